/* What a fit hands back beside its parameters: residuals, their Jacobian, and both without any parameter. */
#include "paper_fit.h"
#include "support.h"

static const double truth[2] = {1.157e11, 0.316e11};

/* Frequencies 0.3 % and shapes 2 % off, always the same way; mode 4 held out, two sensors missing. */
static void open_noisy(struct paper_fit *fit, int nparameter, int functional)
{
    paper_fit_open(fit, BUNDLE_TUBE);
    fit->options.functional = functional;
    fit->options.reduction = ROTID_REDUCTION_NONE;
    paper_synthesise(fit, truth, 3e-3, 0.02);
    for (int k = 0; k < PAPER_MODES; k++)
        fit->frequency_hz[k] *= 1 + 3e-3 * cos(5.0 * k);
    for (int i = 0; i < PAPER_SENSORS * PAPER_MODES; i++)
        fit->shape[i] += 0.02 * sin(3.0 * i);
    fit->shape[5] = fit->shape[2 * PAPER_SENSORS + 40] = NAN;
    fit->holdout[3] = 1;
    fit->measured.holdout = fit->holdout;
    if (nparameter)
        return;
    int failed;
    assert_status(model_open(&fit->pool, NULL, paper_rotor(BUNDLE_TUBE, 0), 0, fit->chosen, 1, &fit->client, &failed), ROTID_OK);
}

/* The fit without parameters of the model that stands at x; *functional of open_noisy. */
static rotid_fit_result *compare_at(struct paper_fit *fit, const double *x)
{
    rotid_fit_result *result = NULL;
    for (int p = 0; p < 2; p++)
        *parameter_value(&fit->client.discrete.beam.rotor, paper_parameters[p]) = x[p];
    assert_status(rotid_fit(&fit->client.equations, NULL, &fit->measured, &fit->options, NULL, NULL, &result), ROTID_OK);
    return result;
}

static int cancel(void *context)
{
    return ++*(int *)context > 0;
}

UNIT_TEST(test_without_parameters_the_model_is_compared)
{
    struct paper_fit fit, with;
    open_noisy(&fit, 0, ROTID_LIKELIHOOD);
    open_noisy(&with, 2, ROTID_LIKELIHOOD);
    fit.options.baseline = 1;
    rotid_fit_result *best = paper_run(&with), *result = compare_at(&fit, best->x);
    assert_int_equal(result->status, ROTID_STOP_GRADIENT);
    assert_true(result->converged && !result->any_at_bound && !result->any_undetermined);
    assert_int_equal(result->n, 0);
    assert_int_equal(result->iterations, 0);
    assert_int_equal(result->evaluations, 1);
    assert_int_equal(result->jacobians, 0);
    assert_int_equal(result->nhistory, 1);
    assert_int_equal(result->nbaseline, 0);
    assert_true(result->gradient == 0 && isnan(result->condition_number));
    assert_int_equal(result->nresidual, best->nresidual);
    assert_int_equal(result->dof, result->nresidual - (PAPER_MODES - 1));
    assert_int_equal(best->dof, result->dof - 2);
    assert_close(result->chi2, 2 * result->objective, 1e-14, 0);
    assert_close(result->chi2_per_dof, result->chi2 / result->dof, 1e-14, 0);
    assert_close(result->objective, best->objective, 1e-9, 0);
    assert_close(result->history[0].objective, result->objective, 1e-14, 0);
    for (int i = 0; i < result->nresidual; i++)
        assert_close(result->r[i], best->r[i], 0, 1e-8);
    for (int k = 0; k < PAPER_MODES; k++) {
        assert_close(result->predicted_hz[k], best->predicted_hz[k], 1e-10, 0);
        assert_close(result->mac[k], best->mac[k], 1e-10, 0);
    }
    rotid_fit_free(result);

    int asked = 0;
    rotid_environment environment = {.size = sizeof environment, .cancelled = cancel, .context = &asked};
    assert_status(rotid_fit(&fit.client.equations, NULL, &fit.measured, &fit.options, &environment, NULL, &result), ROTID_OK);
    assert_int_equal(result->status, ROTID_STOP_CANCELLED);
    assert_true(!result->converged && asked == 1);
    rotid_fit_free(result);
    rotid_fit_free(best);
    assert_status(rotid_fit(&with.client.equations, NULL, &with.measured, &with.options, NULL, NULL, &result),
                  ROTID_ERROR_ARGUMENT);
    fit.client.equations.nparam = -1;
    assert_status(rotid_fit(&fit.client.equations, NULL, &fit.measured, &fit.options, NULL, NULL, &result), ROTID_ERROR_ARGUMENT);
    paper_fit_close(&fit);
    paper_fit_close(&with);
}

/* Its seconds are those since the iteration began: they rise, and the last are not more than the whole took. */
UNIT_TEST(test_history_tells_the_time)
{
    struct paper_fit fit;
    open_noisy(&fit, 2, ROTID_LIKELIHOOD);
    rotid_fit_result *result = paper_run(&fit);
    assert_true(result->nhistory > 3 && result->history[0].seconds > 0);
    for (int i = 1; i < result->nhistory; i++)
        assert_true(result->history[i].seconds >= result->history[i - 1].seconds);
    assert_true(result->history[result->nhistory - 1].seconds <= result->seconds);
    rotid_fit_free(result);
    paper_fit_close(&fit);
}

