/* What each parameter does to each mode: Table 1 of the paper as a picture, its Figure 5, and its Figure 3. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

#define MOST_SERIES 10 /* parameters or modes of a picture: as many styles as there are */

static const rotid_reference *reference_of(struct pool *pool, const struct result *result, const char *parameter)
{
    const char *quantity = pool_format(pool, "sensitivity %s", parameter);
    return quantity ? head_reference(&result->head, quantity) : NULL;
}

enum { MODE, FREQUENCY, FIRST, STEP = 0, LIMIT, REFERENCE, EACH }; /* columns: the first, then as many of each parameter */

static struct series *collect(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    int columns = FIRST + EACH * s->nparameters;
    struct column *column = POOL_ARRAY(pool, struct column, columns);
    double *row = POOL_ARRAY(pool, double, columns);
    if (!column || !row) {
        document->failed = 1;
        return NULL;
    }
    column[MODE] = (struct column){"mode", NULL, AS_FIXED, 0};
    column[FREQUENCY] = (struct column){"frequency", "Hz", AS_FIXED, 2};
    for (int p = 0; p < s->nparameters; p++) {
        const char *name = s->parameters[p].name;
        struct column *its = &column[FIRST + EACH * p];
        its[STEP] = (struct column){pool_format(pool, "%s, %s\xc2\xa0%% step", name, human_digits(pool, 100 * s->step, 2)), "1",
                                    AS_DIGITS, 3};
        its[LIMIT] = (struct column){pool_format(pool, "%s, limit", name), "1", AS_DIGITS, 3};
        its[REFERENCE] = (struct column){pool_format(pool, "%s, reference", name), "1", AS_DIGITS, 3};
    }
    struct series *series = series_new(document, "sensitivity", s->nfrequency_hz, columns, column);
    for (int k = 0; k < s->nfrequency_hz; k++) {
        row[MODE] = k + 1;
        row[FREQUENCY] = s->frequency_hz[k];
        for (int p = 0; p < s->nparameters; p++) {
            double *its = &row[FIRST + EACH * p];
            its[STEP] = s->parameters[p].sensitivity[k];
            its[LIMIT] = s->parameters[p].derivative[k];
            its[REFERENCE] = fabs(reference_value(reference_of(pool, result, s->parameters[p].name), k));
        }
        series_row(series, k, row);
    }
    return series;
}

/* Sizes of the sensitivities and of the references, of the first parameters. */
static void draw(struct plot *plot, struct series *series, const struct result *result, int count)
{
    const struct sensitivity *s = result->sensitivity;
    int m = s->nfrequency_hz, referenced = 0;
    struct plot_entry entry[MOST_SERIES + 1];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 300, .left = 62, .right = 12, .top = 10, .bottom = 48};
    double least = INFINITY, most = 0;
    for (int p = 0; p < count; p++) {
        for (int c = STEP; c <= REFERENCE; c += REFERENCE - STEP)
            for (int k = 0; k < m; k++) {
                double size = fabs(series_values(series, FIRST + EACH * p + c)[k]);
                least = size > 0 ? fmin(least, size) : least;
                most = fmax(most, size);
            }
        referenced |= reference_of(plot->pool, result, s->parameters[p].name) != NULL;
        entry[p] = (struct plot_entry){.text = s->parameters[p].name, .style = p + 1, .keys = KEY_MARK | KEY_LINE};
    }
    entry[count] = (struct plot_entry){.text = "open: reference in the deck", .style = SERIES + 1, .keys = KEY_MARK};
    plot_head(entry, count + referenced, layout.head);
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    struct plot_range range = plot_decades(2, (const double[]){least, most}, 8);
    plot_decades_axis(plot, 'y', &range, 8);
    plot_line(plot, "set xrange [0.7:%g]\nset xtics %d", m + 0.3, 1 + m / 20);
    plot_axes(plot, "mode of the model [1]", "size of the sensitivity [1]");
    plot_legend(plot, entry, count + referenced);
    plot_line(plot,
              "plot for [p = 0:%d] $sensitivity using 1:(abs(column(%d+%d*p))) with linespoints ls p+1, \\\n"
              "    for [p = 0:%d] $sensitivity using 1:(abs(column(%d+%d*p))) with points ls p%%5+6 ps 1.1",
              count - 1, FIRST + STEP + 1, EACH, count - 1, FIRST + REFERENCE + 1, EACH);
}

/* Largest |sensitivity| of a parameter. */
static double strongest(const struct sensitivity *s, int p)
{
    double most = 0;
    for (int k = 0; k < s->nfrequency_hz; k++)
        most = fmax(most, fabs(s->parameters[p].sensitivity[k]));
    return most;
}

void figure_sensitivity(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    int count = s->nparameters < MOST_SERIES ? s->nparameters : MOST_SERIES, most = 0, least = 0;
    if (!count || !s->nfrequency_hz)
        return;
    for (int p = 1; p < count; p++) {
        most = strongest(s, p) > strongest(s, most) ? p : most;
        least = strongest(s, p) < strongest(s, least) ? p : least;
    }
    struct figure *figure = document_figure(document, "sensitivity", "How far each mode depends on each parameter");
    const char *weak = most != least ? pool_format(pool, ", %s does least (%s at most)", s->parameters[least].name,
                                                   human_digits(pool, strongest(s, least), 2))
                                     : "";
    figure->caption = pool_format(pool,
                                  "Change of E = 1 \xe2\x88\x92 \xcf\x89\xc2\xb2(x)/\xcf\x89\xc2\xb2(x\xe2\x82\x80) over the "
                                  "relative change of a parameter, "
                                  "in steps of %s\xc2\xa0%%: %s does most (%s at most)%s.",
                                  human_digits(pool, 100 * s->step, 2), s->parameters[most].name,
                                  human_digits(pool, strongest(s, most), 2), weak ? weak : "");
    figure->alt = pool_format(pool, "%d %s over %d modes on a logarithmic scale.", count, human_plural(count, "curve", "curves"),
                              s->nfrequency_hz);
    struct series *series = collect(document, result);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, result, count);
    figure_end(document, &plot);
}

