#ifndef ROTID_DIAGNOSE_DIAGNOSE_H
#define ROTID_DIAGNOSE_DIAGNOSE_H

/* Diagnosis: whether the model explains the data and, if it does not, which cause of the catalogue (src/diagnose/causes) does.
 * In: states of a deck (struct states). Out: struct diagnosis: verdict, causes, extended model, gain, limits.
 * diagnose.c (diagnose_states) runs the steps on struct engine (engine.c); changed_settle, changed_job there: what changed.
 *
 *   1 data       data.c (data_prepare): copies, assumed noise; correct.c (data_correct): takes a fault out of the data
 *   2 base       base.c (base_prepare): fit of the full model, mesh refined; accelerometer.c: mass of a roving one
 *   3 scan       scan_list.c: causes at all targets and places; columns.c: c = dr/da by adjoints (K - lambda M)^+; scan.c
 *                (scan_run): c_perp = c - QQ'c, drop of chi2 (c_perp'r)^2/|c_perp|^2; as_solid.c: the beam as a solid
 *   4 posterior  posterior.c (posterior_run): probabilities, averaged moduli; search.c, scan_pairs.c: beam search over sets;
 *                refit.c: fits with causes; laplace.c (evidence_of_fit): ln Z of a fit; profile.c
 *   5 data       3 and 4 again behind what they show (round.c, round_run): far_starts.c; pairing.c; faults.c: channels; level of
 *                the noise
 *   6 evidence   verdict.c; advice.c; evidence.c, leave_out.c: single causes for the reader, modes and sensors left out
 *   7 result     finalise.c: final fit, gain; detectable.c: |a| = (sqrt(T) + 1.28)/|c_perp|; hidden.c: dx = (J'J)^-1 J'c s
 *
 * Callers: api, study, suggest; deck writes the extended deck. The room reaches fits by src/run alone and the
 * properties of a cause by struct cause_kind; it must not read files, print, or change the deck. */

#include "diagnose/causes/causes.h"
#include "modal/modal.h"
#include "model/model.h"
#include "run/run.h"

/* -------------------------------------------------------------------------------------------------------------- diagnose */

/* Diagnosis of a job: what the model gets wrong, what causes it, the extended model, the gain, and what the data cannot tell.
 * Judged is always the full model by the likelihood; the FIT of the deck describes what the user does today. */

#define DIAGNOSE_MOST_CAUSES 4 /* physical causes named one after the other */

struct diagnose_options {
    int threads;
    const char *before, *after; /* what changed between these two states, instead of what the model lacks in all; NULL */
};

/* A cause at one target (for those with a place: at its best place), with what became of it. */
struct candidate {
    rotid_candidate result; /* `cause` is put there at the end, from the following members up to the intervals */
    const struct cause_kind *cause;
    struct effect effect; /* at the best values found; effect.name is that of the card it would get */
    int state, home;      /* as in struct scan_candidate */
    const int *in;
    const char *state_name; /* of the one state in which it acts, NULL: in all that have its target */
    const char *target;     /* "core", "core|right", name of a spring or tie rod, "" */
    int nparameter;         /* of the effect, in use; values of a fault of the measurement stand in `effect` likewise */
    int sensor[2];          /* ids, of a fault of one or two channels, else 0 */
    int fixed[EFFECT_MOST_PARAMETERS];
    double std[EFFECT_MOST_PARAMETERS], ci_lower[EFFECT_MOST_PARAMETERS], ci_upper[EFFECT_MOST_PARAMETERS]; /* NaN: not stated */
    int set;            /* of an alternative, from 1: those of one number are the causes of one explanation */
    double probability; /* of that explanation */
};

struct diagnosis_round {
    rotid_round result;
    int ncandidate;
    struct candidate *candidate; /* best first; only those worth a line: refitted, or a visible share of the misfit */
};

#define MOST_MEMBERS     3
#define VERDICT_NAMED    0.95 /* probability of a name */
#define VERDICT_HARMLESS 0.2  /* a cause below it is none */
#define SEARCH_PASSES    4
#define SEARCH_FITS      48 /* of all passes, at most */

struct evidence {
    double log_z;       /* over the noise's factors too */
    double log_stated;  /* at the noise as stated */
    double log_exact;   /* likewise, of an approximation that leaves nothing */
    double log_else;    /* with something else beside the causes; -INFINITY where nobody asked */
    double noise[2];    /* factors of frequencies and shapes at their mode */
    double *mean, *std; /* [nown] of the deck's unknowns */
};

struct scan;
struct refit;
struct evidence_data;

struct explanation { /* a set of causes, perhaps with something else beside it */
    int nmember, something_else, expanded;
    int again; /* fitted once more, from a larger set */
    struct candidate member[MOST_MEMBERS];
    const struct refit *refit;  /* its fit; NULL: none, but the line of the scan */
    const struct scan *scan;    /* at that fit; NULL: not scanned */
    struct evidence_data *data; /* with its faults of the measurement put right */
    double outside;             /* of these, see struct fault_proposal; and what integrals over places and widths add */
    struct evidence evidence;
    double log_prior, log_posterior, probability;
    double at_rest, runup_chi2; /* the probability without the measured critical speeds; chi2 of these, NaN: none */
};

struct marginal {
    struct candidate cause; /* as in the likeliest explanation that has it */
    double probability;
};

struct posterior {
    int count, room, nkind;
    struct explanation *item;   /* most probable first, behind posterior_run */
    struct evidence_data *data; /* as judged */
    const struct states *states;
    const struct scan *base;
    int nown;
    double length;                 /* of the rotor */
    double nothing, nothing_prior; /* probability that nothing is wrong, after and before */
    double something_else;         /* of all explanations with something else */
    int has_runup;                 /* measured critical speeds are in the probabilities */
    double runup_p;                /* of a chi2 as large as theirs, or larger, under the first explanation */
    int nmarginal;
    struct marginal *marginal; /* above LEAST_MARGINAL, largest first */
    int naveraged;
    rotid_averaged_parameter *averaged; /* [naveraged] the deck's unknowns over all explanations */
};

struct round_result;

