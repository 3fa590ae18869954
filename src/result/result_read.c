#include "result/result.h"

#define MOST_SUM 1e9 /* over all places: an int holds it */

static void expect(const struct json_place *at, const char *what, int count, int expected, const char *as)
{
    if (count != expected)
        place_wrong(at, "%s has %d values, expected %d as %s", what, count, expected, as);
}

/* What a drawing rests on: nothing that is drawn to scale may lack a size. */
static void check_geometry(const struct json_place *root, const rotid_geometry *geometry)
{
    const struct json_place at = {.reader = root->reader, .above = root, .key = "geometry"};
    int good = geometry->length_m > 0;
    double elements = 0, members = 0;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int s = 0; s < geometry->groups[g].nsegments; s++) {
            const rotid_segment *segment = &geometry->groups[g].segments[s];
            good &=
                segment->to_m > segment->from_m &&
                (segment->height_m > 0 || (segment->outer_m > 0 && segment->inner_m >= 0 && segment->inner_m < segment->outer_m));
            elements += segment->elements;
        }
    for (int b = 0; b < geometry->ntierods; b++)
        members += geometry->tierods[b].number;
    for (int b = 0; b < geometry->nbars; b++)
        members += geometry->bars[b].number;
    if (fmax(elements, members) > MOST_SUM)
        place_wrong(&at, "has %.0f elements, %.0f tie rods and bars, expected fewer than %.0f", elements, members, MOST_SUM);
    if (!good)
        place_wrong(&at, "has a length or a section of no size, expected a rotor that can be drawn");
}

static void check_meridian(const struct json_place *at, const rotid_spectrum *modes)
{
    const rotid_meridian *meridian = modes->meridian;
    int corners = meridian ? meridian->nr_m : 0, groups = modes->geometry ? modes->geometry->ngroups : 0, good = 1;
    for (int e = 0; meridian && e < meridian->nelements; e++) {
        const rotid_meridian_element *element = &meridian->elements[e];
        good &= element->group >= 0 && element->group < groups;
        for (int c = 0; c < 4; c++)
            good &= element->corner[c] >= 0 && element->corner[c] < corners;
    }
    if (!good)
        place_wrong(at, "meridian.elements[] has a group or a corner that is none, expected less than %d and %d", groups,
                    corners);
    for (int j = 0; j < modes->nmodes; j++) {
        const rotid_meridian_mode *mode = modes->modes[j].meridian;
        if (!mode)
            continue;
        expect(at, "modes[].meridian.u", mode->nu, corners, "meridian.r_m");
        expect(at, "modes[].meridian.w", mode->nw, corners, "meridian.r_m");
        expect(at, "modes[].meridian.energy", mode->nenergy, meridian ? meridian->nelements : 0, "meridian.elements");
    }
}

static void check_fit(const struct json_place *at, const rotid_identification *fit)
{
    if ((fit->nco_matrix || fit->mac_matrix) && (!fit->matrix_rows || !fit->matrix_columns))
        place_wrong(at, "matrix_rows or matrix_columns is missing, expected the numbers of the modes in mac_matrix");
}

/* The candidates stand in the order of their rounds. */
static void check_rounds(const struct json_place *root, const rotid_diagnosis *d)
{
    for (int i = 0; i < d->ncandidates; i++) {
        int round = d->candidates[i].round, before = i ? d->candidates[i - 1].round : 1;
        if (round > d->nrounds)
            place_wrong(root, "candidates[%d].round: is %d, expected one of the %d rounds", i, round, d->nrounds);
        if (round < before)
            place_wrong(root, "candidates[%d].round: is %d behind candidates of a later one, expected them in order", i, round);
    }
}

static void check_diagnosis(const struct json_place *root, const rotid_diagnosis *d)
{
    const struct {
        const char *key;
        const rotid_identification *fit;
    } fits[] = {{"today", d->today}, {"base", d->base}, {"extended", d->extended}};
    for (size_t i = 0; i < sizeof fits / sizeof *fits; i++) {
        const struct json_place at = {.reader = root->reader, .above = root, .key = fits[i].key};
        if (fits[i].fit)
            check_fit(&at, fits[i].fit);
    }
    check_rounds(root, d);
    if (d->base && d->nmodes_standardised)
        expect(root, "modes_standardised", d->nmodes_standardised, d->base->nmodes, "base.modes");
}

