/* The paper's rotor identified from the paper's measured frequencies. */
#include "fit/fit.h"
#include "paper_fit.h"
#include "support.h"

/* From the 68-sensor surrogate of input/paper_rotor.inp; SciPy's optimum is the second opinion on it. */
UNIT_TEST(test_moduli_errors_and_objective_are_those_of_a_second_solver)
{
    static const double percent[PAPER_MODES] = {-4.4, 8.2, 2.7, -1.0, -3.9, -0.7};
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    rotid_fit_result *result = paper_run(&fit);
    assert_true(result->converged && !result->any_at_bound && !result->any_undetermined);
    assert_close(result->x[0], scipy_optimum[0], 1e-7, 0);
    assert_close(result->x[1], scipy_optimum[1], 1e-7, 0);
    assert_close(result->x[0], 1.157e11, 0.01, 0);
    assert_close(result->x[1], 0.316e11, 0.01, 0);
    assert_close(result->objective, scipy_objective, 1e-10, 0);
    for (int k = 0; k < PAPER_MODES; k++) {
        double ratio = result->predicted_hz[k] / paper_measured_hz[k];
        assert_close(100 * (ratio - 1), percent[k], 0, 0.3);
        assert_close(result->residual[k], 1 - ratio * ratio, 0, 1e-12);
        assert_true(isnan(result->mac[k])); /* no shapes are given */
    }
    print_message("E %.10e G %.10e objective %.13g gradient %.1e iterations %d evaluations %d jacobians %d in %.1f ms\n",
                  result->x[0], result->x[1], result->objective, result->gradient, result->iterations, result->evaluations,
                  result->jacobians, 1e3 * result->seconds);
    assert_true(result->iterations <= 13 && result->evaluations <= 14);
    assert_true(result->gradient <= 1e-9);
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

UNIT_TEST(test_objective_and_gradient_hold_when_recomputed)
{
    for (int functional = ROTID_HYBRID; functional <= ROTID_HYBRID_F; functional++)
        for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++) {
            struct paper_fit fit;
            paper_fit_open(&fit, BUNDLE_TUBE);
            fit.options.functional = functional;
            fit.options.reduction = reduction;
            rotid_fit_result *result = paper_run(&fit);
            assert_true(result->converged);
            assert_close(result->objective, paper_objective(&fit, result->x), 1e-9, 0);
            assert_close(paper_gradient(&fit, result->x, NULL), 0, 0, 1e-8); /* rounding of f over the step of the difference */
            rotid_fit_free(result);
            paper_fit_close(&fit);
        }
}

UNIT_TEST(test_history_leads_from_the_start_to_the_result)
{
    struct paper_fit fit;
    double gradient[2];
    paper_fit_open(&fit, BUNDLE_TUBE);
    rotid_fit_result *result = paper_run(&fit);
    assert_int_equal(result->nhistory, result->iterations + 1);
    assert_close(result->history_x[0], paper_start[0], 1e-14, 0);
    assert_close(result->history_x[1], paper_start[1], 1e-14, 0);
    assert_close(result->history_x[2 * result->nhistory - 2], result->x[0], 1e-15, 0);
    assert_true(isnan(result->history[0].gain_ratio) && result->history[0].step == 0);
    for (int h = 0; h < result->nhistory; h++) {
        const double *x = result->history_x + 2 * h;
        const rotid_fit_iteration *now = &result->history[h];
        assert_int_equal(now->iteration, h);
        assert_close(now->objective, paper_objective(&fit, x), 1e-9, 0);
        assert_close(now->gradient, paper_gradient(&fit, x, gradient), 1e-6, 1e-8);
        assert_close(now->gradient, fmax(fabs(gradient[0]), fabs(gradient[1])), 1e-6, 1e-8);
        if (h)
            assert_close(now->step, hypot((x[0] - x[-2]) / paper_start[0], (x[1] - x[-1]) / paper_start[1]), 1e-12, 1e-15);
    }
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* The paper starts within +-70 % of what it finds. */
UNIT_TEST(test_every_start_within_seventy_percent_reaches_the_optimum)
{
    struct paper_fit fit;
    int most = 0;
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < 7; j++) {
            fit.parameter[0].start = scipy_optimum[0] * (0.3 + 1.4 * i / 6);
            fit.parameter[1].start = scipy_optimum[1] * (0.3 + 1.4 * j / 6);
            rotid_fit_result *result = paper_run(&fit);
            assert_true(result->converged);
            assert_close(result->x[0], scipy_optimum[0], 1e-6, 0);
            assert_close(result->x[1], scipy_optimum[1], 1e-6, 0);
            most = result->evaluations > most ? result->evaluations : most;
            rotid_fit_free(result);
        }
    print_message("most evaluations from any of 49 starts: %d\n", most);
    assert_true(most <= 30);
    paper_fit_close(&fit);
}

