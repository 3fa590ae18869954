/* Correlation of shapes, and which mode of the model a measured mode is. */
#include "dense.h"
#include "paper_rotor.h"

#include "modal/modal.h"
#include "model/model.h"
#include "support.h"

/* ---- correlation */

POOL_TEST(mac_is_the_squared_cosine)
{
    const double a[3] = {1, 2, -2}, b[3] = {3, 0, 4}, zero[3] = {0, 0, 0}, across[3] = {2, 0, 1};
    assert_close(rotid_mac(3, a, b), 25.0 / (9 * 25), 1e-15, 0);
    assert_close(rotid_mac(3, b, a), 25.0 / (9 * 25), 1e-15, 0);
    assert_close(rotid_mac(3, a, a), 1, 1e-15, 0);
    assert_close(rotid_mac(3, a, across), 0, 0, 0);
    assert_close(rotid_mac(3, a, zero), 0, 0, 0);
    assert_close(rotid_mac(3, zero, zero), 0, 0, 0);
    assert_close(rotid_mac(1, a, b), 1, 1e-15, 0); /* one component is always parallel */
    assert_close(rotid_mac(0, a, b), 0, 0, 0);
}

POOL_TEST(mac_does_not_see_scale_sign_or_what_was_not_measured)
{
    enum { n = 30 };
    struct random_stream stream = {71};
    for (int repeat = 0; repeat < 50; repeat++) {
        const double *a = random_numbers(*state, &stream, n), *b = random_numbers(*state, &stream, n);
        double scaled[n], shorter_a[n], shorter_b[n], holed_a[n], holed_b[n], mac = rotid_mac(n, a, b);
        int kept = 0;
        assert_true(mac >= 0 && mac <= 1);
        for (int i = 0; i < n; i++) {
            scaled[i] = -1e5 * a[i];
            holed_a[i] = i % 7 == 2 ? NAN : a[i];
            holed_b[i] = i % 5 == 1 ? (i % 2 ? INFINITY : NAN) : b[i];
            if (i % 7 != 2 && i % 5 != 1) {
                shorter_a[kept] = a[i];
                shorter_b[kept++] = b[i];
            }
        }
        assert_close(rotid_mac(n, scaled, b), mac, 1e-12, 0);
        assert_close(rotid_mac(n, scaled, a), 1, 1e-14, 0);
        assert_close(rotid_mac(n, holed_a, holed_b), rotid_mac(kept, shorter_a, shorter_b), 1e-14, 0);
        assert_close(rotid_mac(n, holed_a, scaled), 1, 1e-14, 0); /* what is left is parallel */
    }
    for (int power = -320; power <= 307; power += 33) { /* squares of these have no double */
        double large[3], one[3] = {1, -0.5, 0.25}, mass[9] = {2, 0, 0, 0, 1, 0, 0, 0, 4}, work[3];
        for (int i = 0; i < 3; i++)
            large[i] = one[i] * pow(10, power);
        assert_close(rotid_mac(3, large, large), 1, 1e-14, 0);
        assert_close(rotid_mac(3, large, one), 1, power < -310 ? 1e-3 : 1e-12, 0);
        assert_close(rotid_nco(3, mass, large, large, work), 1, 1e-14, 0);
        assert_close(rotid_nco(3, mass, one, large, work), 1, power < -310 ? 1e-3 : 1e-12, 0);
    }
    double nothing[2] = {NAN, 1}, other[2] = {1, NAN};
    assert_close(rotid_mac(2, nothing, other), 0, 0, 0);
}

POOL_TEST(nco_is_the_squared_cosine_in_the_mass)
{
    enum { n = 25 };
    struct random_stream stream = {72};
    rotid_matrix random_mass;
    random_positive(*state, &stream, n, n - 1, 0, NULL, 1, &random_mass);
    const double *mass = dense_of(*state, &random_mass);
    double identity[n * n] = {0}, work[n];
    for (int i = 0; i < n; i++)
        identity[i + i * n] = 1;
    for (int repeat = 0; repeat < 20; repeat++) {
        const double *a = random_numbers(*state, &stream, n), *b = random_numbers(*state, &stream, n);
        const double *ma = dense_product(*state, n, n, 1, mass, a), *mb = dense_product(*state, n, n, 1, mass, b);
        double aa = 0, ab = 0, bb = 0, scaled[n], holed[n], zeroed[n];
        for (int i = 0; i < n; i++) {
            aa += a[i] * ma[i];
            ab += a[i] * mb[i];
            bb += b[i] * mb[i];
            scaled[i] = -3e-4 * b[i];
            holed[i] = i % 4 == 1 ? NAN : a[i];
            zeroed[i] = i % 4 == 1 ? 0 : a[i];
        }
        double nco = rotid_nco(n, mass, a, b, work);
        assert_close(nco, ab * ab / (aa * bb), 1e-12, 1e-14);
        assert_close(rotid_nco(n, mass, b, a, work), nco, 1e-12, 1e-14);
        assert_close(rotid_nco(n, mass, a, scaled, work), nco, 1e-12, 1e-14);
        assert_close(rotid_nco(n, mass, scaled, b, work), 1, 1e-13, 0);
        assert_close(rotid_nco(n, identity, a, b, work), rotid_mac(n, a, b), 1e-12, 1e-14);
        assert_close(rotid_nco(n, mass, holed, b, work), rotid_nco(n, mass, zeroed, b, work), 1e-14, 0);
        assert_close(rotid_nco(n, mass, b, holed, work), rotid_nco(n, mass, b, zeroed, work), 1e-14, 0);
        memset(zeroed, 0, sizeof zeroed);
        assert_close(rotid_nco(n, mass, a, zeroed, work), 0, 0, 0);
    }
}

