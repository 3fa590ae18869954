/* Pairs of causes from the columns of a scan: drops beside the normal equations and a search on a grid, what may be a pair, and
 * their order. */
#include <math.h>

#include "base/base.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "support.h"

#define ROWS  20
#define MOST  12
#define GRID  2000
#define WIDE  1e3
#define PLACE 1 /* of a soft zone and of a mass */

static struct scan scan;
static struct scan_item item[MOST];
static struct scan_candidate candidate[MOST];
static double column[ROWS * MOST], residual[ROWS];
static struct segment segment = {.length = 1};
static struct state only, two[2];
static const struct states states = {.nstate = 1, .state = &only}, two_states = {.nstate = 2, .state = two};
static const int in_all[] = {1, 1}, in_first[] = {1, 0}, in_second[] = {0, 1};

static void open_scan(void)
{
    scan = (struct scan){.nrow = ROWS, .dof = ROWS, .item = item, .candidate = candidate, .column = column, .r = residual};
    only = (struct state){.job.rotor = {.nsegment = 1, .segment = &segment}};
    two[0] = two[1] = only;
}

static struct scan_candidate *add_candidate(const char *id, int target)
{
    struct scan_candidate *c = &candidate[scan.ncandidate++];
    const struct cause_kind *cause = catalogue_find(id);
    assert_non_null(cause);
    *c = (struct scan_candidate){
        .state = -1, .in = in_all, .cause = cause, .effect = {.kind = cause->effect, .target = target}, .first = scan.nitem};
    return c;
}

/* A column of unit length that leans on the one before by `cosine`. */
static struct scan_item *add_item(struct random_stream *random, double cosine)
{
    double *c = column + (ptrdiff_t)scan.nitem * ROWS, *before = c - ROWS, square = 0, along = 0;
    for (int i = 0; i < ROWS; i++)
        c[i] = random_normal(random);
    for (int i = 0; i < ROWS && cosine != 0; i++)
        along += c[i] * before[i];
    for (int i = 0; i < ROWS && cosine != 0; i++)
        c[i] -= along * before[i];
    for (int i = 0; i < ROWS; i++)
        square += c[i] * c[i];
    for (int i = 0; i < ROWS; i++)
        c[i] = c[i] / sqrt(square) * sqrt(1 - cosine * cosine) + (cosine != 0 ? cosine * before[i] : 0);
    item[scan.nitem] = (struct scan_item){.candidate = scan.ncandidate - 1,
                                          .effect = candidate[scan.ncandidate - 1].effect,
                                          .usable = 1,
                                          .unit = 1,
                                          .norm = 2,
                                          .lower = -WIDE,
                                          .upper = WIDE};
    candidate[scan.ncandidate - 1].count++;
    return &item[scan.nitem++];
}

static void set_residual(int first, double a, int second, double b)
{
    for (int i = 0; i < ROWS; i++)
        residual[i] = -item[first].norm * a * column[first * ROWS + i] - item[second].norm * b * column[second * ROWS + i];
}

/* |r|^2 - |r + a c_i + b c_j|^2 with the columns of their own lengths */
static double drop_at(int i, int j, double a, double b)
{
    double drop = 0;
    for (int k = 0; k < ROWS; k++) {
        double left = residual[k] + a * item[i].norm * column[i * ROWS + k] + b * item[j].norm * column[j * ROWS + k];
        drop += residual[k] * residual[k] - left * left;
    }
    return drop;
}

static double drop_on_grid(int i, int j)
{
    double best = 0;
    for (int s = 0; s <= GRID; s++)
        for (int t = 0; t <= GRID; t++)
            best = fmax(best, drop_at(i, j, item[i].lower + (item[i].upper - item[i].lower) * s / GRID,
                                      item[j].lower + (item[j].upper - item[j].lower) * t / GRID));
    return best;
}

static int choose(struct scan_set *set)
{
    int count;
    assert_status(pairs_choose(&test_pool, &states, &scan, MOST, set, &count), ROTID_OK);
    return count;
}

static void two_columns_that_made_the_residual_come_first_with_their_sizes(void **state)
{
    (void)state;
    struct random_stream random = {5};
    struct scan_set set[MOST];
    open_scan();
    for (int i = 0; i < 5; i++) {
        add_candidate("density", i);
        add_item(&random, i ? 0.9 : 0); /* masked: each alone takes most of the other */
    }
    set_residual(1, 3, 2, -2.5);
    assert_int_equal(choose(set), 10);
    assert_true(set[0].candidate[0] == 1 && set[0].candidate[1] == 2);
    assert_close(set[0].amplitude[0], 3, 1e-10, 0);
    assert_close(set[0].amplitude[1], -2.5, 1e-10, 0);
    assert_close(set[0].drop, drop_at(1, 2, 3, -2.5), 1e-10, 0);
    for (int i = 1; i < 10; i++)
        assert_true(set[i].drop <= set[i - 1].drop); /* of as many parameters */
}

