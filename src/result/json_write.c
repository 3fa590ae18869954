/* JSON of a struct that has a table: its rows one after the other, a key each. */
#include <float.h>

#include "result/result.h"

struct json_writer {
    FILE *out;
    int lines;  /* a key a line, indented; else all in one line */
    int depth;  /* of objects and arrays */
    int behind; /* a value stands before in this one */
};

static void new_line(const struct json_writer *to)
{
    for (int i = 0; i <= to->depth && to->lines; i++)
        (void)fputc(i ? '\t' : '\n', to->out);
}

/* In whatever encoding: bytes that are not UTF-8 become U+FFFD. Control characters are escaped, those beyond ASCII too: a file is
 * shown on terminals as well. */
static void put_text(FILE *out, const char *text)
{
    static const char escaped[] = "\"\\\b\f\n\r\t", letter[] = "\"\\bfnrt";
    unsigned code;
    (void)fputc('"', out);
    for (size_t bytes; *text; text += bytes ? bytes : 1) {
        const char *found = strchr(escaped, *text);
        bytes = text_utf8(text);
        if (found)
            (void)fprintf(out, "\\%c", letter[found - escaped]);
        else if (text_is_control(text, &code))
            (void)fprintf(out, "\\u%04x", code & 0xffff);
        else
            (void)fwrite(bytes ? text : TEXT_REPLACEMENT, 1, bytes ? bytes : sizeof TEXT_REPLACEMENT - 1, out);
    }
    (void)fputc('"', out);
}

/* What stands before the next value: a comma behind another one, and in an object a key. */
static void put_key(struct json_writer *to, const char *key)
{
    if (to->behind)
        (void)fputs(key || !to->lines ? "," : ", ", to->out);
    to->behind = 1;
    if (!key)
        return;
    new_line(to);
    put_text(to->out, key);
    (void)fputs(to->lines ? ":\t" : ":", to->out);
}

static void begin(struct json_writer *to, const char *key, char bracket)
{
    put_key(to, key);
    (void)fputc(bracket, to->out);
    to->depth++;
    to->behind = 0;
}

static void end(struct json_writer *to, char bracket)
{
    to->depth--;
    if (bracket == '}')
        new_line(to);
    (void)fputc(bracket, to->out);
    to->behind = 1;
}

static void put_word(struct json_writer *to, const char *key, const char *word)
{
    put_key(to, key);
    (void)fputs(word, to->out);
}

/* null where there is no text */
static void write_text(struct json_writer *to, const char *key, const char *text)
{
    put_key(to, key);
    if (text)
        put_text(to->out, text);
    else
        (void)fputs("null", to->out);
}

/* null where the value is not finite; 15 digits, or 17 where they do not give it back */
static void write_number(struct json_writer *to, const char *key, double value)
{
    char text[32] = "null";
    if (isfinite(value)) {
        (void)snprintf(text, sizeof text, "%.15g", value);
        double back = strtod(text, NULL);
        if (fabs(back - value) > fmax(fabs(back), fabs(value)) * DBL_EPSILON)
            (void)snprintf(text, sizeof text, "%.17g", value);
    }
    put_word(to, key, text);
}

#define DIGITS 9 /* of what is drawn and not computed with */

/* Numbers that are `stride` apart; rounded: the array of a mesh takes a third of the room. */
static void write_numbers(struct json_writer *to, const char *key, int rounded, int count, const double *value, ptrdiff_t stride)
{
    begin(to, key, '[');
    for (int i = 0; i < count; i++, value += stride)
        if (!rounded)
            write_number(to, NULL, *value);
        else if (isfinite(*value))
            (void)fprintf(to->out, "%s%.*g", i ? "," : "", DIGITS, *value);
        else
            (void)fputs(i ? ",null" : "null", to->out);
    end(to, ']');
}

static double rounded(double value)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.*g", DIGITS, value);
    return strtod(text, NULL);
}

/* ---- the rows of a table */

static void write_keys(struct json_writer *to, const struct record *record, const void *from);

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

