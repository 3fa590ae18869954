/* A deck written from a job is read as the same job. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "folder.h"
#include "run/run.h"
#include "same_job.h"
#include "support.h"

#define INPUT ROTID_SOURCE_DIR "/input/"
#define DECKS ROTID_SOURCE_DIR "/tests/data/decks/"

#define MODEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define TWO                                                                                                                      \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=left, MATERIAL=steel\n0.4, 0.1, 0, 8\n"          \
    "*SHAFT, NAME=core, MATERIAL=steel\n0.6, 0.14, 0, 12\n"

struct reading {
    struct pool pool;
    struct message_list messages;
    struct job job;
};

static void read_path(struct reading *r, const char *path, const char *set)
{
    struct override override;
    pool_open(&r->pool, NULL);
    message_open(&r->messages, &r->pool);
    if (set)
        assert_int_equal(override_parse(&r->pool, set, &override), 0);
    int status = deck_read(&r->pool, path, set != NULL, &override, &r->messages, &r->job);
    for (size_t i = 0; i < r->messages.count && status; i++)
        print_error("%s:%d:%d: %s\n", path, r->messages.item[i].line, r->messages.item[i].column, r->messages.item[i].text);
    assert_status(status, ROTID_OK);
}

static void read_text(struct reading *r, const char *text)
{
    read_path(r, folder_write("deck.inp", text), NULL);
}

static const char *written(struct reading *r, const struct deck_write_options *options)
{
    char *text;
    assert_status(deck_write(&r->pool, &r->job, options, &text), ROTID_OK);
    return text;
}

/* read(write(job)) == job, and the second writing is the first one */
static void assert_comes_back(const char *path, const char *set)
{
    struct reading first, second;
    read_path(&first, path, set);
    const char *text = written(&first, NULL);
    (void)folder_write("again.inp", text);
    read_path(&second, folder_path("again.inp"), NULL);
    assert_same_job(&first.job, &second.job);
    assert_string_equal(written(&second, NULL), text);
    pool_close(&first.pool);
    pool_close(&second.pool);
}

static void assert_text_comes_back(const char *text)
{
    (void)folder_write("deck.inp", text);
    assert_comes_back(folder_path("deck.inp"), NULL);
}

/* ------------------------------------------------------------------------------------------------ round trips */

static void every_shipped_deck_comes_back_to_the_last_bit(void **state)
{
    (void)state;
    static const char *const decks[] = {"brake_reuss_beam",   "foam_bar",    "motor_shaft_stack", "paper_rotor",
                                        "roving_hammer_beam", "solid_rotor", "solid_steel",       "solid_steel_stiff"};
    static const char *const files[] = {"gradient", "local", "mass", "uniform"};
    char text[512];
    for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
        (void)snprintf(text, sizeof text, INPUT "%s.inp", decks[i]);
        assert_comes_back(text, NULL);
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        (void)snprintf(text, sizeof text, "MEASURED.FILE=" INPUT "data/bricks_rotor_%s.uff", files[i]);
        assert_comes_back(INPUT "solid_rotor.inp", text);
    }
}

/* The path of a file becomes absolute, so that the deck holds wherever it is written. */
static void transfer_functions_come_back_with_their_file(void **state)
{
    (void)state;
    static const char *const cards[] = {"*FRF, LOW=100, HIGH=900, STEP=0.25, QUANTITY=VELOCITY, DAMPING=0.004\n1, 2\n2, 2\n",
                                        "*FRF, LINES=50\n",
                                        "*FRF, FILE=deck.inp, AXIS=X, FLIP=YES, ORIGIN=0.125, LOW=20\n7, 1\n"};
    char text[1024];
    for (size_t i = 0; i < sizeof cards / sizeof *cards; i++) {
        (void)snprintf(text, sizeof text,
                       "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n"
                       "1, 0.1, 0, 20\n*SENSORS\n1, start\n2, end\n%s",
                       cards[i]);
        assert_text_comes_back(text);
    }
}

static void every_card_and_every_cause_comes_back(void **state)
{
    (void)state;
    assert_comes_back(DECKS "every_card.inp", NULL);
    assert_comes_back(DECKS "every_cause.inp", NULL);
    assert_comes_back(DECKS "one_element.inp", NULL);
}

