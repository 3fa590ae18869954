#include "score.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"

#define PLACE_TOLERANCE 0.03 /* of the length of the rotor */
#define VALUE_TOLERANCE 0.1  /* of a gain, a shift, a factor */
#define VALUE_STDS      4.0
#define BEST            3 /* causes fitted without noise */
#define NORMAL_95       1.959963984540054

const char *hidden_class_name(enum hidden_class class)
{
    static const char *const names[] = {"nothing", "one effect", "two effects", "data", "noise stated wrongly", "outside"};
    return names[class];
}

const char *hidden_outcome_name(enum hidden_outcome outcome)
{
    static const char *const names[] = {"right", "in set", "silent", "unexplained", "other set", "wrong", "failed"};
    return names[outcome];
}

int hidden_covers(const struct hidden_value *value)
{
    return value->lower <= value->truth && value->truth <= value->upper;
}

struct hidden_score hidden_score_none(void)
{
    return (struct hidden_score){.drop = NAN,
                                 .lesser = NAN,
                                 .before = NAN,
                                 .margin = NAN,
                                 .left = NAN,
                                 .place_error = NAN,
                                 .size_error = NAN,
                                 .outcome = HIDDEN_FAILED};
}

/* ---- the truth */

static const char *text_of(const cJSON *object, const char *key)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, key));
    return text ? text : "";
}

