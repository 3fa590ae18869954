/* Cards behind *RUNNING: what they make, and what is said of those that cannot be. */
#include "api/api.h"
#include "deck/deck.h"
#include "folder.h"
#include "running_case.h"
#include "support.h"

#define SHAFT                                                                                                                    \
    "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n2, 0.1, 0, 20\n*SPRING, "               \
    "NAME=f\nstart, "                                                                                                            \
    "1e4\n"
#define TWO "*RUNNING\n*BEARING, NAME=p\n0.2, 1e8, 10\n*BEARING, NAME=q\n1.8, 1e8, 10\n"

/* Whether reading the text says this at the line. */
static void says(const char *text, int severity, int line, const char *what)
{
    rotid_deck *deck;
    int found = 0;
    (void)rotid_deck_read_text(strlen(text), text, "deck", folder_path("."), 0, NULL, NULL, NULL, &deck);
    assert_non_null(deck);
    for (int i = 0; i < deck->nmessage; i++)
        found |= deck->message[i].severity == severity && (!line || deck->message[i].line == line) &&
                 strstr(deck->message[i].text, what) != NULL;
    if (!found)
        for (int i = 0; i < deck->nmessage; i++)
            print_message("%d: %s\n", deck->message[i].line, deck->message[i].text);
    assert_true(found);
    rotid_deck_free(deck);
}

POOL_TEST(the_cards_of_a_machine_are_read)
{
    struct running_case c;
    (void)folder_write("table.csv", "speed_rpm,kyy,kxx,cxx,cyy\n1000,2e7,1e7,1,2\n3000,4e7,3e7,3,4\n");
    const char *text = pool_format(
        &test_pool,
        SHAFT
        "*RUNNING, WITHOUT=f\n*DISK, NAME=fan\n1.0, 5, 0.1, 0.2\n*BEARING, NAME=p, STD=.2, .3\n0.2, 1e8, 10\n*BEARING, NAME=q, "
        "LIKE=p\n1.8, 1, 2, 3, 4, 5, 6, 7, 8\n*BEARING, FILE=%s, STD=0.1\n1.5\n*PEDESTAL, BEARING=q\n10, 20, 3e9, 4e9, 5\n"
        "*LOSS\na, 0.02, 0.01\n*PULL, GROUP=a, STD=0.3\n100\n*CHANGE\na.E, 0.9, 0.02\n*UNBALANCE\n1, 0.01, 90\n*PROBE, "
        "NAME=x\n0.5, 45\n*OPERATION, MARGIN=0.15\n3000, 4000\n",
        folder_path("table.csv"));
    assert_int_equal(running_case_open(text, 6000, 3, 0, &c), ROTID_OK);
    const struct machine *m = c.machine;
    const double full[4] = {1, 2, 3, 4};
    double k[4], d[4], dk[4], dd[4];
    assert_int_equal(m->nbearing, 3);
    assert_int_equal(m->bearing[1].like, 0);
    assert_close(m->bearing[1].std[1], 0.3, 0, 0);
    assert_memory_equal(m->bearing[1].film.k, full, sizeof full);
    assert_close(m->bearing[1].film.c[YX], 7, 0, 0);
    assert_int_equal(m->bearing[1].pedestal.count, 1);
    assert_close(m->bearing[1].pedestal.k[YY], 4e9, 0, 0);
    assert_close(m->bearing[2].std[1], 0.1, 0, 0);
    coefficients_at(&m->bearing[2].film, 2000 * RPM, k, d, dk, dd);
    assert_close(k[XX], 2e7, 1e-12, 0);
    assert_close(k[YY], 3e7, 1e-12, 0);
    assert_close(d[YY], 3, 1e-12, 0);
    assert_close(dk[XX], 2e7 / (2000 * RPM), 1e-12, 0);
    coefficients_at(&m->bearing[2].film, 500 * RPM, k, d, dk, dd);
    assert_close(k[XX], 1e7, 0, 0);
    assert_close(dk[XX], 0, 0, 0);
    coefficients_at(&m->bearing[2].film, 9000 * RPM, k, d, NULL, NULL);
    assert_close(k[YY], 4e7, 0, 0);
    assert_close(m->unbalance[0].phase, asin(1), 1e-15, 0);
    assert_close(m->probe[0].angle, atan(1), 1e-15, 0);
    assert_close(m->low, 3000 * RPM, 1e-15, 0);
    assert_close(m->change[0].factor, 0.9, 0, 0);
    assert_int_equal(m->without_spring[0], 1);
    assert_int_equal(m->ndisk, 1);
    assert_int_equal(c.job->rotor.ndisk, 0); /* the test knows nothing of it */
    running_case_close(&c);
}

