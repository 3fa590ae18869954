/* Which test at rest narrows a critical speed most. With p the unknowns (their logarithms where they are above zero), C their
 * covariance as measured, g = d ln W/dp and J = d ln f/dp of the frequencies of a test with the relative deviation s
 *   Var ln W = g' (C^-1 + J'J/s^2)^-1 g + the variance by bearings, losses and pull, which no test at rest changes. */
#include "running/running.h"

#define MORE_MODES  3    /* beyond the highest measured one */
#define FIRST_MODES 8    /* where nothing is measured: tests of 2 to so many */
#define MASS_SHARE  0.05 /* of the rotor: an added mass that its supports and its frequencies hardly notice */
#define PLACES      5
#define FINER       2 /* times: a measurement that is repeated four times */
#define HARDLY      0.1

struct worth {
    struct pool *pool;
    const struct machine *machine;
    const struct job *job;
    int n, at_rest; /* unknowns of the machine; the first of them act at rest */
    const double *x;
    double noise, speed, rest; /* relative; rad/s; variance of ln W by what is no unknown */
    double *gradient;          /* [n] */
    double *known;             /* [n^2] C^-1 as measured */
    double *information, *work;
    rotid_suggestion *out;
};

/* C^-1 of the unknowns that were measured; the others have none. */
static int invert(struct worth *w, const rotid_fit_result *fit)
{
    int n = w->n, count = 0, *of = POOL_ARRAY(w->pool, int, n);
    double *c = POOL_ARRAY(w->pool, double, (size_t)n *(size_t)n), *e = POOL_ARRAY(w->pool, double, n);
    if (!of || !c || !e)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n && fit; p++)
        if (isfinite(fit->std[p]) && fit->std[p] > 0)
            of[count++] = p;
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++)
            c[i + (ptrdiff_t)count * j] = machine_covariance(w->machine, w->job, fit, of[i], of[j]) * (i == j ? 1 + 1e-12 : 1);
    if (cholesky_factor(count, c))
        return ROTID_ERROR_FINITE;
    for (int j = 0; j < count; j++) {
        memset(e, 0, (size_t)count * sizeof *e);
        e[j] = 1;
        cholesky_solve(count, c, 1, e);
        for (int i = 0; i < count; i++)
            w->known[of[i] + (ptrdiff_t)n * of[j]] = e[i];
    }
    return ROTID_OK;
}

/* Standard deviation of ln W by an information matrix [n^2], which is kept; NaN where it leaves open what W depends on. */
static double deviation(struct worth *w, const double *information)
{
    int n = w->n, count = 0;
    double *a = w->work, *g = w->work + (ptrdiff_t)n * n, sum = w->rest;
    for (int j = 0; j < n; j++) { /* an unknown without information or effect says nothing */
        if (!(information[j + (ptrdiff_t)n * j] > 0)) {
            if (w->gradient[j] != 0)
                return NAN;
            continue;
        }
        for (int i = 0, row = 0; i < n; i++)
            if (information[i + (ptrdiff_t)n * i] > 0)
                a[row++ + (ptrdiff_t)n * count] = information[i + (ptrdiff_t)n * j];
        g[count++] = w->gradient[j];
    }
    for (int j = 1; j < count; j++) /* columns of n rows to columns of `count` */
        memmove(a + (ptrdiff_t)count * j, a + (ptrdiff_t)n * j, (size_t)count * sizeof *a);
    for (int i = 0; i < count; i++)
        a[i + (ptrdiff_t)count * i] *= 1 + 1e-12;
    if (cholesky_factor(count, a))
        return NAN;
    cholesky_forward(count, a, 1, g);
    for (int i = 0; i < count; i++)
        sum += g[i] * g[i];
    return sqrt(sum);
}

