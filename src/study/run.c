/* One run of a study: the experiment, the fit, the diagnosis or the critical speeds of it, and the line that says so. */
#include "api/api.h"
#include "study/study.h"

#define PLACE_TOLERANCE 0.03 /* of the length of the rotor */

/* ---- the score: the verdict beside what was hidden */

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
        return fabs(mass - found) <= PLACE_TOLERANCE * rotor_length(&e->job->rotor);
    if (c->cause != truth->cause)
        return 0;
    if (c->cause->target != TARGET_NONE && c->cause->target != TARGET_SENSOR && c->effect.target != truth->effect->target)
        return 0;
    if (c->cause->place < 0)
        return 1;
    double width = c->cause->width >= 0 ? truth->effect->value[c->cause->width] : 0;
    return fabs(c->effect.value[c->cause->place] - truth->effect->value[c->cause->place]) <=
           fmax(width, PLACE_TOLERANCE * rotor_length(&e->job->rotor));
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

/* How many of the candidates are the hidden cause. */
static int count_hidden(const struct experiment *e, const struct diagnosis *d, int n, const struct candidate *list)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += score_is_hidden(e, d, &list[i]);
    return count;
}

enum score score_make(const struct experiment *e, const struct diagnosis *d)
{
    const struct truth *truth = e->made_by;
    int faults = score_false_findings(e, d), adequate = d->result.verdict.kind == ROTID_ADEQUATE;
    enum score silent = adequate ? SCORE_SILENT : SCORE_UNEXPLAINED;
    if (!truth->cause)
        return adequate && !d->ncause && !d->result.ndata_findings ? SCORE_QUIET : SCORE_FALSE_ALARM;
    if (count_hidden(e, d, d->ncause, d->cause) < d->ncause)
        return SCORE_WRONG;
    if (!truth->effect)
        return d->result.ndata_findings > faults ? SCORE_RIGHT : faults ? SCORE_WRONG : silent;
    if (d->ncause)
        return SCORE_RIGHT;
    if (d->result.verdict.kind == ROTID_AMBIGUOUS)
        return count_hidden(e, d, d->nalternative, d->alternative) ? SCORE_IN_SET : SCORE_OTHER_SET;
    return silent;
}

/* ---- the run */

/* A run while it is computed. What the result leans on goes with it. */
struct work {
    struct pool pool;
    const struct study *study;
    const rotid_environment *environment;
    struct message_list notes;
    struct experiment experiment;
    rotid_fit_result *fit; /* of an identification */
    struct diagnosis diagnosis;
    struct study_run run; /* the result */
};

/* Which run it is, with nothing found yet. */
static struct study_run begin(const struct study *study, long number)
{
    const struct plan *plan = study->plan;
    const struct study_point point = study_locate(study, number);
    const struct study_cell *cell = &point.cell;
    const struct plan_item *noise = plan_at(plan, cell, AXIS_NOISE);
    return (struct study_run){
        .run = (int)number,
        .cell = {.deck = plan_at(plan, cell, AXIS_DECK)->name,
                 .variant = plan_at(plan, cell, AXIS_VARIANT)->name,
                 .modes = plan_at(plan, cell, AXIS_MODES)->name,
                 .sensors = plan_at(plan, cell, AXIS_SENSORS)->name,
                 .noise_frequency = noise->name ? noise->frequency : NAN,
                 .noise_shape = noise->shape,
                 .hide = plan_at(plan, cell, AXIS_HIDE)->name},
        .replicate = (int)point.replicate,
        .start = (int)point.start,
        .sensors = ROTID_NONE,
        .score = ROTID_NONE,
        .false_findings = ROTID_NONE,
        .input = plan->path ? NULL : study->deck[cell->at[AXIS_DECK]].digest,
    };
}

/* seconds stand last, before the stamp: so two lines can be compared without them. */
static char *line_of(struct study_run *run, double seconds)
{
    run->seconds = round(seconds * 1e6) / 1e6;
    return record_text(&study_run_record, run, 0);
}

/* What acts in the data and not in the fitted model, with the values drawn for it. */
static struct run_hidden *hidden(struct pool *pool, struct truth *truth)
{
    const struct effect_parameter_name *parameter;
    struct run_hidden *out = POOL_NEW(pool, struct run_hidden);
    if (!out)
        return NULL;
    out->id = truth->cause->id;
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++) {
        const struct run_value value = {parameter->name, parameter->unit, *truth_value(truth, p)};
        (void)POOL_ADD(pool, out->parameters, out->nparameters, &value);
    }
    return out;
}

