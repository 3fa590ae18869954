/* A diagnosis on solids: data of a stepped solid on a finer mesh, judged as a beam and as the solid it is. */
#include "folder.h"
#include "one_state.h"
#include "support.h"

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "modal/modal.h"
#include "model/model.h"
#include "run/run.h"

#define SENSORS 9
#define MODES   4

static const double true_e = 2e11, true_g = 0.77e11, frequency_noise = 0.001, shape_noise = 0.01;

/* A shaft with one thick end, whose moduli are wanted; sensors at even distances. */
static const char rotor_text[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n"
                                 "*MATERIAL, NAME=cast\n*ELASTIC, TYPE=SHEAR\n2e11, 0.77e11, 0.30\n*DENSITY\n7850\n"
                                 "*SHAFT, NAME=left, MATERIAL=steel\n0.25, 0.10, 0, 20\n"
                                 "*SHAFT, NAME=core, MATERIAL=cast\n0.35, 0.20, 0, 20\n";

static void put_sensors(char *text)
{
    strcat(text, "*SENSORS\n");
    for (int s = 0; s < SENSORS; s++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", s + 1, 0.6 * (s + 0.5) / SENSORS);
}

/* Modes of the rotor, with the effect (may be NULL) in it, as a solid of a mesh twice as fine, with that share of the stated
 * noise, as cards, their signs such that the first sensor moves upwards: solvers leave them open, and with them what a noise
 * does; where `copied` the last but one sensor is recorded in place of the last one. */
static void put_measured(const struct effect *effect, double share, int copied, char *text)
{
    struct message_list messages;
    struct job job;
    struct rotor_model model;
    struct prediction p;
    struct random_stream noise = {7};
    int failed;
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_write("rotor.inp", text), 0, NULL, &messages, &job), ROTID_OK);
    if (effect) {
        job.rotor.effect = POOL_ARRAY(&test_pool, struct effect, 1);
        job.rotor.effect[job.rotor.neffect++] = *effect;
    }
    assert_status(model_open(&test_pool, models_as(&test_pool, AS_SOLID), &job.rotor, 0, NULL, 2, &model, &failed), ROTID_OK);
    int rigid = model.equations.nrigid;
    assert_status(prediction_new(&test_pool, &model.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, rigid + MODES, 0, &p),
                  ROTID_OK);
    assert_status(prediction_compute(&p, NULL), ROTID_OK);
    (void)sprintf(text + strlen(text), "*NOISE, FREQUENCY=%g, SHAPE=%g\n*MODES\n", frequency_noise, shape_noise);
    for (int k = 0; k < MODES; k++)
        (void)sprintf(text + strlen(text), "%d, %.17g\n", k + 1,
                      prediction_hz(&p, rigid + k) * (1 + share * frequency_noise * random_normal(&noise)));
    for (int k = 0; k < MODES; k++) {
        double largest = 0, read = 0;
        for (int s = 0; s < SENSORS; s++)
            largest = fmax(largest, fabs(prediction_at_sensor(&p, rigid + k, s)));
        largest = copysign(largest, prediction_at_sensor(&p, rigid + k, 0));
        (void)sprintf(text + strlen(text), "*SHAPE, MODE=%d\n", k + 1);
        for (int s = 0; s < SENSORS; s++) {
            double own = prediction_at_sensor(&p, rigid + k, s) / largest + share * shape_noise * random_normal(&noise);
            read = copied && s == SENSORS - 1 ? read : own;
            (void)sprintf(text + strlen(text), "%d, %.17g\n", s + 1, read);
        }
    }
}

static void diagnose(const struct effect *effect, int copied, const char *fit, struct diagnosis *d)
{
    const struct diagnose_options options = {.threads = 2};
    struct message_list messages;
    struct job job;
    char text[16384];
    strcpy(text, rotor_text);
    put_sensors(text);
    put_measured(effect, 1, copied, text);
    (void)sprintf(text + strlen(text), "%s*IDENTIFY\ncore.E, 1e10, 4e11, 1.8e11\ncore.G, 1e10, 1.5e11, 0.7e11\n", fit);
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_write("deck.inp", text), 0, NULL, &messages, &job), ROTID_OK);
    assert_status(diagnose_run(&test_pool, &job, &options, NULL, &messages, d), ROTID_OK);
    print_message("%s\n", d->result.verdict.sentence);
}

static const struct candidate *find(const struct diagnosis *d, const char *id)
{
    for (int r = 0; r < d->nround; r++)
        for (int i = 0; i < d->round[r].ncandidate; i++)
            if (!strcmp(d->round[r].candidate[i].cause->id, id))
                return &d->round[r].candidate[i];
    return NULL;
}

