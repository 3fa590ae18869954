/* Every analytic derivative in the presence of effects against differences: the parameters of each cause, those of the base
 * beside it, all pairs of causes, the joint with and without rods, a mass at any place. */
#include "effect_bench.h"
#include "support.h"

/* Left shaft, core, right shaft: interfaces of the paper's rotor [m] */
#define LEFT_INTERFACE  0.625822
#define RIGHT_INTERFACE 1.550014
#define LENGTH          2.029961

static const struct subject {
    const struct cause_kind *cause; /* NULL: the lump */
    int target, variant;
    double value[EFFECT_MOST_PARAMETERS];
} subjects[] = {
    {&cause_step_stiffness, -1, 0, {33.7}},
    {&cause_stiffness_gradient, 1, 0, {0.37}},
    {&cause_stiffness_profile, 1, 0, {0.41}},
    {&cause_stiffness_local, -1, 0, {0.43, LEFT_INTERFACE + 0.011, 0.05}},
    {&cause_stiffness_local, -1, 1, {0.43, LEFT_INTERFACE + 0.011, 0.07}},
    {&cause_stiffness_local, -1, 2, {0.43, LEFT_INTERFACE + 0.011, 0.004, 0.21}},
    {&cause_stiffness_local, -1, 3, {0.43, LEFT_INTERFACE + 0.011, 0.013, 0.21}},
    {&cause_joint, 0, 0, {3e-9}},
    {&cause_joint, 1, 0, {3e-9}},
    {&cause_support, 0, 0, {1.7}},
    {&cause_added_mass, -1, 0, {9, LEFT_INTERFACE + 0.007}},
    {&cause_added_mass, -1, 0, {9, LEFT_INTERFACE - 0.007}},
    {&cause_density, 1, 0, {1.1}},
    {&cause_diameter, 0, 0, {1.03}},
    {&cause_diameter, 1, 0, {0.97}},
    {&cause_stiffness, 0, 0, {0.9}},
    {&cause_tie_stiffness, 0, 0, {0.6}},
    {&cause_tie_tension, 0, 0, {0.7}},
    {&cause_tie_shear, 0, 0, {0}},
    {&cause_shear_coefficient, 0, 0, {0.8}},
    {&cause_accelerometer_mass, 1, 1, {0.3}},
    {&cause_accelerometer_mass, -1, 0, {0.3}},
    {&cause_support_position, 0, 0, {LEFT_INTERFACE + 0.011}},
    {&cause_support_position, 0, 0, {LEFT_INTERFACE - 0.011}},
    {&cause_support_extra, -1, 0, {2e9, LEFT_INTERFACE - 0.008}},
    {&cause_support_rotation, -1, 0, {3e7, LEFT_INTERFACE - 0.008}},
    {&cause_clamp, 0, 0, {2e-6, 3e-9}},
    {&cause_added_mass, -1, 1, {9, LEFT_INTERFACE + 0.003, 0.213}},
    {&cause_added_inertia, 0, 0, {0.7}},
    {&cause_added_inertia, 0, 0, {-0.1}},
    {&cause_hub_stiffness, -1, 0, {0.6}},
};

#define SUBJECTS ((int)(sizeof subjects / sizeof *subjects))

static const char *const base[] = {"left.E",       "left.nu",  "left.rho",    "core.E",   "core.G",
                                   "core.nu",      "core.rho", "right.E",     "right.nu", "ties.E",
                                   "ties.tension", "start.k",  "start.k_rot", "fan.mass", "fan.inertia"};

#define BASE ((int)(sizeof base / sizeof *base))

static struct sensor sensors[3] = {{1, 0.1}, {2, LEFT_INTERFACE + 0.013}, {3, 1.9}};

static void add(struct rotor *rotor, const struct subject *subject)
{
    bench_add(rotor, subject->cause->effect, subject->target, subject->variant, subject->value);
}

/* One that crosses no kink of an envelope nor drowns in rounding: tension is 1e-5 of the stiffness of an element. */
static double step_of(const struct rotor *rotor, struct parameter parameter)
{
    int effect = parameter.kind == PARAMETER_EFFECT;
    if (parameter.kind == PARAMETER_TENSION || (effect && rotor->effect[parameter.index].kind == cause_tie_tension.effect))
        return 0.1;
    return effect ? 2e-4 : 1e-3;
}

/* All parameters of the rotor at once; the worst error. */
static double check(struct rotor *rotor, const char *what)
{
    struct parameter parameter[32];
    struct beam beam;
    const char *unit;
    int count = 0;
    double worst = 0;
    for (int b = 0; b < BASE; b++)
        if (rotor->ntierod || (b != 9 && b != 10))
            assert_int_equal(parameter_find(rotor, base[b], &parameter[count++], &unit), 0);
    for (int i = 0; i < rotor->neffect; i++)
        for (int p = 0; p < effect_parameters(&rotor->effect[i]); p++)
            parameter[count++] = (struct parameter){PARAMETER_EFFECT, i, p, 0, NULL};
    bench_build(rotor, count, parameter, &beam);
    for (int p = 0; p < count; p++) {
        double error = bench_derivative_error(&beam, p, step_of(rotor, parameter[p]), 0);
        if (error > 1e-6)
            print_error("%s: parameter %d of kind %d, index %d, component %d: error %.2e\n", what, p, (int)parameter[p].kind,
                        parameter[p].index, parameter[p].component, error);
        assert_true(error <= 1e-6);
        worst = fmax(worst, error);
    }
    return worst;
}

