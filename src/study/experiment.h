/* The job of one run: the model that is fitted, with the data, the noise, the sensors and the start of this run. */
#ifndef ROTID_STUDY_EXPERIMENT_H
#define ROTID_STUDY_EXPERIMENT_H

#include "study/jobs.h"

struct experiment {
    struct states states;        /* with the data of this run; of a deck without *STATE one */
    struct job *job;             /* of the first */
    double *truth;               /* [states.nparameter] NaN where not known; NULL where the data are measured */
    const struct truth *made_by; /* [states.nstate] NULL where the data are measured; its effect or fault holds the values that
                                    were drawn, the same in all */
    double length;               /* of the rotor, in the first state [m] */
};

/* Everything hangs on the pool, or on *jobs until its next use. What is wrong goes to the list. Statuses of deck_read,
 * model_open and the prediction; ROTID_ERROR_ARGUMENT where the model has fewer modes than were measured. */
int experiment_make(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                    struct experiment *experiment);

/* The steps of it. */

/* The data of the job, which have their own arrays, become those of the model with the values drawn for a replicate, without
 * noise; shapes relative to their largest component. Values end in *truth. */
int experiment_model(struct pool *pool, const struct study *study, long replicate, struct truth *truth,
                     struct message_list *messages, struct job *job);
/* Adds noise to the data of state s, which has draws of its own, and states it. */
void experiment_noise(const struct study *study, const struct study_point *point, const struct truth *truth, int s,
                      struct job *job);
/* Leaves the sensors of this run. */
int experiment_sensors(struct pool *pool, const struct study *study, const struct study_point *point, const struct truth *truth,
                       struct job *job);

/* A fault of the measurement chain put into shapes or, with behind nonzero, what has to wait until their noise is there. */
void experiment_fault(const struct truth *truth, int behind, struct job *job);

#endif
