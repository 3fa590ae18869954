/* Wide bands whose profile is narrower in places: products, factors in panels and eigenvector derivatives against dense ones. */
#include "dense.h"
#include "either_band.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "support.h"

static const struct structure {
    int n, kd, nfar, far[3];
} structures[] = {
    {30, 29, 0, {0}}, {47, 24, 0, {0}}, {48, 40, 0, {0}}, {97, 60, 0, {0}}, {150, 30, 3, {0, 70, 149}}, {220, 100, 2, {48, 95}},
};

enum { nstructure = sizeof structures / sizeof *structures, columns = 11 };

/* As random_positive, with windows that are short in the middle third, and zeros between the entries of the others. */
static void random_profile(struct pool *pool, struct random_stream *stream, const struct structure *of, double floor,
                           rotid_matrix *a)
{
    int n = of->n;
    double *g = numbers(pool, n);
    random_positive(pool, stream, n, of->kd, of->nfar, of->far, 0, a);
    memset(a->band, 0, (size_t)n * (size_t)(of->kd + 1) * sizeof *a->band);
    for (int first = 0; first < n; first++) {
        int thin = 3 * first > n && 3 * first < 2 * n, width = thin ? of->kd / 8 : of->kd;
        int last = first + width < n ? first + width : n - 1;
        for (int i = first; i <= last; i++)
            g[i] = i > first && random_uniform(stream) < 0.7 ? 0 : random_normal(stream);
        for (int j = first; j <= last; j++)
            for (int i = j; i <= last; i++)
                a->band[(i - j) + (ptrdiff_t)j * (of->kd + 1)] += g[i] * g[j];
        a->band[(ptrdiff_t)first * (of->kd + 1)] += floor;
    }
}

POOL_TEST(products_with_many_columns_match_dense)
{
    struct random_stream stream = {61};
    for (int s = 0; s < nstructure; s++) {
        const struct structure *of = &structures[s];
        ptrdiff_t length = (ptrdiff_t)of->n * columns;
        rotid_matrix k, m;
        struct pencil pencil;
        random_profile(*state, &stream, of, 1, &k);
        random_profile(*state, &stream, of, 2, &m);
        const double *x = random_numbers(*state, &stream, length);
        double *y = numbers(*state, length);
        assert_status(pencil_new(*state, &k, &pencil), ROTID_OK);
        assert_int_equal(pencil_take(&pencil, &k, &m), 0);
        for (int count = 1; count <= columns; count++) {
            size_t size = (size_t)of->n * (size_t)count;
            const double *kx = dense_product(*state, of->n, of->n, count, dense_of(*state, &k), x),
                         *mx = dense_product(*state, of->n, of->n, count, dense_of(*state, &m), x);
            matrix_multiply(&k, count, x, y);
            assert_close(relative_difference(size, y, kx), 0, 0, 1e-14);
            pencil_multiply_stiffness(&pencil, count, x, y);
            assert_close(relative_difference(size, y, kx), 0, 0, 1e-14);
            pencil_multiply_mass(&pencil, count, x, y);
            assert_close(relative_difference(size, y, mx), 0, 0, 1e-14);
        }
    }
}

POOL_TEST(a_pencil_knows_whether_the_mass_is_the_one_of_before)
{
    struct random_stream stream = {62};
    const struct structure *of = &structures[4];
    rotid_matrix k, m;
    struct pencil pencil;
    random_profile(*state, &stream, of, 1, &k);
    random_profile(*state, &stream, of, 1, &m);
    assert_status(pencil_new(*state, &k, &pencil), ROTID_OK);
    assert_int_equal(pencil_take(&pencil, &k, &m), 0);
    k.band[0] += 1;
    assert_int_equal(pencil_take(&pencil, &k, &m), 1);
    double *touched[] = {&m.band[0], &m.band[(ptrdiff_t)100 * (of->kd + 1) + 3], &m.block[4]};
    for (int t = 0; t < 3; t++) {
        *touched[t] += 1e-12;
        assert_int_equal(pencil_take(&pencil, &k, &m), 0);
        assert_int_equal(pencil_take(&pencil, &k, &m), 1);
    }
    const double *x = random_numbers(*state, &stream, of->n);
    double *y = numbers(*state, of->n);
    for (int t = 0; t < 4; t++) { /* entries of K that go, come back, and stand where there were none */
        ptrdiff_t from = (ptrdiff_t)(40 + 10 * t) * (of->kd + 1);
        for (int d = 1; d <= of->kd; d++)
            k.band[from + d] = (d + t) % 3 ? 0 : k.band[from + d] == 0 ? 0.5 : 0;
        (void)pencil_take(&pencil, &k, &m);
        pencil_multiply_stiffness(&pencil, 1, x, y);
        assert_close(relative_difference((size_t)of->n, y, dense_product(*state, of->n, of->n, 1, dense_of(*state, &k), x)), 0, 0,
                     1e-14);
    }
}

