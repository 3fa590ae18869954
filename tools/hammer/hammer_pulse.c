/* What poles answer to a half-sine, in closed form. */
#include <math.h>

#include "hammer.h"

static const double pi = 3.14159265358979323846;

/* g' = p g + sin(w t), g(0) = 0, at a time within the pulse. */
static double complex during(double complex p, double w, double t)
{
    return (w * cexp(p * t) - p * sin(w * t) - w * cos(w * t)) / (p * p + w * w);
}

/* After the pulse g goes on as exp(p t), sample by sample by one multiplication: after 1e4 samples its rounding is 1e-12. */
static void ring(double complex z, double complex factor, int first, int count, double *y)
{
    const double smallest = 1e-18 * cabs(z);
    double re = creal(z), im = cimag(z), a = creal(factor), b = cimag(factor);
    int last = count;
    if (!(smallest > 0))
        return;
    if (cabs(factor) < 1) /* below 1e-18 of where it began it adds nothing any more */
        last = (int)fmin(count, first + log(1e-18) / log(cabs(factor)) + 1);
    for (int n = first; n < last; n++) {
        double next = a * re - b * im;
        y[n] += re;
        im = a * im + b * re;
        re = next;
    }
}

void hammer_pulse_add(const struct hammer_poles *poles, double rate, double start, double duration, double amplitude, int count,
                      double *y)
{
    double w = pi / duration;
    int first = (int)fmax(ceil(start * rate), 0), after = (int)fmax(floor((start + duration) * rate) + 1, 0);
    for (int i = 0; i < poles->count; i++) {
        double complex p = poles->pole[i], scale = 2 * amplitude * poles->residue[i];
        double complex end = w * (cexp(p * duration) + 1) / (p * p + w * w);
        for (int n = first; n < after && n < count; n++)
            y[n] += creal(scale * during(p, w, n / rate - start));
        ring(scale * end * cexp(p * (after / rate - start - duration)), cexp(p / rate), after, count, y);
    }
}
