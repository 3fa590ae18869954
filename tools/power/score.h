/* A diagnosis beside the truth that tools/hide wrote: what was said right, what wrong, what was left open. */
#ifndef SCORE_H
#define SCORE_H

#include <cjson/cJSON.h>

#include "diagnose/diagnose.h"

enum hidden_class { HIDDEN_NOTHING, HIDDEN_PHYSICAL, HIDDEN_PAIR, HIDDEN_DATA, HIDDEN_NOISE, HIDDEN_OUTSIDE, HIDDEN_CLASSES };

enum hidden_outcome {
    HIDDEN_RIGHT,       /* named, and only what is true; a fault of the data found */
    HIDDEN_IN_SET,      /* ambiguous, and the truth is one of the set */
    HIDDEN_SILENT,      /* adequate */
    HIDDEN_UNEXPLAINED, /* something is wrong, no name for it */
    HIDDEN_OTHER_SET,   /* ambiguous, and the truth is none of the set */
    HIDDEN_WRONG,       /* a physical name that is not true; for faults of the data also another fault in place of the true one */
    HIDDEN_FAILED,      /* no diagnosis: see `failure` */
    HIDDEN_OUTCOMES
};

#define HIDDEN_NAME   64
#define HIDDEN_VALUES 12

enum hidden_of { HIDDEN_OF_MODEL, HIDDEN_OF_CAUSE, HIDDEN_OF_MIXTURE };

struct hidden_value {       /* a parameter with a stated 95 % interval */
    char name[HIDDEN_NAME]; /* "core.E", "stiffness_local.depth" */
    enum hidden_of of;      /* the model that was named right, its cause, or the average over all explanations, of every case */
    double truth, estimate, lower, upper;
    double known; /* of the average: half the interval where the true causes are known, NaN where they were not fitted */
};

struct hidden_score {
    enum hidden_class class;
    char id[HIDDEN_NAME];    /* of the first true effect; a kind outside by its name; "none" */
    char wrong[HIDDEN_NAME]; /* the first id that was named and is not true; "" */
    enum hidden_outcome outcome;
    int shapes;        /* were measured */
    int coloured;      /* noise correlated along the rotor */
    int reported;      /* anything but adequate */
    int names;         /* causes named */
    int truths, found; /* effects that are there; of these named or in the set */
    int nset;          /* members of the ambiguous set, 0 without one */
    int accused;       /* findings about the data that are not true */
    int channels;      /* of these such about sensors, not about numbers of modes or noise */
    double drop;       /* chi2 of the base model fitted to the data without their noise */
    double lesser;     /* two effects: the smaller drop of each of them alone; NaN elsewhere */
    double before; /* probability of what is listed before the first explanation with the truth in its stated places, 1: none */
    double margin; /* least chi2 of the other refitted candidates minus that of the true one; NaN where it was not refitted */
    double left;   /* outside the catalogue: chi2 of the best single cause for the data without noise; NaN elsewhere */
    double place_error, size_error; /* of the length, of the size; NaN unless named right and there is one */
    int nvalue;
    struct hidden_value value[HIDDEN_VALUES];
    double seconds; /* of the diagnosis */
    char failure[300];
};

const char *hidden_class_name(enum hidden_class class);
const char *hidden_outcome_name(enum hidden_outcome outcome);

int hidden_covers(const struct hidden_value *value); /* its interval holds the truth */

/* Compares the diagnosis of the job `read` with the truth; *score holds its neutral values (hidden_score_none) before. Fits the
 * base model, and outside the catalogue the best causes, to the data as they would be without noise. Statuses of these fits. */
int hidden_score_make(struct pool *pool, const struct diagnosis *diagnosis, const struct job *read, const cJSON *truth,
                      struct hidden_score *score);
struct hidden_score hidden_score_none(void);

/* The outcome alone, of physical effects. */
enum hidden_outcome hidden_outcome_of(const struct diagnosis *diagnosis, const cJSON *truth);

/* By how much the true effect leads every other candidate of its round, in the score of the decision; NaN where it was not
 * fitted. Of data without noise: below the margin of a name nobody could tell it apart. */
double hidden_lead(const struct diagnosis *diagnosis, const cJSON *truth);

/* The number of the true physical effect that a candidate is, or -1. */
int hidden_which(const struct job *job, const struct candidate *candidate, const cJSON *truth);

/* How many true effects are among the causes of an explanation, each in the places that are stated for it, where these span no
 * more than `widest` of the rotor: HIDDEN_PLACE tells a place, 1 is any. */
#define HIDDEN_PLACE 0.25
int hidden_truths(const struct diagnosis *diagnosis, const struct explanation *explanation, const cJSON *truth, double widest);

/* The drop of the data of `truth`, of the same rotor with the same noise and as many modes: NaN where
 * the fit fails. ROTID_OK or ROTID_ERROR_MEMORY. */
int hidden_drop(struct pool *pool, const struct diagnosis *diagnosis, const struct job *read, const cJSON *truth, double *drop);

#endif
