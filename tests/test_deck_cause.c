/* CAUSE cards: every type into the right numbers of a job, faults of the measurement chain taken out of the data, and parameters
 * of causes identified. Wrong cards: tests/data/decks/wrong. */
#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "folder.h"
#include "modal/modal.h"
#include "model/model.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define EVERY_CAUSE ROTID_SOURCE_DIR "/tests/data/decks/every_cause.inp"

#define MODEL                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"                                                             \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 12\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0, 16\n"                  \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.06, 0, 12\n"
#define FREQUENCIES "*MODES\n1, 400\n2, 715\n3, 1720\n"
#define NOISE       "*NOISE, FREQUENCY=0.001, SHAPE=0.01\n"

static struct reading every;

/* ------------------------------------------------------------------------------------------------ cards */

UNIT_TEST(every_physical_cause_becomes_an_effect_of_its_kind)
{
    static const struct {
        const char *name, *id;
        int target, variant;
        double value[4];
    } expected[] = {
        {"cone", "step_stiffness", -1, 0, {30}},
        {"tilt", "stiffness_gradient", 1, 0, {-0.1}},
        {"bulge", "stiffness_profile", 1, 0, {0.2}},
        {"crack", "stiffness_local", -1, 1, {0.5, 0.3, 0.05}},
        {"soft", "stiffness_local", -1, 0, {0, 1, 0.03}},
        {"shear", "stiffness_local", -1, 3, {0.1, 0.5, 0.04, 0.6}},
        {"fit", "joint", 0, 0, {1e-9}},
        {"bolts", "joint", 1, 0, {0}},
        {"bearing", "support", 1, 0, {1.5}},
        {"away", "support_position", 0, 0, {0.02}},
        {"cord", "support_extra", -1, 0, {2000, 0.4}},
        {"bush", "support_rotation", -1, 0, {50, 0.8}},
        {"vice", "clamp", 1, 0, {1e-7, 0}},
        {"lump", "added_mass", -1, 0, {0.25, 0.7}},
        {"tape", "added_mass", -1, 1, {0.1, 0.6, 0.05}},
        {"blades", "added_inertia", 0, 0, {-5e-5}},
        {"turned", "diameter", 0, 0, {1.01}},
        {"heavy", "density", 0, 0, {1.02}},
        {"stiff", "stiffness", 2, 0, {0.9}},
        {"fitted", "layer_slip", 3, 0, {0.03}},
        {"hubs", "hub_stiffness", -1, 0, {0.7}},
        {"rods", "tie_stiffness", 0, 0, {0.8}},
        {"loose", "tie_tension", 0, 0, {0.5}},
        {"free", "tie_shear", 0, 0, {0}},
        {"k", "shear_coefficient", 2, 0, {1.1}},
        {"cable", "accelerometer_mass", -1, 0, {0.02}},
        {"probe", "accelerometer_mass", 2, 1, {0.03}},
    };
    const struct rotor *rotor = &every.job.rotor;
    int seen[64] = {0};
    assert_int_equal(rotor->neffect, sizeof expected / sizeof *expected);
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        const struct cause_kind *kind = catalogue_of(effect);
        assert_non_null(kind);
        assert_string_equal(effect->name, expected[i].name);
        assert_string_equal(kind->id, expected[i].id);
        assert_int_equal(effect->target, expected[i].target);
        assert_int_equal(effect->variant, expected[i].variant);
        for (int p = 0; p < effect_parameters(effect); p++)
            assert_true(effect->value[p] == expected[i].value[p]);
        for (int c = 0; c < catalogue_count(); c++)
            seen[c] |= catalogue_item(c) == kind;
    }
    for (int c = 0; c < catalogue_count(); c++) /* a new cause belongs into that deck */
        assert_true(seen[c] || catalogue_item(c)->class != CAUSE_PHYSICAL || catalogue_item(c)->solid);
    assert_int_equal(rotor->sensor[2].id, 30);
}

