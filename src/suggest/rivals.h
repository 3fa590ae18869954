/* The explanations that a diagnosis cannot tell apart, each as a fitted model. */
#ifndef ROTID_SUGGEST_RIVALS_H
#define ROTID_SUGGEST_RIVALS_H

#include "diagnose/diagnose.h"

#define MOST_RIVALS 6 /* causes or pairs; the model as it is comes on top */

struct rival {
    const char *label;
    int ncause;                    /* 0 of the model as it is, 2 of a pair */
    const struct candidate *cause; /* [ncause] */
    struct job job;                /* with its causes, at the best values */
    rotid_fit_result *fit;         /* to what was measured */
    double score, share;           /* as in rotid.h */
};

struct rivals {
    int n; /* best first; the last one is the model as it is */
    struct rival *rival;
    int nmode;          /* fitted ones */
    int *number;        /* [nmode] of the model */
    double margin;      /* lead over another rival that is needed for a name */
    double base_margin; /* the same over the model as it is */
    int left_out;       /* of the set: no causes of the rotor, as solids, or beyond the most */
};

/* What a diagnosis leaves as alternatives, beside the causes that it names, each fitted anew: n is 0 where it leaves none that is
 * a model. The fits are to be freed with rivals_free. Statuses of the fits. */
int rivals_find(struct pool *pool, const struct diagnosis *d, const rotid_environment *environment, struct rivals *rivals);
void rivals_free(struct rivals *rivals);

/* Whether parameter p of a rival can follow new data: it is not pressed against a bound. */
int rival_uses(const struct rival *rival, int p);

/* gram [n * n] := J'J of its fit in the relative values of the n parameters that it uses; of those with own [nparameter] nonzero
 * (may be NULL) the unit matrix: 100 % is what is known of them. */
void rival_gram(const struct rival *rival, const int *own, int n, double *gram);

#endif
