/* The dense eigenvalue problem of a condensed model: residuals, orthonormality, the banded solver as second opinion. */
#include "dense.h"

#include "linalg/linalg.h"
#include "support.h"

/* Residuals relative to |K| + |lambda| |M|, phi' M phi = I, lambda ascending. */
static void check_pairs(struct pool *pool, int n, const double *k, const double *m, int count, const double *lambda,
                        const double *phi)
{
    const double *k_phi = dense_product(pool, n, n, count, k, phi), *m_phi = dense_product(pool, n, n, count, m, phi);
    const double *square = dense_transposed_product(pool, count, n, count, phi, m_phi);
    for (int j = 0; j < count; j++) {
        double difference = 0, size = 0;
        assert_true(j == 0 || lambda[j] >= lambda[j - 1]);
        for (int i = j * n; i < (j + 1) * n; i++) {
            difference = fmax(difference, fabs(k_phi[i] - lambda[j] * m_phi[i]));
            size = fmax(size, fabs(phi[i]));
        }
        size *= dense_norm(n, n, k) + fabs(lambda[j]) * dense_norm(n, n, m);
        assert_close(difference / size, 0, 0, 1e-13);
        for (int i = 0; i < count; i++)
            assert_close(square[i + j * count], i == j, 0, 1e-10);
    }
}

static double *solve_and_check(struct pool *pool, int n, const double *k, const double *m, int count)
{
    struct eigen_dense e;
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)n * count);
    assert_status(eigen_dense_new(pool, n, count, &e), ROTID_OK);
    for (int again = 0; again < 2; again++) { /* the second call starts from the shift of the first */
        assert_status(eigen_dense_solve(&e, k, m, lambda, phi), ROTID_OK);
        check_pairs(pool, n, k, m, count, lambda, phi);
    }
    return lambda;
}

/* A free chain whose springs span twelve decades: the trace of M^-1 K is the sum of the highest eigenvalues, of which the inverse
 * problem has no digits where the shift is of the size of the lowest. */
POOL_TEST(all_pairs_of_a_chain_of_soft_and_stiff_springs_are_pairs)
{
    struct random_stream stream = {34};
    for (int turn = 0; turn < 100; turn++) {
        int n = 3 + turn;
        double *lambda = numbers(*state, n), *phi = numbers(*state, n * n), trace = 0, sum = 0;
        rotid_matrix k, m;
        assert_status(matrix_new(*state, n, 1, 0, NULL, &k), ROTID_OK);
        assert_status(matrix_new(*state, n, 1, 0, NULL, &m), ROTID_OK);
        for (int i = 0; i < n; i++)
            m.band[2 * i] = 1;
        for (int i = 0; i + 1 < n; i++) {
            double spring = pow(10, 6 * (2 * random_uniform(&stream) - 1));
            k.band[2 * i] += spring;
            k.band[2 * i + 1] = -spring;
            k.band[2 * i + 2] += spring;
            trace += 2 * spring;
        }
        assert_status(rotid_eigenpairs(&k, &m, n, NULL, NULL, lambda, phi), ROTID_OK);
        const double *square = dense_transposed_product(*state, n, n, n, phi, phi);
        for (int i = 0; i < n; i++) {
            sum += lambda[i];
            for (int j = 0; j < n; j++)
                assert_close(square[i + j * n], i == j, 0, 1e-7);
        }
        assert_close(sum, trace, 1e-9, 0);
    }
}

POOL_TEST(a_part_and_all_pairs_agree_with_the_banded_solver)
{
    struct random_stream stream = {31};
    for (int n = 1; n <= 61; n += 12) {
        rotid_matrix k, m;
        random_positive(*state, &stream, n, n - 1, 0, NULL, 0.1, &k);
        random_positive(*state, &stream, n, n - 1, 0, NULL, 1, &m);
        struct eigen_band band;
        double *expected = numbers(*state, n), *phi = numbers(*state, n * n);
        assert_status(eigen_band_new(*state, &k, n, &band), ROTID_OK);
        assert_status(eigen_band_solve(&band, &k, &m, expected, phi), ROTID_OK);
        const double *full_k = dense_of(*state, &k), *full_m = dense_of(*state, &m);
        const int counts[5] = {1, n > 5 ? 5 : n, n / 2 + 1 < n ? n / 2 + 1 : n, n > 1 ? n - 1 : 1, n};
        for (int c = 0; c < 5; c++) {
            const double *lambda = solve_and_check(*state, n, full_k, full_m, counts[c]);
            for (int j = 0; j < counts[c]; j++)
                assert_close(lambda[j], expected[j], 1e-10, 1e-14);
        }
    }
}

/* Free strings of random masses and springs, `each` masses long: one zero eigenvalue a string. */
static void random_strings(struct pool *pool, struct random_stream *stream, int strings, int each, double **k, double **m)
{
    int n = strings * each;
    *k = numbers(pool, (ptrdiff_t)n * n);
    *m = numbers(pool, (ptrdiff_t)n * n);
    for (int i = 0; i < n; i++) {
        (*m)[i + i * n] = 0.5 + random_uniform(stream);
        if ((i + 1) % each == 0)
            continue;
        double spring = 1 + random_uniform(stream);
        (*k)[i + i * n] += spring;
        (*k)[i + 1 + (i + 1) * n] += spring;
        (*k)[i + 1 + i * n] = (*k)[i + (i + 1) * n] = -spring;
    }
}

