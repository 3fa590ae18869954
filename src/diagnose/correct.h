/* A fault of the measurement chain, found and taken out of the judged data. */
#ifndef ROTID_DIAGNOSE_CORRECT_H
#define ROTID_DIAGNOSE_CORRECT_H

#include "diagnose/engine.h"

/* Adds the finding, and corrects the data by its cause; `found` needs neither name nor id. Statuses of correction_apply. */
int data_correct(struct engine *engine, const rotid_data_finding *finding, const struct correction *found);

/* Raises the noise of a block, "SHAPE" or "FREQUENCY", with a finding that says so. */
int data_correct_noise(struct engine *engine, const char *block, double factor, double std, const char *text);

#endif
