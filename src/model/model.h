/* A rotor as equations of motion, behind rotid_model: the door that a host's own model comes through as well. This room is the
 * one place that chooses what discretises a rotor: src/beam or src/solid. */
#ifndef ROTID_MODEL_MODEL_H
#define ROTID_MODEL_MODEL_H

#include "base/pool.h"
#include "model/models.h"
#include "rotid.h"
#include "rotor/parameter.h"

struct rotor_model {
    rotid_model equations;             /* user points to this struct: do not copy it */
    const struct rotor *rotor;         /* own copy, at the values of the last evaluation, with the springs of a sling */
    const struct parameter *parameter; /* [equations.nparam] */
    int naxis;
    const double *z;          /* [naxis] m: the places along the axis where the model has degrees of freedom */
    int *master;              /* [equations.nmaster] */
    struct discrete discrete; /* what src/export writes element by element and src/page draws; nobody else looks inside */
};

/* The model of a rotor with the given parameters at their values in the rotor; masters are the lateral degrees of freedom at the
 * sensors, without sensors all of the axis. refine >= 1 cuts every element. models: those built already, or NULL. Statuses of
 * discrete_build and discrete_count_rigid, ROTID_ERROR_ARGUMENT where two sensors fall on one node; *failed as for
 * discrete_build. */
int model_open(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
               const struct parameter *parameter, int refine, struct rotor_model *model, int *failed);

/* m: where master i is. */
double model_master_z(const struct rotor_model *model, int i);

/* The lateral degree of freedom nearest to z. */
int model_lateral_dof(const struct rotor_model *model, double z);

/* Sets the parameters to x without solving anything: for mass and deflections. */
void model_set(struct rotor_model *model, const double *x);

/* At the values of the last evaluation or model_set. */
void model_mass_properties(const struct rotor_model *model, struct mass_properties *properties);

/* The same of a rotor that nobody wants the modes of, at x [nparameter]. Statuses of discrete_build. */
int model_weigh(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                const struct parameter *parameter, const double *x, struct mass_properties *properties);

/* Puts an effect in the place of the last one of the model's rotor. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_exchange_effect(struct pool *pool, struct rotor_model *model, const struct effect *effect);

/* *alone: whether sensor s has a node of a beam that no other sensor reads; a solid, whose sensors may be nearer to each other,
 * is asked no less. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_sensor_alone(struct pool *pool, const struct rotor *rotor, int s, int *alone);

/* The solutions of a model begin with phi [n * count], modes of the same rotor on another mesh, as far as discrete_transfer has a
 * way there. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_begin_with(struct pool *pool, struct rotor_model *model, const struct rotor_model *known, int count, const double *phi);

#endif
