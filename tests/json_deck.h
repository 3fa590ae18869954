/* A deck given as text, and what the library and the tables of src/result make of it, read back. */
#ifndef ROTID_TESTS_JSON_DECK_H
#define ROTID_TESTS_JSON_DECK_H

#include "json_value.h"
#include "run/run.h"

struct json_deck {
    struct pool pool; /* for the test */
    rotid_deck *read;
    const struct job *job; /* of it */
    rotid_identification *result;
};

/* The deck is right: no error. To be closed. */
void json_deck_open(struct json_deck *deck, const char *text);
void json_deck_close(struct json_deck *deck);

/* What `check` and `identify` say; to be deleted. `baseline` as for rotid_identify; the identification stays in deck->result. */
cJSON *json_deck_check(struct json_deck *deck);
cJSON *json_deck_identify(struct json_deck *deck, int baseline);
/* That identification as JSON again; NULL where memory is out. To be freed. */
char *json_deck_text(const struct json_deck *deck);

/* Item `at` of a list of the object: it has to be there. */
const cJSON *json_member(const cJSON *object, const char *list, int at);
/* An array of `count` numbers; null becomes NaN. */
void json_numbers(const cJSON *array, int count, double *value);

#endif
