#include <math.h>

#include "record/record.h"
#include "result/result.h"

static const char *at(const void *from, size_t offset)
{
    return (const char *)from + offset;
}

static int integer_at(const void *from, size_t offset)
{
    return *(const int *)at(from, offset);
}

/* What a member that is a pointer, or a struct or array in place, leads to. */
static const void *target_of(const struct record_field *field, const void *from)
{
    const char *place = at(from, field->offset);
    int pointed =
        field->shape == SHAPE_LIST || field->shape == SHAPE_MATRIX || field->kind == FIELD_MAP || field->bits & BEHIND_POINTER;
    return pointed ? *(const void *const *)place : place;
}

static void write_number(struct json_tree *tree, cJSON *object, const char *key, unsigned bits, double value)
{
    if (bits & ROUNDED)
        json_rounded(tree, object, key, value);
    else
        json_number(tree, object, key, value);
}

/* One value; `key` NULL: an element of a list. */
static void write_value(struct json_tree *tree, cJSON *object, const char *key, const struct record_field *field,
                        const void *value)
{
    cJSON *array;
    int integer;
    switch (field->kind) {
    case FIELD_NUMBER:
        write_number(tree, object, key, field->bits, *(const double *)value);
        break;
    case FIELD_INTEGER:
        integer = *(const int *)value;
        json_number(tree, object, key, integer == ROTID_NONE ? (double)NAN : integer);
        break;
    case FIELD_FLAG:
        json_flag(tree, object, key, *(const int *)value);
        break;
    case FIELD_TEXT:
        json_text(tree, object, key, *(const char *const *)value);
        break;
    case FIELD_COUNTS:
        if (*(const int *)value == ROTID_NONE) {
            json_null(tree, object, key);
            break;
        }
        array = json_object(tree, object, key);
        for (int i = 0; field->words[i]; i++)
            json_number(tree, array, field->words[i], ((const int *)value)[i]);
        break;
    case FIELD_WORDS:
        array = json_array(tree, object, key);
        for (int i = 0; field->words[i]; i++)
            if (*(const int *)value & 1 << i)
                json_text(tree, array, NULL, field->words[i]);
        break;
    case FIELD_WORD:
        integer = *(const int *)value;
        json_text(tree, object, key, integer < 0 ? NULL : field->words[integer]);
        break;
    default:
        record_write(tree, json_object(tree, object, key), field->record, value);
    }
}

static void write_list(struct json_tree *tree, cJSON *object, const struct record_field *field, const void *from)
{
    int count = field->shape == SHAPE_FIXED ? field->fixed : integer_at(from, field->count);
    const char *list = target_of(field, from);
    if (!list && field->bits & MAY_BE_NULL) {
        json_null(tree, object, field->key);
        return;
    }
    if (field->kind == FIELD_NUMBER && field->bits & ROUNDED) {
        json_digits(tree, object, field->key, list ? count : 0, (const double *)list);
        return;
    }
    cJSON *array = json_array(tree, object, field->key);
    for (int i = 0; i < count && list; i++)
        write_value(tree, array, NULL, field, list + (size_t)i * record_element_size(field));
}

static void write_map(struct json_tree *tree, cJSON *object, const char *key, int count, const rotid_component *component)
{
    cJSON *map = json_object(tree, object, key);
    for (int i = 0; i < count; i++)
        json_number(tree, map, component[i].name, component[i].value);
}

static void write_maps(struct json_tree *tree, cJSON *object, const struct record_field *field, const void *from)
{
    int count = field->shape == SHAPE_ONE ? 1 : integer_at(from, field->count), each = integer_at(from, field->columns);
    const rotid_component *component = target_of(field, from);
    if (field->shape == SHAPE_ONE) {
        write_map(tree, object, field->key, each, component);
        return;
    }
    cJSON *array = json_array(tree, object, field->key);
    for (int i = 0; i < count; i++)
        write_map(tree, array, NULL, each, component + (ptrdiff_t)i * each);
}

static void write_matrix(struct json_tree *tree, cJSON *object, const struct record_field *field, const void *from)
{
    const double *value = target_of(field, from);
    int rows = value ? integer_at(from, field->count) : 0, columns = integer_at(from, field->columns);
    if (!value && field->bits & MAY_BE_NULL)
        json_null(tree, object, field->key);
    else if (field->bits & ROUNDED)
        json_digit_rows(tree, object, field->key, rows, columns, value);
    else
        json_matrix(tree, object, field->key, rows, columns, value);
}

static int is_known(const struct record_field *field, const void *from)
{
    const void *value = target_of(field, from);
    if (field->kind == FIELD_INLINE && !(field->bits & BEHIND_POINTER))
        return is_known(field->record->field, value);
    if (field->shape != SHAPE_ONE || field->kind == FIELD_RECORD || field->kind == FIELD_MAP || field->bits & BEHIND_POINTER)
        return value != NULL;
    if (field->kind == FIELD_NUMBER)
        return isfinite(*(const double *)value);
    return field->kind == FIELD_TEXT ? *(const char *const *)value != NULL : *(const int *)value != ROTID_NONE;
}

void record_write(struct json_tree *tree, cJSON *object, const struct record *record, const void *from)
{
    for (const struct record_field *field = record->field; field->key; field++) {
        if (field->kind == FIELD_COUNT || (field->bits & IF_KNOWN && !is_known(field, from)))
            continue;
        const void *value = target_of(field, from);
        if (field->kind == FIELD_INLINE) {
            if (value)
                record_write(tree, object, field->record, value);
        } else if (field->kind == FIELD_MAP) {
            write_maps(tree, object, field, from);
        } else if (field->shape == SHAPE_MATRIX) {
            write_matrix(tree, object, field, from);
        } else if (field->shape != SHAPE_ONE) {
            write_list(tree, object, field, from);
        } else if (value) {
            write_value(tree, object, field->key, field, value);
        } else {
            json_null(tree, object, field->key);
        }
    }
}
