/* A study: the answer, cells and parameters. */
#include <math.h>
#include <string.h>

#include "page/page.h"
#include "report/report.h"
#include "study/study.h"

#define MOST_FAILURES 8

static int equal_texts(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

static int equal_numbers(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static const char *name_of_file(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* "orthotropic, modes 1-4": the parts that vary but one. NULL: memory is out. */
static const char *join(struct pool *pool, int count, const int *varies, const char *const part[], int but)
{
    const char *text = "";
    for (int i = 0; i < count && text; i++)
        if (varies[i] && part[i] && i != but)
            text = pool_format(pool, "%s%s%s", text, *text ? ", " : "", part[i]);
    return text;
}

/* What tells a cell from the others, "" where there is one. */
static const char **label_cells(struct pool *pool, const struct study_result *s)
{
    enum { DECK, VARIANT, MODES, SENSORS, HIDE, NOISE, AXES };
    int varies[AXES] = {0};
    const char **label = POOL_ARRAY(pool, const char *, s->ncells + 1);
    for (int i = 1; i < s->ncells; i++) {
        const struct study_axes *a = &s->cells[0].cell, *b = &s->cells[i].cell;
        varies[DECK] |= strcmp(a->deck, b->deck) != 0;
        varies[VARIANT] |= !equal_texts(a->variant, b->variant);
        varies[MODES] |= !equal_texts(a->modes, b->modes);
        varies[SENSORS] |= !equal_texts(a->sensors, b->sensors);
        varies[HIDE] |= !equal_texts(a->hide, b->hide);
        varies[NOISE] |= !equal_numbers(a->noise_frequency, b->noise_frequency) || !equal_numbers(a->noise_shape, b->noise_shape);
    }
    for (int i = 0; i < s->ncells && label; i++) {
        const struct study_axes *cell = &s->cells[i].cell;
        const char *noise = isfinite(cell->noise_shape)
                                ? pool_format(pool, "noise %g, %g", cell->noise_frequency, cell->noise_shape)
                                : pool_format(pool, "noise %g", cell->noise_frequency);
        const char *const part[AXES] = {name_of_file(cell->deck),
                                        cell->variant,
                                        pool_format(pool, "modes %s", cell->modes ? cell->modes : "all"),
                                        pool_format(pool, "sensors %s", cell->sensors ? cell->sensors : "all"),
                                        cell->hide,
                                        noise};
        label[i] = or_nothing(join(pool, AXES, varies, part, AXES));
        label[i] = *label[i] ? label[i] : cell->deck;
    }
    return label;
}

/* Shares over all cells that have them: intervals that hold the truth, starts that came to the best. */
struct shares {
    double intervals, held, starts, reached, judged, good, scored, false_alarm;
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
        sum.judged += cell->diagnoses ? cell->diagnoses->count : 0;
        const int *scores = summary_is_scored(cell) ? cell->diagnoses->scores : NULL;
        for (int k = 0; k < STUDY_SCORES && scores; k++) {
            sum.scored += scores[k];
            sum.good += k == 0 || k == 2 || k == 3 ? scores[k] : 0;
            sum.false_alarm += k == 1 || k == 7 ? scores[k] : 0;
        }
    }
    return sum;
}

static double not_converged(const struct study_result *s)
{
    double count = 0;
    for (int i = 0; i < s->ncells; i++)
        count += s->cells[i].not_converged;
    return count;
}

static const char *runs_of(const struct study_result *s, double count)
{
    if (!strcmp(s->studies, "diagnose"))
        return count == 1 ? "diagnosis" : "diagnoses";
    return count == 1 ? "identification" : "identifications";
}

void answer_study(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct study_result *s = result->study;
    struct shares sum = add_up(s);
    double stuck = not_converged(s);
    const char *text = pool_format(pool, "%d %s: %s.", s->done, runs_of(s, s->done),
                                   or_nothing(s->failed > 0 || stuck > 0
                                                  ? pool_format(pool, "%d failed, %.0f did not converge", s->failed, stuck)
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
    if (s->plan)
        document->title = or_nothing(pool_format(pool, "Study %s", strrchr(s->plan, '/') ? strrchr(s->plan, '/') + 1 : s->plan));
    document->now.tone = s->done < s->runs || s->failed > 0 || stuck > 0 ? TONE_CARE : TONE_NONE;
    document->now.headline =
        s->done < s->runs ? pool_format(pool, "%d of %d runs", s->done, s->runs) : pool_format(pool, "%d runs", s->done);
    document->now.text = or_nothing(text);
}

static double above_rounding(double value, double rounding)
{
    return fabs(value) < rounding ? 0 : value;
}

#define ROUNDING 1e-9 /* relative, or of an error in per cent: below it stands nothing but that */

static struct table *cells_of(struct pool *pool, const struct study_result *s, const char *const label[])
{
    struct table *table = table_open(pool, "Cells: runs that differ in replicate and start alone");
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        table_row(table);
        text_column(table, "cell", SHOW_TEXT, label[i]);
        number_column(table, "runs", NULL, SHOW_COUNT, cell->runs);
        number_column(table, "failed", NULL, SHOW_COUNT, cell->failed);
        number_column(table, "at a bound", NULL, SHOW_COUNT, cell->at_bound);
        number_column(table, "not converged", NULL, SHOW_COUNT, cell->not_converged);
        number_column(table, "at the best", NULL, SHOW_COUNT,
                      cell->reached_best == ROTID_NONE ? (double)NAN : cell->reached_best);
        number_column(table, "error, fitted", "%", SHOW_DIGITS(3), above_rounding(cell->frequency_rms_percent, ROUNDING));
        number_column(table, "error, held out", "%", SHOW_DIGITS(3),
                      above_rounding(cell->holdout_frequency_rms_percent, ROUNDING));
        number_column(table, "evaluations", NULL, SHOW_DIGITS(3), cell->evaluations);
    }
    return table;
}

static struct table *parameters_of(struct pool *pool, const struct study_result *s, const char *const label[])
{
    struct table *table = table_open(pool, "Parameters by cells");
    for (int i = 0; i < s->ncells; i++)
        for (int p = 0; p < s->cells[i].nparameters; p++) {
            const struct cell_parameter *q = &s->cells[i].parameters[p];
            double scatter = isfinite(q->std_error) ? q->std_error : q->std;
            table_row(table);
            text_column(table, "cell", SHOW_TEXT, label[i]);
            text_column(table, "parameter", SHOW_TEXT, q->name);
            unit_column(table, q->mean, NAN, q->unit);
            number_column(table, "mean", ROW_UNIT, SHOW_DIGITS(5), q->mean);
            number_column(table, "scatter", ROW_UNIT, SHOW_DIGITS(2), above_rounding(scatter, 1e3 * ROUNDING * fabs(q->mean)));
            number_column(table, "stated deviation", ROW_UNIT, SHOW_DIGITS(2), q->mean_stated_std);
            number_column(table, "bias", ROW_UNIT, SHOW_DIGITS(2), q->bias);
            number_column(table, "95 % hold the truth", "%", SHOW_FIXED(1), 100 * q->coverage95);
        }
    return table;
}

void section_study(struct document *document, const struct result *result)
{
    const struct study_result *s = result->study;
    struct pool *pool = document->pool;
    const char **label = label_cells(pool, s);
    if (!label) {
        document->failed = 1;
        return;
    }
    document_section(document, "study", "The study");
    document_paragraph(document, "%s: %d of %d %s in %d %s%s.", s->plan ? s->plan : "Decks as they stand", s->done, s->runs,
                       runs_of(s, s->runs), s->ncells, human_plural(s->ncells, "cell", "cells"),
                       isfinite(s->seconds) && s->done > 0
                           ? or_nothing(pool_format(pool, "; %s a run", human_seconds(pool, s->seconds / s->done)))
                           : "");
    if (!cJSON_IsArray(result->json) && s->done > 0)
        document_paragraph(
            document,
            "%s is a summary. The file of results itself (.jsonl) holds the single runs, of which more figures are "
            "made: starts and ends, what depends on the number of modes, errors of the runs.",
            result->file);
    for (int i = 0; i < s->nerrors && i < MOST_FAILURES; i++)
        document_paragraph(document, "%d failed: %s", s->errors[i].runs, s->errors[i].error);
    document_figures(document, "study");
    if (!s->ncells)
        return;
    document_table(document, cells_of(pool, s, label));
    document_table(document, parameters_of(pool, s, label));
}
