/* What the ROSS script states of sections, rods, joints and masses, by the formulas of ROSS; what it leaves out; names in it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "export/ross.h"
#include "export/ross_parts.h"
#include "exported.h"

#define SMALL                                                                                                                    \
    STEEL "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.2, 0, 3\n" TIES                                                             \
          ", 2\n*DISK\n0.2, 1\n*CAUSE, NAME=ring, TYPE=added_mass\nmass, 0.7\n"                                                  \
          "z, 0.3\n"

static void assert_gives(const struct ross_section *s, const struct element *element)
{
    double pi = acos(-1), d = s->outer * s->outer, h = s->inner * s->inner, area = pi * (d - h) / 4,
           inertia = area * (d + h) / 16;
    double r = h / d, p = (1 + r) * (1 + r); /* ROSS: Cowper's coefficient with Poisson's ratio of the material */
    double shear = 6 * p * (1 + s->nu) / (p * (7 + 6 * s->nu) + r * (20 + 12 * s->nu));
    assert_true(s->outer > s->inner && s->inner >= 0);
    assert_close(s->e * inertia, element->ei, 1e-12, 0);
    assert_close(shear * s->g * area, element->kgs, 1e-12, 0);
    assert_close(s->rho * area, element->rhos, 1e-12, 0);
    assert_close(s->rho * inertia, element->rhoi, 1e-12, 0);
}

/* Every element of the axis by the formulas of ROSS; returns how many are not as their card says. */
static int check_sections(const struct beam *beam)
{
    int equivalent = 0;
    for (int e = 0; e < beam->mesh.nelement; e++) {
        struct ross_section section;
        struct element element;
        assert_status(ross_axis_section(&test_pool, beam, e, &section), ROTID_OK);
        axis_quantities(beam, e, &element);
        assert_gives(&section, &element);
        equivalent += section.equivalent != NULL;
    }
    return equivalent;
}

static void test_ross_sections_give_the_element(void **state)
{
    (void)state;
    struct export_model model = model_of(STEEL CORE "*SHAFT, NAME=left, MATERIAL=steel\n0.25, 0.08, 0.02, 4\n*SHAFT, NAME=core, "
                                                    "MATERIAL=sheets\n0.5, 0.2, 0.05, 8\n");
    struct ross_section section;
    assert_int_equal(check_sections(&model.discrete->discrete.beam), 0);
    assert_status(ross_axis_section(&test_pool, &model.discrete->discrete.beam, 6, &section), ROTID_OK);
    assert_true(section.outer == 0.2 && section.inner == 0.05 && section.e == 1.1e11 && section.g == 0.35e11 &&
                section.nu == 0.28 && section.rho == 7600);
    model =
        model_of(MIXED); /* a stiffness diameter in 4, a perforated core with a gradient in 9 (a sensor cuts one), density in 6 */
    const struct mesh *mesh = &model.discrete->discrete.beam.mesh;
    assert_int_equal(check_sections(&model.discrete->discrete.beam), mesh->nelement);
    assert_status(ross_axis_section(&test_pool, &model.discrete->discrete.beam, 0, &section), ROTID_OK);
    assert_true(section.outer == 0.08 && section.inner == 0.02);
    assert_string_equal(section.equivalent, "heavy");
    assert_close(section.rho, 1.1 * 7850, 1e-14, 0);
    assert_close(section.e, 2.1e11, 1e-14, 0);
    assert_status(ross_axis_section(&test_pool, &model.discrete->discrete.beam, mesh->nelement - 1, &section), ROTID_OK);
    assert_true(section.outer == 0.09 && section.inner == 0); /* the mass is real, the stiffness is not */
    assert_close(section.e, 2.1e11 * pow(0.08 / 0.09, 4), 1e-13, 0);
    model = model_of(STEEL "*BEAM, NAME=bar, MATERIAL=steel\n0.72, 0.0127, 0.0254, 8\n");
    assert_int_equal(check_sections(&model.discrete->discrete.beam), 8);
    /* holes so far out that what is left has less inertia than a disc of its area would */
    model = model_of(STEEL "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.2, 0, 4\n*PERFORATION, GROUP=core\n24, 0.014, 0.088\n");
    assert_int_equal(check_sections(&model.discrete->discrete.beam), 4);
    assert_status(ross_axis_section(&test_pool, &model.discrete->discrete.beam, 0, &section), ROTID_OK);
    assert_true(section.outer < 0.2 && section.inner == 0);
}

