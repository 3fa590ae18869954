#include "suggest/suggest.h"

#define MOST_PASSES 4    /* of exchanges: the second one seldom finds anything */
#define GAIN        1e-6 /* of a value, a logarithm: less is rounding */

struct sums { /* over a set of places: of one design and the modes wanted */
    int modes;
    double *uu, *uc, *cc, *square; /* [modes], [modes * columns], [nparam * columns], [ntarget] */
};

int design_new(struct pool *pool, int nmode, int nplace, int nwhole, int nparam, int ntarget, struct design *d)
{
    size_t rows = (size_t)nmode * (1 + (size_t)nplace) + (size_t)nwhole, cells = (size_t)nplace * (size_t)nmode;
    *d = (struct design){.nmode = nmode, .nplace = nplace, .nwhole = nwhole, .nparam = nparam, .ntarget = ntarget};
    d->column = POOL_ARRAY(pool, double, rows *(size_t)(nparam + ntarget));
    d->scale = POOL_ARRAY(pool, double, cells);
    d->largest = POOL_ARRAY(pool, double, cells);
    d->prior = POOL_ARRAY(pool, double, (size_t)nparam *(size_t)nparam);
    return d->column && d->scale && d->largest && d->prior ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void design_take_shapes(const struct columns *c, struct design *d)
{
    for (int k = 0; k < d->nmode; k++)
        for (int i = 0; i < d->nplace; i++) {
            ptrdiff_t cell = i + (ptrdiff_t)k * d->nplace;
            d->scale[cell] = c->mode[k].weighted[i];
            d->largest[cell] = fabs(c->job->measurement.shape[cell]);
        }
}

static int columns_of(const struct design *d)
{
    return d->nparam + d->ntarget;
}

static int first_whole(const struct design *d)
{
    return d->nmode * (1 + d->nplace);
}

static double at(const struct design *d, int column, int row)
{
    return d->column[row + (ptrdiff_t)column * (first_whole(d) + d->nwhole)];
}

/* weight: of the products c_i c_j */
static void add_row(const struct design *d, int row, double weight, struct sums *s)
{
    int p = d->nparam, all = columns_of(d);
    for (int j = 0; j < all; j++) {
        double c = weight * at(d, j, row);
        for (int i = 0; i < p; i++)
            s->cc[i + (ptrdiff_t)j * p] += at(d, i, row) * c;
        if (j >= p)
            s->square[j - p] += at(d, j, row) * c;
    }
}

static void add_place(const struct design *d, int place, const double *weight, double sign, struct sums *s)
{
    for (int k = 0; k < s->modes; k++) {
        int row = d->nmode + k * d->nplace + place;
        double u = d->scale[place + (ptrdiff_t)k * d->nplace], w = sign * (weight ? weight[k] : 1);
        s->uu[k] += w * u * u;
        for (int j = 0; j < columns_of(d); j++)
            s->uc[k + (ptrdiff_t)j * s->modes] += w * u * at(d, j, row);
        add_row(d, row, w, s);
    }
}

static int sums_new(struct pool *pool, const struct design *d, int modes, struct sums *s)
{
    size_t all = (size_t)columns_of(d);
    *s = (struct sums){.modes = modes < d->nmode ? modes : d->nmode};
    s->uu = POOL_ARRAY(pool, double, s->modes);
    s->uc = POOL_ARRAY(pool, double, (size_t)s->modes *all);
    s->cc = POOL_ARRAY(pool, double, (size_t)d->nparam *all);
    s->square = POOL_ARRAY(pool, double, d->ntarget);
    if (!s->uu || !s->uc || !s->cc || !s->square)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < s->modes; k++)
        add_row(d, k, 1, s);
    for (int i = 0; i < d->nwhole; i++)
        add_row(d, first_whole(d) + i, 1, s);
    return ROTID_OK;
}

/* c_i'c_j with the scales taken out */
static double gram(const struct design *d, const struct sums *s, int i, int j)
{
    double g = j >= d->nparam && i == j ? s->square[j - d->nparam] : s->cc[i + (ptrdiff_t)j * d->nparam];
    for (int k = 0; k < s->modes; k++)
        if (s->uu[k] > 0)
            g -= s->uc[k + (ptrdiff_t)i * s->modes] * s->uc[k + (ptrdiff_t)j * s->modes] / s->uu[k];
    return g;
}

static double log_determinant(int n, const double *factor)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += 2 * log(factor[i + (ptrdiff_t)i * n]);
    return sum;
}

