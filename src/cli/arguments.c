/* What the arguments say together: files that would be lost, options that another one excludes or needs. */
#include "cli/cli.h"

#include <getopt.h>
#include <sys/stat.h>

#include "export/export.h"
#include "fit/fit.h"

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

/* The i-th of the options given, where it names a file that is written; else NULL. */
static const char *written(const struct command *command, int i)
{
    const struct option_row *row = option_find(command->given[i].name, command->name);
    return row && row->kind == OPTION_WRITES ? command->given[i].value : NULL;
}

int arguments_refuse_read(const struct command *command, int count, const char *const *file)
{
    for (int f = 0; f < count; f++)
        for (int i = 0; i < command->ngiven; i++) {
            const char *path = written(command, i);
            if (path && strcmp(path, "-") != 0 && arguments_same_file(path, file[f]))
                return terminal_end(EXIT_USAGE, "rotid: --%s %s is a file that is read, expected another one\n",
                                    command->given[i].name, path);
        }
    return -1;
}

/* -1, or the exit code after saying which file would be lost. */
static int refuse_files(const struct command *command)
{
    for (int i = 0; i < command->ngiven; i++) {
        const char *name = command->given[i].name, *path = written(command, i), *wrong = NULL;
        int is_json = !strcmp(name, "json");
        if (!path || (is_json && !strcmp(path, "-")))
            continue;
        if (!strcmp(path, "-"))
            wrong = ": expected a file";
        for (int f = 0; f < command->nfile && !wrong; f++)
            if (arguments_same_file(command->file[f], path))
                wrong = " is the file that is read, expected another one";
        if (wrong)
            return terminal_end(EXIT_USAGE, "rotid: --%s %s%s\n", name, path, wrong);
        for (int j = 0; j < command->ngiven && !is_json; j++)
            if (strcmp(command->given[j].name, name) != 0 && written(command, j) &&
                arguments_same_file(written(command, j), path))
                return terminal_end(EXIT_USAGE, "rotid: --%s %s is the file of --%s as well, expected another one\n", name, path,
                                    command->given[j].name);
    }
    return -1;
}

static int refuse_export(const struct command *command)
{
    if (!arguments_given(command, "format"))
        return arguments_wrong("%s: expected --format matrix-market or dmig", command->name);
    if (!command->output)
        return arguments_wrong("%s: expected --output FILE as well", command->name);
    if (command->condensed && command->format != EXPORT_DMIG)
        return arguments_wrong("--condensed is an option of --format dmig, not of %s", export_format_words[command->format]);
    return -1;
}

static int refuse_study(const struct command *command)
{
    const struct study_arguments *study = &command->study;
    int runs = !study->merge && !study->summary;
    if (study->merge && study->summary)
        return arguments_wrong("%s: --merge and --summary are both given, expected one of them", command->name);
    if (!runs && (study->shards || study->timeout > 0 || study->retry_failed || command->noverride))
        return arguments_wrong("--%s computes nothing, expected it without --shard, --timeout, --retry-failed and --set",
                               study->merge ? "merge" : "summary");
    if (study->summary && command->output)
        return arguments_wrong("--summary writes no results, expected it without --output %s", command->output);
    if (study->summary && command->nfile > 1)
        return arguments_wrong("%s is one argument too many, expected one file of results", command->file[1]);
    if (!study->summary && !command->output)
        return arguments_wrong("%s: no file for the results, expected -o FILE", command->name);
    return -1;
}

/* Two names with a comma between. */
static int is_pair(const char *text)
{
    const char *comma = strchr(text, ',');
    return comma && comma > text && comma[1] && !strchr(comma + 1, ',');
}

int arguments_refuse(const struct command *command, const struct command_entry *entry)
{
    int refused = -1;
    if (command->nfile > 1 && !(entry->flags & SEVERAL_FILES))
        return arguments_wrong("%s is one argument too many, expected one file", command->file[1]);
    if (!strcmp(command->name, "export"))
        refused = refuse_export(command);
    else if (!strcmp(command->name, "study"))
        refused = refuse_study(command);
    else if (command->changed && !is_pair(command->changed))
        return arguments_wrong("--changed %s: expected BEFORE,AFTER, the names of two states of the deck", command->changed);
    else if (command->changed && command->extended)
        return arguments_wrong("--extended %s does not go with --changed, which does not determine the model", command->extended);
    return refused >= 0 ? refused : refuse_files(command);
}

/* Values of options, of each kind: nonzero after saying what was expected. */

