/* The evidence of one explanation: Z = integral of the likelihood over all unknowns, weighed by their priors.
 *
 *   unknowns   u: ln x of the deck's parameters, uniform between their bounds; sizes, places and widths of causes in the unit of
 *              their prior (struct cause_parameter). About the fitted point, r the whitened residual, J = dr/du,
 *                  E(d) = |r + J d|^2/2 + sum P (d - m)^2/2,   N = J'J + P,   least E at d = -N^-1 (J'r - P m)
 *   Laplace    ln Z = -E - ln det N/2 + d ln 2 pi/2 + ln of the prior's factors + ln of the share of each marginal normal that
 *              lies between the bounds, which are the prior's edge: a size pressed against one needs no rule
 *   noise      factors e^a on the frequencies and e^b on the shapes, a, b normal about 0: N and E at 5 x 5 points about their
 *              modes (Gauss-Hermite); every row costs a or b
 *   else       a smooth random field in the shape of each mode and a free error of each frequency: covariance I + A^2 C, C of
 *              squared exponentials over the sensors, diagonalised once a mode; A log-uniform, apart for frequencies and shapes;
 *              unknowns and scales of the shapes are estimated in that metric
 *   columns    of the scan: one size, linear: the same integral in closed form at each place and width */
#include "diagnose/diagnose.h"

#define NOISE_STATED  0.15 /* deviation of ln of the noise: stated by the user, */
#define NOISE_ASSUMED 1.5  /* or assumed */
#define MISSTATED     0.1  /* probability that the stated noise of the shapes is wrong, */
#define MISTAKE       0.7  /* and the deviation of its ln then */
#define ELSE_LEAST    2.0  /* times the noise */
#define ELSE_MOST     1000.0
#define ELSE_SHAPES   16 /* amplitudes tried */
#define ELSE_LINES    8
#define PROFILE_SIZES 5    /* amplitudes tried, */
#define PROFILE_LEAST 0.02 /* of the relative change */
#define PROFILE_MOST  0.6
#define PROFILE_SCALE 0.08 /* correlation length, of the rotor's */
#define LEFT_OPEN     0.24 /* -ln of the share of a normal of deviation 1/sqrt(2 pi) between -1/2 and 1/2 */
#define LN_2          0.69314718055994531
#define ROOT_HALF     0.70710678118654752

double log_sum(double a, double b)
{
    double most = fmax(a, b), least = fmin(a, b);
    return isinf(most) ? most : most + log1p(exp(least - most));
}

/* ln of the share of a standard normal between two of its values, also far out in a tail. */
static double log_share(double lower, double upper)
{
    if (lower > 0) {
        double keep = lower;
        lower = -upper;
        upper = -keep;
    }
    if (!(lower < upper))
        return -INFINITY;
    if (upper > -5) {
        double share = 0.5 * (erfc(-upper * ROOT_HALF) - erfc(-lower * ROOT_HALF));
        return share > 0 ? log(share) : -INFINITY;
    }
    /* Mills' ratio: Phi(-t) = phi(t)/t (1 - 1/t^2 + 3/t^4) */
    double t = -upper, square = 1 / (t * t), width = -expm1(-(lower * lower - upper * upper) / 2);
    return -t * t / 2 - LN_2PI / 2 - log(t) + log1p(-square + 3 * square * square) + log(fmax(width, 1e-300));
}

/* ---- what is known of an unknown before */

struct unknown {
    int flat;            /* uniform over `range`, else normal of deviation 1 about `mean` */
    double step;         /* dx/du at the fitted point */
    double mean;         /* of the prior, from there */
    double lower, upper; /* bounds, from there */
    double precision;    /* of the prior: that of a uniform one makes sqrt(2 pi/precision) its range, so that what the data leave
                            open costs nothing */
    double density;      /* ln of its factor */
};

static struct unknown flat_unknown(double step, double lower, double upper)
{
    double range = upper - lower;
    return (struct unknown){
        .flat = 1, .step = step, .lower = lower, .upper = upper, .precision = 2 * PI / (range * range), .density = -log(range)};
}

/* Of a positive number by its logarithm. */
static struct unknown flat_log(double x, double lower, double upper)
{
    return flat_unknown(x, log(lower / x), log(upper / x));
}

static struct unknown normal_unknown(double x, double neutral, double deviation, double lower, double upper)
{
    struct unknown u = {.step = deviation,
                        .mean = (neutral - x) / deviation,
                        .lower = (lower - x) / deviation,
                        .upper = (upper - x) / deviation,
                        .precision = 1};
    u.density = -LN_2PI / 2 - log_share((lower - neutral) / deviation, (upper - neutral) / deviation);
    return u;
}

/* x > 0 is uniform in ln x over decades below its upper bound, and in x below their least one, with a density that is continuous:
 * uniform in t, x = least t up to t = 1, least e^(t - 1) from there on. */
static double decades_least(const struct cause_parameter *p, double upper)
{
    return upper * pow(10, -p->scale);
}

static double decades_range(const struct cause_parameter *p)
{
    return 1 + p->scale * log(10);
}

static double decades_value(const struct cause_parameter *p, double upper, double t)
{
    double least = decades_least(p, upper);
    return least * (t < 1 ? t : exp(t - 1));
}

