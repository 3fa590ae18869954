#ifndef ROTID_UFF_UFF_H
#define ROTID_UFF_UFF_H

/* uff: universal files, that is mode shapes, nodes, functions and units of a modal test, read and written.
 *
 * A file is a row of sets, each between two lines '-1': a line with the number of the set, then records in columns as Fortran
 * writes them. Files of other writers have the numbers in free format, wrong lengths, missing or further records; what is meant
 * beyond doubt is read, all else is refused with file, line and column.
 *
 * Comes in: a path. Goes out, in three ways:
 *   uff_open, uff_next, uff_read_*   one set after the other; values of functions (58, 58b) come in pieces, so a file may be
 *                                    larger than memory; sets that nobody reads are read over. Used by src/import
 *   uff_read, uff_choose_modes,      nodes and shapes of a file, the modes among them by rising frequency, a complex shape as the
 *   uff_real_shape                   nearest real vector. Used by src/deck for MEASURED, FILE and by src/report for tables
 *   uff_write_*                      the sets of `rotid ema` (151, 164, 2411, 55: src/import) and `rotid frf` (58: src/report)
 *
 * Inside, from below: lines.c lines, bytes, numbers; record.c the layouts of records, from which follow reading and writing
 * of sets; reader.c the sets in turn: header, units, nodes, functions (58 and 58b), uff_si_factor; file.c set 55, whole files and
 * their modes, standard deviations in text lines (uff_extra_*). Numbers are those of the file: uff_si_factor gives
 * the factor to SI. The room knows neither rotor nor deck, and judges no data. */

#include "base/base.h"

/* ---- what sets hold */

/* What the sets of a universal file hold, as plain structs: one struct a kind of set, the same for reading and writing. Texts are
 * without trailing blanks; NULL stands for a text that the file leaves empty or writes as NONE. Numbers are as in the file: no
 * units applied. */

#define UFF_ID_LINES 5
#define UFF_TEXT     80 /* characters of an ID line */

struct uff_header { /* set 151 */
    char model[UFF_TEXT + 1], description[UFF_TEXT + 1], program[UFF_TEXT + 1];
    char created[UFF_TEXT + 1], saved[UFF_TEXT + 1], written_by[UFF_TEXT + 1], written[UFF_TEXT + 1]; /* date and time as text */
    int version[2], file_type;
};

struct uff_units { /* set 164: a value in SI times the factor is the value in the file */
    int code;      /* 1 SI, 2 foot (lbf), ..., 9 user */
    char description[21];
    int temperature_mode;
    double length, force, temperature, temperature_offset;
};

struct uff_node { /* sets 15, 781, 2411 */
    int id;
    int definition_system, displacement_system, color; /* 0 where there is none */
    double x[3];
};

/* Of set 55: analysis types and data types. */
enum { UNKNOWN_ANALYSIS = 0, NORMAL_MODE = 2, COMPLEX_FIRST_ORDER = 3, FREQUENCY_RESPONSE = 5, COMPLEX_SECOND_ORDER = 7 };
enum { REAL_DATA = 2, COMPLEX_DATA = 5 };

struct uff_shape { /* one set 55 */
    int line;      /* of the '-1' that opens the set, from 1 */
    char id[UFF_ID_LINES][UFF_TEXT + 1];
    int model_type, analysis_type;
    int data_characteristic, specific_type, data_type; /* 2 vector3, 3 vector6; 8 displacement, 11 velocity, 12 acceleration */
    int load_case;
    int number;          /* of the mode, or with analysis type 5 of the frequency; from record 7 */
    double frequency_hz; /* 0: a mode that does not oscillate */
    double damping;      /* viscous ratio, of a complex eigenvalue -Re lambda/|lambda|; 0 where the file has none */
    double hysteretic;   /* hysteretic damping ratio of analysis 2, else 0 */
    double modal_mass;   /* of analysis 2; 0 where there is none */
    double eigenvalue[2], modal_a[2], modal_b[2]; /* of analysis 3 and 7 */
    int is_complex;                               /* imag given */
    int component_count;                          /* values per node, 1 to 6 */
    int node_count;                               /* the format lets a writer leave out nodes whose values are all zero */
    int *node;                                    /* [node_count] ids, distinct, in the order of the file */
    double *real;                                 /* [component_count * node_count], components of a node contiguous */
    double *imag;                                 /* same, or NULL */
};

