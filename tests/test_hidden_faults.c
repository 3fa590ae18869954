/* Faults of the data hidden in those of the paper's rotor (hidden.h): found by number, said in a sentence, not taken for physics.
 */
#include "support.h"

#include <unistd.h>

#include "hidden.h"

static const struct {
    const char *effect, *id;
    int sensor[2];
    double value, tolerance; /* 0: not looked at */
    const char *text;
} table[] = {
    {"sensor_gain:sensor=23,gain=1.4", "sensor_gain", {23}, 1.4, 0.14, "sensor 23 reads 1."},
    {"sensor_sign:sensor=5", "sensor_sign", {5}, 0, 0, "sensor 5 has the wrong sign"},
    {"sensor_swap:sensors=12+13", "sensor_swap", {12, 13}, 0, 0, "sensors 12 and 13 are exchanged"},
    {"sensor_position:sensor=40,shift=-0.3", "sensor_position", {40}, -0.3, 0.015, "further left than stated"},
    {"sensor_position:sensor=30,shift=0.06", "sensor_position", {30}, 0.06, 0.015, "mm further right than stated"},
    {"sensor_position:sensor=30,shift=-0.06", "sensor_position", {30}, -0.06, 0.015, "mm further left than stated"},
    {"sensor_line:flip=1", "sensor_line", {0}, 0, 0, "count from the other end; all of them"},
    {"sensor_line:shift=0.01,scale=0.99", "sensor_line", {0}, 0.01, 0.002, "their origin is off by +"},
    {"sensor_line:scale=0.98", "sensor_line", {0}, 0.98, 0.002, "times the stated ones; all of them"},
    {"duplicate_channel:sensor=7,of=6", "duplicate_channel", {7, 6}, 0, 0, "records what sensor"},
    {"mode_pairing:swap=2+3", "mode_pairing", {0}, 0, 0, "have their numbers exchanged"},
    {"mode_pairing:swap=5+6", "mode_pairing", {0}, 0, 0, "have their numbers exchanged"},
    {"noise_level:block=SHAPE,factor=2", "noise_level", {0}, 2, 0.3, "noise"},
    {"noise_level:block=SHAPE,factor=0.5", "noise_level", {0}, 0.5, 0.075, "noise"},
};

#define COUNT ((int)(sizeof table / sizeof *table))

struct seen { /* of one diagnosis, while it is there */
    int kind;
    int ncause, nfinding, sensor[2];
    char id[64], text[300];
    double value;
    int within; /* an interval */
};

static struct seen seen[COUNT];
static char directory[] = "/tmp/faults.XXXXXX";

static void look(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                 const struct hidden_score *score)
{
    struct seen *s = (struct seen *)context + c->number;
    (void)truth, (void)score;
    *s = (struct seen){.kind = d->result.verdict.kind, .ncause = d->ncause, .nfinding = d->result.ndata_findings};
    if (d->result.ndata_findings) {
        const rotid_data_finding *f = &d->result.data_findings[0];
        snprintf(s->id, sizeof s->id, "%s", f->id);
        snprintf(s->text, sizeof s->text, "%s", f->text);
        for (int i = 0; i < f->nsensors && i < 2; i++)
            s->sensor[i] = f->sensors[i];
        s->value = f->value;
        for (int p = 0; p < f->nparameters; p++) /* the size that is not as stated */
            if (isnan(s->value) && isfinite(f->parameters[p].std)) {
                s->value = f->parameters[p].value;
                s->within = f->parameters[p].ci95[0] < s->value && f->parameters[p].ci95[1] > s->value;
            }
    }
}

/* Whether the row is looked at in this run: the first of its kind, unless ROTID_LONG is set. */
static int is_run(int i)
{
    return getenv("ROTID_LONG") || !i || strcmp(table[i].id, table[i - 1].id) != 0;
}

static int run_one(void *deck, int i, int worker)
{
    struct hidden_case c = {.request = hide_request_default(), .directory = directory, .number = i};
    struct hidden_score score;
    (void)worker;
    if (!is_run(i))
        return 0;
    c.request.deck = deck;
    c.request.name = "input/paper_rotor.inp";
    c.request.seed = 1;
    c.request.effect = &table[i].effect;
    c.request.effects = 1;
    return hidden_run(&c, NULL, look, seen, &score);
}

static int run_all(void **state)
{
    char *deck = hidden_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp");
    (void)state;
    assert_non_null(deck);
    assert_non_null(mkdtemp(directory));
    int status = parallel_for(2, COUNT, run_one, deck);
    rmdir(directory);
    free(deck);
    return status;
}

UNIT_TEST(faults_are_found_by_number_and_not_taken_for_physics)
{
    for (int i = 0; i < COUNT; i++) {
        if (!is_run(i))
            continue;
        const int *expected = table[i].sensor, *sensor = seen[i].sensor;
        print_message("%s: %s\n", table[i].effect, seen[i].text);
        assert_int_equal(seen[i].kind, ROTID_ADEQUATE);
        assert_int_equal(seen[i].ncause, 0);
        assert_int_equal(seen[i].nfinding, 1);
        assert_string_equal(seen[i].id, table[i].id);
        assert_true(!expected[0] || sensor[0] == expected[0] || sensor[0] == expected[1]);
        assert_true(!expected[1] || sensor[1] == expected[0] || sensor[1] == expected[1]);
        if (table[i].tolerance > 0)
            assert_close(seen[i].value, table[i].value, 0, table[i].tolerance);
        if (table[i].tolerance > 0 && !strcmp(table[i].id, "sensor_line"))
            assert_true(seen[i].within);
    }
}

UNIT_TEST(the_sentence_says_what_was_found)
{
    for (int i = 0; i < COUNT; i++)
        if (is_run(i) && !strstr(seen[i].text, table[i].text))
            fail_msg("%s: '%s' lacks '%s'", table[i].effect, seen[i].text, table[i].text);
}

UNIT_TEST(a_line_has_to_stay_on_the_rotor)
{
    const double z[] = {0, 0.5, 1};
    assert_int_equal(sensor_line_fits(&(struct sensor_line){0, 0, 1}, 1, 3, z), 1);
    assert_int_equal(sensor_line_fits(&(struct sensor_line){1, 0, 1}, 1, 3, z), 1);
    assert_int_equal(sensor_line_fits(&(struct sensor_line){0, 0.019, 1}, 1, 3, z), 1); /* as well as a line is known */
    assert_int_equal(sensor_line_fits(&(struct sensor_line){0, 0.021, 1}, 1, 3, z), 0);
    assert_int_equal(sensor_line_fits(&(struct sensor_line){1, 0.021, 1}, 1, 3, z), 0);
    assert_int_equal(sensor_line_fits(&(struct sensor_line){0, 0, 1e-4}, 1, 3, z), 0); /* all on one place */
    assert_close(sensor_line_place(&(struct sensor_line){1, 0.1, 0.5}, 2, 0.4), 1.7, 1e-15, 0);
}

TEST_GROUP(run_all, NULL);
