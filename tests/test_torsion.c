/* Torsion and axial motion at rest: bars beside closed forms, exact dynamic stiffness and chains of rigid inertias, their
 * derivatives, and what a deck makes of them. */
#include "deck/deck.h"
#include "folder.h"
#include "linalg/linalg.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "reading.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.3\n*DENSITY\n7850\n"

/* n elements of length l of a free bar: w^2 = 6 (c/j) (1 - cos b l)/(l^2 (2 + cos b l)), b = k pi/L */
POOL_TEST(free_bar_has_the_frequencies_of_its_elements)
{
    const double modulus[2] = {8e10, 2.1e11};
    for (int type = ROTID_TORSION; type <= ROTID_AXIAL; type++) {
        double hz[6];
        read_frequencies(STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.2, 0.05, 0.02, 40\n", type, 6, hz);
        for (int k = 1; k <= 6; k++) {
            double l = 1.2 / 40, c = cos(k * pi / 40), speed2 = modulus[type - 1] / 7850;
            assert_close(hz[k - 1], sqrt(6 * speed2 * (1 - c) / (2 + c)) / l / (2 * pi), 1e-9, 0);
            assert_close(hz[k - 1], k / 2.4 * sqrt(speed2), 0.05, 0);
        }
    }
}

/* Two sections, a disk on the right end, a spring at the left one: c b tan is carried from left to right by exact shapes. */
struct stepped {
    double speed, spring, inertia, length[2], impedance[2]; /* impedance: c of the section, stiffness times length */
};

static double end_moment(const struct stepped *s, double w)
{
    double u = 1, force = s->spring, b = w / s->speed;
    for (int i = 0; i < 2; i++) {
        double cb = s->impedance[i] * b, cosine = cos(b * s->length[i]), sine = sin(b * s->length[i]),
               next = u * cosine + force / cb * sine;
        force = force * cosine - u * cb * sine;
        u = next;
    }
    return force - w * w * s->inertia * u;
}

static void exact_frequencies(const struct stepped *s, int count, double *hz)
{
    double step = 2 * pi * 5, w = step, before = end_moment(s, w);
    for (int found = 0; found < count; w += step) {
        double now = end_moment(s, w + step), low = w, high = w + step;
        for (int i = 0; i < 80 && now * before < 0; i++) {
            double middle = (low + high) / 2;
            if (end_moment(s, middle) * before < 0)
                high = middle;
            else
                low = middle;
        }
        if (now * before < 0)
            hz[found++] = (low + high) / (4 * pi);
        before = now;
    }
}

/* Elements of l = 2 mm raise a frequency by at most (b l)^2/24 of it, and less where disk and spring hold the energy. */
POOL_TEST(stepped_bar_with_disk_and_spring_is_exact)
{
    const double outer[2] = {0.06, 0.09}, inner[2] = {0.01, 0.01};
    static const char text[] = STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n0.4, 0.06, 0.01, 200\n0.5, 0.09, 0.01, 250\n"
                                     "*DISK, NAME=d\n0.9, 12, 0.1, 0.35\n*SPRING\n0, 1e7, 0, 4e5, 3e8\n";
    for (int type = ROTID_TORSION; type <= ROTID_AXIAL; type++) {
        int twist = type == ROTID_TORSION;
        struct stepped s = {sqrt((twist ? 8e10 : 2.1e11) / 7850), twist ? 4e5 : 3e8, twist ? 0.35 : 12, {0.4, 0.5}, {0, 0}};
        double hz[4], exact[4];
        for (int i = 0; i < 2; i++) {
            double polar = pi / 32 * (pow(outer[i], 4) - pow(inner[i], 4)), area = pi / 4 * (pow(outer[i], 2) - pow(inner[i], 2));
            s.impedance[i] = twist ? 8e10 * polar : 2.1e11 * area;
        }
        exact_frequencies(&s, 4, exact);
        /* the lowest one has more energy in the spring than in the bar and counts as one of the supports */
        read_frequencies(text, type, 4, hz);
        int skipped = fabs(hz[0] / exact[0] - 1) > 0.01;
        for (int k = 0; k + skipped < 4; k++) {
            double exactly = exact[k + skipped], raised = pow(2 * pi * exactly / s.speed * 0.002, 2) / 24;
            assert_close(hz[k], exactly * (1 + raised / 2), 0.51 * raised + 1e-9, 0);
        }
    }
}

/* cases/running/B13: chains of rigid inertias on springs, as bars that weigh nothing. */
POOL_TEST(chains_of_inertias_have_the_printed_frequencies)
{
    static const struct {
        int count;
        double inertia[5], stiffness[4], hz[4];
    } cases[] = {{2, {211.4, 8.3}, {9.775e6}, {176.1}},
                 {5, {3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05}, {12e3, 12e3, 14e3, 10e3}, {81.21, 141.21, 378.95, 536.36}}};
    for (int c = 0; c < 2; c++) {
        char *text = "*MATERIAL, NAME=a\n*ELASTIC, TYPE=SHEAR\n2e11, 8e10, 0.3\n*DENSITY\n1e-2\n*SHAFT, NAME=s, MATERIAL=a\n";
        double hz[4], z = 0;
        for (int i = 0; i + 1 < cases[c].count; i++) /* k = G pi d^4/(32 l), l = 0.1 */
            text =
                pool_format(&test_pool, "%s0.1, %.15g, 0, 1\n", text, pow(32 * 0.1 * cases[c].stiffness[i] / (8e10 * pi), 0.25));
        for (int i = 0; i < cases[c].count; i++, z += 0.1)
            text = pool_format(&test_pool, "%s*DISK\n%.12g, 0, 0, %g\n", text, z, cases[c].inertia[i]);
        read_frequencies(text, ROTID_TORSION, cases[c].count - 1, hz);
        for (int k = 0; k + 1 < cases[c].count; k++)
            assert_close(hz[k], cases[c].hz[k], c ? 1e-4 : 5e-4, 0); /* within the printed digits */
    }
}

/* Saint-Venant's constants of rectangles, J = k a b^3: Timoshenko and Goodier, article 109 */
POOL_TEST(rectangles_have_the_printed_torsion_constants)
{
    const double ratio[3] = {1, 2, 10}, printed[3] = {0.1406, 0.229, 0.312};
    for (int i = 0; i < 3; i++) {
        struct section section, turned;
        section_rectangular(ratio[i] * 0.01, 0.01, &section);
        section_rectangular(0.01, ratio[i] * 0.01, &turned);
        assert_close(section.torsion / (ratio[i] * 1e-8), printed[i], 3e-3, 0);
        assert_close(turned.torsion, section.torsion, 1e-14, 0);
        assert_close(section.polar, ratio[i] * 1e-4 * (1 + ratio[i] * ratio[i]) * 1e-4 / 12, 1e-14, 0);
    }
}

/* ---- a rotor with everything */

static struct rotor *workshop(void)
{
    static struct bars bars;
    static struct disk disk;
    struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    rotor->group[0].preload = 2e6;
    rotor->group[1].holes = 12;
    rotor->group[1].hole_diameter = 0.033;
    rotor->group[1].hole_pitch = 0.13364;
    bars = (struct bars){"bars", rotor->group[0].material, 1.05, 0.5, BUNDLE_RODS, 12, 4, 0.02, 0.11};
    disk = (struct disk){"fan", 0.2, 12, 0.4, 0.8, 0, 0};
    rotor->bars = &bars;
    rotor->disk = &disk;
    rotor->nbars = rotor->ndisk = 1;
    return rotor;
}

static void assemble(struct discrete *d, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    rotid_matrix s;
    discrete_structure(d, &s);
    assert_status(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, k), ROTID_OK);
    assert_status(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, m), ROTID_OK);
    discrete_assemble(d, x, k, m);
}

