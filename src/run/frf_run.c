#include "run/run.h"

#define DEFAULT_LINES 1601 /* where the card gives no lines, as many as a usual analyser has */
#define MOST_LINES    1000000

/* The deck as a whole; number: what the text has a place for, if it has one. */
static int refuse_deck(struct message_list *notes, const struct job *job, const char *format, int number)
{
    return message_refuse(notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1, format, number);
}

/* ------------------------------------------------------------------------------------------------ rows */

/* A lateral motion for a lateral force along the same axis: what a beam in one plane knows. Direction 0 is taken for one. */
static int is_lateral(const struct frf *frf, int axis)
{
    int response = abs(frf->response_direction), reference = abs(frf->reference_direction);
    return response <= 3 && reference <= 3 && (!response || !reference || response == reference) && response != axis + 1 &&
           reference != axis + 1;
}

static double sign_of(const struct frf *frf)
{
    return (frf->response_direction < 0) == (frf->reference_direction < 0) ? 1 : -1;
}

static void take(struct pool *pool, struct frf_result *out, int response, int reference, const struct frf *frf)
{
    const struct frf_row row = {.response = response,
                                .reference = reference,
                                .measured = frf,
                                .sign = frf ? sign_of(frf) : 1,
                                .is_reciprocal = frf && frf->response_node != response};
    (void)POOL_ADD(pool, out->row, out->nrow, &row);
}

/* The functions of a pair, those measured with force and response exchanged only where there is none the right way round. How
 * many there are. */
static int take_pair(struct pool *pool, struct frf_result *out, const struct frf_set *set, struct frf_pair pair, int axis)
{
    int found = 0;
    for (int swapped = 0; swapped < 2 && !found; swapped++)
        for (int c = 0; c < set->nfrf; c++) {
            const struct frf *frf = &set->frf[c];
            int response = swapped ? frf->reference_node : frf->response_node,
                reference = swapped ? frf->response_node : frf->reference_node;
            if (response != pair.response || reference != pair.reference || !is_lateral(frf, axis))
                continue;
            take(pool, out, response, reference, frf);
            found++;
        }
    return found;
}

static int requested_rows(struct pool *pool, const struct job *job, const struct frf_measured *measured,
                          struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->options.frf;
    for (int i = 0; i < request->npair; i++)
        if (!take_pair(pool, out, measured->set, request->pair[i], request->axis))
            return message_refuse(
                notes, ROTID_ERROR_ARGUMENT, measured->path, 1, 1,
                "there is no lateral transfer function between %d and %d, expected what *FRF names, or the axis of the rotor "
                "as AXIS on that card",
                request->pair[i].response, request->pair[i].reference);
    return ROTID_OK;
}

static int all_rows(struct pool *pool, const struct job *job, const struct frf_set *set, struct message_list *notes,
                    struct frf_result *out)
{
    int axis = job->options.frf.axis;
    for (int c = 0; c < set->nfrf; c++)
        if (is_lateral(&set->frf[c], axis))
            take(pool, out, set->frf[c].response_node, set->frf[c].reference_node, &set->frf[c]);
    if (!out->nrow)
        return refuse_deck(
            notes, job,
            "none of the %d measured transfer functions is lateral, expected response and force along one axis other "
            "than that of the rotor, AXIS on *FRF",
            set->nfrf);
    out->nleft_out = set->nfrf - out->nrow;
    if (out->nleft_out)
        message_warn(
            notes,
            "%d measured transfer functions are left out: not lateral (AXIS=%s is that of the rotor), or response and force "
            "along different axes",
            out->nleft_out,
            axis == 0   ? "X"
            : axis == 1 ? "Y"
                        : "Z");
    return ROTID_OK;
}

/* Rows of the request, of the measured functions, or of every sensor over the first, in out->row and out->nrow; out->nleft_out.
 * ROTID_OK, ROTID_ERROR_MEMORY, ROTID_ERROR_ARGUMENT with an error in the list. */
