/* dK/dx and dM/dx of the assembled rotor for every kind of parameter, against differences of the assembled matrices; and what
 * beam_build refuses. */
#include "linalg/linalg.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "support.h"

/* The paper's rotor with a group of each shape of section, bars, a disk and holes, so that every branch has something to
 * differentiate: the left shaft is bored, the right one rectangular, the core perforated. */
static struct rotor *workshop(enum bundle_model model, int self_equilibrated, int rod_elements)
{
    static struct bars bars;
    static struct disk disk;
    struct rotor *rotor = paper_rotor(model, self_equilibrated);
    rotor->tierod[0].elements = rod_elements;
    rotor->group[0].preload = 2e6;
    rotor->group[1].holes = 12;
    rotor->group[1].hole_diameter = 0.033;
    rotor->group[1].hole_pitch = 0.13364;
    for (int s = 0; s < rotor->nsegment; s++) {
        struct segment *segment = &rotor->segment[s];
        if (segment->group == 0)
            segment->inner = 0.03;
        if (segment->group == 2) {
            segment->rectangular = 1;
            segment->height = segment->outer;
            segment->width = 0.1;
        }
    }
    bars = (struct bars){"bars", rotor->group[0].material, 1.05, 0.5, model, 12, 4, 0.02, 0.11};
    disk = (struct disk){"fan", 0.2, 12, 0.4, 0.8, 0, 0};
    rotor->bars = &bars;
    rotor->disk = &disk;
    rotor->nbars = rotor->ndisk = 1;
    rotor->spring[0].lateral = 3e8; /* stiff enough that rounding of the shaft's stiffness does not drown it */
    rotor->spring[0].rotational = 3e5;
    return rotor;
}

/* Largest entries of a difference and of a matrix, rotations divided by the length of an element: every entry then has the unit
 * of a translational stiffness, and none hides behind another. b may be NULL. */
static double largest(const rotid_matrix *a, const rotid_matrix *b)
{
    const double h = 0.0116;
    double most = 0;
    for (int j = 0; j < a->n; j++)
        for (int d = 0; d <= a->kd && j + d < a->n; d++) {
            double scale = (j % 2 ? 1 / h : 1) * ((j + d) % 2 ? 1 / h : 1);
            int place = d + j * (a->kd + 1);
            most = fmax(most, scale * fabs(a->band[place] - (b ? b->band[place] : 0)));
        }
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++) {
            double scale = (a->far[f] % 2 ? 1 / h : 1) * (a->far[g] % 2 ? 1 / h : 1);
            int place = f + g * a->nfar;
            most = fmax(most, scale * fabs(a->block[place] - (b ? b->block[place] : 0)));
        }
    return most;
}

static rotid_matrix zero_like(const struct mesh *mesh)
{
    rotid_matrix a;
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, &a), ROTID_OK);
    return a;
}

/* Error of the derivative with respect to parameter p at x, relative to its largest entry, the larger of K's and M's. `wanted`
 * tells whether K or M or both (1, 2, 3) depend on the parameter; the derivative of one that does not is zero but for rounding.
 */
static double error_of(struct beam *beam, int p, int wanted)
{
    const double step[4] = {1e-3, -1e-3, 2e-3, -2e-3}, weight[4] = {8, -8, -1, 1};
    const struct mesh *mesh = &beam->mesh;
    rotid_matrix exact[2], difference[2], value[2];
    double x[16], start, error = 0;
    for (int a = 0; a < 2; a++) {
        exact[a] = zero_like(mesh);
        difference[a] = zero_like(mesh);
        value[a] = zero_like(mesh);
    }
    for (int q = 0; q < beam->nparameter; q++)
        x[q] = *parameter_value(&beam->rotor, beam->parameter[q]);
    start = x[p];
    assert_true(start != 0);
    beam_assemble(beam, x, &value[0], &value[1]);
    beam_differentiate(beam, p, &exact[0], &exact[1]);
    for (int s = 0; s < 4; s++) {
        x[p] = start * (1 + step[s]);
        matrix_zero(&value[0]);
        matrix_zero(&value[1]);
        beam_assemble(beam, x, &value[0], &value[1]);
        for (int a = 0; a < 2; a++)
            matrix_combine(1, &difference[a], weight[s] / (12 * 1e-3 * start), &value[a], &difference[a]);
    }
    x[p] = start;
    matrix_zero(&value[0]);
    matrix_zero(&value[1]);
    beam_assemble(beam, x, &value[0], &value[1]);
    for (int a = 0; a < 2; a++) {
        double size = largest(&exact[a], NULL), whole = largest(&value[a], NULL) / fabs(start);
        if (wanted & (1 << a)) {
            assert_true(size > 1e-9 * whole);
            error = fmax(error, largest(&exact[a], &difference[a]) / size);
        } else {
            assert_close(size, 0, 0, 1e-15 * whole);
            assert_close(largest(&difference[a], NULL), 0, 0, 1e-12 * whole);
        }
    }
    return error;
}

