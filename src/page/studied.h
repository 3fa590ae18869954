/* What `rotid study` writes: the file of results, a line a run, or the summary of --json, which has the cells and no runs. */
#ifndef ROTID_PAGE_STUDIED_H
#define ROTID_PAGE_STUDIED_H

#include "result/place.h"
#include "result/study.h"

struct told_cell {
    struct study_cell_result is;
    const char *label;     /* what tells it from the others, "" where there is one */
    const char *but_modes; /* the same without its modes */
};

struct told_run {
    int cell, fitted; /* frequencies */
    int status;
    double objective;
    struct run_parameter *value; /* [nparameters of its cell], NULL of a run that failed; NaN where the run does not have it */
    int niterate;
    double *iterate; /* [nparameters of its cell * niterate], NULL where the plan had no starts */
};

struct study_outcome {
    struct study_result is;
    struct told_cell *cell; /* [is.ncells] */
    int nrun;               /* 0: a summary */
    struct told_run *run;
};

/* Whether the axes but that of the modes are the same. */
int study_same_but_modes(const struct study_axes *a, const struct study_axes *b);

/* A summary; NULL where something is wrong: reader->status tells. */
struct study_outcome *study_read(const struct json_place *root);
/* A file of results as the list of its lines, the header first. */
struct study_outcome *study_read_lines(const struct json_place *lines);

#endif
