/* Whether a fit leaves no more than noise. */
#ifndef ROTID_DIAGNOSE_EXPLAINS_H
#define ROTID_DIAGNOSE_EXPLAINS_H

#include "diagnose/refit.h"

/* 1 where chi2 of the frequencies and the whole chi2 of the fit of a set are each passed by noise (BLOCK_LEVEL), with what its causes are
 * known to leave as approximations added to the noise. Sizes that the scan still would find do not count. */
int fit_explains(const struct refit *refit, const struct scan *scan, const struct scan_set *set, const int *holdout);

#endif
