/* The residuals of one structure in several states, each a model with measured modes of its own, over unknowns that the models
 * share: r = (r_1, r_2, ...), and dr/dx of a state stands in the columns of the unknowns that its model uses. */
#ifndef ROTID_MODAL_JOINT_H
#define ROTID_MODAL_JOINT_H

#include "modal/functional.h"

/* A state, as in rotid.h. */
struct joint_state {
    const rotid_model *model;
    const rotid_measured *measured;
    const int *parameter;
};

struct joint_part {
    struct functional functional;
    const int *parameter;
    double *x;        /* [nparam of the model] */
    double *jacobian; /* [nresidual * nparam] of the functional */
};

struct joint {
    int nstate, nparam, nresidual;
    int last;                /* state that was evaluated last: of a failure the one that failed */
    struct joint_part *part; /* [nstate] */
};

/* Which of the unknowns parameter q of a model is. */
int joint_unknown(const int *parameter, int q);

/* The unknowns that the states name are below nparam. Statuses of functional_new. */
int joint_new(struct pool *pool, int kind, int reduction, int derivative, int nparam, int nstate, const struct joint_state *state,
              struct joint *joint);

/* r [nresidual] at x [nparam]: state by state, as functional_residual has them. Allocates nothing. Statuses of that, of the first
 * state without a residual. */
int joint_residual(struct joint *joint, const double *x, double *r);

/* dr/dx [nresidual * nparam] at the x of the last joint_residual. Parameters of a model that are one unknown add up. */
int joint_jacobian(struct joint *joint, const double *x, double *jacobian);

#endif
