#include "run/run.h"

#define WITHIN       1e-8 /* of a vector: what is shown, paired and compared needs no more, and frequencies have the square of it */
#define ROUGH        1e-4  /* the same of a trial */
#define APART        0.02  /* of a frequency: two meshes that differ by more lead nowhere */
#define ALIKE        0.8   /* MAC of a mode on two meshes, weighted by the mass: of those of a crossing each has 0.5 */
#define CROSSED      1e-3  /* of a frequency: a limit so far below the one before, or above a mode that was missed */
#define OF_A_WAVE    0.2   /* that an element may be long: a quadratic one raises its frequency by 0.1 % */
#define MOST_FINE    50000 /* unknowns of a mesh that may be refined once more */
#define MOST_ENTRIES 2e7   /* of its K, which has eight times as many then */
#define MOST_MASTERS 1000  /* more cost seconds and gigabytes to condense onto, the cube and the square of their number */

/* What is solved for: a rotor at the values x of its parameters; how exactly, and what a solution begins with in place of the
 * modes that all share: NULL, or a spectrum of nearly the same model, which may be of another size. */
struct task {
    struct models *models;
    const struct rotor *rotor;
    int nparameter;
    const struct parameter *parameter;
    const double *x;
    double within;
    const struct spectrum *near;
};

/* What is kept of a solution: pairs from the rigid ones on. */
struct solution {
    struct rotor_model *model;
    int size, pairs;
    double *hz, *phi, *shape; /* [pairs] and [size * pairs], rigid ones first, [nmaster * count] without those */
    int *same; /* [count] which elastic mode of the solution it was compared with has that shape, -1: none; NULL: as
                  they are numbered */
};

/* Full model on a mesh `refine` times as fine; *count is lowered to the modes it has. known: NULL, or the solution on another
 * mesh. scratch: for what its solution takes */
static int full_model(struct pool *pool, struct pool *scratch, const struct task *task, int refine, const struct solution *known,
                      int *count, struct rotor_model *model, struct prediction *prediction)
{
    int failed, status = model_open(pool, task->models, task->rotor, task->nparameter, task->parameter, refine, model, &failed);
    int most = status ? 0 : model->equations.n - model->equations.nrigid;
    const double *shared = status ? NULL : model->equations.modes;
    int nshared = status ? 0 : model->equations.nmodes;
    *count = *count < most ? *count : most;
    int pairs = status ? 0 : model->equations.nrigid + *count;
    const struct spectrum *near = task->near;
    if (!status && near && near->model->equations.n == model->equations.n && near->nrigid + near->count >= pairs) {
        model->equations.modes = near->phi - (ptrdiff_t)near->nrigid * model->equations.n;
        model->equations.nmodes = pairs;
    }
    if (!status && known && known->pairs >= pairs && nshared < pairs)
        status = model_begin_with(scratch, model, known->model, pairs, known->phi);
    if (!status)
        status = prediction_new(scratch, &model->equations, ROTID_REDUCTION_NONE, ROTID_NELSON, pairs, 0, prediction);
    model->equations.modes = shared; /* the others do not last as long */
    model->equations.nmodes = nshared;
    if (!status) {
        eigen_full_within(&prediction->full, task->within);
        prediction->full.panels.vouched = model_mass_is_positive(model);
        status = prediction_compute(prediction, task->x);
    }
    if (!status && !task->rotor->neffect) /* before candidates are tried, one after the other */
        status = models_keep_modes(task->models, model->equations.n, prediction->count, prediction->phi);
    return status;
}

static void keep_shapes(const struct rotor_model *model, const struct prediction *p, int count, double *shapes)
{
    int nmaster = model->equations.nmaster;
    for (int j = 0; j < count; j++) {
        double *shape = shapes + (ptrdiff_t)j * nmaster, largest = 0;
        for (int i = 0; i < nmaster; i++) {
            shape[i] = prediction_at_sensor(p, model->equations.nrigid + j, i);
            if (fabs(shape[i]) > fabs(largest))
                largest = shape[i];
        }
        for (int i = 0; i < nmaster && largest != 0; i++)
            shape[i] /= largest;
    }
}

