#include "hide_random.h"

#include <math.h>

static uint64_t splitmix(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

void hide_random_open(uint64_t seed, enum hide_purpose purpose, struct hide_random *random)
{
    uint64_t start = seed, scramble = splitmix(&start) ^ ((uint64_t)purpose << 56); /* neighbouring seeds share no stream */
    for (int i = 0; i < 4; i++)
        random->state[i] = splitmix(&scramble);
    random->spare = 0;
    random->has_spare = 0;
}

static uint64_t turn(uint64_t x, int k)
{
    return (x << k) | (x >> (64 - k));
}

double hide_uniform(struct hide_random *random)
{
    uint64_t *s = random->state, result = turn(s[1] * 5, 7) * 9, t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = turn(s[3], 45);
    return (double)(result >> 11) * 0x1p-53;
}

/* Polar method of Marsaglia */
double hide_normal(struct hide_random *random)
{
    double u, v, s;
    if (random->has_spare) {
        random->has_spare = 0;
        return random->spare;
    }
    do {
        u = 2 * hide_uniform(random) - 1;
        v = 2 * hide_uniform(random) - 1;
        s = u * u + v * v;
    } while (s >= 1 || s == 0);
    s = sqrt(-2 * log(s) / s);
    random->spare = v * s;
    random->has_spare = 1;
    return u * s;
}

double hide_between(struct hide_random *random, double low, double high)
{
    return low + (high - low) * hide_uniform(random);
}

double hide_log_between(struct hide_random *random, double low, double high)
{
    return low * exp(log(high / low) * hide_uniform(random));
}

int hide_pick(struct hide_random *random, int count)
{
    return (int)(hide_uniform(random) * count);
}
