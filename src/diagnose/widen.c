#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#define AT_BOUND 0.005 /* of the physical range */
#define STEP     3.0

int size_at_bound(const rotid_parameter *bounds, double neutral, double x)
{
    double lower = bounds->lower, upper = bounds->upper;
    if (lower > 0 && neutral > 0 && x > 0) {
        lower = log(lower);
        upper = log(upper);
        neutral = log(neutral);
        x = log(x);
    }
    double near = AT_BOUND * (upper - lower);
    return (x < lower + near && fabs(lower - neutral) > near) || (x > upper - near && fabs(upper - neutral) > near);
}

/* Index of the parameter that is the size of effect e, -1 where that is fixed. */
static int size_parameter(const struct job *job, int e, int size)
{
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == PARAMETER_EFFECT && job->unknowns.parameter[p].index == e &&
            job->unknowns.parameter[p].component == size)
            return p;
    return -1;
}

/* The bounds of the effect in the states where it acts, and those of its size. */
static void set_bounds(const struct scan *scan, const struct scan_set *set, int m, const struct effect *effect, double start,
                       struct states *states)
{
    const struct scan_candidate *c = &scan->candidate[set->candidate[m]];
    for (int s = 0; s < states->nstate; s++) {
        struct job *job = &states->state[s].job;
        if (!c->in[s])
            continue;
        int e = refit_effect(scan, set, m, s, &job->rotor), q = size_parameter(job, e, c->cause->size);
        memcpy(job->rotor.effect[e].bound, effect->bound, sizeof effect->bound);
        rotid_parameter *const bounds[] = {&job->unknowns.bounds[q], &states->bounds[state_unknown(&states->state[s], q)]};
        for (int i = 0; i < 2; i++) {
            bounds[i]->lower = effect->bound[0];
            bounds[i]->upper = effect->bound[1];
            bounds[i]->start = start;
        }
    }
}

/* *wider := the states with sizes that end at a bound given `times` the usual room; *any: there is such a size. */
static int widen(struct pool *pool, const struct scan *scan, const struct scan_set *set, const struct refit *refit, double times,
                 struct states *wider, int *any)
{
    int status = states_started_at(pool, &refit->states, refit->fit->x, wider);
    *any = 0;
    for (int s = 0; s < wider->nstate && !status; s++) {
        struct rotor *rotor = &wider->state[s].job.rotor;
        struct effect *effect = POOL_ARRAY(pool, struct effect, rotor->neffect);
        if (!effect)
            return ROTID_ERROR_MEMORY;
        if (rotor->neffect)
            memcpy(effect, rotor->effect, (size_t)rotor->neffect * sizeof *effect);
        rotor->effect = effect;
    }
    for (int m = 0; m < set->count && !status; m++) {
        const struct scan_candidate *c = &scan->candidate[set->candidate[m]];
        const struct state *home = &refit->states.state[c->home];
        if (c->cause->solid || c->effect.bound[0] < c->effect.bound[1])
            continue;
        int e = refit_effect(scan, set, m, c->home, &home->job.rotor), size = c->cause->size,
            q = size_parameter(&home->job, e, size);
        if (q < 0)
            continue;
        double x = refit->fit->x[state_unknown(home, q)];
        struct effect effect = wider->state[c->home].job.rotor.effect[e];
        if (!size_at_bound(&wider->state[c->home].job.unknowns.bounds[q], c->cause->parameter[size].neutral, x) ||
            !cause_widen(c->cause, &home->job.rotor, times, &effect))
            continue;
        set_bounds(scan, set, m, &effect, x, wider);
        *any = 1;
    }
    return status;
}

int refit_widen(struct pool *pool, const struct scan *scan, const struct scan_set *set, const int *number, const int *holdout,
                const rotid_environment *environment, struct refit *refit)
{
    int any = refit->fit != NULL, better = 1;
    for (double times = STEP; any && better; times *= STEP) {
        struct states wider;
        rotid_fit_result *fit = NULL;
        int status = widen(pool, scan, set, refit, times, &wider, &any);
        if (status || !any)
            return status;
        status = refit_states(pool, &wider, number, holdout, environment, &fit);
        if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
            return status;
        better = !status && fit->chi2 < refit->chi2;
        if (better)
            status = refit_keep(pool, &wider, fit, refit);
        else
            rotid_fit_free(fit);
        if (better && status)
            return status;
    }
    return ROTID_OK;
}
