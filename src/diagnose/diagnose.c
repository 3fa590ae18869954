#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"

/* Before a verdict. */
static const rotid_diagnosis nothing = {
    .verdict = {.kind = -1, .p_value = NAN},
    .gain =
        {{NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}},
    .noise = {.frequency = NAN, .shape = NAN}};

/* Whether an effect may stay in a rotor beside another one of its kind at its target: factors of fields over z multiply, masses
 * and springs at points and inertias of a disk add up. */
static int effect_can_stay(const struct effect *effect)
{
    const struct effect_kind *kind = effect->kind;
    return (kind->field || kind->point || kind->at_disk) && !kind->section && !kind->tierod && !kind->spring && !kind->joint &&
           !kind->at_sensor;
}

/* before: number of effects without the set of the fit */
static int can_stay(const struct refit *refit, int before)
{
    const struct rotor *rotor = refit ? &refit->states.state->job.rotor : NULL;
    int all = rotor && rotor->neffect > before; /* a beam that became a solid has none more */
    for (int e = before; all && e < rotor->neffect; e++)
        all = effect_can_stay(&rotor->effect[e]);
    return all;
}

/* *out := the job of an engine, paired, with the likeliest explanation of its data among those whose effects can stay. */
static void imitate(const struct engine *engine, const struct posterior *p, struct job *out)
{
    int item = 0;
    struct segment *segment = out->rotor.segment; /* as fine as the whole needs it, which is seen later */
    while (item < p->count && (p->item[item].something_else ||
                               (p->item[item].nmember && !can_stay(p->item[item].refit, engine->job->rotor.neffect))))
        item++;
    const struct job *likeliest = item < p->count ? &explanation_states(engine, &p->item[item])->state->job : engine->job;
    out->rotor = likeliest->rotor;
    out->rotor.segment = segment;
    out->rotor.nsensor = engine->job->rotor.nsensor; /* where faults are not sure, those of the deck */
    out->rotor.sensor = engine->job->rotor.sensor;
    out->unknowns = likeliest->unknowns;
    out->measurement = engine->job->measurement;
    out->measurement.number = engine->number;
    out->measurement.paired = 1;
}

/* The findings about a state behind those of the states before it. */
static int take_findings(struct engine *engine, const rotid_diagnosis *found)
{
    rotid_diagnosis *out = &engine->out->result;
    for (int i = 0; i < found->ndata_findings; i++) {
        int status = data_add_finding(engine, &found->data_findings[i]);
        if (status)
            return status;
    }
    for (int i = 0; i < found->nnumerical_findings; i++) {
        rotid_numerical_finding *finding = &out->numerical_findings[out->nnumerical_findings++];
        *finding = found->numerical_findings[i];
        finding->state = engine->state;
    }
    return ROTID_OK;
}

/* The state that the engine looks at, by an engine of its own. imitated: in, its job in the deck; NULL: not asked for */
static int settle(struct engine *engine, struct job *imitated)
{
    struct diagnosis *out = engine->out, alone = {.result.steps = out->result.steps, .result.nsteps = out->result.nsteps};
    struct engine own = *engine;
    struct message_list quiet;
    struct state state;
    const struct states only = states_of(engine->job, &state);
    message_open(&quiet, engine->pool);
    own.out = &alone;
    own.notes = &quiet;
    own.nown = only.nparameter;
    own.nprepared = own.coloured = 0;
    own.fit = NULL;
    own.deck_start = parameter_starts(engine->pool, only.nparameter, only.bounds);
    alone.result.numerical_findings = POOL_ARRAY(engine->pool, rotid_numerical_finding, NUMERICAL_FINDINGS);
    if (!own.deck_start || !alone.result.numerical_findings)
        return ROTID_ERROR_MEMORY;
    int status = engine_take_states(&own, &only);
    if (!status)
        status = base_prepare(&own);
    struct diagnosis_round round;
    struct round_result result = {0};
    if (!status)
        status = round_run(&own, 1, &round, &result, &alone.posterior);
    if (!status && imitated)
        imitate(&own, &alone.posterior, imitated);
    round_free(&result);
    if (own.fit != alone.base.fit)
        rotid_fit_free(own.fit);
    rotid_fit_free(alone.base.fit);
    out->result.nsteps = alone.result.nsteps;
    engine->clock = own.clock;
    if (status)
        return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
    engine->job->rotor = own.job->rotor;
    engine->job->measurement = own.job->measurement;
    engine->coloured |= own.coloured;
    engine->nfault = own.nfault;
    engine->fault = own.fault;
    return take_findings(engine, &alone.result);
}