/* same of a solution whose model stands at x, by the mass between its modes and the other ones on its mesh. */
static int pair_meshes(struct pool *pool, struct pool *scratch, const struct prediction *p, const struct solution *known,
                       struct solution *out)
{
    int n = out->size, rigid = out->model->equations.nrigid, count = out->pairs - rigid;
    int known_rigid = known->model->equations.nrigid, most = known->pairs - known_rigid;
    double *there = POOL_ARRAY(scratch, double, n), *image = POOL_ARRAY(scratch, double, n),
           *best = POOL_ARRAY(scratch, double, count);
    out->same = POOL_ARRAY(pool, int, count);
    if (!there || !image || !best || !out->same)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++) {
        best[i] = ALIKE;
        out->same[i] = -1;
    }
    for (int j = 0; j < most; j++) {
        const double *mode = known->phi + (ptrdiff_t)(known_rigid + j) * known->model->equations.n;
        if (!discrete_transfer(&known->model->discrete, mode, &out->model->discrete, there)) {
            out->same = NULL;
            return ROTID_OK;
        }
        matrix_multiply(&p->m, 1, there, image);
        double square = product_dot(n, there, image);
        for (int i = 0; i < count; i++) {
            double c = product_dot(n, out->phi + (ptrdiff_t)(rigid + i) * n, image);
            if (c * c > best[i] * square) {
                best[i] = c * c / square;
                out->same[i] = j;
            }
        }
    }
    return ROTID_OK;
}

/* The matrices and factors of a solution, ten times what is kept of it, go before the next one. */
static int solve(struct pool *pool, const struct task *task, int refine, const struct solution *known, int *count,
                 struct solution *out)
{
    struct pool scratch;
    struct prediction p;
    out->model = POOL_NEW(pool, struct rotor_model);
    if (!out->model)
        return ROTID_ERROR_MEMORY;
    pool_open(&scratch, pool->allocator);
    int status = full_model(pool, &scratch, task, refine, known, count, out->model, &p);
    if (!status) {
        const rotid_model *equations = &out->model->equations;
        out->size = p.size;
        out->pairs = equations->nrigid + *count;
        out->hz = POOL_ARRAY(pool, double, out->pairs);
        out->phi = POOL_COPY(pool, p.phi, (size_t)p.size * (size_t)out->pairs, 0);
        out->shape = POOL_ARRAY(pool, double, (size_t)equations->nmaster *(size_t)*count);
        status = out->hz && out->phi && out->shape ? ROTID_OK : ROTID_ERROR_MEMORY;
        for (int j = 0; j < out->pairs && !status; j++)
            out->hz[j] = prediction_hz(&p, j);
        if (!status)
            keep_shapes(out->model, &p, *count, out->shape);
        if (!status && known)
            status = pair_meshes(pool, &scratch, &p, known, out);
    }
    pool_close(&scratch);
    return status;
}

/* Guyan's mass for the NCO */
static int condensed_mass(struct pool *pool, struct pool *scratch, struct prediction *p, const double *x, struct spectrum *s)
{
    struct reduction r;
    int status = prediction_matrices(p, x);
    if (!status)
        status = reduction_new(scratch, ROTID_GUYAN, &p->k, s->nmaster, p->model->master, &r);
    if (!status)
        status = reduction_compute(&r, &p->k, &p->m);
    if (!status && !(s->mass = POOL_COPY(pool, r.mc, (size_t)s->nmaster * (size_t)s->nmaster, 0)))
        status = ROTID_ERROR_MEMORY;
    return status;
}

/* Frequencies of the condensed model as far as it has any, beginning with the modes of the full one, and the mass, each where it
 * is asked for; full_hz: of the same mesh in full. */
static int condense(struct pool *pool, const struct solution *full, const double *x, int reduction, int parts,
                    const double *full_hz, struct spectrum *s)
{
    int wanted = s->nrigid + s->count, count = wanted < s->nmaster ? wanted : s->nmaster;
    rotid_model model = full->model->equations;
    struct prediction p;
    struct pool scratch;
    model.modes = full->phi;
    model.nmodes = full->pairs;
    pool_open(&scratch, pool->allocator);
    int status = prediction_new(&scratch, &model, reduction, ROTID_NELSON, count, 0, &p);
    if (!status && parts & SPECTRUM_MASS)
        status = condensed_mass(pool, &scratch, &p, x, s);
    if (!status && parts & SPECTRUM_REDUCED)
        status = prediction_compute(&p, x);
    for (int j = 0; j < s->count && !status && parts & SPECTRUM_REDUCED; j++)
        s->reduced_hz[j] = s->nrigid + j < count ? prediction_hz(&p, s->nrigid + j) * s->full_hz[j] / full_hz[j] : NAN;
    pool_close(&scratch);
    /* nothing to condense onto, with one sensor, say, and nothing to report */
    return status == ROTID_ERROR_SLAVE || status == ROTID_ERROR_MASS || status == ROTID_ERROR_STIFFNESS ? ROTID_OK : status;
}

