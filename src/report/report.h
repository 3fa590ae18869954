#ifndef ROTID_REPORT_REPORT_H
#define ROTID_REPORT_REPORT_H

/* report: results as tables for a person and as CSV; files that are whole or not there; the terminal.
 *
 * Comes in: structs of results (rotid.h, src/result) and, for some, what they were made of. Goes out: text on a stream, files.
 *
 *   table.c           struct table: columns and cells once; as text, as CSV (the files of a command, all or none, formulas made
 *                     harmless), as HTML, escaped; heading, notes and state on the screen
 *   results           identify.c, modes.c (check, sensitivity), diagnose.c, suggest.c, ema.c, frf.c, uff.c: tables (table_of_*),
 *                     what the command shows (screen_*) and, where rotid.h has no struct for it, that of its JSON
 *   reasons.c         sentences on a fit and a diagnosis, for screen and page
 *   chart.c           bars, strips along the axis
 *   human.c           numbers for people: human_value: prefix of the unit, four significant digits; human_interval: 95 %
 *   layout.c          cells and running text of a width
 *   output.c          output_open, output_close: a file is written beside its name, then renamed; several at once, all or none
 *   terminal.c        standard output and error: memory until terminal_flush; one filter makes control characters harmless
 *
 * Callers: src/cli, src/page (struct table, html), src/study and src/export (files, tables). The room computes nothing: which
 * numbers are good or bad is judged in src/result/judgement.c. No other room writes files, but for the results of src/study. */

#include "ema/ema.h"
#include "import/import.h"
#include "result/result.h"
#include "run/run.h"
#include "uff/uff.h"

/* ----------------------------------------------------------------------------------------------------------------- chart */

/* Charts of one line in plain ASCII: a signed bar, and strips along the axis of the rotor. */

#define STRIP_MOST 120

struct strip {
    double length; /* of the axis [m], begins at 0 */
    int columns;
    char line[STRIP_MOST + 1];
    const char *letter[STRIP_MOST]; /* of columns that no char holds, in the labels, which are the caller's */
};

/* A bar of 2 half + 1 columns around '|' that reaches the end at +-scale; '>' or '<' at the end beyond that. */
void chart_bar(char *bar, int half, double scale, double value);

struct strip strip_open(double length, int columns);
/* One digit a column, the largest value there rounded to the nearest; '+' from 9.5; values that are not finite leave no trace. */
void strip_digits(struct strip *strip, int count, const double *z, const double *value);
/* From 0 (' ') to 1 ('@'), between the points [count] with increasing z by straight lines. */
void strip_density(struct strip *strip, int count, const rotid_localisation *point);
/* "^", or "^---^" where it spans more than a column, with a label behind or before it. */
void strip_mark(struct strip *strip, double from, double to, const char *label);
/* "|name   ", cut to what lies between from and to. */
void strip_name(struct strip *strip, double from, double to, const char *name);
/* Round numbers of z. */
void strip_ticks(struct strip *strip);
/* label in the width given, then the strip without the blanks at its end. */
void strip_print(const struct strip *strip, FILE *out, int width, const char *label);

/* ------------------------------------------------------------------------------------------------------------------- csv */

/* Results as tables for a spreadsheet: commas, a decimal point, names in the first row, which `FILE=` of a deck reads. */

/* The files PATH.NAME.csv of the tables, all of them or none; name: NULL behind the last. ROTID_OK, ROTID_ERROR_MEMORY, or
 * ROTID_ERROR_IO with errno and the file in *failed. */
struct table;
int csv_write(struct pool *pool, const char *path, const char *const *name, struct table *const *table, const char **failed);

/* The modes of a universal file, and their shapes: real, in the one direction in which they move most. */
struct uff_tables {
    struct table *table[2];
    int direction; /* of the values of a node, from 0 */
    int points;    /* the file has frequencies at single points, which the tables do not have */
};

/* Reads modes and shapes. Errors go to the list. ROTID_OK, ROTID_ERROR_SYNTAX where the file has none, _IO, _MEMORY. */
int uff_tables_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_tables *tables);

/* ------------------------------------------------------------------------------------------------------------------ html */

/* Text and elements of a page, escaped and closed. */

