/* Eigenpairs of banded pencils: residuals, orthonormality, dsygv as second solver, closed forms. Every test runs with the solver
 * of narrow bands and, on the same matrices with zeros stored beside them, with that of wide ones. */
#include "dense.h"
#include "either_band.h"
#include "paper_rotor.h"

#include <cblas.h>

#include "linalg/linalg.h"
#include "support.h"

/* ---- the matrices */

/* A string of n masses 1 between springs 1, its ends free or held, at degrees of freedom offset ... */
static void add_string(rotid_matrix *k, rotid_matrix *m, int offset, int n, int held)
{
    for (int i = 0; i < n; i++) {
        matrix_add(m, offset + i, offset + i, 1);
        if (i + 1 < n) {
            matrix_add(k, offset + i, offset + i, 1);
            matrix_add(k, offset + i + 1, offset + i + 1, 1);
            matrix_add(k, offset + i, offset + i + 1, -1);
        }
    }
    if (held) {
        matrix_add(k, offset, offset, 1);
        matrix_add(k, offset + n - 1, offset + n - 1, 1);
    }
}

/* its j-th eigenvalue, j from 0 */
static double string_eigenvalue(int n, int held, int j)
{
    double s = sin(3.14159265358979323846 * (held ? j + 1.0 : j) / (2.0 * (held ? n + 1 : n)));
    return 4 * s * s;
}

static const double ei = 2.1e11 * 4.9087385e-6, kgs = 0.89 * 8.1e10 * 7.8539816e-3;
static const double rhos = 7850 * 7.8539816e-3, rhoi = 7850 * 4.9087385e-6;

/* A steel beam of 0.1 m diameter; pinned: both deflections at its ends are left out, and 2 `elements` degrees of freedom stay. */
static void uniform_beam(struct pool *pool, int elements, double length, int pinned, rotid_matrix *k, rotid_matrix *m)
{
    double l = length / elements, ek[16], em[16];
    int n = pinned ? 2 * elements : 2 * elements + 2;
    rotid_element_stiffness(ei, kgs, l, ek);
    rotid_element_mass(rhos, rhoi, 12 * ei / (kgs * l * l), l, em);
    assert_status(matrix_new(pool, n, 3, 0, NULL, k), ROTID_OK);
    assert_status(matrix_new(pool, n, 3, 0, NULL, m), ROTID_OK);
    for (int e = 0; e < elements; e++)
        for (int j = 0; j < 4; j++)
            for (int i = j; i < 4; i++) {
                int row = 2 * e + i - pinned, column = 2 * e + j - pinned;
                if (pinned && (column < 0 || row == 2 * elements - 1 || column == 2 * elements - 1))
                    continue;
                row -= pinned && row == 2 * elements;
                column -= pinned && column == 2 * elements;
                matrix_add(k, row, column, ek[i + 4 * j]);
                matrix_add(m, row, column, em[i + 4 * j]);
            }
}

/* lambda of the pinned Timoshenko beam, j from 1: rhoS rhoI w^4 - (rhoS (EI q^2 + kGS) + rhoI kGS q^2) w^2 + EI kGS q^4 = 0 */
static double pinned_beam_eigenvalue(double length, int j)
{
    double q2 = pow(3.14159265358979323846 * j / length, 2), b = rhos * (ei * q2 + kgs) + rhoi * kgs * q2;
    return 2 * ei * kgs * q2 * q2 / (b + sqrt(b * b - 4 * rhos * rhoi * ei * kgs * q2 * q2));
}

static void rotor_matrices(struct pool *pool, enum bundle_model model, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct beam beam;
    int failed;
    assert_status(beam_build(pool, paper_rotor(model, 1), 2, paper_parameters, 1, &beam, &failed), ROTID_OK);
    assert_status(matrix_new(pool, beam.mesh.ndof, beam.mesh.kd, beam.mesh.nfar, beam.mesh.far, k), ROTID_OK);
    assert_status(matrix_new(pool, beam.mesh.ndof, beam.mesh.kd, beam.mesh.nfar, beam.mesh.far, m), ROTID_OK);
    beam_assemble(&beam, x, k, m);
}

/* ---- what pairs have to satisfy */

