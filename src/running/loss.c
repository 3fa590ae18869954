/* The loss of a group from the damping of a test: the damping ratio of mode k is half of what its group loses of the elastic
 * energy, 2 zeta_k = eta a_k,  2 zeta_k = s w_k a_k,  a_k = (E d lambda/dE + G d lambda/dG)/lambda with a_k the share of the
 * group in the energy of the mode. What supports and air take is counted as the group's. */
#include <math.h>

#include "modal/modal.h"
#include "running/running.h"

#define LEAST_SHARE 0.02 /* of the energy: a mode with less says nothing of the group */

int loss_of_test(struct pool *pool, const struct job *job, int group, struct loss_of_test *out)
{
    const struct job_measurement *measured = &job->measurement;
    const struct material *material = &job->rotor.group[group].material;
    const struct parameter parameter[2] = {{.kind = PARAMETER_E, .index = group}, {.kind = PARAMETER_G, .index = group}};
    const double x[2] = {material->e, material->g};
    int n = material->isotropic ? 1 : 2, highest = 0, failed, status = ROTID_OK;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct prediction p;
    *out = (struct loss_of_test){0};
    for (int k = 0; k < measured->nmode; k++)
        highest = isfinite(measured->damping[k]) && measured->number[k] > highest ? measured->number[k] : highest;
    if (!highest || !model)
        return model ? ROTID_OK : ROTID_ERROR_MEMORY;
    status = model_open(pool, NULL, &job->rotor, n, parameter, 1, model, &failed);
    int nrigid = status ? 0 : model->equations.nrigid, *wanted = POOL_ARRAY(pool, int, nrigid + highest);
    if (!status)
        status = wanted ? prediction_new(pool, &model->equations, ROTID_REDUCTION_NONE, ROTID_NELSON, nrigid + highest, 0, &p)
                        : ROTID_ERROR_MEMORY;
    if (!status)
        status = prediction_compute(&p, x);
    for (int k = 0; k < highest && !status; k++)
        wanted[nrigid + k] = 1;
    if (!status)
        status = prediction_differentiate(&p, x, wanted, 0);
    double sum[2] = {0, 0}, square[2] = {0, 0};
    for (int k = 0; k < measured->nmode && !status; k++) {
        int pair = nrigid + measured->number[k] - 1;
        double share = 0;
        for (int q = 0; q < n && isfinite(measured->damping[k]); q++)
            share += x[q] * p.dlambda[pair + (ptrdiff_t)(nrigid + highest) * q] / p.lambda[pair];
        if (share < LEAST_SHARE)
            continue;
        const double loss[2] = {2 * measured->damping[k] / share, 2 * measured->damping[k] / share / sqrt(p.lambda[pair])};
        for (int i = 0; i < 2; i++) {
            sum[i] += loss[i];
            square[i] += loss[i] * loss[i];
        }
        out->count++;
    }
    for (int i = 0; i < 2 && out->count; i++) {
        out->value[i] = sum[i] / out->count;
        out->std[i] = out->count > 1 ? sqrt(fmax(0, square[i] - sum[i] * sum[i] / out->count) / (out->count - 1)) : 0;
    }
    return status;
}
