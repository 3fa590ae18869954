/* The level of the noise of the shapes, by what the best model so far leaves of them. */
#ifndef ROTID_DIAGNOSE_NOISE_LEVEL_H
#define ROTID_DIAGNOSE_NOISE_LEVEL_H

#include "diagnose/engine.h"
#include "diagnose/scan.h"

/* r [nrow of the scan] is the residual that the best candidate leaves, or that of the base. Where the noise differs from the
 * stated one beyond chance, or neighbouring sensors share it, which looks like physics to the scan, the judged data get the level
 * that is there, with a finding: the round has to be repeated, *changed. Behind the fits: the second-order part of a large effect
 * looks like noise. */
int noise_settle(struct engine *engine, const struct scan *scan, const double *r, int *changed);

#endif
