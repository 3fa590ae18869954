/* The rotor as a solid of revolution: frequencies of converged references, rigid motions and mass in closed form, patch tests,
 * derivatives by differences. */
#include <math.h>
#include <string.h>

#include "diagnose/causes/catalogue.h"
#include "linalg/eigen.h"
#include "linalg/matrix.h"
#include "model/model.h"
#include "support.h"

static const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};

/* ---- rotors */

#define MOST 8

struct bench {
    struct group group[MOST];
    struct segment segment[MOST];
    struct ring ring[MOST];
    struct spring spring[2];
    struct sensor sensor[80];
    struct disk disk[2];
    struct tierod tierod[2];
    struct bars bars[1];
    struct effect effect[2];
    struct rotor rotor;
};

static void section(struct bench *b, int group, double length, double diameter)
{
    b->segment[b->rotor.nsegment++] =
        (struct segment){.group = group, .elements = 10, .length = length, .outer = diameter, .stiff_outer = diameter};
}

static void begin(struct bench *b, int ngroup)
{
    *b = (struct bench){0};
    for (int g = 0; g < MOST; g++)
        b->group[g] = (struct group){.name = "part", .material = steel, .layer_of = -1};
    b->rotor = (struct rotor){.ngroup = ngroup,
                              .group = b->group,
                              .segment = b->segment,
                              .ring = b->ring,
                              .tierod = b->tierod,
                              .bars = b->bars,
                              .disk = b->disk,
                              .spring = b->spring,
                              .sensor = b->sensor,
                              .effect = b->effect};
}

static void springs(struct bench *b, double left, double right)
{
    b->rotor.nspring = 2;
    b->spring[0] = (struct spring){.name = "left", .position = 0, .lateral = left};
    b->spring[1] = (struct spring){.name = "right", .position = rotor_length(&b->rotor), .lateral = right};
}

static void two_steps(struct bench *b)
{
    begin(b, 1);
    section(b, 0, 0.3, 0.1);
    section(b, 0, 0.3, 0.2);
    section(b, 0, 0.3, 0.1);
    springs(b, 9000, 9000);
}

static const struct material stack = {
    .name = "stack", .e = 1.05e11, .g = 4.7e10, .nu = 0.28, .rho = 7650, .laminated = 1, .sheet_e = 1.9e11, .stacking = 1};

/* rotor A of design notes: constants in input/.../README */
static void rotor_a(struct bench *b, int laminated)
{
    static const double length[] = {0.25, 0.25, 0.2, 0.7, 0.2, 0.23, 0.2}, diameter[] = {0.14, 0.2, 0.26, 0.36, 0.26, 0.18, 0.13};
    begin(b, 3);
    for (int s = 0; s < 7; s++)
        section(b, s < 3 ? 0 : s == 3 ? 1 : 2, length[s], diameter[s]);
    if (laminated)
        b->group[1].material = stack;
    springs(b, 9790, 2000);
}

/* ---- frequencies */

static void solve(const struct rotor *rotor, const struct solid_rule *rule, int refine, int count, double *hz, int *ndof)
{
    struct solid solid;
    struct eigen_band eigen;
    rotid_matrix k, m;
    int failed;
    assert_status(solid_build(&test_pool, rotor, 0, NULL, rule, refine, &solid, &failed), ROTID_OK);
    int n = solid.mesh.ndof;
    double *lambda = POOL_ARRAY(&test_pool, double, count + 2), *phi = POOL_ARRAY(&test_pool, double, n *(count + 2));
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &m), ROTID_OK);
    solid_assemble(&solid, NULL, &k, &m);
    assert_status(eigen_band_new(&test_pool, &k, count + 2, &eigen), ROTID_OK);
    assert_status(eigen_band_solve(&eigen, &k, &m, lambda, phi), ROTID_OK);
    for (int j = 0; j < count; j++)
        hz[j] = sqrt(lambda[j + 2]) / (2 * 3.14159265358979323846);
    *ndof = n;
    print_message("%d unknowns, half band %d, %d slices:", n, solid.mesh.kd, solid.mesh.nslice);
    for (int j = 0; j < count; j++)
        print_message(" %.3f", hz[j]);
    print_message("\n");
}

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
    for (int s = 0; s < solid->rotor.nsensor; s++) {
        int slice = solid_mesh_slice(mesh, solid->rotor.sensor[s].position);
        u[mesh->sensor_dof[s]] = field(mesh->node[mesh->surface[2 * slice + 1]].r, solid->rotor.sensor[s].position).u;
    }
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

