/* The machine in operation beside closed forms and beside the first-order form of the full model. */
#include <lapacke.h>

#include "folder.h"
#include "reading.h"
#include "running_case.h"
#include "support.h"

/* Shaft, disk in the middle, pins: a Jeffcott rotor but for 1e-4 of the mass. The stiffness is 48 EI/L^3 with shear. */
#define LIGHT                                                                                                                    \
    "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n0.1\n*SHAFT, NAME=shaft, MATERIAL=s\n0.5, 0.03, 0, 8\n0.5, 0.03, 0, 8\n"  \
    "*RUNNING\n*DISK\n0.5, 20, 1e-9, 1e-9\n*BEARING\nstart, 1e13, 0\n*BEARING\nend, 1e13, 0\n"
#define MASS 20

static double natural(const struct running_case *c)
{
    const rotid_campbell_mode *m = running_case_mode(c, 0, 1);
    assert_non_null(m);
    return 2 * PI * m->frequency_hz / sqrt(1 - m->damping_ratio * m->damping_ratio);
}

POOL_TEST(a_viscous_loss_drives_forward_whirl_from_w0_and_more)
{
    struct running_case c;
    const double external = 100, loss = 2e-4;
    char *deck = pool_format(&test_pool, LIGHT "*BEARING\n0.5, 0, %g\n*LOSS, TYPE=VISCOUS\nshaft, %g\n", external, loss);
    assert_int_equal(running_case_open(deck, 6000, 21, 0, &c), ROTID_OK);
    double w0 = natural(&c), internal = loss * MASS * w0 * w0;
    assert_true(internal > 20 && w0 * (1 + external / internal) < 6000 * RPM);
    assert_close(c.speeds.stability.onset_rpm * RPM, w0 * (1 + external / internal), 2e-4, 0);
    const rotid_campbell_speed *last = &c.speeds.campbell[c.speeds.ncampbell - 1];
    for (int i = 0; i < last->nmodes; i++)
        if (last->modes[i].mode == c.speeds.stability.mode)
            assert_string_equal(last->modes[i].whirl, "forward");
    /* Im lambda = W has the damping of what does not turn alone: c_e/2 m w0 */
    for (int i = 0; i < c.speeds.ncritical_speeds; i++)
        if (!strcmp(c.speeds.critical_speeds[i].whirl, "forward"))
            assert_close(c.speeds.critical_speeds[i].damping_ratio, external / (2 * MASS * w0), 2e-3, 0);
    running_case_close(&c);
}

POOL_TEST(a_loss_factor_drives_it_from_w0_or_never)
{
    struct running_case c;
    const double external = 100;
    for (int grows = 0; grows < 2; grows++) {
        assert_int_equal(running_case_open(LIGHT "*BEARING\n0.5, 0, 100\n", 6000, 13, 0, &c), ROTID_OK);
        double w0 = natural(&c), limit = external * w0 / (MASS * w0 * w0), eta = limit * (grows ? 1.05 : 0.95);
        running_case_close(&c);
        char *deck = pool_format(&test_pool, LIGHT "*BEARING\n0.5, 0, %g\n*LOSS\nshaft, %.17g\n", external, eta);
        assert_int_equal(running_case_open(deck, 6000, 13, 0, &c), ROTID_OK);
        if (grows)
            assert_close(c.speeds.stability.onset_rpm * RPM, w0, 2e-4, 0);
        else
            assert_true(isnan(c.speeds.stability.onset_rpm));
        running_case_close(&c);
    }
}

POOL_TEST(peak_and_critical_speed_of_a_damped_rotor_lie_apart)
{
    struct running_case c;
    assert_int_equal(running_case_open(LIGHT "*BEARING\n0.5, 0, 100\n", 4000, 9, 0, &c), ROTID_OK);
    double w0 = natural(&c), zeta = 0.1;
    running_case_close(&c);
    char *deck = pool_format(&test_pool, LIGHT "*BEARING\n0.5, 0, %.17g\n*UNBALANCE\n0.5, 0.001, 30\n*PROBE, NAME=p\n0.5, 20\n",
                             2 * zeta * MASS * w0);
    assert_int_equal(running_case_open(deck, 4000, 9, 0, &c), ROTID_OK);
    const rotid_critical_speed *first = NULL;
    for (int i = 0; i < c.speeds.ncritical_speeds && !first; i++)
        if (c.speeds.critical_speeds[i].npeaks)
            first = &c.speeds.critical_speeds[i];
    assert_non_null(first);
    assert_close(first->speed_rpm * RPM, w0 * sqrt(1 - zeta * zeta), 1e-4, 0);
    assert_close(first->log_decrement, 2 * 3.14159265358979323846 * zeta / sqrt(1 - zeta * zeta), 1e-3, 0);
    assert_close(first->peaks[0].speed_rpm * RPM, w0 / sqrt(1 - 2 * zeta * zeta), 1e-4, 0);
    assert_close(first->peaks[0].amplitude_m, 0.001 / MASS / (2 * zeta * sqrt(1 - zeta * zeta)), 1e-3, 0);
    /* e r^2/sqrt((1 - r^2)^2 + (2 zeta r)^2) = peak/sqrt 2: with s = 1/r^2, (s - 1)^2 + 4 zeta^2 s = 8 zeta^2 (1 - zeta^2) */
    double half = 1 - 2 * zeta * zeta, root = 2 * zeta * sqrt(1 - zeta * zeta), low = 1 / sqrt(half + root),
           high = 1 / sqrt(half - root);
    assert_close(first->amplification, 1 / sqrt(half) / (high - low), 1e-3, 0);
    /* at any speed lag = atan2(2 zeta r, 1 - r^2) less the phase of the unbalance and more the angle of the probe */
    const rotid_probe_response *p = &c.speeds.unbalance[0];
    for (int i = 0; i < p->nspeed_rpm; i += 17) {
        double r = p->speed_rpm[i] * RPM / w0, lag = atan2(2 * zeta * r, 1 - r * r) * 180 / 3.14159265358979323846 - 30 + 20;
        assert_close(fmod(p->phase_deg[i] - lag + 720 + 180, 360), 180, 0, 0.2);
        assert_close(p->amplitude_m[i], 0.001 / MASS * r * r / hypot(1 - r * r, 2 * zeta * r), 1e-3, 0);
    }
    running_case_close(&c);
}

/* Two excitations per revolution meet a mode at half of its speed. */
POOL_TEST(a_harmonic_is_critical_at_its_share_of_the_speed)
{
    struct running_case c;
    struct message_list notes;
    struct speeds_options options = {.to = 4000 * RPM, .count = 9, .harmonic = 1, .seed = 1, .threads = 1};
    double first[2];
    assert_int_equal(running_case_open(LIGHT "*BEARING\n0.5, 0, 100\n", 4000, 9, 0, &c), ROTID_OK);
    for (int h = 0; h < 2; h++, options.harmonic = 2) {
        message_open(&notes, &test_pool);
        assert_int_equal(speeds_run(&test_pool, c.machine, c.job, c.x, NULL, &options, NULL, &notes, &c.speeds), ROTID_OK);
        assert_true(c.speeds.ncritical_speeds > 0);
        first[h] = c.speeds.critical_speeds[0].speed_rpm;
    }
    assert_close(first[1], first[0] / 2, 1e-4, 0); /* the light shaft has gyroscopic moments of its own */
    running_case_close(&c);
}

/* The unbalance is no excitation of a harmonic: its peak at w0 does not judge the critical speed at w0/1.5. */
POOL_TEST(a_critical_speed_of_a_harmonic_has_no_peak_of_the_unbalance)
{
    struct running_case c;
    struct message_list notes;
    const struct speeds_options options = {.to = 4000 * RPM, .count = 9, .harmonic = 1.5, .seed = 1, .threads = 1};
    message_open(&notes, &test_pool);
    assert_int_equal(running_case_open(LIGHT
                                       "*BEARING\n0.5, 0, 100\n*UNBALANCE\n0.5, 1e-4\n*PROBE, NAME=p\n0.5\n*OPERATION\n100, "
                                       "3000\n",
                                       4000, 9, 0, &c),
                     ROTID_OK);
    assert_int_equal(speeds_run(&test_pool, c.machine, c.job, c.x, NULL, &options, NULL, &notes, &c.speeds), ROTID_OK);
    int judged = 0;
    for (int i = 0; i < c.speeds.ncritical_speeds; i++) {
        const rotid_critical_speed *critical = &c.speeds.critical_speeds[i];
        assert_int_equal(critical->npeaks, 0);
        if (!strcmp(critical->whirl, "backward"))
            continue;
        assert_close(critical->margin.value, speeds_margin(c.machine, critical->speed_rpm * RPM), 1e-12, 0);
        judged++;
    }
    assert_true(judged > 0);
    running_case_close(&c);
}

/* A loss factor acts by w - W: m lambda^2 + c lambda + k (1 + i eta sgn(h - 1)) = 0 of forward whirl at w = h W, sgn 1 of
 * backward. */
