#include "diagnose/diagnose.h"

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
#define SENSOR_EXPLAIN_NEGLIGIBLE 8.0

/* ROTID_OK or ROTID_ERROR_MEMORY */
static int likelihood_new(struct pool *pool, const struct sensor_field *field, struct sensor_likelihood *suspect)
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

/* Takes up sensor s, which is not masked. Returns an upper limit of `drop` of all kinds but swaps. */
static double likelihood_open(struct sensor_likelihood *suspect, int s)
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
            suspect->wanted[g + k * field->ngrid] = suspect->others[g + k * field->ngrid] > best - SENSOR_EXPLAIN_NEGLIGIBLE;
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

static void offer(const struct sensor_likelihood *suspect, double value, double cost, struct fault_likelihood candidate,
                  struct fault_likelihood *explanation)
{
    candidate.drop = 2 * (value - suspect->sound);
    candidate.score = candidate.drop - cost;
    if (candidate.score > explanation->score)
        *explanation = candidate;
}

static void explain_gain(struct sensor_likelihood *suspect, struct fault_likelihood *explanation)
{
    struct fault_likelihood none = {.other = -1, .value = NAN, .std = NAN};
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
    offer(suspect, best, PARAMETER_COST, (struct fault_likelihood){.other = -1, .value = gain, .std = std},
          &explanation[FAULT_GAIN]);
}

