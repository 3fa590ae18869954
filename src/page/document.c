#include "page/document.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "page/html.h"
#include "page/plain.h"
#include "page/style.h"

/* Nothing runs and nothing is loaded, whatever should get into a page: its style and its pictures stand in it. */
#define POLICY                                                                                                                   \
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "      \
    "base-uri 'none'; form-action 'none'\">\n"

void document_open(struct document *document, struct pool *pool)
{
    *document = (struct document){.pool = pool, .title = "", .subtitle = "", .answer = ""};
}

/* Whether an identifier is this one, or this one with a number. */
static int is_like(const char *id, const char *like)
{
    size_t length = strlen(like);
    if (strncmp(id, like, length) != 0)
        return 0;
    return !id[length] || (id[length] == '-' && id[length + 1] >= '0' && id[length + 1] <= '9');
}

static int count_id(const struct document *document, const char *id)
{
    int count = 0;
    for (const struct page_section *section = document->first; section; section = section->next) {
        count += is_like(section->id, id);
        for (const struct page_block *block = section->first; block; block = block->next)
            count += block->figure && is_like(block->figure->id, id);
    }
    return count;
}

static const char *free_id(struct document *document, const char *id)
{
    int taken = count_id(document, id);
    const char *free = taken ? pool_format(document->pool, "%s-%d", id, taken + 1) : id;
    document->failed |= !free;
    return free ? free : id;
}

void document_section(struct document *document, const char *id, const char *heading)
{
    struct page_section *section = POOL_NEW(document->pool, struct page_section);
    if (!section) {
        document->failed = 1;
        return;
    }
    section->id = free_id(document, id);
    section->heading = document->of ? pool_format(document->pool, "%s: %s", heading, document->of) : heading;
    if (!section->heading) {
        document->failed = 1;
        section->heading = heading;
    }
    if (document->last)
        document->last->next = section;
    else
        document->first = section;
    document->last = section;
}

/* The text as the current section shows it. */
static const char *shown(const struct document *document, const char *text)
{
    return document->verbatim ? text : plain_text(document->pool, text);
}

static void show_table(const struct document *document, struct number_table *table)
{
    for (int j = 0; j < table->columns && !document->verbatim; j++) {
        table->head[j] = shown(document, table->head[j]);
        for (int i = 0; i < table->rows; i++)
            table->cell[i * table->columns + j] = shown(document, table->cell[i * table->columns + j]);
    }
}

void document_answer(struct document *document, const char *of)
{
    struct page_answer *made = POOL_NEW(document->pool, struct page_answer), **at = &document->answers;
    document->failed |= !made;
    if (made && *document->answer) {
        *made = (struct page_answer){.tone = document->tone,
                                     .of = of,
                                     .headline = shown(document, document->headline),
                                     .answer = shown(document, document->answer),
                                     .next = shown(document, document->next)};
        while (*at && (*at)->tone >= made->tone)
            at = &(*at)->following;
        made->following = *at;
        *at = made;
    }
    document->tone = TONE_NONE;
    document->headline = document->next = NULL;
    document->answer = "";
}

static struct page_block *add_block(struct document *document)
{
    struct page_block *block = POOL_NEW(document->pool, struct page_block);
    if (!block || !document->last) {
        document->failed = 1;
        return NULL;
    }
    if (document->last->last)
        document->last->last->next = block;
    else
        document->last->first = block;
    document->last->last = block;
    return block;
}

/* Text of the page written piece by piece. */
struct piece {
    FILE *out;
    char *text;
    size_t length;
};

static FILE *open_piece(struct document *document, struct piece *piece)
{
    *piece = (struct piece){.out = open_memstream(&piece->text, &piece->length)};
    document->failed |= !piece->out;
    return piece->out;
}

static void close_piece(struct document *document, struct piece *piece)
{
    struct page_block *block = fclose(piece->out) == 0 ? add_block(document) : NULL;
    if (block)
        block->html = pool_copy_text(document->pool, piece->text);
    document->failed |= !block || !block->html;
    free(piece->text);
}

void document_paragraph(struct document *document, const char *format, ...)
{
    struct piece piece;
    char *text = NULL;
    size_t length;
    FILE *plain = open_memstream(&text, &length);
    va_list arguments;
    if (!plain) {
        document->failed = 1;
        return;
    }
    va_start(arguments, format);
    (void)vfprintf(plain, format, arguments);
    va_end(arguments);
    if (fclose(plain) == 0 && open_piece(document, &piece)) {
        html_element(piece.out, "p", shown(document, text));
        close_piece(document, &piece);
    }
    free(text);
}

void document_heading(struct document *document, const char *text)
{
    struct piece piece;
    if (!open_piece(document, &piece))
        return;
    html_element(piece.out, "h3", shown(document, text));
    close_piece(document, &piece);
}

void document_list(struct document *document, int count, const char *const text[])
{
    struct piece piece;
    if (!count || !open_piece(document, &piece))
        return;
    (void)fputs("<ul>\n", piece.out);
    for (int i = 0; i < count; i++)
        html_element(piece.out, "li", text[i] ? shown(document, text[i]) : "");
    (void)fputs("</ul>\n", piece.out);
    close_piece(document, &piece);
}