#define LEAST_LEFT 3    /* modes: fewer say too little */
#define SAME_PLACE 0.01 /* of the length: what a model misses is the same there */

static const struct state *find(const struct states *states, const char *name, struct message_list *notes)
{
    const char *list = "";
    for (int s = 0; s < states->nstate; s++)
        if (states->state[s].name && same_text(states->state[s].name, name))
            return &states->state[s];
    for (int s = 0; s < states->nstate && list; s++)
        list = pool_format(notes->pool, "%s%s%s", list, s ? ", " : "", states->state[s].name ? states->state[s].name : "");
    message_add(notes, SEVERITY_ERROR, states->state->job.deck, 1, 1,
                states->nstate > 1 ? "state %s is not defined, expected one of %s"
                                   : "state %s: the deck has no states, expected two *STATE%s",
                name, list ? list : "");
    return NULL;
}

/* Whether a state has what is needed: modes, and the noise of their frequencies. */
static int suffices(const struct state *state, struct message_list *notes)
{
    const struct job *job = &state->job;
    if (job->measurement.nmode && job_knows_frequency_noise(job))
        return 1;
    message_add(notes, SEVERITY_ERROR, job->deck, 1, 1,
                job->measurement.nmode
                    ? "state %s states no noise of its frequencies, expected *NOISE, FREQUENCY=: what changed is judged by it"
                    : "the deck has no measured modes in state %s, expected *MODES or *MEASURED",
                state->name);
    return 0;
}

/* Each of the two states as a deck that is this one alone; as it stands where the data do not suffice. */
static int settle_both(struct engine *engine, const struct states *given, struct settled *out)
{
    int status = data_prepare(engine, given);
    for (int s = 0; s < 2 && !status; s++) {
        struct job *job = &out->state[s].job;
        engine_look_at(engine, s);
        out->imitated[s].measurement = engine->job->measurement;
        status = settle(engine, &out->imitated[s]);
        job->measurement = engine->job->measurement;
        job->rotor.nsensor = engine->job->rotor.nsensor;
        job->rotor.sensor = engine->job->rotor.sensor;
        job->rotor.settled_rigid = engine->job->rotor.settled_rigid;
    }
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The unknowns of `before` as the likelihood of the full model has them, on a mesh without error: the shapes of the second state
 * are judged on the same. */
static int fit_before(struct pool *pool, const char *before, const rotid_environment *environment, struct message_list *notes,
                      struct job *job, struct identification *found)
{
    struct message_list quiet;
    message_open(&quiet, pool);
    job->options.fit.functional = ROTID_LIKELIHOOD;
    job->options.fit.reduction = ROTID_REDUCTION_NONE;
    job->options.fit.derivative = ROTID_NELSON;
    int status = data_copy(pool, job);
    if (!status)
        status = identify_run(pool, job, 0, environment, &quiet, found);
    const struct segment *coarse = job->rotor.segment;
    if (!status && found->fit->status != ROTID_STOP_CANCELLED)
        status = base_refine(pool, job, base_halvings(job, found->compared.number, &found->spectrum));
    if (!status && job->rotor.segment != coarse) {
        rotid_fit_free(found->fit);
        found->fit = NULL;
        status = identify_run(pool, job, 0, environment, &quiet, found);
    }
    for (size_t i = 0; i < quiet.count && status; i++)
        message_add(notes, quiet.item[i].severity, NULL, 0, 0, "%s (state %s)", quiet.item[i].text, before);
    if (!status && found->fit->status == ROTID_STOP_CANCELLED)
        status = ROTID_STOP_CANCELLED;
    return status;
}

/* The mesh of `fine` for a rotor with the elements of `coarse`. */
static void refine_like(const struct rotor *fine, const struct rotor *coarse, struct rotor *rotor)
{
    for (int i = 0; i < rotor->nsegment && i < fine->nsegment; i++)
        rotor->segment[i].elements *= fine->segment[i].elements / coarse->segment[i].elements;
}

/* The effects that imitate what `before` has, at their fitted values, in the rotor of the other state. */
static int keep_effects(struct pool *pool, const struct job *before, const double *x, int first, struct rotor *rotor)
{
    struct state state;
    (void)states_of(before, &state);
    int more = before->rotor.neffect - first;
    struct effect *effect = POOL_COPY(pool, rotor->effect, rotor->neffect, more);
    if (!effect)
        return ROTID_ERROR_MEMORY;
    for (int e = first; e < before->rotor.neffect; e++) {
        struct effect *kept = &effect[rotor->neffect++];
        effect_at(&state, e, x, kept);
        kept->stays = 1;
        kept->name = pool_format(pool, "stays_%d", e - first + 1);
        if (!kept->name)
            return ROTID_ERROR_MEMORY;
    }
    rotor->effect = effect;
    return ROTID_OK;
}

/* Holds the unknowns that `after` has of those of `before`; its own stay free. */
static int hold(struct pool *pool, const struct state *before, const double *x, const struct state *after, struct job *job)
{
    int n = job->unknowns.nparameter, left = 0, status = rotor_copy(pool, &after->job.rotor, &job->rotor);
    struct parameter *parameter = POOL_ARRAY(pool, struct parameter, n);
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
    if (status || !parameter || !bounds)
        return ROTID_ERROR_MEMORY;
    job->rotor.nspring = after->job.rotor.nspring; /* a copy has those of a sling, which the model adds by itself */
    for (int q = 0; q < n; q++) {
        int shared = 0;
        for (int p = 0; p < before->job.unknowns.nparameter; p++)
            if (state_unknown(before, p) == state_unknown(after, q)) {
                parameters_set(&job->rotor, 1, &job->unknowns.parameter[q], &x[p]);
                shared = 1;
            }
        if (shared)
            continue;
        parameter[left] = job->unknowns.parameter[q];
        bounds[left++] = job->unknowns.bounds[q];
    }
    job->unknowns.parameter = parameter;
    job->unknowns.bounds = bounds;
    job->unknowns.nparameter = left;
    return ROTID_OK;
}

static double dot(int n, const double *a, const double *b) /* over what both have */
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += isfinite(a[i]) && isfinite(b[i]) ? a[i] * b[i] : 0;
    return sum;
}