/* Deviation of a normal prior. */
static double deviation_of(const struct cause_parameter *p, double lower, double upper)
{
    if (p->prior == PRIOR_GAUSSIAN)
        return p->scale;
    double below = p->neutral - lower, above = upper - p->neutral, far = fmax(below, above);
    return p->scale * (far > 0 ? far : upper - lower);
}

/* Parameter p of a cause at x. */
static struct unknown unknown_of_cause(const struct cause_kind *cause, int p, double x, double lower, double upper)
{
    const struct cause_parameter *parameter = &cause->parameter[p];
    if (p == cause->width && lower > 0)
        return flat_log(fmin(fmax(x, lower), upper), lower, upper);
    if (p == cause->place || p == cause->width || parameter->prior == PRIOR_FLAT)
        return flat_unknown(1, lower - x, upper - x);
    if (parameter->prior == PRIOR_LOG_FLAT) {
        double least = decades_least(parameter, upper), t = x < least ? x / least : 1 + log(x / least);
        return flat_unknown(fmax(x, least), -t, decades_range(parameter) - t);
    }
    if (parameter->prior == PRIOR_LOG_NORMAL) {
        double step = x * parameter->scale;
        struct unknown u = {.step = step,
                            .precision = 1,
                            .mean = -log(x / parameter->neutral) / parameter->scale,
                            .lower = log(lower / x) / parameter->scale,
                            .upper = log(upper / x) / parameter->scale};
        u.density = -LN_2PI / 2 - log_share(log(lower / parameter->neutral) / parameter->scale,
                                            log(upper / parameter->neutral) / parameter->scale);
        return u;
    }
    struct unknown near = normal_unknown(x, parameter->neutral, deviation_of(parameter, lower, upper), lower, upper);
    if (!(parameter->gross > 0))
        return near;
    struct unknown far = flat_unknown(1, lower - x, upper - x);
    near.density += log1p(-parameter->gross);
    far.density += log(parameter->gross);
    return far.density > near.density - near.mean * near.mean / 2 - log(near.step) ? far : near;
}

/* Unknown p of all at x. */
static struct unknown unknown_of(const struct states *states, int p, double x)
{
    double lower = states->bounds[p].lower, upper = states->bounds[p].upper;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        for (int q = 0; q < job->unknowns.nparameter; q++)
            if (state_unknown(&states->state[s], q) == p && job->unknowns.parameter[q].kind == PARAMETER_EFFECT) {
                const struct effect *effect = &job->rotor.effect[job->unknowns.parameter[q].index];
                return unknown_of_cause(catalogue_of(effect), job->unknowns.parameter[q].component, x, lower, upper);
            }
    }
    return lower > 0 && x > 0 ? flat_log(x, lower, upper)
                              : flat_unknown(upper - lower, (lower - x) / (upper - lower), (upper - x) / (upper - lower));
}

/* ---- the data */

/* shape, std [nsensor] of mode k of a state; position [nsensor], NULL: the field is white; length: over which it is smooth */
static int add_block(struct evidence_data *d, int state, int k, int nsensor, const double *shape, const double *std,
                     const double *position, double length)
{
    int count = 0;
    struct evidence_block *block = &d->block[d->nblock];
    int *sensor = POOL_ARRAY(d->pool, int, nsensor);
    double largest = 0;
    if (!sensor)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        if (isfinite(shape[s])) {
            largest = fmax(largest, fabs(shape[s]));
            sensor[count++] = s;
        }
    if (!count)
        return ROTID_OK;
    *block = (struct evidence_block){.row = d->nrow,
                                     .count = count,
                                     .state = state,
                                     .mode = k,
                                     .sensor = sensor,
                                     .vector = POOL_ARRAY(d->pool, double, (size_t)count *(size_t)count),
                                     .value = POOL_ARRAY(d->pool, double, 4 * (size_t)count)};
    if (!block->vector || !block->value)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++, d->nrow++) {
        d->noise[d->nrow] = std[sensor[i]];
        d->measured[d->nrow] = shape[sensor[i]] / largest / std[sensor[i]];
        for (int j = 0; j < count; j++) {
            double apart = position ? (position[sensor[i]] - position[sensor[j]]) / length : i != j ? INFINITY : 0;
            block->vector[i + (ptrdiff_t)j * count] = exp(-apart * apart / 2);
        }
    }
    d->nblock++;
    d->nscale++;
    return positive_spectrum(count, block->vector, block->value, block->value + count) ? ROTID_ERROR_LIBRARY : ROTID_OK;
}

