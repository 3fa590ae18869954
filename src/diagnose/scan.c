#include "diagnose/diagnose.h"
#include "fit/fit.h"

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

static int width_count(const struct scan *scan, const struct scan_candidate *c)
{
    return searches(c, c->cause->width) && scan->extent == SCAN_ALL ? WIDTHS : 1;
}

static int item_count(const struct scan *scan, const struct scan_candidate *c, int naxis)
{
    int stride = place_stride(naxis);
    if (c->cause->solid) /* no column: as_solid.h */
        return 0;
    int places = searches(c, c->cause->place) ? (naxis + stride - 1) / stride : 1;
    return places * width_count(scan, c);
}

int scan_is_field(const struct scan_candidate *c)
{
    return c->state < 0 && !c->suspect && !c->effect.variant && c->cause->place >= 0 &&
           (c->cause == catalogue_find("stiffness_local") || c->cause == catalogue_find("added_mass"));
}

static void keep_fields(struct scan *scan)
{
    int kept = 0;
    for (int i = 0; i < scan->ncandidate; i++)
        if (scan_is_field(&scan->candidate[i]))
            scan->candidate[kept++] = scan->candidate[i];
    scan->ncandidate = kept;
}

static int is_secant(const struct cause_kind *cause)
{
    return cause->secant || cause->effect->nparameter == 0;
}

/* The columns of a state, and where its rows stand. */
struct part {
    int open; /* a state that is held out has no rows */
    int row;
    const struct state *state;
    struct columns columns;
};

static void list_items(const struct part *part, struct scan *scan)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        struct scan_candidate *c = &scan->candidate[i];
        const struct cause_kind *cause = c->cause;
        const struct rotor *rotor = &part[c->home].state->job.rotor;
        const struct rotor_model *model = &part[c->home].columns.model;
        int widths = width_count(scan, c), stride = place_stride(model->naxis);
        c->first = scan->nitem;
        c->count = part[c->home].open ? item_count(scan, c, model->naxis) : 0;
        double lower = 1, upper = 1;
        if (cause->width >= 0)
            cause_range(cause, rotor, &c->effect, cause->width, &lower, &upper);
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

/* Whether an item acts in a state, which may be shorter than the first. */
static int acts_in(const struct scan *scan, const struct scan_item *item, int s, const struct part *part)
{
    const struct scan_candidate *c = &scan->candidate[item->candidate];
    int place = c->cause->place;
    return part->open && c->in[s] &&
           (place < 0 || s == c->home || item->effect.value[place] <= rotor_length(&part->state->job.rotor));
}

