/* Runs: the same whoever computes them, right where the truth is known, failed where they fail. */
#include "json_value.h"
#include "result/result.h"
#include "study/study.h"
#include "study_bench.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

static struct study study;

static void open_study(const char *plan)
{
    struct message_list messages;
    int status = bench_study(&test_pool, plan, &messages, &study);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%d:%d: %s\n", messages.item[i].line, messages.item[i].column, messages.item[i].text);
    assert_status(status, ROTID_OK);
}

static const char *word(const cJSON *json, const char *key)
{
    assert_true(cJSON_IsString(get(json, key)));
    return get(json, key)->valuestring;
}

POOL_TEST(a_run_does_not_depend_on_the_runs_before_it)
{
    struct jobs jobs;
    open_study(
        "*STUDY, REPLICATES=2, BASELINE=YES\n*DECKS\ndeck.inp\n*VARIANT, NAME=a\n*VARIANT, NAME=b\nFIT.REDUCTION=GUYAN\n"
        "*MODES\n1-4\n1-6\n*SENSORS\nALL\n12\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.9e11, 2.1e11\n*NOISE\n0.001, 0.01\n"
        "*HIDE, TYPE=NONE\n*HIDE, TYPE=sensor_position, SENSOR=4\nshift, 0.01, 0.02\n*HIDE, TYPE=added_mass\nmass, 0.1, 0.3\n"
        "z, 0, 1\n*STARTS, SPREAD=0.2, COUNT=2\n");
    jobs_open(&study, &jobs);
    for (long i = 0; i < study.runs; i++) { /* all over the place, each beside a fresh one */
        long run = (i * 37 + 5) % study.runs;
        char *line;
        assert_status(study_run(&jobs, run, NULL, &line), ROTID_OK);
        cJSON *one = cJSON_Parse(line), *other = i % 4 ? NULL : bench_result(&study, run);
        assert_string_equal(word(one, "status"), "converged");
        assert_true(number_of(one, "run") == (double)run);
        free(line);
        cJSON_DeleteItemFromObject(one, "seconds");
        cJSON_DeleteItemFromObject(other, "seconds");
        assert_true(!other || cJSON_Compare(one, other, 1));
        cJSON_Delete(one);
        cJSON_Delete(other);
    }
    jobs_close(&jobs);
}

POOL_TEST(exact_data_give_back_the_truth)
{
    open_study(
        "*STUDY, REPLICATES=5\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1e11, 3e11\nleft.E, 1.5e11, 2.5e11\n");
    for (long run = 0; run < 5; run++) {
        cJSON *result = bench_result(&study, run);
        for (int p = 0; p < 2; p++)
            assert_close(bench_number(result, "parameters", p, "value"), bench_truth(result, p), 1e-7, 0);
        assert_true(number_of(result, "objective") < 1e-16);
        cJSON_Delete(result);
    }
}

/* With the stated noise the estimates scatter as the fits state, without bias, and their intervals hold the truth. */
POOL_TEST(estimates_scatter_as_they_are_said_to)
{
    enum { N = 400 };
    struct jobs jobs;
    double sum[2] = {0}, square[2] = {0}, stated[2] = {0};
    int covered[2] = {0};
    open_study("*STUDY, REPLICATES=400, SEED=3\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.002, 0.02\n");
    jobs_open(&study, &jobs);
    for (long run = 0; run < N; run++) {
        char *line;
        assert_status(study_run(&jobs, run, NULL, &line), ROTID_OK);
        cJSON *result = cJSON_Parse(line);
        free(line);
        for (int p = 0; p < 2; p++) {
            const cJSON *interval = get(cJSON_GetArrayItem(get(result, "parameters"), p), "ci95");
            double truth = bench_truth(result, p), error = bench_number(result, "parameters", p, "value") - truth;
            sum[p] += error;
            square[p] += error * error;
            stated[p] += bench_number(result, "parameters", p, "std") / N;
            covered[p] +=
                cJSON_GetArrayItem(interval, 0)->valuedouble <= truth && truth <= cJSON_GetArrayItem(interval, 1)->valuedouble;
        }
        cJSON_Delete(result);
    }
    jobs_close(&jobs);
    for (int p = 0; p < 2; p++) {
        double std = sqrt(square[p] / N);
        print_message("parameter %d: std %.4g, stated %.4g, bias %.2g std, covered %d of %d\n", p, std, stated[p],
                      sum[p] / N / std, covered[p], N);
        assert_close(sum[p] / N, 0, 0, 4 * std / sqrt(N));
        assert_close(std / stated[p], 1, 0, 0.15);            /* chi: 4/sqrt(2 N) */
        assert_close((double)covered[p] / N, 0.95, 0, 0.045); /* binomial: 4 sqrt(0.95 0.05/N) */
    }
}

