/* Cells of a study as rows: what share of the intervals holds the truth, and what the verdicts are. */
#include <math.h>
#include <string.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_ROWS  24
#define WIDE_ROW   26.0
#define TALL_ROW   40.0 /* where the names stand over them */
#define NAMES_PX   240.0
#define EDGE_PX    14.0
#define MOST_DOTS  5
#define NOMINAL    95.0
#define LEAST_WIDE 0.09 /* of a bar, for a number in it */

/* ------------------------------------------------------------------------------------------------ what rows have in common */

static double row_height(int layout, int rows)
{
    return 12 + (layout == WIDE ? WIDE_ROW : TALL_ROW) * rows + 50;
}

static struct plot_layout rows_layout(int rows)
{
    return (struct plot_layout){.panels = 1,
                                .columns = {1, 1},
                                .height = row_height(WIDE, rows),
                                .narrow_height = row_height(NARROW, rows),
                                .left = NAMES_PX,
                                .right = 24,
                                .top = 12,
                                .bottom = 50};
}

static const char *fitting(struct plot *plot, const char *text, double room)
{
    size_t length = strlen(text);
    char *cut = pool_copy_text(plot->pool, text);
    if (!cut || plot_width(text) <= room)
        return text;
    while (length > 1 && plot_width(cut) > room - 12) {
        do
            length--;
        while (length > 1 && ((unsigned char)cut[length] & 0xc0) == 0x80); /* not within a character */
        cut[length] = 0;
    }
    const char *marked = pool_format(plot->pool, "%s\xe2\x80\xa6", cut);
    return marked ? marked : text;
}

/* Names of the rows, beside them or on a phone over them; LIFT: how far what is drawn lies under the middle of a row. */
static void draw_names(struct plot *plot, int rows, const char *const name[])
{
    plot_line(plot,
              "LIFT = narrow ? 0.2 : 0\nif (narrow) { set lmargin at screen %g/W }\nset yrange [0.4:%g]\nunset ytics\n"
              "set border 1",
              EDGE_PX, rows + 0.5);
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(plot, l == WIDE ? "if (!narrow) {" : "} else {");
        for (int i = 0; i < rows; i++) {
            char where[64];
            (void)snprintf(where, sizeof where, l == WIDE ? "graph 0, first %d" : "graph 0, first %d+0.26", rows - i);
            plot_label(plot, fitting(plot, name[i], l == WIDE ? NAMES_PX - 16 : NARROW_PX - 2 * EDGE_PX), where, "INK",
                       l == WIDE ? "right offset char -0.7, 0" : "left");
        }
    }
    plot_line(plot, "}");
}

/* ---------------------------------------------------------------------------------------------------------------- coverage */

struct dot {
    const char *name; /* of a parameter */
    int count;
    double row[MOST_ROWS], percent[MOST_ROWS], intervals[MOST_ROWS];
};

struct coverage {
    int rows, ndot;
    const char *name[MOST_ROWS];
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
    }
    dot->row[dot->count] = c->rows; /* from the top, turned round when it is drawn */
    dot->percent[dot->count] = 100 * p->coverage;
    dot->intervals[dot->count++] = p->intervals;
    c->least = fmin(c->least, 100 * p->coverage);
    c->fewest = fmin(c->fewest, p->intervals);
}

static void collect_coverage(const struct study_outcome *s, struct coverage *c)
{
    *c = (struct coverage){.least = NOMINAL, .fewest = INFINITY};
    for (int i = 0; i < s->ncell && c->rows < MOST_ROWS; i++) {
        int any = 0;
        for (int p = 0; p < s->cell[i].nparameter; p++)
            if (isfinite(s->cell[i].parameter[p].coverage)) {
                any = 1;
                add_dot(c, &s->cell[i].parameter[p]);
            }
        if (any)
            c->name[c->rows++] = s->cell[i].label;
    }
}

