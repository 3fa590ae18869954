/* Words of results and of cards, in the order of the constants of rotid.h; NULL behind the last. */
#ifndef ROTID_RECORD_WORDS_H
#define ROTID_RECORD_WORDS_H

extern const char *const functional_words[], *const reduction_words[], *const derivative_words[], *const pairing_words[],
    *const fit_status_words[], *const verdict_words[];

#endif
