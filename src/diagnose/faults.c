/* Which channels are faulty, whatever the physics is. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "model/model.h"

#define LEAST_SENSORS 4
#define LEAST_MOVE    5e-4 /* m: nobody glues a sensor more closely than that */
#define SHIFTS        13   /* places of the grid, over a tenth of the length to either side */
#define REACH         0.12
#define SCALES        5
#define SCALE_STEP    0.05
#define MOST_SHIFT    0.15 /* of the length: a line that is off by more is measured anew */
#define MOST_SCALE    0.2
#define ITERATIONS    20
#define HALVINGS      12
#define STEP          1e-5 /* of the differences, over the length and 1 */
#define COST          12.0 /* of chi2 that each of flip, shift and scale has to gain: 3.5 standard deviations */

struct line_search {
    const struct shape_data *data;
    double length;
    int nrow;
    double *r, *moved, *jacobian; /* [nrow], [nrow], [2 nrow] */
};

/* What of flip, shift and scale is not neutral. */
static int line_parameters(const struct sensor_line *line)
{
    return line->flip + (line->shift != 0) + (line->scale != 1);
}

/* r [nrow] with every mode at its best scale; returns chi2, INFINITY where a sensor leaves the rotor. */
static double residual(const struct line_search *search, const struct sensor_line *line, double *r)
{
    const struct shape_data *data = search->data;
    double chi2 = 0;
    if (fabs(line->shift) > MOST_SHIFT * search->length || fabs(line->scale - 1) > MOST_SCALE ||
        !sensor_line_fits(line, search->length, data->nsensor, data->z))
        return INFINITY;
    for (int k = 0; k < data->nmode; k++) {
        double square = 0, product = 0, *own = r;
        for (int s = 0; s < data->nsensor; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * data->nsensor;
            double z = sensor_line_place(line, search->length, data->z[s]);
            if (!isfinite(data->shape[at]) || !isfinite(data->std[at]))
                continue;
            double p = shape_data_model(data, k, fmin(fmax(z, data->axis_z[0]), data->axis_z[data->naxis - 1])) / data->std[at];
            square += p * p;
            product += p * data->shape[at] / data->std[at];
            *r++ = p;
        }
        double a = square > 0 ? product / square : 0;
        for (int s = 0; s < data->nsensor; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * data->nsensor;
            if (!isfinite(data->shape[at]) || !isfinite(data->std[at]))
                continue;
            *own = a * *own - data->shape[at] / data->std[at];
            chi2 += *own * *own;
            own++;
        }
    }
    return chi2;
}

/* J'J and J'r over what is free, by differences. */
static void normal_equations(const struct line_search *search, const struct sensor_line *line, const int *free, double h[3],
                             double g[2])
{
    int n = search->nrow;
    h[0] = h[1] = h[2] = g[0] = g[1] = 0;
    for (int p = 0; p < 2; p++) {
        double *column = search->jacobian + (ptrdiff_t)p * n, step = p ? STEP : STEP * search->length;
        struct sensor_line other = *line;
        memset(column, 0, (size_t)n * sizeof *column);
        if (!free[p])
            continue;
        *(p ? &other.scale : &other.shift) += step;
        if (!isfinite(residual(search, &other, search->moved))) {
            *(p ? &other.scale : &other.shift) -= 2 * step;
            step = -step;
            if (!isfinite(residual(search, &other, search->moved)))
                continue;
        }
        for (int i = 0; i < n; i++)
            column[i] = (search->moved[i] - search->r[i]) / step;
    }
    for (int i = 0; i < n; i++) {
        double a = search->jacobian[i], b = search->jacobian[n + i];
        h[0] += a * a;
        h[1] += a * b;
        h[2] += b * b;
        g[0] += a * search->r[i];
        g[1] += b * search->r[i];
    }
}

