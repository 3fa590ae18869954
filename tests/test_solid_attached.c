/* What is attached to a solid beside the same on a beam, on rotors so slender that both agree; sensors; limits of the mesh. */
#include "exact.h"
#include "linalg/linalg.h"
#include "solid/solid.h"
#include "solid_rig.h"
#include "support.h"

#define MODES 3

static void slender(struct rig *b, int ngroup)
{
    rig_begin(b, ngroup);
    for (int g = 0; g < ngroup; g++)
        rig_section(b, g, 2.4 / ngroup, 0.08);
}

/* Solid over beam within rtol of that ratio without what is attached. */
static void compare(const struct rig *plain, const struct rig *b, double rtol)
{
    double solid[MODES], beam[MODES], plain_solid[MODES], plain_beam[MODES];
    rig_solid(&plain->rotor, NULL, 1, 2, MODES, plain_solid);
    limit_hz(&plain->rotor, 4, 2, MODES, plain_beam);
    rig_solid(&b->rotor, NULL, 1, 2, MODES, solid);
    limit_hz(&b->rotor, 4, 2, MODES, beam);
    for (int j = 0; j < MODES; j++) {
        print_message("  mode %d: solid moves by %+.5f, beam by %+.5f\n", j + 1, solid[j] / plain_solid[j] - 1,
                      beam[j] / plain_beam[j] - 1);
        assert_close(solid[j] / plain_solid[j], beam[j] / plain_beam[j], rtol, 0);
    }
}

POOL_TEST(disks_and_springs_act_as_on_a_beam)
{
    struct rig plain, b;
    slender(&plain, 1);
    slender(&b, 1);
    b.rotor.ndisk = 1;
    b.disk[0] = (struct disk){.name = "fan", .position = 0.7, .mass = 20, .diametral = 0.3};
    rig_springs(&b, 2e6, 5e6);
    b.spring[0].position = 0.4;
    b.spring[0].rotational = 3e5;
    compare(&plain, &b, 2e-3);
}

POOL_TEST(masses_and_joints_act_as_on_a_beam)
{
    struct rig plain, b;
    slender(&plain, 2);
    slender(&b, 2);
    b.rotor.neffect = 1;
    b.effect[0] = (struct effect){.name = "add", .kind = rig_kind("added_mass"), .target = -1, .value = {8, 0.613}};
    compare(&plain, &b, 1e-3);
    b.effect[0] = (struct effect){.name = "joint", .kind = rig_kind("joint"), .target = 0, .value = {2e-6}};
    compare(&plain, &b, 2e-3);
    for (int way = 0; way < 2; way++) { /* a step */
        for (int s = 0; s < 2; s++)
            plain.segment[s].outer = plain.segment[s].stiff_outer = b.segment[s].outer = b.segment[s].stiff_outer =
                s == way ? 0.09 : 0.06;
        compare(&plain, &b, 5e-3);
    }
}

/* Away from a line a solid has them by rigid pieces of the sections on either side. */
POOL_TEST(springs_anywhere_act_as_on_a_beam)
{
    static const struct {
        const char *id;
        int target;
        double value[3];
    } cause[] = {{"support_extra", -1, {3e6, 0.613}}, {"support_rotation", -1, {4e5, 0.613}},
                 {"support_position", 0, {0.213}},    {"clamp", 0, {2e-6, 1e-7}},
                 {"added_inertia", 0, {0.4}},         {"hub_stiffness", -1, {0.8}}};
    for (size_t i = 0; i < sizeof cause / sizeof *cause; i++) {
        struct rig plain, b;
        slender(&plain, 1);
        slender(&b, 1);
        for (int with = 0; with < 2; with++) {
            struct rig *r = with ? &b : &plain;
            r->rotor.ndisk = 1;
            r->disk[0] =
                (struct disk){.name = "fan", .position = 1.7, .mass = 20, .diametral = 0.3, .hub_length = 0.2, .hub_outer = 0.16};
            rig_springs(r, 4e6, 5e6);
            r->spring[0].position = 0.4;
            r->spring[0].rotational = 3e5;
        }
        b.rotor.neffect = 1;
        b.effect[0] = (struct effect){.name = "c", .kind = rig_kind(cause[i].id), .target = cause[i].target};
        memcpy(b.effect[0].value, cause[i].value, sizeof cause[i].value);
        print_message("%s\n", cause[i].id);
        compare(&plain, &b, 3e-3);
    }
}