static int frf_choose_rows(struct pool *pool, const struct job *job, const struct frf_measured *measured,
                           struct message_list *notes, struct frf_result *out)
{
    const struct rotor *rotor = &job->rotor;
    const struct frf_request *request = &job->options.frf;
    int status = ROTID_OK;
    if (measured)
        status =
            request->npair ? requested_rows(pool, job, measured, notes, out) : all_rows(pool, job, measured->set, notes, out);
    else if (!request->npair && !rotor->nsensor)
        status = refuse_deck(notes, job, "the deck has %d sensors, expected *SENSORS, the points of the transfer functions", 0);
    for (int i = 0; i < request->npair && !measured; i++)
        take(pool, out, request->pair[i].response, request->pair[i].reference, NULL);
    for (int s = 0; s < rotor->nsensor && !measured && !request->npair; s++)
        take(pool, out, rotor->sensor[s].id, rotor->sensor[0].id, NULL);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
}

/* ------------------------------------------------------------------------------------------------ points */

struct placed {
    int id, is_sensor;
    double z;
};

ORDER_BY(by_id, struct placed, it->id, 0)

static int node_position(const struct job *job, const struct frf_measured *measured, struct message_list *notes,
                         struct placed *point)
{
    double *z = &point->z;
    int id = point->id;
    const struct frf_request *request = &job->options.frf;
    double length = rotor_length(&job->rotor);
    for (int s = 0; s < job->rotor.nsensor; s++)
        if (job->rotor.sensor[s].id == id) {
            *z = job->rotor.sensor[s].position;
            point->is_sensor = 1;
            return ROTID_OK;
        }
    for (int i = 0; measured && i < measured->nnode; i++)
        if (measured->node[i].id == id) {
            *z = request->origin + (request->flip ? -1 : 1) * measured->node[i].x[request->axis];
            if (*z >= -1e-5 * length && *z <= length * (1 + 1e-5)) { /* coordinates of files carry six digits */
                *z = fmin(fmax(*z, 0), length);
                return ROTID_OK;
            }
            return message_refuse(
                notes, ROTID_ERROR_ARGUMENT, measured->path, 1, 1,
                "node %d lies at %.6g m of the model, outside the rotor, expected 0 to %.6g m: check AXIS, ORIGIN, FLIP and "
                "the unit",
                id, *z, length);
        }
    return refuse_deck(
        notes, job, "point %d of the transfer functions has no position, expected it in *SENSORS or among the nodes of the file",
        id);
}

/* The distinct points of the rows by id, with their positions. */
static int distinct_points(struct pool *pool, const struct job *job, const struct frf_measured *measured,
                           struct message_list *notes, const struct frf_result *out, struct placed **points, int *count)
{
    struct placed *all = POOL_ARRAY(pool, struct placed, 2 * (size_t)out->nrow);
    int kept = 0;
    *points = all;
    if (!all)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * out->nrow; i++)
        all[i].id = i % 2 ? out->row[i / 2].reference : out->row[i / 2].response;
    qsort(all, 2 * (size_t)out->nrow, sizeof *all, by_id);
    for (int i = 0; i < 2 * out->nrow; i++) {
        if (kept && all[i].id == all[kept - 1].id)
            continue;
        all[kept].id = all[i].id;
        int status = node_position(job, measured, notes, &all[kept]);
        if (status)
            return status;
        kept++;
    }
    *count = kept;
    return ROTID_OK;
}

/* A disk without mass makes the mesh have a node where it is, behind all others so that parameters find theirs. Another sensor
 * would share the mass of an accelerometer that goes from sensor to sensor. */
static int add_nodes(struct pool *pool, int count, const struct placed *point, struct rotor *rotor)
{
    struct disk *disk = POOL_COPY(pool, rotor->disk, rotor->ndisk, count);
    if (!disk)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++)
        if (!point[i].is_sensor)
            disk[rotor->ndisk++] = (struct disk){.position = point[i].z};
    rotor->disk = disk;
    return ROTID_OK;
}

static int find(const struct placed *point, int count, int id)
{
    struct placed key = {.id = id};
    const struct placed *found = bsearch(&key, point, (size_t)count, sizeof *point, by_id);
    return (int)(found - point);
}

/* The model of the job with a mesh node at every point of the rows; pair [nrow] gets the points, dof [2 nrow] their lateral
 * degrees of freedom, *npoint their number. parameters: whether those of the job vary. Nodes that the file does not place and
 * that are no sensors are an error. Statuses of model_open besides. */