/* Condensed vectors are orthogonal in the condensed mass, and only there: the MAC of two of them is not zero. */
POOL_TEST(condensed_vectors_have_the_identity_for_nco)
{
    struct rotor_model client;
    struct prediction p;
    int failed;
    double work[PAPER_SENSORS], largest_mac = 0;
    assert_status(model_open(*state, NULL, paper_rotor(BUNDLE_RODS, 1), 2, paper_parameters, 1, &client, &failed), ROTID_OK);
    assert_status(prediction_new(*state, &client.equations, ROTID_GUYAN, ROTID_NELSON, 8, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, paper_start), ROTID_OK);
    for (int j = 0; j < 8; j++)
        for (int i = 0; i < 8; i++) {
            const double *a = p.phi + i * PAPER_SENSORS, *b = p.phi + j * PAPER_SENSORS;
            assert_close(rotid_nco(PAPER_SENSORS, p.condensed.mc, a, b, work), i == j, 0, 1e-12);
            if (i != j)
                largest_mac = fmax(largest_mac, rotid_mac(PAPER_SENSORS, a, b));
        }
    assert_true(largest_mac > 0.01);
}

/* ---- pairing; correlation[mode + candidate * nmode], written below one candidate a line */

POOL_TEST(clear_shapes_confirm_the_numbers)
{
    const double correlation[9] = {0.99, 0.02, 0.01, 0.03, 0.97, 0.04, 0.00, 0.05, 0.95};
    int number[3] = {1, 2, 3}, used[3];
    enum pairing_basis basis[3];
    assert_int_equal(pair_modes(3, 3, correlation, number, basis, used), 0);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(number[k], k + 1);
        assert_int_equal(basis[k], PAIRED_BY_SHAPE);
    }
}

/* Every order of four modes among six candidates, from shapes of the paper's rotor with noise. */
POOL_TEST(modes_listed_in_any_order_are_found_by_their_shapes)
{
    enum { nmode = 4, ncandidate = 6 };
    struct random_stream stream = {73};
    struct rotor_model client;
    struct prediction p;
    int failed, tried = 0;
    assert_status(model_open(*state, NULL, paper_rotor(BUNDLE_RODS, 1), 2, paper_parameters, 1, &client, &failed), ROTID_OK);
    assert_status(prediction_new(*state, &client.equations, ROTID_GUYAN, ROTID_NELSON, 8, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, paper_start), ROTID_OK);
    for (int order = 0; order < ncandidate * ncandidate * ncandidate * ncandidate; order++) {
        int place[nmode] = {order % 6, order / 6 % 6, order / 36 % 6, order / 216}, distinct = 1, number[nmode], used[ncandidate];
        double correlation[nmode * ncandidate], shape[PAPER_SENSORS], work[PAPER_SENSORS];
        enum pairing_basis basis[nmode];
        for (int a = 0; a < nmode; a++)
            for (int b = 0; b < a; b++)
                distinct &= place[a] != place[b];
        if (!distinct)
            continue;
        tried++;
        for (int k = 0; k < nmode; k++) {
            const double *bending = p.phi + 2 * PAPER_SENSORS, *phi = bending + place[k] * PAPER_SENSORS;
            number[k] = k + 1;
            for (int s = 0; s < PAPER_SENSORS; s++)
                shape[s] = -2 * phi[s] + 0.005 * random_normal(&stream);
            for (int j = 0; j < ncandidate; j++)
                correlation[k + j * nmode] = rotid_nco(PAPER_SENSORS, p.condensed.mc, shape, bending + j * PAPER_SENSORS, work);
        }
        assert_int_equal(pair_modes(nmode, ncandidate, correlation, number, basis, used), 0);
        for (int k = 0; k < nmode; k++) {
            assert_int_equal(number[k], place[k] + 1);
            assert_int_equal(basis[k], PAIRED_BY_SHAPE);
        }
    }
    assert_int_equal(tried, 360);
}

