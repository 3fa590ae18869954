#include <limits.h>

#include "fit/fit.h"

#define INSIDE                                                                                                                   \
    9 /* times the way to the nearest bound, at most, is the scale of a parameter: its longest step is a tenth of that */

#define NARROW 1e-7 /* of x: differences over less, at a bound, are rounding */

/* What rotid_check_jacobian sees: the entries of K or of M as residuals. */
struct check {
    struct prediction prediction;
    int of_mass, status; /* of the last callback that failed */
    double *unit;        /* [n] 1/sqrt(A_ii): entries become the same whatever the units of the degrees of freedom */
};

static int count_entries(const rotid_model *model)
{
    return (model->kd + 1) * model->n + model->nfar * model->nfar;
}

/* out := A in units, the band and then both triangles among the far degrees of freedom, each entry as the sum of what stands in
 * band and block: a host may have it in one or the other. */
static void take_entries(const struct check *check, const rotid_matrix *a, double *out)
{
    int n = a->n, kd = a->kd, nfar = a->nfar;
    double *block = out + (ptrdiff_t)(kd + 1) * n;
    for (int j = 0; j < n; j++)
        for (int d = 0; d <= kd; d++) {
            ptrdiff_t place = d + (ptrdiff_t)j * (kd + 1);
            out[place] = j + d < n ? a->band[place] * check->unit[j] * check->unit[j + d] : 0;
        }
    for (int q = 0; q < nfar; q++)
        for (int p = 0; p < nfar; p++) {
            int i = a->far[p], j = a->far[q], high = i > j ? i : j, low = i + j - high, reached = high - low <= kd;
            double unit = check->unit[i] * check->unit[j], own = a->block[p + (ptrdiff_t)q * nfar] * unit;
            ptrdiff_t place = high - low + (ptrdiff_t)low * (kd + 1);
            block[p + (ptrdiff_t)q * nfar] = own + (reached ? a->band[place] * unit : 0);
            if (reached && p >= q) /* the lower triangle, as the band has it */
                out[place] += own;
        }
}

/* rotid_residual over the parameters */
static int entries(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    struct check *check = user;
    struct prediction *p = &check->prediction;
    if (r) {
        matrix_zero(&p->other_k);
        matrix_zero(&p->other_m);
        if (p->model->matrices(p->model->user, x, &p->other_k, &p->other_m))
            return check->status = ROTID_ERROR_CALLBACK;
        take_entries(check, check->of_mass ? &p->other_m : &p->other_k, r);
        return ROTID_OK;
    }
    int status = ROTID_OK;
    for (int q = 0; q < n && !status; q++) {
        status = prediction_matrix_derivatives(p, x, q);
        take_entries(check, check->of_mass ? &p->dm : &p->dk, jacobian + (ptrdiff_t)q * m);
    }
    return check->status = status;
}

static void choose_units(struct check *check, const rotid_matrix *a)
{
    double largest = 0;
    for (int i = 0; i < a->n; i++)
        check->unit[i] = a->band[(ptrdiff_t)i * (a->kd + 1)];
    for (int f = 0; f < a->nfar; f++)
        check->unit[a->far[f]] += a->block[f + (ptrdiff_t)f * a->nfar];
    for (int i = 0; i < a->n; i++)
        largest = fmax(largest, check->unit[i]);
    for (int i = 0; i < a->n; i++) /* without stiffness of its own: of the unit of the stiffest */
        check->unit[i] = 1 / sqrt(check->unit[i] > 0 ? check->unit[i] : largest > 0 ? largest : 1);
}

static int check_arguments(const rotid_model *model, const rotid_parameter *parameter, const double *x, const double *error,
                           const double *doubt, char *failure)
{
    int status = fit_check_model(model, failure);
    if (!status && model->nparam < 1)
        status = refuse(failure, "model->nparam is %d, expected 1 or more", model->nparam);
    if (!status)
        status = fit_check_parameters("model->nparam", model->nparam, parameter, failure);
    for (int p = 0; !status && x && p < model->nparam; p++)
        if (!(parameter[p].lower < x[p] && x[p] < parameter[p].upper))
            status = refuse(failure, "x[%d] is %g, expected a number between its bounds %g and %g", p, x[p], parameter[p].lower,
                            parameter[p].upper);
    long long entries = status ? 0 : (model->kd + 1LL) * model->n + (long long)model->nfar * model->nfar;
    if (!status && entries > INT_MAX)
        status = refuse(failure, "the matrices have (kd + 1) n + nfar^2 = %lld entries, expected at most %d", entries, INT_MAX);
    if (!status && (!error || !doubt))
        status = refuse(failure, "%s is NULL, expected one", !error ? "error" : "doubt");
    return status;
}

