#ifndef ROTID_RUNNING_RUNNING_H
#define ROTID_RUNNING_RUNNING_H

/* Running: the machine in operation: critical speeds, stability, unbalance response, margins, with their bands.
 * In: struct machine (cards behind *RUNNING), the rotor of a job, the moduli with their covariance. Out: struct speeds.
 *
 * In the fixed frame, q = (x, y), W the speed from x to y:
 *   M q'' + (C_b + C_i + W [0 P; -P 0]) q' + (K + K_b + W [0 C_i; -C_i 0]) q = f
 *
 *   machine        machine.c (machine_rotor): the rotor of the test with what the machine has; bearing_at: tables over speed
 *   matrices       system.c (system_build): K, M, P, losses and pull by src/model, on a basis of modes at rest with the static
 *                  motions by forces at the bearings and by gyroscopic moments; system_at: C(W), K(W)
 *   eigenpairs     pairs.c: all pairs at one speed (quadratic_pairs); pair_refine: inverse iteration; pair_follow: to another
 *                  speed by the vector
 *   criticals      critical.c: Newton on Im lambda(W) = h W; onset of instability by bisection
 *   response       response.c: unbalance response, peaks, amplification by half power; sag and bearing loads
 *   bands          bands.c: derivatives by every uncertain number, by left and right vectors; draws from the posterior of the
 * fit, the bearings, losses, pull; every critical solved again all of it      speeds.c (speeds_run)
 *
 * Loss factors: x + iy = f e^{iwt} + conj(b) e^{-iwt}; the elastic K of the group is multiplied by 1 + i eta sgn(w - W) on f and
 * by 1 + i eta on b, sgn 0 = 0.
 *
 * Callers: deck fills struct machine; cli runs; result, report and page read struct speeds. Only model/model.h is asked for
 * matrices: the room must not know what discretises a rotor. */

#include <complex.h>

#include "base/base.h"
#include "linalg/linalg.h"
#include "model/model.h"
#include "rotid.h"
#include "rotor/rotor.h"
#include "run/run.h"

#define RPM 0.10471975511965978 /* rad/s */

/* --------------------------------------------------------------------------------------------------------------- machine */

enum { XX, XY, YX, YY }; /* of a bearing: forces -(k q + c q') by rows */

struct bearing {
    const char *name;
    double z;                  /* m */
    int like;                  /* whose draws it shares: its own index, or that of a bearing before */
    double std[2];             /* of ln of the factor on all of k, on all of c */
    int count;                 /* speeds of the table; 1: constants */
    double *speed;             /* [count] rad/s, increasing */
    double *k, *c;             /* [4 * count] N/m, N.s/m */
    int has_pedestal;          /* what carries it moves: */
    double m[2], kp[2], cp[2]; /* kg, N/m, N.s/m of the pedestal in x and y */
};

struct loss {           /* in the rotating part */
    int group, viscous; /* viscous: C = value [s] K; else loss factor [1] */
    double value, std;
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
};

struct probe {
    const char *name;
    double z, angle; /* m, rad from x to y */
};

/* What stands behind *RUNNING. */
struct machine {
    int nbearing, nloss, npull, nchange, nunbalance, nprobe;
    struct bearing *bearing;
    struct loss *loss;
    struct pull *pull;
    struct change *change;
    struct unbalance *unbalance;
    struct probe *probe;
    int without_sling;
    int *without_spring, *without_disk; /* [nspring], [ndisk] of the rotor at rest: 1 where it is gone */
    int ndisk;
    struct disk *disk; /* that the machine has beside those of the test */
    int has_operation;
    double low, high; /* rad/s: running range */
    double margin;    /* relative, required; 0: none stated */
};

/* The numbers that are uncertain: factors around the nominal values, all 1 there. */
struct machine_values {
    const double *x;                                      /* [nparameter] of the job */
    double *bearing_k, *bearing_c, *loss, *pull, *change; /* [nbearing] twice, [nloss], [npull], [nchange] factors */
};

/* The rotor of the machine at the values, springs of no stiffness where bearings, unbalances and probes are (behind those of the
 * rotor at rest, in this order). ROTID_OK or ROTID_ERROR_MEMORY. */
int machine_rotor(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                  struct rotor *rotor);

/* All factors 1 at x. ROTID_OK or ROTID_ERROR_MEMORY. */
int machine_nominal(struct pool *pool, const struct machine *machine, const double *x, struct machine_values *values);

