#include "diagnose/sensor_check.h"

#include <math.h>

#include "diagnose/sensor_explain.h"
#include "diagnose/sensor_field.h"
#include "diagnose/sensor_local.h"

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
    struct explanation explanation[FAULT_KINDS];
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
