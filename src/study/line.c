#include "study/study.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/diagnose.h"
#include "result/result.h"

#define PLACE_TOLERANCE 0.03 /* of the length of the rotor */

/* Where a mass is that stays in one place; NaN for other effects, and where an accelerometer moves. */
static double place_of_mass(const struct rotor *rotor, const struct cause_kind *cause, const struct effect *effect)
{
    if (!strcmp(cause->id, "added_mass"))
        return effect->value[cause->place];
    if (!strcmp(cause->id, "accelerometer_mass") && effect->target >= 0 && effect->target < rotor->nsensor)
        return rotor->sensor[effect->target].position;
    return NAN;
}

/* Whether a candidate is the hidden cause by those rules. */
static int score_is_hidden(const struct experiment *e, const struct diagnosis *d, const struct candidate *c)
{
    const struct truth *truth = e->made_by;
    if (!truth->effect || c->state >= 0) /* it acts in all states */
        return 0;
    double mass = place_of_mass(&truth->job.rotor, truth->cause, truth->effect),
           found = place_of_mass(&d->job.rotor, c->cause, &c->effect);
    if (isfinite(mass) || isfinite(found))
        return fabs(mass - found) <= PLACE_TOLERANCE * e->length;
    if (c->cause != truth->cause)
        return 0;
    if (c->cause->target != TARGET_NONE && c->cause->target != TARGET_SENSOR && c->effect.target != truth->effect->target)
        return 0;
    if (c->cause->place < 0)
        return 1;
    double width = c->cause->width >= 0 ? truth->effect->value[c->cause->width] : 0;
    return fabs(c->effect.value[c->cause->place] - truth->effect->value[c->cause->place]) <=
           fmax(width, PLACE_TOLERANCE * e->length);
}

static int has_sensor(const rotid_data_finding *f, int id)
{
    for (int i = 0; i < f->nsensors; i++)
        if (f->sensors[i] == id)
            return 1;
    return 0;
}

static int finding_is_hidden(const struct experiment *e, const rotid_data_finding *f)
{
    const struct truth *truth = e->made_by;
    if (!truth->cause || truth->effect || strcmp(f->id, truth->cause->id) != 0)
        return 0;
    if (truth->fault.block)
        return f->block && !strcmp(f->block, truth->fault.block);
    for (int i = 0; i < truth->fault.nsensor; i++)
        if (!has_sensor(f, truth->fault.sensor[i]) && (i == 0 || !strcmp(truth->cause->id, "sensor_swap")))
            return 0;
    return 1;
}

/* Faults of the data that were found and not hidden. */
static int score_false_findings(const struct experiment *e, const struct diagnosis *d)
{
    int count = 0;
    for (int i = 0; i < d->result.ndata_findings; i++)
        count += !finding_is_hidden(e, &d->result.data_findings[i]);
    return count;
}

static int is_in_set(const struct experiment *e, const struct diagnosis *d)
{
    for (int i = 0; i < d->nalternative; i++)
        if (score_is_hidden(e, d, &d->alternative[i]))
            return 1;
    return 0;
}

enum score score_make(const struct experiment *e, const struct diagnosis *d)
{
    const struct truth *truth = e->made_by;
    int wrong = 0, faults = score_false_findings(e, d), found = d->result.ndata_findings > faults;
    if (!truth->cause)
        return d->result.verdict.kind == ROTID_ADEQUATE && !d->ncause && !d->result.ndata_findings ? SCORE_QUIET
                                                                                                   : SCORE_FALSE_ALARM;
    for (int i = 0; i < d->ncause; i++)
        wrong |= !score_is_hidden(e, d, &d->cause[i]);
    if (wrong)
        return SCORE_WRONG;
    if (!truth->effect)
        return found                                      ? SCORE_RIGHT
               : faults                                   ? SCORE_WRONG
               : d->result.verdict.kind == ROTID_ADEQUATE ? SCORE_SILENT
                                                          : SCORE_UNEXPLAINED;
    if (d->ncause)
        return SCORE_RIGHT;
    if (d->result.verdict.kind == ROTID_AMBIGUOUS)
        return is_in_set(e, d) ? SCORE_IN_SET : SCORE_OTHER_SET;
    return d->result.verdict.kind == ROTID_ADEQUATE ? SCORE_SILENT : SCORE_UNEXPLAINED;
}