/* Whether unknown p of the job acts in the machine: what it is of may have been left at the test. */
int machine_has_unknown(const struct machine *machine, const struct job *job, int p);

/* k, c [4] of a bearing at a speed [rad/s] >= 0, linear between those of its table, constant outside; their rates by speed, or
 * NULL. */
void bearing_at(const struct bearing *bearing, double speed, double k[4], double c[4], double dk[4], double dc[4]);

/* ---------------------------------------------------------------------------------------------------------------- system */

/* The matrices of a machine on a basis. A plane has `plane` unknowns, those of the basis and behind them the pedestals; size = 2
 * plane: those of x, then those of y. */
struct system {
    const struct machine *machine;
    const struct machine_values *values;
    int n, columns, plane, size;
    int naxis; /* places of the rotor where whirl is looked at */
    struct discrete discrete;
    rotid_matrix m;             /* of the full model */
    double *basis, *mass_basis; /* [n * columns] V with V' M V = 1, and M V */
    double *k, *p;              /* [columns^2] V' K V with springs and pull, V' P V */
    double **loss;              /* [nloss] [columns^2] elastic stiffness of each group */
    double *bearing;            /* [columns * nbearing] V' v of each bearing; of unbalances and probes likewise */
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
};

/* How large a basis is to be. */
struct basis_size {
    int modes;   /* at rest */
    int coupled; /* of them, those whose gyroscopic moments have a static motion in the basis */
    int all;     /* nonzero: the forces of pull and losses as well, which leave 1e-11 of a critical speed in place of 1e-7 */
};

/* built: NULL, or the same machine at other values, whose mesh serves; with basis NULL its basis too. Statuses of discrete_build,
 * *failed likewise; ROTID_ERROR_STIFFNESS where nothing holds the rotor; ROTID_ERROR_MASS, ROTID_ERROR_EIGEN. */
int system_build(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
                 const struct system *built, const struct basis_size *basis, struct system *system, int *failed);

/* C, K and their rates at a speed [rad/s]. */
void system_at(struct system *system, double speed);

/* a [size^2] := lambda^2 M + lambda C + K at that speed; side: sgn(w - W), of the loss factors. */
void system_dynamic(const struct system *system, double complex lambda, int side, double complex *a);

struct pair;

/* The pair of one system on the basis of another one of the same mesh: u := V' M u_full. Without left vector. Returns 0, or 1
 * where the vectors of the other one have lost more than a tenth of it. */
int system_transfer(const struct system *from, const struct pair *pair, const struct system *to, struct pair *there);

/* ----------------------------------------------------------------------------------------------------------------- pairs */

struct pair {
    double complex lambda;
    double complex *u, *left; /* [size] u'u = 1; left: u* D = 0 from the left, in any scale */
};

int pair_new(struct pool *pool, int size, struct pair *pair);
void pair_copy(int size, const struct pair *from, struct pair *to);

/* All pairs with Im lambda > 0 and not overdamped at a speed, by rising Im lambda: *count of them into pair [size], which are
 * there; without loss factors. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int pairs_all(struct pool *pool, struct system *system, double speed, int *count, struct pair *pair);

/* The pair near `pair` at the speed of system_at, by inverse iteration with the nonlinear D: quadratic. side: NULL, chosen by Im
 * lambda against `at`, or a pointer to the side to take. Returns 0, or 1 without convergence. */
int pair_refine(struct system *system, double at, const int *side, struct pair *pair);

/* The left vector of a pair that has converged, at the speed of system_at. Returns 0, or 1 where D is singular to the last bit.
 */
int pair_left(struct system *system, int side, struct pair *pair);

/* The speed near *speed where Im lambda = h W of a mode, and its pair there, by Newton on both together, quadratic; side 0. The
 * left vector is workspace. Returns 0, or 1 without convergence. */
int pair_synchronise(struct system *system, double h, double *speed, struct pair *pair);

/* The same mode at another speed in `least` steps or more: they are halved until the vector of one is that of the other. Returns
 * 0 or 1. */
int pair_follow(struct system *system, double from, double to, int least, struct pair *pair);

/* d lambda/dW at the speed of system_at; the pair has its left vector. */
double complex pair_rate(const struct system *system, const struct pair *pair);

/* l* A u/(l* dD/dlambda u) for the product A u [size] */
double complex pair_share(const struct system *system, const struct pair *pair, const double complex *product);

enum whirl { WHIRL_BACKWARD, WHIRL_MIXED, WHIRL_FORWARD };
extern const char *const whirl_words[];
enum whirl pair_whirl(const struct system *system, const double complex *u);

