#include "diagnose/diagnose.h"
#include "linalg/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Directions that physics can take: as many as hold every column to this part of its length, but no more than MOST_DIRECTIONS and
 * a quarter of the rows. What a real effect leaves outside is then the square of that part of its chi2. */
#define LEFT_OF_COLUMN  0.05
#define MOST_DIRECTIONS 60
#define LEAST_ROWS      60 /* of the complement */
/* A column that the residual does not see at all belongs to a parameter that the fit has adjusted: no noise is left on it. */
#define FITTED 1e-6
/* Rows, and directions, beyond three standard deviations are left out; the variance of what stays is 0.97334 of a normal one. */
#define CUT          3.0
#define CUT_VARIANCE 0.97334
#define SWEEPS       50
/* Of the number of rows, what the cut leaves in the estimate of the variance. */
#define EFFICIENCY 0.9
/* Two-sided 0.001, and one-sided 0.002. */
#define QUANTILE_TWO 3.2905
#define QUANTILE_ONE 2.8782
#define MISSTATED    1.15
#define COLOURED     1.3
/* Real effects in the residual: columns that are taken out of the smooth part, one after the other. */
#define MOST_EFFECTS   5
#define EXCHANGES      2
#define EFFECT_MINIMUM 9.0

struct basis {
    int m, count, fitted; /* rows, directions; the first `fitted` hold no noise */
    double *q;            /* [m * count] orthonormal */
    double *left;         /* [ncolumn] what is left of each column's squared length */
};

static void subtract(int n, double part, const double *from, double *x)
{
    for (int i = 0; i < n; i++)
        x[i] -= part * from[i];
}

/* Adds the direction of a column, orthogonalised twice. */
static void add_direction(struct basis *basis, const double *column)
{
    int m = basis->m;
    double *q = basis->q + (ptrdiff_t)basis->count * m;
    memcpy(q, column, (size_t)m * sizeof *q);
    for (int pass = 0; pass < 2; pass++)
        for (int j = 0; j < basis->count; j++) {
            const double *other = basis->q + (ptrdiff_t)j * m;
            subtract(m, product_dot(m, other, q), other, q);
        }
    double length = sqrt(product_dot(m, q, q));
    for (int i = 0; i < m; i++)
        q[i] /= length;
    basis->count++;
}

/* Gram-Schmidt with pivoting: the column of which most is left, relative to its length, comes next; those that are orthogonal to
 * the residual come before all others. `unit` [m * n]: columns of unit length, or zero. */
static void span(int n, const double *unit, const double *residual, int most, struct basis *basis)
{
    int m = basis->m;
    double size = sqrt(product_dot(m, residual, residual));
    for (int phase = 0; phase < 2; phase++) {
        for (int j = 0; j < n; j++) {
            const double *column = unit + (ptrdiff_t)j * m;
            basis->left[j] = product_dot(m, column, column);
            if (!phase && fabs(product_dot(m, column, residual)) > FITTED * size)
                basis->left[j] = 0;
            for (int k = 0; k < basis->count; k++)
                basis->left[j] -= pow(product_dot(m, basis->q + (ptrdiff_t)k * m, column), 2);
        }
        while (basis->count < most) {
            int best = 0;
            for (int j = 1; j < n; j++)
                if (basis->left[j] > basis->left[best])
                    best = j;
            if (!(basis->left[best] > LEFT_OF_COLUMN * LEFT_OF_COLUMN))
                break;
            add_direction(basis, unit + (ptrdiff_t)best * m);
            const double *q = basis->q + (ptrdiff_t)(basis->count - 1) * m;
            for (int j = 0; j < n; j++)
                if (basis->left[j] > LEFT_OF_COLUMN * LEFT_OF_COLUMN)
                    basis->left[j] -= pow(product_dot(m, q, unit + (ptrdiff_t)j * m), 2);
            basis->left[best] = 0;
        }
        if (!phase)
            basis->fitted = basis->count;
    }
}

