/* The parameters of the deck before and after, with their intervals: what the missing cause had done to them. */
#include <math.h>
#include <string.h>

#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/plot.h"

#define MOST_PANELS 8
#define STATES      3
#define ROW_PX      30.0
#define NAMES_PX    112.0

static const int state_style[STATES] = {3, 2, 1};
static const char *const state_text[STATES] = {"as the deck fits", "without the cause", "with it"};

struct state {
    double value, ci[2];
};

struct moved {
    const rotid_changed_parameter *parameter;
    struct human_unit unit;
    struct state state[STATES]; /* in that unit, NaN: there is none */
};

static const rotid_fitted_parameter *in(const rotid_identification *fit, const char *name)
{
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (!strcmp(fit->parameters[p].name, name))
            return &fit->parameters[p];
    return NULL;
}

static int collect(const rotid_diagnosis *d, struct moved moved[MOST_PANELS])
{
    int count = 0;
    for (int p = 0; p < d->gain.nparameters && count < MOST_PANELS; p++) {
        const rotid_changed_parameter *q = &d->gain.parameters[p];
        const rotid_fitted_parameter *today = in(diagnosis_today(d), q->name);
        if (!isfinite(q->before))
            continue;
        struct moved *m = &moved[count++];
        double f;
        *m = (struct moved){.parameter = q, .unit = human_unit(q->before, q->unit)};
        f = m->unit.factor;
        m->state[0] =
            today ? (struct state){f * today->value, {f * today->ci95[0], f * today->ci95[1]}} : (struct state){NAN, {NAN, NAN}};
        m->state[1] = (struct state){f * q->before, {f * q->before_ci95[0], f * q->before_ci95[1]}};
        m->state[2] = (struct state){f * q->after, {f * q->after_ci95[0], f * q->after_ci95[1]}};
    }
    return count;
}

static void draw(struct plot *plot, const struct moved *m, int i, const int *shown, int nshown)
{
    struct plot_range range = {INFINITY, -INFINITY};
    for (int s = 0; s < nshown; s++) {
        const struct state *state = &m->state[shown[s]];
        plot_range_join(&range, state->value);
        plot_range_join(&range, state->ci[0]);
        plot_range_join(&range, state->ci[1]);
    }
    double pad = 0.06 * (range.to - range.from);
    pad = pad > 0 ? pad : 0.1 * fabs(range.from) + 1e-12;
    plot_line(plot, "set xrange [%.8g:%.8g]\nset yrange [0.4:%g]\nunset ytics\nset border 1\nset xtics %g", range.from - pad,
              range.to + pad, nshown + 0.6, plot_tic(range.to - range.from + 2 * pad, 3));
    const char *axis = *m->unit.text ? pool_format(plot->pool, "%s [%s]", m->parameter->name, m->unit.text)
                                     : pool_format(plot->pool, "%s [1]", m->parameter->name);
    char where[96];
    (void)snprintf(where, sizeof where, "graph 0.5, screen 1-(y_of(%d)+HEIGHT-10)/H", i);
    plot_label(plot, axis ? axis : "", where, "INK", "center");
    for (int s = 0; s < nshown; s++) {
        (void)snprintf(where, sizeof where, "graph 0, first %d", nshown - s);
        plot_label(plot, shown[s] == 1 && shown[nshown - 1] == 1 ? "full model" : state_text[shown[s]], where, "INK",
                   "right offset char -0.7, 0");
    }
    (void)fputs("plot ", plot->out);
    for (int s = 0; s < nshown; s++)
        (void)fprintf(
            plot->out,
            "%s$parameter%d every ::%d::%d using 3:1:($4-$3):(0) with vectors heads size screen 0.008,90 ls %d lw 2 dt 1, "
            "\\\n    $parameter%d every ::%d::%d using 2:1 with points ls %d ps 0.9",
            s ? ", \\\n    " : "", i + 1, s, s, state_style[shown[s]], i + 1, s, s, state_style[shown[s]]);
    (void)fputc('\n', plot->out);
}

static int script(struct document *document, struct figure *figure, const struct result *result, int count,
                  const struct moved *moved, const int *shown, int nshown)
{
    struct plot_layout layout = {.panels = count,
                                 .columns = {count > 1 ? 2 : 1, 1},
                                 .height = 66 + ROW_PX * nshown,
                                 .left = NAMES_PX,
                                 .right = 20,
                                 .top = 10,
                                 .bottom = 48};
    struct plot plot;
    if (plot_open(&plot, document->pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: row from below, value, lower and upper end of the interval");
    for (int i = 0; i < count; i++) {
        double data[4][STATES];
        char name[32];
        for (int s = 0; s < nshown; s++) {
            const struct state *state = &moved[i].state[shown[s]];
            data[0][s] = nshown - s;
            data[1][s] = state->value;
            data[2][s] = state->ci[0];
            data[3][s] = state->ci[1];
        }
        (void)snprintf(name, sizeof name, "parameter%d", i + 1);
        plot_data(&plot, name, nshown, 4, (const double *const[]){data[0], data[1], data[2], data[3]});
    }
    plot_begin(&plot, &layout);
    for (int i = 0; i < count; i++) {
        plot_panel(&plot, i);
        draw(&plot, &moved[i], i, shown, nshown);
    }
    return plot_close(&plot);
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
        const rotid_fitted_parameter *today = in(diagnosis_today(d), q->name);
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
        const struct state *before = &moved[i].state[1], *after = &moved[i].state[2];
        text = pool_format(pool, "%s%s%s %sby %s\xc2\xa0%%", text, i ? ", " : "", moved[i].parameter->name, i ? "" : "moves ",
                           human_signed(pool, 100 * (after->value / before->value - 1), 1));
        if (after->value < before->ci[0] || after->value > before->ci[1])
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
    int count = collect(d, moved), shown[STATES], nshown = 0, has[STATES] = {diagnosis_today(d) != NULL, 1, d->extended != NULL};
    if (!count || !d->base || has[0] + has[2] == 0)
        return;
    for (int s = 0; s < STATES; s++)
        if (has[s])
            shown[nshown++] = s;
    struct figure *figure = document_figure(document, "change",
                                            d->extended ? "Parameters with their 95 % intervals, before and after"
                                                        : "Parameters with their 95 % intervals");
    if (d->extended)
        figure->caption = pool_format(pool, "With what was named in the model %s.", movements(pool, count, moved));
    else
        figure->caption =
            pool_format(pool,
                        "The fit as the deck states it (%s, reduction %s) beside the full model, which is judged by the "
                        "likelihood: %s = %s against %s.",
                        d->today->functional, d->today->reduction, moved[0].parameter->name,
                        human_value(pool, moved[0].state[0].value / moved[0].unit.factor, moved[0].parameter->unit),
                        human_value(pool, moved[0].parameter->before, moved[0].parameter->unit));
    figure->alt = pool_format(
        pool, "For each of %d parameters one bar for each of %d models, from the lower to the upper end of its interval.", count,
        nshown);
    figure->table = changes_table(pool, d);
    document->failed |=
        !figure->caption || !figure->alt || script(document, figure, result, count, moved, shown, nshown) != ROTID_OK;
}
