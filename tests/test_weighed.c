/* What a rotor weighs, and where its centre of mass is, beside its modes (*WEIGHT, *CENTRE): the card, the fit, and a diagnosis
 * of effects that tools/hide hides, which modes alone hardly tell apart. The rows of the residual: test_functional, test_columns.
 */
#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "folder.h"
#include "hidden.h"
#include "reading.h"
#include "support.h"

TEST_GROUP(folder_make, folder_remove);

#define DECK ROTID_SOURCE_DIR "/input/paper_rotor.inp"

/* Data of the rotor with an effect, and the cards behind them; on the test's pool. */
static const char *hidden_deck(const char *effect, int shapes, const char *cards)
{
    struct hide_request request = hide_request_default();
    char message[300], *given = hidden_read(DECK), *deck, *truth;
    request.deck = given;
    request.name = "input/paper_rotor.inp";
    request.seed = 7;
    request.effect = &effect;
    request.effects = 1;
    request.no_shapes = !shapes;
    if (hide_case(&request, &deck, &truth, message, sizeof message))
        fail_msg("%s", message);
    const char *text = pool_format(&test_pool, "%s\n%s", deck, cards);
    free(given);
    free(deck);
    free(truth);
    return text;
}

/* Probability of a cause at a target. */
static double share_of(const char *deck, const char *id, const char *target)
{
    struct message_list messages;
    struct job job;
    struct diagnosis d;
    double sum = 0;
    message_open(&messages, &test_pool);
    read_job(deck, &messages, &job);
    assert_status(diagnose_run(&test_pool, &job, &(struct diagnose_options){.threads = 1}, NULL, &messages, &d), ROTID_OK);
    for (int i = 0; i < d.posterior.nmarginal; i++) {
        const struct marginal *m = &d.posterior.marginal[i];
        sum += !strcmp(m->cause.cause->id, id) && !strcmp(m->cause.target, target) ? m->probability : 0;
    }
    diagnose_free(&d);
    return sum;
}

/* Mass and centre of mass of the model, and those of a group without layers and holes. */
static void weigh(int group, double *mass, double *centre)
{
    struct message_list messages;
    struct job job;
    struct mass_properties all;
    double z = 0, m = 0, first = 0;
    char *deck = hidden_read(DECK);
    message_open(&messages, &test_pool);
    read_job(deck, &messages, &job);
    free(deck);
    assert_status(model_weigh(&test_pool, job.models, &job.rotor, 0, NULL, NULL, &all), ROTID_OK);
    *mass = all.mass;
    *centre = all.center;
    for (int s = 0; s < job.rotor.nsegment && group >= 0; z += job.rotor.segment[s++].length) {
        const struct segment *segment = &job.rotor.segment[s];
        double own = (segment->outer * segment->outer - segment->inner * segment->inner) * segment->length;
        if (segment->group != group)
            continue;
        m += own;
        first += own * (z + segment->length / 2);
    }
    if (group < 0)
        return;
    *mass = rotor_group_mass(&job.rotor, group);
    *centre = first / m;
}

/* By frequencies alone, then with the weight, then with the centre of mass as well; the left shaft is solid. */
POOL_TEST(a_weight_tells_masses_apart)
{
    static const struct {
        const char *effect, *id, *target;
        double factor;                   /* of the mass of the left shaft; 0: a mass of 8 kg at 0.4 m */
        double before, weighed, centred; /* at most, at least, at least */
    } hidden[] = {{"density:group=left,factor=1.04", "density", "left", 1.04, 0.1, 0.5, 0.9},
                  {"diameter:group=left,factor=1.02", "diameter", "left", 1.02 * 1.02, 0.6, 0.95, 0.95},
                  {"added_mass:mass=8,z=0.4", "added_mass", "", 0, 0.4, 0.9, 0.9}};
    double mass, centre, part[2], share[3];
    weigh(-1, &mass, &centre);
    weigh(0, &part[0], &part[1]);
    for (int i = 0; i < 3; i++) {
        double more = hidden[i].factor > 0 ? (hidden[i].factor - 1) * part[0] : 8, at = hidden[i].factor > 0 ? part[1] : 0.4;
        const char *weight = pool_format(&test_pool, "*WEIGHT\n%.7g, 0.5\n", mass + more),
                   *cards[3] = {
                       "", weight,
                       pool_format(&test_pool, "%s*CENTRE\n%.7g, 0.0003\n", weight, (mass * centre + more * at) / (mass + more))};
        for (int k = 0; k < 3; k++)
            share[k] = share_of(hidden_deck(hidden[i].effect, 0, cards[k]), hidden[i].id, hidden[i].target);
        print_message("%s: %.3f, %.3f with the weight, %.3f with its centre\n", hidden[i].effect, share[0], share[1], share[2]);
        assert_true(share[0] < hidden[i].before && share[1] > hidden[i].weighed && share[2] > hidden[i].centred);
    }
}

/* Frequencies that no bar has: the model weighs 7850 pi/4 0.05^2 = 15.41 kg, and the verdict says so. */
POOL_TEST(what_is_unexplained_is_to_be_weighed)
{
    static const char *const bar =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, "
        "MATERIAL=steel\n1.0, 0.05, 0, 40\n*MODES\n1, 200\n2, 680\n3, 1100\n4, 2100\n5, 2700\n6, 4300\n7, "
        "4600\n*NOISE, FREQUENCY=1e-3\n*IDENTIFY\nbar.E, 1e11, 4e11, 1.8e11\n";
    static const char *const cards[] = {"", "*WEIGHT\n12, 0.1\n", "*WEIGHT\n15.3, 0.1\n"},
                             *const said[] = {"Weigh the rotor first: the model has 15.41 kg.",
                                              "The model has 15.41 kg and the rotor 12 kg: correct diameters", NULL};
    for (int i = 0; i < 3; i++) {
        struct message_list messages;
        struct job job;
        struct diagnosis d;
        read_job(pool_format(&test_pool, "%s%s", bar, cards[i]), &messages, &job);
        assert_status(diagnose_run(&test_pool, &job, &(struct diagnose_options){.threads = 1}, NULL, &messages, &d), ROTID_OK);
        assert_int_equal(d.result.verdict.kind, ROTID_UNEXPLAINED);
        assert_true(said[i] ? strstr(d.result.verdict.sentence, said[i]) != NULL
                            : !strstr(d.result.verdict.sentence, "correct diameters"));
        diagnose_free(&d);
    }
}