/* Figure 12: every start within 70 % leads to one minimum. */
POOL_TEST(every_start_of_the_paper_reaches_the_minimum)
{
    struct jobs jobs;
    open_study("*STUDY\n*DECKS\n" PAPER "\n*STARTS, SPREAD=0.7, GRID=5\n");
    assert_int_equal(study.runs, 25);
    jobs_open(&study, &jobs);
    for (long run = 0; run < 25; run++) {
        char *line;
        assert_status(study_run(&jobs, run, NULL, &line), ROTID_OK);
        cJSON *result = cJSON_Parse(line);
        free(line);
        assert_close(number_of(result, "objective"), 0.02305273403, 1e-8, 0);
        assert_close(bench_number(result, "parameters", 0, "value"), 1.15706e11, 1e-5, 0);
        /* the way there: from the start to the end, both parameters after each iteration */
        const cJSON *way = get(result, "history");
        int count = cJSON_GetArraySize(way);
        assert_close(count, number_of(result, "iterations") + 1, 0, 0);
        for (int p = 0; p < 2; p++) {
            const cJSON *first = get(cJSON_GetArrayItem(way, 0), "x"), *last = get(cJSON_GetArrayItem(way, count - 1), "x");
            assert_close(cJSON_GetArrayItem(first, p)->valuedouble, bench_number(result, "parameters", p, "start"), 1e-8, 0);
            assert_close(cJSON_GetArrayItem(last, p)->valuedouble, bench_number(result, "parameters", p, "value"), 1e-8, 0);
        }
        cJSON_Delete(result);
    }
    jobs_close(&jobs);
}

/* The paper's orthotropic and isotropic cores by the first m modes; what is not fitted is predicted. */
POOL_TEST(variants_and_modes_are_those_of_the_deck)
{
    open_study("*STUDY\n*DECKS\n" PAPER "\n*VARIANT, NAME=two\n*VARIANT, NAME=one\nFIT.TIE=E:G\n*MODES\n1-2\n1-6\n");
    static const int parameters[] = {2, 2, 1, 1}, fitted[] = {2, 6, 2, 6};
    double objective[4];
    for (long run = 0; run < 4; run++) {
        cJSON *result = bench_result(&study, run);
        int count = 0;
        for (int k = 0; k < 6; k++)
            count += !cJSON_IsTrue(get(cJSON_GetArrayItem(get(result, "modes"), k), "holdout"));
        assert_int_equal(count, fitted[run]);
        assert_int_equal(cJSON_GetArraySize(get(result, "parameters")), parameters[run]);
        assert_string_equal(word(get(result, "cell"), "variant"), run < 2 ? "two" : "one");
        assert_string_equal(word(get(result, "cell"), "modes"), run % 2 ? "1-6" : "1-2");
        objective[run] = number_of(result, "objective");
        cJSON_Delete(result);
    }
    assert_true(objective[0] < objective[1] && objective[2] < objective[3] && objective[1] < objective[3]);
    assert_close(objective[1], 0.02305273403, 1e-8, 0);
}

POOL_TEST(a_hidden_mass_is_named)
{
    open_study("*STUDY, COMMAND=DIAGNOSE, REPLICATES=2\n*DECKS\n" PAPER
               "\n*VARIANT, NAME=full\nFIT.REDUCTION=NONE\n*SENSORS\nEVERY, 3\n"
               "*DATA, SOURCE=MODEL\n*NOISE\n0.001, 0.01\n*HIDE, TYPE=added_mass\nmass, 12, 16\nz, 0.1, 0.4\n"
               "*HIDE, TYPE=sensor_gain, SENSOR=22\ngain, 1.5\n*HIDE, TYPE=NONE\n");
    for (long run = 0; run < study.runs; run++) {
        cJSON *result = bench_result(&study, run);
        const char *hidden = word(get(result, "cell"), "hide"), *score = word(result, "score");
        print_message("%s: %s, %s\n", hidden, word(get(result, "verdict"), "kind"), score);
        if (!strcmp(hidden, "none")) {
            assert_true(!strcmp(score, "quiet") || !strcmp(score, "false_alarm"));
            assert_true(cJSON_IsNull(get(result, "hidden")));
        } else {
            assert_string_equal(score, "right");
        }
        if (!strcmp(hidden, "added_mass")) {
            const cJSON *cause = cJSON_GetArrayItem(get(get(result, "verdict"), "causes"), 0);
            double mass = bench_number(get(result, "hidden"), "parameters", 0, "value"),
                   found = bench_number(cause, "parameters", 0, "value");
            assert_true(mass >= 12 && mass <= 16);
            assert_close(found, mass, 0, 5 * bench_number(cause, "parameters", 0, "std"));
            assert_close(bench_truth(result, 2), mass, 0, 0); /* added_mass.mass of the extended model */
        }
        cJSON_Delete(result);
    }
}

