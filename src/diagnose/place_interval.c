/* The 95 % interval of a place by the profile of chi2: the fit with the place held elsewhere and all else free. About a minimum
 * inside a stretch of one section the profile is a parabola, which two fits show. At a step of the section it has a kink, steep
 * into one section and flat in the other, of which the curvature at the minimum knows nothing; and at an end of the rotor one
 * side is missing. An end of the interval is where f, the root of the rise of chi2, which grows nearly in proportion to the
 * distance, is 1.96 times that by which the intervals of the fit are widened, or the bound.
 *
 * For ln Z the profile does not do: over a grid, halves of normals through its ends are 0.5 to 1.4 off beside a step, where the
 * normal of the fit is 0.1 to 0.6 off, as what else is free has another range at each place. */
#include "diagnose/diagnose.h"

#include <math.h>

#include "fit/fit.h"

#define HELD   1e-6 /* of the range: what a place may still move that is held */
#define NEAR   0.01 /* of the range: as near as an end is looked for */
#define AGREES 0.15 /* of the distance that is looked for */
#define STEPS  7

struct profile {
    const struct engine *engine;
    const struct states *states;
    const rotid_fit_result *fit;
    int p;
    double lower, upper, z, limit;
};

/* *far := f with the place held at z; INFINITY where there is no fit. */
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

/* The end on the side of `bound`, looked for from the fit's own, where that lies between. */
static int find_end(const struct profile *profile, double bound, double own, double *end)
{
    double limit = profile->limit, z = profile->z, range = profile->upper - profile->lower, inside = z, outside = bound, near = 0,
           far = NAN, one = 0; /* far: of the bound or what is outside, once it is known */
    int between = fabs(own - z) > HELD * range && (own - z) * (bound - z) > 0 && fabs(own - z) < fabs(bound - z);
    double at = between ? own : bound;
    for (int i = 0; i < STEPS && fabs(outside - inside) > NEAR * range; i++) {
        int status = look_at(profile, at, &one);
        if (status)
            return status;
        if (fabs(one - limit) <= AGREES * limit || (one <= limit && at == bound)) {
            *end = at;
            return ROTID_OK;
        }
        if (one <= limit) {
            inside = at;
            near = one;
        } else {
            outside = at;
            far = one;
        }
        double share = isinf(far) ? 0.5 : (limit - near) / (far - near);
        at = isnan(far) ? bound : inside + fmin(fmax(share, 0.1), 0.9) * (outside - inside);
    }
    *end = outside;
    return ROTID_OK;
}

int place_interval(const struct engine *engine, const struct states *states, rotid_fit_result *fit, int p)
{
    double lower = states->bounds[p].lower, upper = states->bounds[p].upper, end[2];
    const struct profile profile = {engine,
                                    states,
                                    fit,
                                    p,
                                    lower,
                                    upper,
                                    fmin(fmax(fit->x[p], lower), upper),
                                    sqrt(chi_square_limit(0.05, 1)) * fit->widened_by};
    int status = find_end(&profile, lower, fit->ci_lower[p], &end[0]);
    if (!status)
        status = find_end(&profile, upper, fit->ci_upper[p], &end[1]);
    if (status)
        return status;
    fit->ci_lower[p] = end[0];
    fit->ci_upper[p] = end[1];
    return ROTID_OK;
}
