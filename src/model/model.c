#include "model/model.h"

#include <string.h>

#include "beam/hinge.h"
#include "beam/mesh.h"

static int matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct rotor_model *model = user;
    beam_assemble(&model->beam, x, stiffness, mass);
    return 0;
}

/* rotid_model gives x here too; the beam already stands at it, since derivatives follow matrices at the same point */
static int derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct rotor_model *model = user;
    parameters_set(&model->beam.rotor, model->equations.nparam, model->parameter, x);
    beam_differentiate(&model->beam, p, stiffness, mass);
    return 0;
}

static int choose_masters(struct pool *pool, struct rotor_model *model)
{
    const struct mesh *mesh = &model->beam.mesh;
    int nsensor = model->rotor->nsensor, count = 0;
    model->master = POOL_ARRAY(pool, int, nsensor ? nsensor : mesh->naxis);
    if (!model->master)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < nsensor; i++)
        model->master[count++] = 2 * mesh->sensor_node[i];
    for (int i = 0; !nsensor && i < mesh->naxis; i++)
        model->master[count++] = 2 * i;
    model->equations.nmaster = count;
    model->equations.master = model->master;
    for (int i = 1; i < count; i++) /* two sensors that fall on one node */
        if (model->master[i] <= model->master[i - 1])
            return ROTID_ERROR_ARGUMENT;
    return ROTID_OK;
}

int model_open(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
               const struct parameter *parameter, int refine, struct rotor_model *model, int *failed)
{
    int nrigid, status = models_beam(pool, models, rotor, nparameter, parameter, refine, &model->beam, &nrigid, failed);
    if (status)
        return status;
    const struct mesh *mesh = &model->beam.mesh;
    model->equations = (rotid_model){.size = sizeof model->equations,
                                     .n = mesh->ndof,
                                     .kd = mesh->kd,
                                     .nfar = mesh->nfar,
                                     .far = mesh->far,
                                     .nparam = nparameter,
                                     .nrigid = nrigid,
                                     .matrices = matrices,
                                     .derivatives = derivatives,
                                     .user = model};
    model->rotor = &model->beam.rotor;
    model->parameter = parameter;
    model->naxis = mesh->naxis;
    model->z = mesh->z;
    status = choose_masters(pool, model);
    if (status || nrigid >= 0)
        return status;
    double *x = POOL_ARRAY(pool, double, nparameter);
    if (!x)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < nparameter; p++)
        x[p] = *parameter_value(model->rotor, parameter[p]);
    status = beam_count_rigid(pool, &model->beam, x, &model->equations.nrigid);
    if (!status)
        models_keep_rigid(models, rotor, refine, model->equations.nrigid);
    return status;
}

double model_master_z(const struct rotor_model *model, int i)
{
    return model->z[model->master[i] / 2];
}

int model_lateral_dof(const struct rotor_model *model, double z)
{
    return 2 * mesh_node_at(&model->beam.mesh, z);
}

void model_set(struct rotor_model *model, const double *x)
{
    beam_set(&model->beam, x);
}

void model_mass_properties(const struct rotor_model *model, struct mass_properties *properties)
{
    beam_mass_properties(&model->beam, properties);
}

int model_weigh(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                const struct parameter *parameter, const double *x, struct mass_properties *properties)
{
    struct beam beam;
    int nrigid, failed, status = models_beam(pool, models, rotor, nparameter, parameter, 1, &beam, &nrigid, &failed);
    if (status)
        return status;
    beam_set(&beam, x);
    beam_mass_properties(&beam, properties);
    return ROTID_OK;
}

int model_exchange_effect(struct pool *pool, struct rotor_model *model, const struct effect *effect)
{
    struct effect *slot = &model->beam.rotor.effect[model->beam.rotor.neffect - 1];
    int joints = slot->kind->joint || effect->kind->joint;
    *slot = *effect;
    return joints ? hinge_place(pool, &model->beam) : ROTID_OK; /* which element has the hinge is settled with the mesh */
}

int model_sensor_alone(struct pool *pool, const struct rotor *rotor, int s, int *alone)
{
    struct mesh mesh;
    int status = mesh_build(pool, rotor, 1, &mesh);
    *alone = 1;
    for (int i = 0; i < rotor->nsensor && !status; i++)
        *alone &= i == s || mesh.sensor_node[i] != mesh.sensor_node[s];
    return status;
}
