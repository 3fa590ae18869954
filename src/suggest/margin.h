/* What a test would say between rivals, before it is made.
 *
 * State 1 is what is measured, to which every rival is fitted: J_b1 there. Let rival a be true. State 2, the test, then gives
 * y = f_a(x_a) + J_a2 C_a^(1/2) eta + e, C_a = (J_a1'J_a1 + I)^-1 in relative parameters what state 1 leaves open, eta and e
 * standard normal. Rival b, fitted to both states, fails by min over h of |J_b1 h|^2 + |y - f_b(x_b) - J_b2 h|^2, its residuals
 * of state 1 being orthogonal to J_b1. With H_b = J_b1'J_b1 + J_b2'J_b2,   Q_b(z) = |z|^2 - (J_b2'z)' H_b^-1 (J_b2'z),   d_b =
 * f_b(x_b) - f_a(x_a) where scales of shapes are taken out of everything, that is Q_b(y - f_b), so the lead of a over b is M_b =
 * (score_b - score_a) + Q_b(w - d_b) - Q_a(w),   w = y - f_a(x_a). A name results where M_b exceeds what the decision asks for,
 * of every other rival at once. */
#ifndef ROTID_SUGGEST_MARGIN_H
#define ROTID_SUGGEST_MARGIN_H

#include "suggest/rivals.h"
#include "suggest/tests.h"

/* The best fit of rival b to both states without noise fails by distance [n] = Q_b(d_b), b = 0 ... n - 1 (0 for a itself), if
 * rival `truth` is true. *feasible 0: no such state, or modes that have no partner; distance is then not set. Statuses of memory
 * and cancellation only. */
int margin_distances(struct pool *pool, const struct rivals *rivals, const struct test *test, int truth, double *distance,
                     int *feasible);

/* All of it over `draws` of noise: fills chance, wrong and margins of *out (the lead expected is that of the formulas, the
 * chances are those of the draws), over the truths by their shares. *feasible likewise. */
int margin_judge(struct pool *pool, const struct rivals *rivals, const struct test *test, int draws, unsigned long seed,
                 rotid_suggested_test *out, int *feasible);

/* Whether a lead M [n] of rival `truth` over each other one names it: the last one is the model as it is. */
int margin_suffices(const struct rivals *rivals, int truth, const double *lead);

#endif
