/* What is said of a fit and of a diagnosis, each sentence made once: for the screen, and for the page, which puts ids of causes
 * in words. How far to trust a fit; why a verdict is what it is; what is wrong with the measurement and the numbers. */
#include <ctype.h>

#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "report/report.h"

#define POOR_PERCENT      2.0 /* error of a fitted frequency that a beam need not leave */
#define CONDENSED_PERCENT 0.5 /* as `rotid frf` warns */

void reasons_add(struct reasons *reasons, enum tone tone, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const char *text = pool_text_of(reasons->pool, format, values);
    va_end(values);
    (void)POOL_ADD(reasons->pool, reasons->text, reasons->count, &text);
    reasons->tone = tone > reasons->tone ? tone : reasons->tone;
}

const char *cause_name(struct pool *pool, const char *id, const char *target)
{
    int left = (int)strcspn(target, "|");
    if (!*target)
        return id;
    if (target[left])
        return pool_text(pool, "%s between %.*s and %s", id, left, target, target + left + 1);
    return pool_text(pool, strncmp(target, "at ", 3) ? "%s of %s" : "%s %s", id, target);
}

const char *parameter_remark(struct pool *pool, const rotid_fitted_parameter *is)
{
    const double *ci = is->ci95;
    return is->at_bound        ? "at its bound"
           : !is->identifiable ? "not determined"
           : !isfinite(ci[0])  ? "no interval can be stated"
           : interval_is_wide(is->value, ci[0], ci[1])
               ? pool_text(pool, "known to %s only", percent_text(interval_half_percent(is->value, ci[0], ci[1]), (char[32]){""}))
               : "";
}

/* ---- a fit */

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

static void on_misfit(struct reasons *reasons, const rotid_identification *fit, const char *deck)
{
    struct pool *pool = reasons->pool;
    int worst = fit_worst_mode(fit), noisy = isfinite(fit_p_value(fit));
    double rms = fit_rms_percent(fit, 0), held = fit_rms_percent(fit, 1);
    const char *state = fit_state_of_mode(fit, worst < 0 ? 0 : worst);
    if (worst >= 0)
        reasons_add(
            reasons, !noisy && fabs(fit->modes[worst].error_percent) > POOR_PERCENT ? TONE_CARE : TONE_GOOD,
            "The model leaves an error of %s\xc2\xa0%% rms in the frequencies that were fitted, and of %s\xc2\xa0%% in mode "
            "%d%s%s.",
            human_digits(pool, rms, 2),
            human_signed(pool, fit->modes[worst].error_percent, fabs(fit->modes[worst].error_percent) < 0.01 ? 5 : 2),
            fit->modes[worst].mode, state ? " of state " : "", or_nothing(state));
    if (isfinite(held))
        reasons_add(reasons, held > 2 * rms && held > POOR_PERCENT / 2 ? TONE_CARE : TONE_GOOD,
                    "The prediction error on held-out modes is %s\xc2\xa0%% rms.", human_digits(pool, held, 2));
    if (!noisy)
        return;
    int k = fit_mode_of_mesh(fit);
    const char *chi2 =
        pool_text(pool, "\xcf\x87\xc2\xb2 = %s with %d degrees of freedom", human_digits(pool, fit->chi2, 4), fit->dof);
    if (!fit_is_inadequate(fit))
        reasons_add(reasons, TONE_GOOD, "The stated noise explains the misfit: %s; noise alone causes as much in %s of tests.",
                    chi2, text_of_probability(pool, 2, fit_p_value(fit)));
    else if (k >= 0)
        reasons_add(reasons, TONE_BAD,
                    "The misfit is %s times what the stated noise explains (%s): the mesh moves mode %d by %s\xc2\xa0%%, and the "
                    "parameters are biased by that. Give more elements.",
                    human_digits(pool, sqrt(fit->chi2_per_dof), 2), chi2, fit->modes[k].mode,
                    human_signed(pool, fit->mesh_error_percent[k], 2));
    else
        reasons_add(
            reasons, TONE_BAD,
            "The misfit is %s times what the stated noise explains (%s): the model lacks something, and its parameters are "
            "biased by that. rotid diagnose %s looks for the cause.",
            human_digits(pool, sqrt(fit->chi2_per_dof), 2), chi2, deck);
}