static void test_ross_tie_rods_as_rods_and_as_tube(void **state)
{
    (void)state;
    static const char *const text[] = {FREE TIES "\n", FREE "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end, "
                                                            "MODEL=TUBE\n8, 0.016, 0.07, 40e3\n"};
    for (int tube = 0; tube < 2; tube++) {
        struct export_model model = model_of(text[tube]);
        struct ross_section section;
        struct element element;
        struct stretch stretch;
        ross_tierod_section(&model.discrete->discrete.beam, 0, &section, &stretch);
        tierod_quantities(&model.discrete->discrete.beam, 0, 0.5, &element, &stretch);
        assert_gives(&section, &element);
        assert_close(section.e, (tube ? 1 : 8) * 2.1e11, 1e-14, 0);
        assert_true(tube ? stretch.stiffness == 0 : section.outer == 0.016 && stretch.stiffness > 0);
    }
}

/* What stands where a joint or a mass is: rigid bodies feel nothing of the joint, and the mass is in it once. */
static void test_ross_matrices_of_joint_and_mass(void **state)
{
    (void)state;
    struct export_model model = model_of(MIXED);
    const struct beam *beam = &model.discrete->discrete.beam;
    int found = 0;
    for (int e = 0; e < beam->mesh.nelement; e++) {
        struct ross_matrices matrices;
        struct element element;
        int status = ross_matrices(&test_pool, beam, e, &matrices);
        assert_true(status >= 0);
        if (!status)
            continue;
        axis_quantities(beam, e, &element);
        const double l = element.length, shift[4] = {1, 0, 1, 0}, tilt[4] = {0, 1, l, 1}; /* beta = dx/dz */
        const struct dense_file k = {4, matrices.k}, m = {4, matrices.m}, rotary = {4, matrices.rotary};
        double added = strstr(matrices.why, "ring") ? 0.7 : 0;
        assert_close(quadratic(&k, tilt, tilt) / fabs(k.a[0]), 0, 0, element.force != 0 ? 1e-3 : 1e-13);
        assert_close(quadratic(&k, shift, shift) / fabs(k.a[0]), 0, 0, 1e-13);
        assert_close(matrices.added, added, 1e-15, 0);
        assert_close(quadratic(&m, shift, shift), element.rhos * l + added, 1e-12, 0);
        assert_close(quadratic(&rotary, tilt, tilt), element.rhoi * l, 1e-12, 0);
        assert_close(quadratic(&rotary, shift, shift), 0, 0, 1e-15);
        found++;
    }
    assert_int_equal(found, 2);
}

static void test_what_ross_leaves_out_is_said(void **state)
{
    (void)state;
    struct export_model model = model_of(BARS);
    struct message_list notes;
    struct ross_model ross;
    message_open(&notes, &test_pool);
    assert_status(ross_open(&test_pool, &model, &notes, &ross), ROTID_OK);
    assert_int_equal(notes.count, 3);
    assert_non_null(strstr(notes.item[0].text, "tie rods ties"));
    assert_non_null(strstr(notes.item[1].text, "bars cage"));
    assert_non_null(strstr(notes.item[2].text, "moves its bending modes"));
    assert_true(ross.discrete != model.discrete && ross.deck_hz);
    struct mass_properties mass;
    beam_mass_properties(&ross.discrete->discrete.beam, &mass); /* nothing is lost but flexibility */
    assert_close(mass.mass, model.mass.mass, 1e-13, 0);
    assert_close(mass.center, model.mass.center, 1e-13, 0);
    assert_close(mass.inertia, model.mass.inertia, 1e-13, 0);
    assert_true(model.spectrum.full_hz[0] < 300); /* of the bars, which the script does not have */
    assert_close(ross.spectrum->full_hz[0], ross.deck_hz[0], 1e-2, 0);
    for (int j = 0; j < 3; j++) {
        double nearest = INFINITY; /* what is called its partner is a mode of the deck */
        struct spectrum deck;
        assert_status(spectrum_compute(&test_pool, NULL, &model.job->rotor, 0, NULL, NULL, ROTID_GUYAN, 20, &deck), ROTID_OK);
        for (int i = 0; i < deck.count; i++)
            nearest = fmin(nearest, fabs(deck.full_hz[i] - ross.deck_hz[j]));
        assert_close(nearest, 0, 0, 1e-6);
    }
    model = model_of(MIXED);
    message_open(&notes, &test_pool);
    assert_status(ross_open(&test_pool, &model, &notes, &ross), ROTID_OK);
    assert_int_equal(notes.count, 0);
    assert_true(ross.discrete == model.discrete && !ross.deck_hz);
}

