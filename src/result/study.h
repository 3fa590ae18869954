/* What `rotid study` writes, in the shape of its JSON: the first line of a file of results, the line of a run, and the summary.
 */
#ifndef ROTID_RESULT_STUDY_H
#define ROTID_RESULT_STUDY_H

#include "rotid.h"

enum { STUDY_CONVERGED, STUDY_AT_BOUND, STUDY_NOT_CONVERGED, STUDY_FAILED };
enum { STUDY_VERDICTS = 4, STUDY_SCORES = 8 };
/* The words of the enum above, and of enum score; NULL behind the last. */
extern const char *const score_words[];

/* of what the parts mean: 16 hexadecimal digits each; comments, blanks and places of files do not count */
struct study_digests {
    const char *plan;    /* cards of the plan */
    const char *decks;   /* cards of the decks */
    const char *data;    /* measured data, with the files they come from */
    const char *options; /* --set */
};

/* the first line: which study the file is of */
struct study_header {
    int schema;                  /* version of this schema */
    const char *rotid;           /* version of the program that computes the runs */
    const char *commit;          /* commit it was built from, or unknown */
    const char *command;         /* command that made the file */
    const char *plan;            /* path of the plan as given; NULL where decks were named */
    const char *studies;         /* what each run is */
    struct study_digests digest; /* of the inputs */
    double seed;                 /* of random numbers */
    int runs;                    /* of the whole study */
    const char *shard;           /* I/N: runs with run modulo N = I - 1; NULL: all */
};

/* where a run stands on the axes of the plan; NULL on those that it does not have */
struct study_axes {
    const char *deck;       /* path of the deck as the plan or the command line has it */
    const char *variant;    /* NAME of the *VARIANT */
    const char *modes;      /* line of *MODES */
    const char *sensors;    /* line of *SENSORS: a number, every k, or all */
    double noise_frequency; /* of *NOISE, relative standard deviation [1] */
    double noise_shape;     /* of *NOISE, relative to the largest component [1]; NaN where the line states none */
    const char *hide;       /* NAME of the *HIDE, or its type and target */
};

/* value, start, std, ci95 and truth in its unit */
struct run_parameter {
    const char *name; /* such as core.E */
    const char *unit; /* 1 for a pure number */
    double value;     /* identified */
    double start;     /* of the iteration */
    double std;       /* standard deviation; NaN where it cannot be stated */
    double ci95[2];   /* 95 % interval; NaN where it cannot be stated */
    int at_bound;     /* at a bound */
    int identifiable; /* false: at a bound, or left open by the data */
    double truth;     /* of the model that made the data; NaN where it is not known */
};

/* a measured mode */
struct run_mode {
    const char *state;    /* of a deck with several *STATE, which one; else without this key */
    int mode;             /* of the model that it is paired with, from 1 */
    double measured_hz;   /* of the data of this run [Hz] */
    double predicted_hz;  /* of the fitted model [Hz] */
    double error_percent; /* predicted over measured frequency, less one [%] */
    double nco;           /* normalised cross orthogonality [1]; NaN without a shape, or where the masters are too few */
    int holdout;          /* not fitted */
};

/* a parameter of an effect */
struct run_value {
    const char *name; /* such as mass */
    const char *unit; /* 1 for a pure number */
    double value;     /* in its unit */
};

/* an effect with the values drawn for it */
struct run_hidden {
    const char *id; /* of the catalogue */
    int nparameters;
    struct run_value *parameters; /* in the order of docs/deck.md */
};

struct run_fit {
    const char *functional;  /* that was minimised */
    const char *reduction;   /* of the model that was fitted */
    double objective;        /* half the sum of squared residuals [1] */
    double chi2_per_dof;     /* misfit over the stated noise [1]; NaN without noise or degrees of freedom */
    int dof;                 /* degrees of freedom */
    int iterations;          /* accepted steps */
    int evaluations;         /* of the residual */
    const char *stop_reason; /* text of a status ROTID_STOP_ of include/rotid.h */
    int sensors;             /* of the fitted model */
    int nparameters;
    struct run_parameter *parameters; /* in the order of *IDENTIFY; of a diagnosis those of the extended model */
    int nmodes;
    struct run_mode *modes;    /* measured modes */
    struct run_hidden *hidden; /* what acts in the data and not in the fitted model; NULL: nothing */
};

/* a minimiser */
struct run_minimiser {
    const char *algorithm; /* NLopt's name */
    int usable;            /* converged, or stopped by rounding at a minimum */
    double objective;      /* recomputed at x [1] */
    int evaluations;       /* of the model */
    int nx;
    double *x; /* values of the parameters */
};

/* a parameter of a cause */
struct run_cause_parameter {
    const char *name; /* such as mass */
    const char *unit; /* 1 for a pure number */
    double value;     /* in its unit */
    double std;       /* standard deviation; NaN where it cannot be stated */
};

/* a cause at one target */
struct run_cause {
    const char *id;     /* of the catalogue, docs/diagnosis.md */
    const char *target; /* what it acts on; empty where that is the whole rotor */
    const char *state;  /* the one in which it acts; NULL: in all */
    int nparameters;
    struct run_cause_parameter *parameters; /* in the order of docs/deck.md */
};

