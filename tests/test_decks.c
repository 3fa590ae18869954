/* What --set and *MEASURED make of a deck; the shipped decks end to end, with the numbers that their headings state. */
#include <unistd.h>

#include "deck/deck.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define INPUT ROTID_SOURCE_DIR "/input/"
#define DECKS ROTID_SOURCE_DIR "/tests/data/decks/"

#define MODEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"

/* *MEASURED with these options, of this universal file */
static void read_measured(struct reading *r, const char *options, const char *uff)
{
    char text[1024];
    (void)folder_write("m.uff", uff);
    (void)snprintf(text, sizeof text, "%s*MEASURED, FILE=m.uff%s\n", MODEL, options);
    (void)folder_write("deck.inp", text);
    read_path(r, folder_path("deck.inp"), NULL);
}

UNIT_TEST(an_override_is_card_option_value)
{
    static const char *const wrong[] = {"", "FIT", "FIT.MODES", "FIT.MODES=", "FIT=NONE", "FIT.=NONE", ".MODES=1", "FIT=a.b"};
    struct pool pool;
    struct override override;
    pool_open(&pool, NULL);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(override_parse(&pool, wrong[i], &override), ROTID_ERROR_SYNTAX);
    assert_int_equal(override_parse(&pool, "MEASURED.FILE=a.b=c.uff", &override), ROTID_OK);
    assert_true(!strcmp(override.card, "MEASURED") && !strcmp(override.option, "FILE"));
    assert_string_equal(override.value, "a.b=c.uff");
    pool_close(&pool);
}

