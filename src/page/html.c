#include "page/html.h"

#include <stddef.h>
#include <string.h>

#include "base/text.h"

void html_text(FILE *out, const char *text)
{
    while (*text) {
        size_t bytes = text_utf8(text);
        char c = *text;
        if (!text_visible(text) && c != '\n' && c != '\t')
            (void)fputs(TEXT_REPLACEMENT, out);
        else if (c == '&')
            (void)fputs("&amp;", out);
        else if (c == '<')
            (void)fputs("&lt;", out);
        else if (c == '>')
            (void)fputs("&gt;", out);
        else if (c == '"')
            (void)fputs("&quot;", out);
        else if (c == '\'')
            (void)fputs("&#39;", out);
        else
            (void)fwrite(text, 1, bytes, out);
        text += bytes ? bytes : 1;
    }
}

void html_element(FILE *out, const char *name, const char *text)
{
    (void)fprintf(out, "<%s>", name);
    html_text(out, text);
    (void)fprintf(out, "</%.*s>\n", (int)strcspn(name, " "), name);
}

#define NONE "\xe2\x80\x93" /* the dash of human_fixed */

/* A number, a dash for one that is not there, or nothing. */
static int is_number(const char *cell)
{
    return !*cell || strchr("0123456789+-", *cell) || !strncmp(cell, "\xe2\x88\x92", 3) || !strcmp(cell, NONE);
}

enum look { LOOK_TEXT, LOOK_NUMBERS, LOOK_IDLE };

/* A column without a single value says nothing, and is left out. */
static void judge_columns(const struct number_table *table)
{
    for (int j = 0; j < table->columns; j++) {
        int numbers = 1, idle = j > 0 && table->rows > 0;
        for (int i = 0; i < table->rows; i++) {
            const char *cell = table->cell[i * table->columns + j];
            numbers &= is_number(cell);
            idle &= !*cell || !strcmp(cell, NONE);
        }
        table->look[j] = idle ? LOOK_IDLE : numbers ? LOOK_NUMBERS : LOOK_TEXT;
    }
}

static void write_row(FILE *out, const struct number_table *table, const char *const *cell, const char *first, const char *other)
{
    (void)fputs("<tr>", out);
    for (int j = 0; j < table->columns; j++) {
        const char *element = j ? other : first;
        if (table->look[j] == LOOK_IDLE)
            continue;
        (void)fprintf(out, "<%s%s>", element, table->look[j] == LOOK_NUMBERS ? " class=\"n\"" : "");
        html_text(out, cell[j]);
        (void)fprintf(out, "</%.2s>", element);
    }
    (void)fputs("</tr>\n", out);
}

void html_table(FILE *out, const char *id, const char *caption, const struct number_table *table)
{
    judge_columns(table);
    (void)fprintf(
        out, "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-labelledby=\"%s\">\n<table>\n<caption id=\"%s\"><span>",
        id, id);
    html_text(out, caption);
    (void)fputs("</span></caption>\n<thead>", out);
    write_row(out, table, table->head, "th scope=\"col\"", "th scope=\"col\"");
    (void)fputs("</thead>\n<tbody>\n", out);
    for (int i = 0; i < table->rows; i++)
        write_row(out, table, table->cell + (ptrdiff_t)i * table->columns, "th scope=\"row\"", "td");
    (void)fputs("</tbody></table></div>\n", out);
}

static void write_numbers(FILE *out, const struct figure *figure)
{
    char id[96];
    if (!figure->table)
        return;
    (void)snprintf(id, sizeof id, "%s-numbers", figure->id);
    if (figure->picture[WIDE])
        (void)fputs("<details><summary>Numbers of this figure</summary>\n", out);
    html_table(out, id, figure->title, figure->table);
    if (figure->picture[WIDE])
        (void)fputs("</details>\n", out);
}

void html_figure(FILE *out, int number, const struct figure *figure)
{
    (void)fprintf(out, "<div class=\"set\">\n<figure id=\"%s\">\n<h3>", figure->id);
    html_text(out, figure->title);
    (void)fputs("</h3>\n", out);
    for (int l = 0; l < LAYOUTS && figure->picture[WIDE]; l++) {
        static const char *const names[LAYOUTS] = {"wide", "narrow"};
        (void)fprintf(out, "<img class=\"%s\" width=\"%d\" height=\"%d\" alt=\"", names[l], l == WIDE ? WIDE_PX : NARROW_PX,
                      figure->height[l]);
        html_text(out, figure->alt);
        (void)fprintf(out, "\" src=\"%s\">\n", figure->picture[l]);
    }
    (void)fprintf(out, "<figcaption><b>Figure %d.</b> ", number);
    html_text(out, figure->caption);
    (void)fputs("</figcaption>\n</figure>\n", out);
    write_numbers(out, figure);
    (void)fprintf(out, "<p class=\"files\"><a href=\"figures/%s.gp\">gnuplot script</a>", figure->id);
    if (figure->picture[WIDE])
        (void)fprintf(out, ", <a href=\"figures/%s.svg\">SVG</a>", figure->id);
    if (figure->has_pdf)
        (void)fprintf(out, ", <a href=\"figures/%s.pdf\">PDF</a>", figure->id);
    (void)fputs("</p>\n</div>\n", out);
}
