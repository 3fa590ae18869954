/* Bounds, starts and arguments of rotid_fit on the paper's rotor: what presses against a bound says so, what only passed near one
 * does not stay there, and what cannot be fitted is refused. */
#include "paper_fit.h"
#include "support.h"

/* A short end whose E hardly shifts the frequencies: towards the bound there is less to gain than rounding of f, and the
 * minimiser stalls up to 1e-3 of the interval short of it. Whether it came as far as the bound was chance. */
UNIT_TEST(test_minimum_at_a_bound_is_found_where_f_hardly_falls_towards_it)
{
    static const double starts[] = {0.5e11, 1e11, 1.389e11, 2e11, 4e11};
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        char text[1000];
        rotid_deck *deck;
        rotid_identification *found;
        (void)snprintf(
            text, sizeof text,
            "*MATERIAL, NAME=m\n*ELASTIC, TYPE=SHEAR\n1.389e11, 6.231e10, 0.2493\n*DENSITY\n6743\n*SPRING\n"
            "1.314, 2.897e6\n*SPRING\n1.359, 3.28e7\n*MODES, COUNT=ALL\n1, 1.881, 0.01, 0.001882\n"
            "3, 270.8, 0.01, 0.2705\n4, 298.7, 0.01, 0.2993\n*IDENTIFY\nend.E, 2.778e10, 6.946e11, %.4g\n"
            "left.E, 2.778e10, 6.946e11, 1.389e11\n*SHAFT, NAME=left, MATERIAL=m\n0.3924, 0.08645, 0, 6, 0.06952\n"
            "0.3186, 0.1048, 0, 5\n0.4326, 0.04113, 0.0077, 2\n*SHAFT, NAME=middle, MATERIAL=m\n"
            "0.1709, 0.06741, 0, 6\n*SHAFT, NAME=end, MATERIAL=m\n0.09611, 0.04217, 0, 4\n*FIT, FUNCTIONAL=LIKELIHOOD\n",
            starts[i]);
        assert_status(rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
        assert_status(rotid_identify(deck, 0, NULL, NULL, &found), ROTID_OK);
        const rotid_fit_result *fit = found->fit;
        print_message("from %g: %.10g, %s, %d iterations\n", starts[i], fit->x[0], rotid_status_name(fit->status),
                      fit->iterations);
        assert_true(fit->converged && fit->at_bound[0] && fit->nhistory == fit->iterations + 1);
        assert_int_equal(fit->history[fit->nhistory - 1].iteration, fit->iterations);
        rotid_identification_free(found);
        rotid_deck_free(deck);
    }
}

/* With one modulus held at a bound the other is found by golden section on an objective of our own. */
UNIT_TEST(test_optimum_beyond_a_bound_is_pressed_against_it_and_constrained_otherwise)
{
    static const struct {
        int p;
        double lower, upper, start;
    } cases[] = {{0, 1e6, 1.0e11, 0.6e11},
                 {0, 1e6, 1.15e11, 0.6e11},
                 {0, 1.2e11, 2.3e11, 2e11},
                 {1, 0.35e11, 0.898e11, 0.5e11},
                 {1, 1e6, 0.25e11, 0.1e11}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        int p = cases[c].p, other = 1 - p;
        struct paper_fit fit;
        paper_fit_open(&fit, BUNDLE_TUBE);
        fit.parameter[p].lower = cases[c].lower;
        fit.parameter[p].upper = cases[c].upper;
        fit.parameter[p].start = cases[c].start;
        double bound = scipy_optimum[p] > cases[c].upper ? cases[c].upper : cases[c].lower, x[2], gradient[2];
        rotid_fit_result *result = paper_run(&fit);
        print_message("%s held at %.3e: other %.8e objective %.10g %s evaluations %d\n", fit.parameter[p].name, bound,
                      result->x[other], result->objective, rotid_status_name(result->status), result->evaluations);
        assert_true(result->converged && result->any_at_bound && result->at_bound[p] && !result->at_bound[other]);
        assert_close(result->x[p], bound, 1e-6, 0);
        assert_true(!result->identifiable[p] && isnan(result->std[p]) && isfinite(result->std[other]));
        memcpy(x, result->x, sizeof x);
        x[p] = bound;
        assert_close(result->x[other], paper_line_minimum(&fit, x, other, 0.7 * x[other], 1.4 * x[other]), 2e-6, 0);
        (void)paper_gradient(&fit, result->x, gradient); /* f falls beyond the bound, and along it not at all */
        assert_true(bound == cases[c].upper ? gradient[p] < -1e-5 : gradient[p] > 1e-5);
        assert_close(gradient[other], 0, 0, 1e-6);
        rotid_fit_free(result);
        paper_fit_close(&fit);
    }
}

