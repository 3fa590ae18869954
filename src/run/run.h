#ifndef ROTID_RUN_RUN_H
#define ROTID_RUN_RUN_H

/* Run: what the commands compute from a job. A job (struct job) is a deck resolved to numbers: rotor, measurement, unknowns,
 * options; a deck with several measurements is a job a state over common unknowns (struct states). job.c.
 * In: job or states. Out: plain structs (spectrum, comparison, identification, ...), which src/api makes the results of rotid.h.
 *
 *   modes            spectrum.c (spectrum_compute): full and condensed frequencies, mesh error by two meshes (Richardson)
 *   numbers          numbering.c (numbering_choose): whether modes on the supports were counted; numbering_search: modes missed
 *   ends             numbering.c (exchange_warn): two bearings of a symmetric rotor that frequencies do not tell apart
 *   pairing          compare.c (comparison_make): partner of each measured mode by NCO or number, MAC
 *   identification   identify.c (identify_run, identify_states): pair, fit by rotid_fit_states, pair again, at most 3 times
 *   mesh             identify.c (mesh_of_fit): a solid is fitted on the coarse mesh, f = rho_j f_coarse with rho_j held;
 *                    spectrum.c (mesh_choose): elements of sections without a number, from the noise of the frequencies
 *   frequency and its standard deviation of a mode read at several sensors   point_fit.c (point_mean): weighted regression
 *                    f_j = c + b shape_j^2; point_fit, point_drop_outliers
 *   transfer functions   frf_run.c (frf_run): H = s^q [sum phi_i phi_j/(lambda + s^2 + 2 zeta w s) + R + (c - s^2) R']
 *                    of the modes and of those left out; compare.c: FRAC, scale, level
 *   sensitivity      sensitivity.c (sensitivity_run): E_k over steps (29), d ln f/d ln x; growth_run: growth of the functionals
 *   pictures, checks mode_shapes.c; beside.c (beam_vs_solid_make): beam beside solid; job.c (check_units): wrong units
 *
 * Callers: deck (fills jobs), diagnose, suggest, api, cli, study; result, report, page, export read the structs. The room must
 * not read files, nor know the text of decks, the catalogue of causes (a cause is an effect of the rotor here) or printing. */

#include "modal/modal.h"
#include "model/model.h"
#include "record/record.h"
#include "rotor/rotor.h"
#include "signal/signal.h"

/* ------------------------------------------------------------------------------------------------------------------- job */

/* A job: what a deck says, resolved to numbers and indices. Filled by src/deck, or by anybody who has the data in another form.
 */

/* A fault of the measurement chain, as a CAUSE card states it or the diagnosis finds it: see the causes of that class. */
struct correction {
    const char *name, *id;  /* of the card; of the cause: "sensor_gain" */
    int nsensor, sensor[2]; /* ids */
    const char *block;      /* noise_level: "SHAPE" or "FREQUENCY", else NULL */
    double value;           /* gain, shift [m], factor; 1 where the cause has none */
    double more[2];         /* of sensor_line behind its shift: scale, flip */
};

/* A candidate that the user wants judged: an effect of which some parameters are fixed and the others are searched. */
struct suspect {
    struct effect effect;
    int fixed[EFFECT_MOST_PARAMETERS];
};

/* The measured data as they were read, where corrections have been applied to those of the job. */
struct job_raw {
    int nsensor;
    struct sensor *sensor;
    double *shape, *shape_std, *frequency_std;
    double *point_frequency_hz, *point_frequency_std;
};

struct frf_pair { /* a transfer function: ids of sensors, or of nodes of the measured file */
    int response, reference;
};

/* Which transfer functions are to be synthesised: the FRF card. What it leaves open is settled by frf_run. */
struct frf_request {
    int given;                       /* nonzero: the deck has the card */
    const char *file;                /* absolute path of the measured ones, NULL where there are none */
    double low_hz, high_hz, step_hz; /* 0: not stated */
    int nline;                       /* 0: not stated */
    int has_quantity;                /* 0: that of the file, else acceleration */
    enum frf_quantity quantity;
    double damping; /* ratio of modes without a measured one, 0: not stated */
    int axis, flip; /* of the nodes of the file: z = origin + c, with flip origin - c, c coordinate 0, 1 or 2 [m] */
    double origin;
    int npair; /* 0: all of the file, or every sensor over the first */
    struct frf_pair *pair;
};

/* From which mode of the model the measured ones are counted, and how well that fits at the values of the deck. */
struct numbering {
    int nsupport; /* vibrations of the rotor on its supports, above 0 Hz, that ELASTIC does not count; 0: nothing to choose */
    int stated;   /* by COUNT */
    /* root mean square over the measured modes of ln(f~/f) and 1 - MAC with the partner by number; NaN where COUNT is stated */
    double elastic, all;
};

/* The rotor on scales [kg, m from the left end]; a deviation of 0: not measured. */
struct weighed {
    double mass, mass_std, centre, centre_std;
};

#define ANOTHER_MASS 3 /* standard deviations: beyond, the model has another mass than the rotor */