/* The rows of state s. */
static int fill_columns(int s, struct part *part, struct scan *scan)
{
    struct columns *columns = &part->columns;
    int status = ROTID_OK, n = columns->nrow;
    for (int i = 0; i < scan->nitem && !status; i++) {
        const struct scan_item *item = &scan->item[i];
        const struct cause_kind *cause = scan->candidate[item->candidate].cause;
        if (is_secant(cause) || !acts_in(scan, item, s, part))
            continue;
        double *column = scan->column + (ptrdiff_t)i * scan->nrow + part->row;
        status = columns_probe(columns, &item->effect);
        if (!status)
            status = columns_parameter(columns, part->state->job.unknowns.nparameter + cause->size, column);
    }
    for (int i = 0; i < scan->nitem && !status; i++) { /* behind the others: they leave the point */
        struct effect effect = scan->item[i].effect;
        const struct cause_kind *cause = scan->candidate[scan->item[i].candidate].cause;
        double *column = scan->column + (ptrdiff_t)i * scan->nrow + part->row;
        if (!is_secant(cause) || !acts_in(scan, &scan->item[i], s, part))
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

/* The scales of the shapes of a state. */
static void add_scales(const struct part *part, struct scan *scan)
{
    int n = scan->nrow, row = part->row + part->columns.nmode;
    for (int m = 0; m < part->columns.nmode && part->open; m++) {
        const struct columns_mode *mode = &part->columns.mode[m];
        double *column = scan->basis + (ptrdiff_t)scan->nbasis * n;
        memset(column, 0, (size_t)n * sizeof *column);
        if (mode->sensors)
            memcpy(column + row, mode->weighted, (size_t)mode->sensors * sizeof *column);
        row += mode->sensors;
        if (mode->square > 0)
            scan->nbasis = basis_extend(n, scan->nbasis, INSEPARABLE, scan->basis);
    }
}

/* Unknown p of all, as the states have it. work [nrow] */
static int add_unknown(const struct states *states, int p, struct part *part, double *work, struct scan *scan)
{
    int n = scan->nrow;
    double *column = scan->basis + (ptrdiff_t)scan->nbasis * n;
    memset(column, 0, (size_t)n * sizeof *column);
    for (int s = 0; s < states->nstate; s++)
        for (int q = 0; q < states->state[s].job.unknowns.nparameter && part[s].open; q++) {
            if (state_unknown(&states->state[s], q) != p)
                continue;
            int status = columns_parameter(&part[s].columns, q, work);
            if (status)
                return status;
            for (int i = 0; i < part[s].columns.nrow; i++)
                column[part[s].row + i] += work[i];
        }
    memcpy(work, column, (size_t)n * sizeof *work);
    int before = scan->nbasis;
    scan->nbasis = basis_extend(n, scan->nbasis, INSEPARABLE, scan->basis);
    scan->at[p] = scan->nbasis > before ? before : -1;
    for (int i = 0; i <= p; i++)
        if (scan->at[i] >= 0)
            scan->along[i + (ptrdiff_t)p * scan->nfree] = product_dot(n, scan->basis + (ptrdiff_t)scan->at[i] * n, work);
    return ROTID_OK;
}

/* shift := R^-1 (Q'c) of each item, product [nbasis * nitem] = Q'C of the whole columns. */
static void find_shifts(const double *product, struct scan *scan)
{
    int free = scan->nfree, full = 1;
    for (int p = 0; p < free; p++)
        full &= scan->at[p] >= 0;
    for (int i = 0; i < scan->nitem; i++) {
        double *shift = scan->shift + (ptrdiff_t)i * free;
        for (int p = free - 1; p >= 0; p--) {
            shift[p] = full ? product[scan->at[p] + (ptrdiff_t)i * scan->nbasis] : (double)NAN;
            for (int k = p + 1; k < free && full; k++)
                shift[p] -= scan->along[p + (ptrdiff_t)k * free] * shift[k];
            shift[p] /= full ? scan->along[p + (ptrdiff_t)p * free] : 1;
        }
    }
}

/* takes the basis out of every column: C := C - Q (Q' C), twice, in blocks */
static int project(struct pool *pool, struct scan *scan, double *raw)
{
    int n = scan->nrow, q = scan->nbasis;
    double *product = POOL_ARRAY(pool, double, (size_t)q *(size_t)scan->nitem);
    scan->shift = POOL_ARRAY(pool, double, (size_t)scan->nfree *(size_t)scan->nitem);
    if (!product || !scan->shift)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->nitem; i++) {
        const double *column = scan->column + (ptrdiff_t)i * n;
        raw[i] = sqrt(product_dot(n, column, column));
    }
    if (!q)
        find_shifts(product, scan);
    for (int pass = 0; pass < 2 && q && scan->nitem; pass++) {
        product_transposed(q, scan->nitem, n, scan->basis, scan->column, product);
        if (!pass)
            find_shifts(product, scan);
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

/* The columns of every state that has modes to fit. */
static int open_parts(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                      struct part *part, struct scan *scan)
{
    const struct effect none = {.kind = &nothing};
    int status = ROTID_OK;
    for (int s = 0, mode = 0; s < states->nstate && !status; mode += states->state[s].job.measurement.nmode, s++) {
        const struct state *state = &states->state[s];
        double *own = state_values(pool, state, x);
        part[s] = (struct part){.row = scan->nrow, .state = state, .open = job_fitted(&state->job, holdout + mode) > 0};
        if (!own)
            return ROTID_ERROR_MEMORY;
        if (!part[s].open)
            continue;
        status = columns_open(pool, &state->job, number + mode, holdout + mode, &none, own, &part[s].columns);
        if (!status)
            status = columns_prepare(&part[s].columns, NULL);
        scan->nrow += part[s].columns.nrow;
        scan->nfrequency += part[s].columns.nmode;
    }
    return status;
}

/* A state that is held out has no axis to look along: the next one that has the target lends its own. */
static void move_homes(int nstate, const struct part *part, struct scan *scan)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        struct scan_candidate *c = &scan->candidate[i];
        for (int s = c->home + 1; s < nstate && !part[c->home].open; s++)
            c->home = c->in[s] && part[s].open ? s : c->home;
    }
}

/* Residual and its chi2, which rows are frequencies, what is fitted anyway, and the columns. */
static int fill(struct pool *pool, const struct states *states, struct part *part, struct scan *scan)
{
    int status = ROTID_OK;
    double *work = POOL_ARRAY(pool, double, scan->nrow);
    scan->basis = POOL_ARRAY(pool, double, (size_t)(states->nparameter + scan->nfrequency + 1) * (size_t)scan->nrow);
    scan->r = POOL_ARRAY(pool, double, scan->nrow);
    scan->is_frequency = POOL_ARRAY(pool, char, scan->nrow);
    scan->at = POOL_ARRAY(pool, int, states->nparameter);
    scan->along = POOL_ARRAY(pool, double, (size_t)states->nparameter *(size_t)states->nparameter);
    if (!work || !scan->basis || !scan->r || !scan->is_frequency || !scan->at || !scan->along)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate; s++) {
        const struct columns *columns = &part[s].columns;
        if (!part[s].open)
            continue;
        memcpy(scan->r + part[s].row, columns->r, (size_t)columns->nrow * sizeof *scan->r);
        memset(scan->is_frequency + part[s].row, 1, (size_t)columns->nmode);
        scan->chi2_frequency += product_dot(columns->nmode, columns->r, columns->r);
        add_scales(&part[s], scan);
    }
    scan->chi2 = product_dot(scan->nrow, scan->r, scan->r);
    for (int p = 0; p < states->nparameter && !status; p++)
        status = add_unknown(states, p, part, work, scan);
    for (int s = 0; s < states->nstate && !status; s++)
        if (part[s].open)
            status = fill_columns(s, &part[s], scan);
    return status;
}

