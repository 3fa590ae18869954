#include "model/deflection.h"

#include "beam/deflection.h"

double model_deflection(const struct rotor_model *model, int i, const double *u)
{
    (void)model;
    return u[2 * (ptrdiff_t)i];
}

double model_sensor_deflection(const struct rotor_model *model, int sensor, const double *u)
{
    return u[2 * (ptrdiff_t)model->beam.mesh.sensor_node[sensor]];
}

int model_members(const struct rotor_model *model)
{
    return model->rotor->ntierod + model->rotor->nbars;
}

struct model_member model_member(const struct rotor_model *model, int i)
{
    const struct rotor *rotor = model->rotor;
    const struct mesh *mesh = &model->beam.mesh;
    int bars = i - rotor->ntierod;
    if (bars < 0)
        return (struct model_member){rotor->tierod[i].name, 0, chain_elements(&mesh->tierod[i])};
    return (struct model_member){rotor->bars[bars].name, 1, 2 * chain_elements(&mesh->bars[2 * (ptrdiff_t)bars])};
}

void model_member_deflection(const struct rotor_model *model, int i, const double *u, int npoint, double *z, double *v)
{
    int bars = i - model->rotor->ntierod;
    if (bars < 0)
        tierod_deflection(&model->beam, i, u, npoint, z, v);
    else
        bars_deflection(&model->beam, bars, u, npoint, z, v);
}