static int data_new(struct pool *pool, int rows, int modes, struct evidence_data **out)
{
    struct evidence_data *d = *out = POOL_NEW(pool, struct evidence_data);
    if (!d)
        return ROTID_ERROR_MEMORY;
    *d = (struct evidence_data){.pool = pool,
                                .kind = POOL_ARRAY(pool, char, rows),
                                .noise = POOL_ARRAY(pool, double, rows),
                                .measured = POOL_ARRAY(pool, double, rows),
                                .block = POOL_ARRAY(pool, struct evidence_block, modes),
                                .deviation = NOISE_STATED};
    return d->kind && d->noise && d->measured && d->block ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static void add_line(struct evidence_data *d, double std)
{
    d->kind[d->nrow] = EVIDENCE_FREQUENCY;
    d->noise[d->nrow++] = std;
    d->nline++;
}

/* Behind those of the modes of a state. */
static void add_whole(struct evidence_data *d, double mass_std, double centre_std)
{
    for (int i = 0; i < 2; i++) {
        double std = i ? centre_std : mass_std;
        if (!(std > 0))
            continue;
        d->kind[d->nrow] = EVIDENCE_WHOLE;
        d->noise[d->nrow++] = std;
        d->nwhole++;
    }
}

int evidence_open_model(struct pool *pool, const rotid_measured *m, int nsensor, const double *position, double length,
                        struct evidence_data **out)
{
    int status = data_new(pool, m->nmode * (nsensor + 1) + 2, m->nmode, out);
    for (int k = 0; k < m->nmode && !status; k++)
        if (!m->holdout || !m->holdout[k])
            add_line(*out, m->frequency_std[k]);
    for (int k = 0; k < m->nmode && !status && m->shape; k++)
        if (!m->holdout || !m->holdout[k])
            status = add_block(*out, 0, k, nsensor, m->shape + (ptrdiff_t)k * nsensor, m->shape_std + (ptrdiff_t)k * nsensor,
                               position, 0.3 * length / (m->number[k] + 1));
    if (!status && (*out)->nline)
        add_whole(*out, m->mass_std, m->centre_std);
    return status;
}

int evidence_open(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                  struct evidence_data **out)
{
    int modes = states_modes(states, states->nstate), rows = modes + 2 * states->nstate, status = ROTID_OK;
    for (int s = 0; s < states->nstate; s++)
        rows += states->state[s].job.measurement.nmode * states->state[s].job.rotor.nsensor;
    double *position = POOL_ARRAY(pool, double, rows);
    status = position ? data_new(pool, rows, modes, out) : ROTID_ERROR_MEMORY;
    struct evidence_data *d = *out;
    for (int s = 0, mode = 0; s < states->nstate && !status; mode += states->state[s].job.measurement.nmode, s++) {
        const struct job *job = &states->state[s].job;
        int lines = d->nline;
        if (!job_knows_frequency_noise(job))
            d->deviation = NOISE_ASSUMED;
        d->is_floor |= job->measurement.has_noise_floor;
        for (int k = 0; k < job->measurement.nmode; k++)
            if (!holdout[mode + k])
                add_line(d, job->measurement.frequency_std[k]);
        for (int i = 0; i < job->rotor.nsensor; i++)
            position[i] = job->rotor.sensor[i].position;
        for (int k = 0; k < job->measurement.nmode && !status; k++)
            if (!holdout[mode + k] && job_fits_shapes(job))
                status = add_block(d, s, k, job->rotor.nsensor, job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor,
                                   job->measurement.shape_std + (ptrdiff_t)k * job->rotor.nsensor, position,
                                   0.3 * rotor_length(&job->rotor) / (number[mode + k] + 1)); /* half a wavelength */
        if (!status && d->nline > lines)
            add_whole(d, job->measurement.weighed.mass_std, job->measurement.weighed.centre_std);
    }
    return status;
}

/* ---- one explanation */

struct part { /* N [n * n], b = J'r [n] and r'r of the rows of one kind */
    double *normal, *b, square;
};

struct normal { /* at one noise */
    int n;
    const struct unknown *u;
    struct part part[EVIDENCE_KINDS];
    double *work, *step; /* [n * n], [n] */
};

/* -E, determinant and priors with weights on both parts; N^-1 is left in work, the step to the least E in step. -INFINITY where N
 * is not positive definite. */
static double integrate(struct normal *w, double line, double shape)
{
    int n = w->n;
    const struct part *f = &w->part[EVIDENCE_FREQUENCY], *s = &w->part[EVIDENCE_SHAPE], *whole = &w->part[EVIDENCE_WHOLE];
    double energy = (line * f->square + shape * s->square + whole->square) / 2, determinant, sum;
    for (int i = 0; i < n * n; i++)
        w->work[i] = line * f->normal[i] + shape * s->normal[i] + whole->normal[i];
    for (int i = 0; i < n; i++) {
        w->work[i + (ptrdiff_t)i * n] += w->u[i].precision;
        energy += w->u[i].precision * w->u[i].mean * w->u[i].mean / 2;
    }
    if (positive_invert(n, w->work, &determinant))
        return -INFINITY;
    for (int i = 0; i < n; i++) {
        w->step[i] = 0;
        for (int j = 0; j < n; j++)
            w->step[i] -= w->work[i + (ptrdiff_t)j * n] *
                          (line * f->b[j] + shape * s->b[j] + whole->b[j] - w->u[j].precision * w->u[j].mean);
    }
    for (int i = 0; i < n; i++)
        energy += w->step[i] * (line * f->b[i] + shape * s->b[i] + whole->b[i] - w->u[i].precision * w->u[i].mean) / 2;
    sum = -energy - determinant / 2 + n * LN_2PI / 2;
    for (int i = 0; i < n; i++) {
        const struct unknown *u = &w->u[i];
        double variance = w->work[i + (ptrdiff_t)i * n], mean = w->step[i], root = sqrt(variance),
               share = log_share((u->lower - mean) / root, (u->upper - mean) / root);
        /* of a uniform one that the data leave open the normal that stands for it lies beyond the bounds in part */
        sum += u->density + (u->flat ? fmin(0, share + LEFT_OPEN * variance * u->precision) : share);
    }
    return isfinite(sum) ? sum : -INFINITY;
}

/* ln of a normal at x, but for ln of its density at 0 with deviation 1. */
static double log_normal(double x, double deviation)
{
    return -x * x / (2 * deviation * deviation) - log(deviation);
}

/* ln of the integral over the unknowns at noise e^a and e^b times as stated, with the prior of a and b. */
static double integrate_at(const struct evidence_data *d, struct normal *w, double a, double b)
{
    if (d->is_floor && fmin(a, b) < 0)
        return -INFINITY;
    double wrong = fmax(MISTAKE, d->deviation),
           shapes =
               !d->nblock ? 0 : log_sum(log1p(-MISSTATED) + log_normal(b, d->deviation), log(MISSTATED) + log_normal(b, wrong));
    return integrate(w, exp(-2 * a), exp(-2 * b)) - d->nline * a - (d->nrow - d->nline - d->nwhole - d->nscale) * b +
           log_normal(a, d->deviation) + shapes;
}

/* Mode of a function of one factor, the other held, and the deviation about it, by points and a parabola. */
static double find_mode(const struct evidence_data *d, struct normal *w, int shape, double other, double *spread)
{
    double deviation = d->deviation, step = deviation / 2, at = 0,
           most = integrate_at(d, w, shape ? other : 0, shape ? 0 : other), value[2];
    for (int pass = 0; pass < 60; pass++) {
        for (int side = 0; side < 2; side++) {
            double x = at + (side ? step : -step);
            value[side] = integrate_at(d, w, shape ? other : x, shape ? x : other);
        }
        if (value[0] > most || value[1] > most) {
            int up = value[1] > value[0];
            at += up ? step : -step;
            most = value[up];
        } else if (step < deviation / 20 || 2 * most - value[0] - value[1] < 0.5) {
            break;
        } else {
            step /= 3;
        }
    }
    if (isinf(value[0])) /* at the floor */
        value[0] = value[1];
    double bend = (2 * most - value[0] - value[1]) / (step * step);
    *spread = bend > 0 ? fmin(deviation, 1 / sqrt(bend)) : deviation;
    return bend > 0 ? at + fmin(fmax((value[1] - value[0]) / (2 * step) / bend, -step), step) : at;
}

/* Over both factors of the noise; leaves N^-1 and the step at the mode. *one: at the stated noise. */
static double integrate_noise(const struct evidence_data *d, struct normal *w, double *one, double factor[2])
{
    static const double node[] = {-2.856970013872806, -1.355626179974266, 0, 1.355626179974266, 2.856970013872806};
    static const double weight[] = {0.011257411327720689, 0.22207592200561264, 0.53333333333333333, 0.22207592200561264,
                                    0.011257411327720689};
    double spread[2], sum = -INFINITY, b0 = 0;
    int shapes = d->nblock > 0;
    *one = integrate(w, 1, 1);
    if (shapes)
        b0 = find_mode(d, w, 1, 0, &spread[1]);
    double a0 = find_mode(d, w, 0, b0, &spread[0]);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < (shapes ? 5 : 1); j++) {
            double a = a0 + node[i] * spread[0], b = shapes ? b0 + node[j] * spread[1] : 0, z = integrate_at(d, w, a, b);
            z += node[i] * node[i] / 2 + log(weight[i] * spread[0]);
            z += shapes ? node[j] * node[j] / 2 + log(weight[j] * spread[1]) : 0;
            sum = log_sum(sum, z);
        }
    factor[0] = exp(a0);
    factor[1] = exp(b0);
    (void)integrate_at(d, w, a0, b0);
    return sum;
}

