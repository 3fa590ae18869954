/* Points, directions, references; transfer functions that are wrong; what is refused. */
#include "ema/ema.h"
#include "ema_truth.h"
#include "support.h"

static struct truth truth;

static void measure(int npoint, int drive, double noise, struct frf_set *set)
{
    struct random_stream random = {.state = 17};
    truth_beam(3, npoint, drive, 60, 4e-3, &truth);
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 30, 0.2, 1800, noise, noise > 0, &random, set);
}

static void compute(const struct frf_set *set, struct ema *ema)
{
    struct ema_options options = {.order = 40};
    assert_status(ema_compute(&test_pool, set, &options, NULL, ema), ROTID_OK);
}

static void assert_shapes(const struct ema *ema, int npoint, double atol)
{
    assert_int_equal(ema->nmode, 3);
    assert_int_equal(ema->npoint, npoint);
    for (int r = 0; r < 3; r++)
        for (int i = 0; i < npoint; i++) {
            int j = ema->point_node[i] - 1, first = ema->point_node[0] - 1;
            assert_true(ema->point_direction[i] == 2);
            assert_close(ema->mode[r].shape[i] * truth.phi[r][first], truth.phi[r][j] * ema->mode[r].shape[0], 0, atol);
        }
}

POOL_TEST(a_transducer_turned_round_turns_its_sign)
{
    struct frf_set set;
    struct ema ema;
    measure(8, 0, 0, &set);
    set.frf[0].response_direction = set.frf[5].response_direction = -2;
    for (int i = 0; i < set.nline; i++) {
        set.frf[0].h[i] = -set.frf[0].h[i];
        set.frf[5].h[i] = -set.frf[5].h[i];
    }
    compute(&set, &ema);
    assert_shapes(&ema, 8, 1e-5);
    assert_close(ema.mode[1].modal_mass, 1, 1e-4, 0);
}

POOL_TEST(a_hammer_that_roves_gives_the_same)
{
    struct frf_set set;
    struct ema ema;
    measure(8, 0, 0, &set);
    for (int c = 0; c < 8; c++) {
        set.frf[c].reference_node = set.frf[c].response_node;
        set.frf[c].response_node = 1;
    }
    compute(&set, &ema);
    assert_int_equal(ema.roving_force, 1);
    assert_shapes(&ema, 8, 1e-5);
    assert_close(ema.mode[0].modal_mass, 1, 1e-4, 0);
}

/* Two fixed transducers: the shapes have the points of the hammer, not two. */
POOL_TEST(a_hammer_that_roves_beside_two_transducers_gives_the_same)
{
    struct frf_set a, b;
    struct ema ema;
    measure(9, 4, 0, &b);
    measure(9, 0, 0, &a);
    struct frf_set set = a;
    set.nfrf = 18;
    set.frf = POOL_ARRAY(&test_pool, struct frf, 18);
    memcpy(set.frf, a.frf, 9 * sizeof *a.frf);
    memcpy(set.frf + 9, b.frf, 9 * sizeof *b.frf);
    for (int c = 0; c < 18; c++) {
        int point = set.frf[c].response_node;
        set.frf[c].response_node = set.frf[c].reference_node;
        set.frf[c].reference_node = point;
    }
    compute(&set, &ema);
    assert_int_equal(ema.roving_force, 1);
    assert_shapes(&ema, 9, 1e-4);
    assert_close(ema.mode[0].modal_mass, 1, 1e-3, 0);
}

/* Eight points over two references, one of which sees no middle mode at its node. */
POOL_TEST(two_references_make_one_shape)
{
    struct frf_set a, b, set;
    struct ema ema;
    measure(9, 4, 0, &b);
    measure(9, 0, 0, &a);
    set = a;
    set.nfrf = 18;
    set.frf = POOL_ARRAY(&test_pool, struct frf, 18);
    memcpy(set.frf, a.frf, 9 * sizeof *a.frf);
    memcpy(set.frf + 9, b.frf, 9 * sizeof *b.frf);
    compute(&set, &ema);
    assert_int_equal(ema.roving_force, 0);
    assert_shapes(&ema, 9, 1e-4);
    assert_close(ema.mode[0].modal_mass, 1, 1e-3, 0);
}

POOL_TEST(bad_channels_are_named)
{
    struct frf_set set;
    struct ema ema;
    struct random_stream random = {.state = 4};
    measure(10, 0, 1e-2, &set);
    for (int i = 0; i < set.nline; i++) {
        set.frf[2].h[i] *= 1e-5;
        set.frf[2].variance[i] *= 1e-10;
        set.frf[8].h[i] = set.frf[7].h[i];
        double std = sqrt(set.frf[5].variance[i]) * 10;
        set.frf[5].h[i] += std / sqrt(2) * CMPLX(random_normal(&random), random_normal(&random));
        set.frf[5].variance[i] *= 101;
    }
    set.frf[3].h[100] = CMPLX(NAN, 0);
    set.frf[9].h[100] = CMPLX(1e200, 0); /* its square has no double */
    compute(&set, &ema);
    assert_int_equal(ema.nmode, 3);
    assert_true(ema.channel[2].quality_flags & EMA_DEAD);
    assert_true(ema.channel[3].quality_flags & EMA_NOT_FINITE);
    assert_true(ema.channel[9].quality_flags & EMA_NOT_FINITE);
    assert_true(ema.channel[5].quality_flags & EMA_NOISY);
    assert_true(ema.channel[8].quality_flags & EMA_DUPLICATE);
    assert_int_equal(ema.channel[8].duplicate_of, 7);
    for (int c = 0; c < 10; c++)
        if (c != 2 && c != 3 && c != 5 && c < 8)
            assert_int_equal(ema.channel[c].quality_flags, 0);
    assert_true(isnan(ema.mode[0].shape[3]) && isnan(ema.mode[0].shape[2]) && !isnan(ema.mode[0].shape[4]));
    assert_true(ema.channel[0].fit > 0.99);
}

