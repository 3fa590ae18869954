/* f(E) and f(F) over the square of the perturbation: Figure 3 of the paper. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_TICKS 8 /* numbered decades of an axis */

static const struct growth_line *line_of(const struct growth *growth, int kind)
{
    return kind == GROWTH_E ? &growth->hybrid : &growth->hybrid_f;
}

static struct number_table *growth_table(struct pool *pool, const struct growth *growth)
{
    struct number_table *table = table_new(pool, growth->nepsilon_squared, 4);
    table_head(table, 0, "\xce\xb5\xc2\xb2 [1]");
    table_head(table, 1, "f(E) [1]");
    table_head(table, 2, "f(F) [1]");
    table_head(table, 3, "f(E), shapes alone [1]");
    for (int i = 0; i < growth->nepsilon_squared; i++) {
        table_cell(table, i, 0, human_digits(pool, growth->epsilon_squared[i], 3));
        for (int kind = 0; kind < 2; kind++)
            table_cell(table, i, 1 + kind, human_digits(pool, line_of(growth, kind)->objective[i], 4));
        table_cell(table, i, 3, growth->shapes_alone ? human_digits(pool, growth->shapes_alone[i], 2) : "");
    }
    return table;
}

static int script(struct document *document, struct figure *figure, const struct result *result, const struct growth *growth)
{
    struct pool *pool = document->pool;
    int n = growth->nepsilon_squared;
    struct plot plot;
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 300, .left = 62, .right = 16, .top = 10, .bottom = 48};
    const struct plot_entry entry[] = {{.text = "f(E), HYBRID", .style = 1, .keys = KEY_MARK | KEY_LINE},
                                       {.text = "f(F), HYBRID_F", .style = 2, .keys = KEY_MARK | KEY_LINE}};
    double *both = POOL_ARRAY(pool, double, 2 * (size_t)n);
    if (!both || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * n; i++)
        both[i] = line_of(growth, i / n)->objective[i % n];
    struct plot_range y = plot_decades(2 * n, both, 30), x = plot_decades(n, growth->epsilon_squared, 30);
    plot_head(entry, 2, layout.head);
    plot_line(&plot, "# columns: eps^2, f(E), f(F)");
    plot_data(&plot, "growth", n, 3,
              (const double *const[]){growth->epsilon_squared, growth->hybrid.objective, growth->hybrid_f.objective});
    plot_line(&plot, "# straight lines through the logarithms\nE(x) = exp(%s + %s * log(x)); F(x) = exp(%s + %s * log(x))",
              plot_number(&plot, growth->hybrid.intercept), plot_number(&plot, growth->hybrid.slope),
              plot_number(&plot, growth->hybrid_f.intercept), plot_number(&plot, growth->hybrid_f.slope));
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_decades_axis(&plot, 'x', &x, MOST_TICKS);
    plot_decades_axis(&plot, 'y', &y, MOST_TICKS);
    plot_axes(&plot, "square of the perturbation [1]", "functional [1]");
    plot_legend(&plot, entry, 2);
    plot_line(&plot, "plot E(x) with lines ls 1, F(x) with lines ls 2, $growth using 1:2 with points ls 1, $growth using 1:3 "
                     "with points ls 2");
    return plot_close(&plot);
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
    figure->table = growth_table(pool, growth);
    document->failed |= !figure->caption || !figure->alt || script(document, figure, result, growth) != ROTID_OK;
}
