/* The first layer of rotid.h: what a deck shows, and closed forms of its modes. The program is the first user of it. */
#include <unistd.h>

#include "api_bench.h"
#include "deck/deck.h"
#include "folder.h"
#include "one_state.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define BAR                                                                                                                      \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.1, 0, 24\n"           \
    "*SENSORS\n1, 0\n2, 0.15\n3, 0.3\n4, 0.45\n5, 0.6\n6, 0.75\n7, 0.9\n8, 1.05\n9, 1.2\n"

/* ------------------------------------------------------------------------------------------------ decks */

UNIT_TEST(a_deck_shows_what_was_read)
{
    struct pool pool;
    struct message_list messages;
    struct job job;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, SOLID, 0, NULL, &messages, &job), ROTID_OK);
    rotid_deck *deck = bench_deck(SOLID);
    assert_string_equal(deck->path, SOLID);
    assert_int_equal(deck->nerror, 0);
    assert_int_equal(deck->nmessage, messages.count);
    assert_int_equal(deck->nsensor, job.rotor.nsensor);
    for (int s = 0; s < deck->nsensor; s++) {
        assert_int_equal(deck->sensor_id[s], job.rotor.sensor[s].id);
        assert_true(deck->sensor_z[s] == job.rotor.sensor[s].position);
    }
    size_t modes = (size_t)job.measurement.nmode, components = modes * (size_t)job.rotor.nsensor;
    assert_int_equal(deck->nmode, job.measurement.nmode);
    assert_true(modes > 3 && components > 60);
    assert_memory_equal(deck->number, job.measurement.number, modes * sizeof(int));
    assert_memory_equal(deck->frequency_hz, job.measurement.frequency_hz, modes * sizeof(double));
    assert_memory_equal(deck->frequency_std, job.measurement.frequency_std, modes * sizeof(double));
    assert_memory_equal(deck->shape, job.measurement.shape, components * sizeof(double));
    assert_memory_equal(deck->shape_std, job.measurement.shape_std, components * sizeof(double));
    assert_memory_equal(deck->holdout, job.measurement.holdout, modes * sizeof(int));
    assert_int_equal(deck->nparameter, job.unknowns.nparameter);
    for (int p = 0; p < deck->nparameter; p++) {
        assert_string_equal(deck->parameter[p].name, job.unknowns.bounds[p].name);
        assert_true(deck->parameter[p].start == job.unknowns.bounds[p].start &&
                    deck->parameter[p].upper == job.unknowns.bounds[p].upper);
    }
    rotid_deck_free(deck);
    pool_close(&pool);
}

UNIT_TEST(mass_and_centre_are_those_at_the_start_of_the_parameters)
{
    const double area = 3.14159265358979323846 / 4 * 0.1 * 0.1;
    rotid_deck *deck = bench_deck(folder_write("bar.inp", BAR));
    assert_close(deck->length, 1.2, 1e-15, 0);
    assert_close(deck->mass, 7850 * 1.2 * area, 1e-13, 0);
    assert_close(deck->centre, 0.6, 1e-13, 0);
    assert_null(deck->shape);
    assert_int_equal(deck->nmode, 0);
    rotid_deck_free(deck);
    deck = bench_deck(folder_write("bar.inp", BAR "*IDENTIFY\ncore.rho, 5000, 9000, 6000\n"));
    assert_close(deck->mass, 6000 * 1.2 * area, 1e-13, 0);
    rotid_deck_free(deck);
    /* density of the left half raised by a cause that is part of the model, its size searched from a start of its own */
    deck = bench_deck(folder_write("bar.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n"
                                              "*SHAFT, NAME=a, MATERIAL=steel\n0.6, 0.1, 0, 12\n"
                                              "*SHAFT, NAME=b, MATERIAL=steel\n0.6, 0.1, 0, 12\n"
                                              "*CAUSE, NAME=heavy, TYPE=density, GROUP=a\nfactor, 1.2\n"
                                              "*IDENTIFY\nheavy.factor, 0.8, 1.5, 1.1\n"));
    assert_close(deck->mass, 7850 * area * (0.6 * 1.1 + 0.6), 1e-13, 0);
    assert_close(deck->centre, (0.3 * 1.1 + 0.9) / (1.1 + 1), 1e-13, 0);
    rotid_deck_free(deck);
}

