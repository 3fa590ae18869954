/* The worked example of a figure: numbers into a table and into the data of a script, the script, caption and alternative text.
 */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

enum { OBJECTIVE, GRADIENT, STEP, DAMPING, CURVES };
#define MOST_DECADES 18

static struct number_table *iterations_table(struct pool *pool, const rotid_identification *fit)
{
    static const char *const head[] = {"iteration",      "objective [1]", "gradient [1]", "damping [1]",
                                       "gain ratio [1]", "step [1]",      "time [ms]"};
    struct number_table *table = table_new(pool, fit->nhistory, 7);
    for (int j = 0; j < 7; j++)
        table_head(table, j, head[j]);
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_history_entry *now = &fit->history[i];
        table_cell(table, i, 0, human_fixed(pool, now->iteration, 0));
        table_cell(table, i, 1, human_digits(pool, now->objective, 8));
        table_cell(table, i, 2, human_digits(pool, now->gradient, 3));
        table_cell(table, i, 3, human_digits(pool, now->mu, 3));
        table_cell(table, i, 4, human_fixed(pool, now->gain_ratio, 3));
        table_cell(table, i, 5, human_digits(pool, now->step, 3));
        table_cell(table, i, 6, human_fixed(pool, 1e3 * now->seconds, 1));
    }
    return table;
}

/* The four curves over the iteration, [nhistory] each, NaN where a logarithm has none; NULL: memory is out. */
static double *curves(struct pool *pool, const rotid_identification *fit)
{
    int n = fit->nhistory;
    double *y = POOL_ARRAY(pool, double, (CURVES + 1) * (size_t)n);
    for (int i = 0; i < n && y; i++) {
        const rotid_history_entry *now = &fit->history[i];
        const double value[CURVES] = {now->objective, now->gradient, now->step, now->mu};
        y[i] = now->iteration;
        for (int c = 0; c < CURVES; c++)
            y[i + (ptrdiff_t)(c + 1) * n] = value[c] > 0 ? value[c] : (double)NAN;
    }
    return y;
}

static double last_of(int n, const double *value)
{
    while (n > 1 && !isfinite(value[n - 1]))
        n--;
    return value[n - 1];
}

/* The decades that are drawn. The damping can be smaller by far than all else, and is left out then: *drawn is the number of
 * curves. */
static struct plot_range decades(int n, const double *y, int *drawn)
{
    struct plot_range others = plot_decades(DAMPING * n, y + n, MOST_DECADES),
                      all = plot_decades(CURVES * n, y + n, MOST_DECADES),
                      damping = plot_decades(n, y + (ptrdiff_t)(1 + DAMPING) * n, MOST_DECADES);
    *drawn = damping.to > others.from ? CURVES : DAMPING;
    return *drawn == CURVES ? all : others;
}

static int script(struct document *document, struct figure *figure, const struct result *result, const rotid_identification *fit,
                  const double *y)
{
    static const char *const text[CURVES] = {"functional", "gradient", "step", "damping \xce\xbc"};
    int n = fit->nhistory, steps = fit->history[n - 1].iteration, drawn;
    const double *data[CURVES + 1];
    struct plot plot;
    struct plot_range range = decades(n, y, &drawn);
    if (plot_open(&plot, document->pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c <= CURVES; c++)
        data[c] = y + (ptrdiff_t)c * n;
    plot_line(&plot, "# columns: iteration, functional, gradient, step, damping");
    plot_data(&plot, "iterations", n, CURVES + 1, data);
    plot_begin(&plot, &(struct plot_layout){
                          .panels = 1, .columns = {1, 1}, .height = 330, .left = 62, .right = 84, .top = 12, .bottom = 48});
    plot_panel(&plot, 0);
    plot_decades_axis(&plot, 'y', &range, 8);
    plot_line(&plot, "set xrange [%g:%g]", fit->history[0].iteration - 0.02 * (steps + 1), steps * 1.02 + 0.02);
    if (steps <= 12)
        plot_line(&plot, "set xtics 1");
    plot_axes(&plot, "iteration [1]", "value [1]");
    double height[CURVES];
    for (int c = 0; c < drawn; c++)
        height[c] = plot_share(&range, log10(last_of(n, data[c + 1])));
    plot_end_labels(&plot, drawn, text, height, series_color);
    plot_line(&plot, "plot for [c = 2:%d] $iterations using 1:c with linespoints ls c-1 pointinterval %d", drawn + 1, 1 + n / 25);
    return plot_close(&plot);
}

void figure_convergence(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    if (fit->nhistory < 2)
        return;
    struct figure *figure =
        document_figure(document, "convergence", "Functional, gradient, damping and step over the iterations");
    const rotid_history_entry *first = &fit->history[0], *last = &fit->history[fit->nhistory - 1];
    const double *y = curves(pool, fit);
    int drawn = CURVES;
    if (y)
        (void)decades(fit->nhistory, y, &drawn);
    const char *damping = drawn < CURVES
                              ? pool_format(pool, " The damping goes from %s to %s, too small to be drawn beside the others.",
                                            human_digits(pool, first->mu, 2), human_digits(pool, last->mu, 2))
                              : "";
    figure->caption = pool_format(
        pool,
        "The functional falls from %s to %s in %s %s and %s evaluations of the model (%s), the gradient from %s to %s. The "
        "iteration ended: %s.%s",
        human_digits(pool, first->objective, 3), human_digits(pool, last->objective, 3), human_count(pool, last->iteration),
        human_plural(last->iteration, "iteration", "iterations"), human_count(pool, fit->evaluations),
        human_seconds(pool, fit->seconds), human_digits(pool, first->gradient, 2), human_digits(pool, last->gradient, 2),
        fit->stop_reason, damping ? damping : "");
    figure->alt =
        pool_format(pool,
                    "%s curves over %d iterations on a logarithmic scale: the functional levels out at %s, the gradient "
                    "falls to %s, the last step is %s, the damping ends at %s.",
                    drawn == CURVES ? "Four" : "Three", last->iteration, human_digits(pool, last->objective, 3),
                    human_digits(pool, last->gradient, 2), human_digits(pool, last->step, 2), human_digits(pool, last->mu, 2));
    figure->table = iterations_table(pool, fit);
    document->failed |= !y || !figure->caption || !figure->alt || script(document, figure, result, fit, y) != ROTID_OK;
}
