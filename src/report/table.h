/* Results as tables for a person. */
#ifndef ROTID_REPORT_TABLE_H
#define ROTID_REPORT_TABLE_H

#include <stdio.h>

#include "run/identify.h"
#include "run/job.h"
#include "run/sensitivity.h"

void table_heading(FILE *out, const struct job *job);
void table_notes(FILE *out, const struct message_list *notes);
void table_check(FILE *out, const struct job *job, const struct mass_properties *mass, const struct spectrum *spectrum);
/* shapes: with the shape of every mode at every sensor. */
void table_modes(FILE *out, const struct job *job, const struct spectrum *spectrum, const struct comparison *compared,
                 int shapes);
void table_sensitivity(FILE *out, const struct job *job, const struct sensitivity *result);
/* baseline: NLopt was asked for; history: with the iterations. */
void table_identify(FILE *out, const struct job *job, const struct identification *result, int baseline, int history);

#endif
