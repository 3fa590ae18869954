/* The summary and the runs of a study as tables. */
#include "study/study.h"

#define MOST_ERROR 10   /* different reasons that are listed */
#define ROUNDING   1e-9 /* relative, or of an error in per cent: below it stands nothing but that */

static int equal_numbers(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The axes on which runs of a study may differ. */
static const struct axis {
    const char *name;
    size_t offset; /* of the member of struct study_axes */
    int is_number;
} axes[] = {{"deck", offsetof(struct study_axes, deck), 0},
            {"variant", offsetof(struct study_axes, variant), 0},
            {"modes", offsetof(struct study_axes, modes), 0},
            {"sensors", offsetof(struct study_axes, sensors), 0},
            {"hidden", offsetof(struct study_axes, hide), 0},
            {"noise", offsetof(struct study_axes, noise_frequency), 1},
            {"shape noise", offsetof(struct study_axes, noise_shape), 1}};
#define AXES (int)(sizeof axes / sizeof *axes)

static const char *text_at(const struct axis *axis, const struct study_axes *cell)
{
    return *(const char *const *)((const char *)cell + axis->offset);
}

static double number_at(const struct axis *axis, const struct study_axes *cell)
{
    return *(const double *)((const char *)cell + axis->offset);
}

static int differ(const struct axis *axis, const struct study_axes *a, const struct study_axes *b)
{
    return axis->is_number ? !equal_numbers(number_at(axis, a), number_at(axis, b))
                           : !equal_texts(text_at(axis, a), text_at(axis, b));
}

int summary_same_cell(const struct study_axes *a, const struct study_axes *b)
{
    int same = 1;
    for (const struct axis *axis = axes; axis < axes + AXES; axis++)
        same &= !differ(axis, a, b);
    return same;
}

static int cells_differ(const struct axis *axis, const struct study_result *s)
{
    int any = 0;
    for (int c = 1; c < s->ncells; c++)
        any |= differ(axis, &s->cells[0].cell, &s->cells[c].cell);
    return any;
}

/* An axis on which cells do not differ is in CSV alone. */
static void axes_columns(struct table *table, const struct study_result *all, const struct study_axes *at)
{
    for (const struct axis *axis = axes; axis < axes + AXES; axis++) {
        unsigned same = cells_differ(axis, all) ? 0 : IN_CSV_ONLY;
        if (axis->is_number)
            number_column(table, axis->name, NULL, SHOW_TRIMMED(3) | same, number_at(axis, at));
        else
            text_column(table, axis->name, MAY_BE_CUT | same, text_at(axis, at));
    }
}

/* "; deck paper.inp, noise 0.001": what all cells have. */
static const char *common(struct pool *pool, const struct study_result *s)
{
    const char *text = "";
    for (const struct axis *axis = axes; axis < axes + AXES && s->ncells; axis++) {
        const struct study_axes *cell = &s->cells[0].cell;
        const char *value = axis->is_number ? NULL : text_at(axis, cell);
        if (axis->is_number && isfinite(number_at(axis, cell)))
            value = pool_text(pool, "%g", number_at(axis, cell));
        if (value && !cells_differ(axis, s))
            text = pool_text(pool, "%s%s%s %s", text, *text ? ", " : "; ", axis->name, value);
    }
    return text;
}

static double above_rounding(double value, double rounding)
{
    return fabs(value) < rounding ? 0 : value;
}

struct table *table_of_cells(struct pool *pool, const struct study_result *s)
{
    struct table *table =
        table_open(pool, pool_text(pool, "Cells: runs that differ in replicate and start alone%s", common(pool, s)));
    int starts = 0;
    for (int i = 0; i < s->ncells; i++)
        starts |= s->cells[i].reached_best != ROTID_NONE;
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        int best = cell->reached_best == ROTID_NONE ? cell->converged + cell->at_bound : cell->reached_best;
        axes_columns(table, s, &cell->cell);
        number_column(table, "runs", NULL, SHOW_COUNT, cell->runs);
        number_column(table, "failed", NULL, SHOW_COUNT, cell->failed);
        number_column(table, "at bound", NULL, SHOW_COUNT, cell->at_bound);
        number_column(table, "no conv", NULL, SHOW_COUNT, cell->not_converged);
        number_column(table, "not ad.", NULL, SHOW_COUNT, cell->not_adequate);
        number_column(table, "at best", NULL, SHOW_COUNT, starts ? best : (double)NAN);
        number_column(table, "rms", "%", SHOW_FIXED(3), above_rounding(cell->frequency_rms_percent, ROUNDING));
        number_column(table, "held out", "%", SHOW_FIXED(3), above_rounding(cell->holdout_frequency_rms_percent, ROUNDING));
        number_column(table, "chi2/dof", NULL, SHOW_DIGITS(3) | DETAIL, cell->chi2_per_dof);
        number_column(table, "evaluations", NULL, SHOW_DIGITS(3) | DETAIL, cell->evaluations);
    }
    table_note(table, "rms: error of the fitted frequencies; at best: runs that came to the best objective of their replicate");
    return table;
}

