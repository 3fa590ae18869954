/* What a universal file holds: as tables, and as the struct of their JSON. */
#ifndef ROTID_REPORT_REPORT_UFF_H
#define ROTID_REPORT_REPORT_UFF_H

#include <stdio.h>

#include "base/message.h"
#include "import/import.h"

/* The summary, the sets, the doubtful places. all: each set a row; else those that are alike share one, at most about forty. */
void table_uff(FILE *out, const char *path, const struct listing *listing, int summary_count, const char *const *summary,
               int all);

/* all: with every node and every shape. messages: their errors. On the pool; NULL where memory is out. */
const struct uff_result *uff_result_of(struct pool *pool, const char *path, const struct listing *listing, int summary_count,
                                       const char *const *summary, int all, const struct message_list *messages);

#endif
