/* What effects do to the beam: nothing at their neutral values, lumped masses anywhere, hinges, mass properties, names. */
#include "beam/beam.h"
#include "effect_bench.h"
#include "linalg/linalg.h"
#include "support.h"

static const struct cause_kind *const physical[] = {&cause_step_stiffness,
                                                    &cause_stiffness_gradient,
                                                    &cause_stiffness_profile,
                                                    &cause_stiffness_local,
                                                    &cause_joint,
                                                    &cause_support,
                                                    &cause_added_mass,
                                                    &cause_density,
                                                    &cause_stiffness,
                                                    &cause_tie_stiffness,
                                                    &cause_tie_tension,
                                                    &cause_shear_coefficient,
                                                    &cause_accelerometer_mass,
                                                    &cause_support_position,
                                                    &cause_support_extra,
                                                    &cause_support_rotation,
                                                    &cause_clamp,
                                                    &cause_hub_stiffness,
                                                    &cause_added_inertia};

#define PHYSICAL ((int)(sizeof physical / sizeof *physical))

static void neutral(const struct cause_kind *cause, double *value)
{
    for (int p = 0; p < cause->effect->nparameter; p++)
        value[p] = cause->parameter[p].neutral;
    if (cause->place >= 0)
        value[cause->place] = 0.7;
    if (cause->width >= 0)
        value[cause->width] = 0.1;
}

POOL_TEST(effects_at_their_neutral_values_change_nothing)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int c = 0; c < PHYSICAL; c++)
            for (int variant = 0; variant < 4; variant++) {
                struct rotor *rotor = bench_rotor((enum bundle_model)model, 1, 4);
                struct beam bare, with;
                rotid_matrix k[2], m[2];
                double value[EFFECT_MOST_PARAMETERS];
                if (variant && !physical[c]->variant[variant])
                    break;
                bench_build(rotor, 0, NULL, &bare);
                assert_null(bare.factor);
                assert_int_equal(bare.nhinge, 0);
                neutral(physical[c], value);
                bench_add(rotor, physical[c]->effect, 0, variant, value);
                bench_build(rotor, 0, NULL, &with);
                bench_matrices(&bare, NULL, &k[0], &m[0]);
                bench_matrices(&with, NULL, &k[1], &m[1]);
                assert_close(bench_largest(&k[1], &k[0]), 0, 0, 1e-15 * bench_largest(&k[0], NULL));
                assert_close(bench_largest(&m[1], &m[0]), 0, 0, 1e-15 * bench_largest(&m[0], NULL));
            }
}

POOL_TEST(rods_instead_of_a_tube_are_the_rods_of_the_deck)
{
    struct beam with, expected;
    rotid_matrix k[2], m[2];
    struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 4);
    bench_add(rotor, cause_tie_shear.effect, 0, 0, NULL);
    bench_build(rotor, 0, NULL, &with);
    bench_matrices(&with, NULL, &k[0], &m[0]);
    bench_build(bench_rotor(BUNDLE_RODS, 1, 4), 0, NULL, &expected);
    bench_matrices(&expected, NULL, &k[1], &m[1]);
    assert_close(bench_largest(&k[0], &k[1]), 0, 0, 0);
    assert_close(bench_largest(&m[0], &m[1]), 0, 0, 0);
}

/* ---- lumped masses ---- */

static const struct element elements[] = {
    {6e6, 3e9, 40, 0.06, 0, 0.0125}, {1, 12e6, 3, 1e-4, 0, 1}, {2.5, 7.5, 1.7, 0.3, 0, 2}, {1000, 12, 0.5, 8, 0, 1}};

POOL_TEST(shapes_are_those_that_the_mass_matrix_integrates)
{
    const double point[2] = {0.339981043584856264802666, 0.861136311594052575223946};
    const double weight[2] = {0.652145154862546142626936, 0.347854845137453857373064};
    for (size_t n = 0; n < sizeof elements / sizeof *elements; n++) {
        const struct element *e = &elements[n];
        double k[16], m[16], sum[16] = {0}, l = e->length;
        struct lumped_shape s;
        element_matrices(e, k, m);
        for (int g = 0; g < 4; g++) {
            lumped_shapes(e, (1 + (g % 2 ? 1 : -1) * point[g / 2]) / 2, &s, NULL, NULL);
            for (int i = 0; i < 16; i++)
                sum[i] += weight[g / 2] * l / 2 * (e->rhos * s.v[i % 4] * s.v[i / 4] + e->rhoi * s.theta[i % 4] * s.theta[i / 4]);
        }
        for (int i = 0; i < 16; i++) {
            double scale = (i % 4 % 2 ? l : 1) * (i / 4 % 2 ? l : 1);
            m[i] /= scale;
            sum[i] /= scale;
        }
        assert_close(relative_difference(16, sum, m), 0, 0, 1e-13);
    }
}