static const struct case_of_parameter {
    const char *name;
    int wanted;
    double tolerance;
} cases[] = {{"left.E", 3, 1e-7},   {"left.nu", 3, 1e-6},     {"left.rho", 2, 1e-9}, {"core.E", 3, 1e-7},
             {"core.G", 3, 1e-7},   {"core.nu", 3, 1e-6},     {"core.rho", 2, 1e-9}, {"right.E", 3, 1e-7},
             {"right.nu", 3, 1e-6}, {"right.rho", 2, 1e-9},   {"ties.E", 1, 1e-7},   {"ties.tension", 1, 1e-6},
             {"start.k", 1, 1e-6},  {"start.k_rot", 1, 1e-6}, {"fan.mass", 2, 1e-9}, {"fan.inertia", 2, 1e-9}};

#define CASES ((int)(sizeof cases / sizeof *cases))

/* All parameters at once. Isotropic rods: their E is their G too, and for an isotropic material M does not depend on E, since the
 * shear factor is a ratio of E and G. */
static void differentiate_all(enum bundle_model model, int self_equilibrated, int rod_elements, int orthotropic_shafts,
                              double *worst)
{
    struct rotor *rotor = workshop(model, self_equilibrated, rod_elements);
    struct parameter parameter[CASES];
    struct beam beam;
    const char *unit;
    int failed;
    rotor->spring[0].name = "start";
    for (int g = 0; g < 3 && orthotropic_shafts; g++) {
        struct material *material = &rotor->group[g].material;
        material->g = material_shear_modulus(material);
        material->isotropic = 0;
    }
    for (int c = 0; c < CASES; c++)
        assert_int_equal(parameter_find(rotor, cases[c].name, &parameter[c], &unit), 0);
    assert_status(beam_build(&test_pool, rotor, CASES, parameter, 1, &beam, &failed), ROTID_OK);
    for (int c = 0; c < CASES; c++) {
        int isotropic = parameter[c].kind == PARAMETER_E && rotor->group[parameter[c].index].material.isotropic;
        double error = error_of(&beam, c, isotropic ? 1 : cases[c].wanted);
        if (error > cases[c].tolerance)
            print_error("%s: relative error of the derivative %.2e\n", cases[c].name, error);
        assert_true(error <= cases[c].tolerance);
        worst[c] = fmax(worst[c], error);
    }
}

POOL_TEST(every_kind_of_parameter_agrees_with_differences_for_rods_and_tube)
{
    double worst[CASES] = {0};
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++)
        for (int balanced = 0; balanced < 2; balanced++)
            for (int elements = 1; elements <= 3; elements += 2)
                for (int orthotropic = 0; orthotropic < 2; orthotropic++)
                    differentiate_all((enum bundle_model)model, balanced, elements, orthotropic, worst);
    for (int c = 0; c < CASES; c++)
        print_message("%-13s %.1e\n", cases[c].name, worst[c]);
}

/* K is of first degree in all moduli, forces and springs together, M of first degree in what has mass (Euler's theorem). */
POOL_TEST(derivatives_times_values_sum_up_to_the_matrices)
{
    for (int model = BUNDLE_RODS; model <= BUNDLE_TUBE; model++) {
        static const char *const name[] = {"left.E",       "core.E",    "core.G",      "right.E",    "ties.E",
                                           "ties.tension", "start.k",   "start.k_rot", "right.k",    "left.rho",
                                           "core.rho",     "right.rho", "fan.mass",    "fan.inertia"};
        enum { count = sizeof name / sizeof *name };
        struct rotor *rotor = workshop((enum bundle_model)model, 1, 3);
        struct parameter parameter[count];
        struct beam beam;
        const char *unit;
        double x[count];
        int failed;
        rotor->group[0].preload = 0; /* no parameter moves it, nor the bars */
        rotor->group[0].name = "left";
        rotor->spring[0].name = "start";
        rotor->nbars = 0;
        for (int p = 0; p < count; p++) {
            assert_int_equal(parameter_find(rotor, name[p], &parameter[p], &unit), 0);
            x[p] = *parameter_value(rotor, parameter[p]);
        }
        assert_status(beam_build(&test_pool, rotor, count, parameter, 1, &beam, &failed), ROTID_OK);
        rotid_matrix k = zero_like(&beam.mesh), m = zero_like(&beam.mesh), dk = zero_like(&beam.mesh), dm = zero_like(&beam.mesh);
        rotid_matrix sum_k = zero_like(&beam.mesh), sum_m = zero_like(&beam.mesh);
        beam_assemble(&beam, x, &k, &m);
        for (int p = 0; p < count; p++) {
            matrix_zero(&dk);
            matrix_zero(&dm);
            beam_differentiate(&beam, p, &dk, &dm);
            matrix_combine(1, &sum_k, x[p], &dk, &sum_k);
            matrix_combine(1, &sum_m, x[p], &dm, &sum_m);
        }
        assert_close(largest(&sum_k, &k) / largest(&k, NULL), 0, 0, 1e-14);
        /* the rods' density is no parameter: their mass stands outside the sum */
        struct rotor *weightless = workshop((enum bundle_model)model, 1, 3);
        weightless->group[0].preload = 0;
        weightless->nbars = 0;
        weightless->tierod[0].material.rho = 0;
        assert_status(beam_build(&test_pool, weightless, 0, NULL, 1, &beam, &failed), ROTID_OK);
        matrix_zero(&k);
        matrix_zero(&m);
        beam_assemble(&beam, NULL, &k, &m);
        assert_close(largest(&sum_m, &m) / largest(&m, NULL), 0, 0, 1e-14);
    }
}

