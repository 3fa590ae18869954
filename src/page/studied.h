/* What `rotid study` writes: the file of results, a line a run, or the summary of --json, which has the cells and no runs. */
#ifndef ROTID_PAGE_STUDIED_H
#define ROTID_PAGE_STUDIED_H

#include "result/place.h"

enum told_status { TOLD_CONVERGED, TOLD_AT_BOUND, TOLD_NOT_CONVERGED, TOLD_FAILED, TOLD_STATUSES };

#define TOLD_VERDICTS 4 /* adequate, named, ambiguous, unexplained */
#define TOLD_SCORES   8 /* quiet, false_alarm, right, in_set, other_set, silent, unexplained, wrong */
extern const char *const told_verdict_text[TOLD_VERDICTS], *const told_score_text[TOLD_SCORES];

struct cell_parameter { /* over the runs of a cell; NaN where there is nothing to say */
    const char *name, *unit;
    double count, mean, std, stated, bias, std_error, intervals, coverage;
};

struct told_cell {
    const char *deck, *variant, *modes, *sensors, *hide; /* NULL of an axis that the plan does not have, but for the deck */
    double noise_frequency, noise_shape;
    const char *label;     /* what tells it from the others, "" where there is one */
    const char *but_modes; /* the same without its modes */
    double runs, converged, at_bound, not_converged, failed, reached_best; /* NaN: one start each */
    double rms_percent, held_percent, evaluations;
    int nparameter;
    struct cell_parameter *parameter;
    double judged, verdict[TOLD_VERDICTS], false_findings;
    int scored;
    double score[TOLD_SCORES];
};

struct run_value { /* of a parameter of the cell; NaN where the run does not have it, or it is not stated */
    double value, start, std, ci[2], truth;
};

struct told_run {
    int cell, fitted; /* frequencies */
    enum told_status status;
    double objective;
    struct run_value *value; /* [nparameter of its cell], NULL of a run that failed */
    int niterate;
    double *iterate; /* [nparameter of its cell * niterate], NULL where the plan had no starts */
};

struct told_failure {
    const char *text;
    double runs;
};

struct study_outcome {
    const char *plan, *studies; /* plan NULL: decks were named */
    double wanted, done, failed, seconds;
    int ncell, nrun, nfailure; /* nrun 0: a summary */
    struct told_cell *cell;
    struct told_run *run;
    struct told_failure *failure;
};

/* Values of an axis: NULL and NaN, where there is none, are the same as themselves. */
int axis_same_text(const char *a, const char *b);
int axis_same_number(double a, double b);

/* A summary; NULL where something is wrong: reader->status tells. */
struct study_outcome *study_read(const struct json_place *root);
/* A file of results as the list of its lines, the header first. */
struct study_outcome *study_read_lines(const struct json_place *lines);

#endif
