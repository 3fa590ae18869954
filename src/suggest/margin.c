#include "suggest/suggest.h"

#define DRAWS 400 /* a chance to 0.025 */

struct side { /* a rival in the state of a test */
    int nrow, n, nscale;
    double *j;      /* [nrow * n] relative parameters that are not pressed against a bound */
    double *unit;   /* [nrow * nscale] directions of the scales, orthonormal */
    double *d;      /* [nrow] */
    double *factor; /* [n * n] of H */
    double *spread; /* [n * n] factor of J1'J1 + I */
    double *work;   /* [nrow + n] */
    double trace;   /* of H^-1 J2'J2 */
    /* the unknowns of all rivals: */
    double *value, *variance,
        *moved; /* [nown] x, the variance of its relative error by both states, and relative step of a draw */
    int *at;    /* [nown] among the n, -1: it cannot follow */
};

/* ------------------------------------------------------------------------------------------------ a rival in a state */

static int take_columns(struct columns *c, const struct rival *rival, const double *x_test, struct side *side)
{
    int status = ROTID_OK, n = 0, row = c->nmode;
    for (int p = 0; p < rival->fit->n && !status; p++) {
        if (!rival_uses(rival, p))
            continue;
        double *column = side->j + (ptrdiff_t)n++ * side->nrow;
        int q = rival_own(rival, p);
        if (q < 0) /* of other states alone */
            continue;
        status = columns_parameter(c, q, column);
        for (int i = 0; i < side->nrow; i++)
            column[i] *= x_test[q];
    }
    for (int k = 0; k < c->nmode; k++) {
        const struct columns_mode *mode = &c->mode[k];
        if (mode->square > 0) {
            double *unit = side->unit + (ptrdiff_t)side->nscale++ * side->nrow;
            for (int i = 0; i < mode->sensors; i++)
                unit[row + i] = mode->weighted[i] / sqrt(mode->square);
        }
        row += mode->sensors;
    }
    return status;
}

static int factor_both(struct pool *pool, const struct rival *rival, const int *own, struct side *s)
{
    size_t cells = (size_t)s->n * (size_t)s->n;
    double *gram = POOL_ARRAY(pool, double, cells), *column = POOL_ARRAY(pool, double, s->n);
    s->factor = POOL_ARRAY(pool, double, cells);
    s->spread = POOL_ARRAY(pool, double, cells);
    if (!gram || !column || !s->factor || !s->spread)
        return ROTID_ERROR_MEMORY;
    rival_gram(rival, own, s->n, s->spread);
    for (int j = 0; j < s->n; j++)
        for (int i = 0; i < s->n; i++)
            gram[i + (ptrdiff_t)j * s->n] = product_dot(s->nrow, s->j + (ptrdiff_t)i * s->nrow, s->j + (ptrdiff_t)j * s->nrow);
    for (size_t i = 0; i < cells; i++)
        s->factor[i] = s->spread[i] + gram[i];
    for (int i = 0; i < s->n; i++) {
        s->spread[i + (ptrdiff_t)i * s->n] += 1;
        s->factor[i + (ptrdiff_t)i * s->n] *= 1 + 1e-12; /* a parameter that neither state feels */
        if (!(s->factor[i + (ptrdiff_t)i * s->n] > 0))
            s->factor[i + (ptrdiff_t)i * s->n] = 1;
    }
    if (cholesky_factor(s->n, s->factor) || cholesky_factor(s->n, s->spread))
        return ROTID_ERROR_RANK;
    for (int j = 0; j < s->n; j++) {
        memcpy(column, gram + (ptrdiff_t)j * s->n, (size_t)s->n * sizeof *column);
        cholesky_solve(s->n, s->factor, 1, column);
        s->trace += column[j];
    }
    return ROTID_OK;
}

/* Rival b where `measured` is what rival a would give in that state, its model in *c on the scratch pool; like: NULL, or that of
 * the same rival for another a. ROTID_OK, memory, or a status that says that it has no model or no partner there. */
