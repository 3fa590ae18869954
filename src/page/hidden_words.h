/* What causes below their detection limits may do to parameters, in words. Texts are never NULL: where memory is out they are "".
 */
#ifndef ROTID_PAGE_HIDDEN_WORDS_H
#define ROTID_PAGE_HIDDEN_WORDS_H

#include "base/pool.h"
#include "rotid.h"

/* Of the parameters of the fit that some cause may move by more than half of their interval, the largest shift:
 * "core.E by up to 9.3 %, core.G by up to 7.9 %"; "" of none. */
const char *hidden_shifts_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden);
/* The same with the causes: "core.E by up to 9.3 % (tie_stiffness of ties)". */
const char *hidden_causes_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden);
/* Whether one of these shifts is as large as an interval that is called wide (fit/interval.h). */
int hidden_is_wide(const rotid_identification *fit, int count, const rotid_hidden *hidden);

#endif
