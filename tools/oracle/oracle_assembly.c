/* The dynamic stiffness D(lambda) of the whole system on the nodes of the members. */
#include <math.h>
#include <string.h>

#include "oracle_model.h"

void oracle_station_jump(const struct oracle_station *station, double lambda, double jump[2])
{
    jump[0] = station->spring - lambda * station->mass;
    jump[1] =
        station->rotational_spring[0] + station->rotational_spring[1] - lambda * (station->inertia[0] + station->inertia[1]);
}

void oracle_member_transfer(const struct oracle_model *model, int cell, double lambda, double product[16])
{
    int first = cell;

    for (; cell < model->cells && (cell == first || !model->cell[cell].node); cell++) {
        const struct oracle_cell *c = &model->cell[cell];
        double step[16], before[16], jump[2];
        oracle_transfer(c->segment, c->length, lambda, step);
        if (cell == first) {
            memcpy(product, step, sizeof(step));
            continue;
        }
        oracle_station_jump(&model->station[c->station], lambda, jump);
        for (int j = 0; j < 4; j++) {
            product[8 + j] += jump[0] * product[j];
            product[12 + j] += jump[1] * product[4 + j];
        }
        memcpy(before, product, sizeof(before));
        oracle_multiply(step, before, product);
    }
}

/* Adds to the lower triangle. */
static void add(struct oracle_model *model, int count, const int *dof, const double *matrix)
{
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) {
            if (dof[i] >= dof[j])
                model->matrix[dof[i] * model->dofs + dof[j]] += matrix[count * i + j];
        }
    }
}

/* Takes a held degree of freedom out of the scaled matrix: its row and column become those of a unit matrix, which adds nothing
 * to the count. */
static void hold(struct oracle_model *model, int dof)
{
    int n = model->dofs;

    for (int i = 0; i < n; i++)
        model->matrix[i > dof ? i * n + dof : dof * n + i] = 0.0;
    model->matrix[dof * n + dof] = 1.0;
    model->scale[dof] = 0.0;
}

static void add_stations(struct oracle_model *model, double lambda)
{
    for (int i = 0; i < model->stations; i++) {
        const struct oracle_station *s = &model->station[i];
        double lateral = s->spring - lambda * s->mass;
        if (s->dof[0] < 0)
            continue;
        if (isfinite(lateral))
            add(model, 1, &s->dof[0], &lateral);
        for (int side = 0; side < 2; side++) {
            double rotational = s->rotational_spring[side] - lambda * s->inertia[side];
            if (isfinite(rotational))
                add(model, 1, &s->dof[1 + side], &rotational);
        }
    }
}

/* A hinge of flexibility f enters by its moment M as an unknown, M (theta_right - theta_left) - f M^2/2, since its stiffness 1/f
 * would swamp that of the members as f goes to zero. Eliminating M has the pivot -f: the matrix has one negative eigenvalue more
 * than D. */
static void add_hinges(struct oracle_model *model, int *extra)
{
    int n = model->dofs;

    for (int i = 0; i < model->stations; i++) {
        const struct oracle_station *s = &model->station[i];
        if (!s->hinged || isinf(s->flexibility))
            continue;
        model->matrix[s->dof[3] * n + s->dof[1]] = -1.0;
        model->matrix[s->dof[3] * n + s->dof[2]] = 1.0;
        model->matrix[s->dof[3] * n + s->dof[3]] = -s->flexibility;
        *extra += 1;
    }
}

/* Displacements are scaled so that the inertia force of the whole mass becomes one, forces by the inverse: rounding then acts
 * like a relative change of the mass and of the geometry, whatever the elastic stiffness. */
static void scale_matrix(struct oracle_model *model, double lambda)
{
    int n = model->dofs;
    double lambda_scale = fmax(fabs(lambda), model->floor_lambda);
    double v = 1.0 / sqrt(lambda_scale * model->mass), theta = v / model->length;

    for (int i = 0; i < model->members; i++) {
        const struct oracle_member *member = &model->member[i];
        model->scale[member->dof[0]] = model->scale[member->dof[2]] = v;
        model->scale[member->dof[1]] = model->scale[member->dof[3]] = theta;
        if (member->mixed) {
            model->scale[member->dof[4]] = 1.0 / v;
            model->scale[member->dof[5]] = 1.0 / theta;
        }
    }
    for (int i = 0; i < model->stations; i++) {
        if (model->station[i].hinged)
            model->scale[model->station[i].dof[3]] = 1.0 / theta;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++)
            model->matrix[i * n + j] *= model->scale[i] * model->scale[j];
    }
}

int oracle_evaluate(struct oracle_model *model, double lambda, int *negative, double *log_determinant)
{
    const struct oracle_system *system = model->system;
    int n = model->dofs, extra = 0;

    memset(model->matrix, 0, (size_t)n * (size_t)n * sizeof(*model->matrix));
    for (int i = 0; i < model->members; i++) {
        const struct oracle_member *member = &model->member[i];
        double transfer[16], matrix[36];
        oracle_member_transfer(model, member->cell, lambda, transfer);
        if (member->mixed ? oracle_mixed_member(transfer, matrix) : oracle_dynamic_stiffness(transfer, matrix))
            return ORACLE_ERROR_RANGE;
        add(model, member->mixed ? 6 : 4, member->dof, matrix);
        extra += 2 * member->mixed;
    }
    add_stations(model, lambda);
    for (int i = 0; i < system->parallels; i++) {
        const struct oracle_parallel *p = &system->parallel[i];
        const struct oracle_station *a = &model->station[model->parallel_station[2 * i]];
        const struct oracle_station *b = &model->station[model->parallel_station[2 * i + 1]];
        int dof[4] = {a->dof[0], a->dof[1 + p->side_a], b->dof[0], b->dof[1 + p->side_b]};
        double matrix[16];
        for (int j = 0; j < 16; j++)
            matrix[j] = p->stiffness[j] - lambda * p->mass[j];
        add(model, 4, dof, matrix);
    }
    add_hinges(model, &extra);
    scale_matrix(model, lambda);
    for (int i = 0; i < model->stations; i++) {
        const struct oracle_station *s = &model->station[i];
        if (s->dof[0] >= 0 && isinf(s->spring))
            hold(model, s->dof[0]);
        for (int side = 0; side < 2 && s->dof[0] >= 0; side++) {
            if (isinf(s->rotational_spring[side]))
                hold(model, s->dof[1 + side]);
        }
        if (s->hinged && isinf(s->flexibility))
            hold(model, s->dof[3]);
    }
    oracle_factor(n, model->matrix, model->pivot, negative, log_determinant);
    *negative -= extra;
    return ORACLE_OK;
}
