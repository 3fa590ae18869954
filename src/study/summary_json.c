#include <math.h>

#include "result/json_tree.h"
#include "study/summary.h"

static double share(double sum, long count)
{
    return count ? sum / (double)count : NAN;
}

static void add_parameters(struct json_tree *tree, cJSON *object, const struct summary_cell *cell)
{
    cJSON *list = json_array(tree, object, "parameters");
    for (int i = 0; i < cell->nparameter; i++) {
        const struct summary_parameter *p = &cell->parameter[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", p->name);
        json_text(tree, item, "unit", p->unit);
        json_number(tree, item, "count", (double)p->count);
        json_number(tree, item, "mean", p->count ? p->mean : NAN);
        json_number(tree, item, "std", summary_std(p));
        json_number(tree, item, "min", p->smallest);
        json_number(tree, item, "max", p->largest);
        json_number(tree, item, "mean_stated_std", summary_mean_std(p));
        json_number(tree, item, "bias", summary_bias(p));
        json_number(tree, item, "std_error", summary_std_error(p));
        json_number(tree, item, "rms_error", summary_rms_error(p));
        json_number(tree, item, "intervals", (double)p->intervals);
        json_number(tree, item, "coverage95", summary_coverage(p));
    }
}

static void add_diagnoses(struct json_tree *tree, cJSON *object, const struct summary_cell *cell)
{
    if (!cell->judged) {
        json_null(tree, object, "diagnoses");
        return;
    }
    cJSON *diagnoses = json_object(tree, object, "diagnoses"), *verdicts, *scores, *named;
    json_number(tree, diagnoses, "count", (double)cell->judged);
    verdicts = json_object(tree, diagnoses, "verdicts");
    for (int k = VERDICT_ADEQUATE; k <= VERDICT_UNEXPLAINED; k++)
        json_number(tree, verdicts, verdict_name((enum verdict_kind)k), (double)cell->verdict[k]);
    named = json_object(tree, diagnoses, "named");
    for (int i = 0; i < cell->ncause; i++)
        json_number(tree, named, cell->cause[i].id, (double)cell->cause[i].runs);
    if (cell->scored) {
        scores = json_object(tree, diagnoses, "scores");
        for (int s = 0; s < SCORE_COUNT; s++)
            json_number(tree, scores, score_name((enum score)s), (double)cell->score[s]);
    } else {
        json_null(tree, diagnoses, "scores");
    }
    json_number(tree, diagnoses, "false_findings", cell->scored ? (double)cell->false_faults : NAN);
}

static void add_cell(struct json_tree *tree, cJSON *list, const struct summary_cell *cell)
{
    cJSON *object = json_object(tree, list, NULL), *axes = json_object(tree, object, "cell");
    json_text(tree, axes, "deck", cell->deck);
    json_text(tree, axes, "variant", cell->variant);
    json_text(tree, axes, "modes", cell->modes);
    json_text(tree, axes, "sensors", cell->sensors);
    json_number(tree, axes, "noise_frequency", cell->noise_frequency);
    json_number(tree, axes, "noise_shape", cell->noise_shape);
    json_text(tree, axes, "hide", cell->hide);
    json_number(tree, object, "first_run", (double)cell->first);
    json_number(tree, object, "runs", (double)cell->runs);
    json_number(tree, object, "converged", (double)cell->converged);
    json_number(tree, object, "at_bound", (double)cell->at_bound);
    json_number(tree, object, "not_converged", (double)cell->not_converged);
    json_number(tree, object, "failed", (double)cell->failed);
    json_number(tree, object, "reached_best", cell->last_start ? (double)cell->reached : NAN);
    add_parameters(tree, object, cell);
    json_number(tree, object, "frequency_rms_percent", sqrt(share(cell->fitted_square, cell->fitted)));
    json_number(tree, object, "holdout_frequency_rms_percent", sqrt(share(cell->held_out_square, cell->held_out)));
    json_number(tree, object, "chi2_per_dof", share(cell->chi2_sum, cell->chi2s));
    json_number(tree, object, "evaluations", share(cell->evaluations, cell->runs - cell->failed));
    add_diagnoses(tree, object, cell);
    json_number(tree, object, "seconds", cell->seconds);
}

char *summary_json(const struct provenance *provenance, const struct summary *s)
{
    struct json_tree tree;
    json_open(&tree);
    json_provenance(&tree, provenance);
    json_text(&tree, tree.root, "results", s->path);
    json_text(&tree, tree.root, "plan", s->header.plan);
    json_text(&tree, tree.root, "studies", s->header.studies);
    json_number(&tree, tree.root, "shard", s->header.shard);
    json_number(&tree, tree.root, "shards", s->header.shards);
    json_number(&tree, tree.root, "runs", (double)s->wanted);
    json_number(&tree, tree.root, "done", (double)s->there);
    json_number(&tree, tree.root, "missing", (double)(s->wanted - s->there));
    json_number(&tree, tree.root, "failed", (double)s->failed);
    cJSON *cells = json_array(&tree, tree.root, "cells"), *errors = json_array(&tree, tree.root, "errors");
    for (int i = 0; i < s->ncell; i++)
        add_cell(&tree, cells, &s->cell[i]);
    for (int i = 0; i < s->nerror; i++) {
        cJSON *item = json_object(&tree, errors, NULL);
        json_text(&tree, item, "error", s->error[i].text);
        json_number(&tree, item, "runs", (double)s->error[i].runs);
        json_number(&tree, item, "first_run", (double)s->error[i].first);
    }
    json_number(&tree, tree.root, "seconds", s->seconds);
    return json_close(&tree);
}
