#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define LEAST_DOF   3
#define FALSE_ALARM 0.005  /* one-sided: that of the other faults of the measurement chain */
#define LEFT_OUT    0.05   /* the same with a point left out */
#define POWER       1.2816 /* standard normal deviate of 90 % */
#define TWO_POINTS                                                                                                               \
    1.6449 /* of 95 %: a free beam has two points that decide, its ends, and the mass has to pass without either                 \
            */
#define LARGEST          0.5 /* of m s and m q: beyond, the formula has no meaning */
#define ITERATIONS       20
#define SHIFT_ITERATIONS 8   /* of a contraction by m q, a tenth at most in a test worth its name */
#define BEATEN           2.0 /* thresholds, where a drift explains more */

enum { MASS, DRIFT };

struct work {
    const struct roving_data *data;
    double *log_hz, *std; /* [npoint * nmode] relative */
    double *linear;       /* ln f with the mass taken as linear about its present value */
    double *column[2];
    char *use, *kept; /* kept: a copy, while a point is left out */
    double *mean;
    double most; /* kg, of either sign */
};

static ptrdiff_t count_of(const struct work *w)
{
    return (ptrdiff_t)w->data->nmode * w->data->npoint;
}

static int open_work(struct pool *pool, const struct roving_data *data, struct work *w)
{
    size_t count = (size_t)data->nmode * (size_t)data->npoint;
    *w = (struct work){.data = data};
    double **arrays[] = {&w->log_hz, &w->std, &w->linear, &w->column[MASS], &w->column[DRIFT]};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = POOL_ARRAY(pool, double, count);
    w->use = POOL_ARRAY(pool, char, count);
    w->kept = POOL_ARRAY(pool, char, count);
    w->mean = POOL_ARRAY(pool, double, 4 * (size_t)data->nmode);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    double largest = 0;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)count; i++) {
        w->use[i] = data->hz[i] > 0 && data->std[i] > 0 && isfinite(data->hz[i]) && isfinite(data->std[i]);
        w->log_hz[i] = w->use[i] ? log(data->hz[i]) : 0;
        w->std[i] = w->use[i] ? data->std[i] / data->hz[i] : 1;
        w->column[DRIFT][i] = data->order[i % data->npoint];
        largest = fmax(largest, fmax(data->square[i], fabs(data->others[i])));
    }
    w->most = largest > 0 ? LARGEST / largest : 0;
    return ROTID_OK;
}

static struct point_readings readings_of(const struct work *w, const double *y, int ncolumn, int first)
{
    return (struct point_readings){.nmode = w->data->nmode,
                                   .npoint = w->data->npoint,
                                   .ncolumn = ncolumn,
                                   .y = y,
                                   .std = w->std,
                                   .column = {w->column[first], w->column[DRIFT]},
                                   .use = w->use,
                                   .mean = w->mean};
}

double moving_mass_shift(double mass, double square, double others, double bend)
{
    double x = mass * square / (1 + mass * (square - others));
    for (int i = 0; i < SHIFT_ITERATIONS; i++) {
        double free = 1 - (1 - x) * mass * (others - x * bend);
        x = mass * square / (free + mass * square);
    }
    return x;
}

/* With lambda' = lambda (1 - x) the pole of the loaded receptance R_je/(1 - lambda' m R_jj), its residue is
 * R_je/(m d(lambda R_jj)/d lambda) there; y = x/(m s) is finite at a node. */
double moving_mass_residue(double mass, double square, double others, double bend, double across, double across_bend,
                           double share)
{
    double x = moving_mass_shift(mass, square, others, bend), q = others - x * bend, y = (1 - x) / (1 - (1 - x) * mass * q);
    double above = y * (1 + y * mass * (across - x * across_bend) * share);
    return above / (y * mass * (square + x * q) + (1 - x) * (1 + y * y * mass * mass * square * bend));
}

/* Column and right-hand side about a mass: ln f = ln f_k + g(m), g = ln(1 - x)/2, its slope by central differences. */
static void linearise(struct work *w, double mass)
{
    const struct roving_data *data = w->data;
    double step = 1e-4 * w->most;
    for (ptrdiff_t i = 0; i < count_of(w); i++) {
        double s = data->square[i], q = data->others[i], c = data->bend ? data->bend[i] : 0;
        double above = log1p(-moving_mass_shift(mass + step, s, q, c)), below = log1p(-moving_mass_shift(mass - step, s, q, c));
        w->column[MASS][i] = (above - below) / (4 * step);
        w->linear[i] = w->log_hz[i] - 0.5 * log1p(-moving_mass_shift(mass, s, q, c)) + mass * w->column[MASS][i];
    }
}

/* Mass and drift together; 1 where they cannot be told apart. *fit is left at the last linearisation. */
static int solve(struct work *w, double *mass, struct point_fit *fit)
{
    for (int i = 0; i < ITERATIONS; i++) {
        double before = *mass;
        linearise(w, before);
        const struct point_readings r = readings_of(w, w->linear, 2, MASS);
        if (point_fit(&r, fit))
            return 1;
        *mass = fmin(fmax(fit->slope[MASS], -w->most), w->most);
        if (fabs(*mass - before) <= 1e-9 * w->most)
            break;
    }
    return 0;
}

