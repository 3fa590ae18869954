/* Diagnosis of a job: what the model gets wrong, what causes it, the extended model, the gain, and what the data cannot tell.
 * Judged is always the full model by the likelihood; the FIT of the deck describes what the user does today. */
#ifndef ROTID_DIAGNOSE_DIAGNOSE_H
#define ROTID_DIAGNOSE_DIAGNOSE_H

#include "diagnose/causes/cause.h"
#include "run/identify.h"
#include "run/job.h"

#define DIAGNOSE_MOST_CAUSES 4 /* physical causes named one after the other */

struct diagnose_options {
    int threads;
    unsigned long seed;
    int replicates;             /* of the bootstrap; 0: 1000 */
    const char *before, *after; /* what changed between these two states, instead of what the model lacks in all; NULL */
};

/* A cause at one target (for those with a place: at its best place), with what became of it. Of two at once it is the first. */
struct candidate {
    rotid_candidate result; /* `cause` is put there at the end, from the following members up to the intervals */
    const struct cause_kind *cause;
    struct effect effect; /* at the best values found; effect.name is that of the card it would get */
    int state, home;      /* as in struct scan_candidate */
    const int *in;
    const char *state_name; /* of the one state in which it acts, NULL: in all that have its target */
    const char *target;     /* "core", "core|right", name of a spring or tie rod, "" */
    int nparameter;         /* of the effect, in use */
    int fixed[EFFECT_MOST_PARAMETERS];
    double std[EFFECT_MOST_PARAMETERS], ci_lower[EFFECT_MOST_PARAMETERS], ci_upper[EFFECT_MOST_PARAMETERS]; /* NaN: not stated */
    int refit;                      /* index of the fit in the round, -1 where there is none */
    double other_place, other_chi2; /* the best fit of it at quite another place, NaN where all starts led to one */
    int refused;                    /* for a reason of its own (no fit, physical bound, held-out modes), whatever the others do */
    int explains;                   /* its fit leaves no more than noise */
    int linear;                     /* chi2 and size are those of the scan: the model of the fit lacks part of the cause */
    const double *residual;         /* of its fit, while that is there; NULL */
    int nresidual;
    struct candidate *with; /* the second cause, NULL where this one is alone; the numbers of the fit are here */
    int set;                /* of an alternative, from 1: two of one number are the causes of a pair */
    int nidentified;        /* the deck's unknowns in its fit, of a pair the first member has them; 0: it has no fit */
    rotid_cause_value *identified;
};

struct diagnosis_round {
    rotid_round result;
    int ncandidate;
    struct candidate *candidate; /* best first; only those worth a line: refitted, or a visible share of the misfit */
};

struct diagnosis {
    rotid_diagnosis result;      /* as the steps find it; candidates, causes and the fits are put there at the end, from below */
    struct states given;         /* what was diagnosed, as it came: of what changed the second state, corrected */
    struct states judged;        /* the states that were judged: LIKELIHOOD, NONE, faults of the data taken out, noise as found */
    struct job job;              /* the first of them */
    int mesh_suffices;           /* the meshes of the deck do: the finer ones of the last fits move nothing that counts */
    struct identification today; /* by the FIT of the deck; fit NULL where it could not be made. Of several states this, base and
                                    extended are those of the first with the fit of all, and stand for all in what follows */
    struct identification base;
    struct identification *state_today, *state_base, *state_extended; /* [judged.nstate] of each, the fit as it sees it */
    int nround;
    struct diagnosis_round *round; /* the last one names nothing more */
    int ncause;
    struct candidate *cause; /* [ncause] as they stand in the final model */
    int nalternative;        /* ambiguous: the causes of candidates that cannot be told apart, best first */
    struct candidate *alternative;
    struct states extended_states;  /* without states where nothing was named */
    struct job extended_job;        /* the first of them */
    struct identification extended; /* the base again where nothing was named: fit NULL then */
};

/* Over all states of a deck. Everything hangs on the pool except the fits: diagnose_free. Notes go to the list. ROTID_OK;
 * ROTID_ERROR_ARGUMENT where the job has nothing that can be judged (the list says what and what was expected); any status of the
 * fits. An interruption by the environment is no error: what is finished stands in *out with `result.interrupted`. */
int diagnose_states(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_environment *environment, struct message_list *notes, struct diagnosis *out);
/* The same of a job, the only state. */
int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out);
void diagnose_free(struct diagnosis *out);

#endif