POOL_TEST(parameters_move_the_beams_own_copy_of_the_rotor)
{
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 1);
    struct beam beam;
    int failed;
    assert_status(beam_build(&test_pool, rotor, 2, paper_parameters, 1, &beam, &failed), ROTID_OK);
    rotid_matrix k = zero_like(&beam.mesh), m = zero_like(&beam.mesh);
    beam_assemble(&beam, (double[]){0.9e11, 0.2e11}, &k, &m);
    assert_close(beam.rotor.group[1].material.e, 0.9e11, 0, 0);
    assert_close(beam.rotor.group[1].material.g, 0.2e11, 0, 0);
    assert_close(rotor->group[1].material.e, paper_start[0], 0, 0);
    assert_close(rotor->group[1].material.g, paper_start[1], 0, 0);
}

POOL_TEST(names_find_their_parameter_without_case_and_tell_what_is_wrong)
{
    struct rotor *rotor = workshop(BUNDLE_RODS, 1, 1);
    struct parameter parameter;
    const char *unit = NULL;
    assert_int_equal(parameter_find(rotor, "CORE.e", &parameter, &unit), 0);
    assert_int_equal(parameter.kind, PARAMETER_E);
    assert_int_equal(parameter.index, 1);
    assert_string_equal(unit, "Pa");
    assert_int_equal(parameter_find(rotor, "ties.Tension", &parameter, &unit), 0);
    assert_int_equal(parameter.kind, PARAMETER_TENSION);
    assert_string_equal(unit, "N");
    assert_int_equal(parameter_find(rotor, "right.k", &parameter, &unit), 0); /* a group and a spring share this name */
    assert_int_equal(parameter.kind, PARAMETER_SPRING_K);
    assert_int_equal(parameter.index, 1);
    assert_int_equal(parameter_find(rotor, "right.rho", &parameter, &unit), 0);
    assert_int_equal(parameter.kind, PARAMETER_RHO);
    assert_int_equal(parameter.index, 2);
    assert_int_equal(parameter_find(rotor, "cor.E", &parameter, &unit), 1);
    assert_int_equal(parameter_find(rotor, "core", &parameter, &unit), 1);
    assert_int_equal(parameter_find(rotor, "core.tension", &parameter, &unit), 2);
    assert_int_equal(parameter_find(rotor, "core.", &parameter, &unit), 2);
}

POOL_TEST(impossible_sections_name_their_group_or_bundle)
{
    struct beam beam;
    int failed;
    struct rotor *rotor = workshop(BUNDLE_TUBE, 1, 1);
    rotor->group[1].holes = 400;
    assert_status(beam_build(&test_pool, rotor, 0, NULL, 1, &beam, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, 1);
    rotor = workshop(BUNDLE_TUBE, 1, 1);
    rotor->tierod[0].pitch = 0.02; /* twelve rods of 32 mm in there are more than a disc */
    assert_status(beam_build(&test_pool, rotor, 0, NULL, 1, &beam, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, rotor->ngroup);
    rotor = workshop(BUNDLE_TUBE, 1, 1);
    rotor->bars[0].pitch = 0.01;
    assert_status(beam_build(&test_pool, rotor, 0, NULL, 1, &beam, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, rotor->ngroup + rotor->ntierod);
}

POOL_TEST(no_memory_is_reported_at_every_allocation_of_a_build)
{
    const struct rotor *rotor = workshop(BUNDLE_TUBE, 1, 3);
    int status = ROTID_ERROR_MEMORY, n;
    for (n = 1; status; n++) {
        struct failing_allocator failing;
        struct pool own;
        struct discrete beam;
        int failed, nrigid;
        failing_allocator_open(&failing, n);
        pool_open(&own, &failing.allocator);
        status = discrete_build(&own, AS_BEAM, rotor, 0, NULL, 1, &beam, &failed);
        if (!status)
            status = discrete_count_rigid(&own, &beam, NULL, 0, NULL, &nrigid);
        pool_close(&own);
        assert_int_equal(failing.in_use, 0);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        assert_true(n < 200);
    }
    assert_true(n > 20);
}
