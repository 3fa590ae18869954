/* Sensitivity columns of the scan: beside the Jacobian of the likelihood for what the job itself identifies, and beside
 * differences of the residual for every physical cause of the catalogue. */
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "effect_bench.h"
#include "modal/modal.h"
#include "support.h"

#define SENSORS 13
#define MODES   5
#define WEIGHED 2 /* rows of what the rotor weighs and where its centre of mass is */
#define MOST    (MODES * (SENSORS + 1) + WEIGHED)

static const struct effect_kind nothing = {.id = "none"};

/* The bench rotor with measured data near its own modes: frequencies off by per cent and shapes by hundredths, so that a residual
 * is left and the derivative of the best scale counts. A component is missing in one mode, a whole sensor in another. */
struct bench {
    struct job job;
    struct sensor sensor[SENSORS];
    struct parameter parameter[8];
    int number[MODES], holdout[MODES];
    double frequency_hz[MODES], frequency_std[MODES], shape[SENSORS * MODES], shape_std[SENSORS * MODES];
};
static struct bench bench;

static void place_sensors(struct rotor *rotor)
{
    double length = rotor_length(rotor);
    for (int s = 0; s < SENSORS; s++)
        bench.sensor[s] = (struct sensor){s + 1, length * (s + 0.3) / SENSORS};
    rotor->nsensor = SENSORS;
    rotor->sensor = bench.sensor;
}

static struct job *open_job(enum bundle_model model)
{
    struct rotor *rotor = bench_rotor(model, 1, 5);
    bench = (struct bench){.parameter = {{PARAMETER_E, 1, 0, 0, NULL}, {PARAMETER_G, 1, 0, 0, NULL}}};
    place_sensors(rotor);
    struct rotor_model client;
    struct prediction p;
    int failed;
    assert_status(model_open(&test_pool, NULL, rotor, 0, NULL, 1, &client, &failed), ROTID_OK);
    int count = client.equations.nrigid + MODES;
    assert_status(prediction_new(&test_pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, NULL), ROTID_OK);
    for (int k = 0; k < MODES; k++) {
        int pair = client.equations.nrigid + k;
        double largest = 0;
        bench.number[k] = k + 1;
        bench.frequency_hz[k] = prediction_hz(&p, pair) * (1 + 0.01 * sin(3 * k + 1));
        bench.frequency_std[k] = 0.001 * (1 + k);
        for (int s = 0; s < SENSORS; s++)
            largest = fmax(largest, fabs(prediction_at_sensor(&p, pair, s)));
        for (int s = 0; s < SENSORS; s++) {
            bench.shape[s + k * SENSORS] = prediction_at_sensor(&p, pair, s) / largest + 0.03 * sin(7 * s + 5 * k);
            bench.shape_std[s + k * SENSORS] = 0.015 * (1 + 0.1 * s);
        }
    }
    bench.shape[4 + 1 * SENSORS] = NAN;
    bench.shape[9 + 3 * SENSORS] = NAN;
    bench.job = (struct job){.rotor = *rotor,
                             .measurement.nmode = MODES,
                             .measurement.number = bench.number,
                             .measurement.frequency_hz = bench.frequency_hz,
                             .measurement.frequency_std = bench.frequency_std,
                             .measurement.shape = bench.shape,
                             .measurement.shape_std = bench.shape_std,
                             .measurement.holdout = bench.holdout,
                             .measurement.weighed = {1.02 * rotor_mass(rotor), 1, 0.4 * rotor_length(rotor), 0.01},
                             .unknowns.nparameter = 2,
                             .unknowns.parameter = bench.parameter};
    return &bench.job;
}

static void open_columns(const struct job *job, const struct effect *extra, struct columns *c)
{
    assert_status(columns_open(&test_pool, job, job->measurement.number, job->measurement.holdout, extra, NULL, c), ROTID_OK);
    assert_status(columns_prepare(c, NULL), ROTID_OK);
}

