#include "running/running.h"

#define STEP        1e-4 /* of a logarithm, on both sides: differences of matrices to 1e-8 */
#define REDRAWS     1000 /* until a draw lies within the bounds */
#define FARTHEST    0.5  /* change of a critical speed in one step of a prediction */
#define LEAST_DRAWS 20
#define RESPONSES   400   /* draws of which the response is computed */
#define FEWER       8     /* modes of the basis of these */
#define WEAK        0.002 /* damping ratio up to which modes above twice the running range are watched for growth */
#define MOST        0.5   /* of the decay of a mode lost by the prediction: until then the draw does not solve for that mode */

/* One uncertain number. Drawn is its logarithm, or where it may be zero itself. */
enum source_kind { SOURCE_MODULUS, SOURCE_BEARING_K, SOURCE_BEARING_C, SOURCE_LOSS, SOURCE_PULL, SOURCE_CHANGE };

struct source {
    enum source_kind kind;
    int index, name; /* name: of the shares, sources of one name count as one */
    int is_logarithm;
    double std;      /* of what is drawn; of moduli the covariance says it */
    const char *own; /* its own name */
};

struct bands {
    struct pool *pool;
    struct search *search; /* the nominal machine */
    const struct machine *machine;
    const rotid_fit_result *fit; /* of the unknowns of the machine */
    const struct speeds_options *options;
    const rotid_environment *environment;
    int ncritical, nsource, nmodulus, nname;
    const struct critical *critical;
    const struct tracks *tracks; /* NULL: those of the search say nothing here */
    struct source *source;
    const char **name;
    double *factor;           /* [nmodulus^2] Cholesky factor of the covariance of what is drawn */
    double *derivative;       /* [nsource * ncritical] d W/W by what is drawn */
    double complex *campbell; /* [nsource * nspeed * nmode] d lambda of the tracks */
    double *map;              /* [nsource * columns * nmap] d W/W of the map */
    double *draw;             /* [nsource * draws] deviations from the nominal */
    double *speed;            /* [draws * ncritical] NaN where none was found */
    double *ratio;            /* [draws * ncritical] damping ratio there */
    const rotid_speeds *out;
    int responses;   /* draws of which there is a response */
    float *response; /* [responses * nspeed * nprobe] amplitude */
    int nwatched;
    struct pair *watched;  /* at the highest running speed */
    double complex *drift; /* [nsource * nwatched] d lambda of these */
    double *growth;        /* [draws] largest real part over |lambda| */
};

/* ---- what is uncertain */

static void add_source(struct bands *b, enum source_kind kind, int index, int is_logarithm, double std, const char *name,
                       const char *parameter)
{
    int own = 0;
    while (own < b->nname && name && strcmp(b->name[own], name) != 0)
        own++;
    if (!(std > 0) || !name)
        return;
    b->name[own] = name;
    b->nname += own == b->nname;
    b->source[b->nsource++] = (struct source){kind, index, own, is_logarithm, std, parameter};
}

static int find_sources(struct bands *b)
{
    const struct machine *machine = b->machine;
    const struct job *job = b->search->job;
    int n = machine_unknowns(machine, job), most = n + 2 * machine->nbearing + machine->nloss + machine->npull + machine->nchange;
    b->source = POOL_ARRAY(b->pool, struct source, most);
    b->name = POOL_ARRAY(b->pool, const char *, most + 1);
    if (!b->source || !b->name)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n && b->fit; p++)
        if (isfinite(b->fit->std[p]) && machine_has_unknown(machine, job, p))
            add_source(b, SOURCE_MODULUS, p, machine_by_logarithm(machine, job, p), b->fit->std[p], "identified",
                       machine_bounds(machine, job, p)->name);
    b->nmodulus = b->nsource;
    for (int i = 0; i < machine->nbearing; i++) {
        const struct bearing *own = &machine->bearing[i];
        const char *name = own->name ? pool_format(b->pool, "bearing %s", own->name) : pool_format(b->pool, "bearing %d", i + 1);
        if (own->like != i || !name)
            continue;
        /* what was identified has its deviation from the fit, in place of the one that was stated before it */
        for (int d = 0; d < 2; d++)
            if (!b->fit || own->unknown[d] < 0)
                add_source(b, d ? SOURCE_BEARING_C : SOURCE_BEARING_K, i, 1, own->std[d], name,
                           pool_format(b->pool, "%s.%c", name + strlen("bearing "), d ? 'c' : 'k'));
    }
    for (int i = 0; i < machine->nloss; i++) {
        const char *name = pool_format(b->pool, "loss %s", job->rotor.group[machine->loss[i].group].name);
        add_source(b, SOURCE_LOSS, i, 0, machine->loss[i].std, name, name);
    }
    for (int i = 0; i < machine->npull; i++) {
        const char *name = pool_format(b->pool, "pull %s", job->rotor.group[machine->pull[i].group].name);
        add_source(b, SOURCE_PULL, i, 1, machine->pull[i].std, name, name);
    }
    for (int i = 0; i < machine->nchange; i++) {
        const char *name = pool_format(b->pool, "change %s", machine->change[i].name);
        add_source(b, SOURCE_CHANGE, i, 1, machine->change[i].std, name, name);
    }
    return b->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static double covariance(const struct bands *b, int i, int j)
{
    return machine_covariance(b->machine, b->search->job, b->fit, b->source[i].index, b->source[j].index);
}

