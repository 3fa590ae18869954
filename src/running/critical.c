#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "running/running.h"

#define HALVINGS 60
#define SLOW     1e-3  /* of the highest speed */
#define SAME     0.3   /* |u'v|^2 of a critical speed's mode in another machine */
#define CROSSED  1e-6  /* of the speed: what is left behind bisection */
#define JUMP     0.05  /* and with the jump of Im lambda there by loss factors */
#define ONE_MODE 0.8   /* and of one mode at two speeds of a bracket */
#define DIVERGED 24    /* halves of a step of speed */
#define ROUNDING 1e-12 /* of the largest entry of a matrix */
#define INSIDE   1e-6  /* of a step of speed: where the slopes at its ends are */
#define NEARER   0.5   /* of the distances from h W at the ends of a step: between them modes are followed that come nearer, */
#define SPLITS   8     /* in so many parts */
#define FINEST   256   /* steps at least through half a bracket, in the last attempt */

int critical_side(double h)
{
    return (h > 1) - (h < 1);
}

struct pair *track_at(const struct tracks *t, int mode, int speed)
{
    return &t->pair[(ptrdiff_t)mode * t->nspeed + speed];
}

static int grows(const struct pair *pair)
{
    return creal(pair->lambda) > GROWS * cabs(pair->lambda);
}

static int is_there(const struct pair *pair)
{
    return isfinite(creal(pair->lambda));
}

static int add_mode(struct pool *pool, const struct system *s, struct tracks *t, const struct pair *at, int speed)
{
    for (int i = 0; i < t->nspeed; i++) {
        struct pair *own = track_at(t, t->nmode, i);
        if (pair_new(pool, s->size, own))
            return ROTID_ERROR_MEMORY;
        own->lambda = NAN;
    }
    pair_copy(s->size, at, track_at(t, t->nmode, speed));
    t->nmode++;
    return ROTID_OK;
}

static int are_same(const struct system *s, const struct pair *a, const struct pair *b)
{
    return is_there(a) && is_there(b) && cabs(a->lambda - b->lambda) < 1e-8 * cabs(a->lambda) &&
           pair_likeness(s->size, a, b) > 0.9 * 0.9;
}

/* The mode that another one has run into, -1: none. */
static int twin_of(const struct system *s, const struct tracks *t, int mode, int speed)
{
    for (int m = 0; m < t->nmode; m++)
        if (m != mode && are_same(s, track_at(t, m, speed), track_at(t, mode, speed)))
            return m;
    return -1;
}

static void step(struct system *s, struct tracks *t, int mode, int from, int to, int least)
{
    struct pair *next = track_at(t, mode, to);
    if (!is_there(track_at(t, mode, from)))
        return;
    pair_copy(s->size, track_at(t, mode, from), next);
    if (pair_follow(s, t->speed[from], t->speed[to], least, next))
        next->lambda = NAN;
}

/* Modes first ... from one speed to the next. Where two loci come near each other a long step goes straight on and a short one
 * veers: where both then end in one, they take the same short steps. */
static void step_all(struct system *s, struct tracks *t, int first, int from, int to)
{
    for (int m = first; m < t->nmode; m++)
        step(s, t, m, from, to, 1);
    for (int least = 32; least <= 2048; least *= 8)
        for (int m = first; m < t->nmode; m++) {
            int twin = is_there(track_at(t, m, to)) ? twin_of(s, t, m, to) : -1;
            if (twin < 0)
                continue;
            step(s, t, m, from, to, least);
            step(s, t, twin, from, to, least);
        }
    for (int m = first; m < t->nmode; m++)
        if (is_there(track_at(t, m, to)) && twin_of(s, t, m, to) >= 0)
            track_at(t, m, to)->lambda = NAN;
}

/* With loss factors a pair without them is where the iteration begins. */
static int settle(struct system *s, double speed, struct pair *pair)
{
    system_at(s, speed);
    return pair_refine(s, speed, pair);
}

