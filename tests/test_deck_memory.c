/* Decks from memory: the same as from a file, errors with their places, files only where the host has said where, and texts of
 * anybody. */
#include <unistd.h>

#include "api_dump.h"
#include "compilers.h"
#include "shell.h"
#include "support.h"

#define MODEL  "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.1, 0, 24\n"
#define BROKEN ROTID_SOURCE_DIR "/tests/data/decks/wrong"

static char failure[ROTID_FAILURE_LENGTH];

/* Of a copy that ends where the text does, so that a sanitizer sees whoever reads on. */
static int read_bytes(size_t length, const char *text, const char *name, const char *folder, const char *override,
                      rotid_deck **deck)
{
    char *copy = malloc(length ? length : 1);
    assert_non_null(copy);
    if (length)
        memcpy(copy, text, length);
    int status = rotid_deck_read_text(length, copy, name, folder, override != NULL, &override, NULL, failure, deck);
    memset(copy, '*', length); /* nobody needs it any more */
    free(copy);
    assert_int_equal(*failure != 0, status != ROTID_OK);
    return status;
}

static int read_text(const char *text, const char *folder, const char *override, rotid_deck **deck)
{
    return read_bytes(strlen(text), text, "memory.inp", folder, override, deck);
}

/* Reads a deck that has errors: the first one, with its place. */
static void assert_told(const char *text, const char *folder, const char *override, const char *told)
{
    rotid_deck *deck;
    assert_status(read_text(text, folder, override, &deck), ROTID_ERROR_SYNTAX);
    assert_non_null(deck);
    assert_true(deck->nerror > 0);
    if (strncmp(failure, told, strlen(told)) != 0)
        fail_msg("%s\ninstead of\n%s", failure, told);
    rotid_deck_free(deck);
}

/* ---- the same as from a file */

POOL_TEST(every_deck_is_the_same_as_its_file)
{
    const char *list = shell(&test_pool, "ls %s/input/*.inp %s/*.inp | grep -v include_[il]", ROTID_SOURCE_DIR, BROKEN);
    int count = 0, wrong = 0;
    for (const char *line = list; *line; line += strcspn(line, "\n") + 1, count++) {
        const char *path = pool_format(&test_pool, "%.*s", (int)strcspn(line, "\n"), line), *slash = strrchr(path, '/');
        const char *folder = pool_format(&test_pool, "%.*s", (int)(slash - path), path);
        static char text[1 << 20];
        char why[ROTID_FAILURE_LENGTH];
        rotid_deck *of_file, *of_memory;
        FILE *stream = fopen(path, "rb");
        assert_non_null(stream);
        size_t length = fread(text, 1, sizeof text, stream);
        assert_true(fclose(stream) == 0 && length < sizeof text);
        int status = rotid_deck_read(path, 0, NULL, NULL, why, &of_file);
        const char *expected = rotid_status_name(status);
        assert_string_equal(rotid_status_name(read_bytes(length, text, path, folder, NULL, &of_memory)), expected);
        assert_string_equal(failure, why);
        char *a = dump_deck(of_file), *b = dump_deck(of_memory);
        assert_dump(b, a);
        free(a);
        wrong += status != ROTID_OK;
        rotid_deck_free(of_file);
        rotid_deck_free(of_memory);
    }
    assert_true(count > 50 && wrong > 20 && wrong < count);
}

POOL_TEST(its_results_are_those_of_the_file)
{
    const char *path = ROTID_SOURCE_DIR "/input/paper_rotor.inp";
    const char *text = shell_file(&test_pool, path);
    rotid_deck *of_file, *of_memory;
    rotid_identification *a, *b;
    assert_status(rotid_deck_read(path, 0, NULL, NULL, NULL, &of_file), ROTID_OK);
    assert_status(rotid_deck_read_text(strlen(text), text, path, NULL, 0, NULL, NULL, failure, &of_memory), ROTID_OK);
    assert_status(rotid_identify(of_file, 0, NULL, failure, &a), ROTID_OK);
    assert_status(rotid_identify(of_memory, 0, NULL, failure, &b), ROTID_OK);
    assert_int_equal(a->fit->n, b->fit->n);
    assert_memory_equal(a->fit->x, b->fit->x, (size_t)a->fit->n * sizeof *a->fit->x);
    rotid_identification_free(a);
    rotid_identification_free(b);
    rotid_deck_free(of_file);
    rotid_deck_free(of_memory);
}

