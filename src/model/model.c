#include "model/model.h"

static int matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct rotor_model *model = user;
    discrete_assemble(&model->discrete, x, stiffness, mass);
    return 0;
}

/* rotid_model gives x here too; the model already stands at it, since derivatives follow matrices at the same point */
static int derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    int from, end;
    model_differentiate(user, x, p, stiffness, mass, &from, &end);
    return 0;
}

void model_differentiate(const struct rotor_model *model, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm, int *from,
                         int *end)
{
    parameters_set(discrete_rotor(&model->discrete), model->equations.nparam, model->parameter, x);
    discrete_differentiate(&model->discrete, p, dk, dm, from, end);
}

static int derivative_products(void *user, const double *x, int p, int count, const double *u, double *dk_u, double *dm_u)
{
    int from, end;
    return model_derivative_products(user, x, p, count, u, dk_u, dm_u, &from, &end);
}

int model_derivative_products(const struct rotor_model *model, const double *x, int p, int count, const double *u, double *dk_u,
                              double *dm_u, int *from, int *end)
{
    parameters_set(discrete_rotor(&model->discrete), model->equations.nparam, model->parameter, x);
    return discrete_derivative_products(&model->discrete, p, count, u, dk_u, dm_u, from, end);
}

static int choose_masters(struct pool *pool, struct rotor_model *model)
{
    int nsensor = model->rotor->nsensor, count = nsensor ? nsensor : model->naxis;
    model->master = POOL_ARRAY(pool, int, count);
    if (!model->master)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++)
        model->master[i] = nsensor ? discrete_sensor_dof(&model->discrete, i) : discrete_place_dof(&model->discrete, i);
    model->equations.nmaster = count;
    model->equations.master = model->master;
    for (int i = 1; i < count; i++) /* two sensors that fall on one node */
        if (model->master[i] <= model->master[i - 1])
            return ROTID_ERROR_ARGUMENT;
    return ROTID_OK;
}

/* Of a solid on the coarse mesh: a suspension needs no fine one. */
static int count_rigid(struct pool *pool, struct models *models, const struct rotor *rotor, struct rotor_model *model)
{
    int nparameter = model->equations.nparam, known, failed, status = ROTID_OK;
    struct discrete coarse = model->discrete;
    double *x = POOL_ARRAY(pool, double, nparameter);
    if (!x)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < nparameter; p++)
        x[p] = *parameter_value(model->rotor, model->parameter[p]);
    if (discretisation_is_solid(coarse.as))
        status = models_discretise(pool, models, rotor, nparameter, model->parameter, COARSE_MESH, &coarse, &known, &failed);
    if (status)
        return status;
    rotid_matrix structure;
    int nmodes;
    discrete_structure(&coarse, &structure);
    const double *modes = models_modes(models, structure.n, &nmodes);
    return discrete_count_rigid(pool, &coarse, x, nmodes, modes, &model->equations.nrigid);
}

int model_open(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
               const struct parameter *parameter, int refine, struct rotor_model *model, int *failed)
{
    int nrigid, status = models_discretise(pool, models, rotor, nparameter, parameter, refine, &model->discrete, &nrigid, failed);
    if (status)
        return status;
    rotid_matrix structure;
    discrete_structure(&model->discrete, &structure);
    model->equations = (rotid_model){.size = sizeof model->equations,
                                     .n = structure.n,
                                     .kd = structure.kd,
                                     .nfar = structure.nfar,
                                     .far = structure.far,
                                     .nparam = nparameter,
                                     .nrigid = nrigid,
                                     .matrices = matrices,
                                     .derivatives = derivatives,
                                     .derivative_products = derivative_products,
                                     .user = model};
    model->equations.modes = models_modes(models, structure.n, &model->equations.nmodes);
    model->rotor = discrete_rotor(&model->discrete);
    model->parameter = parameter;
    model->naxis = discrete_places(&model->discrete);
    model->z = discrete_place_z(&model->discrete);
    status = choose_masters(pool, model);
    if (status || nrigid >= 0)
        return status;
    status = count_rigid(pool, models, rotor, model);
    if (!status)
        models_keep_rigid(models, rotor, refine, model->equations.nrigid);
    return status;
}

int model_begin_with(struct pool *pool, struct rotor_model *model, const struct rotor_model *known, int count, const double *phi)
{
    int n = known->equations.n, to = model->equations.n;
    double *modes = POOL_ARRAY(pool, double, (size_t)to *(size_t)count);
    if (!modes)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < count; k++)
        if (!discrete_transfer(&known->discrete, phi + (ptrdiff_t)k * n, &model->discrete, modes + (ptrdiff_t)k * to))
            return ROTID_OK;
    model->equations.modes = modes;
    model->equations.nmodes = count;
    return ROTID_OK;
}

