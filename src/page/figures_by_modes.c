/* The functional and the parameters of a study by the number of modes that were fitted. */
#include <math.h>
#include <string.h>

#include "page/by_modes.h"
#include "page/figures_study.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

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

static int functional_script(struct document *document, struct figure *figure, const struct result *result,
                             const struct by_modes *by)
{
    struct plot_entry entry[BY_MODES_SERIES];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 280, .left = 74, .right = 16, .top = 10, .bottom = 48};
    struct plot plot;
    double most = 0;
    int nentry = legend_of(by, entry);
    plot_head(entry, nentry, layout.head);
    if (plot_open(&plot, document->pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: fitted modes m, mean functional over m^2");
    for (int s = 0; s < by->nseries; s++) {
        const struct modes_series *series = &by->series[s];
        double *x = POOL_ARRAY(document->pool, double, 2 * (size_t)series->count), *y = x ? x + series->count : NULL;
        char name[32];
        for (int i = 0; i < series->count && x; i++) {
            x[i] = series->point[i].fitted;
            y[i] = series->point[i].functional;
            most = fmax(most, y[i]);
        }
        (void)snprintf(name, sizeof name, "series%d", s + 1);
        if (x)
            plot_data(&plot, name, series->count, 2, (const double *const[]){x, y});
        document->failed |= !x;
    }
    double power = most > 0 && most < 0.1 ? pow(1000, floor(log10(most) / 3)) : 1; /* 1e-3, 1e-6: short numbers at the ticks */
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, nentry);
    plot_line(&plot, "set yrange [0:%.6g]", most > 0 ? 1.08 * most / power : 1);
    const char *unit = power < 1 ? human_power(document->pool, (int)floor(log10(power) + 0.5)) : "1",
               *axis = pool_format(document->pool, "mean functional f/m\xc2\xb2 [%s]", unit);
    axis_of_modes(&plot, by, axis ? axis : "");
    (void)fputs("plot ", plot.out);
    for (int s = 0; s < by->nseries; s++)
        (void)fprintf(plot.out, "%s$series%d using 1:($2/%g) with linespoints ls %d", s ? ", " : "", s + 1, power, s + 1);
    (void)fputc('\n', plot.out);
    return plot_close(&plot);
}

static const char *functional_text(struct pool *pool, double functional)
{
    return human_digits(pool, functional < ROUNDING ? 0 : functional, 3);
}

