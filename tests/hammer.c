#include "hammer.h"

#include <math.h>

#include "base/random.h"
#include "support.h"

double complex hammer_pole(const struct hammer_mode *mode)
{
    double w = 2 * PI * mode->frequency_hz;
    return CMPLX(-mode->damping * w, w * sqrt(1 - mode->damping * mode->damping));
}

double complex hammer_transfer(const struct hammer *hammer, double complex s)
{
    double complex h = 0;
    for (int m = 0; m < hammer->nmode; m++) {
        double complex pole = hammer_pole(&hammer->mode[m]);
        h += hammer->mode[m].residue / ((s - pole) * (s - conj(pole)));
    }
    for (int q = 0; q < (int)hammer->quantity; q++)
        h *= s;
    return h;
}

/* y(t) = integral of exp(pole (t - u)) f(u) du over 0 ... t, for f = sin(p u) until the pulse ends. */
static double complex convolution(double complex pole, double p, double t)
{
    double inside = fmin(t, PI / p);
    double complex y = (p * cexp(pole * inside) - p * cos(p * inside) - pole * sin(p * inside)) / (p * p + pole * pole);
    return y * cexp(pole * (t - inside));
}

void hammer_hit(const struct hammer *hammer, double start, double peak, long long count, double *force, double *response)
{
    double p = PI / hammer->width;
    for (long long j = 0; j < count; j++) {
        double t = (double)j / hammer->rate - start;
        if (t <= 0)
            continue;
        double f = t < hammer->width ? peak * sin(p * t) : 0;
        force[j] += f;
        for (int m = 0; m < hammer->nmode; m++) {
            double complex pole = hammer_pole(&hammer->mode[m]);
            double complex amplitude = hammer->mode[m].residue / (2 * I * cimag(pole));
            /* y' = pole y + f, and sum of the amplitudes with their conjugates is zero */
            double complex factor = hammer->quantity == FRF_DISPLACEMENT ? 1
                                    : hammer->quantity == FRF_VELOCITY   ? pole
                                                                         : pole * pole;
            response[j] += 2 * peak * creal(amplitude * factor * convolution(pole, p, t));
            if (hammer->quantity == FRF_ACCELERATION)
                response[j] += 2 * creal(amplitude * pole) * f;
        }
    }
}

struct record hammer_record(long long count)
{
    double *samples = POOL_ARRAY(&test_pool, double, 2 * count);
    assert_non_null(samples);
    return (struct record){.count = count, .force = samples, .response = samples + count};
}

double *hammer_force(const struct record *record)
{
    return (double *)(uintptr_t)record->force;
}

double *hammer_response(const struct record *record)
{
    return (double *)(uintptr_t)record->response;
}

void hammer_noise(uint64_t *seed, double deviation, long long count, double *x)
{
    struct random_stream stream = {*seed};
    for (long long j = 0; j < count; j++)
        x[j] += deviation * random_normal(&stream);
    *seed = stream.state;
}