/* The sensor of `before` nearest to one of `after` at its place, -1: none. shape [before->nsensor]: where it was measured; NULL:
 * all */
static int nearest_sensor(const struct rotor *before, const double *shape, const struct rotor *after, int i)
{
    double nearest = SAME_PLACE * rotor_length(after);
    int found = -1;
    for (int s = 0; s < before->nsensor; s++) {
        double away = fabs(after->sensor[i].position - before->sensor[s].position);
        if (away < nearest && (!shape || isfinite(shape[s]))) {
            nearest = away;
            found = s;
        }
    }
    return found;
}

/* b, its noise and phi_b at the sensors of `after`, NaN where `before` has none at that place. */
static void gather(const struct job *before, const struct identification *found, int j, const struct rotor *after, double *b,
                   double *std, double *phi)
{
    const struct spectrum *spectrum = &found->spectrum;
    int nsensor = before->rotor.nsensor;
    ptrdiff_t measured = (ptrdiff_t)j * nsensor, mode = (ptrdiff_t)(found->compared.number[j] - 1) * spectrum->nmaster;
    const double *shape = before->measurement.shape + measured;
    double absolute = largest_magnitude(nsensor, shape);
    for (int i = 0; i < after->nsensor; i++) {
        int s = nearest_sensor(&before->rotor, shape, after, i);
        b[i] = s < 0 ? (double)NAN : shape[s];
        if (s < 0)
            continue;
        std[i] = before->measurement.shape_std[measured + s] * absolute;
        phi[i] = spectrum->shape[mode + s];
    }
}

/* The part of a that is not along b, squared, over what noise makes of it; a share of a. Noise is absolute. */
static double unlike(int n, const double *a, const double *std, const double *b, const double *b_std)
{
    double ab = dot(n, a, b), bb = dot(n, b, b), aa = 0, noise = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(a[i]) && isfinite(b[i])) {
            aa += a[i] * a[i];
            noise += std[i] * std[i] + ab / bb * ab / bb * b_std[i] * b_std[i];
        }
    return fmax(0, aa - ab * ab / bb - noise) / aa;
}