static int factor_covariance(struct bands *b)
{
    int n = b->nmodulus;
    b->factor = POOL_ARRAY(b->pool, double, (size_t)n *(size_t)n);
    if (!b->factor)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            b->factor[i + (ptrdiff_t)n * j] = covariance(b, i, j) * (i == j ? 1 + 1e-12 : 1);
    return cholesky_factor(n, b->factor) ? ROTID_ERROR_FINITE : ROTID_OK;
}

/* ---- values */

static int values_new(struct pool *pool, const struct bands *b, struct machine_values *values, double **x)
{
    int n = machine_unknowns(b->machine, b->search->job);
    *x = POOL_ARRAY(pool, double, n + 1);
    if (!*x)
        return ROTID_ERROR_MEMORY;
    return machine_nominal(pool, b->machine, *x, values);
}

/* The values at deviations d [nsource] times `part`. */
static void set_values(const struct bands *b, const double *d, double part, double *x, struct machine_values *values)
{
    const struct machine *machine = b->machine;
    memcpy(x, b->search->values.x, (size_t)machine_unknowns(machine, b->search->job) * sizeof *x);
    for (int j = 0; j < b->nsource; j++) {
        const struct source *source = &b->source[j];
        double by = exp(part * d[j]);
        int i = source->index;
        switch (source->kind) {
        case SOURCE_MODULUS:
            x[i] = source->is_logarithm ? x[i] * by : x[i] + part * d[j];
            break;
        case SOURCE_BEARING_K:
        case SOURCE_BEARING_C:
            for (int other = i; other < machine->nbearing; other++)
                if (machine->bearing[other].like == i)
                    *(source->kind == SOURCE_BEARING_K ? &values->bearing_k[other] : &values->bearing_c[other]) = by;
            break;
        case SOURCE_LOSS:
            values->loss[i] = machine->loss[i].value > 0 ? 1 + part * d[j] / machine->loss[i].value : 1;
            break;
        case SOURCE_PULL:
            values->pull[i] = by;
            break;
        case SOURCE_CHANGE:
            values->change[i] = by;
            break;
        }
    }
}

/* ---- derivatives */

