/* What the arguments of the program say. */
#ifndef ROTID_CLI_ARGUMENTS_H
#define ROTID_CLI_ARGUMENTS_H

#include "cli/command.h"

#define THREADS_MOST 1024

enum command_flag {
    READS_DECK = 1,   /* the file it is given is a deck, which is read before it runs */
    PARALLEL = 2,     /* it runs several threads of its own, so the BLAS gets one */
    TAKES_OUTPUT = 4, /* -o */
    SEVERAL_FILES = 8
};

struct command_entry {
    const char *name, *text; /* as help shows them */
    int (*run)(struct command *command);
    int flags; /* of enum command_flag */
};

/* The commands there are, ended by one without a name. */
extern const struct command_entry command_table[];

/* To the members of *command that options and files stand in. -1 to go on, or the exit code of a run that ends here: what is
 * wrong has been said. */
int arguments_parse(struct command *command, int argc, char **argv);

/* -1, or the exit code after saying which file would be lost, or which option this command has no use for. */
int arguments_refuse(const struct command *command, const struct command_entry *entry);

/* Whether two names are of one file, which may not exist yet. */
int arguments_same_file(const char *a, const char *b);

/* Whether an option would write one of these files, which are read: -1, or the exit code after saying so. */
int arguments_refuse_read(const struct command *command, int count, const char *const *file);

/* A number of an option within its range; nonzero after saying what was expected. */
int arguments_number(const char *option, const char *text, double least, double most, int whole, double *value);

/* Says what is wrong with the arguments: the format has one %s. Returns the exit code. */
int arguments_wrong(const char *format, const char *value);

#endif