static int ascending(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Standard deviation of normal numbers from the median of their absolute values. work [n]. */
static double median_level(int n, const double *x, double *work)
{
    for (int i = 0; i < n; i++)
        work[i] = fabs(x[i]);
    qsort(work, (size_t)n, sizeof *work, ascending);
    return 1.482602 * (work[(n - 1) / 2] + work[n / 2]) / 2;
}

/* From there, root mean square of those within the cut, until the same ones are. `lost` of them are taken by a fit. */
static double cut_level(int n, const double *x, double lost, double level)
{
    for (int sweep = 0, before = -1; sweep < SWEEPS; sweep++) {
        double sum = 0;
        int count = 0;
        for (int i = 0; i < n; i++)
            if (fabs(x[i]) <= CUT * level) {
                sum += x[i] * x[i];
                count++;
            }
        if (count == before || count <= lost)
            break;
        before = count;
        level = sqrt(sum / ((count - lost) * CUT_VARIANCE));
    }
    return level;
}

/* Robust least squares of the residual on the basis: rows outside the cut are replaced by what the others predict for them until
 * nothing changes, which leaves them out of the fit. rest [m]: what the basis leaves, over the square root of its share of the
 * variance; coefficient [count]. Returns the level. */
static double fit_basis(const struct basis *basis, const double *residual, double *rest, double *coefficient, double *work)
{
    int m = basis->m, p = basis->count;
    double *kept = work, *scratch = work + m, *share = scratch + m, level = INFINITY;
    for (int i = 0; i < m; i++) {
        share[i] = 1;
        for (int j = 0; j < p; j++)
            share[i] -= pow(basis->q[i + (ptrdiff_t)j * m], 2);
        share[i] = sqrt(fmax(share[i], 1e-3));
    }
    level = median_level(m, residual, scratch);
    for (int i = 0; i < m; i++)
        rest[i] = residual[i];
    memset(coefficient, 0, (size_t)p * sizeof *coefficient);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        /* winsorised: a row beyond the cut pulls as one at the cut, in the last sweeps not at all */
        double bound = CUT * level;
        for (int i = 0; i < m; i++) {
            double fitted = residual[i] - rest[i];
            double off = rest[i] / share[i];
            if (sweep < SWEEPS / 2)
                kept[i] = fabs(off) <= bound ? residual[i] : fitted + copysign(bound * share[i], rest[i]);
            else
                kept[i] = fabs(off) <= bound ? residual[i] : fitted;
        }
        for (int j = 0; j < p; j++)
            coefficient[j] = product_dot(m, basis->q + (ptrdiff_t)j * m, kept);
        memcpy(rest, residual, (size_t)m * sizeof *rest);
        for (int j = 0; j < p; j++)
            subtract(m, coefficient[j], basis->q + (ptrdiff_t)j * m, rest);
        for (int i = 0; i < m; i++)
            kept[i] = rest[i] / share[i];
        level = median_level(m, kept, scratch);
    }
    for (int i = 0; i < m; i++)
        rest[i] /= share[i];
    return level;
}

/* Real effects in the smooth part: x [p] are the coefficients on the directions that hold noise, c [p * n] those of every column.
 */
struct effects {
    int p, n, count, column[MOST_EFFECTS];
    const double *x, *c;
    double *gone; /* [p * MOST_EFFECTS] orthonormal, of the columns taken out */
    double *rest; /* [p] x without them */
};

/* rest for all columns taken out but number `skip`. */
static void take_out(struct effects *e, int skip)
{
    int p = e->p, used = 0;
    memcpy(e->rest, e->x, (size_t)p * sizeof *e->rest);
    for (int k = 0; k < e->count; k++) {
        double *g = e->gone + (ptrdiff_t)used * p;
        if (k == skip)
            continue;
        memcpy(g, e->c + (ptrdiff_t)e->column[k] * p, (size_t)p * sizeof *g);
        for (int pass = 0; pass < 2; pass++)
            for (int j = 0; j < used; j++)
                subtract(p, product_dot(p, e->gone + (ptrdiff_t)j * p, g), e->gone + (ptrdiff_t)j * p, g);
        double length = sqrt(product_dot(p, g, g));
        for (int i = 0; i < p; i++)
            g[i] /= length;
        subtract(p, product_dot(p, g, e->rest), g, e->rest);
        used++;
    }
}

/* The column that takes most away of the rest beside the others; returns how much. */
static double best_column(struct effects *e, int skip, int *column)
{
    int used = e->count - (skip >= 0);
    double most = 0;
    take_out(e, skip);
    for (int j = 0; j < e->n; j++) {
        const double *c = e->c + (ptrdiff_t)j * e->p;
        double along = product_dot(e->p, c, e->rest), square = product_dot(e->p, c, c);
        for (int k = 0; k < used; k++)
            square -= pow(product_dot(e->p, e->gone + (ptrdiff_t)k * e->p, c), 2);
        if (square > 4 * LEFT_OF_COLUMN * LEFT_OF_COLUMN && along * along / square > most) {
            most = along * along / square;
            *column = j;
        }
    }
    return most;
}

