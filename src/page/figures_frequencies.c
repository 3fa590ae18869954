/* Errors of the frequencies, mode by mode: of the fit, of NLopt's minimisers, and of what the heading gives to compare with. */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_SERIES 6    /* the fit, three of NLopt, one reference */
#define NORMAL_95   1.96 /* of the stated noise of a frequency */
#define MOST_TICKS  24   /* numbers of modes side by side */
#define SIDE        0.12 /* between series of a mode: they would lie on each other */

struct error_series {
    const char *name;
    int style;
    double *percent; /* [nmode] */
};

static double *errors_of(struct pool *pool, const rotid_identification *fit, const double *hz)
{
    double *percent = POOL_ARRAY(pool, double, fit->nmodes);
    for (int k = 0; k < fit->nmodes && percent; k++)
        percent[k] = 100 * (hz[k] / fit->modes[k].measured_hz - 1);
    return percent;
}

/* The series there are, the fit first; -1: memory is out. */
static int collect(struct pool *pool, const struct result *result, const rotid_identification *fit, struct error_series *series)
{
    const rotid_reference *reference = head_reference(&result->head, "error_percent");
    int n = fit->nmodes, count = 1;
    series[0] = (struct error_series){"Levenberg-Marquardt", 1, POOL_ARRAY(pool, double, n)};
    if (!series[0].percent)
        return -1;
    for (int k = 0; k < n; k++)
        series[0].percent[k] = fit->modes[k].error_percent;
    for (int b = 0; b < fit->nbaseline && count < MOST_SERIES - 1; b++)
        if (fit->baseline[b].predicted_hz) {
            const char *name = pool_format(pool, "NLopt %s", fit->baseline[b].algorithm);
            series[count] = (struct error_series){name, count + 6, errors_of(pool, fit, fit->baseline[b].predicted_hz)};
            if (!name || !series[count++].percent)
                return -1;
        }
    if (reference) {
        double *percent = POOL_ARRAY(pool, double, n);
        if (!percent)
            return -1;
        for (int k = 0; k < n; k++)
            percent[k] = k < reference->nvalues ? reference->values[k] : (double)NAN;
        series[count++] = (struct error_series){"reference in the deck", 5, percent};
    }
    return count;
}

static struct number_table *errors_table(struct pool *pool, const rotid_identification *fit, const struct error_series *series,
                                         int count)
{
    struct number_table *table = table_new(pool, fit->nmodes, 3 + count);
    table_head(table, 0, "mode");
    table_head(table, 1, "measured [Hz]");
    table_head(table, 2, "predicted [Hz]");
    for (int s = 0; s < count; s++)
        table_head(table, 3 + s, pool_format(pool, "error, %s [%%]", series[s].name));
    for (int k = 0; k < fit->nmodes; k++) {
        table_cell(table, k, 0, human_fixed(pool, fit->modes[k].mode, 0));
        table_cell(table, k, 1, human_fixed(pool, fit->modes[k].measured_hz, 3));
        table_cell(table, k, 2, human_fixed(pool, fit->modes[k].predicted_hz, 3));
        for (int s = 0; s < count; s++)
            table_cell(table, k, 3 + s, human_signed(pool, series[s].percent[k], 3));
    }
    return table;
}

static void draw_modes(struct plot *plot, const rotid_identification *fit)
{
    FILE *out = plot->out;
    (void)fputs("set xtics (", out);
    int every = 1 + fit->nmodes / MOST_TICKS;
    for (int k = 0; k < fit->nmodes; k += every)
        (void)fprintf(out, "%s'%d%s' %d", k ? ", " : "", fit->modes[k].mode, fit->modes[k].holdout ? "*" : "", k + 1);
    (void)fputs(")\n", out);
}

