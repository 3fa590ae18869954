#include "report/table_diagnose.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "diagnose/items.h"
#include "report/layout.h"

static void print_heading(const struct diagnosis_view *view)
{
    const struct job *job = view->deck;
    for (int i = 0; i < job->nheading; i++)
        wrap_text(view->out, 0, view->width, "", job->heading[i]);
    if (!job->nheading)
        wrap_text(view->out, 0, view->width, "", job->deck);
}

static void print_verdict(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    struct wrap wrap;
    (void)fprintf(view->out, "\nVERDICT  ");
    for (const char *c = d->sentence ? verdict_name(d->kind) : "none"; *c; c++)
        (void)fputc(toupper((unsigned char)*c), view->out);
    (void)fputc('\n', view->out);
    if (d->interrupted)
        wrap_text(view->out, 2, view->width, "  ", "INTERRUPTED: below stands what was finished; it is no complete diagnosis.");
    if (d->sentence)
        wrap_text(view->out, 2, view->width, "  ", d->sentence);
    wrap_open(&wrap, view->out, 2, view->width, "  ");
    if (isfinite(d->p_value) && d->sentence) {
        wrap_words(&wrap, "chance that an adequate model misfits so:");
        wrap_item(&wrap, d->p_value < 0.001 ? "below %g" : "%.3g", d->p_value < 0.001 ? 0.001 : d->p_value);
        if (d->kind != VERDICT_ADEQUATE)
            wrap_words(&wrap, !d->adequate_after             ? "; what is left is more than noise"
                              : d->kind == VERDICT_AMBIGUOUS ? "; with the best of them it is adequate"
                                                             : "; with what is named it is adequate");
        wrap_close(&wrap);
    } else {
        wrap_words(&wrap, d->sentence ? "no chance can be stated" : "no verdict was reached");
        wrap_close(&wrap);
    }
    if (d->frequency_noise_assumed || d->shape_noise_assumed)
        wrap_text(view->out, 2, view->width, "  ",
                  "The deck states no noise for all of the data: what is assumed stands below, so statements are relative.");
    if (d->next_measurement)
        wrap_text(view->out, 10, view->width, "  to settle it: ", d->next_measurement);
}

static double value_of(const struct job *job, const rotid_fit_result *fit, const char *name)
{
    int p = fitted_parameter(job, fit, name);
    return p < 0 ? NAN : fit->x[p];
}

/* How well it reaches the frequencies, and what of that is the reduction. */
static void print_frequencies_today(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const rotid_fit_result *fit = d->today.fit;
    struct wrap wrap;
    double sum = 0, most = 0;
    int count = 0, shown = 0, found = view->deck->fit.reduction == ROTID_REDUCTION_NONE;
    for (int k = 0; k < fit->m; k++) {
        double error = 100 * (fit->predicted_hz[k] / view->deck->frequency_hz[k] - 1);
        if ((view->deck->holdout && view->deck->holdout[k]) || !isfinite(error))
            continue;
        sum += error * error;
        most = fmax(most, fabs(error));
        count++;
    }
    if (!count)
        return;
    for (int i = 0; i < d->nnumerical_finding; i++) /* says it mode by mode */
        found |= !strcmp(d->numerical_finding[i].cause->id, "guyan_reduction");
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    wrap_item(&wrap, "frequencies that were fitted: error %.3g %% rms, %.3g %% at most", sqrt(sum / count), most);
    for (int k = 0; k < fit->m && !found; k++) {
        int j = d->today.compared.number[k] - 1;
        double error = d->today.spectrum.reduction_error_percent[j];
        if (isfinite(error))
            wrap_item(&wrap, "%smode %d %+.2f", shown++ ? "" : "; error of the reduction [%]: ", j + 1, error);
    }
    wrap_close(&wrap);
}

