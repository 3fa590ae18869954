#include "solid_rig.h"

#include "linalg/linalg.h"

const struct material rig_steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};

void rig_section(struct rig *b, int group, double length, double diameter)
{
    b->segment[b->rotor.nsegment++] =
        (struct segment){.group = group, .elements = 10, .length = length, .outer = diameter, .stiff_outer = diameter};
}

void rig_begin(struct rig *b, int ngroup)
{
    *b = (struct rig){0};
    for (int g = 0; g < 8; g++)
        b->group[g] = (struct group){.name = "part", .material = rig_steel, .layer_of = -1};
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

void rig_springs(struct rig *b, double left, double right)
{
    b->rotor.nspring = 2;
    b->spring[0] = (struct spring){.name = "left", .position = 0, .lateral = left};
    b->spring[1] = (struct spring){.name = "right", .position = rotor_length(&b->rotor), .lateral = right};
}

void rig_two_steps(struct rig *b)
{
    rig_begin(b, 1);
    rig_section(b, 0, 0.3, 0.1);
    rig_section(b, 0, 0.3, 0.2);
    rig_section(b, 0, 0.3, 0.1);
    rig_springs(b, 9000, 9000);
}

const struct material rig_stack = {
    .name = "stack", .e = 1.05e11, .g = 4.7e10, .nu = 0.28, .rho = 7650, .laminated = 1, .sheet_e = 1.9e11, .stacking = 1};

void rig_rotor_a(struct rig *b, int laminated)
{
    static const double length[] = {0.25, 0.25, 0.2, 0.7, 0.2, 0.23, 0.2}, diameter[] = {0.14, 0.2, 0.26, 0.36, 0.26, 0.18, 0.13};
    rig_begin(b, 3);
    for (int s = 0; s < 7; s++)
        rig_section(b, s < 3 ? 0 : s == 3 ? 1 : 2, length[s], diameter[s]);
    if (laminated)
        b->group[1].material = rig_stack;
    rig_springs(b, 9790, 2000);
}

void rig_sensors(struct rig *b, int count)
{
    double length = rotor_length(&b->rotor);
    b->rotor.nsensor = count;
    for (int s = 0; s < count; s++)
        b->sensor[s] = (struct sensor){s + 1, length * (s + 0.13) / count};
}

const struct effect_kind *rig_kind(const char *id)
{
    return catalogue_find(id)->effect;
}

static void solve(const rotid_matrix *k, const rotid_matrix *m, int skip, int count, double *hz)
{
    struct eigen_band eigen;
    int wanted = count + skip;
    double *lambda = POOL_ARRAY(&test_pool, double, wanted), *phi = POOL_ARRAY(&test_pool, double, k->n *wanted);
    assert_status(eigen_band_new(&test_pool, k, wanted, &eigen), ROTID_OK);
    assert_status(eigen_band_solve(&eigen, k, m, lambda, phi), ROTID_OK);
    for (int j = 0; j < count; j++)
        hz[j] = sqrt(lambda[j + skip]) / (2 * 3.14159265358979323846);
}

int rig_solid(const struct rotor *rotor, const struct solid_rule *rule, int refine, int skip, int count, double *hz)
{
    struct solid solid;
    rotid_matrix k, m;
    int failed;
    assert_status(solid_build(&test_pool, rotor, 0, NULL, rule, refine, &solid, &failed), ROTID_OK);
    int n = solid.mesh.ndof;
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, n, solid.mesh.kd, solid.nfar, solid.far, &m), ROTID_OK);
    solid_assemble(&solid, NULL, &k, &m);
    solve(&k, &m, skip, count, hz);
    return n;
}