/* A text of any origin: & < > and quotes as references; bytes that are not UTF-8, and controls (of direction as
 * well, which would show another text than there is), as U+FFFD. */
void html_text(FILE *out, const char *text);

/* <NAME>text</NAME> and a line feed; name: with attributes. */
void html_element(FILE *out, const char *name, const char *text);

/* ----------------------------------------------------------------------------------------------------------------- human */

/* Numbers and units for people: "115.7 GPa", "-4.4 %" with a true minus sign. Texts are UTF-8 in the pool; where memory is out
 * they are "", and the pool's user notices at the next allocation that counts. */

/* The text, "" for NULL. */
const char *or_nothing(const char *text);

/* The prefix a unit is read best with at a value: value in it = factor * value. Unit "1", which NULL stands for, and unknown ones
 * stay as they are. */
struct human_unit {
    double factor;
    char text[24]; /* "GPa", "kN/m"; "" for a pure number */
};
struct human_unit human_unit(double value, const char *unit);
/* Shows lengths and frequencies in the units of the deck of this result from now on; what a head does not state stays as it was,
 * m and Hz at first. One setting for the program, which shows one deck, or one page. */
void human_units_of(const struct result_head *head);

/* Decimals that show three significant digits of `spread` (0 ... 8, of a value below 0.001 to 20); four significant digits of
 * value where there is no spread.
 */
int human_decimals(double value, double spread);

/* With a number of decimals; "\u2013" where there is none (not finite). Below 0.001 with more than three decimals as 1.20e-5,
 * with the digits that the decimals show. Signed: a plus in front too. */
const char *human_fixed(struct pool *pool, double value, int decimals);
const char *human_signed(struct pool *pool, double value, int decimals);
/* The same in a column of numbers, where zeros count: 0.0002 among 0.0100. plus: "", or "+" in front too. */
const char *human_column(struct pool *pool, double value, int decimals, const char *plus);
/* With a number of significant digits; very large and small ones as 1.2e-7, as decks have them. */
const char *human_digits(struct pool *pool, double value, int digits);

/* The same without zeros at the end: "60" rather than "60.00". */
const char *human_trimmed(struct pool *pool, double value, int digits);

/* "115.7 GPa", "60 GPa": four significant digits without zeros at the end. */
const char *human_value(struct pool *pool, double value, const char *unit);
/* "130 +- 3 GPa" by half an interval: one of its digits, two where the first is 1 or 2; NULL where there is no interval. */
const char *human_quote(struct pool *pool, double value, const double ci[2], const char *unit);
/* "88.59 to 624.6 Hz": five digits without zeros at the end. */
const char *human_range(struct pool *pool, double from, double to, const char *unit);
/* "116 GPa (95 %: 55 to 176)", without the bracket where there is no interval. */
const char *human_interval(struct pool *pool, double value, const double ci[2], const char *unit);

/* "one", "two", ... "twelve", "13": for running text. */
const char *human_count(struct pool *pool, int count);
/* "iteration" or "iterations". */
const char *human_plural(int count, const char *one, const char *many);
/* "6 ms", "1.2 s", "3 min" */
const char *human_seconds(struct pool *pool, double seconds);

/* ---------------------------------------------------------------------------------------------------------------- layout */

/* Cells of tables and running text of a given width. A text may be UTF-8: columns are counted, not bytes. */

/* A text to the left; what does not fit ends in '~'. Control characters, line feeds among them, become U+FFFD. */
void text_cell(FILE *out, int width, const char *text);
/* The same of any length, with at least `width` columns. */
void name_cell(FILE *out, int width, const char *text);

int text_columns(const char *text);
/* The character that begins here, or U+FFFD. */
void text_character(FILE *out, const char *text);

/* Running text behind a head: lines of `width` columns, all but the first indented, broken between words. */
void wrap_text(FILE *out, int indent, int width, const char *head, const char *text);

/* ---------------------------------------------------------------------------------------------------------------- output */

/* Files that are whole or not there: written beside their final name, then renamed. */

/* Writes text to path, "-" being standard output. ROTID_OK or ROTID_ERROR_IO (errno tells why), ROTID_ERROR_MEMORY. */
int output_write(const char *path, const char *text);

