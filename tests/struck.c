#include "struck.h"

#include "support.h"

double complex struck_pole(const struct struck_mode *mode)
{
    double w = 2 * PI * mode->frequency_hz;
    return CMPLX(-mode->damping * w, w * sqrt(1 - mode->damping * mode->damping));
}

double complex struck_transfer(const struct struck *struck, double complex s)
{
    double complex h = 0;
    for (int m = 0; m < struck->nmode; m++) {
        double complex pole = struck_pole(&struck->mode[m]);
        h += struck->mode[m].residue / ((s - pole) * (s - conj(pole)));
    }
    for (int q = 0; q < (int)struck->quantity; q++)
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

void struck_hit(const struct struck *struck, double start, double peak, long long count, double *force, double *response)
{
    double p = PI / struck->width;
    for (long long j = 0; j < count; j++) {
        double t = (double)j / struck->rate - start;
        if (t <= 0)
            continue;
        double f = t < struck->width ? peak * sin(p * t) : 0;
        force[j] += f;
        for (int m = 0; m < struck->nmode; m++) {
            double complex pole = struck_pole(&struck->mode[m]);
            double complex amplitude = struck->mode[m].residue / (2 * I * cimag(pole));
            /* y' = pole y + f, and sum of the amplitudes with their conjugates is zero */
            double complex factor = struck->quantity == FRF_DISPLACEMENT ? 1
                                    : struck->quantity == FRF_VELOCITY   ? pole
                                                                         : pole * pole;
            response[j] += 2 * peak * creal(amplitude * factor * convolution(pole, p, t));
            if (struck->quantity == FRF_ACCELERATION)
                response[j] += 2 * creal(amplitude * pole) * f;
        }
    }
}

struct time_record struck_record(long long count)
{
    double *samples = POOL_ARRAY(&test_pool, double, 2 * count);
    assert_non_null(samples);
    return (struct time_record){.count = count, .force = samples, .response = samples + count};
}

double *struck_force(const struct time_record *record)
{
    return (double *)(uintptr_t)record->force;
}

double *struck_response(const struct time_record *record)
{
    return (double *)(uintptr_t)record->response;
}

void struck_noise(uint64_t *seed, double deviation, long long count, double *x)
{
    struct random_stream stream = {*seed};
    for (long long j = 0; j < count; j++)
        x[j] += deviation * random_normal(&stream);
    *seed = stream.state;
}
