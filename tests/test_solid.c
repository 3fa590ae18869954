/* The rotor as a solid of revolution: rigid motions and mass in closed form, patch tests, derivatives by differences. */
#include "dense.h"
#include "linalg/linalg.h"
#include "solid/solid.h"
#include "solid_rig.h"
#include "support.h"

/* ---- motions in closed form */

struct field { /* U, V, W at a place */
    double u, v, w;
};

static void take(const struct solid *solid, struct field (*field)(double r, double z), double *u)
{
    const struct solid_mesh *mesh = &solid->mesh;
    for (int n = 0; n < mesh->nnode; n++) {
        const struct solid_node *node = &mesh->node[n];
        struct field at = field(node->r, node->z);
        u[node->dof[0]] = at.u;
        if (node->r == 0)
            continue;
        u[node->dof[1]] = at.v;
        u[node->dof[2]] = at.w;
    }
    for (int i = 0; i < solid->rotor.ntierod + solid->rotor.nbars; i++)
        for (int l = 0; l <= mesh->nslice; l++) {
            int dof = *solid_mesh_member_dof(mesh, i, l);
            if (dof < 0)
                continue;
            u[dof] = (field(0, mesh->z[l]).u - field(0, mesh->z[l]).v) / 2;
            u[dof + 1] = field(1, mesh->z[l]).w;
        }
    for (int i = 0; i <= 2 * mesh->nslice; i++) /* a node that stands for a sensor moves as that does */
        u[mesh->node[mesh->surface[i]].dof[0]] = field(mesh->node[mesh->surface[i]].r, mesh->surface_z[i]).u;
}

static struct field translation(double r, double z)
{
    (void)r, (void)z;
    return (struct field){1, -1, 0};
}

static struct field rotation(double r, double z)
{
    return (struct field){-z, z, r};
}

static const double nu = 0.3;

static struct field bending(double r, double z) /* curvature 1, nu of the axial direction */
{
    return (struct field){-z * z / 2 - nu * r * r / 2, z * z / 2 - nu * r * r / 2, r * z};
}

static struct field shear(double r, double z)
{
    (void)r;
    return (struct field){z, -z, 0};
}

struct assembled {
    struct solid solid;
    rotid_matrix k, m;
    double *work;
};

static void assemble(const struct rotor *rotor, struct assembled *a)
{
    int failed;
    assert_status(solid_build(&test_pool, rotor, 0, NULL, NULL, 1, &a->solid, &failed), ROTID_OK);
    const struct solid_mesh *mesh = &a->solid.mesh;
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, a->solid.nfar, a->solid.far, &a->k), ROTID_OK);
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, a->solid.nfar, a->solid.far, &a->m), ROTID_OK);
    solid_assemble(&a->solid, NULL, &a->k, &a->m);
    a->work = POOL_ARRAY(&test_pool, double, 3 * mesh->ndof);
}

static double product(const struct assembled *a, const rotid_matrix *matrix, struct field (*x)(double, double),
                      struct field (*y)(double, double))
{
    int n = a->solid.mesh.ndof;
    double *u = a->work, *v = u + n;
    take(&a->solid, x, u);
    take(&a->solid, y, v);
    return matrix_product(matrix, u, v, v + n);
}

