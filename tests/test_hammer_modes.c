/* Modes, masses and the rest of the virtual hammer test, against a direct solution of the exact dynamic stiffness. */
#include "hammer_bench.h"
#include "hide/hide_model.h"
#include "hide/hide_parameter.h"
#include "support.h"

static const double two_pi = 6.28318530717958647692;

/* The system of the oracle that a deck means. */
struct opened {
    struct hammer_bench bench;
    struct hide_cards cards;
    struct hide_rotor *rotor;
    struct hide_model model;
};

static void open_system(const char *name, const struct hide_disk *moving, struct opened *o)
{
    char text[600] = "";
    struct hide_message message = {text, sizeof text};
    struct hide_random random;
    memset(o, 0, sizeof *o);
    hammer_bench_open(name, &o->bench);
    o->rotor = calloc(1, sizeof *o->rotor);
    hide_random_open(1, HIDE_FOR_PARAMETERS, &random);
    struct hide_physics physics = {.rotor = o->rotor, .refine = 1, .ground = 1, .moving = moving};
    if (hide_cards_read(o->bench.deck, "deck", &o->cards, &message) || hide_rotor_read(&o->cards, "deck", o->rotor, &message) ||
        hide_parameters_set(o->bench.truths, o->bench.truth, &random, o->rotor, &message) ||
        hide_model_open(&physics, &o->model, &message))
        fail_msg("%s", text);
}

static void close_system(struct opened *o)
{
    hide_model_close(&o->model);
    hide_cards_free(&o->cards);
    free(o->rotor);
    hammer_bench_close(&o->bench);
}

/* ---- Direct solution, by plain elimination and with none of the oracle's assembly ---- */

enum { most_nodes = 160 };

struct direct {
    int nodes;
    double z[most_nodes];
};

static void add_node(struct direct *d, double z)
{
    int at = d->nodes;
    for (int i = 0; i < d->nodes; i++)
        if (fabs(d->z[i] - z) < 1e-7)
            return;
    assert_true(d->nodes < most_nodes);
    for (; at > 0 && d->z[at - 1] > z; at--)
        d->z[at] = d->z[at - 1];
    d->z[at] = z;
    d->nodes++;
}

static int node_at(const struct direct *d, double z)
{
    int best = 0;
    for (int i = 1; i < d->nodes; i++)
        best = fabs(d->z[i] - z) < fabs(d->z[best] - z) ? i : best;
    return best;
}

static void eliminate(int n, double *a, double *b)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            best = fabs(a[i * n + k]) > fabs(a[best * n + k]) ? i : best;
        for (int j = 0; j < n; j++) {
            double keep = a[k * n + j];
            a[k * n + j] = a[best * n + j];
            a[best * n + j] = keep;
        }
        double keep = b[k];
        b[k] = b[best];
        b[best] = keep;
        for (int i = k + 1; i < n; i++) {
            double factor = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n && factor != 0; j++)
                a[i * n + j] -= factor * a[k * n + j];
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
    }
}

/* Deflections under a unit force at z_force; solution[2 nodes]. */
static void solve_direct(const struct oracle_system *system, const struct direct *d, double lambda, double z_force,
                         double *solution)
{
    int n = 2 * d->nodes;
    double *a = calloc((size_t)n * (size_t)n, sizeof *a), end = system->segment[0].length;
    int segment = 0;
    for (int i = 0; i + 1 < d->nodes; i++) {
        double transfer[16], stiffness[16];
        while ((d->z[i] + d->z[i + 1]) / 2 > end)
            end += system->segment[++segment].length;
        oracle_transfer(&system->segment[segment], d->z[i + 1] - d->z[i], lambda, transfer);
        assert_int_equal(oracle_dynamic_stiffness(transfer, stiffness), ORACLE_OK);
        for (int j = 0; j < 16; j++)
            a[(2 * i + j / 4) * n + 2 * i + j % 4] += stiffness[j];
    }
    for (int i = 0; i < system->points; i++) {
        const struct oracle_point *p = &system->point[i];
        int v = 2 * node_at(d, p->z);
        a[v * n + v] += p->spring - lambda * p->mass;
        a[(v + 1) * n + v + 1] += p->rotational_spring - lambda * p->inertia;
    }
    for (int i = 0; i < system->parallels; i++) {
        const struct oracle_parallel *p = &system->parallel[i];
        int left = 2 * node_at(d, p->z_a), right = 2 * node_at(d, p->z_b), dof[4] = {left, left + 1, right, right + 1};
        for (int j = 0; j < 16; j++)
            a[dof[j / 4] * n + dof[j % 4]] += p->stiffness[j] - lambda * p->mass[j];
    }
    memset(solution, 0, (size_t)n * sizeof *solution);
    solution[2 * node_at(d, z_force)] = 1;
    eliminate(n, a, solution);
    free(a);
}

