#ifndef ROTID_STUDY_STUDY_H
#define ROTID_STUDY_STUDY_H

/* study: many identifications or diagnoses from one plan (docs/study.md); each run gives one line of a file of results.
 *
 * Comes in: a plan file, or decks. Goes out: a file of results (JSON, one line a run, after a header line), its summary. Steps:
 *   plan.c            plan_read: cards to axes: decks, variants, modes, sensors, noise, hidden effects
 *   study.c           study_open: every deck read in every variant, runs counted; study_locate: run i to its place on the axes
 *   jobs.c            jobs_fitted, jobs_truth: the deck that is fitted, the deck that makes the data; kept between runs
 *   experiment.c      experiment_make: data of the truth at drawn parameters (SOURCE=MODEL), or as measured; noise, sensors and
 *                     starts drawn by name (draw_stream: seed, purpose, replicate, mode, sensor), so order and machine do not
 *                     matter
 *   run.c             study_run: identify_states or diagnose_states on that, one thread; the line of it as JSON;
 *                     score_make: the verdict beside the hidden effect
 *   workers.c         workers_run: processes of this machine, a run each; a process that dies costs its run
 *   results.c         the header; a line knows its study and its own digest; results_open: every line checked, and where it
 *                     stands; record_open, record_append: the file while it grows, locked; record_finish: in order of the runs
 *   merge.c, summary.c, summary_table.c  shards into one file; of each cell bias, scatter, coverage of the intervals
 *
 * Callers: src/cli/command_study.c, src/mpi (hands out runs over MPI), src/page (summary of a file). study_run knows nothing of
 * files, processes and machines. Nothing in a run depends on the clock but its times. */

#include <sys/types.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "report/report.h"
#include "result/result.h"
#include "run/run.h"
#include "running/running.h"

/* ---------------------------------------------------------------------------------------------------------------- digest */

/* What tells whether two things mean the same: 64 bits of everything that is fed in. Comments, blanks and the places of files do
 * not count. Against accidents, not against malice. */

#define DIGEST_LETTERS 16

struct digest {
    uint64_t state;
};

void digest_open(struct digest *digest);
/* Numbers by their bits. */
void digest_integer(struct digest *digest, long long value);
/* With its length, so that "a", "bc" is not "ab", "c". NULL is not "". */
void digest_text(struct digest *digest, const char *text);

/* A number from a text, for streams of random numbers that have names. */
uint64_t digest_name(const char *name);

/* ------------------------------------------------------------------------------------------------------------------ plan */

/* A plan of many runs, as its file states it: keyword cards, docs/study.md. */

enum plan_command { PLAN_IDENTIFY, PLAN_DIAGNOSE, PLAN_SPEEDS };
extern const char *const plan_commands[]; /* as results name them */

/* Runs differ in their entries of these; study.c counts them, the last fastest. */
enum plan_axis { AXIS_DECK, AXIS_VARIANT, AXIS_MODES, AXIS_SENSORS, AXIS_NOISE, AXIS_HIDE, PLAN_AXES };

/* An entry of an axis; the rest is of the axis that it names. */
struct plan_item {
    const char *name;   /* as results have it; NULL: the plan does not have the axis, and this is its only entry */
    struct place place; /* where the plan states it */
    const char *path;   /* AXIS_DECK: as seen from where the program runs */
    int noverride;      /* AXIS_VARIANT */
    struct override *override;
    struct place *override_place; /* [noverride] their text, so that what the deck says of them can be placed */
    int keep, every;              /* AXIS_SENSORS; keep > 0: so many, drawn anew for each replicate; every > 0: the first and each
                                     one so far on; else all */
    double frequency, shape;      /* AXIS_NOISE: relative standard deviations, 0: none is added; shape NaN where none is stated */
    const struct card *end[2];    /* AXIS_HIDE: CAUSE cards with the values at either end; NULL: nothing is hidden */
};

struct plan_truth { /* a parameter of the model that makes the data, drawn between the two */
    const char *name;
    double lower, upper;
    struct place place;
};

