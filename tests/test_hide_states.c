/* Effects that tools/hide hides in one rotor in several states: the data of each state are those of its own deck, parameters and
 * effects are common, and what the identification makes of them. */
#include <cjson/cJSON.h>

#include "folder.h"
#include "hide/hide.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define COMMON                                                                                                                   \
    "*HEADING\nbar\n*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n"                          \
    "*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.08, 0, 40\n*SHAFT, NAME=end, MATERIAL=steel\n0.4, 0.06, 0, 14\n"                  \
    "*SENSORS\n1, 0\n2, 0.3\n3, 0.55\n4, 0.8\n5, 1.1\n6, end\n*IDENTIFY\ncore.E, 1e10, 5e11, 2e11\n"
#define DISC     "*DISK\n0.5, 4\n"
#define BEARINGS "*SPRING, NAME=front\n0.1, 3e6\n*SPRING, NAME=rear\n1.5, 2e6\n*SENSORS\n1, 0.2\n2, 0.7\n3, 1.3\n"
#define LONGER   "*SET\nend.length, 0.7\n"
#define STIFFER  "*SET\nfront.k, 3e7\n"
#define STATES                                                                                                                   \
    COMMON "*STATE, NAME=free\n*STATE, NAME=disc\n" DISC "*STATE, NAME=bearings\n" BEARINGS "*STATE, NAME=longer\n" LONGER

static struct hide_request request_of(const char *deck)
{
    struct hide_request r = hide_request_default();
    r.deck = deck;
    r.modes = 4;
    r.seed = 5;
    return r;
}

static void make(const struct hide_request *request, char **deck, char **truth)
{
    char message[600] = "";
    if (hide_case(request, deck, truth, message, sizeof message))
        fail_msg("%s", message);
}

static void assert_data(const struct job *a, const struct job *b)
{
    assert_int_equal(a->measurement.nmode, b->measurement.nmode);
    assert_int_equal(a->rotor.nsensor, b->rotor.nsensor);
    for (int k = 0; k < a->measurement.nmode; k++)
        assert_close(a->measurement.frequency_hz[k], b->measurement.frequency_hz[k], 1e-9, 0);
    for (int i = 0; i < a->measurement.nmode * a->rotor.nsensor; i++)
        assert_close(a->measurement.shape[i], b->measurement.shape[i], 1e-6, 1e-9);
}

/* Without noise: what the rotor of that state alone gives, written out as a deck without *STATE. */
POOL_TEST(data_are_those_of_each_state)
{
    static const char *const alone[] = {
        COMMON, COMMON DISC,
        "*HEADING\nbar\n*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n"
        "*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.08, 0, 40\n*SHAFT, NAME=end, MATERIAL=steel\n0.4, 0.06, 0, 14\n"
        "*IDENTIFY\ncore.E, 1e10, 5e11, 2e11\n" BEARINGS,
        "*HEADING\nbar\n*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n"
        "*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.08, 0, 40\n*SHAFT, NAME=end, MATERIAL=steel\n0.7, 0.06, 0, 14\n"
        "*SENSORS\n1, 0\n2, 0.3\n3, 0.55\n4, 0.8\n5, 1.1\n6, end\n*IDENTIFY\ncore.E, 1e10, 5e11, 2e11\n",
        "*HEADING\nbar\n*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n"
        "*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.08, 0, 40\n*SHAFT, NAME=end, MATERIAL=steel\n0.4, 0.06, 0, 14\n"
        "*IDENTIFY\ncore.E, 1e10, 5e11, 2e11\n*SPRING, NAME=front\n0.1, 3e7\n*SPRING, NAME=rear\n1.5, 2e6\n"
        "*SENSORS\n1, 0.2\n2, 0.7\n3, 1.3\n"};
    static const char *const effect = "stiffness_local:depth=0.4,z=0.6,width=0.05";
    struct hide_request r = request_of(STATES "*STATE, NAME=stiffer\n" BEARINGS STIFFER);
    char *deck, *truth;
    r.frequency_noise = r.shape_noise = 0;
    r.effects = 1;
    r.effect = &effect;
    make(&r, &deck, &truth);
    struct states states = read_states(deck);
    assert_int_equal(states.nstate, 5);
    cJSON *json = cJSON_Parse(truth), *list = cJSON_GetObjectItem(json, "states");
    assert_int_equal(cJSON_GetArraySize(list), 5);
    for (int s = 0; s < 5; s++) {
        char *own_deck, *own_truth;
        r.deck = alone[s];
        make(&r, &own_deck, &own_truth);
        struct states own = read_states(own_deck);
        assert_data(&states.state[s].job, &own.state[0].job);
        const cJSON *one = cJSON_GetArrayItem(list, s);
        assert_string_equal(cJSON_GetObjectItem(one, "name")->valuestring, states.state[s].name);
        cJSON *alike = cJSON_Parse(own_truth);
        assert_true(cJSON_Compare(cJSON_GetObjectItem(cJSON_GetObjectItem(one, "truth"), "parameters"),
                                  cJSON_GetObjectItem(alike, "parameters"), 1));
        cJSON_Delete(alike);
        free(own_deck);
        free(own_truth);
    }
    cJSON_Delete(json);
    free(deck);
    free(truth);
}

