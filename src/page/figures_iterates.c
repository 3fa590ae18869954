/* The parameters on their way: over the iterations, and on the bijection that keeps them within their bounds. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

#define LEAST_RANGE 1e-4
#define MOST_CURVES 10 /* of parameters: as many styles as there are */
#define MOST_PANELS 12 /* of bijections */
#define PLOT_HEIGHT 230.0
#define END_PX      14.0 /* beside a label */
#define MOST_NAME_PX 120.0 /* of a label; longer ones have more lines */

/* The iterates, then x/x(end) of each, NaN where one ends at zero. */
static struct series *collect(struct document *document, const rotid_identification *fit, int count)
{
    struct column column[1 + 2 * MOST_CURVES] = {{"iteration", NULL, AS_FIXED, 0}};
    double factor[MOST_CURVES];
    int n = fit->nhistory;
    for (int p = 0; p < count; p++) {
        struct human_unit unit = human_unit(fit->parameters[p].value, fit->parameters[p].unit);
        const char *text = *unit.text ? pool_copy_text(document->pool, unit.text) : "1",
                   *relative = pool_format(document->pool, "%s over its end", fit->parameters[p].name);
        document->failed |= !text || !relative;
        factor[p] = unit.factor;
        column[1 + p] = (struct column){fit->parameters[p].name, text, AS_DIGITS, 7};
        column[1 + count + p] = (struct column){relative ? relative : "", "1", AS_PLACE, 0};
    }
    struct series *series = series_new(document, "parameters", n, 1 + 2 * count, column);
    for (int i = 0; i < n; i++) {
        double row[1 + 2 * MOST_CURVES] = {fit->history[i].iteration};
        for (int p = 0; p < count; p++) {
            double x = fit->history[i].x[p], end = fit->history[n - 1].x[p];
            row[1 + p] = factor[p] * x;
            row[1 + count + p] = end != 0 ? x / end : (double)NAN;
        }
        series_row(series, i, row);
    }
    return series;
}

/* Iterations after which every parameter stays within one per cent of its end. */
static int settled(const rotid_identification *fit)
{
    int n = fit->nhistory, last = 0;
    for (int i = 0; i < n; i++)
        for (int p = 0; p < fit->nparameters; p++)
            if (fabs(fit->history[i].x[p] - fit->history[n - 1].x[p]) > 0.01 * fabs(fit->history[n - 1].x[p]))
                last = i + 1;
    return fit->history[last < n ? last : n - 1].iteration;
}

static void iterates_script(struct plot *plot, struct series *series, const rotid_identification *fit, int count)
{
    int n = fit->nhistory, steps = fit->history[n - 1].iteration;
    double height[MOST_CURVES], widest = 0;
    const char *name[MOST_CURVES], *color[MOST_CURVES];
    struct plot_range range = plot_range_of(count * n, series_values(series, 1 + count), 0.06);
    if (range.to - range.from < LEAST_RANGE) /* a fit that started at its end: the axis has no digits for less */
        range = (struct plot_range){1 - LEAST_RANGE / 2, 1 + LEAST_RANGE / 2};
    double tic = plot_tic(range.to - range.from, 6);
    for (int p = 0; p < count; p++) {
        name[p] = fit->parameters[p].name;
        color[p] = series_color[p % SERIES];
        widest = fmax(widest, plot_width(name[p]));
        height[p] = plot_share(&range, 1);
    }
    plot_series(plot, series);
    plot_begin(plot, &(struct plot_layout){.panels = 1,
                                           .columns = {1, 1},
                                           .height = PLOT_HEIGHT + 60,
                                           .left = plot_left(&range, tic),
                                           .right = END_PX + fmin(widest, MOST_NAME_PX),
                                           .top = 12,
                                           .bottom = 48});
    plot_panel(plot, 0);
    plot_line(plot, "set xrange [%g:%g]\nset yrange [%.6g:%.6g]\nset ytics %g", -0.02 * (steps + 1), steps * 1.02 + 0.02,
              range.from, range.to, tic);
    if (steps <= 12)
        plot_line(plot, "set xtics 1");
    plot_axes(plot, "iteration [1]", "value over value at the end [1]");
    plot_end_labels(plot, count, name, height, color);
    plot_line(plot,
              "plot 1 with lines lc rgb MUTED lw 0.75, for [p = 1:%d] $parameters using 1:(column(1+%d+p)) with linespoints ls p "
              "pointinterval %d",
              count, count, 1 + n / 25);
}

