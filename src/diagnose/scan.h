/* The scan: every cause at every target and place as a column of sensitivities, whitened and taken orthogonal to what is fitted
 * anyway, and the drop of chi2 that it promises, (c'r)^2/(c'c). Of several states the rows stand one state behind the other; a
 * cause acts in all states that have its target, or in one of them alone. */
#ifndef ROTID_DIAGNOSE_SCAN_H
#define ROTID_DIAGNOSE_SCAN_H

#include "diagnose/causes/cause.h"
#include "diagnose/columns.h"
#include "run/states.h"

struct scan_item { /* one column */
    int candidate;
    struct effect effect; /* neutral, at this place and width */
    double unit;          /* step of the size parameter that the column stands for: 1, or typical - neutral of a secant */
    int side;             /* sign the amplitude must have, 0: any */
    int usable;           /* the column is more than rounding once what is fitted is taken out */
    double norm;          /* of the projected column */
    double lower, upper;  /* of the amplitude, by physics */
    double amplitude, drop;
};

struct scan_candidate {     /* a cause at a target, with all its places */
    int state;              /* in this one alone, though others have the target too; -1: in all that have it */
    const char *state_name; /* of that one, or of the only one that has the target; NULL */
    int home;               /* the first state in which it acts */
    const int *in;          /* [nstate] nonzero: it acts there */
    const struct cause_kind *cause;
    struct effect effect; /* variant and target; a user's values where fixed */
    const char *target;
    int suspect, fixed[EFFECT_MOST_PARAMETERS];
    int first, count;         /* items */
    int best;                 /* item of the largest drop, -1: none is usable */
    double promise;           /* drop where there is no column */
    const struct effect *far; /* where a fit starts as well (far_starts.h), NULL */
};

struct scan {
    char *is_frequency;               /* [nrow] the row is that of a frequency: the first ones of each state */
    int nrow, nfrequency, nfree, dof; /* dof: rows less free parameters and scales */
    int nitem, ncandidate;
    struct scan_item *item;
    struct scan_candidate *candidate;
    double *column; /* [nrow * nitem] projected, of unit length; zero where not usable */
    int nbasis;
    double *basis; /* [nrow * nbasis] orthonormal: free parameters and scales */
    int *at;       /* [nfree] the column of the basis that a free parameter added; -1: it added none */
    double *along; /* [nfree * nfree] upper triangle: R of J = Q R, the columns of the free parameters in the basis */
    double *shift; /* [nfree * nitem] by how much the fit without the item moves each free parameter where the item is there with
                      an amplitude of 1: (J'J)^-1 J'c, J and c whitened and free of the scales; NaN where J does not have full
                      rank */
    double *r;     /* [nrow] residual, projected */
    double chi2, chi2_frequency;
    double largest; /* drop */
};

struct scan_set { /* one cause, or two at once: what a round fits */
    int count, candidate[2];
    int item[2]; /* of a pair: the columns that promise most together, with their amplitudes */
    double amplitude[2], drop;
    const double *x;        /* a pair found beside one of its causes: what the states' own parameters start at, else NULL */
    struct effect start[2]; /* and its causes */
};

/* The candidates: every physical cause of the catalogue at every target where it applies and is not in the model yet, and the
 * user's suspects; of several states then those of them in one state alone. */
int scan_list(struct pool *pool, const struct states *states, struct scan *scan);

/* A name for a CAUSE card that nothing in the rotor has: "joint", or "joint_2" where that is taken. NULL where memory is out. */
const char *scan_free_name(struct pool *pool, const struct rotor *rotor, const char *id);
const char *states_free_name(struct pool *pool, const struct states *states, const char *id); /* in none of these */

/* Whether what acts in the states a [nstate] and what acts in b are together in one of them. */
int states_meet(int nstate, const int *a, const int *b);

/* Whether the candidates a and b may be there together: the same cause at the same target needs two places. */
int scan_allows(const struct states *states, const struct scan *scan, int a, int b);

/* Columns and drops at the parameters x of the fitted states; number and holdout of all modes. Statuses of columns_open. */
int scan_run(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
             struct scan *scan);

/* Largest drop that a candidate promises, 0 where none of its columns is usable, or nobody asked. */
double scan_best_drop(const struct scan *scan, int candidate);

#endif