static void on_intervals(struct reasons *reasons, const rotid_identification *fit)
{
    struct pool *pool = reasons->pool;
    const char *wide = "";
    double widest = 0;
    int none = 0;
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *is = &fit->parameters[p];
        const char *quote = human_quote(pool, is->value, is->ci95, is->unit);
        none += !quote;
        widest = fmax(widest, interval_half_percent(is->value, is->ci95[0], is->ci95[1])); /* which is above NaN */
        wide = quote ? pool_text(pool, "%s%s%s = %s", wide, *wide ? ", " : "", is->name, quote) : wide;
    }
    if (none == fit->nparameters)
        reasons_add(reasons, TONE_CARE, "No interval can be stated for any parameter.");
    else
        reasons_add(reasons, widest > 100 * INTERVAL_WIDE ? TONE_CARE : TONE_GOOD, "The 95\xc2\xa0%% intervals: %s%s.%s", wide,
                    none ? ", none for the others" : "",
                    !isfinite(fit->chi2) ? " They are estimated from the residuals, since no noise is stated (*NOISE)."
                    : fit->intervals_widened_by > 1
                        ? pool_text(pool, " They are widened by %s because the misfit exceeds the stated noise.",
                                    human_digits(pool, fit->intervals_widened_by, 3))
                        : "");
}

static void on_functional(struct reasons *reasons, const rotid_identification *fit)
{
    int worst = -1, condensed = strcmp(fit->reduction, "NONE") != 0;
    for (int k = 0; k < fit->nmodes; k++)
        if (!fit->modes[k].holdout && fabs(fit->reduction_error_percent[k]) > CONDENSED_PERCENT &&
            (worst < 0 || fabs(fit->reduction_error_percent[k]) > fabs(fit->reduction_error_percent[worst])))
            worst = k;
    if (condensed && worst >= 0)
        reasons_add(
            reasons, TONE_CARE,
            "Condensation (REDUCTION=%s) alone moves the frequency of mode %d by %s\xc2\xa0%%; the parameters absorb that. "
            "REDUCTION=NONE avoids it.",
            fit->reduction, fit->modes[worst].mode, human_signed(reasons->pool, fit->reduction_error_percent[worst], 2));
    if (strcmp(fit->functional, "LIKELIHOOD") != 0)
        reasons_say(
            reasons,
            "The hybrid quotient equals the frequency of the %s for any measured shape: this functional fits frequencies alone.",
            condensed ? "condensed model" : "model");
}

static void on_baseline(struct reasons *reasons, const rotid_identification *fit)
{
    int lower;
    const char *text = minimisers_sentence(reasons->pool, fit, &lower);
    if (*text)
        reasons_add(reasons, lower ? TONE_BAD : TONE_GOOD, "%s.", text);
}

const char *hidden_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden, int causes)
{
    const char *text = "";
    char figure[32];
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *value = &fit->parameters[p];
        const rotid_hidden *most = hidden_in(count, hidden, value);
        if (!most)
            continue;
        text = pool_text(pool, "%s%s%s by %s", text, *text ? ", " : "", value->name,
                         linear_percent_text(100 * fabs(most->shift / value->value), figure));
        if (causes)
            text = pool_text(pool, "%s (%s)", text, cause_name(pool, most->id, most->target));
    }
    return text;
}

int hidden_is_wide(const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    int wide = 0;
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_hidden *most = hidden_in(count, hidden, &fit->parameters[p]);
        wide |= most && fabs(most->shift) > INTERVAL_WIDE * fabs(fit->parameters[p].value);
    }
    return wide;
}

struct reasons reasons_of_fit(struct pool *pool, const struct result_head *head, const rotid_identification *fit)
{
    struct reasons reasons = {.pool = pool};
    const char *deck = head->deck ? head->deck : "DECK", *hidden = hidden_in_words(pool, fit, fit->nhidden, fit->hidden, 1);
    on_convergence(&reasons, fit);
    on_misfit(&reasons, fit, deck);
    on_intervals(&reasons, fit);
    on_functional(&reasons, fit);
    on_baseline(&reasons, fit);
    if (*hidden && !fit_is_inadequate(fit)) /* else something shows already */
        reasons_add(
            &reasons, hidden_is_wide(fit, fit->nhidden, fit->hidden) ? TONE_CARE : TONE_GOOD,
            "A cause below its detection limit would not have shown and may be present: it may move %s. rotid diagnose %s says "
            "more.",
            hidden, deck);
    return reasons;
}

