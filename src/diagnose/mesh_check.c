#include "diagnose/mesh_check.h"

#include "diagnose/columns.h"

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Takes the part along the directions [n * count] out of v. */
static void project(int n, int count, const double *direction, double *v)
{
    for (int q = 0; q < count; q++) {
        const double *d = direction + (ptrdiff_t)q * n;
        double along = dot(n, d, v) / dot(n, d, d);
        for (int i = 0; i < n; i++)
            v[i] -= along * d[i];
    }
}

static int failed(int status)
{
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* the modes are others there: nothing is known */
}

int mesh_worth(const struct engine *engine, const struct job *finer, double *worth)
{
    struct pool *pool = engine->pool;
    struct columns here, there;
    int parameters = engine->job->unknowns.nparameter, count = 0;
    *worth = 0;
    int status = columns_open(pool, engine->job, engine->number, engine->holdout, NULL, engine->fit->x, &here);
    if (!status)
        status = columns_prepare(&here);
    if (!status)
        status = columns_open(pool, finer, engine->number, engine->holdout, NULL, engine->fit->x, &there);
    if (status)
        return failed(status);
    int n = here.nrow;
    double *direction = POOL_ARRAY(pool, double, (size_t)n *(size_t)(parameters + 1)), *change = POOL_ARRAY(pool, double, n);
    if (!direction || !change)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < parameters; p++) {
        double *column = direction + (ptrdiff_t)count * n;
        if ((status = columns_parameter(&here, p, column)))
            return failed(status);
        double before = dot(n, column, column);
        project(n, count, direction, column);
        count += dot(n, column, column) > 1e-12 * before;
    }
    for (int i = 0; i < n; i++)
        change[i] = there.r[i] - here.r[i];
    project(n, count, direction, change);
    *worth = dot(n, change, change);
    return ROTID_OK;
}
