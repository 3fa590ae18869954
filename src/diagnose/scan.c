#include "diagnose/scan.h"

#include <math.h>
#include <string.h>

#include "linalg/product.h"

#define MOST_PLACES 250  /* along the axis; meshes are rarely finer */
#define INSEPARABLE 1e-6 /* of a column is left when what is fitted is taken out: rounding */

static const double width_fraction[] = {0.17, 0.46, 0.79}; /* of the physical range, on a logarithmic scale */
#define WIDTHS ((int)(sizeof width_fraction / sizeof *width_fraction))

static const struct effect_kind nothing = {.id = "none"};

static int place_stride(int naxis)
{
    return (naxis + MOST_PLACES - 1) / MOST_PLACES;
}

static int searches(const struct scan_candidate *c, int p)
{
    return p >= 0 && !c->fixed[p];
}

static int item_count(const struct scan_candidate *c, int naxis)
{
    int stride = place_stride(naxis);
    if (c->cause->solid) /* no column: as_solid.h */
        return 0;
    int places = searches(c, c->cause->place) ? (naxis + stride - 1) / stride : 1;
    return places * (searches(c, c->cause->width) ? WIDTHS : 1);
}

static int is_secant(const struct cause_kind *cause)
{
    return cause->secant || cause->effect->nparameter == 0;
}

static void list_items(const struct rotor *rotor, const struct rotor_model *model, struct scan *scan)
{
    int stride = place_stride(model->naxis);
    for (int i = 0; i < scan->ncandidate; i++) {
        struct scan_candidate *c = &scan->candidate[i];
        const struct cause_kind *cause = c->cause;
        int widths = searches(c, cause->width) ? WIDTHS : 1;
        c->first = scan->nitem;
        c->count = item_count(c, model->naxis);
        double lower = 1, upper = 1;
        if (cause->width >= 0)
            cause->bounds(rotor, &c->effect, cause->width, &lower, &upper);
        for (int j = 0; j < c->count; j++) {
            struct scan_item *item = &scan->item[scan->nitem++];
            int node = j / widths * stride;
            *item = (struct scan_item){.candidate = i, .effect = c->effect, .unit = 1};
            if (searches(c, cause->place))
                item->effect.value[cause->place] = model->z[node];
            if (searches(c, cause->width))
                item->effect.value[cause->width] = lower * pow(upper / lower, width_fraction[j % widths]);
            item->side = cause->parameter[cause->size].one_sided;
            if (is_secant(cause)) {
                const struct cause_parameter *size = &cause->parameter[cause->size];
                item->unit = cause->effect->nparameter ? size->typical - size->neutral : 1; /* there, or not */
                item->side = 1;
            }
        }
    }
}

static int fill_columns(const struct job *job, struct columns *columns, struct scan *scan)
{
    int status = ROTID_OK, n = scan->nrow;
    for (int i = 0; i < scan->nitem && !status; i++) {
        const struct scan_item *item = &scan->item[i];
        const struct cause_kind *cause = scan->candidate[item->candidate].cause;
        if (is_secant(cause))
            continue;
        status = columns_probe(columns, &item->effect);
        if (!status)
            status = columns_parameter(columns, job->unknowns.nparameter + cause->size, scan->column + (ptrdiff_t)i * n);
    }
    for (int i = 0; i < scan->nitem && !status; i++) { /* behind the others: they leave the point */
        struct effect effect = scan->item[i].effect;
        const struct cause_kind *cause = scan->candidate[scan->item[i].candidate].cause;
        double *column = scan->column + (ptrdiff_t)i * n;
        if (!is_secant(cause))
            continue;
        effect.value[cause->size] = cause->parameter[cause->size].typical;
        status = columns_probe(columns, &effect);
        if (status || columns_residual(columns, columns->x, column)) /* no such model: nothing to propose */
            memset(column, 0, (size_t)n * sizeof *column);
        else
            for (int j = 0; j < n; j++)
                column[j] -= columns->r[j];
    }
    return status;
}

static int make_basis(const struct job *job, struct columns *columns, struct scan *scan)
{
    int n = scan->nrow, row = columns->nmode, status = ROTID_OK;
    for (int m = 0; m < columns->nmode; m++) {
        const struct columns_mode *mode = &columns->mode[m];
        double *column = scan->basis + (ptrdiff_t)scan->nbasis * n;
        memset(column, 0, (size_t)n * sizeof *column);
        if (mode->sensors)
            memcpy(column + row, mode->weighted, (size_t)mode->sensors * sizeof *column);
        row += mode->sensors;
        if (mode->square > 0)
            scan->nbasis = basis_extend(n, scan->nbasis, INSEPARABLE, scan->basis);
    }
    for (int p = 0; p < job->unknowns.nparameter && !status; p++) {
        double *column = scan->basis + (ptrdiff_t)scan->nbasis * n;
        status = columns_parameter(columns, p, column);
        if (!status)
            scan->nbasis = basis_extend(n, scan->nbasis, INSEPARABLE, scan->basis);
    }
    return status;
}