/* Nothing resists a rigid motion; its inertia is that of the parts: axially the mass of the beam, in torsion the polar inertia.
 */
POOL_TEST(rigid_motion_has_the_inertia_of_the_parts)
{
    const struct rotor *rotor = workshop();
    for (int as = AS_TORSION; as <= AS_SOLID_AXIAL; as++) {
        int twist = as == AS_TORSION || as == AS_SOLID_TORSION;
        struct discrete d;
        struct mass_properties whole;
        rotid_matrix k, m;
        int failed;
        assert_status(discrete_build(&test_pool, (enum discretisation)as, rotor, 0, NULL, 1, &d, &failed), ROTID_OK);
        assemble(&d, NULL, &k, &m);
        double *u = POOL_ARRAY(&test_pool, double, 2 * k.n), *work = POOL_ARRAY(&test_pool, double, k.n), expected = 0;
        assert_int_equal(discrete_rigid_motions(&d, u), 1);
        discrete_mass_properties(&d, &whole);
        if (!twist) {
            expected = whole.mass;
        } else {
            const struct tierod *rod = &rotor->tierod[0];
            const struct bars *bars = &rotor->bars[0];
            for (int s = 0; s < rotor->nsegment; s++) {
                struct section section;
                assert_status(section_of_segment(rotor, s, &section), ROTID_OK);
                expected +=
                    2 * section.mass_inertia * rotor->segment[s].length * rotor->group[rotor->segment[s].group].material.rho;
            }
            expected += 0.8 + bars->material.rho * bars->length * 12 * pi / 4 * 0.02 * 0.02 * (0.11 * 0.11 + 0.02 * 0.02 / 8);
            const struct mesh *mesh = &d.beam.mesh; /* rods end at nodes, of a solid at lines */
            int from, to;
            if (as == AS_SOLID_TORSION)
                solid_mesh_member(rotor, &d.solid.mesh, 0, &from, &to);
            expected += rod->material.rho *
                        (as == AS_TORSION ? mesh->z[mesh->tierod[0].last_end] - mesh->z[mesh->tierod[0].first_end]
                                          : d.solid.mesh.z[to] - d.solid.mesh.z[from]) *
                        rod->number * pi / 4 * rod->diameter * rod->diameter *
                        (rod->pitch * rod->pitch + rod->diameter * rod->diameter / 8);
        }
        assert_close(matrix_product(&m, u, u, work), expected, as == AS_SOLID_TORSION ? 1e-2 : 1e-9, 0); /* holes are smeared */
        for (int i = 0; i < k.n; i++)
            u[k.n + i] = (double)i / k.n;
        assert_close(matrix_product(&k, u, u, work), 0, 0, 1e-9 * matrix_product(&k, u + k.n, u + k.n, work));
    }
}