static int basis_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct basis_model *model = user;
    solid_basis_assemble(&model->basis, x, stiffness, mass);
    return 0;
}

static int basis_derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct basis_model *model = user;
    solid_basis_differentiate(&model->basis, x, p, stiffness, mass);
    return 0;
}

int model_in_basis(struct pool *pool, struct rotor_model *model, const double *x, int count, const double *v,
                   struct basis_model *out)
{
    const rotid_model *of = &model->equations;
    discrete_set(&model->discrete, x);
    int status = solid_basis_new(pool, &model->discrete.solid, count, v, &out->basis);
    double *sensor = POOL_ARRAY(pool, double, (size_t)count *(size_t)of->nmaster);
    if (status || !sensor)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < of->nmaster; s++)
        for (int j = 0; j < count; j++)
            sensor[j + (ptrdiff_t)s * count] = v[of->master[s] + (ptrdiff_t)j * of->n];
    out->equations = (rotid_model){.size = sizeof out->equations,
                                   .n = count,
                                   .kd = count - 1,
                                   .nparam = of->nparam,
                                   .nrigid = of->nrigid,
                                   .nmaster = of->nmaster,
                                   .matrices = basis_matrices,
                                   .derivatives = basis_derivatives,
                                   .user = out,
                                   .sensor = sensor};
    return ROTID_OK;
}

int model_mass_is_positive(const struct rotor_model *model)
{
    int positive = discretisation_is_solid(model->discrete.as);
    for (int p = 0; p < model->equations.nparam; p++) {
        enum parameter_kind kind = model->parameter[p].kind;
        positive &= kind != PARAMETER_RHO && kind != PARAMETER_DISK_MASS && kind != PARAMETER_DISK_INERTIA;
    }
    for (int i = 0; i < model->rotor->neffect; i++)
        positive &= !model->rotor->effect[i].kind->at_disk && !model->rotor->effect[i].kind->point;
    return positive;
}

double model_master_z(const struct rotor_model *model, int i)
{
    return model->rotor->nsensor ? discrete_sensor_z(&model->discrete, i) : model->z[i];
}

int model_lateral_dof(const struct rotor_model *model, double z)
{
    int nearest = 0;
    for (int i = 1; i < model->naxis; i++)
        if (fabs(model->z[i] - z) < fabs(model->z[nearest] - z))
            nearest = i;
    return discrete_place_dof(&model->discrete, nearest);
}

void model_whole(const struct rotor_model *model, double *whole)
{
    int n = model->equations.n;
    memset(whole, 0, 2 * (size_t)n * sizeof *whole);
    (void)discrete_rigid_motions(&model->discrete, whole);
    for (int i = n; i < 2 * n; i++) /* theta = -dv/dz */
        whole[i] = -whole[i];
}

void model_mass_properties(const struct rotor_model *model, struct mass_properties *properties)
{
    discrete_mass_properties(&model->discrete, properties);
}

int model_weigh(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                const struct parameter *parameter, const double *x, struct mass_properties *properties)
{
    struct discrete discrete;
    int nrigid, failed, status = models_discretise(pool, models, rotor, nparameter, parameter, 1, &discrete, &nrigid, &failed);
    if (status)
        return status;
    discrete_set(&discrete, x);
    discrete_mass_properties(&discrete, properties);
    return ROTID_OK;
}

int model_exchange_effect(struct pool *pool, struct rotor_model *model, const struct effect *effect)
{
    const struct rotor *rotor = discrete_rotor(&model->discrete);
    struct effect *slot = &rotor->effect[rotor->neffect - 1];
    int joints = slot->kind->joint || effect->kind->joint;
    *slot = *effect;
    return joints ? discrete_place_joints(pool, &model->discrete) : ROTID_OK;
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

double model_deflection(const struct rotor_model *model, int i, const double *u)
{
    return u[discrete_place_dof(&model->discrete, i)];
}

struct model_member model_member(const struct rotor_model *model, int i)
{
    const struct rotor *rotor = model->rotor;
    int bars = i - rotor->ntierod;
    return (struct model_member){bars < 0 ? rotor->tierod[i].name : rotor->bars[bars].name, bars >= 0,
                                 discrete_member_elements(&model->discrete, i)};
}
