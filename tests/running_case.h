/* A machine for tests: a deck of it, read, with its system at nominal values. */
#ifndef ROTID_TESTS_RUNNING_CASE_H
#define ROTID_TESTS_RUNNING_CASE_H

#include "running/running.h"

struct running_case {
    rotid_deck *deck;
    const struct machine *machine;
    const struct job *job;
    double *x;
    rotid_speeds speeds;
};

/* Reads the text and computes its speeds from 0 to `to` rpm in `count` of them; draws of bands. The status; the deck stays until
 * running_case_close. */
int running_case_open(const char *text, double to, int count, int draws, struct running_case *c);
/* The same of the deck that is open, with what a fit says of its unknowns. */
int running_case_run(struct running_case *c, const rotid_fit_result *fit, double to, int count, int draws);
void running_case_close(struct running_case *c);

/* The deck of a model of tests/data/running, NAME_model.csv, with every section in `elements`, with `more` behind it; on the test
 * pool. */
char *running_case_deck(const char *name, int elements, const char *more);

/* Frequency [Hz] and damping ratio of the index-th mode, from 1, at a speed of the Campbell diagram; NULL where there is none. */
const rotid_campbell_mode *running_case_mode(const struct running_case *c, double rpm, int index);

#endif
