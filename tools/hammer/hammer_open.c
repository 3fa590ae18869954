/* From a deck to an open test: all that is computed once. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hammer.h"
#include "hammer_options.h"
#include "hide/hide_model.h"
#include "hide/hide_parameter.h"
#include "hide/hide_solve.h"

static const double two_pi = 6.28318530717958647692;

#define MODES_UP_TO 3.0 /* times what the filter lets through */
#define DECAYED     1e-4

static int failed(int wrong, const struct hide_message *m)
{
    return wrong == ORACLE_ERROR_UNSTABLE ? hide_fail(m, HAMMER_INPUT, "the rotor buckles, expected smaller axial forces")
                                          : hide_fail(m, HAMMER_FAILURE, "the oracle failed with status %d", wrong);
}

/* What is left over of the exact receptance at negative omega^2, where nothing resonates, gives the polynomial of the rest: its
 * divided differences after Newton, then its coefficients. */
static int find_rest(const struct oracle_system *system, const struct hammer_test *test, int from, int to, const double *hz,
                     const double *residue, double *rest)
{
    static const double place[HAMMER_REST] = {-0.02, -0.15, -0.4, -0.8}; /* times the square of the filter's edge */
    double band = two_pi * HAMMER_EDGE * test->options.rate, lambda[HAMMER_REST];
    size_t points = (size_t)(to - from);
    double *exact = malloc(HAMMER_REST * points * sizeof *exact);
    int status = exact ? ORACLE_OK : ORACLE_ERROR_MEMORY;
    for (int i = 0; i < HAMMER_REST && !status; i++) {
        lambda[i] = place[i] * band * band;
        status =
            hammer_receptance(system, lambda[i], test->z[test->fixed], to - from, test->z + from, exact + (size_t)i * points);
    }
    for (int s = from; s < to && !status; s++) {
        double left[HAMMER_REST], *c = rest + (ptrdiff_t)s * HAMMER_REST;
        for (int i = 0; i < HAMMER_REST; i++) {
            left[i] = exact[(size_t)i * points + (size_t)(s - from)];
            for (int k = 0; k < test->modes; k++)
                left[i] -=
                    residue[(ptrdiff_t)s * test->modes + k] / (pow(two_pi * hz[(ptrdiff_t)s * test->modes + k], 2) - lambda[i]);
        }
        for (int order = 1; order < HAMMER_REST; order++)
            for (int i = HAMMER_REST - 1; i >= order; i--)
                left[i] = (left[i] - left[i - 1]) / (lambda[i] - lambda[i - order]);
        for (int j = 0; j < HAMMER_REST; j++)
            c[j] = 0;
        for (int i = HAMMER_REST - 1; i >= 0; i--) { /* c(lambda) becomes c(lambda) (lambda - lambda_i) + left_i */
            for (int j = HAMMER_REST - 1; j >= 0; j--)
                c[j] = (j > 0 ? c[j - 1] : left[i]) - lambda[i] * c[j];
        }
    }
    free(exact);
    return status;
}

/* The modes of the system as it is while the points from ... to-1 are recorded, and what they mean for these records. */
static int solve_points(const struct hide_physics *physics, int from, int to, struct hammer_test *test, double *shape,
                        const struct hide_message *m)
{
    struct hide_model model;
    int status = hide_model_open(physics, &model, m), wrong = 0;
    double *hz = test->hz + (ptrdiff_t)from * test->modes;
    if (!status && !(wrong = hammer_modes(&model.system, test->modes, test->points, test->z, hz, shape))) {
        for (int s = from; s < to; s++)
            for (int k = 0; k < test->modes; k++) {
                const double *of_mode = shape + (ptrdiff_t)k * test->points;
                test->hz[(ptrdiff_t)s * test->modes + k] = hz[k];
                test->residue[(ptrdiff_t)s * test->modes + k] = of_mode[test->fixed] * of_mode[s];
            }
        wrong = find_rest(&model.system, test, from, to, test->hz, test->residue, test->rest);
    }
    hide_model_close(&model);
    return status ? status : wrong ? failed(wrong, m) : HAMMER_OK;
}

static int solve_all(const struct hide_physics *bare, struct hammer_test *test, const struct hide_message *m)
{
    const struct hammer_options *o = &test->options;
    size_t all = (size_t)test->modes * (size_t)test->points;
    struct hide_disk sensor = {.z = test->z[test->fixed], .mass = o->sensor_mass};
    struct hide_physics physics = *bare;
    double *shape = malloc(all * sizeof *shape);
    int status =
        shape ? solve_points(bare, 0, test->points, test, shape, m) : hide_fail(m, HAMMER_FAILURE, "no memory for shapes");
    if (!status) {
        memcpy(test->bare_hz, test->hz, (size_t)test->modes * sizeof(double));
        memcpy(test->bare_shape, shape, all * sizeof(double));
    }
    if (!status && !(test->bare_hz[0] > 0))
        status = hide_fail(m, HAMMER_INPUT, "the rotor floats freely, expected *SPRING or *SLING that carry it, however soft");
    physics.moving = &sensor;
    if (!status && o->sensor_mass > 0 && o->roving_hammer)
        status = solve_points(&physics, 0, test->points, test, shape, m);
    for (int s = 0; s < test->points && !status && o->sensor_mass > 0 && !o->roving_hammer; s++) {
        sensor.z = test->z[s];
        status = solve_points(&physics, s, s + 1, test, shape, m);
    }
    free(shape);
    return status;
}