enum { /* function types of set 58 */
       UFF_GENERAL,
       UFF_TIME,
       UFF_AUTO_SPECTRUM,
       UFF_CROSS_SPECTRUM,
       UFF_TRANSFER,
       UFF_TRANSMISSIBILITY,
       UFF_COHERENCE,
       UFF_AUTO_CORRELATION,
       UFF_CROSS_CORRELATION,
       UFF_AUTO_PSD,
       UFF_ESD,
       UFF_PROBABILITY,
       UFF_SPECTRUM
};

enum { UFF_REAL_SINGLE = 2, UFF_REAL_DOUBLE = 4, UFF_COMPLEX_SINGLE = 5, UFF_COMPLEX_DOUBLE = 6 }; /* ordinate data type */

struct uff_axis {      /* records 8 to 11 of set 58 */
    int specific_type; /* 0 unknown, 1 general, 8 displacement, 9 reaction force, 11 velocity, 12 acceleration, 13 excitation
                          force, 15 pressure, 16 mass, 17 time, 18 frequency, 19 rpm */
    int length, force, temperature; /* exponents of the units */
    char label[21], unit[21];       /* "" for NONE */
};

struct uff_binary { /* first line of set 58b */
    int is_binary;
    int order;  /* 1 little endian, 2 big endian */
    int format; /* 1 DEC VMS, 2 IEEE 754, 3 IBM 5/370 */
    long long text_lines, bytes;
};

struct uff_function { /* sets 58 and 58b without their values */
    int line;         /* of the '-1' that opens the set */
    struct uff_binary binary;
    char id[UFF_ID_LINES][UFF_TEXT + 1];
    int type, number, version, load_case;
    char response_name[11], reference_name[11]; /* "" for NONE */
    int response_node, response_direction;      /* 0 scalar; +-1 x, +-2 y, +-3 z, +-4 to 6 rotations */
    int reference_node, reference_direction;
    int ordinate; /* UFF_REAL_SINGLE ... */
    long long count;
    int is_even;
    double start, step; /* of an even abscissa */
    double z;
    struct uff_axis abscissa, numerator, denominator, z_axis;
};

/* Of the values, by the ordinate data type. */
int uff_is_complex(const struct uff_function *function);
int uff_is_double(const struct uff_function *function);

/* ---- set by set */

/* Universal files, read one set after the other: nothing but the set at hand is in memory, and of a function only as many values
 * as are asked for, so a file may be larger than memory. */

enum { UFF_END = 1 }; /* beside the statuses of rotid.h: no further set, no further value */

struct uff_set {
    int number;       /* 58 of a set 58b */
    int is_binary;    /* 58b */
    int line;         /* of the '-1' that opens it, from 1; lines are not counted inside binary data */
    long long offset; /* of that line in the file, in bytes */
};

struct uff_reader; /* opaque; lives on the pool it was opened with */

/* Opens a file. What is wrong with it, now and later, goes to `messages` with file, line, column, set and what was expected.
 * ROTID_OK, ROTID_ERROR_IO, ROTID_ERROR_MEMORY. uff_close for a reader that was opened, NULL allowed. */
int uff_open(struct pool *pool, const char *path, struct message_list *messages, struct uff_reader **reader);
void uff_close(struct uff_reader *reader);

/* Goes on to the next set; the rest of the one before is read over (a binary set by its length). ROTID_OK, UFF_END, or
 * ROTID_ERROR_SYNTAX, _IO, _MEMORY. After an error of syntax in a set uff_next finds the next one, so a caller may go on. */
int uff_next(struct uff_reader *reader, struct uff_set *set);

/* Whether it can go back: a pipe cannot. */
int uff_can_return(const struct uff_reader *reader);

/* Goes back to a set that uff_next returned before, as if it had just been returned. ROTID_OK or ROTID_ERROR_IO. */
int uff_return_to(struct uff_reader *reader, const struct uff_set *set);

/* Each reads the set that uff_next has just returned, and fails with ROTID_ERROR_SYNTAX (messages say where), _IO or _MEMORY, or
 * with ROTID_ERROR_ARGUMENT when the set at hand is of another number or has been read. Arrays lie on `pool`; no memory is taken
 * for what is announced, only for what is there. Numbers that are not finite are errors. */
