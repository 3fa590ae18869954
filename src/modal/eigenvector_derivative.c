#include "modal/eigenvector_derivative.h"

#include <math.h>
#include <string.h>

#include "linalg/matrix.h"
#include "linalg/product.h"

#define ENOUGH 1e-9 /* relative change of V by a step of refinement whose square is below rounding */

int eigenvalue_is_close(int count, const double *lambda, int k)
{
    double reach = CLOSE_EIGENVALUES * fabs(lambda[k]);
    return (k > 0 && lambda[k] - lambda[k - 1] < reach) || (k + 1 < count && lambda[k + 1] - lambda[k] < reach);
}

double nelson_right_side(int n, double lambda, const double *phi, const double *m_phi, const double *dk_phi, const double *dm_phi,
                         double *p, double *q)
{
    double dlambda = product_dot(n, phi, dk_phi) - lambda * product_dot(n, phi, dm_phi);
    for (int i = 0; i < n; i++)
        p[i] = -(dk_phi[i] - dlambda * m_phi[i] - lambda * dm_phi[i]);
    *q = -0.5 * product_dot(n, phi, dm_phi);
    return dlambda;
}

static int largest_component(int n, const double *phi)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (fabs(phi[i]) > fabs(phi[best]))
            best = i;
    return best;
}

/* dphi := V + (Q - phi' M V) phi, V in dphi */
static void complete(int n, const double *phi, const double *m_phi, double q, double *dphi)
{
    double c = q;
    for (int i = 0; i < n; i++)
        c -= m_phi[i] * dphi[i];
    for (int i = 0; i < n; i++)
        dphi[i] += c * phi[i];
}

/* out [n] := in [n - 1] with a zero at left_out; in may be out */
static void insert_zero(int n, int left_out, double *x)
{
    memmove(x + left_out + 1, x + left_out, (size_t)(n - 1 - left_out) * sizeof *x);
    x[left_out] = 0;
}

static void leave_out(int n, int left_out, const double *x, double *shorter)
{
    memcpy(shorter, x, (size_t)left_out * sizeof *x);
    memcpy(shorter + left_out, x + left_out + 1, (size_t)(n - 1 - left_out) * sizeof *x);
}

int nelson_dense_new(struct pool *pool, int n, struct nelson_dense *d)
{
    *d = (struct nelson_dense){.n = n};
    return symmetric_new(pool, n, &d->factor);
}

int nelson_dense_prepare(struct nelson_dense *d, const double *k, const double *m, double lambda, const double *phi)
{
    int n = d->n;
    double *target = d->factor.a;
    d->left_out = largest_component(n, phi);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            if (i != d->left_out && j != d->left_out)
                *target++ = k[i + (ptrdiff_t)j * n] - lambda * m[i + (ptrdiff_t)j * n];
    return symmetric_factor(&d->factor, n - 1) ? ROTID_ERROR_CLOSE : ROTID_OK;
}

void nelson_dense_solve(struct nelson_dense *d, const double *phi, const double *m_phi, const double *p, double q, double *dphi)
{
    leave_out(d->n, d->left_out, p, dphi);
    symmetric_solve(&d->factor, d->n - 1, dphi);
    insert_zero(d->n, d->left_out, dphi);
    complete(d->n, phi, m_phi, q, dphi);
}

void modal_superposition(int n, const double *lambda, const double *phi, int k, const double *m_phi, const double *p, double q,
                         double *dphi)
{
    memset(dphi, 0, (size_t)n * sizeof *dphi);
    for (int j = 0; j < n; j++) {
        if (j == k)
            continue;
        const double *other = phi + (ptrdiff_t)j * n;
        double c = 0;
        for (int i = 0; i < n; i++)
            c += other[i] * p[i];
        c /= lambda[j] - lambda[k];
        for (int i = 0; i < n; i++)
            dphi[i] += c * other[i];
    }
    complete(n, phi + (ptrdiff_t)k * n, m_phi, q, dphi);
}

int nelson_band_new(struct pool *pool, const rotid_matrix *structure, int most, struct nelson_band *b)
{
    int n = structure->n;
    size_t columns = (size_t)n * (size_t)most;
    *b = (struct nelson_band){.n = n};
    b->kept = POOL_ARRAY(pool, int, n);
    b->residual = POOL_ARRAY(pool, double, columns);
    b->shorter = POOL_ARRAY(pool, double, columns);
    if (!b->kept || !b->residual || !b->shorter)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        b->kept[i] = i;
    int status = matrix_new(pool, n, structure->kd, structure->nfar, structure->far, &b->shifted);
    return status ? status : factor_new(pool, FACTOR_LU, structure, n, b->kept, &b->factor);
}

int nelson_band_prepare(struct nelson_band *b, const rotid_matrix *k, const rotid_matrix *m, double lambda, const double *phi)
{
    b->left_out = largest_component(b->n, phi);
    for (int i = 0; i < b->n - 1; i++)
        b->kept[i] = i + (i >= b->left_out);
    matrix_combine(1, k, -lambda, m, &b->shifted);
    factor_keep(&b->factor, k, b->n - 1, b->kept);
    return factor_compute(&b->factor, &b->shifted) ? ROTID_ERROR_CLOSE : ROTID_OK;
}

/* x [n * columns] := A^-1 x without the row and column left out, zero there */
static void solve_columns(struct nelson_band *b, int columns, double *x)
{
    int n = b->n;
    for (int c = 0; c < columns; c++)
        leave_out(n, b->left_out, x + (ptrdiff_t)c * n, b->shorter + (ptrdiff_t)c * (n - 1));
    factor_solve(&b->factor, columns, b->shorter);
    for (int c = 0; c < columns; c++) {
        memcpy(x + (ptrdiff_t)c * n, b->shorter + (ptrdiff_t)c * (n - 1), (size_t)(n - 1) * sizeof *x);
        insert_zero(n, b->left_out, x + (ptrdiff_t)c * n);
    }
}

static double largest(ptrdiff_t count, const double *x)
{
    double most = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* dphi holds V of A V = P for `columns` right-hand sides; one step of refinement. Returns how much it changed V, the worst of the
 * columns. */
static double refine(struct nelson_band *b, int columns, const double *p, double *dphi)
{
    int n = b->n;
    double worst = 0;
    matrix_multiply(&b->shifted, columns, dphi, b->residual);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)n * columns; i++)
        b->residual[i] = p[i] - b->residual[i];
    solve_columns(b, columns, b->residual);
    for (int c = 0; c < columns; c++) {
        double *x = dphi + (ptrdiff_t)c * n, *change = b->residual + (ptrdiff_t)c * n, size = largest(n, x);
        for (int i = 0; i < n; i++)
            x[i] += change[i];
        worst = fmax(worst, size > 0 ? largest(n, change) / size : 0);
    }
    return worst;
}

void nelson_band_solve(struct nelson_band *b, int columns, const double *phi, const double *m_phi, const double *p,
                       const double *q, double *dphi)
{
    int n = b->n;
    memcpy(dphi, p, (size_t)n * (size_t)columns * sizeof *p);
    solve_columns(b, columns, dphi);
    /* the bordered factors may lose digits where a clamped mode lies near; a second step would change V by the square of the
     * first
     */
    if (refine(b, columns, p, dphi) > ENOUGH)
        (void)refine(b, columns, p, dphi);
    for (int c = 0; c < columns; c++)
        complete(n, phi, m_phi, q[c], dphi + (ptrdiff_t)c * n);
}
