/* What a beam gets wrong at a step of the diameter: the figure that `check` and `identify` print, beside the solid itself. */
#include "support.h"

#include "folder.h"
#include "reading.h"
#include "run/run.h"

#define MODES 4

static void rotor_of(double ratio, double slender, const char *more, struct job *job)
{
    char text[1000];
    struct message_list messages;
    double d = 0.2, l = slender * d / 3;
    (void)snprintf(text, sizeof text,
                   "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                   "*MATERIAL, NAME=stack\n*ELASTIC, TYPE=LAMINATED\n1.6e11, 5.3e10, 2.1e11, 0.3\n*DENSITY\n7650\n"
                   "*SHAFT, NAME=left, MATERIAL=steel\n%.9g, %.9g, 0, 40\n*SHAFT, NAME=core, MATERIAL=stack\n%.9g, %.9g, 0, 40\n"
                   "*SHAFT, NAME=right, MATERIAL=steel\n%.9g, %.9g, 0, 40\n%s",
                   l, d / ratio, l, d, l, d / ratio, more);
    read_job(text, &messages, job);
}

static void frequencies(const struct job *job, struct spectrum *s)
{
    assert_status(
        spectrum_compute_parts(&test_pool, job->models, &job->rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, SPECTRUM_MESH, s),
        ROTID_OK);
}

UNIT_TEST(the_error_is_that_beside_the_solid)
{
    static const double table[][2] = {{1.3, 9}, {1.6, 5}, {1.6, 15}, {2, 9}, {3, 9}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct job beam, solid;
        struct spectrum b, s;
        double z, ratio, worst = 0;
        rotor_of(table[i][0], table[i][1], "", &beam);
        rotor_of(table[i][0], table[i][1], "*FIT, MODEL=SOLID\n", &solid);
        frequencies(&beam, &b);
        frequencies(&solid, &s);
        for (int j = 0; j < MODES; j++)
            worst = fmax(worst, b.full_hz[j] / s.full_hz[j] - 1);
        double told = rotor_step_error(&beam.rotor, &z, &ratio);
        print_message("1 : %g, length/D %g: beam %.2f %% above the solid, told %.2f %%\n", table[i][0], table[i][1], 100 * worst,
                      100 * told);
        assert_close(told, worst, 0.25, 0);
        assert_close(ratio, table[i][0], 1e-8, 0); /* nine digits in the deck */
        assert_non_null(strstr(doubt_steps(&test_pool, &beam), "MODEL=SOLID takes the same deck"));
        assert_null(doubt_steps(&test_pool, &solid));
    }
}

UNIT_TEST(a_rotor_that_is_even_or_repaired_is_not_doubted)
{
    struct job job;
    rotor_of(1, 9, "", &job);
    assert_null(doubt_steps(&test_pool, &job));
    rotor_of(1.6, 9, "*CAUSE, NAME=c, TYPE=step_stiffness\nangle, 40\n", &job);
    assert_null(doubt_steps(&test_pool, &job));
}

TEST_GROUP(folder_make, folder_remove);
