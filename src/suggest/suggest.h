#ifndef ROTID_SUGGEST_SUGGEST_H
#define ROTID_SUGGEST_SUGGEST_H

/* Suggest: what to measure next: where sensors should stand before a test, and which test separates the causes that a diagnosis
 * leaves open. In: states of a deck, options. Out: struct suggestion: plans of sensors, rivals, tests with expected leads.
 *
 *   entrance     suggest.c (suggest_states): diagnosis of what is measured, rivals, plan, tests
 *   plan         suggest.c (plan_design): columns of sensitivities at all places; design.c (design_choose): greedy choice and
 *                exchanges on ln det(P + G) + mean ln(1 + q_t); effective_independence; design_half_widths: 196 sqrt((G^-1)_pp) %
 *   rivals       rivals.c (rivals_find): alternatives of the diagnosis; rival_gram: J'J
 *   tests        tests.c (test_apply): mass added, supports stiffer, softer or moved, more modes or sensors; planned.c
 *                (planned_measure): the modes of a model as noise-free measurements of a test
 *   margin       margin.c (margin_judge): lead of a over b, M_b = score_b - score_a + Q_b(w - d_b) - Q_a(w) with
 *                Q_b(z) = |z|^2 - (J_b2'z)' H_b^-1 (J_b2'z); chances by draws of noise
 *   choice       candidates.c (candidates_judge): which tests and places are tried, their rank; joint_chi2: a rival fitted to
 *                the measurement and to a test together, in place of the linear margin
 *
 * Callers: api makes rotid_suggestion of it, deck writes the cards of a test. The room uses src/diagnose and src/run as they are:
 * it must not decide which cause is true, read files or print. */

#include "diagnose/diagnose.h"
#include "run/run.h"

/* ---------------------------------------------------------------------------------------------------------------- rivals */

/* The explanations that a diagnosis cannot tell apart, each as a fitted model. */

#define MOST_RIVALS 6    /* causes or pairs; the model as it is comes on top */
#define JUDGED      0.01 /* a misfit that noise exceeds less often is no noise */

struct rival {
    const char *label;
    int ncause;                    /* 0 of the model as it is, 2 of a pair */
    const struct candidate *cause; /* [ncause] */
    struct states states;          /* with its causes, at the best values */
    int home;                      /* the state that tests are made like */
    struct job job;                /* that one */
    const double *x;               /* [job.unknowns.nparameter] the fitted values that it has */
    const rotid_fit_result *fit;   /* to what was measured in all states */
    double score, share;           /* as in rotid.h */
};

struct rivals {
    int n; /* best first; the last one is the model as it is */
    struct rival *rival;
    int home;      /* the state that tests are made like */
    int nmode;     /* its fitted ones */
    int *number;   /* [nmode] of the model */
    double margin; /* lead over another rival that is needed for a name */
    int left_out;  /* of the set: no causes of the rotor, as solids, or beyond the most */
    double among;  /* how likely the true one is one of them, by what is measured */
};

/* What a diagnosis leaves as alternatives, each by its fit there: n is 0 where it leaves none that is a model. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int rivals_find(struct pool *pool, const struct diagnosis *d, struct rivals *rivals);
/* The state that tests are made like: that of the most fitted data. */
int rivals_home(const struct states *states);

/* Which unknown of the state `home` unknown p of all is, -1: that state does not have it. */
int rival_own(const struct rival *rival, int p);

/* Whether parameter p of a rival, of those of all states, can follow new data: it is not pressed against a bound. */
int rival_uses(const struct rival *rival, int p);

/* gram [n * n] := J'J of its fit in the relative values of the n parameters that it uses; of those with own [fit->n] nonzero
 * (may be NULL) the unit matrix: 100 % is what is known of them. */
void rival_gram(const struct rival *rival, const int *own, int n, double *gram);

/* --------------------------------------------------------------------------------------------------------------- planned */

