#include "signal/signal.h"

#include <math.h>

double window_mean(int n, const double *x)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j] - x[0]; /* the mean of equal values is that value, to the last bit */
    return x[0] + sum / n;
}

void window_force(int n, int keep, int fade, double *x)
{
    static const double pi = 3.14159265358979323846;
    for (int j = keep; j < n; j++)
        x[j] *= j - keep < fade ? (1 + cos(pi * (j - keep + 1) / (fade + 1))) / 2 : 0;
}

double window_decay(int n, double end, double rate)
{
    return -log(end) * rate / n;
}

void window_exponential(int n, double decay, double rate, double *weight)
{
    for (int j = 0; j < n; j++)
        weight[j] = exp(-decay * j / rate);
}
