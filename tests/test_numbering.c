/* From which mode measured ones are counted, and numbers that are wrong. */
#include "support.h"

#include "fit/fit.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"

#define BAR     "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n1.0, 0.05, 0, 40\n"
#define ON(K)   "*SPRING, NAME=a\n0.1, " K "\n*SPRING, NAME=b\n0.9, " K "\n"
#define AS_SEEN "1, 88.59\n2, 136.92\n3, 256.07\n4, 624.60\n"
#define FIND    "*NOISE, FREQUENCY=0.002\n*IDENTIFY\nbar.E, 1e11, 4e11, 1.8e11\na.k, 1e5, 1e8, 2e6\n"

static struct job job_of(const char *text, struct message_list *messages)
{
    struct job job;
    read_job(text, messages, &job);
    return job;
}

static struct identification fitted(const struct job *job)
{
    struct identification found;
    struct message_list notes;
    message_open(&notes, &test_pool);
    assert_status(identify_run(&test_pool, job, 0, NULL, &notes, &found), ROTID_OK);
    return found;
}

/* Springs of 3e6 N/m at 0.1 and 0.9 m: the first two are the rotor on its bearings, and tell their stiffness. */
UNIT_TEST(modes_of_bearings_are_counted_where_they_were_measured)
{
    struct message_list messages;
    struct job job = job_of(BAR ON("3e6") "*MODES\n" AS_SEEN FIND, &messages);
    assert_true(job.rotor.count_all);
    assert_non_null(find_message(&messages, "modes are counted from the lowest vibration on the supports (COUNT=ALL)"));
    struct identification found = fitted(&job);
    assert_close(found.fit->x[0], 2.1e11, 2e-3, 0);
    assert_close(found.fit->x[1], 3e6, 5e-3, 0);
    rotid_fit_free(found.fit);
}

UNIT_TEST(what_the_deck_states_is_not_doubted)
{
    struct message_list messages;
    struct job job = job_of(BAR ON("3e6") "*MODES, COUNT=ELASTIC\n" AS_SEEN, &messages);
    assert_false(job.rotor.count_all);
    assert_int_equal(job.measurement.numbering.nsupport, 2);
    assert_int_equal(messages.count, 0);
    job = job_of(BAR ON("3e6") "*MODES, COUNT=ALL\n1, 256\n2, 624\n", &messages);
    assert_true(job.rotor.count_all);
}

/* Modes above those of the supports, numbered as bending modes: as ever, without a word. */
UNIT_TEST(bending_modes_are_counted_as_such)
{
    struct message_list messages;
    struct job job =
        job_of(BAR ON("3e6") "*MODES\n1, 256.07\n2, 624.60\n*FIT, HOLDOUT=2\n*IDENTIFY\nbar.E, 1e11, 4e11, 2e11\n", &messages);
    assert_false(job.rotor.count_all);
    assert_int_equal(messages.count, 0);
    struct identification found = fitted(&job);
    assert_close(found.fit->predicted_hz[1], 624.6, 2e-3, 0); /* left out, by the same numbers */
    rotid_fit_free(found.fit);
}

/* A rotor on springs of 300 N/m to 0.3 MN/m, five modes with 0.1 % of noise: those on the springs are computed to five digits or
 * fewer, and the fit ends none the less, near the truth. */
UNIT_TEST(soft_springs_leave_a_minimum)
{
    for (int i = 0; i < 24; i++) {
        struct message_list messages;
        struct spectrum s;
        const char *rotor =
            pool_format(&test_pool,
                        "*MATERIAL, NAME=m\n*ELASTIC\n1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=m\n"
                        "0.6, 0.2\n*SHAFT, NAME=core, MATERIAL=m\n0.8, 0.4\n*SHAFT, NAME=b, MATERIAL=m\n0.6, 0.2\n"
                        "*SPRING\n0.2, %g\n1.8, %g\n*MODES, COUNT=ALL\n",
                        300 * pow(2, i % 11), 300 * pow(2, i % 11));
        struct job job = job_of(pool_format(&test_pool, "%s1, 1\n2, 2\n3, 400\n4, 800\n5, 1500\n", rotor), &messages);
        assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_NONE, 5, &s), ROTID_OK);
        const char *modes = "";
        for (int k = 0; k < 5; k++)
            modes = pool_format(&test_pool, "%s%d, %.12g\n", modes, k + 1,
                                s.full_hz[k] * (1 + 1e-3 * sqrt(2) * sin(5.0 * i * i + 3 * k)));
        job =
            job_of(pool_format(&test_pool, "%s%s*NOISE, FREQUENCY=0.001\n*IDENTIFY\ncore.E, 2e10, 4e11, 1.3e11\n", rotor, modes),
                   &messages);
        struct identification found = fitted(&job);
        assert_true(found.fit->converged);
        assert_close(found.fit->x[0], 1e11, 0.02, 0);
        rotid_fit_free(found.fit);
    }
}

/* One frequency between two: both numberings are as far off, and the user is asked. */
UNIT_TEST(where_both_fit_the_user_is_asked)
{
    struct message_list messages;
    struct job job = job_of(BAR ON("3e6") "*MODES\n1, 150\n", &messages);
    assert_false(job.rotor.count_all);
    assert_non_null(find_message(&messages, "state COUNT=ELASTIC or ALL"));
}