/* The inverse of J'J over what is free, in the place of h; 0 where it has none. */
static int invert(const int *free, double h[3])
{
    double a = free[0] ? h[0] : 1, b = free[0] && free[1] ? h[1] : 0, c = free[1] ? h[2] : 1, det = a * c - b * b;
    if (!(det > 1e-12 * a * c))
        return 0;
    h[0] = c / det;
    h[1] = -b / det;
    h[2] = a / det;
    return 1;
}

/* Gauss-Newton with halved steps from *line; returns chi2. */
static double descend(const struct line_search *search, const int *free, struct line_fault *fault)
{
    struct sensor_line *line = &fault->line;
    double h[3], g[2], chi2 = residual(search, line, search->r);
    fault->shift_std = fault->scale_std = NAN;
    if (!free[0] && !free[1])
        return chi2;
    for (int i = 0; i < ITERATIONS; i++) {
        normal_equations(search, line, free, h, g);
        if (!invert(free, h))
            return INFINITY;
        double step[2] = {free[0] ? -(h[0] * g[0] + h[1] * g[1]) : 0, free[1] ? -(h[1] * g[0] + h[2] * g[1]) : 0}, least = chi2;
        struct sensor_line next = *line;
        for (int j = 0; j < HALVINGS && !(least < chi2); j++, step[0] /= 2, step[1] /= 2) {
            next = *line;
            next.shift += step[0];
            next.scale += step[1];
            least = residual(search, &next, search->moved);
        }
        if (!(least < chi2))
            break;
        double gained = chi2 - least;
        *line = next;
        chi2 = residual(search, line, search->r);
        if (gained < 1e-6 * chi2)
            break;
    }
    normal_equations(search, line, free, h, g);
    double spread = search->nrow > 2 ? sqrt(fmax(1, chi2 / (search->nrow - 2))) : 1;
    if (invert(free, h)) {
        fault->shift_std = free[0] ? spread * sqrt(h[0]) : NAN;
        fault->scale_std = free[1] ? spread * sqrt(h[2]) : NAN;
    }
    return chi2;
}

/* The best line of a flip with this freedom, from the best place of the grid. */
static double search_line(const struct line_search *search, int flip, const int *free, struct line_fault *fault)
{
    struct sensor_line best = {.flip = flip, .scale = 1};
    double least = residual(search, &best, search->r);
    for (int i = 0; i < (free[0] ? SHIFTS : 1); i++)
        for (int j = 0; j < (free[1] ? SCALES : 1); j++) {
            struct sensor_line one = {.flip = flip, .scale = free[1] ? 1 + SCALE_STEP * (j - (SCALES - 1) / 2.0) : 1};
            one.shift = free[0] ? REACH * search->length * (2.0 * i / (SHIFTS - 1) - 1) : 0;
            one.shift += free[0] ? (1 - one.scale) * search->length / 2 : 0; /* a scale about the middle */
            double chi2 = residual(search, &one, search->r);
            if (chi2 < least) {
                least = chi2;
                best = one;
            }
        }
    *fault = (struct line_fault){.line = best, .shift_std = NAN, .scale_std = NAN};
    return isfinite(least) ? descend(search, free, fault) : least;
}

static double largest_move(const struct shape_data *data, double length, const struct sensor_line *line)
{
    double move = 0;
    for (int s = 0; s < data->nsensor; s++)
        move = fmax(move, fabs(sensor_line_place(line, length, data->z[s]) - data->z[s]));
    return move;
}

