#include "modal/modal.h"

/* ROTID_OK or ROTID_ERROR_MEMORY. */
static int condensed_new(struct pool *pool, struct prediction *p)
{
    const rotid_model *model = p->model;
    int from = model->nrigid < p->count ? model->nrigid : 0, status = ROTID_OK;
    if (p->reduction == ROTID_GUYAN)
        status = eigen_guyan_new(pool, &p->k, model->nmaster, model->master, p->count, from, &p->guyan);
    size_t vectors = p->guyan.applies ? (size_t)p->count * (size_t)model->n : 0;
    p->full_phi = POOL_ARRAY(pool, double, vectors);
    p->adjoint = POOL_ARRAY(pool, double, vectors);
    p->image = POOL_ARRAY(pool, double, 2 * vectors);
    if (status || !p->full_phi || !p->adjoint || !p->image)
        return status ? status : ROTID_ERROR_MEMORY;
    if (p->guyan.applies && model->modes && model->nmodes >= p->count)
        eigen_guyan_begin(&p->guyan, model->modes);
    return ROTID_OK;
}

/* lambda := lambda + sum dlambda_q (x_q - here_q), where that is known and no leap */
static void extrapolate_eigenvalues(struct prediction *p, const double *x)
{
    for (int k = 0; k < p->count; k++) {
        double here = p->lambda[k], there = here;
        for (int q = 0; q < p->model->nparam && p->turned[k]; q++)
            there += p->dlambda[k + (ptrdiff_t)q * p->count] * (x[q] - p->here[q]);
        p->turned[k] = 0;
        if (there > here / 2 && there < 2 * here)
            p->lambda[k] = there;
    }
}

/* As prediction_compute, with K and M in place. p->by_bands tells which way it went. */
static int condensed_compute(struct prediction *p, const double *x)
{
    int n = p->model->n, status = ROTID_OK;
    extrapolate_eigenvalues(p, x);
    p->by_bands = !eigen_guyan_solve(&p->guyan, &p->k, &p->m, p->begun ? p->lambda : NULL, p->lambda, p->phi);
    if (!p->by_bands) {
        status = reduction_compute(&p->condensed, &p->k, &p->m);
        if (!status)
            status = eigen_dense_solve(&p->dense, p->condensed.kc, p->condensed.mc, p->lambda, p->phi);
        if (!status && p->guyan.applies) {
            for (int k = 0; k < p->count; k++)
                reduction_expand(&p->condensed, p->phi + (ptrdiff_t)k * p->size, p->full_phi + (ptrdiff_t)k * n);
            eigen_guyan_begin(&p->guyan, p->full_phi);
        }
    }
    p->begun = !status;
    if (p->model->nparam)
        memcpy(p->here, x, (size_t)p->model->nparam * sizeof *x);
    return status;
}

/* The pairs from the first to the last that is wanted: first ... *end - 1 */
static int range_of(int count, const int *wanted, int *end)
{
    int first = 0;
    while (first < count && !wanted[first])
        first++;
    for (*end = count; *end > first && !wanted[*end - 1];)
        --*end;
    return first;
}

/* dlambda = u' (dK - lambda dM) u - 2 (S (K - lambda M) u)' dK u, u = T x: (36) */
static int condensed_differentiate(struct prediction *p, const double *x, const int *wanted)
{
    int n = p->model->n, end, first = range_of(p->count, wanted, &end), columns = end - first;
    ptrdiff_t at = (ptrdiff_t)first * n;
    double *u = p->full_phi + at, *adjoint = p->adjoint + at, *dk_u = p->image, *dm_u = dk_u + (ptrdiff_t)columns * n;
    int status = reduction_begin(&p->condensed, &p->k, &p->m);
    if (status || !columns)
        return status;
    for (int k = first; k < end; k++)
        eigen_guyan_expand(&p->guyan, k, p->full_phi + (ptrdiff_t)k * n);
    reduction_adjoint(&p->condensed, columns, p->lambda + first, u, adjoint, dk_u);
    for (int q = 0; q < p->model->nparam; q++) {
        status = prediction_matrix_derivatives(p, x, q);
        if (status)
            return status;
        matrix_multiply(&p->dk, columns, u, dk_u);
        if (!p->dm_is_zero)
            matrix_multiply(&p->dm, columns, u, dm_u);
        for (int j = 0; j < columns; j++) {
            const double *uj = u + (ptrdiff_t)j * n, *dk_uj = dk_u + (ptrdiff_t)j * n;
            double slope = product_dot(n, uj, dk_uj) - 2 * product_dot(n, adjoint + (ptrdiff_t)j * n, dk_uj);
            if (!p->dm_is_zero)
                slope -= p->lambda[first + j] * product_dot(n, uj, dm_u + (ptrdiff_t)j * n);
            p->dlambda[first + j + (ptrdiff_t)q * p->count] = slope;
        }
    }
    for (int k = 0; k < p->count; k++)
        p->turned[k] = wanted[k];
    return ROTID_OK;
}

