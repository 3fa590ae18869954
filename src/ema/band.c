#include "ema/ema.h"

static void smooth_variance(int n, int half, const double *raw, double *smooth)
{
    double mean = 0;
    for (int i = 0; i < n; i++)
        mean += isfinite(raw[i]) ? raw[i] / n : 0;
    double sum = 0;
    for (int i = 0, first = 0, last = -1; i < n; i++) {
        for (; last < i + half && last + 1 < n; sum += raw[last])
            last++;
        for (; first < i - half; first++)
            sum -= raw[first];
        smooth[i] = fmax(sum / (last - first + 1), fmax(1e-10 * mean, 1e-300));
    }
}

/* neighbours on each side that make 20 degrees of freedom of averages that have 2 (averages - 1) each */
static int smoothing_width(int averages)
{
    int half = 0;
    if (averages >= 2)
        while ((2 * half + 1) * 2 * (averages - 1) < 20)
            half++;
    return half;
}

/* A point with one usable impact has no scatter: the noise of a line is that of the median channel, not averaged. work [nchannel]
 */
static void borrow_variance(const struct frf_set *set, struct ema_band *band, int k, double *work)
{
    const struct frf *own = &set->frf[band->channel[k]];
    for (int i = 0; i < band->nline; i++) {
        int count = 0;
        for (int j = 0; j < band->nchannel; j++) {
            const struct frf *frf = &set->frf[band->channel[j]];
            if (frf->variance)
                work[count++] = band->variance[i + (ptrdiff_t)j * band->nline] * (frf->averages > 0 ? frf->averages : 1);
        }
        band->variance[i + (ptrdiff_t)k * band->nline] =
            double_of_rank((size_t)count, (size_t)count / 2, work) / (own->averages > 0 ? own->averages : 1);
    }
}

double complex ema_band_factor(const struct frf_set *set, double omega)
{
    double complex s = I * omega, factor = s * s;
    for (int p = 0; p < (int)set->quantity; p++)
        factor /= s + set->window_decay;
    return factor;
}

int ema_band_new(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema_band *band)
{
    *band = (struct ema_band){0};
    int known, stated = 0;
    for (int c = 0; c < set->nfrf; c++) {
        band->nchannel += usable[c] != 0;
        stated += usable[c] && set->frf[c].variance;
    }
    known = 2 * stated > band->nchannel;
    int n = last - first, half = 0;
    size_t size = (size_t)n * (size_t)band->nchannel;
    band->nline = n;
    band->omega = POOL_ARRAY(pool, double, n);
    band->channel = POOL_ARRAY(pool, int, band->nchannel);
    band->h = POOL_ARRAY(pool, double complex, size);
    band->variance = known ? POOL_ARRAY(pool, double, size) : NULL;
    double *raw = POOL_ARRAY(pool, double, n), *raw_of_line = POOL_ARRAY(pool, double, band->nchannel);
    double complex *factor = POOL_ARRAY(pool, double complex, n);
    if (!raw_of_line || !factor || !band->omega || !band->channel || !band->h || (known && !band->variance) || !raw)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        band->omega[i] = TWO_PI * set->frequency_hz[first + i];
    for (int i = 0; i < n; i++)
        factor[i] = ema_band_factor(set, band->omega[i]);
    band->low = n ? band->omega[0] : 0;
    band->high = n ? band->omega[n - 1] : 0;
    for (int c = 0, k = 0; c < set->nfrf; c++) {
        if (!usable[c])
            continue;
        double complex *h = band->h + (size_t)n * (size_t)k;
        for (int i = 0; i < n; i++)
            h[i] = set->frf[c].h[first + i] * factor[i];
        if (known && set->frf[c].variance) {
            /* that of records is smooth already, and INFINITY where a line says nothing */
            half = set->frf[c].single ? 0 : smoothing_width(set->frf[c].averages);
            for (int i = 0; i < n; i++)
                raw[i] = set->frf[c].variance[first + i] * pow(cabs(factor[i]), 2);
            smooth_variance(n, half, raw, band->variance + (size_t)n * (size_t)k);
        }
        band->channel[k++] = c;
    }
    for (int k = 0; k < band->nchannel && known; k++)
        if (!set->frf[band->channel[k]].variance)
            borrow_variance(set, band, k, raw_of_line);
    return ROTID_OK;
}

int ema_band_part(struct pool *pool, const struct ema_band *band, int first, int nline, struct ema_band *part)
{
    size_t lines = (size_t)nline, size = lines * (size_t)band->nchannel;
    *part = (struct ema_band){.nline = nline,
                              .omega = band->omega + first,
                              .low = band->omega[first],
                              .high = band->omega[first + nline - 1],
                              .nchannel = band->nchannel,
                              .channel = band->channel};
    part->h = POOL_ARRAY(pool, double complex, size);
    part->variance = band->variance ? POOL_ARRAY(pool, double, size) : NULL;
    if (!part->h || (band->variance && !part->variance))
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c < band->nchannel; c++) {
        size_t to = (size_t)c * lines, from = (size_t)c * (size_t)band->nline + (size_t)first;
        memcpy(part->h + to, band->h + from, lines * sizeof *part->h);
        if (band->variance)
            memcpy(part->variance + to, band->variance + from, lines * sizeof *part->variance);
    }
    return ROTID_OK;
}

int ema_band_line(const struct ema_band *band, double value)
{
    int low = 0, high = band->nline;
    while (low < high) {
        int middle = (low + high) / 2;
        if (band->omega[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