int line_check(struct pool *pool, const struct shape_data *data, double length, struct line_fault *fault, int *found)
{
    struct line_search search = {.data = data, .length = length};
    size_t all = (size_t)data->nsensor * (size_t)data->nmode;
    const struct sensor_line stated = {.scale = 1};
    double best = INFINITY, left = 0;
    *found = 0;
    if (data->nsensor < LEAST_SENSORS || data->nmode < 1 || data->naxis < 2)
        return ROTID_OK;
    search.r = POOL_ARRAY(pool, double, 4 * all);
    if (!search.r)
        return ROTID_ERROR_MEMORY;
    search.moved = search.r + all;
    search.jacobian = search.moved + all;
    for (size_t i = 0; i < all; i++)
        search.nrow += isfinite(data->shape[i]) && isfinite(data->std[i]);
    double before = residual(&search, &stated, search.r);
    for (int flip = 0; flip < 2; flip++)
        for (int some = flip ? 0 : 1; some < 4; some++) {
            const int free[2] = {some & 1, some >> 1};
            struct line_fault one;
            double chi2 = search_line(&search, flip, free, &one), score = chi2 + COST * line_parameters(&one.line);
            if (score < best) {
                best = score;
                left = chi2;
                *fault = one;
            }
        }
    if (!isfinite(best))
        return ROTID_OK;
    const struct sensor_line turned = {.flip = 1, .scale = 1};
    double alone = fault->line.flip ? residual(&search, &turned, search.r) : INFINITY;
    if (before - alone > COST) { /* how long a line is, and where it begins, shows once it is the right way round */
        *fault = (struct line_fault){.line = turned, .shift_std = NAN, .scale_std = NAN};
        left = alone;
    }
    int own = line_parameters(&fault->line), dof = search.nrow - data->nmode - own;
    double dispersion = dof > 0 ? fmax(1, left / dof) : 1;
    fault->chi2_drop = before - left;
    *found = own && fault->chi2_drop > COST * own * dispersion && largest_move(data, length, &fault->line) >= LEAST_MOVE;
    return ROTID_OK;
}

static const char *const fault_id[] = {[FAULT_GAIN] = "sensor_gain",
                                       [FAULT_SIGN] = "sensor_sign",
                                       [FAULT_SWAP] = "sensor_swap",
                                       [FAULT_POSITION] = "sensor_position",
                                       [FAULT_DUPLICATE] = "duplicate_channel",
                                       [FAULT_DEAD] = "duplicate_channel"};

/* A negative gain is a wrong sign. */
static enum sensor_fault_kind kind_of(const struct sensor_fault *fault)
{
    return fault->kind == FAULT_GAIN && fault->value < 0 ? FAULT_SIGN : fault->kind;
}

static int has_value(enum sensor_fault_kind kind)
{
    return kind == FAULT_GAIN || kind == FAULT_POSITION;
}

static const char *describe(struct pool *pool, enum sensor_fault_kind kind, double value, const int *id)
{
    switch (kind) {
    case FAULT_GAIN:
        return pool_format(pool, "sensor %d reads %.3g times what it should; its components are divided by that", id[0], value);
    case FAULT_SIGN:
        return pool_format(pool, "sensor %d has the wrong sign; it is turned", id[0]);
    case FAULT_SWAP:
        return pool_format(pool, "sensors %d and %d are exchanged; they are put back", id[0], id[1]);
    case FAULT_POSITION:
        return pool_format(pool, "sensor %d sits %.3g mm further %s than stated; it is moved", id[0], 1e3 * fabs(value),
                           value > 0 ? "right" : "left");
    case FAULT_DUPLICATE:
        return pool_format(pool, "sensor %d records what sensor %d records; it is left out", id[0], id[1]);
    default:
        return pool_format(pool, "sensor %d is dead; it is left out", id[0]);
    }
}