int uff_read_header(struct uff_reader *reader, struct uff_header *header);                            /* 151 */
int uff_read_units(struct uff_reader *reader, struct uff_units *units);                               /* 164 */
int uff_read_nodes(struct uff_reader *reader, struct pool *pool, int *count, struct uff_node **node); /* 15, 781, 2411 */
int uff_read_shape_set(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape);        /* 55 */

/* The records 1 to 11 of a set 58 or 58b, then, in pieces of any length, its values in turn: `*got` <= most of them, x (of an
 * uneven abscissa as in the file, else start + i step; or NULL), real, imag (0 for real data; or NULL). ROTID_OK with *got = 0 at
 * the end of the values, after which the set has been checked to be complete. A wrong number of bytes of a 58b is a warning where
 * its end stands behind the bytes that its values need. DEC and IBM numbers are refused by uff_read_values. */
int uff_read_function(struct uff_reader *reader, struct uff_function *function);
int uff_read_values(struct uff_reader *reader, long long most, double *x, double *real, double *imag, long long *got);

/* What a value of this quantity must be multiplied with to be in SI: specific data types of set 58 (8 displacement, 11 velocity,
 * 12 acceleration, 13 and 9 force, 15 pressure, 16 mass, 17 time, 18 frequency) and the exponents of the axis under `units` (NULL
 * or factors of 0: 1). A unit text "g" or "gn" of an acceleration is 9.80665 m/s2, whatever set 164 says. */
double uff_si_factor(const struct uff_units *units, const struct uff_axis *axis);

/* The ids of `count` structs, that of the first at `id` and the others `stride` bytes apart, with their order there: sorted, so
 * that those that occur twice are neighbours. NULL where memory is out. */
struct uff_label {
    int id, order;
};
struct uff_label *uff_sort_labels(struct pool *pool, int count, const int *id, size_t stride);

/* Whether lengths and forces have the same factors; temperatures stand in no quantity of a modal test. */
int uff_same_units(const struct uff_units *a, const struct uff_units *b);

/* ---- the nodes and shapes of a file */

struct uff_file {
    int node_count, shape_count, extra_count;
    struct uff_node *node; /* ids distinct, in the order of the file */
    struct uff_shape *shape;
    struct uff_shape *extra; /* sets 55 of analysis type 0 that rotid has written itself: their first line begins with "ROTID " */
};

/* Reads a file. Sets 15, 2411, 781 give nodes, sets 55 shapes; all others are skipped, with one note for each type. Everything
 * found lives on the pool. Reading stops at the first malformed set: an error in the message list that names file, line, column,
 * the set, and what was expected. Returns ROTID_OK, ROTID_ERROR_SYNTAX (the list says why), ROTID_ERROR_IO (cannot be read; also
 * in the list) or ROTID_ERROR_MEMORY. *out is empty unless ROTID_OK. A file without a set 55 is ROTID_OK. */
int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out);

/* ---- the modes among the shapes, as real shapes */

/* What sets 55 of `rotid ema` hold beside the shapes. */
enum uff_extra { UFF_EXTRA_SHAPE_STD, UFF_EXTRA_POINT, UFF_EXTRA_POINT_STD, UFF_EXTRAS };

/* Whether a shape has a complex eigenvalue. */
int uff_has_eigenvalue(const struct uff_shape *shape);

/* Whether a shape is one of a mode: not a frequency response. */
int uff_is_mode(const struct uff_shape *shape);

/* Modes by rising frequency, without those at 0 Hz and without the second of each conjugate pair: chosen[shape_count] gets them.
 * *rigid, *conjugates: how many are left out so. Returns their number. */
int uff_choose_modes(const struct uff_file *file, const struct uff_shape **chosen, int *rigid, int *conjugates);

/* number[shape_count] gets those of the chosen modes: of the file, less those of modes that were left out, where they are above
 * zero and rise with the frequency; else 1, 2, 3, ... */
void uff_mode_numbers(const struct uff_file *file, int count, const struct uff_shape *const *chosen, int *number);

/* Record 8 has six digits, which a good test knows better: `rotid ema` writes all of them in a line of text. [Hz] */
double uff_mode_frequency(const struct uff_shape *mode);

/* Component `component` at each node, [node_count], turned by the phase that makes its real part largest: the real vector nearest
 * to a complex one. Returns the share of the motion (sum of squares) that is out of phase. */
double uff_real_shape(const struct uff_shape *mode, int component, double *value);

