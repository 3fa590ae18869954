/* The assembled rotor under rigid motions, its rods and bars by their energies, the sling, and which modes count as rigid. */
#include "linalg/linalg.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

static struct beam beam;
static rotid_matrix k, m;
static double *work;

static void assemble(const struct rotor *rotor, int nparameter, const struct parameter *parameter, const double *x)
{
    int failed;
    assert_status(beam_build(&test_pool, rotor, nparameter, parameter, 1, &beam, &failed), ROTID_OK);
    const struct mesh *mesh = &beam.mesh;
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, &m), ROTID_OK);
    work = POOL_ARRAY(&test_pool, double, mesh->ndof);
    beam_assemble(&beam, x, &k, &m);
}

/* The paper's rotor with all that a deck can hang on it. */
static struct rotor *dressed(enum bundle_model model, int self_equilibrated, int rod_elements)
{
    static struct bars bars[2];
    static struct disk disks[2];
    struct rotor *rotor = paper_rotor(model, self_equilibrated);
    struct material copper = {.name = "copper", .e = 1.2e11, .nu = 0.34, .rho = 8960, .isotropic = 1};
    rotor->tierod[0].elements = rod_elements;
    rotor->group[1].holes = 12;
    rotor->group[1].hole_diameter = 0.033;
    rotor->group[1].hole_pitch = 0.13364;
    bars[0] = (struct bars){"bars", copper, 1.0912, 0.9, model, 40, 6, 0.016, 0.15};
    bars[1] = (struct bars){"more", copper, 1.05, 0.3, model, 7, 2, 0.012, 0.1};
    disks[0] = (struct disk){"fan", 0.2, 12, 0.4, 0.8, 0, 0};
    disks[1] = (struct disk){"hub", 1.9, 7, 0.1, 0.2, 0, 0};
    rotor->bars = bars;
    rotor->disk = disks;
    rotor->nbars = rotor->ndisk = 2;
    return rotor;
}

/* v = translation - rotation (z - about), theta = rotation, at all nodes, those inside rods and bars included */
static double *rigid(double translation, double rotation, double about)
{
    const struct mesh *mesh = &beam.mesh;
    double *u = POOL_ARRAY(&test_pool, double, mesh->ndof), *z = POOL_ARRAY(&test_pool, double, mesh->nnode);
    memcpy(z, mesh->z, (size_t)mesh->naxis * sizeof *z);
    for (int i = 0; i < beam.rotor.ntierod; i++) {
        const struct chain *chain = &mesh->tierod[i];
        for (int c = 0; c < chain->count; c++)
            z[chain->inner + c] = z[chain->first_end] + (z[chain->last_end] - z[chain->first_end]) * (c + 1) / (chain->count + 1);
    }
    for (int i = 0; i < 2 * beam.rotor.nbars; i++) {
        const struct chain *half = &mesh->bars[i];
        for (int c = 0; c < half->count; c++)
            z[half->inner + c] =
                z[half->first_end] + (i % 2 ? 1 : -1) * beam.rotor.bars[i / 2].length / 2 * (c + 1) / half->count;
    }
    for (int i = 0; i < mesh->nnode; i++) {
        u[2 * i] = translation - rotation * (z[i] - about);
        u[2 * i + 1] = rotation;
    }
    return u;
}

static double energy(const rotid_matrix *a, const double *u)
{
    return matrix_product(a, u, u, work);
}

POOL_TEST(paper_rotor_has_its_mass_and_centre)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct mass_properties p;
        assemble(paper_rotor((enum bundle_model)model, 1), 0, NULL, NULL);
        beam_mass_properties(&beam, &p);
        assert_close(p.mass, 998.275538, 1e-8, 0); /* a script with SciPy 1.17 that shares no code */
        assert_close(p.center, 1.05912518, 1e-8, 0);
    }
}

POOL_TEST(rigid_motion_carries_the_mass_and_inertia_of_everything)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int elements = 1; elements <= 3; elements += 2) {
            struct mass_properties p, bare;
            assemble(paper_rotor((enum bundle_model)model, 1), 0, NULL, NULL);
            beam_mass_properties(&beam, &bare);
            assemble(dressed((enum bundle_model)model, 1, elements), 0, NULL, NULL);
            beam_mass_properties(&beam, &p);
            const double *translation = rigid(1, 0, 0), *rotation = rigid(0, 1, p.center);
            assert_close(energy(&m, translation), p.mass, 1e-12, 0);
            assert_close(energy(&m, rotation), p.inertia, 1e-12, 0);
            assert_close(matrix_product(&m, translation, rotation, work), 0, 0, 1e-12 * p.mass);
            /* the disks and bars by hand, less the holes: nothing may be counted twice or left out */
            double copper = 8960 * pi / 4 * (40 * 0.016 * 0.016 * 0.9 + 7 * 0.012 * 0.012 * 0.3);
            double holes = 7380.66 * 12 * pi / 4 * 0.033 * 0.033 * 0.924192;
            assert_close(p.mass - bare.mass, 12 + 7 + copper - holes, 1e-10, 0);
        }
}