/* Adds some rows [m * (n + 1)], the last column the residual, with weights [m] or 1. */
static void gather(int m, int n, const double *rows, ptrdiff_t stride, const double *weight, struct part *to)
{
    for (int i = 0; i < m; i++) {
        double w = weight ? weight[i] : 1, r = rows[i + n * stride];
        to->square += w * r * r;
        for (int p = 0; p < n; p++) {
            double one = w * rows[i + p * stride];
            to->b[p] += one * r;
            for (int q = 0; q <= p; q++)
                to->normal[p + (ptrdiff_t)q * n] += one * rows[i + q * stride];
        }
    }
}

static void mirror(int n, double *a)
{
    for (int p = 0; p < n; p++)
        for (int q = 0; q < p; q++)
            a[q + (ptrdiff_t)p * n] = a[p + (ptrdiff_t)q * n];
}

static int normal_new(struct pool *pool, int n, const struct unknown *u, struct normal *w)
{
    size_t square = (size_t)n * (size_t)n + 1;
    *w = (struct normal){.n = n, .u = u, .work = POOL_ARRAY(pool, double, square), .step = POOL_ARRAY(pool, double, n + 1)};
    int missing = !w->work || !w->step;
    for (int k = 0; k < EVIDENCE_KINDS; k++) {
        w->part[k] = (struct part){POOL_ARRAY(pool, double, square), POOL_ARRAY(pool, double, n + 1), 0};
        missing |= !w->part[k].normal || !w->part[k].b;
    }
    return missing ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* One more normal of weight e^one into a mixture: out->mean [nown] its means, out->std the means of its squares, *weighed ln of
 * the weights so far. inverse [n * n] */
static void add_moments(double one, int nown, const double *mean, const double *inverse, int n, double *weighed,
                        struct evidence *out)
{
    double sum = log_sum(*weighed, one), share = exp(one - sum);
    for (int p = 0; p < nown && isfinite(one); p++) {
        out->mean[p] += share * (mean[p] - out->mean[p]);
        out->std[p] += share * (mean[p] * mean[p] + inverse[p + (ptrdiff_t)p * n] - out->std[p]);
    }
    *weighed = sum;
}

/* ln Z with something else beside the causes. rows [nrow * (n + 1)], rotated here into the fields' eigenvectors; the scale of
 * each shape is one more unknown, whose column is the predicted shape. known: amplitudes of lines and shapes, relative to a
 * frequency and to the largest component; NULL: the grid of something else, over which the steps and the
 * squares of the first nown unknowns are averaged in out->mean and out->std. */
static int with_field(const struct evidence_data *d, struct pool *pool, int n, const struct unknown *u, const double *rows,
                      const double *known, int nprofile, int nown, struct evidence *out, double *weighed, double *log_z)
{
    int shapes = known || !d->nblock ? 1 : ELSE_SHAPES, lines = known ? 1 : ELSE_LINES, sizes = nprofile ? PROFILE_SIZES : 1;
    int none = nprofile && !known; /* fields of amplitude 0 too, and every second one of the others */
    int fields = ((lines + 1) / 2 + 1) * (d->nblock ? (shapes + 1) / 2 + 1 : 1) - 1;
    int total = n + d->nblock, nrow = d->nrow;
    struct normal w;
    struct unknown *all = POOL_ARRAY(pool, struct unknown, total);
    double *turned = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(total + 1)), *weight = POOL_ARRAY(pool, double, nrow),
           z = -INFINITY;
    int status = !all || !turned || !weight ? ROTID_ERROR_MEMORY : normal_new(pool, total, all, &w);
    if (status)
        return status;
    memcpy(all, u, (size_t)n * sizeof *u);
    memset(turned, 0, (size_t)nrow * (size_t)(total + 1) * sizeof *turned);
    for (int i = 0; i < nrow; i++)
        for (int p = 0; p <= n && d->kind[i] != EVIDENCE_SHAPE; p++)
            turned[i + (ptrdiff_t)(p < n ? p : total) * nrow] = rows[i + (ptrdiff_t)p * nrow];
    for (int k = 0; k < d->nblock; k++) {
        const struct evidence_block *block = &d->block[k];
        double length = 0, *scale = turned + (ptrdiff_t)(n + k) * nrow + block->row;
        for (int i = 0; i < block->count; i++) {
            double predicted = rows[block->row + i + (ptrdiff_t)n * nrow] + d->measured[block->row + i];
            length += predicted * predicted;
        }
        /* the scale is known without a field to 1/|u|; so much that det N has no part of it then */
        all[n + k] =
            (struct unknown){.flat = 1, .step = 1, .lower = -1e9, .upper = 1e9, .precision = 1e-9, .density = -LN_2PI / 2};
        for (int j = 0; j < block->count; j++) {
            const double *vector = block->vector + (ptrdiff_t)j * block->count;
            for (int i = 0; i < block->count; i++) {
                const double *row = rows + block->row + i;
                for (int p = 0; p <= n; p++)
                    turned[block->row + j + (ptrdiff_t)(p < n ? p : total) * nrow] += vector[i] * row[(ptrdiff_t)p * nrow];
                scale[j] += vector[i] * (row[(ptrdiff_t)n * nrow] + d->measured[block->row + i]) / sqrt(length > 0 ? length : 1);
            }
        }
    }
    double step_shape = d->nblock ? log(ELSE_MOST / ELSE_LEAST) / (ELSE_SHAPES - 1) : 0,
           step_line = log(ELSE_MOST / ELSE_LEAST) / (ELSE_LINES - 1);
    double known_lines = 0; /* half ln det of what is known of the frequencies */
    for (int i = 0; i < nrow; i++)
        if (d->kind[i] != EVIDENCE_SHAPE) {
            double more = known && d->kind[i] == EVIDENCE_FREQUENCY ? known[0] / d->noise[i] : 0, square = 1 / (1 + more * more);
            gather(1, total, turned + i, nrow, &square, &w.part[(int)d->kind[i]]);
            known_lines -= log(square) / 2;
        }
    mirror(total, w.part[EVIDENCE_FREQUENCY].normal);
    mirror(total, w.part[EVIDENCE_WHOLE].normal);
    struct part *of_shapes = &w.part[EVIDENCE_SHAPE];
    for (int a = none && d->nblock ? -1 : 0; a < shapes; a += none ? 2 : 1) {
        double amplitude = a < 0 ? 0 : ELSE_LEAST * exp(a * step_shape), determinant = 0;
        memset(of_shapes->normal, 0, (size_t)total * (size_t)total * sizeof *of_shapes->normal);
        memset(of_shapes->b, 0, (size_t)total * sizeof *of_shapes->b);
        of_shapes->square = 0;
        for (int k = 0; k < d->nblock; k++)
            for (int i = 0; i < d->block[k].count; i++) {
                double one = known ? known[1] / d->noise[d->block[k].row] : amplitude,
                       more = one * one * fmax(0, d->block[k].value[i]);
                weight[d->block[k].row + i] = 1 / (1 + more);
                determinant += log1p(more) / 2;
            }
        for (int k = 0; k < d->nblock; k++)
            gather(d->block[k].count, total, turned + d->block[k].row, nrow, weight + d->block[k].row, of_shapes);
        mirror(total, of_shapes->normal);
        for (int c = 0; c < sizes; c++) {
            double size = PROFILE_LEAST * pow(PROFILE_MOST / PROFILE_LEAST, (double)c / (PROFILE_SIZES - 1));
            for (int p = n - nprofile; p < n; p++) {
                all[p].precision = 1 / (size * size);
                all[p].density = -log(size) - LN_2PI / 2;
            }
            for (int b = none ? -1 : 0; b < lines; b += none ? 2 : 1) {
                double line = b < 0 ? 0 : ELSE_LEAST * exp(b * step_line), square = known ? 1 : 1 / (1 + line * line),
                       one = integrate(&w, square, 1) - determinant - (known ? known_lines : -d->nline * log(square) / 2);
                if (none) /* one half without */
                    one -= (a < 0 || !d->nblock) && b < 0 ? 0 : log(fields);
                z = log_sum(z, one);
                if (nown)
                    add_moments(one, nown, w.step, w.work, total, weighed, out);
            }
        }
    }
    *log_z = z - (none ? log(2.0 * sizes) : log((double)lines * shapes));
    return ROTID_OK;
}

