/* What a universal file holds, as tables for a person. */
#ifndef ROTID_REPORT_TABLE_UFF_H
#define ROTID_REPORT_TABLE_UFF_H

#include <stdio.h>

#include "import/listing.h"

/* The summary, the sets, the doubtful places. all: each set a row; else those that are alike share one, at most about forty. */
void table_uff(FILE *out, const char *path, const struct listing *listing, int summary_count, const char *const *summary,
               int all);

#endif