/* In an even twist, rods at the radius of gyration of the section that they press together gain what its fibres lose. */
/* A rigid rotation is the same for springs, disks and rods, also with few elements across, as below the thin sleeve of the narrow
 * end here. */
POOL_TEST(springs_disks_and_rods_of_a_solid_turn_as_the_section_does)
{
    struct message_list messages;
    struct job job;
    struct discrete d;
    rotid_matrix k, m;
    double inertia[2];
    int failed;
    read_job(STEEL
             "*SHAFT, NAME=a, MATERIAL=steel\n0.2, 0.1\n*SHAFT, NAME=b, MATERIAL=steel\n0.2, 0.045\n*LAYER, NAME=l, GROUP=b, "
             "MATERIAL=steel\n0.05, 0.045\n*SPRING\n0.4, 1e3, 0, 100\n*DISK, NAME=d\n0.4, 1, 0.5, 1\n"
             "*TIEROD, NAME=t, MATERIAL=steel, FROM=start, TO=end\n4, 0.004, 0.006, 0\n",
             &messages, &job);
    for (int i = 0; i < 2; i++, job.rotor.disk[0].polar = 0) {
        assert_status(discrete_build(&test_pool, AS_SOLID_TORSION, &job.rotor, 0, NULL, 1, &d, &failed), ROTID_OK);
        assemble(&d, NULL, &k, &m);
        double *u = POOL_ARRAY(&test_pool, double, 2 * k.n);
        assert_int_equal(discrete_rigid_motions(&d, u), 1);
        assert_close(matrix_product(&k, u, u, u + k.n), 100, 1e-6, 0);
        inertia[i] = matrix_product(&m, u, u, u + k.n);
    }
    assert_close(inertia[0] - inertia[1], 1, 1e-9, 0);
    assert_close(inertia[1],
                 7850 * pi * (0.2 / 32 * (1e-4 + 6.25e-6) + 4 * 0.4 / 4 * 0.004 * 0.004 * (0.006 * 0.006 + 0.004 * 0.004 / 8)),
                 1e-6, 0);
}

