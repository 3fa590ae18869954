/* The oracle against closed forms, limits, energies and finite elements that bound it from above. */
#include "../tools/oracle/oracle.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

/* cmocka compares floats. */
static void check_close(double value, double expected, double relative, double absolute, const char *what, int line)
{
    double allowed = relative * fabs(expected) + absolute;

    if (!(fabs(value - expected) <= allowed))
        fail_msg("line %d: %s is %.17g, expected %.17g, difference %.3g, allowed %.3g", line, what, value, expected,
                 value - expected, allowed);
}

#define CLOSE(value, expected, relative) check_close(value, expected, relative, 0.0, #value, __LINE__)
#define NEAR(value, expected, absolute)  check_close(value, expected, 0.0, absolute, #value, __LINE__)

#define MODES 12

static void frequencies(const struct oracle_system *system, int first, int number, double *hz)
{
    assert_int_equal(oracle_frequencies(system, first, number, hz), ORACLE_OK);
}

/* Steel, 2 m long, 0.1 m thick; slender: no shear flexibility, no rotary inertia. */
static struct oracle_segment bar(double length, int slender)
{
    struct oracle_segment s;

    assert_int_equal(oracle_round_segment(length, 0.1, 0.0, 2.1e11, 0.8e11, 0.3, 7850.0, 0.0, &s), ORACLE_OK);
    if (slender) {
        s.shear = INFINITY;
        s.inertia = 0.0;
    }
    return s;
}

/* ---- The factorisation ---- */

/* X D X' has the signs of D. Zeros on the diagonal of the product force blocks of size 2. */
UNIT_TEST(inertia_and_solution)
{
    enum { n = 23 };
    double x[n * n], a[n * n], factors[n * n], b[n], solution[n], work[n], log_determinant;
    int pivot[n], negative;
    uint32_t seed = 12345;

    for (int wanted = 0; wanted <= n; wanted++) {
        for (int i = 0; i < n * n; i++) {
            seed = seed * 1664525u + 1013904223u;
            x[i] = seed / 4294967296.0 - 0.5;
        }
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                a[i * n + j] = 0.0;
                for (int k = 0; k < n; k++)
                    a[i * n + j] += (k < wanted ? -1.0 : 1.0) * x[i * n + k] * x[j * n + k];
            }
            b[i] = solution[i] = i - 4.3;
        }
        memcpy(factors, a, sizeof(a));
        oracle_factor(n, factors, pivot, &negative, &log_determinant);
        assert_int_equal(negative, wanted);
        oracle_solve(n, factors, pivot, solution, work);
        for (int i = 0; i < n; i++) {
            double sum = 0.0, size = 0.0;
            for (int j = 0; j < n; j++) {
                sum += a[i * n + j] * solution[j];
                size += fabs(a[i * n + j] * solution[j]);
            }
            NEAR(sum, b[i], 1e-13 * size);
        }
    }
    double swap[9] = {0, 0, 0, 2, 0, 0, 0, 0, -3}; /* lower triangle of [0 2 0; 2 0 0; 0 0 -3]: eigenvalues 2, -2, -3 */
    oracle_factor(3, swap, pivot, &negative, &log_determinant);
    assert_int_equal(negative, 2);
    CLOSE(log_determinant, log(12.0), 1e-15);
}

/* ---- Members ---- */

/* Without axial force the element interpolates the exact static solution, so K = D(0) and M = -dD/dlambda(0). */
UNIT_TEST(element_is_the_static_limit)
{
    double k[16], m[16], transfer[16], exact[16], above[16], below[16];

    for (int slender = 0; slender < 2; slender++) {
        struct oracle_segment s = bar(slender ? 1.0 : 0.13, slender);
        double h = 1e-3 * s.bending / (s.mass * pow(s.length, 4.0));
        assert_int_equal(oracle_beam_element(&s, k, m), ORACLE_OK);
        oracle_transfer(&s, s.length, 0.0, transfer);
        assert_int_equal(oracle_dynamic_stiffness(transfer, exact), ORACLE_OK);
        oracle_transfer(&s, s.length, h, transfer);
        assert_int_equal(oracle_dynamic_stiffness(transfer, above), ORACLE_OK);
        oracle_transfer(&s, s.length, -h, transfer);
        assert_int_equal(oracle_dynamic_stiffness(transfer, below), ORACLE_OK);
        for (int i = 0; i < 16; i++) {
            double stiffness_size = sqrt(k[5 * (i / 4)] * k[5 * (i % 4)]), mass_size = sqrt(m[5 * (i / 4)] * m[5 * (i % 4)]);
            NEAR(k[i], exact[i], 1e-13 * stiffness_size);
            NEAR((below[i] - above[i]) / (2.0 * h), m[i], 1e-8 * mass_size);
        }
    }
}

/* Eliminating Q2 and M2 from the mixed form gives the dynamic stiffness. */
UNIT_TEST(mixed_form)
{
    struct oracle_segment s = bar(0.3, 0);
    double transfer[16], exact[16], mixed[36];

    s.axial = -0.01 * s.shear;
    for (int variant = 0; variant < 3; variant++) {
        oracle_transfer(&s, s.length, (variant - 1) * 2e7, transfer);
        assert_int_equal(oracle_dynamic_stiffness(transfer, exact), ORACLE_OK);
        assert_int_equal(oracle_mixed_member(transfer, mixed), ORACLE_OK);
        for (int k = 5; k >= 4; k--) {
            for (int i = 0; i < k; i++) {
                for (int j = 0; j < k; j++)
                    mixed[6 * i + j] -= mixed[6 * i + k] * mixed[6 * k + j] / mixed[7 * k];
            }
        }
        for (int i = 0; i < 16; i++)
            NEAR(mixed[6 * (i / 4) + i % 4], exact[i], 1e-13 * sqrt(fabs(exact[5 * (i / 4)] * exact[5 * (i % 4)])));
    }
}

