#include "cli/arguments.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/options.h"
#include "fit/baseline.h"

#define FIRST_OPTION 256 /* values of getopt: the row of an option, behind those of letters */

int arguments_wrong(const char *format, const char *value)
{
    terminal_say("rotid: ");
    terminal_say(format, value);
    terminal_say(" (rotid COMMAND --help lists its options)\n");
    return EXIT_USAGE;
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
    const char *nearest = NULL;
    char name[32];
    int least = TEXT_FAR, length = (int)strcspn(word, "=") - 2;
    (void)snprintf(name, sizeof name, "%.*s", length > 0 ? length : 0, length > 0 ? word + 2 : "");
    for (const struct option_row *row = option_table; row->name && *name; row++) {
        int distance = text_distance(name, row->name);
        nearest = distance < least ? row->name : nearest;
        least = distance < least ? distance : least;
    }
    return nearest;
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
    if (near) {
        terminal_say("rotid: %s is no option, expected --%s (rotid COMMAND --help lists its options)\n", word, near);
        return EXIT_USAGE;
    }
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
    opterr = 0;                        /* getopt prints what it was given as it is */
    while ((option = getopt_long(argc, argv, ":o:h", options, NULL)) != -1) {
        if (option == '?' || option == ':')
            return refuse_word(option, argv[optind - 1]);
        const char *name = option == 'o' ? "output" : option == 'h' ? "help" : option_table[option - FIRST_OPTION].name;
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
    terminal_say("rotid: %s is no command, expected", name);
    for (const struct command_entry *c = command_table; c->name; c++)
        terminal_say("%s %s", c == command_table ? "" : c[1].name ? "," : " or", c->name);
    terminal_say(" (rotid --help tells what they do)\n");
    return EXIT_USAGE;
}

int arguments_parse(struct command *command, int argc, char **argv)
{
    option_set_standards(command);
    int code = collect(command, argc, argv);
    if (code >= 0)
        return code;
    command->name = optind < argc ? argv[optind++] : NULL;
    const struct command_entry *entry = command->name ? command_find(command->name) : NULL;
    if (arguments_given(command, "help")) {
        help_print(terminal_out(), entry);
        return EXIT_DONE;
    }
    if (arguments_given(command, "version")) {
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
    for (int i = 0; i < command->ngiven; i++) {
        const struct option_row *row = option_find(command->given[i].name, command->name);
        code = row ? option_take(command, row, command->given[i].value) : refuse_option(command, command->given[i].name);
        if (code)
            return code;
    }
    return -1;
}
