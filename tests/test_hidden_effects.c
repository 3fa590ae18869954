/* The diagnosis on hidden effects (hidden.h): fixed cases of every kind, seeds 1, 2, 3, ... in the order of the table.
 * tools/power does the same with fresh ones by the thousand. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/parallel.h"
#include "hidden.h"

#define JOBS 2

enum expected {
    CLEAR,     /* named, or in an ambiguous set, which is one of two from a margin of 15 on; sound data are not accused */
    SMALL,     /* whatever is said, no wrong name */
    NOTHING,   /* adequate */
    FAULT,     /* of the data: found, nothing else accused, no cause named */
    MISSTATED, /* noise: no cause named */
    TWO,       /* one of them at least, no wrong name */
    OUTSIDE    /* no name where the best cause leaves much */
};

static const struct {
    enum expected expected;
    const char *effect[2]; /* at most */
    double correlation;
} table[] = {
    {CLEAR, {"step_stiffness:angle=40"}, 0},
    {CLEAR, {"stiffness_gradient:group=core,slope=0.2"}, 0},
    {CLEAR, {"stiffness_gradient:group=left,slope=-0.25"}, 0},
    {CLEAR, {"stiffness_profile:group=core,profile=0.5"}, 0},
    {CLEAR, {"stiffness_local:depth=0.6,z=1.2,width=0.04,shape=gaussian"}, 0},
    {CLEAR, {"stiffness_local:depth=0.6,z=0.45,width=0.08,shape=box"}, 0},
    {CLEAR, {"joint:at=core.end,flexibility=1e-9"}, 0},
    {CLEAR, {"joint:at=left.end,flexibility=1e-9"}, 0},
    {CLEAR, {"added_mass:mass=25,z=0.9"}, 0},
    {CLEAR, {"added_mass:mass=0.4,z=0"}, 0},
    {CLEAR, {"density:group=core,factor=1.15"}, 0},
    {CLEAR, {"density:group=right,factor=0.9"}, 0},
    {CLEAR, {"stiffness:group=left,factor=1.08"}, 0},
    {CLEAR, {"stiffness:group=right,factor=0.88"}, 0},
    {CLEAR, {"tie_stiffness:at=ties,factor=0.3"}, 0},
    {CLEAR, {"tie_shear:at=ties"}, 0},
    {CLEAR, {"shear_coefficient:group=left,factor=0.7"}, 0},
    {CLEAR, {"accelerometer_mass:mass=0.5,mount=fixed,sensor=68"}, 0},
    {SMALL, {"stiffness_gradient:group=core,slope=0.05"}, 0},
    {SMALL, {"stiffness_profile:group=core,profile=0.1"}, 0},
    {SMALL, {"stiffness_local:depth=0.15,z=1.0,width=0.04,shape=gaussian"}, 0},
    {SMALL, {"joint:at=left.end,flexibility=1.5e-10"}, 0},
    {SMALL, {"added_mass:mass=4,z=0.9"}, 0},
    {SMALL, {"density:group=right,factor=1.015"}, 0},
    {SMALL, {"stiffness:group=left,factor=0.99"}, 0},
    {SMALL, {"tie_stiffness:at=ties,factor=0.75"}, 0},
    {SMALL, {"shear_coefficient:group=right,factor=1.06"}, 0},
    {SMALL, {"accelerometer_mass:mass=0.3,mount=moving"}, 0},
    {SMALL, {"support:at=sling,factor=3"}, 0},
    {SMALL, {"tie_tension:at=ties,factor=0.5"}, 0},
    {NOTHING, {NULL}, 0},
    {NOTHING, {NULL}, 0},
    {NOTHING, {NULL}, 0},
    {NOTHING, {NULL}, 0.7},
    {FAULT, {"sensor_gain:sensor=20,gain=1.6"}, 0},
    {FAULT, {"sensor_sign:sensor=33"}, 0},
    {FAULT, {"sensor_swap:sensors=12+14"}, 0},
    {FAULT, {"sensor_position:sensor=50,shift=0.08"}, 0},
    {FAULT, {"duplicate_channel:sensor=40,of=43"}, 0},
    {MISSTATED, {"noise_level:block=SHAPE,factor=2"}, 0},
    {MISSTATED, {"noise_level:block=SHAPE,factor=0.5"}, 0},
    {MISSTATED, {"noise_level:block=FREQUENCY,factor=2"}, 0},
    {TWO, {"stiffness:group=left,factor=1.08", "added_mass:mass=20,z=1.2"}, 0},
    {TWO, {"tie_shear:at=ties", "joint:at=core.end,flexibility=1e-9"}, 0},
    {OUTSIDE, {"outside:kind=ground_rotation,z=1.45,stiffness=8e7"}, 0},
    {OUTSIDE, {"outside:kind=sine,group=core,amplitude=0.4,waves=2"}, 0},
    {TWO, {"outside:kind=two_zones,depth=0.8,z=0.4,width=0.03,depth2=0.8,z2=1.5,width2=0.03"}, 0},
};