POOL_TEST(a_loss_factor_damps_a_critical_speed_of_a_harmonic_by_its_side)
{
    const double harmonic[] = {0.5, 1, 2}, eta = 0.02, damping = 100;
    for (int i = 0; i < 3; i++) {
        struct running_case c;
        struct message_list notes;
        const struct speeds_options options = {.to = 6000 * RPM, .count = 9, .harmonic = harmonic[i], .seed = 1, .threads = 1};
        message_open(&notes, &test_pool);
        assert_int_equal(running_case_open(LIGHT, 4000, 9, 0, &c), ROTID_OK);
        double w = natural(&c);
        running_case_close(&c);
        assert_int_equal(running_case_open(LIGHT "*BEARING\n0.5, 0, 100\n*LOSS\nshaft, 0.02\n", 4000, 9, 0, &c), ROTID_OK);
        assert_int_equal(speeds_run(&test_pool, c.machine, c.job, c.x, NULL, &options, NULL, &notes, &c.speeds), ROTID_OK);
        assert_int_equal(c.speeds.ncritical_speeds, 2);
        for (int j = 0; j < 2; j++) {
            const rotid_critical_speed *critical = &c.speeds.critical_speeds[j];
            int forward = !strcmp(critical->whirl, "forward"), side = forward ? (i > 1) - (i < 1) : 1;
            double complex root =
                (-damping + csqrt(damping * damping - 4 * MASS * MASS * w * w * (1 + I * eta * side))) / (2 * MASS);
            root = cimag(root) < 0 ? -damping / MASS - root : root;
            assert_true(forward || !strcmp(critical->whirl, "backward"));
            assert_close(critical->log_decrement, -2 * PI * creal(root) / cimag(root), 2e-3, 0);
        }
        running_case_close(&c);
    }
}

/* A rigid rotor on two like springs: bounce at 2 k/m, cones at Id w^2 -+ W Ip w - k L^2/2 = 0. */
POOL_TEST(a_rigid_rotor_whirls_as_a_cone_with_its_polar_inertia)
{
    struct running_case c;
    const double k = 1e6, mass = 50, diametral = 2, polar = 3, length = 1;
    assert_int_equal(
        running_case_open("*MATERIAL, NAME=s\n*ELASTIC\n1e12, 0.3\n*DENSITY\n1\n*SHAFT, NAME=a, MATERIAL=s\n0.5, 0.2, "
                          "0, 4\n0.5, 0.2, 0, 4\n*RUNNING\n*DISK\n0.5, 50, 2, 3\n*BEARING\nstart, 1e6, 0\n"
                          "*BEARING\nend, 1e6, 0\n",
                          6000, 7, 0, &c),
        ROTID_OK);
    for (int i = 0; i < 7; i++) {
        const rotid_campbell_speed *at = &c.speeds.campbell[i];
        double w = at->speed_rpm * RPM, stiff = k * length * length / 2,
               own = sqrt(w * w * polar * polar + 4 * diametral * stiff);
        const double bounce = sqrt(2 * k / mass),
                     cone[2] = {(own - w * polar) / 2 / diametral, (own + w * polar) / 2 / diametral};
        int bounces = 0, cones[2] = {0, 0};
        for (int j = 0; j < at->nmodes; j++) {
            double f = 2 * 3.14159265358979323846 * at->modes[j].frequency_hz;
            bounces += fabs(f / bounce - 1) < 1e-3;
            cones[0] += fabs(f / cone[0] - 1) < 2e-3 && (!i || !strcmp(at->modes[j].whirl, "backward"));
            cones[1] += fabs(f / cone[1] - 1) < 2e-3 && (!i || !strcmp(at->modes[j].whirl, "forward"));
        }
        assert_true(bounces >= 2 && cones[0] >= 1 && cones[1] >= 1);
    }
    /* Ip > Id: the forward cone is never met; the backward one at (Id + Ip) w^2 = k L^2/2 */
    int met = 0;
    for (int i = 0; i < c.speeds.ncritical_speeds; i++)
        met += fabs(c.speeds.critical_speeds[i].speed_rpm * RPM / sqrt(k * length * length / 2 / (diametral + polar)) - 1) < 2e-3;
    assert_int_equal(met, 1);
    assert_int_equal(c.speeds.ncritical_speeds, 3);
    running_case_close(&c);
}

static int rising(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* A rigid rotor on soft springs, kx and ky, far below the highest speed, looked at in steps of 4000 rpm: bounce at 2 kx/m and 2
 * ky/m, cones where (kx L^2/2 - Id W^2)(ky L^2/2 - Id W^2) = Ip^2 W^4. Each once, whatever the steps. */
POOL_TEST(critical_speeds_far_below_the_first_step_are_found_once)
{
    const double mass = 50, diametral = 2, polar = 1, k[2] = {2e3, 5e3};
    double cone[2] = {k[0] / 2, k[1] / 2}, a = diametral * diametral - polar * polar, b = diametral * (cone[0] + cone[1]),
           root = sqrt(b * b - 4 * a * cone[0] * cone[1]),
           expected[4] = {sqrt(2 * k[0] / mass), sqrt(2 * k[1] / mass), sqrt((b - root) / (2 * a)), sqrt((b + root) / (2 * a))};
    qsort(expected, 4, sizeof *expected, rising);
    for (int count = 2; count <= 101; count += 33) {
        struct running_case c;
        assert_int_equal(
            running_case_open("*MATERIAL, NAME=s\n*ELASTIC\n1e13, 0.3\n*DENSITY\n1e-3\n*SHAFT, NAME=a, MATERIAL=s\n0.5, 0.2, "
                              "0, 2\n0.5, 0.2, 0, 2\n*RUNNING\n*DISK\n0.5, 50, 2, 1\n*BEARING\nstart, 2e3, 5e3, 0, 0\n"
                              "*BEARING\nend, 2e3, 5e3, 0, 0\n",
                              20000, count, 0, &c),
            ROTID_OK);
        assert_int_equal(c.speeds.ncritical_speeds, 4);
        for (int i = 0; i < 4; i++)
            assert_close(c.speeds.critical_speeds[i].speed_rpm * RPM, expected[i], 1e-4, 0);
        running_case_close(&c);
    }
}

/* Loci cross between two steps of a coarse diagram: a slender shaft with two disks on soft bearings, one of them of two
 * stiffnesses, and a drum on a bearing that stiffens with the speed. */
POOL_TEST(critical_speeds_are_those_of_a_finer_diagram)
{
    const char *path = folder_write("drum.csv", "speed_rpm,kxx,kyy,cxx,cyy\n0,154888,154888,28.2645,28.2645\n"
                                                "9149.5,2.01097e7,2.01097e7,28.2645,28.2645\n"
                                                "24277.9,9.58024e7,9.58024e7,28.2645,28.2645\n");
    const char *deck[] = {
        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n0.79, 0.03775, 0, 6\n*RUNNING\n"
        "*DISK\n0.76, 98.39, 0.02984, 0.229\n0.695, 21, 0.01276, 31.47\n*BEARING\n0.1395, 60151, 60151, 22, 22\n*BEARING\n"
        "0.6579, 48042, 87108, 0, 0\n*LOSS\na, 0.01\n",
        pool_format(&test_pool,
                    "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1.94085, 0.175535, 0, "
                    "20\n*RUNNING\n*BEARING, FILE=%s\n0.0917114\n*BEARING\n1.47385, 1.08872e8, 1.08872e8, 1644.43, 28169.7\n",
                    path)};
    for (int i = 0; i < 2; i++) {
        struct running_case coarse, fine;
        assert_int_equal(running_case_open(deck[i], i ? 25000 : 20000, 6, 0, &coarse), ROTID_OK);
        assert_int_equal(running_case_open(deck[i], i ? 25000 : 20000, 301, 0, &fine), ROTID_OK);
        assert_int_equal(coarse.speeds.ncampbell, 6);
        assert_int_equal(coarse.speeds.ncritical_speeds, fine.speeds.ncritical_speeds);
        for (int j = 0; j < coarse.speeds.ncritical_speeds; j++)
            assert_close(coarse.speeds.critical_speeds[j].speed_rpm, fine.speeds.critical_speeds[j].speed_rpm, 1e-8, 0);
        running_case_close(&fine);
        running_case_close(&coarse);
    }
}

/* Bearings whose stiffnesses of two directions, coupled a little, exchange their places between two rows of a table. */
struct exchange {
    const char *table;
    double row[2]; /* rpm */
    double kxx[2], kxy, kyy[2];
    int expected;
};

/* Frequency less speed [rpm] of the lower or the upper bounce of a mass on two of them. */
static double bounce(const struct exchange *e, double mass, int upper, double rpm)
{
    double t = fmin(1, fmax(0, (rpm - e->row[0]) / (e->row[1] - e->row[0])));
    double x = e->kxx[0] + t * (e->kxx[1] - e->kxx[0]), y = e->kyy[0] + t * (e->kyy[1] - e->kyy[0]);
    double k = (x + y) / 2 + (upper ? 1 : -1) * hypot((x - y) / 2, e->kxy);
    return sqrt(2 * k / mass) / RPM - rpm;
}

/* A stiff rotor on them: frequencies of its bounce in closed form. Between the rows loci veer, and one falls below the speed and
 * rises above it again: each crossing is found. */
/* Speeds that differ in the last digit, below standstill, or below what the doubles hold shares of. */
POOL_TEST(speeds_that_are_nearly_one_are_all_there)
{
    static const double ranges[][2] = {{5000, 5000.000000000001}, {0, 9.9e-321}};
    rotid_deck *deck = read_handle(LIGHT, 0, NULL);
    for (int i = 0; i < 2; i++) {
        const rotid_speeds_options options = {
            .size = sizeof options, .from_rpm = ranges[i][0], .to_rpm = ranges[i][1], .count = 41, .draws = -1};
        rotid_speeds *s;
        assert_status(rotid_speeds_compute(deck, &options, NULL, NULL, &s), ROTID_OK);
        assert_int_equal(s->ncampbell, 41);
        for (int k = 0; k < s->ncampbell; k++) {
            assert_true(s->campbell[k].nmodes >= 2);
            assert_close(s->campbell[k].modes[0].frequency_hz, s->campbell[0].modes[0].frequency_hz, 1e-9, 0);
        }
        rotid_speeds_free(s);
    }
    rotid_deck_free(deck);
}

POOL_TEST(critical_speeds_between_rows_of_a_table_are_those_of_the_closed_form)
{
    const struct exchange all[] = {
        {"exchange.csv", {4000, 4600}, {6.02062e6, 4.82734e6}, 101383, {4.82734e6, 6.02062e6}, 2},
        {"veering.csv", {3910, 4430}, {5.34887e6, 4.37635e6}, 26220, {4.37635e6, 5.34887e6}, 2},
        {"steep.csv", {6340, 6660}, {1.27599e7, 1.08696e7}, 46332.3, {1.08696e7, 1.27599e7}, 4},
    };
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) {
        struct running_case c;
        char deck[512];
        int count = 0;
        (void)snprintf(deck, sizeof deck,
                       "*MATERIAL, NAME=s\n*ELASTIC\n1e14, 0.3\n*DENSITY\n1e-3\n*SHAFT, NAME=a, MATERIAL=s\n0.5, 0.2, 0, 2\n0.5, "
                       "0.2, 0, 2\n*RUNNING\n*DISK\n0.5, 50, 1e-3, 1e-3\n*BEARING, FILE=tests/data/running/%s\nstart\n*BEARING, "
                       "FILE=tests/data/running/%s\nend\n",
                       all[n].table, all[n].table);
        assert_int_equal(running_case_open(deck, 10000, 41, 0, &c), ROTID_OK);
        assert_int_equal(c.speeds.ncritical_speeds, all[n].expected);
        for (int i = 1; i < 200000; i++)
            for (int upper = 0; upper < 2; upper++) {
                double below = bounce(&all[n], 50, upper, 0.05 * i), above = bounce(&all[n], 50, upper, 0.05 * (i + 1));
                if (below * above > 0)
                    continue;
                assert_true(count < all[n].expected);
                assert_close(c.speeds.critical_speeds[count++].speed_rpm, 0.05 * i, 2e-4, 0);
            }
        assert_int_equal(count, all[n].expected);
        running_case_close(&c);
    }
}

