/* rotid: the bending stiffness of a rotor from its measured modes.
 *
 * Three layers, each usable alone: run a deck (rotid_deck_read, rotid_identify, rotid_diagnose); bring your own model
 * (rotid_fit); building blocks (elements, condensation, eigenpairs, Levenberg-Marquardt, mode correlation). The twin for Fortran
 * is rotid.f90.
 *
 * Conventions, once for all routines
 *   Units are SI; frequencies whose name ends in _hz are in hertz, all others in rad/s.
 *   Matrices are column-major, indices count from 0.
 *   A node of a beam has two degrees of freedom, the lateral deflection v and the rotation theta = -dv/dz of its section.
 *   Every routine returns a status: 0 done, negative an error, positive a reason why an iteration ended.
 *   `failure` of a routine that can fail is NULL or ROTID_FAILURE_LENGTH characters of the host. The call leaves there why its
 *   status is an error: of ROTID_ERROR_ARGUMENT which argument, by its name and place here, its value, and what was expected;
 *   else at least rotid_status_text. Empty after a status that is no error.
 *   A struct that begins with `size` is filled by the host: size = sizeof the struct, the rest zero but for what it sets, in C
 *   rotid_model model = {.size = sizeof model, ...}. Versions to come add members behind the last one, and take zeros for what a
 *   host was compiled without. What a newer host asks for in members that this library does not know is refused, zeros are not.
 *   A size that was not set, 0, is ROTID_ERROR_ARGUMENT.
 *   No routine prints, exits, handles signals or keeps state between calls, and only rotid_deck_read and rotid_deck_read_text
 *   read files, those that the deck names among them; calls on different data may run at the same time. The number of BLAS
 *   threads stays what the host has set.
 *   NaN stands for what is not known or cannot be stated. While any routine computes, its thread does so with floating-point
 *   exceptions masked, in the layer of decks also with the locale "C"; both are as the host had them when the call returns.
 *   Callbacks run in between. */
#ifndef ROTID_H
#define ROTID_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define ROTID_API __attribute__((visibility("default")))
#else
#define ROTID_API
#endif

#define ROTID_VERSION       "0.3.0"
#define ROTID_VERSION_MAJOR 0 /* of the shared library too: librotid.so.MAJOR */
#define ROTID_VERSION_MINOR 3
#define ROTID_VERSION_PATCH 0

/* The version of the library that is linked, such as "0.3.0". */
ROTID_API const char *rotid_version(void);

/* ------------------------------------------------------------------------------------------------ status */

/* name, value, text */
#define ROTID_STATUS_LIST(X)                                                                                                     \
    X(ROTID_OK, 0, "done")                                                                                                       \
    X(ROTID_STOP_GRADIENT, 1, "the gradient vanished")                                                                           \
    X(ROTID_STOP_STEP, 2, "the step became negligible")                                                                          \
    X(ROTID_STOP_OBJECTIVE, 3, "the decrease that is left is below rounding")                                                    \
    X(ROTID_STOP_ITERATIONS, 4, "the iteration limit was reached")                                                               \
    X(ROTID_STOP_STALLED, 5, "no step lowers the objective")                                                                     \
    X(ROTID_STOP_CANCELLED, 6, "cancelled")                                                                                      \
    X(ROTID_ERROR_ARGUMENT, -1, "an argument is out of its range")                                                               \
    X(ROTID_ERROR_MEMORY, -2, "out of memory")                                                                                   \
    X(ROTID_ERROR_MASS, -3, "the mass matrix is not positive definite")                                                          \
    X(ROTID_ERROR_SLAVE, -4, "the stiffness of the slave degrees of freedom is not positive definite")                           \
    X(ROTID_ERROR_STIFFNESS, -5, "the stiffness matrix is not positive semidefinite")                                            \
    X(ROTID_ERROR_EIGEN, -6, "the eigenvalue iteration did not converge")                                                        \
    X(ROTID_ERROR_CLOSE, -7, "two eigenvalues are too close for their vectors to be differentiated")                             \
    X(ROTID_ERROR_UNPAIRED, -8, "a measured mode has no partner in the model")                                                   \
    X(ROTID_ERROR_RANK, -9, "the Jacobian has no usable column")                                                                 \
    X(ROTID_ERROR_CALLBACK, -10, "a callback reported a failure")                                                                \
    X(ROTID_ERROR_FINITE, -11, "a value is not finite")                                                                          \
    X(ROTID_ERROR_SECTION, -12, "the section is not an annulus: its squared inner diameter would be negative")                   \
    X(ROTID_ERROR_SYNTAX, -13, "the input is malformed")                                                                         \
    X(ROTID_ERROR_IO, -14, "a file cannot be read or written")                                                                   \
    X(ROTID_ERROR_LIBRARY, -15, "a library reported a failure that should not occur")

enum {
#define ROTID_STATUS_ENUM(name, value, text) name = (value),
    ROTID_STATUS_LIST(ROTID_STATUS_ENUM)
#undef ROTID_STATUS_ENUM
};

/* The text of a status; "unknown status" for any other value. Never NULL, not to be freed. */
ROTID_API const char *rotid_status_text(int status);
/* Its name, such as "ROTID_OK". */
ROTID_API const char *rotid_status_name(int status);
/* 1 where the status of an iteration (of rotid_lm, of rotid_fit_result) tells a minimum: ROTID_STOP_GRADIENT, _STEP and
 * _OBJECTIVE; 0 for every other one: ROTID_STOP_STALLED is no minimum, ROTID_OK no end of an iteration. */
ROTID_API int rotid_status_converged(int status);

/* ------------------------------------------------------------------------------------------------ environment */

typedef struct rotid_allocator {
    void *(*allocate)(void *context, size_t bytes); /* aligned for any type, or NULL; must exist until all it made is freed */
    void (*release)(void *context, void *block);
    void *context;
} rotid_allocator;

#define ROTID_FAILURE_LENGTH 512 /* of the text `failure`, with the zero that ends it */

/* What a host may hand to a long call. NULL anywhere: malloc, never cancelled, silent. An allocator has both functions. */
typedef struct rotid_environment {
    size_t size;
    const rotid_allocator *allocator;
    int (*cancelled)(void *context); /* polled once per iteration; nonzero ends the call with ROTID_STOP_CANCELLED */
    void (*progress)(void *context, const char *stage, int step); /* told of every iteration, of the baseline every evaluation */
    void *context;
} rotid_environment;

/* ------------------------------------------------------------------------------------------------ run a deck */

/* What is to be found, by either of the first two layers. */
typedef struct rotid_parameter {
    const char *name, *unit;    /* texts for reports; may be NULL */
    double lower, upper, start; /* lower < start < upper, start != 0, upper - lower finite */
} rotid_parameter;

typedef struct rotid_fit_result rotid_fit_result; /* with rotid_fit below */

enum { ROTID_NOTE, ROTID_WARNING, ROTID_ERROR }; /* severity */

typedef struct rotid_message {
    int severity;
    int line, column; /* from 1; 0 where there is none */
    const char *file; /* NULL where there is none */
    const char *text; /* what is wrong, what was expected */
} rotid_message;

/* A line "paper QUANTITY = ..." of the heading of a deck: values to compare with. */
typedef struct rotid_reference {
    const char *quantity; /* such as predicted_hz, error_percent or sensitivity core.E */
    int nvalues;
    double *values; /* in the units of the quantity, by mode */
} rotid_reference;

/* What a deck says. All arrays belong to it and are not to be changed. A deck is only read by the routines below: several threads
 * may work on one, and it may be freed before their results. */
/* What a rotor does in a mode: its deflection in one plane, the rotation about its axis, the displacement along it. */
enum { ROTID_BENDING, ROTID_TORSION, ROTID_AXIAL };

typedef struct rotid_deck rotid_deck;
struct rotid_deck {
    const char *path;
    int nmessage, nerror; /* of errors beyond the first 200 only the number is kept */
    const rotid_message *message;
    double length, mass, centre; /* m, kg, m from the left end; at the start of the parameters */
    int nsensor;
    const int *sensor_id;             /* [nsensor] */
    const double *sensor_z;           /* [nsensor] m, increasing */
    int nmode;                        /* measured */
    const int *number;                /* [nmode] elastic mode, from 1 */
    const double *frequency_hz;       /* [nmode] */
    const double *frequency_std;      /* [nmode] relative, NaN where there is none */
    const double *shape;              /* [nsensor * nmode] NaN where not measured; NULL where no shapes were */
    const double *shape_std;          /* [nsensor * nmode] relative to the largest component; or NULL */
    const int *holdout;               /* [nmode] */
    int nparameter;                   /* of *IDENTIFY */
    const rotid_parameter *parameter; /* [nparameter] */
    const double *stated;             /* [nparameter] values of the parameters in the model as the deck states it */
    int nheading, nreferences;
    const char **heading;        /* [nheading] lines of *HEADING without the references */
    rotid_reference *references; /* [nreferences] */
    void *memory;                /* internal */
    /* Several *STATE. Of these rotid_identify alone takes the whole deck; the others work on the deck of one state. Above stand
     * the parameters of all, and the rest of the first one. 0 and NULL of a deck that is one state. */
    int nstate;
    const char *const *state_name; /* [nstate] */
    rotid_deck *const *state;      /* [nstate] the deck of each, freed with this one */
};

/* Reads the deck `path`, what it includes and the measured data it names. override [noverride]: texts "CARD.OPTION=VALUE" that
 * replace options of the deck; NULL with 0. Exit: *deck, to be freed with rotid_deck_free also when the status is an error: its
 * messages then say what is wrong and where, the first of them `failure` too. *deck is NULL only with ROTID_ERROR_MEMORY or
 * ROTID_ERROR_ARGUMENT.
 * Statuses: ROTID_OK, ROTID_ERROR_SYNTAX, _IO, _MEMORY, _ARGUMENT; _SECTION where a section of it is none. */
ROTID_API int rotid_deck_read(const char *path, int noverride, const char *const *override, const rotid_environment *environment,
                              char *failure, rotid_deck **deck);
/* The same of the deck text [length], which need not end with a zero. `name` stands for its file in messages and in `path`; NULL:
 * "deck". What it includes and the measured data it names are read relative to `directory`; where that is NULL they are not read
 * but an error with its place (ROTID_ERROR_SYNTAX). No text is needed behind the call. */
ROTID_API int rotid_deck_read_text(size_t length, const char *text, const char *name, const char *directory, int noverride,
                                   const char *const *override, const rotid_environment *environment, char *failure,
                                   rotid_deck **deck);
/* NULL is allowed. */
ROTID_API void rotid_deck_free(rotid_deck *deck);

/* ---- results */

/* What the routines of the first layer return, and what the program writes with --json: each member is the key of that name in
 * docs/schema, and the comment is its description there. A list X has nX elements. What is not known or cannot be stated is NaN
 * or NULL, and null in JSON. Units stand in brackets, [1] for a pure number; where a name ends in a unit that is the unit.
 * Results are not to be changed, and go as a whole with the routine that is named `rotid_..._free`. */

#define ROTID_NONE (-2147483647) /* an integer that is not known */

/* A material at the values of the model. */
typedef struct rotid_material {
    const char *name;  /* of the *MATERIAL, or NULL */
    double e_pa;       /* Young's modulus [Pa] */
    double g_pa;       /* shear modulus, E/2(1+nu) where the material is isotropic [Pa] */
    double nu;         /* Poisson ratio [1] */
    double rho_kg_m3;  /* density [kg/m3] */
    double sheet_e_pa; /* of a stack of sheets across the axis, along which e_pa and g_pa hold: Young's modulus of a sheet, whose
                          Poisson ratio is nu [Pa]; NaN of other materials */
    double stacking;   /* share of the stack's length that is sheet [1]; NaN of other materials */
} rotid_material;

/* A section of constant diameter: round (outer_m, inner_m, stiff_outer_m) or rectangular (height_m, width_m), the others NaN. */
typedef struct rotid_segment {
    double from_m;        /* left end [m] */
    double to_m;          /* right end [m] */
    int elements;         /* of the mesh, before nodes are added at sensors and the like */
    double outer_m;       /* outer diameter [m] */
    double inner_m;       /* inner diameter [m] */
    double stiff_outer_m; /* outer diameter that carries stiffness [m]; NaN where it is outer_m */
    double height_m;      /* in the bending plane [m] */
    double width_m;       /* across it [m] */
} rotid_segment;

