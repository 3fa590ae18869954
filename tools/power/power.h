/* What the diagnosis can do: many cases with hidden effects, and how often it says what is true. */
#ifndef POWER_H
#define POWER_H

#include <stdint.h>
#include <stdio.h>

#include "hidden.h"

#define POWER_MOST_DECKS 8

struct power_deck {
    const char *path;
    char *text;
    int sensors; /* 0: it has its own */
};

struct power_options {
    int cases, first, jobs, modes, half_sensors, no_shapes, decks, quick;
    uint64_t seed;
    const char *only, *log;
};

/* A case drawn from the seed of the run and its number: kind of effect, noise. Texts of effects live in *effect. */
void power_draw(const struct power_options *options, int ndeck, const struct power_deck *deck, int number, struct hidden_case *c,
                char effect[64], const char **list);

/* The arguments of `hide` that make the case again. */
void power_command(const struct hidden_case *c, size_t room, char *command);

/* One line of JSON about a case: everything that was said, and everything that is true. d and truth are NULL where there was no
 * diagnosis. The text is to be freed. */
char *power_line(const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth, const struct hidden_score *score);

struct power_result {
    int done; /* there is a score */
    uint64_t seed;
    int number;
    const char *deck;
    struct hidden_score score;
};

/* Tables and requirements; 0 where all of these hold. */
int power_report(FILE *out, int count, const struct power_result *result);

/* ---- shares */

struct power_share {
    int right, count;
};

/* The requirements alone. */
int power_requirements(FILE *out, int count, const struct power_result *result);

/* Wilson's 95 % interval of a share. */
void power_interval(struct power_share share, double *lower, double *upper);

#endif