POOL_TEST(a_beam_that_is_a_solid_is_told_so)
{
    struct diagnosis d;
    struct message_list messages;
    diagnose(NULL, 0, "*FIT, REDUCTION=NONE\n", &d);
    assert_int_equal(d.result.verdict.kind, ROTID_NAMED);
    assert_int_equal(d.ncause, 1);
    assert_string_equal(d.cause[0].cause->id, "beam_theory");
    assert_int_equal(d.cause[0].nparameter, 0);
    assert_non_null(find(&d, "step_stiffness")); /* its rival, with one parameter more */
    assert_true(d.result.verdict.adequate_after);
    assert_non_null(strstr(d.result.verdict.sentence, "MODEL=SOLID"));
    assert_true(d.extended_job.options.solid);
    assert_int_equal(d.extended_job.rotor.neffect, 0);
    assert_int_equal(d.extended.fit->n, 2);
    assert_close(d.extended.fit->x[0], true_e, 0.015, 0);
    assert_close(d.extended.fit->x[1], true_g, 0.03, 0);
    char *deck;
    message_open(&messages, &test_pool);
    assert_status(deck_write_extended(&test_pool, &d, &messages, &deck), ROTID_OK);
    assert_non_null(strstr(deck, "MODEL=SOLID"));
    struct job again;
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_write("extended.inp", deck), 0, NULL, &messages, &again), ROTID_OK);
    assert_true(again.options.solid);
    diagnose_free(&d);
}

POOL_TEST(a_solid_that_explains_its_data_is_adequate)
{
    struct diagnosis d;
    diagnose(NULL, 0, "*FIT, MODEL=SOLID\n", &d);
    assert_int_equal(d.result.verdict.kind, ROTID_ADEQUATE);
    assert_close(d.base.fit->x[0], true_e, 0.015, 0);
    assert_int_equal(d.result.nnumerical_findings, 0);
    diagnose_free(&d);
}

/* A joint softens the slice beside a corner, which two meshes have of different lengths: its fits hold the mesh at the joint, not
 * at the model without it, where a second cause was to make up for that. */
POOL_TEST(a_joint_at_a_step_is_named_alone)
{
    static const double flexibility[] = {2e-8, 1e-7};
    for (size_t i = 0; i < sizeof flexibility / sizeof *flexibility; i++) {
        struct diagnosis d;
        struct effect joint = {.name = "joint", .kind = catalogue_find("joint")->effect, .target = 0, .value = {flexibility[i]}};
        diagnose(&joint, 0, "*FIT, MODEL=SOLID\n", &d);
        assert_int_equal(d.result.verdict.kind, ROTID_NAMED);
        assert_int_equal(d.ncause, 1);
        assert_string_equal(d.cause[0].cause->id, "joint");
        assert_close(d.cause[0].effect.value[0], flexibility[i], 0.1, 0);
        diagnose_free(&d);
    }
}

POOL_TEST(what_a_solid_lacks_is_named_and_sized)
{
    struct diagnosis d;
    struct effect ring = {.name = "ring", .kind = catalogue_find("added_mass")->effect, .target = -1, .value = {1.5, 0.5}};
    diagnose(&ring, 0, "*FIT, MODEL=SOLID\n", &d);
    assert_int_equal(d.result.verdict.kind, ROTID_NAMED);
    assert_int_equal(d.ncause, 1);
    assert_string_equal(d.cause[0].cause->id, "added_mass");
    assert_close(d.cause[0].effect.value[0], 1.5, 0.1, 0);
    assert_close(d.cause[0].effect.value[1], 0.5, 0, 0.02);
    static const char *const of_beams[] = {"beam_theory", "step_stiffness", "shear_coefficient"};
    for (size_t i = 0; i < sizeof of_beams / sizeof *of_beams; i++) {
        assert_null(find(&d, of_beams[i]));
        for (int j = 0; j < d.result.ndetectable; j++)
            assert_string_not_equal(d.result.detectable[j].id, of_beams[i]);
    }
    diagnose_free(&d);
}

/* What is fitted is the measured shape less what the coarse mesh misses, another number at every sensor. */
POOL_TEST(a_copied_channel_of_a_solid_is_told_by_its_digits)
{
    struct diagnosis d;
    diagnose(NULL, 1, "*FIT, MODEL=SOLID\n", &d);
    assert_int_equal(d.result.ndata_findings, 1);
    assert_string_equal(d.result.data_findings[0].id, "duplicate_channel");
    assert_int_equal(d.result.data_findings[0].sensors[0], SENSORS);
    assert_int_equal(d.result.verdict.kind, ROTID_ADEQUATE);
    diagnose_free(&d);
}

/* The coarse mesh, on which a solid is fitted, has to leave nothing that could be taken for a cause: its shapes are off by more
 * than that beside the step. */
POOL_TEST(a_fit_of_exact_data_leaves_nothing)
{
    struct message_list messages;
    struct identification result;
    struct job job;
    char text[16384];
    strcpy(text, rotor_text);
    put_sensors(text);
    put_measured(NULL, 0, 0, text);
    strcat(text, "*FIT, MODEL=SOLID\n*IDENTIFY\ncore.E, 1e10, 4e11, 1.8e11\ncore.G, 1e10, 1.5e11, 0.7e11\n");
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_write("exact.inp", text), 0, NULL, &messages, &job), ROTID_OK);
    assert_status(identify_run(&test_pool, &job, 0, NULL, &messages, &result), ROTID_OK);
    print_message("chi2 %.4g\n", result.fit->chi2);
    assert_true(result.fit->chi2 < 0.1);
    rotid_fit_free(result.fit);
}

TEST_GROUP(folder_make, folder_remove);
