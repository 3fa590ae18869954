/* Diagnoses over several states of a deck, of effects that tools/hide has put into the data, and what changed between two. */
#include "reading.h"
#include "support.h"

#include "api/api.h"
#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "hidden_states.h"
#include "run/run.h"

#define ROTOR                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8.1e10, 0.3\n*DENSITY\n7850\n"                                         \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.06, 0, 12\n*SHAFT, NAME=core, MATERIAL=steel\n0.50, 0.10, 0, 16\n"               \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.06, 0, 10\n*SPRING, NAME=front\nstart, 2e4\n*SPRING, NAME=rear\nend, 2e4\n"     \
    "*IDENTIFY\ncore.E, 1e10, 1e12, 1.9e11\ncore.G, 1e9, 4e11, 7e10\n"
#define DISC "*DISK, NAME=d\n0.45, 5\n"
#define ZONE "stiffness_local:depth=0.3,z=0.5,width=0.03"

static const char *const truths[] = {"core.E=2.1e11", "core.G=8e10"}, *const zone[] = {ZONE};

static struct hide_request request(int modes, int sensors, unsigned seed)
{
    struct hide_request r = hide_request_default();
    r.deck = ROTOR;
    r.name = "rotor";
    r.seed = seed;
    r.modes = modes;
    r.sensors = sensors;
    r.no_shapes = !sensors;
    r.truths = 2;
    r.truth = truths;
    r.shape_noise = 0.01;
    return r;
}

static rotid_diagnosis *diagnose(const struct hide_request *r, const struct hidden_state *state, const char *set,
                                 const char *before, const char *after)
{
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2, .before = before, .after = after};
    char message[300], failure[ROTID_FAILURE_LENGTH], *text = hidden_states_deck(r, 2, state, NULL, message, sizeof message);
    rotid_diagnosis *d;
    if (!text)
        print_message("%s\n", message);
    assert_non_null(text);
    rotid_deck *deck = read_handle(text, set != NULL, &set);
    int status = rotid_diagnose(deck, &options, NULL, failure, &d);
    if (status)
        print_message("%s\n", failure);
    assert_status(status, ROTID_OK);
    print_message("%s\n", d->verdict.sentence);
    rotid_deck_free(deck);
    free(text);
    return d;
}

/* States of 1.05 m and of 0.5 m share a zone: it has to be a zone of both, so the shorter one limits width and place. */
POOL_TEST(what_states_share_is_possible_in_each)
{
    static const char text[] = ROTOR "*NOISE, FREQUENCY=0.001\n*STATE, NAME=short\n*SET\nleft.length, 0.12\ncore.length, 0.3\n"
                                     "right.length, 0.08\n*MODES\n1, 900\n2, 2000\n*STATE, NAME=long\n*MODES\n1, 300\n2, 800\n";
    rotid_deck *deck = read_handle(text, 0, NULL);
    const struct states *states = deck_states_of(deck);
    const struct cause_kind *zone_kind = catalogue_find("stiffness_local");
    struct effect effect = {.kind = zone_kind->effect, .name = "zone", .value = {0.3, 0.2, 0.02}};
    struct states with;
    assert_status(states_with_effect(&test_pool, states, NULL, &effect, zone_kind, NULL, NULL, &with), ROTID_OK);
    assert_int_equal(with.nparameter, states->nparameter + 3);
    for (int s = 0; s < 2; s++) {
        const struct job *job = &with.state[s].job;
        const rotid_parameter *own = &job->unknowns.bounds[job->unknowns.nparameter - 3];
        assert_close(own[1].upper, 0.5, 1e-12, 0);
        assert_close(own[2].lower, 1.05 / 200, 1e-12, 0);
        assert_close(own[2].upper, 0.5 / 14, 1e-12, 0);
    }
    assert_close(with.bounds[with.nparameter - 1].upper, 0.5 / 14, 1e-12, 0);
    rotid_deck_free(deck);
}

/* Where a single state is copied, too. */
POOL_TEST(changes_of_one_state_may_lack_memory)
{
    rotid_deck *deck = read_handle(ROTOR "*NOISE, FREQUENCY=0.001\n*MODES\n1, 300\n2, 800\n", 0, NULL);
    const struct cause_kind *zone_kind = catalogue_find("stiffness_local");
    struct state only;
    const struct states states = states_of(deck_job_of(deck), &only);
    struct effect effect = {.kind = zone_kind->effect, .name = "zone", .value = {0.3, 0.2, 0.02}};
    const double x[] = {2e11, 8e10};
    for (int change = 0; change < 3; change++) {
        int status = ROTID_ERROR_MEMORY;
        for (long n = 1; status == ROTID_ERROR_MEMORY; n++) {
            struct failing_allocator failing;
            struct pool pool;
            struct states to;
            failing_allocator_open(&failing, n);
            pool_open(&pool, &failing.allocator);
            status = change == 0   ? states_started_at(&pool, &states, x, &to)
                     : change == 1 ? states_with_effect(&pool, &states, x, &effect, zone_kind, NULL, NULL, &to)
                                   : states_hold(&pool, &states, x, 0, 2e11, &to);
            pool_close(&pool);
            assert_int_equal(failing.in_use, 0);
        }
        assert_status(status, ROTID_OK);
    }
    rotid_deck_free(deck);
}

