/* A study: the answer and its sections. */
#include <math.h>
#include <string.h>

#include "page/cause_words.h"
#include "page/figures_study.h"
#include "page/human.h"
#include "page/sections.h"
#include "study/summary.h"

#define MOST_FAILURES 8

static const char *or_nothing(const char *text)
{
    return text ? text : "";
}

/* Shares over all cells that have them: intervals that hold the truth, starts that came to the best. */
struct shares {
    double intervals, held, starts, reached, judged, good, scored, false_alarm;
};

static struct shares add_up(const struct study_outcome *s)
{
    struct shares sum = {0};
    for (int i = 0; i < s->is.ncells; i++) {
        const struct told_cell *cell = &s->cell[i];
        for (int p = 0; p < cell->is.nparameters; p++)
            if (isfinite(cell->is.parameters[p].coverage95)) {
                sum.intervals += cell->is.parameters[p].intervals;
                sum.held += cell->is.parameters[p].intervals * cell->is.parameters[p].coverage95;
            }
        if (cell->is.reached_best != ROTID_NONE) {
            sum.starts += cell->is.runs;
            sum.reached += cell->is.reached_best;
        }
        sum.judged += cell->is.diagnoses ? cell->is.diagnoses->count : 0;
        const int *scores = summary_is_scored(&cell->is) ? cell->is.diagnoses->scores : NULL;
        for (int k = 0; k < STUDY_SCORES && scores; k++) {
            sum.scored += scores[k];
            sum.good += k == 0 || k == 2 || k == 3 ? scores[k] : 0;
            sum.false_alarm += k == 1 || k == 7 ? scores[k] : 0;
        }
    }
    return sum;
}

static double not_converged(const struct study_outcome *s)
{
    double count = 0;
    for (int i = 0; i < s->is.ncells; i++)
        count += s->cell[i].is.not_converged;
    return count;
}

static const char *runs_of(const struct study_outcome *s, double count)
{
    if (!strcmp(s->is.studies, "diagnose"))
        return count == 1 ? "diagnosis" : "diagnoses";
    return count == 1 ? "identification" : "identifications";
}

void answer_study(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct study_outcome *s = result->studied;
    struct shares sum = add_up(s);
    double stuck = not_converged(s);
    const char *text = pool_format(pool, "%d %s: %s.", s->is.done, runs_of(s, s->is.done),
                                   or_nothing(s->is.failed > 0 || stuck > 0
                                                  ? pool_format(pool, "%d failed, %.0f did not converge", s->is.failed, stuck)
                                                  : "none failed, all converged"));
    if (sum.starts > 0 && text)
        text =
            sum.reached == sum.starts
                ? pool_format(pool, "%s Every start leads to the same minimum in its cell.", text)
                : pool_format(pool, "%s Of %.0f iterations from different starts %.0f end at the least functional of their cell.",
                              text, sum.starts, sum.reached);
    if (sum.intervals > 0 && text)
        text = pool_format(pool, "%s Of %.0f 95\xc2\xa0%% intervals %s\xc2\xa0%% hold the truth.", text, sum.intervals,
                           human_fixed(pool, 100 * sum.held / sum.intervals, 1));
    if (sum.scored > 0 && text)
        text = pool_format(pool, "%s Of %.0f diagnoses %.0f are right, in the set, or rightly quiet; %.0f name something else.",
                           text, sum.scored, sum.good, sum.false_alarm);
    if (s->is.plan)
        document->title =
            or_nothing(pool_format(pool, "Study %s", strrchr(s->is.plan, '/') ? strrchr(s->is.plan, '/') + 1 : s->is.plan));
    document->tone = s->is.done < s->is.runs || s->is.failed > 0 || stuck > 0 ? TONE_CARE : TONE_NONE;
    document->headline = s->is.done < s->is.runs ? pool_format(pool, "%d of %d runs", s->is.done, s->is.runs)
                                                 : pool_format(pool, "%d runs", s->is.done);
    document->answer = or_nothing(text);
}

#define ROUNDING 1e-9 /* relative, or of an error in per cent: below it stands nothing but that */

/* The table without the columns that hold nothing but dashes. */
static struct number_table *without_empty(struct pool *pool, const struct number_table *table)
{
    int count = 0, *shown = table ? POOL_ARRAY(pool, int, table->columns) : NULL;
    if (!shown)
        return NULL;
    for (int j = 0; j < table->columns; j++) {
        int filled = !table->rows || !j;
        for (int i = 0; i < table->rows; i++)
            filled |= strcmp(table->cell[i * table->columns + j], human_fixed(pool, NAN, 0)) != 0;
        if (filled)
            shown[count++] = j;
    }
    struct number_table *less = table_new(pool, table->rows, count);
    for (int j = 0; j < count; j++) {
        table_head(less, j, table->head[shown[j]]);
        for (int i = 0; i < table->rows; i++)
            table_cell(less, i, j, table->cell[i * table->columns + shown[j]]);
    }
    return less;
}

