#include "diagnose/sensor_local.h"

#include <math.h>

/* Prior standard deviations of the slope change [largest component over length of the axis] and of the jump [largest component].
 * 0: none. Each mode has its own mixture of all pairs. */
static const double kink[] = {0, 0.3, 1, 3, 10}, jump[] = {0, 0.01, 0.03, 0.1, 0.3};
#define PAIRS ((int)(sizeof kink / sizeof *kink * (sizeof jump / sizeof *jump)))
#define JUMPS ((int)(sizeof jump / sizeof *jump))
/* How many gaps on either side of the sensor are searched, and places in each. */
#define GAPS   2
#define PLACES 3
/* Terms of a sum of exponentials that are e to the minus this of the largest are left out. */
#define NEGLIGIBLE 30.0

/* B' A B and B' w of the two columns b = (z - z0)+ and 1(z > z0) */
static void products(const struct sensor_field *field, int first, double z0, const double *a, double sum[3])
{
    int n = field->n;
    sum[0] = sum[1] = sum[2] = 0;
    for (int j = first; j < n; j++) {
        double level = 0, slope = 0;
        for (int i = first; i < n; i++) {
            double aij = a[i + (ptrdiff_t)j * n];
            level += aij;
            slope += aij * (field->data->z[i] - z0);
        }
        sum[0] += slope * (field->data->z[j] - z0);
        sum[1] += slope;
        sum[2] += level;
    }
}

/* Mean over the prior pairs of the factor by which the likelihood changes: log of N(v; 0, S + S T S)/N(v; 0, S). */
static void add_pairs(double length, const double sum[3], double slope, double level, double evidence, double *each)
{
    for (int pair = 0; pair < PAIRS; pair++) {
        double tk = kink[pair / JUMPS] / length, tj = jump[pair % JUMPS];
        /* I + R S R with R = T^(1/2) */
        double a = 1 + tk * tk * sum[0], b = tk * tj * sum[1], c = 1 + tj * tj * sum[2], det = a * c - b * b;
        double v = tk * slope, w = tj * level;
        each[pair] = evidence + 0.5 * ((c * v * v - 2 * b * v * w + a * w * w) / det - log(det));
    }
}

static double at_place(const struct sensor_field *field, int first, double z0, double *work)
{
    double total = 0, *square = work + (ptrdiff_t)field->ngrid * PAIRS;
    for (int c = 0; c < field->nclass; c++)
        for (int g = 0; g < field->ngrid; g++)
            products(field, first, z0, field_inverse(field, g, c), square + 3 * (g + (ptrdiff_t)c * field->ngrid));
    for (int k = 0; k < field->nmode; k++) {
        double best = -INFINITY, sum = 0;
        int count = field->ngrid * PAIRS;
        for (int g = 0; g < field->ngrid; g++) {
            const double *w = field_weight(field, g, k);
            double slope = 0, level = 0;
            for (int i = first; i < field->n; i++) {
                slope += w[i] * (field->data->z[i] - z0);
                level += w[i];
            }
            add_pairs(2 * field->half, square + 3 * (g + (ptrdiff_t)field->class_of[k] * field->ngrid), slope, level,
                      field->evidence[g + k * field->ngrid], work + (ptrdiff_t)g * PAIRS);
        }
        for (int i = 0; i < count; i++)
            best = fmax(best, work[i]);
        for (int i = 0; i < count; i++)
            if (work[i] > best - NEGLIGIBLE)
                sum += exp(work[i] - best);
        total += best + log(sum / count);
    }
    return total;
}

double local_physics(const struct sensor_field *field, int s, double *work)
{
    double best = -INFINITY;
    const double *z = field->data->z;
    for (int gap = s - GAPS; gap < s + GAPS; gap++)
        for (int i = 0; i < PLACES && gap >= 0 && gap + 1 < field->n; i++)
            best = fmax(best, at_place(field, gap + 1, z[gap] + (z[gap + 1] - z[gap]) * (i + 0.5) / PLACES, work));
    return best;
}

size_t local_workspace(const struct sensor_field *field)
{
    return (size_t)field->ngrid * (size_t)(PAIRS + 3 * field->nclass);
}