/* Which set of `rotid ema` this is and of which mode, by its first line of text: UFF_EXTRAS where it is none. *number: 0 where
 * the text names none. */
enum uff_extra uff_extra_of(const struct uff_shape *set, int *number);

/* How many impacts, or tests, such a standard deviation rests on, in its third line of text; 0: it does not say. */
int uff_extra_count(const struct uff_shape *set, int *tests);

/* Whether the i-th node of such a set has a standard deviation in some direction: where that in another one is zero, the shape's
 * zero there was not measured. */
int uff_extra_is_known(const struct uff_shape *set, int i);

/* The standard deviation of the frequency [Hz], zero where it is not known, in the second line of a UFF_EXTRA_SHAPE_STD. 0, or 1
 * where the line has another form. */
int uff_extra_frequency_std(const struct uff_shape *set, double *hz);

/* ---- writing */

/* Universal files, written set by set to a stream that the caller has opened and will close and check (ferror): the formats of
 * the sets that uff_read_* read, with the same structs. Reading what was written gives the same values to the digits of the
 * format, and bit by bit for binary sets. Every routine returns ROTID_OK, ROTID_ERROR_IO, or ROTID_ERROR_ARGUMENT for what the
 * format cannot hold: a value that is not finite (binary sets hold it), a line of text that looks like the end of a set, a label
 * beyond the width of its field. The stream may hold a part of the set then. */

/* Lines of a universal file under construction, column by column. */

#define UFF_PUT_LIMIT 160 /* the widest line has 13 + 2 * 20 or 80 columns */

/* The first failure stays: what follows it is not written, so one look at the end is enough. */
struct uff_put {
    FILE *stream;
    int status;    /* ROTID_OK, ROTID_ERROR_IO or ROTID_ERROR_ARGUMENT */
    size_t length; /* of the line so far */
    char line[UFF_PUT_LIMIT + 1];
};

int uff_write_header(FILE *stream, const struct uff_header *header);                /* 151 */
int uff_write_units(FILE *stream, const struct uff_units *units);                   /* 164 */
int uff_write_nodes(FILE *stream, int set, int count, const struct uff_node *node); /* 15 or 2411 */
int uff_write_shape(FILE *stream, const struct uff_shape *shape);                   /* 55 */

/* Set 58, as text; function->binary.is_binary is ROTID_ERROR_ARGUMENT. The values come in pieces: uff_write_function writes the
 * records before them, uff_write_values any number of values (x only of an uneven abscissa, imag only of complex ones), until
 * function->count are there; uff_end_function closes the set. */
struct uff_function_writer {
    struct uff_put put;
    const struct uff_function *function;
    long long written;
    int on_line; /* numbers on the current line of text */
};
int uff_write_function(FILE *stream, const struct uff_function *function, struct uff_function_writer *writer);
int uff_write_values(struct uff_function_writer *writer, long long count, const double *x, const double *real,
                     const double *imag);
int uff_end_function(struct uff_function_writer *writer);

/* ---------------------------------------------------------------------------------------------------------------- inside */

/* The room src/uff from inside: lines and their numbers, layouts of records, lines under construction, the reader. */

/* One number as Fortran or C writes it: what is wrong with it. */

enum uff_fault { UFF_FAULT_NONE, UFF_FAULT_COUNT, UFF_FAULT_MALFORMED, UFF_FAULT_RANGE, UFF_FAULT_NOT_FINITE };

/* The whole of text [length] must be the number; *value is set when it is. Fortran writes the exponent as E, D or Q in either
 * case, or, where it has three digits, without the letter: 1.0-100. */
enum uff_fault uff_parse_real(const char *text, size_t length, double *value);

/* Lines of a universal file, the bytes of its binary sets, and the numbers in its lines. */

/* The formats stop at 80 columns; ID lines and free-format writers go beyond. */
#define UFF_LINE_LIMIT 4096
/* Numbers of one record. The formats allow 12; a record 7 may announce more, which are read over. */
#define UFF_VALUE_LIMIT 64
/* Bytes read at once: large beside a line, small beside what a seek over a binary set saves. */
#define UFF_BUFFER 32768

