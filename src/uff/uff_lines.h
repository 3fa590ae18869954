/* Lines of a universal file, the bytes of its binary sets, and the numbers in its lines. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_LINES_H
#define ROTID_UFF_UFF_LINES_H

#include <stdio.h>

#include "base/message.h"
#include "uff/uff_read.h"

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

#endif
