#include <string.h>

#include "result/json_file.h"
#include "result/records.h"
#include "result/result.h"

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

static void note_what_is_lacking(const struct json_place *root, struct result *result)
{
    for (size_t i = 0; i < sizeof newer / sizeof *newer; i++)
        if (!strcmp(newer[i].command, result->head.command) && !place_has(root, newer[i].key) && result->nlacking < LACKING_MOST)
            result->lacking[result->nlacking++] = (struct lacking){newer[i].key, newer[i].shows};
}

/* "check, modes or study" */
static const char *list_commands(struct pool *pool)
{
    const char *text = "", *last = NULL, *command;
    for (int i = 0; (command = result_command(i)) && text; i++) {
        if (!result_has_page(command))
            continue;
        if (last)
            text = pool_format(pool, "%s%s%s", text, *text ? ", " : "", last);
        last = command;
    }
    text = text ? pool_format(pool, "%s or %s", text, last) : NULL;
    return text ? text : "";
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
    if (!result_has_page(command)) {
        place_wrong(root, "command: is '%s', of which no page is made, expected %s", command, list_commands(root->reader->pool));
        return;
    }
    if (!strcmp(command, "study") && place_has(root, "digest") &&
        !place_has(root, "cells")) { /* the header, which stands alone before a run ends */
        place_wrong(root, "is the file of results of a study and holds no run yet, expected the line of a run at least");
        return;
    }
    record_read(root, result_record(command), result);
    if (root->reader->status)
        return;
    note_what_is_lacking(root, result);
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
