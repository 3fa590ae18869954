#include "linalg/linalg.h"

#include <cblas.h>
#include <lapacke.h>

#define STRIP 24 /* columns: narrow enough to save most of the upper triangle, wide enough for dgemm */

int reduction_new(struct pool *pool, int kind, const rotid_matrix *structure, int nc, const int *master, struct reduction *r)
{
    int n = structure->n, ni = n - nc;
    *r = (struct reduction){.kind = kind, .n = n, .nc = nc, .ni = ni, .master = master};
    size_t tall = (size_t)n * (size_t)nc, square = (size_t)nc * (size_t)nc;
    r->slave = POOL_ARRAY(pool, int, ni);
    r->nonzero = POOL_ARRAY(pool, int, n);
    r->t = POOL_ARRAY(pool, double, tall);
    r->kc = POOL_ARRAY(pool, double, square);
    r->mc = POOL_ARRAY(pool, double, square);
    r->image = POOL_ARRAY(pool, double, nc < 3 ? 3 * (size_t)n : tall); /* the derivatives of IRS use three columns of it */
    r->u1 = POOL_ARRAY(pool, double, n);
    r->u2 = POOL_ARRAY(pool, double, n);
    r->u3 = POOL_ARRAY(pool, double, n);
    r->slaves = POOL_ARRAY(pool, double, n);
    r->c1 = POOL_ARRAY(pool, double, nc);
    r->c2 = POOL_ARRAY(pool, double, nc);
    r->c3 = POOL_ARRAY(pool, double, nc);
    r->psi = r->t;
    r->kg = r->kc;
    r->mg = r->mc;
    if (kind == ROTID_IRS) {
        r->psi = POOL_ARRAY(pool, double, tall);
        r->kg = POOL_ARRAY(pool, double, square);
        r->mg = POOL_ARRAY(pool, double, square);
        r->mg_factor = POOL_ARRAY(pool, double, square);
        r->w = POOL_ARRAY(pool, double, square);
    }
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int i = 0, c = 0, s = 0; i < n; i++) {
        if (c < nc && master[c] == i)
            c++;
        else
            r->slave[s++] = i;
    }
    return factor_new(pool, FACTOR_CHOLESKY, structure, ni, r->slave, &r->factor);
}

/* out [n] := S in [n]: K_ii^-1 on the slave rows, zero on the masters; out may be in. */
static void slave_solve(struct reduction *r, const double *in, double *out)
{
    for (int s = 0; s < r->ni; s++)
        r->slaves[s] = in[r->slave[s]];
    factor_solve(&r->factor, 1, r->slaves);
    memset(out, 0, (size_t)r->n * sizeof(double));
    for (int s = 0; s < r->ni; s++)
        out[r->slave[s]] = r->slaves[s];
}

/* column [n] := A e_j */
static void matrix_column(const rotid_matrix *a, int j, double *column)
{
    memset(column, 0, (size_t)a->n * sizeof(double));
    for (int d = 0; d <= a->kd && j + d < a->n; d++)
        column[j + d] = a->band[d + (ptrdiff_t)j * (a->kd + 1)];
    for (int d = 1; d <= a->kd && d <= j; d++)
        column[j - d] = a->band[d + (ptrdiff_t)(j - d) * (a->kd + 1)];
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; a->far[g] == j && f < a->nfar; f++)
            column[a->far[f]] += a->block[f + (ptrdiff_t)g * a->nfar];
}

/* Psi = [Phi; I] with Phi = -K_ii^-1 K_ic (12) */
static void constraint_modes(struct reduction *r, const rotid_matrix *k)
{
    int n = r->n, ni = r->ni;
    double *phi = r->image; /* [ni * nc] */
    for (int c = 0; c < r->nc; c++) {
        matrix_column(k, r->master[c], r->u1);
        for (int s = 0; s < ni; s++)
            phi[s + (ptrdiff_t)c * ni] = -r->u1[r->slave[s]];
    }
    factor_solve(&r->factor, r->nc, phi);
    for (int c = 0; c < r->nc; c++) {
        double *psi = r->psi + (ptrdiff_t)c * n;
        for (int b = 0; b < r->nc; b++)
            psi[r->master[b]] = b == c;
        for (int s = 0; s < ni; s++)
            psi[r->slave[s]] = phi[s + (ptrdiff_t)c * ni];
    }
}

