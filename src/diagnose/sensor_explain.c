#include "diagnose/sensor_explain.h"

#include <math.h>
#include <string.h>

/* A gain or a shift has to earn its parameter: within three standard deviations of a kind without one, that kind is named. */
#define PARAMETER_COST 9.0
/* A channel copied from another differs from it by rounding only, taken as a tenth of the noise. */
#define COPY_NOISE 0.1
/* What a copy must take away even if its difference counts with the full noise: the two places have to differ. */
#define COPY_CONTRAST 10.0
/* Readings further apart than this chi2 and two a mode are no copies. */
#define COPY_APART 30.0
/* Share of the gaps between sensors that two standard deviations of the place on either side may cover. */
#define COINCIDENCE 0.25
/* Reach of a position fault, over the length of the axis, and its grid. */
#define REACH      0.1
#define REACH_GRID 40
/* Gains from 0.02 to 20 of either sign, a quarter apart. */
#define GAIN_FROM 0.02
#define GAIN_STEP 1.25
#define GAIN_GRID 31
/* Grid points whose likelihood for the other sensors is this far below the best contribute nothing to an explanation. */
#define NEGLIGIBLE 8.0

int suspect_new(struct pool *pool, const struct sensor_field *field, struct suspect *suspect)
{
    size_t n = (size_t)field->n, all = (size_t)field->ngrid * (size_t)field->nmode;
    double *numbers = POOL_ARRAY(pool, double, 5 * all + 4 * n);
    *suspect = (struct suspect){.field = field, .wanted = POOL_ARRAY(pool, int, all)};
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
static double likelihood(const struct suspect *suspect, const double *mean, const double *variance, double gain, int all)
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

/* The likelihood where the sensor's reading follows N(centre, variance_k) whatever the field does. */
static double detached(const struct suspect *suspect, const double *centre, double of_variance)
{
    const struct sensor_field *field = suspect->field;
    double total = 0;
    for (int k = 0; k < field->nmode; k++) {
        int at = suspect->s + k * field->n;
        total += log_mean_exp(field->ngrid, suspect->others + (ptrdiff_t)k * field->ngrid);
        if (field->present[at])
            total += log_normal(centre ? field->reading[at] - centre[k] : 0, of_variance * field->variance[at]);
    }
    return total;
}

double suspect_open(struct suspect *suspect, int s)
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
    return 2 * (detached(suspect, NULL, 1) - suspect->sound);
}

static double of_gain(struct suspect *suspect, double gain)
{
    return likelihood(suspect, suspect->mean, suspect->variance, gain, 0);
}

static double of_place(struct suspect *suspect, double z)
{
    field_predict(suspect->field, suspect->s, z, suspect->wanted, suspect->there_mean, suspect->there_variance, suspect->vector);
    return likelihood(suspect, suspect->there_mean, suspect->there_variance, 1, 0);
}

/* The maximum of f between low and high by golden section, and the standard deviation from its curvature there. */
static double maximum(struct suspect *suspect, double (*f)(struct suspect *, double), double low, double high, double *at,
                      double *std)
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

static void offer(const struct suspect *suspect, double value, double cost, struct explanation candidate,
                  struct explanation *explanation)
{
    candidate.drop = 2 * (value - suspect->sound);
    candidate.score = candidate.drop - cost;
    if (candidate.score > explanation->score)
        *explanation = candidate;
}

static void explain_gain(struct suspect *suspect, struct explanation *explanation)
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

static void explain_position(struct suspect *suspect, struct explanation *explanation)
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

static void explain_copy(struct suspect *suspect, struct explanation *explanation)
{
    const struct sensor_field *field = suspect->field;
    double cost = 2 * log(field->n);
    for (int t = 0; t < field->n; t++) {
        int shared = 0, identical = 1;
        double apart = 0;
        double centre[FIELD_MOST_MODES] = {0};
        struct explanation copy = {.other = t, .value = NAN, .std = NAN},
                           exact = {.other = t, .value = NAN, .exact = 1, .std = NAN};
        if (t == suspect->s || field->masked[t])
            continue;
        for (int k = 0; k < field->nmode; k++) {
            int at = suspect->s + k * field->n, from = t + k * field->n;
            if (field->present[at] != field->present[from])
                identical = 0;
            if (!field->present[at] || !field->present[from])
                continue;
            shared++;
            centre[k] = field->reading[from];
            apart += pow(field->reading[at] - centre[k], 2) / (field->variance[at] + field->variance[from]);
            if (fabs(field->reading[at] - centre[k]) > 3 * COPY_NOISE * sqrt(field->variance[at]))
                identical = 0;
        }
        if (!shared || apart > COPY_APART + 2 * shared)
            continue;
        offer(suspect, of_place(suspect, field->data->z[t]), cost, copy, &explanation[FAULT_DUPLICATE]);
        if (identical && 2 * (detached(suspect, centre, 1) - suspect->sound) > COPY_CONTRAST)
            offer(suspect, detached(suspect, centre, COPY_NOISE * COPY_NOISE), cost, exact, &explanation[FAULT_DUPLICATE]);
    }
}

/* Both sensors are predicted by the rest, and each reads what is at the other's place. */
static double swapped(const struct suspect *suspect, int t)
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

static void explain_swap(struct suspect *suspect, struct explanation *explanation)
{
    for (int t = 0; t < suspect->field->n; t++)
        if (t != suspect->s && !suspect->field->masked[t])
            offer(suspect, swapped(suspect, t), 2 * log(suspect->field->n),
                  (struct explanation){.other = t, .value = NAN, .std = NAN}, &explanation[FAULT_SWAP]);
}

/* A sensor that reads what is at another's place, with noise of its own, was either put there or anywhere near. Where sensors are
 * so close that any place is near one of them, the coincidence says nothing. */
static void prefer_position(const struct suspect *suspect, const struct explanation *position, struct explanation *copy)
{
    const struct sensor_field *field = suspect->field;
    int t = copy->other;
    if (t < 0 || copy->score < position->score || copy->exact || !isfinite(position->std))
        return;
    const double *z = field->data->z;
    double gap = fmin(t > 0 ? z[t] - z[t - 1] : INFINITY, t + 1 < field->n ? z[t + 1] - z[t] : INFINITY);
    if (4 * position->std > COINCIDENCE * gap && fabs(z[suspect->s] + position->value - z[t]) < 3 * position->std)
        copy->score = position->score - 1;
}

void suspect_explain(struct suspect *suspect, int quick, struct explanation *explanation)
{
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        explanation[kind] = (struct explanation){.drop = -INFINITY, .score = -INFINITY, .other = -1, .value = NAN, .std = NAN};
    explain_swap(suspect, explanation);
    explain_copy(suspect, explanation);
    if (quick)
        return;
    explain_gain(suspect, explanation);
    explain_position(suspect, explanation);
    prefer_position(suspect, &explanation[FAULT_POSITION], &explanation[FAULT_DUPLICATE]);
}