static void place_nodes(const struct oracle_system *system, int points, const double *z, struct direct *d)
{
    double end = 0;
    d->nodes = 0;
    add_node(d, 0);
    for (int i = 0; i < system->segments; i++)
        add_node(d, end += system->segment[i].length);
    for (int i = 0; i < system->points; i++)
        add_node(d, system->point[i].z);
    for (int i = 0; i < system->parallels; i++) {
        add_node(d, system->parallel[i].z_a);
        add_node(d, system->parallel[i].z_b);
    }
    for (int i = 0; i < points; i++)
        add_node(d, z[i]);
}

/* Without damping and half a per cent off every resonance. The error is that of modes, masses and what the higher modes add, all
 * of it, as a share of the rms of the receptance over the points: relative to each, it would be that of the zeros between
 * resonances. */
UNIT_TEST(modal_sum_is_the_exact_receptance)
{
    static const char *const name[] = {"paper", "beam"};
    for (int r = 0; r < 2; r++) {
        struct opened o;
        struct hammer_test test;
        struct direct d;
        double solution[2 * most_nodes], worst = 0, worst_hz = 0;
        open_system(name[r], NULL, &o);
        o.bench.options.dampings = 1;
        o.bench.options.damping[0] = o.bench.options.suspension_damping = 1e-6;
        o.bench.options.seconds = 1;
        hammer_bench_test(&o.bench, &test);
        place_nodes(&o.model.system, test.points, test.z, &d);
        for (double hz = 20; hz < 3200; hz += 91.7) {
            double omega = two_pi * hz, square = 0, error = 0;
            int resonant = 0;
            for (int k = 0; k < test.modes; k++)
                resonant |= fabs(hz / test.bare_hz[k] - 1) < 5e-3;
            if (resonant)
                continue;
            solve_direct(&o.model.system, &d, omega * omega, test.z[test.fixed], solution);
            for (int s = 0; s < test.points; s++) {
                double exact = solution[2 * node_at(&d, test.z[s])];
                error = fmax(error, fabs(creal(hammer_frf(&test, s, CMPLX(0, omega))) / -(omega * omega) - exact));
                square += exact * exact / test.points;
            }
            if (error / sqrt(square) > worst) {
                worst = error / sqrt(square);
                worst_hz = hz;
            }
        }
        print_message("%s: modal sum differs from the direct solution by %.1e of its rms at most, at %.0f Hz\n", name[r], worst,
                      worst_hz);
        assert_true(worst < 5e-5);
        hammer_close(&test);
        close_system(&o);
    }
}

/* Both solutions of the same equations, below zero, off and near resonance. */
UNIT_TEST(receptance_is_the_direct_solution)
{
    static const double lambda[] = {-4e8, -1e6, 3e6, 1.1e8};
    struct opened o;
    struct direct d;
    double z[3] = {0.028446, 0.9, 2.030003}, receptance[3], solution[2 * most_nodes];
    open_system("paper", NULL, &o);
    place_nodes(&o.model.system, 3, z, &d);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(hammer_receptance(&o.model.system, lambda[i], z[0], 3, z, receptance), ORACLE_OK);
        solve_direct(&o.model.system, &d, lambda[i], z[0], solution);
        for (int s = 0; s < 3; s++)
            assert_close(receptance[s], solution[2 * node_at(&d, z[s])], 1e-7, 1e-16);
    }
    close_system(&o);
}

