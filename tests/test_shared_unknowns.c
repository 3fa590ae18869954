/* One unknown of several groups. The same rotor with these groups as one, whose sections they are, has that unknown without being
 * told: fits, derivatives and decks have to agree. */
#include "deck/deck.h"
#include "derivative_check.h"
#include "folder.h"
#include "model/model.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define MATERIAL                                                                                                                 \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.3\n*DENSITY\n7850\n"                                           \
    "*MATERIAL, NAME=stack\n*ELASTIC, TYPE=SHEAR\n0.8e11, 3e10, 0.3\n*DENSITY\n7600\n"
#define APART                                                                                                                    \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.06, 0, 10\n*SHAFT, NAME=right, MATERIAL=steel\n0.2, 0.08, 0.01, 10\n"             \
    "*SHAFT, NAME=core, MATERIAL=stack\n0.4, 0.14, 0, 16\n"
#define TOGETHER                                                                                                                 \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.06, 0, 10\n0.2, 0.08, 0.01, 10\n*SHAFT, NAME=core, MATERIAL=stack\n0.4, 0.14, "   \
    "0, 16\n"
#define MODES "*MODES\n1, 380\n2, 940\n3, 1930\n4, 2950\n5, 4200\n*NOISE, FREQUENCY=0.001\n"
#define CORE  "core.E, 1e10, 2e11, 0.7e11\n"

static void assert_same_fit(const char *shared, const char *one, double tolerance)
{
    struct reading a, b;
    struct identification fit_a, fit_b;
    read_text(&a, shared, NULL);
    read_text(&b, one, NULL);
    assert_int_equal(a.job.unknowns.nparameter, b.job.unknowns.nparameter);
    assert_status(identify_run(&a.pool, &a.job, 0, NULL, &a.messages, &fit_a), ROTID_OK);
    assert_status(identify_run(&b.pool, &b.job, 0, NULL, &b.messages, &fit_b), ROTID_OK);
    for (int p = 0; p < a.job.unknowns.nparameter; p++) {
        assert_close(fit_a.fit->x[p], fit_b.fit->x[p], tolerance, 0);
        assert_close(fit_a.fit->std[p], fit_b.fit->std[p], 100 * tolerance, 0);
    }
    assert_close(fit_a.fit->chi2, fit_b.fit->chi2, 100 * tolerance, 1e-9);
    rotid_fit_free(fit_a.fit);
    rotid_fit_free(fit_b.fit);
    pool_close(&a.pool);
    pool_close(&b.pool);
}

UNIT_TEST(two_groups_with_one_unknown_are_one_group)
{
    assert_same_fit(MATERIAL APART MODES "*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n" CORE,
                    MATERIAL TOGETHER MODES "*IDENTIFY\nleft.E, 1e10, 1e12, 1.9e11\n" CORE, 1e-8);
    assert_same_fit(MATERIAL APART MODES "*IDENTIFY\nright.rho = left.rho, 1e3, 1e5, 7e3\n" CORE,
                    MATERIAL TOGETHER MODES "*IDENTIFY\nleft.rho, 1e3, 1e5, 7e3\n" CORE, 1e-8);
    assert_same_fit(MATERIAL APART MODES "*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n" CORE "*FIT, TIE=E:G\n",
                    MATERIAL TOGETHER MODES "*IDENTIFY\nleft.E, 1e10, 1e12, 1.9e11\n" CORE "*FIT, TIE=E:G\n", 1e-8);
}

UNIT_TEST(a_solid_shares_unknowns_as_well)
{
    assert_same_fit(MATERIAL APART MODES "*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n" CORE "*FIT, MODEL=SOLID, MODES=1-3\n",
                    MATERIAL TOGETHER MODES "*IDENTIFY\nleft.E, 1e10, 1e12, 1.9e11\n" CORE "*FIT, MODEL=SOLID, MODES=1-3\n",
                    1e-7);
}

/* A shaft under a force and the ring around it: the force is shared by their stiffness, which the unknown does not change alone.
 */
