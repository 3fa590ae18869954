/* Bands of critical speeds where they have a closed form: W is a power of what is uncertain, which is log-normal. */
#include "running_case.h"
#include "support.h"

#define DRAWS 2000

/* Bounce alone: m on two springs; W^2 = (k1 + k2)/m. Light and stiff, the shaft adds nothing. */
#define RIGID                                                                                                                    \
    "*MATERIAL, NAME=s\n*ELASTIC\n1e12, 0.3\n*DENSITY\n1\n*SHAFT, NAME=a, MATERIAL=s\n0.5, 0.2, 0, 4\n0.5, 0.2, 0, "             \
    "4\n*RUNNING\n"                                                                                                              \
    "*DISK\n0.5, 50, 2, 4\n"

static double tail(double z) /* of the normal distribution above z */
{
    return erfc(z / sqrt(2)) / 2;
}

static const rotid_critical_speed *forward(const struct running_case *c)
{
    for (int i = 0; i < c->speeds.ncritical_speeds; i++)
        if (!strcmp(c->speeds.critical_speeds[i].whirl, "forward"))
            return &c->speeds.critical_speeds[i];
    fail();
    return NULL;
}

POOL_TEST(one_draw_for_both_bearings_is_log_normal)
{
    struct running_case c;
    const double std = 0.2, w0 = sqrt(2 * 1e6 / 50) / RPM, high = 1300, sigma = std / 2;
    char *deck = pool_format(
        &test_pool,
        RIGID "*BEARING, NAME=p, STD=%g, 0\nstart, 1e6, 10\n*BEARING, LIKE=p\nend, 1e6, 10\n*OPERATION, MARGIN=0.4\n1000, %g\n",
        std, high);
    assert_int_equal(running_case_open(deck, 4000, 9, DRAWS, &c), ROTID_OK);
    const rotid_critical_speed *w = forward(&c);
    assert_close(w->speed_rpm, w0, 1e-3, 0);
    /* a quantile of n draws has the deviation sqrt(p (1 - p)/n)/density: 2.5 % at 1.96 gives 0.06 sigma, taken thrice */
    assert_close(log(w->ci95[0] / w->speed_rpm), -1.96 * sigma, 0, 0.18 * sigma);
    assert_close(log(w->ci95[1] / w->speed_rpm), 1.96 * sigma, 0, 0.18 * sigma);
    assert_close(w->std / w->speed_rpm, sigma, 0.08, 0);
    assert_int_equal(w->nvariance_shares, 1);
    assert_string_equal(w->variance_shares[0].source, "bearing p");
    assert_close(w->variance_shares[0].share, 1, 1e-12, 0);
    assert_close(w->margin.value, (w0 - high) / high, 0, 2e-3);
    double chance = tail(log(1.4 * high / w0) / sigma) + 1 - tail(log(0.6 * 1000 / w0) / sigma);
    assert_close(w->margin.probability, chance, 0, 3 * sqrt(chance * (1 - chance) / DRAWS) + 1e-3);
    assert_close(c.speeds.stability.probability_stable, 1, 0, 0);
    int seen = 0;
    for (int i = 0; i < c.speeds.campbell[4].nmodes; i++) { /* of the Campbell diagram exactly log-normal */
        const rotid_campbell_mode *m = &c.speeds.campbell[4].modes[i];
        seen += fabs(m->frequency_hz / (w0 / 60) - 1) < 1e-3 &&
                fabs(log(m->ci95[1] / m->frequency_hz) / (1.96 * sigma) - 1) < 1e-3 &&
                fabs(log(m->ci95[0] / m->frequency_hz) / (1.96 * sigma) + 1) < 1e-3;
    }
    assert_int_equal(seen, 2);
    running_case_close(&c);
}

/* Bounce in bearings with a cross-coupled stiffness q: Re lambda = -(c - q/w)/m, so a draw is stable where c w > q. With the draw
 * of k the left side goes as its root and the right one as k itself. */
