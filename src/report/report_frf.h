/* Synthesised transfer functions beside measured ones: as tables with a plot, as the struct of their
 * JSON, as universal file. */
#ifndef ROTID_REPORT_REPORT_FRF_H
#define ROTID_REPORT_REPORT_FRF_H

#include <stdio.h>

#include "base/complex.h"
#include "result/head.h"
#include "run/frf_run.h"

struct frf_view {
    struct pool *pool; /* for curves, row by row */
    const char *state; /* NULL of a deck that is one */
    const struct job *job;
    const struct identification *identified; /* NULL: the model as the deck states it */
    const struct frf_set *set;               /* NULL: nothing measured beside */
    const struct frf_result *result;
    int verbose; /* every function a row */
};

/* Behind a heading. ROTID_OK or ROTID_ERROR_MEMORY. */
int table_frf(FILE *out, const struct frf_view *view);

/* The functions of JSON carry their curves up to this many lines of all of them together; more belong in a universal file. */
#define JSON_FRF_MOST_LINES 250000

/* On view->pool; NULL where memory is out. */
const struct transfer_result *frf_result_of(const struct frf_view *view);

/* Sets 151, 164 (SI), 2411 and a set 58 for each synthesised function. Statuses of uff_write.h, ROTID_ERROR_MEMORY. */
int frf_write_file(FILE *stream, const char *version, const struct frf_view *view);

/* Log magnitude over frequency, and phase below, on `columns` columns: '*' synthesised, 'o' measured (NULL where there is none),
 * '@' both. Of the lines that share a column the largest magnitude is drawn. */
void frf_plot(FILE *out, int columns, int nline, const double *frequency_hz, const double complex *synthesised,
              const double complex *measured);

#endif
