#include "cli/arguments_ema.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/arguments.h"

#define MOST_HZ 1e7

const char *const ema_options_help =
    "  --band LOW,HIGH          ema: in hertz (all lines)\n"
    "  --method M, --order N    ema: lscf or quadrature; highest order of the denominator (from the band)\n"
    "  --pick F1,F2,...         ema: modes nearest to these frequencies [Hz] instead of the stable ones\n"
    "  --per-point              ema: a frequency for each point as well (a roving accelerometer has a mass)\n"
    "  --no-refinement          ema: poles as the least-squares complex frequency method leaves them\n"
    "  --reference N            ema: only transfer functions over this node\n"
    "  --averages K             ema: impacts behind the coherences of the file\n"
    "  --estimator E            ema, time records: H1 (noise on the response), H2 (on the force) or HV (on both)\n"
    "  --exponential P          ema, time records: end value of the exponential window, such as 0.01 (none)\n"
    "  --force-window S, --block S, --pretrigger S   ema, time records: in seconds; a force window below zero: none\n"
    "  --threshold R, --keep-double-hits   ema, time records: share of the largest force that is an impact (0.1)\n";

static int word(const char *option, const char *value, const char *const *words, int *index)
{
    for (*index = 0; words[*index]; ++*index)
        if (same_text(value, words[*index]))
            return -1;
    terminal_say("rotid: %s %s: expected one of", option, value);
    for (int i = 0; words[i]; i++)
        terminal_say("%s %s", i ? "," : "", words[i]);
    terminal_say("\n");
    return EXIT_USAGE;
}

/* Frequencies separated by commas: how many, or 0 after an error. */
static int frequencies(const char *option, const char *value, int most, double *hz)
{
    int count = 0;
    for (const char *at = value; count < most; at++) {
        char *end;
        hz[count] = strtod(at, &end);
        if (end == at || !(hz[count] >= 0 && hz[count] <= MOST_HZ) || (*end && *end != ','))
            break;
        count++;
        if (!*end)
            return count;
        at = end;
    }
    terminal_say("rotid: %s %s: expected frequencies from 0 to %g Hz, separated by commas\n", option, value, MOST_HZ);
    return 0;
}

static int take_band(struct command *command, const char *value)
{
    double hz[2];
    int count = frequencies("--band", value, 2, hz);
    if (!count)
        return EXIT_USAGE;
    if (count != 2 || !(hz[1] > hz[0]))
        return arguments_wrong("--band %s: expected two frequencies, the lower one first", value);
    command->ema.options.low_hz = hz[0];
    command->ema.options.high_hz = hz[1];
    return -1;
}

static int take_picks(struct command *command, const char *value)
{
    int most = (int)strlen(value) / 2 + 1;
    double *hz = POOL_ARRAY(&command->pool, double, most);
    if (!hz)
        return command_fail(command, ROTID_ERROR_MEMORY);
    command->ema.options.npick = frequencies("--pick", value, most, hz);
    command->ema.options.pick_hz = hz;
    return command->ema.options.npick ? -1 : EXIT_USAGE;
}

static int whole(const char *option, const char *value, int least, int most, int *number)
{
    double n;
    if (arguments_number(option, value, least, most, 1, &n))
        return EXIT_USAGE;
    *number = (int)n;
    return -1;
}

static int real(const char *option, const char *value, double least, double most, double *number)
{
    return arguments_number(option, value, least, most, 0, number) ? EXIT_USAGE : -1;
}

int arguments_ema(struct command *command, int option, const char *value)
{
    static const char *const methods[] = {"lscf", "quadrature", NULL}, *const estimators[] = {"H1", "H2", "HV", NULL};
    struct ema_arguments *ema = &command->ema;
    struct transfer_options *transfer = &ema->measurement.transfer;
    static const struct option options[] = {EMA_LONG_OPTIONS};
    for (size_t i = 0; i < sizeof options / sizeof *options && !ema->given; i++)
        if (options[i].val == option)
            ema->given = options[i].name;
    switch (option) {
    case EMA_OPTION_BAND:
        return take_band(command, value);
    case EMA_OPTION_METHOD:
        return word("--method", value, methods, &ema->options.method);
    case EMA_OPTION_ORDER:
        return whole("--order", value, 2, 400, &ema->options.order);
    case EMA_OPTION_PICK:
        return take_picks(command, value);
    case EMA_OPTION_PER_POINT:
        ema->options.per_point = 1;
        return -1;
    case EMA_OPTION_NO_REFINEMENT:
        ema->options.no_refinement = 1;
        return -1;
    case EMA_OPTION_REFERENCE:
        return whole("--reference", value, 1, 2147483647, &ema->measurement.reference);
    case EMA_OPTION_AVERAGES:
        return whole("--averages", value, 2, 1000000, &ema->measurement.averages);
    case EMA_OPTION_ESTIMATOR:
        return word("--estimator", value, estimators, &transfer->estimator);
    case EMA_OPTION_EXPONENTIAL:
        return real("--exponential", value, 1e-12, 0.999, &transfer->exponential);
    case EMA_OPTION_FORCE_WINDOW:
        return real("--force-window", value, -1, 1e6, &transfer->force_window);
    case EMA_OPTION_BLOCK:
        return real("--block", value, 1e-6, 1e6, &transfer->block);
    case EMA_OPTION_PRETRIGGER:
        return real("--pretrigger", value, 1e-9, 1e6, &transfer->pretrigger);
    case EMA_OPTION_THRESHOLD:
        return real("--threshold", value, 1e-6, 0.999, &transfer->threshold);
    default:
        transfer->double_hits = 1;
        return -1;
    }
}
