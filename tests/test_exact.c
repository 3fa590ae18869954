/* Finite elements against exact dynamic stiffness (tools/oracle): the order in which they converge, the paper's rotor with its
 * mesh error, and random rotors. What can hang on a shaft is in test_exact_ties.c. */
#include "exact.h"
#include "modal/modal.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "run/run.h"
#include "support.h"

static const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};

/* ---- order of convergence ---- */

static struct group shaft;
static struct segment bar;

/* A free steel bar, 1 m long. */
static struct rotor uniform(double diameter, int elements)
{
    shaft = (struct group){.layer_of = -1, .name = "shaft", .material = steel};
    bar = (struct segment){.elements = elements, .length = 1, .outer = diameter, .stiff_outer = diameter};
    return (struct rotor){.ngroup = 1, .group = &shaft, .nsegment = 1, .segment = &bar};
}

/* phi = 12 EI/(kGS h^2) of the elements when each is cut into `refine` */
static double element_phi(int refine)
{
    double h = bar.length / bar.elements / refine, r2 = bar.outer * bar.outer / 16, e_over_g = 2 * (1 + steel.nu);
    return 12 * e_over_g * r2 / (oracle_cowper(steel.nu, 0) * h * h);
}

/* error[l][k]: of mode k where elements are cut into 2^l, relative; order[l][k]: log2 error[l]/error[l + 1] */
static void converge(const struct rotor *rotor, int levels, double error[][EXACT_MODES], double order[][EXACT_MODES])
{
    struct exact exact;
    double truth[EXACT_MODES], hz[EXACT_MODES];
    exact_open(rotor, &exact);
    exact_hz(&exact, 3, EXACT_MODES, truth);
    for (int level = 0; level < levels; level++) {
        mesh_hz(rotor, 1 << level, 2, EXACT_MODES, hz);
        for (int k = 0; k < EXACT_MODES; k++) {
            error[level][k] = hz[k] / truth[k] - 1;
            assert_true(error[level][k] > 0); /* deflection and rotation are admissible functions: Ritz converges from above */
            if (level > 0)
                order[level - 1][k] = log2(error[level - 1][k] / error[level][k]);
        }
    }
}

/* 64, 128, 256 elements. Shear carries the error: an element has one shear angle, so the order is 2. */
UNIT_TEST(thick_bar_converges_with_order_two)
{
    struct rotor rotor = uniform(0.3, 64);
    double error[3][EXACT_MODES], order[2][EXACT_MODES];
    assert_true(element_phi(4) > element_phi(1) && element_phi(1) > 500);
    converge(&rotor, 3, error, order);
    for (int k = 0; k < EXACT_MODES; k++) {
        assert_close(order[0][k], 2, 0, 0.01);
        assert_close(order[1][k], 2, 0, 0.002);
    }
}

/* 16, 32, 64 elements. Bending carries the error, and the cubic deflection has order 4. With 8 elements the sixth mode has less
 * than three a wave; from 256 on the error nears rounding, 1e-9 of the frequency and growing. */
UNIT_TEST(slender_bar_converges_with_order_four)
{
    struct rotor rotor = uniform(0.001, 16);
    double error[3][EXACT_MODES], order[2][EXACT_MODES];
    assert_true(element_phi(4) < 0.01);
    converge(&rotor, 3, error, order);
    for (int level = 0; level < 2; level++)
        for (int k = 0; k < EXACT_MODES; k++)
            assert_true(order[level][k] > 3.85 && order[level][k] < 4);
    assert_true(error[2][0] > 1e-8);
}

/* Rounding of K leaves residuals of 1e-7 with 640 elements; frequencies must come through it. */
UNIT_TEST(fine_mesh_of_a_slender_bar_is_limited_by_rounding_alone)
{
    struct rotor rotor = uniform(0.005, 640);
    struct exact exact;
    double truth[EXACT_MODES], hz[EXACT_MODES];
    exact_open(&rotor, &exact);
    exact_hz(&exact, 3, EXACT_MODES, truth);
    mesh_hz(&rotor, 1, 2, EXACT_MODES, hz);
    assert_hz(EXACT_MODES, hz, truth, 2e-7);
}

/* A bar between the two on the way from phi = 0.014 with 8 elements to phi = 14 with 256. */
UNIT_TEST(order_falls_from_four_to_two_as_phi_passes_one)
{
    struct rotor rotor = uniform(0.01, 8);
    double error[6][EXACT_MODES], order[5][EXACT_MODES];
    assert_true(element_phi(1) < 0.02 && element_phi(32) > 10);
    converge(&rotor, 6, error, order);
    for (int k = 0; k < 3; k++) { /* higher modes have too few elements a wave at the start */
        assert_true(order[0][k] > 3.5 && order[4][k] > 2 && order[4][k] < 2.1);
        for (int level = 1; level < 5; level++)
            assert_true(order[level][k] < order[level - 1][k] - 0.1);
    }
}

