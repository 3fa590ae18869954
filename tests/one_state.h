/* What the program does with all states of a deck, for tests of one job. */
#ifndef ROTID_TESTS_ONE_STATE_H
#define ROTID_TESTS_ONE_STATE_H

#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "suggest/suggest.h"

/* The job of a deck that has one state, by itself or by FIT, STATE=NAME; what the program does with a job, its only state. */
int deck_read(struct pool *pool, const char *path, int noverride, const struct override *override, struct message_list *messages,
              struct job *job);
int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out);
int suggest_run(struct pool *pool, const struct job *job, const rotid_suggest_options *options,
                const rotid_environment *environment, struct message_list *notes, struct suggestion *out);

#endif