UNIT_TEST(every_fault_of_the_measurement_chain_becomes_a_correction)
{
    static const struct correction expected[] = {
        {.name = "gain", .id = "sensor_gain", .nsensor = 1, .sensor = {20}, .value = 1.5},
        {.name = "sign", .id = "sensor_sign", .nsensor = 1, .sensor = {50}, .value = 1},
        {.name = "swap", .id = "sensor_swap", .nsensor = 2, .sensor = {20, 60}, .value = 1},
        {.name = "moved", .id = "sensor_position", .nsensor = 1, .sensor = {30}, .value = 0.02},
        {.name = "copy", .id = "duplicate_channel", .nsensor = 2, .sensor = {40, 30}, .value = 1},
        {.name = "loud", .id = "noise_level", .block = "SHAPE", .value = 2},
        {.name = "quiet", .id = "noise_level", .block = "FREQUENCY", .value = 0.5},
        {.name = "line", .id = "sensor_line", .value = 0.001, .more = {0.999, 0}},
    };
    int seen[64] = {0};
    assert_int_equal(every.job.measurement.ncorrection, sizeof expected / sizeof *expected);
    for (int i = 0; i < every.job.measurement.ncorrection; i++) {
        const struct correction *c = &every.job.measurement.correction[i];
        assert_string_equal(c->name, expected[i].name);
        assert_string_equal(c->id, expected[i].id);
        assert_true(c->value == expected[i].value && c->nsensor == expected[i].nsensor);
        assert_memory_equal(c->sensor, expected[i].sensor, sizeof c->sensor);
        assert_memory_equal(c->more, expected[i].more, sizeof c->more);
        assert_true(!c->block == !expected[i].block && (!c->block || !strcmp(c->block, expected[i].block)));
        for (int k = 0; k < catalogue_count(); k++)
            seen[k] |= catalogue_item(k) == catalogue_find(c->id);
    }
    for (int k = 0; k < catalogue_count(); k++)
        assert_true(seen[k] || catalogue_item(k)->class != CAUSE_DATA || !catalogue_item(k)->correct);
}

UNIT_TEST(a_suspect_is_no_part_of_the_model)
{
    const struct suspect *suspect = every.job.unknowns.suspect;
    struct parameter parameter;
    const char *unit;
    assert_int_equal(every.job.unknowns.nsuspect, 3);
    assert_string_equal(suspect[0].effect.name, "maybe");
    assert_true(catalogue_of(&suspect[0].effect) == catalogue_find("stiffness_local") && suspect[0].effect.variant == 0);
    assert_true(!suspect[0].fixed[0] && suspect[0].fixed[1] && !suspect[0].fixed[2]);
    assert_true(suspect[0].effect.value[1] == 0.45 && suspect[0].effect.value[0] == 0 && suspect[0].effect.value[2] > 0);
    assert_true(suspect[1].effect.target == 1 && !suspect[1].fixed[0]);
    assert_true(suspect[2].effect.target == 0 && suspect[2].fixed[0] && suspect[2].effect.value[0] == 0.99);
    assert_int_equal(parameter_find(&every.job.rotor, "maybe.depth", &parameter, &unit), 1);
}

UNIT_TEST(an_interface_is_named_by_its_groups_or_its_position)
{
    static const char *const forms[] = {"BETWEEN=left,core", "BETWEEN=Core , LEFT", "AT=left.end", "AT=core.start", "AT=0.3",
                                        "AT=0.300001"};
    struct reading r;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        char text[1024];
        (void)snprintf(text, sizeof text, MODEL "*CAUSE, NAME=j, TYPE=JOINT, %s\nflexibility, 1e-9\n", forms[i]);
        read_text(&r, text, NULL);
        assert_true(r.job.rotor.neffect == 1 && r.job.rotor.effect[0].target == 0);
        pool_close(&r.pool);
    }
    read_text(&r, MODEL "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core, SUSPECT\n", "CAUSE.BETWEEN=core,right");
    assert_true(r.job.unknowns.nsuspect == 1 && r.job.unknowns.suspect[0].effect.target == 1);
    pool_close(&r.pool);
    read_text(&r, MODEL "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core, SUSPECT\nflexibility, 1e-9\n", "CAUSE.SUSPECT=NO");
    assert_true(r.job.unknowns.nsuspect == 0 && r.job.rotor.neffect == 1 && r.job.rotor.effect[0].target == 0);
    pool_close(&r.pool);
}

UNIT_TEST(groups_called_by_numbers_are_an_interface_too)
{
    struct reading r;
    read_text(&r,
              "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=1, MATERIAL=steel\n0.5, 0.1, 0, 10\n"
              "*SHAFT, NAME=2, MATERIAL=steel\n0.5, 0.1, 0, 10\n*CAUSE, NAME=j, TYPE=joint, BETWEEN=1,2, SUSPECT\n",
              NULL);
    assert_true(r.job.unknowns.nsuspect == 1 && r.job.unknowns.suspect[0].effect.target == 0);
    pool_close(&r.pool);
}