/* A rotor with steps, a layer, holes, sensors, disks and no springs. */
static void everything(struct rig *b)
{
    rig_rotor_a(b, 1);
    b->rotor.nspring = 0;
    b->rotor.ngroup = 4;
    b->group[3].layer_of = 1;
    b->group[3].material.rho = 8900;
    b->rotor.nring = 1;
    b->ring[0] = (struct ring){.group = 3, .segment = 3, .outer = 0.40, .inner = 0.36};
    b->group[1].holes = 8;
    b->group[1].hole_diameter = 0.03;
    b->group[1].hole_pitch = 0.12;
    b->segment[0].inner = 0.02;
    b->segment[6].stiff_outer = 0.12;
    b->rotor.ndisk = 1;
    b->disk[0] =
        (struct disk){.name = "fan", .position = 1.72, .mass = 20, .diametral = 0.3, .hub_length = 0.09, .hub_outer = 0.3};
    b->rotor.ntierod = 1;
    b->tierod[0] = (struct tierod){.name = "rods",
                                   .material = rig_steel,
                                   .from = 0.7,
                                   .to = 1.4,
                                   .model = BUNDLE_RODS,
                                   .self_equilibrated = 1,
                                   .number = 8,
                                   .elements = 4,
                                   .diameter = 0.025,
                                   .pitch = 0.12,
                                   .tension = 1e5};
    b->group[3].holes = 6;
    b->group[3].hole_diameter = 0.01;
    b->group[3].hole_pitch = 0.19;
    b->rotor.nbars = 1;
    b->bars[0] = (struct bars){.name = "bars",
                               .material = rig_steel,
                               .center = 1.05,
                               .length = 0.8,
                               .model = BUNDLE_RODS,
                               .number = 40,
                               .elements = 4,
                               .diameter = 0.015,
                               .pitch = 0.17};
    rig_sensors(b, 68);
}

POOL_TEST(rigid_motions_cost_nothing_and_weigh_what_the_parts_weigh)
{
    struct rig b;
    struct assembled a;
    struct mass_properties own;
    everything(&b);
    b.rotor.neffect = 1;
    b.effect[0] = (struct effect){.name = "less", .kind = rig_kind("added_inertia"), .target = 0, .value = {-0.2}};
    assemble(&b.rotor, &a);
    double scale = product(&a, &a.k, shear, shear), mass = product(&a, &a.m, translation, translation),
           first = -product(&a, &a.m, translation, rotation), second = product(&a, &a.m, rotation, rotation);
    assert_close(product(&a, &a.k, translation, translation), 0, 0, 1e-10 * scale);
    assert_close(product(&a, &a.k, rotation, rotation), 0, 0, 1e-10 * scale);
    solid_mass_properties(&a.solid, &own);
    assert_close(own.mass, mass, 1e-12, 0);
    assert_close(own.center, first / mass, 1e-12, 0);
    assert_close(own.inertia, second - first * first / mass, 1e-12, 0);
    assert_close(mass, rotor_mass(&b.rotor), 1e-12, 0);
}

POOL_TEST(uniform_strains_have_their_energy_exactly)
{
    struct rig b;
    struct assembled a;
    const double pi = 3.14159265358979323846, length = 0.5, d = 0.2, e = 0.9e11, g = 3e10;
    rig_begin(&b, 2);
    rig_section(&b, 0, 0.2, d);
    rig_section(&b, 1, 0.3, d);
    b.segment[0].inner = b.segment[1].inner = 0.05;
    b.group[0].material = b.group[1].material = (struct material){
        .name = "sheets", .e = e, .g = g, .nu = nu * 2.1e11 / e, .rho = 1, .laminated = 1, .sheet_e = 2.1e11, .stacking = 0.97};
    rig_sensors(&b, 7);
    assemble(&b.rotor, &a);
    double area = pi / 4 * (d * d - 0.0025), inertia = pi / 64 * (pow(d, 4) - pow(0.05, 4));
    assert_close(product(&a, &a.k, bending, bending), e * inertia * length, 1e-11, 0);
    assert_close(product(&a, &a.k, shear, shear), g * area * length, 1e-11, 0);
    assert_close(product(&a, &a.k, shear, translation), 0, 0, 1e-9 * g);
}

/* ---- derivatives */

/* Rows and columns from ... end - 1 of the band hold all there is; the block goes with all of them. */
static int zero_outside(const rotid_matrix *a, int from, int end)
{
    int zero = 1;
    for (int g = 0; g < a->nfar * a->nfar; g++)
        zero &= (from == 0 && end == a->n) || a->block[g] == 0;
    for (int j = 0; j < a->n; j++)
        for (int d = 0; d <= a->kd && j + d < a->n; d++)
            zero &= (j >= from && j + d < end) || a->band[d + (ptrdiff_t)j * (a->kd + 1)] == 0;
    return zero;
}

