/* Modal superposition: against exact dynamic stiffness, closed forms of a free rotor, reciprocity and energy. */
#include "exact_receptance.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "run/run.h"
#include "support.h"

#define POINTS 5

/* A stepped free rotor of steel: three groups, points anywhere; the first elastic modes at about 310, 750 and 1430 Hz. */
static const double position[POINTS] = {0, 0.123, 0.5, 0.71, 1.1};

static struct rotor *stepped_rotor(int elements)
{
    static struct group groups[3];
    static struct segment segments[3];
    static struct sensor sensors[POINTS];
    static struct rotor rotor;
    const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};
    const double length[3] = {0.3, 0.5, 0.3}, diameter[3] = {0.06, 0.12, 0.07};
    for (int g = 0; g < 3; g++) {
        groups[g] = (struct group){.layer_of = -1, .name = "part", .material = steel};
        segments[g] = (struct segment){
            .group = g, .elements = elements, .length = length[g], .outer = diameter[g], .stiff_outer = diameter[g]};
    }
    for (int i = 0; i < POINTS; i++)
        sensors[i] = (struct sensor){i + 1, position[i]};
    rotor =
        (struct rotor){.ngroup = 3, .group = groups, .nsegment = 3, .segment = segments, .nsensor = POINTS, .sensor = sensors};
    return &rotor;
}

struct setup {
    struct rotor_model client;
    struct mass_properties mass;
    struct synthesis_pair pair[POINTS * POINTS]; /* response i, reference j at i + POINTS j */
    struct synthesis s;
    double zeta[SYNTHESIS_MOST_MODES];
};

static void open_setup(struct setup *t, const struct rotor *rotor, double up_to_hz, double zeta)
{
    int failed, dof[POINTS];
    assert_status(model_open(&test_pool, NULL, rotor, 0, NULL, 1, &t->client, &failed), ROTID_OK);
    for (int i = 0; i < POINTS; i++)
        dof[i] = t->client.master[i];
    for (int p = 0; p < POINTS * POINTS; p++)
        t->pair[p] = (struct synthesis_pair){.response = p % POINTS, .reference = p / POINTS};
    assert_status(
        synthesis_open(&test_pool, &t->client.equations, NULL, up_to_hz, 0, POINTS, dof, POINTS * POINTS, t->pair, &t->s),
        ROTID_OK);
    for (int r = 0; r < t->s.nmode; r++)
        t->zeta[r] = zeta;
    beam_mass_properties(&t->client.discrete.beam, &t->mass);
}

static void evaluate(const struct setup *t, const struct synthesis_lines *lines, int pair, double complex *h)
{
    double complex *work = POOL_ARRAY(&test_pool, double complex, lines->nline);
    assert_non_null(work);
    synthesis_evaluate(&t->s, lines, t->s.lambda, t->zeta, pair, 1, h, work);
}

/* Lines between the resonances: the sum has no damping there, and the exact solution none at all. */
static double worst_error(const struct setup *t, const struct rotor *rotor, int without_residual, int nline, const double *hz)
{
    static struct exact exact;
    double worst = 0;
    exact_open(rotor, &exact);
    for (int l = 0; l < nline; l++)
        for (int j = 0; j < POINTS; j++) {
            double expected[POINTS], largest = 0;
            exact_receptance(&exact, TWO_PI * hz[l], POINTS, position, j, expected);
            for (int i = 0; i < POINTS; i++)
                largest = fmax(largest, fabs(expected[i]));
            for (int i = 0; i < POINTS; i++) {
                double complex h;
                struct synthesis_lines lines = {
                    .nline = 1, .frequency_hz = &hz[l], .quantity = FRF_DISPLACEMENT, .without_residual = without_residual};
                evaluate(t, &lines, i + POINTS * j, &h);
                assert_true(cimag(h) == 0);
                worst = fmax(worst, fabs(creal(h) - expected[i]) / largest);
            }
        }
    return worst;
}

