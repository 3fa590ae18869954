#include "ema/ema.h"

ORDER_BY(by_frequency, double complex, cimag(*it), 0)

void sort_poles(size_t count, double complex *pole)
{
    if (count)
        qsort(pole, count, sizeof *pole, by_frequency);
}

void residue_of_mode(const struct modal_fit *fit, int c, int r, const double *covariance, double complex *residue,
                     double *residue_std)
{
    int q = fit->nlinear, p = 2 * fit->nmode;
    const double *x = fit->linear + (ptrdiff_t)c * q, *mix = fit->mix + (ptrdiff_t)c * q * p + (ptrdiff_t)2 * r;
    const double *spread = fit->spread + (ptrdiff_t)c * q * q;
    double complex a = CMPLX(x[(ptrdiff_t)2 * r], x[(ptrdiff_t)2 * r + 1]) / fit->scale;
    double size = cabs(a), u[2] = {size > 0 ? creal(a) / size : 1, size > 0 ? cimag(a) / size : 0}, variance = 0;
    *residue = fit->singular[c] ? CMPLX(NAN, NAN) : a;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            variance += u[j] * u[k] * spread[(ptrdiff_t)2 * r + j + (ptrdiff_t)(2 * r + k) * q];
    for (int k = 0; covariance && k < p; k++) {
        double left = u[0] * mix[(ptrdiff_t)k * q] + u[1] * mix[(ptrdiff_t)k * q + 1];
        for (int j = 0; j < p; j++)
            variance +=
                left * covariance[j + (ptrdiff_t)k * p] * (u[0] * mix[(ptrdiff_t)j * q] + u[1] * mix[(ptrdiff_t)j * q + 1]);
    }
    *residue_std = fit->singular[c] ? NAN : sqrt(fmax(variance, 0)) / fit->scale;
}

void ema_synthesise(const struct ema *ema, const struct frf_set *set, int c, int n, const double *frequency_hz, double complex *h)
{
    for (int i = 0; i < n; i++)
        h[i] = 0;
    /* in real arithmetic: complex division and product of C guard against infinities at ten times the cost */
    for (int r = 0; r < ema->nmode + ema->nguard; r++) {
        double complex residue = ema->mode[r].residue[c], pole = ema->mode[r].pole - set->window_decay;
        if (ema->mode[r].local_pole && !isnan(creal(ema->mode[r].local_pole[c])))
            pole = ema->mode[r].local_pole[c] - set->window_decay;
        double a = creal(pole), b = cimag(pole), p = creal(residue), q = cimag(residue);
        for (int i = 0; i < n; i++) {
            double omega = TWO_PI * frequency_hz[i], below = omega - b, above = omega + b;
            double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above);
            /* (p + i q) (-a - i below) d + (p - i q) (-a - i above) e */
            h[i] += CMPLX((q * below - p * a) * d - (p * a + q * above) * e, -(q * a + p * below) * d + (q * a - p * above) * e);
        }
    }
    for (int i = 0; i < n; i++) {
        double omega = TWO_PI * frequency_hz[i];
        if (omega > 0)
            h[i] += -ema->lower[c] / (omega * omega) + ema->upper[c];
        for (int p = 0; p < (int)set->quantity; p++)
            h[i] *= I * omega + set->window_decay;
    }
}

/* S_xx, S_yy, S_xy of the components that are finite */
static void moments(int n, const double complex *shape, double *xx, double *yy, double *xy)
{
    *xx = *yy = *xy = 0;
    for (int i = 0; i < n; i++) {
        double x = creal(shape[i]), y = cimag(shape[i]);
        if (isnan(x) || isnan(y))
            continue;
        *xx += x * x;
        *yy += y * y;
        *xy += x * y;
    }
}

double mode_phase_collinearity(int n, const double complex *shape)
{
    double xx, yy, xy;
    moments(n, shape, &xx, &yy, &xy);
    double all = (xx + yy) * (xx + yy);
    return all > 0 ? ((xx - yy) * (xx - yy) + 4 * xy * xy) / all : 0;
}

double complex mode_axis(int n, const double complex *shape)
{
    double xx, yy, xy;
    moments(n, shape, &xx, &yy, &xy);
    /* the sum of (Re shape exp(-i a))^2 is largest at tan 2 a = 2 S_xy/(S_xx - S_yy) */
    double a = atan2(2 * xy, xx - yy) / 2;
    return CMPLX(cos(a), sin(a));
}

double mode_phase_deviation(int n, const double complex *shape)
{
    double complex axis = mode_axis(n, shape);
    double sum = 0, weight = 0;
    for (int i = 0; i < n; i++) {
        double complex turned = shape[i] * conj(axis);
        double size = cabs(turned);
        if (isnan(size) || size == 0)
            continue;
        sum += size * atan2(fabs(cimag(turned)), fabs(creal(turned)));
        weight += size;
    }
    return weight > 0 ? sum / weight * 57.29577951308232 : 0;
}

