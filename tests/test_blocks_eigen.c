/* Building blocks for hosts: eigenpairs, judged by closed forms, by residuals and orthogonality, and by each other. */
#include "dense.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

static double *lambda_of(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, double **phi)
{
    double *lambda = numbers(pool, count), *vectors = numbers(pool, (ptrdiff_t)k->n * count);
    assert_status(rotid_eigenpairs(k, m, count, NULL, NULL, lambda, vectors), ROTID_OK);
    if (phi)
        *phi = vectors;
    return lambda;
}

/* |K phi - lambda M phi| over (|K| + lambda |M|) |phi|, phi' M phi = 1 and orthogonality, ascending. */
static void assert_pairs(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda,
                         const double *phi, double orthogonal)
{
    int n = k->n;
    const double *full_k = dense_of(pool, k), *full_m = dense_of(pool, m);
    const double *k_phi = dense_product(pool, n, n, count, full_k, phi), *m_phi = dense_product(pool, n, n, count, full_m, phi);
    const double *gram = dense_transposed_product(pool, count, n, count, phi, m_phi);
    double norm_k = dense_norm(n, n, full_k), norm_m = dense_norm(n, n, full_m);
    for (int j = 0; j < count; j++) {
        double *residual = numbers(pool, n);
        for (int i = 0; i < n; i++)
            residual[i] = k_phi[i + j * n] - lambda[j] * m_phi[i + j * n];
        assert_true(dense_norm(n, 1, residual) <
                    1e-13 * n * (norm_k + fabs(lambda[j]) * norm_m) * dense_norm(n, 1, phi + (ptrdiff_t)j * n));
        assert_true(j == 0 || lambda[j] >= lambda[j - 1]);
        for (int i = 0; i < count; i++)
            assert_close(gram[i + j * count], i == j, 0, orthogonal);
    }
}

/* n masses m between n + 1 springs k: lambda_j = 4 k/m sin^2(j pi/(2 (n + 1))) */
static rotid_matrix new_matrix(struct pool *pool, int n, int kd)
{
    return (rotid_matrix){.n = n, .kd = kd, .band = numbers(pool, (ptrdiff_t)n * (kd + 1))};
}

static void chain(struct pool *pool, int n, int kd, int fixed, rotid_matrix *k, rotid_matrix *m)
{
    *k = new_matrix(pool, n, kd);
    *m = new_matrix(pool, n, kd);
    const double spring[4] = {3e4, -3e4, -3e4, 3e4};
    for (int i = fixed ? -1 : 0; i < n - !fixed; i++)
        assert_status(rotid_matrix_add_element(k, 2, (int[]){i, i + 1 < n ? i + 1 : -1}, spring, NULL), ROTID_OK);
    for (int i = 0; i < n; i++)
        assert_status(rotid_matrix_add(m, i, i, 2.5, NULL), ROTID_OK);
}

POOL_TEST(chains_of_masses_have_their_eigenvalues)
{
    static const int sizes[] = {1, 2, 3, 9, 40, 150};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int wide = 0; wide < 3; wide++)
            for (int many = 0; many < 3; many++) {
                int n = sizes[s], kd = wide == 0 ? 1 : wide == 1 ? n / 2 : n - 1, count = many == 0 ? 1 : many == 1 ? n / 3 : n;
                if ((kd < 1 && n > 1) || kd >= n + (n == 1) || count < 1)
                    continue;
                rotid_matrix k, m;
                double *phi;
                chain(*state, n, n == 1 ? 0 : kd, 1, &k, &m);
                const double *lambda = lambda_of(*state, &k, &m, count, &phi);
                for (int j = 0; j < count; j++)
                    assert_close(lambda[j], 4 * 3e4 / 2.5 * pow(sin((j + 1) * pi / (2 * (n + 1))), 2), 1e-11, 0);
                assert_pairs(*state, &k, &m, count, lambda, phi, 1e-11);
            }
}