static void what_was_measured_in_part_comes_back(void **state)
{
    (void)state;
    assert_text_comes_back(MODEL);
    assert_text_comes_back(MODEL "*SENSORS\n1, 0\n2, 0.33333333333333331\n");        /* no modes */
    assert_text_comes_back(MODEL "*MODES\n3, 2400, , 0.7\n1, 500\n2, 1300, 0.01\n"); /* noise of one mode; any order */
    assert_text_comes_back(MODEL "*MODES\n1, 500, , 1\n2, 1300.1, , 0.3\n3, 2407.7, , 0.1\n");
    assert_text_comes_back(MODEL "*MODES\n1, 500\n2, 1300\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n*SHAPE, MODE=2\n3, 1\n1, -0.1, 0.03\n");
    assert_text_comes_back(MODEL "*FIT, MODEL=SOLID\n");
    assert_text_comes_back(MODEL "*CAUSE, NAME=m, TYPE=added_mass, SUSPECT\nz, 0.3\nmass, 0.01, 0.4\n");
    assert_text_comes_back(MODEL "*MODES\n1, 500\n2, 1300\n*FIT, HOLDOUT=2\n*IDENTIFY\ncore.E, 0, 1e12, 2e11\n");
    assert_text_comes_back(MODEL "*MODES\n1, 500\n2, 1300\n*IDENTIFY\ncore.E, 0, 1e12, 2e11\ncore.G, 0, 1e12, 8e10\n");
    assert_text_comes_back(
        MODEL
        "*MODES\n1, 500\n2, 1300\n*IDENTIFY\ncore.E, 0, 1e12, 2e11\ncore.G, 0, 1e12, 8e10\n*FIT, TIE=E:G, FUNCTIONAL=HYBRID\n");
}

static void names_may_be_odd(void **state)
{
    (void)state;
    /* a group whose name is an option or holds an equals sign cannot stand behind a comma */
    static const char *const right[] = {"SUSPECT", "a=b", "name", "2", "at", "*x", "two words", "a.b", "\xc3\xa4", "gr*"};
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
        char text[1024];
        (void)snprintf(text, sizeof text,
                       "*MATERIAL, NAME=*s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=1, MATERIAL=*s\n0.5, 0.1, 0, 9\n"
                       "*SHAFT, NAME=%s, MATERIAL=*s\n0.5, 0.1, 0, 9\n*CAUSE, NAME=j=1, TYPE=joint, AT=0.5\nflexibility, 1e-9\n"
                       "*CAUSE, NAME=type, TYPE=density, GROUP=%s\nfactor, 0.9\n*CAUSE, NAME=x, TYPE=joint, AT=0.5, SUSPECT\n",
                       right[i], right[i]);
        assert_text_comes_back(text);
    }
}

static void two_modes_of_one_frequency_stay_two(void **state)
{
    (void)state;
    struct reading first, second;
    read_text(&first, MODEL "*MODES\n1, 500\n2, 1300\n3, 1400\n");
    first.job.measurement.frequency_hz[2] = 1300; /* as a universal file may have it */
    (void)folder_write("again.inp", written(&first, NULL));
    read_path(&second, folder_path("again.inp"), NULL);
    assert_true(second.job.measurement.frequency_hz[1] == 1300 &&
                second.job.measurement.frequency_hz[2] == nextafter(1300, INFINITY));
    pool_close(&first.pool);
    pool_close(&second.pool);
}

/* ------------------------------------------------------------------------------------------------ what a caller adds */

static void extra_lines_go_into_the_heading_and_harm_nothing(void **state)
{
    (void)state;
    static char longest[2000];
    static const char *const extra[] = {
        "found by diagnose: joint", "*SHAFT, no card", "a ** no comment", "", "tab\tand\nend", longest};
    static const char *const expected[] = {"the deck", "found by diagnose: joint", "SHAFT, no card", "a  * no comment",
                                           "tab and end"};
    const struct deck_write_options options = {.nextra = sizeof extra / sizeof *extra, .extra = extra};
    struct reading first, second;
    memset(longest, 'x', 1023);
    (void)strcpy(longest + 1023, "\xc3\xa4 and more"); /* the character does not fit */
    read_text(&first, "*HEADING\nthe deck\npaper error_percent = 1, 2\n" MODEL);
    (void)folder_write("again.inp", written(&first, &options));
    read_path(&second, folder_path("again.inp"), NULL);
    assert_int_equal(second.job.nheading, 6);
    for (int i = 0; i < 5; i++)
        assert_string_equal(second.job.heading[i], expected[i]);
    assert_int_equal(strlen(second.job.heading[5]), 1023);
    assert_true(second.job.nreference == 1 && second.job.reference[0].values[1] == 2);
    pool_close(&first.pool);
    pool_close(&second.pool);
}