/* Evenly spaced axial holes along a group. */
typedef struct rotid_perforation {
    int number;             /* of holes */
    double hole_diameter_m; /* [m] */
    double pitch_radius_m;  /* from the axis to the middle of a hole [m] */
} rotid_perforation;

/* A group of sections of one material. */
typedef struct rotid_group {
    const char *name;     /* of the card */
    const char *layer_of; /* of a *LAYER: name of the group on whose sections its rings lie; NULL of a group of the axis */
    double from_m;        /* left end [m] */
    double to_m;          /* right end [m] */
    rotid_material material;
    int nsegments;
    rotid_segment *segments;        /* from left to right */
    rotid_perforation *perforation; /* NULL without *PERFORATION */
    double preload_n;               /* axial force of *PRELOAD, tension positive [N] */
} rotid_group;

/* A bundle of tie rods. */
typedef struct rotid_tierods {
    const char *name; /* of the card */
    double from_m;    /* left end [m] */
    double to_m;      /* right end [m] */
    rotid_material material;
    int number;            /* of rods */
    double diameter_m;     /* of a rod [m] */
    double pitch_radius_m; /* from the axis to the middle of a rod [m] */
    const char *model;     /* RODS: each bends about itself; TUBE: the cylinder of equal area and inertia */
    int elements;          /* of the deck */
    double tension_n;      /* of a rod [N] */
    int self_equilibrated; /* the tension compresses what is clamped */
} rotid_tierods;

/* Short-circuit bars. */
typedef struct rotid_bars {
    const char *name; /* of the card */
    double from_m;    /* left end [m] */
    double to_m;      /* right end [m] */
    double center_m;  /* where they are fixed to the axis [m] */
    rotid_material material;
    int number;            /* of bars */
    double diameter_m;     /* of a bar [m] */
    double pitch_radius_m; /* from the axis to the middle of a bar [m] */
    const char *model;     /* RODS: each bends about itself; TUBE: the cylinder of equal area and inertia */
    int elements;          /* of the deck */
} rotid_bars;

/* A disk. */
typedef struct rotid_disk {
    const char *name;       /* NULL where the card gives none */
    double z_m;             /* [m] */
    double mass_kg;         /* [kg] */
    double diametral_kg_m2; /* inertia about a diameter [kg.m2] */
    double polar_kg_m2;     /* inertia about the axis, which plane bending at rest does not use [kg.m2] */
} rotid_disk;

/* A spring to the ground. */
typedef struct rotid_spring {
    const char *name;         /* NULL where the card gives none; sling and sling end for those of *SLING */
    double z_m;               /* [m] */
    double lateral_n_m;       /* [N/m] */
    double rotational_nm_rad; /* [N.m/rad] */
} rotid_spring;

/* A sensor. */
typedef struct rotid_sensor {
    int id;     /* as in the deck or the universal file */
    double z_m; /* position from the left end [m] */
} rotid_sensor;

/* A parameter of a cause that is part of the model. */
typedef struct rotid_cause_parameter {
    const char *name; /* such as depth or z */
    const char *unit; /* 1 for a pure number */
    double value;     /* in its unit */
} rotid_cause_parameter;

/* A CAUSE card that is part of the model, or the accelerometer that a diagnosis weighed. Its factors are not in the values of the
 * other members of the geometry. */
typedef struct rotid_model_cause {
    const char *name;    /* of the card, or NULL */
    const char *id;      /* of the catalogue, such as joint */
    const char *target;  /* name of a group, "left|right" for an interface, name of a spring, disk or tie rod; empty: none */
    int sensor;          /* id of the sensor that it acts at; ROTID_NONE where it acts at none */
    const char *variant; /* word of the option SHAPE or MOUNT of its card, or NULL */
    int nparameters;
    rotid_cause_parameter *parameters; /* places are metres from the left end */
} rotid_model_cause;

/* A model as it is drawn and meshed. Positions count from the left end; in JSON lengths have nine significant digits. */
typedef struct rotid_geometry {
    double length_m; /* of the axis [m] */
    int ngroups;
    rotid_group *groups; /* *SHAFT and *BEAM from left to right, then *LAYER */
    int ntierods;
    rotid_tierods *tierods; /* *TIEROD */
    int nbars;
    rotid_bars *bars; /* *BARS */
    int ndisks;
    rotid_disk *disks; /* *DISK */
    int nsprings;
    rotid_spring *springs; /* *SPRING, and the two end springs that *SLING stands for */
    double sling_m;        /* length of *SLING [m]; NaN without */
    int nsensors;
    rotid_sensor *sensors; /* by increasing position */
    int ncauses;
    rotid_model_cause *causes; /* *CAUSE, and in a diagnosis the accelerometer that was weighed */
    int nnodes_z_m;
    double *nodes_z_m; /* nodes of the mesh on the axis: elements lie between neighbours [m]; empty where there is no mesh */
} rotid_geometry;

/* What was identified; value, start, lower, upper, std and ci95 in its unit. */
typedef struct rotid_fitted_parameter {
    const char *name; /* such as core.E */
    const char *unit; /* 1 for a pure number */
    double value;     /* identified value */
    double start;     /* of the iteration */
    double lower;     /* bound */
    double upper;     /* bound */
    double std;       /* standard deviation; NaN where it cannot be stated */
    double ci95[2];   /* 95 % interval; NaN where it cannot be stated */
    int at_bound;     /* pressed against a bound */
    int identifiable; /* 0: at a bound, or part of a combination that the data do not determine */
} rotid_fitted_parameter;

/* A measured mode beside the mode of the model that it is paired with. */
typedef struct rotid_compared_mode {
    int mode;             /* of the model that it is paired with, from 1 */
    int measured_mode;    /* number of the measured mode in the deck, which its shape may contradict; ROTID_NONE in old results */
    double measured_hz;   /* measured frequency of the mode paired with it [Hz] */
    double frequency_std; /* relative standard deviation of the measured frequency [1]; NaN where it is not known */
    double predicted_hz;  /* frequency of the model that error_percent is taken of, condensed or not [Hz] */
    double error_percent; /* predicted over measured frequency, less one [%] */
    double mac;           /* modal assurance criterion [1]; NaN without a measured shape */
    double nco; /* normalised cross orthogonality with the mass matrix condensed by Guyan [1]; NaN without a measured shape */
    const char *paired_by; /* what decided the pairing: shape or number */
    int holdout;           /* held out of the fit */
    double residual;       /* frequency residual of the functional, of held-out modes too [1] */
    const char *type;      /* BENDING, TORSION or AXIAL: of the motion, within which modes are numbered */
} rotid_compared_mode;

/* How tie rods or bars move in one mode. */
typedef struct rotid_member_shape {
    const char *name; /* of the card */
    int nz_m;
    double *z_m;   /* [m] */
    double *shape; /* per entry of z_m, at the scale of predicted, between nodes by the static shapes of the elements [1] */
} rotid_member_shape;

/* The shapes of a measured mode. */
typedef struct rotid_mode_shapes {
    int mode;          /* of the model that it is paired with, from 1 */
    int measured_mode; /* its number in the deck; ROTID_NONE in old results */
    int nmeasured, nmeasured_std, npredicted, npredicted_axis;
    double *measured;       /* at the sensors, largest component 1, NaN where it was not measured [1]; NULL without a shape */
    double *measured_std;   /* standard deviations at the same scale [1]; NULL where they are not known */
    double *predicted;      /* at the sensors, times its best scale to the measured one: least squares, weighted with measured_std
                               where it      is known of all. Without a measured shape the largest deflection of the axis is 1 [1] */
    double *predicted_axis; /* at axis_z_m at the same scale [1] */
    int ntierods;
    rotid_member_shape *tierods; /* in the order of the deck */
    int nbars;
    rotid_member_shape *bars; /* in the order of the deck */
} rotid_mode_shapes;

/* Measured shapes beside those of the full model that was fitted, for pictures: in JSON with nine significant digits. */
typedef struct rotid_shapes {
    int nsensor_id;
    int *sensor_id; /* of each sensor; empty without sensors */
    double *z_m;    /* per entry of sensor_id: its position [m] */
    int naxis_z_m;
    double *axis_z_m; /* nodes of the axis [m]; evenly thinned to 401 where there are more, both ends among them */
    int nmodes;
    rotid_mode_shapes *modes; /* per measured mode */
} rotid_shapes;

/* An accepted point of the iteration. */
typedef struct rotid_history_entry {
    int iteration;     /* 0 is the start */
    double objective;  /* half the sum of squared residuals [1] */
    double gradient;   /* largest component of its gradient with respect to value/start [1] */
    double mu;         /* damping in use [1] */
    double gain_ratio; /* actual over predicted decrease of the step that led here [1]; NaN at iteration 0 */
    double step;       /* norm of that step in value/start [1] */
    double seconds;    /* since the iteration began [s] */
    int nx;
    double *x; /* values of the parameters in their units */
} rotid_history_entry;

/* The same problem minimised by NLopt. */
typedef struct rotid_minimiser {
    const char *algorithm; /* NLopt's name */
    const char *result;    /* NLopt's name of the result */
    int usable;            /* converged, or stopped by rounding at a minimum */
    double objective;      /* recomputed at x [1] */
    double gradient;       /* recomputed at x [1] */
    int evaluations;       /* of the model */
    double seconds;        /* [s] */
    int nx, npredicted_hz;
    double *x;            /* values of the parameters in their units */
    double *predicted_hz; /* per measured mode: frequency of the model there [Hz]; NaN where it has none */
} rotid_minimiser;

/* Typical noise of the measured data in use. */
typedef struct rotid_noise {
    double frequency;      /* relative standard deviation, median of the modes [1]; NaN where none is stated */
    double shape;          /* relative to the largest component, median of all components [1]; NaN where none is stated */
    int frequency_assumed; /* by the diagnosis: the deck states none */
    int shape_assumed;     /* by the diagnosis: the deck states none */
    const char
        *intervals_from; /* what std and ci95 rest on: noise, the stated one, or residuals, their scatter; NULL in a diagnosis */
} rotid_noise;

/* A component of a direction: the parameter that it belongs to, and its size. */
typedef struct rotid_component {
    const char *name;
    double value;
} rotid_component;

/* What one of several states has for itself. */
typedef struct rotid_identified_state {
    const char *name;     /* of the *STATE */
    int fitted_residuals; /* its share of the residuals, 0 where it was held out */
    int shapes_fitted;    /* measured shapes took part in the residuals, or in the quotient of HYBRID */
    double objective;     /* half the sum of its squared residuals [1] */
    double chi2;          /* sum of its squared residuals over the squared stated noise [1]; NaN but with LIKELIHOOD */
    int nmodes;
    rotid_compared_mode *modes;      /* as those of the identification */
    double *reduction_error_percent; /* per entry of modes: condensed over full frequency, less one [%]; NaN as in the
                                        identification */
    double *mesh_error_percent;      /* per entry of modes, as mesh_error_percent of rotid_mode [%] */
    double mass_kg;                  /* of the fitted model [kg] */
    double center_of_mass_m;         /* of the fitted model, from the left end [m] */
    rotid_shapes *shapes;            /* measured beside predicted */
    int nmatrix_rows, nmatrix_columns;
    double *nco_matrix;       /* as that of the identification [1]; NULL likewise */
    double *mac_matrix;       /* as that of the identification [1]; NULL likewise */
    int *matrix_rows;         /* measured_mode of the rows; empty without measured shapes */
    int *matrix_columns;      /* mode of the columns; empty without measured shapes */
    rotid_noise *noise;       /* of the data */
    rotid_geometry *geometry; /* the model at the values of the fit */
} rotid_identified_state;

/* What a cause that these data would not have shown may do to a parameter of *IDENTIFY: the fit without the cause moves the
 * parameter by `shift` where the cause is there with `size`. The size is the smallest that shows 9 times in 10 at that place, or
 * the largest within physical bounds where that is less. Linear. */
typedef struct rotid_hidden {
    const char *parameter; /* such as core.E */
    double shift;          /* of its value, in its unit */
    const char *unit;      /* of shift */
    const char *id;        /* of the catalogue */
    const char *target;    /* as in candidates */
    const char *component; /* the parameter of the cause that is its size; presence of a cause that is there or not */
    double size; /* deviation from neutral, with its sign; of a cause with two signs the other one turns that of shift */
    const char *size_unit; /* of size */
    double z_m;            /* where on the axis it moves the parameter most [m]; NaN where the cause has no place */
    double width_m;        /* its width there [m]; NaN where the cause has none */
    int beyond;            /* no size within physical bounds shows there */
} rotid_hidden;

