/* What is judged of a result, by its definition, on results made by hand. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "report/table.h"
#include "result/judgement.h"
#include "support.h"

static void errors_of_fitted_modes_and_of_those_held_out_stand_apart(void **state)
{
    (void)state;
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

/* Of two degrees of freedom the tail is exp(-chi2/2). */
static void noise_explains_a_misfit_or_the_model_is_not_adequate(void **state)
{
    (void)state;
    static const struct {
        double p;
        const char *says, *silent;
    } cases[] = {{0.0095, "the model is not adequate for these data", "noise alone does as much"},
                 {0.0105, "noise alone does as much in 1 % of such tests", "not adequate"},
                 {0.3, "noise alone does as much in 30 % of such tests", "not adequate"}};
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
        table_identify(stream, &result, 0, 0);
        assert_int_equal(fclose(stream), 0);
        if (!strstr(text, cases[i].says) || strstr(text, cases[i].silent))
            print_error("p = %g:\n%s\n", cases[i].p, text);
        assert_true(strstr(text, cases[i].says) && !strstr(text, cases[i].silent));
        free(text);
        fit.dof = 0;
        assert_true(isnan(fit_p_value(&fit)));
    }
}

/* A cause with one more parameter that was searched for has to earn it; one that was given costs nothing. */
static void a_lead_counts_what_was_searched_for(void **state)
{
    (void)state;
    rotid_cause_value searched[] = {{.fixed = 0}, {.fixed = 0}}, given[] = {{.fixed = 0}, {.fixed = 1}};
    rotid_candidate candidates[] = {
        {.round = 1, .refitted = 1, .chi2_drop = 50, .cause = {.nparameters = 2, .parameters = searched}},
        {.round = 1, .refitted = 1, .chi2_drop = 49, .cause = {.nparameters = 2, .parameters = given}},
        {.round = 1,
         .refitted = 1,
         .chi2_drop = 60,
         .cause = {.nparameters = 1, .parameters = given},
         .rejected_because = "is larger than any rotor has"},
        {.round = 1,
         .refitted = 1,
         .chi2_drop = 48,
         .cause = {.nparameters = 1, .parameters = given},
         .rejected_because = "loses to the first by 3"},
        {.round = 2, .refitted = 1, .chi2_drop = 90, .cause = {.nparameters = 1, .parameters = given}},
    };
    rotid_round rounds[] = {{.round = 1, .set = 1}, {.round = 2, .set = 0}};
    const rotid_diagnosis d = {.ncandidates = 5, .candidates = candidates, .nrounds = 2, .rounds = rounds};
    int count, first, second;
    assert_close(candidate_lead(&candidates[1], &candidates[3]), 1, 1e-15, 0);
    double more = 1 - candidate_lead(&candidates[0], &candidates[1]);
    assert_true(more > 2); /* what one parameter too many gains by chance, on average, is 1 */
    assert_close(candidate_lead(&candidates[1], &candidates[0]), more - 1, 1e-15, 0);
    assert_ptr_equal(diagnosis_candidates(&d, 1, &count), &candidates[4]);
    assert_int_equal(count, 1);
    assert_ptr_equal(diagnosis_candidates(&d, 0, &count), candidates);
    assert_int_equal(count, 4);
    diagnosis_leaders(&d, 0, &first, &second);
    assert_true(first == 0 && second == 1); /* 2 was refused for a reason of its own */
    diagnosis_leaders(&d, 1, &first, &second);
    assert_true(first == -1 && second == 0);
}

/* The fit as the deck states it is shown where it says something else by another choice. */
static void the_fit_of_today_is_shown_where_it_differs(void **state)
{
    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_of_fitted_modes_and_of_those_held_out_stand_apart),
        cmocka_unit_test(noise_explains_a_misfit_or_the_model_is_not_adequate),
        cmocka_unit_test(a_lead_counts_what_was_searched_for),
        cmocka_unit_test(the_fit_of_today_is_shown_where_it_differs),
    };
    return cmocka_run_group_tests_name("judgement", tests, NULL, NULL);
}