int spectrum_compute(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                     const struct parameter *parameter, const double *x, int reduction, int count, struct spectrum *spectrum)
{
    return spectrum_compute_parts(pool, models, rotor, nparameter, parameter, x, reduction, count, SPECTRUM_WHOLE, spectrum);
}

/* Which mode of the solution that it was compared with mode j is, and which of a solution the mode j of the other one is; -1:
 * none has its shape. */
static int partner_of(const struct solution *s, int j)
{
    return s->same ? s->same[j] : j;
}

static int partner_from(const struct solution *s, int count, int j)
{
    for (int i = 0; i < count && s->same; i++)
        if (s->same[i] == j)
            return i;
    return s->same ? -1 : j;
}

/* What hz and the frequency of a mode on another mesh lead to: the mesh error of mode j, and where the limit counts its
 * frequency; 0 and neither where the meshes are too far apart for that. */
static int lead(double hz, const struct solution *other, int partner, double share, int counts, struct spectrum *s, int j)
{
    double there = partner < 0 ? NAN : other->hz[other->model->equations.nrigid + partner], led_to = hz - share * (there - hz);
    if (isnan(there) || (counts && !(fabs(there - hz) <= APART * fabs(hz))))
        return 0;
    s->full_hz[j] = counts ? led_to : hz;
    s->mesh_error_percent[j] = 100 * (hz / led_to - 1);
    return 1;
}

/* How many modes, followed to where at [count] says, finer meshes than this one have to lead: those that none led, and those
 * whose waves are short beside elements of it. Such elements may be in the mesh before as well, so that the two agree says
 * nothing: what they led to is taken back, its mesh error into led [count]. */
static int modes_to_lead(const struct solution *finest, const int *at, struct spectrum *s, double *led)
{
    double passage = discrete_passage(&finest->model->discrete);
    int count = 0;
    for (int j = 0; j < s->count; j++) {
        if (!isnan(s->mesh_error_percent[j]) && passage * s->full_hz[j] > OF_A_WAVE) {
            led[j] = s->mesh_error_percent[j];
            s->mesh_error_percent[j] = NAN;
        }
        count += isnan(s->mesh_error_percent[j]) && at[j] >= 0;
    }
    return count;
}

static int can_be_refined(const struct solution *solution)
{
    return solution->size <= MOST_FINE && (double)solution->size * (solution->model->equations.kd + 1) <= MOST_ENTRIES;
}

/* The lowest mode of a solution that none of the mesh before has the shape of; infinite: none. */
static double newcomer_hz(const struct solution *s, int count)
{
    for (int i = 0; i < count && s->same; i++)
        if (s->same[i] < 0)
            return s->hz[s->model->equations.nrigid + i];
    return INFINITY;
}

/* Leads the modes whose meshes are apart, or both too coarse for their waves, by finer and finer ones, until two of these agree
 * or the unknowns are too many. *missed: lowered to a mode that only the finer ones have. */
static int refine_apart(struct pool *pool, const struct task *task, const struct mesh_limit *limit, const struct solution *own,
                        struct spectrum *s, double *missed)
{
    struct solution before = *own;
    int status = ROTID_OK, *at = POOL_ARRAY(pool, int, s->count);
    double *led = POOL_ARRAY(pool, double, s->count);
    if (!at || !led)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < s->count; j++) {
        at[j] = j;
        led[j] = NAN;
    }
    for (int refine = limit->finer; !status && modes_to_lead(&before, at, s, led) && can_be_refined(&before);
         refine *= limit->finer) {
        struct solution finer = {0};
        int count = s->count;
        status = solve(pool, task, refine, &before, &count, &finer);
        for (int j = 0; j < s->count && !status; j++) {
            int partner = at[j] < 0 ? -1 : partner_from(&finer, count, at[j]);
            if (isnan(s->mesh_error_percent[j]) && at[j] >= 0) {
                led[j] = partner < 0 ? led[j] : NAN;
                if (lead(before.hz[s->nrigid + at[j]], &finer, partner, -1 - limit->finer_share, 1, s, j))
                    s->mesh_error_percent[j] = 100 * (own->hz[s->nrigid + j] / s->full_hz[j] - 1);
            }
            at[j] = partner;
        }
        if (!status)
            *missed = fmin(*missed, newcomer_hz(&finer, count));
        before = finer;
    }
    for (int j = 0; j < s->count; j++)
        if (isnan(s->mesh_error_percent[j]))
            s->mesh_error_percent[j] = led[j];
    return status;
}

