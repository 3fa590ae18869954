/* Identification from data whose truth is known: predictions of the full model, with and without noise. */
#include "paper_fit.h"
#include "support.h"

static const double truth[PAPER_MOST_PARAMETERS] = {1.157e11, 0.316e11, 7380.66, 150e3, 9790};

static void open_two(struct paper_fit *fit, int functional, int reduction, double frequency_std, double shape_std)
{
    paper_fit_open(fit, BUNDLE_TUBE);
    fit->options.functional = functional;
    fit->options.reduction = reduction;
    paper_synthesise(fit, truth, frequency_std, shape_std);
}

/* docs/method: condensed frequencies are up to 3.3 % high, and the moduli pay for it. */
UNIT_TEST(test_guyan_reduction_biases_the_moduli_and_the_full_model_does_not)
{
    static const double percent[3][2] = {{0, 0}, {0.9366, -9.616}, {0, 0}}, allowed[3] = {1e-6, 0.05, 0.05};
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++) {
        struct paper_fit fit;
        open_two(&fit, ROTID_HYBRID, reduction, 0, 0);
        rotid_fit_result *result = paper_run(&fit);
        assert_true(result->converged);
        print_message("reduction %d: E %+.3e %% G %+.3e %% objective %.3e evaluations %d\n", reduction,
                      100 * (result->x[0] / truth[0] - 1), 100 * (result->x[1] / truth[1] - 1), result->objective,
                      result->evaluations);
        for (int p = 0; p < 2; p++)
            assert_close(100 * (result->x[p] / truth[p] - 1), percent[reduction][p], 0, allowed[reduction]);
        rotid_fit_free(result);
        paper_fit_close(&fit);
    }
}

/* phi~ solves the condensed problem, so R* of (15) is its eigenvalue whatever phi^ is: 30 % noise on the shapes changes nothing,
 * by either derivative of the vectors. */
UNIT_TEST(test_hybrid_quotient_carries_no_shape_information)
{
    struct random_stream stream = {1};
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++)
        for (int derivative = ROTID_NELSON; derivative <= ROTID_MODAL; derivative++) {
            struct paper_fit fit;
            if (reduction == ROTID_REDUCTION_NONE && derivative == ROTID_MODAL)
                continue;
            open_two(&fit, ROTID_HYBRID, reduction, 0, 0.3);
            memcpy(fit.frequency_hz, paper_measured_hz, sizeof fit.frequency_hz);
            for (int i = 0; i < PAPER_SENSORS * PAPER_MODES; i++)
                fit.shape[i] += 0.3 * random_normal(&stream);
            fit.options.derivative = derivative;
            rotid_fit_result *with = paper_run(&fit);
            fit.measured.shape = NULL;
            rotid_fit_result *without = paper_run(&fit);
            assert_true(with->converged && without->converged);
            for (int p = 0; p < 2; p++)
                assert_close(with->x[p], without->x[p], 1e-7, 0);
            assert_close(with->objective, without->objective, 1e-9, 0);
            for (int k = 0; k < PAPER_MODES; k++)
                assert_true(with->mac[k] > 0.1 && with->mac[k] < 0.9); /* these shapes are bad */
            rotid_fit_free(with);
            rotid_fit_free(without);
            paper_fit_close(&fit);
        }
}

/* The scale and sign of a measured shape are free, and a sensor may be missing. */
UNIT_TEST(test_scale_sign_and_gaps_of_the_shapes_do_not_matter)
{
    struct paper_fit fit;
    open_two(&fit, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, 1e-3, 0.015);
    rotid_fit_result *plain = paper_run(&fit);
    for (int i = 0; i < PAPER_SENSORS * PAPER_MODES; i++)
        fit.shape[i] *= i / PAPER_SENSORS % 2 ? -3e-7 : 2e4;
    fit.shape[5] = fit.shape[6] = fit.shape[3 * PAPER_SENSORS + 40] = NAN;
    rotid_fit_result *other = paper_run(&fit);
    assert_true(plain->converged && other->converged);
    assert_int_equal(other->nresidual, plain->nresidual - 3);
    assert_int_equal(other->dof, plain->dof - 3);
    assert_int_equal(plain->dof, PAPER_MODES * (1 + PAPER_SENSORS) - 2 - PAPER_MODES);
    for (int p = 0; p < 2; p++) {
        assert_close(plain->x[p], truth[p], 1e-8, 0);
        assert_close(other->x[p], truth[p], 1e-8, 0);
        assert_close(other->std[p], plain->std[p], 0.05, 0);
    }
    for (int k = 0; k < PAPER_MODES; k++)
        assert_close(other->mac[k], 1, 1e-10, 0);
    rotid_fit_free(plain);
    rotid_fit_free(other);
    paper_fit_close(&fit);
}