struct plan {
    const char *path; /* NULL where decks were named on the command line */
    struct deck_text text;
    enum plan_command command;
    unsigned long seed;
    int replicates, baseline;
    int draws; /* of the bands of critical speeds */
    struct {
        int count; /* at least one */
        struct plan_item *item;
    } axis[PLAN_AXES];
    int from_model, shapes; /* of *DATA */
    int ntruth;
    struct plan_truth *truth;
    double spread;   /* of the starts, relative; 0: those of the deck */
    int count, grid; /* starts drawn for each replicate; or points along each parameter */
};

/* A place on the axes; -1 on an axis: none of its entries, the deck as it stands. */
struct study_cell {
    int at[PLAN_AXES];
};

/* What a cell has on an axis. */
const struct plan_item *plan_at(const struct plan *plan, const struct study_cell *cell, enum plan_axis axis);

/* Reads a plan; every error goes to the list with its place. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO, ROTID_ERROR_MEMORY. */
int plan_read(struct pool *pool, const char *path, struct message_list *messages, struct plan *plan);

/* The plan that runs each deck once as it stands. ROTID_OK or ROTID_ERROR_MEMORY. */
int plan_of_decks(struct pool *pool, int count, char *const *path, struct plan *plan);

/* Whether the cards of a file have *STUDY among them; 0 also where it cannot be read; or ROTID_ERROR_MEMORY. */
int plan_is(const char *path);

/* ---------------------------------------------------------------------------------------------------- study, check, draw */

/* A study: a plan with the decks it names, checked and counted. Run i of it is known by i alone: its result depends on the plan,
 * its files, the seed and i, not on who computes it or when. */

#define STUDY_MOST_RUNS 10000000

struct study_point {
    struct study_cell cell;
    long replicate, start; /* from 0 */
};

struct study_deck {
    const char *error, *digest; /* why every run of it fails, or NULL; of its name, cards and data */
    long *first;                /* [variants + 1] runs of its variants */
    long *starts;               /* [variants] of a replicate */
};

struct study {
    const struct plan *plan;
    int noverride; /* --set: on every deck, before the variant */
    const struct override *override;
    unsigned long seed;
    struct study_deck *deck; /* [decks] */
    long runs;
    int nfile;
    const char **file; /* what the decks are read from, where they can be read */
    struct study_digests digest;
};

/* Reads every deck in every variant, so that what is wrong with the plan is found before the first run. Errors of the plan go to
 * the list with their places. A deck that is wrong as it stands is a warning, and its runs will fail, unless all are. Everything
 * hangs on the pool, and `plan` and `override` are kept. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_MEMORY. */
int study_open(struct pool *pool, const struct plan *plan, int noverride, const struct override *override, unsigned long seed,
               struct message_list *messages, struct study *study);

/* 0 <= run < study->runs. Inside a cell the starts follow each other, then the replicates. */
struct study_point study_locate(const struct study *study, long run);

/* ------------------------------------------------------------------------------------------------------------------ jobs */

/* The jobs behind a run: the deck as it is to be fitted, and the deck that makes the data. */

/* The deck of a cell in its variant, with its modes; where it does not state the noise that the plan adds, and its functional
 * would be another one for that, or none, with that as *NOISE. Statuses of deck_read_states. */
int jobs_read_fitted(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                     struct states *states);

/* A state of a deck, or a deck that is one, as it stands, with a hidden effect. */
struct truth {
    struct job job;
    const struct cause_kind *cause; /* NULL: nothing is hidden */
    struct effect *effect;          /* of the job's rotor; NULL where the cause acts on the data */
    struct correction fault;        /* of such a cause */
    double lower[EFFECT_MOST_PARAMETERS], upper[EFFECT_MOST_PARAMETERS];
};

/* That of each state; what is hidden is in all. ROTID_ERROR_SYNTAX also where a range is upside down. */
int jobs_read_truth(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                    struct truth **truths);

/* The name of parameter p of a cause, physical or not; NULL behind the last. Where its value is. */
const struct effect_parameter_name *truth_parameter(const struct truth *truth, int p);
double *truth_value(struct truth *truth, int p);

/* What one process works with: the jobs read last, since runs that follow each other mostly share them. */
struct jobs {
    const struct study *study;
    struct kept_jobs {
        struct pool pool;
        struct study_cell of;
        int has, status; /* of the reading; the messages say what is wrong */
        struct message_list messages;
        struct states fitted;
        struct truth *truth; /* of each state */
    } fitted, truth;
};

