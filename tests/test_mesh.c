/* Where nodes come to lie, and how rods and bars hang on them. */
#include "beam/beam.h"
#include "support.h"

/* Two segments of 1 m and 0.5 m with 10 and 4 elements: nodes at 0, 0.1, ..., 1, 1.125, ..., 1.5. The arrays have room for the
 * tests. */
static struct group groups[1];
static struct segment segments[2];
static struct tierod rods[2];
static struct bars bars[1];
static struct disk disks[4];
static struct spring springs[2];
static struct sensor sensors[8];

static struct rotor bare(void)
{
    groups[0] = (struct group){
        .layer_of = -1, .name = "shaft", .material = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1}};
    segments[0] = (struct segment){0, 10, 0, 1, 0.1, 0, 0.1, 0, 0};
    segments[1] = (struct segment){0, 4, 0, 0.5, 0.1, 0, 0.1, 0, 0};
    return (struct rotor){.ngroup = 1,
                          .group = groups,
                          .nsegment = 2,
                          .segment = segments,
                          .tierod = rods,
                          .bars = bars,
                          .disk = disks,
                          .spring = springs,
                          .sensor = sensors};
}

static void add_sensors(struct rotor *rotor, int count, const double *position)
{
    for (int i = 0; i < count; i++)
        sensors[i] = (struct sensor){i + 1, position[i]};
    rotor->nsensor = count;
}

static void add_rod(struct rotor *rotor, double from, double to, int elements)
{
    rods[rotor->ntierod++] = (struct tierod){.name = "rod",
                                             .material = groups[0].material,
                                             .from = from,
                                             .to = to,
                                             .model = BUNDLE_RODS,
                                             .number = 6,
                                             .elements = elements,
                                             .diameter = 0.01,
                                             .pitch = 0.04};
}

static struct mesh build(const struct rotor *rotor, int refine)
{
    struct mesh mesh;
    assert_status(mesh_build(&test_pool, rotor, refine, &mesh), ROTID_OK);
    return mesh;
}

POOL_TEST(bare_rotor_keeps_the_nodes_of_its_segments)
{
    struct rotor rotor = bare();
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.naxis, 15);
    assert_int_equal(mesh.nelement, 14);
    assert_int_equal(mesh.nnode, 15);
    assert_int_equal(mesh.ndof, 30);
    assert_int_equal(mesh.kd, 3);
    assert_int_equal(mesh.nfar, 0);
    assert_int_equal(mesh.end_node, 14);
    for (int i = 0; i < 15; i++)
        assert_close(mesh.z[i], i <= 10 ? 0.1 * i : 1 + 0.125 * (i - 10), 1e-15, 0);
    for (int e = 0; e < 14; e++)
        assert_int_equal(mesh.segment[e], e >= 10);
}

POOL_TEST(position_inside_an_element_gets_a_node)
{
    struct rotor rotor = bare();
    add_sensors(&rotor, 2, (double[]){0.37, 1.0625});
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.naxis, 17);
    assert_close(mesh.z[mesh.sensor_node[0]], 0.37, 1e-15, 0);
    assert_close(mesh.z[mesh.sensor_node[1]], 1.0625, 1e-15, 0);
    for (int e = 0; e < mesh.nelement; e++) { /* both halves stay in their segment, and the order is kept */
        assert_true(mesh.z[e + 1] > mesh.z[e]);
        assert_int_equal(mesh.segment[e], mesh.z[e] >= 1 - 1e-12);
    }
}

POOL_TEST(every_kind_of_attachment_gets_its_node)
{
    struct rotor rotor = bare();
    springs[0] = (struct spring){"a", 0.05, 1, 0, 0, 0};
    disks[0] = (struct disk){"b", 0.15, 1, 0, 0, 0, 0};
    bars[0] = (struct bars){"c", groups[0].material, 0.55, 0.4, BUNDLE_RODS, 6, 2, 0.01, 0.04};
    rotor.nspring = rotor.ndisk = rotor.nbars = 1;
    add_sensors(&rotor, 1, (double[]){0.25});
    add_rod(&rotor, 0.35, 0.75, 1);
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.naxis, 15 + 6);
    assert_close(mesh.z[mesh.spring_node[0]], 0.05, 1e-15, 0);
    assert_close(mesh.z[mesh.disk_node[0]], 0.15, 1e-15, 0);
    assert_close(mesh.z[mesh.sensor_node[0]], 0.25, 1e-15, 0);
    assert_close(mesh.z[mesh.tierod[0].first_end], 0.35, 1e-15, 0);
    assert_close(mesh.z[mesh.tierod[0].last_end], 0.75, 1e-15, 0);
    assert_close(mesh.z[mesh.bars[0].first_end], 0.55, 1e-15, 0);
    assert_int_equal(mesh.bars[1].first_end, mesh.bars[0].first_end);
}

