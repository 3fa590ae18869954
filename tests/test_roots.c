/* Roots of polynomials and leading Cholesky systems, which the poles of all orders rest on. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "linalg/cholesky.h"
#include "linalg/product.h"
#include "linalg/roots.h"
#include "support.h"

#define N 12

static void roots_of_unity(void **state)
{
    double c[N] = {0}, work[N * N + 15 * N + N];
    double complex root[N];
    (void)state;
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
static void one_factor_serves_all_sizes(void **state)
{
    double a[N * N], b[N];
    (void)state;
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

static void a_gram_matrix_is_the_product(void **state)
{
    double a[6] = {1, 2, 3, 4, 5, 6}, gram[4], full[4];
    (void)state;
    product_gram(2, 3, a, gram);
    product_transposed(2, 2, 3, a, a, full);
    for (int i = 0; i < 4; i++)
        assert_close(gram[i], full[i], 1e-15, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_of_unity),
        cmocka_unit_test(one_factor_serves_all_sizes),
        cmocka_unit_test(a_gram_matrix_is_the_product),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