/* Whether a mode may grow: none does where stiffness and damping are positive (semi)definite and the stiffness is symmetric,
 * whatever the gyroscopic moments (Thomson, Tait). work [size^2]; loss factors act below w = W alone, where all modes are
 * followed. */
static int may_grow(struct system *s, double speed, double *work)
{
    int n = s->size;
    double largest = 0, skew = 0, most = 0;
    system_at(s, speed);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)n * n; i++) {
        largest = fmax(largest, fabs(s->stiff[i]));
        most = fmax(most, fabs(s->c[i]));
    }
    for (ptrdiff_t j = 0; j < n; j++)
        for (ptrdiff_t i = 0; i < n; i++)
            skew = fmax(skew, fabs(s->stiff[i + n * j] - s->stiff[j + n * i]));
    if (skew > ROUNDING * largest)
        return 1;
    memcpy(work, s->stiff, (size_t)n * (size_t)n * sizeof *work);
    if (cholesky_factor(n, work))
        return 1;
    for (ptrdiff_t j = 0; j < n; j++)
        for (ptrdiff_t i = 0; i < n; i++)
            work[i + n * j] = (s->c[i + n * j] + s->c[j + n * i]) / 2 + (i == j ? ROUNDING * most : 0);
    return most > 0 && cholesky_factor(n, work);
}

/* The speed from which a motion grows without whirl, which is there at `above` and not at `below`. */
static int find_divergence(struct pool *pool, struct system *s, struct pair *all, double below, double above, double *speed)
{
    int count, status = ROTID_OK;
    double real = 0;
    for (int half = 0; half < DIVERGED && !status; half++) {
        double middle = (below + above) / 2;
        status = pairs_all(pool, s, middle, &count, all, &real);
        *(real > 0 ? &above : &below) = middle;
    }
    *speed = above;
    return status;
}

/* Whether bearings change with the speed: a mode may then be overdamped at the first speed and at the last one, and be there
 * between. */
static int has_tables(const struct system *s)
{
    int any = 0;
    for (int i = 0; i < s->machine->nbearing; i++)
        any |= s->machine->bearing[i].film.count > 1 || s->machine->bearing[i].pedestal.count > 1;
    return any;
}

/* Modes that are not followed yet: those below `limit` at the last speed, with tables of bearings at the others too, those that
 * grow at any of them, and what grows without whirl. Of one above `limit` that grows in the upper half of the basis, which does
 * not tell what becomes of it, the frequency is kept. */
static int add_others(struct pool *pool, struct system *s, struct pair *all, double limit, struct tracks *t)
{
    double *work = POOL_ARRAY(pool, double, (size_t)s->size *(size_t)s->size), real;
    int count, status = work ? ROTID_OK : ROTID_ERROR_MEMORY, tables = has_tables(s);
    t->diverges = NAN;
    for (int i = (t->nspeed - 1) % 2; i < t->nspeed && !status; i += 2) { /* every second one, and the highest */
        int first = t->nmode, followed = tables || i == t->nspeed - 1, may = may_grow(s, t->speed[i], work);
        if (!followed && !may)
            continue;
        status = pairs_all(pool, s, t->speed[i], &count, all, &real);
        if (!status && may && real > 0 && isnan(t->diverges))
            status = find_divergence(pool, s, all, t->speed[i > 1 ? i - 2 : 0], t->speed[i], &t->diverges);
        for (int j = 0; j < count && !status && t->nmode < t->room; j++) {
            int below = followed && cimag(all[j].lambda) < limit, known = !below && !grows(&all[j]);
            known = known || settle(s, t->speed[i], &all[j]) || (!below && !grows(&all[j]));
            if (!known && !below && cimag(all[j].lambda) > s->highest / 2) {
                t->beyond = fmax(t->beyond, cimag(all[j].lambda));
                known = 1;
            }
            for (int m = 0; m < t->nmode && !known; m++)
                known = are_same(s, track_at(t, m, i), &all[j]);
            status = known ? ROTID_OK : add_mode(pool, s, t, &all[j], i);
        }
        for (int k = i; first < t->nmode && k > 0 && !status; k--)
            step_all(s, t, first, k, k - 1);
        for (int k = i; first < t->nmode && k + 1 < t->nspeed && !status; k++)
            step_all(s, t, first, k, k + 1);
    }
    return status;
}

