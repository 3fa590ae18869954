/* What can be put on a shaft, one kind at a time, against exact dynamic stiffness (tools/oracle): sections, disks, springs, axial
 * forces, tie rods, bars, sling. */
#include "exact.h"
#include "support.h"

/* Two Richardson meshes of the bench are within 6e-7 of the truth; every check demands an effect that is far above this. */
#define TOLERANCE 1e-6

#define ALL_MODES (2 + EXACT_MODES)

struct bench {
    struct rotor rotor; /* points into this struct */
    struct group group[3];
    struct segment segment[7];
    struct tierod rod[2];
    struct bars bars;
    struct disk disk[2];
    struct spring spring[4];
};

static const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1},
                             core = {.name = "core", .e = 1.1e11, .g = 0.33e11, .nu = 0.28, .rho = 7400};

static void lay(struct bench *b, int group, double length, double diameter, int elements)
{
    b->segment[b->rotor.nsegment++] =
        (struct segment){.group = group, .elements = elements, .length = length, .outer = diameter, .stiff_outer = diameter};
}

static void open_empty(struct bench *b)
{
    *b = (struct bench){
        .group = {{.name = "left", .material = steel}, {.name = "core", .material = core}, {.name = "right", .material = steel}}};
    b->rotor = (struct rotor){.ngroup = 3,
                              .group = b->group,
                              .segment = b->segment,
                              .tierod = b->rod,
                              .bars = &b->bars,
                              .disk = b->disk,
                              .spring = b->spring};
}

/* 0 left 0.55 core 1.15 right 1.65 m */
static void open_bench(struct bench *b)
{
    static const struct {
        int group;
        double length, diameter;
    } steps[] = {{0, 0.3, 0.12}, {0, 0.25, 0.18}, {1, 0.6, 0.25}, {2, 0.2, 0.16}, {2, 0.3, 0.1}};
    open_empty(b);
    for (int s = 0; s < 5; s++)
        lay(b, steps[s].group, steps[s].length, steps[s].diameter, 40);
}

static void add_disk(struct bench *b, double position, double mass, double diametral)
{
    b->disk[b->rotor.ndisk++] = (struct disk){"disk", position, mass, diametral, 0, 0, 0};
}

static void add_spring(struct bench *b, double position, double lateral, double rotational)
{
    b->spring[b->rotor.nspring++] = (struct spring){"spring", position, lateral, rotational, 0, 0};
}

static void add_rods(struct bench *b, enum bundle_model model, double from, double to)
{
    b->rod[b->rotor.ntierod++] = (struct tierod){.name = "rods",
                                                 .material = steel,
                                                 .from = from,
                                                 .to = to,
                                                 .model = model,
                                                 .number = 8,
                                                 .elements = 1,
                                                 .diameter = 0.03,
                                                 .pitch = 0.1,
                                                 .tension = 2e5};
}

/* The meshes of `with` come to its exact frequencies, all of them up to the sixth above two of rigid bodies or suspension, of
 * which `skip` are zero. Of these six one or more differs from `without` by more than `least`. */
static void check(const struct bench *with, const struct bench *without, int skip, double least)
{
    struct exact exact;
    double truth[ALL_MODES], other[ALL_MODES], limit[ALL_MODES];
    exact_open(&without->rotor, &exact);
    exact_hz(&exact, skip + 1, ALL_MODES - skip, other);
    exact_open(&with->rotor, &exact);
    exact_hz(&exact, skip + 1, ALL_MODES - skip, truth);
    limit_hz(&with->rotor, 1, skip, ALL_MODES - skip, limit);
    assert_true(worst_ratio(EXACT_MODES, truth + 2 - skip, other + 2 - skip) > least);
    assert_hz(ALL_MODES - skip, limit, truth, TOLERANCE);
}

/* ---- sections ---- */

UNIT_TEST(annular_sections)
{
    struct bench solid, hollow, limited;
    open_bench(&solid);
    open_bench(&hollow);
    for (int s = 0; s < 5; s++)
        hollow.segment[s].inner = s == 2 ? 0.1 : 0.06;
    check(&hollow, &solid, 2, 0.05);
    open_bench(&limited);
    for (int s = 0; s < 5; s++)
        limited.segment[s].inner = hollow.segment[s].inner;
    limited.segment[2].stiff_outer = 0.2; /* the cone at the steps: mass stays, stiffness goes */
    check(&limited, &hollow, 2, 0.05);
}

