/* A rotor is discretised once in a run, and what is shared never shows. */
#include "effect_bench.h"
#include "linalg/linalg.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "support.h"

static const struct parameter density = {PARAMETER_RHO, 0, 0, 0, NULL};

static int open_in(struct models *models, const struct rotor *rotor, int refine, struct rotor_model *model)
{
    int failed;
    return model_open(&test_pool, models, rotor, 1, &density, refine, model, &failed);
}

/* K and M of both at 1.1 times the density of the first, and the rest of the door. */
static void assert_same_model(const struct rotor_model *a, const struct rotor_model *b)
{
    const struct rotor_model *both[2] = {a, b};
    rotid_matrix k[2], m[2];
    double x = 1.1 * *parameter_value(a->rotor, density);
    for (int i = 0; i < 2; i++) {
        const rotid_model *e = &both[i]->equations;
        assert_status(matrix_new(&test_pool, e->n, e->kd, e->nfar, e->far, &k[i]), ROTID_OK);
        assert_status(matrix_new(&test_pool, e->n, e->kd, e->nfar, e->far, &m[i]), ROTID_OK);
        assert_int_equal(e->matrices(e->user, &x, &k[i], &m[i]), 0);
    }
    assert_int_equal(a->equations.n, b->equations.n);
    assert_int_equal(a->equations.nrigid, b->equations.nrigid);
    assert_int_equal(a->equations.nmaster, b->equations.nmaster);
    assert_memory_equal(a->master, b->master, (size_t)a->equations.nmaster * sizeof *a->master);
    assert_true(bench_largest(&k[0], NULL) > 0 && bench_largest(&m[0], NULL) > 0);
    assert_true(bench_largest(&k[0], &k[1]) == 0 && bench_largest(&m[0], &m[1]) == 0);
}

POOL_TEST(a_rotor_with_other_values_shares_the_mesh_and_nothing_else)
{
    struct models *models = models_for_run(&test_pool, NULL);
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
    struct rotor_model first, second, again, alone;
    assert_non_null(models);
    rotor->sling = 0.5; /* springs that follow the mass */
    rotor->nspring = 0;
    assert_status(open_in(models, rotor, 1, &first), ROTID_OK);
    double stiffness = first.rotor->spring[0].lateral;
    rotor->group[0].material.rho *= 1.5;
    rotor->tierod[0].tension *= 2;
    assert_status(open_in(models, rotor, 1, &second), ROTID_OK);
    assert_status(open_in(models, rotor, 1, &again), ROTID_OK);
    assert_status(open_in(NULL, rotor, 1, &alone), ROTID_OK);
    assert_ptr_equal(first.discrete.beam.mesh.z, second.discrete.beam.mesh.z);
    assert_ptr_equal(first.discrete.beam.mesh.z, again.discrete.beam.mesh.z);
    assert_ptr_not_equal(first.discrete.beam.mesh.z, alone.discrete.beam.mesh.z);
    assert_same_model(&second, &alone);
    assert_same_model(&again, &alone);
    assert_true(second.rotor->spring[0].lateral > 1.01 * stiffness);
    assert_true(first.rotor->spring[0].lateral == stiffness);
    models_end_run(&test_pool, models, NULL);
}

static void change(struct rotor *rotor, int what)
{
    switch (what) {
    case 0:
        rotor->segment[1].elements++;
        break;
    case 1:
        rotor->segment[1].outer *= 1.01;
        break;
    case 2:
        rotor->segment[1].stiff_outer *= 0.99;
        break;
    case 3:
        rotor->sensor[1].position += 0.002;
        break;
    case 4:
        rotor->tierod[0].pitch *= 1.01;
        break;
    case 5:
        rotor->group[1].hole_pitch *= 1.01;
        break;
    case 6:
        rotor->group[0].preload = -1e4;
        break;
    case 7:
        rotor->sling = 0.4;
        break;
    case 8:
        rotor->bars[0].material.e *= 1.1;
        break;
    case 9:
        rotor->effect[0].variant = 1;
        break;
    case 10:
        rotor->effect[0].target = 1;
        break;
    default:
        rotor->disk[0].position += 0.01;
        break;
    }
}

