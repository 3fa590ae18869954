#include "ema/modal_gram.h"

#include <math.h>

/* Functions of a mode, times nu^4 and then the first eight times nu^2: real and imaginary parts of g, g^2, g', g'^2; and times
 * nu^4 only |g|^2 g, |g|^4, which as partial fractions would lose digits far from the pole. Behind those of all modes 1, nu^2,
 * nu^4. */
#define FOURTH  11
#define SQUARE  8
#define OF_MODE (FOURTH + SQUARE)
#define OF_PAIR 16  /* of two poles too close: products of their four columns each, behind the three */
#define NEAREST 0.2 /* of what a line sees: the half bandwidth, the distance to the lines, their spacing */

int modal_gram_functions(const struct modal_gram *gram)
{
    return OF_MODE * gram->nmode + 3 + OF_PAIR * gram->nclose;
}

static int most_close(int nmode)
{
    return nmode + nmode / 2;
}

int modal_gram_new(struct pool *pool, int nline, int nmode, struct modal_gram *gram)
{
    *gram = (struct modal_gram){.nline = nline, .nmode = nmode, .nclose = most_close(nmode)};
    gram->most = modal_gram_functions(gram);
    gram->table = POOL_ARRAY(pool, double, (size_t)nline *(size_t)gram->most);
    gram->a = POOL_ARRAY(pool, double complex, (size_t)nmode *(size_t)nmode);
    gram->b = POOL_ARRAY(pool, double complex, (size_t)nmode *(size_t)nmode);
    gram->close = POOL_ARRAY(pool, int, 2 * (size_t)gram->nclose);
    return gram->table && gram->a && gram->b && gram->close ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static double seen(double complex pole, double first, double last)
{
    return fmax(-creal(pole), fmax(first - cimag(pole), cimag(pole) - last));
}

/* Sums of partial fractions lose (what the lines see of two poles over their distance)^3. */
static int is_close(double complex one, double complex other, double first, double last, double spacing)
{
    double distance = fmin(cabs(conj(one) + conj(other)), cabs(conj(one) + other));
    return distance < NEAREST * fmax(spacing, fmax(seen(one, first, last), seen(other, first, last)));
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

static void fill_mode(int n, const double *nu, double complex pole, double *f)
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
        fill_mode(n, nu, pole[r], gram->table + (ptrdiff_t)OF_MODE * r * n);
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

void modal_gram_assemble(const struct modal_gram *gram, const double *sum, double *matrix)
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