static void open_five(struct paper_fit *fit, int functional, double frequency_std, double shape_std)
{
    static const struct parameter five[] = {{PARAMETER_E, 1, 0, 0, NULL},
                                            {PARAMETER_G, 1, 0, 0, NULL},
                                            {PARAMETER_RHO, 1, 0, 0, NULL},
                                            {PARAMETER_TENSION, 0, 0, 0, NULL},
                                            {PARAMETER_SPRING_K, 0, 0, 0, NULL}};
    paper_fit_open_rotor(fit, paper_rotor(BUNDLE_TUBE, 1), 5, five);
    fit->parameter[0] = (rotid_parameter){"core.E", "Pa", 1e9, 2.3e11, 0.9e11};
    fit->parameter[1] = (rotid_parameter){"core.G", "Pa", 1e9, 0.898e11, 0.25e11};
    fit->parameter[2] = (rotid_parameter){"core.rho", "kg/m3", 5000, 9000, 7000};
    fit->parameter[3] = (rotid_parameter){"ties.tension", "N", 1e4, 5e5, 1e5};
    fit->parameter[4] = (rotid_parameter){"left.k", "N/m", 1e3, 1e5, 2e4};
    fit->options.functional = functional;
    fit->options.reduction = ROTID_REDUCTION_NONE;
    paper_synthesise(fit, truth, frequency_std, shape_std);
}

static int has_direction(const rotid_fit_result *result, int p)
{
    for (int j = 0; j < result->n; j++)
        if (result->direction_undetermined[j] && fabs(result->direction[p + j * result->n]) > 0.9)
            return 1;
    return 0;
}

/* Noise of 0.1 % and 1.5 % leaves the tension and the sling to chance: their values come out right without noise, and are said to
 * mean nothing. */
