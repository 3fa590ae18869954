/* Identification of a job: pairing, fit, pairing again at the fitted model, and what the numbers are worth. */
#ifndef ROTID_RUN_IDENTIFY_H
#define ROTID_RUN_IDENTIFY_H

#include "run/compare.h"
#include "run/job.h"

struct identification {
    rotid_fit_result *fit;      /* to be freed with rotid_fit_free */
    struct comparison compared; /* at the fitted model */
    struct spectrum spectrum;   /* of the fitted model */
    int shapes_fitted;          /* they took part in the residual or in the quotient */
    struct mass_properties mass;
};

/* baseline: NLopt as well. Notes and reasons go to the list. Statuses of rotid_fit and of comparison_make, ROTID_ERROR_ARGUMENT
 * where the job has nothing to identify or nothing measured (the list says which). */
int identify_run(struct pool *pool, const struct job *job, int baseline, const rotid_environment *environment,
                 struct message_list *notes, struct identification *out);

#endif