/* --------------------------------------------------------------------------------------------------------------- results */

/* of a critical speed to the running range */
struct margin {
    double value;   /* (low - W)/low below the range, (W - high)/high above it, below 0 inside [1]; by the speed of the peak where
                       there is one; null of backward whirl, without a peak beside others and without a range */
    double ci95[2]; /* 95 % interval of value [1] */
    double required;    /* what the deck requires of value [1]; null where it states nothing */
    double probability; /* that value is at least what is required [1]; null without bands */
};

/* of the unbalance response at a probe, nearest to a critical speed */
struct peak {
    const char *probe;    /* its name */
    double speed_rpm;     /* of the peak [rpm] */
    double amplitude_m;   /* zero to peak [m] */
    double amplification; /* speed over the width at 0.707 of the peak [1]; null where another peak is nearer than that */
};

/* of one source of doubt */
struct variance_share {
    const char
        *source;  /* identified (all unknowns of the fit together), bearing NAME, loss GROUP, pull GROUP, change PARAMETER */
    double share; /* in the variance of the linear prediction [1] */
};

struct critical_speed {
    int number;           /* from 1, by rising speed */
    int mode;             /* of the Campbell diagram, from 1 */
    double speed_rpm;     /* where Im lambda is harmonic times the speed [rpm] */
    double std;           /* standard deviation of speed_rpm by draws [rpm]; null without uncertain numbers */
    double ci95[2];       /* 95 % interval of speed_rpm by draws [rpm] */
    const char *whirl;    /* backward, mixed (the orbits along the rotor differ) or forward */
    double log_decrement; /* there, without the jump of loss factors [1] */
    double damping_ratio; /* there, the same of critical damping [1] */
    double amplification; /* largest of the peaks [1]; null where none is known */
    struct margin margin; /* to the running range */
    int npeaks;
    struct peak *peaks; /* of the unbalance response, by probe */
    int nvariance_shares;
    struct variance_share *variance_shares; /* where the doubt of speed_rpm comes from */
    int nz;
    double *z;    /* places along the axis [m] */
    double *x_re; /* shape at each z: real part of the motion in x, largest component 1 [1] */
    double *x_im; /* imaginary part of it [1]; the motion is Re (x e^iwt) */
    double *y_re; /* real part of the motion in y, upwards [1] */
    double *y_im; /* imaginary part of it [1] */
};

struct campbell_mode {
    int mode;             /* from 1, of one mode over all speeds */
    double frequency_hz;  /* |Im lambda|/2 pi in the fixed frame [Hz] */
    double ci95[2];       /* 95 % interval of frequency_hz by the linear prediction [Hz]; null without uncertain numbers */
    double damping_ratio; /* -Re lambda/|lambda| [1]; below 0 the mode grows */
    double log_decrement; /* [1] */
    const char *whirl;    /* backward, mixed or forward */
};

struct campbell_speed {
    double speed_rpm; /* [rpm] */
    int nmodes;
    struct campbell_mode *modes; /* by rising frequency; overdamped ones are left out */
};

struct stability {
    double onset_rpm;          /* lowest speed from which a mode grows [rpm]; null: none up to the highest one computed */
    int mode;                  /* which, of the Campbell diagram */
    double probability_stable; /* that no mode grows at the highest running speed [1]; null without bands or range */
};

struct probe_response {
    const char *probe; /* its name */
    int nspeed_rpm;
    double *speed_rpm;   /* [rpm] */
    double *amplitude_m; /* at each speed, zero to peak [m] */
    double *phase_deg;   /* at each speed: lag behind the mark at angle 0, 0 to 360 [deg] */
};

struct bearing_load {
    const char *bearing; /* its name, null where it has none */
    double position_m;   /* from the left end [m] */
    double load_x_n; /* force of the weight on the bearing in x, at the lowest running speed or the highest one computed [N] */
    double load_y_n; /* the same in y, upwards [N] */
};

struct map_row {
    double stiffness_factor; /* on the stiffness of all bearings [1] */
    int nspeed_rpm;
    double *speed_rpm; /* undamped forward critical speeds with the mean of both direct stiffnesses [rpm] */
};

