#include "model/model.h"

double model_deflection(const struct rotor_model *model, int i, const double *u)
{
    return u[discrete_place_dof(&model->discrete, i)];
}

double model_sensor_deflection(const struct rotor_model *model, int sensor, const double *u)
{
    return u[discrete_sensor_dof(&model->discrete, sensor)];
}

int model_members(const struct rotor_model *model)
{
    return model->rotor->ntierod + model->rotor->nbars;
}

struct model_member model_member(const struct rotor_model *model, int i)
{
    const struct rotor *rotor = model->rotor;
    int bars = i - rotor->ntierod;
    return (struct model_member){bars < 0 ? rotor->tierod[i].name : rotor->bars[bars].name, bars >= 0,
                                 discrete_member_elements(&model->discrete, i)};
}

void model_member_deflection(const struct rotor_model *model, int i, const double *u, int npoint, double *z, double *v)
{
    discrete_member_deflection(&model->discrete, i, u, npoint, z, v);
}