POOL_TEST(the_probability_of_a_stable_machine_is_that_of_damping_above_cross_coupling)
{
    static const struct {
        double k_std, c_std, q;
    } table[] = {{0, 0.3, 1.03e4}, {0, 0.3, 1.9e4}, {1.2, 0, 5e3}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        struct running_case c;
        double w = sqrt(2 * 1e6 / 50), far = log(70 * w / table[i].q),
               chance = 1 - tail(table[i].c_std > 0 ? far / table[i].c_std : 2 * far / table[i].k_std);
        const char *deck = pool_format(&test_pool,
                                       RIGID "*BEARING, NAME=p, STD=%g, %g\nstart, 1e6, %g, -%g, 1e6, 70, 0, 0, 70\n"
                                             "*BEARING, LIKE=p\nend, 1e6, %g, -%g, 1e6, 70, 0, 0, 70\n*OPERATION\n2500, 3000\n",
                                       table[i].k_std, table[i].c_std, table[i].q, table[i].q, table[i].q, table[i].q);
        assert_int_equal(running_case_open(deck, 4000, 9, DRAWS, &c), ROTID_OK);
        print_message("stable in %.4f of the draws, of all %.4f\n", c.speeds.stability.probability_stable, chance);
        assert_close(c.speeds.stability.probability_stable, chance, 0, 3 * sqrt(chance * (1 - chance) / DRAWS) + 2e-3);
        running_case_close(&c);
    }
}

POOL_TEST(draws_of_their_own_share_the_variance)
{
    struct running_case c;
    assert_int_equal(
        running_case_open(RIGID "*BEARING, NAME=p, STD=0.1, 0.5\nstart, 1e6, 10\n*BEARING, NAME=q, STD=0.2\nend, 1e6, 10\n", 4000,
                          9, DRAWS, &c),
        ROTID_OK);
    const rotid_critical_speed *w = forward(&c);
    assert_int_equal(w->nvariance_shares, 2);
    assert_close(w->variance_shares[0].share, 0.2, 1e-3, 0); /* d ln W = 1/4 of each */
    assert_close(w->variance_shares[1].share, 0.8, 1e-3, 0);
    assert_close(w->std / w->speed_rpm, sqrt(0.05) / 4, 0.08, 0);
    running_case_close(&c);
}

static const rotid_speed_sensitivity *by(const rotid_critical_speed *w, const char *parameter)
{
    for (int i = 0; i < w->nsensitivities; i++)
        if (!strcmp(w->sensitivities[i].parameter, parameter))
            return &w->sensitivities[i];
    fail_msg("no sensitivity by %s", parameter);
    return NULL;
}

#define BOUNCE                                                                                                                   \
    RIGID "*BEARING, NAME=p, STD=%g, %g\nstart, 1e6, 100\n*BEARING, LIKE=p\nend, 1e6, 100\n*UNBALANCE\n0.5, 1e-3\n"              \
          "*PROBE, NAME=x\n0.5\n*OPERATION\n2500, 3000\n"

/* zeta = c/(2 sqrt(k m)) = 0.01, delta = 2 pi zeta; at the peak, W^2 = k/m/(1 - 2 zeta^2), |x| ~ sqrt(k)/c. */
POOL_TEST(damping_and_peaks_have_their_derivatives_and_bands)
{
    struct running_case c;
    const double sigma = 0.3, delta = 2 * 3.141592653589793 * 0.01;
    assert_int_equal(running_case_open(pool_format(&test_pool, BOUNCE, 1e-6, sigma), 4000, 9, DRAWS, &c), ROTID_OK);
    const rotid_critical_speed *w = forward(&c);
    assert_close(w->log_decrement, delta, 2e-3, 0); /* the shaft is not without mass */
    assert_close(log(w->log_decrement_ci95[0] / w->log_decrement), -1.96 * sigma, 0, 0.18 * sigma);
    assert_close(log(w->log_decrement_ci95[1] / w->log_decrement), 1.96 * sigma, 0, 0.18 * sigma);
    assert_close(by(w, "p.k")->speed, 0.5, 1e-3, 0);
    assert_close(by(w, "p.c")->speed, 0, 0, 1e-3);
    assert_close(by(w, "p.k")->log_decrement, -delta / 2, 3e-3, 0);
    assert_close(by(w, "p.c")->log_decrement, delta, 3e-3, 0);
    assert_close(by(w, "p.k")->amplitude, 0.5, 0, 3e-3);
    assert_close(by(w, "p.c")->amplitude, -1, 1e-3, 0);
    int seen = 0;
    for (int i = 0; i < c.speeds.campbell[4].nmodes; i++) { /* by the linear prediction normal */
        const rotid_campbell_mode *m = &c.speeds.campbell[4].modes[i];
        seen += fabs(m->log_decrement / delta - 1) < 2e-3 &&
                fabs((m->log_decrement_ci95[1] - m->log_decrement) / (1.96 * sigma * delta) - 1) < 3e-3 &&
                fabs((m->log_decrement - m->log_decrement_ci95[0]) / (1.96 * sigma * delta) - 1) < 3e-3;
    }
    assert_int_equal(seen, 2);
    running_case_close(&c);
}

