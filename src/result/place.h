/* Values of a JSON file together with the place where they stand, so that whatever is wrong with one is said with its path:
 * "result.json: modes[2].measured_hz: is a text, expected a number". What is wrong is collected in the messages; the routines
 * then return a neutral value, so that a reader goes on and all mistakes of a file are told at once. reader.status tells at the
 * end. */
#ifndef ROTID_RESULT_PLACE_H
#define ROTID_RESULT_PLACE_H

#include <cJSON.h>

#include "base/message.h"

struct reader {
    struct pool *pool;
    struct message_list *messages;
    const char *file; /* as the user names it */
    int status;       /* ROTID_OK so far, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY */
    int nwrong;       /* mistakes, of which no more than PLACE_MOST_WRONG are told */
};
#define PLACE_MOST_WRONG 20

struct json_place {
    struct reader *reader;
    const struct json_place *above; /* NULL: the whole file */
    const char *key;                /* in the object above, NULL: in an array */
    int index;                      /* in the array above */
    const cJSON *json;              /* NULL: not there */
};

enum place_kind { PLACE_NUMBER, PLACE_TEXT, PLACE_FLAG, PLACE_LIST, PLACE_OBJECT };

/* What is wrong at this place: the text goes on behind the path. */
void place_wrong(const struct json_place *at, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Whether the value is of the kind. If it is of another one that is told; null is let pass. */
int place_is(const struct json_place *at, enum place_kind kind);
/* Whether an object has the key at all. */
int place_has(const struct json_place *above, const char *key);

/* The value under a key of the object `above`, which stays alive as long as *at. 1, or 0 where it is not there: `find` takes a
 * missing key or null for that, `need` says that it is missing. A value of another kind is wrong for both. Of an object that is
 * not there nothing is there. */
int place_find(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at);
int place_need(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at);

/* A key that has to be there. null is NaN of a number, "" of a text, 0 of a flag. Texts are copies in the pool. */
double place_number(const struct json_place *above, const char *key);
const char *place_string(const struct json_place *above, const char *key);

/* The elements of a list: for (struct json_place item = place_first(&list, kind); item.json; item = place_next(&item, kind)).
 * Elements of another kind are wrong and passed over; null counts as one. */
struct json_place place_first(const struct json_place *list, enum place_kind kind);
struct json_place place_next(const struct json_place *item, enum place_kind kind);
int place_count(const struct json_place *list);
/* Rows of the same length as a column-major matrix (pool): 1, or 0 where it is not there or empty. expected: the rows and columns
 * there have to be, NULL: any number. */
int place_matrix(const struct json_place *above, const char *key, int need, const int expected[2], int *rows, int *columns,
                 double **value);

#endif