static void test_names_are_words_and_unlike(void **state)
{
    (void)state;
    struct ross_names names = {.pool = &test_pool};
    static const char *const wanted[] = {"core", "core", "a b", "a\"b", NULL, "", "core_2", "k\xc3\xa4se"};
    static const char *const expected[] = {"core", "core_2", "a_b", "a_b_2", "disk", "disk_2", "core_2_2", "k__se"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_string_equal(ross_name(&names, wanted[i], "disk"), expected[i]);
}

static void test_memory_that_runs_out(void **state)
{
    (void)state;
    static struct job job;
    open_job(SMALL, &job);
    for (long n = 1;; n++) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list notes;
        struct export_model model;
        struct ross_model ross;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        message_open(&notes, &pool);
        FILE *stream = fopen("/dev/null", "wb");
        assert_non_null(stream);
        int status = export_model_open(&pool, &job, NULL, "1.2.3", 1, &model);
        if (!status)
            status = ross_open(&pool, &model, &notes, &ross);
        if (!status)
            status = ross_write(&pool, stream, &ross);
        (void)fclose(stream);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        if (!status && !notes.out_of_memory)
            break;
        assert_true(status == ROTID_ERROR_MEMORY || notes.out_of_memory);
        assert_true(n < 100000);
    }
}

/* Versions of ROSS differ in what they pass: frequency, synchronous. tests/peers/export_peer.py calls them with both. */
static void test_matrices_take_further_arguments(void **state)
{
    (void)state;
    static const char *const text[] = {MIXED, FREE TIES ", 4\n*SPRING, NAME=s\n0.2, 1e6, 1e4\n",
                                       FREE "*CAUSE, NAME=c, TYPE=joint, AT=core.start\nflexibility, 1e-7\n"};
    int methods = 0;
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        struct export_model model = model_of(text[i]);
        struct message_list notes;
        struct ross_model ross;
        char *script = NULL;
        size_t length;
        FILE *stream = open_memstream(&script, &length);
        assert_non_null(stream);
        message_open(&notes, &test_pool);
        assert_status(ross_open(&test_pool, &model, &notes, &ross), ROTID_OK);
        assert_status(ross_write(&test_pool, stream, &ross), ROTID_OK);
        (void)fclose(stream);
        for (const char *at = script; (at = strstr(at, "    def ")); at++)
            if (strchr("KMG", at[8]) && at[9] == '(') {
                assert_int_equal(strncmp(at + 9, "(self, *args, **kwargs):", 24), 0);
                methods++;
            }
        free(script);
    }
    assert_true(methods >= 6);
}

#define WITH_POOL(test) cmocka_unit_test_setup_teardown(test, open_test_pool, close_test_pool)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_POOL(test_ross_sections_give_the_element),  WITH_POOL(test_ross_tie_rods_as_rods_and_as_tube),
        WITH_POOL(test_ross_matrices_of_joint_and_mass), WITH_POOL(test_what_ross_leaves_out_is_said),
        WITH_POOL(test_names_are_words_and_unlike),      WITH_POOL(test_memory_that_runs_out),
        WITH_POOL(test_matrices_take_further_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