/* Euler's beam as the limit of a slender Timoshenko one: beta L of clamped-free and free-free ends. */
POOL_TEST(beams_have_their_beta_l)
{
    static const double clamped[4] = {1.875104068711961, 4.694091132974174, 7.854757438237613, 10.995540734875467};
    static const double both_free[4] = {4.730040744862704, 7.853204624095838, 10.995607838001671, 14.137165491257464};
    for (int is_free = 0; is_free < 2; is_free++) {
        enum { elements = 60 };
        int n = 2 * (elements + 1), first = is_free ? 2 : 0;
        double l = 1.0 / elements, ke[16], me[16], ei = 100, kgs = 1e9, rhos = 7;
        rotid_matrix k = new_matrix(*state, n, 3), m = new_matrix(*state, n, 3);
        rotid_element_stiffness(ei, kgs, l, ke);
        rotid_element_mass(rhos, 1e-12, 12 * ei / (kgs * l * l), l, me);
        for (int e = 0; e < elements; e++) {
            int hold = e == 0 && !is_free, dof[4] = {hold ? -1 : 2 * e, hold ? -1 : 2 * e + 1, 2 * e + 2, 2 * e + 3};
            assert_status(rotid_matrix_add_element(&k, 4, dof, ke, NULL), ROTID_OK);
            assert_status(rotid_matrix_add_element(&m, 4, dof, me, NULL), ROTID_OK);
        }
        for (int d = 0; d < 2 && !is_free; d++) { /* the held ones stand alone, far above all others */
            assert_status(rotid_matrix_add(&k, d, d, 1e12, NULL), ROTID_OK);
            assert_status(rotid_matrix_add(&m, d, d, 1, NULL), ROTID_OK);
        }
        double *phi;
        const double *lambda = lambda_of(*state, &k, &m, first + 4, &phi);
        for (int j = 0; j < 4; j++) {
            double beta = is_free ? both_free[j] : clamped[j];
            assert_close(lambda[first + j], pow(beta, 4) * ei / rhos, 2e-5, 0); /* shear takes 1e-7 (beta)^2, the mesh 1e-7 */
        }
        for (int j = 0; j < first; j++) /* rigid: zero beside the highest eigenvalue */
            assert_close(lambda[j], 0, 0, 1e-6 * lambda[first]);
        assert_pairs(*state, &k, &m, first + 4, lambda, phi, 1e-9);
    }
}

/* A free beam of as many elements as rounding bears: it leaves 1e-4 of the vectors by the shift, and lambda_3 has 3e-4. */
POOL_TEST(a_free_beam_of_many_elements_has_its_pairs)
{
    for (int count = 1; count <= 5; count += 2) {
        enum { elements = 1499 };
        int n = 2 * (elements + 1);
        rotid_matrix k = new_matrix(*state, n, 3), m = new_matrix(*state, n, 3);
        double ke[16], me[16];
        rotid_element_stiffness(1, 1e12, 1, ke);
        rotid_element_mass(1, 0, 0, 1, me);
        for (int e = 0; e < elements; e++) {
            int dof[4] = {2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3};
            assert_status(rotid_matrix_add_element(&k, 4, dof, ke, NULL), ROTID_OK);
            assert_status(rotid_matrix_add_element(&m, 4, dof, me, NULL), ROTID_OK);
        }
        const double *lambda = lambda_of(*state, &k, &m, count, NULL);
        for (int j = 0; j < count; j++) {
            double beta = j < 2 ? 0 : (j - 0.5) * pi + (j == 2 ? 0.0176517 : -0.0007770), expected = pow(beta / elements, 4);
            assert_close(lambda[j], expected, j == 2 ? 5e-3 : 1e-3, 1e-12);
        }
    }
}

