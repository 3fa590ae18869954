/* Comment lines of the files that are written: a description of the model in plain ASCII, each line begun by the mark of the
 * format. */
#ifndef ROTID_EXPORT_REMARK_H
#define ROTID_EXPORT_REMARK_H

#include <stdio.h>

#include "export/model.h"

struct remark {
    FILE *stream;
    const char *mark; /* "% " */
    int width;        /* of a line, mark included */
};

/* One remark, broken between words; other bytes than printable ASCII become '?', since readers of such files stop at other bytes.
 */
void remark_put(const struct remark *remark, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Deck, its heading, version, units, where the values come from, parameters, causes, mass, frequencies. */
void remark_model(const struct remark *remark, const struct export_model *model);

/* What it is condensed onto, and the frequencies then. */
void remark_condensed(const struct remark *remark, const struct export_model *model);

/* A name as one word: other characters than letters, digits and _ . - become '_'. */
void remark_word(FILE *stream, const char *name);

/* The shortest decimal number that is read back as the same double; text [32]. */
const char *remark_number(double value, char *text);

#endif
