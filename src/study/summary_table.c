#include <math.h>
#include <stdio.h>
#include <string.h>

#include "report/report.h"
#include "study/study.h"

#define WIDTH      100
#define WIDEST     28 /* of a column of names */
#define MOST_ERROR 10 /* different reasons that are listed */

enum { DECK, VARIANT, MODES, SENSORS, NOISE, HIDE, AXES };

static const char *const titles[AXES] = {"deck", "variant", "modes", "sensors", "noise", "hidden"};

/* Where a cell stands on an axis, "" where the plan does not have it. */
static const char *place(const struct study_cell_result *cell, int axis, char room[64])
{
    const char *text = axis == DECK      ? cell->cell.deck
                       : axis == VARIANT ? cell->cell.variant
                       : axis == MODES   ? cell->cell.modes
                       : axis == SENSORS ? cell->cell.sensors
                       : axis == HIDE    ? cell->cell.hide
                                         : NULL;
    if (axis != NOISE || !isfinite(cell->cell.noise_frequency))
        return text ? text : "";
    if (isfinite(cell->cell.noise_shape))
        (void)snprintf(room, 64, "%g, %g", cell->cell.noise_frequency, cell->cell.noise_shape);
    else
        (void)snprintf(room, 64, "%g", cell->cell.noise_frequency);
    return room;
}

static const struct cell_diagnoses none; /* of a cell that has none */

struct shown_columns { /* those axes on which cells differ */
    int width[AXES];
    int parameter; /* width of their names */
    int has_truth, has_starts, has_holdout, has_diagnoses, has_scores;
};

static struct shown_columns find_columns(const struct study_result *s)
{
    struct shown_columns c = {.parameter = (int)sizeof "parameter" - 1};
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        char room[2][64];
        for (int a = 0; a < AXES; a++)
            if (strcmp(place(cell, a, room[0]), place(&s->cells[0], a, room[1])) != 0)
                c.width[a] = (int)strlen(titles[a]);
        for (int p = 0; p < cell->nparameters; p++) {
            int wide = text_columns(cell->parameters[p].name);
            c.has_truth |= isfinite(cell->parameters[p].rms_error);
            c.parameter = wide > c.parameter ? wide < WIDEST ? wide : WIDEST : c.parameter;
        }
        c.has_starts |= cell->reached_best != ROTID_NONE;
        c.has_holdout |= isfinite(cell->holdout_frequency_rms_percent);
        c.has_diagnoses |= cell->diagnoses != NULL;
        c.has_scores |= summary_is_scored(cell);
    }
    for (int i = 0; i < s->ncells; i++)
        for (int a = 0; a < AXES; a++) {
            char room[64];
            int wide = text_columns(place(&s->cells[i], a, room));
            if (c.width[a] && wide > c.width[a])
                c.width[a] = wide < WIDEST ? wide : WIDEST;
        }
    return c;
}

static void print_head(FILE *out, const struct study_result *s, const struct shown_columns *c)
{
    char room[64];
    int any = 0;
    (void)fputs("study ", out);
    name_cell(out, 0, s->plan ? s->plan : "of decks");
    (void)fprintf(out, ": %d of %d runs of ", s->done, s->runs);
    name_cell(out, 0, s->studies);
    if (s->shards > 1)
        (void)fprintf(out, ", shard %d of %d", s->shard, s->shards);
    (void)fprintf(out, ", %d failed", s->failed);
    if (s->done)
        (void)fprintf(out, ", %.3g s each", s->seconds / (double)s->done);
    (void)fputc('\n', out);
    for (int a = 0; a < AXES && s->ncells; a++) {
        const char *text = place(&s->cells[0], a, room);
        if (c->width[a] || !*text)
            continue;
        (void)fprintf(out, "%s%s ", any++ ? ", " : "", titles[a]);
        name_cell(out, 0, text);
    }
    (void)fputs(any ? "\n\n" : "\n", out);
}

static void print_place(FILE *out, const struct shown_columns *c, const struct study_cell_result *cell)
{
    char room[64];
    for (int a = 0; a < AXES; a++)
        if (c->width[a]) {
            text_cell(out, c->width[a], cell ? place(cell, a, room) : titles[a]);
            (void)fputs("  ", out);
        }
}

static void print_blank(FILE *out, const struct shown_columns *c)
{
    for (int a = 0; a < AXES; a++)
        if (c->width[a])
            (void)fprintf(out, "%*s", c->width[a] + 2, "");
}

static void print_parameter(FILE *out, const struct shown_columns *c, const struct cell_parameter *p)
{
    (void)fputs("  ", out);
    text_cell(out, c->parameter, p->name);
    digits_cell(out, 13, 6, p->mean);
    digits_cell(out, 10, 3, isfinite(p->rms_error) ? p->std_error : p->std);
    digits_cell(out, 10, 3, p->mean_stated_std);
    if (c->has_truth) {
        digits_cell(out, 11, 3, p->bias);
        number_cell(out, 7, 1, 100 * p->coverage95);
    }
}

