/* The extended deck of a diagnosis: what was named is in it, the moduli stand at their fitted values, the verdict in its heading.
 */
#ifndef ROTID_DECK_DECK_EXTENDED_H
#define ROTID_DECK_DECK_EXTENDED_H

#include "base/pool.h"
#include "diagnose/diagnose.h"

/* The deck of a diagnosis that has a verdict (sentence), of the base model where nothing was named; from: path of the deck that
 * was diagnosed. ROTID_OK and *text on the pool; statuses of deck_write. */
int deck_write_extended(struct pool *pool, const struct diagnosis *diagnosis, const char *from, char **text);

#endif