/* The transfer matrix of two stretches is the product of theirs, down to slivers, under compression and at imaginary frequency.
 * */
UNIT_TEST(transfer_is_a_group)
{
    static const double share[3] = {0.5, 0.9, 1e-7};
    struct oracle_segment s = bar(0.4, 0);

    s.axial = -0.3 * s.shear;
    for (int i = 0; i < 6; i++) {
        double lambda = (i < 3 ? 1.0 : -1.0) * 4e8, whole[16], left[16], right[16];
        oracle_transfer(&s, s.length, lambda, whole);
        oracle_transfer(&s, share[i % 3] * s.length, lambda, left);
        oracle_transfer(&s, (1.0 - share[i % 3]) * s.length, lambda, right);
        for (int j = 0; j < 16; j++) {
            double product = 0.0, size = 0.0;
            for (int k = 0; k < 4; k++) {
                product += right[4 * (j / 4) + k] * left[4 * k + j % 4];
                size += fabs(right[4 * (j / 4) + k] * left[4 * k + j % 4]);
            }
            NEAR(product, whole[j], 2e-14 * size);
        }
    }
}

/* ---- Uniform beams ---- */

UNIT_TEST(euler_bernoulli)
{
    static const double free_free[5] = {4.730040744862704, 7.853204624095838, 10.995607838001671, 14.137165491257464,
                                        17.278759657399481};
    static const double cantilever[5] = {1.875104068711961, 4.694091132974175, 7.854757438237613, 10.995540734875467,
                                         14.137168391046471};
    struct oracle_segment s = bar(2.0, 1);
    struct oracle_point held[2] = {{.z = 0.0, .spring = INFINITY}, {.z = 2.0, .spring = INFINITY}};
    struct oracle_point clamp = {.z = 0.0, .spring = INFINITY, .rotational_spring = INFINITY};
    struct oracle_system system = {.segments = 1, .segment = &s};
    double unit, hz[7];

    for (int finite = 0; finite < 2; finite++) {
        if (finite) { /* the limit from the other side; its error is EI/(kGS L^2) and rhoI/(rhoS L^2), times (beta L)^2 */
            s.shear = 1e13 * s.bending;
            s.inertia = 1e-13 * s.mass;
        }
        unit = sqrt(s.bending / s.mass) / (s.length * s.length) / (2.0 * pi);
        system.points = 0;
        frequencies(&system, 1, 7, hz);
        assert_true(hz[0] == 0.0 && hz[1] == 0.0);
        for (int i = 0; i < 5; i++)
            CLOSE(hz[i + 2], free_free[i] * free_free[i] * unit, finite ? 1e-10 : 2e-12);
        system.points = 2;
        system.point = held;
        frequencies(&system, 1, 5, hz);
        for (int i = 0; i < 5; i++)
            CLOSE(hz[i], (i + 1) * (i + 1) * pi * pi * unit, finite ? 1e-10 : 2e-12);
        system.points = 1;
        system.point = &clamp;
        frequencies(&system, 1, 5, hz);
        for (int i = 0; i < 5; i++)
            CLOSE(hz[i], cantilever[i] * cantilever[i] * unit, finite ? 1e-10 : 2e-12);
    }
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;

    return (*a > *b) - (*a < *b);
}

/* v = A sin kz, theta = B cos kz, k = n pi/L satisfies v = M = 0 at both ends. The two equations of motion become
 *     A (lambda rhoS - (kGS + F) k^2) - B kGS k = 0,   -A kGS k + B (lambda rhoI - EI k^2 - kGS) = 0,
 * whose determinant is a lambda^2 - b lambda + c with a = rhoS rhoI, b = rhoS (EI k^2 + kGS) + rhoI (kGS + F) k^2 and
 * c = k^2 ((kGS + F) EI k^2 + F kGS). Both roots are natural frequencies (the second spectrum); n = 0 has v = 0 and lambda =
 * kGS/rhoI. */
UNIT_TEST(pinned_timoshenko)
{
    struct oracle_segment s = bar(0.25, 0);
    struct oracle_point held[2] = {{.z = 0.0, .spring = INFINITY}, {.z = 0.25, .spring = INFINITY}};
    struct oracle_system system = {.segments = 1, .segment = &s, .points = 2, .point = held};
    double buckling = 1.0 / (s.length * s.length / (pi * pi * s.bending) + 1.0 / s.shear);
    const double axial[4] = {0.0, 0.3 * s.shear, -0.5 * buckling, -0.99 * buckling};
    double expected[2 * 40 + 1], hz[30], v[9], theta[9], z[9];

    for (int i = 0; i < 9; i++)
        z[i] = s.length * i / 8.0;
    for (int variant = 0; variant < 4; variant++) {
        s.axial = axial[variant];
        for (int n = 0; n < 40; n++) {
            double k = (n + 1) * pi / s.length, a = s.mass * s.inertia;
            double b = s.mass * (s.bending * k * k + s.shear) + s.inertia * (s.shear + s.axial) * k * k;
            double c = k * k * ((s.shear + s.axial) * s.bending * k * k + s.axial * s.shear);
            double root = sqrt(b * b - 4.0 * a * c);
            expected[2 * n] = sqrt(2.0 * c / (b + root)) / (2.0 * pi);
            expected[2 * n + 1] = sqrt((b + root) / (2.0 * a)) / (2.0 * pi);
        }
        expected[80] = sqrt(s.shear / s.inertia) / (2.0 * pi);
        qsort(expected, 81, sizeof(expected[0]), ascending);
        frequencies(&system, 1, 30, hz);
        for (int i = 0; i < 30; i++)
            CLOSE(hz[i], expected[i], variant == 3 && i == 0 ? 1e-10 : 2e-12);
        for (int n = 1; n < 3; n++) {
            double k = n * pi / s.length, lambda = 4.0 * pi * pi * hz[n - 1] * hz[n - 1];
            double ratio = (lambda * s.mass - (s.shear + s.axial) * k * k) / (s.shear * k), sign; /* B/A */
            assert_int_equal(oracle_shape(&system, hz[n - 1], 9, z, v, theta), ORACLE_OK);
            sign = v[1] < 0.0 ? -1.0 : 1.0; /* two points are equally far out */
            for (int i = 0; i < 9; i++) {
                NEAR(v[i], sign * sin(k * z[i]), 1e-11);
                NEAR(theta[i], sign * ratio * cos(k * z[i]), 1e-11 * fabs(ratio));
            }
        }
    }
    s.axial = -1.001 * buckling;
    assert_int_equal(oracle_frequencies(&system, 1, 1, hz), ORACLE_ERROR_UNSTABLE);
}

