/* Plans: what is wrong with them and where, how many runs they have, what their digest follows. */
#include "study_bench.h"
#include "support.h"

#define ONE "*STUDY\n*DECKS\ndeck.inp\n"

/* One message at that place that begins so. */
static void complains(const char *text, int line, int column, const char *words)
{
    struct message_list messages;
    struct study study;
    int status = bench_study(&test_pool, text, &messages, &study), found = 0;
    for (size_t i = 0; i < messages.count; i++)
        found |= messages.item[i].line == line && messages.item[i].column == column && strstr(messages.item[i].text, words) &&
                 strstr(messages.item[i].file, "plan.txt");
    if (!found)
        for (size_t i = 0; i < messages.count; i++)
            print_error("%s:%d:%d: %s\n", messages.item[i].file, messages.item[i].line, messages.item[i].column,
                        messages.item[i].text);
    if (!found || !status)
        print_error("expected %d:%d: %s\n", line, column, words);
    assert_true(found && status == ROTID_ERROR_SYNTAX);
}

POOL_TEST(every_mistake_has_its_place)
{
    complains("*STUDY\n", 1, 7, "names no deck, expected *DECKS");
    complains("*STUDY, COMMAND=FIT\n*DECKS\ndeck.inp\n", 1, 17, "COMMAND=FIT is not known, expected one of IDENTIFY, DIAGNOSE");
    complains("*STUDY, SEED=-1\n*DECKS\ndeck.inp\n", 1, 14, "SEED is -1, expected a whole number from 0");
    complains("*STUDY, REPLICATES=1.5\n*DECKS\ndeck.inp\n", 1, 20, "REPLICATES is 1.5, expected a whole number");
    complains("*STUDY, SPEED=1\n*DECKS\ndeck.inp\n", 1, 9, "option SPEED of *STUDY is not known, expected COMMAND");
    complains("*STUDY, DRAWS=20\n*DECKS\ndeck.inp\n", 1, 9, "DRAWS has no meaning for COMMAND=IDENTIFY, expected COMMAND=SPEEDS");
    complains("*STUDY, COMMAND=DIAGNOSE, BASELINE=YES\n*DECKS\ndeck.inp\n", 1, 27, "BASELINE has no meaning");
    complains("*STUDY\n*STUDY\n*DECKS\ndeck.inp\n", 2, 1, "*STUDY is given twice");
    complains("*STUDY\n1\n*DECKS\ndeck.inp\n", 2, 1, "*STUDY has no data lines");
    complains(ONE "deck.inp\n", 4, 1, "deck deck.inp is given twice");
    complains("*STUDY\n*DECKS\n", 2, 1, "*DECKS has no data line, expected a path a line");
    complains(ONE "*SHAFT\n", 4, 1, "card *SHAFT is not known in a plan");
    complains(ONE "*VARIANT\n", 4, 1, "*VARIANT has no NAME");
    complains(ONE "*VARIANT, NAME=a\n*VARIANT, NAME=A\n", 5, 16, "variant A is given twice");
    complains(ONE "*VARIANT, NAME=a\n  FIT=1\n", 5, 3, "'FIT=1' is no option of a deck, expected CARD.OPTION=VALUE");
    complains(ONE "*MODES\n1-3\n1-3\n", 6, 1, "modes 1-3 are given twice");
    complains(ONE "*SENSORS\n0\n", 5, 1, "number of sensors is 0");
    complains(ONE "*SENSORS\nEVERY\n", 5, 6, "a value is missing, expected each one so far on");
    complains(ONE "*SENSORS\n5\n5\n", 6, 1, "5 is given twice");
    complains(ONE "*DATA, SOURCE=DREAM\n", 4, 15, "SOURCE=DREAM is not known, expected one of MEASURED, MODEL");
    complains(ONE "*TRUTH\ncore.E, 2e11\n", 4, 1, "*TRUTH is that of data a model makes");
    complains(ONE "*HIDE, TYPE=NONE\n", 4, 1, "*HIDE acts in data a model makes");
    complains(ONE "*NOISE\n-1\n", 5, 1, "noise of the frequencies is -1, expected a number not below zero");
    complains(ONE "*NOISE\n0.6\n", 5, 1, "is more than a half");
    complains(ONE "*NOISE\n0.1, 0.2, 0.3\n", 5, 11, "'0.3' is one value too many");
    complains(ONE "*STARTS, COUNT=3\n", 4, 1, "*STARTS has no SPREAD");
    complains(ONE "*STARTS, SPREAD=0.5, COUNT=3, GRID=3\n", 4, 22, "COUNT and GRID are both given");
    complains("*STUDY, COMMAND=DIAGNOSE\n*DECKS\ndeck.inp\n*STARTS, SPREAD=0.5\n", 4, 1, "*STARTS has no meaning for");
    complains(ONE "*HIDE\n", 4, 1, "*HIDE has no TYPE");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=NONE\nmass, 1\n", 6, 1, "TYPE=NONE hides nothing");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=NONE\n*HIDE, TYPE=NONE\n", 6, 1, "two *HIDE are called none");
}

