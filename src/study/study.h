/* A study: a plan with the decks it names, checked and counted. Run i of it is known by i alone: its result depends on the plan,
 * its files, the seed and i, not on who computes it or when. */
#ifndef ROTID_STUDY_STUDY_H
#define ROTID_STUDY_STUDY_H

#include "base/message.h"
#include "study/digest.h"
#include "study/plan.h"

#define STUDY_MOST_RUNS 10000000

/* Indices into the axes of the plan. */
struct study_cell {
    int deck, variant, modes, sensors, noise, hide;
};

struct study_point {
    struct study_cell cell;
    long replicate, start; /* from 0 */
};

struct study_deck {
    const char *error; /* why every run of it fails, or NULL */
    long *first;       /* [nvariant + 1] runs of its variants */
    long *starts;      /* [nvariant] */
};

struct study {
    const struct plan *plan;
    int noverride; /* --set: on every deck, before the variant */
    const struct override *override;
    unsigned long seed;
    struct study_deck *deck; /* [plan->ndeck] */
    long runs;
    int nfile;
    size_t file_room;
    const char **file; /* what the decks are read from, where they can be read */
    char plan_digest[DIGEST_LETTERS + 1], decks_digest[DIGEST_LETTERS + 1], data_digest[DIGEST_LETTERS + 1],
        options_digest[DIGEST_LETTERS + 1];
};

/* Reads every deck in every variant, so that what is wrong with the plan is found before the first run. Errors of the plan go to
 * the list with their places. A deck that is wrong as it stands is a warning, and its runs will fail, unless all are. Everything
 * hangs on the pool, and `plan` and `override` are kept. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_MEMORY. */
int study_open(struct pool *pool, const struct plan *plan, int noverride, const struct override *override, unsigned long seed,
               struct message_list *messages, struct study *study);

/* 0 <= run < study->runs. Inside a cell the starts follow each other, then the replicates. */
struct study_point study_locate(const struct study *study, long run);

#endif
