/* Faults of the measurement chain in shapes of the oracle, on the right model and on wrong ones that nobody has fitted: false
 * alarms, and every kind of fault at random sensors. Rates are asserted against their binomial bounds; seeds are fixed. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "paper_rotor.h"
#include "rotor_shapes.h"

#define MOST  PAPER_SENSORS
#define MODES EXACT_MODES
#define AXIS  SHAPE_POINTS
#define NOISE 0.015

enum hidden { RIGHT, SOFT, JOINT, MASS, MODULUS, NARROW, END_MASS, ALL_AT_ONCE, HIDDEN };

static struct rotor_shapes truth[HIDDEN];

static int open_shapes(void **state)
{
    double from, to;
    struct exact e;
    (void)state;
    rotor_group_span(paper_rotor(BUNDLE_RODS, 1), 1, &from, &to);
    for (int h = 0; h < HIDDEN; h++) {
        rotor_shapes_open(&e);
        if (h == SOFT)
            exact_soften(&e, 1.0, 1.06, 0.5);
        if (h == NARROW) /* between two sensors: a change of slope and a jump */
            exact_soften(&e, 1.2, 1.22, 0.1);
        if (h == JOINT || h == ALL_AT_ONCE)
            exact_add(&e, (struct oracle_point){.z = from, .flexibility = 1e-9});
        if (h == MASS)
            exact_add(&e, (struct oracle_point){.z = 0.3, .mass = 15});
        if (h == END_MASS)
            exact_add(&e, (struct oracle_point){.z = 0, .mass = 3});
        if (h == MODULUS)
            exact_soften(&e, from, to, 0.9);
        if (h == ALL_AT_ONCE) {
            exact_add(&e, (struct oracle_point){.z = 1.9, .mass = 5});
            exact_soften(&e, 0.9, 0.95, 0.4);
            exact_soften(&e, 0, from, 0.9);
        }
        rotor_shapes(&e, &truth[h]);
    }
    return 0;
}

struct scene {
    int n;
    double z[MOST], clean[MOST * MODES], shape[MOST * MODES], std[MOST * MODES];
    double axis[AXIS * MODES];
    struct random_stream random;
};

static void open_scene(struct scene *scene, enum hidden hidden, int n, unsigned seed)
{
    const struct rotor *rotor = paper_rotor(BUNDLE_RODS, 1);
    *scene = (struct scene){.n = n, .random = {seed}};
    for (int i = 0; i < n; i++) {
        double off = i > 0 && i < n - 1 ? 0.4 * (random_uniform(&scene->random) - 0.5) : 0;
        scene->z[i] = n == MOST ? rotor->sensor[i].position : truth[0].length * (i + off) / (n - 1);
    }
    for (int k = 0; k < MODES; k++)
        for (int i = 0; i < n; i++) {
            scene->clean[i + k * n] = scene->shape[i + k * n] = rotor_shape_at(&truth[hidden], k, scene->z[i]);
            scene->std[i + k * n] = NOISE;
        }
}

static void add_noise(struct scene *scene)
{
    for (int i = 0; i < scene->n * MODES; i++)
        scene->shape[i] += scene->std[i] * random_normal(&scene->random);
}

/* The model that the check is given is always the right one's, scaled to the data as it is, faults included. */
static int check(struct scene *scene, int most, struct sensor_fault *fault)
{
    int n = scene->n, count;
    for (int k = 0; k < MODES; k++) {
        double aa = 0, ab = 0;
        for (int i = 0; i < n; i++) {
            double a = rotor_shape_at(&truth[RIGHT], k, scene->z[i]), b = scene->shape[i + k * n];
            aa += isnan(b) ? 0 : a * a;
            ab += isnan(b) ? 0 : a * b;
        }
        for (int i = 0; i < AXIS; i++)
            scene->axis[i + k * AXIS] = ab / aa * truth[RIGHT].value[k][i];
    }
    struct shape_data data = {n, MODES, scene->z, scene->shape, scene->std, scene->shape, AXIS, truth[RIGHT].z, scene->axis};
    struct pool pool;
    pool_open(&pool, NULL);
    assert_status(sensor_check(&pool, &data, 0.005, most, fault, &count), ROTID_OK);
    pool_close(&pool);
    return count;
}

static void false_alarms(void **state)
{
    const int sensors[] = {68, 34, 20, 12, 8};
    int alarms = 0;
    (void)state;
    for (unsigned seed = 0; seed < 320; seed++) {
        struct scene scene;
        struct sensor_fault fault[2];
        open_scene(&scene, seed % HIDDEN, sensors[seed / HIDDEN % 5], 100 + seed);
        add_noise(&scene);
        alarms += check(&scene, 2, fault) > 0;
    }
    print_message("false alarms: %d of 320\n", alarms);
    assert_true(alarms <= 5); /* 0.005 of 320 is 1.6; more than 5 has a probability of 0.006 */
}