#define FAR 0.1 /* squared change of a vector, of its length squared, from which its first order is not trusted */

static int new_matrices(struct pool *pool, const rotid_model *model, struct prediction *p)
{
    rotid_matrix *all[] = {&p->k, &p->m, &p->dk, &p->dm, &p->other_k, &p->other_m};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        int status = matrix_new(pool, model->n, model->kd, model->nfar, model->far, all[i]);
        if (status)
            return status;
    }
    return ROTID_OK;
}

static int new_solvers(struct pool *pool, const rotid_model *model, int with_vectors, struct prediction *p)
{
    int status;
    if (p->reduction == ROTID_REDUCTION_NONE) {
        status = eigen_full_new(pool, &p->k, p->count, &p->full);
        return status || !with_vectors ? status : nelson_band_new(pool, &p->k, model->nparam, &p->nelson_band);
    }
    status = reduction_new(pool, p->reduction, &p->k, model->nmaster, model->master, &p->condensed);
    p->mode = POOL_ARRAY(pool, struct reduction_mode, p->count);
    double *vectors = POOL_ARRAY(pool, double, 4 * (size_t)p->count * (size_t)model->n);
    if (!p->mode || !vectors)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < p->count; k++) {
        double *u = vectors + 4 * (ptrdiff_t)k * model->n;
        p->mode[k] = (struct reduction_mode){u, u + model->n, u + 2 * (ptrdiff_t)model->n, u + 3 * (ptrdiff_t)model->n};
    }
    if (!status)
        status = eigen_dense_new(pool, p->size, p->count, &p->dense);
    if (!status && !with_vectors)
        status = condensed_new(pool, p);
    return status || !with_vectors ? status : nelson_dense_new(pool, p->size, &p->nelson_dense);
}

int prediction_new(struct pool *pool, const rotid_model *model, int reduction, int derivative, int count, int with_vectors,
                   struct prediction *p)
{
    int full = reduction == ROTID_REDUCTION_NONE;
    *p = (struct prediction){.model = model, .reduction = reduction, .derivative = derivative, .with_vectors = with_vectors};
    p->size = full ? model->n : model->nmaster;
    if (count < 1 || count > p->size || (full && derivative == ROTID_MODAL) || (!full && model->sensor))
        return ROTID_ERROR_ARGUMENT;
    p->count = count;
    if (with_vectors && derivative == ROTID_MODAL)
        p->count = p->size;
    else if (with_vectors && count < p->size)
        p->count++; /* the neighbour above the last may be close to it */
    size_t vectors = (size_t)p->size * (size_t)p->count, nparam = (size_t)model->nparam;
    p->lambda = POOL_ARRAY(pool, double, p->count);
    p->phi = POOL_ARRAY(pool, double, vectors);
    p->dlambda = POOL_ARRAY(pool, double, (size_t)p->count *nparam);
    p->dphi = POOL_ARRAY(pool, double, with_vectors ? vectors *nparam : 0);
    p->right = POOL_ARRAY(pool, double, with_vectors ? vectors *nparam : 0);
    p->constant = POOL_ARRAY(pool, double, with_vectors ? CLUSTER_MOST *(size_t)p->count *nparam : 0);
    p->m_phi = POOL_ARRAY(pool, double, with_vectors ? vectors : 0);
    p->kx = POOL_ARRAY(pool, double, with_vectors && !full ? vectors * nparam : 0);
    p->mx = POOL_ARRAY(pool, double, with_vectors && !full ? vectors * nparam : 0);
    p->below = POOL_ARRAY(pool, double, with_vectors ? (size_t)p->size *nparam : 0);
    p->image = POOL_ROOM(pool, double, full ? 2 * vectors : 0);
    p->dk_is_zero = p->dm_is_zero = 1; /* as the pool gives them */
    p->x = POOL_ARRAY(pool, double, nparam);
    p->work = POOL_ARRAY(pool, double, 6 * (size_t)model->n);
    p->turned = POOL_ARRAY(pool, int, p->count);
    p->here = POOL_ARRAY(pool, double, nparam);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    int status = new_matrices(pool, model, p);
    if (!status)
        status = new_solvers(pool, model, with_vectors, p);
    if (!status && full && with_vectors) /* rigid motions have no number, and the neighbour is looked at from afar */
        eigen_full_want(&p->full, model->nrigid < count ? model->nrigid : 0, count);
    if (!status && full && model->modes && model->nmodes >= p->count)
        eigen_full_begin(&p->full, model->modes);
    return status;
}

