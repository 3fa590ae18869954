/* The modal model on a choice of lines: sums of partial fractions against the columns themselves, derivatives by the poles. */
#include "ema/ema.h"
#include "support.h"

#define LINES    400
#define CHANNELS 3
#define MODES    6
#define CASES    200

static const double low = 0.6, high = 1.5; /* of the lines, rad/s */

struct case_of_poles {
    int nmode;
    double complex pole[MODES];
};

static double between(struct random_stream *random, double from, double to)
{
    return from + (to - from) * random_uniform(random);
}

/* Three modes in the band and up to three guards anywhere, a third of them close to another pole or hardly damped. */
static void draw(struct random_stream *random, struct case_of_poles *drawn)
{
    drawn->nmode = 3 + (int)(4 * random_uniform(random));
    for (int r = 0; r < drawn->nmode; r++) {
        double omega = r < 3 ? between(random, low, high) : between(random, 0.01, 2 * high);
        double damping = pow(10, between(random, r < 3 ? -3.5 : -5.5, -1.2));
        drawn->pole[r] = CMPLX(-damping * omega, omega);
        if (r >= 3 && random_uniform(random) < 0.33)
            drawn->pole[r] = drawn->pole[0] + between(random, 0.2, 3) * creal(drawn->pole[0]) * CMPLX(0.3, 1);
    }
}

static double complex receptance(const struct case_of_poles *drawn, int c, double nu)
{
    double complex h = 0;
    for (int r = 0; r < drawn->nmode; r++) {
        double complex a = CMPLX(0.1 * (c + 1), 1 + 0.3 * r * (c - 1)) * (r < 3 ? 1 : 1e-3);
        h += a / (CMPLX(0, nu) - drawn->pole[r]) + conj(a) / (CMPLX(0, nu) - conj(drawn->pole[r]));
    }
    return -nu * nu * h + 0.2;
}

static void measure(const struct case_of_poles *drawn, struct random_stream *random, struct ema_band *band)
{
    static double omega[LINES], variance[LINES * CHANNELS];
    static double complex h[LINES * CHANNELS];
    for (int i = 0; i < LINES; i++)
        omega[i] = low + (high - low) * i / (LINES - 1);
    for (int c = 0; c < CHANNELS; c++)
        for (int i = 0; i < LINES; i++) {
            double std = 1e-3 * (1 + 0.5 * c + 0.5 * sin(9 * omega[i]));
            variance[i + c * LINES] = 2 * std * std;
            h[i + c * LINES] = receptance(drawn, c, omega[i]) + CMPLX(std * random_normal(random), std * random_normal(random));
        }
    *band = (struct ema_band){
        .nline = LINES, .low = low, .high = high, .omega = omega, .nchannel = CHANNELS, .h = h, .variance = variance};
}

static const int *all_lines(void)
{
    static int line[LINES];
    for (int i = 0; i < LINES; i++)
        line[i] = i;
    return line;
}

static void open_fit(const struct ema_band *band, int from, int channels, const struct case_of_poles *drawn,
                     struct modal_fit *fit)
{
    assert_int_equal(modal_fit_new(&test_pool, band, LINES, all_lines(), from, channels, drawn->nmode, 1, fit), ROTID_OK);
    for (int r = 0; r < drawn->nmode; r++)
        fit->pole[r] = drawn->pole[r] / fit->scale * CMPLX(1, 1e-5 * (r + 1));
}

#define MOST (4 * MODES + 5)
/* The information of one channel in long double, by orthogonal columns: schur [p * p] */
static void exact_schur(const struct modal_fit *fit, int c, double *schur)
{
    static long double column[MOST][2 * LINES];
    int q = fit->nlinear, p = 2 * fit->nmode;
    const double *x = fit->linear + (ptrdiff_t)c * q;
    for (int i = 0; i < LINES; i++) {
        long double nu = fit->nu[i], w = fit->weight[i + (ptrdiff_t)c * LINES], square = -nu * nu;
        long double value[MOST][2];
        for (int r = 0; r < fit->nmode; r++) {
            long double complex pole = fit->pole[r], g = 1 / (CMPLXL(0, nu) - pole), mirror = 1 / (CMPLXL(0, nu) - conjl(pole));
            long double complex a = CMPLXL(x[2 * r], x[2 * r + 1]), s = square;
            long double complex f[4] = {s * (g + mirror), s * I * (g - mirror), s * (a * g * g + conjl(a) * mirror * mirror),
                                        s * I * (a * g * g - conjl(a) * mirror * mirror)};
            for (int k = 0; k < 4; k++) {
                int j = (k < 2 ? 0 : q) + 2 * r + k % 2;
                value[j][0] = creall(f[k]);
                value[j][1] = cimagl(f[k]);
            }
        }
        long double rest[4][2] = {{1, 0}, {0, 1}, {square, 0}, {0, square}};
        for (int k = 0; k < 4; k++)
            for (int part = 0; part < 2; part++)
                value[2 * fit->nmode + k][part] = rest[k][part];
        for (int j = 0; j < q + p; j++)
            for (int part = 0; part < 2; part++)
                column[j][2 * i + part] = w * value[j][part];
    }
    for (int twice = 0; twice < 2; twice++)
        for (int j = 0; j < q; j++) {
            for (int k = 0; k < j; k++) {
                long double dot = 0;
                for (int i = 0; i < 2 * LINES; i++)
                    dot += column[k][i] * column[j][i];
                for (int i = 0; i < 2 * LINES; i++)
                    column[j][i] -= dot * column[k][i];
            }
            long double norm = 0;
            for (int i = 0; i < 2 * LINES; i++)
                norm += column[j][i] * column[j][i];
            for (int i = 0; i < 2 * LINES; i++)
                column[j][i] /= sqrtl(norm);
        }
    for (int twice = 0; twice < 2; twice++)
        for (int j = q; j < q + p; j++)
            for (int k = 0; k < q; k++) {
                long double dot = 0;
                for (int i = 0; i < 2 * LINES; i++)
                    dot += column[k][i] * column[j][i];
                for (int i = 0; i < 2 * LINES; i++)
                    column[j][i] -= dot * column[k][i];
            }
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++) {
            long double dot = 0;
            for (int i = 0; i < 2 * LINES; i++)
                dot += column[q + j][i] * column[q + k][i];
            schur[j + (ptrdiff_t)k * p] = (double)dot;
        }
}