#define UNKNOWN 1e-200 /* weight of a residue without a standard deviation */
#define SWEEPS  30     /* of alternating least squares: it converges with the square of the ratio of the singular values */

struct place {
    int node, direction;
};

static int place_index(struct place *place, int *count, int node, int direction)
{
    direction = abs(direction);
    for (int i = 0; i < *count; i++)
        if (place[i].node == node && place[i].direction == direction)
            return i;
    place[*count] = (struct place){node, direction};
    return (*count)++;
}

int shapes_points(struct pool *pool, const struct frf_set *set, struct ema_points *points, struct ema *out)
{
    int n = set->nfrf, nresponse = 0, nreference = 0;
    struct place *response = POOL_ARRAY(pool, struct place, n), *reference = POOL_ARRAY(pool, struct place, n);
    int *of_response = POOL_ARRAY(pool, int, n), *of_reference = POOL_ARRAY(pool, int, n);
    *points = (struct ema_points){.sign = POOL_ARRAY(pool, double, n), .is_drive = POOL_ARRAY(pool, int, n)};
    if (!response || !reference || !of_response || !of_reference || !points->sign || !points->is_drive)
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c < n; c++) {
        const struct frf *f = &set->frf[c];
        of_response[c] = place_index(response, &nresponse, f->response_node, f->response_direction);
        of_reference[c] = place_index(reference, &nreference, f->reference_node, f->reference_direction);
        points->sign[c] = (f->response_direction < 0 ? -1 : 1) * (f->reference_direction < 0 ? -1 : 1);
        points->is_drive[c] = f->response_node == f->reference_node && abs(f->response_direction) == abs(f->reference_direction);
    }
    out->roving_force = nreference > nresponse; /* the side with more points: the other one tells one mode from another */
    const struct place *place = out->roving_force ? reference : response;
    out->channel_point = out->roving_force ? of_reference : of_response;
    out->npoint = out->roving_force ? nreference : nresponse;
    points->reference = out->roving_force ? of_response : of_reference;
    points->nreference = out->roving_force ? nresponse : nreference;
    out->point_node = POOL_ARRAY(pool, int, out->npoint);
    out->point_direction = POOL_ARRAY(pool, int, out->npoint);
    if (!out->point_node || !out->point_direction)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < out->npoint; i++) {
        out->point_node[i] = place[i].node;
        out->point_direction[i] = place[i].direction;
    }
    return ROTID_OK;
}

static double weight_of(const struct ema_mode *mode, int c)
{
    double std = mode->residue_std[c];
    return std > 0 && isfinite(std) ? 1 / (std * std) : UNKNOWN;
}

/* A = phi_response phi_force/(2 i omega), where omega may differ from channel to channel: brought to that of the mode. */
static double complex amplitude(const struct ema_mode *mode, int c)
{
    double own = mode->local_pole ? cimag(mode->local_pole[c]) : NAN;
    return isnan(own) ? mode->residue[c] : mode->residue[c] * own / cimag(mode->pole);
}

/* One half of the alternation: with v of the other side, u_k = sum w conj(v) B/sum w |v|^2 over the channels of k; variance too
 * where asked for. A side without a channel becomes NaN. */
static void project(int nfrf, const int *usable, const double *sign, const struct ema_mode *mode, int count, const int *side,
                    const int *other, const double complex *v, double complex *u, double *std)
{
    for (int k = 0; k < count; k++) {
        double complex sum = 0;
        double weight = 0;
        for (int c = 0; c < nfrf; c++) {
            if (!usable[c] || side[c] != k || isnan(creal(mode->residue[c])) || isnan(creal(v[other[c]])))
                continue;
            double w = weight_of(mode, c);
            sum += w * sign[c] * conj(v[other[c]]) * amplitude(mode, c);
            weight += w * creal(v[other[c]] * conj(v[other[c]]));
        }
        u[k] = weight > 0 ? sum / weight : CMPLX(NAN, NAN);
        if (std)
            std[k] = weight > UNKNOWN * 1e6 ? 1 / sqrt(weight) : NAN;
    }
}

static int strongest_reference(const struct frf_set *set, const struct ema_points *points, const int *usable,
                               const struct ema_mode *mode)
{
    double best = -1;
    int chosen = 0;
    for (int k = 0; k < points->nreference; k++) {
        double sum = 0;
        for (int c = 0; c < set->nfrf; c++)
            if (usable[c] && points->reference[c] == k && !isnan(creal(mode->residue[c])))
                sum += creal(mode->residue[c] * conj(mode->residue[c]));
        if (sum > best) {
            best = sum;
            chosen = k;
        }
    }
    return chosen;
}

