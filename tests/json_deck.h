/* A deck given as text, and what the writers of src/report make of it, read back. */
#ifndef ROTID_TESTS_JSON_DECK_H
#define ROTID_TESTS_JSON_DECK_H

#include "base/message.h"
#include "json_value.h"
#include "run/identify.h"

struct json_deck {
    struct pool pool;
    struct message_list messages;
    struct job job;
    struct identification result;
};

/* The deck is right: no error. To be closed. */
void json_deck_open(struct json_deck *deck, const char *text);
void json_deck_close(struct json_deck *deck);

/* What `check` and `identify` say; to be deleted. `baseline` as for identify_run; the identification stays in deck->result. */
cJSON *json_deck_check(struct json_deck *deck);
cJSON *json_deck_identify(struct json_deck *deck, int baseline);

/* Item `at` of a list of the object: it has to be there. */
const cJSON *json_member(const cJSON *object, const char *list, int at);
/* An array of `count` numbers; null becomes NaN. */
void json_numbers(const cJSON *array, int count, double *value);

#endif