/* Largest |K phi - lambda M phi| / ((|K| + |lambda| |M|) |phi|), the norm of a matrix its largest element. */
static double pair_residual(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda,
                            const double *phi)
{
    int n = k->n;
    double *k_phi = numbers(pool, n), *m_phi = numbers(pool, n), k_norm = 0, m_norm = 0, worst = 0;
    for (int i = 0; i < n * (k->kd + 1); i++) {
        k_norm = fmax(k_norm, fabs(k->band[i]));
        m_norm = fmax(m_norm, fabs(m->band[i]));
    }
    for (int j = 0; j < count; j++) {
        matrix_multiply(k, 1, phi + (ptrdiff_t)j * n, k_phi);
        matrix_multiply(m, 1, phi + (ptrdiff_t)j * n, m_phi);
        cblas_daxpy(n, -lambda[j], m_phi, 1, k_phi, 1);
        double size = (k_norm + fabs(lambda[j]) * m_norm) * cblas_dnrm2(n, phi + (ptrdiff_t)j * n, 1);
        worst = fmax(worst, cblas_dnrm2(n, k_phi, 1) / size);
    }
    return worst;
}

static double orthonormality(struct pool *pool, const rotid_matrix *m, int count, const double *phi)
{
    int n = m->n;
    double *m_phi = numbers(pool, (ptrdiff_t)n * count), worst = 0;
    matrix_multiply(m, count, phi, m_phi);
    const double *square = dense_transposed_product(pool, count, n, count, phi, m_phi);
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++)
            worst = fmax(worst, fabs(square[i + j * count] - (i == j)));
    return worst;
}

static void check_pairs(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda,
                        const double *phi)
{
    assert_close(pair_residual(pool, k, m, count, lambda, phi), 0, 0, 1e-11);
    assert_close(orthonormality(pool, m, count, phi), 0, 0, 1e-10);
    for (int j = 1; j < count; j++)
        assert_true(lambda[j] >= lambda[j - 1]);
}

/* Solves cold and checks; returns lambda [count]. */
static double *solve_and_check(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count)
{
    struct either_band e;
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)k->n * count);
    assert_status(either_band_new(pool, k, count, &e), ROTID_OK);
    assert_status(either_band_solve(&e, k, m, lambda, phi), ROTID_OK);
    check_pairs(pool, k, m, count, lambda, phi);
    return lambda;
}

/* ---- banded */

POOL_TEST(random_pencils_agree_with_dsygv)
{
    struct random_stream stream = {21};
    const int far[6] = {0, 1, 4, 5, 8, 9};
    for (int n = 10; n <= 200; n += 19)
        for (int coupled = 0; coupled < 2 && !either_band_is_too_small(n); coupled++) {
            rotid_matrix k, m;
            random_positive(*state, &stream, n, 1 + n % 5, coupled ? 6 : 0, far, 1e-4, &k);
            random_positive(*state, &stream, n, 1 + n % 5, coupled ? 6 : 0, far, 1, &m);
            double *expected = numbers(*state, n), *vectors = numbers(*state, (ptrdiff_t)n * n);
            dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e-3, expected, vectors);
            const double *lambda = solve_and_check(*state, &k, &m, 5);
            for (int j = 0; j < 5; j++)
                assert_close(lambda[j], expected[j], 1e-9, 1e-14);
        }
}

POOL_TEST(the_papers_rotor_agrees_with_dsygv)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        rotid_matrix k, m;
        rotor_matrices(*state, (enum bundle_model)model, paper_start, &k, &m);
        assert_int_equal(k.n, 352);
        double *expected = numbers(*state, 352);
        dense_pairs(*state, 352, dense_of(*state, &k), dense_of(*state, &m), -1e5, expected, numbers(*state, 352 * 352));
        const double *lambda = solve_and_check(*state, &k, &m, 12);
        for (int j = 0; j < 12; j++)
            assert_close(lambda[j], expected[j], 1e-9, 1e-9 * expected[2]);
    }
}

POOL_TEST(free_beams_have_their_rigid_motions_at_zero)
{
    struct either_band e;
    rotid_matrix k, m;
    uniform_beam(*state, 40, 2, 0, &k, &m);
    int n = k.n;
    double lambda[8], *phi = numbers(*state, 8 * (ptrdiff_t)n), *rigid = numbers(*state, 2 * (ptrdiff_t)n);
    assert_status(either_band_new(*state, &k, 8, &e), ROTID_OK);
    assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_OK);
    check_pairs(*state, &k, &m, 8, lambda, phi);
    assert_close(lambda[0], 0, 0, 1e-9 * lambda[2]);
    assert_close(lambda[1], 0, 0, 1e-9 * lambda[2]);
    for (int i = 0; i < n; i += 2) { /* v = 1; v = z - 1, theta = -1 */
        rigid[i] = 1;
        rigid[n + i] = 2.0 * i / (n - 2) - 1;
        rigid[n + i + 1] = -1;
    }
    for (int r = 0; r < 2; r++) { /* all of the rigid motion lies in the first two pairs */
        const double *motion = rigid + (ptrdiff_t)r * n;
        double work[512], all = matrix_product(&m, motion, motion, work), part = 0;
        for (int j = 0; j < 2; j++)
            part += pow(matrix_product(&m, phi + (ptrdiff_t)j * n, motion, work), 2);
        assert_close(part / all, 1, 0, 1e-10);
    }
    double *expected = numbers(*state, n);
    dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e5, expected, numbers(*state, (ptrdiff_t)n * n));
    for (int j = 2; j < 8; j++)
        assert_close(lambda[j], expected[j], 1e-9, 0);
}

