#include "diagnose/diagnose.h"

/* (K - lambda M)^+ on the unit vectors of the sensors, in what the cluster of the mode leaves of the space */
static int solve_adjoints(struct columns *c, struct nelson_band *nelson, const double *zero, double *m_phi, double *unit,
                          struct columns_mode *mode)
{
    const struct prediction *p = &c->functional.prediction;
    int n = p->size;
    const double *phi = p->phi + (ptrdiff_t)mode->first * n;
    mode->adjoint = POOL_ARRAY(c->pool, double, (size_t)n *(size_t)mode->sensors);
    if (!mode->adjoint)
        return ROTID_ERROR_MEMORY;
    int status = nelson_band_prepare(nelson, p->lambda[mode->pair], mode->members, phi);
    if (status || !mode->sensors)
        return status;
    matrix_multiply(&p->m, mode->members, phi, m_phi);
    memset(unit, 0, (size_t)n * (size_t)mode->sensors * sizeof *unit);
    for (int i = 0; i < mode->sensors; i++)
        unit[c->model.equations.master[mode->sensor[i]] + (ptrdiff_t)i * n] = 1;
    double *solution = unit + (ptrdiff_t)n * mode->sensors;
    nelson_band_solve(nelson, mode->sensors, mode->members, phi, m_phi, unit, zero, solution);
    for (int s = 0; s < mode->sensors; s++)
        for (int i = 0; i < n; i++)
            mode->adjoint[s + (ptrdiff_t)i * mode->sensors] = solution[i + (ptrdiff_t)s * n];
    return ROTID_OK;
}

static int open_mode(struct pool *pool, struct columns *c, int k, struct columns_mode *mode)
{
    const struct functional *f = &c->functional;
    const rotid_measured *measured = &c->measured;
    int nmaster = c->model.equations.nmaster;
    *mode = (struct columns_mode){.k = k, .pair = f->pair[k]};
    mode->members = eigenvalue_cluster(f->prediction.count, f->prediction.lambda, mode->pair, &mode->first);
    int *sensor = POOL_ARRAY(pool, int, nmaster);
    if (!sensor)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nmaster && f->shape && measured->shape_std; s++)
        if (isfinite(f->shape[s + (ptrdiff_t)k * nmaster]))
            sensor[mode->sensors++] = s;
    mode->sensor = sensor;
    mode->weighted = POOL_ARRAY(pool, double, mode->sensors);
    if (!mode->weighted)
        return ROTID_ERROR_MEMORY;
    double b = 0;
    for (int i = 0; i < mode->sensors && f->shape && measured->shape_std; i++) {
        ptrdiff_t at = sensor[i] + (ptrdiff_t)k * nmaster;
        mode->weighted[i] = prediction_at_sensor(&f->prediction, mode->pair, sensor[i]) / measured->shape_std[at];
        mode->square += mode->weighted[i] * mode->weighted[i];
        b += mode->weighted[i] * f->shape[at] / measured->shape_std[at];
    }
    mode->scale = mode->square > 0 ? b / mode->square : 0;
    return ROTID_OK;
}

static int open_model(struct pool *pool, const struct job *job, const struct effect *extra, int refine, struct columns *c)
{
    struct rotor rotor = job->rotor;
    int effects = rotor.neffect, nparameter = job->unknowns.nparameter, failed;
    int added = extra ? EFFECT_MOST_PARAMETERS : 0;
    struct effect *effect = POOL_COPY(pool, rotor.effect, effects, 1);
    struct parameter *parameter = POOL_COPY(pool, job->unknowns.parameter, nparameter, added);
    if (!effect || !parameter)
        return ROTID_ERROR_MEMORY;
    if (extra)
        effect[rotor.neffect++] = *extra;
    for (int i = 0; i < added; i++)
        parameter[nparameter + i] = (struct parameter){.kind = PARAMETER_EFFECT, .index = effects, .component = i};
    rotor.effect = effect;
    return model_open(pool, job->models, &rotor, nparameter + added, parameter, refine, &c->model, &failed);
}

