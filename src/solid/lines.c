#include "solid/lines.h"

#include <math.h>
#include <stdlib.h>

#define MOST_HALVINGS 64 /* from one end of an interval: no two doubles are further apart */

static int compare(const void *a, const void *b)
{
    double x = ((const struct stop *)a)->at, y = ((const struct stop *)b)->at;
    return (x > y) - (x < y);
}

int stops_merge(int nstop, struct stop *stop, double tolerance)
{
    int count = 0;
    qsort(stop, (size_t)nstop, sizeof *stop, compare);
    for (int i = 0; i < nstop; i++)
        if (count && stop[i].at - stop[count - 1].at <= tolerance) {
            struct stop *last = &stop[count - 1];
            if (stop[i].fine > 0 && (last->fine == 0 || stop[i].fine < last->fine))
                last->fine = stop[i].fine;
            if (stop[i].upto > 0 && (last->upto == 0 || stop[i].upto < last->upto))
                last->upto = stop[i].upto;
        } else {
            stop[count++] = stop[i];
        }
    return count;
}

/* Lines between two stops, both excluded, into x, or counted only where x is NULL: from each graded end elements that double as
 * long as both sides leave room for them, and even ones between. */
static int between(const struct stop *a, const struct stop *b, int multiple, double *x)
{
    double from[MOST_HALVINGS], to[MOST_HALVINGS], left = a->at, right = b->at;
    double l = a->fine > 0 ? fmin(a->fine, a->upto) : a->upto, r = b->fine > 0 ? fmin(b->fine, a->upto) : a->upto;
    int nleft = 0, nright = 0, count = 0;
    while (right - left > 1.5 * fmin(l, r) && nleft < MOST_HALVINGS && nright < MOST_HALVINGS && fmin(l, r) < a->upto) {
        if (l <= r) {
            left = from[nleft++] = left + l;
            l = fmin(2 * l, a->upto);
        } else {
            right = to[nright++] = right - r;
            r = fmin(2 * r, a->upto);
        }
    }
    int even = (int)ceil((right - left) / (multiple * fmin(l, r)) - 0.3);
    even = multiple * (even < 1 ? 1 : even);
    for (int i = 0; i < nleft; i++, count++)
        if (x)
            x[count] = from[i];
    for (int i = 1; i < even; i++, count++)
        if (x)
            x[count] = left + (right - left) * i / even;
    for (int i = nright - 1; i >= 0; i--, count++)
        if (x)
            x[count] = to[i];
    return count;
}

int lines_graded(struct pool *pool, int nstop, const struct stop *stop, int multiple, int *count, double **x)
{
    int total = nstop;
    for (int i = 0; i + 1 < nstop; i++)
        total += between(&stop[i], &stop[i + 1], multiple, NULL);
    *x = POOL_ARRAY(pool, double, total);
    if (!*x)
        return ROTID_ERROR_MEMORY;
    *count = 0;
    for (int i = 0; i < nstop; i++) {
        (*x)[(*count)++] = stop[i].at;
        if (i + 1 < nstop)
            *count += between(&stop[i], &stop[i + 1], multiple, *x + *count);
    }
    return ROTID_OK;
}