static int side_open(struct pool *pool, struct pool *scratch, const struct rival *b, const struct test *test,
                     const struct job_measurement *measured, const struct columns *like, struct columns *c, struct side *s)
{
    int nparameter = b->job.unknowns.nparameter;
    double *x = POOL_ARRAY(scratch, double, nparameter);
    int *own = POOL_ARRAY(scratch, int, nparameter), *own_of_all = POOL_ARRAY(scratch, int, b->fit->n);
    struct job job;
    *s = (struct side){0};
    if (!x || !own || !own_of_all)
        return ROTID_ERROR_MEMORY;
    int status = test_apply(scratch, test, &b->job, b->x, &job, x, own);
    if (status)
        return status;
    job.measurement = *measured;
    status = planned_on_coarse(scratch, &job);
    if (!status)
        status = columns_open(scratch, &job, measured->number, measured->holdout, NULL, x, c);
    if (!status)
        status = columns_prepare(c, like);
    if (status)
        return status;
    for (int p = 0; p < b->fit->n; p++) {
        int q = rival_own(b, p);
        s->n += rival_uses(b, p);
        own_of_all[p] = q >= 0 && own[q];
    }
    s->nrow = c->nrow;
    s->j = POOL_ARRAY(pool, double, (size_t)s->nrow *(size_t)s->n);
    s->unit = POOL_ARRAY(pool, double, (size_t)s->nrow *(size_t)c->nmode);
    s->d = POOL_COPY(pool, c->r, s->nrow, 0);
    s->work = POOL_ARRAY(pool, double, s->nrow + s->n);
    if (!s->j || !s->unit || !s->d || !s->work)
        return ROTID_ERROR_MEMORY;
    status = take_columns(c, b, x, s);
    return status ? status : factor_both(pool, b, own_of_all, s);
}

/* Q(z) */
static double remainder_of(struct side *s, const double *z)
{
    double *left = s->work, *along = s->work + s->nrow;
    memcpy(left, z, (size_t)s->nrow * sizeof *left);
    for (int k = 0; k < s->nscale; k++) {
        const double *unit = s->unit + (ptrdiff_t)k * s->nrow;
        double length = product_dot(s->nrow, unit, left);
        for (int i = 0; i < s->nrow; i++)
            left[i] -= length * unit[i];
    }
    for (int p = 0; p < s->n; p++)
        along[p] = product_dot(s->nrow, s->j + (ptrdiff_t)p * s->nrow, left);
    cholesky_forward(s->n, s->factor, 1, along);
    return fmax(0, product_dot(s->nrow, left, left) - product_dot(s->n, along, along));
}

/* ------------------------------------------------------------------------------------------------ all rivals */

/* side [n - 1]: rival b where each of the others but the last one is true. Of a solid a model takes 100 MB: of the rival's own
 * the first one stays until all are opened, whose adjoints serve the others. */
static int open_rival(struct pool *pool, const struct rivals *rivals, const struct test *test, int b,
                      const struct job_measurement *measured, struct side **side)
{
    struct columns first, other;
    struct pool of_first;
    int status = ROTID_OK;
    pool_open(&of_first, pool->allocator);
    for (int a = 0; a + 1 < rivals->n && !status; a++) {
        struct pool scratch;
        pool_open(&scratch, pool->allocator);
        status = side_open(pool, a ? &scratch : &of_first, &rivals->rival[b], test, &measured[a], a ? &first : NULL,
                           a ? &other : &first, &side[a][b]);
        pool_close(&scratch);
    }
    pool_close(&of_first);
    return status;
}

/* side [n - 1][n]: every rival where each but the last one is true; none where the state is not feasible. */
static int open_sides(struct pool *pool, const struct rivals *rivals, const struct test *test, struct side ***side, int *feasible)
{
    int n = rivals->n, status = ROTID_OK;
    struct job_measurement *measured = POOL_ARRAY(pool, struct job_measurement, n);
    *side = POOL_ARRAY(pool, struct side *, n);
    if (!measured || !*side)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a + 1 < n && !status; a++) {
        (*side)[a] = POOL_ARRAY(pool, struct side, n);
        status = (*side)[a] ? joint_measurement(pool, &rivals->rival[a], rivals->rival[a].x, test, 1, &measured[a])
                            : ROTID_ERROR_MEMORY;
    }
    for (int b = 0; b < n && !status; b++)
        status = open_rival(pool, rivals, test, b, measured, *side);
    *feasible = !status;
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

int margin_distances(struct pool *pool, const struct rivals *rivals, const struct test *test, double *distance, int *feasible)
{
    struct side **side;
    int n = rivals->n, status = open_sides(pool, rivals, test, &side, feasible);
    for (int a = 0; a + 1 < n && !status && *feasible; a++)
        for (int b = 0; b < n; b++)
            distance[b + (ptrdiff_t)a * n] = b == a ? 0 : remainder_of(&side[a][b], side[a][b].d);
    return status;
}