/* ---- Rigid bodies, points, hinges ---- */

UNIT_TEST(rigid_bodies)
{
    struct oracle_segment s = bar(2.0, 0);
    struct oracle_point pin = {.z = 0.7, .spring = INFINITY}, hinge = {.z = 0.7, .flexibility = INFINITY};
    struct oracle_system system = {.segments = 1, .segment = &s};
    double hz[4], z[4] = {0.0, 0.5, 1.0, 2.0}, v[4];
    int count;

    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_OK);
    assert_int_equal(count, 2);
    frequencies(&system, 1, 4, hz);
    assert_true(hz[0] == 0.0 && hz[1] == 0.0 && hz[2] > 100.0);
    assert_int_equal(oracle_count(&system, 2.0 * pi * hz[2] * (1.0 - 1e-11), &count), ORACLE_OK);
    assert_int_equal(count, 2);
    assert_int_equal(oracle_count(&system, 2.0 * pi * hz[2] * (1.0 + 1e-11), &count), ORACLE_OK);
    assert_int_equal(count, 3);
    assert_int_equal(oracle_shape(&system, 0.0, 4, z, v, NULL), ORACLE_OK);
    NEAR(v[1], v[0] + 0.25 * (v[3] - v[0]), 1e-9);
    NEAR(v[2], v[0] + 0.5 * (v[3] - v[0]), 1e-9);
    system.points = 1;
    system.point = &pin;
    frequencies(&system, 1, 2, hz);
    assert_true(hz[0] == 0.0 && hz[1] > 10.0);
    system.point = &hinge;
    frequencies(&system, 1, 4, hz);
    assert_true(hz[0] == 0.0 && hz[1] == 0.0 && hz[2] == 0.0 && hz[3] > 10.0);
}

/* Smaller root of the eigenproblem of 2 by 2 stiffness and diagonal mass; sign +1 for the larger one. */
static double two_by_two(double k11, double k12, double k22, double m1, double m2, double sign)
{
    double a = k11 / m1, d = k22 / m2, mean = 0.5 * (a + d), root = sqrt(0.25 * (a - d) * (a - d) + k12 * k12 / (m1 * m2));
    double large = mean + root;

    return sqrt(sign > 0.0 ? large : (a * d - k12 * k12 / (m1 * m2)) / large) / (2.0 * pi);
}

/* Cantilever whose own mass is negligible: a tip mass and inertia on the static stiffness, the inverse of the flexibility
 * [L^3/3EI + L/kGS, -L^2/2EI; -L^2/2EI, L/EI]; a hinge at a adds f (L - a)^2, -f (L - a) and f to it. */
UNIT_TEST(tip_mass)
{
    struct oracle_segment s = bar(0.5, 0);
    double hz[2];

    s.mass *= 1e-13;
    s.inertia *= 1e-13;
    for (int hinged = 0; hinged < 2; hinged++) {
        double a = 0.1, f = hinged ? 3e-7 : 0.0, l = s.length, arm = l - a, mass = 40.0, inertia = 0.3;
        struct oracle_point points[3] = {{.z = 0.0, .spring = INFINITY, .rotational_spring = INFINITY},
                                         {.z = l, .mass = mass, .inertia = inertia},
                                         {.z = a, .flexibility = f}};
        struct oracle_system system = {.segments = 1, .segment = &s, .points = 3, .point = points};
        double f11 = l * l * l / (3.0 * s.bending) + l / s.shear + f * arm * arm, f12 = -l * l / (2.0 * s.bending) - f * arm;
        double f22 = l / s.bending + f, determinant = f11 * f22 - f12 * f12;
        frequencies(&system, 1, 2, hz);
        double k11 = f22 / determinant, k12 = -f12 / determinant, k22 = f11 / determinant;
        for (int i = 0; i < 2; i++)
            CLOSE(hz[i], two_by_two(k11, k12, k22, mass, inertia, i ? 1.0 : -1.0), 1e-11);
    }
}

/* With 1e10 times the stiffness of the springs, the beam is a rigid body of mass m and inertia m L^2/12 + rhoI L. */
UNIT_TEST(rigid_beam_on_springs)
{
    struct oracle_segment s = bar(2.0, 0);
    struct oracle_point springs[3] = {
        {.z = 0.0, .spring = 9790.0}, {.z = 2.0, .spring = 2000.0}, {.z = 1.4, .rotational_spring = 70.0}};
    struct oracle_system system = {.segments = 1, .segment = &s, .points = 3, .point = springs};
    double l = s.length, mass = s.mass * l, inertia = mass * l * l / 12.0 + s.inertia * l, hz[3];

    s.bending *= 1e7;
    s.shear *= 1e7;
    frequencies(&system, 1, 3, hz);
    for (int i = 0; i < 2; i++) { /* (v at the centre, theta): v(0) = v + theta L/2, v(L) = v - theta L/2 */
        double k12 = (9790.0 - 2000.0) * l / 2.0, k22 = (9790.0 + 2000.0) * l * l / 4.0 + 70.0;
        CLOSE(hz[i], two_by_two(9790.0 + 2000.0, k12, k22, mass, inertia, i ? 1.0 : -1.0), 1e-9);
    }
    assert_true(hz[2] > 1e4);
}

