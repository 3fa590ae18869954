#include "linalg/matrix_check.h"

#include <stddef.h>

#include "linalg/matrix.h"

int indices_increase(int count, const int *index, int n)
{
    if (count < 0 || count > n || (count && !index))
        return 0;
    for (int i = 0; i < count; i++)
        if (index[i] < 0 || index[i] >= n || (i && index[i] <= index[i - 1]))
            return 0;
    return 1;
}

int matrix_is_valid(const rotid_matrix *a)
{
    return a && a->n >= 1 && a->kd >= 0 && a->kd < a->n && a->band && indices_increase(a->nfar, a->far, a->n) &&
           (!a->nfar || a->block);
}

static int is_alike(const rotid_matrix *a, const rotid_matrix *b)
{
    if (a->n != b->n || a->kd != b->kd || a->nfar != b->nfar)
        return 0;
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] != b->far[f])
            return 0;
    return 1;
}

int matrices_check(int count, const rotid_matrix *const *a)
{
    for (int i = 0; i < count; i++)
        if (!matrix_is_valid(a[i]) || !is_alike(a[i], a[0]))
            return ROTID_ERROR_ARGUMENT;
    for (int i = 0; i < count; i++)
        if (!matrix_is_finite(a[i]))
            return ROTID_ERROR_FINITE;
    return ROTID_OK;
}
