/* Wrong decks. Each file of data/decks/wrong says in its first lines what must be reported where:
 *   ** expect LINE:COLUMN text         ** expect FILE:LINE:COLUMN text (of a file that the deck names)
 * Every expectation must be met, and no other error may be reported: one mistake, one message. Nothing is computed or written.
 * Then decks that are cut off, changed in single bytes, or read while memory runs out: an answer each time, no crash, no leak. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "deck/deck.h"
#include "folder.h"
#include "one_state.h"
#include "support.h"

#define CORPUS      ROTID_SOURCE_DIR "/tests/data/decks/wrong"
#define PAPER_ROTOR ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID_ROTOR ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define EVERY_CARD  ROTID_SOURCE_DIR "/tests/data/decks/every_card.inp"

extern char **environ;

static void write_file(const char *path, const char *bytes, size_t length)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, length, stream), length);
    assert_int_equal(fclose(stream), 0);
}

/* ------------------------------------------------------------------------------------------------ the program */

struct outcome {
    int code;       /* 128 + signal where a signal ended it */
    char *err;      /* to be freed */
    size_t written; /* to standard output */
};

static struct outcome identify(const char *deck)
{
    struct outcome outcome;
    char *arguments[] = {ROTID_PROGRAM, "identify", (char *)deck, "--json", (char *)folder_path("out.json"), NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int status;
    assert_int_equal(posix_spawn_file_actions_init(&actions), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, 1, folder_path("stdout"), O_WRONLY | O_CREAT | O_TRUNC, 0600), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, 2, folder_path("stderr"), O_WRONLY | O_CREAT | O_TRUNC, 0600), 0);
    assert_int_equal(posix_spawn(&child, ROTID_PROGRAM, &actions, NULL, arguments, environ), 0);
    (void)posix_spawn_file_actions_destroy(&actions);
    assert_true(waitpid(child, &status, 0) == child);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    free(file_bytes(folder_path("stdout"), &outcome.written));
    size_t length;
    outcome.err = file_bytes(folder_path("stderr"), &length);
    return outcome;
}

/* No result, no temporary file beside it: what is in the folder is ours. */
static int wrote_a_file(void)
{
    int found = 0;
    DIR *stream = opendir(folder);
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream));)
        found |= !strncmp(entry->d_name, "out.json", 8);
    (void)closedir(stream);
    return found;
}

/* Whether a line of the output begins with "PLACE: " and holds the text. */
static int reports(const char *err, const char *place, const char *text)
{
    size_t length = strlen(place);
    for (const char *line = err; *line; line += strcspn(line, "\n") + (line[strcspn(line, "\n")] == '\n')) {
        const char *found = strstr(line, text);
        if (!strncmp(line, place, length) && !strncmp(line + length, ": ", 2) && found && found < line + strcspn(line, "\n"))
            return 1;
    }
    return 0;
}

/* Errors reported, or -1 where one does not say what was expected. Warnings do not count. */
static int count_errors(char *err)
{
    int count = 0;
    for (char *line = err, *end; (end = strchr(line, '\n')); line = end + 1) {
        *end = 0;
        int is_warning = strstr(line, ": warning: ") != NULL, explains = strstr(line, "expected") != NULL;
        *end = '\n';
        if (!is_warning && !explains)
            return -1;
        count += !is_warning;
    }
    return count;
}

static int refuses(const char *deck, const char *expectations, int count)
{
    struct outcome outcome = identify(deck);
    int met = 0;
    for (const char *line = expectations; *line; line += strlen(line) + 1) { /* place and text, each ended by a zero byte */
        const char *place = line;
        line += strlen(line) + 1;
        met += reports(outcome.err, place, line);
    }
    int errors = count_errors(outcome.err);
    int good = outcome.code == 2 && !outcome.written && met == count && errors == count && !wrote_a_file();
    if (!good)
        print_error("%s: exit code %d, %zu bytes to standard output, %d of %d expectations met, %d errors:\n%s", deck,
                    outcome.code, outcome.written, met, count, errors, outcome.err);
    free(outcome.err);
    (void)unlink(folder_path("out.json"));
    return good;
}

