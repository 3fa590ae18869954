/* Lines of a universal file under construction, column by column. Internal to uff_write*.c. */
#ifndef ROTID_UFF_UFF_PUT_H
#define ROTID_UFF_UFF_PUT_H

#include <stddef.h>
#include <stdio.h>

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
/* 1PEw.d: `decimals` behind the point, one digit before it. The exponent letter is E also where the format says D: every reader
 * of Fortran takes it, and those written in C take nothing else. ROTID_ERROR_ARGUMENT for a value that is not finite. */
void uff_put_real(struct uff_put *put, int width, int decimals, double value);
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

#endif
