/* Errors of the fit and prediction errors on held-out data, before and after, as rms. */
#include <math.h>

#include "page/cause_words.h"
#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/series.h"

#define ROW_PX   40.0
#define MOST_ROW 4

struct gain_row {
    const rotid_pair *pair;
    const char *text;
    double factor; /* to per cent */
};

/* The rows of a panel that have both numbers, and their number. */
static int rows_of(const rotid_diagnosis *d, int panel, struct gain_row shown[MOST_ROW])
{
    const rotid_gain *gain = &d->gain;
    const struct gain_row rows[2][MOST_ROW] = {
        {{&gain->frequency_rms_percent, "fitted", 1},
         {&gain->holdout_frequency_rms_percent, "modes held out by the deck", 1},
         {&gain->mode_out_frequency_rms_percent, "modes left out in turn", 1}},
        {{&gain->shape_rms, "fitted", 100},
         {&gain->holdout_shape_rms, "modes held out by the deck", 100},
         {&gain->mode_out_shape_rms, "modes left out in turn", 100},
         {&gain->sensor_out_shape_rms, "sensors left out in turn", 100}},
    };
    int count = 0;
    for (int i = 0; i < MOST_ROW && rows[panel][i].text; i++)
        if (isfinite(rows[panel][i].pair->before) && isfinite(rows[panel][i].pair->after))
            shown[count++] = rows[panel][i];
    return count;
}

/* Numbers of a panel, name: of their data. */
static struct series *collect(struct document *document, const char *name, int n, const struct gain_row *shown)
{
    static const struct column columns[] = {{"row from below", NULL, AS_PLACE, 0},
                                            {"rms", "%", AS_TEXT, 0},
                                            {"without the cause", "%", AS_DIGITS, 3},
                                            {"with it", "%", AS_DIGITS, 3}};
    struct series *series = series_new(document, name, n, 4, columns);
    for (int i = 0; i < n; i++) {
        double factor = shown[i].factor;
        series_row(series, i, (const double[]){n - i, factor * shown[i].pair->before, factor * shown[i].pair->after});
        series_text(series, i, 1, shown[i].text);
    }
    return series;
}

static void draw(struct plot *plot, struct series *series, const char *name, int n, int most_rows, const struct gain_row *shown,
                 const char *axis)
{
    double most = fmax(plot_range_of(n, series_values(series, 2), 0).to, plot_range_of(n, series_values(series, 3), 0).to);
    plot_line(plot, "set xrange [0:%.6g]\nset yrange [%g:%g]\nunset ytics\nset border 1\nset xtics %g", 1.08 * most,
              n - most_rows + 0.5, n + 0.75, plot_tic(most, 4));
    plot_axes(plot, axis, NULL);
    for (int i = 0; i < n; i++) {
        char where[48];
        (void)snprintf(where, sizeof where, "graph 0, first %g", n - i + 0.36);
        plot_label(plot, shown[i].text, where, "INK", "left");
    }
    plot_line(plot,
              "plot $%s using 2:1:($3-$2):(0) with vectors nohead lc rgb MUTED lw 1.5, \\\n"
              "    $%s using 2:1 with points ls 2 ps 0.9, $%s using 3:1 with points ls 1 ps 0.9",
              name, name, name);
}

static void script(struct document *document, struct plot *plot, const rotid_diagnosis *d)
{
    static const char *const names[] = {"frequencies", "shapes"};
    static const char *const axes[] = {"error of the frequencies, rms [%]", "error of the shapes, rms [% of the largest]"};
    const struct plot_entry entry[] = {{.text = "without the cause", .style = 2, .keys = KEY_MARK},
                                       {.text = "with it", .style = 1, .keys = KEY_MARK}};
    struct gain_row shown[2][MOST_ROW];
    struct series *series[2];
    int count[2] = {rows_of(d, 0, shown[0]), rows_of(d, 1, shown[1])}, panels = (count[0] > 0) + (count[1] > 0),
        most = count[0] > count[1] ? count[0] : count[1], panel = 0;
    struct plot_layout layout = {
        .panels = panels, .columns = {panels, 1}, .height = 64 + ROW_PX * most, .left = 16, .right = 16, .top = 8, .bottom = 48};
    plot_head(entry, 2, layout.head);
    for (int p = 0; p < 2; p++) {
        series[p] = collect(document, names[p], count[p], shown[p]);
        if (count[p])
            plot_series(plot, series[p]);
    }
    plot_begin(plot, &layout);
    for (int p = 0; p < 2; p++) {
        if (!count[p] || !series[p])
            continue;
        plot_panel(plot, panel);
        if (!panel++)
            plot_legend(plot, entry, 2);
        draw(plot, series[p], names[p], count[p], most, shown[p], axes[p]);
    }
}

static const char *one(struct pool *pool, const rotid_pair *pair, double factor, const char *what)
{
    const char *text = pool_format(pool, "%s from %s to %s\xc2\xa0%%", what, human_digits(pool, factor * pair->before, 2),
                                   human_digits(pool, factor * pair->after, 2));
    return isfinite(pair->before) && isfinite(pair->after) && text ? text : "";
}

void figure_gain(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    struct gain_row shown[MOST_ROW];
    struct plot plot;
    if (!d->extended || (!rows_of(d, 0, shown) && !rows_of(d, 1, shown)))
        return;
    struct figure *figure = document_figure(document, "gain", "Fit and prediction of held-out data, before and after");
    const char *parts[] = {one(pool, &d->gain.holdout_frequency_rms_percent, 1, "frequencies held out by the deck go"),
                           one(pool, &d->gain.mode_out_frequency_rms_percent, 1, "frequencies of modes left out in turn go"),
                           one(pool, &d->gain.sensor_out_shape_rms, 100, "shapes at sensors left out in turn go")};
    const char *text = "";
    for (int i = 0; i < 3 && text; i++)
        if (*parts[i])
            text = pool_format(pool, "%s%s%s", text, *text ? ", " : "", parts[i]);
    figure->caption = pool_format(pool,
                                  "%s%s A model with more parameters always fits better; its prediction of held-out data tells "
                                  "whether the model is better.",
                                  text ? words_sentence(pool, text) : "", text && *text ? "." : "");
    figure->alt = pool_format(pool, "Pairs of points, without and with the cause: %s.", text ? text : "");
    /* its numbers: the table of the quality */
    document->failed |= !text;
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    script(document, &plot, d);
    figure_end(document, &plot);
}
