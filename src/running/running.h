#ifndef ROTID_RUNNING_RUNNING_H
#define ROTID_RUNNING_RUNNING_H

/* Running: the machine in operation: critical speeds, stability, unbalance response, margins, with their bands.
 * In: struct machine (cards behind *RUNNING), the rotor of a job, the moduli with their covariance. Out: rotid_speeds.
 *
 * In the fixed frame, q = (x, y), W the speed from x to y:
 *   M q'' + (C_b + C_i + W [0 P; -P 0]) q' + (K + K_b + W [0 C_i; -C_i 0]) q = f
 *
 *   loss           machine.c (loss_of_test): losses from the damping ratios of the test
 *   machine        machine.c (machine_rotor): the rotor of the test with what the machine has; coefficients_at: tables over speed
 *   matrices       system.c (system_build): K, M, P, losses and pull by src/model, on a basis of modes at rest with the static
 *                  motions by forces at the bearings and by gyroscopic moments; system_at: C(W), K(W)
 *   eigenpairs     pairs.c: all pairs at one speed (quadratic_pairs); pair_refine: inverse iteration; pair_follow: to another
 *                  speed by the vector
 *   criticals      critical.c: Newton on Im lambda(W) = h W; onset of instability by bisection
 *   response       response.c: unbalance response, peaks, amplification by half power; sag and bearing loads
 *   bands          bands.c: derivatives by every uncertain number, by left and right vectors; draws from the posterior of the
 *                  fit, the bearings, losses, pull; every critical speed solved again
 *   torsion        torsion.c (torsion_run): its natural frequencies with the disks of the machine
 *   worth          worth.c (worth_run): which test at rest narrows a critical speed most
 *   run-up         runup.c: measured critical speeds as residuals of a fit; beside the model's; as evidence of an explanation
 *   all of it      search.c (search_within): the range, the basis, the critical speeds; speeds.c (speeds_run)
 *
 * Loss factors: x + iy = f e^{iwt} + conj(b) e^{-iwt}; the elastic K of the group is multiplied by 1 + i eta sgn(w - W) on f and
 * by 1 + i eta on b, sgn 0 = 0.
 *
 * Callers: deck fills struct machine; cli runs; result, report and page read rotid_speeds. Only model/model.h is asked for
 * matrices: the room must not know what discretises a rotor. */

#include "linalg/linalg.h"
#include "model/model.h"
#include "rotor/rotor.h"
#include "run/run.h"

#define RPM 0.10471975511965978 /* rad/s */

/* --------------------------------------------------------------------------------------------------------------- machine */

enum { XX, XY, YX, YY }; /* of a bearing: forces -(k q + c q') by rows */

struct coefficients { /* over the speed: linear between the rows, constant outside */
    int count;        /* 1: constants; 0: none */
    double *speed;    /* [count] rad/s, increasing */
    double *k, *c;    /* [4 * count] N/m, N.s/m */
};

struct bearing {
    const char *name;
    double z;      /* m */
    int like;      /* whose draws it shares: its own index, or that of a bearing before */
    double std[2]; /* of ln of the factor on all of k, on all of c */
    struct coefficients film;
    int unknown[2];               /* which unknown of the machine is a factor on k, on c; -1: none */
    struct coefficients pedestal; /* of what carries it, XX and YY alone; count 0: rigid */
    double m[2];                  /* kg of the pedestal in x and y */
};

struct loss {           /* in the rotating part */
    int group, viscous; /* viscous: C = value [s] K; else loss factor [1] */
    double value, std;
    int from_test; /* until both are settled by loss_of_test */
};

struct pull { /* unbalanced magnetic pull: a negative stiffness over a group */
    int group;
    double value, std; /* N/m; std: of ln of a factor */
};

struct change { /* from rest to operation: a factor on a parameter */
    struct parameter parameter;
    const char *name;
    double factor, std; /* std: of ln of the factor */
};