struct diagnosis {
    struct posterior posterior;
    struct round_result *last;   /* the fits of its explanations */
    rotid_diagnosis result;      /* as the steps find it; candidates, causes and the fits are put there at the end, from below */
    struct states given;         /* what was diagnosed, as it came: of what changed the second state, corrected */
    struct states judged;        /* the states that were judged: LIKELIHOOD, NONE, faults of the data taken out, noise as found */
    struct job job;              /* the first of them */
    int mesh_suffices;           /* the meshes of the deck do: the finer ones of the last fits move nothing that counts */
    struct identification today; /* by the FIT of the deck; fit NULL where it could not be made. Of several states this, base and
                                    extended are those of the first with the fit of all, and stand for all in what follows */
    struct identification base;
    struct identification *state_today, *state_base, *state_extended; /* [judged.nstate] of each, the fit as it sees it */
    int nround;
    struct diagnosis_round *round; /* the last one names nothing more */
    int ncause;
    int nlikely;               /* that stand in the final model beside those, without being named, */
    double likely_probability; /* and how probable the model with all of them is */
    struct candidate *cause;   /* [ncause + nlikely] as they stand there */
    int nalternative;          /* ambiguous: the causes of candidates that cannot be told apart, best first */
    struct candidate *alternative;
    struct states extended_states;  /* without states where nothing was named */
    struct job extended_job;        /* the first of them */
    struct identification extended; /* the base again where nothing was named: fit NULL then */
};

/* Over all states of a deck, or what changed between two: result.before and after are exchanged where the other order explains
 * that better. Everything hangs on the pool except the fits: diagnose_free. Notes go to the list. ROTID_OK;
 * ROTID_ERROR_ARGUMENT where the job has nothing that can be judged (the list says what and what was expected); any status of the
 * fits. An interruption by the environment is no error: what is finished stands in *out with `result.interrupted`. */
int diagnose_states(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_environment *environment, struct message_list *notes, struct diagnosis *out);
void diagnose_free(struct diagnosis *out);

/* -------------------------------------------------------------------------------------------------- roving accelerometer */

/* The mass of an accelerometer that goes from point to point, by what it does to the frequencies measured there. */

/* A mass m at point j turns f_k into f_kj = f_k sqrt(1 - x), where
 *   x (1 - (1 - x) m (q - x c)) = (1 - x) m s,
 * s_kj = phi_kj^2 of the mass-normalised mode, q_kj = lambda_k sum over i != k of phi_ij^2/(lambda_i - lambda_k), the response of
 * the other modes there, and c_kj = lambda_k^2 sum of phi_ij^2/(lambda_i - lambda_k)^2, how it changes with the frequency: exact
 * but for its second derivative. To first order x = m s. */
struct roving_data {
    int nmode, npoint;
    const double *hz, *std; /* [npoint * nmode] Hz, NaN: no reading */
    const double *square;   /* [npoint * nmode] s [1/kg] */
    const double *others;   /* [npoint * nmode] q [1/kg] */
    const double *bend;     /* [npoint * nmode] c [1/kg], NULL: 0 */
    const double *order;    /* [npoint] from -0.5, the first point of the test, to 0.5, the last */
    double least_mass;      /* kg: nothing lighter is an accelerometer */
};

struct roving_accelerometer {
    int usable; /* the readings can tell a mass from a drift, with three degrees of freedom left; otherwise all else is zero */
    int found, drifts;
    int readings, dropped, dof;
    double mass, std;        /* kg, the latter widened by the scatter where that is more than stated */
    double scale;            /* that factor, at least 1 */
    double chi2_drop;        /* by the mass, beside a drift */
    double z, threshold;     /* mass/std, and what it has to exceed */
    double drift, drift_std; /* relative change of all frequencies from the first point to the last */
    double smallest;         /* kg: found nine times in ten */
    double *spread_hz; /* [nmode] f_k with mass/npoint at every point, f_k/sqrt(1 + m mean of s), in the middle of the test; NaN
                          where the mode has no reading. On the pool. */
};

/* Regression of ln f_kj, with one m, one f_k a mode, and one drift that is linear in the order of the points and the same in all
 * modes, so that a drift is never taken for a mass. Readings that contradict the others are dropped (point_drop_outliers).
 * Found: z beyond the threshold that noise passes 5 times in 1000 by Student's distribution, and twice that where the drift
 * alone explains more than the mass alone; still beyond noise (5 %) with any one point left out, so that no single accelerometer
 * that sat badly makes a mass; and no lighter than least_mass. drifts: the drift is beyond what noise makes 5 times in 1000.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int weigh_roving_accelerometer(struct pool *pool, const struct roving_data *data, struct roving_accelerometer *out);

/* x of a mass at a point. */
double moving_mass_shift(double mass, double square, double others, double bend);

/* What a mass at point j does to the residue of mode k between that point and another one, e: the loaded over the unloaded
 * phi_kj phi_ke. across: q of the pair (j, e), across_bend its c; share = phi_kj/phi_ke. To first order
 * 1 - m s + m q + m q_je phi_j/phi_e. */
double moving_mass_residue(double mass, double square, double others, double bend, double across, double across_bend,
                           double share);

/* --------------------------------------------------------------------------------------------------------------- columns */

/* Sensitivity of the residuals to anything that changes K and M, at one point of a model: the adjoint way. For every fitted mode
 * the rows of (K - lambda M)^+ at the sensors are solved for once; a change dK, dM then costs products only.
 * Residuals as in struct functional for the likelihood: frequencies of the fitted modes first, then shapes mode by mode, each
 * with its best scale, so a column is already orthogonal to the scales. */

struct columns_mode {
    int k, pair, sensors; /* measured mode; pair of the prediction; components measured */
    const int *sensor;    /* [sensors] indices */
    double scale;         /* a: predicted shape times a is the best fit to the measured one */
    int first, members;   /* pairs of its cluster (eigenvalue_cluster) */
    double *adjoint;      /* [sensors * n] */
    double *weighted;     /* [sensors] phi_s/s_s: the direction of the scale */
    double square;        /* its squared length */
};

struct columns {
    struct pool *pool;
    const struct job *job;
    struct rotor_model model;
    struct functional functional;
    rotid_measured measured;
    int nrow, nmode;                /* residuals, fitted modes */
    struct columns_mode *mode;      /* [nmode] */
    double *x, *r;                  /* [nparam], [nrow]: the point and its residual */
    double *phi;                    /* [n * nmode] */
    double *rows, *dk_phi, *dm_phi; /* [n * nmode] what a change touches of the modes, and what it makes of that */
    double *right;                  /* [n] */
    double *dphi;                   /* [nmaster] */
    rotid_matrix dk, dm;
};

/* At the values x of the job's parameters (those in the rotor, where NULL), with the pairing `number` and the held-out modes
 * `holdout` [nmode]. extra: an effect that can be put in for differentiation, NULL: none; its parameters follow those of the job.
 * Statuses of the fit. */
int columns_open(struct pool *pool, const struct job *job, const int *number, const int *holdout, const struct effect *extra,
                 const double *x, struct columns *c);

