/* What one more sensor is worth along the axis, over the places of the plans. */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

enum { PLACE, WORTH, MARGIN, PLACES }; /* columns */

static const struct column columns[PLACES] = {
    {"z", "m", AS_TRIMMED, 4}, {"worth of one more sensor", "%", AS_FIXED, 3}, {"rise of the margins by it", "%", AS_FIXED, 3}};
static const struct column plan_columns[] = {
    {"z", "m", AS_TRIMMED, 4}, {"plan, from below", "1", AS_FIXED, 0}, {"loss without this sensor", "%", AS_FIXED, 3}};

static struct series *collect(struct document *document, const rotid_suggestion *s)
{
    struct series *series = series_new(document, "places", s->nplaces, PLACES, columns);
    for (int i = 0; i < s->nplaces; i++)
        series_row(series, i, (const double[]){s->places[i].z_m, s->places[i].worth_percent, s->places[i].margin_percent});
    return series;
}

static struct series *collect_plans(struct document *document, const rotid_suggestion *s)
{
    int rows = 0, row = 0;
    for (int p = 0; p < s->nplans; p++)
        rows += s->plans[p].nz_m;
    struct series *series = series_new(document, "sensors", rows, 3, plan_columns);
    for (int p = 0; p < s->nplans; p++)
        for (int i = 0; i < s->plans[p].nz_m; i++)
            series_row(series, row++, (const double[]){s->plans[p].z_m[i], s->nplans - p, s->plans[p].loss_percent[i]});
    return series;
}

static int has_margins(const rotid_suggestion *s)
{
    for (int i = 0; i < s->nplaces; i++)
        if (isfinite(s->places[i].margin_percent))
            return 1;
    return 0;
}

static const char *plan_name(struct pool *pool, const char *method)
{
    return !strcmp(method, "deck") ? "deck" : !strcmp(method, "optimal") ? "optimal" : pool_copy_text(pool, "Kammer 1991");
}

static void curve_panel(struct plot *plot, int panel, struct series *series, const rotid_suggestion *s, int column,
                        const char *axis)
{
    struct plot_range range = plot_range_of(s->nplaces, series_values(series, column), 0.05);
    plot_range_join(&range, 0);
    plot_panel(plot, panel);
    plot_line(plot, "set xrange [0:%.6g]\nset yrange [%.6g:%.6g]\nset xtics %g\nset ytics %g",
              s->geometry ? s->geometry->length_m : 1.0, range.from, range.to > 0 ? range.to : 1,
              plot_tic(s->geometry ? s->geometry->length_m : 1, 6), plot_tic(range.to - range.from, 4));
    plot_axes(plot, "z [m]", axis);
    plot_line(plot, "plot $places using 1:%d with linespoints ls %d pt 7 ps 0.3", column + 1, column);
}

static void draw(struct plot *plot, struct series *series, const rotid_suggestion *s, int margins)
{
    struct plot_layout layout = {
        .panels = 2 + margins, .columns = {1, 1}, .height = 190, .left = 108, .right = 14, .top = 10, .bottom = 48};
    plot_begin(plot, &layout);
    curve_panel(plot, 0, series, s, WORTH, "worth [%]");
    if (margins)
        curve_panel(plot, 1, series, s, MARGIN, "margins [%]");
    plot_panel(plot, 1 + margins);
    plot_line(plot, "set xrange [0:%.6g]\nset yrange [0.5:%d.5]\nset xtics %g\nset ytics ()",
              s->geometry ? s->geometry->length_m : 1.0, s->nplans, plot_tic(s->geometry ? s->geometry->length_m : 1, 6));
    for (int p = 0; p < s->nplans; p++)
        plot_line(plot, "set ytics add (%s %d)", plot_quote_tick(plot, plan_name(plot->pool, s->plans[p].method)), s->nplans - p);
    plot_axes(plot, "z [m]", NULL);
    plot_line(plot, "plot $sensors using 1:2 with points ls 1 pt 7 ps 0.9");
}

void figure_sensor_worth(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const rotid_suggestion *s = result->suggest;
    int best = -1, margins = has_margins(s);
    for (int i = 0; i < s->nplaces; i++)
        if (isfinite(s->places[i].worth_percent) && (best < 0 || s->places[i].worth_percent > s->places[best].worth_percent))
            best = i;
    if (best < 0 || !s->nplans)
        return;
    struct figure *figure =
        document_figure(document, "sensor-worth", "What one more sensor is worth, and where sensors should be");
    struct series *series = collect(document, s), *plans = collect_plans(document, s);
    struct plot plot;
    figure->caption = pool_format(
        pool,
        "Beside the sensors of the plan \xe2\x80\x9c%s\xe2\x80\x9d one more lowers the standard deviations of moduli and causes "
        "by up to %s\xc2\xa0%%, at %s\xc2\xa0m (geometric mean)%s. Below: the places of each plan.",
        s->plans[0].method, human_digits(pool, s->places[best].worth_percent, 2), human_trimmed(pool, s->places[best].z_m, 4),
        margins ? "; under it, by how much it raises what tells the rivals apart" : "");
    figure->alt = pool_format(pool, "A curve over the axis, largest at %s\xc2\xa0m, and %d rows of points where sensors stand.",
                              human_trimmed(pool, s->places[best].z_m, 4), s->nplans);
    const struct series *const both[] = {series, plans};
    figure->table = series_table_of(2, both);
    if (!series || !plans || !figure_begin(document, figure, result->file, &plot))
        return;
    plot_series(&plot, series);
    plot_series(&plot, plans);
    draw(&plot, series, s, margins);
    figure_end(document, &plot);
}
