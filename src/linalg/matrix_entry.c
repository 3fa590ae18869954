/* Matrices of a host: entries where its structure has a place for them, the dense matrix they stand for, products. */
#include <float.h>

#include "linalg/linalg.h"

/* The lowest eigenpairs of a host's matrices. */

#define LOW      0.01 /* of the highest eigenvalue, */
#define AS_PAIRS 1000 /* times rows and rounding of it: the residual of those below */

/* Whether K x - lambda M x of low pairs is rounding, each row over the root of its mass: an iteration with a shift far below many
 * eigenvalues that are zero takes what is 1e-8 of the highest one for one of them. */
static int are_pairs(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda,
                     const double *phi)
{
    double highest = highest_of(k, m), *kx = POOL_ARRAY(pool, double, k->n), *mx = POOL_ARRAY(pool, double, k->n);
    int good = kx && mx;
    for (int j = 0; j < count && good && lambda[j] < LOW * highest; j++) {
        double square = 0;
        matrix_multiply(k, 1, phi + (ptrdiff_t)j * k->n, kx);
        matrix_multiply(m, 1, phi + (ptrdiff_t)j * k->n, mx);
        for (int i = 0, f = 0; i < k->n; i++) {
            double rest = kx[i] - lambda[j] * mx[i];
            square += rest / diagonal_of(m, i, &f) * rest;
        }
        good = sqrt(square) <= AS_PAIRS * k->n * DBL_EPSILON * highest;
    }
    return good;
}

static int solve(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, double *lambda, double *phi)
{
    struct eigen_full e;
    int status = eigen_full_new(pool, k, count, &e);
    if (!status)
        status = eigen_full_solve(&e, k, m, lambda, phi);
    if (!status && !e.dense && !are_pairs(pool, k, m, count, lambda, phi))
        status = pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_EIGEN;
    /* The block iteration cannot count eigenvalues where more are equal than it has vectors. The dense solver does not mind. */
    if ((status != ROTID_ERROR_STIFFNESS && status != ROTID_ERROR_EIGEN) || e.dense || k->n > EIGEN_DENSE_MOST)
        return status;
    status = eigen_full_new_dense(pool, k, count, &e);
    return status ? status : eigen_full_solve(&e, k, m, lambda, phi);
}

static int check_pencil(const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda, const double *phi,
                        char *failure)
{
    const rotid_matrix *all[] = {k, m};
    int status = matrices_check(2, all, failure);
    if (status)
        return status;
    if (count < 1 || count > k->n)
        return refuse(failure, "count is %d, expected 1 ... %d (n)", count, k->n);
    if (!lambda || !phi)
        return refuse(failure, "%s is NULL, expected room for the result", lambda ? "phi" : "lambda");
    return ROTID_OK;
}

int rotid_eigenpairs(const rotid_matrix *k, const rotid_matrix *m, int count, const rotid_environment *environment, char *failure,
                     double *lambda, double *phi)
{
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check_pencil(k, m, count, lambda, phi, failure);
    if (!status)
        status = solve(&entry.scratch, k, m, count, lambda, phi);
    return entry_close(&entry, status);
}

/* Condensation of a host's matrices. */

static int check(int count, const rotid_matrix *const *a, int nmaster, const int *master, int kind, const double *k_out,
                 const double *m_out, char *failure)
{
    int status = matrices_check(count, a, failure);
    if (status)
        return status;
    if (nmaster < 1)
        return refuse(failure, "nmaster is %d, expected 1 ... %d (n)", nmaster, a[0]->n);
    if (kind != ROTID_GUYAN && kind != ROTID_IRS)
        return refuse(failure, "kind is %d, expected ROTID_GUYAN (%d) or ROTID_IRS (%d)", kind, ROTID_GUYAN, ROTID_IRS);
    if (!k_out || !m_out)
        return refuse(failure, "the %s to be written is NULL, expected room for nmaster x nmaster entries",
                      k_out ? "mass" : "stiffness");
    return indices_check("master", nmaster, master, a[0]->n, failure);
}