static int coverage_script(struct document *document, struct figure *figure, const struct result *result, struct coverage *c)
{
    struct plot_layout layout = rows_layout(c->rows);
    struct plot_entry entry[MOST_DOTS + 1];
    struct plot plot;
    for (int k = 0; k < c->ndot; k++)
        entry[k] = (struct plot_entry){.text = c->dot[k].name, .style = k + 1, .keys = KEY_MARK};
    entry[c->ndot] = (struct plot_entry){.text = "95 %", .style = 11, .keys = KEY_LINE};
    plot_head(entry, c->ndot + 1, layout.head);
    if (plot_open(&plot, document->pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "set style line 11 lc rgb INK lw 1 dt (8,4)\n# columns: intervals that hold the truth [%%], row from below");
    for (int k = 0; k < c->ndot; k++) {
        char name[32];
        struct dot *dot = &c->dot[k];
        for (int i = 0; i < dot->count; i++)
            dot->row[i] = c->rows - dot->row[i];
        (void)snprintf(name, sizeof name, "coverage%d", k + 1);
        plot_data(&plot, name, dot->count, 2, (const double *const[]){dot->percent, dot->row});
    }
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, c->ndot + 1);
    double low = fmax(0, 10 * floor((c->least - 5) / 10));
    plot_line(&plot, "set xrange [%g:101]\nset xtics %g", low, plot_tic(100 - low, 5));
    draw_names(&plot, c->rows, c->name);
    plot_axes(&plot, "intervals that hold the truth [%]", NULL);
    plot_line(&plot, "set arrow 1 from first %g, graph 0 to first %g, graph 1 nohead ls 11", NOMINAL, NOMINAL);
    (void)fputs("plot ", plot.out);
    for (int k = 0; k < c->ndot; k++)
        (void)fprintf(plot.out, "%s$coverage%d using 1:($2-LIFT%+.3g*(1-LIFT)) with points ls %d ps 1", k ? ", " : "", k + 1,
                      -0.7 / c->ndot * (k - 0.5 * (c->ndot - 1)), k + 1);
    (void)fputc('\n', plot.out);
    return plot_close(&plot);
}

void figure_coverage(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct coverage *c = POOL_NEW(pool, struct coverage);
    if (!c) {
        document->failed = 1;
        return;
    }
    collect_coverage(result->study, c);
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
    /* its numbers: the table of the cells */
    document->failed |= !figure->caption || !figure->alt || coverage_script(document, figure, result, c) != ROTID_OK;
}

/* ---------------------------------------------------------------------------------------------------------------- verdicts */

struct part {
    const char *text, *says, *color; /* in the legend, in a sentence */
    int which;                       /* of told_score_text or told_verdict_text */
};

/* Best first, so that bars are compared from the left. */
static const struct part score_parts[] = {
    {"right", "right", "GREEN", 2},
    {"quiet: nothing was hidden, nothing found", "rightly quiet", "LEAF", 0},
    {"in the set that cannot be told apart", "in the set that cannot be told apart", "BLUE", 3},
    {"in another set", "in another set", "OCHRE", 4},
    {"silent: judged adequate", "silent", "STEEL", 5},
    {"unexplained", "unexplained", "PURPLE", 6},
    {"wrong", "wrong", "VERMILION", 7},
    {"false alarm", "false alarms", "ROSE", 1}};
static const struct part verdict_parts[] = {{"adequate", "adequate", "GREEN", 0},
                                            {"named", "named", "BLUE", 1},
                                            {"ambiguous", "ambiguous", "OCHRE", 2},
                                            {"unexplained", "unexplained", "PURPLE", 3}};

struct verdicts {
    int rows, nshown, scored;
    const struct part *part;
    int shown[TOLD_SCORES]; /* parts that occur */
    const struct told_cell *cell[MOST_ROWS];
};

static double part_of(const struct verdicts *v, const struct told_cell *cell, int shown)
{
    int which = v->part[v->shown[shown]].which;
    return v->scored ? cell->score[which] : cell->verdict[which];
}

static void collect_verdicts(const struct study_outcome *s, struct verdicts *v)
{
    *v = (struct verdicts){.scored = 1};
    for (int i = 0; i < s->ncell && v->rows < MOST_ROWS; i++)
        if (s->cell[i].judged > 0) {
            v->cell[v->rows++] = &s->cell[i];
            v->scored &= s->cell[i].scored;
        }
    v->part = v->scored ? score_parts : verdict_parts;
    for (int k = 0; k < (v->scored ? TOLD_SCORES : TOLD_VERDICTS); k++) {
        double sum = 0;
        v->shown[v->nshown] = k;
        for (int i = 0; i < v->rows; i++)
            sum += part_of(v, v->cell[i], v->nshown);
        v->nshown += sum > 0;
    }
}

static int is_face(const char *color) /* light: numbers on it in INK */
{
    return !strcmp(color, "LEAF") || !strcmp(color, "STEEL") || !strcmp(color, "ROSE");
}