/* Solves for what the columns need; before the first of them. like: NULL, or prepared columns of the same model and point, whose
 * solutions serve where modes and sensors are the same, and have to stay. Statuses of memory, or ROTID_ERROR_CLOSE. */
int columns_prepare(struct columns *c, const struct columns *like);

/* column [nrow] for parameter p of the model: the job's first, then those of the extra effect. */
int columns_parameter(struct columns *c, int p, double *column);

/* The effect in the place of the extra one, at its neutral values; the model does not change. ROTID_OK or ROTID_ERROR_MEMORY. */
int columns_probe(struct columns *c, const struct effect *effect);

/* Residual [nrow] at other values x of all parameters, by solving the model anew: for secants. The state that columns_parameter
 * needs is lost with it. */
int columns_residual(struct columns *c, const double *x, double *r);

/* ------------------------------------------------------------------------------------------------------------------ scan */

/* The scan: every cause at every target and place as a column of sensitivities, whitened and taken orthogonal to what is fitted
 * anyway, and the drop of chi2 that it promises, (c'r)^2/(c'c). Of several states the rows stand one state behind the other; a
 * cause acts in all states that have its target, or in one of them alone. */

struct scan_item { /* one column */
    int candidate;
    struct effect effect; /* neutral, at this place and width */
    double unit;          /* step of the size parameter that the column stands for: 1, or typical - neutral of a secant */
    int side;             /* sign the amplitude must have, 0: any */
    int usable;           /* the column is more than rounding once what is fitted is taken out */
    double norm;          /* of the projected column */
    double lower, upper;  /* of the amplitude, by physics */
    double shown;         /* amplitudes_shown */
    double amplitude, drop;
};

struct scan_candidate {     /* a cause at a target, with all its places */
    int state;              /* in this one alone, though others have the target too; -1: in all that have it */
    const char *state_name; /* of that one, or of the only one that has the target; NULL */
    int home;               /* the first state in which it acts */
    const int *in;          /* [nstate] nonzero: it acts there */
    const struct cause_kind *cause;
    struct effect effect; /* variant and target; a user's values where fixed */
    const char *target;
    int suspect, fixed[EFFECT_MOST_PARAMETERS];
    int first, count;         /* items */
    int best;                 /* item of the largest drop, -1: none is usable */
    double promise;           /* drop where there is no column */
    const struct effect *far; /* where a fit starts as well (far_starts_mark), NULL */
};

enum scan_extent {
    SCAN_ALL,
    SCAN_FIELDS /* the candidates of scan_is_field alone, zones of the least width */
};

struct scan {
    enum scan_extent extent;
    char *is_frequency;               /* [nrow] the row is that of a frequency: the first ones of each state */
    int nrow, nfrequency, nfree, dof; /* dof: rows less free parameters and scales */
    int nitem, ncandidate;
    struct scan_item *item;
    struct scan_candidate *candidate;
    double *column; /* [nrow * nitem] projected, of unit length; zero where not usable */
    int nbasis;
    double *basis; /* [nrow * nbasis] orthonormal: free parameters and scales */
    int *at;       /* [nfree] the column of the basis that a free parameter added; -1: it added none */
    double *along; /* [nfree * nfree] upper triangle: R of J = Q R, the columns of the free parameters in the basis */
    double *shift; /* [nfree * nitem] by how much the fit without the item moves each free parameter where the item is there with
                      an amplitude of 1: (J'J)^-1 J'c, J and c whitened and free of the scales; NaN where J does not have full
                      rank */
    double *r;     /* [nrow] residual, projected */
    double chi2, chi2_frequency;
    double largest; /* drop */
};

/* The candidates: every physical cause of the catalogue at every target where it applies and is not in the model yet, and the
 * user's suspects; of several states then those of them in one state alone. */
int scan_list(struct pool *pool, const struct states *states, struct scan *scan);

struct scan_pair {
    int item[2];
    double amplitude[2], drop;
};

/* The best items of two candidates each whose columns together promise most, with the largest drop first: list [most], *count.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int scan_pairs(struct pool *pool, const struct scan *scan, int most, struct scan_pair *list, int *count);

/* A name for a CAUSE card that nothing in the rotor has: "joint", or "joint_2" where that is taken. NULL where memory is out. */
const char *scan_free_name(struct pool *pool, const struct rotor *rotor, const char *id);

/* Whether the candidate's columns are those of a field of stiffness or mass along the rotor: a zone or a mass anywhere, in all
 * states. */
int scan_is_field(const struct scan_candidate *c);

/* Columns and drops at the parameters x of the fitted states; number and holdout of all modes. Statuses of columns_open. */
int scan_run(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
             enum scan_extent extent, struct scan *scan);

/* The effect of an item, its size moved by the amplitude unless a user has fixed it. */
struct effect scan_effect(const struct scan *scan, int item, double amplitude);
/* Largest drop that a candidate promises, 0 where none of its columns is usable, or nobody asked. */
double scan_best_drop(const struct scan *scan, int candidate);
/* The sign of an amplitude that physics leaves most room for. */
int scan_side(const struct scan_item *item);
/* Probability that noise as stated makes the chi2 of the frequencies as large; NaN where memory is out. */
double scan_chance_of_frequencies(struct pool *pool, const struct scan *scan);

/* ---------------------------------------------------------------------------------------------------------------- engine */

/* The state that the steps of a diagnosis share. */

struct far_start; /* below */

struct engine {
    struct pool *pool;
    int threads;
    const rotid_environment *environment;
    struct message_list *notes;
    const char *before, *after; /* the question is what changed between these states, or NULL */
    struct diagnosis *out;
    struct states states;               /* judged, with the causes named so far; their starts are the fitted values */
    struct job *job;                    /* of the state whose data are looked at, else of the first */
    const char *state;                  /* its name, NULL in a deck without *STATE */
    int nown;                           /* unknowns of the deck: the first ones of all */
    double *deck_start;                 /* [nown] */
    int *number, *holdout;              /* of the modes of all states */
    int nprepared;                      /* findings of the data before a model was looked at */
    int dropped;                        /* modes that nobody's shape fits and that were left out */
    struct job_measurement measured;    /* with them, where there are any */
    int *by_shape, numbered;            /* the pairs in whose place the deck's numbers were tried, NULL: not yet; being tried */
    double best_by_shape;               /* ln P of the likeliest explanation with them */
    rotid_fit_result *fit;              /* of these states */
    int user_reduction;                 /* of the deck's own FIT */
    int coloured;                       /* the noise of the shapes was raised for its smooth part */
    struct roving_accelerometer moving; /* the accelerometer by the frequencies at single sensors; usable 0 where it has none */
    int nfault;                         /* faults of the measurement that were taken out of the data, */
    struct marginal *fault;             /* as they were named */
    int searched_far;                   /* far starts were looked for, once */
    const struct far_start *far;        /* the one that led farther than the others, NULL */
    double clock;
};

