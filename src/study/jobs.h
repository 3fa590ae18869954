/* The jobs behind a run: the deck as it is to be fitted, and the deck that makes the data. */
#ifndef ROTID_STUDY_JOBS_H
#define ROTID_STUDY_JOBS_H

#include "diagnose/causes/cause.h"
#include "run/states.h"
#include "study/study.h"

/* The deck of a cell in its variant, with its modes; where it does not state the noise that the plan adds, and its functional
 * would be another one for that, or none, with that as *NOISE. Statuses of deck_read. */
int jobs_read_fitted(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                     struct states *states);

/* A state of a deck, or a deck that is one, as it stands, with a hidden effect. */
struct truth {
    struct job job;
    const struct cause_kind *cause; /* NULL: nothing is hidden */
    struct effect *effect;          /* of the job's rotor; NULL where the cause acts on the data */
    struct correction fault;        /* of such a cause */
    double lower[EFFECT_MOST_PARAMETERS], upper[EFFECT_MOST_PARAMETERS];
};

/* That of each state; what is hidden is in all. ROTID_ERROR_SYNTAX also where a range is upside down. */
int jobs_read_truth(struct pool *pool, const struct study *study, int deck, int hide_index, struct message_list *messages,
                    struct truth **truths);

/* The name of parameter p of a cause, physical or not; NULL behind the last. */
const struct effect_parameter_name *truth_parameter(const struct truth *truth, int p);

/* What one process works with: the jobs read last, since runs that follow each other mostly share them. */
struct jobs {
    const struct study *study;
    struct pool fitted_pool, truth_pool;
    struct study_cell fitted_of, truth_of;
    int has_fitted, has_truth; /* 1, or -1 where it could not be read: fitted_messages or truth_messages say why */
    struct states fitted;
    struct truth *truth; /* of each state */
    struct message_list fitted_messages, truth_messages;
};

void jobs_open(const struct study *study, struct jobs *jobs);
void jobs_close(struct jobs *jobs);

/* Pointers into *jobs, valid until the next call. Statuses as above; the messages say what is wrong. */
int jobs_fitted(struct jobs *jobs, const struct study_cell *cell, const struct states **states);
int jobs_truth(struct jobs *jobs, const struct study_cell *cell, struct truth **truth);

#endif
