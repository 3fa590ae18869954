/* The options of the program, a row each. From the rows follow what is accepted and what is said where it is not (arguments.c,
 * option_value.c), `rotid COMMAND --help` (help.c), and the completions of the shells and the lists of docs/rotid.1, which `make
 * tables` writes.
 */
#ifndef ROTID_CLI_OPTIONS_H
#define ROTID_CLI_OPTIONS_H

#include <stddef.h>

struct command;

enum option_kind {
    OPTION_VERSION,
    OPTION_HELP,
    OPTION_SWITCH,  /* int: 1 where it is given. Kinds up to here take no value */
    OPTION_TEXT,    /* const char *; with words: one of them, as the table spells it */
    OPTION_WRITES,  /* const char *: a file, or folder, that is written */
    OPTION_WORD,    /* int: which of the words, from 0 */
    OPTION_WHOLE,   /* int */
    OPTION_SEED,    /* unsigned long */
    OPTION_REAL,    /* double */
    OPTION_BAND,    /* struct ema_options: low_hz and high_hz */
    OPTION_PICK,    /* struct ema_options: npick and pick_hz */
    OPTION_SHARD,   /* struct study_arguments: shard and shards */
    OPTION_OVERRIDE /* struct command: override */
};

struct option_row {
    const char *name, *alias; /* alias: the name that it had in the version before, or NULL */
    char letter;              /* 0: none */
    const char *commands;     /* separated by blanks; NULL: all */
    enum option_kind kind;
    size_t offset;      /* of its member in struct command */
    double least, most; /* numbers */
    double standard;    /* numbers: what stands in the member without it; 0: what a library takes then, which `help` tells */
    const char *value;  /* what help calls its value; NULL: the words */
    const char *const *words; /* end with NULL */
    const char *files;        /* endings that completions look for, separated by bars; "/": folders */
    const char *help;         /* one line */
    const char *more;         /* for the manual page alone: whole sentences, or NULL */
};

/* In the order of help and manual page; ended by a row without a name. Rows of one name have one kind and one member. */
extern const struct option_row option_table[];

/* Whether a command has the option of a row. */
int option_of(const struct option_row *row, const char *command);

/* The row of this name that a command has, or NULL. */
const struct option_row *option_find(const char *name, const char *command);

/* Sets members to their defaults. */
void option_set_standards(struct command *command);

/* Takes the value of an option, "" where it has none, into its member. 0, or the exit code after saying what was expected. */
int option_take(struct command *command, const struct option_row *row, const char *text);

#endif