static void steps_stay_where_physics_allows_them(void **state)
{
    (void)state;
    struct random_stream random = {6};
    const double bound[][4] = {{0, 2, -1, 1}, {0, 10, 0, 10}, {-1, 0.5, -3, 0}, {0, 0.1, 0, 0.1}, {-5, 0, 0, 5}};
    for (int trial = 0; trial < 5; trial++) {
        struct scan_set set[MOST];
        open_scan();
        add_candidate("joint", 0);
        add_item(&random, 0);
        add_candidate("density", 0);
        add_item(&random, 0.6);
        set_residual(0, 3, 1, -2);
        for (int i = 0; i < 2; i++) {
            item[i].lower = bound[trial][2 * i];
            item[i].upper = bound[trial][2 * i + 1];
        }
        double best = drop_on_grid(0, 1);
        int count = choose(set);
        assert_int_equal(count, best > 0);
        if (!count)
            continue;
        assert_close(set[0].drop, best, 1e-3, 0); /* of the grid */
        assert_true(set[0].drop >= best * (1 - 1e-12));
        for (int i = 0; i < 2; i++)
            assert_true(set[0].amplitude[i] >= item[i].lower - 1e-12 && set[0].amplitude[i] <= item[i].upper + 1e-12);
        assert_close(set[0].drop, drop_at(0, 1, set[0].amplitude[0], set[0].amplitude[1]), 1e-9, 0);
    }
}

static void one_cause_twice_needs_two_places(void **state)
{
    (void)state;
    struct random_stream random = {7};
    struct scan_set set[MOST];
    open_scan();
    add_candidate("stiffness_local", -1);
    for (int i = 0; i < 3; i++)
        add_item(&random, 0)->effect.value[PLACE] = i < 2 ? 0.5 + 0.01 * i : 0.8;
    set_residual(0, 2, 1, 2); /* neighbours would do best */
    assert_int_equal(choose(set), 1);
    assert_int_equal(set[0].item[1], 2);
    open_scan();
    add_candidate("density", 3);
    add_item(&random, 0);
    add_candidate("density", 3)->suspect = 1; /* the same asked for by name */
    add_item(&random, 0);
    set_residual(0, 2, 1, 2);
    assert_int_equal(choose(set), 0);
    candidate[1].effect.target = 4;
    assert_int_equal(choose(set), 1);
}

static void columns_that_are_one_and_residuals_that_are_few_make_no_pair(void **state)
{
    (void)state;
    struct random_stream random = {8};
    struct scan_set set[MOST];
    open_scan();
    add_candidate("density", 0);
    add_item(&random, 0);
    add_candidate("stiffness", 0);
    add_item(&random, 0.995);
    set_residual(0, 2, 1, 2);
    assert_int_equal(choose(set), 0);
    open_scan();
    add_candidate("density", 0);
    add_item(&random, 0);
    add_candidate("stiffness", 0);
    add_item(&random, 0.5);
    set_residual(0, 2, 1, 2);
    scan.dof = LEAST_RESIDUALS + 2;
    assert_int_equal(choose(set), 1);
    scan.dof--;
    assert_int_equal(choose(set), 0);
}

/* The candidate in state s alone. */
static struct scan_candidate *add_single(const char *id, int target, int s)
{
    struct scan_candidate *c = add_candidate(id, target);
    c->state = c->home = s;
    c->in = s ? in_second : in_first;
    return c;
}

static int choose_of_two(struct scan_set *set)
{
    int count;
    assert_status(pairs_choose(&test_pool, &two_states, &scan, MOST, set, &count), ROTID_OK);
    return count;
}

/* Behind the pairs of common causes stand those with a cause in one state: not the same one that acts there anyway, but the same
 * one in two states. */
static void causes_in_one_state_make_pairs_of_their_own(void **state)
{
    (void)state;
    struct random_stream random = {10};
    struct scan_set set[2 * MOST];
    open_scan();
    add_candidate("density", 0);
    add_item(&random, 0);
    add_candidate("stiffness", 0);
    add_item(&random, 0.3);
    add_single("density", 0, 0);
    add_item(&random, 0.3);
    add_single("density", 0, 1);
    add_item(&random, 0.3);
    set_residual(2, 4, 3, -3); /* it changes from state to state */
    assert_int_equal(choose_of_two(set), 1 + 3);
    assert_true(set[0].candidate[0] == 0 && set[0].candidate[1] == 1);
    assert_true(set[1].candidate[0] == 2 && set[1].candidate[1] == 3);
    assert_close(set[1].amplitude[0], 4, 1e-10, 0);
    assert_close(set[1].amplitude[1], -3, 1e-10, 0);
    for (int i = 2; i < 4; i++) /* the other ones: stiffness in both beside density in one */
        assert_true(set[i].candidate[0] == 1 && set[i].drop <= set[1].drop);
}