UNIT_TEST(rectangular_sections)
{
    struct bench flat, upright;
    open_bench(&flat);
    flat.segment[2].rectangular = 1;
    flat.segment[2].height = 0.15; /* in the plane of bending */
    flat.segment[2].width = 0.3;
    open_bench(&upright);
    upright.segment[2] = flat.segment[2];
    upright.segment[2].height = 0.3;
    upright.segment[2].width = 0.15;
    check(&flat, &upright, 2, 0.05);
    check(&upright, &flat, 2, 0.05);
}

UNIT_TEST(perforated_sections)
{
    struct bench full, holed, outside;
    open_bench(&full);
    open_bench(&holed);
    holed.group[1].holes = 8;
    holed.group[1].hole_diameter = 0.035;
    holed.group[1].hole_pitch = 0.09;
    check(&holed, &full, 2, 0.01);
    open_bench(&outside);
    outside.group[1] = holed.group[1];
    outside.segment[2].stiff_outer = 0.17; /* holes in what carries no stiffness */
    check(&outside, &holed, 2, 0.01);
}

/* ---- points ---- */

UNIT_TEST(disks)
{
    struct bench bare, masses, disks;
    open_bench(&bare);
    open_bench(&masses);
    add_disk(&masses, 0, 15, 0); /* at the end, and inside an element */
    add_disk(&masses, 0.473, 40, 0);
    check(&masses, &bare, 2, 0.05);
    open_bench(&disks);
    add_disk(&disks, 0, 15, 0.2);
    add_disk(&disks, 0.473, 40, 0.8);
    check(&disks, &masses, 2, 0.05);
}

UNIT_TEST(springs)
{
    struct bench ends, inside, rotational;
    open_bench(&ends);
    add_spring(&ends, 0, 3e8, 0);
    add_spring(&ends, 1.65, 2e8, 0);
    open_bench(&inside);
    add_spring(&inside, 0, 3e8, 0);
    add_spring(&inside, 1.65, 2e8, 0);
    add_spring(&inside, 0.612, 5e8, 0);
    check(&inside, &ends, 0, 0.005);
    open_bench(&rotational);
    add_spring(&rotational, 0, 3e8, 2e6);
    add_spring(&rotational, 1.65, 2e8, 0);
    add_spring(&rotational, 0.612, 5e8, 3e7);
    check(&rotational, &inside, 0, 0.005);
}

/* ---- axial forces ---- */

UNIT_TEST(tension_and_compression)
{
    struct bench bare, tense, held, compressed;
    open_bench(&bare);
    open_bench(&tense);
    tense.group[0].preload = 1e7;
    tense.group[1].preload = 8e7;
    check(&tense, &bare, 1, 0.02); /* the rotation now has a frequency of its own */
    open_bench(&held);
    add_spring(&held, 0, 2e9, 0); /* hold the ends: a free bar under compression topples */
    add_spring(&held, 1.65, 2e9, 0);
    open_bench(&compressed);
    add_spring(&compressed, 0, 2e9, 0);
    add_spring(&compressed, 1.65, 2e9, 0);
    compressed.group[1].preload = -4e7;
    check(&compressed, &held, 0, 0.02);
}

/* ---- tie rods ---- */

UNIT_TEST(tie_rods_between_any_two_positions)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct bench bare, one, two, equilibrated;
        open_bench(&bare);
        open_bench(&one);
        add_rods(&one, (enum bundle_model)model, 0.55, 1.15);
        check(&one, &bare, 2, 0.02);
        open_bench(&two);
        add_rods(&two, (enum bundle_model)model, 0.55, 1.15);
        add_rods(&two, (enum bundle_model)model, 0.213, 0.871); /* overlapping, both ends inside elements */
        check(&two, &one, 2, 0.02);
        open_bench(&equilibrated);
        for (int t = 0; t < 2; t++) {
            equilibrated.rod[equilibrated.rotor.ntierod++] = two.rod[t];
            equilibrated.rod[t].self_equilibrated = 1;
        }
        check(&equilibrated, &two, 2, 1e-3); /* where they overlap, the compression adds up to 3.2 MN */
    }
}