static double number_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItem(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

static double parameter_of(const cJSON *effect, const char *key)
{
    return number_of(cJSON_GetObjectItem(effect, "parameters"), key);
}

static int is(const cJSON *effect, const char *id)
{
    return !strcmp(text_of(effect, "id"), id);
}

/* Where a mass is that belongs to one place; NaN for other effects, and where an accelerometer moves. */
static double place_of_mass(const cJSON *truth, const cJSON *effect)
{
    const cJSON *sensor;
    if (is(effect, "added_mass"))
        return parameter_of(effect, "z");
    if (!is(effect, "accelerometer_mass"))
        return NAN;
    cJSON_ArrayForEach(sensor, cJSON_GetObjectItem(truth, "sensors"))
    {
        if (number_of(sensor, "id") == parameter_of(effect, "sensor"))
            return number_of(sensor, "z");
    }
    return NAN;
}

static double place_of_found_mass(const struct job *job, const struct candidate *c)
{
    if (!strcmp(c->cause->id, "added_mass"))
        return c->effect.value[c->cause->place];
    if (!strcmp(c->cause->id, "accelerometer_mass") && c->effect.variant && c->effect.target >= 0)
        return job->rotor.sensor[c->effect.target].position;
    return NAN;
}

/* The truth says "left,core" where a candidate says "left|core", and the number of a spring without a name. */
static int same_target(const struct candidate *c, const char *target)
{
    char name[2 * HIDDEN_NAME];
    snprintf(name, sizeof name, "%s", target);
    for (char *p = name; *p; p++)
        *p = *p == ',' ? '|' : *p;
    if (c->cause->target == TARGET_NONE || same_text(c->target, name))
        return 1;
    return (c->cause->target == TARGET_SPRING || c->cause->target == TARGET_DISK) && c->effect.target + 1 == atoi(name);
}

/* Whether z lies in the interval that the diagnosis states for the place of a candidate, which spans no more than that. */
static int is_stated(const struct candidate *c, double z, double widest)
{
    int p = c->cause->place;
    return p < c->nparameter && c->ci_upper[p] - c->ci_lower[p] <= widest && z >= c->ci_lower[p] && z <= c->ci_upper[p];
}

/* Whether a candidate is this effect: id, target, and place within one width, 3 % of the length or its stated interval, of
 * which more than `widest` of the length is no place. */
static int is_true(const struct job *job, const struct candidate *c, const cJSON *truth, const cJSON *effect, double widest)
{
    double length = number_of(truth, "length"), mass = place_of_mass(truth, effect), found = place_of_found_mass(job, c);
    if (isfinite(mass) || isfinite(found))
        return fabs(mass - found) <= PLACE_TOLERANCE * length;
    if (!c->cause->effect || !is(effect, c->cause->id))
        return 0;
    if (is(effect, "accelerometer_mass")) /* both move */
        return 1;
    if (!same_target(c, text_of(effect, "target")))
        return 0;
    if (c->cause->place < 0)
        return 1;
    double width = parameter_of(effect, "width"), z = parameter_of(effect, "z");
    return fabs(c->effect.value[c->cause->place] - z) <= fmax(isfinite(width) ? width : 0, PLACE_TOLERANCE * length) ||
           is_stated(c, z, widest * length);
}

static int which(const struct job *job, const struct candidate *c, const cJSON *truth, double widest)
{
    const cJSON *effects = cJSON_GetObjectItem(truth, "effects");
    for (int i = 0; i < cJSON_GetArraySize(effects); i++)
        if (!strcmp(text_of(cJSON_GetArrayItem(effects, i), "class"), "physical") &&
            is_true(job, c, truth, cJSON_GetArrayItem(effects, i), widest))
            return i;
    return -1;
}

int hidden_which(const struct job *job, const struct candidate *c, const cJSON *truth)
{
    return which(job, c, truth, HIDDEN_PLACE);
}

int hidden_truths(const struct diagnosis *d, const struct explanation *e, const cJSON *truth, double widest)
{
    int seen = 0, count = 0;
    for (int m = 0; m < e->nmember; m++) {
        int n = which(&d->job, &e->member[m], truth, widest);
        count += n >= 0 && !(seen & 1 << n);
        seen |= n >= 0 ? 1 << n : 0;
    }
    return count;
}

/* Whether its size lies where the catalogue does not look: then it is outside of that. */
static int is_beyond(const struct rotor *rotor, const cJSON *effect)
{
    const struct cause_kind *cause = catalogue_find(text_of(effect, "id"));
    if (!cause || !cause->effect || !cause->effect->nparameter)
        return 0;
    double lower, upper, value = parameter_of(effect, cause->effect->parameter[cause->size].name);
    struct effect at = {.kind = cause->effect, .target = -1};
    const char *target = text_of(effect, "target");
    int of_group = cause->target == TARGET_GROUP || cause->target == TARGET_INTERFACE;
    for (int g = 0; g < rotor->ngroup && of_group; g++) /* an interface has the name of the group before it, and a comma */
        if (!strncmp(rotor->group[g].name, target, strlen(rotor->group[g].name)))
            at.target = g;
    for (int i = 0; i < rotor->nspring && cause->target == TARGET_SPRING; i++)
        if (rotor->spring[i].name ? same_text(rotor->spring[i].name, target) : atoi(target) == i + 1)
            at.target = i;
    for (int i = 0; i < rotor->ndisk && cause->target == TARGET_DISK; i++)
        if (rotor->disk[i].name ? same_text(rotor->disk[i].name, target) : atoi(target) == i + 1)
            at.target = i;
    if (at.target < 0 && cause->target != TARGET_NONE && cause->target != TARGET_SENSOR)
        return 0;
    cause_range(cause, rotor, &at, cause->size, &lower, &upper);
    return value < lower || (value > upper && value != cause->parameter[cause->size].neutral);
}

static enum hidden_class class_of(const struct rotor *rotor, const cJSON *effects)
{
    const cJSON *first = cJSON_GetArrayItem(effects, 0);
    if (!first)
        return HIDDEN_NOTHING;
    if (!strcmp(text_of(first, "class"), "outside") || is_beyond(rotor, first))
        return HIDDEN_OUTSIDE;
    if (!strcmp(text_of(first, "class"), "data"))
        return is(first, "noise_level") ? HIDDEN_NOISE : HIDDEN_DATA;
    return cJSON_GetArraySize(effects) > 1 ? HIDDEN_PAIR : HIDDEN_PHYSICAL;
}

/* ---- findings about the data */

static int has_sensor(const rotid_data_finding *f, double id)
{
    for (int i = 0; i < f->nsensors; i++)
        if (f->sensors[i] == id)
            return 1;
    return 0;
}

static int finding_is_true(const rotid_data_finding *f, const cJSON *effect)
{
    const cJSON *sensors = cJSON_GetObjectItem(cJSON_GetObjectItem(effect, "parameters"), "sensors");
    const char *size = is(effect, "sensor_gain") ? "gain" : is(effect, "sensor_position") ? "shift" : "factor";
    double value = parameter_of(effect, size);
    if (!is(effect, f->id))
        return 0;
    if (is(effect, "mode_pairing"))
        return 1;
    for (int p = 0; is(effect, "sensor_line") && p < f->nparameters; p++) {
        const rotid_cause_value *found = &f->parameters[p];
        double given = parameter_of(effect, found->name), tolerance = !strcmp(found->name, "shift") ? 2e-3 : 5e-3;
        if (fabs(found->value - given) > fmax(VALUE_STDS * (isfinite(found->std) ? found->std : 0), tolerance))
            return 0;
    }
    if (is(effect, "sensor_line"))
        return f->nparameters > 0;
    if (is(effect, "noise_level") && strcmp(f->block ? f->block : "", text_of(effect, "target")) != 0)
        return 0;
    if (is(effect, "sensor_swap"))
        return has_sensor(f, cJSON_GetArrayItem(sensors, 0)->valuedouble) &&
               has_sensor(f, cJSON_GetArrayItem(sensors, 1)->valuedouble);
    if (!is(effect, "noise_level") && f->sensors[0] != parameter_of(effect, "sensor"))
        return 0;
    return isnan(value) || !isfinite(f->value) ||
           fabs(f->value - value) <= fmax(VALUE_STDS * f->std, VALUE_TOLERANCE * fabs(value));
}

/* Counts the accusations that are not true; 1 where one is. */
static int judge_findings(const struct diagnosis *d, const cJSON *effects, struct hidden_score *s)
{
    const cJSON *effect = cJSON_GetArrayItem(effects, 0);
    int found = 0;
    for (int i = 0; i < d->result.ndata_findings; i++) {
        const rotid_data_finding *f = &d->result.data_findings[i];
        int right = effect && finding_is_true(f, effect);
        found |= right;
        if (right || (s->coloured && !strcmp(f->id, "noise_level")))
            continue;
        s->channels += strcmp(f->id, "noise_level") != 0 && strcmp(f->id, "mode_pairing") != 0;
        if (!s->accused++ && s->class == HIDDEN_DATA)
            snprintf(s->wrong, sizeof s->wrong, "%s", f->id);
    }
    return found;
}

/* ---- chi2 */

/* The job with the data as they would be without noise, on the mesh of the diagnosis: that of the deck may be worth more than the
 * effect. */
static int quiet_job(struct pool *pool, const struct diagnosis *d, const struct job *read, const cJSON *truth, struct job *job)
{
    const cJSON *with = cJSON_GetObjectItem(truth, "with"), *hz = cJSON_GetObjectItem(with, "frequency_hz");
    const cJSON *shapes = cJSON_GetObjectItem(with, "shape"), *sensor;
    int nsensor = read->rotor.nsensor, row = 0;
    *job = *read;
    job->options.fit = d->job.options.fit;
    job->rotor.segment = d->job.rotor.segment;
    job->measurement.frequency_hz = POOL_ARRAY(pool, double, job->measurement.nmode);
    job->measurement.shape =
        job->measurement.shape ? POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)job->measurement.nmode) : NULL;
    if (!job->measurement.frequency_hz || (read->measurement.shape && !job->measurement.shape))
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < job->measurement.nmode; k++)
        job->measurement.frequency_hz[k] = cJSON_GetArrayItem(hz, k)->valuedouble;
    cJSON_ArrayForEach(sensor, cJSON_GetObjectItem(truth, "sensors"))
    {
        for (int s = 0; s < nsensor && job->measurement.shape; s++)
            for (int k = 0; k < job->measurement.nmode && job->rotor.sensor[s].id == number_of(sensor, "id"); k++)
                job->measurement.shape[s + (ptrdiff_t)k * nsensor] =
                    cJSON_GetArrayItem(cJSON_GetArrayItem(shapes, k), row)->valuedouble;
        row++;
    }
    return ROTID_OK;
}