/* 5e5 N/m is within a millionth of an interval up to 1e12, and two hundredths of a start at 1e8: what the data know to 20 % is
 * none the less no bound. The frequencies are those of `rotid modes`, with errors of 5e-5. */
UNIT_TEST(test_what_the_data_know_is_not_pressed_against_a_bound_of_a_wide_interval)
{
    static const char text[] =
        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, 20\n*SPRING, "
        "NAME=p\n0.2, 5e5\n*SPRING\n0.8, 1e6\n*MODES\n1, 228.93, 1e-3\n2, 624.24, 1e-3\n3, 1203.2, 1e-3\n*NOISE, "
        "FREQUENCY=1e-4\n*FIT, FUNCTIONAL=LIKELIHOOD\n*IDENTIFY\np.k, 0, 1e12, 1e8\n";
    rotid_deck *deck;
    rotid_identification *found;
    assert_status(rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_identify(deck, 0, NULL, NULL, &found), ROTID_OK);
    const rotid_fit_result *fit = found->fit;
    assert_true(fit->converged && !fit->at_bound[0]);
    assert_in_range(fit->std[0], 4e4, 8e4);
    assert_true(fabs(fit->x[0] - 5e5) < 2 * fit->std[0]);
    rotid_identification_free(found);
    rotid_deck_free(deck);
}

static void check_minimum(struct paper_fit *fit, const char *text)
{
    rotid_fit_result *result = NULL;
    int status = rotid_fit(&fit->client.equations, fit->parameter, &fit->measured, &fit->options, NULL, NULL, &result);
    if (status || !result->converged || fabs(result->x[0] / scipy_optimum[0] - 1) > 1e-6)
        print_error("%s: from E %.3e G %.3e %s, objective %.6g instead of %.6g, %s\n", text, fit->parameter[0].start,
                    fit->parameter[1].start, rotid_status_name(status), status ? NAN : result->objective, scipy_objective,
                    status                 ? "no result"
                    : !result->converged   ? "said not to be converged"
                    : result->any_at_bound ? "said to be converged, at a bound"
                                           : "said to be converged");
    assert_status(status, ROTID_OK);
    assert_true(result->converged && !result->any_at_bound);
    assert_close(result->x[0], scipy_optimum[0], 1e-6, 0);
    assert_close(result->x[1], scipy_optimum[1], 1e-6, 0);
    rotid_fit_free(result);
}

/* A first step that saturates the sigmoid leaves the Jacobian without that column: the parameter would be caught at a bound
 * towards which nothing presses it. */
UNIT_TEST(test_starts_all_over_the_interval_reach_the_one_minimum)
{
    static const double part[] = {0.01, 0.1, 0.5, 0.9, 0.99};
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            fit.parameter[0].start = fit.parameter[0].lower + part[i] * (fit.parameter[0].upper - fit.parameter[0].lower);
            fit.parameter[1].start = fit.parameter[1].lower + part[j] * (fit.parameter[1].upper - fit.parameter[1].lower);
            check_minimum(&fit, "interval");
        }
    paper_fit_close(&fit);
}

/* Between a thousandth of the interval and the same from the other end, evenly in y. */
UNIT_TEST(test_random_starts_near_and_far_from_the_bounds_reach_the_minimum)
{
    struct random_stream stream = {7};
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (int k = 0; k < 20; k++) {
        for (int p = 0; p < 2; p++)
            fit.parameter[p].start = fit.parameter[p].lower + (fit.parameter[p].upper - fit.parameter[p].lower) /
                                                                  (1 + exp(14 * (random_uniform(&stream) - 0.5)));
        check_minimum(&fit, "random, seed 7");
    }
    paper_fit_close(&fit);
}

