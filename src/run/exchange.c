/* The two ends of a rotor: frequencies of a symmetric one are those of its mirror image, so they determine two bearings, but not
 * which of them is the stiffer one. Found without geometry: a fit that starts from two values exchanged and ends as low there. */
#include "run/run.h"

#include <math.h>
#include <string.h>

#include "fit/fit.h"

#define MOST    6   /* pairs that are tried */
#define APART   3   /* standard deviations between two values that are worth a word */
#define AS_WELL 1   /* of chi2, as the noise is seen by the residuals */
#define ALIKE   1.1 /* of the objective where the noise is not known */

/* Of one kind, and in the same states: "a.k" and "b.k", "held:a.k" and "held:b.k". */
static int are_alike(const rotid_parameter *a, const rotid_parameter *b)
{
    const char *of_a = strrchr(a->name, '.'), *of_b = strrchr(b->name, '.'), *end_a = strchr(a->name, ':'),
               *end_b = strchr(b->name, ':');
    size_t in_a = end_a ? (size_t)(end_a - a->name) : 0, in_b = end_b ? (size_t)(end_b - b->name) : 0;
    return of_a && of_b && !strcmp(of_a, of_b) && in_a == in_b && !strncmp(a->name, b->name, in_a);
}

static int fits_as_well(const rotid_fit_result *fit, const rotid_fit_result *other, int p, int q)
{
    if (fabs(other->x[p] - fit->x[q]) > fabs(other->x[p] - fit->x[p])) /* it went back */
        return 0;
    return isfinite(fit->chi2) && fit->dof > 0 ? 2 * (other->objective - fit->objective) < AS_WELL * fmax(1, fit->chi2 / fit->dof)
                                               : other->objective < ALIKE * fit->objective;
}

int exchange_warn(struct pool *pool, const struct states *states, const struct identification *found, const rotid_fit_result *fit,
                  const rotid_environment *environment, struct message_list *notes)
{
    int n = fit->n, tried = 0, *number, *holdout, status = identify_numbers(pool, states, found, &number, &holdout);
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
    struct states exchanged = *states;
    if (status || !bounds)
        return ROTID_ERROR_MEMORY;
    if (fit->status == ROTID_STOP_CANCELLED || states->state->job.options.solid || states->more || n != states->nparameter)
        return ROTID_OK;
    for (int s = 0; s < states->nstate; s++)
        if (found[s].shapes_fitted)
            return ROTID_OK;
    exchanged.bounds = bounds;
    for (int p = 0; p < n; p++)
        for (int q = p + 1; q < n; q++) {
            const rotid_parameter *a = &states->bounds[p], *b = &states->bounds[q];
            double x = fit->x[p], y = fit->x[q];
            if (!are_alike(a, b) || !(fabs(x - y) > APART * hypot(fit->std[p], fit->std[q])) || x <= b->lower || x >= b->upper ||
                y <= a->lower || y >= a->upper || tried++ >= MOST)
                continue;
            memcpy(bounds, states->bounds, (size_t)n * sizeof *bounds);
            for (int i = 0; i < n; i++)
                if (fit->x[i] > bounds[i].lower && fit->x[i] < bounds[i].upper)
                    bounds[i].start = i == p ? y : i == q ? x : fit->x[i];
            rotid_fit_result *other;
            status = identify_fit_states(pool, &exchanged, number, holdout, &states->state->job.options.fit, environment, &other);
            if (!status && fits_as_well(fit, other, p, q))
                message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                            "%s and %s fit as well if they are exchanged: frequencies alone do not tell the ends of a symmetric "
                            "rotor apart; shapes do, or a known mass near one end (*STATE)",
                            a->name, b->name);
            rotid_fit_free(other);
            if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED) /* the fit is a result all the same */
                return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
        }
    return ROTID_OK;
}
