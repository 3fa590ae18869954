/* Errors of the frequencies, mode by mode: of the fit, of NLopt's minimisers, and of the references in the heading of the deck.
 */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/series.h"

#define MOST_SERIES 6    /* the fit, three of NLopt, one reference */
#define NORMAL_95   1.96 /* of the stated noise of a frequency */
#define MOST_TICKS  24   /* numbers of modes side by side */
#define SIDE        0.12 /* between series of a mode: they would lie on each other */

enum { PLACE, MODE, MEASURED, PREDICTED, NOISE, ERRORS }; /* columns, those of the errors last */

struct errors {
    int count; /* series of errors */
    const char *name[MOST_SERIES];
    int style[MOST_SERIES];
    struct series *series;
};

/* The fit first, then NLopt where it has frequencies, then the reference. */
static void collect(struct document *document, const struct result *result, const rotid_identification *fit,
                    struct errors *errors)
{
    struct pool *pool = document->pool;
    struct column column[ERRORS + MOST_SERIES] = {{"place", NULL, AS_PLACE, 0},
                                                  {"mode", NULL, AS_FIXED, 0},
                                                  {"measured", "Hz", AS_FIXED, 3},
                                                  {"predicted", "Hz", AS_FIXED, 3},
                                                  {"95 % noise", "%", AS_PLACE, 0}};
    const rotid_reference *reference = head_reference(&result->head, "error_percent");
    const double *hz[MOST_SERIES] = {NULL};
    *errors = (struct errors){.count = 1, .name = {"Levenberg-Marquardt"}, .style = {1}};
    for (int b = 0; b < fit->nbaseline && errors->count < MOST_SERIES - 1; b++)
        if (fit->baseline[b].predicted_hz) {
            hz[errors->count] = fit->baseline[b].predicted_hz;
            errors->style[errors->count] = errors->count + 6;
            errors->name[errors->count++] = pool_format(pool, "NLopt %s", fit->baseline[b].algorithm);
        }
    if (reference) {
        errors->style[errors->count] = 5;
        errors->name[errors->count++] = "reference in the deck";
    }
    for (int s = 0; s < errors->count; s++) {
        const char *name = errors->name[s] ? pool_format(pool, "error, %s", errors->name[s]) : NULL;
        column[ERRORS + s] = (struct column){name, "%", AS_SIGNED, 3};
    }
    errors->series = series_new(document, "errors", fit->nmodes, ERRORS + errors->count, column);
    for (int k = 0; k < fit->nmodes; k++) {
        const rotid_compared_mode *mode = &fit->modes[k];
        double row[ERRORS + MOST_SERIES] = {
            k + 1, mode->mode, mode->measured_hz, mode->predicted_hz, 100 * NORMAL_95 * mode->frequency_std, mode->error_percent};
        for (int s = 1; s < errors->count; s++)
            row[ERRORS + s] = hz[s]                    ? 100 * (hz[s][k] / mode->measured_hz - 1)
                              : k < reference->nvalues ? reference->values[k]
                                                       : (double)NAN;
        series_row(errors->series, k, row);
    }
}

static void draw(struct plot *plot, const rotid_identification *fit, const struct errors *errors)
{
    int n = fit->nmodes, noisy = 0, count = errors->count;
    struct plot_entry entry[MOST_SERIES + 1];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .right = 12, .top = 10, .bottom = 48};
    struct plot_range range = {0, 0};
    for (int k = 0; k < n; k++) {
        double noise = series_values(errors->series, NOISE)[k];
        noisy |= noise > 0;
        plot_range_join(&range, noise);
        plot_range_join(&range, -noise);
        for (int s = 0; s < count; s++)
            plot_range_join(&range, series_values(errors->series, ERRORS + s)[k]);
    }
    for (int s = 0; s < count; s++)
        entry[s] =
            (struct plot_entry){.text = errors->name[s] ? errors->name[s] : "", .style = errors->style[s], .keys = KEY_MARK};
    entry[count] = (struct plot_entry){.text = "95 % of the measurement's noise", .keys = KEY_FACE, .face = "STEEL"};
    plot_head(entry, count + noisy, layout.head);
    double pad = 0.08 * (range.to - range.from) + (range.to <= range.from), tic = plot_tic(range.to - range.from + 2 * pad, 8);
    range = (struct plot_range){range.from - pad, range.to + pad};
    layout.left = plot_left(&range, tic);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, count + noisy);
    plot_line(plot, "set xrange [0.5:%g]\nset yrange [%.6g:%.6g]\nset ytics %g", n + 0.5, range.from, range.to, tic);
    plot_mode_tics(plot, n, fit->modes, MOST_TICKS);
    plot_axes(plot, "mode of the model [1]", "error of the frequency [%]");
    plot_line(plot, "set style fill solid noborder\nset boxwidth 0.7");
    plot_line(plot, "plot $errors using 1:(0):(0.35):%d with boxxyerror fc rgb STEEL, 0 with lines lc rgb INK lw 1 \\",
              NOISE + 1);
    (void)fprintf(plot->out, "   , $errors using 1:(0):(0):%d with vectors nohead ls 1 lw 1.5", ERRORS + 1);
    for (int s = count - 1; s >= 0; s--) { /* the fit on top, the others to its left and right in turn */
        int steps = (s + 1) / 2;
        (void)fprintf(plot->out, ", \\\n    $errors using ($1%+g):%d with points ls %d ps %s", (s % 2 ? -SIDE : SIDE) * steps,
                      ERRORS + s + 1, errors->style[s], s ? "0.85" : "0.9");
    }
    (void)fputc('\n', plot->out);
}

