#include "fit/fit.h"
#include "run/run.h"

/* Whether fits of the job run on the coarse mesh. */
static int mesh_is_held(const struct job *job)
{
    return job->options.solid && job->options.fit.reduction == ROTID_REDUCTION_NONE;
}

/* What is held for this job, NULL: nothing. */
static const struct held_modes *held_of(const struct job *job)
{
    struct rotor bare = job->rotor;
    bare.neffect = 0;
    return job->held && rotor_same_shape(&job->held->rotor, &bare) ? job->held : NULL;
}

/* Room for `count` modes; with: shapes as well. */
static struct held_modes *new_held(struct pool *pool, const struct job *job, int count, int with)
{
    struct held_modes *held = POOL_NEW(pool, struct held_modes);
    struct rotor bare = job->rotor;
    bare.neffect = 0;
    if (!held || rotor_copy(pool, &bare, &held->rotor))
        return NULL;
    held->rotor.nspring = bare.nspring; /* without those of the sling */
    held->count = count;
    held->ratio = POOL_ARRAY(pool, double, count);
    held->shift = with ? POOL_ARRAY(pool, double, (size_t)job->rotor.nsensor *(size_t)count) : NULL;
    return held->ratio && (!with || held->shift) ? held : NULL;
}

int mesh_hold_as_it_is(struct pool *pool, struct job *job, int count)
{
    if (held_of(job))
        return ROTID_OK;
    struct held_modes *held = new_held(pool, job, count, 0);
    if (!held)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < count; j++)
        held->ratio[j] = 1;
    job->held = held;
    return ROTID_OK;
}

/* out [n] := measured - a shift, a the least-squares scale of the shape to what is measured. */
static void take_shift(int n, const double *measured, const double *shape, const double *shift, double *out)
{
    double product = 0, square = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(measured[i])) {
            product += measured[i] * shape[i];
            square += shape[i] * shape[i];
        }
    for (int i = 0; i < n; i++)
        out[i] = measured[i] - (square > 0 ? product / square : 0) * shift[i];
}

int mesh_hold(struct pool *pool, struct job *job, const struct spectrum *s, double *moved)
{
    const struct held_modes *before = held_of(job);
    int known = before ? before->count : 0, shapes = s->other_shape && s->nmaster == job->rotor.nsensor;
    struct held_modes *held = new_held(pool, job, s->count, shapes);
    if (!held)
        return ROTID_ERROR_MEMORY;
    *moved = known < s->count ? INFINITY : 0;
    held->shape = shapes ? s->shape : NULL;
    for (int j = 0; j < s->count; j++) {
        ptrdiff_t at = (ptrdiff_t)j * s->nmaster;
        held->ratio[j] = s->full_hz[j] / s->other_hz[j];
        if (j < known)
            *moved = fmax(*moved, fabs(held->ratio[j] / before->ratio[j] - 1));
        if (shapes)
            take_shift(s->nmaster, s->shape + at, s->other_shape + at, s->other_shape + at, held->shift + at);
    }
    job->held = held;
    return ROTID_OK;
}

int mesh_of_fit(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz,
                const double **shape)
{
    const struct job_measurement *measured = &job->measurement;
    int nmode = measured->nmode, n = job->rotor.nsensor;
    const struct held_modes *held = mesh_is_held(job) ? held_of(job) : NULL;
    for (int k = 0; k < nmode && held; k++)
        if (number[k] > held->count)
            held = NULL;
    int shifts = held && held->shift && measured->shape;
    double *shifted = shifts ? POOL_ARRAY(pool, double, (size_t)n *(size_t)nmode) : NULL;
    *frequency_hz = POOL_ARRAY(pool, double, nmode);
    *refine = held ? COARSE_MESH : 1;
    *shape = shifts ? shifted : measured->shape;
    if (!*frequency_hz || (shifts && !shifted))
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < nmode; k++) {
        ptrdiff_t at = (ptrdiff_t)k * n, of = held ? (ptrdiff_t)(number[k] - 1) * n : 0;
        (*frequency_hz)[k] = measured->frequency_hz[k] / (held ? held->ratio[number[k] - 1] : 1);
        if (shifts)
            take_shift(n, measured->shape + at, held->shape + of, held->shift + of, shifted + at);
    }
    return ROTID_OK;
}