static int frf_place_points(struct pool *pool, const struct job *job, int parameters, const struct frf_measured *measured,
                            struct message_list *notes, const struct frf_result *out, struct rotor_model *model,
                            struct synthesis_pair *pair, int *dof, int *npoint)
{
    struct rotor rotor = job->rotor;
    struct placed *point;
    int failed, status = distinct_points(pool, job, measured, notes, out, &point, npoint);
    if (!status)
        status = add_nodes(pool, *npoint, point, &rotor);
    if (!status)
        status = model_open(pool, job->models, &rotor, parameters ? job->unknowns.nparameter : 0, job->unknowns.parameter, 1,
                            model, &failed);
    for (int i = 0; !status && i < *npoint; i++)
        dof[i] = model_lateral_dof(model, point[i].z);
    for (int i = 0; i < out->nrow && !status; i++) {
        struct frf_row *row = &out->row[i];
        pair[i].response = find(point, *npoint, row->response);
        pair[i].reference = find(point, *npoint, row->reference);
        row->response_z = point[pair[i].response].z;
        row->reference_z = point[pair[i].reference].z;
    }
    return status;
}

struct solver { /* on a pool of its own, which goes before the result is used */
    struct pool pool;
    const rotid_model *model;
    struct prediction prediction;
    rotid_matrix shifted;
    struct factor factor;
    int *all;
};

static int new_solver(struct solver *v, int count)
{
    const rotid_model *model = v->model;
    int status = prediction_new(&v->pool, model, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &v->prediction);
    v->all = POOL_ARRAY(&v->pool, int, model->n);
    if (status || !v->all)
        return status ? status : ROTID_ERROR_MEMORY;
    for (int i = 0; i < model->n; i++)
        v->all[i] = i;
    status = matrix_new(&v->pool, model->n, model->kd, model->nfar, model->far, &v->shifted);
    return status ? status : factor_new(&v->pool, FACTOR_CHOLESKY, &v->shifted, model->n, v->all, &v->factor);
}

/* How many modes lie below: the Sturm count of K - lambda M. The matrices of a solver that seeks one pair serve for it. */
static int count_modes(const rotid_model *model, const rotid_allocator *allocator, const double *x, double hz, int *count)
{
    struct solver v = {.model = model};
    double omega = TWO_PI * hz;
    pool_open(&v.pool, allocator);
    int status = new_solver(&v, 1);
    if (!status)
        status = prediction_compute(&v.prediction, x);
    if (!status) {
        matrix_combine(1, &v.prediction.k, -omega * omega, &v.prediction.m, &v.shifted);
        *count = factor_negative_count(&v.factor, &v.shifted);
        status = *count < 0 ? ROTID_ERROR_EIGEN : ROTID_OK;
    }
    pool_close(&v.pool);
    return status;
}

/* What the modes leave of x = (K + c M)^-1 e_j and of (K + c M)^-1 M x at the responses of the pairs with this reference. */
static void reference_residuals(struct solver *v, const struct synthesis *s, const int *dof, int reference, double *x)
{
    int n = v->model->n;
    double *y = x + n;
    memset(x, 0, (size_t)n * sizeof *x);
    x[dof[reference]] = 1;
    factor_solve(&v->factor, 1, x);
    matrix_multiply(&v->prediction.m, 1, x, y);
    factor_solve(&v->factor, 1, y);
    for (int p = 0; p < s->npair; p++) {
        struct synthesis_pair *pair = &s->pair[p];
        if (pair->reference != reference)
            continue;
        const double *a = s->shape + (ptrdiff_t)pair->response * s->nmode, *b = s->shape + (ptrdiff_t)reference * s->nmode;
        pair->residual = x[dof[pair->response]];
        pair->slope = y[dof[pair->response]];
        for (int r = 0; r < s->nmode; r++) {
            double distance = s->lambda[r] + s->shift;
            pair->residual -= a[r] * b[r] / distance;
            pair->slope -= a[r] * b[r] / (distance * distance);
        }
    }
}

/* The shift is of the size of the first elastic eigenvalue: K itself is singular for a free rotor, and with a much smaller one
 * the rigid-body modes, which are taken off again, would drown the rest in rounding. Where the suspension modes are counted too,
 * the first one counted is such a one, and the error goes as 1/c^3: a 32nd of the frequency up to which modes are taken, an
 * eighth of the highest line, is far from zero and from the modes left out. */