POOL_TEST(tension_of_rods_and_pressure_of_the_core_balance)
{
    const double gyration = sqrt((0.2 * 0.2 + 0.1 * 0.1) / 8), tension = 5e6; /* sqrt(J/S) of the tube */
    double energy[3];
    for (int i = 0; i < 3; i++) {
        struct message_list messages;
        struct job job;
        struct discrete d;
        rotid_matrix k, m;
        int failed;
        read_job(pool_format(&test_pool,
                             STEEL
                             "*SHAFT, NAME=tube, MATERIAL=steel\n1, 0.2, 0.1, 50\n*TIEROD, NAME=t, MATERIAL=steel, FROM=start, "
                             "TO=end, MODEL=RODS, SELF_EQUILIBRATED=YES\n8, 0.02, %.15g, %g, 1\n",
                             i == 2 ? 1.2 * gyration : gyration, i == 1 ? 0 : tension),
                 &messages, &job);
        assert_status(discrete_build(&test_pool, AS_TORSION, &job.rotor, 0, NULL, 1, &d, &failed), ROTID_OK);
        assemble(&d, NULL, &k, &m);
        double *u = POOL_ARRAY(&test_pool, double, 2 * k.n);
        for (int node = 0; node < k.n; node++)
            u[node] = d.beam.mesh.z[node];
        energy[i] = matrix_product(&k, u, u, u + k.n);
    }
    assert_close(energy[0], energy[1], 1e-12, 0);
    double rods = 8 * pi / 64 * pow(0.02, 4); /* N I: 12 E I R^2 of their bending moves with the radius too */
    assert_close(energy[2] - energy[1], (1.2 * 1.2 - 1) * gyration * gyration * (8 * tension + 12 * 2.1e11 * rods), 1e-9, 0);
}

/* Fibres under the stress F/S that turn with the section pull back with F I_p/S (Wagner), which is more than G J of a thin strip:
 * a free one has w = (k pi/L) sqrt((G J + F I_p/S)/(rho I_p)), in a strip on edge as in a flat one. */
POOL_TEST(tension_stiffens_a_strip_by_its_polar_inertia)
{
    const double height[2] = {0.1, 0.002}, force[3] = {0, 4e4, -300};
    for (int turned = 0; turned < 2; turned++)
        for (int i = 0; i < 3; i++) {
            struct section section;
            double hz[3], width = height[!turned];
            section_rectangular(height[turned], width, &section);
            read_frequencies(pool_format(&test_pool,
                                         STEEL "*BEAM, NAME=strip, MATERIAL=steel\n1, %g, %g, 400\n*PRELOAD, GROUP=strip\n%g\n",
                                         height[turned], width, force[i]),
                             ROTID_TORSION, 3, hz);
            double polar = (0.1 * 0.1 + 0.002 * 0.002) / 12;
            for (int k = 1; k <= 3; k++)
                assert_close(hz[k - 1],
                             k / 2.0 * sqrt((8e10 * section.torsion + force[i] * polar) / (7850 * polar * section.stiff_area)),
                             2e-5 * k * k, 0);
        }
}

/* ---- derivatives */

static const char *const names[] = {"left.E",   "left.nu", "core.E",       "core.G",  "core.rho",
                                    "right.nu", "ties.E",  "ties.tension", "fan.mass"};
enum { PARAMETERS = sizeof names / sizeof *names };
/* bits of what depends on them: K 1, M 2 */
static const int moves[2][PARAMETERS] = {{1, 1, 0, 1, 2, 1, 1, 1, 0}, {1, 0, 1, 0, 2, 0, 1, 0, 2}};