struct uff_lines {
    FILE *stream;
    const char *path;
    struct message_list *messages;
    int line;      /* number of text, from 1 */
    int set;       /* number of the set being read, 0 between sets */
    int strict;    /* the set was opened by '-1' in columns 5 and 6 */
    int overlong;  /* text holds only the beginning of the line */
    size_t length; /* of text, without line end and trailing blanks */
    char text[UFF_LINE_LIMIT + 1];
    long long offset; /* of the first byte of text in the file */
    struct {          /* the line before */
        int line, is_delimiter, is_strict;
        long long offset;
    } before;
    long long size;    /* of the file; -1 of a pipe, in which there is no seeking */
    long long base;    /* of buffer[0] in the file */
    size_t at, filled; /* in buffer */
    char buffer[UFF_BUFFER];
};

/* Opens lines->path. ROTID_OK or ROTID_ERROR_IO (in the message list). */
int uff_open_lines(struct uff_lines *lines);

/* Adds an error at the current line and returns ROTID_ERROR_SYNTAX. Column from 1, or 0. */
int uff_fail(struct uff_lines *lines, int column, const char *format, ...) __attribute__((format(printf, 3, 4)));
void uff_warn(struct uff_lines *lines, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A piece of the file fit for a message: shortened, unprintable bytes replaced. Returns buffer. */
#define UFF_EXCERPT 32
const char *uff_excerpt(const char *text, size_t length, char buffer[UFF_EXCERPT]);

/* The next line, of any kind: ROTID_OK, UFF_END or ROTID_ERROR_IO (in the message list). */
int uff_take_line(struct uff_lines *lines);

/* The next line of a set that is read: the end of the file and an overlong line are errors. `expected` is for the message. */
int uff_expect_line(struct uff_lines *lines, const char *expected);

/* Whether the current line is '-1' alone. With `strict`, in the columns 5 and 6 it belongs into. */
int uff_is_delimiter(const struct uff_lines *lines, int strict);

/* Reads or skips `count` bytes that are not lines; lines are not counted there, since what can be skipped is not looked at. */
int uff_take_bytes(struct uff_lines *lines, long long count, void *bytes); /* bytes NULL: reads over them */
int uff_skip_bytes(struct uff_lines *lines, long long count);

/* Goes to a byte of the file, after which uff_take_line returns line number `line`. ROTID_OK or ROTID_ERROR_IO (in the list). */
int uff_seek(struct uff_lines *lines, long long offset, int line);

/* Whether a '-1' that ends a set stands behind `count` bytes from here, at once or in a line of its own; 0 also where there is no
 * seeking. ROTID_OK or ROTID_ERROR_IO. */
int uff_find_end(struct uff_lines *lines, long long count, int *found);

/* The columns of a line: so many integers of that width, then so many reals of that width. */
struct uff_form {
    int integers, integer_width, reals, real_width;
};

/* The numbers of the current line, to integer [form->integers] and real [form->reals]. The line holds exactly those, separated
 * by blanks or else in the columns of the form. `what` names the record in messages. ROTID_OK or ROTID_ERROR_SYNTAX. */
int uff_parse_line(struct uff_lines *lines, const struct uff_form *form, const char *what, int *integer, double *real);

/* Reads lines until `count` <= UFF_VALUE_LIMIT reals are there, `columns` of `width` a line; a free-format writer may put all
 * that are left on one. */
int uff_read_reals(struct uff_lines *lines, int count, int columns, int width, const char *what, double *real);

/* The same for integers, 8 columns of 10 a line, where the first line has been read already. */
int uff_read_integers(struct uff_lines *lines, int count, const char *what, int *integer);

/* The reals of the current line, of which at most `left` are due, in columns of those widths: a full line, or as many as there
 * are, up to UFF_VALUE_LIMIT. *taken of them to value. */
int uff_parse_values(struct uff_lines *lines, int columns, const int *width, long long left, const char *what, double *value,
                     int *taken);

/* A record of mixed contents in columns. A blank number is 0, as Fortran reads it, unless it is required. */
enum uff_kind { UFF_INTEGER, UFF_REQUIRED_INTEGER, UFF_LONG, UFF_REAL, UFF_WORDS };
struct uff_column {
    enum uff_kind kind;
    int start, width; /* start from 0 */
};
struct uff_cell {
    size_t start, length; /* in the line, without blanks around it */
    long long integer;
    double real;
};
#define UFF_CELL_LIMIT 10

/* Lines of universal files with what stands in them, for both directions: which columns, and which member of the struct. From one
 * layout follow uff_read_record and uff_put_record. */

struct uff_member {
    struct uff_column column;
    size_t offset; /* int; UFF_LONG: long long; UFF_REAL: double; UFF_WORDS: char [width + 1], written to the left, NONE where
                      empty */
    int decimals;  /* UFF_REAL */
    int one_more;  /* UFF_REAL: a digit more where the number has one and it leaves a blank before it */
};

struct uff_record {
    const char *what; /* in messages */
    int is_exact; /* integers and behind them reals, all of them there (uff_parse_line); else a blank one is 0 (uff_cut_record) */
    int count;
    struct uff_member member[UFF_CELL_LIMIT];
};

/* Cuts the current line in the columns of a record or, when a number is none there, at blanks if that gives as many fields: all
 * of the line (UFF_WHOLE), or of a line with other contents those behind the first `before`. Returns the number of the first cell
 * that is wrong, or -1 when none is. */
#define UFF_WHOLE (-1)
int uff_cut_line(const struct uff_lines *lines, const struct uff_record *record, int before,
                 struct uff_cell cell[UFF_CELL_LIMIT]);

/* The same, with an error in the list when there is one. ROTID_OK or ROTID_ERROR_SYNTAX. */
int uff_cut_record(struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT]);

