#ifndef ROTID_DECK_DECK_H
#define ROTID_DECK_DECK_H

/* deck: input decks (docs/deck.md) to jobs of src/run, and jobs to decks.
 *
 * Comes in: a deck as file or text, --set overrides. Goes out: struct states, one struct job a state, in SI; all errors with
 * file, line, column. Entrance: deck_read_states (deck.c). Steps of reading:
 *   deck_text.c          cards, options, data lines with their places, *INCLUDE; --set
 *   deck_table.c         tables of FILE= (table_text.c) become data lines
 *   deck_state.c         deck_read_all_states: the text of each *STATE with the common cards; unknowns common to states
 *   deck.c               deck_read_cards: the readers in phases, so that what a card refers to is there; then checks, functional
 *   card_table.c         a row a card: phase, routine; cards of plain numbers have rows alone, lists of rotor or machine
 *   deck_fields.c        one number, option or position with range and unit; options and data lines by the rows of the card
 *   deck_units.c         *UNITS, factors to SI; sizes that rotors have
 *   deck_model.c         materials, sections, rings; tie rods, bars, holes, *PRELOAD (group.preload)
 *   deck_measured.c      sensors, modes, shapes, noise; *MEASURED, FILE
 *   deck_fit.c           *IDENTIFY, *FIT: unknowns, bounds, HOLDOUT; *FRF; deck_state.c: *SET, what a state has of its own
 *   deck_cause.c         *CAUSE: effects and suspects, faults of the data taken out of them
 *   deck_running.c       *RUNNING and what stands behind it: struct machine of src/running
 *
 * Writing: there is one writer, deck_write (deck_write.c): the text that was read, in parts (deck_edit.c), with what has to
 * change in it, printed by deck_print.c and the rows of the cards; read back and compared by these rows (deck_compare.c).
 * deck_extended.c gives it a diagnosis and finds the result its place; deck_proposed.c adds the *STATE of a test that src/suggest
 * proposes. Callers: src/api, src/cli, src/study; src/report writes numbers by deck_number_text. The room computes no K, no M, no
 * fit. */

#include <sys/stat.h>

#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "run/run.h"
#include "suggest/suggest.h"
#include "uff/uff.h"

/* ------------------------------------------------------------------------------------------------------------- deck text */

/* A deck as text: cards with their options and data lines, each piece with its place. */

#define DECK_LINE_LENGTH   1024
#define DECK_MOST_BYTES    (16ul << 20) /* all files together: a rotor takes kilobytes */
#define DECK_MOST_INCLUDES 16           /* depth */
#define DECK_MOST_FILES    1000         /* included ones: few lines in each of them include thousands more */
#define DECK_MOST_CARDS    5000         /* names are compared with each other */
#define DECK_MOST_MODES    100          /* and the highest number: a spectrum costs the cube of the number of modes */

struct field { /* of a data line, trimmed; empty between two commas */
    const char *text;
    struct place place; /* row and column where the line comes from a table */
    double in_si;       /* factor of a unit that the field has of its own; 0: that of the deck */
};

struct data_line {
    struct place place, end; /* end: just behind the last character */
    const char *text;        /* the whole line, comment removed */
    int count;
    struct field *field;
};

struct table_text;

/* A deck without a file. */
struct deck_memory {
    const char *name; /* what stands for the file in messages */
    size_t length;
    const char *text;      /* [length] */
    const char *directory; /* of what it names, or NULL: it may name no files */
};

/* A file as it was read, up to a zero. */
struct deck_file {
    const char *path, *text;
};

/* "CARD.OPTION=VALUE" that replaces an option of a deck. */
struct override {
    const char *card, *option, *value;
    const char *text;  /* what stands for the file in messages: "--set CARD.OPTION=VALUE" */
    const char *given; /* the whole, NULL of one that nobody wrote so */
};

/* What a deck was read from: whoever writes it again edits these texts. */
struct deck_origin {
    const char *path;      /* of the deck, as places name it */
    const char *directory; /* of a deck from memory, or NULL */
    int memory;            /* a deck from memory */
    int nfile;
    const struct deck_file *file; /* the deck, the last one, and what it includes, as they were read */
    int noverride;
    const struct override *override;
};

