/* Prediction of what was not fitted, beside fits that really leave it out, and the errors of a fit beside their definitions. */
#include "diagnose/diagnose.h"
#include "effect_bench.h"
#include "modal/modal.h"
#include "model/model.h"
#include "run/run.h"
#include "support.h"

#define SENSORS 9
#define MODES   5

/* A beam with a core of unknown E and G: data are its own modes at 1.1e11 and 0.4e11 Pa with white noise of the stated size,
 * which is so small that the fit is linear in it. */
static struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1},
                       soft = {.name = "soft", .e = 1e11, .g = 0.42e11, .nu = 0.3, .rho = 7600};
static struct group groups[3];
static struct segment segments[3];
static struct sensor sensors[SENSORS];
static struct parameter parameters[2] = {{PARAMETER_E, 1, 0, 0, NULL}, {PARAMETER_G, 1, 0, 0, NULL}};
static rotid_parameter bounds[2] = {{"core.E", "Pa", 0.5e11, 2e11, 1e11}, {"core.G", "Pa", 0.2e11, 0.8e11, 0.42e11}};
static int number[MODES], holdout[MODES];
static double hz[MODES], hz_std[MODES], shape[SENSORS * MODES], shape_std[SENSORS * MODES];

static void open_rotor(struct rotor *rotor)
{
    static const double length[] = {0.4, 0.9, 0.5}, diameter[] = {0.15, 0.3, 0.17};
    static const char *const name[] = {"left", "core", "right"};
    for (int g = 0; g < 3; g++) {
        groups[g] = (struct group){.layer_of = -1, .name = name[g], .material = g == 1 ? soft : steel};
        segments[g] =
            (struct segment){.group = g, .elements = 8, .length = length[g], .outer = diameter[g], .stiff_outer = diameter[g]};
    }
    for (int s = 0; s < SENSORS; s++)
        sensors[s] = (struct sensor){10 + s, 1.8 * s / (SENSORS - 1)};
    *rotor =
        (struct rotor){.ngroup = 3, .group = groups, .nsegment = 3, .segment = segments, .nsensor = SENSORS, .sensor = sensors};
}

static struct job make_job(double noise)
{
    static const double truth[2] = {1.1e11, 0.4e11};
    struct rotor rotor;
    struct rotor_model client;
    struct prediction p;
    struct random_stream stream = {4};
    int failed;
    open_rotor(&rotor);
    assert_status(model_open(&test_pool, NULL, &rotor, 2, parameters, 1, &client, &failed), ROTID_OK);
    int count = client.equations.nrigid + MODES;
    assert_status(prediction_new(&test_pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, truth), ROTID_OK);
    for (int k = 0; k < MODES; k++) {
        int pair = client.equations.nrigid + k;
        double largest = 0;
        number[k] = k + 1;
        holdout[k] = 0;
        hz_std[k] = 0.02 * noise;
        hz[k] = prediction_hz(&p, pair) * (1 + hz_std[k] * random_normal(&stream));
        for (int s = 0; s < SENSORS; s++) {
            shape[s + k * SENSORS] = prediction_at_sensor(&p, pair, s);
            largest = fmax(largest, fabs(shape[s + k * SENSORS]));
        }
        for (int s = 0; s < SENSORS; s++) {
            shape_std[s + k * SENSORS] = noise * (1 + 0.2 * (s % 3));
            shape[s + k * SENSORS] *= (k % 2 ? -3.7 : 0.8) / largest; /* any scale */
            shape[s + k * SENSORS] += (k % 2 ? 3.7 : 0.8) * shape_std[s + k * SENSORS] * random_normal(&stream);
        }
    }
    shape[2 + 1 * SENSORS] = NAN;
    return (struct job){.rotor = rotor,
                        .measurement.nmode = MODES,
                        .measurement.number = number,
                        .measurement.frequency_hz = hz,
                        .measurement.frequency_std = hz_std,
                        .measurement.shape = shape,
                        .measurement.shape_std = shape_std,
                        .measurement.holdout = holdout,
                        .unknowns.nparameter = 2,
                        .unknowns.parameter = parameters,
                        .unknowns.bounds = bounds,
                        .options.fit = {.size = sizeof(rotid_fit_options),
                                        .functional = ROTID_LIKELIHOOD,
                                        .reduction = ROTID_REDUCTION_NONE,
                                        .derivative = ROTID_NELSON}};
}

