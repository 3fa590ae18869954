/* The head of every result: the program that wrote the result, and the input. */
#ifndef ROTID_RESULT_HEAD_H
#define ROTID_RESULT_HEAD_H

#include "rotid.h"

#define RESULT_SCHEMA 1 /* raised where a key is removed, or means something else */

struct result_head {
    int schema;          /* version of this schema */
    const char *rotid;   /* version of the program */
    const char *commit;  /* commit it was built from, or unknown */
    const char *blas;    /* what the BLAS library says of itself */
    double seed;         /* of random numbers, as given by --seed */
    int threads;         /* of the computation; of study: processes */
    const char *command; /* command that made the result */
    const char *deck;    /* path of the deck as given */
    int nheading;
    const char **heading; /* lines of *HEADING without the references */
    int nreferences;
    rotid_reference *references; /* values that the heading of the deck gives to compare with */
};

/* The reference of this quantity, or NULL. */
const rotid_reference *head_reference(const struct result_head *head, const char *quantity);
/* Value of the k-th mode in a reference; NaN where there is none, or reference is NULL. */
double reference_value(const rotid_reference *reference, int k);

#endif
