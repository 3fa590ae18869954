/* hide: writes a deck with measured data that hide an effect, and the truth beside it. See hide.h. */
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hide.h"
#include "hide_text.h"

static const char usage[] =
    "usage: hide DECK -o OUT.inp --truth TRUTH.json [options]\n"
    "  --seed N                     of everything that is drawn (1)\n"
    "  --modes N                    elastic modes from 1 (6)\n"
    "  --sensors N                  evenly spaced from end to end, in place of those of the deck\n"
    "  --half-sensors               every second sensor\n"
    "  --no-shapes                  frequencies alone\n"
    "  --frequency-noise X          relative standard deviation (0.001)\n"
    "  --shape-noise X              the same, of the largest component (0.015)\n"
    "  --state-frequency-noise X    what the deck states (the true one)\n"
    "  --state-shape-noise X\n"
    "  --correlated RHO             shape noise correlated along the rotor, RHO between neighbours\n"
    "  --true NAME=VALUE            true value of a parameter of *IDENTIFY (drawn within 15 % of the deck's); may be repeated\n"
    "  --effect SPEC                id[:key=value,...] of --list; may be repeated\n"
    "  --effect-in NAME=SPEC        in that state of a deck with *STATE alone; may be repeated\n"
    "  --random KIND                draws: none, an id of --list, physical, data, outside, pair, any\n"
    "  --refine N                   begins with varying stiffness cut N times finer than usual (1)\n"
    "  --list, --help\n"
    "Exit code: 0 done, 2 wrong usage or input, 3 a file or memory.\n";

enum {
    OPTION_TRUTH = 256,
    OPTION_SEED,
    OPTION_MODES,
    OPTION_SENSORS,
    OPTION_HALF,
    OPTION_NO_SHAPES,
    OPTION_FREQUENCY,
    OPTION_SHAPE,
    OPTION_STATE_FREQUENCY,
    OPTION_STATE_SHAPE,
    OPTION_CORRELATED,
    OPTION_TRUE,
    OPTION_EFFECT,
    OPTION_EFFECT_IN,
    OPTION_RANDOM,
    OPTION_REFINE,
    OPTION_LIST,
    OPTION_HELP
};

static const struct option options[] = {{"truth", 1, NULL, OPTION_TRUTH},
                                        {"seed", 1, NULL, OPTION_SEED},
                                        {"modes", 1, NULL, OPTION_MODES},
                                        {"sensors", 1, NULL, OPTION_SENSORS},
                                        {"half-sensors", 0, NULL, OPTION_HALF},
                                        {"no-shapes", 0, NULL, OPTION_NO_SHAPES},
                                        {"frequency-noise", 1, NULL, OPTION_FREQUENCY},
                                        {"shape-noise", 1, NULL, OPTION_SHAPE},
                                        {"state-frequency-noise", 1, NULL, OPTION_STATE_FREQUENCY},
                                        {"state-shape-noise", 1, NULL, OPTION_STATE_SHAPE},
                                        {"correlated", 1, NULL, OPTION_CORRELATED},
                                        {"true", 1, NULL, OPTION_TRUE},
                                        {"effect", 1, NULL, OPTION_EFFECT},
                                        {"effect-in", 1, NULL, OPTION_EFFECT_IN},
                                        {"random", 1, NULL, OPTION_RANDOM},
                                        {"refine", 1, NULL, OPTION_REFINE},
                                        {"list", 0, NULL, OPTION_LIST},
                                        {"help", 0, NULL, OPTION_HELP},
                                        {NULL, 0, NULL, 0}};

struct command {
    struct hide_request request;
    const char *out, *truth;
    const char **effect, **effect_in, **true_value; /* [argc] */
    int list, help;
};

static int wrong(const char *what, const char *value)
{
    fprintf(stderr, "hide: %s %s\n", what, value);
    return 1;
}

static int number(const char *text, double *value)
{
    return hide_read_number(text, value) ? 0 : wrong("expected a number, not", text);
}

static int integer(const char *text, int *value)
{
    double d;
    if (!hide_read_number(text, &d) || d != floor(d) || fabs(d) > 1e6)
        return wrong("expected an integer, not", text);
    *value = (int)d;
    return 0;
}

static int seed(const char *text, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return end == text || *end || errno || *text == '-' ? wrong("expected an integer not below zero, not", text) : 0;
}

