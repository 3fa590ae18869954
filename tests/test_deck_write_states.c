/* A deck of several states that is written is read as the same states. */
#include "support.h"

#include <math.h>
#include <string.h>

#include "deck/deck.h"
#include "folder.h"
#include "read_states.h"
#include "same_job.h"

#define BAR                                                                                                                      \
    "*HEADING\na bar\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"                                            \
    "*SHAFT, NAME=bar, MATERIAL=steel\n0.25, 0.05, 0, 10\n0.75, 0.05, 0, 30\n*SHAFT, NAME=end, MATERIAL=steel\n0.5, 0.04, 0, "   \
    "20\n*DISK, NAME=d\n0.3, 1\n*SENSORS\n1, 0\n2, 0.5\n3, bar.end\n*NOISE, FREQUENCY=0.001, SHAPE=0.01\n"                       \
    "*SPRING, NAME=left\n0, 1e6\n*CAUSE, NAME=soft, TYPE=stiffness_local\nz, 0.4\nwidth, 0.05\ndepth, 0.2\n"
#define UNKNOWN "*IDENTIFY\nbar.E, 1e10, 1e12, 1e11\n"
#define FREE    "*STATE, NAME=free\n*MODES\n1, 225\n2, 610\n"

static void assert_same_unknowns(const struct states *a, const struct states *b)
{
    assert_int_equal(a->nstate, b->nstate);
    assert_int_equal(a->nparameter, b->nparameter);
    for (int p = 0; p < a->nparameter; p++)
        assert_string_equal(a->bounds[p].name, b->bounds[p].name);
    for (int s = 0; s < a->nstate; s++) {
        if (a->nstate > 1)
            assert_string_equal(a->state[s].name, b->state[s].name);
        assert_int_equal(a->state[s].ncommon, b->state[s].ncommon);
        assert_memory_equal(a->state[s].unknown, b->state[s].unknown,
                            (size_t)a->state[s].job.unknowns.nparameter * sizeof *a->state[s].unknown);
    }
}

static const char *written(const struct states *states, const double *x)
{
    const struct deck_write_options options = {.x = x};
    char *text;
    assert_status(deck_write_states(&test_pool, states, &options, &text), ROTID_OK);
    return text;
}

/* read(write(states)) == states, state by state, and the second writing is the first one; the text that was written */
static const char *comes_back(const char *text)
{
    const struct states first = read_states(text);
    const char *out = written(&first, NULL);
    const struct states second = read_states(out);
    assert_same_unknowns(&first, &second);
    for (int s = 0; s < first.nstate; s++)
        assert_same_job(&first.state[s].job, &second.state[s].job);
    assert_string_equal(written(&second, NULL), out);
    return out;
}

static int count(const char *text, const char *what)
{
    int n = 0;
    for (const char *at = text; (at = strstr(at, what)); at++)
        n++;
    return n;
}

static void what_states_add_stands_in_them(void **state)
{
    (void)state;
    const char *out =
        comes_back(BAR UNKNOWN FREE "*STATE, NAME=loaded, HOLDOUT=2\n*DISK, NAME=more\n0.5, 3\n*MODES\n1, 190\n2, 500\n"
                                    "*SHAPE, MODE=1\n1, 1\n2, -0.5\n3, 1\n"
                                    "*IDENTIFY\nmore.mass, 0.1, 30, 2\n");
    const char *first = strstr(out, "*STATE, NAME=free"), *second = strstr(out, "*STATE, NAME=loaded, HOLDOUT=2\n");
    assert_true(first && second && first < second);
    assert_int_equal(count(out, "*SHAFT"), 2); /* what is common stands once */
    assert_int_equal(count(out, "*DISK"), 2);
    assert_int_equal(count(out, "*SENSORS"), 1);
    assert_int_equal(count(out, "*CAUSE"), 1);
    assert_int_equal(count(out, "*SET"), 0);
    assert_true(strstr(out, "NAME=d\n") < first && strstr(out, "NAME=more\n") > second);
    assert_non_null(strstr(second, "*IDENTIFY\nmore.mass, 0.1, 30, 2\n"));
}