static int residuals(struct solver *v, double up_to_hz, const int *dof, struct synthesis *s)
{
    double *x = POOL_ARRAY(&v->pool, double, 2 * (size_t)v->model->n);
    int *done = POOL_ARRAY(&v->pool, int, s->npoint);
    if (!x || !done)
        return ROTID_ERROR_MEMORY;
    double least = TWO_PI * up_to_hz / 32, first = fabs(s->lambda[s->nrigid < s->nmode ? s->nrigid : s->nmode - 1]);
    s->shift = fmax(first, least * least);
    matrix_combine(1, &v->prediction.k, s->shift, &v->prediction.m, &v->shifted);
    if (factor_compute(&v->factor, &v->shifted))
        return ROTID_ERROR_STIFFNESS;
    for (int p = 0; p < s->npair; p++)
        if (!done[s->pair[p].reference]++)
            reference_residuals(v, s, dof, s->pair[p].reference, x);
    return ROTID_OK;
}

static int keep_modes(struct pool *pool, const struct prediction *p, const int *dof, struct synthesis *s)
{
    s->lambda = POOL_COPY(pool, p->lambda, s->nmode, 0);
    s->shape = POOL_ARRAY(pool, double, (size_t)s->nmode *(size_t)s->npoint);
    if (!s->lambda || !s->shape)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < s->npoint; i++)
        for (int r = 0; r < s->nmode; r++)
            s->shape[r + (ptrdiff_t)i * s->nmode] = p->phi[dof[i] + (ptrdiff_t)r * p->size];
    return ROTID_OK;
}

int synthesis_open(struct pool *pool, const rotid_model *model, const double *x, double up_to_hz, int least, int npoint,
                   const int *dof, int npair, struct synthesis_pair *pair, struct synthesis *s)
{
    struct solver v = {.model = model};
    int count = 0, status = count_modes(model, pool->allocator, x, up_to_hz, &count);
    if (status)
        return status;
    least = least > model->nrigid ? least : model->nrigid + 1; /* the shift of the residuals is the first elastic one */
    count = count > least ? count : least;
    count = count < 1 ? 1 : count < model->n ? count : model->n;
    if (count > SYNTHESIS_MOST_MODES)
        return ROTID_ERROR_ARGUMENT;
    *s = (struct synthesis){.npoint = npoint, .nmode = count, .nrigid = model->nrigid, .npair = npair, .pair = pair};
    pool_open(&v.pool, pool->allocator);
    status = new_solver(&v, count);
    if (!status)
        status = prediction_compute(&v.prediction, x);
    if (!status)
        status = keep_modes(pool, &v.prediction, dof, s);
    if (!status)
        status = residuals(&v, up_to_hz, dof, s);
    pool_close(&v.pool);
    return status;
}

/* ------------------------------------------------------------------------------------------------ evaluation */

/* 1/(lambda + s^2 + 2 zeta w s) */
static void mode_factor(const struct synthesis_lines *lines, double lambda, double zeta, double complex *factor)
{
    double w = lambda > 0 ? sqrt(lambda) : 0, decay = lines->decay, constant = lambda + decay * decay + 2 * zeta * w * decay,
           loss = 2 * (decay + zeta * w);
    double *out = (double *)factor;
    for (int l = 0; l < lines->nline; l++) {
        double omega = TWO_PI * lines->frequency_hz[l], re = constant - omega * omega, im = loss * omega,
               inverse = 1 / (re * re + im * im);
        *out++ = re * inverse;
        *out++ = -im * inverse;
    }
}

static void add_scaled(int n, double scale, const double complex *x, double complex *y)
{
    const double *restrict from = (const double *)x;
    double *restrict to = (double *)y;
    for (int i = 0; i < 2 * n; i++) /* a real factor: parts are alike, and the loop runs in vectors */
        to[i] += scale * from[i];
}

static void finish(const struct synthesis *s, const struct synthesis_lines *lines, int p, double complex *h)
{
    const struct synthesis_pair *pair = &s->pair[p];
    for (int l = 0; l < lines->nline; l++) {
        double complex at = lines->decay + I * (TWO_PI * lines->frequency_hz[l]), square = at * at;
        if (!lines->without_residual)
            h[l] += pair->residual + (s->shift - square) * pair->slope;
        if (lines->quantity != FRF_DISPLACEMENT)
            h[l] *= lines->quantity == FRF_VELOCITY ? at : square;
    }
}

