#include "export/triplets.h"

#include <stddef.h>

/* the first row beyond the last one that can have an entry in the column: in the band, then far ones */
static int row_after(const rotid_matrix *a, int row, int column)
{
    int next = row < column ? column : row + 1, end = column + a->kd;
    if (next <= end && next < a->n)
        return next;
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] >= next && a->far[f] > end)
            return a->far[f];
    return a->n;
}

static int far_place(const rotid_matrix *a, int dof)
{
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] == dof)
            return f;
    return -1;
}

static double entry(const rotid_matrix *a, int row, int column)
{
    if (row - column <= a->kd)
        return a->band[(row - column) + (ptrdiff_t)column * (a->kd + 1)];
    int i = far_place(a, row), j = far_place(a, column);
    return i < 0 || j < 0 ? 0 : a->block[i + (ptrdiff_t)j * a->nfar];
}

int triplet_next(const rotid_matrix *a, struct triplet *t)
{
    while (t->column < a->n) {
        t->row = row_after(a, t->row, t->column);
        if (t->row >= a->n) {
            t->column++;
            t->row = -1;
            continue;
        }
        t->value = entry(a, t->row, t->column);
        if (t->value != 0)
            return 1;
    }
    return 0;
}

long triplet_count(const rotid_matrix *a)
{
    long count = 0;
    for (struct triplet t = {.row = -1}; triplet_next(a, &t);)
        count++;
    return count;
}
