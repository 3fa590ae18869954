/* The level of the noise in residuals whose physical columns come from the oracle: right level, stated too low or too high,
 * coloured, with hidden effects, with faulty sensors. Seeds are fixed; rates are asserted against their binomial bounds. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "paper_rotor.h"
#include "rotor_shapes.h"

#define SENSORS PAPER_SENSORS
#define ROWS    (SENSORS * EXACT_MODES)
#define SOFT    20
#define MASSES  10
#define COLUMNS (EXACT_MODES + SOFT + MASSES + 3)
#define FREE    (EXACT_MODES + 2) /* the scales come first, then two columns that the fit adjusts as well */

static double column[ROWS * COLUMNS], orthonormal[ROWS * FREE];

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < ROWS; i++)
        sum += a[i] * b[i];
    return sum;
}

static void take_away(double part, const double *from, double *x)
{
    for (int i = 0; i < ROWS; i++)
        x[i] -= part * from[i];
}

static int open_columns(void **state)
{
    struct exact e;
    struct rotor_shapes right, other;
    const struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    double length, from, to, z[SENSORS];
    (void)state;
    rotor_group_span(rotor, 1, &from, &to);
    for (int i = 0; i < SENSORS; i++)
        z[i] = rotor->sensor[i].position;
    rotor_shapes_open(&e);
    rotor_shapes(&e, &right);
    length = right.length;
    for (int k = 0; k < EXACT_MODES; k++)
        for (int i = 0; i < SENSORS; i++)
            column[i + SENSORS * k + ROWS * k] = rotor_shape_at(&right, k, z[i]);
    for (int c = EXACT_MODES; c < COLUMNS; c++) {
        int j = c - EXACT_MODES;
        rotor_shapes_open(&e);
        if (j < 3)
            exact_soften(&e, j ? (j == 1 ? from : to) : 0, j ? (j == 1 ? to : length) : from, 0.95);
        else if (j < 3 + SOFT)
            exact_soften(&e, length * (j - 3) / SOFT, length * (j - 2) / SOFT, 0.9);
        else
            exact_add(&e, (struct oracle_point){.z = length * (j - 3 - SOFT) / (MASSES - 1), .mass = 1});
        rotor_shapes(&e, &other);
        for (int k = 0; k < EXACT_MODES; k++)
            for (int i = 0; i < SENSORS; i++)
                column[i + SENSORS * k + ROWS * c] = rotor_shape_at(&other, k, z[i]) - rotor_shape_at(&right, k, z[i]);
    }
    for (int c = 0; c < FREE; c++) {
        double *q = orthonormal + (ptrdiff_t)c * ROWS;
        memcpy(q, column + (ptrdiff_t)c * ROWS, ROWS * sizeof *q);
        for (int pass = 0; pass < 2; pass++)
            for (int b = 0; b < c; b++)
                take_away(dot(orthonormal + (ptrdiff_t)b * ROWS, q), orthonormal + (ptrdiff_t)b * ROWS, q);
        double size = sqrt(dot(q, q));
        for (int i = 0; i < ROWS; i++)
            q[i] /= size;
    }
    return 0;
}

static void fit(double *residual)
{
    for (int c = 0; c < FREE; c++)
        take_away(dot(orthonormal + (ptrdiff_t)c * ROWS, residual), orthonormal + (ptrdiff_t)c * ROWS, residual);
}

/* Noise of a level, correlated from one sensor to the next by rho. */
static void draw(struct random_stream *random, double level, double rho, double *residual)
{
    for (int k = 0; k < EXACT_MODES; k++) {
        double *r = residual + (ptrdiff_t)k * SENSORS;
        for (int i = 0; i < SENSORS; i++)
            r[i] = i && rho != 0 ? rho * r[i - 1] + sqrt(1 - rho * rho) * level * random_normal(random)
                                 : level * random_normal(random);
    }
}

static struct noise_estimate estimate(const double *residual)
{
    struct noise_estimate e;
    struct pool pool;
    pool_open(&pool, NULL);
    assert_status(noise_check(&pool, ROWS, COLUMNS, residual, column, &e), ROTID_OK);
    pool_close(&pool);
    assert_true(e.usable);
    return e;
}

/* Mean and spread over seeds of (factor - level)/std, with how often each flag was raised. */
struct rates {
    double bias, spread, smooth;
    int misstated, coloured;
};

enum spoilt { CLEAN, EFFECT, TWO_EFFECTS, FAULTS };

