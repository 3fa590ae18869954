/* What --help says. */
#include <stdio.h>
#include <string.h>

#include "cli/arguments.h"
#include "cli/options.h"

static void print_option(FILE *out, const struct option_row *row)
{
    char left[128];
    int length = row->letter ? snprintf(left, sizeof left, "-%c, ", row->letter) : 0;
    length += snprintf(left + length, sizeof left - (size_t)length, "--%s", row->name);
    if (row->value)
        length += snprintf(left + length, sizeof left - (size_t)length, " %s", row->value);
    for (int i = 0; row->words && row->words[i]; i++)
        length += snprintf(left + length, sizeof left - (size_t)length, "%c%s", i ? '|' : ' ', row->words[i]);
    (void)fprintf(out, "  %-24s %s%s", left, length > 24 ? "\n                           " : "", row->help);
    if (row->standard != 0)
        (void)fprintf(out, " (default: %g)", row->standard);
    (void)fputc('\n', out);
}

/* Those of one command alone, of several, of all. */
static void print_options(FILE *out, const char *command, int of_all)
{
    for (const struct option_row *row = option_table; row->name; row++)
        if (row->commands ? !of_all && option_of(row, command) : of_all)
            print_option(out, row);
}

/* Command lines separated by line feeds. */
static void print_examples(FILE *out, const char *examples)
{
    (void)fputs("\nexamples:\n", out);
    for (const char *at = examples; *at; at += strcspn(at, "\n") + (at[strcspn(at, "\n")] == '\n'))
        (void)fprintf(out, "  %.*s\n", (int)strcspn(at, "\n"), at);
}

void help_print(FILE *out, const struct command_entry *entry)
{
    if (entry) {
        (void)fprintf(out, "usage: rotid %s %s [options]\n\n  %s\n\n", entry->name,
                      entry->flags & SEVERAL_FILES ? "FILE..." : "FILE", entry->text);
        print_options(out, entry->name, 0);
    } else {
        (void)fputs("usage: rotid COMMAND FILE [options]\n\n", out);
        for (const struct command_entry *c = command_table; c->name; c++)
            (void)fprintf(out, "  %-12s %s\n", c->name, c->text);
        (void)fputs("\nrotid COMMAND --help lists the options of a command. Of all commands:\n\n", out);
    }
    print_options(out, entry ? entry->name : "", 1);
    if (entry)
        print_examples(out, entry->examples);
    (void)fputs(
        "\n"
        "exit: 0 computed and converged, diagnose: any verdict; 1 computed, not to be trusted as it stands or interrupted;\n"
        "      2 wrong usage or input; 3 failure\n",
        out);
}