/* What was measured, as it is judged: the corrections are applied already. */
struct job_measurement {
    int nmode;
    int *number;           /* [nmode] elastic mode of the model, from 1; the shapes may decide otherwise */
    int paired;            /* they may not: the numbers are settled */
    double *frequency_hz;  /* [nmode] */
    double *damping;       /* [nmode] ratio, NaN where there is none */
    double *frequency_std; /* [nmode] relative, NaN where there is none; the NOISE card is already applied */
    double *shape;         /* [nsensor * nmode] NaN where not measured, or NULL */
    double *shape_std;     /* [nsensor * nmode] relative to the largest component, NaN where there is none; or NULL */
    double stated_frequency_noise, stated_shape_noise; /* of the NOISE card for all modes, relative; 0: not stated */
    int has_noise_floor; /* the user allows for more than the scatter of the test: that is not taken for overstated noise */
    int *holdout;        /* [nmode] */
    struct numbering numbering;
    /* With the accelerometer at one sensor after the other, [nsensor * nmode] in Hz, NaN where not known; NULL where the deck has
     * none. frequency_hz of a mode that has any is then their mean over all sensors: see point_mean. */
    double *point_frequency_hz, *point_frequency_std;
    struct weighed weighed;
    int hammer; /* id of the sensor beside the hammer while that accelerometer went round, 0 where not known */

    int ncorrection; /* raw is NULL where there are none */
    struct correction *correction;
    struct job_raw *raw;
};

/* What is searched. */
struct job_unknowns {
    int nparameter;
    struct parameter *parameter; /* [nparameter] */
    rotid_parameter *bounds;     /* [nparameter] with name and unit */
    int nsuspect;                /* CAUSE cards with SUSPECT: candidates for `diagnose`, no part of the model */
    struct suspect *suspect;
};

/* How the commands are to go about it. */
struct job_options {
    int has_fit; /* a FIT card states functional or reduction */
    rotid_fit_options fit;
    int solid;           /* the rotor as a solid of revolution, not as a beam */
    enum mode_type type; /* of the modes */
    struct frf_request frf;
};

/* Where a deck states something. */
struct place {
    const char *file;
    int line, column;
};

/* The units that the deck states numbers in, in SI; 0: SI. The job itself is in SI. */
#define JOB_QUANTITIES 8
struct job_units {
    double si[JOB_QUANTITIES];      /* of each quantity of *UNITS, in the order of src/deck */
    const char *length, *frequency; /* names of the first and the last one as people write them; NULL: m, Hz */
};

/* "700 mm", "20 GPa": a value in SI with so many digits, in the unit of the deck where it is a length or a frequency, a modulus
 * with its prefix. unit: of the value, "1" for a pure number. "" where memory is out, as the pool says. */
const char *job_value_text(struct pool *pool, const struct job_units *units, int digits, double value, const char *unit);

struct deck_origin;

/* Four things that change for different reasons, each a struct of its own: the rotor (a cause is added to it), what was measured
 * (the measurement chain is corrected, a mode is left out), what is searched (a cause brings its parameters, a refit other
 * starts) and the options. A second state of the same rotor is a second measurement; another model is another option. */
struct job {
    const char *deck; /* path as given */
    int nfile;
    const char *const *file; /* what it was read from: the deck, files it includes, measured data it names */
    int nheading;
    const char **heading; /* lines of text without the references */
    int nreference;
    rotid_reference *reference; /* lines "paper error_percent = -3.83, 8.38, ..." of the heading */

    struct rotor rotor;
    const struct place *part; /* [ngroup + ntierod + nbars + nsensor] of the rotor, or NULL where nobody stated them */
    double mesh_error;     /* relative, of the measured modes, of the elements that were chosen where none are stated; 0: all are
                              stated */
    struct place measured; /* card of the measured modes, file NULL where there is none */
    struct models *models; /* of it, as far as they are built, or NULL */
    const struct held_modes *held; /* what fits of the rotor as a solid hold their mesh to (mesh_hold), or NULL */
    struct job_measurement measurement;
    struct job_unknowns unknowns;
    struct job_options options;
    struct job_units units;
    const struct deck_origin *origin; /* the texts that it was read from, of src/deck; NULL where nobody read it */
};

/* Where the deck states what discrete_build refused with this *failed: the first group for the rotor as a whole, the first line
 * of the deck where nobody stated parts. */
struct place job_part_place(const struct job *job, int failed);
struct place job_sensor_place(const struct job *job, int sensor);

/* How its modes are computed. */
enum discretisation job_discretisation(const struct job *job);
/* The same job in another motion: what was measured in a motion is left out where it is another one. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int job_of_type(struct pool *pool, const struct job *job, enum mode_type type, struct job *other);

/* Whether the noise of every measured frequency, and of every shape component, is known. */
int job_knows_frequency_noise(const struct job *job);
int job_knows_shape_noise(const struct job *job);
/* Whether a likelihood can use shapes: there are some, with their noise. */
int job_fits_shapes(const struct job *job);

/* The rotor as a beam beside the same rotor as a solid of revolution: their modes, and what a beam that is fitted to the solid
 * would take its moduli for. At the values x [nparameter] of the parameters of the job; nmode modes as far as both have them.
 * Without sensors the shapes are compared at nodes of the beam. ROTID_OK; ROTID_ERROR_SECTION with an error in the list where a
 * part of the rotor has no meaning in one of the two; statuses of spectrum_compute, comparison_make and rotid_fit. */
int beam_vs_solid_make(struct pool *pool, const struct job *job, const double *x, int nmode, const rotid_environment *environment,
                       struct message_list *notes, rotid_beam_beside_solid **beside);

/* -------------------------------------------------------------------------------------------------------------- spectrum */

/* The modes of a rotor with the errors of their numbers: full model, condensed model, mesh error. */

