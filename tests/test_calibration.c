/* Self-consistency (power --prior): explanations and sizes are drawn as the priors say, probabilities that are true pass the
 * bands and distorted ones do not, and a case goes from the draw to its line in the log. */
#include "support.h"

#include <unistd.h>

#include "deck/deck.h"
#include "power/power.h"

#define DRAWS 4000
#define SURE  4.5 /* standard deviations of a binomial count; one of some hundred is farther once in a thousand runs */

static volatile sig_atomic_t never;

static const char deck[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                           "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 12\n"
                           "*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.10, 0, 16\n"
                           "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 12\n"
                           "*SPRING, NAME=front\n0.1, 1e5\n*SPRING, NAME=rear\n0.9, 1e5\n"
                           "*SENSORS\n1, 0\n2, 0.1\n3, 0.2\n4, 0.4\n5, 0.5\n6, 0.7\n7, 0.8\n8, 1\n"
                           "*IDENTIFY\ncore.E, 5e10, 8e11, 2e11\n";

static void list_causes(struct pool *pool, struct states *states, struct scan *list)
{
    const struct deck_memory memory = {"calibration", strlen(deck), deck, NULL};
    struct message_list messages;
    message_open(&messages, pool);
    assert_int_equal(deck_read_states(pool, "calibration", &memory, 0, NULL, &messages, states), ROTID_OK);
    assert_int_equal(scan_list(pool, states, list), ROTID_OK);
}

static void near_rate(const char *what, int count, int of, double share)
{
    if (!(fabs(count - of * share) < SURE * sqrt(of * share * (1 - share)) + 0.5))
        fail_msg("%s: %d of %d, expected %.4g", what, count, of, of * share);
}

POOL_TEST(explanations_are_drawn_as_the_priors_say)
{
    struct states states;
    struct scan list;
    struct hide_random random;
    int size[MOST_MEMBERS + 1] = {0}, other = 0, singles = 0, kind[100] = {0}, core = 0, density = 0, narrow = 0, zones = 0,
                            line[4] = {0}, lines = 0, soft = 0, supports = 0, all = 0;
    double share[MOST_MEMBERS + 1], sum = 0, factorial = 1;
    list_causes(&test_pool, &states, &list);
    const struct rotor *rotor = &states.state->job.rotor;
    hide_random_open(3, HIDE_FOR_EFFECTS, &random);
    for (int i = 0; i < DRAWS; i++) {
        struct explanation e;
        power_prior_draw(rotor, &list, 1, &random, &e);
        const struct candidate *c = e.member;
        size[e.nmember]++;
        other += e.something_else;
        if (e.nmember != 1)
            continue;
        singles++;
        for (int k = 0; k < catalogue_count(); k++)
            kind[k] += catalogue_item(k) == c->cause;
        density += !strcmp(c->cause->id, "density");
        core += !strcmp(c->cause->id, "density") && !strcmp(c->target, "core");
        if (!strcmp(c->cause->id, "stiffness_local")) {
            double lower, upper;
            cause_bounds(c->cause, rotor, &c->effect, c->cause->width, &lower, &upper);
            zones++;
            narrow += c->effect.value[c->cause->width] < sqrt(lower * upper);
        }
        if (!strcmp(c->cause->id, "support")) {
            supports++;
            soft += log(c->effect.value[0]) < -0.6745 * 1.6; /* the lower quarter */
        }
        if (!strcmp(c->cause->id, "sensor_line")) {
            lines++;
            line[c->effect.value[2] > 0.5 ? 0 : !c->fixed[0] + 2 * !c->fixed[1]]++;
        }
    }
    for (int n = 0; n <= MOST_MEMBERS; n++) {
        factorial *= n > 1 ? n : 1;
        sum += share[n] = (exp(posterior_log_prior(n, 0)) + exp(posterior_log_prior(n, 1))) / factorial;
    }
    for (int n = 0; n <= MOST_MEMBERS; n++)
        near_rate("members", size[n], DRAWS, share[n] / sum);
    near_rate("something else", other, DRAWS,
              exp(posterior_log_prior(0, 1)) / (exp(posterior_log_prior(0, 0)) + exp(posterior_log_prior(0, 1))));
    for (int k = 0; k < catalogue_count(); k++) {
        int listed = 0, copy = !strcmp(catalogue_item(k)->id, "duplicate_channel");
        for (int i = 0; i < list.ncandidate; i++)
            listed |= list.candidate[i].cause == catalogue_item(k);
        listed |= !strncmp(catalogue_item(k)->id, "sensor_", 7) || copy;
        all += listed + copy;
        near_rate(catalogue_item(k)->id, kind[k], singles, (listed + copy) / (double)power_prior_kinds(&list, 1));
    }
    assert_int_equal(all, power_prior_kinds(&list, 1)); /* a copy or a dead channel */
    assert_int_equal(power_prior_kinds(&list, 0), all - 7);
    near_rate("density of core", core, density, 1 / 3.0);
    near_rate("narrow zones", narrow, zones, 0.5);
    near_rate("soft supports", soft, supports, 0.25);
    for (int l = 0; l < 4; l++)
        near_rate("lines", line[l], lines, 0.25);
}

/* 500 leading explanations with probabilities p, right with probability p^power; how many of 40 such tables pass. */
static int passed(double power)
{
    struct hide_random random;
    FILE *out = fopen("/dev/null", "wb");
    int pass = 0, right[500];
    double probability[500];
    assert_non_null(out);
    hide_random_open(4, HIDE_FOR_EFFECTS, &random);
    for (int table = 0; table < 40; table++) {
        for (int i = 0; i < 500; i++) {
            probability[i] = 1 - 0.8 * pow(hide_uniform(&random), 2);
            right[i] = hide_uniform(&random) < pow(probability[i], power);
        }
        pass += !power_bands(out, 500, probability, right);
    }
    fclose(out);
    return pass;
}

UNIT_TEST(true_probabilities_pass_the_bands_and_distorted_ones_do_not)
{
    const int all = passed(1), over = passed(2), under = passed(0.45);
    print_message("      of 40 tables %d pass, %d that say too much, %d that say too little\n", all, over, under);
    assert_true(all >= 35 && all < 41);
    assert_true(over <= 4);
    assert_true(under <= 4);
}

UNIT_TEST(a_run_from_the_priors_goes_on_from_its_log)
{
    char path[] = "/tmp/calibration.XXXXXX", *text[2] = {NULL, NULL};
    size_t length;
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    struct power_options options = {.cases = 2, .jobs = 1, .seed = 5, .first = 1, .prior = 1, .log = path};
    for (int run = 0; run < 2; run++) {
        FILE *out = open_memstream(&text[run], &length);
        assert_int_equal(power_calibration(&options, &never, out), 0);
        fclose(out);
    }
    remove(path);
    assert_non_null(strstr(text[0], "power --prior --seed 5: 2 cases, 0 draws of them without data, 0 without a diagnosis"));
    assert_non_null(strstr(text[0], "averaged 95 % intervals hold the true values: "));
    assert_null(strstr(text[0], " of 0, "));
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
}