/* A rigid mass on two springs has sqrt(2 k/m) as its first mode; one that is free has no frequency to count. */
UNIT_TEST(modes_at_rest_are_never_counted)
{
    struct message_list messages;
    struct spectrum s;
    struct job job = job_of(BAR ON("1000") "*MODES, COUNT=ALL\n1, 1.8\n", &messages);
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 3, &s), ROTID_OK);
    assert_int_equal(s.nrigid, 0);
    assert_close(s.full_hz[0], sqrt(2000 / (7850 * PI * 0.05 * 0.05 / 4)) / (2 * PI), 1e-4, 0);
    job = job_of(BAR "*MODES, COUNT=ALL\n1, 228.7\n", &messages);
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &s), ROTID_OK);
    assert_int_equal(s.nrigid, 2);
    assert_close(s.full_hz[0], 228.7, 1e-3, 0);
    job = job_of(BAR "*SPRING\n0.5, 1000\n*MODES, COUNT=ALL\n1, 1.3\n", &messages); /* it may still turn */
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &s), ROTID_OK);
    assert_int_equal(s.nrigid, 1);
    assert_close(s.full_hz[0], sqrt(1000 / (7850 * PI * 0.05 * 0.05 / 4)) / (2 * PI), 1e-4, 0);
}

/* The tension of rods and the pressure between their ends do no work in a rigid motion, but for rounding, which grows with the
 * stiffness of short elements and is no support. */
UNIT_TEST(balanced_axial_forces_are_no_support)
{
    struct message_list messages;
    struct spectrum s;
    for (int i = 0; i < 12; i++) {
        struct job job =
            job_of(pool_format(&test_pool,
                               "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                               "*SHAFT, NAME=core, MATERIAL=steel\n%g, 0.05, 0, %d\n"
                               "*SHAFT, NAME=end, MATERIAL=steel\n1, 0.01, 0, 100\n*TIEROD, NAME=t, MATERIAL=steel, "
                               "FROM=core.start, TO=core.end, MODEL=%s\n3, 0.004, 0.04, %g\n"
                               "*MODES, COUNT=ALL\n1, 31\n",
                               i % 2 ? 0.05 : 0.1, i % 3 ? 100 : 200, i % 4 < 2 ? "TUBE" : "RODS", i < 6 ? 12000.0 : -12000.0),
                   &messages);
        assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_REDUCTION_NONE, 1, &s), ROTID_OK);
        assert_int_equal(s.nrigid, 2);
        assert_true(s.full_hz[0] > 20);
    }
}

/* A state on bearings and a free one, each with its own count. */
UNIT_TEST(states_count_for_themselves)
{
    struct states s =
        read_states(BAR "*STATE, NAME=free\n*MODES\n1, 228.7\n2, 622.9\n*STATE, NAME=seated\n" ON("3e6") "*MODES\n" AS_SEEN);
    assert_false(s.state[0].job.rotor.count_all);
    assert_true(s.state[1].job.rotor.count_all);
}

/* In kHz the same modes have the same numbers, on bearings and in cords, and the unit is told. */
UNIT_TEST(a_wrong_unit_changes_no_numbers)
{
    struct message_list messages;
    struct job job = job_of(BAR ON("3e6") "*MODES\n1, 0.08859\n2, 0.13692\n3, 0.25607\n4, 0.62460\n" FIND, &messages);
    assert_true(job.rotor.count_all);
    job = job_of(BAR ON("2000") "*MODES\n1, 0.2287\n2, 0.6229\n" FIND, &messages);
    assert_false(job.rotor.count_all);
    struct identification found;
    struct message_list notes;
    message_open(&notes, &test_pool);
    assert_status(identify_run(&test_pool, &job, 0, NULL, &notes, &found), ROTID_OK);
    assert_non_null(find_message(&notes, "frequencies in kHz?"));
    rotid_fit_free(found.fit);
    job = job_of(BAR ON("2000") "*MODES\n1, 228.7\n" FIND, &messages); /* far above the cords, which is no unit */
    assert_false(job.rotor.count_all);
    assert_int_equal(messages.count, 0);
}

/* A slender cantilever: w = 1.8751^2 sqrt(EI/(rho A L^4)); the clamp is stiff to 1e-6. */
UNIT_TEST(a_clamped_end_is_clamped)
{
    struct message_list messages;
    struct spectrum s;
    struct job job = job_of("*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
                            "1.0, 0.005, 0, 40\n*CLAMP, AT=start\n",
                            &messages);
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 2, &s), ROTID_OK);
    double root = sqrt(2.1e11 / 7850) * 0.005 / 4 / (2 * PI); /* radius of gyration d/4 */
    assert_close(s.full_hz[0], 1.87510407 * 1.87510407 * root, 1e-4, 0);
    assert_close(s.full_hz[1], 4.69409113 * 4.69409113 * root, 2e-4, 0);
}

