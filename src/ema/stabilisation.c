#include "ema/stabilisation.h"
#include "ema/poles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ema/lscf.h"

#define TWO_PI      6.283185307179586
#define OVERDAMPED  0.2
#define LOOSER      4 /* damping of a track, over that of a stable pole */
#define GAP         2 /* orders that a track may advance at a time */
#define LEAST_TRACK 4
#define TRACK_SHARE 8 /* of the orders */
#define PICK_REACH  0.02

static double damping_of(double complex pole)
{
    return -creal(pole) / cabs(pole);
}

/* |a - b|/|b| of frequency and of damping */
static double frequency_change(double complex a, double complex b)
{
    return fabs(cabs(a) / cabs(b) - 1);
}

static double damping_change(double complex a, double complex b)
{
    return fabs(damping_of(a) / damping_of(b) - 1);
}

static void mark_stable(struct stabilisation *s, int i, double frequency_tolerance, double damping_tolerance)
{
    for (int k = s->first[i]; k < s->first[i + 1]; k++) {
        for (int j = i ? s->first[i - 1] : 0; i && j < s->first[i]; j++) {
            if (frequency_change(s->pole[k], s->pole[j]) > frequency_tolerance)
                continue;
            s->table[k].stable_frequency = 1;
            if (damping_of(s->pole[k]) > 0 && damping_change(s->pole[k], s->pole[j]) <= damping_tolerance)
                s->table[k].stable_damping = 1;
        }
    }
}

int stabilisation_compute(struct pool *pool, const struct ema_band *band, int order, double decay, double frequency_tolerance,
                          double damping_tolerance, int threads, struct stabilisation *out)
{
    int step = 2, norder = order / step;
    order = norder * step;
    *out = (struct stabilisation){.norder = norder, .step = step, .order = order};
    double *normal = POOL_ARRAY(pool, double, (size_t)(order + 1) * (size_t)(order + 1));
    double complex *raw = POOL_ARRAY(pool, double complex, (size_t)norder *(size_t)order);
    int *count = POOL_ARRAY(pool, int, norder);
    out->first = POOL_ARRAY(pool, int, norder + 1);
    if (!normal || !raw || !count || !out->first)
        return ROTID_ERROR_MEMORY;
    int status = lscf_normal_matrix(pool, band, order, threads, normal);
    if (status == ROTID_OK)
        status = lscf_poles(pool, band, order, step, normal, count, raw);
    if (status != ROTID_OK)
        return status;
    for (int i = 0; i < norder; i++)
        out->first[i + 1] = out->first[i] + count[i];
    out->npole = out->first[norder];
    out->pole = POOL_ARRAY(pool, double complex, out->npole);
    out->table = POOL_ARRAY(pool, struct ema_pole, out->npole);
    if (!out->pole || !out->table)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < norder; i++) {
        for (int k = 0; k < count[i]; k++) {
            double complex pole = raw[k + (ptrdiff_t)i * order], free = pole + decay;
            out->pole[out->first[i] + k] = pole;
            out->table[out->first[i] + k] = (struct ema_pole){
                .order = (i + 1) * step, .frequency_hz = cabs(free) / TWO_PI, .damping = damping_of(free), .mode = -1};
        }
        mark_stable(out, i, frequency_tolerance, damping_tolerance);
    }
    return ROTID_OK;
}

struct track {
    int begin, end, length; /* orders, number of poles */
    int taken;              /* pole of the order at hand */
    int last;               /* pole */
};

/* Distance of a pole from the end of a track in tolerances, or INFINITY. */
static double distance(const struct stabilisation *s, const struct track *track, int k, double frequency_tolerance,
                       double damping_tolerance)
{
    double complex end = s->pole[track->last];
    double df = frequency_change(s->pole[k], end) / frequency_tolerance;
    double dz = damping_change(s->pole[k], end) / (LOOSER * damping_tolerance);
    return df <= 1 && dz <= 1 ? df + dz : INFINITY;
}

/* Extends the tracks by the poles of order i, nearest pairs first; what is left over begins a track. Returns the number of
 * tracks. */
static int follow(const struct stabilisation *s, int i, double frequency_tolerance, double damping_tolerance, int ntrack,
                  struct track *track, int *owner)
{
    int begin = s->first[i], end = s->first[i + 1];
    for (int t = 0; t < ntrack; t++)
        track[t].taken = -1;
    for (;;) {
        double best = INFINITY;
        int best_track = -1, best_pole = -1;
        for (int k = begin; k < end; k++) {
            double zeta = damping_of(s->pole[k]);
            if (owner[k] >= 0 || !(zeta > 0 && zeta < OVERDAMPED))
                continue;
            for (int t = 0; t < ntrack; t++) {
                if (track[t].taken >= 0 || track[t].end < i - GAP)
                    continue;
                double d = distance(s, &track[t], k, frequency_tolerance, damping_tolerance);
                if (d < best) {
                    best = d;
                    best_track = t;
                    best_pole = k;
                }
            }
        }
        if (best_track < 0)
            break;
        owner[best_pole] = best_track;
        track[best_track].taken = track[best_track].last = best_pole;
        track[best_track].end = i;
        track[best_track].length++;
    }
    for (int k = begin; k < end; k++) {
        double zeta = damping_of(s->pole[k]);
        if (owner[k] < 0 && zeta > 0 && zeta < OVERDAMPED) {
            owner[k] = ntrack;
            track[ntrack++] = (struct track){.begin = i, .end = i, .length = 1, .last = k};
        }
    }
    return ntrack;
}

