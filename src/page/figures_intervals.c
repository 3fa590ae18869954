/* Parameters with their 95 % intervals. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/series.h"

#define ROW_PX       44.0
#define MOST_PERCENT 300.0 /* of the value: beyond that an interval says nothing but that */

static struct series *collect(struct document *document, const rotid_identification *fit)
{
    static const struct column columns[] = {{"row from below", NULL, AS_PLACE, 0},
                                            {"lower end", "% of the value", AS_PLACE, 0},
                                            {"upper end", "% of the value", AS_PLACE, 0}};
    int n = fit->nparameters;
    struct series *series = series_new(document, "intervals", n, 3, columns);
    for (int p = 0; p < n; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        double percent[2];
        for (int e = 0; e < 2; e++) {
            percent[e] = 100 * (parameter->ci95[e] - parameter->value) / fabs(parameter->value);
            percent[e] = isfinite(percent[e]) ? fmin(fmax(percent[e], -MOST_PERCENT), MOST_PERCENT) : (double)NAN;
        }
        series_row(series, p, (const double[]){n - p, percent[0], percent[1]});
    }
    return series;
}

static const char *text_of(struct pool *pool, struct series *series, const rotid_identification *fit, int p)
{
    const rotid_fitted_parameter *parameter = &fit->parameters[p];
    const char *text =
        pool_format(pool, "%s = %s%s", parameter->name, human_interval(pool, parameter->value, parameter->ci95, parameter->unit),
                    parameter->at_bound                                 ? ", at its bound"
                    : !isfinite(parameter->ci95[0])                     ? ", no interval"
                    : fabs(series_values(series, 2)[p]) >= MOST_PERCENT ? ", wider than drawn"
                                                                        : "");
    return text ? text : "";
}

static void draw(struct plot *plot, struct series *series, const rotid_identification *fit)
{
    int n = fit->nparameters;
    struct plot_range range = {-1, 1};
    for (int p = 0; p < n; p++) {
        plot_range_join(&range, series_values(series, 1)[p]);
        plot_range_join(&range, series_values(series, 2)[p]);
    }
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .left = 16, .right = 16, .top = 10, .bottom = 48};
    double room = plot_panel_px(&layout), more = 0;
    for (int p = 0; p < n; p++) {
        const char *text = text_of(plot->pool, series, fit, p);
        more = fmax(more, plot_lines_px(1, &text, room));
    }
    layout.height = 58 + (ROW_PX + more) * n;
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_line(plot, "set xrange [%g:%g]\nset yrange [0.6:%g]\nunset ytics\nset border 1", 1.1 * range.from, 1.1 * range.to,
              n + 0.6);
    plot_axes(plot, "deviation from the identified value [%]", NULL);
    for (int p = 0; p < n; p++) {
        char where[48];
        (void)snprintf(where, sizeof where, "graph 0.01, first %g", n - p + 0.32 * ROW_PX / (ROW_PX + more));
        plot_label_over(plot, text_of(plot->pool, series, fit, p), room, where, 0, "INK");
    }
    plot_line(plot, "plot $intervals using 2:1:($3-$2):(0) with vectors heads size screen 0.008,90 ls 1 lw 2 dt 1, \\\n"
                    "    $intervals using (0):1 with points ls 1 ps 1");
}

void figure_intervals(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    const char *says = "";
    if (!fit->nparameters)
        return;
    struct figure *figure = document_figure(document, "intervals", "Parameters with their 95 % intervals");
    for (int p = 0; p < fit->nparameters && p < 4 && says; p++) {
        double half = human_half_width_percent(fit->parameters[p].value, fit->parameters[p].ci95);
        says = isfinite(half) ? pool_format(pool, "%s%s%s is known to \xc2\xb1%s\xc2\xa0%%", says, p ? ", " : "",
                                            fit->parameters[p].name, human_digits(pool, half, 2))
                              : pool_format(pool, "%s%s%s has no interval", says, p ? ", " : "", fit->parameters[p].name);
    }
    const char *correlated = fit->nparameters == 2 && fit->correlation && isfinite(fit->correlation[1])
                                 ? pool_format(pool, " Their correlation is %s.", human_fixed(pool, fit->correlation[1], 2))
                                 : "";
    figure->caption = pool_format(pool, "%s%s.%s The intervals rest on %s.", says ? says : "",
                                  fit->nparameters > 4 ? ", and so on" : "", correlated ? correlated : "",
                                  !isfinite(fit->chi2)            ? "the misfit that is left, since no noise is stated"
                                  : fit->intervals_widened_by > 1 ? "the stated noise, widened because the misfit exceeds it"
                                                                  : "the stated noise of the measurement");
    figure->alt = pool_format(pool, "One bar for each of %d parameters, from the lower to the upper end of its interval: %s.",
                              fit->nparameters, says ? says : "");
    struct series *series = collect(document, fit);
    struct plot plot;
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    plot_series(&plot, series); /* as a table: tables_parameters */
    draw(&plot, series, fit);
    figure_end(document, &plot);
}