#define DISKS                                                                                                                    \
    BAR "*DISK, NAME=d\n0.3, 4, 0.02\n*DISK, NAME=e\n0.75, 6, 0.03\n*NOISE, FREQUENCY=0.002\n*IDENTIFY\nbar.E, 1e11, 4e11, "     \
        "3.4e11\n"
#define MISSED 5

/* E begins 1.6 times too high. The frequencies of the model without its fifth are numbered from 1 on; in one deck, and in a state
 * beside another one. */
UNIT_TEST(a_mode_that_was_missed_is_told)
{
    char text[2000], modes[400];
    struct message_list messages, notes;
    struct spectrum s;
    size_t used = 0;
    struct job job = job_of(DISKS "*MODES\n1, 190\n", &messages);
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 6, &s), ROTID_OK);
    for (int j = 1, k = 1; j <= 6; j++)
        if (j != MISSED)
            used += (size_t)snprintf(modes + used, sizeof modes - used, "%d, %.6f\n", k++, s.full_hz[j - 1]);
    for (int with_state = 0; with_state < 2; with_state++) {
        if (with_state)
            (void)snprintf(text, sizeof text, DISKS "*STATE, NAME=b\n*MODES\n1, %.6f\n*STATE, NAME=a\n*MODES\n%s", s.full_hz[0],
                           modes);
        else
            (void)snprintf(text, sizeof text, DISKS "*MODES\n%s", modes);
        struct states states = read_states(text);
        struct identification found[2];
        rotid_fit_result *fit;
        struct renumbering best;
        int number[] = {1, 1, 2, 3, 4, 5}, holdout[6] = {0}, *first = number + !with_state;
        message_open(&notes, &test_pool);
        assert_status(numbering_search(&test_pool, &states, first, holdout, NULL, &best), ROTID_OK);
        assert_int_equal(best.state, with_state);
        assert_int_equal(best.from, MISSED - 1);
        assert_int_equal(best.shift, 1);
        assert_int_equal(best.number[with_state + 4], 6);
        assert_true(best.chi2 < 1e-3);
        assert_status(identify_states(&test_pool, &states, 0, NULL, &notes, found, &fit), ROTID_OK);
        assert_status(numbering_warn(&test_pool, &states, found, fit, NULL, &notes), ROTID_OK);
        assert_non_null(find_message(&notes, with_state ? "of state a on the numbers are 1 too low: modes were missed below it"
                                                        : "on the numbers are 1 too low: modes were missed below it"));
        rotid_fit_free(fit);
    }
}

/* Numbers that are right are not doubted, nor errors that no numbering mends. */
UNIT_TEST(right_numbers_are_not_doubted)
{
    struct message_list messages, notes;
    struct state one;
    struct job job =
        job_of(BAR "*MODES\n1, 228.7\n2, 640\n3, 1170\n4, 1943\n*NOISE, FREQUENCY=0.002\n*IDENTIFY\nbar.E, 1e11, 4e11, 1.8e11\n",
               &messages);
    struct identification found = fitted(&job);
    const struct states states = states_of(&job, &one);
    message_open(&notes, &test_pool);
    assert_true(chi_square_tail(found.fit->chi2, found.fit->dof) < 1e-3);
    assert_status(numbering_warn(&test_pool, &states, &found, found.fit, NULL, &notes), ROTID_OK);
    assert_int_equal(notes.count, 0);
    struct renumbering best;
    const int holdout[4] = {0};
    assert_status(numbering_search(&test_pool, &states, found.compared.number, holdout, NULL, &best), ROTID_OK);
    assert_int_equal(best.shift, 0); /* no other numbering is worth a fit */
    rotid_fit_free(found.fit);
}

/* 45 % of the way, in ln f, from mode k + 1 of a free bar to mode k: one higher fits by 0.45/0.55 of the misfit, which tells
 * nothing. */
UNIT_TEST(numbers_that_fit_a_little_better_are_no_better)
{
    static const double ratio[] = {1, 2.757, 5.404, 8.933, 13.344};
    char text[1000];
    struct message_list messages, notes;
    struct state one;
    size_t used =
        (size_t)snprintf(text, sizeof text, BAR "*NOISE, FREQUENCY=0.002\n*IDENTIFY\nbar.E, 5e10, 8e11, 1.8e11\n*MODES\n");
    for (int k = 0; k < 4; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%d, %.6f\n", k + 1,
                                 230 * pow(ratio[k], 0.35) * pow(ratio[k + 1], 0.65));
    struct job job = job_of(text, &messages);
    struct identification found = fitted(&job);
    const struct states states = states_of(&job, &one);
    struct renumbering best;
    const int holdout[4] = {0};
    assert_status(numbering_search(&test_pool, &states, found.compared.number, holdout, NULL, &best), ROTID_OK);
    assert_int_equal(best.shift, 1);
    assert_true(best.chi2 < found.fit->chi2);
    message_open(&notes, &test_pool);
    assert_status(numbering_warn(&test_pool, &states, &found, found.fit, NULL, &notes), ROTID_OK);
    assert_int_equal(notes.count, 0);
    rotid_fit_free(found.fit);
}

TEST_GROUP(folder_make, folder_remove);