/* Sensors, supports, faults of a channel, suspects, transfer functions and what hangs on the rotor may all differ. */
static void states_that_differ_in_everything_come_back(void **state)
{
    (void)state;
    const char *out = comes_back(
        BAR UNKNOWN FREE "*SENSORS\n4, 0.1\n5, 1\n6, 1.2\n*NOISE, FREQUENCY=0.002\n*SHAPE, MODE=1\n4, 1\n5, 0.5\n6, -1\n"
                         "*CAUSE, NAME=turned, TYPE=sensor_sign, SENSOR=5\n*CAUSE, NAME=extra, TYPE=added_mass, SUSPECT=YES\n"
                         "*PRELOAD, GROUP=end\n1000\n"
                         "*STATE, NAME=held\n*SPRING, NAME=right\nend, 1e7\n*MODES\n1, 300\n3, 900\n*SLING, LENGTH=2\n"
                         "*CAUSE, NAME=gone, TYPE=density, GROUP=end\nfactor, 0.9\n"
                         "*MATERIAL, NAME=c\n*ELASTIC\n1e11, 0.3\n*DENSITY\n8900\n"
                         "*BARS, NAME=copper, MATERIAL=c, CENTER=0.5, "
                         "LENGTH=0.2\n20, 0.002, 0.02, 4\n*FRF, LINES=50\n*PERFORATION, GROUP=bar\n4, 0.004, 0.015\n");
    assert_int_equal(count(out, "*SENSORS"), 2);
    assert_int_equal(count(out, "*SHAFT"), 2);
}

/* Moduli and densities that *SET states, and unknowns that are known in a state or its own there. */
static void values_of_states_come_back(void **state)
{
    (void)state;
    const char *out = comes_back(
        BAR "*IDENTIFY\nbar.E, 1e10, 1e12, 1e11\nleft.k, 1e3, 1e9, 1e5\nsoft.depth, 0.01, 0.9, 0.1\n"
            "*STATE, NAME=a\n*SET\nbar.E, 1.9e11\nleft.k, 2e6\n*MODES\n1, 225\n2, 610\n"
            "*STATE, NAME=b\n*SET\nbar.G, 7.7e10\nend.rho, 7000\nend.nu, 0.25\nsoft.depth, 0.3\n*MODES\n1, 225\n2, 610\n"
            "*STATE, NAME=c\n*SET\nend.G, 7e10\n*IDENTIFY\nbar.E, 1e10, 1e12, 3e11\n*MODES\n1, 225\n2, 610\n");
    assert_int_equal(count(out, "*SHAFT"), 2);
    assert_non_null(strstr(out, "bar.E, 1.9e11\n"));
    assert_int_equal(count(out, "*SET\n"), 3);
    assert_non_null(strstr(strstr(out, "NAME=c"), "*IDENTIFY\nbar.E, 1e10, 1e12, 3e11\n"));
}

/* A common G that follows another E in each state is stated in each. */
static void values_that_no_set_can_state_come_back(void **state)
{
    (void)state;
    (void)comes_back(BAR
                     "*IDENTIFY\nbar.G, 1e10, 1e12, 7e10\n*STATE, NAME=a\n*SET\nbar.E, 1.9e11\n*MODES\n1, 225\n2, 610\n" FREE);
}

/* One *SET for a length, and positions that follow it. */
static void lengths_come_back(void **state)
{
    (void)state;
    const struct states first = read_states(BAR UNKNOWN "*DISK, NAME=tip\nend, 0.1\n" FREE
                                                        "*STATE, NAME=short\n*SET\nend.length, 0.3\n*MODES\n1, 225\n2, 610\n"
                                                        "*STATE, NAME=long\n*SET\nbar.length, 1.7\n*MODES\n1, 225\n2, 610\n");
    const char *out = written(&first, NULL);
    const struct states second = read_states(out);
    static const double length[] = {1.5, 1.3, 2.2};
    assert_int_equal(count(out, "*SHAFT"), 2);
    assert_non_null(strstr(out, "*SET\nend.length, 0.3\n"));
    assert_non_null(strstr(out, "*SET\nbar.length, 1.7\n"));
    assert_same_unknowns(&first, &second);
    for (int s = 0; s < 3; s++) {
        const struct rotor *a = &first.state[s].job.rotor, *b = &second.state[s].job.rotor;
        assert_close(rotor_length(b), length[s], 1e-13, 0);
        assert_int_equal(b->ndisk, 2);
        for (int i = 0; i < 2; i++)
            assert_close(b->disk[i].position, a->disk[i].position, 1e-13, 0);
        for (int i = 0; i < a->nsegment; i++)
            assert_close(b->segment[i].length, a->segment[i].length, 1e-13, 0);
        for (int i = 0; i < a->nsensor; i++)
            assert_close(b->sensor[i].position, a->sensor[i].position, 1e-13, 1e-15);
    }
    assert_string_equal(written(&second, NULL), out);
}