/* What the lengths of its lists, the order of its candidates and the sizes of its rotor have to be for a result to be used: told
 * as a mistake of `root` where they are not. */
static void result_check(const struct json_place *root, const struct result *result)
{
    const rotid_geometry *geometry = geometry_of_result(result);
    if (root->reader->status)
        return;
    if (geometry)
        check_geometry(root, geometry);
    if (result->identify)
        check_fit(root, result->identify);
    if (result->diagnose)
        check_diagnosis(root, result->diagnose);
    if (result->modes)
        check_meridian(root, result->modes);
    for (int s = 0; s < result_states(result); s++) { /* as if it stood alone */
        const struct result own = result_of_state(root->reader->pool, result, s);
        result_check(root, &own);
    }
}

/* Keys that results have from 0.3 on, and what cannot be shown without them. */
static const struct {
    const char *command, *key, *shows;
} newer[] = {
    {"identify", "geometry", "the drawing of the rotor"},
    {"identify", "shapes", "the measured and predicted shapes"},
    {"identify", "mac_matrix", "the correlation of all measured with all predicted shapes"},
    {"diagnose", "geometry", "the drawing of the rotor and the places of the causes on it"},
    {"modes", "geometry", "the drawing of the rotor"},
    {"sensitivity", "functional_growth", "the growth of the two functionals"},
    {"check", "geometry", "the drawing of the rotor"},
};

/* "check, modes or study" */
static const char *list_commands(struct pool *pool)
{
    const char *text = "", *last = NULL;
    for (const struct result_kind *kind = result_kinds; kind->command; kind++) {
        if (!kind->has_page)
            continue;
        if (last)
            text = pool_text(pool, "%s%s%s", text, *text ? ", " : "", last);
        last = kind->command;
    }
    return pool_text(pool, "%s or %s", text, last);
}

static void read_root(const struct json_place *root, struct result *result)
{
    struct json_place at;
    const char *command;
    if (!cJSON_IsObject(root->json) || !place_has(root, "rotid") || !place_has(root, "command")) {
        place_wrong(root, "is no result of rotid, expected what a command writes with --json");
        return;
    }
    if (place_need(root, "schema", PLACE_NUMBER, &at) && at.json->valuedouble != 1)
        place_wrong(&at, "is %g, expected 1: made by another version of rotid than this one can read", at.json->valuedouble);
    command = place_string(root, "command");
    if (root->reader->status)
        return;
    const struct result_kind *kind = result_kind(command);
    if (!kind || !kind->has_page) {
        place_wrong(root, "command: is '%s', of which no page is made, expected %s", command, list_commands(root->reader->pool));
        return;
    }
    if (!strcmp(command, "study") && place_has(root, "digest") &&
        !place_has(root, "cells")) { /* the header, which stands alone before a run ends */
        place_wrong(root, "is the file of results of a study and holds no run yet, expected the line of a run at least");
        return;
    }
    record_read(root, &kind->record, NULL, result);
    if (root->reader->status)
        return;
    for (size_t i = 0; i < sizeof newer / sizeof *newer; i++)
        if (!strcmp(newer[i].command, command) && !place_has(root, newer[i].key) && result->nlacking < LACKING_MOST)
            result->lacking[result->nlacking++] = (struct lacking){newer[i].key, newer[i].shows};
    result_check(root, result);
}

int result_read(struct pool *pool, const char *file, struct message_list *messages, result_lines_reader *read_lines,
                struct result *result)
{
    struct reader reader = {.pool = pool, .messages = messages, .file = file};
    struct json_place root = {.reader = &reader};
    int is_lines;
    *result = (struct result){.file = file};
    int status = json_file_read(pool, file, messages, &result->json, &is_lines);
    if (status)
        return status;
    root.json = result->json;
    if (is_lines)
        read_lines(&root, result);
    else
        read_root(&root, result);
    return reader.status;
}
