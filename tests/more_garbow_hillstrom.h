/* Test problems of J. J. More, B. S. Garbow, K. E. Hillstrom, Testing Unconstrained Optimization Software, ACM TOMS 7 (1981) 17-41,
 * from their printed definitions; the number in a comment is the problem's number there. */
#ifndef ROTID_TESTS_MORE_GARBOW_HILLSTROM_H
#define ROTID_TESTS_MORE_GARBOW_HILLSTROM_H

#include "rotid.h"

#define MGH_MOST_RESIDUALS 65
#define MGH_MOST_PARAMETERS 11

struct mgh_problem {
    const char *name;
    int m, n;
    rotid_residual residual; /* with the analytic Jacobian; nonzero where a residual overflows */
    double start[MGH_MOST_PARAMETERS];
    double sum_of_squares; /* at the minimum, as printed, to six digits */
    int factors;           /* starts of 1, 10 and 100 times `start` from which MINPACK's lmder reaches it: bits 0, 1 and 2 */
};

extern const struct mgh_problem mgh_problems[];
extern const int mgh_count;

#endif
