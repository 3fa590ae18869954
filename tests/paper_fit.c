#include "paper_fit.h"

static const double two_pi = 6.28318530717958647692;
const double scipy_optimum[2] = {1.15706008143e11, 3.16081329582e10};
const double scipy_objective = 0.0230527340282;

void paper_fit_open_rotor(struct paper_fit *fit, const struct rotor *rotor, int nparameter, const struct parameter *parameter)
{
    int failed;
    memset(fit, 0, sizeof *fit);
    pool_open(&fit->pool, NULL);
    memcpy(fit->chosen, parameter, (size_t)nparameter * sizeof *parameter);
    assert_status(model_open(&fit->pool, NULL, rotor, nparameter, fit->chosen, 1, &fit->client, &failed), ROTID_OK);
    for (int k = 0; k < PAPER_MODES; k++)
        fit->number[k] = k + 1;
    memcpy(fit->frequency_hz, paper_measured_hz, sizeof fit->frequency_hz);
    fit->measured = (rotid_measured){
        .size = sizeof(rotid_measured), .nmode = PAPER_MODES, .number = fit->number, .frequency_hz = fit->frequency_hz};
    rotid_fit_defaults(sizeof fit->options, &fit->options);
    fit->options.functional = ROTID_HYBRID;
    fit->options.reduction = ROTID_GUYAN;
}

void paper_fit_open(struct paper_fit *fit, enum bundle_model model)
{
    paper_fit_open_rotor(fit, paper_rotor(model, 0), 2, paper_parameters);
    fit->parameter[0] = (rotid_parameter){"core.E", "Pa", 1e6, 2.3e11, paper_start[0]};
    fit->parameter[1] = (rotid_parameter){"core.G", "Pa", 1e6, 0.898e11, paper_start[1]};
}

void paper_fit_close(struct paper_fit *fit)
{
    pool_close(&fit->pool);
}

static void predict_again(struct paper_fit *fit, int reduction, const double *x)
{
    const rotid_model *model = &fit->client.equations;
    int count = model->nrigid + PAPER_MODES;
    if (!fit->predicts || fit->reduction != reduction)
        assert_status(prediction_new(&fit->pool, model, reduction, ROTID_NELSON, count, 0, &fit->prediction), ROTID_OK);
    fit->predicts = 1;
    fit->reduction = reduction;
    assert_status(prediction_compute(&fit->prediction, x), ROTID_OK);
}

void paper_predict(struct paper_fit *fit, int reduction, const double *x, double *frequency_hz, double *shape)
{
    predict_again(fit, reduction, x);
    for (int k = 0; k < PAPER_MODES; k++) {
        int pair = fit->client.equations.nrigid + k;
        double largest = 0;
        frequency_hz[k] = sqrt(fit->prediction.lambda[pair]) / two_pi;
        for (int s = 0; shape && s < PAPER_SENSORS; s++) {
            shape[s + PAPER_SENSORS * k] = prediction_at_sensor(&fit->prediction, pair, s);
            if (fabs(shape[s + PAPER_SENSORS * k]) > fabs(largest))
                largest = shape[s + PAPER_SENSORS * k];
        }
        for (int s = 0; shape && s < PAPER_SENSORS; s++)
            shape[s + PAPER_SENSORS * k] /= largest;
    }
}

void paper_synthesise(struct paper_fit *fit, const double *x, double frequency_std, double shape_std)
{
    paper_predict(fit, ROTID_REDUCTION_NONE, x, fit->frequency_hz, fit->shape);
    for (int k = 0; k < PAPER_MODES; k++)
        fit->frequency_std[k] = frequency_std;
    for (int i = 0; i < PAPER_SENSORS * PAPER_MODES; i++)
        fit->shape_std[i] = shape_std;
    fit->measured.frequency_std = frequency_std > 0 ? fit->frequency_std : NULL;
    fit->measured.shape = shape_std > 0 ? fit->shape : NULL;
    fit->measured.shape_std = shape_std > 0 ? fit->shape_std : NULL;
}

