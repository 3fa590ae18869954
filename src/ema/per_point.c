#include "ema/ema.h"

#include <math.h>

#include "base/base.h"

#define SCATTER        3      /* standard deviations */
#define MEDIAN_STD     1.2533 /* of a median over that of a mean */
#define ALONE_WIDTHS   3
#define LESS           (2.0 / 3)
#define SCATTER_WIDTHS 0.02 /* half bandwidths: less changes a residue by less than a thousandth */

/* Standard deviation of what scatters normally, from the median distance to the median: a channel whose own fit went astray does
 * not count. sorted [known] is overwritten. */
static double robust_scatter(int known, double centre, double *sorted)
{
    for (int k = 0; k < known; k++)
        sorted[k] = fabs(sorted[k] - centre);
    return 1.4826 * median_of((size_t)known, sorted);
}

/* Scatter of the imaginary parts of the channels that know their pole, as it is and over their standard deviations. Returns the
 * number of those channels. */
static int scatter(int n, const struct local_pole *local, double *sorted, double *rms, double *chi)
{
    int known = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[known++] = cimag(local[k].pole);
    *rms = *chi = 0;
    if (known < 2)
        return known;
    double centre = median_of((size_t)known, sorted);
    *rms = robust_scatter(known, centre, sorted);
    known = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[known++] = (cimag(local[k].pole) - centre) / sqrt(fmax(local[k].covariance[3], 1e-300));
    *chi = robust_scatter(known, 0, sorted);
    return known;
}

/* Frequency and damping as medians of the channels, with the deviation of a median. */
static void median_frequency(int n, const struct local_pole *local, double decay, int known, double *sorted,
                             struct ema_mode *mode)
{
    struct ema_mode one;
    double centre[2], std[2];
    for (int which = 0; which < 2; which++) {
        int count = 0;
        for (int k = 0; k < n; k++)
            if (local[k].known) {
                modes_of_pole(local[k].pole + decay, NULL, &one);
                sorted[count++] = which ? one.damping : one.frequency_hz;
            }
        centre[which] = median_of((size_t)known, sorted);
        std[which] = MEDIAN_STD * robust_scatter(known, centre[which], sorted) / sqrt(known);
    }
    double w = 6.283185307179586 * centre[0];
    modes_of_pole(w * CMPLX(-centre[1], sqrt(1 - centre[1] * centre[1])), NULL, mode);
    mode->frequency_std = std[0];
    mode->damping_std = std[1];
}

static int take_local(struct pool *pool, const struct ema_band *band, const struct local_pole *local, double decay, int known,
                      double *sorted, struct ema *out, struct ema_mode *mode)
{
    mode->local_pole = POOL_ARRAY(pool, double complex, out->nfrf);
    if (!mode->local_pole)
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c < out->nfrf; c++)
        mode->local_pole[c] = CMPLX(NAN, NAN);
    for (int k = 0; k < band->nchannel; k++)
        if (local[k].known) {
            int c = band->channel[k];
            mode->local_pole[c] = local[k].pole + decay;
            mode->residue[c] = local[k].residue;
            mode->residue_std[c] = local[k].residue_std;
        }
    median_frequency(band->nchannel, local, decay, known, sorted, mode);
    return ROTID_OK;
}

/* Neither one pole for all nor one for each describes such a peak: a pole as other programs take it, deviations as they are. */
static int take_common(struct pool *pool, const struct ema_band *band, int nmode, const double complex *pole, int r, double decay,
                       struct ema_mode *mode)
{
    double complex common;
    double frequency_std = mode->frequency_std, damping_std = mode->damping_std;
    int status = local_common(pool, band, nmode, pole, r, &common);
    if (status != ROTID_OK || isnan(creal(common)))
        return status;
    modes_of_pole(common + decay, NULL, mode);
    mode->frequency_std = frequency_std;
    mode->damping_std = damping_std;
    return ROTID_OK;
}

