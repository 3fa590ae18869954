/* Faults of channels as rivals of the physical causes: a sensor that looks wrong beside one model may be sound beside another. */
#ifndef ROTID_DIAGNOSE_FAULTS_H
#define ROTID_DIAGNOSE_FAULTS_H

#include "diagnose/round.h"

/* Behind the refits of a round, while nothing is named. The model without a cause and the best refits each say which channels they
 * find faulty, and are fitted again with these put right. The best of these explanations by score counts: its faults are taken out
 * of the judged data, each with a finding, if every explanation within the margin of a name has them too; *changed then, and the
 * round has to be repeated. A fault that stays open beside a physical cause goes to result->fault. */
int faults_settle(struct engine *engine, struct round_result *result, int *changed);

#endif
