/* The base: the model the user has, in full and by the likelihood, on a mesh and on data that are not to blame themselves. */
#include "diagnose/diagnose.h"

static int failed(int status)
{
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* the modes are others there: nothing is known */
}

struct mesh_error {
    double worth; /* ||(I - Q Q') (r' - r)||^2: the chi2 that a cause could gain from the mesh alone */
    double moved; /* ||Q' (r' - r)||: how far the mesh moves the fitted parameters, in standard deviations */
};

/* r the residual of a job at its fitted values x, r' that of `finer`, the same job with more elements, Q an orthonormal basis of
 * the sensitivities of the fitted parameters. Frequencies do not tell it: of two modes close to each other a mesh that moves both
 * by little turns the shapes. 0 where the finer mesh has no such modes. ROTID_OK, ROTID_ERROR_MEMORY. */
static int compare_meshes(struct pool *pool, const struct engine *engine, const struct job *job, const struct job *finer,
                          const double *x, struct mesh_error *error)
{
    struct columns here, there;
    int parameters = job->unknowns.nparameter, count = 0;
    *error = (struct mesh_error){0};
    int status = columns_open(pool, job, engine->number, engine->holdout, NULL, x, &here);
    if (!status)
        status = columns_prepare(&here, NULL);
    if (!status)
        status = columns_open(pool, finer, engine->number, engine->holdout, NULL, x, &there);
    if (status)
        return failed(status);
    int n = here.nrow;
    double *direction = POOL_ARRAY(pool, double, (size_t)n *(size_t)(parameters + 1)), *change = POOL_ARRAY(pool, double, n);
    if (!direction || !change)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < parameters; p++) {
        double *column = direction + (ptrdiff_t)count * n;
        if ((status = columns_parameter(&here, p, column)))
            return failed(status);
        count = basis_extend(n, count, 1e-6, direction);
    }
    for (int i = 0; i < n; i++)
        change[i] = there.r[i] - here.r[i];
    error->moved = sqrt(basis_remove(n, count, direction, change));
    error->worth = product_dot(n, change, change);
    return ROTID_OK;
}

#define MOST_DROPPED 4 /* modes that nobody's shape fits: of 1,000 random rotors one needs more than two */
#define LEAST_LEFT   3
#define MOST_REFINED 3 /* times the mesh is halved */
#define MOST_WEIGHED 5
#define SAME_MASS    0.1 /* standard deviations */
#define MESH_WORTH   1.0 /* of chi2, where noise makes one a residual: from there a mesh is refined, */
#define MESH_MOVES   0.5 /* or of the standard deviation of a parameter */
#define NEGLIGIBLE   0.1 /* of the noise of a frequency: an error of the mesh that moves no modulus out of its interval */

static int add_numerical(struct engine *engine, const char *id, int count, const double *error, const char *text)
{
    struct diagnosis *out = engine->out;
    int *mode = POOL_ARRAY(engine->pool, int, count);
    double *copy = POOL_ARRAY(engine->pool, double, count);
    if (!mode || !copy || !text)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < count; k++) {
        mode[k] = k + 1;
        copy[k] = error[k];
    }
    out->result.numerical_findings[out->result.nnumerical_findings++] =
        (rotid_numerical_finding){.id = id, .nmodes = count, .modes = mode, .error_percent = copy, .text = text};
    return ROTID_OK;
}

/* Largest error of the measured modes against the noise of their frequencies; *at: that mode. */
static double against_noise(const struct job *job, const int *number, const double *error, int count, int *at)
{
    double largest = 0;
    *at = 0;
    for (int k = 0; k < job->measurement.nmode; k++) {
        int mode = number[k] - 1;
        if (mode >= count || !isfinite(error[mode]))
            continue;
        double ratio = fabs(error[mode]) / (100 * job->measurement.frequency_std[k]);
        if (ratio > largest) {
            largest = ratio;
            *at = mode;
        }
    }
    return largest;
}

