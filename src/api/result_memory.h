/* Memory of a result of the first layer, and the copies that make the result independent of the deck and of the run. */
#ifndef ROTID_API_RESULT_MEMORY_H
#define ROTID_API_RESULT_MEMORY_H

#include "base/message.h"
#include "base/pool.h"
#include "rotid.h"

#define RESULT_MOST_FITS 3 /* a diagnosis has so many */

struct result_memory {
    struct pool pool; /* this struct is its first block */
    int nfit;
    rotid_fit_result *fit[RESULT_MOST_FITS]; /* freed with it */
    int missing;                             /* some room was not to be had */
};

/* NULL where memory is out. */
struct result_memory *result_memory_new(const rotid_environment *environment);
/* NULL is allowed. */
void result_memory_free(struct result_memory *memory);

/* Zeroed room; where memory is out NULL with `missing` set, so that many of them need one check. */
void *result_room(struct result_memory *memory, ptrdiff_t count, size_t size);
#define RESULT_NEW(memory, type) ((type *)result_room((memory), 1, sizeof(type)))
/* The list gets room for count elements. Its length: 0 where memory is out, so that a loop that fills it is safe. */
#define RESULT_LIST(memory, list, count) (((list) = result_room((memory), (count), sizeof *(list))) ? (int)(count) : 0)

/* A copy of count elements, NULL of NULL. */
void *result_copy(struct result_memory *memory, const void *source, ptrdiff_t count, size_t size);
#define RESULT_COPY(memory, source, count) result_copy((memory), (source), (count), sizeof *(source))

const char *result_text(struct result_memory *memory, const char *text);
/* The same with "" for NULL. */
const char *result_text_or_empty(struct result_memory *memory, const char *text);
const rotid_message *result_messages(struct result_memory *memory, const struct message_list *list);

#endif
