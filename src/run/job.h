/* A job: what a deck says, resolved to numbers and indices. Filled by src/deck, or by anybody who has the data in another form.
 */
#ifndef ROTID_RUN_JOB_H
#define ROTID_RUN_JOB_H

#include "base/message.h"
#include "base/pool.h"
#include "model/models.h"
#include "record/words.h"
#include "rotid.h"
#include "rotor/parameter.h"
#include "signal/frf.h"

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

/* Which transfer functions are to be synthesised: the FRF card. What it leaves open is settled in frf_run.h. */
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
    /* With the accelerometer at one sensor after the other, [nsensor * nmode] in Hz, NaN where not known; NULL where the deck has
     * none. frequency_hz of a mode that has any is then their mean over all sensors: see run/point_fit.h. */
    double *point_frequency_hz, *point_frequency_std;
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
    int solid; /* the rotor as a solid of revolution, not as a beam */
    struct frf_request frf;
};

/* Where a deck states something. */
struct job_place {
    const char *file;
    int line, column;
};

/* The units that the deck states numbers in, in SI; 0: SI. The job itself is in SI. */
struct job_units {
    double length, mass, stiffness, frequency;
};

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
    const struct job_place *part; /* [ngroup + ntierod + nbars] of the rotor, or NULL where nobody stated them */
    struct models *models;        /* of it, as far as they are built, or NULL */
    struct job_measurement measurement;
    struct job_unknowns unknowns;
    struct job_options options;
    struct job_units units;
};

/* Where the deck states what discrete_build refused with this *failed: the first group for the rotor as a whole, the first line
 * of the deck where nobody stated parts. */
struct job_place job_part_place(const struct job *job, int failed);

/* Whether the noise of every measured frequency, and of every shape component, is known. */
int job_knows_frequency_noise(const struct job *job);
int job_knows_shape_noise(const struct job *job);
/* Whether a likelihood can use shapes: there are some, with their noise. */
int job_fits_shapes(const struct job *job);

#endif