/* ---- the paper's rotor ---- */

/* v = 0 ... 3: TUBE, the same self-equilibrated, RODS, the same self-equilibrated; elements in every segment, 0: its own */
static struct rotor *variant(int v, int elements)
{
    struct rotor *rotor = paper_rotor(v < 2 ? BUNDLE_TUBE : BUNDLE_RODS, v % 2);
    for (int s = 0; s < rotor->nsegment && elements; s++)
        rotor->segment[s].elements = elements;
    return rotor;
}

/* With the moduli of input/paper_rotor.inp. */
static struct rotor *identified_rotor(void)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 0);
    rotor->group[1].material.e = 1.157e11;
    rotor->group[1].material.g = 0.316e11;
    return rotor;
}

/* Expected: transfer matrices by SciPy's matrix exponential, a third implementation. */
UNIT_TEST(oracle_agrees_with_the_matrix_exponential)
{
    static const double expected[] = {416.2978321479,  794.9331931309,  1187.7662703982,
                                      1771.3895878451, 2255.2820616733, 2859.1468944284};
    struct exact exact;
    double hz[EXACT_MODES];
    exact_open(identified_rotor(), &exact);
    exact_hz(&exact, 3, EXACT_MODES, hz);
    assert_hz(EXACT_MODES, hz, expected, 1e-9);
}

UNIT_TEST(paper_rotor_keeps_its_mesh_error)
{
    for (int v = 0; v < 4; v++)
        for (int i = 0; i < 2; i++) { /* its own 175 elements; 32 in every segment, which leave longer ones in the core */
            struct rotor *rotor = variant(v, i ? 32 : 0);
            struct exact exact;
            double truth[EXACT_MODES], hz[EXACT_MODES];
            exact_open(rotor, &exact);
            exact_hz(&exact, 3, EXACT_MODES, truth);
            mesh_hz(rotor, 1, 2, EXACT_MODES, hz);
            assert_hz(EXACT_MODES, hz, truth, i ? 1e-3 : 5e-4);
            assert_true(worst_ratio(EXACT_MODES, hz, truth) > 0.8 * 4.8e-4); /* or else this is not the mesh it says */
            limit_hz(rotor, 1, 2, EXACT_MODES, hz);
            assert_hz(EXACT_MODES, hz, truth, 2e-6);
        }
}

UNIT_TEST(paper_rotor_converges_with_order_two)
{
    for (int v = 0; v < 4; v++) {
        double error[3][EXACT_MODES], order[2][EXACT_MODES];
        converge(variant(v, 0), 3, error, order);
        for (int k = 0; k < EXACT_MODES; k++) {
            assert_close(order[0][k], 2, 0, 0.005);
            assert_close(order[1][k], 2, 0, 0.001);
        }
    }
}

/* The rods press on the core with 1.8 MN: 1e-4 to 1.5e-3 of the frequencies, more than the mesh error in the first modes. */
UNIT_TEST(compression_by_the_rods_lowers_frequencies_as_it_should)
{
    for (int v = 0; v < 4; v += 2) {
        double without[EXACT_MODES], with[EXACT_MODES], truth_without[EXACT_MODES], truth_with[EXACT_MODES];
        struct exact exact;
        exact_open(variant(v, 0), &exact);
        exact_hz(&exact, 3, EXACT_MODES, truth_without);
        mesh_hz(variant(v, 0), 1, 2, EXACT_MODES, without);
        exact_open(variant(v + 1, 0), &exact);
        exact_hz(&exact, 3, EXACT_MODES, truth_with);
        mesh_hz(variant(v + 1, 0), 1, 2, EXACT_MODES, with);
        for (int k = 0; k < EXACT_MODES; k++) {
            double expected = truth_with[k] / truth_without[k] - 1;
            assert_true(expected < -1e-4);
            assert_close(with[k] / without[k] - 1, expected, 0.01, 0); /* the mesh error of both cancels */
        }
    }
}

