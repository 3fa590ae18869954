#include "cli/arguments.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/arguments_ema.h"
#include "cli/arguments_study.h"
#include "export/files.h"
#include "fit/baseline.h"

static void print_help(FILE *out)
{
    (void)fputs("usage: rotid COMMAND FILE [options]\n\n", out);
    for (const struct command_entry *c = command_table; c->name; c++)
        (void)fprintf(out, "  %-12s %s\n", c->name, c->text);
    (void)fputs(
        "\n"
        "  --json FILE              the result as JSON; - for standard output, which then carries nothing else\n"
        "  --set CARD.OPTION=VALUE  another option on every such card of the deck, e.g. FIT.REDUCTION=NONE\n"
        "  --quiet, --verbose       no tables; with shapes (modes), iterations (identify), notes of the readers\n"
        "  --no-baseline            identify: without NLopt\n"
        "  --at NAME[=VALUE],...    sensitivity: other parameters and reference values than those of *IDENTIFY\n"
        "  --step 0.01, --range 0.5, --points 11   sensitivity: relative step, range and points of the curves\n"
        "  --extended FILE          diagnose: a deck with the cause that was named\n"
        "  --replicates N           diagnose: of the bootstrap that tells a cause from chance (1000)\n"
        "  -o, --output FILE        ema: the modes, for *MEASURED; uff: the file anew, its functions in the other format\n"
        "                           frf: the synthesised functions; export: the model, of matrix-market the beginning of the "
        "names\n"
        "                           report: the folder of the page\n"
        "  --format ascii|binary    uff: or in this one\n"
        "  --format matrix-market|dmig|ross   export: for SciPy and others, for Nastran, for ROSS\n"
        "  --start, --condensed     export: the model as the deck states it; dmig: the model condensed onto the sensors\n"
        "  --threads N, --seed N    threads of the BLAS (1), of diagnose and ema, processes of study (one a processor); seed of "
        "random numbers (1)\n"
        "  --version, --help\n\n",
        out);
    (void)fputs(ema_options_help, out);
    (void)fputs(study_options_help, out);
    (void)fputs(
        "\n"
        "exit: 0 computed and converged, diagnose: any verdict; 1 computed, not to be trusted as it stands or interrupted;\n"
        "      2 wrong usage or input; 3 failure\n",
        out);
}

int arguments_wrong(const char *format, const char *value)
{
    terminal_say("rotid: ");
    terminal_say(format, value);
    terminal_say(" (rotid --help lists what there is)\n");
    return EXIT_USAGE;
}

enum {
    OPTION_JSON = 256,
    OPTION_SET,
    OPTION_QUIET,
    OPTION_VERBOSE,
    OPTION_NO_BASELINE,
    OPTION_AT,
    OPTION_STEP,
    OPTION_RANGE,
    OPTION_POINTS,
    OPTION_THREADS,
    OPTION_SEED,
    OPTION_EXTENDED,
    OPTION_REPLICATES,
    OPTION_OUTPUT,
    OPTION_FORMAT,
    OPTION_START,
    OPTION_CONDENSED,
    OPTION_VERSION,
    OPTION_HELP
};

int arguments_number(const char *option, const char *text, double least, double most, int whole, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end != text && !*end && *value >= least && *value <= most && (!whole || *value == floor(*value)))
        return 0;
    terminal_say("rotid: %s %s: expected a %snumber from %g to %g\n", option, text, whole ? "whole " : "", least, most);
    return 1;
}

/* Returns -1 to go on, or an exit code. */
static int take_option(struct command *command, int option, const char *value)
{
    double n;
    switch (option) {
    case OPTION_JSON:
        command->json = value;
        return -1;
    case OPTION_SET:
        if (override_parse(&command->pool, value, &command->override[command->noverride]))
            return arguments_wrong("--set %s: expected CARD.OPTION=VALUE", value);
        command->noverride++;
        return -1;
    case OPTION_QUIET:
        command->quiet = 1;
        return -1;
    case OPTION_VERBOSE:
        command->verbose = 1;
        return -1;
    case OPTION_NO_BASELINE:
        command->baseline = 0;
        return -1;
    case OPTION_AT:
        command->at = value;
        return -1;
    case OPTION_STEP:
        return arguments_number("--step", value, 1e-9, 0.5, 0, &command->step) ? EXIT_USAGE : -1;
    case OPTION_RANGE:
        return arguments_number("--range", value, 1e-6, 0.95, 0, &command->range) ? EXIT_USAGE : -1;
    case OPTION_POINTS:
        if (arguments_number("--points", value, 1, 1000, 1, &n))
            return EXIT_USAGE;
        command->points = (int)n;
        return -1;
    case OPTION_THREADS:
        if (arguments_number("--threads", value, 1, THREADS_MOST, 1, &n))
            return EXIT_USAGE;
        command->threads = (int)n;
        return -1;
    case OPTION_SEED:
        if (arguments_number("--seed", value, 0, 4294967295.0, 1, &n))
            return EXIT_USAGE;
        command->seed = (unsigned long)n;
        command->seed_given = 1;
        return -1;
    case OPTION_EXTENDED:
        command->extended = value;
        return -1;
    case OPTION_REPLICATES:
        if (arguments_number("--replicates", value, 100, 1000000, 1, &n))
            return EXIT_USAGE;
        command->replicates = (int)n;
        return -1;
    case 'o':
    case OPTION_OUTPUT:
        command->output = value;
        return -1;
    case OPTION_FORMAT:
        command->format = value;
        return -1;
    case OPTION_START:
        command->start = 1;
        return -1;
    case OPTION_CONDENSED:
        command->condensed = 1;
        return -1;
    case OPTION_VERSION:
        (void)fprintf(terminal_out(), "rotid %s (%s), %s%s\n", ROTID_VERSION, build_commit, build_blas(),
                      baseline_exists() ? "" : ", without NLopt: identify has no baseline");
        return EXIT_DONE;
    case OPTION_HELP:
        print_help(terminal_out());
        return EXIT_DONE;
    default:
        return option >= STUDY_OPTION_SHARD ? arguments_study(command, option, value) : arguments_ema(command, option, value);
    }
}

