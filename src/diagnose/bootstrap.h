/* How good the best of many looks by chance: a parametric bootstrap of the linearised scan. Each replicate is white noise on the
 * whitened residuals, taken orthogonal to what is fitted, and asks the same three questions of it as the diagnosis asks of the
 * data: the largest drop over all columns, the chi2 of the frequencies, the whole chi2. */
#ifndef ROTID_DIAGNOSE_BOOTSTRAP_H
#define ROTID_DIAGNOSE_BOOTSTRAP_H

#include "diagnose/scan.h"

#define FAMILY_WISE 0.03 /* false alarms of the three tests together */
#define BLOCK_LEVEL 0.01 /* of the frequency block and of the whole chi2 alone */

struct bootstrap {
    int replicates;
    double *largest;   /* [replicates] sorted, increasing: of the scan */
    double *frequency; /* [replicates] sorted */
    double threshold;  /* of the scan: with the two other tests it makes FAMILY_WISE */
    double p_scan, p_frequency, p_total;
};

/* The same numbers for any number of threads. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
int bootstrap_run(struct pool *pool, const struct scan *scan, int replicates, unsigned long seed, int threads,
                  const rotid_environment *environment, struct bootstrap *b);

/* Probability that the largest drop of a sound data set exceeds this one. */
double bootstrap_p(const struct bootstrap *b, double drop);

/* The threshold where the replicates are too few to show its tail: looks are taken for as many independent ones as make their 90
 * % quantile, whose share of replicates beyond it is that of FAMILY_WISE which the two other tests leave to the scan. */
double bootstrap_extrapolated(const struct bootstrap *b);

#endif