static rotid_diagnosis *diagnose_text(const char *text)
{
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2};
    rotid_deck *deck = read_handle(text, 0, NULL);
    rotid_diagnosis *d;
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &d), ROTID_OK);
    rotid_deck_free(deck);
    return d;
}

/* Two effects of which one or both are in one state: what one cause in one state leaves is more than noise. */
UNIT_TEST(two_causes_are_named_with_their_states)
{
    static const char *const left[] = {"stiffness:group=left,factor=0.9"}, *const mass[] = {"added_mass:mass=0.8,z=0.9"},
                             *const both[] = {"density:group=right,factor=1.1", "stiffness:group=left,factor=0.9"};
    static const struct {
        struct hidden_state states[2];
        const char *id[2], *in[2];
    } pair[] = {{{{"bare", "", 1, left}, {"disc", DISC, 1, mass}}, {"stiffness", "added_mass"}, {"bare", "disc"}},
                {{{"bare", "", 1, both}, {"disc", DISC, 2, both}}, {"density", "stiffness"}, {NULL, "disc"}}};
    const struct hide_request r = request(5, 12, 3);
    for (int p = 0; p < 2; p++) {
        rotid_diagnosis *d = diagnose(&r, pair[p].states, NULL, NULL, NULL);
        assert_int_equal(d->verdict.kind, ROTID_NAMED);
        assert_int_equal(d->verdict.ncauses, 2);
        for (int i = 0; i < 2; i++) {
            const rotid_cause *c = &d->verdict.causes[strcmp(d->verdict.causes[0].id, pair[p].id[i]) ? 1 : 0];
            assert_string_equal(c->id, pair[p].id[i]);
            assert_int_equal(c->state != NULL, pair[p].in[i] != NULL);
            if (c->state)
                assert_string_equal(c->state, pair[p].in[i]);
        }
        rotid_diagnosis_free(d);
    }
}

/* A mass at the start of two states of different lengths is one cause for each of them: each has its row, and both are named. */
UNIT_TEST(a_place_in_states_of_other_lengths_is_another_cause)
{
    static const char *const mass[] = {"added_mass:mass=1.5,z=0.02"};
    static const struct hidden_state states[] = {
        {"long", "", 1, mass}, {"short", "*SET\nleft.length, 0.2\ncore.length, 0.4\nright.length, 0.2\n", 1, mass}};
    const struct hide_request r = request(5, 10, 5);
    rotid_diagnosis *d = diagnose(&r, states, NULL, NULL, NULL);
    int rows[2] = {0, 0};
    for (int i = 0; i < d->ncandidates; i++)
        for (int s = 0; s < 2; s++)
            rows[s] += !strcmp(d->candidates[i].cause.id, "added_mass") && !strcmp(d->candidates[i].cause.state, states[s].name);
    assert_int_equal(rows[0], 1);
    assert_int_equal(rows[1], 1);
    assert_int_equal(d->verdict.kind, ROTID_NAMED);
    assert_int_equal(d->verdict.ncauses, 2);
    assert_string_not_equal(d->verdict.causes[0].state, d->verdict.causes[1].state);
    rotid_diagnosis_free(d);
}

/* A deck with one *STATE is that deck without it. */
UNIT_TEST(one_state_is_a_deck_without_states)
{
    const struct hide_request r = request(5, 10, 7);
    const struct hidden_state only[] = {{"only", "", 1, zone}};
    char message[300], *text = hidden_states_deck(&r, 1, only, NULL, message, sizeof message), *card = strstr(text, "*STATE");
    rotid_diagnosis *with = diagnose_text(text);
    memcpy(card, "** no such card     \n", strcspn(card, "\n"));
    rotid_diagnosis *without = diagnose_text(text);
    assert_int_equal(with->verdict.ncauses, 1);
    assert_string_equal(with->verdict.sentence, without->verdict.sentence);
    for (int p = 0; p < 3; p++)
        assert_true(with->verdict.causes[0].parameters[p].value == without->verdict.causes[0].parameters[p].value);
    rotid_diagnosis_free(with);
    rotid_diagnosis_free(without);
    free(text);
}

static double value_of(const rotid_cause *cause, const char *name, double *lower, double *upper)
{
    for (int p = 0; p < cause->nparameters; p++)
        if (!strcmp(cause->parameters[p].name, name)) {
            *lower = cause->parameters[p].ci95[0];
            *upper = cause->parameters[p].ci95[1];
            return cause->parameters[p].value;
        }
    fail_msg("%s has no %s", cause->id, name);
    return NAN;
}