/* Which run it is. */
static struct study_run begin(const struct line *line)
{
    const struct plan *plan = line->study->plan;
    const struct study_cell *cell = &line->point.cell;
    const struct plan_noise *noise = &plan->noise[cell->noise];
    return (struct study_run){
        .run = (int)line->run,
        .cell = {.deck = plan->deck[cell->deck].name,
                 .variant = plan->variant[cell->variant].name,
                 .modes = plan->modes[cell->modes].text,
                 .sensors = plan->sensors[cell->sensors].text,
                 .noise_frequency = plan->has_noise ? noise->frequency : NAN,
                 .noise_shape = plan->has_noise ? noise->shape : NAN,
                 .hide = plan->hide[cell->hide].name},
        .replicate = (int)line->point.replicate,
        .start = (int)line->point.start,
    };
}

/* The pool, on which parts of the run hang, is closed. whole 0: memory was out. seconds stand last, before the stamp: so two
 * lines can be compared without them. */
static char *end(struct pool *pool, struct study_run *run, int whole, double seconds)
{
    struct json_tree tree;
    run->seconds = round(seconds * 1e6) / 1e6;
    json_open(&tree);
    record_write(&tree, tree.root, &study_run_record, run);
    tree.failed |= !whole;
    pool_close(pool);
    return json_close_line(&tree);
}

char *line_failed(const struct line *line, const char *error, double seconds)
{
    struct pool pool;
    struct study_run run = begin(line);
    pool_open(&pool, NULL);
    run.status = STUDY_FAILED;
    run.error = error;
    return end(&pool, &run, 1, seconds);
}

static struct run_parameter *parameters(struct pool *pool, const rotid_parameter *bounds, const rotid_fit_result *fit,
                                        const double *truth)
{
    struct run_parameter *list = POOL_ARRAY(pool, struct run_parameter, fit->n);
    for (int p = 0; p < fit->n && list; p++)
        list[p] = (struct run_parameter){.name = bounds[p].name,
                                         .unit = bounds[p].unit,
                                         .value = fit->x[p],
                                         .start = bounds[p].start,
                                         .std = fit->std[p],
                                         .ci95 = {fit->ci_lower[p], fit->ci_upper[p]},
                                         .at_bound = fit->at_bound[p],
                                         .identifiable = fit->identifiable[p],
                                         .truth = truth ? truth[p] : NAN};
    return list;
}

/* What was fitted: of a deck with several states each, with the predictions for it. */
struct fitted {
    const char *state; /* NULL of a deck that is one */
    const struct job *job;
    const struct comparison *compared;
};

/* The modes of all states one behind the other, as the fit has them. */
static struct run_mode *modes(struct pool *pool, int count, const struct fitted *fitted, const rotid_fit_result *fit)
{
    struct run_mode *list = POOL_ARRAY(pool, struct run_mode, fit->m);
    for (int s = 0, row = 0; s < count && list; s++) {
        const struct job_measurement *measured = &fitted[s].job->measurement;
        for (int k = 0; k < measured->nmode && row < fit->m; k++, row++)
            list[row] = (struct run_mode){.state = fitted[s].state,
                                          .mode = fitted[s].compared->number[k],
                                          .measured_hz = measured->frequency_hz[k],
                                          .predicted_hz = fit->predicted_hz[row],
                                          .error_percent = 100 * (fit->predicted_hz[row] / measured->frequency_hz[k] - 1),
                                          .nco = fitted[s].compared->nco[k],
                                          .holdout = measured->holdout && measured->holdout[k]};
    }
    return list;
}

/* What acts in the data and not in the fitted model, with the values drawn for it. */
static struct run_hidden *hidden(struct pool *pool, const struct truth *truth)
{
    const struct effect_parameter_name *parameter;
    struct run_hidden *out = POOL_NEW(pool, struct run_hidden);
    struct correction fault = truth->fault;
    int n = 0;
    while (truth_parameter(truth, n))
        n++;
    if (!out || !(out->parameters = POOL_ARRAY(pool, struct run_value, n)))
        return NULL;
    out->id = truth->cause->id;
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++)
        out->parameters[out->nparameters++] = (struct run_value){
            parameter->name, parameter->unit, truth->effect ? truth->effect->value[p] : *correction_value(&fault, p)};
    return out;
}

