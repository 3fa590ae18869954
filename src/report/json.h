/* Results as JSON: keys as in docs/schema. */
#ifndef ROTID_REPORT_JSON_H
#define ROTID_REPORT_JSON_H

#include "base/message.h"
#include "run/identify.h"
#include "run/job.h"
#include "run/sensitivity.h"

/* What stands at the head of every result. */
struct provenance {
    const char *command, *version, *commit, *blas;
    unsigned long seed;
    int threads;
};

/* Each returns a text to be freed with json_free, or NULL where memory is out. */
char *json_check(const struct provenance *provenance, const struct job *job, const struct mass_properties *mass,
                 const struct spectrum *spectrum, const struct message_list *notes);
char *json_modes(const struct provenance *provenance, const struct job *job, const struct spectrum *spectrum,
                 const struct comparison *compared, const struct message_list *notes);
char *json_sensitivity(const struct provenance *provenance, const struct job *job, const struct sensitivity *sensitivity);
char *json_identify(const struct provenance *provenance, const struct job *job, const struct identification *result,
                    const struct message_list *notes);
void json_free(char *text);

#endif
