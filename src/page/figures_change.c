/* The parameters of the deck before and after, with their intervals: what the missing cause had done to them. */
#include <math.h>

#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/series.h"

#define MOST_PANELS 8
#define STATES      3
#define ROW_PX      30.0
#define NAMES_PX    112.0

static const int state_style[STATES] = {3, 2, 1};
static const char *const state_text[STATES] = {"as the deck fits", "without the cause", "with the cause"};

struct moved {
    const rotid_changed_parameter *parameter;
    struct human_unit unit;
    struct series *series; /* a row a state that is shown, in that unit */
};

/* The states that are shown. */
struct states {
    int count, state[STATES];
};

static struct states states_of(const rotid_diagnosis *d)
{
    const int has[STATES] = {diagnosis_today(d) != NULL, 1, d->extended != NULL};
    struct states states = {.count = 0};
    for (int s = 0; s < STATES; s++)
        if (has[s])
            states.state[states.count++] = s;
    return states;
}

static int collect(struct document *document, const rotid_diagnosis *d, const struct states *states,
                   struct moved moved[MOST_PANELS])
{
    int count = 0, n = states->count;
    for (int p = 0; p < d->gain.nparameters && count < MOST_PANELS; p++) {
        const rotid_changed_parameter *q = &d->gain.parameters[p];
        const rotid_fitted_parameter *today = fit_parameter(diagnosis_today(d), q->name);
        if (!isfinite(q->before))
            continue;
        struct moved *m = &moved[count++];
        *m = (struct moved){.parameter = q, .unit = human_unit(q->before, q->unit)};
        const char *unit = *m->unit.text ? m->unit.text : "1";
        const struct column columns[] = {{"row from below", NULL, AS_PLACE, 0},
                                         {q->name, unit, AS_PLACE, 0},
                                         {"95 % from", unit, AS_PLACE, 0},
                                         {"to", unit, AS_PLACE, 0}};
        const double value[STATES] = {today ? today->value : (double)NAN, q->before, q->after};
        const double *const ci[STATES] = {today ? today->ci95 : NULL, q->before_ci95, q->after_ci95};
        m->series = series_new(document, pool_format(document->pool, "parameter%d", count), n, 4, columns);
        for (int i = 0; i < n; i++) {
            double f = m->unit.factor, none = NAN;
            int s = states->state[i];
            series_row(m->series, i,
                       (const double[]){n - i, f * value[s], ci[s] ? f * ci[s][0] : none, ci[s] ? f * ci[s][1] : none});
        }
    }
    return count;
}

static const char *axis_of(struct pool *pool, const struct moved *m)
{
    const char *axis = pool_format(pool, "%s [%s]", m->parameter->name, *m->unit.text ? m->unit.text : "1");
    return axis ? axis : "";
}

static void draw(struct plot *plot, const struct moved *m, int i, const struct states *states)
{
    struct plot_range range = {INFINITY, -INFINITY};
    int n = states->count;
    for (int s = 0; s < n; s++)
        for (int c = 1; c < 4; c++)
            plot_range_join(&range, series_values(m->series, c)[s]);
    double pad = 0.06 * (range.to - range.from);
    pad = pad > 0 ? pad : 0.1 * fabs(range.from) + 1e-12;
    plot_line(plot, "set xrange [%.8g:%.8g]\nset yrange [0.4:%g]\nunset ytics\nset border 1\nset xtics %g", range.from - pad,
              range.to + pad, n + 0.6, plot_tic(range.to - range.from + 2 * pad, 3));
    plot_axes(plot, axis_of(plot->pool, m), NULL);
    for (int s = 0; s < n; s++) {
        char where[96];
        (void)snprintf(where, sizeof where, "graph 0, first %d", n - s);
        plot_label(plot, states->state[s] == 1 && states->state[n - 1] == 1 ? "full model" : state_text[states->state[s]], where,
                   "INK", "right offset char -0.7, 0");
    }
    (void)fputs("plot ", plot->out);
    for (int s = 0; s < n; s++) {
        int style = state_style[states->state[s]];
        (void)fprintf(
            plot->out,
            "%s$parameter%d every ::%d::%d using 3:1:($4-$3):(0) with vectors heads size screen 0.008,90 ls %d lw 2 dt 1, "
            "\\\n    $parameter%d every ::%d::%d using 2:1 with points ls %d ps 0.9",
            s ? ", \\\n    " : "", i + 1, s, s, style, i + 1, s, s, style);
    }
    (void)fputc('\n', plot->out);
}

