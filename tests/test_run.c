/* The jobs themselves: spectrum, comparison, identification and sensitivity on jobs made in memory. */
#include "support.h"

#include "paper_rotor.h"
#include "run/run.h"

static const double truth[2] = {1.157e11, 0.316e11};

/* A job of the paper's rotor whose data are the modes of its own full model at `truth`. Modes and shapes live on the pool. */
static void make_job(struct pool *pool, int nmode, struct job *job)
{
    static const rotid_parameter bounds[2] = {{"core.E", "Pa", 1e6, 2.3e11, 0.9e11}, {"core.G", "Pa", 1e6, 0.898e11, 0.28e11}};
    struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    struct spectrum spectrum;
    *job = (struct job){.deck = "memory", .rotor = *rotor, .measurement.nmode = nmode, .unknowns.nparameter = 2};
    assert_int_equal(spectrum_compute(pool, NULL, rotor, 2, paper_parameters, truth, ROTID_GUYAN, nmode, &spectrum), ROTID_OK);
    ptrdiff_t components = (ptrdiff_t)rotor->nsensor * nmode;
    job->measurement.number = POOL_ARRAY(pool, int, nmode);
    job->measurement.frequency_hz = spectrum.full_hz;
    job->measurement.damping = POOL_ARRAY(pool, double, nmode);
    job->measurement.frequency_std = POOL_ARRAY(pool, double, nmode);
    job->measurement.shape = POOL_ARRAY(pool, double, components);
    job->measurement.shape_std = POOL_ARRAY(pool, double, components);
    job->measurement.holdout = POOL_ARRAY(pool, int, nmode);
    job->unknowns.parameter = POOL_ARRAY(pool, struct parameter, 2);
    job->unknowns.bounds = POOL_ARRAY(pool, rotid_parameter, 2);
    memcpy(job->unknowns.parameter, paper_parameters, 2 * sizeof *job->unknowns.parameter);
    memcpy(job->unknowns.bounds, bounds, sizeof bounds);
    memcpy(job->measurement.shape, spectrum.shape, (size_t)components * sizeof *job->measurement.shape);
    for (int k = 0; k < nmode; k++) {
        job->measurement.number[k] = k + 1;
        job->measurement.damping[k] = NAN;
        job->measurement.frequency_std[k] = 0.001;
    }
    for (ptrdiff_t i = 0; i < components; i++)
        job->measurement.shape_std[i] = 0.015;
    rotid_fit_defaults(sizeof job->options.fit, &job->options.fit);
}

static int says(const struct message_list *notes, const char *text)
{
    for (size_t i = 0; i < notes->count; i++)
        if (strstr(notes->item[i].text, text))
            return 1;
    return 0;
}

UNIT_TEST(identification_recovers_what_made_the_data)
{
    struct pool pool;
    struct job job;
    struct message_list notes;
    struct identification result;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    make_job(&pool, 6, &job);
    assert_int_equal(identify_run(&pool, &job, 0, NULL, &notes, &result), ROTID_OK);
    assert_true(result.fit->converged && !result.fit->any_at_bound && !result.fit->any_undetermined);
    assert_close(result.fit->x[0], truth[0], 1e-7, 0);
    assert_close(result.fit->x[1], truth[1], 1e-7, 0);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(result.compared.basis[k], PAIRED_BY_SHAPE);
        assert_close(result.compared.nco[k], 1, 1e-9, 0);
        assert_close(result.compared.mac[k], 1, 1e-9, 0);
        assert_close(result.fit->predicted_hz[k], job.measurement.frequency_hz[k], 1e-8, 0);
    }
    assert_close(result.mass.mass, 998.2755, 1e-6, 0);
    assert_int_equal(notes.count, 0);
    rotid_fit_free(result.fit);
    pool_close(&pool);
}

