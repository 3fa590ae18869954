#include "base/base.h"

#include <math.h>

double random_uniform(struct random_stream *stream)
{
    uint64_t z = (stream->state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return ((double)(z >> 11) + 0.5) * 0x1p-53; /* the half keeps 0 out: random_normal takes its logarithm */
}

double random_normal(struct random_stream *stream)
{
    double radius = sqrt(-2 * log(random_uniform(stream)));
    return radius * cos(6.283185307179586 * random_uniform(stream));
}