/* Noise of twice the stated size is not blamed on sensors. */
static void noise_understated(void **state)
{
    int alarms = 0;
    (void)state;
    for (unsigned seed = 0; seed < 20; seed++) {
        struct scene scene;
        struct sensor_fault fault[6];
        open_scene(&scene, seed % 5, 34, 7000 + seed);
        for (int i = 0; i < scene.n * MODES; i++)
            scene.std[i] = 2 * NOISE;
        add_noise(&scene);
        for (int i = 0; i < scene.n * MODES; i++)
            scene.std[i] = NOISE;
        alarms += check(&scene, 6, fault) > 0;
    }
    assert_true(alarms <= 1);
}

enum trouble { GAIN_HIGH, GAIN_LOW, SIGN, SWAP_NEXT, SWAP_FAR, MOVED, COPY, DEAD, COPY_AGAIN, TROUBLES };
static const char *const trouble_name[] = {"gain 1.4",  "gain 0.7", "sign", "swap of neighbours",     "swap of distant ones",
                                           "60 mm off", "copy",     "dead", "copy with noise of 1e-6"};
static const enum sensor_fault_kind expected[] = {FAULT_GAIN,     FAULT_GAIN,      FAULT_SIGN, FAULT_SWAP,     FAULT_SWAP,
                                                  FAULT_POSITION, FAULT_DUPLICATE, FAULT_DEAD, FAULT_DUPLICATE};

/* Puts the fault on sensor s, t being the other one. Returns the chi2 of what it changes; *shift [m] of MOVED. */
static double spoil(struct scene *scene, enum hidden hidden, enum trouble trouble, int s, int t, double *shift)
{
    double change = 0;
    *shift = s % 2 ? 0.06 : -0.06;
    if (scene->z[s] + *shift < 0 || scene->z[s] + *shift > truth[0].length)
        *shift = -*shift;
    for (int k = 0; k < MODES; k++) {
        const double *c = scene->clean + (ptrdiff_t)k * scene->n;
        double *e = scene->shape + (ptrdiff_t)k * scene->n;
        if (trouble == GAIN_HIGH || trouble == GAIN_LOW)
            e[s] *= trouble == GAIN_HIGH ? 1.4 : 0.7;
        else if (trouble == SIGN)
            e[s] = -c[s];
        else if (trouble == MOVED)
            e[s] = rotor_shape_at(&truth[hidden], k, scene->z[s] + *shift);
        else
            e[s] = trouble == DEAD ? 0 : c[t];
        if (trouble == SWAP_NEXT || trouble == SWAP_FAR)
            e[t] = c[s];
        change += pow((e[s] - c[s]) / NOISE, 2) + pow((e[t] - c[t]) / NOISE, 2);
    }
    return change;
}

static int is_right(enum trouble trouble, int s, int t, double shift, const struct sensor_fault *fault)
{
    double value = trouble == GAIN_HIGH ? 1.4 : trouble == GAIN_LOW ? 0.7 : shift;
    if (expected[trouble] == FAULT_SWAP)
        return fault->kind == FAULT_SWAP &&
               ((fault->sensor == s && fault->other == t) || (fault->sensor == t && fault->other == s));
    if (fault->sensor != s)
        return 0;
    if (fault->kind != expected[trouble] || (fault->kind == FAULT_DUPLICATE && fault->other != t))
        return 0;
    return (fault->kind != FAULT_GAIN && fault->kind != FAULT_POSITION) || fabs(fault->value - value) < 3 * fault->std;
}

static void one_fault(void **state)
{
    int all = 0, found = 0;
    (void)state;
    for (enum trouble trouble = 0; trouble < TROUBLES; trouble++) {
        int visible = 0, right = 0, extra = 0;
        for (unsigned seed = 0; seed < 25; seed++) {
            enum hidden hidden = seed % 5;
            struct scene scene;
            struct sensor_fault fault[3];
            double shift;
            open_scene(&scene, hidden, seed % 4 ? 34 : 68, 5000 + 100 * seed + (unsigned)trouble);
            int n = scene.n, s = (int)(random_uniform(&scene.random) * n), t;
            do
                t = trouble == SWAP_NEXT ? s + (s + 1 < n ? 1 : -1) : (int)(random_uniform(&scene.random) * n);
            while (trouble != SWAP_NEXT && abs(s - t) < 3);
            double change = spoil(&scene, hidden, trouble, s, t, &shift);
            add_noise(&scene);
            for (int k = 0; (trouble == COPY || trouble == COPY_AGAIN) && k < MODES; k++)
                scene.shape[s + k * n] =
                    scene.shape[t + k * n] * (1 + (trouble == COPY ? 0 : 1e-6 * random_normal(&scene.random)));
            if (change < 30) /* too small for anyone */
                continue;
            int count = check(&scene, 3, fault);
            visible++;
            right += count > 0 && is_right(trouble, s, t, shift, &fault[0]);
            extra += count > 1;
            assert_true(count == 0 || fault[0].chi2_drop > 15);
        }
        print_message("%-20s right %d of %d, something else as well %d\n", trouble_name[trouble], right, visible, extra);
        assert_true(visible >= 15 && right >= 0.84 * visible && extra <= 1);
        all += visible;
        found += right;
    }
    assert_true(found >= 0.95 * all);
}