static void sensors(struct bench *b, int count)
{
    double length = rotor_length(&b->rotor);
    b->rotor.nsensor = count;
    for (int s = 0; s < count; s++)
        b->sensor[s] = (struct sensor){s + 1, length * (s + 0.13) / count};
}

/* A rotor with steps, a layer, holes, sensors, disks and no springs. */
static void everything(struct bench *b)
{
    rotor_a(b, 1);
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
    b->disk[0] = (struct disk){.name = "fan", .position = 1.72, .mass = 20, .diametral = 0.3};
    b->rotor.ntierod = 1;
    b->tierod[0] = (struct tierod){.name = "rods",
                                   .material = steel,
                                   .from = 0.7,
                                   .to = 1.4,
                                   .model = BUNDLE_RODS,
                                   .self_equilibrated = 1,
                                   .number = 8,
                                   .elements = 4,
                                   .diameter = 0.025,
                                   .pitch = 0.12,
                                   .tension = 0};
    b->rotor.nbars = 1;
    b->bars[0] = (struct bars){.name = "bars",
                               .material = steel,
                               .center = 1.05,
                               .length = 0.8,
                               .model = BUNDLE_RODS,
                               .number = 40,
                               .elements = 4,
                               .diameter = 0.015,
                               .pitch = 0.17};
    sensors(b, 68);
}

static void rigid_motions_cost_nothing_and_weigh_what_the_parts_weigh(void **state)
{
    struct bench b;
    struct assembled a;
    struct mass_properties own;
    (void)state;
    everything(&b);
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

static void uniform_strains_have_their_energy_exactly(void **state)
{
    struct bench b;
    struct assembled a;
    const double pi = 3.14159265358979323846, length = 0.5, d = 0.2, e = 0.9e11, g = 3e10;
    (void)state;
    begin(&b, 2);
    section(&b, 0, 0.2, d);
    section(&b, 1, 0.3, d);
    b.segment[0].inner = b.segment[1].inner = 0.05;
    b.group[0].material = b.group[1].material = (struct material){
        .name = "sheets", .e = e, .g = g, .nu = nu * 2.1e11 / e, .rho = 1, .laminated = 1, .sheet_e = 2.1e11, .stacking = 0.97};
    sensors(&b, 7);
    assemble(&b.rotor, &a);
    double area = pi / 4 * (d * d - 0.0025), inertia = pi / 64 * (pow(d, 4) - pow(0.05, 4));
    assert_close(product(&a, &a.k, bending, bending), e * inertia * length, 1e-11, 0);
    assert_close(product(&a, &a.k, shear, shear), g * area * length, 1e-11, 0);
    assert_close(product(&a, &a.k, shear, translation), 0, 0, 1e-9 * g);
}

/* ---- derivatives */

static const struct effect_kind *kind_of(const char *id)
{
    return catalogue_find(id)->effect;
}

static double largest_entry(const rotid_matrix *a)
{
    double largest = 0;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)a->n * (a->kd + 1); i++)
        largest = fmax(largest, fabs(a->band[i]));
    return largest;
}

static double difference(const rotid_matrix *a, const rotid_matrix *b)
{
    double largest = 0;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)a->n * (a->kd + 1); i++)
        largest = fmax(largest, fabs(a->band[i] - b->band[i]));
    return largest;
}