UNIT_TEST(a_cause_that_changes_nothing_is_warned_about)
{
    struct reading r;
    read_text(&r,
              MODEL "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n6, 0.01, 0.04, 1e3\n"
                    "*CAUSE, NAME=c, TYPE=tie_shear, AT=ties\n",
              NULL);
    assert_true(warns(&r.messages, "cause c of TYPE=tie_shear changes nothing here"));
    pool_close(&r.pool);
}

/* One shaft written as one, three and twenty sections: the first mode is 0.09 % low, 0.13 % high, and right where the box ends
 * with its sections, and the column mesh says 0.02 % at most. */
POOL_TEST(a_box_that_ends_inside_a_section_of_a_solid_is_warned_about)
{
    static const struct {
        const char *shaft, *rest, *shape;
        int warned;
    } table[] = {{"1, 0.1\n", "*FIT, MODEL=SOLID\n", "BOX", 1},
                 {"1, 0.1\n", "*FIT, MODEL=SOLID\n", "box", 1},
                 {"0.45, 0.1\n0.1, 0.1\n0.45, 0.1\n", "*FIT, MODEL=SOLID\n", "BOX", 0},
                 {"1, 0.1, 0, 10\n", "", "BOX", 0}};
    for (int i = 0; i < 4; i++) {
        struct reading r;
        read_text(&r,
                  pool_format(
                      &test_pool,
                      "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, MATERIAL=m\n%s%s*CAUSE, NAME=c, "
                      "TYPE=stiffness_local, SHAPE=%s\ndepth, 0.6\nz, 0.5\nwidth, 0.1\n",
                      table[i].shaft, table[i].rest, table[i].shape),
                  NULL);
        assert_int_equal(r.job.rotor.neffect, 1);
        assert_int_equal(warns(&r.messages, "this zone ends inside a section"), table[i].warned);
        pool_close(&r.pool);
    }
}

/* ------------------------------------------------------------------------------------------------ faults of the data */

#define SENSORS 6
#define MODES   3

/* Three shapes at six sensors with noise, the largest component of each at another sensor; some not measured. */
static void write_data(char *text, size_t size, const double *position)
{
    static const double shape[MODES][SENSORS] = {
        {1.9, 0.4, -0.7, -0.9, 0.3, 1.5}, {-0.8, 0.5, 0.4, -0.3, -0.6, 1.1}, {0.9, -1.3, NAN, 0.2, -0.5, 0.7}};
    size_t used = (size_t)snprintf(text, size, MODEL "*SENSORS\n");
    for (int s = 0; s < SENSORS; s++)
        used += (size_t)snprintf(text + used, size - used, "%d, %.17g\n", s + 1, position[s]);
    used += (size_t)snprintf(text + used, size - used, FREQUENCIES NOISE);
    for (int k = 0; k < MODES; k++) {
        used += (size_t)snprintf(text + used, size - used, "*SHAPE, MODE=%d\n", k + 1);
        for (int s = 0; s < SENSORS; s++)
            if (isfinite(shape[k][s]))
                used += (size_t)snprintf(text + used, size - used, "%d, %.17g, %.17g\n", s + 1, shape[k][s], 0.01 + 0.002 * s);
    }
}

static const double stated[SENSORS] = {0, 0.2, 0.35, 0.6, 0.81, 1};

static void read_data(struct reading *r, const double *position, const char *cards)
{
    char text[4096];
    write_data(text, sizeof text, position);
    assert_true(strlen(text) + strlen(cards) < sizeof text);
    read_text(r, strcat(text, cards), NULL);
}

/* The residuals that a fit of the job sees, and the predicted shapes at its sensors; returns their number. */
static int residuals(struct reading *r, double *residual, double predicted[MODES][SENSORS])
{
    struct job *job = &r->job;
    struct rotor_model *client = POOL_NEW(&r->pool, struct rotor_model);
    struct functional f;
    int failed;
    assert_status(model_open(&r->pool, NULL, &job->rotor, 0, NULL, 1, client, &failed), ROTID_OK);
    rotid_measured *measured = POOL_NEW(&r->pool, rotid_measured);
    *measured = (rotid_measured){.size = sizeof *measured,
                                 .nmode = MODES,
                                 .number = job->measurement.number,
                                 .frequency_hz = job->measurement.frequency_hz,
                                 .frequency_std = job->measurement.frequency_std,
                                 .shape = job->measurement.shape,
                                 .shape_std = job->measurement.shape_std};
    assert_status(
        functional_new(&r->pool, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON, &client->equations, measured, &f),
        ROTID_OK);
    assert_status(functional_residual(&f, NULL, residual), ROTID_OK);
    for (int k = 0; k < MODES; k++)
        for (int s = 0; s < job->rotor.nsensor; s++)
            predicted[k][s] = prediction_at_sensor(&f.prediction, f.pair[k], s);
    return f.nresidual;
}