/* id [nsensor]: of the sensors when the fault was found. ROTID_OK or ROTID_ERROR_MEMORY. */
static int fault_finding(struct pool *pool, const struct sensor_fault *fault, const int *id, rotid_data_finding *finding)
{
    enum sensor_fault_kind kind = kind_of(fault);
    int two = fault->other >= 0;
    *finding = (rotid_data_finding){.id = fault_id[kind],
                                    .nsensors = 1 + two,
                                    .sensors = POOL_ARRAY(pool, int, 2),
                                    .value = has_value(kind) ? fault->value : NAN,
                                    .std = fault->std,
                                    .chi2_drop = fault->chi2_drop};
    if (!finding->sensors)
        return ROTID_ERROR_MEMORY;
    finding->sensors[0] = id[fault->sensor];
    finding->sensors[1] = two ? id[fault->other] : 0;
    finding->text = describe(pool, kind, fault->value, finding->sensors);
    return finding->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* "sensor 7", "sensors 7,8"; NULL where memory is out. */
static const char *fault_target(struct pool *pool, const rotid_data_finding *finding)
{
    return !finding->nsensors      ? ""
           : finding->nsensors > 1 ? pool_format(pool, "sensors %d,%d", finding->sensors[0], finding->sensors[1])
                                   : pool_format(pool, "sensor %d", finding->sensors[0]);
}

/* Without a name; of a dead channel there is none: nothing could be put right. */
static struct correction fault_correction(const struct sensor_fault *fault, const int *id)
{
    enum sensor_fault_kind kind = kind_of(fault);
    int two = fault->other >= 0;
    return (struct correction){.id = fault_id[kind],
                               .nsensor = 1 + two,
                               .sensor = {id[fault->sensor], two ? id[fault->other] : 0},
                               .value = has_value(kind) ? fault->value : 1};
}

#define NORMAL_95 1.96

static rotid_cause_value sized(const char *name, const char *unit, double value, double std, double neutral)
{
    int as_stated = value == neutral && !isfinite(std);
    double half = as_stated ? NAN : NORMAL_95 * std;
    return (rotid_cause_value){name, unit, value, as_stated ? NAN : std, {value - half, value + half}, 0};
}

static int line_finding(struct pool *pool, const struct line_fault *fault, rotid_data_finding *finding)
{
    const struct sensor_line *line = &fault->line;
    *finding = (rotid_data_finding){.id = "sensor_line",
                                    .value = NAN,
                                    .std = NAN,
                                    .chi2_drop = fault->chi2_drop,
                                    .nparameters = 3,
                                    .parameters = POOL_ARRAY(pool, rotid_cause_value, 3)};
    if (!finding->parameters)
        return ROTID_ERROR_MEMORY;
    finding->parameters[0] = sized("shift", "m", line->shift, fault->shift_std, 0);
    finding->parameters[1] = sized("scale", "1", line->scale, fault->scale_std, 1);
    finding->parameters[2] = sized("flip", "1", line->flip, NAN, line->flip);
    const char *text =
        line->flip ? "the positions of all sensors count from the other end" : "the positions of all sensors are off";
    if (line->scale != 1)
        text =
            pool_format(pool, "%s, their distances are %.5g +- %.2g times the stated ones", text, line->scale, fault->scale_std);
    if (text && line->shift != 0)
        text = pool_format(pool, "%s, their origin is off by %+.3g +- %.2g mm", text, 1e3 * line->shift, 1e3 * fault->shift_std);
    finding->text = text ? pool_format(pool, "%s; all of them are moved", text) : NULL;
    return finding->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The same of all positions at once: the finding with its sizes, and the card. */
static struct correction line_correction(const struct sensor_line *line)
{
    return (struct correction){.id = "sensor_line", .value = line->shift, .more = {line->scale, line->flip}};
}

#define MOST_FAULTS   8
#define MOST_RIVALS   4 /* refits beside which the channels are looked at */
#define FALSE_ALARM   0.005
#define LEAST_SHIFT   5e-4                    /* m: nobody glues a sensor more closely than that */
#define FAULT_PENALTY (2 * PARAMETER_PENALTY) /* which sensor, and its value or its partner */

struct rival { /* an explanation of the data */
    const struct job *stated;
    const rotid_fit_result *fit; /* of that job */
    rotid_fit_result *right;     /* with the faults put right, NULL where there is none */
    double score;                /* with the faults put right */
    double chi2, chi2_frequency;
    int dof, nfault;
    struct sensor_fault fault[MOST_FAULTS]; /* indices of sensors are those of the data as they are judged */
    int has_line;                           /* all positions are put right, before single channels */
    struct line_fault line;
};

/* Shapes of the fitted model on the nodes of the axis, each times its best scale to the measured one. What is fitted of a solid
 * is the measured shape less what the coarse mesh misses, so channels that read the same differ there: `read` is as it was
 * measured. */
static int shape_data(struct pool *pool, const struct job *job, const struct columns *columns, struct shape_data *data)
{
    const struct rotor_model *model = &columns->model;
    const struct prediction *p = &columns->functional.prediction;
    int nsensor = job->rotor.nsensor, nmode = columns->nmode;
    double *z = POOL_ARRAY(pool, double, nsensor), *shape = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *std = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *read = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *axis = POOL_ARRAY(pool, double, (size_t)model->naxis *(size_t)nmode);
    if (!z || !shape || !std || !read || !axis)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        z[s] = job->rotor.sensor[s].position;
    for (int m = 0; m < nmode; m++) {
        const struct columns_mode *mode = &columns->mode[m];
        ptrdiff_t from = (ptrdiff_t)mode->k * nsensor, to = (ptrdiff_t)m * nsensor;
        memcpy(shape + to, columns->functional.shape + from, (size_t)nsensor * sizeof *shape);
        memcpy(std + to, job->measurement.shape_std + from, (size_t)nsensor * sizeof *std);
        memcpy(read + to, job->measurement.shape + from, (size_t)nsensor * sizeof *read);
        for (int i = 0; i < model->naxis; i++)
            axis[i + (ptrdiff_t)m * model->naxis] =
                mode->scale * model_deflection(model, i, p->phi + (ptrdiff_t)mode->pair * p->size);
    }
    *data = (struct shape_data){nsensor, nmode, z, shape, std, read, model->naxis, model->z, axis};
    return ROTID_OK;
}

/* Puts a fault right in the data of a job. id [nsensor]: of the sensors when the fault was found, since a moved sensor changes
 * their order. */
static int put_right(struct pool *pool, const struct sensor_fault *fault, const int *id, struct job *job)
{
    struct correction correction;
    if (fault->kind != FAULT_DEAD) {
        correction = fault_correction(fault, id);
        return correction_apply(pool, job, &correction);
    }
    for (int s = 0; s < job->rotor.nsensor; s++) /* as if it had not been there */
        for (int k = 0; k < job->measurement.nmode && job->rotor.sensor[s].id == id[fault->sensor]; k++)
            job->measurement.shape[s + (ptrdiff_t)k * job->rotor.nsensor] = NAN;
    return ROTID_OK;
}

/* A copy of the job with all positions put right, where the rival says so, and the numbers of the modes by the shapes as they
 * stand then. */
static int put_line_right(struct engine *engine, const struct rival *rival, const double *x, struct job *job, int **number)
{
    struct spectrum spectrum;
    struct comparison compared;
    struct message_list quiet;
    *job = *rival->stated;
    *number = engine->number;
    int status = data_copy(engine->pool, job);
    if (status || !rival->has_line)
        return status;
    const struct correction correction = line_correction(&rival->line.line);
    status = correction_apply(engine->pool, job, &correction);
    message_open(&quiet, engine->pool);
    if (!status)
        status = spectrum_compute_parts(engine->pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter,
                                        x, ROTID_GUYAN, comparison_candidates(job), SPECTRUM_REDUCED, &spectrum);
    if (!status && !comparison_make(engine->pool, job, &spectrum, &quiet, &compared))
        *number = compared.number;
    return status;
}

/* The line that the shapes as they stand show beside the model of a rival at x. */
static int look_for_line(struct engine *engine, const double *x, const int *number, struct rival *rival)
{
    const struct job *job = rival->stated;
    struct columns columns;
    struct shape_data data;
    for (int i = 0; i < job->measurement.ncorrection; i++) { /* once: what is left is not of the positions */
        const struct correction *c = &job->measurement.correction[i];
        if (same_text(c->id, "sensor_line") && (c->value != 0 || c->more[0] != 1))
            return ROTID_OK;
    }
    int status = columns_open(engine->pool, job, number, engine->holdout, NULL, x, &columns);
    if (!status)
        status = shape_data(engine->pool, job, &columns, &data);
    return status ? status : line_check(engine->pool, &data, rotor_length(&job->rotor), &rival->line, &rival->has_line);
}

/* The faults of channels that show beside the model of a rival at x. */
static int look(struct engine *engine, const double *x, const int *id, struct rival *rival)
{
    struct columns columns;
    struct shape_data data;
    struct job job;
    int found = 0, *number, status = put_line_right(engine, rival, x, &job, &number);
    if (!status)
        status = columns_open(engine->pool, &job, number, engine->holdout, NULL, x, &columns);
    if (!status)
        status = shape_data(engine->pool, &job, &columns, &data);
    if (!status)
        status = sensor_check(engine->pool, &data, FALSE_ALARM, MOST_FAULTS, rival->fault, &found);
    rival->nfault = 0;
    for (int i = 0; i < found && !status; i++) {
        struct sensor_fault fault = rival->fault[i];
        if (fault.kind == FAULT_POSITION && fabs(fault.value) < LEAST_SHIFT)
            continue;
        for (int s = engine->job->rotor.nsensor - 1, one = fault.sensor, two = fault.other; s >= 0; s--) {
            fault.sensor = id[s] == job.rotor.sensor[one].id ? s : fault.sensor;
            fault.other = two >= 0 && id[s] == job.rotor.sensor[two].id ? s : fault.other;
        }
        rival->fault[rival->nfault++] = fault;
    }
    return status;
}

/* The fit of a rival with its faults put right; NULL where there is none. */
static int fit_right(struct engine *engine, const int *id, const struct rival *rival, rotid_fit_result **fit)
{
    struct job job;
    int *number, status = put_line_right(engine, rival, rival->fit->x, &job, &number);
    for (int i = 0; i < rival->nfault && !status; i++)
        status = put_right(engine->pool, &rival->fault[i], id, &job);
    if (!status)
        status = refit_job(engine->pool, &job, number, engine->holdout, engine->environment, fit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The score of a rival with its faults put right. Components that a fault takes away count as what they would leave. */
static int weigh(struct engine *engine, const int *id, struct rival *rival)
{
    const rotid_fit_result *best = rival->fit;
    int nfrequency = 0, status = ROTID_OK;
    rotid_fit_free(rival->right);
    rival->right = NULL;
    rival->score = INFINITY;
    if (rival->nfault || rival->has_line) {
        status = fit_right(engine, id, rival, &rival->right);
        best = rival->right;
    }
    if (status || !best)
        return status;
    for (int k = 0; k < engine->job->measurement.nmode; k++)
        nfrequency += !engine->holdout[k];
    rival->dof = best->dof;
    rival->chi2 = best->chi2 + (rival->fit->nresidual - best->nresidual);
    rival->chi2_frequency = 0;
    for (int i = 0; i < nfrequency; i++)
        rival->chi2_frequency += best->r[i] * best->r[i];
    rival->score = rival->chi2 + PARAMETER_PENALTY * (best->n - engine->job->unknowns.nparameter) + FAULT_PENALTY * rival->nfault;
    rival->score += rival->has_line ? PARAMETER_PENALTY * line_parameters(&rival->line.line) : 0;
    return ROTID_OK;
}

/* The faults have spoilt the fit beside which they were found: once more beside the one without them. */
static int look_again(struct engine *engine, const int *id, struct rival *rival)
{
    struct job job;
    int *number, status = ROTID_OK;
    if (!rival->right)
        return ROTID_OK;
    if (rival->has_line) {
        status = put_line_right(engine, rival, rival->right->x, &job, &number);
        if (!status)
            status = look_for_line(engine, rival->right->x, number, rival);
    }
    if (!status)
        status = look(engine, rival->right->x, id, rival);
    return status ? status : weigh(engine, id, rival);
}

/* The highest score within the margin of a name; where nothing explains the data, every rival has a say: what the model lacks
 * then looks like faults beside one model, and otherwise beside the next. */
static double find_limit(int count, const struct rival *rival, int *best)
{
    *best = 0;
    for (int i = 1; i < count; i++)
        *best = rival[i].score < rival[*best].score ? i : *best;
    const struct rival *r = &rival[*best];
    return chi_square_tail(r->chi2, r->dof) < 0.01 ? (double)INFINITY : r->score + LEAST_MARGIN;
}

static int same(const struct sensor_fault *a, const struct sensor_fault *b)
{
    return a->kind == b->kind &&
           ((a->sensor == b->sensor && a->other == b->other) || (a->sensor == b->other && a->other == b->sensor));
}

static int has(const struct rival *rival, const struct sensor_fault *fault)
{
    int found = 0;
    for (int i = 0; i < rival->nfault; i++)
        found |= same(&rival->fault[i], fault);
    return found;
}

/* The refits to ask, best first, behind the model without a cause. */
static int choose(const struct engine *engine, const struct round_result *result, struct rival *rival)
{
    int count = 1, taken[MOST_RIVALS];
    rival[0] = (struct rival){.stated = engine->job, .fit = engine->fit};
    while (count <= MOST_RIVALS) {
        int best = -1;
        for (int i = 0; i < result->nrefit; i++) {
            int used = !result->refit[i].fit;
            for (int j = 0; j + 1 < count; j++)
                used |= taken[j] == i;
            if (!used && (best < 0 || result->refit[i].chi2 < result->refit[best].chi2))
                best = i;
        }
        if (best < 0)
            break;
        taken[count - 1] = best;
        rival[count++] = (struct rival){.stated = &result->refit[best].states.state->job, .fit = result->refit[best].fit};
    }
    return count;
}

/* Takes a fault out of the judged data. */
static int correct(struct engine *engine, const struct sensor_fault *fault, const int *id)
{
    rotid_data_finding finding;
    int status = fault_finding(engine->pool, fault, id, &finding);
    if (status)
        return status;
    if (fault->kind == FAULT_DEAD) {
        status = put_right(engine->pool, fault, id, engine->job);
        return status ? status : data_add_finding(engine, &finding);
    }
    const struct correction correction = fault_correction(fault, id);
    return data_correct(engine, &finding, &correction);
}

/* A fault that no more than the margin separates from a physical cause stays open with it, as one more explanation. */
static int keep_open(struct engine *engine, const struct rival *base, const int *id, struct round_result *result)
{
    rotid_data_finding finding;
    int status = base->has_line ? line_finding(engine->pool, &base->line, &finding)
                                : fault_finding(engine->pool, &base->fault[0], id, &finding),
        line = base->has_line ? line_parameters(&base->line.line) : 0;
    result->fault = POOL_NEW(engine->pool, struct candidate);
    if (status || !result->fault)
        return ROTID_ERROR_MEMORY;
    *result->fault = candidate_blank(catalogue_find(finding.id), fault_target(engine->pool, &finding));
    result->fault->nparameter = 2 * base->nfault + line;
    for (int p = 0; p < 3; p++)
        result->fault->effect.value[p] = base->has_line ? finding.parameters[p].value : finding.value;
    result->fault->result.refitted = 1;
    result->fault->result.chi2 = base->chi2;
    result->fault->result.chi2_drop = result->fault->result.predicted_drop = engine->fit->chi2 - base->chi2;
    result->fault->result.chi2_frequency = base->chi2_frequency;
    return result->fault->target ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Each rival once more with the line that it finds, in the place of the channels, behind the others. */
static void add_lines(int *count, struct rival *rival)
{
    for (int i = 0, stated = *count; i < stated; i++) {
        if (!rival[i].has_line)
            continue;
        rival[*count] = rival[i];
        rival[(*count)++].nfault = 0;
        rival[i].has_line = 0;
    }
}

/* Beside one model the line and single channels explain the same shapes: the line stays where it leads by the margin of a name,
 * else it goes. */
static void choose_line(int stated, int *count, struct rival *rival)
{
    int kept = stated;
    for (int j = stated; j < *count; j++) {
        int own = 0;
        while (own < stated && rival[own].fit != rival[j].fit)
            own++;
        if (own < stated && rival[j].score + LEAST_MARGIN < rival[own].score) {
            rotid_fit_free(rival[own].right);
            rival[own] = rival[j];
        } else {
            rotid_fit_free(rival[j].right);
        }
        rival[j].right = NULL;
    }
    *count = kept;
}

/* Takes the line out where it leaves a model that explains the data, and every rival within the margin of a name has it. Beside a
 * model that is grossly wrong a shift or another scale of all positions lowers chi2, too. *changed then. */
static int settle_line(struct engine *engine, int count, const struct rival *rival, int best, int *changed)
{
    rotid_data_finding finding;
    double limit = rival[best].score + LEAST_MARGIN;
    if (chi_square_tail(rival[best].chi2, rival[best].dof) < 0.01)
        return ROTID_OK;
    for (int i = 0; i < count; i++)
        if (rival[i].score <= limit && !(rival[i].has_line && rival[i].line.line.flip == rival[best].line.line.flip))
            return ROTID_OK;
    const struct correction correction = line_correction(&rival[best].line.line);
    int status = line_finding(engine->pool, &rival[best].line, &finding);
    *changed = 1;
    return status ? status : data_correct(engine, &finding, &correction);
}

static int settle(struct engine *engine, int count, struct rival *rival, struct round_result *result, int *changed)
{
    int best, any = 0, stated = count, status = ROTID_OK, nsensor = engine->job->rotor.nsensor;
    int *id = POOL_ARRAY(engine->pool, int, nsensor);
    if (!id)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        id[s] = engine->job->rotor.sensor[s].id;
    for (int i = 0; i < count && !status; i++) {
        status = look(engine, rival[i].fit->x, id, &rival[i]);
        if (!status)
            status = look_for_line(engine, rival[i].fit->x, engine->number, &rival[i]);
        any |= rival[i].nfault || rival[i].has_line;
    }
    if (status || !any)
        return status;
    add_lines(&count, rival);
    for (int i = 0; i < count && !status; i++)
        status = weigh(engine, id, &rival[i]);
    for (int i = stated; i < count && !status; i++)
        status = look_again(engine, id, &rival[i]);
    choose_line(stated, &count, rival);
    if (status)
        return status;
    double limit = find_limit(count, rival, &best);
    for (int i = 0; i < count && !status; i++)
        if (rival[i].score <= limit)
            status = look_again(engine, id, &rival[i]);
    limit = find_limit(count, rival, &best);
    if (!status && rival[best].has_line)
        status = settle_line(engine, count, rival, best, changed);
    for (int f = 0; f < rival[best].nfault && !status && !*changed; f++) {
        int all = 1;
        for (int i = 0; i < count; i++)
            all &= rival[i].score > limit || has(&rival[i], &rival[best].fault[f]);
        if (all) {
            status = correct(engine, &rival[best].fault[f], id);
            rival[best].fault[f].sensor = -1; /* put right */
        }
    }
    for (int f = 0; f < rival[best].nfault; f++)
        *changed |= rival[best].fault[f].sensor < 0;
    if (!status && !*changed && (rival[0].nfault || (rival[0].has_line && isfinite(limit))) && rival[0].score <= limit)
        status = keep_open(engine, &rival[0], id, result);
    return status;
}

int faults_settle(struct engine *engine, struct round_result *result, int *changed)
{
    struct rival rival[2 * (MOST_RIVALS + 1)] = {0};
    *changed = 0;
    if (!job_fits_shapes(engine->job))
        return ROTID_OK;
    int count = choose(engine, result, rival), status = settle(engine, count, rival, result, changed);
    for (int i = 0; i < 2 * (MOST_RIVALS + 1); i++)
        rotid_fit_free(rival[i].right);
    return status;
}
