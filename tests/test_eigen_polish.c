/* Inverse iteration on near pairs, and the kernels of narrow bands it lives on. */
#include "dense.h"
#include "paper_rotor.h"

#include "linalg/linalg.h"
#include "model/model.h"
#include "support.h"

enum { count = 9 };

static void rotor_matrices(struct pool *pool, int springs, double part_e, double part_g, rotid_matrix *k, rotid_matrix *m)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 0);
    struct parameter chosen[2] = {paper_parameters[0], paper_parameters[1]};
    const double x[2] = {paper_start[0] * part_e, paper_start[1] * part_g};
    struct rotor_model client;
    int failed;
    if (!springs)
        rotor->nspring = 0;
    assert_status(model_open(pool, NULL, rotor, 2, chosen, 1, &client, &failed), ROTID_OK);
    const rotid_model *model = &client.equations;
    assert_status(matrix_new(pool, model->n, model->kd, model->nfar, model->far, k), ROTID_OK);
    assert_status(matrix_new(pool, model->n, model->kd, model->nfar, model->far, m), ROTID_OK);
    assert_int_equal(model->matrices(model->user, x, k, m), 0);
}

/* The block iteration alone is the second solver; steps as a fit takes them, and two rigid motions that share a shift. */
POOL_TEST(polished_pairs_are_those_of_the_block_iteration)
{
    static const double part[][2] = {{1, 1}, {1.2, 0.9}, {1.21, 0.95}, {1.2101, 0.9501}, {1.2101, 0.9501 + 1e-9}, {0.5, 2}};
    for (int springs = 0; springs <= 1; springs++) {
        struct eigen_band polished = {0}, plain = {0};
        for (size_t step = 0; step < sizeof part / sizeof *part; step++) {
            rotid_matrix k, m;
            double lambda[count], expected[count];
            rotor_matrices(*state, springs, part[step][0], part[step][1], &k, &m);
            double *phi = numbers(*state, (ptrdiff_t)count * k.n), *other = numbers(*state, (ptrdiff_t)count * k.n),
                   *work = numbers(*state, k.n);
            if (!step) {
                assert_status(eigen_band_new(*state, &k, count, &polished), ROTID_OK);
                assert_status(eigen_band_new(*state, &k, count, &plain), ROTID_OK);
                plain.failures = 1000;
            }
            assert_status(eigen_band_solve(&polished, &k, &m, lambda, phi), ROTID_OK);
            assert_status(eigen_band_solve(&plain, &k, &m, expected, other), ROTID_OK);
            assert_true(polished.failures == 0 && !polished.plain && plain.plain);
            for (int j = 0; j < count; j++) {
                assert_close(lambda[j], expected[j], 1e-10, 1e-10 * expected[2]);
                if (j >= 2)
                    assert_close(fabs(matrix_product(&m, phi + (ptrdiff_t)j * k.n, other + (ptrdiff_t)j * k.n, work)), 1, 0,
                                 1e-12);
            }
        }
    }
}

/* Pairs 1, 2 and 4 in place of 1, 2 and 3: every residual is small, and the count of eigenvalues tells. */
POOL_TEST(a_skipped_mode_is_noticed)
{
    rotid_matrix k, m;
    struct eigen_band e;
    double lambda[count + 1], missing[count];
    rotor_matrices(*state, 1, 1, 1, &k, &m);
    double *phi = numbers(*state, (ptrdiff_t)(count + 1) * k.n), *again = numbers(*state, (ptrdiff_t)count * k.n);
    assert_status(eigen_band_new(*state, &k, count + 1, &e), ROTID_OK);
    assert_status(eigen_band_solve(&e, &k, &m, lambda, phi), ROTID_OK);
    assert_status(eigen_band_new(*state, &k, count, &e), ROTID_OK);
    assert_status(eigen_band_solve(&e, &k, &m, missing, again), ROTID_OK);
    for (int j = 4; j < count; j++)
        memcpy(e.ritz + (ptrdiff_t)j * k.n, phi + (ptrdiff_t)(j + 1) * k.n, (size_t)k.n * sizeof *phi);
    assert_status(eigen_band_solve(&e, &k, &m, missing, again), ROTID_OK);
    for (int j = 0; j < count; j++)
        assert_close(missing[j], lambda[j], 1e-10, 1e-10 * lambda[2]);
}

