/* Modes and buckling of uniform beams against closed forms, and the order in which the elements converge to them. */
#include <float.h>

#include "beam/beam.h"
#include "linalg/linalg.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

static struct group shaft;
static struct segment segment;
static struct spring springs[2];
static struct disk disk;

/* A round bar; without = 1 has no shear flexibility. Add springs and the disk by their counts. */
static struct rotor bar(double length, double diameter, int elements, int without)
{
    struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};
    if (without) {
        steel.isotropic = 0;
        steel.g = 1e6 * steel.e;
    }
    shaft = (struct group){.layer_of = -1, .name = "shaft", .material = steel};
    segment = (struct segment){0, elements, 0, length, diameter, 0, diameter, 0, 0};
    springs[0] = (struct spring){"left", 0, 0, 0, 0, 0};
    springs[1] = (struct spring){"right", length, 0, 0, 0, 0};
    disk = (struct disk){"tip", length, 0, 0, 0, 0, 0};
    return (struct rotor){.ngroup = 1, .group = &shaft, .nsegment = 1, .segment = &segment, .spring = springs, .disk = &disk};
}

/* The continuous quantities of the same bar; length that of the whole. */
static struct element properties(const struct rotor *rotor)
{
    double d = segment.outer, area = pi * d * d / 4, inertia = area * d * d / 16;
    const struct material *m = &rotor->group[0].material;
    return (struct element){m->e * inertia, rotid_shear_coefficient_annulus(m->nu, 0) * material_shear_modulus(m) * area,
                            m->rho * area,  m->rho * inertia,
                            shaft.preload,  segment.length};
}

static void assemble(const struct rotor *rotor, struct beam *beam, rotid_matrix *k, rotid_matrix *m)
{
    int failed;
    assert_status(beam_build(&test_pool, rotor, 0, NULL, 1, beam, &failed), ROTID_OK);
    const struct mesh *mesh = &beam->mesh;
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, k), ROTID_OK);
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, m), ROTID_OK);
    beam_assemble(beam, NULL, k, m);
}

static void eigenvalues(const struct rotor *rotor, int count, double *lambda)
{
    struct beam beam;
    struct eigen_band eigen;
    rotid_matrix k, m;
    assemble(rotor, &beam, &k, &m);
    double *phi = POOL_ARRAY(&test_pool, double, count *k.n);
    assert_status(eigen_band_new(&test_pool, &k, count, &eigen), ROTID_OK);
    assert_status(eigen_band_solve(&eigen, &k, &m, lambda, phi), ROTID_OK);
}

/* Pinned at both ends: the deflections there are taken out, which no spring does exactly. */
static void pinned_eigenvalues(const struct rotor *rotor, int count, double *lambda)
{
    struct beam beam;
    struct eigen_dense eigen;
    rotid_matrix k, m;
    assemble(rotor, &beam, &k, &m);
    int n = k.n, kept = n - 2;
    double *unit = POOL_ARRAY(&test_pool, double, n), *column = POOL_ARRAY(&test_pool, double, n),
           *phi = POOL_ARRAY(&test_pool, double, kept *count);
    double *dense[2] = {POOL_ARRAY(&test_pool, double, kept *kept), POOL_ARRAY(&test_pool, double, kept *kept)};
    for (int j = 1, c = 0; j < n; j++) {
        if (j == n - 2)
            continue;
        for (int a = 0; a < 2; a++) {
            unit[j] = 1;
            matrix_multiply(a ? &m : &k, 1, unit, column);
            unit[j] = 0;
            for (int i = 1, r = 0; i < n; i++)
                if (i != n - 2)
                    dense[a][r++ + c * kept] = column[i];
        }
        c++;
    }
    assert_status(eigen_dense_new(&test_pool, kept, count, &eigen), ROTID_OK);
    assert_status(eigen_dense_solve(&eigen, dense[0], dense[1], lambda, phi), ROTID_OK);
}

typedef double equation(double x, double a);

