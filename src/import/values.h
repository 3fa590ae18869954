/* The values of a function in a few numbers, gathered piece by piece. */
#ifndef ROTID_IMPORT_VALUES_H
#define ROTID_IMPORT_VALUES_H

#include <stdint.h>

/* Of complex values `min` and `max` are those of the modulus. Without any, all are zero. */
struct values {
    long long count;
    double first[2], last[2], sum[2]; /* real and imaginary part */
    double min, max, rms;             /* rms = sqrt(sum |y|^2 / count) */
    double x_first, x_last, x_least_step, x_most_step;
    int is_constant;        /* all values are equal */
    long long plateau[2];   /* most values in a row that equal the least and the greatest of real data */
    double plateau_jump[2]; /* from the value before that row to it */
    uint64_t hash;          /* of all values, bit by bit */
    double scale, squares;  /* sum |y|^2 = scale^2 squares, which does not overflow */
    long long run[2];
    double before; /* the value before the last */
};

void values_open(struct values *values);
/* count values, all finite: abscissa x, real and imaginary part (imag: of complex ones). */
void values_add(struct values *values, long long count, const double *x, const double *real, const double *imag, int is_complex);
void values_close(struct values *values);

/* Whether a record of a time signal stopped at the limit of its converter: the greatest or the least value stands there at least
 * three times in a row, and the signal was on its way when it got there. */
int values_are_clipped(const struct values *values);

/* Whether two functions have the same values, all of them. */
int values_are_same(const struct values *a, const struct values *b);

#endif