/* Another shaft in one state: nothing that *SET could say. */
static void other_shafts_come_back(void **state)
{
    (void)state;
    const char *out =
        comes_back("*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=one, MATERIAL=s\n1, 0.1, 0, 10\n"
                   "*IDENTIFY\ntwo.E, 1e10, 1e12, 2e11\n*STATE, NAME=thin\n*SHAFT, NAME=two, MATERIAL=s\n0.5, 0.08, 0, "
                   "5\n*MODES\n1, 300\n*STATE, NAME=thick\n*SHAFT, NAME=two, MATERIAL=s\n0.5, 0.12, 0, 5\n*MODES\n1, 500\n");
    assert_int_equal(count(out, "*SHAFT"), 3);
}

static void whole_states_stay_held_out(void **state)
{
    (void)state;
    const char *out = comes_back(BAR UNKNOWN "*FIT, FUNCTIONAL=HYBRID_F, HOLDOUT=STATE:two, STATE:three\n" FREE
                                             "*STATE, NAME=two\n*MODES\n1, 225\n2, 610\n*STATE, NAME=three\n*MODES\n1, 225\n");
    const struct states s = read_states(out);
    assert_non_null(strstr(out, "HOLDOUT=STATE:two,\n    STATE:three\n"));
    assert_int_equal(s.state[0].job.measurement.holdout[0], 0);
    assert_int_equal(s.state[1].job.measurement.holdout[1], 1);
    assert_int_equal(s.state[2].job.measurement.holdout[0], 1);
    (void)comes_back(BAR UNKNOWN "*FIT, HOLDOUT=STATE:two\n" FREE "*STATE, NAME=two\n*MODES\n1, 225\n2, 610\n");
}

/* At other values of the unknowns model and starts are those of each state. */
static void states_are_written_at_a_fit(void **state)
{
    (void)state;
    const struct states first =
        read_states(BAR UNKNOWN FREE "*STATE, NAME=own\n*IDENTIFY\nleft.k, 1e3, 1e9, 1e5\nbar.E, 1e10, 1e12, 3e11\n"
                                     "*MODES\n1, 225\n2, 610\n");
    const double x[] = {1.5e11, 2e6, 2.5e11};
    assert_int_equal(first.nparameter, 3);
    const struct states second = read_states(written(&first, x));
    assert_same_unknowns(&first, &second);
    for (int p = 0; p < 3; p++)
        assert_true(second.bounds[p].start == x[p]);
    assert_true(second.state[0].job.rotor.group[0].material.e == x[0]);
    assert_true(second.state[1].job.rotor.group[0].material.e == x[2]);
    assert_true(second.state[0].job.rotor.spring[0].lateral == 1e6);
    assert_true(second.state[1].job.rotor.spring[0].lateral == x[1]);
}

static void without_memory_nothing_is_written(void **state)
{
    (void)state;
    const struct states states =
        read_states(BAR UNKNOWN FREE "*STATE, NAME=b\n*SET\nbar.E, 2e11\nend.length, 0.4\n*MODES\n1, 225\n");
    struct failing_allocator failing;
    long fail_at = 0;
    int status;
    do {
        struct pool pool;
        char *text;
        failing_allocator_open(&failing, ++fail_at);
        pool_open(&pool, &failing.allocator);
        status = deck_write_states(&pool, &states, NULL, &text);
        assert_true((status == ROTID_OK) == (text != NULL) && (status == ROTID_OK || status == ROTID_ERROR_MEMORY));
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    } while (failing.until_failure == 0);
    assert_status(status, ROTID_OK);
}

static void one_state_is_written_as_a_deck_without(void **state)
{
    (void)state;
    const char *out = comes_back(BAR UNKNOWN "*MODES\n1, 225\n");
    assert_null(strstr(out, "*STATE"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_states_add_stands_in_them, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(states_that_differ_in_everything_come_back, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(values_of_states_come_back, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(values_that_no_set_can_state_come_back, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(lengths_come_back, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(other_shafts_come_back, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(whole_states_stay_held_out, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(states_are_written_at_a_fit, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(without_memory_nothing_is_written, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(one_state_is_written_as_a_deck_without, open_test_pool, close_test_pool),
    };
    return cmocka_run_group_tests_name("deck_write_states", tests, folder_make, folder_remove);
}
