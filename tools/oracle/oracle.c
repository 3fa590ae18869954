/* Counts, natural frequencies and shapes.
 *
 * The number of natural frequencies below omega is J0 + s (Wittrick and Williams): s is the number of negative eigenvalues of the
 * dynamic stiffness D(omega^2) on the nodes, J0 the number of natural frequencies below omega with all nodes held. The members
 * are so short that J0 = 0 (oracle_member_mesh.c), and a parallel member has no inner degrees of freedom to add to it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle_model.h"

static const double two_pi = 6.28318530717958647692;

static int count_below(struct oracle_model *model, double lambda, int *count)
{
    double log_determinant;
    int status = oracle_make_members(model, fabs(lambda));

    return status ? status : oracle_evaluate(model, lambda, count, &log_determinant);
}

int oracle_count(const struct oracle_system *system, double omega, int *count)
{
    struct oracle_model model;
    int status;

    if (!count || !(omega > 0.0) || !isfinite(omega))
        return ORACLE_ERROR_ARGUMENT;
    status = oracle_model_build(system, &model);
    if (!status)
        status = count_below(&model, omega * omega, count);
    oracle_model_free(&model);
    return status;
}

/* ---- Frequencies ---- */

/* Between low and high [rad/s] lies exactly one natural frequency, so det D changes sign there once and has no pole, the members
 * being those of high throughout. Regula falsi (Illinois) on it; the count tells the side. */
static int refine(struct oracle_model *model, double tolerance, double *low, double *high)
{
    double log_low, log_high, log_new;
    int count, count_low, last = 0;
    int status = oracle_make_members(model, *high * *high);

    if (status || (status = oracle_evaluate(model, *low * *low, &count_low, &log_low)) ||
        (status = oracle_evaluate(model, *high * *high, &count, &log_high)))
        return status;
    for (int iteration = 0; *high - *low > tolerance * *high && iteration < 200; iteration++) {
        double width = *high - *low, step = 0.5 * tolerance * *high;
        double x = *low + width / (1.0 + exp(log_high - log_low));
        if (iteration % 8 == 7)
            x = 0.5 * (*low + *high); /* a guarantee, should the determinant be no help */
        x = fmin(fmax(x, *low + step), *high - step);
        if ((status = oracle_evaluate(model, x * x, &count, &log_new)))
            return status;
        if (count > count_low) {
            *high = x;
            log_high = log_new;
            log_low -= last == 1 ? log(2.0) : 0.0;
            last = 1;
        } else {
            *low = x;
            log_low = log_new;
            log_high -= last == -1 ? log(2.0) : 0.0;
            last = -1;
        }
    }
    return ORACLE_OK;
}

struct bracket {
    double low, high; /* rad/s */
    int count_low, count_high;
};

static int search(struct oracle_model *model, int first, int number, struct bracket *bracket, double *frequency_hz)
{
    const double tolerance = 1e-13;
    double floor_omega = sqrt(model->floor_lambda), top;
    int rigid, unstable, count, status;

    status = count_below(model, -model->floor_lambda, &unstable);
    if (!status && unstable > 0)
        status = ORACLE_ERROR_UNSTABLE;
    if (!status)
        status = count_below(model, model->floor_lambda, &rigid);
    if (status)
        return status;
    for (int i = 0; i < number; i++)
        bracket[i] = (struct bracket){floor_omega, INFINITY, rigid, 0};
    for (int i = 0; i < number; i++) {
        struct bracket *b = &bracket[i];
        int wanted = first + i;
        if (wanted <= rigid) {
            frequency_hz[i] = 0.0;
            continue;
        }
        top = fmax(b->low, model->reference);
        while (isinf(b->high) || b->high - b->low > tolerance * b->high) {
            double x;
            if (b->count_high - b->count_low == 1 && b->high - b->low < 0.05 * b->high) {
                status = refine(model, tolerance, &b->low, &b->high);
                if (status)
                    return status;
                break;
            }
            x = isinf(b->high) ? (top *= 2.0) : b->high > 4.0 * b->low ? sqrt(b->low * b->high) : 0.5 * (b->low + b->high);
            status = count_below(model, x * x, &count);
            if (status)
                return status;
            for (int j = i; j < number; j++) { /* what is learnt here serves all the others */
                if (first + j <= count && x < bracket[j].high) {
                    bracket[j].high = x;
                    bracket[j].count_high = count;
                } else if (first + j > count && x > bracket[j].low) {
                    bracket[j].low = x;
                    bracket[j].count_low = count;
                }
            }
        }
        frequency_hz[i] = 0.5 * (b->low + b->high) / two_pi;
    }
    return ORACLE_OK;
}

int oracle_frequencies(const struct oracle_system *system, int first, int number, double *frequency_hz)
{
    struct oracle_model model;
    struct bracket *bracket;
    int status;

    if (first < 1 || number < 1 || !frequency_hz)
        return ORACLE_ERROR_ARGUMENT;
    status = oracle_model_build(system, &model);
    bracket = malloc((size_t)number * sizeof(*bracket));
    if (!status && !bracket)
        status = ORACLE_ERROR_MEMORY;
    if (!status)
        status = search(&model, first, number, bracket, frequency_hz);
    free(bracket);
    oracle_model_free(&model);
    return status;
}

/* ---- Shape ---- */

/* Vector of the eigenvalue of D nearest to zero by inverse iteration, in unscaled degrees of freedom. At a natural frequency that
 * eigenvalue is about 1e-13 of the others, so two steps converge; the others are for close frequencies. */
