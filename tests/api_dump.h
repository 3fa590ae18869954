/* Results of the first layer as text, every number to its last bit: two results are equal where their texts are. Times apart. */
#ifndef ROTID_TESTS_API_DUMP_H
#define ROTID_TESTS_API_DUMP_H

#include "rotid.h"

/* To be freed. Threads may call them. */
char *dump_deck(const rotid_deck *deck);
char *dump_spectrum(const rotid_spectrum *spectrum);
char *dump_identification(const rotid_identification *identification);
char *dump_diagnosis(const rotid_diagnosis *diagnosis);

/* Fails with the first line that differs; frees `is`. */
void assert_dump(char *is, const char *expected);

#endif