/* A measured critical speed of the running machine beside the model's. */
typedef struct rotid_runup_speed {
    int number;           /* of the critical speeds with this whirl, from 1, by rising speed */
    const char *whirl;    /* forward, mixed ones among them, or backward */
    double measured_rpm;  /* [rpm] */
    double measured_std;  /* its standard deviation [rpm] */
    double predicted_rpm; /* of the model [rpm]; NaN where it has no such critical speed */
    double predicted_std; /* standard deviation of predicted_rpm by unknowns, bearings and what else the deck calls uncertain, in
                             linear prediction; of what was fitted, without the reading itself [rpm]; NaN with predicted_rpm */
    double z; /* measured less predicted over the standard deviation: of both where held out, of the reading where fitted [1] */
    int holdout; /* it took no part in the fit */
} rotid_runup_speed;

/* What a rotor weighs, or where its centre of mass is, beside the model. */
typedef struct rotid_weighed {
    const char *quantity; /* mass or centre */
    const char *unit;     /* kg or m, from the left end */
    const char *state;    /* name of the *STATE; NULL where there is one */
    double measured;      /* as the deck states it, in unit */
    double std;           /* its standard deviation, in unit */
    double predicted;     /* of the model, in unit */
    double z;             /* measured less predicted over std [1] */
} rotid_weighed;

/* A model fitted to measured modes. Of several states modes and what goes with them run over all, mass, noise and geometry are
 * those of the first, and shapes and matrices stand in states alone. */
typedef struct rotid_identification {
    const char *status; /* converged, not_converged, or at_bound: converged with at least one parameter pressed against a bound.
                           Undetermined parameters are flagged below */
    const char *functional; /* that was minimised */
    const char *reduction;  /* of the model that was fitted */
    const char *derivative; /* method of the eigenvector derivatives, where they are needed */
    int shapes_fitted;      /* measured shapes took part in the residuals, or in the quotient of HYBRID */
    double bijection_chi; /* chi of the bijection (30), value = lower + (upper - lower)/(1 + exp(chi y)), in whose y the steps are
                             made [1] */
    double objective;     /* half the sum of squared residuals [1] */
    double gradient;      /* largest component of its gradient with respect to value/start [1] */
    double chi2;          /* sum of squared residuals over the squared stated noise [1]; NaN where no noise is stated */
    double chi2_per_dof;  /* chi2 over dof [1]; NaN without noise or degrees of freedom */
    int dof;              /* degrees of freedom: residuals less free parameters less scales of shapes */
    int iterations;       /* accepted steps */
    int evaluations;      /* of the residual */
    int jacobians;        /* evaluations of the Jacobian */
    const char *stop_reason; /* why the iteration ended: the text of a status ROTID_STOP_ of rotid.h */
    int nparameters;
    rotid_fitted_parameter *parameters; /* in the order of *IDENTIFY, then those of the causes in the model */
    double *correlation;                /* of the parameters, by rows, symmetric [1]; NaN where it cannot be stated */
    double condition_number; /* of the Jacobian with respect to relative parameters [1]; NaN where it is singular or nothing is
                                identified */
    int nundetermined_directions;
    rotid_component *undetermined_directions; /* unit vectors of relative parameter changes that the data do not determine, one
                                                 after the other, each with the component of every parameter [1] */
    double intervals_widened_by;              /* factor on std and ci95 because the misfit exceeds the stated noise [1] */
    int nmodes;
    rotid_compared_mode *modes;      /* measured modes in the order of the deck or by rising frequency */
    double *reduction_error_percent; /* per entry of modes: condensed over full frequency at the fitted model, less one [%]; NaN
                                        where the masters are too few or more than 1,000 */
    double *mesh_error_percent;      /* per entry of modes, as mesh_error_percent of rotid_mode [%] */
    double mass_kg;                  /* of the fitted model [kg] */
    double center_of_mass_m;         /* of the fitted model, from the left end [m] */
    rotid_shapes *shapes;            /* NULL in old results */
    int nmatrix_rows, nmatrix_columns;
    double *nco_matrix;  /* normalised cross orthogonality (45) with the mass matrix condensed by Guyan, measured modes by rows,
                            modes of  the model by columns [1]; NULL without measured shapes or with more than 1,000 sensors; a row
                            of NaN for a  mode without a shape */
    double *mac_matrix;  /* modal assurance criterion, measured modes by rows, modes of the model by columns [1]; NULL without
                            measured  shapes; a row of NaN for a mode without a shape */
    int *matrix_rows;    /* measured_mode of the rows; empty without measured shapes */
    int *matrix_columns; /* mode of the columns; empty without measured shapes */
    int nhistory;
    rotid_history_entry *history; /* accepted points, the start first */
    int nlopt;                    /* 0: built without NLopt, so there is no baseline */
    int nbaseline;
    rotid_minimiser *baseline; /* the same problem minimised by NLopt; empty where that was not asked for, or without NLopt */
    double seconds;            /* of Levenberg-Marquardt [s] */
    rotid_noise *noise;        /* of the data; NULL in the fits of a diagnosis */
    rotid_geometry *geometry;  /* the model at the values of the fit; NULL in the fits of a diagnosis, and in old results */
    int nmessage;
    const rotid_message *message; /* of the pairing and the fit */
    const rotid_fit_result *fit;  /* where the above comes from, with the Jacobian; NULL in a result that was read from a file */
    void *memory;                 /* internal */
    int nstates;
    rotid_identified_state *states; /* of a deck with several *STATE, in its order; none of a deck that is one state */
    int nhidden;
    rotid_hidden *hidden; /* as that of a diagnosis, which looks for these causes; empty without stated noise, but with LIKELIHOOD
                             and the full model, and where no baseline was asked for */
    int nrunup;
    rotid_runup_speed *runup; /* measured critical speeds of the machine in operation, in the order of *RUNUP */
    int nweighed;
    rotid_weighed *weighed; /* *WEIGHT and *CENTRE beside the fitted model, state by state */
} rotid_identification;

/* A mode of a solid of revolution in the plane of bending. Four significant digits. */
typedef struct rotid_meridian_mode {
    int nu;
    double *u; /* radial motion of the corners of the mesh where they are farthest from the neutral plane, largest 1 [1] */
    int nw;
    double *w; /* axial motion there, to the same scale [1] */
    int nenergy;
    double *energy; /* per element: its share of the strain energy of all elements [1] */
} rotid_meridian_mode;

/* A mode of the model, and the measured mode that is paired with it. */
typedef struct rotid_model_mode {
    int mode;          /* number, from 1 */
    double full_hz;    /* frequency of the model that is not condensed [Hz] */
    double reduced_hz; /* frequency of the condensed model [Hz]; NaN where the masters are too few or more than 1,000 */
    double reduction_error_percent; /* reduced over full frequency, less one [%] */
    double mesh_error_percent;      /* frequency over its Richardson limit from this mesh and one twice as fine, less one [%];
                                       of a solid, whose full_hz is such a limit, what it may be off by; NaN where no mode of the
                                       other mesh is this one */
    int nshape;
    double *shape;                 /* deflection of the full model at sensor_z_m, largest component 1 [1] */
    rotid_compared_mode *measured; /* NULL where no measured mode is paired with it; residual is NaN */
    rotid_meridian_mode *meridian; /* of a solid, the first six modes; else NULL */
} rotid_model_mode;

/* An element of the mesh of a solid: a quadrilateral with eight nodes, four of them corners. */
typedef struct rotid_meridian_element {
    int group;     /* whose material it has: index into groups of geometry, from 0 */
    int corner[4]; /* indices into r_m and z_m, from 0: inner left, outer left, outer right, inner right */
} rotid_meridian_element;

/* The mesh of a solid of revolution: half of its section through the axis. */
typedef struct rotid_meridian {
    int nr_m;
    double *r_m; /* corners of the elements: distance from the axis [m] */
    double *z_m; /* of the same, from the left end [m] */
    int nelements;
    rotid_meridian_element *elements; /* slice by slice from the left, from the axis outwards */
} rotid_meridian;

/* A mode of the rotor as a solid, and the mode of the rotor as a beam that looks most like it. */
typedef struct rotid_beside_mode {
    int mode;                  /* of the solid, from 1 */
    int beam_mode;             /* of the beam, from 1 */
    double solid_hz;           /* frequency of the solid [Hz] */
    double beam_hz;            /* frequency of the beam [Hz] */
    double difference_percent; /* beam_hz over solid_hz, less one [%] */
    double nco; /* between their shapes at the sensors, by the mass of the beam condensed onto these [1]; NaN where that is
                   impossible */
    double mac; /* modal assurance criterion between these shapes [1]; NaN with fewer than two sensors */
    double solid_mesh_error_percent; /* what solid_hz, a limit for a fine mesh, is in doubt by [%] */
    double beam_mesh_error_percent;  /* beam_hz over its limit for a fine mesh, less one [%] */
} rotid_beside_mode;

/* A modulus of the rotor, and what a beam would take it for. */
typedef struct rotid_beside_modulus {
    const char *name;      /* such as core.E */
    double stated_pa;      /* of the solid [Pa] */
    double found_pa;       /* of the beam whose frequencies are nearest to those of the solid [Pa] */
    double change_percent; /* found_pa over stated_pa, less one [%] */
} rotid_beside_modulus;

/* The rotor as a beam beside the same rotor as a solid of revolution. */
typedef struct rotid_beam_beside_solid {
    int nmodes;
    rotid_beside_mode *modes; /* of the solid by rising frequency */
    int nmoduli;
    rotid_beside_modulus *moduli; /* those of *IDENTIFY; without any, E and G of the longest group of sheets, else of the first
                                     one whose G is its own. Empty where there is none, and where the fit did not end well */
    int nfitted_modes;
    int *fitted_modes; /* numbers of the modes of the solid to which they were fitted: the measured ones, else the first six */
    double fitted_rms_percent; /* what the fitted beam leaves of these frequencies, rms [%]; NaN without moduli */
    const char *sentence;      /* the same for a person; NULL without moduli */
} rotid_beam_beside_solid;

/* The modes of the model of a deck. */
typedef struct rotid_spectrum {
    const char *reduction; /* of reduced_hz: as FIT says, GUYAN where it says nothing */
    int nrigid_hz;
    double *rigid_hz; /* modes of the rotor on its supports, or of free motion, below the first bending mode [Hz] */
    int nsensor_z_m;
    double *sensor_z_m; /* positions of the components of every shape, from the left end [m]: the sensors, without sensors all
                           nodes of the axis */
    int nmodes;
    rotid_model_mode *modes;         /* bending modes by rising frequency; fewer than asked for where the model has fewer */
    rotid_geometry *geometry;        /* the model at the values of its parameters; NULL in old results */
    rotid_meridian *meridian;        /* of a solid, else NULL */
    rotid_beam_beside_solid *beside; /* of rotid_spectrum_beside, else NULL */
    double *master_mass; /* [nsensor_z_m * nsensor_z_m] condensed by Guyan onto the components of the shapes, for rotid_nco; NULL
                            where it cannot be had */
    int nmessage;
    const rotid_message *message; /* of the pairing; with an error among them no measured mode is paired */
    const char *type; /* of the modes: BENDING, TORSION or AXIAL, whose shapes are the deflection, the rotation about the
                         axis or the displacement along it */
    void *memory;     /* internal */
} rotid_spectrum;

/* How fine a solid of revolution is discretised. */
typedef struct rotid_solid_mesh {
    int unknowns;     /* degrees of freedom */
    int half_band;    /* of the matrices: most that two coupled degrees of freedom are apart */
    int slices;       /* of the mesh, across the axis */
    double corner_m;  /* longest side of an element at a re-entrant corner [m]; NaN where the outline has none */
    double largest_m; /* longest side of any element [m] */
} rotid_solid_mesh;