UNIT_TEST(hinge_limits)
{
    struct oracle_segment s[2] = {bar(0.8, 0), bar(1.2, 0)};
    struct oracle_point hinge = {.z = 0.8, .flexibility = 0.0};
    struct oracle_system system = {.segments = 2, .segment = s}, half = {.segments = 1, .segment = s};
    double solid[8], hz[8], pinned[8];
    double z[2] = {0.8, 0.8 + 1e-6}, v[2], theta[2];

    s[1].bending *= 0.4;
    frequencies(&system, 1, 8, solid);
    system.points = 1;
    system.point = &hinge;
    frequencies(&system, 1, 8, hz);
    for (int i = 0; i < 8; i++)
        CLOSE(hz[i], solid[i], 1e-12);
    for (int tiny = 0; tiny < 3; tiny++) { /* the stiffness 1/f must not swamp the rest; f EI/L is the size of the difference */
        hinge.flexibility = pow(10.0, -20.0 - 30.0 * tiny);
        frequencies(&system, 1, 8, hz);
        for (int i = 0; i < 8; i++)
            CLOSE(hz[i], solid[i], 1e-12);
    }
    hinge.flexibility = 1e-8;
    frequencies(&system, 1, 8, hz);
    for (int i = 2; i < 8; i++)
        assert_true(hz[i] < solid[i] * (1.0 - 1e-6));
    hinge.flexibility = INFINITY;
    frequencies(&system, 1, 8, pinned);
    hinge.flexibility = 1e8;
    frequencies(&system, 3, 6, hz);
    for (int i = 1; i < 6; i++)
        CLOSE(hz[i], pinned[i + 2], 1e-10);
    /* Held there as well, the halves are independent: the frequencies of the pinned-free left half are among them. */
    struct oracle_point pin = {.z = 0.8, .spring = INFINITY};
    half.points = 1;
    half.point = &pin;
    frequencies(&half, 1, 3, hz);
    hinge.spring = INFINITY;
    hinge.flexibility = INFINITY;
    frequencies(&system, 1, 8, pinned);
    assert_true(hz[0] == 0.0 && pinned[0] == 0.0 && pinned[1] == 0.0);
    for (int i = 1; i < 3; i++) {
        double best = INFINITY;
        for (int j = 2; j < 8; j++)
            best = fmin(best, fabs(pinned[j] / hz[i] - 1.0));
        NEAR(best, 0.0, 1e-11);
    }
    /* M = (theta_right - theta_left)/f is continuous: compare with EI theta' from the right. */
    hinge.spring = 0.0;
    hinge.flexibility = 1e-7;
    frequencies(&system, 3, 1, hz);
    assert_int_equal(oracle_shape(&system, hz[0], 2, z, v, theta), ORACLE_OK);
    double near[2] = {0.8 + 1e-6, 0.8 + 2e-6}, slope[2], right_theta[2], right_moment, left_theta;
    assert_int_equal(oracle_shape(&system, hz[0], 2, near, slope, right_theta), ORACLE_OK);
    left_theta = theta[0] / theta[1] * right_theta[0];
    right_moment = s[1].bending * (right_theta[1] - right_theta[0]) / 1e-6;
    CLOSE(right_theta[0] - left_theta, 1e-7 * right_moment, 1e-4);
}

/* A clamp in the middle leaves two equal cantilevers: every frequency is double. */
UNIT_TEST(double_frequencies)
{
    struct oracle_segment s = bar(2.0, 0), half = bar(1.0, 0);
    struct oracle_point middle = {.z = 1.0, .spring = INFINITY, .rotational_spring = INFINITY};
    struct oracle_point root = {.z = 0.0, .spring = INFINITY, .rotational_spring = INFINITY};
    struct oracle_system system = {.segments = 1, .segment = &s, .points = 1, .point = &middle};
    struct oracle_system cantilever = {.segments = 1, .segment = &half, .points = 1, .point = &root};
    double hz[8], expected[4], z[3] = {0.0, 1.0, 2.0}, v[3];

    frequencies(&system, 1, 8, hz);
    frequencies(&cantilever, 1, 4, expected);
    for (int i = 0; i < 8; i++)
        CLOSE(hz[i], expected[i / 2], 1e-12);
    assert_int_equal(oracle_shape(&system, hz[2], 3, z, v, NULL), ORACLE_OK);
    NEAR(v[1], 0.0, 1e-12);
    z[0] = 1.0;
    assert_int_equal(oracle_shape(&system, hz[2], 1, z, v, NULL), ORACLE_ERROR_SHAPE);
}

/* ---- A rotor with everything ---- */

struct rotor {
    struct oracle_segment segment[5];
    struct oracle_point point[6];
    struct oracle_parallel parallel[2];
    struct oracle_system system;
    double length;
};

