/* Where the iterations of a study began and where they ended. */
#include <math.h>

#include "page/figures_study.h"
#include "page/human.h"
#include "page/series.h"

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

static const char *unit_of(const struct starts *starts, int p)
{
    return *starts->unit[p].text ? starts->unit[p].text : "1";
}

static const char *axis_of(struct pool *pool, const struct told_cell *cell, const struct starts *starts, int p)
{
    const char *text = pool_format(pool, "%s [%s]", cell->is.parameters[p].name, unit_of(starts, p));
    return text ? text : "";
}

static struct series *collect_runs(struct document *document, const struct told_cell *cell, const struct starts *starts)
{
    struct column column[] = {[0] = {"run", NULL, AS_FIXED, 0}, [5] = {"least functional", NULL, AS_FIXED, 0}};
    for (int p = 0; p < 2; p++) {
        const char *name = cell->is.parameters[p].name, *unit = unit_of(starts, p);
        column[1 + p] = (struct column){pool_format(document->pool, "start, %s", name), unit, AS_DIGITS, 4};
        column[3 + p] = (struct column){pool_format(document->pool, "end, %s", name), unit, AS_DIGITS, 6};
    }
    struct series *series = series_new(document, "runs", starts->drawn, 6, column);
    for (int i = 0; i < starts->drawn; i++) {
        const struct way *way = &starts->way[i];
        series_row(series, i, (const double[]){i + 1, way->from[0], way->from[1], way->to[0], way->to[1], way->reached});
        series_text(series, i, 5, way->reached ? "yes" : "no");
    }
    return series;
}

/* The ways as lines: the corners of each, and a gap behind it. */
static struct series *collect_ways(struct document *document, const struct told_cell *cell, const struct starts *starts)
{
    const struct column columns[] = {{cell->is.parameters[0].name, unit_of(starts, 0), AS_PLACE, 0},
                                     {cell->is.parameters[1].name, unit_of(starts, 1), AS_PLACE, 0}};
    struct series *series = series_new(document, "ways", starts->corners, 2, columns);
    for (int i = 0, row = 0; i < starts->drawn; i++, row++) {
        const struct way *way = &starts->way[i];
        int known = way->run->niterate;
        for (int k = 0; k < (known >= 1 ? known : 2); k++, row++) {
            const double *at = known >= 1 ? way->run->iterate + (ptrdiff_t)k * cell->is.nparameters : k ? way->to : way->from;
            double x = known >= 1 ? starts->unit[0].factor : 1, y = known >= 1 ? starts->unit[1].factor : 1;
            series_row(series, row, (const double[]){x * at[0], y * at[1]});
        }
    }
    return series;
}

static void draw(struct plot *plot, const struct told_cell *cell, const struct starts *starts, const struct series *runs,
                 struct series *ways)
{
    int elsewhere = starts->reached < starts->count;
    const struct plot_entry entry[] = {{.text = "start", .style = 12, .keys = KEY_MARK},
                                       {.text = "end at the least functional of all", .style = 1, .keys = KEY_MARK},
                                       {.text = "end elsewhere", .style = 2, .keys = KEY_MARK}};
    struct plot_layout layout = {
        .panels = 1, .columns = {1, 1}, .height = 400, .narrow_height = 330, .left = 62, .right = 16, .top = 10, .bottom = 48};
    plot_head(entry, 2 + elsewhere, layout.head);
    plot_line(plot, "set style line 11 lc rgb MUTED lw 0.5 dt 1 pt 7 ps 0.2\nset style line 12 lc rgb MUTED pt 6 ps 0.7 lw 1");
    plot_series(plot, runs);
    plot_series(plot, ways);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, 2 + elsewhere);
    for (int p = 0; p < 2; p++) {
        struct plot_range range = {starts->low[p], starts->high[p]};
        for (int i = 0; i < starts->drawn; i++)
            plot_range_join(&range, starts->way[i].to[p]);
        for (int i = 0; i < starts->corners; i++)
            plot_range_join(&range, series_values(ways, p)[i]);
        double pad = 0.05 * (range.to - range.from);
        pad = pad > 0 ? pad : 0.1 * fabs(range.from) + 1e-12;
        plot_line(plot, "set %crange [%.8g:%.8g]", "xy"[p], range.from - pad, range.to + pad);
    }
    plot_label(plot, axis_of(plot->pool, cell, starts, 0), "graph 0.5, screen 1-(y_of(0)+HEIGHT-10)/H", "INK", "center");
    plot_label(plot, axis_of(plot->pool, cell, starts, 1), "screen 12.0/W, graph 0.5", "INK", "center rotate");
    plot_line(plot,
              "plot $ways using 1:2 with linespoints ls 11, $runs using 2:3 with points ls 12, \\\n"
              "    $runs using ($6 > 0 ? NaN : $4):5 with points ls 2 ps 0.9, $runs using ($6 > 0 ? $4 : NaN):5 with points "
              "ls 1 ps 1.1");
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
    struct series *runs = collect_runs(document, cell, &starts), *ways = collect_ways(document, cell, &starts);
    struct plot plot;
    figure->table = series_table(runs);
    if (!runs || !ways || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, cell, &starts, runs, ways);
    figure_end(document, &plot);
}
