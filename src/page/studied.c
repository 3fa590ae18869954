#include "page/studied.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "result/records.h"
#include "study/summary.h"

static int equal_texts(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

static int equal_numbers(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

int study_same_but_modes(const struct study_axes *a, const struct study_axes *b)
{
    struct study_axes like = *b;
    like.modes = a->modes;
    return summary_same_cell(a, &like);
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
    for (int i = 1; i < out->is.ncells; i++) {
        const struct study_axes *a = &out->is.cells[0].cell, *b = &out->is.cells[i].cell;
        varies[DECK] |= strcmp(a->deck, b->deck) != 0;
        varies[VARIANT] |= !equal_texts(a->variant, b->variant);
        varies[MODES] |= !equal_texts(a->modes, b->modes);
        varies[SENSORS] |= !equal_texts(a->sensors, b->sensors);
        varies[HIDE] |= !equal_texts(a->hide, b->hide);
        varies[NOISE] |= !equal_numbers(a->noise_frequency, b->noise_frequency) || !equal_numbers(a->noise_shape, b->noise_shape);
    }
    out->cell = POOL_ARRAY(pool, struct told_cell, out->is.ncells);
    for (int i = 0; i < out->is.ncells; i++) {
        if (!out->cell)
            return ROTID_ERROR_MEMORY;
        out->cell[i].is = out->is.cells[i];
        struct told_cell *told = &out->cell[i];
        const struct study_axes *cell = &out->is.cells[i].cell;
        const char *noise = isfinite(cell->noise_shape)
                                ? pool_format(pool, "noise %g, %g", cell->noise_frequency, cell->noise_shape)
                                : pool_format(pool, "noise %g", cell->noise_frequency),
                   *modes = pool_format(pool, "modes %s", cell->modes ? cell->modes : "all"),
                   *sensors = pool_format(pool, "sensors %s", cell->sensors ? cell->sensors : "all");
        const char *const part[AXES] = {name_of_file(cell->deck), cell->variant, modes, sensors, cell->hide, noise};
        told->label = join(pool, AXES, varies, part, AXES);
        told->but_modes = join(pool, AXES, varies, part, MODES);
        if (!told->label || !told->but_modes || !noise || !modes || !sensors)
            return ROTID_ERROR_MEMORY;
    }
    return out->cell ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Names that stand twice would be drawn twice. */
static void check_names(const struct json_place *root, const struct study_result *is)
{
    struct json_place cells, parameters;
    if (!place_find(root, "cells", PLACE_LIST, &cells))
        return;
    for (struct json_place cell = place_first(&cells, PLACE_OBJECT); cell.json; cell = place_next(&cell, PLACE_OBJECT)) {
        const struct study_cell_result *now = &is->cells[cell.index];
        if (!place_find(&cell, "parameters", PLACE_LIST, &parameters))
            return;
        for (struct json_place item = place_first(&parameters, PLACE_OBJECT); item.json; item = place_next(&item, PLACE_OBJECT))
            for (int k = 0; k < item.index; k++)
                if (!strcmp(now->parameters[k].name, now->parameters[item.index].name)) {
                    place_wrong(&item, "name: is '%s' as in parameters[%d], expected each parameter once",
                                now->parameters[k].name, k);
                    break;
                }
    }
}

struct study_outcome *study_read(const struct json_place *root)
{
    struct reader *reader = root->reader;
    struct study_outcome *out = POOL_NEW(reader->pool, struct study_outcome);
    if (!out) {
        reader->status = ROTID_ERROR_MEMORY;
        return NULL;
    }
    record_read(root, &study_record, &out->is);
    if (!reader->status)
        check_names(root, &out->is);
    if (!reader->status)
        reader->status = name_cells(reader->pool, out);
    return reader->status ? NULL : out;
}

/* Runs of a cell mostly follow each other, so the cell of the last one is asked first. */
static int cell_of(const struct json_place *line, const struct study_outcome *out, const struct study_run *said, int guess)
{
    for (int i = 0; i < out->is.ncells; i++) {
        int cell = (guess + i) % out->is.ncells;
        if (summary_same_cell(&said->cell, &out->is.cells[cell].cell))
            return cell;
    }
    place_wrong(line, "cell: is none of those that the file has, expected one of them");
    return 0;
}

/* The parameters of a run in the order of its cell. */
static struct run_parameter *values_of(struct pool *pool, const struct run_fit *fit, const struct study_cell_result *cell)
{
    static const struct run_parameter nothing = {.value = NAN, .start = NAN, .std = NAN, .ci95 = {NAN, NAN}, .truth = NAN};
    struct run_parameter *value = POOL_ARRAY(pool, struct run_parameter, cell->nparameters);
    for (int p = 0; p < cell->nparameters && value; p++) {
        value[p] = nothing;
        for (int k = 0; k < fit->nparameters; k++)
            if (!strcmp(cell->parameters[p].name, fit->parameters[k].name))
                value[p] = fit->parameters[k];
    }
    return value;
}

static void read_run(const struct json_place *line, const struct study_outcome *out, int guess, struct told_run *run)
{
    struct study_run said = {0};
    record_read(line, &study_run_record, &said);
    if (line->reader->status)
        return;
    *run = (struct told_run){.cell = cell_of(line, out, &said, guess), .status = said.status, .objective = NAN};
    if (!said.fit)
        return;
    const struct study_cell_result *cell = &out->is.cells[run->cell];
    run->objective = said.fit->objective;
    run->value = values_of(line->reader->pool, said.fit, cell);
    if (!run->value)
        line->reader->status = ROTID_ERROR_MEMORY;
    if (cell->nparameters > 0 && said.niterates % cell->nparameters == 0) {
        run->niterate = said.niterates / cell->nparameters;
        run->iterate = said.iterates;
    }
    for (int k = 0; k < said.fit->nmodes; k++)
        run->fitted += !said.fit->modes[k].holdout;
}

struct study_outcome *study_read_lines(const struct json_place *lines)
{
    struct reader *reader = lines->reader;
    struct study_outcome *out = POOL_NEW(reader->pool, struct study_outcome);
    struct json_place line = {.reader = reader, .above = lines};
    struct header header;
    char name[32];
    int number = 1,
        status = out ? summary_read(reader->pool, reader->file, reader->messages, &header, &out->is) : ROTID_ERROR_MEMORY;
    if (!status)
        status = name_cells(reader->pool, out);
    if (!status && !(out->run = POOL_ARRAY(reader->pool, struct told_run, place_count(lines))))
        status = ROTID_ERROR_MEMORY;
    if (status) {
        reader->status = status == ROTID_ERROR_MEMORY ? status : ROTID_ERROR_SYNTAX;
        return NULL;
    }
    line.key = name;
    for (const cJSON *json = lines->json->child ? lines->json->child->next : NULL;
         json && out->is.ncells && reader->status != ROTID_ERROR_MEMORY; json = json->next) {
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