/* The model of a deck as the deck states it. */
typedef struct rotid_check {
    double length_m;         /* length of the rotor [m] */
    double mass_kg;          /* mass, disks and rods included [kg] */
    double center_of_mass_m; /* from the left end [m] */
    double inertia_kg_m2;    /* about a diameter through the centre of mass [kg.m2] */
    int nodes;               /* nodes on the axis; of a solid those of its meridian */
    int elements;            /* elements on the axis; of a solid those of its meridian */
    rotid_solid_mesh *solid; /* NULL of a beam */
    int rigid_modes;         /* number of modes that are not counted as bending modes */
    int nrigid_hz;
    double *rigid_hz;       /* modes of the rotor on its supports, or of free motion, below the first bending mode [Hz] */
    int measured_modes;     /* number of measured modes */
    const char *functional; /* that identify would minimise */
    const char *reduction;  /* that identify would use */
    int nsensors;
    rotid_sensor *sensors; /* by increasing position */
    int nparameters;
    const char **parameters;  /* names of the parameters of *IDENTIFY */
    rotid_geometry *geometry; /* NULL in old results */
    void *memory;             /* internal */
    int nweighed;
    rotid_weighed *weighed; /* *WEIGHT and *CENTRE beside the model at the start of the parameters */
} rotid_check;

/* ---- diagnosis */

enum { ROTID_ADEQUATE, ROTID_NAMED, ROTID_AMBIGUOUS, ROTID_UNEXPLAINED }; /* verdict */

/* A parameter of a cause. */
typedef struct rotid_cause_value {
    const char *name; /* such as depth or z */
    const char *unit; /* 1 for a pure number */
    double value;     /* in its unit */
    double std;       /* standard deviation; NaN where it cannot be stated */
    double ci95[2];   /* 95 % interval; NaN where it cannot be stated */
    int fixed;        /* by the user: not searched */
} rotid_cause_value;

/* A physical cause at one target, by the ids of docs/diagnosis.md. */
typedef struct rotid_cause {
    const char *id;      /* of the catalogue, such as joint */
    const char *target;  /* name of a group, "left|right" for an interface, name of a spring, disk or tie rod; empty: none */
    const char *name;    /* of the CAUSE card that it would get, or NULL */
    const char *variant; /* word of the option SHAPE or MOUNT of its card, or NULL */
    int nparameters;
    rotid_cause_value *parameters; /* at the best values found */
    const char *state; /* the one state in which it acts; NULL: in all that have its target, or the deck has no *STATE */
} rotid_cause;

/* How far a parameter of *IDENTIFY lies apart between the causes that cannot be told apart. */
typedef struct rotid_spread {
    const char *name;       /* such as core.E */
    const char *unit;       /* 1 for a pure number */
    double lowest, highest; /* of its values with one of these causes in the model */
    double ci95[2];         /* that hold the 95 % intervals of all of them; NaN where one of them has none */
} rotid_spread;

/* A set of causes, perhaps with something else that is not in the catalogue, and how probable it is (docs/method.md, section 11).
 */
typedef struct rotid_explanation {
    int ncauses;
    rotid_cause *causes; /* none, and not something_else: nothing is wrong */
    int something_else;  /* beside the causes, or without any, there is something that is not in the catalogue */
    double probability;  /* after the data, among all explanations */
    double at_rest;      /* the same without the measured critical speeds of *RUNUP; NaN: they take no part */
    int nidentified;
    rotid_cause_value *identified; /* the parameters of *IDENTIFY if this is what is there */
} rotid_explanation;

/* The probability that a cause is there, alone or with others. */
typedef struct rotid_marginal {
    const char *id;     /* of the catalogue */
    const char *target; /* as that of a cause */
    const char *state;  /* the one state in which it acts; NULL: in all that have its target */
    double z_m;         /* place, which a cause elsewhere does not share; NaN: it has none */
    double probability; /* of all explanations that have it */
} rotid_marginal;

/* A parameter of *IDENTIFY, averaged over all explanations by their probabilities. */
typedef struct rotid_averaged_parameter {
    const char *name; /* such as core.E */
    const char *unit; /* 1 for a pure number */
    double value;     /* mean */
    double std;       /* standard deviation */
    double ci95[2];   /* between the quantiles 0.025 and 0.975 */
} rotid_averaged_parameter;

/* What a diagnosis says of physical causes: faults of the data and of the numbers are removed before. */
typedef struct rotid_verdict {
    int kind;           /* ROTID_ADEQUATE ... ROTID_UNEXPLAINED; -1: interrupted before a verdict */
    int adequate_after; /* the model with the causes that were named is adequate for these data */
    double p_value;     /* of the base model: the smallest of the tests */
    int ncauses;
    rotid_cause *causes; /* named, as they stand in the extended model */
    int nlikely_causes;
    rotid_cause *likely_causes; /* not named, but in the extended model beside those, which alone are next to excluded */
    int nalternatives;
    const char **alternatives; /* ids of the candidates that cannot be told apart, best first */
    int nalternative_causes;
    rotid_cause *alternative_causes; /* the same with targets and values */
    int nalternative_sets;
    int *alternative_sets;        /* a number from 1 for each of them: two causes of one number are meant together */
    const char *next_measurement; /* what would settle it; NULL where nothing is open */
    const char *sentence;         /* the verdict for a person; NULL where there is none */
    int undetermined_parameters;  /* parameters of the base model that the data leave open */
    int confident;                /* modes, stated noise and reach of the sensors suffice for naming a cause */
    int nspread;
    rotid_spread *spread; /* over alternative_causes: what the dispute is worth in parameters; empty where nothing is open */
    int nexplanations;
    rotid_explanation *explanations; /* most probable first, together 0.99 */
    int nmarginals;
    rotid_marginal *marginals; /* of each cause above 0.001, most probable first */
    double nothing;            /* probability that nothing is wrong; NaN without explanations */
    double nothing_prior;      /* the same before the data were seen */
    double something_else;     /* probability that something outside of the catalogue is */
    double runup_p; /* of measured critical speeds as far from the first explanation, or farther; NaN: they take no part */
} rotid_verdict;

/* A fault of the measurement chain, taken out of the data. */
typedef struct rotid_data_finding {
    const char *id; /* of the catalogue */
    int nsensors;
    int *sensors; /* their ids */
    int nmodes;
    int *modes;        /* their numbers */
    const char *block; /* what noise_level speaks of: SHAPE or FREQUENCY; NULL for the others */
    double value;      /* gain, shift, factor, mass; NaN where there is none */
    const char *unit;  /* of value, or NULL */
    double std;        /* standard deviation of value */
    double chi2_drop;  /* drop of chi2 by the correction [1] */
    const char *text;  /* what was found and done */
    const char *state; /* name of the state whose data these are; NULL in a deck without *STATE */
    int nparameters;
    rotid_cause_value
        *parameters; /* of sensor_line: shift, scale and flip (1: counted from the other end); none for the others */
} rotid_data_finding;

/* An error of the model's own numbers, removed. */
typedef struct rotid_numerical_finding {
    const char *id; /* of the catalogue: mesh or guyan_reduction */
    int nmodes;
    int *modes;            /* numbers */
    double *error_percent; /* per entry of modes: error of the frequency [%] */
    const char *text;      /* what was found and done */
    const char *state;     /* name of the state, as in rotid_data_finding */
} rotid_numerical_finding;

/* The model of the deck before any cause. */
typedef struct rotid_round {
    int round;             /* from 1 */
    double chi2;           /* of the model before the round [1] */
    double chi2_frequency; /* the part of the frequencies [1] */
    int dof;               /* degrees of freedom */
    int frequencies;       /* number of frequencies that were fitted */
    double largest;        /* predicted drop of chi2 in the scan [1] */
    double p_frequency;    /* of the frequencies */
    double p_total;        /* of chi2 */
} rotid_round;

/* A cause at one target, tried in one round. */
typedef struct rotid_candidate {
    int round; /* from 1 */
    rotid_cause cause;
    int suspect;           /* asked for by a CAUSE card with SUSPECT */
    int refitted;          /* judged by a nonlinear fit; else the numbers of that fit are NaN */
    double predicted_drop; /* of chi2, from the linear scan [1] */
    double chi2;           /* with the cause in the model [1] */
    double chi2_frequency; /* the part of the frequencies [1] */
    double chi2_drop;      /* against the model of the round [1] */
    double holdout_rms;    /* error of the frequencies that the deck holds out [%] */
    double sensor_out_rms; /* standardised shape residual of sensors left out in turn [1] */
    int at_bound;          /* a parameter is pressed against a physical bound */
    double probability;    /* that this cause is there, alone or with others */
} rotid_candidate;

/* Of the base and of the extended model. */
typedef struct rotid_pair {
    double before, after; /* of the base and of the extended model */
} rotid_pair;

/* A parameter of the base or of the extended model; NaN where the model has no such parameter. */
typedef struct rotid_changed_parameter {
    const char *name;      /* such as core.E */
    const char *unit;      /* 1 for a pure number */
    double before;         /* base model */
    double after;          /* extended model */
    double before_ci95[2]; /* 95 % interval; NaN where it cannot be stated */
    double after_ci95[2];  /* 95 % interval; NaN where it cannot be stated */
} rotid_changed_parameter;

/* Before and after; NaN where there is nothing to compare. */
typedef struct rotid_gain {
    rotid_pair frequency_rms_percent;          /* error of the frequencies that were fitted, rms [%] */
    rotid_pair frequency_max_percent;          /* the largest of them [%] */
    rotid_pair shape_rms;                      /* of the difference relative to the largest component [1] */
    rotid_pair chi2_per_dof;                   /* [1] */
    rotid_pair nco_min;                        /* smallest of the fitted modes [1] */
    rotid_pair holdout_frequency_rms_percent;  /* modes held out by the deck [%] */
    rotid_pair holdout_shape_rms;              /* modes held out by the deck [1] */
    rotid_pair mode_out_frequency_rms_percent; /* modes left out in turn [%] */
    rotid_pair mode_out_shape_rms;             /* modes left out in turn [1] */
    rotid_pair sensor_out_shape_rms;           /* sensors left out in turn [1] */
    int nparameters;
    rotid_changed_parameter *parameters; /* of either model */
} rotid_gain;

/* What the base model leaves at a sensor. */
typedef struct rotid_sensor_residual {
    int id;            /* as in the deck or the universal file */
    double z_m;        /* position [m] */
    double rms;        /* of its shape residuals over their noise [1]; NaN where nothing was measured */
    const char *state; /* name of the state that it is a sensor of; NULL in a deck without *STATE */
} rotid_sensor_residual;

/* A place on the axis. */
typedef struct rotid_localisation {
    double z_m;       /* [m] */
    double indicator; /* force that the base model lacks there, largest 1 [1] */
} rotid_localisation;

/* The smallest deviation of a cause from its neutral value that these data show 9 times in 10, with 3 % of false alarms. */
typedef struct rotid_detectable {
    const char *id;        /* of the catalogue */
    const char *target;    /* as in candidates */
    const char *parameter; /* its size */
    double smallest;       /* deviation from neutral, at the best place */
    const char *unit;      /* of smallest and worst */
    double z_m;            /* the best place [m]; NaN where there is none */
    double worst;          /* smallest size at the worst place */
    int beyond;            /* no size within physical bounds would show */
} rotid_detectable;

/* A step of the diagnosis. */
typedef struct rotid_step {
    const char *name; /* of the step */
    double seconds;   /* [s] */
} rotid_step;

/* What the model gets wrong, and why. */
typedef struct rotid_diagnosis {
    int interrupted; /* stopped by a signal or by the host: what was finished is there */
    rotid_verdict verdict;
    int ndata_findings;
    rotid_data_finding *data_findings; /* faults of the measurement chain, taken out of the data */
    int nnumerical_findings;
    rotid_numerical_finding *numerical_findings; /* errors of the model's own numbers, removed */
    int nrounds;
    rotid_round *rounds; /* one: the model of the deck before any cause */
    int ncandidates;
    rotid_candidate *candidates; /* of all rounds, best first within a round */
    rotid_gain gain;
    int nmodes_standardised;
    double *modes_standardised; /* frequency residual of the base model over its noise, per entry of base.modes [1] */
    int nsensors;
    rotid_sensor_residual *sensors; /* by increasing position */
    int nlocalisation;
    rotid_localisation *localisation; /* along the axis */
    int ndetectable;
    rotid_detectable *detectable;   /* what would have shown with 90 % power at 3 % false alarm */
    rotid_noise noise;              /* typical, in use */
    rotid_geometry *geometry;       /* the base model at the values of its fit, faults of the data taken out, on the mesh that was
                                       judged;       that of the deck where a signal came first. NULL in old results */
    rotid_identification *today;    /* the fit by the FIT of the deck; NULL where it is that of base or could not be made */
    rotid_identification *base;     /* the full model by the likelihood, faults of the data taken out */
    rotid_identification *extended; /* with the causes that were named; NULL where nothing was named */
    int nsteps;
    rotid_step *steps; /* where the time went */
    int nmessage;
    const rotid_message *message;
    const char *extended_deck;  /* the deck with the named causes and the fitted values in it, as text, which names files by
                                   absolute  paths; NULL where no deck reads as that model: a warning says why */
    void *memory;               /* internal */
    const char *before, *after; /* the states of which it says what changed between them, exchanged where what is gone in the
                                   second one explains them better; NULL: it says what the model lacks */
    int nhidden;
    rotid_hidden *hidden; /* for each parameter of *IDENTIFY those that move it most, the largest first, three at most */
    int nparameters;
    rotid_averaged_parameter *parameters; /* of *IDENTIFY, over all explanations: the values to design with */
} rotid_diagnosis;