/* Those of one source, by the machines on both sides of it, `apart` in what is drawn. work [2 size^2 + 2 size] */
static void differentiate_one(struct bands *b, int j, struct system side[2], double apart, double complex *work)
{
    struct system nominal = b->search->system;
    const struct tracks *t = b->tracks;
    double h = b->options->harmonic;
    for (int i = 0; i < b->ncritical; i++) {
        const struct critical *c = &b->critical[i];
        b->derivative[j + (ptrdiff_t)b->nsource * i] = critical_rate(&nominal, side, apart, h, c, work) / c->speed;
    }
    for (int i = 0; t && i < t->nspeed; i++)
        for (int m = 0; m < t->nmode; m++) {
            const struct pair *pair = track_at(t, m, i);
            double w = cimag(pair->lambda);
            if (isfinite(w))
                b->campbell[j + (ptrdiff_t)b->nsource * (i + (ptrdiff_t)t->nspeed * m)] =
                    pair_difference(&nominal, side, apart, t->speed[i], w > t->speed[i] ? 1 : -1, pair, work);
        }
    for (int i = 0; i < b->nwatched; i++) {
        const struct pair *pair = &b->watched[i];
        double high = b->machine->high;
        b->drift[j + (ptrdiff_t)b->nsource * i] =
            pair_difference(&nominal, side, apart, high, cimag(pair->lambda) > high ? 1 : -1, pair, work);
    }
    if (!b->out)
        return;
    for (int i = 0; i < b->ncritical; i++) {
        const struct critical *c = &b->critical[i];
        rotid_speed_sensitivity *to = &b->out->critical_speeds[i].sensitivities[j];
        const rotid_response_peak *peak = speeds_peak(b->machine, &b->out->critical_speeds[i]);
        int probe = 0;
        while (peak && probe + 1 < b->machine->nprobe && strcmp(peak->probe, b->machine->probe[probe].name) != 0)
            probe++;
        /* delta = -2 pi Re/Im along the critical speed, which moves: d lambda = lambda,p + lambda,W dW/dp */
        to->speed = b->derivative[j + (ptrdiff_t)b->nsource * i];
        double complex rate = pair_difference(&nominal, side, apart, c->speed, critical_side(h), &c->pair, work);
        rate += pair_rate(&nominal, &c->pair) * to->speed * c->speed;
        double w = cimag(c->pair.lambda);
        to->parameter = b->source[j].own;
        to->log_decrement = -2 * PI * (creal(rate) - creal(c->pair.lambda) * cimag(rate) / w) / w;
        to->amplitude = peak ? response_rate(&nominal, side, apart, probe, peak->speed_rpm * RPM, work) : (double)NAN;
    }
    for (int row = 0; row < b->out->nmap; row++)
        for (int i = 0; i < b->out->map[row].nspeed_rpm && b->source[j].kind != SOURCE_BEARING_K; i++)
            b->map[j + (ptrdiff_t)b->nsource * (i + (ptrdiff_t)nominal.columns * row)] = map_rate(
                &nominal, side, apart, b->out->map[row].speed_rpm[i] * RPM, b->search->map[row] + (ptrdiff_t)nominal.columns * i);
}

static int differentiate(struct bands *b)
{
    size_t n = (size_t)b->nsource, tracks = b->tracks ? (size_t)b->tracks->nspeed * (size_t)b->tracks->nmode : 0,
           map = b->out ? (size_t)b->search->system.columns * (size_t)b->out->nmap : 0, size = (size_t)b->search->system.size;
    b->derivative = POOL_ARRAY(b->pool, double, n *(size_t)b->ncritical);
    b->campbell = POOL_ARRAY(b->pool, double complex, n *tracks);
    b->map = POOL_ARRAY(b->pool, double, n *map);
    b->drift = POOL_ARRAY(b->pool, double complex, n *(size_t)b->nwatched);
    int status = b->derivative && b->campbell && b->map && b->drift ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int i = 0; b->out && i < b->ncritical && !status; i++) {
        rotid_critical_speed *to = &b->out->critical_speeds[i];
        to->nsensitivities = POOL_LIST(b->pool, to->sensitivities, b->nsource);
        status = to->nsensitivities ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    for (int j = 0; j < b->nsource && !status; j++) {
        struct pool scratch;
        struct system side[2];
        struct machine_values values[2];
        double *x, *d, step = b->source[j].is_logarithm ? STEP : STEP * fmax(b->source[j].std, 1e-12);
        int failed;
        pool_open(&scratch, b->pool->allocator);
        d = POOL_ARRAY(&scratch, double, b->nsource);
        double complex *work = POOL_ARRAY(&scratch, double complex, 2 * size * size + 2 * size);
        status = d && work ? ROTID_OK : ROTID_ERROR_MEMORY;
        for (int i = 0; i < 2 && !status; i++) {
            status = values_new(&scratch, b, &values[i], &x);
            if (status)
                break;
            d[j] = i ? step : -step;
            set_values(b, d, 1, x, &values[i]);
            status = system_build(&scratch, b->machine, b->search->job, &values[i], &b->search->system, NULL, &side[i], &failed);
        }
        if (!status)
            differentiate_one(b, j, side, 2 * step, work);
        pool_close(&scratch);
    }
    return status;
}