/* A cause may put a spring anywhere, so neutral has to be the spring of the deck to the last digit. */
POOL_TEST(a_spring_that_did_not_move_is_that_of_the_deck)
{
    struct rig b;
    double plain[MODES], with[MODES];
    slender(&b, 1);
    rig_springs(&b, 4e6, 5e6);
    b.spring[0].position = 0.4123;
    rig_solid(&b.rotor, NULL, 1, 2, MODES, plain);
    b.rotor.neffect = 1;
    b.effect[0] = (struct effect){.name = "c", .kind = rig_kind("support_position"), .target = 0};
    rig_solid(&b.rotor, NULL, 1, 2, MODES, with);
    for (int j = 0; j < MODES; j++)
        assert_close(with[j], plain[j], 1e-10, 0);
}

/* Beside a line too: of a motion of the whole rotor, v = a - b z, it takes up k v^2 where it is, and k_rot b^2. */
POOL_TEST(a_spring_holds_its_point)
{
    const double at = 0.4123 + 0.0171, motion[3][2] = {{1, 0}, {0, 1}, {at, 1}};
    struct rig b;
    struct solid solid;
    rotid_matrix k, m;
    int failed;
    slender(&b, 1);
    rig_springs(&b, 4e6, 0);
    b.spring[0].position = 0.4123;
    b.spring[0].rotational = 3e5;
    b.rotor.neffect = 1;
    b.effect[0] = (struct effect){.name = "c", .kind = rig_kind("support_position"), .target = 0, .value = {0.0171}};
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, NULL, 1, &solid, &failed), ROTID_OK);
    int n = solid.mesh.ndof;
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &m), ROTID_OK);
    solid_assemble(&solid, NULL, &k, &m);
    double *u = POOL_ARRAY(&test_pool, double, 4 * n), *whole = u + 2 * (ptrdiff_t)n;
    solid_rigid_motions(&solid, u);
    for (int i = 0; i < 3; i++) {
        for (int d = 0; d < n; d++)
            whole[d] = motion[i][0] * u[d] + motion[i][1] * u[n + d];
        double v = motion[i][0] - motion[i][1] * at;
        assert_close(matrix_product(&k, whole, whole, whole + n), 4e6 * v * v + 3e5 * motion[i][1] * motion[i][1], 1e-7, 0);
    }
}

static void rods(struct rig *b, int elements, double tension)
{
    b->rotor.ntierod = 1;
    b->tierod[0] = (struct tierod){.name = "rods",
                                   .material = rig_steel,
                                   .from = 0.8,
                                   .to = 1.4,
                                   .model = BUNDLE_RODS,
                                   .self_equilibrated = 1,
                                   .number = 8,
                                   .elements = elements,
                                   .diameter = 0.01,
                                   .pitch = 0.025,
                                   .tension = tension};
}

/* Of several elements they bend by themselves; of one they follow the section, and in a beam have their mass at their ends:
 * without mass, both are a spring between the ends. Tension and what it presses together cancel where rods follow, and a beam's
 * bow. */
POOL_TEST(tie_rods_act_as_on_a_beam)
{
    static const double tension[] = {0, 2e4};
    struct rig plain, b;
    for (int t = 0; t < 2; t++) {
        slender(&plain, 1);
        slender(&b, 1);
        rods(&b, 12, tension[t]);
        compare(&plain, &b, 3e-3);
    }
    slender(&b, 1);
    rods(&b, 1, 0);
    b.tierod[0].material.rho = 1;
    compare(&plain, &b, 3e-3);
}

/* Tension of rods that follow is balanced by what it presses together, however large; of rods that press elsewhere it is a
 * tension of the axis. */
POOL_TEST(tension_of_rods_that_follow_is_that_of_the_axis)
{
    struct rig b;
    double loose[4], tight[4], pulled[4];
    slender(&b, 3);
    rods(&b, 1, 0);
    rig_solid(&b.rotor, NULL, 1, 2, 4, loose);
    b.tierod[0].tension = 1e6;
    rig_solid(&b.rotor, NULL, 1, 2, 4, tight);
    assert_hz(4, tight, loose, 1e-9);
    b.tierod[0].from = 0;
    b.tierod[0].to = rotor_length(&b.rotor);
    b.tierod[0].self_equilibrated = 0;
    rig_solid(&b.rotor, NULL, 1, 2, 4, tight);
    b.tierod[0].tension = 0;
    for (int g = 0; g < 3; g++)
        b.group[g].preload = 8e6;
    rig_solid(&b.rotor, NULL, 1, 2, 4, pulled);
    assert_hz(4, tight, pulled, 1e-9);
    assert_true(tight[0] > 1.01 * loose[0]);
}