/* The least favourable estimate with one point left out: the smallest mass over its deviation, and the largest deviation. */
static void leave_out_points(struct work *w, double *z, double *std)
{
    int npoint = w->data->npoint;
    const struct point_readings r = readings_of(w, w->linear, 2, MASS);
    for (ptrdiff_t i = 0; i < count_of(w); i++)
        w->kept[i] = w->use[i];
    *z = INFINITY;
    *std = 0;
    for (int j = 0; j < npoint; j++) {
        struct point_fit fit;
        int any = 0;
        for (ptrdiff_t i = j; i < count_of(w); i += npoint) {
            any |= w->use[i];
            w->use[i] = 0;
        }
        double deviation = INFINITY;
        if (any && !point_fit(&r, &fit) && fit.dof > 0)
            deviation = fit.scale * sqrt(fit.variance[MASS]);
        if (any) {
            *z = fmin(*z, isfinite(deviation) ? fit.slope[MASS] / deviation : 0);
            *std = fmax(*std, deviation);
        }
        for (ptrdiff_t i = j; i < count_of(w); i += npoint)
            w->use[i] = w->kept[i];
    }
}

static double chi2_with(const struct work *w, const double *y, int ncolumn, int first)
{
    struct point_fit fit;
    const struct point_readings r = readings_of(w, y, ncolumn, first);
    (void)point_fit(&r, &fit); /* a column that says nothing leaves the chi2 of none */
    return fit.chi2;
}

/* Behind solve(): the means of the fit give ln f_k; the drift is zero in the middle. */
static int spread(struct pool *pool, const struct work *w, const struct point_fit *fit, struct roving_accelerometer *out)
{
    const struct roving_data *data = w->data;
    out->spread_hz = POOL_ARRAY(pool, double, data->nmode);
    if (!out->spread_hz)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < data->nmode; k++) {
        const double *mean = w->mean + 4 * (ptrdiff_t)k; /* weight, linear, columns */
        double square = 0;
        for (int j = 0; j < data->npoint; j++)
            square += data->square[j + (ptrdiff_t)k * data->npoint] / data->npoint;
        double log_hz = mean[1] - fit->slope[MASS] * mean[2] - fit->slope[DRIFT] * mean[3];
        out->spread_hz[k] = mean[0] > 0 ? exp(log_hz) / sqrt(1 + fit->slope[MASS] * square) : NAN;
    }
    return ROTID_OK;
}

int weigh_roving_accelerometer(struct pool *pool, const struct roving_data *data, struct roving_accelerometer *out)
{
    struct work w;
    struct point_fit fit;
    double mass = 0, z_left_out, std_left_out;
    *out = (struct roving_accelerometer){0};
    int status = open_work(pool, data, &w);
    if (status)
        return status;
    if (solve(&w, &mass, &fit) || fit.dof < LEAST_DOF)
        return ROTID_OK;
    const struct point_readings r = readings_of(&w, w.linear, 2, MASS);
    int dropped = point_drop_outliers(&r);
    if (dropped && (solve(&w, &mass, &fit) || fit.dof < LEAST_DOF))
        return ROTID_OK;
    status = spread(pool, &w, &fit, out);
    if (status)
        return status;
    double *spread_hz = out->spread_hz;
    leave_out_points(&w, &z_left_out, &std_left_out);
    double std = fit.scale * sqrt(fit.variance[MASS]), drift_std = fit.scale * sqrt(fit.variance[DRIFT]),
           by_mass = chi2_with(&w, w.linear, 1, MASS), by_drift = chi2_with(&w, w.log_hz, 1, DRIFT),
           threshold = quantile_student(2 * FALSE_ALARM, fit.dof), left_out = quantile_student(2 * LEFT_OUT, fit.dof);
    *out = (struct roving_accelerometer){.usable = 1,
                                         .readings = fit.readings,
                                         .dropped = dropped,
                                         .dof = fit.dof,
                                         .mass = fit.slope[MASS],
                                         .std = std,
                                         .scale = fit.scale,
                                         .chi2_drop = by_drift - fit.chi2,
                                         .z = fit.slope[MASS] / std,
                                         .drift = fit.slope[DRIFT],
                                         .drift_std = drift_std,
                                         .spread_hz = spread_hz};
    out->threshold = by_drift < by_mass ? BEATEN * threshold : threshold;
    out->found = out->z > out->threshold && z_left_out > left_out && out->mass >= data->least_mass;
    out->drifts = fabs(out->drift) > quantile_student(FALSE_ALARM, fit.dof) * drift_std;
    out->smallest = fmax(data->least_mass, fmax((threshold + POWER) * std, (left_out + TWO_POINTS) * std_left_out));
    return ROTID_OK;
}
