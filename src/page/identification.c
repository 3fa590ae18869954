/* The verdict on an identification in plain words, the tiles, and how far to trust it. */
#include <math.h>
#include <string.h>

#include "fit/fit.h"
#include "page/page.h"

#define NAMED             3   /* parameters that the answer names; the table has the others */
#define POOR_PERCENT      2.0 /* error of a fitted frequency that a beam need not leave */
#define CONDENSED_PERCENT 0.5 /* as `rotid frf` warns */

void reasons_add(struct reasons *reasons, enum tone tone, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    if (reasons->count < REASONS_MOST)
        reasons->text[reasons->count++] = pool_text_of(reasons->pool, format, values);
    va_end(values);
    reasons->tone = tone > reasons->tone ? tone : reasons->tone;
}

/* "core.E = 115.7 GPa (95 %: 55 to 176), core.G = ..." */
static const char *values(struct pool *pool, const rotid_identification *fit)
{
    const char *text = "";
    for (int p = 0; p < fit->nparameters && p < NAMED; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        text = pool_text(pool, "%s%s%s = %s", text, p ? "; " : "", parameter->name,
                         human_interval(pool, parameter->value, parameter->ci95, parameter->unit));
    }
    if (fit->nparameters > NAMED)
        text = pool_text(pool, "%s; and %s more", text, human_count(pool, fit->nparameters - NAMED));
    return text;
}

static void on_convergence(struct reasons *reasons, const rotid_identification *fit)
{
    struct pool *pool = reasons->pool;
    if (!strcmp(fit->status, "converged"))
        reasons_add(reasons, TONE_GOOD, "The fit converged in %s %s: %s.", human_count(pool, fit->iterations),
                    human_plural(fit->iterations, "iteration", "iterations"), fit->stop_reason);
    else if (!strcmp(fit->status, "at_bound"))
        reasons_add(reasons, TONE_BAD,
                    "The fit ended with a parameter pressed against its bound: its value without the bound is not known.");
    else
        reasons_add(reasons, TONE_BAD, "The fit did not converge: %s.", fit->stop_reason);
    const char *held = "", *loose = "";
    for (int p = 0; p < fit->nparameters; p++) {
        const char **list = fit->parameters[p].at_bound ? &held : &loose;
        if (!fit->parameters[p].identifiable)
            *list = pool_text(pool, "%s%s%s", *list, **list ? ", " : "", fit->parameters[p].name);
    }
    if (*held)
        reasons_add(reasons, TONE_BAD, "At a bound: %s.", held);
    if (*loose)
        reasons_add(reasons, TONE_BAD, "Not determined by these data, alone or in a combination: %s.", loose);
}

static void on_baseline(struct reasons *reasons, const rotid_identification *fit)
{
    int lower;
    const char *text = minimisers_sentence(reasons->pool, fit, &lower);
    if (*text)
        reasons_add(reasons, lower ? TONE_BAD : TONE_GOOD, "%s.", text);
}

static void on_misfit(struct reasons *reasons, const rotid_identification *fit, const char *deck)
{
    struct pool *pool = reasons->pool;
    int worst = fit_worst_mode(fit), noisy = isfinite(fit_p_value(fit));
    double rms = fit_rms_percent(fit, 0), held = fit_rms_percent(fit, 1);
    const char *state = fit_state_of_mode(fit, worst < 0 ? 0 : worst);
    if (worst >= 0)
        reasons_add(reasons, !noisy && fabs(fit->modes[worst].error_percent) > POOR_PERCENT ? TONE_CARE : TONE_GOOD,
                    "The model leaves an error of %s\xc2\xa0%% rms in the frequencies that were fitted, and of %s\xc2\xa0%% "
                    "in mode %d%s%s.",
                    human_digits(pool, rms, 2),
                    human_signed(pool, fit->modes[worst].error_percent, fabs(fit->modes[worst].error_percent) < 0.01 ? 5 : 2),
                    fit->modes[worst].mode, state ? " of state " : "", state ? state : "");
    if (isfinite(held))
        reasons_add(reasons, held > 2 * rms && held > POOR_PERCENT / 2 ? TONE_CARE : TONE_GOOD,
                    "The prediction error on held-out modes is %s\xc2\xa0%% rms.", human_digits(pool, held, 2));
    if (!noisy)
        return;
    int k = fit_mode_of_mesh(fit);
    if (fit_is_inadequate(fit))
        reasons_add(
            reasons, TONE_BAD,
            "The misfit is %s times what the stated noise explains (\xcf\x87\xc2\xb2 = %s with %d degrees of freedom): %s",
            human_digits(pool, sqrt(fit->chi2_per_dof), 2), human_digits(pool, fit->chi2, 3), fit->dof,
            k >= 0 ? pool_text(pool,
                               "its mesh moves mode %d by %s\xc2\xa0%%, and the parameters are biased by that. Give more "
                               "elements.",
                               fit->modes[k].mode, human_signed(pool, fit->mesh_error_percent[k], 2))
                   : pool_text(pool,
                               "the model lacks something, and its parameters are biased by that. rotid diagnose %s looks for "
                               "the cause.",
                               deck));
    else
        reasons_add(reasons, TONE_GOOD, "The stated noise explains the misfit: \xcf\x87\xc2\xb2 = %s with %d degrees of freedom.",
                    human_digits(pool, fit->chi2, 3), fit->dof);
}