static double mass_of(const struct frf_set *set, const struct ema_points *points, const int *usable, const struct ema *out,
                      const struct ema_mode *mode)
{
    double sum = 0;
    int count = 0;
    for (int c = 0; c < set->nfrf; c++) {
        if (!usable[c] || !points->is_drive[c] || isnan(creal(mode->residue[c])))
            continue;
        double phi = mode->shape[out->channel_point[c]];
        sum += creal(phi * phi / (2 * I * cimag(mode->pole) * points->sign[c] * amplitude(mode, c)));
        count++;
    }
    return count ? sum / count : NAN;
}

void shapes_of_mode(const struct frf_set *set, const struct ema_points *points, const int *usable, const struct ema *out,
                    struct ema_mode *mode, double complex *work)
{
    double complex *v = work, *u = mode->complex_shape;
    int strongest = strongest_reference(set, points, usable, mode);
    for (int k = 0; k < points->nreference; k++)
        v[k] = k == strongest ? 1 : CMPLX(NAN, NAN);
    for (int sweep = 0; sweep < (points->nreference > 1 ? SWEEPS : 1); sweep++) {
        project(set->nfrf, usable, points->sign, mode, out->npoint, out->channel_point, points->reference, v, u, mode->shape_std);
        if (points->nreference == 1)
            break;
        project(set->nfrf, usable, points->sign, mode, points->nreference, points->reference, out->channel_point, u, v, NULL);
        double complex unit = v[strongest];
        for (int k = 0; k < points->nreference; k++)
            v[k] /= unit;
    }
    mode->mpc = mode_phase_collinearity(out->npoint, u);
    mode->mpd = mode_phase_deviation(out->npoint, u);
    double complex axis = mode_axis(out->npoint, u);
    double largest = 0;
    for (int i = 0; i < out->npoint; i++) {
        double part = creal(u[i] * conj(axis));
        if (fabs(part) > fabs(largest))
            largest = part;
    }
    for (int i = 0; i < out->npoint; i++) {
        u[i] *= largest != 0 ? conj(axis) / largest : 1;
        mode->shape[i] = creal(u[i]);
        mode->shape_std[i] /= largest != 0 ? fabs(largest) : 1;
    }
    mode->modal_mass = mass_of(set, points, usable, out, mode);
}

#define CLOSE_WIDTHS   3 /* half-power bandwidths */
#define EDGE_WIDTHS    2
#define LEAST_MPC      0.8
#define MOST_MPD       20 /* degrees */
#define WEAK_THRESHOLD 3  /* standard deviations of the strongest residue */

/* NaN of complex numbers; NULL where memory is out, as the pool says. */
static void *unknown_complex(struct pool *pool, size_t count)
{
    return pool_unknown(pool, 2 * count);
}

int modes_new(struct pool *pool, int nmode, int per_point, struct ema *out)
{
    size_t nfrf = (size_t)out->nfrf, npoint = (size_t)out->npoint;
    out->nmode = nmode;
    out->mode = POOL_ARRAY(pool, struct ema_mode, nmode);
    out->lower = unknown_complex(pool, nfrf);
    out->upper = unknown_complex(pool, nfrf);
    for (int r = 0; r < nmode && out->mode; r++)
        out->mode[r] = (struct ema_mode){.frequency_std = NAN,
                                         .damping_std = NAN,
                                         .modal_mass = NAN,
                                         .peak_signal_to_noise = NAN,
                                         .nearest_hz = NAN,
                                         .residue = unknown_complex(pool, nfrf),
                                         .residue_std = pool_unknown(pool, nfrf),
                                         .shape = pool_unknown(pool, npoint),
                                         .shape_std = pool_unknown(pool, npoint),
                                         .complex_shape = unknown_complex(pool, npoint),
                                         .point_frequency_hz = per_point ? pool_unknown(pool, npoint) : NULL,
                                         .point_frequency_std = per_point ? pool_unknown(pool, npoint) : NULL};
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

void modes_of_pole(double complex pole, const double *covariance, struct ema_mode *mode)
{
    double w = cabs(pole), zeta = w > 0 ? -creal(pole) / w : 0;
    mode->pole = pole;
    mode->frequency_hz = w / TWO_PI;
    mode->damping = zeta;
    mode->frequency_std = mode->damping_std = NAN;
    if (!covariance || !(w > 0))
        return;
    double dw[2] = {creal(pole) / w, cimag(pole) / w}, dz[2] = {(-1 - zeta * dw[0]) / w, -zeta * dw[1] / w};
    double vw = 0, vz = 0;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) {
            vw += dw[j] * dw[k] * covariance[j + 2 * k];
            vz += dz[j] * dz[k] * covariance[j + 2 * k];
        }
    mode->frequency_std = sqrt(fmax(vw, 0)) / TWO_PI;
    mode->damping_std = sqrt(fmax(vz, 0));
    if (isnan(vw) || isnan(vz))
        mode->frequency_std = mode->damping_std = NAN;
}

