/* Charts of one line in plain ASCII: a signed bar, and strips along the axis of the rotor. */
#ifndef ROTID_REPORT_CHART_H
#define ROTID_REPORT_CHART_H

#include <stdio.h>

#include "rotid.h"

/* A bar of 2 half + 1 columns around '|' that reaches the end at +-scale; '>' or '<' at the end beyond that. */
void chart_bar(FILE *out, int half, double scale, double value);

#define STRIP_MOST 120

struct strip {
    double length; /* of the axis [m], begins at 0 */
    int columns;
    char line[STRIP_MOST + 1];
    const char *letter[STRIP_MOST]; /* of columns that no char holds, in the labels, which are the caller's */
};

void strip_open(struct strip *strip, double length, int columns);
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

#endif
