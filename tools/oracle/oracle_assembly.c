/* The dynamic stiffness D(lambda) of the whole system on the nodes of the members. */
#include <math.h>
#include <string.h>

#include "oracle_model.h"

/* product := left product; the state is (v, theta, Q, M). */
static void advance(const double left[16], double product[16])
{
    double old[16];

    memcpy(old, product, sizeof(old));
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            product[4 * i + j] = left[4 * i] * old[j] + left[4 * i + 1] * old[4 + j] + left[4 * i + 2] * old[8 + j] +
                                 left[4 * i + 3] * old[12 + j];
        }
    }
}

void oracle_station_jump(const struct oracle_station *station, double lambda, double jump[2])
{
    jump[0] = station->spring - lambda * station->mass;
    jump[1] = station->rotational_spring[0] + station->rotational_spring[1] -
              lambda * (station->inertia[0] + station->inertia[1]);
}

int oracle_member_transfer(const struct oracle_model *model, int cell, double lambda, double product[16])
{
    int first = cell;

    for (; cell < model->cells && (cell == first || !model->cell[cell].node); cell++) {
        const struct oracle_cell *c = &model->cell[cell];
        double step[16], jump[2];
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
        advance(step, product);
    }
    return cell;
}

/* Adds to the lower triangle; scale collects the magnitudes on the diagonal, among which nothing cancels. */
static void add(struct oracle_model *model, int count, const int *dof, const double *matrix)
{
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) {
            if (dof[i] >= dof[j])
                model->matrix[dof[i] * model->dofs + dof[j]] += matrix[count * i + j];
        }
        model->scale[dof[i]] += fabs(matrix[count * i + i]);
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
 * than D has. The scale is that which makes the larger of f and the flexibility of the members equal to one. */
static void add_hinges(struct oracle_model *model, int *extra)
{
    int n = model->dofs;

    *extra = 0;
    for (int i = 0; i < model->stations; i++) {
        const struct oracle_station *s = &model->station[i];
        int moment = s->dof[3];
        if (!s->hinged || isinf(s->flexibility))
            continue;
        model->matrix[moment * n + s->dof[1]] = -1.0;
        model->matrix[moment * n + s->dof[2]] = 1.0;
        model->matrix[moment * n + moment] = -s->flexibility;
        model->scale[moment] = fmax(s->flexibility, 1.0 / (model->scale[s->dof[1]] + model->scale[s->dof[2]]));
        *extra += 1;
    }
}

int oracle_evaluate(struct oracle_model *model, double lambda, int *negative, double *log_determinant)
{
    const struct oracle_system *system = model->system;
    int n = model->dofs, extra;

    memset(model->matrix, 0, (size_t)n * (size_t)n * sizeof(*model->matrix));
    memset(model->scale, 0, (size_t)n * sizeof(*model->scale));
    for (int member = 0, cell = 0; member < model->members; member++) {
        double transfer[16], stiffness[16];
        cell = oracle_member_transfer(model, cell, lambda, transfer);
        if (oracle_dynamic_stiffness(transfer, stiffness))
            return ORACLE_ERROR_RANGE;
        add(model, 4, &model->member_dof[4 * member], stiffness);
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
    for (int i = 0; i < n; i++) {
        model->scale[i] = model->scale[i] > 0.0 ? 1.0 / sqrt(model->scale[i]) : 1.0;
        for (int j = 0; j <= i; j++)
            model->matrix[i * n + j] *= model->scale[i] * model->scale[j];
    }
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