/* A shaft on stiff pins: every critical speed goes with the root of E, whose truth makes that of the speeds; exact data. */
POOL_TEST(critical_speeds_are_those_of_the_machine_and_of_its_truth)
{
    static const char deck[] = "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, "
                               "20\n*MODES\n1, 200\n2, 600\n*IDENTIFY\na.E, 1e9, 1e13, 2e11\n*RUNNING\n*BEARING\nstart, 1e13, "
                               "0\n*BEARING\nend, 1e13, 0\n*OPERATION, MARGIN=0.1\n2000, 12000\n";
    double speed[2] = {0, 0}, modulus[2] = {0, 0};
    (void)bench_write("machine.inp", deck);
    open_study("*STUDY, COMMAND=SPEEDS, REPLICATES=2, DRAWS=30\n*DECKS\nmachine.inp\n*DATA, SOURCE=MODEL\n*TRUTH\na.E, 1.6e11, "
               "2.4e11\n*NOISE\n0.001\n");
    for (long run = 0; run < study.runs; run++) {
        cJSON *result = bench_result(&study, run), *first = NULL, *one;
        assert_string_equal(word(result, "status"), "converged");
        cJSON_ArrayForEach(one, get(result, "critical_speeds")) if (!first && !strcmp(word(one, "whirl"), "forward")) first = one;
        double w = number_of(first, "speed_rpm"), std = number_of(first, "std"),
               e = bench_number(result, "parameters", 0, "value"), std_e = bench_number(result, "parameters", 0, "std");
        const cJSON *truth = get(result, "truth");
        modulus[run] = number_of(truth, "a.E");
        speed[run] = number_of(truth, "forward:1");
        assert_close(w / speed[run], sqrt(e / modulus[run]), 1e-5, 0);
        assert_close(std / w, std_e / e / 2, 0.5, 0); /* of 30 draws */
        assert_true(cJSON_GetArraySize(get(first, "ci95")) == 2 && cJSON_IsNumber(get(get(first, "margin"), "probability")));
        cJSON_Delete(result);
    }
    assert_close(speed[0] / speed[1], sqrt(modulus[0] / modulus[1]), 1e-5, 0);
    open_study("*STUDY, COMMAND=SPEEDS\n*DECKS\ndeck.inp\n");
    cJSON *result = bench_result(&study, 0);
    assert_string_equal(word(result, "status"), "failed");
    assert_non_null(strstr(word(result, "error"), "no *RUNNING"));
    cJSON_Delete(result);
}

/* A mode that has the shape of another one which has none, a model that cannot be: a result that says why. */
POOL_TEST(what_cannot_be_computed_says_why)
{
    (void)bench_write("unpaired.inp",
                      BENCH_BEAM BENCH_SENSORS "*MODES\n1, 398.9\n2, 713.5\n3, 1722\n" BENCH_WANTED
                                               "*SHAPE, MODE=1\n1, 1\n2, 0.4\n3, -0.1\n4, -0.4\n5, -0.2\n6, 0\n7, 0.2\n"
                                               "8, 0.4\n9, 0.1\n10, -0.1\n11, -0.4\n12, -0.9\n");
    open_study("*STUDY\n*DECKS\nunpaired.inp\n");
    cJSON *result = bench_result(&study, 0);
    assert_string_equal(word(result, "status"), "failed");
    assert_non_null(strstr(word(result, "error"), "measured mode 2 at 713.5 Hz is left without a mode of the model"));
    cJSON_Delete(result);
    open_study("*STUDY\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1e-25\n");
    result = bench_result(&study, 0);
    assert_string_equal(word(result, "status"), "failed");
    assert_true(strlen(word(result, "error")) > 10);
    cJSON_Delete(result);
}

static int stop_at_once(void *context)
{
    (void)context;
    return 1;
}

POOL_TEST(a_cancelled_run_leaves_no_line)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = stop_at_once};
    struct jobs jobs;
    char *line = (char *)"";
    open_study("*STUDY\n*DECKS\ndeck.inp\n");
    jobs_open(&study, &jobs);
    assert_status(study_run(&jobs, 0, &environment, &line), ROTID_STOP_CANCELLED);
    assert_null(line);
    jobs_close(&jobs);
}

POOL_TEST(seeds_change_the_noise_alone)
{
    open_study("*STUDY\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.001\n0\n");
    cJSON *noisy = bench_result(&study, 0), *clean = bench_result(&study, 1);
    study.seed = 2;
    cJSON *other = bench_result(&study, 0), *same = bench_result(&study, 1);
    assert_true(bench_number(noisy, "modes", 0, "measured_hz") != bench_number(other, "modes", 0, "measured_hz"));
    assert_true(bench_number(clean, "modes", 0, "measured_hz") == bench_number(same, "modes", 0, "measured_hz"));
    cJSON_Delete(noisy);
    cJSON_Delete(clean);
    cJSON_Delete(other);
    cJSON_Delete(same);
}

TEST_GROUP(bench_make, bench_remove);