/* The matrices of the models and their adjoints are large beside what is left of a scan: they stand in `matrices`. */
static int run(struct pool *pool, struct pool *matrices, const struct states *states, const int *number, const int *holdout,
               const double *x, struct scan *scan)
{
    struct part *part = POOL_ARRAY(matrices, struct part, states->nstate);
    int items = 0, n, status = part ? open_parts(matrices, states, number, holdout, x, part, scan) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    n = scan->nrow;
    move_homes(states->nstate, part, scan);
    for (int i = 0; i < scan->ncandidate; i++)
        if (part[scan->candidate[i].home].open)
            items += item_count(scan, &scan->candidate[i], part[scan->candidate[i].home].columns.model.naxis);
    scan->item = POOL_ARRAY(pool, struct scan_item, items);
    scan->column = POOL_ARRAY(pool, double, (size_t)items *(size_t)n);
    double *raw = POOL_ARRAY(pool, double, items);
    if (!scan->item || !scan->column || !raw)
        return ROTID_ERROR_MEMORY;
    list_items(part, scan);
    scan->nfree = states->nparameter;
    status = fill(pool, states, part, scan);
    if (!status)
        status = project(pool, scan, raw);
    if (status)
        return status;
    scan->dof = n - scan->nbasis;
    (void)basis_remove(n, scan->nbasis, scan->basis, scan->r);
    for (int i = 0; i < scan->nitem; i++) {
        struct scan_item *item = &scan->item[i];
        struct scan_candidate *c = &scan->candidate[item->candidate];
        predict(&part[c->home].state->job.rotor, scan, item, raw[i], scan->column + (ptrdiff_t)i * n);
        if (item->usable && (c->best < 0 || item->drop > scan->item[c->best].drop))
            c->best = i;
        scan->largest = fmax(scan->largest, item->drop);
    }
    return ROTID_OK;
}

int scan_run(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
             enum scan_extent extent, struct scan *scan)
{
    struct pool matrices;
    int status = scan_list(pool, states, scan);
    scan->extent = extent;
    if (status)
        return status;
    if (extent == SCAN_FIELDS)
        keep_fields(scan);
    pool_open(&matrices, pool->allocator);
    status = run(pool, &matrices, states, number, holdout, x, scan);
    pool_close(&matrices);
    return status;
}

struct effect scan_effect(const struct scan *scan, int item, double amplitude)
{
    const struct scan_item *i = &scan->item[item];
    const struct scan_candidate *c = &scan->candidate[i->candidate];
    struct effect effect = i->effect;
    if (!c->fixed[c->cause->size])
        effect.value[c->cause->size] += amplitude * i->unit;
    return effect;
}

double scan_best_drop(const struct scan *scan, int candidate)
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    return c->best < 0 ? c->promise : scan->item[c->best].drop;
}

int scan_side(const struct scan_item *item)
{
    return item->side < 0 || (!item->side && -item->lower > item->upper) ? -1 : 1;
}

/* The whitened residual of the frequencies alone, free of what is fitted, has the covariance P = I - Q_f Q_f', Q_f the rows of
 * the basis that are theirs: chi2 of it has the mean tr P and the variance 2 tr P^2, those of g chi2 with h degrees of freedom,
 * g = tr P^2/tr P, h = (tr P)^2/tr P^2 (Satterthwaite 1946). */
double scan_chance_of_frequencies(struct pool *pool, const struct scan *scan)
{
    int n = scan->nbasis;
    double *rows = POOL_ARRAY(pool, double, (size_t)scan->nfrequency *(size_t)n),
           *gram = POOL_ARRAY(pool, double, (size_t)n *(size_t)n), trace = scan->nfrequency, square = trace;
    if (!rows || !gram)
        return NAN;
    for (int b = 0; b < n; b++)
        for (int i = 0, at = 0; i < scan->nrow; i++)
            if (scan->is_frequency[i])
                rows[at++ + (ptrdiff_t)b * scan->nfrequency] = scan->basis[i + (ptrdiff_t)b * scan->nrow];
    if (n && scan->nfrequency)
        product_transposed(n, n, scan->nfrequency, rows, rows, gram);
    for (int b = 0; b < n; b++) {
        trace -= gram[b + (ptrdiff_t)b * n];
        square -= 2 * gram[b + (ptrdiff_t)b * n];
    }
    square += product_dot(n * n, gram, gram);
    return trace > INSEPARABLE && square > INSEPARABLE
               ? chi_square_tail(scan->chi2_frequency * trace / square, trace * trace / square)
               : 1;
}
