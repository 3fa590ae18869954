/* What rotid export writes, read back by readers of the test's own: the matrices to the last bit, rigid bodies, signs, sections.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "deck/deck.h"
#include "export/dmig.h"
#include "export/matrix_market.h"
#include "export/remark.h"
#include "export/ross.h"
#include "export/ross_parts.h"
#include "export_readers.h"
#include "support.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define CORE  "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.35e11, 0.28\n*DENSITY\n7600\n"
#define SHAFT                                                                                                                    \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.25, 0.08, 0.02, 4\n*SHAFT, NAME=core, MATERIAL=sheets\n0.5, 0.2, 0.05, 8\n"            \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.09, 0, 4, 0.08\n"
#define SENSORS "*SENSORS\n11, 0\n12, 0.2\n13, 0.41\n14, 0.6\n15, 0.8\n16, 1\n"
#define TIES    "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n8, 0.016, 0.07, 40e3"
#define CAUSES                                                                                                                   \
    "*CAUSE, NAME=gap, TYPE=joint, BETWEEN=core,right\nflexibility, 2e-7\n*CAUSE, NAME=ring, TYPE=added_mass\nmass, 0.7\nz, "    \
    "0.333\n"                                                                                                                    \
    "*CAUSE, NAME=slope, TYPE=stiffness_gradient, GROUP=core\nslope, 0.2\n*CAUSE, NAME=heavy, TYPE=density, "                    \
    "GROUP=left\nfactor, 1.1\n"
#define FREE STEEL CORE SHAFT SENSORS
#define MIXED                                                                                                                    \
    FREE TIES "\n*PERFORATION, GROUP=core\n12, 0.02, 0.06\n*SPRING\n0.1, 1e5, 2e3\n*DISK, NAME=fan\n0.9, 6, 0.02, 0.04\n" CAUSES
#define BARS FREE TIES ", 4\n*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.4\n12, 0.012, 0.08, 4\n"

static char deck_name[] = "/tmp/test_export_XXXXXX";

static void open_job(const char *text, struct job *job)
{
    struct message_list messages;
    FILE *stream = fopen(deck_name, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    message_open(&messages, &test_pool);
    int status = deck_read(&test_pool, deck_name, 0, NULL, &messages, job);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%d: %s\n", messages.item[i].line, messages.item[i].text);
    assert_status(status, ROTID_OK);
}

static struct export_model model_of(const char *text)
{
    static struct job job;
    struct export_model model;
    open_job(text, &job);
    assert_status(export_model_open(&test_pool, &job, NULL, "1.2.3", 1, &model), ROTID_OK);
    return model;
}

/* A writer's output as a stream to read. */
static FILE *written(int (*write)(FILE *, const struct export_model *), const struct export_model *model)
{
    FILE *stream = tmpfile();
    assert_non_null(stream);
    assert_status(write(stream, model), ROTID_OK);
    rewind(stream);
    return stream;
}

static struct dense_file market(int (*write)(FILE *, const struct export_model *), const struct export_model *model)
{
    FILE *stream = written(write, model);
    struct dense_file file = read_market(stream);
    (void)fclose(stream);
    return file;
}

static struct dmig_file bulk(int (*write)(FILE *, const struct export_model *), const struct export_model *model)
{
    static struct dmig_file file;
    FILE *stream = written(write, model);
    read_bulk(stream, &file);
    (void)fclose(stream);
    return file;
}

/* The matrix itself, both triangles, by products with unit vectors. */
static double *dense_of(const rotid_matrix *a)
{
    double *dense = POOL_ARRAY(&test_pool, double, (size_t)a->n *(size_t)a->n), *unit = POOL_ARRAY(&test_pool, double, a->n);
    assert_true(dense && unit);
    for (int j = 0; j < a->n; j++) {
        for (int i = 0; i < a->n; i++)
            unit[i] = i == j;
        for (int i = 0; i < a->n; i++) {
            double sum = 0;
            for (int d = -a->kd; d <= a->kd; d++)
                if (i + d == j)
                    sum += a->band[abs(d) + (ptrdiff_t)(i < j ? i : j) * (a->kd + 1)];
            for (int r = 0; r < a->nfar; r++)
                for (int c = 0; c < a->nfar; c++)
                    if (a->far[r] == i && a->far[c] == j)
                        sum += a->block[r + (ptrdiff_t)c * a->nfar];
            dense[i + (ptrdiff_t)j * a->n] = sum;
        }
    }
    return dense;
}