/* The level of the coefficients. A real effect is a column, so it is taken out as one: the column that explains most goes, as
 * long as one stands out, and each is exchanged for a better one once the others are known. Returns the degrees of freedom left.
 * work [p]. */
static int smooth_level(struct effects *e, double *level, double *work)
{
    for (;;) {
        int column = 0;
        take_out(e, -1);
        *level = cut_level(e->p, e->rest, e->count, median_level(e->p, e->rest, work));
        if (e->count == MOST_EFFECTS || best_column(e, -1, &column) < EFFECT_MINIMUM * *level * *level)
            return e->p - e->count;
        e->column[e->count++] = column;
        for (int i = 0; e->count > 1 && i < EXCHANGES * e->count; i++)
            if (best_column(e, i % e->count, &column) > 0)
                e->column[i % e->count] = column;
    }
}

static void normalise(int m, int n, const double *column, double *unit)
{
    for (int j = 0; j < n; j++) {
        const double *from = column + (ptrdiff_t)j * m;
        double largest = 0, length = 0;
        for (int i = 0; i < m; i++)
            largest = fmax(largest, fabs(from[i]));
        if (!(largest > 0) || !isfinite(largest))
            continue;
        for (int i = 0; i < m; i++) {
            unit[i + (ptrdiff_t)j * m] = from[i] / largest;
            length += pow(from[i] / largest, 2);
        }
        for (int i = 0; i < m; i++)
            unit[i + (ptrdiff_t)j * m] /= sqrt(length);
    }
}

int noise_check(struct pool *pool, int nrow, int ncolumn, const double *residual, const double *column,
                struct noise_estimate *estimate)
{
    int most = nrow / 4 < MOST_DIRECTIONS ? nrow / 4 : MOST_DIRECTIONS;
    size_t m = (size_t)nrow, n = (size_t)ncolumn, widest = (size_t)most;
    *estimate = (struct noise_estimate){.factor = NAN, .std = NAN, .smooth_factor = NAN};
    if (nrow < LEAST_ROWS)
        return ROTID_OK;
    double *unit = POOL_ARRAY(pool, double, (m * n));
    double *smooth = POOL_ARRAY(pool, double, (widest * n));
    double *numbers = POOL_ARRAY(pool, double, m *widest + n + m + widest + 3 * m + (2 + MOST_EFFECTS) * widest);
    if (!unit || !smooth || !numbers)
        return ROTID_ERROR_MEMORY;
    struct basis basis = {.m = nrow, .q = numbers, .left = numbers + m * widest};
    double *rest = basis.left + n, *coefficient = rest + m, *work = coefficient + widest;
    normalise(nrow, ncolumn, column, unit);
    if (ncolumn > 0)
        span(ncolumn, unit, residual, most, &basis);
    int rows = nrow - basis.count;
    if (rows < LEAST_ROWS)
        return ROTID_OK;
    double level = fit_basis(&basis, residual, rest, coefficient, work);
    level = cut_level(nrow, rest, 0, level);
    *estimate =
        (struct noise_estimate){.usable = 1, .factor = level, .std = level / sqrt(2 * EFFICIENCY * rows), .smooth_factor = NAN};
    estimate->misstated = fabs(log(level)) > log(MISSTATED) && fabs(log(level)) > QUANTILE_TWO * estimate->std / level;
    int p = basis.count - basis.fitted;
    if (p <= MOST_EFFECTS)
        return ROTID_OK;
    struct effects effects = {.p = p,
                              .n = ncolumn,
                              .x = coefficient + basis.fitted,
                              .c = smooth,
                              .gone = work,
                              .rest = work + MOST_EFFECTS * (ptrdiff_t)p};
    for (int j = 0; j < ncolumn; j++)
        for (int k = 0; k < p; k++)
            smooth[k + (ptrdiff_t)j * p] =
                product_dot(nrow, basis.q + (ptrdiff_t)(basis.fitted + k) * nrow, unit + (ptrdiff_t)j * nrow);
    int dof = smooth_level(&effects, &estimate->smooth_factor, effects.rest + p);
    double ratio = estimate->smooth_factor / level, chance = sqrt((1.0 / dof + 1.0 / rows) / (2 * EFFICIENCY));
    estimate->coloured = ratio > COLOURED && ratio > 1 + QUANTILE_ONE * chance;
    return ROTID_OK;
}
