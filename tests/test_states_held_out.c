/* A whole state predicted from the others, with a beam and with a solid. The data come from exact dynamic stiffness of the rotor
 * in each state, which shares no code with librotid: with the truth in the model the state that is held out is predicted, and
 * with a mistake in the model of a common part it is not. */
#include "support.h"

#include "exact.h"
#include "folder.h"
#include "reading.h"

#define E_TRUE 1.9e11
#define ROTOR                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC\n1.9e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=left, MATERIAL=steel\n0.6, 0.040, 0, 12\n"       \
    "*SHAFT, NAME=core, MATERIAL=steel\n0.9, 0.040, 0, 18\n*NOISE, FREQUENCY=0.001\n"
#define TIED "*FIT, TIE=E:G, HOLDOUT=STATE:%s%s\n*IDENTIFY\ncore.E, 5e10, 5e11, 2.2e11\nleft.E, 5e10, 5e11, 2.2e11\n"

static const char *const name[] = {"free", "disc", "bearings"};
static const char *const cards[] = {"", "*DISK\n0.45, 1.5, 0.002, 0.004\n", "*SPRING\n0.1, 2e7\n1.3, 1e7\n"};

/* The first three elastic modes of a state as the oracle has them. */
static void measure(int state, double *hz)
{
    struct exact exact;
    const struct states states = read_states(pool_format(&test_pool, ROTOR "%s", cards[state]));
    exact_open(&states.state[0].job.rotor, &exact);
    exact_hz(&exact, state == 2 ? 1 : 3, 3, hz); /* free: behind two motions as a rigid body */
}

static const char *deck(int held, const char *model, const char *mistake)
{
    char *text = pool_format(&test_pool, ROTOR TIED, name[held], model);
    for (int s = 0; s < 3; s++) {
        double hz[3];
        measure(s, hz);
        text = pool_format(&test_pool, "%s*STATE, NAME=%s\n%s*MODES\n1, %.9f\n2, %.9f\n3, %.9f\n", text, name[s],
                           s == 1 && mistake ? mistake : cards[s], hz[0], hz[1], hz[2]);
    }
    return folder_write("deck.inp", text);
}

/* The largest error of a mode that is held out, or of one that is fitted [%]; *e: of the core. */
static void run(const char *path, int held, double *error, double *fitted, double *e)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *read;
    rotid_identification *found;
    assert_status(rotid_deck_read(path, 0, NULL, NULL, failure, &read), ROTID_OK);
    assert_status(rotid_identify(read, 0, NULL, failure, &found), ROTID_OK);
    assert_int_equal(found->nstates, 3);
    *error = *fitted = 0;
    for (int s = 0; s < 3; s++)
        for (int k = 0; k < 3; k++) {
            double *to = s == held ? error : fitted;
            assert_int_equal(found->states[s].modes[k].holdout, s == held);
            *to = fmax(*to, fabs(found->states[s].modes[k].error_percent));
        }
    *e = found->parameters[0].value;
    rotid_identification_free(found);
    rotid_deck_free(read);
}

/* The mesh of a beam leaves parts in a million at these elements, the beam itself two hundredths of a per cent of a solid. */
POOL_TEST(a_state_is_predicted_from_the_others)
{
    static const char *const model[] = {"", ", MODEL=SOLID"};
    static const double within[] = {0.01, 0.03};
    for (int m = 0; m < 2; m++)
        for (int held = 0; held < (m ? 1 : 3); held++) {
            double error, fitted, e;
            run(deck(held, model[m], NULL), held, &error, &fitted, &e);
            assert_true(error < within[m] && fitted < within[m]);
            assert_close(e, E_TRUE, m ? 0.005 : 2e-4, 0);
        }
}

/* The disc is half as heavy as it was: where its state is fitted the moduli absorb part of that, where it is held out nothing. */
POOL_TEST(a_mistake_in_a_state_shows_where_it_is_held_out)
{
    static const char *const model[] = {"", ", MODEL=SOLID"};
    for (int m = 0; m < 2; m++) {
        double error, fitted, e;
        run(deck(1, model[m], "*DISK\n0.45, 0.75, 0.001, 0.002\n"), 1, &error, &fitted, &e);
        assert_true(error > 3 && fitted < 0.03);
        assert_close(e, E_TRUE, 0.005, 0);
    }
}

TEST_GROUP(folder_make, folder_remove);