POOL_TEST(shapes_are_differentiated_by_place_and_shear_factor)
{
    const double xi = 0.37, h = 1e-3;
    for (size_t n = 0; n < sizeof elements / sizeof *elements; n++) {
        struct element softer = elements[n], stiffer = elements[n];
        struct lumped_shape s, low, high, by_xi, by_phi;
        double phi = 12 * softer.ei / (softer.kgs * softer.length * softer.length), l = softer.length;
        lumped_shapes(&elements[n], xi, &s, &by_xi, &by_phi);
        lumped_shapes(&elements[n], xi - h, &low, NULL, NULL);
        lumped_shapes(&elements[n], xi + h, &high, NULL, NULL);
        for (int i = 0; i < 4; i++) {
            double unit = i % 2 ? l : 1;
            assert_close((high.v[i] - low.v[i]) / (2 * h), by_xi.v[i], 0, 1e-5 * unit);
            assert_close((high.theta[i] - low.theta[i]) / (2 * h), by_xi.theta[i], 0, 1e-5 * unit / l);
        }
        softer.ei *= 1 - h;
        stiffer.ei *= 1 + h;
        lumped_shapes(&softer, xi, &low, NULL, NULL);
        lumped_shapes(&stiffer, xi, &high, NULL, NULL);
        for (int i = 0; i < 4; i++) {
            double unit = i % 2 ? l : 1;
            assert_close((high.v[i] - low.v[i]) / (2 * h), by_phi.v[i] * phi, 0, 1e-6 * unit);
            assert_close((high.theta[i] - low.theta[i]) / (2 * h), by_phi.theta[i] * phi, 0, 1e-6 * unit / l);
        }
    }
}

/* K [16] of an element in two parts with springs at the node between them, that node condensed. */
static void condensed_in_two(const struct element *whole, double xi, double lateral, double rotational, double *k)
{
    struct element part = *whole;
    double two[36] = {0}, m[16], one[16];
    const int place[2][4] = {{0, 1, 4, 5}, {4, 5, 2, 3}};
    for (int side = 0; side < 2; side++) {
        part.length = (side ? 1 - xi : xi) * whole->length;
        element_matrices(&part, one, m);
        for (int i = 0; i < 16; i++)
            two[place[side][i % 4] + 6 * place[side][i / 4]] += one[i];
    }
    two[4 + 6 * 4] += lateral;
    two[5 + 6 * 5] += rotational;
    for (int pivot = 5; pivot > 3; pivot--)
        for (int j = 0; j < pivot; j++)
            for (int i = 0; i < pivot; i++)
                two[i + 6 * j] -= two[i + 6 * pivot] * two[pivot + 6 * j] / two[pivot + 6 * pivot];
    for (int i = 0; i < 16; i++)
        k[i] = two[i % 4 + 6 * (i / 4)];
}

POOL_TEST(springs_inside_an_element_are_at_a_node_that_has_been_condensed)
{
    const double place[] = {0.05, 0.3, 0.5, 0.81}, stiff[] = {0, 1e-2, 1, 1e4};
    for (size_t n = 0; n < 3; n++) /* the last one has no bending to speak of beside its shear */
        for (int p = 0; p < 4; p++)
            for (int s = 1; s < 16; s++) {
                const struct element *e = &elements[n];
                double z[2] = {0, e->length}, k[16], m[16], expected[16], l = e->length;
                struct beam beam = {.mesh.z = z};
                struct lumped lumped = {.point = {.z = place[p] * l}};
                lumped.point.lateral = stiff[s % 4] * 3 * e->ei / l / l / l;
                lumped.point.rotational = stiff[s / 4] * 3 * e->ei / l;
                element_matrices(e, k, m);
                lumped_add(&beam, &lumped, e, k, m);
                condensed_in_two(e, place[p], lumped.point.lateral, lumped.point.rotational, expected);
                for (int i = 0; i < 16; i++) {
                    double scale = (i % 4 % 2 ? l : 1) * (i / 4 % 2 ? l : 1);
                    k[i] /= scale;
                    expected[i] /= scale;
                }
                assert_close(relative_difference(16, k, expected), 0, 0, 1e-10);
            }
}