/* ---- a diagnosis */

/* "in fewer than 1 of 1,000": how often chance does it. */
static const char *words_chance(struct pool *pool, double p)
{
    return p < 0.001  ? "in fewer than 1 of 1,000"
           : p < 0.01 ? pool_text(pool, "in about %.0f of 1,000", 1000 * p)
                      : pool_text(pool, "in about %.0f of 100", 100 * p);
}

/* How often chance does what was found, and what that rests on. */
static void on_chance(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_verdict *v = &d->verdict;
    const rotid_round *round = d->nrounds ? d->rounds : NULL;
    if (round && isfinite(v->p_value))
        reasons_say(
            reasons,
            "A correct model has a misfit this large or larger %s tests: the misfit \xcf\x87\xc2\xb2 is %s, where a correct "
            "model has about %d.",
            words_chance(pool, v->p_value), human_digits(pool, round->chi2, 3), round->dof);
    else if (v->sentence)
        reasons_say(reasons, "No p-value can be stated.");
    if (round && v->kind == ROTID_ADEQUATE && isfinite(round->largest))
        reasons_say(reasons, "No cause of the catalogue is expected to lower it by more than %s.",
                    human_digits(pool, round->largest, 2));
    if (v->kind > ROTID_ADEQUATE)
        reasons_say(reasons, !v->adequate_after           ? "The misfit that is left still exceeds the noise."
                             : v->kind == ROTID_AMBIGUOUS ? "With the best of these causes the model is adequate."
                                                          : "The extended model is adequate.");
    if (d->noise.frequency_assumed || d->noise.shape_assumed)
        reasons_say(
            reasons,
            "The deck does not state all of the noise. The assumed values stand below; another noise may change the verdict, so "
            "no cause is named: state *NOISE.");
}

/* The named causes, and how many were tried. */
static void on_shares(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_verdict *v = &d->verdict;
    int tried = 0;
    for (int i = 0; i < d->ncandidates; i++)
        tried += d->candidates[i].refitted;
    for (int i = 0; i < v->nmarginals && v->kind == ROTID_NAMED && i < v->ncauses; i++)
        reasons_say(reasons, "%s: probability %s %%.", cause_name(pool, v->marginals[i].id, v->marginals[i].target),
                    human_digits(pool, 100 * v->marginals[i].probability, 3));
    const char *count = human_count(pool, tried);
    if (tried && v->kind != ROTID_ADEQUATE)
        reasons_say(reasons, "%c%s single %s fitted, then sets of them.", toupper((unsigned char)*count), count + 1,
                    human_plural(tried, "cause was", "causes were"));
}

static void on_parameters(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const char *moved = "";
    for (int p = 0; p < d->gain.nparameters; p++) {
        double percent = 100 * (d->gain.parameters[p].after / d->gain.parameters[p].before - 1);
        if (isfinite(percent))
            moved = pool_text(pool, "%s%s%s by %s\xc2\xa0%%", moved, *moved ? ", " : "", d->gain.parameters[p].name,
                              human_signed(pool, percent, fabs(percent) < 1 ? 2 : 1));
    }
    if (*moved && d->verdict.kind != -1)
        reasons_say(reasons, "The missing cause had biased the parameters; the extended model moves %s.", moved);
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (!fit->parameters[p].identifiable)
            reasons_say(reasons, "%s %s.", fit->parameters[p].name,
                        fit->parameters[p].at_bound ? "ends at its bound: its value without the bound is not known"
                                                    : "is not determined by these data");
    if (fit && fit->intervals_widened_by > 1)
        reasons_say(reasons, "The intervals of the %s are widened by %s: the misfit exceeds the noise.",
                    d->extended ? "extended model" : "model", human_digits(pool, fit->intervals_widened_by, 3));
}

