#include "suggest/pair_design.h"

#include <math.h>
#include <string.h>

#include "diagnose/columns.h"
#include "suggest/planned.h"

#define MOST_OF_SET 3 /* rivals, of which all pairs are taken */

static const struct effect_kind nothing = {.id = "none"};

static int one_pair(struct pool *pool, const struct rivals *rivals, const struct rival *a, const struct rival *b,
                    const struct places *places, double frequency_std, double shape_std, struct design *d)
{
    struct effect none = {.kind = &nothing};
    struct columns *c = POOL_NEW(pool, struct columns);
    const struct planned plan = {rivals->nmode, rivals->number, frequency_std, shape_std};
    struct job source, job;
    int n = b->fit->n, used = 0, q = 0;
    for (int p = 0; p < n; p++)
        used += rival_uses(b, p);
    int status = c ? planned_sensors(pool, &a->job, places->n, places->z, &source) : ROTID_ERROR_MEMORY;
    if (!status)
        status = planned_measure(pool, &source, a->x, &plan, &source);
    if (!status)
        status = planned_sensors(pool, &b->job, places->n, places->z, &job);
    if (status)
        return status;
    job.measurement = source.measurement;
    status = columns_open(pool, &job, job.measurement.number, job.measurement.holdout, &none, b->x, c);
    if (!status)
        status = columns_prepare(c);
    if (!status)
        status = design_new(pool, rivals->nmode, places->n, used, 1, d);
    if (status)
        return status;
    d->targets_alone = 1;
    rival_gram(b, NULL, used, d->prior);
    for (int p = 0; p < n && !status; p++) {
        double *column = d->column + (ptrdiff_t)q * c->nrow;
        if (!rival_uses(b, p))
            continue;
        int own = rival_own(b, p);
        if (own >= 0)
            status = columns_parameter(c, own, column);
        for (int i = 0; i < c->nrow && own >= 0; i++)
            column[i] *= b->x[own];
        d->prior[q + (ptrdiff_t)q * used] *= 1 + 1e-9; /* a direction that the data leave open */
        q++;
    }
    memcpy(d->column + (ptrdiff_t)used * c->nrow, c->r, (size_t)c->nrow * sizeof *c->r);
    for (int k = 0; k < d->nmode && !status; k++)
        for (int i = 0; i < d->nplace; i++) {
            ptrdiff_t cell = i + (ptrdiff_t)k * d->nplace;
            d->scale[cell] = c->mode[k].weighted[i];
            d->largest[cell] = fabs(job.measurement.shape[cell]);
        }
    return status;
}

int pair_designs(struct pool *pool, const struct rivals *rivals, const struct places *places, double frequency_std,
                 double shape_std, int *ndesign, struct design **design)
{
    int set = rivals->n - 1, most = set > MOST_OF_SET ? MOST_OF_SET : set;
    *ndesign = 0;
    *design = POOL_ARRAY(pool, struct design, (size_t)(most + 1) * (size_t)(most + 1));
    if (!*design)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a < most; a++)
        for (int b = 0; b < (set > 1 ? most : 2); b++) {
            if (a == b)
                continue;
            int status = one_pair(pool, rivals, &rivals->rival[a], &rivals->rival[b], places, frequency_std, shape_std,
                                  *design + *ndesign);
            if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
                return status;
            *ndesign += !status;
        }
    return ROTID_OK;
}
