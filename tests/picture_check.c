#include "picture_check.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

#define MOST_OPEN 64
#define NAME      32

struct judge {
    int problems, open;
    char stack[MOST_OPEN][NAME];
};

static void problem(struct judge *judge, const char *what, const char *at)
{
    if (judge->problems++ < 10)
        print_error("picture, %s: %.100s\n", what, at);
}

/* Those of gnuplot, which draw, and of the page, which colour. */
static int is_known(const char *name)
{
    static const char *const names[] = {"svg",      "title",    "desc", "defs",    "g",       "path",    "text",       "tspan",
                                        "rect",     "circle",   "line", "polygon", "use",     "pattern", "filter",     "feFlood",
                                        "polyline", "clipPath", "mask", "symbol",  "ellipse", "style",   "feComposite"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(names[i], name))
            return 1;
    return 0;
}

static int holds(const char *value, size_t length, const char *what)
{
    for (size_t i = 0; i + strlen(what) <= length; i++)
        if (!memcmp(value + i, what, strlen(what)))
            return 1;
    return 0;
}

static void judge_attribute(struct judge *judge, const char *name, const char *value, size_t length)
{
    const char *colon = strchr(name, ':'), *local = colon ? colon + 1 : name;
    if (!strncmp(name, "xmlns", 5))
        return;
    if (!strncmp(local, "on", 2))
        problem(judge, "attribute that runs", name);
    if ((!strcmp(local, "href") || !strcmp(local, "src")) && *value != '#')
        problem(judge, "refers elsewhere", value);
    if (holds(value, length, "url(") && !holds(value, length, "url(#"))
        problem(judge, "refers elsewhere", value);
    static const char *const never[] = {"javascript:", "http:", "https:", "data:", "<"};
    for (size_t i = 0; i < sizeof never / sizeof *never; i++)
        if (holds(value, length, never[i]))
            problem(judge, "has no place in a picture", value);
}

static size_t read_name(const char *at, char name[NAME])
{
    size_t n = 0, length = 0;
    for (; isalnum((unsigned char)at[length]) || (at[length] && strchr(":-_", at[length])); length++)
        if (n < NAME - 1)
            name[n++] = at[length];
    name[n] = 0;
    return length;
}

/* Behind the tag that begins at `at`. */
static const char *judge_tag(struct judge *judge, const char *at)
{
    char name[NAME], attribute[NAME];
    const char *tag = at++;
    int closes = *at == '/', is_empty = 0;
    at += closes;
    at += read_name(at, name);
    if (!is_known(name))
        problem(judge, "element that draws nothing", tag);
    for (at += strspn(at, " \t\r\n"); *at && *at != '>'; at += strspn(at, " \t\r\n")) {
        is_empty = *at == '/';
        if (is_empty) {
            at++;
            continue;
        }
        size_t length = read_name(at, attribute);
        at += length + strspn(at + length, " \t\r\n");
        const char *value = *at == '=' ? at + 1 + strspn(at + 1, " \t\r\n") : NULL,
                   *end = value && (*value == '"' || *value == '\'') ? strchr(value + 1, *value) : NULL;
        if (!length || !end) {
            problem(judge, "attribute without quoted value", tag);
            return at + strlen(at);
        }
        judge_attribute(judge, attribute, value + 1, (size_t)(end - value - 1));
        at = end + 1;
    }
    if (closes && (!judge->open || strcmp(judge->stack[--judge->open], name) != 0))
        problem(judge, "closes what is not open", tag);
    if (!closes && !is_empty && judge->open < MOST_OPEN)
        (void)strcpy(judge->stack[judge->open++], name);
    return *at ? at + 1 : at;
}

int picture_problems(const char *svg)
{
    struct judge judge = {0};
    const char *at = strstr(svg, "<svg");
    if (!at || (at > svg && strncmp(svg, "<?xml", 5) != 0))
        problem(&judge, "begins as no picture", svg);
    while (at && *at) {
        unsigned char c = (unsigned char)*at;
        if (!strncmp(at, "<!--", 4)) {
            at = strstr(at, "-->");
            at = at ? at + 3 : NULL;
        } else if (c == '<') {
            at = judge_tag(&judge, at);
        } else {
            if ((c < 0x20 && !strchr("\t\r\n", c)) ||
                (c == '&' && strncmp(at, "&amp;", 5) != 0 && strncmp(at, "&lt;", 4) != 0 && strncmp(at, "&gt;", 4) != 0 &&
                 strncmp(at, "&quot;", 6) != 0 && strncmp(at, "&apos;", 6) != 0 && strncmp(at, "&#", 2) != 0))
                problem(&judge, "is no text of XML", at);
            at++;
        }
    }
    if (judge.open)
        problem(&judge, "is not closed", judge.stack[judge.open - 1]);
    return judge.problems;
}

char *picture_of_uri(const char *uri)
{
    static const char head[] = "data:image/svg+xml;base64,",
                      digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t length = strcspn(uri, "\""), n = 0;
    if (strncmp(uri, head, sizeof head - 1) != 0 || (length - sizeof head + 1) % 4)
        return NULL;
    char *text = malloc(length);
    unsigned four = 0;
    for (size_t i = sizeof head - 1, k = 0; text && i < length; i++, k++) {
        const char *digit = strchr(digits, uri[i]);
        if (!digit && (uri[i] != '=' || i + 2 < length)) {
            free(text);
            return NULL;
        }
        four = four << 6 | (digit ? (unsigned)(digit - digits) : 0);
        for (int b = 16; b >= 0 && k % 4 == 3; b -= 8)
            text[n++] = (char)(four >> b & 255);
    }
    if (!text)
        return NULL;
    text[n] = 0; /* what stands for = are zero bytes before it */
    return text;
}