struct unbalance {
    double z, value, phase; /* m, kg.m, rad from x in the direction of spin */
    double grade;           /* m/s of ISO 21940-11, of which `value` was a share in the deck; 0: none */
    double mass;            /* kg of the machine by the values of the deck, to which `value` of a grade belongs */
};

struct probe {
    const char *name;
    double z, angle; /* m, rad from x to y */
};

struct runup_reading {    /* a measured critical speed */
    int number, backward; /* from 1, of those with backward whirl, or with any other */
    double speed, std;    /* rad/s */
    struct place place;
};

struct machine_unknown { /* a factor on all stiffness or all damping of a bearing and of those like it */
    int bearing, damping;
    rotid_parameter bounds;
};

/* What stands behind *RUNNING. */
struct machine {
    struct place place; /* of *RUNNING */
    int nbearing, nloss, npull, nchange, nunbalance, nprobe, nrunup, nunknown;
    struct runup_reading *runup;
    int runup_held; /* HOLDOUT=RUNUP: it takes no part in fits */
    struct machine_unknown *unknown;
    struct bearing *bearing;
    struct loss *loss;
    struct pull *pull;
    struct change *change;
    struct unbalance *unbalance;
    struct probe *probe;
    int without_sling;
    int *without_spring, *without_disk, *without_effect; /* [nspring], [ndisk], [neffect] of the rotor at rest: 1 where it is
                                                            gone */
    int ndisk;
    struct disk *disk; /* that the machine has beside those of the test */
    int has_operation;
    double low, high; /* rad/s: running range */
    double margin;    /* relative, required; 0: none stated */
    int api617;       /* that of API 617 in its place, by the amplification factor */
    double line_hz;   /* of the grid; 0: none */
    double
        poles; /* of the machine; 0: unknown. Without line_hz a converter feeds it, by a frequency of poles/2 times the speed */
};

/* The numbers that are uncertain: factors around the nominal values, all 1 there. */
struct machine_values {
    const double *x;                                      /* [machine_unknowns] */
    double *bearing_k, *bearing_c, *loss, *pull, *change; /* [nbearing] twice, [nloss], [npull], [nchange] factors */
};

/* The rotor of the machine at the values, springs of no stiffness where bearings, unbalances and probes are (behind those of the
 * rotor at rest, in this order). ROTID_OK or ROTID_ERROR_MEMORY. */
int machine_rotor(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                  struct rotor *rotor);

/* All factors 1 at x. ROTID_OK or ROTID_ERROR_MEMORY. */
int machine_nominal(struct pool *pool, const struct machine *machine, const double *x, struct machine_values *values);

/* The unknowns of the machine: those of the job, and behind them its own. */
int machine_unknowns(const struct machine *machine, const struct job *job);
const rotid_parameter *machine_bounds(const struct machine *machine, const struct job *job, int p);

/* Whether u, in which an unknown is drawn and differentiated, is ln x: where its lower bound is above zero; else u = x. */
int machine_by_logarithm(const struct machine *machine, const struct job *job, int p);

/* Covariance of u of two unknowns that a fit of the machine's unknowns determines. */
double machine_covariance(const struct machine *machine, const struct job *job, const rotid_fit_result *fit, int p, int q);

/* On the stiffness or the damping of bearing i. */
double machine_bearing_factor(const struct machine *machine, const struct machine_values *values, int i, int damping);

/* What a fit of all states says of the unknowns of the machine: n, x, std and covariance of *own alone are to be used. Those of
 * the machine that took no part in the fit, and without a fit (NULL) all, are at their starts, without std. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int machine_fit(struct pool *pool, const struct states *states, const rotid_fit_result *fit, rotid_fit_result *own);

/* Whether a cause is a support of the test, or at a sensor. */
int effect_is_of_test(const struct effect *effect, const struct rotor *rotor);

