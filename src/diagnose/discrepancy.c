#include "diagnose/diagnose.h"

static int change(struct pool *pool, ptrdiff_t n, double discrepancy, double **std)
{
    double *changed = POOL_ARRAY(pool, double, n);
    if (!changed)
        return ROTID_ERROR_MEMORY;
    for (ptrdiff_t i = 0; i < n; i++)
        changed[i] = hypot((*std)[i], discrepancy); /* NaN where nothing is measured */
    *std = changed;
    return ROTID_OK;
}

int discrepancy_add(struct pool *pool, const struct candidate *c, struct states *states)
{
    int approximate = c->cause->discrepancy_frequency > 0 || c->cause->discrepancy_shape > 0, status = ROTID_OK;
    for (int s = 0; s < states->nstate && approximate && !status; s++) {
        struct job *job = &states->state[s].job;
        struct job_measurement *m = &job->measurement;
        if (!c->in[s])
            continue;
        status = change(pool, m->nmode, c->cause->discrepancy_frequency, &m->frequency_std);
        if (!status && m->shape && c->cause->discrepancy_shape > 0)
            status = change(pool, (ptrdiff_t)job->rotor.nsensor * m->nmode, c->cause->discrepancy_shape, &m->shape_std);
    }
    return status;
}
