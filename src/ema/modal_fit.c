#include "ema/ema.h"
#include "linalg/linalg.h"

/* Functions of a mode, times nu^4 and then the first eight times nu^2: real and imaginary parts of g, g^2, g', g'^2; and times
 * nu^4 only |g|^2 g, |g|^4, which as partial fractions would lose digits far from the pole. Behind those of all modes 1, nu^2,
 * nu^4. */
#define FOURTH  11
#define SQUARE  8
#define OF_MODE (FOURTH + SQUARE)
#define OF_PAIR 16  /* of two poles too close: products of their four columns each, behind the three */
#define NEAREST 0.2 /* of what a line sees: the half bandwidth, the distance to the lines, their spacing */

/* Number of functions in the table, for the poles that it was filled for. */
static int modal_gram_functions(const struct modal_gram *gram)
{
    return OF_MODE * gram->nmode + 3 + OF_PAIR * gram->nclose;
}

static int most_close(int nmode)
{
    return nmode + nmode / 2;
}

/* ROTID_OK or ROTID_ERROR_MEMORY. */
static int modal_gram_new(struct pool *pool, int nline, int nmode, struct modal_gram *gram)
{
    *gram = (struct modal_gram){.nline = nline, .nmode = nmode, .nclose = most_close(nmode)};
    gram->most = modal_gram_functions(gram);
    gram->table = POOL_ARRAY(pool, double, (size_t)nline *(size_t)gram->most);
    gram->a = POOL_ARRAY(pool, double complex, (size_t)nmode *(size_t)nmode);
    gram->b = POOL_ARRAY(pool, double complex, (size_t)nmode *(size_t)nmode);
    gram->close = POOL_ARRAY(pool, int, 2 * (size_t)gram->nclose);
    return gram->table && gram->a && gram->b && gram->close ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static double modal_gram_seen(double complex pole, double first, double last)
{
    return fmax(-creal(pole), fmax(first - cimag(pole), cimag(pole) - last));
}

/* Sums of partial fractions lose (what the lines see of two poles over their distance)^3. */
static int is_close(double complex one, double complex other, double first, double last, double spacing)
{
    double distance = fmin(cabs(conj(one) + conj(other)), cabs(conj(one) + other));
    return distance < NEAREST * fmax(spacing, fmax(modal_gram_seen(one, first, last), modal_gram_seen(other, first, last)));
}

static int find_close(struct modal_gram *gram, const double *nu, const double complex *pole)
{
    double first = nu[0], last = nu[gram->nline - 1], spacing = (last - first) / gram->nline;
    gram->nclose = 0;
    for (int s = 0; s < gram->nmode; s++) {
        if (!(-creal(pole[s]) > 1e-9))
            return 1;
        for (int r = 0; r <= s; r++) {
            if (!is_close(pole[r], pole[s], first, last, spacing))
                continue;
            if (gram->nclose == most_close(gram->nmode))
                return 1;
            int *pair = gram->close + 2 * (ptrdiff_t)gram->nclose++;
            pair[0] = r;
            pair[1] = s;
        }
    }
    return 0;
}

static void modal_gram_fill_mode(int n, const double *nu, double complex pole, double *f)
{
    double a = creal(pole), b = cimag(pole);
    for (int i = 0; i < n; i++) {
        double square = nu[i] * nu[i], fourth = square * square, below = nu[i] - b, above = nu[i] + b;
        double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above);
        double gr = -a * d, gi = -below * d, mr = -a * e, mi = -above * e;
        double value[SQUARE] = {gr, gi, gr * gr - gi * gi, 2 * gr * gi, mr, mi, mr * mr - mi * mi, 2 * mr * mi};
        for (int k = 0; k < SQUARE; k++) {
            f[i + (ptrdiff_t)k * n] = fourth * value[k];
            f[i + (ptrdiff_t)(FOURTH + k) * n] = square * value[k];
        }
        f[i + (ptrdiff_t)8 * n] = fourth * d * gr;
        f[i + (ptrdiff_t)9 * n] = fourth * d * gi;
        f[i + (ptrdiff_t)10 * n] = fourth * d * d;
    }
}

/* Columns of phi and psi of two modes, [2 n] each, two and two side by side. */
static void fill_pair(int n, const double *const one[2], const double *const other[2], double *f)
{
    for (int k = 0; k < OF_PAIR; k++) {
        const double *x = one[k % 4 / 2] + (ptrdiff_t)2 * n * (k % 2), *y = other[k / 8] + (ptrdiff_t)2 * n * (k / 4 % 2);
        for (int i = 0; i < n; i++)
            f[i + (ptrdiff_t)k * n] = x[i] * y[i] + x[i + n] * y[i + n];
    }
}

