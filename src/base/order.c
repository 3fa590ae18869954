#include "base/base.h"

ORDER_BY(of_doubles, double, *it, 0)

void sort_doubles(size_t count, double *value)
{
    qsort(value, count, sizeof *value, of_doubles);
}

ORDER_BY(of_ints, int, *it, 0)

void sort_ints(size_t count, int *value)
{
    if (count)
        qsort(value, count, sizeof *value, of_ints);
}

double double_of_rank(size_t count, size_t rank, double *value)
{
    /* Hoare's selection: all up to j are no more than the pivot, all from i on no less, and what is between is the pivot */
    for (ptrdiff_t low = 0, high = (ptrdiff_t)count - 1, at = (ptrdiff_t)rank; low < high;) {
        double pivot = value[at];
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (value[i] < pivot)
                i++;
            while (value[j] > pivot)
                j--;
            if (i > j)
                break;
            double kept = value[i];
            value[i++] = value[j];
            value[j--] = kept;
        }
        if (j < at)
            low = i;
        if (at < i)
            high = j;
    }
    return value[rank];
}

double median_of(size_t count, double *x)
{
    sort_doubles(count, x);
    return count ? (x[(count - 1) / 2] + x[count / 2]) / 2 : NAN;
}

double largest_magnitude(ptrdiff_t count, const double *x)
{
    double largest = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(x[i]))
            largest = fmax(largest, fabs(x[i]));
    return largest;
}

int all_finite(ptrdiff_t count, const double *x)
{
    for (ptrdiff_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

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
    return radius * cos(TWO_PI * random_uniform(stream));
}
