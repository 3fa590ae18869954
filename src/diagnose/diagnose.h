/* Diagnosis of a job: what the model gets wrong, what causes it, the extended model, the gain, and what the data cannot tell.
 * Judged is always the full model by the likelihood; the FIT of the deck describes what the user does today. */
#ifndef ROTID_DIAGNOSE_DIAGNOSE_H
#define ROTID_DIAGNOSE_DIAGNOSE_H

#include "diagnose/causes/cause.h"
#include "run/identify.h"
#include "run/job.h"

#define DIAGNOSE_MOST_CAUSES 4 /* physical causes named one after the other */

struct diagnose_options {
    int threads;
    unsigned long seed;
    int replicates; /* of the bootstrap; 0: 1000 */
};

enum verdict_kind { VERDICT_ADEQUATE, VERDICT_NAMED, VERDICT_AMBIGUOUS, VERDICT_UNEXPLAINED };

/* A fault of the measurement chain. Already taken out of the data when the physics is judged. */
struct data_finding {
    const struct cause_kind *cause;
    int nsensor, sensor[2]; /* ids */
    int nmode, mode[2];     /* mode_pairing: numbers */
    const char *block;      /* noise_level: "SHAPE" or "FREQUENCY", else NULL */
    double value, std;      /* gain, shift, factor; NaN where there is none */
    double chi2_drop;       /* NaN where there is none */
    const char *text;       /* a sentence: what was found, what was done about it */
};

/* An error of the numbers themselves: mesh, guyan_reduction. */
struct numerical_finding {
    const struct cause_kind *cause;
    int nmode;
    const int *mode;             /* [nmode] */
    const double *error_percent; /* [nmode] of frequencies */
    const char *text;
};

/* A cause at one target (for those with a place: at its best place), with what became of it. */
struct candidate {
    const struct cause_kind *cause;
    struct effect effect; /* at the best values found; effect.name is that of the card it would get */
    const char *target;   /* "core", "core|right", name of a spring or tie rod, "" */
    int suspect;          /* the user asked for it */
    int round;            /* in which it was one, from 1 */
    int nparameter;       /* of the effect, in use */
    int fixed[EFFECT_MOST_PARAMETERS];
    double std[EFFECT_MOST_PARAMETERS], ci_lower[EFFECT_MOST_PARAMETERS], ci_upper[EFFECT_MOST_PARAMETERS]; /* NaN: not stated */
    double predicted_drop;  /* of chi2, from the linear scan */
    int refit;              /* index of that fit in the round, -1 where there is none */
    int refitted;           /* the following come from the nonlinear fit; NaN else */
    double chi2, chi2_drop; /* against the model of this round */
    double chi2_frequency;  /* the part of chi2 that the frequencies have */
    double bic;             /* chi2 + ln(residuals) * parameters */
    double p_value;         /* that the best of the whole family is this good by chance */
    double holdout_rms;     /* relative frequency error of the modes the deck holds out, percent; NaN where there are none */
    double mode_out_rms;    /* of modes left out in turn, percent */
    double sensor_out_rms;  /* standardised shape residual of sensors left out in turn */
    double other_place, other_chi2; /* the best fit of it at quite another place, NaN where all starts led to one */
    int at_bound;
    const char *collinear_with; /* id of the candidate that looks most like it among those refitted, or NULL */
    const char *collinear_target;
    double cosine;
    int refused;                  /* for a reason of its own (no fit, physical bound, held-out modes), whatever the others do */
    const char *rejected_because; /* NULL: named, or in the ambiguous set */
};

struct diagnosis_round {
    int ncandidate;
    struct candidate *candidate; /* best first; only those worth a line: refitted, or a visible share of the misfit */
    double chi2, chi2_frequency; /* of the model before this round; the part of the frequencies */
    int dof, nfrequency;
    double largest, threshold; /* of the scan: largest predicted drop, and the 3 % family-wise quantile */
    double p_scan, p_frequency, p_total;
    double required_margin;
    enum verdict_kind kind;
    int nset; /* named: 1; ambiguous: the first nset candidates; else 0 */
};

/* One state of the model, before or after. Frequencies in percent, shapes as rms of the difference relative to the largest
 * component, NaN where there is nothing to compare. */
struct fit_quality {
    double frequency_rms_percent, frequency_max_percent, shape_rms, chi2_per_dof, nco_min;
    double holdout_frequency_rms_percent, holdout_shape_rms;   /* modes held out by the deck */
    double mode_out_frequency_rms_percent, mode_out_shape_rms; /* modes held out in turn */
    double sensor_out_shape_rms;                               /* sensors held out in turn */
};

struct detectable {
    const struct cause_kind *cause;
    const char *target;
    const char *parameter, *unit;
    double smallest; /* deviation from neutral that this data set shows with 90 % power at 3 % false alarm; at its best place */
    double z;        /* that place, NaN where there is none */
    double worst;    /* at the worst place; NaN where there is none, or where no physical size would show there */
    int beyond;      /* no size within physical bounds would show */
};

struct diagnosis_step { /* where the time went */
    const char *name;
    double seconds;
};

struct diagnosis {
    struct job job; /* the job that was judged: LIKELIHOOD, NONE, faults of the data taken out, noise as found */
    int frequency_noise_assumed, shape_noise_assumed; /* the deck states none: relative statements only */
    double frequency_noise, shape_noise;              /* typical values in use */
    int interrupted;

    int has_today;
    struct identification today; /* by the FIT of the deck; fit NULL where it could not be made */

    int ndata_finding;
    struct data_finding *data_finding;
    int nnumerical_finding;
    struct numerical_finding *numerical_finding;

    struct identification base;
    double *mode_z;     /* [nmode] standardised frequency residual of the base model */
    double *sensor_rms; /* [nsensor] rms of the standardised shape residuals, NaN where there are none */
    int nlocal;         /* along the axis: force residual of the base model, largest 1 */
    double *local_z, *local;

    int nround;
    struct diagnosis_round *round; /* the last one names nothing more */

    /* verdict */
    enum verdict_kind kind;
    int adequate_after;
    double p_value; /* of the first round: the smallest of its tests */
    int ncause;
    struct candidate *cause; /* [ncause] as they stand in the final model */
    int nalternative;        /* ambiguous: candidates that cannot be told apart, best first */
    struct candidate *alternative;
    const char *sentence;         /* the verdict in one sentence */
    const char *next_measurement; /* NULL where nothing is open */

    struct job extended_job;
    struct identification extended; /* the base again where nothing was named: fit NULL then */
    struct fit_quality before, after;

    int ndetectable;
    struct detectable *detectable;
    int undetermined; /* parameters of the base fit that the data leave open: names in `sentence` */

    int nstep;
    struct diagnosis_step *step;
};

/* Everything hangs on the pool except the fits: diagnose_free. Notes go to the list. ROTID_OK; ROTID_ERROR_ARGUMENT where the job
 * has nothing that can be judged (the list says what and what was expected); any status of the fits. An interruption by the
 * environment is no error: what is finished stands in *out and `interrupted` is set. */
int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out);
void diagnose_free(struct diagnosis *out);

const char *verdict_name(enum verdict_kind kind);

#endif