void jobs_open(const struct study *study, struct jobs *jobs);
void jobs_close(struct jobs *jobs);

/* Pointers into *jobs, valid until the next call. Statuses as above; the messages say what is wrong. */
int jobs_fitted(struct jobs *jobs, const struct study_cell *cell, struct message_list *messages, const struct states **states);
int jobs_truth(struct jobs *jobs, const struct study_cell *cell, struct message_list *messages, struct truth **truth);

/* ------------------------------------------------------------------------------------------------------------ experiment */

/* The job of one run: the model that is fitted, with the data, the noise, the sensors and the start of this run. */

struct experiment {
    struct states states;  /* with the data of this run; of a deck without *STATE one */
    struct job *job;       /* of the first */
    double *truth;         /* [states.nparameter] NaN where not known; NULL where the data are measured */
    struct truth *made_by; /* [states.nstate] NULL where the data are measured; its effect or fault holds the values that
                                    were drawn, the same in all */
};

/* Everything hangs on the pool, or on *jobs until its next use. What is wrong goes to the list. Statuses of deck_read_states,
 * model_open and the prediction; ROTID_ERROR_ARGUMENT where the model has fewer modes than were measured. */
int experiment_make(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                    struct experiment *experiment);

/* ---------------------------------------------------------------------------------------------------------------- header */

/* The first line of a file of results: which study it is of. Lines of the study carry a stamp of it. */

/* The shard that a text such as "2/3" tells: runs with run % shards == shard - 1; NULL, 1 of 1: all. 0 where it is none. */
int shard_parse(const char *text, int *shard, int *shards);

/* Leans on the study; its shard, 1 of 1: all, is a text on the pool. */
struct study_header header_of(struct pool *pool, const struct study *study, const char *version, const char *commit, int shard,
                              int shards);

/* With the line feed at its end, to be freed; NULL where memory is out. */
char *header_text(const struct study_header *header);

/* The header in a line [length]; texts go to the pool. ROTID_OK, ROTID_ERROR_SYNTAX where it is none, ROTID_ERROR_MEMORY. */
int results_header_read(struct pool *pool, const char *text, size_t length, struct study_header *header);

/* What differs in "the file ..., here ...", such as "the plan has changed"; "" where they are of one study, NULL where memory is
 * out. The shard does not count, nor do decks and data with other_decks. */
const char *header_difference(struct pool *pool, const struct study_header *file, const struct study_header *here,
                              int other_decks);

/* What a line of results carries so that it can be told from a line that was changed or belongs elsewhere: which study it is of,
 * and a digest of everything before. One byte that is changed always changes the digest, more of them but once in 2^64. Against
 * accidents: whoever wants to forge a line can compute its digest. */

/* Of version and commit of the program, plan, decks, data, options, seed and number of runs: of all that the runs depend on. In a
 * study of decks each line carries the digest of its deck with the data, and that of the study knows nothing of them. */
void stamp_study(const struct study_header *header, char study[DIGEST_LETTERS + 1]);

/* A line that record_text made, with its stamp behind the last value; to be freed, NULL where memory is out. */
char *stamp_line(const char study[DIGEST_LETTERS + 1], const char *line);

/* --------------------------------------------------------------------------------------------------------------- results */

/* A file of results: where the line of each run stands. It is read line by line without ever holding more than one. */

struct result_place { /* of the line that counts for a run, the last one; length 0: there is none */
    int descriptor, failed;
    off_t offset;
    size_t length;
    uint64_t input; /* what tells the digest of its deck; 0: none */
};

struct results {
    const char *path;
    FILE *stream;
    struct study_header header;
    int shard, shards;              /* of the header */
    char study[DIGEST_LETTERS + 1]; /* stamp of its lines */
    struct result_place *place;     /* [header.runs] */
    long last;                      /* run of the last line, -1 where there is none */
    int in_order;                   /* the lines stand in order of the runs, once each */
    int lines;                      /* whole ones that were read, with the header */
    off_t end, size;                /* of the last whole line; of the file, more where its last line is cut */
};