int modal_gram_fill(struct modal_gram *gram, const double *nu, const double complex *pole, const double *basis)
{
    int n = gram->nline, m = gram->nmode;
    if (find_close(gram, nu, pole))
        return 1;
    for (int r = 0; r < m; r++)
        modal_gram_fill_mode(n, nu, pole[r], gram->table + (ptrdiff_t)OF_MODE * r * n);
    double *rest = gram->table + (ptrdiff_t)OF_MODE * m * n;
    for (int i = 0; i < n; i++) {
        double square = nu[i] * nu[i];
        rest[i] = 1;
        rest[i + n] = square;
        rest[i + (ptrdiff_t)2 * n] = square * square;
    }
    const double *psi = basis + (ptrdiff_t)2 * n * (2 * m + 4);
    for (ptrdiff_t k = 0; k < gram->nclose; k++) {
        ptrdiff_t r = (ptrdiff_t)4 * n * gram->close[2 * k], s = (ptrdiff_t)4 * n * gram->close[2 * k + 1];
        fill_pair(n, (const double *const[2]){basis + r, psi + r}, (const double *const[2]){basis + s, psi + s},
                  rest + (3 + OF_PAIR * k) * n);
    }
    for (int s = 0; s < m; s++)
        for (int r = 0; r < m; r++) {
            gram->a[r + (ptrdiff_t)s * m] = -1 / (pole[s] + conj(pole[r]));
            gram->b[r + (ptrdiff_t)s * m] = -1 / (conj(pole[s]) + conj(pole[r]));
        }
    return 0;
}

struct number { /* complex: the product of C guards against infinities at ten times the cost */
    double re, im;
};

static struct number times(struct number x, struct number y)
{
    return (struct number){x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re};
}

static struct number plus(struct number x, struct number y)
{
    return (struct number){x.re + y.re, x.im + y.im};
}

static struct number conjugate(struct number x)
{
    return (struct number){x.re, -x.im};
}

struct powers { /* sum of x and of x^2 */
    struct number one, two;
};

struct four_products { /* sum of conj(x)^i y^j; product[i - 1][j - 1] */
    struct number of[2][2];
};

/* inverse: -1/(pole of y + conj(pole of x)) */
static struct four_products products(struct powers x, struct powers y, struct number inverse)
{
    struct four_products p;
    x.one = conjugate(x.one);
    x.two = conjugate(x.two);
    p.of[0][0] = times(inverse, plus(x.one, y.one));
    p.of[0][1] = times(inverse, plus(y.two, p.of[0][0]));
    p.of[1][0] = times(inverse, plus(x.two, p.of[0][0]));
    p.of[1][1] = times(inverse, plus(p.of[0][1], p.of[1][0]));
    return p;
}

static struct powers powers_of(const double *sum)
{
    return (struct powers){{sum[0], sum[1]}, {sum[2], sum[3]}};
}

/* The block of two columns of each: rows s^2 (x + x'), i s^2 (x - x') by those of y; p: conj(g) g, conj(g) g', conj(g') g,
 * conj(g') g'
 */
static void put_block(ptrdiff_t all, const struct number p[4], int row, int column, double *matrix)
{
    double block[2][2] = {{p[0].re + p[1].re + p[2].re + p[3].re, -(p[0].im - p[1].im + p[2].im - p[3].im)},
                          {p[0].im + p[1].im - p[2].im - p[3].im, p[0].re - p[1].re - p[2].re + p[3].re}};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
            matrix[row + i + (column + j) * all] = matrix[column + j + (row + i) * all] = block[i][j];
}

static void put_pair(const struct modal_gram *gram, const double *sum, int r, int s, double *matrix)
{
    int m = gram->nmode, q = 2 * m + 4;
    const double *from = sum + (ptrdiff_t)OF_MODE * r, *to = sum + (ptrdiff_t)OF_MODE * s;
    double complex ca = gram->a[r + (ptrdiff_t)s * m], cb = gram->b[r + (ptrdiff_t)s * m];
    struct number a = {creal(ca), cimag(ca)}, b = {creal(cb), cimag(cb)};
    struct powers x = powers_of(from), y = powers_of(to), x1 = powers_of(from + 4), y1 = powers_of(to + 4);
    struct four_products p[4] = {products(x, y, a), products(x, y1, b), products(x1, y, conjugate(b)),
                                 products(x1, y1, conjugate(a))};
    if (r == s) {
        p[0].of[0][1] = (struct number){from[8], from[9]};
        p[0].of[1][0] = (struct number){from[8], -from[9]};
        p[0].of[1][1] = (struct number){from[10], 0};
    }
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            struct number of[4] = {p[0].of[i][j], p[1].of[i][j], p[2].of[i][j], p[3].of[i][j]};
            put_block(4 * (ptrdiff_t)m + 5, of, (i ? q : 0) + 2 * r, (j ? q : 0) + 2 * s, matrix);
        }
}

