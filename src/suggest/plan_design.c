/* Where sensors could stand, and what they would say there: columns of parameters and of the causes of the catalogue. */
#include <math.h>

#include "diagnose/scan.h"
#include "suggest/plan.h"
#include "suggest/planned.h"

#define MOST_PLACES  100
#define APART        0.02 /* of the length: nearer sensors share their noise, and seldom fit beside each other */
#define CAUSE_PLACES 9    /* where a cause that has a place is looked for */

static const struct effect_kind nothing = {.id = "none"};

int places_find(struct pool *pool, const struct job *job, struct places *places)
{
    const struct rotor *rotor = &job->rotor;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    int failed, status = model ? model_open(pool, job->models, rotor, 0, NULL, 1, model, &failed) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    int stride = (model->naxis + MOST_PLACES - 1) / MOST_PLACES, *sensor = POOL_ARRAY(pool, int, model->naxis);
    *places = (struct places){.z = POOL_ARRAY(pool, double, model->naxis),
                              .deck = POOL_ARRAY(pool, int, model->naxis),
                              .apart = APART * rotor_length(rotor)};
    if (!places->z || !places->deck || !sensor)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsensor; s++) { /* a sensor near a node is read there: no other one has room */
        int node = 0;
        for (int i = 1; i < model->naxis; i++)
            if (fabs(model->z[i] - rotor->sensor[s].position) < fabs(model->z[node] - rotor->sensor[s].position))
                node = i;
        sensor[node] = s + 1;
    }
    for (int i = 0; i < model->naxis; i++) {
        if (!sensor[i] && i % stride)
            continue;
        places->deck[places->n] = sensor[i] > 0;
        places->z[places->n++] = sensor[i] ? rotor->sensor[sensor[i] - 1].position : model->z[i];
    }
    return ROTID_OK;
}

/* Effects at neutral whose sizes are the targets, with the size worth looking for. */
struct targets {
    int n;
    struct effect *effect;
    int *size;
    double *typical;
};

static int list_targets(struct pool *pool, const struct job *job, struct targets *t)
{
    struct scan scan;
    struct state state;
    const struct states states = states_of(job, &state);
    int status = scan_list(pool, &states, &scan);
    double length = rotor_length(&job->rotor);
    if (status)
        return status;
    size_t room = (size_t)scan.ncandidate * CAUSE_PLACES;
    *t = (struct targets){0, POOL_ARRAY(pool, struct effect, room), POOL_ARRAY(pool, int, room), POOL_ARRAY(pool, double, room)};
    if (!t->effect || !t->size || !t->typical)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan.ncandidate; i++) {
        const struct scan_candidate *c = &scan.candidate[i];
        const struct cause_kind *cause = c->cause;
        double typical = cause->parameter[cause->size].typical - cause->parameter[cause->size].neutral, lower, upper;
        if (c->suspect || cause->solid || cause->secant || !cause->effect->nparameter || cause->target == TARGET_SENSOR ||
            typical == 0)
            continue;
        int places = cause->place >= 0 ? CAUSE_PLACES : 1;
        for (int j = 0; j < places; j++) {
            struct effect effect = c->effect;
            if (cause->place >= 0)
                effect.value[cause->place] = length * (j + 0.5) / CAUSE_PLACES;
            if (cause->width >= 0) {
                cause->bounds(&job->rotor, &effect, cause->width, &lower, &upper);
                effect.value[cause->width] = sqrt(lower * upper);
            }
            t->effect[t->n] = effect;
            t->size[t->n] = cause->size;
            t->typical[t->n++] = typical;
        }
    }
    return ROTID_OK;
}

static double scale_of(const struct job *job, int p, double x)
{
    const rotid_parameter *b = &job->unknowns.bounds[p];
    return x != 0 ? fabs(x) : fmax(fabs(b->lower), fabs(b->upper));
}

static int fill(struct columns *c, const struct job *job, const double *x, const struct targets *t, struct design *d)
{
    int status = ROTID_OK, rows = c->nrow;
    for (int p = 0; p < d->nparam && !status; p++) {
        double *column = d->column + (ptrdiff_t)p * rows;
        status = columns_parameter(c, p, column);
        for (int i = 0; i < rows; i++)
            column[i] *= scale_of(job, p, x[p]);
        d->prior[p + (ptrdiff_t)p * d->nparam] = 1;
    }
    for (int i = 0; i < t->n && !status; i++) {
        double *column = d->column + (ptrdiff_t)(d->nparam + i) * rows;
        status = columns_probe(c, &t->effect[i]);
        if (!status)
            status = columns_parameter(c, d->nparam + t->size[i], column);
        for (int r = 0; r < rows; r++)
            column[r] *= t->typical[i];
    }
    for (int k = 0; k < d->nmode && !status; k++)
        for (int i = 0; i < d->nplace; i++) {
            ptrdiff_t cell = i + (ptrdiff_t)k * d->nplace;
            d->scale[cell] = c->mode[k].weighted[i];
            d->largest[cell] = fabs(job->measurement.shape[cell]);
        }
    return status;
}

int plan_design(struct pool *pool, const struct job *job, const double *x, const struct places *places, int modes,
                double frequency_std, double shape_std, struct design *design)
{
    struct effect none = {.kind = &nothing};
    struct columns *c = POOL_NEW(pool, struct columns);
    struct targets targets;
    struct job at;
    int *number = POOL_ARRAY(pool, int, modes), *holdout = POOL_ARRAY(pool, int, modes);
    if (!c || !number || !holdout)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < modes; k++)
        number[k] = k + 1;
    const struct planned plan = {modes, number, frequency_std, shape_std};
    int status = planned_sensors(pool, job, places->n, places->z, &at);
    if (!status)
        status = planned_measure(pool, &at, x, &plan, &at);
    if (!status)
        status = list_targets(pool, &at, &targets);
    if (!status)
        status = design_new(pool, modes, places->n, job->unknowns.nparameter, targets.n, design);
    if (!status)
        status = columns_open(pool, &at, number, holdout, &none, x, c);
    if (!status)
        status = columns_prepare(c);
    return status ? status : fill(c, &at, x, &targets, design);
}
