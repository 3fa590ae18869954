#include "export/model.h"

#include <math.h>

#include "export/nodes.h"
#include "linalg/matrix.h"
#include "linalg/reduction.h"

static int condense(struct pool *pool, struct export_model *model)
{
    const rotid_model *beam = &model->discrete->equations;
    struct export_condensed *c = &model->condensed;
    struct reduction reduction;
    c->count = beam->nmaster;
    c->kind = model->job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    if (c->count > EXPORT_MOST_CONDENSE) {
        c->impossible =
            pool_format(pool, "%d %s are too many to condense onto, at most %d are possible", c->count,
                        model->job->rotor.nsensor ? "sensors" : "nodes (the deck has no sensors)", EXPORT_MOST_CONDENSE);
        return c->impossible ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    int status = reduction_new(pool, c->kind, &model->k, c->count, beam->master, &reduction);
    if (!status)
        status = reduction_compute(&reduction, &model->k, &model->m);
    if (status == ROTID_ERROR_SLAVE || status == ROTID_ERROR_MASS) {
        c->impossible = pool_format(pool,
                                    "%d sensor%s too few to condense onto: the rotor can still move freely while %s, expected "
                                    "two or more",
                                    c->count, c->count == 1 ? " is" : "s are", c->count == 1 ? "it rests" : "they rest");
        return c->impossible ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    c->k = reduction.kc;
    c->m = reduction.mc;
    return status;
}

int export_model_open(struct pool *pool, const struct job *job, const struct identification *identified, const char *version,
                      int with_condensed, struct export_model *model)
{
    *model = (struct export_model){.job = job, .version = version, .identified = identified};
    int failed, highest = comparison_highest(job), nparameter = identified ? job->unknowns.nparameter : 0;
    const double *x = identified ? identified->fit->x : NULL;
    model->discrete = POOL_NEW(pool, struct rotor_model);
    if (!model->discrete)
        return ROTID_ERROR_MEMORY;
    struct rotor_model *discrete = model->discrete;
    int status = model_open(pool, job->models, &job->rotor, nparameter, job->unknowns.parameter, 1, discrete, &failed);
    rotid_matrix structure;
    if (!status) {
        discrete_structure(&discrete->discrete, &structure);
        status = matrix_new(pool, structure.n, structure.kd, structure.nfar, structure.far, &model->k);
    }
    if (!status)
        status = matrix_new(pool, structure.n, structure.kd, structure.nfar, structure.far, &model->m);
    if (!status)
        status = spectrum_compute(pool, job->models, &job->rotor, nparameter, job->unknowns.parameter, x,
                                  job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN,
                                  highest > EXPORT_MODES ? highest : EXPORT_MODES, &model->spectrum);
    if (!status)
        status = export_nodes(pool, model);
    if (status)
        return status;
    discrete_assemble(&discrete->discrete, x, &model->k, &model->m);
    discrete_mass_properties(&discrete->discrete, &model->mass);
    return with_condensed ? condense(pool, model) : ROTID_OK;
}

double export_parameter(const struct export_model *model, int p)
{
    return *parameter_value(model->discrete->rotor, model->job->unknowns.parameter[p]);
}

double export_parameter_std(const struct export_model *model, int p)
{
    return model->identified ? model->identified->fit->std[p] : NAN;
}

int export_master_id(const struct export_model *model, int i)
{
    const struct rotor *rotor = &model->job->rotor;
    if (rotor->nsensor)
        return rotor->sensor[i].id;
    return model->is_solid ? model->discrete->discrete.solid.mesh.surface[i] + 1 : model->discrete->master[i] / 2 + 1;
}

double export_master_z(const struct export_model *model, int i)
{
    return model_master_z(model->discrete, i);
}