#define NUMERICAL_FINDINGS 2  /* of one state: its mesh, its condensation */
#define MOST_STEPS         64 /* that the time is counted for */

/* "density of core", "joint of core|right with density of core"; the user's own name where it is a suspect. */
const char *candidate_label(struct pool *pool, const struct candidate *candidate);

/* A candidate of which nothing is known yet: NaN where a number may be missing, refit -1. */
struct candidate candidate_blank(const struct cause_kind *cause, const char *target);

/* The states that are judged from here on, in an array of their own, or the only one. ROTID_OK or ROTID_ERROR_MEMORY. */
int engine_take_states(struct engine *engine, const struct states *states);
/* job and state := those of state s. */
void engine_look_at(struct engine *engine, int s);
void engine_take_job(struct engine *engine, const struct job *job);

/* Counts the time since the last call for a step. */
void engine_step(struct engine *engine, const char *name);
/* Says where the work is; ROTID_STOP_CANCELLED once the environment wants to stop. */
int engine_stage(const struct engine *engine, const char *stage, int step);

/* --------------------------------------------------------------------------------------------------------- accelerometer */

/* An accelerometer that went from sensor to sensor: its mass and a drift, by the frequencies at single sensors. */

/* After the base fit, where there are frequencies at single sensors: the mass of an accelerometer that went from one to the next,
 * and a drift of the frequencies. What is found becomes a finding; the mass becomes part of the judged model (MOUNT=MOVING), the
 * frequencies are those of the regression with it, and what it does to the shapes is taken out of them where the place of the
 * hammer is known, else added to their noise. Where no mass is found the shapes get room for the largest one that is not
 * excluded. *changed when anything was. Nothing where the model has such an accelerometer already. */
int data_weigh_accelerometer(struct engine *engine, int *changed);
/* What was odd about the readings, once. */
void data_note_readings(struct engine *engine);
int is_moving_accelerometer(const struct effect *effect);

/* ----------------------------------------------------------------------------------------------------------------- refit */

/* Fits of all states with one more cause in them, or two, from several starts, and the small bookkeeping of jobs that grow.
 * number and holdout are those of all states, one behind the other, and x is that of the unknowns of all. */

/* Tolerances of the fits of a diagnosis: enough for chi2 to 1e-6 but in a valley; the final model is fitted to the end. */
#define REFIT_GRADIENT  1e-5
#define REFIT_STEP      1e-7
#define REFIT_OBJECTIVE 1e-6 /* what another step would gain: sizes are good to a hundredth of their standard deviation */
#define REFIT_DECREASE  1e-4 /* of the objective, by five steps */
#define REFIT_LEAST     0.01 /* chi2 by 0.02 in five steps is worth nothing; at 0.1 some stop on the way to another minimum */
/* Of chi2, well beyond those: so far above the model without its cause, a fit did not find what it contains. */
#define REFIT_WORSE 0.01

/* *to := the job `from` with the effect in its rotor and its parameters (those not fixed) behind the job's own, between their
 * physical bounds; a cause that asks for a solid makes the rotor one instead. Starts are x [nparameter] (the job's own starts,
 * where NULL) and the effect's values, moved off the bounds. `to` may be the job itself. ROTID_OK or ROTID_ERROR_MEMORY. */
int job_with_effect(struct pool *pool, const struct job *from, const double *x, const struct effect *effect,
                    const struct cause_kind *cause, const int *fixed, struct job *to);

/* The job with its starts at x [nparameter], moved inside where they press on a bound: the bijection of the fit is flat there,
 * and a parameter that a missing cause has pushed to its bound would stay. `to` may be the job itself. */
int job_started_at(struct pool *pool, const struct job *job, const double *x, struct job *to);

/* The same for the states with `in` [nstate] nonzero (NULL: all), which share the parameters of the effect: unknowns behind those
 * of all, between what is possible in every one of these states. A solid they are all together. */
int states_with_effect(struct pool *pool, const struct states *from, const double *x, const struct effect *effect,
                       const struct cause_kind *cause, const int *fixed, const int *in, struct states *to);

/* The same for the starts of all. */
int states_started_at(struct pool *pool, const struct states *states, const double *x, struct states *to);

/* *to := the states with the values that their effects have at x. */
int states_at(struct pool *pool, const struct states *states, const double *x, struct states *to);

/* *to := the same, started at x, with unknown p, a parameter of an effect, at a value and no unknown any more. */
int states_hold(struct pool *pool, const struct states *states, const double *x, int p, double value, struct states *to);

struct refit {
    struct states states;  /* with the effects of the set at the best values, which are also the starts */
    rotid_fit_result *fit; /* NULL where no start led anywhere */
    double chi2;
};

/* The best of the fits from the most promising places of a candidate, and the best of those that end at another place, more than
 * a width or 3 % of the length away. The states' own parameters start at x [nparameter], which is where the scan was made; and at
 * `deck` [nparameter] where none of those fits succeeded, or all ended above the model without the cause, which they contain.
 * Statuses of memory and cancellation only: where that leads no further fit is NULL. */
int refit_cause(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                const double *deck, const struct scan *scan, int candidate, const rotid_environment *environment,
                struct refit refit[2]);

/* The fit of the states, which is taken over, in the place of what *refit has. ROTID_OK or ROTID_ERROR_MEMORY. */
int refit_keep(struct pool *pool, const struct states *states, rotid_fit_result *fit, struct refit *refit);

/* One fit with the options of a diagnosis, which ends where another step would gain less than this part of the objective
 * (REFIT_OBJECTIVE; 0: at the minimum). */
int refit_until(struct pool *pool, const struct states *states, const int *number, const int *holdout, double objective,
                const rotid_environment *environment, rotid_fit_result **fit);
/* One that ends at REFIT_OBJECTIVE; refit_job: of a job that is the only state. */
int refit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                 const rotid_environment *environment, rotid_fit_result **fit);
int refit_job(struct pool *pool, const struct job *job, const int *number, const int *holdout,
              const rotid_environment *environment, rotid_fit_result **fit);

/* The values of effect number `effect` of a state at x of the unknowns of all. */
void effect_at(const struct state *state, int effect, const double *x, struct effect *out);
/* Number of the effect of that name (NULL: none) in a state, or -1. */
int effect_named(const struct state *state, const char *name);
/* The unknown that is a component of effect number `effect` of a state, or -1: it is held. */
int effect_unknown(const struct state *state, int effect, int component);

/* ----------------------------------------------------------------------------------------------------------------- round */

