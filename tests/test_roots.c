/* Roots of polynomials and leading Cholesky systems, which the poles of all orders rest on. */
#include "ema/ema.h"
#include "linalg/linalg.h"
#include "support.h"

#define N 12

UNIT_TEST(roots_of_unity)
{
    double c[N] = {0}, work[N * N + 15 * N + N];
    double complex root[N];
    assert_true(polynomial_roots_workspace(N) <= sizeof work / sizeof *work);
    c[N - 1] = -1;
    assert_int_equal(polynomial_roots(N, c, root, work), 0);
    for (int j = 0; j < N; j++) {
        double complex power = 1;
        for (int k = 0; k < N; k++)
            power *= root[j];
        assert_close(cabs(power - 1), 0, 0, 1e-13);
        for (int k = 0; k < j; k++)
            assert_true(cabs(root[j] - root[k]) > 0.5);
    }
    c[3] = NAN;
    assert_int_equal(polynomial_roots(N, c, root, work), 1);
}

/* A_ij = min(i, j) + 1, whose leading blocks are of the same kind; A^-1 of a unit vector is tridiagonal. */
UNIT_TEST(one_factor_serves_all_sizes)
{
    double a[N * N], b[N];
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            a[i + j * N] = (i < j ? i : j) + 1;
    assert_int_equal(cholesky_factor(N, a), 0);
    for (int m = 2; m <= N; m++) {
        memset(b, 0, sizeof b);
        b[m - 2] = 1;
        cholesky_forward(N, a, 1, b);
        cholesky_backward_leading(m, N, a, b);
        assert_close(b[m - 1], -1, 1e-12, 0);
        assert_close(b[m - 2], 2, 1e-12, 0);
        if (m > 2)
            assert_close(b[m - 3], -1, 1e-12, 0);
    }
    a[0] = -1;
    assert_int_equal(cholesky_factor(N, a), 1);
}

UNIT_TEST(a_gram_matrix_is_the_product)
{
    double a[6] = {1, 2, 3, 4, 5, 6}, gram[4], full[4];
    product_gram(2, 3, a, gram);
    product_transposed(2, 2, 3, a, a, full);
    for (int i = 0; i < 4; i++)
        assert_close(gram[i], full[i], 1e-15, 0);
}

#define ORDER 24

/* Coefficients of the polynomial with these roots, which come in pairs. */
static void from_roots(int n, const double complex *root, double *c)
{
    double complex all[ORDER + 1] = {1};
    for (int j = 0; j < n; j++)
        for (int k = j + 1; k > 0; k--)
            all[k] -= root[j] * all[k - 1];
    for (int k = 0; k < n; k++)
        c[k] = creal(all[k + 1]);
}

/* The next order of a stabilisation table: most roots stay, each a little elsewhere, and a pair or two real ones come. The
 * eigenvalues of the companion matrix are the other way. */
UNIT_TEST(roots_of_the_next_order_are_those_of_the_companion_matrix)
{
    struct random_stream random = {.state = 3};
    int reached = 0;
    for (int k = 0; k < 200; k++) {
        double complex before[ORDER], truth[ORDER], root[ORDER], companion[ORDER];
        double c[ORDER], angle[ORDER], work[ORDER * ORDER + 16 * ORDER];
        int done[ORDER], n = 4 + 2 * (int)(11 * random_uniform(&random));
        assert_true(polynomial_roots_workspace(n) <= sizeof work / sizeof *work);
        for (int j = 0; j < n; j += 2) {
            int are_real = j >= n - 2 && k % 5 == 0;
            double size = 0.8 + 0.4 * random_uniform(&random), phi = 3.1 * random_uniform(&random) + 0.02;
            truth[j] = are_real ? size : size * CMPLX(cos(phi), sin(phi));
            truth[j + 1] = are_real ? -0.7 * size : conj(truth[j]);
        }
        for (int j = 0; j < n - 2; j++) {
            double complex off = 1 + 1e-3 * CMPLX(random_normal(&random), random_normal(&random));
            before[j] = j % 2 ? conj(before[j - 1]) : truth[j] * off;
        }
        from_roots(n, truth, c);
        assert_int_equal(polynomial_roots(n, c, companion, work), 0);
        if (next_roots(n, c, before, root, done, angle))
            continue; /* the caller turns to the companion matrix */
        reached++;
        for (int j = 0; j < n; j++) {
            double nearest = INFINITY, apart = INFINITY, partner = INFINITY;
            for (int i = 0; i < n; i++) {
                nearest = fmin(nearest, cabs(root[j] - companion[i]));
                partner = fmin(partner, cabs(conj(root[j]) - root[i]));
                if (i != j)
                    apart = fmin(apart, cabs(root[j] - root[i]));
            }
            assert_close(nearest, 0, 0, 1e-8);
            assert_true(apart > 1e-9 && partner == 0);
        }
    }
    print_message("%d of 200\n", reached);
    assert_true(reached >= 190);
    double c[4] = {0, NAN, 0, 1};
    double complex before[2] = {I, -I}, root[4];
    int done[4];
    double angle[4];
    assert_int_equal(next_roots(4, c, before, root, done, angle), 1);
}
