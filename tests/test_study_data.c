/* The data of a study: those of the model beside tools/hide, which makes them by other means; faults, noise, sensors, starts;
 * what runs of different cells have in common. */
#include "diagnose/causes/causes.h"
#include "hide/hide.h"
#include "json_value.h"
#include "study/study.h"
#include "study_bench.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define MODEL "*STUDY, REPLICATES=40\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n"

static struct study study;
static struct jobs jobs;

static void open_study(const char *plan)
{
    struct message_list messages;
    int status = bench_study(&test_pool, plan, &messages, &study);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%d:%d: %s\n", messages.item[i].line, messages.item[i].column, messages.item[i].text);
    assert_status(status, ROTID_OK);
    jobs_open(&study, &jobs);
}

static struct experiment make(long run)
{
    struct study_point point = study_locate(&study, run);
    struct message_list messages;
    struct experiment experiment;
    message_open(&messages, &test_pool);
    assert_status(experiment_make(&test_pool, &jobs, &point, &messages, &experiment), ROTID_OK);
    return experiment;
}

static char *text_of(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = calloc(1, 100000);
    assert_true(file && text && fread(text, 1, 99999, file) > 0);
    (void)fclose(file);
    return text;
}

/* Frequencies and shapes of the paper's rotor with something hidden in it, by exact dynamic stiffness: what is left is the mesh.
 */