/* Tests that nobody has made yet: a job with sensors where they could stand, and with the modes of a model as measurements. */

/* What is measured in a test. */
struct planned {
    int modes;
    const int *number;               /* [modes] elastic modes, from 1; NULL: the first ones */
    double frequency_std, shape_std; /* relative, > 0; shape_std 0: no shapes */
    int coarse;                      /* nonzero: of a solid by its coarse mesh */
};

/* *to := the job `from` with sensors at z [n], increasing, and without measurements. Where the job has a sensor its id stays;
 * others get ids behind the largest. An effect at a sensor that is gone acts nowhere. `to` may be the job itself. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int planned_sensors(struct pool *pool, const struct job *from, int n, const double *z, struct job *to);

/* The measurements of *to := the modes of `source` at the values x [nparameter] of its parameters, without noise, to be weighed
 * by the noise of the plan: frequencies, and shapes at the sensors of `source`, largest component 1; *to has sensors at the same
 * places. All modes are fitted, by the likelihood of the full model. Statuses of spectrum_compute; ROTID_ERROR_ARGUMENT where
 * the model has fewer modes. */
int planned_measure(struct pool *pool, const struct job *source, const double *x, const struct planned *plan, struct job *to);

/* Columns of the job, whose measurements are `coarse`, are those of the coarse mesh too: rivals are compared there, its error is
 * one that they share. Nothing of a beam. ROTID_OK or ROTID_ERROR_MEMORY. */
int planned_on_coarse(struct pool *pool, struct job *job);

/* *to := the job in a test with sensors at z [n], increasing: the measurements of its own model at x, and weighed as well as the
 * job was. Statuses of planned_measure and model_weigh. */
int planned_test(struct pool *pool, const struct job *job, const double *x, int n, const double *z, const struct planned *plan,
                 struct job *to);

/* ----------------------------------------------------------------------------------------------------------------- tests */

/* Tests that could be made next, and what each makes of a rotor. */

enum test_kind {
    TEST_AGAIN,
    TEST_MODES,   /* more of them */
    TEST_SENSORS, /* more of them */
    TEST_SHAPES,  /* where frequencies alone were measured */
    TEST_NOISE,   /* half of that of the shapes */
    TEST_MASS,
    TEST_STIFF, /* supports ten times as stiff */
    TEST_FREE,  /* hardly supported */
    TEST_MOVED, /* a support elsewhere */
};

struct test {
    enum test_kind kind;
    int modes;
    int *number;          /* [modes] */
    int nsensor;          /* 0: frequencies alone */
    const double *sensor; /* [nsensor] m, increasing */
    double frequency_std, shape_std;
    double mass, z;       /* kg, m: of the mass; z of the support that was moved */
    int spring;           /* that was moved */
    int setups, averages; /* averages: how often each point is measured */
    double *hz;           /* [modes] that the best rival expects, or NULL */
};

/* The i-th of them as a deck and a result know it: "again", "modes", ... */
const char *test_id(enum test_kind kind);
/* What to do, for a person. NULL where memory is out. */
const char *test_text(struct pool *pool, const struct job *job, const struct test *test);

/* *to := the job in the state of the test, without measurements, its sensors in place: parameters x [nparameter] become x_test
 * [nparameter] there, and own [nparameter] nonzero where a parameter has a value of its own in that state, which is not known:
 * the stiffness of a support that was changed. ROTID_OK or ROTID_ERROR_MEMORY. */
int test_apply(struct pool *pool, const struct test *test, const struct job *job, const double *x, struct job *to, double *x_test,
               int *own);

/* The factors of the supports in TEST_STIFF and TEST_FREE. */
#define TEST_STIFFER 10.0
#define TEST_SOFTER  1e-4

/* --------------------------------------------------------------------------------------------------------------- suggest */

/* What to measure next: before any measurement, and after an ambiguous diagnosis. */

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
 * list says what was expected); ROTID_STOP_CANCELLED; any status of diagnose_states and the models. */