int evidence_profile(const struct scan *scan, const struct states *states, const struct cause_kind *cause, double *column)
{
    const struct scan_candidate *c = NULL;
    for (int i = 0; i < scan->ncandidate && !c; i++)
        if (scan->candidate[i].cause == cause && scan_is_field(&scan->candidate[i]) && scan->candidate[i].count > 2)
            c = &scan->candidate[i];
    if (!c)
        return 0;
    const struct rotor *rotor = &states->state[c->home].job.rotor;
    double length = rotor_length(rotor), sum = 0, share[EVIDENCE_PROFILE_TERMS];
    int step = 1;
    while (step < c->count &&
           scan->item[c->first + step].effect.value[cause->place] <= scan->item[c->first].effect.value[cause->place])
        step++;
    for (int k = 0; k < EVIDENCE_PROFILE_TERMS; k++)
        sum += share[k] = exp(-pow(k * PI * PROFILE_SCALE, 2) / 2);
    memset(column, 0, (size_t)scan->nrow * EVIDENCE_PROFILE_TERMS * sizeof *column);
    for (int i = 0; i < c->count; i += step) {
        const struct scan_item *item = &scan->item[c->first + i];
        double z = item->effect.value[cause->place], before = i >= step ? item[-step].effect.value[cause->place] : z,
               after = i + step < c->count ? item[step].effect.value[cause->place] : z, span = (after - before) / 2;
        double amount =
            cause->width >= 0 ? span / (item->effect.value[cause->width] * sqrt(2 * PI)) : span / length * rotor_mass(rotor);
        if (!item->usable)
            continue;
        const double *one = scan->column + (ptrdiff_t)(c->first + i) * scan->nrow;
        for (int k = 0; k < EVIDENCE_PROFILE_TERMS; k++) {
            double factor = amount * item->norm / item->unit * sqrt(2 * share[k] / sum) * cos(k * PI * z / length);
            for (int j = 0; j < scan->nrow; j++)
                column[j + (ptrdiff_t)k * scan->nrow] += factor * one[j];
        }
    }
    return EVIDENCE_PROFILE_TERMS;
}