static struct rates over_seeds(int seeds, double level, double rho, enum spoilt spoilt)
{
    struct rates rates = {0};
    for (int seed = 0; seed < seeds; seed++) {
        struct random_stream random = {(uint64_t)(1000 + seed)};
        double residual[ROWS];
        draw(&random, level, rho, residual);
        for (int j = 0; j < (spoilt == EFFECT) + 2 * (spoilt == TWO_EFFECTS); j++) {
            double hidden[ROWS]; /* chi2 of 500 after the fit */
            int c = FREE + (int)(random_uniform(&random) * (COLUMNS - FREE));
            memcpy(hidden, column + (ptrdiff_t)c * ROWS, sizeof hidden);
            fit(hidden);
            take_away(sqrt(500 / dot(hidden, hidden)), hidden, residual);
        }
        for (int j = 0; spoilt == FAULTS && j < 3; j++) { /* a flipped, a dead and a loose channel: up to 130 times the noise */
            int s = (int)(random_uniform(&random) * SENSORS);
            const double change[] = {-2, -1, 0.4};
            for (int k = 0; k < EXACT_MODES; k++)
                residual[s + SENSORS * k] += change[j] * column[s + SENSORS * k + ROWS * k] / 0.015;
        }
        fit(residual);
        struct noise_estimate e = estimate(residual);
        double t = (e.factor - level) / e.std;
        rates.bias += t / seeds;
        rates.spread += t * t / seeds;
        rates.smooth += e.smooth_factor / level / seeds;
        rates.misstated += e.misstated;
        rates.coloured += e.coloured;
    }
    rates.spread = sqrt(fmax(0, rates.spread - rates.bias * rates.bias));
    print_message("level %g rho %g case %d: bias %.2f std, spread %.2f, smooth %.2f, misstated %d, coloured %d of %d\n", level,
                  rho, spoilt, rates.bias, rates.spread, rates.smooth, rates.misstated, rates.coloured, seeds);
    return rates;
}

static void right_level(void **state)
{
    struct rates rates = over_seeds(300, 1, 0, CLEAN);
    (void)state;
    assert_true(fabs(rates.bias) < 0.3 && rates.spread > 0.8 && rates.spread < 1.15);
    assert_true(rates.misstated <= 3 && rates.coloured <= 3);
    assert_close(rates.smooth, 1, 0.08, 0);
}

static void wrong_level(void **state)
{
    const double level[] = {0.5, 2};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rates rates = over_seeds(50, level[i], 0, CLEAN);
        assert_true(fabs(rates.bias) < 0.5 && rates.misstated == 50 && rates.coloured <= 2);
    }
}

static void coloured_noise(void **state)
{
    struct rates rates = over_seeds(100, 1, 0.7, CLEAN);
    (void)state;
    assert_true(rates.coloured >= 88); /* 95 or so: 29 smooth directions are few */
}

static void hidden_effects(void **state)
{
    (void)state;
    for (int spoilt = EFFECT; spoilt <= TWO_EFFECTS; spoilt++) {
        struct rates rates = over_seeds(100, 1, 0, (enum spoilt)spoilt);
        assert_true(fabs(rates.bias) < 0.7 && rates.misstated <= 2 && rates.coloured <= (spoilt == EFFECT ? 3 : 8));
    }
}

static void faulty_sensors(void **state)
{
    struct rates rates = over_seeds(100, 1, 0, FAULTS);
    (void)state;
    assert_true(fabs(rates.bias) < 1 && rates.misstated <= 2 && rates.coloured <= 6);
}

static void too_few_rows(void **state)
{
    struct noise_estimate e;
    double residual[70] = {1, -1}, one[70 * 12] = {0};
    (void)state;
    for (int i = 0; i < 70 * 12; i++)
        one[i] = sin(0.7 * i * (1 + i / 70));
    assert_status(noise_check(&test_pool, 59, 0, residual, one, &e), ROTID_OK);
    assert_false(e.usable);
    assert_status(noise_check(&test_pool, 70, 12, residual, one, &e), ROTID_OK);
    assert_false(e.usable);
    assert_status(noise_check(&test_pool, 70, 0, residual, one, &e), ROTID_OK);
    assert_true(e.usable && !e.coloured && isnan(e.smooth_factor));
}

static void without_memory(void **state)
{
    double residual[ROWS];
    struct noise_estimate e;
    struct random_stream random = {5};
    int status = ROTID_ERROR_MEMORY;
    (void)state;
    draw(&random, 1, 0, residual);
    for (long fail = 1; status == ROTID_ERROR_MEMORY; fail++) {
        struct failing_allocator failing;
        struct pool pool;
        assert_true(fail < 20);
        failing_allocator_open(&failing, fail);
        pool_open(&pool, &failing.allocator);
        status = noise_check(&pool, ROWS, COLUMNS, residual, column, &e);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_status(status, ROTID_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_level),    cmocka_unit_test(wrong_level),
        cmocka_unit_test(coloured_noise), cmocka_unit_test(hidden_effects),
        cmocka_unit_test(faulty_sensors), cmocka_unit_test_setup_teardown(too_few_rows, open_test_pool, close_test_pool),
        cmocka_unit_test(without_memory),
    };
    return cmocka_run_group_tests(tests, open_columns, NULL);
}