/* takes the basis out of every column: C := C - Q (Q' C), twice, in blocks */
static int project(struct pool *pool, struct scan *scan, double *raw)
{
    int n = scan->nrow, q = scan->nbasis;
    double *product = POOL_ARRAY(pool, double, (size_t)q *(size_t)scan->nitem);
    if (!product)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->nitem; i++) {
        const double *column = scan->column + (ptrdiff_t)i * n;
        raw[i] = sqrt(product_dot(n, column, column));
    }
    for (int pass = 0; pass < 2 && q && scan->nitem; pass++) {
        product_transposed(q, scan->nitem, n, scan->basis, scan->column, product);
        product_subtract(n, scan->nitem, q, scan->basis, product, scan->column);
    }
    return ROTID_OK;
}

/* Drop of chi2 for the amplitude that physics allows: within the bounds of the size, on its side of neutral. */
static void predict(const struct rotor *rotor, struct scan *scan, struct scan_item *item, double raw, double *column)
{
    const struct cause_kind *cause = scan->candidate[item->candidate].cause;
    double lower = 0, upper = 1, neutral = cause->parameter[cause->size].neutral;
    item->norm = sqrt(product_dot(scan->nrow, column, column));
    item->usable = isfinite(item->norm) && item->norm > INSEPARABLE * raw && raw > 0;
    for (int j = 0; j < scan->nrow; j++)
        column[j] = item->usable ? column[j] / item->norm : 0;
    if (!item->usable)
        return;
    double along = product_dot(scan->nrow, column, scan->r);
    if (cause->effect->nparameter)
        cause_bounds(cause, rotor, &item->effect, cause->size, &lower, &upper);
    double least = (lower - neutral) / item->unit, most = (upper - neutral) / item->unit;
    item->lower = item->side > 0 ? 0 : fmin(0, fmin(least, most));
    item->upper = item->side < 0 ? 0 : fmax(least, most);
    item->amplitude = fmin(fmax(-along / item->norm, item->lower), item->upper);
    double step = item->amplitude * item->norm;
    item->drop = -2 * step * along - step * step;
}

int scan_run(struct pool *pool, const struct job *job, const int *number, const int *holdout, const double *x, struct scan *scan)
{
    struct effect none = {.kind = &nothing};
    struct columns columns;
    int status = scan_list(pool, job, scan);
    if (!status)
        status = columns_open(pool, job, number, holdout, &none, x, &columns);
    if (!status)
        status = columns_prepare(&columns);
    if (status)
        return status;
    const struct rotor_model *model = &columns.model;
    int items = 0, n = scan->nrow = columns.nrow;
    for (int i = 0; i < scan->ncandidate; i++)
        items += item_count(&scan->candidate[i], model->naxis);
    scan->item = POOL_ARRAY(pool, struct scan_item, items);
    scan->column = POOL_ARRAY(pool, double, (size_t)items *(size_t)n);
    scan->basis = POOL_ARRAY(pool, double, (size_t)(job->unknowns.nparameter + columns.nmode + 1) * (size_t)n);
    scan->r = POOL_ARRAY(pool, double, n);
    double *raw = POOL_ARRAY(pool, double, items);
    if (!scan->item || !scan->column || !scan->basis || !scan->r || !raw)
        return ROTID_ERROR_MEMORY;
    list_items(&job->rotor, model, scan);
    scan->nfrequency = columns.nmode;
    scan->nfree = job->unknowns.nparameter;
    memcpy(scan->r, columns.r, (size_t)n * sizeof *scan->r);
    scan->chi2 = product_dot(n, scan->r, scan->r);
    scan->chi2_frequency = product_dot(columns.nmode, scan->r, scan->r);
    status = make_basis(job, &columns, scan);
    if (!status)
        status = fill_columns(job, &columns, scan);
    if (!status)
        status = project(pool, scan, raw);
    if (status)
        return status;
    scan->dof = n - scan->nbasis;
    for (int b = 0; b < scan->nbasis; b++) {
        const double *q = scan->basis + (ptrdiff_t)b * n;
        double along = product_dot(n, q, scan->r);
        for (int i = 0; i < n; i++)
            scan->r[i] -= along * q[i];
    }
    for (int i = 0; i < scan->nitem; i++) {
        struct scan_item *item = &scan->item[i];
        struct scan_candidate *c = &scan->candidate[item->candidate];
        predict(&job->rotor, scan, item, raw[i], scan->column + (ptrdiff_t)i * n);
        if (item->usable && (c->best < 0 || item->drop > scan->item[c->best].drop))
            c->best = i;
        scan->largest = fmax(scan->largest, item->drop);
    }
    return ROTID_OK;
}

double scan_best_drop(const struct scan *scan, int candidate)
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    return c->best < 0 ? c->promise : scan->item[c->best].drop;
}