static int evaluate(struct prediction *p, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const rotid_model *model = p->model;
    matrix_zero(k);
    matrix_zero(m);
    int failed = model->matrices(model->user, x, k, m);
    if (failed)
        return failure_say(p->failure, ROTID_ERROR_CALLBACK, "model->matrices returned %d", failed);
    int status = matrix_check_entries("the stiffness of model->matrices", k, p->failure);
    return status ? status : matrix_check_entries("the mass of model->matrices", m, p->failure);
}

/* phi := phi + sum dphi_q (x_q - here_q) for the pairs whose derivatives are known, as a beginning of the solution at x: its
 * error is of second order then. A vector that would turn far is left as it is. */
static void extrapolate(struct prediction *p, const double *x)
{
    int n = p->size, any = 0;
    for (int k = 0; k < p->count; k++) {
        double *phi = p->phi + (ptrdiff_t)k * n, *turn = p->work;
        if (!p->turned[k])
            continue;
        p->turned[k] = 0;
        memset(turn, 0, (size_t)n * sizeof *turn);
        for (int q = 0; q < p->model->nparam; q++) {
            const double *dphi = p->dphi + prediction_place(p, k, q), step = x[q] - p->here[q];
            for (int i = 0; i < n; i++)
                turn[i] += step * dphi[i];
        }
        if (!(product_dot(n, turn, turn) < FAR * product_dot(n, phi, phi)))
            continue;
        any = 1;
        for (int i = 0; i < n; i++)
            phi[i] += turn[i];
    }
    if (any)
        eigen_full_begin(&p->full, p->phi);
}

int prediction_matrices(struct prediction *p, const double *x)
{
    return evaluate(p, x, &p->k, &p->m);
}

int prediction_compute(struct prediction *p, const double *x)
{
    int status = prediction_matrices(p, x);
    if (status)
        return status;
    if (p->reduction == ROTID_REDUCTION_NONE) {
        extrapolate(p, x);
        status = eigen_full_solve(&p->full, &p->k, &p->m, p->lambda, p->phi);
        if (p->model->nparam)
            memcpy(p->here, x, (size_t)p->model->nparam * sizeof *x);
        return status;
    }
    return condensed_compute(p, x);
}

/* dK and dM by differences of fourth order over steps of h, for a host that gives none: of A(x + h) - A(x), K and M at x being
 * the last that were computed, so that entries that x_q leaves alone come out as zeros. The wide step is for parameters that
 * change little of a stiff entry: its rounding is divided by the step. Where the host has no model on one side of x, those of the
 * other side, whose error is six times as large. */
static int difference(struct prediction *p, const double *x, int q)
{
    static const struct {
        int at[4];
        double weight[4];
    } side[] = {{{-2, -1, 1, 2}, {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12}},
                {{1, 2, 3, 4}, {4, -3, 4.0 / 3, -1.0 / 4}},
                {{-1, -2, -3, -4}, {-4, 3, -4.0 / 3, 1.0 / 4}}};
    double h = 2e-3 * (x[q] != 0 ? fabs(x[q]) : 1);
    int status = ROTID_OK;
    p->dk_is_zero = p->dm_is_zero = 0;
    memcpy(p->x, x, (size_t)p->model->nparam * sizeof *x);
    for (size_t s = 0; s < sizeof side / sizeof *side && (!s || status); s++) {
        matrix_zero(&p->dk);
        matrix_zero(&p->dm);
        status = ROTID_OK;
        for (int i = 0; i < 4 && !status; i++) {
            p->x[q] = x[q] + side[s].at[i] * h;
            status = evaluate(p, p->x, &p->other_k, &p->other_m);
            matrix_combine(1, &p->other_k, -1, &p->k, &p->other_k);
            matrix_combine(1, &p->other_m, -1, &p->m, &p->other_m);
            matrix_combine(1, &p->dk, side[s].weight[i] / h, &p->other_k, &p->dk);
            matrix_combine(1, &p->dm, side[s].weight[i] / h, &p->other_m, &p->dm);
        }
    }
    return status;
}

