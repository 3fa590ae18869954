#include "generated.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "cli/arguments.h"
#include "cli/options.h"
#include "deck/card_table.h"

/* ---- words */

static void put_commands(FILE *out)
{
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "%s%s", c == command_table ? "" : " ", c->name);
}

static void put_words(FILE *out, const struct option_row *row, const char *between)
{
    for (int i = 0; row->words && row->words[i]; i++)
        (void)fprintf(out, "%s%s", i ? between : "", row->words[i]);
}

/* A text with each character of `special` behind `escape`. */
static void put_escaped(FILE *out, const char *text, const char *special, const char *escape)
{
    for (; *text; text++)
        (void)fprintf(out, "%s%c", strchr(special, *text) ? escape : "", *text);
}

/* Endings separated by bars, each between two texts. */
static void put_endings(FILE *out, const char *files, const char *before, const char *after)
{
    while (*files) {
        int length = (int)strcspn(files, "|");
        (void)fprintf(out, "%s%.*s%s", before, length, files, after);
        files += length + (files[length] == '|');
    }
}

static int takes_value(const struct option_row *row)
{
    return row->kind > OPTION_SWITCH;
}

/* ---- completions */

/* Names; commands; "" without a value, words, files and their endings, or value */
static void write_bash(FILE *out, int section)
{
    (void)section;
    (void)fputs("_rotid_commands=(\n", out);
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "    '%s:%s'\n", c->name, c->files);
    (void)fputs(")\n_rotid_options=(\n", out);
    for (const struct option_row *row = option_table; row->name; row++) {
        (void)fprintf(out, "    '%s--%s:", row->letter ? "-o " : "", row->name);
        if (row->commands)
            (void)fputs(row->commands, out);
        else
            put_commands(out);
        (void)fprintf(out, ":%s:%s",
                      row->words         ? "words"
                      : row->files       ? "files"
                      : takes_value(row) ? "value"
                                         : "",
                      row->files ? row->files : "");
        put_words(out, row, " ");
        (void)fputs("'\n", out);
    }
    (void)fputs(")\n", out);
}

static void write_zsh(FILE *out, int section)
{
    (void)section;
    (void)fputs("_rotid_rows() {\n    commands=(\n", out);
    for (const struct command_entry *c = command_table; c->name; c++) {
        (void)fprintf(out, "        '%s:", c->name);
        put_escaped(out, c->text, "'", "'\\'");
        (void)fputs("'\n", out);
    }
    (void)fputs("    )\n    case $command in\n", out);
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "        %s) file='*.(#i)(%s)(-.)' ;;\n", c->name, c->files);
    (void)fputs("    esac\n", out);
    for (const struct option_row *row = option_table; row->name; row++) {
        (void)fputs("    ", out);
        if (row->commands) {
            (void)fputs("[[ $command == (", out);
            for (const char *at = row->commands; *at; at++)
                (void)fputc(*at == ' ' ? '|' : *at, out);
            (void)fputs(") ]] && ", out);
        }
        (void)fputs("rows+=(", out);
        if (row->kind == OPTION_OVERRIDE)
            (void)fputs("'*", out);
        else
            (void)fprintf(out, row->letter ? "'(-o --%s)'{-o," : row->kind <= OPTION_HELP ? "'(- *)" : "'", row->name);
        (void)fprintf(out, row->letter ? "--%s}'[" : "--%s[", row->name);
        put_escaped(out, row->help, "[]:", "\\");
        (void)fputc(']', out);
        if (takes_value(row)) {
            (void)fputc(':', out);
            put_escaped(out, row->value ? row->value : row->name, "[]:", "\\");
            if (row->files)
                (void)fprintf(out, strcmp(row->files, "/") ? ":_files -g \"*.(%s)(-.)\"" : ":_files -%s", row->files);
            else if (row->words) {
                (void)fputs(":(", out);
                put_words(out, row, " ");
                (void)fputc(')', out);
            } else if (row->kind == OPTION_OVERRIDE)
                (void)fputs(":($overrides)", out);
        }
        (void)fputs("')\n", out);
    }
    (void)fputs("}\n", out);
}

static void write_fish(FILE *out, int section)
{
    (void)section;
    (void)fputs("set -l commands ", out);
    put_commands(out);
    (void)fputs("\nset -l none \"not __fish_seen_subcommand_from $commands\"\n", out);
    for (const struct command_entry *c = command_table; c->name; c++) {
        (void)fprintf(out, "complete -c rotid -n $none -a %s -d '", c->name);
        put_escaped(out, c->text, "'\\", "\\");
        (void)fprintf(out, "'\ncomplete -c rotid -n '__fish_seen_subcommand_from %s' -k -a '(", c->name);
        put_endings(out, c->files, "__fish_complete_suffix .", "; ");
        (void)fputs(")'\n", out);
    }
    for (const struct option_row *row = option_table; row->name; row++) {
        (void)fputs("complete -c rotid", out);
        if (row->commands)
            (void)fprintf(out, " -n '__fish_seen_subcommand_from %s'", row->commands);
        (void)fprintf(out, "%s -l %s", row->letter ? " -s o" : "", row->name);
        if (takes_value(row))
            (void)fputs(row->files ? " -r -F" : " -x", out);
        if (row->words) {
            (void)fputs(" -a '", out);
            put_words(out, row, " ");
            (void)fputc('\'', out);
        } else if (row->kind == OPTION_OVERRIDE)
            (void)fputs(" -a $overrides", out);
        (void)fputs(" -d '", out);
        put_escaped(out, row->help, "'\\", "\\");
        (void)fputs("'\n", out);
    }
}

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
        (void)fprintf(out, letter ? " Fl o" : " Fl -%s", row->name);
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
static void write_manual(FILE *out, int section)
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

static void write_cards(FILE *out, int section)
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

/* ---- */

#define SHELL(PATH, WRITE)                                                                                                       \
    {                                                                                                                            \
        PATH, "# what follows is written by make tables\n", "# end of what make tables writes\n", WRITE, 0                       \
    }
#define CARDS(NAME, SECTION)                                                                                                     \
    {                                                                                                                            \
        "docs/deck.md", "<!-- " NAME ", written by make tables -->\n", "<!-- end -->\n", write_cards, SECTION                    \
    }

const struct generated generated_parts[] = {
    SHELL("completions/rotid.bash", write_bash),
    SHELL("completions/_rotid", write_zsh),
    SHELL("completions/rotid.fish", write_fish),
    {"docs/rotid.1", ".\\\" what follows is written by make tables\n", ".\\\" end of what make tables writes\n", write_manual, 0},
    CARDS("cards of the model", CARD_MODEL),
    CARDS("cards of the measured data", CARD_MEASURED),
    CARDS("card of the causes", CARD_CAUSE),
    CARDS("cards of the identification", CARD_IDENTIFICATION),
    CARDS("card of the transfer functions", CARD_FRF),
    {NULL, NULL, NULL, NULL, 0}};

char *generated_text(const struct generated *part, const char *text)
{
    const char *begin = strstr(text, part->begin), *end = begin ? strstr(begin, part->end) : NULL;
    char *whole = NULL;
    size_t size;
    FILE *out = end ? open_memstream(&whole, &size) : NULL;
    if (!out)
        return NULL;
    (void)fwrite(text, 1, (size_t)(begin - text) + strlen(part->begin), out);
    part->write(out, part->section);
    (void)fputs(end, out);
    if (fclose(out)) {
        free(whole);
        return NULL;
    }
    return whole;
}