POOL_TEST(derivatives_are_those_of_differences)
{
    struct rotor *rotor = workshop();
    for (int as = AS_TORSION; as <= AS_SOLID_AXIAL; as++) {
        int type = as == AS_AXIAL || as == AS_SOLID_AXIAL, refine = as == AS_TORSION || as == AS_AXIAL;
        struct parameter parameter[PARAMETERS];
        struct discrete d;
        double x[PARAMETERS];
        const char *unit;
        int failed;
        for (int p = 0; p < PARAMETERS; p++) {
            assert_int_equal(parameter_find(rotor, names[p], &parameter[p], &unit), 0);
            x[p] = *parameter_value(rotor, parameter[p]);
        }
        assert_status(discrete_build(&test_pool, (enum discretisation)as, rotor, PARAMETERS, parameter, refine, &d, &failed),
                      ROTID_OK);
        for (int p = 0; p < PARAMETERS; p++) {
            rotid_matrix a[2][2], exact[2];
            int from, end;
            double start = x[p], step = 1e-4 * start;
            assemble(&d, x, &exact[0], &exact[1]);
            matrix_zero(&exact[0]);
            matrix_zero(&exact[1]);
            discrete_differentiate(&d, p, &exact[0], &exact[1], &from, &end);
            for (int side = 0; side < 2; side++) {
                x[p] = start + (side ? step : -step);
                assemble(&d, x, &a[side][0], &a[side][1]);
            }
            x[p] = start;
            int n = exact[0].n;
            double *u = POOL_ARRAY(&test_pool, double, 2 * n), *work = POOL_ARRAY(&test_pool, double, n);
            for (int w = 0; w < 2; w++) {
                double size = 0, error = 0, whole = 0;
                for (int vector = 0; vector < 4; vector++) { /* any two motions */
                    for (int i = 0; i < 2 * n; i++)
                        u[i] = sin(1 + i * (2.1 + 0.37 * vector));
                    double difference =
                               (matrix_product(&a[1][w], u, u + n, work) - matrix_product(&a[0][w], u, u + n, work)) / (2 * step),
                           value = matrix_product(&exact[w], u, u + n, work);
                    size = fmax(size, fabs(value));
                    whole = fmax(whole, fabs(matrix_product(&a[0][w], u, u, work)) / start);
                    error = fmax(error, fabs(value - difference));
                }
                assert_close(error, 0, 0, 1e-6 * size + 1e-10 * whole);
                if (moves[type][p] & (1 << w))
                    assert_true(size > 0);
                else if (as <= AS_AXIAL) /* the sections of a solid deform in themselves, with the other constants */
                    assert_close(size, 0, 0, 0);
            }
        }
    }
}

/* ---- solids: harmonic 0 */

/* A uniform bar: torsion k c/2L exactly; along it the inertia of the contraction, Love: (1 - (nu k pi r/L)^2/2), r^2 = (a^2 +
 * b^2)/2. */
