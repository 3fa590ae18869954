/* A fault of a channel, as a sentence and as the card that puts it right. */
#ifndef ROTID_DIAGNOSE_FAULT_TEXT_H
#define ROTID_DIAGNOSE_FAULT_TEXT_H

#include "diagnose/line_check.h"
#include "diagnose/sensor_check.h"
#include "run/job.h"

/* id [nsensor]: of the sensors when the fault was found. ROTID_OK or ROTID_ERROR_MEMORY. */
int fault_finding(struct pool *pool, const struct sensor_fault *fault, const int *id, rotid_data_finding *finding);
/* "sensor 7", "sensors 7,8"; NULL where memory is out. */
const char *fault_target(struct pool *pool, const rotid_data_finding *finding);
/* Without a name; of a dead channel there is none: nothing could be put right. */
struct correction fault_correction(const struct sensor_fault *fault, const int *id);

/* The same of all positions at once: the finding with its sizes, and the card. */
int line_finding(struct pool *pool, const struct line_fault *fault, rotid_data_finding *finding);
struct correction line_correction(const struct sensor_line *line);

#endif
