/* Decks of several states: what each state is made of, which unknowns they share, and what is refused, with its place. */
#include "one_state.h"
#include "support.h"

#include "deck/deck.h"
#include "folder.h"

#define BAR                                                                                                                      \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.3\n*DENSITY\n7850\n"                                           \
    "*SHAFT, NAME=bar, MATERIAL=steel\n0.25, 0.05, 0, 10\n0.75, 0.05, 0, 30\n*DISK, NAME=d\nend, 1\n"                            \
    "*SENSORS\n1, 0\n2, bar.end\n*NOISE, FREQUENCY=0.001\n"
#define UNKNOWN "*IDENTIFY\nbar.E, 1e10, 1e12, 1e11\n"
#define FREE    "*STATE, NAME=free\n*MODES\n1, 225\n2, 610\n"
#define LOADED                                                                                                                   \
    "*STATE, NAME=loaded\n*DISK\n0.5, 3\n*SENSORS\n7, 0.3\n*NOISE, FREQUENCY=0.002\n*IDENTIFY\nd.mass, 0.1, 30, 2\n*MODES\n1, "  \
    "190\n"

struct reading {
    struct message_list messages;
    struct states states;
    int status;
};

static struct reading read_text(const char *text, const char *set)
{
    struct reading r = {.status = 0};
    struct override override;
    message_open(&r.messages, &test_pool);
    if (set)
        assert_status(override_parse(&test_pool, set, &override), ROTID_OK);
    r.status =
        deck_read_states(&test_pool, folder_write("states.inp", text), NULL, set != NULL, &override, &r.messages, &r.states);
    return r;
}

static struct states good(const char *text, const char *set)
{
    struct reading r = read_text(text, set);
    for (size_t i = 0; i < r.messages.count; i++)
        print_message("%s\n", r.messages.item[i].text);
    assert_status(r.status, ROTID_OK);
    assert_int_equal(r.messages.count, 0);
    return r.states;
}

static void assert_refused(const char *text, int line, const char *why)
{
    struct reading r = read_text(text, NULL);
    assert_status(r.status, ROTID_ERROR_SYNTAX);
    assert_string_equal(r.messages.item[0].text, why);
    assert_int_equal(r.messages.item[0].line, line);
}

POOL_TEST(a_deck_without_states_is_one)
{
    struct states s = good(BAR UNKNOWN "*MODES\n1, 225\n", NULL);
    assert_int_equal(s.nstate, 1);
    assert_null(s.state[0].name);
    assert_int_equal(s.nparameter, 1);
    assert_string_equal(s.bounds[0].name, "bar.E");
}

POOL_TEST(a_state_is_the_common_cards_and_its_own)
{
    struct states s = good(BAR UNKNOWN FREE LOADED, NULL);
    assert_int_equal(s.nstate, 2);
    const struct job *bare = &s.state[0].job, *loaded = &s.state[1].job;
    assert_string_equal(s.state[0].name, "free");
    assert_string_equal(s.state[1].name, "loaded");
    assert_int_equal(bare->rotor.ndisk, 1); /* disks add up */
    assert_int_equal(loaded->rotor.ndisk, 2);
    assert_int_equal(bare->rotor.nsensor, 2); /* sensors and noise take the place of the common ones */
    assert_int_equal(loaded->rotor.nsensor, 1);
    assert_int_equal(loaded->rotor.sensor[0].id, 7);
    assert_close(bare->measurement.frequency_std[0], 0.001, 1e-15, 0);
    assert_close(loaded->measurement.frequency_std[0], 0.002, 1e-15, 0);
    assert_int_equal(bare->measurement.nmode, 2);
    assert_int_equal(loaded->measurement.nmode, 1);

    assert_int_equal(s.nparameter, 2); /* the common unknown, and one of the second state alone */
    assert_string_equal(s.bounds[0].name, "bar.E");
    assert_string_equal(s.bounds[1].name, "loaded:d.mass");
    assert_int_equal(bare->unknowns.nparameter, 1);
    assert_int_equal(s.state[0].unknown[0], 0);
    assert_int_equal(s.state[1].unknown[0], 0);
    assert_int_equal(s.state[1].unknown[1], 1);
}

/* A state may be called as a part of the rotor. */
POOL_TEST(states_have_names_of_their_own)
{
    struct states s = good(BAR UNKNOWN "*STATE, NAME=bar\n*MODES\n1, 225\n*STATE, NAME=d\n*MODES\n1, 225\n", NULL);
    assert_string_equal(s.state[1].name, "d");
}

