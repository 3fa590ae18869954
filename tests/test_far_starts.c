/* How far starts are ranked: what all frequencies have in common, a parameter of the deck puts right. */
#include "deck/deck.h"
#include "diagnose/far_starts.c" /* the cost is its own */
#include "effect_bench.h"
#include "support.h"

static const char bar[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
                          "0.5, 0.05, 0, 10\n0.5, 0.07, 0, 10\n*MODES\n1, 100\n2, 200\n3, 300\n4, 400\n"
                          "*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, 1e10, 1e12, 2e11\n";

static double cost_with(const struct job *job)
{
    double x[] = {2e11}, cost;
    const struct engine engine = {.pool = &test_pool, .job = (struct job *)job, .deck_start = x};
    const struct trials trials = {.engine = &engine, .measured = &job->measurement};
    const struct effect none = {.kind = cause_added_mass.effect, .target = -1, .value = {0, 0.3}};
    struct spectrum spectrum = {0};
    assert_status(cost_of(&test_pool, &trials, &none, &spectrum, &cost), ROTID_OK);
    return cost;
}

POOL_TEST(a_common_factor_costs_nothing)
{
    const struct deck_memory memory = {"deck", sizeof bar - 1, bar, NULL};
    struct message_list messages;
    struct job job;
    struct spectrum s;
    enum { MODES = 4 };
    message_open(&messages, &test_pool);
    struct states states;
    assert_status(deck_read_states(&test_pool, "deck", &memory, 0, NULL, &messages, &states), ROTID_OK);
    job = states.state[0].job;
    assert_status(spectrum_compute(&test_pool, NULL, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, &s), ROTID_OK);
    for (int k = 0; k < MODES; k++)
        job.measurement.frequency_hz[k] = s.full_hz[k];
    assert_close(cost_with(&job), 0, 0, 1e-9);
    for (int k = 0; k < MODES; k++)
        job.measurement.frequency_hz[k] = 0.9 * s.full_hz[k];
    assert_close(cost_with(&job), 0, 0, 1e-9);
    job.measurement.frequency_hz[2] *= 1.01; /* one of four: the mean takes a quarter of it */
    assert_close(cost_with(&job), 0.75 * pow(log(1.01) / OFF_HZ, 2), 1e-3, 0);
}
