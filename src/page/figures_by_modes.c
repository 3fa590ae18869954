/* The functional and the parameters of a study by the number of modes that were fitted. */
#include <math.h>
#include <string.h>

#include "page/by_modes.h"
#include "page/figures_study.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

#define MOST_PANELS 6
#define ROUNDING    1e-15 /* of a functional that is zero but for it */
#define SIDE        0.06  /* between series: bars would lie on each other */

static int most_fitted(const struct by_modes *by)
{
    int most = 0;
    for (int s = 0; s < by->nseries; s++)
        most = by->series[s].point[by->series[s].count - 1].fitted > most ? by->series[s].point[by->series[s].count - 1].fitted
                                                                          : most;
    return most;
}

static int legend_of(const struct by_modes *by, struct plot_entry *entry)
{
    int n = 0;
    for (int s = 0; s < by->nseries && by->nseries > 1; s++)
        entry[n++] = (struct plot_entry){.text = by->series[s].name, .style = s + 1, .keys = KEY_LINE | KEY_MARK};
    return n;
}

static void axis_of_modes(struct plot *plot, const struct by_modes *by, const char *y)
{
    int low = most_fitted(by), high = low;
    for (int s = 0; s < by->nseries; s++)
        low = by->series[s].point[0].fitted < low ? by->series[s].point[0].fitted : low;
    plot_line(plot, "set xrange [%g:%g]\nset xtics %g", low - 0.3, high + 0.3, high - low > 12 ? plot_tic(high - low, 6) : 1.0);
    plot_axes(plot, "fitted modes m [1]", y);
}

static const char *functional_text(struct pool *pool, double functional)
{
    return human_digits(pool, functional < ROUNDING ? 0 : functional, 3);
}

static struct series *collect_functional(struct document *document, const struct by_modes *by, int s)
{
    static const struct column columns[] = {
        {"variant", NULL, AS_TEXT, 0}, {"fitted modes m", "1", AS_FIXED, 0}, {"mean functional f/m\xc2\xb2", "1", AS_DIGITS, 3}};
    const struct modes_series *of = &by->series[s];
    struct series *series = series_new(document, pool_format(document->pool, "variant%d", s + 1), of->count, 3, columns);
    for (int i = 0; i < of->count; i++) {
        const struct modes_point *point = &of->point[i];
        series_row(series, i, (const double[]){point->fitted, point->functional});
        series_text(series, i, 0, *of->name ? of->name : "as stated");
        series_text(series, i, 2, functional_text(document->pool, point->functional));
    }
    return series;
}

static void draw_functional(struct plot *plot, const struct by_modes *by, struct series *const series[])
{
    struct plot_entry entry[BY_MODES_SERIES];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .left = 74, .right = 16, .top = 10, .bottom = 48};
    double most = 0;
    int nentry = legend_of(by, entry);
    plot_head(entry, nentry, layout.head);
    for (int s = 0; s < by->nseries; s++) {
        plot_series(plot, series[s]);
        for (int i = 0; i < by->series[s].count; i++)
            most = fmax(most, by->series[s].point[i].functional);
    }
    double power = most > 0 && most < 0.1 ? pow(1000, floor(log10(most) / 3)) : 1; /* 1e-3, 1e-6: short numbers at the ticks */
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, nentry);
    plot_line(plot, "set yrange [0:%.6g]", most > 0 ? 1.08 * most / power : 1);
    const char *unit = power < 1 ? human_power(plot->pool, (int)floor(log10(power) + 0.5)) : "1",
               *axis = pool_format(plot->pool, "mean functional f/m\xc2\xb2 [%s]", unit);
    axis_of_modes(plot, by, axis ? axis : "");
    (void)fputs("plot ", plot->out);
    for (int s = 0; s < by->nseries; s++)
        (void)fprintf(plot->out, "%s$variant%d using 1:($2/%g) with linespoints ls %d", s ? ", " : "", s + 1, power, s + 1);
    (void)fputc('\n', plot->out);
}

