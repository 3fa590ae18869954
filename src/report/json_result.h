/* A result with its head as JSON. */
#ifndef ROTID_REPORT_JSON_RESULT_H
#define ROTID_REPORT_JSON_RESULT_H

#include "report/json.h"
#include "result/result.h"

/* Head and warnings of the result from what the command has; job NULL: it reads no deck, notes NULL: it has no warnings. A text
 * to be freed with json_free, or NULL where memory is out. The pool, which holds parts of the result that were made for it, is
 * closed. */
char *json_result(struct pool *pool, const struct provenance *provenance, const struct job *job, const struct message_list *notes,
                  struct result *result);

#endif
