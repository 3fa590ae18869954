#ifndef ROTID_DIAGNOSE_CAUSES_CAUSES_H
#define ROTID_DIAGNOSE_CAUSES_CAUSES_H

/* Causes: the catalogue of what can be wrong with numbers, data or rotor. One file a cause, one line each in catalogue.c.
 * In: a rotor or a job, a target (group, interface, spring, tie rod, sensor, ...), parameter values of the cause. Out: struct
 * cause_kind: how the cause changes the model or the data, its bounds, when it applies, its words for reports and CAUSE cards.
 *
 *   catalogue      catalogue.c (catalogue_item, catalogue_find, catalogue_of): by number, by id, by effect; correction_apply
 *   bounds         cause.c (cause_bounds, cause_reach): physically possible bounds of a parameter
 *   numbers        mesh.c, guyan_reduction.c, beam_theory.c: entries without an effect; the last one asks for a solid
 *   measurement    sensor_gain.c, sensor_sign.c, sensor_swap.c, sensor_position.c, sensor_line.c, duplicate_channel.c,
 *                  noise_level.c, mode_pairing.c: hook `correct` takes the fault out of a job's data; sensor.c: shared routines
 *   rotor          all others (stiffness_local.c, joint.c, support.c, tie_tension.c, ...): hooks of struct effect_kind
 *                  (src/rotor/rotor.h) with exact derivatives; tie_tension.c: a factor on the tension T; shared.c: Gauss rule,
 *                  mean compliance 1/f of a soft zone, flexibility int (z - z0)^n/EI dz
 *
 * Callers: diagnose, suggest by way of it; deck (CAUSE cards), api, report, page and study for names and words. A cause must not
 * know the mesh, the modes or the scan: it states factors, compliances and masses, and src/beam and src/solid apply them. */

#include "rotor/rotor.h"
#include "run/run.h"

/* ----------------------------------------------------------------------------------------------------------------- cause */

/* One cause of the catalogue: what the diagnosis needs to look for it, to judge it and to speak of it. Physical causes act on the
 * rotor through the hooks of `effect`; causes of the measurement chain and of the numbers act on the data or on nothing. */

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

/* What is expected of a parameter before the data are seen. */
enum prior_kind {
    PRIOR_FLAT,       /* uniform between its bounds */
    PRIOR_GAUSSIAN,   /* normal about neutral; half of it where it is one-sided */
    PRIOR_SHARE,      /* the same with a deviation of `scale` times the distance of the farther bound from neutral */
    PRIOR_LOG_NORMAL, /* ln(x/neutral) normal */
    PRIOR_LOG_FLAT    /* uniform in ln x over `scale` decades below the upper bound */
};

struct cause_parameter {
    double neutral; /* the effect vanishes here */
    double typical; /* a size worth looking for: start of a fit where the scan gives none, point of a secant */
    int one_sided;  /* 1: physical only above neutral, -1: only below, 0: both */
    enum prior_kind prior;
    double scale;
    double gross; /* of PRIOR_SHARE: this part is uniform between the bounds: a wrong number, no error of measuring */
};
#define PRIOR_NORMAL(deviation)    .prior = PRIOR_GAUSSIAN, .scale = (deviation)
#define PRIOR_OF_BOUND(share)      .prior = PRIOR_SHARE, .scale = (share)
#define PRIOR_LOGNORMAL(deviation) .prior = PRIOR_LOG_NORMAL, .scale = (deviation)
#define PRIOR_DECADES(decades)     .prior = PRIOR_LOG_FLAT, .scale = (decades)
#define PRIOR_UNIFORM              .prior = PRIOR_FLAT

/* For causes: of a size alone; of a factor on what is known roughly. */
#define NO_PLACE             .place = -1, .width = -1
#define FACTOR_ROUGHLY_KNOWN .lower = 0.5, .upper = 1.5

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
    /* from the first variant to the second one, which is the same cause in another form along the rotor: an effect of the first
     * one becomes that of the second with the same area and standard deviation. NULL: the variants are different models */
    void (*reshape)(struct effect *effect);
    /* the cause is an approximation: what it leaves, relative to frequencies and to the largest component of a shape */
    double discrepancy_frequency, discrepancy_shape;
    /* whether the cause makes sense for this target; identified [ngroup]: E or G of the group is free. NULL: always */
    int (*applies)(const struct rotor *rotor, int target, const int *identified);
    /* bounds of parameter p, lower < upper: of the size the usual ones; NULL: lower and upper, of any
     * rotor; none where both are 0 */
    void (*bounds)(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper);
    double lower, upper;
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

/* The usual bounds of parameter p, on this rotor; infinite ones where the cause states none. */
void cause_range(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                 double *upper);

/* Bounds of parameter p: those of the effect where it is the size and has some, else as far as is physically possible. */
void cause_bounds(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                  double *upper);

/* As far as is physically possible. */
void cause_reach(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                 double *upper);

/* Whether it has a size that is searched: then the model with it contains that without. fixed [nparameter of its effect] */
int cause_has_free_size(const struct cause_kind *cause, const int *fixed);

