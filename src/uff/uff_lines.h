/* Lines of a universal file and the numbers in them. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_LINES_H
#define ROTID_UFF_UFF_LINES_H

#include <stdio.h>

#include "base/message.h"

/* The formats stop at 80 columns; ID lines and free-format writers go beyond. */
#define UFF_LINE_LIMIT 4096
/* Numbers of one record. The formats allow 12; a record 7 may announce more, which are read over. */
#define UFF_VALUE_LIMIT 64

enum { UFF_END = 1 }; /* beside the statuses of rotid.h: the file ends */

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
};

/* Adds an error at the current line and returns ROTID_ERROR_SYNTAX. Column from 1, or 0. */
int uff_fail(struct uff_lines *lines, int column, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* A piece of the file fit for a message: shortened, what is not printable replaced. Returns buffer. */
#define UFF_EXCERPT 32
const char *uff_excerpt(const char *text, size_t length, char buffer[UFF_EXCERPT]);

/* The next line, of any kind: ROTID_OK, UFF_END or ROTID_ERROR_IO (in the message list). */
int uff_take_line(struct uff_lines *lines);

/* The next line of a set that is read: the end of the file and an overlong line are errors. `expected` is for the message. */
int uff_expect_line(struct uff_lines *lines, const char *expected);

/* Whether the current line is '-1' alone. With `strict`, in the columns 5 and 6 it belongs into. */
int uff_is_delimiter(const struct uff_lines *lines, int strict);

/* Reads over `count` bytes that are not lines. */
int uff_skip_bytes(struct uff_lines *lines, long long count);

/* The columns of a line: so many integers of that width, then so many reals of that width. */
struct uff_form {
    int integers, integer_width, reals, real_width;
};

/* The numbers of the current line, to integer [form->integers] and real [form->reals]. The line holds exactly those, separated
 * by blanks or else in the columns of the form. `what` names the record in messages. ROTID_OK or ROTID_ERROR_SYNTAX. */
int uff_parse_line(struct uff_lines *lines, const struct uff_form *form, const char *what, int *integer, double *real);

/* Reads lines until `count` reals are there, 6 columns of 13 a line; a free-format writer may put all that are left on one. */
int uff_read_reals(struct uff_lines *lines, int count, const char *what, double *real);

/* The same for integers, 8 columns of 10 a line, where the first line has been read already. */
int uff_read_integers(struct uff_lines *lines, int count, const char *what, int *integer);

/* Some integers of the current line whose other contents are not known yet: value[i] from column start[i] (from 0) of
 * width[i], or, unless every one of them is there, blank-separated field number field[i] (from 0). Nonzero when found. */
int uff_find_integers(const struct uff_lines *lines, int count, const int *start, const int *width, const int *field,
                      long long *value);

#endif
