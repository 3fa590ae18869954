/* Tests that could be made next, and what each makes of a rotor. */
#ifndef ROTID_SUGGEST_TESTS_H
#define ROTID_SUGGEST_TESTS_H

#include "suggest/planned.h"

enum test_kind {
    TEST_AGAIN,
    TEST_MODES,   /* more of them */
    TEST_SENSORS, /* more of them */
    TEST_SHAPES,  /* where frequencies alone were measured */
    TEST_NOISE,   /* half of that of the shapes */
    TEST_MASS,
    TEST_STIFF, /* supports ten times as stiff */
    TEST_FREE,  /* hardly supported */
    TEST_MOVED, /* a support elsewhere */
};

struct test {
    enum test_kind kind;
    int modes;
    int *number;          /* [modes] */
    int nsensor;          /* 0: frequencies alone */
    const double *sensor; /* [nsensor] m, increasing */
    double frequency_std, shape_std;
    double mass, z;       /* kg, m: of the mass; z of the support that was moved */
    int spring;           /* that was moved */
    int setups, averages; /* averages: how often each point is measured */
    double *hz;           /* [modes] that the best rival expects, or NULL */
};

/* The i-th of them as a deck and a result know it: "again", "modes", ... */
const char *test_id(enum test_kind kind);
/* What to do, for a person. NULL where memory is out. */
const char *test_text(struct pool *pool, const struct job *job, const struct test *test);

/* *to := the job in the state of the test, without measurements, its sensors in place: parameters x [nparameter] become x_test
 * [nparameter] there, and own [nparameter] nonzero where a parameter has a value of its own in that state, which is not known:
 * the stiffness of a support that was changed. ROTID_OK or ROTID_ERROR_MEMORY. */
int test_apply(struct pool *pool, const struct test *test, const struct job *job, const double *x, struct job *to, double *x_test,
               int *own);

/* The factors of the supports in TEST_STIFF and TEST_FREE. */
#define TEST_STIFFER 10.0
#define TEST_SOFTER  1e-4

#endif