/* One round of scan, refit, comparison and decision. */

struct round_result {
    struct scan scan;
    int nrefit, room;
    struct refit *refit; /* [nrefit] of the search for explanations */
};

/* The scan and the explanations; doubt: of the data as well, pairing, channels, noise, of a job that is the only state: where
 * they were at fault all is done again. Statuses of the fits. */
int round_run(struct engine *engine, int doubt, struct diagnosis_round *round, struct round_result *result,
              struct posterior *posterior);
void round_free(struct round_result *result); /* NULL: nothing */

/* -------------------------------------------------------------------------------------------------------------- as solid */

/* The rival of a beam's causes: the same rotor as a solid (causes/beam_theory.c). */

/* *to := the job with its rotor as a solid, without the suspects that a solid cannot have. In a run alone (models_solids). `to`
 * may be the job itself. ROTID_OK or ROTID_ERROR_MEMORY. */
int job_as_solid(struct pool *pool, const struct job *from, struct job *to);

/* A fit of a solid again, its mesh held where that ended, until what is held moves by a tenth of the least noise of a frequency
 * at most. Statuses of memory and cancellation only. */
int refit_held(struct pool *pool, const int *number, const int *holdout, const rotid_environment *environment,
               struct refit *refit);

/* What the rotor as a solid in all states promises, by its residual at x, from which the beam's columns take what is fitted
 * anyway: to the first order in a change of the moduli; its mesh is held there. 0 where the rotor can be no solid, or one that is
 * too large, as is noted where notes is not NULL. Statuses of memory only. */
int scan_solid(struct pool *pool, struct states *states, const int *number, const int *holdout, const double *x,
               struct scan *scan, struct message_list *notes);

/* ------------------------------------------------------------------------------------------------------------------ base */

/* What the rounds start from: the model of the user, on a mesh and on data that are not to blame themselves. */

/* The fit of all states: of each, *first that of the first with the fit of all. Statuses of identify_states. */
int base_identify(struct engine *engine, const struct states *states, struct message_list *notes, struct identification **each,
                  struct identification *first);
/* Fit, mesh fine enough. ROTID_ERROR_ARGUMENT where nothing is left to judge by. */
int base_prepare(struct engine *engine);
/* Once more with the residuals, the data having changed. */
int base_again(struct engine *engine);
/* How often the elements of a job are to be halved until the error of its mesh, which the spectrum states, is negligible beside
 * the noise: what is too small to be a cause still moves a modulus by part of its interval. */
int base_halvings(const struct job *job, const int *number, const struct spectrum *spectrum);
/* Halves them so often, or until they are as many as a rotor may have. */
int base_refine(struct pool *pool, struct job *job, int halvings);
/* Elements of the base as many as a job with causes at x needs, which may vary faster along the rotor than any of its sections:
 * where twice as many would change its chi2 by more than the noise does. *changed: more are there. */
int base_refine_beside(struct engine *engine, const struct job *job, const double *x, int *changed);
/* "lower" or "upper": the bound at which parameter p of the base ends. */
const char *base_bound_side(const struct engine *engine, int p);
/* What the condensation of the user's own fit costs. */
int base_note_reduction(struct engine *engine);
/* Residuals of the base by mode and by sensor. */
int base_residuals(struct engine *engine);

/* What changed between two states: each is settled as a deck that is this one alone, the unknowns and what imitates the errors of
 * the model are fitted to the first, what the model still misses there is taken out of the data of the second, and the second is
 * diagnosed with the unknowns held. An error of the model that both states have is in neither. */

struct settled {
    struct state state[2];  /* as in the deck, their data without the faults of the measurement */
    struct job imitated[2]; /* the same with effects that imitate the errors of the model */
    rotid_diagnosis found;  /* steps and findings, which go with the names of the states; the rest is nothing */
};

/* options->before and after, in this order. ROTID_ERROR_ARGUMENT where a name is none of a state, or the data of one do not
 * suffice (the list says what was expected); statuses of memory and cancellation. */
int changed_settle(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct settled *out);

/* *out := the job of the other state of the two with the unknowns that it shares held at what fits `before`, 0 or 1, beside
 * effects that imitate what else is there. Its modes are those that both states have, with the frequencies f_a p_b/f_b, p_b what
 * the fitted model predicts for f_b on a mesh without error, and with the shapes a - g (b - s phi_b) at the places where both
 * have sensors, s and g the least-squares scales of the model's shape to b and of b to a. The noise of both adds in squares, and
 * so does what is missed times how much the mode is another one in both, d, d^2 = (2 ln f_a/f_b)^2 + 1 - MAC(a, b) less what
 * noise makes of that: what the model misses of a mode moves with it. Statuses of identify_run. */
int changed_job(struct pool *pool, const struct settled *settled, int before, const rotid_environment *environment,
                struct message_list *notes, struct job *out);

/* --------------------------------------------------------------------------------------------------------------- correct */

/* A fault of the measurement chain, found and taken out of the judged data. */

/* Takes a fault out of the data of a job, which has its own copies, and lists it among its corrections; the data as read are
 * kept. Statuses of correction_apply. */
int correction_add(struct pool *pool, struct job *job, const struct correction *correction);

/* Adds the finding, and corrects the data by its cause; `found` needs neither name nor id. Statuses of correction_apply. */
int data_correct(struct engine *engine, const rotid_data_finding *finding, const struct correction *found);

/* Raises the noise of a block, "SHAPE" or "FREQUENCY", with a finding that says so. */
int data_correct_noise(struct engine *engine, const char *block, double factor, double std, const char *text);

/* ------------------------------------------------------------------------------------------------------------------ data */

/* The job that is judged: copies of the data, and the faults found in them. */

/* Copies the data of all states, states the noise, refuses what cannot be judged. ROTID_ERROR_ARGUMENT with a reason in the
 * notes. */
int data_prepare(struct engine *engine, const struct states *states);
/* Gives a job its own copies of the data that the steps change. */
int data_copy(struct pool *pool, struct job *job);
void data_remove_mode(struct job *job, int k);
/* A mode that was counted twice: the numbers of those behind it are one lower. */
void data_remove_double(struct job *job, int k);
/* The unit of its value follows from its id. */
int data_add_finding(struct engine *engine, const rotid_data_finding *finding);
/* A finding about measured modes; second 0: about the first alone. */
int data_add_pairing(struct engine *engine, int first, int second, const char *text);

/* -------------------------------------------------------------------------------------------------------------- compare */

/* Of models of one measurement that are no explanations of the posterior: numberings and faults of channels. */

