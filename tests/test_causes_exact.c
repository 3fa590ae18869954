/* Physical causes of the catalogue in the finite elements against exact dynamic stiffness, where each effect is worked out from
 * its definition with no help of librotid. Geometry, bounds and where a cause applies: test_causes.c. */
#include "effect_bench.h"
#include "exact.h"
#include "support.h"

#define MOST_PIECES 1024

/* ---- the truth ---- */

struct change { /* factors at one place */
    double bending, shear, mass;
};

typedef struct change change_at(const struct rotor *rotor, const double *value, int segment, double z);

static int segment_at(const struct rotor *rotor, double z)
{
    int s = 0;
    for (double end = rotor->segment[0].length; end < z && s + 1 < rotor->nsegment; end += rotor->segment[s].length)
        s++;
    return s;
}

/* The exact system, every stretch cut into pieces of constant properties, about `length` long. */
static void exact_varying(const struct rotor *rotor, double length, change_at *change, const double *value, struct exact *exact,
                          struct oracle_segment *fine)
{
    int count = 0;
    double z = 0;
    exact_open(rotor, exact);
    for (int i = 0; i < exact->system.segments; i++) {
        const struct oracle_segment *whole = &exact->segment[i];
        int pieces = (int)ceil(whole->length / length);
        for (int n = 0; n < pieces; n++) {
            double middle = z + whole->length * (n + 0.5) / pieces;
            struct change c = change(rotor, value, segment_at(rotor, middle), middle);
            assert_true(count < MOST_PIECES);
            fine[count] = *whole;
            fine[count].length /= pieces;
            fine[count].bending *= c.bending;
            fine[count].shear *= c.shear;
            fine[count].mass *= c.mass;
            fine[count++].inertia *= c.mass;
        }
        z += whole->length;
    }
    exact->system.segments = count;
    exact->system.segment = fine;
}

/* Extrapolated from this length and half of it: constant pieces leave an error of second order. */
static void truth_of(const struct rotor *rotor, double length, change_at *change, const double *value, double *hz)
{
    static struct oracle_segment fine[MOST_PIECES];
    struct exact exact;
    double coarse[EXACT_MODES];
    exact_varying(rotor, length, change, value, &exact, fine);
    exact_hz(&exact, 3, EXACT_MODES, coarse);
    exact_varying(rotor, length / 2, change, value, &exact, fine);
    exact_hz(&exact, 3, EXACT_MODES, hz);
    for (int k = 0; k < EXACT_MODES; k++)
        hz[k] += (hz[k] - coarse[k]) / 3;
}

/* Order of the largest error over two halvings of the mesh, and the error of the limit; and that the effect is no small thing. */
static void compare(const char *name, const struct rotor *rotor, const double *truth, double tolerance, double least_order)
{
    struct rotor bare = *rotor;
    struct exact exact;
    double without[EXACT_MODES], hz[3][EXACT_MODES], limit[EXACT_MODES];
    bare.neffect = 0;
    exact_open(&bare, &exact);
    exact_hz(&exact, 3, EXACT_MODES, without);
    for (int level = 0; level < 3; level++)
        mesh_hz(rotor, 1 << level, 2, EXACT_MODES, hz[level]);
    for (int k = 0; k < EXACT_MODES; k++)
        limit[k] = hz[2][k] + (hz[2][k] - hz[1][k]) / 3;
    double order = log2(worst_ratio(EXACT_MODES, hz[0], truth) / worst_ratio(EXACT_MODES, hz[2], truth)) / 2;
    double size = worst_ratio(EXACT_MODES, truth, without), error = worst_ratio(EXACT_MODES, limit, truth);
    print_message("%-28s effect %.1e, error of the limit %.1e, order %.2f\n", name, size, error, order);
    assert_true(size > 30 * tolerance);
    assert_hz_at(EXACT_MODES, limit, truth, tolerance, name, __FILE__, __LINE__);
    assert_true(order > least_order);
}

/* ---- effects along the axis ---- */

static double along(const struct rotor *rotor, int group, double z)
{
    double from, to;
    rotor_group_span(rotor, group, &from, &to);
    return (2 * z - from - to) / (to - from);
}