/* rotation: factor on entries of a rotation, -1 where theta became dv/dz */
static void assert_same(const struct dense_file *file, const double *a, double rotation)
{
    for (int j = 0; j < file->n; j++)
        for (int i = 0; i < file->n; i++) {
            double sign = (i % 2 ? rotation : 1) * (j % 2 ? rotation : 1);
            if (file->a[i + (ptrdiff_t)j * file->n] != sign * a[i + (ptrdiff_t)j * file->n])
                fail_msg("entry %d %d is %.17g, expected %.17g", i, j, file->a[i + (ptrdiff_t)j * file->n],
                         sign * a[i + (ptrdiff_t)j * file->n]);
        }
}

static const char *const decks[] = {FREE, MIXED, BARS, STEEL CORE SHAFT};

static void test_matrices_come_back_to_the_last_bit(void **state)
{
    (void)state;
    for (size_t d = 0; d < sizeof decks / sizeof *decks; d++) {
        struct export_model model = model_of(decks[d]);
        const double *k = dense_of(&model.k), *m = dense_of(&model.m);
        struct dense_file file[4] = {market(matrix_market_stiffness, &model), market(matrix_market_mass, &model),
                                     market(matrix_market_condensed_stiffness, &model),
                                     market(matrix_market_condensed_mass, &model)};
        assert_int_equal(file[0].n, model.client->beam.mesh.ndof);
        assert_int_equal(file[2].n, model.job->rotor.nsensor ? model.job->rotor.nsensor : model.client->beam.mesh.naxis);
        assert_same(&file[0], k, 1);
        assert_same(&file[1], m, 1);
        for (int i = 0; i < file[2].n; i++) /* the lower triangle is written; rounding may differ in the upper one */
            for (int j = 0; j <= i; j++) {
                assert_true(file[2].a[i + j * file[2].n] == model.condensed.k[i + j * file[2].n]);
                assert_true(file[3].a[i + j * file[3].n] == model.condensed.m[i + j * file[3].n]);
            }
        struct dmig_file full = bulk(dmig_full, &model);
        struct dense_file dk = dmig_sum(&full, full.k2gg, 0), dm = dmig_sum(&full, full.m2gg, 0);
        assert_same(&dk, k, -1);
        assert_same(&dm, m, -1);
        free(full.text);
        struct dmig_file reduced = bulk(dmig_condensed, &model);
        struct dense_file rk = dmig_sum(&reduced, reduced.k2gg, 1), rm = dmig_sum(&reduced, reduced.m2gg, 1);
        assert_memory_equal(rk.a, file[2].a, sizeof(double) * (size_t)(rk.n * rk.n));
        assert_memory_equal(rm.a, file[3].a, sizeof(double) * (size_t)(rm.n * rm.n));
        free(reduced.text);
        double *all[] = {file[0].a, file[1].a, file[2].a, file[3].a, dk.a, dm.a, rk.a, rm.a};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            free(all[i]);
    }
}

static double quadratic(const struct dense_file *a, const double *u, const double *w)
{
    double sum = 0;
    for (int j = 0; j < a->n; j++)
        for (int i = 0; i < a->n; i++)
            sum += u[i] * a->a[i + (ptrdiff_t)j * a->n] * w[j];
    return sum;
}

/* Mass, centre and inertia of the rotor by hand: three cylinders. */
struct body {
    double mass, moment, inertia; /* about the left end */
};

static void add_cylinder(struct body *body, double rho, double from, double to, double outer, double inner)
{
    double pi = acos(-1), l = to - from, mass = rho * l * pi / 4 * (outer * outer - inner * inner), z = (from + to) / 2;
    body->mass += mass;
    body->moment += mass * z;
    body->inertia += mass * (z * z + l * l / 12 + (outer * outer + inner * inner) / 16);
}

/* A free rotor moved and turned as a rigid body: no stiffness, its own mass. Wrong signs of the rotation would show in both. */
static void test_rigid_bodies_and_signs(void **state)
{
    (void)state;
    struct export_model model = model_of(FREE);
    struct dmig_file full = bulk(dmig_full, &model), reduced = bulk(dmig_condensed, &model);
    struct body body = {0, 0, 0};
    add_cylinder(&body, 7850, 0, 0.25, 0.08, 0.02);
    add_cylinder(&body, 7600, 0.25, 0.75, 0.2, 0.05);
    add_cylinder(&body, 7850, 0.75, 1, 0.09, 0);
    for (int kind = 0; kind < 3; kind++) { /* Matrix Market, DMIG, condensed DMIG */
        int lateral = kind == 2;
        struct dmig_file *file = lateral ? &reduced : &full;
        struct dense_file k = kind ? dmig_sum(file, file->k2gg, lateral) : market(matrix_market_stiffness, &model);
        struct dense_file m = kind ? dmig_sum(file, file->m2gg, lateral) : market(matrix_market_mass, &model);
        double shift[128] = {0}, tilt[128] = {0}, largest = 0;
        assert_true(k.n <= 128);
        for (int i = 0; i < k.n; i++) {
            int rotation = !lateral && i % 2;
            double z = file->z[lateral ? i : i / 2];
            shift[i] = !rotation;
            tilt[i] = rotation ? (kind ? 1 : -1) : z;
            largest = fmax(largest, fabs(k.a[i + i * k.n]));
        }
        assert_close(quadratic(&k, shift, shift) / largest, 0, 0, 1e-13);
        assert_close(quadratic(&k, tilt, tilt) / largest, 0, 0, 1e-12);
        assert_close(quadratic(&m, shift, shift), body.mass, 1e-12, 0);
        assert_close(quadratic(&m, shift, tilt), body.moment, 1e-9, 0);
        assert_close(quadratic(&m, tilt, tilt), body.inertia, 1e-9, 0);
        free(k.a);
        free(m.a);
    }
    free(full.text);
    free(reduced.text);
}

