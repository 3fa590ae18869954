#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "running/running.h"

#define STEPS          40    /* of an inverse iteration: six are enough from near */
#define WITHIN         1e-13 /* relative change of lambda at which it ends */
#define ALIKE          0.8   /* |u'v|^2 of the vectors of one mode before and behind a step of speed */
#define TURNED         0.75  /* biorthogonal product of a mode with itself before a step, at least */
#define HALVINGS       30
#define FARTHEST       0.2  /* of the speed: a step of Newton */
#define ONE            1e-7 /* relative distance of two eigenvalues below which they are one */
#define ASIDE          1e-7 /* of lambda: a shift beside it, to which modes of one value, as the bounce of a drum, are one */
#define GROWS_STRAIGHT 1e-7 /* of the highest mode: below, a real eigenvalue is rounding of 0 */
#define IS_A_WAVE      1e-6 /* Im lambda over |lambda|: below, the mode does not whirl */
#define OVERDAMPED     0.05 /* and does not where it decays: the basis does not tell its frequency */

int pair_new(struct pool *pool, int size, struct pair *pair)
{
    pair->u = POOL_ARRAY(pool, double complex, 2 * (size_t)size);
    pair->left = pair->u + size;
    return pair->u ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void pair_copy(int size, const struct pair *from, struct pair *to)
{
    to->lambda = from->lambda;
    memcpy(to->u, from->u, (size_t)size * sizeof *to->u);
    memcpy(to->left, from->left, (size_t)size * sizeof *to->left);
}

static double complex inner(int n, const double complex *a, const double complex *b)
{
    double complex sum = 0;
    for (int i = 0; i < n; i++)
        sum += conj(a[i]) * b[i];
    return sum;
}

double pair_likeness(int size, const struct pair *a, const struct pair *b)
{
    double complex alike = inner(size, a->u, b->u);
    return creal(alike * conj(alike));
}

static void normalise(int n, double complex *u)
{
    double length = sqrt(creal(inner(n, u, u)));
    for (int i = 0; i < n; i++)
        u[i] /= length;
}

/* v := (factor A + B) u, of which D has two derivatives: 2 lambda M + C by lambda, lambda dC + dK by the speed */
static void multiply(int n, double complex factor, const double *a, const double *b, const double complex *u, double complex *v)
{
    memset(v, 0, (size_t)n * sizeof *v);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            v[i] += (factor * a[i + (ptrdiff_t)n * j] + b[i + (ptrdiff_t)n * j]) * u[j];
}

ORDER_BY(by_imaginary, struct pair, cimag(it->lambda), 0)

static int is_a_wave(double complex lambda)
{
    return cimag(lambda) > (creal(lambda) < 0 ? OVERDAMPED : IS_A_WAVE) * cabs(lambda);
}

/* u' T v, T (x, y) = (i y, -i x): 1 for forward circles, -1 for backward ones */
static double complex turning(const struct system *s, const double complex *u, const double complex *v)
{
    double complex sum = 0;
    for (int i = 0; i < s->plane; i++)
        sum += conj(u[i]) * I * v[s->plane + i] - conj(u[s->plane + i]) * I * v[i];
    return sum;
}

/* Two modes of one eigenvalue, as the bounce of an isotropic rotor, have any vectors of a plane: those that are most forward and
 * most backward in it are taken, which stay modes at other speeds. */
static void part(const struct system *s, struct pair *a, struct pair *b)
{
    double complex along = inner(s->size, a->u, b->u);
    for (int i = 0; i < s->size; i++)
        b->u[i] -= along * a->u[i];
    double left = creal(inner(s->size, b->u, b->u));
    if (!(left > 1e-12))
        return; /* one vector */
    normalise(s->size, b->u);
    double p = creal(turning(s, a->u, a->u)), q = creal(turning(s, b->u, b->u));
    double complex r = turning(s, a->u, b->u);
    double apart = hypot((p - q) / 2, cabs(r));
    if (!(apart > 1e-12))
        return;
    double low = (p + q) / 2 - apart; /* eigenvalue of [p r; r* q] with its vector (r, low - p) or (low - q, r*) */
    double complex first = fabs(low - p) > fabs(low - q) ? r : low - q,
                   second = fabs(low - p) > fabs(low - q) ? low - p : conj(r);
    double length = hypot(cabs(first), cabs(second));
    first /= length;
    second /= length;
    for (int i = 0; i < s->size; i++) {
        double complex x = a->u[i], y = b->u[i];
        a->u[i] = first * x + second * y;
        b->u[i] = -conj(second) * x + conj(first) * y;
    }
}

int pairs_all(struct pool *pool, struct system *s, double speed, int *count, struct pair *pair, double *real)
{
    struct pool scratch;
    int two = 2 * s->size;
    *count = 0;
    pool_open(&scratch, pool->allocator);
    double complex *lambda = POOL_ARRAY(&scratch, double complex, two),
                   *u = POOL_ARRAY(&scratch, double complex, (size_t)two *(size_t)s->size);
    double *work = POOL_ARRAY(&scratch, double, quadratic_workspace(s->size)),
           *mass = POOL_ARRAY(&scratch, double, (size_t)s->size *(size_t)s->size);
    int status = lambda && u && work && mass ? ROTID_OK : ROTID_ERROR_MEMORY;
    system_at(s, speed);
    if (!status) {
        memcpy(mass, s->mass, (size_t)s->size * (size_t)s->size * sizeof *mass);
        status = quadratic_pairs(s->size, s->highest / 4, mass, s->c, s->stiff, lambda, u, work, s->pivot) ? ROTID_ERROR_EIGEN
                                                                                                           : ROTID_OK;
    }
    for (int j = 0; j < two && !status && real; j++) {
        double grown = fabs(cimag(lambda[j])) <= IS_A_WAVE * cabs(lambda[j]) && creal(lambda[j]) > GROWS_STRAIGHT * s->highest
                           ? creal(lambda[j])
                           : 0;
        *real = j ? fmax(*real, grown) : grown;
    }
    for (int j = 0; j < two && !status; j++) {
        if (!is_a_wave(lambda[j]) || *count == s->size)
            continue;
        struct pair *to = &pair[(*count)++];
        to->lambda = lambda[j];
        memcpy(to->u, u + (ptrdiff_t)s->size * j, (size_t)s->size * sizeof *u);
        memset(to->left, 0, (size_t)s->size * sizeof *u);
        normalise(s->size, to->u);
    }
    qsort(pair, (size_t)*count, sizeof *pair, by_imaginary);
    for (int j = 0; j + 1 < *count; j++)
        if (cabs(pair[j + 1].lambda - pair[j].lambda) < ONE * cabs(pair[j].lambda))
            part(s, &pair[j], &pair[j + 1]);
    pool_close(&scratch);
    return status;
}

/* By inverse iteration from u, with the factors of D next to the eigenvalue in s->d. */
static void left_by_factor(struct system *s, struct pair *pair)
{
    memcpy(pair->left, pair->u, (size_t)s->size * sizeof *pair->left);
    for (int i = 0; i < 3; i++) {
        complex_solve(s->size, 1, s->d, s->pivot, pair->left);
        normalise(s->size, pair->left);
    }
}

int pair_left(struct system *s, int side, struct pair *pair)
{
    system_dynamic(s, pair->lambda * (1 + ASIDE), side, s->d);
    if (complex_factor(s->size, s->d, s->pivot))
        return 1;
    left_by_factor(s, pair);
    return 0;
}

/* D(s + i h W, W) u = 0 with c* u = 1, c being u as it came: each step solves
 *   x = D^-1 D,lambda u, y = D^-1 D,W u,  c* x ds + c* (i h x + y) dW = -1,  u := -(x (ds + i h dW) + y dW)
 * for the real ds and dW. */
int pair_synchronise(struct system *s, double h, double *speed, struct pair *pair)
{
    int n = s->size;
    double growth = creal(pair->lambda), w = *speed, before = INFINITY;
    double complex *x = s->right, *c = s->left, *y = pair->left;
    memcpy(c, pair->u, (size_t)n * sizeof *c);
    for (int step = 0; step < STEPS; step++) {
        double aside = ASIDE * w;
        double complex lambda = growth + aside + I * h * w;
        system_at(s, w);
        system_dynamic(s, lambda, critical_side(h), s->d);
        multiply(n, 2 * lambda, s->mass, s->c, pair->u, x);
        multiply(n, lambda, s->dc, s->dk, pair->u, y);
        if (complex_factor(n, s->d, s->pivot)) {
            w *= 1 + 1e-15; /* an eigenvalue to the last bit */
            continue;
        }
        complex_solve(n, 0, s->d, s->pivot, x);
        complex_solve(n, 0, s->d, s->pivot, y);
        double complex a = inner(n, c, x), b = I * h * a + inner(n, c, y);
        double det = creal(a) * cimag(b) - cimag(a) * creal(b), ds = -cimag(b) / det, dw = cimag(a) / det;
        if (!isfinite(ds) || !isfinite(dw))
            return 1;
        double limit = fabs(dw) > FARTHEST * w ? FARTHEST * w / fabs(dw) : 1;
        for (int i = 0; i < n; i++)
            pair->u[i] = -(x[i] * (ds + I * h * dw) + y[i] * dw);
        growth += aside + limit * ds;
        w += limit * dw;
        double change = (fabs(dw) + fabs(aside + ds)) / w;
        if (change < WITHIN || (change < 1e-10 && change >= before / 2)) {
            *speed = w;
            pair->lambda = growth + I * h * w;
            normalise(n, pair->u);
            return 0;
        }
        before = change;
    }
    return 1;
}

/* Inverse iteration: x = D^-1 D' u, lambda := lambda - 1/(c* x), u := x/(c* x), c being u as it came, which keeps scale and
 * phase: a mode that is followed turns continuously. */
static int refine(struct system *s, int side, struct pair *pair)
{
    int n = s->size;
    double complex lambda = pair->lambda;
    double before = INFINITY;
    memcpy(s->left, pair->u, (size_t)n * sizeof *s->left);
    for (int step = 0; step < STEPS; step++) {
        double complex shift = lambda * (1 + ASIDE);
        system_dynamic(s, shift, side, s->d);
        multiply(n, 2 * shift, s->mass, s->c, pair->u, s->right);
        if (complex_factor(n, s->d, s->pivot)) { /* lambda is an eigenvalue to the last bit */
            lambda *= 1 + 1e-15;
            continue;
        }
        complex_solve(n, 0, s->d, s->pivot, s->right);
        double complex scale = inner(n, s->left, s->right);
        if (!(cabs(scale) > 0) || !isfinite(cabs(scale)))
            return 1;
        double change = cabs(shift - 1 / scale - lambda) / cabs(lambda);
        lambda = shift - 1 / scale;
        for (int i = 0; i < n; i++)
            pair->u[i] = s->right[i] / scale;
        if (change < WITHIN || (change < 1e-10 && change >= before / 2)) { /* the last digits come and go */
            pair->lambda = lambda;
            left_by_factor(s, pair); /* those of the last step are as near as that went */
            normalise(n, pair->u);
            return !is_a_wave(lambda);
        }
        before = change;
    }
    return 1;
}

static int side_of(double complex lambda, double at)
{
    return cimag(lambda) > at ? 1 : cimag(lambda) < at ? -1 : 0;
}

/* Where the pair of one side lies on the other side and that of the other one on this, Im lambda stays at w = W: side 0. */
int pair_refine(struct system *s, double at, struct pair *pair)
{
    int own = side_of(pair->lambda, at);
    if (refine(s, own, pair))
        return 1;
    if (!s->hysteretic || side_of(pair->lambda, at) == own)
        return 0;
    if (refine(s, -own, pair))
        return 1;
    return side_of(pair->lambda, at) == -own ? 0 : refine(s, 0, pair);
}

/* l* A u/(l* dD/dlambda u) for the product A u [size] */
static double complex share_of(const struct system *s, const struct pair *pair, const double complex *product)
{
    double complex below = 0, above = inner(s->size, pair->left, product);
    for (int j = 0; j < s->size; j++) {
        double complex column = 0;
        for (int i = 0; i < s->size; i++)
            column +=
                conj(pair->left[i]) * (2 * pair->lambda * s->mass[i + (ptrdiff_t)s->size * j] + s->c[i + (ptrdiff_t)s->size * j]);
        below += column * pair->u[j];
    }
    return above / below;
}

double complex pair_difference(struct system *nominal, struct system side[2], double apart, double speed, int turn,
                               const struct pair *pair, double complex *work)
{
    size_t size = (size_t)nominal->size;
    double complex *below = work, *above = work + size * size, *product = work + 2 * size * size;
    for (int i = 0; i < 2; i++) {
        system_at(&side[i], speed);
        system_dynamic(&side[i], pair->lambda, turn, i ? above : below);
    }
    memset(product, 0, size * sizeof *product);
    for (size_t col = 0; col < size; col++)
        for (size_t row = 0; row < size; row++)
            product[row] += (above[row + size * col] - below[row + size * col]) / apart * pair->u[col];
    system_at(nominal, speed);
    return -share_of(nominal, pair, product);
}

double complex pair_rate(const struct system *s, const struct pair *pair)
{
    multiply(s->size, pair->lambda, s->dc, s->dk, pair->u, s->right);
    return -share_of(s, pair, s->right);
}

/* Of two modes u and v of one speed l* ((lambda + mu) M + C) v = 0, l and lambda being those of u. The quotient of that by the
 * same with v = u is 1 for one mode, and near 0 for another one a step of speed away. */
static double biorthogonal(const struct system *s, const struct pair *pair, const struct pair *other)
{
    double complex above = 0, below = 0;
    for (int j = 0; j < s->size; j++)
        for (int i = 0; i < s->size; i++) {
            double complex l = conj(pair->left[i]);
            double m = s->mass[i + (ptrdiff_t)s->size * j], c = s->c[i + (ptrdiff_t)s->size * j];
            above += l * ((pair->lambda + other->lambda) * m + c) * other->u[j];
            below += l * (2 * pair->lambda * m + c) * pair->u[j];
        }
    return cabs(above / below);
}

int pair_follow(struct system *s, double from, double to, int least, struct pair *pair)
{
    struct pair next = s->spare[0];
    double at = from, step = (to - from) / least, most = fabs(step);
    int lost = 0, halved = 0;
    while (at != to && !lost) {
        double then = fabs(to - at) <= fabs(step) * (1 + 1e-9) ? to : at + step;
        system_at(s, at);
        double complex rate = pair_rate(s, pair); /* no number where there is no left vector yet */
        int known = isfinite(cabs(rate));
        pair_copy(s->size, pair, &next);
        next.lambda += known ? rate * (then - at) : 0;
        system_at(s, then);
        int failed = pair_refine(s, then, &next);
        double same = failed ? 0 : pair_likeness(s->size, pair, &next);
        if (known && !failed) {
            system_at(s, at);
            double likewise = biorthogonal(s, pair, &next);
            failed = !(likewise > TURNED && likewise < 1 / TURNED);
        }
        if (!failed && same > ALIKE) {
            pair_copy(s->size, &next, pair);
            at = then;
            step *= fabs(step) < most ? 2 : 1;
            continue;
        }
        step /= 2;
        lost = ++halved > HALVINGS;
    }
    return lost;
}

void system_orbit(const struct system *s, const double *row, const double complex *u, double complex orbit[2])
{
    orbit[0] = orbit[1] = 0;
    for (int j = 0; j < s->columns; j++) {
        orbit[0] += row[j] * u[j];
        orbit[1] += row[j] * u[s->plane + j];
    }
}

/* Forward where the orbits x + iy = f e^{iwt} + conj(b) e^{-iwt} of all places run with the spin, |f| > |b|. A place that hardly
 * moves, or moves along a line, says nothing. */
enum whirl pair_whirl(const struct system *s, const double complex *u)
{
    double most = 0;
    int forward = 0, backward = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < s->naxis; i++) {
            double complex at[2];
            system_orbit(s, s->axis + (ptrdiff_t)s->columns * i, u, at);
            double f = cabs(at[0] + I * at[1]), b = cabs(at[0] - I * at[1]), size = f * f + b * b;
            most = pass ? most : fmax(most, size);
            if (!pass || size < 1e-4 * most)
                continue;
            forward += f * f - b * b > 1e-6 * size;
            backward += b * b - f * f > 1e-6 * size;
        }
    return forward && !backward ? WHIRL_FORWARD : backward && !forward ? WHIRL_BACKWARD : WHIRL_MIXED;
}
