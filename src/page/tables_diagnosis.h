/* Tables of a diagnosis that stand open on the page. All in the pool, NULL where memory is out. */
#ifndef ROTID_PAGE_TABLES_DIAGNOSIS_H
#define ROTID_PAGE_TABLES_DIAGNOSIS_H

#include "page/figure.h"
#include "page/result.h"

/* Candidates of a round, from 0, each with what became of it. */
struct number_table *tables_candidates(struct pool *pool, const rotid_diagnosis *d, int round);
/* Fitted candidates: prediction errors on held-out data and the most similar candidate; their sizes and places. */
struct number_table *tables_candidate_quality(struct pool *pool, const rotid_diagnosis *d, int round);
struct number_table *tables_candidate_sizes(struct pool *pool, const rotid_diagnosis *d, int round);
/* Misfit of the model, and of the extended one beside it: fitted, held out, left out in turn. */
struct number_table *tables_quality(struct pool *pool, const rotid_diagnosis *d);
/* Smallest sizes that would have shown, and the causes of which no size would. */
struct number_table *tables_detection_limits(struct pool *pool, const rotid_diagnosis *d);
/* Errors of mesh and condensation, mode by mode. */
struct number_table *tables_numerical(struct pool *pool, const rotid_numerical_finding *finding);

#endif