POOL_TEST(one_state_can_be_chosen)
{
    struct states s = good(BAR UNKNOWN FREE LOADED, "FIT.STATE=Loaded");
    assert_int_equal(s.nstate, 1);
    assert_string_equal(s.state[0].name, "loaded");
    assert_string_equal(s.bounds[1].name, "d.mass");
    assert_int_equal(s.state[0].job.rotor.ndisk, 2);
    struct job job;
    struct message_list messages;
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_write("both.inp", BAR UNKNOWN FREE LOADED), 0, NULL, &messages, &job),
                  ROTID_ERROR_SYNTAX);
    assert_string_equal(
        messages.item[0].text,
        "the deck has 2 states and this works on one, expected one of free, loaded as FIT.STATE: --set FIT.STATE=free");
}

/* Positions follow a length; what a state sets is known there; what it identifies anew is its own. */
POOL_TEST(set_and_identify_hold_for_their_state)
{
    struct states s = good(BAR UNKNOWN "bar.G, 1e10, 1e12, 1e11\n" FREE "*SET\nbar.length, 0.8\nbar.length, 0.5\nbar.G, 7e10\n"
                                       "*STATE, NAME=after\n*IDENTIFY\nbar.E, 1e10, 1e12, 3e11\n*MODES\n1, 225\n2, 610\n",
                           NULL);
    const struct job *shorter = &s.state[0].job, *after = &s.state[1].job;
    assert_close(rotor_length(&shorter->rotor), 0.5, 1e-14, 0);
    assert_close(shorter->rotor.segment[0].length, 0.125, 1e-14, 0);
    assert_close(shorter->rotor.sensor[1].position, 0.5, 1e-14, 0);
    assert_close(shorter->rotor.disk[0].position, 0.5, 1e-14, 0);
    assert_close(shorter->rotor.group[0].material.g, 7e10, 1e-14, 0);
    assert_close(rotor_length(&after->rotor), 1, 1e-14, 0);
    assert_int_equal(s.nparameter, 3);
    assert_string_equal(s.bounds[0].name, "bar.E");
    assert_string_equal(s.bounds[1].name, "bar.G");
    assert_string_equal(s.bounds[2].name, "after:bar.E");
    assert_close(s.bounds[2].start, 3e11, 1e-14, 0);
    assert_int_equal(shorter->unknowns.nparameter, 1);
    assert_int_equal(s.state[0].unknown[0], 0);
    assert_int_equal(after->unknowns.nparameter, 2); /* bar.G is common, bar.E its own */
    assert_int_equal(s.state[1].unknown[0], 1);
    assert_int_equal(s.state[1].unknown[1], 2);
}

POOL_TEST(states_and_modes_are_held_out)
{
    struct states s = good(BAR UNKNOWN "*FIT, HOLDOUT=STATE:more\n" FREE "*STATE, NAME=more, HOLDOUT=2\n*MODES\n1, 225\n2, 610\n"
                                       "*STATE, NAME=last, MODES=2\n*MODES\n1, 225\n2, 610\n",
                           NULL);
    static const int held[3][2] = {{0, 0}, {1, 1}, {1, 0}};
    for (int i = 0; i < 3; i++)
        assert_memory_equal(s.state[i].job.measurement.holdout, held[i], sizeof held[i]);
}

/* In a deck each item of the list begins with STATE:, on a command line the first does. */
POOL_TEST(several_states_are_held_out)
{
    const char *three = "*STATE, NAME=b\n*MODES\n1, 225\n*STATE, NAME=c c\n*MODES\n1, 225\n";
    struct states s =
        good(pool_format(&test_pool, "%s*FIT, HOLDOUT=STATE:free,\n  state: C c\n%s%s", BAR UNKNOWN, FREE, three), NULL);
    for (int i = 0; i < 3; i++)
        assert_int_equal(s.state[i].job.measurement.holdout[0], i != 1);
    s = good(pool_format(&test_pool, "%s%s%s", BAR UNKNOWN, FREE, three), "FIT.HOLDOUT=STATE:b,STATE:c c");
    for (int i = 0; i < 3; i++)
        assert_int_equal(s.state[i].job.measurement.holdout[0], i != 0);
    assert_refused(pool_format(&test_pool, "%s*FIT, HOLDOUT=STATE:b, STATE:d\n%s%s", BAR UNKNOWN, FREE, three), 17,
                   "state d is not defined, expected one of free, b, c c");
}

/* Without *FIT all are weighed by their noise, or none. */
POOL_TEST(the_functional_is_that_of_all)
{
    struct states s = good(BAR UNKNOWN FREE LOADED, NULL);
    assert_int_equal(s.state[0].job.options.fit.functional, ROTID_LIKELIHOOD);
    s = good("*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.3\n*DENSITY\n7850\n"
             "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.05, 0, 10\n" UNKNOWN FREE
             "*STATE, NAME=noisy\n*NOISE, FREQUENCY=0.01\n*MODES\n1, 225\n",
             NULL);
    for (int i = 0; i < 2; i++)
        assert_int_equal(s.state[i].job.options.fit.functional, ROTID_HYBRID);
}