/* |a - b| / max(|a|, |b|), 0 where both vanish */
static double apart(ptrdiff_t length, const double *a, const double *b)
{
    double difference = 0, largest = 0;
    for (ptrdiff_t i = 0; i < length; i++) {
        difference = fmax(difference, fabs(a[i] - b[i]));
        largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    }
    return largest > 0 ? difference / largest : 0;
}

/* error: at least what model->derivative_products differ from the products of dK and dM with the lowest modes */
static int check_products(struct pool *pool, struct prediction *p, const double *x, double *error)
{
    const rotid_model *model = p->model;
    ptrdiff_t length = (ptrdiff_t)model->n * p->count;
    if (!model->derivative_products)
        return ROTID_OK;
    double *own = POOL_ARRAY(pool, double, 2 * length), *right = POOL_ARRAY(pool, double, length);
    int status = own && right ? prediction_compute(p, x) : ROTID_ERROR_MEMORY; /* the host stands at x again */
    for (int q = 0; q < model->nparam && !status; q++) {
        if (model->derivative_products(model->user, x, q, p->count, p->phi, own, own + length))
            continue;
        status = prediction_matrix_derivatives(p, x, q);
        for (int of_mass = 0; of_mass < 2 && !status; of_mass++) {
            matrix_multiply(of_mass ? &p->dm : &p->dk, p->count, p->phi, right);
            double *worst = &error[q + of_mass * model->nparam];
            *worst = fmax(*worst, apart(length, own + of_mass * length, right));
        }
    }
    return status;
}

static int run(struct pool *pool, const rotid_model *model, const rotid_parameter *parameter, const double *given, char *failure,
               double *error, double *doubt)
{
    struct check check = {.of_mass = 0};
    struct prediction *p = &check.prediction;
    int n = model->nparam, m = count_entries(model), pairs = model->nrigid < model->n ? model->nrigid + 1 : model->n;
    int status = prediction_new(pool, model, ROTID_REDUCTION_NONE, ROTID_NELSON, pairs, 0, p);
    if (status)
        return status;
    p->failure = failure;
    double *x = POOL_ARRAY(pool, double, n), *scale = POOL_ARRAY(pool, double, n),
           *work = POOL_ARRAY(pool, double, rotid_check_jacobian_workspace(m, n));
    check.unit = POOL_ARRAY(pool, double, model->n);
    if (!x || !scale || !work || !check.unit)
        return ROTID_ERROR_MEMORY;
    for (int q = 0; q < n; q++) {
        x[q] = given ? given[q] : parameter[q].start;
        scale[q] = fmin(fabs(x[q] != 0 ? x[q] : parameter[q].start),
                        INSIDE * fmin(x[q] - parameter[q].lower, parameter[q].upper - x[q]));
    }
    status = prediction_compute(p, x);
    for (check.of_mass = 0; check.of_mass < 2 && !status; check.of_mass++) {
        ptrdiff_t place = check.of_mass ? n : 0;
        choose_units(&check, check.of_mass ? &p->m : &p->k);
        status = rotid_check_jacobian(m, n, entries, &check, x, scale, failure, error + place, doubt + place, work);
        status = status == ROTID_ERROR_CALLBACK ? check.status : status;
    }
    for (int q = 0; q < n; q++)
        if (scale[q] < NARROW * fabs(x[q]))
            error[q] = error[n + q] = doubt[q] = doubt[n + q] = NAN;
    return status ? status : check_products(pool, p, x, error);
}

int rotid_check_model(const rotid_model *model, const rotid_parameter *parameter, const double *x,
                      const rotid_environment *environment, char *failure, double *error, double *doubt)
{
    struct entry entry;
    rotid_model own;
    int status = entry_open(&entry, environment, failure);
    if (!status && !model)
        status = refuse(failure, "model is NULL, expected a struct");
    if (!status)
        status = sized_take(SIZED_MODEL, model, failure, &own);
    if (!status)
        status = check_arguments(&own, parameter, x, error, doubt, failure);
    if (!status)
        status = run(&entry.scratch, &own, parameter, x, failure, error, doubt);
    return entry_close(&entry, status);
}