/* Opens and reads the file. Texts of the header and places go to the pool. ROTID_OK: to be closed; ROTID_ERROR_SYNTAX where it is
 * something else or a line is wrong, ROTID_ERROR_IO: the list says so; ROTID_ERROR_MEMORY. */
int results_open(struct pool *pool, const char *path, struct message_list *messages, struct results *results);
/* Also where it is closed or was never opened. */
void results_close(struct results *results);

/* A line by its place, "" where there is none. NULL with errno. */
char *results_fetch(struct pool *pool, struct result_place place);

/* The run of a line, on the pool. NULL, or the mistake in the line; "" where memory is out. */
const char *results_line_read(struct pool *pool, const char *text, size_t length, struct study_run *run);

/* Writes the file `path` whole: the header and the lines in order of the runs. ROTID_OK, ROTID_ERROR_IO with errno,
 * ROTID_ERROR_MEMORY: then nothing is written. */
int results_write(const char *path, const struct results *results);

/* ----------------------------------------------------------------------------------------------------------------- merge */

/* Shards, or other parts of one study, into one file of results in order of the runs: byte for byte what one program alone would
 * have written, but for the times. */

struct merge {
    long runs, missing, failed;
    const char *list; /* of the runs that are missing, "3, 7-9"; the first few of many */
};

/* Reads the parts `part` [count] and writes `path`, which must not exist. A run in several parts must have the same result in
 * all, but for its time; where it failed in some and not in others, it is taken from those where it did not. What is missing is
 * no error: the file is then that of a study which goes on. ROTID_OK; ROTID_ERROR_ARGUMENT where the parts are not of one study
 * or contradict each other, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO: the list says so, and nothing is written; ROTID_ERROR_MEMORY. */
int merge_results(struct pool *pool, int count, char *const *part, const char *path, struct message_list *messages,
                  struct merge *merge);

/* ---------------------------------------------------------------------------------------------------------------- record */

/* The file of results while a study writes it. Each line goes to its end with one write, so that whatever ends the program leaves
 * whole lines and at most one that is cut, which the next start removes. One process at a time holds its lock. */

struct study_record {
    struct results file;           /* runs that are to be computed again have no line */
    char *path;                    /* without symbolic links */
    const struct study_deck *deck; /* [runs] decks of which each may change, whose run is computed again then; NULL: none may */
    long wanted, done, failed;     /* of the shard; failed ones are among those done */
    long next;                     /* where record_take goes on */
    double synced;                 /* on the clock */
};

/* Opens or creates the file of the study that the header and `deck` (as above) tell, and locks it. What is cut at its end goes;
 * everything else stays as it is. ROTID_OK; ROTID_ERROR_ARGUMENT where the file is something else, of another study or in use,
 * ROTID_ERROR_IO: the list says why; ROTID_ERROR_MEMORY. Without ROTID_OK nothing is open. */
int record_open(struct pool *pool, const char *path, const struct study_header *header, const struct study_deck *deck,
                int retry_failed, struct message_list *messages, struct study_record *record);

/* The next run that is missing and was not given out yet, or -1. */
long record_take(struct study_record *record);

/* Appends the line of a run as study_run makes it, stamped. ROTID_OK; ROTID_ERROR_IO with errno, ROTID_ERROR_MEMORY: the file
 * then ends with the line before. */
int record_append(struct study_record *record, const char *line);

/* To the disk, where the last time is a second ago; now [s] of the clock, infinity: in any case.
 * ROTID_OK or ROTID_ERROR_IO with errno. */
int record_sync(struct study_record *record, double now);

/* With every run there: writes the lines in order of the runs to a new file, which takes the place of this one, unless they stand
 * so already. ROTID_OK; ROTID_ERROR_IO with errno, ROTID_ERROR_MEMORY: the file is as it was. */
int record_finish(struct study_record *record);

void record_close(struct study_record *record);

/* ------------------------------------------------------------------------------------------------------------------- run */

/* One run of a study, as one line of JSON: docs/schema/study_line.schema.json. Knows nothing of files, processes or machines. */