static int take_number(const struct option_row *row, const char *text, double *value)
{
    char *end;
    int whole = row->kind != OPTION_REAL;
    *value = strtod(text, &end);
    if (end != text && !*end && *value >= row->least && *value <= row->most && (!whole || *value == floor(*value)))
        return 0;
    return terminal_end(EXIT_USAGE, "rotid: --%s %s: expected a %snumber from %g to %g\n", row->name, text, whole ? "whole " : "",
                        row->least, row->most);
}

static int take_word(const struct option_row *row, const char *text, int *index)
{
    for (*index = 0; row->words[*index]; ++*index)
        if (same_text(text, row->words[*index]))
            return 0;
    terminal_say("rotid: --%s %s: expected ", row->name, text);
    for (int i = 0; row->words[i]; i++)
        terminal_say("%s%s", !i ? "" : row->words[i + 1] ? ", " : " or ", row->words[i]);
    return terminal_end(EXIT_USAGE, "\n");
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
    return terminal_end(0, "rotid: --%s %s: expected frequencies from %g to %g Hz, separated by commas\n", row->name, text,
                        row->least, row->most);
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

static int take_override(struct command *command, const char *text)
{
    if (override_parse(&command->pool, text, &command->override[command->noverride]))
        return arguments_wrong("--set %s: expected CARD.OPTION=VALUE", text);
    command->noverride++;
    return 0;
}

/* Takes the value of an option, "" where it has none, into its member. 0, or the exit code after saying what was expected. */
static int option_take(struct command *command, const struct option_row *row, const char *text)
{
    void *member = (char *)command + row->offset;
    struct study_arguments *study = member;
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
        wrong = !shard_parse(text, &study->shard, &study->shards);
        return wrong ? arguments_wrong("--shard %s: expected I/N with I from 1 to N", text) : 0;
    case OPTION_OVERRIDE:
        return take_override(command, text);
    default:
        return 0;
    }
}

/* Sets members to their defaults. */
static void option_set_standards(struct command *command)
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

/* What --help says. */

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

/* The options of a command, or, for NULL, the commands. */
static void help_print(FILE *out, const struct command_entry *entry)
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

#define FIRST_OPTION 256 /* values of getopt: the row of an option, behind those of letters */

int arguments_wrong(const char *format, const char *value)
{
    terminal_say("rotid: ");
    terminal_say(format, value);
    return terminal_end(EXIT_USAGE, " (rotid COMMAND --help lists its options)\n");
}

const char *arguments_given(const struct command *command, const char *name)
{
    for (int i = 0; i < command->ngiven; i++)
        if (!strcmp(command->given[i].name, name))
            return command->given[i].value;
    return NULL;
}

const struct command_entry *command_find(const char *name)
{
    for (const struct command_entry *c = command_table; c->name; c++)
        if (!strcmp(c->name, name))
            return c;
    return NULL;
}

/* ---- words of the command line */

/* One of each name, what stands in the table for getopt. Of several rows the first: they have one kind. */
static struct option *long_options(struct command *command)
{
    int count = 0, i = 0;
    while (option_table[count].name)
        count++;
    struct option *options = POOL_ARRAY(&command->pool, struct option, 2 * count + 1);
    for (int r = 0; r < count && options; r++) {
        const struct option_row *row = &option_table[r];
        int argument = row->kind <= OPTION_SWITCH ? no_argument : required_argument, first = 0;
        while (strcmp(option_table[first].name, row->name) != 0)
            first++;
        if (first == r)
            options[i++] = (struct option){row->name, argument, NULL, FIRST_OPTION + r};
        if (row->alias)
            options[i++] = (struct option){row->alias, argument, NULL, FIRST_OPTION + r};
    }
    return options;
}

/* The option that a misspelt "--word" or "--word=value" is closest to, or NULL. */
static const char *nearest_option(const char *word)
{
    char name[32];
    int length = (int)strcspn(word, "=") - 2;
    (void)snprintf(name, sizeof name, "%.*s", length > 0 ? length : 0, length > 0 ? word + 2 : "");
    return text_nearest(name, option_table, sizeof *option_table);
}

/* Says what getopt would have; word: where it stopped. */
static int refuse_word(int why, const char *word)
{
    const char *name = optopt >= FIRST_OPTION ? option_table[optopt - FIRST_OPTION].name : NULL;
    if (why == ':' && !name)
        return arguments_wrong("-%s: expected a value behind it", (char[]){(char)optopt, 0});
    if (why == ':')
        return arguments_wrong("--%s: expected a value behind it", name);
    if (name)
        return arguments_wrong("--%s: expected no value", name);
    if (optopt)
        return arguments_wrong("-%s is no option", (char[]){(char)optopt, 0});
    const char *near = nearest_option(word);
    if (near)
        return terminal_end(EXIT_USAGE, "rotid: %s is no option, expected --%s (rotid COMMAND --help lists its options)\n", word,
                            near);
    return arguments_wrong("%s is no option, or the beginning of several", word);
}

