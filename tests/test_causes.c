/* Physical causes of the catalogue: geometry of the cones at steps, means over elements, bounds and where a cause applies. Their
 * frequencies: test_causes_exact.c. */
#include "diagnose/causes/causes.h"
#include "effect_bench.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

/* ---- the cones at steps ---- */

static struct group bars[2];
static struct segment steps[5];

/* Diameters 100 - 300 - 120 - 300 mm, and a last one of 200 that is rectangular or round. */
static struct rotor stepped(double length, int rectangular_end)
{
    static const double diameter[] = {0.1, 0.3, 0.12, 0.3, 0.2};
    const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};
    bars[0] = (struct group){.layer_of = -1, .name = "a", .material = steel};
    bars[1] = (struct group){.layer_of = -1, .name = "b", .material = steel};
    for (int s = 0; s < 5; s++)
        steps[s] =
            (struct segment){.group = s > 1, .elements = 10, .length = length, .outer = diameter[s], .stiff_outer = diameter[s]};
    if (rectangular_end)
        steps[4] = (struct segment){.group = 1, .elements = 10, .length = length, .rectangular = 1, .height = 0.2, .width = 0.1};
    return (struct rotor){.ngroup = 2, .group = bars, .nsegment = 5, .segment = steps};
}

/* Diameter that carries stiffness around z of a round segment without a bore: I is as D^4. angle in degrees. */
static double diameter_at(const struct rotor *rotor, int segment, double z, double angle)
{
    const struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {angle}};
    const struct effect_span span = {rotor->segment[segment].group, segment, z - 1e-9, z + 1e-9};
    struct effect_section factors = {1, 1};
    effect.kind->section(&effect, rotor, &span, -1, &factors);
    assert_close(sqrt(factors.ei), factors.kgs, 1e-9, 0);
    return rotor->segment[segment].stiff_outer * pow(factors.ei, 0.25);
}

POOL_TEST(cones_open_from_the_smaller_side_of_every_step)
{
    struct rotor rotor = stepped(0.2, 0);
    assert_close(diameter_at(&rotor, 1, 0.21, 45), 0.12, 1e-12, 0);
    assert_close(diameter_at(&rotor, 1, 0.25, 45), 0.2, 1e-12, 0);
    assert_close(diameter_at(&rotor, 1, 0.299, 45), 0.298, 1e-12, 0);
    assert_close(diameter_at(&rotor, 1, 0.37, 45), 0.12 + 0.06, 1e-12, 0); /* from the groove on the other side */
    assert_close(diameter_at(&rotor, 0, 0.19, 45), 0.1, 0, 0);             /* the smaller side is untouched */
    assert_close(diameter_at(&rotor, 1, 0.25, 90), 0.3, 0, 0);
    assert_close(diameter_at(&rotor, 4, 0.9, 10), 0.2, 0, 0);
}

POOL_TEST(cones_reach_across_sections)
{
    struct rotor rotor = stepped(0.02, 0); /* short: a cone of 30 degrees needs 0.17 m for 0.2 m */
    double t = tan(pi / 6);
    assert_close(diameter_at(&rotor, 1, 0.035, 30), fmin(0.1 + 2 * 0.015 * t, 0.12 + 2 * 0.005 * t), 1e-12, 0);
    /* the groove of 120 mm is inside the cone of the first step, which starts at 100 */
    assert_close(diameter_at(&rotor, 2, 0.045, 10), fmin(0.12, 0.1 + 2 * 0.025 * tan(pi / 18)), 1e-12, 0);
    assert_true(diameter_at(&rotor, 2, 0.045, 10) < 0.12);
    assert_close(diameter_at(&rotor, 3, 0.062, 10), 0.1 + 2 * 0.042 * tan(pi / 18), 1e-12, 0);
}

POOL_TEST(rectangles_make_no_step_and_have_no_cone)
{
    struct rotor rotor = stepped(0.2, 1);
    struct effect_span span = {1, 4, 0.8, 0.82};
    struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {20}};
    struct effect_section factors;
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, -1, &factors), 0);
    /* near the rectangle the last disc is whole: the next step is far away */
    assert_close(diameter_at(&rotor, 3, 0.799, 45), 0.3, 0, 0);
    struct rotor round = stepped(0.2, 0);
    assert_close(diameter_at(&round, 3, 0.799, 45), 0.202, 1e-12, 0);
}