UNIT_TEST(a_mode_that_was_not_measured_is_said_and_the_rest_keep_their_partners)
{
    struct pool pool;
    struct job job;
    struct message_list notes;
    struct identification result;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    make_job(&pool, 6, &job);
    int nsensor = job.rotor.nsensor;
    for (int k = 2; k < 5; k++) { /* mode 3 was missed, and the analyser numbered the others through */
        job.measurement.frequency_hz[k] = job.measurement.frequency_hz[k + 1];
        memcpy(job.measurement.shape + (ptrdiff_t)k * nsensor, job.measurement.shape + (ptrdiff_t)(k + 1) * nsensor,
               (size_t)nsensor * sizeof *job.measurement.shape);
    }
    job.measurement.nmode = 5;
    assert_int_equal(identify_run(&pool, &job, 0, NULL, &notes, &result), ROTID_OK);
    const int expected[] = {1, 2, 4, 5, 6};
    for (int k = 0; k < 5; k++)
        assert_int_equal(result.compared.number[k], expected[k]);
    assert_close(result.fit->x[0], truth[0], 1e-6, 0);
    assert_true(says(&notes, "mode 3 of the model"));
    assert_true(says(&notes, "measured mode 3 at"));
    rotid_fit_free(result.fit);
    pool_close(&pool);
}

/* Shapes first ... end - 1 become pure noise. */
static void lose_shapes(struct job *job, int first, int end, struct random_stream *stream)
{
    for (ptrdiff_t i = (ptrdiff_t)first * job->rotor.nsensor; i < (ptrdiff_t)end * job->rotor.nsensor; i++)
        job->measurement.shape[i] = random_normal(stream);
}

POOL_TEST(a_mode_that_is_no_mode_of_the_model_is_said)
{
    struct job job;
    struct message_list notes;
    struct identification result;
    struct random_stream stream = {7};
    message_open(&notes, &test_pool);
    make_job(&test_pool, 6, &job);
    lose_shapes(&job, 3, 4, &stream); /* under number 4 */
    job.measurement.holdout[3] = 1;   /* so that it does not decide the fit */
    assert_int_equal(identify_run(&test_pool, &job, 0, NULL, &notes, &result), ROTID_OK);
    assert_true(says(&notes, "has no partner in the model by its shape"));
    assert_close(result.fit->x[0], truth[0], 1e-6, 0);
    rotid_fit_free(result.fit);
}

POOL_TEST(shapes_of_something_else_are_said)
{
    struct job job;
    struct message_list notes;
    struct identification result;
    struct random_stream stream = {9};
    message_open(&notes, &test_pool);
    make_job(&test_pool, 6, &job);
    for (int more = 0; more < 2; more++) { /* while the last one is its own, nothing is said */
        lose_shapes(&job, more ? 5 : 0, more ? 6 : 5, &stream);
        assert_int_equal(identify_run(&test_pool, &job, 0, NULL, &notes, &result), ROTID_OK);
        assert_int_equal(says(&notes, "no measured shape resembles a mode of the model"), more);
        rotid_fit_free(result.fit);
    }
}

UNIT_TEST(jobs_without_data_are_refused_and_without_parameters_compared)
{
    struct pool pool;
    struct job job;
    struct message_list notes;
    struct identification result;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    make_job(&pool, 2, &job);
    job.unknowns.nparameter = 0;
    assert_int_equal(identify_run(&pool, &job, 0, NULL, &notes, &result), ROTID_OK);
    assert_int_equal(result.fit->n, 0);
    assert_int_equal(result.fit->iterations, 0);
    for (int k = 0; k < job.measurement.nmode; k++)
        assert_close(result.fit->predicted_hz[k], result.spectrum.full_hz[job.measurement.number[k] - 1], 1e-9, 0);
    rotid_fit_free(result.fit);
    job.unknowns.nparameter = 2;
    job.measurement.nmode = 0;
    assert_int_equal(identify_run(&pool, &job, 0, NULL, &notes, &result), ROTID_ERROR_ARGUMENT);
    assert_true(says(&notes, "MODES"));
    assert_null(result.fit);
    pool_close(&pool);
}