POOL_TEST(free_solid_has_the_frequencies_of_a_continuous_bar)
{
    const double modulus[2] = {8e10, 2.1e11}, gyration2 = (0.025 * 0.025 + 0.01 * 0.01) / 2;
    for (int type = ROTID_TORSION; type <= ROTID_AXIAL; type++) {
        double hz[4];
        read_frequencies(STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.2, 0.05, 0.02\n*FIT, MODEL=SOLID\n", type, 4, hz);
        for (int k = 1; k <= 4; k++) {
            double slender = pow(0.3 * k * pi / 1.2, 2) * gyration2, love = type == ROTID_AXIAL ? 1 - slender / 2 : 1;
            assert_close(hz[k - 1], k / 2.4 * sqrt(modulus[type - 1] / 7850) * love,
                         2e-6 + (type == ROTID_AXIAL ? 4 * slender * slender : 0), 0);
        }
    }
}

/* Layers of one wave speed turn as one; a disk at one end and a spring at the other move with the mean of their section, which is
 * that of the whole where it is of one material. */
POOL_TEST(layers_disk_and_spring_of_a_solid_are_those_of_a_bar)
{
    static const char layered[] = STEEL "*MATERIAL, NAME=soft\n*ELASTIC, TYPE=SHEAR\n1.05e11, 4e10, 0.3\n*DENSITY\n3925\n"
                                        "*SHAFT, NAME=bar, MATERIAL=steel\n0.9, 0.04, 0\n*LAYER, NAME=l, GROUP=bar, "
                                        "MATERIAL=soft\n0.06, 0.04\n*FIT, MODEL=SOLID\n",
                      held[] = STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n0.9, 0.06, 0\n*DISK, NAME=d\n0.9, 12, 0.1, "
                                     "0.02\n*SPRING\n0, 1e3, 0, 2e4, 3e8\n*FIT, MODEL=SOLID\n";
    double hz[4], exact[4];
    struct stepped s = {sqrt(8e10 / 7850), 2e4, 0.02, {0.45, 0.45}, {0, 0}};
    s.impedance[0] = s.impedance[1] = 8e10 * pi / 32 * pow(0.06, 4);
    exact_frequencies(&s, 4, exact);
    read_frequencies(held, ROTID_TORSION, 3, hz);
    for (int k = 0; k < 3; k++)
        assert_close(hz[k], exact[k + (fabs(hz[0] / exact[0] - 1) > 0.05)], 1e-6, 0);
    read_frequencies(layered, ROTID_TORSION, 3, hz);
    for (int k = 0; k < 3; k++)
        assert_close(hz[k], (k + 1) / 1.8 * s.speed, 1e-6, 0);
}

/* ---- decks */

#define HUNG                                                                                                                     \
    STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.0, 0.05, 0, 100\n*SENSORS\n1, 0\n2, 0.3\n3, 0.55\n4, 1.0\n*NOISE, "               \
          "FREQUENCY=0.001\n"                                                                                                    \
          "*IDENTIFY\nbar.E, 1e11, 3e11, 1.9e11\nbar.G, 4e10, 2e11, 7e10\n"
static const char *const words[3] = {"BENDING", "TORSION", "AXIAL"};

/* Frequencies of the model at E = 2.1e11, G = 8e10 as measured modes. */
static char *measured(int type, int count)
{
    double hz[6];
    read_frequencies(STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.0, 0.05, 0, 100\n*SENSORS\n1, 0\n2, 0.3\n3, 0.55\n4, 1.0\n", type,
                     count, hz);
    char *text = pool_format(&test_pool, "*MODES, TYPE=%s\n", words[type]);
    for (int k = 0; k < count; k++)
        text = pool_format(&test_pool, "%s%d, %.12g\n", text, k + 1, hz[k]);
    return text;
}

static rotid_identification *identified(const char *text)
{
    rotid_identification *found;
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = read_handle(text, 0, NULL);
    int status = rotid_identify(deck, 0, NULL, failure, &found);
    if (status)
        print_message("%s\n", failure);
    assert_status(status, ROTID_OK);
    rotid_deck_free(deck);
    return found;
}

POOL_TEST(torsion_alone_gives_g_and_axial_motion_e)
{
    for (int i = 0; i < 4; i++) {
        int type = i % 2 ? ROTID_AXIAL : ROTID_TORSION, seen = type == ROTID_TORSION;
        rotid_identification *found =
            identified(pool_format(&test_pool, "%s*FIT, MODEL=%s\n%s", HUNG, i < 2 ? "BEAM" : "SOLID", measured(type, 2)));
        /* those of the data are bars of 100 elements, raised by (k pi/100)^2/24 in frequency, and do not contract */
        assert_close(found->parameters[seen].value, seen ? 8e10 : 2.1e11, i < 2 ? 1e-7 : seen ? 4e-4 : 2e-3, 0);
        assert_true(found->parameters[seen].identifiable);
        assert_false(found->parameters[!seen].identifiable);
        assert_string_equal(found->modes[1].type, words[type]);
        rotid_identification_free(found);
    }
}

/* Bending hardly sees G of a slender bar: with torsion as a second state its interval shrinks, and a third state is predicted. */
POOL_TEST(bending_and_torsion_are_fitted_together)
{
    const char *bending = measured(ROTID_BENDING, 3), *torsion = measured(ROTID_TORSION, 2), *axial = measured(ROTID_AXIAL, 2);
    rotid_identification *alone = identified(pool_format(&test_pool, HUNG "%s", bending)),
                         *both = identified(pool_format(&test_pool,
                                                        HUNG
                                                        "*FIT, FUNCTIONAL=LIKELIHOOD, HOLDOUT=STATE:pulled\n*STATE, NAME=hung\n%s"
                                                        "*STATE, NAME=twisted\n%s*STATE, NAME=pulled\n%s",
                                                        bending, torsion, axial));
    assert_close(both->parameters[0].value, 2.1e11, 1e-7, 0);
    assert_close(both->parameters[1].value, 8e10, 1e-7, 0);
    assert_true(both->parameters[1].std < 0.2 * alone->parameters[1].std);
    assert_int_equal(both->nmodes, 7);
    for (int k = 0; k < both->nmodes; k++) {
        assert_string_equal(both->modes[k].type, words[k < 3 ? 0 : k < 5 ? 1 : 2]);
        assert_int_equal(both->modes[k].holdout, k >= 5);
        assert_close(both->modes[k].error_percent, 0, 0, 1e-5);
    }
    rotid_identification_free(alone);
    rotid_identification_free(both);
}

/* Shapes are rotations at the sensors: cos(k pi z/L); they pair modes whose numbers are wrong. */
POOL_TEST(shapes_of_torsion_pair_its_modes)
{
    double hz[2];
    const double z[4] = {0, 0.3, 0.55, 1};
    read_frequencies(STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.0, 0.05, 0, 100\n", ROTID_TORSION, 2, hz);
    char *text = pool_format(&test_pool, HUNG "*MODES, TYPE=TORSION\n1, %.12g\n*SHAPE, MODE=1\n", hz[1]);
    for (int s = 0; s < 4; s++)
        text = pool_format(&test_pool, "%s%d, %.9g\n", text, s + 1, 3 * cos(2 * pi * z[s]));
    rotid_identification *found = identified(text);
    assert_int_equal(found->modes[0].mode, 2);
    assert_close(found->modes[0].mac, 1, 1e-4, 0);
    assert_close(found->parameters[1].value, 8e10, 1e-7, 0);
    rotid_identification_free(found);
}

POOL_TEST(what_is_of_bending_alone_is_refused)
{
    struct reading r;
    rotid_diagnosis *diagnosis;
    rotid_suggestion *suggestion;
    rotid_spectrum *spectrum;
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = read_handle(pool_format(&test_pool, HUNG "%s", measured(ROTID_TORSION, 2)), 0, NULL);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &diagnosis), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(failure, "a diagnosis is of bending, expected no *MODES, TYPE=TORSION"));
    assert_status(rotid_suggest(deck, NULL, NULL, failure, &suggestion), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_spectrum_of_type(deck, 3, NULL, 2, NULL, failure, &spectrum), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_spectrum_of_type(deck, ROTID_BENDING, NULL, 2, NULL, failure, &spectrum), ROTID_OK);
    assert_null(spectrum->modes[0].measured); /* which is of torsion */
    rotid_spectrum_free(spectrum);
    rotid_deck_free(deck);
    try_path(&r, folder_write("whirl.inp", HUNG "*MODES, TYPE=WHIRL\n1, 100\n"), NULL);
    assert_non_null(find_message(&r.messages, "BENDING"));
    pool_close(&r.pool);
}

