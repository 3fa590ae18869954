/* What the named cause is worth: errors of the frequencies before and after. */
#include <math.h>

#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/series.h"

#define NORMAL_95  1.96
#define MOST_TICKS 24

/* Modes of both models by the measured frequency, in the order of the first: before [count], and after behind room for all. NULL:
 * memory is out. */
static rotid_compared_mode *pair(struct pool *pool, const rotid_diagnosis *d, int *count)
{
    int n = d->base->nmodes;
    rotid_compared_mode *before = POOL_ARRAY(pool, rotid_compared_mode, 2 * (size_t)n);
    *count = 0;
    for (int k = 0; k < n && before; k++)
        for (int j = 0; j < d->extended->nmodes; j++) {
            const rotid_compared_mode *one = &d->base->modes[k], *other = &d->extended->modes[j];
            if (one->measured_hz != other->measured_hz || !isfinite(one->error_percent) || !isfinite(other->error_percent))
                continue;
            before[*count] = *one;
            before[n + (*count)++] = *other;
            break;
        }
    return before;
}

static struct series *collect(struct document *document, int n, const rotid_compared_mode *before,
                              const rotid_compared_mode *after)
{
    static const struct column columns[] = {{"place", NULL, AS_PLACE, 0},         {"mode", NULL, AS_FIXED, 0},
                                            {"measured", "Hz", AS_FIXED, 3},      {"error without the cause", "%", AS_SIGNED, 3},
                                            {"error with it", "%", AS_SIGNED, 3}, {"95 % noise", "%", AS_PLACE, 0}};
    struct series *series = series_new(document, "errors", n, 6, columns);
    for (int k = 0; k < n; k++) {
        series_row(series, k,
                   (const double[]){k + 1, before[k].mode, before[k].measured_hz, before[k].error_percent, after[k].error_percent,
                                    100 * NORMAL_95 * before[k].frequency_std});
        if (before[k].holdout)
            series_text(series, k, 1, pool_format(document->pool, "%d, held out", before[k].mode));
    }
    return series;
}

static void draw(struct plot *plot, struct series *series, int n, const rotid_compared_mode *before)
{
    const struct plot_entry entry[] = {
        {.text = "without the cause", .style = 2, .keys = KEY_MARK},
        {.text = "with it", .style = 1, .keys = KEY_MARK},
        {.text = "95 % of the measurement's noise", .keys = KEY_FACE, .face = "STEEL"},
    };
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .left = 56, .right = 12, .top = 10, .bottom = 48};
    struct plot_range range = {0, 0};
    int noisy = 0;
    for (int k = 0; k < n; k++) {
        double noise = series_values(series, 5)[k];
        noisy |= noise > 0;
        plot_range_join(&range, series_values(series, 3)[k]);
        plot_range_join(&range, series_values(series, 4)[k]);
        plot_range_join(&range, noise);
        plot_range_join(&range, -noise);
    }
    plot_head(entry, 2 + noisy, layout.head);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, 2 + noisy);
    double pad = 0.08 * (range.to - range.from) + (range.to <= range.from);
    plot_line(plot, "set xrange [0.5:%g]\nset yrange [%.6g:%.6g]", n + 0.5, range.from - pad, range.to + pad);
    plot_mode_tics(plot, n, before, MOST_TICKS);
    plot_axes(plot, "mode of the model [1]", "error of the frequency [%]");
    plot_line(plot, "set style fill solid noborder\n"
                    "plot $errors using 1:(0):(0.35):6 with boxxyerror fc rgb STEEL, 0 with lines lc rgb INK lw 1 dt 1, \\\n"
                    "    $errors using 1:4:(0):($5-$4) with vectors nohead lc rgb MUTED lw 1.5, \\\n"
                    "    $errors using 1:4 with points ls 2 ps 0.9, $errors using 1:5 with points ls 1 ps 0.9");
}

void figure_improvement(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    int count, held = 0;
    if (!d->base || !d->extended)
        return;
    const rotid_compared_mode *before = pair(pool, d, &count);
    if (!before || !count) {
        document->failed |= !before;
        return;
    }
    for (int k = 0; k < count; k++)
        held += before[k].holdout;
    struct figure *figure = document_figure(document, "improvement", "Errors of the frequencies, before and after");
    const char *left =
        held ? pool_format(pool, " Modes with a star were held out by the deck: %s\xc2\xa0%% rms before, %s\xc2\xa0%% after.",
                           human_digits(pool, fit_rms_percent(d->base, 1), 2),
                           human_digits(pool, fit_rms_percent(d->extended, 1), 2))
             : " No mode was held out by the deck.";
    figure->caption =
        pool_format(pool,
                    "In the extended model the errors of the fitted frequencies fall from %s to %s\xc2\xa0%% rms, the largest "
                    "from %s to %s\xc2\xa0%%.%s",
                    human_digits(pool, fit_rms_percent(d->base, 0), 2), human_digits(pool, fit_rms_percent(d->extended, 0), 2),
                    human_digits(pool, d->gain.frequency_max_percent.before, 2),
                    human_digits(pool, d->gain.frequency_max_percent.after, 2), left ? left : "");
    figure->alt = pool_format(pool, "For each of %d modes its error before and after, joined by a line.", count);
    struct series *series = collect(document, count, before, before + d->base->nmodes);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    plot_series(&plot, series);
    draw(&plot, series, count, before);
    figure_end(document, &plot);
}
