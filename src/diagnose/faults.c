/* Faults of the measurement chain as explanations: they act on the prediction, beside physical causes and something else.
 *
 *   gain, sign   sensor s reads g times the deflection; sign: g = -1
 *   position     it sits `shift` further right; line: all of them, at shift + scale z, from the other end where `flip`
 *   swap         two channels read each other's place
 *   copy, dead   sensor s reads what sensor t reads, y_s ~ N(y_t, t^2), or nothing of the rotor, y_s ~ N(0, t^2), t log-uniform:
 *                its readings are explained whatever the model is (`outside`), and go out of the rest
 *
 * With u the predicted shape over its noise at the rows of a fit, Q what is fitted and r the residual behind it, every fault is a
 * column c (u, -2u, du/dz, ...): it lowers chi2 by (c'r)^2/|c_perp|^2, or by 2 a c'r - a^2 |c_perp|^2 at a fixed amplitude a; a
 * row that goes out of the data takes its part r_R'M^-1 r_R with it, M = I - Q_R Q_R'. What promises most is put right in the
 * data (correction_apply, which leaves the likelihood that of a prediction with the fault in it), fitted, and weighed by
 * laplace.c with its numbers as unknowns. */
#include "diagnose/diagnose.h"

#define LEAST_SENSORS 5    /* fewer cannot tell a channel from the rotor */
#define LEAST_COPY    1e-6 /* of the noise: the last digit of a reading, */
#define MOST_COPY     1.0  /* and where a copy is none */
#define POINTS        32   /* of a log-uniform deviation */
#define STEPS         4    /* of Gauss-Newton in the numbers of a fault */
#define STEP_DONE     0.1  /* standard deviations */
#define PLACES        64   /* of a sensor that is far from where it is stated */
#define DIFFERENCE    1e-3 /* of the length: step of a slope */
#define LEAST_SHIFT   5e-4 /* m: nobody glues a sensor more closely than that */
#define NORMAL_95     1.96

/* ---- the readings of a state beside a fit */

struct shape_data { /* deflections of a model along the axis */
    int naxis;
    const double *axis_z;     /* [naxis] nodes of the model, increasing [m] */
    const double *axis_shape; /* [naxis * nmode] deflection of the model's modes there */
};

struct channels {
    const struct states *states;
    const struct evidence_data *d;
    int state, nsensor, nblock, first; /* its blocks */
    int *row;                          /* [nsensor * nblock] of a reading, -1: none */
    double *u, *slope;                 /* [nrow] u, du/dz */
    struct shape_data data;
    int *mode; /* [nblock] of data */
};

/* Shapes of the fitted model on the nodes of the axis, each times its best scale to the measured one. */
static int axis_shapes(struct pool *pool, const struct columns *columns, struct shape_data *data)
{
    const struct rotor_model *model = &columns->model;
    const struct prediction *p = &columns->functional.prediction;
    double *axis = POOL_ARRAY(pool, double, (size_t)model->naxis *(size_t)columns->nmode);
    if (!axis)
        return ROTID_ERROR_MEMORY;
    for (int m = 0; m < columns->nmode; m++)
        for (int i = 0; i < model->naxis; i++)
            axis[i + (ptrdiff_t)m * model->naxis] =
                columns->mode[m].scale * model_deflection(model, i, p->phi + (ptrdiff_t)columns->mode[m].pair * p->size);
    *data = (struct shape_data){model->naxis, model->z, axis};
    return ROTID_OK;
}

/* Mode m of the model at z [m], which a place beyond its nodes is taken to the end of; cubic between the nodes (Lagrange, on the
 * four around z). */
