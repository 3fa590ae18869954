/* What to do next, in a sentence. */
#ifndef ROTID_SUGGEST_ADVICE_H
#define ROTID_SUGGEST_ADVICE_H

#include "suggest/suggest.h"

/* NULL where memory is out. */
const char *advice_sentence(struct pool *pool, const struct suggestion *suggestion);

#endif