static void make_rotor(struct rotor *rotor)
{
    static const double length[5] = {0.25, 0.3, 0.7, 0.26, 0.4}, diameter[5] = {0.14, 0.22, 0.36, 0.26, 0.15};
    struct oracle_tie tie = {12, 0.032, 0.13, 0.7, 2.1e11, 0.3, 7850.0, 150e3};

    memset(rotor, 0, sizeof(*rotor));
    for (int i = 0; i < 5; i++) {
        int core = i == 2;
        assert_int_equal(oracle_round_segment(length[i], diameter[i], i == 4 ? 0.05 : 0.0, core ? 1.05e11 : 2.1e11,
                                              core ? 0.47e11 : 2.1e11 / 2.6, 0.3, core ? 7650.0 : 7850.0,
                                              core ? -12.0 * 150e3 : 0.0, &rotor->segment[i]),
                         ORACLE_OK);
        rotor->length += length[i];
    }
    rotor->point[0] = (struct oracle_point){.z = 0.0, .spring = 9790.0};
    rotor->point[1] = (struct oracle_point){.z = rotor->length, .spring = 2000.0, .rotational_spring = 5e4};
    rotor->point[2] = (struct oracle_point){.z = 1.7, .mass = 8.0, .inertia = 0.2};
    rotor->point[3] = (struct oracle_point){.z = 0.55, .flexibility = 4e-9, .mass = 2.0, .inertia = 0.1, .side = ORACLE_LEFT};
    rotor->point[4] = (struct oracle_point){.z = 0.1234, .rotational_spring = 3e5, .spring = 1e7};
    rotor->point[5] = (struct oracle_point){.z = 0.55, .rotational_spring = 2e6, .side = ORACLE_RIGHT};
    rotor->parallel[0] = (struct oracle_parallel){.z_a = 0.55, .z_b = 1.25, .side_a = ORACLE_LEFT, .side_b = ORACLE_RIGHT};
    rotor->parallel[1] = (struct oracle_parallel){.z_a = 0.4, .z_b = 1.45};
    assert_int_equal(oracle_tie_rods(&tie, rotor->parallel[0].stiffness, rotor->parallel[0].mass), ORACLE_OK);
    tie.length = 1.05;
    tie.tension = 0.0;
    tie.count = 5;
    tie.pitch_radius = 0.1;
    assert_int_equal(oracle_tie_tube(&tie, rotor->parallel[1].stiffness, rotor->parallel[1].mass), ORACLE_OK);
    rotor->system = (struct oracle_system){5, rotor->segment, 6, rotor->point, 2, rotor->parallel};
}

/* Cutting the segments anywhere, slivers included, changes nothing. */
UNIT_TEST(subdivision)
{
    struct rotor rotor;
    struct oracle_segment pieces[400];
    double whole[MODES], cut[MODES];
    uint32_t seed = 7;

    make_rotor(&rotor);
    frequencies(&rotor.system, 1, MODES, whole);
    for (int variant = 0; variant < 3; variant++) {
        int count = 0, parts = variant == 0 ? 3 : 80;
        for (int i = 0; i < 5; i++) {
            double left = rotor.segment[i].length;
            for (int k = 0; k < parts; k++) {
                pieces[count] = rotor.segment[i];
                seed = seed * 1664525u + 1013904223u;
                if (variant == 1)
                    pieces[count].length = rotor.segment[i].length / parts;
                else
                    pieces[count].length = left * (seed >> 28 == 0 ? 1e-6 : seed / 4294967296.0 * 2.0 / parts);
                if (k == parts - 1)
                    pieces[count].length = left;
                left -= pieces[count++].length;
            }
        }
        rotor.system.segments = count;
        rotor.system.segment = pieces;
        frequencies(&rotor.system, 1, MODES, cut);
        for (int i = 0; i < MODES; i++)
            CLOSE(cut[i], whole[i], 1e-11);
    }
}

/* Seen from the other end, theta changes its sign and the sides of a hinge change places. */
UNIT_TEST(mirror)
{
    static const int swapped[4] = {2, 3, 0, 1};
    struct rotor rotor, image;
    double hz[MODES], mirrored[MODES], z[40], back[40], v[40], w[40];

    make_rotor(&rotor);
    image = rotor;
    for (int i = 0; i < 5; i++)
        image.segment[i] = rotor.segment[4 - i];
    for (int i = 0; i < 6; i++) {
        image.point[i].z = rotor.length - rotor.point[i].z;
        image.point[i].side = 1 - rotor.point[i].side;
    }
    for (int i = 0; i < 2; i++) {
        struct oracle_parallel *p = &image.parallel[i];
        const struct oracle_parallel *q = &rotor.parallel[i];
        p->z_a = rotor.length - q->z_b;
        p->z_b = rotor.length - q->z_a;
        p->side_a = 1 - q->side_b;
        p->side_b = 1 - q->side_a;
        for (int j = 0; j < 16; j++) {
            int from = 4 * swapped[j / 4] + swapped[j % 4];
            double sign = (j / 4 + j % 4) % 2 == 0 ? 1.0 : -1.0;
            p->stiffness[j] = sign * q->stiffness[from];
            p->mass[j] = sign * q->mass[from];
        }
    }
    image.system = (struct oracle_system){5, image.segment, 6, image.point, 2, image.parallel};
    frequencies(&rotor.system, 1, MODES, hz);
    frequencies(&image.system, 1, MODES, mirrored);
    for (int i = 0; i < 40; i++) {
        z[i] = rotor.length * i / 39.0;
        back[i] = rotor.length - z[i];
    }
    for (int i = 0; i < MODES; i++) {
        double product = 0.0;
        CLOSE(mirrored[i], hz[i], 1e-11);
        assert_int_equal(oracle_shape(&rotor.system, hz[i], 40, z, v, NULL), ORACLE_OK);
        assert_int_equal(oracle_shape(&image.system, mirrored[i], 40, back, w, NULL), ORACLE_OK);
        for (int j = 0; j < 40; j++)
            product += v[j] * w[j];
        for (int j = 0; j < 40; j++)
            NEAR(w[j] * (product < 0.0 ? -1.0 : 1.0), v[j], 1e-9);
    }
}

/* A fine mesh of finite elements is a Ritz approximation, so its frequencies lie above the exact ones, mode by mode, and near
 * them. The elements are those of oracle_beam_element; the hinge is one more degree of freedom. */