/* The same for a file that is written piece by piece: the caller writes to `stream`, then closes the output. */
struct output {
    FILE *stream;
    const char *path; /* of the caller, who keeps it until the end */
    char *beside;
};

/* ROTID_OK, ROTID_ERROR_IO (errno tells why) or ROTID_ERROR_MEMORY; then there is nothing to close. */
int output_open(struct output *output, const char *path);
/* status: of the caller's writing. Renames the file when that is ROTID_OK and all has arrived, else removes it and keeps errno.
 * Returns the status, or ROTID_ERROR_IO (errno). */
int output_close(struct output *output, int status);
/* The same for several files, all of them or none: those that had taken their names when one could not are put back as they were
 * (where the file system has hard links). *failed is the index of that one. */
int output_close_all(int count, struct output *output, int *failed);
/* Whether there is a file that is not closed yet, for the handler of a signal. */
int output_is_open(void);
/* Removes it; errno stays. */
void output_abandon(struct output *output);
/* Why one of these failed, by errno. */
const char *output_error(void);

/* ------------------------------------------------------------------------------------------------------------ report ema */

/* Results of the modal extraction: as a table, and as the struct of their JSON. */

struct ema_report {
    const char *file;   /* that was read */
    const char *output; /* that was written, or NULL */
    const struct measurement *measurement;
    const struct ema_options *options;
    const struct ema *ema;
    double seconds;
};

/* On the pool; NULL where memory is out. functions: with curves, and the rms over all functions. */
const struct ema_result *ema_result_of(struct pool *pool, const struct ema_report *report, int functions);

/* ------------------------------------------------------------------------------------------------------------ report frf */

/* Synthesised transfer functions beside measured ones: as tables with a plot, as the struct of their
 * JSON, as universal file. */

struct frf_view {
    struct pool *pool; /* for curves, row by row */
    const char *state; /* NULL of a deck that is one */
    const struct job *job;
    const struct identification *identified; /* NULL: the model as the deck states it */
    const struct frf_set *set;               /* NULL: nothing measured beside */
    const struct frf_result *result;
};

/* The functions of JSON carry their curves up to this many lines of all of them together; more belong in a universal file. */
#define JSON_FRF_MOST_LINES 250000

/* On view->pool; NULL where memory is out. */
const struct transfer_result *frf_result_of(const struct frf_view *view);

/* Real and imaginary parts [n], on the pool. 0, or 1 where memory is out. */
int complex_parts(struct pool *pool, int n, const double complex *h, const double **re, const double **im);

/* Sets 151, 164 (SI), 2411 and a set 58 for each synthesised function. Statuses of uff_write_function, ROTID_ERROR_MEMORY. */
int frf_write_file(FILE *stream, const char *version, const struct frf_view *view);

/* ------------------------------------------------------------------------------------------------------------ report uff */

/* What a universal file holds, as the struct of its JSON. */

/* all: with every node and every shape. messages: their errors. On the pool; NULL where memory is out. */
const struct uff_result *uff_result_of(struct pool *pool, const char *path, const struct listing *listing, int summary_count,
                                       const char *const *summary, int all, const struct message_list *messages);

/* ---------------------------------------------------------------------------------------------------------- struct table */

/* One table for all ways to show it: made once from a result, then written as lines of text, as CSV or as HTML. Each call of
 * *_column adds the next cell, and in the first row the column: every row names the same columns, and begins with the first.
 * Values come in SI; people read them in the unit of human_unit, CSV has SI. What was added when memory was out is lost, as the
 * pool says. Texts are not copied. */