UNIT_TEST(test_five_parameters_are_found_and_the_undetermined_ones_named)
{
    struct paper_fit fit;
    open_five(&fit, ROTID_LIKELIHOOD, 1e-3, 0.015);
    rotid_fit_result *result = paper_run(&fit);
    for (int p = 0; p < 5; p++)
        print_message("%-13s %.10g off by %+.1e, std %.1e of it%s%s\n", fit.parameter[p].name, result->x[p],
                      result->x[p] / truth[p] - 1, result->std[p] / result->x[p],
                      result->identifiable[p] ? "" : ", not identifiable", result->at_bound[p] ? ", at a bound" : "");
    print_message("evaluations %d, condition number %.2e\n", result->evaluations, result->condition_number);
    assert_true(result->converged && !result->any_at_bound && result->any_undetermined);
    for (int p = 0; p < 3; p++) {
        assert_close(result->x[p], truth[p], 1e-6, 0);
        assert_true(result->identifiable[p] && result->std[p] < 0.02 * result->x[p] && !has_direction(result, p));
    }
    for (int p = 3; p < 5; p++) {
        assert_true(!result->identifiable[p] && has_direction(result, p));
        assert_true(result->std[p] > result->x[p]); /* the interval is stated, and is as wide as it is */
    }
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* Six exact frequencies determine five parameters. */
UNIT_TEST(test_five_parameters_are_found_from_exact_frequencies)
{
    for (int functional = ROTID_HYBRID; functional <= ROTID_HYBRID_F; functional++) {
        struct paper_fit fit;
        open_five(&fit, functional, 0, 0);
        rotid_fit_result *result = paper_run(&fit);
        assert_true(result->converged && !result->any_at_bound && result->dof == 1);
        for (int p = 0; p < 5; p++)
            assert_close(result->x[p], truth[p], p < 3 ? 1e-6 : 1e-4, 0);
        rotid_fit_free(result);
        paper_fit_close(&fit);
    }
}

struct tally {
    int covered[2];
    double square[2], chi2_per_dof;
};

/* One noisy replicate; `fit` keeps the noise-free data it starts from. */
static void replicate(struct paper_fit *fit, struct random_stream *stream, double frequency_std, double shape_std,
                      struct tally *tally)
{
    double frequency_hz[PAPER_MODES], shape[PAPER_SENSORS * PAPER_MODES];
    memcpy(frequency_hz, fit->frequency_hz, sizeof frequency_hz);
    memcpy(shape, fit->shape, sizeof shape);
    for (int k = 0; k < PAPER_MODES; k++)
        fit->frequency_hz[k] *= 1 + frequency_std * random_normal(stream);
    for (int i = 0; i < PAPER_SENSORS * PAPER_MODES; i++)
        fit->shape[i] += shape_std * random_normal(stream);
    rotid_fit_result *result = paper_run(fit);
    assert_true(result->converged);
    for (int p = 0; p < 2; p++) {
        double t = (result->x[p] - truth[p]) / result->std[p];
        tally->covered[p] += result->ci_lower[p] <= truth[p] && truth[p] <= result->ci_upper[p];
        tally->square[p] += t * t;
    }
    tally->chi2_per_dof += result->chi2_per_dof;
    rotid_fit_free(result);
    memcpy(fit->frequency_hz, frequency_hz, sizeof frequency_hz);
    memcpy(fit->shape, shape, sizeof shape);
}

/* 40 replicates: 95 % intervals cover 38 on average, and fewer than 33 in less than one of 2000 such tests. */
static void check_coverage(const char *text, struct paper_fit *fit, double shape_std, uint64_t seed, struct tally *tally)
{
    enum { REPLICATES = 40 };
    struct random_stream stream = {seed};
    *tally = (struct tally){{0}, {0}, 0};
    for (int k = 0; k < REPLICATES; k++)
        replicate(fit, &stream, 1e-3, shape_std, tally);
    print_message(
        "%s, seed %d: E covered %d, G covered %d of %d; mean square of the error over its std %.2f, %.2f; chi2 per dof %.4f\n",
        text, (int)seed, tally->covered[0], tally->covered[1], REPLICATES, tally->square[0] / REPLICATES,
        tally->square[1] / REPLICATES, tally->chi2_per_dof / REPLICATES);
    for (int p = 0; p < 2; p++)
        assert_true(tally->covered[p] >= 33);
    tally->chi2_per_dof /= REPLICATES;
    for (int p = 0; p < 2; p++)
        tally->square[p] /= REPLICATES;
}

UNIT_TEST(test_likelihood_intervals_cover_the_truth)
{
    struct paper_fit fit;
    struct tally tally;
    open_two(&fit, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, 1e-3, 0.015);
    check_coverage("LIKELIHOOD", &fit, 0.015, 11, &tally);
    /* 40 times 406 degrees of freedom: 1 +- 0.011, less what noise adds to the component by which a mode is divided */
    assert_close(tally.chi2_per_dof, 1, 0, 0.06);
    for (int p = 0; p < 2; p++) /* a mean of 40 squares of mean 1 and variance 2; intervals twice too wide would have 0.25 */
        assert_true(tally.square[p] > 0.45 && tally.square[p] < 1.9);
    paper_fit_close(&fit);
}

UNIT_TEST(test_hybrid_intervals_cover_the_truth_with_known_and_unknown_noise)
{
    struct paper_fit fit;
    struct tally tally;
    open_two(&fit, ROTID_HYBRID, ROTID_REDUCTION_NONE, 1e-3, 0);
    check_coverage("HYBRID, noise stated", &fit, 0, 12, &tally);
    for (int p = 0; p < 2; p++)
        assert_true(tally.square[p] > 0.4 && tally.square[p] < 1.9);
    assert_close(tally.chi2_per_dof, 1, 0, 0.4); /* 160 degrees of freedom: 1 +- 0.11 */
    fit.measured.frequency_std = NULL;
    check_coverage("HYBRID, noise from the residuals", &fit, 0, 13, &tally);
    paper_fit_close(&fit);
}