static void print_today(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const rotid_fit_result *fit = d->today.fit;
    struct wrap wrap;
    if (!d->has_today)
        return;
    const rotid_fit_options *options = &view->deck->fit;
    (void)fprintf(view->out, "\nYOUR FIT TODAY  %s, reduction %s: %s\n", functional_name(options->functional),
                  reduction_name(options->reduction),
                  options->functional == ROTID_LIKELIHOOD && options->reduction == ROTID_REDUCTION_NONE
                      ? "as it is judged below"
                      : "what that choice alone costs");
    if (!fit) {
        wrap_text(view->out, 4, view->width, "  ", "it could not be made with these data");
        return;
    }
    for (int p = 0; p < fit->n; p++) {
        const rotid_parameter *bounds = &view->deck->bounds[p];
        double base = 100 * (fit->x[p] / value_of(&d->job, d->base.fit, bounds->name) - 1),
               extended = 100 * (fit->x[p] / value_of(&d->extended_job, d->extended.fit, bounds->name) - 1);
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s %.4g%s%s", bounds->name, fit->x[p], bounds->unit && strcmp(bounds->unit, "1") ? " " : "",
                  bounds->unit && strcmp(bounds->unit, "1") ? bounds->unit : "");
        if (fit->at_bound[p])
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
    const struct diagnosis *d = view->diagnosis;
    if (d->nnumerical_finding)
        (void)fprintf(view->out, "\nNUMBERS  errors of the numbers themselves; the model that is judged is free of them\n");
    for (int i = 0; i < d->nnumerical_finding; i++) {
        const struct numerical_finding *finding = &d->numerical_finding[i];
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s:", finding->cause->id);
        if (finding->text)
            wrap_words(&wrap, finding->text);
        for (int k = 0, shown = 0; k < finding->nmode; k++)
            if (isfinite(finding->error_percent[k]))
                wrap_item(&wrap, "%smode %d %+.3g", shown++ ? ", " : "; error [%]: ", finding->mode[k],
                          finding->error_percent[k]);
        wrap_close(&wrap);
    }
}

static void print_data(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    if (d->ndata_finding)
        (void)fprintf(view->out, "\nDATA  faults of the measurement, taken out before the physics is judged\n");
    for (int i = 0; i < d->ndata_finding; i++) {
        const struct data_finding *finding = &d->data_finding[i];
        const char *unit = finding->cause->value.unit;
        struct wrap wrap;
        wrap_open(&wrap, view->out, 4, view->width, "  ");
        wrap_item(&wrap, "%s", finding->cause->id);
        for (int n = 0; n < finding->nsensor; n++)
            wrap_item(&wrap, "%s%d", n ? "and " : "sensor ", finding->sensor[n]);
        for (int k = 0; k < finding->nmode; k++)
            wrap_item(&wrap, "%s%d", k ? "and " : "mode ", finding->mode[k]);
        if (finding->block)
            wrap_item(&wrap, "%s", finding->block);
        if (isfinite(finding->value))
            wrap_item(&wrap, ": %.3g%s%s", finding->value, unit && strcmp(unit, "1") ? " " : "",
                      unit && strcmp(unit, "1") ? unit : "");
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

static void print_foot(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    struct wrap wrap;
    double seconds = 0;
    int frequency = d->frequency_noise > 0, shape = d->shape_noise > 0; /* NaN: no */
    (void)fputc('\n', view->out);
    wrap_open(&wrap, view->out, 7, view->width, "noise  ");
    if (frequency)
        wrap_item(&wrap, "frequencies %.3g %% (%s)%s", 100 * d->frequency_noise,
                  d->frequency_noise_assumed ? "the deck states none: assumed" : "stated", shape ? "," : "");
    if (shape)
        wrap_item(&wrap, "shapes %.3g %% of the largest component (%s)", 100 * d->shape_noise,
                  d->shape_noise_assumed ? "the deck states none: assumed" : "stated");
    if (!frequency && !shape)
        wrap_item(&wrap, "unknown");
    wrap_close(&wrap);
    for (int i = 0; i < d->nstep; i++)
        seconds += d->step[i].seconds;
    (void)fprintf(view->out, "seed %lu, %d thread%s", view->provenance->seed, view->provenance->threads,
                  view->provenance->threads == 1 ? "" : "s");
    if (d->nstep)
        (void)fprintf(view->out, ", %.3g s", seconds);
    (void)fputc('\n', view->out);
    if (!view->verbose || !d->nstep)
        return;
    wrap_open(&wrap, view->out, 7, view->width, "time   ");
    for (int i = 0; i < d->nstep; i++)
        wrap_item(&wrap, "%s %.3g s%s", d->step[i].name, d->step[i].seconds, i + 1 < d->nstep ? "," : "");
    wrap_close(&wrap);
}

void table_diagnose(const struct diagnosis_view *view)
{
    print_heading(view);
    print_verdict(view);
    print_today(view);
    print_numerical(view);
    print_data(view);
    table_misfit(view);
    table_evidence(view);
    table_gain(view);
    table_blind_spots(view);
    print_foot(view);
}