/* ln Z with something else: fields over the sensors alone, or small ones and fields of stiffness, of mass or of both along the
 * rotor. */
static int something_else(const struct evidence_data *d, struct pool *pool, const struct states *states, const struct scan *scan,
                          int n, const struct unknown *u, const double *rows, int nown, struct evidence *out)
{
    int nrow = d->nrow, most_columns = n + 2 * EVIDENCE_PROFILE_TERMS, tried = 1;
    double weighed = -INFINITY, sum;
    struct unknown *all = POOL_ARRAY(pool, struct unknown, most_columns);
    double *more = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(most_columns + 1));
    if (!all || !more)
        return ROTID_ERROR_MEMORY;
    int status = with_field(d, pool, n, u, rows, NULL, 0, nown, out, &weighed, &sum);
    memcpy(all, u, (size_t)n * sizeof *u);
    memcpy(more, rows, (size_t)nrow * (size_t)n * sizeof *rows);
    for (int p = n; p < most_columns; p++)
        all[p] = (struct unknown){.step = 1, .lower = -1e9, .upper = 1e9};
    for (int kinds = 1; kinds < 4 && !status && states && scan->nrow == nrow; kinds++) {
        int count = 0;
        for (int k = 0; k < 2; k++)
            if (kinds & 1 << k)
                count += evidence_profile(scan, states, catalogue_find(k ? "added_mass" : "stiffness_local"),
                                          more + (ptrdiff_t)(n + count) * nrow);
        double one;
        if (!count)
            continue;
        memcpy(more + (ptrdiff_t)(n + count) * nrow, rows + (ptrdiff_t)n * nrow, (size_t)nrow * sizeof *rows);
        status = with_field(d, pool, n + count, all, more, NULL, count, nown, out, &weighed, &one);
        sum = log_sum(sum, one);
        tried++;
    }
    out->log_else = sum - log(tried);
    for (int p = 0; p < nown && !status; p++)
        out->std[p] = sqrt(fmax(0, out->std[p] - out->mean[p] * out->mean[p]));
    return status;
}