static void derivatives_agree_with_differences(void **state)
{
    static const char *const names[] = {"core.E",       "core.G",     "core.nu",      "core.rho",   "left.E",      "left.nu",
                                        "ring.E",       "rods.E",     "rods.tension", "fan.mass",   "fan.inertia", "spring.k",
                                        "spring.k_rot", "zone.depth", "zone.z",       "zone.width", "add.mass",    "add.z"};
    struct bench b;
    enum { COUNT = sizeof names / sizeof *names };
    struct parameter parameter[COUNT];
    double x[COUNT];
    const char *unit;
    (void)state;
    everything(&b);
    b.group[0].name = "left";
    b.group[1].name = "core";
    b.group[2].name = "right";
    b.group[3].name = "ring";
    b.tierod[0].tension = 1e5;
    b.rotor.nspring = 1;
    b.spring[0] = (struct spring){"spring", 0.1, 1e6, 1e5};
    b.rotor.neffect = 2;
    b.effect[0] = (struct effect){.name = "zone", .kind = kind_of("stiffness_local"), .target = -1, .value = {0.4, 1.0, 0.05}};
    b.effect[1] = (struct effect){.name = "add", .kind = kind_of("added_mass"), .target = -1, .value = {3, 1.113}};
    for (int p = 0; p < COUNT; p++) {
        assert_int_equal(parameter_find(&b.rotor, names[p], &parameter[p], &unit), 0);
        x[p] = *parameter_value(&b.rotor, parameter[p]);
    }
    for (int p = 0; p < COUNT; p++) {
        struct solid solid;
        rotid_matrix k[2], m[2], dk, dm;
        int failed;
        assert_status(
            solid_build(&test_pool, &b.rotor, COUNT, parameter, &(struct solid_rule){0.03, 0.15, 0}, 1, &solid, &failed),
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
        solid_differentiate(&solid, p, &dk, &dm);
        double scale_k = largest_entry(&k[0]) * 1e-9 / h, scale_m = largest_entry(&m[0]) * 1e-9 / h;
        matrix_combine(0.5 / h, &k[1], -0.5 / h, &k[0], &k[0]);
        matrix_combine(0.5 / h, &m[1], -0.5 / h, &m[0], &m[0]);
        double ek = difference(&k[0], &dk), em = difference(&m[0], &dm), sk = largest_entry(&dk), sm = largest_entry(&dm);
        print_message("%-13s dK %.2e of %.2e, dM %.2e of %.2e\n", names[p], ek, sk, em, sm);
        assert_true(sk > 0 || sm > 0);
        assert_true(ek <= 2e-6 * sk + 1e-3 * scale_k && em <= 2e-6 * sm + 1e-3 * scale_m);
    }
}

static void try(void **state)
{
    struct bench b;
    double hz[6];
    int n;
    (void)state;
    two_steps(&b);
    solve(&b.rotor, NULL, 1, 5, hz, &n);
    solve(&b.rotor, NULL, 2, 5, hz, &n);
    solve(&b.rotor, &(struct solid_rule){0.00125, 0.02, 1}, 1, 5, hz, &n);
    rotor_a(&b, 1);
    solve(&b.rotor, NULL, 1, 6, hz, &n);
    solve(&b.rotor, NULL, 2, 6, hz, &n);
    solve(&b.rotor, &(struct solid_rule){0.005, 0.05, 1}, 1, 6, hz, &n);
    rotor_a(&b, 0);
    solve(&b.rotor, NULL, 1, 6, hz, &n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rigid_motions_cost_nothing_and_weigh_what_the_parts_weigh, open_test_pool,
                                        close_test_pool),
        cmocka_unit_test_setup_teardown(uniform_strains_have_their_energy_exactly, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(derivatives_agree_with_differences, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(try, open_test_pool, close_test_pool),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
