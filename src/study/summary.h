/* What a file of results says as a whole: for each cell how its runs ended, what they found and how far that is from the truth.
 */
#ifndef ROTID_STUDY_SUMMARY_H
#define ROTID_STUDY_SUMMARY_H

#include <stdio.h>

#include "report/json.h"
#include "study/header.h"
#include "study/score.h"

struct summary_parameter { /* over the runs that converged, at a bound or not */
    const char *name, *unit;
    long count;
    double mean, square, smallest, largest; /* square: sum of squared deviations from the mean */
    long stds;
    double std_sum; /* of those stated by the fits */
    long errors;
    double error_sum, error_square; /* value less truth */
    long intervals, covered;        /* those that hold the truth */
};

struct summary_objective { /* of one run */
    long replicate;
    double value; /* NaN where it did not converge */
};

struct summary_cause {
    const char *id;
    long runs; /* in which it was named */
};

struct summary_cell {
    const char *key; /* text of the cell in a line */
    const char *deck, *variant, *modes, *sensors, *hide;
    double noise_frequency, noise_shape; /* NaN where the plan has none */
    long first, runs, failed, converged, not_converged, at_bound, last_start;
    int nparameter;
    size_t parameter_room, objective_room, cause_room;
    struct summary_parameter *parameter;
    long fitted, held_out;                 /* frequencies */
    double fitted_square, held_out_square; /* [%^2] */
    long chi2s;
    double chi2_sum; /* of chi2 per degree of freedom */
    double evaluations, seconds;
    long nobjective;
    struct summary_objective *objective;
    long reached;                          /* runs that came to the best objective of their replicate */
    long judged, verdict[4], false_faults; /* diagnoses; by enum verdict_kind; faults of the data found and not hidden */
    long scored, score[SCORE_COUNT];
    int ncause;
    struct summary_cause *cause;
};

struct summary_error {
    const char *text;
    long runs, first;
};

struct summary {
    const char *path;
    struct header header;
    long wanted, there, failed; /* of the file's shard */
    double seconds;             /* of all runs together */
    int ncell, nerror;
    size_t cell_room, error_room;
    struct summary_cell *cell; /* in order of their first runs */
    struct summary_error *error;
};

/* Reads a file of results, finished or not. ROTID_OK; ROTID_ERROR_SYNTAX where it is something else, ROTID_ERROR_IO: the list
 * says so; ROTID_ERROR_MEMORY. */
int summary_read(struct pool *pool, const char *path, struct message_list *messages, struct summary *summary);

/* For a person. */
void summary_table(FILE *out, const struct summary *summary);

/* docs/schema/study.schema.json; to be freed with json_free, NULL where memory is out. */
char *summary_json(const struct provenance *provenance, const struct summary *summary);

/* What both show; NaN where there is nothing to say. */
double summary_std(const struct summary_parameter *parameter);
double summary_mean_std(const struct summary_parameter *parameter);
double summary_bias(const struct summary_parameter *parameter);
double summary_std_error(const struct summary_parameter *parameter); /* of value less truth, about its mean */
double summary_rms_error(const struct summary_parameter *parameter);
double summary_coverage(const struct summary_parameter *parameter);

#endif