static int take(int option, struct command *c)
{
    struct hide_request *r = &c->request;
    switch (option) {
    case 'o':
        c->out = optarg;
        return 0;
    case OPTION_TRUTH:
        c->truth = optarg;
        return 0;
    case OPTION_SEED:
        return seed(optarg, &r->seed);
    case OPTION_MODES:
        return integer(optarg, &r->modes);
    case OPTION_SENSORS:
        return integer(optarg, &r->sensors) || (r->sensors < 2 && wrong("expected 2 sensors or more, not", optarg));
    case OPTION_HALF:
        return (r->half_sensors = 1) - 1;
    case OPTION_NO_SHAPES:
        return (r->no_shapes = 1) - 1;
    case OPTION_FREQUENCY:
        return number(optarg, &r->frequency_noise);
    case OPTION_SHAPE:
        return number(optarg, &r->shape_noise);
    case OPTION_STATE_FREQUENCY:
        return number(optarg, &r->stated_frequency_noise);
    case OPTION_STATE_SHAPE:
        return number(optarg, &r->stated_shape_noise);
    case OPTION_CORRELATED:
        return number(optarg, &r->correlation);
    case OPTION_TRUE:
        c->true_value[r->truths++] = optarg;
        return 0;
    case OPTION_EFFECT:
        c->effect[r->effects++] = optarg;
        return 0;
    case OPTION_EFFECT_IN:
        c->effect_in[r->effects_in++] = optarg;
        return 0;
    case OPTION_RANDOM:
        r->random = optarg;
        return 0;
    case OPTION_REFINE:
        return integer(optarg, &r->refine);
    case OPTION_LIST:
        return (c->list = 1) - 1;
    case OPTION_HELP:
        return (c->help = 1) - 1;
    default:
        return 1; /* getopt has said why */
    }
}

/* Under a temporary name beside the final one, so that the file is whole or not there. */
static int write_file(const char *path, const char *content)
{
    struct hide_text name = {NULL, 0, 0, 0};
    hide_add(&name, "%s.new", path);
    FILE *file = name.failed ? NULL : fopen(name.data, "wb");
    int bad = !file || fputs(content, file) < 0;
    if (file)
        bad |= fclose(file) != 0;
    if (!bad)
        bad = rename(name.data, path) != 0;
    if (bad)
        fprintf(stderr, "hide: %s: %s\n", path, strerror(errno));
    if (bad && file)
        remove(name.data);
    free(name.data);
    return bad ? HIDE_FAILURE : HIDE_OK;
}

static int run(struct command *c)
{
    char message[600], *text = hide_read_file("hide", c->request.name, ""), *deck = NULL, *truth = NULL;
    int status;
    if (!text)
        return HIDE_FAILURE;
    c->request.deck = text;
    status = hide_case(&c->request, &deck, &truth, message, sizeof message);
    if (status)
        fprintf(stderr, "hide: %s\n", message);
    if (!status)
        status = write_file(c->truth, truth);
    if (!status)
        status = write_file(c->out, deck);
    free(text);
    free(deck);
    free(truth);
    return status;
}

static int list(void)
{
    char *text = hide_list();
    int bad = !text || fputs(text, stdout) < 0;
    free(text);
    return bad ? HIDE_FAILURE : HIDE_OK;
}

int main(int argc, char **argv)
{
    struct command c = {.request = hide_request_default()};
    int option, status = HIDE_OK;
    c.effect = calloc((size_t)argc + 1, sizeof *c.effect);
    c.true_value = calloc((size_t)argc + 1, sizeof *c.true_value);
    c.effect_in = calloc((size_t)argc + 1, sizeof *c.effect_in);
    if (!c.effect || !c.effect_in || !c.true_value)
        status = HIDE_FAILURE;
    while (!status && (option = getopt_long(argc, argv, "o:", options, NULL)) != -1)
        status = take(option, &c) ? HIDE_INPUT : HIDE_OK;
    c.request.effect = c.effect;
    c.request.effect_in = c.effect_in;
    c.request.truth = c.true_value;
    if (status == HIDE_INPUT || (!status && !c.help && !c.list && (optind + 1 != argc || !c.out || !c.truth))) {
        fputs(usage, stderr);
        status = HIDE_INPUT;
    } else if (!status && c.help)
        fputs(usage, stdout);
    else if (!status && c.list)
        status = list();
    else if (!status) {
        c.request.name = argv[optind];
        status = run(&c);
    }
    free(c.effect);
    free(c.effect_in);
    free(c.true_value);
    return status;
}