/* One cause alone, in this state (NULL: in all), whose parameter is no farther from the truth than its interval is wide. */
static void assert_named(const rotid_diagnosis *d, const char *id, const char *state, const char *name, double truth)
{
    double lower = NAN, upper = NAN;
    assert_int_equal(d->verdict.kind, ROTID_NAMED);
    assert_int_equal(d->verdict.ncauses, 1);
    assert_true(d->verdict.adequate_after);
    const rotid_cause *cause = &d->verdict.causes[0];
    assert_string_equal(cause->id, id);
    if (state) {
        assert_non_null(cause->state);
        assert_string_equal(cause->state, state);
        assert_non_null(strstr(d->verdict.sentence, state));
    } else {
        assert_null(cause->state);
    }
    double value = value_of(cause, name, &lower, &upper);
    assert_true(fabs(value - truth) < upper - lower);
}

/* A state of another length that is held out has no part in whether a mass is in one of two states or in both. */
UNIT_TEST(a_cause_is_in_one_of_two_states_beside_one_held_out_of_another_length)
{
#define SHORT "*SET\nleft.length, 0.2\ncore.length, 0.4\nright.length, 0.2\n"
    static const char *const mass[] = {"added_mass:mass=1.5,z=0.02"}, *const holdout = "FIT.HOLDOUT=STATE:long";
    static const struct hidden_state states[] = {{"long", "", 0, NULL}, {"short", SHORT, 1, mass}, {"again", SHORT, 0, NULL}};
    const struct hide_request r = request(5, 10, 5);
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2};
    char message[300], *text = hidden_states_deck(&r, 3, states, NULL, message, sizeof message);
    assert_non_null(text);
    rotid_deck *deck = read_handle(text, 1, &holdout);
    rotid_diagnosis *d;
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &d), ROTID_OK);
    print_message("%s\n", d->verdict.sentence);
    assert_named(d, "added_mass", "short", "mass", 1.5);
    rotid_diagnosis_free(d);
    rotid_deck_free(deck);
    free(text);
}

/* The extended deck, with all states in it, is fitted as the diagnosis fitted it. */
static void assert_extended(const rotid_diagnosis *d)
{
    const rotid_identification *meant = d->extended ? d->extended : d->base;
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck;
    rotid_identification *again;
    for (int i = 0; i < d->nmessage && !d->extended_deck; i++)
        print_error("%s\n", d->message[i].text);
    assert_non_null(d->extended_deck);
    assert_status(rotid_deck_read_text(strlen(d->extended_deck), d->extended_deck, NULL, NULL, 0, NULL, NULL, failure, &deck),
                  ROTID_OK);
    assert_int_equal(deck->nstate, meant->nstates);
    assert_status(rotid_identify(deck, 0, NULL, failure, &again), ROTID_OK);
    assert_int_equal(again->nparameters, meant->nparameters);
    assert_close(again->chi2, meant->chi2, 1e-6, 0);
    assert_close(again->parameters[0].value, meant->parameters[0].value, 1e-5, 0);
    rotid_identification_free(again);
    rotid_deck_free(deck);
}

/* Two of the states need elements four times as many, the third one eight times: one deck states one mesh, and the diagnosis has
 * the same. */
UNIT_TEST(states_share_the_mesh_that_one_of_them_needs)
{
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2};
    char failure[ROTID_FAILURE_LENGTH] = "";
    rotid_deck *deck;
    rotid_diagnosis *d;
    assert_status(rotid_deck_read(ROTID_SOURCE_DIR "/tests/data/search/three_states.inp", 0, NULL, NULL, failure, &deck),
                  ROTID_OK);
    assert_status(rotid_diagnose(deck, &options, NULL, failure, &d), ROTID_OK);
    assert_non_null(strstr(d->extended_deck, "\nthe mesh is refined: 336 elements in place of 42"));
    assert_extended(d);
    rotid_diagnosis_free(d);
    rotid_deck_free(deck);
}

UNIT_TEST(a_cause_of_both_is_surer_than_of_one_alone)
{
    static const struct hidden_state states[] = {{"bare", "", 1, zone}, {"disc", DISC, 1, zone}};
    static const char *const sets[] = {"FIT.STATE=bare", "FIT.STATE=disc"};
    const struct hide_request r = request(6, 0, 700);
    double most = 0;
    for (int s = 0; s < 2; s++) {
        rotid_diagnosis *alone = diagnose(&r, states, sets[s], NULL, NULL);
        assert_int_equal(alone->base->nstates, 0);
        most = fmax(most, alone->verdict.marginals[0].probability);
        rotid_diagnosis_free(alone);
    }
    rotid_diagnosis *both = diagnose(&r, states, NULL, NULL, NULL);
    assert_named(both, "stiffness_local", NULL, "z", 0.5);
    assert_true(both->verdict.marginals[0].probability > most - 0.01);
    assert_extended(both);
    assert_int_equal(both->base->nstates, 2);
    assert_int_equal(both->extended->nstates, 2);
    assert_int_equal(both->nmodes_standardised, 12);
    assert_null(both->before);
    rotid_diagnosis_free(both);
}