/* Whether a deck may have twice as many. */
static int can_be_refined(const struct rotor *rotor)
{
    long elements = 2 * rotor_elements(rotor);
    for (int i = 0; i < rotor->ntierod; i++)
        elements += rotor->tierod[i].elements;
    for (int i = 0; i < rotor->nbars; i++)
        elements += 2L * rotor->bars[i].elements;
    return elements <= ROTOR_MOST_ELEMENTS;
}

/* Elements twice as many, but for rods, which have modes of their own by their elements: the error of the mesh is taken out
 * before anything else is blamed. */
static int refine_mesh(struct pool *pool, struct rotor *rotor)
{
    rotor->segment = POOL_COPY(pool, rotor->segment, rotor->nsegment, 0);
    rotor->bars = POOL_COPY(pool, rotor->bars, rotor->nbars, 1);
    if (!rotor->segment || !rotor->bars)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsegment; s++)
        rotor->segment[s].elements *= 2;
    for (int i = 0; i < rotor->nbars; i++)
        rotor->bars[i].elements *= 2;
    return ROTID_OK;
}

/* The same of a job and its fitted values, beside twice as many elements. */
static int find_mesh_error(const struct engine *engine, const struct job *job, const double *x, struct mesh_error *error)
{
    struct pool scratch;
    struct job finer = *job;
    pool_open(&scratch, engine->pool->allocator);
    int status = refine_mesh(&scratch, &finer.rotor);
    if (!status)
        status = compare_meshes(&scratch, engine, job, &finer, x, error);
    pool_close(&scratch);
    return status;
}

static int is_too_coarse(const struct mesh_error *error)
{
    return error->worth > MESH_WORTH || error->moved > MESH_MOVES;
}

/* That the mesh is made finer, once: by the error `ratio` of mode `at` against its noise, or where that is small by what
 * it does to the fit. */
static int note_mesh(struct engine *engine, double ratio, int at, const struct mesh_error *error)
{
    const rotid_diagnosis *out = &engine->out->result;
    const struct spectrum *s = &engine->out->base.spectrum;
    for (int i = 0; i < out->nnumerical_findings; i++)
        if (!strcmp(out->numerical_findings[i].id, "mesh"))
            return ROTID_OK;
    return add_numerical(
        engine, "mesh", s->count, s->mesh_error_percent,
        ratio > 1 ? pool_format(engine->pool, "the mesh moves mode %d by %+.2f %%, %.1f times its noise; a finer mesh is used",
                                at + 1, s->mesh_error_percent[at], ratio)
        : error->worth > MESH_WORTH
            ? pool_format(engine->pool, "the error of the mesh raises chi2 by %.2g; a finer mesh is used", error->worth)
            : pool_format(engine->pool,
                          "the error of the mesh moves the fitted parameters by %.2g standard deviations; a finer mesh is used",
                          error->moved));
}

int base_note_reduction(struct engine *engine)
{
    const struct diagnosis *out = engine->out;
    const struct spectrum *s = &out->today.spectrum;
    int at;
    if (engine->states.nstate > 1 || !out->today.fit || engine->user_reduction == ROTID_REDUCTION_NONE)
        return ROTID_OK;
    double ratio = against_noise(engine->job, engine->number, s->reduction_error_percent, s->count, &at);
    if (!(ratio > 1))
        return ROTID_OK;
    return add_numerical(
        engine, "guyan_reduction", s->count, s->reduction_error_percent,
        pool_format(engine->pool,
                    "the condensation onto %d masters moves mode %d by %+.2f %%, %.1f times its noise; the full model is used",
                    s->nmaster, at + 1, s->reduction_error_percent[at], ratio));
}

