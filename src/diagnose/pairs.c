#include "diagnose/pairs.h"

#include <math.h>

#include "diagnose/decide.h"
#include "linalg/product.h"

#define SAME  0.98 /* of two unit columns, their cosine squared: one of them does what both do */
#define APART 0.06 /* of the rotor's length: two places of one cause */

/* Largest drop of the unit columns i and j with product g, their steps within bounds; *u, *v: the steps. */
static double best_along_edge(double b_free, double b_fixed, double g, double fixed, double lower, double upper, double *step)
{
    *step = fmin(fmax(-(b_free + g * fixed), lower), upper);
    return -2 * (b_free * *step + b_fixed * fixed) - *step * *step - fixed * fixed - 2 * g * *step * fixed;
}

static double pair_drop(const struct scan_item *i, const struct scan_item *j, double b_i, double b_j, double g, double *u,
                        double *v)
{
    double lower[2] = {i->lower * i->norm, j->lower * j->norm}, upper[2] = {i->upper * i->norm, j->upper * j->norm};
    double rest = 1 - g * g, best = 0;
    *u = -(b_i - g * b_j) / rest;
    *v = -(b_j - g * b_i) / rest;
    if (*u >= lower[0] && *u <= upper[0] && *v >= lower[1] && *v <= upper[1])
        return -b_i * *u - b_j * *v;
    *u = *v = 0;
    for (int edge = 0; edge < 4; edge++) { /* a convex function of two steps: its least value lies on an edge of their box */
        int of_second = edge & 1;
        double fixed = edge & 2 ? upper[of_second] : lower[of_second], free;
        double drop = of_second ? best_along_edge(b_i, b_j, g, fixed, lower[0], upper[0], &free)
                                : best_along_edge(b_j, b_i, g, fixed, lower[1], upper[1], &free);
        if (drop > best) {
            best = drop;
            *u = of_second ? free : fixed;
            *v = of_second ? fixed : free;
        }
    }
    return best;
}

static int searched(const struct scan_candidate *c)
{
    int count = 0;
    for (int p = 0; p < cause_parameters(&c->effect); p++)
        count += !c->fixed[p];
    return count ? count : 1;
}

static double place_of(const struct scan *scan, int item)
{
    const struct scan_item *i = &scan->item[item];
    int place = scan->candidate[i->candidate].cause->place;
    return place < 0 ? NAN : i->effect.value[place];
}

/* Products of the columns of two candidates, from their first items on, [leading * ...]. */
struct products {
    const double *gram;
    int leading, from_first, from_second;
    int in_one_state; /* one of the two acts in one state alone, in which the other one acts too */
};

/* The best items of the candidates a and b together. */
static double best_items(const struct scan *scan, const struct products *p, const double *along, int a, int b, double apart,
                         struct scan_set *set)
{
    const struct scan_candidate *first = &scan->candidate[a], *second = &scan->candidate[b];
    int one = a == b || (p->in_one_state && first->cause == second->cause && first->effect.target == second->effect.target);
    double best = 0;
    for (int i = first->first; i < first->first + first->count; i++)
        for (int j = a == b ? i + 1 : second->first; j < second->first + second->count; j++) {
            double g = p->gram[i - p->from_first + (ptrdiff_t)(j - p->from_second) * p->leading], u, v;
            if (!scan->item[i].usable || !scan->item[j].usable || g * g > SAME)
                continue;
            if (one && fabs(place_of(scan, i) - place_of(scan, j)) < apart)
                continue;
            double drop = pair_drop(&scan->item[i], &scan->item[j], along[i], along[j], g, &u, &v);
            if (drop <= best)
                continue;
            best = drop;
            *set = (struct scan_set){.count = 2,
                                     .candidate = {a, b},
                                     .item = {i, j},
                                     .amplitude = {u / scan->item[i].norm, v / scan->item[j].norm},
                                     .drop = drop};
        }
    return best;
}

/* A pair into the list of the best ones, which is kept in order. */
static void enter(const struct scan *scan, const struct scan_set *pair, int most, struct scan_set *set, int *count)
{
    double score =
        PARAMETER_PENALTY * (searched(&scan->candidate[pair->candidate[0]]) + searched(&scan->candidate[pair->candidate[1]])) -
        pair->drop;
    int at = *count < most ? (*count)++ : most;
    for (; at > 0; at--) {
        const struct scan_set *other = &set[at - 1];
        if (PARAMETER_PENALTY *
                    (searched(&scan->candidate[other->candidate[0]]) + searched(&scan->candidate[other->candidate[1]])) -
                other->drop <=
            score)
            break;
        if (at < most)
            set[at] = *other;
    }
    if (at < most)
        set[at] = *pair;
}

/* Whether a cause acts in one state, though others have its target. */
static int is_single(const struct scan *scan, int candidate)
{
    return scan->candidate[candidate].state >= 0;
}

/* The pair of a and b, if they make one, into the list. */
static void try_pair(const struct states *states, const struct scan *scan, const struct products *products, const double *along,
                     int a, int b, int most, struct scan_set *set, int *count)
{
    const struct rotor *rotor = &states->state[scan->candidate[a].home].job.rotor;
    struct scan_set pair = {0};
    int left = scan->dof - searched(&scan->candidate[a]) - searched(&scan->candidate[b]);
    if (left >= LEAST_RESIDUALS && scan_allows(states, scan, a, b) &&
        best_items(scan, products, along, a, b, APART * rotor_length(rotor), &pair) > 0)
        enter(scan, &pair, most, set, count);
}