/* dr/dx_p by five points, on one side where the parameter cannot go to the other. What columns_parameter needs is lost. */
static void difference(struct columns *c, int p, double h, int side, double *column)
{
    static const double at[3][5] = {{-2, -1, 0, 1, 2}, {0, 1, 2, 3, 4}, {0, -1, -2, -3, -4}};
    static const double weight[3][5] = {{1, -8, 0, 8, -1}, {-25, 48, -36, 16, -3}, {25, -48, 36, -16, 3}};
    int scheme = side < 0 ? 2 : side;
    double x[16], r[MOST];
    assert_true(c->model.equations.nparam <= 16 && c->nrow <= MOST);
    memset(column, 0, (size_t)c->nrow * sizeof *column);
    for (int s = 0; s < 5; s++) {
        memcpy(x, c->x, (size_t)c->model.equations.nparam * sizeof *x);
        x[p] += h * at[scheme][s];
        assert_status(columns_residual(c, x, r), ROTID_OK);
        for (int i = 0; i < c->nrow; i++)
            column[i] += weight[scheme][s] / (12 * h) * r[i];
    }
}

static void check_own(const struct job *job)
{
    struct columns c;
    double jacobian[MOST * 8], column[MOST], moved[MOST];
    open_columns(job, NULL, &c);
    assert_status(functional_jacobian(&c.functional, c.x, jacobian), ROTID_OK);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        assert_status(columns_parameter(&c, p, column), ROTID_OK);
        double apart = relative_difference((size_t)c.nrow, column, jacobian + (ptrdiff_t)p * c.nrow);
        if (!(apart < 1e-8))
            print_error("parameter %d: %g off its Jacobian\n", p, apart);
        assert_true(apart < 1e-8);
    }
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        assert_status(columns_parameter(&c, p, column), ROTID_OK);
        /* a place has to stay in its element, and the end of a cone between two points of the quadrature */
        double step = job->unknowns.parameter[p].kind == PARAMETER_EFFECT ? 2e-4 : 2e-3;
        difference(&c, p, step * fabs(c.x[p]), 0, moved);
        double apart = relative_difference((size_t)c.nrow, moved, column);
        if (!(apart < 5e-5))
            print_error("parameter %d: %g off its difference\n", p, apart);
        assert_true(apart < 5e-5);
        open_columns(job, NULL, &c);
    }
}

POOL_TEST(columns_of_own_parameters_are_the_jacobian)
{
    struct job *job = open_job(BUNDLE_TUBE);
    check_own(job);
    bench.holdout[2] = 1; /* leaves rows out, not parameters */
    check_own(job);
    struct columns c;
    open_columns(job, NULL, &c);
    assert_int_equal(c.nmode, MODES - 1);
    assert_int_equal(c.nrow, MODES - 1 + (MODES - 1) * SENSORS - 2 + WEIGHED);
    bench.number[0] = 2; /* another pairing */
    bench.number[1] = 1;
    check_own(job);
}

POOL_TEST(frequencies_and_scales_have_one_row_each)
{
    struct job *job = open_job(BUNDLE_RODS);
    job->measurement.shape = NULL;
    check_own(job);
    struct columns c;
    open_columns(job, NULL, &c);
    assert_int_equal(c.nrow, MODES + WEIGHED);
    job = open_job(BUNDLE_RODS);
    bench.shape_std[3] = NAN; /* noise of the shapes not known: they are not fitted */
    open_columns(job, NULL, &c);
    assert_int_equal(c.nrow, MODES + WEIGHED);
    for (int m = 0; m < MODES; m++)
        assert_int_equal(c.mode[m].sensors, 0);
}

/* A mass, a soft zone and a third effect with one parameter, all of whose values are identified beside E and G. */
static void add_three(struct job *job, const struct effect_kind *third, int target, const double *value)
{
    static const double mass[4] = {4, 1.603}, soft[4] = {0.3, 0.81, 0.05};
    bench_add(&job->rotor, cause_added_mass.effect, -1, 0, mass);
    bench_add(&job->rotor, cause_stiffness_local.effect, -1, 0, soft);
    bench_add(&job->rotor, third, target, 0, value);
    for (int p = 0; p < 2; p++)
        bench.parameter[2 + p] = (struct parameter){PARAMETER_EFFECT, 0, p, 0, NULL};
    for (int p = 0; p < 3; p++)
        bench.parameter[4 + p] = (struct parameter){PARAMETER_EFFECT, 1, p, 0, NULL};
    bench.parameter[7] = (struct parameter){PARAMETER_EFFECT, 2, 0, 0, NULL};
    job->unknowns.nparameter = 8;
}

