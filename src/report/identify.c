/* A fit: its tables, and `rotid identify` on the screen. */
#include "fit/fit.h"
#include "report/report.h"

struct table *table_of_compared_modes(struct pool *pool, const struct result_head *head, const rotid_identification *fit,
                                      const char *caption)
{
    const rotid_reference *hz = head_reference(head, "predicted_hz"), *error = head_reference(head, "error_percent");
    const unsigned reduced = strcmp(fit->reduction, "NONE") ? 0 : IN_CSV_ONLY; /* what a condensation would cost */
    struct table *table = table_open(pool, caption ? caption : "Modes: errors are predicted over measured frequency, less one");
    int typed = 0; /* not all are of bending; older results have no type */
    for (int k = 0; k < fit->nmodes; k++)
        typed |= fit->modes[k].type && !same_text(fit->modes[k].type, "BENDING");
    for (int k = 0; k < fit->nmodes; k++) {
        const rotid_compared_mode *mode = &fit->modes[k];
        if (fit->nstates)
            text_column(table, "state", SHOW_TEXT, fit_state_of_mode(fit, k));
        if (typed)
            text_column(table, "type", SHOW_TEXT, mode->type);
        number_column(table, "mode", NULL, SHOW_COUNT, mode->mode);
        number_column(table, "measured mode", NULL, SHOW_COUNT | IN_CSV_ONLY, mode->measured_mode);
        number_column(table, "measured", "Hz", SHOW_FIXED(3), mode->measured_hz);
        number_column(table, "predicted", "Hz", SHOW_FIXED(3), mode->predicted_hz);
        number_column(table, "error", "%", SHOW_SIGNED(3), mode->error_percent);
        number_column(table, "reference", "Hz", SHOW_FIXED(2) | NOT_IN_CSV, reference_value(hz, k));
        number_column(table, "reference error", "%", SHOW_SIGNED(2) | NOT_IN_CSV, reference_value(error, k));
        number_column(table, "reduction", "%", SHOW_SIGNED(3) | reduced, fit->reduction_error_percent[k]);
        number_column(table, "mesh", "%", SHOW_SIGNED(4), fit->mesh_error_percent[k]);
        number_column(table, "nco", NULL, SHOW_FIXED(3), mode->nco);
        number_column(table, "mac", NULL, SHOW_FIXED(3), mode->mac);
        number_column(table, "noise", "%", SHOW_FIXED(3) | NOT_IN_CSV | DETAIL, 100 * mode->frequency_std);
        text_column(table, "paired by", NOT_IN_CSV | DETAIL, mode->paired_by);
        number_column(table, "held out", NULL, SHOW_COUNT | IN_CSV_ONLY, mode->holdout);
        text_column(table, "remark", NOT_IN_CSV, mode->holdout ? "held out" : "");
    }
    return table;
}

struct table *table_of_parameters(struct pool *pool, const rotid_identification *fit)
{
    struct table *table = table_open(pool, "Parameters");
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *is = &fit->parameters[p];
        text_column(table, "parameter", SHOW_TEXT, is->name);
        unit_column(table, is->value, (is->ci95[1] - is->ci95[0]) / 2, is->unit);
        number_column(table, "value", ROW_UNIT, SHOW_ROW, is->value);
        number_column(table, "std", ROW_UNIT, SHOW_DIGITS(2), is->std);
        number_column(table, "lower 95 %", ROW_UNIT, SHOW_ROW, is->ci95[0]);
        number_column(table, "upper 95 %", ROW_UNIT, SHOW_ROW, is->ci95[1]);
        number_column(table, "start", ROW_UNIT, SHOW_TRIMMED(5), is->start);
        number_column(table, "lower bound", ROW_UNIT, SHOW_TRIMMED(5) | NOT_IN_CSV | DETAIL, is->lower);
        number_column(table, "upper bound", ROW_UNIT, SHOW_TRIMMED(5) | NOT_IN_CSV | DETAIL, is->upper);
        number_column(table, "at bound", NULL, SHOW_COUNT | IN_CSV_ONLY, is->at_bound);
        number_column(table, "identifiable", NULL, SHOW_COUNT | IN_CSV_ONLY, is->identifiable);
        text_column(table, "remark", NOT_IN_CSV, parameter_remark(pool, is));
    }
    return table;
}