/* 0: memory is out; of all below. */
static int add_fit(struct pool *pool, const struct experiment *experiment, int count, const struct fitted *fitted,
                   const rotid_parameter *bounds, const rotid_fit_result *fit, const double *truth, struct study_run *run)
{
    const struct job *job = fitted[0].job;
    struct run_fit *out = POOL_NEW(pool, struct run_fit);
    int sensors = 0;
    for (int s = 0; s < count; s++)
        sensors += fitted[s].job->rotor.nsensor;
    if (!out)
        return 0;
    run->fit = out;
    run->status = !fit->converged ? STUDY_NOT_CONVERGED : fit->any_at_bound ? STUDY_AT_BOUND : STUDY_CONVERGED;
    *out = (struct run_fit){
        .functional = functional_words[job->options.fit.functional],
        .reduction = reduction_words[job->options.fit.reduction],
        .objective = fit->objective,
        .chi2_per_dof = fit->chi2_per_dof,
        .dof = fit->dof,
        .iterations = fit->iterations,
        .evaluations = fit->evaluations,
        .stop_reason = rotid_status_text(fit->status),
        .sensors = sensors,
        .nparameters = fit->n,
        .parameters = parameters(pool, bounds, fit, truth),
        .nmodes = fit->m,
        .modes = modes(pool, count, fitted, fit),
    };
    int hides = experiment->made_by && experiment->made_by->cause;
    if (hides)
        out->hidden = hidden(pool, experiment->made_by);
    return out->parameters && out->modes && (!hides || out->hidden);
}

static int add_baseline(struct pool *pool, const rotid_fit_result *fit, struct study_run *run)
{
    run->baseline = POOL_ARRAY(pool, struct run_minimiser, fit->nbaseline);
    for (int i = 0; i < fit->nbaseline && run->baseline; i++)
        run->baseline[run->nbaseline++] = (struct run_minimiser){
            fit->baseline[i].algorithm, fit->baseline[i].usable, fit->baseline[i].objective, fit->baseline[i].evaluations, fit->n,
            fit->baseline[i].x};
    return run->baseline != NULL;
}

char *line_identified(const struct line *line, const struct experiment *experiment, const struct identification *result,
                      const rotid_fit_result *fit, const struct message_list *notes)
{
    struct pool pool;
    struct study_run run = begin(line);
    int count = experiment->states.nstate;
    pool_open(&pool, NULL);
    struct fitted *fitted = POOL_ARRAY(&pool, struct fitted, count);
    for (int s = 0; s < count && fitted; s++)
        fitted[s] = (struct fitted){count > 1 ? experiment->states.state[s].name : NULL, &experiment->states.state[s].job,
                                    &result[s].compared};
    int whole = fitted && add_fit(&pool, experiment, count, fitted, experiment->states.bounds, fit, experiment->truth, &run) &&
                (run.warnings = message_warnings(notes, &pool, &run.nwarnings)) &&
                (!line->study->plan->baseline || add_baseline(&pool, fit, &run));
    if (line->study->plan->spread > 0) { /* the way from each start is what such a plan is about */
        run.niterates = fit->n * fit->nhistory;
        run.iterates = fit->history_x;
    }
    return end(&pool, &run, whole, clock_seconds() - line->begin);
}

static struct run_cause *causes(struct pool *pool, int count, const struct candidate *candidate)
{
    const struct effect_parameter_name *parameter;
    struct run_cause *list = POOL_ARRAY(pool, struct run_cause, count);
    for (int i = 0; i < count && list; i++) {
        int n = 0;
        while (candidate_parameter(&candidate[i], n))
            n++;
        list[i] = (struct run_cause){.id = candidate[i].cause->id,
                                     .target = candidate[i].target ? candidate[i].target : "",
                                     .state = candidate[i].state_name,
                                     .parameters = POOL_ARRAY(pool, struct run_cause_parameter, n)};
        if (!list[i].parameters)
            return NULL;
        for (int p = 0; (parameter = candidate_parameter(&candidate[i], p)); p++)
            list[i].parameters[list[i].nparameters++] =
                (struct run_cause_parameter){parameter->name, parameter->unit, candidate[i].effect.value[p], candidate[i].std[p]};
    }
    return list;
}