/* chi2 of mode k: data as read, scaled to a largest component of 1, against a times gain times the prediction of sensor from[s]
 */
static double chi2_of_faulty_prediction(const struct job_raw *raw, int k, const double *predicted, const double *gain,
                                        const int *from)
{
    const double *shape = raw->shape + (ptrdiff_t)k * SENSORS, *std = raw->shape_std + (ptrdiff_t)k * SENSORS;
    double largest = 0, b = 0, c = 0, sum = 0;
    for (int s = 0; s < SENSORS; s++)
        if (isfinite(shape[s]))
            largest = fmax(largest, fabs(shape[s]));
    for (int pass = 0; pass < 2; pass++)
        for (int s = 0; s < SENSORS; s++) {
            double value = shape[s] / largest, model = gain[s] * predicted[from[s]];
            if (!isfinite(value) || gain[s] == 0)
                continue;
            double misfit = (b / c * model - value) / std[s];
            if (pass)
                sum += misfit * misfit;
            b += pass ? 0 : model * value / (std[s] * std[s]);
            c += pass ? 0 : model * model / (std[s] * std[s]);
        }
    return sum;
}

/* The likelihood of the corrected job is that of a prediction with the faults in it, of the data as read. */
static void assert_same_likelihood(const char *cards, const double *gain, const int *from)
{
    struct reading r;
    double residual[MODES + MODES * SENSORS], predicted[MODES][SENSORS];
    read_data(&r, stated, cards);
    int count = residuals(&r, residual, predicted), row = MODES;
    for (int k = 0; k < MODES; k++) {
        double sum = 0;
        for (int s = 0; s < SENSORS; s++)
            if (isfinite(r.job.measurement.shape[s + k * SENSORS])) {
                sum += residual[row] * residual[row];
                row++;
            }
        assert_close(sum, chi2_of_faulty_prediction(r.job.measurement.raw, k, predicted[k], gain, from), 1e-11, 0);
    }
    assert_int_equal(row, count);
    pool_close(&r.pool);
}

static const int own[SENSORS] = {0, 1, 2, 3, 4, 5};

UNIT_TEST(a_gain_weighs_as_a_prediction_times_gain_would)
{
    /* of the largest component, so that another one is the largest; of a small one, so that it becomes the largest */
    assert_same_likelihood("*CAUSE, NAME=g, TYPE=sensor_gain, SENSOR=1\ngain, 3\n", (double[]){3, 1, 1, 1, 1, 1}, own);
    assert_same_likelihood("*CAUSE, NAME=g, TYPE=sensor_gain, SENSOR=2\ngain, 0.1\n", (double[]){1, 0.1, 1, 1, 1, 1}, own);
    assert_same_likelihood("*CAUSE, NAME=g, TYPE=sensor_gain, SENSOR=6\ngain, 1\n", (double[]){1, 1, 1, 1, 1, 1}, own);
}

UNIT_TEST(a_reversed_a_swapped_and_a_repeated_channel_weigh_as_the_fault_in_the_prediction)
{
    assert_same_likelihood("*CAUSE, NAME=s, TYPE=sensor_sign, SENSOR=1\n", (double[]){-1, 1, 1, 1, 1, 1}, own);
    /* channel 2 reads what sensor 3 sees, which was not measured in mode 3, and the other way round */
    assert_same_likelihood("*CAUSE, NAME=s, TYPE=sensor_swap, SENSOR=2,3\n", (double[]){1, 1, 1, 1, 1, 1},
                           (int[]){0, 2, 1, 3, 4, 5});
    assert_same_likelihood("*CAUSE, NAME=s, TYPE=duplicate_channel, SENSOR=1,2\n", (double[]){0, 1, 1, 1, 1, 1}, own);
}

