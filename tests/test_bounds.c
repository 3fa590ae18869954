/* The bijection (30) between bounds, and the quantiles that intervals and tests take from. */
#include <float.h>

#include "fit/fit.h"
#include "support.h"

static const double chi = 0.05;

static rotid_parameter between(double lower, double upper)
{
    return (rotid_parameter){"x", "1", lower, upper, lower + 0.4 * (upper - lower)};
}

/* moduli, a range across zero, one below zero, one of few ulps of width beside its size, one across many decades */
static const double ranges[][2] = {{1e6, 2.3e11}, {-3, 5}, {-7, -2}, {1, 1 + 1e-9}, {1e-12, 1e12}, {0, 1}};
#define RANGES ((int)(sizeof ranges / sizeof *ranges))

UNIT_TEST(test_bijection_is_the_printed_formula)
{
    for (int k = 0; k < RANGES; k++) {
        rotid_parameter p = between(ranges[k][0], ranges[k][1]);
        for (double y = -200; y <= 200; y += 12.5)
            assert_close(bounds_to_x(&p, chi, y), p.lower + (p.upper - p.lower) / (1 + exp(chi * y)), 4e-16,
                         4e-16 * (p.upper - p.lower));
        assert_close(bounds_to_x(&p, chi, 0), p.lower + (p.upper - p.lower) / 2, 4e-16, 0);
    }
}

/* (31): alpha for y towards plus infinity, beta towards minus infinity; saturated, it is the bound itself */
UNIT_TEST(test_far_saturation_is_the_bound_without_overflow)
{
    static const double far[] = {1e5, 1e150, DBL_MAX, INFINITY};
    for (int k = 0; k < RANGES; k++) {
        rotid_parameter p = between(ranges[k][0], ranges[k][1]);
        for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
            assert_true(bounds_to_x(&p, chi, far[i]) == p.lower);
            assert_true(bounds_to_x(&p, chi, -far[i]) == p.upper);
            assert_close(bounds_slope(&p, chi, far[i]), 0, 0, 1e-25 * (p.upper - p.lower));
            assert_close(bounds_slope(&p, chi, -far[i]), 0, 0, 1e-25 * (p.upper - p.lower));
        }
        for (double y = -3000; y <= 3000; y += 7) {
            double x = bounds_to_x(&p, chi, y);
            assert_true(x >= p.lower && x <= p.upper);
            assert_true(bounds_slope(&p, chi, y) <= 0);
        }
    }
}

/* Near a bound the distance to it has lost digits to the subtraction: y is then known to eps |x| / (distance chi). */
UNIT_TEST(test_inverse_gives_back_what_went_in)
{
    for (int k = 0; k < RANGES; k++) {
        rotid_parameter p = between(ranges[k][0], ranges[k][1]);
        double largest = fmax(fabs(p.lower), fabs(p.upper));
        for (double y = -300; y <= 300; y += 10) {
            double x = bounds_to_x(&p, chi, y), distance = fmin(x - p.lower, p.upper - x);
            if (distance <= 4 * DBL_EPSILON * largest)
                continue;
            assert_close(bounds_to_y(&p, chi, x), y, 1e-14, 2 * DBL_EPSILON * largest / (distance * chi) + 1e-12);
        }
        for (int i = 1; i < 100; i++) {
            double x = p.lower + i / 100.0 * (p.upper - p.lower);
            assert_close(bounds_to_x(&p, chi, bounds_to_y(&p, chi, x)), x, 0,
                         1e-14 * (p.upper - p.lower) + 4 * DBL_EPSILON * largest);
        }
    }
}

UNIT_TEST(test_slope_is_the_derivative)
{
    rotid_parameter p = between(0, 1); /* from zero, x keeps its digits near the lower bound; the slope is even in y */
    for (double y = -300; y <= 300; y += 12.5) {
        double at = fabs(y), h = 0.05, difference = 0;
        static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
        for (int i = 0; i < 4; i++)
            difference += weight[i] * bounds_to_x(&p, chi, at + step[i] * h) / (12 * h);
        assert_close(bounds_slope(&p, chi, y), difference, 1e-10, 0);
        assert_true(bounds_slope(&p, chi, y) == bounds_slope(&p, chi, -y));
    }
    assert_close(bounds_slope(&p, chi, 0), -chi / 4, 1e-15, 0);
    rotid_parameter moduli = between(1e6, 2.3e11);
    assert_close(bounds_slope(&moduli, chi, 20), (2.3e11 - 1e6) * bounds_slope(&p, chi, 20), 1e-14, 0);
}

/* The paper applies (30) to variables scaled by their start: y is the same with and without. */
UNIT_TEST(test_scaling_by_the_start_leaves_y_alone)
{
    rotid_parameter p = between(1e6, 2.3e11), scaled = between(1e6 / 0.6e11, 2.3e11 / 0.6e11);
    for (double y = -200; y <= 200; y += 25)
        assert_close(bounds_to_x(&scaled, chi, y) * 0.6e11, bounds_to_x(&p, chi, y), 1e-15, 0);
}

