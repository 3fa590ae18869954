/* Values of a JSON object that have to be there: a missing key fails the test by its name. */
#ifndef ROTID_TESTS_JSON_VALUE_H
#define ROTID_TESTS_JSON_VALUE_H

#include <cJSON.h>

const cJSON *get(const cJSON *json, const char *key);
/* It has to be a number. */
double number_of(const cJSON *json, const char *key);

#endif