struct table *table_of_states(struct pool *pool, const rotid_identification *fit)
{
    struct table *table = table_open(pool, "States: one set of parameters for all, each with its own model and modes");
    for (int s = 0; s < fit->nstates; s++) {
        const rotid_identification own = fit_of_state(pool, fit, s);
        text_column(table, "state", SHOW_TEXT, fit->states[s].name);
        number_column(table, "modes", NULL, SHOW_COUNT, own.nmodes);
        number_column(table, "residuals", NULL, SHOW_COUNT, fit->states[s].fitted_residuals);
        number_column(table, "rms error, fitted", "%", SHOW_FIXED(3), fit_rms_percent(&own, 0));
        number_column(table, "held out", "%", SHOW_FIXED(3), fit_rms_percent(&own, 1));
        number_column(table, "chi2", NULL, SHOW_DIGITS(3), own.chi2);
        number_column(table, "length", "m", SHOW_TRIMMED(5), own.geometry ? own.geometry->length_m : (double)NAN);
        number_column(table, "mass", "kg", SHOW_TRIMMED(5), own.mass_kg);
    }
    return table;
}

struct table *table_of_weighed(struct pool *pool, int count, const rotid_weighed *list)
{
    struct table *t = table_open(pool, "WEIGHED: mass and centre of mass beside the model's");
    for (int i = 0; i < count; i++) {
        int centre = same_text(list[i].quantity, "centre");
        text_column(t, "quantity", SHOW_TEXT, centre ? "centre of mass [m]" : "mass [kg]");
        text_column(t, "state", SHOW_TEXT, list[i].state);
        number_column(t, "measured", NULL, SHOW_TRIMMED(6), list[i].measured);
        number_column(t, "std", NULL, SHOW_DIGITS(2), list[i].std);
        number_column(t, "model", NULL, SHOW_DIGITS(6), list[i].predicted);
        number_column(t, "z", NULL, SHOW_SIGNED(1), list[i].z);
        if (!centre && fabs(list[i].z) > ANOTHER_MASS)
            table_note(t,
                       "the model is %.2g %% too %s: correct diameters, bores and densities first (rotid check prints "
                       "the mass of each group)",
                       100 * fabs(list[i].predicted / list[i].measured - 1),
                       list[i].predicted > list[i].measured ? "heavy" : "light");
    }
    return t;
}

struct table *table_of_minimisers(struct pool *pool, const rotid_identification *fit)
{
    struct table *table = table_open(pool, "Minimisers from the same start");
    for (int b = 0; b <= fit->nbaseline; b++) {
        const rotid_minimiser *other = b ? &fit->baseline[b - 1] : NULL;
        text_column(table, "minimiser", SHOW_TEXT, other ? pool_text(pool, "NLopt %s", other->algorithm) : "Levenberg-Marquardt");
        number_column(table, "objective", NULL, SHOW_DIGITS(4), other ? other->objective : fit->objective);
        number_column(table, "gradient", NULL, SHOW_DIGITS(2) | DETAIL, other ? other->gradient : fit->gradient);
        number_column(table, "evaluations", NULL, SHOW_COUNT, other ? other->evaluations : fit->evaluations);
        number_column(table, "time", "ms", SHOW_FIXED(1), 1e3 * (other ? other->seconds : fit->seconds));
        for (int p = 0; p < fit->nparameters; p++) {
            const rotid_fitted_parameter *is = &fit->parameters[p];
            scaled_column(table, is->name, is->unit, SHOW_DIGITS(7), is->value, other ? other->x[p] : is->value);
        }
        text_column(table, "result", SHOW_TEXT, other ? other->result : fit->stop_reason);
    }
    return table;
}

#define SAME_POINT 1e-6 /* relative difference of objectives */