static double deflection(const struct shape_data *data, int m, double z)
{
    const double *x = data->axis_z, *y = data->axis_shape + (ptrdiff_t)m * data->naxis;
    int low = 0, high = data->naxis - 1, points = data->naxis < 4 ? data->naxis : 4;
    double sum = 0;
    z = fmin(fmax(z, x[0]), x[high]);
    while (high - low > 1) {
        int mid = (low + high) / 2;
        if (x[mid] <= z)
            low = mid;
        else
            high = mid;
    }
    int first = low - 1 > 0 ? low - 1 : 0;
    if (first + points > data->naxis)
        first = data->naxis - points;
    for (int i = first; i < first + points; i++) {
        double product = y[i];
        for (int j = first; j < first + points; j++)
            if (j != i)
                product *= (z - x[j]) / (x[i] - x[j]);
        sum += product;
    }
    return sum;
}

/* number, holdout: of the modes of all states. *out has no sensors where the shapes of the state are not fitted. */
static int open_channels(struct pool *pool, const struct states *states, int state, const int *number, const int *holdout,
                         const rotid_fit_result *fit, const struct evidence_data *d, struct channels *out)
{
    const struct job *job = &states->state[state].job;
    int n = job->rotor.nsensor, mode = states_modes(states, state);
    struct columns columns;
    double length = rotor_length(&job->rotor), *x = state_values(pool, &states->state[state], fit->x);
    *out = (struct channels){.states = states, .d = d, .state = state};
    while (out->first < d->nblock && d->block[out->first].state != state)
        out->first++;
    while (out->first + out->nblock < d->nblock && d->block[out->first + out->nblock].state == state)
        out->nblock++;
    if (!out->nblock)
        return ROTID_OK;
    out->row = POOL_ARRAY(pool, int, (size_t)n *(size_t)out->nblock);
    out->u = POOL_ARRAY(pool, double, 2 * (size_t)d->nrow);
    out->mode = POOL_ARRAY(pool, int, out->nblock);
    int status = x && out->row && out->u && out->mode ? columns_open(pool, job, number + mode, holdout + mode, NULL, x, &columns)
                                                      : ROTID_ERROR_MEMORY;
    if (!status)
        status = axis_shapes(pool, &columns, &out->data);
    if (status)
        return status;
    out->nsensor = n;
    out->slope = out->u + d->nrow;
    for (int i = 0; i < n * out->nblock; i++)
        out->row[i] = -1;
    for (int b = 0; b < out->nblock; b++) {
        const struct evidence_block *block = &d->block[out->first + b];
        int m = 0;
        while (m + 1 < columns.nmode && columns.mode[m].k != block->mode)
            m++;
        out->mode[b] = m;
        for (int i = 0; i < block->count; i++) {
            int row = block->row + i, s = block->sensor[i];
            double z = job->rotor.sensor[s].position, h = DIFFERENCE * length;
            out->row[s + (ptrdiff_t)b * n] = row;
            out->u[row] = fit->r[row] + d->measured[row];
            out->slope[row] = (deflection(&out->data, m, z + h) - deflection(&out->data, m, z - h)) / (2 * h) / d->noise[row];
        }
    }
    return ROTID_OK;
}

/* ---- what promises */

struct column { /* a sparse one */
    int count;
    int row[2 * FAULT_MOST_MODES];
    double value[2 * FAULT_MOST_MODES];
};

static void add_row(struct column *c, int row, double value)
{
    c->row[c->count] = row;
    c->value[c->count++] = value;
}

/* |c_perp|^2, and *along = c'r. */
static double project(const struct scan *scan, const struct column *c, double *along)
{
    double square = 0;
    *along = 0;
    for (int i = 0; i < c->count; i++) {
        square += c->value[i] * c->value[i];
        *along += c->value[i] * scan->r[c->row[i]];
    }
    for (int b = 0; b < scan->nbasis; b++) {
        const double *q = scan->basis + (ptrdiff_t)b * scan->nrow;
        double part = 0;
        for (int i = 0; i < c->count; i++)
            part += q[c->row[i]] * c->value[i];
        square -= part * part;
    }
    return fmax(square, 0);
}

/* Gain of ln Z by a column whose amplitude is normal of this deviation; *amplitude at the best. */
static double gain_of_size(const struct scan *scan, const struct column *c, double deviation, double *amplitude)
{
    double along, square = project(scan, c, &along);
    *amplitude = -along / (square + 1 / (deviation * deviation));
    return -along * *amplitude / 2 - log1p(square * deviation * deviation) / 2;
}