static int condense(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int nmaster, const int *master, int kind,
                    double *kc, double *mc, double *t)
{
    struct reduction r;
    ptrdiff_t square = (ptrdiff_t)nmaster * nmaster;
    int status = reduction_new(pool, kind, k, nmaster, master, &r);
    if (!status)
        status = reduction_compute(&r, k, m);
    if (status)
        return status;
    memcpy(kc, r.kc, (size_t)square * sizeof *kc);
    memcpy(mc, r.mc, (size_t)square * sizeof *mc);
    if (t)
        memcpy(t, r.t, (size_t)k->n * (size_t)nmaster * sizeof *t);
    /* entries near the ends of the doubles leave no numbers behind */
    int finite = all_finite(square, kc) && all_finite(square, mc) && all_finite((ptrdiff_t)k->n * nmaster, r.t);
    return finite ? ROTID_OK : ROTID_ERROR_FINITE;
}

int rotid_condense(const rotid_matrix *k, const rotid_matrix *m, int nmaster, const int *master, int kind,
                   const rotid_environment *environment, char *failure, double *kc, double *mc, double *t)
{
    const rotid_matrix *all[] = {k, m};
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check(2, all, nmaster, master, kind, kc, mc, failure);
    if (!status)
        status = condense(&entry.scratch, k, m, nmaster, master, kind, kc, mc, t);
    return entry_close(&entry, status);
}

/* Symmetric but for rounding */
static void symmetrise(int n, double *a)
{
    for (int j = 0; j < n; j++)
        for (int i = 0; i < j; i++)
            a[i + (ptrdiff_t)j * n] = a[j + (ptrdiff_t)i * n] = (a[i + (ptrdiff_t)j * n] + a[j + (ptrdiff_t)i * n]) / 2;
}

static int differentiate(struct pool *pool, const rotid_matrix *const *a, int nmaster, const int *master, int kind, double *dkc,
                         double *dmc)
{
    struct reduction r;
    int status = reduction_new(pool, kind, a[0], nmaster, master, &r);
    double *unit = POOL_ARRAY(pool, double, nmaster);
    double *work = POOL_ARRAY(pool, double, 3 * (size_t)a[0]->n + (size_t)nmaster);
    if (!status && (!unit || !work))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        status = reduction_compute(&r, a[0], a[1]);
    for (int c = 0; c < nmaster && !status; c++) {
        ptrdiff_t column = (ptrdiff_t)c * nmaster;
        unit[c] = 1;
        reduction_derivative_multiply(&r, a[2], a[3], unit, dkc + column, dmc + column, work);
        unit[c] = 0;
    }
    if (!status) {
        symmetrise(nmaster, dkc);
        symmetrise(nmaster, dmc);
    }
    ptrdiff_t square = (ptrdiff_t)nmaster * nmaster;
    return !status && !(all_finite(square, dkc) && all_finite(square, dmc)) ? ROTID_ERROR_FINITE : status;
}

int rotid_condense_derivative(const rotid_matrix *k, const rotid_matrix *m, const rotid_matrix *dk, const rotid_matrix *dm,
                              int nmaster, const int *master, int kind, const rotid_environment *environment, char *failure,
                              double *dkc, double *dmc)
{
    const rotid_matrix *all[] = {k, m, dk, dm};
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check(4, all, nmaster, master, kind, dkc, dmc, failure);
    if (!status)
        status = differentiate(&entry.scratch, all, nmaster, master, kind, dkc, dmc);
    return entry_close(&entry, status);
}

/* Does A(i, j) have a place? */
static int has_place(const rotid_matrix *a, int i, int j)
{
    if (i < 0 || j < 0 || i >= a->n || j >= a->n)
        return 0;
    if ((i > j ? i - j : j - i) <= a->kd)
        return 1;
    int found = 0;
    for (int f = 0; f < a->nfar; f++)
        found += a->far[f] == i || a->far[f] == j;
    return found == 2;
}

static int refuse_place(const rotid_matrix *a, int i, int j, char *failure)
{
    if (i < 0 || j < 0 || i >= a->n || j >= a->n)
        return refuse(failure, "there is no entry (%d, %d), expected indices of 0 ... %d", i, j, a->n - 1);
    return refuse(failure, "entry (%d, %d) lies outside the band, kd = %d, expected both %d and %d among the %d of a->far", i, j,
                  a->kd, i, j, a->nfar);
}

HOST_COMPUTES int add(rotid_matrix *a, int i, int j, double value, char *failure)
{
    int status = matrix_check_structure("a", a, failure);
    if (status)
        return status;
    if (!has_place(a, i, j))
        return refuse_place(a, i, j, failure);
    matrix_add(a, i, j, value);
    return ROTID_OK;
}