/* Into mean and deviation a share of what has another mean and mean of its squares. */
static void mix_moments(double share, double mean, double square, double *to_mean, double *to_std)
{
    double before = *to_mean * *to_mean + *to_std * *to_std;
    *to_mean += share * (mean - *to_mean);
    *to_std = sqrt(fmax(0, before + share * (square - before) - *to_mean * *to_mean));
}

/* Rows in units of the unknowns; u [n + 1] is filled, extra columns are those of the faults. */
static void take_rows(const struct evidence_data *d, const rotid_fit_result *fit, int nfault, const struct fault_column *fault,
                      const struct unknown *u, double *rows)
{
    int n = fit->n + nfault, nrow = d->nrow;
    for (int p = 0; p <= n; p++) {
        const double *column = p == n ? fit->r : p < fit->n ? fit->jacobian + (ptrdiff_t)p * nrow : fault[p - fit->n].column;
        for (int i = 0; i < nrow; i++)
            rows[i + (ptrdiff_t)p * nrow] = p < n ? u[p].step * column[i] : column[i];
    }
}

/* What the line at the end of a fit promises and no step along it brought, as where two modes veer, is no evidence: it is taken
 * out of the residual, the last of rows [nrow * (n + 1)]. *sum: its square, 0 for a fit that ended at a minimum. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
static int take_promise(const rotid_fit_result *fit, struct pool *pool, int nrow, int n, double *rows, double *sum)
{
    *sum = 0;
    if (fit->converged)
        return ROTID_OK;
    double *basis = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(fit->n + 1));
    if (!basis)
        return ROTID_ERROR_MEMORY;
    *sum = basis_remove(nrow, basis_add(nrow, fit->n, rows, 1e-10, 0, basis), basis, rows + (ptrdiff_t)n * nrow);
    return ROTID_OK;
}

/* ln Z of a fit in units of its unknowns u, those of the fault [nfault] behind them; the first nown are the deck's, moments of
 * which go to out->mean and out->std in those units. known: what approximations leave of a frequency and of a shape. states,
 * scan: of something else, NULL scan: not asked for. */
static int evidence_in_units(const struct evidence_data *d, struct pool *pool, const rotid_fit_result *fit,
                             const struct unknown *u, int nown, const double known[2], const struct states *states,
                             const struct scan *scan, int with_else, int nfault, struct fault_column *fault, struct evidence *out)
{
    struct normal w;
    int n = fit->n + nfault, nrow = d->nrow;
    double field, promise, *rows = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(n + 1));
    if (!rows)
        return ROTID_ERROR_MEMORY;
    take_rows(d, fit, nfault, fault, u, rows);
    int status = take_promise(fit, pool, nrow, n, rows, &promise);
    if (!status)
        status = normal_new(pool, n, u, &w);
    for (int i = 0; i < nrow && !status; i++)
        gather(1, n, rows + i, nrow, NULL, &w.part[(int)d->kind[i]]);
    if (status)
        return status;
    for (int k = 0; k < EVIDENCE_KINDS; k++)
        mirror(n, w.part[k].normal);
    out->log_z = integrate_noise(d, &w, &out->log_stated, out->noise) - promise / 2;
    out->log_stated -= promise / 2;
    out->log_exact = out->log_stated;
    for (int p = 0; p < nown; p++) {
        out->mean[p] = w.step[p];
        out->std[p] = sqrt(w.work[p + (ptrdiff_t)p * n]);
    }
    for (int f = 0, p = n - nfault; f < nfault; f++, p++) {
        fault[f].step = u[p].step * w.step[p];
        fault[f].std = fabs(u[p].step) * sqrt(w.work[p + (ptrdiff_t)p * n]);
    }
    if (known[0] > 0 || known[1] > 0) { /* what an approximation leaves: nothing, or as much as is known of it */
        double *mean = POOL_ARRAY(pool, double, 2 * (size_t)nown + 1), weighed = -INFINITY;
        struct evidence with = {.mean = mean, .std = mean + nown};
        if (!mean)
            return ROTID_ERROR_MEMORY;
        status = with_field(d, pool, n, u, rows, known, 0, nown, &with, &weighed, &field);
        field -= promise / 2;
        for (int p = 0; p < nown && !status && isfinite(field); p++)
            mix_moments(exp(field - log_sum(out->log_z, field)), with.mean[p], with.std[p], &out->mean[p], &out->std[p]);
        out->log_z = log_sum(out->log_z, field) - LN_2;
        out->log_stated = log_sum(out->log_stated, field) - LN_2;
    }
    out->log_else = -INFINITY;
    if (status || !with_else)
        return status;
    memset(out->mean, 0, (size_t)nown * sizeof *out->mean);
    memset(out->std, 0, (size_t)nown * sizeof *out->std);
    status = something_else(d, pool, states, scan, n, u, rows, nown, out);
    out->log_else -= promise / 2;
    return status;
}

static struct unknown unknown_of_prior(const struct model_prior *prior, double x)
{
    if (prior->deviation > 0)
        return normal_unknown(x, prior->neutral, prior->deviation, prior->lower, prior->upper);
    return prior->lower > 0 ? flat_log(x, prior->lower, prior->upper) : flat_unknown(1, prior->lower - x, prior->upper - x);
}