static int add_diagnosis(struct pool *pool, const struct experiment *experiment, const struct diagnosis *d, struct study_run *run)
{
    struct run_diagnosis *out = POOL_NEW(pool, struct run_diagnosis);
    if (!out)
        return 0;
    run->diagnosis = out;
    *out = (struct run_diagnosis){
        .verdict = {.kind = d->result.verdict.kind,
                    .adequate_after = d->result.verdict.adequate_after,
                    .p_value = d->result.verdict.p_value,
                    .ncauses = d->ncause,
                    .causes = causes(pool, d->ncause, d->cause),
                    .nalternatives = d->nalternative,
                    .alternatives = causes(pool, d->nalternative, d->alternative)},
        .data_findings = POOL_ARRAY(pool, struct run_finding, d->result.ndata_findings),
        .score = experiment->made_by ? (int)score_make(experiment, d) : -1,
        .false_findings = experiment->made_by ? score_false_findings(experiment, d) : ROTID_NONE,
    };
    for (int i = 0; i < d->result.ndata_findings && out->data_findings; i++) {
        const rotid_data_finding *finding = &d->result.data_findings[i];
        out->data_findings[out->ndata_findings++] = (struct run_finding){finding->id,      finding->state, finding->nsensors,
                                                                         finding->sensors, finding->block, finding->value};
    }
    return out->verdict.causes && out->verdict.alternatives && out->data_findings;
}

/* What a parameter of the extended model is in truth: one of the experiment, or one of the hidden effect where it was named. */
static double extended_truth(const struct experiment *experiment, const struct diagnosis *d, const char *name)
{
    const struct truth *truth = experiment->made_by;
    const char *dot = strrchr(name, '.');
    for (int p = 0; p < experiment->states.nparameter; p++)
        if (same_text(name, experiment->states.bounds[p].name))
            return experiment->truth[p];
    for (int i = 0; i < d->ncause && dot; i++) {
        const struct candidate *c = &d->cause[i];
        size_t length = strlen(c->effect.name);
        if (c->cause != truth->cause || c->effect.variant != truth->effect->variant || !score_is_hidden(experiment, d, c) ||
            (size_t)(dot - name) != length || strncmp(name, c->effect.name, length) != 0)
            continue;
        for (int p = 0; truth_parameter(truth, p); p++)
            if (same_text(dot + 1, truth_parameter(truth, p)->name))
                return truth->effect->value[p];
    }
    return NAN;
}

char *line_diagnosed(const struct line *line, const struct experiment *experiment, const struct diagnosis *d,
                     const struct message_list *notes)
{
    const struct states *final = d->extended.fit ? &d->extended_states : &d->judged;
    const struct identification *of = d->extended.fit ? d->state_extended : d->state_base;
    const rotid_fit_result *fit = d->extended.fit ? d->extended.fit : d->base.fit;
    struct pool pool;
    struct study_run run = begin(line);
    pool_open(&pool, NULL);
    double *truth = POOL_ARRAY(&pool, double, final->nparameter);
    struct fitted *fitted = POOL_ARRAY(&pool, struct fitted, final->nstate);
    for (int p = 0; p < final->nparameter && truth && experiment->made_by; p++)
        truth[p] = extended_truth(experiment, d, final->bounds[p].name);
    for (int s = 0; s < final->nstate && fitted; s++)
        fitted[s] = (struct fitted){final->nstate > 1 ? final->state[s].name : NULL, &final->state[s].job, &of[s].compared};
    int whole = fit && truth && fitted &&
                add_fit(&pool, experiment, final->nstate, fitted, final->bounds, fit, experiment->made_by ? truth : NULL, &run) &&
                (run.warnings = message_warnings(notes, &pool, &run.nwarnings)) && add_diagnosis(&pool, experiment, d, &run);
    return end(&pool, &run, whole, clock_seconds() - line->begin);
}