/* Free in all directions, unconnected, or nothing but masses: as many zeros as there are motions without strain. */
POOL_TEST(rigid_modes_are_pairs_like_others)
{
    for (int dense = 0; dense < 2; dense++)
        for (int bodies = 1; bodies <= 15; bodies += 7)
            for (int count = 1; count <= bodies + 3; count++) { /* also fewer than there are zeros */
                int each = 5, n = bodies * each;
                rotid_matrix k = new_matrix(*state, n, dense ? n - 1 : 1), m = new_matrix(*state, n, dense ? n - 1 : 1);
                const double spring[4] = {100, -100, -100, 100};
                for (int i = 0; i < n; i++) {
                    assert_status(rotid_matrix_add(&m, i, i, 2, NULL), ROTID_OK);
                    if (i % each)
                        assert_status(rotid_matrix_add_element(&k, 2, (int[]){i - 1, i}, spring, NULL), ROTID_OK);
                }
                if (count > n)
                    break;
                double *phi;
                const double *lambda = lambda_of(*state, &k, &m, count, &phi);
                for (int j = 0; j < count; j++) /* chains of five: 4 k/m sin^2(pi/10) */
                    assert_close(lambda[j], j < bodies ? 0 : 200 * pow(sin(pi / 10 * (1 + (j - bodies) / bodies)), 2), 1e-10,
                                 1e-9);
                assert_pairs(*state, &k, &m, count, lambda, phi, 1e-9);
            }
    for (int n = 1; n < 30; n += 14) {
        rotid_matrix k = new_matrix(*state, n, 0), m = new_matrix(*state, n, 0);
        for (int i = 0; i < n; i++)
            m.band[i] = 1 + i;
        double *phi;
        const double *lambda = lambda_of(*state, &k, &m, 1, &phi);
        double square = 0;
        for (int i = 0; i < n; i++)
            square += phi[i] * m.band[i] * phi[i];
        assert_close(lambda[0], 0, 0, 1e-20);
        assert_close(square, 1, 1e-12, 0);
    }
}

POOL_TEST(repeated_eigenvalues_come_as_often_as_they_are)
{
    enum { n = 40 };
    rotid_matrix k = new_matrix(*state, 2 * n, 2), m = new_matrix(*state, 2 * n, 2);
    const double spring[4] = {3e4, -3e4, -3e4, 3e4}; /* two planes of one shaft: equal chains on every other degree of freedom */
    for (int i = 0; i < 2 * n; i++) {
        assert_status(rotid_matrix_add(&m, i, i, 2.5, NULL), ROTID_OK);
        assert_status(rotid_matrix_add_element(&k, 2, (int[]){i - 2 < 0 ? -1 : i - 2, i}, spring, NULL), ROTID_OK);
    }
    for (int i = 2 * n - 2; i < 2 * n; i++)
        assert_status(rotid_matrix_add(&k, i, i, 3e4, NULL), ROTID_OK);
    for (int count = 1; count < 9; count++) {
        double *phi;
        const double *lambda = lambda_of(*state, &k, &m, count, &phi);
        for (int j = 0; j < count; j++)
            assert_close(lambda[j], 4 * 3e4 / 2.5 * pow(sin((1 + j / 2) * pi / (2 * (n + 1))), 2), 1e-11, 0);
        assert_pairs(*state, &k, &m, count, lambda, phi, 1e-10);
    }
}

/* The same random pencil as a band with a block, in a wide band, dense, and by LAPACK's own driver. */
/* A chain held at one end, by leaving the mass there out and by a spring that is stiff beyond measure. */
POOL_TEST(a_support_by_a_penalty_leaves_the_others_their_digits)
{
    for (int n = 3; n <= 40; n += n < 8 ? 1 : 8)
        for (int power = 17; power <= 30; power++)
            for (int all = 0; all < 2; all++) {
                int count = all ? n : n / 2;
                rotid_matrix k, m;
                chain(*state, n, 1, 0, &k, &m);
                assert_status(rotid_matrix_add(&k, 0, 0, pow(10, power), NULL), ROTID_OK);
                const double *lambda = lambda_of(*state, &k, &m, count, NULL);
                for (int j = 0; j < count && j < n - 1; j++)
                    assert_close(lambda[j], 4 * 3e4 / 2.5 * pow(sin((2 * j + 1) * pi / (2 * (2 * n - 1))), 2), 1e-10, 0);
            }
}