POOL_TEST(hidden_effects_do_what_exact_dynamics_says)
{
    static const struct {
        const char *card, *spec;
        double shapes; /* tolerance */
    } table[] = {
        {"*HIDE, TYPE=NONE\n", NULL, 2e-3},
        {"*HIDE, TYPE=added_mass\nmass, 10\nz, 1.6\n", "added_mass:mass=10,z=1.6", 2e-3},
        {"*HIDE, TYPE=stiffness, GROUP=left\nfactor, 0.96\n", "stiffness:group=left,factor=0.96", 2e-3},
        {"*HIDE, TYPE=density, GROUP=core\nfactor, 0.94\n", "density:group=core,factor=0.94", 2e-3},
        {"*HIDE, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-9\n", "joint:at=core.start,flexibility=1e-9", 2e-3},
        {"*HIDE, TYPE=support, AT=sling\nfactor, 3\n", "support:at=sling,factor=3", 2e-3},
        {"*HIDE, TYPE=tie_shear, AT=ties\n", "tie_shear:at=ties", 2e-3},
        {"*HIDE, TYPE=stiffness_local\ndepth, 0.5\nz, 0.609\nwidth, 0.05\n", "stiffness_local:depth=0.5,z=0.609,width=0.05",
         1e-2},
        {"*HIDE, TYPE=accelerometer_mass, MOUNT=FIXED, SENSOR=23\nmass, 0.2\n",
         "accelerometer_mass:mass=0.2,mount=fixed,sensor=23", 2e-3},
        {"*HIDE, TYPE=accelerometer_mass\nmass, 0.2\n", "accelerometer_mass:mass=0.2,mount=moving", 2e-3},
        {"*HIDE, TYPE=sensor_position, SENSOR=30\nshift, 0.037\n", "sensor_position:sensor=30,shift=0.037", 2e-3},
        {"*HIDE, TYPE=sensor_line\nshift, 0.01\nscale, 0.99\nflip, 1\n", "sensor_line:flip=1,shift=0.01,scale=0.99", 2e-3},
        {"*HIDE, TYPE=sensor_gain, SENSOR=23\ngain, 0.6\n", "sensor_gain:sensor=23,gain=0.6", 2e-3},
        {"*HIDE, TYPE=sensor_sign, SENSOR=5\n", "sensor_sign:sensor=5", 2e-3},
        {"*HIDE, TYPE=sensor_swap, SENSOR=12,13\n", "sensor_swap:sensors=12+13", 2e-3},
        {"*HIDE, TYPE=duplicate_channel, SENSOR=7,6\n", "duplicate_channel:sensor=7,of=6", 2e-3},
    };
    static const char *const truth[] = {"core.E=1.1e11", "core.G=3.2e10"};
    char *deck = text_of(PAPER);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        char plan[1024], message[600] = "", *made, *json;
        struct hide_request request = hide_request_default();
        request.deck = deck;
        request.frequency_noise = request.shape_noise = 0;
        request.truth = truth;
        request.truths = 2;
        request.effect = &table[i].spec;
        request.effects = table[i].spec != NULL;
        if (hide_case(&request, &made, &json, message, sizeof message))
            fail_msg("%s: %s", table[i].spec, message);
        (void)snprintf(plan, sizeof plan,
                       "*STUDY\n*DECKS\n%s\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.1e11\ncore.G, 3.2e10\n*NOISE\n0, 0\n%s", PAPER,
                       table[i].card);
        open_study(plan);
        struct experiment e = make(0);
        cJSON *object = cJSON_Parse(json);
        const cJSON *with = get(object, "with");
        const int data = table[i].spec && strstr(table[i].spec, "sensor_") == table[i].spec,
                  twice = table[i].spec && strstr(table[i].spec, "duplicate") == table[i].spec;
        double sum = 0;
        for (int k = 0; k < e.job->measurement.nmode; k++) {
            double hz = cJSON_GetArrayItem(get(with, "frequency_hz"), k)->valuedouble, across = 0;
            const cJSON *shape = cJSON_GetArrayItem(get(with, "shape"), k);
            const double *mine = e.job->measurement.shape + (ptrdiff_t)k * e.job->rotor.nsensor;
            assert_close(e.job->measurement.frequency_hz[k], hz, 6e-4, 0); /* the mesh of the deck: 0.043 % of mode 6 */
            for (int s = 0; s < e.job->rotor.nsensor; s++)
                across += mine[s] * cJSON_GetArrayItem(shape, s)->valuedouble;
            /* faults of the data are not in the truth of tools/hide, but in its deck: they are seen below */
            for (int s = 0; s < e.job->rotor.nsensor && !data && !twice; s++) {
                double difference = fabs(copysign(1, across) * mine[s] - cJSON_GetArrayItem(shape, s)->valuedouble);
                sum = fmax(sum, difference);
            }
        }
        if (!(sum <= table[i].shapes))
            fail_msg("%s: shapes differ by %g", table[i].spec, sum);
        if (data || twice) { /* the deck of tools/hide, read back */
            struct message_list messages;
            struct study other;
            (void)bench_write("hidden.inp", made);
            assert_status(bench_study(&test_pool, "*STUDY\n*DECKS\nhidden.inp\n", &messages, &other), ROTID_OK);
            struct jobs others;
            const struct states *states;
            jobs_open(&other, &others);
            const struct study_point point = study_locate(&other, 0);
            assert_status(jobs_fitted(&others, &point.cell, &messages, &states), ROTID_OK);
            const struct job *job = &states->state[0].job;
            for (int k = 0; k < job->measurement.nmode; k++) {
                double across = 0, square = 0;
                const double *a = e.job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor,
                             *b = job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor;
                for (int s = 0; s < job->rotor.nsensor; s++) {
                    across += a[s] * b[s];
                    square += a[s] * a[s];
                }
                for (int s = 0; s < job->rotor.nsensor; s++)
                    assert_close(across / square * a[s], b[s], 0, 2e-3);
            }
            jobs_close(&others);
        }
        cJSON_Delete(object);
        free(made);
        free(json);
        jobs_close(&jobs);
    }
    free(deck);
}