static int compute(struct pool *pool, const struct task *task, int reduction, int count, int parts, struct spectrum *s)
{
    struct solution own = {0}, other = {0};
    double missed = INFINITY;
    int refine = parts & SPECTRUM_COARSE ? COARSE_MESH : 1;
    const struct mesh_limit limit = discrete_mesh_limit(models_discretisation(task->models), task->rotor);
    int meshed = parts & SPECTRUM_MESH, coarse_first = meshed && limit.refine == COARSE_MESH && refine != COARSE_MESH;
    int status = coarse_first ? solve(pool, task, limit.refine, NULL, &count, &other) : ROTID_OK;
    if (!status)
        status = solve(pool, task, refine, coarse_first ? &other : NULL, &count, &own);
    if (!status && meshed && !coarse_first)
        status = solve(pool, task, limit.refine, &own, &count, &other);
    if (status)
        return status;
    const rotid_model *equations = &own.model->equations;
    *s = (struct spectrum){.nrigid = equations->nrigid,
                           .count = count,
                           .nmaster = equations->nmaster,
                           .nnode = own.model->naxis,
                           .model = own.model,
                           .phi = own.phi + (ptrdiff_t)equations->nrigid * own.size,
                           .shape = own.shape,
                           .rigid_hz = own.hz};
    double **arrays[] = {&s->full_hz, &s->other_hz, &s->reduced_hz, &s->reduction_error_percent, &s->mesh_error_percent};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = POOL_ARRAY(pool, double, count);
    int alike = other.model && other.model->equations.nmaster == s->nmaster;
    s->other_shape = alike ? other.shape : NULL;
    s->master_z = POOL_ARRAY(pool, double, s->nmaster);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < s->nmaster; i++)
        s->master_z[i] = model_master_z(own.model, i);
    double passage = discrete_passage(&own.model->discrete);
    for (int j = 0; j < count; j++) {
        double hz = own.hz[s->nrigid + j];
        s->reduced_hz[j] = s->other_hz[j] = s->mesh_error_percent[j] = NAN;
        s->full_hz[j] = hz;
        if (!other.model)
            continue;
        int partner = coarse_first ? partner_of(&own, j) : partner_from(&other, count, j);
        s->other_hz[j] = other.hz[other.model->equations.nrigid + j];
        lead(hz, &other, partner, limit.share, limit.counts, s, j);
        /* elements along the axis of a solid with corners, and of members, are in both meshes, whose distance does not tell
         * (k h)^4/1440 */
        double *error = &s->mesh_error_percent[j], omega = TWO_PI * hz;
        double members = discrete_members_error(&own.model->discrete, s->phi + (ptrdiff_t)j * own.size, omega * omega);
        *error = copysign(limit.may_be_off * fabs(*error) + 100 * (pow(passage * omega, 4) / 1440 + members), *error);
    }
    if (limit.counts && coarse_first)
        status = refine_apart(pool, task, &limit, &own, s, &missed);
    if (status)
        return status;
    for (int j = count - 1; j >= 0 && coarse_first; j--)
        if (isnan(s->mesh_error_percent[j]) || missed < (1 - CROSSED) * s->full_hz[j] ||
            (j > 0 && s->full_hz[j] < (1 - CROSSED) * s->full_hz[j - 1]))
            s->apart = j + 1;
    /* what a condensation costs is seen on a coarse mesh as well */
    int on_other = alike && other.model->equations.n < equations->n;
    if (parts & (SPECTRUM_REDUCED | SPECTRUM_MASS) && s->nmaster <= MOST_MASTERS)
        status =
            condense(pool, on_other ? &other : &own, task->x, reduction, parts, on_other ? s->other_hz : own.hz + s->nrigid, s);
    for (int j = 0; j < count && !status; j++)
        s->reduction_error_percent[j] = 100 * (s->reduced_hz[j] / s->full_hz[j] - 1);
    return status;
}

