/* Modes of which only frequencies are known, numbered as users do it wrongly (hide_case): the numbers are put right, and no cause
 * is named for them. */
#include "folder.h"
#include "one_state.h"
#include "support.h"

#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "hidden.h"

#define MODES 7

/* The deck with its modes numbered by `number` [MODES], 0: left out. */
static void write_numbered(const char *deck, const int *number)
{
    const char *line = strstr(deck, "*MODES\n");
    char *text = malloc(strlen(deck) + 100), *to = text;
    assert_non_null(line);
    assert_non_null(text);
    line += strlen("*MODES\n");
    to += sprintf(to, "%.*s", (int)(line - deck), deck);
    for (int k = 0; k < MODES; k++) {
        const char *comma = strchr(line, ','), *end = strchr(line, '\n');
        assert_true(comma && end && comma < end);
        if (number[k])
            to += sprintf(to, "%d%.*s\n", number[k], (int)(end - comma), comma);
        line = end + 1;
    }
    (void)strcpy(to, line);
    (void)folder_write("deck.inp", text);
    free(text);
}

UNIT_TEST(numbers_are_put_right)
{
    static const struct {
        int number[MODES], first, is;
        const char *words;
    } table[] = {
        {{1, 2, 3, 4, 5, 6, 7}, 0, 0, NULL},
        {{3, 4, 5, 6, 7, 8, 9}, 0, 0, NULL}, /* those of the sling were counted: COUNT=ALL, as the deck is read */
        {{2, 3, 4, 5, 6, 7, 8}, 2, 1, "1 too high: rigid-body modes were counted"},
        {{0, 1, 2, 3, 4, 5, 6}, 1, 2, "1 too low: the lowest modes were missed"},
        {{1, 2, 0, 3, 4, 5, 6}, 3, 4, "modes were missed below it"},
    };
    const struct diagnose_options options = {.threads = 1};
    char *text = hidden_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp"), *deck = NULL, *truth = NULL, message[300] = "";
    struct hide_request request = hide_request_default();
    assert_non_null(text);
    request.deck = text;
    request.name = "paper_rotor.inp";
    request.seed = 4;
    request.modes = MODES;
    request.no_shapes = 1;
    (void)hide_case(&request, &deck, &truth, message, sizeof message);
    assert_string_equal(message, "");
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct pool pool;
        struct message_list messages;
        struct job job;
        struct diagnosis d;
        write_numbered(deck, table[i].number);
        pool_open(&pool, NULL);
        message_open(&messages, &pool);
        assert_status(deck_read(&pool, folder_path("deck.inp"), 0, NULL, &messages, &job), ROTID_OK);
        assert_int_equal(job.rotor.count_all, table[i].number[0] == 3);
        assert_status(diagnose_run(&pool, &job, &options, NULL, &messages, &d), ROTID_OK);
        assert_string_equal(rotid_verdict_name(d.result.verdict.kind), "adequate");
        assert_int_equal(d.result.ndata_findings, table[i].words != NULL);
        if (table[i].words) {
            const rotid_data_finding *f = &d.result.data_findings[0];
            print_message("%s\n", f->text);
            assert_string_equal(f->id, "mode_pairing");
            assert_int_equal(f->modes[0], table[i].first);
            assert_int_equal(f->modes[1], table[i].is);
            assert_non_null(strstr(f->text, table[i].words));
        }
        diagnose_free(&d);
        pool_close(&pool);
    }
    free(truth);
    free(deck);
    free(text);
}

TEST_GROUP(folder_make, folder_remove);
