/* The tables of the results of rotid.h, where their members, units and meaning stand, of those of src/run, and of those of
 * this room. */
#ifndef ROTID_RESULT_RECORDS_H
#define ROTID_RESULT_RECORDS_H

#include "result/record.h"

/* Words of several of them. */
extern const char *const functional_words[], *const reduction_words[], *const pairing_words[];

extern const struct record geometry_record;             /* rotid_geometry */
extern const struct record sensor_record;               /* rotid_sensor */
extern const struct record check_record;                /* rotid_check */
extern const struct record spectrum_record;             /* rotid_spectrum */
extern const struct record identification_record;       /* rotid_identification as part of a diagnosis: without noise and geometry */
extern const struct record identification_alone_record; /* these two */
extern const struct record noise_record;                /* rotid_noise */
extern const struct record diagnosis_record;            /* rotid_diagnosis */

extern const struct record sensitivity_record;          /* struct sensitivity */
extern const struct record transfer_record;             /* struct transfer_result */

#endif