POOL_TEST(a_mass_at_a_node_is_a_disk)
{
    for (int n = 0; n < 3; n++) {
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
        struct beam lump, disk;
        rotid_matrix k[2], m[2];
        double from, to;
        rotor_group_span(rotor, 1, &from, &to);
        double z = n == 0 ? 0 : n == 1 ? to : rotor_length(rotor);
        rotor->disk[0] = (struct disk){"fan", z, 12, 0, 0, 0, 0};
        bench_build(rotor, 0, NULL, &disk);
        rotor->ndisk = 0;
        bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){12, z, 0});
        bench_build(rotor, 0, NULL, &lump);
        bench_matrices(&lump, NULL, &k[0], &m[0]);
        bench_matrices(&disk, NULL, &k[1], &m[1]);
        assert_close(bench_largest(&m[0], &m[1]), 0, 0, 1e-14 * bench_largest(&m[1], NULL));
        assert_close(bench_largest(&k[0], &k[1]), 0, 0, 0);
    }
}

/* A rigid motion feels the mass wherever the lump is, and nothing jumps where it crosses a node. */
POOL_TEST(a_mass_moves_smoothly_from_element_to_element)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    struct beam beam, bare;
    struct parameter place = {PARAMETER_EFFECT, 0, 1, 0, NULL};
    rotid_matrix k, m, m0, before;
    bench_build(rotor, 0, NULL, &bare);
    bench_matrices(&bare, NULL, &k, &m0);
    bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){9, 0, 0});
    bench_build(rotor, 1, &place, &beam);
    int n = beam.mesh.ndof;
    double *shift = pool_get(&test_pool, (size_t)n, sizeof(double)), *turn = pool_get(&test_pool, (size_t)n, sizeof(double)),
           *work = pool_get(&test_pool, (size_t)n, sizeof(double));
    for (int i = 0; i < beam.mesh.naxis; i++) {
        shift[2 * i] = 1;
        turn[2 * i] = -beam.mesh.z[i];
        turn[2 * i + 1] = 1;
    }
    for (int i = 0; i <= 40; i++) {
        double z = rotor_length(rotor) * i / 40;
        bench_matrices(&beam, &z, &k, &m);
        matrix_combine(1, &m, -1, &m0, &m);
        assert_close(matrix_product(&m, shift, shift, work), 9, 1e-10, 0);
        assert_close(matrix_product(&m, shift, turn, work), -9 * z, 0, 1e-9);
        assert_close(matrix_product(&m, turn, turn, work), 9 * z * z, 0, 1e-9);
    }
    for (int e = 1; e < beam.mesh.nelement; e++) {
        double left = beam.mesh.z[e] - 1e-9, right = beam.mesh.z[e] + 1e-9;
        bench_matrices(&beam, &left, &k, &before);
        bench_matrices(&beam, &right, &k, &m);
        assert_close(bench_largest(&m, &before), 0, 0, 2e-6 * 9);
    }
}

