/* What a host is told where something is wrong: the place and what was expected, in the result and nowhere else. */
#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.h"
#include "support.h"

#define CORPUS ROTID_SOURCE_DIR "/tests/data/decks/wrong"
#define PAPER  ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define MODEL  "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.1, 0, 24\n"

static int kept[2], quiet_file;

/* Standard output and error into a file until told otherwise. */
static void listen_in(void)
{
    (void)fflush(NULL);
    quiet_file = open(folder_path("printed"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(quiet_file >= 0);
    for (int i = 0; i < 2; i++) {
        kept[i] = dup(i + 1);
        assert_true(kept[i] >= 0 && dup2(quiet_file, i + 1) >= 0);
    }
}

/* How many bytes were printed meanwhile. */
static off_t stop_listening(void)
{
    struct stat about;
    (void)fflush(NULL);
    for (int i = 0; i < 2; i++) {
        (void)dup2(kept[i], i + 1);
        (void)close(kept[i]);
    }
    assert_int_equal(fstat(quiet_file, &about), 0);
    (void)close(quiet_file);
    (void)unlink(folder_path("printed"));
    return about.st_size;
}

struct expectation {
    char file[512], text[512];
    int line, column, met;
};

/* "** expect [FILE:]LINE:COLUMN text" */
static int read_expectations(const char *name, struct expectation *list, int most)
{
    char path[512], line[2048];
    int count = 0;
    (void)snprintf(path, sizeof path, CORPUS "/%s", name);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream) && !strncmp(line, "** ", 3)) {
        char place[256], *last;
        int at = 0;
        if (sscanf(line, "** expect %255s %n", place, &at) != 1 || !at)
            continue;
        assert_true(count < most);
        struct expectation *e = &list[count++];
        line[strcspn(line, "\r\n")] = 0;
        *e = (struct expectation){.line = 0};
        (void)snprintf(e->text, sizeof e->text, "%s", line + at);
        last = strrchr(place, ':');
        e->column = atoi(last + 1);
        *last = 0;
        last = strrchr(place, ':');
        e->line = atoi(last ? last + 1 : place);
        if (last)
            *last = 0;
        (void)snprintf(e->file, sizeof e->file, CORPUS "/%s", last ? place : name);
    }
    (void)fclose(stream);
    return count;
}

struct tally {
    int decks, met, expected, syntax, io, section, later;
};

/* Where the deck itself is right the identification refuses it, and `failure` has the text. */
static void try_deck(const char *name, struct tally *tally)
{
    static struct expectation list[16];
    char path[512], failure[512] = "not touched";
    rotid_deck *deck = NULL;
    rotid_identification *result = (void *)list;
    int count = read_expectations(name, list, 16);
    (void)snprintf(path, sizeof path, CORPUS "/%s", name);
    int status = rotid_deck_read(path, 0, NULL, NULL, NULL, &deck);
    if (!deck)
        return;
    for (int i = 0; i < deck->nmessage; i++)
        for (int e = 0; e < count; e++) {
            const rotid_message *m = &deck->message[i];
            if (m->severity == ROTID_ERROR && m->line == list[e].line && m->column == list[e].column &&
                !strcmp(m->file, list[e].file) && strstr(m->text, list[e].text))
                list[e].met = 1;
        }
    int then = rotid_identify(deck, 0, NULL, failure, &result), later = !status && then < 0 && !result;
    for (int e = 0; e < count; e++) {
        list[e].met |= later && strstr(failure, list[e].text);
        tally->met += list[e].met;
    }
    if (status && (then != ROTID_ERROR_ARGUMENT || result || (count == 1 && !strstr(failure, list[0].text))))
        tally->met = -10000;
    tally->decks++;
    tally->expected += count;
    tally->syntax += status == ROTID_ERROR_SYNTAX && deck->nerror > 0 && isnan(deck->mass) && !deck->nmode;
    tally->io += status == ROTID_ERROR_IO && deck->nerror > 0;
    tally->section += status == ROTID_ERROR_SECTION && deck->nerror == 1;
    tally->later += later;
    rotid_deck_free(deck);
}

UNIT_TEST(wrong_decks_are_told_by_their_messages_alone)
{
    struct tally tally = {0};
    int files = 0;
    DIR *stream = opendir(CORPUS);
    assert_non_null(stream);
    listen_in();
    for (struct dirent *entry; (entry = readdir(stream));) {
        const char *ending = strrchr(entry->d_name, '.');
        if (!ending || strcmp(ending, ".inp"))
            continue;
        files++;
        try_deck(entry->d_name, &tally);
    }
    assert_int_equal(stop_listening(), 0);
    (void)closedir(stream);
    print_message("%d decks: %d malformed, %d without a file, %d without a section, %d refused by the run\n", tally.decks,
                  tally.syntax, tally.io, tally.section, tally.later);
    assert_true(files > 150);
    assert_int_equal(tally.decks, files);
    assert_int_equal(tally.met, tally.expected);
    assert_int_equal(tally.syntax + tally.io + tally.section + tally.later, tally.decks);
    assert_true(tally.section > 0);
}

