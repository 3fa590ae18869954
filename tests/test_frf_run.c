/* Which functions are synthesised, with which damping, and what their agreement with measured ones says: on jobs and measured
 * functions made in memory. */
#include <time.h>

#include "run/run.h"
#include "support.h"

#define MODES  4
#define POINTS 5
#define LINES  900

/* A stepped free shaft with its own first modes as the measured ones; nothing to identify but a formality of the fit. */
struct bench {
    struct group group[3];
    struct segment segment[3];
    struct sensor sensor[POINTS];
    struct job job;
    int number[MODES], holdout[MODES];
    double hz[MODES], damping[MODES], std[MODES];
    double line[LINES];
    double complex h[POINTS][LINES];
    struct frf frf[POINTS];
    struct frf_set set;
    struct frf_measured measured;
    struct message_list notes;
    struct identification identified;
    struct frf_result result;
};

/* factor: of E and G, so that frequencies go with its root and the shapes stay */
static void open_bench(struct bench *b, struct pool *pool, double factor)
{
    static const double length[3] = {0.3, 0.5, 0.3}, diameter[3] = {0.06, 0.12, 0.07}, z[POINTS] = {0, 0.123, 0.5, 0.71, 1.1};
    const struct material steel = {.name = "steel", .e = 2.1e11 * factor, .nu = 0.3, .rho = 7850, .isotropic = 1};
    memset(b, 0, sizeof *b);
    for (int g = 0; g < 3; g++) {
        b->group[g] = (struct group){.layer_of = -1, .name = "part", .material = steel};
        b->segment[g] =
            (struct segment){.group = g, .elements = 20, .length = length[g], .outer = diameter[g], .stiff_outer = diameter[g]};
    }
    for (int i = 0; i < POINTS; i++)
        b->sensor[i] = (struct sensor){10 * (i + 1), z[i]};
    b->job = (struct job){
        .deck = "memory",
        .rotor = {.ngroup = 3, .group = b->group, .nsegment = 3, .segment = b->segment, .nsensor = POINTS, .sensor = b->sensor},
        .measurement.number = b->number,
        .measurement.frequency_hz = b->hz,
        .measurement.damping = b->damping,
        .measurement.frequency_std = b->std,
        .measurement.holdout = b->holdout,
        .options.frf = {.given = 1, .axis = 2, .quantity = FRF_ACCELERATION, .low_hz = 100, .high_hz = 1900, .nline = LINES}};
    rotid_fit_defaults(sizeof b->job.options.fit, &b->job.options.fit);
    b->job.options.fit.functional = ROTID_HYBRID;
    for (int l = 0; l < LINES; l++)
        b->line[l] = 100 + 2.0 * l;
    message_open(&b->notes, pool);
}

/* The modes of the model at the bench's stiffness count as measured. */
static void measure_modes(struct bench *b, struct pool *pool)
{
    struct spectrum spectrum;
    assert_status(spectrum_compute(pool, NULL, &b->job.rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, &spectrum), ROTID_OK);
    for (int k = 0; k < MODES; k++) {
        b->number[k] = k + 1;
        b->hz[k] = spectrum.full_hz[k];
        b->damping[k] = 0.004 + 0.002 * k;
        b->std[k] = NAN;
    }
    b->job.measurement.nmode = MODES;
}

