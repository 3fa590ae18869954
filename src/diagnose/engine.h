/* What the steps of a diagnosis share. */
#ifndef ROTID_DIAGNOSE_ENGINE_H
#define ROTID_DIAGNOSE_ENGINE_H

#include "diagnose/bootstrap.h"
#include "diagnose/diagnose.h"
#include "diagnose/moving_mass.h"
#include "diagnose/refit.h"
#include "diagnose/scan.h"

struct engine {
    struct pool *pool;
    int threads, replicates;
    unsigned long seed;
    const rotid_environment *environment;
    struct message_list *notes;
    struct diagnosis *out;
    struct job job;                      /* judged, with the causes named so far; its starts are the fitted values */
    int nown;                            /* parameters of the deck: the first ones of the job */
    double *deck_start;                  /* [nown] */
    int *number, *holdout;               /* [nmode] */
    rotid_fit_result *fit;               /* of that job */
    double mode_out_rms, mode_out_shape; /* of that job, NaN where unknown: modes left out in turn, percent and shape */
    int confident;                       /* the data are enough for a name */
    int user_reduction;                  /* of the deck's own FIT */
    int coloured;                        /* the noise of the shapes was raised for its smooth part */
    struct moving_mass moving;           /* the accelerometer by the frequencies at single sensors; usable 0 where it has none */
    const struct scan *base_scan;        /* of the base as it stands, for the first round; NULL: to be made */
    double clock;
};

#define MOST_STEPS 64 /* that the time is counted for */

/* "density of core"; the user's own name where it is a suspect. NULL where memory is out. */
const char *candidate_label(struct pool *pool, const struct candidate *candidate);

/* A candidate of which nothing is known yet: NaN where a number may be missing, refit -1. */
struct candidate candidate_blank(const struct cause_kind *cause, const char *target);

/* Counts the time since the last call for a step. */
void engine_step(struct engine *engine, const char *name);
/* Says where the work is; ROTID_STOP_CANCELLED once the environment wants to stop. */
int engine_stage(const struct engine *engine, const char *stage, int step);

/* ---- data.c: the job that is judged */

/* Copies the data, states the noise, refuses what cannot be judged. ROTID_ERROR_ARGUMENT with a reason in the notes. */
int data_prepare(struct engine *engine, const struct job *job);
/* Gives a job its own copies of the data that the steps change. */
int data_copy(struct pool *pool, struct job *job);
void data_remove_mode(struct job *job, int k);
int data_add_finding(struct engine *engine, const struct data_finding *finding);
/* A finding about measured modes; second 0: about the first alone. */
int data_add_pairing(struct engine *engine, int first, int second, const char *text);

/* ---- clean.c */

/* After the base fit: faults of channels and the level of the noise, taken out of the judged data; *changed when there were any.
 */
int data_clean(struct engine *engine, const struct scan *scan, int *changed);
/* Noise that neighbouring sensors share looks like physics to the scan. r [nrow] is the residual that the best candidate leaves:
 * where its smooth part, or all of it, is still too large, the noise of the shapes is raised to that, and the round has to be
 * repeated. */
int data_colour(struct engine *engine, const struct scan *scan, const double *r, int *changed);

/* Raises the noise of a block, "SHAPE" or "FREQUENCY", with a finding that says so. */
int data_correct_noise(struct engine *engine, const char *block, double factor, double std, const char *text);

/* ---- accelerometer.c */

/* After the base fit, where there are frequencies at single sensors: the mass of an accelerometer that went from one to the next,
 * and a drift of the frequencies. What is found becomes a finding; the mass becomes part of the judged model (MOUNT=MOVING), the
 * frequencies are those of the regression with it, and what it does to the shapes is taken out of them where the place of the
 * hammer is known, else added to their noise. Where no mass is found the shapes get room for the largest one that is not
 * excluded. *changed when anything was. Nothing where the model has such an accelerometer already. */
int data_weigh_accelerometer(struct engine *engine, int *changed);
/* What was odd about the readings, once. */
void data_note_readings(struct engine *engine);
int is_moving_accelerometer(const struct effect *effect);

/* ---- base.c: what the rounds start from */

/* Fit, faults of the data taken out, mesh fine enough. ROTID_ERROR_ARGUMENT where nothing is left to judge by. */
int base_prepare(struct engine *engine);
/* Elements of a job until the error of its mesh, which the spectrum states, is negligible beside the noise: what is too small to
 * be a cause still moves a modulus by part of its interval. */
int base_refine(struct engine *engine, struct job *job, const struct spectrum *spectrum);
/* "lower" or "upper": the bound at which parameter p of the base ends. */
const char *base_bound_side(const struct engine *engine, int p);
/* What the condensation of the user's own fit costs. */
int base_note_reduction(struct engine *engine);
/* Residuals of the base by mode and by sensor. */
int base_residuals(struct engine *engine);

/* ---- round.c: one round of scan, refit, comparison and decision */

struct round_result {
    struct scan scan;
    struct bootstrap bootstrap;
    int nrefit;
    struct refit *refit; /* [nrefit] */
    int *candidate;      /* [nrefit] of the scan */
};

int round_run(struct engine *engine, struct diagnosis_round *round, struct round_result *result);
void round_free(struct round_result *result);

/* ---- decide.c */

/* Penalty of a parameter in chi2. Two more of them, a place and a width, cost as much as the least margin: they let a zone follow
 * almost anything, and a cause without them is named where the zone fits no better. */
#define PARAMETER_PENALTY 3.0
/* Least margin of a name, in chi2 with those penalties: noise turns a rival into the better one by so much once in a hundred
 * times at most, however well it mimics (the difference of two fits at distance d is normal with mean d^2 and deviation 2 d). */
#define LEAST_MARGIN 6.0

/* The model before the round, as far as the candidates are compared with it. */
struct before {
    int dof, nfrequency;
    double chi2, chi2_frequency, holdout_rms, mode_out_rms, sensor_out_rms;
    double beyond_drop; /* of chi2, were its parameters free to pass the bounds they end at; 0 where none does */
};

double candidate_score(const struct candidate *candidate);

/* Sorts the candidates by their scores, gives every one that loses its reason, and the round its kind. The array of the
 * candidates has room for one more. */
int decide(const struct engine *engine, const struct before *before, struct diagnosis_round *round);

/* ---- evidence.c */

/* Fills the round's candidates from the refits and lets decide() judge them. */
int evidence_collect(struct engine *engine, struct round_result *result, struct diagnosis_round *round);
/* Prediction of modes left out in turn, for several jobs at once: error [models] in percent, shape [models]. */
int modes_in_turn(const struct engine *engine, int models, const struct job *const *job, double *error, double *shape);

/* ---- settle.c: from rounds to a verdict */

/* The winner of a round becomes part of the model, with what it leaves as an approximation added to the noise. */
int accept_cause(struct engine *engine, const struct diagnosis_round *round, struct round_result *result);
int settle(struct engine *engine, struct round_result *last);

/* ---- conclude.c: the final model, the gain, the verdict in words */

/* last: the round that named nothing more, or NULL. */
int conclude(struct engine *engine, const struct round_result *last);

/* ---- detectable.c: what could not be seen, and where it would show */

int detectable_sizes(struct engine *engine, const struct round_result *last);
int localise(struct engine *engine, const struct scan *scan);

/* ---- advice.c: the measurement that separates the members of an ambiguous set best; last: the fits of that
 * round, NULL where they are gone. NULL where memory is out. */
const char *advise(struct engine *engine, const struct diagnosis_round *round, const struct round_result *last);

#endif
