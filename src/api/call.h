/* One call of the first layer: the environment that its run sees, its notes, and why it failed. */
#ifndef ROTID_API_CALL_H
#define ROTID_API_CALL_H

#include <stdatomic.h>

#include "base/entry.h"
#include "base/host.h"
#include "base/message.h"

struct call {
    struct entry entry; /* with the environment of the host, and the scratch */
    atomic_int cancelled;
    rotid_environment environment; /* of the run: once the host has said stop it is not asked, and told of nothing, again */
    struct message_list notes;     /* on the scratch */
    struct host_locale locale;     /* as it was, while `entered` */
    int entered;
};

/* `result`: what the call is to set; `name`: of that argument. ROTID_OK, with exceptions masked and the locale "C" until
 * call_close; ROTID_ERROR_ARGUMENT where it is NULL or the environment is none, ROTID_ERROR_MEMORY. To be closed in any case. */
int call_open(struct call *call, const rotid_environment *given, char *failure, const void *result, const char *name);

/* Leaves in the `failure` of the host the errors among the notes, joined and cut off, where nothing was said before. Returns
 * status. */
int call_close(struct call *call, int status);

#endif
