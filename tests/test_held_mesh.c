/* A fit of a solid runs on its coarse mesh with frequencies held to the limit that this mesh and the one that counts lead to:
 * beside fits that use no coarse mesh, and beside frequencies of meshes that are refined. */
#include "folder.h"
#include "reading.h"
#include "solid_rig.h"

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "model/model.h"
#include "run/run.h"
#include "support.h"

#define SENSORS 9
#define MODES   4

/* A step up and a step down; E and G of the core are wanted. */
static const char rotor_text[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n"
                                 "*MATERIAL, NAME=stack\n*ELASTIC, TYPE=LAMINATED\n1e11, 0.4e11, 1.9e11, 0.28\n*DENSITY\n7650\n"
                                 "*SHAFT, NAME=left, MATERIAL=steel\n0.25, 0.10, 0, 20\n"
                                 "*SHAFT, NAME=core, MATERIAL=stack\n0.35, 0.20, 0, 20\n"
                                 "*SHAFT, NAME=right, MATERIAL=steel\n0.20, 0.08, 0, 20\n*FIT, MODEL=SOLID\n";

/* x: of the unknowns; NULL: at what the deck states */
static void compute(const struct job *job, const double *x, int parts, struct spectrum *spectrum)
{
    assert_status(spectrum_compute_parts(&test_pool, job->models, &job->rotor, x ? job->unknowns.nparameter : 0,
                                         job->unknowns.parameter, x, ROTID_GUYAN, MODES, parts, spectrum),
                  ROTID_OK);
}

/* *MODES with that option and shapes, each number `share` of 0.1 and 1 % off. */
static void put_modes(char *text, const char *option, const struct spectrum *s, int shapes, double share)
{
    static const double off[MODES] = {1, -0.7, 0.4, -1.2};
    (void)sprintf(text + strlen(text), "*NOISE, FREQUENCY=0.001%s\n*MODES%s\n", shapes ? ", SHAPE=0.01" : "", option);
    for (int k = 0; k < MODES; k++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", k + 1, s->full_hz[k] * (1 + 0.001 * share * off[k]));
    for (int k = 0; k < MODES && shapes; k++) {
        (void)sprintf(text + strlen(text), "*SHAPE, MODE=%d\n", k + 1);
        for (int i = 0; i < SENSORS; i++)
            (void)sprintf(text + strlen(text), "%d, %.17g\n", i + 1,
                          s->shape[k * SENSORS + i] + 0.01 * share * off[(3 * i + k) % MODES]);
    }
}

/* Modes of the rotor itself, off by 0.1 and 1 % to both sides: a misfit that no E and G take away. */
static void measured_job(int shapes, struct job *job)
{
    char text[16384];
    struct message_list quiet;
    struct spectrum s;
    strcpy(text, rotor_text);
    if (shapes)
        strcat(text, "*SENSORS\n");
    for (int i = 0; i < SENSORS && shapes; i++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", i + 1, 0.8 * (i + 0.5) / SENSORS);
    read_job(text, &quiet, job);
    compute(job, NULL, SPECTRUM_MESH, &s);
    put_modes(text, "", &s, shapes, 1);
    strcat(text, "*IDENTIFY\ncore.E, 1e10, 4e11, 0.6e11\ncore.G, 1e10, 1.5e11, 0.7e11\n");
    read_job(text, &quiet, job);
}

/* Through rotid_fit on the mesh that counts alone, the measured frequencies, frequency_hz [MODES], being as far above the limit
 * as those of the mesh are at x. */
static rotid_fit_result *fit_fine(const struct job *job, const double *x, double *frequency_hz)
{
    const struct job_measurement *m = &job->measurement;
    struct rotor_model model;
    struct spectrum limit, mesh;
    rotid_fit_result *fit;
    int failed;
    compute(job, x, SPECTRUM_MESH, &limit);
    compute(job, x, 0, &mesh);
    for (int k = 0; k < MODES; k++)
        frequency_hz[k] = m->frequency_hz[k] * mesh.full_hz[k] / limit.full_hz[k];
    assert_status(
        model_open(&test_pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1, &model, &failed),
        ROTID_OK);
    const rotid_measured measured = {.size = sizeof measured,
                                     .nmode = m->nmode,
                                     .number = m->number,
                                     .frequency_hz = frequency_hz,
                                     .frequency_std = m->frequency_std,
                                     .shape = m->shape,
                                     .shape_std = m->shape_std};
    assert_status(rotid_fit(&model.equations, job->unknowns.bounds, &measured, &job->options.fit, NULL, NULL, &fit), ROTID_OK);
    return fit;
}

POOL_TEST(a_fit_on_the_coarse_mesh_is_that_of_the_mesh_that_counts)
{
    for (int shapes = 0; shapes < 2; shapes++) {
        struct message_list messages;
        struct identification found;
        struct job job;
        measured_job(shapes, &job);
        message_open(&messages, &test_pool);
        assert_status(identify_run(&test_pool, &job, 0, NULL, &messages, &found), ROTID_OK);
        print_message("%d evaluations, %d Jacobians\n", found.fit->evaluations, found.fit->jacobians);
        assert_true(found.fit->evaluations <= 12 && found.fit->jacobians <= 7); /* 15 and 13 without a basis to begin in */
        double fine_hz[MODES];
        rotid_fit_result *fine = fit_fine(&job, found.fit->x, fine_hz);
        for (int p = 0; p < 2; p++) {
            print_message("%s: %.8g, on the mesh that counts %.8g, standard deviation %.2g\n", job.unknowns.bounds[p].name,
                          found.fit->x[p], fine->x[p], fine->std[p]);
            /* shapes at sensors are those of the coarse mesh, which nothing holds */
            assert_close(found.fit->x[p], fine->x[p], shapes ? 0 : 1e-4, shapes ? 0.1 * fine->std[p] : 0);
        }
        for (int k = 0; k < MODES; k++)
            assert_close(found.fit->predicted_hz[k] / job.measurement.frequency_hz[k], fine->predicted_hz[k] / fine_hz[k],
                         shapes ? 2e-4 : 2e-5, 0);
        rotid_fit_free(fine);
        rotid_fit_free(found.fit);
    }
}

/* A fit of the search ends in its basis, and takes the Jacobian from there. */
POOL_TEST(a_fit_that_ends_in_its_basis_has_the_jacobian_of_the_mesh)
{
    static const int number[MODES] = {1, 2, 3, 4}, holdout[MODES] = {0};
    rotid_fit_result *ends, *goes_on;
    struct state one;
    struct job job;
    measured_job(1, &job);
    const struct states states = states_of(&job, &one);
    assert_status(mesh_hold_as_it_is(&test_pool, &one.job, MODES + 2), ROTID_OK);
    assert_status(refit_states(&test_pool, &states, number, holdout, NULL, &ends), ROTID_OK);
    assert_status(identify_fit_states(&test_pool, &states, number, holdout, &job.options.fit, NULL, &goes_on), ROTID_OK);
    print_message("%d and %d Jacobians\n", ends->jacobians, goes_on->jacobians);
    assert_true(ends->jacobians < goes_on->jacobians);
    for (int p = 0; p < 2; p++)
        assert_close(ends->std[p], goes_on->std[p], 1e-3, 0);
    assert_close(ends->correlation[1], goes_on->correlation[1], 0, 1e-3);
    rotid_fit_free(ends);
    rotid_fit_free(goes_on);
}

/* A disc of soft sheets, whose meshes are apart by another share of a frequency at other moduli: its own modes lead back to its
 * moduli, from a start a third away. */
POOL_TEST(a_fit_goes_on_until_what_the_meshes_lead_to_stays)
{
    char text[2048] = "*MATERIAL, NAME=soft\n*ELASTIC, TYPE=LAMINATED\n1.1e10, 1.8e9, 2.1e11, 0.3\n*DENSITY\n6000\n"
                      "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                      "*SHAFT, NAME=core, MATERIAL=soft\n0.03, 0.14\n*SHAFT, NAME=hub, MATERIAL=steel\n0.03, 0.05\n"
                      "*FIT, MODEL=SOLID\n";
    struct message_list messages;
    struct identification found;
    struct spectrum s;
    struct job job;
    read_job(text, &messages, &job);
    compute(&job, NULL, SPECTRUM_MESH, &s);
    strcat(text, "*NOISE, FREQUENCY=1e-4\n*MODES\n");
    for (int k = 0; k < MODES; k++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", k + 1, s.full_hz[k]);
    strcat(text, "*IDENTIFY\ncore.E, 3e9, 3e10, 1.5e10\ncore.G, 5e8, 5e9, 1.4e9\n");
    read_job(text, &messages, &job);
    message_open(&messages, &test_pool);
    assert_status(identify_run(&test_pool, &job, 0, NULL, &messages, &found), ROTID_OK);
    assert_int_equal(messages.count, 0);
    print_message("E %.8g, G %.8g\n", found.fit->x[0], found.fit->x[1]);
    assert_close(found.fit->x[0], 1.1e10, 1e-4, 0);
    assert_close(found.fit->x[1], 1.8e9, 1e-4, 0);
    rotid_fit_free(found.fit);
}

/* Errors at a corner fall with the power 1.089 of the size of its elements: test_solid_frequencies. */
POOL_TEST(the_limit_is_that_of_refined_meshes_within_the_mesh_column)
{
    for (int which = 0; which < 2; which += SPARSE) {
        struct rig b;
        struct spectrum s;
        double two[MODES], four[MODES];
        if (which)
            rig_rotor_a(&b, 1);
        else
            rig_two_steps(&b);
        const struct job job = {.rotor = b.rotor, .models = models_as(&test_pool, AS_SOLID)};
        compute(&job, NULL, SPECTRUM_MESH, &s);
        rig_solid(&b.rotor, NULL, 2, 2, MODES, two);
        rig_solid(&b.rotor, NULL, 4, 2, MODES, four);
        for (int k = 0; k < MODES; k++) {
            double limit = four[k] - (two[k] - four[k]) / (pow(2, 1.089) - 1), error = 100 * (s.full_hz[k] / limit - 1);
            print_message("mode %d: in doubt by %+.4f %%, by refining off by %+.4f %%\n", k + 1, s.mesh_error_percent[k], error);
            assert_true(fabs(error) < s.mesh_error_percent[k] && s.mesh_error_percent[k] < 0.03);
        }
    }
}

/* The same stubby rotor in one section and in 24: rods of one element move with any mesh alike (their mass on its lines alone was
 * 0.011 % off beside a column of 0.0000), and what elements of others leave of their own modes is in the column. */
static void rods_in_sections(int elements, int sections, struct spectrum *s)
{
    char text[4096] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n";
    struct message_list messages;
    struct job job;
    for (int i = 0; i < sections; i++)
        (void)sprintf(text + strlen(text), "%.17g, 0.1334\n", 0.234 / sections);
    (void)sprintf(text + strlen(text),
                  "*TIEROD, NAME=rods, MATERIAL=steel, FROM=core.start, TO=core.end, MODEL=RODS\n6, 0.0133, 0.0333, 1e4, %d\n"
                  "*FIT, MODEL=SOLID\n",
                  elements);
    read_job(text, &messages, &job);
    compute(&job, NULL, SPECTRUM_MESH, s);
}

POOL_TEST(rods_are_the_same_in_any_number_of_sections)
{
    for (int elements = 1; elements <= 2; elements++) {
        struct spectrum one, many;
        double most = 0;
        rods_in_sections(elements, 1, &one);
        rods_in_sections(elements, 24, &many);
        for (int j = 0; j < MODES; j++) {
            double apart = 100 * fabs(one.full_hz[j] / many.full_hz[j] - 1), column = fabs(one.mesh_error_percent[j]);
            print_message("mode %d: %.5f %% apart, column %.5f\n", j + 1, apart, column);
            assert_true(apart < column && (elements == 2 || apart < 5e-3));
            most = fmax(most, apart / column);
        }
        assert_true(most > 0.2);
    }
}

/* The rotor's own modes with a joint at the step: beside a fit that holds the mesh of the rotor without it, a zone at the step
 * with 98 % made up for what the meshes have otherwise. */
POOL_TEST(a_joint_at_a_step_needs_nothing_beside_it)
{
    char text[16384] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                       "*MATERIAL, NAME=sheet\n*ELASTIC, TYPE=LAMINATED\n8e10, 2.6e10, 2e11, 0.3, 0.97\n*DENSITY\n7600\n"
                       "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.08\n*SHAFT, NAME=core, MATERIAL=sheet\n0.5, 0.14\n"
                       "*SPRING, NAME=front\n0, 2e6\n*SPRING, NAME=rear\n0.8, 2e6\n*DISK, NAME=disk\n0.1, 2, 0.004\n"
                       "*FIT, MODEL=SOLID\n*SENSORS\n";
    const struct diagnose_options options = {.threads = 2};
    struct effect joint = {.name = "joint", .kind = catalogue_find("joint")->effect, .target = 0, .value = {2e-8}};
    struct message_list messages;
    struct diagnosis d;
    struct spectrum s;
    struct job job;
    for (int i = 0; i < SENSORS; i++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", i + 1, 0.1 * i);
    read_job(text, &messages, &job);
    job.rotor.effect = &joint;
    job.rotor.neffect = 1;
    compute(&job, NULL, SPECTRUM_MESH, &s);
    put_modes(text, ", COUNT=ELASTIC", &s, 1, 0);
    strcat(text, "*IDENTIFY\ncore.E, 3e10, 2e11, 7e10\ncore.G, 1e10, 6e10, 3e10\n");
    read_job(text, &messages, &job);
    message_open(&messages, &test_pool);
    assert_status(diagnose_run(&test_pool, &job, &options, NULL, &messages, &d), ROTID_OK);
    print_message("%s\n", d.result.verdict.sentence);
    assert_int_equal(d.result.verdict.kind, ROTID_NAMED);
    assert_int_equal(d.ncause, 1);
    assert_string_equal(d.cause[0].cause->id, "joint");
    assert_null(strstr(d.result.verdict.sentence, "and with"));
    assert_close(d.cause[0].effect.value[0], 2e-8, 0.03, 0);
    diagnose_free(&d);
}

TEST_GROUP(folder_make, folder_remove);
