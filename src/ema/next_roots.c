#include "ema/next_roots.h"

#include <math.h>
#include <stddef.h>

#define STEPS   60
#define PRECISE 4e-16 /* of a root: a step below it is rounding */
#define REAL_PART                                                                                                                \
    1e-11 /* an imaginary part below that of the size is rounding; a pole so near to the end of the band is none                 \
           */
#define PI 3.141592653589793

struct number { /* complex: the product of C guards against infinities at ten times the cost */
    double re, im;
};

static struct number inverse(double re, double im)
{
    double d = 1 / (re * re + im * im);
    return (struct number){re * d, -im * d};
}

/* p'/p at x, by the reversed polynomial outside of the unit circle; *small: p is no more than its own rounding */
static struct number logarithmic_derivative(int n, const double *c, double re, double im, int *small)
{
    int outside = re * re + im * im > 1;
    struct number at = outside ? inverse(re, im) : (struct number){re, im};
    double size = sqrt(at.re * at.re + at.im * at.im), first = outside ? c[n - 1] : 1, bound = fabs(first);
    struct number p = {first, 0}, d = {0, 0};
    for (int j = 0; j < n; j++) {
        double next = outside ? (j < n - 1 ? c[n - 2 - j] : 1) : c[j], old = d.re;
        d.re = d.re * at.re - d.im * at.im + p.re;
        d.im = old * at.im + d.im * at.re + p.im;
        old = p.re;
        p.re = p.re * at.re - p.im * at.im + next;
        p.im = old * at.im + p.im * at.re;
        bound = bound * size + fabs(next);
    }
    *small = p.re * p.re + p.im * p.im <= 1e-31 * bound * bound;
    if (!(p.re * p.re + p.im * p.im > 0))
        return (struct number){0, 0};
    struct number i = inverse(p.re, p.im), ratio = {d.re * i.re - d.im * i.im, d.re * i.im + d.im * i.re};
    if (!outside)
        return ratio;
    /* p(x) = x^n q(1/x): p'/p = y (n - y q'/q) */
    struct number rest = {n - (at.re * ratio.re - at.im * ratio.im), -(at.re * ratio.im + at.im * ratio.re)};
    return (struct number){at.re * rest.re - at.im * rest.im, at.re * rest.im + at.im * rest.re};
}

static struct number repulsion(int n, const double complex *root, int i)
{
    struct number sum = {0, 0};
    double re = creal(root[i]), im = cimag(root[i]);
    for (int j = 0; j < n; j++) {
        if (j == i)
            continue;
        struct number one = inverse(re - creal(root[j]), im - cimag(root[j]));
        sum.re += one.re;
        sum.im += one.im;
    }
    return sum;
}

static void start(int n, const double *c, const double complex *before, double complex *root, double *angle)
{
    double product = 1, best = 0, where = PI / 2;
    for (int i = 0; i < n - 2; i++) {
        product *= cabs(before[i]);
        /* off the axis, which a pair of real ones could not leave to become a complex one */
        root[i] = fabs(cimag(before[i])) > 0 ? before[i] : before[i] * CMPLX(1, i % 2 ? 1e-2 : -1e-2);
        angle[i] = carg(root[i]);
    }
    for (int i = 0; i < n - 2; i++) {
        double from = angle[i], gap = PI - from;
        for (int j = 0; j < n - 2; j++)
            if (angle[j] > from && angle[j] - from < gap)
                gap = angle[j] - from;
        if (from >= 0 && gap > best) {
            best = gap;
            where = from + gap / 2;
        }
    }
    double size = fmin(fmax(sqrt(fabs(c[n - 1]) / fmax(product, 1e-300)), 0.5), 2);
    root[n - 2] = CMPLX(size * cos(where), size * sin(where));
    root[n - 1] = conj(root[n - 2]) * 1.001; /* no symmetry that every step would keep */
}

/* Real roots on the axis, others exactly in pairs. Returns 0, or 1 where one has no partner. */
static int pair_up(int n, double complex *root, int *done)
{
    for (int i = 0; i < n; i++) {
        done[i] = fabs(cimag(root[i])) <= REAL_PART * cabs(root[i]);
        if (done[i])
            root[i] = creal(root[i]);
    }
    for (int i = 0; i < n; i++) {
        int partner = -1;
        double nearest = INFINITY;
        if (done[i])
            continue;
        for (int j = 0; j < n; j++)
            if (j != i && !done[j] && cabs(root[j] - conj(root[i])) < nearest) {
                partner = j;
                nearest = cabs(root[j] - conj(root[i]));
            }
        /* a double root is known to the root of the rounding */
        if (partner < 0 || !(nearest < 1e-6 * cabs(root[i])))
            return 1;
        root[partner] = conj(root[i]);
        done[i] = done[partner] = 1;
    }
    return 0;
}

int next_roots(int n, const double *c, const double complex *before, double complex *root, int *done, double *angle)
{
    for (int i = 0; i < n; i++) {
        done[i] = 0;
        if (!isfinite(c[i]))
            return 1;
    }
    start(n, c, before, root, angle);
    int left = n;
    for (int step = 0; step < STEPS && left; step++)
        for (int i = 0; i < n; i++) {
            int small;
            if (done[i])
                continue;
            struct number newton = logarithmic_derivative(n, c, creal(root[i]), cimag(root[i]), &small);
            struct number other = repulsion(n, root, i), move = inverse(newton.re - other.re, newton.im - other.im);
            if (!small && !(isfinite(move.re) && isfinite(move.im)))
                return 1;
            if (!small)
                root[i] -= CMPLX(move.re, move.im);
            if (small || hypot(move.re, move.im) <= PRECISE * cabs(root[i])) {
                done[i] = 1;
                left--;
            }
        }
    return left || pair_up(n, root, done);
}
