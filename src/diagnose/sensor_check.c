#include "diagnose/sensor_check.h"

#include <math.h>

#include "diagnose/sensor_explain.h"
#include "diagnose/sensor_field.h"
#include "diagnose/sensor_local.h"

/* With fewer sensors the neighbours cannot say what a sensor should read. */
#define LEAST_SENSORS 8
/* What a higher noise must gain in log likelihood. */
#define NOISE_MARGIN 5.0

struct search {
    struct sensor_field field;
    struct suspect suspect;
    double threshold; /* of the score */
    double *limit;    /* [n] */
    double *work;     /* of local_physics */
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

/* The best explanation of sensor s into *fault. Returns its score, or -INFINITY where it is certain to stay below `least`. */
static double judge(struct search *search, int s, double least, struct sensor_fault *fault)
{
    struct explanation explanation[FAULT_KINDS];
    int best = 0, rival = -1;
    double limit = suspect_open(&search->suspect, s);
    if (limit < search->threshold / 2) /* of a swap, each of the two sensors must show half */
        return -INFINITY;
    suspect_explain(&search->suspect, limit < least, explanation);
    for (int kind = 1; kind < FAULT_KINDS; kind++)
        if (explanation[kind].score > explanation[best].score)
            best = kind;
    for (int kind = 0; kind < FAULT_KINDS; kind++)
        if (kind != best && (rival < 0 || explanation[kind].drop > explanation[rival].drop))
            rival = kind;
    *fault = (struct sensor_fault){.kind = (enum sensor_fault_kind)best,
                                   .sensor = s,
                                   .other = explanation[best].other,
                                   .value = explanation[best].value,
                                   .std = explanation[best].std,
                                   .chi2_drop = explanation[best].drop,
                                   .alternative = explanation[rival].drop,
                                   .alternative_kind = (enum sensor_fault_kind)rival};
    if (explanation[best].score <= least)
        return -INFINITY;
    double physics = 2 * (local_physics(&search->field, s, search->work) - search->suspect.sound);
    return explanation[best].score - fmax(physics, 0);
}

static void take_out(struct sensor_field *field, const struct sensor_fault *fault)
{
    if (fault->kind == FAULT_SWAP)
        field_exchange(field, fault->sensor, fault->other);
    else
        field_mask(field, fault->sensor);
}

static void find_all(struct search *search, int most, struct sensor_fault *fault, int *nfault)
{
    struct sensor_field *field = &search->field;
    for (*nfault = 0; *nfault < most && sensors_left(field) >= LEAST_SENSORS; ++*nfault) {
        double worst = search->threshold;
        int found = -1;
        for (int s = 0; s < field->n; s++)
            search->limit[s] = field->masked[s] ? -INFINITY : suspect_open(&search->suspect, s);
        for (;;) { /* the most suspicious first, so that the others need less work */
            struct sensor_fault candidate;
            int s = 0;
            for (int i = 1; i < field->n; i++)
                if (search->limit[i] > search->limit[s])
                    s = i;
            if (search->limit[s] < search->threshold / 2)
                break;
            search->limit[s] = -INFINITY;
            double score = judge(search, s, worst, &candidate);
            if (score > worst) {
                worst = score;
                found = s;
            }
        }
        if (found < 0)
            return;
        judge(search, found, -INFINITY, &fault[*nfault]);
        take_out(field, &fault[*nfault]);
    }
}

/* Noise above what is stated roughens every shape and would be taken for faults. What explains the sensors that are left best? */
static double noise_above_stated(struct search *search, int nfault, const struct sensor_fault *fault)
{
    static const double factor[] = {1, 1.4, 2, 2.8, 4};
    double best = 1, most = -INFINITY;
    for (int i = 0; i < (int)(sizeof factor / sizeof *factor); i++) {
        if (field_start(&search->field, factor[i]))
            return best;
        for (int j = 0; j < nfault; j++)
            take_out(&search->field, &fault[j]);
        double evidence = field_evidence(&search->field) - (i ? NOISE_MARGIN : 0);
        if (evidence > most) {
            most = evidence;
            best = factor[i];
        }
    }
    return best;
}

int sensor_check(struct pool *pool, const struct shape_data *data, double false_alarm, int most, struct sensor_fault *fault,
                 int *nfault)
{
    struct search search;
    *nfault = 0;
    if (data->nsensor < LEAST_SENSORS || data->nmode < 1 || data->nmode > FIELD_MOST_MODES || data->naxis < 2)
        return ROTID_OK;
    int status = field_new(pool, data, &search.field);
    if (!status)
        status = suspect_new(pool, &search.field, &search.suspect);
    if (status)
        return status;
    search.limit = POOL_ARRAY(pool, double, data->nsensor);
    search.work = POOL_ARRAY(pool, double, local_workspace(&search.field));
    if (!search.limit || !search.work)
        return ROTID_ERROR_MEMORY;
    if (field_start(&search.field, 1))
        return ROTID_OK;
    search.threshold = 2 * log(data->nsensor * FAULT_KINDS / false_alarm);
    find_all(&search, most, fault, nfault);
    if (*nfault) {
        double factor = noise_above_stated(&search, *nfault, fault);
        if (factor > 1 && !field_start(&search.field, factor))
            find_all(&search, most, fault, nfault);
    }
    return ROTID_OK;
}