POOL_TEST(columns_with_effects_in_the_model)
{
    static const double both[4] = {0.3, 0.6, 0.09, 0.5}, cone[4] = {31}, joint[4] = {3e-10};
    struct job *job = open_job(BUNDLE_TUBE);
    add_three(job, cause_step_stiffness.effect, -1, cone);
    check_own(job);
    job = open_job(BUNDLE_TUBE);
    bench_add(&job->rotor, cause_joint.effect, 1, 0, joint);
    bench_add(&job->rotor, cause_stiffness_local.effect, -1, 2, both); /* the shear with a depth of its own */
    bench.parameter[2] = (struct parameter){PARAMETER_EFFECT, 0, 0, 0, NULL};
    for (int p = 0; p < 4; p++)
        bench.parameter[3 + p] = (struct parameter){PARAMETER_EFFECT, 1, p, 0, NULL};
    job->unknowns.nparameter = 7;
    check_own(job);
}

/* By products of elements, and of one that is weighed by the matrices, whose rows of the modes are the same. */
POOL_TEST(columns_of_a_solid_are_the_same_by_products_and_matrices)
{
    static const double slope[4] = {0.2};
    struct job *job = open_job(BUNDLE_RODS);
    struct columns by[2];
    double column[2][MOST];
    job->models = models_as(&test_pool, AS_SOLID);
    assert_non_null(job->models);
    add_three(job, cause_stiffness_gradient.effect, 1, slope);
    open_columns(job, NULL, &by[0]);
    job->measurement.weighed = (struct weighed){0};
    open_columns(job, NULL, &by[1]);
    assert_int_equal(by[0].nrow, by[1].nrow + WEIGHED);
    for (int p = 0; p < 8; p++) {
        for (int i = 0; i < WEIGHED; i++)
            column[0][by[1].nrow + i] = NAN;
        for (int i = 0; i < 2; i++)
            assert_status(columns_parameter(&by[i], p, column[i]), ROTID_OK);
        assert_true(relative_difference((size_t)by[1].nrow, column[1], column[0]) < 1e-7);
        for (int i = 0; i < WEIGHED; i++) /* of stiffness nothing, of the mass and its place */
            assert_int_equal(!(fabs(column[0][by[1].nrow + i]) < 1e-6), p == 2 || (p == 3 && i == 1));
    }
}

static int targets(const struct rotor *rotor, enum cause_target target)
{
    return target == TARGET_GROUP       ? rotor->ngroup
           : target == TARGET_INTERFACE ? rotor->ngroup - 1
           : target == TARGET_SPRING    ? rotor->nspring
           : target == TARGET_DISK      ? rotor->ndisk
           : target == TARGET_TIEROD    ? rotor->ntierod
                                        : 1;
}

static int variants(const struct cause_kind *cause)
{
    int count = 0;
    while (count < 5 && cause->variant[count])
        count++;
    return count ? count : 1;
}

/* The extra effect at neutral, each of its sizes beside differences on the side that physics allows. */
static int check_probe(const struct job *job, struct effect *effect, const struct cause_kind *cause)
{
    static const struct effect none = {.kind = &nothing};
    int checked = 0;
    for (int p = 0; p < effect_parameters(effect); p++) {
        const struct cause_parameter *size = &cause->parameter[p];
        if (p == cause->place || p == cause->width)
            continue;
        struct columns c;
        double column[MOST], moved[MOST], lower, upper;
        open_columns(job, &none, &c);
        cause_range(cause, &job->rotor, effect, p, &lower, &upper); /* at an end of the rotor there is one way only */
        int side = size->one_sided ? size->one_sided : (lower == size->neutral) - (upper == size->neutral);
        assert_status(columns_probe(&c, effect), ROTID_OK);
        assert_status(columns_parameter(&c, job->unknowns.nparameter + p, column), ROTID_OK);
        double step = size->typical != size->neutral ? fabs(size->typical - size->neutral) : 1;
        difference(&c, job->unknowns.nparameter + p, 0.05 * step, side, moved);
        if (cause == &cause_added_mass && p > cause->place) { /* the width of no mass */
            for (int i = 0; i < c.nrow; i++)
                assert_true(column[i] == 0 && fabs(moved[i]) < 1e-4); /* the modes of the same matrices, solved for anew */
            continue;
        }
        double apart = relative_difference((size_t)c.nrow, moved, column);
        if (!(apart < 4e-5)) { /* of a clamp that gives way a little: rounding of the modes */
            difference(&c, job->unknowns.nparameter + p, 0.2 * step, side, moved);
            apart = relative_difference((size_t)c.nrow, moved, column);
        }
        if (!(apart < 4e-5))
            print_error("%s, target %d, variant %d, parameter %d: %g off\n", cause->id, effect->target, effect->variant, p,
                        apart);
        assert_true(apart < 4e-5);
        checked++;
    }
    return checked;
}