POOL_TEST(errors_have_their_places_and_the_name)
{
    rotid_deck *deck;
    assert_told("*MATERIAL, NAME=steel\n*ELASTIC, TIPE=x\n", NULL, NULL,
                "memory.inp:2:11: option TIPE of *ELASTIC is not known, expected TYPE");
    assert_told(MODEL, NULL, "SHAFT.BORE=2", "SHAFT.BORE=2:1:1: option BORE of *SHAFT is not known");
    assert_status(rotid_deck_read_text(7, "*NOTHING", NULL, NULL, 0, NULL, NULL, failure, &deck), ROTID_ERROR_SYNTAX);
    assert_non_null(strstr(failure, "deck:1:1: card *NOTHIN is not known")); /* as long as it was said to be */
    assert_string_equal(deck->path, "deck");
    rotid_deck_free(deck);
    assert_status(read_text(MODEL, NULL, "SHAFT.NAME=kern", &deck), ROTID_OK);
    assert_string_equal(deck->path, "memory.inp");
    rotid_deck_free(deck);
    assert_status(rotid_deck_read_text(1, NULL, NULL, NULL, 0, NULL, NULL, failure, &deck), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "text is NULL, expected 1 characters");
    assert_null(deck);
    assert_status(rotid_deck_read_text(0, NULL, NULL, NULL, 1, NULL, NULL, failure, &deck), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "override is NULL, expected noverride = 1 texts");
    assert_null(deck);
}

/* ---- files */

#define NO_FILES " is a file, and a deck from memory has no directory of its own, expected one beside its text"

POOL_TEST(without_a_directory_no_file_is_read)
{
    const char *folder = make_folder(&test_pool), *core = write_file(&test_pool, folder, "core.inp", MODEL), *there;
    there = pool_format(&test_pool, "*INCLUDE, FILE=%s\n", core);
    assert_told(there, NULL, NULL, pool_format(&test_pool, "memory.inp:1:16: %s%s", core, NO_FILES)); /* nor by its whole path */
    assert_told("*INCLUDE, FILE=core.inp\n", NULL, NULL, "memory.inp:1:16: core.inp" NO_FILES);
    assert_told(MODEL "*MEASURED, FILE=test.uff\n", NULL, NULL, "memory.inp:8:17: test.uff" NO_FILES);
    assert_told(MODEL "*FRF, FILE=/etc/passwd\n1, 1\n", NULL, NULL, "memory.inp:8:12: /etc/passwd" NO_FILES);
    assert_told(MODEL, NULL, "MEASURED.FILE=/etc/passwd", "MEASURED.FILE=/etc/passwd:1:1: /etc/passwd" NO_FILES);
    remove_folder(&test_pool, folder);
}

POOL_TEST(files_are_relative_to_the_directory_and_those_in_them_to_themselves)
{
    const char *folder = make_folder(&test_pool);
    rotid_deck *deck;
    (void)shell(&test_pool, "mkdir %s/parts", folder);
    (void)write_file(&test_pool, folder, "parts/core.inp",
                     "*INCLUDE, FILE=steel.inp\n*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.1, 0, 24\n");
    (void)write_file(&test_pool, folder, "parts/steel.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n");
    (void)write_file(&test_pool, folder, "parts/itself.inp", "*INCLUDE, FILE=itself.inp\n");
    assert_status(read_text("*INCLUDE, FILE=parts/core.inp\n", folder, NULL, &deck), ROTID_OK);
    assert_close(deck->length, 1.2, 0, 0);
    rotid_deck_free(deck);
    /* the name is a name: files do not follow the folder that it seems to have */
    assert_status(read_bytes(29, "*INCLUDE, FILE=parts/core.inp\n", "/nowhere/at/all.inp", folder, NULL, &deck), ROTID_OK);
    rotid_deck_free(deck);
    assert_told("*INCLUDE, FILE=core.inp\n", folder, NULL,
                pool_format(&test_pool, "memory.inp:1:16: cannot read %s/core.inp: No such file", folder));
    assert_told("*INCLUDE, FILE=parts/itself.inp\n", folder, NULL,
                pool_format(&test_pool, "%s/parts/itself.inp:1:16: %s/parts/itself.inp includes itself", folder, folder));
    assert_told(MODEL "*MEASURED, FILE=none.uff\n", folder, NULL,
                pool_format(&test_pool, "memory.inp:8:17: %s/none.uff", folder));
    assert_told(MODEL, folder, "MEASURED.FILE=none.uff",
                pool_format(&test_pool, "MEASURED.FILE=none.uff:1:1: %s/none.uff", folder));
    remove_folder(&test_pool, folder);
}

