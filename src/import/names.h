/* What the numbers of a universal file mean, in words. */
#ifndef ROTID_IMPORT_NAMES_H
#define ROTID_IMPORT_NAMES_H

#include "uff/uff_data.h"

/* Of a set; NULL for those that are not known. */
const char *name_of_set(int number);

/* Of a function type of set 58, one of them and several: "transfer function", "transfer functions". */
const char *name_of_function(int type, int plural);

/* Of an ordinate data type: "real single", ... */
const char *name_of_ordinate(int ordinate);

/* Of an analysis type of sets 55 and 2414. */
const char *name_of_analysis(int type);

/* Of a unit system of set 164: "SI (m, N)", ... */
const char *name_of_units(int code);

/* A degree of freedom as in "19:+X", "19" for a scalar, "19:-RZ" for a rotation. Returns buffer. */
#define PLACE_MOST 24
const char *place_text(int node, int direction, char buffer[PLACE_MOST]);

/* Whether the abscissa is time: by its data type or, where that says nothing, by the kind of function. */
int has_time_axis(const struct uff_function *function);

/* SI unit of a quantity (specific data type of set 58), "" where that is not known. */
const char *si_unit(int specific_type);

/* What a value in the unit that a text names must be multiplied with to be in that SI unit; 0 where the text is none of the usual
 * ones for the quantity. */
double unit_text_factor(int specific_type, const char *text);

#endif
