#include "modal/modal.h"

#define ENOUGH     1e-9 /* relative change of V by a step of refinement whose square is below rounding */
#define MOST_STEPS 6    /* of refinement with the factor of a wide band, which has not pivoted */

static int neighbours(int count, const double *lambda, int k, int most, int *first)
{
    double reach = CLOSE_EIGENVALUES * fabs(lambda[k]);
    int low = k, high = k;
    while (low > 0 && lambda[low] - lambda[low - 1] < reach && high - low + 1 < most)
        low--;
    while (high + 1 < count && lambda[high + 1] - lambda[high] < reach && high - low + 1 < most)
        high++;
    *first = low;
    return high - low + 1;
}

int eigenvalue_cluster(int count, const double *lambda, int k, int *first)
{
    return neighbours(count, lambda, k, CLUSTER_MOST, first);
}

double nelson_right_side(int n, double lambda, const double *phi, const double *m_phi, const double *dk_phi, const double *dm_phi,
                         double *p, double *q)
{
    double dlambda = product_dot(n, phi, dk_phi) - lambda * product_dot(n, phi, dm_phi);
    for (int i = 0; i < n; i++)
        p[i] = -(dk_phi[i] - dlambda * m_phi[i] - lambda * dm_phi[i]);
    *q = -0.5 * product_dot(n, phi, dm_phi);
    return dlambda;
}