/* b := A^-1 b of the rows kept, which the dense solver confirms */
static void check_solution(struct pool *pool, struct factor *f, const rotid_matrix *shifted, int n, const int *kept, double *b)
{
    const double *part = dense_part(pool, shifted->n, dense_of(pool, shifted), n, kept, n, kept),
                 *expected = dense_solution(pool, n, columns, part, b);
    factor_solve(f, columns, b);
    assert_close(relative_difference((size_t)n * columns, b, expected), 0, 0, 1e-9);
}

POOL_TEST(factors_of_a_pencil_solve_as_dense_ones_and_count)
{
    struct random_stream stream = {63};
    for (int s = 0; s < nstructure; s++)
        for (int left_out = -1; left_out < structures[s].n; left_out += 1 + structures[s].n / 4) {
            const struct structure *of = &structures[s];
            int n = of->n, kept[220], count = 0;
            rotid_matrix k, m, shifted;
            struct pencil pencil;
            struct factor f;
            for (int i = 0; i < n; i++)
                if (i != left_out)
                    kept[count++] = i;
            random_profile(*state, &stream, of, 1, &k);
            random_profile(*state, &stream, of, 1, &m);
            assert_status(matrix_new(*state, n, of->kd, of->nfar, of->far, &shifted), ROTID_OK);
            assert_status(pencil_new(*state, &k, &pencil), ROTID_OK);
            (void)pencil_take(&pencil, &k, &m);
            double *lambda = numbers(*state, n), *vectors = numbers(*state, (ptrdiff_t)n * n);
            dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1, lambda, vectors);

            assert_status(factor_new(*state, FACTOR_CHOLESKY, &k, count, kept, &f), ROTID_OK);
            matrix_combine(1, &k, 0.5, &m, &shifted);
            assert_int_equal(factor_compute_pencil(&f, &pencil, -0.5), 0);
            check_solution(*state, &f, &shifted, count, kept, random_numbers(*state, &stream, (ptrdiff_t)count * columns));
            assert_int_equal(factor_compute_pencil(&f, &pencil, 2 * lambda[n - 1]), 1);

            assert_status(factor_new(*state, FACTOR_LU, &k, count, kept, &f), ROTID_OK);
            for (int below = 0; below < n; below += 1 + n / 7) { /* every block of the diagonal may be of either sign */
                double shift = below ? (lambda[below - 1] + lambda[below]) / 2 : lambda[0] - 1;
                matrix_combine(1, &k, -shift, &m, &shifted);
                assert_int_equal(factor_compute_pencil(&f, &pencil, shift), 0);
                check_solution(*state, &f, &shifted, count, kept, random_numbers(*state, &stream, (ptrdiff_t)count * columns));
                if (left_out < 0)
                    assert_int_equal(factor_negative_count_pencil(&f, &pencil, shift), below);
            }
        }
}

/* ---- eigenvector derivatives */

/* Those of pair j, one of `members` equal ones from `first` on, for random right-hand sides by both ways */
static void check_derivative(struct pool *pool, struct random_stream *stream, const rotid_matrix *k, const rotid_matrix *m,
                             double lambda, const double *phi, int members)
{
    int n = k->n;
    struct nelson_band band;
    struct nelson_dense dense;
    const double *p = random_numbers(pool, stream, 2 * (ptrdiff_t)n), *q = random_numbers(pool, stream, 2 * (ptrdiff_t)members);
    double *m_phi = numbers(pool, (ptrdiff_t)n * members), *dphi = numbers(pool, 2 * (ptrdiff_t)n),
           *expected = numbers(pool, 2 * (ptrdiff_t)n);
    matrix_multiply(m, members, phi, m_phi);
    assert_status(nelson_band_new(pool, k, 2, &band), ROTID_OK);
    assert_int_equal(band.factor.is_wide, 1);
    nelson_band_begin(&band, k, m);
    assert_status(nelson_band_prepare(&band, lambda, members, phi), ROTID_OK);
    nelson_band_solve(&band, 2, members, phi, m_phi, p, q, dphi);
    assert_status(nelson_dense_new(pool, n, &dense), ROTID_OK);
    assert_status(nelson_dense_prepare(&dense, dense_of(pool, k), dense_of(pool, m), lambda, members, phi), ROTID_OK);
    for (int c = 0; c < 2; c++)
        nelson_dense_solve(&dense, members, phi, m_phi, p + (ptrdiff_t)c * n, q + (ptrdiff_t)c * members,
                           expected + (ptrdiff_t)c * n);
    assert_close(relative_difference(2 * (size_t)n, dphi, expected), 0, 0, 1e-9);
}