/* A mass of 50 kg in the middle of a stiff shaft without one, on two bearings by a table. */
static const char *mass_between(const char *table)
{
    return pool_format(&test_pool,
                       "*MATERIAL, NAME=s\n*ELASTIC\n1e14, 0.3\n*DENSITY\n1e-3\n*SHAFT, NAME=a, MATERIAL=s\n0.5, "
                       "0.2, 0, 2\n0.5, 0.2, 0, 2\n*RUNNING\n*DISK\n0.5, 50, 1e-3, 1e-3\n*BEARING, FILE=%s\nstart\n"
                       "*BEARING, FILE=%s\nend\n",
                       table, table);
}

/* Bearings that stiffen with the speed between two rows as 2k = f m ((a + b) W - a b): with f = 1 a mass on them alone has its
 * bounce above W from a to b and below it on either side. With the shaft, 1/(48 E I/L^3) + L/(4 kappa G A) softer, the places
 * move; each is critical twice, backward and forward, however near they are to each other, and once however the diagram is
 * sampled. */
POOL_TEST(a_mode_that_rides_along_the_speed_is_critical_where_it_comes_and_where_it_goes)
{
    static const double turn[][3] = {{5980, 6020, 1}, {6020, 6200, 1}, {5780, 5820, 1.0002}, {6080, 6120, 1.00007}};
    static const int speeds[] = {2, 17, 53, 80, 97, 313};
    const double row[2] = {4000, 14000}, m = 50, e = 1e14, area = 3.14159265358979323846 * 0.01, inertia = area * 0.01 / 4;
    const double kappa = 6 * 1.3 / (7 + 6 * 0.3), shaft = 1 / (1 / (48 * e * inertia) + 1 / (4 * kappa * e / 2.6 * area));
    for (size_t n = 0; n < sizeof turn / sizeof *turn; n++) {
        double a = turn[n][0] * RPM, b = turn[n][1] * RPM, k[2], expected[3], before = 1;
        int count = 0;
        for (int i = 0; i < 2; i++)
            k[i] = turn[n][2] * m * ((a + b) * row[i] * RPM - a * b) / 2;
        for (double rpm = 500; rpm < 15600; rpm += 0.05) {
            double film = 2 * (k[0] + (k[1] - k[0]) * fmax(0, fmin(1, (rpm - row[0]) / (row[1] - row[0]))));
            double above = film * shaft / (film + shaft) / m - rpm * RPM * rpm * RPM;
            if (above * before < 0)
                expected[count++] = rpm;
            before = above;
        }
        assert_int_equal(count, n ? 3 : 1);
        const char *path = folder_write("ride.csv", pool_format(&test_pool,
                                                                "speed_rpm,kxx,kyy,cxx,cyy\n%.17g,%.17g,%.17g,1,1\n"
                                                                "%.17g,%.17g,%.17g,1,1\n",
                                                                row[0], k[0], k[0], row[1], k[1], k[1]));
        for (size_t j = 0; j < sizeof speeds / sizeof *speeds; j++) {
            struct running_case c;
            assert_int_equal(running_case_open(mass_between(path), 15600, speeds[j], 0, &c), ROTID_OK);
            assert_int_equal(c.speeds.ncritical_speeds, 2 * count);
            for (int i = 0; i < 2 * count; i++) {
                const rotid_critical_speed *one = &c.speeds.critical_speeds[i], *other = &c.speeds.critical_speeds[i ^ 1];
                assert_close(one->speed_rpm, expected[i / 2], 1e-4, 0);
                assert_string_equal(one->whirl, strcmp(other->whirl, "forward") ? "forward" : "backward");
            }
            running_case_close(&c);
        }
    }
}

/* Overdamped at standstill and at the highest speed, there between 2,500 and 8,000 rpm: Im lambda = sqrt(k/m - (c/m)^2), c that
 * of one bearing, rises from 0 through the speed before the second row, and the speed comes to it behind. */
POOL_TEST(a_mode_that_is_overdamped_at_both_ends_is_critical_between)
{
    const double k = 6e6, m = 50, row[2] = {0, 2500}, damping[2] = {1e6, 10};
    const char *path = folder_write("both.csv", "speed_rpm,kxx,kyy,cxx,cyy\n0,3e6,3e6,1e6,1e6\n2500,3e6,3e6,10,10\n"
                                                "8000,3e6,3e6,10,10\n12000,3e6,3e6,1e6,1e6\n");
    double low = row[0], high = row[1];
    struct running_case c;
    while (high - low > 1e-7) {
        double rpm = (low + high) / 2, own = damping[0] + (damping[1] - damping[0]) * (rpm - row[0]) / (row[1] - row[0]),
               square = k / m - own / m * own / m;
        *(square > rpm * RPM * rpm * RPM ? &high : &low) = rpm;
    }
    const double expected[2] = {low, sqrt(k / m) / RPM};
    for (int count = 2; count < 100; count += 49) {
        assert_int_equal(running_case_open(mass_between(path), 15000, count, 0, &c), ROTID_OK);
        assert_int_equal(c.speeds.ncritical_speeds, 4);
        for (int i = 0; i < 4; i++)
            assert_close(c.speeds.critical_speeds[i].speed_rpm, expected[i / 2], 1e-4, 0);
        running_case_close(&c);
    }
}

/* Two modes that rise through the speed between the same two rows, where a long step of one goes on to the other. Reference: the
 * eigenvalues of elements of a program of its own in numpy. */
