/* What each parameter does to each mode: Table 1 of the paper as a picture, its Figure 5, and its Figure 3. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_SERIES 10 /* parameters or modes of a picture: as many styles as there are */

static const rotid_reference *reference_of(struct pool *pool, const struct result *result, const char *parameter)
{
    const char *quantity = pool_format(pool, "sensitivity %s", parameter);
    return quantity ? head_reference(&result->head, quantity) : NULL;
}

static struct number_table *sensitivity_table(struct pool *pool, const struct result *result)
{
    const struct sensitivity *s = result->sensitivity;
    struct number_table *table = table_new(pool, s->nfrequency_hz, 2 + 3 * s->nparameters);
    table_head(table, 0, "mode");
    table_head(table, 1, "frequency [Hz]");
    for (int p = 0; p < s->nparameters; p++) {
        const struct sensitivity_parameter *parameter = &s->parameters[p];
        const rotid_reference *reference = reference_of(pool, result, parameter->name);
        table_head(table, 2 + 3 * p,
                   pool_format(pool, "%s, %s\xc2\xa0%% step [1]", parameter->name, human_digits(pool, 100 * s->step, 2)));
        table_head(table, 3 + 3 * p, pool_format(pool, "%s, limit [1]", parameter->name));
        table_head(table, 4 + 3 * p, pool_format(pool, "%s, reference [1]", parameter->name));
        for (int k = 0; k < s->nfrequency_hz; k++) {
            table_cell(table, k, 0, human_fixed(pool, k + 1, 0));
            table_cell(table, k, 1, human_fixed(pool, s->frequency_hz[k], 2));
            table_cell(table, k, 2 + 3 * p, human_digits(pool, parameter->sensitivity[k], 3));
            table_cell(table, k, 3 + 3 * p, human_digits(pool, parameter->derivative[k], 3));
            table_cell(table, k, 4 + 3 * p, human_digits(pool, fabs(reference_value(reference, k)), 3));
        }
    }
    return table;
}

static int sensitivity_script(struct document *document, struct figure *figure, const struct result *result, int count)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    int m = s->nfrequency_hz, referenced = 0;
    struct plot plot;
    struct plot_entry entry[MOST_SERIES + 1];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .height = 300, .left = 62, .right = 12, .top = 10, .bottom = 48};
    double *value = POOL_ARRAY(pool, double, (size_t)m *(2 * (size_t)count + 1));
    const double *data[2 * MOST_SERIES + 1];
    if (!value || plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c <= 2 * count; c++)
        data[c] = value + (ptrdiff_t)c * m;
    for (int k = 0; k < m; k++)
        value[k] = k + 1;
    for (int p = 0; p < count; p++) {
        const rotid_reference *reference = reference_of(pool, result, s->parameters[p].name);
        for (int k = 0; k < m; k++) {
            value[k + (ptrdiff_t)(1 + p) * m] = fabs(s->parameters[p].sensitivity[k]);
            value[k + (ptrdiff_t)(1 + count + p) * m] = fabs(reference_value(reference, k));
        }
        referenced |= reference != NULL;
        entry[p] = (struct plot_entry){.text = s->parameters[p].name, .style = p + 1, .keys = KEY_MARK | KEY_LINE};
    }
    entry[count] = (struct plot_entry){.text = "open: reference in the deck", .style = SERIES + 1, .keys = KEY_MARK};
    plot_head(entry, count + referenced, layout.head);
    plot_line(&plot, "# columns: mode, |sensitivity| to each parameter, then the references");
    plot_data(&plot, "sensitivity", m, 1 + 2 * count, data);
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    struct plot_range range = plot_decades(2 * count * m, value + m, 8);
    plot_decades_axis(&plot, 'y', &range, 8);
    plot_line(&plot, "set xrange [0.7:%g]\nset xtics %d", m + 0.3, 1 + m / 20);
    plot_axes(&plot, "mode of the model [1]", "size of the sensitivity [1]");
    plot_legend(&plot, entry, count + referenced);
    plot_line(
        &plot,
        "plot for [c = 2:%d] $sensitivity using 1:c with linespoints ls c-1, for [c = 2:%d] $sensitivity using 1:(column(c+%d)) "
        "with points ls (c-2)%%5+6 ps 1.1",
        count + 1, count + 1, count);
    return plot_close(&plot);
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
    figure->table = sensitivity_table(pool, result);
    document->failed |= !figure->caption || !figure->alt || sensitivity_script(document, figure, result, count) != ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ curves, Figure 5 */

