#include "ema/ema.h"

#define EARLY          64 /* lines */
#define DEAD_SHARE     1e-3
#define TWIN_SHARE     1e-6
#define TWIN_FRAC      0.99999
#define TWIN_NOISE     5e-3
#define NOISY_RATIO    5
#define NOISY_LINES    5 /* a fifth of the band */
#define MISFIT_RATIO   3
#define LEAST_COHERENT 0.8

#define MOST_SQUARE 1e290 /* sums of squares over lines and channels have a double */

static int is_finite(const struct frf *frf, int first, int last)
{
    for (int i = first; i < last; i++)
        if (!(complex_square(frf->h[i]) < MOST_SQUARE) ||
            (frf->variance && !(frf->variance[i] >= 0))) /* INFINITY: the line says nothing */
            return 0;
    return 1;
}

/* Largest |H|, sum |H|^2; whether all values are the same */
static double largest(const struct frf *frf, int first, int last, double *power, int *constant)
{
    double most = 0;
    *power = 0;
    *constant = 1;
    for (int i = first; i < last; i++) {
        double size = complex_square(frf->h[i]);
        most = size > most ? size : most;
        *power += size;
        *constant = *constant && frf->h[i] == frf->h[first];
    }
    return sqrt(most);
}

/* power: sum |H|^2 of each */
static int is_duplicate(const struct frf *a, const struct frf *b, int first, int last, const double power[2], double noise_a,
                        double noise_b, double most)
{
    double apart = 0, aa = 0, bb = 0, re = 0, im = 0, share = TWIN_SHARE * most * (TWIN_SHARE * most);
    int separate = !(noise_a > TWIN_NOISE && noise_b > TWIN_NOISE && noise_a < 2 * noise_b && noise_b < 2 * noise_a);
    for (int i = first; i < last; i++) {
        if (i > first && (i - first) % EARLY == 0 && apart > share) {
            double seen = re * re + im * im;
            /* two channels in a thousand are alike: what differs shows at once */
            if (separate || (i == first + EARLY && seen < 0.99 * TWIN_FRAC * aa * bb))
                return 0;
            /* or no rest could make up for it */
            double rest = sqrt(fmax(power[0] - aa, 0) * fmax(power[1] - bb, 0)), best = sqrt(seen) + rest;
            if (best * best < 0.9999999 * TWIN_FRAC * power[0] * power[1])
                return 0;
        }
        double ar = creal(a->h[i]), ai = cimag(a->h[i]), br = creal(b->h[i]), bi = cimag(b->h[i]);
        double dr = ar - br, di = ai - bi, away = dr * dr + di * di;
        apart = away > apart ? away : apart;
        aa += ar * ar + ai * ai;
        bb += br * br + bi * bi;
        re += ar * br + ai * bi;
        im += ar * bi - ai * br;
    }
    return apart <= share || (!separate && re * re + im * im > TWIN_FRAC * aa * bb);
}

/* rms of noise over rms of signal; sum of coherence by |H|^2, NaN where there is none */
static void noise_of(const struct frf *frf, int first, int last, double power, double *noise, double *coherence)
{
    double sum = 0, coherent = 0;
    for (int i = first; i < last; i++) {
        sum += frf->variance && isfinite(frf->variance[i]) ? frf->variance[i] : 0;
        coherent += frf->coherence ? frf->coherence[i] * complex_square(frf->h[i]) : 0;
    }
    *noise = frf->variance && power > 0 ? sqrt(sum / power) : NAN;
    *coherence = frf->coherence && power > 0 ? coherent / power : NAN;
}

/* NOISY needs the ratio over the whole and on a fifth of the lines: a dip alone makes no noisy channel. */
static int is_noisy(const struct frf *frf, int first, int last, double noise, double usual)
{
    if (!(noise > NOISY_RATIO * usual))
        return 0;
    int bad = 0;
    for (int i = first; i < last; i++)
        bad += frf->variance[i] > NOISY_RATIO * usual * (NOISY_RATIO * usual) * complex_square(frf->h[i]);
    return bad * NOISY_LINES >= last - first;
}