POOL_TEST(the_sum_is_the_exact_receptance_and_the_residual_makes_it_so)
{
    static struct setup t;
    static const double hz[] = {3, 40, 150, 400, 620, 900, 1200, 1600, 1990};
    const struct rotor *rotor = stepped_rotor(160);
    open_setup(&t, rotor, 4 * 2000, 0);
    double with = worst_error(&t, rotor, 0, 9, hz), without = worst_error(&t, rotor, 1, 9, hz);
    print_message("%d modes up to 8000 Hz: error %.1e with the residual, %.1e without\n", t.s.nmode, with, without);
    assert_true(with < 2e-4 && without > 50 * with);
}

/* COUNT=ALL counts the suspension modes among the others, and their eigenvalues are no shift for the residuals. */
POOL_TEST(suspension_modes_may_be_counted)
{
    static struct setup t;
    static const double hz[] = {3, 40, 150, 400, 620, 900, 1200, 1600, 1990};
    struct spring springs[2] = {{.name = "left", .position = 0, .lateral = 500},
                                {.name = "right", .position = 1.1, .lateral = 800}};
    struct rotor *rotor = stepped_rotor(160);
    rotor->nspring = 2;
    rotor->spring = springs;
    rotor->count_all = 1;
    open_setup(&t, rotor, 4 * 2000, 0);
    assert_int_equal(t.s.nrigid, 0);
    double error = worst_error(&t, rotor, 0, 9, hz);
    print_message("suspension modes from %.2f Hz: error %.1e\n", sqrt(t.s.lambda[0]) / TWO_PI, error);
    assert_true(error < 2e-4);
}

/* What is left out enters with the square of (f/f_next)^2: from twice to four times the highest line it drops by 2^4 and more. */
POOL_TEST(more_modes_help_as_the_formula_says)
{
    static struct setup all, t;
    static const double hz[] = {1980}, factor[] = {2, 4, 8};
    const struct rotor *rotor = stepped_rotor(40);
    double error[3], largest = 0;
    open_setup(&all, rotor, 3e5, 0);
    assert_true(all.s.nmode > 40);
    for (int i = 0; i < 3; i++) {
        open_setup(&t, rotor, 2000 * factor[i], 0);
        error[i] = 0;
        for (int p = 0; p < POINTS * POINTS; p++) {
            struct synthesis_lines lines = {.nline = 1, .frequency_hz = hz, .quantity = FRF_DISPLACEMENT};
            double complex h, reference;
            evaluate(&t, &lines, p, &h);
            evaluate(&all, &lines, p, &reference);
            error[i] = fmax(error[i], cabs(h - reference));
            largest = fmax(largest, cabs(reference));
        }
        error[i] /= largest;
    }
    print_message("modes up to 2, 4, 8 times the line: %.1e, %.1e, %.1e\n", error[0], error[1], error[2]);
    assert_true(error[1] < error[0] / 10 && error[2] < error[1] / 10 && error[1] < 2e-3);
}

POOL_TEST(functions_are_reciprocal_and_take_energy_in)
{
    static struct setup t;
    enum { LINES = 400 };
    double hz[LINES];
    double complex h[LINES], back[LINES];
    for (int l = 0; l < LINES; l++)
        hz[l] = 5 * (l + 1);
    open_setup(&t, stepped_rotor(20), 8000, 0.01);
    for (int q = FRF_DISPLACEMENT; q <= FRF_ACCELERATION; q++) {
        struct synthesis_lines lines = {.nline = LINES, .frequency_hz = hz, .quantity = (enum frf_quantity)q};
        for (int i = 0; i < POINTS; i++) {
            for (int j = 0; j < i; j++) {
                evaluate(&t, &lines, i + POINTS * j, h);
                evaluate(&t, &lines, j + POINTS * i, back);
                for (int l = 0; l < LINES; l++)
                    assert_true(cabs(h[l] - back[l]) <= 1e-8 * cabs(h[l]) + 1e-14);
            }
            evaluate(&t, &lines, i + POINTS * i, h); /* power v F/2 >= 0: Re of the mobility */
            for (int l = 0; l < LINES; l++)
                assert_true((q == FRF_DISPLACEMENT ? -cimag(h[l]) : q == FRF_VELOCITY ? creal(h[l]) : cimag(h[l])) > 0);
        }
    }
}

