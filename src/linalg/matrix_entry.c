/* Matrices of a host: entries where its structure has a place for them, the dense matrix they stand for, products. */
#include <stdint.h>

#include "linalg/matrix.h"
#include "linalg/matrix_check.h"

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

int rotid_matrix_add(rotid_matrix *a, int i, int j, double value)
{
    if (!matrix_is_valid(a) || !has_place(a, i, j))
        return ROTID_ERROR_ARGUMENT;
    matrix_add(a, i, j, value);
    return ROTID_OK;
}

int rotid_matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e)
{
    if (!matrix_is_valid(a) || nd < 1 || !dof || !e)
        return ROTID_ERROR_ARGUMENT;
    for (int q = 0; q < nd; q++)
        for (int p = q; p < nd; p++)
            if (dof[p] >= a->n || dof[q] >= a->n || (dof[p] >= 0 && dof[q] >= 0 && !has_place(a, dof[p], dof[q])))
                return ROTID_ERROR_ARGUMENT;
    for (int q = 0; q < nd; q++)
        for (int p = q; p < nd; p++)
            if (dof[p] >= 0 && dof[q] >= 0) /* two places of the element on one degree of freedom: both of its entries */
                matrix_add(a, dof[p], dof[q], (p != q && dof[p] == dof[q] ? 2 : 1) * e[p + (ptrdiff_t)q * nd]);
    return ROTID_OK;
}

int rotid_matrix_set_dense(rotid_matrix *a, const double *full, int ld)
{
    if (!matrix_is_valid(a) || !full || ld < a->n)
        return ROTID_ERROR_ARGUMENT;
    for (int j = 0; j < a->n; j++)
        for (int i = j + a->kd + 1; i < a->n; i++)
            if (full[i + (ptrdiff_t)j * ld] != 0 && !has_place(a, i, j))
                return ROTID_ERROR_ARGUMENT;
    matrix_zero(a);
    for (int j = 0; j < a->n; j++)
        for (int i = j; i < a->n; i++)
            if (full[i + (ptrdiff_t)j * ld] != 0)
                matrix_add(a, i, j, full[i + (ptrdiff_t)j * ld]);
    return ROTID_OK;
}

int rotid_matrix_get_dense(const rotid_matrix *a, double *full, int ld)
{
    if (!matrix_is_valid(a) || !full || ld < a->n)
        return ROTID_ERROR_ARGUMENT;
    matrix_to_dense(a, ld, full);
    return ROTID_OK;
}

int rotid_matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y)
{
    if (!matrix_is_valid(a) || columns < 1 || !x || !y)
        return ROTID_ERROR_ARGUMENT;
    uintptr_t of_x = (uintptr_t)x, of_y = (uintptr_t)y, bytes = (uintptr_t)a->n * (uintptr_t)columns * sizeof(double);
    if ((of_x < of_y ? of_y - of_x : of_x - of_y) < bytes)
        return ROTID_ERROR_ARGUMENT;
    matrix_multiply(a, columns, x, y);
    return ROTID_OK;
}