int suggest_states(struct pool *pool, const struct states *states, const rotid_suggest_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct suggestion *out);
void suggest_free(struct suggestion *out);

/* ---------------------------------------------------------------------------------------------------------------- design */

/* Where to put sensors: Bayesian D-optimal design on columns of sensitivities (Chaloner and Verdinelli, Statistical Science 10,
 * 1995), beside effective independence (Kammer, J. Guidance 14, 1991).
 *
 * A design has a row for each frequency and for each shape component at any of `nplace` places, whitened by the noise. A set of
 * places S takes the frequencies and its components; the scale of each shape is free, so of mode k only the part orthogonal to
 * u_k counts, u_k the shape over its noise at S:
 *   G_ij(S) = sum c_i c_j - sum_k (u_k'c_i)(u_k'c_j)/(u_k'u_k)
 * The value of S is ln det(P + G) of the parameters, P what is known before, plus the mean over the targets t of ln(1 + q_t),
 * q_t = G_tt - G_tp (P + G_pp)^-1 G_pt: what is left of a target when the parameters follow it. */

struct design {
    int nmode, nplace, nwhole, nparam, ntarget;
    int targets_alone; /* nonzero: the value is that of the targets */
    double *column;    /* [nrow * (nparam + ntarget)], nrow = nmode (1 + nplace) + nwhole: frequencies, then shapes mode by mode,
                          then what the rotor weighs, whatever is taken */
    double *scale;     /* [nplace * nmode] u_k at all places */
    double *prior;     /* [nparam * nparam] P, positive definite */
    double *largest;   /* [nplace * nmode] |shape|, largest 1: noise is stated relative to the largest component at S */
};

/* Room for a design. ROTID_OK or ROTID_ERROR_MEMORY. */
int design_new(struct pool *pool, int nmode, int nplace, int nwhole, int nparam, int ntarget, struct design *design);

/* u_k and the shapes at all places, of columns whose sensors they are. */
void design_take_shapes(const struct columns *columns, struct design *design);

/* What a set of places says by the first `modes` modes. */
struct information {
    double value;  /* as above, less ln det P: nothing measured is 0 */
    double target; /* mean of ln(1 + q_t) alone */
    double *gram;  /* [nparam * nparam] G_pp, or NULL: not wanted */
    double *q;     /* [ntarget], or NULL */
};

/* Of the places with taken [nplace] nonzero; taken NULL: frequencies alone. own: the noise of a shape refers to its largest
 * component at these places, as that of a measured shape does, and not to the largest along the axis. ROTID_OK or
 * ROTID_ERROR_MEMORY, ROTID_ERROR_RANK where P + G is not positive definite. */
int design_information(struct pool *pool, const struct design *design, int modes, const int *taken, int own,
                       struct information *out);

/* Half-widths of the 95 % intervals [nparam] in percent, of relative parameters: 196 sqrt((G^-1)_pp); NaN where that is above
 * 100, or G is singular. ROTID_OK or ROTID_ERROR_MEMORY. */
int design_half_widths(struct pool *pool, int nparam, const double *gram, double *half_width);

/* Adds places to `taken` [nplace] until there are n, each time the one that raises the mean value of the designs most, then
 * exchanges those that were added as long as that raises it. Places nearer than `apart` to another one are left out; fewer are
 * taken where there are no more. told (may be NULL) is called after each addition, before the exchanges. design [ndesign] have
 * the same places z [nplace]. ROTID_OK, ROTID_ERROR_MEMORY or _RANK. */
int design_choose(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart, int n,
                  int (*told)(void *context, const int *taken), void *context, int *taken);

/* The exchanges alone, of all that are taken. Statuses likewise. */
int design_improve(struct pool *pool, int ndesign, const struct design *design, int modes, const double *z, double apart,
                   int *taken);

/* Mean value of the designs, likewise. */
int design_value(struct pool *pool, int ndesign, const struct design *design, int modes, const int *taken, double *value);