UNIT_TEST(several_faults_are_taken_out_one_after_the_other)
{
    assert_same_likelihood("*CAUSE, NAME=a, TYPE=sensor_gain, SENSOR=1\ngain, 4\n"
                           "*CAUSE, NAME=b, TYPE=duplicate_channel, SENSOR=6,5\n"
                           "*CAUSE, NAME=c, TYPE=sensor_gain, SENSOR=4\ngain, 0.2\n"
                           "*CAUSE, NAME=d, TYPE=sensor_sign, SENSOR=1\n",
                           (double[]){-4, 1, 1, 0.2, 1, 0}, own);
}

UNIT_TEST(a_level_of_noise_scales_the_residuals_of_its_block)
{
    struct reading plain, shape, frequency;
    double a[MODES * (SENSORS + 1)], b[MODES * (SENSORS + 1)], c[MODES * (SENSORS + 1)], predicted[MODES][SENSORS];
    read_data(&plain, stated, "");
    read_data(&shape, stated, "*CAUSE, NAME=n, TYPE=noise_level, AT=shape\nfactor, 2\n");
    read_data(&frequency, stated, "*CAUSE, NAME=n, TYPE=noise_level, AT=FREQUENCY\nfactor, 0.5\n");
    int count = residuals(&plain, a, predicted);
    assert_int_equal(residuals(&shape, b, predicted), count);
    assert_int_equal(residuals(&frequency, c, predicted), count);
    for (int i = 0; i < count; i++) {
        assert_close(b[i], i < MODES ? a[i] : a[i] / 2, 1e-12, 1e-12);
        assert_close(c[i], i < MODES ? 2 * a[i] : a[i], 1e-12, 1e-12);
    }
    assert_null(plain.job.measurement.raw);
    pool_close(&plain.pool);
    pool_close(&shape.pool);
    pool_close(&frequency.pool);
}

UNIT_TEST(a_shift_is_the_deck_with_the_sensor_at_its_true_place)
{
    /* 0.35 + 0.3 passes the sensor at 0.6: the order changes */
    static const double truth[SENSORS] = {0, 0.2, 0.65, 0.6, 0.81, 1};
    struct reading moved, right;
    double a[MODES * (SENSORS + 1)], b[MODES * (SENSORS + 1)], predicted[MODES][SENSORS];
    read_data(&moved, stated, "*CAUSE, NAME=p, TYPE=sensor_position, SENSOR=3\nshift, 0.3\n");
    read_data(&right, truth, "");
    int count = residuals(&moved, a, predicted);
    assert_int_equal(residuals(&right, b, predicted), count);
    for (int i = 0; i < count; i++)
        assert_close(a[i], b[i], 1e-9, 1e-9);
    for (int s = 0; s < SENSORS; s++)
        assert_int_equal(moved.job.rotor.sensor[s].id, right.job.rotor.sensor[s].id);
    pool_close(&moved.pool);
    pool_close(&right.pool);
}

UNIT_TEST(a_shifted_sensor_keeps_a_node_of_its_own_inside_the_rotor)
{
    static const struct {
        double shift, place; /* of sensor 3, at 0.35 */
    } expected[] = {{0.25, 0.6}, {0.2501, 0.6}, {0.2499, 0.6}, {-0.15, 0.2}, {0.65, 1}, {0.9, 1}, {-0.9, 0}, {1e-4, 0.35}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char card[128];
        struct reading r;
        struct mesh mesh;
        (void)snprintf(card, sizeof card, "*CAUSE, NAME=p, TYPE=sensor_position, SENSOR=3\nshift, %g\n", expected[i].shift);
        read_data(&r, stated, card);
        const struct rotor *rotor = &r.job.rotor;
        assert_close(rotor->sensor[sensor_find(&r.job, 3)].position, expected[i].place, 0, 0.025 * 0.025);
        assert_status(mesh_build(&r.pool, rotor, 1, &mesh), ROTID_OK);
        for (int s = 1; s < SENSORS; s++)
            assert_true(rotor->sensor[s].position > rotor->sensor[s - 1].position &&
                        mesh.sensor_node[s] > mesh.sensor_node[s - 1]);
        pool_close(&r.pool);
    }
}