static void draw_verdicts(struct plot *plot, const struct verdicts *v)
{
    int object = 0;
    for (int i = 0; i < v->rows; i++) {
        double from = 0;
        for (int k = 0; k < v->nshown; k++) {
            const struct part *part = &v->part[v->shown[k]];
            double share = 100 * part_of(v, v->cell[i], k) / v->cell[i]->judged;
            char where[64];
            if (!(share > 0))
                continue;
            plot_line(plot,
                      "set object %d rectangle from %.6g,%d-LIFT-0.3 to %.6g,%d-LIFT+0.3 fs solid border lc rgb MUTED fc rgb %s",
                      ++object, from, v->rows - i, from + share, v->rows - i, part->color);
            (void)snprintf(where, sizeof where, "first %.6g, first %d-LIFT", from + share / 2, v->rows - i);
            if (share > 100 * LEAST_WIDE)
                plot_label(plot, human_fixed(plot->pool, part_of(v, v->cell[i], k), 0), where,
                           is_face(part->color) ? "INK" : "PAPER", "center");
            from += share;
        }
    }
}

static int verdicts_script(struct document *document, struct figure *figure, const struct result *result,
                           const struct verdicts *v)
{
    struct plot_layout layout = rows_layout(v->rows);
    struct plot_entry entry[TOLD_SCORES];
    const char *name[MOST_ROWS] = {NULL};
    struct plot plot;
    for (int k = 0; k < v->nshown; k++)
        entry[k] = (struct plot_entry){.text = v->part[v->shown[k]].text, .keys = KEY_FACE, .face = v->part[v->shown[k]].color};
    plot_head(entry, v->nshown, layout.head);
    if (plot_open(&plot, document->pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    (void)fputs("# rows from below; columns:", plot.out);
    for (int k = 0; k < v->nshown; k++)
        (void)fprintf(plot.out, " %s,", v->part[v->shown[k]].text);
    (void)fputs(" runs\n$verdicts << end\n", plot.out);
    for (int i = v->rows - 1; i >= 0; i--) {
        for (int k = 0; k < v->nshown; k++)
            (void)fprintf(plot.out, "%.0f ", part_of(v, v->cell[i], k));
        (void)fprintf(plot.out, "%.0f\n", v->cell[i]->judged);
    }
    (void)fputs("end\n", plot.out);
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, v->nshown);
    plot_line(&plot, "set xrange [0:100]\nset xtics 20");
    for (int i = 0; i < v->rows; i++)
        name[i] = *v->cell[i]->label ? v->cell[i]->label : "all runs";
    draw_names(&plot, v->rows, name);
    plot_axes(&plot, "share of the runs [%]", NULL);
    draw_verdicts(&plot, v);
    plot_line(&plot, "plot NaN");
    return plot_close(&plot);
}

static struct number_table *verdicts_table(struct pool *pool, const struct verdicts *v)
{
    struct number_table *table = table_new(pool, v->rows, 2 + v->nshown);
    table_head(table, 0, "cell");
    table_head(table, 1, "runs");
    for (int k = 0; k < v->nshown; k++)
        table_head(table, 2 + k, v->part[v->shown[k]].text);
    for (int i = 0; i < v->rows; i++) {
        table_cell(table, i, 0, *v->cell[i]->label ? v->cell[i]->label : "all runs");
        table_cell(table, i, 1, human_fixed(pool, v->cell[i]->judged, 0));
        for (int k = 0; k < v->nshown; k++)
            table_cell(table, i, 2 + k, human_fixed(pool, part_of(v, v->cell[i], k), 0));
    }
    return table;
}

void figure_verdicts(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct verdicts v;
    const char *says = "";
    double runs = 0;
    collect_verdicts(result->study, &v);
    if (!v.rows || !v.nshown)
        return;
    struct figure *figure = document_figure(document, "verdicts", v.scored ? "Verdicts beside what was hidden" : "Verdicts");
    for (int i = 0; i < v.rows; i++)
        runs += v.cell[i]->judged;
    for (int k = 0; k < v.nshown && says; k++) {
        double sum = 0;
        for (int i = 0; i < v.rows; i++)
            sum += part_of(&v, v.cell[i], k);
        says = pool_format(pool, "%s%s%.0f %s", says, k ? ", " : "", sum, v.part[v.shown[k]].says);
    }
    figure->caption = pool_format(pool, "Of %.0f diagnoses: %s. Numbers in the bars are runs.", runs, says ? says : "");
    figure->alt =
        pool_format(pool, "A bar for each of %d cells, divided by verdicts. Of all runs: %s.", v.rows, says ? says : "");
    figure->table = verdicts_table(pool, &v);
    document->failed |= !says || !figure->caption || !figure->alt || verdicts_script(document, figure, result, &v) != ROTID_OK;
}