/* Whether a parameter of the rotor at rest, or unknown p, acts in the machine: what it is of may have been left at the test. */
int machine_has(const struct machine *machine, const struct rotor *rotor, struct parameter parameter);
int machine_has_unknown(const struct machine *machine, const struct job *job, int p);

/* Of a group from the damping ratios that were measured at rest, at the values of the job's rotor: loss factor [1] and viscous
 * loss [s], each the mean over `count` modes and the standard deviation of one of them; count 0: no mode says anything. Statuses
 * of model_open and the prediction. */
struct loss_of_test {
    int count;
    double value[2], std[2];
};
int loss_of_test(struct pool *pool, const struct job *job, int group, struct loss_of_test *out);

/* k, c [4] at a speed [rad/s] >= 0 with their rates by the speed, or NULL. */
void coefficients_at(const struct coefficients *all, double speed, double k[4], double c[4], double dk[4], double dc[4]);

/* k in series with the pedestal under a bearing, both the mean of x and y at a speed: k where there is none. */
double bearing_on_pedestal(const struct bearing *bearing, double speed, double k);

/* ---------------------------------------------------------------------------------------------------------------- system */

struct pair {
    double complex lambda;
    double complex *u, *left; /* [size] u'u = 1; left: u* D = 0 from the left, in any scale */
};

/* The matrices of a machine on a basis. A plane has `plane` unknowns: those of the basis, and behind them for each bearing on a
 * pedestal what the stiffer of the two gives way, the film or the pedestal; the other one gives way by v' V q less that. A large
 * stiffness on both unknowns would leave no digits of what is soft. size = 2 plane: those of x, then those of y. */
struct system {
    const struct machine *machine;
    const struct machine_values *values;
    int n, columns, plane, size;
    int naxis; /* places of the rotor where whirl is looked at */
    struct discrete discrete;
    rotid_matrix m;             /* of the full model */
    double *basis, *mass_basis; /* [n * columns] V with V' M V = 1, and M V */
    double *k, *p;              /* [columns^2] V' K V with springs and pull, V' P V */
    double *loss[2]; /* [columns^2] elastic stiffness of the groups times their loss factors, times their viscous losses */
    double *bearing; /* [columns * nbearing] V' v of each bearing; of unbalances and probes likewise */
    double *unbalance, *probe;
    double *weight; /* [columns] V' M 1: a uniform acceleration */
    double *axis;   /* [columns * naxis] rows of V at the places of the axis */
    double total_mass;
    double highest;   /* rad/s: of the modes in the basis */
    int hysteretic;   /* a loss factor is there */
    double *own_mass; /* [columns^2] V' M V on the basis of another system; NULL: 1 */
    double *mass;     /* [size^2] */
    /* at a speed, by system_at */
    double speed;
    double *c, *stiff; /* [size^2] */
    double *h, *turn;  /* [size^2] of loss factors: eta K on both planes; eta [0 K; -K 0]; NULL without */
    double *dc, *dk;   /* [size^2] rates of c and stiff by the speed */
    /* workspace of pairs */
    double complex *d, *right, *left;
    int *pivot;
    struct pair spare[2]; /* the first of pair_follow and critical_carry, the second of onset_find */
};

/* How large a basis is to be. */
struct basis_size {
    int modes;   /* at rest */
    int coupled; /* of them, those whose gyroscopic moments have a static motion in the basis */
    int all;     /* nonzero: the forces of pull and losses as well, which leave 1e-11 of a critical speed in place of 1e-7 */
};

/* built: NULL, or the same machine at other values, whose mesh serves; with basis NULL its basis too. Statuses of discrete_build,
 * *failed likewise; ROTID_ERROR_ARGUMENT where both are NULL, ROTID_ERROR_STIFFNESS where nothing holds the rotor;
 * ROTID_ERROR_MASS, ROTID_ERROR_EIGEN. */
int system_build(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                 const struct system *built, const struct basis_size *basis, struct system *system, int *failed);