/* ---- draws */

static int is_outside(const struct bands *b, const double *d)
{
    for (int j = 0; j < b->nsource; j++) {
        const struct source *source = &b->source[j];
        if (source->kind == SOURCE_LOSS && b->machine->loss[source->index].value + d[j] < 0)
            return 1;
        if (source->kind != SOURCE_MODULUS)
            continue;
        const rotid_parameter *bounds = machine_bounds(b->machine, b->search->job, source->index);
        double value = b->search->values.x[source->index];
        value = source->is_logarithm ? value * exp(d[j]) : value + d[j];
        if (!(value >= bounds->lower && value <= bounds->upper))
            return 1;
    }
    return 0;
}

/* Of a variance from the residuals Student's t: the normal deviate over the root of chi2/dof. */
static void draw_one(const struct bands *b, struct random_stream *stream, double *z, double *d)
{
    int n = b->nmodulus;
    double widened = 1;
    if (n && b->fit->variance_from_residuals) {
        double chi2 = 0;
        for (int i = 0; i < b->fit->dof; i++) {
            double one = random_normal(stream);
            chi2 += one * one;
        }
        widened = sqrt(b->fit->dof / chi2);
    }
    for (int i = 0; i < n; i++)
        z[i] = random_normal(stream);
    for (int i = 0; i < n; i++) {
        d[i] = 0;
        for (int j = 0; j <= i; j++)
            d[i] += widened * b->factor[i + (ptrdiff_t)n * j] * z[j];
    }
    for (int j = n; j < b->nsource; j++)
        d[j] = b->source[j].std * random_normal(stream);
}

static int draw_all(struct bands *b)
{
    struct random_stream stream = {b->options->seed};
    b->draw = POOL_ARRAY(b->pool, double, (size_t)b->nsource *(size_t)b->options->draws);
    double *z = POOL_ARRAY(b->pool, double, b->nmodulus);
    if (!b->draw || !z)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < b->options->draws; i++) {
        double *d = b->draw + (ptrdiff_t)b->nsource * i;
        int attempt = 0;
        do
            draw_one(b, &stream, z, d);
        while (is_outside(b, d) && ++attempt < REDRAWS);
        if (attempt == REDRAWS) /* the bounds leave next to nothing of the distribution */
            memset(d, 0, (size_t)b->nsource * sizeof *d);
    }
    return ROTID_OK;
}

/* The critical speeds of a draw, from near pairs of `from`. How many were not found, or -1 where memory is out. */
static int solve(struct pool *pool, const struct bands *b, const struct system *from, const struct critical *near,
                 struct system *s, const double *predicted, struct critical *to)
{
    int lost = 0;
    for (int i = 0; i < b->ncritical; i++) {
        to[i].speed = predicted[i];
        if (pair_new(pool, s->size, &to[i].pair))
            return -1;
        lost += !isfinite(near[i].speed) || critical_carry(from, &near[i], b->options->harmonic, s, &to[i]);
        if (!isfinite(near[i].speed))
            to[i].speed = NAN;
    }
    return lost;
}

static double ratio(double complex lambda)
{
    return -creal(lambda) / cabs(lambda);
}

/* Solved are the modes that have lost much of their decay at the deviations d [nsource] by the prediction. */
static void watch(struct pool *pool, const struct bands *b, const double *d, struct system *s, double *growth)
{
    *growth = -INFINITY;
    struct pair pair;
    for (int i = 0; i < b->nwatched && !pair_new(pool, s->size, &pair); i++) {
        double rate = creal(b->watched[i].lambda), predicted = rate;
        for (int j = 0; j < b->nsource; j++) { /* linear in what is drawn or in its power, whichever destabilises more */
            double by = creal(b->drift[j + (ptrdiff_t)b->nsource * i]);
            predicted += fmax(by * d[j], by * (b->source[j].is_logarithm ? expm1(d[j]) : d[j]));
        }
        if (rate < 0 && predicted < (1 - MOST) * rate)
            continue;
        system_at(s, b->machine->high);
        if (system_transfer(&b->search->system, &b->watched[i], s, &pair) || pair_refine(s, b->machine->high, &pair))
            continue;
        *growth = fmax(*growth, creal(pair.lambda) / cabs(pair.lambda));
    }
}