/* Factors of an element against many points of the definition. */
POOL_TEST(factors_are_means_of_the_compliance)
{
    for (int kind = 0; kind < 4; kind++) { /* plain, core of another group, bore, holes */
        struct rotor rotor = stepped(0.2, 0);
        steps[3].inner = kind == 2 ? 0.05 : 0;
        if (kind == 3)
            bars[1] = (struct group){
                .layer_of = -1, .name = "b", .material = bars[1].material, .holes = 8, .hole_diameter = 0.02, .hole_pitch = 0.04};
        struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {30}};
        for (int e = 0; e < 100; e++) {
            double from = 0.01 * e, to = from + 0.01, bending = 0, shear = 0, own_area, own_inertia;
            int segment = e / 20;
            struct effect_span span = {rotor.segment[segment].group, segment, from, to};
            struct effect_section factors = {1, 1};
            effect.kind->section(&effect, &rotor, &span, -1, &factors);
            bench_section(&rotor, segment, rotor.segment[segment].stiff_outer, &own_area, &own_inertia);
            for (int i = 0; i < 2000; i++) {
                double area, inertia, z = from + (i + 0.5) / 2000 * 0.01, bore = steps[segment].inner;
                double diameter = bench_cone_diameter(&rotor, segment, z, 30);
                bench_section(&rotor, segment, diameter, &area, &inertia);
                bending += own_inertia / inertia / 2000;
                shear += own_area / area * rotid_shear_coefficient_annulus(0.3, bore / steps[segment].stiff_outer) /
                         rotid_shear_coefficient_annulus(0.3, bore / diameter) / 2000;
            }
            assert_close(factors.ei, 1 / bending, 1e-2, 0); /* four points see a kink within an element to a per cent */
            assert_close(factors.kgs, 1 / shear, 1e-2, 0);
        }
    }
}

/* A ring of holes within the reach of the cones: their share grows with the diameter that a cone leaves; the shear coefficient
 * grows with it where there is a bore. */
POOL_TEST(derivatives_by_the_angle_see_the_holes)
{
    struct rotor rotor = stepped(0.2, 0);
    steps[3].inner = 0.06;
    bars[1] = (struct group){
        .layer_of = -1, .name = "b", .material = bars[0].material, .holes = 8, .hole_diameter = 0.02, .hole_pitch = 0.08};
    int moved = 0;
    for (int e = 60; e < 80; e++) {
        const double step = 1e-4;
        struct effect_span span = {1, 3, 0.01 * e, 0.01 * (e + 1)};
        struct effect_section factors[2], d;
        for (int side = 0; side < 2; side++) {
            struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {30 + (side ? step : -step)}};
            factors[side] = (struct effect_section){1, 1};
            effect.kind->section(&effect, &rotor, &span, -1, &factors[side]);
        }
        struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {30}};
        if (!effect.kind->section(&effect, &rotor, &span, 0, &d))
            continue;
        moved += d.ei != 0;
        assert_close(d.ei, (factors[1].ei - factors[0].ei) / (2 * step), 1e-5, 1e-8);
        assert_close(d.kgs, (factors[1].kgs - factors[0].kgs) / (2 * step), 1e-5, 1e-8);
    }
    assert_true(moved > 5);
}

/* A flange on a thin shaft whose bore is wider than that shaft: the cone begins inside the bore. */
POOL_TEST(a_cone_inside_the_bore_leaves_a_little)
{
    struct rotor rotor = stepped(0.2, 0);
    struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {30}};
    struct effect_span span = {0, 1, 0.2, 0.202};
    struct effect_section factors, d;
    steps[1].inner = 0.2;
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, -1, &factors), 1);
    /* 0.21: a tenth of the wall */
    assert_close(factors.ei, (pow(0.21, 4) - pow(0.2, 4)) / (pow(0.3, 4) - pow(0.2, 4)), 1e-12, 0);
    assert_close(factors.kgs,
                 (pow(0.21, 2) - pow(0.2, 2)) / (pow(0.3, 2) - pow(0.2, 2)) * rotid_shear_coefficient_annulus(0.3, 0.2 / 0.21) /
                     rotid_shear_coefficient_annulus(0.3, 0.2 / 0.3),
                 1e-12, 0);
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, 0, &d), 1);
    assert_close(d.ei, 0, 0, 0);
}

/* ---- a soft zone narrower than an element ---- */