/* Rows [2] of a mode by L and U, both powers; sums over nu^2 and over nu^4. */
static void put_rest(const struct modal_gram *gram, const double *sum, int r, double *matrix)
{
    int m = gram->nmode, q = 2 * m + 4;
    ptrdiff_t all = 4 * (ptrdiff_t)m + 5;
    for (int power = 0; power < 2; power++)
        for (int fourth = 0; fourth < 2; fourth++) {
            const double *f = sum + (ptrdiff_t)OF_MODE * r + (fourth ? 0 : FOURTH) + (power ? 2 : 0);
            double sign = fourth ? 1 : -1, plus_re = sign * (f[0] + f[4]), plus_im = sign * (f[1] + f[5]);
            double minus_re = sign * (f[0] - f[4]), minus_im = sign * (f[1] - f[5]);
            double block[2][2] = {{plus_re, plus_im}, {-minus_im, minus_re}};
            for (int j = 0; j < 2; j++)
                for (int i = 0; i < 2; i++) {
                    int row = (power ? q : 0) + 2 * r + i, column = 2 * m + 2 * fourth + j;
                    matrix[row + column * all] = matrix[column + row * all] = block[i][j];
                }
        }
}

static void put_close(const struct modal_gram *gram, const double *sum, int r, int s, double *matrix)
{
    int m = gram->nmode, q = 2 * m + 4;
    ptrdiff_t all = 4 * (ptrdiff_t)m + 5;
    for (int k = 0; k < OF_PAIR; k++) {
        int row = 2 * r + k % 2 + (k % 4 / 2 ? q : 0), column = 2 * s + k / 4 % 2 + (k / 8 ? q : 0);
        matrix[row + column * all] = matrix[column + row * all] = sum[k];
    }
}

/* From sums [functions] of one channel over w^2 of its lines: matrix [(4 nmode + 5)^2], both triangles, but for the last row and
 * column: columns in the order of modal_fit.h. */
static void modal_gram_assemble(const struct modal_gram *gram, const double *sum, double *matrix)
{
    int m = gram->nmode;
    ptrdiff_t all = 4 * (ptrdiff_t)m + 5;
    for (int s = 0; s < m; s++) {
        for (int r = 0; r <= s; r++)
            put_pair(gram, sum, r, s, matrix);
        put_rest(gram, sum, s, matrix);
    }
    const double *rest = sum + (ptrdiff_t)OF_MODE * m;
    for (ptrdiff_t k = 0; k < gram->nclose; k++)
        put_close(gram, rest + 3 + OF_PAIR * k, gram->close[2 * k], gram->close[2 * k + 1], matrix);
    for (int k = 0; k < 4; k++)
        for (int j = 0; j < 4; j++)
            matrix[2 * m + j + (2 * m + k) * all] = (j - k) % 2 ? 0 : j / 2 != k / 2 ? -rest[1] : rest[j < 2 ? 0 : 2];
}

/* Channels that share a product: their sums are the same however many threads there are. */
#define TOGETHER 32
/* From so many modes on sums of partial fractions are less work than products of columns */
#define FEWEST 3

static int is_summed(const struct modal_fit *fit)
{
    return fit->weight && fit->nmode >= FEWEST && fit->nchannel > 1;
}

static size_t workspace(const struct modal_fit *fit)
{
    size_t columns = (size_t)fit->ncolumn + 1, q = (size_t)fit->nlinear, p = 2 * (size_t)fit->nmode, lines = (size_t)fit->nline;
    size_t rows = fit->weight ? 2 * lines * columns : 0, least = lines * (2 * TOGETHER + 1);
    if (is_summed(fit))
        least = ((size_t)fit->summed.most + q + 3 * lines) * TOGETHER;
    return (rows > least ? rows : least) + columns * columns + q * q + q * (p + 1) + q + p * p;
}