int columns_open(struct pool *pool, const struct job *job, const int *number, const int *holdout, const struct effect *extra,
                 const double *x, struct columns *c)
{
    *c = (struct columns){.pool = pool, .job = job};
    const double *shape;
    double *frequency_hz;
    int refine, status = mesh_of_fit(pool, job, number, &refine, &frequency_hz, &shape);
    if (!status)
        status = open_model(pool, job, extra, refine, c);
    if (status)
        return status;
    int nparam = c->model.equations.nparam, shapes = job_fits_shapes(job);
    c->measured = (rotid_measured){.nmode = job->measurement.nmode,
                                   .number = number,
                                   .frequency_hz = frequency_hz,
                                   .frequency_std = job->measurement.frequency_std,
                                   .shape = shapes ? shape : NULL,
                                   .shape_std = shapes ? job->measurement.shape_std : NULL,
                                   .holdout = holdout};
    status = measured_whole(pool, job, &c->model, &c->measured);
    if (!status)
        status = functional_new(pool, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON, &c->model.equations, &c->measured,
                                &c->functional);
    if (status)
        return status;
    c->nrow = c->functional.nresidual;
    c->mode = POOL_ARRAY(pool, struct columns_mode, job->measurement.nmode);
    c->x = POOL_ARRAY(pool, double, nparam);
    c->r = POOL_ARRAY(pool, double, c->nrow);
    if (!c->mode || !c->x || !c->r)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < nparam; p++)
        c->x[p] = x && p < job->unknowns.nparameter ? x[p] : *parameter_value(c->model.rotor, c->model.parameter[p]);
    status = functional_residual(&c->functional, c->x, c->r);
    for (int m = 0; m < job->measurement.nmode && !status; m++) {
        if (holdout && holdout[m])
            continue;
        status = open_mode(pool, c, m, &c->mode[c->nmode++]);
    }
    return status;
}

static int are_alike(const struct columns_mode *a, const struct columns_mode *b)
{
    int alike = a->pair == b->pair && a->sensors == b->sensors;
    return alike && !memcmp(a->sensor, b->sensor, (size_t)a->sensors * sizeof *a->sensor);
}

int columns_prepare(struct columns *c, const struct columns *like)
{
    struct pool *pool = c->pool;
    const rotid_matrix *k = &c->functional.prediction.k;
    int n = c->model.equations.n, most = c->model.equations.nmaster > 1 ? c->model.equations.nmaster : 1;
    size_t images = (size_t)n * (size_t)c->nmode;
    double *vectors = POOL_ARRAY(pool, double, 3 * images + (size_t)n),
           *zero = POOL_ARRAY(pool, double, CLUSTER_MOST *(size_t)most),
           *m_phi = POOL_ARRAY(pool, double, CLUSTER_MOST *(size_t)n),
           *unit = POOL_ARRAY(pool, double, 2 * (size_t)n * (size_t)most);
    c->dphi = POOL_ARRAY(pool, double, most);
    c->phi = POOL_ARRAY(pool, double, images);
    if (!c->dphi || !c->phi || !vectors || !zero || !m_phi || !unit)
        return ROTID_ERROR_MEMORY;
    c->dk_phi = vectors;
    c->dm_phi = vectors + images;
    c->rows = vectors + 2 * images;
    c->right = vectors + 3 * images;
    for (int i = 0; i < c->nmode; i++)
        memcpy(c->phi + (ptrdiff_t)i * n, c->functional.prediction.phi + (ptrdiff_t)c->mode[i].pair * n,
               (size_t)n * sizeof *c->phi);
    struct nelson_band nelson;
    int status = matrix_like(pool, k, &c->dk);
    if (!status)
        status = matrix_like(pool, k, &c->dm);
    if (!status)
        status = nelson_band_new(pool, k, most, &nelson);
    if (!status)
        nelson_band_begin(&nelson, k, &c->functional.prediction.m);
    for (int m = 0; m < c->nmode && !status; m++)
        if (like && m < like->nmode && are_alike(&c->mode[m], &like->mode[m]))
            c->mode[m].adjoint = like->mode[m].adjoint;
        else
            status = solve_adjoints(c, &nelson, zero, m_phi, unit, &c->mode[m]);
    return status;
}

/* takes the direction of the scale out of a column's part of one mode: the best scale follows every change */
static void project_scale(const struct columns_mode *mode, double *part)
{
    if (!(mode->square > 0))
        return;
    double along = product_dot(mode->sensors, mode->weighted, part) / mode->square;
    for (int i = 0; i < mode->sensors; i++)
        part[i] -= along * mode->weighted[i];
}

/* The derivative of the best scale also turns the residual itself: with r = a u - m, u = phi/s, a = u'm/u'u and du,
 * dr = a (I - P) du - u (du' r)/(u'u), where P projects on u. */
static void shape_part(const struct columns *c, const struct columns_mode *mode, double *dphi, const double *r, double *part)
{
    if (!mode->sensors) /* then there is no shape_std either */
        return;
    const double *std = c->measured.shape_std + (ptrdiff_t)mode->k * c->model.equations.nmaster;
    double along = 0;
    for (int i = 0; i < mode->sensors; i++) {
        dphi[i] /= std[mode->sensor[i]];
        along += dphi[i] * r[i];
        part[i] = mode->scale * dphi[i];
    }
    project_scale(mode, part);
    for (int i = 0; i < mode->sensors; i++)
        part[i] -= mode->weighted[i] * along / mode->square;
}

struct rows { /* that hold all there is in a matrix */
    int from, end;
};

static struct rows either(struct rows a, struct rows b)
{
    if (a.from == a.end || b.from == b.end)
        return a.from == a.end ? b : a;
    return (struct rows){a.from < b.from ? a.from : b.from, a.end > b.end ? a.end : b.end};
}

