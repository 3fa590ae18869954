/* What the runs of a study scatter beside what their fits say of it. */
#include <math.h>
#include <string.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/series.h"

#define LEAST_RUNS  20 /* below it a histogram is a matter of luck */
#define MOST_PANELS 6
#define BINS        16 /* from -4 to 4 standard deviations; what lies beyond counts in the last ones */
#define REACH       4.0
#define BIN         (2 * REACH / BINS)
#define NORMAL_95   1.96

struct histogram {
    const struct cell_parameter *parameter;
    int count, held; /* values; intervals that hold the truth */
    double mean, deviation, bin[BINS];
};

static struct histogram count_errors(const struct study_outcome *s, int cell, int p)
{
    struct histogram h = {.parameter = &s->cell[cell].is.parameters[p]};
    double sum = 0, square = 0;
    for (int i = 0; i < s->nrun; i++) {
        const struct told_run *run = &s->run[i];
        if (run->cell != cell || !run->value || run->status > STUDY_AT_BOUND)
            continue;
        const struct run_parameter *v = &run->value[p];
        double z = (v->value - v->truth) / v->std;
        if (!isfinite(z))
            continue;
        h.bin[(int)fmin(fmax(floor((z + REACH) / BIN), 0), BINS - 1)] += 1;
        h.held += v->ci95[0] <= v->truth && v->truth <= v->ci95[1];
        h.count++;
        sum += z;
        square += z * z;
    }
    h.mean = sum / h.count;
    h.deviation = sqrt((square - sum * sum / h.count) / (h.count - 1));
    return h;
}

/* The histograms of the first cell that has enough runs with a truth. */
static int collect(const struct study_outcome *s, struct histogram h[MOST_PANELS], int *cell)
{
    for (*cell = 0; *cell < s->is.ncells && s->nrun; (*cell)++) {
        int count = 0;
        for (int p = 0; p < s->cell[*cell].is.nparameters && count < MOST_PANELS; p++) {
            h[count] = count_errors(s, *cell, p);
            count += h[count].count >= LEAST_RUNS;
        }
        if (count)
            return count;
    }
    return 0;
}

static struct series *collect_bins(struct document *document, int count, const struct histogram *h)
{
    struct pool *pool = document->pool;
    struct column column[2 + MOST_PANELS] = {{"error over its stated deviation", "1", AS_TEXT, 0},
                                             {"middle of the bin", "1", AS_PLACE, 0}};
    for (int p = 0; p < count; p++)
        column[2 + p] = (struct column){pool_format(pool, "runs, %s", h[p].parameter->name), NULL, AS_FIXED, 0};
    struct series *series = series_new(document, "errors", BINS, 2 + count, column);
    for (int b = 0; b < BINS; b++) {
        double from = -REACH + b * BIN, row[1 + MOST_PANELS] = {from + 0.5 * BIN};
        for (int p = 0; p < count; p++)
            row[1 + p] = h[p].bin[b];
        series_row(series, b, row);
        series_text(series, b, 0,
                    b == 0 ? pool_format(pool, "below %s", human_signed(pool, from + BIN, 1))
                    : b == BINS - 1
                        ? pool_format(pool, "from %s", human_signed(pool, from, 1))
                        : pool_format(pool, "%s to %s", human_signed(pool, from, 1), human_signed(pool, from + BIN, 1)));
    }
    return series;
}

static void draw(struct plot *plot, const struct series *series, int count, const struct histogram *h)
{
    struct plot_layout layout = {
        .panels = count, .columns = {count > 1 ? 2 : 1, 1}, .height = 250, .left = 54, .right = 12, .top = 24, .bottom = 48};
    const struct plot_entry entry[] = {{.text = "runs", .keys = KEY_FACE, .face = "BLUE"},
                                       {.text = "normal distribution", .style = 2, .keys = KEY_LINE},
                                       {.text = "95 % of it", .style = 11, .keys = KEY_LINE}};
    plot_head(entry, 3, layout.head);
    plot_line(plot, "set style line 11 lc rgb INK lw 1 dt (8,4)");
    plot_series(plot, series);
    double more = 0;
    for (int p = 0; p < count; p++)
        more = fmax(more, plot_lines_px(1, &h[p].parameter->name, plot_panel_px(&layout)));
    layout.top += more;
    layout.height += more;
    plot_begin(plot, &layout);
    for (int p = 0; p < count; p++) {
        plot_panel(plot, p);
        if (!p)
            plot_legend(plot, entry, 3);
        plot_label_over(plot, h[p].parameter->name, plot_panel_px(&layout), "graph 0, graph 1", 0.7, "INK");
        plot_line(plot, "set xrange [-%g:%g]\nset yrange [0:*]\nset xtics 1", REACH, REACH);
        plot_axes(plot, "value less truth over its stated deviation [1]", "runs [1]");
        for (int side = 0; side < 2; side++)
            plot_line(plot, "set arrow %d from first %g, graph 0 to first %g, graph 1 nohead front ls 11", side + 1,
                      side ? NORMAL_95 : -NORMAL_95, side ? NORMAL_95 : -NORMAL_95);
        plot_line(plot,
                  "set style fill solid noborder\nset boxwidth %g\n"
                  "plot $errors using 1:%d with boxes fc rgb BLUE, %g*exp(-x*x/2) with lines ls 2 lw 2",
                  0.94 * BIN, p + 2, h[p].count * BIN / sqrt(2 * 3.14159265358979));
    }
}

void figure_errors_of_runs(struct document *document, const struct result *result)
{
    const struct study_outcome *s = result->studied;
    struct pool *pool = document->pool;
    struct histogram h[MOST_PANELS];
    int cell, count = collect(s, h, &cell);
    const char *says = "";
    if (!count)
        return;
    struct figure *figure = document_figure(document, "errors-of-runs", "Errors of the runs beside what their fits state");
    for (int p = 0; p < count && says; p++)
        says = pool_format(pool, "%s%s%s: mean %s, deviation %s, %d of %d intervals hold the truth", says, p ? "; " : "",
                           h[p].parameter->name, human_signed(pool, h[p].mean, 2), human_digits(pool, h[p].deviation, 2),
                           h[p].held, h[p].count);
    const char *label = *s->cell[cell].label ? pool_format(pool, " (%s)", s->cell[cell].label) : "";
    figure->caption =
        pool_format(pool,
                    "Value less truth over the standard deviation that the fit states%s. %s. Where the fits can be believed "
                    "the mean is 0, the deviation 1, and 95 of 100 intervals hold the truth.",
                    label ? label : "", says ? says : "");
    figure->alt =
        pool_format(pool, "A histogram for each of %d parameters beside the normal distribution. %s.", count, says ? says : "");
    document->failed |= !label || !says;
    struct series *series = collect_bins(document, count, h);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, count, h);
    figure_end(document, &plot);
}