UNIT_TEST(tie_rods_of_different_material_and_tension)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct bench plain, titanium, slack;
        open_bench(&plain);
        add_rods(&plain, (enum bundle_model)model, 0.3, 1.35);
        open_bench(&titanium);
        add_rods(&titanium, (enum bundle_model)model, 0.3, 1.35);
        titanium.rod[0].material = (struct material){.name = "titanium", .e = 1.05e11, .nu = 0.36, .rho = 4430, .isotropic = 1};
        check(&titanium, &plain, 2, 0.02);
        open_bench(&slack);
        add_rods(&slack, (enum bundle_model)model, 0.3, 1.35);
        slack.rod[0].tension = 0;
        check(&slack, &plain, 2, 1e-4);
    }
}

/* Compared with the single element, bundles of many have more modes: two of the slender rods' own in the band. */
UNIT_TEST(tie_rods_of_many_elements)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct bench b;
        double limit[EXACT_MODES], single[EXACT_MODES];
        open_bench(&b);
        add_rods(&b, (enum bundle_model)model, 0.55, 1.15);
        b.rod[0].self_equilibrated = model == BUNDLE_TUBE;
        mesh_hz(&b.rotor, 1, 2, EXACT_MODES, single);
        b.rod[0].elements = 60;
        limit_hz(&b.rotor, 1, 2, EXACT_MODES, limit);
        assert_true(worst_ratio(EXACT_MODES, limit, single) > 0.01);
        for (int k = 0; k < EXACT_MODES; k++) {
            assert_int_equal(exact_count(&b.rotor, limit[k] * (1 - TOLERANCE)), 2 + k);
            assert_int_equal(exact_count(&b.rotor, limit[k] * (1 + TOLERANCE)), 3 + k);
        }
    }
}

/* ---- bars ---- */

static int compare_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* The oracle has no branches. But where shaft and bars are symmetric about their common centre, each mode has theta = 0 or v = 0
 * there, and half the shaft with half the bars laid out behind it in one line has the same conditions at the joint: equal v and
 * no resultant force, or equal theta and no resultant moment. */
static void symmetric_branch_hz(const struct bench *b, double *hz)
{
    enum { each = EXACT_MODES + 2 };
    const struct bars *bars = &b->bars;
    struct oracle_segment segment[4];
    struct exact exact;
    double pitch, all[2 * each];
    exact_open(&b->rotor, &exact);
    memcpy(segment, exact.segment, 3 * sizeof *segment);
    segment[2].length /= 2;
    segment[3] = exact_bundle(bars->model, &bars->material, bars->number, bars->diameter, bars->pitch, bars->length / 2, &pitch);
    struct oracle_point joint = {.z = segment[0].length + segment[1].length + segment[2].length};
    struct oracle_system half = {.segments = 4, .segment = segment, .points = 1, .point = &joint};
    joint.rotational_spring = INFINITY;
    assert_int_equal(oracle_frequencies(&half, 1, each, all), ORACLE_OK);
    joint.rotational_spring = 0;
    joint.spring = INFINITY;
    if (bars->model == BUNDLE_RODS) /* bars off the axis move to and fro with the rotation of their centre */
        joint.inertia = bars->material.rho * pitch * bars->length / 2;
    assert_int_equal(oracle_frequencies(&half, 1, each, all + each), ORACLE_OK);
    qsort(all, 2 * each, sizeof *all, compare_doubles);
    assert_close(all[1], 0, 0, 0); /* both rigid motions */
    memcpy(hz, all + 2, EXACT_MODES * sizeof *hz);
}

