#ifndef ROTID_CLI_CLI_H
#define ROTID_CLI_CLI_H

/* cli: the program rotid: arguments, one file a command, messages, signals, exit codes.
 *
 * Comes in: argv. Goes out: tables on standard output, files, messages on standard error, an exit code (0 done, 1 doubtful,
 * 2 usage, 3 internal). The way of a run:
 *
 *   main.c              main: terminal, arguments, deck, command, exit code; threads of BLAS: blas.c
 *   arguments.c         arguments_parse: the rows of option_table.c to struct command; --help; options that do not go
 *                       together, files that would be lost
 *   command_deck.c      command_read_deck: the deck by rotid_deck_read; states; command_fit_deck: fits before frf, export, ...
 *   command_NAME.c      command_check, _modes, _sensitivity, _speeds, _identify, _diagnose, _suggest, _frf, _ema, _uff, _report,
 * _export, _study, _test: calls the library, shows the table (src/report), writes JSON (src/result) and CSV (command.c)
 *   command_table.c     the list of the commands; option_table.c: the options, a row each, from which `make tables` writes the
 *                       completions and the lists of docs/rotid.1
 *   command.c           messages, head of the result, failures, environment of a long call
 *   interrupt.c         command_watch_signals, command_cancelled: the first signal asks a run to end, the second ends it
 *
 * src/mpi uses study_prepare and study_conduct; no other room includes cli. The room computes nothing: what a command finds comes
 * from rotid.h, src/run, src/ema, src/import or src/study. Only this room and src/mpi exit and handle signals. */

#include "deck/deck.h"
#include "ema/ema.h"
#include "import/import.h"
#include "report/report.h"
#include "result/result.h"
#include "run/run.h"
#include "study/study.h"

/* --------------------------------------------------------------------------------------------------------------- command */

/* One run of the program: its arguments, and the commands. */

#define THREADS_MOST 1024

enum exit_code { EXIT_DONE = 0, EXIT_DOUBTFUL = 1, EXIT_USAGE = 2, EXIT_INTERNAL = 3 };

/* Of `ema`: what to read, and how to look for modes in it. */
struct ema_arguments {
    struct measurement_options measurement;
    struct ema_options options;
};

/* Of `study`: which runs, or what else to do with their results. */
struct study_arguments {
    int shard, shards; /* 0: all runs */
    int retry_failed, merge, summary;
    double timeout; /* s, 0: none */
};

/* Of `suggest`: what is wanted of a test, and what it costs; 0: the default of the library. */
struct suggest_arguments {
    const char *aim;                               /* speed:N, or NULL */
    double interval, frequency_noise, shape_noise; /* percent */
    double set_up_cost;
    int sensors, modes;
};

/* Of `speeds`. */
struct speeds_arguments {
    const char *range, *campbell, *response;
    double harmonic;
    int draws;
};

struct given_option {
    const char *name, *value; /* value: "" where it has none */
};

struct command {
    /* files and texts NULL where they are not asked for; deck: the file of a command that reads none, too */
    const char *name, *deck, *json, *at, *extended, *changed, *output, *state, *csv;
    int nfile;
    char **file; /* [nfile] deck is the first of them; more than one only with SEVERAL_FILES */
    int quiet, verbose, threads, no_baseline, compare, mode_type, points, start, condensed;
    int format; /* of --output: enum export_format, or a word of uff */
    unsigned long seed;
    double step, range;
    struct suggest_arguments suggest;
    struct speeds_arguments speeds;
    int ngiven, noverride;
    struct given_option *given; /* [ngiven] in their order */
    struct override *override;
    struct ema_arguments ema;
    struct study_arguments study;

    struct pool pool;
    struct message_list messages;
    size_t printed;          /* of the messages */
    double progressed;       /* on the clock, when progress was last shown; 0: not yet */
    rotid_deck *read;        /* NULL of commands that read none */
    const struct job *job;   /* of it, of several states the first one's */
    struct result_head head; /* of its result */
};

/* Reads the deck of the command; prints its errors. An exit code, EXIT_DONE to go on. */
int command_read_deck(struct command *command);

/* Prints the messages that are new on standard error: errors always, the rest unless quiet. */
void command_print_messages(struct command *command);

/* The messages of a call of the library go to those of the command; with the state that they are of, NULL where all are one. */
void command_take_messages(struct command *command, const char *state, int count, const rotid_message *message);

/* Works on one deck after the other: the states, or the deck itself where it is one, [*count] in result->states, and what the
 * first one has in the result as well. 0, or the exit code of one that ended it. */
typedef int command_of_state(struct command *command, const rotid_deck *deck, struct result_state *state);
int command_each_state(struct command *command, struct result *result, command_of_state *work, int *count);

/* Head of the result, from the arguments alone; command_read_deck completes it with the deck. */
void command_begin_head(struct command *command);

/* The exit code of a status below zero, after saying what happened. */
int command_fail(struct command *command, int status);
/* The same of a call of the library that left its reason in `failure`. */
int command_fail_with(struct command *command, int status, const char *failure);