POOL_TEST(a_short_request_is_served_when_all_of_it_is_rigid)
{
    for (int count = 1; count <= 3; count++) {
        rotid_matrix k, m;
        uniform_beam(*state, 40, 2, 0, &k, &m);
        const double *lambda = solve_and_check(*state, &k, &m, count);
        assert_close(lambda[0], 0, 0, 1e-9 * 1e6); /* lambda of the first bending mode: 1.5e6 */
    }
}

/* Rotors in two planes, or with several bodies, have four rigid motions and more. */
POOL_TEST(any_number_of_rigid_motions_is_served)
{
    for (int bodies = 2; bodies <= 7; bodies++) {
        enum { each = 30 };
        rotid_matrix k, m;
        assert_status(matrix_new(*state, bodies * each, 1, 0, NULL, &k), ROTID_OK);
        assert_status(matrix_new(*state, bodies * each, 1, 0, NULL, &m), ROTID_OK);
        for (int b = 0; b < bodies; b++)
            add_string(&k, &m, b * each, each, 0);
        const double *lambda = solve_and_check(*state, &k, &m, 2 * bodies);
        for (int j = 0; j < 2 * bodies; j++)
            assert_close(lambda[j], string_eigenvalue(each, 0, j / bodies), 1e-10, 1e-10 * string_eigenvalue(each, 0, 1));
    }
}

POOL_TEST(no_partner_of_a_repeated_eigenvalue_is_missed)
{
    enum { each = 60 };
    rotid_matrix k, m;
    for (int chains = 2; chains <= 4; chains++)
        for (int count = 1; count <= 14; count++) { /* also a request that ends within a group */
            assert_status(matrix_new(*state, chains * each, 1, 0, NULL, &k), ROTID_OK);
            assert_status(matrix_new(*state, chains * each, 1, 0, NULL, &m), ROTID_OK);
            for (int c = 0; c < chains; c++)
                add_string(&k, &m, c * each, each, 1);
            const double *lambda = solve_and_check(*state, &k, &m, count);
            for (int j = 0; j < count; j++)
                assert_close(lambda[j], string_eigenvalue(each, 1, j / chains), 1e-10, 0);
        }
}

POOL_TEST(a_warm_start_gives_what_a_cold_one_gives)
{
    const double factors[][2] = {{1, 1}, {5, 5}, {0.2, 1}, {1, 5}, {5, 0.2}, {1, 1}, {1, 1}, {1 + 1e-9, 1}};
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct either_band warm;
        rotid_matrix k, m;
        double lambda[8], *phi = NULL;
        for (int step = 0; step < 8; step++) {
            const double x[2] = {paper_start[0] * factors[step][0], paper_start[1] * factors[step][1]};
            rotor_matrices(*state, (enum bundle_model)model, x, &k, &m);
            if (!step) {
                assert_status(either_band_new(*state, &k, 8, &warm), ROTID_OK);
                phi = numbers(*state, 8 * (ptrdiff_t)k.n);
            }
            assert_status(either_band_solve(&warm, &k, &m, lambda, phi), ROTID_OK);
            check_pairs(*state, &k, &m, 8, lambda, phi);
            const double *cold = solve_and_check(*state, &k, &m, 8);
            for (int j = 0; j < 8; j++)
                assert_close(lambda[j], cold[j], 1e-9, 1e-11 * cold[2]); /* suspension modes: eps times the highest */
        }
    }
}

