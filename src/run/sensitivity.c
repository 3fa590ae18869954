#include "run/sensitivity.h"

#include <math.h>
#include <string.h>

#include "modal/prediction.h"
#include "model/model.h"

/* E_k = 1 - lambda_k(x)/lambda_k(x0) of mode k; R*_k is lambda~_k for every shape (docs/errata.md) */
static double residual(const struct prediction *p, int nrigid, const double *reference, int k)
{
    return 1 - p->lambda[nrigid + k] / reference[k];
}

static int allocate(struct pool *pool, int n, int m, int points, struct sensitivity *out)
{
    size_t square = (size_t)m * (size_t)n;
    *out = (struct sensitivity){.n = n, .m = m, .points = points};
    out->reference = POOL_ARRAY(pool, double, n);
    out->hz = POOL_ARRAY(pool, double, m);
    out->difference = POOL_ARRAY(pool, double, square);
    out->derivative = POOL_ARRAY(pool, double, square);
    out->relative = POOL_ARRAY(pool, double, points);
    out->curve = POOL_ARRAY(pool, double, square *(size_t)points);
    return out->reference && out->hz && out->difference && out->derivative && out->relative && out->curve ? ROTID_OK
                                                                                                          : ROTID_ERROR_MEMORY;
}

int sensitivity_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0,
                    const struct sensitivity_options *options, struct sensitivity *out)
{
    int m = options->modes, failed;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct prediction p;
    int status = model ? allocate(pool, n, m, options->points, out) : ROTID_ERROR_MEMORY;
    if (!status)
        status = model_open(pool, job->models, &job->rotor, n, parameter, 1, model, &failed);
    if (status)
        return status;
    int nrigid = model->equations.nrigid;
    status = prediction_new(pool, &model->equations, job->fit.reduction, ROTID_NELSON, nrigid + m, 0, &p);
    double *x = POOL_ARRAY(pool, double, n), *lambda = POOL_ARRAY(pool, double, m);
    int *wanted = POOL_ARRAY(pool, int, nrigid + m);
    if (!status && (!x || !lambda || !wanted))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_compute(&p, x0);
    for (int k = 0; k < m && !status; k++) {
        wanted[nrigid + k] = 1;
        lambda[k] = p.lambda[nrigid + k];
        out->hz[k] = prediction_hz(&p, nrigid + k);
    }
    if (!status)
        status = prediction_differentiate(&p, x0, wanted, 0);
    for (int q = 0; q < n && !status; q++) {
        out->reference[q] = x0[q];
        for (int k = 0; k < m; k++)
            out->derivative[k + (ptrdiff_t)q * m] = -p.dlambda[nrigid + k + (ptrdiff_t)q * p.count] * x0[q] / lambda[k];
    }
    for (int q = 0; q < n && !status; q++) {
        memcpy(x, x0, (size_t)n * sizeof *x);
        x[q] = x0[q] * (1 + options->step);
        status = prediction_compute(&p, x);
        for (int k = 0; k < m && !status; k++)
            out->difference[k + (ptrdiff_t)q * m] = residual(&p, nrigid, lambda, k) / options->step;
        for (int i = 0; i < options->points && !status; i++) {
            out->relative[i] =
                1 - options->range + (options->points > 1 ? 2 * options->range * i / (options->points - 1) : options->range);
            x[q] = x0[q] * out->relative[i];
            int failed_here = prediction_compute(&p, x);
            for (int k = 0; k < m; k++) {
                double e = failed_here ? NAN : residual(&p, nrigid, lambda, k);
                out->curve[k + (ptrdiff_t)m * (i + (ptrdiff_t)options->points * q)] = e * e / 2;
            }
        }
    }
    if (!status && options->with_growth)
        status = growth_run(pool, job, n, parameter, x0, m, options->seed, &out->growth);
    return status;
}