/* ---- suggestion: what to measure next */

/* What the frequencies and shapes of the lowest modes would say of the parameters of *IDENTIFY, in their order. Half-widths are
 * half of a 95 % interval over the value, NaN where the parameter stays undetermined. */
typedef struct rotid_expected_modes {
    int modes; /* measured: the first ones */
    int nfrequencies_percent, nshapes_percent;
    double *frequencies_percent; /* half-width by the frequencies alone [%] */
    double *shapes_percent;      /* half-width by frequencies and shapes at the sensors of the first plan [%] */
} rotid_expected_modes;

/* Where sensors could stand, and what they would be worth there. */
typedef struct rotid_sensor_plan {
    const char *method; /* deck, optimal (Bayesian D-optimal), or effective_independence (Kammer 1991) */
    int nz_m, nloss_percent, nhalf_width_percent;
    double *z_m;                /* positions from the left end [m] */
    double *loss_percent;       /* per entry of z_m: by how much the standard deviations of moduli and causes grow without it,
                                   geometric mean [%] */
    double *half_width_percent; /* of each parameter, as in the modes [%] */
    double gain_percent; /* by how much these standard deviations are below those of the frequencies alone, geometric mean [%] */
} rotid_sensor_plan;

/* How far a number of sensors leads, the best places taken one after the other. */
typedef struct rotid_sensor_count {
    int sensors;               /* how many */
    double half_width_percent; /* the widest of the parameters [%] */
    double gain_percent;       /* as in the plans [%] */
} rotid_sensor_count;

/* One more sensor at a place. */
typedef struct rotid_sensor_place {
    double z_m;            /* from the left end [m] */
    double worth_percent;  /* by how much it lowers the standard deviations of moduli and causes, geometric mean [%] */
    double margin_percent; /* by how much it raises what tells the rivals apart in the same test again, mean [%]; NaN without
                              rivals */
} rotid_sensor_place;

/* One of the explanations that a diagnosis cannot tell apart. */
typedef struct rotid_rival {
    const char *label; /* such as joint of core|right */
    int ncauses;
    rotid_cause *causes; /* none of the model as it is */
    double chi2;         /* of its fit to what was measured [1] */
    double score;        /* -2 ln of its probability by what is measured [1] */
    double share;        /* of it among the rivals, exp(-score/2) over the sum of all; 0 of the model as it is [1] */
} rotid_rival;

/* What tells two rivals apart if the first of them is true. */
typedef struct rotid_expected_margin {
    int truth;       /* index of the rivals, from 0 */
    int rival;       /* the one that it is to be told from, likewise */
    double before;   /* lead of the truth by what is measured already [1] */
    double distance; /* chi2 by which the best fit of the rival to all states fails, without noise [1] */
    double expected; /* lead by all states, on the average over noise and over what is not known of the truth [1] */
    double refitted; /* before and distance by a nonlinear fit of the rival to all states; NaN where that was not made [1] */
    double chance;   /* that the lead suffices */
} rotid_expected_margin;

/* A test that could be made next, and what it promises. */
typedef struct rotid_suggested_test {
    const char *id;   /* again, modes, sensors, shapes, noise, mass, stiff_support, free or moved_support */
    const char *text; /* what to do */
    double cost;      /* in points: the set-ups times their cost and the points [1] */
    int setups;       /* what has to be hung, mounted or moved */
    int points;       /* measured at each sensor, repeated where the noise asks for it */
    int modes;        /* measured */
    int nsensors_m;
    double *sensors_m; /* positions of the sensors; empty where frequencies alone are measured [m] */
    double mass_kg;    /* of the known mass [kg]; NaN without */
    double z_m;        /* where it goes, or the support [m]; NaN without */
    double chance;     /* that the true one of the rivals is named afterwards */
    double wrong;      /* that another one is named */
    double entropy;    /* of the probabilities of the rivals afterwards, expected [nat] */
    int nexpected_percent;
    double *expected_percent; /* half of the 95 % intervals of the parameters afterwards, averaged over the rivals [%] */
    int nmargins;
    rotid_expected_margin *margins;
    const char *cards; /* of the deck: the *STATE of this test, with comments where its measurements go */
} rotid_suggested_test;

/* A test at rest, for a critical speed. */
typedef struct rotid_speed_test {
    const char *test; /* in words: "the 6 modes again" */
    int modes;        /* measured in it */
    double std_rpm;   /* of the critical speed, expected behind it, in linear prediction [rpm]; NaN where it leaves that open */
    double narrowed_percent; /* by how much that is below the present one [%]; NaN where one of them is not known */
} rotid_speed_test;

/* What to measure, before a test and after an ambiguous diagnosis. */
typedef struct rotid_suggestion {
    int nparameters;
    rotid_fitted_parameter *parameters; /* of *IDENTIFY at the values that all of this holds for: std and ci95 as measured, NaN
                                           where nothing is */
    rotid_noise noise;                  /* that is expected of the tests */
    double wanted_percent;              /* half-width that is asked for [%] */
    int modes_needed;                   /* modes whose frequencies alone reach it; null: none of the numbers below */
    int sensors_needed;                 /* sensors that reach it with the modes of the plans; null: none of the numbers below */
    int plan_modes;                     /* modes of the plans */
    int nmodes;
    rotid_expected_modes *modes;
    int nplans;
    rotid_sensor_plan *plans; /* that of the deck first, where it has sensors; then the best places, then the classic */
    int ncounts;
    rotid_sensor_count *counts;
    int nplaces;
    rotid_sensor_place *places; /* one more sensor beside those of the first plan, along the axis */
    int ndetectable;
    rotid_detectable *detectable; /* what the first plan would show of each cause */
    const char *verdict;          /* of the diagnosis in a sentence; NULL where nothing is measured */
    int nrivals;
    rotid_rival *rivals; /* best first; empty where nothing is open. The last is the model as it is */
    double among;        /* how likely the true cause is one of them; NaN without rivals */
    double entropy;      /* of the probabilities of the rivals now [nat]; NaN without */
    int ntests;
    rotid_suggested_test *tests; /* by chance, then by cost */
    double set_up_cost;          /* of a set-up, in points [1] */
    const char *state;           /* of a deck with states: the one that plans and tests are made like; NULL of others */
    const char *sentence;        /* what to do next */
    rotid_geometry *geometry;    /* the model that all of this holds for */
    int nmessage;
    const rotid_message *message;
    void *memory;            /* internal */
    double speed_rpm;        /* critical speed that was asked for, of which the tests are speed_tests [rpm]; NaN where none was */
    double speed_std;        /* its standard deviation as measured, in linear prediction [rpm]; NaN where nothing is measured */
    double speed_identified; /* share of the unknowns in its variance, of which tests at rest take away [1]; NaN as speed_rpm */
    int nspeed_tests;
    rotid_speed_test *speed_tests; /* by std_rpm */
} rotid_suggestion;

/* Of a critical speed to the running range. */
typedef struct rotid_speed_margin {
    double value;   /* (low - W)/low below the range, (W - high)/high above it, below 0 inside [1]; by the speed of the peak where
                       there is one; NaN of backward whirl, without a peak beside others and without a range */
    double ci95[2]; /* 95 % interval of value [1] */
    double required;    /* what the deck requires of value [1]; NaN where it states nothing */
    double probability; /* that value is at least what is required [1]; NaN without bands */
} rotid_speed_margin;

/* Of the unbalance response at a probe, nearest to a critical speed. */
typedef struct rotid_response_peak {
    const char *probe;    /* its name */
    double speed_rpm;     /* of the peak [rpm] */
    double amplitude_m;   /* zero to peak [m] */
    double amplification; /* speed over the width at 0.707 of the peak [1]; NaN where another peak is nearer than that */
} rotid_response_peak;

/* Of one source of doubt. */
typedef struct rotid_variance_share {
    const char
        *source;  /* identified (all unknowns of the fit together), bearing NAME, loss GROUP, pull GROUP, change PARAMETER */
    double share; /* in the variance of the linear prediction [1] */
} rotid_variance_share;

/* What one uncertain number does to a critical speed: derivatives by its logarithm, by itself where it may be zero. */
typedef struct rotid_speed_sensitivity {
    const char *parameter; /* its name: core.E, de.k, de.c, loss GROUP, pull GROUP, change PARAMETER */
    double speed;          /* d ln speed_rpm [1] */
    double log_decrement;  /* d log_decrement there [1] */
    double amplitude;      /* d ln amplitude_m of the peak by which the margin is judged [1]; NaN without a peak */
} rotid_speed_sensitivity;

typedef struct rotid_critical_speed {
    int number;                   /* from 1, by rising speed */
    int mode;                     /* of the Campbell diagram, from 1 */
    double speed_rpm;             /* where Im lambda is harmonic times the speed [rpm] */
    double std;                   /* standard deviation of speed_rpm by draws [rpm]; NaN without uncertain numbers */
    double ci95[2];               /* 95 % interval of speed_rpm by draws [rpm] */
    const char *whirl;            /* backward, mixed (the orbits along the rotor differ) or forward */
    double log_decrement;         /* there, without the jump of loss factors [1] */
    double log_decrement_ci95[2]; /* 95 % interval of it by draws [1]; NaN without uncertain numbers */
    double damping_ratio;         /* there, the same of critical damping [1] */
    double amplification;         /* largest of the peaks [1]; NaN where none is known */
    rotid_speed_margin margin;    /* to the running range */
    int npeaks;
    rotid_response_peak *peaks; /* of the unbalance response, by probe */
    int nvariance_shares;
    rotid_variance_share *variance_shares; /* where the doubt of speed_rpm comes from */
    int nsensitivities;
    rotid_speed_sensitivity *sensitivities; /* by each uncertain number */
    int nz;
    double *z;    /* places along the axis [m] */
    double *x_re; /* shape at each z: real part of the motion in x, largest component 1 [1] */
    double *x_im; /* imaginary part of it [1]; the motion is Re (x e^iwt) */
    double *y_re; /* real part of the motion in y, upwards [1] */
    double *y_im; /* imaginary part of it [1] */
} rotid_critical_speed;

typedef struct rotid_campbell_mode {
    int mode;                     /* from 1, of one mode over all speeds */
    double frequency_hz;          /* |Im lambda|/2 pi in the fixed frame [Hz] */
    double ci95[2];               /* 95 % interval of frequency_hz by the linear prediction [Hz]; NaN without uncertain numbers */
    double damping_ratio;         /* -Re lambda/|lambda| [1]; below 0 the mode grows */
    double log_decrement;         /* [1] */
    double log_decrement_ci95[2]; /* 95 % interval of it by the linear prediction [1] */
    const char *whirl;            /* backward, mixed or forward */
} rotid_campbell_mode;

typedef struct rotid_campbell_speed {
    double speed_rpm; /* [rpm] */
    int nmodes;
    rotid_campbell_mode *modes; /* by rising frequency; overdamped ones are left out */
} rotid_campbell_speed;

typedef struct rotid_stability {
    double onset_rpm;          /* lowest speed from which a mode grows [rpm]; NaN: none up to the highest one computed */
    int mode;                  /* which, of the Campbell diagram; ROTID_NONE: none, or a motion without whirl */
    double probability_stable; /* that no mode grows at the highest running speed [1]; NaN without bands or range */
} rotid_stability;

typedef struct rotid_probe_response {
    const char *probe; /* its name */
    int nspeed_rpm;
    double *speed_rpm;   /* [rpm] */
    double *amplitude_m; /* at each speed, zero to peak [m] */
    double *phase_deg;   /* at each speed: lag behind the mark at angle 0, 0 to 360 [deg] */
    double *from_m;      /* lower limit of the 95 % interval of amplitude_m, by draws [m]; NaN without bands */
    double *to_m;        /* upper limit [m] */
} rotid_probe_response;