POOL_TEST(a_narrow_zone_keeps_its_mean)
{
    for (double width = 0.001; width < 0.2; width *= 1.7)
        for (double depth = 0.05; depth < 1; depth += 0.15) {
            struct effect effect = {.kind = cause_stiffness_local.effect, .target = -1, .value = {depth, 0.513, width}};
            struct effect_span span = {0, 0, 0.5, 0.53};
            struct effect_field factors = {1, 1, 1};
            double mean = 0;
            effect.kind->field(&effect, NULL, &span, -1, &factors);
            for (int i = 0; i < 20000; i++) {
                double z = 0.5 + 0.03 * (i + 0.5) / 20000;
                mean += 1 / (1 - depth * exp(-pow((z - 0.513) / width, 2) / 2)) / 20000;
            }
            assert_close(factors.e, 1 / mean, 1e-3, 0);
        }
}

/* ---- catalogue ---- */

static const struct cause_kind *const all[] = {&cause_step_stiffness,
                                               &cause_stiffness_gradient,
                                               &cause_stiffness_profile,
                                               &cause_stiffness_local,
                                               &cause_joint,
                                               &cause_support,
                                               &cause_added_mass,
                                               &cause_density,
                                               &cause_diameter,
                                               &cause_stiffness,
                                               &cause_tie_stiffness,
                                               &cause_tie_tension,
                                               &cause_tie_shear,
                                               &cause_shear_coefficient,
                                               &cause_accelerometer_mass,
                                               &cause_support_position,
                                               &cause_support_extra,
                                               &cause_support_rotation,
                                               &cause_clamp,
                                               &cause_hub_stiffness,
                                               &cause_added_inertia};

#define ALL ((int)(sizeof all / sizeof *all))

POOL_TEST(entries_are_complete)
{
    const struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 0);
    for (int c = 0; c < ALL; c++) {
        const struct cause_kind *cause = all[c];
        assert_int_equal(cause->class, CAUSE_PHYSICAL);
        assert_string_equal(cause->id, cause->effect->id);
        assert_true(cause->sentence && cause->check);
        assert_true(cause->place < cause->effect->nparameter && cause->width < cause->effect->nparameter);
        for (int variant = 0; variant < 4 && (variant == 0 || cause->variant[variant]); variant++) {
            struct effect effect = {.kind = cause->effect, .variant = variant};
            for (int p = 0; p < cause->effect->nparameter; p++) {
                double lower = NAN, upper = NAN, neutral = cause->parameter[p].neutral, typical = cause->parameter[p].typical;
                assert_true(cause->effect->parameter[p].name && cause->effect->parameter[p].unit);
                cause_range(cause, rotor, &effect, p, &lower, &upper);
                assert_true(lower < upper);
                if (p == cause->place || p == cause->width)
                    continue;
                assert_true(lower <= typical && typical <= upper && typical != neutral);
                assert_true(cause->parameter[p].one_sided * (typical - neutral) >= 0);
            }
        }
    }
}

/* What is possible holds what is usual. */
POOL_TEST(sizes_reach_beyond_their_usual_bounds)
{
    struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 0);
    for (int c = 0; c < ALL; c++) {
        const struct cause_kind *cause = all[c];
        struct effect effect = {.kind = cause->effect}, stated = effect;
        double lower, upper, least, most, neutral = cause->parameter[cause->size].neutral;
        if (!cause->effect->nparameter)
            continue;
        cause_range(cause, rotor, &effect, cause->size, &lower, &upper);
        cause_bounds(cause, rotor, &effect, cause->size, &least, &most);
        assert_true(least <= lower && most >= upper);
        assert_int_equal(cause->widest > 1, most > upper);
        if (cause->widest > 1)
            assert_close(most - neutral, cause->widest * (upper - neutral), 1e-12, 0);
        stated.bound[0] = 0.9 * lower + 0.1 * upper;
        stated.bound[1] = upper;
        cause_bounds(cause, rotor, &stated, cause->size, &least, &most);
        assert_true(least == stated.bound[0] && most == upper);
    }
}