const char *minimisers_sentence(struct pool *pool, const rotid_identification *fit, int *lower)
{
    double best = INFINITY, furthest = 0;
    const char *names = "";
    for (int b = 0; b < fit->nbaseline; b++) {
        if (!fit->baseline[b].usable || !isfinite(fit->baseline[b].objective))
            continue;
        best = fmin(best, fit->baseline[b].objective);
        furthest = fmax(furthest, fabs(fit->baseline[b].objective / fit->objective - 1));
        names = pool_text(pool, "%s%s%s", names, *names ? ", " : "", fit->baseline[b].algorithm);
    }
    *lower = best < fit->objective * (1 - SAME_POINT);
    if (!*names)
        return "";
    if (*lower)
        return pool_text(pool, "NLopt (%s) finds a lower minimum: %s, against %s of this fit", names, human_digits(pool, best, 6),
                         human_digits(pool, fit->objective, 6));
    return pool_text(pool,
                     furthest <= SAME_POINT ? "NLopt (%s) finds the same minimum"
                                            : "NLopt (%s) finds no lower minimum; not all of its minimisers came as far",
                     names);
}

static struct table *table_of_history(struct pool *pool, const rotid_identification *fit)
{
    struct table *table = table_open(pool, "Iterations");
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_history_entry *entry = &fit->history[i];
        number_column(table, "iteration", NULL, SHOW_COUNT, entry->iteration);
        number_column(table, "objective", NULL, SHOW_DIGITS(4), entry->objective);
        number_column(table, "gradient", NULL, SHOW_DIGITS(3), entry->gradient);
        number_column(table, "mu", NULL, SHOW_DIGITS(3), entry->mu);
        number_column(table, "gain", NULL, SHOW_FIXED(3), entry->gain_ratio);
        number_column(table, "step", NULL, SHOW_DIGITS(3), entry->step);
    }
    return table;
}

static void print_parameters(const struct screen *to, const rotid_identification *fit)
{
    int n = fit->nparameters;
    screen_table(to, table_of_parameters(to->pool, fit));
    for (int j = 0; j < fit->nundetermined_directions; j++) {
        const char *text = "";
        for (int p = 0; p < n; p++) {
            const rotid_component *component = &fit->undetermined_directions[p + (ptrdiff_t)j * n];
            if (fabs(component->value) > 0.05)
                text = pool_text(to->pool, "%s %+.2f %s", text, component->value, component->name);
        }
        screen_say(to, "the data do not determine the combination%s (relative changes)", text);
    }
    if (n > 1)
        screen_say(to, "condition number %s%s", human_digits(to->pool, fit->condition_number, 3),
                   n == 2 && isfinite(fit->correlation[1]) ? pool_text(to->pool, ", correlation %.3f", fit->correlation[1]) : "");
}

void screen_identify(const struct screen *to, const struct result *result, int baseline)
{
    const rotid_identification *fit = result->identify;
    const struct reasons reasons = reasons_of_fit(to->pool, &result->head, fit);
    int lower, fitted = 0;
    for (int k = 0; k < fit->nmodes; k++)
        fitted += !fit->modes[k].holdout;
    screen_heading(to, &result->head);
    screen_say(to, "fit of %d %s, functional %s, reduction %s, objective %s, gradient %s", fitted,
               human_plural(fitted, "mode", "modes"), fit->functional, fit->reduction, human_digits(to->pool, fit->objective, 4),
               human_digits(to->pool, fit->gradient, 2));
    screen_reasons(to, &reasons);
    print_parameters(to, fit);
    if (fit->nbaseline && (!*minimisers_sentence(to->pool, fit, &lower) || lower || to->verbose))
        screen_table(to, table_of_minimisers(to->pool, fit));
    if (baseline && !fit->nlopt)
        screen_say(to, "\nno check by NLopt: this rotid is built without it (WITH_NLOPT=0)");
    if (to->verbose)
        screen_table(to, table_of_history(to->pool, fit));
    screen_table(to, table_of_states(to->pool, fit));
    screen_table(to, table_of_compared_modes(to->pool, &result->head, fit, NULL));
    screen_table(to, table_of_runup(to->pool, fit->nrunup, fit->runup));
    screen_table(to, table_of_weighed(to->pool, fit->nweighed, fit->weighed));
}
