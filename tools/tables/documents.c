/* Lists of docs/rotid.1 and tables of docs/deck.md. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "deck/deck_row.h"
#include "generated.h"

/* ---- docs/rotid.1 */

/* Running text: each sentence begins a line, as mdoc wants it, and an option keeps its hyphens. */
static void put_prose(FILE *out, const char *text)
{
    int column = 0;
    for (int first = 1; *text; first = 0) {
        int length = (int)strcspn(text, " "), ends = length > 1 && strchr(".", text[length - 1]) != NULL;
        if (!first && column)
            column += fprintf(out, "%s", column + length > 78 ? "\n" : " ");
        if (!first && column > 78)
            column = 0;
        for (int i = 0; i < length; i++)
            column += fprintf(out, "%s%c", text[i] == '-' && (!i || text[i - 1] == '-') && length > i + 1 ? "\\" : "",
                              i || !first ? text[i] : toupper((unsigned char)text[i]));
        if (ends) {
            (void)fputc('\n', out);
            column = 0;
        }
        text += length + (text[length] == ' ');
    }
    if (column)
        (void)fputc('\n', out);
}

static int is_of_one(const struct option_row *row)
{
    return row->commands && !strchr(row->commands, ' ');
}

static void put_item(FILE *out, const struct option_row *row)
{
    (void)fputs(".It", out);
    for (int letter = row->letter ? 1 : 0; letter >= 0; letter--) {
        if (letter)
            (void)fprintf(out, " Fl %c", row->letter);
        else
            (void)fprintf(out, " Fl -%s", row->name);
        if (row->words) {
            (void)fputs(" Cm ", out);
            put_words(out, row, " | ");
        } else if (row->value) {
            (void)fputs(" Ar ", out);
            for (const char *at = row->value; *at; at++)
                (void)fputc(tolower((unsigned char)*at), out);
        }
        if (letter)
            (void)fputs(" ,", out);
    }
    (void)fputc('\n', out);
    char text[512];
    (void)snprintf(text, sizeof text, "%s", row->help);
    if (row->standard != 0)
        (void)snprintf(text + strlen(text), sizeof text - strlen(text), " (default: %g)", row->standard);
    (void)snprintf(text + strlen(text), sizeof text - strlen(text), ".");
    put_prose(out, text);
    if (row->least < row->most) {
        (void)snprintf(text, sizeof text, "From %.12g to %.12g.", row->least, row->most);
        put_prose(out, text);
    }
    if (row->commands && !is_of_one(row)) {
        int length = snprintf(text, sizeof text, "An option of ");
        for (const char *at = row->commands; *at; at++)
            length += snprintf(text + length, sizeof text - (size_t)length, "%s%c", *at == ' ' ? "," : "", *at);
        (void)snprintf(text + length, sizeof text - (size_t)length, ".");
        put_prose(out, text);
    }
    if (row->more)
        put_prose(out, row->more);
}

/* Rows that belong to the same command, or to all or several, stand together. */
void write_manual(FILE *out, int section)
{
    (void)section;
    for (const struct option_row *row = option_table; row->name; row++) {
        const struct option_row *before = row == option_table ? NULL : row - 1;
        if (!before || is_of_one(before) != is_of_one(row) || (is_of_one(row) && strcmp(before->commands, row->commands) != 0)) {
            if (before)
                (void)fputs(".El\n", out);
            (void)fprintf(out, ".Ss Options of %s\n.Bl -tag -width indent\n",
                          is_of_one(row) ? row->commands : "several commands");
        }
        put_item(out, row);
    }
    (void)fputs(".El\n", out);
}

/* ---- docs/deck.md */

/* `NAME=FIRST` (default), `OTHER`; or `NAME` and what stands behind it, of a number its unit */
static void put_option(FILE *out, const struct deck_row *row)
{
    const char *what = row->what ? row->what : "", *unit = row->kind == ROW_OTHER ? what : strpbrk(what, "[(");
    (void)fprintf(out, "`%s", row->option);
    if (row->words) {
        int standard = row->standard < 0 ? 0 : row->standard;
        (void)fprintf(out, "=%s`%s", row->words[standard], row->standard < 0 ? "" : " (default)");
        for (int i = 0; row->words[i]; i++)
            if (i != standard)
                (void)fprintf(out, ", `%s`", row->words[i]);
        return;
    }
    (void)fprintf(out, "`%s%s", unit && *unit ? " " : "", unit ? unit : "");
    if (row->kind == ROW_NAME && row->bits & ROW_MAY_LACK)
        (void)fputs(" (optional)", out);
}

void write_cards(FILE *out, int section)
{
    (void)fputs("| card | options | data lines |\n| --- | --- | --- |\n", out);
    for (const struct deck_card *kind = deck_card_table; kind->name; kind++) {
        int count = 0;
        if ((int)kind->section != section)
            continue;
        (void)fprintf(out, "| `*%s` |", kind->name);
        for (const struct deck_row *row = kind->row; !deck_row_is_last(row); row++)
            if (row->option) {
                (void)fputs(count++ ? "; " : " ", out);
                put_option(out, row);
            }
        (void)fprintf(out, " | %s |\n", kind->lines ? kind->lines : "none");
    }
}