struct table *table_of_cell_parameters(struct pool *pool, const struct study_result *s)
{
    struct table *table = table_open(pool, "Parameters by cells");
    for (int i = 0; i < s->ncells; i++)
        for (int p = 0; p < s->cells[i].nparameters; p++) {
            const struct cell_parameter *q = &s->cells[i].parameters[p];
            double scatter = isfinite(q->std_error) ? q->std_error : q->std;
            axes_columns(table, s, &s->cells[i].cell);
            text_column(table, "parameter", MAY_BE_CUT, q->name);
            unit_column(table, q->mean, NAN, q->unit);
            number_column(table, "runs", NULL, SHOW_COUNT, q->count);
            number_column(table, "mean", ROW_UNIT, SHOW_DIGITS(6), q->mean);
            number_column(table, "std", ROW_UNIT, SHOW_DIGITS(3), above_rounding(scatter, 1e3 * ROUNDING * fabs(q->mean)));
            number_column(table, "stated", ROW_UNIT, SHOW_DIGITS(3), q->mean_stated_std);
            number_column(table, "bias", ROW_UNIT, SHOW_DIGITS(3), q->bias);
            number_column(table, "rms error", ROW_UNIT, SHOW_DIGITS(3) | IN_CSV_ONLY, q->rms_error);
            number_column(table, "in95%", "%", SHOW_FIXED(1), 100 * q->coverage95);
            number_column(table, "intervals", NULL, SHOW_COUNT | IN_CSV_ONLY, q->intervals);
            number_column(table, "min", ROW_UNIT, SHOW_DIGITS(6) | DETAIL, q->min);
            number_column(table, "max", ROW_UNIT, SHOW_DIGITS(6) | DETAIL, q->max);
        }
    table_note(table,
               "std: scatter of the runs, about the truth where it is known; stated: mean standard deviation of the fits; bias: "
               "mean difference to the truth; in95%%: share of the 95 %% intervals that hold it");
    return table;
}

/* What was named, with its number of runs. */
static const char *named(struct pool *pool, const struct cell_diagnoses *d)
{
    const char *text = "";
    for (int k = 0; k < d->nnamed; k++)
        text = pool_text(pool, "%s%s%s %.0f", text, k ? ", " : "", d->named[k].name, d->named[k].value);
    return text;
}

/* Whether the diagnoses of a cell could be compared with the hidden effects. */
static int summary_is_scored(const struct study_cell_result *cell)
{
    return cell->diagnoses && cell->diagnoses->scores[0] != ROTID_NONE;
}

/* Verdicts, and where the plan hid something the scores. */
static struct table *table_of_cell_diagnoses(struct pool *pool, const struct study_result *s)
{
    static const char *const scores[] = {"quiet", "false alarm", "right", "in set", "other set", "silent", "no cause", "wrong"};
    struct table *table = table_open(pool, "Diagnoses");
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        const struct cell_diagnoses *d = cell->diagnoses;
        int scored = summary_is_scored(cell);
        if (!d)
            continue;
        axes_columns(table, s, &cell->cell);
        number_column(table, "runs", NULL, SHOW_COUNT, d->count);
        for (int k = 0; k < STUDY_VERDICTS; k++)
            number_column(table, verdict_words[k], NULL, SHOW_COUNT, d->verdicts[k]);
        for (int k = 0; k < SCORE_COUNT; k++)
            number_column(table, scores[k], NULL, SHOW_COUNT, scored ? d->scores[k] : (double)NAN);
        number_column(table, "false faults", NULL, SHOW_COUNT, scored ? d->false_findings : (double)NAN);
        text_column(table, "causes and faults named", SHOW_TEXT, named(pool, d));
    }
    return table;
}

