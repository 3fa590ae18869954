#include "diagnose/widen.h"

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

/* *wider := the job with sizes that end at a bound given `times` the usual room; *any: there is such a size. */
static int widen(struct pool *pool, const struct scan *scan, const struct scan_set *set, const struct refit *refit, double times,
                 struct job *wider, int *any)
{
    const struct job *job = &refit->job;
    int first = job->rotor.neffect - set->count, status = job_started_at(pool, job, refit->fit->x, wider);
    *any = 0;
    wider->rotor.effect = POOL_ARRAY(pool, struct effect, job->rotor.neffect);
    if (status || !wider->rotor.effect)
        return ROTID_ERROR_MEMORY;
    memcpy(wider->rotor.effect, job->rotor.effect, (size_t)job->rotor.neffect * sizeof *wider->rotor.effect);
    for (int m = 0; m < set->count; m++) {
        const struct scan_candidate *c = &scan->candidate[set->candidate[m]];
        int size = c->cause->size, p = c->cause->solid ? -1 : size_parameter(job, first + m, size);
        if (p < 0 || c->effect.bound[0] < c->effect.bound[1])
            continue;
        rotid_parameter *bounds = &wider->unknowns.bounds[p];
        struct effect *effect = &wider->rotor.effect[first + m];
        if (!size_at_bound(bounds, c->cause->parameter[size].neutral, refit->fit->x[p]) ||
            !cause_widen(c->cause, &job->rotor, times, effect))
            continue;
        bounds->lower = effect->bound[0];
        bounds->upper = effect->bound[1];
        bounds->start = refit->fit->x[p];
        *any = 1;
    }
    return ROTID_OK;
}

int refit_widen(struct pool *pool, const struct scan *scan, const struct scan_set *set, const int *number, const int *holdout,
                const rotid_environment *environment, struct refit *refit)
{
    int any = refit->fit != NULL, better = 1;
    for (double times = STEP; any && better; times *= STEP) {
        struct job wider;
        rotid_fit_result *fit = NULL;
        int status = widen(pool, scan, set, refit, times, &wider, &any);
        if (status || !any)
            return status;
        status = refit_job(pool, &wider, number, holdout, environment, &fit);
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