int spectrum_compute_parts(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                           const struct parameter *parameter, const double *x, int reduction, int count, int parts,
                           struct spectrum *spectrum)
{
    const struct task task = {models, rotor, nparameter, parameter, x, WITHIN, NULL};
    return compute(pool, &task, reduction, count, parts, spectrum);
}

int job_spectrum(struct pool *pool, const struct job *job, const double *x, int count, int parts, struct spectrum *spectrum)
{
    int reduction = job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    return spectrum_compute_parts(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, x, reduction,
                                  count, parts, spectrum);
}

int spectrum_try(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                 const struct parameter *parameter, const double *x, int count, const struct spectrum *near,
                 struct spectrum *spectrum)
{
    const struct task task = {models, rotor, nparameter, parameter, x, ROUGH, near};
    return compute(pool, &task, ROTID_GUYAN, count, 0, spectrum);
}

double spectrum_correlation(const struct spectrum *s, const double *shape, int j, double *work)
{
    const double *mode = s->shape + (ptrdiff_t)j * s->nmaster;
    return s->mass ? rotid_nco(s->nmaster, s->mass, shape, mode, work) : rotid_mac(s->nmaster, shape, mode);
}

#define FIRST_PER_WAVE 8   /* elements for half a wave of the highest mode */
#define ROUNDS         4   /* the second one mostly ends it */
#define MARGIN         0.9 /* of h: what h^2 leaves out */

/* Elements no longer than h. Returns their number. */
static int divide(struct rotor *rotor, int count, const int *section, double h)
{
    int elements = 0;
    for (int i = 0; i < count; i++) {
        struct segment *s = &rotor->segment[section[i]];
        s->elements = (int)fmin(fmax(ceil(s->length / h - 1e-9), 1), MESH_CHOICE_LARGEST);
        elements += s->elements;
    }
    return elements;
}

/* The largest error of modes 1 to `mode`; NaN where there is no telling. */
static int mesh_error(struct pool *pool, const struct job *job, int mode, double *error)
{
    struct spectrum s;
    struct pool scratch;
    enum discretisation as = job->options.type == MODE_BENDING ? AS_BEAM : job_discretisation(job);
    *error = NAN;
    pool_open(&scratch, pool->allocator);
    int status = spectrum_compute_parts(&scratch, models_as(&scratch, as), &job->rotor, 0, NULL, NULL, ROTID_GUYAN, mode,
                                        SPECTRUM_MESH, &s);
    for (int j = 0; !status && j < s.count; j++)
        *error = fmax(isnan(*error) ? 0 : *error, fabs(s.mesh_error_percent[j]) / 100);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

int mesh_choose(struct pool *pool, struct job *job, int count, const int *section, struct mesh_choice *choice)
{
    const struct job_measurement *m = &job->measurement;
    double length = rotor_length(&job->rotor), free = 0, noise = INFINITY;
    *choice = (struct mesh_choice){.mode = m->nmode ? 1 : MESH_CHOICE_MODES};
    for (int k = 0; k < m->nmode; k++) {
        choice->mode = m->number[k] > choice->mode ? m->number[k] : choice->mode;
        noise = m->frequency_std[k] > 0 ? fmin(noise, m->frequency_std[k]) : noise;
    }
    for (int i = 0; i < count; i++)
        free += job->rotor.segment[section[i]].length;
    choice->is_noise_known = isfinite(noise);
    choice->wanted = choice->is_noise_known ? MESH_CHOICE_SHARE * noise : MESH_CHOICE_ERROR;
    double h = length / (FIRST_PER_WAVE * (choice->mode + 1)), least = free / MESH_CHOICE_LARGEST;
    for (int round = 0; round < ROUNDS; round++) {
        h = fmax(h, least);
        choice->elements = divide(&job->rotor, count, section, h);
        int status = mesh_error(pool, job, choice->mode, &choice->error);
        if (status)
            return status;
        if (!(choice->error > choice->wanted) || h <= least)
            break;
        h *= MARGIN * sqrt(choice->wanted / choice->error);
    }
    for (int i = 0; i < count; i++) {
        const struct segment *s = &job->rotor.segment[section[i]];
        choice->length_m = fmax(choice->length_m, s->length / s->elements);
    }
    return ROTID_OK;
}