/* d ln f/dp [highest * at_rest] of the elastic modes of a rotor. */
static int differentiate(struct pool *pool, const struct worth *w, const struct rotor *rotor, int highest, double *rows)
{
    struct prediction p;
    int status =
        elastic_rates(pool, NULL, rotor, w->at_rest, w->job->unknowns.parameter, ROTID_REDUCTION_NONE, w->x, highest, &p);
    for (int q = 0; q < w->at_rest && !status; q++)
        for (int k = 0; k < highest; k++) {
            int pair = p.count - highest + k;
            rows[k + (ptrdiff_t)highest * q] = p.dlambda[pair + (ptrdiff_t)p.count * q] / (2 * p.lambda[pair]) *
                                               (machine_by_logarithm(w->machine, w->job, q) ? w->x[q] : 1);
        }
    return status;
}

/* A test of the modes number [count] of which the rows [highest * at_rest] are there, `finer` times as exact. */
static void add_test(struct worth *w, const char *text, int count, const int *number, int highest, const double *rows,
                     double finer)
{
    rotid_suggestion *out = w->out;
    if (!text)
        return;
    memcpy(w->information, w->known, (size_t)w->n * (size_t)w->n * sizeof *w->information);
    for (int i = 0; i < count; i++)
        for (int q = 0; q < w->at_rest; q++)
            for (int p = 0; p < w->at_rest; p++)
                w->information[p + (ptrdiff_t)w->n * q] += rows[number[i] - 1 + (ptrdiff_t)highest * p] *
                                                           rows[number[i] - 1 + (ptrdiff_t)highest * q] * finer * finer /
                                                           w->noise / w->noise;
    double std = deviation(w, w->information) * w->speed / RPM;
    const rotid_speed_test test = {
        .test = text, .modes = count, .std_rpm = std, .narrowed_percent = 100 * (1 - std / out->speed_std)};
    (void)POOL_ADD(w->pool, out->speed_tests, out->nspeed_tests, &test); /* memory: the pool tells */
}

static int add_masses(struct worth *w, int count, const int *number, int highest)
{
    struct mass_properties mass;
    int status = model_weigh(w->pool, NULL, &w->job->rotor, 0, NULL, NULL, &mass);
    double *rows = POOL_ARRAY(w->pool, double, (size_t)highest *(size_t)w->at_rest);
    struct disk *disk = POOL_COPY(w->pool, w->job->rotor.disk, w->job->rotor.ndisk, 1);
    if (!status && (!rows || !disk))
        status = ROTID_ERROR_MEMORY;
    for (int i = 0; i < PLACES && !status; i++) {
        struct pool scratch;
        struct rotor rotor = w->job->rotor;
        disk[rotor.ndisk] = (struct disk){.position = rotor_length(&rotor) * i / (PLACES - 1), .mass = MASS_SHARE * mass.mass};
        rotor.disk = disk;
        rotor.ndisk++;
        pool_open(&scratch, w->pool->allocator);
        status = differentiate(&scratch, w, &rotor, highest, rows);
        pool_close(&scratch);
        if (!status)
            add_test(w,
                     pool_format(w->pool, "the %d modes with %.3g kg at %.3f m", count, MASS_SHARE * mass.mass,
                                 rotor_length(&rotor) * i / (PLACES - 1)),
                     count, number, highest, rows, 1);
    }
    return status;
}

static int add_tests(struct worth *w)
{
    const struct job_measurement *measured = &w->job->measurement;
    int count = measured->nmode, highest = comparison_highest(w->job), first = 2;
    int most = highest ? highest + MORE_MODES : FIRST_MODES, *number = POOL_ARRAY(w->pool, int, most + count);
    double *rows = POOL_ARRAY(w->pool, double, (size_t)most *(size_t)w->at_rest);
    int status = number && rows ? differentiate(w->pool, w, &w->job->rotor, most, rows) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    if (count) {
        memcpy(number, measured->number, (size_t)count * sizeof *number);
        add_test(w, pool_format(w->pool, "the %d modes again", count), count, number, most, rows, 1);
        add_test(w, pool_format(w->pool, "the %d modes again, with half the noise", count), count, number, most, rows, FINER);
        for (int k = 0; k < count; k++)
            add_test(w, pool_format(w->pool, "mode %d again, with half the noise", number[k]), 1, number + k, most, rows, FINER);
        status = add_masses(w, count, number, most);
        first = highest + 1;
    }
    for (int k = first; k <= most && !status; k++) {
        for (int i = highest + 1; i <= k; i++)
            number[i - highest - 1] = i;
        add_test(w,
                 highest && k == first ? pool_format(w->pool, "mode %d besides", k)
                                       : pool_format(w->pool, "modes %d to %d%s", highest + 1, k, highest ? " besides" : ""),
                 k - highest, number, most, rows, 1);
    }
    return status;
}