/* How a column is shown: a format with its digits, and bits. */
enum {
    SHOW_FORMAT = 7,
    SHOW_TEXT = 0,
    SHOW_ROW = 1, /* decimals of the row's interval, unit_column */
    SHOW_DIGITS_FROM = 3,
    SHOW_DIGITS_MOST = 31,
    IN_CSV_ONLY = 1024,
    NOT_IN_CSV = 2048,
    DETAIL = 4096,     /* on a screen only where the width allows it */
    MAY_BE_CUT = 8192, /* a text that a screen cuts where the width asks for it */
};
#define SHOW_FIXED(decimals)  (2U | (unsigned)(decimals) << SHOW_DIGITS_FROM)
#define SHOW_SIGNED(decimals) (3U | (unsigned)(decimals) << SHOW_DIGITS_FROM)
#define SHOW_DIGITS(digits)   (4U | (unsigned)(digits) << SHOW_DIGITS_FROM) /* significant ones */
#define SHOW_TRIMMED(digits)  (5U | (unsigned)(digits) << SHOW_DIGITS_FROM) /* the same without zeros at the end */
#define SHOW_CHANCE(digits)   (6U | (unsigned)(digits) << SHOW_DIGITS_FROM) /* a probability: "<0.001" below that */
#define SHOW_COUNT            SHOW_FIXED(0)
#define ROW_UNIT              "" /* unit of a column: the one that stands in the row */

struct table_column {
    const char *name, *unit, *shown; /* unit of the values, NULL of a text and a pure number; unit that is shown */
    unsigned show;
    double factor; /* from the one to the other */
};

struct table_cell {
    const char *text, *csv; /* as it is shown, "" where it stays blank; csv: NULL: the same */
    const char *note;       /* of the first one: of its row; NULL: none */
    double value;           /* of a number, in the unit of its column or row */
    int is_number;
};

struct table {
    struct pool *pool;
    const char *caption, *note; /* note: under the table */
    int ncolumns, ncells;
    int is_made; /* its columns are those of the first row */
    struct table_column *column;
    struct table_cell *cell; /* by rows */
    double row_factor;       /* of the unit of the row */
    int row_decimals;
};

/* A table without columns; NULL where memory is out, which all that adds takes. */
struct table *table_open(struct pool *pool, const char *caption);
int table_rows(const struct table *table);

