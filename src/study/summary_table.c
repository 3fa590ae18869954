#include <math.h>
#include <stdio.h>
#include <string.h>

#include "report/layout.h"
#include "study/summary.h"

#define WIDTH      100
#define WIDEST     28 /* of a column of names */
#define MOST_ERROR 10 /* different reasons that are listed */

enum { DECK, VARIANT, MODES, SENSORS, NOISE, HIDE, AXES };

static const char *const titles[AXES] = {"deck", "variant", "modes", "sensors", "noise", "hidden"};

/* Where a cell stands on an axis, "" where the plan does not have it. */
static const char *place(const struct summary_cell *cell, int axis, char room[64])
{
    const char *text = axis == DECK      ? cell->deck
                       : axis == VARIANT ? cell->variant
                       : axis == MODES   ? cell->modes
                       : axis == SENSORS ? cell->sensors
                       : axis == HIDE    ? cell->hide
                                         : NULL;
    if (axis != NOISE || !isfinite(cell->noise_frequency))
        return text ? text : "";
    if (isfinite(cell->noise_shape))
        (void)snprintf(room, 64, "%g, %g", cell->noise_frequency, cell->noise_shape);
    else
        (void)snprintf(room, 64, "%g", cell->noise_frequency);
    return room;
}

struct columns { /* those axes on which cells differ */
    int width[AXES];
    int parameter; /* width of their names */
    int has_truth, has_starts, has_holdout, has_diagnoses, has_scores;
};

static struct columns find_columns(const struct summary *s)
{
    struct columns c = {.parameter = (int)sizeof "parameter" - 1};
    for (int i = 0; i < s->ncell; i++) {
        const struct summary_cell *cell = &s->cell[i];
        char room[2][64];
        for (int a = 0; a < AXES; a++)
            if (strcmp(place(cell, a, room[0]), place(&s->cell[0], a, room[1])) != 0)
                c.width[a] = (int)strlen(titles[a]);
        for (int p = 0; p < cell->nparameter; p++) {
            int wide = text_columns(cell->parameter[p].name);
            c.has_truth |= cell->parameter[p].errors > 0;
            c.parameter = wide > c.parameter ? wide < WIDEST ? wide : WIDEST : c.parameter;
        }
        c.has_starts |= cell->last_start > 0;
        c.has_holdout |= cell->held_out > 0;
        c.has_diagnoses |= cell->judged > 0;
        c.has_scores |= cell->scored > 0;
    }
    for (int i = 0; i < s->ncell; i++)
        for (int a = 0; a < AXES; a++) {
            char room[64];
            int wide = text_columns(place(&s->cell[i], a, room));
            if (c.width[a] && wide > c.width[a])
                c.width[a] = wide < WIDEST ? wide : WIDEST;
        }
    return c;
}

static void print_head(FILE *out, const struct summary *s, const struct columns *c)
{
    char room[64];
    int any = 0;
    (void)fputs("study ", out);
    name_cell(out, 0, s->header.plan ? s->header.plan : "of decks");
    (void)fprintf(out, ": %ld of %ld runs of ", s->there, s->wanted);
    name_cell(out, 0, s->header.studies);
    if (s->header.shards > 1)
        (void)fprintf(out, ", shard %d of %d", s->header.shard, s->header.shards);
    (void)fprintf(out, ", %ld failed", s->failed);
    if (s->there)
        (void)fprintf(out, ", %.3g s each", s->seconds / (double)s->there);
    (void)fputc('\n', out);
    for (int a = 0; a < AXES && s->ncell; a++) {
        const char *text = place(&s->cell[0], a, room);
        if (c->width[a] || !*text)
            continue;
        (void)fprintf(out, "%s%s ", any++ ? ", " : "", titles[a]);
        name_cell(out, 0, text);
    }
    (void)fputs(any ? "\n\n" : "\n", out);
}

static void print_place(FILE *out, const struct columns *c, const struct summary_cell *cell)
{
    char room[64];
    for (int a = 0; a < AXES; a++)
        if (c->width[a]) {
            text_cell(out, c->width[a], cell ? place(cell, a, room) : titles[a]);
            (void)fputs("  ", out);
        }
}

static void print_blank(FILE *out, const struct columns *c)
{
    for (int a = 0; a < AXES; a++)
        if (c->width[a])
            (void)fprintf(out, "%*s", c->width[a] + 2, "");
}

static void print_parameter(FILE *out, const struct columns *c, const struct summary_parameter *p)
{
    (void)fputs("  ", out);
    text_cell(out, c->parameter, p->name);
    digits_cell(out, 13, 6, p->count ? p->mean : NAN);
    digits_cell(out, 10, 3, p->errors ? summary_std_error(p) : summary_std(p));
    digits_cell(out, 10, 3, summary_mean_std(p));
    if (c->has_truth) {
        digits_cell(out, 11, 3, summary_bias(p));
        number_cell(out, 7, 1, 100 * summary_coverage(p));
    }
}