/* A channel that recorded nothing leaves zeros: of a mode with nothing else no scale is fitted. */
UNIT_TEST(test_a_shape_of_zeros_is_none)
{
    rotid_fit_result *result[2];
    struct paper_fit fit[2];
    for (int zero = 0; zero < 2; zero++) {
        open_noisy(&fit[zero], 2, ROTID_LIKELIHOOD);
        for (int s = 0; s < PAPER_SENSORS; s++)
            fit[zero].shape[PAPER_SENSORS + s] = zero ? 0 : NAN;
        result[zero] = paper_run(&fit[zero]);
    }
    assert_int_equal(result[1]->dof, result[0]->dof);
    for (int p = 0; p < 2; p++)
        assert_close(result[1]->std[p], result[0]->std[p], 1e-12, 0);
    for (int zero = 0; zero < 2; zero++) {
        rotid_fit_free(result[zero]);
        paper_fit_close(&fit[zero]);
    }
}

/* Of every functional, condensed or not, and where noise is not known. */
UNIT_TEST(test_every_functional_compares_without_parameters)
{
    for (int functional = ROTID_LIKELIHOOD; functional <= ROTID_HYBRID_F; functional++)
        for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++) {
            struct paper_fit fit;
            open_noisy(&fit, 0, functional);
            fit.options.reduction = reduction;
            if (functional != ROTID_LIKELIHOOD)
                fit.measured.frequency_std = fit.measured.shape_std = NULL;
            rotid_fit_result *result = compare_at(&fit, truth);
            assert_true(result->converged);
            assert_int_equal(result->dof, result->nresidual - (functional == ROTID_LIKELIHOOD ? PAPER_MODES - 1 : 0));
            assert_true(functional == ROTID_LIKELIHOOD || isnan(result->chi2));
            assert_true(result->variance_from_residuals == (functional != ROTID_LIKELIHOOD));
            rotid_fit_free(result);
            paper_fit_close(&fit);
        }
}

/* Residuals: those told mode by mode, half their square the objective. Jacobian: central differences of the residuals of the same
 * model without parameters. Once at the optimum, once where the iteration is cut short. */
static void check_residuals(int functional, int max_iterations)
{
    struct paper_fit fit, there;
    open_noisy(&fit, 2, functional);
    open_noisy(&there, 0, functional);
    fit.options.max_iterations = max_iterations;
    rotid_fit_result *result = paper_run(&fit);
    double sum = 0, worst = 0;
    for (int i = 0; i < result->nresidual; i++)
        sum += result->r[i] * result->r[i] / 2;
    assert_close(sum, result->objective, 1e-14, 0);
    for (int k = 0, row = 0; k < PAPER_MODES; k++)
        if (!fit.holdout[k])
            assert_close(result->r[row++], result->residual[k], 1e-12, 1e-15);
    for (int p = 0; p < 2; p++) {
        double x[2] = {result->x[0], result->x[1]}, h = 1e-4 * x[p], column = 0, gradient = 0;
        rotid_fit_result *side[2];
        for (int i = 0; i < 2; i++) {
            x[p] = result->x[p] + (2 * i - 1) * h;
            side[i] = compare_at(&there, x);
        }
        const double *derivative = result->jacobian + (ptrdiff_t)p * result->nresidual;
        for (int i = 0; i < result->nresidual; i++) {
            column = fmax(column, fabs(derivative[i]));
            worst = fmax(worst, fabs(derivative[i] - (side[1]->r[i] - side[0]->r[i]) / (2 * h)));
            gradient += derivative[i] * result->r[i];
        }
        assert_true(worst < 1e-6 * column);
        assert_true(fabs(gradient * fit.parameter[p].start) <= result->gradient * (1 + 1e-12) + 1e-9); /* rounding of zero */
        rotid_fit_free(side[0]);
        rotid_fit_free(side[1]);
    }
    rotid_fit_free(result);
    paper_fit_close(&fit);
    paper_fit_close(&there);
}

UNIT_TEST(test_residuals_and_jacobian_are_those_at_the_solution)
{
    for (int functional = ROTID_LIKELIHOOD; functional <= ROTID_HYBRID_F; functional++) {
        check_residuals(functional, 100);
        check_residuals(functional, 1);
    }
}

/* A looser tolerance saves iterations and moves the result by as much as it says. */
UNIT_TEST(test_loose_tolerances_stop_earlier)
{
    struct paper_fit fit;
    open_noisy(&fit, 2, ROTID_LIKELIHOOD);
    rotid_fit_result *tight = paper_run(&fit);
    fit.options.gradient_tolerance = fit.options.step_tolerance = 1e-6;
    rotid_fit_result *loose = paper_run(&fit);
    print_message("iterations %d, with 1e-6 %d\n", tight->iterations, loose->iterations);
    assert_true(tight->converged && loose->converged && loose->iterations <= tight->iterations - 1);
    for (int p = 0; p < 2; p++)
        assert_close(loose->x[p], tight->x[p], 0, 1e-3 * tight->std[p]);
    rotid_fit_free(tight);
    rotid_fit_free(loose);
    paper_fit_close(&fit);
}