/* Copies a text to out [room], without trailing blanks, cut to its room; NONE gives the empty text. */
void uff_copy_text(const char *text, size_t length, size_t room, char *out);

/* The five lines of text of a set, each of at most UFF_TEXT characters. */
int uff_read_id(struct uff_lines *lines, char id[UFF_ID_LINES][UFF_TEXT + 1]);

/* Where the fields of a line stand. */

struct uff_field {
    size_t start, length;
};

/* By set and record. */
extern const struct uff_record uff_versions_151, uff_units_164, uff_node_15, uff_node_2411, uff_place_2411, uff_kind_55,
    uff_location_58, uff_form_58, uff_abscissa_58, uff_ordinate_58, uff_denominator_58, uff_z_axis_58;

/* The next line, or the one at hand, to the members of the struct `to`. */
int uff_read_record(struct uff_lines *lines, const struct uff_record *record, void *to);
int uff_take_record(struct uff_lines *lines, const struct uff_record *record, void *to);

/* Cuts the line at hand without a word: the member that is wrong, or -1; cells for messages. The members are set where none is.
 */
int uff_cut_members(const struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT],
                    void *to);

/* The reader of a universal file from inside. */

enum uff_place {
    UFF_BETWEEN, /* sets */
    UFF_AT_BODY, /* behind the number of a set */
    UFF_AT_DATA, /* behind the records of a function */
    UFF_LOST,    /* after an error of syntax */
    UFF_BROKEN   /* after the file could not be read */
};

/* The values of the function at hand. */
struct uff_values {
    struct uff_function function;
    long long done;
    int per_value; /* numbers: x of an uneven abscissa, real part, imaginary part of complex ones */
    int columns, width[6];
    double pending[UFF_VALUE_LIMIT]; /* numbers of the last line of text that are not handed out yet */
    int pending_at, pending_count;
    int x_size, y_size;  /* bytes of a number */
    long long left_over; /* bytes between the last value and the end of a binary set */
    int is_finished;     /* the closing '-1' has been read */
};

struct uff_reader {
    struct uff_lines lines;
    const rotid_allocator *allocator;
    struct uff_set set;
    struct uff_binary binary;
    enum uff_place place;
    int opened_sets;         /* so far */
    long long warned_before; /* this offset: what was to say about lengths of sets 58b */
    struct uff_values values;
};

/* Every routine that reads a set begins and ends with these: uff_begin is ROTID_ERROR_ARGUMENT unless the set at hand is the
 * `number` and not read yet; uff_end takes the status of the reading, remembers where the reader is, and returns it. */
int uff_begin(struct uff_reader *reader, int number);
int uff_end(struct uff_reader *reader, int status, enum uff_place place);

/* The next line of a set that may end here: *is_end tells. The end of the file is an error. */
int uff_next_record(struct uff_reader *reader, const char *expected, int *is_end);

/* A node and where it stands. */
struct uff_placed_node {
    struct uff_node node;
    int line, set, set_line;
};
struct uff_node_list {
    struct uff_placed_node *item;
    int count;
};

/* Appends the nodes of the set at hand. */
int uff_append_nodes(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list);

#endif