HOST_COMPUTES int add_element(rotid_matrix *a, int nd, const int *dof, const double *e, char *failure)
{
    int status = matrix_check_structure("a", a, failure);
    if (status)
        return status;
    if (nd < 1)
        return refuse(failure, "nd is %d, expected 1 or more", nd);
    if (!dof || !e)
        return refuse(failure, "%s is NULL, expected an array", dof ? "e" : "dof");
    for (int q = 0; q < nd; q++)
        for (int p = q; p < nd; p++) {
            if (dof[p] >= a->n)
                return refuse(failure, "dof[%d] is %d, expected at most %d (n - 1)", p, dof[p], a->n - 1);
            if (dof[p] >= 0 && dof[q] >= 0 && !has_place(a, dof[p], dof[q]))
                return refuse_place(a, dof[p], dof[q], failure);
        }
    for (int q = 0; q < nd; q++)
        for (int p = q; p < nd; p++)
            if (dof[p] >= 0 && dof[q] >= 0) /* two places of the element on one degree of freedom: both of its entries */
                matrix_add(a, dof[p], dof[q], (p != q && dof[p] == dof[q] ? 2 : 1) * e[p + (ptrdiff_t)q * nd]);
    return ROTID_OK;
}

static int check_dense(const rotid_matrix *a, const double *full, int ld, char *failure)
{
    int status = matrix_check_structure("a", a, failure);
    if (status)
        return status;
    if (!full)
        return refuse(failure, "full is NULL, expected an array");
    return ld < a->n ? refuse(failure, "ld is %d, expected at least %d (n)", ld, a->n) : ROTID_OK;
}

static int set_dense(rotid_matrix *a, const double *full, int ld, char *failure)
{
    int status = check_dense(a, full, ld, failure);
    if (status)
        return status;
    for (int j = 0; j < a->n; j++)
        for (int i = j + a->kd + 1; i < a->n; i++)
            if (full[i + (ptrdiff_t)j * ld] != 0 && !has_place(a, i, j))
                return refuse_place(a, i, j, failure);
    matrix_zero(a);
    for (int j = 0; j < a->n; j++)
        for (int i = j; i < a->n; i++)
            if (full[i + (ptrdiff_t)j * ld] != 0)
                matrix_add(a, i, j, full[i + (ptrdiff_t)j * ld]);
    return ROTID_OK;
}

static int multiply(const rotid_matrix *a, int columns, const double *x, double *y, char *failure)
{
    int status = matrix_check_structure("a", a, failure);
    if (!status)
        status = matrix_check_block("a", a, failure);
    if (status)
        return status;
    if (columns < 1)
        return refuse(failure, "columns is %d, expected 1 or more", columns);
    if (!x || !y)
        return refuse(failure, "%s is NULL, expected an array", x ? "y" : "x");
    uintptr_t of_x = (uintptr_t)x, of_y = (uintptr_t)y, bytes = (uintptr_t)a->n * (uintptr_t)columns * sizeof(double);
    if ((of_x < of_y ? of_y - of_x : of_x - of_y) < bytes)
        return refuse(failure, "x and y overlap, expected two arrays");
    matrix_multiply(a, columns, x, y);
    return ROTID_OK;
}

int rotid_matrix_add(rotid_matrix *a, int i, int j, double value, char *failure)
{
    struct host_arithmetic arithmetic;
    host_enter_arithmetic(&arithmetic);
    if (failure)
        *failure = 0;
    int status = add(a, i, j, value, failure);
    host_leave_arithmetic(&arithmetic);
    return status;
}

int rotid_matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e, char *failure)
{
    struct host_arithmetic arithmetic;
    host_enter_arithmetic(&arithmetic);
    if (failure)
        *failure = 0;
    int status = add_element(a, nd, dof, e, failure);
    host_leave_arithmetic(&arithmetic);
    return status;
}

int rotid_matrix_set_dense(rotid_matrix *a, const double *full, int ld, char *failure)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = set_dense(a, full, ld, failure);
    return entry_close(&entry, status);
}

int rotid_matrix_get_dense(const rotid_matrix *a, double *full, int ld, char *failure)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = check_dense(a, full, ld, failure);
    if (!status)
        status = matrix_check_block("a", a, failure);
    if (!status)
        matrix_to_dense(a, ld, full);
    return entry_close(&entry, status);
}

int rotid_matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y, char *failure)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = multiply(a, columns, x, y, failure);
    return entry_close(&entry, status);
}
