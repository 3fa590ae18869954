#include "diagnose/sensor_explain.h"

#include <math.h>
#include <string.h>

/* A gain or a shift has to earn its parameter: within three standard deviations of a kind without one, that kind is named. */
#define PARAMETER_COST 9.0
/* Reach of a position fault, over the length of the axis, and its grid. */
#define REACH      0.1
#define REACH_GRID 40
/* Gains from 0.02 to 20 of either sign, a quarter apart. */
#define GAIN_FROM 0.02
#define GAIN_STEP 1.25
#define GAIN_GRID 31
/* Grid points whose likelihood for the other sensors is this far below the best contribute nothing to an explanation. */
#define NEGLIGIBLE 8.0

int likelihood_new(struct pool *pool, const struct sensor_field *field, struct sensor_likelihood *suspect)
{
    size_t n = (size_t)field->n, all = (size_t)field->ngrid * (size_t)field->nmode;
    double *numbers = POOL_ARRAY(pool, double, 5 * all + 4 * n);
    *suspect = (struct sensor_likelihood){.field = field, .wanted = POOL_ARRAY(pool, int, all)};
    if (!numbers || !suspect->wanted)
        return ROTID_ERROR_MEMORY;
    suspect->others = numbers;
    suspect->mean = numbers + all;
    suspect->variance = numbers + 2 * all;
    suspect->there_mean = numbers + 3 * all;
    suspect->there_variance = numbers + 4 * all;
    suspect->vector = numbers + 5 * all;
    return ROTID_OK;
}

static double log_mean_exp(int count, const double *x)
{
    double best = -INFINITY, sum = 0;
    for (int i = 0; i < count; i++)
        best = fmax(best, x[i]);
    if (isinf(best))
        return best;
    for (int i = 0; i < count; i++)
        if (x[i] > best - 30)
            sum += exp(x[i] - best);
    return best + log(sum / count);
}

static double log_normal(double difference, double variance)
{
    return -0.5 * (difference * difference / variance + log(variance));
}

/* Log likelihood of all sensors when this one reads `gain` times the deflection at a place with this prediction. */
static double likelihood(const struct sensor_likelihood *suspect, const double *mean, const double *variance, double gain,
                         int all)
{
    const struct sensor_field *field = suspect->field;
    double total = 0, each[FIELD_MOST_GRID];
    for (int k = 0; k < field->nmode; k++) {
        int at = suspect->s + k * field->n;
        for (int g = 0; g < field->ngrid; g++) {
            int i = g + k * field->ngrid;
            each[g] = suspect->others[i];
            if (!all && !suspect->wanted[i])
                each[g] = -INFINITY;
            else if (field->present[at])
                each[g] += log_normal(field->reading[at] - gain * mean[i], gain * gain * variance[i] + field->variance[at]);
        }
        total += log_mean_exp(field->ngrid, each);
    }
    return total;
}

/* The likelihood where the sensor reads what it does whatever the field does. */
static double detached(const struct sensor_likelihood *suspect)
{
    const struct sensor_field *field = suspect->field;
    double total = 0;
    for (int k = 0; k < field->nmode; k++) {
        int at = suspect->s + k * field->n;
        total += log_mean_exp(field->ngrid, suspect->others + (ptrdiff_t)k * field->ngrid);
        if (field->present[at])
            total += log_normal(0, field->variance[at]);
    }
    return total;
}

double likelihood_open(struct sensor_likelihood *suspect, int s)
{
    const struct sensor_field *field = suspect->field;
    suspect->s = s;
    for (int k = 0; k < field->nmode; k++) {
        int at = s + k * field->n;
        double best = -INFINITY;
        for (int g = 0; g < field->ngrid; g++) {
            int i = g + k * field->ngrid;
            double a = field_inverse(field, g, field->class_of[k])[s + (ptrdiff_t)s * field->n], w = field_weight(field, g, k)[s];
            suspect->others[i] = field->evidence[i];
            suspect->mean[i] = suspect->variance[i] = 0;
            if (a > 0) {
                suspect->others[i] -= log_normal(w / a, 1 / a);
                suspect->mean[i] = field->reading[at] - w / a;
                suspect->variance[i] = fmax(1 / a - field->variance[at], 0);
            }
            best = fmax(best, suspect->others[i]);
        }
        for (int g = 0; g < field->ngrid; g++)
            suspect->wanted[g + k * field->ngrid] = suspect->others[g + k * field->ngrid] > best - NEGLIGIBLE;
    }
    suspect->sound = likelihood(suspect, suspect->mean, suspect->variance, 1, 1);
    return 2 * (detached(suspect) - suspect->sound);
}

static double of_gain(struct sensor_likelihood *suspect, double gain)
{
    return likelihood(suspect, suspect->mean, suspect->variance, gain, 0);
}

static double of_place(struct sensor_likelihood *suspect, double z)
{
    field_predict(suspect->field, suspect->s, z, suspect->wanted, suspect->there_mean, suspect->there_variance, suspect->vector);
    return likelihood(suspect, suspect->there_mean, suspect->there_variance, 1, 0);
}