POOL_TEST(what_cannot_be_done_is_refused)
{
    struct frf_set set;
    struct ema ema;
    struct ema_options options = {.low_hz = 59, .high_hz = 61};
    measure(3, 0, 0, &set);
    assert_status(ema_compute(&test_pool, &set, &options, NULL, &ema), ROTID_ERROR_ARGUMENT);
    options = (struct ema_options){.low_hz = 5000};
    assert_status(ema_compute(&test_pool, &set, &options, NULL, &ema), ROTID_ERROR_ARGUMENT);
    set.nline = 1;
    assert_status(ema_compute(&test_pool, &set, NULL, NULL, &ema), ROTID_ERROR_ARGUMENT);
    set.nline = 1800;
    options = (struct ema_options){.low_hz = 55, .high_hz = 60, .order = 500};
    assert_status(ema_compute(&test_pool, &set, &options, NULL, &ema), ROTID_OK);
    assert_true(ema.order <= 26);
    for (int c = 0; c < 3; c++)
        memset(set.frf[c].h, 0, 1800 * sizeof *set.frf[c].h);
    assert_status(ema_compute(&test_pool, &set, NULL, NULL, &ema), ROTID_ERROR_ARGUMENT);
    set.nfrf = 0;
    assert_status(ema_compute(&test_pool, &set, NULL, NULL, &ema), ROTID_ERROR_ARGUMENT);
}

static int always(void *context)
{
    (void)context;
    return 1;
}

POOL_TEST(it_can_be_cancelled)
{
    struct frf_set set;
    struct ema ema;
    rotid_environment environment = {.size = sizeof environment, .cancelled = always};
    measure(3, 0, 0, &set);
    assert_status(ema_compute(&test_pool, &set, NULL, &environment, &ema), ROTID_STOP_CANCELLED);
}

POOL_TEST(every_allocation_may_fail)
{
    struct frf_set set;
    struct ema_options options = {.order = 10, .per_point = 1, .low_hz = 40, .high_hz = 80};
    int status = ROTID_ERROR_MEMORY;
    measure(3, 0, 1e-2, &set);
    for (long n = 1; status != ROTID_OK; n += n < 60 ? 1 : 17) {
        struct failing_allocator failing;
        struct pool pool;
        struct ema ema;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        status = ema_compute(&pool, &set, &options, NULL, &ema);
        assert_true(status == ROTID_OK || status == ROTID_ERROR_MEMORY);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
}

POOL_TEST(threads_change_no_bit)
{
    struct frf_set set;
    struct ema one, four;
    struct ema_options options = {.order = 40, .threads = 1};
    measure(19, 0, 1e-2, &set);
    assert_status(ema_compute(&test_pool, &set, &options, NULL, &one), ROTID_OK);
    options.threads = 4;
    assert_status(ema_compute(&test_pool, &set, &options, NULL, &four), ROTID_OK);
    assert_int_equal(one.nmode, four.nmode);
    for (int r = 0; r < one.nmode; r++) {
        assert_memory_equal(&one.mode[r].frequency_hz, &four.mode[r].frequency_hz, sizeof(double));
        assert_memory_equal(&one.mode[r].damping_std, &four.mode[r].damping_std, sizeof(double));
        assert_memory_equal(one.mode[r].shape, four.mode[r].shape, 19 * sizeof(double));
    }
}

UNIT_TEST(how_far_from_real_in_closed_form)
{
    double complex line[3] = {CMPLX(3, 4), CMPLX(-6, -8), CMPLX(0.3, 0.4)}, circle[4] = {1, I, -1, -I};
    double complex cross[2] = {2, 3 * I};
    assert_close(mode_phase_collinearity(3, line), 1, 1e-14, 0);
    assert_close(mode_phase_deviation(3, line), 0, 0, 1e-12);
    assert_close(fabs(creal(line[1] * conj(mode_axis(3, line)))), 10, 1e-14, 0);
    assert_close(mode_phase_collinearity(4, circle), 0, 0, 1e-14);
    assert_close(mode_phase_deviation(4, circle), 45, 1e-12, 0);
    /* S_xx = 4, S_yy = 9: (5/13)^2; phases 90 and 0 from the axis weighted 2 and 3 */
    assert_close(mode_phase_collinearity(2, cross), 25.0 / 169, 1e-14, 0);
    assert_close(mode_phase_deviation(2, cross), 36, 1e-12, 0);
    line[1] = CMPLX(NAN, NAN);
    assert_close(mode_phase_collinearity(3, line), 1, 1e-14, 0);
    memset(line, 0, sizeof line);
    assert_close(mode_phase_collinearity(3, line), 0, 0, 0);
}