static void take_points(const struct ema_band *band, const struct local_pole *local, double decay, const struct ema *out,
                        struct ema_mode *mode)
{
    for (int p = 0; p < out->npoint; p++) {
        double sum = 0, weight = 0;
        for (int k = 0; k < band->nchannel; k++) {
            struct ema_mode one;
            if (out->channel_point[band->channel[k]] != p || !local[k].known)
                continue;
            modes_of_pole(local[k].pole + decay, local[k].covariance, &one);
            double w = 1 / fmax(one.frequency_std * one.frequency_std, 1e-300);
            sum += w * one.frequency_hz;
            weight += w;
        }
        mode->point_frequency_hz[p] = weight > 0 ? sum / weight : NAN;
        mode->point_frequency_std[p] = weight > 0 ? 1 / sqrt(weight) : NAN;
    }
}

/* A mass that moves shifts a peak and leaves its width: where the widths disagree by more than half in a fifth of the channels,
 * something else is wrong with the peak, and one pole a channel would be no better. */
static int same_width(int n, const struct local_pole *local, int known, double *sorted)
{
    int count = 0, alike = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[count++] = -creal(local[k].pole) / cabs(local[k].pole);
    sort_doubles((size_t)known, sorted);
    double median = sorted[known / 2];
    for (int k = 0; k < known; k++)
        alike += fabs(sorted[k] / median - 1) < 0.5;
    return 5 * alike >= 4 * known;
}

/* One channel alone does not tell two modes that overlap apart. */
static int stands_alone(int nmode, const double complex *pole, int r)
{
    for (int s = 0; s < nmode; s++)
        if (s != r && fabs(cimag(pole[s]) - cimag(pole[r])) < ALONE_WIDTHS * 2 * fmax(fabs(creal(pole[s])), fabs(creal(pole[r]))))
            return 0;
    return 1;
}

/* Whether poles of their own explain the channels better; else the scatter is that of a local fit among neighbours. */
static int leaves_less(int n, const struct local_pole *local, const double *common)
{
    double together = 0, alone = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known) {
            together += common[k];
            alone += local[k].noise;
        }
    return alone < LESS * together;
}

struct channel { /* its own view of all modes, those beyond the band behind */
    int nmode;
    double complex *pole, *residue;
};

static void view(const struct ema *out, int c, double decay, struct channel *channel)
{
    for (int r = 0; r < channel->nmode; r++) {
        const struct ema_mode *mode = &out->mode[r];
        int own = mode->local_pole && !isnan(creal(mode->local_pole[c]));
        channel->pole[r] = (own ? mode->local_pole[c] : mode->pole) - decay;
        channel->residue[r] = mode->residue[c];
    }
}

struct work {
    struct pool *pool;
    const struct ema_band *band;
    double decay;
    const double *common, *gain;
    double complex *pole; /* [nmode + nguard] common ones */
    struct channel channel;
    struct local_pole *local; /* [nchannel] */
    double *sorted;           /* [nchannel] */
    struct ema *out;
};

/* One mode in every channel, and what follows. informed: the residues of all modes are known. */
static int one_mode(struct work *w, int informed, int r)
{
    const struct ema_band *band = w->band;
    struct ema *out = w->out;
    struct ema_mode *mode = &out->mode[r];
    double chi, rms;
    for (int k = 0; k < band->nchannel; k++) {
        view(out, band->channel[k], w->decay, &w->channel);
        w->channel.pole[r] = w->pole[r];
        int status =
            local_fit(w->pool, band, k, w->channel.nmode, w->channel.pole, informed ? w->channel.residue : NULL, r, &w->local[k]);
        if (status != ROTID_OK)
            return status;
        w->local[k].residue_std = hypot(w->local[k].residue_std, sqrt(w->gain[r]) * cabs(w->local[k].residue));
    }
    if (mode->point_frequency_hz)
        take_points(band, w->local, w->decay, out, mode);
    int known = scatter(band->nchannel, w->local, w->sorted, &rms, &chi);
    if (known < 2 || !stands_alone(out->nmode, w->pole, r) ||
        !leaves_less(band->nchannel, w->local, w->common + (ptrdiff_t)r * band->nchannel) || !(chi > SCATTER) ||
        !(rms > SCATTER_WIDTHS * fabs(creal(w->pole[r]))))
        return ROTID_OK;
    mode->quality_flags |= EMA_DOUBLE_PEAK;
    return same_width(band->nchannel, w->local, known, w->sorted)
               ? take_local(w->pool, band, w->local, w->decay, known, w->sorted, out, mode)
               : take_common(w->pool, band, out->nmode, w->pole, r, w->decay, mode);
}

