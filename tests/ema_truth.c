#include "ema_truth.h"

#include "support.h"

double truth_free_free(int r, double x)
{
    static const double exact[3] = {4.730040744862704, 7.853204624095838, 10.995607838001671};
    double b = r < 3 ? exact[r] : (2 * r + 3) * 1.5707963267948966;
    /* about the middle: even modes cos, odd modes sin, free of cancellation */
    double u = b * (x - 0.5), h = b / 2;
    if (r % 2 == 0)
        return (cos(u) / cos(h) + exp(fabs(u) - h) * (1 + exp(-2 * fabs(u))) / (1 + exp(-2 * h))) / 2;
    double sinh_ratio = exp(fabs(u) - h) * (1 - exp(-2 * fabs(u))) / (1 - exp(-2 * h)) * (u < 0 ? -1 : 1);
    return -(sin(u) / sin(h) + sinh_ratio) / 2;
}

void truth_beam(int nmode, int npoint, int drive, double f1, double damping, struct truth *truth)
{
    *truth = (struct truth){.nmode = nmode, .npoint = npoint, .drive = drive};
    for (int r = 0; r < nmode; r++) {
        truth->frequency_hz[r] = f1 * pow((2.0 * r + 3) / 3, 2);
        truth->damping[r] = damping;
        truth->mass[r] = 1;
        for (int j = 0; j < npoint; j++)
            truth->phi[r][j] = truth_free_free(r, npoint > 1 ? (double)j / (npoint - 1) : 0);
    }
}

static double complex truth_value(const struct truth *t, int j, double omega, enum frf_quantity quantity)
{
    double complex sum = 0;
    for (int r = 0; r < t->nmode; r++) {
        double w = TWO_PI * t->frequency_hz[r];
        w *= 1 - t->moving_mass * t->phi[r][j] * t->phi[r][j] / (2 * t->mass[r]);
        sum += t->phi[r][j] * t->phi[r][t->drive] / (t->mass[r] * CMPLX(w * w - omega * omega, 2 * t->damping[r] * w * omega));
    }
    for (int p = 0; p < (int)quantity; p++)
        sum *= I * omega;
    return sum;
}

void truth_measure(struct pool *pool, const struct truth *truth, enum frf_quantity quantity, double low_hz, double step_hz,
                   int nline, double noise, int with_variance, struct random_stream *random, struct frf_set *set)
{
    *set = (struct frf_set){.nline = nline, .quantity = quantity, .nfrf = truth->npoint};
    set->frequency_hz = POOL_ARRAY(pool, double, nline);
    set->frf = POOL_ARRAY(pool, struct frf, truth->npoint);
    assert_true(set->frequency_hz && set->frf);
    for (int i = 0; i < nline; i++)
        set->frequency_hz[i] = low_hz + i * step_hz;
    for (int j = 0; j < truth->npoint; j++) {
        struct frf *f = &set->frf[j];
        *f = (struct frf){.response_node = j + 1,
                          .response_direction = 2,
                          .reference_node = truth->drive + 1,
                          .reference_direction = 2,
                          .averages = 100};
        f->h = POOL_ARRAY(pool, double complex, nline);
        f->variance = with_variance ? POOL_ARRAY(pool, double, nline) : NULL;
        double power = 0;
        for (int i = 0; i < nline; i++) {
            f->h[i] = truth_value(truth, j, TWO_PI * set->frequency_hz[i], quantity);
            power += creal(f->h[i] * conj(f->h[i])) / nline;
        }
        double std = noise * sqrt(power);
        for (int i = 0; i < nline; i++) {
            if (noise > 0)
                f->h[i] += std / sqrt(2) * CMPLX(random_normal(random), random_normal(random));
            if (with_variance)
                f->variance[i] = std * std;
        }
    }
}