/* An object of one key for each component. */
static void write_map(struct json_writer *to, const char *key, int count, const rotid_component *component)
{
    begin(to, key, '{');
    for (int i = 0; i < count; i++)
        write_number(to, component[i].name, component[i].value);
    end(to, '}');
}

/* One value; `key` NULL: an element of a list. */
static void write_value(struct json_writer *to, const char *key, const struct record_field *field, const void *value)
{
    const int *integer = value;
    switch (field->kind) {
    case FIELD_NUMBER:
        write_number(to, key, field->bits & ROUNDED ? rounded(*(const double *)value) : *(const double *)value);
        break;
    case FIELD_INTEGER:
        write_number(to, key, *integer == ROTID_NONE ? (double)NAN : *integer);
        break;
    case FIELD_FLAG:
        put_word(to, key, *integer ? "true" : "false");
        break;
    case FIELD_TEXT:
        write_text(to, key, *(const char *const *)value);
        break;
    case FIELD_CHARS:
        write_text(to, key, *(const char *)value ? value : NULL);
        break;
    case FIELD_NAME:
        write_text(to, key, field->name(*integer));
        break;
    case FIELD_WORD:
        write_text(to, key, *integer < 0 ? NULL : field->words[*integer]);
        break;
    case FIELD_WORDS:
        begin(to, key, '[');
        for (int i = 0; field->words[i]; i++)
            if (*integer & 1 << i)
                write_text(to, NULL, field->words[i]);
        end(to, ']');
        break;
    case FIELD_COUNTS:
        if (*integer == ROTID_NONE) {
            write_text(to, key, NULL);
            break;
        }
        begin(to, key, '{');
        for (int i = 0; field->words[i]; i++)
            write_number(to, field->words[i], integer[i]);
        end(to, '}');
        break;
    default:
        begin(to, key, '{');
        write_keys(to, field->record, value);
        end(to, '}');
    }
}

static void write_list(struct json_writer *to, const struct record_field *field, const void *from)
{
    const char *list = target_of(field, from);
    int count = !list ? 0 : field->shape == SHAPE_FIXED ? field->fixed : integer_at(from, field->count);
    if (!list && field->bits & MAY_BE_NULL) {
        write_text(to, field->key, NULL);
    } else if (field->kind == FIELD_NUMBER && field->shape != SHAPE_MATRIX) {
        write_numbers(to, field->key, field->bits & ROUNDED, count, (const double *)list, 1);
    } else {
        begin(to, field->key, '[');
        for (int i = 0; i < count; i++)
            if (field->shape == SHAPE_MATRIX)
                write_numbers(to, NULL, field->bits & ROUNDED, integer_at(from, field->columns), (const double *)list + i, count);
            else if (field->kind == FIELD_MAP)
                write_map(to, NULL, integer_at(from, field->columns),
                          (const rotid_component *)list + (ptrdiff_t)i * integer_at(from, field->columns));
            else
                write_value(to, NULL, field, list + (size_t)i * record_element_size(field));
        end(to, ']');
    }
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

static void write_keys(struct json_writer *to, const struct record *record, const void *from)
{
    for (const struct record_field *field = record->field; field->key; field++) {
        if (field->kind == FIELD_COUNT || (field->bits & IF_KNOWN && !is_known(field, from)))
            continue;
        const void *value = target_of(field, from);
        if (field->kind == FIELD_INLINE && value)
            write_keys(to, field->record, value);
        else if (field->kind == FIELD_INLINE)
            continue;
        else if (field->shape != SHAPE_ONE)
            write_list(to, field, from);
        else if (field->kind == FIELD_MAP)
            write_map(to, field->key, integer_at(from, field->columns), value);
        else if (value)
            write_value(to, field->key, field, value);
        else
            write_text(to, field->key, NULL);
    }
}

char *record_text(const struct record *record, const void *from, int lines)
{
    char *text = NULL;
    size_t length;
    struct json_writer to = {.out = open_memstream(&text, &length), .lines = lines};
    if (!to.out)
        return NULL;
    begin(&to, NULL, '{');
    write_keys(&to, record, from);
    end(&to, '}');
    int failed = fputc('\n', to.out) == EOF || ferror(to.out);
    if (fclose(to.out) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}
