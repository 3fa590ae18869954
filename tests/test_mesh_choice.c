/* Elements that a deck does not state: the mesh that is chosen beside exact dynamic stiffness. */
#include "deck/deck.h"
#include "exact.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define MATERIAL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"

/* Worst error of modes 1 to count against the oracle, relative. */
static double error_of(const struct rotor *rotor, int count)
{
    struct exact exact;
    double truth[EXACT_MODES], hz[EXACT_MODES];
    exact_open(rotor, &exact);
    exact_hz(&exact, 3, count, truth);
    mesh_hz(rotor, 1, 2, count, hz);
    return worst_ratio(count, hz, truth);
}

static int elements_of(const struct rotor *rotor)
{
    int elements = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        elements += rotor->segment[s].elements;
    return elements;
}

#define SHAFTS(L, C, R)                                                                                                          \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0" L "\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0.02" C                  \
    "\n*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.06, 0" R "\n"
#define MODES "*MODES\n1, 390\n2, 690\n4, 2470\n"

UNIT_TEST(the_error_is_a_tenth_of_the_noise_and_no_less_than_a_fifth_of_that)
{
    static const double noise[] = {3e-3, 1e-3, 1e-4};
    for (size_t i = 0; i < sizeof noise / sizeof *noise; i++) {
        char text[1024];
        struct reading r;
        (void)snprintf(text, sizeof text, MATERIAL SHAFTS("", "", ",, 0.058") MODES "*NOISE, FREQUENCY=%g\n", noise[i]);
        read_text(&r, text, NULL);
        double error = error_of(&r.job.rotor, 4);
        assert_true(error <= MESH_CHOICE_SHARE * noise[i]);
        assert_true(error > 0.2 * MESH_CHOICE_SHARE * noise[i]); /* elements cost time */
        pool_close(&r.pool);
    }
}

UNIT_TEST(the_highest_mode_and_the_smallest_noise_count)
{
    struct reading low, high, fine;
    read_text(&low, MATERIAL SHAFTS("", "", "") "*MODES\n1, 390, , 0.39\n", NULL);
    read_text(&high, MATERIAL SHAFTS("", "", "") "*MODES\n1, 390, , 0.39\n6, 4900, , 4.9\n", NULL);
    read_text(&fine, MATERIAL SHAFTS("", "", "") "*MODES\n1, 390, , 0.39\n6, 4900, , 0.49\n", NULL);
    assert_true(elements_of(&high.job.rotor) > 2 * elements_of(&low.job.rotor));
    assert_true(elements_of(&fine.job.rotor) > 2 * elements_of(&high.job.rotor));
    assert_true(error_of(&fine.job.rotor, 6) <= 1e-5);
    pool_close(&low.pool);
    pool_close(&high.pool);
    pool_close(&fine.pool);
}

UNIT_TEST(without_noise_the_error_is_a_hundredth_of_a_percent)
{
    struct reading r;
    read_text(&r, MATERIAL SHAFTS("", "", ""), NULL);
    assert_true(error_of(&r.job.rotor, MESH_CHOICE_MODES) <= MESH_CHOICE_ERROR);
    assert_int_equal(r.messages.count, 0);
    assert_true(r.job.mesh_error > 0 && r.job.mesh_error <= MESH_CHOICE_ERROR); /* check prints it */
    pool_close(&r.pool);
}

UNIT_TEST(sections_that_state_elements_keep_them)
{
    struct reading r;
    read_text(&r, MATERIAL SHAFTS(", 7", "", ", 300, 0.055") MODES "*NOISE, FREQUENCY=0.01\n", NULL);
    assert_int_equal(r.job.rotor.segment[0].elements, 7);
    assert_true(r.job.rotor.segment[1].elements > 1);
    assert_int_equal(r.job.rotor.segment[2].elements, 300);
    assert_close(r.job.rotor.segment[2].stiff_outer, 0.055, 0, 0);
    pool_close(&r.pool);
    read_text(&r, MATERIAL "*BEAM, NAME=strip, MATERIAL=steel\n0.5, 0.005, 0.02\n" MODES, NULL);
    assert_true(r.job.rotor.segment[0].elements > 5);
    pool_close(&r.pool);
}

/* Noise that no mesh reaches ends at the most elements, and is told. */
UNIT_TEST(there_is_an_end)
{
    struct reading r;
    read_text(&r, MATERIAL SHAFTS("", "", "") MODES "*NOISE, FREQUENCY=1e-9\n", NULL);
    assert_in_range(elements_of(&r.job.rotor), MESH_CHOICE_LARGEST, MESH_CHOICE_LARGEST + 3);
    assert_non_null(strstr(r.messages.item[0].text, "where none are stated, leaves an error of"));
    pool_close(&r.pool);
}

/* The deck that is written states them, so it gives the same model whatever its noise becomes. */
UNIT_TEST(the_deck_that_is_written_states_the_elements)
{
    struct reading r, again;
    char *text;
    read_text(&r, MATERIAL SHAFTS("", "", "") MODES, NULL);
    struct state only, other;
    const struct states given = states_of(&r.job, &only), meant = states_of(&r.job, &other);
    double std[10];
    for (int k = 0; k < r.job.measurement.nmode; k++)
        std[k] = 1e-6;
    other.job.measurement.frequency_std = std; /* for which a finer mesh would be chosen */
    other.job.options.fit.functional = ROTID_LIKELIHOOD;
    assert_status(deck_write(&r.pool, &given, &meant, NULL, &r.messages, &text), ROTID_OK);
    assert_non_null(strstr(text, "*NOISE, FREQUENCY=1e-6"));
    read_text(&again, text, NULL);
    for (int s = 0; s < 3; s++)
        assert_int_equal(again.job.rotor.segment[s].elements, r.job.rotor.segment[s].elements);
    pool_close(&again.pool);
    pool_close(&r.pool);
}

TEST_GROUP(folder_make, folder_remove);