POOL_TEST(two_modes_that_cross_between_the_same_speeds_are_both_found)
{
    const char *one = folder_write("one.csv", "speed_rpm,kxx,kxy,kyx,kyy,cxx,cxy,cyx,cyy\n"
                                              "18837.77,7382329.8,1547721,-1547721,9581981,635.2304,0,0,635.2304\n"
                                              "18936.8592,965557666,123540736,-123540736,1415956110,173.4515,0,0,173.4515\n"
                                              "21600.2605,14990857.7,546174.46,-546174.46,10579941,4053.753,0,0,4053.753\n"
                                              "38172.0813,94053722.6,20890438,-20890438,183994888,1298.679,0,0,1298.679\n"),
               *other = folder_write("other.csv", "speed_rpm,kxx,kxy,kyx,kyy,cxx,cxy,cyx,cyy\n"
                                                  "17560.5388,442102560,51395940,-51395940,685503830,10137.33,0,0,10137.33\n"
                                                  "18901.1453,382948609,77410632,-77410632,239248174,30739.93,0,0,30739.93\n"
                                                  "28125.8085,5709640.8,39835.158,-39835.158,5728940.4,904.1867,0,0,904.1867\n"
                                                  "32218.1498,957716750,63575318,-63575318,1213213923,5020.132,0,0,5020.132\n");
    const char *deck = pool_format(
        &test_pool,
        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n0.495, 0.078, 0, 7\n0.402, "
        "0.035, 0, 4\n0.347, 0.098, 0, 5\n*RUNNING\n*DISK\n0, 9.19, 0.01003028, 0.01892568\n*DISK\n0.346, 2.08, 0.001707413, "
        "0.003476678\n*DISK\n0, 36.89, 0.7701974, 1.01797539\n*BEARING, FILE=%s\n0.488\n*BEARING, FILE=%s\n1.126\n",
        one, other);
    static const double to[] = {35000, 40000};
    for (int i = 0; i < 2; i++) {
        struct running_case c;
        double found[3];
        int count = 0;
        assert_int_equal(running_case_open(deck, to[i], 2, 0, &c), ROTID_OK);
        for (int j = 0; j < c.speeds.ncritical_speeds && count < 3; j++)
            if (c.speeds.critical_speeds[j].speed_rpm > 26000 && c.speeds.critical_speeds[j].speed_rpm < 30000)
                found[count++] = c.speeds.critical_speeds[j].speed_rpm;
        assert_int_equal(count, 2);
        assert_close(found[0], 28596.1, 2e-4, 0);
        assert_close(found[1], 28712.9, 2e-4, 0);
        running_case_close(&c);
    }
}

/* Between rows of a table whose damping rises beyond critical Im lambda = sqrt(k/m - (c/2m)^2) falls from above the speed to 0,
 * and comes back. Both ends of such a row are speeds of the diagram, and at one of them there is no mode. */
POOL_TEST(a_mode_that_is_overdamped_at_the_next_row_has_crossed_the_speed)
{
    static const double rows[6] = {0, 3000, 3100, 3150, 3200, 9000}, damping[6] = {10, 10, 1e6, 1e6, 10, 10};
    const double k = 6e6, m = 50;
    char *table = pool_format(&test_pool, "speed_rpm,kxx,kyy,cxx,cyy\n");
    for (int i = 0; i < 6; i++)
        table = pool_format(&test_pool, "%s%g,3e6,3e6,%g,%g\n", table, rows[i], damping[i], damping[i]);
    const char *path = folder_write("fall.csv", table);
    const char *deck = mass_between(path);
    struct running_case c;
    int count = 0;
    double before = 1;
    assert_int_equal(running_case_open(deck, 6000, 41, 0, &c), ROTID_OK);
    for (int i = 1; i < 600000; i++) { /* steps of 0.01 rpm */
        double rpm = 0.01 * i, w = rpm * PI / 30, each = damping[0];
        for (int r = 0; r < 5; r++)
            if (rpm >= rows[r] && rpm <= rows[r + 1])
                each = damping[r] + (damping[r + 1] - damping[r]) * (rpm - rows[r]) / (rows[r + 1] - rows[r]);
        double now = k / m - each * each / (m * m) - w * w; /* c/2m of two bearings */
        for (int whirl = 0; whirl < 2 && now * before < 0; whirl++) {
            assert_true(count < c.speeds.ncritical_speeds);
            assert_close(c.speeds.critical_speeds[count++].speed_rpm, rpm, 5e-5, 0);
        }
        before = now;
    }
    assert_int_equal(count, 6);
    assert_int_equal(c.speeds.ncritical_speeds, 6);
    running_case_close(&c);
}

/* Oil that damps beyond whirl at low speeds: Im lambda = sqrt(k/m - (c/2m)^2) is none at standstill and above the speed at the
 * highest one. */
POOL_TEST(a_mode_that_is_overdamped_at_standstill_has_crossed_the_speed)
{
    const char *path = folder_write("rise.csv", "speed_rpm,kxx,kyy,cxx,cyy\n0,3e6,3e6,5e4,5e4\n3000,3e6,3e6,10,10\n");
    const char *deck = mass_between(path);
    struct running_case c;
    assert_int_equal(running_case_open(deck, 3200, 41, 0, &c), ROTID_OK);
    assert_int_equal(c.speeds.ncritical_speeds, 2);
    for (int i = 0; i < 2; i++) {
        double rpm = c.speeds.critical_speeds[i].speed_rpm, w = rpm * RPM, decay = (5e4 + (10 - 5e4) * rpm / 3000) / 50;
        assert_close(decay * decay + w * w, 6e6 / 50, 1e-4, 0);
        assert_close(running_case_mode(&c, 3200, i + 1)->frequency_hz, sqrt(6e6 / 50) / (2 * PI), 1e-4, 0);
    }
    running_case_close(&c);
}

/* A loss factor makes Im lambda jump where it crosses the speed: what is called critical lies between, side 0. */
POOL_TEST(a_jump_at_a_critical_speed_hides_none)
{
    const char *deck =
        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1.16756, 0.193758, 0, 6\n1.16756, "
        "0.165926, 0, 6\n1.16756, 0.160297, 0, 6\n*RUNNING\n*BEARING, NAME=b0\n1.63375, 855800, 855800, 0, 0\n*PEDESTAL, "
        "BEARING=b0\n196.375, 14.1673, 2.24159e+08, 4.04729e+07\n*BEARING, NAME=b1\n2.96963, 6.26429e+07, 1.47698e+08, 249306, "
        "587808\n*PEDESTAL, BEARING=b1\n1.37719, 1.59502, 9.70873e+07, 4.48499e+07\n*LOSS\na, 0.01\n";
    struct running_case coarse, fine;
    assert_int_equal(running_case_open(deck, 20000, 6, 0, &coarse), ROTID_OK);
    assert_int_equal(running_case_open(deck, 20000, 301, 0, &fine), ROTID_OK);
    assert_int_equal(coarse.speeds.ncritical_speeds, fine.speeds.ncritical_speeds);
    for (int i = 0; i < coarse.speeds.ncritical_speeds; i++)
        assert_close(coarse.speeds.critical_speeds[i].speed_rpm, fine.speeds.critical_speeds[i].speed_rpm, 1e-8, 0);
    running_case_close(&fine);
    running_case_close(&coarse);
}

/* The onset does not depend on the range: within the lower one the mode that grows, at 420 Hz, lies above those that are
 * followed, in the higher one it is followed from standstill. */
POOL_TEST(a_mode_above_those_that_are_followed_grows)
{
    const char *table = folder_write(
        "growing.csv",
        "speed_rpm,kxx,kxy,kyx,kyy,cxx,cxy,cyx,cyy\n4000,1.26e8,2.1e6,-3.2e7,3.76e8,2460,425,279,2450\n5000,1.5e8,2.4e6,"
        "-9e7,2.33e8,2070,236,435,2310\n");
    const char *deck = pool_format(
        &test_pool,
        "*MATERIAL, NAME=s\n*ELASTIC, TYPE=SHEAR\n1.81e11, 1.18e10, 0.23\n*DENSITY\n6187\n*SHAFT, NAME=a, MATERIAL=s\n0.546, "
        "0.0667, 0, 6\n0.365, 0.0761, 0, 3\n0.211, 0.141, 0, 8\n0.349, 0.0539, 0, 5\n*SPRING\n1.4, 2.8e7\n*RUNNING\n*DISK\n1.19, "
        "11.4, 0.3, 0.475\n*DISK\n1.04, 55.7, 0.688, 1.17\n*BEARING, NAME=b1\n0.79, 2e8, 1e5\n*PEDESTAL, BEARING=b1\n62, 194, "
        "1.73e7, 3.89e8, 9683, 12330\n*BEARING, NAME=b2\n0.94, 5.24e6, 1.77e6, -1.69e6, 1.72e8, 37000, 740, 550, 1.58e5\n"
        "*PEDESTAL, BEARING=b2\n59, 290, 2.87e8, 7.26e7, 0, 4740\n*BEARING, FILE=%s\n1.19\n",
        table);
    struct running_case low, high;
    assert_int_equal(running_case_open(deck, 4760, 41, 0, &low), ROTID_OK);
    assert_int_equal(running_case_open(deck, 25000, 41, 0, &high), ROTID_OK);
    assert_true(low.speeds.stability.mode > 6 && high.speeds.stability.mode > 6);
    assert_in_range(high.speeds.stability.onset_rpm, 4300, 4500);
    assert_close(low.speeds.stability.onset_rpm, high.speeds.stability.onset_rpm, 1e-7, 0);
    running_case_close(&low);
    running_case_close(&high);
}