UNIT_TEST(a_file_that_is_not_there_is_named)
{
    rotid_deck *deck;
    char failure[512];
    rotid_identification *result;
    assert_status(rotid_deck_read(folder_path("none.inp"), 0, NULL, NULL, NULL, &deck), ROTID_ERROR_IO);
    assert_non_null(deck);
    assert_int_equal(deck->nerror, 1);
    assert_non_null(strstr(deck->message[0].text, folder_path("none.inp")));
    assert_non_null(strstr(deck->message[0].text, "No such file"));
    assert_true(isnan(deck->mass) && isnan(deck->length) && isnan(deck->centre));
    assert_status(rotid_identify(deck, 0, NULL, failure, &result), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(failure, "No such file"));
    rotid_deck_free(deck);
    assert_status(rotid_deck_read(folder, 0, NULL, NULL, NULL, &deck), ROTID_ERROR_IO);
    rotid_deck_free(deck);
}

UNIT_TEST(of_many_errors_the_number_is_kept)
{
    static char text[30000];
    size_t used = 0;
    for (int i = 0; i < 1000; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "*UNKNOWN\n");
    rotid_deck *deck;
    assert_status(rotid_deck_read(folder_write("many.inp", text), 0, NULL, NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
    assert_true(deck->nerror >= 1000);
    assert_int_equal(deck->nmessage, 200);
    assert_int_equal(deck->message[199].line, 200);
    rotid_deck_free(deck);
}

UNIT_TEST(arguments_out_of_range_are_refused)
{
    static const char *const text[] = {"FIT.FUNCTIONAL=HYBRID"};
    const struct {
        rotid_diagnose_options options;
        const char *text;
    } wrong[] = {{{.size = sizeof wrong->options, .threads = -1}, "options->threads is -1, expected 0 or more"},
                 {{.threads = 1}, "options->size is 0, expected sizeof(rotid_diagnose_options), here 32"}};
    const struct {
        rotid_suggest_options options;
        const char *text;
    } far[] = {{{.size = sizeof far->options, .modes = 101}, "options->modes is 101, expected 0 ... 100"},
               {{.size = sizeof far->options, .modes = 1}, "options->modes is 1, expected 2 ... 100"},
               {{.size = sizeof far->options, .sensors = 1001}, "options->sensors is 1001, expected 0 ... 1000"},
               {{.size = sizeof far->options, .seed = -1}, "options->seed is -1, expected 0 ... 1e+12"}};
    const double x[2] = {1e11, NAN};
    char failure[512];
    rotid_suggestion *suggestion;
    rotid_deck *deck;
    assert_status(rotid_deck_read(NULL, 0, NULL, NULL, failure, &deck), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "path is NULL, expected that of a deck");
    assert_null(deck);
    assert_status(rotid_deck_read(PAPER, 0, NULL, NULL, failure, NULL), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "deck is NULL, expected the address of a pointer");
    assert_status(rotid_deck_read(PAPER, 1, NULL, NULL, failure, &deck), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "override is NULL, expected noverride = 1 texts");
    assert_null(deck);
    assert_status(rotid_deck_read(PAPER, -1, text, NULL, failure, &deck), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "noverride is -1, expected 0 or more");
    assert_null(deck);
    rotid_deck_free(NULL);

    rotid_spectrum *spectrum = (void *)&deck;
    assert_status(rotid_deck_read(PAPER, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_spectrum_compute(NULL, NULL, 1, NULL, NULL, &spectrum), ROTID_ERROR_ARGUMENT);
    assert_null(spectrum);
    assert_status(rotid_spectrum_compute(deck, NULL, -1, NULL, failure, &spectrum), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "nmode is -1, expected 0 or more");
    assert_status(rotid_spectrum_compute(deck, x, 1, NULL, failure, &spectrum), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "x[1], the value of core.G, is nan, expected a number");
    assert_status(rotid_spectrum_compute(deck, NULL, 1, NULL, NULL, NULL), ROTID_ERROR_ARGUMENT);
    const double soft[2] = {-1e11, -1e10};
    assert_status(rotid_spectrum_compute(deck, soft, 1, NULL, failure, &spectrum), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "x[0], the value of core.E, is -1e+11, expected a value above 0 and at most inf");
    assert_null(spectrum);
    rotid_spectrum_free(NULL);

    rotid_identification *identification = (void *)&deck;
    assert_status(rotid_identify(NULL, 0, NULL, failure, &identification), ROTID_ERROR_ARGUMENT);
    assert_null(identification);
    assert_non_null(strstr(failure, "expected"));
    assert_status(rotid_identify(deck, 0, NULL, failure, NULL), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "result is NULL, expected the address of a pointer");
    rotid_identification_free(NULL);

    rotid_diagnosis *diagnosis = (void *)&deck;
    assert_status(rotid_diagnose(NULL, NULL, NULL, NULL, &diagnosis), ROTID_ERROR_ARGUMENT);
    assert_null(diagnosis);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, NULL), ROTID_ERROR_ARGUMENT);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_status(rotid_diagnose(deck, &wrong[i].options, NULL, failure, &diagnosis), ROTID_ERROR_ARGUMENT);
        assert_string_equal(failure, wrong[i].text);
    }
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        assert_status(rotid_suggest(deck, &far[i].options, NULL, failure, &suggestion), ROTID_ERROR_ARGUMENT);
        assert_string_equal(failure, far[i].text);
    }
    rotid_diagnosis_free(NULL);
    rotid_deck_free(deck);
}