/* Rods at pitch radius e have the moment of inertia of their own discs and of S e^2/2, whichever way they couple. */
POOL_TEST(rods_and_tube_have_the_same_mass_properties)
{
    struct mass_properties rods, tube;
    assemble(dressed(BUNDLE_RODS, 1, 3), 0, NULL, NULL);
    beam_mass_properties(&beam, &rods);
    assemble(dressed(BUNDLE_TUBE, 1, 1), 0, NULL, NULL);
    beam_mass_properties(&beam, &tube);
    assert_close(rods.mass, tube.mass, 1e-13, 0);
    assert_close(rods.center, tube.center, 1e-13, 0);
    assert_close(rods.inertia, tube.inertia, 1e-13, 0);
}

POOL_TEST(limited_stiffness_diameter_weakens_the_shaft_and_leaves_its_mass)
{
    struct mass_properties whole, limited;
    struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    assemble(rotor, 0, NULL, NULL);
    beam_mass_properties(&beam, &whole);
    double *bent = POOL_ARRAY(&test_pool, double, k.n), before;
    bent[2 * 20] = 1; /* node 20 lies in the second segment */
    before = energy(&k, bent);
    rotor->segment[1].stiff_outer *= 0.8;
    assemble(rotor, 0, NULL, NULL);
    beam_mass_properties(&beam, &limited);
    assert_close(limited.mass, whole.mass, 0, 0);
    assert_close(limited.inertia, whole.inertia, 0, 0);
    assert_true(energy(&k, bent) < 0.7 * before);
}

/* Largest force that a displacement meets, relative to the sum of the absolute terms of its row. */
static double largest_force(const double *u)
{
    double worst = 0, *force = POOL_ARRAY(&test_pool, double, k.n), *size = POOL_ARRAY(&test_pool, double, k.n),
           *most = POOL_ARRAY(&test_pool, double, k.n);
    matrix_multiply(&k, 1, u, force);
    rotid_matrix absolute;
    assert_status(matrix_new(&test_pool, k.n, k.kd, k.nfar, k.far, &absolute), ROTID_OK);
    for (int i = 0; i < k.n * (k.kd + 1); i++)
        absolute.band[i] = fabs(k.band[i]);
    for (int i = 0; i < k.nfar * k.nfar; i++)
        absolute.block[i] = fabs(k.block[i]);
    for (int i = 0; i < k.n; i++)
        size[i] = fabs(u[i]);
    matrix_multiply(&absolute, 1, size, most);
    for (int i = 0; i < k.n; i++)
        worst = fmax(worst, fabs(force[i]) / most[i]);
    return worst;
}

POOL_TEST(rigid_motion_of_a_free_rotor_meets_no_force_when_its_tension_is_balanced)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int elements = 1; elements <= 3; elements += 2) {
            struct rotor *rotor = dressed((enum bundle_model)model, 1, elements);
            rotor->nspring = 0;
            assemble(rotor, 0, NULL, NULL);
            assert_close(largest_force(rigid(1, 0, 0)), 0, 0, 1e-15);
            assert_close(largest_force(rigid(0, 1, 0.7)), 0, 0, 1e-14);
        }
}

/* Tension that nothing balances: a rotation theta stores N T L theta^2/2, held by two lateral forces N T theta at the rods' ends.
 * A free rotor then swings like a pendulum with omega^2 = N T L/J, where the balanced one has a rigid mode at zero. */