POOL_TEST(far_below_the_first_mode_the_free_rotor_is_a_rigid_body)
{
    static struct setup t;
    open_setup(&t, stepped_rotor(20), 8000, 0.01);
    double hz = 0.3;
    for (int p = 0; p < POINTS * POINTS; p++) {
        struct synthesis_lines lines = {.nline = 1, .frequency_hz = &hz, .quantity = FRF_ACCELERATION};
        double zi = position[p % POINTS] - t.mass.center, zj = position[p / POINTS] - t.mass.center,
               expected = 1 / t.mass.mass + zi * zj / t.mass.inertia;
        double complex h;
        evaluate(&t, &lines, p, &h);
        assert_close(creal(h), expected, 0, 1e-4 / t.mass.mass);
    }
}

/* With s = decay + i omega the exponential window adds decay/w to the ratio of every mode: |H| at the resonance falls by that. */
POOL_TEST(an_exponential_window_adds_its_decay_to_the_damping)
{
    static struct setup t;
    open_setup(&t, stepped_rotor(20), 8000, 0.002);
    double w = sqrt(t.s.lambda[2]), hz = w / TWO_PI, decay = 0.002 * w;
    struct synthesis_lines lines = {.nline = 1, .frequency_hz = &hz, .quantity = FRF_DISPLACEMENT};
    double complex plain, windowed;
    evaluate(&t, &lines, 0, &plain);
    lines.decay = decay;
    evaluate(&t, &lines, 0, &windowed);
    assert_close(cabs(windowed) / cabs(plain), 0.5, 0.01, 0);
}

/* ------------------------------------------------------------------------------------------------ Figure 15 */

/* Width of the peak of the mobility at the half-power points over its frequency: 2 zeta of one mode. */
static double half_power(const struct setup *t, int pair, int r)
{
    enum { LINES = 4001 };
    static double hz[LINES];
    static double complex h[LINES];
    struct synthesis only = t->s; /* one mode: what the neighbours add is no damping */
    double resonance = sqrt(t->s.lambda[r]) / TWO_PI, low = NAN, high = NAN, peak = 0;
    double complex *work = POOL_ARRAY(&test_pool, double complex, LINES);
    for (int l = 0; l < LINES; l++)
        hz[l] = resonance * (0.9 + 0.2 * l / (LINES - 1));
    struct synthesis_lines lines = {.nline = LINES, .frequency_hz = hz, .quantity = FRF_VELOCITY, .without_residual = 1};
    struct synthesis_pair one = {.response = t->pair[pair].response, .reference = t->pair[pair].reference};
    double shape[2] = {t->s.shape[r + one.response * t->s.nmode], t->s.shape[r + one.reference * t->s.nmode]};
    one.response = 0;
    one.reference = 1;
    only.nmode = 1;
    only.shape = shape;
    only.pair = &one;
    synthesis_evaluate(&only, &lines, &t->s.lambda[r], &t->zeta[r], 0, 1, h, work);
    for (int l = 0; l < LINES; l++)
        peak = fmax(peak, cabs(h[l]));
    for (int l = 1; l < LINES; l++) {
        double a = cabs(h[l - 1]) / peak - sqrt(0.5), b = cabs(h[l]) / peak - sqrt(0.5);
        if (a < 0 && b >= 0)
            low = hz[l - 1] + (hz[l] - hz[l - 1]) * a / (a - b);
        if (a >= 0 && b < 0)
            high = hz[l - 1] + (hz[l] - hz[l - 1]) * a / (a - b);
    }
    return (high - low) / 2 / resonance;
}