UNIT_TEST(stated_mesh_error_is_the_true_one)
{
    for (int v = -1; v < 4; v++) {
        const struct rotor *rotor = v < 0 ? identified_rotor() : variant(v, 0);
        struct pool pool;
        struct spectrum spectrum;
        struct exact exact;
        double truth[EXACT_MODES];
        exact_open(rotor, &exact);
        exact_hz(&exact, 3, EXACT_MODES, truth);
        pool_open(&pool, NULL);
        assert_status(spectrum_compute(&pool, NULL, rotor, 0, NULL, NULL, ROTID_GUYAN, EXACT_MODES, &spectrum), ROTID_OK);
        assert_int_equal(spectrum.nrigid, 2);
        for (int k = 0; k < EXACT_MODES; k++) {
            double error = 100 * (spectrum.full_hz[k] / truth[k] - 1);
            assert_close(spectrum.mesh_error_percent[k], error, 0.002, 0);
        }
        pool_close(&pool);
    }
}

/* Deflection and rotation have one factor, so that the sign of theta = -dv/dz is compared as well. */
static void check_shape(const struct prediction *p, int pair, const struct exact *exact, double hz, const double *z)
{
    double deflection[PAPER_SENSORS], rotation[PAPER_SENSORS], mac;
    double exact_deflection[PAPER_SENSORS], exact_rotation[PAPER_SENSORS];
    assert_int_equal(oracle_shape(&exact->system, hz, PAPER_SENSORS, z, exact_deflection, exact_rotation), ORACLE_OK);
    for (int i = 0; i < PAPER_SENSORS; i++) {
        deflection[i] = prediction_at_sensor(p, pair, i);
        rotation[i] = p->phi[(ptrdiff_t)pair * p->size + p->model->master[i] + 1];
    }
    double scale = best_scale(PAPER_SENSORS, deflection, exact_deflection, &mac);
    for (int i = 0; i < PAPER_SENSORS; i++) {
        deflection[i] *= scale;
        rotation[i] *= scale;
    }
    assert_close(mac, 1, 0, 1e-6);
    assert_close(relative_difference(PAPER_SENSORS, deflection, exact_deflection), 0, 0, 1e-3);
    assert_close(relative_difference(PAPER_SENSORS, rotation, exact_rotation), 0, 0, 1e-3);
}

UNIT_TEST(paper_rotor_has_the_exact_shapes)
{
    for (int v = 0; v < 4; v++) {
        const struct rotor *rotor = variant(v, 0);
        struct pool pool;
        struct rotor_model client;
        struct prediction p;
        struct exact exact;
        double hz[EXACT_MODES], z[PAPER_SENSORS];
        int failed;
        exact_open(rotor, &exact);
        exact_hz(&exact, 3, EXACT_MODES, hz);
        pool_open(&pool, NULL);
        assert_status(model_open(&pool, NULL, rotor, 0, NULL, 1, &client, &failed), ROTID_OK);
        assert_status(prediction_new(&pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, 2 + EXACT_MODES, 0, &p),
                      ROTID_OK);
        assert_status(prediction_compute(&p, NULL), ROTID_OK);
        assert_int_equal(client.equations.nmaster, PAPER_SENSORS);
        for (int i = 0; i < PAPER_SENSORS; i++)
            z[i] = rotor->sensor[i].position;
        for (int k = 0; k < EXACT_MODES; k++)
            check_shape(&p, 2 + k, &exact, hz[k], z);
        pool_close(&pool);
    }
}

/* ---- random rotors ---- */

#define RANDOM_ROTORS   20
#define RANDOM_ELEMENTS 40 /* in every segment; two Richardson meshes are then within 4e-7 of the truth */

struct random_rotor {
    struct rotor rotor; /* points into this struct */
    struct group group[3];
    struct segment segment[7];
    struct tierod rod;
    struct disk disk[3];
    struct spring spring[3];
};

static double between(struct random_stream *stream, double from, double to)
{
    return from + (to - from) * random_uniform(stream);
}

static int below(struct random_stream *stream, int count)
{
    return (int)(count * random_uniform(stream));
}

/* An end, a node, or a place inside an element; not within 1 % of its nodes, which the mesh would take instead. */
static double random_position(struct random_stream *stream, const struct rotor *rotor)
{
    int which = below(stream, 8), segment = below(stream, rotor->nsegment);
    double z = 0, element = below(stream, RANDOM_ELEMENTS) + (which < 4 ? 0 : between(stream, 0.05, 0.95));
    for (int s = 0; s < segment; s++)
        z += rotor->segment[s].length;
    return which < 2 ? which * rotor_length(rotor) : z + rotor->segment[segment].length * element / RANDOM_ELEMENTS;
}

static struct material random_material(struct random_stream *stream)
{
    double e = 0.6e11 * pow(2.1 / 0.6, random_uniform(stream)), nu = 0.3 + 0.03 * random_normal(stream);
    struct material material = {
        .name = "metal", .e = e, .g = e * between(stream, 0.2, 0.45), .nu = nu, .rho = between(stream, 2700, 8000)};
    material.isotropic = random_uniform(stream) < 0.5;
    return material;
}

