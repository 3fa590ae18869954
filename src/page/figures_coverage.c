/* How often the intervals of a study hold the truth, cell by cell. */
#include <math.h>
#include <string.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/rows.h"
#include "page/series.h"

#define MOST_DOTS 5 /* parameters */
#define NOMINAL   95.0

struct dot {
    const char *name;          /* of a parameter */
    double percent[ROWS_MOST]; /* of each row, NaN: the cell has no interval of it */
};

struct coverage {
    int rows, ndot;
    const char *name[ROWS_MOST];
    struct dot dot[MOST_DOTS];
    double least, fewest; /* % ; intervals of a cell */
};

static void add_dot(struct coverage *c, const struct cell_parameter *p)
{
    int k = 0;
    while (k < c->ndot && strcmp(c->dot[k].name, p->name) != 0)
        k++;
    if (k == MOST_DOTS)
        return;
    struct dot *dot = &c->dot[k];
    if (k == c->ndot) {
        dot->name = p->name;
        c->ndot++;
        for (int row = 0; row < ROWS_MOST; row++)
            dot->percent[row] = NAN;
    }
    dot->percent[c->rows] = 100 * p->coverage95;
    c->least = fmin(c->least, 100 * p->coverage95);
    c->fewest = fmin(c->fewest, p->intervals);
}

static void collect_coverage(const struct study_outcome *s, struct coverage *c)
{
    *c = (struct coverage){.least = NOMINAL, .fewest = INFINITY};
    for (int i = 0; i < s->is.ncells && c->rows < ROWS_MOST; i++) {
        int any = 0;
        for (int p = 0; p < s->cell[i].is.nparameters; p++)
            if (isfinite(s->cell[i].is.parameters[p].coverage95)) {
                any = 1;
                add_dot(c, &s->cell[i].is.parameters[p]);
            }
        if (any)
            c->name[c->rows++] = s->cell[i].label;
    }
}

/* Its numbers stand in the table of the cells. */
static struct series *series_of(struct document *document, const struct coverage *c)
{
    struct column column[1 + MOST_DOTS] = {{"row from below", NULL, AS_PLACE, 0}};
    for (int k = 0; k < c->ndot; k++)
        column[1 + k] = (struct column){c->dot[k].name, "%", AS_PLACE, 0};
    struct series *series = series_new(document, "coverage", c->rows, 1 + c->ndot, column);
    for (int i = 0; i < c->rows; i++) {
        double row[1 + MOST_DOTS] = {c->rows - i};
        for (int k = 0; k < c->ndot; k++)
            row[1 + k] = c->dot[k].percent[i];
        series_row(series, i, row);
    }
    return series;
}

static void draw(struct plot *plot, const struct series *series, const struct coverage *c)
{
    struct plot_layout layout = rows_layout(c->rows, c->name);
    struct plot_entry entry[MOST_DOTS + 1];
    for (int k = 0; k < c->ndot; k++)
        entry[k] = (struct plot_entry){.text = c->dot[k].name, .style = k + 1, .keys = KEY_MARK};
    entry[c->ndot] = (struct plot_entry){.text = "95 %", .style = 11, .keys = KEY_LINE};
    plot_head(entry, c->ndot + 1, layout.head);
    plot_line(plot, "set style line 11 lc rgb INK lw 1 dt (8,4)");
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, c->ndot + 1);
    double low = fmax(0, 10 * floor((c->least - 5) / 10));
    plot_line(plot, "set xrange [%g:101]\nset xtics %g", low, plot_tic(100 - low, 5));
    rows_draw(plot, c->rows, c->name);
    plot_axes(plot, "coverage [%]", NULL);
    plot_line(plot, "set arrow 1 from first %g, graph 0 to first %g, graph 1 nohead ls 11", NOMINAL, NOMINAL);
    (void)fputs("plot ", plot->out);
    for (int k = 0; k < c->ndot; k++)
        (void)fprintf(plot->out, "%s$coverage using %d:($1-LIFT%+.3g*(1-LIFT)) with points ls %d ps 1", k ? ", " : "", k + 2,
                      -0.7 / c->ndot * (k - 0.5 * (c->ndot - 1)), k + 1);
    (void)fputc('\n', plot->out);
}

void figure_coverage(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct coverage *c = POOL_NEW(pool, struct coverage);
    if (!c) {
        document->failed = 1;
        return;
    }
    collect_coverage(result->studied, c);
    if (c->rows < 2)
        return;
    struct figure *figure = document_figure(document, "coverage", "How often the 95 % intervals hold the truth");
    double luck = 196 * sqrt(0.95 * 0.05 / c->fewest);
    figure->caption =
        pool_format(pool,
                    "The least is %s\xc2\xa0%%. With %.0f intervals in the smallest cell chance alone moves a share by about "
                    "\xc2\xb1%s points; what lies lower shows a model or a noise other than those of the data, what lies "
                    "higher intervals that are too wide.",
                    human_digits(pool, c->least, 3), c->fewest, human_digits(pool, luck, 1));
    figure->alt = pool_format(pool, "For each of %d cells the share of intervals that hold the truth, from %s to 100 %%.",
                              c->rows, human_digits(pool, c->least, 3));
    struct series *series = series_of(document, c);
    struct plot plot;
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, c);
    figure_end(document, &plot);
}