POOL_TEST(half_power_bandwidths_are_the_damping_of_table_4)
{
    static const double table4[PAPER_MODES] = {6.008e-3, 9.205e-3, 1.592e-2, 1.045e-2, 1.935e-2, 1.893e-2};
    static struct setup t;
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 0);
    struct synthesis_pair pair = {.response = 1, .reference = 0}; /* N 19 over N 1 */
    int failed, dof[2];
    rotor->group[1].material.e = 1.157e11;
    rotor->group[1].material.g = 0.316e11;
    assert_status(model_open(&test_pool, NULL, rotor, 0, NULL, 1, &t.client, &failed), ROTID_OK);
    dof[0] = t.client.master[0];
    dof[1] = t.client.master[18];
    t.pair[0] = pair;
    assert_status(synthesis_open(&test_pool, &t.client.equations, NULL, 4 * 3200, 0, 2, dof, 1, t.pair, &t.s), ROTID_OK);
    assert_int_equal(t.s.nrigid, 2);
    for (int k = 0; k < PAPER_MODES; k++) {
        t.zeta[2 + k] = table4[k];
        assert_close(half_power(&t, 0, 2 + k), table4[k], 2e-3, 0);
    }
}

/* ------------------------------------------------------------------------------------------------ FRAC */

POOL_TEST(frac_is_one_for_the_same_and_blind_to_scale)
{
    enum { LINES = 50 };
    double complex a[LINES], b[LINES];
    for (int l = 0; l < LINES; l++)
        a[l] = 1 / (25.0 * 25 - l * l + I * 0.05 * 25 * l + 1e-3);
    struct frf_sums same = {0}, scaled = {0}, conjugate = {0}, other = {0};
    frf_sums_add(&same, LINES, a, a);
    assert_close(frf_sums_frac(&same), 1, 1e-14, 0);
    assert_close(frf_sums_scale(&same), 1, 1e-14, 0);
    assert_close(frf_sums_level(&same), 0, 0, 1e-12);
    for (int l = 0; l < LINES; l++)
        b[l] = -2.5 * a[l];
    b[7] = NAN;
    frf_sums_add(&scaled, LINES, b, a);
    assert_int_equal(scaled.lines, LINES - 1);
    assert_close(frf_sums_frac(&scaled), 1, 1e-14, 0);
    assert_close(frf_sums_scale(&scaled), -2.5, 1e-14, 0);
    assert_close(frf_sums_level(&scaled), 20 * log10(2.5), 1e-12, 0);
    for (int l = 0; l < LINES; l++)
        b[l] = conj(a[l]);
    frf_sums_add(&conjugate, LINES, b, a);
    assert_close(frf_sums_frac_conjugate(&conjugate), 1, 1e-14, 0);
    assert_true(frf_sums_frac(&conjugate) < 0.5);
    for (int l = 0; l < LINES; l++)
        b[l] = 1 / (35.0 * 35 - l * l + I * 0.05 * 35 * l);
    frf_sums_add(&other, LINES, b, a);
    assert_true(frf_sums_frac(&other) < 0.1 && frf_sums_frac(&other) >= 0);
    struct frf_sums empty = {0};
    assert_true(isnan(frf_sums_frac(&empty)) && isnan(frf_sums_scale(&empty)) && isnan(frf_sums_level(&empty)));
}

POOL_TEST(too_many_modes_are_refused)
{
    static struct setup t;
    int failed, dof[1];
    struct synthesis_pair pair = {0};
    assert_status(model_open(&test_pool, NULL, stepped_rotor(200), 0, NULL, 1, &t.client, &failed), ROTID_OK);
    dof[0] = t.client.master[0];
    assert_status(synthesis_open(&test_pool, &t.client.equations, NULL, 1e8, 0, 1, dof, 1, &pair, &t.s), ROTID_ERROR_ARGUMENT);
}
