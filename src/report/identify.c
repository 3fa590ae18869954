/* A fit: its tables, and `rotid identify` on the screen. */
#include <math.h>
#include <string.h>

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
    const char *quote = "";
    for (int p = 0; p < fit->nparameters && !fit_is_inadequate(fit); p++) {
        const rotid_fitted_parameter *is = &fit->parameters[p];
        const char *one = is->at_bound || !is->identifiable ? NULL : human_quote(pool, is->value, is->ci95, is->unit);
        quote = one ? pool_text(pool, "%s%s%s = %s", quote, *quote ? ", " : "", is->name, one) : quote;
    }
    if (*quote)
        table_note(table, "%s (95 %%)", quote);
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
        text_column(table, "remark", NOT_IN_CSV,
                    is->at_bound             ? "at its bound"
                    : !is->identifiable      ? "not determined by these data"
                    : !isfinite(is->ci95[0]) ? "no interval can be stated"
                    : interval_is_wide(is->value, is->ci95[0], is->ci95[1])
                        ? pool_text(pool, "determined to %s only",
                                    percent_text(interval_half_percent(is->value, is->ci95[0], is->ci95[1]), (char[32]){""}))
                        : "");
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

static void print_rms(FILE *out, const rotid_identification *fit)
{
    double fitted = fit_rms_percent(fit, 0), held_out = fit_rms_percent(fit, 1);
    if (isfinite(fitted))
        (void)fprintf(out, "rms error of the fitted modes %.2f %%%s", fitted,
                      isfinite(held_out) ? ", of the modes held out " : "\n");
    else if (isfinite(held_out)) /* a state that is held out */
        (void)fputs("rms error of the modes held out ", out);
    if (isfinite(held_out))
        (void)fprintf(out, "%.2f %%\n", held_out);
}

/* What the intervals rest on, what the misfit has made of them, and whether the model is adequate. */
static void print_intervals(const struct screen *to, const struct result_head *head, const rotid_identification *fit)
{
    FILE *out = to->out;
    double wide = fit->intervals_widened_by;
    if (fit->noise && !strcmp(fit->noise->intervals_from, "residuals") && fit->dof > 0)
        screen_say(
            to,
            "intervals are estimated from the residuals (Student t, %d degrees of freedom); state *NOISE to take them from "
            "the measurement",
            fit->dof);
    if (wide > 1 && fit_is_inadequate(fit))
        screen_say(to, "the misfit is %.3g times the stated noise: the intervals are widened by that", wide);
    else if (wide > 1) /* half of all adequate models have a misfit above the noise */
        screen_say(to,
                   "the misfit is %.3g times the stated noise: the intervals are widened by that; noise alone causes as much in "
                   "%.0f %% of tests",
                   wide, 100 * fit_p_value(fit));
    int k = fit_mode_of_mesh(fit);
    if (k >= 0) {
        screen_say(
            to,
            "the model is not adequate for these data, which biases its parameters: its mesh moves mode %d by %+.2g %%, %.3g "
            "times the noise; give more elements",
            fit->modes[k].mode, fit->mesh_error_percent[k], fabs(fit->mesh_error_percent[k]) / 100 / fit->modes[k].frequency_std);
    } else if (fit_is_inadequate(fit)) {
        (void)fputs("the model is not adequate for these data, which biases its parameters; rotid diagnose ", out);
        name_cell(out, 0, head->deck ? head->deck : "DECK");
        (void)fputs(" looks for the cause\n", out);
    }
}

/* What the intervals know nothing of: the cause that moves each parameter most, where that is more than half of its interval. */
static void print_hidden(const struct screen *to, const rotid_identification *fit)
{
    int shown = 0;
    struct wrap wrap;
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *value = &fit->parameters[p];
        const rotid_hidden *hidden = hidden_in(fit->nhidden, fit->hidden, value);
        if (!hidden)
            continue;
        if (!shown++)
            wrap = wrap_open(to->out, 2, to->width, "possible bias by a cause below its detection limit: ");
        wrap_item(&wrap, "%s%s by %s", shown > 1 ? ", " : "", value->name,
                  linear_percent_text(100 * fabs(hidden->shift / value->value), (char[32]){""}));
        wrap_item(&wrap, "(%s%s%s)", hidden->id, *hidden->target ? " of " : "", hidden->target);
    }
    if (!shown)
        return;
    wrap_words(&wrap, ": see rotid diagnose");
    wrap_close(&wrap);
}

