/* Results as JSON: keys as in docs/schema. */
#ifndef ROTID_REPORT_JSON_H
#define ROTID_REPORT_JSON_H

#include "base/message.h"
#include "run/job.h"
#include "run/sensitivity.h"

/* What stands at the head of every result. */
struct provenance {
    const char *command, *version, *commit, *blas;
    unsigned long seed;
    int threads;
};

/* A text to be freed with json_free, or NULL where memory is out. */
char *json_sensitivity(const struct provenance *provenance, const struct job *job, const struct sensitivity *sensitivity);

#endif