/* Tables go to standard output unless that carries JSON or the user wants none. */
int command_wants_table(const struct command *command);
/* Where they go. */
struct screen command_screen(struct command *command);
/* Where tables are wanted: those of a result, and behind them the warnings that have no place in a file. */
void command_show(struct command *command, const struct result *result, screen_of *show);

/* Writes the result, with the warnings among the messages, where --json says; `code` unless that fails. */
int command_write_result(struct command *command, struct result *result, int code);

/* The same of a deck that was made from that of the command, to --extended. */
int command_write_deck(struct command *command, const char *text, int code);

/* A state to work on at identified values, or the deck that is one. */
struct fitted_state {
    const char *name; /* NULL of a deck that is one state */
    const struct job *job;
    struct identification identified; /* by all states, with its own unknowns; fit NULL: nothing was fitted */
};
struct command_fit {
    int first, count; /* all states of the deck, or that of --state */
    struct fitted_state *state;
    rotid_fit_result *fit; /* to be freed with rotid_fit_free, or NULL */
};

/* The states of the deck or that of --state, not fitted yet; refused where `what` ("a diagnosis", NULL for anything) is of
 * bending and one of them is not. An exit code, EXIT_DONE to go on. */
int command_choose_states(struct command *command, const char *what, struct command_fit *fit);

/* Fits the deck, where `wanted` and a mode is measured, over all of its states. Without a mode and with unknowns a warning. fit:
 * of command_choose_states. An exit code, EXIT_DONE to go on. */
int command_fit_deck(struct command *command, int wanted, struct command_fit *fit);

/* Warns of identifications at whose values the models are `done`, where they did not end well or their reduction is coarse. An
 * exit code, EXIT_DONE or EXIT_DOUBTFUL. */
int command_judge_fit(struct command *command, const struct command_fit *fit, const char *done);

/* Refuses --csv where one of its files is read or is that of --json. An exit code, EXIT_DONE to go on. */
int command_refuse_csv(const struct command *command, const char *const *name);
/* Writes the tables that --csv asks for; `code` unless that fails. name: of each, NULL behind the last. */
int command_write_csv(struct command *command, const char *const *name, struct table *const *table, int code);

/* Whether somebody would see a line of progress. */
int command_wants_progress(const struct command *command);
/* What a long call of the library gets: command_cancelled and, where somebody would see it, a line on standard error that is
 * written over five times a second. One at a time. */
rotid_environment command_environment(struct command *command);

/* A write beyond the largest size of a file is an error, and how a child ended can be waited for, whatever was inherited. */
void command_set_signals(void);
/* From now on the first SIGINT or SIGTERM makes command_cancelled say so. Where the command has
 * not ended 0.9 s later, the program ends by that signal, after the file that is open for writing if there is one. A second
 * signal, not at the same time, ends the program at once. Before, while decks are read and nothing is written, the first one
 * does. */
void command_watch_signals(void);
/* Polled by long computations: nonzero after SIGINT or SIGTERM. */
int command_cancelled(void *unused);

/* A run of the program with these arguments, argv[0] its name: parsed, run, its memory given back. The exit code. */
int command_line(int argc, char **argv);

int command_check(struct command *command);
int command_modes(struct command *command);
int command_sensitivity(struct command *command);
int command_speeds(struct command *command);
int command_identify(struct command *command);
int command_diagnose(struct command *command);
int command_suggest(struct command *command);
int command_frf(struct command *command);
int command_ema(struct command *command);
int command_uff(struct command *command);
int command_report(struct command *command);
int command_export(struct command *command);
int command_study(struct command *command);
int command_test(struct command *command);

/* Of the build. */
extern const char *const build_commit;
const char *build_blas(void);
void build_set_threads(int threads);
/* How many threads, up to `wanted`, may call the BLAS at the same time; asked: no fewer than these will do. 0 after saying that
 * there is no room for their buffers, without which OpenBLAS never returns. */
int build_make_room(int wanted, int asked);

/* ------------------------------------------------------------------------------------------------------------- arguments */

/* What the arguments of the program say. */

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

/* --------------------------------------------------------------------------------------------------------- command study */

/* The command `study`, apart from how its runs come to processors. */

/* Computes the runs that are missing in the record: statuses of workers_run. context: of the caller of study_command. */
typedef int study_compute(void *context, struct command *command, const struct study *study, struct study_record *record);

/* Reads the plan, or the decks, that the command names. An exit code, EXIT_DONE to go on; what is wrong has been said. The plan
 * hangs on the command's pool. */
int study_prepare(struct command *command, struct study *study);

/* Computes a prepared study into the file of --output and reports it. The exit code. */
int study_conduct(struct command *command, const struct study *study, study_compute *compute, void *context);

/* --------------------------------------------------------------------------------------------------------------- options */

/* The options of the program, a row each. From the rows follow what is accepted, what is said where it is not, and `rotid COMMAND
 * --help` (arguments.c), and the completions of the shells and the lists of docs/rotid.1, which `make tables` writes. */

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

#endif