/* What only the deck can tell stands at its place in the plan as well. */
POOL_TEST(mistakes_that_a_deck_finds_stand_in_the_plan)
{
    complains(ONE "*VARIANT, NAME=a\nFIT.TIE=E\n", 5, 1, "TIE=E is not known, expected one of E:G (deck deck.inp)");
    complains(ONE "*VARIANT, NAME=a\nBARS.MODEL=TUBE\n", 5, 1, "the deck has no card *BARS");
    complains(ONE "*MODES\n1-3\n1-7\n", 6, 1, "mode 7 of MODES is not measured");
    complains(ONE "*SENSORS\n13\n", 5, 1, "deck deck.inp has 12 sensors, expected not more");
    complains(ONE "*VARIANT, NAME=a\nFIT.REDUCTION=GUYAN\n*SENSORS\n11\n", 7, 1,
              "11 sensors are too few to condense deck deck.inp");
    complains(ONE "*DATA, SOURCE=MODEL\n*TRUTH\ncore.X, 1\n", 6, 1, "core.X is no parameter of deck deck.inp");
    complains(ONE "*DATA, SOURCE=MODEL\n*TRUTH\ncore.nu, 0.3, 0.7\n", 6, 1,
              "core.nu is 0.7, expected a value above -1 and at most 0.5");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=added_mas\n", 5, 13, "TYPE=added_mas is no cause, expected one of");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=added_mass\nmass, 0.1\n", 5, 1, "no value of z [m]");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=added_mass\nmass, 0.1, 900\nz, 0.5\n", 6, 12,
              "mass is 900, expected a value from 0");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=added_mass\nmass, 0.1\nz, 0.5, core.start\n", 5, 1,
              "z lies between 0.5 and 0.3");
    complains(ONE "*DATA, SOURCE=MODEL\n*HIDE, TYPE=sensor_gain, SENSOR=3\ngain, 2\n", 5, 1,
              "corrects measured shapes and there are none");
    complains(ONE "*DATA, SOURCE=MODEL\n*NOISE\n0.1, 0.1\n*HIDE, TYPE=sensor_gain, SENSOR=13\ngain, 2\n", 7, 33,
              "sensor 13 is not among");
}

/* A deck that is wrong as it stands does not stop the others; alone it does. */
POOL_TEST(a_wrong_deck_fails_alone)
{
    struct message_list messages;
    struct study study;
    (void)bench_write("wrong.inp", "*SHAFT\n");
    (void)bench_write("idle.inp", BENCH_BEAM BENCH_MODES);
    assert_status(bench_study(&test_pool, ONE "wrong.inp\nmissing.inp\nidle.inp\n", &messages, &study), ROTID_OK);
    assert_null(study.deck[0].error);
    assert_non_null(strstr(study.deck[1].error, "wrong.inp:1:1: *SHAFT has no NAME"));
    assert_non_null(strstr(study.deck[2].error, "missing.inp:1:1: cannot read"));
    assert_non_null(strstr(study.deck[3].error, "has no *IDENTIFY"));
    assert_int_equal(study.runs, 4);
    cJSON *result = bench_result(&study, 2);
    assert_string_equal(cJSON_GetObjectItem(result, "status")->valuestring, "failed");
    assert_non_null(strstr(cJSON_GetObjectItem(result, "error")->valuestring, "cannot read"));
    cJSON_Delete(result);
    assert_status(bench_study(&test_pool, "*STUDY\n*DECKS\nwrong.inp\nmissing.inp\n", &messages, &study), ROTID_ERROR_SYNTAX);
    assert_true(messages.errors >= 3);
}

/* Every combination once, and every run somewhere. */
POOL_TEST(axes_multiply)
{
    struct message_list messages;
    struct study study;
    (void)bench_write("other.inp", BENCH_DECK);
    assert_status(
        bench_study(&test_pool,
                    "*STUDY, REPLICATES=4\n*DECKS\ndeck.inp\nother.inp\n*VARIANT, NAME=two\n"
                    "*VARIANT, NAME=one\nFIT.TIE=E:G\n*MODES\n1-4\n1-5\n1-6\n*SENSORS\nALL\n6\n*DATA, SOURCE=MODEL\n"
                    "*NOISE\n0.001\n0.002\n0.004, 0.01\n*HIDE, TYPE=NONE\n*HIDE, TYPE=stiffness, GROUP=right\nfactor, 0.9\n"
                    "*STARTS, SPREAD=0.5, GRID=5\n",
                    &messages, &study),
        ROTID_OK);
    const long cells = 3 * 2 * 3 * 2,
               starts = 25; /* neither variant changes the number of parameters: TIE takes G, which is free in none */
    assert_int_equal(study.runs, 2 * 2 * cells * 4 * starts);
    struct study_point before = study_locate(&study, 0);
    assert_true(!before.start && !before.replicate && !before.cell.at[AXIS_DECK]);
    for (long run = 1; run < study.runs; run++) { /* one number after the other, as an odometer does */
        struct study_point now = study_locate(&study, run), next = before;
        if (++next.start == starts) {
            next.start = 0;
            next.replicate++;
        }
        int *const digit[] = {&next.cell.at[AXIS_HIDE],  &next.cell.at[AXIS_NOISE],   &next.cell.at[AXIS_SENSORS],
                              &next.cell.at[AXIS_MODES], &next.cell.at[AXIS_VARIANT], &next.cell.at[AXIS_DECK]};
        const int most[] = {2, 3, 2, 3, 2, 2};
        if (next.replicate == 4) {
            next.replicate = 0;
            for (int d = 0; d < 6 && ++*digit[d] == most[d]; d++)
                *digit[d] = 0;
        }
        assert_true(!memcmp(&now.cell, &next.cell, sizeof now.cell) && now.replicate == next.replicate &&
                    now.start == next.start);
        before = now;
    }
}

