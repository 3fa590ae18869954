/* The parameters on their way: over the iterations, and on the bijection that keeps them within their bounds. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_CURVES 10 /* of parameters: as many styles as there are */
#define MOST_PANELS 12 /* of bijections */
#define PLOT_HEIGHT 230.0
#define END_PX      14.0 /* beside a label */

/* x/x(end) of parameter p over the iterations; NaN where it ends at zero. */
static void relative(const rotid_identification *fit, int p, double *value)
{
    double end = fit->history[fit->nhistory - 1].x[p];
    for (int i = 0; i < fit->nhistory; i++)
        value[i] = end != 0 ? fit->history[i].x[p] / end : (double)NAN;
}

static struct number_table *iterates_table(struct pool *pool, const rotid_identification *fit, int count)
{
    struct number_table *table = table_new(pool, fit->nhistory, count + 1);
    table_head(table, 0, "iteration");
    for (int p = 0; p < count; p++) {
        struct human_unit unit = human_unit(fit->parameters[p].value, fit->parameters[p].unit);
        table_head(table, p + 1, pool_format(pool, "%s [%s]", fit->parameters[p].name, *unit.text ? unit.text : "1"));
        for (int i = 0; i < fit->nhistory; i++) {
            table_cell(table, i, 0, human_fixed(pool, fit->history[i].iteration, 0));
            table_cell(table, i, p + 1, human_digits(pool, unit.factor * fit->history[i].x[p], 7));
        }
    }
    return table;
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

static int iterates_script(struct document *document, struct figure *figure, const struct result *result,
                           const rotid_identification *fit, int count)
{
    int n = fit->nhistory, steps = fit->history[n - 1].iteration;
    struct pool *pool = document->pool;
    struct plot plot;
    double *y = POOL_ARRAY(pool, double, (size_t)(count + 1) * (size_t)n), height[MOST_CURVES];
    const double *data[MOST_CURVES + 1];
    const char *name[MOST_CURVES], *color[MOST_CURVES];
    double widest = 0;
    if (!y || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        y[i] = fit->history[i].iteration;
    data[0] = y;
    for (int p = 0; p < count; p++) {
        relative(fit, p, y + (ptrdiff_t)(p + 1) * n);
        data[p + 1] = y + (ptrdiff_t)(p + 1) * n;
        name[p] = fit->parameters[p].name;
        color[p] = series_color[p % SERIES];
        widest = fmax(widest, plot_width(name[p]));
    }
    plot_line(&plot, "# columns: iteration, then each parameter over its value at the end");
    plot_data(&plot, "parameters", n, count + 1, data);
    struct plot_range range = plot_range_of(count * n, y + n, 0.06);
    double tic = plot_tic(range.to - range.from, 6);
    plot_begin(&plot, &(struct plot_layout){.panels = 1,
                                            .columns = {1, 1},
                                            .height = PLOT_HEIGHT + 60,
                                            .left = plot_left(&range, tic),
                                            .right = END_PX + widest,
                                            .top = 12,
                                            .bottom = 48});
    plot_panel(&plot, 0);
    plot_line(&plot, "set xrange [%g:%g]\nset yrange [%.6g:%.6g]\nset ytics %g", -0.02 * (steps + 1), steps * 1.02 + 0.02,
              range.from, range.to, tic);
    if (steps <= 12)
        plot_line(&plot, "set xtics 1");
    plot_axes(&plot, "iteration [1]", "value over value at the end [1]");
    for (int p = 0; p < count; p++)
        height[p] = plot_share(&range, 1);
    plot_end_labels(&plot, count, name, height, color);
    plot_line(
        &plot,
        "plot 1 with lines lc rgb MUTED lw 0.75, for [c = 2:%d] $parameters using 1:c with linespoints ls c-1 pointinterval %d",
        count + 1, 1 + n / 25);
    return plot_close(&plot);
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
    figure->table = iterates_table(pool, fit, count);
    document->failed |= !figure->caption || !figure->alt || iterates_script(document, figure, result, fit, count) != ROTID_OK;
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

static void bijection_panel(struct plot *plot, const rotid_identification *fit, int p, double most)
{
    const rotid_fitted_parameter *parameter = &fit->parameters[p];
    struct pool *pool = plot->pool;
    const char *title = pool_format(pool, "%s: %s \xe2\x86\x92 %s", parameter->name,
                                    human_value(pool, fit->history[0].x[p], parameter->unit),
                                    human_value(pool, parameter->value, parameter->unit)),
               *upper = pool_format(pool, "1: upper bound %s", human_value(pool, parameter->upper, parameter->unit)),
               *lower = pool_format(pool, "0: lower bound %s", human_value(pool, parameter->lower, parameter->unit));
    plot_panel(plot, p);
    plot_line(plot, "set xrange [%g:%g]\nset yrange [-0.03:1.03]\nset ytics 0.25", -most, most);
    plot_axes(plot, isfinite(fit->bijection_chi) ? "unbounded variable y [1]" : "\xcf\x87 y [1]", "share of the way [1]");
    plot_label(plot, title ? title : "", "graph 0, graph 1.08", "INK", "left");
    plot_label(plot, upper ? upper : "", "graph 0.98, graph 0.93", "MUTED", "right");
    plot_label(plot, lower ? lower : "", "graph 0.02, graph 0.08", "MUTED", "left");
    plot_line(
        plot,
        "plot share(x) with lines lc rgb MUTED lw 1, $iterates%d using 1:2 with points ls 6, $iterates%d every ::%d using 1:2 "
        "with points ls 1 ps 0.9",
        p + 1, p + 1, fit->nhistory - 1);
}

static int bijection_script(struct document *document, struct figure *figure, const struct result *result,
                            const rotid_identification *fit, int count)
{
    struct pool *pool = document->pool;
    int n = fit->nhistory;
    double *u = POOL_ARRAY(pool, double, 3 * (size_t)n), chi = isfinite(fit->bijection_chi) ? fit->bijection_chi : 1, most = 5;
    struct plot plot;
    if (!u || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns of an iterate: y, share of the way from the lower to the upper bound, iteration");
    for (int p = 0; p < count; p++) {
        char name[32];
        for (int i = 0; i < n; i++) {
            u[i] = unbounded(&fit->parameters[p], fit->history[i].x[p]) / chi;
            u[i + n] = share(&fit->parameters[p], fit->history[i].x[p]);
            u[i + 2 * n] = fit->history[i].iteration;
            if (isfinite(u[i]))
                most = fmax(most, fabs(u[i] * chi) + 1);
        }
        (void)snprintf(name, sizeof name, "iterates%d", p + 1);
        plot_data(&plot, name, n, 3, (const double *const[]){u, u + n, u + 2 * (ptrdiff_t)n});
    }
    plot_line(&plot, "chi = %g\nshare(y) = 1 / (1 + exp(chi * y))", chi);
    plot_begin(&plot, &(struct plot_layout){.panels = count,
                                            .columns = {count > 1 ? 2 : 1, 1},
                                            .height = PLOT_HEIGHT + 20,
                                            .left = 58,
                                            .right = 14,
                                            .top = 30,
                                            .bottom = 48});
    for (int p = 0; p < count; p++)
        bijection_panel(&plot, fit, p, most / chi);
    return plot_close(&plot);
}

static struct number_table *bounds_table(struct pool *pool, const rotid_identification *fit)
{
    static const char *const head[] = {"parameter", "unit", "lower bound", "start", "end", "upper bound", "place [%]"};
    struct number_table *table = table_new(pool, fit->nparameters, 7);
    for (int j = 0; j < 7; j++)
        table_head(table, j, head[j]);
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
    document->failed |= !figure->caption || !figure->alt || bijection_script(document, figure, result, fit, count) != ROTID_OK;
}