/* One element by (A.1), written out here. */
static void test_one_element_by_hand(void **state)
{
    (void)state;
    struct export_model model = model_of(STEEL "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.1, 0, 1\n*SPRING\n0, 1000\n");
    struct dense_file k = market(matrix_market_stiffness, &model);
    struct dmig_file full = bulk(dmig_full, &model);
    struct dense_file dk = dmig_sum(&full, full.k2gg, 0);
    double pi = acos(-1), ei = 2.1e11 * pi * 1e-4 / 64, g = 2.1e11 / 2.6, l = 0.5, area = pi * 0.01 / 4;
    double shear = 6 * 1.3 / (7 + 6 * 0.3) * g * area, phi = 12 * ei / (shear * l * l), a = ei / (l * l * l * (1 + phi));
    assert_close(k.a[0], 12 * a + 1000, 1e-14, 0);
    assert_close(k.a[1], -6 * l * a, 1e-14, 0); /* a force at v turns the section by theta = -dv/dz */
    assert_close(k.a[2], -12 * a, 1e-14, 0);
    assert_close(k.a[4 + 1], (4 + phi) * l * l * a, 1e-14, 0);
    assert_close(k.a[3 * 4 + 1], (2 - phi) * l * l * a, 1e-14, 0);
    assert_close(dk.a[1], 6 * l * a, 1e-14, 0);
    assert_close(dk.a[4 + 1], (4 + phi) * l * l * a, 1e-14, 0);
    assert_int_equal(full.ngrid, 2);
    assert_true(full.longest <= 80);
    for (int id = 1; id <= 2; id++)
        assert_true(is_held(&full, id, "2346") && !is_held(&full, id, "23456"));
    assert_false(is_held(&full, 3, "2346"));
    free(k.a);
    free(dk.a);
    free(full.text);
}

static void test_numbers_of_sixteen_columns(void **state)
{
    (void)state;
    static const double some[] = {1,       -1,      1.0 / 3,  -1.0 / 3, 2.0 / 3e9, -5.7410459570050156e10, 1e100,
                                  -1e-100, 9999999, 0.999999, 1.5e-300, -1.5e+300, 9.9999999999999995,     123456789012345678.0};
    for (size_t i = 0; i < sizeof some / sizeof *some; i++) {
        char text[17], rest[17];
        double first = dmig_number(some[i], text), second = some[i] - first;
        assert_true(strlen(text) <= 16 && strchr(text, 'D') && strchr(text, '.'));
        assert_close(first, some[i], 1e-9, 0);
        second = second != 0 ? dmig_number(second, rest) : 0;
        if (first + second != some[i])
            fail_msg("%.17g became %.17g", some[i], first + second);
    }
}