/* ------------------------------------------------------------------------------------------------ curves, Figure 5 */

/* Side by side, parameter by parameter. */
static struct series *collect_curves(struct document *document, const struct sensitivity *s, int count, int modes)
{
    struct column column[1 + MOST_SERIES * MOST_SERIES] = {{"value over reference", "1", AS_TRIMMED, 4}};
    double row[1 + MOST_SERIES * MOST_SERIES];
    for (int c = 0; c < count * modes; c++)
        column[1 + c] = (struct column){pool_format(document->pool, "%s, mode %d", s->parameters[c / modes].name, c % modes + 1),
                                        "1", AS_DIGITS, 3};
    struct series *series = series_new(document, "curves", s->nrelative_value, 1 + count * modes, column);
    for (int i = 0; i < s->nrelative_value; i++) {
        row[0] = s->relative_value[i];
        for (int c = 0; c < count * modes; c++)
            row[1 + c] = s->parameters[c / modes].curves[c % modes + (ptrdiff_t)i * s->nfrequency_hz];
        series_row(series, i, row);
    }
    return series;
}

static void draw_curves(struct plot *plot, struct series *series, const struct sensitivity *s, int count, int modes)
{
    int n = s->nrelative_value;
    struct plot_entry entry[MOST_SERIES];
    struct plot_layout layout = {
        .panels = count, .columns = {count < 3 ? count : 3, 1}, .height = 230, .left = 54, .right = 12, .top = 26, .bottom = 48};
    struct plot_range range = {0, 0};
    plot_series(plot, series);
    for (int i = 0; i < count * modes * n; i++)
        plot_range_join(&range, series_values(series, 1)[i]);
    for (int k = 0; k < modes; k++) {
        const char *text = pool_format(plot->pool, "mode %d", k + 1);
        entry[k] = (struct plot_entry){.text = text ? text : "", .style = k + 1, .keys = KEY_LINE};
    }
    plot_head(entry, modes, layout.head);
    range.to = range.to > 0 ? 1.05 * range.to : 1;
    double tic = plot_tic(range.to, 5);
    layout.left = plot_left(&range, tic);
    double more = 0;
    for (int p = 0; p < count; p++)
        more = fmax(more, plot_lines_px(1, &s->parameters[p].name, plot_panel_px(&layout)));
    layout.top += more;
    layout.height += more;
    plot_begin(plot, &layout);
    for (int p = 0; p < count; p++) {
        plot_panel(plot, p);
        if (p == 0)
            plot_legend(plot, entry, modes);
        plot_line(plot, "set xrange [%.4g:%.4g]\nset yrange [0:%.4g]\nset xtics %g\nset ytics %g", s->relative_value[0],
                  s->relative_value[n - 1], range.to, plot_tic(s->relative_value[n - 1] - s->relative_value[0], 3), tic);
        plot_axes(plot, "value over reference [1]", "E\xc2\xb2/2 [1]");
        plot_label_over(plot, s->parameters[p].name, plot_panel_px(&layout), "graph 0, graph 1", 0.7, "INK");
        plot_line(plot, "plot for [k = 1:%d] $curves using 1:(column(%d+k)) with lines ls k", modes, 1 + p * modes);
    }
}

void figure_sensitivity_curves(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    int count = s->nparameters < MOST_SERIES - 1 ? s->nparameters : MOST_SERIES - 1,
        modes = s->nfrequency_hz < MOST_SERIES ? s->nfrequency_hz : MOST_SERIES;
    const char *says = "";
    if (!count || !modes || s->nrelative_value < 2)
        return;
    for (int p = 0; p < count && says; p++) {
        double most = 0;
        int mode = 0;
        for (int i = 0; i < s->nfrequency_hz * s->nrelative_value; i++)
            if (s->parameters[p].curves[i] > most) {
                most = s->parameters[p].curves[i];
                mode = i % s->nfrequency_hz + 1;
            }
        says = pool_format(pool, "%s%s%s reaches %s in mode %d", says, p ? ", " : "", s->parameters[p].name,
                           human_digits(pool, most, 2), mode);
    }
    struct figure *figure = document_figure(document, "sensitivity-curves", "How the functional grows away from the reference");
    figure->caption =
        pool_format(pool, "Share of each mode in the functional where one parameter goes from %s to %s of its reference: %s.",
                    human_trimmed(pool, s->relative_value[0], 3),
                    human_trimmed(pool, s->relative_value[s->nrelative_value - 1], 3), says ? says : "");
    figure->alt = pool_format(
        pool, "%d panels, one a parameter, on one scale: %d curves that are zero at the reference and rise to both sides.", count,
        modes);
    struct series *series = collect_curves(document, s, count, modes);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw_curves(&plot, series, s, count, modes);
    figure_end(document, &plot);
}
