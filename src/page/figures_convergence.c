/* The worked example of a figure: its numbers as series, caption and alternative text, and the script that draws them. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

enum { OBJECTIVE = 1, GRADIENT, STEP, DAMPING, OTHERS = DAMPING - 1, CURVES = DAMPING }; /* columns, from the first on drawn */
#define MOST_DECADES 18

static const struct column columns[] = {
    {"iteration", NULL, AS_FIXED, 0}, {"objective", "1", AS_DIGITS, 8}, {"gradient", "1", AS_DIGITS, 3},
    {"step", "1", AS_DIGITS, 3},      {"damping", "1", AS_DIGITS, 3},   {"gain ratio", "1", AS_FIXED, 3},
    {"time", "ms", AS_FIXED, 1},
};

static struct series *collect(struct document *document, const rotid_identification *fit)
{
    struct series *series = series_new(document, "iterations", fit->nhistory, (int)(sizeof columns / sizeof *columns), columns);
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_history_entry *now = &fit->history[i];
        series_row(series, i,
                   (const double[]){now->iteration, now->objective, now->gradient, now->step, now->mu, now->gain_ratio,
                                    1e3 * now->seconds});
    }
    return series;
}

/* The last number that a logarithm has. */
static double last_of(int n, const double *value)
{
    while (n > 1 && !(value[n - 1] > 0 && isfinite(value[n - 1])))
        n--;
    return value[n - 1];
}

/* The decades that are drawn. The damping can be smaller by far than all else, and is left out then: *drawn is the number of
 * curves. */
static struct plot_range decades(int n, const double *curves, int *drawn)
{
    struct plot_range others = plot_decades(OTHERS * n, curves, MOST_DECADES),
                      all = plot_decades(CURVES * n, curves, MOST_DECADES),
                      damping = plot_decades(n, curves + (ptrdiff_t)OTHERS * n, MOST_DECADES);
    *drawn = damping.to > others.from ? CURVES : OTHERS;
    return *drawn == CURVES ? all : others;
}

static void draw(struct plot *plot, struct series *series, const rotid_identification *fit, const struct plot_range *range,
                 int drawn)
{
    static const char *const text[] = {"functional", "gradient", "step", "damping \xce\xbc"};
    int n = fit->nhistory, steps = fit->history[n - 1].iteration;
    double height[CURVES];
    plot_begin(plot, &(struct plot_layout){
                         .panels = 1, .columns = {1, 1}, .height = 330, .left = 62, .right = 84, .top = 12, .bottom = 48});
    plot_panel(plot, 0);
    plot_decades_axis(plot, 'y', range, 8);
    plot_line(plot, "set xrange [%g:%g]", fit->history[0].iteration - 0.02 * (steps + 1), steps * 1.02 + 0.02);
    if (steps <= 12)
        plot_line(plot, "set xtics 1");
    plot_axes(plot, "iteration [1]", "value [1]");
    for (int c = 0; c < drawn; c++)
        height[c] = plot_share(range, log10(last_of(n, series_values(series, OBJECTIVE + c))));
    plot_end_labels(plot, drawn, text, height, series_color);
    plot_line(plot, "plot for [c = 2:%d] $iterations using 1:c with linespoints ls c-1 pointinterval %d", drawn + 1, 1 + n / 25);
}

void figure_convergence(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    if (fit->nhistory < 2)
        return;
    struct figure *figure =
        document_figure(document, "convergence", "Functional, gradient, damping and step over the iterations");
    const rotid_history_entry *first = &fit->history[0], *last = &fit->history[fit->nhistory - 1];
    struct series *series = collect(document, fit);
    struct plot plot;
    int drawn;
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    struct plot_range range = decades(fit->nhistory, series_values(series, OBJECTIVE), &drawn);
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
    figure->table = series_table(series);
    plot_series(&plot, series);
    draw(&plot, series, fit, &range, drawn);
    figure_end(document, &plot);
}
