/* The modes of a rotor with the errors of their numbers: full model, condensed model, mesh error. */
#ifndef ROTID_RUN_SPECTRUM_H
#define ROTID_RUN_SPECTRUM_H

#include "base/pool.h"
#include "model/model.h"
#include "rotid.h"

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
    SPECTRUM_MASS = 8     /* mass */
};
int spectrum_compute_parts(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                           const struct parameter *parameter, const double *x, int reduction, int count, int parts,
                           struct spectrum *spectrum);

/* Of the full model alone, vectors good to 1e-4 and frequencies to the square of it: one of many trials. near: NULL, or the
 * spectrum of a model that is nearly this one, whose modes it begins with. */
int spectrum_try(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                 const struct parameter *parameter, const double *x, int count, const struct spectrum *near,
                 struct spectrum *spectrum);

/* NCO of a measured shape [nmaster] with mode j of the full model by the condensed mass; MAC where there is no such matrix.
 * work [nmaster]. */
double spectrum_correlation(const struct spectrum *spectrum, const double *shape, int j, double *work);

#endif