static double gain_of_fixed(const struct scan *scan, const struct column *c)
{
    double along, square = project(scan, c, &along);
    return -along - square / 2;
}

/* Gain of ln Z where the rows of sensor s are explained without the model. */
static double gain_without(struct pool *pool, const struct scan *scan, const struct column *c)
{
    int m = c->count;
    double *a = POOL_ARRAY(pool, double, (size_t)m *(size_t)m), drop = 0, determinant;
    if (!a)
        return -INFINITY;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) {
            double sum = i == j;
            for (int b = 0; b < scan->nbasis; b++)
                sum -= scan->basis[c->row[i] + (ptrdiff_t)b * scan->nrow] * scan->basis[c->row[j] + (ptrdiff_t)b * scan->nrow];
            a[i + (ptrdiff_t)j * m] = sum + (i == j) * 1e-9;
        }
    if (positive_invert(m, a, &determinant))
        return -INFINITY;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++)
            drop += scan->r[c->row[i]] * a[i + (ptrdiff_t)j * m] * scan->r[c->row[j]];
    return (drop - determinant) / 2;
}

/* ln of the likelihood of differences [n] over the noise whose deviation is log-uniform from `least` to `most` times the noise.
 */
static double log_scatter(int n, const double *x, double least, double most)
{
    double square = 0, sum = -INFINITY;
    for (int i = 0; i < n; i++)
        square += x[i] * x[i];
    for (int j = 0; j < POINTS; j++) {
        double t = least * pow(most / least, (j + 0.5) / POINTS);
        sum = log_sum(sum, -square / (2 * t * t) - n * log(t));
    }
    return sum - log(POINTS);
}

struct fault_list {
    struct pool *pool;
    const struct channels *channels;
    const struct scan *scan;
    int most, count;
    struct fault_proposal *item;
};

/* The best `most` stay. */
static int offer(struct fault_list *list, const char *id, int s, int t, const double *value, const int *fixed, double outside,
                 double gain)
{
    const struct channels *c = list->channels;
    const struct sensor *sensor = c->states->state[c->state].job.rotor.sensor;
    const struct cause_kind *cause = catalogue_find(id);
    int one = s < 0 ? 0 : sensor[s].id, two = t < 0 ? 0 : sensor[t].id;
    if (!isfinite(gain) || (list->count == list->most && gain <= list->item[list->most - 1].gain))
        return ROTID_OK;
    const char *target = !one  ? ""
                         : two ? pool_format(list->pool, "sensors %d,%d", one, two)
                               : pool_format(list->pool, "sensor %d", one);
    if (!target)
        return ROTID_ERROR_MEMORY;
    list->count += list->count < list->most;
    int at = list->count - 1;
    for (; at > 0 && list->item[at - 1].gain < gain; at--)
        list->item[at] = list->item[at - 1];
    struct candidate *made = &list->item[at].fault;
    list->item[at] = (struct fault_proposal){candidate_blank(cause, target), gain, outside};
    made->home = c->state;
    made->state = c->states->nstate > 1 ? c->state : -1;
    made->state_name = c->states->state[c->state].name;
    made->sensor[0] = one;
    made->sensor[1] = two;
    for (int p = 0; value && correction_parameter(cause, p); p++, made->nparameter++) {
        made->effect.value[p] = value[p];
        made->fixed[p] = fixed && fixed[p];
    }
    return ROTID_OK;
}

/* The rows of sensor s with a column of the state, times a factor. */
static struct column of_sensor(const struct channels *c, int s, const double *values, double factor)
{
    struct column out = {0};
    for (int b = 0; b < c->nblock && b < FAULT_MOST_MODES; b++)
        if (c->row[s + (ptrdiff_t)b * c->nsensor] >= 0)
            add_row(&out, c->row[s + (ptrdiff_t)b * c->nsensor], factor * values[c->row[s + (ptrdiff_t)b * c->nsensor]]);
    return out;
}