typedef struct rotid_bearing_load {
    const char *bearing; /* its name, NULL where it has none */
    double position_m;   /* from the left end [m] */
    double load_x_n; /* force of the weight on the bearing in x, at the lowest running speed or the highest one computed [N] */
    double load_y_n; /* the same in y, upwards [N] */
} rotid_bearing_load;

typedef struct rotid_map_row {
    double stiffness_factor; /* on the stiffness of all bearings [1] */
    int nspeed_rpm;
    double *speed_rpm; /* undamped forward critical speeds with the mean of both direct stiffnesses [rpm] */
    double
        *from_rpm;  /* lower limit of the 95 % interval of each by the linear prediction, the bearings known [rpm]; NaN without */
    double *to_rpm; /* upper limit [rpm] */
} rotid_map_row;

/* A line of the Campbell diagram along which the machine is excited. */
typedef struct rotid_excitation {
    const char *name;      /* 1x, 2x, line, 2x line */
    double per_revolution; /* its frequency is hz + per_revolution times the speed [1] */
    double hz;             /* [Hz] */
} rotid_excitation;

/* A torsional natural frequency of the machine, free of its bearings. */
typedef struct rotid_torsional_frequency {
    int number;          /* from 1, above the free rotation */
    double frequency_hz; /* [Hz] */
    double std_hz;       /* its standard deviation by the moduli and what changed in operation, in linear prediction [Hz] */
} rotid_torsional_frequency;

/* The machine in operation. */
typedef struct rotid_speeds {
    double low_rpm;     /* lowest running speed [rpm]; NaN where no range is stated */
    double high_rpm;    /* highest running speed [rpm] */
    double harmonic;    /* excitation per revolution that the critical speeds are of [1] */
    int draws;          /* of the bands; 0: nothing is uncertain */
    double basis_error; /* largest relative change of a critical speed by half as large a basis again [1] */
    int ncritical_speeds;
    rotid_critical_speed *critical_speeds; /* by rising speed */
    rotid_stability stability;             /* whether a mode grows */
    int ncampbell;
    rotid_campbell_speed *campbell; /* modes over the speed */
    int nexcitation;
    rotid_excitation *excitation; /* with LINE or POLES of *OPERATION */
    int nunbalance;
    rotid_probe_response *unbalance; /* response at each probe */
    double weight_n;                 /* of the rotor [N] */
    double sag_m;                    /* largest deflection by it, with that of the bearings [m] */
    int nbearing_loads;
    rotid_bearing_load *bearing_loads; /* by weight */
    int nmap;
    rotid_map_row *map; /* critical speed map: over the stiffness of the bearings */
    int nrunup;
    rotid_runup_speed *runup; /* measured critical speeds beside these, in the order of *RUNUP */
    int ntorsion;
    rotid_torsional_frequency *torsion; /* the lowest ones; none where the model has none */
    int nmessage;
    const rotid_message *message;
    void *memory; /* internal */
} rotid_speeds;

/* ---- the runs */

/* What `rotid check` says of a deck, of which the model is taken as the deck states it. Statuses as for rotid_spectrum_compute.
 */
ROTID_API int rotid_deck_check(const rotid_deck *deck, const rotid_environment *environment, char *failure, rotid_check **check);
ROTID_API void rotid_check_free(rotid_check *check);

/* The lowest nmode elastic modes at the values x [nparameter] of the parameters of the deck, at their starts where x is NULL, and
 * the measured modes beside them; nmode 0: as many as the pairing looks through, at least six. Statuses: every ROTID_ERROR_ but
 * UNPAIRED, RANK, SYNTAX and IO. *spectrum is NULL on an error. */
ROTID_API int rotid_spectrum_compute(const rotid_deck *deck, const double *x, int nmode, const rotid_environment *environment,
                                     char *failure, rotid_spectrum **spectrum);
/* The same with `beside`: the rotor as a beam and as a solid at these values, whichever of them the deck asks for, and the moduli
 * that a beam fitted to the frequencies of the solid would have. ROTID_ERROR_SECTION where a part of the rotor has no meaning in
 * the other one; failure says which. Cancelled: ROTID_STOP_CANCELLED and *spectrum NULL. */
ROTID_API int rotid_spectrum_beside(const rotid_deck *deck, const double *x, int nmode, const rotid_environment *environment,
                                    char *failure, rotid_spectrum **spectrum);
/* rotid_spectrum_compute of the modes of a type, whichever type the deck states for its measured ones: ROTID_BENDING,
 * ROTID_TORSION or ROTID_AXIAL. Measured modes of another type are left out. ROTID_ERROR_ARGUMENT where type is none of these. */
ROTID_API int rotid_spectrum_of_type(const rotid_deck *deck, int type, const double *x, int nmode,
                                     const rotid_environment *environment, char *failure, rotid_spectrum **spectrum);
ROTID_API void rotid_spectrum_free(rotid_spectrum *spectrum);

/* What `rotid identify` does: pairs, fits *IDENTIFY of the deck by its FIT, pairs again; over all states of a deck at once. With
 * nothing to identify the model is compared as it stands. baseline: nonzero, checks as well: NLopt on the same objective, and
 * what may hide in the parameters (`hidden`). The environment's allocator must exist until the result is freed. Statuses: every
 * ROTID_ERROR_ but SYNTAX and IO; ARGUMENT where the deck has errors or nothing measured. Cancelled: ROTID_OK with fit->status ==
 * ROTID_STOP_CANCELLED and the best point so far. On an error *result is NULL. Cancelled while NLopt runs, or without NLopt (make
 * WITH_NLOPT=0): the fit is complete and fit->nbaseline is 0. */
ROTID_API int rotid_identify(const rotid_deck *deck, int baseline, const rotid_environment *environment, char *failure,
                             rotid_identification **result);
ROTID_API void rotid_identification_free(rotid_identification *result);

/* ---- diagnosis: what the model gets wrong, and why */

/* Zero takes the default in brackets. */
typedef struct rotid_diagnose_options {
    size_t size;
    int threads;                /* [1] of this call; its BLAS should have one then */
    const char *before, *after; /* [NULL] names of two states of the deck: what changed between them, not what the model lacks */
} rotid_diagnose_options;

/* What `rotid diagnose` does, over all states of a deck at once, or of what changed between two of them; the same numbers
 * whatever the number of threads. options may be NULL. Allocator, statuses, failure and *result as for rotid_identify. The
 * allocator and the callbacks of the environment are called from several threads where options ask for more than one. */
ROTID_API int rotid_diagnose(const rotid_deck *deck, const rotid_diagnose_options *options, const rotid_environment *environment,
                             char *failure, rotid_diagnosis **result);
ROTID_API void rotid_diagnosis_free(rotid_diagnosis *result);
/* "adequate", "named", "ambiguous", "unexplained". */
ROTID_API const char *rotid_verdict_name(int kind);

/* ---- suggestion: what to measure next */

/* Zero takes the default in brackets. */
typedef struct rotid_suggest_options {
    size_t size;
    double wanted_percent;  /* [2] half of a 95 % interval over the value */
    double frequency_noise; /* [that of the deck, else 0.003] relative */
    double shape_noise;     /* [that of the deck, else 0.02] relative to the largest component */
    double set_up_cost;     /* [20] of a set-up, where a point costs 1 */
    int sensors;            /* [those of the deck, else 8] of a plan, at most 1000 */
    int modes;              /* [those of the deck, else 5] of a plan, 2 ... 100 */
    int threads;            /* [1] of the diagnosis */
    long seed;              /* [1] >= 0 */
    int speed;              /* [none] number of the critical speed, from 1, that tests at rest are to narrow, in place of the
                               rest: of those with forward or mixed whirl, */
    int speed_backward;     /* [0] nonzero: with backward whirl */
} rotid_suggest_options;

/* What `rotid suggest` does: without measured modes what sensors and modes would tell of the parameters of *IDENTIFY, at their
 * starts; with them a diagnosis, and where it is ambiguous the tests that could end that. options may be NULL. Allocator,
 * statuses, failure and *result as for rotid_diagnose; cancelled: ROTID_STOP_CANCELLED and *result NULL. */
ROTID_API int rotid_suggest(const rotid_deck *deck, const rotid_suggest_options *options, const rotid_environment *environment,
                            char *failure, rotid_suggestion **result);
ROTID_API void rotid_suggestion_free(rotid_suggestion *result);

/* Zero takes the default in brackets. */
typedef struct rotid_speeds_options {
    size_t size;
    double from_rpm; /* [0] lowest speed of the Campbell diagram */
    double to_rpm;   /* [1.3 times the running range; without one, beyond the third forward critical speed] above from_rpm */
    double harmonic; /* [1] excitation per revolution, above 0 and at most 100 */
    int count;       /* [41] speeds of the Campbell diagram, 2 ... 10000 */
    int draws;       /* [2000] of the bands, at most 1e6; negative: no bands */
    int threads;     /* [1] of the draws */
    int no_fit;      /* nonzero: the unknowns are taken at their starts, and as known */
    long seed;       /* [1] >= 0 */
} rotid_speeds_options;

/* What `rotid speeds` does: the machine behind *RUNNING at the unknowns that rotid_identify gives, with bands. options may be
 * NULL. Allocator, statuses, failure and *result as for rotid_identify; ROTID_ERROR_ARGUMENT where the deck has no *RUNNING;
 * cancelled before the bands are there: ROTID_STOP_CANCELLED, and *result without them, or NULL where it is of the fit. */
ROTID_API int rotid_speeds_compute(const rotid_deck *deck, const rotid_speeds_options *options,
                                   const rotid_environment *environment, char *failure, rotid_speeds **result);
ROTID_API void rotid_speeds_free(rotid_speeds *result);

/* ------------------------------------------------------------------------------------------------ bring your own model */

/* A symmetric matrix A = B + P C P': a band B, and a small dense block C on a few degrees of freedom that couple across it
 * (tie rods join the two ends of a core). n >= 1, 0 <= kd <= n - 1; a dense matrix is a band with kd = n - 1. */
typedef struct rotid_matrix {
    int n, kd, nfar;
    const int *far; /* [nfar] degrees of freedom of C, increasing */
    double *band;   /* [(kd + 1) * n] lower triangle: B(i, j) = band[(i - j) + j * (kd + 1)], j <= i <= min(n - 1, j + kd) */
    double *block;  /* [nfar * nfar] C, both triangles: alike but for rounding, else ROTID_ERROR_ARGUMENT where it is used */
} rotid_matrix;

/* A model with nparam >= 0 parameters x. `matrices` and `derivatives` receive matrices of the structure declared here, set to
 * zero, and return 0 or anything else for failure. K is positive semidefinite, M positive definite. */
typedef struct rotid_model {
    size_t size;
    int n, kd, nfar;
    const int *far;
    int nparam;
    int nrigid;        /* the lowest nrigid modes are not counted: rigid-body and suspension modes */
    int nmaster;       /* number of sensors */
    const int *master; /* [nmaster] degree of freedom of each sensor, distinct, increasing */
    int (*matrices)(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass);
    /* dK/dx_p and dM/dx_p; NULL: differences of fourth order of `matrices`, central over x_p (1 +- 0.004), or over x_p ... x_p (1
     * +- 0.008) on one side where `matrices` fails on the other; 1e-9 accurate for parameters that act strongly, 1e-7 for weak
     * ones */
    int (*derivatives)(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass);
    void *user;
    int nmodes;          /* vectors in modes, 0 for none */
    const double *modes; /* [n * nmodes] vectors near the lowest modes, rigid ones included, from which the first solution of the
                            full model begins where they are as many as it needs: of a model nearby, say. The result is the same
                            but for rounding. NULL: none */
    /* NULL, or dk_u := dK/dx_p u and dm_u := dM/dx_p u for u [n * count], which takes less time than the matrices: returns 0,
     * anything else where `derivatives` are to be asked for this parameter. */
    int (*derivative_products)(void *user, const double *x, int p, int count, const double *u, double *dk_u, double *dm_u);
    const double *sensor; /* NULL, or [n * nmaster]: the motion at sensor s is column s times u, where a sensor lies between
                             degrees of freedom or the unknowns are no motions (of modes, say); ROTID_REDUCTION_NONE alone. master
                             is not read then */
} rotid_model;

/* The measured modes. Shapes are optional; their scale and sign are free, each mode is scaled to a largest component of 1
 * before use. */