static void written_at_x_the_model_and_the_starts_are_those_of_x(void **state)
{
    (void)state;
    static const double x[] = {1.9e11, 3e-8, -0.07};
    const struct deck_write_options options = {.x = x};
    struct reading first, second;
    read_text(&first, TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 0\n"
                          "*CAUSE, NAME=t, TYPE=stiffness_gradient, GROUP=core\nslope, 0\n*MODES\n1, 500\n2, 1300\n3, 2400\n"
                          "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\nj.flexibility, 0, 1e-7, 1e-8\nt.slope, -0.5, 0.5, 0.1\n");
    (void)folder_write("again.inp", written(&first, &options));
    read_path(&second, folder_path("again.inp"), NULL);
    assert_true(second.job.rotor.group[1].material.e == 1.9e11 && second.job.rotor.group[0].material.e == 2.1e11);
    assert_true(second.job.rotor.effect[0].value[0] == 3e-8 && second.job.rotor.effect[1].value[0] == -0.07);
    for (int p = 0; p < 3; p++)
        assert_true(second.job.unknowns.bounds[p].start == x[p] &&
                    second.job.unknowns.bounds[p].lower == first.job.unknowns.bounds[p].lower);
    assert_true(first.job.rotor.group[1].material.e == 2.1e11 && first.job.rotor.effect[0].value[0] == 0); /* untouched */
    pool_close(&first.pool);
    pool_close(&second.pool);
}

static void what_lies_on_a_bound_is_still_a_deck(void **state)
{
    (void)state;
    struct reading first, second;
    double lower, upper, x[] = {4e11, 0, 0.5};
    const struct deck_write_options options = {.x = x};
    read_text(&first, TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 0\n"
                          "*CAUSE, NAME=t, TYPE=stiffness_gradient, GROUP=core\nslope, 0\n*MODES\n1, 500\n2, 1300\n3, 2400\n"
                          "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\nj.flexibility, 0, 1e-8, 1e-9\nt.slope, -0.5, 0.5, 0.1\n");
    /* bounds of the joint at the E of before, which are wider than those at the E that was found */
    const struct effect *joint = first.job.rotor.effect;
    cause_reach(catalogue_of(joint), &first.job.rotor, joint, 0, &lower, &upper);
    first.job.unknowns.bounds[1].upper = upper;
    first.job.rotor.effect[0].value[0] = x[1] = upper;
    first.job.rotor.group[0].material.e = 4e11;
    (void)folder_write("again.inp", written(&first, &options));
    read_path(&second, folder_path("again.inp"), NULL);
    assert_true(second.job.unknowns.bounds[1].upper < 0.6 * upper);
    assert_close(second.job.rotor.effect[0].value[0], second.job.unknowns.bounds[1].upper, 1e-15, 0);
    for (int p = 0; p < 3; p++)
        assert_true(second.job.unknowns.bounds[p].start > second.job.unknowns.bounds[p].lower &&
                    second.job.unknowns.bounds[p].start < second.job.unknowns.bounds[p].upper);
    x[2] = 0; /* is no scale */
    (void)folder_write("again.inp", written(&first, &options));
    pool_close(&second.pool);
    read_path(&second, folder_path("again.inp"), NULL);
    assert_true(second.job.unknowns.bounds[2].start == 0.1);
    pool_close(&first.pool);
    pool_close(&second.pool);
}