static double fitted_chi2(struct pool *pool, const struct diagnosis *d, const struct job *job)
{
    rotid_fit_result *fit = NULL;
    double chi2 = NAN;
    struct state state;
    const struct states states = states_of(job, &state);
    int all = d->base.compared.nmode == job->measurement.nmode; /* or the diagnosis has left one out */
    if (!identify_fit_states(pool, &states, all ? d->base.compared.number : job->measurement.number, job->measurement.holdout,
                             &job->options.fit, NULL, &fit))
        chi2 = fit->chi2;
    rotid_fit_free(fit);
    return chi2;
}

int hidden_drop(struct pool *pool, const struct diagnosis *d, const struct job *read, const cJSON *truth, double *drop)
{
    struct job quiet;
    int status = quiet_job(pool, d, read, truth, &quiet);
    *drop = status ? NAN : fitted_chi2(pool, d, &quiet);
    return status;
}

/* Without noise: what the base model leaves, and outside the catalogue what the best single causes leave. */
static int measure_chi2(struct pool *pool, const struct diagnosis *d, const struct job *read, const cJSON *truth,
                        struct hidden_score *s)
{
    struct job quiet, with;
    int status = quiet_job(pool, d, read, truth, &quiet);
    if (status)
        return status;
    s->drop = fitted_chi2(pool, d, &quiet);
    for (int i = 0, tried = 0; s->class == HIDDEN_OUTSIDE && d->nround && i < d->round[0].ncandidate && tried < BEST; i++) {
        const struct candidate *c = &d->round[0].candidate[i];
        if (!c->result.refitted || !c->cause->effect || c->cause->solid ||
            !isfinite(c->result.chi2)) /* a solid has no effect to add */
            continue;
        tried++;
        status = job_with_effect(pool, &quiet, NULL, &c->effect, c->cause, c->fixed, &with);
        double chi2 = status ? NAN : fitted_chi2(pool, d, &with);
        if (isfinite(chi2) && !(s->left <= chi2))
            s->left = chi2;
    }
    return status;
}