/* Two at a time, next to one another or not, one of them often at an end; noise that differs from sensor to sensor, and gaps. */
static void two_faults(void **state)
{
    const enum trouble kinds[] = {GAIN_HIGH, SIGN, DEAD, MOVED};
    int right = 0, all = 0, extra = 0;
    (void)state;
    for (unsigned seed = 0; seed < 24; seed++) {
        struct scene scene;
        struct sensor_fault fault[5];
        enum hidden hidden = seed % 5;
        double shift[2], change[2];
        open_scene(&scene, hidden, seed % 4 ? 34 : 68, 900 + seed);
        int n = scene.n, s[2] = {seed % 3 ? (int)(random_uniform(&scene.random) * (n - 1)) : 0, 0};
        s[1] = seed % 2 ? s[0] + 1 : (s[0] + n / 2) % n;
        enum trouble trouble[2] = {kinds[seed % 4], kinds[seed / 4 % 4]};
        for (int i = 0; i < 2; i++)
            change[i] = spoil(&scene, hidden, trouble[i], s[i], s[i], &shift[i]) / 2; /* counted for s and t, here the same */
        for (int i = 0; i < n * MODES; i++)
            scene.std[i] = NOISE * (0.7 + 0.6 * random_uniform(&scene.random));
        add_noise(&scene);
        for (int i = 0; i < n * MODES; i++)
            if (random_uniform(&scene.random) < 0.05)
                scene.shape[i] = NAN;
        int count = check(&scene, 5, fault);
        for (int i = 0; i < 2; i++)
            if (change[i] >= 60) {
                int hit = 0;
                for (int j = 0; j < count; j++)
                    hit |= is_right(trouble[i], s[i], s[i], shift[i], &fault[j]);
                all++;
                right += hit;
            }
        for (int j = 0; j < count; j++)
            extra += fault[j].sensor != s[0] && fault[j].sensor != s[1];
    }
    print_message("two at once: right %d of %d, something else as well %d\n", right, all, extra);
    assert_true(right >= 0.88 * all && extra <= 2);
}

static void few_sensors_or_none(void **state)
{
    struct scene scene;
    struct sensor_fault fault[2];
    (void)state;
    open_scene(&scene, RIGHT, 7, 1);
    for (int k = 0; k < MODES; k++)
        scene.shape[3 + k * 7] *= -1;
    add_noise(&scene);
    assert_int_equal(check(&scene, 2, fault), 0);
    open_scene(&scene, RIGHT, 34, 2);
    add_noise(&scene);
    for (int k = 0; k < 2; k++) /* two modes of which nothing was measured */
        for (int i = 0; i < 34; i++)
            scene.shape[i + k * 34] = NAN;
    for (int k = 2; k < MODES; k++)
        scene.shape[20 + k * 34] *= -1;
    assert_int_equal(check(&scene, 2, fault), 1);
    assert_true(fault[0].kind == FAULT_SIGN && fault[0].sensor == 20);
}

/* The scale of the measured shapes is free, as is that of the modes of the model. */
static void any_scale(void **state)
{
    struct scene scene;
    struct sensor_fault fault[2], scaled[2];
    double shift;
    (void)state;
    open_scene(&scene, SOFT, 34, 3);
    spoil(&scene, SOFT, GAIN_HIGH, 11, 11, &shift);
    add_noise(&scene);
    assert_int_equal(check(&scene, 2, fault), 1);
    for (int i = 0; i < 34 * MODES; i++) {
        scene.shape[i] *= -3e-6;
        scene.std[i] *= 3e-6;
    }
    assert_int_equal(check(&scene, 2, scaled), 1);
    assert_int_equal(scaled[0].sensor, fault[0].sensor);
    assert_close(scaled[0].value, fault[0].value, 1e-6, 0);
    assert_close(scaled[0].chi2_drop, fault[0].chi2_drop, 1e-6, 0);
}

static void without_memory(void **state)
{
    struct scene scene;
    struct sensor_fault fault[2];
    int count, status = ROTID_ERROR_MEMORY;
    (void)state;
    open_scene(&scene, RIGHT, 12, 4);
    check(&scene, 2, fault); /* fills the axis */
    struct shape_data data = {12, MODES, scene.z, scene.shape, scene.std, scene.shape, AXIS, truth[RIGHT].z, scene.axis};
    for (long fail = 1; status == ROTID_ERROR_MEMORY; fail++) {
        struct failing_allocator failing;
        struct pool pool;
        assert_true(fail < 50);
        failing_allocator_open(&failing, fail);
        pool_open(&pool, &failing.allocator);
        status = sensor_check(&pool, &data, 0.005, 2, fault, &count);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_status(status, ROTID_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(false_alarms),   cmocka_unit_test(noise_understated),   cmocka_unit_test(one_fault),
        cmocka_unit_test(two_faults),     cmocka_unit_test(few_sensors_or_none), cmocka_unit_test(any_scale),
        cmocka_unit_test(without_memory),
    };
    return cmocka_run_group_tests(tests, open_shapes, NULL);
}
