/* How well each kind of fault explains what one sensor reads, given the field that the other sensors predict. */
#ifndef ROTID_DIAGNOSE_SENSOR_EXPLAIN_H
#define ROTID_DIAGNOSE_SENSOR_EXPLAIN_H

#include "base/pool.h"
#include "diagnose/sensor_check.h"
#include "diagnose/sensor_field.h"

#define FAULT_KINDS 6

struct explanation {
    double drop;  /* twice the gain in log likelihood over a sound sensor; -INFINITY where the kind does not apply */
    double score; /* drop less what the search and the parameter cost */
    int other;
    double value, std;
};

struct sensor_likelihood { /* one sensor at a time */
    const struct sensor_field *field;
    int s;
    double sound;            /* log likelihood, no fault */
    double *others;          /* [ngrid * nmode] log likelihood of the other sensors */
    double *mean, *variance; /* [ngrid * nmode] of the deflection at its own place, predicted by them */
    int *wanted;             /* [ngrid * nmode] grid points that matter: the others' likelihood is not lost against the best */
    double *there_mean, *there_variance; /* elsewhere */
    double *vector;
};

/* ROTID_OK or ROTID_ERROR_MEMORY */
int likelihood_new(struct pool *pool, const struct sensor_field *field, struct sensor_likelihood *suspect);

/* Takes up sensor s, which is not masked. Returns an upper limit of `drop` of all kinds but swaps. */
double likelihood_open(struct sensor_likelihood *suspect, int s);

/* explanation [FAULT_KINDS] of the suspect; only swaps where `quick`; copies are no matter of likelihood. */
void likelihood_explain(struct sensor_likelihood *suspect, int quick, struct explanation *explanation);

#endif