UNIT_TEST(an_override_replaces_or_adds_an_option_on_every_such_card)
{
    struct reading r;
    read_path(&r, DECKS "every_card.inp", "fit.functional=likelihood");
    assert_int_equal(r.job.options.fit.functional, ROTID_LIKELIHOOD);
    pool_close(&r.pool);
    read_path(&r, DECKS "every_card.inp", "TIEROD.MODEL=TUBE");
    assert_true(r.job.rotor.tierod[0].model == BUNDLE_TUBE && r.job.rotor.tierod[1].model == BUNDLE_TUBE);
    pool_close(&r.pool);
    read_path(&r, DECKS "every_card.inp", "SHAFT.MATERIAL=lamination"); /* group 2 is a *BEAM */
    assert_true(r.job.rotor.group[0].material.rho == 7650 && r.job.rotor.group[2].material.rho == 7850);
    pool_close(&r.pool);
    (void)folder_write("deck.inp", MODEL "*MODES\n1, 500\n2, 1300\n3, 2400\n");
    read_path(&r, folder_path("deck.inp"), "FIT.HOLDOUT=2-3"); /* a card of which there can only be one is added */
    assert_true(r.job.measurement.holdout[1] && r.job.measurement.holdout[2] && !r.job.measurement.holdout[0]);
    pool_close(&r.pool);
    read_path(&r, folder_path("deck.inp"), "NOISE.FREQUENCY=0.002");
    assert_true(r.job.options.fit.functional == ROTID_LIKELIHOOD && r.job.measurement.frequency_std[2] == 0.002);
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ measured data */

#define NODE_AT(id, place) "         " id "         0         0         8 " place "\n"
/* nodes 7, 3, 5 and one that no shape knows */
#define NODES(a, b, c) "    -1\n    15\n" NODE_AT("7", a) NODE_AT("3", b) NODE_AT("5", c) NODE_AT("9", ".5 .5 .5") "    -1\n"
#define ALONG_Z        NODES("0 0 0.1", "0 0 0.9", "0 0 0.4")

#define SHAPE(kind, numbers, mode, a, b, c)                                                                                      \
    "    -1\n    55\n1\n2\n3\n4\n5\n" kind "\n" numbers "\n" mode "\n"                                                           \
    "         7\n" a "\n         3\n" b "\n         5\n" c "\n    -1\n"
#define KIND(analysis, characteristic, type, values)                                                                             \
    "         1         " analysis "         " characteristic "         8         " type "         " values
#define NUMBERS(reals, mode) "         2         " reals "         1         " mode
/* three values a node */
#define REAL(mode, hz, damping, a, b, c) SHAPE(KIND("2", "2", "2", "3"), NUMBERS("4", mode), hz " 1. " damping " 0.", a, b, c)
/* one complex value a node */
#define COMPLEX(mode, lambda, a, b, c) SHAPE(KIND("3", "1", "5", "1"), NUMBERS("6", mode), lambda " 1. 0. 1. 0.", a, b, c)

UNIT_TEST(nodes_that_carry_shapes_become_sensors)
{
    struct reading r;
    read_measured(&r, "",
                  ALONG_Z REAL("4", "1300.", "0.", "1. 0. 0.", "-2. 0. 0.", "3. 0. 0.")
                      REAL("2", "500.", "0.02", ".1 0. 0.", ".2 0. 0.", ".3 0. 0."));
    const struct sensor *sensor = r.job.rotor.sensor;
    assert_true(r.job.rotor.nsensor == 3 && r.job.measurement.nmode == 2);
    assert_true(sensor[0].id == 7 && sensor[0].position == 0.1 && sensor[1].id == 5 && sensor[1].position == 0.4);
    assert_true(sensor[2].id == 3 && sensor[2].position == 0.9);
    /* modes by rising frequency, with the numbers of the file where those rise too */
    assert_true(r.job.measurement.frequency_hz[0] == 500 && r.job.measurement.number[0] == 2 &&
                r.job.measurement.damping[0] == 0.02);
    assert_true(r.job.measurement.frequency_hz[1] == 1300 && r.job.measurement.number[1] == 4 &&
                isnan(r.job.measurement.damping[1]));
    static const double shape[] = {.1, .3, .2, 1, 3, -2};
    assert_memory_equal(r.job.measurement.shape, shape, sizeof shape);
    assert_true(isnan(r.job.measurement.frequency_std[0]) && isnan(r.job.measurement.shape_std[0]));
    pool_close(&r.pool);
}

UNIT_TEST(mode_numbers_that_do_not_rise_are_counted_anew)
{
    struct reading r;
    read_measured(&r, "",
                  ALONG_Z REAL("4", "500.", "0.", "1. 0. 0.", "2. 0. 0.", "3. 0. 0.")
                      REAL("1", "1300.", "0.", "1. 0. 0.", "-2. 0. 0.", "3. 0. 0."));
    assert_true(r.job.measurement.nmode == 2 && r.job.measurement.number[0] == 1 && r.job.measurement.number[1] == 2);
    pool_close(&r.pool);
}

UNIT_TEST(axis_origin_scale_and_flip_bring_test_geometry_into_the_model)
{
    static const struct {
        const char *options, *nodes;
        double z[3]; /* of the sensors in order */
        int first;   /* id of the leftmost */
    } expected[] = {{", AXIS=X, SCALE=0.001", NODES("100 0 0", "900 0 0", "400 0 0"), {0.1, 0.4, 0.9}, 7},
                    {", AXIS=Y, ORIGIN=0.05", NODES("0 0.1 0", "0 0.9 0", "0 0.4 0"), {0.15, 0.45, 0.95}, 7},
                    {", FLIP=YES", ALONG_Z, {0.1, 0.6, 0.9}, 3}, /* from the right end */
                    {", FLIP=NO, ORIGIN=-0.1", ALONG_Z, {0, 0.3, 0.8}, 7},
                    {", AXIS=z, flip=yes, SCALE=0.5, ORIGIN=0.5", ALONG_Z, {0.05, 0.3, 0.45}, 3}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char uff[4096];
        struct reading r;
        (void)snprintf(uff, sizeof uff, "%s%s", expected[i].nodes, REAL("1", "500.", "0.", "1. 0. 0.", "2. 0. 0.", "3. 0. 0."));
        read_measured(&r, expected[i].options, uff);
        assert_int_equal(r.job.rotor.nsensor, 3);
        for (int s = 0; s < 3; s++)
            assert_close(r.job.rotor.sensor[s].position, expected[i].z[s], 1e-14, 1e-15);
        assert_int_equal(r.job.rotor.sensor[0].id, expected[i].first);
        pool_close(&r.pool);
    }
}

UNIT_TEST(direction_chooses_the_component_of_a_shape)
{
    static const char *const options[] = {"", ", DIRECTION=X", ", DIRECTION=Y", ", DIRECTION=z"};
    static const double shape[][3] = {{1, 7, 4}, {1, 7, 4}, {2, 8, 5}, {3, 9, 6}};
    for (int i = 0; i < 4; i++) {
        struct reading r;
        read_measured(&r, options[i], ALONG_Z REAL("1", "500.", "0.", "1. 2. 3.", "4. 5. 6.", "7. 8. 9."));
        assert_memory_equal(r.job.measurement.shape, shape[i], sizeof shape[i]);
        pool_close(&r.pool);
    }
}

UNIT_TEST(complex_shapes_are_turned_real_and_conjugates_dropped)
{
    struct reading r; /* (1, 2, -1) times 3 + 4i, in the order of the file 7, 3, 5; the eigenvalue is -30 +- 3000i */
    read_measured(&r, ", DIRECTION=Y",
                  ALONG_Z COMPLEX("1", "-30. 3000.", "3. 4.", "-3. -4.", "6. 8.")
                      COMPLEX("2", "-30. -3000.", "3. -4.", "-3. 4.", "6. -8."));
    assert_int_equal(r.job.measurement.nmode, 1);
    assert_close(r.job.measurement.frequency_hz[0], hypot(30, 3000) / 6.283185307179586, 1e-14, 0);
    assert_close(r.job.measurement.damping[0], 30 / hypot(30, 3000), 1e-14, 0);
    assert_close(fabs(r.job.measurement.shape[0]), 5, 1e-14, 0);
    assert_close(r.job.measurement.shape[1] / r.job.measurement.shape[0], 2, 1e-14, 0); /* its sign is free */
    assert_close(r.job.measurement.shape[2] / r.job.measurement.shape[0], -1, 1e-14, 0);
    assert_true(warns(&r.messages, "1 shapes repeat the frequency of another and are left out, as conjugates of it"));
    assert_false(warns(&r.messages, "out of phase"));
    pool_close(&r.pool);
}

/* Of modes at 0 Hz, of conjugates with numbers of their own and with those of their partners; 4 is missing. */
UNIT_TEST(numbers_of_a_file_do_not_count_modes_that_are_left_out)
{
    struct reading r;
    read_measured(&r, "",
                  ALONG_Z REAL("1", "0.", "0.", "1. 0. 0.", "1. 0. 0.", "1. 0. 0.")
                      REAL("2", "0.", "0.", "1. 0. 0.", "2. 0. 0.", "3. 0. 0.")
                          REAL("3", "500.", "0.", "1. 0. 0.", "2. 0. 0.", "3. 0. 0.")
                              REAL("5", "900.", "0.", "1. 0. 0.", "-2. 0. 0.", "3. 0. 0."));
    assert_int_equal(r.job.measurement.nmode, 2);
    assert_int_equal(r.job.measurement.number[0], 1);
    assert_int_equal(r.job.measurement.number[1], 3);
    pool_close(&r.pool);
    for (int own = 0; own < 2; own++) {
        read_measured(&r, ", DIRECTION=Y",
                      own ? ALONG_Z COMPLEX("1", "-30. 3000.", "3. 4.", "-3. -4.", "6. 8.")
                                COMPLEX("2", "-30. -3000.", "3. -4.", "-3. 4.", "6. -8.")
                                    COMPLEX("3", "-30. 5000.", "3. 4.", "3. 4.", "6. 8.")
                                        COMPLEX("4", "-30. -5000.", "3. -4.", "3. -4.", "6. -8.")
                          : ALONG_Z COMPLEX("1", "-30. 3000.", "3. 4.", "-3. -4.", "6. 8.")
                                COMPLEX("1", "-30. -3000.", "3. -4.", "-3. 4.", "6. -8.")
                                    COMPLEX("2", "-30. 5000.", "3. 4.", "3. 4.", "6. 8.")
                                        COMPLEX("2", "-30. -5000.", "3. -4.", "3. -4.", "6. -8."));
        assert_int_equal(r.job.measurement.nmode, 2);
        assert_int_equal(r.job.measurement.number[0], 1);
        assert_int_equal(r.job.measurement.number[1], 2);
        pool_close(&r.pool);
    }
}

UNIT_TEST(motion_out_of_phase_is_left_out_and_said)
{
    struct reading r;
    read_measured(&r, "", ALONG_Z COMPLEX("1", "-30. 3000.", "2. 0.", "0. 1.", "2. 0."));
    assert_true(fabs(fabs(r.job.measurement.shape[0]) - 2) < 1e-14 && fabs(r.job.measurement.shape[2]) < 1e-14);
    assert_true(warns(&r.messages, "11 % of the motion of the shape at 477.489 Hz is out of phase and left out"));
    pool_close(&r.pool);
}

UNIT_TEST(sensors_of_the_deck_place_a_file_without_nodes)
{
    struct reading r;
    read_measured(&r, "\n*SENSORS\n3, 0.2\n5, 0.5\n7, end\n8, 0", REAL("1", "500.", "0.", "1. 0. 0.", "2. 0. 0.", "3. 0. 0."));
    assert_int_equal(r.job.rotor.nsensor, 4);
    assert_true(isnan(r.job.measurement.shape[0]) && r.job.measurement.shape[1] == 2 && r.job.measurement.shape[2] == 3 &&
                r.job.measurement.shape[3] == 1);
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ shipped decks */

struct run {
    struct reading reading;
    struct identification result;
    const rotid_fit_result *fit;
    double fitted_rms, held_rms; /* percent */
};

static double error_percent(const struct run *run, int k)
{
    return 100 * (run->fit->predicted_hz[k] / run->reading.job.measurement.frequency_hz[k] - 1);
}

static void open_run(struct run *run, const char *path, const char *set)
{
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    read_path(&run->reading, path, set);
    const struct job *job = &run->reading.job;
    assert_status(identify_run(&run->reading.pool, job, 0, NULL, &run->reading.messages, &run->result), ROTID_OK);
    run->fit = run->result.fit;
    assert_true(run->fit->converged && !run->fit->any_at_bound && !run->fit->any_undetermined);
    for (int k = 0; k < job->measurement.nmode; k++) {
        sum[job->measurement.holdout[k]] += error_percent(run, k) * error_percent(run, k);
        count[job->measurement.holdout[k]]++;
    }
    run->fitted_rms = sqrt(sum[0] / count[0]);
    run->held_rms = sqrt(sum[1] / count[1]);
}

static void close_run(struct run *run)
{
    rotid_fit_free(run->result.fit);
    pool_close(&run->reading.pool);
}

UNIT_TEST(paper_rotor_gives_the_moduli_of_the_paper)
{
    static const double errors[] = {-4.4, 8.2, 2.7, -1.0, -3.9, -0.7};
    struct run run;
    open_run(&run, INPUT "paper_rotor.inp", NULL);
    assert_close(run.fit->x[0], 1.157e11, 0.01, 0);
    assert_close(run.fit->x[1], 0.316e11, 0.01, 0);
    for (int k = 0; k < 6; k++)
        assert_close(error_percent(&run, k), errors[k], 0, 0.3);
    assert_close(run.result.mass.mass, 998, 0, 0.5);
    assert_close(run.result.mass.center, 1.0594, 0, 0.001);
    close_run(&run);
}

UNIT_TEST(tying_g_to_e_fits_the_paper_rotor_worse)
{
    struct run run, tied;
    open_run(&run, INPUT "paper_rotor.inp", NULL);
    open_run(&tied, INPUT "paper_rotor.inp", "FIT.TIE=E:G");
    assert_int_equal(tied.fit->n, 1);
    assert_true(tied.fit->objective > 1.05 * run.fit->objective);
    close_run(&run);
    close_run(&tied);
}

UNIT_TEST(one_modulus_leaves_the_joint_and_the_foam_in_the_errors)
{
    struct run run;
    open_run(&run, INPUT "brake_reuss_beam.inp", NULL);
    assert_close(run.fitted_rms, 12.5, 0, 0.2);
    assert_close(run.held_rms, 14.3, 0, 0.2);
    close_run(&run);
    open_run(&run, INPUT "foam_bar.inp", NULL);
    assert_close(run.fitted_rms, 0.47, 0, 0.02);
    assert_close(error_percent(&run, 0), -0.97, 0, 0.02); /* the foam is soft, not absent */
    close_run(&run);
}

UNIT_TEST(roving_hammer_beam_determines_e_and_hardly_g)
{
    struct run run;
    double width[2];
    open_run(&run, INPUT "roving_hammer_beam.inp", NULL);
    for (int p = 0; p < 2; p++)
        width[p] = (run.fit->ci_upper[p] - run.fit->ci_lower[p]) / run.fit->x[p];
    assert_true(run.fit->x[0] > 2.0e11 && run.fit->x[0] < 2.2e11);
    assert_true(width[0] > 0 && width[1] > 3 * width[0]);
    close_run(&run);
}

UNIT_TEST(solid_rotor_widens_its_intervals_and_pairs_by_shape)
{
    struct run run;
    open_run(&run, INPUT "solid_rotor.inp", NULL);
    assert_true(run.fit->x[0] < 0.85 * 1.05e11 && run.fit->x[1] < 0.85 * 0.47e11); /* of the truth: the beam's own error */
    assert_true(run.reading.job.options.fit.functional == ROTID_LIKELIHOOD && run.fit->widened_by > 1 &&
                run.result.shapes_fitted);
    for (int k = 0; k < 6; k++)
        assert_int_equal(run.result.compared.basis[k], PAIRED_BY_SHAPE);
    close_run(&run);
}

/* Bricks are 0.4 to 0.7 % high, and a fit takes that for stiffer moduli. */
UNIT_TEST(data_of_bricks_make_moduli_high)
{
    struct run bricks, converged;
    open_run(&bricks, INPUT "bricks_rotor.inp", NULL);
    open_run(&converged, INPUT "converged_rotor.inp", NULL);
    assert_close(converged.fit->x[0], 1.05e11, 0.015, 0);
    assert_close(converged.fit->x[1], 0.47e11, 0.015, 0);
    assert_close(bricks.fit->x[0], 1.05e11, 0.025, 0);
    for (int p = 0; p < 2; p++)
        assert_true(bricks.fit->x[p] > 1.015 * converged.fit->x[p]);
    close_run(&converged);
    close_run(&bricks);
}

/* What `rotid modes` compares: errors [6] of the model as it stands; returns their root mean square. */
static double model_errors(const char *path, double *error)
{
    struct reading r;
    struct spectrum spectrum;
    struct comparison compared;
    double sum = 0;
    read_path(&r, path, NULL);
    assert_int_equal(r.job.measurement.nmode, 6);
    assert_status(spectrum_compute(&r.pool, r.job.models, &r.job.rotor, 0, NULL, NULL, ROTID_REDUCTION_NONE, 6 + 3, &spectrum),
                  ROTID_OK);
    assert_status(comparison_make(&r.pool, &r.job, &spectrum, &r.messages, &compared), ROTID_OK);
    for (int k = 0; k < 6; k++) {
        error[k] = 100 * (spectrum.full_hz[compared.number[k] - 1] / r.job.measurement.frequency_hz[k] - 1);
        sum += error[k] * error[k];
    }
    pool_close(&r.pool);
    return sqrt(sum / 6);
}

UNIT_TEST(a_stiffness_diameter_at_the_steps_halves_the_error_of_the_beam)
{
    double plain[6], cone[6], rms = model_errors(INPUT "solid_steel.inp", plain);
    for (int k = 0; k < 6; k++)
        assert_true(plain[k] > 3 && plain[k] < 7.5); /* a beam is too stiff where the diameter steps */
    assert_true(model_errors(INPUT "solid_steel_stiff.inp", cone) < rms / 2);
}

/* At the E and G that the deck states as identified. */
UNIT_TEST(a_solid_explains_the_paper_rotor_better_than_its_beam)
{
    static const double expected[] = {-0.4, -1.2, 0.7, 1.4, 0.1, -2.3};
    double error[6], rms = model_errors(INPUT "paper_rotor_solid.inp", error);
    for (int k = 0; k < 6; k++)
        assert_close(error[k], expected[k], 0, 0.1);
    assert_true(rms < 1.3); /* the beam: 4.3 */
}

TEST_GROUP(folder_make, folder_remove);