static int stop_at_once(void *unused)
{
    (void)unused;
    return 1;
}

UNIT_TEST(a_cancelled_identification_keeps_the_best_point)
{
    struct pool pool;
    struct job job;
    struct message_list notes;
    struct identification result;
    const rotid_environment environment = {.size = sizeof environment, .cancelled = stop_at_once};
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    make_job(&pool, 4, &job);
    assert_int_equal(identify_run(&pool, &job, 1, &environment, &notes, &result), ROTID_OK);
    assert_int_equal(result.fit->status, ROTID_STOP_CANCELLED);
    assert_false(result.fit->converged);
    assert_close(result.fit->x[0], job.unknowns.bounds[0].start, 1e-12, 0);
    rotid_fit_free(result.fit);
    pool_close(&pool);
}

UNIT_TEST(sensitivities_add_up_to_at_most_one_and_their_limit_is_the_derivative)
{
    struct pool pool;
    struct job job;
    struct sensitivity coarse, fine;
    static const rotid_parameter named[3] = {{.name = "core.E"}, {.name = "core.G"}, {.name = "core.nu"}};
    struct sensitivity_options options = {.step = 1e-2, .range = 0.5, .points = 3, .modes = 6};
    const double x[3] = {8e10, 3e10, 1.0 / 3};
    const struct parameter parameter[3] = {
        {PARAMETER_E, 1, 0, 0, NULL}, {PARAMETER_G, 1, 0, 0, NULL}, {PARAMETER_NU, 1, 0, 0, NULL}};
    pool_open(&pool, NULL);
    make_job(&pool, 6, &job);
    job.options.fit.reduction = ROTID_GUYAN;
    assert_int_equal(sensitivity_run(&pool, &job, 3, parameter, named, x, &options, &coarse), ROTID_OK);
    options.step = 1e-5;
    assert_int_equal(sensitivity_run(&pool, &job, 3, parameter, named, x, &options, &fine), ROTID_OK);
    for (int k = 0; k < 6; k++) {
        for (int p = 0; p < 3; p++)
            assert_close(fine.parameters[p].sensitivity[k], fine.parameters[p].derivative[k], 1e-4, 1e-9);
        /* per cent of the frequency for a per cent of the parameter: by the frequencies of a model that is stiffer by a millionth
         */
        double hz = fine.frequency_hz[k] * sqrt(1 - fine.parameters[0].sensitivity[k] * options.step);
        assert_close(fine.parameters[0].frequency_change[k], log(hz / fine.frequency_hz[k]) / log(1 + options.step), 1e-3, 1e-9);
        /* all stiffness times (1 + e) raises every eigenvalue by e, so a part of it by less */
        double sum = -(coarse.parameters[0].derivative[k] + coarse.parameters[1].derivative[k]);
        assert_true(sum > 0 && sum < 1);
        /* E_k vanishes at the reference and grows to both sides: Figure 5 */
        const double *curve = coarse.parameters[0].curves + k;
        assert_true(curve[6] < 1e-15 && curve[0] > curve[6] && curve[12] > curve[6]);
    }
    pool_close(&pool);
}

UNIT_TEST(no_allocation_that_fails_leaks_or_goes_unsaid)
{
    struct pool outer;
    struct job job;
    pool_open(&outer, NULL);
    make_job(&outer, 3, &job);
    long n = 1;
    for (;; n = NEXT_FAILURE(n)) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list notes;
        struct identification result;
        failing_allocator_open(&failing, n);
        const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        pool_open(&pool, &failing.allocator);
        message_open(&notes, &pool);
        int status = identify_run(&pool, &job, 0, &environment, &notes, &result);
        if (!status)
            rotid_fit_free(result.fit);
        else
            assert_status(status, ROTID_ERROR_MEMORY);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        if (!status)
            break;
    }
    assert_true(n > 100); /* the sweep went through the run, not around it */
    pool_close(&outer);
}