struct card_option {
    const char *name, *value; /* value "" where there is no '=' */
    struct place place, value_place;
    int overridden;   /* --set gave it */
    struct place end; /* just behind it */
};

struct card {
    const char *name;             /* upper case, without the asterisk */
    const struct deck_card *kind; /* NULL: there is none of that name */
    struct place place, end;      /* end: just behind its name and options */
    int noption, nline;
    struct card_option *option;
    struct data_line *line;
};

struct deck_text {
    int ncard;
    struct card *card;
    struct place end;
    int nfile; /* the deck, what it includes, and measured data that its cards name */
    const char **file;
    int ntable;
    struct table_text **table; /* read so far: a table may serve several cards */
    struct deck_origin origin; /* without overrides */
};

/* Reads a deck, a file or one from memory (not NULL), whose name is kept, and what it includes. Errors go to the list with their
 * place. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO or ROTID_ERROR_MEMORY. */
int deck_text_read(struct pool *pool, const char *path, const struct deck_memory *memory, struct message_list *messages,
                   struct deck_text *text);

/* The bytes of a file with a zero behind them; *about as by fstat. *length above `most`: it is longer, and of a regular file
 * nothing was read. NULL: memory is out, or *failed is the error number of the opening; else it is that of the reading, or 0. */
char *deck_read_file(struct pool *pool, const char *path, size_t most, struct stat *about, size_t *length, int *failed);

/* A path that `file` names: relative to the directory where that is not NULL, else to the folder of the file (NULL: to where the
 * program runs). NULL: memory is out. */
const char *deck_path_from(struct pool *pool, const char *path, const char *file, const char *directory);
/* As seen from the root. NULL: memory is out, or there is no such folder. */
const char *deck_absolute(struct pool *pool, const char *path);

/* The cards of a piece of a deck, whose places count from its text: *INCLUDE is a card like others, and nothing is said. */
void deck_text_read_piece(struct pool *pool, size_t length, const char *piece, struct deck_text *text);

/* A path that an option names, as seen from where the program runs: relative ones are relative to the file that names them, those
 * of an override to where the program runs; in a deck from memory both are relative to its directory. NULL: no memory, or, with
 * an error in the list, a deck from memory that may name no files. */
const char *deck_text_path(struct pool *pool, const struct deck_text *text, const struct card *card,
                           const struct card_option *option, struct message_list *messages);

/* One more card, or option of a card. NULL, or not 0, where memory is out. */
struct card *deck_text_add_card(struct pool *pool, struct deck_text *text, const char *name, struct place place);
int deck_text_add_option(struct pool *pool, struct card *card, struct card_option option);

/* Splits "CARD.OPTION=VALUE", parts of which are pointed to. ROTID_OK, ROTID_ERROR_SYNTAX where it has another form, or
 * ROTID_ERROR_MEMORY. */
int override_parse(struct pool *pool, const char *text, struct override *override);

/* The option of that name, or NULL. */
const struct card_option *card_option(const struct card *card, const char *name);

/* ------------------------------------------------------------------------------------------------------------------ deck */

/* Reads a deck, a file or one from memory (not NULL), applies the overrides, reads the measured data it names and checks
 * everything. All errors of the deck are in the list, each with file, line and column. ROTID_OK, ROTID_ERROR_SYNTAX,
 * ROTID_ERROR_IO, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION where all that is wrong is a section that cannot be. */
int deck_read_states(struct pool *pool, const char *path, const struct deck_memory *memory, int noverride,
                     const struct override *override, struct message_list *messages, struct states *states);

/* All states with cards [ncard] of somebody else behind those of the deck, common to all. They keep their own places, which
 * errors name. */
int deck_read_with(struct pool *pool, const char *path, const struct deck_memory *memory, int noverride,
                   const struct override *override, int ncard, const struct card *card, struct message_list *messages,
                   struct states *states);

/* ------------------------------------------------------------------------------------------------------------ deck cards */

/* Shared by the readers of the cards: what has been read so far, and the reading of single fields. */

#define DECK_MOST_KINDS 64             /* of cards */
#define DECK_QUANTITIES JOB_QUANTITIES /* whose units *UNITS can state */