/* work [nparam * (nparam + 1)] */
static int evaluate(const struct design *d, const struct sums *s, struct information *out, double *work)
{
    int p = d->nparam;
    double *side = work + (ptrdiff_t)p * p, before;
    memcpy(work, d->prior, (size_t)p * (size_t)p * sizeof *work);
    if (cholesky_factor(p, work))
        return ROTID_ERROR_RANK;
    before = log_determinant(p, work);
    for (int j = 0; j < p; j++)
        for (int i = 0; i < p; i++) {
            double g = gram(d, s, i, j);
            work[i + (ptrdiff_t)j * p] = d->prior[i + (ptrdiff_t)j * p] + g;
            if (out->gram)
                out->gram[i + (ptrdiff_t)j * p] = g;
        }
    if (cholesky_factor(p, work))
        return ROTID_ERROR_RANK;
    out->value = log_determinant(p, work) - before;
    out->target = 0;
    for (int t = 0; t < d->ntarget; t++) {
        double q = gram(d, s, p + t, p + t);
        for (int i = 0; i < p; i++)
            side[i] = gram(d, s, i, p + t);
        cholesky_forward(p, work, 1, side);
        for (int i = 0; i < p; i++)
            q -= side[i] * side[i];
        q = fmax(q, 0);
        if (out->q)
            out->q[t] = q;
        out->target += log1p(q) / d->ntarget;
    }
    out->value = d->targets_alone ? out->target : out->value + out->target;
    return ROTID_OK;
}

static double *work_for(struct pool *pool, const struct design *d)
{
    return POOL_ARRAY(pool, double, (size_t)d->nparam *((size_t)d->nparam + 1));
}

int design_information(struct pool *pool, const struct design *d, int modes, const int *taken, int own, struct information *out)
{
    struct sums s;
    int status = sums_new(pool, d, modes, &s);
    double *work = work_for(pool, d), *weight = POOL_ARRAY(pool, double, d->nmode);
    if (status || !work || !weight)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < s.modes; k++) {
        double largest = 0;
        for (int i = 0; i < d->nplace && taken; i++)
            if (taken[i])
                largest = fmax(largest, d->largest[i + (ptrdiff_t)k * d->nplace]);
        weight[k] = own && largest > 0 ? 1 / (largest * largest) : 1;
    }
    for (int i = 0; i < d->nplace && taken; i++)
        if (taken[i])
            add_place(d, i, weight, 1, &s);
    return evaluate(d, &s, out, work);
}

int design_value(struct pool *pool, int ndesign, const struct design *design, int modes, const int *taken, double *value)
{
    struct information information = {0};
    *value = 0;
    for (int d = 0; d < ndesign; d++) {
        int status = design_information(pool, &design[d], modes, taken, 0, &information);
        if (status)
            return status;
        *value += information.value / ndesign;
    }
    return ROTID_OK;
}

int design_half_widths(struct pool *pool, int n, const double *g, double *half_width)
{
    double *factor = POOL_COPY(pool, g, (size_t)n * (size_t)n, 0), *unit = POOL_ARRAY(pool, double, n);
    if (!factor || !unit)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++)
        half_width[p] = NAN;
    if (cholesky_factor(n, factor))
        return ROTID_OK;
    for (int p = 0; p < n; p++) {
        double square = 0;
        memset(unit, 0, (size_t)n * sizeof *unit);
        unit[p] = 1;
        cholesky_forward(n, factor, 1, unit);
        for (int i = 0; i < n; i++)
            square += unit[i] * unit[i];
        half_width[p] = 196 * sqrt(square);
        if (!(half_width[p] <= 100))
            half_width[p] = NAN;
    }
    return ROTID_OK;
}

struct choice {
    int ndesign, modes, nplace;
    const struct design *design;
    struct sums *sums; /* [ndesign] of the places taken */
    double **work;     /* [ndesign] */
    const double *z;
    double apart;
    int *taken;
};

static void change(struct choice *c, int place, int take)
{
    for (int d = 0; d < c->ndesign; d++)
        add_place(&c->design[d], place, NULL, take ? 1 : -1, &c->sums[d]);
    c->taken[place] = take;
}

static int total(const struct choice *c, double *value)
{
    struct information information = {0};
    *value = 0;
    for (int d = 0; d < c->ndesign; d++) {
        int status = evaluate(&c->design[d], &c->sums[d], &information, c->work[d]);
        if (status)
            return status;
        *value += information.value / c->ndesign;
    }
    return ROTID_OK;
}

static int is_free(const struct choice *c, int place)
{
    for (int i = 0; i < c->nplace; i++)
        if (c->taken[i] && fabs(c->z[i] - c->z[place]) < c->apart)
            return 0;
    return 1;
}