/* A matrix of a wide band takes longer to look at than its products with a few vectors take: one that nothing was written to need
 * be neither cleared again nor multiplied. */
static void clear(rotid_matrix *a, int *is_zero)
{
    if (!*is_zero)
        matrix_zero(a);
    *is_zero = 0;
}

static int check_derivative(const char *name, const rotid_matrix *a, char *failure, int *is_zero)
{
    *is_zero = matrix_is_zero(a);
    return *is_zero ? ROTID_OK : matrix_check_entries(name, a, failure);
}

int prediction_matrix_derivatives(struct prediction *p, const double *x, int q)
{
    if (!p->model->derivatives)
        return difference(p, x, q);
    clear(&p->dk, &p->dk_is_zero);
    clear(&p->dm, &p->dm_is_zero);
    int failed = p->model->derivatives(p->model->user, x, q, &p->dk, &p->dm);
    if (failed)
        return failure_say(p->failure, ROTID_ERROR_CALLBACK, "model->derivatives returned %d for p = %d", failed, q);
    int status = check_derivative("the stiffness of model->derivatives", &p->dk, p->failure, &p->dk_is_zero);
    return status ? status : check_derivative("the mass of model->derivatives", &p->dm, p->failure, &p->dm_is_zero);
}

/* dK phi and dM phi of the wanted pairs, and those between, from the model itself; *given: whether it has such a way. */
static int ask_products(struct prediction *p, const double *x, int q, const int *wanted, int *given)
{
    const rotid_model *model = p->model;
    int end, first = range_of(p->count, wanted, &end), n = p->size;
    ptrdiff_t length = (ptrdiff_t)(end - first) * n;
    double *image[] = {p->image + (ptrdiff_t)first * n, p->image + ((ptrdiff_t)first + p->count) * n};
    *given = model->derivative_products && p->reduction == ROTID_REDUCTION_NONE;
    *given =
        *given && !model->derivative_products(model->user, x, q, end - first, p->phi + (ptrdiff_t)first * n, image[0], image[1]);
    for (ptrdiff_t i = 0; i < 2 * length && *given; i++)
        if (!isfinite(image[i / length][i % length]))
            return failure_say(p->failure, ROTID_ERROR_FINITE,
                               "model->derivative_products for p = %d: row %d is %g, expected a number", q, (int)(i % n),
                               image[i / length][i % length]);
    return ROTID_OK;
}

/* image [size * count] := A phi of the wanted pairs, neighbours together */
static void multiply_wanted(const struct prediction *p, const rotid_matrix *a, int is_zero, const int *wanted, double *image)
{
    for (int k = 0, end; k < p->count; k = end + 1) {
        ptrdiff_t at = (ptrdiff_t)k * p->size;
        for (end = k; end < p->count && wanted[end];)
            end++;
        if (is_zero)
            memset(image + at, 0, (size_t)(end - k) * (size_t)p->size * sizeof *image);
        else
            matrix_multiply(a, end - k, p->phi + at, image + at);
    }
}

/* dK phi and dM phi of the full matrices; condensed dK and dM alone */
static int form_images(struct prediction *p, const double *x, int q, const int *wanted)
{
    double *dm_phi = p->image + (ptrdiff_t)p->count * p->size;
    int given, status = ask_products(p, x, q, wanted, &given);
    if (status || given)
        return status;
    status = prediction_matrix_derivatives(p, x, q);
    if (status || p->reduction != ROTID_REDUCTION_NONE)
        return status;
    multiply_wanted(p, &p->dk, p->dk_is_zero, wanted, p->image);
    multiply_wanted(p, &p->dm, p->dm_is_zero, wanted, dm_phi);
    return ROTID_OK;
}

int prediction_images(struct prediction *p, const double *x, int q, const int *wanted, const double **dk_phi,
                      const double **dm_phi)
{
    *dk_phi = p->image;
    *dm_phi = p->image + (ptrdiff_t)p->count * p->size;
    return form_images(p, x, q, wanted);
}

