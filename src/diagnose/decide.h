/* Which candidate is named, and why the others are not. */
#ifndef ROTID_DIAGNOSE_DECIDE_H
#define ROTID_DIAGNOSE_DECIDE_H

#include "diagnose/engine.h"

/* Penalty of a parameter in chi2. Two more of them, a place and a width, cost as much as the least margin: they let a zone follow
 * almost anything, and a cause without them is named where the zone fits no better. */
#define PARAMETER_PENALTY 3.0
/* Least margin of a name, in chi2 with those penalties: noise turns a rival into the better one by so much once in a hundred
 * times at most, however well it mimics (the difference of two fits at distance d is normal with mean d^2 and deviation 2 d). */
#define LEAST_MARGIN 6.0
/* Residuals more than parameters, that could still contradict a name: six frequencies carry one parameter. Twice as many where
 * the cause leaves more than noise: what else is there has parameters too, and with few residuals one cause imitates two. */
#define LEAST_RESIDUALS 3

/* The model before the round, as far as the candidates are compared with it. */
struct before {
    int dof, nfrequency;
    double chi2, chi2_frequency, holdout_rms, mode_out_rms, sensor_out_rms;
    double beyond_drop; /* of chi2, were its parameters free to pass the bounds they end at; 0 where none does */
};

double candidate_score(const struct candidate *candidate);

/* Whether the first causes of two candidates are one, at its target and in its state; and whether one of a set is that cause. */
int candidate_is(const struct candidate *a, const struct candidate *b);
int candidate_has(const struct candidate *set, const struct candidate *cause);

/* Sorts the candidates by their scores, gives every one that loses its reason, and the round its kind. The array of the
 * candidates has room for one more. */
int decide(const struct engine *engine, const struct before *before, struct diagnosis_round *round);

#endif
