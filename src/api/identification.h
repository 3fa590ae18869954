/* Identifications for hosts: alone, and as the base and the extended model of a diagnosis. */
#ifndef ROTID_API_IDENTIFICATION_H
#define ROTID_API_IDENTIFICATION_H

#include "api/holding.h"
#include "run/identify.h"

/* The result of a job as the header shows it, without messages and with `memory` NULL. The fit goes over to the holding as fit
 * `number`; it has left *found also where NULL is returned and `missing` set. */
rotid_identification *identification_new(struct holding *holding, int number, const struct job *job,
                                         struct identification *found);

#endif