/* The shape of mode k less what the model misses of it in `before`, where it is mode j; *other: d^2, to which the shape adds.
 * work [3 * nsensor] */
static void correct_shape(const struct job *before, const struct identification *found, int j, int k, double *work, double *other,
                          struct job *job)
{
    int n = job->rotor.nsensor;
    double *a = job->measurement.shape + (ptrdiff_t)k * n, *std = job->measurement.shape_std + (ptrdiff_t)k * n, *b = work,
           *b_std = b + n, *phi = b_std + n, was = largest_magnitude(n, a);
    gather(before, found, j, &job->rotor, b, b_std, phi);
    for (int i = 0; i < n; i++)
        if (!isfinite(a[i]) || !isfinite(b[i])) /* not measured twice */
            a[i] = b[i] = NAN;
    if (!(dot(n, a, a) > 0 && dot(n, b, b) > 0)) { /* the frequency alone was measured twice */
        for (int i = 0; i < n; i++)
            a[i] = NAN;
        return;
    }
    double g = dot(n, a, b) / dot(n, b, b), square = 0, along = 0;
    for (int i = 0; i < n; i++)
        std[i] *= was;
    *other += unlike(n, a, std, b, b_std);
    for (int i = 0; i < n; i++)
        if (isfinite(a[i]) && isfinite(b[i])) {
            square += phi[i] * phi[i];
            along += phi[i] * b[i];
        }
    for (int i = 0; i < n; i++) {
        double missed = g * (b[i] - along / square * phi[i]);
        std[i] = hypot(hypot(std[i], g * b_std[i]), *other > 0 && isfinite(missed) ? sqrt(*other) * missed : 0);
        a[i] -= missed;
    }
    double is = largest_magnitude(n, a);
    for (int i = 0; i < n; i++)
        std[i] /= is;
}

static int partner(const struct identification *found, int number)
{
    for (int j = 0; j < found->compared.nmode; j++)
        if (found->compared.number[j] == number)
            return j;
    return -1;
}

/* A line that is off in one state alone, or sensors elsewhere, leave few places where shapes can be compared. */
static void warn_of_places(const struct rotor *before, const struct rotor *after, const char *name, struct message_list *notes)
{
    int common = 0;
    for (int i = 0; i < after->nsensor; i++)
        common += nearest_sensor(before, NULL, after, i) >= 0;
    if (2 * common < (before->nsensor < after->nsensor ? before->nsensor : after->nsensor))
        message_warn(notes,
                     "%d of %d sensors of state %s have one of the other state within 1 %% of the length: shapes are compared at "
                     "these alone",
                     common, after->nsensor, name);
}

/* The modes of `after` with the numbers that their shapes give them beside the model, those that `before` has as well, corrected.
 */
static int correct(struct pool *pool, const struct job *before, const struct identification *found, struct message_list *notes,
                   const char *name, struct job *job)
{
    struct spectrum spectrum;
    struct comparison compared = {0};
    struct message_list quiet;
    int n = job->unknowns.nparameter, left_out = 0;
    int shapes = job_fits_shapes(before) && job_fits_shapes(job) && job->measurement.shape;
    double *x = parameter_starts(pool, n, job->unknowns.bounds), *work = POOL_ARRAY(pool, double, 3 * (size_t)job->rotor.nsensor);
    if (!x || !work)
        return ROTID_ERROR_MEMORY;
    message_open(&quiet, pool);
    int status = spectrum_compute_parts(pool, job->models, &job->rotor, n, job->unknowns.parameter, x, ROTID_GUYAN,
                                        comparison_candidates(job), job->measurement.shape ? SPECTRUM_MASS : 0, &spectrum);
    if (!status)
        status = comparison_make(pool, job, &spectrum, &quiet, &compared);
    while (status == ROTID_ERROR_UNPAIRED && job->measurement.nmode > LEAST_LEFT) {
        int k = compared.clash; /* left out, as a diagnosis does: it tells nothing of what changed */
        message_warn(notes, "measured mode %d of state %s at %.6g Hz has the shape of no mode of the model and is left out",
                     job->measurement.number[k], name, job->measurement.frequency_hz[k]);
        data_remove_mode(job, k);
        message_open(&quiet, pool);
        status = comparison_make(pool, job, &spectrum, &quiet, &compared);
    }
    for (size_t i = 0; i < quiet.count && status; i++)
        message_add(notes, quiet.item[i].severity, NULL, 0, 0, "%s (state %s)", quiet.item[i].text, name);
    if (status)
        return status;
    memcpy(job->measurement.number, compared.number, (size_t)job->measurement.nmode * sizeof(int));
    job->measurement.paired = 1;
    if (shapes)
        warn_of_places(&before->rotor, &job->rotor, name, notes);
    else
        job->measurement.shape = NULL;
    for (int k = 0; k < job->measurement.nmode; k++) {
        int number = job->measurement.number[k], j = partner(found, number);
        if (j < 0) {
            data_remove_mode(job, k--);
            left_out++;
            continue;
        }
        double ratio = found->spectrum.full_hz[number - 1] / before->measurement.frequency_hz[j],
               moved = 2 * log(job->measurement.frequency_hz[k] / before->measurement.frequency_hz[j]), other = moved * moved;
        if (shapes)
            correct_shape(before, found, j, k, work, &other, job);
        job->measurement.frequency_hz[k] *= ratio;
        job->measurement.frequency_std[k] =
            hypot(hypot(job->measurement.frequency_std[k], before->measurement.frequency_std[j]), sqrt(other) * log(ratio));
    }
    if (left_out)
        message_warn(notes, "%d mode%s of state %s that the other state has not tell%s nothing of what changed and %s left out",
                     left_out, left_out == 1 ? "" : "s", name, left_out == 1 ? "s" : "", left_out == 1 ? "is" : "are");
    return ROTID_OK;
}