/* Effective independence: of the places in `taken` [nplace] the one of the least leverage phi_i'(Phi'Phi)^-1 phi_i goes, until n
 * are left. shape [nplace * modes]. ROTID_OK, ROTID_ERROR_MEMORY or _RANK (fewer places than modes). */
int effective_independence(struct pool *pool, int nplace, int modes, const double *shape, int n, int *taken);

/* ------------------------------------------------------------------------------------------------------------------ plan */

/* Before a test: what modes and sensors would say of the parameters, and where the sensors are to stand. */

/* Where along the axis sensors could stand. */
struct places {
    int n;
    double *z;    /* [n] m, increasing */
    int *deck;    /* [n] nonzero where the deck has one */
    double apart; /* m: sensors that are added keep this distance */
};

/* The tests worth a thought for the rivals of a diagnosis, each judged. Fills tests, in the order of their rank, rivals' margins
 * of places, and out->test. options: with defaults settled. Statuses of memory, cancellation and the models of plan_design. */
int candidates_judge(struct pool *pool, const struct places *places, const rotid_suggest_options *options,
                     const rotid_environment *environment, struct suggestion *out);

/* ------------------------------------------------------------------------------------------------------------- joint fit */

/* A rival fitted to what was measured and to a test at once: what the linear margins are compared with. */

/* *measured := what rival a at the values x [job.unknowns.nparameter] of the parameters of its home would give in the test,
 * without noise; coarse as in struct planned. Statuses of planned_measure. */
int joint_measurement(struct pool *pool, const struct rival *a, const double *x, const struct test *test, int coarse,
                      struct job_measurement *measured);

/* *chi2 of rival b fitted to its measurements in all states and to `measured` of the test together, from where it stands; what
 * has a value of its own in the test is an unknown of that state alone. Statuses of identify_states. */
int joint_chi2(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
               const rotid_environment *environment, double *chi2);

/* ---------------------------------------------------------------------------------------------------------------- margin */

/* What a test would say between rivals, before it is made.
 *
 * State 1 is what is measured, to which every rival is fitted: J_b1 there. Let rival a be true. State 2, the test, then gives
 * y = f_a(x_a) + J_a2 C_a^(1/2) eta + e, C_a = (J_a1'J_a1 + I)^-1 in relative parameters what state 1 leaves open, eta and e
 * standard normal. Rival b, fitted to both states, fails by min over h of |J_b1 h|^2 + |y - f_b(x_b) - J_b2 h|^2, its residuals
 * of state 1 being orthogonal to J_b1. With H_b = J_b1'J_b1 + J_b2'J_b2,   Q_b(z) = |z|^2 - (J_b2'z)' H_b^-1 (J_b2'z),   d_b =
 * f_b(x_b) - f_a(x_a) where scales of shapes are taken out of everything, that is Q_b(y - f_b), so the lead of a over b is M_b =
 * (score_b - score_a) + Q_b(w - d_b) - Q_a(w),   w = y - f_a(x_a). A name results where M_b exceeds what the decision asks for,
 * of every other rival at once. */

/* The best fit of rival b to both states without noise fails by distance [n * (n - 1)] = Q_b(d_b), b = 0 ... n - 1 (0 for a
 * itself), if rival a = 0 ... n - 2 is true. *feasible 0: no such state, or modes that have no partner; distance is then not set.
 * Statuses of memory and cancellation only. */
int margin_distances(struct pool *pool, const struct rivals *rivals, const struct test *test, double *distance, int *feasible);

/* All of it over draws of noise: fills chance, wrong and margins of *out (the lead expected is that of the formulas, the
 * chances are those of the draws), over the truths by their shares. *feasible likewise. */
int margin_judge(struct pool *pool, const struct rivals *rivals, const struct test *test, unsigned long seed,
                 rotid_suggested_test *out, int *feasible);

#endif
