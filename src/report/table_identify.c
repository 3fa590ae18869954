#include <math.h>
#include <string.h>

#include "fit/fit.h"
#include "report/report.h"
#include "result/result.h"

static void print_rms(FILE *out, const rotid_identification *fit)
{
    double fitted = fit_rms_percent(fit, 0), held_out = fit_rms_percent(fit, 1);
    int predicted_alone = isfinite(held_out) && !isfinite(fitted); /* a state that is held out */
    if (!predicted_alone) {
        (void)fputs("rms error of the fitted modes ", out);
        number_cell(out, 0, 2, fitted);
        (void)fputs(" %", out);
    }
    if (isfinite(held_out)) {
        (void)fputs(predicted_alone ? "rms error of the modes held out " : ", of the modes held out ", out);
        number_cell(out, 0, 2, held_out);
        (void)fputs(" %", out);
    }
    (void)fprintf(out, "\n");
}

/* first: number of the first one among the references of the heading */
static void print_modes(FILE *out, const struct result_head *head, int first, const rotid_identification *fit)
{
    const rotid_reference *paper_hz = head_reference(head, "predicted_hz"), *paper_error = head_reference(head, "error_percent");
    int paper = paper_hz || paper_error, shapes = 0, reduced = strcmp(fit->reduction, "NONE") != 0;
    for (int k = 0; k < fit->nmodes; k++)
        shapes |= isfinite(fit->modes[k].nco);
    (void)fprintf(out, "mode   measured  predicted    error%s%s    mesh%s\n", paper ? "      paper    paper" : "",
                  reduced ? "  reduction" : "", shapes ? "     NCO    MAC" : "");
    (void)fprintf(out, "           [Hz]       [Hz]      [%%]%s%s     [%%]\n", paper ? "       [Hz]      [%]" : "",
                  reduced ? "        [%]" : "");
    for (int k = 0; k < fit->nmodes; k++) {
        const rotid_compared_mode *mode = &fit->modes[k];
        (void)fprintf(out, "%4d", mode->mode);
        number_cell(out, 11, 2, mode->measured_hz);
        number_cell(out, 11, 2, mode->predicted_hz);
        signed_cell(out, 9, 2, mode->error_percent);
        if (paper) {
            number_cell(out, 11, 2, reference_value(paper_hz, first + k));
            signed_cell(out, 9, 2, reference_value(paper_error, first + k));
        }
        if (reduced)
            signed_cell(out, 11, 2, fit->reduction_error_percent[k]);
        signed_cell(out, 8, 3, fit->mesh_error_percent[k]);
        if (shapes) {
            number_cell(out, 8, 3, mode->nco);
            number_cell(out, 7, 3, mode->mac);
        }
        (void)fprintf(out, "%s\n", mode->holdout ? "  held out" : "");
    }
    print_rms(out, fit);
}

static void print_parameter(FILE *out, const rotid_fitted_parameter *p)
{
    double ratio = fabs(p->value) / (p->ci95[1] - p->ci95[0]); /* an interval shows two digits of its width */
    int digits = ratio > 1e3 && isfinite(ratio) ? (int)ceil(log10(ratio)) + 2 : 5;
    digits = digits < 5 ? 5 : digits > 8 ? 8 : digits;
    name_cell(out, 14, p->name);
    (void)fprintf(out, " %14.*g  %-8s ", digits > 6 ? digits : 6, p->value, p->unit);
    if (isfinite(p->ci95[0]))
        (void)fprintf(out, "%12.*g ...%12.*g", digits, p->ci95[0], digits, p->ci95[1]);
    else
        (void)fprintf(out, "%27s", "cannot be stated");
    (void)fprintf(out, "   %.4g%s", p->start,
                  p->at_bound        ? "   AT ITS BOUND"
                  : !p->identifiable ? "   NOT DETERMINED by these data"
                                     : "");
    if (p->identifiable && interval_is_wide(p->value, p->ci95[0], p->ci95[1]))
        (void)fprintf(out, "   to %s only",
                      percent_text(interval_half_percent(p->value, p->ci95[0], p->ci95[1]), (char[32]){""}));
    (void)fputc('\n', out);
}

