#include "hide_solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int failed(const struct hide_message *message, int status)
{
    if (status == ORACLE_ERROR_UNSTABLE)
        return hide_fail(message, HIDE_INPUT, "the rotor buckles, expected smaller axial forces or a smaller effect");
    if (status == ORACLE_ERROR_SHAPE)
        return hide_fail(message, HIDE_INPUT, "a mode does not move any sensor, expected more sensors");
    return hide_fail(message, HIDE_FAILURE, "the oracle failed with status %d", status);
}

static int frequencies(const struct hide_physics *physics, int first, int modes, double *hz, const struct hide_message *message)
{
    struct hide_model model;
    int status = hide_model_open(physics, &model, message), wrong;
    if (!status && (wrong = oracle_frequencies(&model.system, first, modes, hz)))
        status = failed(message, wrong);
    hide_model_close(&model);
    return status;
}

/* d ln(lambda)/d ln(c), c a factor on springs to the ground and on axial forces, is their share of the potential energy: beyond
 * half of it, or where there is hardly any energy at all, the mode is one of the suspension (docs/method.md). */
int hide_rigid_modes(const struct hide_physics *physics, int *rigid, const struct hide_message *message)
{
    const double step = 0.01;
    struct hide_physics more = *physics;
    double hz[3], raised[3];
    int status = frequencies(physics, 1, 3, hz, message);
    more.ground *= 1 + step;
    *rigid = 0;
    if (status || (status = frequencies(&more, 1, 3, raised, message)))
        return status;
    while (*rigid < 2) {
        double share = hz[*rigid] > 0 ? 2 * log(raised[*rigid] / hz[*rigid]) / log(1 + step) : 1;
        if (share <= 0.5 && hz[*rigid] > 1e-3 * hz[2])
            break;
        ++*rigid;
    }
    return HIDE_OK;
}

static int solve(const struct hide_physics *physics, int rigid, int modes, int sensors, const double *z, double *hz,
                 double *shape, const struct hide_message *message)
{
    struct hide_model model;
    int status = hide_model_open(physics, &model, message), wrong = 0;
    if (!status)
        wrong = oracle_frequencies(&model.system, rigid + 1, modes, hz);
    for (int k = 0; k < modes && sensors > 0 && !status && !wrong; k++)
        wrong = oracle_shape(&model.system, hz[k], sensors, z, shape + (ptrdiff_t)k * sensors, NULL);
    hide_model_close(&model);
    return status ? status : wrong ? failed(message, wrong) : HIDE_OK;
}

/* The largest component +1, as the oracle has it. */
static void scale(int sensors, double *shape)
{
    double largest = 0;
    for (int s = 0; s < sensors; s++)
        largest = fabs(shape[s]) > fabs(largest) ? shape[s] : largest;
    for (int s = 0; s < sensors; s++)
        shape[s] /= largest;
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Each point records its own component of the mode as it is with the accelerometer there. The scale of a loaded mode is the one
 * that brings it nearest to the unloaded one; masses make scales differ from it by the square of what they change. What the
 * accelerometer changes is computed with the first stretches, however fine those of the solution are: there are as many rotors as
 * sensors. */
static int add_moving(const struct hide_physics *physics, double mass, int rigid, const double *z, struct hide_solution *solution,
                      const struct hide_message *message)
{
    int modes = solution->modes, sensors = solution->sensors, status;
    size_t all = (size_t)modes * (size_t)sensors;
    double *bare = malloc(all * sizeof *bare), *loaded = malloc(all * sizeof *loaded), *record = malloc(all * sizeof *record);
    double bare_hz[HIDE_MOST_MODES], loaded_hz[HIDE_MOST_MODES], mean[HIDE_MOST_MODES] = {0};
    status = bare && loaded && record ? solve(physics, rigid, modes, sensors, z, bare_hz, bare, message)
                                      : hide_fail(message, HIDE_FAILURE, "no memory for shapes");
    for (int s = 0; s < sensors && !status; s++) {
        struct hide_disk accelerometer = {.z = z[s], .mass = mass};
        struct hide_physics with = *physics;
        with.moving = &accelerometer;
        status = solve(&with, rigid, modes, sensors, z, loaded_hz, loaded, message);
        for (int k = 0; k < modes && !status; k++) {
            const double *a = loaded + (ptrdiff_t)k * sensors, *b = bare + (ptrdiff_t)k * sensors;
            record[(ptrdiff_t)k * sensors + s] = dot(sensors, a, b) / dot(sensors, a, a) * a[s];
            mean[k] += loaded_hz[k] / sensors;
        }
    }
    for (int k = 0; k < modes && !status; k++) {
        double *shape = solution->shape + (ptrdiff_t)k * sensors, *b = bare + (ptrdiff_t)k * sensors;
        double sign = copysign(1, dot(sensors, shape, b)); /* the largest component is +1, and two may be nearly the largest */
        for (int s = 0; s < sensors; s++)
            shape[s] += sign * (record[(ptrdiff_t)k * sensors + s] - b[s]);
        scale(sensors, shape);
        solution->hz[k] *= mean[k] / bare_hz[k];
    }
    free(bare);
    free(loaded);
    free(record);
    return status;
}

static double moving_mass(const struct hide_physics *physics)
{
    double mass = 0;
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "accelerometer_mass") && hide_get(&physics->effect[i], "mount")->index == 1)
            mass += hide_get(&physics->effect[i], "mass")->number;
    return mass;
}