/* Nor where that mode lies in the upper half of the basis that the range asks for: a seal on a light pedestal drives a mode at
 * 1573 Hz below 6000 rpm, as an independent model of 160 elements has it, with a log decrement of -0.0026 at 1000 rpm. */
POOL_TEST(a_mode_beyond_the_basis_grows)
{
    const double to[] = {4000, 30000, 60000};
    for (int i = 0; i < 3; i++) {
        struct running_case c;
        assert_int_equal(
            running_case_open(
                "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n4, 0.1, 0, "
                "80\n*RUNNING\n*BEARING\n0, 8e7, 2e5\n*BEARING\n4, 8e7, 2e5\n*BEARING, NAME=seal\n2, 1e9, 1e8, -1e8, "
                "1e9, 0, 0, 0, 0\n*PEDESTAL, BEARING=seal\n30, 30, 5e8, 5e8\n*OPERATION\n1000, 3000\n",
                to[i], 11, 0, &c),
            ROTID_OK);
        assert_true(c.speeds.stability.onset_rpm < 1);
        const rotid_campbell_speed *slow = &c.speeds.campbell[1];
        int found = 0;
        for (int m = 0; m < slow->nmodes; m++)
            found |= slow->modes[m].mode == c.speeds.stability.mode && slow->modes[m].damping_ratio < 0 &&
                     fabs(slow->modes[m].frequency_hz - 1573) < 30;
        assert_true(found);
        running_case_close(&c);
    }
}

/* Two springs of stiffness k(W) that fall with the speed hold a stiff rotor while 2 k is above the pull; coefficients whose
 * symmetric part is indefinite never hold one. */
POOL_TEST(what_moves_away_without_whirl_is_unstable)
{
    const char
        *table = folder_write("falling.csv", "speed_rpm,kxx,kyy,cxx,cyy\n0,2e6,2e6,1e2,1e2\n10000,1e6,1e6,1e2,1e2\n"),
        *rotor = "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n0.5, 0.2, 0, 8\n*RUNNING\n";
    struct running_case c;
    const char *deck = pool_format(
        &test_pool, "%s*BEARING, FILE=%s\nstart\n*BEARING, FILE=%s\nend\n*PULL, GROUP=a\n3e6\n*OPERATION\n1000, 7000\n", rotor,
        table, table);
    assert_int_equal(running_case_open(deck, 9000, 41, 0, &c), ROTID_OK);
    assert_close(c.speeds.stability.onset_rpm, 5000, 1e-4, 0);
    assert_int_equal(c.speeds.stability.mode, ROTID_NONE);
    running_case_close(&c);
    deck = pool_format(&test_pool,
                       "%s*BEARING\nstart, 1e6, 2e6, 2e6, 1e6, 1e3, 0, 0, 1e3\n*BEARING\nend, 1e6, 2e6, 2e6, 1e6, 1e3, 0, 0, "
                       "1e3\n",
                       rotor);
    assert_int_equal(running_case_open(deck, 9000, 41, 0, &c), ROTID_OK);
    assert_true(c.speeds.stability.onset_rpm < 1);
    assert_int_equal(c.speeds.stability.mode, ROTID_NONE);
    running_case_close(&c);
}

POOL_TEST(kxy_above_kyx_drives_forward_whirl)
{
    struct running_case c;
    for (int sign = -1; sign <= 1; sign += 2) {
        char *deck = pool_format(&test_pool, LIGHT "*BEARING\n0.5, 0, %g, %g, 0, 0, 0, 0, 0\n", sign * 1e4, -sign * 1e4);
        assert_int_equal(running_case_open(deck, 4000, 5, 0, &c), ROTID_OK);
        const rotid_campbell_speed *at = &c.speeds.campbell[2];
        int growing = 0;
        for (int i = 0; i < 2; i++)
            if (at->modes[i].damping_ratio < -1e-6) {
                assert_string_equal(at->modes[i].whirl, sign > 0 ? "forward" : "backward");
                growing++;
            }
        assert_int_equal(growing, 1);
        running_case_close(&c);
    }
}

/* ---- the first-order form of the full model, by LAPACK, in place of basis, iteration and tracking */

static const char general[] =
    "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*MATERIAL, NAME=l\n*ELASTIC, TYPE=SHEAR\n1.1e11, 3e10, "
    "0.28\n*DENSITY\n7600\n"
    "*SHAFT, NAME=left, MATERIAL=s\n0.3, 0.10, 0, 12\n0.2, 0.16, 0.02, 8\n*SHAFT, NAME=core, MATERIAL=l\n0.7, 0.30, 0, 20\n"
    "*SHAFT, NAME=right, MATERIAL=s\n0.4, 0.11, 0, 14\n*TIEROD, NAME=t, MATERIAL=s, FROM=core.start, TO=core.end, MODEL=RODS\n"
    "8, 0.02, 0.11, 1e5, 1\n*SPRING, NAME=sling\nstart, 1e4\n*SENSORS\n1, 0.1\n2, 0.6\n3, 1.1\n4, 1.5\n"
    "*RUNNING\n*DISK\nend, 12, 0.1, 0.18\n*BEARING, NAME=a\n0.15, 8e7, 2e7, -1e7, 6e7, 3e4, -2e3, 1e3, 2.5e4\n"
    "*BEARING, NAME=b\n1.5, 9e7, 7e7, 2e4, 3e4\n*PEDESTAL, BEARING=b\n150, 200, 6e8, 4e8, 1e4, 2e4\n*PULL, GROUP=core\n1e7\n"
    "*LOSS, TYPE=VISCOUS\ncore, 2e-6\n";

static void add(const rotid_matrix *a, double factor, int n, int size, int row, int column, double *to)
{
    double *full = POOL_ARRAY(&test_pool, double, (size_t)n *(size_t)n);
    matrix_to_dense(a, n, full);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            to[row + i + (ptrdiff_t)size * (column + j)] += factor * full[i + (ptrdiff_t)n * j];
}

/* A full model of `system` at W: order x, y of the rotor, then x, y of the pedestal. */
static void full_pairs(const struct running_case *c, double w, double complex *lambda, int *count)
{
    struct machine_values values;
    struct rotor rotor;
    struct discrete discrete;
    rotid_matrix s, k, m, p, pull, loss, none;
    int failed;
    const struct parameter parameter[] = {{.kind = PARAMETER_E, .index = 1}, {.kind = PARAMETER_G, .index = 1}};
    const double x[] = {1.1e11, 3e10};
    assert_int_equal(machine_nominal(&test_pool, c->machine, c->x, &values), ROTID_OK);
    assert_int_equal(machine_rotor(&test_pool, c->machine, c->job, &values, &rotor), ROTID_OK);
    assert_int_equal(discrete_build(&test_pool, AS_BEAM, &rotor, 2, parameter, 1, &discrete, &failed), ROTID_OK);
    discrete_structure(&discrete, &s);
    rotid_matrix *const all[] = {&k, &m, &p, &pull, &loss, &none};
    for (int i = 0; i < 6; i++)
        assert_int_equal(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, all[i]), ROTID_OK);
    discrete_assemble(&discrete, x, &k, &m);
    discrete_gyroscopic(&discrete, &p);
    discrete_spread(&discrete, 1, 1e7, &pull);
    for (int i = 0; i < 2; i++) {
        rotid_matrix one;
        int from, end;
        assert_int_equal(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, &one), ROTID_OK);
        discrete_differentiate(&discrete, i, &one, &none, &from, &end);
        matrix_combine(1, &loss, x[i], &one, &loss);
    }
    int n = s.n, size = 2 * n + 2, two = 2 * size;
    size_t square = (size_t)size * (size_t)size;
    double *kk = POOL_ARRAY(&test_pool, double, square), *cc = POOL_ARRAY(&test_pool, double, square),
           *mm = POOL_ARRAY(&test_pool, double, square);
    for (int plane = 0; plane < 2; plane++) {
        add(&k, 1, n, size, plane * n, plane * n, kk);
        add(&pull, -1, n, size, plane * n, plane * n, kk);
        add(&m, 1, n, size, plane * n, plane * n, mm);
        add(&loss, 2e-6, n, size, plane * n, plane * n, cc);
        add(&p, plane ? -w : w, n, size, plane * n, (1 - plane) * n, cc);
        add(&loss, (plane ? -w : w) * 2e-6, n, size, plane * n, (1 - plane) * n, kk);
    }
    int a = 2 * discrete.beam.mesh.spring_node[1], b = 2 * discrete.beam.mesh.spring_node[2];
    const int at_a[2] = {a, n + a}, at_b[4] = {b, n + b, 2 * n, 2 * n + 1};
    const double ka[4] = {8e7, 2e7, -1e7, 6e7}, ca[4] = {3e4, -2e3, 1e3, 2.5e4}, kb[2] = {9e7, 7e7}, cb[2] = {2e4, 3e4},
                 kp[2] = {6e8, 4e8}, cp[2] = {1e4, 2e4}, mp[2] = {150, 200};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            kk[at_a[i] + (ptrdiff_t)size * at_a[j]] += ka[2 * i + j];
            cc[at_a[i] + (ptrdiff_t)size * at_a[j]] += ca[2 * i + j];
        }
        for (int r = 0; r < 2; r++)
            for (int col = 0; col < 2; col++) {
                ptrdiff_t at = at_b[i + 2 * r] + (ptrdiff_t)size * at_b[i + 2 * col];
                kk[at] += (r == col ? 1 : -1) * kb[i] + (r && col ? kp[i] : 0);
                cc[at] += (r == col ? 1 : -1) * cb[i] + (r && col ? cp[i] : 0);
            }
        mm[at_b[2 + i] + (ptrdiff_t)size * at_b[2 + i]] = mp[i];
    }
    double *first = POOL_ARRAY(&test_pool, double, 4 * square), *second = POOL_ARRAY(&test_pool, double, 4 * square),
           *re = POOL_ARRAY(&test_pool, double, 3 * (size_t)two), *im = re + two, *beta = im + two;
    double rate = 1000; /* time in units of 1/rate: one size of the blocks */
    for (int j = 0; j < size; j++) {
        first[j + (ptrdiff_t)two * (size + j)] = second[j + (ptrdiff_t)two * j] = 1;
        for (int i = 0; i < size; i++) {
            first[size + i + (ptrdiff_t)two * j] = -kk[i + (ptrdiff_t)size * j] / rate / rate;
            first[size + i + (ptrdiff_t)two * (size + j)] = -cc[i + (ptrdiff_t)size * j] / rate;
            second[size + i + (ptrdiff_t)two * (size + j)] = mm[i + (ptrdiff_t)size * j];
        }
    }
    assert_int_equal(LAPACKE_dggev(LAPACK_COL_MAJOR, 'N', 'N', two, first, two, second, two, re, im, beta, NULL, 1, NULL, 1), 0);
    *count = 0;
    for (int i = 0; i < two; i++)
        if (im[i] > 1e-6 * hypot(re[i], im[i]) && fabs(beta[i]) > 0)
            lambda[(*count)++] = rate * (re[i] + I * im[i]) / beta[i];
}