struct spectrum {
    int nrigid, count, nmaster;      /* count: elastic modes */
    int nnode;                       /* of the axis */
    double *rigid_hz;                /* [nrigid] */
    double *full_hz;                 /* [count] of a solid, with SPECTRUM_MESH, the limit that two meshes lead to */
    double *reduced_hz;              /* [count] NaN where the masters are too few, or more than 1000 */
    double *reduction_error_percent; /* [count] reduced against full */
    double *other_hz;                /* [count] by a mesh that is refined, of a solid by the coarse one; NaN without */
    double *mesh_error_percent; /* [count] of the mesh against that limit; a solid's full_hz may be off by as much, either way;
                                  NaN where the meshes differ too much for a limit */
    int apart;                  /* of a solid: the first mode, from 1, without a limit for that reason; 0: none */
    double *shape;              /* [nmaster * count] full model at the masters, largest component 1 */
    double *other_shape;        /* the same of the mesh of other_hz; NULL without, and where that has other masters */
    double *mass;     /* [nmaster * nmaster] condensed by Guyan, NULL where that is impossible or there are more than 1000 */
    double *master_z; /* [nmaster] m */
    const struct rotor_model *model; /* the full one: its rotor at x with the end springs of a sling */
    const double *phi;               /* [model->equations.n * count] its mass-normalised vectors */
};

/* At the values x [nparameter] of the parameters; fewer than `count` modes where the model has fewer. reduction: ROTID_GUYAN or
 * ROTID_IRS. Statuses of the prediction and of model_open. */
int spectrum_compute(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                     const struct parameter *parameter, const double *x, int reduction, int count, struct spectrum *spectrum);

/* The same with the parts that are wanted alone; the others are NaN or NULL. */
enum spectrum_part {
    SPECTRUM_MESH = 1,    /* other_hz, other_shape, mesh_error_percent: a second mesh, for a beam half of the time */
    SPECTRUM_REDUCED = 2, /* reduced_hz, reduction_error_percent */
    SPECTRUM_COARSE = 4,  /* of a solid: on the coarse mesh */
    SPECTRUM_MASS = 8,    /* mass */
    SPECTRUM_WHOLE = SPECTRUM_MESH | SPECTRUM_REDUCED | SPECTRUM_MASS
};
int spectrum_compute_parts(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                           const struct parameter *parameter, const double *x, int reduction, int count, int parts,
                           struct spectrum *spectrum);

/* The same of a job, with the condensation of its FIT card, else Guyan's, at the values x [job.unknowns.nparameter]. */
int job_spectrum(struct pool *pool, const struct job *job, const double *x, int count, int parts, struct spectrum *spectrum);

/* Of the full model alone, vectors good to 1e-4 and frequencies to the square of it: one of many trials. near: NULL, or the
 * spectrum of a model that is nearly this one, whose modes it begins with. */
int spectrum_try(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                 const struct parameter *parameter, const double *x, int count, const struct spectrum *near,
                 struct spectrum *spectrum);

/* NCO of a measured shape [nmaster] with mode j of the full model by the condensed mass; MAC where there is no such matrix.
 * work [nmaster]. */
double spectrum_correlation(const struct spectrum *spectrum, const double *shape, int j, double *work);

/* --------------------------------------------------------------------------------------------------------------- compare */

/* The measured modes of a job beside those of its model: the partner of each, and the modes without one. */

struct comparison {
    int nmode;                 /* measured */
    int *number;               /* [nmode] mode of the model, from 1 */
    enum pairing_basis *basis; /* [nmode] */
    double *mac, *nco;         /* [nmode] with that partner, NaN without a shape */
    int clash;                 /* UNPAIRED: the measured mode whose number another one's shape claims */
};

/* Highest mode number of the measured modes, and the modes of the model that a comparison looks through. */
int comparison_highest(const struct job *job);
int comparison_candidates(const struct job *job);

#define NUMBERING_CLEAR 0.5 /* the better numbering has less than this share of the misfit of the other */

/* Chooses job->rotor.count_all where the deck does not state it (numbering.stated), from its measured modes at the values of the
 * rotor: ALL where that has less than NUMBERING_CLEAR of the misfit of ELASTIC, else ELASTIC. A rotor whose vibrations on its
 * supports are none, or bend it, has one numbering. By beams, whatever the job says. ROTID_OK or ROTID_ERROR_MEMORY. */
int numbering_choose(struct pool *pool, struct job *job);

/* Pairs by the shapes where they can tell, else by number. Notes say which modes look like no mode of the model, which modes of
 * the model nobody measured, and which pairings the shapes changed. ROTID_OK, MEMORY or UNPAIRED (two modes claim one partner;
 * the notes say which). */
int comparison_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, struct message_list *notes,
                    struct comparison *comparison);

/* What the rotor weighs into *measured, by motions of its model. ROTID_OK or ROTID_ERROR_MEMORY. */
int measured_whole(struct pool *pool, const struct job *job, const struct rotor_model *model, rotid_measured *measured);

/* Warns where the mesh moves a measured mode by more than the noise of its frequency, on a solid by more than a third: the
 * intervals rest on the noise alone. */
void comparison_warn_of_mesh(const struct job *job, const struct spectrum *spectrum, const struct comparison *comparison,
                             struct message_list *notes);

/* ----------------------------------------------------------------------------------------------------------------- doubt */

/* Doubts about a measurement that only the model can raise. */

/* Whether the measured frequencies are all the same number times those of the model at its stated values, by mode numbers, and
 * that number is one of a mistaken unit: 2 pi, 1000, the root of 1000, or one over these. Returns it, 0 where
 * there is none. What is said of it goes to notes, as an error at the deck's first line where it is `refused`, else as a warning.
 */