UNIT_TEST(runs_say_why_they_failed)
{
    char failure[512] = "not touched";
    rotid_deck *deck;
    rotid_identification *identification;
    rotid_diagnosis *diagnosis;
    const char *path = folder_write("bare.inp", MODEL "*IDENTIFY\ncore.E, 1e11, 3e11, 2e11\n");
    assert_status(rotid_deck_read(path, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_identify(deck, 0, NULL, failure, &identification), ROTID_ERROR_ARGUMENT);
    assert_memory_equal(failure, path, strlen(path));
    assert_non_null(strstr(failure, ":1:1: the deck has no measured modes"));
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &diagnosis), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(failure, ":1:1: the deck has no measured modes"));
    rotid_deck_free(deck);
    /* rad/s, say, or one frequency for one parameter */
    path = folder_write("bare.inp", MODEL "*MODES\n1, 300\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\ncore.E, 1e11, 3e11, 2e11\n");
    assert_status(rotid_deck_read(path, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &diagnosis), ROTID_ERROR_ARGUMENT);
    assert_null(diagnosis);
    assert_non_null(strstr(failure, "leave no degree of freedom to test the model, expected more modes"));
    rotid_deck_free(deck);
}

/* Paths and names are of the call alone: a host may free them, as Fortran and Python do at once. */
UNIT_TEST(names_of_the_caller_may_go_behind_the_call)
{
    static const char text[] = MODEL "*IDENTIFY\ncore.E, 1e11, 3e11, 2e11\n";
    const double x[] = {1e300};
    char failure[512], name[64], directory[64];
    rotid_deck *deck;
    rotid_spectrum *spectrum;
    for (int memory = 0; memory < 2; memory++) {
        const char *path = folder_write("given.inp", text);
        (void)snprintf(name, sizeof name, "%s", path);
        (void)snprintf(directory, sizeof directory, "%s", folder);
        assert_status(memory ? rotid_deck_read_text(strlen(text), text, name, directory, 0, NULL, NULL, NULL, &deck)
                             : rotid_deck_read(name, 0, NULL, NULL, NULL, &deck),
                      ROTID_OK);
        memset(name, 'x', sizeof name);
        memset(directory, 'x', sizeof directory);
        assert_status(rotid_spectrum_compute(deck, x, 3, NULL, failure, &spectrum), ROTID_ERROR_EIGEN);
        assert_memory_equal(failure, path, strlen(path));
        assert_true(failure[strlen(path)] == ':');
        rotid_deck_free(deck);
    }
}

/* A message longer than the buffer is cut off between two characters. */
UNIT_TEST(a_long_reason_is_cut_off_between_characters)
{
    char name[3][260], path[1200], text[] = MODEL;
    size_t used = (size_t)snprintf(path, sizeof path, "%s", folder);
    for (int i = 0; i < 3; i++) { /* three folders of a hundred letters with two bytes each, the last begins with one more byte */
        size_t length = i == 2;
        name[i][0] = 'x';
        for (int letter = 0; letter < 100; letter++, length += 2)
            memcpy(name[i] + length, "\xc3\xa4", 2);
        name[i][length] = 0;
        used += (size_t)snprintf(path + used, sizeof path - used, "/%s", name[i]);
        assert_int_equal(mkdir(path, 0700), 0);
    }
    (void)snprintf(path + used, sizeof path - used, "/deck.inp");
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    size_t total = 0;
    for (int shift = 0; shift < 2; shift++) { /* by one byte */
        char failure[520];
        rotid_deck *deck;
        rotid_identification *result;
        char asked[1210];
        (void)snprintf(asked, sizeof asked, "%s%s", shift ? "/" : "", path);
        memset(failure, 'z', sizeof failure);
        assert_status(rotid_deck_read(asked, 0, NULL, NULL, NULL, &deck), ROTID_OK);
        assert_status(rotid_identify(deck, 0, NULL, failure, &result), ROTID_ERROR_ARGUMENT);
        rotid_deck_free(deck);
        size_t length = strlen(failure);
        total += length;
        assert_memory_equal(failure, asked, length);
        assert_int_not_equal((unsigned char)failure[length - 1], 0xc3);
        assert_int_equal(failure[512], 'z');
    }
    assert_int_equal(total, 510 + 511);
    (void)unlink(path);
    for (int i = 3; i-- > 0;) {
        *strrchr(path, '/') = 0;
        assert_int_equal(rmdir(path), 0);
    }
}

TEST_GROUP(folder_make, folder_remove);