POOL_TEST(axial_force_acts_as_in_a_beam)
{
    struct rig plain, b;
    slender(&plain, 2);
    slender(&b, 2);
    b.group[0].preload = 5e4;
    b.group[1].preload = 5e4;
    compare(&plain, &b, 2e-3);
}

POOL_TEST(holes_bores_and_bars_act_as_in_a_beam)
{
    struct rig plain, b;
    slender(&plain, 1);
    slender(&b, 1);
    b.segment[0].inner = 0.03;
    compare(&plain, &b, 1e-3);
    b.segment[0].inner = 0;
    b.group[0].holes = 6;
    b.group[0].hole_diameter = 0.012;
    b.group[0].hole_pitch = 0.025;
    compare(&plain, &b, 2e-3);
    b.group[0].holes = 0;
    b.rotor.nbars = 1;
    b.bars[0] = (struct bars){.name = "bars",
                              .material = rig_steel,
                              .center = 0.8,
                              .length = 0.6,
                              .model = BUNDLE_RODS,
                              .number = 12,
                              .elements = 12,
                              .diameter = 0.008,
                              .pitch = 0.03};
    compare(&plain, &b, 2e-3);
}

/* ---- sensors */

struct solved {
    struct solid solid;
    double *lambda, *phi;
};

static void solve(const struct rotor *rotor, struct solved *s)
{
    struct eigen_band eigen;
    rotid_matrix k, m;
    int failed, count = 2 + MODES;
    assert_status(solid_build(&test_pool, rotor, 0, NULL, NULL, 1, &s->solid, &failed), ROTID_OK);
    int n = s->solid.mesh.ndof;
    assert_status(matrix_new(&test_pool, n, s->solid.mesh.kd, s->solid.nfar, s->solid.far, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, n, s->solid.mesh.kd, s->solid.nfar, s->solid.far, &m), ROTID_OK);
    s->lambda = POOL_ARRAY(&test_pool, double, count);
    s->phi = POOL_ARRAY(&test_pool, double, count *n);
    solid_assemble(&s->solid, NULL, &k, &m);
    assert_status(eigen_band_new(&test_pool, &k, count, &eigen), ROTID_OK);
    assert_status(eigen_band_solve(&eigen, &k, &m, s->lambda, s->phi), ROTID_OK);
}

static double surface(const struct solved *s, int mode, double z)
{
    int dof[SURFACE_MOST + 3];
    double weight[SURFACE_MOST + 3];
    struct motion motion;
    motion_of_surface(&s->solid.mesh, z, 0, 0, dof, weight, &motion);
    return motion_value(&motion, s->phi + (ptrdiff_t)mode * s->solid.mesh.ndof);
}

POOL_TEST(a_sensor_inside_an_element_moves_with_its_surface)
{
    struct rig b;
    struct solved without, with;
    rig_two_steps(&b);
    solve(&b.rotor, &without);
    const struct solid_mesh *mesh = &without.solid.mesh;
    for (int i = 0; i < mesh->nslice; i += 2) /* in every other slice, where they move no line */
        b.sensor[b.rotor.nsensor++] = (struct sensor){i + 1, mesh->z[i] + (0.4 + 0.2 * (i % 3)) * (mesh->z[i + 1] - mesh->z[i])};
    solve(&b.rotor, &with);
    int inside = 0, same = with.solid.mesh.nslice == mesh->nslice;
    for (int i = 0; i <= mesh->nslice && same; i++)
        same = with.solid.mesh.z[i] == mesh->z[i];
    for (int e = 0; e < with.solid.mesh.nelement; e++)
        inside += with.solid.mesh.element[e].sensor >= 0;
    print_message("%d of %d sensors inside, lines %s\n", inside, b.rotor.nsensor, same ? "kept" : "moved");
    assert_true(inside > 0);
    for (int j = 2; j < 2 + MODES; j++) {
        double scale = surface(&without, j, 0) / surface(&with, j, 0), most = fabs(surface(&without, j, 0));
        assert_close(with.lambda[j], without.lambda[j], same ? 1e-8 : 2e-4, 0);
        for (int s = 0; s < b.rotor.nsensor; s++) {
            double u = with.phi[with.solid.mesh.sensor_dof[s] + (ptrdiff_t)j * with.solid.mesh.ndof];
            assert_close(u, surface(&with, j, b.sensor[s].position), 0, 1e-9 * fabs(most / scale));
            assert_close(u * scale, surface(&without, j, b.sensor[s].position), 0, (same ? 1e-7 : 1e-3) * most);
        }
    }
}