/* The job as the only state. */
static const struct states *of(const struct job *job)
{
    static struct state state;
    static struct states states;
    states = states_of(job, &state);
    return &states;
}

static rotid_fit_result *fit_job(const struct job *job, const int *held)
{
    rotid_fit_result *fit;
    struct state state;
    const struct states states = states_of(job, &state);
    assert_status(identify_fit_states(&test_pool, &states, number, held, &job->options.fit, NULL, &fit), ROTID_OK);
    assert_true(fit->converged);
    return fit;
}

static double largest_of(const double *mode)
{
    double largest = 0;
    for (int s = 0; s < SENSORS; s++)
        largest = fmax(largest, isfinite(mode[s]) ? fabs(mode[s]) : 0);
    return largest;
}

/* Standardised residuals of sensor s in all fitted modes, by a fit without it, their squares added to sums[0], their count to
 * sums[1], and the squares of the differences of shapes to sums[2]. The scale of each mode is that of the other sensors. */
static void leave_sensor_out(const struct job *job, int s, double *sums)
{
    double less[SENSORS * MODES], std[SENSORS * MODES], x[2];
    struct job without = *job;
    memcpy(less, shape, sizeof less);
    memcpy(std, shape_std, sizeof std);
    for (int k = 0; k < MODES; k++) {
        less[s + k * SENSORS] = NAN;
        double ratio = largest_of(shape + k * SENSORS) / largest_of(less + k * SENSORS); /* the noise stays what it is */
        for (int i = 0; i < SENSORS; i++)
            std[i + k * SENSORS] *= ratio;
    }
    without.measurement.shape = less;
    without.measurement.shape_std = std;
    rotid_fit_result *fit = fit_job(&without, job->measurement.holdout);
    x[0] = fit->n ? fit->x[0] : soft.e;
    x[1] = fit->n ? fit->x[1] : soft.g;
    rotid_fit_free(fit);
    struct rotor_model client;
    struct prediction p;
    int failed;
    assert_status(model_open(&test_pool, NULL, &job->rotor, 2, parameters, 1, &client, &failed), ROTID_OK);
    int count = client.equations.nrigid + MODES;
    assert_status(prediction_new(&test_pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, x), ROTID_OK);
    for (int k = 0; k < MODES; k++) {
        double ab = 0, aa = 0, largest = largest_of(shape + k * SENSORS);
        if (job->measurement.holdout[k] || !isfinite(shape[s + k * SENSORS]))
            continue;
        for (int i = 0; i < SENSORS; i++) {
            if (i == s || !isfinite(shape[i + k * SENSORS]))
                continue;
            double phi = prediction_at_sensor(&p, client.equations.nrigid + k, i), w = pow(shape_std[i + k * SENSORS], -2);
            aa += w * phi * phi;
            ab += w * phi * shape[i + k * SENSORS] / largest;
        }
        double off = ab / aa * prediction_at_sensor(&p, client.equations.nrigid + k, s) - shape[s + k * SENSORS] / largest;
        sums[0] += pow(off / shape_std[s + k * SENSORS], 2);
        sums[1]++;
        sums[2] += off * off;
    }
}