/* Nonzero if finer stretches differ from these: if any stiffness varies. */
static int can_refine(const struct hide_physics *physics)
{
    struct hide_physics finer = *physics;
    int coarse_count = 0, fine_count = 0;
    finer.refine *= 2;
    double *coarse = hide_cuts(physics, &coarse_count), *fine = hide_cuts(&finer, &fine_count);
    free(coarse);
    free(fine);
    return fine_count > coarse_count;
}

/* What the last halving changed is three times what is left, the error being of second order. */
#define FREQUENCY_CHANGE 3e-5
#define SHAPE_CHANGE     3e-4
#define MOST_REFINE      32

int hide_solve(const struct hide_physics *physics, int rigid, int modes, int sensors, const double *z,
               struct hide_solution *solution, const struct hide_message *message)
{
    size_t all = (size_t)modes * (size_t)sensors;
    struct hide_physics finer = *physics;
    double hz[HIDE_MOST_MODES], *shape = malloc((all + 1) * sizeof *shape);
    int status, again = can_refine(physics);
    *solution = (struct hide_solution){.modes = modes, .sensors = sensors, .refine = physics->refine};
    solution->shape = malloc((all + 1) * sizeof *shape);
    status = shape && solution->shape ? solve(physics, rigid, modes, sensors, z, solution->hz, solution->shape, message)
                                      : hide_fail(message, HIDE_FAILURE, "no memory for shapes");
    while (!status && again && finer.refine < MOST_REFINE) {
        double shape_change = 0, change = 0;
        finer.refine *= 2;
        if ((status = solve(&finer, rigid, modes, sensors, z, hz, shape, message)))
            break;
        for (int k = 0; k < modes; k++)
            change = fmax(change, fabs(hz[k] / solution->hz[k] - 1));
        for (size_t i = 0; i < all; i++) /* the sign turns where two components are nearly the largest */
            shape_change = fmax(shape_change, fabs(fabs(shape[i]) - fabs(solution->shape[i])));
        memcpy(solution->hz, hz, (size_t)modes * sizeof *hz);
        memcpy(solution->shape, shape, all * sizeof *shape);
        solution->refine = finer.refine;
        solution->error = change / 3;
        again = change > FREQUENCY_CHANGE || shape_change > SHAPE_CHANGE;
    }
    free(shape);
    if (!status && sensors > 0 && moving_mass(physics) > 0)
        status = add_moving(physics, moving_mass(physics), rigid, z, solution, message);
    return status;
}

void hide_solution_free(struct hide_solution *solution)
{
    free(solution->shape);
}