/* C, K and their rates at a speed [rad/s]. */
void system_at(struct system *system, double speed);

/* a [size^2] := lambda^2 M + lambda C + K at that speed; side: sgn(w - W), of the loss factors. */
void system_dynamic(const struct system *system, double complex lambda, int side, double complex *a);

/* Motions in x and y of a place whose row of the basis is `row`, in the motion u [size]. */
void system_orbit(const struct system *system, const double *row, const double complex *u, double complex orbit[2]);

/* How far the film of a bearing gives way in x and y in the motion u [size]. */
void system_film(const struct system *system, int bearing, const double complex *u, double complex film[2]);

/* The pair of one system on the basis of another one of the same mesh: u := V' M u_full. Without left vector. Returns 0, or 1
 * where the vectors of the other one have lost more than a tenth of it. */
int system_transfer(const struct system *from, const struct pair *pair, const struct system *to, struct pair *there);

/* ----------------------------------------------------------------------------------------------------------------- pairs */

int pair_new(struct pool *pool, int size, struct pair *pair);
void pair_copy(int size, const struct pair *from, struct pair *to);

/* |u'v|^2 of the vectors of two pairs: 1 of one motion. */
double pair_likeness(int size, const struct pair *a, const struct pair *b);

/* All pairs with Im lambda > 0 and not overdamped at a speed, by rising Im lambda: *count of them into pair [size], which are
 * there; without loss factors. real: NULL, or the largest eigenvalue above zero without whirl, 0: none. ROTID_OK,
 * ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int pairs_all(struct pool *pool, struct system *system, double speed, int *count, struct pair *pair, double *real);

/* The pair near `pair` at the speed of system_at, by inverse iteration with the nonlinear D: quadratic; on the side that Im
 * lambda says against `at`. Returns 0, or 1 without convergence. */
int pair_refine(struct system *system, double at, struct pair *pair);

/* The left vector of a pair that has converged, at the speed of system_at. Returns 0, or 1 where D is singular to the last bit.
 */
int pair_left(struct system *system, int side, struct pair *pair);

/* Side of the loss factors where Im lambda = h W: 0 for h = 1, where they jump. */
int critical_side(double h);

/* The speed near *speed where Im lambda = h W of a mode, and its pair there, by Newton on both together, quadratic; side of h.
 * The left vector is workspace. Returns 0, or 1 without convergence. */
int pair_synchronise(struct system *system, double h, double *speed, struct pair *pair);

/* The same mode at another speed in `least` steps or more: they are halved until the vector of one is that of the other. Returns
 * 0 or 1. */
int pair_follow(struct system *system, double from, double to, int least, struct pair *pair);

/* d lambda/dW at the speed of system_at; the pair has its left vector. */
double complex pair_rate(const struct system *system, const struct pair *pair);

/* d lambda/dp of a pair that has its left vector, dD/dp from the matrices of two machines on the basis of the nominal one,
 * `apart` in p: -l* dD u/(l* dD/dlambda u). turn: side of the loss factors. work [2 size^2 + size] */
double complex pair_difference(struct system *nominal, struct system side[2], double apart, double speed, int turn,
                               const struct pair *pair, double complex *work);

enum whirl { WHIRL_BACKWARD, WHIRL_MIXED, WHIRL_FORWARD }; /* as whirl_words */
enum whirl pair_whirl(const struct system *system, const double complex *u);

/* --------------------------------------------------------------------------------------------------------------- results */

#define SPEEDS_COUNT 41 /* of a Campbell diagram */
#define SPEEDS_DRAWS 2000

/* What is computed beside the machine. */
struct speeds_options {
    double from, to;     /* rad/s; to = 0: by the running range, else to beyond the third critical speed */
    int count;           /* speeds of the Campbell diagram */
    const double *speed; /* [count] rad/s, rising, in place of equal steps from `from` to `to`; or NULL */
    double harmonic;     /* 1: synchronous */
    int draws;           /* of the bands; 0: none */
    unsigned long seed;
    int threads; /* of the draws; the result does not depend on it */
};