/* What the intervals rest on, what the misfit has made of them, and whether the model is adequate. */
static void print_intervals(FILE *out, const struct result_head *head, const rotid_identification *fit)
{
    if (fit->noise && !strcmp(fit->noise->intervals_from, "residuals") && fit->dof > 0)
        (void)fprintf(out,
                      "intervals rest on the misfit that is left (Student t, %d degrees of freedom); state *NOISE to rest them "
                      "on the measurement\n",
                      fit->dof);
    if (fit->intervals_widened_by > 1)
        (void)fprintf(out, "the misfit is %s times the stated noise: the intervals are widened by that",
                      IN_DIGITS(3, fit->intervals_widened_by));
    if (fit->intervals_widened_by > 1 && !fit_is_inadequate(fit)) /* half of all adequate models have a misfit above the noise */
        (void)fprintf(out, "; noise alone does as much in %.0f %% of such tests", 100 * fit_p_value(fit));
    if (fit->intervals_widened_by > 1)
        (void)fputc('\n', out);
    if (fit_is_inadequate(fit)) {
        (void)fputs("the model is not adequate for these data: its parameters have absorbed what it lacks; rotid diagnose ", out);
        name_cell(out, 0, head->deck ? head->deck : "DECK");
        (void)fputs(" looks for the cause\n", out);
    }
}

/* What the intervals know nothing of: the cause that moves each parameter most, where that is more than half of its interval. */
static void print_hidden(FILE *out, const rotid_identification *fit)
{
    int shown = 0;
    struct wrap wrap;
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *value = &fit->parameters[p];
        const rotid_hidden *hidden = hidden_in(fit->nhidden, fit->hidden, value);
        if (!hidden)
            continue;
        if (!shown++)
            wrap_open(&wrap, out, 2, 100, "a cause that these data would not show may move ");
        wrap_item(&wrap, "%s%s by %s", shown > 1 ? ", " : "", value->name,
                  linear_percent_text(100 * fabs(hidden->shift / value->value), (char[32]){""}));
        wrap_item(&wrap, "(%s%s%s)", hidden->id, *hidden->target ? " of " : "", hidden->target);
    }
    if (!shown)
        return;
    wrap_words(&wrap, ": see rotid diagnose");
    wrap_close(&wrap);
}

static void print_parameters(FILE *out, const struct result_head *head, const rotid_identification *fit)
{
    int n = fit->nparameters;
    (void)fprintf(out, "%-14s %14s  %-8s %27s   %s\n", "parameter", "value", "unit", "95 % interval", "start");
    for (int p = 0; p < n; p++)
        print_parameter(out, &fit->parameters[p]);
    for (int j = 0; j < fit->nundetermined_directions; j++) {
        (void)fprintf(out, "the data do not determine the combination");
        for (int p = 0; p < n; p++) {
            const rotid_component *component = &fit->undetermined_directions[p + (ptrdiff_t)j * n];
            if (fabs(component->value) > 0.05)
                (void)fprintf(out, " %+.2f %s", component->value, component->name);
        }
        (void)fprintf(out, " (relative changes)\n");
    }
    if (n > 1) {
        (void)fprintf(out, "condition number %s", IN_DIGITS(3, fit->condition_number));
        if (n == 2 && isfinite(fit->correlation[1]))
            (void)fprintf(out, ", correlation %.3f", fit->correlation[1]);
        (void)fprintf(out, "\n");
    }
    print_intervals(out, head, fit);
    if (!fit_is_inadequate(fit)) /* else something shows already */
        print_hidden(out, fit);
}

static void print_history(FILE *out, const rotid_identification *fit)
{
    (void)fprintf(out, "\niteration   objective         gradient    mu         gain      step\n");
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_history_entry *entry = &fit->history[i];
        (void)fprintf(out, "%6d", entry->iteration);
        power_cell(out, 22, 10, entry->objective);
        power_cell(out, 10, 2, entry->gradient);
        power_cell(out, 12, 2, entry->mu);
        number_cell(out, 10, 3, entry->gain_ratio);
        power_cell(out, 10, 2, entry->step);
        (void)fputc('\n', out);
    }
}