rotid_fit_result *paper_run(struct paper_fit *fit)
{
    rotid_fit_result *result = NULL;
    assert_status(rotid_fit(&fit->client.equations, fit->parameter, &fit->measured, &fit->options, NULL, NULL, &result),
                  ROTID_OK);
    assert_non_null(result);
    return result;
}

/* 1/2 sum ((a phi - phi^)/s)^2 with the a that makes it least: what is left of phi^ after its projection on phi, one s for all */
static double shape_misfit(const struct paper_fit *fit, int mode)
{
    const double *measured = fit->shape + PAPER_SENSORS * mode;
    double across = 0, own = 0, sum = 0;
    for (int s = 0; s < PAPER_SENSORS; s++) {
        double phi = prediction_at_sensor(&fit->prediction, fit->client.equations.nrigid + mode, s);
        across += phi * measured[s];
        own += phi * phi;
    }
    for (int s = 0; s < PAPER_SENSORS; s++) {
        double phi = prediction_at_sensor(&fit->prediction, fit->client.equations.nrigid + mode, s);
        double left = (across / own * phi - measured[s]) / fit->shape_std[s + PAPER_SENSORS * mode];
        sum += left * left / 2;
    }
    return sum;
}

double paper_objective(struct paper_fit *fit, const double *x)
{
    double sum = 0;
    predict_again(fit, fit->options.reduction, x);
    for (int k = 0; k < fit->measured.nmode; k++) {
        double f = sqrt(fit->prediction.lambda[fit->client.equations.nrigid + fit->number[k] - 1]) / two_pi,
               ratio = f / fit->frequency_hz[k];
        double r = fit->options.functional == ROTID_HYBRID     ? 1 - ratio * ratio
                   : fit->options.functional == ROTID_HYBRID_F ? 1 - ratio
                                                               : (ratio - 1) / fit->frequency_std[k];
        if (fit->measured.holdout && fit->holdout[k])
            continue;
        sum += r * r / 2;
        if (fit->options.functional == ROTID_LIKELIHOOD && fit->measured.shape)
            sum += shape_misfit(fit, fit->number[k] - 1);
    }
    return sum;
}

double paper_gradient(struct paper_fit *fit, const double *x, double *gradient)
{
    static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
    double largest = 0, moved[PAPER_MOST_PARAMETERS];
    int n = fit->client.equations.nparam;
    memcpy(moved, x, (size_t)n * sizeof *x);
    for (int p = 0; p < n; p++) {
        double h = 3e-4 * fabs(fit->parameter[p].start), sum = 0; /* truncation h^4 and rounding eps/h are then both near 1e-12 */
        for (int i = 0; i < 4; i++) {
            moved[p] = x[p] + step[i] * h;
            sum += weight[i] * paper_objective(fit, moved);
        }
        moved[p] = x[p];
        if (gradient)
            gradient[p] = sum / (12 * 3e-4);
        largest = fmax(largest, fabs(sum / (12 * 3e-4)));
    }
    return largest;
}

double paper_line_minimum(struct paper_fit *fit, double *x, int p, double low, double high)
{
    const double golden = 0.61803398874989485;
    double kept = x[p], a = high - golden * (high - low), b = low + golden * (high - low), fa, fb;
    x[p] = a;
    fa = paper_objective(fit, x);
    x[p] = b;
    fb = paper_objective(fit, x);
    while (high - low > 1e-9 * fabs(high)) {
        if (fa < fb) {
            high = b;
            b = a;
            fb = fa;
            x[p] = a = high - golden * (high - low);
            fa = paper_objective(fit, x);
        } else {
            low = a;
            a = b;
            fa = fb;
            x[p] = b = low + golden * (high - low);
            fb = paper_objective(fit, x);
        }
    }
    x[p] = kept;
    return (low + high) / 2;
}