/* L and U of a channel for poles of its own: least squares of what its modes leave, L - omega^2 U. */
static void refit_rest(struct work *w, int k)
{
    const struct ema_band *band = w->band;
    int c = band->channel[k];
    double one = 0, square = 0, fourth = 0, top = band->high * band->high;
    double complex left = 0, right = 0;
    view(w->out, c, w->decay, &w->channel);
    for (int i = 0; i < band->nline; i++) {
        ptrdiff_t at = i + (ptrdiff_t)k * band->nline;
        double weight = band->variance ? 1 / band->variance[at] : 1, x = -band->omega[i] * band->omega[i] / top;
        double complex s = I * band->omega[i], sum = 0;
        for (int r = 0; r < w->channel.nmode; r++)
            if (!isnan(creal(w->channel.residue[r])))
                sum += w->channel.residue[r] / (s - w->channel.pole[r]) +
                       conj(w->channel.residue[r]) / (s - conj(w->channel.pole[r]));
        double complex rest = band->h[at] - s * s * sum;
        one += weight;
        square += weight * x;
        fourth += weight * x * x;
        left += weight * rest;
        right += weight * x * rest;
    }
    double determinant = one * fourth - square * square;
    if (!(determinant > 1e-12 * one * fourth))
        return;
    w->out->lower[c] = (fourth * left - square * right) / determinant;
    w->out->upper[c] = (one * right - square * left) / determinant / top;
}

static int has_local(const struct ema *out)
{
    for (int r = 0; r < out->nmode; r++)
        if (out->mode[r].local_pole)
            return 1;
    return 0;
}

int per_point_frequencies(struct pool *pool, const struct ema_band *band, double decay, const int *suspect, const double *common,
                          const double *gain, const rotid_environment *environment, struct ema *out)
{
    int all = out->nmode + out->nguard;
    struct work w = {.pool = pool,
                     .band = band,
                     .decay = decay,
                     .common = common,
                     .gain = gain,
                     .pole = POOL_ARRAY(pool, double complex, all),
                     .channel = {all, POOL_ARRAY(pool, double complex, all), POOL_ARRAY(pool, double complex, all)},
                     .local = POOL_ARRAY(pool, struct local_pole, band->nchannel),
                     .sorted = POOL_ARRAY(pool, double, band->nchannel),
                     .out = out};
    if (!w.local || !w.pole || !w.sorted || !w.channel.pole || !w.channel.residue)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < all; r++)
        w.pole[r] = out->mode[r].pole - decay;
    /* twice: the first time the other modes are known by poles that do not suit the channel */
    for (int informed = 0; informed < 2; informed++)
        for (int r = 0; r < out->nmode; r++) {
            if (!suspect[r] && !out->mode[r].point_frequency_hz)
                continue;
            if (environment && environment->cancelled && environment->cancelled(environment->context))
                return ROTID_STOP_CANCELLED;
            if (environment && environment->progress)
                environment->progress(environment->context, "frequency of each point", r);
            int status = one_mode(&w, informed, r);
            if (status != ROTID_OK)
                return status;
        }
    for (int k = 0; k < band->nchannel && has_local(out); k++)
        refit_rest(&w, k);
    return ROTID_OK;
}