static void compare_with_refits(const struct job *job, double tolerance)
{
    double sums[3] = {0}, standardised, rms;
    rotid_fit_result *fit = fit_job(job, job->measurement.holdout);
    assert_status(sensor_out(&test_pool, of(job), job->measurement.holdout, fit, &standardised, &rms), ROTID_OK);
    rotid_fit_free(fit);
    for (int s = 0; s < SENSORS; s++)
        leave_sensor_out(job, s, sums);
    assert_close(standardised, sqrt(sums[0] / sums[1]), tolerance, 0);
    assert_close(rms, sqrt(sums[2] / sums[1]), tolerance, 0);
}

POOL_TEST(sensors_out_are_fits_without_them)
{
    struct job job = make_job(1e-4);
    compare_with_refits(&job, 0.002);
    holdout[1] = holdout[4] = 1;
    compare_with_refits(&job, 0.002);
    job = make_job(0.02); /* noise of real tests: still good */
    compare_with_refits(&job, 0.02);
}

POOL_TEST(sensors_out_with_nothing_identified)
{
    struct job job = make_job(0.01);
    job.unknowns.nparameter = 0; /* the scales are left */
    compare_with_refits(&job, 1e-9);
}

POOL_TEST(sensors_out_need_shapes)
{
    struct job job = make_job(1e-3);
    double standardised = 0, rms = 0;
    rotid_fit_result *fit = fit_job(&job, holdout);
    job.measurement.shape = NULL;
    assert_status(sensor_out(&test_pool, of(&job), holdout, fit, &standardised, &rms), ROTID_OK);
    assert_true(isnan(standardised) && isnan(rms));
    rotid_fit_free(fit);
}

/* sqrt of the mean square of what is left of the measured shape beside the best multiple of the predicted one. */
static double shape_by_definition(const struct job *job, const double *x, int k)
{
    struct rotor_model client;
    struct prediction p;
    int failed, used = 0;
    double ab = 0, aa = 0, sum = 0, largest = largest_of(shape + k * SENSORS);
    assert_status(model_open(&test_pool, NULL, &job->rotor, 2, parameters, 1, &client, &failed), ROTID_OK);
    int count = client.equations.nrigid + MODES;
    assert_status(prediction_new(&test_pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, x), ROTID_OK);
    for (int pass = 0; pass < 2; pass++)
        for (int s = 0; s < SENSORS; s++) {
            double phi = prediction_at_sensor(&p, client.equations.nrigid + k, s), m = shape[s + k * SENSORS] / largest;
            if (isnan(m))
                continue;
            if (!pass) {
                aa += phi * phi;
                ab += phi * m;
            } else {
                sum += pow(ab / aa * phi - m, 2);
                used++;
            }
        }
    return sqrt(sum / used);
}

POOL_TEST(errors_are_as_defined)
{
    struct job job = make_job(0.02);
    double rms, most, shapes, squares = 0, largest = 0, shape_squares = 0;
    holdout[2] = holdout[3] = 1;
    rotid_fit_result *fit = fit_job(&job, holdout);
    for (int held = 0; held < 2; held++) {
        int count = 0;
        squares = largest = shape_squares = 0;
        for (int k = 0; k < MODES; k++) {
            double error = 100 * (fit->predicted_hz[k] - hz[k]) / hz[k];
            if (holdout[k] != held)
                continue;
            squares += error * error;
            largest = fmax(largest, fabs(error));
            shape_squares += pow(shape_by_definition(&job, fit->x, k), 2);
            assert_close(shape_difference(&job, k, fit->mac[k]), shape_by_definition(&job, fit->x, k), 1e-6, 0);
            count++;
        }
        fitted_errors(of(&job), holdout, fit, held, &rms, &most, &shapes);
        assert_close(rms, sqrt(squares / count), 1e-12, 0);
        assert_close(most, largest, 1e-12, 0);
        assert_close(shapes, sqrt(shape_squares / count), 1e-6, 0);
    }
    memset(holdout, 0, sizeof holdout);
    fitted_errors(of(&job), holdout, fit, 1, &rms, &most, &shapes);
    assert_true(isnan(rms) && isnan(most) && isnan(shapes));
    assert_true(isnan(shape_difference(&job, 0, NAN)));
    job.measurement.shape = NULL;
    assert_true(isnan(shape_difference(&job, 0, 0.9)));
    fitted_errors(of(&job), holdout, fit, 0, &rms, &most, &shapes);
    assert_true(isfinite(rms) && isnan(shapes));
    rotid_fit_free(fit);
}