static int script(struct document *document, struct figure *figure, const struct result *result, const rotid_identification *fit,
                  const struct error_series *series, int count)
{
    struct pool *pool = document->pool;
    int n = fit->nmodes, noisy = 0;
    struct plot plot;
    struct plot_entry entry[MOST_SERIES + 1];
    double *x = POOL_ARRAY(pool, double, n), *noise = POOL_ARRAY(pool, double, n);
    const double *data[MOST_SERIES + 2] = {x, noise};
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .right = 12, .top = 10, .bottom = 48};
    if (!x || !noise || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    struct plot_range range = {0, 0};
    for (int k = 0; k < n; k++) {
        x[k] = k + 1;
        noise[k] = 100 * NORMAL_95 * fit->modes[k].frequency_std;
        noisy |= noise[k] > 0;
        plot_range_join(&range, noise[k]);
        plot_range_join(&range, -noise[k]);
        for (int s = 0; s < count; s++)
            plot_range_join(&range, series[s].percent[k]);
    }
    for (int s = 0; s < count; s++) {
        data[2 + s] = series[s].percent;
        entry[s] = (struct plot_entry){.text = series[s].name, .style = series[s].style, .keys = KEY_MARK};
    }
    entry[count] = (struct plot_entry){.text = "95 % of the measurement's noise", .keys = KEY_FACE, .face = "STEEL"};
    plot_head(entry, count + noisy, layout.head);
    plot_line(&plot, "# columns: place, 95 %% noise, then the errors [%%]: the fit, NLopt, references");
    plot_data(&plot, "errors", n, 2 + count, data);
    double pad = 0.08 * (range.to - range.from) + (range.to <= range.from), tic = plot_tic(range.to - range.from + 2 * pad, 8);
    range = (struct plot_range){range.from - pad, range.to + pad};
    layout.left = plot_left(&range, tic);
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, count + noisy);
    plot_line(&plot, "set xrange [0.5:%g]\nset yrange [%.6g:%.6g]\nset ytics %g", n + 0.5, range.from, range.to, tic);
    draw_modes(&plot, fit);
    plot_axes(&plot, "mode of the model [1]", "error of the frequency [%]");
    plot_line(&plot, "set style fill solid noborder\nset boxwidth 0.7");
    plot_line(&plot, "plot $errors using 1:(0):(0.35):2 with boxxyerror fc rgb STEEL, 0 with lines lc rgb INK lw 1 \\");
    (void)fprintf(plot.out, "   , $errors using 1:(0):(0):3 with vectors nohead ls 1 lw 1.5");
    for (int s = count - 1; s >= 0; s--) { /* the fit on top, the others to its left and right in turn */
        int steps = (s + 1) / 2;
        (void)fprintf(plot.out, ", \\\n    $errors using ($1%+g):%d with points ls %d ps %s", (s % 2 ? -SIDE : SIDE) * steps,
                      s + 3, series[s].style, s ? "0.85" : "0.9");
    }
    (void)fputc('\n', plot.out);
    return plot_close(&plot);
}

/* What the others say, in a sentence that begins with a blank. */
static const char *compared(struct pool *pool, const rotid_identification *fit, const struct error_series *series, int count)
{
    double furthest = 0;
    int others = 0;
    for (int s = 1; s < count; s++) {
        if (strncmp(series[s].name, "NLopt", 5) != 0)
            continue;
        others++;
        for (int k = 0; k < fit->nmodes; k++)
            furthest = fmax(furthest, fabs(series[s].percent[k] - series[0].percent[k]));
    }
    if (!others)
        return fit->nbaseline ? "" : " NLopt was not run beside it.";
    const char *text =
        pool_format(pool, " At the points of %s of NLopt's minimisers they differ from that by %s\xc2\xa0%% at most.",
                    human_count(pool, others), human_digits(pool, furthest, 1));
    return text ? text : "";
}

void figure_frequencies(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    struct error_series series[MOST_SERIES];
    int worst = fit_worst_mode(fit), held = 0;
    if (worst < 0)
        return;
    struct figure *figure = document_figure(document, "frequencies", "Errors of the predicted frequencies");
    int count = collect(pool, result, fit, series);
    if (count < 0) {
        document->failed = 1;
        return;
    }
    for (int k = 0; k < fit->nmodes; k++)
        held += fit->modes[k].holdout;
    const char *left = held ? pool_format(pool, "; modes with a star were held out of the fit (rms %s\xc2\xa0%%)",
                                          human_digits(pool, fit_rms_percent(fit, 1), 2))
                            : "";
    figure->caption =
        pool_format(pool, "Predicted over measured frequency, less one: %s\xc2\xa0%% rms, largest %s\xc2\xa0%% in mode %d%s.%s",
                    human_digits(pool, fit_rms_percent(fit, 0), 2), human_signed(pool, fit->modes[worst].error_percent, 2),
                    fit->modes[worst].mode, left ? left : "", compared(pool, fit, series, count));
    figure->alt = pool_format(pool, "For each of %d modes its error in per cent, from %s to %s.", fit->nmodes,
                              human_signed(pool, plot_range_of(fit->nmodes, series[0].percent, 0).from, 2),
                              human_signed(pool, plot_range_of(fit->nmodes, series[0].percent, 0).to, 2));
    figure->table = errors_table(pool, fit, series, count);
    document->failed |= !figure->caption || !figure->alt || script(document, figure, result, fit, series, count) != ROTID_OK;
}
