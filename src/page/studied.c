#include "page/studied.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const told_verdict_text[TOLD_VERDICTS] = {"adequate", "named", "ambiguous", "unexplained"};
const char *const told_score_text[TOLD_SCORES] = {"quiet",     "false_alarm", "right",       "in_set",
                                                  "other_set", "silent",      "unexplained", "wrong"};

static void read_axes(const struct json_place *at, struct told_cell *cell)
{
    struct json_place axes;
    (void)place_need(at, "cell", PLACE_OBJECT, &axes);
    cell->deck = place_string(&axes, "deck");
    cell->variant = place_string_if(&axes, "variant");
    cell->modes = place_string_if(&axes, "modes");
    cell->sensors = place_string_if(&axes, "sensors");
    cell->hide = place_string_if(&axes, "hide");
    cell->noise_frequency = place_number(&axes, "noise_frequency");
    cell->noise_shape = place_number(&axes, "noise_shape");
}

static void read_parameters(const struct json_place *at, struct told_cell *cell)
{
    struct json_place list;
    cell->parameter = place_items(at, "parameters", sizeof *cell->parameter, &list, &cell->nparameter);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && cell->parameter;
         item = place_next(&item, PLACE_OBJECT)) {
        struct cell_parameter *p = &cell->parameter[item.index];
        p->name = place_string(&item, "name");
        for (int k = 0; k < item.index; k++)
            if (cell->parameter[k].name && !strcmp(cell->parameter[k].name, p->name)) {
                place_wrong(&item, "name: is '%s' as in parameters[%d], expected each parameter once", p->name, k);
                break;
            }
        p->unit = place_string(&item, "unit");
        p->count = place_number(&item, "count");
        p->mean = place_number(&item, "mean");
        p->std = place_number(&item, "std");
        p->stated = place_number(&item, "mean_stated_std");
        p->bias = place_number(&item, "bias");
        p->std_error = place_number(&item, "std_error");
        p->intervals = place_number(&item, "intervals");
        p->coverage = place_number(&item, "coverage95");
    }
}

static void read_diagnoses(const struct json_place *at, struct told_cell *cell)
{
    struct json_place diagnoses, verdicts, scores;
    if (!place_find(at, "diagnoses", PLACE_OBJECT, &diagnoses))
        return;
    cell->judged = place_number(&diagnoses, "count");
    cell->false_findings = place_number(&diagnoses, "false_findings");
    (void)place_need(&diagnoses, "verdicts", PLACE_OBJECT, &verdicts);
    for (int k = 0; k < TOLD_VERDICTS; k++)
        cell->verdict[k] = place_number(&verdicts, told_verdict_text[k]);
    cell->scored = place_find(&diagnoses, "scores", PLACE_OBJECT, &scores);
    for (int s = 0; s < TOLD_SCORES && cell->scored; s++)
        cell->score[s] = place_number(&scores, told_score_text[s]);
}

static void read_cells(const struct json_place *root, struct study_outcome *out)
{
    struct json_place list;
    out->cell = place_items(root, "cells", sizeof *out->cell, &list, &out->ncell);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->cell;
         item = place_next(&item, PLACE_OBJECT)) {
        struct told_cell *cell = &out->cell[item.index];
        read_axes(&item, cell);
        cell->runs = place_number(&item, "runs");
        cell->converged = place_number(&item, "converged");
        cell->at_bound = place_number(&item, "at_bound");
        cell->not_converged = place_number(&item, "not_converged");
        cell->failed = place_number(&item, "failed");
        cell->reached_best = place_number(&item, "reached_best");
        cell->rms_percent = place_number(&item, "frequency_rms_percent");
        cell->held_percent = place_number(&item, "holdout_frequency_rms_percent");
        cell->evaluations = place_number(&item, "evaluations");
        read_parameters(&item, cell);
        read_diagnoses(&item, cell);
    }
}

int axis_same_text(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

int axis_same_number(double a, double b)
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

/* What varies among the cells, as the name of each. */
static int name_cells(struct pool *pool, struct study_outcome *out)
{
    enum { DECK, VARIANT, MODES, SENSORS, HIDE, NOISE, AXES };
    int varies[AXES] = {0};
    for (int i = 1; i < out->ncell; i++) {
        const struct told_cell *a = &out->cell[0], *b = &out->cell[i];
        varies[DECK] |= !axis_same_text(a->deck, b->deck);
        varies[VARIANT] |= !axis_same_text(a->variant, b->variant);
        varies[MODES] |= !axis_same_text(a->modes, b->modes);
        varies[SENSORS] |= !axis_same_text(a->sensors, b->sensors);
        varies[HIDE] |= !axis_same_text(a->hide, b->hide);
        varies[NOISE] |=
            !axis_same_number(a->noise_frequency, b->noise_frequency) || !axis_same_number(a->noise_shape, b->noise_shape);
    }
    for (int i = 0; i < out->ncell; i++) {
        struct told_cell *cell = &out->cell[i];
        const char *noise = isfinite(cell->noise_shape)
                                ? pool_format(pool, "noise %g, %g", cell->noise_frequency, cell->noise_shape)
                                : pool_format(pool, "noise %g", cell->noise_frequency),
                   *modes = pool_format(pool, "modes %s", cell->modes ? cell->modes : "all"),
                   *sensors = pool_format(pool, "sensors %s", cell->sensors ? cell->sensors : "all");
        const char *const part[AXES] = {name_of_file(cell->deck), cell->variant, modes, sensors, cell->hide, noise};
        cell->label = join(pool, AXES, varies, part, AXES);
        cell->but_modes = join(pool, AXES, varies, part, MODES);
        if (!cell->label || !cell->but_modes || !noise || !modes || !sensors)
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

struct study_outcome *study_read(const struct json_place *root)
{
    struct reader *reader = root->reader;
    struct json_place list;
    struct study_outcome *out = POOL_NEW(reader->pool, struct study_outcome);
    if (!out) {
        reader->status = ROTID_ERROR_MEMORY;
        return NULL;
    }
    out->plan = place_string_if(root, "plan");
    out->studies = place_string(root, "studies");
    out->wanted = place_number(root, "runs");
    out->done = place_number(root, "done");
    out->failed = place_number(root, "failed");
    out->seconds = place_number(root, "seconds");
    read_cells(root, out);
    out->failure = place_items(root, "errors", sizeof *out->failure, &list, &out->nfailure);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->failure;
         item = place_next(&item, PLACE_OBJECT)) {
        out->failure[item.index].text = place_string(&item, "error");
        out->failure[item.index].runs = place_number(&item, "runs");
    }
    if (!reader->status)
        reader->status = name_cells(reader->pool, out);
    return reader->status ? NULL : out;
}