#define ROUNDS      3    /* of fitting and pairing, should the pairs change with the model */
#define MESH_ROUNDS 12   /* of fitting alone, should what the meshes lead to change with it */
#define HELD        1e-5 /* of a frequency: a hundredth of the noise of a good measurement */

/* Which measured shapes the functional gets: with LIKELIHOOD those whose noise is known. */
static int uses_shapes(const struct job *job)
{
    return job->measurement.shape && (job->options.fit.functional != ROTID_LIKELIHOOD || job_knows_shape_noise(job));
}

/* What a state is fitted with: its pairing and what is left out. */
struct paired {
    const int *number, *holdout;
    struct mass_properties *mass; /* to be filled, or NULL */
};

int measured_whole(struct pool *pool, const struct job *job, const struct rotor_model *model, rotid_measured *measured)
{
    const struct weighed *w = &job->measurement.weighed;
    if (!(w->mass_std > 0) && !(w->centre_std > 0))
        return ROTID_OK;
    double *whole = POOL_ARRAY(pool, double, 2 * (size_t)model->equations.n);
    if (!whole)
        return ROTID_ERROR_MEMORY;
    model_whole(model, whole);
    measured->whole = whole;
    measured->mass = w->mass;
    measured->mass_std = w->mass_std;
    measured->centre = w->centre;
    measured->centre_std = w->centre_std;
    return ROTID_OK;
}

static int open_state(struct pool *pool, const struct state *state, const struct paired *paired, struct rotor_model *model,
                      rotid_measured *measured, rotid_state *out)
{
    const struct job *job = &state->job;
    const double *shape;
    double *frequency_hz;
    int failed, refine, shapes = uses_shapes(job),
                        status = mesh_of_fit(pool, job, paired->number, &refine, &frequency_hz, &shape);
    if (status)
        return status;
    *measured = (rotid_measured){.size = sizeof *measured,
                                 .nmode = job->measurement.nmode,
                                 .number = paired->number,
                                 .frequency_hz = frequency_hz,
                                 .frequency_std = job_knows_frequency_noise(job) ? job->measurement.frequency_std : NULL,
                                 .shape = shapes ? shape : NULL,
                                 .shape_std = shapes && job_knows_shape_noise(job) ? job->measurement.shape_std : NULL,
                                 .holdout = paired->holdout};
    *out = (rotid_state){sizeof *out, &model->equations, measured, state->unknown};
    status =
        model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, refine, model, &failed);
    return status ? status : measured_whole(pool, job, model, measured);
}

/* The models of solids in a basis, made where the fit asks for them. */
struct in_basis {
    int nstate;
    struct rotor_model *model; /* [nstate] */
    rotid_state *state;        /* [nstate] */
    int *count;                /* [nstate] of the columns of the last basis, which the next one holds as well */
    double **v;
};

static int state_in_basis(struct pool *pool, const struct in_basis *in, int s, struct joint_part *part, struct joint_state *out)
{
    struct rotor_model *model = &in->model[s];
    const rotid_measured *measured = in->state[s].measured;
    struct functional *f = &part->functional;
    int n = model->equations.n, count = in->count[s];
    double *v = in->v[s];
    f->prediction.full.panels.vouched = model_mass_is_positive(model);
    struct basis_model *basis = POOL_NEW(pool, struct basis_model);
    rotid_measured *own = POOL_NEW(pool, rotid_measured);
    if (!v) {
        v = POOL_ARRAY(pool, double, 2 * (size_t)n);
        if (!v)
            return ROTID_ERROR_MEMORY;
        model_whole(model, v);
        count = basis_extend(n, basis_extend(n, 0, 0, v), 0, v);
    }
    if (!basis || !own)
        return ROTID_ERROR_MEMORY;
    int status = prediction_basis(pool, &f->prediction, part->x, count, v, f->wanted, &count, &v);
    if (!status && count > BASIS_MOST)
        return ROTID_ERROR_RANK;
    in->count[s] = count;
    in->v[s] = v;
    if (!status)
        status = model_in_basis(pool, model, part->x, count, v, basis);
    if (status)
        return status;
    *own = *measured;
    if (own->whole) { /* V is orthonormal and holds these motions */
        double *along = POOL_ARRAY(pool, double, 2 * (size_t)count);
        if (!along)
            return ROTID_ERROR_MEMORY;
        for (int i = 0; i < 2 * count; i++)
            along[i] = product_dot(n, v + (ptrdiff_t)(i % count) * n, measured->whole + (ptrdiff_t)(i / count) * n);
        own->whole = along;
    }
    *out = (struct joint_state){&basis->equations, own, part->parameter};
    return ROTID_OK;
}