void figure_functional_by_modes(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct by_modes by;
    const char *says = "";
    if (by_modes_make(pool, result->studied, &by)) {
        document->failed = 1;
        return;
    }
    if (!by.nseries)
        return;
    struct figure *figure = document_figure(document, "functional-by-modes", "Mean functional by the number of fitted modes");
    for (int s = 0; s < by.nseries && says; s++) {
        const struct modes_point *first = by.series[s].point, *last = &first[by.series[s].count - 1];
        says = pool_format(pool, "%s%s%s%s%s with %d %s, %s with %d", says, s ? "; " : "", by.series[s].name,
                           *by.series[s].name ? " " : "", functional_text(pool, first->functional), first->fitted,
                           human_plural(first->fitted, "mode", "modes"), functional_text(pool, last->functional), last->fitted);
    }
    figure->caption = pool_format(
        pool,
        "Mean functional for each pair of modes at the optimum: %s.%s A functional that is small because no more modes "
        "than parameters were fitted says nothing about the model.",
        says ? says : "", by.more ? " Further variants stand in the table of the cells." : "");
    figure->alt =
        pool_format(pool, "One line for each of %d variants over the number of modes: %s.", by.nseries, says ? says : "");
    struct series *series[BY_MODES_SERIES];
    struct plot plot;
    for (int s = 0; s < by.nseries; s++)
        series[s] = collect_functional(document, &by, s);
    document->failed |= !says;
    figure->table = series_table_of(by.nseries, (const struct series *const *)series);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    draw_functional(&plot, &by, series);
    figure_end(document, &plot);
}

/* ------------------------------------------------------------------------------------------------------ parameters */

static const struct cell_parameter *in(const struct told_cell *cell, const char *name)
{
    for (int p = 0; p < cell->is.nparameters; p++)
        if (!strcmp(cell->is.parameters[p].name, name))
            return &cell->is.parameters[p];
    return NULL;
}

static int has_value(const struct cell_parameter *p)
{
    return p && isfinite(p->mean);
}

/* Of the cells where the parameter has a value. Its numbers stand in the table of the cells. */
static struct series *collect_parameter(struct document *document, const struct study_outcome *study,
                                        const struct modes_series *of, const char *data, const char *name,
                                        const struct human_unit *unit)
{
    const char *text = *unit->text ? unit->text : "1";
    const struct column columns[] = {
        {"fitted modes m", "1", AS_PLACE, 0}, {name, text, AS_PLACE, 0}, {"its stated standard deviation", text, AS_PLACE, 0}};
    int rows = 0, row = 0;
    for (int i = 0; i < of->count; i++)
        rows += has_value(in(&study->cell[of->point[i].cell], name));
    struct series *series = series_new(document, data, rows, 3, columns);
    for (int i = 0; i < of->count; i++) {
        const struct cell_parameter *p = in(&study->cell[of->point[i].cell], name);
        if (has_value(p))
            series_row(series, row++,
                       (const double[]){of->point[i].fitted, unit->factor * p->mean, unit->factor * p->mean_stated_std});
    }
    return series;
}

struct parameter_panel {
    const struct cell_parameter *parameter;
    struct human_unit unit;
    struct series *series[BY_MODES_SERIES];
    struct plot_range range;
};

static struct parameter_panel collect_panel(struct document *document, const struct study_outcome *study,
                                            const struct by_modes *by, int p, const struct cell_parameter *parameter)
{
    struct parameter_panel panel = {parameter, human_unit(parameter->mean, parameter->unit), {NULL}, {INFINITY, -INFINITY}};
    for (int s = 0; s < by->nseries; s++) {
        struct series *series = panel.series[s] = collect_parameter(
            document, study, &by->series[s], pool_format(document->pool, "p%d_%d", p + 1, s + 1), parameter->name, &panel.unit);
        for (int i = 0; i < series_rows(series); i++) { /* a deviation larger than half the value is cut off by the panel */
            double value = series_values(series, 1)[i], bar = series_values(series, 2)[i],
                   reach = fmin(isfinite(bar) ? bar : 0, 0.5 * fabs(value));
            plot_range_join(&panel.range, value + reach);
            plot_range_join(&panel.range, value - reach);
        }
    }
    return panel;
}