#define COUNT ((int)(sizeof table / sizeof *table))

static struct hidden_score score[COUNT];
static char directory[] = "/tmp/hidden.XXXXXX";

static int run_one(void *deck, int i, int worker)
{
    struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
    (void)worker;
    c.request.deck = deck;
    c.request.name = "input/paper_rotor.inp";
    c.request.seed = (uint64_t)i + 1;
    c.request.correlation = table[i].correlation;
    c.request.effect = table[i].effect;
    c.request.effects = (table[i].effect[0] != NULL) + (table[i].effect[1] != NULL);
    return hidden_run(&c, NULL, NULL, NULL, &score[i]);
}

static int run_all(void **state)
{
    char *deck = hidden_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp");
    (void)state;
    assert_non_null(deck);
    assert_non_null(mkdtemp(directory));
    int status = parallel_for(JOBS, COUNT, run_one, deck);
    rmdir(directory);
    free(deck);
    return status;
}

static int is_as_expected(enum expected expected, const struct hidden_score *s)
{
    int found = s->outcome == HIDDEN_RIGHT || (s->outcome == HIDDEN_IN_SET && (s->nset <= 2 || !(s->margin >= 15))),
        wrong = s->outcome == HIDDEN_WRONG;
    switch (expected) {
    case CLEAR:
        return found && !s->accused;
    case SMALL:
        return !wrong;
    case NOTHING:
        return s->outcome == HIDDEN_SILENT && !s->accused;
    case FAULT:
        return s->outcome == HIDDEN_RIGHT && !s->accused && !s->names;
    case MISSTATED:
        return !s->names;
    case TWO:
        return s->found > 0 && !wrong;
    default:
        return !wrong || !(s->left >= 60);
    }
}

static void check(enum expected expected)
{
    int bad = 0;
    for (int i = 0; i < COUNT; i++) {
        const struct hidden_score *s = &score[i];
        if (table[i].expected != expected)
            continue;
        int as_expected = is_as_expected(expected, s) && s->outcome != HIDDEN_FAILED;
        bad += !as_expected;
        print_message("%s seed %-2d %-50s %s%s%s%s, drop %.1f, margin %.1f, %.1f s\n", as_expected ? "     " : "  BAD", i + 1,
                      table[i].effect[0] ? table[i].effect[0] : "nothing", hidden_outcome_name(s->outcome),
                      s->wrong[0] ? ": " : "", s->wrong, s->failure, s->drop, s->margin, s->seconds);
    }
    assert_int_equal(bad, 0);
}

static void clear_effects_are_found(void **state)
{
    (void)state;
    check(CLEAR);
}

static void small_effects_get_no_wrong_name(void **state)
{
    (void)state;
    check(SMALL);
}

static void nothing_is_nothing(void **state)
{
    (void)state;
    check(NOTHING);
}

static void faults_of_the_data_are_found(void **state)
{
    (void)state;
    check(FAULT);
}

static void wrong_noise_is_no_physics(void **state)
{
    (void)state;
    check(MISSTATED);
}

static void two_effects_at_once(void **state)
{
    (void)state;
    check(TWO);
}

static void what_is_not_in_the_catalogue_gets_no_name(void **state)
{
    (void)state;
    check(OUTSIDE);
}

/* What the data are worth is known without a diagnosis: a drop of 30 has to be reported, whatever it is then called. */
static void a_drop_of_30_is_reported(void **state)
{
    int clear = 0;
    (void)state;
    for (int i = 0; i < COUNT; i++)
        if (score[i].class == HIDDEN_PHYSICAL && score[i].drop >= 30) {
            clear++;
            if (!score[i].reported)
                fail_msg("seed %d, %s: drop %.1f and nothing reported", i + 1, table[i].effect[0], score[i].drop);
        }
    assert_true(clear >= 15);
}

static void intervals_hold_the_truth(void **state)
{
    int count = 0, inside = 0;
    (void)state;
    for (int i = 0; i < COUNT; i++)
        for (int v = 0; v < score[i].nvalue; v++) {
            const struct hidden_value *value = &score[i].value[v];
            count++;
            inside += hidden_covers(value);
        }
    print_message("      %d of %d intervals hold the truth\n", inside, count);
    assert_true(count >= 40);
    assert_true(inside >= 0.85 * count); /* 95 % less what so few may be short of */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clear_effects_are_found),
        cmocka_unit_test(small_effects_get_no_wrong_name),
        cmocka_unit_test(nothing_is_nothing),
        cmocka_unit_test(faults_of_the_data_are_found),
        cmocka_unit_test(wrong_noise_is_no_physics),
        cmocka_unit_test(two_effects_at_once),
        cmocka_unit_test(what_is_not_in_the_catalogue_gets_no_name),
        cmocka_unit_test(a_drop_of_30_is_reported),
        cmocka_unit_test(intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, run_all, NULL);
}