/* The lowest modes move from one of two uncoupled chains to the other, of which the old vectors contain nothing. */
POOL_TEST(modes_that_a_warm_start_cannot_see_are_found)
{
    enum { each = 60, n = 2 * each, count = 4 };
    const double stiffness[4] = {100, 1e-4, 1e4, 0.5}; /* of the second chain */
    struct either_band e;
    rotid_matrix k, m;
    double lambda[count], *phi = numbers(*state, n * count);
    for (int step = 0; step < 4; step++) {
        assert_status(matrix_new(*state, n, 1, 0, NULL, &k), ROTID_OK);
        assert_status(matrix_new(*state, n, 1, 0, NULL, &m), ROTID_OK);
        add_string(&k, &m, 0, each, 1);
        add_string(&k, &m, each, each, 1);
        for (int i = each; i < n; i++)
            for (int d = 0; d < 2; d++)
                k.band[d + 2 * i] *= stiffness[step];
        if (!step)
            assert_status(either_band_new(*state, &k, count, &e), ROTID_OK);
        assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_OK);
        check_pairs(*state, &k, &m, count, lambda, phi);
        for (int j = 0, a = 0, b = 0; j < count; j++) {
            double first = string_eigenvalue(each, 1, a), second = stiffness[step] * string_eigenvalue(each, 1, b);
            assert_close(lambda[j], fmin(first, second), 1e-9, 0);
            a += first <= second;
            b += first > second;
        }
    }
}

/* Whatever the unit of mass: a part of grams counted in tonnes, or the one of a micromechanical sensor. */
POOL_TEST(light_structures_have_the_same_pairs)
{
    enum { n = 60, count = 4 };
    for (int power = -300; power <= 300; power += 20)
        for (int held = 0; held < 2; held++) {
            struct either_band e;
            rotid_matrix k, m;
            double lambda[count], *phi = numbers(*state, n * count);
            assert_status(matrix_new(*state, n, 1, 0, NULL, &k), ROTID_OK);
            assert_status(matrix_new(*state, n, 1, 0, NULL, &m), ROTID_OK);
            add_string(&k, &m, 0, n, held);
            for (int i = 0; i < 2 * n; i++) {
                k.band[i] *= pow(10, power);
                m.band[i] *= pow(10, power);
            }
            assert_status(either_band_new(*state, &k, count, &e), ROTID_OK);
            assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_OK);
            for (int j = 0; j < count; j++)
                assert_close(lambda[j], string_eigenvalue(n, held, j), 1e-10, held ? 0 : 1e-13);
        }
}

POOL_TEST(one_pair_and_nearly_all_pairs_are_served)
{
    const int counts[][2] = {{1, 1}, {2, 1}, {2, 2}, {3, 2}, {17, 1}, {17, 15}, {17, 16}, {17, 17}, {60, 57}, {60, 60}};
    struct random_stream stream = {22};
    for (int c = 0; c < 10; c++) {
        int n = counts[c][0], count = counts[c][1];
        rotid_matrix k, m;
        if (either_band_is_too_small(n))
            continue;
        random_positive(*state, &stream, n, n > 3 ? 3 : n - 1, 0, NULL, 1e-2, &k);
        random_positive(*state, &stream, n, n > 3 ? 3 : n - 1, 0, NULL, 1, &m);
        double *expected = numbers(*state, n);
        dense_pairs(*state, n, dense_of(*state, &k), dense_of(*state, &m), -1e-3, expected, numbers(*state, (ptrdiff_t)n * n));
        const double *lambda = solve_and_check(*state, &k, &m, count);
        for (int j = 0; j < count; j++)
            assert_close(lambda[j], expected[j], 1e-10, 1e-14);
    }
}

POOL_TEST(twenty_thousand_degrees_of_freedom_agree_with_closed_forms)
{
    enum { n = 20000 };
    rotid_matrix k, m;
    assert_status(matrix_new(*state, n, 1, 0, NULL, &k), ROTID_OK);
    assert_status(matrix_new(*state, n, 1, 0, NULL, &m), ROTID_OK);
    add_string(&k, &m, 0, n, 1);
    const double *lambda = solve_and_check(*state, &k, &m, 6);
    for (int j = 0; j < 6; j++) /* eps |K| n^2 is 1e-7 of the lowest */
        assert_close(lambda[j], string_eigenvalue(n, 1, j), 1e-7, 0);
    uniform_beam(*state, n / 2, 20, 1, &k, &m);
    assert_int_equal(k.n, n);
    lambda = solve_and_check(*state, &k, &m, 6);
    for (int j = 0; j < 6; j++)
        assert_close(lambda[j], pinned_beam_eigenvalue(20, j + 1), 1e-5, 0);
}

int main(int argc, char **argv)
{
    int failed = test_main(argc, argv); /* narrow bands */
    either_band_wide = 1;
    return failed + test_main(argc, argv);
}