static int check_all_causes(const struct job *job)
{
    static const int identified[3] = {0, 1, 0};
    int checked = 0;
    for (int i = 0; i < catalogue_count(); i++) {
        const struct cause_kind *cause = catalogue_item(i);
        if (cause->class != CAUSE_PHYSICAL || cause->secant || !cause->effect->nparameter)
            continue;
        for (int t = 0; t < targets(&job->rotor, cause->target); t++)
            for (int v = 0; v < variants(cause); v++) {
                int has_target = cause->target >= TARGET_GROUP && cause->target <= TARGET_TIEROD;
                struct effect effect = {.name = "probe", .kind = cause->effect, .target = has_target ? t : -1, .variant = v};
                if (cause->applies && !cause->applies(&job->rotor, t, identified))
                    continue;
                if (cause->target == TARGET_SENSOR) /* fixed at the sensor of that index */
                    effect.target = v ? SENSORS / 2 : -1;
                for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
                    effect.value[p] = cause->parameter[p].neutral;
                if (cause->place >= 0)
                    effect.value[cause->place] = 1.137;
                if (cause->width >= 0)
                    effect.value[cause->width] = 0.08;
                checked += check_probe(job, &effect, cause);
            }
    }
    return checked;
}

POOL_TEST(columns_of_causes_are_derivatives_at_neutral)
{
    assert_true(check_all_causes(open_job(BUNDLE_TUBE)) >= 20);
}

POOL_TEST(columns_of_causes_beside_an_accepted_one)
{
    static const double cone[4] = {33}, mass[4] = {6, 1.7};
    struct job *job = open_job(BUNDLE_RODS);
    bench_add(&job->rotor, cause_step_stiffness.effect, -1, 0, cone);
    bench_add(&job->rotor, cause_added_mass.effect, -1, 0, mass);
    bench.parameter[2] = (struct parameter){PARAMETER_EFFECT, 0, 0, 0, NULL};
    bench.parameter[3] = (struct parameter){PARAMETER_EFFECT, 1, 0, 0, NULL};
    job->unknowns.nparameter = 4;
    bench.holdout[3] = 1;
    assert_true(check_all_causes(job) >= 20);
}

/* The probe changes nothing of the model, and one after the other in the same place gives what each gives alone. */
POOL_TEST(probes_leave_no_trace)
{
    static const struct effect none = {.kind = &nothing};
    struct job *job = open_job(BUNDLE_TUBE);
    struct effect joint = {.name = "j", .kind = cause_joint.effect, .target = 0},
                  mass = {.name = "m", .kind = cause_added_mass.effect, .target = -1, .value = {0, 1.1}};
    struct columns alone, in_turn;
    double expected[MOST], column[MOST], own[MOST], r[MOST];
    open_columns(job, &none, &alone);
    assert_status(columns_probe(&alone, &mass), ROTID_OK);
    assert_status(columns_parameter(&alone, job->unknowns.nparameter, expected), ROTID_OK);
    open_columns(job, NULL, &alone);
    assert_status(columns_parameter(&alone, 0, own), ROTID_OK);
    memcpy(r, alone.r, sizeof *r * (size_t)alone.nrow);
    open_columns(job, &none, &in_turn);
    assert_memory_equal(r, in_turn.r, sizeof *r * (size_t)alone.nrow);
    assert_status(columns_probe(&in_turn, &joint), ROTID_OK);
    assert_status(columns_parameter(&in_turn, job->unknowns.nparameter, column), ROTID_OK);
    assert_status(columns_probe(&in_turn, &mass), ROTID_OK);
    assert_status(columns_parameter(&in_turn, job->unknowns.nparameter, column), ROTID_OK);
    assert_true(relative_difference((size_t)in_turn.nrow, column, expected) < 1e-12);
    assert_status(columns_parameter(&in_turn, 0, column), ROTID_OK);
    assert_true(relative_difference((size_t)in_turn.nrow, column, own) < 1e-12);
}