UNIT_TEST(a_cause_in_one_state_is_named_with_it)
{
    static const char *const mass[] = {"added_mass:mass=1.5,z=0.7"}, *const soft[] = {
                                                                         "stiffness_local:depth=0.4,z=0.5,width=0.03"};
    static const struct hidden_state second[] = {{"bare", "", 0, NULL}, {"disc", DISC, 1, mass}},
                                     first[] = {{"bare", "", 1, soft}, {"disc", DISC, 0, NULL}};
    const struct hide_request r = request(4, 7, 100);
    rotid_diagnosis *d = diagnose(&r, second, NULL, NULL, NULL);
    assert_named(d, "added_mass", "disc", "mass", 1.5);
    assert_extended(d);
    rotid_diagnosis_free(d);
    d = diagnose(&r, first, NULL, NULL, NULL);
    assert_named(d, "stiffness_local", "bare", "z", 0.5);
    rotid_diagnosis_free(d);
}

UNIT_TEST(nothing_hidden_is_adequate)
{
    static const struct hidden_state states[] = {{"bare", "", 0, NULL}, {"disc", DISC, 0, NULL}};
    const struct hide_request r = request(4, 7, 300);
    rotid_diagnosis *d = diagnose(&r, states, NULL, NULL, NULL);
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_int_equal(d->ndata_findings, 0);
    assert_int_equal(d->nsensors, 14);
    assert_string_equal(d->sensors[13].state, "disc");
    rotid_diagnosis_free(d);
}

/* A wrong gain in one state is found there, and the cause of both states beside it. */
UNIT_TEST(a_fault_of_a_channel_goes_with_its_state)
{
    static const char *const fault[] = {"density:group=right,factor=1.15", "sensor_gain:sensor=6,gain=1.4"};
    static const struct hidden_state states[] = {{"bare", "", 1, fault}, {"disc", DISC, 2, fault}};
    const struct hide_request r = request(4, 11, 500);
    rotid_diagnosis *d = diagnose(&r, states, NULL, NULL, NULL);
    assert_int_equal(d->ndata_findings, 1);
    assert_string_equal(d->data_findings[0].id, "sensor_gain");
    assert_string_equal(d->data_findings[0].state, "disc");
    assert_int_equal(d->data_findings[0].sensors[0], 6);
    assert_named(d, "density", NULL, "factor", 1.15);
    rotid_diagnosis_free(d);
}

/* A state that is held out is predicted, and no cause is looked for in it. */
UNIT_TEST(a_state_held_out_is_evidence)
{
    static const char *const dense[] = {"density:group=right,factor=1.15"};
    static const struct hidden_state states[] = {{"disc", DISC, 1, dense}, {"bare", "", 1, dense}};
    const struct hide_request r = request(4, 7, 600);
    rotid_diagnosis *d = diagnose(&r, states, "FIT.HOLDOUT=STATE:disc", NULL, NULL);
    assert_named(d, "density", NULL, "factor", 1.15);
    assert_true(d->gain.holdout_frequency_rms_percent.after < 0.2);
    assert_true(d->gain.holdout_frequency_rms_percent.before > 2 * d->gain.holdout_frequency_rms_percent.after);
    for (int i = 0; i < d->ncandidates; i++)
        assert_true(!d->candidates[i].refitted || !d->candidates[i].cause.state || strcmp(d->candidates[i].cause.state, "disc"));
    rotid_diagnosis_free(d);
}

/* An error that stays is not what changed. */
UNIT_TEST(what_changed_is_named_and_what_stays_is_not)
{
    static const char *const soft = "stiffness_local:depth=0.4,z=0.4,width=0.03", *const dense = "density:group=left,factor=1.1";
    static const struct {
        const char *effect[2]; /* that stays, that comes */
        const char *id, *name;
        double truth;
    } pairs[] = {
        {{soft, NULL}, NULL, NULL, 0},
        {{soft, "added_mass:mass=1.5,z=0.7"}, "added_mass", "mass", 1.5},
        {{soft, "stiffness_local:depth=0.3,z=0.62,width=0.03"}, "stiffness_local", "z", 0.62},
        {{dense, "stiffness:group=right,factor=0.8"}, "stiffness", "factor", 0.8},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const struct hidden_state states[] = {{"before", "", 1, pairs[i].effect},
                                              {"after", "", pairs[i].id ? 2 : 1, pairs[i].effect}};
        const struct hide_request r = request(6, 13, 1200 + 10 * (unsigned)i);
        rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "AFTER");
        assert_string_equal(d->before, "before");
        if (pairs[i].id)
            assert_named(d, pairs[i].id, NULL, pairs[i].name, pairs[i].truth);
        else
            assert_true(d->verdict.nothing > 0.5 && !d->verdict.ncauses);
        assert_true(!pairs[i].id || strstr(d->verdict.sentence, "Between before and AFTER changed"));
        assert_null(d->extended_deck);
        rotid_diagnosis_free(d);
    }
}

