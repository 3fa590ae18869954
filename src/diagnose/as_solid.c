#include "diagnose/as_solid.h"

#include <math.h>

#include "diagnose/causes/catalogue.h"
#include "linalg/product.h"

int job_as_solid(struct pool *pool, const struct job *from, struct job *to)
{
    const struct job copy = *from, *job = &copy; /* `to` may be the same */
    *to = *job;
    to->options.solid = 1;
    to->models = models_solids(job->models);
    to->unknowns.nsuspect = 0;
    to->unknowns.suspect = POOL_ARRAY(pool, struct suspect, job->unknowns.nsuspect);
    if (!to->models || !to->unknowns.suspect)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < job->unknowns.nsuspect; i++)
        if (!cause_of_beam(catalogue_of(&job->unknowns.suspect[i].effect)))
            to->unknowns.suspect[to->unknowns.nsuspect++] = job->unknowns.suspect[i];
    return ROTID_OK;
}

int scan_solid(struct pool *pool, const struct job *job, const int *number, const int *holdout, const double *x,
               struct scan *scan)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        struct scan_candidate *c = &scan->candidate[i];
        struct columns columns;
        struct job solid;
        if (!c->cause->solid)
            continue;
        int status = job_as_solid(pool, job, &solid);
        if (!status)
            status = columns_open(pool, &solid, number, holdout, NULL, x, &columns);
        if (status) /* the rotor can be no solid: nothing to propose */
            return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
        double left = product_dot(scan->nrow, columns.r, columns.r), before = product_dot(scan->nrow, scan->r, scan->r);
        for (int b = 0; b < scan->nbasis; b++) {
            double along = product_dot(scan->nrow, scan->basis + (ptrdiff_t)b * scan->nrow, columns.r);
            left -= along * along;
        }
        c->promise = fmax(0, before - left);
    }
    return ROTID_OK;
}