int channels_check(struct pool *pool, const struct frf_set *set, int first, int last, struct ema_channel *channel, int *usable)
{
    double *most = POOL_ARRAY(pool, double, set->nfrf), *sorted = POOL_ARRAY(pool, double, set->nfrf);
    double *power = POOL_ARRAY(pool, double, set->nfrf);
    int *constant = POOL_ARRAY(pool, int, set->nfrf);
    if (!most || !sorted || !power || !constant)
        return ROTID_ERROR_MEMORY;
    size_t known = 0;
    for (int c = 0; c < set->nfrf; c++) {
        double coherence;
        const struct frf *f = &set->frf[c];
        channel[c] = (struct ema_channel){.response_node = f->response_node,
                                          .response_direction = f->response_direction,
                                          .reference_node = f->reference_node,
                                          .reference_direction = f->reference_direction,
                                          .averages = f->averages,
                                          .duplicate_of = -1,
                                          .fit = NAN,
                                          .noise = NAN};
        usable[c] = is_finite(&set->frf[c], first, last);
        if (!usable[c]) {
            channel[c].quality_flags = EMA_NOT_FINITE;
            continue;
        }
        most[c] = largest(&set->frf[c], first, last, &power[c], &constant[c]);
        noise_of(&set->frf[c], first, last, power[c], &channel[c].noise, &coherence);
        if (coherence < LEAST_COHERENT)
            channel[c].quality_flags |= EMA_LOW_COHERENCE;
        sorted[known++] = most[c];
    }
    double usual = median_of(known, sorted);
    known = 0;
    for (int c = 0; c < set->nfrf; c++) {
        if (usable[c] && (constant[c] || most[c] < DEAD_SHARE * usual || most[c] == 0)) {
            channel[c].quality_flags |= EMA_DEAD;
            usable[c] = 0;
        }
        if (usable[c] && !isnan(channel[c].noise))
            sorted[known++] = channel[c].noise;
    }
    usual = median_of(known, sorted);
    for (int c = 0; c < set->nfrf; c++) {
        if (!usable[c])
            continue;
        if (is_noisy(&set->frf[c], first, last, channel[c].noise, usual))
            channel[c].quality_flags |= EMA_NOISY;
        for (int d = 0; d < c && channel[c].duplicate_of < 0; d++)
            if (usable[d] && is_duplicate(&set->frf[d], &set->frf[c], first, last, (double[]){power[d], power[c]},
                                          channel[d].noise, channel[c].noise, fmax(most[c], most[d]))) {
                channel[c].duplicate_of = d;
                channel[c].quality_flags |= EMA_DUPLICATE;
            }
    }
    return ROTID_OK;
}

int channels_compare(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema *out)
{
    int n = last - first;
    double *left = POOL_ARRAY(pool, double, set->nfrf), *sorted = POOL_ARRAY(pool, double, set->nfrf);
    double complex *model = POOL_ARRAY(pool, double complex, n);
    if (!left || !sorted || !model)
        return ROTID_ERROR_MEMORY;
    size_t known = 0;
    for (int c = 0; c < set->nfrf; c++) {
        if (!usable[c])
            continue;
        const double complex *h = set->frf[c].h + first;
        double hh = 0, mm = 0, apart = 0;
        double complex hm = 0;
        ema_synthesise(out, set, c, n, set->frequency_hz + first, model);
        for (int i = 0; i < n; i++) {
            if (set->frequency_hz[first + i] <= 0)
                continue;
            double re = creal(h[i]), im = cimag(h[i]), to_re = creal(model[i]), to_im = cimag(model[i]);
            hh += complex_square(h[i]);
            mm += complex_square(model[i]);
            hm += CMPLX(re * to_re + im * to_im, re * to_im - im * to_re);
            apart += complex_square(h[i] - model[i]);
        }
        out->channel[c].fit = hh > 0 && mm > 0 ? cabs(hm) * cabs(hm) / (hh * mm) : 0;
        left[c] = hh > 0 ? sqrt(apart / hh) : 0;
        sorted[known++] = left[c];
    }
    double usual = median_of(known, sorted);
    for (int c = 0; c < set->nfrf; c++)
        /* below 1e-6 the difference is rounding */
        if (usable[c] && out->nmode && left[c] > MISFIT_RATIO * usual && left[c] > 1e-6)
            out->channel[c].quality_flags |= EMA_MISFIT;
    return ROTID_OK;
}
