/* Verdicts of the diagnoses of a study, cell by cell. */
#include <math.h>
#include <string.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/rows.h"
#include "page/series.h"
#include "study/summary.h"

#define LEAST_WIDE 0.09 /* of a bar, for a number in it */

struct part {
    const char *text, *says, *color; /* in the legend, in a sentence */
    int which;                       /* of score_words or verdict_words */
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
    int shown[STUDY_SCORES]; /* parts that occur */
    const struct told_cell *cell[ROWS_MOST];
};

static double part_of(const struct verdicts *v, const struct told_cell *cell, int shown)
{
    int which = v->part[v->shown[shown]].which;
    return v->scored ? cell->is.diagnoses->scores[which] : cell->is.diagnoses->verdicts[which];
}

static void collect_verdicts(const struct study_outcome *s, struct verdicts *v)
{
    *v = (struct verdicts){.scored = 1};
    for (int i = 0; i < s->is.ncells && v->rows < ROWS_MOST; i++)
        if (s->cell[i].is.diagnoses) {
            v->cell[v->rows++] = &s->cell[i];
            v->scored &= summary_is_scored(&s->cell[i].is);
        }
    v->part = v->scored ? score_parts : verdict_parts;
    for (int k = 0; k < (v->scored ? STUDY_SCORES : STUDY_VERDICTS); k++) {
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

static void draw_bars(struct plot *plot, const struct verdicts *v)
{
    int object = 0;
    for (int i = 0; i < v->rows; i++) {
        double from = 0;
        for (int k = 0; k < v->nshown; k++) {
            const struct part *part = &v->part[v->shown[k]];
            double share = 100 * part_of(v, v->cell[i], k) / v->cell[i]->is.diagnoses->count;
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

static const char *label_of(const struct told_cell *cell)
{
    return *cell->label ? cell->label : "all runs";
}

static struct series *series_of(struct document *document, const struct verdicts *v)
{
    struct column column[2 + STUDY_SCORES] = {{"cell", NULL, AS_TEXT, 0}, {"runs", NULL, AS_FIXED, 0}};
    for (int k = 0; k < v->nshown; k++)
        column[2 + k] = (struct column){v->part[v->shown[k]].text, NULL, AS_FIXED, 0};
    struct series *series = series_new(document, "verdicts", v->rows, 2 + v->nshown, column);
    for (int i = 0; i < v->rows; i++) {
        double row[1 + STUDY_SCORES] = {v->cell[i]->is.diagnoses->count};
        for (int k = 0; k < v->nshown; k++)
            row[1 + k] = part_of(v, v->cell[i], k);
        series_row(series, i, row);
        series_text(series, i, 0, label_of(v->cell[i]));
    }
    return series;
}

static void draw(struct plot *plot, const struct series *series, const struct verdicts *v)
{
    struct plot_entry entry[STUDY_SCORES];
    const char *name[ROWS_MOST] = {NULL};
    for (int i = 0; i < v->rows; i++)
        name[i] = label_of(v->cell[i]);
    struct plot_layout layout = rows_layout(v->rows, name);
    for (int k = 0; k < v->nshown; k++)
        entry[k] = (struct plot_entry){.text = v->part[v->shown[k]].text, .keys = KEY_FACE, .face = v->part[v->shown[k]].color};
    plot_head(entry, v->nshown, layout.head);
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, v->nshown);
    plot_line(plot, "set xrange [0:100]\nset xtics 20");
    rows_draw(plot, v->rows, name);
    plot_axes(plot, "share of the runs [%]", NULL);
    draw_bars(plot, v);
    plot_line(plot, "plot NaN");
}

void figure_verdicts(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct verdicts v;
    const char *says = "";
    double runs = 0;
    collect_verdicts(result->studied, &v);
    if (!v.rows || !v.nshown)
        return;
    struct figure *figure = document_figure(document, "verdicts", v.scored ? "Verdicts beside what was hidden" : "Verdicts");
    for (int i = 0; i < v.rows; i++)
        runs += v.cell[i]->is.diagnoses->count;
    for (int k = 0; k < v.nshown && says; k++) {
        double sum = 0;
        for (int i = 0; i < v.rows; i++)
            sum += part_of(&v, v.cell[i], k);
        says = pool_format(pool, "%s%s%.0f %s", says, k ? ", " : "", sum, v.part[v.shown[k]].says);
    }
    figure->caption = pool_format(pool, "Of %.0f diagnoses: %s. Numbers in the bars are runs.", runs, says ? says : "");
    figure->alt =
        pool_format(pool, "A bar for each of %d cells, divided by verdicts. Of all runs: %s.", v.rows, says ? says : "");
    document->failed |= !says;
    struct series *series = series_of(document, &v);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, &v);
    figure_end(document, &plot);
}