UNIT_TEST(overrides_act_and_those_of_another_form_are_refused)
{
    static const char *const good[] = {"FIT.MODES=1-4", "fit.holdout=2"}, *const none[] = {NULL},
                             *const bad[] = {"FIT.MODES", "=", "FIT=3", ".MODES=1", "SHAFTS.NAME=a", "FIT.MODES=fish"};
    rotid_deck *deck;
    assert_status(rotid_deck_read(PAPER, 2, good, NULL, NULL, &deck), ROTID_OK);
    assert_int_equal(deck->nmode, 6);
    for (int k = 0; k < 6; k++) /* those not fitted are predicted */
        assert_int_equal(deck->holdout[k], k == 1 || k > 3);
    rotid_deck_free(deck);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_status(rotid_deck_read(PAPER, 1, &bad[i], NULL, NULL, &deck), ROTID_ERROR_SYNTAX);
        assert_non_null(deck);
        assert_int_equal(deck->nerror, 1);
        assert_non_null(strstr(deck->message[deck->nmessage - 1].text, "expected"));
        rotid_deck_free(deck);
    }
    assert_status(rotid_deck_read(PAPER, 1, none, NULL, NULL, &deck), ROTID_ERROR_ARGUMENT);
    assert_null(deck);
}

/* ------------------------------------------------------------------------------------------------ modes */

UNIT_TEST(modes_follow_the_parameters)
{
    const double four = 8e11;
    rotid_spectrum *one, *two;
    rotid_deck *deck = bench_deck(folder_write("bar.inp", BAR "*IDENTIFY\ncore.E, 1e11, 9e11, 2e11\n"));
    assert_status(rotid_spectrum_compute(deck, NULL, 4, NULL, NULL, &one), ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, &four, 4, NULL, NULL, &two), ROTID_OK);
    assert_int_equal(one->nrigid_hz, 2);
    assert_int_equal(one->nmodes, 4);
    assert_int_equal(one->nsensor_z_m, 9);
    for (int k = 0; k < 4; k++) { /* G follows E: every stiffness times four */
        assert_close(two->modes[k].full_hz, 2 * one->modes[k].full_hz, 1e-9, 0);
        assert_close(two->modes[k].reduced_hz, 2 * one->modes[k].reduced_hz, 1e-9, 0);
        assert_true(one->modes[k].mesh_error_percent > 0 && one->modes[k].mesh_error_percent < 0.3);
        assert_true(one->modes[k].reduction_error_percent > 0);
    }
    /* Euler-Bernoulli (4.730)^2/(2 pi l^2) sqrt(EI/rho S), lowered by shear and rotary inertia */
    double slender = 4.7300407 * 4.7300407 / (2 * 3.14159265 * 1.44) * sqrt(2e11 / 7850) * 0.1 / 4;
    assert_true(one->modes[0].full_hz < slender && one->modes[0].full_hz > 0.96 * slender);
    double total = 0, turning = 0; /* the condensed mass moves rigid bodies as they are */
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            total += one->master_mass[i + 9 * j];
            turning += one->master_mass[i + 9 * j] * one->sensor_z_m[j];
        }
    assert_close(total, deck->mass, 1e-9, 0);
    assert_close(turning, deck->mass * deck->centre, 1e-9, 0);
    for (int k = 0; k < 4; k++) {
        double largest = 0, work[9];
        for (int i = 0; i < 9; i++)
            largest = fmax(largest, one->modes[k].shape[i]);
        assert_close(largest, 1, 1e-12, 0);
        assert_close(rotid_nco(9, one->master_mass, one->modes[k].shape, one->modes[k].shape, work), 1, 1e-12, 0);
    }
    rotid_spectrum_free(one);
    rotid_spectrum_free(two);
    rotid_deck_free(deck);
}

UNIT_TEST(a_model_with_few_modes_gives_what_it_has)
{
    rotid_spectrum *s;
    rotid_deck *deck = bench_deck(ROTID_SOURCE_DIR "/tests/data/decks/one_element.inp");
    assert_status(rotid_spectrum_compute(deck, NULL, 1000000000, NULL, NULL, &s), ROTID_OK);
    assert_true(s->nmodes >= 1 && s->nmodes <= 4);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}

/* ------------------------------------------------------------------------------------------------ identification */

