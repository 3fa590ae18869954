#include "page/matrix.h"

#include <math.h>

#include "page/human.h"
#include "page/palette.h"

#define NUMBER_PX  27.0 /* of a cell that has room for "0.99" */
#define LEFT_PX    56.0
#define MOST_CELL  46.0
#define LEAST_CELL 22.0

static int most_columns(int count, const struct matrix_panel *panel)
{
    int most = 1;
    for (int i = 0; i < count; i++)
        most = panel[i].columns > most ? panel[i].columns : most;
    return most;
}

static double longest_name(int count, const struct matrix_panel *panel)
{
    double width = 0;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < panel[i].rows; r++)
            width = fmax(width, plot_width(panel[i].row[r]));
    return width;
}

/* Ticks in the middle of rows or columns, thinned where they would touch. */
static void ticks(struct plot *plot, const char *axis, int count, const char *const *name, double room)
{
    int every = (int)ceil(20 / room), k = 0;
    (void)fprintf(plot->out, "set %stics scale 0 (", axis);
    for (int i = 0; i<count; i += every> 1 ? every : 1)
        (void)fprintf(plot->out, "%s%s %d", k++ ? ", " : "", plot_quote_tick(plot, name[i]), i + 1);
    (void)fputs(")\n", plot->out);
}

static void draw(struct plot *plot, const struct matrix_panel *panel, double cell_px)
{
    int object = 0;
    plot_line(plot, "unset grid; set border 0\nset xrange [0.5:%g]\nset yrange [%g:0.5]", panel->columns + 0.5,
              panel->rows + 0.5);
    ticks(plot, "x", panel->columns, panel->column, cell_px);
    ticks(plot, "y", panel->rows, panel->row, LEAST_CELL);
    for (int i = 0; i < panel->rows; i++)
        for (int j = 0; j < panel->columns; j++) {
            double value = panel->value[i + (ptrdiff_t)j * panel->rows];
            if (isfinite(value))
                plot_line(plot, "set object %d rectangle from %g,%g to %g,%g fs solid noborder fc rgb %s", ++object, j + 0.52,
                          i + 0.52, j + 1.48, i + 1.48, palette_ramp(fabs(value)));
        }
    for (int i = 0; i < panel->rows && panel->mark; i++)
        if (panel->mark[i] >= 0)
            plot_line(plot, "set object %d rectangle from %g,%g to %g,%g fs empty border lc rgb VERMILION lw 1.5", ++object,
                      panel->mark[i] + 0.52, i + 0.52, panel->mark[i] + 1.48, i + 1.48);
}

/* The numbers, once the cells are wide enough for them. */
static void numbers(struct plot *plot, const struct matrix_panel *panel)
{
    for (int i = 0; i < panel->rows; i++)
        for (int j = 0; j < panel->columns; j++) {
            double value = panel->value[i + (ptrdiff_t)j * panel->rows];
            char where[32];
            (void)snprintf(where, sizeof where, "%d,%d", j + 1, i + 1);
            if (isfinite(value))
                plot_label(plot, human_fixed(plot->pool, value, 2), where, palette_on_ramp(fabs(value)), "center");
        }
}

/* Rows of the matrix, headed by their names and, of several matrices, by its title. */
static struct series *collect(struct document *document, int count, const struct matrix_panel *panel, int i)
{
    const struct matrix_panel *m = &panel[i];
    struct pool *pool = document->pool;
    struct column *column = POOL_ARRAY(pool, struct column, m->columns + 1);
    double *row = POOL_ARRAY(pool, double, m->columns);
    if (!column || !row) {
        document->failed = 1;
        return NULL;
    }
    column[0] = (struct column){count > 1 ? "matrix and row" : m->row_axis ? m->row_axis : "", NULL, AS_TEXT, 0};
    for (int j = 0; j < m->columns; j++)
        column[j + 1] = (struct column){m->column[j], NULL, AS_FIXED, 3};
    struct series *series = series_new(document, pool_format(pool, "matrix%d", i + 1), m->rows, m->columns + 1, column);
    for (int r = 0; r < m->rows; r++) {
        for (int j = 0; j < m->columns; j++)
            row[j] = m->value[r + (ptrdiff_t)j * m->rows];
        series_row(series, r, row);
        series_text(series, r, 0, count > 1 ? pool_format(pool, "%s, %s", m->title, m->row[r]) : m->row[r]);
    }
    return series;
}

void matrix_figure(struct document *document, struct figure *figure, const char *source, int count,
                   const struct matrix_panel *panel)
{
    struct plot plot;
    int columns = most_columns(count, panel), rows = 1;
    double left = LEFT_PX + fmax(longest_name(count, panel) - 16, 0);
    const struct series *series[MATRIX_MOST] = {NULL};
    for (int i = 0; i < count; i++) {
        rows = panel[i].rows > rows ? panel[i].rows : rows;
        series[i] = collect(document, count, panel, i);
    }
    figure->table = series_table_of(count, series);
    int beside = count > 1 && (WIDE_PX / 2.0 - left - 10) / columns >= NUMBER_PX ? 2 : 1;
    double wide = fmin((WIDE_PX / (double)beside - left - 10) / columns, MOST_CELL),
           narrow = fmin((NARROW_PX - left - 10) / columns, MOST_CELL), height = fmin(fmax(narrow, LEAST_CELL), 34);
    if (!figure_begin(document, figure, source, &plot))
        return;
    for (int i = 0; i < count; i++)
        plot_series(&plot, series[i]);
    plot_begin(&plot, &(struct plot_layout){.panels = count,
                                            .columns = {beside, 1},
                                            .height = 78 + height * rows,
                                            .left = left,
                                            .right = 10,
                                            .top = 28,
                                            .bottom = 50});
    for (int i = 0; i < count; i++) {
        plot_panel(&plot, i);
        /* cells that are no wider than they need be */
        plot_line(&plot, "set rmargin at screen (x_of(%d)+LEFT+%d*(narrow ? %g : %g))/W", i, panel[i].columns, narrow, wide);
        plot_axes(&plot, panel[i].column_axis, panel[i].row_axis);
        plot_label(&plot, panel[i].title, "graph 0, graph 1 offset 0, char 0.8", "INK", "left");
        draw(&plot, &panel[i], narrow);
        if (narrow >= NUMBER_PX)
            numbers(&plot, &panel[i]);
        else if (wide >= NUMBER_PX) {
            plot_line(&plot, "if (!narrow) {");
            numbers(&plot, &panel[i]);
            plot_line(&plot, "}");
        }
        plot_line(&plot, "plot NaN");
    }
    figure_end(document, &plot);
}
