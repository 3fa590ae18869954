#include "linalg/linalg.h"

#include <float.h>

#define KD         3     /* of a chain of elements with two degrees of freedom a node */
#define ENDS       4     /* degrees of freedom at both ends of a piece */
#define ROUNDS     6     /* the error is cubed in each */
#define TOLERANCE  1e-11 /* of what is expected to be left of a vector */
#define LOW        0.01  /* of the first eigenvalue that is wanted: the shift, below zero, of those that are not */
#define COUNTED    1e-6  /* above the last eigenvalue, of it: where those below are counted */
#define ATTEMPTS   2
#define BESIDE     1e-5 /* of a shift that loses a pivot: another that costs little of the convergence */
#define INDEFINITE 1e-6 /* of the first eigenvalue that is wanted: what is farther below zero is judged by the full solution */

/* kept, and their rows: those of far ones last. Returns how many rows there are before these. */
static int number_rows(const rotid_matrix *structure, int nc, const int *master, struct eigen_guyan *e)
{
    enum { BETWEEN, KEPT, FAR };
    int *mark = e->mark, rows = 0, inner = 0;
    for (int c = 0; c < nc; c++)
        mark[master[c]] = mark[master[c] ^ 1] = KEPT;
    for (int f = 0; f < structure->nfar; f++)
        if (!mark[structure->far[f] ^ 1])
            mark[structure->far[f] ^ 1] = KEPT;
    for (int f = 0; f < structure->nfar; f++)
        mark[structure->far[f]] = FAR;
    for (int i = 0, c = 0; i < structure->n; i++) {
        if (!mark[i])
            continue;
        int k = e->nkept++, is_master = c < nc && master[c] == i;
        e->kept[k] = i;
        e->force[k] = is_master ? -1 : 0;
        if (is_master)
            e->master[c++] = k;
    }
    for (int pass = KEPT; pass <= FAR; pass++) {
        for (int k = 0; k < e->nkept; k++) {
            if (mark[e->kept[k]] != pass)
                continue;
            e->row[k] = rows++;
            if (e->force[k] >= 0)
                e->force[k] = rows++;
        }
        inner = pass == KEPT ? rows : inner;
    }
    e->rows = rows;
    return inner;
}