/* ------------------------------------------------------------------------------------------------ ROSS */

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
    assert_int_equal(check_sections(&model.client->beam), 0);
    assert_status(ross_axis_section(&test_pool, &model.client->beam, 6, &section), ROTID_OK);
    assert_true(section.outer == 0.2 && section.inner == 0.05 && section.e == 1.1e11 && section.g == 0.35e11 &&
                section.nu == 0.28 && section.rho == 7600);
    model =
        model_of(MIXED); /* a stiffness diameter in 4, a perforated core with a gradient in 9 (a sensor cuts one), density in 6 */
    const struct mesh *mesh = &model.client->beam.mesh;
    assert_int_equal(check_sections(&model.client->beam), mesh->nelement);
    assert_status(ross_axis_section(&test_pool, &model.client->beam, 0, &section), ROTID_OK);
    assert_true(section.outer == 0.08 && section.inner == 0.02);
    assert_string_equal(section.equivalent, "heavy");
    assert_close(section.rho, 1.1 * 7850, 1e-14, 0);
    assert_close(section.e, 2.1e11, 1e-14, 0);
    assert_status(ross_axis_section(&test_pool, &model.client->beam, mesh->nelement - 1, &section), ROTID_OK);
    assert_true(section.outer == 0.09 && section.inner == 0); /* the mass is real, the stiffness is not */
    assert_close(section.e, 2.1e11 * pow(0.08 / 0.09, 4), 1e-13, 0);
    model = model_of(STEEL "*BEAM, NAME=bar, MATERIAL=steel\n0.72, 0.0127, 0.0254, 8\n");
    assert_int_equal(check_sections(&model.client->beam), 8);
    /* holes so far out that what is left has less inertia than a disc of its area would */
    model = model_of(STEEL "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.2, 0, 4\n*PERFORATION, GROUP=core\n24, 0.014, 0.088\n");
    assert_int_equal(check_sections(&model.client->beam), 4);
    assert_status(ross_axis_section(&test_pool, &model.client->beam, 0, &section), ROTID_OK);
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
        ross_tierod_section(&model.client->beam, 0, &section, &stretch);
        tierod_quantities(&model.client->beam, 0, 0.5, &element, &stretch);
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
    const struct beam *beam = &model.client->beam;
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
    assert_true(ross.client != model.client && ross.deck_hz);
    struct mass_properties mass;
    beam_mass_properties(&ross.client->beam, &mass); /* nothing is lost but flexibility */
    assert_close(mass.mass, model.mass.mass, 1e-13, 0);
    assert_close(mass.center, model.mass.center, 1e-13, 0);
    assert_close(mass.inertia, model.mass.inertia, 1e-13, 0);
    assert_true(model.spectrum.full_hz[0] < 300); /* of the bars, which the script does not have */
    assert_close(ross.spectrum->full_hz[0], ross.deck_hz[0], 1e-2, 0);
    for (int j = 0; j < 3; j++) {
        double nearest = INFINITY; /* what is called its partner is a mode of the deck */
        struct spectrum deck;
        assert_status(spectrum_compute(&test_pool, &model.job->rotor, 0, NULL, NULL, ROTID_GUYAN, 20, &deck), ROTID_OK);
        for (int i = 0; i < deck.count; i++)
            nearest = fmin(nearest, fabs(deck.full_hz[i] - ross.deck_hz[j]));
        assert_close(nearest, 0, 0, 1e-6);
    }
    model = model_of(MIXED);
    message_open(&notes, &test_pool);
    assert_status(ross_open(&test_pool, &model, &notes, &ross), ROTID_OK);
    assert_int_equal(notes.count, 0);
    assert_true(ross.client == model.client && !ross.deck_hz);
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

/* ------------------------------------------------------------------------------------------------ texts, memory */

static void test_remarks_are_plain_and_broken(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    struct remark remark = {stream, "$ ", 20};
    remark_put(&remark, "one two three four five six seven");
    remark_put(&remark, "%s", "k\xc3\xa4se\nSOL 101");
    remark_put(&remark, "%s", "");
    remark_put(&remark, "%s", "abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz");
    (void)fclose(stream);
    assert_string_equal(text, "$ one two three four\n$   five six seven\n$ k??se?SOL 101\n$\n$ abcdefghijklmnopqr\n"
                              "$   stuvwxyzabcdefgh\n$   ijklmnopqrstuvwx\n$   yz\n");
    free(text);
}

static void test_memory_that_runs_out(void **state)
{
    (void)state;
    static struct job job;
    open_job(BARS, &job);
    for (long n = 1;; n++) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list notes;
        struct export_model model;
        struct ross_model ross;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        message_open(&notes, &pool);
        FILE *stream = tmpfile();
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

static int remove_deck(void **state)
{
    (void)state;
    return unlink(deck_name);
}

static int name_deck(void **state)
{
    (void)state;
    int descriptor = mkstemp(deck_name);
    return descriptor < 0 || close(descriptor);
}

#define WITH_POOL(test) cmocka_unit_test_setup_teardown(test, open_test_pool, close_test_pool)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_POOL(test_matrices_come_back_to_the_last_bit),
        WITH_POOL(test_rigid_bodies_and_signs),
        WITH_POOL(test_one_element_by_hand),
        cmocka_unit_test(test_numbers_of_sixteen_columns),
        WITH_POOL(test_ross_sections_give_the_element),
        WITH_POOL(test_ross_tie_rods_as_rods_and_as_tube),
        WITH_POOL(test_ross_matrices_of_joint_and_mass),
        WITH_POOL(test_what_ross_leaves_out_is_said),
        WITH_POOL(test_names_are_words_and_unlike),
        cmocka_unit_test(test_remarks_are_plain_and_broken),
        WITH_POOL(test_memory_that_runs_out),
    };
    return cmocka_run_group_tests(tests, name_deck, remove_deck);
}