POOL_TEST(all_pairs_are_those_of_the_full_model)
{
    struct running_case c;
    assert_int_equal(running_case_open(general, 15000, 31, 0, &c), ROTID_OK);
    assert_true(c.speeds.basis_error < 1e-8);
    double complex *lambda = POOL_ARRAY(&test_pool, double complex, 2000);
    for (int i = 0; i < 31; i += 15) {
        const rotid_campbell_speed *at = &c.speeds.campbell[i];
        double w = at->speed_rpm * RPM;
        int count, compared = 0;
        full_pairs(&c, w, lambda, &count);
        for (int j = 0; j < count; j++) {
            double hz = cimag(lambda[j]) / 2 / 3.14159265358979323846, ratio = -creal(lambda[j]) / cabs(lambda[j]),
                   nearest = INFINITY;
            if (hz > 15000 / 60.0 || ratio > 0.9)
                continue;
            for (int m = 0; m < at->nmodes; m++)
                nearest = fmin(nearest, hypot(at->modes[m].frequency_hz / hz - 1, at->modes[m].damping_ratio - ratio));
            assert_close(nearest, 0, 0, 2e-8);
            compared++;
        }
        assert_true(compared >= 4);
    }
    running_case_close(&c);
}

/* Dashpots and a loss far beyond critical damping leave pairs that a basis of modes does not tell. */
POOL_TEST(what_is_damped_beyond_whirl_is_no_mode)
{
    struct running_case c;
    const char *deck = pool_format(&test_pool,
                                   "%.*s*BEARING, NAME=a\n0.15, 8e7, 8e7, 3e7, 2e7\n*BEARING, NAME=b\n1.5, 9e7, 7e7, "
                                   "2e7, 3e7\n*LOSS, TYPE=VISCOUS\ncore, 1e-2\n",
                                   (int)(strstr(general, "*BEARING") - general), general);
    assert_int_equal(running_case_open(deck, 15000, 5, 0, &c), ROTID_OK);
    for (int i = 0; i < c.speeds.ncampbell; i++)
        for (int m = 0; m < c.speeds.campbell[i].nmodes; m++)
            assert_true(c.speeds.campbell[i].modes[m].damping_ratio < 0.999);
    running_case_close(&c);
}

/* A distributed unbalance is one load on the basis, and its response the sum of those of its parts. */
POOL_TEST(unbalance_in_many_planes_is_one_load)
{
    double complex motion[3];
    for (int part = 0; part < 3; part++) { /* the left half, the right half, both */
        struct running_case c;
        struct machine_values values;
        struct system system;
        const struct basis_size basis = {14, 10, 1};
        int failed;
        char *deck = pool_copy_text(&test_pool,
                                    "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1, "
                                    "0.1, 0, 50\n*RUNNING\n*BEARING\nstart, 1e8, 1e4\n*BEARING\nend, 1e8, 1e4\n*PROBE, NAME=p\n"
                                    "0.3, 30\n*UNBALANCE\n");
        for (int i = 0; i < 48; i++)
            if (part == 2 || i / 24 == part)
                deck = pool_format(&test_pool, "%s%.9g, %d, %d\n", deck, 0.02 * (i + 1), 1 + i % 3, 40 * i % 360);
        assert_int_equal(running_case_open(deck, 4000, 9, 0, &c), ROTID_OK);
        assert_int_equal(machine_nominal(&test_pool, c.machine, c.x, &values), ROTID_OK);
        assert_int_equal(system_build(&test_pool, c.machine, c.job, &values, NULL, &basis, &system, &failed), ROTID_OK);
        assert_true(system.columns <= basis.modes + basis.coupled + 1 + 2 + 2); /* weight, bearings, unbalance in two phases */
        assert_int_equal(response_at(&system, 2000 * RPM, system.right), 0);
        motion[part] = probe_motion(&system, 0, system.right);
        running_case_close(&c);
    }
    assert_close(cabs(motion[0] + motion[1] - motion[2]) / cabs(motion[2]), 0, 0, 1e-7);
}

/* A pedestal sank under its own weight before the rotor was laid in its bearing: the sag is that of springs in series and of the
 * shaft, whatever the pedestal weighs. */
POOL_TEST(pedestals_do_not_sag_under_their_own_weight)
{
    double sag[2];
    for (int i = 0; i < 2; i++) {
        struct running_case c;
        char *text =
            pool_format(&test_pool,
                        "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, MATERIAL=m\n0.5, 0.2, 0, "
                        "10\n*RUNNING\n*BEARING, NAME=a\nstart, 1e8, 1e4\n*BEARING, NAME=b\nend, 1e8, 1e4\n"
                        "*PEDESTAL, BEARING=a\n%s, %s, 1e8, 1e8\n*PEDESTAL, BEARING=b\n%s, %s, 1e8, 1e8\n",
                        i ? "1000" : "1", i ? "1000" : "1", i ? "1000" : "1", i ? "1000" : "1");
        assert_int_equal(running_case_open(text, 3000, 4, 0, &c), ROTID_OK);
        sag[i] = c.speeds.sag_m;
        assert_close(sag[i], c.speeds.weight_n * 2 / 2e8, 0.02, 0); /* half of it on two springs of 1e8, and bending */
        running_case_close(&c);
    }
    assert_close(sag[1], sag[0], 1e-9, 0);
}

/* A film that is stiff on a pedestal of a mass m is a disk of that mass on the pedestal's springs, one on a stiff pedestal is on
 * rigid ground; how stiff is nothing to the critical speeds, nor to the loads. */