static int new_pieces(struct pool *pool, struct eigen_guyan *e)
{
    int longest = 0;
    e->npiece = 0;
    for (int k = 0; k <= e->nkept; k++) {
        int from = k ? e->kept[k - 1] + 1 : 0, length = (k < e->nkept ? e->kept[k] : e->n) - from;
        if (!length)
            continue;
        int first = k > 2 ? k - 2 : 0, end = k + 2 < e->nkept ? k + 2 : e->nkept;
        size_t size = (size_t)length * (size_t)(end - first);
        struct guyan_piece *piece = &e->piece[e->npiece++];
        *piece = (struct guyan_piece){.from = from, .length = length, .first = first, .nend = end - first};
        piece->k_end = POOL_ARRAY(pool, double, size);
        piece->m_end = POOL_ARRAY(pool, double, size);
        piece->x = POOL_ARRAY(pool, double, size);
        if (!piece->k_end || !piece->m_end || !piece->x)
            return ROTID_ERROR_MEMORY;
        longest = length > longest ? length : longest;
    }
    e->cholesky = POOL_ARRAY(pool, double, (KD + 1) * (size_t)longest);
    e->image = POOL_ARRAY(pool, double, ENDS *(size_t)longest);
    return e->cholesky && e->image ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Far degrees of freedom in K2 */
static int *new_far(struct pool *pool, const rotid_matrix *structure, const struct eigen_guyan *e)
{
    int *far = POOL_ARRAY(pool, int, structure->nfar);
    for (int f = 0, k = 0; far && f < structure->nfar; f++) {
        while (e->kept[k] != structure->far[f])
            k++;
        far[f] = k;
    }
    return far;
}

/* Largest distance of two rows before `inner` that meet in the bordered matrix */
static int bordered_band(const struct eigen_guyan *e, int inner)
{
    int widest = 0;
    for (int k = 0; k < e->nkept; k++)
        for (int b = k; b >= 0 && k - b <= KD; b--) {
            int last = e->force[k] >= 0 ? e->force[k] : e->row[k], first = e->row[b];
            if (last < inner && first < inner)
                widest = last - first > widest ? last - first : widest;
        }
    return widest;
}

int eigen_guyan_new(struct pool *pool, const rotid_matrix *structure, int nc, const int *master, int count, int from,
                    struct eigen_guyan *e)
{
    int n = structure->n, status;
    size_t most = (size_t)n;
    *e = (struct eigen_guyan){.n = n, .nc = nc, .count = count, .from = from};
    if (structure->kd != KD || n % 2 || from >= count)
        return ROTID_OK;
    e->kept = POOL_ARRAY(pool, int, most);
    e->row = POOL_ARRAY(pool, int, most);
    e->force = POOL_ARRAY(pool, int, most);
    e->mark = POOL_ARRAY(pool, int, most);
    e->master = POOL_ARRAY(pool, int, nc);
    e->piece = POOL_ARRAY(pool, struct guyan_piece, most / 2 + 1);
    if (!e->kept || !e->row || !e->force || !e->mark || !e->master || !e->piece)
        return ROTID_ERROR_MEMORY;
    int inner = number_rows(structure, nc, master, e);
    if (count > nc / 2 || 4 * count > e->nkept) /* so many of them are had for less in full */
        return ROTID_OK;
    int *far = new_far(pool, structure, e);
    size_t kept = (size_t)e->nkept, columns = (size_t)count;
    status = far ? new_pieces(pool, e) : ROTID_ERROR_MEMORY;
    if (!status)
        status = matrix_new(pool, e->nkept, KD, structure->nfar, far, &e->k);
    if (!status)
        status = matrix_new(pool, e->nkept, KD, structure->nfar, far, &e->m);
    if (!status)
        status = arrow_new(pool, inner, bordered_band(e, inner), e->rows - inner, &e->bordered);
    e->u = POOL_ARRAY(pool, double, kept *columns);
    e->value = POOL_ARRAY(pool, double, columns);
    e->next = POOL_ARRAY(pool, double, columns);
    e->expected = POOL_ARRAY(pool, double, columns);
    size_t most_rows = columns > ARROW_SHIFTS ? columns : ARROW_SHIFTS;
    e->right = POOL_ARRAY(pool, double, (size_t)e->rows *most_rows);
    e->y = POOL_ARRAY(pool, double, kept *columns);
    e->product = POOL_ARRAY(pool, double, kept *columns);
    e->squares = POOL_ARRAY(pool, double, 2 * columns * columns);
    e->work = POOL_ARRAY(pool, double, RITZ_WORK *columns);
    if (!e->u || !e->value || !e->next || !e->expected || !e->right || !e->y || !e->product || !e->squares || !e->work)
        return ROTID_ERROR_MEMORY;
    e->applies = !status;
    return status;
}

void eigen_guyan_begin(struct eigen_guyan *e, const double *phi)
{
    for (int j = 0; j < e->count; j++)
        for (int k = 0; k < e->nkept; k++)
            e->u[k + (ptrdiff_t)j * e->nkept] = phi[e->kept[k] + (ptrdiff_t)j * e->n];
    e->near = 1;
}

/* A(i, j) of the band */
static inline double entry(const rotid_matrix *a, int i, int j)
{
    int low = i < j ? i : j, distance = i < j ? j - i : i - j;
    return distance <= KD ? a->band[distance + low * (KD + 1)] : 0;
}

/* Does a pair that is kept part what is left of it from what is right? */
static int parts(const struct eigen_guyan *e, const rotid_matrix *k, const rotid_matrix *m)
{
    for (int c = 0; c < e->nkept; c += 2) {
        int i = e->kept[c];
        if (i > 0 && i + 2 < e->n && (entry(k, i - 1, i + 2) != 0 || entry(m, i - 1, i + 2) != 0))
            return 0;
    }
    return 1;
}

/* The matrix between those that are kept, as it is */
static void take_kept(const struct eigen_guyan *e, const rotid_matrix *a, rotid_matrix *kept)
{
    for (int c = 0; c < e->nkept; c++)
        for (int d = 0; d <= KD; d++)
            kept->band[d + c * (KD + 1)] = c + d < e->nkept ? entry(a, e->kept[c + d], e->kept[c]) : 0;
    if (a->nfar)
        memcpy(kept->block, a->block, (size_t)a->nfar * (size_t)a->nfar * sizeof *a->block);
}

/* ends [length * nend] := coupling of the rows of a piece to its ends */
static void take_ends(const struct eigen_guyan *e, const struct guyan_piece *p, const rotid_matrix *a, double *ends)
{
    memset(ends, 0, (size_t)p->length * (size_t)p->nend * sizeof *ends);
    for (int q = 0; q < p->nend; q++) {
        int column = e->kept[p->first + q], begin = column - KD - p->from, end = column + KD + 1 - p->from;
        for (int i = begin > 0 ? begin : 0; i < end && i < p->length; i++)
            ends[i + q * p->length] = entry(a, p->from + i, column);
    }
}

/* y [length] := A x of the rows of a piece */
static void multiply_piece(const struct guyan_piece *p, const rotid_matrix *a, const double *x, double *y)
{
    const double *band = a->band + (ptrdiff_t)p->from * (KD + 1);
    memset(y, 0, (size_t)p->length * sizeof *y);
    for (int j = 0; j < p->length; j++, band += KD + 1) {
        y[j] += band[0] * x[j];
        for (int d = 1; d <= KD && j + d < p->length; d++) {
            y[j + d] += band[d] * x[j];
            y[j] += band[d] * x[j + d];
        }
    }
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Adds K_ei X to K2, and X' (M_ie + M_ii X) + M_ei X to M2, with X = -K_ii^-1 K_ie. Returns 0, or 1 where K_ii is singular. */
static int condense_piece(struct eigen_guyan *e, struct guyan_piece *p, const rotid_matrix *k, const rotid_matrix *m)
{
    int length = p->length, nend = p->nend;
    memcpy(e->cholesky, k->band + (ptrdiff_t)p->from * (KD + 1), (size_t)length * (KD + 1) * sizeof(double));
    if (band_cholesky(length, KD, e->cholesky))
        return 1;
    take_ends(e, p, k, p->k_end);
    take_ends(e, p, m, p->m_end);
    for (int i = 0; i < length; i++)
        for (int q = 0; q < ENDS; q++)
            e->image[i * ENDS + q] = q < nend ? -p->k_end[i + q * length] : 0;
    band_cholesky_solve(length, KD, e->cholesky, ENDS, e->image);
    for (int i = 0; i < length; i++)
        for (int q = 0; q < nend; q++)
            p->x[i + q * length] = e->image[i * ENDS + q];
    for (int q = 0; q < nend; q++) {
        const double *x = p->x + (ptrdiff_t)q * length, *m_end = p->m_end + (ptrdiff_t)q * length;
        double *y = e->image;
        multiply_piece(p, m, x, y);
        for (int i = 0; i < length; i++)
            y[i] += m_end[i];
        for (int b = 0; b < nend; b++) {
            ptrdiff_t at = (b - q) + (ptrdiff_t)(p->first + q) * (KD + 1), of = (ptrdiff_t)b * length;
            if (b < q)
                continue;
            e->k.band[at] += dot(length, p->k_end + of, x);
            e->m.band[at] += dot(length, p->x + of, y) + dot(length, p->m_end + of, x);
        }
    }
    return 0;
}

/* Between rows of two kept degrees of freedom: K and the constraints; M */
static void put(struct eigen_guyan *e, int i, int j, double k, double m)
{
    struct arrow *a = &e->bordered;
    arrow_add(a, &a->k, e->row[i], e->row[j], k);
    arrow_add(a, &a->m, e->row[i], e->row[j], m);
    if (e->force[i] >= 0)
        arrow_add(a, &a->k, e->force[i], e->row[j], k);
    if (e->force[j] >= 0 && i != j)
        arrow_add(a, &a->k, e->force[j], e->row[i], k);
}

static void form_bordered(struct eigen_guyan *e)
{
    const rotid_matrix *k = &e->k, *m = &e->m;
    arrow_zero(&e->bordered, &e->bordered.k);
    arrow_zero(&e->bordered, &e->bordered.m);
    for (int b = 0; b < e->nkept; b++)
        for (int d = 0; d <= KD && b + d < e->nkept; d++)
            put(e, b + d, b, k->band[d + b * (KD + 1)], m->band[d + b * (KD + 1)]);
    for (int q = 0; q < k->nfar; q++)
        for (int p = q; p < k->nfar; p++)
            put(e, k->far[p], k->far[q], k->block[p + q * k->nfar], m->block[p + q * k->nfar]);
}

/* One solution for each of `count` <= ARROW_SHIFTS pairs with its shift: y = u, right-hand sides [M u; 0]. Returns how many lost
 * a pivot; those come first in pair and shift then, with a shift beside, as at a pair to the last digit. */
static int solve_together(struct eigen_guyan *e, int count, int *pair, double *shift)
{
    double sigma[ARROW_SHIFTS];
    int negative[ARROW_SHIFTS], lost = 0, n = e->nkept;
    for (int s = 0; s < ARROW_SHIFTS; s++)
        sigma[s] = shift[s < count ? s : 0];
    arrow_factor(&e->bordered, sigma, negative);
    memset(e->right, 0, (size_t)e->rows * ARROW_SHIFTS * sizeof(double));
    for (int s = 0; s < count; s++)
        for (int k = 0; k < n && negative[s] >= 0; k++)
            e->right[(ptrdiff_t)e->row[k] * ARROW_SHIFTS + s] = e->product[k + (ptrdiff_t)pair[s] * n];
    arrow_solve(&e->bordered, e->right);
    for (int s = 0; s < count; s++) {
        for (int k = 0; k < n && negative[s] >= 0; k++)
            e->y[k + (ptrdiff_t)pair[s] * n] = e->right[(ptrdiff_t)e->row[k] * ARROW_SHIFTS + s];
        if (negative[s] < 0) {
            pair[lost] = pair[s];
            shift[lost++] = shift[s] * (1 + BESIDE);
        }
    }
    return lost;
}

/* y of the pairs that are not good yet. Returns 1 where one has no factor. */
static int solve_open(struct eigen_guyan *e, const double *sigma)
{
    int pair[ARROW_SHIFTS], waiting = 0, failures = 0;
    double shift[ARROW_SHIFTS];
    for (int j = 0; j < e->count || waiting;) {
        for (; j < e->count && waiting < ARROW_SHIFTS; j++)
            if (e->expected[j] > TOLERANCE) {
                pair[waiting] = j;
                shift[waiting++] = j < e->from ? -LOW * sigma[e->from] : sigma[j];
            }
        waiting = waiting ? solve_together(e, waiting, pair, shift) : 0;
        failures += waiting;
        if (failures > ATTEMPTS * e->count)
            return 1;
    }
    return 0;
}

/* One solution for each pair that is not good yet with the shift sigma [count], Rayleigh-Ritz, and what is expected to be left of
 * the vectors: the sine of how far one turned times |lambda - sigma|/gap. */
static int iterate(struct eigen_guyan *e, const double *sigma)
{
    int n = e->nkept, count = e->count;
    matrix_multiply(&e->m, count, e->u, e->product);
    memcpy(e->y, e->u, (size_t)n * (size_t)count * sizeof(double));
    if (solve_open(e, sigma))
        return 1;
    memcpy(e->right, e->product, (size_t)n * (size_t)count * sizeof(double)); /* M times the vectors before */
    if (ritz_pairs(n, count, &e->k, &e->m, e->y, e->next, e->u, e->product, e->squares, e->work))
        return 1;
    for (int j = 0; j < count; j++) {
        double cosine = product_dot(n, e->u + (ptrdiff_t)j * n, e->right + (ptrdiff_t)j * n), gap = INFINITY;
        if (j > 0)
            gap = fabs(sigma[j] - e->next[j - 1]);
        if (j + 1 < count)
            gap = fmin(gap, fabs(e->next[j + 1] - sigma[j]));
        if (j < e->from)
            e->expected[j] = 0;
        else if (e->expected[j] > TOLERANCE)
            e->expected[j] = sqrt(fmax(1 - cosine * cosine, 4 * DBL_EPSILON)) * fabs(e->next[j] - sigma[j]) / gap;
    }
    memcpy(e->value, e->next, (size_t)count * sizeof(double));
    return 0;
}

/* Lengths of the vectors in the new M: the angles of the first iteration want them. */
static int normalise(struct eigen_guyan *e)
{
    int n = e->nkept;
    matrix_multiply(&e->m, e->count, e->u, e->product);
    for (int j = 0; j < e->count; j++) {
        double *u = e->u + (ptrdiff_t)j * n, square = product_dot(n, u, e->product + (ptrdiff_t)j * n);
        if (!(square > 0) || !isfinite(square))
            return 1;
        for (int i = 0; i < n; i++)
            u[i] /= sqrt(square);
    }
    return 0;
}

static void quotients(struct eigen_guyan *e)
{
    matrix_multiply(&e->k, e->count, e->u, e->product);
    for (int j = 0; j < e->count; j++)
        e->value[j] = product_dot(e->nkept, e->u + (ptrdiff_t)j * e->nkept, e->product + (ptrdiff_t)j * e->nkept);
}

/* As many eigenvalues are negative as there are forces, and those of the pairs. */
static int none_missed(struct eigen_guyan *e)
{
    double above = e->value[e->count - 1] * (1 + COUNTED);
    int negative = arrow_count(&e->bordered, above);
    if (negative < 0)
        negative = arrow_count(&e->bordered, above * (1 + BESIDE));
    return negative == e->count + e->nkept - e->nc;
}

int eigen_guyan_solve(struct eigen_guyan *e, const rotid_matrix *k, const rotid_matrix *m, const double *near, double *lambda,
                      double *x)
{
    if (!e->applies || !e->near || !parts(e, k, m))
        return 1;
    e->near = 0;
    take_kept(e, k, &e->k);
    take_kept(e, m, &e->m);
    for (int p = 0; p < e->npiece; p++)
        if (condense_piece(e, &e->piece[p], k, m))
            return 1;
    if (normalise(e))
        return 1;
    form_bordered(e);
    if (near)
        memcpy(e->value, near, (size_t)e->count * sizeof *near);
    else
        quotients(e);
    double worst = INFINITY;
    for (int j = 0; j < e->count; j++)
        e->expected[j] = INFINITY;
    for (int round = 0; worst > TOLERANCE; round++) {
        if (round == ROUNDS || !(e->value[e->from] > 0))
            return 1;
        memcpy(lambda, e->value, (size_t)e->count * sizeof *lambda);
        if (iterate(e, lambda))
            return 1;
        worst = 0;
        for (int j = e->from; j < e->count; j++)
            worst = fmax(worst, isnan(e->expected[j]) ? INFINITY : e->expected[j]);
    }
    if (e->value[0] < -INDEFINITE * e->value[e->from] || !none_missed(e))
        return 1;
    memcpy(lambda, e->value, (size_t)e->count * sizeof *lambda);
    for (int j = 0; j < e->count; j++)
        for (int c = 0; c < e->nc; c++)
            x[c + (ptrdiff_t)j * e->nc] = e->u[e->master[c] + (ptrdiff_t)j * e->nkept];
    e->near = 1;
    return 0;
}

void eigen_guyan_expand(const struct eigen_guyan *e, int j, double *u)
{
    const double *kept = e->u + (ptrdiff_t)j * e->nkept;
    for (int k = 0; k < e->nkept; k++)
        u[e->kept[k]] = kept[k];
    for (int p = 0; p < e->npiece; p++) {
        const struct guyan_piece *piece = &e->piece[p];
        for (int i = 0; i < piece->length; i++) {
            double sum = 0;
            for (int q = 0; q < piece->nend; q++)
                sum += piece->x[i + q * piece->length] * kept[piece->first + q];
            u[piece->from + i] = sum;
        }
    }
}
