/* The virtual hammer test on a deck of several states: each is the rotor of its own cards, and the deck that is written names the
 * modes file of each. From records to moduli: docs/hammer.md. */
#include "support.h"

#include "exact.h"
#include "folder.h"
#include "hammer/hammer.h"
#include "hide/hide_states.h"
#include "reading.h"

#define COMMON                                                                                                                   \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.06e11, 0.795e11, 0.30\n*DENSITY\n7850\n"                                     \
    "*SHAFT, NAME=bar, MATERIAL=steel\n1.2, 0.02848, 0, 40\n*SPRING, NAME=left\nstart, 200\n*SPRING, NAME=right\nend, 200\n"
#define SENSORS "*SENSORS\n1, 0\n2, 0.4\n3, 0.8\n4, 1.2\n"
#define UNKNOWN "*IDENTIFY\nbar.E, 1e11, 3e11, 1.9e11\n"
#define DISC    "*DISK\n0.45, 0.5\n"
#define DECK    COMMON SENSORS UNKNOWN "*STATE, NAME=free\n*STATE, NAME=disc\n" DISC
#define FIT     "*FIT, FUNCTIONAL=LIKELIHOOD, REDUCTION=NONE\n"

static char *text_of(const char *deck, const char *name, char *message, size_t room)
{
    const struct hide_message to = {message, room};
    struct hide_cards cards;
    int first, end, status;
    assert_int_equal(hide_cards_read(deck, "deck", &cards, &to), HIDE_OK);
    char *text = hide_state_text(deck, "deck", name, &cards, &first, &end, &status, &to);
    hide_cards_free(&cards);
    assert_true((status == HIDE_OK) == (text != NULL));
    return text;
}

POOL_TEST(a_state_has_the_modes_of_its_own_rotor)
{
    static const char *const name[] = {"free", "disc"}, *const own[] = {COMMON SENSORS, COMMON SENSORS DISC};
    static const char *const truth[] = {"bar.E=2.06e11"};
    struct hammer_options options = hammer_options_default();
    for (int s = 0; s < 2; s++) {
        char message[600] = "", *text = text_of(DECK, name[s], message, sizeof message);
        struct hammer_test test;
        struct exact exact;
        double hz[4];
        if (hammer_open(text, "deck", 1, truth, 1, &options, &test, message, sizeof message))
            fail_msg("%s", message);
        const struct states states = read_states(own[s]);
        exact_open(&states.state[0].job.rotor, &exact);
        exact_hz(&exact, 3, 4, hz);
        assert_int_equal(test.points, 4);
        for (int k = 0; k < 4; k++)
            assert_close(test.bare_hz[test.rigid + k], hz[k], 1e-9, 0);
        hammer_close(&test);
        free(text);
    }
}

static const char *written(const char *deck, const char *name, const char *modes)
{
    char message[600] = "";
    const char *path = folder_path("out.inp");
    if (hammer_write_state(deck, name, modes, path, message, sizeof message))
        fail_msg("%s", message);
    char *bytes = file_bytes(path, NULL);
    const char *text = pool_copy_text(&test_pool, bytes);
    free(bytes);
    return text;
}

/* A state that was tested has the sensors of its file, the others those of the deck until then. */
POOL_TEST(the_deck_of_one_test_is_the_rotor_of_the_next)
{
    const char *one = written(DECK, "Free", "free.unv"), *both = written(one, "disc", "disc.unv");
    assert_string_equal(one, COMMON UNKNOWN FIT "*STATE, NAME=free\n*MEASURED, FILE=free.unv, AXIS=Z, DIRECTION=X\n"
                                                "*STATE, NAME=disc\n" SENSORS DISC);
    assert_string_equal(both, COMMON UNKNOWN FIT "*STATE, NAME=free\n*MEASURED, FILE=free.unv, AXIS=Z, DIRECTION=X\n"
                                                 "*STATE, NAME=disc\n" DISC "*MEASURED, FILE=disc.unv, AXIS=Z, DIRECTION=X\n");
}

POOL_TEST(another_state_is_refused)
{
    char message[600] = "";
    assert_null(text_of(DECK, "bearings", message, sizeof message));
    assert_string_equal(message, "--state bearings: expected a *STATE of deck");
    assert_null(text_of(COMMON SENSORS, "free", message, sizeof message));
    assert_int_equal(hammer_write_state(DECK, "x", "m.unv", folder_path("none.inp"), message, sizeof message), HAMMER_INPUT);
}

TEST_GROUP(folder_make, folder_remove);