static void explain_position(struct sensor_likelihood *suspect, struct fault_likelihood *explanation)
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
    offer(suspect, best, PARAMETER_COST, (struct fault_likelihood){.other = -1, .value = place - own, .std = std},
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

static void explain_swap(struct sensor_likelihood *suspect, struct fault_likelihood *explanation)
{
    for (int t = 0; t < suspect->field->n; t++)
        if (t != suspect->s && !suspect->field->masked[t])
            offer(suspect, swapped(suspect, t), 2 * log(suspect->field->n),
                  (struct fault_likelihood){.other = t, .value = NAN, .std = NAN}, &explanation[FAULT_SWAP]);
}

/* explanation [FAULT_KINDS] of the suspect; only swaps where `quick`; copies are no matter of likelihood. */
static void likelihood_explain(struct sensor_likelihood *suspect, int quick, struct fault_likelihood *explanation)
{
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        explanation[kind] =
            (struct fault_likelihood){.drop = -INFINITY, .score = -INFINITY, .other = -1, .value = NAN, .std = NAN};
    explain_swap(suspect, explanation);
    if (quick)
        return;
    explain_gain(suspect, explanation);
    explain_position(suspect, explanation);
}

/* Prior standard deviations of the slope change [largest component over length of the axis] and of the jump [largest component].
 * 0: none. Each mode has its own mixture of all pairs. */
static const double kink[] = {0, 0.3, 1, 3, 10}, jump[] = {0, 0.01, 0.03, 0.1, 0.3};
#define PAIRS ((int)(sizeof kink / sizeof *kink * (sizeof jump / sizeof *jump)))
#define JUMPS ((int)(sizeof jump / sizeof *jump))
/* How many gaps on either side of the sensor are searched, and places in each. */
#define GAPS   2
#define PLACES 3
/* Terms of a sum of exponentials that are e to the minus this of the largest are left out. */
#define NEGLIGIBLE 30.0

/* B' A B and B' w of the two columns b = (z - z0)+ and 1(z > z0) */
static void products(const struct sensor_field *field, int first, double z0, const double *a, double sum[3])
{
    int n = field->n;
    sum[0] = sum[1] = sum[2] = 0;
    for (int j = first; j < n; j++) {
        double level = 0, slope = 0;
        for (int i = first; i < n; i++) {
            double aij = a[i + (ptrdiff_t)j * n];
            level += aij;
            slope += aij * (field->data->z[i] - z0);
        }
        sum[0] += slope * (field->data->z[j] - z0);
        sum[1] += slope;
        sum[2] += level;
    }
}

/* Mean over the prior pairs of the factor by which the likelihood changes: log of N(v; 0, S + S T S)/N(v; 0, S). */
static void add_pairs(double length, const double sum[3], double slope, double level, double evidence, double *each)
{
    for (int pair = 0; pair < PAIRS; pair++) {
        double tk = kink[pair / JUMPS] / length, tj = jump[pair % JUMPS];
        /* I + R S R with R = T^(1/2) */
        double a = 1 + tk * tk * sum[0], b = tk * tj * sum[1], c = 1 + tj * tj * sum[2], det = a * c - b * b;
        double v = tk * slope, w = tj * level;
        each[pair] = evidence + 0.5 * ((c * v * v - 2 * b * v * w + a * w * w) / det - log(det));
    }
}

static double at_place(const struct sensor_field *field, int first, double z0, double *work)
{
    double total = 0, *square = work + (ptrdiff_t)field->ngrid * PAIRS;
    for (int c = 0; c < field->nclass; c++)
        for (int g = 0; g < field->ngrid; g++)
            products(field, first, z0, field_inverse(field, g, c), square + 3 * (g + (ptrdiff_t)c * field->ngrid));
    for (int k = 0; k < field->nmode; k++) {
        double best = -INFINITY, sum = 0;
        int count = field->ngrid * PAIRS;
        for (int g = 0; g < field->ngrid; g++) {
            const double *w = field_weight(field, g, k);
            double slope = 0, level = 0;
            for (int i = first; i < field->n; i++) {
                slope += w[i] * (field->data->z[i] - z0);
                level += w[i];
            }
            add_pairs(2 * field->half, square + 3 * (g + (ptrdiff_t)field->class_of[k] * field->ngrid), slope, level,
                      field->evidence[g + k * field->ngrid], work + (ptrdiff_t)g * PAIRS);
        }
        for (int i = 0; i < count; i++)
            best = fmax(best, work[i]);
        for (int i = 0; i < count; i++)
            if (work[i] > best - NEGLIGIBLE)
                sum += exp(work[i] - best);
        total += best + log(sum / count);
    }
    return total;
}

/* Log likelihood of all sensors that are in, with a change of slope and a jump of free size in every mode at the best place
 * within two gaps of sensor s. */
static double local_physics(const struct sensor_field *field, int s, double *work)
{
    double best = -INFINITY;
    const double *z = field->data->z;
    for (int gap = s - GAPS; gap < s + GAPS; gap++)
        for (int i = 0; i < PLACES && gap >= 0 && gap + 1 < field->n; i++)
            best = fmax(best, at_place(field, gap + 1, z[gap] + (z[gap + 1] - z[gap]) * (i + 0.5) / PLACES, work));
    return best;
}

/* Length of the workspace in doubles. */
static size_t local_workspace(const struct sensor_field *field)
{
    return (size_t)field->ngrid * (size_t)(PAIRS + 3 * field->nclass);
}

/* With fewer sensors the neighbours cannot say what a sensor should read. */
#define LEAST_SENSORS 8
#define LEAST_COPY    4 /* of which two that are equal stand out */
/* A likelihood ratio above 2 log(number of hypotheses/probability) is a false alarm with that probability at most, if the field
 * is what it is taken to be. From few sensors that is hard to know: with eight of them 1.7 times as much is asked for. */
#define FEW_SENSORS 7.0
/* Modes in which a copy has to agree, and the share of the sensors, one in so many, that are no copies but mirror images. */
#define COPY_MODES 2
#define COPY_APART 1e-3 /* of their noise, at most, in each mode */
#define DIGITS     1e-6 /* of the largest component: as many are no step but all that there are */
#define MIRRORED   5
/* Sensors for which a bad neighbour is tried. */
#define PAIR_TRIES 6
/* What a higher noise must gain in log likelihood. */
#define NOISE_MARGIN 5.0
#define NOISE_STEP   1.4
#define NOISE_STEPS  5

struct search {
    struct sensor_field field;
    struct sensor_likelihood suspect;
    double threshold; /* of the score */
    double false_alarm;
    double noise_factor;
    double *limit, *left; /* [n] how suspicious a sensor is at most; -INFINITY once looked at */
    double *work;         /* of local_physics */
    const double *digits; /* [n * nmode] as read, on the scale of the field */
};

static int sensors_left(const struct sensor_field *field)
{
    int left = 0;
    for (int s = 0; s < field->n; s++) {
        int present = 0;
        for (int k = 0; k < field->nmode; k++)
            present |= field->present[s + k * field->n];
        left += present && !field->masked[s];
    }
    return left;
}

/* The best explanation of sensor s into *fault. Returns its score, or -INFINITY where it does not reach `least` or physics at
 * that place does nearly as well. */
static double judge(struct search *search, int s, double least, struct sensor_fault *fault)
{
    struct fault_likelihood explanation[FAULT_KINDS];
    int best = 0;
    double limit = likelihood_open(&search->suspect, s), physics;
    if (limit < search->threshold / 2) /* of a swap, each of the two sensors must show half */
        return -INFINITY;
    likelihood_explain(&search->suspect, limit < least, explanation);
    for (int kind = 1; kind < FAULT_KINDS; kind++)
        if (explanation[kind].score > explanation[best].score)
            best = kind;
    *fault = (struct sensor_fault){.kind = (enum sensor_fault_kind)best,
                                   .sensor = s,
                                   .other = explanation[best].other,
                                   .value = explanation[best].value,
                                   .std = explanation[best].std,
                                   .chi2_drop = explanation[best].drop};
    if (explanation[best].score <= least)
        return -INFINITY;
    physics = local_physics(&search->field, s, search->work);
    if (best == FAULT_SWAP)
        physics = fmax(physics, local_physics(&search->field, fault->other, search->work));
    physics = 2 * (physics - search->suspect.sound);
    return explanation[best].score - fmax(physics, 0) > search->threshold ? explanation[best].score : -INFINITY;
}

static void take_out(struct sensor_field *field, const struct sensor_fault *fault)
{
    if (fault->kind == FAULT_SWAP)
        field_exchange(field, fault->sensor, fault->other);
    else
        field_mask(field, fault->sensor);
}

/* All sensors but those that `fault` names; fault number `but` stays in. */
static int start_without(struct search *search, int nfault, const struct sensor_fault *fault, int but)
{
    if (field_start(&search->field, search->noise_factor))
        return 1;
    for (int j = 0; j < nfault; j++)
        if (j != but)
            take_out(&search->field, &fault[j]);
    return 0;
}

static int certain(struct search *search, int s, struct sensor_fault *fault)
{
    return judge(search, s, search->threshold, fault) > search->threshold;
}

static int largest(int n, const double *x)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (x[i] > x[best])
            best = i;
    return best;
}

