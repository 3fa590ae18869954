/* Building blocks for hosts: condensation and its derivatives against dense elimination written out. */
#include "dense.h"
#include "support.h"

static const int far[3] = {1, 7, 18};

/* Structures: band, band with block, wide band, dense. */
static const int structures[][3] = {{20, 3, 0}, {20, 2, 3}, {24, 12, 0}, {20, 19, 0}, {9, 1, 0}};

static void open_structure(struct pool *pool, struct random_stream *stream, size_t s, rotid_matrix *a)
{
    random_positive(pool, stream, structures[s][0], structures[s][1], structures[s][2], far, 1, a);
}

POOL_TEST(condensed_matrices_are_those_of_dense_elimination)
{
    static const int some[4] = {0, 3, 7, 8}, one[1] = {5};
    struct random_stream stream = {1};
    for (size_t s = 0; s < 5; s++)
        for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++)
            for (int nc = 1; nc <= 4; nc += 3) {
                rotid_matrix k, m;
                const int *master = nc == 1 ? one : some;
                open_structure(*state, &stream, s, &k);
                open_structure(*state, &stream, s, &m);
                int n = k.n;
                double kc[16], mc[16], *t = numbers(*state, n * nc);
                const double *full_k = dense_of(*state, &k), *full_m = dense_of(*state, &m);
                assert_status(rotid_condense(&k, &m, nc, master, kind, NULL, NULL, kc, mc, t), ROTID_OK);
                const double *expected = kind == ROTID_GUYAN ? dense_guyan(*state, n, full_k, nc, master)
                                                             : dense_irs(*state, n, full_k, full_m, nc, master);
                assert_true(relative_difference((size_t)(n * nc), t, expected) < 1e-11);
                assert_true(relative_difference((size_t)(nc * nc), kc, dense_congruence(*state, n, nc, full_k, expected)) <
                            1e-11);
                assert_true(relative_difference((size_t)(nc * nc), mc, dense_congruence(*state, n, nc, full_m, expected)) <
                            1e-11);
                double again_k[16], again_m[16]; /* t is optional */
                assert_status(rotid_condense(&k, &m, nc, master, kind, NULL, NULL, again_k, again_m, NULL), ROTID_OK);
                assert_memory_equal(again_k, kc, (size_t)(nc * nc) * sizeof *kc);
                assert_memory_equal(again_m, mc, (size_t)(nc * nc) * sizeof *mc);
            }
}

POOL_TEST(masters_everywhere_leave_the_matrices_as_they_are)
{
    struct random_stream stream = {2};
    for (size_t s = 0; s < 5; s++)
        for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
            rotid_matrix k, m;
            open_structure(*state, &stream, s, &k);
            open_structure(*state, &stream, s, &m);
            int n = k.n, master[24];
            double *kc = numbers(*state, n * n), *mc = numbers(*state, n * n), *t = numbers(*state, n * n);
            double *dkc = numbers(*state, n * n), *dmc = numbers(*state, n * n);
            for (int i = 0; i < n; i++)
                master[i] = i;
            assert_status(rotid_condense(&k, &m, n, master, kind, NULL, NULL, kc, mc, t), ROTID_OK);
            assert_true(relative_difference((size_t)(n * n), kc, dense_of(*state, &k)) < 1e-14);
            assert_true(relative_difference((size_t)(n * n), mc, dense_of(*state, &m)) < 1e-14);
            for (int i = 0; i < n * n; i++)
                assert_true(t[i] == (i % (n + 1) == 0));
            assert_status(rotid_condense_derivative(&k, &m, &m, &k, n, master, kind, NULL, NULL, dkc, dmc), ROTID_OK);
            assert_true(relative_difference((size_t)(n * n), dkc, dense_of(*state, &m)) < 1e-13);
            assert_true(relative_difference((size_t)(n * n), dmc, dense_of(*state, &k)) < 1e-13);
        }
    rotid_matrix one = {.n = 1, .band = (double[]){4}}, mass = {.n = 1, .band = (double[]){3}};
    double kc, mc, t;
    assert_status(rotid_condense(&one, &mass, 1, (int[]){0}, ROTID_IRS, NULL, NULL, &kc, &mc, &t), ROTID_OK);
    assert_true(kc == 4 && mc == 3 && t == 1);
}

/* Springs in series between two masters, the chain free at both ends: 1/k = sum 1/k_i, and of the masses each end takes what the
 * linear shape of the displacement gives it. */
