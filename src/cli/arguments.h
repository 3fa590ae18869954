/* What the arguments of the program say. */
#ifndef ROTID_CLI_ARGUMENTS_H
#define ROTID_CLI_ARGUMENTS_H

#include <stdio.h>

#include "cli/command.h"

enum command_flag {
    READS_DECK = 1, /* the file it is given is a deck, which is read before it runs */
    PARALLEL = 2,   /* it runs several threads of its own, so the BLAS gets one */
    SEVERAL_FILES = 4
};

struct command_entry {
    const char *name, *text; /* as help shows them */
    const char *examples;    /* command lines, separated by line feeds */
    const char *files;       /* endings of what it reads, separated by bars */
    int (*run)(struct command *command);
    int flags; /* of enum command_flag */
};

/* The commands there are, ended by one without a name. */
extern const struct command_entry command_table[];

/* NULL where there is none of this name. */
const struct command_entry *command_find(const char *name);

/* To the members of *command that options and files stand in. -1 to go on, or the exit code of a run that ends here: what is
 * wrong has been said. */
int arguments_parse(struct command *command, int argc, char **argv);

/* The value of an option that was given, "" where it has none; else NULL. */
const char *arguments_given(const struct command *command, const char *name);

/* -1, or the exit code after saying which file would be lost, or which options do not go together. */
int arguments_refuse(const struct command *command, const struct command_entry *entry);

/* Whether two names are of one file, which may not exist yet. */
int arguments_same_file(const char *a, const char *b);

/* Whether an option would write one of these files, which are read: -1, or the exit code after saying so. */
int arguments_refuse_read(const struct command *command, int count, const char *const *file);

/* Reports a mistake in the arguments: the format has one %s. Returns the exit code. */
int arguments_wrong(const char *format, const char *value);

/* The options of a command, or, for NULL, the commands. */
void help_print(FILE *out, const struct command_entry *entry);

#endif