/* What sensor s would read more at z than where it is stated. */
static struct column of_place(const struct channels *c, int s, double z)
{
    double stated = c->states->state[c->state].job.rotor.sensor[s].position;
    struct column out = {0};
    for (int b = 0; b < c->nblock && b < FAULT_MOST_MODES; b++) {
        int row = c->row[s + (ptrdiff_t)b * c->nsensor];
        if (row >= 0)
            add_row(&out, row,
                    (deflection(&c->data, c->mode[b], z) - deflection(&c->data, c->mode[b], stated)) / c->d->noise[row]);
    }
    return out;
}

/* Along its slope, or at the place of a grid that promises most: far from where it is stated a slope leads nowhere. */
static int offer_position(struct fault_list *list, int s)
{
    const struct channels *c = list->channels;
    const struct rotor *rotor = &c->states->state[c->state].job.rotor;
    struct column slope = of_sensor(c, s, c->slope, 1);
    const struct cause_parameter *prior = catalogue_find("sensor_position")->parameter;
    double length = rotor_length(rotor), deviation = length * prior->scale, shift, along,
           gross = log(prior->gross * prior->scale), best = gain_of_size(list->scan, &slope, deviation, &shift),
           width = log1p(project(list->scan, &slope, &along) * deviation * deviation) / 2;
    for (int i = 0; i <= PLACES; i++) {
        double there = length * i / PLACES - rotor->sensor[s].position;
        struct column at = of_place(c, s, length * i / PLACES);
        double gain = gain_of_fixed(list->scan, &at) + fmax(-there * there / (2 * deviation * deviation), gross) - width;
        if (gain > best) {
            best = gain;
            shift = there;
        }
    }
    return fabs(shift) > LEAST_SHIFT ? offer(list, "sensor_position", s, -1, &shift, NULL, 0, best) : ROTID_OK;
}

static int offer_single(struct fault_list *list, int s)
{
    const struct channels *c = list->channels;
    const struct evidence_data *d = c->d;
    double amplitude, rms = 0, reading[FAULT_MOST_MODES], gain_deviation = catalogue_find("sensor_gain")->parameter[0].scale;
    struct column own = of_sensor(c, s, c->u, 1), turned = of_sensor(c, s, c->u, -2);
    if (!own.count)
        return ROTID_OK;
    (void)gain_of_size(list->scan, &own, 10, &amplitude);
    double factor = 1 + amplitude, along, square = project(list->scan, &own, &along);
    int status = ROTID_OK;
    if (factor > 0.01) { /* normal in ln of the gain */
        double off = log(factor) / gain_deviation, spread = square * factor * factor * gain_deviation * gain_deviation,
               gain = along * along / (2 * square) - off * off / 2 - log1p(spread) / 2;
        status = offer(list, "sensor_gain", s, -1, &factor, NULL, 0, gain);
    }
    if (!status)
        status = offer(list, "sensor_sign", s, -1, NULL, NULL, 0, gain_of_fixed(list->scan, &turned));
    if (!status)
        status = offer_position(list, s);
    double without = gain_without(list->pool, list->scan, &own);
    for (int i = 0; i < own.count; i++)
        reading[i] = d->measured[own.row[i]];
    for (int i = c->first; i < c->first + c->nblock; i++)
        rms = fmax(rms, largest_magnitude(d->block[i].count, d->measured + d->block[i].row));
    double outside = log_scatter(own.count, reading, 1, fmax(2, rms));
    if (!status)
        status = offer(list, "duplicate_channel", s, -1, NULL, NULL, outside, without + outside);
    for (int t = 0; t < c->nsensor && !status; t++) { /* a copy of t, and nothing of the rotor where t has no reading */
        double apart[FAULT_MOST_MODES], most_apart = 0;
        int count = 0, alone = 0;
        for (int b = 0; b < c->nblock && b < FAULT_MOST_MODES; b++) {
            int mine = c->row[s + (ptrdiff_t)b * c->nsensor], other = c->row[t + (ptrdiff_t)b * c->nsensor];
            if (mine >= 0 && other < 0)
                reading[alone++] = d->measured[mine];
            if (mine < 0 || other < 0)
                continue;
            apart[count] = d->measured[mine] - d->measured[other] * d->noise[other] / d->noise[mine];
            most_apart = fmax(most_apart, fabs(apart[count++]));
        }
        if (t == s || !count || (alone && count < 2) || most_apart > MOST_COPY)
            continue;
        outside = log_scatter(count, apart, LEAST_COPY, MOST_COPY) + (alone ? log_scatter(alone, reading, 1, fmax(2, rms)) : 0);
        status = offer(list, "duplicate_channel", s, t, NULL, NULL, outside, without + outside);
    }
    return status;
}

