/* One call of the first layer: the environment that its run sees, its notes, and why it failed. */
#ifndef ROTID_API_CALL_H
#define ROTID_API_CALL_H

#include <stdatomic.h>

#include "base/host.h"
#include "base/message.h"
#include "base/pool.h"
#include "rotid.h"

#define FAILURE_LENGTH 512 /* with the closing zero: of the header */

struct call {
    const rotid_environment *given; /* may be NULL */
    atomic_int cancelled;
    rotid_environment environment; /* of the run: once the host has said stop it is not asked, and told of nothing, again */
    struct pool scratch;           /* gone when the call returns */
    struct message_list notes;
    struct host host; /* as it was, while `entered` */
    int entered;
};

/* `result`: what the call is to set. ROTID_OK, with exceptions masked and the locale "C" until call_close; ROTID_ERROR_ARGUMENT
 * where it is NULL, ROTID_ERROR_MEMORY. To be closed in any case. */
int call_open(struct call *call, const rotid_environment *given, const void *result);
void call_close(struct call *call);

/* Writes into failure [FAILURE_LENGTH] (may be NULL) the errors among the notes, joined and cut off, the text of the status where
 * there are none, and nothing where it is ROTID_OK. */
void call_explain(const struct call *call, int status, char *failure);

#endif