double check_units(const struct job *job, const struct spectrum *spectrum, int refused, struct message_list *notes);

/* What a beam gets wrong at the steps of the diameter, where it is 1 % of a frequency or more and the job, a beam, has no effect
 * on its sections that repairs it; else NULL, as without memory. */
const char *doubt_steps(struct pool *pool, const struct job *job);

/* Where the eigenvalue problem of the job failed (ROTID_ERROR_EIGEN, _STIFFNESS, _MASS, _SLAVE) and no error says why: an error
 * with the place of the softest section, and the stiffest element where the two are far apart, or the densest group where
 * another one is far lighter. Nothing for other statuses. */
void check_sections(const struct job *job, int status, struct message_list *notes);

/* --------------------------------------------------------------------------------------------------------- frf agreement */

/* How far synthesised transfer functions are from measured ones. */

/* Sums over lines, and over functions where they are added up: H^ measured, H synthesised. Begin with zeros. */
struct frf_sums {
    double complex cross;         /* sum conj(H) H^ */
    double complex conjugate;     /* sum H H^ */
    double measured, synthesised; /* sum |H^|^2, sum |H|^2 */
    long long lines;
};

/* Adds n lines; those where H^ or H is not finite are left out. */
void frf_sums_add(struct frf_sums *sums, int n, const double complex *measured, const double complex *synthesised);

/* Frequency response assurance criterion |sum conj(H^) H|^2/(sum |H^|^2 sum |H|^2) in [0, 1]; NaN where one of them vanishes.
 * Free of scale and sign. */
double frf_sums_frac(const struct frf_sums *sums);

/* The same with the conjugate of H: higher where the measurement has the other sign of time. */
double frf_sums_frac_conjugate(const struct frf_sums *sums);

/* Real a of least sum |H^ - a H|^2: 1 for the same mass and sign, below 0 where the sign of one direction is the other one. */
double frf_sums_scale(const struct frf_sums *sums);

/* Level of H^ over H, 10 log10(sum |H^|^2/sum |H|^2) [dB]. */
double frf_sums_level(const struct frf_sums *sums);

/* ---------------------------------------------------------------------------------------------------------------- states */

/* The states of a deck: a structure that was measured more than once is a job for each time, complete by itself, over unknowns
 * that they share. What works on one job works on that of one state. */

struct machine;

struct state {
    const char *name; /* NULL in a deck without *STATE */
    struct job job;
    int ncommon;  /* the first of its unknowns: those of the common cards */
    int *unknown; /* [job.unknowns.nparameter] which of the unknowns of all states each of its own is;
                     NULL: the first ones */
};

struct states {
    int nstate;
    struct state *state; /* [nstate] at least one; several have the same options but for transfer functions */
    int nparameter;
    rotid_parameter *bounds; /* [nparameter] those of the common cards, then those of each state alone, "bearings:front.k" */
    const struct machine *machine; /* the rotor in operation, of src/running, or NULL */
    const struct joint_more *more; /* residuals of that beside those of the modes (runup_join), or NULL */
};

/* A job as the only state, at *state, which has no name. Leans on both. */
struct states states_of(const struct job *job, struct state *state);

/* Which of the unknowns of all states unknown q of a state is. */
int state_unknown(const struct state *state, int q);

/* The values of the unknowns of a state [job.unknowns.nparameter] among the values x of those of all. NULL where memory is out.
 */
double *state_values(struct pool *pool, const struct state *state, const double *x);

/* How many of its measured modes are not held out; holdout [nmode] */
int job_fitted(const struct job *job, const int *holdout);

/* Measured modes of the first `count` states. */
int states_modes(const struct states *states, int count);

/* *to := the same states in an array of its own, whose jobs can be changed. `to` may be the states themselves. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int states_copy(struct pool *pool, const struct states *from, struct states *to);

/* Says, as an error, that somebody who works on one state has been given several. */
void states_refuse(const struct states *states, const char *deck, struct message_list *notes);

/* An error in the list, and ROTID_ERROR_ARGUMENT, where a state is not of bending and `what` ("a diagnosis") is of bending alone.
 */
int states_refuse_types(const struct states *states, const char *what, struct message_list *notes);

/* -------------------------------------------------------------------------------------------------------------- identify */

/* Identification of a job: pairing, fit, pairing again at the fitted model, and the errors of the numbers. */

struct identification {
    rotid_fit_result *fit;      /* to be freed with rotid_fit_free */
    struct comparison compared; /* at the fitted model */
    struct spectrum spectrum;   /* of the fitted model */
    int shapes_fitted;          /* they took part in the residual or in the quotient */
    struct mass_properties mass;
    double *baseline_hz;           /* [nmode * fit->nbaseline] predicted at the points of NLopt, NaN where there is no model */
    const struct held_modes *held; /* of a solid: what the last fit held its mesh to, from there on */
};

/* One fit of several states together with the pairing number and the modes holdout left out, [nmode] of all one behind the other;
 * no notes, no spectrum, no progress, no NLopt; nothing of it stays on the pool. ROTID_STOP_CANCELLED without a fit; statuses of
 * rotid_fit and model_open. */
int identify_fit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                        const rotid_fit_options *options, const rotid_environment *environment, rotid_fit_result **fit);