POOL_TEST(unbalanced_tension_stores_force_times_length_in_a_rotation)
{
    for (int elements = 1; elements <= 3; elements += 2) {
        struct rotor *rotor = dressed(BUNDLE_RODS, 0, elements);
        struct eigen_band eigen;
        struct mass_properties p;
        double lambda[3];
        rotor->nspring = 0;
        assemble(rotor, 0, NULL, NULL);
        beam_mass_properties(&beam, &p);
        const struct chain *chain = &beam.mesh.tierod[0];
        double force = 12 * 150e3, length = beam.mesh.z[chain->last_end] - beam.mesh.z[chain->first_end];
        double *u = rigid(0, 1, p.center), *held = POOL_ARRAY(&test_pool, double, k.n),
               *phi = POOL_ARRAY(&test_pool, double, 3 * k.n);
        assert_close(energy(&k, u), force * length, 1e-7, 0); /* rounding of K, whose entries are 1e11 */
        matrix_multiply(&k, 1, u, held);
        assert_close(held[2 * chain->first_end], force, 1e-5, 0);
        assert_close(held[2 * chain->last_end], -force, 1e-5, 0);
        assert_status(eigen_band_new(&test_pool, &k, 3, &eigen), ROTID_OK);
        assert_status(eigen_band_solve(&eigen, &k, &m, lambda, phi), ROTID_OK);
        print_message("swing over N T L/J %.6f, balanced force %.3e N\n", lambda[1] / (force * length / p.inertia),
                      held[2 * chain->last_end]);
        assert_close(lambda[1], force * length / p.inertia, 1e-2, 0);
        assert_close(lambda[0], 0, 0, 1e-3 * lambda[1]);
    }
}

/* K of the rods alone: it is proportional to their E when they carry no tension. */
static void rods_alone(enum bundle_model model, int elements, rotid_matrix *rods)
{
    struct rotor *rotor = paper_rotor(model, 1);
    const struct parameter parameter = {PARAMETER_TIEROD_E, 0, 0, 0, NULL};
    rotid_matrix unused;
    double e = rotor->tierod[0].material.e;
    rotor->tierod[0].elements = elements;
    rotor->tierod[0].tension = 0;
    assemble(rotor, 1, &parameter, &e);
    assert_status(matrix_new(&test_pool, k.n, k.kd, k.nfar, k.far, rods), ROTID_OK);
    assert_status(matrix_new(&test_pool, k.n, k.kd, k.nfar, k.far, &unused), ROTID_OK);
    beam_differentiate(&beam, 0, rods, &unused);
    matrix_combine(e, rods, 0, rods, rods);
}

/* Ends turned against each other by one radian, the rods bent to a parabola: E (I_own + S e^2/2)/L, for the tube the same E I/L.
 */
POOL_TEST(relative_rotation_of_the_ends_stretches_and_bends_the_rods)
{
    double area, own, pitch;
    section_rods(12, 0.032, 0.13364, &area, &own, &pitch);
    assert_true(pitch > 100 * own); /* it is the stretch that couples */
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int elements = 1; elements <= 3; elements += 2) {
            rotid_matrix rods;
            rods_alone((enum bundle_model)model, elements, &rods);
            const struct chain *chain = &beam.mesh.tierod[0];
            double *u = POOL_ARRAY(&test_pool, double, k.n),
                   length = beam.mesh.z[chain->last_end] - beam.mesh.z[chain->first_end];
            for (int i = 0; i <= elements; i++) {
                int node = i == 0 ? chain->first_end : i == elements ? chain->last_end : chain->inner + i - 1;
                double s = (double)i / elements;
                u[2 * node] = length * s * (1 - s) / 2;
                u[2 * node + 1] = s - 0.5;
            }
            assert_close(energy(&rods, u), 2.1e11 * (own + pitch) / length, 1e-10, 0);
        }
}

/* Ends shifted against each other without turning: the tube resists as a short thick beam, rods only with their own bending. */
POOL_TEST(relative_shift_of_the_ends_meets_the_tube_but_hardly_the_rods)
{
    double area, own, pitch, outer, inner, stored[2];
    section_rods(12, 0.032, 0.13364, &area, &own, &pitch);
    assert_status(rotid_equivalent_cylinder(area, own + pitch, NULL, &outer, &inner), ROTID_OK);
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        rotid_matrix rods;
        rods_alone((enum bundle_model)model, 1, &rods);
        const struct chain *chain = &beam.mesh.tierod[0];
        double *u = POOL_ARRAY(&test_pool, double, k.n), l = beam.mesh.z[chain->last_end] - beam.mesh.z[chain->first_end];
        double inertia = model == BUNDLE_RODS ? own : own + pitch, e = 2.1e11, g = e / 2.6;
        double shear = rotid_shear_coefficient_annulus(0.3, model == BUNDLE_RODS ? 0 : inner / outer) * g * area;
        u[2 * chain->last_end] = 1;
        stored[model] = energy(&rods, u);
        assert_close(stored[model], 1 / (l * l * l / (12 * e * inertia) + l / shear), 1e-12, 0);
    }
    print_message("shift: tube %.4e N/m, rods %.4e N/m, ratio %.1f\n", stored[BUNDLE_TUBE], stored[BUNDLE_RODS],
                  stored[BUNDLE_TUBE] / stored[BUNDLE_RODS]);
    assert_true(stored[BUNDLE_TUBE] > 50 * stored[BUNDLE_RODS]);
}

