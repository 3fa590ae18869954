#include "cli/arguments_study.h"

#include <stdio.h>
#include <string.h>

#include "cli/arguments.h"

const char *const study_options_help =
    "  -o, --output FILE        study: the results, a line of JSON a run; where it exists already, what is missing in it\n"
    "  --shard I/N              study: each N-th run from the I-th on, for an array of jobs; --merge puts the files together\n"
    "  --timeout SECONDS        study: a run that takes longer has failed\n"
    "  --retry-failed           study: runs that have failed once again\n"
    "  --merge                  study: files of shards into the one of -o\n"
    "  --summary                study: the table of a file of results, finished or not\n";

int arguments_study(struct command *command, int option, const char *value)
{
    struct study_arguments *study = &command->study;
    static const struct option options[] = {STUDY_LONG_OPTIONS};
    int end = 0;
    for (size_t i = 0; i < sizeof options / sizeof *options && !study->given; i++)
        if (options[i].val == option)
            study->given = options[i].name;
    switch (option) {
    case STUDY_OPTION_SHARD:
        if (sscanf(value, "%9d/%9d%n", &study->shard, &study->shards, &end) != 2 || value[end] || study->shard < 1 ||
            study->shard > study->shards)
            return arguments_wrong("--shard %s: expected I/N with I from 1 to N", value);
        return -1;
    case STUDY_OPTION_TIMEOUT:
        return arguments_number("--timeout", value, 0.001, 1e9, 0, &study->timeout) ? EXIT_USAGE : -1;
    case STUDY_OPTION_RETRY:
        study->retry_failed = 1;
        return -1;
    case STUDY_OPTION_MERGE:
        study->merge = 1;
        return -1;
    default:
        study->summary = 1;
        return -1;
    }
}

int arguments_refuse_study(const struct command *command)
{
    const struct study_arguments *study = &command->study;
    int runs = !study->merge && !study->summary;
    if (strcmp(command->name, "study") != 0)
        return study->given ? arguments_wrong("--%s is an option of study alone", study->given) : -1;
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
    if (!command->baseline)
        return arguments_wrong("--no-baseline is no option of %s: a plan has BASELINE=NO", command->name);
    return -1;
}