/* Below the critical speed |x| = u W^2/(k - m W^2) falls with k alone: its quantiles are those of k. */
POOL_TEST(the_response_has_the_band_of_its_stiffness)
{
    struct running_case c;
    const double sigma = 0.1, m = 50, k = 2e6;
    int seen = 0;
    assert_int_equal(running_case_open(pool_format(&test_pool, BOUNCE, sigma, 0.0), 4000, 9, 400, &c), ROTID_OK);
    const rotid_probe_response *u = &c.speeds.unbalance[0];
    for (int i = 0; i < u->nspeed_rpm; i++) {
        double w = u->speed_rpm[i] * RPM, z[2];
        if (u->speed_rpm[i] < 300 || u->speed_rpm[i] > 1200)
            continue;
        for (int end = 0; end < 2; end++) /* the factor on k that has such an amplitude */
            z[end] = log((1e-3 * w * w / (end ? u->to_m[i] : u->from_m[i]) + m * w * w) / k) / sigma;
        assert_close(z[0], 1.96, 0, 0.4); /* three deviations of a quantile of 400 draws */
        assert_close(z[1], -1.96, 0, 0.4);
        seen++;
    }
    assert_true(seen > 20);
    running_case_close(&c);
}

/* A permitted unbalance is that of the mass that was found, not of the deck's; by the mass the amplitude has the derivative with
 * it. */
POOL_TEST(a_grade_follows_an_identified_mass)
{
    static const double of_deck[4] = {10, 30, 30 * 0.999, 30 * 1.001};
    double peak[4], slope = 0;
    for (int i = 0; i < 4; i++) {
        struct running_case c;
        double x[1] = {30}, std[1] = {3}, covariance[1] = {9};
        const rotid_fit_result fit = {.n = 1, .x = x, .std = std, .covariance = covariance};
        char *text =
            pool_format(&test_pool,
                        "*MATERIAL, NAME=s\n*ELASTIC\n1e12, 0.3\n*DENSITY\n1\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.2, 0, 8\n*DISK, "
                        "NAME=d\n0.5, %.9g, 2, 4\n%s*RUNNING\n*BEARING\nstart, 1e6, 300\n*BEARING\nend, 1e6, 300\n*UNBALANCE, "
                        "G=2.5\n0.5, 1\n*PROBE, NAME=x\n0.5\n*OPERATION\n2500, 3000\n",
                        of_deck[i], i ? "" : "*IDENTIFY\nd.mass, 1, 100, 30\n");
        assert_int_equal(running_case_open(text, 4000, 9, 0, &c), ROTID_OK);
        if (!i)
            assert_int_equal(running_case_run(&c, &fit, 4000, 9, 50), ROTID_OK);
        const rotid_critical_speed *w = forward(&c);
        assert_int_equal(w->npeaks, 1);
        peak[i] = w->peaks[0].amplitude_m;
        slope = i ? slope : by(w, "d.mass")->amplitude;
        running_case_close(&c);
    }
    assert_close(peak[0], peak[1], 1e-9, 0);
    assert_close(slope, log(peak[3] / peak[2]) / log(of_deck[3] / of_deck[2]), 1e-4, 0);
}

#define BY_DIFFERENCES 1e-3
static double changed(double one, int which, int number)
{
    return which == number ? one : 0;
}

