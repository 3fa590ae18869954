/* Banded matrices with a far block, their factors, dense symmetric systems, least squares: each against dense arithmetic. */
#include "dense.h"

#include <cblas.h>
#include <lapacke.h>

#include "linalg/linalg.h"
#include "support.h"

static const struct structure {
    int n, kd, nfar, far[6];
} structures[] = {
    {1, 0, 0, {0}},
    {1, 0, 1, {0}},
    {7, 0, 0, {0}},
    {7, 6, 0, {0}},
    {9, 3, 2, {2, 3}},
    {12, 11, 3, {0, 5, 11}},
    {30, 3, 4, {4, 5, 22, 23}},
    {41, 5, 6, {0, 1, 17, 18, 39, 40}},
    {60, 1, 1, {30}},
    {5, 2, 5, {0, 1, 2, 3, 4}},
    {100, 40, 0, {0}}, /* in panels, from here on */
    {97, 24, 5, {0, 47, 48, 49, 96}},
    {75, 30, 2, {10, 60}},
};

enum { nstructure = sizeof structures / sizeof *structures };

/* ---- matrices */

POOL_TEST(multiply_combine_and_product_match_dense)
{
    struct random_stream stream = {1};
    for (int s = 0; s < nstructure; s++) {
        const struct structure *of = &structures[s];
        int n = of->n;
        rotid_matrix a, b, c;
        random_positive(*state, &stream, n, of->kd, of->nfar, of->far, 1, &a);
        random_positive(*state, &stream, n, of->kd, of->nfar, of->far, 1, &b);
        assert_status(matrix_new(*state, n, of->kd, of->nfar, of->far, &c), ROTID_OK);
        const double *full = dense_of(*state, &a), *other = dense_of(*state, &b);
        const double *x = random_numbers(*state, &stream, 3 * (ptrdiff_t)n);
        double *y = numbers(*state, 3 * (ptrdiff_t)n), *work = numbers(*state, n), *sum = numbers(*state, (ptrdiff_t)n * n);
        matrix_multiply(&a, 3, x, y);
        assert_close(relative_difference(3 * (size_t)n, y, dense_product(*state, n, n, 3, full, x)), 0, 0, 1e-14);

        double expected = dense_transposed_product(*state, 1, n, 1, x, dense_product(*state, n, n, 1, full, x + n))[0];
        double size = dense_norm(n, n, full) * cblas_dnrm2(n, x, 1) * cblas_dnrm2(n, x + n, 1);
        assert_close(matrix_product(&a, x, x + n, work), expected, 0, 1e-14 * size);

        matrix_combine(2, &a, -0.25, &b, &c);
        for (ptrdiff_t i = 0; i < (ptrdiff_t)n * n; i++)
            sum[i] = 2 * full[i] - 0.25 * other[i];
        assert_close(relative_difference((size_t)n * (size_t)n, dense_of(*state, &c), sum), 0, 0, 1e-15);
        matrix_combine(2, &a, -0.25, &b, &b); /* the result may be the second matrix, or the first */
        assert_close(relative_difference((size_t)n * (size_t)n, dense_of(*state, &b), sum), 0, 0, 1e-15);
        matrix_combine(-1, &c, 0, &a, &c);
        assert_close(relative_difference((size_t)n * (size_t)n, dense_of(*state, &c), sum), 2, 0, 1e-15);

        matrix_zero(&a);
        assert_close(dense_norm(n, n, dense_of(*state, &a)), 0, 0, 0);
    }
}

/* The element is stiff between degrees of freedom that are neighbours, far apart, and in falling order. */
POOL_TEST(added_elements_stand_at_their_place_and_its_mirror)
{
    enum { n = 20 };
    const int far[4] = {2, 3, 16, 17}, dof[3][4] = {{4, 5, 6, 7}, {2, 3, 16, 17}, {17, 16, 3, 2}};
    struct random_stream stream = {2};
    rotid_matrix a;
    assert_status(matrix_new(*state, n, 3, 4, far, &a), ROTID_OK);
    double *expected = numbers(*state, n * n);
    for (int e = 0; e < 3; e++) {
        double *g = random_numbers(*state, &stream, 16), element[16];
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++)
                element[i + 4 * j] = g[i + 4 * j] + g[j + 4 * i];
        matrix_add_element(&a, 4, dof[e], element);
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++)
                expected[dof[e][i] + n * dof[e][j]] += element[i + 4 * j];
    }
    matrix_add(&a, 8, 8, 3.5);
    matrix_add(&a, 9, 11, -2);
    matrix_add(&a, 11, 9, -2);
    matrix_add(&a, 16, 2, 0.75);
    expected[8 + n * 8] += 3.5;
    expected[9 + n * 11] -= 4;
    expected[11 + n * 9] -= 4;
    expected[16 + n * 2] += 0.75;
    expected[2 + n * 16] += 0.75;
    assert_close(relative_difference(n * n, dense_of(*state, &a), expected), 0, 0, 1e-15);
}