static struct number_table *functional_table(struct pool *pool, const struct by_modes *by)
{
    int rows = 0, row = 0;
    for (int s = 0; s < by->nseries; s++)
        rows += by->series[s].count;
    struct number_table *table = table_new(pool, rows, 3);
    table_head(table, 0, "variant");
    table_head(table, 1, "fitted modes m [1]");
    table_head(table, 2, "mean functional f/m\xc2\xb2 [1]");
    for (int s = 0; s < by->nseries; s++)
        for (int i = 0; i < by->series[s].count; i++, row++) {
            table_cell(table, row, 0, *by->series[s].name ? by->series[s].name : "as stated");
            table_cell(table, row, 1, human_fixed(pool, by->series[s].point[i].fitted, 0));
            table_cell(table, row, 2, functional_text(pool, by->series[s].point[i].functional));
        }
    return table;
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
    figure->table = functional_table(pool, &by);
    document->failed |= !says || !figure->caption || !figure->alt || functional_script(document, figure, result, &by) != ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------------ parameters */

static const struct cell_parameter *in(const struct told_cell *cell, const char *name)
{
    for (int p = 0; p < cell->is.nparameters; p++)
        if (!strcmp(cell->is.parameters[p].name, name))
            return &cell->is.parameters[p];
    return NULL;
}

/* Values and their stated deviations of a parameter, [count] each, in a unit. */
static int values_of(const struct study_outcome *study, const struct modes_series *series, const char *name, double factor,
                     double *x, double *y, double *bar)
{
    int n = 0;
    for (int i = 0; i < series->count; i++) {
        const struct cell_parameter *p = in(&study->cell[series->point[i].cell], name);
        if (!p || !isfinite(p->mean))
            continue;
        x[n] = series->point[i].fitted;
        y[n] = factor * p->mean;
        bar[n++] = factor * p->mean_stated_std;
    }
    return n;
}

static int parameters_script(struct document *document, struct figure *figure, const struct result *result,
                             const struct by_modes *by, int panels, const struct cell_parameter *const parameter[])
{
    struct pool *pool = document->pool;
    const struct study_outcome *study = result->studied;
    struct plot_entry entry[BY_MODES_SERIES];
    struct plot_layout layout = {
        .panels = panels, .columns = {panels > 1 ? 2 : 1, 1}, .height = 270, .left = 62, .right = 14, .top = 10, .bottom = 48};
    struct plot_range range[MOST_PANELS];
    int nentry = legend_of(by, entry), count[MOST_PANELS][BY_MODES_SERIES];
    struct human_unit unit[MOST_PANELS];
    double *room = POOL_ARRAY(pool, double, 3 * (size_t)study->is.ncells);
    struct plot plot;
    plot_head(entry, nentry, layout.head);
    if (!room || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: fitted modes m, mean value, mean of the stated standard deviations");
    for (int p = 0; p < panels; p++) {
        range[p] = (struct plot_range){INFINITY, -INFINITY};
        unit[p] = human_unit(parameter[p]->mean, parameter[p]->unit);
        for (int s = 0; s < by->nseries; s++) {
            double *x = room, *y = room + study->is.ncells, *bar = room + 2 * (ptrdiff_t)study->is.ncells;
            int n = values_of(study, &by->series[s], parameter[p]->name, unit[p].factor, x, y, bar);
            char name[48];
            for (int i = 0; i < n; i++) { /* a deviation larger than half the value is cut off by the panel */
                double reach = fmin(isfinite(bar[i]) ? bar[i] : 0, 0.5 * fabs(y[i]));
                plot_range_join(&range[p], y[i] + reach);
                plot_range_join(&range[p], y[i] - reach);
            }
            count[p][s] = n;
            (void)snprintf(name, sizeof name, "p%d_%d", p + 1, s + 1);
            if (n)
                plot_data(&plot, name, n, 3, (const double *const[]){x, y, bar});
        }
    }
    plot_begin(&plot, &layout);
    for (int p = 0; p < panels; p++) {
        char where[64];
        const char *axis = pool_format(pool, "%s [%s]", parameter[p]->name, *unit[p].text ? unit[p].text : "1"), *between = "";
        double pad = 0.05 * (range[p].to - range[p].from);
        plot_panel(&plot, p);
        if (!p)
            plot_legend(&plot, entry, nentry);
        pad = pad > 0 ? pad : 0.1 * fabs(range[p].from) + 1e-12;
        plot_line(&plot, "set yrange [%.8g:%.8g]", range[p].from - pad, range[p].to + pad);
        axis_of_modes(&plot, by, NULL);
        (void)snprintf(where, sizeof where, "screen (x_of(%d)+12)/W, graph 0.5", p);
        plot_label(&plot, axis ? axis : "", where, "INK", "center rotate");
        (void)fputs("plot ", plot.out);
        for (int s = 0; s < by->nseries; s++) {
            if (!count[p][s])
                continue;
            (void)fprintf(
                plot.out,
                "%s$p%d_%d using ($1%+g):2:3 with yerrorbars ls %d lw 1 ps 0, $p%d_%d using ($1%+g):2 with linespoints ls %d",
                between, p + 1, s + 1, SIDE * (s - 0.5 * (by->nseries - 1)), s + 1, p + 1, s + 1,
                SIDE * (s - 0.5 * (by->nseries - 1)), s + 1);
            between = ", \\\n    ";
        }
        (void)fputc('\n', plot.out);
    }
    return plot_close(&plot);
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
    /* its numbers: the table of the cells */
    document->failed |= !says || !figure->caption || !figure->alt ||
                        parameters_script(document, figure, result, &by, panels, parameter) != ROTID_OK;
}