/* Reads the "** expect" lines of a deck of the corpus and runs it. */
static int is_refused_as_it_says(const char *name)
{
    char deck[512], expectations[8192];
    size_t length, used = 0;
    int count = 0;
    (void)snprintf(deck, sizeof deck, "%s/%s", CORPUS, name);
    char *text = file_bytes(deck, &length), *rest = NULL;
    for (char *line = strtok_r(text, "\r\n", &rest); line && !strncmp(line, "** ", 3); line = strtok_r(NULL, "\r\n", &rest)) {
        if (strncmp(line, "** expect ", 10))
            continue;
        char *place = line + 10, *space = strchr(place, ' ');
        assert_non_null(space);
        *space = 0;
        int other = strchr(place, ':') != strrchr(place, ':');
        assert_true(sizeof expectations - used > strlen(CORPUS) + strlen(name) + strlen(place) + strlen(space + 1) + 8);
        used += 1 + (size_t)sprintf(expectations + used, "%s/%s%s%s", CORPUS, other ? "" : name, other ? "" : ":", place);
        used += 1 + (size_t)sprintf(expectations + used, "%s", space + 1);
        count++;
    }
    expectations[used] = 0;
    free(text);
    if (!count)
        print_error("%s states no expectation\n", deck);
    return count && refuses(deck, expectations, count);
}

UNIT_TEST(each_wrong_deck_is_refused_where_it_is_wrong)
{
    int decks = 0, refused = 0;
    DIR *stream = opendir(CORPUS);
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream));) {
        const char *ending = strrchr(entry->d_name, '.');
        if (!ending || strcmp(ending, ".inp"))
            continue;
        decks++;
        refused += decks % SLOW_START || is_refused_as_it_says(entry->d_name);
    }
    (void)closedir(stream);
    assert_true(decks >= 150);
    assert_int_equal(refused, decks);
}

/* One error at that place of the deck, and its text. */
static int is_refused(const char *deck, const char *place, const char *text)
{
    char expectations[1024];
    int first = snprintf(expectations, sizeof expectations, "%s:%s", deck, place);
    int second = snprintf(expectations + first + 1, sizeof expectations - (size_t)first - 1, "%s", text);
    expectations[first + second + 2] = 0;
    return refuses(deck, expectations, 1);
}

/* ------------------------------------------------------------------------------------------------ files that are no deck */

UNIT_TEST(what_is_no_file_of_text_is_refused)
{
    struct random_stream stream = {7};
    char noise[4096];
    noise[0] = 0;
    for (size_t i = 1; i < sizeof noise; i++)
        noise[i] = (char)(int)(256 * random_uniform(&stream) - 128);
    write_file(folder_path("noise.inp"), noise, sizeof noise);
    write_file(folder_path("empty.inp"), noise, 0);
    write_file(folder_path("huge.inp"), noise, 0);
    assert_int_equal(truncate(folder_path("huge.inp"), 100 * 1000 * 1000), 0);
    assert_true(is_refused(folder_path("noise.inp"), "1:1", "byte 0x00 is not text"));
    assert_true(is_refused(folder_path("empty.inp"), "1:1", "the deck is empty"));
    assert_true(is_refused(folder_path("huge.inp"), "1:1", "the deck is larger than"));
    assert_true(is_refused(folder_path("missing.inp"), "1:1", "No such file or directory"));
    assert_true(is_refused(folder, "1:1", "Is a directory"));
    assert_true(is_refused("/dev/zero", "1:1025", "the line is longer than 1024 characters"));
}

UNIT_TEST(a_file_that_may_not_be_read_is_refused)
{
    if (geteuid() == 0)
        skip(); /* root may read everything */
    write_file(folder_path("locked.inp"), "*HEADING\n", 9);
    assert_int_equal(chmod(folder_path("locked.inp"), 0), 0);
    assert_true(is_refused(folder_path("locked.inp"), "1:1", "Permission denied"));
}

#define START "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"

/* `count` times `line` in the deck; `every` lines a new card. */
static void write_many(const char *card, int every, const char *line, int count)
{
    FILE *stream = fopen(folder_path("many.inp"), "wb");
    assert_non_null(stream);
    (void)fputs(START "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n", stream);
    for (int i = 0; i < count; i++) {
        if (i % every == 0)
            (void)fprintf(stream, card, i);
        (void)fprintf(stream, line, i + 1);
    }
    assert_int_equal(fclose(stream), 0);
}