int modal_fit_new(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                  int threads, struct modal_fit *fit)
{
    int q = 2 * nmode + 4, p = 2 * nmode, workers = threads < 1 || nchannel < 2 ? 1 : threads;
    size_t channels = (size_t)nchannel, rows = 2 * (size_t)nline;
    *fit = (struct modal_fit){.nline = nline,
                              .nchannel = nchannel,
                              .nmode = nmode,
                              .nlinear = q,
                              .ncolumn = q + p,
                              .threads = workers,
                              .scale = nline ? band->omega[line[nline / 2]] : 1};
    fit->nu = POOL_ARRAY(pool, double, nline);
    fit->y = POOL_ARRAY(pool, double, rows *channels);
    fit->yy = POOL_ARRAY(pool, double, nchannel);
    fit->weight = band->variance ? POOL_ARRAY(pool, double, (size_t)nline *channels) : NULL;
    fit->sigma = POOL_ARRAY(pool, double, nchannel);
    fit->pole = POOL_ARRAY(pool, double complex, nmode);
    fit->held = POOL_ARRAY(pool, int, nmode);
    fit->loose = POOL_ARRAY(pool, int, nmode);
    fit->basis = POOL_ARRAY(pool, double, rows *(size_t)(q + p));
    fit->gram = POOL_ARRAY(pool, double, (size_t)(q + p) * (size_t)(q + p));
    fit->right = POOL_ARRAY(pool, double, (size_t)(q + p) * channels);
    fit->linear = POOL_ARRAY(pool, double, (size_t)q *channels);
    fit->chi2 = POOL_ARRAY(pool, double, nchannel);
    fit->schur = POOL_ARRAY(pool, double, (size_t)p *(size_t)p *channels);
    fit->score = POOL_ARRAY(pool, double, (size_t)p *channels);
    fit->mix = POOL_ARRAY(pool, double, (size_t)q *(size_t)p *channels);
    fit->spread = POOL_ARRAY(pool, double, (size_t)q *(size_t)q *channels);
    fit->singular = POOL_ARRAY(pool, int, nchannel);
    fit->work = POOL_ARRAY(pool, double *, workers);
    if ((is_summed(fit) && modal_gram_new(pool, nline, nmode, &fit->summed)) || pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < workers; i++)
        if (!(fit->work[i] = POOL_ARRAY(pool, double, workspace(fit))))
            return ROTID_ERROR_MEMORY;
    for (int i = 0; i < nline; i++)
        fit->nu[i] = band->omega[line[i]] / fit->scale;
    for (int c = 0; c < nchannel; c++) {
        const double complex *h = band->h + (ptrdiff_t)(from + c) * band->nline;
        double *y = fit->y + (ptrdiff_t)2 * nline * c;
        for (int i = 0; i < nline; i++) {
            y[i] = creal(h[line[i]]);
            y[i + nline] = cimag(h[line[i]]);
            /* the variance of a complex value is shared by its two parts */
            if (band->variance)
                fit->weight[i + (ptrdiff_t)c * nline] = sqrt(2 / band->variance[line[i] + (ptrdiff_t)(from + c) * band->nline]);
        }
        fit->yy[c] = product_dot(2 * nline, y, y);
        fit->sigma[c] = 1;
    }
    return ROTID_OK;
}

static void put(double *column, int nline, int i, double re, double im)
{
    column[i] = re;
    column[i + nline] = im;
}

/* In real arithmetic: complex division and product of C guard against infinities at ten times the cost. psi may be NULL. */
static void fill_mode(int n, const double *at, double complex pole, double *phi, double *psi)
{
    ptrdiff_t rows = (ptrdiff_t)2 * n;
    double a = creal(pole), b = cimag(pole);
    for (int i = 0; i < n; i++) {
        double nu = at[i], square = -nu * nu, below = nu - b, above = nu + b;
        /* g = 1/(-a + i (nu - b)), mirror = 1/(-a + i (nu + b)) */
        double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above);
        double gr = -a * d, gi = -below * d, mr = -a * e, mi = -above * e;
        put(phi, n, i, square * (gr + mr), square * (gi + mi));
        put(phi + rows, n, i, -square * (gi - mi), square * (gr - mr));
        if (!psi)
            continue;
        double g2r = gr * gr - gi * gi, g2i = 2 * gr * gi, m2r = mr * mr - mi * mi, m2i = 2 * mr * mi;
        put(psi, n, i, square * (g2r + m2r), square * (g2i + m2i));
        put(psi + rows, n, i, -square * (g2i - m2i), square * (g2r - m2r));
    }
}

