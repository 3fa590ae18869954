/* What of a result on the scratch of a call the host keeps. */
#ifndef ROTID_API_KEEP_H
#define ROTID_API_KEEP_H

#include "api/call.h"
#include "record/record.h"

/* A copy of the struct `made`, which `record` describes: it leans on nothing, and its member `memory`, of which the address in
 * `made` is given, is a pool of its own, for pool_free. NULL where memory is out, now or since the scratch was opened. */
void *call_keep(const struct call *call, const struct record *record, const void *made, void **memory);

#endif