/* Says what getopt would have; word: where it stopped. */
static int refuse_option(int why, const struct option *options, const char *word)
{
    const char *name = NULL;
    for (; options->name; options++)
        if (optopt && options->val == optopt)
            name = options->name;
    if (why == ':' && !name)
        return arguments_wrong("-%s: expected a value behind it", (char[]){(char)optopt, 0});
    if (why == ':')
        return arguments_wrong("--%s: expected a value behind it", name);
    if (name)
        return arguments_wrong("--%s: expected no value", name);
    if (optopt)
        return arguments_wrong("-%s is no option", (char[]){(char)optopt, 0});
    return arguments_wrong("%s is no option, or the beginning of several", word);
}

int arguments_parse(struct command *command, int argc, char **argv)
{
    static const struct option options[] = {{"json", required_argument, NULL, OPTION_JSON},
                                            {"set", required_argument, NULL, OPTION_SET},
                                            {"quiet", no_argument, NULL, OPTION_QUIET},
                                            {"verbose", no_argument, NULL, OPTION_VERBOSE},
                                            {"no-baseline", no_argument, NULL, OPTION_NO_BASELINE},
                                            {"at", required_argument, NULL, OPTION_AT},
                                            {"step", required_argument, NULL, OPTION_STEP},
                                            {"range", required_argument, NULL, OPTION_RANGE},
                                            {"points", required_argument, NULL, OPTION_POINTS},
                                            {"threads", required_argument, NULL, OPTION_THREADS},
                                            {"seed", required_argument, NULL, OPTION_SEED},
                                            {"extended", required_argument, NULL, OPTION_EXTENDED},
                                            {"replicates", required_argument, NULL, OPTION_REPLICATES},
                                            {"output", required_argument, NULL, OPTION_OUTPUT},
                                            {"format", required_argument, NULL, OPTION_FORMAT},
                                            {"start", no_argument, NULL, OPTION_START},
                                            {"condensed", no_argument, NULL, OPTION_CONDENSED},
                                            EMA_LONG_OPTIONS,
                                            STUDY_LONG_OPTIONS,
                                            {"version", no_argument, NULL, OPTION_VERSION},
                                            {"help", no_argument, NULL, OPTION_HELP},
                                            {NULL, 0, NULL, 0}};
    int option;
    command->override = POOL_ARRAY(&command->pool, struct override, argc);
    if (!command->override)
        return command_fail(command, ROTID_ERROR_MEMORY);
    (void)unsetenv("POSIXLY_CORRECT"); /* with it getopt takes the options behind COMMAND FILE for files */
    opterr = 0;                        /* getopt prints what it was given as it is */
    while ((option = getopt_long(argc, argv, ":o:", options, NULL)) != -1) {
        int code = option == '?' || option == ':' ? refuse_option(option, options, argv[optind - 1])
                                                  : take_option(command, option, optarg);
        if (code >= 0)
            return code;
    }
    if (optind >= argc) {
        print_help(terminal_out());
        terminal_to_error();
        return EXIT_USAGE;
    }
    command->name = argv[optind++];
    if (optind >= argc)
        return arguments_wrong("%s: no file given, expected rotid COMMAND FILE", command->name);
    command->file = &argv[optind];
    command->nfile = argc - optind;
    command->deck = command->file[0];
    return -1;
}

