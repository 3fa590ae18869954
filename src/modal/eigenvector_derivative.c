#include "modal/eigenvector_derivative.h"

#include <math.h>
#include <string.h>

#include "linalg/matrix.h"

int eigenvalue_is_close(int count, const double *lambda, int k)
{
    double reach = CLOSE_EIGENVALUES * fabs(lambda[k]);
    return (k > 0 && lambda[k] - lambda[k - 1] < reach) || (k + 1 < count && lambda[k + 1] - lambda[k] < reach);
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

int nelson_band_new(struct pool *pool, const rotid_matrix *structure, struct nelson_band *b)
{
    int n = structure->n;
    *b = (struct nelson_band){.n = n};
    b->kept = POOL_ARRAY(pool, int, n);
    b->residual = POOL_ARRAY(pool, double, n);
    b->right = POOL_ARRAY(pool, double, n);
    if (!b->kept || !b->residual || !b->right)
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

void nelson_band_solve(struct nelson_band *b, const double *phi, const double *m_phi, const double *p, double q, double *dphi)
{
    int n = b->n;
    leave_out(n, b->left_out, p, dphi);
    factor_solve(&b->factor, 1, dphi);
    insert_zero(n, b->left_out, dphi);
    for (int pass = 0; pass < 2; pass++) { /* the bordered factors may lose digits where a clamped mode lies near: refine */
        matrix_multiply(&b->shifted, 1, dphi, b->residual);
        for (int i = 0; i < n; i++)
            b->residual[i] = p[i] - b->residual[i];
        leave_out(n, b->left_out, b->residual, b->right);
        factor_solve(&b->factor, 1, b->right);
        insert_zero(n, b->left_out, b->right);
        for (int i = 0; i < n; i++)
            dphi[i] += b->right[i];
    }
    complete(n, phi, m_phi, q, dphi);
}