/* What the others say, in a sentence that begins with a blank. */
static const char *compared(struct pool *pool, const rotid_identification *fit, const struct errors *errors)
{
    double furthest = 0;
    int others = 0;
    for (int s = 1; s < errors->count; s++) {
        if (!errors->name[s] || strncmp(errors->name[s], "NLopt", 5) != 0)
            continue;
        others++;
        for (int k = 0; k < fit->nmodes; k++)
            furthest = fmax(furthest, fabs(series_values(errors->series, ERRORS + s)[k] - fit->modes[k].error_percent));
    }
    if (!others)
        return fit->nbaseline ? "" : " NLopt was not run beside it.";
    const char *text =
        pool_format(pool, " At the points of %s of NLopt's minimisers they differ from that by %s\xc2\xa0%% at most.",
                    human_count(pool, others), human_digits(pool, furthest, 1));
    return text ? text : "";
}

/* The mode with the largest error, of a state that is held out too; -1: none has an error. */
static int worst_of(const rotid_identification *fit)
{
    int worst = fit_worst_mode(fit);
    for (int k = 0; k < fit->nmodes && (worst < 0 || fit->modes[worst].holdout); k++)
        if (isfinite(fit->modes[k].error_percent) &&
            (worst < 0 || fabs(fit->modes[k].error_percent) > fabs(fit->modes[worst].error_percent)))
            worst = k;
    return worst;
}

/* "mode 3 of state free" */
static const char *mode_text(struct pool *pool, const rotid_identification *fit, int k)
{
    const char *state = fit_state_of_mode(fit, k),
               *text = pool_format(pool, "mode %d%s%s", fit->modes[k].mode, state ? " of state " : "", state ? state : "");
    return text ? text : "";
}

void figure_frequencies(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    struct errors errors;
    struct plot plot;
    int worst = worst_of(fit), held = 0, predicted_alone = worst >= 0 && fit->modes[worst].holdout;
    if (worst < 0)
        return;
    struct figure *figure = document_figure(document, "frequencies", "Errors of the predicted frequencies");
    collect(document, result, fit, &errors);
    if (!errors.series)
        return;
    for (int k = 0; k < fit->nmodes; k++)
        held += fit->modes[k].holdout;
    const char *left = held && !predicted_alone
                           ? pool_format(pool, "; modes with a star were held out of the fit (rms %s\xc2\xa0%%)",
                                         human_digits(pool, fit_rms_percent(fit, 1), 2))
                           : "";
    figure->caption =
        pool_format(pool, "Predicted over measured frequency, less one: %s\xc2\xa0%% rms, largest %s\xc2\xa0%% in %s%s.%s%s",
                    human_digits(pool, fit_rms_percent(fit, predicted_alone), 2),
                    human_signed(pool, fit->modes[worst].error_percent, 2), mode_text(pool, fit, worst), left ? left : "",
                    predicted_alone ? " No mode of this state is in the fit." : "", compared(pool, fit, &errors));
    struct plot_range range = plot_range_of(fit->nmodes, series_values(errors.series, ERRORS), 0);
    figure->alt = pool_format(pool, "For each of %d modes its error in per cent, from %s to %s.", fit->nmodes,
                              human_signed(pool, range.from, 2), human_signed(pool, range.to, 2));
    figure->table = series_table(errors.series);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    plot_series(&plot, errors.series);
    draw(&plot, fit, &errors);
    figure_end(document, &plot);
}
