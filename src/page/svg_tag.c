#include "page/svg_tag.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page/palette.h"

static int is(const struct svg_attribute *a, const char *name)
{
    return (int)strlen(name) == a->name_length && !memcmp(a->name, name, (size_t)a->name_length);
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && isspace((unsigned char)*at))
        at++;
    return at;
}

const char *svg_tag_read(const char *at, const char *end, struct svg_tag *tag)
{
    int n = 0;
    *tag = (struct svg_tag){.is_empty = 0};
    if (end - at > 4 && !memcmp(at, "<!--", 4)) {
        const char *over = strstr(at, "-->");
        (void)strcpy(tag->name, "!");
        tag->is_empty = 1;
        return over && over + 3 <= end ? over + 3 : NULL;
    }
    at++;
    tag->closes = at < end && *at == '/';
    at += tag->closes;
    while (at < end && isalnum((unsigned char)*at) && n < SVG_NAME - 1)
        tag->name[n++] = *at++;
    while ((at = skip_blanks(at, end)) < end && *at != '>' && *at != '/') {
        struct svg_attribute a = {.name = at};
        while (at < end && (isalnum((unsigned char)*at) || strchr(":-_", *at)))
            at++;
        a.name_length = (int)(at - a.name);
        at = skip_blanks(at, end);
        if (!a.name_length || at == end || *at != '=')
            return NULL;
        at = skip_blanks(at + 1, end);
        char quote = at < end ? *at : 0;
        const char *close = quote == '"' || quote == '\'' ? memchr(at + 1, quote, (size_t)(end - at - 1)) : NULL;
        if (!close || tag->count == SVG_ATTRIBUTES)
            return NULL;
        a.value = at + 1;
        a.value_length = (int)(close - a.value);
        tag->attribute[tag->count++] = a;
        at = close + 1;
    }
    tag->is_empty = at < end && *at == '/';
    at += tag->is_empty;
    return n && at < end && *at == '>' ? at + 1 : NULL;
}

const char *svg_attribute(struct svg_tag *tag, const char *name)
{
    for (int i = 0; i < tag->count; i++)
        if (is(&tag->attribute[i], name)) {
            (void)snprintf(tag->value, sizeof tag->value, "%.*s", tag->attribute[i].value_length, tag->attribute[i].value);
            return tag->value;
        }
    return "";
}

/* The role of a colour as gnuplot writes it: a name, "rgb( 27, 31, 36)" or "#1b1f24". */
static const struct role *role_of(const char *value, int length)
{
    char text[48];
    unsigned r, g, b;
    if (length >= (int)sizeof text)
        return NULL;
    memcpy(text, value, (size_t)length);
    text[length] = 0;
    if (!strcmp(text, "black"))
        return palette_role(palette[0].light);
    if (!strcmp(text, "white"))
        return palette_role(0xffffff);
    if (sscanf(text, "rgb(%u,%u,%u)", &r, &g, &b) == 3 || sscanf(text, "#%2x%2x%2x", &r, &g, &b) == 3) /* NOLINT: small */
        return palette_role(r << 16 | g << 8 | b);
    return NULL;
}

struct writer {
    FILE *out;
    char classes[96];
    const char *prefix;
    char *used;
    size_t room;
};

static void write_value(struct writer *writer, const char *name, const char *value, int length)
{
    while (length && isspace((unsigned char)*value)) {
        value++;
        length--;
    }
    (void)fprintf(writer->out, " %s=\"%.*s\"", name, length, value);
}

/* fill, stroke or color. */
static void write_color(struct writer *writer, const char *property, const char *value, int length)
{
    const struct role *role = role_of(value, length);
    if (!role) {
        write_value(writer, property, value, length);
        return;
    }
    size_t used = strlen(writer->classes), room = sizeof writer->classes - used;
    int more = snprintf(writer->classes + used, room, "%s%c-%s", used ? " " : "",
                        !strcmp(property, "fill")     ? 'f'
                        : !strcmp(property, "stroke") ? 's'
                                                      : 'k',
                        role->name);
    for (char *c = writer->classes + used; more > 0 && *c; c++)
        *c = (char)tolower((unsigned char)*c);
}