/* Sensors s and t read each other's place. */
static int offer_swap(struct fault_list *list, int s, int t)
{
    const struct channels *c = list->channels;
    struct column both = {0};
    for (int b = 0; b < c->nblock && b < FAULT_MOST_MODES; b++) {
        int one = c->row[s + (ptrdiff_t)b * c->nsensor], two = c->row[t + (ptrdiff_t)b * c->nsensor];
        if (one < 0 || two < 0) /* the fit sees it there */
            continue;
        double ratio = c->d->noise[two] / c->d->noise[one];
        add_row(&both, one, c->u[two] * ratio - c->u[one]);
        add_row(&both, two, c->u[one] / ratio - c->u[two]);
    }
    return both.count ? offer(list, "sensor_swap", s, t, NULL, NULL, 0, gain_of_fixed(list->scan, &both)) : ROTID_OK;
}

/* One line of all positions: shift, scale or both free; which of them are as stated says `fixed`. */
static int offer_line_with(struct fault_list *list, const double h[3], const double g[2], double shift, double scale)
{
    int moved = shift > 0, stretched = scale > 0; /* what is free; the other one has a row of the unit matrix */
    double a = moved ? h[0] + 1 / (shift * shift) : 1, b = moved && stretched ? h[1] : 0,
           e = stretched ? h[2] + 1 / (scale * scale) : 1, det = a * e - b * b, one = moved ? g[0] : 0,
           two = stretched ? g[1] : 0, value[3] = {-(e * one - b * two) / det, 1 - (a * two - b * one) / det, 0},
           gain = -(one * value[0] + two * (value[1] - 1)) / 2 -
                  log(det * (moved ? shift * shift : 1) * (stretched ? scale * scale : 1)) / 2;
    if (fabs(value[0]) + fabs(value[1] - 1) * rotor_length(&list->channels->states->state->job.rotor) < LEAST_SHIFT)
        return ROTID_OK;
    return offer(list, "sensor_line", -1, -1, value, (const int[]){!moved, !stretched, 1}, 0, gain);
}

/* All positions: chi2 with the line as it is linearised, and counted from the other end. Scales of the modes are free. */
static int offer_line(struct fault_list *list)
{
    const struct channels *c = list->channels;
    const struct job *job = &c->states->state[c->state].job;
    const struct evidence_data *d = c->d;
    double h[3] = {0}, g[2] = {0};
    const struct cause_parameter *prior = catalogue_find("sensor_line")->parameter;
    double *column = POOL_ARRAY(list->pool, double, 2 * (size_t)d->nrow);
    if (!column)
        return ROTID_ERROR_MEMORY;
    memset(column, 0, 2 * (size_t)d->nrow * sizeof *column);
    for (int b = c->first; b < c->first + c->nblock; b++) {
        for (int i = 0; i < d->block[b].count; i++) {
            int row = d->block[b].row + i;
            column[row] = c->slope[row];
            column[row + d->nrow] = c->slope[row] * job->rotor.sensor[d->block[b].sensor[i]].position;
        }
    }
    /* no line leads from the model that was fitted to positions from the wrong end: all that there is to gain */
    double gain = (list->scan->chi2 - list->scan->dof) / 2;
    int status = offer(list, "sensor_line", -1, -1, (const double[]){0, 1, 1}, (const int[]){1, 1, 1}, 0, gain);
    for (int b = 0; b < 2 * list->scan->nbasis; b++) { /* twice */
        const double *q = list->scan->basis + (ptrdiff_t)(b / 2) * d->nrow;
        for (int p = 0; p < 2; p++) {
            double *own = column + (ptrdiff_t)p * d->nrow, part = product_dot(d->nrow, q, own);
            for (int i = 0; i < d->nrow; i++)
                own[i] -= part * q[i];
        }
    }
    for (int i = 0; i < d->nrow; i++) {
        double one = column[i], two = column[i + d->nrow];
        h[0] += one * one;
        h[1] += one * two;
        h[2] += two * two;
        g[0] += one * list->scan->r[i];
        g[1] += two * list->scan->r[i];
    }
    double shift = rotor_length(&job->rotor) * prior[0].scale, scale = prior[1].scale;
    for (int some = 1; some < 4 && !status; some++)
        status = offer_line_with(list, h, g, some & 1 ? shift : 0, some & 2 ? scale : 0);
    return status;
}