void figure_iterates(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    int count = fit->nparameters < MOST_CURVES ? fit->nparameters : MOST_CURVES, n = fit->nhistory;
    if (n < 2 || !count)
        return;
    struct figure *figure = document_figure(document, "iterates", "Parameters over the iterations, relative to the end");
    const char *from = "";
    for (int p = 0; p < count && p < 3 && from; p++)
        from = pool_format(pool, "%s%s%s from %s to %s", from, p ? ", " : "", fit->parameters[p].name,
                           human_value(pool, fit->parameters[p].start, fit->parameters[p].unit),
                           human_value(pool, fit->parameters[p].value, fit->parameters[p].unit));
    double ms = 1e3 * fit->history[n - 1].seconds;
    figure->caption =
        pool_format(pool, "The iteration takes %s. From iteration %d on %s within 1\xc2\xa0%% of the end%s%s.%s",
                    from ? from : "", settled(fit), count > 1 ? "all parameters stay" : "it stays",
                    isfinite(ms) ? "; the last point is reached after " : "", isfinite(ms) ? human_seconds(pool, ms / 1e3) : "",
                    fit->nparameters > count ? " Of more than ten parameters the first ten are drawn." : "");
    double lowest = 1, highest = 1;
    for (int p = 0; p < count; p++) {
        double first = fit->parameters[p].value != 0 ? fit->history[0].x[p] / fit->parameters[p].value : 1;
        lowest = fmin(lowest, first);
        highest = fmax(highest, first);
    }
    figure->alt = pool_format(pool, "%d %s over %d iterations: from %s to %s of the final value at the start, 1 at the end.",
                              count, human_plural(count, "curve", "curves"), fit->history[n - 1].iteration,
                              human_digits(pool, lowest, 2), human_digits(pool, highest, 2));
    struct series *series = collect(document, fit, count);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    iterates_script(&plot, series, fit, count);
    figure_end(document, &plot);
}

/* The bijection (30): x = lower + (upper - lower)/(1 + exp(u)), u = chi y. Its inverse; NaN at a bound. */
static double unbounded(const rotid_fitted_parameter *p, double x)
{
    return log((p->upper - x) / (x - p->lower));
}

static double share(const rotid_fitted_parameter *p, double x)
{
    return (x - p->lower) / (p->upper - p->lower);
}

static const char *bijection_title(struct pool *pool, const rotid_identification *fit, int p)
{
    const rotid_fitted_parameter *parameter = &fit->parameters[p];
    const char *title = pool_format(pool, "%s: %s \xe2\x86\x92 %s", parameter->name,
                                    human_value(pool, fit->history[0].x[p], parameter->unit),
                                    human_value(pool, parameter->value, parameter->unit));
    return title ? title : "";
}

static void bijection_panel(struct plot *plot, const rotid_identification *fit, int p, double most)
{
    const rotid_fitted_parameter *parameter = &fit->parameters[p];
    struct pool *pool = plot->pool;
    const char *upper = pool_format(pool, "1: upper bound %s", human_value(pool, parameter->upper, parameter->unit)),
               *lower = pool_format(pool, "0: lower bound %s", human_value(pool, parameter->lower, parameter->unit));
    plot_panel(plot, p);
    plot_line(plot, "set xrange [%g:%g]\nset yrange [-0.03:1.03]\nset ytics 0.25", -most, most);
    plot_axes(plot, isfinite(fit->bijection_chi) ? "unbounded variable y [1]" : "\xcf\x87 y [1]", "share of the way [1]");
    plot_label_over(plot, bijection_title(pool, fit, p), plot_panel_px(&plot->layout), "graph 0, graph 1", 0.9, "INK");
    plot_label(plot, upper ? upper : "", "graph 0.98, graph 0.93", "MUTED", "right");
    plot_label(plot, lower ? lower : "", "graph 0.02, graph 0.08", "MUTED", "left");
    plot_line(
        plot,
        "plot share(x) with lines lc rgb MUTED lw 1, $iterates%d using 1:2 with points ls 6, $iterates%d every ::%d using 1:2 "
        "with points ls 1 ps 0.9",
        p + 1, p + 1, fit->nhistory - 1);
}