struct run_verdict {
    int kind;           /* as in diagnose.schema.json */
    int adequate_after; /* the model with the causes that were named is adequate */
    double p_value;     /* of the base model */
    int ncauses;
    struct run_cause *causes; /* named */
    int nalternatives;
    struct run_cause *alternatives; /* that cannot be told apart, best first */
};

/* a fault of the measurement chain */
struct run_finding {
    const char *id;    /* of the catalogue */
    const char *state; /* whose data; NULL of a deck that is one */
    int nsensors;
    int *sensors;      /* ids */
    const char *block; /* of noise_level */
    double value;      /* gain, shift [m] or factor */
};

struct run_diagnosis {
    struct run_verdict verdict; /* on physical causes */
    int ndata_findings;
    struct run_finding *data_findings; /* faults of the measurement chain */
    int score;          /* the verdict beside what was hidden, docs/study.md; below 0 where the data are measured */
    int false_findings; /* faults of the data that were found and not hidden; ROTID_NONE where the data are measured */
};

/* the line of a run; the keys from functional on stand where it did not fail, those from verdict on in a diagnosis */
struct study_run {
    int run;                /* number of the run, from 0 */
    struct study_axes cell; /* what tells its cell from others */
    int replicate;          /* from 0 */
    int start;              /* from 0 */
    int status;             /* of the fit; failed: the run has no result */
    const char *error;      /* why it failed; NULL: the run has a result */
    struct run_fit *fit;    /* NULL: it failed */
    int niterates;
    double *iterates; /* only where the plan has *STARTS: all parameters at the start, then after each iteration; nine digits */
    int nbaseline;
    struct run_minimiser *baseline;  /* the same problem minimised by NLopt, with BASELINE=YES */
    struct run_diagnosis *diagnosis; /* NULL of an identification */
    int nwarnings;
    const char **warnings; /* what the pairing and the fit have to say; NULL: it failed */
    double seconds;        /* of the run [s] */
    const char *study;     /* digest of the study that the run is of, docs/study.md; NULL before the stamp is there */
    const char *digest;    /* of all bytes of the line before it; NULL before the stamp is there */
};

/* over the runs of a cell, in its unit where it has one */
struct cell_parameter {
    const char *name;       /* such as core.E */
    const char *unit;       /* 1 for a pure number */
    int count;              /* runs that have it */
    double mean;            /* of the values */
    double std;             /* of the values; NaN for fewer than two */
    double min;             /* smallest value */
    double max;             /* largest value */
    double mean_stated_std; /* mean of the standard deviations of the fits */
    double bias;            /* mean of value less truth; NaN where no truth is known */
    double std_error;       /* standard deviation of value less truth, about its mean */
    double rms_error;       /* root of the mean square of value less truth */
    int intervals;          /* 95 % intervals with a truth beside */
    double coverage95;      /* share of them that hold it [1] */
};

/* counts */
struct cell_diagnoses {
    int count;                    /* diagnoses */
    int verdicts[STUDY_VERDICTS]; /* runs by verdict */
    int nnamed;
    rotid_component *named;   /* runs in which a cause or a fault of the data was named, by id */
    int scores[STUDY_SCORES]; /* runs by score, docs/study.md; ROTID_NONE where the data are measured */
    int false_findings;       /* faults of the data that were found and not hidden; ROTID_NONE where the data are measured */
};

/* runs that differ in replicate and start alone */
struct study_cell_result {
    struct study_axes cell; /* its place on the axes of the plan */
    int first_run;          /* lowest number */
    int runs;               /* there */
    int converged;          /* not at a bound */
    int at_bound;           /* converged at a bound */
    int not_converged;      /* fits that did not */
    int not_adequate;       /* of those that converged, at a bound or not: noise alone leaves such a misfit in less than 1 % of tests */
    int failed;             /* runs without a result */
    int reached_best;       /* runs whose objective is the best of their replicate; ROTID_NONE with one start each */
    int nparameters;
    struct cell_parameter *parameters;    /* over the runs that converged, at a bound or not */
    double frequency_rms_percent;         /* of the fitted frequencies [%] */
    double holdout_frequency_rms_percent; /* of those held out [%] */
    double chi2_per_dof;                  /* mean [1] */
    double evaluations;                   /* mean, of the residual */
    struct cell_diagnoses *diagnoses;     /* NULL for identifications */
    double seconds;                       /* of its runs together [s] */
};

/* why runs failed */
struct study_error {
    const char *error; /* as in the line */
    int runs;          /* that failed for it */
    int first_run;     /* lowest number */
};

struct study_result {
    const char *results; /* path of the file of results as given */
    const char *plan;    /* path of the plan as it was given; NULL where decks were named */
    const char *studies; /* what each run is */
    int shard;           /* which one the file is of */
    int shards;          /* 1: the file is of all runs */
    int runs;            /* that the file is to have */
    int done;            /* that it has */
    int missing;         /* that it does not have */
    int failed;          /* of those it has */
    int ncells;
    struct study_cell_result *cells; /* in order of their first runs */
    int nerrors;
    struct study_error *errors; /* why runs failed */
    double seconds;             /* of all runs together [s] */
};

#endif
