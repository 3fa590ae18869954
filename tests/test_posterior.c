/* Explanations with probabilities (src/diagnose/posterior.c) on hidden effects (hidden.h): what is hidden leads and is named,
 * nothing hidden stays nothing, what is not in the catalogue and leaves much is "something else"; and what holds of every list.
 */
#include "support.h"

#include <unistd.h>

#include "hidden.h"

static const struct {
    const char *effect[2]; /* at most */
    unsigned seed;
    enum hidden_outcome outcome;
} table[] = {
    {{NULL}, 31, HIDDEN_SILENT},
    {{"stiffness_gradient:group=core,slope=0.15"}, 1, HIDDEN_RIGHT},
    {{"joint:at=core.end,flexibility=4e-10"}, 1, HIDDEN_RIGHT},
    {{"added_mass:mass=10,z=1.6", "sensor_gain:sensor=23,gain=1.4"}, 1, HIDDEN_RIGHT},
    {{"stiffness:group=left,factor=1.08", "added_mass:mass=20,z=1.2"}, 43, HIDDEN_RIGHT},
};
#define COUNT ((int)(sizeof table / sizeof *table))

/* What holds of every posterior: probabilities, their order, marginals, moduli between those of the explanations. */
static void check_list(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                       const struct hidden_score *unused)
{
    const struct posterior *p = &d->posterior;
    double sum = 0, nothing = 0;
    int *checked = context;
    (void)truth, (void)unused;
    assert_true(p->count > 1);
    for (int i = 0; i < p->count; i++) {
        sum += p->item[i].probability;
        nothing += !p->item[i].nmember && !p->item[i].something_else ? p->item[i].probability : 0;
        if (i)
            assert_true(p->item[i].probability <= p->item[i - 1].probability);
    }
    assert_close(sum, 1, 1e-12, 0);
    assert_close(p->nothing, nothing, 1e-12, 1e-300);
    for (int m = 0; m < p->nmarginal; m++) {
        double own = 0;
        for (int i = 0; i < p->count; i++) {
            int has = 0;
            for (int k = 0; k < p->item[i].nmember; k++)
                has |= p->item[i].member[k].cause == p->marginal[m].cause.cause &&
                       !strcmp(p->item[i].member[k].target, p->marginal[m].cause.target);
            own += has ? p->item[i].probability : 0;
        }
        if (p->marginal[m].cause.cause->class == CAUSE_DATA && own == 0) { /* taken out of the data before this list was made */
            assert_true(p->marginal[m].probability >= VERDICT_NAMED);
            assert_true(d->result.ndata_findings > 0);
            continue;
        }
        /* less than LEAST_SHARE a set is not counted; a cause far from the place of this one is another name */
        assert_true(own - p->marginal[m].probability > -1e-4);
        if (p->marginal[m].cause.cause->place < 0)
            assert_true(own - p->marginal[m].probability < 1e-4);
    }
    for (int q = 0; q < p->naveraged; q++) {
        double lowest = INFINITY, highest = -INFINITY;
        for (int i = 0; i < p->count; i++) {
            lowest = fmin(lowest, p->item[i].evidence.mean[q]);
            highest = fmax(highest, p->item[i].evidence.mean[q]);
        }
        const rotid_averaged_parameter *a = &p->averaged[q];
        assert_true(a->value >= lowest * (1 - 1e-12) && a->value <= highest * (1 + 1e-12));
        assert_true(a->ci95[0] < a->value && a->value < a->ci95[1]);
    }
    if (c->number > 0 && c->number < 3) /* one cause: nothing is left for nothing */
        assert_true(p->nothing < 1e-6 && p->item[0].nmember == 1 && p->item[0].probability > 0.9);
    (*checked)++;
}

static struct candidate zone_at(double z)
{
    const struct cause_kind *cause = catalogue_find("stiffness_local");
    struct candidate c = {.cause = cause, .state = -1, .target = ""};
    c.effect.value[cause->place] = z;
    return c;
}

/* Zones within an eighth of the length are one name, which counts once in a set that has it twice. */
POOL_TEST(a_place_nearby_is_the_same_name)
{
    struct explanation item[] = {{.nmember = 2, .member = {zone_at(0.50), zone_at(0.55)}, .probability = 0.4},
                                 {.nmember = 1, .member = {zone_at(0.45)}, .probability = 0.3},
                                 {.nmember = 1, .member = {zone_at(0.90)}, .probability = 0.2, .something_else = 1},
                                 {.probability = 0.1}};
    struct posterior p = {.count = 4, .item = item, .length = 1};
    assert_status(posterior_marginals(&test_pool, &p), ROTID_OK);
    assert_int_equal(p.nmarginal, 2);
    assert_close(p.marginal[0].probability, 0.7, 1e-12, 0);
    assert_close(p.marginal[1].probability, 0.2, 1e-12, 0);
    assert_close(p.nothing, 0.1, 1e-12, 0);
    assert_close(p.something_else, 0.2, 1e-12, 0);
}

