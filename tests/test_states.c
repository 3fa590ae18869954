/* Several states of a rotor through the first layer: each is a deck of its own, all are identified together, a state held out is
 * predicted, and results go to JSON and back. */
#include "reading.h"
#include "support.h"

#define SHAFT                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.3\n*DENSITY\n7850\n"                                           \
    "*SHAFT, NAME=bar, MATERIAL=steel\n0.6, 0.05, 0, 24\n0.4, 0.06, 0, 16\n*SENSORS\n1, 0\n2, 0.5\n3, end\n"                     \
    "*NOISE, FREQUENCY=0.001\n*FIT, FUNCTIONAL=%s%s\n*IDENTIFY\nbar.E, 1e10, 1e12, 1.5e11\n"
#define LOAD   "*DISK, NAME=d\n0.45, 3\n*IDENTIFY\nd.mass, 0.1, 30, 2\n"
#define SPRING "*SPRING, NAME=k\n0.1, 5e5\n*SET\nbar.length, 0.8\n"

enum { MODES = 3, STATES = 3 };
static const char *const names[STATES] = {"free", "loaded", "held"};

static char *deck_text(const char *functional, const char *fit, double hz[STATES][MODES])
{
    static const char *const cards[STATES] = {"", LOAD, SPRING};
    char *text = pool_format(&test_pool, SHAFT, functional, fit);
    for (int s = 0; s < STATES; s++) {
        text = pool_format(&test_pool, "%s*STATE, NAME=%s\n%s*MODES\n", text, names[s], cards[s]);
        for (int k = 0; k < MODES; k++)
            text = pool_format(&test_pool, "%s%d, %.12g\n", text, k + 1, hz[s][k]);
    }
    return text;
}

/* Frequencies of the model at bar.E = 2e11 and d.mass = 4, which each state as a deck of its own says. */
static void measure(double hz[STATES][MODES])
{
    double any[STATES][MODES] = {{100, 200, 300}, {100, 200, 300}, {100, 200, 300}}, truth[] = {2e11, 4};
    rotid_deck *deck = read_handle(deck_text("LIKELIHOOD", "", any), 0, NULL);
    assert_int_equal(deck->nstate, STATES);
    assert_int_equal(deck->nparameter, 2);
    assert_string_equal(deck->parameter[1].name, "loaded:d.mass");
    assert_close(deck->stated[1], 3, 1e-14, 0);
    for (int s = 0; s < STATES; s++) {
        rotid_spectrum *spectrum;
        assert_string_equal(deck->state_name[s], names[s]);
        assert_int_equal(deck->state[s]->nparameter, s == 1 ? 2 : 1);
        assert_close(deck->state[s]->length, s == 2 ? 0.8 : 1, 1e-12, 0);
        assert_status(rotid_spectrum_compute(deck->state[s], truth, MODES, NULL, NULL, &spectrum), ROTID_OK);
        for (int k = 0; k < MODES; k++)
            hz[s][k] = spectrum->modes[k].full_hz;
        rotid_spectrum_free(spectrum);
        rotid_deck_free(deck->state[s]); /* goes with the whole deck */
    }
    rotid_deck_free(deck);
}

static rotid_identification *identify(const char *text, int baseline)
{
    rotid_identification *found;
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = read_handle(text, 0, NULL);
    int status = rotid_identify(deck, baseline, NULL, failure, &found);
    if (status)
        print_message("%s\n", failure);
    assert_status(status, ROTID_OK);
    rotid_deck_free(deck); /* before the result */
    return found;
}

