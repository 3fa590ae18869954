/* A study: the answer, cells and parameters. */
#include <math.h>
#include <string.h>

#include "page/page.h"
#include "report/report.h"
#include "study/study.h"

#define MOST_FAILURES 8

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
        text = pool_format(
            pool, "%s Of %.0f diagnoses %.0f are right, in the set, or correctly without a cause; %.0f name something else.",
            text, sum.scored, sum.good, sum.false_alarm);
    if (s->plan)
        document->title = or_nothing(pool_format(pool, "Study %s", strrchr(s->plan, '/') ? strrchr(s->plan, '/') + 1 : s->plan));
    document->now.tone = s->done < s->runs || s->failed > 0 || stuck > 0 ? TONE_CARE : TONE_NONE;
    document->now.headline =
        s->done < s->runs ? pool_format(pool, "%d of %d runs", s->done, s->runs) : pool_format(pool, "%d runs", s->done);
    document->now.text = or_nothing(text);
}

void section_study(struct document *document, const struct result *result)
{
    const struct study_result *s = result->study;
    struct pool *pool = document->pool;
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
    document_table(document, table_of_cells(pool, s));
    document_table(document, table_of_cell_parameters(pool, s));
    document_table(document, table_of_cell_diagnoses(pool, s));
}