/* image [length * nmode] := the rows `all` of A times those of the modes; A, which occupies `own` of them, is zero again then */
static void take_image(const struct columns *c, rotid_matrix *a, struct rows own, struct rows all, double *image)
{
    rotid_matrix part;
    int length = all.end - all.from;
    if (own.from == own.end) {
        memset(image, 0, (size_t)length * (size_t)c->nmode * sizeof *image);
        return;
    }
    matrix_rows(a, all.from, length, &part);
    matrix_multiply(&part, c->nmode, c->rows, image);
    matrix_zero(&part);
}

/* What of a mode moves with dK and dM: dlambda, and dphi at its sensors: P by the adjoints, which do not see its middle part,
 * plus the parts along the cluster. P = -(dK - dlambda M - lambda dM) phi is local but for that part, to the rows
 * from..from + length - 1, of which dk_phi and dm_phi are. */
static double mode_derivative(struct columns *c, const struct columns_mode *mode, int from, int length, const double *dk_phi,
                              const double *dm_phi, double *dphi)
{
    const rotid_model *equations = &c->model.equations;
    const struct prediction *prediction = &c->functional.prediction;
    ptrdiff_t n = equations->n;
    double lambda = prediction->lambda[mode->pair];
    for (int i = 0; i < length; i++)
        c->right[i] = dk_phi[i] - lambda * dm_phi[i];
    product_combine(mode->sensors, length, -1, mode->adjoint + (ptrdiff_t)from * mode->sensors, c->right, dphi);
    for (int j = mode->first; j < mode->first + mode->members; j++) {
        const double *member = prediction->phi + j * n;
        double along = -0.5 * product_dot(length, member + from, dm_phi);
        for (int i = 0; i < mode->sensors; i++)
            dphi[i] += along * member[equations->master[mode->sensor[i]]];
    }
    return product_dot(length, prediction->phi + mode->pair * n + from, c->right);
}

/* dk_phi and dm_phi [length * nmode] := the rows of dK phi and dM phi that are not zero, by the matrices; weighed := the
 * derivatives of what was weighed */
static struct rows images_by_matrices(struct columns *c, int p, double *weighed)
{
    struct rows k, m;
    model_differentiate(&c->model, c->x, p, &c->dk, &c->dm, &k.from, &k.end);
    m = k;
    matrix_occupied(&c->dk, &k.from, &k.end);
    matrix_occupied(&c->dm, &m.from, &m.end);
    functional_whole_derivative(&c->functional, &c->dm, weighed);
    const struct rows rows = either(k, m);
    ptrdiff_t length = rows.end - rows.from, n = c->model.equations.n;
    for (int i = 0; i < c->nmode; i++)
        memcpy(c->rows + i * length, c->phi + i * n + rows.from, (size_t)length * sizeof *c->rows);
    take_image(c, &c->dk, k, rows, c->dk_phi);
    take_image(c, &c->dm, m, rows, c->dm_phi);
    return rows;
}

/* The same without matrices, dk_phi and dm_phi [n * nmode]. Returns 0 where that is impossible. */
static int images_by_products(struct columns *c, int p, struct rows *rows)
{
    return !c->functional.nwhole &&
           !model_derivative_products(&c->model, c->x, p, c->nmode, c->phi, c->dk_phi, c->dm_phi, &rows->from, &rows->end);
}

int columns_parameter(struct columns *c, int p, double *column)
{
    const struct prediction *prediction = &c->functional.prediction;
    struct rows rows;
    int row = c->nmode, whole = images_by_products(c, p, &rows);
    if (!whole)
        rows = images_by_matrices(c, p, column + c->nrow - c->functional.nwhole);
    ptrdiff_t length = rows.end - rows.from, leading = whole ? c->model.equations.n : length, first = whole ? rows.from : 0;
    for (int i = 0; i < c->nmode; i++) {
        const struct columns_mode *mode = &c->mode[i];
        ptrdiff_t at = first + i * leading;
        double dlambda = mode_derivative(c, mode, rows.from, (int)length, c->dk_phi + at, c->dm_phi + at, c->dphi),
               lambda = prediction->lambda[mode->pair];
        column[i] = dlambda / (2 * sqrt(lambda) * c->functional.omega[mode->k] * c->measured.frequency_std[mode->k]);
        shape_part(c, mode, c->dphi, c->r + row, column + row);
        row += mode->sensors;
    }
    return ROTID_OK;
}

int columns_probe(struct columns *c, const struct effect *effect)
{
    for (int i = 0; i < EFFECT_MOST_PARAMETERS; i++)
        c->x[c->job->unknowns.nparameter + i] = effect->value[i];
    return model_exchange_effect(c->pool, &c->model, effect);
}

int columns_residual(struct columns *c, const double *x, double *r)
{
    return functional_residual(&c->functional, x, r);
}