/* A joint that was tightened, a mass that was taken off: what is gone is named as what the first state has beside the second. */
UNIT_TEST(what_is_gone_is_named_the_other_way_round)
{
    static const struct {
        const char *effect[2]; /* that stays, that goes */
        const char *id, *name;
        double truth;
    } pairs[] = {
        {{"density:group=left,factor=1.1", "joint:at=left.end,flexibility=1e-7"}, "joint", "flexibility", 1e-7},
        {{"density:group=left,factor=1.1", "added_mass:mass=1.5,z=0.7"}, "added_mass", "mass", 1.5},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const struct hidden_state states[] = {{"before", "", 2, pairs[i].effect}, {"after", "", 1, pairs[i].effect}};
        const struct hide_request r = request(6, 13, 1600 + 10 * (unsigned)i);
        rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "after");
        assert_string_equal(d->before, "after");
        assert_string_equal(d->after, "before");
        assert_named(d, pairs[i].id, NULL, pairs[i].name, pairs[i].truth);
        assert_non_null(strstr(d->verdict.sentence, "Between after and before changed"));
        rotid_diagnosis_free(d);
    }
}

/* A fault of the measurement is found in the state that has it, or in both, and put right before the states are compared. */
UNIT_TEST(faults_of_the_measurement_go_with_the_states_that_have_them)
{
#define SOFT "stiffness_local:depth=0.4,z=0.4,width=0.03"
#define MASS "added_mass:mass=1.5,z=0.7"
    static const struct {
        const char *before[2], *after[3];
        int effects[2];
        const char *id, *finding[2]; /* of what changed, NULL: nothing; of each state */
    } pairs[] = {
        {{SOFT, "sensor_line:flip=1"}, {SOFT, "sensor_line:flip=1", MASS}, {2, 3}, "added_mass", {"sensor_line", "sensor_line"}},
        {{SOFT, "sensor_line:scale=0.95,shift=0.025"},
         {SOFT, "sensor_line:scale=0.95,shift=0.025", MASS},
         {2, 3},
         "added_mass",
         {"sensor_line", "sensor_line"}},
        {{SOFT, "sensor_line:flip=1"}, {SOFT, MASS}, {2, 2}, "added_mass", {"sensor_line", NULL}},
        {{SOFT, "sensor_gain:sensor=6,gain=3"}, {SOFT}, {2, 1}, NULL, {"sensor_gain", NULL}},
        {{SOFT, "sensor_sign:sensor=6"}, {SOFT, MASS}, {2, 2}, "added_mass", {"sensor_sign", NULL}},
        {{SOFT}, {SOFT, MASS, "mode_pairing:double=3"}, {1, 3}, "added_mass", {NULL, "mode_pairing"}},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const struct hidden_state states[] = {{"before", "", pairs[i].effects[0], pairs[i].before},
                                              {"after", "", pairs[i].effects[1], pairs[i].after}};
        const struct hide_request r = request(6, 13, 1 + 10 * (unsigned)i);
        rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "after");
        int findings = 0;
        for (int s = 0; s < 2; s++)
            if (pairs[i].finding[s]) {
                assert_true(findings < d->ndata_findings);
                assert_string_equal(d->data_findings[findings].id, pairs[i].finding[s]);
                assert_string_equal(d->data_findings[findings++].state, states[s].name);
            }
        assert_int_equal(d->ndata_findings, findings);
        assert_string_equal(d->sensors[0].state, "after");
        assert_non_null(
            strstr(d->verdict.sentence, pairs[i].finding[0] ? "In the measurement of state before, " : "of state after, "));
        if (pairs[i].id)
            assert_named(d, pairs[i].id, NULL, "mass", 1.5);
        else
            assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
        rotid_diagnosis_free(d);
    }
}

/* A support that is stiff in both states counts for neither among the rigid-body motions that modes are numbered above. */
UNIT_TEST(modes_have_the_same_numbers_in_both_states)
{
    static const char *const stiff[] = {"support:at=front,factor=1000"};
    static const struct hidden_state states[] = {{"before", "", 1, stiff}, {"after", "", 1, stiff}};
    const struct hide_request r = request(6, 0, 3);
    rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "after");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_true(d->verdict.p_value > 0.01);
    rotid_diagnosis_free(d);
}

/* Noise two and a half times the stated one is no change of the catalogue, nor that nothing shows. */
UNIT_TEST(what_scatters_more_than_stated_is_said_to)
{
    static const struct hidden_state states[] = {{"before", "", 0, NULL}, {"after", "", 0, NULL}};
    struct hide_request r = request(4, 5, 6);
    double times = 0;
    r.stated_frequency_noise = 0.001;
    r.frequency_noise = 0.0025;
    rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "after");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_true(d->verdict.p_value < 1e-6);
    assert_int_equal(sscanf(d->verdict.sentence, "Between before and after the data differ by %lf times", &times), 1);
    assert_true(times > 1.5 && times < 4);
    assert_non_null(strstr(d->verdict.sentence, "nothing changed and the noise is larger than stated"));
    rotid_diagnosis_free(d);
}