/* Of causes that act in all states that have them, which stand first; the products are one matrix. */
static int choose_common(struct pool *pool, const struct states *states, const struct scan *scan, const double *along, int most,
                         struct scan_set *set, int *count)
{
    int n = 0, ncommon = 0;
    while (ncommon < scan->ncandidate && !is_single(scan, ncommon))
        n += scan->candidate[ncommon++].count;
    double *gram = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    if (!gram)
        return ROTID_ERROR_MEMORY;
    if (n)
        product_gram(n, scan->nrow, scan->column, gram);
    const struct products products = {gram, n, 0, 0, 0};
    for (int a = 0; a < ncommon; a++)
        for (int b = a; b < ncommon; b++)
            try_pair(states, scan, &products, along, a, b, most, set, count);
    return ROTID_OK;
}

/* Of causes of which one or both act in one state alone. There are many more of these, and the products of all of them would not
 * be worth their room: those of two candidates at a time. */
static int choose_single(struct pool *pool, const struct states *states, const struct scan *scan, const double *along, int most,
                         struct scan_set *set, int *count)
{
    size_t largest = 0;
    for (int a = 0; a < scan->ncandidate; a++)
        largest = (size_t)scan->candidate[a].count > largest ? (size_t)scan->candidate[a].count : largest;
    double *gram = POOL_ARRAY(pool, double, largest *largest);
    if (!gram)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a < scan->ncandidate; a++)
        for (int b = a; b < scan->ncandidate; b++) {
            const struct scan_candidate *first = &scan->candidate[a], *second = &scan->candidate[b];
            if (!(is_single(scan, a) || is_single(scan, b)) || !first->count || !second->count)
                continue;
            const struct products products = {gram, first->count, first->first, second->first,
                                              states_meet(states->nstate, first->in, second->in)};
            product_transposed(first->count, second->count, scan->nrow, scan->column + (ptrdiff_t)first->first * scan->nrow,
                               scan->column + (ptrdiff_t)second->first * scan->nrow, gram);
            try_pair(states, scan, &products, along, a, b, most, set, count);
        }
    return ROTID_OK;
}

int pairs_choose(struct pool *pool, const struct states *states, const struct scan *scan, int most, struct scan_set *set,
                 int *count)
{
    double *along = POOL_ARRAY(pool, double, scan->nitem);
    int single = 0;
    *count = 0;
    if (!along)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->nitem; i++)
        along[i] = product_dot(scan->nrow, scan->column + (ptrdiff_t)i * scan->nrow, scan->r);
    int status = choose_common(pool, states, scan, along, most, set, count);
    if (!status && states->nstate > 1)
        status = choose_single(pool, states, scan, along, most, set + *count, &single);
    *count += single;
    return status;
}

/* The candidate of a scan that is candidate c of another one, -1 where it has none. */
static int same_candidate(const struct scan *scan, const struct scan_candidate *c)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *own = &scan->candidate[i];
        if (own->cause == c->cause && own->effect.target == c->effect.target && own->effect.variant == c->effect.variant &&
            own->state == c->state && own->suspect == c->suspect)
            return i;
    }
    return -1;
}

/* The partners that promise most beside a cause, in score. */
static void enter_partners(const struct states *states, const struct scan *scan, struct scan *beside, struct scan_set from,
                           int most, struct scan_set *set, int *count)
{
    for (int entered = 0; entered < most;) {
        int best = -1;
        double score = 0;
        for (int i = 0; i < beside->ncandidate; i++) {
            double worth = scan_best_drop(beside, i) - PARAMETER_PENALTY * searched(&beside->candidate[i]);
            if (beside->candidate[i].best >= 0 && worth > score) {
                best = i;
                score = worth;
            }
        }
        if (best < 0)
            return;
        const struct scan_candidate *partner = &beside->candidate[best];
        const struct scan_item *item = &beside->item[partner->best];
        int a = from.candidate[0], b = same_candidate(scan, partner);
        beside->candidate[best].best = -1;
        if (b < 0 || !scan_allows(states, scan, a, b) ||
            scan->dof - searched(&scan->candidate[a]) - searched(&scan->candidate[b]) < LEAST_RESIDUALS)
            continue;
        from.candidate[1] = b;
        from.drop = item->drop;
        from.start[1] = item->effect;
        from.start[1].name = scan->candidate[b].effect.name;
        if (!scan->candidate[b].fixed[partner->cause->size])
            from.start[1].value[partner->cause->size] += item->amplitude * item->unit;
        set[(*count)++] = from;
        entered++;
    }
}

int pairs_beside(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                 const struct scan *scan, int candidate, const struct effect *effect, int most, struct scan_set *set, int *count)
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    struct pool scratch;
    struct states with;
    struct scan beside = {0};
    pool_open(&scratch, pool->allocator);
    int status = states_with_effect(&scratch, states, x, effect, c->cause, c->fixed, c->in, &with);
    double *start = POOL_ARRAY(&scratch, double, status ? 0 : with.nparameter);
    if (!status && !start)
        status = ROTID_ERROR_MEMORY;
    for (int p = 0; !status && p < with.nparameter; p++)
        start[p] = with.bounds[p].start;
    if (!status)
        status = scan_run(&scratch, &with, number, holdout, start, &beside);
    if (!status)
        enter_partners(states, scan, &beside, (struct scan_set){.count = 2, .candidate = {candidate}, .x = x, .start = {*effect}},
                       most, set, count);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* no such model: no partner */
}