static void draw_panel(struct plot *plot, const struct by_modes *by, const struct parameter_panel *panel, int p)
{
    const char *axis = pool_format(plot->pool, "%s [%s]", panel->parameter->name, *panel->unit.text ? panel->unit.text : "1"),
               *between = "";
    const struct plot_range *range = &panel->range;
    double pad = 0.05 * (range->to - range->from);
    char where[64];
    pad = pad > 0 ? pad : 0.1 * fabs(range->from) + 1e-12;
    plot_line(plot, "set yrange [%.8g:%.8g]", range->from - pad, range->to + pad);
    axis_of_modes(plot, by, NULL);
    (void)snprintf(where, sizeof where, "screen (x_of(%d)+12)/W, graph 0.5", p);
    plot_label(plot, axis ? axis : "", where, "INK", "center rotate");
    (void)fputs("plot ", plot->out);
    for (int s = 0; s < by->nseries; s++) {
        double side = SIDE * (s - 0.5 * (by->nseries - 1));
        if (!series_rows(panel->series[s]))
            continue;
        (void)fprintf(
            plot->out,
            "%s$p%d_%d using ($1%+g):2:3 with yerrorbars ls %d lw 1 ps 0, $p%d_%d using ($1%+g):2 with linespoints ls %d",
            between, p + 1, s + 1, side, s + 1, p + 1, s + 1, side, s + 1);
        between = ", \\\n    ";
    }
    (void)fputc('\n', plot->out);
}

static void draw_parameters(struct plot *plot, const struct by_modes *by, int panels, const struct parameter_panel *panel)
{
    struct plot_entry entry[BY_MODES_SERIES];
    struct plot_layout layout = {
        .panels = panels, .columns = {panels > 1 ? 2 : 1, 1}, .height = 270, .left = 62, .right = 14, .top = 10, .bottom = 48};
    int nentry = legend_of(by, entry);
    plot_head(entry, nentry, layout.head);
    for (int p = 0; p < panels; p++)
        for (int s = 0; s < by->nseries; s++)
            if (series_rows(panel[p].series[s]))
                plot_series(plot, panel[p].series[s]);
    plot_begin(plot, &layout);
    for (int p = 0; p < panels; p++) {
        plot_panel(plot, p);
        if (!p)
            plot_legend(plot, entry, nentry);
        draw_panel(plot, by, &panel[p], p);
    }
}

/* Parameters of all cells of the series, each once. */
static int parameters_of(const struct study_outcome *study, const struct by_modes *by, const struct cell_parameter *parameter[])
{
    int count = 0;
    for (int s = 0; s < by->nseries; s++)
        for (int i = 0; i < by->series[s].count; i++) {
            const struct told_cell *cell = &study->cell[by->series[s].point[i].cell];
            for (int p = 0; p < cell->is.nparameters; p++) {
                int known = 0;
                for (int k = 0; k < count; k++)
                    known |= !strcmp(parameter[k]->name, cell->is.parameters[p].name);
                if (!known && count < MOST_PANELS && isfinite(cell->is.parameters[p].mean))
                    parameter[count++] = &cell->is.parameters[p];
            }
        }
    return count;
}

void figure_parameters_by_modes(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct study_outcome *study = result->studied;
    const struct cell_parameter *parameter[MOST_PANELS];
    struct by_modes by;
    const char *says = "";
    if (by_modes_make(pool, study, &by)) {
        document->failed = 1;
        return;
    }
    int panels = by.nseries ? parameters_of(study, &by, parameter) : 0;
    if (!panels)
        return;
    struct figure *figure = document_figure(document, "parameters-by-modes", "Parameters by the number of fitted modes");
    for (int p = 0; p < panels && p < 2 && says; p++)
        for (int s = 0; s < by.nseries && says; s++) {
            const struct modes_series *series = &by.series[s];
            const struct cell_parameter *first = in(&study->cell[series->point[0].cell], parameter[p]->name),
                                        *last = in(&study->cell[series->point[series->count - 1].cell], parameter[p]->name);
            if (first && last)
                says = pool_format(pool, "%s%s%s%s%s goes from %s with %d modes to %s with %d", says, *says ? "; " : "",
                                   by.series[s].name, *by.series[s].name ? ": " : "", parameter[p]->name,
                                   human_value(pool, first->mean, first->unit), series->point[0].fitted,
                                   human_value(pool, last->mean, last->unit), series->point[series->count - 1].fitted);
        }
    figure->caption =
        pool_format(pool,
                    "%s. Bars are one standard deviation as the fits state it; where there is none, the data are no more "
                    "than the unknowns.",
                    says ? says : "");
    figure->alt = pool_format(pool, "A panel for each of %d parameters over the number of modes: %s.", panels, says ? says : "");
    struct parameter_panel panel[MOST_PANELS];
    struct plot plot;
    for (int p = 0; p < panels; p++)
        panel[p] = collect_panel(document, study, &by, p, parameter[p]);
    document->failed |= !says;
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    draw_parameters(&plot, &by, panels, panel);
    figure_end(document, &plot);
}