enum deck_places {
    NO_PLACES,
    MATERIAL_PLACES,
    GROUP_PLACES,
    TIEROD_PLACES,
    BARS_PLACES,
    SENSOR_PLACES,
    CORRECTION_PLACES,
    DECK_PLACES
};

struct deck_reader {
    struct pool *pool;
    struct message_list *messages;
    struct deck_text text;
    struct job *job;
    int seen[DECK_MOST_KINDS]; /* of cards that may stand once */
    int nmaterial;
    struct material *material;
    int *material_complete;           /* [nmaterial] bit 1: elastic constants, bit 2: density */
    struct place *place[DECK_PLACES]; /* where the items of these lists stand, in the order of each list */
    int nplace[DECK_PLACES];
    long taken;                 /* rows of tables, by all cards */
    int nopen, *open_section;   /* sections without elements: the mesh follows from modes and noise */
    const struct card *card;    /* at hand, */
    const char *layout;         /* what a data line of it holds, */
    const struct deck_row *row; /* and its options and values */
    double length;              /* of the rotor, once all groups are read */
    double noise_frequency, noise_shape, floor_frequency, floor_shape;
    int states_floor; /* *NOISE has a floor */
    int impacts;      /* behind the standard deviations of the file, the fewest; 0: not known. Below 0: so many tests */
    const struct card *measured_card, *modes_card, *frequencies_card, *weighed_card, *fit_card, *identify_card;
    int tie;                             /* FIT, TIE=E:G */
    int *mean_kept;                      /* [nmode] FREQUENCIES, MEAN=NO */
    const char *state;                   /* that the cards are of, NULL in a deck without *STATE */
    int ncommon;                         /* the first cards of the text are common to all states; the others are of this one */
    int ncommon_unknown;                 /* the first unknowns come from those */
    int alone;                           /* no other state is read beside it */
    int held_out;                        /* HOLDOUT=STATE: all its modes are */
    int no_section;                      /* the one error is that of a section that cannot be */
    const char *likely[DECK_QUANTITIES]; /* that a warning has named, NULL: none yet */
    int nrunning;                        /* cards from *RUNNING on, which are taken out of the text */
    struct card *running;
    struct place margin_place; /* of *OPERATION */
    struct machine *machine;   /* that they make */
    unsigned warned;           /* kinds of numbers that a warning was given for */
};