UNIT_TEST(with_nothing_to_identify_the_model_is_compared)
{
    rotid_spectrum *s;
    rotid_identification *r;
    rotid_deck *deck = bench_deck(folder_write("bar.inp", BAR "*MODES\n1, 350\n3, 1600\n"));
    assert_status(rotid_identify(deck, 1, NULL, NULL, &r), ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, NULL, 3, NULL, NULL, &s), ROTID_OK);
    assert_int_equal(r->fit->iterations, 0);
    assert_int_equal(r->nparameters, 0);
    assert_close(r->modes[0].predicted_hz, s->modes[0].full_hz, 1e-12, 0); /* from other vectors to begin with */
    assert_close(r->modes[1].predicted_hz, s->modes[2].full_hz, 1e-12, 0);
    assert_close(r->mass_kg, deck->mass, 1e-15, 0);
    rotid_identification_free(r);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}

UNIT_TEST(an_identification_says_what_its_fit_found)
{
    rotid_identification *r;
    rotid_spectrum *s;
    rotid_deck *deck = bench_deck(PAPER);
    assert_status(rotid_identify(deck, 1, NULL, NULL, &r), ROTID_OK);
    const rotid_fit_result *fit = r->fit;
    assert_true(r->nparameters == fit->n && r->nmodes == fit->m && r->nhistory == fit->nhistory && r->nhistory > 2);
    assert_true(r->objective == fit->objective && r->gradient == fit->gradient && r->dof == fit->dof);
    assert_true(r->iterations == fit->iterations && r->evaluations == fit->evaluations && r->jacobians == fit->jacobians);
    for (int p = 0; p < r->nparameters; p++) {
        const rotid_fitted_parameter *is = &r->parameters[p];
        const rotid_parameter *asked = &deck->parameter[p];
        assert_true(!strcmp(is->name, asked->name) && !strcmp(is->unit, asked->unit));
        assert_true(is->value == fit->x[p] && is->std == fit->std[p] && is->start == asked->start);
        assert_true(is->lower == asked->lower && is->upper == asked->upper);
        assert_true(is->ci95[0] == fit->ci_lower[p] && is->ci95[1] == fit->ci_upper[p] && is->ci95[0] < is->ci95[1]);
    }
    assert_status(rotid_spectrum_compute(deck, fit->x, 20, NULL, NULL, &s), ROTID_OK);
    for (int k = 0; k < r->nmodes; k++) {
        const rotid_compared_mode *mode = &r->modes[k];
        const rotid_model_mode *own = &s->modes[mode->mode - 1];
        assert_true(mode->measured_mode == deck->number[k] && mode->measured_hz == deck->frequency_hz[k]);
        assert_true(mode->predicted_hz == fit->predicted_hz[k] && mode->residual == fit->residual[k]);
        assert_close(mode->error_percent, 100 * (fit->predicted_hz[k] / deck->frequency_hz[k] - 1), 1e-12, 0);
        assert_close(r->reduction_error_percent[k], own->reduction_error_percent, 1e-6, 1e-9);
        assert_close(r->mesh_error_percent[k], own->mesh_error_percent, 1e-6, 1e-9);
        assert_true(fabs(own->reduction_error_percent - own->mesh_error_percent) > 1e-4);
    }
    for (int i = 0; i < r->nhistory; i++) {
        const rotid_history_entry *is = &r->history[i];
        assert_true(is->iteration == i && is->objective == fit->history[i].objective && is->step == fit->history[i].step);
        assert_true(is->gradient == fit->history[i].gradient && is->mu == fit->history[i].mu);
        assert_memory_equal(is->x, fit->history_x + (ptrdiff_t)i * fit->n, (size_t)fit->n * sizeof *is->x);
    }
    for (int i = 0; i < r->nbaseline; i++) {
        assert_true(r->baseline[i].objective == fit->baseline[i].objective);
        assert_close(r->baseline[i].predicted_hz[0], fit->predicted_hz[0], 1e-3, 0);
    }
    rotid_spectrum_free(s);
    rotid_identification_free(r);
    rotid_deck_free(deck);
}

UNIT_TEST(verdicts_have_names)
{
    assert_string_equal(rotid_verdict_name(ROTID_ADEQUATE), "adequate");
    assert_string_equal(rotid_verdict_name(ROTID_NAMED), "named");
    assert_string_equal(rotid_verdict_name(ROTID_AMBIGUOUS), "ambiguous");
    assert_string_equal(rotid_verdict_name(ROTID_UNEXPLAINED), "unexplained");
    assert_non_null(rotid_verdict_name(-1));
    assert_non_null(rotid_verdict_name(4));
}

static int open_folder(void **state)
{
    set_blas_threads(1); /* the numbers of the program too are those of one */
    return folder_make(state);
}

TEST_GROUP(open_folder, folder_remove);