/* A machine with everything that may be uncertain; which: of these the one that is changed, by a logarithm. */
static int open_changed(struct running_case *c, int which, double by_log)
{
    double k = exp(changed(by_log, which, 0)), damping = exp(changed(by_log, which, 1)), eta = exp(changed(by_log, which, 2)),
           pull = exp(changed(by_log, which, 3)), e = exp(changed(by_log, which, 4));
    char *text = pool_format(
        &test_pool,
        "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n0.6, 0.08, 0, 6\n*SHAFT, NAME=b, "
        "MATERIAL=s\n0.4, 0.12, 0, 4\n*RUNNING\n*DISK\n0.7, 20, 0.2, 0.35\n*BEARING, NAME=p, STD=0.1, 0.1\n0.1, %.17g, %.17g, "
        "%.17g, %.17g, %.17g, 0, 0, %.17g\n*BEARING, NAME=q\n0.9, 3e7, 2e7, 2e3, 3e3\n*PEDESTAL, BEARING=q\n40, 50, 3e8, 2e8, "
        "1e4, 1e4\n*LOSS\na, %.17g, 1e-3\n*PULL, GROUP=b, STD=0.1\n%.17g\n*CHANGE\na.E, %.17g, 0.1\n*UNBALANCE\n0.7, 1e-3\n"
        "*PROBE, NAME=x\n0.6, 30\n*OPERATION\n4000, 5000\n",
        2e7 * k, 3e6 * k, -3e6 * k, 3e7 * k, 2e3 * damping, 3e3 * damping, 0.01 * eta, 1e6 * pull, 0.95 * e);
    return running_case_open(text, 12000, 25, which < 0 ? 20 : 0, c);
}

POOL_TEST(derivatives_are_those_of_differences)
{
    static const char *const name[] = {"p.k", "p.c", "loss a", "pull b", "change a.E"};
    struct running_case c, side[2];
    int peaks = 0;
    assert_int_equal(open_changed(&c, -1, 0), ROTID_OK);
    assert_true(c.speeds.ncritical_speeds >= 3);
    for (int which = 0; which < 5; which++) {
        for (int i = 0; i < 2; i++)
            assert_int_equal(open_changed(&side[i], which, i ? BY_DIFFERENCES : -BY_DIFFERENCES), ROTID_OK);
        for (int i = 0; i < c.speeds.ncritical_speeds; i++) {
            const rotid_critical_speed *w = &c.speeds.critical_speeds[i], *a = &side[0].speeds.critical_speeds[i],
                                       *b = &side[1].speeds.critical_speeds[i];
            const rotid_speed_sensitivity *s = by(w, name[which]);
            double unit = which == 2 ? 0.01 : 1; /* of a loss the derivative is by itself */
            assert_close(s->speed * unit, log(b->speed_rpm / a->speed_rpm) / (2 * BY_DIFFERENCES), 1e-4, 1e-6);
            assert_close(s->log_decrement * unit, (b->log_decrement - a->log_decrement) / (2 * BY_DIFFERENCES), 1e-4, 1e-6);
            if (!w->npeaks || !a->npeaks || !b->npeaks)
                continue;
            assert_close(s->amplitude * unit, log(b->peaks[0].amplitude_m / a->peaks[0].amplitude_m) / (2 * BY_DIFFERENCES), 1e-3,
                         1e-5);
            peaks++;
        }
        for (int i = 0; i < 2; i++)
            running_case_close(&side[i]);
    }
    assert_true(peaks >= 5);
    running_case_close(&c);
}

/* The formula at factors of which the values are known by hand: 17 (1 - 1/1) = 0, 17 (1 - 1/8.5) = 15, and the caps. */
POOL_TEST(the_margin_of_api_617_goes_by_the_amplification)
{
    const struct machine machine = {.api617 = 1, .low = 100, .high = 200};
    assert_true(isnan(speeds_required(&machine, 2.49, 90)) && isnan(speeds_required(&machine, NAN, 90)));
    assert_close(speeds_required(&machine, 2.5, 90), 0, 0, 1e-15);
    assert_close(speeds_required(&machine, 10, 90), 0.15, 1e-12, 0);
    assert_close(speeds_required(&machine, 10, 210), 0.25, 1e-12, 0);
    assert_close(speeds_required(&machine, 1e3, 90), 0.16, 1e-12, 0);
    assert_close(speeds_required(&machine, 1e3, 210), 0.26, 1e-12, 0);
    assert_close(speeds_required(&machine, 10, 150), 0, 0, 0); /* the margin itself is below 0 there */
    struct running_case c;
    assert_int_equal(running_case_open(RIGID
                                       "*BEARING, NAME=p, STD=0.1\nstart, 1e6, 800\n*BEARING, LIKE=p\nend, 1e6, 800\n"
                                       "*UNBALANCE\n0.5, 1e-3\n*PROBE, NAME=x\n0.5\n*OPERATION, MARGIN=API617\n2500, 4000\n",
                                       5000, 9, 400, &c),
                     ROTID_OK);
    const rotid_critical_speed *w = forward(&c); /* zeta = 1600/(2 sqrt(2e6 50)) = 0.08: by half power 6.09 */
    assert_close(w->amplification, 6.09, 5e-3, 0);
    assert_close(w->margin.required, 0.17 * (1 - 1 / (w->amplification - 1.5)), 1e-12, 0);
    assert_true(w->margin.value > 0.2 && w->margin.probability > 0.9);
    running_case_close(&c);
}

