/* What a line of results carries so that it can be told from a line that was changed or belongs elsewhere: which study it is of,
 * and a digest of everything before. One byte that is changed always changes the digest, more of them but once in 2^64. Against
 * accidents: whoever wants to forge a line can compute its digest. */
#ifndef ROTID_STUDY_STAMP_H
#define ROTID_STUDY_STAMP_H

#include <stddef.h>

#include "study/digest.h"
#include "study/header.h"

/* Of version and commit of the program, plan, decks, data, options, seed and number of runs: of all that the runs depend on. */
void stamp_study(const struct header *header, char study[DIGEST_LETTERS + 1]);

/* A line that json_close_line made, with its stamp behind the last value; to be freed, NULL where memory is out. */
char *stamp_line(const char study[DIGEST_LETTERS + 1], const char *line);

enum stamp_fault { STAMP_GOOD, STAMP_NONE, STAMP_CHANGED, STAMP_OTHER_STUDY };

/* line [length] with its line feed */
enum stamp_fault stamp_check(const char study[DIGEST_LETTERS + 1], const char *line, size_t length);

#endif