/* What a cause acts on, by name: a group, "left|right" for an interface, a spring or its place, a tie rod; "" where it has no
 * such target. NULL where memory is out. */
const char *cause_target_name(struct pool *pool, const struct rotor *rotor, const struct cause_kind *cause, int target);

/* ------------------------------------------------------------------------------------------------------------- catalogue */

/* The catalogue: one line a cause. */

/* Number of causes, and the i-th of them. */
int catalogue_count(void);
const struct cause_kind *catalogue_item(int i);

/* By id, without regard to case; NULL where there is none. */
const struct cause_kind *catalogue_find(const char *id);

/* The cause whose effect this is. */
const struct cause_kind *catalogue_of(const struct effect *effect);

/* Takes one fault out of the data of the job by the cause of that id. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_ARGUMENT where
 * there is no such cause or sensor, or nothing that could be corrected. */
int correction_apply(struct pool *pool, struct job *job, const struct correction *correction);

/* ---------------------------------------------------------------------------------------------------------------- sensor */

/* What the causes of the measurement chain share.
 *
 * The noise of a shape is stated relative to the largest component as it was measured, with the fault still in it. Taking the
 * fault out may change which component is the largest; the noise in absolute terms stays what it is, so that the likelihood of
 * corrected data is that of a prediction with the fault in it and of data as read. */

/* All positions at once: counted from the other end, from a wrong origin, with a wrong length. */
struct sensor_line {
    int flip;
    double shift, scale; /* [m], [1]: 0 and 1 where they are as stated */
};

/* Where a sensor sits that is stated at z [m]: shift + scale z from the left end, with flip from the right one. */
double sensor_line_place(const struct sensor_line *line, double length, double z);

/* Whether sensors stated at z [n], increasing, all have a place of their own on the rotor then; a line may end a little beyond
 * it, as its error does: its end is that of the rotor. */
int sensor_line_fits(const struct sensor_line *line, double length, int n, const double *z);

/* Index of a sensor, -1 where there is none of that id. */
int sensor_find(const struct job *job, int id);

/* Divides each mode by its largest component. The standard deviations, relative to it, stay. Before a correction. */
void shapes_scale(struct job *job);

/* Divides each mode and its standard deviations by its largest component. After a correction. */
void shapes_rescale(struct job *job);

/* Components and standard deviations of sensor s (an index) by a factor, of the standard deviations its size; between
 * shapes_scale and shapes_rescale, which it calls. */
void shapes_multiply(struct job *job, int s, double factor);

/* Exchanges what sensors a and b (indices) read, with the noise of it. */
void shapes_exchange(struct job *job, int a, int b);

/* Sensors a and b (indices) change their places in the list, with all that refers to them. */
void sensors_exchange(struct job *job, int a, int b);

/* Keeps the data as they were read in job->raw, unless they are kept already. ROTID_OK or ROTID_ERROR_MEMORY. */
int corrections_keep_raw(struct pool *pool, struct job *job);

/* ---------------------------------------------------------------------------------------------------------------- shared */

/* What several physical causes have in common. */

/* Gauss-Legendre rule on [-1, 1], exact to degree 7. */
#define GAUSS_POINTS 4
extern const double gauss_place[GAUSS_POINTS], gauss_weight[GAUSS_POINTS];

/* A factor f(z) on the stiffness along an element acts through the mean of its compliance 1/f: the factor of the element, 1/mean,
 * and its derivative -d(mean)/mean^2 where p >= 0. */
double factor_of_compliance(double mean, double dmean, int p);

/* Stiffness of group `effect->target` times 1 + value f(xi), xi from -1 to 1 along the group: a `field` hook but for the shape f.
 */
int scale_along_group(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                      double (*shape)(double xi), struct effect_field *field);

/* E and G times the factor (p < 0), or their derivative. Returns 1. */
int scale_stiffness(double factor, int p, struct effect_field *field);

/* EI of a segment without its holes, rings of layers included. */
double bending_stiffness(const struct rotor *rotor, int segment);

/* Over the axis the mean of EI, and the integral of (z - from)^n/EI: what the rotor as a whole gives way by. */
double mean_bending_stiffness(const struct rotor *rotor);
double bending_flexibility(const struct rotor *rotor, double from, int n);

/* kg: the heaviest thing that one may have forgotten. Of a large rotor 3 % of what it weighs by its dimensions; on a small one
 * what is fixed to it counts for more, since fixtures do not shrink with it: 10 kg, or a quarter of it. */
double heaviest_overlooked(const struct rotor *rotor);

/* A `point` hook but for what is held: a spring to the ground of stiffness value 0 at z, value 1. */
int spring_anywhere(const struct effect *effect, int i, int p, int rotational, struct effect_point *point);

/* Whether a spring has a stiffness. */
int applies_to_felt_spring(const struct rotor *rotor, int target, const int *identified);

/* Whether neither E nor G of a group is free. */
int applies_to_known_group(const struct rotor *rotor, int target, const int *identified);

#endif