/* 0: RODS, 1: TUBE, 2: no rods, which moves the hinge to the other side of the left interface */
static struct rotor *open_rotor(int variant)
{
    struct rotor *rotor = bench_rotor(variant & 1 ? BUNDLE_TUBE : BUNDLE_RODS, !(variant & 2), 4);
    rotor->sensor = sensors;
    rotor->nsensor = 3;
    return rotor;
}

static int acts_on_rods(const struct subject *subject)
{
    return subject->cause && subject->cause->target == TARGET_TIEROD;
}

POOL_TEST(every_cause_alone_agrees_with_differences)
{
    for (int variant = 0; variant < 3; variant++)
        for (int s = 0; s < SUBJECTS; s++) {
            struct rotor *rotor = open_rotor(variant);
            if (acts_on_rods(&subjects[s]) && !rotor->ntierod)
                continue;
            add(rotor, &subjects[s]);
            double worst = check(rotor, subjects[s].cause->id);
            if (variant == 0)
                print_message("%-20s %.1e\n", subjects[s].cause->id, worst);
        }
}

POOL_TEST(pairs_of_causes_agree_with_differences)
{
    double worst = 0;
    for (int variant = 0; variant < 3; variant++)
        for (int s = 0; s < SUBJECTS; s++)
            for (int t = s; t < SUBJECTS; t++) {
                struct rotor *rotor = open_rotor(variant);
                if ((acts_on_rods(&subjects[s]) || acts_on_rods(&subjects[t])) && !rotor->ntierod)
                    continue;
                add(rotor, &subjects[s]);
                add(rotor, &subjects[t]);
                worst = fmax(worst, check(rotor, subjects[s].cause->id));
            }
    print_message("pairs: %.1e\n", worst);
}

/* Hinges at both ends of one element, a mass inside it and a soft core. */
POOL_TEST(an_element_with_two_hinges_agrees_with_differences)
{
    const double soft[] = {0.3};
    struct rotor *rotor = open_rotor(0);
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == 1)
            rotor->segment[s].elements = 1;
    add(rotor, &subjects[7]);
    add(rotor, &subjects[8]);
    bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){9, 1.1, 0});
    rotor->nsensor = 0;
    struct beam beam;
    bench_build(rotor, 0, NULL, &beam);
    assert_int_equal(beam.nhinge, 2);
    assert_int_equal(beam.hinge[0].element, beam.hinge[1].element);
    assert_int_equal(beam.hinge[0].end, 0);
    assert_int_equal(beam.hinge[1].end, 1);
    check(rotor, "two hinges");
    rotor->neffect--;
    bench_add(rotor, cause_stiffness_gradient.effect, 1, 0, soft);
    check(rotor, "two hinges, gradient");
}

/* At a node the slope of the deflection differs by the shear angle between both sides: one-sided, on that of the element. */
POOL_TEST(a_mass_at_nodes_and_ends_is_differentiated_to_one_side)
{
    const double node[] = {0, 0.256018, LENGTH};
    for (int n = 0; n < 3; n++) {
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
        struct beam beam;
        double end = rotor_length(rotor), z = n == 2 ? end : node[n];
        bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){9, z, 0});
        struct parameter parameter[] = {{PARAMETER_EFFECT, 0, 0, 0, NULL}, {PARAMETER_EFFECT, 0, 1, 0, NULL}};
        bench_build(rotor, 2, parameter, &beam);
        assert_true(bench_derivative_error(&beam, 0, 1e-3, 0) < 1e-9);
        assert_true(bench_derivative_error(&beam, 1, 2e-4, n == 2 ? -1 : 1) < 1e-6);
    }
}

POOL_TEST(a_mass_beyond_the_ends_stays_there_and_does_not_move)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    struct effect *lump = bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){9, -0.1, 0});
    struct parameter parameter[] = {{PARAMETER_EFFECT, 0, 1, 0, NULL}};
    struct beam outside, at_end;
    rotid_matrix k[2], m[2], dk, dm;
    bench_build(rotor, 1, parameter, &outside);
    lump->value[1] = 0;
    bench_build(rotor, 1, parameter, &at_end);
    bench_matrices(&outside, (double[]){-0.1}, &k[0], &m[0]);
    bench_matrices(&at_end, (double[]){0}, &k[1], &m[1]);
    assert_close(bench_largest(&m[0], &m[1]), 0, 0, 0);
    dk = bench_zero(&outside);
    dm = bench_zero(&outside);
    beam_differentiate(&outside, 0, &dk, &dm);
    assert_close(bench_largest(&dm, NULL), 0, 0, 0);
}
