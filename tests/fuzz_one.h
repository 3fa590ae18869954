/* One input of a fuzzer, also run as a test over the corpus in tests/fuzz/corpus: whatever the bytes are, the readers return a
 * status, and an error message exactly when it is an error; else they abort. */
#ifndef ROTID_TESTS_FUZZ_ONE_H
#define ROTID_TESTS_FUZZ_ONE_H

#include <stddef.h>
#include <stdint.h>

void fuzz_one_uff(const uint8_t *bytes, size_t count);    /* a universal file: by the streaming reader and by uff_read */
void fuzz_one_import(const uint8_t *bytes, size_t count); /* the same as what `uff` lists and as what `ema` and `frf` measure */
void fuzz_one_deck(const uint8_t *bytes, size_t count);   /* a deck */
void fuzz_one_table(const uint8_t *bytes, size_t count);  /* a table that cards of a deck name */
/* what to measure next: options by the first bytes, the rest is a deck */
void fuzz_one_suggest(const uint8_t *bytes, size_t count);
void fuzz_one_plan(const uint8_t *bytes, size_t count);    /* a plan, without its decks */
void fuzz_one_results(const uint8_t *bytes, size_t count); /* a file of results: its lines, and its summary */

#endif