POOL_TEST(a_stiff_film_or_a_stiff_pedestal_hides_no_critical_speed)
{
    const char *end[] = {"*DISK\n0.1, 300\n*BEARING\n0.1, 2e7, 3e7, 2e4, 1e4\n",
                         "*BEARING, NAME=e\n0.1, 1e15, 1e15, 0, 0\n*PEDESTAL, BEARING=e\n300, 300, 2e7, 3e7, 2e4, 1e4\n",
                         "*BEARING\n0.1, 2e7, 3e7, 2e4, 1e4\n",
                         "*BEARING, NAME=e\n0.1, 2e7, 3e7, 2e4, 1e4\n*PEDESTAL, BEARING=e\n300, 300, 1e17, 1e17\n"};
    struct running_case c[4];
    for (int i = 0; i < 4; i++) {
        const char *deck =
            pool_format(&test_pool,
                        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1.5, "
                        "0.15, 0, 10\n*RUNNING\n*DISK\n0.9, 60, 1.5, 2.8\n*BEARING\n1.4, 1e8, 8e7, 3e4, 3e4\n%s",
                        end[i]);
        assert_int_equal(running_case_open(deck, 25000, 12, 0, &c[i]), ROTID_OK);
    }
    for (int i = 0; i < 4; i += 2) {
        const rotid_speeds *one = &c[i].speeds, *other = &c[i + 1].speeds;
        assert_true(one->ncritical_speeds >= 4);
        assert_int_equal(other->ncritical_speeds, one->ncritical_speeds);
        for (int j = 0; j < one->ncritical_speeds; j++)
            assert_close(other->critical_speeds[j].speed_rpm, one->critical_speeds[j].speed_rpm, 1e-6, 0);
        if (i) /* there the disk weighs on the bearing */
            assert_close(other->bearing_loads[1].load_y_n, one->bearing_loads[1].load_y_n, 1e-6, 0);
    }
    assert_close(c[1].speeds.bearing_loads[0].load_y_n, c[0].speeds.bearing_loads[0].load_y_n, 1e-6, 0);
    for (int i = 0; i < 4; i++)
        running_case_close(&c[i]);
}

/* A turning shaft that sags is bent to and fro: with three supports, the middle one soft, its loss turns the loads. Of viscous
 * loss s the factor on a static force is 1 - i s W, as that of the loss factor s W. */
POOL_TEST(loss_of_a_shaft_that_sags_is_in_the_loads)
{
    struct running_case c[2];
    const char *loss[] = {"HYSTERETIC\nb, 0.1\n", "VISCOUS\nb, 3.18309886183791e-4\n"}; /* at 3000 rpm */
    double x = 0, moment = 0;
    for (int i = 0; i < 2; i++)
        assert_int_equal(
            running_case_open(
                pool_format(&test_pool,
                            "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1, "
                            "0.05, 0, 20\n*SHAFT, NAME=b, MATERIAL=s\n1, 0.08, 0, 20\n*RUNNING\n*BEARING\n0, 1e8, 0\n"
                            "*BEARING\n0.8, 1e7, 0\n*BEARING\n2, 1e8, 0\n*OPERATION\n3000, 9000\n*LOSS, TYPE=%s",
                            loss[i]),
                12000, 5, 0, &c[i]),
            ROTID_OK);
    for (int i = 0; i < 3; i++) {
        const rotid_bearing_load *one = &c[0].speeds.bearing_loads[i], *other = &c[1].speeds.bearing_loads[i];
        assert_close(one->load_x_n, other->load_x_n, 1e-6, 0);
        assert_close(one->load_y_n, other->load_y_n, 1e-6, 0);
        x += one->load_x_n;
        moment += one->load_x_n * one->position_m;
    }
    assert_close(c[0].speeds.bearing_loads[1].load_x_n, 1.2588, 1e-3, 0); /* by a state space of its own, numpy */
    assert_close(x, 0, 0, 1e-6);
    assert_close(moment, 0, 0, 1e-6);
    running_case_close(&c[0]);
    running_case_close(&c[1]);
}

POOL_TEST(bearing_loads_carry_the_weight)
{
    struct running_case c;
    double y = 0, moment = 0;
    assert_int_equal(
        running_case_open("*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n2, 0.1, 0, 20\n"
                          "*RUNNING\n*DISK\n0.5, 30, 0, 0\n*BEARING\n0.2, 1e8, 0\n*BEARING\n1.6, 1e8, 0\n",
                          6000, 5, 0, &c),
        ROTID_OK);
    double shaft = 7800 * 3.14159265358979323846 / 4 * 0.01 * 2;
    for (int i = 0; i < 2; i++) {
        y += c.speeds.bearing_loads[i].load_y_n;
        moment += c.speeds.bearing_loads[i].load_y_n * c.speeds.bearing_loads[i].position_m;
        assert_close(c.speeds.bearing_loads[i].load_x_n, 0, 0, 1e-6);
    }
    assert_close(y, -(shaft + 30) * 9.80665, 1e-9, 0);
    assert_close(moment, -(shaft * 1 + 30 * 0.5) * 9.80665, 1e-9, 0);
    running_case_close(&c);
}

POOL_TEST(a_pull_lowers_critical_speeds_as_its_stiffness_says)
{
    struct running_case c;
    assert_int_equal(running_case_open(LIGHT, 4000, 5, 0, &c), ROTID_OK);
    double w0 = c.speeds.critical_speeds[0].speed_rpm * RPM;
    running_case_close(&c);
    /* spread over the shaft, whose deflection by a force in the middle is v = (3 s - 4 s^3), s = z/L up to 1/2: mean of v^2 =
     * 17/35 */
    const double pull = 1e4;
    assert_int_equal(running_case_open(LIGHT "*PULL, GROUP=shaft\n1e4\n", 4000, 5, 0, &c), ROTID_OK);
    double w = c.speeds.critical_speeds[0].speed_rpm * RPM;
    assert_close(w * w, w0 * w0 - pull * 17 / 35 / MASS, 2e-4, 0);
    running_case_close(&c);
}

POOL_TEST(undamped_isotropic_critical_speeds_are_those_of_the_map)
{
    struct running_case c;
    int compared = 0;
    assert_int_equal(running_case_open(running_case_deck("B1_friswell_5_9_1", 2, ""), 12000, 13, 0, &c), ROTID_OK);
    const rotid_map_row *row = &c.speeds.map[c.speeds.nmap / 2];
    assert_close(row->stiffness_factor, 1, 1e-12, 0);
    for (int i = 0; i < c.speeds.ncritical_speeds; i++)
        if (!strcmp(c.speeds.critical_speeds[i].whirl, "forward"))
            assert_close(c.speeds.critical_speeds[i].speed_rpm, row->speed_rpm[compared++], 1e-9, 0);
    assert_true(compared >= 4);
    running_case_close(&c);
}

/* u'P u of a rigid turn is the polar inertia, whatever the mesh; of a translation nothing. */
POOL_TEST(rigid_motions_have_the_polar_inertia)
{
    struct running_case c;
    const double pi = 3.14159265358979323846;
    double expected = 0.18; /* the disk; then shaft, holes of the rods, rods */
    const double section[][4] = {{0.3, 0.10, 0, 7850}, {0.2, 0.16, 0.02, 7850}, {0.7, 0.30, 0, 7600}, {0.4, 0.11, 0, 7850}};
    for (int i = 0; i < 4; i++)
        expected += section[i][3] * pi / 32 * (pow(section[i][1], 4) - pow(section[i][2], 4)) * section[i][0];
    expected += 7850 * 8 * (pi / 32 * pow(0.02, 4) + pi / 4 * 0.02 * 0.02 * 0.11 * 0.11) * 0.7;
    assert_int_equal(running_case_open(general, 6000, 3, 0, &c), ROTID_OK);
    for (int as = AS_BEAM; as <= AS_SOLID; as++) {
        struct machine_values values;
        struct rotor rotor;
        struct discrete discrete;
        rotid_matrix s, k, m, p;
        int failed;
        assert_int_equal(machine_nominal(&test_pool, c.machine, c.x, &values), ROTID_OK);
        assert_int_equal(machine_rotor(&test_pool, c.machine, c.job, &values, &rotor), ROTID_OK);
        assert_int_equal(discrete_build(&test_pool, (enum discretisation)as, &rotor, 0, NULL, 1, &discrete, &failed), ROTID_OK);
        discrete_structure(&discrete, &s);
        assert_int_equal(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, &k), ROTID_OK);
        assert_int_equal(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, &m), ROTID_OK);
        assert_int_equal(matrix_new(&test_pool, s.n, s.kd, s.nfar, s.far, &p), ROTID_OK);
        discrete_assemble(&discrete, NULL, &k, &m);
        discrete_gyroscopic(&discrete, &p);
        double *u = POOL_ARRAY(&test_pool, double, 2 * (size_t)s.n), *work = POOL_ARRAY(&test_pool, double, s.n);
        discrete_rigid_motions(&discrete, u);
        assert_close(matrix_product(&p, u + s.n, u + s.n, work), expected, 1e-6, 0);
        assert_close(matrix_product(&p, u, u, work), 0, 0, 1e-9);
    }
    running_case_close(&c);
}

/* Of a prototype by other elements: 1 m x 0.12 m of steel at 1000 rad/s, 526.66 and 539.51 of 533.05 Hz; as a Timoshenko beam
 * 526.34 and 539.16 of 532.72. The bearings are soft enough to leave the rotor free. */
