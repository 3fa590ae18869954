/* Results of the modal extraction: tables for a person, JSON for programs. */
#ifndef ROTID_REPORT_REPORT_EMA_H
#define ROTID_REPORT_REPORT_EMA_H

#include <stdio.h>

#include "base/message.h"
#include "ema/ema.h"
#include "import/measurement.h"
#include "report/json.h"

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
/* To be freed with json_free, or NULL where memory is out. */
char *json_ema(const struct provenance *provenance, const struct ema_report *report, const struct message_list *notes);

#endif
