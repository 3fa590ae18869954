/* The profile of one unknown of an explanation, t: a place z, or ln of a width w, uniform before the data. Fits with t held and
 * all else free tell what no normal about the best one does. At a step of the section chi2 has a kink, steep into one section and
 * flat in the other; where symmetry makes the first derivative of the residual vanish chi2 is of fourth order; at an end of the
 * rotor one side is missing; a narrow deep zone does what a wide shallow one does, a bent ridge of width and size.
 *
 *   interval   of 95 %: to where the root of the rise of chi2, which grows nearly in proportion to the distance, is 1.96 times
 *              that by which the intervals of the fit are widened, or the bound
 *   evidence   Z = mean over t of Z(t), each by laplace.c; f(t) = sqrt(ln Z_max - ln Z(t)) is linear between the fits, and beyond
 *              the last ones as steep as from the best one there: a stretch in which f goes from a to b has moments in s, 0 to 1,
 *                  M_k = length * integral of s^k e^{-f^2} ds
 *              in closed form. Stretches are halved until that changes nothing.
 *   moduli     mean and square of each linear in s: E m = sum m_a M_0 + (m_b - m_a) M_1, and so on
 *   valley     to where f is TAIL: minima inside are this one, those beyond are explanations of their own */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define NEAR    0.01 /* of the range: as near as an end is looked for, */
#define SAME    1e-6 /* and what is one value */
#define AGREES  0.15 /* of the distance that is looked for */
#define STEPS   7
#define HALVED  4   /* stretches */
#define SETTLED 0.1 /* of ln Z */
#define TAIL    2.0 /* f */
#define BEYOND  3   /* nodes on a side, where less */
#define FALLEN  1.2 /* is f at the end */
#define NODES   (2 * (STEPS + BEYOND) + 1 + HALVED)

struct node {
    double t, log_z, f;
    double *mean, *std; /* [nown] */
    double *x;          /* [n] */
};

struct profile {
    const struct profile_case *c;
    struct pool *pool;
    int p, logarithmic, count;
    double lower, upper, best, limit;
    struct node node[NODES]; /* with a fit and an evidence, in order */
};

static double value_of(const struct profile *profile, double t)
{
    return profile->logarithmic ? exp(t) : t;
}

/* The node nearest to t; there is one. Of two as near, as beside the middle of a stretch, the likelier one: rounding does not
 * decide where a fit begins. */
static int nearest(const struct profile *profile, double t)
{
    const struct node *node = profile->node;
    int at = 0;
    for (int i = 1; i < profile->count; i++) {
        double apart = fabs(node[i].t - t), least = fabs(node[at].t - t), tie = SAME * (profile->upper - profile->lower);
        if (apart < least - tie || (apart < least + tie && node[i].log_z > node[at].log_z))
            at = i;
    }
    return at;
}

/* Where the fit with the unknown held at t begins: at the nearest one there is, the best fit of all where that is as near. */
static const double *start_for(const struct profile *profile, double t)
{
    int at = profile->count ? nearest(profile, t) : -1;
    double tie = SAME * (profile->upper - profile->lower);
    return at < 0 || fabs(profile->best - t) <= fabs(profile->node[at].t - t) + tie ? profile->c->fit->x : profile->node[at].x;
}

/* The fit at t among the nodes. */
static int add_node(struct profile *profile, const struct states *held, const rotid_fit_result *fit, double t)
{
    const struct profile_case *c = profile->c;
    int n = c->fit->n, at = profile->count;
    double *room = POOL_ARRAY(profile->pool, double, 2 * (size_t)c->nown + (size_t)n);
    if (!room)
        return ROTID_ERROR_MEMORY;
    struct evidence one = {.mean = room, .std = room + c->nown};
    int status = evidence_of_fit(c->data, held, c->nown, fit, c->nmember, c->member, c->nfault, c->fault, NULL, &one);
    if (status || !isfinite(one.log_z))
        return status;
    struct node node = {.t = t, .log_z = one.log_z, .mean = one.mean, .std = one.std, .x = one.std + c->nown};
    for (int q = 0; q < n; q++)
        node.x[q] = q == profile->p ? value_of(profile, t) : fit->x[q - (q > profile->p)];
    for (; at > 0 && profile->node[at - 1].t > t; at--)
        profile->node[at] = profile->node[at - 1];
    profile->node[at] = node;
    profile->count++;
    return ROTID_OK;
}

