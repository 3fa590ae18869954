/* What every public routine that returns a status does first and last. */
#ifndef ROTID_BASE_ENTRY_H
#define ROTID_BASE_ENTRY_H

#include <fenv.h>

#include "base/failure.h"
#include "base/pool.h"
#include "rotid.h"

struct entry {
    fenv_t floating;               /* of the host */
    char *failure;                 /* [ROTID_FAILURE_LENGTH] or NULL */
    rotid_environment environment; /* of the host, of this library's size; zeros where there is none */
    struct pool scratch;           /* gone when the call returns */
};

/* Masks floating-point exceptions, takes the environment (NULL is allowed), opens the scratch on its allocator. ROTID_OK, or
 * ROTID_ERROR_ARGUMENT where the environment is none, its allocator incomplete. To be closed in any case. */
int entry_open(struct entry *entry, const rotid_environment *environment, char *failure);

/* Leaves in failure why the status is an error, the text of the status where nobody has said more, and nothing where it is none.
 * Traps, flags and rounding are the host's again. Returns status. */
int entry_close(struct entry *entry, int status);

#endif