POOL_TEST(position_within_one_percent_of_an_element_takes_the_node_there)
{
    const double offset[] = {-0.99e-3, 0.99e-3, -1.01e-3, 1.01e-3}; /* the element is 0.1 m long */
    for (int i = 0; i < 4; i++) {
        struct rotor rotor = bare();
        add_sensors(&rotor, 1, (double[]){0.4 + offset[i]});
        struct mesh mesh = build(&rotor, 1);
        int own = i >= 2;
        assert_int_equal(mesh.naxis, 15 + own);
        assert_close(mesh.z[mesh.sensor_node[0]], own ? 0.4 + offset[i] : 0.4, 1e-14, 0);
    }
}

/* At 1 m an element of 0.1 m meets one of 0.125 m: 1 % is of the element that holds the position. */
POOL_TEST(one_percent_is_of_the_element_that_holds_the_position)
{
    const double position[] = {1 - 0.0011, 1 + 0.0011};
    for (int i = 0; i < 2; i++) {
        struct rotor rotor = bare();
        add_sensors(&rotor, 1, position + i);
        assert_int_equal(build(&rotor, 1).naxis, i ? 15 : 16);
    }
}

POOL_TEST(two_positions_at_the_same_place_share_a_node)
{
    struct rotor rotor = bare();
    add_sensors(&rotor, 1, (double[]){0.33});
    springs[0] = (struct spring){"a", 0.33, 1, 0, 0, 0};
    disks[0] = (struct disk){"b", 0.3303, 1, 0, 0, 0, 0};
    disks[1] = (struct disk){"c", 0.3297, 1, 0, 0, 0, 0}; /* comes first: the others then lie within 1 % of its node */
    rotor.nspring = 1;
    rotor.ndisk = 2;
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.naxis, 16);
    assert_int_equal(mesh.sensor_node[0], 4);
    assert_int_equal(mesh.spring_node[0], 4);
    assert_int_equal(mesh.disk_node[0], 4);
    assert_int_equal(mesh.disk_node[1], 4);
}

POOL_TEST(ends_of_the_rotor_are_nodes_already)
{
    struct rotor rotor = bare();
    springs[0] = (struct spring){"start", 0, 1, 0, 0, 0};
    springs[1] = (struct spring){"end", rotor_length(&rotor), 1, 0, 0, 0};
    rotor.nspring = 2;
    add_sensors(&rotor, 3, (double[]){1e-9, 1.5 - 1e-9, 1.5});
    struct mesh mesh = build(&rotor, 3);
    assert_int_equal(mesh.naxis, 14 * 3 + 1);
    assert_int_equal(mesh.spring_node[0], 0);
    assert_int_equal(mesh.spring_node[1], mesh.end_node);
    assert_int_equal(mesh.sensor_node[0], 0);
    assert_int_equal(mesh.sensor_node[1], mesh.end_node);
    assert_int_equal(mesh.sensor_node[2], mesh.end_node);
    assert_int_equal(mesh.end_node, mesh.naxis - 1);
}

POOL_TEST(refinement_keeps_every_node_and_divides_evenly)
{
    struct rotor rotor = bare();
    add_sensors(&rotor, 3, (double[]){0.0123, 0.37, 1.31});
    add_rod(&rotor, 0.111, 0.9, 3);
    struct mesh coarse = build(&rotor, 1), fine;
    for (int refine = 2; refine <= 5; refine++) {
        fine = build(&rotor, refine);
        assert_int_equal(fine.nelement, coarse.nelement * refine);
        for (int i = 0; i < coarse.naxis; i++)
            assert_close(fine.z[i * refine], coarse.z[i], 0, 0);
        for (int e = 0; e < fine.nelement; e++) {
            double whole = coarse.z[e / refine + 1] - coarse.z[e / refine];
            assert_close(fine.z[e + 1] - fine.z[e], whole / refine, 1e-12, 0);
            assert_int_equal(fine.segment[e], coarse.segment[e / refine]);
        }
        for (int i = 0; i < 3; i++)
            assert_int_equal(fine.sensor_node[i], coarse.sensor_node[i] * refine);
        assert_int_equal(fine.tierod[0].first_end, coarse.tierod[0].first_end * refine);
        assert_int_equal(fine.tierod[0].last_end, coarse.tierod[0].last_end * refine);
    }
}

POOL_TEST(sensor_nodes_increase_with_the_position)
{
    struct rotor rotor = bare();
    add_sensors(&rotor, 8, (double[]){0, 0.0021, 0.05, 0.101, 0.5, 0.502, 1.2, 1.5});
    struct mesh mesh = build(&rotor, 1);
    for (int i = 1; i < 8; i++)
        assert_true(mesh.sensor_node[i] > mesh.sensor_node[i - 1]);
    for (int i = 0; i < 8; i++)
        assert_close(mesh.z[mesh.sensor_node[i]], sensors[i].position, 0, 1.001e-3);
}

static void assert_far(const struct mesh *mesh, int count, const int *node)
{
    assert_int_equal(mesh->nfar, 2 * count);
    for (int i = 0; i < 2 * count; i++)
        assert_int_equal(mesh->far[i], 2 * node[i / 2] + i % 2);
}