/* x [machine_unknowns]; fit: of these (machine_fit), or NULL: they are taken as known. Reasons and notes go to the list.
 * ROTID_OK; ROTID_ERROR_STIFFNESS where bearings do not hold the rotor or the pull is stronger; ROTID_STOP_CANCELLED: all but the
 * bands is there; statuses of system_build, pairs_all. */
int speeds_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
               const rotid_fit_result *fit, const struct speeds_options *options, const rotid_environment *environment,
               struct message_list *notes, rotid_speeds *out);

/* ------------------------------------------------------------------------------------------- tracks, criticals, response */

/* The modes over the speeds of a Campbell diagram. */
struct tracks {
    int nspeed, nmode, room;
    double *speed;     /* [nspeed] rad/s */
    struct pair *pair; /* [nspeed * room], those of a mode one behind the other; lambda NaN where the mode is not there */
    double diverges;   /* lowest speed from which a motion grows without whirl, NaN: none */
    double beyond;     /* rad/s: the highest mode that grows in the upper half of the basis, and is not followed; 0: none */
};

/* Follows the modes up to Im lambda = limit at the first speed, those below at the last one that are not among them, where
 * bearings have tables at every second one between too, and those of the lower half of the basis that grow at any of the speeds.
 * Statuses of pairs_all. */
int tracks_make(struct pool *pool, struct system *system, int nspeed, const double *speed, double limit, struct tracks *tracks);

struct pair *track_at(const struct tracks *tracks, int mode, int speed);

struct critical {
    double speed; /* rad/s */
    int mode;     /* of the tracks */
    struct pair pair;
};

/* Every place where Im lambda crosses h W, by rising speed; missed: the lowest speed behind which a mode crosses at a place that
 * was not found, NaN: none. ROTID_OK or ROTID_ERROR_MEMORY. */
int criticals_find(struct pool *pool, struct system *system, const struct tracks *tracks, double h, int *count,
                   struct critical **critical, double *missed);

/* dW/dp [rad/s] of a critical speed: Im dlambda/dp/(h - Im dlambda/dW); the others as for pair_difference. */
double critical_rate(struct system *nominal, struct system side[2], double apart, double h, const struct critical *critical,
                     double complex *work);

/* The critical speed of another system of the same mesh that has the mode of `near`, by Newton from to->speed. Returns 0, or 1
 * and a speed of NaN where it is lost. */
int critical_carry(const struct system *from, const struct critical *near, double h, struct system *system, struct critical *to);

/* A machine over a range of speeds: its system, its modes and its critical speeds. */
struct search {
    const struct machine *machine;
    const struct job *job;
    struct machine_values values;
    double from, harmonic; /* from: rad/s; harmonic: 1: synchronous */
    int count;             /* speeds at which modes are looked at */
    const double *given;   /* [count] rad/s, rising; NULL: in equal steps */
    struct system system;
    struct basis_size basis;
    struct tracks tracks, followed; /* at the speeds; at those and more between them */
    double *speed;                  /* [count] rad/s */
    int ncritical;
    struct critical *critical; /* by rising speed */
    double missed;             /* as of criticals_find */
    double complex **map;      /* of map_make */
};

#define STANDSTILL 1e-8 /* of the highest speed: in place of 0, where forward and backward whirl are one */

/* Up to a speed [rad/s]; machine, job, values, from, harmonic and count of *search are in, the others out. Reasons go to the
 * list. Statuses of system_build, ROTID_ERROR_STIFFNESS where the pull is stronger than the bearings; those of pairs_all. */
int search_within(struct pool *pool, double to, struct message_list *notes, struct search *search);

/* Up to `least` [rad/s] or beyond, until so many critical speeds of forward or mixed whirl and of backward whirl are found, or
 * the range has been made larger several times. */