/* What a parameter of the fitted model is in truth: one of the experiment, or, in an extended model, one of the hidden effect
 * where that was named; NaN where that is not known. */
static double truth_of(const struct work *w, const char *name)
{
    const struct experiment *experiment = &w->experiment;
    const struct truth *truth = experiment->made_by;
    const struct diagnosis *d = &w->diagnosis;
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

/* What was fitted, as `identify` and `diagnose` have it, and what made the data. */
static int add_fit(struct work *w, const struct states *states, rotid_identification *fit)
{
    struct truth *made_by = w->experiment.made_by;
    struct study_run *run = &w->run;
    if (!fit)
        return ROTID_ERROR_MEMORY;
    run->fit = fit;
    run->status = !strcmp(fit->status, "not_converged") ? STUDY_NOT_CONVERGED
                  : !strcmp(fit->status, "at_bound")    ? STUDY_AT_BOUND
                                                        : STUDY_CONVERGED;
    run->sensors = 0;
    for (int s = 0; s < states->nstate; s++)
        run->sensors += states->state[s].job.rotor.nsensor;
    if (!made_by)
        return ROTID_OK;
    run->truth = POOL_ARRAY(&w->pool, rotid_component, 0); /* where none is known an object without keys */
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_component truth = {fit->parameters[p].name, truth_of(w, fit->parameters[p].name)};
        if (isfinite(truth.value))
            (void)POOL_ADD(&w->pool, run->truth, run->ntruth, &truth);
    }
    run->hidden = made_by->cause ? hidden(&w->pool, made_by) : NULL;
    return ROTID_OK;
}

/* The machine at the values of the fit, and at those that made the data where nothing else acts in these: what its speeds are in
 * truth. */
static int add_speeds(struct work *w)
{
    const struct experiment *experiment = &w->experiment;
    const struct states *states = &experiment->states;
    const struct machine *machine = states->machine;
    const struct job *job = experiment->job;
    struct speeds_options options = {
        .count = SPEEDS_COUNT, .harmonic = 1, .draws = w->study->plan->draws, .seed = w->study->seed, .threads = 1};
    rotid_fit_result own;
    int n = machine_unknowns(machine, job), known = experiment->made_by != NULL, count = 0;
    double *x = POOL_ARRAY(&w->pool, double, n);
    rotid_speeds *truth = POOL_NEW(&w->pool, rotid_speeds);
    int status = machine_fit(&w->pool, states, w->fit, &own);
    w->run.speeds = POOL_NEW(&w->pool, rotid_speeds);
    if (status || !x || !truth || !w->run.speeds)
        return status ? status : ROTID_ERROR_MEMORY;
    status = speeds_run(&w->pool, machine, job, own.x, &own, &options, w->environment, &w->notes, w->run.speeds);
    for (int p = 0; p < n; p++) {
        x[p] = p < job->unknowns.nparameter && experiment->truth ? experiment->truth[state_unknown(&states->state[0], p)]
                                                                 : machine_bounds(machine, job, p)->start;
        known = known && isfinite(x[p]) && !experiment->made_by->effect;
    }
    if (status || !known)
        return status;
    options.draws = 0;
    status = speeds_run(&w->pool, machine, job, x, NULL, &options, w->environment, &w->notes, truth);
    const struct study_run of_truth = {.speeds = truth};
    const rotid_fitted_parameter *value = status ? NULL : study_run_values(&w->pool, &of_truth, &count);
    for (int i = 0; value && i < count; i++) {
        const rotid_component speed = {value[i].name, value[i].value};
        (void)POOL_ADD(&w->pool, w->run.truth, w->run.ntruth, &speed);
    }
    return status;
}