/* Its pairing, as found [nstate] has it: *number and *holdout on the pool. ROTID_OK or ROTID_ERROR_MEMORY. */
int identify_numbers(struct pool *pool, const struct states *states, const struct identification *found, int **number,
                     int **holdout);

enum {
    IDENTIFY_BASELINE = 1, /* NLopt as well */
    IDENTIFY_BARE = 2 /* without the errors of the numbers, mesh_error_percent and, without shapes, the condensed model of the
                         spectrum: for many runs of one deck */
};

/* Over the states of a deck: out [nstate], each with the fit as its state sees it, all unknowns but its modes and residuals
 * alone, chi2 of these. *fit: of all, to be freed with rotid_fit_free, in place of those. With nothing to identify the model is
 * compared as it stands. how: bits of these. Notes and reasons go to the list. Statuses of rotid_fit and of comparison_make,
 * ROTID_ERROR_ARGUMENT where nothing is measured (the list says so). */
int identify_states(struct pool *pool, const struct states *states, int how, const rotid_environment *environment,
                    struct message_list *notes, struct identification *out, rotid_fit_result **fit);

/* The same of a deck that has one state. */
int identify_run(struct pool *pool, const struct job *job, int how, const rotid_environment *environment,
                 struct message_list *notes, struct identification *out);

/* The fit that identify_states left in `out` of a state, for those that work on its job: of its own unknowns alone, n, x, std,
 * limits, at_bound and identifiable in the order of the job; without what goes over pairs of them. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int identify_own_unknowns(struct pool *pool, const struct state *state, struct identification *out);

/* Warns where the condensed model that was fitted has other frequencies than the full one, of which `what` is said: "written". */
void identify_warn_of_reduction(const struct job *job, const struct identification *result, const char *what,
                                struct message_list *notes);

/* Another numbering of the modes of a state without shapes: those from `from` on have numbers that are `shift` higher, all of
 * them ones that are lower. */
struct renumbering {
    int state, from, shift; /* shift 0: there is none */
    int *number;            /* of all states, one behind the other */
    double chi2;            /* twice the objective with it, fitted */
};

/* The one of least chi2 among shifts by up to 3 of the modes of each state without shapes, `number` being those of all states,
 * and the states started where the fits are to begin. Fits only those whose frequencies, to first order in ln x about the start,
 * come nearer than those of `number`; shift 0 where there is none. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
int numbering_search(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                     const rotid_environment *environment, struct renumbering *best);

/* "from measured mode 5 (2350 Hz) on the numbers are 1 too low: modes were missed below it" [, of state b] */
const char *numbering_text(struct pool *pool, const struct states *states, const struct renumbering *renumbering);

/* Warns where the fit, of these states without shapes, leaves a misfit that a renumbering takes to less than NUMBERING_CLEAR^2 of
 * it; of beams alone, whose fits cost little. ROTID_OK, or as numbering_search. */
int numbering_warn(struct pool *pool, const struct states *states, const struct identification *found,
                   const rotid_fit_result *fit, const rotid_environment *environment, struct message_list *notes);

/* Warns of two unknowns of one kind (front.k, back.k) whose fitted values are clearly apart and, exchanged, fit as well: a fit
 * started there ends within 1 of chi2 (times chi2 over dof above 1; objective within a tenth where the noise is unknown). Of
 * states without fitted shapes and of beams, whose fits cost little, up to six pairs. found [nstate], fit: of these states.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int exchange_warn(struct pool *pool, const struct states *states, const struct identification *found, const rotid_fit_result *fit,
                  const rotid_environment *environment, struct message_list *notes);

/* ------------------------------------------------------------------------------------------------------------- synthesis */

/* Transfer functions of a model by superposition of its modes. With s = decay + i omega, phi mass-normalised, lambda = w^2,
 *
 *     H_ij(s) = s^q [ sum_r phi_ir phi_jr/(lambda_r + s^2 + 2 zeta_r w_r s) + R_ij + (c - s^2) R'_ij ],  q = 0, 1, 2
 *
 * for the displacement, velocity or acceleration at i per force at j. R and R' stand for the modes that are left out: value and
 * slope of their undamped sum at s^2 = c, exact there but for rounding, so that what is missing elsewhere is of the second order
 * in (s^2 - c)/lambda of the first mode left out. */

#define SYNTHESIS_MOST_MODES 500 /* a rotor test sees ten; vectors of more take gigabytes */
#define SYNTHESIS_TOGETHER   16  /* functions that share the factor of a mode, which costs a division a line */

struct synthesis_pair {
    int response, reference; /* in: points, from 0 */
    double residual, slope;  /* out: R, R' [m/N], [s2 m/N] */
};

struct synthesis {
    int npoint, nmode, nrigid; /* modes, rigid and suspension modes first */
    double *lambda;            /* [nmode] (rad/s)^2, ascending */
    double *shape;             /* [nmode * npoint] the modes of a point beside each other, 1/sqrt(kg) */
    double shift;              /* c, the first elastic eigenvalue, or (2 pi up_to_hz/32)^2 if that is larger */
    int npair;
    struct synthesis_pair *pair; /* [npair] */
};

/* Modes of the full model at x [nparam] up to up_to_hz > 0, but not fewer than `least` where the model has them, and the
 * residuals of the pairs, whose points are degrees of freedom dof [npoint] of the model (distinct or not). ROTID_OK;
 * ROTID_ERROR_ARGUMENT where there are more than SYNTHESIS_MOST_MODES modes up to there; statuses of prediction_compute;
 * ROTID_ERROR_MEMORY. The solver's memory is given back. */