/* The states of a deck, and the job that asks what changed from one to the other; the number of warnings. */
static size_t settle(const struct states *read, struct job *out)
{
    const struct diagnose_options options = {.threads = 1, .before = "before", .after = "after"};
    struct message_list notes;
    struct settled settled;
    message_open(&notes, &test_pool);
    assert_status(changed_settle(&test_pool, read, &options, NULL, &notes, &settled), ROTID_OK);
    assert_status(changed_job(&test_pool, &settled, 0, NULL, &notes, out), ROTID_OK);
    return notes.count;
}

static void read_changed(const char *text, struct states *read, struct job *out)
{
    const struct deck_memory memory = {"deck", strlen(text), text, NULL};
    struct message_list notes;
    message_open(&notes, &test_pool);
    assert_status(deck_read_states(&test_pool, "deck", &memory, 0, NULL, &notes, read), ROTID_OK);
    settle(read, out);
}

/* The data of the second state by the equations of changed.h, beside the modes of the model that is held. */
POOL_TEST(data_are_corrected_by_what_the_first_state_shows)
{
    enum { MODES = 4, SENSORS = 7 };
    static const char *const dense[] = {"joint:at=core.end,flexibility=3e-9", "density:group=left,factor=1.1"};
    static const struct hidden_state states[] = {{"before", "", 1, dense}, {"after", "", 1, dense}};
    const struct hide_request r = request(MODES, SENSORS, 1300);
    char message[300], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
    struct states read;
    struct job out;
    struct spectrum spectrum;
    read_changed(text, &read, &out);
    assert_int_equal(out.unknowns.nparameter, 0);
    assert_status(spectrum_compute(&test_pool, NULL, &out.rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, &spectrum), ROTID_OK);
    const struct job_measurement *before = &read.state[0].job.measurement, *after = &read.state[1].job.measurement;
    for (int k = 0; k < MODES; k++) {
        const double *a = after->shape + (ptrdiff_t)k * SENSORS, *b = before->shape + (ptrdiff_t)k * SENSORS,
                     *phi = spectrum.shape + (ptrdiff_t)k * SENSORS;
        double ab = 0, bb = 0, pb = 0, pp = 0, p = spectrum.full_hz[k];
        assert_close(out.measurement.frequency_hz[k], after->frequency_hz[k] * p / before->frequency_hz[k], 1e-6, 0);
        assert_true(out.measurement.frequency_std[k] >= sqrt(2) * 0.000999);
        assert_true(out.measurement.frequency_std[k] < 1.1 * sqrt(2) * 0.001);
        for (int s = 0; s < SENSORS; s++) {
            ab += a[s] * b[s];
            bb += b[s] * b[s];
            pb += phi[s] * b[s];
            pp += phi[s] * phi[s];
        }
        for (int s = 0; s < SENSORS; s++)
            assert_close(out.measurement.shape[s + k * SENSORS], a[s] - ab / bb * (b[s] - pb / pp * phi[s]), 0, 1e-5);
    }
    free(text);
}

/* Places and shapes that the first state alone was measured at tell nothing, nor do they take from the others. */
POOL_TEST(what_was_measured_once_takes_nothing_from_the_rest)
{
    enum { MODES = 4, SENSORS = 7, COMMON = 4 };
    static const char *const dense[] = {"joint:at=core.end,flexibility=3e-9", "density:group=left,factor=1.1"};
    static const struct hidden_state states[] = {{"before", "", 1, dense}, {"after", "", 1, dense}};
    const struct hide_request r = request(MODES, SENSORS, 1300);
    char message[300], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
    const struct deck_memory memory = {"deck", strlen(text), text, NULL};
    struct message_list notes;
    struct states read;
    struct job out;
    message_open(&notes, &test_pool);
    assert_status(deck_read_states(&test_pool, "deck", &memory, 0, NULL, &notes, &read), ROTID_OK);
    for (int s = 0; s < SENSORS; s++) {
        read.state[1].job.measurement.shape[s + 3 * SENSORS] = NAN;
        if (s >= COMMON)
            read.state[1].job.measurement.shape[s + SENSORS] = NAN;
    }
    settle(&read, &out);
    for (int k = 0; k < MODES; k++) {
        assert_true(out.measurement.frequency_std[k] >= sqrt(2) * 0.000999);
        assert_true(out.measurement.frequency_std[k] < 1.1 * sqrt(2) * 0.001);
    }
    const double *a = read.state[1].job.measurement.shape + SENSORS;
    for (int s = 0; s < SENSORS; s++) {
        assert_true(isnan(out.measurement.shape[s + 3 * SENSORS]));
        if (s < COMMON)
            assert_close(out.measurement.shape[s + SENSORS], a[s], 0, 0.1); /* less what the model misses */
        else
            assert_true(isnan(out.measurement.shape[s + SENSORS]));
    }
    free(text);
}

