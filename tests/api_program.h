/* The program beside the library: what it prints as JSON, compared with a result. */
#ifndef ROTID_TESTS_API_PROGRAM_H
#define ROTID_TESTS_API_PROGRAM_H

#include "json_value.h"

/* What `rotid ARGUMENTS --quiet --json -` prints; the exit code has to be that of a result. */
cJSON *program_json(const char *arguments);

/* The value of the key, where null stands for what is not finite and for no text. */
void assert_json_number(const cJSON *json, const char *key, double value);
void assert_json_text(const cJSON *json, const char *key, const char *text);

#endif
