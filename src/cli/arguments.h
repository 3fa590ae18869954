/* What the arguments of the program say. */
#ifndef ROTID_CLI_ARGUMENTS_H
#define ROTID_CLI_ARGUMENTS_H

#include "cli/command.h"

#define THREADS_MOST 1024

struct command_entry {
    const char *name, *text; /* as help shows them */
    int (*run)(struct command *command);
    int reads_deck; /* the file it is given is a deck, which is read before it runs */
};

/* The commands there are, ended by one without a name. */
extern const struct command_entry command_table[];

/* To the members of *command that options and files stand in. -1 to go on, or the exit code of a run that ends here: what is
 * wrong has been said. */
int arguments_parse(struct command *command, int argc, char **argv);

/* -1, or the exit code after saying which file would be lost, or which option this command has no use for. */
int arguments_refuse(const struct command *command);

/* Says what is wrong with the arguments: the format has one %s. Returns the exit code. */
int arguments_wrong(const char *format, const char *value);

#endif