POOL_TEST(a_rotor_of_another_shape_is_built_anew)
{
    const double zone[] = {0.3, 0.7, 0.05, 0};
    for (int what = 0; what < 12; what++) {
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        struct rotor_model first, second, alone;
        if (!rotor->nbars && what == 8)
            continue;
        struct models *models = models_for_run(&test_pool, NULL);
        bench_add(rotor, cause_stiffness_local.effect, -1, 0, zone);
        assert_status(open_in(models, rotor, 1, &first), ROTID_OK);
        change(rotor, what); /* in place: the models must not look at the caller's arrays later */
        assert_status(open_in(models, rotor, 1, &second), ROTID_OK);
        assert_status(open_in(NULL, rotor, 1, &alone), ROTID_OK);
        assert_ptr_not_equal(first.discrete.beam.mesh.z, second.discrete.beam.mesh.z);
        assert_same_model(&second, &alone);
        models_end_run(&test_pool, models, NULL);
    }
}

/* None, and a joint with a mass; of a beam, whose joints are hinges of the mesh, that is another shape. */
POOL_TEST(a_solid_has_one_mesh_whatever_causes_are_in_it)
{
    static const double joint[4] = {3e-10}, mass[4] = {4, 1.603};
    for (int solid = 0; solid < 2; solid++) {
        struct models *run = models_for_run(&test_pool, NULL), *models = solid ? models_solids(run) : run;
        struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 0);
        struct rotor_model bare, both, alone;
        assert_status(open_in(models, rotor, 1, &bare), ROTID_OK);
        bench_add(rotor, cause_joint.effect, 1, 0, joint);
        bench_add(rotor, cause_added_mass.effect, -1, 0, mass);
        assert_status(open_in(models, rotor, 1, &both), ROTID_OK);
        assert_status(open_in(solid ? models_as(&test_pool, AS_SOLID) : NULL, rotor, 1, &alone), ROTID_OK);
        const void *mesh = solid ? (const void *)bare.discrete.solid.integrals : bare.discrete.beam.mesh.z;
        assert_int_equal(mesh == (solid ? (const void *)both.discrete.solid.integrals : both.discrete.beam.mesh.z), solid);
        assert_same_model(&both, &alone);
        assert_status(open_in(models, rotor, 1, &both), ROTID_OK); /* with the entry of its own values */
        assert_same_model(&both, &alone);
        models_end_run(&test_pool, run, NULL);
    }
}

POOL_TEST(a_finer_mesh_is_another_model)
{
    struct models *models = models_for_run(&test_pool, NULL);
    struct rotor_model coarse, fine;
    assert_status(open_in(models, paper_rotor(BUNDLE_RODS, 1), 1, &coarse), ROTID_OK);
    assert_status(open_in(models, paper_rotor(BUNDLE_RODS, 1), 2, &fine), ROTID_OK);
    assert_int_equal(fine.naxis, 2 * coarse.naxis - 1);
    models_end_run(&test_pool, models, NULL);
}

POOL_TEST(a_run_goes_on_with_what_the_deck_has_built)
{
    struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    struct models *deck, *run;
    struct model_size size;
    struct rotor_model one, two;
    int failed;
    assert_status(models_begin(&test_pool, AS_BEAM, rotor, &deck, &size, &failed), ROTID_OK);
    run = models_for_run(&test_pool, deck);
    assert_ptr_not_equal(run, deck); /* that of a deck takes up no others: several runs may share it */
    assert_ptr_equal(models_for_run(&test_pool, run), run);
    assert_status(open_in(deck, rotor, 1, &one), ROTID_OK);
    assert_status(open_in(run, rotor, 1, &two), ROTID_OK);
    assert_ptr_equal(one.discrete.beam.mesh.z, two.discrete.beam.mesh.z);
    assert_int_equal(size.ndof, one.equations.n);
    assert_same_model(&one, &two);
    models_end_run(&test_pool, run, deck);
    assert_status(open_in(run, rotor, 2, &two), ROTID_OK); /* after its end: built, and not kept */
    assert_status(open_in(run, rotor, 2, &one), ROTID_OK);
    assert_ptr_not_equal(one.discrete.beam.mesh.z, two.discrete.beam.mesh.z);
}

POOL_TEST(every_failing_allocation_is_survived)
{
    int status = ROTID_ERROR_MEMORY, n = 0, failed;
    while (status == ROTID_ERROR_MEMORY) {
        struct failing_allocator failing;
        struct pool pool;
        struct rotor_model model;
        failing_allocator_open(&failing, ++n);
        pool_open(&pool, &failing.allocator);
        struct models *models = models_for_run(&pool, NULL);
        status = models ? ROTID_OK : ROTID_ERROR_MEMORY;
        for (int refine = 1; refine <= 2 && !status; refine++)
            status = model_open(&pool, models, paper_rotor(BUNDLE_TUBE, 0), 2, paper_parameters, refine, &model, &failed);
        if (models)
            models_end_run(&pool, models, NULL);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 1000);
    }
    assert_status(status, ROTID_OK);
    assert_true(n > 50);
}