/* G is where it has to be for an E at its upper bound; E starts next to that bound and one step cannot bring it away. */
UNIT_TEST(test_parameter_that_a_bound_only_holds_back_is_not_converged)
{
    struct paper_fit fit;
    double gradient[2];
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.parameter[0].start = fit.parameter[0].upper - 1;
    fit.parameter[1].start = 2.04831169e10;
    fit.options.max_iterations = 1;
    rotid_fit_result *result = paper_run(&fit);
    (void)paper_gradient(&fit, result->x, gradient);
    assert_true(result->at_bound[0] && gradient[0] > 0.01 && fabs(gradient[1]) < 1e-6); /* f falls towards a smaller E */
    assert_true(!result->converged);
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* Whatever the start and the limit: `converged` means that no move within the bounds lowers the objective. */
UNIT_TEST(test_converged_is_never_said_where_the_objective_falls_towards_the_inside)
{
    static const double part[] = {1e-9, 1e-6, 1e-3, 0.3, 1 - 1e-6};
    int said = 0, runs = 0;
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            fit.parameter[0].start = fit.parameter[0].lower + part[i] * (fit.parameter[0].upper - fit.parameter[0].lower);
            fit.parameter[1].start = fit.parameter[1].lower + part[j] * (fit.parameter[1].upper - fit.parameter[1].lower);
            for (int limit = 1; limit <= 100; limit *= 10) {
                fit.options.max_iterations = limit;
                rotid_fit_result *result = paper_run(&fit);
                runs += limit == 100;
                said += result->converged && limit == 100;
                if (result->converged)
                    assert_close(result->objective, scipy_objective, 1e-6, 0);
                rotid_fit_free(result);
            }
        }
    print_message("starts within 1e-9 of the bounds: %d of %d converged\n", said, runs);
    assert_true(said >= 3 * runs / 4);
    paper_fit_close(&fit);
}

static void refused(struct paper_fit *fit, const char *expected)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_fit_result *result = (void *)fit;
    int status = rotid_fit(&fit->client.equations, fit->parameter, &fit->measured, &fit->options, NULL, failure, &result);
    assert_string_equal(rotid_status_name(status), expected);
    assert_true(status != ROTID_ERROR_ARGUMENT || strstr(failure, "expected")); /* which one, and what of it */
    assert_null(result);
}

