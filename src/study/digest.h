/* What tells whether two things mean the same: 64 bits of everything that is fed in. Comments, blanks and the places of files do
 * not count. Against accidents, not against malice. */
#ifndef ROTID_STUDY_DIGEST_H
#define ROTID_STUDY_DIGEST_H

#include <stdint.h>

#include "deck/deck_text.h"
#include "run/job.h"

#define DIGEST_LETTERS 16

struct digest {
    uint64_t state;
};

void digest_open(struct digest *digest);
void digest_bytes(struct digest *digest, size_t count, const void *bytes);
/* Numbers by their bits. */
void digest_integer(struct digest *digest, long long value);
/* Includes the terminating zero, so that "a", "bc" is not "ab", "c". NULL is not "". */
void digest_text(struct digest *digest, const char *text);
/* Names, options and data lines of the cards. */
void digest_cards(struct digest *digest, const struct deck_text *text);
/* What was measured, as the deck and its files say it. */
void digest_measured(struct digest *digest, const struct job *job);
/* Hexadecimal, with an end. */
void digest_letters(const struct digest *digest, char letters[DIGEST_LETTERS + 1]);

/* A number from a text, for streams of random numbers that have names. */
uint64_t digest_name(const char *name);

#endif