int base_identify(struct engine *engine, const struct states *states, struct message_list *notes, struct identification **each,
                  struct identification *first)
{
    rotid_fit_result *fit = NULL;
    *each = POOL_ARRAY(engine->pool, struct identification, states->nstate);
    if (!*each)
        return ROTID_ERROR_MEMORY;
    int status = identify_states(engine->pool, states, 0, engine->environment, notes, *each, &fit);
    *first = **each;
    first->fit = fit;
    return status;
}

/* A parameter at a bound may have been caught there: once more from inside, and the better fit counts. */
static int leave_bound(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    struct identification second, *each;
    struct message_list quiet;
    struct states states;
    message_open(&quiet, engine->pool);
    int status = states_started_at(engine->pool, &engine->states, out->base.fit->x, &states);
    if (!status)
        status = base_identify(engine, &states, &quiet, &each, &second);
    if (status) /* the first one stands */
        return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
    int better = second.fit->status != ROTID_STOP_CANCELLED && second.fit->chi2 < out->base.fit->chi2;
    rotid_fit_free(better ? out->base.fit : second.fit);
    if (better) {
        out->base = second;
        out->state_base = each;
    }
    return ROTID_OK;
}

/* A misfit may be nothing but a bound of *IDENTIFY that holds a parameter off. */
static void note_bounds(struct engine *engine)
{
    for (int p = 0; p < engine->nown; p++)
        if (engine->fit->at_bound[p]) {
            const rotid_parameter *bounds = &engine->out->judged.bounds[p];
            message_warn(engine->notes,
                         "without a cause %s ends at its %s bound %.4g %s: the bound itself may be what is wrong; widen it where "
                         "physics allows",
                         bounds->name, base_bound_side(engine, p), engine->fit->x[p], bounds->unit);
        }
}

const char *base_bound_side(const struct engine *engine, int p)
{
    const rotid_parameter *bounds = &engine->out->judged.bounds[p];
    double x = engine->out->base.fit->x[p];
    return x - bounds->lower < bounds->upper - x ? "lower" : "upper";
}

/* Numbers and held-out modes of all states, one behind the other, as the base has them. */
static int take_numbers(struct engine *engine)
{
    engine->number = engine->out->base.compared.number;
    engine->holdout = engine->job->measurement.holdout;
    if (engine->states.nstate == 1)
        return ROTID_OK;
    return identify_numbers(engine->pool, &engine->states, engine->out->state_base, &engine->number, &engine->holdout);
}

/* Measured modes keep the numbers that they have beside the base: a spring that a candidate adds or stiffens makes its suspension
 * modes bend, and counting them anew would turn every number into that of another mode. A solid keeps what holds its mesh. */
static void settle_numbers(struct engine *engine)
{
    for (int s = 0; s < engine->states.nstate; s++) {
        struct job *job = &engine->states.state[s].job;
        job->rotor.settled_rigid = 1 + engine->out->state_base[s].spectrum.nrigid;
        job->held = job->options.solid ? engine->out->state_base[s].held : job->held;
    }
}

/* say: the notes of the fit */
static int fit_base(struct engine *engine, int say)
{
    struct diagnosis *out = engine->out;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    rotid_fit_free(out->base.fit);
    out->base.fit = engine->fit = NULL;
    int status = base_identify(engine, &engine->states, &quiet, &out->state_base, &out->base);
    for (int pass = 0; status == ROTID_ERROR_UNPAIRED && engine->states.nstate == 1 && pass < MOST_DROPPED &&
                       engine->job->measurement.nmode > LEAST_LEFT && !engine->job->measurement.raw;
         pass++) {
        status = pairing_drop(engine, engine->out->base.compared.clash);
        message_open(&quiet, engine->pool);
        if (!status)
            status = base_identify(engine, &engine->states, &quiet, &out->state_base, &out->base);
    }
    for (size_t i = 0; i < quiet.count && (say || status); i++)
        message_add(engine->notes, quiet.item[i].severity, NULL, 0, 0, "%s", quiet.item[i].text);
    if (status)
        return status;
    if (out->base.fit->any_at_bound && out->base.fit->status != ROTID_STOP_CANCELLED)
        status = leave_bound(engine);
    if (status)
        return status;
    engine->fit = out->base.fit;
    if (out->base.fit->status == ROTID_STOP_CANCELLED)
        return ROTID_STOP_CANCELLED;
    status = take_numbers(engine);
    settle_numbers(engine);
    out->judged = engine->states;
    if (!status)
        status = states_started_at(engine->pool, &out->judged, engine->fit->x, &engine->states);
    engine_look_at(engine, 0);
    return status;
}