/* Tracks that end before another begins, at the same place, are one. */
static void join(const struct stabilisation *s, int ntrack, struct track *track, int *owner, double frequency_tolerance)
{
    for (int t = 0; t < ntrack; t++)
        for (int u = 0; u < ntrack; u++) {
            if (u == t || !track[u].length || !track[t].length || track[t].end >= track[u].begin)
                continue;
            double complex a = s->pole[track[t].last], b = s->pole[track[u].last];
            double width = 2 * fmax(fabs(creal(a)), fabs(creal(b)));
            if (cabs(a - b) > width || frequency_change(a, b) > frequency_tolerance)
                continue;
            for (int k = 0; k < s->npole; k++)
                if (owner[k] == t)
                    owner[k] = u;
            track[u].length += track[t].length;
            track[u].begin = track[t].begin;
            track[t].length = 0;
        }
}

int stabilisation_candidates(struct pool *pool, const struct stabilisation *table, double frequency_tolerance,
                             double damping_tolerance, int *count, double complex **pole)
{
    struct track *track = POOL_ARRAY(pool, struct track, table->npole);
    int *owner = POOL_ARRAY(pool, int, table->npole), ntrack = 0;
    *count = 0;
    *pole = POOL_ARRAY(pool, double complex, table->npole);
    if (!track || !owner || !*pole)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < table->npole; k++)
        owner[k] = -1;
    for (int i = 0; i < table->norder; i++)
        ntrack = follow(table, i, frequency_tolerance, damping_tolerance, ntrack, track, owner);
    join(table, ntrack, track, owner, frequency_tolerance);
    int least = table->norder / TRACK_SHARE > LEAST_TRACK ? table->norder / TRACK_SHARE : LEAST_TRACK;
    for (int t = 0; t < ntrack; t++) {
        if (track[t].length < least)
            continue;
        int skip = track[t].length / 2, taken = 0;
        double complex sum = 0;
        for (int k = 0; k < table->npole; k++)
            if (owner[k] == t && skip-- <= 0) {
                sum += table->pole[k];
                taken++;
            }
        (*pole)[(*count)++] = sum / taken;
    }
    sort_poles((size_t)*count, *pole);
    return ROTID_OK;
}

void stabilisation_picks(const struct stabilisation *table, int npick, const double *pick_hz, double complex *pole, int *unstable)
{
    for (int i = 0; i < npick; i++) {
        double best[2] = {INFINITY, INFINITY};
        int chosen[2] = {-1, -1};
        for (int k = table->npole - 1; k >= 0; k--) {
            const struct ema_pole *p = &table->table[k];
            int stable = p->stable_frequency && p->stable_damping;
            double away = fabs(cabs(table->pole[k]) / (TWO_PI * pick_hz[i]) - 1), zeta = damping_of(table->pole[k]);
            if (away > PICK_REACH || !(zeta > 0 && zeta < OVERDAMPED))
                continue;
            /* rounded up a little, so that the higher order wins among poles that agree */
            if (stable && away < 0.8 * best[0] - 1e-4) {
                best[0] = away;
                chosen[0] = k;
            }
            if (away < 0.8 * best[1] - 1e-4) {
                best[1] = away;
                chosen[1] = k;
            }
        }
        int k = chosen[0] >= 0 ? chosen[0] : chosen[1];
        unstable[i] = chosen[0] < 0;
        pole[i] = k >= 0 ? table->pole[k] : TWO_PI * pick_hz[i] * CMPLX(-0.01, 1);
    }
}

void stabilisation_assign(const struct stabilisation *table, int nmode, const double complex *pole, double frequency_tolerance,
                          double damping_tolerance)
{
    for (int k = 0; k < table->npole; k++) {
        double best = INFINITY;
        for (int r = 0; r < nmode; r++) {
            double df = frequency_change(table->pole[k], pole[r]) / frequency_tolerance;
            double dz = damping_change(table->pole[k], pole[r]) / (LOOSER * damping_tolerance);
            if (df <= 1 && dz <= 1 && df + dz < best) {
                best = df + dz;
                table->table[k].mode = r;
            }
        }
    }
}