/* The amplitudes of a draw, on a basis of its own that has fewer modes and the static motions by all that acts at a place. */
static int respond(struct pool *pool, struct bands *b, const struct machine_values *values, int index)
{
    const struct basis_size fewer = {FEWER, 0, 0};
    const rotid_probe_response *curve = b->out->unbalance;
    int nprobe = b->out->nunbalance, failed;
    struct system s;
    int status = system_build(pool, b->machine, b->search->job, values, &b->search->system, &fewer, &s, &failed);
    if (status)
        return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* this draw has none */
    double complex *q = POOL_ARRAY(pool, double complex, s.size);
    float *to = b->response + (ptrdiff_t)index * curve->nspeed_rpm * nprobe;
    for (int i = 0; i < curve->nspeed_rpm && q; i++) {
        int singular = response_at(&s, curve->speed_rpm[i] * RPM, q);
        for (int p = 0; p < nprobe; p++)
            to[i * nprobe + p] = (float)(singular ? 0 : cabs(probe_motion(&s, p, q)));
    }
    return q ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* In one step from the nominal, or where a mode is lost in four. */
static int one_draw(void *context, int index, int worker)
{
    struct bands *b = context;
    const double *d = b->draw + (ptrdiff_t)b->nsource * index;
    struct pool pool;
    int status = ROTID_OK, done = 0;
    const rotid_environment *host = worker ? NULL : b->environment; /* which is asked by one thread alone */
    if (environment_cancelled(host))
        return ROTID_STOP_CANCELLED;
    environment_progress(host, "draw", index);
    for (int steps = 1; steps <= 4 && !done && !status; steps *= 4) {
        struct machine_values values;
        struct system system[2];
        struct critical *now[2] = {NULL, NULL};
        double *x, *predicted;
        const struct system *from = &b->search->system;
        const struct critical *near = b->critical;
        int lost = 0, failed;
        pool_open(&pool, b->pool->allocator);
        status = values_new(&pool, b, &values, &x);
        predicted = POOL_ARRAY(&pool, double, b->ncritical);
        for (int step = 1; step <= steps && !status; step++) {
            int own = step % 2;
            now[own] = POOL_ARRAY(&pool, struct critical, b->ncritical);
            if (!now[own] || !predicted) {
                status = ROTID_ERROR_MEMORY;
                break;
            }
            set_values(b, d, (double)step / steps, x, &values);
            const struct basis_size basis = {b->search->basis.modes, b->search->basis.coupled, 0};
            int built =
                system_build(&pool, b->machine, b->search->job, &values, &b->search->system, &basis, &system[own], &failed);
            if (built) {
                status = built == ROTID_ERROR_MEMORY ? built : ROTID_OK;
                lost = b->ncritical;
                break;
            }
            for (int i = 0; i < b->ncritical; i++) {
                double change = 0;
                for (int j = 0; j < b->nsource; j++)
                    change += b->derivative[j + (ptrdiff_t)b->nsource * i] * d[j] / steps;
                predicted[i] = near[i].speed * (1 + fmax(-FARTHEST, fmin(FARTHEST, change)));
            }
            lost = solve(&pool, b, from, near, &system[own], predicted, now[own]);
            if (lost < 0)
                status = ROTID_ERROR_MEMORY;
            from = &system[own];
            near = now[own];
        }
        for (int i = 0; i < b->ncritical && !status; i++) {
            ptrdiff_t at = index + (ptrdiff_t)b->options->draws * i;
            b->speed[at] = near == b->critical ? (double)NAN : near[i].speed;
            b->ratio[at] = isfinite(b->speed[at]) ? ratio(near[i].pair.lambda) : (double)NAN;
        }
        if (!status && index < b->responses && (!lost || steps == 4)) {
            set_values(b, d, 1, x, &values);
            status = respond(&pool, b, &values, index);
        }
        if (!status && from != &b->search->system)
            watch(&pool, b, d, (struct system *)from, &b->growth[index]);
        done = !lost;
        status = !status && pool.out_of_memory ? ROTID_ERROR_MEMORY : status;
        pool_close(&pool);
    }
    return status;
}

/* ---- what they say */

static double decrement(double damping_ratio)
{
    return 2 * PI * damping_ratio / sqrt(1 - damping_ratio * damping_ratio);
}

static double quantile(const double *sorted, int count, double p)
{
    double at = p * (count - 1);
    int i = (int)at;
    return i + 1 < count ? sorted[i] + (at - i) * (sorted[i + 1] - sorted[i]) : sorted[count - 1];
}

static int summarise(struct bands *b, int i, rotid_critical_speed *to)
{
    int draws = b->options->draws, count = 0, kept = 0;
    const struct machine *machine = b->machine;
    double *own = POOL_ARRAY(b->pool, double, 3 * (size_t)draws), *margin = own + draws, *damping = margin + draws, sum = 0,
           square = 0;
    const rotid_response_peak *peak = isfinite(to->margin.value) ? speeds_peak(machine, to) : NULL;
    double judged = peak ? peak->speed_rpm / to->speed_rpm : 1;
    if (!own)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < draws; k++) {
        double speed = b->speed[k + (ptrdiff_t)draws * i];
        if (!isfinite(speed))
            continue;
        double zeta = b->ratio[k + (ptrdiff_t)draws * i];
        double factor = to->amplification * (zeta > 0 ? to->damping_ratio / zeta : INFINITY); /* AF goes as 1/(2 zeta) */
        double required = machine->has_operation ? speeds_required(machine, factor, speed * judged) : (double)NAN;
        margin[count] = machine->has_operation ? speeds_margin(machine, speed * judged) : (double)NAN;
        kept += !(margin[count] < required); /* nothing is required of a flat peak */
        damping[count] = decrement(zeta);
        own[count++] = speed / RPM;
        sum += speed / RPM;
        square += speed * speed / RPM / RPM;
    }
    if (count < LEAST_DRAWS)
        return ROTID_OK;
    sort_doubles((size_t)count, own);
    sort_doubles((size_t)count, damping);
    to->ci95[0] = quantile(own, count, 0.025);
    to->ci95[1] = quantile(own, count, 0.975);
    to->log_decrement_ci95[0] = quantile(damping, count, 0.025);
    to->log_decrement_ci95[1] = quantile(damping, count, 0.975);
    to->std = sqrt(fmax(0, square - sum * sum / count) / (count - 1));
    if (!isfinite(to->margin.value))
        return ROTID_OK;
    sort_doubles((size_t)count, margin);
    to->margin.ci95[0] = quantile(margin, count, 0.025);
    to->margin.ci95[1] = quantile(margin, count, 0.975);
    if (isfinite(to->margin.required) || (machine->api617 && isfinite(to->amplification)))
        to->margin.probability = (double)kept / count;
    return ROTID_OK;
}