/* A replicate has its noise, whatever the cell fits, keeps or hides. */
POOL_TEST(cells_see_the_same_noise)
{
    open_study(MODEL "*VARIANT, NAME=a\n*VARIANT, NAME=b\nFIT.REDUCTION=GUYAN\n*MODES\n1-4\n1-6\n*SENSORS\nALL\nEVERY, "
                     "1\n*NOISE\n0.001, 0.01\n");
    struct experiment first = make(7);
    const long cell = 40;
    for (long c = 1; c < study.runs / cell; c++) {
        struct experiment e = make(c * cell + 7), other = make(c * cell + 8);
        for (int k = 0; k < 6; k++) {
            assert_true(e.job->measurement.frequency_hz[k] == first.job->measurement.frequency_hz[k]);
            assert_true(other.job->measurement.frequency_hz[k] != first.job->measurement.frequency_hz[k]);
            for (int s = 0; s < 12; s++) /* EVERY rescales, which costs a bit */
                assert_close(e.job->measurement.shape[s + 12 * k] / e.job->measurement.shape[12 * k],
                             first.job->measurement.shape[s + 12 * k] / first.job->measurement.shape[12 * k], 1e-12, 1e-12);
        }
    }
    jobs_close(&jobs);
}

/* Mean and variance of what is added, its independence between modes and sensors, and what the fit is told. */
POOL_TEST(noise_is_what_it_is_said_to_be)
{
    open_study("*STUDY, REPLICATES=2000\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.002, 0.03\n0, 0\n");
    struct experiment clean = make(2000);
    double f1 = 0, f2 = 0, f12 = 0, s1 = 0, s2 = 0;
    for (long run = 0; run < 2000; run++) {
        struct experiment e = make(run);
        double a = (e.job->measurement.frequency_hz[0] / clean.job->measurement.frequency_hz[0] - 1) / 0.002,
               b = (e.job->measurement.frequency_hz[5] / clean.job->measurement.frequency_hz[5] - 1) / 0.002,
               c = (e.job->measurement.shape[4] - clean.job->measurement.shape[4]) / 0.03;
        f1 += a;
        f2 += a * a;
        f12 += a * b;
        s1 += c;
        s2 += c * c;
        assert_true(e.job->measurement.frequency_std[3] == 0.002 && e.job->measurement.shape_std[17] == 0.03);
    }
    /* of 2000: means within 4/sqrt(2000), variances within 4 sqrt(2/2000) */
    assert_close(f1 / 2000, 0, 0, 0.09);
    assert_close(s1 / 2000, 0, 0, 0.09);
    assert_close(f12 / 2000, 0, 0, 0.09);
    assert_close(f2 / 2000, 1, 0.13, 0);
    assert_close(s2 / 2000, 1, 0.13, 0);
    jobs_close(&jobs);
}

/* A start, or a truth, of an unknown that groups share is that of all of them. */
POOL_TEST(a_shared_truth_is_that_of_every_group)
{
    static const char *const truths[] = {"", "*TRUTH\nleft.E=right.E, 1.6e11\n"};
    (void)bench_write("shared.inp",
                      BENCH_BEAM BENCH_MODES "*NOISE, FREQUENCY=0.001\n*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.5e11\n");
    for (int i = 0; i < 2; i++) {
        char plan[512];
        (void)snprintf(plan, sizeof plan, "*STUDY\n*DECKS\nshared.inp\n*DATA, SOURCE=MODEL\n*NOISE\n1e-6\n%s", truths[i]);
        open_study(plan);
        cJSON *result = bench_result(&study, 0);
        assert_close(bench_number(result, "parameters", 0, "value"), i ? 1.6e11 : 1.5e11, 1e-5, 0);
        cJSON_Delete(result);
        jobs_close(&jobs);
    }
}

/* A solver returns an eigenvector with either sign, by its last digits: the data of nearly one rotor have one sign, and the same
 * noise then leaves the same misfit. */