struct speeds {
    double low_rpm;     /* lowest running speed [rpm]; null where no range is stated */
    double high_rpm;    /* highest running speed [rpm] */
    double harmonic;    /* excitation per revolution that the critical speeds are of [1] */
    int draws;          /* of the bands; 0: nothing is uncertain */
    double basis_error; /* largest relative change of a critical speed by half as large a basis again [1] */
    int ncritical_speeds;
    struct critical_speed *critical_speeds; /* by rising speed */
    struct stability stability;             /* whether a mode grows */
    int ncampbell;
    struct campbell_speed *campbell; /* modes over the speed */
    int nunbalance;
    struct probe_response *unbalance; /* response at each probe */
    double weight_n;                  /* of the rotor [N] */
    double sag_m;                     /* largest deflection by it, with that of the bearings [m] */
    int nbearing_loads;
    struct bearing_load *bearing_loads; /* by weight */
    int nmap;
    struct map_row *map; /* critical speed map: over the stiffness of the bearings */
};

/* What is computed beside the machine. */
struct speeds_options {
    double from, to; /* rad/s; to = 0: by the running range, else to beyond the third critical speed */
    int count;       /* speeds of the Campbell diagram */
    double harmonic; /* 1: synchronous */
    int draws;       /* of the bands; 0: none */
    unsigned long seed;
    int threads; /* of the draws; the result does not depend on it */
};

/* x [nparameter] of the job; fit: of the unknowns, or NULL: they are taken as known. Reasons and notes go to the list. ROTID_OK;
 * ROTID_ERROR_STIFFNESS where bearings do not hold the rotor or the pull is stronger; ROTID_STOP_CANCELLED: all but the bands is
 * there; statuses of system_build, pairs_all. */
int speeds_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
               const rotid_fit_result *fit, const struct speeds_options *options, const rotid_environment *environment,
               struct message_list *notes, struct speeds *out);

/* ------------------------------------------------------------------------------------------- tracks, criticals, response */

/* The modes over the speeds of a Campbell diagram. */
struct tracks {
    int nspeed, nmode, room;
    double *speed;     /* [nspeed] rad/s */
    struct pair *pair; /* [nspeed * room], those of a mode one behind the other; lambda NaN where the mode is not there */
};

/* Follows the modes up to Im lambda = limit at the first speed, and those below at the last one that are not among them. Statuses
 * of pairs_all. */
int tracks_make(struct pool *pool, struct system *system, int nspeed, const double *speed, double limit, struct tracks *tracks);

struct pair *track_at(const struct tracks *tracks, int mode, int speed);

struct critical {
    double speed; /* rad/s */
    int mode;     /* of the tracks */
    struct pair pair;
};

/* Every place where Im lambda crosses h W, by rising speed. ROTID_OK or ROTID_ERROR_MEMORY. */
int criticals_find(struct pool *pool, struct system *system, const struct tracks *tracks, double h, int *count,
                   struct critical **critical);

/* The lowest speed from which a mode grows, NaN: none; *mode of the tracks. */
double onset_find(struct system *system, const struct tracks *tracks, int *mode);

/* What of |lambda| counts as growth: below is rounding. */
#define GROWS 1e-9

/* q [size] of the unbalance at a speed: D(i W) q = W^2 f. Returns 0, or 1 where D is singular. */
int response_at(struct system *system, double speed, double complex *q);

/* Motion of a probe: x cos a + y sin a. */
double complex probe_motion(const struct system *system, int probe, const double complex *q);

/* The peak of a probe near a speed within [from, to]. Returns 0, or 1 where the response has none there. */
int response_peak(struct system *system, int probe, double from, double near, double to, struct peak *peak);

/* Weight, sag and loads at a speed into *out. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_STIFFNESS. */
int static_loads(struct pool *pool, struct system *system, double speed, struct speeds *out);

/* (low - W)/low below the running range, (W - high)/high above it, below 0 inside. */
double speeds_margin(const struct machine *machine, double speed);

/* Bands, shares of variance and probabilities of the critical speeds in *out by draws of what is uncertain; nothing where nothing
 * is. nominal: at the values, with its basis of that size. Statuses of system_build; ROTID_ERROR_FINITE where the covariance of
 * the fit is none. */
int bands_make(struct pool *pool, const struct machine *machine, const struct job *job, const struct machine_values *values,
               const rotid_fit_result *fit, const struct speeds_options *options, const rotid_environment *environment,
               struct system *nominal, const struct basis_size *basis, const struct tracks *tracks, int ncritical,
               const struct critical *critical, struct message_list *notes, struct speeds *out);

/* Critical speed map at the stiffness of a speed. ROTID_OK or ROTID_ERROR_MEMORY. */
int map_make(struct pool *pool, struct system *system, double speed, double most, struct speeds *out);

#endif