/* F_k is E_k to first order and half its size, so that only the large residuals make a difference. */
UNIT_TEST(test_functional_f_finds_nearly_the_same)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.options.functional = ROTID_HYBRID_F;
    rotid_fit_result *result = paper_run(&fit);
    assert_true(result->converged && result->iterations <= 13);
    assert_close(result->x[0], scipy_optimum[0], 0.03, 0);
    assert_close(result->x[1], scipy_optimum[1], 0.02, 0);
    assert_close(result->objective, scipy_objective / 4, 0.06, 0);
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* With frequencies alone LIKELIHOOD of one relative noise is F over that noise. */
UNIT_TEST(test_likelihood_of_frequencies_is_functional_f_over_the_noise)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.options.functional = ROTID_HYBRID_F;
    rotid_fit_result *plain = paper_run(&fit);
    for (int k = 0; k < PAPER_MODES; k++)
        fit.frequency_std[k] = 0.03;
    fit.measured.frequency_std = fit.frequency_std;
    fit.options.functional = ROTID_LIKELIHOOD;
    rotid_fit_result *likely = paper_run(&fit);
    assert_close(likely->x[0], plain->x[0], 1e-7, 0);
    assert_close(likely->x[1], plain->x[1], 1e-7, 0);
    assert_close(likely->objective, plain->objective / 9e-4, 1e-8, 0);
    assert_close(likely->chi2, 2 * likely->objective, 1e-13, 0);
    assert_int_equal(likely->dof, PAPER_MODES - 2);
    rotid_fit_free(plain);
    rotid_fit_free(likely);
    paper_fit_close(&fit);
}

/* Every solver is judged by our own objective and gradient at the point that it returned. */
UNIT_TEST(test_nlopt_agrees_and_needs_more_evaluations)
{
    if (!baseline_count(2))
        skip(); /* built without NLopt */
    for (int functional = ROTID_LIKELIHOOD; functional <= ROTID_HYBRID_F; functional++)
        for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_GUYAN; reduction++) {
            struct paper_fit fit;
            int usable = 0;
            paper_fit_open(&fit, BUNDLE_TUBE);
            fit.options = (rotid_fit_options){
                .size = sizeof(rotid_fit_options), .functional = functional, .reduction = reduction, .baseline = 1};
            for (int k = 0; k < PAPER_MODES; k++)
                fit.frequency_std[k] = 1e-4; /* makes f large, which is no reason for a solver to stop early */
            fit.measured.frequency_std = functional == ROTID_LIKELIHOOD ? fit.frequency_std : NULL;
            rotid_fit_result *result = paper_run(&fit);
            assert_true(result->converged);
            assert_int_equal(result->nbaseline, baseline_count(2));
            print_message("functional %d reduction %d  LM           objective %.12g gradient %.1e evaluations %4d %7.1f ms\n",
                          functional, reduction, result->objective, result->gradient, result->evaluations, 1e3 * result->seconds);
            for (int b = 0; b < result->nbaseline; b++) {
                const rotid_baseline *other = &result->baseline[b];
                print_message("%26s %-12s objective %.12g gradient %.1e evaluations %4d %7.1f ms %s\n", "", other->algorithm,
                              other->objective, other->gradient, other->evaluations, 1e3 * other->seconds, other->result);
                usable += other->usable;
                if (!other->usable)
                    continue;
                assert_close(other->x[0], result->x[0], 1e-5, 0);
                assert_close(other->x[1], result->x[1], 1e-5, 0);
                assert_close(other->objective, result->objective, 1e-9, 0);
                assert_close(other->objective, paper_objective(&fit, other->x), 1e-9, 0);
                assert_close(other->gradient, paper_gradient(&fit, other->x, NULL), 1e-2, 2e-7 * result->objective);
                assert_true(other->evaluations > result->evaluations);
            }
            assert_int_equal(usable, result->nbaseline);
            rotid_fit_free(result);
            paper_fit_close(&fit);
        }
}