ORDER_BY(by_std, rotid_speed_test, isnan(it->std_rpm) != 0, it->std_rpm)

static const char *conclude(struct pool *pool, const rotid_suggestion *s, const char *what)
{
    const rotid_speed_test *best = s->nspeed_tests ? &s->speed_tests[0] : NULL;
    if (!best || isnan(best->std_rpm))
        return pool_format(pool, "No test at rest of these determines what %s depends on.", what);
    if (s->speed_identified < HARDLY)
        return pool_format(pool,
                           "%.0f %% of the variance of %s, %.0f rpm, comes from bearings, losses and pull: no test at rest "
                           "reduces it, a run-up (*RUNUP) does.",
                           100 * (1 - s->speed_identified), what, s->speed_rpm);
    return pool_format(pool, "Measure %s: the standard deviation of %s, %.0f rpm, is then expected to be %.3g rpm%s.", best->test,
                       what, s->speed_rpm, best->std_rpm,
                       isfinite(s->speed_std) ? pool_format(pool, " in place of %.3g rpm", s->speed_std) : "");
}

int worth_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
              const rotid_fit_result *fit, const struct worth_options *options, struct message_list *notes, rotid_suggestion *out)
{
    struct worth w = {.pool = pool,
                      .machine = machine,
                      .job = job,
                      .n = machine_unknowns(machine, job),
                      .at_rest = job->unknowns.nparameter,
                      .x = x,
                      .noise = options->noise,
                      .out = out};
    struct search search = {.machine = machine, .job = job, .harmonic = 1, .count = SPEEDS_COUNT};
    size_t square = (size_t)w.n * (size_t)w.n;
    const char *whirl = options->backward ? "backward" : "forward",
               *what = pool_format(pool, "critical speed %d with %s whirl", options->number, whirl);
    w.gradient = POOL_ARRAY(pool, double, w.n);
    w.known = POOL_ARRAY(pool, double, square);
    w.information = POOL_ARRAY(pool, double, square);
    w.work = POOL_ARRAY(pool, double, square + (size_t)w.n);
    int status = w.gradient && w.known && w.information && w.work && what ? machine_nominal(pool, machine, x, &search.values)
                                                                          : ROTID_ERROR_MEMORY;
    if (!status && !w.at_rest)
        status = message_refuse(notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1,
                                "the deck has no *IDENTIFY of the rotor at rest, expected one");
    if (!status)
        status = search_until(pool, 0, options->backward ? 0 : options->number, options->backward ? options->number : 0, notes,
                              &search);
    const struct critical *critical = status ? NULL : search_find(&search, options->number, options->backward);
    if (!status && !critical)
        status = message_refuse(notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1,
                                "the machine has %d critical speeds with %s whirl up to %.0f rpm, expected "
                                "one of them and not number %d",
                                search_count(&search, options->backward), whirl, search.speed[search.count - 1] / RPM,
                                options->number);
    if (!status)
        status = bands_gradient(pool, &search, 1, critical, w.gradient, &w.rest);
    if (!status)
        status = invert(&w, fit);
    if (status || !critical)
        return status;
    w.speed = critical->speed;
    double now = deviation(&w, w.known);
    out->speed_rpm = w.speed / RPM;
    out->speed_std = now * out->speed_rpm;
    out->speed_identified = isfinite(now) && now > 0 ? 1 - w.rest / (now * now) : 1;
    status = add_tests(&w);
    if (out->nspeed_tests)
        qsort(out->speed_tests, (size_t)out->nspeed_tests, sizeof *out->speed_tests, by_std);
    out->sentence = conclude(pool, out, what);
    return status ? status : pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
