#include "page/result.h"

#include <math.h>
#include <string.h>

#include "result/json_file.h"
#include "result/records.h"

static void read_noise(const struct json_place *root, struct result *result)
{
    struct json_place noise;
    if (!place_find(root, "noise", PLACE_OBJECT, &noise))
        return;
    result->noise_frequency = place_number(&noise, "frequency");
    result->noise_shape = place_number(&noise, "shape");
    result->frequency_assumed = place_flag(&noise, "frequency_assumed");
    result->shape_assumed = place_flag(&noise, "shape_assumed");
    result->intervals_from = place_string_if(&noise, "intervals_from");
}

/* NULL where something is wrong: the status of the reader tells. */
static void *read_record(const struct json_place *root, const struct record *record)
{
    void *own = pool_get(root->reader->pool, 1, record_size(record));
    if (own)
        record_read(root, record, own);
    else
        root->reader->status = ROTID_ERROR_MEMORY;
    return root->reader->status ? NULL : own;
}

static void read_identify(const struct json_place *root, struct result *result)
{
    result->identify = fitted_read(root);
    read_noise(root, result);
    if (!result->geometry)
        result_lacks(result, "geometry", "the drawing of the rotor");
    if (result->identify && !result->identify->shapes)
        result_lacks(result, "shapes", "the measured and predicted shapes");
    if (result->identify && !cJSON_HasObjectItem(root->json, "mac_matrix"))
        result_lacks(result, "mac_matrix", "the correlation of all measured with all predicted shapes");
}

static void read_diagnose(const struct json_place *root, struct result *result)
{
    result->diagnosis = diagnosis_read(root);
    read_noise(root, result);
    if (!result->geometry)
        result_lacks(result, "geometry", "the drawing of the rotor and the places of the causes on it");
}

static void read_study(const struct json_place *root, struct result *result)
{
    result->study = study_read(root);
}

static void read_modes(const struct json_place *root, struct result *result)
{
    result->modes = modes_read(root);
    if (!result->geometry)
        result_lacks(result, "geometry", "the drawing of the rotor");
}

static void read_sensitivity(const struct json_place *root, struct result *result)
{
    result->sensitivity = read_record(root, &sensitivity_record);
    if (result->sensitivity && !cJSON_HasObjectItem(root->json, "functional_growth"))
        result_lacks(result, "functional_growth", "the growth of the two functionals");
}

static void read_transfer(const struct json_place *root, struct result *result)
{
    result->frf = read_record(root, &transfer_record);
}

static void read_check(const struct json_place *root, struct result *result)
{
    (void)root;
    if (!result->geometry)
        result_lacks(result, "geometry", "the drawing of the rotor");
}

/* Results that a page is made of. */
static const struct {
    const char *command;
    void (*read)(const struct json_place *root, struct result *result);
} readers[] = {
    {"identify", read_identify}, {"diagnose", read_diagnose}, {"modes", read_modes}, {"sensitivity", read_sensitivity},
    {"frf", read_transfer},      {"check", read_check},       {"study", read_study},
};
#define READERS       (sizeof readers / sizeof *readers)
#define READERS_NAMES "identify, diagnose, modes, sensitivity, frf, check or study"

void result_lacks(struct result *result, const char *key, const char *shows)
{
    if (result->nlacking < LACKING_MOST)
        result->lacking[result->nlacking++] = (struct lacking){key, shows};
}

const struct reference_values *result_reference(const struct result *result, const char *quantity)
{
    for (int i = 0; i < result->nreference; i++)
        if (!strcmp(result->reference[i].quantity, quantity))
            return &result->reference[i];
    return NULL;
}

const struct fitted *result_fit(const struct result *result)
{
    return result->diagnosis ? result->diagnosis->base : result->identify;
}

static const char **read_texts(const struct json_place *root, const char *key, int *count)
{
    struct json_place list;
    *count = 0;
    if (!place_find(root, key, PLACE_LIST, &list))
        return NULL;
    const char **text = POOL_ARRAY(root->reader->pool, const char *, place_count(&list));
    for (struct json_place item = place_first(&list, PLACE_TEXT); item.json && text; item = place_next(&item, PLACE_TEXT))
        text[(*count)++] = pool_copy_text(root->reader->pool, item.json->valuestring);
    if (!text || (*count && !text[*count - 1]))
        root->reader->status = ROTID_ERROR_MEMORY;
    return text;
}

/* What stands at the head of every result. */
static void read_head(const struct json_place *root, struct result *result)
{
    struct json_place list;
    result->version = place_string(root, "rotid");
    result->commit = place_string(root, "commit");
    result->blas = place_string(root, "blas");
    result->seed = place_number(root, "seed");
    result->threads = place_whole(root, "threads", 1, 1 << 20);
    result->deck = place_string_if(root, "deck");
    result->heading = read_texts(root, "heading", &result->nheading);
    result->warning = read_texts(root, "warnings", &result->nwarning);
    if (!place_find(root, "references", PLACE_LIST, &list))
        return;
    result->reference = place_items(root, "references", sizeof *result->reference, &list, &result->nreference);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && result->reference;
         item = place_next(&item, PLACE_OBJECT)) {
        struct reference_values *reference = &result->reference[item.index];
        reference->quantity = place_string(&item, "quantity");
        reference->count = place_list(&item, "values", 1, -1, &reference->value);
    }
}

static void read_root(const struct json_place *root, struct result *result)
{
    struct json_place at;
    const char *command;
    if (!cJSON_IsObject(root->json) || !cJSON_HasObjectItem(root->json, "rotid") || !cJSON_HasObjectItem(root->json, "command")) {
        place_wrong(root, "is no result of rotid, expected what a command writes with --json");
        return;
    }
    if (place_need(root, "schema", PLACE_NUMBER, &at) && at.json->valuedouble != 1)
        place_wrong(&at, "is %g, expected 1: made by another version of rotid than this one can read", at.json->valuedouble);
    command = place_string(root, "command");
    if (root->reader->status)
        return;
    for (size_t i = 0; i < READERS; i++) {
        if (strcmp(readers[i].command, command))
            continue;
        result->command = readers[i].command;
        read_head(root, result);
        result->geometry = geometry_read(root);
        readers[i].read(root, result);
        return;
    }
    place_wrong(root, "command: is '%s', of which no page is made, expected " READERS_NAMES, command);
}

/* A file of results of a study: its first line says what it is. */
static void read_lines(const struct json_place *lines, struct result *result)
{
    struct json_place head = place_first(lines, PLACE_OBJECT);
    if (!head.json || !cJSON_HasObjectItem(head.json, "rotid") || !cJSON_HasObjectItem(head.json, "studies")) {
        place_wrong(lines, "has a value a line and is no file of results, expected one of rotid study, or one result");
        return;
    }
    result->command = "study";
    result->version = place_string(&head, "rotid");
    result->commit = place_string(&head, "commit");
    result->seed = place_number(&head, "seed");
    if (!lines->reader->status)
        result->study = study_read_lines(lines);
}

int result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result)
{
    struct reader reader = {.pool = pool, .messages = messages, .file = file};
    struct json_place root = {.reader = &reader};
    cJSON *json;
    int is_lines;
    *result = (struct result){.file = file, .noise_frequency = NAN, .noise_shape = NAN};
    int status = json_file_read(pool, file, messages, &json, &is_lines);
    if (status)
        return status;
    root.json = json;
    if (is_lines)
        read_lines(&root, result);
    else
        read_root(&root, result);
    cJSON_Delete(json);
    return reader.status;
}