/* Twice ln of the odds of the likeliest explanation all of whose causes are there over the likeliest other one. One of which some
 * are there neither leads nor is led. */
double hidden_lead(const struct diagnosis *d, const cJSON *truth)
{
    double right = -INFINITY, other = -INFINITY;
    for (int i = 0; i < d->posterior.count; i++) {
        const struct explanation *e = &d->posterior.item[i];
        int found = 0;
        for (int m = 0; m < e->nmember; m++)
            found += hidden_which(&d->job, &e->member[m], truth) >= 0;
        double *best = found ? &right : &other;
        if (!found || (found == e->nmember && !e->something_else))
            *best = fmax(*best, e->log_posterior);
    }
    return isfinite(right) ? fmin(2 * (right - other), 1e9) : NAN;
}

/* ---- intervals, places, sizes */

static void add_value(struct hidden_score *s, const char *id, const char *name, double truth, double estimate, double lower,
                      double upper)
{
    if (s->nvalue == HIDDEN_VALUES || !isfinite(truth))
        return;
    struct hidden_value *v = &s->value[s->nvalue++];
    *v = (struct hidden_value){.of = id[0] ? HIDDEN_OF_CAUSE : HIDDEN_OF_MODEL,
                               .truth = truth,
                               .estimate = estimate,
                               .lower = lower,
                               .upper = upper,
                               .known = NAN};
    snprintf(v->name, sizeof v->name, "%s%s%s", id, id[0] ? "." : "", name);
}

static void take_parameters(const struct job *job, const rotid_fit_result *fit, const cJSON *truth, struct hidden_score *s)
{
    const cJSON *parameter;
    cJSON_ArrayForEach(parameter, cJSON_GetObjectItem(truth, "parameters"))
    {
        for (int p = 0; p < fit->n; p++)
            if (same_text(job->unknowns.bounds[p].name, text_of(parameter, "name")))
                add_value(s, "", job->unknowns.bounds[p].name, number_of(parameter, "value"), fit->x[p], fit->ci_lower[p],
                          fit->ci_upper[p]);
    }
}

/* The averages over the explanations, and what is listed before the first one that has all that is there. */
static void take_posterior(const struct diagnosis *d, const cJSON *truth, struct hidden_score *s)
{
    const struct posterior *p = &d->posterior;
    const struct explanation *known = NULL;
    const cJSON *parameter;
    double before = 0;
    s->before = 1;
    for (int i = 0; i < p->count && s->truths; before += p->item[i++].probability) {
        const struct explanation *e = &p->item[i];
        int whole = hidden_truths(d, e, truth, 1) == s->truths;
        if (whole)
            s->before = fmin(s->before, before);
        if (whole && !known && e->nmember == s->truths && !e->something_else)
            known = e;
    }
    cJSON_ArrayForEach(parameter, cJSON_GetObjectItem(truth, "parameters"))
    {
        for (int q = 0; q < p->naveraged; q++) {
            const rotid_averaged_parameter *a = &p->averaged[q];
            int count = s->nvalue;
            if (!same_text(a->name, text_of(parameter, "name")))
                continue;
            add_value(s, "", a->name, number_of(parameter, "value"), a->value, a->ci95[0], a->ci95[1]);
            if (s->nvalue == count)
                continue;
            s->value[count].of = HIDDEN_OF_MIXTURE;
            snprintf(s->value[count].name, sizeof s->value[count].name, "%.40s, averaged", a->name);
            s->value[count].known = known ? NORMAL_95 * known->evidence.std[q] : NAN;
        }
    }
}

