/* Faults of channels and the level of the noise, taken out of the judged data. */
#ifndef ROTID_DIAGNOSE_CLEAN_H
#define ROTID_DIAGNOSE_CLEAN_H

#include "diagnose/engine.h"
#include "diagnose/scan.h"

/* After the base fit: faults of channels and the level of the noise, taken out of the judged data; *changed when there were any.
 */
int data_clean(struct engine *engine, const struct scan *scan, int *changed);
/* Noise that neighbouring sensors share looks like physics to the scan. r [nrow] is the residual that the best candidate leaves:
 * where its smooth part, or all of it, is still too large, the noise of the shapes is raised to that, and the round has to be
 * repeated. */
int data_colour(struct engine *engine, const struct scan *scan, const double *r, int *changed);

#endif
