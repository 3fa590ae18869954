/* Test problems of J. J. More, B. S. Garbow, K. E. Hillstrom, Testing Unconstrained Optimization Software, ACM TOMS 7 (1981)
 * 17-41, from their printed definitions, with 1, 10 and 100 times their standard starts as there. */
#ifndef ROTID_TESTS_MORE_GARBOW_HILLSTROM_H
#define ROTID_TESTS_MORE_GARBOW_HILLSTROM_H

#include "rotid.h"

#define MGH_MOST_RESIDUALS  99
#define MGH_MOST_PARAMETERS 40
#define MGH_MOST_MINIMA     2

struct mgh_problem {
    const char *name;
    int m, n;
    rotid_residual residual; /* with the analytic Jacobian; nonzero where a residual overflows */
    double start[11];
    int given;                       /* n; or 1: start[0] is that of all variables; or 0: x_j = j/(n + 1), j = 1 ... n */
    double minimum[MGH_MOST_MINIMA]; /* sums of squares, to six digits; the one that a standard start leads to first */
    int nminimum;
    int lmder[3]; /* evaluations of r in which MINPACK's lmder reaches one of them from 1, 10 and 100 times the start; 0: none of
                     them in 2000 (libcminpack 1.3.6, ftol = xtol = 1e-12, gtol = 0, factor = 100; tests/peers/minpack_peer.c) */
    double ends[3]; /* where it reaches none: the sum it ends at, NAN where that is anywhere */
};

extern const struct mgh_problem mgh_problems[];
extern const int mgh_count;
extern const double mgh_factors[3]; /* 1, 10, 100 */

/* x [n] := factor times the standard start; where that is zero, `factor` itself from 10 on, as in the tests of MINPACK. */
void mgh_start(const struct mgh_problem *problem, double factor, double *x);

/* The known minimum that a sum of squares has reached, an index, or -1: within 1e-5 of one, the printed ones having six digits;
 * where that is zero, less than 1e-22 of the sum at the standard start. */
int mgh_reached(const struct mgh_problem *problem, double sum_of_squares);

#endif