/* What source j adds to the variance of a sum g [nsource] of what is drawn. */
static double variance_of(const struct bands *b, const double *g, int j)
{
    double sum = 0;
    if (j >= b->nmodulus)
        return g[j] * g[j] * b->source[j].std * b->source[j].std;
    for (int k = 0; k < b->nmodulus; k++)
        sum += g[j] * covariance(b, j, k) * g[k];
    return sum;
}

/* 1.96 standard deviations of what has the derivatives g [nsource]; NaN where a mode has none, as where two are one at
 * standstill. */
static double half_width(const struct bands *b, const double *g)
{
    double variance = 0;
    for (int j = 0; j < b->nsource; j++)
        variance += variance_of(b, g, j);
    return 1.96 * sqrt(variance);
}

/* Of the Campbell diagram and the map by the linear prediction: frequencies and speeds log-normal, log decrements normal. g
 * [nsource] */
static void spread(const struct bands *b, rotid_speeds *out, double *g)
{
    for (int i = 0; i < out->ncampbell; i++)
        for (int m = 0; m < out->campbell[i].nmodes; m++) {
            rotid_campbell_mode *to = &out->campbell[i].modes[m];
            const double complex lambda = track_at(b->tracks, to->mode - 1, i)->lambda,
                                 *rate =
                                     b->campbell + (ptrdiff_t)b->nsource * (i + (ptrdiff_t)b->tracks->nspeed * (to->mode - 1));
            double w = cimag(lambda);
            for (int j = 0; j < b->nsource; j++)
                g[j] = cimag(rate[j]) / w;
            double half = half_width(b, g);
            if (!isfinite(half))
                continue;
            to->ci95[0] = to->frequency_hz * exp(-half);
            to->ci95[1] = to->frequency_hz * exp(half);
            for (int j = 0; j < b->nsource; j++)
                g[j] = 2 * PI * (creal(rate[j]) - creal(lambda) * cimag(rate[j]) / w) / w;
            half = half_width(b, g);
            to->log_decrement_ci95[0] = to->log_decrement - half;
            to->log_decrement_ci95[1] = to->log_decrement + half;
        }
    for (int row = 0; row < out->nmap; row++)
        for (int i = 0; i < out->map[row].nspeed_rpm; i++) {
            double half = half_width(b, b->map + (ptrdiff_t)b->nsource * (i + (ptrdiff_t)b->search->system.columns * row));
            out->map[row].from_rpm[i] = out->map[row].speed_rpm[i] * exp(-half);
            out->map[row].to_rpm[i] = out->map[row].speed_rpm[i] * exp(half);
        }
}