/* The worst fault of a sensor by itself into *fault. Returns 1 where there is one. */
static int find_one(struct search *search, struct sensor_fault *fault)
{
    struct sensor_field *field = &search->field;
    double worst = search->threshold;
    int found = 0;
    for (int s = 0; s < field->n; s++)
        search->limit[s] = search->left[s] = field->masked[s] ? -INFINITY : likelihood_open(&search->suspect, s);
    for (;;) { /* the most suspicious first, so that the others need less work */
        struct sensor_fault candidate;
        int s = largest(field->n, search->left);
        if (search->left[s] < search->threshold / 2)
            break;
        search->left[s] = -INFINITY;
        double score = judge(search, s, worst, &candidate);
        if (score > worst) {
            worst = score;
            found = 1;
            *fault = candidate;
        }
    }
    return found;
}

/* Sensors t and s by themselves, each with the other taken out, into fault[nfault] and the next. Returns 1 where both are bad. */
static int both_bad(struct search *search, int t, int s, int nfault, struct sensor_fault *fault)
{
    struct sensor_fault *one = &fault[nfault], *two = &fault[nfault + 1];
    if (!certain(search, s, one) || one->kind == FAULT_SWAP || start_without(search, nfault + 1, fault, -1))
        return 0;
    if (!certain(search, t, two) || two->kind == FAULT_SWAP)
        return 0;
    take_out(&search->field, two);
    if (two->chi2_drop > one->chi2_drop) {
        struct sensor_fault keep = *one;
        *one = *two;
        *two = keep;
    }
    return 1;
}

/* Two bad sensors spoil each other's prediction, most of all side by side. With one of the most suspicious taken out, its
 * neighbours and the sensor that is most suspicious then have to show their fault, and the one taken out its own. */
