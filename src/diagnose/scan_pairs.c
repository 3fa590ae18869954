/* Pairs of causes that the columns of one scan promise: two that hide each other stand first in no list of single ones.
 *
 * With unit columns a and b, r the residual, all projected, and rho = a'b, the amplitudes s, t within their bounds minimise
 * |r + s a + t b|^2 = |r|^2 + 2 s a'r + 2 t b'r + s^2 + t^2 + 2 rho s t; both free at s = -(a'r - rho b'r)/(1 - rho^2), t alike.
 */
#include "diagnose/diagnose.h"

#define THIN  32   /* columns of a candidate, over its places and widths */
#define ALIKE 0.98 /* |rho|, from which two columns are one */

struct chosen { /* a column [nrow] of the list */
    int item;
    double along; /* with r */
};

static double clamp(double x, double lower, double upper)
{
    return fmin(fmax(x, lower), upper);
}

/* Least of the quadratic where s is held at a bound or free: *s, *t, the drop. */
static double drop_at(const double along[2], double rho, double s, const double lower, const double upper, double *t)
{
    *t = clamp(-along[1] - rho * s, lower, upper);
    return -2 * s * along[0] - 2 * *t * along[1] - s * s - *t * *t - 2 * rho * s * *t;
}

/* Drop of chi2 by both, the amplitudes within the bounds of physics. */
static double drop_of_pair(const struct scan_item *a, const struct scan_item *b, const double along[2], double rho,
                           double amplitude[2])
{
    double free = -(along[0] - rho * along[1]) / (1 - rho * rho), most = -INFINITY, t,
           bound[2] = {a->lower * a->norm, a->upper * a->norm}, lower = b->lower * b->norm, upper = b->upper * b->norm;
    const double s[] = {clamp(free, bound[0], bound[1]), clamp(-along[0] - rho * lower, bound[0], bound[1]),
                        clamp(-along[0] - rho * upper, bound[0], bound[1])};
    for (int i = 0; i < 3; i++) {
        if (!isfinite(s[i]))
            continue;
        double drop = drop_at(along, rho, s[i], lower, upper, &t);
        if (!(drop > most))
            continue;
        most = drop;
        amplitude[0] = s[i] / a->norm;
        amplitude[1] = t / b->norm;
    }
    return most;
}

static int choose(const struct scan *scan, const struct scan_candidate *c, struct chosen *chosen)
{
    int count = 0, step = (c->count + THIN - 1) / THIN;
    for (int i = c->first; i < c->first + c->count && !c->suspect && c->state < 0; i++) {
        const double *column = scan->column + (ptrdiff_t)i * scan->nrow;
        if (scan->item[i].usable && ((i - c->first) % step == 0 || i == c->best))
            chosen[count++] = (struct chosen){i, product_dot(scan->nrow, column, scan->r)};
    }
    return count;
}

/* Keeps the list in order. */
static void enter(const struct scan_pair *pair, int most, int *count, struct scan_pair *list)
{
    int at = *count < most ? *count : most - 1;
    if (*count == most && !(pair->drop > list[at].drop))
        return;
    *count = *count < most ? *count + 1 : most;
    for (; at > 0 && list[at - 1].drop < pair->drop; at--)
        list[at] = list[at - 1];
    list[at] = *pair;
}

int scan_pairs(struct pool *pool, const struct scan *scan, int most, struct scan_pair *list, int *count)
{
    struct chosen *chosen = POOL_ARRAY(pool, struct chosen, (size_t)scan->ncandidate * (THIN + 1));
    int *first = POOL_ARRAY(pool, int, scan->ncandidate + 1), n = scan->nrow;
    *count = 0;
    if (!chosen || !first)
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c < scan->ncandidate; c++)
        first[c + 1] = first[c] + choose(scan, &scan->candidate[c], chosen + first[c]);
    for (int c = 0; c < scan->ncandidate; c++)
        for (int d = c + 1; d < scan->ncandidate; d++) {
            struct scan_pair best = {.drop = -INFINITY};
            for (int i = first[c]; i < first[c + 1]; i++)
                for (int j = first[d]; j < first[d + 1]; j++) {
                    struct scan_pair one = {{chosen[i].item, chosen[j].item}, {0, 0}, 0};
                    double along[2] = {chosen[i].along, chosen[j].along},
                           rho = product_dot(n, scan->column + (ptrdiff_t)one.item[0] * n,
                                             scan->column + (ptrdiff_t)one.item[1] * n);
                    if (fabs(rho) > ALIKE)
                        continue;
                    one.drop = drop_of_pair(&scan->item[one.item[0]], &scan->item[one.item[1]], along, rho, one.amplitude);
                    if (one.drop > best.drop)
                        best = one;
                }
            if (best.drop > 0)
                enter(&best, most, count, list);
        }
    return ROTID_OK;
}
