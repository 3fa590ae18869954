/* The mixture of cases. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/random.h"
#include "power.h"

/* Shares of what is hidden; the rest lies outside the catalogue. */
#define PHYSICAL  0.70
#define NOTHING   0.08
#define DATA      0.08
#define MISSTATED 0.04
#define PAIR      0.05

#define USUAL_NOISE 0.6  /* share of cases with 0.1 % and 1.5 %; the others draw it */
#define COLOURED    0.06 /* of those with one effect or none */

static double log_between(struct random_stream *random, double low, double high)
{
    return low * pow(high / low, random_uniform(random));
}

void power_draw(const struct power_options *options, int ndeck, const struct power_deck *deck, int number, struct hidden_case *c,
                char effect[64], const char **list)
{
    const struct power_deck *d = &deck[number % ndeck];
    struct hide_request r = hide_request_default();
    struct random_stream random;
    r.seed = options->seed * 10000 + (uint64_t)number;
    random.state = r.seed ^ 0x5a17ull << 40;
    r.deck = d->text;
    r.name = d->path;
    r.sensors = d->sensors;
    r.modes = options->modes;
    r.half_sensors = options->half_sensors;
    r.no_shapes = options->no_shapes;
    if (random_uniform(&random) > USUAL_NOISE) {
        r.frequency_noise = log_between(&random, 5e-4, 3e-3);
        r.shape_noise = log_between(&random, 5e-3, 3e-2);
    }
    double kind = random_uniform(&random), coloured = random_uniform(&random), fault = random_uniform(&random);
    if (options->only)
        r.random = options->only;
    else if (kind < PHYSICAL + NOTHING) {
        r.random = kind < PHYSICAL ? "physical" : "none";
        r.correlation = coloured < COLOURED && !r.no_shapes ? 0.7 : 0;
    } else if ((kind -= PHYSICAL + NOTHING) < DATA)
        r.random = "data";
    else if ((kind -= DATA) < MISSTATED) {
        int shape = fault < 0.5 && !r.no_shapes, twice = fault * 4 - floor(fault * 4) < 0.5;
        snprintf(effect, 64, "noise_level:block=%s,factor=%s", shape ? "SHAPE" : "FREQUENCY", twice ? "2" : "0.5");
        *list = effect;
        r.effect = list;
        r.effects = 1;
    } else
        r.random = kind - MISSTATED < PAIR ? "pair" : "outside";
    c->request = r;
    c->number = number;
}

void power_command(const struct hidden_case *c, size_t room, char *command)
{
    const struct hide_request *r = &c->request;
    char part[200];
    snprintf(command, room, "%s --seed %llu --modes %d --frequency-noise %.6g --shape-noise %.6g", r->name,
             (unsigned long long)r->seed, r->modes, r->frequency_noise, r->shape_noise);
    if (r->sensors > 0)
        snprintf(part, sizeof part, " --sensors %d", r->sensors);
    else
        part[0] = 0;
    size_t length = strlen(command);
    length += (size_t)snprintf(command + length, room - length, "%s%s%s", part, r->half_sensors ? " --half-sensors" : "",
                               r->no_shapes ? " --no-shapes" : "");
    if (r->correlation > 0)
        length += (size_t)snprintf(command + length, room - length, " --correlated %g", r->correlation);
    if (r->random)
        length += (size_t)snprintf(command + length, room - length, " --random %s", r->random);
    for (int i = 0; i < r->effects; i++)
        length += (size_t)snprintf(command + length, room - length, " --effect %s", r->effect[i]);
}
