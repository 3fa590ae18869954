/* Many decks beside each other, each identified once: a parameter with its interval in every deck. */
#include <math.h>
#include <string.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/rows.h"
#include "page/series.h"

#define LEAST 3

struct deck_row {
    const char *name;
    double value, ci[2];
};

struct decks {
    const struct cell_parameter *parameter;
    struct human_unit unit;
    int count, hidden;
    struct deck_row row[ROWS_MOST];
};

/* The parameter that most decks have, -1 of cells that are no decks side by side. */
static const char *commonest(const struct study_outcome *s)
{
    const char *best = NULL;
    int most = 0;
    for (int i = 0; i < s->is.ncells; i++) {
        const struct told_cell *cell = &s->cell[i];
        if (cell->is.cell.variant || cell->is.cell.modes || cell->is.cell.sensors || cell->is.cell.hide || cell->is.runs > 1)
            return NULL;
        for (int p = 0; p < cell->is.nparameters; p++) {
            int count = 0;
            for (int k = 0; k < s->is.ncells; k++)
                for (int q = 0; q < s->cell[k].is.nparameters; q++)
                    count += !strcmp(s->cell[k].is.parameters[q].name, cell->is.parameters[p].name);
            if (count > most) {
                most = count;
                best = cell->is.parameters[p].name;
            }
        }
    }
    return most >= LEAST ? best : NULL;
}

static void collect(const struct study_outcome *s, const char *name, struct decks *decks)
{
    *decks = (struct decks){0};
    for (int i = 0; i < s->nrun; i++) {
        const struct told_run *run = &s->run[i];
        const struct told_cell *cell = &s->cell[run->cell];
        for (int p = 0; p < cell->is.nparameters && run->value; p++) {
            if (strcmp(cell->is.parameters[p].name, name) != 0 || !isfinite(run->value[p].value))
                continue;
            if (!decks->parameter) {
                decks->parameter = &cell->is.parameters[p];
                decks->unit = human_unit(run->value[p].value, cell->is.parameters[p].unit);
            }
            double f = decks->unit.factor;
            if (decks->count == ROWS_MOST)
                decks->hidden++;
            else
                decks->row[decks->count++] = (struct deck_row){*cell->label ? cell->label : cell->is.cell.deck,
                                                               f * run->value[p].value,
                                                               {f * run->value[p].ci95[0], f * run->value[p].ci95[1]}};
        }
    }
}

static const char *unit_of(const struct decks *decks)
{
    return *decks->unit.text ? decks->unit.text : "1";
}

static struct series *series_of(struct document *document, const struct decks *decks)
{
    const char *unit = unit_of(decks);
    const struct column columns[] = {{"deck", NULL, AS_TEXT, 0},
                                     {"row from below", NULL, AS_PLACE, 0},
                                     {decks->parameter->name, unit, AS_DIGITS, 5},
                                     {"95 % from", unit, AS_DIGITS, 5},
                                     {"to", unit, AS_DIGITS, 5}};
    struct series *series = series_new(document, "decks", decks->count, 5, columns);
    for (int i = 0; i < decks->count; i++) {
        const struct deck_row *row = &decks->row[i];
        series_row(series, i, (const double[]){decks->count - i, row->value, row->ci[0], row->ci[1]});
        series_text(series, i, 0, row->name);
    }
    return series;
}

static void draw(struct plot *plot, const struct series *series, const struct decks *decks)
{
    const char *name[ROWS_MOST] = {NULL};
    struct plot_range range = {INFINITY, -INFINITY};
    for (int i = 0; i < decks->count; i++) {
        const struct deck_row *row = &decks->row[i];
        name[i] = row->name;
        plot_range_join(&range, row->value);
        plot_range_join(&range, row->ci[0]);
        plot_range_join(&range, row->ci[1]);
    }
    struct plot_layout layout = rows_layout(decks->count, name);
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    double pad = 0.05 * (range.to - range.from) + 1e-12;
    plot_line(plot, "set xrange [%.8g:%.8g]\nset xtics %g", range.from - pad, range.to + pad,
              plot_tic(range.to - range.from + 2 * pad, 5));
    rows_draw(plot, decks->count, name);
    const char *axis = pool_format(plot->pool, "%s [%s]", decks->parameter->name, unit_of(decks));
    plot_label(plot, axis ? axis : "", "graph 0.5, screen 1-(y_of(0)+HEIGHT-10)/H", "INK", "center");
    plot_line(plot, "plot $decks using 3:($1-LIFT):($4-$3):(0) with vectors heads size screen 0.006,90 ls 1 lw 1.5 dt 1, \\\n"
                    "    $decks using 2:($1-LIFT) with points ls 1 ps 0.8");
}

void figure_decks(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    struct decks *decks = POOL_NEW(pool, struct decks);
    const char *name = commonest(result->studied);
    int least = 0, most = 0;
    if (!decks) {
        document->failed = 1;
        return;
    }
    if (!name)
        return;
    collect(result->studied, name, decks);
    if (decks->count < LEAST)
        return;
    for (int i = 0; i < decks->count; i++) {
        least = decks->row[i].value < decks->row[least].value ? i : least;
        most = decks->row[i].value > decks->row[most].value ? i : most;
    }
    struct figure *figure = document_figure(document, "decks", pool_format(pool, "%s of the decks", name));
    figure->caption = pool_format(pool, "From %s\xc2\xa0%s (%s) to %s\xc2\xa0%s (%s), each with its 95\xc2\xa0%% interval.%s",
                                  human_digits(pool, decks->row[least].value, 4), decks->unit.text, decks->row[least].name,
                                  human_digits(pool, decks->row[most].value, 4), decks->unit.text, decks->row[most].name,
                                  decks->hidden ? " The first 24 are drawn." : "");
    figure->alt = pool_format(pool, "A point with its interval for each of %d decks.", decks->count);
    struct series *series = series_of(document, decks);
    struct plot plot;
    figure->table = series_table(series);
    if (!series || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, series, decks);
    figure_end(document, &plot);
}