POOL_TEST(derivatives_agree_with_dense_ones)
{
    struct random_stream stream = {64};
    for (int s = 0; s < nstructure; s++) {
        const struct structure *of = &structures[s];
        int n = of->n;
        rotid_matrix k, m;
        random_profile(*state, &stream, of, 1, &k);
        random_profile(*state, &stream, of, 1, &m);
        double *lambda = numbers(*state, n), *phi = numbers(*state, (ptrdiff_t)n * n);
        dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1, lambda, phi);
        for (int j = 0; j < n; j += 1 + n / 9)
            check_derivative(*state, &stream, &k, &m, lambda[j], phi + (ptrdiff_t)j * n, 1);
    }
}

/* Two free chains, not coupled: every eigenvalue twice, the lowest ones zero. The second one has its degrees of freedom between
 * those of the first. */
POOL_TEST(derivatives_in_clusters_of_a_free_structure_agree)
{
    enum { each = 60, n = 2 * each };
    struct random_stream stream = {65};
    rotid_matrix k, m;
    assert_status(matrix_new(*state, n, FACTOR_WIDE, 0, NULL, &k), ROTID_OK);
    assert_status(matrix_new(*state, n, FACTOR_WIDE, 0, NULL, &m), ROTID_OK);
    for (int i = 0; i < n; i++) {
        matrix_add(&m, i, i, 1 + 0.01 * (double)(i / 2));
        if (i + 2 < n) {
            matrix_add(&k, i, i, 1);
            matrix_add(&k, i + 2, i + 2, 1);
            matrix_add(&k, i, i + 2, -1);
        }
    }
    double *lambda = numbers(*state, n), *phi = numbers(*state, (ptrdiff_t)n * n);
    dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e-3, lambda, phi);
    for (int j = 0; j < n; j += 10)
        check_derivative(*state, &stream, &k, &m, lambda[j], phi + (ptrdiff_t)j * n, 2);
}

/* ---- eigenpairs */

POOL_TEST(pairs_agree_with_dense_ones)
{
    struct random_stream stream = {66};
    for (int s = 0; s < nstructure; s++)
        for (int count = 1; count < 12; count += 5) {
            const struct structure *of = &structures[s];
            int n = of->n;
            rotid_matrix k, m;
            struct eigen_wide e;
            random_profile(*state, &stream, of, 0.01, &k);
            random_profile(*state, &stream, of, 1, &m);
            double *lambda = numbers(*state, n), *expected = numbers(*state, n), *phi = numbers(*state, (ptrdiff_t)n * n);
            assert_status(eigen_wide_new(*state, &k, count, &e), ROTID_OK);
            for (int step = 0; step < 4; step++) { /* cold, the same again, a part and all of K stiffer */
                for (ptrdiff_t i = 0; i < (ptrdiff_t)n * (of->kd + 1) && step == 3; i++)
                    k.band[i] *= 3;
                if (step == 2)
                    for (int i = 0; i < n / 2; i++)
                        matrix_add(&k, i, i, 0.2);
                dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e-3, expected,
                            numbers(*state, (ptrdiff_t)n * n));
                assert_status(eigen_wide_solve(&e, &k, &m, lambda, phi), ROTID_OK);
                for (int j = 0; j < count; j++)
                    assert_close(lambda[j], expected[j], 1e-10, 0);
            }
        }
}

/* Vectors to 1e-8, those that are not wanted to 1e-4, of a mass that is not looked at: eigenvalues are off by the square, warm
 * and cold. */