typedef struct rotid_measured {
    size_t size;
    int nmode;
    const int *number;           /* [nmode] mode of the model that each is paired with, counted from 1 after the rigid ones */
    const double *frequency_hz;  /* [nmode] > 0 */
    const double *frequency_std; /* [nmode] relative standard deviation > 0, finite, or NULL where the noise is not known */
    const double *shape;         /* [nmaster * nmode] column-major at the masters, NaN where not measured; or NULL */
    const double *shape_std;     /* [nmaster * nmode] the same, relative to the largest component of the mode; or NULL */
    const int *holdout;          /* [nmode] nonzero: predicted and compared, not fitted; or NULL */
    /* What the structure weighs, r'M r, and where its centre of mass is, r'M s/(r'M r): rows of ROTID_LIKELIHOOD behind those of
     * the modes, where any mode is fitted */
    const double *whole;       /* [2 * n] the motions r, all of the structure moves by 1, and s, every point moves by its place z
                                  [m]; NULL: not weighed */
    double mass, mass_std;     /* > 0; standard deviation, 0: not measured [kg] */
    double centre, centre_std; /* the same of the centre of mass [m] */
} rotid_measured;

/* A structure as it was measured once: free, on its bearings, with a known mass. Several of them share unknowns. */
typedef struct rotid_state {
    size_t size;
    const rotid_model *model;
    const rotid_measured *measured;
    const int *parameter; /* [model->nparam] which of the unknowns of rotid_fit_states each parameter of the model is, from 0; two
                             may be one; NULL: the first ones in their order */
} rotid_state;

enum { ROTID_LIKELIHOOD, ROTID_HYBRID, ROTID_HYBRID_F }; /* functional */
enum { ROTID_REDUCTION_NONE, ROTID_GUYAN, ROTID_IRS };   /* reduction */
enum { ROTID_NELSON, ROTID_MODAL };                      /* eigenvector derivative; ROTID_MODAL needs a reduction */

/* Zeros but for the size, or rotid_fit_defaults, which are one choice: a zero takes the default in brackets. */
typedef struct rotid_fit_options {
    size_t size;
    int functional, reduction, derivative; /* [ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON] */
    int baseline;                          /* nonzero: minimise the same objective with NLopt as well, where the library has it */
    int max_iterations;                    /* [100] */
    double gradient_tolerance;             /* [1e-10] of the cosine between the residual and each column of the Jacobian */
    double step_tolerance;                 /* [1e-12] relative step */
    double bijection_chi; /* [0.05] 1e-50 ... 1e6: chi of x = alpha + (beta - alpha)/(1 + exp(chi y)), variables scaled by
                             their start */
    double decrease_tolerance, objective_tolerance; /* [0], [1e-16] as in rotid_lm_options */
    double decrease_least;                          /* [0] as there; of ROTID_LIKELIHOOD half of chi2 */
} rotid_fit_options;

/* *options := ROTID_LIKELIHOOD without reduction, the defaults in brackets; size is sizeof *options of the host. */
ROTID_API void rotid_fit_defaults(size_t size, rotid_fit_options *options);

typedef struct rotid_fit_iteration {
    int iteration;
    double objective;  /* half the sum of squared residuals */
    double gradient;   /* largest component of the gradient with respect to x_p / start_p */
    double mu;         /* damping in use */
    double gain_ratio; /* actual over predicted decrease of the step that led here; NaN at iteration 0 */
    double step;       /* norm of that step in x_p / start_p */
    double seconds;    /* since the iteration began */
} rotid_fit_iteration;

typedef struct rotid_baseline {
    const char *algorithm, *result; /* NLopt's names */
    int code;                       /* NLopt's result */
    int usable;                     /* converged, or stopped by rounding at a minimum */
    double objective, seconds, gradient;
    int evaluations; /* of the model; each gradient counts as part of its evaluation */
    double *x;       /* [nparam] */
} rotid_baseline;

/* Everything is owned by the result and released with it. n = nparam, m = nmode of the measured data, of all states one after
 * the other. */
struct rotid_fit_result {
    int status;    /* why the iteration ended: ROTID_STOP_... */
    int converged; /* a minimum was reached: inside the bounds or pressed against one */
    int any_at_bound, any_undetermined;
    int n, m, nresidual, dof;
    double objective, gradient, chi2, chi2_per_dof; /* chi2 is NaN where the noise is not known */
    int iterations, evaluations, jacobians;
    double seconds;
    double *x, *std, *ci_lower, *ci_upper; /* [n]; NaN where they cannot be stated */
    int *at_bound, *identifiable;          /* [n] */
    double *covariance, *correlation;      /* [n * n] */
    double condition_number;               /* of the Jacobian with respect to x_p / x_p*; NaN where n = 0 */
    double *singular_value;                /* [n] of that Jacobian, decreasing */
    double *direction;                     /* [n * n] right singular vectors, column j belongs to singular_value[j] */
    int *direction_undetermined;           /* [n] */
    double widened_by;                     /* factor by which the intervals were widened, 1 where they were not */
    int variance_from_residuals;           /* 1: Student t with dof; 0: from the stated noise */
    double *predicted_hz, *mac, *residual; /* [m]; mac NaN without a shape; residual of the functional, held-out modes too */
    double *r;        /* [nresidual] of the fitted modes at x: their frequencies, then for a likelihood the measured components of
                         their shapes mode by mode, sensors increasing; objective = r'r/2 */
    double *jacobian; /* [nresidual * n] column-major, dr_i/dx_p there */
    int nhistory;
    rotid_fit_iteration *history; /* [nhistory], iteration 0 first */
    double *history_x;            /* [n * nhistory] */
    int nbaseline;
    rotid_baseline *baseline;
    void *memory;                   /* internal */
    int nstate;                     /* 1 of rotid_fit */
    int *state_m, *state_nresidual; /* [nstate] how many of the m modes, and of the residuals, are those of each state */
};

/* Minimises f(x) = 1/2 sum r^2 over lower < x < upper by Levenberg-Marquardt on y with the bijection of the paper's (30).
 *   ROTID_HYBRID      r_k = 1 - R*_k / w^_k^2, R*_k = phi^' K~ phi~ / (phi^' M~ phi~)            (15)
 *   ROTID_HYBRID_F    r_k = 1 - R*_k / (w^_k w~_k)                                                (16)
 *   ROTID_LIKELIHOOD  r_k = (f_k - f^_k)/s_k and (a_k phi_kj - phi^_kj)/s_kj, a_k the best scale; needs frequency_std, and
 *                     shape_std where shapes are given
 * Entry: `nparam` parameters, `measured` with at least one fitted mode, each mode
 * number once; `options` NULL: the defaults. With nparam = 0 (`parameter` may be NULL) the model is
 * only evaluated and compared: converged with ROTID_STOP_GRADIENT after 0 iterations, chi2 and dof of the residuals, arrays over
 * the parameters empty, no baseline. Exit: *result, to be freed with rotid_fit_free, also when the iteration ended without
 * convergence (status >= 0). On an error (< 0) *result is NULL. Statuses: every ROTID_ERROR_ but SYNTAX and IO. Memory:
 * O(nmaster^2 + n kd). The iteration itself allocates nothing but room for a history beyond 100 iterations. A parameter whose
 * column of the Jacobian is below 1e-13 of the largest does not move: what is left of it is rounding of the others. */
ROTID_API int rotid_fit(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
                        const rotid_fit_options *options, const rotid_environment *environment, char *failure,
                        rotid_fit_result **result);
/* The same over several states, one objective f(x) = 1/2 sum of r^2 over all, for nparam unknowns of which each model uses those
 * that state->parameter names. A parameter that one state leaves open another may determine. Entry: state [nstate], nstate >= 1,
 * each state[0].size behind the other; sensors, noise and modes are those of each state. A state with all modes in holdout is
 * predicted and compared alone; some state has a mode that is fitted, and every unknown acts in such a state. Exit: as above,
 * modes and residuals state by state. Time and memory are the sum over the states. Texts in failure begin with "state[s]: " where
 * one state is meant. rotid_check_model looks at the derivatives of one model after the other. */
ROTID_API int rotid_fit_states(int nstate, const rotid_state *state, int nparam, const rotid_parameter *parameter,
                               const rotid_fit_options *options, const rotid_environment *environment, char *failure,
                               rotid_fit_result **result);
/* NULL is allowed. The allocator of the environment that the fit was given has to exist until then. */
ROTID_API void rotid_fit_free(rotid_fit_result *result);

/* A cause that the model of a host may lack: what it adds to K and M. Causes of one name are one kind, at several targets. */
typedef struct rotid_host_cause {
    size_t size;
    const char *name, *target;        /* "crack", "blade 3"; target NULL: "" */
    int nparameter;                   /* 1 to 4 */
    const rotid_parameter *parameter; /* [nparameter] bounds are what is possible, start is where fits begin, not neutral */
    const double *neutral;            /* [nparameter] there is no cause there; NULL: 0 */
    const double *deviation; /* [nparameter] expected before the data: normal about neutral with this deviation, between the
                                bounds; 0, or NULL: uniform between them, of positive bounds in ln */
    /* adds what the cause changes at these values [nparameter] to the matrices of the model at x; 0: done */
    int (*add)(void *user, const double *x, const double *value, rotid_matrix *stiffness, rotid_matrix *mass);
    void *user;
} rotid_host_cause;

/* Zeros but for the size: the defaults in brackets. */
typedef struct rotid_host_options {
    size_t size;
    const double *position; /* [nmaster] of the sensors along the structure [m]; NULL [errors of the model are not smooth] */
    double length;          /* of the structure [m], with position: an error of the model is smooth over a part of it */
    int changed;            /* nonzero: something is known to be wrong: "nothing" has the prior of one cause among them [0.5] */
    int reserved;           /* 0 */
} rotid_host_options;

/* One explanation: none, one, two or three causes, perhaps with something else that no cause is. */
typedef struct rotid_host_explanation {
    int ncause, cause[3]; /* indices */
    int something_else;
    double probability;
    double chi2;               /* of its fit */
    double value[12], std[12]; /* 4 k + q: of parameter q of cause k, NaN beyond them */
} rotid_host_explanation;

typedef struct rotid_host_diagnosis {
    int verdict;                    /* ROTID_ADEQUATE ... ROTID_UNEXPLAINED */
    double nothing, something_else; /* probability that the model lacks nothing; that it lacks something that is no cause */
    int nexplanation;
    rotid_host_explanation *explanation; /* [nexplanation] largest probability first */
    int ncause;
    double *probability;                      /* [ncause] of each cause, alone or with others */
    int nparameter;                           /* of the model, averaged over all explanations: */
    double *mean, *std, *ci_lower, *ci_upper; /* [nparameter] 95 % */
    int dof;                                  /* of the model without a cause, and its chi2 */
    double chi2;
    void *memory; /* internal */
} rotid_host_diagnosis;

/* What the model of a host lacks: the explanations of measured modes by sets of up to three causes, and by something else, with
 * their probabilities P(H) Z(H), Z the integral of the likelihood over all parameters with their priors (docs/method.md, 11).
 * Entry: model, parameter [model->nparam] and measured as for rotid_fit by ROTID_LIKELIHOOD without a reduction, frequency_std
 * not NULL; cause [ncause], ncause >= 1, all of one size, their starts not 0; options NULL: the defaults. Every
 * cause is fitted alone, then the likeliest sets with one cause more. Exit: *diagnosis, to be freed with
 * rotid_host_diagnosis_free; NULL on an error. Statuses: those of rotid_fit; ROTID_STOP_CANCELLED, and *diagnosis is NULL. Time:
 * 1 + ncause fits and as many again for each of up to eight sets; memory O(ncause n kd). */
ROTID_API int rotid_diagnose_model(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
                                   int ncause, const rotid_host_cause *cause, const rotid_host_options *options,
                                   const rotid_environment *environment, char *failure, rotid_host_diagnosis **diagnosis);
/* NULL is allowed. The allocator of the environment of that call has to exist until then. */
ROTID_API void rotid_host_diagnosis_free(rotid_host_diagnosis *diagnosis);

