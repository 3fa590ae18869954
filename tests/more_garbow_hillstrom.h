/* Test problems of J. J. More, B. S. Garbow, K. E. Hillstrom, Testing Unconstrained Optimization Software, ACM TOMS 7 (1981)
 * 17-41, from their printed definitions; the number in a comment is the problem's number there. */
/* Starts. MINPACK's lmder (scipy 1.17.1) reaches the minimum from all that are set but Kowalik-Osborne x10, and from one that is
 * not: Meyer x100, where rotid_lm has gone astray along the valley after 3000 iterations. From the others both end at another
 * minimum or at infinity. */
#ifndef ROTID_TESTS_MORE_GARBOW_HILLSTROM_H
#define ROTID_TESTS_MORE_GARBOW_HILLSTROM_H

#include "rotid.h"

#define MGH_MOST_RESIDUALS  65
#define MGH_MOST_PARAMETERS 11

struct mgh_problem {
    const char *name;
    int m, n;
    rotid_residual residual; /* with the analytic Jacobian; nonzero where a residual overflows */
    double start[MGH_MOST_PARAMETERS];
    double sum_of_squares; /* at the minimum, as printed, to six digits */
    int factors;           /* starts of 1, 10 and 100 times `start` from which it has to be reached: bits 0, 1 and 2 */
};

extern const struct mgh_problem mgh_problems[];
extern const int mgh_count;

#endif