static void assert_derivatives(const char *fit)
{
    static const char text[] = MATERIAL APART "*LAYER, NAME=ring, GROUP=core, MATERIAL=stack\n0.2, 0.14\n"
                                              "*PRELOAD, GROUP=core\n2e6\n" MODES
                                              "*IDENTIFY\ncore.E=ring.E=left.E, 1e10, 2e11, 0.7e11\nright.E, 1e10, 1e12, 2e11\n";
    struct reading r;
    struct rotor_model model;
    const double steps[] = {1e-3, 1e-3}, x[] = {0.8e11, 2.1e11};
    int failed;
    char deck[2048];
    (void)snprintf(deck, sizeof deck, "%s%s", text, fit);
    char *steel = strstr(deck, "2.1e11, 8e10"); /* what is shared is stated alike */
    memcpy(steel, "0.8e11, 8e10", strlen("0.8e11, 8e10"));
    read_text(&r, deck, NULL);
    assert_status(model_open(&r.pool, r.job.models, &r.job.rotor, 2, r.job.unknowns.parameter, 1, &model, &failed), ROTID_OK);
    check_derivatives(&r.pool, &model.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, model.equations.nrigid,
                      model.equations.nrigid + 3, x, steps, 1e-6);
    pool_close(&r.pool);
}

UNIT_TEST(the_derivative_is_that_of_all_its_groups)
{
    assert_derivatives("");
    assert_derivatives("*FIT, MODEL=SOLID\n");
}

UNIT_TEST(what_cannot_be_shared_is_said)
{
    static const char *const wrong[][2] = {
        {"left.E=right.G, 1e10, 1e12, 1.9e11\n", "right.G in left.E=right.G cannot be shared"},
        {"left.E=nobody.E, 1e10, 1e12, 1.9e11\n", "nobody.E in left.E=nobody.E cannot be shared"},
        {"left.E=, 1e10, 1e12, 1.9e11\n", " in left.E= cannot be shared"},
        {"left.E=right.E=left.E, 1e10, 1e12, 1.9e11\n", "left.E stands twice"},
        {"left.E=core.E, 1e10, 1e12, 1.9e11\n", "core.E is 8e+10 and left.E 2.1e+11 in the deck"},
        {"left.E=right.E, 1e10, 1e12, 1.9e11\nright.E, 1e10, 1e12, 1.9e11\n", "right.E is given twice"},
        {"right.E, 1e10, 1e12, 1.9e11\nleft.E=right.E, 1e10, 1e12, 1.9e11\n", "left.E=right.E is given twice"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[2048];
        struct reading r;
        (void)snprintf(text, sizeof text, MATERIAL APART MODES "*IDENTIFY\n%s", wrong[i][0]);
        try_path(&r, folder_write("deck.inp", text), NULL);
        assert_status(r.status, ROTID_ERROR_SYNTAX);
        if (!strstr(r.messages.item[0].text, wrong[i][1]))
            fail_msg("%s: %s", wrong[i][0], r.messages.item[0].text);
        pool_close(&r.pool);
    }
}

/* *SET in a state: of all that share the unknown, or an error. */
UNIT_TEST(a_state_sets_what_is_shared)
{
#define STATES(SET)                                                                                                              \
    MATERIAL APART "*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n" CORE "*STATE, NAME=known\n*SET\n" SET "\n" MODES            \
                   "*STATE, NAME=open\n" MODES
    struct pool pool;
    struct message_list messages;
    struct states states;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    const char *path = folder_write("deck.inp", STATES("left.E=right.E, 2e11"));
    assert_status(deck_read_states(&pool, path, NULL, 0, NULL, &messages, &states), ROTID_OK);
    assert_true(states.state[0].job.rotor.group[0].material.e == 2e11 && states.state[0].job.rotor.group[1].material.e == 2e11);
    assert_int_equal(states.state[0].job.unknowns.nparameter, 1);
    assert_int_equal(states.state[1].job.unknowns.nparameter, 2);
    path = folder_write("deck.inp", STATES("left.E, 2e11"));
    message_open(&messages, &pool);
    assert_status(deck_read_states(&pool, path, NULL, 0, NULL, &messages, &states), ROTID_ERROR_SYNTAX);
    assert_non_null(strstr(messages.item[0].text, "left.E has a value in common with the unknown left.E=right.E"));
    pool_close(&pool);
}

UNIT_TEST(a_deck_with_shared_unknowns_is_written_and_read)
{
    struct reading r, again;
    char *text;
    const double x[] = {1.7e11, 0.6e11};
    const struct deck_write_options at = {.x = x};
    read_text(&r, MATERIAL APART MODES "*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n" CORE, NULL);
    struct state only;
    const struct states states = states_of(&r.job, &only);
    assert_status(deck_write(&r.pool, &states, &states, &at, &r.messages, &text), ROTID_OK);
    read_text(&again, text, NULL);
    assert_true(again.job.unknowns.bounds[0].start == 1.7e11);
    assert_string_equal(again.job.unknowns.bounds[0].name, "left.E=right.E");
    assert_int_equal(again.job.unknowns.parameter[0].nalso, 1);
    pool_close(&again.pool);
    pool_close(&r.pool);
}

TEST_GROUP(folder_make, folder_remove);