/* Names and values, in their order, before it is known of which command. Returns -1 to go on, or an exit code. */
static int collect(struct command *command, int argc, char **argv)
{
    struct option *options = long_options(command);
    int option;
    command->given = POOL_ARRAY(&command->pool, struct given_option, argc);
    command->override = POOL_ARRAY(&command->pool, struct override, argc);
    if (!options || !command->given || !command->override)
        return command_fail(command, ROTID_ERROR_MEMORY);
    (void)unsetenv("POSIXLY_CORRECT"); /* with it getopt takes the options behind COMMAND FILE for files */
    optind = 1;                        /* a command of `test` is parsed after its own */
    opterr = 0;                        /* getopt prints what it was given as it is */
    while ((option = getopt_long(argc, argv, ":o:hV", options, NULL)) != -1) {
        if (option == '?' || option == ':')
            return refuse_word(option, argv[optind - 1]);
        const char *name = option == 'o'   ? "output"
                           : option == 'h' ? "help"
                           : option == 'V' ? "version"
                                           : option_table[option - FIRST_OPTION].name;
        command->given[command->ngiven++] = (struct given_option){name, optarg ? optarg : ""};
    }
    return -1;
}

/* An option that another command has. */
static int refuse_option(struct command *command, const char *name)
{
    const char *of = NULL;
    for (const struct option_row *row = option_table; row->name; row++)
        if (!strcmp(row->name, name))
            of = pool_format(&command->pool, "%s%s%s", of ? of : "", of ? " " : "", row->commands);
    if (!of)
        return command_fail(command, ROTID_ERROR_MEMORY);
    if (strchr(of, ' '))
        terminal_say("rotid: --%s is no option of %s, but of %s\n", name, command->name, of);
    else
        terminal_say("rotid: --%s is an option of %s alone\n", name, of);
    return EXIT_USAGE;
}

static int refuse_command(const char *name)
{
    const char *nearest = text_nearest(name, command_table, sizeof *command_table);
    if (nearest)
        return terminal_end(EXIT_USAGE, "rotid: %s is no command: did you mean %s?\n", name, nearest);
    terminal_say("rotid: %s is no command, expected", name);
    for (const struct command_entry *c = command_table; c->name; c++)
        terminal_say("%s %s", c == command_table ? "" : c[1].name ? "," : " or", c->name);
    return terminal_end(EXIT_USAGE, " (rotid --help tells what they do)\n");
}

int arguments_parse(struct command *command, int argc, char **argv)
{
    option_set_standards(command);
    int code = collect(command, argc, argv);
    if (code >= 0)
        return code;
    command->name = optind < argc ? argv[optind++] : NULL;
    int help = command->name && !strcmp(command->name, "help"), version = command->name && !strcmp(command->name, "version");
    if (help)
        command->name = optind < argc ? argv[optind++] : NULL;
    const struct command_entry *entry = command->name ? command_find(command->name) : NULL;
    if (help && command->name && !entry)
        return refuse_command(command->name);
    if (help || arguments_given(command, "help")) {
        help_print(terminal_out(), entry);
        return EXIT_DONE;
    }
    if (version || arguments_given(command, "version")) {
        (void)fprintf(terminal_out(), "rotid %s (%s), %s%s\n", ROTID_VERSION, build_commit, build_blas(),
                      baseline_exists() ? "" : ", without NLopt: identify has no baseline");
        return EXIT_DONE;
    }
    if (!command->name) {
        help_print(terminal_out(), NULL);
        terminal_to_error();
        return EXIT_USAGE;
    }
    if (!entry)
        return refuse_command(command->name);
    if (optind >= argc)
        return arguments_wrong("%s: no file given, expected rotid COMMAND FILE", command->name);
    command->file = &argv[optind];
    command->nfile = argc - optind;
    command->deck = command->file[0];
    for (int i = 0; i < command->ngiven && command->given[i].value; i++) {
        const struct option_row *row = option_find(command->given[i].name, command->name);
        code = row ? option_take(command, row, command->given[i].value) : refuse_option(command, command->given[i].name);
        if (code)
            return code;
    }
    return -1;
}