POOL_TEST(a_mode_out_is_a_fit_without_it)
{
    struct job job = make_job(0.02);
    holdout[4] = 1;
    for (int k = 0; k < MODES; k++) {
        int held[MODES] = {0, 0, 0, 0, 1};
        double error, difference;
        held[k] = 1;
        rotid_fit_result *fit = fit_job(&job, held);
        assert_status(mode_out_fit(of(&job), NULL, number, holdout, k, NULL, NULL, &error, &difference), ROTID_OK);
        assert_close(error, 100 * (fit->predicted_hz[k] / hz[k] - 1), 1e-5, 1e-6);
        assert_close(difference, shape_by_definition(&job, fit->x, k), 1e-4, 0);
        rotid_fit_free(fit);
    }
    struct failing_allocator failing;
    double error, difference;
    failing_allocator_open(&failing, 0);
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 0, NULL, &failing.allocator, &error, &difference), ROTID_OK);
    assert_int_equal(failing.in_use, 0);
    failing_allocator_open(&failing, 5);
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 0, NULL, &failing.allocator, &error, &difference),
                  ROTID_ERROR_MEMORY);
    assert_int_equal(failing.in_use, 0);
}

/* One step from the fit of all, beside noise and beside a misfit that no step follows. */
POOL_TEST(a_mode_out_is_one_step_from_the_fit_of_all)
{
    for (int far = 0; far < 2; far++) {
        struct job job = make_job(0.02);
        rotid_fit_result *all;
        hz[1] *= far ? 1.05 : 1;
        struct state only;
        holdout[4] = 1;
        all = fit_job(&job, holdout);
        struct states started = states_of(&job, &only);
        assert_status(states_started_at(&test_pool, &started, all->x, &started), ROTID_OK);
        for (int k = 0; k < MODES; k++) {
            double error[2], difference[2];
            for (int from = 0; from < 2; from++)
                assert_status(
                    mode_out_fit(&started, from ? all : NULL, number, holdout, k, NULL, NULL, &error[from], &difference[from]),
                    ROTID_OK);
            assert_close(error[1], error[0], 0, 0.05 * 100 * job.measurement.frequency_std[k]);
            assert_close(difference[1], difference[0], 0.02, 0);
            assert_true(fabs(error[0]) > job.measurement.frequency_std[k]);
        }
        rotid_fit_free(all);
    }
}

POOL_TEST(a_mode_out_leaves_enough_or_nothing_is_said)
{
    struct job job = make_job(0.02);
    double error = 0, difference = 0;
    job.measurement.shape = NULL;
    holdout[2] = holdout[3] = holdout[4] = 1; /* two frequencies for two moduli; one of them left out is too few */
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 0, NULL, NULL, &error, &difference), ROTID_OK);
    assert_true(isnan(error) && isnan(difference));
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 2, NULL, NULL, &error, &difference), ROTID_OK);
    assert_true(isfinite(error) && isnan(difference));
    holdout[1] = 1; /* the last one */
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 0, NULL, NULL, &error, &difference), ROTID_OK);
    assert_true(isnan(error));
}

static int at_once(void *context)
{
    (void)context;
    return 1;
}

POOL_TEST(a_host_can_cancel)
{
    struct job job = make_job(0.02);
    double error, difference;
    const rotid_environment environment = {.size = sizeof environment, .cancelled = at_once};
    assert_status(mode_out_fit(of(&job), NULL, number, holdout, 0, &environment, NULL, &error, &difference),
                  ROTID_STOP_CANCELLED);
}
