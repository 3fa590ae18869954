/* What to measure next: before any measurement, and after an ambiguous diagnosis. */
#ifndef ROTID_SUGGEST_SUGGEST_H
#define ROTID_SUGGEST_SUGGEST_H

#include "run/spectrum.h"
#include "suggest/rivals.h"
#include "suggest/tests.h"

struct suggestion {
    rotid_suggestion result; /* all but the cards, the causes of the rivals and the geometry, which are made of the following */
    struct state home;       /* the state that tests are made like, with the model that all of it holds for: */
    struct job job;          /* its job, */
    const double *x;         /* at the values of its parameters */
    struct spectrum spectrum;
    struct diagnosis found; /* base.fit NULL where nothing is measured */
    struct rivals rivals;
    struct test *test; /* [result.ntests] */
};

/* Of all states of a deck with options as in rotid.h, zeros for the defaults. Everything hangs on the pool except fits:
 * suggest_free, also of an error. Notes go to the list. ROTID_OK; ROTID_ERROR_ARGUMENT where the job has nothing to ask for (the
 * list says what was expected); ROTID_STOP_CANCELLED; any status of diagnose_run and the models. */
int suggest_states(struct pool *pool, const struct states *states, const rotid_suggest_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct suggestion *out);
/* The same of a job, the only state. */
int suggest_run(struct pool *pool, const struct job *job, const rotid_suggest_options *options,
                const rotid_environment *environment, struct message_list *notes, struct suggestion *out);
void suggest_free(struct suggestion *out);

#endif