int faults_propose(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                   const rotid_fit_result *fit, const struct evidence_data *d, const struct scan *scan, int most,
                   struct fault_proposal *proposal, int *count)
{
    struct pool scratch;
    int status = ROTID_OK;
    *count = 0;
    pool_open(&scratch, pool->allocator);
    for (int state = 0; state < states->nstate && !status && scan->nrow == d->nrow; state++) {
        struct channels c;
        status = open_channels(&scratch, states, state, number, holdout, fit, d, &c);
        struct fault_list list = {pool, &c, scan, most, *count, proposal};
        for (int s = 0; s < c.nsensor && c.nsensor >= LEAST_SENSORS && !status; s++) {
            status = offer_single(&list, s);
            for (int t = s + 1; t < c.nsensor && !status; t++)
                status = offer_swap(&list, s, t);
        }
        if (!status && c.nsensor >= LEAST_SENSORS)
            status = offer_line(&list);
        *count = list.count;
    }
    pool_close(&scratch);
    return status;
}

/* ---- fits */

static int is_dead(const struct candidate *fault)
{
    return !strcmp(fault->cause->id, "duplicate_channel") && !fault->sensor[1];
}

static void forget(double *shape, int nsensor, int nmode, int s)
{
    for (int k = 0; k < nmode && shape; k++)
        shape[s + (ptrdiff_t)k * nsensor] = NAN;
}

/* A dead channel leaves no data that could be put right: as if the sensor had not been there. */
static void leave_out(struct job *job, int id)
{
    struct job_raw *raw = job->measurement.raw;
    forget(job->measurement.shape, job->rotor.nsensor, job->measurement.nmode, sensor_find(job, id));
    for (int s = 0; raw && s < raw->nsensor; s++)
        if (raw->sensor[s].id == id)
            forget(raw->shape, raw->nsensor, job->measurement.nmode, s);
}

static struct correction correction_of(const struct candidate *fault)
{
    const double *value = fault->effect.value;
    return (struct correction){.id = fault->cause->id,
                               .nsensor = (fault->sensor[0] > 0) + (fault->sensor[1] > 0),
                               .sensor = {fault->sensor[0], fault->sensor[1]},
                               .value = fault->nparameter ? value[0] : 1,
                               .more = {value[1], value[2]}};
}

/* *to := the states with the fault put right in data of their own. */
static int put_right(struct pool *pool, const struct states *from, const struct candidate *fault, struct states *to)
{
    int status = states_copy(pool, from, to);
    if (status)
        return status;
    struct job *job = &to->state[fault->home].job;
    const struct correction correction = correction_of(fault);
    status = data_copy(pool, job);
    if (!status && is_dead(fault)) {
        leave_out(job, fault->sensor[0]);
        return ROTID_OK;
    }
    return status ? status : correction_add(pool, job, &correction);
}

