/* Whether a line of JSON is a result. */
#ifndef ROTID_STUDY_LINE_WRONG_H
#define ROTID_STUDY_LINE_WRONG_H

#include <cJSON.h>

/* NULL where it is one; else what is wrong with it and what was expected, a constant. json: NULL where the line is no JSON. */
const char *line_wrong(const cJSON *json);

#endif
