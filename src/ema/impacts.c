#include "ema/ema.h"

#define ITERATIONS 5

struct jackknife {
    const struct frf_set *set;
    const struct ema_band *band;
    const int *line;
    int first, most; /* impacts of a channel */
    struct modal_fit fit;
    double *residue; /* [2 nmode * nchannel * most] without each impact */
    double *energy;  /* [nchannel * most] of the force, over all of them */
};

static int averages(const struct jackknife *j, int k)
{
    const struct frf *frf = &j->set->frf[j->band->channel[k]];
    return frf->single ? frf->averages : 0;
}

static void weigh_impacts(struct jackknife *j)
{
    for (int k = 0; k < j->fit.nchannel; k++) {
        const struct frf *frf = &j->set->frf[j->band->channel[k]];
        double sum = 0;
        for (int i = 0; i < averages(j, k); i++) {
            double *energy = &j->energy[k + (ptrdiff_t)i * j->fit.nchannel];
            for (int l = 0; l < j->fit.nline; l++)
                *energy += frf->single_force[j->first + j->line[l] + (ptrdiff_t)i * j->set->nline];
            sum += *energy;
        }
        for (int i = 0; i < averages(j, k); i++)
            j->energy[k + (ptrdiff_t)i * j->fit.nchannel] /= sum;
    }
}

/* y of channel k from all of its impacts but one, as accelerance. */
static void leave_out(struct jackknife *j, int k, int left_out)
{
    const struct frf *frf = &j->set->frf[j->band->channel[k]];
    double *y = j->fit.y + (ptrdiff_t)2 * j->fit.nline * k;
    for (int l = 0; l < j->fit.nline; l++) {
        ptrdiff_t at = j->first + j->line[l];
        double complex cross = 0;
        double force = 0;
        for (int i = 0; i < frf->averages; i++) {
            if (i == left_out)
                continue;
            cross += frf->single[at + (ptrdiff_t)i * j->set->nline];
            force += frf->single_force[at + (ptrdiff_t)i * j->set->nline];
        }
        double complex h = cross / force * ema_band_factor(j->set, j->band->omega[j->line[l]]);
        y[l] = creal(h);
        y[l + j->fit.nline] = cimag(h);
    }
}

/* Variance of the residue of mode r in channel k along its phase. */
static double variance_by_impacts(const struct jackknife *j, const struct modal_fit *fit, int k, int r, const double *u)
{
    int n = averages(j, k), nchannel = fit->nchannel;
    const double *x = fit->linear + (ptrdiff_t)k * fit->nlinear + (ptrdiff_t)2 * r;
    double all = u[0] * x[0] + u[1] * x[1], mean = 0, variance = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < n; i++) {
            const double *a = j->residue + 2 * (r + (ptrdiff_t)fit->nmode * (k + (ptrdiff_t)nchannel * i));
            double weight = 1 / j->energy[k + (ptrdiff_t)i * nchannel];
            double pseudo = weight * all - (weight - 1) * (u[0] * a[0] + u[1] * a[1]);
            if (pass)
                variance += (pseudo - mean) * (pseudo - mean) / (weight - 1) / n;
            else
                mean += pseudo / weight;
        }
    return variance;
}

/* Of each channel: variance by the impacts, that stated, and |A|^2, in the units of the fit. Returns how many there are. */
static int compare_variances(const struct jackknife *j, const struct modal_fit *fit, int r, double *found, double *stated,
                             double *square)
{
    int q = fit->nlinear, count = 0;
    for (int k = 0; k < fit->nchannel; k++) {
        const double *x = fit->linear + (ptrdiff_t)k * q + (ptrdiff_t)2 * r, *spread = fit->spread + (ptrdiff_t)k * q * q;
        double size = hypot(x[0], x[1]), sum = 0;
        if (averages(j, k) < 2 || fit->singular[k] || j->fit.singular[k] || !(size > 0))
            continue;
        double u[2] = {x[0] / size, x[1] / size};
        for (int b = 0; b < 2; b++)
            for (int a = 0; a < 2; a++)
                sum += u[a] * u[b] * spread[2 * r + a + (ptrdiff_t)(2 * r + b) * q];
        if (!(sum > 0))
            continue;
        found[count] = variance_by_impacts(j, fit, k, r, u);
        stated[count] = sum;
        square[count++] = size * size;
    }
    return count;
}