static void print_cells(FILE *out, const struct summary *s, const struct columns *c)
{
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%5s%6s%8s%s%s%9s  %-*s%13s%10s%10s%s\n", "runs", "fail", "bound", "no conv",
                  c->has_starts ? "  at best" : "", c->has_holdout ? "    held" : "", "rms[%]", c->parameter, "parameter", "mean",
                  "std", "stated", c->has_truth ? "       bias in95%" : "");
    for (int i = 0; i < s->ncell; i++) {
        const struct summary_cell *cell = &s->cell[i];
        print_place(out, c, cell);
        (void)fprintf(out, "%6ld%5ld%6ld%8ld", cell->runs, cell->failed, cell->at_bound, cell->not_converged);
        if (c->has_starts)
            (void)fprintf(out, "%9ld", cell->reached);
        if (c->has_holdout)
            number_cell(out, 8, 3, cell->held_out ? sqrt(cell->held_out_square / (double)cell->held_out) : NAN);
        number_cell(out, 9, 3, cell->fitted ? sqrt(cell->fitted_square / (double)cell->fitted) : NAN);
        for (int p = 0; p < cell->nparameter; p++) {
            if (p) {
                print_blank(out, c);
                (void)fprintf(out, "%*s", 34 + (c->has_starts ? 9 : 0) + (c->has_holdout ? 8 : 0), "");
            }
            print_parameter(out, c, &cell->parameter[p]);
            (void)fputc('\n', out);
        }
        if (!cell->nparameter)
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

static void print_diagnoses(FILE *out, const struct summary *s, const struct columns *c)
{
    (void)fputc('\n', out);
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%10s%7s%11s%13s  %s\n", "runs", "adequate", "named", "ambiguous", "unexplained",
                  "causes and faults named");
    for (int i = 0; i < s->ncell; i++) {
        const struct summary_cell *cell = &s->cell[i];
        print_place(out, c, cell);
        (void)fprintf(out, "%6ld%10ld%7ld%11ld%13ld ", cell->judged, cell->verdict[VERDICT_ADEQUATE],
                      cell->verdict[VERDICT_NAMED], cell->verdict[VERDICT_AMBIGUOUS], cell->verdict[VERDICT_UNEXPLAINED]);
        for (int k = 0; k < cell->ncause; k++) {
            (void)fputs(k ? ", " : " ", out);
            name_cell(out, 0, cell->cause[k].id);
            (void)fprintf(out, " %ld", cell->cause[k].runs);
        }
        (void)fputc('\n', out);
    }
}

static void print_scores(FILE *out, const struct summary *s, const struct columns *c)
{
    (void)fputc('\n', out);
    print_place(out, c, NULL);
    (void)fprintf(out, "%6s%7s%8s%11s%8s%13s%7s%8s%13s%14s\n", "runs", "right", "in set", "other set", "silent", "unexplained",
                  "wrong", "quiet", "false alarm", "false faults");
    for (int i = 0; i < s->ncell; i++) {
        const struct summary_cell *cell = &s->cell[i];
        const long *n = cell->score;
        print_place(out, c, cell);
        (void)fprintf(out, "%6ld%7ld%8ld%11ld%8ld%13ld%7ld%8ld%13ld%14ld\n", cell->scored, n[SCORE_RIGHT], n[SCORE_IN_SET],
                      n[SCORE_OTHER_SET], n[SCORE_SILENT], n[SCORE_UNEXPLAINED], n[SCORE_WRONG], n[SCORE_QUIET],
                      n[SCORE_FALSE_ALARM], cell->false_faults);
    }
}

void summary_table(FILE *out, const struct summary *s)
{
    const struct columns c = find_columns(s);
    print_head(out, s, &c);
    if (s->ncell)
        print_cells(out, s, &c);
    if (c.has_diagnoses)
        print_diagnoses(out, s, &c);
    if (c.has_scores)
        print_scores(out, s, &c);
    if (s->nerror)
        (void)fputc('\n', out);
    for (int i = 0; i < s->nerror && i < MOST_ERROR; i++) {
        char head[64];
        (void)snprintf(head, sizeof head, "failed %ld, first run %ld: ", s->error[i].runs, s->error[i].first);
        wrap_text(out, 4, WIDTH, head, s->error[i].text);
    }
    if (s->nerror > MOST_ERROR)
        (void)fprintf(out, "and %d other reasons\n", s->nerror - MOST_ERROR);
    if (s->there < s->wanted)
        (void)fprintf(out, "\n%ld runs are missing\n", s->wanted - s->there);
}
