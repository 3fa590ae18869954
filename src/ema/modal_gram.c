#include "ema/modal_gram.h"

#include <math.h>

/* Functions of a mode, times nu^4 and then the first eight times nu^2: real and imaginary parts of g, g^2, g', g'^2; and times
 * nu^4 only |g|^2 g, |g|^4, which as partial fractions would lose digits far from the pole. Behind those of all modes 1, nu^2,
 * nu^4. */
#define FOURTH  11
#define SQUARE  8
#define OF_MODE (FOURTH + SQUARE)
#define NEAREST 0.02 /* of what a line sees: the half bandwidth or the spacing of the lines */

int modal_gram_functions(int nmode)
{
    return OF_MODE * nmode + 3;
}

int modal_gram_is_good(int nmode, const double complex *pole, double spacing)
{
    for (int r = 0; r < nmode; r++) {
        double half = -creal(pole[r]);
        if (!(half > 1e-9))
            return 0;
        for (int s = 0; s < r; s++)
            if (cabs(conj(pole[r]) + pole[s]) < NEAREST * fmax(spacing, fmax(half, -creal(pole[s]))))
                return 0;
    }
    return 1;
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

void modal_gram_fill(struct modal_gram *gram, const double *nu, const double complex *pole)
{
    int n = gram->nline, m = gram->nmode;
    for (int r = 0; r < m; r++)
        fill_mode(n, nu, pole[r], gram->table + (ptrdiff_t)OF_MODE * r * n);
    double *rest = gram->table + (ptrdiff_t)OF_MODE * m * n;
    for (int i = 0; i < n; i++) {
        double square = nu[i] * nu[i];
        rest[i] = 1;
        rest[i + n] = square;
        rest[i + (ptrdiff_t)2 * n] = square * square;
    }
    for (int s = 0; s < m; s++)
        for (int r = 0; r < m; r++) {
            gram->a[r + (ptrdiff_t)s * m] = -1 / (pole[s] + conj(pole[r]));
            gram->b[r + (ptrdiff_t)s * m] = -1 / (conj(pole[s]) + conj(pole[r]));
        }
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
            const double *f = sum + (ptrdiff_t)OF_MODE * r + (fourth ? 0 : FOURTH) + 2 * power;
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
    for (int k = 0; k < 4; k++)
        for (int j = 0; j < 4; j++)
            matrix[2 * m + j + (2 * m + k) * all] = (j - k) % 2 ? 0 : j / 2 != k / 2 ? -rest[1] : rest[j < 2 ? 0 : 2];
}
