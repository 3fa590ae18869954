/* What is judged of a result, by its definition, on results made by hand. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "report/report.h"
#include "result/result.h"
#include "support.h"

UNIT_TEST(errors_of_fitted_modes_and_of_those_held_out_stand_apart)
{
    rotid_compared_mode modes[] = {
        {.error_percent = NAN}, {.error_percent = 3}, {.error_percent = -4}, {.error_percent = 12, .holdout = 1}};
    const rotid_identification fit = {.nmodes = 4, .modes = modes}, fitted = {.nmodes = 3, .modes = modes},
                               unknown = {.nmodes = 1, .modes = modes};
    assert_close(fit_rms_percent(&fit, 0), sqrt((9 + 16) / 2.0), 1e-15, 0);
    assert_close(fit_rms_percent(&fit, 1), 12, 1e-15, 0);
    assert_true(isnan(fit_rms_percent(&fitted, 1)));
    assert_int_equal(fit_worst_mode(&fit), 2); /* whatever its sign, and not the one held out */
    assert_true(isnan(fit_rms_percent(&unknown, 0)));
    assert_int_equal(fit_worst_mode(&unknown), -1);
}

/* Mesh errors of 3 and 4 times the noise are a chi2 of 25. */
UNIT_TEST(a_mesh_that_is_enough_for_the_misfit_is_its_reason)
{
    rotid_compared_mode modes[] = {{.frequency_std = 0.001}, {.frequency_std = 0.002}, {.frequency_std = 0.001, .holdout = 1}};
    double mesh[] = {0.3, -0.8, 7};
    rotid_identification fit = {.chi2 = 49, .dof = 2, .nmodes = 3, .modes = modes, .mesh_error_percent = mesh};
    assert_int_equal(fit_mode_of_mesh(&fit), 1);
    fit.chi2 = 51; /* more than twice: something else as well */
    assert_int_equal(fit_mode_of_mesh(&fit), -1);
    fit.chi2 = 3; /* as noise has it */
    assert_int_equal(fit_mode_of_mesh(&fit), -1);
    fit.chi2 = NAN; /* no noise is stated */
    assert_int_equal(fit_mode_of_mesh(&fit), -1);
}

/* Of two degrees of freedom the tail is exp(-chi2/2). */
UNIT_TEST(noise_explains_a_misfit_or_the_model_is_not_adequate)
{
    static const struct {
        double p;
        const char *says, *silent;
    } cases[] = {{0.0095, "the model lacks something", "as much in"},
                 {0.0105, "  as much in 1 % of tests", "lacks something"},
                 {0.3, "  as much in 30 % of tests", "lacks something"}};
    rotid_compared_mode mode = {.mode = 1, .measured_hz = 100, .predicted_hz = 101, .error_percent = 1};
    double error = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        rotid_identification fit = {.status = "converged",
                                    .functional = "LIKELIHOOD",
                                    .reduction = "NONE",
                                    .stop_reason = "",
                                    .chi2 = -2 * log(cases[i].p),
                                    .dof = 2,
                                    .intervals_widened_by = 2,
                                    .nmodes = 1,
                                    .modes = &mode,
                                    .reduction_error_percent = &error,
                                    .mesh_error_percent = &error};
        const struct result result = {.head.deck = "rotor.inp", .identify = &fit};
        char *text = NULL;
        size_t length;
        FILE *stream = open_memstream(&text, &length);
        assert_close(fit_p_value(&fit), cases[i].p, 1e-12, 0);
        assert_non_null(stream);
        screen_identify(&(struct screen){stream, &test_pool, 0, SCREEN_WIDTH}, &result, 0);
        assert_int_equal(fclose(stream), 0);
        if (!strstr(text, cases[i].says) || strstr(text, cases[i].silent))
            print_error("p = %g:\n%s\n", cases[i].p, text);
        assert_true(strstr(text, cases[i].says) && !strstr(text, cases[i].silent));
        free(text);
        fit.dof = 0;
        assert_true(isnan(fit_p_value(&fit)));
    }
}

/* The fit as the deck states it is shown where it says something else by another choice. */
UNIT_TEST(the_fit_of_today_is_shown_where_it_differs)
{
    rotid_fitted_parameter now[] = {{.name = "core.E", .value = 1.01e11}}, near[] = {{.name = "core.E", .value = 1.0005e11}},
                           then[] = {{.name = "core.E", .value = 1e11}};
    rotid_identification today = {.functional = "HYBRID", .reduction = "GUYAN", .nparameters = 1, .parameters = now},
                         base = {.functional = "LIKELIHOOD", .reduction = "GUYAN", .nparameters = 1, .parameters = then};
    const rotid_diagnosis d = {.today = &today, .base = &base};
    assert_ptr_equal(diagnosis_today(&d), &today);
    today.parameters = near;
    assert_null(diagnosis_today(&d));
    today.parameters = now;
    today.functional = "LIKELIHOOD";
    assert_null(diagnosis_today(&d));
}

/* One rule for a wide interval, in identify as in a diagnosis. */
UNIT_TEST(an_interval_is_wide_from_15_per_cent_on)
{
    char text[32];
    assert_false(interval_is_wide(-2, -2.29, -1.71));
    assert_true(interval_is_wide(-2, -2.31, -1.69));
    assert_false(interval_is_wide(1, NAN, NAN));
    assert_close(interval_half_percent(-2, -2.31, -1.69), 15.5, 1e-12, 0);
    assert_string_equal(linear_percent_text(3.14, text), "up to 3.1 %");
    assert_string_equal(linear_percent_text(50.1, text), "more than 50 %");
    assert_string_equal(percent_text(107.3, text), "107 %");
    rotid_fitted_parameter p[2] = {{.name = "core.E", .unit = "Pa", .value = 1, .ci95 = {0.84, 1.16}, .identifiable = 1},
                                   {.name = "core.G", .unit = "Pa", .value = 1, .ci95 = {0.86, 1.14}, .identifiable = 1}};
    rotid_compared_mode mode = {.mode = 1, .measured_hz = 100, .predicted_hz = 101, .error_percent = 1};
    rotid_hidden hidden[3] = {{.parameter = "core.E", .shift = -0.2, .id = "density", .target = "core"},
                              {.parameter = "core.E", .shift = 0.19, .id = "joint", .target = ""},
                              {.parameter = "core.G", .shift = 0.13, .id = "added_mass", .target = ""}};
    double error = 0, correlation[4] = {1, 0, 0, 1};
    rotid_identification fit = {.status = "converged",
                                .functional = "LIKELIHOOD",
                                .reduction = "NONE",
                                .stop_reason = "",
                                .nparameters = 2,
                                .parameters = p,
                                .correlation = correlation,
                                .nmodes = 1,
                                .modes = &mode,
                                .reduction_error_percent = &error,
                                .mesh_error_percent = &error,
                                .nhidden = 3,
                                .hidden = hidden};
    struct result result = {.identify = &fit};
    char *screen = NULL;
    size_t size;
    FILE *out = open_memstream(&screen, &size);
    screen_identify(&(struct screen){out, &test_pool, 0, SCREEN_WIDTH}, &result, 0);
    (void)fclose(out);
    assert_non_null(strstr(screen, "  known to 16 % only\n"));
    assert_null(strstr(screen, "to 14 % only"));
    assert_ptr_equal(hidden_in(3, hidden, &p[0]), &hidden[0]);
    assert_null(hidden_in(3, hidden, &p[1])); /* within its interval */
    assert_non_null(strstr(screen, "core.E by"));
    free(screen);
}

TEST_GROUP(open_test_pool, close_test_pool);
