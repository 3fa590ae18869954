#include "diagnose/cause_intervals.h"

#include <math.h>
#include <string.h>

#include "diagnose/refit.h"
#include "fit/quantile.h"

#define HELD  1e-6 /* of the range: what a place may still move that is held */
#define NEAR  0.01 /* of the range: as near as an end is looked for */
#define STEPS 6

struct profile {
    const struct engine *engine;
    const struct states *states;
    const rotid_fit_result *fit;
    int p;
    double lower, upper;
};

/* *far := square root of what chi2 is above that of the fit with the place held at z; INFINITY where there is no fit. */
static int look_at(const struct profile *profile, double z, double *far)
{
    struct pool scratch;
    struct states held;
    rotid_fit_result *fit = NULL;
    double room = HELD * (profile->upper - profile->lower), from = fmax(profile->lower, z - room),
           to = fmin(profile->upper, z + room);
    pool_open(&scratch, profile->engine->pool->allocator);
    int status = states_started_at(&scratch, profile->states, profile->fit->x, &held);
    if (!status) {
        rotid_parameter *place = &held.bounds[profile->p];
        place->lower = from;
        place->upper = to;
        place->start = (from + to) / 2;
        states_share_bounds(&held, profile->p);
        status =
            refit_states(&scratch, &held, profile->engine->number, profile->engine->holdout, profile->engine->environment, &fit);
    }
    *far = status ? INFINITY : sqrt(fmax(0, fit->chi2 - profile->fit->chi2));
    rotid_fit_free(fit);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The end on the side of `bound`: the distance grows with that of the place, nearly in proportion. */
static int find_end(const struct profile *profile, double z, double bound, double *end)
{
    double limit = sqrt(chi_square_limit(0.05, 1)) * profile->fit->widened_by, inside = z, outside = bound, near = 0, far;
    int status = look_at(profile, bound, &far);
    *end = bound;
    if (status || far <= limit)
        return status;
    for (int i = 0; i < STEPS && fabs(outside - inside) > NEAR * (profile->upper - profile->lower); i++) {
        double share = isfinite(far) ? (limit - near) / (far - near) : 0.5, one,
               at = inside + fmin(fmax(share, 0.1), 0.9) * (outside - inside);
        status = look_at(profile, at, &one);
        if (status)
            return status;
        if (one <= limit) {
            inside = at;
            near = one;
        } else {
            outside = at;
            far = one;
        }
    }
    *end = outside;
    return ROTID_OK;
}

/* 95 % interval of unknown p, a place between `lower` and `upper` [m], by the profile of chi2: where the least chi2 of all other
 * unknowns is within 3.84 of that of `fit`, times the square by which the intervals of that are widened. interval [2] ends where
 * a side does, or within 1 % of the range outside of it. */
static int place_interval(const struct engine *engine, const struct states *states, const rotid_fit_result *fit, int p,
                          double lower, double upper, double interval[2])
{
    const struct profile profile = {engine, states, fit, p, lower, upper};
    double z = fmin(fmax(fit->x[p], lower), upper);
    int status = find_end(&profile, z, lower, &interval[0]);
    return status ? status : find_end(&profile, z, upper, &interval[1]);
}

/* Parameter p of the final fit, which belongs to the cause: its interval, unless the round found out that the fit's own says too
 * much; and a place that the fit gives no interval for has that of the scan. */
static void settle_parameter(const struct state *state, rotid_fit_result *fit, int q, struct candidate *cause)
{
    const struct job *job = &state->job;
    int component = job->unknowns.parameter[q].component, from_round = isfinite(cause->ci_lower[component]),
        p = state_unknown(state, q);
    if (isfinite(fit->std[p]) && from_round) {
        cause->std[component] = fit->std[p];
        cause->ci_lower[component] = fmax(fit->ci_lower[p], job->unknowns.bounds[q].lower);
        cause->ci_upper[component] = fmin(fit->ci_upper[p], job->unknowns.bounds[q].upper);
    } else if (from_round) {
        fit->ci_lower[p] = cause->ci_lower[component];
        fit->ci_upper[p] = cause->ci_upper[component];
        fit->identifiable[p] = 1;
    }
}

/* Whether the width of effect e ends at a bound, so that the fit knows the rest for that width alone. */
static int has_width_at_bound(const struct state *state, const rotid_fit_result *fit, int e, int width)
{
    const struct job_unknowns *u = &state->job.unknowns;
    for (int q = 0; q < u->nparameter; q++)
        if (u->parameter[q].kind == PARAMETER_EFFECT && u->parameter[q].index == e && u->parameter[q].component == width)
            return !isfinite(fit->std[state_unknown(state, q)]);
    return 0;
}

/* A place whose interval reaches beyond an end of the rotor, or that has none, is where no linear model holds, and with a width
 * at its bound the linear one is too short: its profile. */
static int settle_place(const struct engine *engine, const struct state *state, rotid_fit_result *fit, int q,
                        struct candidate *cause)
{
    const struct rotid_parameter *bounds = &state->job.unknowns.bounds[q];
    int component = state->job.unknowns.parameter[q].component, p = state_unknown(state, q);
    double interval[2];
    if (component != cause->cause->place || cause->fixed[component] ||
        (fit->ci_lower[p] > bounds->lower && fit->ci_upper[p] < bounds->upper &&
         !has_width_at_bound(state, fit, state->job.unknowns.parameter[q].index, cause->cause->width)))
        return ROTID_OK;
    int status = place_interval(engine, &engine->out->extended_states, fit, p, bounds->lower, bounds->upper, interval);
    if (status)
        return status;
    fit->ci_lower[p] = cause->ci_lower[component] = interval[0];
    fit->ci_upper[p] = cause->ci_upper[component] = interval[1];
    return ROTID_OK;
}

int cause_intervals(const struct engine *engine)
{
    struct diagnosis *out = engine->out;
    rotid_fit_result *fit = out->extended.fit;
    int status = ROTID_OK;
    for (int c = 0; c < out->ncause && !status; c++) {
        struct candidate *cause = &out->cause[c];
        const struct state *state = &out->extended_states.state[cause->home];
        const struct job *job = &state->job;
        int e = 0;
        while (e < job->rotor.neffect && strcmp(job->rotor.effect[e].name, cause->effect.name) != 0)
            e++;
        if (e == job->rotor.neffect)
            continue;
        effect_at(state, e, fit->x, &cause->effect);
        for (int q = 0; q < job->unknowns.nparameter && !status; q++)
            if (job->unknowns.parameter[q].kind == PARAMETER_EFFECT && job->unknowns.parameter[q].index == e) {
                settle_parameter(state, fit, q, cause);
                status = settle_place(engine, state, fit, q, cause);
            }
    }
    return status;
}