/* Measured functions from the bench itself: every point over the third. */
static void measure_functions(struct bench *b, struct pool *pool)
{
    double complex work[LINES];
    struct frf_result own;
    struct frf_pair pair[POINTS];
    for (int i = 0; i < POINTS; i++)
        pair[i] = (struct frf_pair){10 * (i + 1), 30};
    b->job.options.frf.npair = POINTS;
    b->job.options.frf.pair = pair;
    b->job.options.fit.reduction = ROTID_REDUCTION_NONE;
    assert_status(identify_run(pool, &b->job, 0, NULL, &b->notes, &b->identified), ROTID_OK);
    assert_status(frf_run(pool, &b->job, &b->identified, NULL, NULL, &b->notes, &own), ROTID_OK);
    assert_int_equal(own.nline, LINES);
    for (int i = 0; i < POINTS; i++) {
        assert_close(own.frequency_hz[i], b->line[i], 1e-3, 0);
        frf_synthesised(&own, i, b->h[i], work);
        b->frf[i] = (struct frf){
            .response_node = 10 * (i + 1), .response_direction = 1, .reference_node = 30, .reference_direction = 1, .h = b->h[i]};
    }
    memcpy(b->line, own.frequency_hz, sizeof b->line);
    b->set =
        (struct frf_set){.nline = LINES, .frequency_hz = b->line, .quantity = FRF_ACCELERATION, .nfrf = POINTS, .frf = b->frf};
    b->measured = (struct frf_measured){.set = &b->set, .path = "memory.uff"};
    b->job.options.frf = (struct frf_request){.given = 1, .axis = 2, .quantity = FRF_ACCELERATION};
}

static int run(struct bench *b, struct pool *pool)
{
    rotid_fit_free(b->identified.fit);
    b->identified.fit = NULL;
    int status = b->job.measurement.nmode ? identify_run(pool, &b->job, 0, NULL, &b->notes, &b->identified) : ROTID_OK;
    if (!status)
        status = frf_run(pool, &b->job, b->identified.fit ? &b->identified : NULL, b->set.nfrf ? &b->measured : NULL, NULL,
                         &b->notes, &b->result);
    return status;
}

static int says(const struct bench *b, const char *text)
{
    for (size_t i = 0; i < b->notes.count; i++)
        if (strstr(b->notes.item[i].text, text))
            return 1;
    return 0;
}

static struct bench bench;

static void close_bench(void)
{
    rotid_fit_free(bench.identified.fit);
}

static void open_measured(double factor)
{
    open_bench(&bench, &test_pool, factor);
    measure_modes(&bench, &test_pool);
    measure_functions(&bench, &test_pool);
}

/* ------------------------------------------------------------------------------------------------ agreement */

POOL_TEST(the_model_agrees_with_itself)
{
    open_measured(1);
    assert_status(run(&bench, &test_pool), ROTID_OK);
    const struct frf_result *r = &bench.result;
    assert_int_equal(r->nrow, POINTS);
    assert_int_equal(r->ndone, POINTS);
    assert_int_equal(r->nband, 3);
    for (int i = 0; i < POINTS; i++) {
        assert_close(frf_sums_frac(&r->row[i].sums), 1, 1e-9, 0);
        assert_close(frf_sums_frac(&r->row[i].moved), 1, 1e-6, 0);
        assert_close(frf_sums_scale(&r->row[i].sums), 1, 1e-9, 0);
        for (int b = 0; b < r->nband; b++) {
            const struct frf_at_mode *at = &r->at[b + i * r->nband];
            assert_close(at->level_db, 0, 0, 1e-6);
            assert_close(at->phase_deg, 0, 0, 1e-6);
            assert_close(at->deviation, 0, 0, 1e-9);
        }
    }
    int lines = 0; /* every line belongs to one mode */
    for (int b = 0; b < r->nband; b++) {
        assert_true(r->band[b].first <= r->band[b].at_model && r->band[b].at_model <= r->band[b].last);
        lines += r->band[b].last - r->band[b].first + 1;
    }
    assert_int_equal(lines, LINES);
    close_bench();
}

/* All moduli 8 % too high: every frequency 4 % off, shapes and masses right. FRAC is ruined, and whole again at the measured
 * frequencies; what the static part keeps of the stiffness makes the rest. */
POOL_TEST(a_frequency_error_is_told_from_an_error_of_the_shape)
{
    open_measured(1);
    for (int g = 0; g < 3; g++)
        bench.group[g].material.e *= 1.08;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    const struct frf_result *r = &bench.result;
    assert_true(frf_sums_frac(&r->sums) < 0.2);
    assert_true(frf_sums_frac(&r->moved) > 0.9999);
    for (int b = 0; b < r->nband; b++) {
        assert_close(r->band[b].model_hz / r->band[b].measured_hz, sqrt(1.08), 1e-9, 0);
        assert_true(frf_sums_frac(&r->band[b].moved) > 0.999 && frf_sums_frac(&r->band[b].sums) < 0.3);
        assert_close(frf_sums_level(&r->band[b].resonance), 0, 0, 0.7); /* peaks of accelerance do not care where they are */
    }
    close_bench();
}