POOL_TEST(units_of_the_deck_hold_for_the_machine)
{
    rotid_deck *deck;
    const char *text =
        "*UNITS, LENGTH=MM, STIFFNESS=N/UM\n*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, "
        "MATERIAL=s\n2000, 100, 0, 20\n*RUNNING\n*BEARING\n200, 100, 5\n*BEARING\n1800, 100, 5\n";
    assert_int_equal(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    const struct machine *m = deck_states_of(deck)->machine;
    assert_close(m->bearing[0].z, 0.2, 1e-15, 0);
    assert_close(m->bearing[0].film.k[YY], 1e8, 1e-15, 0);
    assert_close(m->bearing[0].film.c[XX], 5, 0, 0);
    rotid_deck_free(deck);
}

POOL_TEST(cards_that_cannot_be_are_refused_with_their_place)
{
    says(SHAFT "*RUNNING\n", ROTID_ERROR, 10, "free rotor has no critical speed");
    says(SHAFT "*BEARING\n0.2, 1, 1\n", ROTID_ERROR, 10, "stands before *RUNNING");
    says(SHAFT TWO "*RUNNING\n", ROTID_ERROR, 15, "given twice");
    says(SHAFT TWO "*SHAFT, NAME=b, MATERIAL=s\n1, 1, 0\n", ROTID_ERROR, 15, "stands behind *RUNNING");
    says(SHAFT TWO "*STATE, NAME=b\n", ROTID_ERROR, 15, "*STATE stands behind");
    says(SHAFT "*RUNNING, WITHOUT=x\n*BEARING\n0.2, 1, 1\n", ROTID_ERROR, 10, "no support or mass");
    says(SHAFT "*RUNNING\n*BEARING\n2.2, 1, 1\n", ROTID_ERROR, 12, "outside the rotor");
    says(SHAFT "*RUNNING\n*BEARING\n0.2, 1, 1, 1\n", ROTID_ERROR, 12, "3 coefficients, expected 2");
    says(SHAFT "*RUNNING\n*BEARING\n0.2, -1, 1\n", ROTID_ERROR, 12, "below zero, expected *PULL");
    says(SHAFT "*RUNNING\n*BEARING, STD=x\n0.2, 1, 1\n", ROTID_ERROR, 11, "no deviation");
    says(SHAFT TWO "*BEARING, NAME=p\n0.3, 1, 1\n", ROTID_ERROR, 15, "given twice");
    says(SHAFT TWO "*BEARING, LIKE=r\n0.3, 1, 1\n", ROTID_ERROR, 15, "bearing r is not defined");
    says(SHAFT TWO "*PEDESTAL, BEARING=p\n0, 1, 1, 1\n", ROTID_ERROR, 16, "mass mx [kg] is 0");
    says(SHAFT TWO "*LOSS\nx, 1\n", ROTID_ERROR, 16, "group x is not defined");
    says(SHAFT TWO "*LOSS\na, -1\n", ROTID_ERROR, 16, "not below zero");
    says(SHAFT TWO "*PULL, GROUP=a\n-1\n", ROTID_ERROR, 16, "not below zero");
    says(SHAFT TWO "*CHANGE\na.q, 1\n", ROTID_ERROR, 16, "no such parameter");
    says(SHAFT TWO "*CHANGE\na.nu, 2\n", ROTID_ERROR, 16, "a.nu times 2 is 0.6, expected a value above -1 and at most 0.5");
    says(SHAFT "*RUNNING, WITHOUT=f\n*CHANGE\nf.k, 2\n", ROTID_ERROR, 12, "f.k is of a part that is left at the test");
    says(SHAFT TWO "*PROBE, NAME=x\n3\n", ROTID_ERROR, 16, "outside the rotor");
    says(SHAFT TWO "*OPERATION\n5000, 4000\n", ROTID_ERROR, 16, "expected the lowest speed first");
    says(SHAFT TWO "*OPERATION, POLES=3\n4000, 5000\n", ROTID_ERROR, 15, "expected an even one");
    says(SHAFT TWO "*OPERATION, LINE=0\n4000, 5000\n", ROTID_ERROR, 15, "LINE");
    says(SHAFT TWO "*OPERATION, LINE=50, POLES=4\n1000, 1600\n", ROTID_WARNING, 16, "above 1500 rpm, the speed of the field");
    says(SHAFT TWO "*OPERATION, MARGIN=15\n4000, 5000\n", ROTID_ERROR, 15, "expected a share below 1");
    says(SHAFT TWO "*OPERATION, MARGIN=API617\n4000, 5000\n", ROTID_ERROR, 15, "expected *UNBALANCE and *PROBE");
    says(SHAFT TWO "*OPERATION, MARGIN=API541\n4000, 5000\n", ROTID_ERROR, 15, "MARGIN");
    says(SHAFT TWO "*OPERATION\n4000, 5000\n*OPERATION\n4000, 5000\n", ROTID_ERROR, 17, "given twice");
    says("*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*BEAM, NAME=a, MATERIAL=s\n2, 0.1, 0.1\n" TWO, ROTID_ERROR, 8,
         "is a *BEAM");
}

/* With x along the load: what holds the journal against its weight is kyy here. Signs as of a journal that drives forward whirl.
 */
POOL_TEST(a_bearing_is_turned_from_the_axes_of_its_load)
{
    struct running_case c;
    const double k[4] = {4, -3, 2, 1}, d[4] = {8, -7, 6, 5};
    assert_int_equal(running_case_open(SHAFT TWO "*BEARING, AXES=LOAD\n1, 1, -2, 3, 4, 5, -6, 7, 8\n", 100, 2, 0, &c), ROTID_OK);
    assert_memory_equal(c.machine->bearing[2].film.k, k, sizeof k);
    assert_memory_equal(c.machine->bearing[2].film.c, d, sizeof d);
    running_case_close(&c);
    says(SHAFT TWO "*BEARING, AXES=UP\n1, 1, 1\n", ROTID_ERROR, 15, "AXES");
}

/* G 2.5 of ISO 21940-11 at 3000 rpm: e = 7.96 um. */
POOL_TEST(a_grade_is_an_unbalance_of_the_whole_machine)
{
    struct running_case c;
    const double mass = 7800 * 3.14159265358979 / 4 * 0.01 * 2 + 30;
    assert_int_equal(running_case_open(SHAFT TWO "*DISK\n1, 30\n*UNBALANCE, G=2.5\n0.5, 0.25\n1.5, 0.75, 180\n*UNBALANCE\n1, "
                                                 "1e-3\n*OPERATION\n1000, 3000\n",
                                       3000, 3, 0, &c),
                     ROTID_OK);
    assert_close(c.machine->unbalance[0].value, 0.25 * 7.9577e-6 * mass, 1e-4, 0);
    assert_close(c.machine->unbalance[1].value, 0.75 * 7.9577e-6 * mass, 1e-4, 0);
    assert_close(c.machine->unbalance[2].value, 1e-3, 0, 0);
    running_case_close(&c);
    assert_int_equal(
        running_case_open(SHAFT TWO "*DISK\n1, 30\n*UNBALANCE, G=2.5\n0.5, 0.25\n*CHANGE\na.rho, 0.8\n*OPERATION\n1000, 3000\n",
                          3000, 3, 0, &c),
        ROTID_OK);
    assert_close(c.machine->unbalance[0].value, 0.25 * 7.9577e-6 * (0.8 * (mass - 30) + 30), 1e-4, 0);
    running_case_close(&c);
    assert_int_equal(running_case_open(
                         SHAFT
                         "*CAUSE, NAME=acc, TYPE=added_mass\nmass, 5\nz, 0.4\n*RUNNING, WITHOUT=acc\n*BEARING, NAME=p\n0.2, 1e8, "
                         "10\n*UNBALANCE, G=2.5\n0.5, 0.25\n*OPERATION\n1000, 3000\n",
                         3000, 3, 0, &c),
                     ROTID_OK); /* a cause that is gone has no mass */
    assert_close(c.machine->unbalance[0].value, 0.25 * 7.9577e-6 * (mass - 30), 1e-4, 0);
    running_case_close(&c);
    says(SHAFT TWO "*UNBALANCE, G=2.5\n1, 1\n", ROTID_ERROR, 10, "expected *OPERATION");
    says(SHAFT TWO "*UNBALANCE, G=-1\n1, 1\n", ROTID_ERROR, 15, "G");
}

/* All of the energy of a free shaft is its own: eta = 2 zeta, s = 2 zeta/w; the mean of two modes, and their scatter. */
POOL_TEST(a_loss_comes_from_the_damping_of_the_test)
{
    static const char *const begin =
        "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n2, 0.1, 0, 40\n*MODES\n1, "
        "111%s\n2, 301%s\n*RUNNING\n*BEARING\n0.2, 1e8, 10\n*BEARING\n1.8, 1e8, 10\n*LOSS, TEST%s\na\n";
    struct running_case c;
    rotid_spectrum *s;
    rotid_deck *deck;
    assert_int_equal(running_case_open(pool_format(&test_pool, begin, ", 0.004", ", 0.006", ""), 3000, 3, 0, &c), ROTID_OK);
    assert_close(c.machine->loss[0].value, 0.010, 1e-9, 0);
    assert_close(c.machine->loss[0].std, 0.002 * sqrt(2), 1e-9, 0);
    assert_int_equal(c.machine->loss[0].viscous, 0);
    running_case_close(&c);
    char *text = pool_format(&test_pool, begin, ", 0.004", "", ", TYPE=VISCOUS");
    assert_int_equal(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_int_equal(rotid_spectrum_compute(deck, NULL, 2, NULL, NULL, &s), ROTID_OK);
    assert_close(deck_states_of(deck)->machine->loss[0].value, 0.008 / (2 * 3.14159265358979323846 * s->modes[0].full_hz), 1e-6,
                 0);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
    says(pool_format(&test_pool, begin, "", "", ""), ROTID_ERROR, 17, "expected damping ratios in *MODES");
    says(SHAFT TWO "*LOSS, TEST\na\n", ROTID_ERROR, 16, "expected damping ratios");
    says(SHAFT TWO "*LOSS, TEST\na, 0.01\n", ROTID_ERROR, 16, "group alone with TEST");
}

/* A soft zone in the shaft makes the machine softer unless it was left at the test. */
static int tells_of_heavy(const char *text)
{
    rotid_deck *deck;
    int found = 0;
    assert_int_equal(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    for (int i = 0; i < deck->nmessage; i++)
        found +=
            strstr(deck->message[i].text, "the machine has the rotor of state heavy, the first one, with this *DISK") != NULL;
    rotid_deck_free(deck);
    return found;
}

/* And says so where that has something of its own. */
POOL_TEST(of_several_states_the_machine_has_the_rotor_of_the_first)
{
#define HEAVY    "*STATE, NAME=heavy\n*DISK, NAME=hub\n1, 5\n*MODES\n1, 100\n"
#define BARE     "*STATE, NAME=bare\n*MODES\n1, 110\n"
#define BEARINGS "*BEARING\n0.2, 1e8, 10\n*BEARING\n1.8, 1e8, 10\n"
    assert_true(tells_of_heavy(SHAFT HEAVY BARE "*RUNNING, WITHOUT=ALL\n" BEARINGS));
    assert_false(tells_of_heavy(SHAFT HEAVY BARE "*RUNNING, WITHOUT=hub\n" BEARINGS));
    assert_false(tells_of_heavy(SHAFT BARE HEAVY "*RUNNING\n" BEARINGS));
    assert_false(tells_of_heavy(SHAFT "*FIT, STATE=heavy\n" HEAVY BARE "*RUNNING\n" BEARINGS));
}

POOL_TEST(a_cause_is_left_at_the_test)
{
    struct running_case c;
    double speed[3];
    static const char *const cause = "*CAUSE, NAME=soft, TYPE=stiffness_local\ndepth, 0.5\nz, 1\nwidth, 0.14\n",
                             *const with[3] = {"*RUNNING", "*RUNNING, WITHOUT=soft", "*RUNNING"};
    for (int i = 0; i < 3; i++) {
        char *text =
            pool_format(&test_pool, SHAFT "%s%s\n*BEARING\n0.2, 1e8, 10\n*BEARING\n1.8, 1e8, 10\n", i < 2 ? cause : "", with[i]);
        assert_int_equal(running_case_open(text, 6000, 9, 0, &c), ROTID_OK);
        assert_true(c.speeds.ncritical_speeds > 0);
        speed[i] = c.speeds.critical_speeds[0].speed_rpm;
        running_case_close(&c);
    }
    assert_true(speed[0] < 0.99 * speed[2]);
    assert_close(speed[1], speed[2], 1e-9, 0);
}

/* A support or a disk that is left at the test leaves nothing behind: no stiffness about or along the axis, no hub, no cause of
 * its own. */
POOL_TEST(what_is_left_at_the_test_is_left_with_all_of_it)
{
    static const char *const had[6] =
        {"*SPRING, NAME=held\nend, 1e6, 1e5, 1e7, 1e9\n*DISK, NAME=hub\n1, 20, 0.1, 0.2, 0.3, 0.3\n*CAUSE, NAME=fit, "
         "TYPE=hub_stiffness\nshare, 1\n",
         "*DISK, NAME=hub\n0.6, 20\n*CAUSE, NAME=more, TYPE=added_inertia, AT=hub\ninertia, 2\n",
         "*CLAMP, NAME=held, AT=end\n",
         "*CAUSE, NAME=cord, TYPE=support_rotation\nstiffness, 9e6\nz, 0.6\n",
         "*SENSORS\n1, 1\n*CAUSE, NAME=cell, TYPE=accelerometer_mass, SENSOR=1, MOUNT=FIXED\nmass, 0.2\n",
         ""},
                             *const gone[6] = {"f, held, hub", "f, hub", "f, held", "ALL", "ALL", "f"};
    double speed[6], torsion[6], count[6];
    for (int i = 0; i < 6; i++) {
        struct running_case c;
        char *text =
            pool_format(&test_pool, SHAFT "%s*RUNNING\n%s\n*BEARING\n0.2, 1e8, 10\n*BEARING\n1.8, 1e8, 10\n", had[i], gone[i]);
        assert_int_equal(running_case_open(text, 9000, 9, 0, &c), ROTID_OK);
        count[i] = c.speeds.ncritical_speeds;
        assert_true(count[i] > 0 && c.speeds.ntorsion > 0);
        speed[i] = c.speeds.critical_speeds[0].speed_rpm;
        torsion[i] = c.speeds.torsion[0].frequency_hz;
        running_case_close(&c);
    }
    for (int i = 0; i < 5; i++) {
        assert_close(count[i], count[5], 0, 0);
        assert_close(speed[i], speed[5], 1e-4, 0); /* a hub has nodes of its own */
        assert_close(torsion[i], torsion[5], 1e-2, 0);
    }
    for (int i = 3; i < 5; i++)
        says(pool_format(&test_pool, SHAFT "%s" TWO, had[i]), ROTID_WARNING, 0,
             i == 3 ? "the machine has cord" : "the machine has cell");
}

#define MODES "*NOISE, FREQUENCY=1e-3\n*MODES\n1, 100\n*IDENTIFY\na.E, 1e10, 1e12, 2e11\n" /* five lines */

POOL_TEST(a_run_up_that_cannot_be_is_refused_with_its_place)
{
    says(SHAFT TWO "*RUNUP\n1, 4000\n", ROTID_ERROR, 16, "standard deviation of it [rpm]");
    says(SHAFT TWO "*RUNUP\n1, 4000, 0\n", ROTID_ERROR, 16, "standard deviation of it [rpm] is 0");
    says(SHAFT TWO "*RUNUP\n0, 4000, 1\n", ROTID_ERROR, 16, "number of the critical speed");
    says(SHAFT TWO "*RUNUP\n1, -4000, 1\n", ROTID_ERROR, 16, "critical speed [rpm] is -4000");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1, UPWARD\n", ROTID_ERROR, 16, "expected one of FORWARD, BACKWARD");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n1, 4100, 1, FORWARD\n", ROTID_ERROR, 17, "critical speed 1 is given twice");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*RUNUP\n2, 4100, 1\n", ROTID_ERROR, 17, "given twice");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\nr.k, 0.1, 2, 1\n", ROTID_ERROR, 18, "no unknown of the machine");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\np.m, 0.1, 2, 1\n", ROTID_ERROR, 18, "no unknown of the machine");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\np.k, 0.1, 2, 3\n", ROTID_ERROR, 18, "expected a value between its bounds");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\np.k, -1, 2, 1\n", ROTID_ERROR, 18, "lower bound");
    says(SHAFT TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\np.k, 0.1, 2, 1\np.k, 0.1, 2, 1\n", ROTID_ERROR, 19, "given twice");
    says(SHAFT TWO "*BEARING, NAME=r, LIKE=p\n1, 1, 1\n*RUNUP\n1, 4000, 1\n*IDENTIFY\nr.k, 0.1, 2, 1\n", ROTID_ERROR, 20,
         "r is like p, expected p.k");
    says(SHAFT TWO "*IDENTIFY\np.k, 0.1, 2, 1\n", ROTID_ERROR, 10, "expected *RUNUP");
    says(SHAFT MODES "*FIT, HOLDOUT=RUNUP\n" TWO, ROTID_ERROR, 15, "the machine has no *RUNUP");
    says(SHAFT MODES "*FIT, HOLDOUT=RUNUP\n", ROTID_ERROR, 15, "the deck has no machine");
    says(SHAFT MODES "*FIT, HOLDOUT=RUNUP\n" TWO "*RUNUP\n1, 4000, 1\n*IDENTIFY\np.k, 0.1, 2, 1\n", ROTID_ERROR, 16,
         "the run-up is held out");
    says(SHAFT MODES "*FIT, FUNCTIONAL=HYBRID\n" TWO "*RUNUP\n1, 4000, 1\n", ROTID_ERROR, 16,
         "expected *FIT, FUNCTIONAL=LIKELIHOOD");
    says(SHAFT MODES "p.k, 0.1, 2, 1\n" TWO, ROTID_ERROR, 15, "p is a *BEARING, expected its unknowns in an *IDENTIFY behind");
}

POOL_TEST(tables_of_bearings_are_refused_by_their_cells)
{
    const char *text = SHAFT "*RUNNING\n*BEARING, FILE=bad.csv\n0.2\n";
    says(text, ROTID_ERROR, 11, "cannot read");
    (void)folder_write("bad.csv", "speed_rpm,kxx,kyy,cxx\n0,1,1,1\n");
    says(text, ROTID_ERROR, 1, "no column cyy");
    (void)folder_write("bad.csv", "speed_rpm,kxx,kyy,cxx,cyy\n100,1,1,1,1\n50,1,1,1,1\n");
    says(text, ROTID_ERROR, 3, "do not rise");
    (void)folder_write("bad.csv", "speed_rpm,kxx,kyy,cxx,cyy\n100,1,x,1,1\n");
    says(text, ROTID_ERROR, 2, "'x' is not a number");
    (void)folder_write("bad.csv", "speed_rpm,kxx,kyy,cxx,cyy\n");
    says(text, ROTID_ERROR, 11, "has 1 rows");
}

/* A pedestal k - m w^2 + i w c by its dynamic stiffness: with its mass the same machine, with another one the same response,
 * which is at the frequency of the spin. */
POOL_TEST(a_pedestal_by_its_dynamic_stiffness)
{
    const double m = 150, k = 6e8, d = 2e4;
    char *table = pool_copy_text(&test_pool, "frequency_hz,kx_re,kx_im,ky_re,ky_im\n");
    const char *under = "*PEDESTAL, BEARING=p, FILE=stand.csv\n%g, %g\n", *rest = "*UNBALANCE\n1, 1e-3\n*PROBE, NAME=x\n1\n";
    struct running_case c[3];
    says(pool_format(&test_pool, SHAFT TWO "*PEDESTAL, BEARING=p, FILE=none.csv\n1, 1\n"), ROTID_ERROR, 15, "cannot read");
    (void)folder_write("stand.csv", "frequency_hz,kx_re,kx_im,ky_re\n1,1,1,1\n");
    says(pool_format(&test_pool, SHAFT TWO "*PEDESTAL, BEARING=p, FILE=stand.csv\n1, 1\n"), ROTID_ERROR, 1, "no column ky_im");
    (void)folder_write("stand.csv", "frequency_hz,kx_re,kx_im,ky_re,ky_im\n0,1,1,1,1\n");
    says(pool_format(&test_pool, SHAFT TWO "*PEDESTAL, BEARING=p, FILE=stand.csv\n1, 1\n"), ROTID_ERROR, 2,
         "frequency [Hz] is 0");
    says(pool_format(&test_pool, SHAFT TWO "*PEDESTAL, BEARING=p, FILE=stand.csv\n1, 1, 1\n"), ROTID_ERROR, 16, "mx, my alone");
    for (int hz = 1; hz <= 200; hz++) {
        double w = 6.283185307179586 * hz;
        table = pool_format(&test_pool, "%s%d,%.17g,%.17g,%.17g,%.17g\n", table, hz, k - m * w * w, w * d, k - m * w * w, w * d);
    }
    (void)folder_write("stand.csv", table);
    for (int i = 0; i < 3; i++) {
        char *pedestal = i ? pool_format(&test_pool, under, i * m, i * m)
                           : pool_format(&test_pool, "*PEDESTAL, BEARING=p\n%g, %g, %g, %g, %g, %g\n", m, m, k, k, d, d);
        char *text = pool_format(&test_pool, SHAFT TWO "%s%s", pedestal, rest);
        const char *file = strstr(text, "stand.csv");
        if (file)
            text = pool_format(&test_pool, "%.*s%s%s", (int)(file - text), text, folder_path("stand.csv"),
                               file + strlen("stand.csv"));
        assert_int_equal(running_case_open(text, 9000, 31, 0, &c[i]), ROTID_OK);
    }
    assert_true(c[0].speeds.ncritical_speeds >= 2);
    for (int i = 0; i < c[0].speeds.ncritical_speeds; i++) {
        assert_close(c[1].speeds.critical_speeds[i].speed_rpm, c[0].speeds.critical_speeds[i].speed_rpm, 1e-9, 0);
        assert_close(c[1].speeds.critical_speeds[i].log_decrement, c[0].speeds.critical_speeds[i].log_decrement, 1e-7, 1e-12);
    }
    const double *same = c[0].speeds.unbalance[0].amplitude_m;
    for (int i = 0; i < c[0].speeds.unbalance[0].nspeed_rpm; i += 7) {
        assert_close(c[1].speeds.unbalance[0].amplitude_m[i], same[i], 1e-8, 0);
        if (c[2].speeds.unbalance[0].speed_rpm[i] == c[0].speeds.unbalance[0].speed_rpm[i] && i < 90)
            assert_close(c[2].speeds.unbalance[0].amplitude_m[i], same[i], 1e-4, 0);
    }
    for (int i = 0; i < 3; i++)
        running_case_close(&c[i]);
}

POOL_TEST(lines_of_excitation)
{
    struct running_case c;
    assert_int_equal(running_case_open(SHAFT TWO "*OPERATION, LINE=50, POLES=4\n1000, 1500\n", 3000, 3, 0, &c), ROTID_OK);
    assert_int_equal(c.speeds.nexcitation, 4);
    assert_string_equal(c.speeds.excitation[3].name, "2x line");
    assert_close(c.speeds.excitation[3].hz, 100, 0, 0);
    assert_close(c.speeds.excitation[3].per_revolution, 0, 0, 0);
    running_case_close(&c);
    assert_int_equal(running_case_open(SHAFT TWO "*OPERATION, POLES=4\n1000, 1500\n", 3000, 3, 0, &c), ROTID_OK);
    assert_close(c.speeds.excitation[2].per_revolution, 2, 0, 0); /* a converter */
    assert_close(c.speeds.excitation[2].hz, 0, 0, 0);
    assert_close(c.speeds.excitation[3].per_revolution, 4, 0, 0);
    running_case_close(&c);
}

POOL_TEST(a_bearing_that_is_not_what_it_seems_is_warned_of)
{
    says(SHAFT TWO "*BEARING\n1, 1e8, -1e7, 1e7, 1e8, 1, 0, 0, 1\n", ROTID_WARNING, 15, "drives backward whirl");
    says(SHAFT TWO "*BEARING\n1, 1e8, 0, 0, 1e8, -1, 0, 0, 1\n", ROTID_WARNING, 15,
         "direct damping of this bearing is below zero");
    says(SHAFT TWO "*DISK\n1, 5, 0.1\n", ROTID_WARNING, 0, "no polar one");
    says(SHAFT "*DISK, NAME=d\n1, 5\n*CAUSE, TYPE=added_inertia, AT=d, NAME=c\ninertia, 0.1\n" TWO, ROTID_WARNING, 0,
         "no polar one");
}

/* Ip = int r^2 dm, Id = int (r^2/2 + z^2) dm: no more than twice. */
POOL_TEST(a_disk_with_more_polar_inertia_than_a_body_has_is_warned_of)
{
    rotid_deck *deck;
    says(SHAFT TWO "*DISK\n1, 5, 0.1, 0.3\n", ROTID_WARNING, 0, "is 3 times the diametral one, expected at most 2 times");
    says(SHAFT "*DISK, NAME=d\n1, 5, 0.15, 0.19\n*CAUSE, TYPE=added_inertia, AT=d, NAME=c\ninertia, -0.12\n" TWO, ROTID_WARNING,
         14, "disk d has 0.03 kg.m2 about a diameter and 0.19 about the axis, expected at most twice as much");
    const char *thin = SHAFT TWO "*DISK\n1, 5, 0.123, 0.247\n"; /* 2 but for the digits */
    assert_status(rotid_deck_read_text(strlen(thin), thin, "deck", folder_path("."), 0, NULL, NULL, NULL, &deck), ROTID_OK);
    for (int i = 0; i < deck->nmessage; i++)
        assert_null(strstr(deck->message[i].text, "times the diametral one"));
    rotid_deck_free(deck);
}

/* What a diagnosis or a suggestion writes keeps the machine, last of all. */
POOL_TEST(written_decks_keep_the_machine)
{
    const struct deck_write_options options = {.x = NULL};
    struct running_case c;
    struct message_list notes;
    char *text, *with;
    message_open(&notes, &test_pool);
    assert_int_equal(running_case_open(SHAFT TWO "*DISK, NAME=fan\n1, 5, 0.1, 0.2\n", 3000, 3, 0, &c), ROTID_OK);
    struct states states = *deck_states_of(c.deck);
    assert_int_equal(deck_write(&test_pool, &states, &states, &options, &notes, &text), ROTID_OK);
    assert_non_null(strstr(text, TWO "*DISK, NAME=fan\n1, 5, 0.1, 0.2\n"));
    assert_int_equal(deck_add_state(&test_pool, c.job->origin, NULL, "*STATE, NAME=next\n*SPRING\nend, 1e4\n", &with), ROTID_OK);
    assert_true(strstr(with, "*STATE, NAME=next") && strstr(with, "*RUNNING") > strstr(with, "*STATE, NAME=next"));
    running_case_close(&c);
}

POOL_TEST(what_does_not_hold_the_rotor_is_refused)
{
    struct running_case c;
    assert_int_equal(running_case_open(SHAFT "*RUNNING, WITHOUT=ALL\n*BEARING\n0.2, 1e8, 1\n", 3000, 3, 0, &c),
                     ROTID_ERROR_STIFFNESS);
    running_case_close(&c);
    rotid_deck *deck;
    rotid_speeds *speeds;
    char failure[ROTID_FAILURE_LENGTH];
    const char *loose = SHAFT "*RUNNING, WITHOUT=ALL\n*BEARING\n0.2, 1e8, 1\n";
    assert_int_equal(rotid_deck_read_text(strlen(loose), loose, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_int_equal(rotid_speeds_compute(deck, NULL, NULL, failure, &speeds), ROTID_ERROR_STIFFNESS);
    assert_non_null(strstr(failure, "deck:10:1: the bearings do not hold the rotor"));
    rotid_deck_free(deck);
    assert_int_equal(running_case_open(SHAFT TWO "*PULL, GROUP=a\n1e9\n", 3000, 3, 0, &c), ROTID_ERROR_STIFFNESS);
    running_case_close(&c);
    assert_int_equal(running_case_open(SHAFT TWO "*PULL, GROUP=a\n1e5\n", 3000, 3, 0, &c), ROTID_OK);
    running_case_close(&c);
    static const struct {
        const char *more;
        int status;
    } damped[] = {{"*BEARING\n1, 0, 1e8\n", ROTID_OK},
                  {"*BEARING\n1, 0, 1e14\n", ROTID_ERROR_STIFFNESS},
                  {"*LOSS, TYPE=VISCOUS\na, 1e-4\n", ROTID_OK},
                  {"*LOSS, TYPE=VISCOUS\na, 1e5\n", ROTID_ERROR_STIFFNESS}};
    for (size_t i = 0; i < sizeof damped / sizeof *damped; i++) {
        assert_int_equal(running_case_open(pool_format(&test_pool, SHAFT TWO "%s", damped[i].more), 3000, 3, 0, &c),
                         damped[i].status);
        running_case_close(&c);
    }
}

TEST_GROUP(folder_make, folder_remove);
