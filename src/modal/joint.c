#include "modal/modal.h"

int joint_unknown(const int *parameter, int q)
{
    return parameter ? parameter[q] : q;
}

int joint_new(struct pool *pool, int kind, int reduction, int derivative, int nparam, int nstate, const struct joint_state *state,
              const struct joint_more *more, struct joint *joint)
{
    *joint = (struct joint){.nstate = nstate,
                            .nparam = nparam,
                            .nresidual = more ? more->count : 0,
                            .part = POOL_ARRAY(pool, struct joint_part, nstate),
                            .more = more};
    int status = joint->part ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int s = 0; s < nstate && !status; s++) {
        struct joint_part *part = &joint->part[s];
        int n = state[s].model->nparam;
        part->parameter = state[s].parameter;
        status = functional_new(pool, kind, reduction, derivative, state[s].model, state[s].measured, &part->functional);
        part->x = POOL_ARRAY(pool, double, n);
        part->jacobian = POOL_ARRAY(pool, double, (size_t)part->functional.nresidual *(size_t)n);
        if (!status && (!part->x || !part->jacobian))
            status = ROTID_ERROR_MEMORY;
        joint->nresidual += part->functional.nresidual;
    }
    return status;
}

static void take_unknowns(struct joint_part *part, const double *x)
{
    for (int q = 0; q < part->functional.prediction.model->nparam; q++)
        part->x[q] = x[joint_unknown(part->parameter, q)];
}

int joint_residual(struct joint *joint, const double *x, double *r)
{
    int status = ROTID_OK;
    for (int s = 0; s < joint->nstate && !status; s++) {
        struct joint_part *part = &joint->part[joint->last = s];
        take_unknowns(part, x);
        status = functional_residual(&part->functional, part->x, r);
        r += part->functional.nresidual;
    }
    return status || !joint->more ? status : joint->more->residual(joint->more->user, x, r);
}

int joint_jacobian(struct joint *joint, const double *x, double *jacobian)
{
    int status = ROTID_OK;
    ptrdiff_t row = 0;
    memset(jacobian, 0, (size_t)joint->nresidual * (size_t)joint->nparam * sizeof *jacobian);
    for (int s = 0; s < joint->nstate && !status; s++) {
        struct joint_part *part = &joint->part[joint->last = s];
        int m = part->functional.nresidual;
        take_unknowns(part, x);
        if (m) /* a state that is held out has none */
            status = functional_jacobian(&part->functional, part->x, part->jacobian);
        for (int q = 0; q < part->functional.prediction.model->nparam && !status; q++) {
            double *column = jacobian + row + (ptrdiff_t)joint_unknown(part->parameter, q) * joint->nresidual;
            for (int i = 0; i < m; i++)
                column[i] += part->jacobian[i + (ptrdiff_t)q * m];
        }
        row += m;
    }
    return status || !joint->more ? status : joint->more->jacobian(joint->more->user, x, joint->nresidual, jacobian + row);
}