POOL_TEST(storage_does_not_matter)
{
    static const int far[3] = {1, 17, 38};
    struct random_stream stream = {1};
    for (int trial = 0; trial < 6; trial++) {
        enum { n = 40 };
        rotid_matrix k, m;
        random_positive(*state, &stream, n, 3, 3, far, 0.1, &k);
        random_positive(*state, &stream, n, 3, 3, far, 1, &m);
        const double *full_k = dense_of(*state, &k), *full_m = dense_of(*state, &m);
        double *expected = numbers(*state, n), *vectors = numbers(*state, n * n);
        dense_pairs(*state, n, full_k, full_m, 0, expected, vectors);
        for (int storage = 0; storage < 3; storage++)
            for (int c = 0; c < 4; c++) {
                int count = (int[]){1, 6, 20, n}[c];
                rotid_matrix stored_k = k, stored_m = m;
                if (storage) {
                    stored_k = new_matrix(*state, n, storage == 1 ? 37 : n - 1);
                    stored_m = new_matrix(*state, n, storage == 1 ? 37 : n - 1);
                    assert_status(rotid_matrix_set_dense(&stored_k, full_k, n, NULL), ROTID_OK);
                    assert_status(rotid_matrix_set_dense(&stored_m, full_m, n, NULL), ROTID_OK);
                }
                double *phi;
                const double *lambda = lambda_of(*state, &stored_k, &stored_m, count, &phi);
                for (int j = 0; j < count; j++)
                    assert_close(lambda[j], expected[j], 1e-10, 0);
                assert_pairs(*state, &stored_k, &stored_m, count, lambda, phi, 1e-10);
            }
    }
}

POOL_TEST(pencils_that_no_structure_has_are_named)
{
    struct random_stream stream = {2};
    for (int dense = 0; dense < 2; dense++)
        for (int count = 1; count <= 40; count += 13) {
            int n = 40, kd = dense ? n - 1 : 3;
            rotid_matrix k, m;
            double *lambda = numbers(*state, n), *phi = numbers(*state, n * n), *unit = numbers(*state, n);
            random_positive(*state, &stream, n, kd, 0, NULL, 1, &k);
            random_positive(*state, &stream, n, kd, 0, NULL, 1, &m);
            unit[20] = 1;
            double *diagonal = &k.band[20 * (kd + 1)], kept = *diagonal;
            *diagonal -= 1.5 / dense_solution(*state, n, 1, dense_of(*state, &k), unit)[20];
            assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_ERROR_STIFFNESS);
            *diagonal = kept;
            diagonal = &m.band[20 * (kd + 1)];
            kept = *diagonal;
            *diagonal -= 1.5 / dense_solution(*state, n, 1, dense_of(*state, &m), unit)[20];
            assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_ERROR_MASS);
            *diagonal = NAN;
            assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_ERROR_FINITE);
            *diagonal = kept;
            k.band[7] = -INFINITY;
            assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_ERROR_FINITE);
        }
}

POOL_TEST(arguments_out_of_range_are_refused)
{
    struct random_stream stream = {3};
    rotid_matrix k, m, other;
    double lambda[10], phi[100];
    random_positive(*state, &stream, 10, 3, 0, NULL, 1, &k);
    random_positive(*state, &stream, 10, 3, 0, NULL, 1, &m);
    random_positive(*state, &stream, 10, 4, 0, NULL, 1, &other);
    assert_status(rotid_eigenpairs(NULL, &m, 1, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, NULL, 1, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &other, 1, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &m, 0, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &m, -1, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &m, 11, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &m, 1, NULL, NULL, NULL, phi), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_eigenpairs(&k, &m, 1, NULL, NULL, lambda, NULL), ROTID_ERROR_ARGUMENT);
    k.kd = 10;
    assert_status(rotid_eigenpairs(&k, &k, 1, NULL, NULL, lambda, phi), ROTID_ERROR_ARGUMENT);
}

POOL_TEST(memory_that_runs_out_is_an_error_and_none_is_kept)
{
    struct random_stream stream = {4};
    for (int dense = 0; dense < 2; dense++) {
        enum { n = 30 };
        rotid_matrix k, m;
        double *lambda = numbers(*state, n), *phi = numbers(*state, n * n);
        random_positive(*state, &stream, n, dense ? n - 1 : 2, 0, NULL, 1, &k);
        random_positive(*state, &stream, n, dense ? n - 1 : 2, 0, NULL, 1, &m);
        for (long fail = 1;; fail++) {
            struct failing_allocator failing;
            failing_allocator_open(&failing, fail);
            rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
            int status = rotid_eigenpairs(&k, &m, 3, &environment, NULL, lambda, phi);
            assert_int_equal(failing.in_use, 0);
            if (status == ROTID_OK) {
                assert_true(fail > 8);
                break;
            }
            assert_status(status, ROTID_ERROR_MEMORY);
        }
    }
}