static int states_in_basis(void *user, struct pool *pool, struct joint *joint, int anew, const struct joint_state **state)
{
    const struct in_basis *in = user;
    struct joint_state *out = POOL_ARRAY(pool, struct joint_state, in->nstate);
    int status = out ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int s = 0; s < in->nstate && anew; s++) {
        in->count[s] = 0;
        in->v[s] = NULL;
    }
    for (int s = 0; s < in->nstate && !status; s++)
        status = state_in_basis(pool, in, s, &joint->part[s], &out[s]);
    *state = out;
    return status;
}

static void begin_in_basis(void *user, const struct joint *near, struct joint *joint)
{
    const struct in_basis *in = user;
    for (int s = 0; s < in->nstate; s++)
        prediction_begin(&joint->part[s].functional.prediction, in->count[s], in->v[s], &near->part[s].functional.prediction);
}

static int fit_states(struct pool *pool, const struct states *states, const rotid_parameter *bounds, const struct paired *paired,
                      const rotid_fit_options *options, const rotid_environment *environment, rotid_fit_result **fit)
{
    int count = states->nstate;
    struct rotor_model *model = POOL_ARRAY(pool, struct rotor_model, count);
    rotid_measured *measured = POOL_ARRAY(pool, rotid_measured, count);
    rotid_state *state = POOL_ARRAY(pool, rotid_state, count);
    struct in_basis in = {count, model, state, POOL_ARRAY(pool, int, count), POOL_ARRAY(pool, double *, count)};
    const struct fit_near near = {&in, states_in_basis, begin_in_basis};
    int status = model && measured && state && in.count && in.v ? ROTID_OK : ROTID_ERROR_MEMORY, in_basis = 1;
    for (int s = 0; s < count; s++)
        in_basis &= mesh_is_held(&states->state[s].job);
    for (int s = 0; s < count && !status; s++)
        status = open_state(pool, &states->state[s], &paired[s], &model[s], &measured[s], &state[s]);
    if (!status)
        status = fit_states_more(count, state, states->nparameter, bounds, states->more, in_basis ? &near : NULL, options,
                                 environment, NULL, fit);
    for (int s = 0, mode = 0; s < count && !status; mode += measured[s].nmode, s++)
        for (int k = 0; k < measured[s].nmode; k++) /* as the mesh that counts has it */
            (*fit)->predicted_hz[mode + k] *= states->state[s].job.measurement.frequency_hz[k] / measured[s].frequency_hz[k];
    for (int s = 0; s < count && !status; s++) {
        if (!paired[s].mass)
            continue;
        double *x = state_values(pool, &states->state[s], (*fit)->x);
        if (!x) {
            rotid_fit_free(*fit);
            *fit = NULL;
            return ROTID_ERROR_MEMORY;
        }
        discrete_set(&model[s].discrete,
                     x); /* the model stands at the last point that was evaluated; the mass wants the best one */
        model_mass_properties(&model[s], paired[s].mass);
    }
    return status;
}

int identify_fit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                        const rotid_fit_options *given, const rotid_environment *environment, rotid_fit_result **fit)
{
    const rotid_environment quiet = {.size = sizeof quiet,
                                     .cancelled = environment ? environment->cancelled : NULL,
                                     .context = environment ? environment->context : NULL,
                                     .allocator = environment ? environment->allocator : NULL};
    rotid_fit_options options = *given;
    struct pool scratch; /* the models of a fit are not needed behind it */
    options.baseline = 0;
    *fit = NULL;
    pool_open(&scratch, pool->allocator);
    struct paired *paired = POOL_ARRAY(&scratch, struct paired, states->nstate);
    for (int s = 0, mode = 0; s < states->nstate && paired; mode += states->state[s].job.measurement.nmode, s++)
        paired[s] = (struct paired){number + mode, holdout + mode, NULL};
    int status = paired ? fit_states(&scratch, states, states->bounds, paired, &options, &quiet, fit) : ROTID_ERROR_MEMORY;
    pool_close(&scratch);
    if (status || (*fit)->status != ROTID_STOP_CANCELLED)
        return status;
    rotid_fit_free(*fit);
    *fit = NULL;
    return ROTID_STOP_CANCELLED;
}