int evidence_of_model(const struct evidence_data *d, const struct model_prior *prior, int nown, const rotid_fit_result *fit,
                      int with_else, struct evidence *out)
{
    struct pool pool;
    const double known[2] = {0, 0};
    if (fit->nresidual != d->nrow)
        return ROTID_ERROR_ARGUMENT;
    pool_open(&pool, d->pool->allocator);
    struct unknown *u = POOL_ARRAY(&pool, struct unknown, fit->n + 1);
    int status = u ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int p = 0; p < fit->n && !status; p++)
        u[p] = unknown_of_prior(&prior[p], fit->x[p]);
    if (!status)
        status = evidence_in_units(d, &pool, fit, u, nown, known, NULL, NULL, with_else, 0, NULL, out);
    for (int p = 0; p < nown && !status; p++) {
        out->mean[p] = fmin(fmax(fit->x[p] + u[p].step * out->mean[p], prior[p].lower), prior[p].upper);
        out->std[p] *= fabs(u[p].step);
    }
    pool_close(&pool);
    return status;
}

int evidence_of_fit(const struct evidence_data *d, const struct states *states, int nown, const rotid_fit_result *fit,
                    int nmember, const struct candidate *member, int nfault, struct fault_column *fault,
                    const struct scan *else_scan, struct evidence *out)
{
    struct pool pool;
    int n = fit->n + nfault;
    if (fit->nresidual != d->nrow)
        return ROTID_ERROR_ARGUMENT;
    pool_open(&pool, d->pool->allocator);
    struct unknown *u = POOL_ARRAY(&pool, struct unknown, n + 1);
    double known[2] = {0, 0};
    int status = u ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int p = 0; p < n && !status; p++) {
        const struct fault_column *f = p < fit->n ? NULL : fault + p - fit->n;
        u[p] = f ? unknown_of_cause(f->cause, f->parameter, f->value, f->lower, f->upper) : unknown_of(states, p, fit->x[p]);
    }
    for (int m = 0; m < nmember; m++) {
        known[0] = hypot(known[0], member[m].cause->discrepancy_frequency);
        known[1] = hypot(known[1], member[m].cause->discrepancy_shape);
    }
    if (!status)
        status = evidence_in_units(d, &pool, fit, u, nown, known, states, else_scan, else_scan != NULL, nfault, fault, out);
    for (int p = 0; p < nown && !status; p++) {
        double x = fit->x[p] + u[p].step * out->mean[p];
        out->mean[p] = fmin(fmax(x, states->bounds[p].lower), states->bounds[p].upper);
        out->std[p] *= fabs(u[p].step);
    }
    pool_close(&pool);
    return status;
}

/* ---- a column of the scan */

/* along: minus the product of the column and the residual */
static double gain_of_item(const struct scan *scan, const struct rotor *rotor, int i, double along)
{
    const struct scan_item *item = &scan->item[i];
    const struct scan_candidate *c = &scan->candidate[item->candidate];
    const struct cause_kind *cause = c->cause;
    const struct cause_parameter *size = &cause->parameter[cause->size];
    double lower = 0, upper = 1, square = item->norm * item->norm;
    if (!item->usable)
        return 0;
    if (!cause_has_free_size(cause, c->fixed))
        return along - square / 2;
    cause_bounds(cause, rotor, &item->effect, cause->size, &lower, &upper);
    if (size->prior == PRIOR_LOG_FLAT || size->prior == PRIOR_FLAT) { /* by points over it */
        double sum = -INFINITY;
        const int points = 24;
        for (int j = 0; j < points; j++) {
            double share = (j + 0.5) / points,
                   x = size->prior == PRIOR_FLAT ? lower + share * (upper - lower)
                                                 : decades_value(size, upper, share * decades_range(size)),
                   a = (x - size->neutral) / item->unit;
            sum = log_sum(sum, along * a - square * a * a / 2);
        }
        return sum - log(points);
    }
    double deviation = (size->prior == PRIOR_LOG_NORMAL ? size->scale * size->neutral : deviation_of(size, lower, upper)) /
                       fabs(item->unit),
           precision = square + 1 / (deviation * deviation), mean = along / precision, root = sqrt(precision);
    return along * mean / 2 - log(precision * deviation * deviation) / 2 +
           log_share((item->lower - mean) * root, (item->upper - mean) * root) -
           log_share(item->lower / deviation, item->upper / deviation);
}

double evidence_of_item(const struct scan *scan, const struct rotor *rotor, int i)
{
    const struct scan_item *item = &scan->item[i];
    return gain_of_item(scan, rotor, i, -item->norm * product_dot(scan->nrow, scan->column + (ptrdiff_t)i * scan->nrow, scan->r));
}

#define STEPS 20 /* of a search that takes four */

/* ln Z rises by nearly half of what the drop does, less what the range of the size costs. */
double evidence_drop_for(const struct scan *scan, const struct rotor *rotor, int i, double gain)
{
    const struct scan_item *item = &scan->item[i];
    const struct scan_candidate *c = &scan->candidate[item->candidate];
    int is_known = !cause_has_free_size(c->cause, c->fixed);
    double drop = 2 * fmax(gain, 0), missing = INFINITY, most = item->norm * fmax(item->upper, -item->lower);
    for (int k = 0; k < STEPS && fabs(missing) > 1e-3 && item->usable && !is_known && sqrt(drop) < most; k++) {
        missing = gain - gain_of_item(scan, rotor, i, scan_side(item) * item->norm * sqrt(drop));
        drop = fmax(0, drop + 2 * missing);
    }
    return drop;
}