/* square [nc * nc] := basis' A basis */
static void congruence(struct reduction *r, const rotid_matrix *a, const double *basis, double *square)
{
    int n = r->n, nc = r->nc;
    matrix_multiply(a, nc, basis, r->image);
    for (int begin = 0; begin < nc; begin += STRIP) { /* strips of the lower triangle: the upper one is its mirror image */
        int width = nc - begin < STRIP ? nc - begin : STRIP;
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, nc - begin, width, n, 1, basis + (ptrdiff_t)begin * n, n,
                    r->image + (ptrdiff_t)begin * n, n, 0, square + begin + (ptrdiff_t)begin * nc, nc);
    }
    for (int c = 0; c < nc; c++)
        for (int b = 0; b < c; b++)
            square[b + (ptrdiff_t)c * nc] = square[c + (ptrdiff_t)b * nc];
}

/* Psi' K Psi = K_cc + K_ci Phi: K Psi vanishes on the slave rows, so only the master rows of K are needed. */
static void guyan_stiffness(struct reduction *r, const rotid_matrix *k)
{
    int n = r->n, nc = r->nc;
    for (int b = 0; b < nc; b++) {
        matrix_column(k, r->master[b], r->u1);
        int count = 0;
        for (int i = 0; i < n; i++)
            if (r->u1[i] != 0)
                r->nonzero[count++] = i;
        for (int c = 0; c < nc; c++) {
            const double *psi = r->psi + (ptrdiff_t)c * n;
            double sum = 0;
            for (int i = 0; i < count; i++)
                sum += r->u1[r->nonzero[i]] * psi[r->nonzero[i]];
            r->kg[b + (ptrdiff_t)c * nc] = sum;
        }
    }
    for (int c = 0; c < nc; c++) /* symmetric but for rounding, which the eigen-solvers would see */
        for (int b = c + 1; b < nc; b++)
            r->kg[b + (ptrdiff_t)c * nc] = r->kg[c + (ptrdiff_t)b * nc] =
                (r->kg[b + (ptrdiff_t)c * nc] + r->kg[c + (ptrdiff_t)b * nc]) / 2;
}

static int improve(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m)
{
    int n = r->n, nc = r->nc;
    size_t square = (size_t)nc * (size_t)nc * sizeof(double), tall = (size_t)n * (size_t)nc * sizeof(double);
    memcpy(r->mg_factor, r->mg, square);
    memcpy(r->w, r->kg, square);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', nc, r->mg_factor, nc))
        return ROTID_ERROR_MASS;
    (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', nc, nc, r->mg_factor, nc, r->w, nc);
    matrix_multiply(m, nc, r->psi, r->image);
    for (int c = 0; c < nc; c++)
        slave_solve(r, r->image + (ptrdiff_t)c * n, r->image + (ptrdiff_t)c * n);
    memcpy(r->t, r->psi, tall);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, nc, nc, 1, r->image, n, r->w, nc, 1, r->t, n);
    congruence(r, k, r->t, r->kc);
    congruence(r, m, r->t, r->mc);
    return ROTID_OK;
}

int reduction_begin(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m)
{
    r->k = k;
    r->m = m;
    return factor_compute(&r->factor, k) || factor_is_singular(&r->factor, k) ? ROTID_ERROR_SLAVE : ROTID_OK;
}

int reduction_compute(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m)
{
    int status = reduction_begin(r, k, m);
    if (status)
        return status;
    constraint_modes(r, k);
    guyan_stiffness(r, k);
    congruence(r, m, r->psi, r->mg);
    return r->kind == ROTID_IRS ? improve(r, k, m) : ROTID_OK;
}

void reduction_expand(const struct reduction *r, const double *x, double *u)
{
    cblas_dgemv(CblasColMajor, CblasNoTrans, r->n, r->nc, 1, r->t, r->n, x, 1, 0, u, 1);
}

void reduction_project(const struct reduction *r, const double *u, double *x)
{
    cblas_dgemv(CblasColMajor, CblasTrans, r->n, r->nc, 1, r->t, r->n, u, 1, 0, x, 1);
}

static void psi_expand(const struct reduction *r, const double *x, double *u)
{
    cblas_dgemv(CblasColMajor, CblasNoTrans, r->n, r->nc, 1, r->psi, r->n, x, 1, 0, u, 1);
}

static void psi_project_add(const struct reduction *r, const double *u, double *x)
{
    cblas_dgemv(CblasColMajor, CblasTrans, r->n, r->nc, 1, r->psi, r->n, u, 1, 1, x, 1);
}

static void psi_project(const struct reduction *r, const double *u, double *x)
{
    memset(x, 0, (size_t)r->nc * sizeof(double));
    psi_project_add(r, u, x);
}