/* The unknowns that the model as it is has, which every rival has, too. */
static int open_unknowns(struct pool *pool, const struct rival *rival, int nown, struct side *s)
{
    double *column = POOL_ARRAY(pool, double, s->n);
    s->value = POOL_ARRAY(pool, double, nown);
    s->variance = POOL_ARRAY(pool, double, nown);
    s->moved = POOL_ARRAY(pool, double, nown);
    s->at = POOL_ARRAY(pool, int, nown);
    if (!column || !s->value || !s->variance || !s->moved || !s->at)
        return ROTID_ERROR_MEMORY;
    for (int p = 0, used = 0; p < nown; p++) {
        s->value[p] = rival->fit->x[p];
        s->at[p] = rival_uses(rival, p) ? used++ : -1;
        if (s->at[p] < 0)
            continue;
        memset(column, 0, (size_t)s->n * sizeof *column);
        column[s->at[p]] = 1;
        cholesky_solve(s->n, s->factor, 1, column);
        s->variance[p] = column[s->at[p]];
    }
    return ROTID_OK;
}

/* The steps of the unknowns in the fit that remainder_of has just made: H^-1 J2'z. */
static void take_steps(int nown, struct side *s)
{
    double *along = s->work + s->nrow;
    cholesky_backward_leading(s->n, s->n, s->factor, along);
    for (int p = 0; p < nown; p++)
        s->moved[p] = s->at[p] < 0 ? 0 : along[s->at[p]];
}

/* The lead expected: noise is white, and what is not known of the truth lies along the columns of J_a2 C_a^(1/2). */
static double expected(struct side *a, struct side *b, const double *spread, double before)
{
    double sum = before + remainder_of(b, b->d) + a->trace - b->trace;
    for (int p = 0; p < a->n; p++) {
        const double *w = spread + (ptrdiff_t)p * a->nrow;
        sum += remainder_of(b, w) - remainder_of(a, w);
    }
    return sum;
}

/* spread [nrow * n] := J2 C^(1/2), C^(1/2) = L^-T of the factor L of C^-1: column p is J2 times that of L^-T */
static void make_spread(const struct side *a, double *spread)
{
    for (int p = 0; p < a->n; p++) {
        double *column = a->work, *to = spread + (ptrdiff_t)p * a->nrow;
        memset(column, 0, (size_t)a->n * sizeof *column);
        column[p] = 1;
        cholesky_backward_leading(a->n, a->n, a->spread, column);
        for (int i = 0; i < a->nrow; i++) {
            to[i] = 0;
            for (int q = 0; q < a->n; q++)
                to[i] += a->j[i + (ptrdiff_t)q * a->nrow] * column[q];
        }
    }
}

struct counts { /* sums over draws */
    int named, wrong;
    double entropy;
    double *variance; /* [nown] of the mixture of all rivals */
};

/* Probabilities of the rivals by a draw, chi2 [n] in, and what follows of them. */
static void weigh_draw(int n, int truth, int nown, const struct side *side, double *chi2, struct counts *count)
{
    double least = INFINITY, sum = 0;
    for (int b = 0; b < n; b++)
        least = fmin(least, chi2[b]);
    for (int b = 0; b < n; b++)
        sum += chi2[b] = exp((least - chi2[b]) / 2);
    for (int b = 0; b < n; b++) {
        double share = chi2[b] /= sum;
        count->entropy -= share > 0 ? share * log(share) : 0;
        if (b + 1 < n && share >= VERDICT_NAMED)
            *(b == truth ? &count->named : &count->wrong) += 1;
    }
    for (int p = 0; p < nown; p++) {
        double mean = 0, square = 0;
        for (int b = 0; b < n; b++) {
            double x = side[b].value[p], at = x * (1 + side[b].moved[p]);
            mean += chi2[b] * at;
            square += chi2[b] * (at * at + x * x * side[b].variance[p]);
        }
        count->variance[p] += fmax(0, square - mean * mean);
    }
}