POOL_TEST(nearly_one_rotor_has_the_same_replicates)
{
    double objective = NAN;
    for (int i = 0; i < 4; i++) {
        (void)bench_write("near.inp",
                          pool_format(&test_pool,
                                      "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n%.10f\n*SHAFT, NAME=core, "
                                      "MATERIAL=steel\n1.0, 0.1, 0, 20\n0.5, 0.15, 0, 10\n*SENSORS\n1, 0.1\n2, 0.5\n3, 0.9"
                                      "\n4, 1.3\n*MODES\n1, 100\n2, 200\n3, 300\n*IDENTIFY\ncore.E, 1e10, 1e12, 2e11\n"
                                      "core.G, 1e10, 1e12, 8e10\n",
                                      7850 + 1e-7 * i));
        open_study("*STUDY\n*DECKS\nnear.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.001, 0.02\n");
        cJSON *result = bench_result(&study, 0);
        double found = number_of(result, "objective");
        if (i)
            assert_close(found, objective, 1e-6, 0);
        objective = found;
        cJSON_Delete(result);
        jobs_close(&jobs);
    }
}

/* As what is hidden in it is. */
POOL_TEST(a_truth_is_in_the_units_of_the_deck)
{
    (void)bench_write("units.inp",
                      "*UNITS, LENGTH=MM, MODULUS=GPA, DENSITY=G/CM3, MASS=G\n*MATERIAL, NAME=m\n*ELASTIC\n210, 0.3\n"
                      "*DENSITY\n7.85\n*SHAFT, NAME=a, MATERIAL=m\n1000, 50, 0, 12\n*DISK, NAME=d\n700, 3000\n"
                      "*MODES\n1, 1\n2, 2\n3, 3\n*IDENTIFY\na.E, 100, 300, 200\nd.mass, 100, 9000, 2000\n");
    open_study("*STUDY\n*DECKS\nunits.inp\n*DATA, SOURCE=MODEL, SHAPES=NO\n*TRUTH\na.E, 180\nd.mass, 2500\n*NOISE\n1e-7\n");
    cJSON *result = bench_result(&study, 0);
    assert_close(bench_number(result, "parameters", 0, "value"), 1.8e11, 1e-5, 0);
    assert_close(bench_number(result, "parameters", 1, "value"), 2.5, 1e-5, 0);
    cJSON_Delete(result);
    jobs_close(&jobs);
}

/* Scales read the rotor that the data are of, with its density and the mass that is hidden, within their stated deviations: the
 * weight of the deck is that of another one. */
POOL_TEST(a_model_is_weighed_as_it_is)
{
    static const double pi = 3.14159265358979323846;
    (void)bench_write("weighed.inp",
                      BENCH_BEAM BENCH_MODES BENCH_WANTED "*NOISE, FREQUENCY=0.001\n*WEIGHT\n1, 0.02\n*CENTRE\n0.1, 0.001\n");
    open_study("*STUDY, REPLICATES=1000\n*DECKS\nweighed.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.rho, 7000\n*NOISE\n0.001\n"
               "*HIDE, TYPE=added_mass\nmass, 2\nz, 0.9\n");
    double part[4] = {7850 * pi / 4 * 0.05 * 0.05 * 0.3, 7000 * pi / 4 * 0.1 * 0.1 * 0.4, 7850 * pi / 4 * 0.06 * 0.06 * 0.3, 2},
           at[4] = {0.15, 0.5, 0.85, 0.9}, mass = 0, centre = 0, sum[4] = {0};
    for (int i = 0; i < 4; i++) {
        mass += part[i];
        centre += part[i] * at[i];
    }
    centre /= mass;
    for (long run = 0; run < 1000; run++) {
        const struct weighed w = make(run).job->measurement.weighed;
        double m = (w.mass - mass) / 0.02, z = (w.centre - centre) / 0.001;
        sum[0] += m;
        sum[1] += z;
        sum[2] += m * m;
        sum[3] += z * z;
    }
    for (int i = 0; i < 2; i++) {
        assert_close(sum[i] / 1000, 0, 0, 4 / sqrt(1000));
        assert_close(sum[2 + i] / 1000, 1, 4 * sqrt(2.0 / 1000), 0);
    }
    jobs_close(&jobs);
}