/* u [n] := dPsi x = -S dK Psi x, given psi_x = Psi x: (39) corrected; u may be psi_x. Uses u1. */
static void guyan_derivative_expand(struct reduction *r, const rotid_matrix *dk, const double *psi_x, double *u)
{
    matrix_multiply(dk, 1, psi_x, r->u1);
    slave_solve(r, r->u1, u);
    cblas_dscal(r->n, -1, u, 1);
}

/* x [nc] := dPsi' u = -Psi' dK S u. Uses u1 and u3. */
static void guyan_derivative_project(struct reduction *r, const rotid_matrix *dk, const double *u, double *x)
{
    slave_solve(r, u, r->u3);
    matrix_multiply(dk, 1, r->u3, r->u1);
    psi_project(r, r->u1, x);
    cblas_dscal(r->nc, -1, x, 1);
}

/* x [nc] := dM_g y [nc], given psi_y = Psi y: (41) corrected. Uses u1, u2, u3. */
static void guyan_mass_derivative(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *psi_y,
                                  double *x)
{
    matrix_multiply(r->m, 1, psi_y, r->u2);
    guyan_derivative_project(r, dk, r->u2, x);
    guyan_derivative_expand(r, dk, psi_y, r->u2);
    matrix_multiply(r->m, 1, r->u2, r->u1);
    psi_project_add(r, r->u1, x);
    matrix_multiply(dm, 1, psi_y, r->u1);
    psi_project_add(r, r->u1, x);
}