/* *count over the draws; won [n] how often the lead over each rival suffices */
static int draw_all(struct pool *pool, const struct rivals *rivals, int truth, struct side *side, const double *spread,
                    unsigned long seed, struct counts *count, int *won)
{
    int nown = rivals->rival[rivals->n - 1].fit->n;
    struct side *a = &side[truth];
    int n = rivals->n;
    struct random_stream stream = {seed};
    double *w = POOL_ARRAY(pool, double, a->nrow), *z = POOL_ARRAY(pool, double, a->nrow), *chi2 = POOL_ARRAY(pool, double, n);
    if (!w || !z || !chi2)
        return ROTID_ERROR_MEMORY;
    for (int draw = 0; draw < DRAWS; draw++) {
        for (int i = 0; i < a->nrow; i++)
            w[i] = random_normal(&stream);
        for (int p = 0; p < a->n; p++) {
            double size = random_normal(&stream);
            for (int i = 0; i < a->nrow; i++)
                w[i] += size * spread[i + (ptrdiff_t)p * a->nrow];
        }
        for (int b = 0; b < n; b++) {
            for (int i = 0; i < a->nrow; i++)
                z[i] = w[i] - (b == truth ? 0 : side[b].d[i]);
            chi2[b] = rivals->rival[b].score + remainder_of(&side[b], z);
            take_steps(nown, &side[b]);
        }
        for (int b = 0; b < n; b++)
            won[b] += chi2[b] - chi2[truth] > rivals->margin;
        weigh_draw(n, truth, nown, side, chi2, count);
    }
    return ROTID_OK;
}

static int judge_truth(struct pool *pool, const struct rivals *rivals, struct side *side, int truth, unsigned long seed,
                       rotid_suggested_test *out)
{
    int n = rivals->n, nown = rivals->rival[n - 1].fit->n, *won = POOL_ARRAY(pool, int, n), status = ROTID_OK;
    struct counts count = {.variance = POOL_ARRAY(pool, double, nown)};
    if (!won || !count.variance)
        return ROTID_ERROR_MEMORY;
    for (int b = 0; b < n && !status; b++)
        status = open_unknowns(pool, &rivals->rival[b], nown, &side[b]);
    if (status)
        return status;
    struct side *a = &side[truth];
    double *spread = POOL_ARRAY(pool, double, (size_t)a->nrow *(size_t)a->n);
    if (!spread)
        return ROTID_ERROR_MEMORY;
    make_spread(a, spread);
    status = draw_all(pool, rivals, truth, side, spread, seed, &count, won);
    const struct rival *true_one = &rivals->rival[truth];
    out->chance += rivals->among * true_one->share * count.named / DRAWS;
    out->wrong += rivals->among * true_one->share * count.wrong / DRAWS;
    out->entropy += true_one->share * count.entropy / DRAWS;
    for (int p = 0; p < out->nexpected_percent; p++)
        out->expected_percent[p] += true_one->share * count.variance[p] / DRAWS;
    for (int b = 0; b < n && !status; b++) {
        double before = rivals->rival[b].score - true_one->score;
        if (b != truth)
            out->margins[out->nmargins++] = (rotid_expected_margin){.truth = truth,
                                                                    .rival = b,
                                                                    .before = before,
                                                                    .distance = remainder_of(&side[b], side[b].d),
                                                                    .expected = expected(a, &side[b], spread, before),
                                                                    .refitted = NAN,
                                                                    .chance = (double)won[b] / DRAWS};
    }
    return status;
}

int margin_judge(struct pool *pool, const struct rivals *rivals, const struct test *test, unsigned long seed,
                 rotid_suggested_test *out, int *feasible)
{
    int status = ROTID_OK, n = rivals->n;
    int nown = rivals->rival[n - 1].fit->n;
    out->chance = out->wrong = out->entropy = 0;
    out->nmargins = 0;
    out->nexpected_percent = POOL_LIST(pool, out->expected_percent, nown);
    *feasible = POOL_LIST(pool, out->margins, (size_t)n * (size_t)n) > 0 && out->nexpected_percent == nown;
    if (!*feasible)
        return ROTID_ERROR_MEMORY;
    struct side **side;
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    status = open_sides(&scratch, rivals, test, &side, feasible);
    for (int a = 0; a + 1 < n && !status && *feasible; a++)
        status = judge_truth(&scratch, rivals, side[a], a, seed, out);
    status = scratch.out_of_memory ? ROTID_ERROR_MEMORY : status;
    pool_close(&scratch);
    for (int p = 0; p < nown; p++) /* variances so far */
        out->expected_percent[p] = 196 * sqrt(out->expected_percent[p]) / fabs(rivals->rival->fit->x[p]);
    return status;
}
