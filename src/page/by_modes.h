/* Runs of a study by the number of frequencies that were fitted, a series for each variant: what Figures 13 and 14 are made of.
 */
#ifndef ROTID_PAGE_BY_MODES_H
#define ROTID_PAGE_BY_MODES_H

#include "page/studied.h"

#define BY_MODES_SERIES 5

struct modes_point {
    int cell, fitted;  /* frequencies */
    double functional; /* mean over the runs, by the square of that number */
};

struct modes_series {
    const char *name; /* what tells it from the others */
    int count;
    struct modes_point *point; /* by rising number */
};

struct by_modes {
    int nseries, more; /* series there was no room for */
    struct modes_series series[BY_MODES_SERIES];
};

/* ROTID_OK or ROTID_ERROR_MEMORY; without a series where the study has no such axis, or no runs. */
int by_modes_make(struct pool *pool, const struct study_outcome *study, struct by_modes *by);

#endif
