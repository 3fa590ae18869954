/* A file that rotid wrote with --json, read into plain structs. It is judged as a whole: what is wrong with it stands in the
 * messages with its place, before anything is written. */
#ifndef ROTID_PAGE_RESULT_H
#define ROTID_PAGE_RESULT_H

#include "page/diagnosis.h"
#include "page/fitted.h"
#include "page/geometry.h"
#include "page/outcomes.h"
#include "page/studied.h"
#include "result/transfer.h"
#include "run/sensitivity.h"

/* What an older result does not hold, and what is left out for it. */
struct lacking {
    const char *key, *shows; /* "geometry", "the drawing of the rotor" */
};
#define LACKING_MOST 16

struct reference_values { /* of the heading: "paper error_percent = ..." */
    const char *quantity;
    int count;
    double *value;
};

struct result {
    const char *file; /* as given */
    const char *command, *version, *commit, *blas, *deck;
    double seed;
    int threads; /* 0: not known */
    int nheading, nreference, nwarning, nlacking;
    const char **heading, **warning;
    struct reference_values *reference;
    struct lacking lacking[LACKING_MOST];
    double noise_frequency, noise_shape;  /* relative, typical of the data; NaN: not stated */
    int frequency_assumed, shape_assumed; /* by the diagnosis */
    const char *intervals_from;           /* "noise", "residuals", NULL: not said */

    struct geometry *geometry; /* NULL where the result has none */
    /* of the command that made it, the others NULL */
    struct fitted *identify;
    struct diagnosis_outcome *diagnosis;
    struct study_outcome *study;
    struct modes_outcome *modes;
    struct sensitivity *sensitivity;
    struct transfer_result *frf;
};

/* Reads a file. The structs hang on the pool. ROTID_OK; ROTID_ERROR_IO: it cannot be read; ROTID_ERROR_SYNTAX: no JSON, or not a
 * result that rotid makes pages of; ROTID_ERROR_MEMORY. The messages say what and where. */
int result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result);

/* Notes that a key is lacking which newer versions write. */
void result_lacks(struct result *result, const char *key, const char *shows);

/* The identification that the result is about: its own, or the model that a diagnosis judged; NULL: there is none. */
const struct fitted *result_fit(const struct result *result);

/* The values of a reference, or NULL. */
const struct reference_values *result_reference(const struct result *result, const char *quantity);

#endif
