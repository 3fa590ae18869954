#include "run/run.h"

#define POINTS   17 /* four a decade */
#define LOWEST   1e-6
#define HIGHEST  1e-2
#define ROUNDING 1e-20 /* an f below that says nothing: eigenvalues are known to 1e-12 */

struct search {
    struct functional functional;
    rotid_measured measured;
    const double *x0;
    double *x, *r;
    double *shape, *direction; /* [nmaster * modes] at x0, and Y: of the same length */
};

/* The modes of the model at x0 as the measured ones. */
static int make_data(struct pool *pool, const rotid_model *model, int reduction, int modes, struct search *s)
{
    struct prediction p;
    int nmaster = model->nmaster, *number = POOL_ARRAY(pool, int, modes);
    double *hz = POOL_ARRAY(pool, double, modes);
    s->shape = POOL_ARRAY(pool, double, (size_t)nmaster *(size_t)modes);
    int status = number && hz && s->shape ? prediction_new(pool, model, reduction, ROTID_NELSON, model->nrigid + modes, 0, &p)
                                          : ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_compute(&p, s->x0);
    for (int k = 0; k < modes && !status; k++) {
        number[k] = k + 1;
        hz[k] = prediction_hz(&p, model->nrigid + k);
        for (int i = 0; i < nmaster; i++)
            s->shape[i + (ptrdiff_t)k * nmaster] = prediction_at_sensor(&p, model->nrigid + k, i);
    }
    s->measured = (rotid_measured){.nmode = modes, .number = number, .frequency_hz = hz, .shape = s->shape};
    return status;
}

/* Y_k of (18) for every mode: as long as the shape */
static void draw_direction(int nmaster, int modes, unsigned long seed, struct search *s)
{
    struct random_stream stream = {seed};
    for (int k = 0; k < modes; k++) {
        double *shape = s->shape + (ptrdiff_t)k * nmaster, *y = s->direction + (ptrdiff_t)k * nmaster, own = 0, square = 0;
        for (int i = 0; i < nmaster; i++) {
            y[i] = random_normal(&stream);
            square += y[i] * y[i];
            own += shape[i] * shape[i];
        }
        for (int i = 0; i < nmaster; i++)
            y[i] *= sqrt(own / square);
    }
}

static int prepare(struct pool *pool, const struct job *job, const rotid_model *model, int modes, unsigned long seed,
                   struct search *s)
{
    int status = make_data(pool, model, job->options.fit.reduction, modes, s);
    if (!status)
        status =
            functional_new(pool, ROTID_HYBRID, job->options.fit.reduction, ROTID_NELSON, model, &s->measured, &s->functional);
    s->direction = POOL_ARRAY(pool, double, (size_t)model->nmaster *(size_t)modes);
    s->x = POOL_ARRAY(pool, double, model->nparam);
    s->r = POOL_ARRAY(pool, double, modes);
    if (!status && (!s->direction || !s->x || !s->r))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        draw_direction(model->nmaster, modes, seed, s);
    return status;
}

/* f(E) and f(F) at x0 (1 + eps) with the measured shapes moved by `moved` times Y */
static void evaluate(struct search *s, double eps, double moved, double f[GROWTH_KINDS])
{
    struct functional *functional = &s->functional;
    int n = functional->prediction.model->nparam, modes = s->measured.nmode;
    ptrdiff_t components = (ptrdiff_t)functional->prediction.model->nmaster * modes;
    for (int p = 0; p < n; p++)
        s->x[p] = s->x0[p] * (1 + eps);
    for (ptrdiff_t i = 0; i < components; i++)
        functional->shape[i] = s->shape[i] + moved * s->direction[i];
    int status = functional_residual(functional, s->x, s->r);
    for (int kind = 0; kind < GROWTH_KINDS; kind++) {
        functional->kind = kind == GROWTH_E ? ROTID_HYBRID : ROTID_HYBRID_F; /* both are of the quotient just formed */
        f[kind] = status ? NAN : 0;
        for (int k = 0; k < modes && !status; k++) {
            double residual = functional_frequency_residual(functional, k);
            f[kind] += residual * residual / 2;
        }
    }
    functional->kind = ROTID_HYBRID;
}

/* The line through ln f over ln x. */
static void fit_line(int count, const double *x, const double *f, double *slope, double *intercept)
{
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    *slope = *intercept = NAN;
    for (int i = 0; i < count; i++) {
        if (!(f[i] > ROUNDING))
            return;
        double lx = log(x[i]), ly = log(f[i]);
        n += 1;
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    *slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    *intercept = (sy - *slope * sx) / n;
}

int growth_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0, int modes,
               unsigned long seed, struct growth *out)
{
    int failed;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct search search = {.x0 = x0};
    *out = (struct growth){.nepsilon_squared = POINTS, .hybrid.nepsilon_squared = POINTS, .hybrid_f.nepsilon_squared = POINTS};
    struct growth_line *line[GROWTH_KINDS] = {[GROWTH_E] = &out->hybrid, [GROWTH_F] = &out->hybrid_f};
    double **arrays[] = {&out->epsilon_squared, &out->hybrid.objective, &out->hybrid_f.objective, &out->shapes_alone};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = POOL_ARRAY(pool, double, POINTS);
    int status =
        pool->out_of_memory ? ROTID_ERROR_MEMORY : model_open(pool, job->models, &job->rotor, n, parameter, 1, model, &failed);
    if (!status)
        status = prepare(pool, job, &model->equations, modes, seed, &search);
    for (int i = 0; i < POINTS && !status; i++) {
        double f[GROWTH_KINDS], eps;
        out->epsilon_squared[i] = LOWEST * pow(HIGHEST / LOWEST, (double)i / (POINTS - 1));
        eps = sqrt(out->epsilon_squared[i]);
        evaluate(&search, 0, eps, f);
        out->shapes_alone[i] = f[GROWTH_E];
        evaluate(&search, eps, eps, f);
        for (int kind = 0; kind < GROWTH_KINDS; kind++)
            line[kind]->objective[i] = f[kind];
    }
    for (int kind = 0; kind < GROWTH_KINDS && !status; kind++)
        fit_line(POINTS, out->epsilon_squared, line[kind]->objective, &line[kind]->slope, &line[kind]->intercept);
    return status;
}

int elastic_rates(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                  const struct parameter *parameter, int reduction, const double *x, int count, struct prediction *p)
{
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    int failed, status = model ? model_open(pool, models, rotor, nparameter, parameter, 1, model, &failed) : ROTID_ERROR_MEMORY;
    int nrigid = status ? 0 : model->equations.nrigid, *wanted = POOL_ARRAY(pool, int, nrigid + count);
    if (!status)
        status =
            wanted ? prediction_new(pool, &model->equations, reduction, ROTID_NELSON, nrigid + count, 0, p) : ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_compute(p, x);
    for (int k = 0; k < count && !status; k++)
        wanted[nrigid + k] = 1;
    return status ? status : prediction_differentiate(p, x, wanted, 0);
}

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
    int m = options->modes, status = allocate(pool, n, named, x0, options, out);
    struct prediction p;
    double *x = POOL_ARRAY(pool, double, n), *lambda = POOL_ARRAY(pool, double, m);
    if (!status)
        status = x && lambda ? elastic_rates(pool, job->models, &job->rotor, n, parameter, job->options.fit.reduction, x0, m, &p)
                             : ROTID_ERROR_MEMORY;
    int nrigid = status ? 0 : p.count - m;
    for (int k = 0; k < m && !status; k++) {
        lambda[k] = p.lambda[nrigid + k];
        out->frequency_hz[k] = prediction_hz(&p, nrigid + k);
    }
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
