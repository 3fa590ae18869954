/* The runs of a study out of its file of results, beside the summary that `rotid study` itself makes of that file. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "page/studied.h"
#include "study/summary.h"

#define MOST 1000000000

static int is_text(const struct json_place *at, const char *key, const char *text)
{
    struct json_place value;
    return place_find(at, key, PLACE_TEXT, &value) ? text && !strcmp(value.json->valuestring, text) : !text;
}

static int is_number(const struct json_place *at, const char *key, double number)
{
    double value = place_number_if(at, key);
    return value == number || (isnan(value) && isnan(number));
}

static int is_of(const struct json_place *axes, const struct told_cell *cell)
{
    return is_text(axes, "deck", cell->deck) && is_text(axes, "variant", cell->variant) && is_text(axes, "modes", cell->modes) &&
           is_text(axes, "sensors", cell->sensors) && is_text(axes, "hide", cell->hide) &&
           is_number(axes, "noise_frequency", cell->noise_frequency) && is_number(axes, "noise_shape", cell->noise_shape);
}

/* Runs of a cell mostly follow each other, so the cell of the last one is asked first. */
static int cell_of(const struct json_place *line, const struct study_outcome *out, int guess)
{
    struct json_place axes;
    if (!place_need(line, "cell", PLACE_OBJECT, &axes))
        return 0;
    for (int i = 0; i < out->ncell; i++) {
        int cell = (guess + i) % out->ncell;
        if (is_of(&axes, &out->cell[cell]))
            return cell;
    }
    place_wrong(&axes, "is none of those that the file has, expected one of them");
    return 0;
}

static enum told_status status_of(const struct json_place *line)
{
    static const char *const names[TOLD_STATUSES] = {"converged", "at_bound", "not_converged", "failed"};
    struct json_place at;
    if (!place_need(line, "status", PLACE_TEXT, &at))
        return TOLD_FAILED;
    for (int s = 0; s < TOLD_STATUSES; s++)
        if (!strcmp(names[s], at.json->valuestring))
            return (enum told_status)s;
    place_wrong(&at, "is '%s', expected converged, at_bound, not_converged or failed", at.json->valuestring);
    return TOLD_FAILED;
}

static void read_value(const struct json_place *item, struct run_value *value)
{
    struct json_place interval;
    int i = 0;
    value->value = place_number(item, "value");
    value->start = place_number(item, "start");
    value->std = place_number(item, "std");
    value->truth = place_number(item, "truth");
    if (!place_need(item, "ci95", PLACE_LIST, &interval))
        return;
    for (const cJSON *end = interval.json->child; end && i < 2; end = end->next)
        value->ci[i++] = cJSON_IsNumber(end) ? end->valuedouble : (double)NAN;
}

static void read_values(const struct json_place *line, const struct told_cell *cell, struct told_run *run)
{
    static const struct run_value nothing = {NAN, NAN, NAN, {NAN, NAN}, NAN};
    struct json_place list;
    run->value = POOL_ARRAY(line->reader->pool, struct run_value, cell->nparameter);
    if (!run->value) {
        line->reader->status = ROTID_ERROR_MEMORY;
        return;
    }
    for (int p = 0; p < cell->nparameter; p++)
        run->value[p] = nothing;
    (void)place_need(line, "parameters", PLACE_LIST, &list);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json; item = place_next(&item, PLACE_OBJECT)) {
        struct json_place name;
        if (!place_need(&item, "name", PLACE_TEXT, &name))
            continue;
        for (int p = 0; p < cell->nparameter; p++)
            if (!strcmp(cell->parameter[p].name, name.json->valuestring))
                read_value(&item, &run->value[p]);
    }
}

static void read_run(const struct json_place *line, const struct study_outcome *out, int guess, struct told_run *run)
{
    struct json_place list;
    run->cell = cell_of(line, out, guess);
    run->status = status_of(line);
    run->objective = NAN;
    if (run->status == TOLD_FAILED)
        return;
    run->objective = place_number(line, "objective");
    read_values(line, &out->cell[run->cell], run);
    int parameters = out->cell[run->cell].nparameter, numbers = place_list(line, "iterates", 0, -1, &run->iterate);
    run->niterate = parameters > 0 && numbers % parameters == 0 ? numbers / parameters : 0;
    (void)place_need(line, "modes", PLACE_LIST, &list);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json; item = place_next(&item, PLACE_OBJECT))
        run->fitted += !place_flag(&item, "holdout");
}

static struct study_outcome *summarise(const struct json_place *lines)
{
    const struct provenance nobody = {.command = "study", .version = "", .commit = "", .blas = ""};
    struct reader *reader = lines->reader;
    struct json_place root = {.reader = reader};
    struct summary summary;
    struct study_outcome *out = NULL;
    int status = summary_read(reader->pool, reader->file, reader->messages, &summary);
    if (status) {
        reader->status = status == ROTID_ERROR_MEMORY ? status : ROTID_ERROR_SYNTAX;
        return NULL;
    }
    char *text = summary_json(&nobody, &summary);
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    root.json = json;
    if (json)
        out = study_read(&root);
    else
        reader->status = ROTID_ERROR_MEMORY;
    cJSON_Delete(json);
    json_free(text);
    return out;
}

struct study_outcome *study_read_lines(const struct json_place *lines)
{
    struct reader *reader = lines->reader;
    struct study_outcome *out = summarise(lines);
    struct json_place line = {.reader = reader, .above = lines};
    char name[32];
    int number = 1;
    if (!out)
        return NULL;
    out->run = POOL_ARRAY(reader->pool, struct told_run, place_count(lines));
    if (!out->run)
        reader->status = ROTID_ERROR_MEMORY;
    line.key = name;
    for (const cJSON *json = lines->json->child ? lines->json->child->next : NULL;
         json && out->ncell && reader->status != ROTID_ERROR_MEMORY; json = json->next) {
        (void)snprintf(name, sizeof name, "line %d", ++number);
        line.json = json;
        if (!cJSON_IsObject(json))
            place_wrong(&line, "is no run, expected an object");
        else
            read_run(&line, out, out->nrun ? out->run[out->nrun - 1].cell : 0, &out->run[out->nrun]);
        out->nrun++;
    }
    return reader->status ? NULL : out;
}