POOL_TEST(one_value_that_is_not_finite_is_seen)
{
    struct random_stream stream = {3};
    const struct structure *of = &structures[6];
    const double bad[3] = {NAN, INFINITY, -INFINITY};
    rotid_matrix a;
    random_positive(*state, &stream, of->n, of->kd, of->nfar, of->far, 1, &a);
    a.band[0] = 1e308;
    a.band[4] = -1e308; /* large is finite */
    assert_true(matrix_is_finite(&a));
    for (int b = 0; b < 3; b++) {
        double *places[3] = {&a.band[0], &a.band[4 * (of->n - 1)], &a.block[of->nfar * of->nfar - 1]};
        for (int p = 0; p < 3; p++) {
            double kept = *places[p];
            *places[p] = bad[b];
            assert_false(matrix_is_finite(&a));
            *places[p] = kept;
        }
    }
    assert_true(matrix_is_finite(&a));
}

/* ---- factors */

/* Largest |A x - b| over |A| |x| + |b|, columns apart. */
static double solution_residual(struct pool *pool, int n, int columns, const double *a, const double *x, const double *b)
{
    const double *ax = dense_product(pool, n, n, columns, a, x);
    double norm = dense_norm(n, n, a), worst = 0;
    for (int c = 0; c < columns; c++) {
        double difference = 0, size = 0;
        for (int i = c * n; i < (c + 1) * n; i++) {
            difference += fabs(ax[i] - b[i]);
            size += norm * fabs(x[i]) + fabs(b[i]);
        }
        worst = fmax(worst, difference / size);
    }
    return worst;
}

/* Factors A on the rows kept, solves for three right-hand sides. */
static void check_factor(struct pool *pool, struct random_stream *stream, enum factor_kind kind, const rotid_matrix *a, int nkept,
                         const int *kept)
{
    struct factor f;
    const double *part = dense_part(pool, a->n, dense_of(pool, a), nkept, kept, nkept, kept);
    const double *b = random_numbers(pool, stream, 3 * (ptrdiff_t)nkept);
    double *x = numbers(pool, 3 * (ptrdiff_t)nkept);
    assert_status(factor_new(pool, kind, a, nkept, kept, &f), ROTID_OK);
    for (int again = 0; again < 2; again++) { /* nothing of the first factors may be left in the second */
        memcpy(x, b, 3 * (size_t)nkept * sizeof *x);
        assert_int_equal(factor_compute(&f, a), 0);
        factor_solve(&f, 3, x);
        assert_close(solution_residual(pool, nkept, 3, part, x, b), 0, 0, 1e-12);
        /* the condition of these matrices is below 1e4 */
        assert_close(relative_difference(3 * (size_t)nkept, x, dense_solution(pool, nkept, 3, part, b)), 0, 0, 1e-10);
    }
}

/* all, all but the far ones, only the far ones, and a random half */
static int choose_rows(struct random_stream *stream, const struct structure *of, int choice, int *kept)
{
    int count = 0;
    for (int i = 0; i < of->n; i++) {
        int is_far = 0;
        for (int f = 0; f < of->nfar; f++)
            is_far |= of->far[f] == i;
        if (choice == 0 || (choice == 1 && !is_far) || (choice == 2 && is_far) || (choice > 2 && random_uniform(stream) < 0.5))
            kept[count++] = i;
    }
    return count;
}

