/* One round of scan, refit, comparison and decision. */
#ifndef ROTID_DIAGNOSE_ROUND_H
#define ROTID_DIAGNOSE_ROUND_H

#include "diagnose/bootstrap.h"
#include "diagnose/engine.h"
#include "diagnose/refit.h"
#include "diagnose/scan.h"

struct round_result {
    struct scan scan;
    struct bootstrap bootstrap;
    int nrefit;
    struct refit *refit;     /* [nrefit] */
    struct scan_set *set;    /* [nrefit] what was fitted: single causes first, then pairs */
    struct candidate *fault; /* of a channel, which stays open beside physical causes; NULL: none */
};

/* Settles the data beside the fits of the first round of a job that is the only state: pairing, channels, noise. Statuses of the
 * fits. */
int round_settle(struct engine *engine);
/* The fits of a round without what they say: kind is ROTID_ADEQUATE, or -1. */
int round_fit(struct engine *engine, struct diagnosis_round *round, struct round_result *result);
/* A round. The data of several states are settled before. */
int round_run(struct engine *engine, struct diagnosis_round *round, struct round_result *result);
void round_free(struct round_result *result);

#endif
