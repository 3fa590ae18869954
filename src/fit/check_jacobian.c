#include <float.h>

#include "base/base.h"

#define STEPS  16  /* at most: the last is 2^-15 of the first */
#define FIRST  0.1 /* of the scale */
#define SHRINK 2   /* from step to step */
#define WORSE  8   /* than the best estimate so far: rounding has taken over, and shorter steps will not help */
#define EARLY  5   /* steps that are taken in any case: the first may be too long to tell anything */

struct check {
    int m, n;
    rotid_residual residual;
    void *user;
    double *x, *jacobian, *above, *below;
    double *rows[2]; /* [m * STEPS] of the tableau: extrapolations of growing order */
    double *best;
};

size_t rotid_check_jacobian_workspace(int m, int n)
{
    size_t rows = (size_t)m, columns = (size_t)n;
    return m < 1 || n < 1 ? 0 : columns + rows * columns + (3 + 2 * STEPS) * rows;
}

static double length(int m, const double *a)
{
    double largest = largest_magnitude(m, a), sum = 0;
    for (int i = 0; i < m && largest > 0; i++)
        sum += a[i] / largest * (a[i] / largest);
    return largest * sqrt(sum);
}

static double distance(int m, const double *a, const double *b)
{
    double largest = 0, sum = 0;
    for (int i = 0; i < m; i++)
        largest = fmax(largest, fabs(a[i] - b[i]));
    for (int i = 0; i < m && largest > 0; i++)
        sum += (a[i] - b[i]) / largest * ((a[i] - b[i]) / largest);
    return largest * sqrt(sum);
}

/* out [m] := (r(x + h e_j) - r(x - h e_j))/2h with the h that x + h and x - h have after rounding. Returns 0, or 1 where one of
 * the points has no residual or is x itself. */
static int difference(struct check *check, int j, double h, double *out)
{
    double here = check->x[j], high = here + h, low = here - h;
    int failed = !(high > here && low < here) || !isfinite(high - low);
    if (!failed) {
        check->x[j] = high;
        failed = check->residual(check->user, check->m, check->n, check->x, check->above, NULL) != 0;
        check->x[j] = low;
        failed = failed || check->residual(check->user, check->m, check->n, check->x, check->below, NULL);
        check->x[j] = here;
    }
    for (int i = 0; i < check->m && !failed; i++) {
        out[i] = (check->above[i] - check->below[i]) / (high - low);
        failed = !isfinite(out[i]);
    }
    return failed;
}

/* check->best := D_j. Returns what it may be wrong by, the least difference between neighbours in the tableau, or NaN where no
 * two steps could be taken. */
static double extrapolate(struct check *check, int j, double scale)
{
    int m = check->m, order = 0;
    double h = FIRST * scale, doubt = INFINITY;
    for (int step = 0; step < STEPS; step++, h /= SHRINK) {
        double *row = check->rows[order % 2], *above = check->rows[1 - order % 2], factor = 1;
        if (difference(check, j, h, row)) {
            if (order) /* a shorter step fails behind a longer one: there is no order to be found */
                break;
            continue;
        }
        for (int k = 1; k <= order; k++) {
            double *now = row + (ptrdiff_t)k * m, *left = now - m, *before = above + (ptrdiff_t)(k - 1) * m;
            factor *= SHRINK * SHRINK; /* the error of central differences is a series in h^2 */
            for (int i = 0; i < m; i++)
                now[i] = left[i] + (left[i] - before[i]) / (factor - 1);
            double change = fmax(distance(m, now, left), distance(m, now, before));
            if (change <= doubt) {
                doubt = change;
                memcpy(check->best, now, (size_t)m * sizeof *now);
            }
        }
        if (order >= EARLY && distance(m, row + (ptrdiff_t)order * m, above + (ptrdiff_t)(order - 1) * m) >= WORSE * doubt)
            break;
        order++;
    }
    return isfinite(doubt) ? doubt : NAN;
}

static int check_arguments(int m, int n, rotid_residual residual, const double *x, const double *scale, const double *error,
                           const double *doubt, const double *work, char *failure)
{
    if (m < 1 || n < 1)
        return refuse(failure, "m is %d and n is %d, expected 1 or more", m, n);
    const char *missing = !residual ? "residual" : !x ? "x" : !error ? "error" : !doubt ? "doubt" : !work ? "work" : NULL;
    if (missing)
        return refuse(failure, "%s is NULL, expected one", missing);
    for (int j = 0; j < n; j++) {
        if (!isfinite(x[j]))
            return refuse(failure, "x[%d] is %g, expected a number", j, x[j]);
        if (scale && (!(scale[j] > 0) || !isfinite(scale[j])))
            return refuse(failure, "scale[%d] is %g, expected a positive number", j, scale[j]);
    }
    return ROTID_OK;
}

static int run(int m, int n, rotid_residual residual, void *user, const double *x, const double *scale, char *failure,
               double *error, double *doubt, double *work)
{
    int status = check_arguments(m, n, residual, x, scale, error, doubt, work, failure);
    if (status)
        return status;
    struct check check = {.m = m, .n = n, .residual = residual, .user = user, .x = work};
    check.jacobian = check.x + n;
    check.above = check.jacobian + (ptrdiff_t)m * n;
    check.below = check.above + m;
    check.best = check.below + m;
    check.rows[0] = check.best + m;
    check.rows[1] = check.rows[0] + (ptrdiff_t)STEPS * m;
    memcpy(check.x, x, (size_t)n * sizeof *x);
    if (residual(user, m, n, check.x, check.above, NULL))
        return ROTID_ERROR_CALLBACK;
    if (!all_finite(m, check.above))
        return failure_say(failure, ROTID_ERROR_FINITE, "the residual at x is not finite");
    if (residual(user, m, n, check.x, NULL, check.jacobian))
        return ROTID_ERROR_CALLBACK;
    if (!all_finite((ptrdiff_t)m * n, check.jacobian))
        return failure_say(failure, ROTID_ERROR_FINITE, "the Jacobian at x is not finite");
    double rounding = DBL_EPSILON * length(m, check.above); /* of r: no difference is known any better */
    for (int j = 0; j < n; j++) {
        const double *column = check.jacobian + (ptrdiff_t)j * m;
        double unit = scale ? scale[j] : fmax(fabs(x[j]), 1e-3), wrong_by = extrapolate(&check, j, unit);
        if (wrong_by < rounding / (FIRST * unit) && length(m, check.best) > 0) /* 0: r does not change at all */
            wrong_by = rounding / (FIRST * unit);
        error[j] = doubt[j] = wrong_by; /* where that is not NaN: */
        if (wrong_by >= 0) {
            double size = fmax(length(m, column), length(m, check.best));
            error[j] = size > 0 ? distance(m, column, check.best) / size : 0;
            doubt[j] = size > 0 ? wrong_by / size : 0;
        }
    }
    return ROTID_OK;
}

int rotid_check_jacobian(int m, int n, rotid_residual residual, void *user, const double *x, const double *scale, char *failure,
                         double *error, double *doubt, double *work)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = run(m, n, residual, user, x, scale, failure, error, doubt, work);
    return entry_close(&entry, status);
}
