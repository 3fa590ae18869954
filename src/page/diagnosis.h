/* What `rotid diagnose` writes with --json. */
#ifndef ROTID_PAGE_DIAGNOSIS_H
#define ROTID_PAGE_DIAGNOSIS_H

#include "page/fitted.h"
#include "page/geometry.h"

enum verdict_told { TOLD_NONE, TOLD_ADEQUATE, TOLD_NAMED, TOLD_AMBIGUOUS, TOLD_UNEXPLAINED };

struct told_value { /* of a cause */
    const char *name, *unit;
    double value, ci[2]; /* NaN: not stated */
    int fixed;
};

struct told_cause {
    const char *id, *target, *name; /* target "" of a cause that has none; name of the CAUSE card, NULL */
    int suspect;                    /* asked for by a card, which gave it that name */
    int nvalue;
    struct told_value *value;
};

struct evidence { /* for one candidate */
    struct told_cause cause;
    int refitted, at_bound;
    double predicted_drop, chi2_drop, bic, holdout_rms, mode_out_rms, sensor_out_rms, p_value, cosine; /* NaN: not known */
    const char *collinear_with, *collinear_target, *rejected_because;                                  /* or NULL */
};

struct evidence_round {
    enum verdict_told kind;
    int dof, nset, ncandidate;
    double chi2, largest, threshold, p_scan, p_frequency, p_total, required_margin;
    struct evidence *candidate; /* the set first, then the others, best first */
};

struct told_finding { /* about the data, or about the numbers of the model */
    const char *id, *text;
    int nerror; /* of the numbers alone */
    double *mode, *error_percent;
};

enum gain_kind {
    GAIN_FREQUENCY,      /* rms of the fitted frequencies, % */
    GAIN_FREQUENCY_MOST, /* the largest, % */
    GAIN_SHAPE,          /* rms of the fitted shapes relative to their largest component, 1 */
    GAIN_HELD_FREQUENCY, /* held out by the deck */
    GAIN_HELD_SHAPE,
    GAIN_MODE_FREQUENCY, /* left out in turn */
    GAIN_MODE_SHAPE,
    GAIN_SENSOR_SHAPE,
    GAIN_CHI2, /* per degree of freedom */
    GAIN_NCO,  /* the smallest */
    GAINS
};

struct told_gain {
    double before, after;
};

struct told_parameter { /* before and after */
    const char *name, *unit;
    double before, after, before_ci[2], after_ci[2];
};

struct told_size { /* the smallest that would have shown */
    const char *id, *target, *parameter, *unit;
    double smallest, z, worst;
    int beyond;
};

struct told_sensor {
    double id, z, rms;
};

struct diagnosis_outcome {
    int interrupted, adequate_after;
    enum verdict_told kind;
    double p_value;
    const char *next_measurement, *sentence; /* NULL: none */
    int ncause, nalternative, ndata, nnumerical, nround, nparameter, nmode, nsensor, nlocal, nsize;
    struct told_cause *cause, *alternative;
    struct told_finding *data, *numerical;
    struct evidence_round *round;
    struct told_gain gain[GAINS];
    struct told_parameter *parameter;
    double *mode_z; /* [nmode] of base, over their noise */
    struct told_sensor *sensor;
    double *local_z, *local; /* [nlocal] largest 1 */
    struct told_size *size;
    struct fitted *today, *base, *extended; /* NULL: there is none */
};

/* NULL where something is wrong: reader->status tells. */
struct diagnosis_outcome *diagnosis_read(const struct json_place *root);

/* The fit as the deck states it, where it gives other parameters than the base model by a
 * different choice; else NULL. */
const struct fitted *diagnosis_today(const struct diagnosis_outcome *d);

/* Where a cause acts along the axis, from <= to [m]; ci: the 95 % interval of its place, NaN where it is not searched for or not
 * stated. 0: it has no place, or the geometry (may be NULL) does not know it. */
struct told_place {
    double from, to, ci[2];
};
int diagnosis_place(const struct geometry *geometry, const struct told_cause *cause, struct told_place *place);

/* By how much candidate `a` of a round leads candidate `b`: chi2 and a penalty for each parameter that was searched for, as the
 * decision counts it. */
double diagnosis_lead(const struct evidence *a, const struct evidence *b);
/* The best candidate of a round, and the best other one that was not refused for a reason of its own, such as its size or what it
 * does to modes held out: such a one is no rival. -1: none. */
int diagnosis_is_rival(const struct evidence *candidate);
void diagnosis_leaders(const struct evidence_round *round, int *first, int *second);

#endif
