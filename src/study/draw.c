#include "study/draw.h"

/* The output function of splitmix64 on state and key: a change of one bit changes half of the bits. */
static uint64_t mix(uint64_t state, uint64_t key)
{
    uint64_t z = state + 0x9E3779B97F4A7C15u + key;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

struct random_stream draw_stream(unsigned long seed, enum draw_purpose purpose, long long replicate, uint64_t a, uint64_t b)
{
    uint64_t state = mix(0, seed);
    state = mix(state, (uint64_t)purpose);
    state = mix(state, (uint64_t)replicate);
    state = mix(state, a);
    return (struct random_stream){mix(state, b)};
}