int fault_columns(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                  const rotid_fit_result *fit, const struct evidence_data *d, const struct candidate *fault,
                  struct fault_column *column, int *count)
{
    const struct job *job = &states->state[fault->home].job;
    struct channels c;
    int line = !fault->sensor[0], parameters = fault->nparameter, s = line ? 0 : sensor_find(job, fault->sensor[0]), status;
    if (!parameters || s < 0)
        return ROTID_OK;
    struct pool scratch; /* the model of a solid is large beside its columns */
    pool_open(&scratch, pool->allocator);
    status = open_channels(&scratch, states, fault->home, number, holdout, fit, d, &c);
    for (int p = 0; p < parameters && !status; p++) {
        if (fault->fixed[p])
            continue;
        struct fault_column *to = &column[*count];
        *to = (struct fault_column){fault->cause, p, fault->effect.value[p], 0, 0, POOL_ARRAY(pool, double, d->nrow), NAN, NAN};
        if (!to->column) {
            status = ROTID_ERROR_MEMORY;
            break;
        }
        (*count)++;
        cause_range(fault->cause, &job->rotor, &fault->effect, p, &to->lower, &to->upper);
        memset(to->column, 0, (size_t)d->nrow * sizeof *to->column);
        for (int b = 0; b < c.nblock; b++) {
            const struct evidence_block *block = &d->block[c.first + b];
            double along = 0, square = 0, end = line && fault->effect.value[2] >= 0.5 ? -1 : 1;
            for (int i = 0; i < block->count; i++) {
                int row = block->row + i, own = block->sensor[i];
                double z = job->rotor.sensor[own].position; /* as it is now */
                if (!line && own != s)
                    continue;
                to->column[row] = line && p ? c.slope[row] *
                                                  (z - (end < 0 ? rotor_length(&job->rotor) : 0) - end * fault->effect.value[0]) /
                                                  fault->effect.value[1]
                                  : line || !strcmp(fault->cause->id, "sensor_position") ? end * c.slope[row]
                                                                                         : c.u[row] / fault->effect.value[0];
                along += c.u[row] * to->column[row];
            }
            for (int i = 0; i < block->count; i++)
                square += c.u[block->row + i] * c.u[block->row + i];
            for (int i = 0; i < block->count && square > 0; i++) /* the scale of the shape is free */
                to->column[block->row + i] -= along / square * c.u[block->row + i];
        }
    }
    pool_close(&scratch);
    return status;
}

int fault_refit(struct pool *pool, const struct states *states, int nown, const int *number, const int *holdout,
                const rotid_fit_result *from, const rotid_environment *environment, struct candidate *fault, struct refit *refit,
                struct evidence_data **data)
{
    double *own = POOL_ARRAY(pool, double, nown + 1), *std = POOL_ARRAY(pool, double, nown + 1);
    struct candidate fitted = *fault;
    *refit = (struct refit){.chi2 = INFINITY};
    if (!own || !std)
        return ROTID_ERROR_MEMORY;
    for (int pass = 0; pass < STEPS; pass++) {
        struct states right;
        struct fault_column column[2];
        struct evidence e = {.mean = own, .std = std};
        rotid_fit_result *fit = NULL;
        int count = 0, status = put_right(pool, states, fault, &right);
        if (!status)
            status = states_started_at(pool, &right, refit->fit ? refit->fit->x : from->x, &right);
        if (!status)
            status = refit_states(pool, &right, number, holdout, environment, &fit);
        if (!status)
            status = evidence_open(pool, &right, number, holdout, data);
        if (!status)
            status = fault_columns(pool, &right, number, holdout, fit, *data, fault, column, &count);
        if (!status && count)
            status = evidence_of_fit(*data, &right, nown, fit, 0, NULL, count, column, NULL, &e);
        if (status) {
            rotid_fit_free(fit);
            *fault = fitted; /* no sensor may leave the rotor, as a step may ask */
            return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
        }
        status = refit_keep(pool, &right, fit, refit);
        if (status)
            return status;
        double most = 0;
        struct candidate next = *fault;
        for (int i = 0; i < count; i++) {
            const struct fault_column *c = &column[i];
            int p = c->parameter;
            fault->std[p] = c->std;
            fault->ci_lower[p] = c->value - NORMAL_95 * c->std;
            fault->ci_upper[p] = c->value + NORMAL_95 * c->std;
            most = fmax(most, fabs(c->step) / c->std);
            next.effect.value[p] = fmin(fmax(c->value + c->step, c->lower), c->upper);
        }
        if (!(most > STEP_DONE) || pass + 1 == STEPS)
            return ROTID_OK;
        fitted = *fault;
        *fault = next;
    }
    return ROTID_OK;
}

