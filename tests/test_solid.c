/* The rotor as a solid of revolution: frequencies of converged references, rigid motions and mass in closed form, patch tests,
 * derivatives by differences. */
#include <math.h>
#include <string.h>

#include "linalg/matrix.h"
#include "modal/prediction.h"
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
        cmocka_unit_test_setup_teardown(try, open_test_pool, close_test_pool),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