void synthesis_evaluate(const struct synthesis *s, const struct synthesis_lines *lines, const double *lambda, const double *zeta,
                        int first, int count, double complex *h, double complex *work)
{
    memset(h, 0, (size_t)count * (size_t)lines->nline * sizeof *h);
    for (int r = 0; r < s->nmode; r++) {
        mode_factor(lines, lambda[r], zeta[r], work);
        for (int c = 0; c < count; c++) {
            const struct synthesis_pair *pair = &s->pair[first + c];
            double product =
                s->shape[r + (ptrdiff_t)pair->response * s->nmode] * s->shape[r + (ptrdiff_t)pair->reference * s->nmode];
            add_scaled(lines->nline, product, work, h + (ptrdiff_t)c * lines->nline);
        }
    }
    for (int c = 0; c < count; c++)
        finish(s, lines, first + c, h + (ptrdiff_t)c * lines->nline);
}

/* ------------------------------------------------------------------------------------------------ lines */

static int measured_lines(const struct job *job, const struct frf_set *set, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->options.frf;
    int first = 0, last = set->nline - 1;
    double low = request->low_hz * (1 - 1e-9), high = request->high_hz * (1 + 1e-9);
    while (first <= last && !(set->frequency_hz[first] > 0 && set->frequency_hz[first] >= low))
        first++; /* nothing is free of its suspension at 0 Hz */
    while (last >= first && request->high_hz > 0 && set->frequency_hz[last] > high)
        last--;
    out->skip = first;
    out->nline = last - first + 1;
    out->frequency_hz = set->frequency_hz + first;
    out->decay = set->window_decay;
    out->quantity = request->has_quantity ? request->quantity : set->quantity;
    return out->nline > 0
               ? ROTID_OK
               : refuse_deck(notes, job, "no measured line lies between LOW and HIGH, expected other limits on *FRF", 0);
}

