/* Measured transfer functions of a free-free bar: data/beam.uff of pyuff 2.4.2 (MIT), lines around the modes. */
#include "ema/ema.h"
#include "support.h"

#define FRFS 3

/* The three functions of the excerpt: uneven abscissa, real and imaginary part, six numbers a line. */
static void read_excerpt(struct frf_set *set)
{
    FILE *file = fopen(ROTID_SOURCE_DIR "/tests/data/uff/beam_excerpt.uff", "r");
    char text[256];
    assert_non_null(file);
    *set = (struct frf_set){.quantity = FRF_ACCELERATION, .nfrf = FRFS, .frf = POOL_ARRAY(&test_pool, struct frf, FRFS)};
    for (int c = 0; c < FRFS; c++) {
        for (int i = 0; i < 8; i++)
            assert_non_null(fgets(text, sizeof text, file));
        assert_non_null(fgets(text, sizeof text, file));
        int n = (int)strtol(text + 10, NULL, 10);
        for (int i = 0; i < 4; i++)
            assert_non_null(fgets(text, sizeof text, file));
        set->nline = n;
        set->frequency_hz = POOL_ARRAY(&test_pool, double, n);
        set->frf[c] = (struct frf){.h = POOL_ARRAY(&test_pool, double complex, n),
                                   .response_node = c + 1,
                                   .response_direction = 1,
                                   .reference_node = 21,
                                   .reference_direction = 1};
        for (int i = 0; i < n; i++) {
            double re, im;
            assert_int_equal(fscanf(file, "%lf %lf %lf", &set->frequency_hz[i], &re, &im), 3);
            set->frf[c].h[i] = CMPLX(re, im);
        }
        assert_non_null(fgets(text, sizeof text, file)); /* the rest of the line, and the end of the set */
        assert_non_null(fgets(text, sizeof text, file));
    }
    (void)fclose(file);
}

/* Frequencies and damping that other programs find in the whole file, where a bar has (2 r + 1)^2. */
POOL_TEST(nine_modes_of_a_real_bar)
{
    static const double hz[9] = {52.553, 144.632, 283.127, 468.277, 698.466, 972.977, 1292.957, 1655.35, 2064.51};
    static const double zeta[9] = {0.001821, 0.000715, 0.000392, 0.000216, 0.000186, 0.000228, 0.000217, 0.000333, 0.000210};
    struct frf_set set;
    struct ema ema;
    read_excerpt(&set);
    assert_status(ema_compute(&test_pool, &set, NULL, NULL, &ema), ROTID_OK);
    assert_int_equal(ema.nmode, 9);
    for (int r = 0; r < 9; r++) {
        assert_close(ema.mode[r].frequency_hz, hz[r], 1e-3, 0);
        assert_close(ema.mode[r].damping, zeta[r], 0.15, 0);
        assert_true(ema.mode[r].frequency_std > 0 && ema.mode[r].frequency_std < 1e-3 * hz[r]);
        assert_true(ema.mode[r].mpc > 0.75);
    }
    assert_int_equal(ema.std_from_impacts, 0);
    for (int k = 0; k < ema.npole; k++)
        assert_true(ema.pole[k].mode == ROTID_NONE || (ema.pole[k].mode >= 1 && ema.pole[k].mode <= 9));
}
