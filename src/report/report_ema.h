/* Results of the modal extraction: as a table, and as the struct of their JSON. */
#ifndef ROTID_REPORT_REPORT_EMA_H
#define ROTID_REPORT_REPORT_EMA_H

#include <stdio.h>

#include "base/pool.h"
#include "ema/ema.h"
#include "import/import.h"

struct ema_report {
    const char *file;   /* that was read */
    const char *output; /* that was written, or NULL */
    const struct measurement *measurement;
    const struct ema_options *options;
    const struct ema *ema;
    double seconds;
};

/* Modes, quality flags, stabilisation table as a picture, MAC of the result with itself, worst channels. all: every pole, every
 * channel.
 */
void table_ema(FILE *out, const struct ema_report *report, int all);
/* On the pool; NULL where memory is out. */
const struct ema_result *ema_result_of(struct pool *pool, const struct ema_report *report);

#endif
