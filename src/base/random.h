/* Reproducible random numbers without global state: splitmix64 (Steele, Lea, Flood, OOPSLA 2014). */
#ifndef ROTID_BASE_RANDOM_H
#define ROTID_BASE_RANDOM_H

#include <stdint.h>

struct random_stream {
    uint64_t state;
};

double random_uniform(struct random_stream *stream); /* in (0, 1) */
double random_normal(struct random_stream *stream);  /* mean 0, variance 1 */

#endif
