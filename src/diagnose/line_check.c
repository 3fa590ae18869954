#include "diagnose/line_check.h"

#include <math.h>
#include <string.h>

#define LEAST_SENSORS 4
#define LEAST_MOVE    5e-4 /* m: nobody glues a sensor more closely than that */
#define SHIFTS        13   /* places of the grid, over a tenth of the length to either side */
#define REACH         0.12
#define SCALES        5
#define SCALE_STEP    0.05
#define MOST_SHIFT    0.15 /* of the length: a line that is off by more is measured anew */
#define MOST_SCALE    0.2
#define ITERATIONS    20
#define HALVINGS      12
#define STEP          1e-5 /* of the differences, over the length and 1 */
#define COST          12.0 /* of chi2 that each of flip, shift and scale has to gain: 3.5 standard deviations */

struct line_search {
    const struct shape_data *data;
    double length;
    int nrow;
    double *r, *moved, *jacobian; /* [nrow], [nrow], [2 nrow] */
};

int line_parameters(const struct sensor_line *line)
{
    return line->flip + (line->shift != 0) + (line->scale != 1);
}

/* r [nrow] with every mode at its best scale; returns chi2, INFINITY where a sensor leaves the rotor. */
static double residual(const struct line_search *search, const struct sensor_line *line, double *r)
{
    const struct shape_data *data = search->data;
    double chi2 = 0;
    if (fabs(line->shift) > MOST_SHIFT * search->length || fabs(line->scale - 1) > MOST_SCALE ||
        !sensor_line_fits(line, search->length, data->nsensor, data->z))
        return INFINITY;
    for (int k = 0; k < data->nmode; k++) {
        double square = 0, product = 0, *own = r;
        for (int s = 0; s < data->nsensor; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * data->nsensor;
            double z = sensor_line_place(line, search->length, data->z[s]);
            if (!isfinite(data->shape[at]) || !isfinite(data->std[at]))
                continue;
            double p = shape_data_model(data, k, fmin(fmax(z, data->axis_z[0]), data->axis_z[data->naxis - 1])) / data->std[at];
            square += p * p;
            product += p * data->shape[at] / data->std[at];
            *r++ = p;
        }
        double a = square > 0 ? product / square : 0;
        for (int s = 0; s < data->nsensor; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * data->nsensor;
            if (!isfinite(data->shape[at]) || !isfinite(data->std[at]))
                continue;
            *own = a * *own - data->shape[at] / data->std[at];
            chi2 += *own * *own;
            own++;
        }
    }
    return chi2;
}

/* J'J and J'r over what is free, by differences. */
static void normal_equations(const struct line_search *search, const struct sensor_line *line, const int *free, double h[3],
                             double g[2])
{
    int n = search->nrow;
    h[0] = h[1] = h[2] = g[0] = g[1] = 0;
    for (int p = 0; p < 2; p++) {
        double *column = search->jacobian + (ptrdiff_t)p * n, step = p ? STEP : STEP * search->length;
        struct sensor_line other = *line;
        memset(column, 0, (size_t)n * sizeof *column);
        if (!free[p])
            continue;
        *(p ? &other.scale : &other.shift) += step;
        if (!isfinite(residual(search, &other, search->moved))) {
            *(p ? &other.scale : &other.shift) -= 2 * step;
            step = -step;
            if (!isfinite(residual(search, &other, search->moved)))
                continue;
        }
        for (int i = 0; i < n; i++)
            column[i] = (search->moved[i] - search->r[i]) / step;
    }
    for (int i = 0; i < n; i++) {
        double a = search->jacobian[i], b = search->jacobian[n + i];
        h[0] += a * a;
        h[1] += a * b;
        h[2] += b * b;
        g[0] += a * search->r[i];
        g[1] += b * search->r[i];
    }
}

/* The inverse of J'J over what is free, in the place of h; 0 where it has none. */
static int invert(const int *free, double h[3])
{
    double a = free[0] ? h[0] : 1, b = free[0] && free[1] ? h[1] : 0, c = free[1] ? h[2] : 1, det = a * c - b * b;
    if (!(det > 1e-12 * a * c))
        return 0;
    h[0] = c / det;
    h[1] = -b / det;
    h[2] = a / det;
    return 1;
}

