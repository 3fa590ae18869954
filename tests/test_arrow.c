/* Factors of K - sigma M for four shifts at once, beside dense solutions; and what a beam's modes are worth on a refined mesh. */
#include "dense.h"
#include "paper_rotor.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "model/model.h"
#include "support.h"

#define N 37

static void rows_of(int n, int nfar, const int *far, int *row)
{
    for (int i = 0, f = 0, inner = 0; i < n; i++)
        row[i] = f < nfar && far[f] == i ? n - nfar + f++ : inner++;
}

/* Bands of 1 to 6 with no, four, six, nine full rows, and the last two, which keep their places; shifts below, between and above
 * eigenvalues. */
POOL_TEST(solutions_and_counts_are_those_of_dense_matrices)
{
    struct random_stream stream = {91};
    const int spread[9] = {0, 1, 7, 11, 12, 20, 24, 25, 36}, ends[2] = {N - 2, N - 1}, nfars[5] = {0, 4, 6, 9, 2};
    for (int trial = 0; trial < 30; trial++) {
        const int *far = trial < 24 ? spread : ends;
        int kd = 1 + trial % 6, nfar = nfars[trial / 6], row[N], negative[ARROW_SHIFTS], judged = 0;
        rotid_matrix k, m;
        struct arrow a;
        random_positive(*state, &stream, N, kd, nfar, far, 1, &k);
        random_positive(*state, &stream, N, kd, nfar, far, 1, &m);
        rows_of(N, nfar, far, row);
        assert_status(arrow_new(*state, N - nfar, kd, nfar, &a), ROTID_OK);
        arrow_take(&a, &a.k, &k, row);
        arrow_take(&a, &a.m, &m, row);
        double *lambda = numbers(*state, N), *phi = numbers(*state, N * N),
               *b = random_numbers(*state, &stream, N * ARROW_SHIFTS), *x = numbers(*state, N * ARROW_SHIFTS);
        const double *dense_k = dense_of(*state, &k), *dense_m = dense_of(*state, &m);
        dense_pairs(*state, N, dense_k, dense_m, -0.1, lambda, phi);
        const int below[ARROW_SHIFTS] = {0, 1, 9, N};
        const double sigma[ARROW_SHIFTS] = {-1, (lambda[0] + lambda[1]) / 2, (lambda[8] + lambda[9]) / 2, 2 * lambda[N - 1]};
        for (int s = 0; s < ARROW_SHIFTS; s++)
            for (int i = 0; i < N; i++)
                x[row[i] * ARROW_SHIFTS + s] = b[i + s * N];
        arrow_factor(&a, sigma, negative);
        arrow_solve(&a, x);
        for (int s = 0; s < ARROW_SHIFTS; s++) {
            double *shifted = numbers(*state, N * N);
            if (negative[s] < 0)
                continue;
            judged++;
            assert_int_equal(negative[s], below[s]);
            assert_int_equal(arrow_count(&a, sigma[s]), below[s]);
            for (int i = 0; i < N * N; i++)
                shifted[i] = dense_k[i] - sigma[s] * dense_m[i];
            const double *expected = dense_solution(*state, N, 1, shifted, b + s * N);
            for (int i = 0; i < N; i++)
                assert_close(x[row[i] * ARROW_SHIFTS + s], expected[i], 1e-8, 1e-8);
        }
        assert_true(judged >= 3);
    }
}

/* [0 1; 1 0] has no pivot to begin with, and [1 1; 1 1 + 1e-9] loses nine digits: told of that shift, and of no other. */
POOL_TEST(a_lost_pivot_is_told_for_its_shift_alone)
{
    struct arrow a;
    int negative[ARROW_SHIFTS];
    const double sigma[ARROW_SHIFTS] = {0, -1, 1, -2};
    assert_status(arrow_new(*state, 3, 1, 0, &a), ROTID_OK);
    arrow_add(&a, &a.k, 1, 0, 1);
    arrow_add(&a, &a.k, 1, 1, 1e-9);
    arrow_add(&a, &a.k, 2, 2, 1);
    arrow_add(&a, &a.m, 0, 0, 1);
    arrow_add(&a, &a.m, 1, 1, 1);
    arrow_factor(&a, sigma, negative);
    assert_int_equal(negative[0], -1);
    assert_int_equal(negative[1], -1);
    assert_int_equal(negative[2], -1); /* [-1 1; 1 -1 + 1e-9] */
    assert_int_equal(negative[3], 0);
}

/* Modes of the coarse mesh at the nodes of the refined one: rigid motions as they are, and modes but for the error of the mesh.
 */
POOL_TEST(modes_of_a_refined_mesh_are_near)
{
    for (int bundle = BUNDLE_RODS; bundle <= BUNDLE_TUBE; bundle++) {
        struct rotor_model coarse, fine;
        struct prediction p, q;
        int failed, count = 8;
        const struct rotor *rotor = paper_rotor((enum bundle_model)bundle, 1);
        assert_status(model_open(*state, NULL, rotor, 2, paper_parameters, 1, &coarse, &failed), ROTID_OK);
        assert_status(model_open(*state, NULL, rotor, 2, paper_parameters, 2, &fine, &failed), ROTID_OK);
        assert_status(prediction_new(*state, &coarse.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
        assert_status(prediction_new(*state, &fine.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &q), ROTID_OK);
        assert_status(prediction_compute(&p, paper_start), ROTID_OK);
        assert_status(prediction_compute(&q, paper_start), ROTID_OK);
        assert_status(model_begin_with(*state, &fine, &coarse, count, p.phi), ROTID_OK);
        assert_int_equal(fine.equations.nmodes, count);
        double *m_phi = numbers(*state, fine.equations.n), *straight = numbers(*state, coarse.equations.n);
        for (int j = 0; j < count; j++) {
            const double *near = fine.equations.modes + (ptrdiff_t)j * q.size, *mode = q.phi + (ptrdiff_t)j * q.size;
            double length = matrix_product(&q.m, near, near, m_phi), along = matrix_product(&q.m, mode, near, m_phi);
            double sine = sqrt(fmax(0, 1 - along * along / length));
            assert_close(sine, 0, 0, 2e-3);
        }
        for (int i = 0; i < coarse.naxis; i++) { /* v = 3 - 2 z, theta = 2 */
            straight[2 * i] = 3 - 2 * coarse.z[i];
            straight[2 * i + 1] = 2;
        }
        assert_status(model_begin_with(*state, &fine, &coarse, 1, straight), ROTID_OK);
        for (int i = 0; i < fine.naxis; i++) {
            assert_close(fine.equations.modes[2 * i], 3 - 2 * fine.z[i], 1e-12, 1e-12);
            assert_close(fine.equations.modes[2 * i + 1], 2, 1e-12, 0);
        }
    }
}