static int rows_new(struct pool *pool, int n, struct nelson_rows *rows)
{
    rows->kept = POOL_ARRAY(pool, int, n);
    rows->pivot = POOL_ARRAY(pool, double, (size_t)n *CLUSTER_MOST);
    return rows->kept && rows->pivot ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Leaves out the rows where an elimination of the vectors with complete pivoting has its pivots: those of one vector at its
 * largest component, and no combination of several is zero in all of them. */
static void choose_rows(int n, int members, const double *phi, struct nelson_rows *rows)
{
    double *w = rows->pivot;
    rows->count = members;
    int done[CLUSTER_MOST] = {0};
    memcpy(w, phi, (size_t)n * (size_t)members * sizeof *w);
    for (int step = 0; step < members; step++) {
        int row = 0, column = -1;
        for (int c = 0; c < members; c++)
            for (int i = 0; i < n && !done[c]; i++)
                if (column < 0 || fabs(w[i + (ptrdiff_t)c * n]) > fabs(w[row + (ptrdiff_t)column * n])) {
                    row = i;
                    column = c;
                }
        const double *of = w + (ptrdiff_t)column * n;
        done[column] = 1;
        for (int c = 0; c < members; c++) {
            double *other = w + (ptrdiff_t)c * n, part = done[c] ? 0 : other[row] / of[row];
            for (int i = 0; i < n && part != 0; i++)
                other[i] -= part * of[i];
            if (!done[c])
                other[row] = 0;
        }
        int at = step;
        for (; at > 0 && rows->left_out[at - 1] > row; at--)
            rows->left_out[at] = rows->left_out[at - 1];
        rows->left_out[at] = row;
    }
    for (int i = 0, left = 0, kept = 0; i < n; i++)
        if (left < members && rows->left_out[left] == i)
            left++;
        else
            rows->kept[kept++] = i;
}

/* x [n - count] -> [n] in place, zero in the rows that are left out */
static void spread(const struct nelson_rows *rows, int n, double *x)
{
    for (int i = n - rows->count - 1; i >= 0; i--)
        x[rows->kept[i]] = x[i];
    for (int j = 0; j < rows->count; j++)
        x[rows->left_out[j]] = 0;
}

static void gather(const struct nelson_rows *rows, int n, const double *x, double *shorter)
{
    for (int i = 0; i < n - rows->count; i++)
        shorter[i] = x[rows->kept[i]];
}

/* x := x - sum over the members of b_j (a_j' x - q_j); q NULL: zero */
static void set_components(int n, int members, const double *a, const double *b, const double *q, double *x)
{
    for (int j = 0; j < members; j++) {
        double c = q ? q[j] : 0;
        c -= product_dot(n, a + (ptrdiff_t)j * n, x);
        for (int i = 0; i < n; i++)
            x[i] += c * b[i + (ptrdiff_t)j * n];
    }
}

int nelson_dense_new(struct pool *pool, int n, struct nelson_dense *d)
{
    *d = (struct nelson_dense){.n = n};
    int status = rows_new(pool, n, &d->rows);
    return status ? status : symmetric_new(pool, n, &d->factor);
}

static int factor_dense(struct nelson_dense *d, const double *k, const double *m, double lambda)
{
    int n = d->n, size = n - d->rows.count;
    const int *kept = d->rows.kept;
    double *target = d->factor.a;
    for (int j = 0; j < size; j++)
        for (int i = 0; i < size; i++) {
            ptrdiff_t at = kept[i] + (ptrdiff_t)kept[j] * n;
            *target++ = k[at] - lambda * m[at];
        }
    return symmetric_factor(&d->factor, size);
}

int nelson_dense_prepare(struct nelson_dense *d, const double *k, const double *m, double lambda, int members, const double *phi)
{
    choose_rows(d->n, members, phi, &d->rows);
    if (!factor_dense(d, k, m, lambda) || !factor_dense(d, k, m, lambda * (1 + CLOSE_EIGENVALUES)))
        return ROTID_OK;
    return ROTID_ERROR_CLOSE;
}

int nelson_dense_below(struct nelson_dense *d, const double *k, const double *m, double lambda)
{
    for (ptrdiff_t i = 0; i < (ptrdiff_t)d->n * d->n; i++)
        d->factor.a[i] = k[i] - lambda * m[i];
    (void)symmetric_factor(&d->factor, d->n);
    return symmetric_negative(&d->factor, d->n);
}

void nelson_dense_solve(struct nelson_dense *d, int members, const double *phi, const double *m_phi, const double *p,
                        const double *q, double *dphi)
{
    int n = d->n;
    memcpy(dphi, p, (size_t)n * sizeof *p);
    set_components(n, members, phi, m_phi, NULL, dphi);
    gather(&d->rows, n, dphi, dphi);
    symmetric_solve(&d->factor, n - d->rows.count, dphi);
    spread(&d->rows, n, dphi);
    set_components(n, members, m_phi, phi, q, dphi);
}

void modal_superposition(int n, const double *lambda, const double *phi, int k, int first, int members, const double *m_phi,
                         const double *p, const double *q, double *dphi)
{
    int low, near = neighbours(n, lambda, k, n, &low); /* members beyond CLUSTER_MOST do not turn either */
    memset(dphi, 0, (size_t)n * sizeof *dphi);
    for (int j = 0; j < n; j++) {
        if (j >= low && j < low + near)
            continue;
        const double *other = phi + (ptrdiff_t)j * n;
        double c = 0;
        for (int i = 0; i < n; i++)
            c += other[i] * p[i];
        c /= lambda[j] - lambda[k];
        for (int i = 0; i < n; i++)
            dphi[i] += c * other[i];
    }
    set_components(n, members, m_phi, phi + (ptrdiff_t)first * n, q, dphi);
}

int nelson_band_new(struct pool *pool, const rotid_matrix *structure, int most, struct nelson_band *b)
{
    int n = structure->n;
    size_t columns = (size_t)n * (size_t)most;
    *b = (struct nelson_band){.n = n};
    b->residual = POOL_ARRAY(pool, double, columns);
    b->shorter = POOL_ARRAY(pool, double, columns);
    int status = b->residual && b->shorter ? rows_new(pool, n, &b->rows) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    b->all = POOL_ARRAY(pool, int, n);
    if (!b->all)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        b->all[i] = b->rows.kept[i] = i;
    status = factor_new(pool, FACTOR_LU, structure, n, b->rows.kept, &b->factor);
    if (status)
        return status;
    if (factor_is_wide(structure))
        return pencil_new(pool, structure, &b->pencil);
    status = matrix_like(pool, structure, &b->shifted);
    return status ? status : factor_new(pool, FACTOR_CHOLESKY, structure, n, b->all, &b->inertia);
}

void nelson_band_begin(struct nelson_band *b, const rotid_matrix *k, const rotid_matrix *m)
{
    b->k = k;
    b->m = m;
    if (b->factor.is_wide)
        (void)pencil_take(&b->pencil, k, m);
}

void nelson_band_multiply_mass(struct nelson_band *b, int columns, const double *x, double *y)
{
    if (b->factor.is_wide)
        pencil_multiply_mass(&b->pencil, columns, x, y);
    else
        matrix_multiply(b->m, columns, x, y);
}

int nelson_band_below(struct nelson_band *b, double lambda)
{
    if (b->factor.is_wide) {
        factor_keep(&b->factor, b->k, b->n, b->all);
        return factor_negative_count_pencil(&b->factor, &b->pencil, lambda);
    }
    matrix_combine(1, b->k, -lambda, b->m, &b->shifted);
    return factor_negative_count(&b->inertia, &b->shifted);
}

static int factor_band(struct nelson_band *b, double lambda)
{
    b->lambda = lambda;
    if (b->factor.is_wide)
        return factor_compute_pencil(&b->factor, &b->pencil, lambda);
    matrix_combine(1, b->k, -lambda, b->m, &b->shifted);
    return factor_compute(&b->factor, &b->shifted);
}

int nelson_band_prepare(struct nelson_band *b, double lambda, int members, const double *phi)
{
    choose_rows(b->n, members, phi, &b->rows);
    factor_keep(&b->factor, b->k, b->n - members, b->rows.kept);
    if (!factor_band(b, lambda) || !factor_band(b, lambda * (1 + CLOSE_EIGENVALUES)))
        return ROTID_OK;
    return ROTID_ERROR_CLOSE;
}

/* x [n * columns] := A^-1 x without the rows and columns left out, zero there */
static void solve_columns(struct nelson_band *b, int columns, double *x)
{
    int n = b->n, size = n - b->rows.count;
    for (int c = 0; c < columns; c++)
        gather(&b->rows, n, x + (ptrdiff_t)c * n, b->shorter + (ptrdiff_t)c * size);
    factor_solve(&b->factor, columns, b->shorter);
    for (int c = 0; c < columns; c++) {
        memcpy(x + (ptrdiff_t)c * n, b->shorter + (ptrdiff_t)c * size, (size_t)size * sizeof *x);
        spread(&b->rows, n, x + (ptrdiff_t)c * n);
    }
}

static double largest(ptrdiff_t count, const double *x)
{
    double most = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* y := (K - lambda M) x */
static void multiply_shifted(struct nelson_band *b, int columns, const double *x, double *y)
{
    if (!b->factor.is_wide) {
        matrix_multiply(&b->shifted, columns, x, y);
        return;
    }
    pencil_multiply_stiffness(&b->pencil, columns, x, y);
    pencil_multiply_mass(&b->pencil, columns, x, b->shorter);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)b->n * columns; i++)
        y[i] -= b->lambda * b->shorter[i];
}