static void solve_mg(const struct reduction *r, double *x)
{
    (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', r->nc, 1, r->mg_factor, r->nc, x, r->nc);
}

/* dT x = dPsi x + S (dM - dK S M) Psi W x + S M dPsi W x + S M Psi dW x,
 * dW x = M_g^-1 (dK_g x - dM_g W x),  dS = -S dK S */
static void irs_derivative_expand(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x, double *u)
{
    int n = r->n, nc = r->nc;
    double *psi_y = r->image, *sum = r->image + n, *t = r->image + 2 * (ptrdiff_t)n;
    cblas_dgemv(CblasColMajor, CblasNoTrans, nc, nc, 1, r->w, nc, x, 1, 0, r->c1, 1); /* y = W x */
    psi_expand(r, r->c1, psi_y);

    psi_expand(r, x, t); /* c2 = dW x, u = dPsi x */
    matrix_multiply(dk, 1, t, r->u1);
    psi_project(r, r->u1, r->c2);
    guyan_derivative_expand(r, dk, t, u);
    guyan_mass_derivative(r, dk, dm, psi_y, r->c3);
    cblas_daxpy(nc, -1, r->c3, 1, r->c2, 1);
    solve_mg(r, r->c2);

    psi_expand(r, r->c2, sum); /* sum = Psi dW x + dPsi y */
    guyan_derivative_expand(r, dk, psi_y, t);
    cblas_daxpy(n, 1, t, 1, sum, 1);
    matrix_multiply(r->m, 1, psi_y, r->u1); /* u2 = S M Psi y */
    slave_solve(r, r->u1, r->u2);
    matrix_multiply(r->m, 1, sum, r->u1); /* u1 = M sum + dM Psi y - dK S M Psi y */
    matrix_multiply(dm, 1, psi_y, t);
    cblas_daxpy(n, 1, t, 1, r->u1, 1);
    matrix_multiply(dk, 1, r->u2, t);
    cblas_daxpy(n, -1, t, 1, r->u1, 1);
    slave_solve(r, r->u1, t);
    cblas_daxpy(n, 1, t, 1, u, 1);
}

/* dT' u = dPsi' u + W' [Psi' (dM - M S dK) s + dPsi' M s] + dW' Psi' M s, s = S u,
 * dW' v = dK_g b - W' dM_g b, b = M_g^-1 v; W' q = K_g M_g^-1 q */
static void irs_derivative_project(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *u,
                                   double *x)
{
    int n = r->n, nc = r->nc;
    double *s = r->image, *ms = r->image + n, *t = r->image + 2 * (ptrdiff_t)n;
    guyan_derivative_project(r, dk, u, x);
    slave_solve(r, u, s);
    matrix_multiply(r->m, 1, s, ms);

    psi_project(r, ms, r->c1); /* c1 = b */
    solve_mg(r, r->c1);
    psi_expand(r, r->c1, t);
    matrix_multiply(dk, 1, t, r->u1);
    psi_project_add(r, r->u1, x);
    guyan_mass_derivative(r, dk, dm, t, r->c2);
    cblas_dscal(nc, -1, r->c2, 1); /* c2 collects what W' multiplies */

    guyan_derivative_project(r, dk, ms, r->c3);
    cblas_daxpy(nc, 1, r->c3, 1, r->c2, 1);
    matrix_multiply(dm, 1, s, r->u1);
    psi_project_add(r, r->u1, r->c2);
    matrix_multiply(dk, 1, s, r->u1);
    slave_solve(r, r->u1, r->u2);
    matrix_multiply(r->m, 1, r->u2, r->u1);
    cblas_dscal(n, -1, r->u1, 1);
    psi_project_add(r, r->u1, r->c2);

    solve_mg(r, r->c2);
    cblas_dsymv(CblasColMajor, CblasLower, nc, 1, r->kg, nc, r->c2, 1, 1, x, 1);
}

void reduction_derivative_expand(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x, double *u)
{
    if (r->kind == ROTID_IRS) {
        irs_derivative_expand(r, dk, dm, x, u);
        return;
    }
    psi_expand(r, x, r->u2);
    guyan_derivative_expand(r, dk, r->u2, u);
}

void reduction_derivative_project(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *u, double *x)
{
    if (r->kind == ROTID_IRS)
        irs_derivative_project(r, dk, dm, u, x);
    else
        guyan_derivative_project(r, dk, u, x);
}

/* y [nc] := (T' dA T + dT' A T + T' A dT) x, with u = T x and du = dT x */
static void congruence_derivative(struct reduction *r, const rotid_matrix *a, const rotid_matrix *da, const rotid_matrix *dk,
                                  const rotid_matrix *dm, const double *u, const double *du, double *y, double *row,
                                  double *column)
{
    matrix_multiply(a, 1, u, row);
    reduction_derivative_project(r, dk, dm, row, y);
    matrix_multiply(a, 1, du, row);
    reduction_project(r, row, column);
    cblas_daxpy(r->nc, 1, column, 1, y, 1);
    matrix_multiply(da, 1, u, row);
    reduction_project(r, row, column);
    cblas_daxpy(r->nc, 1, column, 1, y, 1);
}

void reduction_derivative_multiply(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x,
                                   double *kx, double *mx, double *work)
{
    double *u = work, *du = work + r->n, *row = du + r->n, *column = row + r->n;
    reduction_expand(r, x, u);
    reduction_derivative_expand(r, dk, dm, x, du);
    congruence_derivative(r, r->k, dk, dk, dm, u, du, kx, row, column);
    congruence_derivative(r, r->m, dm, dk, dm, u, du, mx, row, column);
}

double reduction_eigenvalue_derivative(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, double lambda,
                                       const double *x, const struct reduction_mode *mode)
{
    int n = r->n;
    matrix_multiply(dk, 1, mode->u, r->u2);
    matrix_multiply(dm, 1, mode->u, r->u3);
    double sum = cblas_ddot(n, mode->u, 1, r->u2, 1) - lambda * cblas_ddot(n, mode->u, 1, r->u3, 1);
    if (r->kind == ROTID_GUYAN) /* dT x = -S dK u, so that 2 g' dT x = -2 (S g)' dK u, and S g serves every parameter */
        return sum - 2 * cblas_ddot(n, mode->adjoint, 1, r->u2, 1);
    irs_derivative_expand(r, dk, dm, x, mode->scratch);
    return sum + 2 * cblas_ddot(n, mode->residual, 1, mode->scratch, 1);
}

void reduction_mode_prepare(struct reduction *r, double lambda, const double *x, struct reduction_mode *mode)
{
    reduction_expand(r, x, mode->u);
    matrix_multiply(r->k, 1, mode->u, mode->residual);
    matrix_multiply(r->m, 1, mode->u, r->u1);
    cblas_daxpy(r->n, -lambda, r->u1, 1, mode->residual, 1);
    if (r->kind == ROTID_GUYAN)
        slave_solve(r, mode->residual, mode->adjoint);
}

/* On the slave rows K u is zero. */
void reduction_adjoint(struct reduction *r, int count, const double *lambda, const double *u, double *adjoint, double *work)
{
    int n = r->n, ni = r->ni;
    matrix_multiply(r->m, count, u, adjoint);
    for (int j = 0; j < count; j++)
        for (int s = 0; s < ni; s++)
            work[s + (ptrdiff_t)j * ni] = -lambda[j] * adjoint[r->slave[s] + (ptrdiff_t)j * n];
    factor_solve(&r->factor, count, work);
    memset(adjoint, 0, (size_t)n * (size_t)count * sizeof(double));
    for (int j = 0; j < count; j++)
        for (int s = 0; s < ni; s++)
            adjoint[r->slave[s] + (ptrdiff_t)j * n] = work[s + (ptrdiff_t)j * ni];
}