/* With G identified beside E, TIE leaves one parameter less, and the grid has a dimension less. */
POOL_TEST(grids_follow_the_parameters_of_a_variant)
{
    struct message_list messages;
    struct study study;
    (void)bench_write("moduli.inp", BENCH_BEAM BENCH_MODES "*IDENTIFY\ncore.E, 1e10, 1e12, 2e11\ncore.G, 1e10, 1e12, 8e10\n");
    assert_status(
        bench_study(
            &test_pool,
            "*STUDY\n*DECKS\nmoduli.inp\n*VARIANT, NAME=two\n*VARIANT, NAME=one\nFIT.TIE=E:G\n*STARTS, SPREAD=0.7, GRID=7\n",
            &messages, &study),
        ROTID_OK);
    assert_int_equal(study.runs, 49 + 7);
    assert_int_equal(study_locate(&study, 48).cell.at[AXIS_VARIANT], 0);
    assert_int_equal(study_locate(&study, 49).cell.at[AXIS_VARIANT], 1);
    complains("*STUDY, REPLICATES=10000000\n*DECKS\nmoduli.inp\n*STARTS, SPREAD=0.7, GRID=7\n", 1, 1, "more than 10000000 runs");
}

static struct study digests(const char *plan)
{
    struct message_list messages;
    struct study study;
    assert_status(bench_study(&test_pool, plan, &messages, &study), ROTID_OK);
    return study;
}

/* What means the same has the same digest; what means another thing does not, and the digest that changes says what it was. */
POOL_TEST(digests_follow_the_meaning)
{
    (void)bench_write("data.inp", BENCH_BEAM "*INCLUDE, FILE=modes.inc\n" BENCH_WANTED);
    (void)bench_write("modes.inc", BENCH_MODES);
    struct study first = digests("*STUDY\n*DECKS\ndata.inp\n"),
                 now = digests("** a word\n*study\n\n*DECKS\n  data.inp   ** this one\n");
    assert_string_equal(first.digest.plan, now.digest.plan);
    assert_string_equal(first.digest.decks, now.digest.decks);
    now = digests("*STUDY\n*DECKS\ndata.inp\n*MODES\n1-6\n");
    assert_string_not_equal(first.digest.plan, now.digest.plan);
    assert_string_equal(first.digest.data, now.digest.data);
    (void)bench_write("modes.inc", "*MODES\n1, 398.9\n2, 713.5\n3, 1722\n4, 2480\n5, 3970\n6, 5021\n");
    now = digests("*STUDY\n*DECKS\ndata.inp\n");
    assert_string_equal(first.digest.plan, now.digest.plan);
    assert_string_not_equal(first.digest.decks, now.digest.decks);
    assert_string_not_equal(first.digest.data, now.digest.data);
    (void)bench_write("modes.inc", "** the same again\n" BENCH_MODES);
    now = digests("*STUDY\n*DECKS\ndata.inp\n");
    assert_string_equal(first.digest.decks, now.digest.decks);
    assert_string_equal(first.digest.data, now.digest.data);
}

/* Every memory that a plan and its check ask for runs out once. */
POOL_TEST(running_out_of_memory_is_a_status)
{
    const char *path =
        bench_write("plan.txt", "*STUDY\n*DECKS\ndeck.inp\n*VARIANT, NAME=a\nFIT.TIE=E:G\n*MODES\n1-4\n*SENSORS\nEVERY, 2\n"
                                "*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1e11, 2e11\n*NOISE\n0.001, 0.01\n*HIDE, TYPE=sensor_gain, "
                                "SENSOR=3\ngain, 2\n*STARTS, SPREAD=0.3, COUNT=2\n");
    for (long fail_at = 1;; fail_at += fail_at < 400 ? 1 : 37) {
        struct failing_allocator failing;
        struct message_list messages;
        struct pool pool;
        struct plan plan;
        struct study study;
        failing_allocator_open(&failing, fail_at);
        pool_open(&pool, &failing.allocator);
        message_open(&messages, &pool);
        int status = plan_read(&pool, path, &messages, &plan);
        if (!status)
            status = study_open(&pool, &plan, 0, NULL, 1, &messages, &study);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        if (failing.until_failure > 0) { /* it was never asked for so many */
            assert_status(status, ROTID_OK);
            break;
        }
        assert_status(status, ROTID_ERROR_MEMORY);
    }
}

TEST_GROUP(bench_make, bench_remove);