POOL_TEST(without_shapes_the_numbers_stand)
{
    int number[3] = {4, 1, 2}, used[5];
    enum pairing_basis basis[3] = {PAIRED_BY_SHAPE, PAIRED_BY_SHAPE, PAIRED_BY_SHAPE};
    assert_int_equal(pair_modes(3, 5, NULL, number, basis, used), 0);
    assert_int_equal(number[0], 4);
    assert_int_equal(number[1], 1);
    assert_int_equal(number[2], 2);
    for (int k = 0; k < 3; k++)
        assert_int_equal(basis[k], PAIRED_BY_NUMBER);
}

/* Two candidates nearly as good, none good enough, or no correlation at all: such shapes move nothing. */
POOL_TEST(ambiguous_and_poor_shapes_leave_the_number)
{
    const double rows[][3] = {{0.60, 0.35, 0.01}, {0.45, 0.01, 0.01}, {0.501, 0.499, 0}, {NAN, NAN, NAN}, {0, 0, 0}};
    for (int r = 0; r < 5; r++) {
        const double correlation[6] = {rows[r][0], 0.02, rows[r][1], 0.01, rows[r][2], 0.98};
        int number[2] = {2, 1}, used[3];
        enum pairing_basis basis[2];
        assert_int_equal(pair_modes(2, 3, correlation, number, basis, used), 0);
        assert_int_equal(number[0], 2);
        assert_int_equal(basis[0], PAIRED_BY_NUMBER);
        assert_int_equal(number[1], 3);
        assert_int_equal(basis[1], PAIRED_BY_SHAPE);
    }
}

/* As soon as the best is PAIRING_LEAST and twice the next. */
POOL_TEST(a_shape_decides_from_the_stated_threshold_on)
{
    const double rows[][2] = {{PAIRING_LEAST, PAIRING_LEAST / 2}, {0.8, 0.4}, {0.499, 0.1}, {0.8, 0.41}};
    for (int r = 0; r < 4; r++) {
        int number[1] = {2}, used[2];
        enum pairing_basis basis[1];
        assert_int_equal(pair_modes(1, 2, rows[r], number, basis, used), 0);
        assert_int_equal(number[0], r < 2 ? 1 : 2);
        assert_int_equal(basis[0], r < 2 ? PAIRED_BY_SHAPE : PAIRED_BY_NUMBER);
    }
}

POOL_TEST(the_stronger_of_two_claims_wins)
{
    for (int strong = 0; strong < 2; strong++) { /* both are most like candidate 1 */
        const double correlation[6] = {strong ? 0.70 : 0.95, strong ? 0.95 : 0.70, 0.10, 0.05, 0.02, 0.01};
        int number[2] = {2, 3}, used[3];
        enum pairing_basis basis[2];
        assert_int_equal(pair_modes(2, 3, correlation, number, basis, used), 0);
        assert_int_equal(number[strong], 1);
        assert_int_equal(basis[strong], PAIRED_BY_SHAPE);
        assert_int_equal(number[1 - strong], strong ? 2 : 3);
        assert_int_equal(basis[1 - strong], PAIRED_BY_NUMBER);
    }
}

POOL_TEST(a_number_that_is_taken_is_reported)
{
    const double correlation[9] = {0.1, 0.9, 0.1, 0.1, 0.0, 0.1, 0.1, 0.0, 0.1}; /* mode 2 of the data is candidate 1 */
    int number[3] = {1, 2, 3}, twice[3] = {3, 2, 3}, used[3];
    enum pairing_basis basis[3];
    assert_int_equal(pair_modes(3, 3, correlation, number, basis, used), 1 + 0);
    assert_int_equal(pair_modes(3, 3, NULL, twice, basis, used), 1 + 2);
}

POOL_TEST(a_number_beyond_the_candidates_disturbs_nothing)
{
    const double correlation[4] = {0.1, 0.9, 0.1, 0.0};
    int number[2] = {7, 2}, used[2];
    enum pairing_basis basis[2];
    assert_int_equal(pair_modes(2, 2, correlation, number, basis, used), 0);
    assert_int_equal(number[0], 7);
    assert_int_equal(number[1], 1);
    number[0] = 0;
    assert_int_equal(pair_modes(2, 2, NULL, number, basis, used), 0);
    assert_int_equal(number[0], 0);
}