/* Slender rods instead of a tube halve the misfit; SciPy's optimum for the rods, condensed to the same sensors. */
UNIT_TEST(test_rods_halve_the_objective_of_the_tube)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_RODS);
    rotid_fit_result *result = paper_run(&fit);
    assert_true(result->converged);
    assert_close(result->objective, 0.0112419104296, 1e-9, 0);
    assert_close(result->x[0], 1.21105484950e11, 1e-7, 0);
    assert_close(result->x[1], 3.24207702978e10, 1e-7, 0);
    assert_close(100 * (result->predicted_hz[1] / paper_measured_hz[1] - 1), 4.8, 0, 0.1);
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* Figs. 13 and 14: the moduli from the first m modes */
UNIT_TEST(test_two_to_six_modes_identify)
{
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_GUYAN; reduction++)
        for (int m = 2; m <= PAPER_MODES; m++) {
            struct paper_fit fit;
            paper_fit_open(&fit, BUNDLE_TUBE);
            fit.measured.nmode = m;
            fit.options.reduction = reduction;
            rotid_fit_result *result = paper_run(&fit);
            print_message("reduction %d, %d modes: E %.4e G %.4e objective %.3e iterations %d%s\n", reduction, m, result->x[0],
                          result->x[1], result->objective, result->iterations, result->any_at_bound ? ", at a bound" : "");
            assert_true(result->converged);
            assert_int_equal(result->nresidual, m);
            assert_close(result->objective, paper_objective(&fit, result->x), 1e-8, 1e-20);
            if (!result->any_at_bound)
                assert_close(paper_gradient(&fit, result->x, NULL), 0, 0, 1e-8);
            rotid_fit_free(result);
            paper_fit_close(&fit);
        }
}

/* An isotropic core: E alone, G = E/2(1 + nu) follows it. It cannot fit better than two free moduli. */
UNIT_TEST(test_isotropic_core_is_a_fit_of_one_parameter)
{
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_GUYAN; reduction++) {
        struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 0);
        struct paper_fit fit;
        rotor->group[1].material.isotropic = 1;
        paper_fit_open_rotor(&fit, rotor, 1, paper_parameters);
        fit.parameter[0] = (rotid_parameter){"core.E", "Pa", 1e6, 2.3e11, paper_start[0]};
        fit.options.reduction = reduction;
        fit.options.baseline = 1;
        rotid_fit_result *result = paper_run(&fit);
        double x = result->x[0];
        assert_true(result->converged && result->n == 1 && result->dof == PAPER_MODES - 1);
        assert_close(x, paper_line_minimum(&fit, &x, 0, 0.5 * x, 1.5 * x), 1e-6, 0);
        assert_close(paper_gradient(&fit, &x, NULL), 0, 0, 1e-8);
        assert_true(result->objective > scipy_objective);
        for (int b = 0; b < result->nbaseline; b++)
            assert_close(result->baseline[b].x[0], x, 1e-5, 0);
        print_message("isotropic, reduction %d: E %.4e objective %.6g\n", reduction, x, result->objective);
        rotid_fit_free(result);
        paper_fit_close(&fit);
    }
}

/* Held-out modes are predicted and compared, and change nothing, whatever was measured of them. */
UNIT_TEST(test_held_out_modes_do_not_influence_the_moduli)
{
    struct paper_fit fit;
    rotid_fit_result *alone, *with, *other;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.measured.nmode = 4;
    alone = paper_run(&fit);
    fit.measured.nmode = PAPER_MODES;
    fit.measured.holdout = fit.holdout;
    fit.holdout[4] = fit.holdout[5] = 1;
    with = paper_run(&fit);
    fit.frequency_hz[4] = 9999;
    other = paper_run(&fit);
    for (int p = 0; p < 2; p++) {
        assert_close(with->x[p], alone->x[p], 1e-8, 0);
        assert_true(other->x[p] == with->x[p]);
        assert_close(with->std[p], alone->std[p], 1e-6, 0);
    }
    assert_int_equal(with->m, PAPER_MODES);
    assert_int_equal(with->nresidual, 4);
    assert_int_equal(with->dof, 2);
    for (int k = 4; k < PAPER_MODES; k++)
        assert_close(with->residual[k], 1 - pow(with->predicted_hz[k] / paper_measured_hz[k], 2), 0, 1e-12);
    rotid_fit_free(alone);
    rotid_fit_free(with);
    rotid_fit_free(other);
    paper_fit_close(&fit);
}