int tracks_make(struct pool *pool, struct system *s, int nspeed, const double *speed, double limit, struct tracks *t)
{
    int count, last = nspeed - 1;
    struct pair *all = POOL_ARRAY(pool, struct pair, s->size);
    *t = (struct tracks){.nspeed = nspeed, .room = s->size};
    t->speed = POOL_COPY(pool, speed, nspeed, 0);
    t->pair = POOL_ARRAY(pool, struct pair, (size_t)nspeed * (size_t)s->size);
    if (!all || !t->speed || !t->pair)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < s->size; i++)
        if (pair_new(pool, s->size, &all[i]))
            return ROTID_ERROR_MEMORY;
    int status = pairs_all(pool, s, speed[0], &count, all, NULL);
    for (int i = 0; i < count && !status; i++) {
        if (cimag(all[i].lambda) > limit && t->nmode >= 6)
            break;
        /* near standstill two modes are nearly one: the vectors of pairs_all tell them apart, an iteration does not */
        if ((s->hysteretic || speed[0] > SLOW * speed[last]) && settle(s, speed[0], &all[i]))
            continue;
        status = add_mode(pool, s, t, &all[i], 0);
    }
    for (int i = 0; i < last && !status; i++)
        step_all(s, t, 0, i, i + 1);
    return status ? status : add_others(pool, s, all, limit, t);
}

ORDER_BY(by_speed, struct critical, it->speed, 0)

/* Newton from a speed within the bracket of a crossing: 0 where it ends in the bracket, at the mode that it began with. */
static int newton(struct system *s, double h, double below, double above, const struct pair *from, double *speed, struct pair *to)
{
    pair_copy(s->size, from, to);
    return pair_synchronise(s, h, speed, to) || !(*speed >= below * (1 - 1e-9) && *speed <= above * (1 + 1e-9)) ||
           !(pair_likeness(s->size, from, to) > ONE_MODE);
}

/* The crossing on the way between two speeds, up or down, of the mode at the first: by halves where Newton leaves the bracket or
 * the mode. */
static int cross(struct system *s, double from, double to, double h, int least, struct critical *c, struct pair near)
{
    double below = from, above = to, low = fmin(from, to), high = fmax(from, to), at = from,
           sign = cimag(c->pair.lambda) - h * from;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = (below + above) / 2;
        if (pair_follow(s, at, middle, i < 16 && least >> i > 1 ? least >> i : 1, &c->pair))
            return 1;
        at = middle;
        if ((cimag(c->pair.lambda) - h * middle) * sign > 0)
            below = middle;
        else
            above = middle;
        if (i == 1 || i % 8 == 7) {
            c->speed = middle;
            /* a loss factor makes Im lambda jump at the crossing: it may lie outside of the bracket of either side */
            if (!newton(s, h, s->hysteretic ? low * (1 - JUMP) : fmin(below, above),
                        s->hysteretic ? high * (1 + JUMP) : fmax(below, above), &c->pair, &c->speed, &near)) {
                pair_copy(s->size, &near, &c->pair);
                system_at(s, c->speed);
                return pair_left(s, critical_side(h), &c->pair);
            }
        }
    }
    c->speed = (below + above) / 2;
    return !(fabs(cimag(c->pair.lambda) - h * c->speed) < (s->hysteretic ? JUMP : CROSSED) * h * c->speed); /* two modes */
}

/* Whether that mode has it: a jump may end in the next interval. */
static int is_known(int count, const struct critical *all, const struct critical *c)
{
    int any = 0;
    for (int i = 0; i < count; i++)
        any |= all[i].mode == c->mode && fabs(all[i].speed - c->speed) < 1e-9 * c->speed;
    return any;
}

/* Whether another mode has it. */
static int is_taken(const struct system *s, int count, const struct critical *all, const struct critical *c)
{
    for (int i = 0; i < count; i++)
        if (fabs(all[i].speed - c->speed) < 1e-9 * c->speed && are_same(s, &all[i].pair, &c->pair))
            return 1;
    return 0;
}

