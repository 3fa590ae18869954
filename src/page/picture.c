#include "page/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page/palette.h"

/* Rules for what has this colour, in the ways in which gnuplot writes one: as an attribute of lines and faces, of texts, and in
 * the style of a hatching. None where the picture does not have it. */
static void rule(FILE *out, const char *svg, const char *color, unsigned dark)
{
    static const char *const properties[] = {"fill", "stroke", "color"};
    if (!strstr(svg, color))
        return;
    for (size_t p = 0; p < sizeof properties / sizeof *properties; p++)
        (void)fprintf(out, "[%s=\"%s\"]{%s:#%06x}", properties[p], color, properties[p], dark);
    (void)fprintf(out, "[style*=\"stroke:%s\"]{stroke:#%06x!important}", color, dark);
}

static void style(FILE *out, const char *svg)
{
    (void)fputs("<style>[font-family]{font-family:Arial,\"Liberation Sans\",Helvetica,sans-serif}\n"
                "@media screen and (prefers-color-scheme:dark){",
                out);
    for (const struct role *role = palette; role->name; role++) {
        unsigned r = role->light >> 16, g = role->light >> 8 & 255, b = role->light & 255;
        char color[4][24];
        (void)snprintf(color[0], sizeof color[0], "rgb(%3u, %3u, %3u)", r, g, b);
        (void)snprintf(color[1], sizeof color[1], "rgb(%u,%u,%u)", r, g, b);
        (void)snprintf(color[2], sizeof color[2], "#%06x", role->light);
        (void)snprintf(color[3], sizeof color[3], "%s", role == palette ? "black" : ""); /* what has no colour of its own */
        for (int i = 0; i < 4; i++)
            if (*color[i])
                rule(out, svg, color[i], role->dark);
    }
    (void)fputs("}</style>", out);
}

static void base64(FILE *out, const char *text, size_t length)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *byte = (const unsigned char *)text;
    for (size_t i = 0; i < length; i += 3) {
        size_t there = length - i < 3 ? length - i : 3;
        unsigned three = byte[i] * 65536u + (there > 1 ? byte[i + 1] * 256u : 0) + (there > 2 ? byte[i + 2] : 0);
        for (size_t k = 0; k < 4; k++)
            (void)fputc(k > there ? '=' : digit[three >> (18 - 6 * k) & 63], out);
    }
}

/* Behind the tag of the root, NULL where the text does not end with that element: gnuplot was stopped. */
static const char *behind_root(const char *svg)
{
    const char *root = strstr(svg, "<svg"), *behind = root ? strchr(root, '>') : NULL;
    size_t length = strlen(svg);
    while (length && strchr(" \r\n", svg[length - 1]))
        length--;
    return behind && svg + length >= behind + 7 && !strncmp(svg + length - 6, "</svg>", 6) ? behind + 1 : NULL;
}

const char *picture_uri(struct pool *pool, const char *svg)
{
    const char *body = behind_root(svg), *kept = NULL;
    char *whole = NULL, *uri = NULL;
    size_t length;
    FILE *out = body ? open_memstream(&whole, &length) : NULL;
    if (!out)
        return NULL;
    (void)fwrite(svg, 1, (size_t)(body - svg), out);
    style(out, svg);
    (void)fputs(body, out);
    int failed = ferror(out);
    failed |= fclose(out) != 0;
    out = failed ? NULL : open_memstream(&uri, &(size_t){0});
    if (out) {
        (void)fputs("data:image/svg+xml;base64,", out);
        base64(out, whole, length);
        failed = ferror(out);
        if (fclose(out) == 0 && !failed)
            kept = pool_copy_text(pool, uri);
    }
    free(whole);
    free(uri);
    return kept;
}