/* ---- findings */

static const char *describe(struct pool *pool, const struct candidate *fault)
{
    const char *id = fault->cause->id;
    const int *sensor = fault->sensor;
    double value = fault->effect.value[0];
    if (!strcmp(id, "sensor_gain"))
        return pool_text(pool, "sensor %d reads %.3g times what it should; its components are divided by that", sensor[0], value);
    if (!strcmp(id, "sensor_sign"))
        return pool_text(pool, "sensor %d has the wrong sign; it is turned", sensor[0]);
    if (!strcmp(id, "sensor_swap"))
        return pool_text(pool, "sensors %d and %d are exchanged; they are put back", sensor[0], sensor[1]);
    if (!strcmp(id, "sensor_position"))
        return pool_text(pool, "sensor %d sits %.3g mm further %s than stated; it is moved", sensor[0], 1e3 * fabs(value),
                         value > 0 ? "right" : "left");
    return sensor[1] ? pool_text(pool, "sensor %d records what sensor %d records; it is left out", sensor[0], sensor[1])
                     : pool_text(pool, "sensor %d is dead; it is left out", sensor[0]);
}

static rotid_cause_value sized(const char *name, const char *unit, double value, double std)
{
    double half = NORMAL_95 * std;
    return (rotid_cause_value){name, unit, value, std, {value - half, value + half}, 0};
}

static const char *describe_line(struct pool *pool, const struct candidate *fault)
{
    const double *value = fault->effect.value;
    const char *text =
        value[2] >= 0.5 ? "the positions of all sensors count from the other end" : "the positions of all sensors are off";
    if (!fault->fixed[1])
        text = pool_text(pool, "%s, their distances are %.5g +- %.2g times the stated ones", text, value[1], fault->std[1]);
    if (!fault->fixed[0])
        text = pool_text(pool, "%s, their origin is off by %+.3g +- %.2g mm", text, 1e3 * value[0], 1e3 * fault->std[0]);
    return pool_text(pool, "%s; all of them are moved", text);
}

int fault_correct(struct engine *engine, const struct candidate *fault)
{
    int line = !fault->sensor[0], valued = fault->nparameter && !line;
    rotid_data_finding finding = {.id = fault->cause->id,
                                  .nsensors = (fault->sensor[0] > 0) + (fault->sensor[1] > 0),
                                  .sensors = POOL_ARRAY(engine->pool, int, 2),
                                  .value = valued ? fault->effect.value[0] : NAN,
                                  .std = valued ? fault->std[0] : NAN,
                                  .chi2_drop = fault->result.chi2_drop,
                                  .text = line ? describe_line(engine->pool, fault) : describe(engine->pool, fault)};
    if (engine->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    memcpy(finding.sensors, fault->sensor, sizeof fault->sensor);
    if (line) {
        finding.nparameters = 3;
        finding.parameters = POOL_ARRAY(engine->pool, rotid_cause_value, 3);
        if (!finding.parameters)
            return ROTID_ERROR_MEMORY;
        finding.parameters[0] = sized("shift", "m", fault->effect.value[0], fault->std[0]);
        finding.parameters[1] = sized("scale", "1", fault->effect.value[1], fault->std[1]);
        finding.parameters[2] = sized("flip", "1", fault->effect.value[2], NAN);
    }
    engine_look_at(engine, fault->home);
    const struct correction correction = correction_of(fault);
    int status = is_dead(fault) ? data_add_finding(engine, &finding) : data_correct(engine, &finding, &correction);
    if (is_dead(fault))
        leave_out(engine->job, fault->sensor[0]);
    engine_look_at(engine, 0);
    return status;
}
