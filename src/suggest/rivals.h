/* The explanations that a diagnosis cannot tell apart, each as a fitted model. */
#ifndef ROTID_SUGGEST_RIVALS_H
#define ROTID_SUGGEST_RIVALS_H

#include "diagnose/diagnose.h"

#define MOST_RIVALS 6 /* causes or pairs; the model as it is comes on top */
#define JUDGED      0.01 /* a misfit that noise exceeds less often is no noise */

struct rival {
    const char *label;
    int ncause;                    /* 0 of the model as it is, 2 of a pair */
    const struct candidate *cause; /* [ncause] */
    struct states states;          /* with its causes, at the best values */
    int home;                      /* the state that tests are made like */
    struct job job;                /* that one */
    const double *x;               /* [job.unknowns.nparameter] the fitted values that it has */
    rotid_fit_result *fit;         /* to what was measured in all states */
    double score, share;           /* as in rotid.h */
};

struct rivals {
    int n; /* best first; the last one is the model as it is */
    struct rival *rival;
    int home;           /* the state that tests are made like */
    int nmode;          /* its fitted ones */
    int *number;        /* [nmode] of the model */
    double margin;      /* lead over another rival that is needed for a name */
    double base_margin; /* the same over the model as it is */
    int left_out;       /* of the set: no causes of the rotor, as solids, or beyond the most */
    double among;       /* how likely the true one is one of them, by what is measured */
};

/* What a diagnosis leaves as alternatives, beside the causes that it names, each fitted anew: n is 0 where it leaves none that is
 * a model. The fits are to be freed with rivals_free. Statuses of the fits. */
int rivals_find(struct pool *pool, const struct diagnosis *d, const rotid_environment *environment, struct rivals *rivals);
/* The state that tests are made like: that of the most fitted data. */
int rivals_home(const struct states *states);
void rivals_free(struct rivals *rivals);

/* Which unknown of the state `home` unknown p of all is, -1: that state does not have it. */
int rival_own(const struct rival *rival, int p);

/* Whether parameter p of a rival, of those of all states, can follow new data: it is not pressed against a bound. */
int rival_uses(const struct rival *rival, int p);

/* gram [n * n] := J'J of its fit in the relative values of the n parameters that it uses; of those with own [fit->n] nonzero
 * (may be NULL) the unit matrix: 100 % is what is known of them. */
void rival_gram(const struct rival *rival, const int *own, int n, double *gram);

#endif