static void bijection_script(struct document *document, struct plot *plot, const rotid_identification *fit, int count)
{
    static const struct column columns[] = {{"y", "1", AS_PLACE, 0},
                                            {"share of the way from the lower to the upper bound", "1", AS_PLACE, 0},
                                            {"iteration", NULL, AS_PLACE, 0}};
    double chi = isfinite(fit->bijection_chi) ? fit->bijection_chi : 1, most = 5;
    for (int p = 0; p < count; p++) {
        struct series *series = series_new(document, pool_format(document->pool, "iterates%d", p + 1), fit->nhistory, 3, columns);
        for (int i = 0; i < fit->nhistory; i++) {
            const rotid_history_entry *now = &fit->history[i];
            double u = unbounded(&fit->parameters[p], now->x[p]);
            series_row(series, i, (const double[]){u / chi, share(&fit->parameters[p], now->x[p]), now->iteration});
            most = isfinite(u) ? fmax(most, fabs(u) + 1) : most;
        }
        plot_series(plot, series);
    }
    plot_line(plot, "chi = %g\nshare(y) = 1 / (1 + exp(chi * y))", chi);
    struct plot_layout layout = {.panels = count,
                                 .columns = {count > 1 ? 2 : 1, 1},
                                 .height = PLOT_HEIGHT + 20,
                                 .left = 58,
                                 .right = 14,
                                 .top = 30,
                                 .bottom = 48};
    double more = 0;
    for (int p = 0; p < count; p++) {
        const char *title = bijection_title(plot->pool, fit, p);
        more = fmax(more, plot_lines_px(1, &title, plot_panel_px(&layout)));
    }
    layout.top += more;
    layout.height += more;
    plot_begin(plot, &layout);
    for (int p = 0; p < count; p++)
        bijection_panel(plot, fit, p, most / chi);
}

static struct number_table *bounds_table(struct pool *pool, const rotid_identification *fit)
{
    static const char *const head[] = {"parameter", "unit", "lower bound", "start", "end", "upper bound", "place [%]"};
    struct number_table *table = table_headed(pool, fit->nparameters, 7, head);
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        struct human_unit unit = human_unit(parameter->value, parameter->unit);
        const double value[] = {parameter->lower, parameter->start, parameter->value, parameter->upper};
        table_cell(table, p, 0, parameter->name);
        table_cell(table, p, 1, *unit.text ? pool_copy_text(pool, unit.text) : "1");
        for (int j = 0; j < 4; j++)
            table_cell(table, p, 2 + j, human_digits(pool, unit.factor * value[j], 5));
        table_cell(table, p, 6, human_fixed(pool, 100 * share(parameter, parameter->value), 1));
    }
    return table;
}

void figure_bijection(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    int count = fit->nparameters < MOST_PANELS ? fit->nparameters : MOST_PANELS;
    const char *ends = "";
    if (!count || !fit->nhistory)
        return;
    struct figure *figure =
        document_figure(document, "bijection", "Iterates on the bijection that keeps them within their bounds");
    for (int p = 0; p < count && p < 4 && ends; p++)
        ends = pool_format(pool, "%s%s%s ends at %s\xc2\xa0%%", ends, p ? ", " : "", fit->parameters[p].name,
                           human_fixed(pool, 100 * share(&fit->parameters[p], fit->parameters[p].value), 0));
    figure->caption = pool_format(
        pool,
        "%s of the way from its lower to its upper bound%s. Where the curve is flat, close to 0 or 1, a bound "
        "would hold a parameter rather than the data.",
        ends ? ends : "", count < fit->nparameters ? "; of more than twelve parameters the first twelve are drawn" : "");
    figure->alt =
        pool_format(pool, "%d %s with the falling S-shaped curve of the bijection and %d iterates of a parameter on it.", count,
                    human_plural(count, "panel", "panels"), fit->nhistory);
    figure->table = bounds_table(pool, fit);
    struct plot plot;
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    bijection_script(document, &plot, fit, count);
    figure_end(document, &plot);
}