/* The slowest elastic mode sets the length: those of the suspension hardly accelerate anything. */
static void choose_count(struct hammer_test *test)
{
    double slowest = INFINITY, seconds = test->options.seconds;
    for (int k = test->rigid; k < test->modes; k++)
        slowest = fmin(slowest, two_pi * test->bare_hz[k] * hammer_damping(test, k));
    test->count = seconds > 0 ? (int)ceil(seconds * test->options.rate) : 256;
    while (seconds == 0 && test->count < HAMMER_MOST_COUNT &&
           test->count < (test->options.pretrigger - log(DECAYED) / slowest) * test->options.rate)
        test->count *= 2;
}

static int count_modes(const struct hide_physics *physics, struct hammer_test *test, const struct hide_message *m)
{
    struct hide_model model;
    int status = hide_model_open(physics, &model, m), wrong = 0;
    if (!status)
        wrong = oracle_count(&model.system, two_pi * MODES_UP_TO * HAMMER_EDGE * test->options.rate, &test->modes);
    hide_model_close(&model);
    if (status || wrong)
        return status ? status : failed(wrong, m);
    if (test->modes < test->rigid + 1 || test->modes > HAMMER_MOST_MODES)
        return hide_fail(m, HAMMER_INPUT, "%d modes up to %g Hz, expected %d to %d: choose another sampling rate", test->modes,
                         MODES_UP_TO * HAMMER_EDGE * test->options.rate, test->rigid + 1, HAMMER_MOST_MODES);
    return HAMMER_OK;
}

static int make_room(const struct hide_rotor *rotor, struct hammer_test *test)
{
    size_t points = (size_t)rotor->sensors, modes = (size_t)test->modes, all = points * modes;
    test->id = calloc(points, sizeof *test->id);
    test->z = calloc(points, sizeof *test->z);
    test->parameter = calloc((size_t)rotor->parameters + 1, sizeof *test->parameter);
    test->bare_hz = calloc(modes, sizeof(double));
    test->bare_shape = calloc(all, sizeof(double));
    test->hz = calloc(all, sizeof(double));
    test->residue = calloc(all, sizeof(double));
    test->rest = calloc(HAMMER_REST * points, sizeof(double));
    return test->id && test->z && test->parameter && test->bare_hz && test->bare_shape && test->hz && test->residue && test->rest;
}

static int open_rotor(const struct hide_rotor *rotor, struct hammer_test *test, const struct hide_message *m)
{
    struct hide_physics physics = {.rotor = rotor, .refine = 1, .ground = 1};
    int status;
    if (rotor->sensors < 1)
        return hide_fail(m, HAMMER_INPUT, "the deck has no *SENSORS, expected the points of the test");
    test->fixed = test->options.fixed ? hide_find_sensor(rotor, test->options.fixed) : 0;
    if (test->fixed < 0)
        return hide_fail(m, HAMMER_INPUT, "--fixed %ld: expected a sensor of the deck", test->options.fixed);
    if ((status = hammer_faults_check(&test->options, rotor, m)) || (status = hide_rigid_modes(&physics, &test->rigid, m)) ||
        (status = count_modes(&physics, test, m)))
        return status;
    if (!make_room(rotor, test))
        return hide_fail(m, HAMMER_FAILURE, "no memory for the modes");
    test->points = rotor->sensors;
    for (int s = 0; s < rotor->sensors; s++) {
        test->id[s] = rotor->sensor[s].id;
        test->z[s] = rotor->sensor[s].z;
    }
    test->parameters = rotor->parameters;
    for (int i = 0; i < rotor->parameters; i++) {
        memcpy(test->parameter[i].name, rotor->parameter[i].name, sizeof test->parameter[i].name);
        test->parameter[i].value = rotor->parameter[i].truth;
    }
    if ((status = solve_all(&physics, test, m)))
        return status;
    choose_count(test);
    hammer_filter_open(test->options.rate, &test->filter);
    return HAMMER_OK;
}

int hammer_open(const char *deck, const char *name, int truths, const char *const *truth, uint64_t seed,
                const struct hammer_options *options, struct hammer_test *test, char *message, size_t room)
{
    struct hide_message to = {message, room};
    struct hide_cards cards = {0};
    struct hide_rotor *rotor = calloc(1, sizeof *rotor);
    struct hide_random random;
    int status;
    *test = (struct hammer_test){.options = *options};
    hide_random_open(seed, HIDE_FOR_PARAMETERS, &random);
    if (rotor && (test->deck = calloc(strlen(deck) + 1, 1))) {
        memcpy(test->deck, deck, strlen(deck));
        if (!(status = hammer_options_check(options, &to)) && !(status = hide_cards_read(deck, name, &cards, &to)) &&
            !(status = hide_rotor_read(&cards, name, rotor, &to)) &&
            !(status = hide_parameters_set(truths, truth, &random, rotor, &to)))
            status = open_rotor(rotor, test, &to);
        hide_cards_free(&cards);
    } else
        status = hide_fail(&to, HAMMER_FAILURE, "no memory for a rotor");
    free(rotor);
    return status;
}

void hammer_close(struct hammer_test *test)
{
    free(test->deck);
    free(test->id);
    free(test->z);
    free(test->parameter);
    free(test->bare_hz);
    free(test->bare_shape);
    free(test->hz);
    free(test->residue);
    free(test->rest);
}