static double largest_difference(const rotid_matrix *a, const rotid_matrix *b) /* b: NULL for zero */
{
    double largest = 0;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)a->n * (a->kd + 1); i++)
        largest = fmax(largest, fabs(a->band[i] - (b ? b->band[i] : 0)));
    for (ptrdiff_t i = 0; i < (ptrdiff_t)a->nfar * a->nfar; i++)
        largest = fmax(largest, fabs(a->block[i] - (b ? b->block[i] : 0)));
    return largest;
}

/* Without the matrices, of five vectors at once, but for what moves more than elements: springs, masses, tie rods. */
static void check_products(const struct solid *solid, int p, const rotid_matrix *dk, const rotid_matrix *dm)
{
    enum { COUNT = 5 };
    struct random_stream stream = {20 + (unsigned)p};
    const struct parameter parameter = solid->parameter[p];
    const struct effect_kind *kind = parameter.kind == PARAMETER_EFFECT ? solid->rotor.effect[parameter.index].kind : NULL;
    int n = solid->mesh.ndof, from, end, elements = parameter.kind <= PARAMETER_RHO || (kind && kind->field);
    size_t length = (size_t)n * COUNT;
    double *u = random_numbers(&test_pool, &stream, (ptrdiff_t)length), *expected = numbers(&test_pool, (ptrdiff_t)length),
           *dk_u = POOL_ARRAY(&test_pool, double, length), *dm_u = POOL_ARRAY(&test_pool, double, length);
    int refused = solid_derivative_products(solid, p, COUNT, u, dk_u, dm_u, &from, &end);
    assert_true(!elements || !refused);
    for (int i = 0; i < 2 && !refused; i++) {
        const double *own = i ? dm_u : dk_u;
        matrix_multiply(i ? dm : dk, COUNT, u, expected);
        assert_true(relative_difference(length, own, expected) < 1e-12);
        for (int row = 0; row < n; row++)
            assert_true((row >= from && row < end) || own[row] == 0);
    }
}

/* V'A V of the mesh beside that of a basis, a full matrix */
static void check_congruence(const rotid_matrix *a, int count, const double *v, const rotid_matrix *in_basis)
{
    double *image = numbers(&test_pool, (ptrdiff_t)count * a->n), *expected = numbers(&test_pool, (ptrdiff_t)count * count),
           *full = numbers(&test_pool, (ptrdiff_t)count * count);
    matrix_multiply(a, count, v, image);
    product_transposed(count, count, a->n, v, image, expected);
    matrix_to_dense(in_basis, count, full);
    assert_true(relative_difference((size_t)count * (size_t)count, full, expected) < 1e-11);
}

/* The basis made at x, matrices and derivatives where x_p is another one: zones, springs and masses have moved on. */
static void check_basis(struct solid *solid, int p, double *x)
{
    enum { COUNT = 5 };
    struct random_stream stream = {40 + (unsigned)p};
    struct solid_basis basis;
    rotid_matrix a[4], own[4];
    int n = solid->mesh.ndof, from, end;
    double *v = random_numbers(&test_pool, &stream, (ptrdiff_t)n * COUNT), at = x[p];
    for (int i = 0; i < 4; i++) {
        assert_status(matrix_new(&test_pool, n, solid->mesh.kd, solid->nfar, solid->far, &a[i]), ROTID_OK);
        assert_status(matrix_new(&test_pool, COUNT, COUNT - 1, 0, NULL, &own[i]), ROTID_OK);
    }
    solid_set(solid, x);
    assert_status(solid_basis_new(&test_pool, solid, COUNT, v, &basis), ROTID_OK);
    x[p] *= 1.06;
    solid_assemble(solid, x, &a[0], &a[1]);
    solid_differentiate(solid, p, &a[2], &a[3], &from, &end);
    solid_basis_differentiate(&basis, x, p, &own[2], &own[3]);
    solid_basis_assemble(&basis, x, &own[0], &own[1]);
    for (int i = 0; i < 4; i++)
        check_congruence(&a[i], COUNT, v, &own[i]);
    x[p] = at;
}

