/* Completions of bash, zsh and fish. */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "generated.h"

static void put_commands(FILE *out)
{
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "%s%s", c == command_table ? "" : " ", c->name);
}

void put_words(FILE *out, const struct option_row *row, const char *between)
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

/* Names; commands; "" without a value, words, files and their endings, or value */
void write_bash(FILE *out, int section)
{
    (void)section;
    (void)fputs("_rotid_commands=(\n", out);
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "    '%s:%s'\n", c->name, c->files);
    (void)fputs(")\n_rotid_options=(\n", out);
    for (const struct option_row *row = option_table; row->name; row++) {
        (void)fputs("    '", out);
        if (row->letter)
            (void)fprintf(out, "-%c ", row->letter);
        (void)fprintf(out, "--%s:", row->name);
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

void write_zsh(FILE *out, int section)
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
            (void)fputs(row->kind <= OPTION_HELP ? "'(- *)" : row->letter ? "'(" : "'", out);
        if (row->letter && row->kind > OPTION_HELP)
            (void)fprintf(out, "-%c --%s)", row->letter, row->name);
        if (row->letter)
            (void)fprintf(out, "'{-%c,", row->letter);
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

void write_fish(FILE *out, int section)
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
        if (row->letter)
            (void)fprintf(out, " -s %c", row->letter);
        (void)fprintf(out, " -l %s", row->name);
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