int search_until(struct pool *pool, double least, int forward, int backward, struct message_list *notes, struct search *search);

/* The number-th critical speed, from 1, with backward whirl, or with any other; NULL: there is none. */
const struct critical *search_find(const struct search *search, int number, int backward);

/* How many of the critical speeds are of backward whirl, or are not. */
int search_count(const struct search *search, int backward);

/* The lowest speed from which a mode grows, NaN: none; *mode of the tracks, -1 where it grows without whirl. */
double onset_find(struct system *system, const struct tracks *tracks, int *mode);

/* What of |lambda| counts as growth: below is rounding. */
#define GROWS 1e-9

/* q [size] of the unbalance at a speed: D(i W) q = W^2 f. Returns 0, or 1 where D is singular. */
int response_at(struct system *system, double speed, double complex *q);

/* Motion of a probe: x cos a + y sin a. */
double complex probe_motion(const struct system *system, int probe, const double complex *q);

/* The peak of a probe near a speed within [from, to]. Returns 0, or 1 where the response has none there. */
int response_peak(struct system *system, int probe, double from, double near, double to, rotid_response_peak *peak);

/* Weight, sag and loads at a speed into *out. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_STIFFNESS. */
int static_loads(struct pool *pool, struct system *system, double speed, rotid_speeds *out);

/* d ln |motion| of a probe at a speed by p, dD/dp from two machines as for pair_difference. work [2 size^2 + 2 size]. NaN where D
 * is singular. */
double response_rate(struct system *nominal, struct system side[2], double apart, int probe, double speed, double complex *work);

/* The margin that is required of a critical speed with that amplification factor, NaN: none. API Std 617, 8th edition, 6.8.2.5,
 * as two programs quote it: none for a factor below 2.5; min(16, 17 (1 - 1/(AF - 1.5))) % of the lowest running speed below it,
 * min(26, 10 + 17 (1 - 1/(AF - 1.5))) % of the highest one above it; inside the range 0, which is not kept. */
double speeds_required(const struct machine *machine, double amplification, double speed);

/* (low - W)/low below the running range, (W - high)/high above it, below 0 inside. */
double speeds_margin(const struct machine *machine, double speed);

/* The peak of a critical speed that is nearest to the running range, by which its margin is judged; NULL: it has none. */
const rotid_response_peak *speeds_peak(const struct machine *machine, const rotid_critical_speed *critical);

/* Bands, shares of variance and probabilities of the critical speeds in *out by draws of what is uncertain; nothing where nothing
 * is. fit: of the unknowns of the machine (machine_fit), or NULL. Statuses of system_build; ROTID_ERROR_FINITE where the
 * covariance of the fit is none. */
int bands_make(struct pool *pool, struct search *search, const rotid_fit_result *fit, const struct speeds_options *options,
               const rotid_environment *environment, struct message_list *notes, rotid_speeds *out);

/* gradient [machine_unknowns * ncritical] := d ln W by the unknowns, by their logarithms where their lower bound is above zero; 0
 * of those that do not act in the machine. rest [ncritical^2], or NULL: covariance of ln W by bearings, losses, pull and changes,
 * in linear prediction. Statuses of bands_make. */
int bands_gradient(struct pool *pool, struct search *search, int ncritical, const struct critical *critical, double *gradient,
                   double *rest);

/* ------------------------------------------------------------------------------------------------ worth of a test at rest */

struct worth_options {
    int number, backward; /* of the critical speed, as of a run-up */
    double noise;         /* of the frequencies of a test, relative */
};

/* Tests at rest by how much they narrow a critical speed: fills speed_tests, speed_rpm, speed_std, speed_identified and sentence
 * of *out. x, fit as for speeds_run. Statuses of search_until, bands_gradient, model_open and the prediction;
 * ROTID_ERROR_ARGUMENT where there is no such critical speed, or nothing to be identified. */
