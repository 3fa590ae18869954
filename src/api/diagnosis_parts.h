/* The lists of a diagnosis as the header shows them. */
#ifndef ROTID_API_DIAGNOSIS_PARTS_H
#define ROTID_API_DIAGNOSIS_PARTS_H

#include "api/holding.h"
#include "diagnose/diagnose.h"

/* Each returns NULL with `missing` set where memory is out; names and texts are copied. */
const rotid_cause *diagnosis_causes(struct holding *holding, int count, const struct candidate *candidate);
/* Of all rounds; *count: their number. */
const rotid_cause *diagnosis_candidates(struct holding *holding, const struct diagnosis *diagnosis, int *count);
const rotid_finding *diagnosis_data_findings(struct holding *holding, const struct diagnosis *diagnosis);
const rotid_finding *diagnosis_numerical_findings(struct holding *holding, const struct diagnosis *diagnosis);
const rotid_detectable *diagnosis_detectable(struct holding *holding, const struct diagnosis *diagnosis);

#endif
