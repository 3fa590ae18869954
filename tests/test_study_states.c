/* Studies of decks with several states: what varies acts on the common part and noise on each state; a run fits all at once. */
#include "json_value.h"
#include "result/result.h"
#include "run/run.h"
#include "study/study.h"
#include "study_bench.h"
#include "support.h"

#define STATES                                                                                                                   \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n"      \
    "1.2, 0.08, 0, 24\n*SENSORS\n1, 0\n2, 0.5\n3, end\n*IDENTIFY\ncore.E, 1e11, 3e11, 2e11\n*STATE, NAME=free\n*MODES\n1, 250\n" \
    "2, 680\n3, 1300\n*STATE, NAME=bearings\n*SPRING, NAME=front\n0.1, 2e6\n*SPRING, NAME=rear\n1.1, 1e6\n*MODES\n1, 300\n"      \
    "2, 700\n*IDENTIFY\nfront.k, 1e5, 1e8, 2e6\n"

static struct study study;
static struct jobs jobs;

static void open_study(const char *plan)
{
    static struct message_list messages;
    (void)bench_write("states.inp", STATES);
    assert_status(bench_study(&test_pool, plan, &messages, &study), ROTID_OK);
    jobs_open(&study, &jobs);
}

static struct experiment make(long run)
{
    struct message_list messages;
    struct experiment experiment;
    const struct study_point point = study_locate(&study, run);
    message_open(&messages, &test_pool);
    assert_status(experiment_make(&test_pool, &jobs, &point, &messages, &experiment), ROTID_OK);
    return experiment;
}

/* Data of the model at values that are drawn once for all states: fitted without noise they give these values back. */
POOL_TEST(the_truth_is_that_of_all_states)
{
    open_study("*STUDY, REPLICATES=3\n*DECKS\nstates.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.5e11, 2.5e11\nfront.k, 3e6\n");
    for (long run = 0; run < 3; run++) {
        struct experiment e = make(run);
        struct identification found[2];
        struct message_list notes;
        rotid_fit_result *fit;
        assert_int_equal(e.states.nstate, 2);
        assert_int_equal(e.states.nparameter, 2);
        assert_true(e.truth[0] >= 1.5e11 && e.truth[0] <= 2.5e11);
        assert_close(e.truth[1], 3e6, 1e-14, 0);
        message_open(&notes, &test_pool);
        assert_status(identify_states(&test_pool, &e.states, 0, NULL, &notes, found, &fit), ROTID_OK);
        assert_close(fit->x[0], e.truth[0], 1e-7, 0);
        assert_close(fit->x[1], 3e6, 1e-6, 0);
        rotid_fit_free(fit);
    }
    assert_true(make(0).truth[0] != make(1).truth[0]);
    jobs_close(&jobs);
}

/* The same truth, and noise of its own in each state. */
POOL_TEST(noise_is_that_of_each_state)
{
    const char *same = STATES "*STATE, NAME=again\n*MODES\n1, 250\n2, 680\n3, 1300\n";
    open_study("*STUDY\n*DECKS\nstates.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0\n0.001\n");
    (void)bench_write("states.inp", same);
    jobs_close(&jobs);
    jobs_open(&study, &jobs);
    struct experiment clean = make(0), noisy = make(1);
    assert_int_equal(clean.states.nstate, 3);
    for (int k = 0; k < 3; k++) {
        double r[2];
        for (int i = 0; i < 2; i++) {
            const struct job_measurement *a = &clean.states.state[2 * i].job.measurement,
                                         *b = &noisy.states.state[2 * i].job.measurement;
            r[i] = b->frequency_hz[k] / a->frequency_hz[k] - 1;
            assert_true(r[i] != 0 && fabs(r[i]) < 0.005);
            assert_close(b->frequency_std[k], 0.001, 1e-12, 0);
        }
        assert_close(clean.states.state[0].job.measurement.frequency_hz[k], clean.states.state[2].job.measurement.frequency_hz[k],
                     1e-12, 0);
        assert_true(fabs(r[0] - r[1]) > 1e-6);
    }
    jobs_close(&jobs);
}

/* What is hidden is in all states. */
POOL_TEST(effects_are_hidden_in_all_states)
{
    open_study("*STUDY\n*DECKS\nstates.inp\n*DATA, SOURCE=MODEL\n");
    struct experiment bare = make(0);
    jobs_close(&jobs);
    open_study("*STUDY\n*DECKS\nstates.inp\n*DATA, SOURCE=MODEL\n*HIDE, TYPE=added_mass\nz, 0.6\nmass, 2\n");
    struct experiment with = make(0);
    for (int s = 0; s < 2; s++)
        assert_true(with.states.state[s].job.measurement.frequency_hz[0] <
                    0.999 * bare.states.state[s].job.measurement.frequency_hz[0]);
    jobs_close(&jobs);
}