static void a_fit_runs_from_the_written_deck_to_where_it_stood(void **state)
{
    (void)state;
    struct reading first, second;
    struct identification before, after;
    read_path(&first, DECKS "every_cause.inp", NULL);
    first.job.unknowns.nparameter = 1; /* E alone: this deck is no rotor that was ever measured */
    assert_status(identify_run(&first.pool, &first.job, 0, NULL, &first.messages, &before), ROTID_OK);
    const struct deck_write_options options = {.x = before.fit->x};
    (void)folder_write("again.inp", written(&first, &options));
    read_path(&second, folder_path("again.inp"), NULL);
    assert_status(identify_run(&second.pool, &second.job, 0, NULL, &second.messages, &after), ROTID_OK);
    assert_close(after.fit->x[0], before.fit->x[0], 1e-7, 0);
    assert_close(after.fit->objective, before.fit->objective, 1e-9, 0);
    rotid_fit_free(before.fit);
    rotid_fit_free(after.fit);
    pool_close(&first.pool);
    pool_close(&second.pool);
}

/* ------------------------------------------------------------------------------------------------ what a deck cannot say */

static void what_no_deck_can_say_is_refused(void **state)
{
    (void)state;
    static char longest[1100];
    struct reading r;
    char *text;
    memset(longest, 'n', sizeof longest - 1);
    static const char *const names[] = {"a,b", "", " a", "a ", "a**b", "a\nb", longest, NULL};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        read_text(&r, TWO "*CAUSE, NAME=j, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-9\n");
        r.job.rotor.effect[0].name = names[i];
        assert_status(deck_write(&r.pool, &r.job, NULL, &text), ROTID_ERROR_ARGUMENT);
        assert_null(text);
        r.job.rotor.effect[0].name = "j";
        r.job.rotor.group[1].name = names[i] ? names[i] : ",";
        assert_status(deck_write(&r.pool, &r.job, NULL, &text), ROTID_ERROR_ARGUMENT);
        pool_close(&r.pool);
    }
    read_text(&r, MODEL "*SENSORS\n1, 0\n*MODES\n1, 500\n");
    r.job.rotor.sensor[0].id = 0;
    assert_status(deck_write(&r.pool, &r.job, NULL, &text), ROTID_ERROR_ARGUMENT);
    r.job.rotor.sensor[0].id = 1;
    r.job.measurement.frequency_hz[0] = NAN;
    assert_status(deck_write(&r.pool, &r.job, NULL, &text), ROTID_ERROR_ARGUMENT);
    r.job.measurement.frequency_hz[0] = 500;
    r.job.measurement.number[0] = 1001;
    assert_status(deck_write(&r.pool, &r.job, NULL, &text), ROTID_ERROR_ARGUMENT);
    pool_close(&r.pool);
}

static void without_memory_nothing_is_written(void **state)
{
    (void)state;
    struct reading r;
    struct failing_allocator failing;
    static const double x[] = {2e11, -0.1, 0.2, 0.7};
    const struct deck_write_options options = {.x = x};
    long fail_at = 0;
    int status;
    read_path(&r, DECKS "every_cause.inp", NULL);
    do {
        struct pool pool;
        char *text;
        failing_allocator_open(&failing, ++fail_at);
        pool_open(&pool, &failing.allocator);
        status = deck_write(&pool, &r.job, &options, &text);
        assert_true((status == ROTID_OK) == (text != NULL) && (status == ROTID_OK || status == ROTID_ERROR_MEMORY));
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    } while (failing.until_failure == 0);
    assert_status(status, ROTID_OK);
    pool_close(&r.pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shipped_deck_comes_back_to_the_last_bit),
        cmocka_unit_test(transfer_functions_come_back_with_their_file),
        cmocka_unit_test(every_card_and_every_cause_comes_back),
        cmocka_unit_test(what_was_measured_in_part_comes_back),
        cmocka_unit_test(names_may_be_odd),
        cmocka_unit_test(two_modes_of_one_frequency_stay_two),
        cmocka_unit_test(extra_lines_go_into_the_heading_and_harm_nothing),
        cmocka_unit_test(written_at_x_the_model_and_the_starts_are_those_of_x),
        cmocka_unit_test(what_lies_on_a_bound_is_still_a_deck),
        cmocka_unit_test(a_fit_runs_from_the_written_deck_to_where_it_stood),
        cmocka_unit_test(what_no_deck_can_say_is_refused),
        cmocka_unit_test(without_memory_nothing_is_written),
    };
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
