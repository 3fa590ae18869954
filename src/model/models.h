/* The models of one run that are built already: a rotor's mesh and sections are made once, however often the rotor is opened with
 * other values or other parameters. Threads may share them. */
#ifndef ROTID_MODEL_MODELS_H
#define ROTID_MODEL_MODELS_H

#include "base/pool.h"
#include "model/discrete.h"

struct models;

/* What a reader of decks wants to know of a discretised rotor. */
struct model_size {
    int ndof;
    const int *sensor_dof; /* [nsensor] */
};

/* No models yet, and none taken up: all that are opened with these are discretised like this. NULL where memory is out. */
struct models *models_as(struct pool *pool, enum discretisation as);

/* How models that are opened with these are discretised: as beams where models is NULL. */
enum discretisation models_discretisation(const struct models *models);

/* The model of a rotor without parameters, in *models, which takes up no others. Statuses of discrete_build; *failed likewise. */
int models_begin(struct pool *pool, enum discretisation as, const struct rotor *rotor, struct models **models,
                 struct model_size *size, int *failed);

/* Models for a run, which begin with those of `given` (or NULL): `given` itself where it takes up others. NULL where memory is
 * out. */
struct models *models_for_run(struct pool *pool, struct models *given);

/* Models of the same run, of rotors as solids: `models` itself where its rotors are; NULL outside of a run. */
struct models *models_solids(struct models *models);

/* Ends what models_for_run began: the memory goes to the pool, and nothing is taken up any more. */
void models_end_run(struct pool *pool, struct models *models, const struct models *given);

/* A rotor discretised, by a mesh that is there already where there is one. *nrigid: rigid-body and suspension modes at the values
 * of the rotor, -1 where nobody has counted them. Statuses of discrete_build; *failed likewise. */
int models_discretise(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, int refine, struct discrete *discrete, int *nrigid, int *failed);

/* Keeps what somebody has counted. */
void models_keep_rigid(struct models *models, const struct rotor *rotor, int refine, int nrigid);

/* What a fit holds its coarse mesh to, for `count` elastic modes. Both change by a tenth of their distance to 1 and to 0 where E
 * and G change by half. */
struct held_modes {
    int count, nmaster;
    const double *ratio; /* [count] frequencies that count over those of the coarse mesh */
    const double *shape; /* [nmaster * count] of the mesh that counts, largest component 1; NULL: shapes are not held */
    const double *shift; /* [nmaster * count] that shape less the one of the coarse mesh */
};

/* Keeps a copy. ROTID_OK or ROTID_ERROR_MEMORY; with models that take up no others nothing happens. */
int models_hold(struct models *models, const struct rotor *rotor, const struct held_modes *modes);

/* What is held for rotors of this shape, whatever causes are in them; NULL: nothing. */
const struct held_modes *models_held(struct models *models, const struct rotor *rotor);

/* Keeps a copy of vectors phi [n * count] near the lowest modes, for models of that size to begin with; those kept before stay where
 * they are as many. From one thread alone: which vectors are met must not depend on who comes first. With models that take up no
 * others nothing happens. ROTID_OK or ROTID_ERROR_MEMORY. */
int models_keep_modes(struct models *models, int n, int count, const double *phi);

/* Those kept for models with n degrees of freedom, *count of them; NULL: none. */
const double *models_modes(struct models *models, int n, int *count);

#endif