static void on_intervals(struct reasons *reasons, const rotid_identification *fit)
{
    struct pool *pool = reasons->pool;
    const char *wide = "";
    double widest = 0;
    int none = 0;
    for (int p = 0; p < fit->nparameters; p++) {
        const double *ci = fit->parameters[p].ci95, half = interval_half_percent(fit->parameters[p].value, ci[0], ci[1]);
        if (!isfinite(half)) {
            none++;
            continue;
        }
        widest = fmax(widest, half);
        wide = pool_text(pool, "%s%s%s \xc2\xb1%s\xc2\xa0%%", wide, *wide ? ", " : "", fit->parameters[p].name,
                         human_digits(pool, half, 2));
    }
    if (none == fit->nparameters)
        reasons_add(reasons, TONE_CARE, "No interval can be stated for any parameter.");
    else
        reasons_add(reasons, widest > 100 * INTERVAL_WIDE ? TONE_CARE : TONE_GOOD, "The 95\xc2\xa0%% intervals: %s%s.%s", wide,
                    none ? ", none for the others" : "",
                    isfinite(fit->chi2)
                        ? fit->intervals_widened_by > 1 ? " They are widened because the misfit exceeds the stated noise." : ""
                        : " They are estimated from the residuals, since no noise is stated (*NOISE).");
}

static void on_condensation(struct reasons *reasons, const rotid_identification *fit)
{
    double worst = 0;
    int mode = 0;
    for (int k = 0; k < fit->nmodes; k++)
        if (!fit->modes[k].holdout && fabs(fit->reduction_error_percent[k]) > fabs(worst)) {
            worst = fit->reduction_error_percent[k];
            mode = fit->modes[k].mode;
        }
    if (strcmp(fit->reduction, "NONE") != 0 && fabs(worst) > CONDENSED_PERCENT)
        reasons_add(
            reasons, TONE_CARE,
            "Condensation (REDUCTION=%s) alone moves the frequency of mode %d by %s\xc2\xa0%%; the parameters absorb that. "
            "REDUCTION=NONE avoids it.",
            fit->reduction, mode, human_signed(reasons->pool, worst, 2));
}

static void tile_number(struct document *document, const char *name, double value, const char *note)
{
    if (isfinite(value))
        document_tile(document, name, human_digits(document->pool, value, 2), note);
}

void tile_parameter(struct document *document, const rotid_fitted_parameter *parameter, const char *note)
{
    struct pool *pool = document->pool;
    struct human_unit unit = human_unit(parameter->value, parameter->unit);
    double f = unit.factor, half = (parameter->ci95[1] - parameter->ci95[0]) / 2 * f;
    int decimals = human_decimals(parameter->value * f, half);
    const char *interval = isfinite(half)
                               ? pool_text(pool, "95\xc2\xa0%%: %s to %s", human_fixed(pool, parameter->ci95[0] * f, decimals),
                                           human_fixed(pool, parameter->ci95[1] * f, decimals))
                               : "no interval can be stated";
    document_tile(document, *unit.text ? pool_text(pool, "%s [%s]", parameter->name, unit.text) : parameter->name,
                  human_fixed(pool, parameter->value * f, decimals),
                  pool_text(pool, "%s%s%s", interval, note ? "; " : "", or_nothing(note)));
}

