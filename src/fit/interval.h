/* What is said of the interval of a parameter: one rule for every command. */
#ifndef ROTID_FIT_INTERVAL_H
#define ROTID_FIT_INTERVAL_H

/* A parameter is determined where its fit says so (`identifiable`: the 95 % interval does not hold zero, and no combination that
 * the data leave open has a part of it; fit/covariance.h). One that is determined is wide where half of its interval is more than
 * this part of its value: it says little about a modulus. */
#define INTERVAL_WIDE 0.15
/* Of a value: a change that a linear calculation promises beyond it is only known to be large. */
#define LINEAR_MOST 0.5

/* Half of the interval in per cent of the value; NaN where there is none, or the value is 0. */
double interval_half_percent(double value, double lower, double upper);
/* Whether that is more than INTERVAL_WIDE; 0 where there is none. */
int interval_is_wide(double value, double lower, double upper);

/* "3.1 %", two digits, or as many as there are before the point. percent >= 0. Returns text. */
const char *percent_text(double percent, char text[32]);
/* "up to 3.1 %"; "more than 50 %" beyond LINEAR_MOST. */
const char *linear_percent_text(double percent, char text[32]);

#endif
