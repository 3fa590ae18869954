/* The room src/uff from inside: lines and their numbers, layouts of records, lines under construction, the reader. */
#ifndef ROTID_UFF_READER_H
#define ROTID_UFF_READER_H

#include <stddef.h>
#include <stdio.h>

#include "uff/uff.h"

/* One number as Fortran or C writes it. Internal to uff_*.c. */

enum uff_fault { UFF_FAULT_NONE, UFF_FAULT_COUNT, UFF_FAULT_MALFORMED, UFF_FAULT_RANGE, UFF_FAULT_NOT_FINITE };

/* The whole of text [length] must be the number; *value is set when it is. */
enum uff_fault uff_parse_integer(const char *text, size_t length, long long *value);

/* Fortran writes the exponent as E, D or Q in either case, or, where it has three digits, without the letter: 1.0-100. */
enum uff_fault uff_parse_real(const char *text, size_t length, double *value);

/* Lines of a universal file, the bytes of its binary sets, and the numbers in its lines. Internal to uff_*.c. */

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
int uff_take_bytes(struct uff_lines *lines, size_t count, void *bytes);
int uff_skip_bytes(struct uff_lines *lines, long long count);

/* Goes to a byte of the file, after which uff_take_line returns line number `line`. ROTID_OK or ROTID_ERROR_IO (in the list). */
int uff_seek(struct uff_lines *lines, long long offset, int line);

/* Whether a '-1' that ends a set stands behind `count` bytes from here, at once or in a line of its own; 0 also where there is no
 * seeking. ROTID_OK or ROTID_ERROR_IO. */
int uff_look_for_end(struct uff_lines *lines, long long count, int *found);

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

/* Some integers of the current line whose other contents are not known yet: value[i] from column start[i] (from 0) of
 * width[i], or, unless every one of them is there, blank-separated field number field[i] (from 0). Nonzero when found. */
int uff_find_integers(const struct uff_lines *lines, int count, const int *start, const int *width, const int *field,
                      long long *value);

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

/* Cuts the current line in these columns or, when a number is none there, at blanks if that gives `count` fields. Returns the
 * number of the first cell that is wrong, or -1 when none is. */
int uff_cut_line(const struct uff_lines *lines, int count, const struct uff_column *column, struct uff_cell *cell);

/* The same, with an error in the list when there is one. ROTID_OK or ROTID_ERROR_SYNTAX. */
int uff_cut_record(struct uff_lines *lines, int count, const struct uff_column *column, const char *what, struct uff_cell *cell);

/* Copies a text to out [room], without trailing blanks, cut to its room; NONE gives the empty text. */
void uff_copy_text(const char *text, size_t length, size_t room, char *out);

/* The next line as a text of at most UFF_TEXT characters. */
int uff_read_text(struct uff_lines *lines, const char *expected, char out[UFF_TEXT + 1]);

/* Where the fields of a line stand. */

struct uff_field {
    size_t start, length;
};

/* Lines of a universal file under construction, column by column. Internal to uff_write*.c. */

#define UFF_PUT_LIMIT 160 /* the widest line has 13 + 2 * 20 or 80 columns */

/* The first failure stays: what follows it is not written, so one look at the end is enough. */
struct uff_put {
    FILE *stream;
    int status;    /* ROTID_OK, ROTID_ERROR_IO or ROTID_ERROR_ARGUMENT */
    size_t length; /* of the line so far */
    char line[UFF_PUT_LIMIT + 1];
};

/* The line '-1' and the line with the number of the set; the line '-1' that closes it, and the status of all. */
void uff_put_open(struct uff_put *put, FILE *stream, int set);
int uff_put_close(struct uff_put *put);

/* To the right of `width` columns; ROTID_ERROR_ARGUMENT where it is wider. */
void uff_put_integer(struct uff_put *put, int width, long long value);
/* To the left of `width` columns; `fallback` where the text is empty. ROTID_ERROR_ARGUMENT where it is longer or has control
 * characters, which would break the line. */
void uff_put_text(struct uff_put *put, int width, const char *text, const char *fallback);

/* Writes the line without its trailing blanks. A line of '-1' alone, which readers take for the end of the set, is
 * ROTID_ERROR_ARGUMENT. */
void uff_put_line(struct uff_put *put);

/* Integers or reals, `per_line` a line. */
void uff_put_integers(struct uff_put *put, int width, int per_line, int count, const int *value);
void uff_put_reals(struct uff_put *put, int width, int decimals, int per_line, int count, const double *value);
/* A line with one text of up to 80 characters, NONE where it is empty: the format has no blank lines. */
void uff_put_text_line(struct uff_put *put, const char *text);

/* Lines of universal files with what stands in them, for both directions: which columns, and which member of the struct. From one
 * layout follow uff_read_record and uff_put_record. Internal to uff_*.c. */

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

/* By set and record. */
extern const struct uff_record uff_units_164, uff_node_15, uff_node_2411, uff_place_2411, uff_kind_55, uff_location_58,
    uff_form_58, uff_abscissa_58, uff_ordinate_58, uff_denominator_58, uff_z_axis_58;

/* The next line, or the one at hand, to the members of the struct `to`. */
int uff_read_record(struct uff_lines *lines, const struct uff_record *record, void *to);
int uff_take_record(struct uff_lines *lines, const struct uff_record *record, void *to);

/* Cuts the line at hand without a word: the member that is wrong, or -1; cells for messages. The members are set where none is.
 */
int uff_cut_members(const struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT],
                    void *to);

/* The members as a line. */
void uff_put_record(struct uff_put *put, const struct uff_record *record, const void *from);

/* The reader of a universal file from inside. Internal to uff_*.c. */

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
    size_t count, capacity;
};

/* Appends the nodes of the set at hand. */
int uff_append_nodes(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list);

/* Set 55 in two parts: to record 6, which describes the data; the rest, or nothing more. */
int uff_read_shape_kind(struct uff_reader *reader, struct uff_shape *shape);
int uff_read_shape_rest(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape);

/* From the end of the records of a 58b: how many bytes its data have. The number in the first line is wrong with some writers,
 * so the '-1' behind the data decides. `function` holds record 7, or has ordinate 0 when that is not known. Sets *bytes, and in
 * *x_size the size of an abscissa of double precision data, which is 4 by the format and 8 with some writers. */
int uff_measure_binary(struct uff_reader *reader, const struct uff_function *function, long long *bytes, int *x_size);

/* Record 7 of sets 58: the description of the values. Returns the cell that is wrong, or -1. */
int uff_cut_data_form(const struct uff_lines *lines, struct uff_cell cell[UFF_CELL_LIMIT], struct uff_function *function);

/* From the last value to behind the closing '-1'; blank lines may stand before it. */
int uff_close_values(struct uff_lines *lines, long long left_over);

/* Ids with their place in a list, to find those that occur twice. */
struct uff_label {
    int id, order;
};
struct uff_label_list {
    struct uff_label *item;
    size_t count, capacity;
};
int uff_add_label(struct pool *pool, struct uff_label_list *labels, int id); /* ROTID_OK or ROTID_ERROR_MEMORY */
void uff_sort_labels(struct uff_label_list *labels);                         /* by id and then by order */

/* The nodes of a file as one list. Internal to uff_*.c. */

#endif