static struct change gradient(const struct rotor *rotor, const double *value, int segment, double z)
{
    double f = rotor->segment[segment].group == 1 ? 1 + value[0] * along(rotor, 1, z) : 1;
    return (struct change){f, f, 1};
}

static struct change profile(const struct rotor *rotor, const double *value, int segment, double z)
{
    double xi = along(rotor, 1, z), f = rotor->segment[segment].group == 1 ? 1 + value[0] * (xi * xi - 1.0 / 3) : 1;
    return (struct change){f, f, 1};
}

static struct change gaussian(const struct rotor *rotor, const double *value, int segment, double z)
{
    (void)rotor, (void)segment;
    double f = 1 - value[0] * exp(-pow((z - value[1]) / value[2], 2) / 2);
    return (struct change){f, f, 1};
}

static struct change gaussian_shear(const struct rotor *rotor, const double *value, int segment, double z)
{
    (void)rotor, (void)segment;
    double g = exp(-pow((z - value[1]) / value[2], 2) / 2);
    return (struct change){1 - value[0] * g, 1 - value[3] * g, 1};
}

static struct change heavier(const struct rotor *rotor, const double *value, int segment, double z)
{
    (void)z;
    return (struct change){1, 1, rotor->segment[segment].group == 1 ? value[0] : 1};
}

static struct change stiffer(const struct rotor *rotor, const double *value, int segment, double z)
{
    (void)z;
    double f = rotor->segment[segment].group == 1 ? value[0] : 1;
    return (struct change){f, f, 1};
}

static struct change sheared(const struct rotor *rotor, const double *value, int segment, double z)
{
    (void)z;
    return (struct change){1, rotor->segment[segment].group == 1 ? value[0] : 1, 1};
}

static struct change cone(const struct rotor *rotor, const double *value, int segment, double z)
{
    const struct segment *own = &rotor->segment[segment];
    double area, inertia, own_area, own_inertia, diameter = bench_cone_diameter(rotor, segment, z, value[0]);
    bench_section(rotor, segment, own->stiff_outer, &own_area, &own_inertia);
    bench_section(rotor, segment, diameter, &area, &inertia);
    double coefficient = rotid_shear_coefficient_annulus(0.3, own->inner / diameter) /
                         rotid_shear_coefficient_annulus(0.3, own->inner / own->stiff_outer);
    return (struct change){inertia / own_inertia, coefficient * area / own_area, 1};
}

static struct change turned(const struct rotor *rotor, const double *value, int segment, double z)
{
    double area, inertia, own_area, own_inertia, outer = rotor->segment[segment].outer;
    (void)z;
    if (rotor->segment[segment].group != 2)
        return (struct change){1, 1, 1};
    bench_section(rotor, segment, outer, &own_area, &own_inertia);
    bench_section(rotor, segment, value[0] * outer, &area, &inertia);
    return (struct change){inertia / own_inertia, area / own_area, area / own_area};
}

static const struct axis_case {
    const char *name;
    const struct cause_kind *cause;
    int target, variant;
    double piece, value[EFFECT_MOST_PARAMETERS];
    change_at *change;
    double tolerance, least_order;
} axis_cases[] = {
    {"gradient", &cause_stiffness_gradient, 1, 0, 0.01, {-0.6}, gradient, 2e-6, 1.95},
    {"profile", &cause_stiffness_profile, 1, 0, 0.01, {0.8}, profile, 2e-6, 1.95},
    {"soft zone in the core", &cause_stiffness_local, -1, 0, 0.006, {0.6, 1.1, 0.05}, gaussian, 2e-6, 1.95},
    {"soft zone over an interface", &cause_stiffness_local, -1, 0, 0.006, {0.5, 0.62, 0.08}, gaussian, 2e-6, 1.95},
    {"bending-soft zone", &cause_stiffness_local, -1, 2, 0.006, {0.6, 1.1, 0.05, 0}, gaussian_shear, 2e-6, 1.95},
    {"shear-soft zone", &cause_stiffness_local, -1, 2, 0.006, {0, 1.1, 0.05, 0.6}, gaussian_shear, 2e-6, 1.95},
    {"density", &cause_density, 1, 0, 1, {1.2}, heavier, 2e-6, 1.95},
    {"stiffness", &cause_stiffness, 1, 0, 1, {0.8}, stiffer, 2e-6, 1.95},
    {"diameter", &cause_diameter, 2, 0, 1, {1.04}, turned, 2e-6, 1.95},
    {"shear coefficient", &cause_shear_coefficient, 1, 0, 1, {0.8}, sheared, 2e-6, 1.95},
    {"cones", &cause_step_stiffness, -1, 0, 0.0042, {31}, cone, 1e-4, 1.5},
    {"flat cones", &cause_step_stiffness, -1, 0, 0.0042, {14}, cone, 2e-4, 1.2},
};