/* one [responses] */
static void spread_response(const struct bands *b, rotid_speeds *out, double *one)
{
    for (int p = 0; p < out->nunbalance; p++)
        for (int i = 0; i < out->unbalance[p].nspeed_rpm && b->responses >= LEAST_DRAWS; i++) {
            int count = 0;
            for (int k = 0; k < b->responses; k++) {
                float amplitude = b->response[((ptrdiff_t)k * out->unbalance[p].nspeed_rpm + i) * out->nunbalance + p];
                if (amplitude > 0)
                    one[count++] = (double)amplitude;
            }
            if (count < LEAST_DRAWS)
                continue;
            sort_doubles((size_t)count, one);
            out->unbalance[p].from_m[i] = quantile(one, count, 0.025);
            out->unbalance[p].to_m[i] = quantile(one, count, 0.975);
        }
}

/* Of the linear prediction: sources of one name together, with their correlation. */
static int share(struct bands *b, int i, rotid_critical_speed *to)
{
    double all = 0;
    to->nvariance_shares = b->nname;
    to->variance_shares = POOL_ARRAY(b->pool, rotid_variance_share, b->nname);
    if (!to->variance_shares)
        return ROTID_ERROR_MEMORY;
    for (int name = 0; name < b->nname; name++)
        to->variance_shares[name].source = b->name[name];
    const double *g = b->derivative + (ptrdiff_t)b->nsource * i;
    for (int j = 0; j < b->nsource; j++)
        to->variance_shares[b->source[j].name].share += variance_of(b, g, j);
    for (int name = 0; name < b->nname; name++)
        all += to->variance_shares[name].share;
    for (int name = 0; name < b->nname; name++)
        to->variance_shares[name].share = all > 0 ? fmax(0, to->variance_shares[name].share / all) : 0;
    return ROTID_OK;
}

static int find_watched(struct bands *b, struct system *nominal)
{
    int count, status;
    if (!b->machine->has_operation)
        return ROTID_OK;
    b->watched = POOL_ARRAY(b->pool, struct pair, nominal->size);
    for (int i = 0; i < nominal->size && b->watched; i++)
        if (pair_new(b->pool, nominal->size, &b->watched[i]))
            return ROTID_ERROR_MEMORY;
    if (!b->watched)
        return ROTID_ERROR_MEMORY;
    status = pairs_all(b->pool, nominal, b->machine->high, &count, b->watched, NULL);
    for (int i = 0; i < count && !status && cimag(b->watched[i].lambda) < nominal->highest; i++) {
        struct pair *own = &b->watched[i];
        if (cimag(own->lambda) > 2 * b->machine->high && creal(own->lambda) < -WEAK * cabs(own->lambda))
            continue;
        if (!pair_refine(nominal, b->machine->high, own))
            pair_copy(nominal->size, own, &b->watched[b->nwatched++]);
    }
    return status;
}