POOL_TEST(sensors_do_not_move_frequencies)
{
    static const int count[] = {1, 68, 500};
    struct rig b;
    double hz[4], with[4];
    rig_two_steps(&b);
    rig_solid(&b.rotor, NULL, 1, 2, 4, hz);
    for (int i = 0; i < 3; i++) {
        rig_sensors(&b, count[i]);
        int n = rig_solid(&b.rotor, NULL, 1, 2, 4, with);
        print_message("%d sensors, %d unknowns: largest change %.1e\n", count[i], n, worst_ratio(4, with, hz));
        assert_hz(4, with, hz, 2e-4);
    }
}

POOL_TEST(sensors_at_steps_at_ends_and_close_together_are_distinct)
{
    static const double at[] = {0, 0.001, 0.002, 0.299, 0.3, 0.301, 0.4501, 0.4511, 0.4521, 0.4531, 0.599, 0.6, 0.899, 0.9};
    enum { COUNT = sizeof at / sizeof *at };
    struct rig b;
    struct solved s;
    rig_two_steps(&b);
    for (int i = 0; i < COUNT; i++)
        b.sensor[b.rotor.nsensor++] = (struct sensor){i + 1, at[i]};
    solve(&b.rotor, &s);
    for (int i = 0; i < COUNT; i++) {
        for (int j = 0; j < i; j++)
            assert_int_not_equal(s.solid.mesh.sensor_dof[i], s.solid.mesh.sensor_dof[j]);
        double u = s.phi[s.solid.mesh.sensor_dof[i] + (ptrdiff_t)2 * s.solid.mesh.ndof];
        assert_close(u, surface(&s, 2, at[i] == 0.6 ? 0.6 - 1e-9 : at[i]), 0,
                     1e-3 * fabs(surface(&s, 2, 0))); /* 0.01 of a slice is taken to be a line */
    }
}

/* ---- dimensions */

POOL_TEST(extreme_dimensions_are_solved)
{
    static const double size[] = {1e-3, 1, 100};
    struct rig b;
    double hz[3], first = 0;
    for (int i = 0; i < 3; i++) { /* frequencies of a similar rotor fall with its size */
        rig_begin(&b, 1);
        for (int s = 0; s < 3; s++)
            rig_section(&b, 0, size[i], size[i] * (s == 1 ? 0.5 : 0.3));
        rig_solid(&b.rotor, NULL, 1, 2, 3, hz);
        first = i ? first : hz[0] * size[i];
        assert_close(hz[0] * size[i], first, 1e-6, 0);
    }
    rig_begin(&b, 1); /* step ratios of 1.001 and 10, a section of 0.1 mm */
    static const double length[] = {0.3, 0.3, 1e-4, 0.3}, diameter[] = {0.1, 0.1001, 0.2, 0.02};
    for (int s = 0; s < 4; s++)
        rig_section(&b, 0, length[s], diameter[s]);
    int n = rig_solid(&b.rotor, NULL, 1, 2, 3, hz);
    print_message("%d unknowns: %.2f %.2f %.2f\n", n, hz[0], hz[1], hz[2]);
    assert_true(n < 8000 && hz[0] > 0 && isfinite(hz[2]));
    rig_begin(&b, 1);
    rig_section(&b, 0, 100, 1);
    struct exact exact;
    double beam[3];
    exact_open(&b.rotor, &exact);
    exact_hz(&exact, 3, 3, beam);
    rig_solid(&b.rotor, NULL, 1, 2, 3, hz);
    assert_hz(3, hz, beam, 1e-3);
}

POOL_TEST(what_has_no_meaning_is_refused_with_its_place)
{
    struct rig b;
    struct solid solid;
    int failed;
    slender(&b, 2);
    b.segment[1].rectangular = 1;
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, NULL, 1, &solid, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, 1);
    slender(&b, 2);
    b.segment[1].inner = 0.08;
    b.segment[1].outer = b.segment[1].stiff_outer = 0.1;
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, NULL, 1, &solid, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, 1);
    slender(&b, 2);
    rods(&b, 1, 0);
    b.tierod[0].pitch = 0.06;
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, NULL, 1, &solid, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, 2);
    slender(&b, 1);
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, &(struct solid_rule){.largest = 2e-4}, 1, &solid, &failed),
                  ROTID_ERROR_SECTION);
    assert_int_equal(failed, 1);
}
