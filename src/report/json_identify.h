/* Parts of a result that more than one command writes. */
#ifndef ROTID_REPORT_JSON_IDENTIFY_H
#define ROTID_REPORT_JSON_IDENTIFY_H

#include "result/json_tree.h"

/* What measured mode k says beside the frequency predicted for it. */
void json_measured_mode(struct json_tree *tree, cJSON *item, const struct job *job, const struct comparison *compared, int k,
                        double predicted);

/* Everything that `identify` says of a fit, status to seconds. result->fit is not NULL; it may have no parameters. */
void json_identification(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result);

#endif