UNIT_TEST(what_was_read_is_kept_and_effects_follow_their_sensors)
{
    struct reading plain, faulty;
    read_data(&plain, stated, "");
    read_data(&faulty, stated,
              "*CAUSE, NAME=a, TYPE=accelerometer_mass, MOUNT=FIXED, SENSOR=3\nmass, 0.01\n"
              "*CAUSE, NAME=b, TYPE=accelerometer_mass, MOUNT=FIXED, SENSOR=4, SUSPECT\n"
              "*CAUSE, NAME=p, TYPE=sensor_position, SENSOR=3\nshift, 0.3\n"
              "*CAUSE, NAME=g, TYPE=sensor_gain, SENSOR=1\ngain, 3\n");
    const struct job_raw *raw = faulty.job.measurement.raw;
    assert_true(raw && raw->nsensor == SENSORS);
    assert_memory_equal(raw->sensor, plain.job.rotor.sensor, SENSORS * sizeof *raw->sensor);
    assert_memory_equal(raw->shape_std, plain.job.measurement.shape_std, MODES * SENSORS * sizeof *raw->shape_std);
    assert_memory_equal(raw->frequency_std, plain.job.measurement.frequency_std, MODES * sizeof *raw->frequency_std);
    for (int i = 0; i < MODES * SENSORS; i++)
        assert_true(raw->shape[i] == plain.job.measurement.shape[i] ||
                    (isnan(raw->shape[i]) && isnan(plain.job.measurement.shape[i])));
    const struct rotor *rotor = &faulty.job.rotor;
    assert_int_equal(rotor->sensor[rotor->effect[0].target].id, 3);
    assert_int_equal(rotor->sensor[faulty.job.unknowns.suspect[0].effect.target].id, 4);
    pool_close(&plain.pool);
    pool_close(&faulty.pool);
}