/* The number of elements once overflowed to a small one, 429,497 x 10,000 = 2^32 + 2,704: the mesh went past its memory. */
UNIT_TEST(more_elements_than_an_integer_counts_are_refused)
{
    write_many("*SHAFT, NAME=s%d, MATERIAL=steel\n", 10000, "1, 0.1, 0, 10000\n", 429497);
    assert_true(is_refused(folder_path("many.inp"), "420050:1", "elements, expected at most"));
}

/* Names and ids are compared with each other: tens of thousands once took minutes. */
UNIT_TEST(more_cards_or_sensors_than_a_rotor_has_are_refused_at_once)
{
    write_many("*DISK, NAME=d%d\n", 1, "0.5, 1\n", 50000);
    assert_true(is_refused(folder_path("many.inp"), "10000:1", "the deck has more than 5000 cards"));
    write_many("*SENSORS\n", 200000, "%d, 0.5\n", 200000);
    assert_true(is_refused(folder_path("many.inp"), "10009:1", "*SENSORS has"));
}

/* ------------------------------------------------------------------------------------------------ deck_read by itself */

static int read_path(const char *path, const rotid_allocator *allocator)
{
    struct pool pool;
    struct message_list messages;
    struct job job;
    pool_open(&pool, allocator);
    message_open(&messages, &pool);
    int status = deck_read(&pool, path, 0, NULL, &messages, &job);
    for (size_t i = 0; i < messages.count && status != ROTID_ERROR_MEMORY; i++)
        assert_true(messages.item[i].file && messages.item[i].line > 0 && messages.item[i].column > 0);
    if (status != ROTID_ERROR_MEMORY)
        assert_true((status == ROTID_OK) == (messages.errors == 0));
    pool_close(&pool);
    return status;
}

/* An answer, whichever it is. */
static int reads(const char *text, size_t length)
{
    write_file(folder_path("deck.inp"), text, length);
    int status = read_path(folder_path("deck.inp"), NULL);
    assert_true(status == ROTID_OK || status == ROTID_ERROR_SYNTAX || status == ROTID_ERROR_SECTION);
    return status == ROTID_OK;
}

UNIT_TEST(a_deck_cut_off_anywhere_gets_an_answer)
{
    struct random_stream stream = {11};
    size_t length;
    int good = 0;
    char *text = file_bytes(PAPER_ROTOR, &length);
    for (size_t i = 0; i < length; i++)
        if (text[i] == '\n')
            good += reads(text, i) + reads(text, i + 1);
    for (int i = 0; i < 200; i++)
        good += reads(text, (size_t)((double)length * random_uniform(&stream)));
    assert_true(good > 100); /* most cuts are among the sensors */
    free(text);
}

UNIT_TEST(a_deck_with_one_wrong_byte_gets_an_answer)
{
    static const char *const path[] = {PAPER_ROTOR, EVERY_CARD};
    struct random_stream stream = {13};
    for (int d = 0; d < 2; d++) {
        size_t length;
        int good = 0;
        char *text = file_bytes(path[d], &length);
        for (int i = 0; i < 1000; i += SLOW_START) {
            size_t at = (size_t)((double)length * random_uniform(&stream));
            char kept = text[at];
            text[at] = (char)(int)(256 * random_uniform(&stream) - 128);
            good += reads(text, length);
            text[at] = kept;
        }
        assert_true(good > 0 && good < 1000);
        free(text);
    }
}

UNIT_TEST(without_memory_a_deck_is_no_deck_and_nothing_leaks)
{
    static const char *const path[] = {PAPER_ROTOR, SOLID_ROTOR, EVERY_CARD, CORPUS "/many_errors.inp"};
    for (int d = 0; d < 4; d++) {
        struct failing_allocator failing;
        long fail_at = 0;
        int status;
        do {
            failing_allocator_open(&failing, ++fail_at);
            status = read_path(path[d], &failing.allocator);
            assert_int_equal(failing.in_use, 0);
            assert_true(failing.until_failure > 0 || status == ROTID_ERROR_MEMORY);
        } while (failing.until_failure == 0);
        assert_int_equal(status, d < 3 ? ROTID_OK : ROTID_ERROR_SYNTAX);
        assert_true(fail_at > 50);
    }
}

TEST_GROUP(folder_make, folder_remove);
