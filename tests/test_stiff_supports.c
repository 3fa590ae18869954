/* Diagnoses of random rotors on supports from stiff to rigid: the overhangs on both sides of them are then nearly two rotors, and
 * where they are alike their modes come in pairs of nearly one frequency. None of that ends a diagnosis. */
#include "support.h"

#include <unistd.h>

#include "hidden.h"

#define JOBS 2

static const struct {
    uint64_t seed;
    int symmetric;
    double stiffness, rotational; /* N/m; N m/rad */
    const char *effect;
} table[] = {
    {1, 1, 1e12, 1e12, NULL},
    {2, 1, 1e12, 1e12, "joint:at=core.end,flexibility=1e-9"},
    {4, 1, 1e12, 1e12, NULL},
    {6, 1, 1e12, 1e12, "step_stiffness:angle=40"},
    {9, 1, 1e12, 1e12, "stiffness:group=left,factor=1.1"},
    {3, 1, 1e11, 0, "step_stiffness:angle=40"},
    {5, 0, 1e8, 0, "joint:at=core.end,flexibility=1e-9"},
};

#define COUNT ((int)(sizeof table / sizeof *table))

static char directory[] = "/tmp/stiff.XXXXXX";

static double between(struct random_stream *stream, double low, double high)
{
    return low + (high - low) * random_uniform(stream);
}

/* One to three diameters on either side of a core, in reverse order on the right where it is symmetric; springs where the core
 * ends, 41 sensors along it. */
static void write_rotor(int i, char *text, size_t room)
{
    struct random_stream stream = {table[i].seed};
    double length[2][3], diameter[2][3], core[2];
    int count[2], used = 0;
    for (int side = 0; side < 2; side++) {
        count[side] = 1 + (int)between(&stream, 0, 3);
        for (int s = 0; s < 3; s++) {
            length[side][s] = between(&stream, 0.12, 0.3);
            diameter[side][s] = between(&stream, 0.08, 0.16);
        }
    }
    core[0] = between(&stream, 0.4, 0.9);
    core[1] = between(&stream, 0.2, 0.36);
    used = snprintf(text, room,
                    "*HEADING\nrandom rotor on stiff supports\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                    "*MATERIAL, NAME=lamination\n*ELASTIC, TYPE=SHEAR\n1.0e11, 0.35e11, 0.28\n*DENSITY\n7650\n");
    for (int group = 0; group < 3; group++) {
        static const char *const name[] = {"left, MATERIAL=steel", "core, MATERIAL=lamination", "right, MATERIAL=steel"};
        int from = group == 2 && !table[i].symmetric, segments = group == 1 ? 1 : count[from];
        used += snprintf(text + used, room - (size_t)used, "*SHAFT, NAME=%s\n", name[group]);
        for (int s = 0; s < segments; s++) {
            int at = group == 2 && table[i].symmetric ? segments - 1 - s : s;
            double l = group == 1 ? core[0] : length[from][at], d = group == 1 ? core[1] : diameter[from][at];
            used += snprintf(text + used, room - (size_t)used, "%.3f, %.3f, 0, %d\n", l, d, 1 + (int)(l / 0.02));
        }
    }
    (void)snprintf(text + used, room - (size_t)used,
                   "*SPRING\nleft.end, %g, %g\ncore.end, %g, %g\n*SENSORS\n1, start\n2, end\n*IDENTIFY\n"
                   "core.E, 2e10, 2.5e11, 1.0e11\ncore.G, 5e9, 1e11, 0.35e11\n",
                   table[i].stiffness, table[i].rotational, table[i].stiffness, table[i].rotational);
}

static struct hidden_score score[COUNT];

static int run_one(void *context, int i, int worker)
{
    char deck[4000];
    const char *effect[1] = {table[i].effect};
    struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
    (void)context;
    (void)worker;
    write_rotor(i, deck, sizeof deck);
    c.request.deck = deck;
    c.request.name = "rotor.inp";
    c.request.seed = table[i].seed;
    c.request.sensors = 41;
    c.request.effect = effect;
    c.request.effects = effect[0] != NULL;
    return hidden_run(&c, NULL, NULL, NULL, &score[i]);
}

UNIT_TEST(close_pairs_end_no_diagnosis)
{
    int failed = 0;
    assert_non_null(mkdtemp(directory));
    assert_int_equal(parallel_for(JOBS, COUNT, run_one, NULL), 0);
    assert_int_equal(rmdir(directory), 0);
    for (int i = 0; i < COUNT; i++) {
        print_message("seed %d, %s, springs %.0e and %.0e, %s: %s%s%s\n", (int)table[i].seed,
                      table[i].symmetric ? "symmetric" : "not", table[i].stiffness, table[i].rotational,
                      table[i].effect ? table[i].effect : "nothing", hidden_outcome_name(score[i].outcome),
                      score[i].failure[0] ? ": " : "", score[i].failure);
        failed += score[i].outcome == HIDDEN_FAILED;
    }
    assert_int_equal(failed, 0);
}