POOL_TEST(causes_along_the_axis_converge_to_the_exact_frequencies)
{
    for (size_t c = 0; c < sizeof axis_cases / sizeof *axis_cases; c++) {
        const struct axis_case *one = &axis_cases[c];
        double truth[EXACT_MODES];
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        truth_of(rotor, one->piece, one->change, one->value, truth);
        bench_add(rotor, one->cause->effect, one->target, one->variant, one->value);
        compare(one->name, rotor, truth, one->tolerance, one->least_order);
    }
}

/* The box from its edges: pieces of the axis that end there. Elements that it fills in part carry the mean compliance. */
POOL_TEST(a_box_converges_to_the_exact_frequencies)
{
    for (int shear = 0; shear < 2; shear++) {
        const double value[] = {0.5, 1.0371, 0.1234, 0.2};
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        static struct oracle_segment pieces[40];
        struct exact exact;
        double truth[EXACT_MODES], z = 0, edge[2] = {value[1] - value[2] / 2, value[1] + value[2] / 2};
        int count = 0;
        exact_open(rotor, &exact);
        for (int i = 0; i < exact.system.segments; i++) {
            double end = z + exact.segment[i].length;
            while (end - z > 1e-12) {
                double stop = z < edge[0] && edge[0] < end ? edge[0] : z < edge[1] - 1e-12 && edge[1] < end ? edge[1] : end;
                int soft = z > edge[0] - 1e-9 && stop < edge[1] + 1e-9;
                pieces[count] = exact.segment[i];
                pieces[count].length = stop - z;
                pieces[count].bending *= soft ? 1 - value[0] : 1;
                pieces[count++].shear *= soft ? 1 - value[shear ? 3 : 0] : 1;
                z = stop;
            }
        }
        exact.system.segments = count;
        exact.system.segment = pieces;
        exact_hz(&exact, 3, EXACT_MODES, truth);
        bench_add(rotor, cause_stiffness_local.effect, -1, shear ? 3 : 1, value);
        compare(shear ? "box, shear apart" : "box", rotor, truth, 2e-5, 1.5);
    }
}

/* ---- points, joints, rods ---- */

POOL_TEST(joints_converge_to_the_exact_frequencies)
{
    for (int rods = 0; rods < 2; rods++)
        for (int interface = 0; interface < 2; interface++) {
            const double flexibility[] = {4e-9};
            struct rotor *rotor = bench_rotor(BUNDLE_RODS, rods, 0);
            struct exact exact;
            double truth[EXACT_MODES], from, to;
            char name[40];
            rotor_group_span(rotor, interface, &from, &to);
            rotor->disk[0].position = to; /* feels the rotation of the outer side, as the rods do */
            rotor->disk[0].diametral = 2;
            /* outside of the rods; without them the hinge is in the element on the left, what is attached is on the right */
            int side = rods && interface == 0 ? ORACLE_LEFT : ORACLE_RIGHT;
            exact_open(rotor, &exact);
            exact.point[0].side = side;
            exact.point[exact.system.points++] = (struct oracle_point){.z = to, .flexibility = flexibility[0]};
            exact.parallel[0].side_a = interface == 0 ? side : ORACLE_LEFT;
            exact.parallel[0].side_b = interface == 1 ? side : ORACLE_LEFT;
            exact_hz(&exact, 3, EXACT_MODES, truth);
            bench_add(rotor, cause_joint.effect, interface, 0, flexibility);
            snprintf(name, sizeof name, "%s joint%s", interface ? "right" : "left", rods ? " with rods" : "");
            compare(name, rotor, truth, 2e-6, 1.95);
        }
}