static double off(int p, const double *schur, const double *exact)
{
    double worst = 0;
    for (int j = 0; j < p; j++)
        for (int i = 0; i < p; i++)
            worst = fmax(worst, fabs(schur[i + j * p] - exact[i + j * p]) / sqrt(exact[i + i * p] * exact[j + j * p]));
    return worst;
}

static double signal(const struct modal_fit *one)
{
    double sum = 0;
    for (int i = 0; i < 2 * LINES; i++)
        sum += pow(one->weight[i % LINES] * one->y[i], 2);
    return sum;
}

/* Sums and products round alike: an information that both lose, as that of a guard far from the lines, is no mark of either. */
UNIT_TEST(sums_of_fractions_are_the_products_of_the_columns)
{
    struct random_stream random = {.state = 5};
    int told = 0, pairs = 0;
    for (int k = 0; k < CASES; k++) {
        struct case_of_poles drawn;
        struct ema_band band;
        struct modal_fit all, one;
        double exact[4 * MODES * MODES];
        draw(&random, &drawn);
        measure(&drawn, &random, &band);
        open_fit(&band, 0, CHANNELS, &drawn, &all);
        int p = 2 * drawn.nmode;
        (void)modal_fit_evaluate(&all, MODAL_FIT_POLES);
        assert_int_equal(modal_gram_fill(&all.summed, all.nu, all.pole, all.basis), 0);
        pairs += all.summed.nclose;
        for (int c = 0; c < CHANNELS; c++) {
            open_fit(&band, c, 1, &drawn, &one); /* one channel is fitted by products */
            (void)modal_fit_evaluate(&one, MODAL_FIT_POLES);
            assert_int_equal(all.singular[c], one.singular[0]);
            const double *score = all.score + (ptrdiff_t)c * p;
            exact_schur(&one, 0, exact);
            double products = off(p, one.schur, exact);
            exact_schur(&all, c, exact);
            assert_true(off(p, all.schur + (ptrdiff_t)c * p * p, exact) < 20 * products + 1e-12);
            if (products > 1e-6)
                continue;
            told++;
            /* of products the difference of two large sums */
            assert_close(all.chi2[c], one.chi2[0], 1e-9, 1e-13 * signal(&one));
            for (int j = 0; j < p; j++)
                assert_close(score[j], one.score[j], 0, 1e-4 * sqrt(exact[j + j * p]));
        }
    }
    print_message("%d of %d channels told to 1e-6, %d close pairs\n", told, CASES * CHANNELS, pairs);
    assert_true(told > 2 * CASES && pairs > CASES / 2);
}

/* An undamped pole has no partial fractions of finite sums: the products of the columns serve. */
UNIT_TEST(a_pole_on_the_axis_is_left_to_the_products)
{
    struct random_stream random = {.state = 6};
    struct case_of_poles drawn;
    struct ema_band band;
    struct modal_fit all;
    draw(&random, &drawn);
    measure(&drawn, &random, &band);
    open_fit(&band, 0, CHANNELS, &drawn, &all);
    all.pole[0] = CMPLX(0, cimag(all.pole[0]));
    assert_int_equal(modal_gram_fill(&all.summed, all.nu, all.pole, all.basis), 1);
}

/* A guard far below the lines whose own information is lost in rounding: the modes have the standard deviations that they have
 * where it is held. */