static int find_pair(struct search *search, int nfault, struct sensor_fault *fault)
{
    struct sensor_field *field = &search->field;
    int n = field->n;
    for (int try = 0; try < PAIR_TRIES; try++) {
        int t = largest(n, search->limit), other[3] = {t - 1, t + 1, -1};
        if (search->limit[t] < search->threshold)
            break;
        search->limit[t] = -INFINITY;
        for (int i = 0; i < 3; i++) {
            if (start_without(search, nfault, fault, -1))
                return 0;
            field_mask(field, t);
            if (i == 2) {
                for (int s = 0; s < n; s++)
                    search->left[s] = field->masked[s] ? -INFINITY : likelihood_open(&search->suspect, s);
                other[2] = largest(n, search->left);
            }
            if (other[i] >= 0 && other[i] < n && !field->masked[other[i]] && both_bad(search, t, other[i], nfault, fault))
                return 1;
        }
    }
    return 0;
}

/* The step of the digits of a mode: the largest number of which all readings are multiples, by Euclid; some DIGITS where there is
 * none. The scale of the mode does not matter. */
static double digit_step(int n, const double *reading, const int *present)
{
    double step = 0;
    for (int i = 0; i < n; i++) {
        double left = present[i] ? fabs(reading[i]) : 0;
        if (left < DIGITS)
            continue;
        while (step > DIGITS) {
            double rest = fmod(left, step);
            left = step;
            step = step - rest < DIGITS ? 0 : rest;
        }
        step = left;
    }
    return step;
}

/* Whether two channels agree a thousand times better than their noise wherever both were measured, so often that noise does not
 * make it: two independent readings are within d of each other with a probability of about d over the spread of noise, d no less
 * than the step of the digits. Their neighbours differ, else it is a mirror image without noise. */
static int is_copy(const struct search *search, int s, int t)
{
    const struct sensor_field *field = &search->field;
    int n = field->n, shared = 0;
    double chance = log(0.5 * n * n);
    for (int k = 0; k < field->nmode; k++) {
        const double *m = search->digits + (ptrdiff_t)k * n;
        const int *present = field->present + (ptrdiff_t)k * n;
        if (!present[s] || !present[t] || (m[s] == 0 && m[t] == 0)) /* two that are dead are no copies */
            continue;
        double apart = fabs(m[s] - m[t]), noise = sqrt(field->variance[s + k * n]);
        if (apart > COPY_APART * noise)
            return 0;
        shared++;
        chance += log(fmin(1, fmax(digit_step(n, m, present), 2 * apart) / noise));
    }
    return shared >= COPY_MODES && chance < log(search->false_alarm);
}

/* Copies into the first faults: which of the two is at the wrong place, the others say. */
static void find_copies(struct search *search, int most, struct sensor_fault *fault, int *nfault)
{
    struct sensor_field *field = &search->field;
    int n = field->n, first = *nfault, equal = 0;
    for (int s = 0; s < n; s++)
        for (int t = 0; t < s; t++) {
            if (field->masked[s] || field->masked[t] || !is_copy(search, s, t))
                continue;
            equal++;
            if (*nfault == most)
                continue;
            double of_s = likelihood_open(&search->suspect, s), of_t = likelihood_open(&search->suspect, t);
            fault[(*nfault)++] = (struct sensor_fault){.kind = FAULT_DUPLICATE,
                                                       .sensor = of_s > of_t ? s : t,
                                                       .other = of_s > of_t ? t : s,
                                                       .value = NAN,
                                                       .std = NAN,
                                                       .chi2_drop = fmax(of_s, of_t)};
        }
    if (MIRRORED * equal > n)
        *nfault = first;
    for (int j = first; j < *nfault; j++)
        take_out(field, &fault[j]);
}

static void find_all(struct search *search, int most, struct sensor_fault *fault, int *nfault)
{
    struct sensor_field *field = &search->field;
    *nfault = 0;
    find_copies(search, most, fault, nfault);
    while (*nfault < most && sensors_left(field) >= LEAST_SENSORS) {
        if (find_one(search, &fault[*nfault]))
            take_out(field, &fault[(*nfault)++]);
        else if (*nfault + 1 < most && find_pair(search, *nfault, fault))
            *nfault += 2;
        else
            break;
    }
}