int identify_numbers(struct pool *pool, const struct states *states, const struct identification *found, int **number,
                     int **holdout)
{
    int all = states_modes(states, states->nstate);
    *number = POOL_ARRAY(pool, int, all);
    *holdout = POOL_ARRAY(pool, int, all);
    if (!*number || !*holdout)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, at = 0; s < states->nstate; s++)
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++, at++) {
            (*number)[at] = found[s].compared.number[k];
            (*holdout)[at] = states->state[s].job.measurement.holdout[k];
        }
    return ROTID_OK;
}

/* Also while NLopt ran: the fit itself is complete then. */
static int is_cancelled(const rotid_fit_result *fit, const rotid_environment *environment)
{
    return fit->status == ROTID_STOP_CANCELLED || environment_cancelled(environment);
}

/* What the model that was fitted predicts at the points of the baseline. */
static int predict_baseline(struct pool *pool, const struct state *state, struct identification *out)
{
    const struct job *job = &state->job;
    const rotid_fit_result *fit = out->fit;
    const struct paired paired = {out->compared.number, job->measurement.holdout, NULL};
    int highest = 1, nmode = job->measurement.nmode;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct prediction p;
    rotid_measured measured;
    rotid_state opened;
    for (int k = 0; k < nmode; k++)
        highest = out->compared.number[k] > highest ? out->compared.number[k] : highest;
    out->baseline_hz = POOL_ARRAY(pool, double, (size_t)nmode *(size_t)fit->nbaseline);
    int status = model && out->baseline_hz ? open_state(pool, state, &paired, model, &measured, &opened) : ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_new(pool, &model->equations, job->options.fit.reduction, ROTID_NELSON,
                                model->equations.nrigid + highest, 0, &p);
    for (int i = 0; i < fit->nbaseline && status != ROTID_ERROR_MEMORY; i++) {
        double *x = state_values(pool, state, fit->baseline[i].x);
        if (!x)
            return ROTID_ERROR_MEMORY;
        int lost = status ? status : prediction_compute(&p, x);
        for (int k = 0; k < nmode; k++)
            out->baseline_hz[k + (ptrdiff_t)i * nmode] =
                lost ? NAN
                     : prediction_hz(&p, model->equations.nrigid + out->compared.number[k] - 1) *
                           job->measurement.frequency_hz[k] / measured.frequency_hz[k];
    }
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* the fit stands without these */
}

static void pass_on(const struct message_list *from, const char *name, struct message_list *notes)
{
    for (size_t i = 0; i < from->count; i++)
        message_at(notes, from->item[i].severity, from->item[i], name ? "%s (state %s)" : "%s", from->item[i].text, name);
}

/* A state while it is fitted. */
struct running {
    struct state *state;
    struct comparison before;
    struct message_list quiet;
    struct identification *out;
    int candidates, held; /* held: on the coarse mesh of a solid */
};

/* The spectrum at the unknowns x of all, and the pairs there. parts: beyond what pairing needs */
static int pair_state(struct pool *pool, struct running *run, const double *x, int parts, struct comparison *pairs)
{
    double *own = state_values(pool, run->state, x);
    message_open(&run->quiet, pool);
    if (!own)
        return ROTID_ERROR_MEMORY;
    parts |= run->state->job.measurement.shape ? SPECTRUM_MASS : 0;
    int status = job_spectrum(pool, &run->state->job, own, run->candidates, parts, &run->out->spectrum);
    return status ? status : comparison_make(pool, &run->state->job, &run->out->spectrum, &run->quiet, pairs);
}

static int pairs_moved(const struct running *run)
{
    return memcmp(run->before.number, run->out->compared.number,
                  (size_t)run->state->job.measurement.nmode * sizeof *run->before.number) != 0;
}