/* A millionth of the interval; at the lower bound a small start must not look pressed only because the interval spans decades. */
UNIT_TEST(test_pressed_is_what_saturates)
{
    rotid_parameter p = {"x", "1", 10, 20, 14};
    assert_int_equal(bounds_pressed(&p, 20), 1);
    assert_int_equal(bounds_pressed(&p, 20 - 9e-6), 1);
    assert_int_equal(bounds_pressed(&p, 20 - 1.1e-5), 0);
    assert_int_equal(bounds_pressed(&p, 15), 0);
    assert_int_equal(bounds_pressed(&p, 10 + 1.1e-5), 0);
    assert_int_equal(bounds_pressed(&p, 10 + 9e-6), -1);
    assert_int_equal(bounds_pressed(&p, 10), -1);
    rotid_parameter spring = {"k", "N/m", 1, 1e12, 9790};
    assert_int_equal(bounds_pressed(&spring, 5000), 0);
    assert_int_equal(bounds_pressed(&spring, 1.5), -1);
    assert_int_equal(bounds_pressed(&spring, 1e12), 1);
    rotid_parameter density = {"rho", "kg/m3", 8600, 9000, 8600}; /* an extended deck starts where the fit ended */
    assert_int_equal(bounds_pressed(&density, 8600), -1);
    assert_int_equal(bounds_pressed(&density, 8600.001), 0);
    density.start = 8600.0000001;
    assert_int_equal(bounds_pressed(&density, 8600.0000001), -1);
}

UNIT_TEST(test_student_quantiles_agree_with_the_tables)
{
    /* scipy 1.17.1, scipy.stats.t.ppf(0.975, dof); the first digits are those of any printed table */
    static const struct {
        int dof;
        double t;
    } table[] = {{1, 12.706204736174694},   {2, 4.302652729749462},     {3, 3.1824463052837078},     {4, 2.7764451051977934},
                 {5, 2.5705818356363146},   {10, 2.228138851986274},    {30, 2.0422724563012378},    {100, 1.9839715185235518},
                 {406, 1.9658241784477395}, {1000, 1.9623390808264083}, {100000, 1.9599877075346095}};
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        assert_close(quantile_student_95(table[k].dof), table[k].t, 1e-10, 0);
    assert_close(quantile_student_95(0), 1.9599639845400545, 1e-15, 0);
    for (int dof = 1; dof < 300; dof++)
        assert_true(quantile_student_95(dof) > quantile_student_95(dof + 1));
}

UNIT_TEST(test_chi_square_tails_agree_with_the_tables)
{
    /* scipy 1.17.1, scipy.stats.chi2.sf(x, dof) */
    static const struct {
        double x;
        int dof;
        double tail;
    } table[] = {{3.841458820694124, 1, 0.05},   {18.307038053275146, 10, 0.05},    {406, 406, 0.49066632775011815},
                 {300, 406, 0.9999774970229296}, {500, 406, 0.0009780533342488447}, {1000, 406, 5.794843480901828e-52},
                 {1e-3, 1, 0.9747728793699604},  {40, 3, 1.065509033425585e-08},    {1400, 3, 2.945619361016289e-303}};
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        assert_close(chi_square_tail(table[k].x, table[k].dof), table[k].tail, 1e-11, 0);
}

/* dof 1: erfc(sqrt(x/2)); dof 2: exp(-x/2); dof 6: exp(-y)(1 + y + y^2/2), y = x/2 */
UNIT_TEST(test_chi_square_tails_agree_with_closed_forms)
{
    for (double x = 1e-6; x < 1300; x *= 1.3) {
        double y = x / 2;
        assert_close(chi_square_tail(x, 1), erfc(sqrt(y)), 1e-11, 0);
        assert_close(chi_square_tail(x, 2), exp(-y), 1e-11, 0);
        assert_close(chi_square_tail(x, 6), exp(-y) * (1 + y + y * y / 2), 1e-11, 0);
    }
}

UNIT_TEST(test_chi_square_tail_keeps_its_ends)
{
    assert_true(chi_square_tail(0, 5) == 1);
    assert_true(chi_square_tail(1e5, 5) == 0);
    assert_true(chi_square_tail(1e300, 406) == 0);
    assert_true(chi_square_tail(INFINITY, 406) == 0);
    assert_true(isnan(chi_square_tail(NAN, 406))); /* chi2 is NaN where no noise is stated: that is not a perfect fit */
    for (double x = 1; x < 800; x += 1)
        assert_true(chi_square_tail(x + 1, 406) <= chi_square_tail(x, 406));
}