int synthesis_open(struct pool *pool, const rotid_model *model, const double *x, double up_to_hz, int least, int npoint,
                   const int *dof, int npair, struct synthesis_pair *pair, struct synthesis *s);

/* How H is to be evaluated. */
struct synthesis_lines {
    int nline;
    const double *frequency_hz; /* [nline] > 0 */
    enum frf_quantity quantity;
    double decay;         /* [1/s] of an exponential window on force and response; 0: none */
    int without_residual; /* nonzero: only the modes, to see the contribution of the rest */
};

/* h [nline * count] := pairs first ... first + count - 1. lambda [nmode] of the synthesis, or others in their place; zeta
 * [nmode] >= 0, zero only where no line lies on the mode; an eigenvalue not above zero counts as undamped. work [nline]. */
void synthesis_evaluate(const struct synthesis *s, const struct synthesis_lines *lines, const double *lambda, const double *zeta,
                        int first, int count, double complex *h, double complex *work);

/* --------------------------------------------------------------------------------------------------------------- frf run */

/* Synthesised transfer functions of a job, beside measured ones where there are any: which ones, at which lines, with which
 * damping, and how far the two are apart. Curves are computed when they are asked for; what is kept does not grow with the
 * lines. */

struct frf_node { /* of the measured file */
    int id;
    double x[3]; /* m */
};

struct frf_measured {
    const struct frf_set *set;
    const char *path; /* for messages */
    int nnode;
    const struct frf_node *node;
};

enum frf_damping { /* where the ratio of a mode comes from */
                   FRF_DAMPING_MEASURED,
                   FRF_DAMPING_STATED,   /* DAMPING= */
                   FRF_DAMPING_SMALLEST, /* rigid and suspension modes: the smallest measured ratio, since slings damp little */
                   FRF_DAMPING_MEAN      /* elastic modes that nobody measured: the mean of the measured ratios */
};

struct frf_row {
    int response, reference;        /* ids */
    double response_z, reference_z; /* m, in the model */
    const struct frf *measured;     /* NULL where there is none */
    double sign;                    /* -1 where measured along one opposite direction */
    int is_reciprocal;              /* measured with the force at the response: H_ij = H_ji */
    struct frf_sums sums;           /* over all lines; the sign is taken into account */
    struct frf_sums moved;          /* with the measured frequencies in place of the model's */
};

/* What one function shows at one mode. */
struct frf_at_mode {
    int mode;         /* number, from 1 */
    double level_db;  /* measured over synthesised, each at its own resonance */
    double phase_deg; /* measured less synthesised there, -180 to 180 */
    double deviation; /* largest |H^ - H| of the band over the largest |H^| of it */
};

/* An elastic mode within the lines, and the lines that are nearer to it than to its neighbours. */
struct frf_band {
    int mode, measured;           /* number from 1; index of the measured mode or -1 */
    double model_hz, measured_hz; /* measured_hz NaN where it was not measured */
    int first, last;              /* lines, last inclusive; first > last: none */
    int at_model, at_measured;    /* lines nearest to the resonances */
    struct frf_sums sums, moved;  /* of all functions over these lines */
    struct frf_sums resonance;    /* H^ at its own resonance with H at its own, over the functions */
    int worst;                    /* row of the largest deviation, -1 without measured functions */
};

struct frf_result {
    int is_measured; /* there are measured functions beside */
    enum frf_quantity quantity;
    int nline;
    const double *frequency_hz; /* [nline] > 0 */
    double decay;               /* 1/s, window of the measured functions */
    int skip;                   /* lines of the set below the first one used */
    int nrow, ndone;            /* ndone < nrow: interrupted */
    struct frf_row *row;
    int nband;
    struct frf_band *band;
    struct frf_at_mode *at;      /* [nband * nrow], the bands of a row beside each other; NULL without measured functions */
    struct frf_sums sums, moved; /* of all */
    int nleft_out;               /* measured functions that are no lateral ones along one axis, where all were asked for */
    double up_to_hz;             /* the modes reach at least to there */
    struct synthesis synthesis;
    double *zeta;              /* [synthesis.nmode] */
    enum frf_damping *damping; /* [synthesis.nmode] */
    double *moved_lambda;      /* [synthesis.nmode] */
};

/* ROTID_ERROR_ARGUMENT with the error of frf_run in the list where neither a measured mode nor the card has a damping ratio:
 * known before the fit. Else ROTID_OK. */
int frf_refuse_undamped(const struct job *job, struct message_list *notes);

/* identified: of the job, whose parameters and pairing are used; NULL where nothing was measured: the model as the deck states
 * it. measured: NULL where there are no functions to compare with. ROTID_OK, also where environment->cancelled ended it (ndone <
 * nrow); ROTID_ERROR_ARGUMENT with an error in the list: an id that does not exist, no lines, no damping, nothing measured that
 * was asked for, too many modes; ROTID_ERROR_MEMORY; statuses of model_open and prediction_compute. */
int frf_run(struct pool *pool, const struct job *job, const struct identification *identified,
            const struct frf_measured *measured, const rotid_environment *environment, struct message_list *notes,
            struct frf_result *out);

/* The curves of a row, h [nline], in the quantity of the result and with the sign of the model's direction; of the measured one
 * NaN where there is none. work [nline]. */
void frf_synthesised(const struct frf_result *result, int row, double complex *h, double complex *work);
void frf_measured_curve(const struct frf_result *result, const struct frf_set *set, int row, double complex *h);