static void script(struct plot *plot, int count, const struct moved *moved, const struct states *states)
{
    for (int i = 0; i < count; i++)
        plot_series(plot, moved[i].series);
    struct plot_layout layout = {.panels = count,
                                 .columns = {count > 1 ? 2 : 1, 1},
                                 .height = 66 + ROW_PX * states->count,
                                 .left = NAMES_PX,
                                 .right = 20,
                                 .top = 10,
                                 .bottom = 48};
    double more = 0;
    for (int i = 0; i < count; i++) {
        const char *axis = axis_of(plot->pool, &moved[i]);
        more = fmax(more, plot_lines_px(1, &axis, plot_axis_px(&layout)));
    }
    layout.bottom += more;
    layout.height += more;
    plot_begin(plot, &layout);
    for (int i = 0; i < count; i++) {
        plot_panel(plot, i);
        if (moved[i].series)
            draw(plot, &moved[i], i, states);
    }
}

static struct number_table *changes_table(struct pool *pool, const rotid_diagnosis *d)
{
    struct number_table *table = table_new(pool, d->gain.nparameters, 5);
    table_head(table, 0, "parameter");
    table_head(table, 1, "as the deck fits");
    table_head(table, 2, d->extended ? "without the cause" : "full model");
    table_head(table, 3, "with it");
    table_head(table, 4, "change [%]");
    for (int p = 0; p < d->gain.nparameters; p++) {
        const rotid_changed_parameter *q = &d->gain.parameters[p];
        const rotid_fitted_parameter *today = fit_parameter(diagnosis_today(d), q->name);
        table_cell(table, p, 0, q->name);
        table_cell(table, p, 1, today ? human_interval(pool, today->value, today->ci95, today->unit) : "\xe2\x80\x93");
        table_cell(table, p, 2, human_interval(pool, q->before, q->before_ci95, q->unit));
        table_cell(table, p, 3, human_interval(pool, q->after, q->after_ci95, q->unit));
        table_cell(table, p, 4, human_signed(pool, 100 * (q->after / q->before - 1), 1));
    }
    return table;
}

/* "core.E moves by +1.7 %, core.G by +5.6 %: ..." */
static const char *movements(struct pool *pool, int count, const struct moved *moved)
{
    const char *text = "", *outside = "";
    int left = 0;
    for (int i = 0; i < count && text && outside; i++) {
        const rotid_changed_parameter *q = moved[i].parameter;
        text = pool_format(pool, "%s%s%s %sby %s\xc2\xa0%%", text, i ? ", " : "", moved[i].parameter->name, i ? "" : "moves ",
                           human_signed(pool, 100 * (q->after / q->before - 1), 1));
        if (q->after < q->before_ci95[0] || q->after > q->before_ci95[1])
            outside = pool_format(pool, "%s%s%s", outside, left++ ? ", " : "", moved[i].parameter->name);
    }
    if (left && text && outside)
        text = pool_format(
            pool, "%s. Out of the interval before: %s; an interval knows nothing of an error that the parameter can absorb", text,
            outside);
    return text ? text : "";
}

void figure_change(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    struct moved moved[MOST_PANELS];
    struct states states = states_of(d);
    struct plot plot;
    int count = d->base && states.count > 1 ? collect(document, d, &states, moved) : 0;
    if (!count)
        return;
    struct figure *figure = document_figure(document, "change",
                                            d->extended ? "Parameters with their 95 % intervals, before and after"
                                                        : "Parameters with their 95 % intervals");
    if (d->extended)
        figure->caption = pool_format(pool, "In the extended model %s.", movements(pool, count, moved));
    else
        figure->caption =
            pool_format(pool,
                        "The fit as the deck states it (%s, reduction %s) beside the full model, which is judged by the "
                        "likelihood: %s = %s against %s.",
                        d->today->functional, d->today->reduction, moved[0].parameter->name,
                        human_value(pool,
                                    fit_parameter(d->today, moved[0].parameter->name)
                                        ? fit_parameter(d->today, moved[0].parameter->name)->value
                                        : (double)NAN,
                                    moved[0].parameter->unit),
                        human_value(pool, moved[0].parameter->before, moved[0].parameter->unit));
    figure->alt = pool_format(
        pool, "For each of %d parameters one bar for each of %d models, from the lower to the upper end of its interval.", count,
        states.count);
    figure->table = changes_table(pool, d);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    script(&plot, count, moved, &states);
    figure_end(document, &plot);
}