/* dphi holds V of A V = P for `columns` right-hand sides; one step of refinement. Returns how much it changed V, the worst of the
 * columns. */
static double refine(struct nelson_band *b, int columns, int members, const double *phi, const double *m_phi, const double *p,
                     double *dphi)
{
    int n = b->n;
    double worst = 0;
    multiply_shifted(b, columns, dphi, b->residual);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)n * columns; i++)
        b->residual[i] = p[i] - b->residual[i];
    for (int c = 0; c < columns; c++)
        set_components(n, members, phi, m_phi, NULL, b->residual + (ptrdiff_t)c * n);
    solve_columns(b, columns, b->residual);
    for (int c = 0; c < columns; c++) {
        double *x = dphi + (ptrdiff_t)c * n, *change = b->residual + (ptrdiff_t)c * n, size = largest(n, x);
        for (int i = 0; i < n; i++)
            x[i] += change[i];
        worst = fmax(worst, size > 0 ? largest(n, change) / size : 0);
    }
    return worst;
}

void nelson_band_solve(struct nelson_band *b, int columns, int members, const double *phi, const double *m_phi, const double *p,
                       const double *q, double *dphi)
{
    int n = b->n;
    memcpy(dphi, p, (size_t)n * (size_t)columns * sizeof *p);
    for (int c = 0; c < columns; c++)
        set_components(n, members, phi, m_phi, NULL, dphi + (ptrdiff_t)c * n);
    solve_columns(b, columns, dphi);
    /* the bordered factors may lose digits where a clamped mode lies near, and a cluster counts as one eigenvalue in them; a
     * second step would change V by the square of the first. Where a step gains nothing, what is left is rounding of P
     */
    double change = INFINITY, before;
    for (int most = b->factor.is_wide ? MOST_STEPS : 2; most > 0; most--) {
        before = change;
        change = refine(b, columns, members, phi, m_phi, p, dphi);
        if (!(change > ENOUGH && change < before / 2))
            break;
    }
    for (int c = 0; c < columns; c++)
        set_components(n, members, m_phi, phi, q + (ptrdiff_t)c * members, dphi + (ptrdiff_t)c * n);
}