static double truth_of(const char *truth)
{
    cJSON *json = cJSON_Parse(truth),
          *of = cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "states"), 0), "truth");
    double value = cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(of, "parameters"), 0), "value")->valuedouble;
    cJSON_Delete(json);
    return value;
}

/* Noise of its own in each state, and a truth that all of them together find. */
POOL_TEST(states_together_find_the_truth)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct hide_request r = request_of(STATES);
        struct identification found[4];
        struct message_list notes;
        rotid_fit_result *fit;
        char *deck, *truth;
        r.seed = seed;
        make(&r, &deck, &truth);
        struct states states = read_states(deck);
        message_open(&notes, &test_pool);
        assert_status(identify_states(&test_pool, &states, 0, NULL, &notes, found, &fit), ROTID_OK);
        assert_true(fit->converged);
        assert_true(fabs(fit->x[0] - truth_of(truth)) < 4 * fit->std[0]);
        assert_true(fit->chi2_per_dof > 0.5 && fit->chi2_per_dof < 1.6);
        assert_true(fabs(found[0].fit->residual[0] - found[1].fit->residual[0]) > 1e-6);
        rotid_fit_free(fit);
        free(deck);
        free(truth);
    }
}

/* What is hidden in one state leaves the others as they were, and what is drawn is in all. */
POOL_TEST(effects_are_in_all_states_or_in_one)
{
    static const char *const in = "disc=added_mass:mass=0.5,z=0.9";
    struct hide_request r = request_of(STATES);
    char *deck[3], *truth[3];
    make(&r, &deck[0], &truth[0]);
    r.effects_in = 1;
    r.effect_in = &in;
    make(&r, &deck[1], &truth[1]);
    r.random = "added_mass";
    make(&r, &deck[2], &truth[2]);
    struct states plain = read_states(deck[0]), one = read_states(deck[1]), drawn = read_states(deck[2]);
    for (int s = 0; s < 4; s++) {
        double a = plain.state[s].job.measurement.frequency_hz[2], b = one.state[s].job.measurement.frequency_hz[2],
               c = drawn.state[s].job.measurement.frequency_hz[2];
        assert_true((s == 1) == (fabs(a / b - 1) > 1e-3));
        assert_true(fabs(c / b - 1) > 1e-6);
    }
    cJSON *json = cJSON_Parse(truth[2]), *list = cJSON_GetObjectItem(json, "states");
    const cJSON *of[2];
    for (int s = 0; s < 2; s++)
        of[s] = cJSON_GetObjectItem(cJSON_GetObjectItem(cJSON_GetArrayItem(list, 2 * s), "truth"), "effects");
    assert_int_equal(cJSON_GetArraySize(of[0]), 1);
    assert_true(cJSON_Compare(of[0], of[1], 1)); /* one draw, of the first state */
    cJSON_Delete(json);
    for (int i = 0; i < 3; i++) {
        free(deck[i]);
        free(truth[i]);
    }
}

static void assert_refused(const char *deck, const char *in, const char *says)
{
    struct hide_request r = request_of(deck);
    char *out, *truth, message[600] = "";
    r.effects_in = in != NULL;
    r.effect_in = &in;
    assert_int_equal(hide_case(&r, &out, &truth, message, sizeof message), HIDE_INPUT);
    assert_null(out);
    assert_string_equal(message, says);
}

/* Lines are those of the deck. */
POOL_TEST(what_is_wrong_has_its_line)
{
    assert_refused(COMMON "*STATE\n", NULL, "deck:21: *STATE: expected NAME=name, without quotes");
    assert_refused(COMMON "*STATE, NAME=a\n*STATE, NAME=b\n*SET\ncore.E, 2e11\n", NULL,
                   "deck:24: *SET: expected GROUP.length, SPRING.k or SPRING.k_rot and a value above zero: this program cannot "
                   "follow another one");
    assert_refused(STATES, "disk=added_mass:mass=1,z=0.5",
                   "--effect-in disk=added_mass:mass=1,z=0.5: expected NAME=SPEC with a state of the deck");
    assert_refused(COMMON, "disc=added_mass:mass=1,z=0.5", "--effect-in: deck has no *STATE, expected --effect");
}

TEST_GROUP(folder_make, folder_remove);
