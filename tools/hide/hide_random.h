/* Random numbers of a case: xoshiro256** (Blackman and Vigna 2018), filled by splitmix64. */
#ifndef HIDE_RANDOM_H
#define HIDE_RANDOM_H

#include <stdint.h>

struct hide_random {
    uint64_t state[4];
    double spare; /* the second normal number of a pair */
    int has_spare;
};

/* Each purpose has a stream of its own, so that one more effect leaves the noise of the same seed as it was. */
enum hide_purpose {
    HIDE_FOR_PARAMETERS = 1,
    HIDE_FOR_EFFECTS,
    HIDE_FOR_FREQUENCIES,
    HIDE_FOR_SHAPES,
    HIDE_FOR_ROTOR,
    HIDE_FOR_CASE
};

void hide_random_open(uint64_t seed, enum hide_purpose purpose, struct hide_random *random);
double hide_uniform(struct hide_random *random); /* in [0, 1) */
double hide_normal(struct hide_random *random);  /* mean 0, variance 1 */

double hide_between(struct hide_random *random, double low, double high);
double hide_log_between(struct hide_random *random, double low, double high); /* uniform in the logarithm; both > 0 */
int hide_pick(struct hide_random *random, int count);                         /* 0 ... count-1 */

#endif