static void fill_rest(int n, const double *nu, double *rest)
{
    ptrdiff_t rows = (ptrdiff_t)2 * n;
    for (int i = 0; i < n; i++) {
        double square = -nu[i] * nu[i];
        put(rest, n, i, 1, 0);
        put(rest + rows, n, i, 0, 1);
        put(rest + 2 * rows, n, i, square, 0);
        put(rest + 3 * rows, n, i, 0, square);
    }
}

void modal_fit_columns(int nline, const double *nu, int nmode, const double complex *pole, double *phi)
{
    ptrdiff_t rows = (ptrdiff_t)2 * nline;
    for (int r = 0; r < nmode; r++)
        fill_mode(nline, nu, pole[r], phi + rows * 2 * r, NULL);
    fill_rest(nline, nu, phi + rows * 2 * nmode);
}

static void fill_basis(struct modal_fit *fit, enum modal_fit_part part)
{
    int n = fit->nline, m = fit->nmode;
    ptrdiff_t rows = (ptrdiff_t)2 * n;
    for (int r = 0; r < m; r++)
        fill_mode(n, fit->nu, fit->pole[r], fit->basis + rows * 2 * r,
                  part == MODAL_FIT_LINEAR && fit->weight ? NULL : fit->basis + rows * (fit->nlinear + 2 * r));
    fill_rest(n, fit->nu, fit->basis + rows * 2 * m);
}

/* squares [nline]: of what channel c leaves, over its variance; rows: y less what the columns explain */
static void square_residual(const struct modal_fit *fit, int c, const double *rows, double *squares)
{
    int n = fit->nline;
    double flat = fit->weight ? 1 : 1 / fit->sigma[c];
    const double *weight = fit->weight ? fit->weight + (ptrdiff_t)c * n : NULL;
    for (int i = 0; i < n; i++) {
        double re = rows[i], im = rows[i + n], w = weight ? weight[i] : flat;
        squares[i] = w * w * (re * re + im * im);
    }
}

/* Lines nu of [from, to] are first ... last - 1. */
static void lines_within(const struct modal_fit *fit, double from, double to, int *first, int *last)
{
    for (*first = 0; *first < fit->nline && fit->nu[*first] < from;)
        ++*first;
    for (*last = *first; *last < fit->nline && fit->nu[*last] <= to;)
        ++*last;
}

void modal_fit_local_noise(const struct modal_fit *fit, int count, double widths, double *noise)
{
    int n = fit->nline, at_once = fit->nchannel < TOGETHER ? fit->nchannel : TOGETHER;
    double *rows = fit->work[0], *squares = rows + (ptrdiff_t)2 * n * TOGETHER;
    for (int from = 0; from < fit->nchannel; from += at_once) {
        int channels = fit->nchannel - from < at_once ? fit->nchannel - from : at_once;
        memcpy(rows, fit->y + (ptrdiff_t)2 * n * from, 2 * (size_t)n * (size_t)channels * sizeof(double));
        product_subtract(2 * n, channels, fit->nlinear, fit->basis, fit->linear + (ptrdiff_t)fit->nlinear * from, rows);
        for (int k = 0; k < channels; k++) {
            square_residual(fit, from + k, rows + (ptrdiff_t)2 * n * k, squares);
            for (int r = 0; r < count; r++) {
                int first, last;
                double centre = cimag(fit->pole[r]), reach = widths * 2 * fabs(creal(fit->pole[r])), sum = 0;
                lines_within(fit, centre - reach, centre + reach, &first, &last);
                for (int i = first; i < last; i++)
                    sum += squares[i];
                noise[from + k + (ptrdiff_t)r * fit->nchannel] = last - first >= 4 ? sum / (2 * (last - first)) : 1;
            }
        }
    }
}

/* Gram matrix [(ncolumn + 1)^2] of basis and y with flat weights, from that of all channels. */
static void flat_gram(const struct modal_fit *fit, int c, double *gram)
{
    int all = fit->ncolumn + 1;
    double w = 1 / (fit->sigma[c] * fit->sigma[c]);
    for (int k = 0; k < fit->ncolumn; k++) {
        for (int j = 0; j < fit->ncolumn; j++)
            gram[j + (ptrdiff_t)k * all] = w * fit->gram[j + (ptrdiff_t)k * fit->ncolumn];
        gram[fit->ncolumn + (ptrdiff_t)k * all] = gram[k + (ptrdiff_t)fit->ncolumn * all] =
            w * fit->right[k + (ptrdiff_t)c * fit->ncolumn];
    }
    gram[(ptrdiff_t)all * all - 1] = w * fit->yy[c];
}

