#include "fit/fit.h"
#include "run/run.h"

#define CONSTANT   1e-10  /* squared variation against the squared size: a column that rounding alone moves */
#define ALIKE      1e-8   /* sine squared between two columns */
#define CHANCE     0.01   /* of losing a good reading among all of them */
#define LEAST_DOF  3      /* for a scatter worth the name */
#define INEXACT    0.25   /* of the shift by the accelerometer: its second order, and the noise of the shape */
#define MEDIAN     1.4826 /* standard deviations of noise a median of its size */
#define LEAST_MEAN 5      /* readings for a regression on the shape: a line and LEAST_DOF */

/* Sum of weights and weighted means of every mode; the sums of squares of the columns as they stand. */
static int take_means(const struct point_readings *r, double *square)
{
    int modes = 0, stride = 2 + r->ncolumn;
    for (int i = 0; i < r->ncolumn; i++)
        square[i] = 0;
    for (int k = 0; k < r->nmode; k++) {
        double *mean = r->mean + (ptrdiff_t)k * stride;
        memset(mean, 0, (size_t)stride * sizeof *mean);
        for (int j = 0; j < r->npoint; j++) {
            ptrdiff_t at = j + (ptrdiff_t)k * r->npoint;
            if (!r->use[at])
                continue;
            double weight = 1 / (r->std[at] * r->std[at]);
            mean[0] += weight;
            mean[1] += weight * r->y[at];
            for (int i = 0; i < r->ncolumn; i++) {
                mean[2 + i] += weight * r->column[i][at];
                square[i] += weight * r->column[i][at] * r->column[i][at];
            }
        }
        for (int i = 1; i < stride && mean[0] > 0; i++)
            mean[i] /= mean[0];
        modes += mean[0] > 0;
    }
    return modes;
}

/* What is left of reading `at` of mode k and of its columns when the means are taken out. */
static double centred(const struct point_readings *r, int k, ptrdiff_t at, double *column)
{
    const double *mean = r->mean + (ptrdiff_t)k * (2 + r->ncolumn);
    for (int i = 0; i < r->ncolumn; i++)
        column[i] = r->column[i][at] - mean[2 + i];
    return r->y[at] - mean[1];
}

static double residual(const struct point_readings *r, const struct point_fit *fit, int k, ptrdiff_t at, double *column)
{
    double left = centred(r, k, at, column);
    for (int i = 0; i < r->ncolumn; i++)
        left -= fit->slope[i] * column[i];
    return left;
}

/* Inverts the normal matrix s [2 * 2], of which ncolumn rows are in use; 0, or 1 where it is singular. */
static int invert(int ncolumn, const double *square, const double *s, struct point_fit *fit)
{
    for (ptrdiff_t i = 0; i < ncolumn; i++)
        if (!(s[3 * i] > CONSTANT * square[i]))
            return 1;
    double determinant = ncolumn == 2 ? s[0] * s[3] - s[1] * s[1] : 0;
    if (ncolumn == 2 && !(determinant > ALIKE * s[0] * s[3]))
        return 1;
    if (ncolumn == 1)
        fit->variance[0] = 1 / s[0];
    if (ncolumn == 2) {
        fit->variance[0] = s[3] / determinant;
        fit->variance[1] = s[0] / determinant;
        fit->cross = -s[1] / determinant;
    }
    return 0;
}

int point_fit(const struct point_readings *r, struct point_fit *fit)
{
    double square[POINT_COLUMNS], s[POINT_COLUMNS * POINT_COLUMNS] = {0}, right[POINT_COLUMNS] = {0}, column[POINT_COLUMNS] = {0};
    *fit = (struct point_fit){.scale = 1};
    int modes = take_means(r, square);
    for (int k = 0; k < r->nmode; k++)
        for (int j = 0; j < r->npoint; j++) {
            ptrdiff_t at = j + (ptrdiff_t)k * r->npoint;
            if (!r->use[at])
                continue;
            double y = centred(r, k, at, column), weight = 1 / (r->std[at] * r->std[at]);
            fit->readings++;
            for (int i = 0; i < r->ncolumn; i++) {
                right[i] += weight * column[i] * y;
                for (int l = 0; l < r->ncolumn; l++)
                    s[i + POINT_COLUMNS * l] += weight * column[i] * column[l];
            }
        }
    int singular = invert(r->ncolumn, square, s, fit);
    if (!singular && r->ncolumn) {
        fit->slope[0] = fit->variance[0] * right[0] + fit->cross * right[1];
        fit->slope[1] = fit->cross * right[0] + fit->variance[1] * right[1];
    }
    fit->dof = fit->readings - modes - (singular ? 0 : r->ncolumn);
    for (int k = 0; k < r->nmode; k++)
        for (int j = 0; j < r->npoint; j++) {
            ptrdiff_t at = j + (ptrdiff_t)k * r->npoint;
            double left = r->use[at] ? residual(r, fit, k, at, column) / r->std[at] : 0;
            fit->chi2 += left * left;
        }
    if (fit->dof > 0 && fit->chi2 > fit->dof)
        fit->scale = sqrt(fit->chi2 / fit->dof);
    return singular;
}

/* The share of its own residual that a reading decides by itself, from 0 to 1. */
static double leverage(const struct point_readings *r, const struct point_fit *fit, int k, ptrdiff_t at, const double *column)
{
    double weight = 1 / (r->std[at] * r->std[at]), share = 1 / r->mean[(ptrdiff_t)k * (2 + r->ncolumn)];
    if (r->ncolumn)
        share += column[0] * column[0] * fit->variance[0];
    if (r->ncolumn == 2)
        share += column[1] * column[1] * fit->variance[1] + 2 * column[0] * column[1] * fit->cross;
    return weight * share;
}