static int identify(struct work *w)
{
    const struct plan *plan = w->study->plan;
    const struct states *states = &w->experiment.states;
    struct states joined = *states; /* with the run-up where that was measured: a model makes none */
    struct identification *found = POOL_ARRAY(&w->pool, struct identification, states->nstate);
    struct runup *runup = NULL;
    int status = found ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (plan->command == PLAN_SPEEDS && !states->machine)
        return message_refuse(&w->notes, ROTID_ERROR_ARGUMENT, NULL, 0, 0,
                              "the deck has no *RUNNING, expected the machine in operation behind it");
    if (!status && !plan->from_model)
        status = runup_join(&w->pool, states, &w->notes, &joined, &runup);
    if (!status)
        status = identify_states(&w->pool, &joined, IDENTIFY_BARE | (plan->baseline ? IDENTIFY_BASELINE : 0), w->environment,
                                 &w->notes, found, &w->fit);
    if (runup_close(runup))
        status = ROTID_ERROR_MEMORY;
    if (!status && w->fit->status == ROTID_STOP_CANCELLED)
        status = ROTID_STOP_CANCELLED;
    if (!status)
        status = add_fit(w, &joined, result_identification(&w->pool, &joined, found, w->fit));
    if (!status && !(plan->spread > 0)) /* the way from each start is what such a plan is about */
        w->run.fit->history = NULL;
    if (!status && !plan->baseline)
        w->run.fit->baseline = NULL;
    return status || plan->command != PLAN_SPEEDS ? status : add_speeds(w);
}

static int diagnose(struct work *w)
{
    const struct diagnose_options options = {.threads = 1};
    struct diagnosis *d = &w->diagnosis;
    struct states states = w->experiment.states;
    if (w->study->plan->from_model) /* which makes no run-up */
        states.machine = NULL;
    int status = diagnose_states(&w->pool, &states, &options, w->environment, &w->notes, d);
    if (status || d->result.interrupted)
        return status ? status : ROTID_STOP_CANCELLED;
    w->run.diagnosis = result_diagnosis(&w->pool, d->given.nstate ? &d->given : &w->experiment.states, d);
    status = add_fit(w, d->extended.fit ? &d->extended_states : &d->judged,
                     w->run.diagnosis->extended ? w->run.diagnosis->extended : w->run.diagnosis->base);
    if (status)
        return status;
    w->run.fit->history = NULL;
    w->run.fit->baseline = NULL;
    if (w->experiment.made_by) {
        w->run.score = (int)score_make(&w->experiment, d);
        w->run.false_findings = score_false_findings(&w->experiment, d);
    }
    return ROTID_OK;
}

static int compute(struct work *w, struct jobs *jobs, long number)
{
    const struct study_point point = study_locate(w->study, number);
    int status = experiment_make(&w->pool, jobs, &point, &w->notes, &w->experiment);
    if (!status)
        status = w->study->plan->command == PLAN_DIAGNOSE ? diagnose(w) : identify(w);
    if (environment_cancelled(w->environment))
        return ROTID_STOP_CANCELLED; /* what came behind the last look at it may be incomplete */
    if (!status)
        w->run.warnings = message_warnings(&w->notes, &w->pool, &w->run.nwarnings);
    return !status && w->pool.out_of_memory ? ROTID_ERROR_MEMORY : status;
}

int study_run(struct jobs *jobs, long run, const rotid_environment *environment, char **line)
{
    const double begun = clock_seconds();
    struct work w = {.study = jobs->study, .environment = environment, .run = begin(jobs->study, run)};
    const char *error = w.study->deck[study_locate(w.study, run).cell.at[AXIS_DECK]].error;
    pool_open(&w.pool, NULL);
    message_open(&w.notes, &w.pool);
    int status = error ? ROTID_OK : compute(&w, jobs, run);
    if (status < 0) { /* what the errors say, else what the status says */
        const char *said = message_errors(&w.notes, &w.pool);
        error = *said ? said : rotid_status_text(status);
    }
    *line = status == ROTID_STOP_CANCELLED ? NULL
            : error                        ? study_run_failed(w.study, run, error, clock_seconds() - begun)
                                           : line_of(&w.run, clock_seconds() - begun);
    rotid_fit_free(w.fit);
    diagnose_free(&w.diagnosis);
    pool_close(&w.pool);
    return status == ROTID_STOP_CANCELLED ? status : *line ? ROTID_OK : ROTID_ERROR_MEMORY;
}

char *study_run_failed(const struct study *study, long run, const char *error, double seconds)
{
    struct study_run failed = begin(study, run);
    failed.status = STUDY_FAILED;
    failed.error = error;
    return line_of(&failed, seconds);
}