/* The same by the weighted columns themselves, as many of them as `part` asks for. */
static void channel_gram(const struct modal_fit *fit, int c, enum modal_fit_part part, double *rows, double *gram)
{
    int n = fit->nline, count = (part == MODAL_FIT_LINEAR ? fit->nlinear : fit->ncolumn) + 1;
    ptrdiff_t all = (ptrdiff_t)fit->ncolumn + 1;
    const double *weight = fit->weight + (ptrdiff_t)c * n;
    for (int k = 0; k < count; k++) {
        const double *from = k < count - 1 ? fit->basis + (ptrdiff_t)2 * n * k : fit->y + (ptrdiff_t)2 * n * c;
        double *to = rows + (ptrdiff_t)2 * n * k;
        for (int i = 0; i < n; i++) {
            to[i] = weight[i] * from[i];
            to[i + n] = weight[i] * from[i + n];
        }
    }
    product_gram(count, 2 * n, rows, gram);
    /* last first: a column moves up */
    for (ptrdiff_t k = count - 1; k >= 0 && count < all; k--) {
        ptrdiff_t to = (k == count - 1 ? all - 1 : k) * all;
        memmove(gram + to, gram + k * count, (size_t)count * sizeof(double));
        gram[to + all - 1] = gram[to + count - 1];
    }
}

/* D' D of the derivatives D = psi B(x): by Re lambda a psi1 + b psi2, by Im lambda -b psi1 + a psi2, for a residue a + i b */
static void derivative_products(int nmode, int q, const double *x, const double *gram, double *schur)
{
    ptrdiff_t all = 4 * (ptrdiff_t)nmode + 5, p = 2 * (ptrdiff_t)nmode;
    for (ptrdiff_t s = 0; s < nmode; s++)
        for (ptrdiff_t r = 0; r <= s; r++) {
            const double *one = gram + q + 2 * r + (q + 2 * s) * all, *two = one + all, *u = x + 2 * r, *v = x + 2 * s;
            double left[2][2] = {{u[0] * one[0] + u[1] * one[1], u[0] * two[0] + u[1] * two[1]},
                                 {u[0] * one[1] - u[1] * one[0], u[0] * two[1] - u[1] * two[0]}};
            for (int i = 0; i < 2; i++) {
                ptrdiff_t j = 2 * r + i, k = 2 * s;
                schur[j + k * p] = schur[k + j * p] = left[i][0] * v[0] + left[i][1] * v[1];
                schur[j + (k + 1) * p] = schur[k + 1 + j * p] = left[i][1] * v[0] - left[i][0] * v[1];
            }
        }
}

/* From the Gram matrix G: x = G_phi^-1 phi'y, derivatives D, schur = D'D - D'phi G_phi^-1 phi'D, score = D'(y - phi x). */
static void channel_solve(struct modal_fit *fit, int c, enum modal_fit_part part, const double *gram, double *work)
{
    int q = fit->nlinear, p = 2 * fit->nmode, all = fit->ncolumn + 1;
    double *factor = work, *b = factor + (ptrdiff_t)q * q, *scale = b + (ptrdiff_t)q * (p + 1), *square = scale + q;
    double *x = fit->linear + (ptrdiff_t)c * q, *mix = fit->mix + (ptrdiff_t)c * q * p;
    double *schur = fit->schur + (ptrdiff_t)c * p * p, *score = fit->score + (ptrdiff_t)c * p;
    const double *y = gram + (ptrdiff_t)fit->ncolumn * all;
    for (int j = 0; j < q; j++)
        scale[j] = gram[j + (ptrdiff_t)j * all] > 0 ? 1 / sqrt(gram[j + (ptrdiff_t)j * all]) : 0;
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            factor[j + (ptrdiff_t)k * q] = j == k ? 1 + 1e-14 : gram[j + (ptrdiff_t)k * all] * scale[j] * scale[k];
    fit->singular[c] = cholesky_factor(q, factor);
    if (fit->singular[c]) {
        memset(x, 0, (size_t)q * sizeof(double));
        memset(mix, 0, (size_t)q * (size_t)p * sizeof(double));
        memset(schur, 0, (size_t)p * (size_t)p * sizeof(double));
        memset(score, 0, (size_t)p * sizeof(double));
        fit->chi2[c] = y[fit->ncolumn];
        return;
    }
    for (int j = 0; j < q; j++)
        x[j] = y[j] * scale[j];
    cholesky_solve(q, factor, 1, x);
    double gained = 0;
    for (int j = 0; j < q; j++) {
        x[j] *= scale[j];
        gained += x[j] * y[j];
    }
    fit->chi2[c] = fmax(y[fit->ncolumn] - gained, 0);
    if (part == MODAL_FIT_LINEAR)
        return;
    for (int k = 0; k < p; k++) {
        ptrdiff_t first = k - k % 2;
        double f1 = k % 2 ? -x[first + 1] : x[first], f2 = k % 2 ? x[first] : x[first + 1];
        const double *g1 = gram + (q + first) * all, *g2 = g1 + all;
        double value = f1 * y[q + first] + f2 * y[q + first + 1], *column = b + (ptrdiff_t)k * q;
        for (int j = 0; j < q; j++) {
            double entry = f1 * g1[j] + f2 * g2[j];
            value -= entry * x[j];
            column[j] = entry * scale[j];
        }
        score[k] = value;
    }
    if (part == MODAL_FIT_SPREAD) {
        memcpy(mix, b, (size_t)q * (size_t)p * sizeof(double));
        cholesky_solve(q, factor, p, mix);
        for (int k = 0; k < p; k++)
            for (int j = 0; j < q; j++)
                mix[j + (ptrdiff_t)k * q] *= scale[j];
    }
    derivative_products(fit->nmode, q, x, gram, schur);
    cholesky_forward(q, factor, p, b);
    product_gram(p, q, b, square);
    for (int k = 0; k < p * p; k++)
        schur[k] -= square[k];
}