/* Compares dK/dx_p and dM/dx_p as rotid_fit would use them, those of model->derivatives or differences where it is NULL, with
 * differences of `matrices` that are extrapolated over a sequence of steps inside the bounds (rotid_check_jacobian), at x
 * [nparam] between the bounds, NULL: at the starts. A derivative that is a fifth too large does not keep a fit from converging,
 * but its intervals are too narrow then. Entries are compared as A_ij / sqrt(A_ii A_jj), whatever their units, those of the far
 * block both triangles. error [2 * nparam]: |claimed - D| / max(|claimed|, |D|) of dK/dx_p, p = 0 ..., then of dM/dx_p, 0 where
 * both vanish, 1 where one does, or the same ratio of derivative_products and dK u, dM u for the lowest modes u, where that is
 * larger; doubt [2 * nparam]: the same ratio for what D may be wrong by. A derivative is wrong where its error exceeds both 1e-6
 * and doubt; both are NaN where `matrices` has no model around x, or x is within 1e-8 of a bound. K and M at x are looked at as
 * by the fit: positive (semi)definite, finite. Some thirty calls of `matrices` for each parameter, twice. Statuses: ROTID_OK,
 * _ARGUMENT, _MEMORY, _CALLBACK, _FINITE, _MASS, _STIFFNESS, _EIGEN. Memory: O(n kd + nfar^2), 35 + nparam times. */
ROTID_API int rotid_check_model(const rotid_model *model, const rotid_parameter *parameter, const double *x,
                                const rotid_environment *environment, char *failure, double *error, double *doubt);

/* ------------------------------------------------------------------------------------------------ building blocks: the beam */

/* Shear coefficient of an annulus after Cowper, (A.3): a = inner/outer diameter in [0, 1], -1 < nu <= 0.5. */
ROTID_API double rotid_shear_coefficient_annulus(double nu, double a);
/* Of a rectangle: 10 (1 + nu)/(12 + 11 nu) (Cowper 1966). */
ROTID_API double rotid_shear_coefficient_rectangle(double nu);

/* Cylinder of area S [m2] and second moment I [m4], (6): outer^2 = 8 I/S + 2 S/pi, inner^2 = 8 I/S - 2 S/pi.
 * ROTID_ERROR_SECTION when the inner diameter would be imaginary, ROTID_ERROR_ARGUMENT unless S, I > 0. */
ROTID_API int rotid_equivalent_cylinder(double area, double inertia, char *failure, double *outer, double *inner);

/* Element matrices [16] for (v1, theta1, v2, theta2). EI [N.m2] bending, kGS [N] shear stiffness, length l [m] > 0;
 * phi = 12 EI/(kGS l^2), (A.2); rhoS [kg/m], rhoI [kg.m]; axial force F [N], tension positive.
 *   rotid_element_stiffness  (A.1)        rotid_element_geometric  (A.4) corrected, see docs/errata.md
 *   rotid_element_mass       (B.1) + (B.2) */
ROTID_API void rotid_element_stiffness(double ei, double kgs, double l, double *stiffness);
ROTID_API void rotid_element_geometric(double force, double phi, double l, double *stiffness);
ROTID_API void rotid_element_mass(double rhos, double rhoi, double phi, double l, double *mass);

/* ------------------------------------------------------------------------------------------------ building blocks: matrices */

/* A(i, j) += value, and A(j, i) with it: into the band where it reaches, else into the block. ROTID_OK, or ROTID_ERROR_ARGUMENT
 * where the structure of the matrix has no such place; nothing is changed then. */
ROTID_API int rotid_matrix_add(rotid_matrix *a, int i, int j, double value, char *failure);
/* Adds the symmetric element matrix e [nd * nd] on the degrees of freedom dof [nd]; a negative dof is left out (held). Statuses
 * as above, nothing is changed on an error. */
ROTID_API int rotid_matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e, char *failure);
/* A := the symmetric matrix `full` [n, n] with leading dimension ld >= n, of which the lower triangle is read. ROTID_OK, or
 * ROTID_ERROR_ARGUMENT where it has an entry other than zero outside the structure of A. */
ROTID_API int rotid_matrix_set_dense(rotid_matrix *a, const double *full, int ld, char *failure);
/* full [n, n], leading dimension ld >= n := A, both triangles. ROTID_OK or ROTID_ERROR_ARGUMENT. */
ROTID_API int rotid_matrix_get_dense(const rotid_matrix *a, double *full, int ld, char *failure);
/* Y [n * columns] := A X [n * columns]; they do not overlap. */
ROTID_API int rotid_matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y, char *failure);

/* In the following K and M have the same n, kd and far, and symmetric blocks; `environment` may be NULL, of it only the allocator
 * is used. */

/* Condensation onto master degrees of freedom, u = T x: K~ = T'KT, M~ = T'MT. kind: ROTID_GUYAN (11-13), T = [-K_ii^-1 K_ic; I];
 * ROTID_IRS (O'Callahan 1989). master [nmaster] increasing, 1 <= nmaster <= n. kc, mc [nmaster * nmaster]; t [n * nmaster] or
 * NULL. Statuses: ROTID_OK, _ARGUMENT, _MEMORY, _SLAVE, _MASS (IRS), _FINITE. */
ROTID_API int rotid_condense(const rotid_matrix *k, const rotid_matrix *m, int nmaster, const int *master, int kind,
                             const rotid_environment *environment, char *failure, double *kc, double *mc, double *t);
/* The derivatives of K~ and M~ in the direction dK, dM (40, 41 corrected, docs/errata.md): dkc, dmc [nmaster * nmaster]. */
ROTID_API int rotid_condense_derivative(const rotid_matrix *k, const rotid_matrix *m, const rotid_matrix *dk,
                                        const rotid_matrix *dm, int nmaster, const int *master, int kind,
                                        const rotid_environment *environment, char *failure, double *dkc, double *dmc);

/* The lowest `count` pairs of K phi = lambda M phi, ascending, phi'M phi = 1: lambda [count] (rad/s)^2, phi [n * count]. A Sturm
 * count proves that none was missed. K positive semidefinite, M positive definite. Statuses: ROTID_OK, _ARGUMENT, _MEMORY, _MASS,
 * _STIFFNESS, _EIGEN, _FINITE. */
ROTID_API int rotid_eigenpairs(const rotid_matrix *k, const rotid_matrix *m, int count, const rotid_environment *environment,
                               char *failure, double *lambda, double *phi);
/* Derivatives of pair j of those lambda [count], phi [n * count] that rotid_eigenpairs gave, in the direction dK, dM:
 *   dlambda = phi' (dK - lambda dM) phi,   dphi [n] after Nelson (1976), with phi' M dphi = -1/2 phi' dM phi.
 * dphi may be NULL. Statuses: ROTID_OK, _ARGUMENT, _MEMORY, _FINITE, _CLOSE (for dphi: pair j has a neighbour within 1e-6). */
ROTID_API int rotid_eigenpair_derivative(const rotid_matrix *k, const rotid_matrix *m, const rotid_matrix *dk,
                                         const rotid_matrix *dm, int count, const double *lambda, const double *phi, int j,
                                         const rotid_environment *environment, char *failure, double *dlambda, double *dphi);

/* -------------------------------------------------------------------------------------- building blocks: least squares */

/* At x [n], one of the two: the residual r [m] (jacobian is NULL), or the jacobian [m * n] column-major, dr_i/dx_j (r is NULL),
 * always at the point whose residual was asked for last, so that what both need is computed once. Returns 0, or nonzero where x
 * has no residual or no Jacobian: at the start that ends the call, later the step is refused and a shorter one tried. */
typedef int (*rotid_residual)(void *user, int m, int n, const double *x, double *r, double *jacobian);

typedef struct rotid_lm_iteration {
    int iteration;
    double objective, mu, gain_ratio; /* objective: r'r/2, infinite or 0 where that has no double */
    double cosine;                    /* largest cosine between r and a column of J */
    const double *x, *gradient;       /* [n] the accepted point, J' r */
} rotid_lm_iteration;

/* Zero takes the default in brackets. */
typedef struct rotid_lm_options {
    size_t size;
    int max_iterations;                                            /* [1000] */
    double gradient_tolerance;                                     /* [1e-10] on that cosine */
    double step_tolerance;                                         /* [1e-12] |dx_j| <= eps (|x_j| + eps) for every j */
    double objective_tolerance;                                    /* [1e-16] what an undamped step promises over the objective */
    double initial_damping;                                        /* [1e-14] */
    int (*trace)(void *user, const rotid_lm_iteration *iteration); /* NULL, or told of every accepted point; nonzero cancels */
    void *trace_user;
    double decrease_tolerance; /* [0] decrease by the last five accepted steps over the objective: smaller, the iteration creeps
                                  along a valley, and ends with ROTID_STOP_OBJECTIVE */
    double decrease_least;     /* [0] of that decrease itself: as good an end */
} rotid_lm_options;

typedef struct rotid_lm_result {
    int status, iterations, evaluations, jacobians;
    double objective, cosine, mu;
} rotid_lm_result;

/* Length of the workspace of rotid_lm in doubles; 0 unless m, n >= 1. */
ROTID_API size_t rotid_lm_workspace(int m, int n);

/* Levenberg-Marquardt: min 1/2 r'r. Each step solves (J'J + mu (s D)^2) h = -J'r by QR of [J; sqrt(mu) s D], D the largest column
 * norms of J so far (More 1978), s the largest of |J_j|/D_j. mu follows the gain ratio (Nielsen 1999; Madsen, Nielsen, Tingleff
 * 2004, 3.2), the actual decrease being (r - r+)'(r + r+)/2, which keeps its digits at the optimum. It is raised where |D h|
 * would exceed a radius (More 1978): the larger of 10 |D x| and |r| at first, then 4 times the last step, after one that failed a
 * half to a tenth of it. Residuals and Jacobians may be of any size: the path is the same for 1e200 r as for r. Entry: m >= 1,
 * n >= 1 (m < n is allowed: the damped step is of least norm), x [n] start. Exit: x the best point, r [m] and jacobian [m * n]
 * there. Workspace: work [rotid_lm_workspace(m, n)]. Allocates nothing. Returns
 *   ROTID_STOP_GRADIENT    the cosine, or r, has vanished
 *   ROTID_STOP_STEP        the Gauss-Newton step, without damping and radius, is negligible
 *   ROTID_STOP_OBJECTIVE   what the Gauss-Newton step promises is below 1e-8 of the objective and no step that was tried gains
 *                          anything, or it is below ten times the change of the objective by the last trial, too short to
 *                          change it but by rounding, or the cosine is below 1e-4
 *   ROTID_STOP_STALLED     no step lowers the objective though there is more to gain: this is no minimum. The Jacobian is not
 *                          that of the residual (rotid_check_jacobian), the residual is flat around x but not to its slope (a
 *                          minimum at infinity), or the residual fails on every step from here
 *   ROTID_STOP_ITERATIONS, ROTID_STOP_CANCELLED
 * or ROTID_ERROR_ARGUMENT, _CALLBACK (no residual or Jacobian at the start), _FINITE (one there is not), _RANK (J = 0 there with
 * r != 0), _LIBRARY. */
ROTID_API int rotid_lm(int m, int n, rotid_residual residual, void *user, const rotid_lm_options *options, char *failure,
                       double *x, double *r, double *jacobian, double *work, rotid_lm_result *result);

/* Length of the workspace of rotid_check_jacobian in doubles; 0 unless m, n >= 1. */
ROTID_API size_t rotid_check_jacobian_workspace(int m, int n);

/* Compares the Jacobian that `residual` gives at x [n] with central differences D of its residual, extrapolated over a sequence
 * of steps (Ridders 1982) scaled by scale [n] > 0, the size of a natural change of each variable; NULL: max(|x_j|, 1e-3).
 * error [n]: |J_j - D_j| / max(|J_j|, |D_j|), 0 where both vanish; doubt [n]: the same ratio for what D_j itself may be wrong by.
 * Column j is wrong where error exceeds both a tolerance and doubt. x is not changed. Statuses: ROTID_OK, _ARGUMENT, _CALLBACK,
 * _FINITE (r or J at x). Where no differences can be had around x in a column, its doubt and error are NaN. */
ROTID_API int rotid_check_jacobian(int m, int n, rotid_residual residual, void *user, const double *x, const double *scale,
                                   char *failure, double *error, double *doubt, double *work);

/* ------------------------------------------------------------------------------------------------ building blocks: modes */

/* Modal assurance criterion (a'b)^2/((a'a)(b'b)) over the components that are finite in both; 0 where one vanishes. */
ROTID_API double rotid_mac(int n, const double *a, const double *b);

/* Normalised cross orthogonality (45) with the symmetric mass matrix [n * n] of the masters; NaN components count as 0.
 * work [n]. */
ROTID_API double rotid_nco(int n, const double *mass, const double *a, const double *b, double *work);

#ifdef __cplusplus
}
#endif

#endif
