/* JSON to a struct that has a table: values with the place where they stand, and the walk over the rows of the table. */
#include <limits.h>

#include "result/result.h"

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
    return cJSON_IsNumber(json)   ? "a number"
           : cJSON_IsString(json) ? "a text"
           : cJSON_IsBool(json)   ? "true or false"
           : cJSON_IsArray(json)  ? "a list"
           : cJSON_IsNull(json)   ? "null"
                                  : "an object";
}

static int is_kind(const cJSON *json, enum place_kind kind)
{
    return kind == PLACE_NUMBER ? cJSON_IsNumber(json) && isfinite(json->valuedouble)
           : kind == PLACE_TEXT ? cJSON_IsString(json)
           : kind == PLACE_FLAG ? cJSON_IsBool(json)
           : kind == PLACE_LIST ? cJSON_IsArray(json)
                                : cJSON_IsObject(json);
}

/* Whether the value is of the kind. If it is of another one that is told; null is let pass. */
static int place_is(const struct json_place *at, enum place_kind kind)
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

int place_need(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at)
{
    return look_up(above, key, kind, 1, at);
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

static struct json_place place_next(const struct json_place *item, enum place_kind kind)
{
    struct json_place next = *item;
    next.json = item->json->next;
    next.index++;
    return settle(next, kind);
}

static int place_count(const struct json_place *list)
{
    return list->json ? cJSON_GetArraySize(list->json) : 0;
}

/* ---- the rows of a table */

static void *member(void *to, size_t offset)
{
    return (char *)to + offset;
}

static void *room_for(const struct json_place *at, size_t count, size_t size)
{
    void *room = pool_get(at->reader->pool, count, size);
    if (!room)
        at->reader->status = ROTID_ERROR_MEMORY;
    return room;
}

static void check_range(const struct json_place *at, unsigned bits, double value)
{
    static const struct {
        unsigned bit;
        double least, most;
        const char *expected;
    } ranges[] = {
        {ABOVE_0, 0, INFINITY, "a number above 0"},          {FROM_0, 0, INFINITY, "no number below 0"},
        {FROM_1, 1, INFINITY, "no number below 1"},          {PROBABILITY, 0, 1, "a number from 0 to 1"},
        {CORRELATION, 0, 1.0000001, "a number from 0 to 1"},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (bits & ranges[i].bit && (value < ranges[i].least || value > ranges[i].most || (bits & ABOVE_0 && value == 0)))
            place_wrong(at, "is %g, expected %s", value, ranges[i].expected);
}

static int is_whole(const struct json_place *at, double value, double most)
{
    int whole = value == floor(value) && fabs(value) < most;
    if (!whole)
        place_wrong(at, "is %g, expected a whole number", value);
    return whole;
}

static void read_integer(const struct json_place *at, const struct record_field *field, int *to)
{
    double value = at->json->valuedouble;
    if (is_whole(at, value, INT_MAX)) {
        check_range(at, field->bits, value);
        *to = (int)value;
    }
}

/* "a, b or c" */
static const char *list_words(struct pool *pool, const char *const *word)
{
    const char *text = "";
    for (int i = 0; word[i]; i++)
        text = pool_text(pool, "%s%s%s", text, !i ? "" : word[i + 1] ? ", " : " or ", word[i]);
    return text;
}

/* The index of the text among the words, -1 with a mistake told where it is none. */
static int read_word(const struct json_place *at, const char *const *word)
{
    for (int i = 0; word[i]; i++)
        if (!strcmp(word[i], at->json->valuestring))
            return i;
    place_wrong(at, "is '%s', expected %s", at->json->valuestring, list_words(at->reader->pool, word));
    return -1;
}

static enum place_kind kind_of_field(const struct record_field *field)
{
    return field->kind == FIELD_NUMBER || field->kind == FIELD_INTEGER ? PLACE_NUMBER
           : field->kind == FIELD_FLAG                                 ? PLACE_FLAG
           : field->kind == FIELD_TEXT || field->kind == FIELD_WORD    ? PLACE_TEXT
           : field->kind == FIELD_WORDS                                ? PLACE_LIST
                                                                       : PLACE_OBJECT;
}

/* What stands for a value that is not known. A text that has to be there is "" then, so that nobody meets NULL. */
static void set_unknown(const struct record_field *field, void *to)
{
    if (field->kind == FIELD_NUMBER)
        *(double *)to = NAN;
    else if (field->kind == FIELD_INTEGER || field->kind == FIELD_COUNTS)
        *(int *)to = field->bits & (MAY_BE_NULL | IF_KNOWN | SINCE_LATER) ? ROTID_NONE : 0;
    else if (field->kind == FIELD_WORD || (field->kind == FIELD_FLAG && field->bits & SINCE_LATER))
        *(int *)to = -1;
    else if (field->kind == FIELD_TEXT)
        *(const char **)to = field->bits & (MAY_BE_NULL | IF_KNOWN | SINCE_LATER) ? NULL : "";
}

static void read_words(const struct json_place *list, const struct record_field *field, int *to)
{
    *to = 0;
    for (struct json_place item = place_first(list, PLACE_TEXT); item.json; item = place_next(&item, PLACE_TEXT)) {
        int word = read_word(&item, field->words);
        *to |= word < 0 ? 0 : 1 << word;
    }
}

static void read_counts(const struct json_place *map, const struct record_field *field, int *to)
{
    struct json_place at;
    for (int i = 0; field->words[i]; i++)
        if (place_need(map, field->words[i], PLACE_NUMBER, &at))
            read_integer(&at, field, &to[i]);
}

/* at->json is of the kind, or NULL or null where there is none. above: the struct that the value is of. */
static void read_value(const struct json_place *at, const struct record_field *field, const void *above, void *to)
{
    int is_there = at->json && !cJSON_IsNull(at->json);
    if (field->kind == FIELD_RECORD) {
        record_read(at, field->record, above, to);
        return;
    }
    set_unknown(field, to);
    if (!is_there)
        return;
    switch (field->kind) {
    case FIELD_NUMBER:
        *(double *)to = at->json->valuedouble;
        check_range(at, field->bits, at->json->valuedouble);
        if (field->bits & WHOLE)
            (void)is_whole(at, at->json->valuedouble, INFINITY);
        break;
    case FIELD_INTEGER:
        read_integer(at, field, to);
        break;
    case FIELD_FLAG:
        *(int *)to = cJSON_IsTrue(at->json);
        break;
    case FIELD_TEXT:
        *(const char **)to = keep(at);
        if (field->words)
            (void)read_word(at, field->words);
        break;
    case FIELD_COUNTS:
        read_counts(at, field, to);
        break;
    case FIELD_WORDS:
        read_words(at, field, to);
        break;
    default:
        *(int *)to = read_word(at, field->words);
    }
}

/* Whether the value of a field is there, and of the kind. A list or struct that may not be null has to be. */
static int find_field(const struct json_place *above, const struct record_field *field, enum place_kind kind,
                      struct json_place *at)
{
    int may_lack = field->bits & (IF_KNOWN | SINCE_LATER) || (field->bits & MAY_BE_NULL && place_has(above, field->key));
    return look_up(above, field->key, kind, !may_lack, at);
}

/* A value of another kind is told, and becomes an unknown one. */
static void read_elements(const struct json_place *list, const struct record_field *field, int count, const void *above, char *to)
{
    size_t size = record_element_size(field);
    struct json_place item = {.reader = list->reader, .above = list, .json = list->json->child};
    for (int i = 0; i < count && item.json; i++, item.json = item.json->next, item.index++) {
        struct json_place value = item;
        if (!place_is(&item, kind_of_field(field))) {
            if (cJSON_IsNull(item.json) && !(field->bits & ELEMENTS_MAY_BE_NULL) && field->kind != FIELD_NUMBER)
                place_wrong(&item, "is null, expected a value");
            value.json = NULL;
        }
        read_value(&value, field, above, to + (size_t)i * size);
    }
}

static void read_fixed(const struct json_place *above, const struct record_field *field, void *record)
{
    struct json_place list;
    void *to = member(record, field->offset);
    for (int i = 0; i < field->fixed; i++)
        set_unknown(field, (char *)to + (size_t)i * record_element_size(field));
    if (!find_field(above, field, PLACE_LIST, &list))
        return;
    if (place_count(&list) == field->fixed)
        read_elements(&list, field, field->fixed, record, to);
    else
        place_wrong(&list, "has %d values, expected %d", place_count(&list), field->fixed);
}

static void read_list(const struct json_place *above, const struct record_field *field, void *record)
{
    struct json_place list;
    int *count = member(record, field->count), length;
    void **to = member(record, field->offset);
    if (!field->counted_by)
        *count = 0;
    if (!find_field(above, field, PLACE_LIST, &list))
        return;
    length = place_count(&list);
    if (field->counted_by && length != *count) {
        place_wrong(&list, "has %d values, expected %d as %s", length, *count, field->counted_by);
        return;
    }
    if (!length && field->bits & NOT_EMPTY)
        place_wrong(&list, "is empty, expected at least one value");
    *to = room_for(above, (size_t)length, record_element_size(field));
    if (!*to)
        return;
    *count = length;
    read_elements(&list, field, length, record, *to);
}

/* The components of one map into `next`: 0 where memory is out. */
static int read_components(const struct json_place *map, rotid_component *next)
{
    for (const cJSON *json = map->json->child; json; json = json->next, next++) {
        struct json_place component = {.reader = map->reader, .above = map, .key = json->string, .json = json};
        next->name = pool_copy_text(map->reader->pool, json->string);
        next->value = place_is(&component, PLACE_NUMBER) ? json->valuedouble : (double)NAN;
        if (!next->name) {
            map->reader->status = ROTID_ERROR_MEMORY;
            return 0;
        }
    }
    return 1;
}

static void read_map(const struct json_place *above, const struct record_field *field, void *record)
{
    struct json_place map;
    rotid_component **to = member(record, field->offset);
    if (!find_field(above, field, PLACE_OBJECT, &map))
        return;
    int count = cJSON_GetArraySize(map.json);
    *to = room_for(above, (size_t)count, sizeof **to);
    if (*to && read_components(&map, *to))
        *(int *)member(record, field->columns) = count;
}

static void read_maps(const struct json_place *above, const struct record_field *field, void *record)
{
    struct json_place list;
    int *count = member(record, field->count), width = *(int *)member(record, field->columns), length;
    rotid_component **to = member(record, field->offset), *next;
    *count = 0;
    if (!find_field(above, field, PLACE_LIST, &list) || !(length = place_count(&list)))
        return;
    next = *to = room_for(above, (size_t)length * (size_t)width, sizeof **to);
    for (struct json_place map = place_first(&list, PLACE_OBJECT); map.json && next; map = place_next(&map, PLACE_OBJECT)) {
        if (cJSON_GetArraySize(map.json) != width) {
            place_wrong(&map, "has %d components, expected %d", cJSON_GetArraySize(map.json), width);
            return;
        }
        if (!read_components(&map, next))
            return;
        next += width;
    }
    *count = length;
}

/* Rows of the same length as a column-major matrix. Of a square one the size stands before it. */
static void read_matrix(const struct json_place *above, const struct record_field *field, void *record)
{
    int *rows = member(record, field->count), *columns = member(record, field->columns);
    int known = rows == columns || *rows || *columns;
    struct json_place list;
    if (!find_field(above, field, PLACE_LIST, &list))
        return;
    int m = place_count(&list), n = m ? cJSON_GetArraySize(list.json->child) : 0;
    if (known && (m != *rows || (m && n != *columns))) {
        place_wrong(&list, "has %d rows of %d values, expected %d of %d", m, n, *rows, *columns);
        return;
    }
    double *a = m && n ? room_for(above, (size_t)m * (size_t)n, sizeof *a) : NULL;
    if (!a)
        return;
    for (struct json_place row = place_first(&list, PLACE_LIST); row.json; row = place_next(&row, PLACE_LIST)) {
        if (place_count(&row) != n) {
            place_wrong(&row, "has %d values, expected %d as in the first row", place_count(&row), n);
            return;
        }
        struct json_place item = {.reader = list.reader, .above = &row, .json = row.json->child};
        for (; item.json; item.json = item.json->next, item.index++)
            a[row.index + (ptrdiff_t)item.index * m] = place_is(&item, PLACE_NUMBER) ? item.json->valuedouble : (double)NAN;
    }
    *rows = m;
    *columns = n;
    *(double **)member(record, field->offset) = a;
}

static void read_one(const struct json_place *above, const struct record_field *field, void *record)
{
    struct json_place at;
    void *to = member(record, field->offset);
    int is_there = find_field(above, field, kind_of_field(field), &at);
    const cJSON *json = above->json ? cJSON_GetObjectItemCaseSensitive(above->json, field->key) : NULL;
    int number = field->kind == FIELD_NUMBER; /* NaN where it is null: older tables let more of them be that */
    if (cJSON_IsNull(json) && !number && kind_of_field(field) < PLACE_LIST && !(field->bits & MAY_BE_NULL))
        place_wrong(&at, "is null, expected a value");
    if (field->bits & BEHIND_POINTER) {
        void *room = is_there ? room_for(above, 1, field->record->size) : NULL;
        *(void **)to = room;
        if (room)
            record_read(&at, field->record, record, room);
        return;
    }
    read_value(&at, field, record, to);
}

/* Whether the keys of a struct stand here: the first one that results of all versions have tells. */
static int stands_here(const struct json_place *at, const struct record *record)
{
    const struct record_field *field = record->field;
    while (field->bits & SINCE_LATER)
        field++;
    return field->kind == FIELD_INLINE ? stands_here(at, field->record) : place_has(at, field->key);
}

void record_read(const struct json_place *at, const struct record *record, const void *above, void *to)
{
    for (const struct record_field *field = record->field; field->key; field++) {
        void *inside = member(to, field->offset);
        if (field->kind == FIELD_COUNT) {
            *(int *)inside = above ? *(const int *)((const char *)above + field->count) : 0;
        } else if (field->kind == FIELD_INLINE) {
            if (field->bits & IF_KNOWN && !stands_here(at, field->record))
                continue;
            if (field->bits & BEHIND_POINTER) { /* the keys of one struct may stand in two places */
                void **pointer = inside;
                inside = *pointer = *pointer ? *pointer : room_for(at, 1, field->record->size);
            }
            if (inside)
                record_read(at, field->record, to, inside);
        } else if (field->kind == FIELD_MAP && field->shape == SHAPE_ONE) {
            read_map(at, field, to);
        } else if (field->kind == FIELD_MAP) {
            read_maps(at, field, to);
        } else if (field->shape == SHAPE_MATRIX) {
            read_matrix(at, field, to);
        } else if (field->shape == SHAPE_LIST) {
            read_list(at, field, to);
        } else if (field->shape == SHAPE_FIXED) {
            read_fixed(at, field, to);
        } else {
            read_one(at, field, to);
        }
    }
}