void modes_from_fit(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, double decay,
                    struct ema *out)
{
    int p = 2 * fit->nmode;
    for (int r = 0; r < fit->nmode; r++) {
        double block[4];
        for (int k = 0; k < 2; k++)
            for (int j = 0; j < 2; j++)
                block[j + 2 * k] =
                    refinement->covariance[(ptrdiff_t)2 * r + j + (ptrdiff_t)(2 * r + k) * p] * fit->scale * fit->scale;
        modes_of_pole(fit->pole[r] * fit->scale + decay, block, &out->mode[r]);
        if (refinement->moved[r] || !refinement->converged)
            out->mode[r].quality_flags |= EMA_NOT_REFINED;
    }
    for (int k = 0; k < fit->nchannel; k++) {
        int c = band->channel[k];
        const double *x = fit->linear + (ptrdiff_t)k * fit->nlinear;
        if (fit->singular[k])
            continue;
        out->lower[c] = CMPLX(x[p], x[p + 1]);
        out->upper[c] = CMPLX(x[p + 2], x[p + 3]) / (fit->scale * fit->scale);
        for (int r = 0; r < fit->nmode; r++)
            residue_of_mode(fit, k, r, refinement->covariance, &out->mode[r].residue[c], &out->mode[r].residue_std[c]);
    }
}

static double mac_of(int n, const double complex *a, const double complex *b)
{
    double aa = 0, bb = 0;
    double complex ab = 0;
    for (int i = 0; i < n; i++) {
        if (isnan(creal(a[i])) || isnan(creal(b[i])))
            continue;
        aa += creal(a[i] * conj(a[i]));
        bb += creal(b[i] * conj(b[i]));
        ab += conj(a[i]) * b[i];
    }
    return aa > 0 && bb > 0 ? creal(ab * conj(ab)) / (aa * bb) : 0;
}

static double half_power_hz(const struct ema_mode *mode)
{
    return 2 * fabs(mode->damping) * mode->frequency_hz;
}

static double signal_to_noise(const struct ema_band *band, const struct ema_mode *mode, double *sorted)
{
    int at = ema_band_line(band, cimag(mode->pole));
    at = at < band->nline ? at : band->nline - 1;
    for (int k = 0; k < band->nchannel; k++) {
        ptrdiff_t i = at + (ptrdiff_t)k * band->nline;
        sorted[k] = cabs(band->h[i]) / sqrt(band->variance[i]);
    }
    return median_of((size_t)band->nchannel, sorted);
}

int modes_judge(struct pool *pool, const struct ema_band *band, double decay, struct ema *out)
{
    int n = out->nmode;
    double *sorted = POOL_ARRAY(pool, double, band->nchannel);
    out->mac = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    if (!sorted || !out->mac)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < n; r++) {
        struct ema_mode *mode = &out->mode[r];
        double width = half_power_hz(mode) + decay * 2 / TWO_PI, strongest = 0;
        int known = 0;
        for (int s = 0; s < n; s++) {
            double apart = fabs(out->mode[s].frequency_hz - mode->frequency_hz);
            out->mac[s + (ptrdiff_t)r * n] = mac_of(out->npoint, out->mode[s].complex_shape, mode->complex_shape);
            if (s != r && !(fabs(mode->nearest_hz - mode->frequency_hz) <= apart))
                mode->nearest_hz = out->mode[s].frequency_hz;
            if (s != r && apart < CLOSE_WIDTHS * fmax(width, half_power_hz(&out->mode[s])))
                mode->quality_flags |= EMA_CLOSE;
        }
        for (int c = 0; c < out->nfrf; c++) {
            known |= isfinite(mode->residue_std[c]);
            if (cabs(mode->residue[c]) > strongest * mode->residue_std[c])
                strongest = cabs(mode->residue[c]) / mode->residue_std[c];
        }
        if (known && strongest < WEAK_THRESHOLD)
            mode->quality_flags |= EMA_WEAK;
        if (mode->mpc < LEAST_MPC || mode->mpd > MOST_MPD)
            mode->quality_flags |= EMA_COMPLEX;
        if (mode->damping < 0)
            mode->quality_flags |= EMA_NEGATIVE_DAMPING;
        if (mode->frequency_hz - band->low / TWO_PI < EDGE_WIDTHS * width ||
            band->high / TWO_PI - mode->frequency_hz < EDGE_WIDTHS * width)
            mode->quality_flags |= EMA_EDGE;
        if (band->variance)
            mode->peak_signal_to_noise = signal_to_noise(band, mode, sorted);
    }
    return ROTID_OK;
}
