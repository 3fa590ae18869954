/* docs/reference.md: every command with its options, every card with its options and data lines, every cause, on one page. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "deck/deck_row.h"
#include "diagnose/causes/causes.h"
#include "generated.h"

/* `-o, --output FILE`, `--method lscf|quadrature` */
static void put_flag(FILE *out, const struct option_row *row)
{
    (void)fputs("`", out);
    if (row->letter)
        (void)fprintf(out, "-%c, ", row->letter);
    (void)fprintf(out, "--%s", row->name);
    if (row->words) {
        (void)fputc(' ', out);
        put_words(out, row, "\\|");
    } else if (row->value) {
        (void)fprintf(out, " %s", row->value);
    }
    (void)fputs("`", out);
}

/* An option of most commands stands in a row of its own. */
static int is_common(const struct option_row *row)
{
    int count = 0, all = 0;
    for (const struct command_entry *entry = command_table; entry->name; entry++, all++)
        count += row->commands && option_of(row, entry->name);
    return 2 * count > all;
}

/* Those of one command, or those of all and of most with NULL. */
static void put_flags(FILE *out, const char *command)
{
    int count = 0;
    for (const struct option_row *row = option_table; row->name; row++)
        if (command ? row->commands && option_of(row, command) && !is_common(row) : !row->commands || is_common(row)) {
            (void)fputs(count++ ? ", " : "", out);
            put_flag(out, row);
        }
}

void write_commands(FILE *out, int section)
{
    (void)section;
    (void)fputs("| `rotid` | what it does | options |\n| --- | --- | --- |\n", out);
    for (const struct command_entry *entry = command_table; entry->name; entry++) {
        (void)fprintf(out, "| `%s %s` | %s | ", entry->name, entry->flags & SEVERAL_FILES ? "FILE..." : "FILE", entry->text);
        put_flags(out, entry->name);
        (void)fputs(" |\n", out);
    }
    (void)fputs("| all or most | | ", out);
    put_flags(out, NULL);
    (void)fputs(" |\n", out);
}

/* `NAME`, `MODEL=RODS\|TUBE` */
static void put_card_option(FILE *out, const struct deck_row *row)
{
    (void)fprintf(out, "`%s", row->option);
    for (int i = 0; row->words && row->words[i]; i++)
        (void)fprintf(out, "%s%s", i ? "\\|" : "=", row->words[i]);
    (void)fputs("`", out);
}

/* Links within docs/deck.md lead there from here. */
static void put_lines(FILE *out, const char *text)
{
    for (; *text; text++)
        (void)fprintf(out, "%c%s", *text, text[0] == '(' && text[1] == '#' ? "deck.md" : "");
}

void write_card_list(FILE *out, int section)
{
    (void)section;
    (void)fputs("| card | options | data lines |\n| --- | --- | --- |\n", out);
    for (const struct deck_card *card = deck_card_table; card->name; card++) {
        int count = 0;
        (void)fprintf(out, "| `*%s` | ", card->name);
        for (const struct deck_row *row = card->row; !deck_row_is_last(row); row++)
            if (row->option) {
                (void)fputs(count++ ? ", " : "", out);
                put_card_option(out, row);
            }
        (void)fputs(count ? " | " : "| ", out);
        put_lines(out, card->lines ? card->lines : "none");
        (void)fputs(" |\n", out);
    }
}

/* Prior of a parameter of a cause, as the evidence has it (src/diagnose/laplace.c); places and widths are alike for all. */
static void put_prior(FILE *out, const struct cause_kind *cause, int p, const struct effect_parameter_name *name, int *count)
{
    const struct cause_parameter *parameter = &cause->parameter[p];
    const char *unit = parameter->prior == PRIOR_SHARE ? "b" : name->unit && name->unit[0] != '1' ? name->unit : "";
    if (p == cause->width || p == cause->place)
        return;
    (void)fprintf(out, "%s%s ", (*count)++ ? "; " : "", name->name);
    if (parameter->prior == PRIOR_FLAT)
        (void)fputs("U", out);
    else if (parameter->prior == PRIOR_GAUSSIAN || parameter->prior == PRIOR_SHARE)
        (void)fprintf(out, "%sN(%g, %g%s%s)", parameter->one_sided ? "H" : "", parameter->neutral, fabs(parameter->scale),
                      *unit ? " " : "", unit);
    else if (parameter->prior == PRIOR_LOG_NORMAL)
        (void)fprintf(out, "lnN(%g, %g)", parameter->neutral, parameter->scale);
    else
        (void)fprintf(out, "lnU(%g)", parameter->scale);
    if (parameter->gross > 0)
        (void)fprintf(out, ", %g of it U", parameter->gross);
}

/* Without the parameters that no explanation has: of numbers, of pairing and of the level of the noise. */
static void put_priors(FILE *out, const struct cause_kind *cause)
{
    int count = 0;
    if (cause->effect)
        for (int p = 0; p < cause->effect->nparameter; p++)
            put_prior(out, cause, p, &cause->effect->parameter[p], &count);
    else if (!strncmp(cause->id, "sensor_", 7))
        for (int p = 0; p < 2 && correction_parameter(cause, p); p++)
            put_prior(out, cause, p, correction_parameter(cause, p), &count);
}

void write_causes(FILE *out, int section)
{
    (void)section;
    (void)fputs("| `TYPE` | cause | check | prior |\n| --- | --- | --- | --- |\n", out);
    for (int i = 0; i < catalogue_count(); i++) {
        (void)fprintf(out, "| `%s` | %s | %s | ", catalogue_item(i)->id, catalogue_item(i)->sentence, catalogue_item(i)->check);
        put_priors(out, catalogue_item(i));
        (void)fputs(" |\n", out);
    }
}