static void channel_spread(struct modal_fit *fit, int c, double *factor, const double *scale)
{
    int q = fit->nlinear;
    double *spread = fit->spread + (ptrdiff_t)c * q * q;
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            spread[j + (ptrdiff_t)k * q] = j == k;
    if (fit->singular[c])
        return;
    cholesky_solve(q, factor, q, spread);
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            spread[j + (ptrdiff_t)k * q] *= scale[j] * scale[k];
}

struct evaluation {
    struct modal_fit *fit;
    enum modal_fit_part part;
    int summed;
};

/* Sums over the lines of the channels from ... from + count - 1: w^2 [nline], w^2 y [2 nline]; sum [functions], right [nlinear]
 */
static void sum_channels(const struct modal_fit *fit, int from, int count, double *work, double *sum, double *right)
{
    int n = fit->nline;
    double *square = work, *wy = square + (ptrdiff_t)TOGETHER * n;
    for (int c = 0; c < count; c++) {
        const double *weight = fit->weight + (ptrdiff_t)(from + c) * n, *y = fit->y + (ptrdiff_t)2 * n * (from + c);
        for (int i = 0; i < n; i++) {
            double w = weight[i] * weight[i];
            square[i + (ptrdiff_t)c * n] = w;
            wy[i + (ptrdiff_t)2 * n * c] = w * y[i];
            wy[i + n + (ptrdiff_t)2 * n * c] = w * y[i + n];
        }
    }
    product_transposed(modal_gram_functions(&fit->summed), count, n, fit->summed.table, square, sum);
    product_transposed(fit->nlinear, count, 2 * n, fit->basis, wy, right);
}

/* chi2 and score once more from what is left of y: as differences of products they have the rounding of sums of fractions times
 * the signal over the noise, which a descent takes for progress. rest [2 nline * count], right [2 nmode * count] are workspace.
 */
static void settle_channels(struct modal_fit *fit, int from, int count, enum modal_fit_part part, double *rest, double *right)
{
    int n = fit->nline, p = 2 * fit->nmode, q = fit->nlinear;
    memcpy(rest, fit->y + (ptrdiff_t)2 * n * from, 2 * (size_t)n * (size_t)count * sizeof(double));
    product_subtract(2 * n, count, q, fit->basis, fit->linear + (ptrdiff_t)q * from, rest);
    for (int c = 0; c < count; c++) {
        const double *weight = fit->weight + (ptrdiff_t)(from + c) * n;
        double *left = rest + (ptrdiff_t)2 * n * c, sum = 0;
        for (int i = 0; i < n; i++) {
            double w = weight[i] * weight[i], re = left[i], im = left[i + n];
            sum += w * (re * re + im * im);
            left[i] = w * re;
            left[i + n] = w * im;
        }
        fit->chi2[from + c] = sum;
    }
    if (part == MODAL_FIT_LINEAR)
        return;
    product_transposed(p, count, 2 * n, fit->basis + (ptrdiff_t)2 * n * q, rest, right);
    for (int c = 0; c < count; c++) {
        const double *x = fit->linear + (ptrdiff_t)q * (from + c), *t = right + (ptrdiff_t)p * c;
        double *score = fit->score + (ptrdiff_t)p * (from + c);
        for (int k = 0; k < p && !fit->singular[from + c]; k += 2) {
            score[k] = x[k] * t[k] + x[k + 1] * t[k + 1];
            score[k + 1] = x[k] * t[k + 1] - x[k + 1] * t[k];
        }
    }
}

