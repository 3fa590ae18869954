/* The options of `study` alone. */
#ifndef ROTID_CLI_ARGUMENTS_STUDY_H
#define ROTID_CLI_ARGUMENTS_STUDY_H

#include <getopt.h>

#include "cli/command.h"

enum {
    STUDY_OPTION_SHARD = 768, /* the first of them */
    STUDY_OPTION_RETRY,
    STUDY_OPTION_TIMEOUT,
    STUDY_OPTION_MERGE,
    STUDY_OPTION_SUMMARY
};

/* For getopt_long, without the last line of zeros. */
#define STUDY_LONG_OPTIONS                                                                                                       \
    {"shard", required_argument, NULL, STUDY_OPTION_SHARD}, {"retry-failed", no_argument, NULL, STUDY_OPTION_RETRY},             \
        {"timeout", required_argument, NULL, STUDY_OPTION_TIMEOUT}, {"merge", no_argument, NULL, STUDY_OPTION_MERGE},            \
    {                                                                                                                            \
        "summary", no_argument, NULL, STUDY_OPTION_SUMMARY                                                                       \
    }

extern const char *const study_options_help;

/* -1 to go on, or the exit code after saying what was expected. */
int arguments_study(struct command *command, int option, const char *value);

/* The same for what the options of it say together. */
int arguments_refuse_study(const struct command *command);

#endif