/* Bars that follow their centre without bending store nothing, however the axis bends: they are fixed there only. */
POOL_TEST(bars_add_mass_but_no_stiffness_to_the_axis)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        struct rotor *rotor = dressed((enum bundle_model)model, 1, 1);
        assemble(rotor, 0, NULL, NULL);
        double *u = POOL_ARRAY(&test_pool, double, k.n), with[2];
        for (int i = 0; i < beam.mesh.naxis; i++) {
            u[2 * i] = sin(3 * beam.mesh.z[i]);
            u[2 * i + 1] = -3 * cos(3 * beam.mesh.z[i]);
        }
        for (int i = 0; i < 2 * rotor->nbars; i++) {
            const struct chain *half = &beam.mesh.bars[i];
            for (int c = 0; c < half->count; c++) {
                int node = half->inner + c, center = half->first_end;
                double arm = (i % 2 ? 1 : -1) * rotor->bars[i / 2].length / 2 * (c + 1) / half->count;
                u[2 * node] = u[2 * center] - u[2 * center + 1] * arm;
                u[2 * node + 1] = u[2 * center + 1];
            }
        }
        with[0] = energy(&k, u);
        with[1] = energy(&m, u);
        for (int i = 0; i < 2; i++)
            rotor->bars[i].material.e = rotor->bars[i].material.rho = 1e-9;
        assemble(rotor, 0, NULL, NULL);
        assert_close(with[0], energy(&k, u), 1e-12, 0);
        assert_true(with[1] > 1.05 * energy(&m, u));
    }
}

POOL_TEST(sling_springs_follow_from_the_models_own_mass_and_centre)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 1);
    struct mass_properties p;
    rotor->nspring = 0;
    rotor->sling = 1.7;
    assemble(rotor, 0, NULL, NULL);
    beam_mass_properties(&beam, &p);
    double length = rotor_length(rotor), weight = p.mass * 9.81;
    assert_int_equal(beam.rotor.nspring, 2);
    assert_int_equal(beam.mesh.spring_node[0], 0);
    assert_int_equal(beam.mesh.spring_node[1], beam.mesh.end_node);
    assert_close(beam.rotor.spring[0].lateral, weight / 1.7, 1e-14, 0);
    assert_close(beam.rotor.spring[1].lateral, weight * p.center / (length * length + p.center * 1.7), 1e-14, 0);
    assert_close(energy(&k, rigid(1, 0, 0)), beam.rotor.spring[0].lateral + beam.rotor.spring[1].lateral, 1e-6, 0);
    assert_int_equal(rotor->nspring, 0); /* the caller's rotor keeps its own */
}

static int count_rigid(const struct rotor *rotor)
{
    int nrigid = -1;
    assemble(rotor, 0, NULL, NULL);
    struct discrete discrete = {.as = AS_BEAM, .beam = beam};
    assert_status(discrete_count_rigid(&test_pool, &discrete, NULL, 0, NULL, &nrigid), ROTID_OK);
    return nrigid;
}

static int count_with_springs(double lateral_left, double rotational_left, double lateral_right)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 1);
    rotor->spring[0].lateral = lateral_left;
    rotor->spring[0].rotational = rotational_left;
    rotor->spring[1].lateral = lateral_right;
    return count_rigid(rotor);
}

POOL_TEST(rigid_modes_are_those_that_the_supports_leave)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 1);
    assert_int_equal(count_rigid(rotor), 2);
    rotor->nspring = 0;
    assert_int_equal(count_rigid(rotor), 2);
    rotor->sling = 1;
    assert_int_equal(count_rigid(rotor), 2);
    rotor = paper_rotor(BUNDLE_RODS, 0); /* unbalanced tension: the swing is no bending mode either */
    rotor->nspring = 0;
    assert_int_equal(count_rigid(rotor), 2);
    assert_int_equal(count_with_springs(1e12, 1e11, 0), 0); /* cantilever */
    assert_int_equal(count_with_springs(1e12, 0, 0), 1);    /* turns about a pin */
    assert_int_equal(count_with_springs(0, 1e11, 0), 1);    /* shifts without turning */
    assert_int_equal(count_with_springs(1e12, 0, 1e12), 0); /* simply supported */
}

POOL_TEST(rigid_modes_become_bending_modes_one_by_one_as_springs_stiffen)
{
    int last = 2;
    for (double stiffness = 1e3; stiffness < 2e12; stiffness *= 10) {
        int now = count_with_springs(stiffness, 0, stiffness);
        assert_true(now <= last);
        last = now;
    }
    assert_int_equal(last, 0);
}