int worth_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
              const rotid_fit_result *fit, const struct worth_options *options, struct message_list *notes,
              rotid_suggestion *out);

/* --------------------------------------------------------------------------------------------------------------- torsion */

/* The lowest torsional natural frequencies of the machine into *out: ntorsion 0 where the model has none. x, fit as for
 * speeds_run. ROTID_OK or ROTID_ERROR_MEMORY. */
int torsion_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
                const rotid_fit_result *fit, struct message_list *notes, rotid_speeds *out);

/* ---------------------------------------------------------------------------------------------------------------- run-up */

/* Measured critical speeds W^ as residuals (W - W^)/std of a fit of all states, over their unknowns and behind these the
 * machine's own: dW/dp by critical_rate. *joined: the states with both, which lean on *runup; as they are, and *runup NULL, where
 * nothing was measured or it is held out. Statuses of search_until, ROTID_ERROR_ARGUMENT where the model at its start has no such
 * critical speed; the list says why. runup_close in any case: it says whether an evaluation ran out of memory. */
struct runup;
int runup_join(struct pool *pool, const struct states *states, struct message_list *notes, struct states *joined,
               struct runup **runup);
int runup_close(struct runup *runup);

/* identify_states of these, without NLopt, from one to the other. */
int runup_identify(struct pool *pool, const struct states *states, const rotid_environment *environment,
                   struct message_list *notes, struct identification *out, rotid_fit_result **fit);

/* The measured critical speeds beside those of the model at x [machine_unknowns]; fit as for speeds_run. Statuses of search_until
 * and bands_gradient. */
int runup_compare(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
                  const rotid_fit_result *fit, struct message_list *notes, int *count, rotid_runup_speed **list);

/* The same of a diagnosis, held out: of a fit of states at rest with causes besides those of the deck, which go on in operation
 * but for supports and sensors of the test. */
int runup_explain(struct pool *pool, const struct states *deck, const struct states *states, const rotid_fit_result *fit,
                  struct message_list *notes, int *count, rotid_runup_speed **list);

/* What the measured critical speeds say of such an explanation: its posterior at rest, the normal about x with covariance C in
 * the unknowns u (ln x where the lower bound is above zero), is the prior; r = ln W^ - ln W(u) with the variance R of the
 * readings and of bearings, losses and pull, ln p(W^ | rest) = -(v'S^-1 v + ln det 2 pi S)/2,  S = G C G' + R,  v = r(u) + G (u -
 * u0),  G = d ln W/du, u := u0 + C G' S^-1 v,  C := C - C G' S^-1 G C, linear about u, which is repeated where the step moves a
 * critical speed by 2 % or more. Unknowns of the machine that were not fitted have the normal of the uniform prior between their
 * bounds, of the same density in the middle. mean, std [nown]: of the first unknowns of all states, at rest, and then with the
 * run-up. *chi2: v'S^-1 v. log_z -INFINITY, the others as they were, where the machine has no such critical speed. Statuses of
 * runup_compare; ROTID_ERROR_FINITE where S is none. */
int runup_learn(struct pool *pool, const struct states *deck, const struct states *states, const rotid_fit_result *fit, int nown,
                double *mean, double *std, double *log_z, double *chi2);

/* Critical speed map at the stiffness of a speed, K q = W^2 (M - P) q; (*vector)[row] [columns * nspeed_rpm] has the q. ROTID_OK
 * or ROTID_ERROR_MEMORY. */
int map_make(struct pool *pool, struct system *system, double speed, double most, rotid_speeds *out, double complex ***vector);

/* d ln W/dp of such a speed [rad/s], from two machines on the basis of the nominal one: q' (dK - W^2 d(M - P)) q over
 * 2 W^2 q' (M - P) q. */
double map_rate(const struct system *nominal, struct system side[2], double apart, double speed, const double complex *q);

#endif
