/* Causes in plain words, as far as this version's catalogue knows them. Texts are never NULL: where memory is out they are "". */
#ifndef ROTID_PAGE_CAUSE_WORDS_H
#define ROTID_PAGE_CAUSE_WORDS_H

#include "base/pool.h"
#include "rotid.h"

/* How to look for a cause: "weigh the part"; "" of one that is not in the catalogue. */
const char *cause_check(const char *id);
/* "stiffness of right", "joint between core and right", "added mass" */
const char *cause_name(struct pool *pool, const char *id, const char *target);
/* The same of a cause; of a suspicion the name that its card gives it. */
const char *cause_label(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause);
/* The same of a candidate: "joint between core and right with added mass" where two are tried at once. */
const char *candidate_words(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *candidate);
/* "mass 22.22 kg (95 %: 18.96 to 25.48), z 0.8983 m (95 %: 0.8886 to 0.9080)"; "" of one without values. */
const char *cause_values(struct pool *pool, const rotid_cause *cause);
/* "a zone softer than its surroundings (soft zone: depth 0.58, ...)", the values only where they are asked for. */
const char *cause_in_words(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause, int with_values);

/* What has no effect of a size, where that is not zero and sizes are told as they are: 90 degrees of a cone; NaN else. */
double cause_falls_from(const char *id);

/* The text with a large letter at its beginning. */
const char *words_sentence(struct pool *pool, const char *text);
/* "in fewer than 1 of 1,000", "in about 7 of 100": how often chance does it; "" where p is not known. */
const char *words_chance(struct pool *pool, double p);

#endif
