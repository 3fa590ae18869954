/* What the arguments say together: files that would be lost, options that another one excludes or needs. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "export/export.h"
#include "result/result.h"

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
            if (path && strcmp(path, "-") != 0 && arguments_same_file(path, file[f])) {
                terminal_say("rotid: --%s %s is a file that is read, expected another one\n", command->given[i].name, path);
                return EXIT_USAGE;
            }
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
        if (!wrong && !is_json && command->json && arguments_same_file(command->json, path))
            wrong = " is the file of --json as well, expected another one";
        if (wrong) {
            terminal_say("rotid: --%s %s%s\n", name, path, wrong);
            return EXIT_USAGE;
        }
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
    else if (!strcmp(command->name, "report") && !command->output)
        return arguments_wrong("%s: expected -o FOLDER", command->name);
    else if (command->changed && !is_pair(command->changed))
        return arguments_wrong("--changed %s: expected BEFORE,AFTER, the names of two states of the deck", command->changed);
    else if (command->changed && command->extended)
        return arguments_wrong("--extended %s does not go with --changed, which holds the model that it says nothing of",
                               command->extended);
    return refused >= 0 ? refused : refuse_files(command);
}