/* The maximum of f between low and high by golden section, and the standard deviation from its curvature there. */
static double maximum(struct sensor_likelihood *suspect, double (*f)(struct sensor_likelihood *, double), double low, double high,
                      double *at, double *std)
{
    const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(suspect, a), fb = f(suspect, b);
    for (double stop = 1e-3 * (high - low); high - low > stop;) {
        if (fa > fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - golden * (high - low);
            fa = f(suspect, a);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + golden * (high - low);
            fb = f(suspect, b);
        }
    }
    double top = fmax(fa, fb), x = fa > fb ? a : b, step = 0.02 * fmax(fabs(x), 0.1);
    for (int i = 0; i < 2; i++) { /* a second time over one standard deviation */
        double bend = (2 * top - f(suspect, x - step) - f(suspect, x + step)) / (step * step);
        *std = bend > 0 ? 1 / sqrt(bend) : INFINITY;
        step = fmin(*std, 0.2 * fmax(fabs(x), 0.1));
    }
    *at = x;
    return top;
}

static void offer(const struct sensor_likelihood *suspect, double value, double cost, struct explanation candidate,
                  struct explanation *explanation)
{
    candidate.drop = 2 * (value - suspect->sound);
    candidate.score = candidate.drop - cost;
    if (candidate.score > explanation->score)
        *explanation = candidate;
}

static void explain_gain(struct sensor_likelihood *suspect, struct explanation *explanation)
{
    struct explanation none = {.other = -1, .value = NAN, .std = NAN};
    double best = -INFINITY, best_gain = 1, gain, std;
    offer(suspect, of_gain(suspect, -1), 0, none, &explanation[FAULT_SIGN]);
    offer(suspect, of_gain(suspect, 0), 0, none, &explanation[FAULT_DEAD]);
    for (int sign = -1; sign < 2; sign += 2) {
        double g = GAIN_FROM * sign;
        for (int i = 0; i < GAIN_GRID; i++, g *= GAIN_STEP) {
            double value = of_gain(suspect, g);
            if (value > best) {
                best = value;
                best_gain = g;
            }
        }
    }
    double a = best_gain / GAIN_STEP, b = best_gain * GAIN_STEP;
    if (fabs(best_gain) < 1.5 * GAIN_FROM)
        a = -b;
    best = maximum(suspect, of_gain, fmin(a, b), fmax(a, b), &gain, &std);
    offer(suspect, best, PARAMETER_COST, (struct explanation){.other = -1, .value = gain, .std = std}, &explanation[FAULT_GAIN]);
}

static void explain_position(struct sensor_likelihood *suspect, struct explanation *explanation)
{
    const struct sensor_field *field = suspect->field;
    double own = field->data->z[suspect->s], reach = REACH * 2 * field->half, step = 2 * reach / REACH_GRID;
    double from = fmax(own - reach, field->middle - field->half), to = fmin(own + reach, field->middle + field->half);
    double best = -INFINITY, place = own, std;
    for (int i = 0; from + i * step <= to; i++) {
        double z = from + i * step;
        double value = of_place(suspect, z);
        if (value > best) {
            best = value;
            place = z;
        }
    }
    best = maximum(suspect, of_place, fmax(from, place - step), fmin(to, place + step), &place, &std);
    offer(suspect, best, PARAMETER_COST, (struct explanation){.other = -1, .value = place - own, .std = std},
          &explanation[FAULT_POSITION]);
}

/* Both sensors are predicted by the rest, and each reads what is at the other's place. */
static double swapped(const struct sensor_likelihood *suspect, int t)
{
    const struct sensor_field *field = suspect->field;
    int n = field->n, s = suspect->s;
    double total = 0, each[FIELD_MOST_GRID];
    for (int k = 0; k < field->nmode; k++) {
        double ms = field->reading[s + k * n], mt = field->reading[t + k * n];
        double of_s = field->variance[s + k * n], of_t = field->variance[t + k * n];
        if (field->present[s + k * n] != field->present[t + k * n])
            return -INFINITY;
        for (int g = 0; g < field->ngrid; g++) {
            each[g] = field->evidence[g + k * field->ngrid];
            if (!field->present[s + k * n])
                continue;
            const double *a = field_inverse(field, g, field->class_of[k]), *w = field_weight(field, g, k);
            double ss = a[s + (ptrdiff_t)s * n], tt = a[t + (ptrdiff_t)t * n], st = a[s + (ptrdiff_t)t * n];
            double det = ss * tt - st * st, us = (tt * w[s] - st * w[t]) / det, ut = (ss * w[t] - st * w[s]) / det;
            double ds = ms - (mt - ut), dt = mt - (ms - us); /* what s reads is at the place of t */
            double vs = ss / det - of_t + of_s, vt = tt / det - of_s + of_t, cross = -st / det, other = vs * vt - cross * cross;
            each[g] += 0.5 * (us * w[s] + ut * w[t] - log(det));
            each[g] -= 0.5 * ((vt * ds * ds - 2 * cross * ds * dt + vs * dt * dt) / other + log(other));
        }
        total += log_mean_exp(field->ngrid, each);
    }
    return total;
}

static void explain_swap(struct sensor_likelihood *suspect, struct explanation *explanation)
{
    for (int t = 0; t < suspect->field->n; t++)
        if (t != suspect->s && !suspect->field->masked[t])
            offer(suspect, swapped(suspect, t), 2 * log(suspect->field->n),
                  (struct explanation){.other = t, .value = NAN, .std = NAN}, &explanation[FAULT_SWAP]);
}

void likelihood_explain(struct sensor_likelihood *suspect, int quick, struct explanation *explanation)
{
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        explanation[kind] = (struct explanation){.drop = -INFINITY, .score = -INFINITY, .other = -1, .value = NAN, .std = NAN};
    explain_swap(suspect, explanation);
    if (quick)
        return;
    explain_gain(suspect, explanation);
    explain_position(suspect, explanation);
}
