/* The diagnosis as JSON: keys as in docs/schema/diagnose.schema.json. */
#ifndef ROTID_REPORT_JSON_DIAGNOSE_H
#define ROTID_REPORT_JSON_DIAGNOSE_H

#include "diagnose/diagnose.h"
#include "result/json_tree.h"

/* deck: the job as the user states it, whose FIT `today` was fitted with. A text to be freed with json_free, or NULL where memory
 * is out. */
char *json_diagnose(const struct provenance *provenance, const struct job *deck, const struct diagnosis *diagnosis,
                    const struct message_list *notes);

/* "verdict", "rounds" and "candidates". */
void json_verdict(struct json_tree *tree, const struct diagnosis *diagnosis);
void json_rounds(struct json_tree *tree, const struct diagnosis *diagnosis);

#endif
