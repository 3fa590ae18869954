/* JSON of a struct that has a table: an object under construction, and the walk over the rows of the table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "record/record.h"
#include "result/result.h"

#define DIGITS 9
#define WIDEST 24 /* characters of such a number, with sign, point and exponent */
#define POWERS 22 /* of ten, that are numbers without rounding */

static cJSON *put(struct json_tree *tree, cJSON *parent, const char *key, cJSON *item)
{
    if (item && parent && (key ? cJSON_AddItemToObject(parent, key, item) : cJSON_AddItemToArray(parent, item)))
        return item;
    cJSON_Delete(item);
    tree->failed = 1;
    return NULL;
}

/* Each adds to an object under `key`, to an array where `key` is NULL; nothing and a mark on the tree where `parent` is NULL. */

static cJSON *json_object(struct json_tree *tree, cJSON *parent, const char *key)
{
    return put(tree, parent, key, cJSON_CreateObject());
}

static cJSON *json_array(struct json_tree *tree, cJSON *parent, const char *key)
{
    return put(tree, parent, key, cJSON_CreateArray());
}

static void json_null(struct json_tree *tree, cJSON *parent, const char *key)
{
    (void)put(tree, parent, key, cJSON_CreateNull());
}

static void json_flag(struct json_tree *tree, cJSON *parent, const char *key, int value)
{
    (void)put(tree, parent, key, cJSON_CreateBool(value != 0));
}

