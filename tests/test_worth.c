/* Which test at rest narrows a critical speed: a shaft on pins, whose speeds and frequencies go with the root of E. */
#include "api/api.h"
#include "support.h"

#define NOISE 0.002
#define SHAFT "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, 20\n"
#define PINS                                                                                                                     \
    "*IDENTIFY\na.E, 1e9, 1e13, 1.9e11\n*RUNNING\n*BEARING\nstart, 1e13, 0\n*BEARING\nend, 1e13, 0\n*OPERATION\n1000, 9000\n"

static rotid_deck *deck_of(const char *text)
{
    rotid_deck *deck;
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    return deck;
}

/* The deck with exact frequencies of `count` modes, the first without number. */
static rotid_deck *measured(int count, int number)
{
    rotid_deck *deck = deck_of(SHAFT);
    rotid_spectrum *s;
    char *text = pool_format(&test_pool, SHAFT "*NOISE, FREQUENCY=%g\n*MODES\n", NOISE);
    assert_status(rotid_spectrum_compute(deck, NULL, 6, NULL, NULL, &s), ROTID_OK);
    for (int k = 0; k < count; k++)
        text = pool_format(&test_pool, "%s%d, %.12g\n", text, number + k, s->modes[number + k - 1].full_hz);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
    return deck_of(pool_format(&test_pool, "%s" PINS, text));
}

static rotid_suggestion *suggest(const rotid_deck *deck, int speed, int expected, char *failure)
{
    rotid_suggestion *s = NULL;
    rotid_suggest_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    options.speed = speed;
    assert_int_equal(rotid_suggest(deck, &options, NULL, failure, &s), expected);
    return s;
}

static double std_of(const rotid_suggestion *s, const char *test)
{
    for (int i = 0; i < s->nspeed_tests; i++)
        if (!strcmp(s->speed_tests[i].test, test))
            return s->speed_tests[i].std_rpm;
    fail_msg("no test '%s'", test);
    return NAN;
}

/* d ln f/d ln E = d ln W/d ln E = 1/2: K frequencies with the deviation s leave s/sqrt K of a critical speed. */
POOL_TEST(a_test_adds_its_information)
{
    enum { K = 2 };
    rotid_deck *deck = measured(K, 1);
    rotid_suggestion *s = suggest(deck, 1, ROTID_OK, NULL);
    double one = NOISE * s->speed_rpm;
    assert_close(s->noise.frequency, NOISE, 1e-12, 0);
    assert_close(s->speed_std, one / sqrt(K), 1e-5, 0);
    assert_close(s->speed_identified, 1, 1e-9, 0);
    assert_close(std_of(s, "the 2 modes again"), one / sqrt(2 * K), 1e-5, 0);
    assert_close(std_of(s, "the 2 modes again, with half the noise"), one / sqrt(5 * K), 1e-5, 0);
    assert_close(std_of(s, "mode 1 again, with half the noise"), one / sqrt(K + 4), 1e-5, 0);
    assert_close(std_of(s, "mode 3 besides"), one / sqrt(K + 1), 1e-5, 0);
    assert_close(std_of(s, "modes 3 to 5 besides"), one / sqrt(K + 3), 1e-5, 0);
    /* a mass changes the frequencies and not how they go with E */
    assert_close(std_of(s, pool_format(&test_pool, "the 2 modes with %.3g kg at 0.500 m", 0.05 * 7800 * 3.14159265 / 4 * 0.0025)),
                 one / sqrt(2 * K), 1e-5, 0);
    for (int i = 1; i < s->nspeed_tests; i++)
        assert_true(s->speed_tests[i].std_rpm >= s->speed_tests[i - 1].std_rpm);
    assert_close(s->speed_tests[0].narrowed_percent, 100 * (1 - 1 / sqrt(5)), 1e-5, 0);
    assert_non_null(strstr(s->sentence, "Measure the 2 modes again, with half the noise"));
    rotid_suggestion_free(s);
    rotid_deck_free(deck);
}

POOL_TEST(before_a_test_its_modes_say_all)
{
    rotid_deck *deck = deck_of(SHAFT "*NOISE, FREQUENCY=0.002\n" PINS);
    rotid_suggestion *s = suggest(deck, 1, ROTID_OK, NULL);
    assert_true(isnan(s->speed_std));
    assert_close(std_of(s, "modes 1 to 4"), s->noise.frequency * s->speed_rpm / 2, 1e-5, 0);
    rotid_suggestion_free(s);
    rotid_deck_free(deck);
}

/* The share of the unknowns is that of the variance shares of `rotid speeds`. */
POOL_TEST(the_share_of_the_unknowns_is_that_of_the_machine)
{
    rotid_deck *deck;
    rotid_speeds *speeds;
    const rotid_speeds_options options = {.size = sizeof options, .draws = 20, .count = 9};
    assert_status(rotid_deck_read(ROTID_SOURCE_DIR "/input/motor_running.inp", 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_speeds_compute(deck, &options, NULL, NULL, &speeds), ROTID_OK);
    rotid_suggestion *s = suggest(deck, 1, ROTID_OK, NULL);
    const rotid_critical_speed *c = &speeds->critical_speeds[1];
    assert_string_equal(c->whirl, "forward");
    assert_string_equal(c->variance_shares[0].source, "identified");
    assert_close(s->speed_rpm, c->speed_rpm, 1e-6, 0);
    assert_close(s->speed_identified, c->variance_shares[0].share, 1e-3, 0);
    assert_non_null(strstr(s->sentence, "a run-up (*RUNUP) does"));
    rotid_suggestion_free(s);
    rotid_speeds_free(speeds);
    rotid_deck_free(deck);
}

POOL_TEST(what_cannot_be_is_refused)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = measured(2, 1), *bare = deck_of(SHAFT "*IDENTIFY\na.E, 1e9, 1e13, 1.9e11\n");
    (void)suggest(bare, 1, ROTID_ERROR_ARGUMENT, failure);
    assert_non_null(strstr(failure, "no *RUNNING"));
    (void)suggest(deck, 101, ROTID_ERROR_ARGUMENT, failure);
    assert_non_null(strstr(failure, "options->speed is 101"));
    (void)suggest(deck, 90, ROTID_ERROR_ARGUMENT, failure);
    assert_non_null(strstr(failure, "not number 90"));
    rotid_deck_free(bare);
    rotid_deck_free(deck);
}