/* The accelerometer is weighed by the shapes of the fitted model, and the fit is spoilt by its weight: in turn, each time from
 * the data as they came, until the mass stays. */
static int weigh_accelerometer(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    const struct job came = *engine->job;
    double mass = 0;
    int status = ROTID_OK, changed = 1, nfinding = out->result.ndata_findings;
    for (int pass = 0; pass < MOST_WEIGHED && changed && !status; pass++) {
        const double *x = engine->fit->x;
        struct job job = came;
        status = job_started_at(engine->pool, &came, x, &job);
        if (!status)
            status = data_copy(engine->pool, &job);
        engine_take_job(engine, &job);
        out->result.ndata_findings = nfinding;
        if (!status)
            status = data_weigh_accelerometer(engine, &changed);
        if (status || !changed)
            break;
        status = fit_base(engine, 0);
        if (fabs(engine->moving.mass - mass) < SAME_MASS * engine->moving.std)
            break;
        mass = engine->moving.mass;
    }
    data_note_readings(engine);
    return status;
}

static int is_judgeable(struct engine *engine)
{
    if (engine->fit->dof >= 1)
        return ROTID_OK;
    return message_refuse(
        engine->notes, ROTID_ERROR_ARGUMENT, engine->job->deck, 1, 1,
        "%d residuals for %d parameters leave no degree of freedom to test the model, expected more modes or shapes",
        engine->fit->nresidual, engine->fit->n);
}

/* Base fit and a mesh fine enough: what the rounds start from. */
int base_prepare(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    int status = fit_base(engine, 1), at, one = engine->states.nstate == 1;
    if (!status && one)
        status = pairing_note(engine, engine->job->measurement.number);
    if (!status && one) /* before the channels are judged: its mass is seen in the shapes too */
        status = weigh_accelerometer(engine);
    if (!status && one && engine->job->options.solid) /* whose mesh follows from its outline, not from elements of the deck */
        comparison_warn_of_mesh(engine->job, &out->base.spectrum, &out->base.compared, engine->notes);
    for (int pass = 0;
         pass < MOST_REFINED && !status && one && !engine->job->options.solid && can_be_refined(&engine->job->rotor); pass++) {
        const struct spectrum *s = &out->base.spectrum;
        double ratio = against_noise(engine->job, engine->number, s->mesh_error_percent, s->count, &at);
        struct mesh_error error = {0};
        if (!(ratio > 1))
            status = find_mesh_error(engine, engine->job, engine->fit->x, &error);
        if (status || (!(ratio > 1) && !is_too_coarse(&error)))
            break;
        status = note_mesh(engine, ratio, at, &error);
        if (!status)
            status = refine_mesh(engine->pool, &engine->job->rotor);
        if (!status)
            status = fit_base(engine, 0);
    }
    if (!status)
        status = is_judgeable(engine);
    if (!status)
        note_bounds(engine);
    return status;
}

