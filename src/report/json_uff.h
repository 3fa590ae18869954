/* What a universal file holds, as JSON: keys as in docs/schema/uff.schema.json. */
#ifndef ROTID_REPORT_JSON_UFF_H
#define ROTID_REPORT_JSON_UFF_H

#include "import/listing.h"
#include "report/json.h"

/* all: with every node and every shape. A text to be freed with json_free, or NULL where memory is out. */
char *json_uff(const struct provenance *provenance, const char *path, const struct listing *listing, int summary_count,
               const char *const *summary, int all, const struct message_list *messages);

#endif
