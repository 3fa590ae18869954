/* One cause of the catalogue: what the diagnosis needs to look for it, to judge it and to speak of it. Physical causes act on the
 * rotor through the hooks of `effect`; causes of the measurement chain and of the numbers act on the data or on nothing. */
#ifndef ROTID_DIAGNOSE_CAUSES_CAUSE_H
#define ROTID_DIAGNOSE_CAUSES_CAUSE_H

#include "rotor/effect.h"
#include "run/job.h"

enum cause_class { CAUSE_NUMERICAL, CAUSE_DATA, CAUSE_PHYSICAL };

enum cause_target { /* what a CAUSE card names, and what the scan enumerates */
                    TARGET_NONE,
                    TARGET_GROUP,     /* GROUP= */
                    TARGET_INTERFACE, /* BETWEEN=left,right: two groups that follow each other */
                    TARGET_SPRING,    /* AT= name of a spring */
                    TARGET_DISK,      /* AT= name of a disk */
                    TARGET_TIEROD,    /* AT= name of a tie rod */
                    TARGET_SENSOR,    /* SENSOR= id */
                    TARGET_SENSORS,   /* SENSOR= two ids */
                    TARGET_BLOCK,     /* AT=SHAPE or FREQUENCY */
                    TARGET_MODES
};

struct cause_parameter {
    double neutral; /* the effect vanishes here */
    double typical; /* a size worth looking for: start of a fit where the scan gives none, point of a secant */
    int one_sided;  /* 1: physical only above neutral, -1: only below, 0: both */
};

struct cause_kind {
    const char *id;
    enum cause_class class;
    enum cause_target target;
    const struct effect_kind *effect; /* NULL for other than physical causes */
    struct cause_parameter parameter[EFFECT_MOST_PARAMETERS];
    int size;   /* index of the parameter that is the size; the others are places and widths */
    int place;  /* index of the parameter that is a place z, or -1 */
    int width;  /* index of the parameter that is a width, or -1 */
    int secant; /* no derivative at neutral: the scan uses the difference to `typical` */
    int solid;  /* the remedy is not in the rotor: the rotor is to be a solid */
    const char
        *limit_of; /* the cause with a place that is this one where it stands here: a zone at an interface is a joint; NULL */
    const char
        *variant[5]; /* words of option SHAPE= (stiffness_local, added_mass) or MOUNT= (accelerometer_mass), NULL at the end */
    const char *variant_option; /* "SHAPE", "MOUNT" or NULL */
    /* the cause is an approximation: what it leaves, relative to frequencies and to the largest component of a shape */
    double discrepancy_frequency, discrepancy_shape;
    /* whether the cause makes sense for this target; identified [ngroup]: E or G of the group is free. NULL: always */
    int (*applies)(const struct rotor *rotor, int target, const int *identified);
    /* bounds of parameter p, lower < upper: of the size the usual ones */
    void (*bounds)(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper);
    double widest; /* how many times so far from no effect its size is still possible; 0: those bounds are the limit */
    /* causes of the measurement chain: the value a CAUSE card gives ("gain", "1"), NULL where it gives none, and up to two behind
     * it; and what takes the fault out of the data of a job, whose arrays may be changed in place. ROTID_OK, ROTID_ERROR_MEMORY,
     * ROTID_ERROR_ARGUMENT */
    struct effect_parameter_name value, more[2];
    int (*correct)(struct pool *pool, struct job *job, const struct correction *correction);
    /* half lines of text for reports */
    const char *sentence; /* what it is: "a zone softer than its surroundings" */
    const char *check;    /* how to tell it apart in the workshop: "weigh the end pieces" */
};

/* Name of value p of a cause of the measurement chain, NULL behind the last; where a correction has it. */
const struct effect_parameter_name *correction_parameter(const struct cause_kind *cause, int p);
double *correction_value(struct correction *correction, int p);

/* Whether a cause is an error of beams alone, which a solid does not have. */
int cause_of_beam(const struct cause_kind *cause);

/* The number of parameters of an effect in use, the first ones of its kind: a soft zone of one depth has no depth_shear. */
int cause_parameters(const struct effect *effect);

/* Bounds of parameter p: those of the effect where it is the size and has some, else those of its cause. */
void cause_bounds(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                  double *upper);

/* The same as far as is physically possible. */
void cause_reach(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                 double *upper);

/* The bounds of the effect's size `times` as far as usual, within what is possible. 1 where that is farther than before. */
int cause_widen(const struct cause_kind *cause, const struct rotor *rotor, double times, struct effect *effect);

/* What a cause acts on, by name: a group, "left|right" for an interface, a spring or its place, a tie rod; "" where it has no
 * such target. NULL where memory is out. */
const char *cause_target_name(struct pool *pool, const struct rotor *rotor, const struct cause_kind *cause, int target);

#endif
