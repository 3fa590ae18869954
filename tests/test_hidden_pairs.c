/* Two effects hidden at once (hidden.h), both to be named with their sizes inside their intervals; one effect, and effects
 * outside of the catalogue, where no pair may be named. tools/power does the same with fresh ones. */
#include "support.h"

#include <unistd.h>

#include "hidden.h"

#define JOBS 2

enum expected {
    BOTH,    /* named, with their sizes, and nothing is left */
    ALONE,   /* the one cause is named, and no pair was tried beside it */
    NO_PAIR, /* none is named */
};

static const struct {
    enum expected expected;
    unsigned seed;
    const char *effect[2]; /* at most */
} table[] = {
    {BOTH, 2, {"stiffness:group=left,factor=0.88", "stiffness:group=right,factor=0.85"}},
    {BOTH, 3, {"stiffness_local:depth=0.5,z=0.857,width=0.04,shape=gaussian", "added_mass:mass=10,z=1.6"}},
    {BOTH, 5, {"joint:at=left.end,flexibility=2e-9", "density:group=core,factor=0.92"}},
    {BOTH,
     4,
     {"stiffness:group=left,factor=0.7", "joint:at=core.end,flexibility=9e-9"}}, /* too large for columns without effects */
    {ALONE, 6, {"stiffness_gradient:group=core,slope=0.4"}},
    {ALONE, 7, {"stiffness_local:depth=0.6,z=0.857,width=0.04,shape=gaussian"}},
    {ALONE, 8, {"stiffness:group=left,factor=2.2"}},                         /* beyond the usual bounds */
    {NO_PAIR, 12, {"outside:kind=density_zone,factor=1.5,z=0.6,width=0.5"}}, /* two masses stand for a shorter one */
    {NO_PAIR, 12, {"outside:kind=inertia,z=0.6,inertia=3"}},
};

#define COUNT ((int)(sizeof table / sizeof *table))

static struct seen { /* of one diagnosis, while it is there */
    int kind, adequate_after, ncause, covered;
    char sentence[400];
} seen[COUNT];
static struct hidden_score score[COUNT];
static char directory[] = "/tmp/hidden.XXXXXX";

/* Whether the interval of the size of a cause holds that of the effect it is. */
static int covers(const struct candidate *c, const cJSON *effects)
{
    const struct effect_kind *kind = c->effect.kind;
    int size = c->cause->size;
    const cJSON *effect;
    cJSON_ArrayForEach(effect, effects)
    {
        const char *id = cJSON_GetStringValue(cJSON_GetObjectItem(effect, "id")),
                   *target = cJSON_GetStringValue(cJSON_GetObjectItem(effect, "target"));
        const cJSON *value = cJSON_GetObjectItem(cJSON_GetObjectItem(effect, "parameters"), kind->parameter[size].name);
        if (!strcmp(id, c->cause->id) && (!target || !*target || !strncmp(target, c->target, strlen(c->target)) ||
                                          strchr(target, ','))) /* of an interface, which is but one here */
            return cJSON_IsNumber(value) && c->ci_lower[size] <= value->valuedouble && value->valuedouble <= c->ci_upper[size];
    }
    return 0;
}

static void look(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                 const struct hidden_score *unused)
{
    struct seen *s = (struct seen *)context + c->number;
    (void)unused;
    s->kind = d->result.verdict.kind;
    s->adequate_after = d->result.verdict.adequate_after;
    s->ncause = d->ncause;
    for (int i = 0; i < d->ncause; i++)
        s->covered += covers(&d->cause[i], cJSON_GetObjectItem(truth, "effects"));
    snprintf(s->sentence, sizeof s->sentence, "%s", d->result.verdict.sentence);
}

static int run_one(void *deck, int i, int worker)
{
    struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
    (void)worker;
    c.request.deck = deck;
    c.request.name = "input/paper_rotor.inp";
    c.request.seed = table[i].seed;
    c.request.effect = table[i].effect;
    c.request.effects = (table[i].effect[0] != NULL) + (table[i].effect[1] != NULL);
    return hidden_run(&c, NULL, look, seen, &score[i]);
}

static int run_all(void **state)
{
    char *deck = hidden_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp");
    (void)state;
    assert_non_null(deck);
    assert_non_null(mkdtemp(directory));
    int status = parallel_for(JOBS, COUNT, run_one, deck);
    rmdir(directory);
    free(deck);
    return status;
}

static int is_as_expected(int i)
{
    const struct hidden_score *s = &score[i];
    const struct seen *d = &seen[i];
    int named = d->kind == ROTID_NAMED && d->adequate_after && s->outcome == HIDDEN_RIGHT && d->covered == d->ncause;
    switch (table[i].expected) {
    case BOTH:
        return named && d->ncause == 2 && s->found == 2;
    case ALONE:
        return d->kind == ROTID_NAMED && d->adequate_after && d->ncause == 1 && d->covered == 1;
    default:
        return d->ncause < 2;
    }
}

static void check(enum expected expected)
{
    int bad = 0;
    for (int i = 0; i < COUNT; i++) {
        const struct hidden_score *s = &score[i];
        if (table[i].expected != expected)
            continue;
        int as_expected = is_as_expected(i) && s->outcome != HIDDEN_FAILED;
        bad += !as_expected;
        print_message("%s seed %-2u %s %s: %s%s, drop %.1f, %.1f s; %s\n", as_expected ? "     " : "  BAD", table[i].seed,
                      table[i].effect[0], table[i].effect[1] ? table[i].effect[1] : "alone", hidden_outcome_name(s->outcome),
                      s->failure, s->drop, s->seconds, seen[i].sentence);
    }
    assert_int_equal(bad, 0);
}

#define TEST(name, expected)                                                                                                     \
    static void name(void **state)                                                                                               \
    {                                                                                                                            \
        (void)state;                                                                                                             \
        check(expected);                                                                                                         \
    }
TEST(two_effects_are_both_named_with_their_sizes, BOTH)
TEST(one_effect_is_no_pair, ALONE)
TEST(what_is_not_in_the_catalogue_is_no_pair, NO_PAIR)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_effects_are_both_named_with_their_sizes),
        cmocka_unit_test(one_effect_is_no_pair),
        cmocka_unit_test(what_is_not_in_the_catalogue_is_no_pair),
    };
    return cmocka_run_group_tests(tests, run_all, NULL);
}
