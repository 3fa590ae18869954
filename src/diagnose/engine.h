/* The state that the steps of a diagnosis share. */
#ifndef ROTID_DIAGNOSE_ENGINE_H
#define ROTID_DIAGNOSE_ENGINE_H

#include "diagnose/diagnose.h"
#include "diagnose/roving_accelerometer.h"
#include "diagnose/scan.h"

struct far_start; /* far_starts.h */

struct engine {
    struct pool *pool;
    int threads, replicates;
    unsigned long seed;
    const rotid_environment *environment;
    struct message_list *notes;
    const char *before, *after; /* the question is what changed between these states, or NULL */
    struct diagnosis *out;
    struct states states;                /* judged, with the causes named so far; their starts are the fitted values */
    struct job *job;                     /* of the state whose data are looked at, else of the first */
    const char *state;                   /* its name, NULL in a deck without *STATE */
    int nown;                            /* unknowns of the deck: the first ones of all */
    double *deck_start;                  /* [nown] */
    int *number, *holdout;               /* of the modes of all states */
    int nprepared;                       /* findings of the data before a model was looked at */
    int dropped;                         /* modes that nobody's shape fits and that were left out */
    struct job_measurement measured;     /* with them, where there are any */
    rotid_fit_result *fit;               /* of these states */
    double mode_out_rms, mode_out_shape; /* of them, NaN where unknown: modes left out in turn, percent and shape */
    int user_reduction;                  /* of the deck's own FIT */
    int coloured;                        /* the noise of the shapes was raised for its smooth part */
    struct roving_accelerometer moving;  /* the accelerometer by the frequencies at single sensors; usable 0 where it has none */
    int searched_far;                    /* far starts were looked for, once */
    const struct far_start *far;         /* the one that led farther than the others, NULL */
    double clock;
};

#define NUMERICAL_FINDINGS 2  /* of one state: its mesh, its condensation */
#define MOST_STEPS         64 /* that the time is counted for */

/* "density of core", "joint of core|right with density of core"; the user's own name where it is a suspect. NULL where memory is
 * out. */
const char *candidate_label(struct pool *pool, const struct candidate *candidate);

/* A candidate of which nothing is known yet: NaN where a number may be missing, refit -1. */
struct candidate candidate_blank(const struct cause_kind *cause, const char *target);

/* The states that are judged from here on, in an array of their own, or the only one. ROTID_OK or ROTID_ERROR_MEMORY. */
int engine_take_states(struct engine *engine, const struct states *states);
/* job and state := those of state s. */
void engine_look_at(struct engine *engine, int s);
void engine_take_job(struct engine *engine, const struct job *job);

/* Counts the time since the last call for a step. */
void engine_step(struct engine *engine, const char *name);
/* Says where the work is; ROTID_STOP_CANCELLED once the environment wants to stop. */
int engine_stage(const struct engine *engine, const char *stage, int step);

#endif
