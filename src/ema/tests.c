/* Modes of several tests of one structure: their means, and the scatter from test to test, which holds what one test does not
 * show: sensors put on again, another day, another hand. */
#include <math.h>

#include "ema/ema.h"

#define ALIKE_MAC       0.8  /* of the shapes of one mode in two tests */
#define ALIKE_FREQUENCY 0.05 /* relative difference of its frequencies */

/* Which point of `test` is point p of `first`, -1: none. */
static int same_point(const struct ema *first, int p, const struct ema *test)
{
    for (int q = 0; q < test->npoint; q++)
        if (test->point_node[q] == first->point_node[p] && test->point_direction[q] == first->point_direction[p])
            return q;
    return -1;
}

/* Points that a test has and another one has not, each once. */
static int count_lacking(int count, const struct ema test[])
{
    int lacking = 0;
    for (int t = 0; t < count; t++)
        for (int p = 0; p < test[t].npoint; p++) {
            int before = 0, with = 0;
            for (int s = 0; s < count; s++) {
                int is_there = same_point(&test[t], p, &test[s]) >= 0;
                before += is_there && s < t;
                with += is_there;
            }
            lacking += !before && with < count;
        }
    return lacking;
}

/* MAC of mode k of `first` with mode j of `test` over the points [first->npoint] of both, and the factor by which the second has
 * to be taken to be nearest to the first. */
static double alike(const struct ema *first, int k, const struct ema *test, int j, const int *point, double *factor)
{
    double xx = 0, yy = 0, xy = 0;
    for (int p = 0; p < first->npoint; p++) {
        double x = first->mode[k].shape[p], y = point[p] < 0 ? NAN : test->mode[j].shape[point[p]];
        if (isfinite(x) && isfinite(y)) {
            xx += x * x;
            yy += y * y;
            xy += x * y;
        }
    }
    *factor = yy > 0 ? xy / yy : 1;
    return xx > 0 && yy > 0 ? xy * xy / (xx * yy) : 0;
}

int ema_average(struct pool *pool, int count, const struct ema test[], struct ema *mean, struct ema_scatter *scatter)
{
    const struct ema *first = &test[0];
    int n = first->npoint, *point = POOL_ARRAY(pool, int, n);
    double *value = POOL_ARRAY(pool, double, (ptrdiff_t)count *n), *hz = POOL_ARRAY(pool, double, count);
    double squares_hz = 0, squares_shape = 0;
    long long rows_hz = 0, rows_shape = 0;
    *mean = *first;
    *scatter = (struct ema_scatter){
        .tests = count, .lacking = count_lacking(count, test), .std_hz = POOL_ARRAY(pool, double, first->nmode)};
    mean->mode = POOL_ARRAY(pool, struct ema_mode, first->nmode);
    mean->nmode = 0;
    mean->tests = count;
    if (!point || !value || !hz || !scatter->std_hz || !mean->mode)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < first->nmode; k++) {
        struct ema_mode *mode = &mean->mode[mean->nmode];
        int in_all = 1;
        for (int t = 0; t < count && in_all; t++) {
            double best = 0, factor = 1, own;
            int partner = -1;
            for (int p = 0; p < n; p++)
                point[p] = same_point(first, p, &test[t]);
            for (int j = 0; j < test[t].nmode; j++) {
                double mac = alike(first, k, &test[t], j, point, &own);
                if (mac > best && fabs(test[t].mode[j].frequency_hz / first->mode[k].frequency_hz - 1) < ALIKE_FREQUENCY) {
                    best = mac;
                    partner = j;
                    factor = own;
                }
            }
            in_all = best > ALIKE_MAC;
            for (int p = 0; p < n && in_all; p++)
                value[t + (ptrdiff_t)p * count] = point[p] < 0 ? (double)NAN : factor * test[t].mode[partner].shape[point[p]];
            hz[t] = in_all ? test[t].mode[partner].frequency_hz : 0;
        }
        if (!in_all) {
            scatter->missing++;
            continue;
        }
        *mode = first->mode[k];
        mode->shape = POOL_ARRAY(pool, double, n);
        mode->shape_std = POOL_ARRAY(pool, double, n);
        if (!mode->shape || !mode->shape_std)
            return ROTID_ERROR_MEMORY;
        mode->point_frequency_hz = mode->point_frequency_std = NULL; /* an accelerometer's, of one test */
        double square = 0;
        mode->frequency_hz = 0;
        for (int t = 0; t < count; t++)
            mode->frequency_hz += hz[t] / count;
        for (int t = 0; t < count; t++)
            square += (hz[t] - mode->frequency_hz) * (hz[t] - mode->frequency_hz);
        scatter->std_hz[mean->nmode++] = sqrt(square / (count - 1));
        squares_hz += square / (mode->frequency_hz * mode->frequency_hz);
        rows_hz += count - 1;
        for (int p = 0; p < n; p++) {
            double sum = 0;
            for (int t = 0; t < count; t++)
                sum += value[t + (ptrdiff_t)p * count];
            mode->shape[p] = sum / count;
            for (int t = 0; t < count && isfinite(sum); t++)
                squares_shape += pow(value[t + (ptrdiff_t)p * count] - mode->shape[p], 2);
            rows_shape += isfinite(sum) ? count - 1 : 0;
        }
    }
    scatter->frequency = sqrt(squares_hz / (double)rows_hz);
    scatter->shape = sqrt(squares_shape / (double)rows_shape);
    for (int k = 0; k < mean->nmode; k++) {
        struct ema_mode *mode = &mean->mode[k];
        mode->frequency_std = scatter->frequency * mode->frequency_hz / sqrt(count);
        for (int p = 0; p < n; p++)
            mode->shape_std[p] = isfinite(mode->shape[p]) ? scatter->shape / sqrt(count) : (double)NAN;
    }
    return ROTID_OK;
}