/* At the start. What the pairing there says is not worth repeating unless it ends the run. */
static int pair_at_start(struct pool *pool, const struct states *states, struct running *run, struct message_list *notes)
{
    int status = ROTID_OK;
    const double *start = parameter_starts(pool, states->nparameter, states->bounds);
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &run[s].state->job;
        run[s].candidates = comparison_candidates(job);
        run[s].held = mesh_is_held(job);
        if (job->measurement.nmode)
            continue;
        status = message_refuse(notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1,
                                "the deck has no measured modes%s%s, expected *MODES or *MEASURED",
                                run[s].state->name ? " in state " : "", run[s].state->name ? run[s].state->name : "");
    }
    if (!start)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate && !status; s++) {
        const struct spectrum *spectrum = &run[s].out->spectrum;
        status = pair_state(pool, &run[s], start, run[s].held ? SPECTRUM_COARSE : 0, &run[s].before);
        if (!status || status == ROTID_ERROR_UNPAIRED)
            (void)check_units(&run[s].state->job, spectrum, 0, notes);
        if (!status && run[s].held)
            status = mesh_hold_as_it_is(pool, &run[s].state->job, spectrum->count);
        if (status) {
            pass_on(&run[s].quiet, run[s].state->name, notes);
            run[s].out->compared = run[s].before;
        }
    }
    return status;
}

/* The fit of all as a state sees it: its modes and residuals. */
static int share_fit(struct pool *pool, const rotid_fit_result *fit, int functional, int nstate, struct running *run)
{
    for (int s = 0, mode = 0, row = 0; s < nstate; mode += fit->state_m[s], row += fit->state_nresidual[s], s++) {
        rotid_fit_result *own = POOL_NEW(pool, rotid_fit_result);
        if (!own)
            return ROTID_ERROR_MEMORY;
        *own = *fit;
        own->m = fit->state_m[s];
        own->nresidual = fit->state_nresidual[s];
        own->predicted_hz += mode;
        own->mac += mode;
        own->residual += mode;
        own->r += row;
        own->jacobian = NULL;
        own->memory = NULL;
        own->nstate = 1;
        own->state_m += s;
        own->state_nresidual += s;
        own->objective = 0;
        for (int i = 0; i < own->nresidual; i++)
            own->objective += own->r[i] * own->r[i] / 2;
        own->chi2 = functional == ROTID_LIKELIHOOD ? 2 * own->objective : (double)NAN;
        run[s].out->fit = own;
    }
    return ROTID_OK;
}

/* ROTID_ERROR_RANK of a fit: each unknown has a column of zeros. Names them. Returns ROTID_ERROR_ARGUMENT or ROTID_ERROR_MEMORY.
 */
static int refuse_unmoved(struct pool *pool, const struct states *states, struct message_list *notes)
{
    const struct job *job = &states->state[0].job;
    const char *names = "";
    for (int p = 0; p < states->nparameter && names; p++)
        names = pool_format(pool, "%s%s%s", names, p ? ", " : "", states->bounds[p].name);
    if (!names)
        return ROTID_ERROR_MEMORY;
    return message_refuse(notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1,
                          "no measured mode (TYPE=%s) depends on %s, expected a parameter in *IDENTIFY that moves one",
                          mode_type_words[job->options.type], names);
}

/* After a fit: the spectrum and the pairs of a state there; *moved: the pairs differ from those it had; *apart: raised to how far
 * what the meshes lead to does, of a frequency. */
static int pair_after_fit(struct pool *pool, struct running *run, const double *x, int bare, int *moved, double *apart)
{
    double ratio = 0;
    int status = pair_state(pool, run, x, (bare ? 0 : SPECTRUM_MESH | SPECTRUM_REDUCED) | (run->held ? SPECTRUM_MESH : 0),
                            &run->out->compared);
    if (!status && run->held)
        status = mesh_hold(pool, &run->state->job, &run->out->spectrum, &ratio);
    run->out->held = run->state->job.held;
    if (!status)
        *moved |= pairs_moved(run);
    *apart = fmax(*apart, ratio);
    return status;
}

/* A fit to data that the mesh which counts has moved by little begins where the one before ended, at `bounds`. Not with NLopt
 * beside it, which begins at the start as well, and not from a bound. */