/* At one place a zone of both states and one of a state are one, zones of two states are two. */
static void zones_of_two_states_may_share_a_place(void **state)
{
    (void)state;
    struct random_stream random = {11};
    struct scan_set set[2 * MOST];
    for (int apart = 0; apart < 2; apart++) {
        open_scan();
        add_candidate("stiffness_local", -1);
        add_item(&random, 0)->effect.value[PLACE] = 0.5;
        add_single("stiffness_local", -1, 0);
        add_item(&random, 0)->effect.value[PLACE] = apart ? 0.8 : 0.5;
        set_residual(0, 2, 1, 2);
        assert_int_equal(choose_of_two(set), apart);
    }
    open_scan();
    for (int s = 0; s < 2; s++) {
        add_single("stiffness_local", -1, s);
        add_item(&random, 0)->effect.value[PLACE] = 0.5;
    }
    set_residual(0, 2, 1, 2);
    assert_int_equal(choose_of_two(set), 1);
}

/* Among pairs of like drops the one with fewer parameters comes first. */
static void a_pair_pays_for_its_parameters(void **state)
{
    (void)state;
    struct random_stream random = {9};
    struct scan_set set[MOST];
    open_scan();
    add_candidate("density", 0)->effect.kind = catalogue_find("density")->effect;
    add_item(&random, 0);
    add_candidate("stiffness_local", -1);
    add_item(&random, 0);
    add_candidate("stiffness", 1);
    add_item(&random, 0);
    set_residual(0, 5, 1, 1); /* the third column takes next to nothing */
    double more = drop_at(0, 1, 5, 1) - drop_at(0, 1, 5, 0);
    int count = choose(set);
    assert_int_equal(count, 3);
    assert_true(more < 2 * PARAMETER_PENALTY && set[0].candidate[1] == 2);
    set_residual(0, 5, 1, 4);
    assert_int_equal(choose(set), 3);
    assert_int_equal(set[0].candidate[1], 1);
}

static void what_an_approximation_adds_to_the_noise_comes_out_again(void **state)
{
    (void)state;
    double frequency[] = {1e-4, NAN}, shape[] = {0.01, NAN, 0.02, 0.03}, any[4] = {0};
    const struct candidate cone = {.cause = catalogue_find("step_stiffness"), .in = in_all},
                           exact = {.cause = catalogue_find("density"), .in = in_all};
    struct state one = {
        .job = {.rotor.nsensor = 2, .measurement = {.nmode = 2, .frequency_std = frequency, .shape_std = shape, .shape = any}}};
    struct states with = {.nstate = 1, .state = &one};
    const struct job_measurement *m = &one.job.measurement;
    assert_true(discrepancy_of(cone.cause) && !discrepancy_of(exact.cause));
    assert_status(discrepancy_add(&test_pool, &exact, 1, &with), ROTID_OK);
    assert_ptr_equal(m->frequency_std, frequency);
    assert_status(discrepancy_add(&test_pool, &cone, 1, &with), ROTID_OK);
    assert_close(m->frequency_std[0], hypot(1e-4, cone.cause->discrepancy_frequency), 1e-14, 0);
    assert_close(m->shape_std[3], hypot(0.03, cone.cause->discrepancy_shape), 1e-14, 0);
    assert_status(discrepancy_add(&test_pool, &cone, -1, &with), ROTID_OK);
    assert_close(m->frequency_std[0], 1e-4, 1e-9, 0);
    assert_close(m->shape_std[0], 0.01, 1e-9, 0);
    assert_true(isnan(m->frequency_std[1]) && isnan(m->shape_std[1])); /* what is not measured stays so */
    assert_close(frequency[0], 1e-4, 0, 0);                            /* others may have the same arrays */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(two_columns_that_made_the_residual_come_first_with_their_sizes, open_test_pool,
                                        close_test_pool),
        cmocka_unit_test_setup_teardown(steps_stay_where_physics_allows_them, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(one_cause_twice_needs_two_places, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(columns_that_are_one_and_residuals_that_are_few_make_no_pair, open_test_pool,
                                        close_test_pool),
        cmocka_unit_test_setup_teardown(what_an_approximation_adds_to_the_noise_comes_out_again, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(a_pair_pays_for_its_parameters, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(causes_in_one_state_make_pairs_of_their_own, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(zones_of_two_states_may_share_a_place, open_test_pool, close_test_pool),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