UNIT_TEST(finite_elements_bound_from_above)
{
    enum { per_segment = 24, nodes = 5 * per_segment + 5, dofs = 2 * nodes + 1 };
    static double stiffness[dofs * dofs], mass[dofs * dofs], shifted[dofs * dofs];
    struct rotor rotor;
    double z[nodes], hz[MODES], cuts[4] = {0.1234, 0.4, 1.45, 1.7}, log_determinant;
    struct oracle_segment element[nodes];
    int elements = 0, pivot[dofs], hinge_node = -1;

    make_rotor(&rotor);
    z[0] = 0.0;
    for (int i = 0; i < 5; i++) { /* equal elements, cut further at the points and at the ends of the second parallel member */
        double start = z[elements];
        for (int k = 1; k <= per_segment; k++) {
            double next = start + rotor.segment[i].length * k / per_segment;
            for (int c = 0; c < 4; c++) {
                if (cuts[c] > z[elements] + 1e-9 && cuts[c] < next - 1e-9) {
                    element[elements] = rotor.segment[i];
                    z[++elements] = cuts[c];
                }
            }
            element[elements] = rotor.segment[i];
            z[++elements] = next;
        }
    }
    assert_true(elements < nodes);
    int n = 2 * (elements + 1) + 1;
    for (int i = 0; i <= elements; i++)
        hinge_node = fabs(z[i] - 0.55) < 1e-9 ? i : hinge_node;
        /* theta on the right of the hinge is the last degree of freedom */
#define DOF(node, which, right) ((which) == 1 && (right) && (node) == hinge_node ? n - 1 : 2 * (node) + (which))
    for (int i = 0; i < elements + 2; i++) {
        double k[16], m[16];
        int dof[4];
        if (i < elements) {
            element[i].length = z[i + 1] - z[i];
            assert_int_equal(oracle_beam_element(&element[i], k, m), ORACLE_OK);
            for (int j = 0; j < 4; j++)
                dof[j] = DOF(i + j / 2, j % 2, j < 2);
        } else {
            const struct oracle_parallel *p = &rotor.parallel[i - elements];
            int end[2] = {-1, -1};
            for (int j = 0; j <= elements; j++) {
                end[0] = fabs(z[j] - p->z_a) < 1e-9 ? j : end[0];
                end[1] = fabs(z[j] - p->z_b) < 1e-9 ? j : end[1];
            }
            assert_true(end[0] >= 0 && end[1] >= 0);
            for (int j = 0; j < 4; j++)
                dof[j] = DOF(end[j / 2], j % 2, j < 2 ? p->side_a : p->side_b);
            memcpy(k, p->stiffness, sizeof(k));
            memcpy(m, p->mass, sizeof(m));
        }
        for (int a = 0; a < 16; a++) {
            stiffness[dof[a / 4] * n + dof[a % 4]] += k[a];
            mass[dof[a / 4] * n + dof[a % 4]] += m[a];
        }
    }
    for (int i = 0; i < 6; i++) {
        const struct oracle_point *p = &rotor.point[i];
        int node = -1;
        for (int j = 0; j <= elements; j++)
            node = fabs(z[j] - p->z) < 1e-9 ? j : node;
        assert_true(node >= 0);
        int lateral = 2 * node, left = 2 * node + 1, turning = DOF(node, 1, p->side), right = DOF(node, 1, 1);
        stiffness[lateral * n + lateral] += p->spring;
        mass[lateral * n + lateral] += p->mass;
        stiffness[turning * n + turning] += p->rotational_spring;
        mass[turning * n + turning] += p->inertia;
        if (p->flexibility > 0.0) {
            stiffness[left * n + left] += 1.0 / p->flexibility;
            stiffness[right * n + right] += 1.0 / p->flexibility;
            stiffness[left * n + right] -= 1.0 / p->flexibility;
            stiffness[right * n + left] -= 1.0 / p->flexibility;
        }
    }
#undef DOF
    frequencies(&rotor.system, 1, MODES, hz);
    for (int mode = 0; mode < MODES; mode++) {
        for (int above = 0; above < 2; above++) {
            double omega = 2.0 * pi * hz[mode] * (above ? 1.0 + 2e-3 : 1.0 - 1e-9);
            int negative;
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < n; j++) {
                    double scale = sqrt((fabs(stiffness[i * n + i]) + 1e6 * mass[i * n + i]) *
                                        (fabs(stiffness[j * n + j]) + 1e6 * mass[j * n + j]));
                    shifted[i * n + j] = (stiffness[i * n + j] - omega * omega * mass[i * n + j]) / scale;
                }
            }
            oracle_factor(n, shifted, pivot, &negative, &log_determinant);
            if (above)
                assert_true(negative >= mode + 1);
            else
                assert_true(negative <= mode);
        }
    }
}

/* Shapes are orthogonal in mass, and the Rayleigh quotient of a shape, with derivatives taken from the shape itself, is its
 * omega^2. 20 Gauss points in each stretch integrate and interpolate the analytic shapes to rounding. */