POOL_TEST(factors_solve_as_dense_ones_on_any_rows)
{
    struct random_stream stream = {4};
    int kept[100], cases = 0;
    for (int s = 0; s < nstructure; s++)
        for (int choice = 0; choice < 6; choice++) {
            const struct structure *of = &structures[s];
            int count = choose_rows(&stream, of, choice, kept);
            rotid_matrix a, b;
            if (!count)
                continue;
            cases++;
            random_positive(*state, &stream, of->n, of->kd, of->nfar, of->far, 1, &a);
            check_factor(*state, &stream, FACTOR_CHOLESKY, &a, count, kept);
            check_factor(*state, &stream, FACTOR_LU, &a, count, kept);
            random_positive(*state, &stream, of->n, of->kd, of->nfar, of->far, 0.3, &b);
            matrix_combine(1, &a, -0.8, &b, &a); /* of either sign */
            check_factor(*state, &stream, FACTOR_LU, &a, count, kept);
        }
    assert_true(cases > 50);
}

POOL_TEST(a_factor_can_keep_other_rows_afterwards)
{
    struct random_stream stream = {5};
    const struct structure *of = &structures[7];
    int n = of->n, all[100], fewer[100];
    rotid_matrix a;
    struct factor f;
    random_positive(*state, &stream, n, of->kd, of->nfar, of->far, 1, &a);
    for (int i = 0; i < n; i++)
        all[i] = i;
    assert_status(factor_new(*state, FACTOR_LU, &a, n, all, &f), ROTID_OK);
    assert_int_equal(factor_compute(&f, &a), 0);
    const double *full = dense_of(*state, &a);
    for (int left_out = 0; left_out < n; left_out++) { /* as Nelson's method does: also a far one */
        for (int i = 0; i < n - 1; i++)
            fewer[i] = i + (i >= left_out);
        const double *b = random_numbers(*state, &stream, n - 1), *part = dense_part(*state, n, full, n - 1, fewer, n - 1, fewer);
        double *x = numbers(*state, n - 1);
        memcpy(x, b, (size_t)(n - 1) * sizeof *x);
        factor_keep(&f, &a, n - 1, fewer);
        assert_int_equal(factor_compute(&f, &a), 0);
        factor_solve(&f, 1, x);
        assert_close(solution_residual(*state, n - 1, 1, part, x, b), 0, 0, 1e-12);
    }
}

POOL_TEST(a_matrix_that_is_not_positive_definite_is_refused)
{
    struct random_stream stream = {6};
    const struct structure *of = &structures[6];
    int n = of->n, all[100];
    rotid_matrix a;
    struct factor f;
    for (int i = 0; i < n; i++)
        all[i] = i;
    for (int i = 0; i < n; i++) { /* of the band, or a far one: that shows in the Schur complement only */
        random_positive(*state, &stream, n, of->kd, of->nfar, of->far, 1, &a);
        assert_status(factor_new(*state, FACTOR_CHOLESKY, &a, n, all, &f), ROTID_OK);
        assert_int_equal(factor_compute(&f, &a), 0);
        const double *full = dense_of(*state, &a);
        double *unit = numbers(*state, n);
        unit[i] = 1;
        double margin = 1 / dense_solution(*state, n, 1, full, unit)[i]; /* lowering a_ii by this makes A singular */
        a.band[(ptrdiff_t)i * (of->kd + 1)] -= 0.99 * margin;
        assert_int_equal(factor_compute(&f, &a), 0);
        a.band[(ptrdiff_t)i * (of->kd + 1)] -= 0.02 * margin;
        assert_int_equal(factor_compute(&f, &a), 1);
    }
}

POOL_TEST(a_singular_matrix_is_refused_by_lu)
{
    const int far[2] = {1, 5}, all[6] = {0, 1, 2, 3, 4, 5};
    rotid_matrix a;
    struct factor f;
    for (int empty = 0; empty < 6; empty++) {
        assert_status(matrix_new(*state, 6, 1, 2, far, &a), ROTID_OK);
        for (int i = 0; i < 6; i++)
            matrix_add(&a, i, i, i % 2 ? -1 : 2);
        assert_status(factor_new(*state, FACTOR_LU, &a, 6, all, &f), ROTID_OK);
        assert_int_equal(factor_compute(&f, &a), 0);
        a.band[2 * empty] = 0;
        assert_int_equal(factor_compute(&f, &a), 1);
    }
}