static const char *digits_above(struct pool *pool, double value, int digits, double rounding)
{
    return human_digits(pool, fabs(value) < rounding ? 0 : value, digits);
}

static struct number_table *cells_table(struct pool *pool, const struct study_outcome *s)
{
    static const char *const head[] = {
        "cell",       "runs", "failed", "at a bound", "not converged", "at the best", "error, fitted [%]", "error, held out [%]",
        "evaluations"};
    enum { COLUMNS = sizeof head / sizeof *head };
    struct number_table *table = table_headed(pool, s->is.ncells, COLUMNS, head);
    for (int i = 0; i < s->is.ncells; i++) {
        const struct told_cell *cell = &s->cell[i];
        const double number[] = {cell->is.runs, cell->is.failed, cell->is.at_bound, cell->is.not_converged,
                                 cell->is.reached_best == ROTID_NONE ? (double)NAN : cell->is.reached_best};
        table_cell(table, i, 0, *cell->label ? cell->label : cell->is.cell.deck);
        for (int j = 0; j < 5; j++)
            table_cell(table, i, 1 + j, human_fixed(pool, number[j], 0));
        table_cell(table, i, 6, digits_above(pool, cell->is.frequency_rms_percent, 3, ROUNDING));
        table_cell(table, i, 7, digits_above(pool, cell->is.holdout_frequency_rms_percent, 3, ROUNDING));
        table_cell(table, i, 8, human_digits(pool, cell->is.evaluations, 3));
    }
    return without_empty(pool, table);
}

static struct number_table *parameters_table(struct pool *pool, const struct study_outcome *s)
{
    static const char *const head[] = {
        "cell", "parameter", "mean", "scatter", "stated deviation", "bias", "95 % hold the truth [%]"};
    enum { COLUMNS = sizeof head / sizeof *head };
    int rows = 0, row = 0;
    for (int i = 0; i < s->is.ncells; i++)
        rows += s->cell[i].is.nparameters;
    struct number_table *table = table_headed(pool, rows, COLUMNS, head);
    for (int i = 0; i < s->is.ncells; i++)
        for (int p = 0; p < s->cell[i].is.nparameters; p++, row++) {
            const struct cell_parameter *q = &s->cell[i].is.parameters[p];
            double scatter = isfinite(q->std_error) ? q->std_error : q->std;
            struct human_unit unit = human_unit(q->mean, q->unit);
            table_cell(table, row, 0, *s->cell[i].label ? s->cell[i].label : s->cell[i].is.cell.deck);
            table_cell(table, row, 1, *unit.text ? pool_format(pool, "%s [%s]", q->name, unit.text) : q->name);
            table_cell(table, row, 2, human_digits(pool, unit.factor * q->mean, 5));
            table_cell(table, row, 3, digits_above(pool, unit.factor * scatter, 2, 1e3 * ROUNDING * fabs(unit.factor * q->mean)));
            table_cell(table, row, 4, human_digits(pool, unit.factor * q->mean_stated_std, 2));
            table_cell(table, row, 5, human_digits(pool, unit.factor * q->bias, 2));
            table_cell(table, row, 6, human_fixed(pool, 100 * q->coverage95, 1));
        }
    return without_empty(pool, table);
}

void section_study(struct document *document, const struct result *result)
{
    const struct study_outcome *s = result->studied;
    struct pool *pool = document->pool;
    document_section(document, "study", "The study");
    document_paragraph(document, "%s: %d of %d %s in %d %s%s.", s->is.plan ? s->is.plan : "Decks as they stand", s->is.done,
                       s->is.runs, runs_of(s, s->is.runs), s->is.ncells, human_plural(s->is.ncells, "cell", "cells"),
                       isfinite(s->is.seconds) && s->is.done > 0
                           ? or_nothing(pool_format(pool, "; %s a run", human_seconds(pool, s->is.seconds / s->is.done)))
                           : "");
    if (!s->nrun && s->is.done > 0)
        document_paragraph(
            document,
            "%s is a summary. The file of results itself (.jsonl) holds the single runs, of which more figures are "
            "made: starts and ends, what depends on the number of modes, errors of the runs.",
            result->file);
    for (int i = 0; i < s->is.nerrors && i < MOST_FAILURES; i++)
        document_paragraph(document, "%s failed: %s", words_sentence(pool, human_count(pool, s->is.errors[i].runs)),
                           s->is.errors[i].error);
    figure_starts(document, result);
    figure_functional_by_modes(document, result);
    figure_parameters_by_modes(document, result);
    figure_errors_of_runs(document, result);
    figure_coverage(document, result);
    figure_verdicts(document, result);
    figure_decks(document, result);
    if (!s->is.ncells)
        return;
    document_table(document, "Cells: runs that differ in replicate and start alone", cells_table(pool, s));
    document_table(document, "Parameters by cells", parameters_table(pool, s));
}
