/* Where the iterations of a study began and where they ended. */
#include <math.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/plot.h"

#define MOST_RUNS 400   /* that are drawn */
#define SAME_BEST 1e-6  /* relative difference of objectives, as in the summary of a study */
#define ROUNDING  1e-20 /* of an objective that is zero but for it */

struct way { /* of a run */
    double from[2], to[2];
    int reached; /* the best objective of its cell */
    const struct told_run *run;
};

struct starts {
    int cell, count, drawn, reached, converged;
    int corners;            /* of all ways that are drawn, two each where the iterates are not known, and what ends each */
    int whole;              /* all iterates are known */
    double low[2], high[2]; /* of the starts, in their units */
    struct human_unit unit[2];
    struct way *way; /* [drawn] in those units */
};

/* The cell with the most frequencies of those with several starts and two parameters, -1: none. */
static int choose(const struct study_outcome *s)
{
    int best = -1, most = 0;
    for (int i = 0; i < s->nrun; i++) {
        const struct told_run *run = &s->run[i];
        const struct told_cell *cell = &s->cell[run->cell];
        if (cell->is.reached_best != ROTID_NONE && cell->is.nparameters >= 2 && run->fitted > most) {
            best = run->cell;
            most = run->fitted;
        }
    }
    return best;
}

static double best_of(const struct study_outcome *s, int cell)
{
    double best = INFINITY;
    for (int i = 0; i < s->nrun; i++)
        if (s->run[i].cell == cell && s->run[i].status <= STUDY_AT_BOUND)
            best = fmin(best, s->run[i].objective);
    return best;
}

