/* Stabilisation over the whole band, and where there are very many lines over parts of it too: an order of 120 resolves a band
 * into some hundred widths, and a mode a thousandth of that wide comes out late or biased. */
#ifndef ROTID_EMA_ZOOM_H
#define ROTID_EMA_ZOOM_H

#include "ema/stabilisation.h"

/* Parts of 4000 lines or more, 16 at most, each with a tenth more on both sides, of which only the poles of its own middle and a
 * fiftieth around it count; order 60 at most in each. *table: all poles, order by order; candidate [*count] rising, found in one
 * of them, once. options: complete. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int zoom_compute(struct pool *pool, const struct ema_band *band, double decay, const struct ema_options *options,
                 struct stabilisation *table, int *count, double complex **candidate);

#endif