int bands_gradient(struct pool *pool, struct search *search, int ncritical, const struct critical *critical, double *gradient,
                   double *rest)
{
    const struct speeds_options options = {.harmonic = search->harmonic};
    int n = machine_unknowns(search->machine, search->job);
    double *one = POOL_ARRAY(pool, double, n);
    const rotid_fit_result all = {.n = n, .std = one}; /* every unknown is uncertain */
    struct bands b = {.pool = pool,
                      .search = search,
                      .machine = search->machine,
                      .fit = &all,
                      .options = &options,
                      .ncritical = ncritical,
                      .critical = critical};
    for (int p = 0; p < n && one; p++)
        one[p] = 1;
    int status = one ? find_sources(&b) : ROTID_ERROR_MEMORY;
    b.nsource = rest ? b.nsource : b.nmodulus;
    if (!status)
        status = differentiate(&b);
    if (rest)
        memset(rest, 0, (size_t)ncritical * (size_t)ncritical * sizeof *rest);
    memset(gradient, 0, (size_t)n * (size_t)ncritical * sizeof *gradient);
    for (int i = 0; i < ncritical && !status; i++) {
        const double *own = b.derivative + (ptrdiff_t)b.nsource * i;
        for (int j = 0; j < b.nmodulus; j++)
            gradient[b.source[j].index + (ptrdiff_t)n * i] = own[j];
        for (int k = 0; k < ncritical && rest; k++)
            for (int j = b.nmodulus; j < b.nsource; j++)
                rest[i + (ptrdiff_t)ncritical * k] +=
                    own[j] * b.derivative[j + (ptrdiff_t)b.nsource * k] * b.source[j].std * b.source[j].std;
    }
    return status;
}

int bands_make(struct pool *pool, struct search *search, const rotid_fit_result *fit, const struct speeds_options *options,
               const rotid_environment *environment, struct message_list *notes, rotid_speeds *out)
{
    int ncritical = search->ncritical;
    struct bands b = {.pool = pool,
                      .search = search,
                      .machine = search->machine,
                      .fit = fit,
                      .options = options,
                      .environment = environment,
                      .ncritical = ncritical,
                      .critical = search->critical,
                      .tracks = &search->tracks,
                      .out = out};
    int status = find_sources(&b), lost = 0;
    if (status || !b.nsource || !options->draws || !ncritical)
        return status;
    status = factor_covariance(&b);
    if (!status)
        status = find_watched(&b, &search->system);
    if (!status)
        status = differentiate(&b);
    b.responses = out->nunbalance ? options->draws < RESPONSES ? options->draws : RESPONSES : 0;
    size_t curve = out->nunbalance ? (size_t)out->nunbalance * (size_t)out->unbalance->nspeed_rpm : 0;
    double *work = POOL_ARRAY(pool, double, b.nsource + b.responses);
    b.response = POOL_ARRAY(pool, float, (size_t)b.responses *curve);
    if (!status && (!work || !b.response))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        spread(&b, out, work);
    if (!status)
        status = draw_all(&b);
    b.speed = POOL_ARRAY(pool, double, (size_t)options->draws *(size_t)ncritical);
    b.ratio = POOL_ARRAY(pool, double, (size_t)options->draws *(size_t)ncritical);
    b.growth = POOL_ARRAY(pool, double, options->draws);
    if (!status && (!b.speed || !b.ratio || !b.growth))
        status = ROTID_ERROR_MEMORY;
    if (!status)
        status = parallel_for(options->threads, options->draws, one_draw, &b);
    for (int i = 0; i < ncritical && !status; i++) {
        for (int k = 0; k < options->draws; k++)
            lost += !isfinite(b.speed[k + (ptrdiff_t)options->draws * i]);
        status = summarise(&b, i, &out->critical_speeds[i]);
        if (!status)
            status = share(&b, i, &out->critical_speeds[i]);
    }
    if (status)
        return status;
    spread_response(&b, out, work);
    out->draws = options->draws;
    int moves_away = out->stability.mode == ROTID_NONE && out->stability.onset_rpm * RPM <= b.machine->high;
    if (b.nwatched && !moves_away) { /* modes of whirl say nothing of that */
        int stable = 0;
        for (int k = 0; k < options->draws; k++)
            stable += b.growth[k] <= GROWS;
        out->stability.probability_stable = (double)stable / options->draws;
    }
    if (lost)
        message_warn(notes, "%d of %d critical speeds of the draws were not found: the intervals are of the others", lost,
                     options->draws * ncritical);
    return ROTID_OK;
}