static int restart_from(const struct states *states, const struct running *run, int baseline, const rotid_fit_result *fit,
                        rotid_parameter *bounds)
{
    int near = fit && run[0].held && !baseline && fit->converged && !fit->any_at_bound;
    for (int p = 0; p < states->nparameter; p++) {
        bounds[p] = states->bounds[p];
        if (near)
            bounds[p].start = fit->x[p];
    }
    return near;
}

/* The rows of the fit before, then those of this one, which began where that ended; counts are of both. */
static int join(struct pool *pool, const rotid_fit_result *before, rotid_fit_result *fit)
{
    int rows = before->nhistory + fit->nhistory, n = fit->n;
    rotid_fit_iteration *history = POOL_ARRAY(pool, rotid_fit_iteration, rows);
    double *x = POOL_ARRAY(pool, double, (size_t)rows *(size_t)n);
    if (!history || !x)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < rows; i++) {
        int own = i - before->nhistory;
        history[i] = own < 0 ? before->history[i] : fit->history[own];
        memcpy(x + (ptrdiff_t)i * n, own < 0 ? before->history_x + (ptrdiff_t)i * n : fit->history_x + (ptrdiff_t)own * n,
               (size_t)n * sizeof *x);
        if (own < 0)
            continue;
        history[i].iteration += before->iterations + 1;
        history[i].seconds += before->seconds;
    }
    fit->history = history;
    fit->history_x = x;
    fit->nhistory = rows;
    fit->iterations += before->iterations + 1;
    fit->evaluations += before->evaluations;
    fit->jacobians += before->jacobians;
    fit->seconds += before->seconds;
    return ROTID_OK;
}

static int with_models(struct pool *pool, const struct states *states, int baseline, int bare,
                       const rotid_environment *environment, struct message_list *notes, struct running *run,
                       rotid_fit_result **fit)
{
    int count = states->nstate, status = pair_at_start(pool, states, run, notes), moved = 0;
    double apart = 0;
    struct paired *paired = POOL_ARRAY(pool, struct paired, count);
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, states->nparameter);
    if (status || !paired || !bounds)
        return status ? status : ROTID_ERROR_MEMORY;
    rotid_fit_options options = states->state[0].job.options.fit;
    for (int round = 1;; round++) {
        options.baseline = baseline && (!run[0].held || round > 1); /* not before the coarse mesh is held */
        rotid_fit_result *last = *fit;
        int goes_on = restart_from(states, run, options.baseline, last, bounds);
        *fit = NULL;
        for (int s = 0; s < count; s++)
            paired[s] = (struct paired){run[s].before.number, run[s].state->job.measurement.holdout, &run[s].out->mass};
        status = fit_states(pool, states, bounds, paired, &options, environment, fit);
        if (status == ROTID_ERROR_RANK)
            status = refuse_unmoved(pool, states, notes);
        if (!status && goes_on)
            status = join(pool, last, *fit);
        rotid_fit_free(last);
        moved = options.baseline != baseline;
        apart = 0;
        for (int s = 0; s < count && !status; s++)
            status = pair_after_fit(pool, &run[s], (*fit)->x, bare, &moved, &apart);
        int again = round < ROUNDS ? moved || apart > HELD : !moved && apart > HELD && round < MESH_ROUNDS;
        if (status || !again || is_cancelled(*fit, environment))
            break;
        for (int s = 0; s < count; s++)
            run[s].before = run[s].out->compared;
    }
    for (int s = 0; s < count; s++)
        pass_on(&run[s].quiet, run[s].state->name, notes);
    if (!status && run[0].state->name)
        status = share_fit(pool, *fit, options.functional, count, run);
    else if (!status)
        run[0].out->fit = *fit;
    for (int s = 0; s < count && !status && (*fit)->nbaseline; s++)
        status = predict_baseline(pool, run[s].state, run[s].out);
    if (status)
        return status;
    for (int s = 0, paired_anew = 0; s < count; s++)
        if (pairs_moved(&run[s]) && !paired_anew++)
            message_warn(notes, "the pairing of the modes still changes with the fitted model: the result is not reliable");
    if (apart > HELD && !moved && !is_cancelled(*fit, environment))
        message_warn(
            notes,
            "what two meshes of the solid lead to still changes with the fitted model, by %.2g %% of a frequency: the result is "
            "not reliable",
            100 * apart);
    for (int s = 0; s < count; s++) {
        const struct job *job = &run[s].state->job;
        run[s].out->shapes_fitted = uses_shapes(job) && !(job->options.fit.functional != ROTID_LIKELIHOOD &&
                                                          job->options.fit.reduction == ROTID_REDUCTION_NONE);
    }
    return ROTID_OK;
}

