/* The first line of a file of results: which study it is of. */
#ifndef ROTID_STUDY_HEADER_H
#define ROTID_STUDY_HEADER_H

#include <cJSON.h>

#include "base/pool.h"
#include "study/study.h"

struct header {
    const char *version, *commit; /* of the program that computed the runs */
    const char *plan;             /* path as given, NULL where decks were named */
    const char *studies;          /* "identify", "diagnose" */
    const char *plan_digest, *decks_digest, *data_digest, *options_digest;
    unsigned long seed;
    long runs;         /* of the whole study */
    int shard, shards; /* runs with run % shards == shard - 1; 1 of 1: all */
};

struct header header_of(const struct study *study, const char *version, const char *commit, int shard, int shards);

/* With the line feed at its end, to be freed with json_free; NULL where memory is out. */
char *header_text(const struct header *header);

/* Texts go to the pool. ROTID_OK, ROTID_ERROR_SYNTAX where it is no header of results, ROTID_ERROR_MEMORY. */
int results_header_read(struct pool *pool, const cJSON *object, struct header *header);

/* What differs in "the file ..., here ...", such as "the plan has changed"; NULL where they are of one study. The shard does not
 * count. ROTID_OK or ROTID_ERROR_MEMORY. */
int header_difference(struct pool *pool, const struct header *file, const struct header *here, const char **text);

#endif