POOL_TEST(rod_of_one_element_has_no_inner_node_at_any_refinement)
{
    struct rotor rotor = bare();
    add_rod(&rotor, 0.2, 0.8, 1);
    for (int refine = 1; refine <= 3; refine++) {
        struct mesh mesh = build(&rotor, refine);
        assert_int_equal(mesh.tierod[0].count, 0);
        assert_int_equal(mesh.nnode, mesh.naxis);
        assert_far(&mesh, 2, (int[]){2 * refine, 8 * refine});
    }
}

POOL_TEST(rod_of_three_elements_is_numbered_after_the_axis)
{
    struct rotor rotor = bare();
    add_rod(&rotor, 0.2, 0.8, 3);
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.tierod[0].inner, 15);
    assert_int_equal(mesh.tierod[0].count, 2);
    assert_int_equal(mesh.nnode, 17);
    assert_int_equal(mesh.ndof, 34);
    assert_far(&mesh, 4, (int[]){2, 8, 15, 16});
    mesh = build(&rotor, 2);
    assert_int_equal(mesh.tierod[0].count, 5);
    assert_far(&mesh, 4, (int[]){4, 16, 29, 33}); /* the first and the last inner node; those between stay in the band */
}

POOL_TEST(shared_ends_appear_once_among_the_far_ones)
{
    struct rotor rotor = bare();
    add_rod(&rotor, 0.2, 0.8, 1);
    add_rod(&rotor, 0.8, 1, 2);
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.nnode, 16);
    assert_far(&mesh, 4, (int[]){2, 8, 10, 15});
    for (int i = 1; i < mesh.nfar; i++)
        assert_true(mesh.far[i] > mesh.far[i - 1]);
}

POOL_TEST(bars_have_two_halves_with_free_ends)
{
    struct rotor rotor = bare();
    bars[0] = (struct bars){"bars", groups[0].material, 0.6, 0.5, BUNDLE_RODS, 6, 6, 0.01, 0.04};
    rotor.nbars = 1;
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.nnode, 15 + 6);
    for (int half = 0; half < 2; half++) {
        assert_int_equal(mesh.bars[half].first_end, 6);
        assert_int_equal(mesh.bars[half].last_end, -1);
        assert_int_equal(mesh.bars[half].count, 3);
        assert_int_equal(mesh.bars[half].inner, 15 + 3 * half);
    }
    assert_far(&mesh, 3, (int[]){6, 15, 18});
    assert_int_equal(build(&rotor, 3).nnode, 14 * 3 + 1 + 18);
}

POOL_TEST(node_at_is_the_nearest_one)
{
    struct rotor rotor = bare();
    struct mesh mesh = build(&rotor, 2);
    for (double z = -0.1; z < 1.6; z += 0.0071) {
        int found = mesh_node_at(&mesh, z);
        for (int i = 0; i < mesh.naxis; i++)
            assert_true(fabs(mesh.z[found] - z) <= fabs(mesh.z[i] - z));
    }
}

/* Nearer to each other than 1 % of an element. */
POOL_TEST(no_sensor_moves_a_disk)
{
    for (int side = -1; side <= 1; side += 2) {
        struct rotor rotor = bare();
        disks[0] = (struct disk){"disk", 0.35, 1, 0, 0, 0, 0};
        rotor.ndisk = 1;
        add_sensors(&rotor, 1, (double[]){0.35 + side * 5e-4});
        struct mesh mesh = build(&rotor, 1);
        assert_int_equal(mesh.naxis, 16);
        assert_close(mesh.z[mesh.disk_node[0]], 0.35, 1e-15, 0);
        assert_int_equal(mesh.sensor_node[0], mesh.disk_node[0]);
    }
}

POOL_TEST(a_turned_rotor_has_the_same_nodes_turned)
{
    struct segment turned[] = {segments[1], segments[0]};
    double place[] = {0.35, 0.3506}, length = 1.5;
    struct rotor rotor = bare();
    rotor.nspring = 2;
    for (int i = 0; i < 2; i++)
        springs[i] = (struct spring){"s", place[i], 1, 0, 0, 0};
    struct mesh mesh = build(&rotor, 1);
    assert_int_equal(mesh.naxis, 16);
    for (int i = 0; i < 2; i++)
        springs[i].position = length - place[i];
    rotor.segment = turned;
    struct mesh other = build(&rotor, 1);
    assert_int_equal(other.naxis, mesh.naxis);
    for (int i = 0; i < mesh.naxis; i++)
        assert_close(other.z[i], length - mesh.z[mesh.naxis - 1 - i], 1e-14, 0);
}

POOL_TEST(no_memory_is_reported_at_every_allocation)
{
    struct rotor rotor = bare();
    add_rod(&rotor, 0.2, 0.8, 3);
    struct mesh mesh;
    int status = ROTID_ERROR_MEMORY, n;
    for (n = 1; status; n++) {
        struct failing_allocator failing;
        struct pool own;
        failing_allocator_open(&failing, n);
        pool_open(&own, &failing.allocator);
        status = mesh_build(&own, &rotor, 1, &mesh);
        pool_close(&own);
        assert_int_equal(failing.in_use, 0);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        assert_true(n < 100);
    }
    assert_true(n > 5);
}
