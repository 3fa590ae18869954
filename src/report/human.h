/* Numbers and units for people: "115.7 GPa", "-4.4 %" with a true minus sign. Texts are UTF-8 in the pool; where memory is out
 * they are "", and the pool's user notices at the next allocation that counts. */
#ifndef ROTID_REPORT_HUMAN_H
#define ROTID_REPORT_HUMAN_H

#include "base/pool.h"

/* The prefix a unit is read best with at a value: value in it = factor * value. Unit "1", which NULL stands for, and unknown ones
 * stay as they are. */
struct human_unit {
    double factor;
    char text[24]; /* "GPa", "kN/m"; "" for a pure number */
};
struct human_unit human_unit(double value, const char *unit);

/* Decimals that show three significant digits of `spread` (0 ... 8, of a value below 0.001 to 20); four significant digits of value where there is no spread.
 */
int human_decimals(double value, double spread);

/* With a number of decimals; "\u2013" where there is none (not finite). Below 0.001 with more than three decimals as 1.20e-5, with the
 * digits that the decimals show. Signed: a plus in front too. */
const char *human_fixed(struct pool *pool, double value, int decimals);
const char *human_signed(struct pool *pool, double value, int decimals);
/* With a number of significant digits; very large and small ones as 1.2e-7, as decks have them. */
const char *human_digits(struct pool *pool, double value, int digits);

/* The same without zeros at the end: "60" rather than "60.00". */
const char *human_trimmed(struct pool *pool, double value, int digits);

/* "115.7 GPa", "60 GPa": four significant digits without zeros at the end. */
const char *human_value(struct pool *pool, double value, const char *unit);
/* "115.7 GPa (95 %: 55.1 to 176.4)", without the bracket where there is no interval. */
const char *human_interval(struct pool *pool, double value, const double ci[2], const char *unit);
/* Half an interval in per cent of the value, NaN where there is none. */
double human_half_width_percent(double value, const double ci[2]);

/* "one", "two", ... "twelve", "13": for running text. */
const char *human_count(struct pool *pool, int count);
/* "iteration" or "iterations". */
const char *human_plural(int count, const char *one, const char *many);
/* "6 ms", "1.2 s", "3 min" */
const char *human_seconds(struct pool *pool, double seconds);

#endif