/* g of variance = stated + g |A|^2 by least squares, each weighted by what it has itself. */
static double gain_variance(int count, const double *found, const double *stated, const double *square)
{
    double gain = 0;
    for (int i = 0; i < ITERATIONS; i++) {
        double top = 0, bottom = 0;
        for (int k = 0; k < count; k++) {
            double own = stated[k] + gain * square[k], weight = 1 / (own * own);
            top += weight * (found[k] - stated[k]) * square[k];
            bottom += weight * square[k] * square[k];
        }
        gain = bottom > 0 ? fmax(top / bottom, 0) : 0;
    }
    return gain;
}

static void add_to_spread(struct modal_fit *fit, int r, double gain)
{
    int q = fit->nlinear;
    for (int k = 0; k < fit->nchannel; k++) {
        const double *x = fit->linear + (ptrdiff_t)k * q + (ptrdiff_t)2 * r;
        for (int b = 0; b < 2; b++)
            for (int a = 0; a < 2; a++)
                fit->spread[2 * r + a + (ptrdiff_t)(2 * r + b) * q + (ptrdiff_t)k * q * q] += gain * x[a] * x[b];
    }
}

int impacts_spread(const struct pool *pool, const struct frf_set *set, int first, const struct ema_band *band, const int *line,
                   struct modal_fit *fit, double *gain)
{
    struct jackknife j = {.set = set, .band = band, .line = line, .first = first};
    for (int r = 0; r < fit->nmode; r++)
        gain[r] = 0;
    for (int k = 0; k < fit->nchannel; k++)
        j.most = averages(&j, k) > j.most ? averages(&j, k) : j.most;
    if (j.most < 2)
        return ROTID_OK;
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    size_t size = 2 * (size_t)fit->nmode * (size_t)fit->nchannel;
    j.residue = POOL_ARRAY(&scratch, double, size *(size_t)j.most);
    j.energy = POOL_ARRAY(&scratch, double, (size_t)fit->nchannel *(size_t)j.most);
    double *found = POOL_ARRAY(&scratch, double, fit->nchannel), *stated = POOL_ARRAY(&scratch, double, fit->nchannel),
           *square = POOL_ARRAY(&scratch, double, fit->nchannel);
    int status = j.residue && j.energy && found && stated && square
                     ? modal_fit_new(&scratch, band, fit->nline, line, 0, fit->nchannel, fit->nmode, fit->threads, &j.fit)
                     : ROTID_ERROR_MEMORY;
    if (!status) {
        weigh_impacts(&j);
        memcpy(j.fit.pole, fit->pole, (size_t)fit->nmode * sizeof *fit->pole);
        for (int i = 0; i < j.most; i++) {
            for (int k = 0; k < fit->nchannel; k++)
                if (i < averages(&j, k) && averages(&j, k) > 1)
                    leave_out(&j, k, i);
            (void)modal_fit_evaluate(&j.fit, MODAL_FIT_LINEAR);
            for (int k = 0; k < fit->nchannel; k++)
                memcpy(j.residue + size * (size_t)i + (size_t)2 * (size_t)fit->nmode * (size_t)k,
                       j.fit.linear + (ptrdiff_t)k * fit->nlinear, 2 * (size_t)fit->nmode * sizeof(double));
        }
        for (int r = 0; r < fit->nmode; r++) {
            gain[r] = gain_variance(compare_variances(&j, fit, r, found, stated, square), found, stated, square);
            add_to_spread(fit, r, gain[r]);
        }
    }
    pool_close(&scratch);
    return status;
}
