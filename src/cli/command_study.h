/* The command `study`, apart from how its runs come to processors. */
#ifndef ROTID_CLI_COMMAND_STUDY_H
#define ROTID_CLI_COMMAND_STUDY_H

#include "cli/command.h"
#include "study/record.h"

/* Computes the runs that are missing in the record: statuses of workers_run. context: of the caller of study_command. */
typedef int study_compute(void *context, struct command *command, const struct study *study, struct study_record *record);

/* Reads the plan, or the decks, that the command names. An exit code, EXIT_DONE to go on; what is wrong has been said. The plan
 * hangs on the command's pool. */
int study_prepare(struct command *command, struct study *study);

/* Computes a prepared study into the file of --output and reports it. The exit code. */
int study_conduct(struct command *command, const struct study *study, study_compute *compute, void *context);

#endif
