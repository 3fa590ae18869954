/* Transfer functions of a model by superposition of its modes. With s = decay + i omega, phi mass-normalised, lambda = w^2,
 *
 *     H_ij(s) = s^q [ sum_r phi_ir phi_jr/(lambda_r + s^2 + 2 zeta_r w_r s) + R_ij + (c - s^2) R'_ij ],  q = 0, 1, 2
 *
 * for the displacement, velocity or acceleration at i per force at j. R and R' stand for the modes that are left out: value and
 * slope of their undamped sum at s^2 = c, exact there but for rounding, so that what is missing elsewhere is of the second order
 * in (s^2 - c)/lambda of the first mode left out. */
#ifndef ROTID_RUN_SYNTHESIS_H
#define ROTID_RUN_SYNTHESIS_H

#include "base/complex.h"
#include "base/pool.h"
#include "rotid.h"
#include "signal/frf.h"

#define SYNTHESIS_MOST_MODES 500 /* a rotor test sees ten; vectors of more take gigabytes */
#define SYNTHESIS_TOGETHER   16  /* functions that share the factor of a mode, which costs a division a line */

struct synthesis_pair {
    int response, reference; /* in: points, from 0 */
    double residual, slope;  /* out: R, R' [m/N], [s2 m/N] */
};

struct synthesis {
    int npoint, nmode, nrigid; /* modes, rigid and suspension modes first */
    double *lambda;            /* [nmode] (rad/s)^2, ascending */
    double *shape;             /* [nmode * npoint] the modes of a point beside each other, 1/sqrt(kg) */
    double shift;              /* c, the first elastic eigenvalue */
    int npair;
    struct synthesis_pair *pair; /* [npair] */
};

/* Modes of the full model at x [nparam] up to up_to_hz > 0, but not fewer than `least` where the model has them, and the
 * residuals of the pairs, whose points are degrees of freedom dof [npoint] of the model (distinct or not). ROTID_OK;
 * ROTID_ERROR_ARGUMENT where there are more than SYNTHESIS_MOST_MODES modes up to there; statuses of prediction_compute;
 * ROTID_ERROR_MEMORY. The solver's memory is given back. */
int synthesis_open(struct pool *pool, const rotid_model *model, const double *x, double up_to_hz, int least, int npoint,
                   const int *dof, int npair, struct synthesis_pair *pair, struct synthesis *s);

/* How H is to be evaluated. */
struct synthesis_lines {
    int nline;
    const double *frequency_hz; /* [nline] > 0 */
    enum frf_quantity quantity;
    double decay;         /* [1/s] of an exponential window on force and response; 0: none */
    int without_residual; /* nonzero: only the modes, to see the contribution of the rest */
};

/* h [nline * count] := pairs first ... first + count - 1. lambda [nmode] of the synthesis, or others in their place; zeta
 * [nmode] >= 0, zero only where no line lies on the mode; an eigenvalue not above zero counts as undamped. work [nline]. */
void synthesis_evaluate(const struct synthesis *s, const struct synthesis_lines *lines, const double *lambda, const double *zeta,
                        int first, int count, double complex *h, double complex *work);

#endif