UNIT_TEST(orthogonality_and_energy)
{
    enum { q = 20, stretches = 10, total = q * stretches, ends = 12 };
    static const double bound[stretches + 1] = {0.0, 0.1234, 0.25, 0.4, 0.55, 0.9, 1.25, 1.45, 1.51, 1.7, 1.91};
    struct rotor rotor;
    double x[q], weight[q], derivative[q][q], z[total + ends], hz[MODES];
    static double v[MODES][total + ends], theta[MODES][total + ends], slope[MODES][total], curvature[MODES][total];

    make_rotor(&rotor);
    for (int i = 0; i < q; i++) { /* zeros of the Legendre polynomial by Newton */
        double p = 0.0, dp = 1.0;
        x[i] = cos(pi * (i + 0.75) / (q + 0.5));
        for (int iteration = 0; iteration < 20; iteration++) {
            double before = 1.0;
            p = x[i];
            for (int k = 2; k <= q; k++) {
                double next = ((2.0 * k - 1.0) * x[i] * p - (k - 1.0) * before) / k;
                before = p;
                p = next;
            }
            dp = q * (x[i] * p - before) / (x[i] * x[i] - 1.0);
            x[i] -= p / dp;
        }
        weight[i] = 2.0 / ((1.0 - x[i] * x[i]) * dp * dp);
    }
    for (int i = 0; i < q; i++) { /* differentiation of the interpolating polynomial */
        derivative[i][i] = 0.0;
        for (int j = 0; j < q; j++) {
            if (j == i)
                continue;
            derivative[i][i] += 1.0 / (x[i] - x[j]);
            derivative[i][j] = 1.0 / (x[j] - x[i]);
            for (int k = 0; k < q; k++) {
                if (k != i && k != j)
                    derivative[i][j] *= (x[i] - x[k]) / (x[j] - x[k]);
            }
        }
    }
    for (int s = 0; s < stretches; s++) {
        for (int i = 0; i < q; i++)
            z[s * q + i] = 0.5 * (bound[s] + bound[s + 1]) + 0.5 * (bound[s + 1] - bound[s]) * x[i];
    }
    for (int i = 0; i < 6; i++)
        z[total + i] = rotor.point[i].z;
    for (int i = 0; i < 2; i++) {
        z[total + 6 + 2 * i] = rotor.parallel[i].z_a;
        z[total + 7 + 2 * i] = rotor.parallel[i].z_b;
    }
    z[total + 10] = 0.55 + 1e-8 * rotor.length; /* to the right of the hinge; corrected by the curvature below */
    z[total + 11] = 0.55 + 2e-8 * rotor.length;
    frequencies(&rotor.system, 1, MODES, hz);
    for (int a = 0; a < MODES; a++) {
        assert_int_equal(oracle_shape(&rotor.system, hz[a], total + ends, z, v[a], theta[a]), ORACLE_OK);
        double right = 2.0 * theta[a][total + 10] - theta[a][total + 11];
        theta[a][total + 5] = right; /* the rotational spring on the right of the hinge */
        for (int i = 0; i < total; i++) {
            int s = i / q;
            slope[a][i] = curvature[a][i] = 0.0;
            for (int j = 0; j < q; j++) {
                slope[a][i] += derivative[i % q][j] * v[a][s * q + j] * 2.0 / (bound[s + 1] - bound[s]);
                curvature[a][i] += derivative[i % q][j] * theta[a][s * q + j] * 2.0 / (bound[s + 1] - bound[s]);
            }
        }
    }
    double kinetic[MODES][MODES], potential[MODES][MODES];
    for (int a = 0; a < MODES; a++) {
        for (int b = 0; b < MODES; b++) {
            double t = 0.0, u = 0.0, end = 0.0;
            int segment = 0;
            for (int i = 0; i < total; i++) {
                const struct oracle_segment *g;
                double w = 0.5 * weight[i % q] * (bound[i / q + 1] - bound[i / q]);
                for (segment = 0, end = rotor.segment[0].length; z[i] > end; end += rotor.segment[++segment].length)
                    continue;
                g = &rotor.segment[segment];
                t += w * (g->mass * v[a][i] * v[b][i] + g->inertia * theta[a][i] * theta[b][i]);
                u += w * (g->bending * curvature[a][i] * curvature[b][i] + g->axial * slope[a][i] * slope[b][i] +
                          g->shear * (slope[a][i] + theta[a][i]) * (slope[b][i] + theta[b][i]));
            }
            for (int i = 0; i < 6; i++) {
                const struct oracle_point *p = &rotor.point[i];
                int at = total + i;
                t += p->mass * v[a][at] * v[b][at] + p->inertia * theta[a][at] * theta[b][at];
                u += p->spring * v[a][at] * v[b][at] + p->rotational_spring * theta[a][at] * theta[b][at];
            }
            u += (theta[a][total + 5] - theta[a][total + 3]) * (theta[b][total + 5] - theta[b][total + 3]) /
                 rotor.point[3].flexibility;
            for (int i = 0; i < 2; i++) {
                double left[4], right[4];
                for (int j = 0; j < 4; j++) {
                    int at = total + 6 + 2 * i + j / 2;
                    left[j] = j % 2 ? theta[a][at] : v[a][at];
                    right[j] = j % 2 ? theta[b][at] : v[b][at];
                }
                for (int j = 0; j < 16; j++) {
                    t += rotor.parallel[i].mass[j] * left[j / 4] * right[j % 4];
                    u += rotor.parallel[i].stiffness[j] * left[j / 4] * right[j % 4];
                }
            }
            kinetic[a][b] = t;
            potential[a][b] = u;
        }
    }
    for (int a = 0; a < MODES; a++) {
        double omega = 2.0 * pi * hz[a];
        CLOSE(potential[a][a] / kinetic[a][a], omega * omega, 1e-10);
        for (int b = 0; b < a; b++)
            NEAR(kinetic[a][b] / sqrt(kinetic[a][a] * kinetic[b][b]), 0.0, 1e-10);
    }
}

/* ---- Tie members ---- */

static double form(const double matrix[16], const double left[4], const double right[4])
{
    double sum = 0.0;

    for (int i = 0; i < 16; i++)
        sum += matrix[i] * left[i / 4] * right[i % 4];
    return sum;
}

/* Rigid motions store no elastic energy, F L theta^2 of geometric energy, and have the mass and inertia of the body. Pure
 * bending, theta = -z/R + const and v' = -theta, stores EI L/R^2. */