/* (36) with the derivatives of the matrices in place */
static double eigenvalue_derivative(struct prediction *p, int k)
{
    int n = p->size;
    const double *phi = p->phi + (ptrdiff_t)k * n;
    if (p->reduction != ROTID_REDUCTION_NONE)
        return reduction_eigenvalue_derivative(&p->condensed, &p->dk, &p->dm, p->lambda[k], phi, &p->mode[k]);
    const double *dk_phi = p->image + (ptrdiff_t)k * n, *dm_phi = dk_phi + (ptrdiff_t)p->count * n;
    return product_dot(n, phi, dk_phi) - p->lambda[k] * product_dot(n, phi, dm_phi);
}

static void multiply_dense(int n, const double *a, const double *x, double *y)
{
    memset(y, 0, (size_t)n * sizeof *y);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            y[i] += a[i + (ptrdiff_t)j * n] * x[j];
}

ptrdiff_t prediction_place(const struct prediction *p, int k, int q)
{
    return ((ptrdiff_t)k * p->model->nparam + q) * p->size;
}

/* [members * nparam] of mode k */
static double *constants_of(const struct prediction *p, int k)
{
    return p->constant + (ptrdiff_t)k * p->model->nparam * CLUSTER_MOST;
}

/* P, Q and dlambda of mode k, with dK and dM of parameter q in place */
static void form_right_side(struct prediction *p, int k, int q)
{
    int n = p->size;
    ptrdiff_t place = prediction_place(p, k, q);
    const double *phi = p->phi + (ptrdiff_t)k * n, *m_phi = p->m_phi + (ptrdiff_t)k * n, *dk_phi, *dm_phi;
    if (p->reduction == ROTID_REDUCTION_NONE) {
        dk_phi = p->image + (ptrdiff_t)k * n;
        dm_phi = dk_phi + (ptrdiff_t)p->count * n;
    } else {
        reduction_derivative_multiply(&p->condensed, &p->dk, &p->dm, phi, p->kx + place, p->mx + place, p->work);
        dk_phi = p->kx + place;
        dm_phi = p->mx + place;
    }
    int first, members = eigenvalue_cluster(p->count, p->lambda, k, &first);
    double *constant = constants_of(p, k) + (ptrdiff_t)q * members;
    for (int j = 0; j < members; j++)
        constant[j] = -0.5 * product_dot(n, p->phi + (ptrdiff_t)(first + j) * n, dm_phi);
    p->dlambda[k + (ptrdiff_t)q * p->count] =
        nelson_right_side(n, p->lambda[k], phi, m_phi, dk_phi, dm_phi, p->right + place, &constant[k - first]);
}

/* Has the cluster of mode k more members than those? */
static int cluster_goes_on(struct prediction *p, int k, int first, int members)
{
    int end = first + members;
    double reach = CLOSE_EIGENVALUES * fabs(p->lambda[k]), above = p->lambda[end - 1] + reach;
    /* a vector alone has its neighbours on both sides among the known */
    if (first > 0 && p->lambda[first] - p->lambda[first - 1] < reach)
        return 1;
    if (end < p->count)
        return p->lambda[end] < above;
    if (members == 1 || p->count == p->size)
        return 0;
    return (p->reduction == ROTID_REDUCTION_NONE
                ? nelson_band_below(&p->nelson_band, above)
                : nelson_dense_below(&p->nelson_dense, p->condensed.kc, p->condensed.mc, above)) > p->count;
}

/* dphi [n * nparam] of mode k for every parameter, with `lambda` as its eigenvalue */
static int solve_at(struct prediction *p, int k, int first, int members, double lambda, double *dphi)
{
    int n = p->size, left_out = lambda == p->lambda[k] ? members : 0, nparam = p->model->nparam, status = ROTID_OK;
    ptrdiff_t place = prediction_place(p, k, 0);
    const double *phi = p->phi + (ptrdiff_t)first * n, *m_phi = p->m_phi + (ptrdiff_t)first * n, *right = p->right + place,
                 *constant = constants_of(p, k);
    if (p->reduction == ROTID_REDUCTION_NONE) {
        status = nelson_band_prepare(&p->nelson_band, lambda, left_out, phi);
        if (!status)
            nelson_band_solve(&p->nelson_band, nparam, members, phi, m_phi, right, constant, dphi);
        return status;
    }
    if (p->derivative == ROTID_NELSON)
        status = nelson_dense_prepare(&p->nelson_dense, p->condensed.kc, p->condensed.mc, lambda, left_out, phi);
    for (int q = 0; q < nparam && !status; q++, right += n, dphi += n, constant += members)
        if (p->derivative == ROTID_MODAL)
            modal_superposition(n, p->lambda, p->phi, k, first, members, m_phi, right, constant, dphi);
        else
            nelson_dense_solve(&p->nelson_dense, members, phi, m_phi, right, constant, dphi);
    return status;
}