POOL_TEST(noise_adds_to_that_of_measured_data)
{
    (void)bench_write("noisy.inp", BENCH_DECK "*NOISE, FREQUENCY=0.003\n");
    open_study("*STUDY, REPLICATES=3\n*DECKS\nnoisy.inp\n*NOISE\n0.004\n");
    struct experiment e = make(1);
    assert_close(e.job->measurement.frequency_std[0], 0.005, 1e-12, 0);
    assert_true(fabs(e.job->measurement.frequency_hz[0] / 398.9 - 1) < 0.02 && e.job->measurement.frequency_hz[0] != 398.9 &&
                !e.truth);
    jobs_close(&jobs);
    open_study("*STUDY\n*DECKS\ndeck.inp\n*NOISE\n0.004\n"); /* a deck without noise: known now, and so a likelihood */
    e = make(0);
    assert_close(e.job->measurement.frequency_std[0], 0.004, 1e-12, 0);
    assert_int_equal(e.job->options.fit.functional, ROTID_LIKELIHOOD);
    jobs_close(&jobs);
    open_study("*STUDY\n*DECKS\ndeck.inp\n");
    e = make(0);
    assert_true(e.job->measurement.frequency_hz[0] == 398.9 && e.job->options.fit.functional == ROTID_HYBRID);
    jobs_close(&jobs);
}

static int has(const struct job *job, int id)
{
    return sensor_find(job, id) >= 0;
}

/* Fewer sensors of a replicate are some of more, replicates differ, each sensor has its chance, and what is hidden at one stays.
 */
POOL_TEST(sensors_are_drawn_from_all)
{
    open_study(MODEL "*SENSORS\n3\n6\n9\nEVERY, 5\n*NOISE\n0.001, 0.01\n");
    int seen[13] = {0}, differ = 0;
    for (long r = 0; r < 40; r++) {
        struct experiment three = make(r), six = make(40 + r), nine = make(80 + r), fifth = make(120 + r);
        assert_true(three.job->rotor.nsensor == 3 && six.job->rotor.nsensor == 6 && nine.job->rotor.nsensor == 9);
        assert_true(fifth.job->rotor.nsensor == 3 && has(fifth.job, 1) && has(fifth.job, 6) && has(fifth.job, 11));
        for (int s = 0; s < 9; s++) {
            int id = nine.job->rotor.sensor[s].id;
            assert_true(!has(three.job, id) || has(six.job, id));
            seen[id] += has(three.job, id);
            assert_true(s == 0 || nine.job->rotor.sensor[s].position > nine.job->rotor.sensor[s - 1].position);
        }
        for (int s = 0; s < 6; s++)
            assert_true(has(nine.job, six.job->rotor.sensor[s].id));
        differ += !has(three.job, make(0).job->rotor.sensor[0].id);
        /* the noise stays what it is in absolute terms, also where the largest component went */
        int s = sensor_find(nine.job, three.job->rotor.sensor[0].id);
        assert_close(three.job->measurement.shape_std[0] / three.job->measurement.shape[0],
                     nine.job->measurement.shape_std[s] / nine.job->measurement.shape[s], 1e-10, 0);
    }
    assert_true(differ > 10);
    for (int id = 1; id <= 12; id++) /* 10 on average */
        assert_true(seen[id] >= 1 && seen[id] <= 25);
    jobs_close(&jobs);
    open_study(MODEL "*SENSORS\n2\n*NOISE\n0.001, 0.01\n*HIDE, TYPE=sensor_swap, SENSOR=4,9\n");
    for (long r = 0; r < 40; r++) {
        struct experiment e = make(r);
        assert_true(e.job->rotor.nsensor == 2 && has(e.job, 4) && has(e.job, 9));
    }
    jobs_close(&jobs);
}