UNIT_TEST(a_guard_whose_information_is_lost_leaves_the_modes_theirs)
{
    double std[2][6];
    for (int held = 0; held < 2; held++) {
        struct random_stream random = {.state = 8};
        struct case_of_poles drawn;
        struct ema_band band;
        struct modal_fit fit;
        struct refinement refinement;
        draw(&random, &drawn);
        drawn.nmode = 4;
        drawn.pole[3] = CMPLX(-1e-6, 1e-4);
        measure(&drawn, &random, &band);
        assert_int_equal(
            refinement_open(&test_pool, &band, LINES, all_lines(), 0, CHANNELS, drawn.nmode, drawn.pole, 1, &fit, &refinement),
            ROTID_OK);
        fit.held[3] = held;
        assert_int_equal(refine_poles(&fit, 0, NULL, &refinement), ROTID_OK);
        for (int j = 0; j < 6; j++)
            std[held][j] = sqrt(refinement.covariance[j + j * 2 * drawn.nmode]);
    }
    for (int j = 0; j < 6; j++)
        assert_close(std[0][j], std[1][j], 1e-9, 0);
}

/* An undamped guard just below the lines and another one further off wander on where rounding refuses their steps, as beside
 * clean measurements whose band begins where nothing is: the modes are known as well as they say long before. Modes that are
 * still on their way are not. */
UNIT_TEST(convergence_waits_for_the_modes_and_not_for_guards)
{
    int wandering = 0, told = 0, early = 0;
    for (int k = 0; k < 50; k++) {
        struct random_stream random = {.state = (uint64_t)(100 + k)};
        struct case_of_poles drawn = {.nmode = 5};
        struct ema_band band;
        struct modal_fit fit;
        struct refinement refinement;
        for (int r = 0; r < 3; r++)
            drawn.pole[r] = (0.75 + 0.25 * r) * CMPLX(-4e-3, 1);
        drawn.pole[3] = CMPLX(-between(&random, 0, 1e-9), between(&random, 0.58, low));
        drawn.pole[4] = between(&random, 0.1, 0.5) * CMPLX(-between(&random, 0.01, 1), 1);
        measure(&drawn, &random, &band);
        double complex start[5] = {drawn.pole[0], drawn.pole[1], drawn.pole[2], CMPLX(-1e-3, 0.59), 1.2 * drawn.pole[4]};
        for (int most = 1; most <= 40; most += 39) {
            for (int r = 0; r < 3; r++)
                start[r] = drawn.pole[r] * (1 + (most == 1 ? 0.01 : 0));
            assert_int_equal(refinement_open(&test_pool, &band, LINES, all_lines(), 0, CHANNELS, 5, start, 1, &fit, &refinement),
                             ROTID_OK);
            fit.loose[3] = fit.loose[4] = 1;
            assert_int_equal(refine_poles(&fit, most, NULL, &refinement), ROTID_OK);
            early += most == 1 && refinement.converged;
        }
        wandering += refinement.iterations >= 26;
        told += refinement.converged;
        for (int j = 0; j < 6 && refinement.converged; j++) {
            double complex error = fit.pole[j / 2] - drawn.pole[j / 2] / fit.scale;
            assert_true(fabs(j % 2 ? cimag(error) : creal(error)) < 4.5 * sqrt(refinement.covariance[j + j * 10]));
        }
    }
    print_message("%d of 50 told, the guards of %d wander on\n", told, wandering);
    assert_true(wandering > 20 && told >= 45 && !early);
}

/* d chi2/d pole = -2 score and its second derivative 2 schur where the residual is noise alone, by central differences. */
UNIT_TEST(the_score_is_the_slope_of_chi2)
{
    struct random_stream random = {.state = 7};
    for (int k = 0; k < 20; k++) {
        struct case_of_poles drawn;
        struct ema_band band;
        struct modal_fit fit;
        draw(&random, &drawn);
        drawn.nmode = 3;
        measure(&drawn, &random, &band);
        open_fit(&band, 0, CHANNELS, &drawn, &fit);
        int p = 2 * drawn.nmode;
        (void)modal_fit_evaluate(&fit, MODAL_FIT_POLES);
        for (int j = 0; j < p; j++) {
            double score = 0, curvature = 0, side[2];
            for (int c = 0; c < CHANNELS; c++) {
                score += fit.score[j + (ptrdiff_t)c * p];
                curvature += fit.schur[j + (ptrdiff_t)j * p + (ptrdiff_t)c * p * p];
            }
            double complex at = fit.pole[j / 2], step = 1e-5 * creal(at) * (j % 2 ? I : 1);
            for (int up = 0; up < 2; up++) {
                fit.pole[j / 2] = at + (up ? step : -step);
                side[up] = modal_fit_evaluate(&fit, MODAL_FIT_LINEAR);
            }
            fit.pole[j / 2] = at;
            double slope = (side[1] - side[0]) / (2 * (creal(step) + cimag(step)));
            assert_close(slope, -2 * score, 1e-4, 1e-3 * sqrt(curvature));
            (void)modal_fit_evaluate(&fit, MODAL_FIT_POLES);
        }
    }
}

TEST_GROUP(open_test_pool, close_test_pool);