static int solve_vectors(struct prediction *p, int k)
{
    int first, members = eigenvalue_cluster(p->count, p->lambda, k, &first);
    ptrdiff_t length = (ptrdiff_t)p->size * p->model->nparam;
    double *dphi = p->dphi + prediction_place(p, k, 0), lambda = p->lambda[k];
    if (p->derivative == ROTID_MODAL || !cluster_goes_on(p, k, first, members))
        return solve_at(p, k, first, members, lambda, dphi);
    int status = solve_at(p, k, first, members, lambda * (1 - BESIDE), p->below);
    if (!status)
        status = solve_at(p, k, first, members, lambda * (1 + BESIDE), dphi);
    for (ptrdiff_t i = 0; i < length && !status; i++)
        dphi[i] = (dphi[i] + p->below[i]) / 2;
    return status;
}

/* dK and dM belong to a parameter and the factors to a mode: all right-hand sides first, so that each is formed once. */
static int differentiate_vectors(struct prediction *p, const double *x, const int *wanted)
{
    int n = p->size, full = p->reduction == ROTID_REDUCTION_NONE, status = ROTID_OK;
    if (full) {
        nelson_band_begin(&p->nelson_band, &p->k, &p->m);
        nelson_band_multiply_mass(&p->nelson_band, p->count, p->phi, p->m_phi);
    }
    for (int k = 0; k < p->count && !full; k++) {
        int first, members = wanted[k] ? eigenvalue_cluster(p->count, p->lambda, k, &first) : 0;
        for (int j = 0; j < members; j++) {
            ptrdiff_t at = (ptrdiff_t)(first + j) * n;
            multiply_dense(n, p->condensed.mc, p->phi + at, p->m_phi + at);
        }
    }
    for (int q = 0; q < p->model->nparam && !status; q++) {
        status = form_images(p, x, q, wanted);
        for (int k = 0; k < p->count && !status; k++)
            if (wanted[k])
                form_right_side(p, k, q);
    }
    for (int k = 0; k < p->count && !status; k++)
        if (wanted[k]) {
            status = solve_vectors(p, k);
            p->turned[k] = full && !status;
        }
    return status;
}

int prediction_differentiate(struct prediction *p, const double *x, const int *wanted, int with_vectors)
{
    int status = ROTID_OK;
    if (with_vectors)
        return differentiate_vectors(p, x, wanted);
    if (p->by_bands)
        return condensed_differentiate(p, x, wanted);
    for (int k = 0; k < p->count && p->reduction != ROTID_REDUCTION_NONE; k++)
        if (wanted[k])
            reduction_mode_prepare(&p->condensed, p->lambda[k], p->phi + (ptrdiff_t)k * p->size, &p->mode[k]);
    for (int q = 0; q < p->model->nparam && !status; q++) {
        status = form_images(p, x, q, wanted);
        for (int k = 0; k < p->count && !status; k++)
            if (wanted[k])
                p->dlambda[k + (ptrdiff_t)q * p->count] = eigenvalue_derivative(p, k);
    }
    return status;
}

double prediction_hz(const struct prediction *p, int k)
{
    return p->lambda[k] > 0 ? sqrt(p->lambda[k]) / TWO_PI : 0;
}

/* Component at sensor s of a vector as long as one of the prediction */
static double at_sensor(const struct prediction *p, const double *u, int s)
{
    const rotid_model *model = p->model;
    if (model->sensor)
        return product_dot(model->n, u, model->sensor + (ptrdiff_t)s * model->n);
    return u[p->reduction == ROTID_REDUCTION_NONE ? model->master[s] : s];
}

double prediction_at_sensor(const struct prediction *p, int k, int s)
{
    return at_sensor(p, p->phi + (ptrdiff_t)k * p->size, s);
}

double prediction_derivative_at_sensor(const struct prediction *p, int k, int q, int s)
{
    return at_sensor(p, p->dphi + prediction_place(p, k, q), s);
}