/* Functions of another specimen than the modes: they fit the model where its frequencies are, not where the modes are. */
POOL_TEST(functions_and_modes_of_different_tests_are_noticed)
{
    open_measured(1);
    for (int k = 0; k < MODES; k++)
        bench.hz[k] *= 1.05;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_true(says(&bench, "do they come from the same test?"));
    close_bench();
}

/* Twice the mass: H^ is half of H; FRAC does not see it, scale and level do. */
POOL_TEST(a_wrong_calibration_shows_in_scale_and_level)
{
    open_measured(1);
    for (int l = 0; l < LINES; l++)
        bench.h[1][l] *= 0.5;
    for (int l = 0; l < LINES; l++)
        bench.h[2][l] = conj(bench.h[2][l]);
    bench.h[3][17] = NAN;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    const struct frf_row *row = bench.result.row;
    assert_close(frf_sums_frac(&row[1].sums), 1, 1e-9, 0);
    assert_close(frf_sums_scale(&row[1].sums), 0.5, 1e-9, 0);
    assert_close(frf_sums_level(&row[1].sums), -20 * log10(2), 1e-9, 0);
    assert_close(frf_sums_frac_conjugate(&row[2].sums), 1, 1e-9, 0);
    assert_true(frf_sums_frac(&row[2].sums) < 0.9);
    assert_int_equal(row[3].sums.lines, LINES - 1);
    assert_close(frf_sums_frac(&row[3].sums), 1, 1e-9, 0);
    close_bench();
}

POOL_TEST(directions_and_reciprocity_are_respected)
{
    struct frf_pair pairs[] = {{30, 50}, {20, 30}};
    open_measured(1);
    for (int l = 0; l < LINES; l++)
        bench.h[0][l] *= -1;
    bench.frf[0].response_direction = -1;  /* said, so it is no fault */
    bench.frf[1].response_direction = -1;  /* said, but not so */
    bench.frf[2].response_direction = 3;   /* along the rotor */
    bench.frf[3].reference_direction = -2; /* across */
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_int_equal(bench.result.nrow, 3);
    assert_int_equal(bench.result.nleft_out, 2);
    assert_true(says(&bench, "2 measured transfer functions are left out"));
    assert_close(frf_sums_scale(&bench.result.row[0].sums), 1, 1e-9, 0);
    assert_close(frf_sums_scale(&bench.result.row[1].sums), -1, 1e-9, 0);
    assert_int_equal(bench.result.row[2].response, 50);
    bench.job.options.frf.npair = 2; /* the first is measured the other way round */
    bench.job.options.frf.pair = pairs;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_int_equal(bench.result.nrow, 2);
    assert_true(bench.result.row[0].is_reciprocal && !bench.result.row[1].is_reciprocal);
    assert_close(frf_sums_scale(&bench.result.row[0].sums), 1, 1e-7, 0);
    bench.job.options.frf.axis = 0;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "there is no lateral transfer function between 30 and 50"));
    close_bench();
}

/* Mobilities asked for where accelerances were measured; and the lines of the file within LOW and HIGH, but that at 0 Hz. */
POOL_TEST(quantity_and_lines_are_those_of_card_and_file)
{
    open_measured(1);
    bench.job.options.frf.has_quantity = 1;
    bench.job.options.frf.quantity = FRF_VELOCITY;
    bench.job.options.frf.low_hz = bench.line[10];
    bench.job.options.frf.high_hz = bench.line[400];
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_int_equal(bench.result.nline, 391);
    assert_close(frf_sums_frac(&bench.result.sums), 1, 1e-9, 0);
    assert_close(frf_sums_scale(&bench.result.sums), 1, 1e-9, 0);
    bench.job.options.frf.low_hz = bench.job.options.frf.high_hz = 0;
    bench.line[0] = 0;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_int_equal(bench.result.nline, LINES - 1);
    bench.job.options.frf.low_hz = 5000;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "no measured line lies between LOW and HIGH"));
    close_bench();
}