/* Penalty of a parameter in chi2. */
#define PARAMETER_PENALTY 3.0
/* Least lead in chi2 with those penalties: noise turns a rival into the better one by so much once in a hundred times at most,
 * however well it mimics (the difference of two fits at distance d is normal with mean d^2 and deviation 2 d). */
#define LEAST_MARGIN 6.0

/* ------------------------------------------------------------------------------------------------------------ detectable */

/* What could not be seen, and where along the axis it would show. */

/* item->shown of all items of a scan of the states: the amplitude that shows in 9 of 10 tests, >= 0: an amplitude a moves the
 * whitened residual by a |c|, the score is normal about that with variance 1, so a |c| = sqrt(T) + 1.28, T the drop of chi2 that
 * gives the cause, beside nothing, the probability above which a model is not called adequate (VERDICT_HARMLESS). INFINITY where
 * the item is not usable. */
void amplitudes_shown(const struct states *states, struct scan *scan);

/* result.detectable of *engine->out by the scan of the last search, whose items have their amplitudes that show. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int detectable_sizes(struct engine *engine, const struct scan *scan);
int localise(struct engine *engine, const struct scan *scan);

/* ----------------------------------------------------------------------------------------------------------- discrepancy */

/* What a cause that is an approximation, such as the cone at a step, leaves: noise behind it. */

/* sigma := sqrt(sigma^2 + d^2) in the states in which the candidate acts, in arrays of their own: d is what its cause leaves of a
 * frequency, and of the largest component of a shape. ROTID_OK or ROTID_ERROR_MEMORY. */
int discrepancy_add(struct pool *pool, const struct candidate *c, struct states *states);

/* -------------------------------------------------------------------------------------------------------------- evidence */

/* What each fit says about its candidate, and how well it predicts what was left out. */

/* The effect and its parameters, those of the fit that belong to it: effect number e of a state in which it acts. */
void candidate_values(const struct refit *refit, const struct state *state, int e, struct candidate *c);
/* Candidate `index` of the scan as it was listed. */
struct candidate candidate_listed(const struct scan *scan, int index);

#define BLOCK_LEVEL 0.01

/* The candidates of the search, the most probable first. ROTID_OK or ROTID_ERROR_MEMORY. */
int evidence_collect(struct engine *engine, const struct scan *scan, const struct posterior *posterior,
                     struct diagnosis_round *round);
/* Prediction of modes left out in turn beside the fit of states that start where it ended: rms of *error in percent, and of
 * *shape. Statuses of memory and cancellation only. */
int modes_in_turn(const struct engine *engine, const struct states *states, const rotid_fit_result *fit, double *error,
                  double *shape);

/* ------------------------------------------------------------------------------------------------------------ far starts */

/* Where a fit has to start that no straight line from the model without a cause leads to: an effect so large that modes change
 * their order, or that its drop is no longer linear in its size. */

struct far_start {
    const struct cause_kind *cause;
    struct effect effect; /* with its target, at the values to start from */
};

/* Behind a search where even the best single cause leaves more than FAR_RATE of chi2 a degree of freedom, or a mode was left out
 * that nobody's shape fits; once in a diagnosis, of one state, as a beam. Every candidate is looked at with sizes over all of its
 * bounds, at places along the rotor, all modes paired anew with each; what comes nearest is fitted with its own pairing. Where
 * one of these fits leaves less than half of what all others do, a degree of freedom, or with the modes that were left out less
 * than twice that, it is the start of its candidate from then on, its pairing is settled for all, and the round has to be
 * repeated: *changed. Statuses of memory and cancellation only. */
int far_starts_search(struct engine *engine, const struct round_result *result, const struct posterior *posterior, int *changed);

/* -------------------------------------------------------------------------------------------------------------- finalise */

/* The final model, the gain, the verdict in words. */
int finalise(struct engine *engine);

/* ---------------------------------------------------------------------------------------------------------------- hidden */

/* What a cause below its detection limit does to the parameters that are identified. */

/* result.hidden of *engine->out. With the scan of the last round, c the whitened column of a cause, J those of what is fitted,
 * both free of the scales of the shapes, and s the smallest size that shows at a place (amplitudes_shown), or the largest that is
 * physical, the fit without the cause is off by
 *   dx = (J'J)^-1 J'c s.
 * Of all places and widths of a cause the one counts that moves a parameter most; of all causes those that move it most, three at
 * most. A cause in one state alone, a suspect, and one whose column lies within those of J (its size is not bounded by the data)
 * are left out, as is a parameter at its bound. ROTID_OK or ROTID_ERROR_MEMORY. */
int hidden_shifts(struct engine *engine, const struct scan *scan);

/* The same of a fit that no diagnosis made: of the states, whose noise is stated, at the values of their unknowns in `fit`, the
 * full model by the likelihood; found [nstate] and number of all modes as paired: what that fit gave. A solid is scanned on its
 * coarse mesh, held by the spectrum of `found`. list [*n] on the pool; none where there is nothing to judge by. Statuses of
 * scan_run. */
int hidden_of_fit(struct pool *pool, const struct states *states, const struct identification *found, const int *number,
                  const rotid_fit_result *fit, int *n, rotid_hidden **list);

/* ------------------------------------------------------------------------------------------------------------- leave out */

/* Prediction of what was not fitted: modes left out in turn (fitted again without each), sensors left out in turn (one
 * Gauss-Newton step, exact where the model is linear), modes the deck holds out. Modes are those of all states: k, number,
 * holdout. */

/* Predicts mode k by a fit of all fitted modes but it: error of its frequency and rms difference of its shape, NaN where there is
 * no such fit. from: the fit with it, from which one step leads there where the model follows it, or NULL. May run in several
 * threads. Statuses of memory and cancellation only. */
int mode_out_fit(const struct states *states, const rotid_fit_result *from, const int *number, const int *holdout, int k,
                 const rotid_environment *environment, const rotid_allocator *allocator, double *error_percent, double *shape);

/* From the fit of the job: rms over the sensors of the standardised residual that each has when it is not fitted, and of the
 * difference of shapes; NaN without shapes. ROTID_OK, ROTID_ERROR_MEMORY. */
int sensor_out(struct pool *pool, const struct states *states, const int *holdout, const rotid_fit_result *fit,
               double *standardised, double *shape_rms);

/* Frequency and shape errors of the modes that are (held = 1) or are not (0) held out. NaN where there are none. */
void fitted_errors(const struct states *states, const int *holdout, const rotid_fit_result *fit, int held, double *rms_percent,
                   double *max_percent, double *shape_rms);

/* rms difference of a measured shape [nsensor] to the model's, from their MAC: sqrt((1 - MAC) mean of squares), the largest
 * component being 1. NaN without a shape. */
