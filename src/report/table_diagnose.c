#include "report/table_diagnose.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "result/judgement.h"

static void print_heading(const struct diagnosis_view *view)
{
    const struct result_head *head = view->head;
    for (int i = 0; i < head->nheading; i++)
        wrap_text(view->out, 0, view->width, "", head->heading[i]);
    if (!head->nheading)
        wrap_text(view->out, 0, view->width, "", head->deck);
}

static void print_verdict(const struct diagnosis_view *view)
{
    const rotid_verdict *v = &view->diagnosis->verdict;
    const rotid_noise *noise = &view->diagnosis->noise;
    struct wrap wrap;
    (void)fprintf(view->out, "\nVERDICT  ");
    for (const char *c = v->sentence ? rotid_verdict_name(v->kind) : "none"; *c; c++)
        (void)fputc(toupper((unsigned char)*c), view->out);
    (void)fputc('\n', view->out);
    if (view->diagnosis->interrupted)
        wrap_text(view->out, 2, view->width, "  ", "INTERRUPTED: the finished part stands below; the diagnosis is not complete.");
    if (v->sentence)
        wrap_text(view->out, 2, view->width, "  ", v->sentence);
    wrap_open(&wrap, view->out, 2, view->width, "  ");
    if (isfinite(v->p_value) && v->sentence) {
        wrap_words(&wrap, "p-value (hypothesis: adequate model):");
        wrap_item(&wrap, v->p_value < 0.001 ? "below %g" : "%.3g", v->p_value < 0.001 ? 0.001 : v->p_value);
        if (v->kind != ROTID_ADEQUATE)
            wrap_words(&wrap, !v->adequate_after           ? "; the residual still exceeds the noise"
                              : v->kind == ROTID_AMBIGUOUS ? "; with the best of these causes the model is adequate"
                                                           : "; the extended model is adequate");
        wrap_close(&wrap);
    } else {
        wrap_words(&wrap, v->sentence ? "no p-value can be stated" : "no verdict was reached");
        wrap_close(&wrap);
    }
    if (noise->frequency_assumed || noise->shape_assumed)
        wrap_text(view->out, 2, view->width, "  ",
                  "The deck states no noise for all of the data: the assumed values stand below, so statements are relative.");
    if (v->next_measurement)
        wrap_text(view->out, 10, view->width, "  to settle it: ", v->next_measurement);
}

static double value_of(const rotid_identification *fit, const char *name)
{
    const rotid_fitted_parameter *parameter = fit_parameter(fit, name);
    return parameter ? parameter->value : NAN;
}

/* Errors of its frequencies, and the share of the reduction in them. */
static void print_frequencies_today(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_identification *fit = d->today;
    struct wrap wrap;
    int shown = 0, found = !strcmp(fit->reduction, "NONE"), worst = fit_worst_mode(fit);
    if (worst < 0)
        return;
    for (int i = 0; i < d->nnumerical_findings; i++) /* says it mode by mode */
        found |= !strcmp(d->numerical_findings[i].id, "guyan_reduction");
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    wrap_item(&wrap, "frequencies that were fitted: error %.3g %% rms, %.3g %% at most", fit_rms_percent(fit, 0),
              fabs(fit->modes[worst].error_percent));
    for (int k = 0; k < fit->nmodes && !found; k++) {
        double error = fit->reduction_error_percent[k];
        if (isfinite(error))
            wrap_item(&wrap, "%smode %d %+.2f", shown++ ? "" : "; error of the reduction [%]: ", fit->modes[k].mode, error);
    }
    wrap_close(&wrap);
}

static void print_today(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_identification *fit = d->today;
    if (!fit)
        return;
    int as_judged = !strcmp(fit->functional, "LIKELIHOOD") && !strcmp(fit->reduction, "NONE");
    (void)fprintf(view->out, "\nFIT AS SPECIFIED  %s, reduction %s: %s\n", fit->functional, fit->reduction,
                  as_judged ? "as it is judged below" : "what that choice alone costs");
    for (int i = 0; i < fit->nparameters; i++) {
        const rotid_fitted_parameter *p = &fit->parameters[i];
        struct wrap wrap;
        double base = 100 * (p->value / value_of(d->base, p->name) - 1),
               extended = 100 * (p->value / value_of(d->extended, p->name) - 1);
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s %.4g%s%s", p->name, p->value, layout_gap(p->unit), layout_unit(p->unit));
        if (p->at_bound)
            wrap_item(&wrap, "AT ITS BOUND");
        if (isfinite(base))
            wrap_item(&wrap, ": %+.1f %% off the full model by the likelihood", base);
        if (isfinite(extended))
            wrap_item(&wrap, ", %+.1f %% off the extended one", extended);
        wrap_close(&wrap);
    }
    print_frequencies_today(view);
}