/* ---------------------------------------------------------------------------------------------------------------- growth */

/* How the hybrid functionals grow away from the optimum: Figure 3 of the paper. */

enum { GROWTH_E, GROWTH_F, GROWTH_KINDS }; /* HYBRID with (15), HYBRID_F with (16) */

/* one of the functionals */
struct growth_line {
    int nepsilon_squared; /* as in struct growth */
    double *objective;    /* at each epsilon_squared, all parameters raised by epsilon [1]; NaN where the model has no modes */
    double slope;         /* of ln objective over ln epsilon_squared by least squares, which theory says is 1 [1]; NaN where an
                             objective is none, or rounding */
    double intercept;     /* of the same line [1]; NaN as well */
};

struct growth {
    int nepsilon_squared;
    double *epsilon_squared;     /* abscissa, evenly in the logarithm [1] */
    struct growth_line hybrid;   /* FUNCTIONAL=HYBRID, f with E of (15) */
    struct growth_line hybrid_f; /* FUNCTIONAL=HYBRID_F, f with F of (16) */
    double *shapes_alone; /* objective of HYBRID with the shapes perturbed and the parameters left [1]: nothing but rounding
                             (docs/errata.md) */
};

/* Data: frequencies and shapes of modes 1 ... modes of the model itself at x0 [n] of the parameters, so that f(x0) = 0, by the
 * reduction of the job's FIT; as in (17) and (18) every parameter is raised by eps, and to each measured shape eps times an
 * arbitrary vector of its own length is added, drawn from `seed`. Statuses of the prediction. */
int growth_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0, int modes,
               unsigned long seed, struct growth *growth);

/* ------------------------------------------------------------------------------------------------------------- held mesh */

/* A fit of a solid runs on the coarse mesh, whose frequencies are held in ratio to the limit that this mesh and the one that
 * counts lead to, and whose shapes at their distance from the shapes of the latter: both hardly depend on E and G. Condensed
 * matrices have no such ratio. Both change by a tenth of their distance to 1 and to 0 where E and G change by half. What is held
 * goes with the job, for its outline and sensors, whatever causes are in it. */
struct held_modes {
    struct rotor rotor;  /* without causes */
    int count;           /* elastic modes */
    double *ratio;       /* [count] frequencies that count over those of the coarse mesh */
    const double *shape; /* [nsensor * count] of the mesh that counts, largest component 1; NULL: shapes are not held */
    double *shift;       /* [nsensor * count] that shape less the one of the coarse mesh */
};

/* Takes the coarse mesh as it stands for the first `count` modes, unless something is held. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_hold_as_it_is(struct pool *pool, struct job *job, int count);

/* Holds ratio and distance at the parameters of a spectrum with SPECTRUM_MESH, which stays; *moved: by how much the ratio differs
 * from what was held. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_hold(struct pool *pool, struct job *job, const struct spectrum *spectrum, double *moved);

/* The mesh for fits with this pairing [nmode], model_open's refine, and the measured frequencies and shapes as that mesh has
 * them, frequency_hz [nmode], shape [nsensor * nmode] (NULL where none are measured). ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_of_fit(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz,
                const double **shape);

/* ----------------------------------------------------------------------------------------------------------- mesh choice */

/* Elements for sections of which the deck states none. */

#define MESH_CHOICE_SHARE   0.1 /* of the noise: the mesh then moves an estimate by less than a tenth of its standard deviation */
#define MESH_CHOICE_ERROR   1e-4 /* relative error of a frequency where no noise is known */
#define MESH_CHOICE_MODES   6    /* where none is measured */
#define MESH_CHOICE_LARGEST 1000 /* elements of all these sections */

struct mesh_choice {
    int elements;    /* of these sections */
    double length_m; /* of the longest of them */
    int mode;        /* the highest that counts */
    double wanted;   /* relative error of a frequency that the mesh may have */
    double error;    /* that it has, the largest of modes 1 to `mode`; NaN where it is not known */
    int is_noise_known;
};

/* Writes elements into the sections section[count] of job->rotor. All elements are about equally long, h: the error of a
 * frequency falls as h^2, so that of a first mesh, by its Richardson limit, gives h. The error is that of modes 1 to the highest
 * measured one, at the values of the rotor, and is at most MESH_CHOICE_SHARE of the smallest relative standard deviation of a
 * measured frequency. With MESH_CHOICE_LARGEST elements it ends. Where the model has no such modes (a section that cannot be) the
 * first mesh is left. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_choose(struct pool *pool, struct job *job, int count, const int *section, struct mesh_choice *choice);

/* Measured shapes beside those of the full model, as a picture of them needs it: on one scale, the model's along the whole axis
 * and along the members beside it, and which measured shape looks like which mode. Fills `shapes` and, where a measured shape
 * has two components, the matrices of the MAC and, with a mass matrix of the masters, of the NCO with their rows and columns;
 * zeros before. The best scale of a shape of the model to the measured one is a = sum p m/s^2/sum p^2/s^2 with the stated noise
 * s, 1 where it is not known of all; NaN without a partner. Leans on the job and the spectrum, which is that of spectrum_compute
 * at the model that `compared` paired. ROTID_OK or ROTID_ERROR_MEMORY. */
int mode_shapes_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, const struct comparison *compared,
                     rotid_identification *out);

/* ------------------------------------------------------------------------------------------------------------- point fit */

/* Frequencies that depend on where the accelerometer sat: weighted regressions with an intercept for each mode. */

#define POINT_COLUMNS 2