static struct segment random_segment(struct random_stream *stream, int group, int perforated)
{
    double outer = between(stream, 0.08, 0.35), kind = random_uniform(stream);
    struct segment segment = {.group = group, .elements = RANDOM_ELEMENTS, .length = between(stream, 0.08, 0.4)};
    if (kind < 0.2 && !perforated) {
        segment.rectangular = 1;
        segment.height = outer;
        segment.width = between(stream, 0.05, 0.3);
        return segment;
    }
    segment.outer = outer;
    segment.inner = kind < 0.6 && !perforated ? outer * between(stream, 0.2, 0.7) : 0;
    segment.stiff_outer = outer * (random_uniform(stream) < 0.3 ? between(stream, 0.8, 1) : 1);
    return segment;
}

static void attach(struct random_stream *stream, int index, struct random_rotor *r)
{
    struct rotor *rotor = &r->rotor;
    for (int i = rotor->ndisk = below(stream, 4); i-- > 0;) {
        double mass = between(stream, 2, 60);
        r->disk[i] = (struct disk){"disk", random_position(stream, rotor), mass, mass * between(stream, 0, 0.03), 0, 0, 0};
    }
    for (int i = rotor->nspring = below(stream, 4); i-- > 0;)
        r->spring[i] = (struct spring){
            "spring", random_position(stream, rotor), pow(10, between(stream, 3, 9)), i ? pow(10, between(stream, 3, 7)) : 0, 0,
            0};
    double a = random_position(stream, rotor), b = random_position(stream, rotor);
    struct material material = random_material(stream);
    material.isotropic = 1; /* of the oracle's builders */
    rotor->ntierod = fabs(a - b) > 0.1;
    r->rod = (struct tierod){.name = "rods",
                             .material = material,
                             .from = fmin(a, b),
                             .to = fmax(a, b),
                             .model = index % 2 ? BUNDLE_RODS : BUNDLE_TUBE,
                             .self_equilibrated = index / 2 % 2,
                             .number = 3 + below(stream, 12),
                             .elements = 1,
                             .diameter = between(stream, 0.01, 0.035),
                             .pitch = between(stream, 0.08, 0.15),
                             .tension = between(stream, 0, 1e5)};
}

static void random_rotor(struct random_stream *stream, int index, struct random_rotor *r)
{
    *r = (struct random_rotor){0};
    int perforated = index % 3 == 0;
    r->rotor = (struct rotor){.ngroup = 3,
                              .group = r->group,
                              .nsegment = 3 + below(stream, 5),
                              .segment = r->segment,
                              .tierod = &r->rod,
                              .disk = r->disk,
                              .spring = r->spring};
    for (int g = 0; g < 3; g++) /* tension only: a compressed free rotor has no stable equilibrium */
        r->group[g] = (struct group){.layer_of = -1,
                                     .name = "group",
                                     .material = random_material(stream),
                                     .preload = random_uniform(stream) < 0.3 ? between(stream, 0, 2e6) : 0};
    for (int s = 0; s < r->rotor.nsegment; s++) {
        int group = 3 * s / r->rotor.nsegment;
        r->segment[s] = random_segment(stream, group, perforated && group == 1);
    }
    if (perforated) { /* the thinnest shaft has a stiffness radius of 0.032 m */
        r->group[1].holes = 3 + below(stream, 6);
        r->group[1].hole_diameter = between(stream, 0.004, 0.012);
        r->group[1].hole_pitch = between(stream, 0.018, 0.025);
    }
    attach(stream, index, r);
}

UNIT_TEST(random_rotors_converge_to_the_truth)
{
    struct random_stream stream = {20170521};
    int bundles[2] = {0, 0};
    for (int index = 0; index < RANDOM_ROTORS; index++) {
        struct random_rotor r;
        struct exact exact;
        double truth[EXACT_MODES], limit[EXACT_MODES];
        char name[40];
        random_rotor(&stream, index, &r);
        exact_open(&r.rotor, &exact);
        exact_hz(&exact, 3, EXACT_MODES, truth);
        limit_hz(&r.rotor, 1, 2, EXACT_MODES, limit);
        snprintf(name, sizeof name, "random rotor %d", index);
        assert_hz_at(EXACT_MODES, limit, truth, 1e-6, name, __FILE__, __LINE__);
        bundles[r.rod.model] += r.rotor.ntierod;
    }
    assert_true(bundles[BUNDLE_RODS] >= 5 && bundles[BUNDLE_TUBE] >= 5); /* a seed that draws no rods would show little */
}
