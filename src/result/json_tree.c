#include "result/json_tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

#define DIGITS 9
#define WIDEST 24 /* characters of such a number, with sign, point and exponent */

static cJSON *put(struct json_tree *tree, cJSON *parent, const char *key, cJSON *item)
{
    if (item && parent && (key ? cJSON_AddItemToObject(parent, key, item) : cJSON_AddItemToArray(parent, item)))
        return item;
    cJSON_Delete(item);
    tree->failed = 1;
    return NULL;
}

cJSON *json_object(struct json_tree *tree, cJSON *parent, const char *key)
{
    return put(tree, parent, key, cJSON_CreateObject());
}

cJSON *json_array(struct json_tree *tree, cJSON *parent, const char *key)
{
    return put(tree, parent, key, cJSON_CreateArray());
}

void json_null(struct json_tree *tree, cJSON *parent, const char *key)
{
    (void)put(tree, parent, key, cJSON_CreateNull());
}

void json_flag(struct json_tree *tree, cJSON *parent, const char *key, int value)
{
    (void)put(tree, parent, key, cJSON_CreateBool(value != 0));
}

void json_number(struct json_tree *tree, cJSON *parent, const char *key, double value)
{
    (void)put(tree, parent, key, isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

void json_text(struct json_tree *tree, cJSON *parent, const char *key, const char *text)
{
    if (!text) {
        json_null(tree, parent, key);
        return;
    }
    (void)put(tree, parent, key, cJSON_CreateString(text)); /* what is no UTF-8 in it is replaced at the end */
}

/* Numbers that are `stride` apart. */
static void put_digits(struct json_tree *tree, cJSON *parent, const char *key, int count, const double *value, ptrdiff_t stride)
{
    size_t length = 1, room = (size_t)(count > 0 ? count : 0) * (WIDEST + 1) + 3;
    char *text = malloc(room);
    for (int i = 0; i < count && text; i++) {
        const char *comma = i ? "," : "";
        double number = value[i * stride];
        int more = isfinite(number) ? snprintf(text + length, room - length, "%s%.*g", comma, DIGITS, number)
                                    : snprintf(text + length, room - length, "%snull", comma);
        length += (size_t)more;
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

void json_rounded(struct json_tree *tree, cJSON *parent, const char *key, double value)
{
    char text[WIDEST + 8];
    (void)snprintf(text, sizeof text, "%.*g", DIGITS, value);
    json_number(tree, parent, key, isfinite(value) ? strtod(text, NULL) : NAN);
}

void json_matrix(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value)
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

/* A copy with `behind` at its end, in which control characters are escaped: cJSON does so with those of ASCII alone, and a file
 * is shown on terminals too. They stand within texts only, but for the blanks between values. */
static char *escape(const char *text, const char *behind)
{
    unsigned code;
    size_t room = strlen(text) + strlen(behind) + 1;
    for (const char *c = text; *c; c += text_utf8(c) ? text_utf8(c) : 1)
        room += text_visible(c) ? 0 : 6; /* of an escape, or of what stands for a byte that is no UTF-8 */
    char *copy = cJSON_malloc(room), *end = copy;
    while (copy && *text) {
        size_t bytes = text_utf8(text);
        if (text_is_control(text, &code) && *text != '\n' && *text != '\t') {
            end += snprintf(end, 7, "\\u%04x", code & 0xffff);
        } else {
            memcpy(end, bytes ? text : TEXT_REPLACEMENT, bytes ? bytes : 3);
            end += bytes ? bytes : 3;
        }
        text += bytes ? bytes : 1;
    }
    if (copy)
        (void)strcpy(end, behind);
    return copy;
}

static char *finish(struct json_tree *tree, char *text, const char *behind)
{
    char *escaped = text ? escape(text, behind) : NULL;
    cJSON_free(text);
    cJSON_Delete(tree->root);
    tree->root = NULL;
    return escaped;
}

char *json_close(struct json_tree *tree)
{
    return finish(tree, tree->failed ? NULL : cJSON_Print(tree->root), "");
}

char *json_close_line(struct json_tree *tree)
{
    return finish(tree, tree->failed ? NULL : cJSON_PrintUnformatted(tree->root), "\n");
}

void json_free(char *text)
{
    cJSON_free(text);
}
