/* The tables of the results of rotid.h. Their members, units and meaning stand there. */
#ifndef ROTID_RESULT_RECORDS_H
#define ROTID_RESULT_RECORDS_H

#include "result/head.h"
#include "result/record.h"

/* Words of several of them. */
extern const char *const functional_words[], *const reduction_words[], *const pairing_words[];

extern const struct record head_record;                 /* struct result_head */
extern const struct record geometry_record;             /* rotid_geometry */
extern const struct record sensor_record;               /* rotid_sensor */
extern const struct record check_record;                /* rotid_check */
extern const struct record spectrum_record;             /* rotid_spectrum */
extern const struct record identification_record;       /* rotid_identification as part of a diagnosis: without noise and geometry */
extern const struct record identification_alone_record; /* these two */
extern const struct record noise_record;                /* rotid_noise */
extern const struct record diagnosis_record;            /* rotid_diagnosis */

/* The i-th command whose results have a table; NULL behind the last. */
const char *result_command(int i);
/* The table of the results of a command, NULL where no result of the command has one. */
const struct record *result_record(const char *command);

#endif
