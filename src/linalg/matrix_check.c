#include "linalg/linalg.h"

#define ROUNDING 1e-10 /* of the largest entry of a block: two triangles that a host computes in different ways */

int indices_check(const char *name, int count, const int *index, int n, char *failure)
{
    if (count < 0 || count > n)
        return refuse(failure, "n%s is %d, expected 0 ... %d", name, count, n);
    if (count && !index)
        return refuse(failure, "%s is NULL, expected n%s = %d indices", name, name, count);
    for (int i = 0; i < count; i++) {
        if (index[i] < 0 || index[i] >= n)
            return refuse(failure, "%s[%d] is %d, expected 0 ... %d", name, i, index[i], n - 1);
        if (i && index[i] <= index[i - 1])
            return refuse(failure, "%s[%d] is %d behind %d, expected increasing numbers", name, i, index[i], index[i - 1]);
    }
    return ROTID_OK;
}

int matrix_check_structure(const char *name, const rotid_matrix *a, char *failure)
{
    if (!a)
        return refuse(failure, "%s is NULL, expected a matrix", name);
    if (a->n < 1)
        return refuse(failure, "%s->n is %d, expected 1 or more", name, a->n);
    if (a->kd < 0 || a->kd >= a->n)
        return refuse(failure, "%s->kd is %d, expected 0 ... %d (n - 1)", name, a->kd, a->n - 1);
    if (!a->band)
        return refuse(failure, "%s->band is NULL, expected (kd + 1) n = %lld entries", name, (a->kd + 1LL) * a->n);
    if (!a->nfar)
        return ROTID_OK;
    if (!a->block)
        return refuse(failure, "%s->block is NULL, expected nfar x nfar entries, nfar = %d", name, a->nfar);
    return indices_check("far", a->nfar, a->far, a->n, failure);
}

/* Where the entry stands that matrix_is_finite has seen. */
static int say_not_finite(const char *name, const rotid_matrix *a, char *failure)
{
    for (int j = 0; j < a->n; j++)
        for (int d = 0; d <= a->kd && j + d < a->n; d++)
            if (!isfinite(a->band[d + (ptrdiff_t)j * (a->kd + 1)]))
                return failure_say(failure, ROTID_ERROR_FINITE, "%s: entry (%d, %d) is %g, expected a number", name, j + d, j,
                                   a->band[d + (ptrdiff_t)j * (a->kd + 1)]);
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++)
            if (!isfinite(a->block[f + (ptrdiff_t)g * a->nfar]))
                return failure_say(failure, ROTID_ERROR_FINITE,
                                   "%s: block (%d, %d), entry (%d, %d) of the matrix, is %g, expected a number", name, f, g,
                                   a->far[f], a->far[g], a->block[f + (ptrdiff_t)g * a->nfar]);
    return ROTID_ERROR_FINITE;
}

int matrix_check_block(const char *name, const rotid_matrix *a, char *failure)
{
    double largest = largest_magnitude((ptrdiff_t)a->nfar * a->nfar, a->block);
    for (int g = 0; g < a->nfar; g++)
        for (int f = g + 1; f < a->nfar; f++) {
            double low = a->block[f + (ptrdiff_t)g * a->nfar], high = a->block[g + (ptrdiff_t)f * a->nfar];
            if (fabs(low - high) > ROUNDING * largest)
                return refuse(failure,
                              "%s: block (%d, %d) is %.10g and block (%d, %d) is %.10g, expected a symmetric block (entries "
                              "(%d, %d) and (%d, %d) of the matrix)",
                              name, f, g, low, g, f, high, a->far[f], a->far[g], a->far[g], a->far[f]);
        }
    return ROTID_OK;
}

int matrix_check_entries(const char *name, const rotid_matrix *a, char *failure)
{
    return matrix_is_finite(a) ? matrix_check_block(name, a, failure) : say_not_finite(name, a, failure);
}

static int check_alike(const char *name, const rotid_matrix *a, const char *first, const rotid_matrix *b, char *failure)
{
    if (a->n != b->n || a->kd != b->kd || a->nfar != b->nfar)
        return refuse(failure, "%s has n, kd, nfar %d, %d, %d, expected those of %s, %d, %d, %d", name, a->n, a->kd, a->nfar,
                      first, b->n, b->kd, b->nfar);
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] != b->far[f])
            return refuse(failure, "%s->far[%d] is %d, expected that of %s, %d", name, f, a->far[f], first, b->far[f]);
    return ROTID_OK;
}

int matrices_check(int count, const rotid_matrix *const *a, char *failure)
{
    static const char *const name[] = {"k", "m", "dk", "dm"};
    int status = ROTID_OK;
    for (int i = 0; i < count && !status; i++) {
        status = matrix_check_structure(name[i], a[i], failure);
        if (!status)
            status = check_alike(name[i], a[i], name[0], a[0], failure);
    }
    for (int i = 0; i < count && !status; i++)
        status = matrix_check_entries(name[i], a[i], failure);
    return status;
}
