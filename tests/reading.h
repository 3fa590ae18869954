/* The states of a deck that a test has as a text. */
#ifndef ROTID_TESTS_READ_STATES_H
#define ROTID_TESTS_READ_STATES_H

#include "run/run.h"

/* Reads it by way of a file in the folder (folder.h) of the test program, into test_pool; a deck with an error fails the test. */
struct states read_states(const char *text);

#endif