/* Sylvester: as many negative eigenvalues of K - s M as eigenvalues of the pencil below s, for s in every gap. */
POOL_TEST(negative_eigenvalues_are_counted_in_every_gap)
{
    struct random_stream stream = {8};
    for (int s = 2; s < nstructure; s++) {
        const struct structure *of = &structures[s];
        int n = of->n, all[100];
        rotid_matrix k, m, shifted;
        struct factor f;
        for (int i = 0; i < n; i++)
            all[i] = i;
        double floor = of->kd < FACTOR_WIDE ? 0 : 1; /* the lowest eigenvalues of a wide random band are rounding without */
        random_positive(*state, &stream, n, of->kd, of->nfar, of->far, floor, &k);
        random_positive(*state, &stream, n, of->kd, of->nfar, of->far, 1, &m);
        assert_status(matrix_new(*state, n, of->kd, of->nfar, of->far, &shifted), ROTID_OK);
        assert_status(factor_new(*state, FACTOR_CHOLESKY, &k, n, all, &f), ROTID_OK);
        double *lambda = numbers(*state, n), *value = numbers(*state, n);
        dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1, lambda, numbers(*state, (ptrdiff_t)n * n));
        for (int below = 0; below <= n; below++) {
            double low = below ? lambda[below - 1] : -lambda[n - 1], high = below < n ? lambda[below] : 2 * lambda[n - 1];
            matrix_combine(1, &k, -(low + high) / 2, &m, &shifted);
            int negative = 0;
            double *full = dense_of(*state, &shifted);
            assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, full, n, value), 0);
            for (int i = 0; i < n; i++)
                negative += value[i] < 0;
            assert_int_equal(factor_negative_count(&f, &shifted), negative);
            assert_int_equal(negative, below);
        }
    }
}

/* ---- dense kernels */

POOL_TEST(symmetric_systems_are_solved_at_any_leading_size)
{
    enum { most = 40 };
    struct random_stream stream = {9};
    struct symmetric s;
    assert_status(symmetric_new(*state, most, &s), ROTID_OK);
    for (int n = 1; n <= most; n += 3) {
        const double *g = random_numbers(*state, &stream, n * n), *b = random_numbers(*state, &stream, n);
        double *a = numbers(*state, n * n), *x = numbers(*state, n);
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                a[i + j * n] = n > 1 && i == j ? 0 : g[i + j * n] + g[j + i * n]; /* a zero diagonal wants pivots of size two */
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                s.a[i + j * n] = i >= j ? a[i + j * n] : NAN; /* the lower triangle is all that may be read */
        memcpy(x, b, (size_t)n * sizeof *x);
        assert_int_equal(symmetric_factor(&s, n), 0);
        symmetric_solve(&s, n, x);
        assert_close(solution_residual(*state, n, 1, a, x, b), 0, 0, 1e-14);
    }
    memset(s.a, 0, 9 * sizeof *s.a);
    s.a[0] = s.a[4] = 1;
    assert_int_equal(symmetric_factor(&s, 3), 1);
    assert_int_equal(symmetric_factor(&s, 0), 0);
    symmetric_solve(&s, 0, NULL);
}

static double scaled_length(int n, const double *scale, const double *h)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += scale[j] * h[j] * scale[j] * h[j];
    return sqrt(sum);
}

/* With all the room it wants, and then with less: mu has grown, and the length is what was allowed. */
POOL_TEST(the_damped_step_solves_the_normal_equations)
{
    const int sizes[][2] = {{1, 1}, {6, 2}, {400, 8}, {3, 7}, {20, 20}};
    const double dampings[] = {1e-6, 1e-2, 1, 1e4}, parts[] = {2, 0.9, 0.1, 1e-6};
    struct random_stream stream = {10};
    for (int s = 0; s < 5; s++)
        for (int d = 0; d < 4; d++) {
            int m = sizes[s][0], n = sizes[s][1];
            const double *jacobian = random_numbers(*state, &stream, (ptrdiff_t)m * n), *r = random_numbers(*state, &stream, m);
            double *scale = numbers(*state, n), *floor = numbers(*state, n), *h = numbers(*state, n), free_length = INFINITY;
            double *work = numbers(*state, (ptrdiff_t)least_squares_workspace(m, n));
            for (int j = 0; j < n; j++) {
                scale[j] = 0.1 + random_uniform(&stream);
                floor[j] = 1e-3 * random_uniform(&stream);
            }
            for (int p = -1; p < 4; p++) {
                double mu = dampings[d], length, radius = p < 0 ? INFINITY : parts[p] * free_length;
                assert_int_equal(least_squares_damped_step(m, n, jacobian, r, scale, floor, radius, &mu, h, &length, work), 0);
                double *normal = dense_transposed_product(*state, n, m, n, jacobian, jacobian);
                double *right = dense_transposed_product(*state, n, m, 1, jacobian, r);
                for (int j = 0; j < n; j++) {
                    normal[j + j * n] += mu * scale[j] * scale[j] + floor[j] * floor[j];
                    right[j] = -right[j];
                }
                /* rows of the damping that are larger than those above them cost digits */
                assert_close(solution_residual(*state, n, 1, normal, h, right), 0, 0, 1e-13 * (1 + sqrt(mu)));
                assert_close(length, scaled_length(n, scale, h), 1e-14, 0);
                if (p < 0)
                    free_length = length;
                if (p <= 0) {
                    assert_true(mu == dampings[d]);
                    continue;
                }
                assert_true(length <= 1.1 * radius && (mu > dampings[d] || length == free_length));
                assert_true(length > 0.999 * radius); /* from above: Newton's iteration does not overshoot */
            }
        }
}