void text_column(struct table *table, const char *name, unsigned show, const char *text);
/* A number that is not finite is shown as a dash. */
void number_column(struct table *table, const char *name, const char *unit, unsigned show, double value);
/* The same in the unit that suits a typical value of the column. */
void scaled_column(struct table *table, const char *name, const char *unit, unsigned show, double typical, double value);
/* What a reader has to know of it, "" for nothing. */
void table_note(struct table *table, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* What is said of the row that ends here: a line under it; "" for nothing. CSV does not have it. */
void row_note(struct table *table, const char *text);
/* The unit of this row, which suits the value; half: half its interval, for the decimals of SHOW_ROW. */
void unit_column(struct table *table, double value, double half, const char *unit);

/* Whether a column holds anything: one of dashes and blanks alone is shown in no form but CSV. */
int table_column_is_shown(const struct table *table, int column);
/* Lines with a head, columns two blanks apart, numbers to the right, signs of people's numbers as ASCII; the caption in front and
 * the note behind, both wrapped to `width` columns. */
void table_write_text(FILE *out, const struct table *table, int width);
/* A head and a line a row; numbers in SI with the digits that give them back, blank where there is none. */
void table_write_csv(FILE *out, const struct table *table);
/* <table> with caption; number: of the table on its page, for the id of the caption; words: its texts as the page shows them. */
typedef const char *table_words(struct pool *pool, const char *text);
void table_write_html(FILE *out, const struct table *table, int number, table_words *words);

/* ------------------------------------------------------------------------------------------------------ tables of results */

/* The tables of results, each for screen, CSV and page. */

/* A caption NULL: that of the table. head: for the references of the deck. */
struct table *table_of_compared_modes(struct pool *pool, const struct result_head *head, const rotid_identification *fit,
                                      const char *caption);
struct table *table_of_parameters(struct pool *pool, const rotid_identification *fit);
struct table *table_of_states(struct pool *pool, const rotid_identification *fit);
struct table *table_of_minimisers(struct pool *pool, const rotid_identification *fit);
/* "NLopt (LN_BOBYQA, LD_SLSQP) finds the same minimum", "" where nothing was minimised beside; *lower: it finds a lower one. */
const char *minimisers_sentence(struct pool *pool, const rotid_identification *fit, int *lower);
struct table *table_of_model_modes(struct pool *pool, const rotid_spectrum *spectrum);
/* The shapes at the sensors, whose ids the rotor has; NULL: they are counted. */
struct table *table_of_shapes(struct pool *pool, const struct rotor *rotor, const rotid_spectrum *spectrum);
struct table *table_of_sensitivity(struct pool *pool, const struct sensitivity *sensitivity);
/* "At core.E = 60 GPa, reduction GUYAN." */
const char *sensitivity_in_words(struct pool *pool, const struct sensitivity *sensitivity);
struct table *table_of_transfer_modes(struct pool *pool, const struct transfer_result *of);
struct table *table_of_test_modes(struct pool *pool, const struct ema_result *ema);
struct table *table_of_quality(struct pool *pool, const rotid_diagnosis *d);
/* What may hide in the parameters of a fit. */
struct table *table_of_hidden(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden);
/* all: every cause of a set that cannot be told apart, and every candidate; else the first ones, and how many there are more */
struct table *table_of_verdict_values(struct pool *pool, const rotid_diagnosis *d, int all);
/* The explanations with their shares of probability, together 99 %; all: or the first ones. */
struct table *table_of_explanations(struct pool *pool, const rotid_diagnosis *d, int all);
/* round: from 0; a note of each candidate says its size and place and what became of it */
struct table *table_of_candidates(struct pool *pool, const rotid_diagnosis *d, int round, int all);
struct table *table_of_detectable(struct pool *pool, int count, const rotid_detectable *list);
/* What became of a candidate: "named", "possible", "refused: ...". */
const char *candidate_fate(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *candidate);
/* A sentence for each doubtful mode and channel, or that there is none; NULL where memory is out. */
const char **ema_doubts(struct pool *pool, const struct ema_result *ema, int *count);
struct table *table_of_weighed(struct pool *pool, int count, const rotid_weighed *list);
struct table *table_of_runup(struct pool *pool, int count, const rotid_runup_speed *list);
struct table *table_of_campbell(struct pool *pool, const rotid_speeds *speeds);
struct table *table_of_response(struct pool *pool, const rotid_speeds *speeds);

/* --------------------------------------------------------------------------------------------------------------- reasons */

/* What is judged of a result, in sentences. */

enum tone { TONE_NONE, TONE_GOOD, TONE_CARE, TONE_BAD }; /* no judgement, to be relied on, with care, not at all */

struct reasons {
    struct pool *pool;
    int count;
    enum tone tone; /* the gravest of all */
    const char **text;
};

void reasons_add(struct reasons *reasons, enum tone tone, const char *format, ...) __attribute__((format(printf, 3, 4)));
#define reasons_say(reasons, ...) reasons_add((reasons), TONE_NONE, __VA_ARGS__)

/* How far to trust a fit; why a verdict is what it is; what is wrong with the measurement and the numbers. */
struct reasons reasons_of_fit(struct pool *pool, const struct result_head *head, const rotid_identification *fit);
struct reasons reasons_of_diagnosis(struct pool *pool, const rotid_diagnosis *d);
struct reasons findings_of_diagnosis(struct pool *pool, const rotid_diagnosis *d);
/* What was synthesised, of which model, and how it agrees. */
struct reasons sentences_of_transfer(struct pool *pool, const struct transfer_result *of);
const char *noise_in_words(struct pool *pool, const rotid_noise *noise);

/* "joint between core and right" of a target core|right, "support_extra at 0.5 m". */
const char *cause_name(struct pool *pool, const char *id, const char *target);
/* "at its bound", "known to 16 % only", "" */
const char *parameter_remark(struct pool *pool, const rotid_fitted_parameter *parameter);
/* "core.E by up to 9.3 %, core.G by up to 7.9 %": what causes below their detection limits may do; causes: with their names. */
const char *hidden_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden,
                            int causes);
int hidden_is_wide(const rotid_identification *fit, int count, const rotid_hidden *hidden);

/* ---------------------------------------------------------------------------------------------------------------- shown */

/* What a result says in sentences and tables, on the screen and on the page. all: rows and tables that take much room, too. */

#define SHOWN_TABLES 10

struct shown {
    struct reasons said;
    struct table *table[SHOWN_TABLES]; /* NULL behind the last; without rows: nothing is shown */
};