/* Of 4 and of 6 sensors from end to end all and the two ends lie where 7 have one. */
POOL_TEST(sensors_at_other_places_are_told)
{
    static const struct hidden_state states[] = {{"before", "", 0, NULL}, {"after", "", 0, NULL}};
    static const int sensors[] = {7, 4, 6};
    struct states read[3];
    for (int i = 0; i < 3; i++) {
        const struct hide_request r = request(4, sensors[i], 1300);
        char message[300], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
        const struct deck_memory memory = {"deck", strlen(text), text, NULL};
        struct message_list notes;
        message_open(&notes, &test_pool);
        assert_status(deck_read_states(&test_pool, "deck", &memory, 0, NULL, &notes, &read[i]), ROTID_OK);
        free(text);
    }
    for (int i = 1; i < 3; i++) {
        struct job out;
        read[0].state[1] = read[i].state[1];
        assert_int_equal(settle(&read[0], &out), i == 2);
        for (int s = 0; s < sensors[i]; s++)
            assert_int_equal(isnan(out.measurement.shape[s]), i == 2 && s > 0 && s + 1 < sensors[i]);
    }
}

/* An unknown that groups share is held in all of them, not in the first alone. */
POOL_TEST(a_shared_unknown_is_held_in_every_group)
{
#define MEASURED "*MODES, COUNT=ELASTIC\n1, 419.065\n2, 754.2\n3, 1502.17\n"
    static const char text[] =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.06, 0, 12\n"
        "*SHAFT, NAME=core, MATERIAL=steel\n0.50, 0.10, 0, 16\n*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.06, 0, 10\n"
        "*NOISE, FREQUENCY=0.01\n*IDENTIFY\nleft.E=right.E, 1e10, 1e12, 1.9e11\n"
        "*STATE, NAME=before\n" MEASURED "*STATE, NAME=after\n" MEASURED;
    struct states read;
    struct job out;
    read_changed(text, &read, &out);
    double left = out.rotor.group[0].material.e, right = out.rotor.group[2].material.e;
    print_message("left %g, right %g\n", left, right);
    assert_true(left < 2e11 && left == right);
    assert_close(out.rotor.group[1].material.e, 2.1e11, 0, 0);
}

/* Too few data for judging each state by itself: they are compared as they stand. */
POOL_TEST(states_that_cannot_be_settled_are_compared_as_they_stand)
{
#define FEW "*MODES, COUNT=ELASTIC\n1, 420\n2, 785\n"
    struct states read;
    struct job out;
    read_changed(ROTOR
                 "left.E, 1e10, 1e12, 1.9e11\nleft.G, 1e9, 4e11, 7e10\nright.E, 1e10, 1e12, 1.9e11\n*NOISE, FREQUENCY=0.001\n"
                 "*STATE, NAME=before\n" FEW "*STATE, NAME=after\n" FEW,
                 &read, &out);
    assert_int_equal(out.measurement.nmode, 2);
    assert_int_equal(out.unknowns.nparameter, 0);
}

/* In two states that are alike a cause of both moves the rows of both alike. */
POOL_TEST(a_cause_of_all_states_has_columns_in_each)
{
    static const char text[] = ROTOR "*NOISE, FREQUENCY=0.01\n*FIT, FUNCTIONAL=LIKELIHOOD, REDUCTION=NONE\n"
                                     "*STATE, NAME=before\n" MEASURED "*STATE, NAME=after\n" MEASURED;
    const struct deck_memory memory = {"deck", sizeof text - 1, text, NULL};
    const int number[] = {1, 2, 3, 1, 2, 3}, holdout[6] = {0};
    const double x[] = {1.9e11, 7e10};
    struct message_list messages;
    struct states states;
    struct scan scan;
    int common = 0;
    message_open(&messages, &test_pool);
    assert_status(deck_read_states(&test_pool, "deck", &memory, 0, NULL, &messages, &states), ROTID_OK);
    assert_int_equal(states.nparameter, 2);
    assert_status(scan_run(&test_pool, &states, number, holdout, x, SCAN_ALL, &scan), ROTID_OK);
    assert_int_equal(scan.nrow, 6);
    for (int i = 0; i < scan.nitem; i++) {
        const double *column = scan.column + (ptrdiff_t)i * scan.nrow;
        for (int row = 0; row < 3 && scan.candidate[scan.item[i].candidate].state < 0; row++, common++)
            assert_close(column[row + 3], column[row], 1e-6, 1e-12);
    }
    assert_true(common > 100);
}