static int curves_script(struct document *document, struct figure *figure, const struct result *result, int count, int modes)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    int n = s->nrelative_value;
    struct plot plot;
    struct plot_entry entry[MOST_SERIES];
    struct plot_layout layout = {
        .panels = count, .columns = {count < 3 ? count : 3, 1}, .height = 230, .left = 54, .right = 12, .top = 26, .bottom = 48};
    const double *data[MOST_SERIES + 1] = {s->relative_value};
    struct plot_range range = {0, 0};
    if (plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: value over reference, then E_k^2/2 of each mode");
    for (int p = 0; p < count; p++) {
        double *rows = POOL_ARRAY(pool, double, (size_t)modes *(size_t)n);
        char name[32];
        for (int k = 0; k < modes && rows; k++) {
            data[k + 1] = rows + (ptrdiff_t)k * n;
            for (int i = 0; i < n; i++) {
                rows[i + (ptrdiff_t)k * n] = s->parameters[p].curves[k + (ptrdiff_t)i * s->nfrequency_hz];
                plot_range_join(&range, rows[i + (ptrdiff_t)k * n]);
            }
        }
        document->failed |= !rows;
        (void)snprintf(name, sizeof name, "curves%d", p + 1);
        if (rows)
            plot_data(&plot, name, n, modes + 1, data);
    }
    for (int k = 0; k < modes; k++) {
        const char *text = pool_format(pool, "mode %d", k + 1);
        entry[k] = (struct plot_entry){.text = text ? text : "", .style = k + 1, .keys = KEY_LINE};
    }
    plot_head(entry, modes, layout.head);
    range.to = range.to > 0 ? 1.05 * range.to : 1;
    double tic = plot_tic(range.to, 5);
    layout.left = plot_left(&range, tic);
    plot_begin(&plot, &layout);
    for (int p = 0; p < count; p++) {
        plot_panel(&plot, p);
        if (p == 0)
            plot_legend(&plot, entry, modes);
        plot_line(&plot, "set xrange [%.4g:%.4g]\nset yrange [0:%.4g]\nset xtics %g\nset ytics %g", s->relative_value[0],
                  s->relative_value[n - 1], range.to, plot_tic(s->relative_value[n - 1] - s->relative_value[0], 3), tic);
        plot_axes(&plot, "value over reference [1]", "E\xc2\xb2/2 [1]");
        plot_label(&plot, s->parameters[p].name, "graph 0, graph 1 offset 0, char 0.7", "INK", "left");
        plot_line(&plot, "plot for [c = 2:%d] $curves%d using 1:c with lines ls c-1", modes + 1, p + 1);
    }
    return plot_close(&plot);
}

static struct number_table *curves_table(struct pool *pool, const struct sensitivity *s, int count, int modes)
{
    struct number_table *table = table_new(pool, s->nrelative_value, 1 + count * modes);
    table_head(table, 0, "value over reference [1]");
    for (int p = 0; p < count; p++)
        for (int k = 0; k < modes; k++) {
            int column = 1 + p * modes + k;
            table_head(table, column, pool_format(pool, "%s, mode %d [1]", s->parameters[p].name, k + 1));
            for (int i = 0; i < s->nrelative_value; i++) {
                table_cell(table, i, 0, human_trimmed(pool, s->relative_value[i], 4));
                table_cell(table, i, column, human_digits(pool, s->parameters[p].curves[k + (ptrdiff_t)i * s->nfrequency_hz], 3));
            }
        }
    return table;
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
    figure->table = curves_table(pool, s, count, modes);
    document->failed |= !figure->caption || !figure->alt || curves_script(document, figure, result, count, modes) != ROTID_OK;
}