void document_facts(struct document *document, int count, const char *const name[], const char *const value[])
{
    struct piece piece;
    if (!open_piece(document, &piece))
        return;
    (void)fputs("<dl>\n", piece.out);
    for (int i = 0; i < count; i++)
        if (value[i]) {
            (void)fputs("<div>", piece.out);
            html_element(piece.out, "dt", name[i]);
            html_element(piece.out, "dd", shown(document, value[i]));
            (void)fputs("</div>\n", piece.out);
        }
    (void)fputs("</dl>\n", piece.out);
    close_piece(document, &piece);
}

void document_table(struct document *document, const char *caption, struct number_table *table)
{
    struct piece piece;
    char id[32];
    if (!table || !open_piece(document, &piece)) {
        document->failed |= !table;
        return;
    }
    (void)snprintf(id, sizeof id, "table-%d", ++document->ntable);
    show_table(document, table);
    html_table(piece.out, id, caption ? shown(document, caption) : "", table);
    close_piece(document, &piece);
}

struct figure *document_figure(struct document *document, const char *id, const char *title)
{
    static const struct figure nothing = {.id = "", .title = "", .caption = "", .alt = "", .script = NULL};
    id = free_id(document, id);
    struct page_block *block = add_block(document);
    struct figure *figure = POOL_NEW(document->pool, struct figure);
    document->failed |= !figure;
    if (!block || !figure) {
        document->lost = nothing;
        return &document->lost;
    }
    *figure = nothing;
    figure->id = id;
    figure->title = title;
    block->figure = figure;
    document->nfigure++;
    return figure;
}

struct figure **document_figures(const struct document *document)
{
    struct figure **list = POOL_ARRAY(document->pool, struct figure *, document->nfigure);
    int count = 0;
    for (const struct page_section *section = document->first; section && list; section = section->next)
        for (const struct page_block *block = section->first; block; block = block->next)
            if (block->figure)
                list[count++] = block->figure;
    return list;
}

static void write_head(FILE *out, const struct document *document)
{
    (void)fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" POLICY DOCUMENT_MARK " " ROTID_VERSION
                "\">\n"
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                "<meta name=\"color-scheme\" content=\"light dark\">\n",
                out);
    html_element(out, "title", document->title);
    (void)fputs("<style>\n", out);
    style_write(out);
    (void)fputs("</style>\n</head>\n<body>\n", out);
}

static void write_answer(FILE *out, const struct page_answer *answer)
{
    static const char *const words[] = {"plain", "good", "care", "bad"};
    static const char *const says[] = {NULL, "Can be relied on", "To be used with care", "Not to be relied on as it stands"};
    (void)fprintf(out, "<section class=\"answer %s\" aria-label=\"Answer", words[answer->tone]);
    if (answer->of) {
        (void)fputs(": ", out);
        html_text(out, answer->of);
    }
    (void)fputs("\">\n", out);
    if (answer->of)
        html_element(out, "p class=\"of\"", answer->of);
    const char *headline = answer->headline ? answer->headline : says[answer->tone];
    if (headline)
        html_element(out, "p class=\"tone\"", headline);
    html_element(out, "p class=\"says\"", answer->answer);
    if (answer->next)
        html_element(out, "p class=\"next\"", answer->next);
    (void)fputs("</section>\n", out);
}

static void write_answers(FILE *out, const struct document *document)
{
    (void)fputs("<header>\n", out);
    html_element(out, "h1", document->title);
    html_element(out, "p class=\"subtitle\"", document->subtitle);
    (void)fputs("</header>\n<main>\n", out);
    for (const struct page_answer *answer = document->answers; answer; answer = answer->following)
        write_answer(out, answer);
}

/* The texts of a figure, which its maker has filled in since it was added. */
static void show_figure(const struct document *document, struct figure *figure)
{
    figure->title = shown(document, figure->title);
    figure->caption = shown(document, figure->caption);
    figure->alt = shown(document, figure->alt);
    if (figure->table)
        show_table(document, figure->table);
}

static void write_contents(FILE *out, const struct document *document)
{
    (void)fputs("<nav aria-label=\"Contents\"><ul>\n", out);
    for (const struct page_section *section = document->first; section; section = section->next) {
        (void)fprintf(out, "<li><a href=\"#%s\">", section->id);
        html_text(out, section->heading);
        (void)fputs("</a></li>\n", out);
    }
    (void)fputs("</ul></nav>\n", out);
}

void document_write(FILE *out, const struct document *document, const char *made_by, const char *hint)
{
    int number = 0;
    write_head(out, document);
    write_answers(out, document);
    if (hint) {
        (void)fputs("<aside class=\"hint\" aria-label=\"Figures\">", out);
        html_element(out, "p", hint);
        (void)fputs("</aside>\n", out);
    }
    write_contents(out, document);
    for (const struct page_section *section = document->first; section; section = section->next) {
        (void)fprintf(out, "<section id=\"%s\">\n", section->id);
        html_element(out, "h2", section->heading);
        for (const struct page_block *block = section->first; block; block = block->next) {
            if (block->figure) {
                show_figure(document, block->figure);
                html_figure(out, ++number, block->figure);
            } else if (block->html) {
                (void)fputs(block->html, out);
            }
        }
        (void)fputs("</section>\n", out);
    }
    (void)fputs("</main>\n<footer>\n", out);
    html_element(out, "p", made_by);
    (void)fputs("</footer>\n</body>\n</html>\n", out);
}