/* ROTID_OK or ROTID_ERROR_MEMORY. */
static int collect(struct pool *pool, const struct study_outcome *s, int cell, struct starts *starts)
{
    double best = best_of(s, cell);
    *starts = (struct starts){.cell = cell, .whole = 1, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (int p = 0; p < 2; p++)
        starts->unit[p] = human_unit(s->cell[cell].is.parameters[p].mean, s->cell[cell].is.parameters[p].unit);
    starts->way = POOL_ARRAY(pool, struct way, MOST_RUNS);
    for (int i = 0; i < s->nrun && starts->way; i++) {
        const struct told_run *run = &s->run[i];
        struct way way = {.run = run,
                          .reached = run->status <= STUDY_AT_BOUND && run->objective <= best * (1 + SAME_BEST) + ROUNDING};
        if (run->cell != cell || !run->value)
            continue;
        for (int p = 0; p < 2; p++) {
            way.from[p] = starts->unit[p].factor * run->value[p].start;
            way.to[p] = starts->unit[p].factor * run->value[p].value;
            starts->low[p] = fmin(starts->low[p], way.from[p]);
            starts->high[p] = fmax(starts->high[p], way.from[p]);
        }
        starts->count++;
        starts->converged += run->status <= STUDY_AT_BOUND;
        starts->reached += way.reached;
        if (starts->drawn == MOST_RUNS)
            continue;
        starts->way[starts->drawn++] = way;
        starts->whole &= run->niterate >= 1;
        starts->corners += (run->niterate >= 1 ? run->niterate : 2) + 1;
    }
    return starts->way ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static const char *axis_of(struct pool *pool, const struct told_cell *cell, const struct starts *starts, int p)
{
    const char *unit = *starts->unit[p].text ? starts->unit[p].text : "1";
    const char *text = pool_format(pool, "%s [%s]", cell->is.parameters[p].name, unit);
    return text ? text : "";
}

/* The ways as lines: x and y [corners] of each, and a gap behind it; range [2] is widened to hold them. */
static void lines(const struct told_cell *cell, const struct starts *starts, struct plot_range *range, double *x, double *y)
{
    int row = 0;
    for (int i = 0; i < starts->drawn; i++) {
        const struct way *way = &starts->way[i];
        int known = way->run->niterate;
        for (int k = 0; k < (known >= 1 ? known : 2); k++, row++) {
            const double *at = known >= 1 ? way->run->iterate + (ptrdiff_t)k * cell->is.nparameters : NULL;
            x[row] = at ? starts->unit[0].factor * at[0] : k ? way->to[0] : way->from[0];
            y[row] = at ? starts->unit[1].factor * at[1] : k ? way->to[1] : way->from[1];
            plot_range_join(&range[0], x[row]);
            plot_range_join(&range[1], y[row]);
        }
        x[row] = y[row] = NAN;
        row++;
    }
}

static int script(struct document *document, struct figure *figure, const struct result *result, const struct starts *starts)
{
    struct pool *pool = document->pool;
    const struct told_cell *cell = &result->studied->cell[starts->cell];
    int n = starts->drawn, elsewhere = starts->reached < starts->count;
    double *data = POOL_ARRAY(pool, double, 5 * (size_t)n), *x = POOL_ARRAY(pool, double, starts->corners),
           *y = POOL_ARRAY(pool, double, starts->corners);
    const struct plot_entry entry[] = {{.text = "start", .style = 12, .keys = KEY_MARK},
                                       {.text = "end at the least functional of all", .style = 1, .keys = KEY_MARK},
                                       {.text = "end elsewhere", .style = 2, .keys = KEY_MARK}};
    struct plot_layout layout = {
        .panels = 1, .columns = {1, 1}, .height = 400, .narrow_height = 330, .left = 62, .right = 16, .top = 10, .bottom = 48};
    struct plot_range range[2];
    struct plot plot;
    if (!data || !x || !y)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < 2; p++)
        range[p] = (struct plot_range){starts->low[p], starts->high[p]};
    for (int i = 0; i < n; i++) {
        const struct way *way = &starts->way[i];
        const double row[] = {way->from[0], way->from[1], way->to[0], way->to[1], way->reached};
        for (int c = 0; c < 5; c++)
            data[i + (ptrdiff_t)c * n] = row[c];
        for (int p = 0; p < 2; p++)
            plot_range_join(&range[p], way->to[p]);
    }
    lines(cell, starts, range, x, y);
    plot_head(entry, 2 + elsewhere, layout.head);
    if (plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "set style line 11 lc rgb MUTED lw 0.5 dt 1 pt 7 ps 0.2\nset style line 12 lc rgb MUTED pt 6 ps 0.7 lw 1");
    plot_line(&plot, "# columns: start, end, both parameters each; 1: the end has the least functional of all");
    plot_data(&plot, "runs", n, 5,
              (const double *const[]){data, data + n, data + 2 * (ptrdiff_t)n, data + 3 * (ptrdiff_t)n, data + 4 * (ptrdiff_t)n});
    plot_line(&plot, "# columns: both parameters along each way");
    plot_data(&plot, "ways", starts->corners, 2, (const double *const[]){x, y});
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_legend(&plot, entry, 2 + elsewhere);
    for (int p = 0; p < 2; p++) {
        double pad = 0.05 * (range[p].to - range[p].from);
        pad = pad > 0 ? pad : 0.1 * fabs(range[p].from) + 1e-12;
        plot_line(&plot, "set %crange [%.8g:%.8g]", "xy"[p], range[p].from - pad, range[p].to + pad);
    }
    plot_label(&plot, axis_of(pool, cell, starts, 0), "graph 0.5, screen 1-(y_of(0)+HEIGHT-10)/H", "INK", "center");
    plot_label(&plot, axis_of(pool, cell, starts, 1), "screen 12.0/W, graph 0.5", "INK", "center rotate");
    plot_line(&plot,
              "plot $ways using 1:2 with linespoints ls 11, $runs using 1:2 with points ls 12, \\\n"
              "    $runs using ($5 > 0 ? NaN : $3):4 with points ls 2 ps 0.9, $runs using ($5 > 0 ? $3 : NaN):4 with points "
              "ls 1 ps 1.1");
    return plot_close(&plot);
}

static struct number_table *ways_table(struct pool *pool, const struct told_cell *cell, const struct starts *starts)
{
    struct number_table *table = table_new(pool, starts->drawn, 6);
    table_head(table, 0, "run");
    for (int p = 0; p < 2; p++) {
        const char *axis = axis_of(pool, cell, starts, p);
        table_head(table, 1 + p, pool_format(pool, "start, %s", axis));
        table_head(table, 3 + p, pool_format(pool, "end, %s", axis));
    }
    table_head(table, 5, "least functional");
    for (int i = 0; i < starts->drawn; i++) {
        const struct way *way = &starts->way[i];
        table_cell(table, i, 0, human_fixed(pool, i + 1, 0));
        for (int p = 0; p < 2; p++) {
            table_cell(table, i, 1 + p, human_digits(pool, way->from[p], 4));
            table_cell(table, i, 3 + p, human_digits(pool, way->to[p], 6));
        }
        table_cell(table, i, 5, way->reached ? "yes" : "no");
    }
    return table;
}

/* "within +-70 % of core.E = 60 GPa, core.G = 30 GPa", or where that differs from to of each. */
static const char *span_of(struct pool *pool, const struct told_cell *cell, const struct starts *starts)
{
    double spread[2];
    const char *text = "";
    for (int p = 0; p < 2; p++)
        spread[p] = 100 * (starts->high[p] - starts->low[p]) / (starts->high[p] + starts->low[p]);
    int even = fabs(spread[0] - spread[1]) < 0.5;
    for (int p = 0; p < 2 && text; p++) {
        const char *name = cell->is.parameters[p].name, *unit = starts->unit[p].text;
        if (even)
            text = pool_format(pool, "%s%s%s = %s\xc2\xa0%s", text, p ? ", " : "", name,
                               human_trimmed(pool, (starts->low[p] + starts->high[p]) / 2, 3), unit);
        else
            text = pool_format(pool, "%s%s%s from %s to %s\xc2\xa0%s", text, p ? ", " : "", name,
                               human_trimmed(pool, starts->low[p], 3), human_trimmed(pool, starts->high[p], 3), unit);
    }
    if (text && even)
        text = pool_format(pool, "within \xc2\xb1%.0f\xc2\xa0%% of %s", spread[0], text);
    else if (text)
        text = pool_format(pool, "with %s", text);
    return text ? text : "";
}

void figure_starts(struct document *document, const struct result *result)
{
    const struct study_outcome *s = result->studied;
    struct pool *pool = document->pool;
    struct starts starts;
    int chosen = choose(s);
    if (chosen < 0)
        return;
    const struct told_cell *cell = &s->cell[chosen];
    if (collect(pool, s, chosen, &starts)) {
        document->failed = 1;
        return;
    }
    if (starts.count < 2)
        return;
    struct figure *figure = document_figure(document, "starts", "Where the iterations begin and where they end");
    const char *where =
        pool_format(pool, "%s = %s, %s = %s", cell->is.parameters[0].name,
                    human_value(pool, cell->is.parameters[0].mean, cell->is.parameters[0].unit), cell->is.parameters[1].name,
                    human_value(pool, cell->is.parameters[1].mean, cell->is.parameters[1].unit));
    const char *span = span_of(pool, cell, &starts);
    const char *end = starts.reached == starts.count
                          ? pool_format(pool, "all end at the same minimum, %s", where ? where : "")
                          : pool_format(pool, "%d end at the least functional, %d elsewhere, %d did not converge", starts.reached,
                                        starts.converged - starts.reached, starts.count - starts.converged);
    figure->caption = pool_format(pool, "%d iterations%s%s%s, started %s: %s.%s %s", starts.count, *cell->label ? " (" : "",
                                  cell->label, *cell->label ? ")" : "", span ? span : "", end ? end : "",
                                  starts.drawn < starts.count ? " The first 400 are drawn." : "",
                                  starts.whole ? "Small dots are the iterates between." : "Lines join start and end.");
    figure->alt =
        pool_format(pool, "%d points of departure over the plane of %s and %s, joined by lines to where the runs ended: %s.",
                    starts.drawn, cell->is.parameters[0].name, cell->is.parameters[1].name, end ? end : "");
    figure->table = ways_table(pool, cell, &starts);
    document->failed |= !figure->caption || !figure->alt || script(document, figure, result, &starts) != ROTID_OK;
}