POOL_TEST(what_is_wrong_has_its_place)
{
    assert_refused(BAR UNKNOWN "*MODES\n1, 225\n" FREE, 17,
                   "*MODES stands before the first *STATE, expected it behind that of the state it is of");
    assert_refused(BAR UNKNOWN FREE "*FIT, MODEL=SOLID\n", 21,
                   "*FIT stands behind *STATE, expected it before the first one: it is common to all");
    assert_refused(BAR UNKNOWN FREE FREE, 21, "state free is given twice, expected a new name");
    assert_refused(BAR UNKNOWN "*STATE\n*MODES\n1, 225\n", 17, "*STATE has no NAME, expected NAME=name");
    assert_refused(BAR UNKNOWN "*FIT, STATE=fee\n" FREE, 17, "state fee is not defined, expected one of free");
    assert_refused(BAR UNKNOWN "*FIT, HOLDOUT=STATE:fee\n" FREE LOADED, 17,
                   "state fee is not defined, expected one of free, loaded");
    assert_refused(BAR UNKNOWN "*FIT, STATE=free\n*MODES\n1, 225\n", 17, "state free: the deck has no *STATE, expected none");
    assert_refused(BAR UNKNOWN FREE "*SET\nbar.x, 1\n" LOADED, 22,
                   "bar.x: there is a thing of that name and it has no such parameter, expected one of bar.E, bar.G, bar.nu, "
                   "bar.rho (state free)");
    assert_refused(BAR UNKNOWN FREE "*SET\nbore.length, 1\n" LOADED, 22,
                   "bore.length is no length, expected that of a *SHAFT or *BEAM (state free)");
    assert_refused(BAR UNKNOWN FREE "*SET\nbar.E, -1\n" LOADED, 22,
                   "bar.E is -1, expected a value above 0 and at most inf (state free)");
    assert_refused(BAR UNKNOWN "*DISK\n7, 1\n" FREE LOADED, 18, /* of a common card, once */
                   "position 7 m lies outside the rotor, expected 0 to 1 m");
    assert_refused(BAR UNKNOWN "*FIT, HOLDOUT=STATE:loaded\n" FREE LOADED, 22,
                   "loaded:d.mass acts in no state that is fitted, expected it in one that is not held out");
}

/* Each is read with all that is common: a file of nothing but states must not take for ever. */
/* `rotid test` of a deck of two states gave both the modes of the test: counted twice, intervals a root of two too short. */
POOL_TEST(one_file_is_not_set_for_two_states)
{
    const char *file = folder_write("b.csv", "mode,frequency\n1,226\n"), *set = pool_format(&test_pool, "MODES.FILE=%s", file);
    (void)folder_write("a.csv", "mode,frequency\n1,225\n");
    struct reading r =
        read_text(BAR UNKNOWN "*STATE, NAME=free\n*MODES, FILE=a.csv\n*STATE, NAME=again\n*MODES, FILE=a.csv\n", set);
    assert_status(r.status, ROTID_ERROR_SYNTAX);
    assert_string_equal(r.messages.item[0].text,
                        "the states free and again would both have what is measured in one file, expected FIT.STATE as well");
    struct states s = good(BAR UNKNOWN "*STATE, NAME=free\n*MODES, FILE=a.csv\n", set);
    assert_close(s.state[0].job.measurement.frequency_hz[0], 226, 1e-12, 0);
}

/* The diagnosis looks at neighbours: modes that may be one, or whose shapes are exchanged. */
POOL_TEST(modes_are_kept_by_rising_number)
{
    const struct states s = good(BAR UNKNOWN "*MODES\n3, 1190, 0.03\n1, 225, 0.01, 0.9\n2, 610\n", NULL);
    const struct job_measurement *m = &s.state[0].job.measurement;
    static const double hz[] = {225, 610, 1190};
    for (int k = 0; k < 3; k++)
        assert_true(m->number[k] == k + 1 && m->frequency_hz[k] == hz[k]);
    assert_true(m->damping[0] == 0.01 && isnan(m->damping[1]) && m->damping[2] == 0.03);
    assert_close(m->frequency_std[0], 0.9 / 225, 1e-12, 0);
}

POOL_TEST(states_have_a_limit)
{
    char *text = pool_copy_text(&test_pool, BAR UNKNOWN);
    for (int s = 0; s < 101; s++)
        text = pool_format(&test_pool, "%s*STATE, NAME=s%d\n*MODES\n1, 225\n", text, s);
    assert_refused(text, 317, "the deck has more than 100 states, expected fewer");
}

TEST_GROUP(folder_make, folder_remove);
