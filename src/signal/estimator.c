#include "signal/estimator.h"

#include <math.h>
#include <string.h>

#include "signal/transfer.h"

void estimator_sum(int nline, int count, const struct spectra *column, const double *weight, struct spectra *sum)
{
    memset(sum->ff, 0, (size_t)nline * sizeof *sum->ff);
    memset(sum->xx, 0, (size_t)nline * sizeof *sum->xx);
    for (int l = 0; l < nline; l++)
        sum->xf[l] = 0;
    for (int i = 0; i < count; i++) {
        double w = weight ? weight[i] : 1;
        size_t at = (size_t)i * (size_t)nline;
        for (int l = 0; l < nline && w > 0; l++) {
            sum->ff[l] += w * column->ff[at + (size_t)l];
            sum->xx[l] += w * column->xx[at + (size_t)l];
            sum->xf[l] += w * column->xf[at + (size_t)l];
        }
    }
}

double estimator_balance(int nline, const struct spectra *sum)
{
    double ff = 0, xx = 0;
    for (int l = 0; l < nline; l++) {
        ff += sum->ff[l];
        xx += sum->xx[l];
    }
    return ff > 0 ? xx / ff : 0;
}

static double square(double complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

static double complex total_least_squares(double balance, double ff, double xx, double complex xf)
{
    double cross = cabs(xf), difference = xx - balance * ff, root = hypot(difference, 2 * sqrt(balance) * cross);
    if (difference > 0)
        return xf / cross * ((difference + root) / (2 * cross));
    return xf * (2 * balance / (root - difference)); /* the same, without the difference of two large numbers */
}

void estimator_transfer(int estimator, double balance, int nline, const struct spectra *sum, double complex *h)
{
    for (int l = 0; l < nline; l++) {
        double ff = sum->ff[l], xx = sum->xx[l];
        double complex xf = sum->xf[l];
        if (!(ff > 0) || (fabs(creal(xf)) <= 0 && fabs(cimag(xf)) <= 0))
            h[l] = 0;
        else if (estimator == TRANSFER_H1)
            h[l] = xf / ff;
        else if (estimator == TRANSFER_H2)
            h[l] = xx / conj(xf);
        else
            h[l] = total_least_squares(balance, ff, xx, xf);
    }
}

void estimator_coherence(int nline, const struct spectra *sum, double *coherence)
{
    for (int l = 0; l < nline; l++) {
        double ratio = square(sum->xf[l]) / sum->ff[l] / sum->xx[l];
        coherence[l] = sum->ff[l] > 0 && sum->xx[l] > 0 ? fmin(ratio, 1) : 0;
    }
}

void estimator_jackknife(int estimator, int nline, int count, const struct spectra *column, const double complex *h,
                         double *variance, struct spectra *sum, double complex *part, double *weight)
{
    for (int i = 0; i < count; i++)
        weight[i] = 1;
    estimator_sum(nline, count, column, weight, sum);
    double balance = estimator_balance(nline, sum);
    for (int l = 0; l < nline; l++)
        variance[l] = sum->ff[l] > 0 ? 0 : INFINITY;
    for (int i = 0; i < count; i++) {
        const double *own = column->ff + (size_t)i * (size_t)nline;
        weight[i] = 0;
        estimator_sum(nline, count, column, weight, sum);
        weight[i] = 1;
        estimator_transfer(estimator, balance, nline, sum, part);
        for (int l = 0; l < nline; l++) {
            if (own[l] > 0) /* (1 - w)/w */
                variance[l] += square(h[l] - part[l]) * (sum->ff[l] / own[l]) / count;
        }
    }
}

/* The finite ones among the lines of a window, in order: a window that moves by one line changes by two values. */
struct window {
    double *value; /* [2 ESTIMATOR_SMOOTH + 2] rising */
    int count;
};

static void add(struct window *window, double value)
{
    int at = window->count;
    if (!isfinite(value))
        return;
    for (; at > 0 && window->value[at - 1] > value; at--)
        window->value[at] = window->value[at - 1];
    window->value[at] = value;
    window->count++;
}

static void take(struct window *window, double value)
{
    int at = 0;
    if (!isfinite(value))
        return;
    while (window->value[at] < value)
        at++;
    window->count--;
    for (; at < window->count; at++)
        window->value[at] = window->value[at + 1];
}

static double median(const struct window *window)
{
    int half = window->count / 2;
    return window->count % 2 ? window->value[half] : (window->value[half - 1] + window->value[half]) / 2;
}

void estimator_smooth(int nline, const double *force, double *variance, double *work)
{
    double *noise = work;
    struct window window = {.value = work + nline};
    for (int l = 0; l < nline; l++) {
        noise[l] = force[l] > 0 ? variance[l] * force[l] : INFINITY;
        if (l < ESTIMATOR_SMOOTH)
            add(&window, noise[l]);
    }
    for (int l = 0; l < nline; l++) {
        int from = l < ESTIMATOR_SMOOTH ? 0 : l - ESTIMATOR_SMOOTH;
        int to = l > nline - 1 - ESTIMATOR_SMOOTH ? nline : l + ESTIMATOR_SMOOTH + 1, count = 0;
        if (l + ESTIMATOR_SMOOTH < nline)
            add(&window, noise[l + ESTIMATOR_SMOOTH]);
        if (from > 0)
            take(&window, noise[from - 1]);
        if (!isfinite(noise[l]))
            continue;
        double limit = ESTIMATOR_OUTLIER * median(&window), sum = 0;
        for (int k = from; k < to; k++)
            if (isfinite(noise[k]) && (noise[k] > limit) == (noise[l] > limit)) {
                sum += noise[k];
                count++;
            }
        variance[l] = sum / count / force[l];
    }
}