/* The line of a run: parameters of all, and modes that name their state. */
POOL_TEST(a_run_names_the_state_of_its_modes)
{
    char *text;
    open_study("*STUDY\n*DECKS\nstates.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.001\n");
    assert_status(study_run(&jobs, 0, NULL, &text), ROTID_OK);
    cJSON *json = cJSON_Parse(text);
    const cJSON *modes = get(json, "modes"), *parameters = get(json, "parameters");
    assert_int_equal(cJSON_GetArraySize(modes), 5);
    assert_int_equal(cJSON_GetArraySize(parameters), 2);
    assert_string_equal(get(cJSON_GetArrayItem(parameters, 1), "name")->valuestring, "bearings:front.k");
    assert_close(number_of(get(json, "truth"), "bearings:front.k"), 2e6, 1e-14, 0);
    for (int k = 0; k < 5; k++) {
        const cJSON *mode = cJSON_GetArrayItem(modes, k);
        const cJSON *part = cJSON_GetArrayItem(get(json, "states"), k >= 3), *own = cJSON_GetArrayItem(get(part, "modes"), k % 3);
        assert_string_equal(get(part, "name")->valuestring, k < 3 ? "free" : "bearings");
        assert_close(number_of(mode, "measured_hz"), number_of(own, "measured_hz"), 0, 0);
        assert_int_equal((int)number_of(mode, "mode"), k % 3 + 1);
        assert_true(fabs(number_of(mode, "error_percent")) < 0.5);
    }
    assert_int_equal((int)number_of(json, "sensors"), 6);
    cJSON_Delete(json);
    free(text);
    jobs_close(&jobs);
}

#define ROTOR                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n"      \
    "0.6, 0.08, 0, 12\n*SHAFT, NAME=end, MATERIAL=steel\n0.4, 0.06, 0, 8\n*SENSORS\n1, 0\n2, 0.1\n3, 0.2\n4, 0.3\n5, 0.4\n"      \
    "6, 0.5\n7, 0.7\n8, 0.8\n9, 0.9\n10, end\n*IDENTIFY\ncore.E, 1e11, 3e11, 2e11\n"
#define FOUR "*MODES\n1, 250\n2, 680\n3, 1300\n4, 2000\n"

/* A heavier end, in the data of all states: named once for all, also where one of them is held out; what is held out is
 * predicted, and its modes name it. */
POOL_TEST(all_states_are_diagnosed_together)
{
    static const char *const fit[] = {"", "*FIT, HOLDOUT=STATE:disc\n"};
    static const char plan[] = "*STUDY, COMMAND=DIAGNOSE\n*DECKS\nheavy.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.001, 0.02\n"
                               "*HIDE, TYPE=density, GROUP=end\nfactor, 1.2\n";
    for (int held = 0; held < 2; held++) {
        struct message_list messages;
        char *text;
        (void)bench_write("heavy.inp", pool_format(&test_pool,
                                                   ROTOR "%s*STATE, NAME=free\n" FOUR "*STATE, NAME=disc\n*DISK\n0.3, 5\n" FOUR
                                                         "*STATE, NAME=ring\n*DISK\n0.7, 4\n" FOUR,
                                                   fit[held]));
        assert_status(bench_study(&test_pool, plan, &messages, &study), ROTID_OK);
        jobs_open(&study, &jobs);
        assert_status(study_run(&jobs, 0, NULL, &text), ROTID_OK);
        cJSON *json = cJSON_Parse(text);
        const cJSON *modes = get(json, "modes"), *parameters = get(json, "parameters"),
                    *causes = get(get(json, "verdict"), "causes");
        assert_string_equal(get(json, "score")->valuestring, "right");
        assert_int_equal(cJSON_GetArraySize(causes), 1);
        assert_string_equal(get(cJSON_GetArrayItem(causes, 0), "id")->valuestring, "density");
        assert_true(cJSON_IsNull(get(cJSON_GetArrayItem(causes, 0), "state")));
        assert_int_equal(cJSON_GetArraySize(modes), 12);
        for (int k = 0; k < 12; k++) {
            const cJSON *mode = cJSON_GetArrayItem(modes, k);
            const char *name = get(cJSON_GetArrayItem(get(json, "states"), k / 4), "name")->valuestring;
            assert_string_equal(name, k < 4 ? "free" : k < 8 ? "disc" : "ring");
            assert_int_equal(cJSON_IsTrue(get(mode, "holdout")), held && !strcmp(name, "disc"));
            assert_true(fabs(number_of(mode, "error_percent")) < 0.5);
        }
        const cJSON *factor = cJSON_GetArrayItem(parameters, 1);
        assert_string_equal(get(factor, "name")->valuestring, "density.factor");
        assert_close(number_of(get(json, "truth"), "density.factor"), 1.2, 1e-12, 0);
        assert_true(fabs(number_of(factor, "value") - 1.2) < 4 * number_of(factor, "std"));
        cJSON_Delete(json);
        free(text);
        jobs_close(&jobs);
    }
}

TEST_GROUP(bench_make, bench_remove);