POOL_TEST(a_solid_has_the_gyroscopic_split_of_other_elements)
{
    static const double hz[2][3] = {{532.72, 526.34, 539.16}, {533.05, 526.66, 539.51}};
    for (int solid = 0; solid < 2; solid++) {
        struct running_case c;
        char *deck =
            pool_format(&test_pool,
                        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.12, 0, 60\n"
                        "*FIT, MODEL=%s\n*RUNNING\n*BEARING\nstart, 1e3, 0\n*BEARING\nend, 1e3, 0\n",
                        solid ? "SOLID" : "BEAM");
        assert_int_equal(running_case_open(deck, 1000 / RPM, 2, 0, &c), ROTID_OK);
        assert_close(running_case_mode(&c, 0, 5)->frequency_hz, hz[solid][0], 2e-5, 0);
        for (int i = 0; i < 2; i++) {
            const rotid_campbell_mode *m = &c.speeds.campbell[1].modes[4 + i];
            assert_close(m->frequency_hz, hz[solid][1 + i], 2e-5, 0);
            assert_string_equal(m->whirl, i ? "forward" : "backward");
        }
        running_case_close(&c);
    }
}

/* 30 times as long as thick, with a disk: beam and solid are one rotor. (A disk of 0.12 kg.m2 bends its section against the
 * contraction on both sides of it, which a solid has and a beam has not: 0.2 % of the mode that turns there.) */
POOL_TEST(a_slender_rotor_is_the_same_as_beam_and_as_solid)
{
    struct running_case c[2];
    for (int solid = 0; solid < 2; solid++)
        assert_int_equal(
            running_case_open(pool_format(&test_pool,
                                          "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, "
                                          "MATERIAL=s\n1.5, 0.05, 0, 90\n*FIT, MODEL=%s\n*RUNNING\n*DISK\n0.4, 12, "
                                          "0.03, 0.055\n*BEARING\nstart, 2e7, 4e3\n*BEARING\nend, 1e7, 2e3\n",
                                          solid ? "SOLID" : "BEAM"),
                              9000, 4, 0, &c[solid]),
            ROTID_OK);
    const rotid_campbell_speed *as[2] = {&c[0].speeds.campbell[3], &c[1].speeds.campbell[3]};
    assert_true(as[0]->nmodes >= 6 && as[1]->nmodes >= 6);
    for (int i = 0; i < 6; i++) {
        assert_close(as[1]->modes[i].frequency_hz, as[0]->modes[i].frequency_hz, 1e-3, 0);
        assert_close(as[1]->modes[i].log_decrement, as[0]->modes[i].log_decrement, 3e-3, 0);
        assert_string_equal(as[1]->modes[i].whirl, as[0]->modes[i].whirl);
    }
    assert_true(as[0]->modes[5].frequency_hz > 1.03 * as[0]->modes[4].frequency_hz);
    assert_int_equal(c[1].speeds.ncritical_speeds, c[0].speeds.ncritical_speeds);
    assert_true(c[0].speeds.ncritical_speeds >= 4);
    for (int i = 0; i < c[0].speeds.ncritical_speeds; i++)
        assert_close(c[1].speeds.critical_speeds[i].speed_rpm, c[0].speeds.critical_speeds[i].speed_rpm, 1e-3, 0);
    running_case_close(&c[0]);
    running_case_close(&c[1]);
}

/* What is added to the diametral inertia of a disk, or taken from it, is a disk with that inertia and the same polar one: at
 * rest, at speed, in torsion. */
POOL_TEST(an_inertia_added_to_a_disk_is_that_of_the_disk)
{
    static const struct {
        const char *model, *disk, *added;
    } table[] = {{"BEAM", ".15, .19", "-.12"}, {"BEAM", ".1, .19", ".05"},    {"BEAM", "0, 0", ".05"},
                 {"BEAM", ".1, .19", "-.1"},   {"SOLID", ".15, .19", "-.12"}, {"SOLID", ".1, .19", ".05"},
                 {"SOLID", "0, 0", ".05"},     {"SOLID", ".1, .19", "-.1"},   {"SOLID", ".1, .19", "-.0001"}};
    for (size_t t = 0; t < sizeof table / sizeof *table; t++) {
        struct running_case c[2];
        double diametral, polar, added = strtod(table[t].added, NULL);
        assert_int_equal(sscanf(table[t].disk, "%lf, %lf", &diametral, &polar), 2);
        for (int own = 0; own < 2; own++) {
            const char *cause =
                own ? "" : pool_format(&test_pool, "*CAUSE, NAME=c, TYPE=added_inertia, AT=dd\ninertia, %s\n", table[t].added);
            assert_int_equal(
                running_case_open(pool_format(&test_pool,
                                              "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, .3\n*DENSITY\n7850\n*SHAFT, NAME=a, "
                                              "MATERIAL=s\n1.1, .06, 0, 40\n*DISK, NAME=dd\n.25, 10, %.17g, %.17g\n%s*FIT, "
                                              "MODEL=%s\n*RUNNING\n*BEARING\nstart, 3e7, 100\n*BEARING\n.95, 5e7, 100\n",
                                              own ? diametral + added : diametral, polar, cause, table[t].model),
                                  12000, 4, 0, &c[own]),
                ROTID_OK);
        }
        for (int i = 0; i < 4; i++) {
            const rotid_campbell_speed *as[2] = {&c[0].speeds.campbell[i], &c[1].speeds.campbell[i]};
            assert_true(as[0]->nmodes >= 6 && as[0]->nmodes == as[1]->nmodes);
            for (int j = 0; j < as[0]->nmodes; j++)
                assert_close(as[0]->modes[j].frequency_hz, as[1]->modes[j].frequency_hz, 1e-9, 0);
        }
        assert_true(c[0].speeds.ncritical_speeds > 0 && c[0].speeds.ncritical_speeds == c[1].speeds.ncritical_speeds);
        for (int i = 0; i < c[0].speeds.ncritical_speeds; i++)
            assert_close(c[0].speeds.critical_speeds[i].speed_rpm, c[1].speeds.critical_speeds[i].speed_rpm, 1e-9, 0);
        assert_true(c[0].speeds.ntorsion > 0 && c[0].speeds.ntorsion == c[1].speeds.ntorsion);
        for (int i = 0; i < c[0].speeds.ntorsion; i++)
            assert_close(c[0].speeds.torsion[i].frequency_hz, c[1].speeds.torsion[i].frequency_hz, 1e-9, 0);
        running_case_close(&c[0]);
        running_case_close(&c[1]);
    }
}

/* Two couplings of inertia J at the ends of a free shaft: tan b = 2 m b/(m^2 b^2 - 1), m = J/(rho Ip L), w = b sqrt(G/rho)/L. By
 * f ~ sqrt G its relative deviation is half that of G, and *CHANGE counts as G does. */
POOL_TEST(couplings_twist_the_machine_as_a_free_shaft_with_two_inertias)
{
    const double length = 1.5, g = 3e10, rho = 7600, polar = PI * pow(0.12, 4) / 32, m = 0.4 / (rho * polar * length);
    double root[3];
    for (int k = 0; k < 3; k++) {
        double low = k * PI + 1e-6, high = (k + 1) * PI - 1e-6, value = 0, first = 0;
        for (int i = 0; i < 100; i++) {
            double b = i ? (low + high) / 2 : low;
            value = sin(b) * (m * m * b * b - 1) - 2 * m * b * cos(b);
            first = i ? first : value;
            *(value * first > 0 ? &low : &high) = b;
        }
        root[k] = low;
    }
    for (int solid = 0; solid < 2; solid++) {
        struct running_case c;
        double x[1] = {g}, std[1] = {0.04 * g}, covariance[1] = {std[0] * std[0]};
        const rotid_fit_result fit = {.n = 1, .x = x, .std = std, .covariance = covariance};
        const char *text = pool_format(
            &test_pool,
            "*MATERIAL, NAME=l\n*ELASTIC, TYPE=SHEAR\n1.1e11, 3e10, 0.28\n*DENSITY\n7600\n*SHAFT, NAME=core, MATERIAL=l\n"
            "1.5, 0.12, 0, 30\n*FIT%s\n*IDENTIFY\ncore.G, 1e9, 1e12, 3e10\n*RUNNING\n*DISK\nstart, 10, 0.2, 0.4\nend, "
            "10, 0.2, 0.4\n*BEARING, STD=0.3\n0.2, 1e8, 1e4\n*BEARING\n1.3, 1e8, 1e4\n*CHANGE\ncore.G, 1, 0.06\n",
            solid ? ", MODEL=SOLID" : "");
        assert_int_equal(running_case_open(text, 9000, 5, 0, &c), ROTID_OK);
        assert_int_equal(running_case_run(&c, &fit, 9000, 5, 0), ROTID_OK);
        assert_true(c.speeds.ntorsion >= 3);
        for (int k = 0; k < 3; k++) {
            const rotid_torsional_frequency *f = &c.speeds.torsion[k];
            assert_int_equal(f->number, k + 1);
            /* elements of length h: (b h)^2/24 at most; at the end of a solid its section yields to the inertia there */
            assert_close(f->frequency_hz, root[k] * sqrt(g / rho) / length / (2 * PI), solid ? 3e-4 : pow(root[k] / 30, 2) / 20,
                         0);
            assert_close(f->std_hz / f->frequency_hz, hypot(0.04, 0.06) / 2, 1e-4, 0);
        }
        running_case_close(&c);
    }
}

TEST_GROUP(folder_make, folder_remove);