/* Of a cause that was named right. Depth and width of another form than the true one say nothing. */
static void take_cause(const struct candidate *c, const cJSON *truth, const cJSON *effect, struct hidden_score *s)
{
    const struct effect_kind *kind = c->effect.kind;
    const char *form = text_of(cJSON_GetObjectItem(effect, "parameters"), "shape");
    int size = c->cause->size;
    int comparable = !form[0] || (c->cause->variant[0] && same_text(c->cause->variant[c->effect.variant], form));
    for (int p = 0; p < c->nparameter; p++) {
        double value = p == c->cause->place && isfinite(place_of_mass(truth, effect))
                           ? place_of_mass(truth, effect)
                           : parameter_of(effect, kind->parameter[p].name);
        if (p == c->cause->place)
            s->place_error = fabs(c->effect.value[p] - value) / number_of(truth, "length");
        if (comparable || p == c->cause->place)
            add_value(s, c->cause->id, kind->parameter[p].name, value, c->effect.value[p], c->ci_lower[p], c->ci_upper[p]);
    }
    if (c->nparameter && comparable) {
        double neutral = c->cause->parameter[size].neutral, value = parameter_of(effect, kind->parameter[size].name);
        s->size_error = fabs((c->effect.value[size] - value) / (value - neutral));
    }
}

/* ---- the score */

static enum hidden_outcome judge_verdict(const struct diagnosis *d, const cJSON *truth, struct hidden_score *s)
{
    int found[2] = {0, 0}, wrong = 0, noise = 0;
    const cJSON *effect = cJSON_GetArrayItem(cJSON_GetObjectItem(truth, "effects"), 0);
    for (int i = 0; i < d->ncause; i++) {
        int n = hidden_which(&d->job, &d->cause[i], truth);
        if (n >= 0)
            found[n & 1] = 1;
        else if (!wrong++)
            snprintf(s->wrong, sizeof s->wrong, "%s", d->cause[i].cause->id);
    }
    if (wrong)
        return HIDDEN_WRONG;
    for (int i = 0; i < d->nalternative; i++) {
        int n = hidden_which(&d->job, &d->alternative[i], truth);
        if (n >= 0)
            found[n & 1] = 1;
        noise |= s->class == HIDDEN_NOISE && is(effect, d->alternative[i].cause->id);
    }
    s->nset = d->nalternative ? d->alternative[d->nalternative - 1].set : 0;
    s->found = found[0] + found[1];
    if (d->ncause)
        return HIDDEN_RIGHT;
    if (d->result.verdict.kind == ROTID_ADEQUATE)
        return HIDDEN_SILENT;
    if (d->result.verdict.kind == ROTID_AMBIGUOUS)
        return s->found || noise ? HIDDEN_IN_SET : HIDDEN_OTHER_SET;
    return HIDDEN_UNEXPLAINED;
}

enum hidden_outcome hidden_outcome_of(const struct diagnosis *d, const cJSON *truth)
{
    struct hidden_score score = hidden_score_none();
    score.class = HIDDEN_PHYSICAL;
    return judge_verdict(d, truth, &score);
}

int hidden_score_make(struct pool *pool, const struct diagnosis *d, const struct job *read, const cJSON *truth,
                      struct hidden_score *s)
{
    const cJSON *effects = cJSON_GetObjectItem(truth, "effects"), *effect = cJSON_GetArrayItem(effects, 0);
    s->class = class_of(&read->rotor, effects);
    s->truths = cJSON_GetArraySize(effects);
    snprintf(s->id, sizeof s->id, "%s", !effect ? "none" : text_of(effect, is(effect, "outside") ? "kind" : "id"));
    s->shapes = read->measurement.shape != NULL;
    s->coloured = number_of(cJSON_GetObjectItem(truth, "noise"), "correlation") != 0;
    s->reported = d->result.verdict.kind != ROTID_ADEQUATE;
    s->names = d->ncause;
    int found = judge_findings(d, effects, s), status = measure_chi2(pool, d, read, truth, s);
    s->margin = hidden_lead(d, truth);
    s->outcome = judge_verdict(d, truth, s);
    if ((s->class == HIDDEN_DATA || s->class == HIDDEN_NOISE) && s->outcome != HIDDEN_WRONG) {
        if (found)
            s->outcome = HIDDEN_RIGHT;
        else if (s->class == HIDDEN_DATA && s->accused)
            s->outcome = HIDDEN_WRONG;
    }
    if (s->class == HIDDEN_NOTHING && s->outcome == HIDDEN_SILENT)
        take_parameters(&d->job, d->base.fit, truth, s);
    int whole = s->outcome == HIDDEN_RIGHT && d->extended.fit && s->names == s->truths; /* the model has all that is there */
    if (whole && (s->class == HIDDEN_PHYSICAL || s->class == HIDDEN_PAIR))
        take_parameters(&d->extended_job, d->extended.fit, truth, s);
    take_posterior(d, truth, s);
    if (whole && s->class == HIDDEN_PHYSICAL)
        take_cause(&d->cause[0], truth, effect, s);
    return status;
}