void table_add_run(struct table *table, const struct study_run *run)
{
    static const struct study_result none;
    static const rotid_fitted_parameter nothing = {
        .name = "", .unit = "1", .value = NAN, .start = NAN, .std = NAN, .ci95 = {NAN, NAN}};
    const rotid_identification *fit = run->fit;
    int count;
    const rotid_fitted_parameter *value = table ? study_run_values(table->pool, run, &count) : NULL;
    if (!value)
        return;
    for (int p = 0; p < (count ? count : 1); p++) {
        const rotid_fitted_parameter *is = count ? &value[p] : &nothing;
        double truth = study_run_truth(run, is->name);
        number_column(table, "run", NULL, SHOW_COUNT, run->run);
        axes_columns(table, &none, &run->cell);
        number_column(table, "replicate", NULL, SHOW_COUNT, run->replicate);
        number_column(table, "start", NULL, SHOW_COUNT, run->start);
        text_column(table, "status", SHOW_TEXT,
                    run->status == STUDY_FAILED ? "failed"
                    : fit                       ? study_status_words[run->status]
                                                : "");
        number_column(table, "objective", NULL, SHOW_DIGITS(6), fit ? fit->objective : (double)NAN);
        number_column(table, "chi2/dof", NULL, SHOW_DIGITS(3), fit ? fit->chi2_per_dof : (double)NAN);
        text_column(table, "verdict", SHOW_TEXT, run->diagnosis ? verdict_words[run->diagnosis->verdict.kind] : "");
        text_column(table, "score", SHOW_TEXT, run->diagnosis && run->score >= 0 ? score_words[run->score] : "");
        text_column(table, "parameter", SHOW_TEXT, is->name);
        unit_column(table, is->value, NAN, is->unit);
        number_column(table, "value", ROW_UNIT, SHOW_DIGITS(6), is->value);
        number_column(table, "std", ROW_UNIT, SHOW_DIGITS(3), is->std);
        number_column(table, "lower 95 %", ROW_UNIT, SHOW_DIGITS(6), is->ci95[0]);
        number_column(table, "upper 95 %", ROW_UNIT, SHOW_DIGITS(6), is->ci95[1]);
        number_column(table, "truth", ROW_UNIT, SHOW_DIGITS(6), truth);
        text_column(table, "error", SHOW_TEXT, run->error);
    }
}

/* Over all cells that have them: intervals that hold the truth, starts that came to the best. */
struct shares {
    double intervals, held, starts, reached, good, scored, false_alarm, not_converged;
};

static struct shares add_up(const struct study_result *s)
{
    struct shares sum = {0};
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        for (int p = 0; p < cell->nparameters; p++)
            if (isfinite(cell->parameters[p].coverage95)) {
                sum.intervals += cell->parameters[p].intervals;
                sum.held += cell->parameters[p].intervals * cell->parameters[p].coverage95;
            }
        if (cell->reached_best != ROTID_NONE) {
            sum.starts += cell->runs;
            sum.reached += cell->reached_best;
        }
        sum.not_converged += cell->not_converged;
        const int *scores = summary_is_scored(cell) ? cell->diagnoses->scores : NULL;
        for (int k = 0; k < STUDY_SCORES && scores; k++) {
            sum.scored += scores[k];
            sum.good += k == 0 || k == 2 || k == 3 ? scores[k] : 0;
            sum.false_alarm += k == 1 || k == 7 ? scores[k] : 0;
        }
    }
    return sum;
}

struct shown shown_of_study(struct pool *pool, const struct study_result *s)
{
    const struct shares sum = add_up(s);
    struct shown shown = {
        .said.pool = pool,
        .table = {table_of_cells(pool, s), table_of_cell_parameters(pool, s), table_of_cell_diagnoses(pool, s)}};
    reasons_add(
        &shown.said, s->done < s->runs || s->failed > 0 || sum.not_converged > 0 ? TONE_CARE : TONE_NONE,
        "%s: %d of %d runs of %s%s in %d %s, %d failed, %.0f did not converge%s.", s->plan ? s->plan : "Decks as they stand",
        s->done, s->runs, s->studies, s->shards > 1 ? pool_text(pool, ", shard %d of %d,", s->shard, s->shards) : "", s->ncells,
        human_plural(s->ncells, "cell", "cells"), s->failed, sum.not_converged,
        s->done > 0 && isfinite(s->seconds) ? pool_text(pool, "; %s a run", human_seconds(pool, s->seconds / s->done)) : "");
    if (sum.starts > 0)
        reasons_say(&shown.said, "Of %.0f iterations from different starts %.0f end at the least functional of their cell.",
                    sum.starts, sum.reached);
    if (sum.intervals > 0)
        reasons_say(&shown.said, "Of %.0f 95\xc2\xa0%% intervals %s\xc2\xa0%% hold the truth.", sum.intervals,
                    human_fixed(pool, 100 * sum.held / sum.intervals, 1));
    if (sum.scored > 0)
        reasons_say(&shown.said,
                    "Of %.0f diagnoses %.0f are right, in the set, or correctly without a cause; %.0f name something else.",
                    sum.scored, sum.good, sum.false_alarm);
    for (int i = 0; i < s->nerrors && i < MOST_ERROR; i++)
        reasons_say(&shown.said, "%d failed, the first is run %d: %s", s->errors[i].runs, s->errors[i].first_run,
                    s->errors[i].error);
    if (s->nerrors > MOST_ERROR)
        reasons_say(&shown.said, "%d other reasons", s->nerrors - MOST_ERROR);
    if (s->done < s->runs)
        reasons_say(&shown.said, "%d runs are missing", s->missing);
    return shown;
}

void screen_study(const struct screen *to, const struct study_result *s)
{
    const struct shown shown = shown_of_study(to->pool, s);
    screen_shown(to, &shown);
}
