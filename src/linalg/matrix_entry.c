/* Matrices of a host: entries where its structure has a place for them, the dense matrix they stand for, products. */

#include "linalg/linalg.h"

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
