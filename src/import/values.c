#include "import/values.h"

#include <math.h>
#include <string.h>

#define HASH_START  0xcbf29ce484222325u /* FNV-1a */
#define HASH_FACTOR 0x100000001b3u
/* Near a crest the values of a wave fall off as the square of the distance: three of them are equal only where a step of the
 * converter is larger than the first difference, and the next value is then no farther than five such steps. */
#define CLIPPED_RUN 3
#define CLIPPED_JUMP                                                                                                             \
    0.02 /* of the span: a converter of which at least eight bits are in use has smaller steps than a fifth of that */

void values_open(struct values *values)
{
    *values = (struct values){.hash = HASH_START, .is_constant = 1};
}

static void add_hash(struct values *values, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int b = 0; b < 64; b += 8)
        values->hash = (values->hash ^ ((bits >> b) & 0xff)) * HASH_FACTOR;
}

static void add_square(struct values *values, double size)
{
    if (size == 0)
        return;
    if (size > values->scale) {
        double ratio = values->scale / size;
        values->squares = 1 + values->squares * ratio * ratio;
        values->scale = size;
    } else {
        double ratio = size / values->scale;
        values->squares += ratio * ratio;
    }
}

/* Rows of values at the least (0) and the greatest (1) of all so far. */
static void follow_plateau(struct values *values, int which, double value)
{
    double extreme = which ? values->max : values->min;
    int beyond = !values->count || (which ? value > extreme : value < extreme);
    values->run[which] = beyond ? 1 : value == extreme ? values->run[which] + 1 : 0;
    if (!beyond && values->run[which] <= values->plateau[which])
        return;
    values->plateau[which] = values->run[which];
    if (values->run[which] == 1)
        values->plateau_jump[which] = values->count ? fabs(value - values->before) : 0;
}

static void add_abscissa(struct values *values, double x)
{
    double step = x - values->x_last;
    if (!values->count)
        values->x_first = x;
    if (values->count == 1 || (values->count && step < values->x_least_step))
        values->x_least_step = step;
    if (values->count == 1 || (values->count && step > values->x_most_step))
        values->x_most_step = step;
    values->x_last = x;
}

void values_add(struct values *values, long long count, const double *x, const double *real, const double *imag, int is_complex)
{
    for (long long i = 0; i < count; ++i) {
        double im = is_complex ? imag[i] : 0, size = is_complex ? hypot(real[i], im) : real[i];
        add_abscissa(values, x[i]);
        add_hash(values, real[i]);
        add_hash(values, im);
        add_square(values, fabs(size));
        for (int which = 0; which < 2 && !is_complex; ++which)
            follow_plateau(values, which, size);
        values->min = values->count && values->min < size ? values->min : size;
        values->max = values->count && values->max > size ? values->max : size;
        values->last[0] = real[i];
        values->last[1] = im;
        if (!values->count)
            memcpy(values->first, values->last, sizeof values->first);
        values->is_constant = values->is_constant && real[i] == values->first[0] && im == values->first[1];
        values->sum[0] += real[i];
        values->sum[1] += im;
        values->before = size;
        ++values->count;
    }
}

void values_close(struct values *values)
{
    values->is_constant = values->is_constant && values->count > 1;
    if (values->count)
        values->rms = values->scale * sqrt(values->squares / (double)values->count);
}

int values_are_clipped(const struct values *values)
{
    double span = values->max - values->min;
    const double extreme[] = {values->min, values->max};
    for (int which = 0; which < 2 && span > 0; ++which)
        if (extreme[which] != 0 && /* zeros are a window, or padding */
            values->plateau[which] >= CLIPPED_RUN && values->plateau_jump[which] > CLIPPED_JUMP * span)
            return 1;
    return 0;
}

int values_are_same(const struct values *a, const struct values *b)
{
    return a->count == b->count && a->hash == b->hash && a->min == b->min && a->max == b->max && a->rms == b->rms;
}