/* A mode above h times the speed that is overdamped at the next speed has crossed it where Im lambda fell to 0 between: *from and
 * *to := speeds before and behind that, with the mode at *from in pair. 0, or 1 where it is lost first. */
static int bracket_fall(struct system *s, double h, double *from, double *to, struct pair *pair, struct pair *near)
{
    for (int half = 0; half < DIVERGED; half++) {
        double middle = (*from + *to) / 2;
        pair_copy(s->size, pair, near);
        if (pair_follow(s, *from, middle, 1, near)) {
            *to = middle;
            continue;
        }
        if (cimag(near->lambda) <= h * middle) {
            *to = middle;
            return 0;
        }
        pair_copy(s->size, near, pair);
        *from = middle;
    }
    return 1;
}

/* The crossing of a mode that is there at `from` alone, not at `to`. 0, or 1 where there is none. */
static int cross_to_rest(struct system *s, double from, double to, double h, struct critical *c, struct pair near)
{
    return cimag(c->pair.lambda) <= h * from || bracket_fall(s, h, &from, &to, &c->pair, &near) ||
           cross(s, from, to, h, 1, c, near);
}

/* Of a mode on one side of h W at both speeds, where Im lambda - h W comes nearest to 0 between, by the cubic of values and
 * slopes. NAN where that is at an end, or hardly nearer than there. A table of bearings may bend at either speed: slopes within.
 */
static double nearest_between(struct system *s, double h, double from, const struct pair *a, double to, const struct pair *b)
{
    double apart = to - from, first = cimag(a->lambda) - h * from, last = cimag(b->lambda) - h * to, side = first > 0 ? 1 : -1;
    system_at(s, from + INSIDE * apart);
    double falls = -side * (cimag(pair_rate(s, a)) - h) * apart;
    system_at(s, to - INSIDE * apart);
    double rises = side * (cimag(pair_rate(s, b)) - h) * apart;
    first *= side;
    last *= side;
    if (!(falls > 0 && rises > 0))
        return NAN;
    double cubic = rises - falls + 2 * (first - last), square = 3 * (last - first) + 2 * falls - rises;
    double root = sqrt(square * square + 3 * cubic * falls), t = falls / (square + root);
    return first + t * (-falls + t * (square + t * cubic)) < NEARER * fmin(first, last) ? from + t * apart : (double)NAN;
}

struct crossings {
    struct pool *pool;
    struct system *system;
    double h;
    struct pair near;
    int least; /* steps through half a bracket */
    int count;
    struct critical *critical;
    int lost; /* crossings that were not found, or that another mode has */
};