/* null where the value is not finite */
static void json_number(struct json_tree *tree, cJSON *parent, const char *key, double value)
{
    (void)put(tree, parent, key, isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

/* In whatever encoding: bytes that are not UTF-8 become U+FFFD; null where there is no text. */
static void json_text(struct json_tree *tree, cJSON *parent, const char *key, const char *text)
{
    if (!text) {
        json_null(tree, parent, key);
        return;
    }
    (void)put(tree, parent, key, cJSON_CreateString(text)); /* what is no UTF-8 in it is replaced at the end */
}

/* The nine digits of a positive number as an integer, and the power of ten of the first one; 0 where a product with a power of
 * ten is not near enough to tell how it rounds. */
static long nine_digits(double value, int *exponent)
{
    static const double power[POWERS + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                             1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (!(value > 1e-13 && value < 1e30))
        return 0;
    int first = (int)floor(log10(value)), shift = DIGITS - 1 - first;
    double scaled = shift < 0 ? value / power[-shift] : value * power[shift], below = floor(scaled);
    if (fabs(scaled - below - 0.5) < 1e-6 || scaled < 1e8 || scaled >= 999999999.5)
        return 0;
    *exponent = first;
    return (long)below + (scaled - below > 0.5);
}

/* As printf's %.9g writes a finite number, which costs five times as much; the characters written. */
static size_t write_digits(char *text, double value)
{
    int exponent;
    long digits = nine_digits(fabs(value), &exponent);
    if (!digits)
        return (size_t)snprintf(text, WIDEST + 1, "%.*g", DIGITS, value);
    char digit[DIGITS], *c = text;
    int scientific = exponent < -4 || exponent >= DIGITS, point = scientific ? 0 : exponent, last = DIGITS - 1;
    for (int i = DIGITS - 1; i >= 0; i--, digits /= 10)
        digit[i] = (char)('0' + digits % 10);
    while (last > 0 && digit[last] == '0')
        last--;
    if (value < 0)
        *c++ = '-';
    for (int i = point < 0 ? point : 0; i <= last || i <= point; i++) {
        *c++ = (char)(i < 0 ? '0' : digit[i]); /* the zeros in front of a fraction, and those up to the point, are digits too */
        if (i == point && i < last)
            *c++ = '.';
    }
    if (scientific)
        c += snprintf(c, 6, "e%+03d", exponent);
    return (size_t)(c - text);
}

/* Numbers that are `stride` apart. */
static void put_digits(struct json_tree *tree, cJSON *parent, const char *key, int count, const double *value, ptrdiff_t stride)
{
    size_t length = 1, room = (size_t)(count > 0 ? count : 0) * (WIDEST + 1) + 3;
    char *text = malloc(room);
    for (int i = 0; i < count && text; i++) {
        double number = value[i * stride];
        if (i)
            text[length++] = ',';
        if (isfinite(number))
            length += write_digits(text + length, number);
        else
            length += (size_t)snprintf(text + length, room - length, "null");
    }
    if (text) {
        text[0] = '[';
        memcpy(text + length, "]", 2);
    }
    (void)put(tree, parent, key, text ? cJSON_CreateRaw(text) : NULL);
    free(text);
}

void json_digits(struct json_tree *tree, cJSON *parent, const char *key, int count, const double *value)
{
    put_digits(tree, parent, key, count, value, 1);
}

void json_digit_rows(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value)
{
    cJSON *array = json_array(tree, parent, key);
    for (int i = 0; i < rows; i++)
        put_digits(tree, array, NULL, columns, value + i, rows);
}

/* A number rounded to nine significant digits. */
static void json_rounded(struct json_tree *tree, cJSON *parent, const char *key, double value)
{
    char text[WIDEST + 8];
    (void)snprintf(text, sizeof text, "%.*g", DIGITS, value);
    json_number(tree, parent, key, isfinite(value) ? strtod(text, NULL) : NAN);
}

static void json_matrix(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value)
{
    cJSON *array = json_array(tree, parent, key);
    for (int i = 0; i < rows && array; i++) {
        cJSON *row = json_array(tree, array, NULL);
        for (int j = 0; j < columns && row; j++)
            json_number(tree, row, NULL, value[i + (ptrdiff_t)j * rows]);
    }
}

void json_open(struct json_tree *tree)
{
    tree->root = cJSON_CreateObject();
    tree->failed = !tree->root;
}

/* The length of what stands at the beginning and is copied as it is: ASCII, and the blanks between values. */
static size_t plain(const char *text)
{
    const char *c = text;
    while ((*c >= ' ' && *c < 0x7f) || *c == '\n' || *c == '\t')
        c++;
    return (size_t)(c - text);
}

/* A copy with a line feed at its end, in which control characters are escaped: cJSON does so with those of ASCII alone, and a
 * file is shown on terminals too. They stand within texts only, but for the blanks between values. */
static char *escape(const char *text)
{
    unsigned code;
    size_t room = strlen(text) + 2;
    for (const char *c = text + plain(text); *c; c += plain(c)) {
        room += text_visible(c) ? 0 : 6; /* of an escape, or of what stands for a byte that is no UTF-8 */
        c += text_utf8(c) ? text_utf8(c) : 1;
    }
    char *copy = cJSON_malloc(room), *end = copy;
    while (copy) {
        size_t as_it_is = plain(text);
        memcpy(end, text, as_it_is);
        end += as_it_is;
        text += as_it_is;
        if (!*text)
            break;
        size_t bytes = text_utf8(text);
        if (text_is_control(text, &code)) {
            end += snprintf(end, 7, "\\u%04x", code & 0xffff);
        } else {
            memcpy(end, bytes ? text : TEXT_REPLACEMENT, bytes ? bytes : 3);
            end += bytes ? bytes : 3;
        }
        text += bytes ? bytes : 1;
    }
    if (copy)
        (void)strcpy(end, "\n");
    return copy;
}

static char *finish(struct json_tree *tree, char *text)
{
    char *escaped = text ? escape(text) : NULL;
    cJSON_free(text);
    cJSON_Delete(tree->root);
    tree->root = NULL;
    return escaped;
}

char *json_close(struct json_tree *tree)
{
    return finish(tree, tree->failed ? NULL : cJSON_Print(tree->root));
}

char *json_close_line(struct json_tree *tree)
{
    return finish(tree, tree->failed ? NULL : cJSON_PrintUnformatted(tree->root));
}

void json_free(char *text)
{
    cJSON_free(text);
}

/* ---- the rows of a table */

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
