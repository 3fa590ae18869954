/* What the card FRF leaves open: lines, damping, and which lines belong to which mode. */
#ifndef ROTID_RUN_FRF_SETTLE_H
#define ROTID_RUN_FRF_SETTLE_H

#include "run/frf_run.h"

/* Lines, quantity and window: those of the measured set (NULL: none) within LOW and HIGH but a line at 0 Hz, else those of the
 * card, by default 1601 from half the lowest measured frequency to 1.1 times the highest. ROTID_OK, ROTID_ERROR_MEMORY,
 * ROTID_ERROR_ARGUMENT with an error in the list. */
int frf_choose_lines(struct pool *pool, const struct job *job, const struct frf_set *set, struct message_list *notes,
                     struct frf_result *out);

/* zeta, damping and moved_lambda of every mode of out->synthesis; compared NULL: nothing was measured. Statuses as above,
 * ARGUMENT where no ratio is known. */
int frf_choose_damping(struct pool *pool, const struct job *job, const struct comparison *compared, struct message_list *notes,
                       struct frf_result *out);

/* The elastic modes within the lines; every line belongs to one of them where there is one. ROTID_OK or ROTID_ERROR_MEMORY. */
int frf_make_bands(struct pool *pool, const struct job *job, const struct comparison *compared, struct frf_result *out);

#endif
