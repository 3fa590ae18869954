#ifndef ROTID_API_API_H
#define ROTID_API_API_H

/* api: the first layer of rotid.h: a deck and its results as plain structs of which the host owns a copy.
 *
 * Comes in: a path or text of a deck, a rotid_deck, options, an environment. Goes out: a status, a struct of rotid.h, the reason
 * of a failure. Each routine of rotid.h opens a call (call_open: scratch memory, cancellation, locale "C"), lets src/run,
 * src/diagnose or src/suggest compute on the scratch, makes a struct of pointers into the scratch, and copies the struct for the
 * host (call_keep, by the tables of src/record); call_close explains errors.
 *
 *   deck_handle.c     the frame of a call; the copy; rotid_deck_read, rotid_deck_read_text; deck_states, deck_job
 *   spectrum.c        rotid_deck_check: mass, geometry, sensors; rotid_spectrum_compute, rotid_spectrum_beside: modes, pairing
 *   identification.c  rotid_identify; result_identification.c: parameters with std and interval, chi^2, modes, noise
 *   diagnosis.c       rotid_diagnose; result_diagnosis.c: candidates, verdict, rounds, gain
 *   suggestion.c      rotid_suggest: tests to do next
 *   result_geometry.c the model as it is drawn and meshed
 *
 * Hosts and src/cli call rotid.h; src/cli takes deck_job_of, deck_states_of and machine_refuse besides. Models and fits of a
 * host (rotid_model, rotid_fit) belong to src/modal and src/fit. The room prints nothing and keeps nothing between calls. */

#include <stdatomic.h>

#include "diagnose/diagnose.h"
#include "model/model.h"
#include "record/record.h"
#include "run/run.h"

/* ------------------------------------------------------------------------------------------------------------------ call */

/* One call of the first layer: the environment that its run sees, its notes, and why it failed. */

struct call {
    struct entry entry; /* with the environment of the host, and the scratch */
    atomic_int cancelled;
    rotid_environment environment; /* of the run: once the host has said stop it is not asked, and told of nothing, again */
    struct message_list notes;     /* on the scratch */
    const struct job *job;         /* of the deck, its first state; NULL where no deck was asked for */
    struct host_locale locale;     /* as it was, while `entered` */
    int entered;
};

/* `result`: address of the pointer that the call is to set, NULL from now on; `name`: of that argument. ROTID_OK, with exceptions
 * masked and the locale "C" until call_close; ROTID_ERROR_ARGUMENT where it is NULL or the environment is none,
 * ROTID_ERROR_MEMORY. To be closed in any case. */
int call_open(struct call *call, const rotid_environment *given, char *failure, void *result, const char *name);

/* Leaves in the `failure` of the host the errors among the notes, joined and cut off, where nothing was said before. Returns
 * status. */
int call_close(struct call *call, int status);

/* ----------------------------------------------------------------------------------------------------- deck handle, keep */

/* The states of a deck, for reading alone; NULL where there is none to compute with (deck NULL, or with errors): the notes of the
 * call say why then. */
const struct states *deck_states(const rotid_deck *deck, struct call *call);

/* The job of a deck of one state; NULL also where it has several. */
const struct job *deck_job(const rotid_deck *deck, struct call *call);

/* All states, and the job of the first one, without a call that has to be explained; NULL of a deck with errors. */
const struct states *deck_states_of(const rotid_deck *deck);
const struct job *deck_job_of(const rotid_deck *deck);

/* A copy of the struct `made`, which `record` describes, and the notes of the call as its messages. It leans on nothing, and its
 * member `memory` is a pool of its own, for pool_free; the addresses of these three members of `made` are given. NULL where
 * memory is out, now or since the scratch was opened. */
void *call_keep(const struct call *call, const struct record *record, const void *made, void **memory, int *nmessage,
                const rotid_message **message);
#define CALL_KEEP(call, record, made) call_keep((call), (record), (made), &(made)->memory, &(made)->nmessage, &(made)->message)

/* --------------------------------------------------------------------------------------------------------------- machine */

/* The fit of all states, with the run-up of the machine where it has one; *fit stays NULL where nothing is to be identified or
 * measured. Statuses of runup_join and identify_states. */
int machine_fit_all(struct call *call, const struct states *states, rotid_fit_result **fit);

/* ROTID_ERROR_ARGUMENT, with the reason among the notes, where there is no machine. */
int machine_refuse(const struct states *states, struct message_list *notes);

/* --------------------------------------------------------------------------------------------------------------- results */

/* A diagnosis as hosts and files have it. deck: the states as the user states them, whose FIT `today` was fitted with. It leans
 * on both. Without messages and the extended deck. The result of `d`; where memory is out the pool says so. */
rotid_diagnosis *result_diagnosis(struct pool *pool, const struct states *deck, struct diagnosis *d);

/* Candidates at their best values, as *list; how many. Where memory is out the pool says so. */
int result_causes(struct pool *pool, int count, const struct candidate *candidate, rotid_cause **list);

/* A model as it is drawn and meshed: of the beam, with the values of the parameters and the end springs that it has; of the rotor
 * as it stands, without nodes, where beam is NULL. It leans on both. NULL where memory is out. */
rotid_geometry *result_geometry(struct pool *pool, const struct rotor *rotor, const struct rotor_model *model);

/* An identification as hosts and files have it, without messages: of the states that were fitted together, found [nstate], fit:
 * of all; of several those of each in `states`. Leans on these. NULL where there is no fit, or memory is out. */
rotid_identification *result_identification(struct pool *pool, const struct states *states, const struct identification *found,
                                            const rotid_fit_result *fit);

/* Measured mode k beside the frequency predicted for its partner. Without residual, which is NaN. */
rotid_compared_mode result_compared_mode(const struct job *job, const struct comparison *compared, int k, double predicted_hz);

/* *WEIGHT and *CENTRE of a job beside a model of this mass, [*count]. NULL where memory is out. */
rotid_weighed *result_weighed(struct pool *pool, const struct job *job, const struct mass_properties *mass, int *count);

/* Typical noise of the data of a job, and what the intervals of the fit rest on. NULL where memory is out. */
rotid_noise *result_noise(struct pool *pool, const struct job *job, const rotid_fit_result *fit);

#endif