/* Dependent vectors are refused, whatever their length. */
POOL_TEST(dependent_vectors_are_refused)
{
    rotid_matrix k, m;
    struct eigen_band e;
    struct random_stream stream = {7};
    rotor_matrices(*state, 1, 1, 1, &k, &m);
    assert_status(eigen_band_new(*state, &k, 3, &e), ROTID_OK);
    const double *x = random_numbers(*state, &stream, 3 * (ptrdiff_t)k.n);
    memcpy(e.image, x, 3 * (size_t)k.n * sizeof *x);
    assert_int_equal(eigen_ritz_pairs(&e, &k, &m), 0);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < k.n; i++)
            e.image[i + (ptrdiff_t)j * k.n] = pow(1e20, j) * (x[i] + (j == 2 ? 1e-9 * x[i + k.n] : j * x[i + k.n]));
    assert_int_equal(eigen_ritz_pairs(&e, &k, &m), 1);
    memset(e.image, 0, (size_t)k.n * sizeof *x);
    assert_int_equal(eigen_ritz_pairs(&e, &k, &m), 1);
}

/* ---- kernels: residuals, and that a lane does not feel the others */

static void check_solution(int n, int kd, const double *full, const double *b, const double *x)
{
    double worst = 0;
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++)
            sum += abs(i - j) <= kd ? full[i + (ptrdiff_t)j * n] * x[j] : 0;
        worst = fmax(worst, fabs(sum - b[i]));
    }
    assert_close(worst, 0, 0, 1e-10);
}

POOL_TEST(bands_of_any_width_are_solved_the_same_in_every_lane)
{
    static const int widths[] = {0, 1, 2, 3, 4, 5, 11, 12, 13, 30};
    enum { n = 31 };
    struct random_stream stream = {3};
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++)
        for (int indefinite = 0; indefinite < 2; indefinite++) {
            int kd = widths[w], ld = indefinite ? 3 * kd + 1 : kd + 1, pivot[n];
            rotid_matrix a;
            random_positive(*state, &stream, n, kd, 0, NULL, 1, &a);
            for (int j = 0; j < n && indefinite; j++) /* a zero on the diagonal asks for a pivot */
                a.band[(ptrdiff_t)j * (kd + 1)] = kd && j % 3 == 0 ? 0 : a.band[(ptrdiff_t)j * (kd + 1)] * (j % 2 ? 1 : -1);
            const double *full = dense_of(*state, &a);
            double *band = numbers(*state, (ptrdiff_t)n * ld), *b = random_numbers(*state, &stream, 8 * n),
                   *x = numbers(*state, 8 * n), first[n];
            for (int j = 0; j < n; j++)
                for (int i = 0; i < n; i++)
                    if (indefinite ? abs(i - j) <= kd : i >= j && i - j <= kd)
                        band[(indefinite ? 2 * kd : 0) + (i - j) + (ptrdiff_t)j * ld] = full[i + (ptrdiff_t)j * n];
            assert_int_equal(indefinite ? band_lu(n, kd, band, pivot) : band_cholesky(n, kd, band), 0);
            for (int lanes = 1; lanes <= BAND_LANES; lanes *= 2) {
                for (int i = 0; i < n; i++)
                    for (int c = 0; c < lanes; c++)
                        x[i * lanes + c] = b[i + c * n];
                if (indefinite)
                    band_lu_solve(n, kd, band, pivot, lanes, x);
                else
                    band_cholesky_solve(n, kd, band, lanes, x);
                for (int c = 0; c < lanes; c++) {
                    double column[n];
                    for (int i = 0; i < n; i++)
                        column[i] = x[i * lanes + c];
                    check_solution(n, kd, full, b + (ptrdiff_t)c * n, column);
                    if (c == 0 && lanes == 1)
                        memcpy(first, column, sizeof first);
                    else if (c == 0)
                        assert_memory_equal(first, column, sizeof first);
                }
            }
        }
}

POOL_TEST(what_is_singular_or_indefinite_is_told)
{
    static const int widths[] = {0, 3, 5, 20};
    enum { n = 31 };
    struct random_stream stream = {5};
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        int kd = widths[w], pivot[n];
        rotid_matrix a;
        random_positive(*state, &stream, n, kd, 0, NULL, 1, &a);
        double *lu = numbers(*state, (ptrdiff_t)n * (3 * kd + 1));
        a.band[17 * (ptrdiff_t)(kd + 1)] = -1e-3;
        assert_int_equal(band_cholesky(n, kd, a.band), 1);
        assert_int_equal(band_lu(n, kd, lu, pivot), 1);
    }
}