struct shown shown_of_modes(struct pool *pool, const rotid_spectrum *modes);
struct shown shown_of_speeds(struct pool *pool, const rotid_speeds *speeds, int all);
struct shown shown_of_suggestion(struct pool *pool, const rotid_suggestion *suggestion, int all);

/* ---------------------------------------------------------------------------------------------------------------- screen */

/* Results on the screen of a person: lines and tables. Where memory is out the pool says so, and what was written is cut. */

struct screen {
    FILE *out;
    struct pool *pool; /* of the tables */
    int verbose;       /* iterations, shapes, every pair of rivals, all candidates, times of the steps, every pole and function */
    int width;         /* columns of texts and charts; of tables where they have columns that may be left away */
};
#define SCREEN_WIDTH 100 /* fits a terminal beside an editor, and a page of a log */

void screen_heading(const struct screen *to, const struct result_head *head);
/* The warnings that have no place in a file: the others have been said on standard error. */
void screen_notes(const struct screen *to, const struct message_list *notes);
/* Before what is said of state i, where there are several: a line with its name. */
void screen_state(const struct screen *to, int i, const char *name);
/* A sentence. */
void screen_say(const struct screen *to, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Wrapped text behind a head, each reason on its own. */
void screen_paragraph(const struct screen *to, const char *head, const char *text);
void screen_reasons(const struct screen *to, const struct reasons *reasons);
void screen_shown(const struct screen *to, const struct shown *shown);
/* A table behind an empty line; nothing of one without rows. */
void screen_table(const struct screen *to, const struct table *table);

/* The heading and what a command found, of several states one after the other. The CAUSE cards of a check are told. */
typedef void screen_of(const struct screen *to, const struct result *result);
void screen_result(const struct screen *to, const struct result *result, screen_of *print);
screen_of screen_check, screen_modes, screen_suggest, screen_sensitivity, screen_speeds, screen_diagnose;
/* baseline: NLopt was asked for */
void screen_identify(const struct screen *to, const struct result *result, int baseline);
/* The summary, the sets, the doubtful places; sets that are alike share a row, at most about forty. */
void screen_uff(const struct screen *to, const char *path, const struct listing *listing, int summary_count,
                const char *const *summary);
/* Modes, what is doubtful, stabilisation table as a picture, MAC of the result with itself, worst channels. */
void screen_ema(const struct screen *to, const struct ema_report *report);
/* Several tests [count] of the files, and what they say together; output: the file of the means, or NULL. */
void screen_scatter(const struct screen *to, int count, const char *const *file, const struct ema test[], const struct ema *mean,
                    const struct ema_scatter *scatter, const char *output);
/* Behind a heading. */
void screen_frf(const struct screen *to, const struct frf_view *view, const struct transfer_result *of);

/* -------------------------------------------------------------------------------------------------------------- terminal */

/* Standard output and standard error. What is printed passes one filter here, whatever deck, file or argument it comes from:
 * control characters and bytes that are no UTF-8 become U+FFFD; line feeds and tabs stay. No other file of the program names the
 * two. */

/* Before anything is printed and any file is opened: no file of the program takes the place of a standard stream that is closed.
 * ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO where that cannot be seen to. */
int terminal_open(void);

/* Where tables are written to: memory, until terminal_flush or a message sends it to standard output. */
FILE *terminal_out(void);

/* ROTID_OK, or ROTID_ERROR_IO with errno where something did not arrive, now or before. */
int terminal_flush(void);

/* Appends the text to standard output. Statuses of terminal_flush. */
int terminal_print(const char *text);

/* A line to standard error, its line feed included: line feeds within the values would be lines of somebody else. */
void terminal_say(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same, with which a command ends: its exit code. */
#define terminal_end(code, ...) (terminal_say(__VA_ARGS__), (code))

/* Marks on standard error: what is said until the next mark stands out where that is a terminal with colours, unless the
 * environment has a NO_COLOR that is not empty or TERM=dumb. */
enum terminal_mark { TERMINAL_PLAIN, TERMINAL_BOLD, TERMINAL_WARNING, TERMINAL_ERROR };
void terminal_mark(enum terminal_mark mark);

/* What stands in terminal_out to standard error instead. */
void terminal_to_error(void);

/* A line on standard error that the next one is written over; whatever else is printed takes its place. */
void terminal_progress(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