/* Shafts in two planes have four rigid motions, bodies in space six; a request may end among them. */
POOL_TEST(any_number_of_rigid_motions_is_served)
{
    enum { each = 10 };
    struct random_stream stream = {34};
    for (int strings = 1; strings <= 7; strings++)
        for (int count = 1; count <= strings + 3; count++)
            for (int repeat = 0; repeat < 4; repeat++) {
                double *k, *m, expected[7 * each];
                int n = strings * each;
                random_strings(*state, &stream, strings, each, &k, &m);
                dense_pairs(*state, n, k, m, -0.1, expected, numbers(*state, (ptrdiff_t)n * n));
                const double *lambda = solve_and_check(*state, n, k, m, count);
                for (int j = 0; j < count; j++)
                    assert_close(lambda[j], expected[j], 1e-12, 1e-14);
            }
}

/* Two strings of n/2 masses 1 and springs 1: 4 sin^2(j pi/n), each twice. */
POOL_TEST(repeated_eigenvalues_are_found_for_any_request)
{
    enum { n = 40 };
    double *k = numbers(*state, n * n), *m = numbers(*state, n * n);
    for (int i = 0; i < n; i++) {
        m[i + i * n] = 1;
        if (i == n / 2 - 1 || i == n - 1)
            continue;
        k[i + i * n] += 1;
        k[i + 1 + (i + 1) * n] += 1;
        k[i + 1 + i * n] = k[i + (i + 1) * n] = -1;
    }
    for (int count = 1; count <= n; count++) {
        const double *lambda = solve_and_check(*state, n, k, m, count);
        for (int j = 0; j < count; j++)
            assert_close(lambda[j], 4 * pow(sin(3.14159265358979323846 * (j / 2) / n), 2), 1e-12, 1e-14);
    }
}

/* From parameters five times as stiff or as soft to others: what was found before must not matter. */
POOL_TEST(the_solution_before_does_not_show)
{
    enum { n = 30, count = 7 };
    const double factors[] = {1, 5, 0.2, 25, 1e-3, 1};
    struct random_stream stream = {32};
    struct eigen_dense warm;
    rotid_matrix k, other, m;
    random_positive(*state, &stream, n, n - 1, 0, NULL, 0.1, &k);
    random_positive(*state, &stream, n, n - 1, 0, NULL, 0.1, &other);
    random_positive(*state, &stream, n, n - 1, 0, NULL, 1, &m);
    assert_status(eigen_dense_new(*state, n, count, &warm), ROTID_OK);
    const double *full_m = dense_of(*state, &m);
    for (int f = 0; f < 6; f++) {
        double lambda[count], phi[n * count];
        matrix_combine(factors[f], &k, 0.1, &other, &k);
        const double *full_k = dense_of(*state, &k), *cold = solve_and_check(*state, n, full_k, full_m, count);
        assert_status(eigen_dense_solve(&warm, full_k, full_m, lambda, phi), ROTID_OK);
        check_pairs(*state, n, full_k, full_m, count, lambda, phi);
        for (int j = 0; j < count; j++)
            assert_close(lambda[j], cold[j], 1e-9, 0);
    }
}

/* Lowers a(row, row) by `part` of what makes A singular: 1 and more make it indefinite. */
static double *lowered(struct pool *pool, int n, const double *a, int row, double part)
{
    double *copy = numbers(pool, (ptrdiff_t)n * n), *unit = numbers(pool, n);
    memcpy(copy, a, (size_t)n * (size_t)n * sizeof *a);
    unit[row] = 1;
    copy[row + row * n] -= part / dense_solution(pool, n, 1, a, unit)[row];
    return copy;
}

POOL_TEST(a_pencil_that_is_not_of_a_structure_is_an_error)
{
    enum { n = 20 };
    struct random_stream stream = {33};
    rotid_matrix k, m;
    random_positive(*state, &stream, n, n - 1, 0, NULL, 1, &k);
    random_positive(*state, &stream, n, n - 1, 0, NULL, 1, &m);
    const double *full_k = dense_of(*state, &k), *full_m = dense_of(*state, &m);
    const int counts[3] = {1, 6, n};
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < n; row++)
            for (int warm = 0; warm < 2; warm++) {
                struct eigen_dense e;
                double lambda[n], phi[n * n];
                const double *bad_m = lowered(*state, n, full_m, row, 1.5), *bad_k = lowered(*state, n, full_k, row, 1.5);
                assert_status(eigen_dense_new(*state, n, counts[c], &e), ROTID_OK);
                if (warm)
                    assert_status(eigen_dense_solve(&e, full_k, full_m, lambda, phi), ROTID_OK);
                assert_status(eigen_dense_solve(&e, full_k, bad_m, lambda, phi), ROTID_ERROR_MASS);
                assert_status(eigen_dense_solve(&e, bad_k, full_m, lambda, phi), ROTID_ERROR_STIFFNESS);
                assert_status(eigen_dense_solve(&e, full_k, full_m, lambda, phi), ROTID_OK); /* an error spoils nothing */
                check_pairs(*state, n, full_k, full_m, counts[c], lambda, phi);
            }
}