/* Reading j of mode k stands at [j + k * npoint]; y_kj = c_k + sum over the columns of slope_i column_i,kj + noise of std_kj. */
struct point_readings {
    int nmode, npoint, ncolumn; /* ncolumn from 0 to POINT_COLUMNS */
    const double *y, *std;      /* [npoint * nmode] finite and std > 0 where use is set */
    const double *column[POINT_COLUMNS];
    char *use; /* [npoint * nmode] nonzero: this reading counts */
    double
        *mean; /* [(2 + ncolumn) * nmode] workspace, afterwards for each mode: sum of weights, weighted means of y and columns */
};

struct point_fit {
    int readings, dof; /* dof: readings less modes that have any, less columns */
    double slope[POINT_COLUMNS];
    double variance[POINT_COLUMNS]; /* of the slopes, for the noise as stated */
    double cross;                   /* and their covariance */
    double chi2;
    double scale; /* sqrt(chi2/dof) where that is above one, else 1: factor by which the stated noise grows */
};

/* Least squares over the readings in use. 0, or 1 where a column is constant within every mode or the two cannot be told apart:
 * *fit is then that without columns. */
int point_fit(const struct point_readings *readings, struct point_fit *fit);

/* Takes out of use, one after the other, the reading that the others contradict most: its residual is beyond what noise makes of
 * the largest of all readings once in a hundred times, by Student's distribution and by the scatter of the others or the stated
 * noise, whichever is larger. At most a tenth of the readings, at least one; never so many that fewer than three degrees of
 * freedom are left. Returns the number taken out. */
int point_drop_outliers(const struct point_readings *readings);

/* What one measured mode has for a frequency, from readings that were taken with the accelerometer at one sensor after the
 * other. */
struct point_mean {
    int readings, dropped;
    int regressed;        /* on the squared shape; else the plain weighted mean of the readings */
    double hz, std;       /* Hz; std NaN where nothing says it */
    double std_of_others; /* Hz, of one reading that has none of its own; NaN where nothing says it */
};

/* The mean over all sensors that have a component of the shape: f_j = c + b shape_j^2 by weighted regression, read at the mean of
 * shape_j^2; its standard deviation from the regression, times its scale. Readings whose std is not known (NaN) count with the
 * largest that is known; where none is, all count alike and their scatter gives both deviations. Fewer than five readings, no
 * shape, or readings where the shape is the same everywhere: the plain weighted mean of the readings.
 * hz, std [nsensor] in Hz, NaN where there is none; shape [nsensor], or NULL. ROTID_OK, ROTID_ERROR_MEMORY, or
 * ROTID_ERROR_ARGUMENT where there is no reading. */
int point_mean(struct pool *pool, int nsensor, const double *hz, const double *std, const double *shape, struct point_mean *out);

/* ----------------------------------------------------------------------------------------------------------- sensitivity */

/* Sensitivity of the modes to parameters: the paper's Table 1 and Figure 5, for any parameter. */

struct sensitivity_options {
    double step;  /* relative, for (29) */
    double range; /* relative, of the curves: x/x0 from 1 - range to 1 + range */
    int points;   /* of each curve */
    int modes;
    int with_growth;
    unsigned long seed; /* of its shapes */
};

/* how the modes depend on one parameter */
struct sensitivity_parameter {
    const char *name;                   /* such as core.E */
    const char *unit;                   /* of the reference; 1 for a pure number */
    double reference;                   /* value x0 that the relative changes refer to [unit] */
    int nfrequency_hz, nrelative_value; /* as in struct sensitivity */
    double *sensitivity;      /* per mode: E_k after one step, divided by the step [1]; E_k = 1 - R*_k/w_k(x0)^2: (29) */
    double *derivative;       /* per mode: its limit for a step that vanishes, from the analytic derivatives [1] */
    double *frequency_change; /* per mode: relative change of the frequency for that of the parameter, d ln f/d ln x [1], per cent
                                 for a per cent; -derivative/2, since E_k = 1 - (f/f0)^2 */
    double *curves; /* per mode, Figure 5 of the paper: component E_k^2/2 of the objective of HYBRID at each relative_value [1];
                       NaN where the model has no modes */
};

struct sensitivity {
    const char *reduction;  /* of the model that is varied */
    double step;            /* relative step of the differences [1] */
    int nfrequency_hz;      /* modes */
    double *frequency_hz;   /* of each mode at the reference values [Hz] */
    int nrelative_value;    /* points of the curves */
    double *relative_value; /* abscissa of the curves: value over reference [1] */
    int nparameters;
    struct sensitivity_parameter *parameters; /* in the order of *IDENTIFY or --at */
    struct growth *functional_growth; /* how the hybrid functionals grow away from the optimum, Figure 3 of the paper; NULL where
                                         that was not asked for */
};

/* The first `count` elastic modes of a rotor at x with the derivatives of their eigenvalues by the parameters: behind the rigid
 * ones in p->lambda [p->count] and p->dlambda [p->count * nparameter]. Statuses of model_open and the prediction. */
int elastic_rates(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                  const struct parameter *parameter, int reduction, const double *x, int count, struct prediction *p);

/* Around the values x0 [n] of the parameters, whose names are `named`, with the reduction of the job's FIT. Statuses of the
 * prediction; at points of a curve where the model has no modes the curve is NaN. */
int sensitivity_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter,
                    const rotid_parameter *named, const double *x0, const struct sensitivity_options *options,
                    struct sensitivity *out);

#endif