static int evaluate_channels(void *context, int index, int worker)
{
    const struct evaluation *evaluation = context;
    struct modal_fit *fit = evaluation->fit;
    int from = index * TOGETHER, count = fit->nchannel - from < TOGETHER ? fit->nchannel - from : TOGETHER;
    int functions = modal_gram_functions(&fit->summed);
    ptrdiff_t all = fit->ncolumn + 1, q = fit->nlinear, p = 2 * (ptrdiff_t)fit->nmode;
    double *gram = fit->work[worker], *rest = gram + all * all, *rows = rest + q * q + q * (p + 1) + q + p * p;
    double *sum = rows + (ptrdiff_t)3 * fit->nline * TOGETHER, *right = sum + (ptrdiff_t)functions * TOGETHER;
    if (evaluation->summed)
        sum_channels(fit, from, count, rows, sum, right);
    for (int k = 0, c = from; k < count; k++, c++) {
        if (!fit->weight) {
            flat_gram(fit, c, gram);
        } else if (evaluation->summed) {
            modal_gram_assemble(&fit->summed, sum + (ptrdiff_t)k * functions, gram);
            /* score and chi2, which ask for the rest of the column, come afterwards */
            memset(gram + (all - 1) * all, 0, (size_t)all * sizeof(double));
            memcpy(gram + (all - 1) * all, right + k * q, (size_t)q * sizeof(double));
        } else {
            channel_gram(fit, c, evaluation->part, rows, gram);
        }
        channel_solve(fit, c, evaluation->part, gram, rest);
        if (evaluation->part == MODAL_FIT_SPREAD)
            channel_spread(fit, c, rest, rest + q * q + q * (p + 1));
    }
    if (evaluation->summed)
        settle_channels(fit, from, count, evaluation->part, rows, right);
    return 0;
}

double modal_fit_evaluate(struct modal_fit *fit, enum modal_fit_part part)
{
    int n = fit->nline;
    fill_basis(fit, part);
    if (!fit->weight) {
        product_gram(fit->ncolumn, 2 * n, fit->basis, fit->gram);
        product_transposed(fit->ncolumn, fit->nchannel, 2 * n, fit->basis, fit->y, fit->right);
    }
    struct evaluation evaluation = {fit, part, is_summed(fit) && !modal_gram_fill(&fit->summed, fit->nu, fit->pole, fit->basis)};
    (void)parallel_for(fit->threads, (fit->nchannel + TOGETHER - 1) / TOGETHER, evaluate_channels, &evaluation);
    double sum = 0;
    for (int c = 0; c < fit->nchannel; c++)
        sum += fit->chi2[c];
    return sum;
}

int modal_fit_lines(const struct ema_band *band, int nmode, const double complex *pole, double widths, int most, int *line)
{
    for (int i = 0; i < band->nline; i++)
        line[i] = 0;
    for (int r = 0; r < nmode; r++) {
        double centre = cimag(pole[r]), width = 2 * fabs(creal(pole[r]));
        for (int near = 0; near < 2; near++) {
            double reach = (near ? 3 : widths) * width;
            int first = ema_band_line(band, centre - reach), last = ema_band_line(band, centre + reach);
            int middle = ema_band_line(band, centre);
            first = middle - 10 < first ? middle - 10 : first;
            last = middle + 10 > last ? middle + 10 : last;
            for (int i = first < 0 ? 0 : first; i < last && i < band->nline; i++)
                line[i] |= near ? 2 : 1;
        }
    }
    int near = 0, far = 0;
    for (int i = 0; i < band->nline; i++) {
        near += line[i] >= 2;
        far += line[i] == 1;
    }
    int step = 1, kept = 0;
    while (far / step + near > most && step < far)
        step++;
    for (int i = 0, seen = 0; i < band->nline; i++)
        if (line[i] >= 2 || (line[i] == 1 && seen++ % step == 0))
            line[kept++] = i;
    return kept;
}