/* The crossings of mode m between two speeds. Where the mode may come to h W and turn back it is followed to where it turns. */
static int find_between(struct crossings *all, int m, int splits, double from, const struct pair *a, double to,
                        const struct pair *b)
{
    struct system *s = all->system;
    double h = all->h, turn = NAN;
    int both = is_there(a) && is_there(b);
    if (!is_there(a) && !is_there(b))
        return ROTID_OK;
    if (both && (cimag(a->lambda) - h * from) * (cimag(b->lambda) - h * to) > 0) {
        turn = splits ? nearest_between(s, h, from, a, to, b) : NAN;
        if (!(turn > from && turn < to))
            return ROTID_OK;
    }
    struct critical c = {.mode = m};
    if (pair_new(all->pool, s->size, &c.pair) || (!all->near.u && pair_new(all->pool, s->size, &all->near)))
        return ROTID_ERROR_MEMORY;
    if (!isnan(turn)) {
        pair_copy(s->size, a, &c.pair);
        if (pair_follow(s, from, turn, 1, &c.pair)) {
            all->lost++;
            return ROTID_OK;
        }
        int status = find_between(all, m, splits - 1, from, a, turn, &c.pair);
        return status ? status : find_between(all, m, splits - 1, turn, &c.pair, to, b);
    }
    if (!both) {
        pair_copy(s->size, is_there(a) ? a : b, &c.pair);
        if (!cross_to_rest(s, is_there(a) ? from : to, is_there(a) ? to : from, h, &c, all->near) &&
            !is_taken(s, all->count, all->critical, &c) && POOL_ADD(all->pool, all->critical, all->count, &c))
            return ROTID_ERROR_MEMORY;
        return ROTID_OK;
    }
    int known = 0, found = 0;
    for (int back = 0; back < 2 && !found; back++) {
        pair_copy(s->size, back ? b : a, &c.pair);
        found = !cross(s, back ? to : from, back ? from : to, h, all->least, &c, all->near);
        known = found && is_known(all->count, all->critical, &c);
        found = found && (known || !is_taken(s, all->count, all->critical, &c));
    }
    all->lost += !found;
    return found && !known && POOL_ADD(all->pool, all->critical, all->count, &c) ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* A long step may go straight on from one locus to another one where short ones veer, and end at the crossing of the other: the
 * modes that cross between two speeds then all take shorter ones. */
int criticals_find(struct pool *pool, struct system *s, const struct tracks *t, double h, int *count, struct critical **critical,
                   double *missed)
{
    struct crossings all = {.pool = pool, .system = s, .h = h};
    int status = ROTID_OK;
    *missed = NAN;
    for (int i = 0; i + 1 < t->nspeed && !status; i++) {
        int before = all.count;
        all.lost = 1;
        for (all.least = 1; all.least <= FINEST && all.lost && !status; all.least *= 16) {
            all.count = before;
            all.lost = 0;
            for (int m = 0; m < t->nmode && !status; m++)
                status = find_between(&all, m, SPLITS, t->speed[i], track_at(t, m, i), t->speed[i + 1], track_at(t, m, i + 1));
        }
        *missed = all.lost ? fmin(*missed, t->speed[i]) : *missed;
    }
    if (all.count)
        qsort(all.critical, (size_t)all.count, sizeof *all.critical, by_speed);
    *count = all.count;
    *critical = all.critical;
    return status;
}

double critical_rate(struct system *nominal, struct system side[2], double apart, double h, const struct critical *c,
                     double complex *work)
{
    double complex rate = pair_difference(nominal, side, apart, c->speed, critical_side(h), &c->pair, work);
    return cimag(rate) / (h - cimag(pair_rate(nominal, &c->pair)));
}

int critical_carry(const struct system *from, const struct critical *near, double h, struct system *s, struct critical *to)
{
    struct pair start = s->spare[0];
    int lost = system_transfer(from, &near->pair, s, &start);
    pair_copy(s->size, &start, &to->pair);
    to->mode = near->mode;
    to->pair.lambda = creal(near->pair.lambda) + I * h * to->speed;
    lost = lost || pair_synchronise(s, h, &to->speed, &to->pair) || pair_likeness(s->size, &start, &to->pair) < SAME;
    if (lost)
        to->speed = NAN;
    return lost;
}

/* The step from decay to growth may be a jump where w = W: by halves. */
double onset_find(struct system *s, const struct tracks *t, int *mode)
{
    struct pair now = s->spare[1]; /* pair_follow has the other one */
    double lowest = t->diverges;
    *mode = -1;
    for (int m = 0; m < t->nmode; m++) {
        int i = 0;
        while (i < t->nspeed && !(is_there(track_at(t, m, i)) && grows(track_at(t, m, i))))
            i++;
        if (i == t->nspeed || t->speed[i > 0 ? i - 1 : 0] > lowest)
            continue;
        double below = t->speed[i > 0 ? i - 1 : 0], above = t->speed[i], at = above;
        pair_copy(s->size, track_at(t, m, i), &now);
        for (int half = 0; half < HALVINGS && above - below > 1e-12 * above && i > 0; half++) {
            double middle = (below + above) / 2;
            if (pair_follow(s, at, middle, 1, &now))
                break;
            at = middle;
            if (grows(&now))
                above = middle;
            else
                below = middle;
        }
        if (!(above > lowest)) {
            lowest = above;
            *mode = m;
        }
    }
    return lowest;
}