/* Why the fit can be trusted or not. */
static struct reasons reasons_of(struct pool *pool, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    struct reasons reasons = {.pool = pool};
    const char *deck = result->head.deck ? result->head.deck : "DECK";
    on_convergence(&reasons, fit);
    on_misfit(&reasons, fit, deck);
    on_intervals(&reasons, fit);
    on_condensation(&reasons, fit);
    on_baseline(&reasons, fit);
    if (*hidden_in_words(pool, fit, fit->nhidden, fit->hidden, 0))
        reasons_add(&reasons, hidden_is_wide(fit, fit->nhidden, fit->hidden) ? TONE_CARE : TONE_GOOD,
                    "A cause below its detection limit would not have shown and may be present: it may move %s. rotid diagnose "
                    "%s says more.",
                    hidden_in_words(pool, fit, fit->nhidden, fit->hidden, 1), deck);
    return reasons;
}

void answer_identify(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    struct pool *pool = document->pool;
    const char *shifts = hidden_in_words(pool, fit, fit->nhidden, fit->hidden, 0);
    document->now.text = values(pool, fit);
    document->now.tone = reasons_of(pool, result).tone;
    if (document->now.tone == TONE_GOOD)
        document->now.headline = *shifts ? pool_text(pool, "Reliable; effects below the detection limits may shift %s", shifts)
                                         : "Reliable if the model is right";
    for (int p = 0; p < fit->nparameters && p < TILES_MOST - 3; p++)
        tile_parameter(document, &fit->parameters[p],
                       fit->parameters[p].at_bound        ? "at its bound"
                       : !fit->parameters[p].identifiable ? "not determined"
                                                          : NULL);
    tile_number(document, "error of the frequencies, rms [%]", fit_rms_percent(fit, 0), "of the fitted modes");
    tile_number(document, "error of held-out frequencies, rms [%]", fit_rms_percent(fit, 1), "not fitted");
    tile_number(document, "\xcf\x87\xc2\xb2 per degree of freedom", fit->chi2_per_dof,
                pool_text(pool, "%d degrees of freedom; 1 is what the stated noise leaves", fit->dof));
}

void section_trust(struct document *document, const struct result *result)
{
    const struct reasons reasons = reasons_of(document->pool, result);
    document_section(document, "trust", "How far to trust it", NULL);
    document_list(document, reasons.count, reasons.text);
    if (!fit_is_inadequate(result->identify)) /* else something shows already */
        section_hidden(document, result->identify, result->identify->nhidden, result->identify->hidden);
}

void answer_plain(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const char *text = "";
    if (result->modes && result->modes->nmodes) {
        const rotid_model_mode *mode = result->modes->modes;
        text = pool_text(pool, "%d bending modes from %s", result->modes->nmodes,
                         human_range(pool, mode[0].full_hz, mode[result->modes->nmodes - 1].full_hz, "Hz"));
    } else if (result->suggest) {
        text = result->suggest->sentence;
    } else if (result->speeds) {
        text = answer_of_speeds(pool, result->speeds);
    } else if (result->sensitivity) {
        text =
            pool_text(pool, "How %d modes depend on %d %s", result->sensitivity->nfrequency_hz, result->sensitivity->nparameters,
                      human_plural(result->sensitivity->nparameters, "parameter", "parameters"));
    } else if (result->frf) {
        text = pool_text(pool, "%d transfer %s from %s", result->frf->nfunctions,
                         human_plural(result->frf->nfunctions, "function", "functions"),
                         human_range(pool, result->frf->low_hz, result->frf->high_hz, "Hz"));
    } else if (result->check) {
        text = pool_text(pool, "A rotor of %s and %s in %d %s", human_value(pool, result->check->length_m, "m"),
                         human_value(pool, result->check->mass_kg, "kg"), result->check->elements,
                         human_plural(result->check->elements, "element", "elements"));
    }
    document->now.text = text;
}
