/* The mixture of cases. */
#include <stdio.h>

#include "hide/hide_random.h"
#include "power.h"

/* Shares of what is hidden; the rest lies outside the catalogue. */
#define PHYSICAL 0.60
#define NOTHING  0.10
#define DATA     0.06
#define NOISE    0.04 /* stated wrongly: of frequencies, of shapes, or correlated along the rotor */
#define PAIR     0.12

#define NO_SHAPES 0.2

static void draw_noise(struct hide_random *random, struct power_case *c)
{
    struct hide_request *r = &c->hidden.request;
    int kind = hide_pick(random, r->no_shapes ? 2 : 5);
    const char *factor = hide_pick(random, 2) ? "2" : "0.5";
    if (kind == 4) {
        r->random = "none";
        r->correlation = 0.7;
        return;
    }
    snprintf(c->effect, sizeof c->effect, "noise_level:block=%s,factor=%s", kind < 2 ? "FREQUENCY" : "SHAPE", factor);
    c->list = c->effect;
    r->effect = &c->list;
    r->effects = 1;
}

int power_draw(const struct power_options *options, int number, struct power_case *c)
{
    struct hide_request *r = &c->hidden.request;
    struct hide_random random;
    *c = (struct power_case){.hidden = {.request = hide_request_default(), .number = number}};
    r->seed = options->seed * 1000000 + (uint64_t)number;
    r->deck = c->deck = power_rotor(r->seed);
    r->name = "rotor";
    hide_random_open(r->seed, HIDE_FOR_CASE, &random);
    r->modes = 4 + hide_pick(&random, 5);
    r->no_shapes = hide_uniform(&random) < NO_SHAPES;
    r->frequency_noise = hide_log_between(&random, 1e-4, 1e-2);
    r->shape_noise = hide_log_between(&random, 5e-3, 5e-2);
    double kind = hide_uniform(&random);
    if (options->only)
        r->random = options->only;
    else if (kind < PHYSICAL)
        r->random = "physical";
    else if ((kind -= PHYSICAL) < NOTHING)
        r->random = "none";
    else if ((kind -= NOTHING) < DATA)
        r->random = "data";
    else if ((kind -= DATA) < NOISE)
        draw_noise(&random, c);
    else
        r->random = kind - NOISE < PAIR ? "pair" : "outside";
    snprintf(c->again, sizeof c->again, "--seed %llu --first %d --cases 1%s%s", (unsigned long long)options->seed, number,
             options->only ? " --only " : "", options->only ? options->only : "");
    return !c->deck;
}
