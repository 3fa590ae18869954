/* What each fit says about its candidate, and how well it predicts what was left out. */
#ifndef ROTID_DIAGNOSE_EVIDENCE_H
#define ROTID_DIAGNOSE_EVIDENCE_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* 1 where noise reaches chi2 of the frequencies and the whole chi2 of the fit, each (BLOCK_LEVEL). What the scan still would find
 * does not count. */
int fit_explains(const struct scan *scan, const rotid_fit_result *fit);
/* Fills the round's candidates from the refits and lets decide() judge them. */
int evidence_collect(struct engine *engine, struct round_result *result, struct diagnosis_round *round);
/* Prediction of modes left out in turn, for several models at once: error [models] in percent, shape [models]. */
int modes_in_turn(const struct engine *engine, int models, const struct states *const *model, double *error, double *shape);

#endif