static int requested_lines(struct pool *pool, const struct job *job, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->options.frf;
    double low = request->low_hz, high = request->high_hz;
    for (int k = 0; k < job->measurement.nmode; k++) {
        if (request->low_hz <= 0 && (!k || job->measurement.frequency_hz[k] / 2 < low))
            low = job->measurement.frequency_hz[k] / 2;
        if (request->high_hz <= 0)
            high = fmax(high, 1.1 * job->measurement.frequency_hz[k]);
    }
    if (!(low > 0 && high > low))
        return refuse_deck(notes, job,
                           "the lines of the transfer functions are not known, expected LOW and HIGH [Hz] on *FRF, LOW first", 0);
    double step = request->step_hz;
    if (step > 0 && (high - low) / step >= MOST_LINES)
        return refuse_deck(notes, job, "there are more than %d lines, expected a larger STEP on *FRF", MOST_LINES);
    out->nline = step > 0 ? (int)floor((high - low) / step * (1 + 1e-12)) + 1 : request->nline ? request->nline : DEFAULT_LINES;
    double *hz = POOL_ARRAY(pool, double, out->nline);
    if (!hz)
        return ROTID_ERROR_MEMORY;
    for (int l = 0; l < out->nline; l++)
        hz[l] = step > 0 ? low + step * l : low + (high - low) * l / (out->nline - 1);
    out->frequency_hz = hz;
    out->quantity = request->quantity;
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ damping */

/* A ratio of zero is that of a file or deck which does not know it. */
static int has_ratio(const struct job *job, int k)
{
    return job->measurement.damping[k] > 0 && job->measurement.damping[k] < 1;
}

int frf_refuse_undamped(const struct job *job, struct message_list *notes)
{
    for (int k = 0; k < job->measurement.nmode; k++)
        if (has_ratio(job, k))
            return ROTID_OK;
    return job->options.frf.damping > 0
               ? ROTID_OK
               : refuse_deck(notes, job,
                             "no mode has a damping ratio, expected one as third value of *MODES, in the file of *MEASURED, or "
                             "DAMPING= on *FRF",
                             0);
}

/* zeta, damping and moved_lambda of every mode of out->synthesis; compared NULL: nothing was measured. Statuses as above,
 * ARGUMENT where no ratio is known. */
static int frf_choose_damping(struct pool *pool, const struct job *job, const struct comparison *compared,
                              struct message_list *notes, struct frf_result *out)
{
    const struct synthesis *s = &out->synthesis;
    double stated = job->options.frf.damping, smallest = INFINITY, sum[2] = {0, 0};
    int count[2] = {0, 0}, suspended = job->rotor.count_all ? job->measurement.numbering.nsupport : 0; /* of those counted */
    out->zeta = POOL_ARRAY(pool, double, s->nmode);
    out->damping = POOL_ARRAY(pool, enum frf_damping, s->nmode);
    out->moved_lambda = POOL_ARRAY(pool, double, s->nmode);
    if (!out->zeta || !out->damping || !out->moved_lambda)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; compared && k < compared->nmode; k++)
        if (has_ratio(job, k)) {
            int elastic = compared->number[k] > suspended;
            smallest = fmin(smallest, job->measurement.damping[k]);
            sum[elastic] += job->measurement.damping[k];
            count[elastic]++;
        }
    int of = count[1] > 0; /* the mean is that of elastic modes, as far as one has a ratio */
    int status = frf_refuse_undamped(job, notes);
    if (status)
        return status;
    memcpy(out->moved_lambda, s->lambda, (size_t)s->nmode * sizeof *s->lambda);
    for (int r = 0; r < s->nmode; r++) {
        int rigid = r < s->nrigid + suspended;
        out->damping[r] = stated > 0 ? FRF_DAMPING_STATED : rigid ? FRF_DAMPING_SMALLEST : FRF_DAMPING_MEAN;
        out->zeta[r] = stated > 0 ? stated : rigid ? smallest : sum[of] / count[of];
    }
    for (int k = 0; compared && k < compared->nmode; k++) {
        int r = s->nrigid + compared->number[k] - 1;
        double omega = TWO_PI * job->measurement.frequency_hz[k];
        if (r >= s->nmode)
            continue;
        out->moved_lambda[r] = omega * omega;
        if (has_ratio(job, k)) {
            out->zeta[r] = job->measurement.damping[k];
            out->damping[r] = FRF_DAMPING_MEASURED;
        }
    }
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ modes and lines */

static int nearest_line(const struct frf_result *out, double hz)
{
    int low = 0, high = out->nline - 1;
    while (high - low > 1) {
        int middle = low + (high - low) / 2;
        *(out->frequency_hz[middle] <= hz ? &low : &high) = middle;
    }
    return hz - out->frequency_hz[low] < out->frequency_hz[high] - hz ? low : high;
}

/* Borders half-way between the resonances of neighbours, so that both peaks of a mode whose frequency is off by percent lie
 * within its lines. */
static int frf_make_bands(struct pool *pool, const struct job *job, const struct comparison *compared, struct frf_result *out)
{
    const struct synthesis *s = &out->synthesis;
    double from = out->frequency_hz[0], to = out->frequency_hz[out->nline - 1];
    out->band = POOL_ARRAY(pool, struct frf_band, s->nmode);
    if (!out->band)
        return ROTID_ERROR_MEMORY;
    for (int r = s->nrigid; r < s->nmode; r++) {
        struct frf_band band = {.mode = r - s->nrigid + 1, .measured = -1, .model_hz = sqrt(s->lambda[r]) / TWO_PI, .worst = -1};
        band.measured_hz = NAN;
        for (int k = 0; compared && k < compared->nmode; k++)
            if (compared->number[k] == band.mode) {
                band.measured = k;
                band.measured_hz = job->measurement.frequency_hz[k];
            }
        if (fmax(band.measured_hz, band.model_hz) < from || fmin(band.measured_hz, band.model_hz) > to) /* without NaN */
            continue;
        band.at_model = nearest_line(out, band.model_hz);
        band.at_measured = isfinite(band.measured_hz) ? nearest_line(out, band.measured_hz) : band.at_model;
        out->band[out->nband++] = band;
    }
    for (int b = 0; b < out->nband; b++) {
        struct frf_band *band = &out->band[b];
        double highest = fmax(band->measured_hz, band->model_hz),
               next = b + 1 < out->nband ? (highest + fmin(band[1].measured_hz, band[1].model_hz)) / 2 : INFINITY;
        band->first = b ? out->band[b - 1].last + 1 : 0;
        band->last = out->nline - 1;
        while (band->last >= band->first && out->frequency_hz[band->last] > next)
            band->last--;
    }
    return ROTID_OK;
}

#define STRANGE 0.1 /* loss of FRAC with measured frequencies that no scatter of them explains */
#define ABOVE   4   /* modes are taken up to this many times the highest line; the rest is static to within 1/16 squared */

/* ------------------------------------------------------------------------------------------------ curves */

static struct synthesis_lines lines_of(const struct frf_result *result)
{
    return (struct synthesis_lines){
        .nline = result->nline, .frequency_hz = result->frequency_hz, .quantity = result->quantity, .decay = result->decay};
}

void frf_synthesised(const struct frf_result *result, int row, double complex *h, double complex *work)
{
    struct synthesis_lines lines = lines_of(result);
    synthesis_evaluate(&result->synthesis, &lines, result->synthesis.lambda, result->zeta, row, 1, h, work);
}

void frf_measured_curve(const struct frf_result *result, const struct frf_set *set, int row, double complex *h)
{
    const struct frf_row *r = &result->row[row];
    int powers = (int)result->quantity - (set ? (int)set->quantity : 0);
    for (int l = 0; l < result->nline; l++) {
        double complex s = result->decay + I * (TWO_PI * result->frequency_hz[l]), value = NAN;
        if (set && r->measured)
            value = r->sign * r->measured->h[result->skip + l];
        for (int p = 0; p < powers; p++)
            value *= s;
        for (int p = powers; p < 0; p++)
            value /= s;
        h[l] = value;
    }
}

/* ------------------------------------------------------------------------------------------------ agreement */

/* At the resonances, and where the curves are furthest apart. */
static void judge_band(struct frf_result *out, int row, int b, const double complex *measured, const double complex *h)
{
    struct frf_band *band = &out->band[b];
    struct frf_at_mode *at = &out->at[b + (ptrdiff_t)row * out->nband];
    double largest = 0, apart = 0; /* squares */
    for (int l = band->first; l <= band->last; l++) {
        double re = creal(measured[l]), im = cimag(measured[l]), dre = re - creal(h[l]), dim = im - cimag(h[l]);
        if (!isfinite(re) || !isfinite(im))
            continue;
        largest = fmax(largest, re * re + im * im);
        apart = fmax(apart, dre * dre + dim * dim);
    }
    frf_sums_add(&band->resonance, 1, measured + band->at_measured, h + band->at_model);
    double complex quotient = measured[band->at_measured] / h[band->at_model];
    at->mode = band->mode;
    at->level_db = 20 * log10(cabs(quotient));
    at->phase_deg = carg(quotient) * 360 / TWO_PI;
    at->deviation = largest > 0 ? sqrt(apart / largest) : NAN;
    if (isfinite(at->deviation) &&
        (band->worst < 0 || at->deviation > out->at[b + (ptrdiff_t)band->worst * out->nband].deviation))
        band->worst = row;
}

/* Adds what another one holds. */
static void frf_sums_join(struct frf_sums *sums, const struct frf_sums *other)
{
    sums->cross += other->cross;
    sums->conjugate += other->conjugate;
    sums->measured += other->measured;
    sums->synthesised += other->synthesised;
    sums->lines += other->lines;
}

static void compare_row(struct frf_result *out, int row, const double complex *measured, const double complex *h,
                        const double complex *moved)
{
    struct frf_row *r = &out->row[row];
    for (int b = 0; b < out->nband; b++) { /* every line belongs to one band */
        struct frf_band *band = &out->band[b];
        struct frf_sums sums = {0}, shifted = {0};
        int n = band->last - band->first + 1;
        frf_sums_add(&sums, n, measured + band->first, h + band->first);
        frf_sums_add(&shifted, n, measured + band->first, moved + band->first);
        frf_sums_join(&band->sums, &sums);
        frf_sums_join(&band->moved, &shifted);
        frf_sums_join(&r->sums, &sums);
        frf_sums_join(&r->moved, &shifted);
        judge_band(out, row, b, measured, h);
    }
    if (!out->nband) {
        frf_sums_add(&r->sums, out->nline, measured, h);
        frf_sums_add(&r->moved, out->nline, measured, moved);
    }
    frf_sums_join(&out->sums, &r->sums);
    frf_sums_join(&out->moved, &r->moved);
}

static int compare_rows(struct pool *pool, const struct frf_measured *measured, const rotid_environment *environment,
                        struct frf_result *out)
{
    struct pool scratch;
    struct synthesis_lines lines = lines_of(out);
    size_t block = (size_t)out->nline * SYNTHESIS_TOGETHER;
    out->at = POOL_ARRAY(pool, struct frf_at_mode, (size_t)out->nband * (size_t)out->nrow);
    pool_open(&scratch, pool->allocator);
    double complex *h = POOL_ARRAY(&scratch, double complex, block), *moved = POOL_ARRAY(&scratch, double complex, block),
                   *work = POOL_ARRAY(&scratch, double complex, out->nline);
    int status = out->at && h && moved && work ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int first = 0; first < out->nrow && !status; first += SYNTHESIS_TOGETHER) {
        int count = out->nrow - first < SYNTHESIS_TOGETHER ? out->nrow - first : SYNTHESIS_TOGETHER;
        if (environment_cancelled(environment))
            break;
        synthesis_evaluate(&out->synthesis, &lines, out->synthesis.lambda, out->zeta, first, count, h, work);
        synthesis_evaluate(&out->synthesis, &lines, out->moved_lambda, out->zeta, first, count, moved, work);
        for (int c = 0; c < count; c++) {
            ptrdiff_t at = (ptrdiff_t)c * out->nline;
            frf_measured_curve(out, measured->set, first + c, work);
            compare_row(out, first + c, work, h + at, moved + at);
        }
        out->ndone += count;
        environment_progress(environment, "transfer function", out->ndone);
    }
    pool_close(&scratch);
    return status;
}