/* *far := root of the rise of chi2 with the unknown held at t; INFINITY where there is no fit. */
static int look_at(struct profile *profile, double t, double *far)
{
    const struct profile_case *c = profile->c;
    struct pool scratch;
    struct states held;
    rotid_fit_result *fit = NULL;
    pool_open(&scratch, profile->pool->allocator);
    int status = states_hold(&scratch, c->states, start_for(profile, t), profile->p, value_of(profile, t), &held);
    if (!status)
        status = refit_states(&scratch, &held, c->number, c->holdout, c->environment, &fit);
    *far = status ? INFINITY : sqrt(fmax(0, fit->chi2 - c->fit->chi2));
    if (!status && c->data)
        status = add_node(profile, &held, fit, t);
    rotid_fit_free(fit);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The end on the side of `bound`, looked for from the fit's own, where that lies between. */
static int find_end(struct profile *profile, double bound, double own, double *end)
{
    double limit = profile->limit, t = profile->best, range = profile->upper - profile->lower, inside = t, outside = bound,
           near = 0, far = NAN, one = 0; /* far: of the bound or what is outside, once it is known */
    int between = fabs(own - t) > SAME * range && (own - t) * (bound - t) > 0 && fabs(own - t) < fabs(bound - t);
    double at = between ? own : bound;
    for (int i = 0; i < STEPS && fabs(outside - inside) > NEAR * range; i++) {
        int status = look_at(profile, at, &one);
        if (status)
            return status;
        if (fabs(one - limit) <= AGREES * limit || (one <= limit && at == bound)) {
            *end = at;
            return ROTID_OK;
        }
        if (one <= limit) {
            inside = at;
            near = one;
        } else {
            outside = at;
            far = one;
        }
        double share = isinf(far) ? 0.5 : (limit - near) / (far - near);
        at = isnan(far) ? bound : inside + fmin(fmax(share, 0.1), 0.9) * (outside - inside);
    }
    *end = outside;
    return ROTID_OK;
}

/* M_0 to M_2 of a stretch on which f goes from a to b. */
static void moments_of(double length, double a, double b, double m[3])
{
    double k = b - a, sum = sqrt(PI) / 2 * (erf(b) - erf(a)), fall = (exp(-a * a) - exp(-b * b)) / 2;
    if (fabs(k) < 1e-2) {
        for (int i = 0; i < 3; i++)
            m[i] = length * exp(-a * b) / (i + 1);
        return;
    }
    double square = (sum + a * exp(-a * a) - b * exp(-b * b)) / 2; /* integrals of 1, f and f^2 times e^{-f^2} df */
    m[0] = length * sum / k;
    m[1] = length * (fall - a * sum) / (k * k);
    m[2] = length * (square - 2 * a * fall + a * a * sum) / (k * k * k);
}

/* Stretch i: before node i, or behind the last one; *from, *to its nodes, one where it reaches to a bound. */
static void stretch(const struct profile *profile, int i, const struct node **from, const struct node **to, double m[3])
{
    const struct node *node = profile->node;
    int last = profile->count - 1;
    *from = &node[i > 0 ? i - 1 : 0];
    *to = &node[i > last ? last : i];
    if (i > 0 && i <= last) {
        moments_of((*to)->t - (*from)->t, (*from)->f, (*to)->f, m);
        return;
    }
    double beyond = i ? profile->upper - (*to)->t : (*from)->t - profile->lower, apart = fabs((*to)->t - profile->best),
           slope = apart > 0 ? (*to)->f / apart : 0;
    moments_of(beyond, (*to)->f, (*to)->f + slope * beyond, m);
}

/* Leaves the nodes between the ends of the interval, from the best fit outwards to the first one in the tail: what lies beyond is
 * another minimum. */
static void keep_valley(struct profile *profile, const double end[2])
{
    struct node *node = profile->node;
    int at = nearest(profile, profile->best), first = 0, last = profile->count - 1;
    for (int side = -1; side < 2; side += 2) {
        double most = node[at].log_z;
        int i = at;
        while (i + side >= 0 && i + side < profile->count && node[i].log_z > most - TAIL * TAIL &&
               (side < 0 ? node[i + side].t >= end[0] : node[i + side].t <= end[1])) {
            i += side;
            most = fmax(most, node[i].log_z);
        }
        *(side < 0 ? &first : &last) = i;
    }
    profile->count = last - first + 1;
    memmove(node, node + first, (size_t)profile->count * sizeof *node);
}

/* ln of the mean of Z over the range. */
static double mean_of_nodes(struct profile *profile)
{
    double best = -INFINITY, sum = 0, m[3];
    const struct node *from, *to;
    for (int i = 0; i < profile->count; i++)
        best = fmax(best, profile->node[i].log_z);
    for (int i = 0; i < profile->count; i++)
        profile->node[i].f = sqrt(best - profile->node[i].log_z);
    for (int i = 0; i <= profile->count; i++) {
        stretch(profile, i, &from, &to, m);
        sum += m[0];
    }
    return best + log(sum / (profile->upper - profile->lower));
}

/* Where Z has hardly fallen at an end of the interval, nodes beyond, until it has, or rises again towards another minimum. */
static int look_beyond(struct profile *profile, int side, double end[2])
{
    double bound = side ? profile->upper : profile->lower, unused;
    int status = ROTID_OK;
    for (int pass = 0; pass < BEYOND && !status; pass++) {
        const struct node *node = profile->node;
        int last = side ? profile->count - 1 : 0, peak = 0, before = profile->count;
        for (int i = 0; i < profile->count; i++)
            peak = node[i].log_z > node[peak].log_z ? i : peak;
        double from = node[last].t, log_z = node[last].log_z, step = fabs(from - node[peak].t),
               range = profile->upper - profile->lower;
        if (node[peak].log_z - log_z > FALLEN * FALLEN || fabs(bound - from) < NEAR * range)
            return ROTID_OK;
        step = fmax(step, NEAR * range);
        double t = side ? fmin(from + step, bound) : fmax(from - step, bound);
        status = look_at(profile, t, &unused);
        last = side ? profile->count - 1 : 0;
        if (status || profile->count == before || profile->node[last].log_z > log_z)
            break;
        end[side] = t;
    }
    if (!status)
        keep_valley(profile, end);
    return status;
}

/* ln of the mean, stretches between the ends halved, those that weigh most first, until that changes nothing. */
static int settle(struct profile *profile, double end[2], double *log_z)
{
    double before = INFINITY, unused, m[3];
    int status = ROTID_OK;
    keep_valley(profile, end);
    for (int side = 0; side < 2 && !status; side++)
        status = look_beyond(profile, side, end);
    *log_z = mean_of_nodes(profile);
    for (int pass = 0; pass < HALVED && !status && fabs(*log_z - before) > SETTLED; pass++) {
        double most = 0, at = NAN;
        for (int i = 1; i < profile->count; i++) {
            const struct node *from, *to;
            stretch(profile, i, &from, &to, m);
            if (m[0] > most && to->t - from->t > NEAR * (profile->upper - profile->lower)) {
                most = m[0];
                at = (from->t + to->t) / 2;
            }
        }
        if (isnan(at))
            break;
        status = look_at(profile, at, &unused);
        keep_valley(profile, end);
        before = *log_z;
        *log_z = mean_of_nodes(profile);
    }
    return status;
}

/* Where f reaches TAIL, from the best fit outwards, or the last node; the bound, where that is near. */
static double valley_end(const struct profile *profile, int side)
{
    const struct node *node = profile->node;
    int i = nearest(profile, profile->best);
    const struct node *before = &node[i];
    while (node[i].f < TAIL && i + side >= 0 && i + side < profile->count) {
        before = &node[i];
        i += side;
    }
    double bound = side < 0 ? profile->lower : profile->upper, share = (TAIL - before->f) / (node[i].f - before->f),
           end = node[i].f > TAIL && before->f < TAIL ? before->t + share * (node[i].t - before->t) : node[i].t;
    return fabs(end - bound) < NEAR * (profile->upper - profile->lower) ? bound : end;
}

/* A tail far out does not widen the normal that stands for all. */
static void average(struct profile *profile, struct evidence *out)
{
    const struct node *from, *to;
    for (int q = 0; q < profile->c->nown; q++) {
        double sum = 0, mean = 0, square = 0, m[3];
        for (int i = 0; i <= profile->count; i++) {
            stretch(profile, i, &from, &to, m);
            if (fmin(from->f, to->f) > TAIL)
                continue;
            double a = from->mean[q], d = to->mean[q] - a, va = from->std[q] * from->std[q], vb = to->std[q] * to->std[q];
            sum += m[0];
            mean += a * m[0] + d * m[1];
            square += (a * a + va) * m[0] + (2 * a * d + vb - va) * m[1] + d * d * m[2];
        }
        out->mean[q] = mean / sum;
        out->std[q] = sqrt(fmax(0, square / sum - out->mean[q] * out->mean[q]));
    }
}

int profile_unknown(struct pool *pool, const struct profile_case *c, int p, int logarithmic, struct evidence *out,
                    double valley[2])
{
    rotid_fit_result *fit = c->fit;
    double lower = c->states->bounds[p].lower, upper = c->states->bounds[p].upper, best = fmin(fmax(fit->x[p], lower), upper),
           end[2], own[2] = {fit->ci_lower[p], fit->ci_upper[p]}, log_z = -INFINITY, unused;
    struct profile profile = {.c = c,
                              .pool = pool,
                              .p = p,
                              .logarithmic = logarithmic,
                              .lower = logarithmic ? log(lower) : lower,
                              .upper = logarithmic ? log(upper) : upper,
                              .best = logarithmic ? log(best) : best,
                              .limit = sqrt(chi_square_limit(0.05, 1)) * fit->widened_by};
    int status = c->data ? look_at(&profile, profile.best, &unused) : ROTID_OK;
    for (int side = 0; side < 2 && !status; side++) {
        double one = logarithmic ? log(fmax(own[side], lower)) : own[side];
        status = find_end(&profile, side ? profile.upper : profile.lower, one, &end[side]);
    }
    if (status)
        return status;
    for (int side = 0; side < 2; side++)
        *(side ? &fit->ci_upper[p] : &fit->ci_lower[p]) = value_of(&profile, end[side]);
    if (!c->data || profile.count < 2)
        return ROTID_OK;
    status = settle(&profile, end, &log_z);
    if (status || !isfinite(log_z))
        return status;
    out->log_z = log_z;
    average(&profile, out);
    for (int side = 0; side < 2; side++)
        valley[side] = value_of(&profile, valley_end(&profile, side ? 1 : -1));
    fit->ci_lower[p] = fmax(fit->ci_lower[p], valley[0]); /* of another minimum between which and this one is no probability */
    fit->ci_upper[p] = fmin(fit->ci_upper[p], valley[1]);
    return ROTID_OK;
}
