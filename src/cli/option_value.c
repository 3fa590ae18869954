/* Values of options, of each kind: nonzero after saying what was expected. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/arguments.h"
#include "cli/options.h"

static int take_number(const struct option_row *row, const char *text, double *value)
{
    char *end;
    int whole = row->kind != OPTION_REAL;
    *value = strtod(text, &end);
    if (end != text && !*end && *value >= row->least && *value <= row->most && (!whole || *value == floor(*value)))
        return 0;
    terminal_say("rotid: --%s %s: expected a %snumber from %g to %g\n", row->name, text, whole ? "whole " : "", row->least,
                 row->most);
    return EXIT_USAGE;
}

static int take_word(const struct option_row *row, const char *text, int *index)
{
    for (*index = 0; row->words[*index]; ++*index)
        if (same_text(text, row->words[*index]))
            return 0;
    terminal_say("rotid: --%s %s: expected ", row->name, text);
    for (int i = 0; row->words[i]; i++)
        terminal_say("%s%s", !i ? "" : row->words[i + 1] ? ", " : " or ", row->words[i]);
    terminal_say("\n");
    return EXIT_USAGE;
}

/* Frequencies separated by commas: how many, or 0 after an error. */
static int frequencies(const struct option_row *row, const char *text, int most, double *hz)
{
    int count = 0;
    for (const char *at = text; count < most; at++) {
        char *end;
        hz[count] = strtod(at, &end);
        if (end == at || !(hz[count] >= row->least && hz[count] <= row->most) || (*end && *end != ','))
            break;
        count++;
        if (!*end)
            return count;
        at = end;
    }
    terminal_say("rotid: --%s %s: expected frequencies from %g to %g Hz, separated by commas\n", row->name, text, row->least,
                 row->most);
    return 0;
}

static int take_band(const struct option_row *row, const char *text, struct ema_options *ema)
{
    double hz[2];
    int count = frequencies(row, text, 2, hz);
    if (!count)
        return EXIT_USAGE;
    if (count != 2 || !(hz[1] > hz[0]))
        return arguments_wrong("--band %s: expected two frequencies, the lower one first", text);
    ema->low_hz = hz[0];
    ema->high_hz = hz[1];
    return 0;
}

static int take_picks(struct command *command, const struct option_row *row, const char *text, struct ema_options *ema)
{
    int most = (int)strlen(text) / 2 + 1;
    double *hz = POOL_ARRAY(&command->pool, double, most);
    if (!hz)
        return command_fail(command, ROTID_ERROR_MEMORY);
    ema->npick = frequencies(row, text, most, hz);
    ema->pick_hz = hz;
    return ema->npick ? 0 : EXIT_USAGE;
}

static int take_shard(const char *text, struct study_arguments *study)
{
    int end = 0;
    if (sscanf(text, "%9d/%9d%n", &study->shard, &study->shards, &end) != 2 || text[end] || study->shard < 1 ||
        study->shard > study->shards)
        return arguments_wrong("--shard %s: expected I/N with I from 1 to N", text);
    return 0;
}

static int take_override(struct command *command, const char *text)
{
    if (override_parse(&command->pool, text, &command->override[command->noverride]))
        return arguments_wrong("--set %s: expected CARD.OPTION=VALUE", text);
    command->noverride++;
    return 0;
}

int option_take(struct command *command, const struct option_row *row, const char *text)
{
    void *member = (char *)command + row->offset;
    double number = 0;
    int index = 0, wrong = 0;
    if (row->kind == OPTION_WHOLE || row->kind == OPTION_SEED || row->kind == OPTION_REAL)
        wrong = take_number(row, text, &number);
    else if (row->words)
        wrong = take_word(row, text, &index);
    if (wrong)
        return wrong;
    switch (row->kind) {
    case OPTION_SWITCH:
        *(int *)member = 1;
        return 0;
    case OPTION_TEXT:
    case OPTION_WRITES:
        *(const char **)member = text;
        return 0;
    case OPTION_WORD:
        *(int *)member = index;
        return 0;
    case OPTION_WHOLE:
        *(int *)member = (int)number;
        return 0;
    case OPTION_SEED:
        *(unsigned long *)member = (unsigned long)number;
        return 0;
    case OPTION_REAL:
        *(double *)member = number;
        return 0;
    case OPTION_BAND:
        return take_band(row, text, member);
    case OPTION_PICK:
        return take_picks(command, row, text, member);
    case OPTION_SHARD:
        return take_shard(text, member);
    case OPTION_OVERRIDE:
        return take_override(command, text);
    default:
        return 0;
    }
}

void option_set_standards(struct command *command)
{
    for (const struct option_row *row = option_table; row->name; row++) {
        void *member = (char *)command + row->offset;
        if (row->kind == OPTION_WHOLE)
            *(int *)member = (int)row->standard;
        else if (row->kind == OPTION_SEED)
            *(unsigned long *)member = (unsigned long)row->standard;
        else if (row->kind == OPTION_REAL)
            *(double *)member = row->standard;
    }
}