static void print_parameters(const struct screen *to, const struct result_head *head, const rotid_identification *fit)
{
    int n = fit->nparameters;
    screen_table(to, table_of_parameters(to->pool, fit));
    for (int j = 0; j < fit->nundetermined_directions; j++) {
        (void)fputs("the data do not determine the combination", to->out);
        for (int p = 0; p < n; p++) {
            const rotid_component *component = &fit->undetermined_directions[p + (ptrdiff_t)j * n];
            if (fabs(component->value) > 0.05)
                (void)fprintf(to->out, " %+.2f %s", component->value, component->name);
        }
        (void)fputs(" (relative changes)\n", to->out);
    }
    if (n > 1)
        (void)fprintf(to->out, "condition number %s", IN_DIGITS(3, fit->condition_number));
    if (n == 2 && isfinite(fit->correlation[1]))
        (void)fprintf(to->out, ", correlation %.3f", fit->correlation[1]);
    (void)fputs(n > 1 ? "\n" : "", to->out);
    print_intervals(to, head, fit);
    if (!fit_is_inadequate(fit)) /* else something shows already */
        print_hidden(to, fit);
}

static void print_head(const struct screen *to, const rotid_identification *fit)
{
    int fitted = 0;
    for (int k = 0; k < fit->nmodes; k++)
        fitted += !fit->modes[k].holdout;
    (void)fprintf(to->out, "%s, fit of %d %s, functional %s, reduction %s, objective %s, gradient %s\n",
                  !strcmp(fit->status, "converged")  ? "converged"
                  : !strcmp(fit->status, "at_bound") ? "converged AT A BOUND"
                                                     : "NOT CONVERGED",
                  fitted, human_plural(fitted, "mode", "modes"), fit->functional, fit->reduction, IN_DIGITS(4, fit->objective),
                  IN_DIGITS(2, fit->gradient));
}

void screen_identify(const struct screen *to, const struct result *result, int baseline)
{
    const rotid_identification *fit = result->identify;
    FILE *out = to->out;
    screen_heading(to, &result->head);
    print_head(to, fit);
    print_parameters(to, &result->head, fit);
    int lower;
    const char *beside = minimisers_sentence(to->pool, fit, &lower);
    if (fit->nbaseline && (to->verbose || lower || !*beside))
        screen_table(to, table_of_minimisers(to->pool, fit));
    if (*beside)
        screen_say(to, "%s", beside);
    else if (baseline && !fit->nlopt)
        (void)fprintf(out, "\nno check by NLopt: this rotid is built without it (WITH_NLOPT=0)\n");
    if (to->verbose)
        screen_table(to, table_of_history(to->pool, fit));
    for (int s = 0; s < fit->nstates; s++) {
        const struct result own = result_of_state(to->pool, result, s);
        const char *held_out = fit->states[s].fitted_residuals ? "" : ", held out";
        if (!own.identify)
            return;
        screen_table(to, table_of_compared_modes(to->pool, &own.head, own.identify,
                                                 pool_text(to->pool, "state %s%s", fit->states[s].name, held_out)));
        print_rms(out, own.identify);
    }
    if (fit->nstates)
        (void)fputs("\nall states: ", out);
    else
        screen_table(to, table_of_compared_modes(to->pool, &result->head, fit, NULL));
    print_rms(out, fit);
    screen_table(to, table_of_runup(to->pool, fit->nrunup, fit->runup));
    screen_table(to, table_of_weighed(to->pool, fit->nweighed, fit->weighed));
    if (strcmp(fit->functional, "LIKELIHOOD") != 0)
        screen_say(to,
                   "the hybrid quotient equals the frequency of the %s for any measured shape: this functional fits frequencies "
                   "alone",
                   strcmp(fit->reduction, "NONE") ? "condensed model" : "model");
    if (isfinite(fit->chi2_per_dof))
        (void)fprintf(out, "chi2 %.4g with %d degrees of freedom\n", fit->chi2, fit->dof);
}
