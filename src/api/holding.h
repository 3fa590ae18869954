/* What a result of the first layer lives on, and the copies that make it independent of the deck and of the run. */
#ifndef ROTID_API_HOLDING_H
#define ROTID_API_HOLDING_H

#include "base/message.h"
#include "base/pool.h"
#include "rotid.h"

#define HOLDING_FITS 2 /* a diagnosis has two */

struct holding {
    struct pool pool;                    /* this struct is its first block */
    rotid_fit_result *fit[HOLDING_FITS]; /* NULL, or freed with it */
    int missing;                         /* a copy found no memory */
};

/* NULL where memory is out. */
struct holding *holding_new(const rotid_environment *environment);
/* NULL is allowed. */
void holding_free(struct holding *holding);

/* A copy of count elements, NULL of NULL; where memory is out NULL with `missing` set, so that many copies need one check. */
void *holding_copy(struct holding *holding, const void *source, ptrdiff_t count, size_t size);
#define HOLDING_COPY(holding, source, count) holding_copy((holding), (source), (count), sizeof *(source))

const char *holding_text(struct holding *holding, const char *text);
const rotid_parameter *holding_parameters(struct holding *holding, int count, const rotid_parameter *parameter);
const rotid_message *holding_messages(struct holding *holding, const struct message_list *list);

#endif
