#include "run/sensitivity.h"

#include <math.h>
#include <string.h>

#include "modal/prediction.h"
#include "model/model.h"
#include "run/job.h"

/* E_k = 1 - lambda_k(x)/lambda_k(x0) of mode k; R*_k is lambda~_k for every shape (docs/errata.md) */
static double residual(const struct prediction *p, int nrigid, const double *reference, int k)
{
    return 1 - p->lambda[nrigid + k] / reference[k];
}

static int allocate(struct pool *pool, int n, const rotid_parameter *named, const double *x0,
                    const struct sensitivity_options *options, struct sensitivity *out)
{
    int m = options->modes, points = options->points;
    *out = (struct sensitivity){.step = options->step, .nfrequency_hz = m, .nrelative_value = points, .nparameters = n};
    out->frequency_hz = POOL_ARRAY(pool, double, m);
    out->relative_value = POOL_ARRAY(pool, double, points);
    out->parameters = POOL_ARRAY(pool, struct sensitivity_parameter, n);
    for (int p = 0; p < n && out->parameters; p++) {
        struct sensitivity_parameter *one = &out->parameters[p];
        *one = (struct sensitivity_parameter){.name = named[p].name,
                                              .unit = named[p].unit,
                                              .reference = x0[p],
                                              .nfrequency_hz = m,
                                              .nrelative_value = points,
                                              .sensitivity = POOL_ARRAY(pool, double, m),
                                              .derivative = POOL_ARRAY(pool, double, m),
                                              .frequency_change = POOL_ARRAY(pool, double, m),
                                              .curves = POOL_ARRAY(pool, double, (size_t)m *(size_t)points)};
        if (!one->sensitivity || !one->derivative || !one->frequency_change || !one->curves)
            return ROTID_ERROR_MEMORY;
    }
    return out->frequency_hz && out->relative_value && out->parameters ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int sensitivity_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter,
                    const rotid_parameter *named, const double *x0, const struct sensitivity_options *options,
                    struct sensitivity *out)
{
    int m = options->modes, failed;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct prediction p;
    int status = model ? allocate(pool, n, named, x0, options, out) : ROTID_ERROR_MEMORY;
    if (!status)
        status = model_open(pool, job->models, &job->rotor, n, parameter, 1, model, &failed);
    if (status)
        return status;
    int nrigid = model->equations.nrigid;
    status = prediction_new(pool, &model->equations, job->options.fit.reduction, ROTID_NELSON, nrigid + m, 0, &p);
    double *x = POOL_ARRAY(pool, double, n), *lambda = POOL_ARRAY(pool, double, m);
    int *wanted = POOL_ARRAY(pool, int, nrigid + m);
    if (!status && (!x || !lambda || !wanted))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_compute(&p, x0);
    for (int k = 0; k < m && !status; k++) {
        wanted[nrigid + k] = 1;
        lambda[k] = p.lambda[nrigid + k];
        out->frequency_hz[k] = prediction_hz(&p, nrigid + k);
    }
    if (!status)
        status = prediction_differentiate(&p, x0, wanted, 0);
    for (int q = 0; q < n && !status; q++) {
        struct sensitivity_parameter *one = &out->parameters[q];
        for (int k = 0; k < m; k++) {
            one->derivative[k] = -p.dlambda[nrigid + k + (ptrdiff_t)q * p.count] * x0[q] / lambda[k];
            one->frequency_change[k] = -one->derivative[k] / 2; /* lambda = (2 pi f)^2 */
        }
    }
    for (int q = 0; q < n && !status; q++) {
        memcpy(x, x0, (size_t)n * sizeof *x);
        x[q] = x0[q] * (1 + options->step);
        status = prediction_compute(&p, x);
        for (int k = 0; k < m && !status; k++)
            out->parameters[q].sensitivity[k] = residual(&p, nrigid, lambda, k) / options->step;
        for (int i = 0; i < options->points && !status; i++) {
            out->relative_value[i] =
                1 - options->range + (options->points > 1 ? 2 * options->range * i / (options->points - 1) : options->range);
            x[q] = x0[q] * out->relative_value[i];
            int failed_here = prediction_compute(&p, x);
            for (int k = 0; k < m; k++) {
                double e = failed_here ? NAN : residual(&p, nrigid, lambda, k);
                out->parameters[q].curves[k + (ptrdiff_t)m * i] = e * e / 2;
            }
        }
    }
    out->reduction = reduction_words[job->options.fit.reduction];
    if (status || !options->with_growth)
        return status;
    out->functional_growth = POOL_NEW(pool, struct growth);
    return out->functional_growth ? growth_run(pool, job, n, parameter, x0, m, options->seed, out->functional_growth)
                                  : ROTID_ERROR_MEMORY;
}