/* Noise above what is stated roughens every shape and would be taken for faults. Sets the level that explains the sensors that
 * are left best; returns 1 where it is another. */
static int noise_above_stated(struct search *search, int nfault, const struct sensor_fault *fault)
{
    double best = 1, most;
    if (start_without(search, nfault, fault, -1))
        return 0;
    most = field_evidence(&search->field) + NOISE_MARGIN;
    for (int step = 1; step <= NOISE_STEPS; step++) {
        double factor = pow(NOISE_STEP, step);
        search->noise_factor = factor;
        if (start_without(search, nfault, fault, -1))
            break;
        double evidence = field_evidence(&search->field);
        if (evidence < most)
            break;
        most = evidence;
        best = factor;
    }
    search->noise_factor = best;
    return best > 1;
}

/* Once all faults are known, each is judged with all others taken out: a bad neighbour can make one look like another kind. */
static void judge_again(struct search *search, struct sensor_fault *fault, int *nfault)
{
    for (int j = 0; *nfault > 1 && j < *nfault;) {
        struct sensor_fault again;
        if (start_without(search, *nfault, fault, j))
            return;
        if (fault[j].kind == FAULT_DUPLICATE) {
            j++;
            continue;
        }
        if (certain(search, fault[j].sensor, &again)) {
            fault[j++] = again;
            continue;
        }
        for (int i = j; i + 1 < *nfault; i++)
            fault[i] = fault[i + 1];
        --*nfault;
    }
}

/* What was read in every mode, as large as what the field takes for its reading. */
static const double *digits_of(struct pool *pool, const struct sensor_field *field)
{
    int n = field->n;
    double *digits = POOL_ARRAY(pool, double, (size_t)n *(size_t)field->nmode);
    for (int k = 0; k < field->nmode && digits; k++) {
        const double *read = field->data->read + (ptrdiff_t)k * n, *reading = field->reading + (ptrdiff_t)k * n;
        const int *present = field->present + (ptrdiff_t)k * n;
        double largest = 0, as_read = 0;
        for (int i = 0; i < n; i++)
            if (present[i]) {
                largest = fmax(largest, fabs(reading[i]));
                as_read = fmax(as_read, fabs(read[i]));
            }
        for (int i = 0; i < n; i++)
            digits[i + (ptrdiff_t)k * n] = present[i] && as_read > 0 ? read[i] * (largest / as_read) : 0;
    }
    return digits;
}

int sensor_check(struct pool *pool, const struct shape_data *data, double false_alarm, int most, struct sensor_fault *fault,
                 int *nfault)
{
    struct search search;
    *nfault = 0;
    if (data->nsensor < LEAST_COPY || data->nmode < 1 || data->nmode > FIELD_MOST_MODES || data->naxis < 2)
        return ROTID_OK;
    int status = field_new(pool, data, &search.field);
    if (!status)
        status = likelihood_new(pool, &search.field, &search.suspect);
    if (status)
        return status;
    search.limit = POOL_ARRAY(pool, double, data->nsensor);
    search.left = POOL_ARRAY(pool, double, data->nsensor);
    search.work = POOL_ARRAY(pool, double, local_workspace(&search.field));
    search.digits = digits_of(pool, &search.field);
    if (!search.limit || !search.left || !search.work || !search.digits)
        return ROTID_ERROR_MEMORY;
    search.threshold = 2 * log(data->nsensor * FAULT_KINDS / false_alarm) * (1 + pow(FEW_SENSORS / data->nsensor, 3));
    search.noise_factor = 1;
    search.false_alarm = false_alarm;
    if (start_without(&search, 0, fault, -1))
        return ROTID_OK;
    find_all(&search, most, fault, nfault);
    if (*nfault && noise_above_stated(&search, *nfault, fault) && !start_without(&search, 0, fault, -1))
        find_all(&search, most, fault, nfault);
    judge_again(&search, fault, nfault);
    return ROTID_OK;
}