UNIT_TEST(what_is_hidden_leads)
{
    char directory[] = "/tmp/hidden.XXXXXX", *deck = hidden_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp");
    int checked = 0;
    assert_non_null(deck);
    assert_non_null(mkdtemp(directory));
    for (int i = 0; i < COUNT; i++) {
        struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
        struct hidden_score score;
        c.request.deck = deck;
        c.request.name = "input/paper_rotor.inp";
        c.request.seed = table[i].seed;
        c.request.effect = table[i].effect;
        c.request.effects = (table[i].effect[0] != NULL) + (table[i].effect[1] != NULL);
        assert_int_equal(hidden_run(&c, NULL, check_list, &checked, &score), 0);
        print_message("%s: %s %s\n", table[i].effect[0] ? table[i].effect[0] : "nothing", hidden_outcome_name(score.outcome),
                      score.wrong);
        assert_int_equal(score.outcome, table[i].outcome);
    }
    assert_int_equal(checked, COUNT);
    rmdir(directory);
    free(deck);
}

/* Of a free rotor in one group with E unknown the density: its frequencies are those of another E, so that nothing tells it from
 * nothing, and their ratio stays that of the priors. */
static void check_inseparable(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                              const struct hidden_score *unused)
{
    const struct posterior *p = &d->posterior;
    double density = 0;
    (void)c, (void)truth, (void)unused;
    for (int i = 0; i < p->count; i++)
        if (p->item[i].nmember == 1 && !p->item[i].something_else && !strcmp(p->item[i].member[0].cause->id, "density"))
            density += p->item[i].probability;
    assert_close(density / p->nothing, exp(posterior_log_prior(1, 0) - posterior_log_prior(0, 0)) / p->nkind, 1e-9, 0);
    (*(int *)context)++;
}

UNIT_TEST(what_no_data_tell_apart_keeps_the_ratio_of_the_priors)
{
    char directory[] = "/tmp/hidden.XXXXXX";
    int checked = 0;
    struct hidden_case c = {.request = hide_request_default(), .directory = directory};
    struct hidden_score score;
    assert_non_null(mkdtemp(directory));
    c.request.name = "free";
    c.request.deck = "*MATERIAL, NAME=own\n*ELASTIC\n1.5e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=own\n"
                     "0.5, 0.1, 0, 20\n0.5, 0.06, 0, 20\n*IDENTIFY\ncore.E, 3e10, 6e11, 1.2e11\n";
    c.request.modes = 6;
    c.request.sensors = 17;
    c.request.seed = 4;
    assert_int_equal(hidden_run(&c, NULL, check_inseparable, &checked, &score), 0);
    assert_int_equal(score.outcome, HIDDEN_SILENT);
    assert_int_equal(checked, 1);
    rmdir(directory);
}

/* Of a normal that is cut at its mean half is left: m + s sqrt(2/pi), s sqrt(1 - 2/pi); of one far wider than its bounds a
 * uniform one; of two explanations the mixture. The mean is inside its interval. */
UNIT_TEST(averages_are_cut_at_the_bounds_as_their_intervals_are)
{
    static const struct {
        double mean, std, lower, upper, value, deviation;
    } cut[] = {{5, 0.1, 1, 9, 5, 0.1},
               {1, 0.1, 1, 9, 1.0797884560802865, 0.06028102749890869},
               {9, 0.1, 1, 9, 8.9202115439197135, 0.06028102749890869},
               {8.9, 1e6, 1, 9, 5, 2.3094010767585030},
               {8.9, 400, 1, 9, 5, 2.3094010767585030},
               {3, 0, 1, 9, 3, 0}};
    for (size_t i = 0; i < sizeof cut / sizeof *cut; i++) {
        double mean = cut[i].mean, std = cut[i].std, value, deviation, lower, upper;
        struct explanation item[2] = {{.probability = 0.25, .evidence = {.mean = &mean, .std = &std}},
                                      {.probability = 0.75, .evidence = {.mean = &mean, .std = &std}}};
        const struct posterior p = {.count = 2, .item = item};
        const rotid_parameter bounds = {"x", "1", cut[i].lower, cut[i].upper, 2};
        posterior_average(&p, &bounds, 0, &value, &deviation, &lower, &upper);
        assert_close(value, cut[i].value, 1e-3, 0);
        assert_close(deviation, cut[i].deviation, 1e-3, 1e-12);
        assert_true(lower <= value * (1 + 1e-8) && value <= upper * (1 + 1e-8));
    }
}
