#include "page/svg.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page/html.h"
#include "page/svg_tag.h"

#define DEPTH      64 /* of elements: gnuplot needs six */
#define MOST_PARTS 128

struct part { /* of <defs>: a mark or a pattern */
    const char *from, *to;
    char id[32];
    int used;
};

struct open_tag {
    char name[SVG_NAME];
    char *text;  /* what is written once there is something in it; NULL: written already */
    int dropped; /* neither it nor its end is written */
};

struct svg {
    struct pool *pool;
    FILE *out;
    const char *prefix;
    struct open_tag stack[DEPTH];
    int depth, in_text, nparts, failed;
    struct part part[MOST_PARTS];
};

/* What is open and was held back, because there might be nothing in it. */
static void write_open(struct svg *svg)
{
    for (int i = 0; i < svg->depth; i++)
        if (svg->stack[i].text) {
            (void)fputs(svg->stack[i].text, svg->out);
            svg->stack[i].text = NULL;
        }
}

static void mark_used(struct svg *svg, const char *id)
{
    for (int p = 0; p < svg->nparts; p++)
        svg->part[p].used |= !strcmp(svg->part[p].id, id);
}

static void open_element(struct svg *svg, const struct svg_tag *tag, const char *text)
{
    if (svg->depth == DEPTH) {
        svg->failed = 1;
        return;
    }
    struct open_tag *top = &svg->stack[svg->depth++];
    (void)strcpy(top->name, tag->name);
    int plain = !strchr(text, ' '); /* a group without attributes does nothing */
    top->dropped = plain && (!strcmp(tag->name, "g") || !strcmp(tag->name, "tspan"));
    top->text = top->dropped ? NULL : pool_copy_text(svg->pool, text);
    svg->failed |= !top->dropped && !top->text;
    svg->in_text += !strcmp(tag->name, "text");
}

static void close_element(struct svg *svg, const char *name)
{
    if (!svg->depth || strcmp(svg->stack[svg->depth - 1].name, name)) {
        svg->failed = 1;
        return;
    }
    const struct open_tag *top = &svg->stack[svg->depth - 1];
    if (!top->dropped && !top->text)
        (void)fprintf(svg->out, "</%s>", name);
    svg->in_text -= !strcmp(name, "text");
    svg->depth--;
}

/* The background, which the page has itself. */
static int is_ground(struct svg_tag *tag)
{
    return !strcmp(tag->name, "rect") && !strcmp(svg_attribute(tag, "x"), "0");
}

/* Behind "</name>". */
static const char *skip_element(const char *at, const char *end, const char *name)
{
    char close[SVG_NAME + 4];
    (void)snprintf(close, sizeof close, "</%s>", name);
    const char *found = strstr(at, close);
    return found && found < end ? found + strlen(close) : end;
}

/* The children of <defs>, to be written where something uses them. */
static void keep_parts(struct svg *svg, const char *at, const char *end)
{
    struct svg_tag tag;
    while ((at = memchr(at, '<', (size_t)(end - at))) && svg->nparts < MOST_PARTS) {
        const char *next = svg_tag_read(at, end, &tag);
        if (!next || tag.closes) {
            svg->failed |= !next;
            return;
        }
        const char *behind = tag.is_empty ? next : skip_element(next, end, tag.name);
        struct part *part = &svg->part[svg->nparts++];
        *part = (struct part){.from = at, .to = behind};
        (void)snprintf(part->id, sizeof part->id, "%s", svg_attribute(&tag, "id"));
        at = behind;
    }
}

static void clean(struct svg *svg, const char *at, const char *end, int in_parts)
{
    struct svg_tag tag;
    while (at < end && !svg->failed) {
        const char *angle = memchr(at, '<', (size_t)(end - at));
        angle = angle ? angle : end;
        if (svg->in_text && angle > at) {
            write_open(svg);
            (void)fwrite(at, 1, (size_t)(angle - at), svg->out);
        }
        if (angle == end)
            return;
        const char *next = svg_tag_read(angle, end, &tag);
        if (!next) {
            svg->failed = 1;
            return;
        }
        at = next;
        if (tag.closes)
            close_element(svg, tag.name);
        else if (!strcmp(tag.name, "title") || !strcmp(tag.name, "desc")) {
            at = skip_element(next, end, tag.name);
        } else if (!strcmp(tag.name, "defs")) {
            at = skip_element(next, end, "defs");
            keep_parts(svg, next, at);
        } else if (in_parts || !is_ground(&tag)) {
            char used[32], *text = svg_tag_text(svg->pool, &tag, svg->prefix, in_parts, used, sizeof used);
            svg->failed |= !text;
            mark_used(svg, used);
            if (text && !tag.is_empty)
                open_element(svg, &tag, text);
            else if (text) {
                write_open(svg);
                (void)fputs(text, svg->out);
            }
        }
    }
}

/* Parts that are used, and those that they use; a part comes behind those it uses, so one way from the last to the first marks
 * all. */
static void write_parts(struct svg *svg, FILE *out)
{
    int any = 0;
    for (int p = svg->nparts - 1; p >= 0; p--)
        for (int q = 0; svg->part[p].used && q < p; q++) {
            char reference[48];
            (void)snprintf(reference, sizeof reference, "#%s'", svg->part[q].id);
            const char *found = strstr(svg->part[p].from, reference);
            svg->part[q].used |= found && found < svg->part[p].to;
        }
    svg->out = out;
    for (int p = 0; p < svg->nparts; p++) {
        if (!svg->part[p].used || !*svg->part[p].id)
            continue;
        (void)fputs(any ? "" : "<defs>", out);
        any = 1;
        clean(svg, svg->part[p].from, svg->part[p].to, 1);
    }
    (void)fputs(any ? "</defs>" : "", out);
}

char *svg_clean(struct pool *pool, const char *text, const struct figure *figure, int layout)
{
    const char *root = strstr(text, "<svg"), *begin = root ? strchr(root, '>') : NULL, *end = NULL;
    char *body = NULL, *whole = NULL, *kept = NULL, letter = "wn"[layout];
    size_t body_length, length;
    struct svg *svg = POOL_NEW(pool, struct svg);
    for (const char *c = begin; c && (c = strstr(c, "</svg>")); c++)
        end = c;
    if (!svg || !end || end[6 + strspn(end + 6, " \r\n")])
        return NULL;
    svg->pool = pool;
    svg->prefix = pool_format(pool, "%s-%c-", figure->id, letter);
    FILE *out = open_memstream(&body, &body_length);
    svg->out = out;
    if (out && svg->prefix)
        clean(svg, begin + 1, end, 0);
    int failed = !out || !svg->prefix || svg->failed || svg->depth;
    failed |= out && fclose(out) != 0;
    out = failed ? NULL : open_memstream(&whole, &length);
    if (out) {
        (void)fprintf(out, "<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-labelledby=\"%stitle %sdesc\"><title id=\"%stitle\">",
                      layout == WIDE ? WIDE_PX : NARROW_PX, figure->height[layout], svg->prefix, svg->prefix, svg->prefix);
        html_text(out, figure->title);
        (void)fprintf(out, "</title><desc id=\"%sdesc\">", svg->prefix);
        html_text(out, figure->alt);
        (void)fputs("</desc>", out);
        write_parts(svg, out);
        (void)fwrite(body, 1, body_length, out);
        (void)fputs("</svg>", out);
        failed = ferror(out) || svg->failed;
        if (fclose(out) == 0 && !failed)
            kept = pool_copy_text(pool, whole);
    }
    free(body);
    free(whole);
    return kept;
}
