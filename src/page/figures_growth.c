/* f(E) and f(F) over the square of the perturbation: Figure 3 of the paper. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/series.h"

#define MOST_TICKS 8 /* numbered decades of an axis */

static const struct growth_line *line_of(const struct growth *growth, int kind)
{
    return kind == GROWTH_E ? &growth->hybrid : &growth->hybrid_f;
}

/* Older results lack the functional of the shapes alone, then the series lacks its column. */
static struct series *collect(struct document *document, const struct growth *growth)
{
    static const struct column columns[] = {{"\xce\xb5\xc2\xb2", "1", AS_DIGITS, 3},
                                            {"f(E)", "1", AS_DIGITS, 4},
                                            {"f(F)", "1", AS_DIGITS, 4},
                                            {"f(E), shapes alone", "1", AS_DIGITS, 2}};
    const double *alone = growth->shapes_alone;
    struct series *series = series_new(document, "growth", growth->nepsilon_squared, alone ? 4 : 3, columns);
    for (int i = 0; i < growth->nepsilon_squared; i++)
        series_row(series, i,
                   (const double[]){growth->epsilon_squared[i], growth->hybrid.objective[i], growth->hybrid_f.objective[i],
                                    alone ? alone[i] : (double)NAN});
    return series;
}

static void draw(struct plot *plot, struct series *series, const struct growth *growth)
{
    int n = growth->nepsilon_squared;
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 300, .left = 62, .right = 16, .top = 10, .bottom = 48};
    const struct plot_entry entry[] = {{.text = "f(E), HYBRID", .style = 1, .keys = KEY_MARK | KEY_LINE},
                                       {.text = "f(F), HYBRID_F", .style = 2, .keys = KEY_MARK | KEY_LINE}};
    struct plot_range x = plot_decades(n, series_values(series, 0), 30), y = plot_decades(2 * n, series_values(series, 1), 30);
    plot_head(entry, 2, layout.head);
    plot_series(plot, series);
    plot_line(plot, "# straight lines through the logarithms\nE(x) = exp(%s + %s * log(x)); F(x) = exp(%s + %s * log(x))",
              plot_number(plot, growth->hybrid.intercept), plot_number(plot, growth->hybrid.slope),
              plot_number(plot, growth->hybrid_f.intercept), plot_number(plot, growth->hybrid_f.slope));
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_decades_axis(plot, 'x', &x, MOST_TICKS);
    plot_decades_axis(plot, 'y', &y, MOST_TICKS);
    plot_axes(plot, "square of the perturbation [1]", "functional [1]");
    plot_legend(plot, entry, 2);
    plot_line(plot, "plot E(x) with lines ls 1, F(x) with lines ls 2, $growth using 1:2 with points ls 1, $growth using 1:3 "
                    "with points ls 2");
}

void figure_growth(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct growth *growth = result->sensitivity->functional_growth;
    if (!growth || growth->nepsilon_squared < 2)
        return;
    struct figure *figure = document_figure(document, "growth", "Growth of the two functionals away from the optimum");
    const char *line[2];
    double rounding = 0;
    for (int kind = 0; kind < 2; kind++)
        line[kind] = pool_format(pool, "ln f(%c) = %s ln \xce\xb5\xc2\xb2 %s %s", "EF"[kind],
                                 human_fixed(pool, line_of(growth, kind)->slope, 4),
                                 line_of(growth, kind) -> intercept < 0 ? "\xe2\x88\x92" : "+",
                                 human_fixed(pool, fabs(line_of(growth, kind)->intercept), 3));
    for (int i = 0; i < growth->nepsilon_squared && growth->shapes_alone; i++)
        rounding = fmax(rounding, fabs(growth->shapes_alone[i]));
    const char *alone =
        growth->shapes_alone
            ? pool_format(pool, " Where the measured shapes alone are perturbed, f(E) stays below %s: it does not see them.",
                          human_digits(pool, rounding, 2))
            : "";
    figure->caption = pool_format(
        pool, "Both grow with the square of the perturbation: %s, %s. They differ by a factor of %s (4 to first order).%s",
        line[0] ? line[0] : "", line[1] ? line[1] : "",
        human_digits(pool, exp(growth->hybrid.intercept - growth->hybrid_f.intercept), 2), alone ? alone : "");
    figure->alt = pool_format(pool, "Two straight lines on logarithmic scales, one above the other, with %d points on each.",
                              growth->nepsilon_squared);
    struct series *series = collect(document, growth);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, growth);
    figure_end(document, &plot);
}