static void print_cells(FILE *out, const struct study_result *s, const struct shown_columns *c)
{
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%5s%6s%8s%8s%s%s%9s  %-*s%13s%10s%10s%s\n", "runs", "fail", "bound", "no conv", "not ad.",
                  c->has_starts ? "  at best" : "", c->has_holdout ? "    held" : "", "rms[%]", c->parameter, "parameter", "mean",
                  "std", "stated", c->has_truth ? "       bias in95%" : "");
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        print_place(out, c, cell);
        (void)fprintf(out, "%6d%5d%6d%8d%8d", cell->runs, cell->failed, cell->at_bound, cell->not_converged, cell->not_adequate);
        if (c->has_starts)
            (void)fprintf(out, "%9d", cell->reached_best == ROTID_NONE ? cell->converged + cell->at_bound : cell->reached_best);
        if (c->has_holdout)
            number_cell(out, 8, 3, cell->holdout_frequency_rms_percent);
        number_cell(out, 9, 3, cell->frequency_rms_percent);
        for (int p = 0; p < cell->nparameters; p++) {
            if (p) {
                print_blank(out, c);
                (void)fprintf(out, "%*s", 42 + (c->has_starts ? 9 : 0) + (c->has_holdout ? 8 : 0), "");
            }
            print_parameter(out, c, &cell->parameters[p]);
            (void)fputc('\n', out);
        }
        if (!cell->nparameters)
            (void)fputc('\n', out);
    }
    (void)fprintf(
        out, "\nrms: error of the fitted frequencies; std: scatter of the runs%s; stated: mean standard deviation of the fits\n",
        c->has_truth ? " about the truth" : "");
    if (c->has_holdout)
        (void)fputs("held: rms error [%] of the frequencies that were not fitted\n", out);
    if (c->has_truth)
        (void)fputs("bias: mean difference to the truth; in95%: share of the 95 % intervals that hold it [%]\n", out);
    if (c->has_starts)
        (void)fputs("at best: runs that came to the best objective of their replicate\n", out);
}

static void print_diagnoses(FILE *out, const struct study_result *s, const struct shown_columns *c)
{
    (void)fputc('\n', out);
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%10s%7s%11s%13s  %s\n", "runs", "adequate", "named", "ambiguous", "unexplained",
                  "causes and faults named");
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        const struct cell_diagnoses *d = cell->diagnoses ? cell->diagnoses : &none;
        print_place(out, c, cell);
        (void)fprintf(out, "%6d%10d%7d%11d%13d ", d->count, d->verdicts[ROTID_ADEQUATE], d->verdicts[ROTID_NAMED],
                      d->verdicts[ROTID_AMBIGUOUS], d->verdicts[ROTID_UNEXPLAINED]);
        for (int k = 0; k < d->nnamed; k++) {
            (void)fputs(k ? ", " : " ", out);
            name_cell(out, 0, d->named[k].name);
            (void)fprintf(out, " %.0f", d->named[k].value);
        }
        (void)fputc('\n', out);
    }
}

static void print_scores(FILE *out, const struct study_result *s, const struct shown_columns *c)
{
    (void)fputc('\n', out);
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%7s%8s%11s%8s%13s%7s%8s%13s%14s\n", "runs", "right", "in set", "other set", "silent", "unexplained",
                  "wrong", "quiet", "false alarm", "false faults");
    for (int i = 0; i < s->ncells; i++) {
        const struct study_cell_result *cell = &s->cells[i];
        const struct cell_diagnoses *d = summary_is_scored(cell) ? cell->diagnoses : &none;
        const int *n = d->scores;
        int scored = 0;
        for (int k = 0; k < SCORE_COUNT; k++)
            scored += n[k];
        print_place(out, c, cell);
        (void)fprintf(out, "%6d%7d%8d%11d%8d%13d%7d%8d%13d%14d\n", scored, n[SCORE_RIGHT], n[SCORE_IN_SET], n[SCORE_OTHER_SET],
                      n[SCORE_SILENT], n[SCORE_UNEXPLAINED], n[SCORE_WRONG], n[SCORE_QUIET], n[SCORE_FALSE_ALARM],
                      d->false_findings);
    }
}

void summary_table(FILE *out, const struct study_result *s)
{
    const struct shown_columns c = find_columns(s);
    print_head(out, s, &c);
    if (s->ncells)
        print_cells(out, s, &c);
    if (c.has_diagnoses)
        print_diagnoses(out, s, &c);
    if (c.has_scores)
        print_scores(out, s, &c);
    if (s->nerrors)
        (void)fputc('\n', out);
    for (int i = 0; i < s->nerrors && i < MOST_ERROR; i++) {
        char head[64];
        (void)snprintf(head, sizeof head, "failed %d, first run %d: ", s->errors[i].runs, s->errors[i].first_run);
        wrap_text(out, 4, WIDTH, head, s->errors[i].error);
    }
    if (s->nerrors > MOST_ERROR)
        (void)fprintf(out, "and %d other reasons\n", s->nerrors - MOST_ERROR);
    if (s->done < s->runs)
        (void)fprintf(out, "\n%d runs are missing\n", s->missing);
}
