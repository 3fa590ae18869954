#include "ema/ema.h"

#include <math.h>
#include <stdlib.h>

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
    out->roving_force = nresponse == 1 && nreference > 1;
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