/* What the side means: with the disk on the other one frequencies are others. */
POOL_TEST(the_side_of_a_joint_matters)
{
    double truth[2][EXACT_MODES], from, to;
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    rotor_group_span(rotor, 0, &from, &to);
    for (int side = 0; side < 2; side++) {
        struct exact exact;
        exact_open(rotor, &exact);
        exact.point[exact.system.points++] = (struct oracle_point){.z = to, .flexibility = 4e-9};
        exact.parallel[0].side_a = side;
        exact_hz(&exact, 3, EXACT_MODES, truth[side]);
    }
    assert_true(worst_ratio(EXACT_MODES, truth[0], truth[1]) > 1e-3);
}

/* A jump of the shear force or the moment inside an element is beyond its shapes: error of first order, if a small one. */
POOL_TEST(masses_anywhere_converge_to_the_exact_frequencies)
{
    static const double place[] = {0, 0.04, 0.256018, 0.6281, 1.0379, 1.9733};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
        const double value[] = {5, place[i], 0};
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        struct exact exact;
        double truth[EXACT_MODES];
        char name[40];
        exact_open(rotor, &exact);
        exact.point[exact.system.points++] = (struct oracle_point){.z = place[i], .mass = value[0]};
        exact_hz(&exact, 3, EXACT_MODES, truth);
        bench_add(rotor, cause_added_mass.effect, -1, 0, value);
        snprintf(name, sizeof name, "mass at %.4f", place[i]);
        compare(name, rotor, truth, 2e-5, 0.9);
    }
}

/* The same of the force of a spring: to the ground at any place, of the deck and elsewhere, softer by a clamp that gives way. */
POOL_TEST(springs_anywhere_converge_to_the_exact_frequencies)
{
    static const double place[] = {0.04, 0.256018, 0.6281, 1.0379, 1.9733};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++)
        for (int which = 0; which < 3; which++) {
            const double extra[] = {which == 1 ? 3e7 : 3e8, place[i]}, shift[] = {place[i]};
            const struct cause_kind *cause = which == 0 ? &cause_support_extra : &cause_support_rotation;
            struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
            struct exact exact;
            double truth[EXACT_MODES];
            char name[40];
            exact_open(rotor, &exact);
            if (which < 2)
                exact.point[exact.system.points++] = (struct oracle_point){
                    .z = place[i], .spring = which ? 0 : extra[0], .rotational_spring = which ? extra[0] : 0};
            for (int p = 0; p < exact.system.points && which == 2; p++)
                if (exact.point[p].spring > 0 && exact.point[p].z == 0)
                    exact.point[p].z = place[i];
            exact_hz(&exact, 3, EXACT_MODES, truth);
            bench_add(rotor, which < 2 ? cause->effect : cause_support_position.effect, which < 2 ? -1 : 0, 0,
                      which < 2 ? extra : shift);
            snprintf(name, sizeof name, "%s at %.4f", rotor->effect[0].kind->id, place[i]);
            compare(name, rotor, truth, 1e-4, 0.9);
        }
}

POOL_TEST(a_clamp_is_in_series_with_its_spring)
{
    const double compliance[] = {2e-6, 3e-9};
    double expected[EXACT_MODES], hz[EXACT_MODES];
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    bench_add(rotor, cause_clamp.effect, 0, 0, compliance);
    mesh_hz(rotor, 1, 2, EXACT_MODES, hz);
    rotor->neffect = 0;
    rotor->spring[0].rotational = 1 / (1 / rotor->spring[0].rotational + compliance[0]);
    rotor->spring[0].lateral = 1 / (1 / rotor->spring[0].lateral + compliance[1]);
    mesh_hz(rotor, 1, 2, EXACT_MODES, expected);
    assert_hz(EXACT_MODES, hz, expected, 1e-9);
}

/* Mass per length over the width, without inertia of its own. */
POOL_TEST(a_wide_mass_converges_to_mass_per_length)
{
    static struct oracle_segment cut[64];
    const double value[] = {20, 1.0379, 0.3};
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    struct exact exact;
    double truth[EXACT_MODES], z = 0;
    int count = 0;
    exact_open(rotor, &exact);
    for (int i = 0; i < exact.system.segments; i++) {
        double end = z + exact.segment[i].length,
               at[4] = {z, fmin(fmax(value[1] - 0.15, z), end), fmin(fmax(value[1] + 0.15, z), end), end};
        for (int k = 0; k < 3; k++)
            if (at[k + 1] > at[k]) {
                cut[count] = exact.segment[i];
                cut[count].length = at[k + 1] - at[k];
                cut[count++].mass += k == 1 ? value[0] / value[2] : 0;
            }
        z = end;
    }
    exact.system.segments = count;
    exact.system.segment = cut;
    exact_hz(&exact, 3, EXACT_MODES, truth);
    bench_add(rotor, cause_added_mass.effect, -1, 1, value);
    compare("wide mass", rotor, truth, 3e-5, 0.9);
}

