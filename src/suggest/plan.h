/* Before a test: what modes and sensors would say of the parameters, and where the sensors are to stand. */
#ifndef ROTID_SUGGEST_PLAN_H
#define ROTID_SUGGEST_PLAN_H

#include "run/job.h"
#include "suggest/design.h"

/* Where along the axis sensors could stand. */
struct places {
    int n;
    double *z;    /* [n] m, increasing */
    int *deck;    /* [n] nonzero where the deck has one */
    double apart; /* m: sensors that are added keep this distance */
};

struct plan_request {
    double frequency_std, shape_std; /* relative, of all modes */
    double wanted_percent;
    int sensors, modes; /* of a plan */
    int detect;         /* fill the detection limits as well */
    int threads, replicates;
    unsigned long seed;
    const rotid_environment *environment;
};

/* The nodes of the axis of the job's model, at most about a hundred, and its sensors. Statuses of model_open. */
int places_find(struct pool *pool, const struct job *job, struct places *places);

/* The columns of the job's parameters at x [nparameter], relative ones with a prior of 100 %, and as targets those of every cause
 * of the catalogue that has a derivative, times the size worth looking for; causes with a place at several. Modes are the first
 * `modes`. Statuses of columns_open and planned_measure. */
int plan_design(struct pool *pool, const struct job *job, const double *x, const struct places *places, int modes,
                double frequency_std, double shape_std, struct design *design);

/* Fills of *out what concerns plans: modes to detectable, and what is needed. *first [places->n]: those of the first plan.
 * Statuses of plan_design, ROTID_STOP_CANCELLED. */
int plan_run(struct pool *pool, const struct job *job, const double *x, const struct places *places,
             const struct plan_request *request, rotid_suggestion *out, int *first);

#endif