/* ------------------------------------------------------------------------------------------------ points */

POOL_TEST(nodes_of_the_file_are_placed_in_the_model)
{
    static const struct frf_node nodes[] = {{777, {0.25, 0, 0}}, {778, {1.5, 0, 0}}};
    open_measured(1);
    bench.job.options.frf.axis = 0;
    bench.job.options.frf.flip = 1;
    bench.job.options.frf.origin = 0.6;
    bench.measured.nnode = 2;
    bench.measured.node = nodes;
    for (int i = 0; i < POINTS; i++)
        bench.frf[i].response_direction = bench.frf[i].reference_direction = 2;
    bench.frf[0].response_node = 777;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_close(bench.result.row[0].response_z, 0.35, 1e-12, 0);
    bench.frf[1].response_node = 778;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "node 778 lies at -0.9 m of the model, outside the rotor"));
    bench.frf[1].response_node = 779;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "point 779 of the transfer functions has no position"));
    close_bench();
}

POOL_TEST(without_a_card_every_sensor_over_the_first)
{
    open_bench(&bench, &test_pool, 1);
    measure_modes(&bench, &test_pool);
    bench.job.options.frf = (struct frf_request){.axis = 2, .quantity = FRF_ACCELERATION};
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_int_equal(bench.result.nrow, POINTS);
    for (int i = 0; i < POINTS; i++)
        assert_true(bench.result.row[i].response == 10 * (i + 1) && bench.result.row[i].reference == 10);
    assert_close(bench.result.frequency_hz[0], bench.hz[0] / 2, 1e-12, 0);
    assert_close(bench.result.frequency_hz[bench.result.nline - 1], 1.1 * bench.hz[MODES - 1], 1e-12, 0);
    bench.job.rotor.nsensor = 0;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "the deck has 0 sensors, expected *SENSORS"));
    close_bench();
}

/* ------------------------------------------------------------------------------------------------ damping */

POOL_TEST(damping_is_measured_stated_or_refused)
{
    open_bench(&bench, &test_pool, 1);
    measure_modes(&bench, &test_pool);
    bench.damping[1] = NAN;
    bench.damping[2] = 0; /* a file that does not know it */
    assert_status(run(&bench, &test_pool), ROTID_OK);
    const struct frf_result *r = &bench.result;
    const double mean = (0.004 + 0.010) / 2;
    const struct {
        enum frf_damping from;
        double zeta;
    } expected[] = {{FRF_DAMPING_SMALLEST, 0.004}, {FRF_DAMPING_SMALLEST, 0.004}, {FRF_DAMPING_MEASURED, 0.004},
                    {FRF_DAMPING_MEAN, mean},      {FRF_DAMPING_MEAN, mean},      {FRF_DAMPING_MEASURED, 0.010},
                    {FRF_DAMPING_MEAN, mean}};
    for (int m = 0; m < 7; m++) {
        assert_int_equal(r->damping[m], expected[m].from);
        assert_close(r->zeta[m], expected[m].zeta, 1e-12, 0);
    }
    bench.job.options.frf.damping = 0.02;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_true(bench.result.damping[0] == FRF_DAMPING_STATED && bench.result.zeta[0] == 0.02 && bench.result.zeta[2] == 0.004);
    bench.job.options.frf.damping = 0;
    bench.damping[0] = bench.damping[3] = NAN;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "no mode has a damping ratio, expected one as third value of *MODES"));
    bench.job.measurement.nmode = 0; /* nothing measured: as the deck states it */
    rotid_fit_free(bench.identified.fit);
    bench.identified.fit = NULL;
    bench.job.options.frf.damping = 0.02;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    bench.job.options.frf.high_hz = 0;
    assert_status(run(&bench, &test_pool), ROTID_ERROR_ARGUMENT);
    assert_true(says(&bench, "expected LOW and HIGH"));
    bench.job.options.frf.high_hz = 1e7;
    assert_status(run(&bench, &test_pool), ROTID_OK); /* all modes of a small model */
    close_bench();
}