/* What is missed counts as noise by how much the mode has moved, d^2 = (2 ln f_a/f_b)^2 without shapes. */
POOL_TEST(what_a_mode_has_moved_widens_its_noise)
{
    enum { MODES = 4 };
    static const char *const dense[] = {"joint:at=core.end,flexibility=3e-9", "density:group=left,factor=1.1"};
    static const struct hidden_state states[] = {{"before", "", 2, dense}, {"after", DISC, 2, dense}};
    const struct hide_request r = request(MODES, 0, 1400);
    char message[300], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
    struct states read;
    struct job out;
    double widest = 0;
    read_changed(text, &read, &out);
    const struct job_measurement *before = &read.state[0].job.measurement, *after = &read.state[1].job.measurement;
    assert_int_equal(out.measurement.nmode, MODES);
    for (int k = 0; k < MODES; k++) {
        double missed = log(out.measurement.frequency_hz[k] / after->frequency_hz[k]),
               d = 2 * log(after->frequency_hz[k] / before->frequency_hz[k]),
               noise = hypot(after->frequency_std[k], before->frequency_std[k]);
        assert_close(out.measurement.frequency_std[k], hypot(noise, d * missed), 1e-9, 0);
        widest = fmax(widest, fabs(d * missed) / noise);
    }
    assert_true(widest > 1e-3);
    free(text);
}

/* Every fitted residual is one of a frequency or of a sensor, and those of modes that are held out are none: their squares sum up
 * to chi2. */
UNIT_TEST(residuals_of_sensors_and_frequencies_are_all_of_chi2)
{
    static const struct hidden_state states[] = {{"one", "", 0, NULL}, {"two", DISC, 0, NULL}};
    const struct hide_request r = request(4, 7, 1500);
    rotid_diagnosis *d = diagnose(&r, states, "FIT.HOLDOUT=2", NULL, NULL);
    double sum = 0;
    int fitted[2] = {0, 0};
    assert_int_equal(d->nsensors, 14);
    assert_int_equal(d->nmodes_standardised, 8);
    for (int k = 0; k < 8; k++) {
        fitted[k / 4] += !d->base->modes[k].holdout;
        sum += d->base->modes[k].holdout ? 0 : d->modes_standardised[k] * d->modes_standardised[k];
    }
    assert_in_range(fitted[0] + fitted[1], 4, 7);
    for (int s = 0; s < 14; s++)
        sum += d->sensors[s].rms * d->sensors[s].rms * fitted[s / 7];
    assert_int_equal(d->nrounds, 1);
    assert_close(sum, d->rounds[0].chi2, 1e-9, 0);
    rotid_diagnosis_free(d);
}

/* What a disc adds that the deck states is no change. */
UNIT_TEST(what_the_deck_states_is_no_change)
{
    static const struct hidden_state states[] = {{"before", "", 0, NULL}, {"after", DISC, 0, NULL}};
    const struct hide_request r = request(4, 7, 900);
    rotid_diagnosis *d = diagnose(&r, states, NULL, "before", "after");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    rotid_diagnosis_free(d);
}

UNIT_TEST(wrong_states_are_refused)
{
    static const struct hidden_state states[] = {{"before", "", 0, NULL}, {"after", DISC, 0, NULL}};
    static const struct {
        const char *before, *after, *text;
    } cases[] = {{"before", "later", "state later is not defined, expected one of before, after"},
                 {"now", "after", "state now is not defined, expected one of before, after"},
                 {"after", "after", "state after is given twice, expected two states"},
                 {"before", NULL, "options->after is NULL, expected the name of a state as well as in options->before"}};
    const struct hide_request r = request(4, 7, 900);
    char message[300], failure[ROTID_FAILURE_LENGTH], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
    rotid_deck *deck = read_handle(text, 0, NULL);
    rotid_diagnosis *d;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const rotid_diagnose_options options = {.size = sizeof options, .before = cases[i].before, .after = cases[i].after};
        assert_status(rotid_diagnose(deck, &options, NULL, failure, &d), ROTID_ERROR_ARGUMENT);
        assert_null(d);
        if (!strstr(failure, cases[i].text))
            fail_msg("%s, expected %s", failure, cases[i].text);
    }
    rotid_deck_free(deck);
    free(text);
}

/* Both questions, with one allocation failing, ever later. */
UNIT_TEST(failing_allocations_are_survived)
{
    static const char *const mass[] = {"added_mass:mass=0.5,z=0.7"};
    static const struct hidden_state states[] = {{"before", "", 0, NULL}, {"after", DISC, 1, mass}};
    const struct hide_request r = request(5, 0, 900);
    char message[300], *text = hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
    assert_non_null(text);
    for (int question = 0; question < 2; question++) {
        const rotid_diagnose_options options = {
            .size = sizeof options, .before = question ? "before" : NULL, .after = question ? "after" : NULL};
        rotid_deck *deck = read_handle(text, 0, NULL);
        for (int n = 1, done = 0; !done; n += 1 + n) {
            struct failing_allocator failing;
            rotid_diagnosis *d = NULL;
            failing_allocator_open(&failing, n);
            const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
            int status = rotid_diagnose(deck, &options, &environment, NULL, &d);
            if (status)
                assert_status(status, ROTID_ERROR_MEMORY);
            done = !status;
            assert_true(!done || failing.until_failure > 0);
            rotid_diagnosis_free(d);
            assert_int_equal(failing.in_use, 0);
            if (done)
                print_message("%d allocations at most\n", n);
        }
        rotid_deck_free(deck);
    }
    free(text);
}