/* ---- texts of anybody */

POOL_TEST(a_text_may_hold_anything)
{
    rotid_deck *deck;
    enum { LARGE = (16 << 20) + 1 };
    assert_status(read_text("", NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
    assert_string_equal(failure, "memory.inp:1:1: the deck is empty, expected cards such as *SHAFT");
    rotid_deck_free(deck);
    assert_status(rotid_deck_read_text(0, NULL, NULL, NULL, 0, NULL, NULL, failure, &deck), ROTID_ERROR_SYNTAX);
    rotid_deck_free(deck);
    assert_status(read_bytes(sizeof MODEL, MODEL, "memory.inp", NULL, NULL, &deck), ROTID_ERROR_SYNTAX); /* with its zero */
    assert_string_equal(failure, "memory.inp:8:1: byte 0x00 is not text, expected a deck of cards that begin with *");
    rotid_deck_free(deck);
    assert_status(read_bytes(sizeof MODEL - 2, MODEL, "memory.inp", NULL, NULL, &deck), ROTID_OK); /* no newline at its end */
    rotid_deck_free(deck);
    for (size_t length = 0; length < sizeof MODEL - 1; length++) {
        assert_true(read_bytes(length, MODEL, "memory.inp", NULL, NULL, &deck) <= 0);
        rotid_deck_free(deck);
    }
    char *large = malloc(LARGE);
    assert_non_null(large);
    memset(large, '\n', LARGE);
    assert_status(read_bytes(LARGE, large, "memory.inp", NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
    assert_string_equal(failure, "memory.inp:1:1: the deck is larger than 16 MiB, expected cards of a rotor");
    rotid_deck_free(deck);
    assert_status(rotid_deck_read_text(SIZE_MAX, large, NULL, NULL, 0, NULL, NULL, failure, &deck), ROTID_ERROR_SYNTAX);
    rotid_deck_free(deck); /* of which nothing was read */
    memset(large, 'x', LARGE);
    assert_status(read_bytes(LARGE - 1, large, "memory.inp", NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
    assert_non_null(strstr(failure, "memory.inp:1:1025: the line is longer than 1024 characters"));
    rotid_deck_free(deck);
    free(large);
}

POOL_TEST(changed_decks_are_read_or_refused)
{
    const char *text = shell_file(&test_pool, ROTID_SOURCE_DIR "/input/paper_rotor.inp");
    size_t length = strlen(text);
    char *changed = malloc(length);
    unsigned seed = 1;
    assert_non_null(changed);
    for (int i = 0; i < 2000; i++) {
        rotid_deck *deck;
        memcpy(changed, text, length);
        for (int k = 0; k < 1 + i % 5; k++) {
            seed = seed * 1103515245u + 12345u;
            changed[seed % length] = (char)("\0\n*,=.-9e\xff"[seed >> 16 & 7] + (i % 3 == 0));
        }
        int status = read_bytes(length - seed % 64, changed, "memory.inp", NULL, NULL, &deck);
        assert_true(status == ROTID_OK || status == ROTID_ERROR_SYNTAX || status == ROTID_ERROR_SECTION);
        rotid_deck_free(deck);
    }
    free(changed);
}

POOL_TEST(memory_that_runs_out_leaves_nothing)
{
    for (int n = 1;; n++) {
        struct failing_allocator failing;
        rotid_deck *deck;
        failing_allocator_open(&failing, n);
        const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        int status = rotid_deck_read_text(sizeof MODEL - 1, MODEL, "a", "/tmp", 0, NULL, &environment, failure, &deck);
        assert_true(status == ROTID_OK || status == ROTID_ERROR_MEMORY);
        assert_int_equal(deck != NULL, status == ROTID_OK);
        rotid_deck_free(deck);
        assert_int_equal(failing.in_use, 0);
        if (status == ROTID_OK)
            break;
        assert_true(n < 1000);
    }
}
