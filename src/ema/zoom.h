/* Stabilisation over the whole band and over parts of it: an order of 120 resolves a band into some hundred widths, and a mode a
 * thousandth of that wide comes out late or biased. Widths are proportional to frequency, and so are the parts. */
#ifndef ROTID_EMA_ZOOM_H
#define ROTID_EMA_ZOOM_H

#include "ema/stabilisation.h"

/* Octaves from the upper end down, of 150 to 5000 lines, 20 at most, each with a tenth more on both sides, of which only the
 * poles of its own middle and a fiftieth around it count; order 60 at most in each. *table: all poles, order by order; candidate
 * [*count] rising, found in one of them, once. options: complete. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int zoom_compute(struct pool *pool, const struct ema_band *band, double decay, const struct ema_options *options,
                 struct stabilisation *table, int *count, double complex **candidate);

#endif