/* Both that were exchanged, in either order; of a channel that repeats another one, it alone. */
POOL_TEST(a_fault_is_found_where_its_sensors_are)
{
    static const struct {
        const char *card, *id;
        int sensor[2];
        enum score score;
    } table[] = {
        {"sensor_swap, SENSOR=4,9", "sensor_swap", {4, 9}, SCORE_RIGHT},
        {"sensor_swap, SENSOR=4,9", "sensor_swap", {9, 4}, SCORE_RIGHT},
        {"sensor_swap, SENSOR=4,9", "sensor_swap", {4, 5}, SCORE_WRONG},
        {"sensor_swap, SENSOR=4,9", "sensor_swap", {5, 9}, SCORE_WRONG},
        {"sensor_swap, SENSOR=4,9", "duplicate_channel", {4, 9}, SCORE_WRONG},
        {"duplicate_channel, SENSOR=7,6", "duplicate_channel", {7, 5}, SCORE_RIGHT},
        {"duplicate_channel, SENSOR=7,6", "duplicate_channel", {6, 5}, SCORE_WRONG},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        char plan[500];
        rotid_data_finding finding = {.id = table[i].id, .nsensors = 2, .sensors = (int *)table[i].sensor};
        const struct diagnosis d = {.result = {.verdict.kind = ROTID_ADEQUATE, .ndata_findings = 1, .data_findings = &finding}};
        (void)snprintf(plan, sizeof plan, MODEL "*NOISE\n0.001, 0.01\n*HIDE, TYPE=%s\n", table[i].card);
        open_study(plan);
        struct experiment e = make(0);
        assert_int_equal(score_make(&e, &d), table[i].score);
        jobs_close(&jobs);
    }
}

POOL_TEST(starts_lie_around_that_of_the_deck)
{
    (void)bench_write("bounded.inp", BENCH_BEAM BENCH_MODES "*IDENTIFY\ncore.E, 1.5e11, 1e12, 2e11\nleft.E, 1e10, 1e12, 2e11\n");
    open_study("*STUDY\n*DECKS\nbounded.inp\n*STARTS, SPREAD=0.5, GRID=5\n");
    assert_int_equal(study.runs, 25);
    for (long run = 0; run < 25; run++) {
        struct experiment e = make(run);
        assert_close(e.job->unknowns.bounds[0].start, 1.5e11 + 1.5e11 * (double)(run % 5) / 4, 1e-5, 0); /* up to the bound */
        assert_close(e.job->unknowns.bounds[1].start, 1e11 + 2e11 * (double)(run / 5) / 4, 1e-5, 0);
        assert_true(e.job->unknowns.bounds[0].start > e.job->unknowns.bounds[0].lower);
    }
    jobs_close(&jobs);
    open_study("*STUDY, REPLICATES=2\n*DECKS\nbounded.inp\n*STARTS, SPREAD=0.5, COUNT=500\n");
    double least = INFINITY, most = 0, sum = 0;
    for (long run = 0; run < 500; run++) {
        double start = make(run).job->unknowns.bounds[1].start;
        least = fmin(least, start);
        most = fmax(most, start);
        sum += start;
        assert_true(start != make(run + 500).job->unknowns.bounds[1].start);
    }
    assert_true(least > 1e11 && least < 1.02e11 && most < 3e11 && most > 2.98e11);
    assert_close(sum / 500, 2e11, 0, 4 * 2e11 / sqrt(12 * 500));
    jobs_close(&jobs);
}

POOL_TEST(truths_are_drawn_from_their_ranges)
{
    open_study("*STUDY, REPLICATES=500\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1e11, 2e11\nright.E, "
               "1.9e11\n*NOISE\n0\n");
    double least = INFINITY, most = 0, sum = 0;
    for (long run = 0; run < 500; run++) {
        struct experiment e = make(run);
        least = fmin(least, e.truth[0]);
        most = fmax(most, e.truth[0]);
        sum += e.truth[0];
        assert_true(e.truth[1] == 2e11); /* left.E: its start */
    }
    assert_true(least > 1e11 && least < 1.02e11 && most < 2e11 && most > 1.98e11);
    assert_close(sum / 500, 1.5e11, 0, 4 * 1e11 / sqrt(12 * 500));
    jobs_close(&jobs);
}

TEST_GROUP(bench_make, bench_remove);