int changed_job(struct pool *pool, const struct settled *settled, int before, const rotid_environment *environment,
                struct message_list *notes, struct job *out)
{
    const struct state *first = &settled->state[before], *second = &settled->state[!before];
    struct identification found = {0};
    struct job job = settled->imitated[before];
    *out = second->job;
    out->measurement.has_noise_floor = 1; /* where a mode is another one it holds more than scatter */
    out->measurement.raw = NULL;          /* the corrections of the deck are applied, and no deck is written of this */
    out->measurement.ncorrection = 0;
    int status = data_copy(pool, out);
    if (!status)
        status = fit_before(pool, first->name, environment, notes, &job, &found);
    if (!status)
        status = hold(pool, first, found.fit->x, second, out);
    if (!status)
        status = keep_effects(pool, &job, found.fit->x, first->job.rotor.neffect, &out->rotor);
    if (!status)
        refine_like(&job.rotor, &first->job.rotor, &out->rotor);
    if (!status)
        status = correct(pool, &job, &found, notes, second->name, out);
    rotid_fit_free(found.fit);
    return status;
}

/* Pairing, channels, noise, accelerometer and mesh of every state as of a deck that is this state alone; what is found goes with
 * the name of the state to the findings, and the states are judged without. A state whose data do not suffice to judge a model
 * by stays as it is. Statuses of memory and cancellation only. */
static int settle_states(struct engine *engine)
{
    int status = ROTID_OK;
    for (int s = 0; s < engine->states.nstate && !status; s++) {
        engine_look_at(engine, s);
        status = settle(engine, NULL);
    }
    engine_look_at(engine, 0);
    return status;
}

/* The search, and what it says. */
static int search(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    struct round_result *last = out->last;
    struct diagnosis_round *round = out->round = POOL_NEW(engine->pool, struct diagnosis_round);
    int status = round ? round_run(engine, engine->states.nstate == 1, round, last, &out->posterior) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    out->nround = 1;
    status = evidence_collect(engine, &last->scan, &out->posterior, round);
    engine_step(engine, "held out");
    if (!status)
        status = localise(engine, &last->scan);
    out->result.verdict.p_value = fmin(round->result.p_frequency, round->result.p_total);
    if (!status)
        status = posterior_verdict(engine, &out->posterior);
    if (!status && out->ncause) /* the limits are those of the extended model */
        status = scan_run(engine->pool, &engine->states, engine->number, engine->holdout, engine->fit->x, SCAN_ALL, &last->scan);
    return status;
}

/* What the user does today; should that fail, there is still the judged model. What its mesh was held to is near what the base's
 * will be. */