POOL_TEST(mass_properties_know_of_effects)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    struct mass_properties bare, with;
    struct beam beam;
    double from, to;
    rotor_group_span(rotor, 1, &from, &to);
    rotor->nspring = 0;
    rotor->sling = 1.5;
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &bare);
    bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){9, 0.4, 0});
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &with);
    assert_close(with.mass, bare.mass + 9, 1e-14, 0);
    double center = (bare.mass * bare.center + 9 * 0.4) / with.mass;
    assert_close(with.center, center, 1e-14, 0);
    assert_close(with.inertia, bare.inertia + bare.mass * pow(bare.center - center, 2) + 9 * pow(0.4 - center, 2), 1e-13, 0);
    assert_close(beam.rotor.spring[0].lateral, with.mass * 9.81 / 1.5, 1e-14, 0);
    rotor->neffect = 0;
    bench_add(rotor, cause_added_inertia.effect, 0, 0, (double[]){-0.3});
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &with);
    assert_close(with.inertia, bare.inertia - 0.3, 1e-13, 0);
    rotor->neffect = 0;
    bench_add(rotor, cause_density.effect, 1, 0, (double[]){1.25});
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &with);
    rotor->neffect = 0;
    rotor->group[1].material.rho *= 1.25;
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &bare);
    assert_close(with.mass, bare.mass, 1e-14, 0);
    assert_close(with.inertia, bare.inertia, 1e-13, 0);
    rotor->neffect = 0;
    bench_add(rotor, cause_accelerometer_mass.effect, -1, 0, (double[]){0.5}); /* no sensors: nothing moves over them */
    bench_build(rotor, 0, NULL, &beam);
    beam_mass_properties(&beam, &with);
    assert_close(with.mass, bare.mass, 1e-14, 0);
}

/* ---- hinges ---- */

/* The element with the rotation of its own end kept, and a spring 1/c between that and the node; then the end is condensed. */
static void series_of_five(double c, int end, const double *k, double *condensed)
{
    double five[25] = {0};
    int r = end ? 3 : 1, place[4] = {0, 1, 2, 3};
    place[r] = 4;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            five[place[i] + 5 * place[j]] += k[i + 4 * j];
    five[r + 5 * r] += 1 / c;
    five[24] += 1 / c;
    five[r + 20] -= 1 / c;
    five[4 + 5 * r] -= 1 / c;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            condensed[i + 4 * j] = five[i + 5 * j] - five[i + 20] * five[4 + 5 * j] / five[24];
}

POOL_TEST(a_hinge_is_a_spring_in_series_that_has_been_condensed)
{
    const struct element *e = &elements[2];
    for (int end = 0; end < 2; end++)
        for (double c = 1e-3; c < 1e4; c *= 10) {
            double k[16], m[16], expected[16], product[16] = {0}, turned[16] = {0}, transform[16] = {0}, full[16];
            element_matrices(e, k, m);
            memcpy(full, m, sizeof full);
            series_of_five(c, end, k, expected);
            int r = end ? 3 : 1;
            double corner = k[r + 4 * r];
            for (int j = 0; j < 4; j++) {
                transform[j + 4 * j] = 1;
                transform[r + 4 * j] -= c / (1 + c * corner) * k[j + 4 * r];
            }
            for (int j = 0; j < 4; j++)
                for (int i = 0; i < 4; i++)
                    for (int s = 0; s < 4; s++)
                        product[i + 4 * j] += full[i + 4 * s] * transform[s + 4 * j];
            for (int j = 0; j < 4; j++)
                for (int i = 0; i < 4; i++)
                    for (int s = 0; s < 4; s++)
                        turned[i + 4 * j] += transform[s + 4 * i] * product[s + 4 * j];
            hinge_apply(c, 0, end, k, m, NULL, NULL);
            assert_close(relative_difference(16, k, expected), 0, 0, 1e-13);
            assert_close(relative_difference(16, m, turned), 0, 0, 1e-13);
        }
}

static void place_of_hinge(const struct rotor *rotor, double z, int end)
{
    struct beam beam;
    bench_build(rotor, 0, NULL, &beam);
    assert_int_equal(beam.nhinge, 1);
    assert_int_equal(beam.hinge[0].end, end);
    assert_close(beam.mesh.z[beam.hinge[0].element + end], z, 1e-12, 0);
    assert_true(hinge_in(&beam, beam.hinge[0].element));
    assert_true(hinge_at(&beam, beam.hinge[0].element, end));
    assert_false(hinge_at(&beam, beam.hinge[0].element, !end));
}

POOL_TEST(the_hinge_is_between_the_rods_and_else_on_the_left)
{
    for (int interface = 0; interface < 2; interface++)
        for (int rods = 0; rods < 2; rods++) {
            struct rotor *rotor = bench_rotor(BUNDLE_RODS, rods, 4);
            double from, to;
            rotor_group_span(rotor, interface, &from, &to);
            bench_add(rotor, cause_joint.effect, interface, 0, (double[]){1e-9});
            place_of_hinge(rotor, to, !(rods && interface == 0));
        }
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4); /* nothing lies behind the last group */
    struct beam beam;
    bench_add(rotor, cause_joint.effect, 2, 0, (double[]){1e-9});
    bench_build(rotor, 0, NULL, &beam);
    assert_int_equal(beam.nhinge, 0);
}