UNIT_TEST(bars_held_at_their_centre)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct bench b;
        double truth[EXACT_MODES], bare[EXACT_MODES], limit[EXACT_MODES];
        struct exact exact;
        open_empty(&b);
        lay(&b, 0, 0.2, 0.12, 40);
        lay(&b, 0, 0.3, 0.2, 40);
        lay(&b, 1, 0.8, 0.26, 80);
        lay(&b, 2, 0.3, 0.2, 40);
        lay(&b, 2, 0.2, 0.12, 40);
        b.bars = (struct bars){.name = "bars",
                               .material = {.name = "copper", .e = 1.2e11, .nu = 0.34, .rho = 8900, .isotropic = 1},
                               .center = 0.9,
                               .length = 0.7,
                               .model = (enum bundle_model)model,
                               .number = 20,
                               .elements = 80,
                               .diameter = 0.03,
                               .pitch = 0.11};
        exact_open(&b.rotor, &exact);
        exact_hz(&exact, 3, EXACT_MODES, bare);
        b.rotor.nbars = 1;
        symmetric_branch_hz(&b, truth);
        limit_hz(&b.rotor, 1, 2, EXACT_MODES, limit);
        assert_true(worst_ratio(EXACT_MODES, truth, bare) > 0.02);
        assert_hz(EXACT_MODES, limit, truth, TOLERANCE);
    }
}

/* ---- sling and whole rotors ---- */

/* The springs of (44) move elastic modes by 3e-6 only: the two modes of the suspension show them. These come from the coarse
 * mesh, which bends nothing in them; rounding of entries of 1e13 N/m beside springs of 1e3 N/m leaves 1e-7 there, and several
 * times as much on a mesh twice as fine. */
UNIT_TEST(sling)
{
    struct bench b;
    struct exact exact;
    double truth[ALL_MODES], other[ALL_MODES], hz[ALL_MODES];
    open_bench(&b);
    add_disk(&b, 0.473, 40, 0.8);
    add_rods(&b, BUNDLE_RODS, 0.55, 1.15);
    b.rod[0].self_equilibrated = 1; /* or else the tension holds the rotation more than the springs do */
    b.rotor.sling = 1.8;
    exact_open(&b.rotor, &exact);
    exact_hz(&exact, 1, ALL_MODES, other);
    b.rotor.sling = 1.2;
    exact_open(&b.rotor, &exact);
    exact_hz(&exact, 1, ALL_MODES, truth);
    mesh_hz(&b.rotor, 1, 0, ALL_MODES, hz);
    limit_hz(&b.rotor, 1, 2, EXACT_MODES, hz + 2);
    assert_true(fabs(truth[0] / other[0] - 1) > 0.05 && fabs(truth[1] / other[1] - 1) > 0.05);
    assert_hz(ALL_MODES, hz, truth, TOLERANCE);
}

/* input/solid_rotor.inp with its 193 elements */
UNIT_TEST(solid_rotor)
{
    static const struct {
        int group, elements;
        double length, diameter;
    } steps[] = {{0, 24, 0.25, 0.14}, {0, 24, 0.25, 0.2},  {0, 19, 0.2, 0.26}, {1, 66, 0.7, 0.36},
                 {2, 19, 0.2, 0.26},  {2, 22, 0.23, 0.18}, {2, 19, 0.2, 0.13}};
    struct bench b;
    struct exact exact;
    double truth[EXACT_MODES], hz[EXACT_MODES];
    open_empty(&b);
    for (int s = 0; s < 7; s++)
        lay(&b, steps[s].group, steps[s].length, steps[s].diameter, steps[s].elements);
    b.group[1].material = (struct material){.name = "lamination", .e = 0.6e11, .g = 0.3e11, .nu = 0.28, .rho = 7650};
    add_spring(&b, 0, 9790, 0);
    add_spring(&b, 2.03, 2000, 0);
    exact_open(&b.rotor, &exact);
    exact_hz(&exact, 3, EXACT_MODES, truth);
    mesh_hz(&b.rotor, 1, 2, EXACT_MODES, hz);
    assert_hz(EXACT_MODES, hz, truth, 4e-4);
    assert_true(worst_ratio(EXACT_MODES, hz, truth) > 1e-4); /* the mesh error is there: limit and mesh are not mixed up */
    limit_hz(&b.rotor, 1, 2, EXACT_MODES, hz);
    assert_hz(EXACT_MODES, hz, truth, TOLERANCE);
}
