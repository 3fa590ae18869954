/* What the named cause is worth: errors of the frequencies before and after. */
#include <math.h>

#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/plot.h"

#define NORMAL_95  1.96
#define MOST_TICKS 24

struct change { /* of a frequency */
    const rotid_compared_mode *before, *after;
};

/* Modes of both models by the number of the test, in the order of the first. NULL: memory is out. */
static struct change *pair(struct pool *pool, const rotid_diagnosis *d, int *count)
{
    struct change *change = POOL_ARRAY(pool, struct change, d->base->nmodes);
    *count = 0;
    for (int k = 0; k < d->base->nmodes && change; k++)
        for (int j = 0; j < d->extended->nmodes; j++) {
            const rotid_compared_mode *before = &d->base->modes[k], *after = &d->extended->modes[j];
            if (before->measured_hz != after->measured_hz || !isfinite(before->error_percent) || !isfinite(after->error_percent))
                continue;
            change[(*count)++] = (struct change){before, after};
            break;
        }
    return change;
}

static int script(struct document *document, struct figure *figure, const struct result *result, int n,
                  const struct change *change)
{
    struct pool *pool = document->pool;
    double *data = POOL_ARRAY(pool, double, 4 * (size_t)n);
    const struct plot_entry entry[] = {
        {.text = "without the cause", .style = 2, .keys = KEY_MARK},
        {.text = "with it", .style = 1, .keys = KEY_MARK},
        {.text = "95 % of the measurement's noise", .keys = KEY_FACE, .face = "STEEL"},
    };
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .left = 56, .right = 12, .top = 10, .bottom = 48};
    struct plot_range range = {0, 0};
    struct plot plot;
    int noisy = 0;
    if (!data)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < n; k++) {
        double noise = 100 * NORMAL_95 * change[k].before->frequency_std;
        const double row[] = {k + 1, change[k].before->error_percent, change[k].after->error_percent, noise};
        for (int c = 0; c < 4; c++)
            data[k + (ptrdiff_t)c * n] = row[c];
        noisy |= noise > 0;
        plot_range_join(&range, row[1]);
        plot_range_join(&range, row[2]);
        plot_range_join(&range, noise);
        plot_range_join(&range, -noise);
    }
    plot_head(entry, 2 + noisy, layout.head);
    if (plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: place, error of the frequency before and after [%%], 95 %% noise [%%]");
    plot_data(&plot, "errors", n, 4, (const double *const[]){data, data + n, data + 2 * (ptrdiff_t)n, data + 3 * (ptrdiff_t)n});
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, 2 + noisy);
    double pad = 0.08 * (range.to - range.from) + (range.to <= range.from);
    plot_line(&plot, "set xrange [0.5:%g]\nset yrange [%.6g:%.6g]", n + 0.5, range.from - pad, range.to + pad);
    (void)fputs("set xtics (", plot.out);
    for (int k = 0; k < n; k += 1 + n / MOST_TICKS)
        (void)fprintf(plot.out, "%s'%d%s' %d", k ? ", " : "", change[k].before->mode, change[k].before->holdout ? "*" : "",
                      k + 1);
    (void)fputs(")\n", plot.out);
    plot_axes(&plot, "mode of the model [1]", "error of the frequency [%]");
    plot_line(&plot, "set style fill solid noborder\n"
                     "plot $errors using 1:(0):(0.35):4 with boxxyerror fc rgb STEEL, 0 with lines lc rgb INK lw 1 dt 1, \\\n"
                     "    $errors using 1:2:(0):($3-$2) with vectors nohead lc rgb MUTED lw 1.5, \\\n"
                     "    $errors using 1:2 with points ls 2 ps 0.9, $errors using 1:3 with points ls 1 ps 0.9");
    return plot_close(&plot);
}

static struct number_table *changes_table(struct pool *pool, int n, const struct change *change)
{
    struct number_table *table = table_new(pool, n, 4);
    table_head(table, 0, "mode");
    table_head(table, 1, "measured [Hz]");
    table_head(table, 2, "error without the cause [%]");
    table_head(table, 3, "error with it [%]");
    for (int k = 0; k < n; k++) {
        table_cell(table, k, 0, pool_format(pool, "%d%s", change[k].before->mode, change[k].before->holdout ? ", held out" : ""));
        table_cell(table, k, 1, human_fixed(pool, change[k].before->measured_hz, 3));
        table_cell(table, k, 2, human_signed(pool, change[k].before->error_percent, 3));
        table_cell(table, k, 3, human_signed(pool, change[k].after->error_percent, 3));
    }
    return table;
}

void figure_improvement(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    int count, held = 0;
    if (!d->base || !d->extended)
        return;
    struct change *change = pair(pool, d, &count);
    if (!change || !count) {
        document->failed |= !change;
        return;
    }
    for (int k = 0; k < count; k++)
        held += change[k].before->holdout;
    struct figure *figure = document_figure(document, "improvement", "Errors of the frequencies, before and after");
    const char *left =
        held ? pool_format(pool, " Modes with a star were held out by the deck: %s\xc2\xa0%% rms before, %s\xc2\xa0%% after.",
                           human_digits(pool, fit_rms_percent(d->base, 1), 2),
                           human_digits(pool, fit_rms_percent(d->extended, 1), 2))
             : " No mode was held out by the deck.";
    figure->caption = pool_format(
        pool,
        "With what was named in the model the errors of the fitted frequencies fall from %s to %s\xc2\xa0%% rms, the largest "
        "from %s to %s\xc2\xa0%%.%s",
        human_digits(pool, fit_rms_percent(d->base, 0), 2), human_digits(pool, fit_rms_percent(d->extended, 0), 2),
        human_digits(pool, d->gain.frequency_max_percent.before, 2), human_digits(pool, d->gain.frequency_max_percent.after, 2),
        left ? left : "");
    figure->alt = pool_format(pool, "For each of %d modes its error before and after, joined by a line.", count);
    figure->table = changes_table(pool, count, change);
    document->failed |= !figure->caption || !figure->alt || script(document, figure, result, count, change) != ROTID_OK;
}