/* The residuals of a state, whose modes begin at `mode` of all and whose rows at `row`. */
static void residuals_of(const struct engine *engine, const struct job *job, int mode, int row, rotid_sensor_residual *sensor,
                         int *count)
{
    const rotid_fit_result *fit = engine->fit;
    const int *holdout = engine->holdout + mode;
    int nsensor = job->rotor.nsensor, shapes = job_fits_shapes(job);
    for (int k = 0; k < job->measurement.nmode; k++) {
        engine->out->result.modes_standardised[mode + k] = fit->residual[mode + k];
        row += !holdout[k];
    }
    for (int k = 0; k < job->measurement.nmode && shapes; k++)
        for (int s = 0; s < nsensor && !holdout[k]; s++)
            if (isfinite(job->measurement.shape[s + (ptrdiff_t)k * nsensor])) {
                sensor[s].rms += fit->r[row] * fit->r[row];
                count[s]++;
                row++;
            }
    for (int s = 0; s < nsensor; s++)
        sensor[s] = (rotid_sensor_residual){.id = job->rotor.sensor[s].id,
                                            .z_m = job->rotor.sensor[s].position,
                                            .rms = count[s] ? sqrt(sensor[s].rms / count[s]) : (double)NAN};
}

int base_residuals(struct engine *engine)
{
    rotid_diagnosis *out = &engine->out->result;
    const struct states *states = &engine->states;
    const struct job *job = engine->job;
    int nsensor = 0, shapes = job_fits_shapes(job);
    for (int s = 0; s < states->nstate; s++)
        nsensor += states->state[s].job.rotor.nsensor;
    int *count = POOL_ARRAY(engine->pool, int, nsensor);
    out->nmodes_standardised = POOL_LIST(engine->pool, out->modes_standardised, states_modes(states, states->nstate));
    out->nsensors = POOL_LIST(engine->pool, out->sensors, nsensor);
    if (!out->modes_standardised || !out->sensors || !count)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, mode = 0, row = 0, at = 0; s < states->nstate; s++) {
        const struct job *own = &states->state[s].job;
        residuals_of(engine, own, mode, row, out->sensors + at, count + at);
        for (int i = at; i < at + own->rotor.nsensor; i++)
            out->sensors[i].state = states->state[s].name;
        mode += own->measurement.nmode;
        row += engine->fit->state_nresidual[s];
        at += own->rotor.nsensor;
    }
    if (job->measurement.nmode)
        out->noise.frequency = job->measurement.frequency_std[0];
    for (ptrdiff_t i = 0; i < (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode && shapes && !isfinite(out->noise.shape);
         i++)
        out->noise.shape = job->measurement.shape_std[i];
    return ROTID_OK;
}

int base_again(struct engine *engine)
{
    int status = fit_base(engine, 0);
    return status ? status : base_residuals(engine);
}

int base_refine_beside(struct engine *engine, const struct job *job, const double *x, int *changed)
{
    struct mesh_error error = {0}, first;
    *changed = 0;
    if (engine->states.nstate > 1 || job->options.solid || !can_be_refined(&job->rotor))
        return ROTID_OK;
    int status = find_mesh_error(engine, job, x, &error);
    first = error;
    for (int pass = 0; pass < MOST_REFINED && is_too_coarse(&error) && !status && can_be_refined(&engine->job->rotor); pass++) {
        error = (struct mesh_error){error.worth / 16, error.moved / 4};
        status = refine_mesh(engine->pool, &engine->job->rotor);
        *changed = 1;
    }
    return *changed && !status ? note_mesh(engine, 0, 0, &first) : status;
}

int base_halvings(const struct job *job, const int *number, const struct spectrum *spectrum)
{
    int at, count = 0;
    double ratio = job->options.solid ? 0 : against_noise(job, number, spectrum->mesh_error_percent, spectrum->count, &at);
    for (; count < MOST_REFINED && ratio > NEGLIGIBLE; count++)
        ratio /= 4;
    return count;
}

int base_refine(struct pool *pool, struct job *job, int halvings)
{
    int status = ROTID_OK;
    for (int pass = 0; pass < halvings && !status && can_be_refined(&job->rotor); pass++)
        status = refine_mesh(pool, &job->rotor);
    return status;
}