POOL_TEST(derivatives_agree_with_differences)
{
    static const char *const names[] = {"core.E",
                                        "core.G",
                                        "core.nu",
                                        "core.rho",
                                        "left.E",
                                        "left.nu",
                                        "ring.E",
                                        "rods.E",
                                        "rods.tension",
                                        "fan.mass",
                                        "fan.inertia",
                                        "spring.k",
                                        "spring.k_rot",
                                        "zone.depth",
                                        "zone.z",
                                        "zone.width",
                                        "add.mass",
                                        "add.z",
                                        "joint.flexibility",
                                        "slope.slope",
                                        "profile.profile",
                                        "dense.factor",
                                        "soft.factor",
                                        "tie_e.factor",
                                        "tie_t.factor",
                                        "away.shift",
                                        "extra.stiffness",
                                        "extra.z",
                                        "turn.stiffness",
                                        "turn.z",
                                        "clamp.rotational",
                                        "clamp.lateral",
                                        "wide.mass",
                                        "wide.z",
                                        "wide.width",
                                        "inert.inertia",
                                        "hubs.share",
                                        "slip.transfer"};
    static const struct effect effects[] = {{.name = "zone", .target = -1, .value = {0.4, 1.0, 0.05}},
                                            {.name = "add", .target = -1, .value = {3, 1.113}},
                                            {.name = "joint", .target = 0, .value = {2e-9}},
                                            {.name = "slope", .target = 1, .value = {0.3}},
                                            {.name = "profile", .target = 1, .value = {0.2}},
                                            {.name = "dense", .target = 3, .value = {1.1}},
                                            {.name = "soft", .target = 0, .value = {0.8}},
                                            {.name = "tie_e", .target = 0, .value = {0.9}},
                                            {.name = "tie_t", .target = 0, .value = {1.2}},
                                            {.name = "away", .target = 0, .value = {0.037}},
                                            {.name = "extra", .target = -1, .value = {3e6, 0.917}},
                                            {.name = "turn", .target = -1, .value = {2e5, 1.311}},
                                            {.name = "clamp", .target = 0, .value = {3e-6, 2e-7}},
                                            {.name = "wide", .target = -1, .variant = 1, .value = {4, 1.07, 0.21}},
                                            {.name = "inert", .target = 0, .value = {-0.2}},
                                            {.name = "hubs", .target = -1, .value = {0.57}},
                                            {.name = "slip", .target = 3, .value = {0.08}}};
    static const char *const kinds[] = {
        "stiffness_local", "added_mass",    "joint",         "stiffness_gradient", "stiffness_profile", "density",
        "stiffness",       "tie_stiffness", "tie_tension",   "support_position",   "support_extra",     "support_rotation",
        "clamp",           "added_mass",    "added_inertia", "hub_stiffness",      "layer_slip"};
    struct rig b;
    enum { COUNT = sizeof names / sizeof *names };
    struct parameter parameter[COUNT];
    double x[COUNT];
    const char *unit;
    everything(&b);
    b.group[0].name = "left";
    b.group[1].name = "core";
    b.group[2].name = "right";
    b.group[3].name = "ring";
    b.rotor.nspring = 1;
    b.spring[0] = (struct spring){"spring", 0.1, 1e6, 1e5, 0, 0};
    for (int i = 0; i < (int)(sizeof effects / sizeof *effects); i++) {
        b.effect[b.rotor.neffect] = effects[i];
        b.effect[b.rotor.neffect++].kind = rig_kind(kinds[i]);
    }
    for (int p = 0; p < COUNT; p++) {
        assert_int_equal(parameter_find(&b.rotor, names[p], &parameter[p], &unit), 0);
        x[p] = *parameter_value(&b.rotor, parameter[p]);
    }
    for (int p = 0; p < COUNT; p++) {
        struct solid solid;
        rotid_matrix k[2], m[2], dk, dm;
        int failed, from, end;
        assert_status(solid_build(&test_pool, &b.rotor, COUNT, parameter, &(struct solid_rule){.corner = 0.03, .largest = 0.15},
                                  1, &solid, &failed),
                      ROTID_OK);
        rotid_matrix *all[] = {&k[0], &k[1], &m[0], &m[1], &dk, &dm};
        for (int i = 0; i < 6; i++)
            assert_status(matrix_new(&test_pool, solid.mesh.ndof, solid.mesh.kd, solid.nfar, solid.far, all[i]), ROTID_OK);
        double h = (strstr(names[p], ".z") ? 1e-5 : 1e-4) * fabs(x[p]), at = x[p];
        for (int side = 0; side < 2; side++) {
            x[p] = at + (2 * side - 1) * h;
            solid_assemble(&solid, x, &k[side], &m[side]);
        }
        x[p] = at;
        solid_set(&solid, x);
        solid_differentiate(&solid, p, &dk, &dm, &from, &end);
        if (!zero_outside(&dk, from, end) || !zero_outside(&dm, from, end))
            fail_msg("parameter %d moves more than rows %d to %d", p, from, end - 1);
        check_products(&solid, p, &dk, &dm);
        check_basis(&solid, p, x);
        double scale_k = largest_difference(&k[0], NULL) * 1e-9 / h, scale_m = largest_difference(&m[0], NULL) * 1e-9 / h;
        matrix_combine(0.5 / h, &k[1], -0.5 / h, &k[0], &k[0]);
        matrix_combine(0.5 / h, &m[1], -0.5 / h, &m[0], &m[0]);
        double ek = largest_difference(&k[0], &dk), em = largest_difference(&m[0], &dm), sk = largest_difference(&dk, NULL),
               sm = largest_difference(&dm, NULL);
        if (sk + sm == 0 || ek > 2e-6 * sk + 1e-3 * scale_k || em > 2e-6 * sm + 1e-3 * scale_m)
            fail_msg("%s: dK off by %.2e of %.2e, dM by %.2e of %.2e", names[p], ek, sk, em, sm);
    }
}

