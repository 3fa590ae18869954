/* The model that is exported: its matrices at the values that were identified or that the deck states, the same condensed
 * onto the sensors, and the texts of the files beside the numbers. */
#ifndef ROTID_EXPORT_MODEL_H
#define ROTID_EXPORT_MODEL_H

#include "model/model.h"
#include "run/identify.h"
#include "run/job.h"

#define EXPORT_MODES         6    /* stated at least, as far as the model has them */
#define EXPORT_MOST_CONDENSE 1000 /* masters: more cost gigabytes, the square of their number */

struct export_condensed {
    const char *impossible; /* why there is none, else NULL */
    int kind, count;        /* ROTID_GUYAN or ROTID_IRS; masters, those of the discrete */
    double *k, *m;          /* [count * count] */
};

struct export_node {
    double r, z;        /* m; r NaN of a beam */
    const char *member; /* "axis" or, of a solid, "section"; or the name of rods or bars */
    int sensor;         /* id, 0 where there is none */
    int row[4]; /* from 1, 0 where there is none: of v and theta; of a solid U, V, W, and theta of a member, whose v is U */
};

struct export_model {
    const struct job *job;
    const char *version;
    const struct identification *identified; /* NULL: as the deck states it */
    struct rotor_model *discrete;            /* stands at the exported values */
    rotid_matrix k, m;
    int nnode, is_solid;
    struct export_node *node; /* [nnode]: of the axis or of the section, then the inner ones of rods and bars */
    struct export_condensed condensed;
    struct spectrum spectrum;
    struct mass_properties mass;
};

/* identified: a fit of the job, or NULL for the model as the deck states it. condense: nonzero, with the condensed matrices.
 * Statuses of model_open and spectrum_compute. */
int export_model_open(struct pool *pool, const struct job *job, const struct identification *identified, const char *version,
                      int condense, struct export_model *model);

/* What the model has: parameters of *IDENTIFY with their values there. */
double export_parameter(const struct export_model *model, int p);
/* Standard deviation, NaN where it was not identified. */
double export_parameter_std(const struct export_model *model, int p);
/* Id of the sensor at master i, without sensors the node from 1; and where it is [m]. */
int export_master_id(const struct export_model *model, int i);
double export_master_z(const struct export_model *model, int i);

#endif