/* The reading with the largest residual by what the others scatter, -1 where there is none; *size: that residual. */
static ptrdiff_t worst_reading(const struct point_readings *r, const struct point_fit *fit, double *size)
{
    ptrdiff_t worst = -1;
    *size = 0;
    for (int k = 0; k < r->nmode; k++)
        for (int j = 0; j < r->npoint; j++) {
            double column[POINT_COLUMNS];
            ptrdiff_t at = j + (ptrdiff_t)k * r->npoint;
            if (!r->use[at])
                continue;
            double left = residual(r, fit, k, at, column) / r->std[at], free = 1 - leverage(r, fit, k, at, column);
            if (free < 1e-6) /* nothing contradicts the only reading of a mode */
                continue;
            double others = fmax(1, (fit->chi2 - left * left / free) / (fit->dof - 1)), t = fabs(left) / sqrt(free * others);
            if (t > *size) {
                *size = t;
                worst = at;
            }
        }
    return worst;
}

int point_drop_outliers(const struct point_readings *r)
{
    struct point_fit fit;
    int dropped = 0, most = 1;
    do {
        double size;
        if (point_fit(r, &fit) || fit.dof <= LEAST_DOF)
            break;
        most = dropped ? most : fit.readings / 10 > 1 ? fit.readings / 10 : 1;
        ptrdiff_t worst = worst_reading(r, &fit, &size);
        if (worst < 0 || size <= quantile_student(CHANCE / fit.readings, fit.dof - 1))
            break;
        r->use[worst] = 0;
    } while (++dropped < most);
    return dropped;
}

#define NO_NOISE 1e-9 /* relative: where nothing is known of the noise, so little that the scatter alone decides */

/* What is known of the noise of the readings. Returns the largest known, 0 where none is. */
static double fill_std(int n, const double *hz, const double *std, double *filled)
{
    double largest = 0, highest = 0;
    for (int j = 0; j < n; j++) {
        if (!isfinite(hz[j]))
            continue;
        highest = fmax(highest, hz[j]);
        if (isfinite(std[j]))
            largest = fmax(largest, std[j]);
    }
    for (int j = 0; j < n; j++)
        filled[j] = isfinite(std[j]) ? std[j] : largest > 0 ? largest : NO_NOISE * highest;
    return largest;
}

/* Takes outliers out of use by the scatter about the line and a share of what the accelerometer does to each reading: the line in
 * the squared shape, which was measured with noise of its own, is no better. The scatter is the median's, which one wrong reading
 * hardly moves. wide, size [npoint] are workspace. */
static int drop_from_line(struct point_readings line, double *wide, double *size)
{
    struct point_fit fit;
    double column[POINT_COLUMNS], slope = point_fit(&line, &fit) ? 0 : fit.slope[0];
    const double *std = line.std;
    int count = 0;
    for (int j = 0; j < line.npoint; j++)
        if (line.use[j])
            size[count++] = fabs(residual(&line, &fit, 0, j, column)) / std[j];
    if (fit.dof <= LEAST_DOF)
        return 0;
    sort_doubles((size_t)count, size);
    double scale = fmax(1, MEDIAN * size[count / 2] * sqrt((double)count / fit.dof));
    for (int j = 0; j < line.npoint; j++)
        wide[j] = line.ncolumn && line.use[j] ? hypot(scale * std[j], INEXACT * slope * line.column[0][j]) : scale * std[j];
    line.std = wide;
    return point_drop_outliers(&line);
}

int point_mean(struct pool *pool, int nsensor, const double *hz, const double *std, const double *shape, struct point_mean *out)
{
    double *filled = POOL_ARRAY(pool, double, nsensor), *square = POOL_ARRAY(pool, double, nsensor),
           *wide = POOL_ARRAY(pool, double, 2 * (size_t)nsensor), mean[3], middle = 0;
    char *use = POOL_ARRAY(pool, char, nsensor);
    int components = 0, both = 0;
    *out = (struct point_mean){.hz = NAN, .std = NAN, .std_of_others = NAN};
    if (!filled || !square || !wide || !use)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < nsensor; j++) {
        int there = shape && isfinite(shape[j]);
        square[j] = there ? shape[j] * shape[j] : NAN;
        middle += there ? square[j] : 0;
        components += there;
        out->readings += isfinite(hz[j]) != 0;
        both += there && isfinite(hz[j]);
    }
    if (!out->readings)
        return ROTID_ERROR_ARGUMENT;
    double largest = fill_std(nsensor, hz, std, filled);
    struct point_readings readings = {
        .nmode = 1, .npoint = nsensor, .ncolumn = 1, .y = hz, .std = filled, .column = {square}, .use = use, .mean = mean};
    struct point_fit fit;
    out->regressed = both >= LEAST_MEAN;
    for (int pass = 0; pass < 2; pass++) { /* the second where the shape turned out to be the same everywhere */
        readings.ncolumn = out->regressed;
        for (int j = 0; j < nsensor; j++)
            use[j] = isfinite(hz[j]) && (!out->regressed || isfinite(square[j]));
        out->dropped = drop_from_line(readings, wide, wide + nsensor);
        if (!point_fit(&readings, &fit))
            break;
        out->regressed = 0;
    }
    double away = out->regressed ? middle / components - mean[2] : 0, variance = 1 / mean[0];
    out->hz = mean[1] + fit.slope[0] * away;
    if (out->regressed)
        variance += away * away * fit.variance[0];
    double known = largest > 0 || fit.dof >= LEAST_DOF ? 1 : NAN;
    out->std = known * fit.scale * sqrt(variance);
    out->std_of_others = largest > 0 ? largest : known * fit.scale * filled[0];
    return ROTID_OK;
}