POOL_TEST(what_a_type_does_not_see_is_said)
{
    struct message_list messages;
    struct job job;
    read_job(pool_format(&test_pool, HUNG "*DISK\n0.3, 5\n*FIT, MODEL=SOLID\n%s", measured(ROTID_TORSION, 2)), &messages, &job);
    assert_non_null(find_message(&messages, "the disk at 0.3 m has no polar inertia"));
    assert_int_equal(job_discretisation(&job), AS_SOLID_TORSION);
}

/* The one writer of decks gives the type back. */
POOL_TEST(type_is_written_and_read_back)
{
    struct states given = read_states(pool_format(&test_pool, HUNG "%s", measured(ROTID_TORSION, 2))), again;
    struct message_list notes;
    const struct deck_write_options options = {0, NULL, NULL};
    char *text;
    message_open(&notes, &test_pool);
    assert_status(deck_write(&test_pool, &given, &given, &options, &notes, &text), ROTID_OK);
    assert_status(deck_read_back(&test_pool, given.state->job.deck, text, ".", &notes, &again), ROTID_OK);
    assert_int_equal(again.state->job.options.type, MODE_TORSION);
    struct states other = again;
    other.state->job.options.type = MODE_AXIAL;
    assert_true(deck_compare(&test_pool, &given.state->job, &other.state->job, &(const char *){NULL}) & DECK_OTHER_DATA);
}

TEST_GROUP(folder_make, folder_remove);