POOL_TEST(causes_apply_where_they_make_sense)
{
    struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 0);
    const int identified[] = {0, 1, 0};
    for (int g = 0; g < 3; g++) {
        assert_int_equal(cause_stiffness.applies(rotor, g, identified), g != 1);
        assert_int_equal(cause_shear_coefficient.applies(rotor, g, identified), g != 1);
        assert_int_equal(cause_joint.applies(rotor, g, identified), g < 2);
    }
    assert_int_equal(cause_tie_shear.applies(rotor, 0, identified), 1);
    rotor->tierod[0].model = BUNDLE_RODS;
    assert_int_equal(cause_tie_shear.applies(rotor, 0, identified), 0);
    assert_int_equal(cause_tie_tension.applies(rotor, 0, identified), 1);
    rotor->tierod[0].tension = 0;
    assert_int_equal(cause_tie_tension.applies(rotor, 0, identified), 0);
    assert_int_equal(cause_support.applies(rotor, 1, identified), 1);
    rotor->spring[1].lateral = rotor->spring[1].rotational = 0;
    assert_int_equal(cause_support.applies(rotor, 1, identified), 0);
    assert_int_equal(cause_step_stiffness.applies(rotor, -1, identified), 1);
    for (int s = 0; s < rotor->nsegment; s++)
        rotor->segment[s].outer = 0.4;
    assert_int_equal(cause_step_stiffness.applies(rotor, -1, identified), 0);
}

POOL_TEST(bounds_of_mass_rest_on_the_mass_of_the_model)
{
    struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 0);
    struct effect effect = {.kind = cause_added_mass.effect};
    struct mass_properties properties;
    struct beam beam;
    double lower, upper;
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &properties);
    assert_close(rotor_mass(rotor), properties.mass, 1e-12, 0);
    cause_added_mass.bounds(rotor, &effect, 0, &lower, &upper);
    assert_close(upper, 0.03 * properties.mass, 1e-12, 0); /* of a ton */
    for (int s = 0; s < rotor->nsegment; s++)              /* of a hundredth of it */
        rotor->segment[s].length /= 100;
    rotor->ntierod = 0;
    rotor->ndisk = 0;
    cause_added_mass.bounds(rotor, &effect, 0, &lower, &upper);
    assert_close(upper, 0.25 * rotor_mass(rotor), 1e-12, 0);
}

/* Of a uniform shaft: L/EI and L^3/3EI at its end, less where it is held in the middle; 4.730^4 EI/L^3. */
POOL_TEST(bounds_of_supports_follow_the_rotor)
{
    struct rotor rotor = stepped(0.2, 0);
    struct spring spring[2] = {{"end", 0, 1e9, 1e6, 0, 0}, {"middle", 0.5, 1e9, 0, 0, 0}};
    struct effect effect = {.target = 0};
    double lower, upper, ei = 2.1e11 * pi / 64 * pow(0.12, 4);
    const int identified[2] = {0, 0};
    for (int s = 0; s < 5; s++)
        steps[s].outer = steps[s].stiff_outer = 0.12;
    rotor.spring = spring;
    rotor.nspring = 2;
    cause_clamp.bounds(&rotor, &effect, 0, &lower, &upper);
    assert_close(upper, 1 / ei / 8, 1e-12, 0);
    cause_clamp.bounds(&rotor, &effect, 1, &lower, &upper);
    assert_close(upper, 1 / (3 * ei) / 8, 1e-12, 0);
    assert_int_equal(cause_clamp.applies(&rotor, 0, identified), 1);
    assert_int_equal(cause_clamp.applies(&rotor, 1, identified), 0);
    cause_support_extra.bounds(&rotor, &effect, 0, &lower, &upper);
    assert_close(upper, pow(4.7300407, 4) * ei, 1e-4, 0);
    cause_support_position.bounds(&rotor, &effect, 0, &lower, &upper);
    assert_true(lower == 0 && upper == 0.125); /* it cannot leave the rotor */
    effect.target = 1;
    cause_clamp.bounds(&rotor, &effect, 1, &lower, &upper);
    assert_close(upper, 2 * pow(0.5, 3) / (3 * ei) / 8, 1e-12, 0);
    cause_support_position.bounds(&rotor, &effect, 0, &lower, &upper);
    assert_true(lower == -0.125 && upper == 0.125);
}

/* As soft as ten diameters of the softer neighbour: the last piece of the left shaft. */
POOL_TEST(bounds_of_a_joint_are_ten_diameters_of_shaft)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    struct effect effect = {.kind = cause_joint.effect, .target = 0};
    double lower, upper, area, inertia, d = 0.334092;
    rotor->group[1].holes = 0;
    bench_section(rotor, 6, d, &area, &inertia);
    cause_joint.bounds(rotor, &effect, 0, &lower, &upper);
    assert_close(lower, 0, 0, 0);
    assert_close(upper, 10 * d / (0.6e11 * inertia), 1e-12, 0); /* the core is the softer one */
}