/* The objective of one that failed may be none. */
static void print_minimiser(FILE *out, const char *library, const char *name, double objective, int evaluations, double seconds)
{
    (void)fprintf(out, "%s%-*s", library, 20 - (int)strlen(library), name);
    power_cell(out, 15, 8, objective);
    (void)fprintf(out, " %11d %9.2f", evaluations, 1e3 * seconds);
}

static void print_baseline(FILE *out, const rotid_identification *fit)
{
    (void)fprintf(out, "\n%-20s %14s %11s %9s", "minimiser", "objective", "evaluations", "ms");
    for (int p = 0; p < fit->nparameters; p++)
        (void)fprintf(out, " %13s", fit->parameters[p].name);
    (void)fprintf(out, "   result\n");
    print_minimiser(out, "", "Levenberg-Marquardt", fit->objective, fit->evaluations, fit->seconds);
    for (int p = 0; p < fit->nparameters; p++)
        digits_cell(out, 14, 7, fit->parameters[p].value);
    (void)fprintf(out, "   %s\n", fit->stop_reason);
    for (int i = 0; i < fit->nbaseline; i++) {
        const rotid_minimiser *b = &fit->baseline[i];
        print_minimiser(out, "NLopt ", b->algorithm, b->objective, b->evaluations, b->seconds);
        for (int p = 0; p < b->nx; p++)
            digits_cell(out, 14, 7, b->x[p]);
        (void)fprintf(out, "   %s\n", b->result);
    }
}

static void print_head(FILE *out, const rotid_identification *fit)
{
    int fitted = 0;
    for (int k = 0; k < fit->nmodes; k++)
        fitted += !fit->modes[k].holdout;
    (void)fprintf(out, "%s, fit of %d mode%s, functional %s, reduction %s, objective %s, gradient ",
                  !strcmp(fit->status, "converged")  ? "converged"
                  : !strcmp(fit->status, "at_bound") ? "converged AT A BOUND"
                                                     : "NOT CONVERGED",
                  fitted, fitted == 1 ? "" : "s", fit->functional, fit->reduction, IN_DIGITS(10, fit->objective));
    power_cell(out, 0, 1, fit->gradient);
    (void)fputs("\n\n", out);
}

void table_identify(FILE *out, const struct result *result, int baseline, int history)
{
    const rotid_identification *fit = result->identify;
    table_heading(out, &result->head);
    print_head(out, fit);
    print_parameters(out, &result->head, fit);
    if (fit->nbaseline)
        print_baseline(out, fit);
    else if (baseline && !fit->nlopt)
        (void)fprintf(out, "\nno minimiser beside it: this rotid is built without NLopt (WITH_NLOPT=0)\n");
    if (history)
        print_history(out, fit);
    (void)fputc('\n', out);
    for (int s = 0, first = 0; s < fit->nstates; first += fit->states[s++].nmodes) {
        const rotid_identification of_state = fit_of_state(fit, s);
        (void)fprintf(out, "state %s%s\n", fit->states[s].name, fit->states[s].fitted_residuals ? "" : ", held out");
        print_modes(out, &result->head, first, &of_state);
        (void)fputc('\n', out);
    }
    if (!fit->nstates) {
        print_modes(out, &result->head, 0, fit);
    } else {
        (void)fputs("all states: ", out);
        print_rms(out, fit);
    }
    if (strcmp(fit->functional, "LIKELIHOOD") != 0)
        (void)fprintf(
            out,
            "the hybrid quotient equals the frequency of the %s for any measured shape: this functional fits frequencies alone\n",
            strcmp(fit->reduction, "NONE") ? "condensed model" : "model");
    if (isfinite(fit->chi2_per_dof))
        (void)fprintf(out, "chi2 %.4g with %d degrees of freedom\n", fit->chi2, fit->dof);
}