static int fit_today(struct engine *engine, const struct states *states)
{
    struct diagnosis *out = engine->out;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    int today = base_identify(engine, states, &quiet, &out->state_today, &out->today);
    for (int s = 0; s < engine->states.nstate && !today; s++)
        engine->states.state[s].job.held = out->state_today[s].held;
    int ends = today == ROTID_ERROR_MEMORY || (!today && out->today.fit->status == ROTID_STOP_CANCELLED);
    return !ends ? ROTID_OK : today ? today : ROTID_STOP_CANCELLED;
}

static int run(struct engine *engine, const struct states *states)
{
    int status = data_prepare(engine, states);
    engine_step(engine, "data");
    if (!status)
        status = engine_stage(engine, "fit as the deck states it", 1);
    if (!status && states->nparameter)
        status = fit_today(engine, states);
    engine_step(engine, "fit of today");
    if (!status && states->nstate > 1)
        status = settle_states(engine);
    if (!status)
        status = base_prepare(engine);
    if (!status)
        status = base_note_reduction(engine);
    if (!status)
        status = base_residuals(engine);
    engine_step(engine, "base");
    if (!status)
        status = search(engine);
    return status ? status : finalise(engine);
}

/* The same with models for the run, or settle_both where `settled` is not NULL. */
static int run_with_models(struct engine *engine, const struct states *given, struct settled *settled)
{
    struct states states;
    int begun = 0, status = states_copy(engine->pool, given, &states);
    for (; begun < given->nstate && !status; begun++) {
        struct job *job = &states.state[begun].job;
        job->models = models_for_run(engine->pool, job->models);
        status = job->models ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (!status)
        status = settled ? settle_both(engine, &states, settled) : run(engine, &states);
    for (int s = 0; s < begun; s++)
        if (states.state[s].job.models)
            models_end_run(engine->pool, states.state[s].job.models, given->state[s].job.models);
    return status;
}

int changed_settle(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct settled *out)
{
    const struct state *first = find(states, options->before, notes),
                       *second = first ? find(states, options->after, notes) : NULL;
    struct message_list quiet;
    struct diagnosis found = {.result = nothing};
    struct engine engine = {.pool = pool,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .environment = environment,
                            .notes = &quiet,
                            .out = &found,
                            .clock = clock_seconds()};
    if (second == first && second)
        message_add(notes, SEVERITY_ERROR, states->state->job.deck, 1, 1, "state %s is given twice, expected two states",
                    options->before);
    if (!second || second == first || !suffices(first, notes) || !suffices(second, notes))
        return ROTID_ERROR_ARGUMENT;
    message_open(&quiet, pool);
    *out = (struct settled){.state = {*first, *second}};
    for (int s = 0; s < 2; s++) { /* an accelerometer loads both states */
        struct job_measurement *m = &out->state[s].job.measurement;
        m->point_frequency_hz = m->point_frequency_std = NULL;
        out->imitated[s] = out->state[s].job;
    }
    found.result.steps = POOL_ARRAY(pool, rotid_step, MOST_STEPS);
    found.result.numerical_findings = POOL_ARRAY(pool, rotid_numerical_finding, 2 * NUMERICAL_FINDINGS);
    if (!found.result.steps || !found.result.numerical_findings)
        return ROTID_ERROR_MEMORY;
    const struct states both = {.nstate = 2, .state = out->state, .nparameter = states->nparameter, .bounds = states->bounds};
    int status = run_with_models(&engine, &both, out);
    out->found = found.result;
    return status;
}

/* begun: what was found before. */
static int diagnose(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_diagnosis *begun, const rotid_environment *environment, struct message_list *notes,
                    struct diagnosis *out)
{
    struct engine engine = {.pool = pool,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .environment = environment,
                            .notes = notes,
                            .before = options->before,
                            .after = options->after,
                            .out = out,
                            .clock = clock_seconds()};
    engine.user_reduction = states->state->job.options.fit.reduction;
    *out = (struct diagnosis){.result = *begun, .last = POOL_NEW(pool, struct round_result)};
    out->result.before = options->before;
    out->result.after = options->after;
    out->result.steps = POOL_COPY(pool, begun->steps, begun->nsteps, MOST_STEPS);
    out->result.numerical_findings =
        POOL_COPY(pool, begun->numerical_findings, begun->nnumerical_findings, NUMERICAL_FINDINGS * states->nstate);
    if (!out->result.steps || !out->result.numerical_findings || !out->last)
        return ROTID_ERROR_MEMORY;
    int status = states_copy(pool, states, &out->given);
    if (!status)
        status = run_with_models(&engine, states, NULL);
    if (engine.fit != out->base.fit)
        rotid_fit_free(engine.fit);
    if (out->judged.nstate)
        out->job = out->judged.state->job;
    if (out->extended_states.nstate)
        out->extended_job = out->extended_states.state->job;
    if (status == ROTID_STOP_CANCELLED) {
        out->result.interrupted = 1;
        out->result.verdict.kind = nothing.verdict.kind;
        out->result.verdict.p_value = nothing.verdict.p_value;
        out->result.gain = nothing.gain;
        return ROTID_OK;
    }
    if (status)
        diagnose_free(out);
    return status;
}

/* What the other state has and `before`, 0 or 1, has not. */
static int diagnose_changed(struct pool *pool, const struct settled *settled, int before, const struct diagnose_options *options,
                            const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct state state;
    struct job job;
    *out = (struct diagnosis){.result = nothing};
    int status = changed_job(pool, settled, before, environment, notes, &job);
    if (status == ROTID_STOP_CANCELLED) {
        out->result.interrupted = 1;
        return ROTID_OK;
    }
    const struct states only = states_of(&job, &state);
    state.name = settled->state[!before].name;
    return status ? status : diagnose(pool, &only, options, &settled->found, environment, notes, out);
}

#define LIKELIER 3 /* ln: of the explanation of one order of the states beside that of the other */

/* The likeliest explanation, NULL: none, or that it is something else. */
static const struct explanation *named(const struct diagnosis *d)
{
    const struct explanation *lead = d->posterior.count ? d->posterior.item : NULL;
    return lead && lead->nmember && !lead->something_else ? lead : NULL;
}

/* What `before` has and `after` has not, as a joint that was tightened, is nothing that a mass or a joint of `after` explains,
 * both of one sign, and other causes imitate that. The states are compared the other way round then, where that explains them
 * better. */
static int diagnose_gone(struct pool *pool, const struct settled *settled, const struct diagnose_options *options,
                         const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct diagnose_options other = *options;
    struct diagnosis gone;
    struct message_list quiet;
    message_open(&quiet, pool);
    other.before = options->after;
    other.after = options->before;
    int status = diagnose_changed(pool, settled, 1, &other, environment, &quiet, &gone);
    if (status == ROTID_ERROR_MEMORY || pool->out_of_memory) {
        if (!status)
            diagnose_free(&gone);
        diagnose_free(out);
        return ROTID_ERROR_MEMORY;
    }
    if (status)
        return ROTID_OK;
    const struct explanation *one = named(&gone), *lead = out->posterior.item;
    out->result.interrupted |= gone.result.interrupted;
    if (gone.result.interrupted || !one || !(one->log_posterior > lead->log_posterior + LIKELIER)) {
        diagnose_free(&gone);
        return ROTID_OK;
    }
    diagnose_free(out);
    *out = gone;
    for (size_t i = 0; i < quiet.count; i++)
        message_at(notes, quiet.item[i].severity, quiet.item[i], "%s", quiet.item[i].text);
    message_warn(notes, "compared from %s to %s: what %s has not any more explains the states better than what %s has beside %s",
                 other.before, other.after, other.before, other.before, other.after);
    return ROTID_OK;
}

int diagnose_states(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct settled settled;
    if (!options->before)
        return diagnose(pool, states, options, &nothing, environment, notes, out);
    *out = (struct diagnosis){.result = nothing};
    int status = changed_settle(pool, states, options, environment, notes, &settled);
    if (status == ROTID_STOP_CANCELLED)
        out->result.interrupted = 1;
    if (status)
        return out->result.interrupted ? ROTID_OK : status;
    status = diagnose_changed(pool, &settled, 0, options, environment, notes, out);
    const struct explanation *lead = !status && !out->result.interrupted && out->posterior.count ? out->posterior.item : NULL;
    return lead && (lead->nmember || lead->something_else) ? diagnose_gone(pool, &settled, options, environment, notes, out)
                                                           : status;
}

void diagnose_free(struct diagnosis *out)
{
    round_free(out->last);
    rotid_fit_free(out->today.fit);
    rotid_fit_free(out->base.fit);
    rotid_fit_free(out->extended.fit);
    out->today.fit = out->base.fit = out->extended.fit = NULL;
}
