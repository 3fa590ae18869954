/* The evidence of an explanation with a width w that is free. A narrow deep zone does what a wide shallow one does: the posterior
 * of width and size is a bent ridge, which no normal describes where the data hardly say how wide the zone is. Within a strip of
 * the width, ln w between two of its values, the ridge is nearly straight:
 *
 *   Z = 1/STRIPS sum over strips of Z(w within the strip),   each by laplace.c
 *
 * about a fit with w held in the strip: where the best w is, or as near to that as INSIDE of the strip lets it be, since a fit
 * at the edge of a strip knows the ridge on one side alone. The prior of w is uniform in ln w, so the strips are alike. They are
 * taken from that of the best w outwards until one adds nothing. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#define STRIPS  6
#define INSIDE  0.25 /* of a strip, from its edges */
#define NOTHING 6.0  /* in ln Z below the best strip */
#define HELD    1e-3 /* relative range of a width that is held */

struct sum { /* of one width */
    double log_z, log_stated, log_exact;
    double *mean, *square; /* [nown] of the deck's unknowns, weighed so far */
};

/* Unknown p of all is a width with a range in ln. */
static int is_width(const struct states *states, int p)
{
    int found = 0;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        for (int q = 0; q < job->unknowns.nparameter; q++)
            if (state_unknown(&states->state[s], q) == p && job->unknowns.parameter[q].kind == PARAMETER_EFFECT)
                found |= catalogue_of(&job->rotor.effect[job->unknowns.parameter[q].index])->width ==
                         job->unknowns.parameter[q].component;
    }
    return found && states->bounds[p].lower > 0;
}

static void add(const struct evidence *one, int nown, struct sum *sum)
{
    double before = sum->log_z;
    sum->log_z = log_sum(before, one->log_z);
    sum->log_stated = log_sum(sum->log_stated, one->log_stated);
    sum->log_exact = log_sum(sum->log_exact, one->log_exact);
    double share = isfinite(one->log_z) ? exp(one->log_z - sum->log_z) : 0;
    for (int q = 0; q < nown; q++) {
        sum->mean[q] += share * (one->mean[q] - sum->mean[q]);
        sum->square[q] += share * (one->mean[q] * one->mean[q] + one->std[q] * one->std[q] - sum->square[q]);
    }
}

/* Adds strip i of unknown p, fitted from x [nparameter], which becomes its best point; *log_z: its part. */
static int add_strip(struct pool *pool, const struct evidence_data *data, const struct strip_case *c, int p, int i, double *x,
                     struct evidence *one, struct sum *sum, double *log_z)
{
    struct states states;
    rotid_fit_result *fit = NULL;
    double lower = c->states->bounds[p].lower, upper = c->states->bounds[p].upper, step = log(upper / lower) / STRIPS;
    int status = states_started_at(pool, c->states, x, &states);
    if (status)
        return status;
    double share = log(c->fit->x[p] / lower) / step - i, held = lower * exp((i + fmin(fmax(share, INSIDE), 1 - INSIDE)) * step);
    states.bounds[p].start = held;
    states.bounds[p].lower = held * (1 - HELD);
    states.bounds[p].upper = held * (1 + HELD);
    states_share_bounds(&states, p);
    *log_z = -INFINITY;
    status = refit_states(pool, &states, c->number, c->holdout, c->environment, &fit);
    if (status)
        return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
    states.bounds[p].lower = lower * exp(i * step);
    states.bounds[p].upper = lower * exp((i + 1) * step);
    status = evidence_of_fit(data, &states, c->nown, fit, c->nmember, c->member, c->nfault, c->fault, NULL, one);
    if (!status) {
        *log_z = one->log_z;
        add(one, c->nown, sum);
        for (int q = 0; q < states.nparameter; q++)
            x[q] = fit->x[q];
    }
    rotid_fit_free(fit);
    return status;
}

/* Adds to *out what the strips of unknown p make of the evidence `fitted`. x [nparameter], room [4 nown] */
static int over_width(struct pool *pool, const struct evidence_data *data, const struct strip_case *c,
                      const struct evidence *fitted, int p, double *x, double *room, struct evidence *out)
{
    struct evidence one = {.mean = room, .std = room + c->nown};
    struct sum sum = {-INFINITY, -INFINITY, -INFINITY, room + 2 * (ptrdiff_t)c->nown, room + 3 * (ptrdiff_t)c->nown};
    double lower = c->states->bounds[p].lower, upper = c->states->bounds[p].upper, best = -INFINITY, z = -INFINITY;
    int first = (int)fmin(fmax(STRIPS * log(c->fit->x[p] / lower) / log(upper / lower), 0), STRIPS - 1), status = ROTID_OK;
    for (int q = 0; q < 2 * c->nown; q++)
        sum.mean[q] = 0;
    for (int side = -1; side < 2; side += 2) {
        memcpy(x, c->fit->x, (size_t)c->states->nparameter * sizeof *x);
        for (int i = side < 0 ? first : first + 1; i >= 0 && i < STRIPS && !status; i += side) {
            status = add_strip(pool, data, c, p, i, x, &one, &sum, &z);
            best = fmax(best, z);
            if (z < best - NOTHING)
                break;
        }
    }
    if (status || !isfinite(sum.log_z))
        return status;
    out->log_z += sum.log_z - log(STRIPS) - fitted->log_z;
    out->log_stated += sum.log_stated - log(STRIPS) - fitted->log_stated;
    out->log_exact += sum.log_exact - log(STRIPS) - fitted->log_exact;
    for (int q = 0; q < c->nown; q++) {
        out->mean[q] = sum.mean[q];
        out->std[q] = sqrt(fmax(0, sum.square[q] - sum.mean[q] * sum.mean[q]));
    }
    return ROTID_OK;
}

int evidence_over_widths(struct pool *pool, const struct evidence_data *data, const struct strip_case *c, struct evidence *out)
{
    int n = c->states->nparameter, nown = c->nown;
    double *x = POOL_ARRAY(pool, double, n), *room = POOL_ARRAY(pool, double, 6 * (size_t)nown + 1);
    if (!x || !room)
        return ROTID_ERROR_MEMORY;
    struct evidence fitted = {.mean = room + 4 * (ptrdiff_t)nown, .std = room + 5 * (ptrdiff_t)nown};
    int status = evidence_of_fit(data, c->states, nown, c->fit, c->nmember, c->member, c->nfault, c->fault, NULL, &fitted);
    for (int p = 0; p < n && !status; p++)
        if (is_width(c->states, p))
            status = over_width(pool, data, c, &fitted, p, x, room, out);
    return status;
}