/* A pinned shaft: W ~ sqrt(E), and a hammer test of E with few degrees of freedom: Student's t. */
#define PINNED                                                                                                                   \
    "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, 20\n*IDENTIFY\na.E, %g, "   \
    "%g, "                                                                                                                       \
    "2e11\n*RUNNING\n*BEARING\nstart, 1e13, 0\n*BEARING\nend, 1e13, 0\n"

static rotid_fit_result fit_of(double *x, double *std, double *covariance, int dof)
{
    return (rotid_fit_result){
        .n = 1, .x = x, .std = std, .covariance = covariance, .dof = dof, .variance_from_residuals = dof > 0};
}

POOL_TEST(the_modulus_has_the_distribution_of_its_fit)
{
    struct running_case c;
    double x = 2e11, std = 0.04 * x, covariance = std * std;
    for (int dof = 0; dof <= 3; dof += 3) {
        rotid_fit_result fit = fit_of(&x, &std, &covariance, dof);
        assert_int_equal(running_case_open(pool_format(&test_pool, PINNED, 1e9, 1e13), 15000, 9, 0, &c), ROTID_OK);
        assert_int_equal(running_case_run(&c, &fit, 15000, 9, DRAWS), ROTID_OK);
        const rotid_critical_speed *w = forward(&c);
        double t = dof ? 3.182 : 1.960; /* 97.5 % of Student's t with 3 degrees of freedom, of the normal distribution */
        assert_close(log(w->ci95[1] / w->ci95[0]), 2 * t * 0.02, dof ? 0.2 : 0.1, 0);
        assert_string_equal(w->variance_shares[0].source, "identified");
        const rotid_map_row *map = &c.speeds.map[8]; /* the stated stiffness, by the linear prediction */
        assert_close(log(map->to_rpm[0] / map->speed_rpm[0]), 1.96 * 0.02, 1e-3, 0);
        assert_close(log(map->from_rpm[0] / map->speed_rpm[0]), -1.96 * 0.02, 1e-3, 0);
        running_case_close(&c);
    }
}

POOL_TEST(draws_end_at_the_bounds_of_the_unknown)
{
    struct running_case c;
    double x = 2e11, std = 0.7 * x, covariance = std * std;
    rotid_fit_result fit = fit_of(&x, &std, &covariance, 0);
    assert_int_equal(running_case_open(pool_format(&test_pool, PINNED, 1.9e11, 2.2e11), 15000, 9, 0, &c), ROTID_OK);
    assert_int_equal(running_case_run(&c, &fit, 15000, 9, 400), ROTID_OK);
    const rotid_critical_speed *w = forward(&c);
    assert_true(w->ci95[0] > w->speed_rpm * sqrt(0.95) && w->ci95[1] < w->speed_rpm * sqrt(1.1));
    assert_true(w->ci95[1] > w->speed_rpm * sqrt(1.08)); /* nearly even between them */
    running_case_close(&c);
}

POOL_TEST(threads_do_not_change_the_draws)
{
    struct running_case c;
    struct message_list notes;
    rotid_speeds speeds;
    struct speeds_options options = {.to = 4000 * RPM, .count = 9, .harmonic = 1, .draws = 100, .seed = 7, .threads = 3};
    assert_int_equal(
        running_case_open(RIGID "*BEARING, STD=0.1\nstart, 1e6, 10\n*BEARING, STD=0.2\nend, 1e6, 10\n", 4000, 9, 0, &c),
        ROTID_OK);
    double first[2] = {0};
    for (int pass = 0; pass < 2; pass++, options.threads = 1) {
        message_open(&notes, &test_pool);
        assert_int_equal(speeds_run(&test_pool, c.machine, c.job, c.x, NULL, &options, NULL, &notes, &speeds), ROTID_OK);
        c.speeds = speeds;
        if (pass)
            assert_memory_equal(first, forward(&c)->ci95, sizeof first);
        memcpy(first, forward(&c)->ci95, sizeof first);
    }
    running_case_close(&c);
}
