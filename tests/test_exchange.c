/* Bearings of unequal stiffness on a symmetric bar: mirrored, it has the same frequencies, and the program says so. */
#include "support.h"

#include "fit/fit.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"

#define BAR   "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n1.0, 0.05, 0, 40\n"
#define MODES 6

TEST_GROUP(folder_make, folder_remove);

/* Frequencies of the bar on 5e6 and 2e6 N/m, at 0.1 m and at `second`, identified from 4e6 and 3e6 N/m; shapes at five points. */
static int says(const char *second, int shapes, double stiffness[2])
{
    struct message_list messages, notes;
    struct job job;
    struct state state;
    struct spectrum s;
    struct identification found;
    const char *sensors = "*SENSORS\n1, 0\n2, 0.2\n3, 0.45\n4, 0.7\n5, 0.9\n6, 0.05\n7, 0.3\n8, 0.55\n9, 0.6\n10, 1\n";
    read_job(pool_format(&test_pool, BAR "*SPRING, NAME=a\n0.1, 5e6\n*SPRING, NAME=b\n%s, 2e6\n%s*MODES, COUNT=ALL\n1, 60\n",
                         second, sensors),
             &messages, &job);
    assert_status(spectrum_compute(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, &s), ROTID_OK);
    const char *deck = pool_format(&test_pool,
                                   BAR "*SPRING, NAME=a\n0.1, 4e6\n*SPRING, NAME=b\n%s, 3e6\n*NOISE, FREQUENCY=1e-4, SHAPE=0.01\n"
                                       "*IDENTIFY\nbar.E, 1e11, 4e11, 2e11\na.k, 1e5, 1e8, 4e6\nb.k, 1e5, 1e8, 3e6\n*MODES, "
                                       "COUNT=ALL\n",
                                   second);
    for (int k = 0; k < MODES; k++)
        deck = pool_format(&test_pool, "%s%d, %.9g\n", deck, k + 1, s.full_hz[k]);
    deck = shapes ? pool_format(&test_pool, "%s%s*SHAPE, MODE=1\n", deck, sensors) : deck;
    for (int i = 0; i < s.nmaster && shapes; i++)
        deck = pool_format(&test_pool, "%s%d, %.6g\n", deck, job.rotor.sensor[i].id, s.shape[i]);
    read_job(deck, &messages, &job);
    message_open(&notes, &test_pool);
    assert_status(identify_run(&test_pool, &job, 0, NULL, &notes, &found), ROTID_OK);
    message_open(&notes, &test_pool);
    struct states one = states_of(&job, &state);
    assert_status(exchange_warn(&test_pool, &one, &found, found.fit, NULL, &notes), ROTID_OK);
    stiffness[0] = found.fit->x[1];
    stiffness[1] = found.fit->x[2];
    rotid_fit_free(found.fit);
    return find_message(&notes, "a.k and b.k fit as well if they are exchanged") != NULL;
}

POOL_TEST(frequencies_do_not_tell_the_ends_of_a_symmetric_rotor)
{
    double k[2];
    assert_true(says("0.9", 0, k));
    assert_close(k[0] * k[1], 1e13, 1e-2, 0); /* the one or the other */
    assert_false(says("0.8", 0, k));
    assert_close(k[0], 5e6, 1e-2, 0);
    assert_close(k[1], 2e6, 1e-2, 0);
    assert_false(says("0.9", 1, k)); /* a shape tells */
    assert_close(k[0], 5e6, 1e-2, 0);
}