/* ------------------------------------------------------------------------------------------------ the whole */

static int open_synthesis(struct pool *pool, const struct job *job, const struct identification *identified,
                          const struct frf_measured *measured, struct message_list *notes, struct frf_result *out)
{
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct synthesis_pair *pair = POOL_ARRAY(pool, struct synthesis_pair, out->nrow);
    int *dof = POOL_ARRAY(pool, int, 2 * (size_t)out->nrow), npoint;
    if (!model || !pair || !dof)
        return ROTID_ERROR_MEMORY;
    int status = frf_place_points(pool, job, identified != NULL, measured, notes, out, model, pair, dof, &npoint);
    if (status)
        return status;
    out->up_to_hz = ABOVE * out->frequency_hz[out->nline - 1];
    status = synthesis_open(pool, &model->equations, identified ? identified->fit->x : NULL, out->up_to_hz,
                            model->equations.nrigid + comparison_highest(job), npoint, dof, out->nrow, pair, &out->synthesis);
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(notes, SEVERITY_ERROR, job->deck, 1, 1,
                    "the model has more than %d modes below %.6g Hz, %d times the highest line, expected a lower HIGH on *FRF",
                    SYNTHESIS_MOST_MODES, out->up_to_hz, ABOVE);
    return status;
}

int frf_run(struct pool *pool, const struct job *job, const struct identification *identified,
            const struct frf_measured *measured, const rotid_environment *environment, struct message_list *notes,
            struct frf_result *out)
{
    const struct comparison *compared = identified ? &identified->compared : NULL;
    *out = (struct frf_result){.is_measured = measured != NULL};
    /* lines, quantity and window: those of the measured set within LOW and HIGH but a line at 0 Hz, else those of the card, by
     * default 1601 from half the lowest measured frequency to 1.1 times the highest */
    int status = measured ? measured_lines(job, measured->set, notes, out) : requested_lines(pool, job, notes, out);
    if (!status)
        status = frf_choose_rows(pool, job, measured, notes, out);
    if (!status)
        status = open_synthesis(pool, job, identified, measured, notes, out);
    if (!status)
        status = frf_choose_damping(pool, job, compared, notes, out);
    if (!status)
        status = frf_make_bands(pool, job, compared, out);
    if (!measured)
        out->ndone = out->nrow;
    else if (!status)
        status = compare_rows(pool, measured, environment, out);
    if (!status && frf_sums_frac(&out->moved) < frf_sums_frac(&out->sums) - STRANGE)
        message_warn(
            notes,
            "the measured functions fit the frequencies of the model (FRAC %.3f) better than those of the measured modes (%.3f): "
            "do they come from the same test?",
            frf_sums_frac(&out->sums), frf_sums_frac(&out->moved));
    return status;
}