int arguments_same_file(const char *a, const char *b)
{
    struct stat first, second;
    int exists = stat(a, &first) == 0;
    if (exists != (stat(b, &second) == 0))
        return 0;
    if (exists)
        return S_ISREG(first.st_mode) && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
    const char *name_a = strrchr(a, '/'), *name_b = strrchr(b, '/');
    char folder[2][4096];
    (void)snprintf(folder[0], sizeof folder[0], "%.*s", name_a ? (int)(name_a - a) + 1 : 1, name_a ? a : ".");
    (void)snprintf(folder[1], sizeof folder[1], "%.*s", name_b ? (int)(name_b - b) + 1 : 1, name_b ? b : ".");
    return !strcmp(name_a ? name_a + 1 : a, name_b ? name_b + 1 : b) && stat(folder[0], &first) == 0 &&
           stat(folder[1], &second) == 0 && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

int arguments_refuse_read(const struct command *command, int count, const char *const *file)
{
    const char *const option[] = {"json", "extended", "output"}, *const path[] = {command->json, command->extended,
                                                                                  command->output};
    for (int i = 0; i < count; i++)
        for (int o = 0; o < 3; o++)
            if (path[o] && strcmp(path[o], "-") && arguments_same_file(path[o], file[i])) {
                terminal_say("rotid: --%s %s is a file that is read, expected another one\n", option[o], path[o]);
                return EXIT_USAGE;
            }
    return -1;
}

/* -1, or the exit code after saying what is wrong with the options of export. */
static int refuse_export(const struct command *command)
{
    enum export_format format;
    int exports = !strcmp(command->name, "export");
    if (!exports && (command->start || command->condensed))
        return arguments_wrong("%s is an option of export alone", command->start ? "--start" : "--condensed");
    if (!exports)
        return -1;
    if (!command->format)
        return arguments_wrong("%s: expected --format matrix-market, dmig or ross", command->name);
    if (export_format_find(command->format, &format))
        return arguments_wrong("--format %s: expected matrix-market, dmig or ross", command->format);
    if (!command->output)
        return arguments_wrong("%s: expected --output FILE as well", command->name);
    if (command->condensed && format != EXPORT_DMIG)
        return arguments_wrong("--condensed is an option of --format dmig, not of %s", command->format);
    return -1;
}

/* -1, or the exit code after saying what is wrong with -o and --format. */
static int refuse_output(const struct command *command, const struct command_entry *entry)
{
    int converts = !strcmp(command->name, "uff"), exports = !strcmp(command->name, "export");
    if (command->output && !(entry->flags & TAKES_OUTPUT))
        return arguments_wrong("--output is no option of %s", command->name);
    if (command->format && !converts && !exports)
        return arguments_wrong("--format is no option of %s", command->name);
    if (command->format && converts && strcmp(command->format, "ascii") && strcmp(command->format, "binary"))
        return arguments_wrong("--format %s: expected ascii or binary", command->format);
    if (!command->output)
        return command->format ? arguments_wrong("--format %s: expected --output as well", command->format) : -1;
    if (!strcmp(command->output, "-"))
        return arguments_wrong("--output %s: expected a file", command->output);
    for (int i = 0; i < command->nfile; i++)
        if (arguments_same_file(command->file[i], command->output))
            return arguments_wrong("--output %s is the file that is read, expected another one", command->output);
    if (command->json && arguments_same_file(command->json, command->output))
        return arguments_wrong("--output %s is the file of --json as well, expected another file", command->output);
    return -1;
}

int arguments_refuse(const struct command *command, const struct command_entry *entry)
{
    int diagnoses = !strcmp(command->name, "diagnose"), refused = refuse_export(command);
    if (refused >= 0)
        return refused;
    if (command->json && !strcmp(command->name, "report"))
        return arguments_wrong("--json is no option of %s", command->name);
    if (!diagnoses && (command->extended || command->replicates))
        return arguments_wrong("%s is an option of diagnose alone", command->extended ? "--extended" : "--replicates");
    if (command->ema.given && strcmp(command->name, "ema"))
        return arguments_wrong("--%s is an option of ema alone", command->ema.given);
    if (command->nfile > 1 && !(entry->flags & SEVERAL_FILES))
        return arguments_wrong("%s is one argument too many, expected one file", command->file[1]);
    refused = arguments_refuse_study(command);
    if (refused >= 0)
        return refused;
    for (int i = 0; i < command->nfile && command->json && strcmp(command->json, "-"); i++)
        if (arguments_same_file(command->file[i], command->json))
            return arguments_wrong("--json %s is the file that is read, expected another one", command->json);
    if (!command->extended)
        return refuse_output(command, entry);
    if (!strcmp(command->extended, "-"))
        return arguments_wrong("--extended %s: expected a file", command->extended);
    if (arguments_same_file(command->deck, command->extended))
        return arguments_wrong("--extended %s is the deck itself, expected another file", command->extended);
    if (command->json && arguments_same_file(command->json, command->extended))
        return arguments_wrong("--extended %s is the file of --json as well, expected another file", command->extended);
    return -1;
}