POOL_TEST(pairs_that_are_near_alone_have_the_eigenvalues)
{
    struct random_stream stream = {68};
    enum { COUNT = 6 };
    for (int s = 0; s < nstructure; s++) {
        const struct structure *of = &structures[s];
        int n = of->n;
        rotid_matrix k, m;
        struct eigen_wide e;
        random_profile(*state, &stream, of, 0.01, &k);
        random_profile(*state, &stream, of, 1, &m);
        double *expected = numbers(*state, n), *exact = numbers(*state, (ptrdiff_t)n * n), lambda[COUNT],
               *phi = numbers(*state, COUNT * (ptrdiff_t)n), *image = numbers(*state, n);
        assert_status(eigen_wide_new(*state, &k, COUNT, &e), ROTID_OK);
        e.within = 1e-8;
        e.from = 1;
        e.to = COUNT - 1;
        e.vouched = 1;
        for (int step = 0; step < 2; step++) {
            for (int i = 0; i < n / 2 && step; i++)
                matrix_add(&k, i, i, 0.02);
            dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e-3, expected, exact);
            assert_status(eigen_wide_solve(&e, &k, &m, lambda, phi), ROTID_OK);
            for (int j = 0; j < COUNT; j++) {
                int wanted = j >= 1 && j < COUNT - 1;
                assert_close(lambda[j], expected[j], wanted ? 1e-12 : 1e-6, 0);
                double along = matrix_product(&m, phi + (ptrdiff_t)j * n, exact + (ptrdiff_t)j * n, image);
                if (wanted && expected[j + 1] - expected[j] > 1e-2 * expected[j] &&
                    expected[j] - expected[j - 1] > 1e-2 * expected[j])
                    assert_close(fabs(along), 1, 1e-10, 0);
            }
        }
    }
}

/* A mass that has lost its definiteness between two calls is seen though it is not factored where it has not changed. */
POOL_TEST(a_mass_that_changes_is_checked_again)
{
    struct random_stream stream = {67};
    const struct structure *of = &structures[3];
    int n = of->n;
    rotid_matrix k, m;
    struct eigen_wide e;
    double lambda[3], *phi = numbers(*state, 3 * (ptrdiff_t)n);
    random_profile(*state, &stream, of, 1, &k);
    random_profile(*state, &stream, of, 1, &m);
    assert_status(eigen_wide_new(*state, &k, 3, &e), ROTID_OK);
    for (int round = 0; round < 2; round++) {
        assert_status(eigen_wide_solve(&e, &k, &m, lambda, phi), ROTID_OK);
        double *unit = numbers(*state, n), *diagonal = &m.band[(ptrdiff_t)40 * (of->kd + 1)], kept = *diagonal;
        unit[40] = 1;
        *diagonal -= 1.01 / dense_solution(*state, n, 1, dense_of(*state, &m), unit)[40];
        assert_status(eigen_wide_solve(&e, &k, &m, lambda, phi), ROTID_ERROR_MASS);
        assert_status(eigen_wide_solve(&e, &k, &m, lambda, phi), ROTID_ERROR_MASS);
        *diagonal = kept;
    }
}

/* The block behind the basis is twice the pairs that are known, and no more, however often the search is extended. */
POOL_TEST(a_search_refuses_more_vectors_than_it_has_room_for)
{
    enum { N = 120, COLUMNS = 4, BLOCK = 6 };
    struct random_stream stream = {77};
    struct pencil pencil;
    struct factor f;
    struct lanczos l;
    rotid_matrix k, m;
    int all[N], status = ROTID_OK, extended = 0;
    double x[N * COLUMNS], tolerance[BLOCK] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};
    assert_status(matrix_new(*state, N, 20, 0, NULL, &k), ROTID_OK);
    assert_status(matrix_new(*state, N, 20, 0, NULL, &m), ROTID_OK);
    for (int i = 0; i < N; i++) {
        all[i] = i;
        matrix_add(&k, i, i, 1 + i % 40);
        matrix_add(&m, i, i, 1);
    }
    for (int i = 0; i < N * COLUMNS; i++)
        x[i] = random_normal(&stream);
    assert_status(pencil_new(*state, &k, &pencil), ROTID_OK);
    (void)pencil_take(&pencil, &k, &m);
    assert_status(factor_new(*state, FACTOR_CHOLESKY, &k, N, all, &f), ROTID_OK);
    assert_int_equal(factor_compute_pencil(&f, &pencil, -1), 0);
    assert_status(lanczos_new(*state, &pencil, &f, COLUMNS, BLOCK, &l), ROTID_OK);
    lanczos_begin(&l, x);
    for (; !status && extended < 10; extended++) {
        assert_status(lanczos_iterate(&l, 1, tolerance), ROTID_OK);
        int before = l.next;
        status = lanczos_extend(&l, COLUMNS);
        assert_true(l.next <= l.behind && l.next == before + (status ? 0 : COLUMNS));
    }
    assert_status(status, ROTID_ERROR_EIGEN);
    assert_int_equal(extended, 1 + (2 * BLOCK - COLUMNS) / COLUMNS);
}