static double root(equation *f, double a, double low, double high)
{
    double sign = f(low, a);
    assert_true(sign * f(high, a) < 0);
    for (int i = 0; i < 100; i++) {
        double middle = (low + high) / 2;
        if (sign * f(middle, a) > 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* cos x cosh x = a divided by cosh x: a = 1 free at both ends, a = -1 fixed at one */
static double free_or_fixed(double x, double a)
{
    return cos(x) - a / cosh(x);
}

/* fixed at one end, with a mass of a times the beam's at the other */
static double with_tip_mass(double x, double a)
{
    return 1 / cosh(x) + cos(x) + a * x * (cos(x) * tanh(x) - sin(x));
}

static void assert_wave_numbers(const struct rotor *rotor, const double *lambda, int count, equation *f, double a,
                                const double *bracket, double tolerance)
{
    struct element e = properties(rotor);
    for (int k = 0; k < count; k++) {
        double x = root(f, a, bracket[k], bracket[k + 1]) / e.length;
        assert_close(lambda[k], x * x * x * x * e.ei / e.rhos, tolerance, 0);
    }
}

POOL_TEST(slender_free_beam_has_the_euler_bernoulli_frequencies)
{
    struct rotor rotor = bar(10, 1e-3, 60, 1);
    double lambda[6];
    eigenvalues(&rotor, 6, lambda);
    assert_wave_numbers(&rotor, lambda + 2, 4, free_or_fixed, 1, (double[]){pi, 2 * pi, 3 * pi, 4 * pi, 5 * pi}, 1e-5);
    for (int j = 0; j < 2; j++)
        assert_close(lambda[j], 0, 0, 1e-9 * lambda[2]);
}

POOL_TEST(slender_cantilever_on_stiff_springs_has_the_euler_bernoulli_frequencies)
{
    struct rotor rotor = bar(10, 1e-3, 60, 1);
    struct element e = properties(&rotor);
    rotor.nspring = 1;
    springs[0].lateral = 1e8 * e.ei / 1e3;
    springs[0].rotational = 1e7 * e.ei / 10;
    double lambda[4];
    eigenvalues(&rotor, 4, lambda);
    assert_wave_numbers(&rotor, lambda, 4, free_or_fixed, -1, (double[]){1, pi, 2 * pi, 3 * pi, 4 * pi}, 1e-5);
}

POOL_TEST(cantilever_with_a_tip_mass_follows_its_frequency_equation)
{
    struct rotor rotor = bar(10, 1e-3, 60, 1);
    struct element e = properties(&rotor);
    rotor.nspring = rotor.ndisk = 1;
    springs[0].lateral = 1e8 * e.ei / 1e3;
    springs[0].rotational = 1e7 * e.ei / 10;
    for (double ratio = 0.1; ratio < 20; ratio *= 5) {
        double lambda[3];
        disk.mass = ratio * e.rhos * e.length;
        eigenvalues(&rotor, 3, lambda);
        assert_wave_numbers(&rotor, lambda, 3, with_tip_mass, ratio, (double[]){0.1, 3.2, 6.4, 9.6}, 1e-5);
    }
}

POOL_TEST(slender_pinned_beam_has_the_euler_bernoulli_frequencies)
{
    struct rotor rotor = bar(10, 1e-3, 40, 1);
    struct element e = properties(&rotor);
    double lambda[5];
    pinned_eigenvalues(&rotor, 5, lambda);
    for (int k = 0; k < 5; k++)
        assert_close(lambda[k], pow((k + 1) * pi / e.length, 4) * e.ei / e.rhos, 1e-4, 0);
}

POOL_TEST(stiff_springs_approach_the_pinned_beam)
{
    struct rotor rotor = bar(1, 0.05, 24, 0);
    double pinned[3], sprung[3];
    pinned_eigenvalues(&rotor, 3, pinned);
    rotor.nspring = 2;
    springs[0].lateral = springs[1].lateral = 1e6 * properties(&rotor).ei;
    eigenvalues(&rotor, 3, sprung);
    for (int k = 0; k < 3; k++) {
        assert_true(sprung[k] < pinned[k]); /* a support that gives can only lower a frequency */
        assert_close(sprung[k], pinned[k], 1e-3, 0);
    }
}

/* A stubby bar a hundred times stiffer than steel: it translates with 2k/m and turns with k L^2/2 + 2 k_rot over its inertia. */
POOL_TEST(rigid_bar_on_soft_springs_translates_and_turns)
{
    struct rotor rotor = bar(1, 0.5, 4, 0);
    shaft.material.e *= 100;
    struct element e = properties(&rotor);
    rotor.nspring = rotor.ndisk = 2;
    struct disk ends[2] = {{"a", 0, 30, 4, 0, 0, 0}, {"b", 1, 30, 4, 0, 0, 0}};
    rotor.disk = ends;
    springs[0].lateral = springs[1].lateral = 5e4;
    springs[0].rotational = springs[1].rotational = 2e3;
    double lambda[3], mass = e.rhos + 60, inertia = e.rhos / 12 + e.rhoi + 2 * (30 * 0.25 + 4);
    eigenvalues(&rotor, 3, lambda);
    double rounding =
        16 * DBL_EPSILON * e.kgs / e.rhoi; /* of the highest modes, where sections turn against the shear stiffness */
    assert_close(lambda[0], 1e5 / mass, 1e-6, rounding);
    assert_close(lambda[1], (5e4 * 2 * 0.25 + 4e3) / inertia, 1e-6, rounding);
}

/* v = sin(n pi z/L), theta = B cos(n pi z/L) solve the pinned Timoshenko beam with an axial force:
 * (kGS q^2 + F q^2 - lambda rhoS)(EI q^2 + kGS - lambda rhoI) = (kGS q)^2, q = n pi/L; the lower root is the bending mode. */
static double timoshenko_pinned(const struct element *e, int n)
{
    double q = n * pi / e->length, v = (e->kgs + e->force) * q * q, t = e->ei * q * q + e->kgs, coupling = e->kgs * q;
    double a = e->rhos * e->rhoi, b = v * e->rhoi + t * e->rhos, c = v * t - coupling * coupling;
    return 2 * c / (b + sqrt(b * b - 4 * a * c));
}

POOL_TEST(thick_pinned_beam_has_the_timoshenko_frequencies_with_and_without_tension)
{
    const double force[] = {0, 4e7, -4e7};
    for (int f = 0; f < 3; f++) {
        struct rotor rotor = bar(1, 0.2, 60, 0);
        shaft.preload = force[f];
        struct element e = properties(&rotor);
        double lambda[4];
        pinned_eigenvalues(&rotor, 4, lambda);
        for (int k = 0; k < 4; k++)
            assert_close(lambda[k], timoshenko_pinned(&e, k + 1), 2e-3, 0);
        struct element slender = e;
        slender.force = 0;
        if (f) /* the force is large enough to be seen */
            assert_true(fabs(timoshenko_pinned(&e, 1) / timoshenko_pinned(&slender, 1) - 1) > 0.05);
    }
}

/* Relative error of an eigenvalue on a mesh. The elements are conforming, so it is positive. */
static double error_of(double diameter, int elements, int mode)
{
    double lambda[3];
    struct rotor rotor = bar(1, diameter, elements, 0);
    struct element e = properties(&rotor);
    pinned_eigenvalues(&rotor, 3, lambda);
    double error = lambda[mode] / timoshenko_pinned(&e, mode + 1) - 1;
    assert_true(error > 0);
    return error;
}

POOL_TEST(order_of_convergence_is_two_for_thick_elements_and_rises_to_four_for_slender_ones)
{
    const double diameter[] = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
    double order[6];
    for (int i = 0; i < 6; i++) {
        double coarse = error_of(diameter[i], 12, 1), fine = error_of(diameter[i], 24, 1);
        struct rotor rotor = bar(1, diameter[i], 24, 0);
        struct element e = properties(&rotor);
        order[i] = log2(coarse / fine);
        print_message("diameter/length %.3f: element phi %.2e, errors %.2e %.2e, order %.3f\n", diameter[i],
                      12 * e.ei / (e.kgs / 576), coarse, fine, order[i]);
        if (i)
            assert_true(order[i] > order[i - 1]);
    }
    assert_close(order[0], 2, 0, 0.03);
    assert_close(order[5], 4, 0, 0.05);
}

POOL_TEST(rotor_like_mesh_converges_with_order_two_at_every_level)
{
    double last = error_of(0.3, 8, 2);
    for (int elements = 16; elements <= 64; elements *= 2) {
        double error = error_of(0.3, elements, 2);
        assert_close(log2(last / error), 2, 0, 0.1);
        last = error;
    }
}

/* Compression at which the pinned bar's stiffness loses its definiteness, by bisection. */
static double critical_load(struct rotor *rotor)
{
    struct beam beam;
    struct factor factor;
    rotid_matrix k, m;
    assemble(rotor, &beam, &k, &m);
    int *kept = POOL_ARRAY(&test_pool, int, k.n), count = 0;
    for (int i = 1; i < k.n; i++)
        if (i != k.n - 2)
            kept[count++] = i;
    assert_status(factor_new(&test_pool, FACTOR_CHOLESKY, &k, count, kept, &factor), ROTID_OK);
    struct element e = properties(rotor);
    double low = 0, high = 4 * pi * pi * e.ei / (e.length * e.length);
    for (int i = 0; i < 50; i++) {
        beam.rotor.group[0].preload = -(low + high) / 2;
        matrix_zero(&k);
        matrix_zero(&m);
        beam_assemble(&beam, NULL, &k, &m);
        if (factor_compute(&factor, &k))
            high = (low + high) / 2;
        else
            low = (low + high) / 2;
    }
    return low;
}

POOL_TEST(pinned_column_buckles_at_engessers_load)
{
    const double diameter[] = {0.02, 0.1, 0.2, 0.4, 0.8};
    for (int i = 0; i < 5; i++) {
        struct rotor coarse = bar(1, diameter[i], 20, 0);
        double on_coarse = critical_load(&coarse);
        struct rotor fine = bar(1, diameter[i], 40, 0);
        struct element e = properties(&fine);
        double euler = pi * pi * e.ei, engesser = euler / (1 + euler / e.kgs), on_fine = critical_load(&fine);
        print_message("Pe/kGS %.4f: critical load over Engesser's %.7f on 20, %.7f on 40 elements\n", euler / e.kgs,
                      on_coarse / engesser, on_fine / engesser);
        assert_close(on_fine, engesser, 1e-3, 0);
        assert_true(on_coarse > on_fine && on_fine > engesser * (1 - 1e-9));
    }
}