/* "fill:none; stroke:rgb(0,114,178)" */
static void write_style(struct writer *writer, const char *value, int length)
{
    const char *end = value + length;
    while (value < end) {
        char name[24];
        const char *colon = memchr(value, ':', (size_t)(end - value)), *next;
        if (!colon)
            return;
        next = memchr(colon, ';', (size_t)(end - colon));
        next = next ? next : end;
        (void)snprintf(name, sizeof name, "%.*s", (int)(colon - value), value);
        write_color(writer, name, colon + 1, (int)(next - colon - 1));
        value = skip_blanks(next + (next < end), end);
    }
}

/* "#gpPt6" or "url(#gpPat1)" */
static void write_reference(struct writer *writer, const char *name, const char *value, int length)
{
    const char *hash = memchr(value, '#', (size_t)length), *end = value + length;
    end -= end[-1] == ')';
    (void)snprintf(writer->used, writer->room, "%.*s", (int)(end - hash - 1), hash + 1);
    (void)fprintf(writer->out, " %s=\"%.*s#%s%s%s\"", name, (int)(hash - value), value, writer->prefix, writer->used,
                  end < value + length ? ")" : "");
}

/* What the style of the page says for all pictures, or what says nothing. */
static int is_idle(const struct svg_tag *tag, const struct svg_attribute *a)
{
    static const char *const idle[][2] = {{"stroke-linecap", "butt"}, {"stroke-linejoin", "miter"}, {"stroke-width", "1.00"},
                                          {"font-size", "12.00"},     {"font-size", "12.0"},        {"fill-opacity", "1.000000"}};
    static const char *const always[] = {"font-family", "class", "xml:space", "font-weight", "font-style"};
    static const char *const of_groups[][2] = {{"fill", "none"}, {"stroke", "currentColor"}, {"stroke", "black"}};
    int is_group = !strcmp(tag->name, "g");
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++)
        if (is(a, idle[i][0]) && !strncmp(a->value, idle[i][1], (size_t)a->value_length))
            return 1;
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        if (is(a, always[i]))
            return strncmp(a->value, "bold", 4) != 0 && strncmp(a->value, "italic", 6) != 0;
    for (size_t i = 0; i < sizeof of_groups / sizeof *of_groups && is_group; i++)
        if (is(a, of_groups[i][0]) && !strncmp(a->value, of_groups[i][1], (size_t)a->value_length))
            return 1;
    return is_group && is(a, "color");
}

static void write_attribute(struct writer *writer, const struct svg_tag *tag, const struct svg_attribute *a, int in_defs)
{
    char name[32];
    (void)snprintf(name, sizeof name, "%.*s", a->name_length, a->name);
    int refers = memchr(a->value, '#', (size_t)a->value_length) && (!strcmp(name, "xlink:href") || !strncmp(a->value, "url(", 4));
    if (!strcmp(name, "id")) {
        if (in_defs)
            (void)fprintf(writer->out, " id=\"%s%.*s\"", writer->prefix, a->value_length, a->value);
    } else if (is_idle(tag, a)) {
        return;
    } else if (refers) {
        write_reference(writer, !strcmp(name, "xlink:href") ? "href" : name, a->value, a->value_length);
    } else if (!strcmp(name, "fill") || !strcmp(name, "stroke") || !strcmp(name, "color")) {
        write_color(writer, name, a->value, a->value_length);
    } else if (!strcmp(name, "style")) {
        write_style(writer, a->value, a->value_length);
    } else {
        write_value(writer, name, a->value, a->value_length);
    }
}

char *svg_tag_text(struct pool *pool, const struct svg_tag *tag, const char *prefix, int in_defs, char *used, size_t room)
{
    char *text = NULL, *kept = NULL;
    size_t length;
    *used = 0;
    if (!strcmp(tag->name, "!"))
        return pool_copy_text(pool, "");
    struct writer writer = {.out = open_memstream(&text, &length), .prefix = prefix, .used = used, .room = room};
    if (!writer.out)
        return NULL;
    (void)fprintf(writer.out, "<%s", tag->name);
    for (int i = 0; i < tag->count; i++)
        write_attribute(&writer, tag, &tag->attribute[i], in_defs);
    if (*writer.classes)
        (void)fprintf(writer.out, " class=\"%s\"", writer.classes);
    (void)fputs(tag->is_empty ? "/>" : ">", writer.out);
    if (fclose(writer.out) == 0)
        kept = pool_copy_text(pool, text);
    free(text);
    return kept;
}