UNIT_TEST(test_bounds_and_starts_that_make_no_sense_are_refused)
{
    /* lower, upper, start */
    static const double bad[][3] = {{1e6, 2e11, 3e11},  {1e6, 2e11, 1e5},        {1e6, 2e11, 1e6},      {1e6, 2e11, 2e11},
                                    {2e11, 1e6, 1e11},  {1e11, 1e11, 1e11},      {NAN, 2e11, 1e11},     {1e6, NAN, 1e11},
                                    {1e6, 2e11, NAN},   {-INFINITY, 2e11, 1e11}, {1e6, INFINITY, 1e11}, {-1e11, 1e11, 0},
                                    {-1e308, 1e308, 1}, {0, 10, 5e-324}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        for (int p = 0; p < 2; p++) {
            struct paper_fit fit;
            paper_fit_open(&fit, BUNDLE_TUBE);
            fit.parameter[p] = (rotid_parameter){"x", "Pa", bad[k][0], bad[k][1], bad[k][2]};
            refused(&fit, "ROTID_ERROR_ARGUMENT");
            paper_fit_close(&fit);
        }
}

UNIT_TEST(test_measured_data_that_make_no_sense_are_refused)
{
    struct paper_fit fit;
    static const double bad_hz[] = {0, -1, NAN, INFINITY};
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (size_t k = 0; k < sizeof bad_hz / sizeof *bad_hz; k++) {
        fit.frequency_hz[2] = bad_hz[k];
        refused(&fit, "ROTID_ERROR_ARGUMENT");
    }
    fit.frequency_hz[2] = paper_measured_hz[2];
    fit.number[3] = 0;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.number[3] = 67; /* 68 masters, two of them for the suspension: modes 1 to 66 */
    refused(&fit, "ROTID_ERROR_UNPAIRED");
    fit.number[3] = 4;
    fit.measured.nmode = 0;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.measured.nmode = PAPER_MODES;
    fit.measured.holdout = fit.holdout;
    for (int k = 0; k < PAPER_MODES; k++)
        fit.holdout[k] = 1;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.measured.holdout = NULL;
    fit.options.functional = ROTID_LIKELIHOOD; /* without any noise stated */
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    paper_synthesise(&fit, scipy_optimum, 1e-3, 0.015);
    fit.measured.shape_std = NULL;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.measured.shape_std = fit.shape_std;
    fit.shape_std[100] = 0;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.shape_std[100] = 0.015;
    fit.shape_std[100] = INFINITY; /* it would count as a residual that fits well */
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.shape_std[100] = 0.015;
    fit.frequency_std[5] = INFINITY;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.frequency_std[5] = -1e-3;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    paper_fit_close(&fit);
}

UNIT_TEST(test_options_and_models_that_make_no_sense_are_refused)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    const rotid_model model = fit.client.equations;
    const rotid_fit_options options = fit.options;
    static const struct {
        int functional, reduction, derivative;
    } bad[] = {{3, 1, 0}, {-1, 1, 0}, {0, 3, 0}, {0, -1, 0}, {0, 1, 2}, {0, 1, -1}, {2, 0, 1}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) { /* the last: a modal derivative of the full model */
        fit.options.functional = bad[k].functional;
        fit.options.reduction = bad[k].reduction;
        fit.options.derivative = bad[k].derivative;
        paper_synthesise(&fit, scipy_optimum, 1e-3, 0.015);
        refused(&fit, "ROTID_ERROR_ARGUMENT");
    }
    fit.options = options;
    static const double bad_chi[] = {INFINITY, 1e7, 1e-60, 1e-320};
    for (size_t k = 0; k < sizeof bad_chi / sizeof *bad_chi; k++) {
        fit.options.bijection_chi = bad_chi[k];
        refused(&fit, "ROTID_ERROR_ARGUMENT");
    }
    fit.options = options;
    rotid_model wrong[] = {model, model, model, model, model, model, model, model};
    int order[PAPER_SENSORS];
    memcpy(order, model.master, sizeof order);
    order[3] = order[2];
    wrong[0].n = 1;
    wrong[1].kd = model.n;
    wrong[2].nparam = -1;
    wrong[3].matrices = NULL;
    wrong[4].master = order;
    wrong[5].nmaster = -1;
    wrong[6].nrigid = -1;
    wrong[7].nfar = -1;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        fit.client.equations = wrong[k];
        refused(&fit, "ROTID_ERROR_ARGUMENT");
    }
    fit.client.equations = model;
    rotid_fit_result *result = (void *)&fit;
    assert_status(rotid_fit(NULL, fit.parameter, &fit.measured, &fit.options, NULL, NULL, &result), ROTID_ERROR_ARGUMENT);
    assert_null(result);
    assert_status(rotid_fit(&model, NULL, &fit.measured, &fit.options, NULL, NULL, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_fit(&model, fit.parameter, NULL, &fit.options, NULL, NULL, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_fit(&model, fit.parameter, &fit.measured, &fit.options, NULL, NULL, NULL), ROTID_ERROR_ARGUMENT);
    paper_fit_close(&fit);
}

/* a host may forget one: an error is better than a crash inside its solver */
UNIT_TEST(test_missing_arrays_are_refused)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    const rotid_model model = fit.client.equations;
    fit.client.equations.master = NULL;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.client.equations = model;
    fit.client.equations.far = NULL;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.client.equations = model;
    fit.measured.number = NULL;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    fit.measured.number = fit.number;
    fit.measured.frequency_hz = NULL;
    refused(&fit, "ROTID_ERROR_ARGUMENT");
    paper_fit_close(&fit);
}

/* What the host's model does wrong comes back as itself. */
static int broken(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    (void)x;
    if (*(int *)user == 0)
        return 1;
    for (int i = 0; i < stiffness->n; i++) {
        stiffness->band[i * (stiffness->kd + 1)] = *(int *)user == 1 ? NAN : 1.0 + i;
        mass->band[i * (mass->kd + 1)] = *(int *)user == 2 ? -1 : 1;
    }
    return 0;
}

UNIT_TEST(test_failures_of_the_model_come_back_as_themselves)
{
    static const char *const expected[] = {"ROTID_ERROR_CALLBACK", "ROTID_ERROR_FINITE", "ROTID_ERROR_MASS"};
    for (int kind = 0; kind < 3; kind++) {
        struct paper_fit fit;
        paper_fit_open(&fit, BUNDLE_TUBE);
        fit.client.equations.matrices = broken;
        fit.client.equations.user = &kind;
        refused(&fit, expected[kind]);
        paper_fit_close(&fit);
    }
}