double shape_difference(const struct job *job, int k, double mac);

/* What the mass of an accelerometer that went from sensor to sensor did to the measured shapes. The fitted model at the sensors,
 * mode by mode, without the accelerometer. */
struct weighing {
    struct columns columns; /* of the base: its fitted modes */
    int nmode, npoint;
    double *hz, *std, *square, *others, *order, *phi; /* as in struct roving_data; phi [npoint * nmode] */
    double *bend;                                     /* likewise */
    double *across, *across_bend; /* [npoint * nmode] like others and bend, but between the point and the hammer */
    double *spread; /* [npoint * nmode] d phi/dm with the mass spread over all sensors, but for a share of phi itself */
    int hammer;     /* sensor, -1 where not known */
};

/* --------------------------------------------------------------------------------------------------------------- pairing */

/* Which mode of the model each measured mode is, as long as the model is not the right one. */

/* Leaves out measured mode k, which looks like no mode of the base and whose number the shape of another one claims, with a
 * finding.
 */
int pairing_drop(struct engine *engine, int k);
/* A finding for every mode that engine->number takes for another one than `number` [nmode], the deck's. */
int pairing_note(struct engine *engine, const int *number);
/* The data `measured`, modes that were left out among them, take the place of those that are judged, with the pairing `number`,
 * and what was found about pairing is that. Nothing where it is the pairing there is. ROTID_OK or ROTID_ERROR_MEMORY. */
int pairing_adopt(struct engine *engine, const struct job_measurement *measured, int *number);
/* Where shapes pair the modes otherwise than the deck numbers them and what leaves only noise is not likely, the search is
 * repeated with the numbers of the deck, and again with those before where that made the likeliest explanation less likely:
 * *changed. A strong cause turns shapes of neighbours into each other, and fits with such pairs end between them. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int pairing_as_numbered(struct engine *engine, const struct posterior *posterior, int *changed);
/* The findings about pairing again, the data and the base being others. */
int pairing_note_again(struct engine *engine);
/* Behind a search: shapes of two neighbours under each other's number; without shapes shifts and gaps of the numbers. Where the
 * data are others then the search has to be repeated: *changed. */
int pairing_settle(struct engine *engine, const struct round_result *result, int *changed);

/* --------------------------------------------------------------------------------------------------------------- laplace */

/* The evidence of an explanation (laplace.c). */

/* Rows of the shape of a mode and the field over its sensors: C = U diag(value) U'. */
struct evidence_block {
    int row, count, state, mode;
    const int *sensor; /* [count] indices in its state */
    double *vector, *value;
};

/* What a row is of. The noise of what the rotor weighs is as stated, whatever that of the modes is. */
enum evidence_kind { EVIDENCE_SHAPE, EVIDENCE_FREQUENCY, EVIDENCE_WHOLE, EVIDENCE_KINDS };

struct evidence_data {
    struct pool *pool;
    int nrow, nline, nwhole, nscale, nblock;
    char *kind;       /* [nrow] enum evidence_kind */
    double *noise;    /* [nrow] as stated, relative */
    double *measured; /* [nrow] components over their noise */
    struct evidence_block *block;
    double deviation; /* of ln of the noise */
    int is_floor;     /* the noise is stated for more than scatter: it is no less */
};

struct fault_column { /* how the residual moves with a parameter of a fault of the measurement */
    const struct cause_kind *cause;
    int parameter;
    double value, lower, upper;
    double *column;   /* [nrow] d r/d value, free of the scales of the shapes */
    double step, std; /* of its value, by evidence_of_fit: to the best one in the metric of the fit, and its deviation */
};

double log_sum(double a, double b); /* ln(e^a + e^b) */

/* Of the data in the states with this pairing. ROTID_OK, ROTID_ERROR_MEMORY, ROTID_ERROR_LIBRARY. */
int evidence_open(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                  struct evidence_data **data);
/* Of a fit of states whose first nown unknowns are the deck's; member [nmember]: causes whose approximation adds to the noise;
 * fault [nfault]: parameters of faults of the measurement, at whose values the data were corrected before the fit.
 * out->mean and out->std [nown] are filled. ROTID_OK, ROTID_ERROR_MEMORY; ROTID_ERROR_ARGUMENT where the fit is of other data. */
int evidence_of_fit(const struct evidence_data *data, const struct states *states, int nown, const rotid_fit_result *fit,
                    int nmember, const struct candidate *member, int nfault, struct fault_column *fault,
                    const struct scan *else_scan, struct evidence *out);
/* A random field of relative stiffness or mass along the rotor: cosines with the spectrum of a squared exponential, by the
 * columns of the narrowest zones or of the masses of a scan. column [nrow * EVIDENCE_PROFILE_TERMS]: of unit amplitude. Returns
 * their number, 0 where the scan has none. */
#define EVIDENCE_PROFILE_TERMS 12
int evidence_profile(const struct scan *scan, const struct states *states, const struct cause_kind *cause, double *column);

/* Unknown p of a fit with causes, a place between its bounds [m] or a width, logarithmic, by its profile (profile.c). Its 95 %
 * interval goes into the fit: where the least chi2 of all other unknowns is within 3.84 of that of the fit, times the square by
 * which its intervals are widened, to a hundredth of the range or a seventh of the distance. In *out, the evidence_of_fit, ln Z
 * and the moments of the nown unknowns become those with the integral over it; data NULL: not asked for, out and valley are not
 * used. valley: where Z falls to e^-4 of the largest. Both are left alone where there is no integral. Statuses of memory,
 * cancellation, library. Time: three to twenty fits. */
struct profile_case {
    const struct evidence_data *data;
    const struct states *states; /* with the bounds of the fit */
    rotid_fit_result *fit;
    const int *number, *holdout;
    int nown, nmember, nfault;
    const struct candidate *member;
    struct fault_column *fault;
    const rotid_environment *environment;
};
int profile_unknown(struct pool *pool, const struct profile_case *c, int p, int logarithmic, struct evidence *out,
                    double valley[2]);

struct model_prior { /* of a parameter of a host: normal about neutral, deviation 0: uniform, of a positive one in ln */
    double lower, upper, neutral, deviation;
};

/* The same of a host's model: of its measured modes, position [nsensor] of the sensors along a structure of that length (NULL:
 * something else is white), and of a fit with priors [fit->n]; with_else: something else as well. */
int evidence_open_model(struct pool *pool, const rotid_measured *measured, int nsensor, const double *position, double length,
                        struct evidence_data **data);
int evidence_of_model(const struct evidence_data *data, const struct model_prior *prior, int nown, const rotid_fit_result *fit,
                      int with_else, struct evidence *out);

