#include "result/result.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define PATH_MOST 512

/* "modes[2].measured_hz" */
static void write_path(const struct json_place *at, char *text, size_t room)
{
    if (!at->above)
        return;
    write_path(at->above, text, room);
    size_t used = strlen(text);
    if (at->key)
        (void)snprintf(text + used, room - used, "%s%s", used ? "." : "", at->key);
    else
        (void)snprintf(text + used, room - used, "[%d]", at->index);
}

void place_wrong(const struct json_place *at, const char *format, ...)
{
    struct reader *reader = at->reader;
    char path[PATH_MOST] = "", text[PATH_MOST];
    va_list arguments;
    if (!reader->status)
        reader->status = ROTID_ERROR_SYNTAX;
    if (++reader->nwrong > PLACE_MOST_WRONG)
        return;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    write_path(at, path, sizeof path);
    message_add(reader->messages, SEVERITY_ERROR, NULL, 0, 0, "%s: %s%s%s", reader->file, path, *path ? ": " : "", text);
    if (reader->nwrong == PLACE_MOST_WRONG)
        message_add(reader->messages, SEVERITY_ERROR, NULL, 0, 0, "%s: and so on, the rest is not told", reader->file);
}

static const char *kind_of(const cJSON *json)
{
    if (cJSON_IsNumber(json))
        return "a number";
    if (cJSON_IsString(json))
        return "a text";
    if (cJSON_IsBool(json))
        return "true or false";
    if (cJSON_IsArray(json))
        return "a list";
    return cJSON_IsNull(json) ? "null" : "an object";
}

static int is_kind(const cJSON *json, enum place_kind kind)
{
    switch (kind) {
    case PLACE_NUMBER:
        return cJSON_IsNumber(json) && isfinite(json->valuedouble);
    case PLACE_TEXT:
        return cJSON_IsString(json);
    case PLACE_FLAG:
        return cJSON_IsBool(json);
    case PLACE_LIST:
        return cJSON_IsArray(json);
    default:
        return cJSON_IsObject(json);
    }
}

int place_is(const struct json_place *at, enum place_kind kind)
{
    static const char *const expected[] = {"a number", "a text", "true or false", "a list", "an object"};
    if (is_kind(at->json, kind))
        return 1;
    if (cJSON_IsNumber(at->json) && kind == PLACE_NUMBER)
        place_wrong(at, "is beyond the range of numbers, expected a finite number or null");
    else if (!cJSON_IsNull(at->json))
        place_wrong(at, "is %s, expected %s", kind_of(at->json), expected[kind]);
    return 0;
}

int place_has(const struct json_place *above, const char *key)
{
    return above->json && cJSON_GetObjectItemCaseSensitive(above->json, key);
}

static int look_up(const struct json_place *above, const char *key, enum place_kind kind, int need, struct json_place *at)
{
    *at = (struct json_place){.reader = above->reader, .above = above, .key = key};
    if (!above->json)
        return 0;
    at->json = cJSON_GetObjectItemCaseSensitive(above->json, key);
    if (!at->json) {
        if (need)
            place_wrong(at, "is missing");
        return 0;
    }
    if (place_is(at, kind))
        return 1;
    if (need && cJSON_IsNull(at->json) && kind >= PLACE_LIST)
        place_wrong(at, "is null, expected %s", kind == PLACE_LIST ? "a list" : "an object");
    at->json = NULL;
    return 0;
}

int place_find(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at)
{
    return look_up(above, key, kind, 0, at);
}

int place_need(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at)
{
    return look_up(above, key, kind, 1, at);
}

double place_number(const struct json_place *above, const char *key)
{
    struct json_place at;
    return place_need(above, key, PLACE_NUMBER, &at) ? at.json->valuedouble : (double)NAN;
}

static const char *keep(const struct json_place *at)
{
    const char *text = pool_copy_text(at->reader->pool, at->json->valuestring);
    if (!text)
        at->reader->status = ROTID_ERROR_MEMORY;
    return text ? text : "";
}

const char *place_string(const struct json_place *above, const char *key)
{
    struct json_place at;
    return place_need(above, key, PLACE_TEXT, &at) ? keep(&at) : "";
}

/* This element, or the next one of the kind. */
static struct json_place settle(struct json_place item, enum place_kind kind)
{
    while (item.json && !place_is(&item, kind)) {
        if (cJSON_IsNull(item.json))
            place_wrong(&item, "is null, expected a value");
        item.json = item.json->next;
        item.index++;
    }
    return item;
}

struct json_place place_first(const struct json_place *list, enum place_kind kind)
{
    struct json_place item = {.reader = list->reader, .above = list, .json = list->json ? list->json->child : NULL};
    return settle(item, kind);
}

struct json_place place_next(const struct json_place *item, enum place_kind kind)
{
    struct json_place next = *item;
    next.json = item->json->next;
    next.index++;
    return settle(next, kind);
}

int place_count(const struct json_place *list)
{
    return list->json ? cJSON_GetArraySize(list->json) : 0;
}

/* The numbers of a list, `stride` apart: their count. */
static int copy_numbers(const struct json_place *list, double *value, int stride)
{
    struct json_place item = {.reader = list->reader, .above = list};
    for (item.json = list->json->child; item.json; item.json = item.json->next, item.index++)
        value[(ptrdiff_t)item.index * stride] = place_is(&item, PLACE_NUMBER) ? item.json->valuedouble : (double)NAN;
    return item.index;
}

int place_matrix(const struct json_place *above, const char *key, int need, const int expected[2], int *rows, int *columns,
                 double **value)
{
    struct json_place list;
    *rows = *columns = 0;
    *value = NULL;
    if (!look_up(above, key, PLACE_LIST, need, &list))
        return 0;
    int m = place_count(&list), n = m ? cJSON_GetArraySize(list.json->child) : 0;
    if (expected && (m != expected[0] || (m && n != expected[1]))) {
        place_wrong(&list, "has %d rows of %d values, expected %d of %d", m, n, expected[0], expected[1]);
        return 0;
    }
    if (!m || !n)
        return 0;
    double *a = POOL_ARRAY(above->reader->pool, double, (size_t)m *(size_t)n);
    if (!a) {
        above->reader->status = ROTID_ERROR_MEMORY;
        return 0;
    }
    for (struct json_place row = place_first(&list, PLACE_LIST); row.json; row = place_next(&row, PLACE_LIST)) {
        if (place_count(&row) != n) {
            place_wrong(&row, "has %d values, expected %d as in the first row", place_count(&row), n);
            return 0;
        }
        (void)copy_numbers(&row, a + row.index, m);
    }
    *rows = m;
    *columns = n;
    *value = a;
    return 1;
}