/* Counted with the others (COUNT=ALL), the motion on the supports is damped by these and not by the rotor. */
POOL_TEST(suspension_modes_that_are_counted_are_no_part_of_the_mean)
{
    struct spring spring[2] = {{.name = "left", .position = 0.1, .lateral = 1e4},
                               {.name = "right", .position = 1, .lateral = 1e4}};
    open_bench(&bench, &test_pool, 1);
    bench.job.rotor.nspring = 2;
    bench.job.rotor.spring = spring;
    bench.job.rotor.count_all = 1;
    bench.job.measurement.numbering.nsupport = 2;
    measure_modes(&bench, &test_pool);
    bench.damping[0] = NAN;
    bench.damping[1] = 0.5;
    assert_status(run(&bench, &test_pool), ROTID_OK);
    const struct frf_result *r = &bench.result;
    const double expected[] = {0.008, 0.5, 0.008, 0.010, (0.008 + 0.010) / 2};
    for (int m = 0; m < 5; m++)
        assert_close(r->zeta[m], expected[m], 1e-12, 0);
    assert_int_equal(r->damping[0], FRF_DAMPING_SMALLEST);
    assert_int_equal(r->damping[4], FRF_DAMPING_MEAN);
    bench.damping[2] = bench.damping[3] = NAN; /* no elastic mode has a ratio: those that are known */
    assert_status(run(&bench, &test_pool), ROTID_OK);
    assert_close(bench.result.zeta[4], 0.5, 1e-12, 0);
    rotid_fit_free(bench.identified.fit);
    bench.identified.fit = NULL;
}

/* ------------------------------------------------------------------------------------------------ size, interruption, memory */

static int polled;

static int cancel_at_the_third(void *unused)
{
    (void)unused;
    return ++polled > 2;
}

/* 680 points over one, 30,000 lines: one curve stands for all of them, so that the test itself stays small. */
POOL_TEST(a_test_of_680_points_and_30000_lines_takes_seconds)
{
    enum { MANY = 680, LONG = 30000 };
    static struct frf frf[MANY];
    static double hz[LONG];
    static double complex h[LONG];
    open_measured(1);
    for (int l = 0; l < LONG; l++) {
        hz[l] = 100 + 0.06 * l;
        h[l] = 1 + 0.001 * l * I;
    }
    for (int i = 0; i < MANY; i++) {
        frf[i] = bench.frf[i % POINTS];
        frf[i].h = h;
    }
    bench.set = (struct frf_set){.nline = LONG, .frequency_hz = hz, .quantity = FRF_ACCELERATION, .nfrf = MANY, .frf = frf};
    clock_t start = clock(); /* processor time, which other programs on the machine do not change */
    assert_status(run(&bench, &test_pool), ROTID_OK);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    print_message("680 functions of 30000 lines, %d modes: %.2f s\n", bench.result.synthesis.nmode, seconds);
    assert_true(seconds < 60);
    const rotid_environment environment = {.size = sizeof environment, .cancelled = cancel_at_the_third};
    polled = 0;
    assert_status(frf_run(&test_pool, &bench.job, &bench.identified, &bench.measured, &environment, &bench.notes, &bench.result),
                  ROTID_OK);
    assert_int_equal(bench.result.ndone, 2 * SYNTHESIS_TOGETHER);
    assert_int_equal(bench.result.nrow, MANY);
    close_bench();
}

POOL_TEST(memory_that_runs_out_is_an_answer)
{
    open_measured(1);
    for (long n = 1;; n++) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list notes;
        struct frf_result result;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        message_open(&notes, &pool);
        int status = frf_run(&pool, &bench.job, &bench.identified, &bench.measured, NULL, &notes, &result);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        if (status == ROTID_OK)
            break;
        assert_status(status, ROTID_ERROR_MEMORY);
        assert_true(n < 10000);
    }
    close_bench();
}