/* A hub that is one with the shaft over all of its length is a thicker shaft without more mass. */
POOL_TEST(hubs_are_thicker_shafts)
{
    const double share[] = {1};
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    struct exact exact;
    static struct oracle_segment cut[64];
    double truth[EXACT_MODES], z = 0, from, to;
    int count = 0;
    rotor_hub_span(rotor, 0, &from, &to);
    exact_open(rotor, &exact);
    for (int i = 0, s = 0; i < exact.system.segments; i++) {
        double end = z + exact.segment[i].length, at[4] = {z, fmin(fmax(from, z), end), fmin(fmax(to, z), end), end};
        s = segment_at(rotor, (z + end) / 2);
        double o = rotor->segment[s].outer, b = rotor->segment[s].inner, h = rotor->disk[0].hub_outer;
        for (int k = 0; k < 3; k++)
            if (at[k + 1] > at[k]) {
                cut[count] = exact.segment[i];
                cut[count].length = at[k + 1] - at[k];
                cut[count].bending *= k == 1 ? (pow(h, 4) - pow(b, 4)) / (pow(o, 4) - pow(b, 4)) : 1;
                cut[count++].shear *= k == 1 ? (h * h - b * b) / (o * o - b * b) : 1;
            }
        z = end;
    }
    exact.system.segments = count;
    exact.system.segment = cut;
    exact_hz(&exact, 3, EXACT_MODES, truth);
    bench_add(rotor, cause_hub_stiffness.effect, -1, 0, share);
    compare("hub", rotor, truth, 2e-5, 1.5);
}

POOL_TEST(a_moving_accelerometer_is_its_mass_spread_over_the_sensors)
{
    static struct sensor sensors[8];
    for (int fixed = 0; fixed < 2; fixed++) {
        const double mass[] = {8};
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        struct exact exact;
        double truth[EXACT_MODES];
        for (int i = 0; i < 8; i++)
            sensors[i] = rotor->sensor[9 * i];
        rotor->sensor = sensors;
        rotor->nsensor = 8;
        exact_open(rotor, &exact);
        for (int i = 0; i < 8; i++)
            exact.point[exact.system.points++] =
                (struct oracle_point){.z = sensors[i].position, .mass = fixed ? (i == 5) * 8.0 : 1};
        exact_hz(&exact, 3, EXACT_MODES, truth);
        bench_add(rotor, cause_accelerometer_mass.effect, fixed ? 5 : -1, fixed, mass);
        compare(fixed ? "fixed accelerometer" : "moving accelerometer", rotor, truth, 3e-6, 1.9);
    }
}

/* These are what the deck itself can say. */
POOL_TEST(factors_on_rods_and_springs_are_those_of_the_deck)
{
    const struct cause_kind *const cause[] = {&cause_tie_stiffness, &cause_tie_tension, &cause_support};
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int c = 0; c < 3; c++) {
            const double factor[] = {0.6};
            double expected[EXACT_MODES], hz[EXACT_MODES];
            struct rotor *rotor = bench_rotor((enum bundle_model)model, 1, 0);
            struct tierod *rod = &rotor->tierod[0];
            double e = rod->material.e, tension = rod->tension;
            bench_add(rotor, cause[c]->effect, 0, 0, factor);
            mesh_hz(rotor, 1, 2, EXACT_MODES, hz);
            rotor->neffect = 0;
            rod->material.e = c == 0 ? 0.6 * e : e;
            rod->tension = c == 1 ? 0.6 * tension : tension;
            rotor->spring[0].lateral *= c == 2 ? 0.6 : 1;
            rotor->spring[0].rotational *= c == 2 ? 0.6 : 1;
            mesh_hz(rotor, 1, 2, EXACT_MODES, expected);
            assert_hz(EXACT_MODES, hz, expected, 1e-9);
        }
}