/* Gauss-Newton with halved steps from *line; returns chi2. */
static double descend(const struct line_search *search, const int *free, struct line_fault *fault)
{
    struct sensor_line *line = &fault->line;
    double h[3], g[2], chi2 = residual(search, line, search->r);
    fault->shift_std = fault->scale_std = NAN;
    if (!free[0] && !free[1])
        return chi2;
    for (int i = 0; i < ITERATIONS; i++) {
        normal_equations(search, line, free, h, g);
        if (!invert(free, h))
            return INFINITY;
        double step[2] = {free[0] ? -(h[0] * g[0] + h[1] * g[1]) : 0, free[1] ? -(h[1] * g[0] + h[2] * g[1]) : 0}, least = chi2;
        struct sensor_line next = *line;
        for (int j = 0; j < HALVINGS && !(least < chi2); j++, step[0] /= 2, step[1] /= 2) {
            next = *line;
            next.shift += step[0];
            next.scale += step[1];
            least = residual(search, &next, search->moved);
        }
        if (!(least < chi2))
            break;
        double gained = chi2 - least;
        *line = next;
        chi2 = residual(search, line, search->r);
        if (gained < 1e-6 * chi2)
            break;
    }
    normal_equations(search, line, free, h, g);
    double spread = search->nrow > 2 ? sqrt(fmax(1, chi2 / (search->nrow - 2))) : 1;
    if (invert(free, h)) {
        fault->shift_std = free[0] ? spread * sqrt(h[0]) : NAN;
        fault->scale_std = free[1] ? spread * sqrt(h[2]) : NAN;
    }
    return chi2;
}

/* The best line of a flip with this freedom, from the best place of the grid. */
static double search_line(const struct line_search *search, int flip, const int *free, struct line_fault *fault)
{
    struct sensor_line best = {.flip = flip, .scale = 1};
    double least = residual(search, &best, search->r);
    for (int i = 0; i < (free[0] ? SHIFTS : 1); i++)
        for (int j = 0; j < (free[1] ? SCALES : 1); j++) {
            struct sensor_line one = {.flip = flip, .scale = free[1] ? 1 + SCALE_STEP * (j - (SCALES - 1) / 2.0) : 1};
            one.shift = free[0] ? REACH * search->length * (2.0 * i / (SHIFTS - 1) - 1) : 0;
            one.shift += free[0] ? (1 - one.scale) * search->length / 2 : 0; /* a scale about the middle */
            double chi2 = residual(search, &one, search->r);
            if (chi2 < least) {
                least = chi2;
                best = one;
            }
        }
    *fault = (struct line_fault){.line = best, .shift_std = NAN, .scale_std = NAN};
    return isfinite(least) ? descend(search, free, fault) : least;
}

static double largest_move(const struct shape_data *data, double length, const struct sensor_line *line)
{
    double move = 0;
    for (int s = 0; s < data->nsensor; s++)
        move = fmax(move, fabs(sensor_line_place(line, length, data->z[s]) - data->z[s]));
    return move;
}

int line_check(struct pool *pool, const struct shape_data *data, double length, struct line_fault *fault, int *found)
{
    struct line_search search = {.data = data, .length = length};
    size_t all = (size_t)data->nsensor * (size_t)data->nmode;
    const struct sensor_line stated = {.scale = 1};
    double best = INFINITY, left = 0;
    *found = 0;
    if (data->nsensor < LEAST_SENSORS || data->nmode < 1 || data->naxis < 2)
        return ROTID_OK;
    search.r = POOL_ARRAY(pool, double, 4 * all);
    if (!search.r)
        return ROTID_ERROR_MEMORY;
    search.moved = search.r + all;
    search.jacobian = search.moved + all;
    for (size_t i = 0; i < all; i++)
        search.nrow += isfinite(data->shape[i]) && isfinite(data->std[i]);
    double before = residual(&search, &stated, search.r);
    for (int flip = 0; flip < 2; flip++)
        for (int some = flip ? 0 : 1; some < 4; some++) {
            const int free[2] = {some & 1, some >> 1};
            struct line_fault one;
            double chi2 = search_line(&search, flip, free, &one), score = chi2 + COST * line_parameters(&one.line);
            if (score < best) {
                best = score;
                left = chi2;
                *fault = one;
            }
        }
    if (!isfinite(best))
        return ROTID_OK;
    const struct sensor_line turned = {.flip = 1, .scale = 1};
    double alone = fault->line.flip ? residual(&search, &turned, search.r) : INFINITY;
    if (before - alone > COST) { /* how long a line is, and where it begins, shows once it is the right way round */
        *fault = (struct line_fault){.line = turned, .shift_std = NAN, .scale_std = NAN};
        left = alone;
    }
    int own = line_parameters(&fault->line), dof = search.nrow - data->nmode - own;
    double dispersion = dof > 0 ? fmax(1, left / dof) : 1;
    fault->chi2_drop = before - left;
    *found = own && fault->chi2_drop > COST * own * dispersion && largest_move(data, length, &fault->line) >= LEAST_MOVE;
    return ROTID_OK;
}
