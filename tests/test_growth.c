/* How the hybrid functionals grow away from the optimum, beside closed forms. */
#include "support.h"

#include "paper_rotor.h"
#include "run/run.h"

/* A free steel bar: with G tied to E every eigenvalue is proportional to E, condensed or not. */
static void make_bar(struct job *job, struct group *group, struct segment *segment, struct sensor *sensor, int nsensor)
{
    *group = (struct group){.layer_of = -1, .name = "bar", .material = {.e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1}};
    *segment = (struct segment){.elements = 20, .length = 1, .outer = 0.1, .stiff_outer = 0.1};
    for (int i = 0; i < nsensor; i++)
        sensor[i] = (struct sensor){i + 1, (double)i / (nsensor - 1)};
    *job = (struct job){
        .rotor = {.ngroup = 1, .nsegment = 1, .nsensor = nsensor, .group = group, .segment = segment, .sensor = sensor}};
    rotid_fit_defaults(sizeof job->options.fit, &job->options.fit);
}

POOL_TEST(of_a_bar_it_is_that_of_its_modulus)
{
    static const struct parameter young = {PARAMETER_E, 0, 0, 0, NULL};
    const double x0 = 2.1e11;
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++) {
        struct group group;
        struct segment segment;
        struct sensor sensor[21];
        struct job job;
        struct growth growth;
        make_bar(&job, &group, &segment, sensor, 21);
        job.options.fit.reduction = reduction;
        assert_status(growth_run(&test_pool, &job, 1, &young, &x0, 3, 7, &growth), ROTID_OK);
        assert_close(growth.epsilon_squared[0], 1e-6, 1e-12, 0);
        assert_close(growth.epsilon_squared[growth.nepsilon_squared - 1], 1e-2, 1e-12, 0);
        for (int i = 0; i < growth.nepsilon_squared; i++) { /* E_k = -eps, F_k = 1 - sqrt(1 + eps) */
            double eps = sqrt(growth.epsilon_squared[i]), f = 1 - sqrt(1 + eps);
            assert_close(growth.hybrid.objective[i], 1.5 * eps * eps, 1e-6, 0);
            assert_close(growth.hybrid_f.objective[i], 1.5 * f * f, 1e-6, 0);
            assert_true(growth.shapes_alone[i] < 1e-16);
        }
        assert_close(growth.hybrid.slope, 1, 1e-7, 0);
        assert_close(growth.hybrid.intercept, log(1.5), 1e-5, 0);
        assert_true(growth.hybrid_f.slope < 1 && growth.hybrid_f.slope > 0.98);
    }
}

/* Slope between neighbouring points */
static double local_slope(const struct growth *growth, const struct growth_line *line, int i)
{
    return log(line->objective[i + 1] / line->objective[i]) / log(growth->epsilon_squared[i + 1] / growth->epsilon_squared[i]);
}

POOL_TEST(the_slope_tends_to_one_at_the_optimum)
{
    struct job job = {.rotor = *paper_rotor(BUNDLE_TUBE, 0)};
    struct sensitivity result;
    static const rotid_parameter named[2] = {{.name = "core.E", .unit = "Pa"}, {.name = "core.G", .unit = "Pa"}};
    const struct sensitivity_options options = {
        .step = 0.01, .range = 0.5, .points = 3, .modes = PAPER_MODES, .with_growth = 1, .seed = 3};
    rotid_fit_defaults(sizeof job.options.fit, &job.options.fit);
    job.options.fit.reduction = ROTID_GUYAN;
    assert_status(sensitivity_run(&test_pool, &job, 2, paper_parameters, named, paper_start, &options, &result), ROTID_OK);
    const struct growth *growth = result.functional_growth;
    for (int kind = 0; kind < GROWTH_KINDS; kind++) {
        const struct growth_line *line = kind == GROWTH_E ? &growth->hybrid : &growth->hybrid_f;
        double near = fabs(local_slope(growth, line, 0) - 1),
               far = fabs(local_slope(growth, line, growth->nepsilon_squared - 2) - 1);
        print_message("ln f(%c) = %.4f ln(eps^2) %+.4f; slope off by %.1e at eps 0.001, %.1e at 0.1\n", kind ? 'F' : 'E',
                      line->slope, line->intercept, near, far);
        assert_close(near, 0, 0, 1e-3);
        assert_true(far > 10 * near); /* in proportion to eps */
        assert_close(line->slope, 1, 0.01, 0);
    }
    assert_close(growth->hybrid.objective[0] / growth->hybrid_f.objective[0], 4, 2e-3, 0); /* (25) */
    double noise = 0;
    for (int i = 0; i < growth->nepsilon_squared; i++)
        noise = fmax(noise, growth->shapes_alone[i]);
    assert_true(noise > 0 && noise < 1e-20); /* the shapes take part in the quotient, and change it by rounding */
}

POOL_TEST(a_parameter_without_effect_has_no_slope)
{
    static const struct parameter mass = {PARAMETER_DISK_INERTIA, 0, 0, 0, NULL};
    const double x0 = 1e-30;
    struct group group;
    struct segment segment;
    struct disk disk = {.name = "ghost", .position = 0.5, .diametral = 1e-30};
    struct job job;
    struct growth growth;
    make_bar(&job, &group, &segment, NULL, 0);
    job.rotor.ndisk = 1;
    job.rotor.disk = &disk;
    assert_status(growth_run(&test_pool, &job, 1, &mass, &x0, 2, 1, &growth), ROTID_OK);
    for (int i = 0; i < growth.nepsilon_squared; i++)
        assert_true(growth.hybrid.objective[i] < 1e-16);
    assert_true(isnan(growth.hybrid.slope) && isnan(growth.hybrid_f.intercept));
}