int identify_states(struct pool *pool, const struct states *given, int how, const rotid_environment *environment,
                    struct message_list *notes, struct identification *out, rotid_fit_result **fit)
{
    int count = given->nstate, status = ROTID_OK, begun = 0;
    struct states states = *given;
    struct running *run = POOL_ARRAY(pool, struct running, count);
    states.state = POOL_ARRAY(pool, struct state, count);
    *fit = NULL;
    for (int s = 0; s < count; s++)
        out[s] = (struct identification){0};
    if (!run || !states.state)
        return ROTID_ERROR_MEMORY;
    for (; begun < count && !status; begun++) {
        struct state *state = &states.state[begun];
        *state = given->state[begun];
        state->job.models = models_for_run(pool, state->job.models);
        status = state->job.models ? ROTID_OK : ROTID_ERROR_MEMORY;
        message_open(&run[begun].quiet, pool);
        run[begun].state = state;
        run[begun].out = &out[begun];
    }
    if (!status)
        status = with_models(pool, &states, how & IDENTIFY_BASELINE, how & IDENTIFY_BARE, environment, notes, run, fit);
    for (int s = 0; s < begun; s++)
        if (states.state[s].job.models)
            models_end_run(pool, states.state[s].job.models, given->state[s].job.models);
    if (status) {
        rotid_fit_free(*fit);
        *fit = NULL;
        for (int s = 0; s < count; s++)
            out[s].fit = NULL;
    }
    return status;
}

int identify_own_unknowns(struct pool *pool, const struct state *state, struct identification *out)
{
    int n = state->job.unknowns.nparameter;
    rotid_fit_result *own = POOL_NEW(pool, rotid_fit_result);
    int *flag = POOL_ARRAY(pool, int, 2 * n);
    double *value[4] = {out->fit->x, out->fit->std, out->fit->ci_lower, out->fit->ci_upper};
    if (!own || !flag)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 4; i++)
        if (!(value[i] = state_values(pool, state, value[i])))
            return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++) {
        flag[p] = out->fit->at_bound[state_unknown(state, p)];
        flag[n + p] = out->fit->identifiable[state_unknown(state, p)];
    }
    *own = *out->fit;
    own->n = n;
    own->x = value[0];
    own->std = value[1];
    own->ci_lower = value[2];
    own->ci_upper = value[3];
    own->at_bound = flag;
    own->identifiable = flag + n;
    own->covariance = own->correlation = own->singular_value = own->direction = own->history_x = NULL;
    own->direction_undetermined = NULL;
    own->nhistory = own->nbaseline = 0;
    out->fit = own;
    return ROTID_OK;
}

int identify_run(struct pool *pool, const struct job *job, int how, const rotid_environment *environment,
                 struct message_list *notes, struct identification *out)
{
    struct state state;
    const struct states states = states_of(job, &state);
    rotid_fit_result *fit;
    return identify_states(pool, &states, how, environment, notes, out, &fit);
}

void identify_warn_of_reduction(const struct job *job, const struct identification *result, const char *what,
                                struct message_list *notes)
{
    double worst = 0;
    for (int k = 0; k < result->compared.nmode; k++) {
        double error = result->spectrum.reduction_error_percent[result->compared.number[k] - 1];
        if (fabs(error) > fabs(worst))
            worst = error;
    }
    if (job->options.fit.reduction != ROTID_REDUCTION_NONE && fabs(worst) > 0.5)
        message_warn(notes,
                     "identified with REDUCTION=%s, whose frequencies are up to %+.1f %% off those of the full model that is %s "
                     "here (rotid identify, column reduction)",
                     reduction_words[job->options.fit.reduction], worst, what);
}