POOL_TEST(springs_in_series)
{
    enum { n = 30 };
    rotid_matrix k = {.n = n, .kd = 1, .band = numbers(*state, 2 * n)}, m = {.n = n, .kd = 0, .band = numbers(*state, n)};
    rotid_matrix wide = {.n = n, .kd = 1, .band = numbers(*state, 2 * n)};
    double flexibility = 0, kc[4], mc[4], share[n] = {0}, expected[4] = {0};
    for (int i = 0; i < n - 1; i++) {
        double spring = 1e6 / (1 + i % 3);
        const double e[4] = {spring, -spring, -spring, spring};
        assert_status(rotid_matrix_add_element(&k, 2, (int[]){i, i + 1}, e, NULL), ROTID_OK);
        flexibility += 1 / spring;
        share[i + 1] = flexibility;
    }
    for (int i = 0; i < n; i++) {
        double mass = 1 + i % 2, right = share[i] / flexibility;
        assert_status(rotid_matrix_add(&wide, i, i, mass, NULL), ROTID_OK);
        assert_status(rotid_matrix_add(&m, i, i, mass, NULL), ROTID_OK);
        expected[0] += mass * (1 - right) * (1 - right);
        expected[1] += mass * (1 - right) * right;
        expected[3] += mass * right * right;
    }
    expected[2] = expected[1];
    const int ends[2] = {0, n - 1};
    assert_status(rotid_condense(&k, &m, 2, ends, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_ERROR_ARGUMENT); /* kd differs */
    assert_status(rotid_condense(&k, &wide, 2, ends, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_OK);
    for (int i = 0; i < 4; i++) {
        assert_close(kc[i], (i % 3 ? -1 : 1) / flexibility, 1e-12, 0);
        assert_close(mc[i], expected[i], 1e-12, 0);
    }
}

/* dKc = T' dK T because K T has no slave rows; dT = -K_ii^-1 (dK T)_i and dMc = dT' M T + T' dM T + T' M dT. */
POOL_TEST(derivatives_of_guyan_are_those_of_dense_elimination)
{
    static const int master[4] = {0, 3, 7, 8};
    struct random_stream stream = {3};
    for (size_t s = 0; s < 5; s++) {
        rotid_matrix k, m, dk, dm;
        open_structure(*state, &stream, s, &k);
        open_structure(*state, &stream, s, &m);
        open_structure(*state, &stream, s, &dk);
        open_structure(*state, &stream, s, &dm);
        int n = k.n, nc = 4, ni = n - nc, slave[24];
        for (int i = 0, c = 0, next = 0; i < n; i++)
            if (c < nc && master[c] == i)
                c++;
            else
                slave[next++] = i;
        const double *full_k = dense_of(*state, &k), *full_m = dense_of(*state, &m), *full_dk = dense_of(*state, &dk);
        const double *t = dense_guyan(*state, n, full_k, nc, master);
        const double *dk_t = dense_product(*state, n, n, nc, full_dk, t);
        double *right = numbers(*state, ni * nc), *dt = numbers(*state, n * nc), dkc[16], dmc[16];
        for (int c = 0; c < nc; c++)
            for (int i = 0; i < ni; i++)
                right[i + c * ni] = -dk_t[slave[i] + c * n];
        const double *dphi = dense_solution(*state, ni, nc, dense_part(*state, n, full_k, ni, slave, ni, slave), right);
        for (int c = 0; c < nc; c++)
            for (int i = 0; i < ni; i++)
                dt[slave[i] + c * n] = dphi[i + c * ni];
        double *expected_m = dense_congruence(*state, n, nc, dense_of(*state, &dm), t);
        const double *cross = dense_transposed_product(*state, nc, n, nc, dt, dense_product(*state, n, n, nc, full_m, t));
        for (int j = 0; j < nc; j++)
            for (int i = 0; i < nc; i++)
                expected_m[i + j * nc] += cross[i + j * nc] + cross[j + i * nc];
        assert_status(rotid_condense_derivative(&k, &m, &dk, &dm, nc, master, ROTID_GUYAN, NULL, NULL, dkc, dmc), ROTID_OK);
        assert_true(relative_difference(16, dkc, dense_congruence(*state, n, nc, full_dk, t)) < 1e-11);
        assert_true(relative_difference(16, dmc, expected_m) < 1e-10);
    }
}

/* Condensed matrices at K + h dK, M + h dM; differences of sixth order. */
POOL_TEST(derivatives_of_irs_match_differences)
{
    static const int master[3] = {0, 4, 8};
    static const double at[6] = {-3, -2, -1, 1, 2, 3}, weight[6] = {-1.0 / 60, 3.0 / 20, -0.75, 0.75, -3.0 / 20, 1.0 / 60};
    struct random_stream stream = {4};
    for (size_t s = 0; s < 5; s++)
        for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
            rotid_matrix k, m, dk, dm, moved_k, moved_m;
            open_structure(*state, &stream, s, &k);
            open_structure(*state, &stream, s, &m);
            open_structure(*state, &stream, s, &dk);
            open_structure(*state, &stream, s, &dm);
            open_structure(*state, &stream, s, &moved_k);
            open_structure(*state, &stream, s, &moved_m);
            double h = 2e-4, dkc[9], dmc[9], kc[9], mc[9], expected_k[9] = {0}, expected_m[9] = {0};
            for (int p = 0; p < 6; p++) {
                for (int i = 0; i < k.n * (k.kd + 1); i++) {
                    moved_k.band[i] = k.band[i] + at[p] * h * dk.band[i];
                    moved_m.band[i] = m.band[i] + at[p] * h * dm.band[i];
                }
                for (int i = 0; i < k.nfar * k.nfar; i++) {
                    moved_k.block[i] = k.block[i] + at[p] * h * dk.block[i];
                    moved_m.block[i] = m.block[i] + at[p] * h * dm.block[i];
                }
                assert_status(rotid_condense(&moved_k, &moved_m, 3, master, kind, NULL, NULL, kc, mc, NULL), ROTID_OK);
                for (int i = 0; i < 9; i++) {
                    expected_k[i] += weight[p] / h * kc[i];
                    expected_m[i] += weight[p] / h * mc[i];
                }
            }
            assert_status(rotid_condense_derivative(&k, &m, &dk, &dm, 3, master, kind, NULL, NULL, dkc, dmc), ROTID_OK);
            assert_true(relative_difference(9, dkc, expected_k) < 1e-10);
            assert_true(relative_difference(9, dmc, expected_m) < 1e-10);
            for (int j = 0; j < 3; j++)
                for (int i = 0; i < j; i++)
                    assert_true(dkc[i + 3 * j] == dkc[j + 3 * i] && dmc[i + 3 * j] == dmc[j + 3 * i]);
        }
}

/* Two springs and masses whose condensation leaves the doubles: T'KT and its derivative. */
POOL_TEST(what_leaves_the_doubles_is_no_result)
{
    const int master[1] = {0};
    double k_band[4] = {1, -1e200, 1, 0}, m_band[4] = {1, 0, 1, 0}, kc[1], mc[1];
    const rotid_matrix k = {2, 1, 0, NULL, k_band, NULL}, m = {2, 1, 0, NULL, m_band, NULL};
    (void)state;
    assert_status(rotid_condense(&k, &m, 1, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_ERROR_FINITE);
    k_band[1] = -1;
    m_band[2] = 1e200;
    assert_status(rotid_condense(&k, &m, 1, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_OK);
    double large_band[4] = {1e308, 1e308, 1e308, 0};
    const rotid_matrix large = {2, 1, 0, NULL, large_band, NULL};
    assert_status(rotid_condense_derivative(&k, &m, &large, &m, 1, master, ROTID_GUYAN, NULL, NULL, kc, mc), ROTID_ERROR_FINITE);
}

POOL_TEST(what_cannot_be_condensed_is_named)
{
    struct random_stream stream = {5};
    const int master[2] = {0, 1};
    double kc[4], mc[4];
    rotid_matrix k, m;
    open_structure(*state, &stream, 0, &k);
    open_structure(*state, &stream, 0, &m);
    double *keep = numbers(*state, 80);
    memcpy(keep, k.band, 80 * sizeof *keep);
    for (int d = 0; d < 4; d++) /* the last degree of freedom floats */
        k.band[d + 4 * 19] = d <= 3 ? k.band[3 - d + 4 * (16 + d)] = 0 : 0;
    assert_status(rotid_condense(&k, &m, 2, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_ERROR_SLAVE);
    assert_status(rotid_condense_derivative(&k, &m, &k, &m, 2, master, ROTID_IRS, NULL, NULL, kc, mc), ROTID_ERROR_SLAVE);
    memcpy(k.band, keep, 80 * sizeof *keep);
    for (int j = 0; j < 20; j++)
        m.band[4 * j] -= 1e3; /* negative definite */
    assert_status(rotid_condense(&k, &m, 2, master, ROTID_IRS, NULL, NULL, kc, mc, NULL), ROTID_ERROR_MASS);
    assert_status(rotid_condense(&k, &m, 2, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_OK); /* needs nothing of M */
    for (int which = 0; which < 2; which++)
        for (int bad = 0; bad < 2; bad++) {
            double *entry = &(which ? m : k).band[9], kept = *entry;
            *entry = bad ? INFINITY : NAN;
            assert_status(rotid_condense(&k, &m, 2, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL), ROTID_ERROR_FINITE);
            assert_status(rotid_condense_derivative(&k, &k, &m, &k, 2, master, ROTID_GUYAN, NULL, NULL, kc, mc),
                          ROTID_ERROR_FINITE);
            *entry = kept;
        }
}

POOL_TEST(arguments_out_of_range_are_refused)
{
    static const int backwards[2] = {5, 3}, twice[2] = {5, 5}, beyond[2] = {3, 20}, below[2] = {-1, 4}, good[2] = {3, 5};
    struct random_stream stream = {6};
    rotid_matrix k, m, other;
    double kc[4], mc[4];
    open_structure(*state, &stream, 0, &k);
    open_structure(*state, &stream, 0, &m);
    open_structure(*state, &stream, 3, &other);
    const struct {
        const rotid_matrix *k, *m;
        int nmaster;
        const int *master;
        int kind;
        double *kc, *mc;
    } wrong[] = {
        {NULL, &m, 2, good, ROTID_GUYAN, kc, mc},
        {&k, NULL, 2, good, ROTID_GUYAN, kc, mc},
        {&k, &other, 2, good, ROTID_GUYAN, kc, mc},
        {&k, &m, 0, good, ROTID_GUYAN, kc, mc},
        {&k, &m, -1, good, ROTID_GUYAN, kc, mc},
        {&k, &m, 21, good, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, NULL, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, backwards, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, twice, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, beyond, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, below, ROTID_GUYAN, kc, mc},
        {&k, &m, 2, good, ROTID_REDUCTION_NONE, kc, mc},
        {&k, &m, 2, good, 3, kc, mc},
        {&k, &m, 2, good, -1, kc, mc},
        {&k, &m, 2, good, ROTID_GUYAN, NULL, mc},
        {&k, &m, 2, good, ROTID_GUYAN, kc, NULL},
    };
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
        assert_status(rotid_condense(wrong[w].k, wrong[w].m, wrong[w].nmaster, wrong[w].master, wrong[w].kind, NULL, NULL,
                                     wrong[w].kc, wrong[w].mc, NULL),
                      ROTID_ERROR_ARGUMENT);
        assert_status(rotid_condense_derivative(wrong[w].k, wrong[w].m, &k, &m, wrong[w].nmaster, wrong[w].master, wrong[w].kind,
                                                NULL, NULL, wrong[w].kc, wrong[w].mc),
                      ROTID_ERROR_ARGUMENT);
    }
    assert_status(rotid_condense_derivative(&k, &m, NULL, &m, 2, good, ROTID_GUYAN, NULL, NULL, kc, mc), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_condense_derivative(&k, &m, &k, &other, 2, good, ROTID_GUYAN, NULL, NULL, kc, mc), ROTID_ERROR_ARGUMENT);
}

POOL_TEST(memory_that_runs_out_is_an_error_and_none_is_kept)
{
    static const int master[3] = {0, 4, 8};
    struct random_stream stream = {7};
    rotid_matrix k, m;
    double kc[9], mc[9];
    open_structure(*state, &stream, 1, &k);
    open_structure(*state, &stream, 1, &m);
    for (int which = 0; which < 4; which++)
        for (long fail = 1;; fail++) {
            struct failing_allocator failing;
            failing_allocator_open(&failing, fail);
            rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
            int kind = which % 2 ? ROTID_IRS : ROTID_GUYAN;
            int status = which < 2 ? rotid_condense(&k, &m, 3, master, kind, &environment, NULL, kc, mc, NULL)
                                   : rotid_condense_derivative(&k, &m, &k, &m, 3, master, kind, &environment, NULL, kc, mc);
            assert_int_equal(failing.in_use, 0);
            if (status == ROTID_OK) {
                assert_true(fail > 10 && failing.served > 10);
                break;
            }
            assert_status(status, ROTID_ERROR_MEMORY);
        }
}
