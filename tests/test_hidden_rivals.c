/* Effects strong enough to look like faults of the data, and both at once (hidden.h): sound channels, noise and modes are not
 * accused, and what is at fault is found beside the effect. */
#include "support.h"

#include <unistd.h>

#include "hidden.h"

#define MOST 2

static const struct {
    const char *deck;
    int sensors, modes;
    unsigned seed;
    double frequency_noise, shape_noise;
    int effects;
    const char *effect[MOST];
    const char *named, *found; /* NULL: nothing */
    int sensor;
} table[] = {
    /* before any fit the second-order part of the effect looks like noise of 1.8 times the stated one */
    {"input/paper_rotor.inp",
     20,
     6,
     1,
     0.001,
     0.015,
     1,
     {"stiffness_local:depth=0.93,z=1.2,width=0.05"},
     "stiffness_local",
     NULL,
     0},
    /* beside the model without it mode 7 looks like none, and mode 8 like 7 */
    {"tests/data/supported_rotor.inp",
     20,
     8,
     7020,
     0.0006,
     0.01,
     1,
     {"stiffness_local:depth=0.9341,z=1.3128,width=0.053457"},
     "stiffness_local",
     NULL,
     0},
    {"input/paper_rotor.inp",
     20,
     6,
     2,
     0.001,
     0.015,
     2,
     {"stiffness_local:depth=0.8,z=1.0,width=0.05", "sensor_gain:sensor=7,gain=1.3"},
     "stiffness_local",
     "sensor_gain",
     7},
    /* a bad fit, and three modes */
    {"input/paper_rotor.inp",
     12,
     3,
     3,
     0.001,
     0.015,
     2,
     {"stiffness_local:depth=0.8,z=1.0,width=0.05", "duplicate_channel:sensor=9,of=8"},
     NULL,
     "duplicate_channel",
     9},
};

#define COUNT ((int)(sizeof table / sizeof *table))

static struct seen { /* of one diagnosis */
    int ncause, nfinding, sensor;
    char named[64], found[64];
} seen[COUNT];
static char directory[] = "/tmp/rivals.XXXXXX";

static void look(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                 const struct hidden_score *score)
{
    struct seen *s = (struct seen *)context + c->number;
    (void)truth, (void)score;
    *s = (struct seen){.ncause = d->ncause, .nfinding = d->result.ndata_findings};
    if (d->ncause)
        snprintf(s->named, sizeof s->named, "%s", d->cause[0].cause->id);
    if (d->result.ndata_findings) {
        const rotid_data_finding *f = &d->result.data_findings[0];
        snprintf(s->found, sizeof s->found, "%s", f->id);
        s->sensor = f->nsensors ? f->sensors[0] : 0;
    }
}

static int run_one(void *context, int i, int worker)
{
    char path[512];
    struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
    struct hidden_score score;
    const char *effect[MOST] = {table[i].effect[0], table[i].effect[1]};
    (void)context, (void)worker;
    (void)snprintf(path, sizeof path, ROTID_SOURCE_DIR "/%s", table[i].deck);
    char *deck = hidden_read(path);
    c.request.deck = deck;
    c.request.name = table[i].deck;
    c.request.seed = table[i].seed;
    c.request.sensors = table[i].sensors;
    c.request.modes = table[i].modes;
    c.request.frequency_noise = table[i].frequency_noise;
    c.request.shape_noise = table[i].shape_noise;
    c.request.effect = effect;
    c.request.effects = table[i].effects;
    int status = deck ? hidden_run(&c, NULL, look, seen, &score) : -1;
    free(deck);
    return status;
}

static int run_all(void **state)
{
    (void)state;
    assert_non_null(mkdtemp(directory));
    int status = parallel_for(2, COUNT, run_one, NULL);
    rmdir(directory);
    return status;
}

UNIT_TEST(the_effect_is_named_and_what_is_sound_not_accused)
{
    for (int i = 0; i < COUNT; i++) {
        print_message("%s: named '%s', found '%s' of %d\n", table[i].effect[0], seen[i].named, seen[i].found, seen[i].sensor);
        if (table[i].named) {
            assert_int_equal(seen[i].ncause, 1);
            assert_string_equal(seen[i].named, table[i].named);
        }
        assert_int_equal(seen[i].nfinding, table[i].found != NULL);
        assert_string_equal(seen[i].found, table[i].found ? table[i].found : "");
        assert_int_equal(seen[i].sensor, table[i].sensor);
    }
}

TEST_GROUP(run_all, NULL);