/* ln Z of the model of a scan with item i over that without it, at the place and width of the item; the drop of chi2 by the item
 * that makes so much of it, or one beyond what its size can make. */
double evidence_of_item(const struct scan *scan, const struct rotor *rotor, int i);
double evidence_drop_for(const struct scan *scan, const struct rotor *rotor, int i, double gain);

/* ---------------------------------------------------------------------------------------------------------------- faults */

/* Faults of the measurement chain as explanations (faults.c). */

#define FAULT_MOST_MODES 100 /* of a state */

struct fault_proposal {
    struct candidate fault;
    double gain;    /* of ln Z over the explanation beside which it was found, as it is linearised */
    double outside; /* ln of the likelihood of the readings that it takes out of the data, over their noise as stated */
};

/* The `most` faults that promise most beside a fit of the states with its scan and its data, [*count] best first. number and
 * holdout of all modes. ROTID_OK, ROTID_ERROR_MEMORY; statuses of columns_open. */
int faults_propose(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                   const rotid_fit_result *fit, const struct evidence_data *data, const struct scan *scan, int most,
                   struct fault_proposal *proposal, int *count);

/* Its parameters as columns beside the fit of states in whose data it was put right, behind the *count there are. */
int fault_columns(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                  const rotid_fit_result *fit, const struct evidence_data *data, const struct candidate *fault,
                  struct fault_column *column, int *count);

/* Fits of the states, whose fit is `from`, with the fault put right in data of their own, *data, until its numbers stay; they and
 * their deviations go to `fault`. refit->fit NULL where there is none. Statuses of memory and cancellation only. */
int fault_refit(struct pool *pool, const struct states *states, int nown, const int *number, const int *holdout,
                const rotid_fit_result *from, const rotid_environment *environment, struct candidate *fault, struct refit *refit,
                struct evidence_data **data);

/* Takes it out of the judged data, with a finding. Statuses of correction_apply. */
int fault_correct(struct engine *engine, const struct candidate *fault);

/* ------------------------------------------------------------------------------------------------------------- posterior */

/* The explanations of the data of an engine whose first round has been fitted (`result`): search, evidence, probabilities. Fits
 * and lists hang on the engine's pool; the fits that the search made are in posterior_free. */
int posterior_run(struct engine *engine, struct round_result *result, struct posterior *posterior);
/* The search that it makes: fills the list of a posterior whose data are open. Statuses of memory and cancellation only. */
int search_run(struct engine *engine, struct round_result *result, struct posterior *posterior);

#define SEARCH_WITHIN  7.0   /* of the best, in ln P */
#define POSTERIOR_NEAR 0.125 /* of the length: half of the interval of a place that is named */

/* A fault of the measurement rather than of the model. */
int candidate_is_fault(const struct candidate *c);
/* The same cause at the same target in the same states, whatever its variant and whoever asked for it; that near the same place
 * too, where it has one, far from which it is another one; that model, with what is fixed of it. Of two channels that are one,
 * whichever is the copy. */
int posterior_same_cause(const struct candidate *a, const struct candidate *b);
int posterior_same_name(const struct posterior *p, const struct candidate *a, const struct candidate *b);
int posterior_same_model(const struct candidate *a, const struct candidate *b);
/* Whether a set has a cause by its name; whether two sets have the same models; the item that does, or NULL. */
int posterior_has(const struct posterior *p, const struct explanation *e, const struct candidate *c);
int posterior_same_set(const struct explanation *a, const struct explanation *b);
struct explanation *posterior_find(const struct posterior *p, const struct explanation *e);
/* ln Z that a candidate of a scan has to gain at its best place and width to be more than harmless where the other explanation is
 * that nothing is wrong: its items are alike before, and the other ones are taken to gain nothing. */
double posterior_gain_shown(const struct scan *scan, int candidate);
/* ln of the prior of a set. */
double posterior_prior_of(const struct posterior *p, const struct explanation *e);
/* Behind the list; NULL: it is full. */
struct explanation *posterior_append(struct posterior *p, const struct explanation *e);
/* The most probable first. */
void posterior_sort(struct posterior *p);
/* Room for means and deviations of the deck's unknowns. ROTID_OK or ROTID_ERROR_MEMORY. */
int posterior_room(struct pool *pool, int nown, struct evidence *evidence);
/* Evidence and probability, not normalised, of a set by its fit; else_scan: with something else too, NULL: without. */
int posterior_score(struct engine *engine, struct posterior *p, const struct scan *else_scan, struct explanation *e);
/* The fit of a set and its states: those of the base where it has none of its own. */
const struct rotid_fit_result *explanation_fit(const struct engine *engine, const struct explanation *e);
const struct states *explanation_states(const struct engine *engine, const struct explanation *e);
/* column [2 * MOST_MEMBERS] of the faults in it, *nfault. */
int explanation_faults(const struct engine *engine, const struct explanation *e, struct fault_column *column, int *nfault);
/* fit_explains. */
int explanation_explains(const struct engine *engine, const struct posterior *p, const struct explanation *e);

/* The marginals of a list whose items have their probabilities; something_else and nothing, which are 0 before, likewise.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int posterior_marginals(struct pool *pool, struct posterior *p);
/* Probability of a cause, alone or with others; 0 where it is below LEAST_MARGINAL. */
double posterior_of_cause(const struct posterior *posterior, const struct candidate *cause);
/* ln of the prior of a set of so many causes, without those of its causes. */
double posterior_log_prior(int nmember, int something_else);
/* Unknown q averaged over all explanations, cut at its bounds: mean, deviation, 95 % interval. */
void posterior_average(const struct posterior *posterior, const rotid_parameter *bounds, int q, double *mean, double *std,
                       double *lower, double *upper);
/* The kind of the verdict by the probabilities: of something else, of the likeliest cause, of nothing after and before. */
int posterior_kind(double something_else, int named, int nothing_leads, double largest, double nothing, double prior);
/* Takes the faults of the measurement with a probability of VERDICT_NAMED out of the judged data, *changed: there were any. The
 * search has to be repeated then. */
int posterior_take_faults(struct engine *engine, const struct posterior *posterior, int *changed);
/* The verdict of it into the engine: what is named becomes part of the model. */
int posterior_verdict(struct engine *engine, struct posterior *posterior);

/* ---------------------------------------------------------------------------------------------------------------- advice */

/* A model that is possible, and what it is called. */
struct possible {
    const struct candidate *cause;
    const struct states *states;
    const double *x;
};

/* What to measure next: the mode in which two models differ most against the noise; count: 2, or fewer where there are none. NULL
 * where memory is out. */
const char *advise_between(struct engine *engine, int count, const struct possible *model);

#endif