UNIT_TEST(tie_members)
{
    struct oracle_tie tie = {12, 0.032, 0.13364, 0.924192, 2.1e11, 0.3, 7850.0, 150e3}, slack = tie, bad = tie;
    double area = 12.0 * pi / 4.0 * 0.032 * 0.032, l = tie.length, e = tie.pitch_radius, force = 12.0 * 150e3;
    double own = 12.0 * pi / 64.0 * pow(0.032, 4.0), mass = 7850.0 * area * l;
    double lift[4] = {1.0, 0.0, 1.0, 0.0}, turn[4] = {l / 2.0, 1.0, -l / 2.0, 1.0}, bend[4] = {0.0, -0.5 * l, 0.0, 0.5 * l};

    slack.tension = 0.0;
    for (int tube = 0; tube < 2; tube++) {
        double k[16], m[16], elastic[16], ignored[16];
        assert_int_equal((tube ? oracle_tie_tube : oracle_tie_rods)(&tie, k, m), ORACLE_OK);
        assert_int_equal((tube ? oracle_tie_tube : oracle_tie_rods)(&slack, elastic, ignored), ORACLE_OK);
        NEAR(form(elastic, lift, lift), 0.0, 1e-12 * k[0]);
        NEAR(form(elastic, turn, turn), 0.0, 1e-12 * k[5]);
        NEAR(form(k, lift, lift), 0.0, 1e-12 * k[0]);
        NEAR(form(k, lift, turn), 0.0, 1e-12 * k[0] * l);
        CLOSE(form(k, turn, turn), force * l, 1e-10);
        CLOSE(form(m, lift, lift), mass, 1e-13);
        NEAR(form(m, lift, turn), 0.0, 1e-13 * mass * l);
        /* The rods keep e about the middle: their axial motion y theta has the inertia rho S L e^2/2, the same as the tube's
         * rotary. */
        CLOSE(form(m, turn, turn), mass * l * l / 12.0 + 7850.0 * l * (own + area * e * e / 2.0), 1e-12);
        CLOSE(form(elastic, bend, bend), 2.1e11 * (own + area * e * e / 2.0) * l, 1e-10);
        /* Sway, v across the length without rotation: the tube's wall in shear, or just twelve thin rods. */
        double sway[4] = {0.0, 0.0, 1.0, 0.0}, inertia = tube ? own + area * e * e / 2.0 : own;
        double outer2 = 8.0 * inertia / area + 2.0 * area / pi, inner2 = 8.0 * inertia / area - 2.0 * area / pi;
        double kappa = tube ? oracle_cowper(0.3, sqrt(inner2 / outer2)) : 6.0 * 1.3 / (7.0 + 1.8);
        double flexibility = l * l * l / (12.0 * 2.1e11 * inertia) + l / (kappa * 2.1e11 / 2.6 * area);
        CLOSE(form(elastic, sway, sway), 1.0 / flexibility, 1e-11);
        if (tube) {
            CLOSE(pi / 4.0 * (outer2 - inner2), area, 1e-13);
            CLOSE(pi / 64.0 * (outer2 * outer2 - inner2 * inner2), inertia, 1e-13);
        }
    }
    CLOSE(oracle_cowper(0.3, 1.0), 2.0 * 1.3 / (4.0 + 3.0 * 0.3), 1e-15); /* thin tube: (2 + 2 nu)/(4 + 3 nu) */
    bad.pitch_radius = 0.01;
    double k[16], m[16];
    assert_int_equal(oracle_tie_tube(&bad, k, m), ORACLE_ERROR_ARGUMENT); /* no annulus */
    assert_int_equal(oracle_tie_rods(&bad, k, m), ORACLE_OK);
}

/* Pinned light beam with heavy inertias at its ends and a spring k between the two rotations: in the symmetric mode both
 * stiffnesses act on the relative rotation, omega^2 = 2 (EI/L + k)/Id; in the other k does nothing, omega^2 = 6 EI/((1 + phi)
 * L)/Id. */
UNIT_TEST(parallel_spring_between_rotations)
{
    struct oracle_segment s = bar(0.9, 0);
    struct oracle_point points[2] = {{.z = 0.0, .spring = INFINITY, .inertia = 3.0},
                                     {.z = 0.9, .spring = INFINITY, .inertia = 3.0}};
    double k = 1.7 * s.bending / s.length, phi = 12.0 * s.bending / (s.shear * s.length * s.length), hz[2];
    struct oracle_parallel between = {.z_a = 0.0, .z_b = 0.9, .stiffness = {[5] = k, [7] = -k, [13] = -k, [15] = k}};
    struct oracle_system system = {1, &s, 2, points, 1, &between};

    s.mass *= 1e-13;
    s.inertia *= 1e-13;
    frequencies(&system, 1, 2, hz);
    CLOSE(hz[0], sqrt(2.0 * (s.bending / s.length + k) / 3.0) / (2.0 * pi), 1e-11);
    CLOSE(hz[1], sqrt(6.0 * s.bending / s.length / (1.0 + phi) / 3.0) / (2.0 * pi), 1e-11);
}

/* ---- Misuse ---- */

UNIT_TEST(bad_arguments)
{
    struct oracle_segment s = bar(2.0, 0), wrong = s;
    struct oracle_point point = {.z = 2.5, .mass = 1.0};
    struct oracle_system system = {.segments = 1, .segment = &s};
    double hz[1], z[1] = {3.0}, v[1];
    int count;

    assert_int_equal(oracle_count(NULL, 1.0, &count), ORACLE_ERROR_ARGUMENT);
    assert_int_equal(oracle_count(&system, 0.0, &count), ORACLE_ERROR_ARGUMENT);
    assert_int_equal(oracle_count(&system, NAN, &count), ORACLE_ERROR_ARGUMENT);
    assert_int_equal(oracle_count(&system, 1e12, &count), ORACLE_ERROR_RANGE);
    assert_int_equal(oracle_frequencies(&system, 0, 1, hz), ORACLE_ERROR_ARGUMENT);
    assert_int_equal(oracle_shape(&system, 100.0, 1, z, v, NULL), ORACLE_ERROR_ARGUMENT);
    system.points = 1;
    system.point = &point;
    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_ERROR_ARGUMENT); /* outside */
    point = (struct oracle_point){.z = 2.0, .flexibility = 1e-9};
    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_ERROR_ARGUMENT); /* a hinge with nothing behind it */
    point = (struct oracle_point){.z = 1.0, .mass = -1.0};
    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_ERROR_ARGUMENT);
    point = (struct oracle_point){.z = 1.0, .spring = -1e6};
    assert_int_equal(oracle_frequencies(&system, 1, 1, hz), ORACLE_ERROR_UNSTABLE);
    system.points = 0;
    system.segment = &wrong;
    wrong.bending = NAN;
    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_ERROR_ARGUMENT);
    wrong = s;
    wrong.axial = -1.1 * s.shear;
    assert_int_equal(oracle_count(&system, 1.0, &count), ORACLE_ERROR_UNSTABLE);
}
