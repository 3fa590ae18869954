/* Matrices that rotid export writes, read back by readers of the test's own: to the last bit, rigid bodies, signs. */
#include "export/export.h"
#include "exported.h"
#include "linalg/linalg.h"
#include "support.h"

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

POOL_TEST(test_matrices_come_back_to_the_last_bit)
{
    for (size_t d = 0; d < sizeof decks / sizeof *decks; d++) {
        struct export_model model = model_of(decks[d]);
        const double *k = dense_of(&model.k), *m = dense_of(&model.m);
        struct dense_file file[4] = {market(matrix_market_stiffness, &model), market(matrix_market_mass, &model),
                                     market(matrix_market_condensed_stiffness, &model),
                                     market(matrix_market_condensed_mass, &model)};
        assert_int_equal(file[0].n, model.discrete->discrete.beam.mesh.ndof);
        assert_int_equal(file[2].n,
                         model.job->rotor.nsensor ? model.job->rotor.nsensor : model.discrete->discrete.beam.mesh.naxis);
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

/* The rows that the table of nodes tells, moved as a rigid body: U = 1, V = -1, and v = 1 of rods. */
POOL_TEST(test_nodes_of_a_solid_tell_its_rows)
{
    struct export_model model = model_of(FREE TIES ", 4\n*FIT, MODEL=SOLID\n");
    double *u = calloc((size_t)model.k.n, sizeof *u), *ku = calloc((size_t)model.k.n, sizeof *ku);
    int sensors = 0, members = 0;
    assert_true(u && ku && model.is_solid);
    for (int i = 0; i < model.nnode; i++) {
        const struct export_node *node = &model.node[i];
        sensors += node->sensor != 0;
        members += node->row[3] != 0;
        u[node->row[0] - 1] = 1;
        if (node->row[1] && node->row[1] != node->row[0]) /* on the axis V = -U has the row of U */
            u[node->row[1] - 1] = -1;
        assert_true((node->r == 0) == (node->row[1] == node->row[0]));
    }
    assert_int_equal(sensors, model.job->rotor.nsensor);
    assert_true(members > 0);
    assert_close(matrix_product(&model.m, u, u, ku), model.mass.mass, 1e-9, 0);
    double largest = 0;
    for (int i = 0; i < model.k.n; i++)
        largest = fmax(largest, model.k.band[(ptrdiff_t)i * (model.k.kd + 1)]);
    assert_close(matrix_product(&model.k, u, u, ku), 0, 0, 1e-9 * largest);
    free(u);
    free(ku);
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
POOL_TEST(test_rigid_bodies_and_signs)
{
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
POOL_TEST(test_one_element_by_hand)
{
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

UNIT_TEST(test_numbers_of_sixteen_columns)
{
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

UNIT_TEST(test_remarks_are_plain_and_broken)
{
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