/* Free-free Euler-Bernoulli: at the end |v| is the largest and m v^2 / int m v^2 = 4 for every elastic mode. */
UNIT_TEST(masses_of_a_free_beam)
{
    struct oracle_segment bar = {.length = 2, .bending = 1e6, .shear = INFINITY, .mass = 50};
    struct oracle_system system = {.segments = 1, .segment = &bar};
    double z[1] = {0}, hz[6], shape[6];
    assert_int_equal(hammer_modes(&system, 6, 1, z, hz, shape), ORACLE_OK);
    for (int k = 2; k < 6; k++)
        assert_close(shape[k] * shape[k] * 50 * 2, 4, 1e-8, 0);
}

/* f'/f = 1 - m phi^2/2 to first order, and exactly the oracle's with the mass as a point of the rotor. */
UNIT_TEST(moving_accelerometer)
{
    const double mass = 0.03;
    struct opened o;
    struct hammer_test test;
    double hz[10], largest = 0;
    open_system("beam", NULL, &o);
    o.bench.options.sensor_mass = mass;
    o.bench.options.seconds = 1;
    hammer_bench_test(&o.bench, &test);
    for (int s = 0; s < test.points; s += 3) {
        struct opened with;
        struct hide_disk disk = {.z = test.z[s], .mass = mass};
        open_system("beam", &disk, &with);
        assert_int_equal(oracle_frequencies(&with.model.system, 1, 10, hz), ORACLE_OK);
        for (int k = 0; k < 10; k++) {
            double phi = test.bare_shape[(ptrdiff_t)k * test.points + s], shift = -mass * phi * phi / 2;
            assert_close(test.hz[(ptrdiff_t)s * test.modes + k], hz[k], 1e-11, 0);
            assert_close(hz[k] / test.bare_hz[k] - 1, shift, 0.15, 3e-7);
            largest = fmin(largest, hz[k] / test.bare_hz[k] - 1);
        }
        close_system(&with);
    }
    print_message("30 g shift frequencies of the 6 kg beam by up to %.2f %%\n", 100 * largest);
    assert_true(largest < -5e-3);
    hammer_close(&test);
    close_system(&o);
}

/* The fixed accelerometer belongs to every system alike, and its place is the response. */
UNIT_TEST(fixed_accelerometer)
{
    struct opened o;
    struct hammer_test roving, fixed;
    open_system("beam", NULL, &o);
    o.bench.options.seconds = 1;
    o.bench.options.fixed = 4;
    o.bench.options.sensor_mass = 0.03;
    hammer_bench_test(&o.bench, &roving);
    o.bench.options.roving_hammer = 1;
    hammer_bench_test(&o.bench, &fixed);
    assert_int_equal(fixed.fixed, 3);
    for (int s = 0; s < fixed.points; s++)
        for (int k = 0; k < fixed.modes; k++)
            assert_close(fixed.hz[(ptrdiff_t)s * fixed.modes + k], roving.hz[3 * (ptrdiff_t)roving.modes + k], 0, 0);
    hammer_close(&roving);
    o.bench.options.sensor_mass = 0;
    hammer_bench_test(&o.bench, &roving);
    hammer_close(&fixed);
    o.bench.options.roving_hammer = 0;
    hammer_bench_test(&o.bench, &fixed);
    for (int s = 0; s < fixed.points; s++) /* reciprocity */
        assert_true(cabs(hammer_frf(&fixed, s, CMPLX(0, 5e3)) - hammer_frf(&roving, s, CMPLX(0, 5e3))) == 0);
    hammer_close(&roving);
    hammer_close(&fixed);
    close_system(&o);
}
