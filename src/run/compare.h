/* The measured modes of a job beside those of its model: the partner of each, and the modes without one. */
#ifndef ROTID_RUN_COMPARE_H
#define ROTID_RUN_COMPARE_H

#include "base/message.h"
#include "modal/pairing.h"
#include "run/job.h"
#include "run/spectrum.h"

struct comparison {
    int nmode;                 /* measured */
    int *number;               /* [nmode] mode of the model, from 1 */
    enum pairing_basis *basis; /* [nmode] */
    double *mac, *nco;         /* [nmode] with that partner, NaN without a shape */
    int clash;                 /* UNPAIRED: the measured mode whose number another one's shape claims */
};

/* Highest mode number of the measured modes, and the modes of the model that a comparison looks through. */
int comparison_highest(const struct job *job);
int comparison_candidates(const struct job *job);

/* Pairs by the shapes where they can tell, else by number. Notes say which modes look like no mode of the model, which modes of
 * the model nobody measured, and which pairings the shapes changed. ROTID_OK, MEMORY or UNPAIRED (two modes claim one partner;
 * the notes say which). */
int comparison_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, struct message_list *notes,
                    struct comparison *comparison);

/* Warns where the mesh moves a measured mode by more than the noise of its frequency, on a solid by more than a third: the
 * intervals rest on the noise alone. */
void comparison_warn_of_mesh(const struct job *job, const struct spectrum *spectrum, const struct comparison *comparison,
                             struct message_list *notes);

#endif