UNIT_TEST(a_correction_without_its_sensor_is_refused)
{
    struct reading r;
    read_data(&r, stated, "");
    struct correction c = {.name = "c", .id = "sensor_gain", .nsensor = 1, .sensor = {9}, .value = 2};
    assert_status(correction_apply(&r.pool, &r.job, &c), ROTID_ERROR_ARGUMENT);
    c.sensor[0] = 1;
    c.value = 0;
    assert_status(correction_apply(&r.pool, &r.job, &c), ROTID_ERROR_ARGUMENT);
    c.id = "mode_pairing";
    assert_status(correction_apply(&r.pool, &r.job, &c), ROTID_ERROR_ARGUMENT);
    c.id = "no_cause";
    assert_status(correction_apply(&r.pool, &r.job, &c), ROTID_ERROR_ARGUMENT);
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ identification */

/* Frequencies of a deck with the truth become the data of one that starts elsewhere; its parameters are found again. */
static void assert_found(const char *truth, const char *deck, const double *expected, double rtol)
{
    struct reading r;
    struct spectrum spectrum;
    struct identification result;
    char text[4096];
    read_text(&r, truth, NULL);
    assert_status(spectrum_compute(&r.pool, NULL, &r.job.rotor, 0, NULL, NULL, ROTID_GUYAN, 6, &spectrum), ROTID_OK);
    size_t used = (size_t)snprintf(text, sizeof text, "%s*MODES\n", deck);
    for (int k = 0; k < 6; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%d, %.17g\n", k + 1, spectrum.full_hz[k]);
    pool_close(&r.pool);
    read_text(&r, text, NULL);
    assert_status(identify_run(&r.pool, &r.job, 0, NULL, &r.messages, &result), ROTID_OK);
    assert_true(result.fit->converged && !result.fit->any_at_bound && !result.fit->any_undetermined);
    for (int p = 0; p < r.job.unknowns.nparameter; p++)
        assert_close(result.fit->x[p], expected[p], rtol, 0);
    rotid_fit_free(result.fit);
    pool_close(&r.pool);
}

UNIT_TEST(parameters_of_causes_are_identified_beside_moduli)
{
    assert_found(MODEL "*CAUSE, NAME=bolts, TYPE=joint, BETWEEN=left,core\nflexibility, 4e-7\n",
                 MODEL "*CAUSE, NAME=bolts, TYPE=joint, BETWEEN=left,core\nflexibility, 0\n"
                       "*IDENTIFY\ncore.E, 1e10, 4e11, 1.8e11\nBolts.Flexibility, 0, 1e-6, 1e-7\n",
                 (double[]){2.1e11, 4e-7}, 1e-6);
    /* two components of one effect; a slope below zero with a lower bound below zero */
    assert_found(MODEL "*CAUSE, NAME=lump, TYPE=added_mass\nmass, 0.5\nz, 0.8\n"
                       "*CAUSE, NAME=tilt, TYPE=stiffness_gradient, GROUP=core\nslope, -0.2\n",
                 MODEL "*CAUSE, NAME=lump, TYPE=added_mass\nmass, 0\nz, core.end\n"
                       "*CAUSE, NAME=tilt, TYPE=stiffness_gradient, GROUP=core\nslope, 0\n"
                       "*IDENTIFY\nlump.mass, 0, 0.8, 0.3\nlump.z, 0.7, 1, 0.78\ntilt.slope, -0.5, 0.5, -0.1\n",
                 (double[]){0.5, 0.8, -0.2}, 1e-5);
}

UNIT_TEST(a_cause_that_stands_in_the_deck_is_part_of_the_model)
{
    struct reading r;
    struct spectrum plain, effect, suspected;
    read_text(&r, MODEL, NULL);
    assert_status(spectrum_compute(&r.pool, NULL, &r.job.rotor, 0, NULL, NULL, ROTID_GUYAN, 3, &plain), ROTID_OK);
    double hz = plain.full_hz[0];
    pool_close(&r.pool);
    read_text(&r, MODEL "*CAUSE, NAME=j, TYPE=joint, AT=core.end\nflexibility, 5e-7\n", NULL);
    assert_status(spectrum_compute(&r.pool, NULL, &r.job.rotor, 0, NULL, NULL, ROTID_GUYAN, 3, &effect), ROTID_OK);
    assert_true(effect.full_hz[0] < 0.99 * hz);
    pool_close(&r.pool);
    read_text(&r, MODEL "*CAUSE, NAME=j, TYPE=joint, AT=core.end, SUSPECT\nflexibility, 5e-7\n", NULL);
    assert_status(spectrum_compute(&r.pool, NULL, &r.job.rotor, 0, NULL, NULL, ROTID_GUYAN, 3, &suspected), ROTID_OK);
    assert_true(suspected.full_hz[0] == hz);
    pool_close(&r.pool);
}

UNIT_TEST(a_suspect_states_where_its_size_is_looked_for)
{
    struct reading r;
    read_text(&r, MODEL "*CAUSE, NAME=m, TYPE=added_mass, SUSPECT\nmass, 0.01, 0.4\nz, 0.3\n", NULL);
    const struct suspect *suspect = r.job.unknowns.suspect;
    assert_int_equal(r.job.unknowns.nsuspect, 1);
    assert_true(suspect->effect.bound[0] == 0.01 && suspect->effect.bound[1] == 0.4);
    assert_true(!suspect->fixed[0] && suspect->fixed[1] && suspect->effect.value[1] == 0.3);
    pool_close(&r.pool);
}

/* A value beyond the bounds is told with bounds in the unit in which it was written. */
POOL_TEST(bounds_are_told_in_the_units_of_the_deck)
{
    static const char *const text[3] = {"*CAUSE, NAME=c, TYPE=stiffness_local, SHAPE=BOX\ndepth, 0.3\nz, 500\nwidth, 0.2\n",
                                        "*CAUSE, NAME=m, TYPE=added_mass, SHAPE=BOX, SUSPECT\nwidth, 10\nmass, 1, 1e6\nz, 300\n",
                                        "*CAUSE, NAME=m, TYPE=added_mass, SHAPE=BOX\nmass, 100\nz, 300\nwidth, 10\n"
                                        "*IDENTIFY\nm.width, 0, 600, 50\n"},
                             *const told[3] = {"width is 0.2, expected a value from 10 to 250",
                                               "expected the lower one first and both from 0 to 15413.4",
                                               "are 0 and 600, expected them inside 0 to 500"};
    for (int i = 0; i < 3; i++) {
        struct reading r;
        try_path(&r,
                 folder_write("bounds.inp",
                              pool_format(&test_pool,
                                          "*UNITS, LENGTH=MM, MASS=G\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n"
                                          "7850\n*SHAFT, NAME=left, MATERIAL=steel\n1000, 50, 0, 12\n%s",
                                          text[i])),
                 NULL);
        assert_non_null(find_message(&r.messages, told[i]));
        pool_close(&r.pool);
    }
}

/* L/14 = 94.857142857142857... mm in fifteen digits lies above that bound; a value off by more is no rounding. */
POOL_TEST(a_bound_in_another_unit_is_that_bound)
{
    static const struct {
        const char *width, *upper, *more, *told;
    } cases[] = {{"94.8571428571429", "94.8571428571429", "", NULL},
                 {"20", "94.8571428571429", "*SET\nc.width, 94.8571428571429\n", NULL},
                 {"94.857143", "94", "", "width is 94.857143, expected a value from 6.64 to 94.8571"},
                 {"20", "94.857143", "", "the bounds of c.width are 7 and 94.857143, expected them inside 6.64 to 94.8571"},
                 {"20", "94", "*SET\nc.width, 94.857143\n", "c.width is 94.857143, expected a value from 6.64 to 94.8571"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct reading r;
        try_path(
            &r,
            folder_write("bounds.inp",
                         pool_format(&test_pool,
                                     "*UNITS, LENGTH=MM\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                     "*SHAFT, NAME=left, MATERIAL=steel\n1328, 50, 0, 12\n*CAUSE, NAME=c, "
                                     "TYPE=stiffness_local\ndepth, 0.3\nz, 500\nwidth, %s\n*IDENTIFY\nc.width, 7, %s, 30\n%s",
                                     cases[i].width, cases[i].upper, cases[i].more)),
            NULL);
        assert_int_equal(r.messages.errors, cases[i].told != NULL);
        if (cases[i].told)
            assert_non_null(find_message(&r.messages, cases[i].told));
        pool_close(&r.pool);
    }
}

/* ------------------------------------------------------------------------------------------------ faults of the world */

UNIT_TEST(without_memory_nothing_leaks)
{
    struct failing_allocator failing;
    long fail_at = 0;
    int status;
    do {
        struct pool pool;
        struct message_list messages;
        struct job job;
        failing_allocator_open(&failing, ++fail_at);
        pool_open(&pool, &failing.allocator);
        message_open(&messages, &pool);
        status = deck_read(&pool, EVERY_CAUSE, 0, NULL, &messages, &job);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        assert_true(failing.until_failure > 0 || status == ROTID_ERROR_MEMORY);
    } while (failing.until_failure == 0);
    assert_status(status, ROTID_OK);
}

UNIT_TEST(a_deck_of_causes_with_one_wrong_byte_gets_an_answer)
{
    static char text[16384];
    struct random_stream stream = {17};
    FILE *source = fopen(EVERY_CAUSE, "rb");
    assert_non_null(source);
    size_t length = fread(text, 1, sizeof text, source);
    (void)fclose(source);
    assert_true(length > 1000 && length < sizeof text);
    int good = 0;
    for (int i = 0; i < 2000; i++) {
        size_t at = (size_t)((double)length * random_uniform(&stream));
        char kept = text[at], *path = (char *)folder_path("deck.inp");
        struct pool pool;
        struct message_list messages;
        struct job job;
        text[at] = (char)(32 + (int)(95 * random_uniform(&stream)));
        FILE *stream_out = fopen(path, "wb");
        assert_non_null(stream_out);
        assert_true(fwrite(text, 1, length, stream_out) == length && fclose(stream_out) == 0);
        text[at] = kept;
        pool_open(&pool, NULL);
        message_open(&messages, &pool);
        int status = deck_read(&pool, path, 0, NULL, &messages, &job);
        assert_true(status == ROTID_OK || status == ROTID_ERROR_SYNTAX || status == ROTID_ERROR_SECTION);
        assert_true((status == ROTID_OK) == (messages.errors == 0));
        good += status == ROTID_OK;
        pool_close(&pool);
    }
    assert_true(good > 0 && good < 2000);
}

static int open_all(void **state)
{
    read_path(&every, EVERY_CAUSE, NULL);
    return folder_make(state);
}

static int close_all(void **state)
{
    pool_close(&every.pool);
    return folder_remove(state);
}

/* A slender bored shaft is turned to 1.02 of its diameter: as the cause, and as the drawing. Shear coefficient and rotary inertia
 * of the cause follow the area, which leaves 1e-5 of a mode at 40 diameters. */
UNIT_TEST(a_diameter_cause_is_the_shaft_of_that_diameter)
{
    double hz[2][3];
    for (int drawn = 0; drawn < 2; drawn++) {
        char text[512];
        (void)snprintf(
            text, sizeof text,
            "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=s\n4, %s, 0.08, 60\n%s",
            drawn ? "0.102" : "0.1", drawn ? "" : "*CAUSE, NAME=thick, TYPE=diameter, GROUP=bar\nfactor, 1.02\n");
        read_frequencies(text, ROTID_BENDING, 3, hz[drawn]);
    }
    for (int k = 0; k < 3; k++)
        assert_close(hz[0][k], hz[1][k], 1e-4, 0);
}

TEST_GROUP(open_all, close_all);