static void print_numerical(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->nnumerical_findings)
        (void)fprintf(view->out, "\nNUMBERS  errors of the numbers themselves; the model that is judged is free of them\n");
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->numerical_findings[i];
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s%s%s:", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        if (finding->text)
            wrap_words(&wrap, finding->text);
        for (int k = 0, shown = 0; k < finding->nmodes; k++)
            if (isfinite(finding->error_percent[k]))
                wrap_item(&wrap, "%smode %d %+.3g", shown++ ? ", " : "; error [%]: ", finding->modes[k],
                          finding->error_percent[k]);
        wrap_close(&wrap);
    }
}

static void print_data(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (d->ndata_findings)
        (void)fprintf(view->out, "\nDATA  faults of the measurement, taken out before the physics is judged\n");
    for (int i = 0; i < d->ndata_findings; i++) {
        const rotid_data_finding *finding = &d->data_findings[i];
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s%s%s", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        for (int n = 0; n < finding->nsensors; n++)
            wrap_item(&wrap, "%s%d", n ? "and " : "sensor ", finding->sensors[n]);
        for (int k = 0; k < finding->nmodes; k++)
            wrap_item(&wrap, "%s%d", k ? "and " : "mode ", finding->modes[k]);
        if (finding->block)
            wrap_item(&wrap, "%s", finding->block);
        if (isfinite(finding->value))
            wrap_item(&wrap, ": %.3g%s%s", finding->value, layout_gap(finding->unit), layout_unit(finding->unit));
        if (isfinite(finding->std))
            wrap_item(&wrap, "+- %.2g", finding->std);
        if (isfinite(finding->chi2_drop))
            wrap_item(&wrap, ", chi2 less by %.4g", finding->chi2_drop);
        if (finding->text) {
            wrap_item(&wrap, ";");
            wrap_words(&wrap, finding->text);
        }
        wrap_close(&wrap);
    }
}

static void print_noise(const struct diagnosis_view *view)
{
    static const char *const said[] = {"stated", "the deck states none: assumed"};
    const rotid_noise *noise = &view->diagnosis->noise;
    struct wrap wrap;
    int frequency = noise->frequency > 0, shape = noise->shape > 0; /* NaN: no */
    wrap_open(&wrap, view->out, 7, view->width, "noise  ");
    if (frequency)
        wrap_item(&wrap, "frequencies %.3g %% (%s)%s", 100 * noise->frequency, said[noise->frequency_assumed != 0],
                  shape ? "," : "");
    if (shape)
        wrap_item(&wrap, "shapes %.3g %% of the largest component (%s)", 100 * noise->shape, said[noise->shape_assumed != 0]);
    if (!frequency && !shape)
        wrap_item(&wrap, "unknown");
    wrap_close(&wrap);
}

static void print_foot(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    double seconds = 0;
    (void)fputc('\n', view->out);
    print_noise(view);
    for (int i = 0; i < d->nsteps; i++)
        seconds += d->steps[i].seconds;
    (void)fprintf(view->out, "seed %.0f, %d thread%s", view->head->seed, view->head->threads,
                  view->head->threads == 1 ? "" : "s");
    if (d->nsteps)
        (void)fprintf(view->out, ", %.3g s", seconds);
    (void)fputc('\n', view->out);
    if (!view->verbose || !d->nsteps)
        return;
    wrap_open(&wrap, view->out, 7, view->width, "time   ");
    for (int i = 0; i < d->nsteps; i++)
        wrap_item(&wrap, "%s %.3g s%s", d->steps[i].name, d->steps[i].seconds, i + 1 < d->nsteps ? "," : "");
    wrap_close(&wrap);
}

void table_diagnose(const struct diagnosis_view *view)
{
    print_heading(view);
    print_verdict(view);
    table_parameters(view);
    print_today(view);
    print_numerical(view);
    print_data(view);
    table_misfit(view);
    table_evidence(view);
    table_gain(view);
    table_detection_limits(view);
    print_foot(view);
}
