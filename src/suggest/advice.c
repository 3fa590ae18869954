#include "suggest/advice.h"

#include "fit/quantile.h"

#define LIKELY 0.5 /* chance of a name from which on a test is recommended without more ado */

static const char *needed(struct pool *pool, const rotid_suggestion *r)
{
    if (!r->nparameters)
        return "nothing is to be identified";
    if (r->modes_needed != ROTID_NONE)
        return pool_format(pool, "the frequencies of modes 1 to %d determine all parameters to %g %%", r->modes_needed,
                           r->wanted_percent);
    if (r->sensors_needed != ROTID_NONE)
        return pool_format(pool, "%d modes with shapes at the %d best points determine all parameters to %g %%", r->plan_modes,
                           r->sensors_needed, r->wanted_percent);
    return pool_format(pool, "no number of modes and sensors that was tried determines all parameters to %g %%: less noise would",
                       r->wanted_percent);
}

static const char *plan(struct pool *pool, const rotid_suggestion *r)
{
    const rotid_sensor_plan *best = NULL;
    for (int i = 0; i < r->nplans; i++)
        if (!best || r->plans[i].gain_percent > best->gain_percent)
            best = &r->plans[i];
    const char *where = best ? pool_format(pool, " Of the plans %s tells most of moduli and causes: shapes at its %d points.",
                                           best->method, best->nz_m)
                             : "";
    const char *what = needed(pool, r);
    return what && where ? pool_format(pool, "With this noise %s.%s", what, where) : NULL;
}

static const char *tests(struct pool *pool, const struct suggestion *s)
{
    const rotid_suggestion *r = &s->result;
    const rotid_suggested_test *best = &r->tests[0];
    int causes = r->nrivals - 1, again = 0; /* number of the same test; the best one's where there is none or it is the best */
    for (int i = 0; i < r->ntests; i++)
        if (s->test[i].kind == TEST_AGAIN)
            again = i;
    const rotid_fit_result *fit = s->rivals.rival[0].fit;
    int doubtful = s->rivals.left_out || (fit->dof > 0 && chi_square_tail(fit->chi2, fit->dof) < JUDGED);
    const char *unless = doubtful ? "If one of these rivals is the true one: " : "Next: ";
    const char *who = causes > 1 ? pool_format(pool, "the true one of the %d rivals", causes) : "the one cause that is left";
    const char *instead = again ? pool_format(pool, "; the same test again: %.2f", r->tests[again].chance) : "";
    if (!who || !instead)
        return NULL;
    if (best->chance < LIKELY)
        return pool_format(
            pool,
            "%sno single test that was tried is likely to name %s; the best is %s, with a chance of %.2f at a cost of "
            "%.3g points%s.",
            unless, who, best->text, best->chance, best->cost, instead);
    return pool_format(pool, "%smeasure %s: %s is then named with a chance of %.2f, at a cost of %.3g points%s.", unless,
                       best->text, who, best->chance, best->cost, instead);
}

const char *advice_sentence(struct pool *pool, const struct suggestion *s)
{
    const rotid_suggestion *r = &s->result;
    if (!s->found.base.fit)
        return plan(pool, r);
    if (r->ntests)
        return tests(pool, s);
    const char *more = plan(pool, r);
    const char *open = s->rivals.left_out ? "What is open is no matter of causes that a test of this kind tells apart"
                       : s->found.result.verdict.kind == ROTID_UNEXPLAINED
                           ? "No cause of the catalogue explains the data, so no test can be chosen to tell causes apart"
                           : "No cause is left to be told from another one";
    return more ? pool_format(pool, "%s. %s", open, more) : NULL;
}