static void null_vector(struct oracle_model *model)
{
    int n = model->dofs;

    for (int i = 0; i < n; i++)
        model->vector[i] = 1.0 + 0.5 * sin(1.7 * i * i + 0.3); /* no symmetry, so it is orthogonal to no shape that occurs */
    for (int iteration = 0; iteration < 5; iteration++) {
        double largest = 0.0;
        oracle_solve(n, model->matrix, model->pivot, model->vector, model->work);
        for (int i = 0; i < n; i++)
            largest = fmax(largest, fabs(model->vector[i]));
        for (int i = 0; i < n; i++)
            model->vector[i] /= largest;
    }
    for (int i = 0; i < n; i++)
        model->vector[i] *= model->scale[i];
}

static void apply(const double transfer[16], double state[4])
{
    double old[4] = {state[0], state[1], state[2], state[3]};

    for (int i = 0; i < 4; i++) {
        state[i] = 0.0;
        for (int j = 0; j < 4; j++)
            state[i] += transfer[4 * i + j] * old[j];
    }
}

/* State (v, theta, Q, M) at the left end of a member: p1 = Tpp^-1 (p2 - Tpu u1) or Tup^-1 (u2 - Tuu u1). */
static void left_state(const struct oracle_model *model, const struct oracle_member *member, double lambda, double state[4])
{
    double transfer[16], first, second, determinant;
    const double *t, *end;

    oracle_member_transfer(model, member->cell, lambda, transfer);
    t = member->mixed ? &transfer[8] : transfer;
    state[0] = model->vector[member->dof[0]];
    state[1] = model->vector[member->dof[1]];
    end = model->vector;
    first = end[member->dof[member->mixed ? 4 : 2]] - t[0] * state[0] - t[1] * state[1];
    second = end[member->dof[member->mixed ? 5 : 3]] - t[4] * state[0] - t[5] * state[1];
    determinant = t[2] * t[7] - t[3] * t[6];
    state[2] = (t[7] * first - t[3] * second) / determinant;
    state[3] = (t[2] * second - t[6] * first) / determinant;
}

/* Marches through every member from the state at its left end. */
static void interpolate(const struct oracle_model *model, double lambda, int points, const double *z, double *deflection,
                        double *rotation)
{
    const double margin = 1e-9 * model->length; /* at a station means to its left, whatever the rounding of z */

    for (int member = 0; member < model->members; member++) {
        double step[16], jump[2], state[4], at[4];
        int first = model->member[member].cell, end = member + 1 < model->members ? model->member[member + 1].cell : model->cells;
        left_state(model, &model->member[member], lambda, state);
        for (int cell = first; cell < end; cell++) {
            const struct oracle_cell *c = &model->cell[cell];
            double stop = cell + 1 < model->cells ? model->cell[cell + 1].z : INFINITY;
            if (cell > first) {
                oracle_station_jump(&model->station[c->station], lambda, jump);
                state[2] += jump[0] * state[0];
                state[3] += jump[1] * state[1];
            }
            for (int i = 0; i < points; i++) {
                if ((z[i] <= c->z + margin && cell > 0) || z[i] > stop + margin)
                    continue;
                memcpy(at, state, sizeof(at));
                oracle_transfer(c->segment, fmin(fmax(z[i] - c->z, 0.0), c->length), lambda, step);
                apply(step, at);
                deflection[i] = at[0];
                if (rotation)
                    rotation[i] = at[1];
            }
            oracle_transfer(c->segment, c->length, lambda, step);
            apply(step, state);
        }
    }
}

int oracle_shape(const struct oracle_system *system, double frequency_hz, int points, const double *z, double *deflection,
                 double *rotation)
{
    struct oracle_model model;
    double omega, log_determinant, largest = 0.0, in_nodes = 0.0;
    int status, negative;

    if (points < 1 || !z || !deflection || !(frequency_hz >= 0.0) || !isfinite(frequency_hz))
        return ORACLE_ERROR_ARGUMENT;
    status = oracle_model_build(system, &model);
    for (int i = 0; i < points && !status; i++) {
        if (!(z[i] >= -1e-9 * model.length && z[i] <= (1.0 + 1e-9) * model.length))
            status = ORACLE_ERROR_ARGUMENT;
    }
    if (status)
        goto done;
    omega = two_pi * frequency_hz;
    status = oracle_make_members(&model, omega * omega);
    if (!status)
        status = oracle_evaluate(&model, omega * omega, &negative, &log_determinant);
    if (status)
        goto done;
    null_vector(&model);
    interpolate(&model, omega * omega, points, z, deflection, rotation);
    for (int i = 0; i < points; i++)
        largest = fabs(deflection[i]) > fabs(largest) ? deflection[i] : largest;
    for (int i = 0; i < 4 * model.members; i++) /* the length turns a rotation into a deflection */
        in_nodes = fmax(in_nodes, fabs(model.vector[model.member[i / 4].dof[i % 4]]) * (i % 2 == 0 ? 1.0 : model.length));
    if (fabs(largest) <= 1e-9 * in_nodes) {
        status = ORACLE_ERROR_SHAPE;
        goto done;
    }
    for (int i = 0; i < points; i++) {
        deflection[i] /= largest;
        if (rotation)
            rotation[i] /= largest;
    }
done:
    oracle_model_free(&model);
    return status;
}