/* Two equal columns: without damping the step is as long as rounding makes it. */
POOL_TEST(a_step_without_bound_is_shortened_to_the_radius)
{
    const double jacobian[6] = {1, 2, 3, 1, 2, 3}, r[3] = {1, -2, 0.5}, scale[2] = {1, 1}, floor[2] = {1e-14, 3e-14};
    double *work = numbers(*state, (ptrdiff_t)least_squares_workspace(3, 2)), h[2], length;
    for (double radius = 1e-8; radius < 1e3; radius *= 10) {
        double mu = 1e-100;
        assert_int_equal(least_squares_damped_step(3, 2, jacobian, r, scale, floor, radius, &mu, h, &length, work), 0);
        assert_true(length <= 1.1 * radius);
    }
}

POOL_TEST(a_step_that_is_not_finite_is_refused)
{
    double jacobian[6] = {1, 2, 3, 4, 5, 7}, r[3] = {1, 1, 1}, scale[2] = {1, 1}, h[2], length, mu = 1;
    const double zero[6] = {0};
    double *work = numbers(*state, (ptrdiff_t)least_squares_workspace(3, 2));
    r[1] = NAN;
    assert_int_equal(least_squares_damped_step(3, 2, jacobian, r, scale, zero, 1, &mu, h, &length, work), 1);
    r[1] = 1;
    jacobian[4] = INFINITY;
    assert_int_equal(least_squares_damped_step(3, 2, jacobian, r, scale, zero, 1, &mu, h, &length, work), 1);
    jacobian[4] = 5;
    assert_int_equal(least_squares_damped_step(3, 2, jacobian, r, scale, zero, 1, &mu, h, &length, work), 0);
    scale[1] = 0; /* nothing holds h[1] */
    assert_int_equal(least_squares_damped_step(3, 2, zero, r, scale, zero, 1, &mu, h, &length, work), 1);
}

POOL_TEST(singular_values_are_roots_of_the_normal_matrix)
{
    const int sizes[][2] = {{1, 1}, {6, 2}, {300, 7}, {2, 5}, {1, 4}, {9, 9}, {4, 1}};
    struct random_stream stream = {11};
    for (int s = 0; s < 7; s++) {
        int m = sizes[s][0], n = sizes[s][1];
        const double *jacobian = random_numbers(*state, &stream, (ptrdiff_t)m * n);
        double *value = numbers(*state, n), *v = numbers(*state, n * n), *square = numbers(*state, n);
        double *work = numbers(*state, (ptrdiff_t)singular_values_workspace(m, n));
        assert_int_equal(singular_values(m, n, jacobian, value, v, work), 0);
        double *normal = dense_transposed_product(*state, n, m, n, jacobian, jacobian);
        const double *v_v = dense_transposed_product(*state, n, n, n, v, v), *j_v = dense_product(*state, m, n, n, jacobian, v);
        const double *diagonal = dense_transposed_product(*state, n, m, n, j_v, j_v);
        assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, normal, n, square), 0);
        for (int j = 0; j < n; j++) {
            double top = value[0] * value[0];
            assert_true(value[j] >= 0 && (j == 0 || value[j] <= value[j - 1]));
            assert_close(value[j] * value[j], square[n - 1 - j], 0, 1e-13 * top);
            if (j >= m)
                assert_close(value[j], 0, 0, 0);
            for (int i = 0; i < n; i++) {
                assert_close(v_v[i + j * n], i == j, 0, 1e-14);
                assert_close(diagonal[i + j * n], i == j ? value[j] * value[j] : 0, 0, 1e-13 * top);
            }
        }
    }
}