/* A mass at the interface itself is on the node, on either side of the hinge. */
POOL_TEST(a_mass_at_the_interface_hangs_on_the_node)
{
    for (int rods = 0; rods < 2; rods++) {
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, rods, 4);
        struct beam lump, disk;
        rotid_matrix k[2], m[2];
        double from, to;
        rotor_group_span(rotor, 0, &from, &to);
        bench_add(rotor, cause_joint.effect, 0, 0, (double[]){3e-9});
        rotor->disk[0] = (struct disk){"fan", to, 12, 0, 0, 0, 0};
        bench_build(rotor, 0, NULL, &disk);
        rotor->ndisk = 0;
        bench_add(rotor, cause_added_mass.effect, -1, 0, (double[]){12, to, 0});
        bench_build(rotor, 0, NULL, &lump);
        bench_matrices(&lump, NULL, &k[0], &m[0]);
        bench_matrices(&disk, NULL, &k[1], &m[1]);
        assert_close(bench_largest(&m[0], &m[1]), 0, 0, 1e-14 * bench_largest(&m[1], NULL));
    }
}

/* ---- parameters ---- */

POOL_TEST(names_find_the_parameters_of_effects)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    struct parameter parameter;
    const char *unit = NULL;
    struct effect *zone = bench_add(rotor, cause_stiffness_local.effect, -1, 0, (double[]){0.1, 0.7, 0.05, 0.2});
    bench_add(rotor, cause_joint.effect, 0, 0, (double[]){1e-9})->name = NULL;
    assert_int_equal(parameter_find(rotor, "A.Width", &parameter, &unit), 0);
    assert_int_equal(parameter.kind, PARAMETER_EFFECT);
    assert_int_equal(parameter.index, 0);
    assert_int_equal(parameter.component, 2);
    assert_string_equal(unit, "m");
    assert_true(parameter_value(rotor, parameter) == &zone->value[2]);
    assert_int_equal(parameter_find(rotor, "a.depth_shear", &parameter, &unit), 2); /* one depth for both */
    zone->variant = 2;
    assert_int_equal(parameter_find(rotor, "a.depth_shear", &parameter, &unit), 0);
    assert_int_equal(parameter.component, 3);
    assert_int_equal(effect_parameters(zone), 4);
    assert_int_equal(parameter_find(rotor, "a.flexibility", &parameter, &unit), 2);
    assert_int_equal(parameter_find(rotor, "b.flexibility", &parameter, &unit), 1);
    assert_int_equal(parameter_find(rotor, "core.E", &parameter, &unit), 0);
    assert_int_equal(parameter.component, 0);
}

POOL_TEST(parameters_move_the_beams_own_copy_of_an_effect)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    struct effect *effect = bench_add(rotor, cause_density.effect, 1, 0, (double[]){1.1});
    struct parameter parameter = {PARAMETER_EFFECT, 0, 0, 0, NULL};
    struct beam beam;
    rotid_matrix k, m;
    bench_build(rotor, 1, &parameter, &beam);
    bench_matrices(&beam, (double[]){1.3}, &k, &m);
    assert_close(beam.rotor.effect[0].value[0], 1.3, 0, 0);
    assert_close(effect->value[0], 1.1, 0, 0);
}

POOL_TEST(no_memory_is_reported_at_every_allocation)
{
    struct rotor *rotor = bench_rotor(BUNDLE_TUBE, 1, 4);
    int status = ROTID_ERROR_MEMORY;
    bench_add(rotor, cause_joint.effect, 0, 0, (double[]){1e-9});
    bench_add(rotor, cause_density.effect, 1, 0, (double[]){1.1});
    for (int n = 1; status; n++) {
        struct failing_allocator failing;
        struct pool own;
        struct beam beam;
        int failed;
        failing_allocator_open(&failing, n);
        pool_open(&own, &failing.allocator);
        status = beam_build(&own, rotor, 0, NULL, 1, &beam, &failed);
        pool_close(&own);
        assert_int_equal(failing.in_use, 0);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        assert_true(n < 100);
    }
}