/* Computes a run. *line: its text with the line feed at its end, to be freed; also where the run failed, which is
 * a result. ROTID_OK; ROTID_STOP_CANCELLED where the environment ended it, and ROTID_ERROR_MEMORY where there is no room for the
 * text: then there is no line. Uses one thread. */
int study_run(struct jobs *jobs, long run, const rotid_environment *environment, char **line);

/* The line of a run that could not be finished, such as "worker ended by signal 9". NULL where memory is out. */
char *study_run_failed(const struct study *study, long run, const char *error, double seconds);

/* ----------------------------------------------------------------------------------------------------------------- score */

/* The verdict of a diagnosis beside the effect that was hidden. */

enum score {                    /* their words: score_words of src/result */
             SCORE_QUIET,       /* nothing was hidden and nothing was found */
             SCORE_FALSE_ALARM, /* nothing was hidden and something was found */
             SCORE_RIGHT,       /* named, and nothing else */
             SCORE_IN_SET,      /* among those that cannot be told apart */
             SCORE_OTHER_SET,   /* not among those */
             SCORE_SILENT,      /* judged adequate */
             SCORE_UNEXPLAINED,
             SCORE_WRONG, /* something else was named */
             SCORE_COUNT
};

/* The experiment's data were made by a model. A cause is the hidden one by its id, its target, and where it has a place by that,
 * within its width or 3 % of the length; a mass is a mass, whether it is called added or that of an accelerometer there; one that
 * is said to act in one state alone is another one. A fault of the data is known by its id, sensors and block. */
enum score score_make(const struct experiment *experiment, const struct diagnosis *diagnosis);

/* --------------------------------------------------------------------------------------------------------------- summary */

/* What a file of results says as a whole: for each cell how its runs ended, what they found and how far that is from the truth.
 */

/* Reads a file of results, finished or not, with its header. runs: NULL, or takes a row of every run. ROTID_OK;
 * ROTID_ERROR_SYNTAX where it is something else, ROTID_ERROR_IO: the list says so; ROTID_ERROR_MEMORY. */
int summary_read(struct pool *pool, const char *path, struct message_list *messages, struct study_header *header,
                 struct table *runs, struct study_result *summary);

/* The summary and the runs as tables; on a page and a screen an axis on which cells do not differ is left away. */
struct table *table_of_cells(struct pool *pool, const struct study_result *summary);
struct table *table_of_cell_parameters(struct pool *pool, const struct study_result *summary);
/* A row for each parameter of a run, one for a run that failed. */
void table_add_run(struct table *table, const struct study_run *run);
/* How the runs ended and what they found together, why runs failed. */
struct shown shown_of_study(struct pool *pool, const struct study_result *summary);
void screen_study(const struct screen *to, const struct study_result *summary);

/* What a run says in numbers: the parameters of its fit, then its critical speeds, "forward:1" (mixed ones among them) and
 * "backward:1" [rpm]. NULL where memory is out. */
rotid_fitted_parameter *study_run_values(struct pool *pool, const struct study_run *run, int *count);

/* What a parameter is in truth; NaN where that is not known. */
double study_run_truth(const struct study_run *run, const char *name);

/* Whether two runs are of one cell. */
int summary_same_cell(const struct study_axes *a, const struct study_axes *b);

/* --------------------------------------------------------------------------------------------------------------- workers */

/* Runs of a study in processes of this machine. Each takes the number of a run, computes it and gives back its line; one that
 * dies costs its run, which is recorded as failed, and is replaced. */

struct workers_options {
    int workers;    /* >= 1 */
    double timeout; /* [s] a run may take, 0: any time */
    int (*cancelled)(void *context);
    /* NULL, or called a few times a second with what this program has computed and since when [s] */
    void (*progress)(const struct study_record *record, long computed, double seconds);
    void *context;
};

/* Computes the runs that are missing in the record. Handlers of signals are inherited by the workers, of which `cancelled` is
 * asked as well. ROTID_OK: every run is there; ROTID_STOP_CANCELLED: what was finished is there; ROTID_ERROR_IO (errno): the file
 * cannot be written, or no process can be started; ROTID_ERROR_MEMORY. Leaves no process behind. */
int workers_run(struct pool *pool, const struct study *study, const struct workers_options *options, struct study_record *record);

#endif