/* Returns 1, as what it is the error of does. */
int deck_say(struct deck_reader *reader, enum severity severity, struct place place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
#define deck_error(reader, ...) deck_say((reader), SEVERITY_ERROR, __VA_ARGS__)
#define deck_note(reader, ...)  ((void)deck_say((reader), SEVERITY_WARNING, __VA_ARGS__))

void deck_add_place(struct deck_reader *reader, enum deck_places which, struct place place);

enum range { ANY, NOT_NEGATIVE, POSITIVE };

/* Sizes of numbers in SI units that leave room for what is computed of them: fourth powers of lengths, squares of stiffnesses,
 * reciprocals of variances. Beyond, results would be zero, infinite or no numbers, without a place to blame. */
#define DECK_LEAST 1e-30
#define DECK_MOST  1e30
/* Zero, or within these. */
int deck_is_usual(double value);

/* The factor that makes numbers in the unit `word` SI, of what has the unit `si` inside ("m", "1" for a share); 0 where that has
 * no such unit. */
double deck_unit_factor(const char *si, const char *word);
/* The factor that makes a number of the deck SI; what: "length [m]", or a unit alone. 1 for what has no unit. */
double deck_in_si(const struct deck_reader *reader, const char *what);
/* The same of a job. */
double deck_unit_of(const struct job_units *units, const char *what);
/* The deck's own one of lengths, for messages. */
const char *deck_length_unit(const struct deck_reader *reader);
/* Warns of a number, which the deck states by `text` and which is `value` in SI units, that rotors do not have. */
void deck_check_magnitude(struct deck_reader *reader, struct place place, const char *what, const char *text, double value);

/* Number i of a data line within the range; `what` names it in the error, and its unit ("outer diameter [m]"): the value
 * is SI whatever *UNITS says. 0, or 1 after an error. */
int deck_number(struct deck_reader *reader, const struct data_line *line, int i, const char *what, enum range range,
                double *value);
int deck_integer(struct deck_reader *reader, const struct data_line *line, int i, const char *what, int least, int most,
                 int *value);
/* Field i is there and not empty. */
int deck_has(const struct data_line *line, int i);
/* No more than `most` fields; otherwise an error that says what a line of this card holds. */
int deck_count(struct deck_reader *reader, const struct data_line *line, int most);
/* A number in metres, start, end, group.start or group.end, inside the rotor. */
int deck_position(struct deck_reader *reader, const struct field *field, const char *what, double *z);

/* The value of an option that must be there, or NULL after an error. */
const char *deck_option(struct deck_reader *reader, const struct card *card, const char *name, const char *expected);
/* unit: "" or as for deck_in_si. */
int deck_option_number(struct deck_reader *reader, const struct card_option *option, const char *unit, enum range range,
                       double *value);
extern const char *const deck_answers[]; /* NO, YES */
extern const char *const deck_counts[];  /* ELASTIC, ALL */

/* The same of an option's value. */
int deck_option_word(struct deck_reader *reader, const struct card_option *option, const char *const *words);
/* From `least` to `most` data lines; otherwise an error that says what is expected. Returns how many to read, never more than
 * `most`. */
int deck_lines(struct deck_reader *reader, const struct card *card, int least, int most);
/* The only one that there may be, NULL after an error. */
const struct data_line *deck_only_line(struct deck_reader *reader, const struct card *card);

/* deck_text_path of an option of this deck. NULL after an error or where memory is out. */
const char *deck_path(struct deck_reader *reader, const struct card *card, const struct card_option *option);

/* Index of the material of that name, -1 after an error. */
int deck_named_material(struct deck_reader *reader, const char *name, struct place place);

/* Index of the first `count` groups that is called so [length], -1 where there is none. */
int deck_find_group(const struct rotor *rotor, int count, const char *name, size_t length);
/* The group of that name, or that an option names: -1 after an error. */
int deck_named_group(struct deck_reader *reader, const char *name, struct place place);
int deck_option_group(struct deck_reader *reader, const struct card *card, const char *option);

#define FRF_MOST_LINES     1000000
#define DECK_MOST_ELEMENTS ROTOR_MOST_ELEMENTS /* of a segment, of a bundle of rods, of the rotor with its bundles */
#define DECK_MOST_STATES   100                 /* each is read with all common cards */
#define DECK_MOST_LINES    10000               /* of a card, and sensors of the rotor: they are compared with each other */

/* The readers of the cards (card_table.c). */
typedef void deck_card_reader(struct deck_reader *reader, const struct card *card);
/* What no row says of an item of a list; it may complete it. 0, or 1 after an error. */
typedef int deck_item_check(struct deck_reader *reader, const struct data_line *line, void *item);
deck_card_reader deck_units, deck_material, deck_elastic, deck_density, deck_sections, deck_layer, deck_perforation, deck_preload,
    deck_clamp, deck_sling, deck_heading, deck_modes, deck_shape, deck_frequencies, deck_measured, deck_noise, deck_weight,
    deck_cause, deck_identify, deck_fit, deck_frf, deck_choose_modes, deck_set, deck_running, deck_bearing, deck_pedestal,
    deck_operation;
deck_item_check deck_check_sensor, deck_check_tierod, deck_check_bars, deck_check_disk, deck_check_loss, deck_check_change,
    deck_check_runup, deck_check_unknown;

/* The causes that MODEL=SOLID leaves without a meaning: an error each. */
void deck_causes_of_solid(struct deck_reader *reader);
/* Of a solid: zones that end inside a section, a warning each. */
void deck_note_boxes(struct deck_reader *reader);

/* The cards of the text into the job, with everything that is checked of them. */
void deck_read_cards(struct deck_reader *reader);

/* parameter_find of a field, also of "left.E=right.E". 0, or 1 after an error. */
int deck_find_parameter(struct deck_reader *reader, const struct field *field, struct parameter *parameter, const char **unit);

/* NULL where a parameter may have this value: one of a cause within its own range, others as their cards ask for; one that leaves
 * it by rounding becomes its end. Else what was expected, in a unit of which one is `si`. */
const char *deck_outside_range(struct pool *pool, const struct rotor *rotor, struct parameter parameter, double si,
                               double *value);

/* Takes an unknown out of the job. */
void deck_drop_unknown(struct deck_reader *reader, int p);
/* What HOLDOUT=RUNUP, STATE:a, ... or HOLDOUT=RUNUP, 1-4 holds out: the measured critical speeds, states, a list of modes. The
 * option may be NULL. */
struct deck_holdout {
    int runup, nstate;
    const char **state, *modes;
};
void deck_read_holdout(struct pool *pool, const struct card_option *option, struct deck_holdout *holdout);

/* Where a parameter can lie. */
void deck_range_of(const struct rotor *rotor, const struct parameter *parameter, double *lower, double *upper);

/* What the tables of FILE hold becomes data lines of their cards, of new cards where a table holds that of several. *nread, the
 * number of cards in front, counts these. 0, or 1 after an error that leaves nothing to read. */
int deck_read_tables(struct deck_reader *reader, int *nread);
/* The table that FILE of a card names, read once whatever number of cards name it. NULL after an error, or where memory is out;
 * bad: its text has an error. */
struct table_text *deck_open_table(struct deck_reader *reader, const struct card *card);

/* Takes *RUNNING and what stands behind it out of the text, of whose cards *nread were read. */
void deck_split_running(struct deck_reader *reader, int *nread);
/* These cards into states->machine, once all states are read without an error. */
void deck_read_machine(struct deck_reader *reader, struct states *states);
/* Errors of a card or an option that is not known; of a NAME that two cards have. */
void deck_check_names(struct deck_reader *reader, const struct card *card);
void deck_check_unique(struct deck_reader *reader, int ncard, const struct card *card, int machine);

/* Where the name of the i-th group, spring, disk or tie rod is, NULL where there is none. */
const char **deck_name_of(const struct rotor *rotor, enum cause_target kind, int i);
/* Whether a deviation [count] is known. */
int deck_knows_any(ptrdiff_t count, const double *std);
/* Takes the faults that CAUSE cards state out of the data, in the order of the cards; the noise is known by then. */
void deck_apply_corrections(struct deck_reader *reader);
/* Whether "cause.parameter", which is no parameter of the model, has that name from a CAUSE card: of a suspect or a fault of the
 * data, which this reports, or of a card that was refused, which has been reported. */
int deck_cause_explains(struct deck_reader *reader, const char *parameter, struct place place);

/* ------------------------------------------------------------------------------------------------------ deck frequencies */

/* Frequencies at single sensors, from a card or a universal file. */

/* What a reading may differ from its mode, relative: no accelerometer loads a rotor more, and another mode is not far. */
#define POINT_FREQUENCY_RANGE 0.05

/* The frequencies of modes that have readings at single sensors, and the noise of all: what a mode, a component or a reading has
 * of its own, with the floors of *NOISE in quadrature; *NOISE itself where there is none. */
void deck_complete_noise(struct deck_reader *reader);

/* -------------------------------------------------------------------------------------------------- deck state, deck uff */

/* Decks of several states: the cards before the first *STATE and those of a state are the deck of that state, which is read like
 * any other. */

/* All states of the text, or the one that FIT, STATE=NAME chooses; of a deck without *STATE the one that it is. Cards from
 * `nread` on are common to all: overrides and others have added them. Memory, messages and text are those of reader, which is
 * otherwise new. Errors go to the list, of the common cards once; no section: as in the reader. */
void deck_read_all_states(struct deck_reader *reader, int nread, struct states *states);

/* What *SET says of lengths, before anything refers to positions. */
void deck_set_lengths(struct deck_reader *reader);

/* Reads the sets that say how far the modes of a universal file can be trusted, file->extra of a file that MEASURED names at
 * `path`, after its modes: chosen [count] are the sets behind the modes of the job, component is the value of a node that
 * DIRECTION asks for where there are several. Sets 55 of analysis type 0, behind a mode n of the file, by their first line of
 * text: ROTID STANDARD DEVIATION OF MODE n: of the components, in their unit; the second line of text is FREQUENCY_HZ value
 * DAMPING value, standard deviations as well, the third IMPACTS n or TESTS n; ROTID FREQUENCY AT POINT OF MODE n: Hz, with the
 * accelerometer at each node, less what a second line ABOVE_HZ value says; ROTID STANDARD DEVIATION OF FREQUENCY AT POINT OF MODE
 * n: Hz. They fill frequency_std, shape_std and the frequencies at single sensors of the job. Zero stands for what is not known;
 * sets with other texts are left alone. Anything malformed is an error of the deck. */
void deck_uff_std(struct deck_reader *reader, const char *path, const struct uff_file *file, int count,
                  const struct uff_shape *const *chosen, int component);

/* ------------------------------------------------------------------------------------------------------------- deck print */

/* Numbers and cards as a reader of decks takes them, in the units of the deck. */

struct deck_writer {
    struct pool *pool;
    const struct job *job; /* what is written; its units are those of the numbers, NULL: SI */
    char *text;            /* incomplete where memory is out, as the pool says */
    size_t length, room;
};

void deck_put(struct deck_writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

#define DECK_NUMBER_LENGTH 32

/* The fewest digits that give the value back to the last bit, written out unless that is much longer. Returns `text`. */
const char *deck_number_text(double value, char text[DECK_NUMBER_LENGTH]);

/* A number behind the separator, in the deck's unit of `what` ("length [m]", a unit alone, "" for a number without one): in such
 * digits, in another unit than SI to 15 of them, for a quotient is rounded. */
void deck_put_number(struct deck_writer *w, const char *separator, double value, const char *what);

/* The beginning of a card, and an option of it; the line goes on in the next one where it becomes long. The caller ends the line.
 * What a deck cannot give back is found when it is read back. */
void deck_put_card(struct deck_writer *w, const char *name);
void deck_put_option(struct deck_writer *w, const char *name, const char *value);
void deck_put_option_number(struct deck_writer *w, const char *name, double value, const char *what);

/* Cards of w->job. *MODES, *SHAPE, *FREQUENCIES and, where all modes have one noise, *NOISE, as they were read; with_sensors:
 * *SENSORS before; the two alone (NaN: without). The faults of the data from `first` on; a cause; the line of an unknown in
 * *IDENTIFY under this name; HOLDOUT= of the modes that are held out, "" where none is. */
void deck_put_measured(struct deck_writer *w, int with_sensors);
void deck_put_sensors(struct deck_writer *w, int count, const struct sensor *sensor);
void deck_put_noise(struct deck_writer *w, double frequency, double shape);
void deck_put_corrections(struct deck_writer *w, int first);
void deck_put_cause(struct deck_writer *w, const struct effect *effect);
void deck_put_unknown(struct deck_writer *w, const rotid_parameter *bounds, const char *name);
void deck_put_holdout(struct deck_writer *w);

/* The data as they were read, before the faults in them were taken out. */
struct job_raw deck_data_as_read(const struct job *job);

/* Of all modes, as they were read: NaN where they differ or one has none, of the frequencies where there are readings of single
 * sensors too. */
void deck_noise_of_all(const struct job *job, double *frequency, double *shape);

/* -------------------------------------------------------------------------------------------------------------- deck edit */

/* The text of a deck in parts that can be changed one by one; what is not changed stays as its user wrote it. */

/* Whether "NAME.x" names a *BEARING of the machine. */
int deck_is_of_bearing(const struct deck_reader *reader, const char *name);

/* Of *RUNNING and what stands behind it: the machine in operation ends a deck. */
#define DECK_BEHIND_STATES DECK_MOST_CARDS

/* A card with all lines up to the next one, comments among them. */
struct deck_part {
    const char *text, *file; /* file: that it stands in */
    size_t length, end;      /* end: where the comments and empty lines begin with which it ends */
    struct card read;        /* its first card, whose places count from its text; "" where there is none */
    int include, inside;     /* an *INCLUDE; behind it the parts of its file, so many */
    int state;               /* which *STATE it stands behind, from 0; -1: none; DECK_BEHIND_STATES */
    int changed, left_out;
};

struct deck_edit {
    struct pool *pool;
    const struct deck_origin *origin;
    int npart, nstate, running; /* running: of the part at hand, *RUNNING has been met */
    struct deck_part *part;
};

/* The parts of all files, with the overrides in them. An *INCLUDE of a file that the origin lacks is a card. ROTID_OK,
 * ROTID_ERROR_MEMORY, or ROTID_ERROR_IO of an origin that lacks the deck. */
int deck_edit_open(struct deck_edit *e, struct pool *pool, const struct deck_origin *origin);

/* Whether a part is this card. */
int deck_edit_is(const struct deck_part *part, const char *card);
/* The value of an option of a part, NULL: the card has none of that name. */
const char *deck_edit_option(const struct deck_part *part, const char *name);
/* Gives the option that value in place of its own, or behind the others; NULL: takes it out. */
void deck_edit_set(struct deck_edit *e, int part, const char *name, const char *value);

/* What becomes of a data line, the `number`-th from 0: text in front of it, values in place of its fields or behind them. */
#define DECK_EDIT_FIELDS 4
struct deck_line_edit {
    const struct data_line *line;
    int number;
    const char *before, *value[DECK_EDIT_FIELDS]; /* NULL: as it is */
};
void deck_edit_lines(struct deck_edit *e, int part, void (*edit)(struct deck_line_edit *, void *), void *context);

/* The comments of a part alone. */
void deck_edit_clear(struct deck_edit *e, int part);
/* Text behind the last line of a part, in front of the comments with which it ends. */
void deck_edit_append(struct deck_edit *e, int part, const char *text);
/* Puts text before part `at`, in front of the comments that introduce it. */
void deck_edit_insert(struct deck_edit *e, int at, const char *text);
/* A card alone. Returns `at`. */
int deck_edit_new(struct deck_edit *e, int at, const char *card);

/* The text of all parts but those that are left out. A file that is included stays one where none of its cards has changed or is
 * left out, else its cards stand in its place. Relative paths become absolute. */
void deck_edit_text(struct deck_edit *e, struct deck_writer *w);
/* One part alone: its card (1), its comments (2), both (3). */
void deck_edit_put(struct deck_edit *e, struct deck_writer *w, const struct deck_part *part, int with);

/* ----------------------------------------------------------------------------------------------------------- deck compare */

/* What a writer can do of a difference. */
enum deck_difference {
    DECK_OTHER_FIT = 1,      /* how is fitted */
    DECK_OTHER_HOLDOUT = 2,  /* which modes are held out */
    DECK_OTHER_ELEMENTS = 4, /* elements of sections */
    DECK_OTHER_NOISE = 8,    /* deviations of frequencies and shapes */
    DECK_OTHER_DATA = 16,    /* modes and shapes, as they were read */
    DECK_OTHER_SENSORS = 32,
    DECK_OTHER_MODEL = 64 /* anything else: there is nothing to be done */
};

/* Bits of how `read` differs from `meant`, both with their parameters at the starts, numbers to rounding; *card: the card that
 * says the gravest of them. Mode numbers and options of a job without measured modes count as well. */
unsigned deck_compare(struct pool *pool, const struct job *meant, const struct job *read, const char **card);
/* rotor_copy without the springs of a sling, which a deck does not state. */
int deck_copy_rotor(struct pool *pool, const struct rotor *rotor, struct rotor *copy);
/* Of the rotor alone: the last bits but those of the data. Sensors are compared by themselves. */
unsigned deck_compare_rotors(const struct rotor *meant, const struct rotor *read, const char **card);

/* ------------------------------------------------------------------------------------------------------------- deck write */

struct deck_write_options {
    int nextra;
    const char *const *extra; /* [nextra] lines of text for the heading, behind those of the deck; long ones are cut */
    const double *x;          /* [nparameter] starts of *IDENTIFY; NULL: as in the states */
};

/* The deck that `given` was read from, edited so that it reads as `meant`: with other starts, *FIT, elements, noise or measured
 * data where these differ, the causes, faults of the data and unknowns that it has besides, and without the suspects that it
 * lacks. Comments, names, units, *STATE, tables and included files stay as they are wherever what they say does; files are named
 * by absolute paths, so that the text can be read from anywhere. The text is read and compared before it is given. ROTID_OK and
 * *text on the pool; ROTID_ERROR_MEMORY; ROTID_ERROR_ARGUMENT and an error in the list, which names the card, where no such
 * text reads as what is meant. */
int deck_write(struct pool *pool, const struct states *given, const struct states *meant,
               const struct deck_write_options *options, struct message_list *notes, char **text);

/* deck_write of a diagnosis that has a verdict (sentence): what was named, the base model where nothing was, the moduli at their
 * fitted values, the verdict in the heading. */
#define DECK_EXTENDED_FROM "rotid " ROTID_VERSION " from " /* begins its heading, */
#define DECK_MESH_REFINED  "the mesh is refined: "         /* and this the line behind it where that is so */
int deck_write_extended(struct pool *pool, const struct diagnosis *diagnosis, struct message_list *notes, char **text);

/* The text of deck_write for the file `to`: the paths of files in the folder of the deck `from` are relative where `to` lies
 * there too. The result is read from there and compared with the text. ROTID_OK, ROTID_ERROR_MEMORY, ROTID_ERROR_IO where there
 * is no such folder, or ROTID_ERROR_ARGUMENT with an error in the list. */
int deck_place(struct pool *pool, const char *from, const char *text, const char *to, struct message_list *notes, char **placed);

/* The states of a text of deck_write, whose files are those of the directory. */
int deck_read_back(struct pool *pool, const char *path, const char *text, const char *directory, struct message_list *notes,
                   struct states *states);

/* ---------------------------------------------------------------------------------------------------------- deck proposed */

/* A test that is proposed, as the state of a deck. */

/* The *STATE of a test: what changes in the rotor, its sensors, its noise, and as comments where its measurements go, beside the
 * frequencies that the best rival expects, all in the units of the deck. job: the model that is tested. ROTID_OK and *text on the
 * pool, ROTID_ERROR_MEMORY, or ROTID_ERROR_ARGUMENT where a deck cannot say it: a support without a name. */
int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text);

/* The deck of `origin` with that state behind it: as it is where it has states, of which the new one takes the cards of `home`
 * (may be NULL) that say how the structure is; else its measured data become a state of their own, `measured`, so that the other
 * cards are common to both. Where the deck has a state of the name of the new one, that gets a number. Statuses of
 * deck_edit_open. */
int deck_add_state(struct pool *pool, const struct deck_origin *origin, const char *home, const char *state, char **text);

/* The same of a test that was suggested, read back: with the expected frequencies in it the text reads as the states `given` of
 * the deck and one more, which is `home` with what the test changes. Else *text is NULL, the list has an error and the status is
 * ROTID_ERROR_ARGUMENT, or ROTID_ERROR_IO or ROTID_ERROR_MEMORY. */
int deck_propose(struct pool *pool, const struct states *given, const char *home, const rotid_suggested_test *test,
                 struct message_list *notes, char **text);

/* ------------------------------------------------------------------------------------------------------------ table text */

/* A table as a spreadsheet writes it: rows of cells with their places. */

#define TABLE_MOST_BYTES   (16ul << 20) /* of one file */
#define TABLE_MOST_CELLS   500000       /* of one file: 10,000 sensors with fifty modes */
#define TABLE_MOST_TAKEN   1000000      /* rows that all cards of a deck take of tables */
#define TABLE_MOST_TABLES  100          /* of a deck */
#define TABLE_MOST_COLUMNS 20100        /* 10,000 sensors with a standard deviation each, and what else a row says */
#define TABLE_CELL_LENGTH  32           /* of the name of a cell */

struct table_text {
    const char *path;
    int bad; /* an error has been reported: of the caller */
    int nrow;
    struct data_line *row; /* rows that hold something; a place counts rows and columns from 1, text is NULL */
    double *number;        /* [nrow] of the cells of a column, NaN where there is none; of the caller */
};

/* The same of a file. `from`: what names it, the place of the error where it cannot be read. */
int table_text_read(struct pool *pool, const char *path, struct place from, struct message_list *messages,
                    struct table_text *table);

/* Whether the text is a number and nothing else. */
int table_is_number(const char *text);

/* "C7" of row 7 and column 3, as spreadsheets name it. Returns `name`. */
const char *table_cell_name(int row, int column, char name[TABLE_CELL_LENGTH]);

#endif
