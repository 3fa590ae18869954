/* One run of a study: the experiment, the fit, the diagnosis or the critical speeds of it, and the line that says so. */
#include "study/study.h"

#include <math.h>
#include <string.h>

#include "api/api.h"

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

/* ---- the line */

struct line {
    const struct study *study;
    long run;
    struct study_point point;
    double begin; /* on the clock */
};

/* What was fitted and, of *RUNNING, computed from it. */
struct fitted {
    const struct states *states;  /* with the unknowns of the machine where its run-up was fitted */
    struct identification *found; /* [states] */
    rotid_fit_result *fit;        /* of all */
    rotid_speeds *speeds, *truth; /* NULL without; truth: of the model that made the data */
};

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
        .sensors = ROTID_NONE,
        .score = ROTID_NONE,
        .false_findings = ROTID_NONE,
        .input = plan->path ? NULL : line->study->deck[cell->deck].digest,
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

static char *line_failed(const struct line *line, const char *error, double seconds)
{
    struct pool pool;
    struct study_run run = begin(line);
    pool_open(&pool, NULL);
    run.status = STUDY_FAILED;
    run.error = error;
    return end(&pool, &run, 1, seconds);
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

/* What a parameter of the fitted model is in truth: one of the experiment, or, in an extended model, one of the hidden effect
 * where that was named; NaN where that is not known. d: NULL of an identification. */
static double truth_of(const struct experiment *experiment, const struct diagnosis *d, const char *name)
{
    const struct truth *truth = experiment->made_by;
    const char *dot = strrchr(name, '.');
    for (int p = 0; p < experiment->states.nparameter; p++)
        if (same_text(name, experiment->states.bounds[p].name))
            return experiment->truth[p];
    for (int i = 0; d && i < d->ncause && dot; i++) {
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

/* What was fitted, as `identify` and `diagnose` have it, and what made the data. 0: memory is out. */
static int add_fit(struct pool *pool, const struct experiment *experiment, const struct diagnosis *d, const struct states *states,
                   rotid_identification *fit, const struct message_list *notes, struct study_run *run)
{
    const struct truth *made_by = experiment->made_by;
    if (!fit)
        return 0;
    run->fit = fit;
    run->status = !strcmp(fit->status, "not_converged") ? STUDY_NOT_CONVERGED
                  : !strcmp(fit->status, "at_bound")    ? STUDY_AT_BOUND
                                                        : STUDY_CONVERGED;
    run->sensors = 0;
    for (int s = 0; s < states->nstate; s++)
        run->sensors += states->state[s].job.rotor.nsensor;
    if (made_by && !POOL_LIST(pool, run->truth, fit->nparameters) && fit->nparameters)
        return 0;
    for (int p = 0; p < fit->nparameters && made_by; p++) {
        double truth = truth_of(experiment, d, fit->parameters[p].name);
        if (isfinite(truth))
            run->truth[run->ntruth++] = (rotid_component){fit->parameters[p].name, truth};
    }
    if (made_by && made_by->cause && !(run->hidden = hidden(pool, made_by)))
        return 0;
    run->warnings = message_warnings(notes, pool, &run->nwarnings);
    return run->warnings && !pool->out_of_memory;
}

/* What the machine is in truth beside the values of the parameters. */
static int add_speeds(struct pool *pool, const struct fitted *fitted, struct study_run *run)
{
    run->speeds = fitted->speeds;
    if (!fitted->truth || !run->truth)
        return 1;
    const struct study_run truth = {.speeds = fitted->truth};
    int count;
    const rotid_fitted_parameter *value = study_run_values(pool, &truth, &count);
    rotid_component *all = POOL_ARRAY(pool, rotid_component, run->ntruth + count);
    if (!value || !all)
        return 0;
    memcpy(all, run->truth, (size_t)run->ntruth * sizeof *all);
    for (int i = 0; i < count; i++)
        all[run->ntruth++] = (rotid_component){value[i].name, value[i].value};
    run->truth = all;
    return 1;
}

static char *line_identified(const struct line *line, const struct experiment *experiment, const struct fitted *fitted,
                             const struct message_list *notes)
{
    const struct states *states = fitted->states;
    struct pool pool;
    struct study_run run = begin(line);
    pool_open(&pool, NULL);
    rotid_identification *said = states->nstate > 1
                                     ? result_identification_states(&pool, states, fitted->found, fitted->fit)
                                     : result_identification(&pool, &states->state->job, states->bounds, fitted->found);
    int whole = add_fit(&pool, experiment, NULL, states, said, notes, &run) && add_speeds(&pool, fitted, &run);
    if (whole && !(line->study->plan->spread > 0)) /* the way from each start is what such a plan is about */
        said->history = NULL;
    if (whole && !line->study->plan->baseline)
        said->baseline = NULL;
    return end(&pool, &run, whole, clock_seconds() - line->begin);
}

static char *line_diagnosed(const struct line *line, const struct experiment *experiment, struct diagnosis *d,
                            const struct message_list *notes)
{
    const struct states *final = d->extended.fit ? &d->extended_states : &d->judged;
    struct pool pool;
    struct study_run run = begin(line);
    pool_open(&pool, NULL);
    run.diagnosis = result_diagnosis(&pool, d->given.nstate ? &d->given : &experiment->states, d);
    rotid_identification *fit = run.diagnosis->extended ? run.diagnosis->extended : run.diagnosis->base;
    int whole = add_fit(&pool, experiment, d, final, fit, notes, &run);
    if (whole) {
        fit->history = NULL;
        fit->baseline = NULL;
        run.score = experiment->made_by ? (int)score_make(experiment, d) : ROTID_NONE;
        run.false_findings = experiment->made_by ? score_false_findings(experiment, d) : ROTID_NONE;
    }
    return end(&pool, &run, whole, clock_seconds() - line->begin);
}

/* ---- the run */

static int is_cancelled(const rotid_environment *environment)
{
    return environment && environment->cancelled && environment->cancelled(environment->context);
}

/* Why a run failed, in one line: the errors that say something of their own, else what the status says. */
static const char *reason(struct pool *pool, int status, const struct message_list *notes)
{
    const char *text = NULL;
    for (size_t i = 0; i < notes->count; i++) {
        const rotid_message *m = &notes->item[i];
        if (m->severity != SEVERITY_ERROR)
            continue;
        const char *placed = m->file ? pool_format(pool, "%s:%d:%d: %s", m->file, m->line, m->column, m->text) : m->text;
        const char *longer = text && placed ? pool_format(pool, "%s; %s", text, placed) : placed;
        text = longer ? longer : text;
    }
    return text ? text : rotid_status_text(status);
}

/* The machine at the values of the fit, and at those that made the data where nothing else acts in these. */
static int compute_speeds(struct pool *pool, const struct study *study, const struct experiment *experiment,
                          const rotid_environment *environment, struct message_list *notes, struct fitted *fitted)
{
    const struct states *states = &experiment->states;
    const struct machine *machine = states->machine;
    const struct job *job = experiment->job;
    struct speeds_options options = {
        .count = SPEEDS_COUNT, .harmonic = 1, .draws = study->plan->draws, .seed = study->seed, .threads = 1};
    rotid_fit_result own;
    int n = job->unknowns.nparameter, status = machine_fit(pool, states, fitted->fit, &own), known = experiment->made_by != NULL;
    double *x = POOL_ARRAY(pool, double, machine_unknowns(machine, job));
    fitted->speeds = POOL_NEW(pool, rotid_speeds);
    rotid_speeds *truth = POOL_NEW(pool, rotid_speeds);
    if (status || !x || !fitted->speeds || !truth)
        return status ? status : ROTID_ERROR_MEMORY;
    status = speeds_run(pool, machine, job, own.x, &own, &options, environment, notes, fitted->speeds);
    for (int p = 0; p < machine_unknowns(machine, job); p++) {
        x[p] = p < n && experiment->truth ? experiment->truth[state_unknown(&states->state[0], p)]
                                          : machine_bounds(machine, job, p)->start;
        known = known && isfinite(x[p]) && !experiment->made_by->effect;
    }
    options.draws = 0;
    if (!status && known) {
        fitted->truth = truth;
        status = speeds_run(pool, machine, job, x, NULL, &options, environment, notes, truth);
    }
    return status;
}

static char *identify(struct pool *pool, const struct study *study, const struct line *line, struct experiment *experiment,
                      const rotid_environment *environment, struct message_list *notes, int *status)
{
    const struct states *states = &experiment->states;
    struct states joined = *states; /* with the run-up where that was measured: a model makes none */
    struct fitted fitted = {.states = &joined, .found = POOL_ARRAY(pool, struct identification, states->nstate)};
    struct runup *runup = NULL;
    char *text = NULL;
    *status = fitted.found ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (study->plan->command == PLAN_SPEEDS && !states->machine) {
        message_add(notes, SEVERITY_ERROR, NULL, 0, 0, "the deck has no *RUNNING, expected the machine in operation behind it");
        *status = ROTID_ERROR_ARGUMENT;
    }
    if (!*status && !study->plan->from_model)
        *status = runup_join(pool, states, notes, &joined, &runup);
    if (!*status)
        *status = identify_states(pool, &joined, IDENTIFY_BARE | (study->plan->baseline ? IDENTIFY_BASELINE : 0), environment,
                                  notes, fitted.found, &fitted.fit);
    if (runup_close(runup))
        *status = ROTID_ERROR_MEMORY;
    if (!*status && fitted.fit->status != ROTID_STOP_CANCELLED && study->plan->command == PLAN_SPEEDS)
        *status = compute_speeds(pool, study, experiment, environment, notes, &fitted);
    if (!*status && fitted.fit->status == ROTID_STOP_CANCELLED)
        *status = ROTID_STOP_CANCELLED;
    if (!*status)
        text = line_identified(line, experiment, &fitted, notes);
    rotid_fit_free(fitted.fit);
    return text;
}

static char *diagnose(struct pool *pool, const struct study *study, const struct line *line, struct experiment *experiment,
                      const rotid_environment *environment, struct message_list *notes, int *status)
{
    const struct diagnose_options options = {.threads = 1, .seed = study->seed, .replicates = study->plan->bootstrap};
    struct diagnosis result;
    struct states states = experiment->states;
    char *text = NULL;
    if (study->plan->from_model) /* which makes no run-up */
        states.machine = NULL;
    *status = diagnose_states(pool, &states, &options, environment, notes, &result);
    if (*status)
        return NULL;
    if (result.result.interrupted)
        *status = ROTID_STOP_CANCELLED;
    else
        text = line_diagnosed(line, experiment, &result, notes);
    diagnose_free(&result);
    return text;
}

int study_run(struct jobs *jobs, long run, const rotid_environment *environment, char **text)
{
    const struct study *study = jobs->study;
    const struct study_point point = study_locate(study, run);
    const struct line line = {study, run, point, clock_seconds()};
    const char *error = study->deck[point.cell.deck].error;
    struct pool pool;
    struct message_list notes;
    struct experiment experiment;
    int status = ROTID_OK;
    *text = NULL;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    if (!error) {
        status = experiment_make(&pool, jobs, &point, &notes, &experiment);
        if (!status)
            *text = (study->plan->command == PLAN_DIAGNOSE ? diagnose : identify)(&pool, study, &line, &experiment, environment,
                                                                                  &notes, &status);
        if (is_cancelled(environment)) /* what came behind the last look at it may be incomplete */
            status = ROTID_STOP_CANCELLED;
        error = status < 0 ? reason(&pool, status, &notes) : NULL;
    }
    if (status == ROTID_STOP_CANCELLED) {
        json_free(*text);
        *text = NULL;
    } else if (error) {
        *text = line_failed(&line, error, clock_seconds() - line.begin);
        status = ROTID_OK;
    }
    pool_close(&pool);
    return status == ROTID_STOP_CANCELLED || *text ? status : ROTID_ERROR_MEMORY;
}

char *study_run_failed(const struct study *study, long run, const char *error, double seconds)
{
    const struct line line = {study, run, study_locate(study, run), 0};
    return line_failed(&line, error, seconds);
}