/* Motions of the coarse mesh on the finer one: a translation as it is, others but for the elements at corners, whose nodes are
 * not half-way. */
POOL_TEST(a_motion_is_carried_to_a_finer_mesh)
{
    struct field (*const fields[])(double, double) = {translation, rotation, bending};
    const double off[] = {1e-12, 2e-3, 2e-3}; /* of the length of the motion in M */
    struct rig b;
    struct assembled fine;
    struct solid coarse;
    int failed;
    everything(&b);
    assemble(&b.rotor, &fine);
    assert_status(solid_build(&test_pool, &b.rotor, 0, NULL, NULL, 0, &coarse, &failed), ROTID_OK);
    int n = fine.solid.mesh.ndof;
    assert_true(coarse.mesh.ndof < n);
    double *u = POOL_ARRAY(&test_pool, double, coarse.mesh.ndof), *v = fine.work, *expected = v + n, *image = expected + n;
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++) {
        take(&coarse, fields[f], u);
        take(&fine.solid, fields[f], expected);
        solid_transfer(&coarse, u, &fine.solid, v);
        double length = matrix_product(&fine.m, expected, expected, image);
        for (int i = 0; i < n; i++)
            v[i] -= expected[i];
        double square = matrix_product(&fine.m, v, v, image);
        assert_true(sqrt(fmax(square, 0) / length) < off[f]);
    }
}
