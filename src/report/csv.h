/* Results as tables for a spreadsheet: commas, a decimal point, names in the first row, which `FILE=` of a deck reads. */
#ifndef ROTID_REPORT_CSV_H
#define ROTID_REPORT_CSV_H

#include <stdio.h>

#include "base/message.h"
#include "run/job.h"
#include "uff/uff.h"

#define CSV_MOST_FILES 2

/* A file NAME.suffix; `from` is handed to `write`. */
struct csv_part {
    const char *suffix;
    int (*write)(FILE *out, const void *from); /* a status */
};

/* The modes of the model, and their shapes at the sensors. */
struct csv_spectrum {
    const rotid_spectrum *spectrum;
    const struct job *job;
};
extern const struct csv_part csv_spectrum_parts[CSV_MOST_FILES];

/* The parameters, and the modes, of a rotid_identification. */
extern const struct csv_part csv_identify_parts[CSV_MOST_FILES];

/* The modes of a universal file, and their shapes: real, in the one direction in which they move most. */
struct csv_universal {
    int count, nnode, direction; /* direction: of the values of a node, from 0 */
    int points;                  /* the file has frequencies at single points, which the tables do not have */
    const struct uff_shape **mode;
    int *number;           /* [count] */
    double *frequency_std; /* [count] Hz, NaN where it is not known */
    double *value, *std;   /* [nnode * count] a mode after the other; std relative to its largest value */
    struct uff_node *node; /* [nnode] by their ids; coordinates in the unit of the file, NaN where it has none */
};
extern const struct csv_part csv_universal_parts[CSV_MOST_FILES];

/* Reads modes and shapes. Errors go to the list. ROTID_OK, ROTID_ERROR_SYNTAX where the file has none, _IO, _MEMORY. */
int csv_universal_read(struct pool *pool, const char *path, struct message_list *messages, struct csv_universal *universal);

/* The files of path, all of them or none. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO with errno and the file in *failed. */
int csv_write(struct pool *pool, const char *path, const struct csv_part part[CSV_MOST_FILES], const void *from,
              const char **failed);
/* The name of a file of them; NULL where memory is out. */
const char *csv_path(struct pool *pool, const char *path, const struct csv_part *part);

/* Cells. A text is quoted where it has to be, and one that a spreadsheet would take for a formula gets an apostrophe in front; a
 * number has the digits that give it back, and is blank where it is not finite. `before`: "" or ",". */
void csv_text(FILE *out, const char *before, const char *text);
void csv_number(FILE *out, const char *before, double value);

#endif