/* What the FIT of the deck makes of the parameters beside the full model. */
static void on_today(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_identification *final = d->extended ? d->extended : d->base, *today = diagnosis_today(d);
    const char *text = "";
    for (int p = 0; today && p < today->nparameters; p++) {
        const rotid_fitted_parameter *is = &today->parameters[p], *of = fit_parameter(final, is->name);
        double percent = of ? 100 * (is->value / of->value - 1) : (double)NAN;
        if (isfinite(percent))
            text = pool_text(pool, "%s%s%s = %s, %s\xc2\xa0%%", text, *text ? "; " : "", is->name,
                             human_value(pool, is->value, is->unit), human_signed(pool, percent, 1));
    }
    if (*text)
        reasons_say(
            reasons,
            "The fit as the deck states it (%s, reduction %s, %s\xc2\xa0%% rms error of its frequencies) gives %s against the %s "
            "here, which is the full model judged by the likelihood.",
            today->functional, today->reduction, human_digits(pool, fit_rms_percent(today, 0), 2), text,
            d->extended ? "extended model" : "model");
}

struct reasons reasons_of_diagnosis(struct pool *pool, const rotid_diagnosis *d)
{
    struct reasons reasons = {.pool = pool};
    on_chance(&reasons, d);
    on_shares(&reasons, d);
    on_parameters(&reasons, d);
    on_today(&reasons, d);
    return reasons;
}

/* "sensor_gain in state hot: " */
static const char *finding_head(struct pool *pool, const char *id, const char *state)
{
    return pool_text(pool, "%s%s%s: ", id, state ? " in state " : "", or_nothing(state));
}

struct reasons findings_of_diagnosis(struct pool *pool, const rotid_diagnosis *d)
{
    struct reasons findings = {.pool = pool};
    for (int i = 0; i < d->ndata_findings; i++) {
        const rotid_data_finding *f = &d->data_findings[i];
        const struct human_unit unit = human_unit(f->value, f->unit);
        const struct cause_kind *kind = catalogue_find(f->id);
        const char *text = pool_text(pool, "%s%s", finding_head(pool, f->id, f->state), f->text ? f->text : "found");
        if (isfinite(f->value))
            text = pool_text(pool, "%s; %s", text, human_value(pool, f->value, f->unit));
        if (isfinite(f->std))
            text = pool_text(pool, "%s \xc2\xb1 %s", text, human_digits(pool, f->std * unit.factor, 2));
        if (isfinite(f->chi2_drop))
            text = pool_text(pool, "%s; \xcf\x87\xc2\xb2 less by %s", text, human_digits(pool, f->chi2_drop, 4));
        reasons_say(&findings, "%s.%s%s%s", text, kind ? " At the test: " : "", kind ? kind->check : "", kind ? "." : "");
    }
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *f = &d->numerical_findings[i];
        const char *text = pool_text(pool, "%s%s", finding_head(pool, f->id, f->state), f->text ? f->text : "found"),
                   *before = "; error [%]: ";
        for (int k = 0; k < f->nmodes; k++)
            if (isfinite(f->error_percent[k])) {
                text = pool_text(pool, "%s%smode %d %s", text, before, f->modes[k], human_signed(pool, f->error_percent[k], 3));
                before = ", ";
            }
        reasons_say(&findings, "%s.", text);
    }
    return findings;
}

/* "frequencies 0.10 %; shapes 1.5 % of the largest component (assumed)" */
const char *noise_in_words(struct pool *pool, const rotid_noise *noise)
{
    const char *assumed[] = {"", " (assumed)"},
               *frequency = isfinite(noise->frequency)
                                ? pool_text(pool, "frequencies %s\xc2\xa0%%%s", human_digits(pool, 100 * noise->frequency, 2),
                                            assumed[noise->frequency_assumed != 0])
                                : "frequencies: not stated",
               *shape = isfinite(noise->shape)
                            ? pool_text(pool, "shapes %s\xc2\xa0%% of the largest component%s",
                                        human_digits(pool, 100 * noise->shape, 2), assumed[noise->shape_assumed != 0])
                            : "shapes: not stated";
    return pool_text(pool, "%s; %s", frequency, shape);
}