/* The free place of the largest value, the first of those that are equal, *best -1 where none is above `least`. */
static int best_addition(struct choice *c, double least, int *best)
{
    *best = -1;
    for (int i = 0; i < c->nplace; i++) {
        double value;
        if (!is_free(c, i))
            continue;
        change(c, i, 1);
        int status = total(c, &value);
        change(c, i, 0);
        if (status)
            return status;
        if (value > least + GAIN) {
            least = value;
            *best = i;
        }
    }
    return ROTID_OK;
}

static int exchange(struct choice *c, const int *fixed)
{
    int status = ROTID_OK, changed = 1;
    for (int pass = 0; pass < MOST_PASSES && changed && !status; pass++) {
        changed = 0;
        for (int i = 0; i < c->nplace && !status; i++) {
            double before = 0;
            int best;
            if (!c->taken[i] || fixed[i])
                continue;
            status = total(c, &before);
            change(c, i, 0);
            if (!status)
                status = best_addition(c, before, &best);
            if (!status && best >= 0 && best != i)
                changed = 1;
            change(c, !status && best >= 0 ? best : i, 1);
        }
    }
    return status;
}

/* With the places that are taken. */
static int choice_open(struct pool *pool, struct choice *c)
{
    c->sums = POOL_ARRAY(pool, struct sums, c->ndesign);
    c->work = POOL_ARRAY(pool, double *, c->ndesign);
    if (!c->sums || !c->work)
        return ROTID_ERROR_MEMORY;
    for (int d = 0; d < c->ndesign; d++)
        if (sums_new(pool, &c->design[d], c->modes, &c->sums[d]) || !(c->work[d] = work_for(pool, &c->design[d])))
            return ROTID_ERROR_MEMORY;
    for (int i = 0; i < c->nplace; i++)
        if (c->taken[i])
            change(c, i, 1);
    return ROTID_OK;
}

int design_improve(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart,
                   int *taken)
{
    struct choice c = {
        .ndesign = ndesign, .design = design, .modes = modes, .nplace = design->nplace, .z = z, .apart = apart, .taken = taken};
    int *fixed = POOL_ARRAY(pool, int, c.nplace), status = fixed ? choice_open(pool, &c) : ROTID_ERROR_MEMORY;
    return status ? status : exchange(&c, fixed);
}

int design_choose(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart, int n,
                  int (*told)(void *context, const int *taken), void *context, int *taken)
{
    struct choice c = {
        .ndesign = ndesign, .design = design, .modes = modes, .nplace = design->nplace, .z = z, .apart = apart, .taken = taken};
    int count = 0, *fixed = POOL_ARRAY(pool, int, c.nplace), status = fixed ? choice_open(pool, &c) : ROTID_ERROR_MEMORY;
    for (int i = 0; i < c.nplace && !status; i++)
        count += fixed[i] = taken[i];
    for (int best = 0; count < n && best >= 0 && !status;) {
        status = best_addition(&c, -INFINITY, &best);
        if (status || best < 0)
            break;
        change(&c, best, 1);
        count++;
        status = told ? told(context, taken) : ROTID_OK;
    }
    return status ? status : exchange(&c, fixed);
}

int effective_independence(struct pool *pool, int nplace, int modes, const double *shape, int n, int *taken)
{
    size_t square = (size_t)modes * (size_t)modes;
    double *fisher = POOL_ARRAY(pool, double, square), *row = POOL_ARRAY(pool, double, modes);
    if (!fisher || !row)
        return ROTID_ERROR_MEMORY;
    int count = 0;
    for (int i = 0; i < nplace; i++)
        count += taken[i];
    for (int left = count; left > n && left > modes; left--) {
        int least = -1;
        double smallest = INFINITY;
        memset(fisher, 0, square * sizeof *fisher);
        for (int i = 0; i < nplace; i++)
            for (int a = 0; a < modes && taken[i]; a++)
                for (int b = 0; b < modes; b++)
                    fisher[a + b * modes] += shape[i + (ptrdiff_t)a * nplace] * shape[i + (ptrdiff_t)b * nplace];
        if (cholesky_factor(modes, fisher))
            return ROTID_ERROR_RANK;
        for (int i = 0; i < nplace; i++) {
            double leverage = 0;
            if (!taken[i])
                continue;
            for (int a = 0; a < modes; a++)
                row[a] = shape[i + (ptrdiff_t)a * nplace];
            cholesky_forward(modes, fisher, 1, row);
            for (int a = 0; a < modes; a++)
                leverage += row[a] * row[a];
            if (leverage < smallest) {
                smallest = leverage;
                least = i;
            }
        }
        taken[least] = 0;
    }
    return ROTID_OK;
}