POOL_TEST(all_states_are_identified_together)
{
    static const char *const functionals[] = {"LIKELIHOOD", "HYBRID"};
    double hz[STATES][MODES];
    measure(hz);
    for (int f = 0; f < 2; f++) {
        rotid_identification *found = identify(deck_text(functionals[f], "", hz), 1);
        assert_string_equal(found->status, "converged");
        assert_close(found->parameters[0].value, 2e11, 1e-8, 0);
        assert_close(found->parameters[1].value, 4, 1e-7, 0);
        assert_int_equal(found->nmodes, STATES * MODES);
        assert_int_equal(found->nstates, STATES);
        for (int s = 0; s < STATES; s++) {
            const rotid_identified_state *of = &found->states[s];
            assert_string_equal(of->name, names[s]);
            assert_int_equal(of->nmodes, MODES);
            assert_int_equal(of->fitted_residuals, MODES);
            assert_close(of->geometry->length_m, s == 2 ? 0.8 : 1, 1e-12, 0);
            for (int k = 0; k < MODES; k++) {
                assert_close(of->modes[k].predicted_hz, hz[s][k], 1e-8, 0);
                assert_close(found->modes[s * MODES + k].predicted_hz, hz[s][k], 1e-8, 0);
                for (int b = 0; b < found->nbaseline; b++)
                    assert_close(found->baseline[b].predicted_hz[s * MODES + k], hz[s][k], 1e-4, 0);
            }
        }
        assert_true(found->states[1].mass_kg > found->states[0].mass_kg + 3.99);
        rotid_identification_free(found);
    }
}

/* The third state is wrong by 10 %: held out, nothing of that is in the others, and all of it in its prediction. */
POOL_TEST(a_state_held_out_is_predicted)
{
    double hz[STATES][MODES];
    measure(hz);
    for (int k = 0; k < MODES; k++)
        hz[2][k] *= 1.1;
    rotid_identification *found = identify(deck_text("LIKELIHOOD", ", HOLDOUT=STATE:held", hz), 0);
    assert_close(found->parameters[0].value, 2e11, 1e-8, 0);
    assert_int_equal(found->states[2].fitted_residuals, 0);
    assert_int_equal(found->fit->nresidual, 2 * MODES);
    for (int k = 0; k < MODES; k++) {
        assert_true(found->modes[2 * MODES + k].holdout);
        assert_close(found->states[2].modes[k].error_percent, 100 * (1 / 1.1 - 1), 1e-6, 0);
    }
    rotid_identification_free(found);
}

/* By itself, by FIT.STATE and as the deck of its state. */
POOL_TEST(one_state_is_the_same_however_it_is_asked_for)
{
    static const char *const set[] = {"FIT.STATE=loaded"};
    double hz[STATES][MODES];
    char failure[ROTID_FAILURE_LENGTH];
    measure(hz);
    const char *text = deck_text("LIKELIHOOD", "", hz);
    rotid_deck *all = read_handle(text, 0, NULL), *one = read_handle(text, 1, set);
    rotid_identification *a, *b;
    assert_int_equal(one->nstate, 0);
    assert_string_equal(one->parameter[1].name, "d.mass");
    assert_status(rotid_identify(all->state[1], 0, NULL, NULL, &a), ROTID_OK);
    assert_status(rotid_identify(one, 0, NULL, NULL, &b), ROTID_OK);
    assert_int_equal(a->nstates + b->nstates, 0);
    for (int p = 0; p < 2; p++)
        assert_true(a->parameters[p].value == b->parameters[p].value);
    rotid_identification_free(a);
    rotid_identification_free(b);
    rotid_check *check;
    assert_status(rotid_deck_check(all, NULL, failure, &check), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(failure, "the deck has 3 states and this works on one, expected one of free, loaded, held"));
    rotid_deck_free(all);
    rotid_deck_free(one);
}

POOL_TEST(every_failing_allocation_is_survived)
{
    double hz[STATES][MODES];
    measure(hz);
    const char *text = deck_text("LIKELIHOOD", "", hz);
    for (int n = 1, done = 0; !done; n += n < 50 ? 1 : 7) {
        struct failing_allocator failing;
        rotid_deck *deck = NULL;
        rotid_identification *found = NULL;
        failing_allocator_open(&failing, n);
        const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        int status = rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, &environment, NULL, &deck);
        if (!status)
            status = rotid_identify(deck, 0, &environment, NULL, &found);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        done = !status;
        assert_int_equal(done, failing.until_failure > 0);
        rotid_identification_free(found);
        rotid_deck_free(deck);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 20000);
        if (done)
            print_message("three states: %d allocations\n", n);
    }
}
