#include "ema/ema.h"

#include <math.h>

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
