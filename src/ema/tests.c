/* Modes of several tests of one structure: their means, and the scatter from test to test, which holds what one test does not
 * show: sensors put on again, another day, another hand. */
#include "ema/ema.h"

#define ALIKE_MAC       0.8  /* of the shapes of one mode in two tests */
#define ALIKE_FREQUENCY 0.05 /* relative difference of its frequencies */
#define UNLIKE          2    /* distance of two modes at both limits */
#define SWEEPS          20 /* of the mean shape; each takes the error down by the square of the scatter, at worst by 1 - ALIKE_MAC */

struct tests {
    int count, npoint; /* points that every test has */
    const struct ema *test;
    int *at; /* [count * npoint], test by test: their indices there */
};

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

static void common_points(struct tests *of)
{
    for (int p = 0; p < of->test[0].npoint; p++) {
        int *at = of->at + (ptrdiff_t)of->count * of->npoint, with = 0;
        for (; with < of->count; with++)
            if ((at[with] = same_point(&of->test[0], p, &of->test[with])) < 0)
                break;
        of->npoint += with == of->count;
    }
}

/* Component of mode k of test t at common point p. */
static double component(const struct tests *of, int t, int k, int p)
{
    return of->test[t].mode[k].shape[of->at[t + (ptrdiff_t)p * of->count]];
}

/* Squared distance of mode k of test s from mode j of test t, over MAC and frequency, each in units of its limit: where shapes
 * differ they tell the modes apart, where they are alike (two planes of bending along one axis) the frequencies do, and keep
 * their order where all are shifted, since squares add. UNLIKE where one is beyond its limit. */
static double distance(const struct tests *of, int s, int k, int t, int j)
{
    double xx = 0, yy = 0, xy = 0;
    for (int p = 0; p < of->npoint; p++) {
        double x = component(of, s, k, p), y = component(of, t, j, p);
        if (isfinite(x) && isfinite(y)) {
            xx += x * x;
            yy += y * y;
            xy += x * y;
        }
    }
    double apart = log(of->test[t].mode[j].frequency_hz / of->test[s].mode[k].frequency_hz) / ALIKE_FREQUENCY;
    double unlike = xx > 0 && yy > 0 ? (1 - xy * xy / (xx * yy)) / (1 - ALIKE_MAC) : 1;
    return fabs(apart) < 1 && unlike < 1 ? apart * apart + unlike * unlike : UNLIKE;
}

/* Assignment of least sum of d [rows * columns], rows <= columns, by shortest augmenting paths: column [rows] of each row.
 * work [3 * columns + rows + 3], way [3 * columns + 3]; row and column 0 are none. */
static void assign(int rows, int columns, const double *d, int *column, double *work, int *way)
{
    double *u = work, *v = u + rows + 1, *least = v + columns + 1;
    int *row = way + columns + 1, *done = row + columns + 1;
    memset(u, 0, ((size_t)rows + 1) * sizeof *u);
    memset(v, 0, ((size_t)columns + 1) * sizeof *v);
    memset(row, 0, ((size_t)columns + 1) * sizeof *row);
    for (int k = 1; k <= rows; k++) {
        int at = 0;
        row[0] = k;
        for (int j = 0; j <= columns; j++) {
            least[j] = INFINITY;
            done[j] = 0;
        }
        while (row[at]) {
            int next = 0;
            done[at] = 1;
            for (int j = 1; j <= columns; j++) {
                double own = d[row[at] - 1 + (ptrdiff_t)(j - 1) * rows] - u[row[at]] - v[j];
                if (!done[j] && own < least[j]) {
                    least[j] = own;
                    way[j] = at;
                }
                if (!done[j] && (!next || least[j] < least[next]))
                    next = j;
            }
            double step = least[next];
            for (int j = 0; j <= columns; j++)
                if (done[j]) {
                    u[row[j]] += step;
                    v[j] -= step;
                } else {
                    least[j] -= step;
                }
            at = next;
        }
        for (; at; at = way[at])
            row[at] = row[way[at]];
    }
    for (int j = 1; j <= columns; j++)
        if (row[j])
            column[row[j] - 1] = j - 1;
}

/* Partner [count * nmode of s] in every test for each mode of test s, -1: none; returns the sum of their distances, lower by
 * UNLIKE for each partner. work [2 most^2 + 5 most + 3], way [6 most + 3], most: the modes of the test with the most. */
static double match(const struct tests *of, int s, int *partner, double *work, int *way)
{
    int rows = of->test[s].nmode;
    double sum = 0;
    for (int t = 0; t < of->count; t++) {
        int real = of->test[t].nmode, columns = real + rows, *own = partner + (ptrdiff_t)t * rows; /* or none of them */
        double *d = work;
        for (int k = 0; k < rows; k++)
            for (int j = 0; j < columns; j++)
                d[k + (ptrdiff_t)j * rows] = j < real ? distance(of, s, k, t, j) : UNLIKE;
        assign(rows, columns, d, own, work + (ptrdiff_t)rows * columns, way);
        for (int k = 0; k < rows; k++) {
            double apart = d[k + (ptrdiff_t)own[k] * rows];
            own[k] = apart < UNLIKE ? own[k] : -1;
            sum += t == s ? 0 : apart - UNLIKE;
        }
    }
    return sum;
}

/* Sum of squares about the mean; that goes to *mean. */
static double spread(int n, const double *x, double *mean)
{
    double square = 0;
    *mean = 0;
    for (int i = 0; i < n; i++)
        *mean += x[i] / n;
    for (int i = 0; i < n; i++)
        square += (x[i] - *mean) * (x[i] - *mean);
    return square;
}

/* Mean shape of one mode, number[t] in test t, largest component 1: each test at the factor [count] that is nearest to the mean,
 * so that none is the measure of the others (the first principal component of the shapes). Adds the squares about it and their
 * degrees of freedom: a factor goes with each test but one. */
static void mean_shape(const struct tests *of, const int *number, struct ema_mode *mode, double *factor, double *squares,
                       long long *free)
{
    int n = of->count, known = 0;
    double largest = 0;
    for (int p = 0; p < of->npoint; p++) {
        double sum = 0;
        for (int t = 0; t < n; t++)
            sum += component(of, t, number[t], p);
        mode->shape[p] = isfinite(sum) ? component(of, 0, number[0], p) : (double)NAN;
        known += isfinite(sum);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int t = 0; t < n; t++) {
            double xx = 0, xy = 0;
            for (int p = 0; p < of->npoint; p++)
                if (isfinite(mode->shape[p])) {
                    double x = component(of, t, number[t], p);
                    xx += x * x;
                    xy += x * mode->shape[p];
                }
            factor[t] = xx > 0 ? xy / xx : 0;
        }
        largest = 0;
        for (int p = 0; p < of->npoint; p++) {
            double sum = isfinite(mode->shape[p]) ? 0 : (double)NAN;
            for (int t = 0; t < n; t++)
                sum += factor[t] * component(of, t, number[t], p) / n;
            mode->shape[p] = sum;
            largest = fabs(sum) > fabs(largest) ? sum : largest;
        }
        for (int p = 0; p < of->npoint && largest != 0; p++)
            mode->shape[p] /= largest;
    }
    for (int t = 0; t < n && largest != 0; t++)
        factor[t] /= largest;
    for (int p = 0; p < of->npoint; p++) {
        mode->complex_shape[p] = isfinite(mode->shape[p]) ? 0 : CMPLX(NAN, NAN);
        for (int t = 0; t < n; t++) {
            double apart = factor[t] * component(of, t, number[t], p) - mode->shape[p];
            mode->complex_shape[p] += factor[t] * of->test[t].mode[number[t]].complex_shape[of->at[t + (ptrdiff_t)p * n]] / n;
            *squares += isfinite(apart) && isfinite(mode->shape[p]) ? apart * apart : 0;
        }
    }
    *free += known ? (long long)(n - 1) * (known - 1) : 0;
}

/* Modal mass in the scale of the mean shape, over the tests that have one; NaN where none has, or one the wrong sign. */
static double mean_mass(const struct tests *of, const int *number, const double *factor)
{
    double sum = 0;
    int known = 0;
    for (int t = 0; t < of->count; t++) {
        double mass = of->test[t].mode[number[t]].modal_mass;
        if (mass < 0)
            return NAN;
        sum += isfinite(mass) ? factor[t] * factor[t] * mass : 0;
        known += isfinite(mass);
    }
    return known ? sum / known : NAN;
}

int ema_average(struct pool *pool, int count, const struct ema test[], struct ema *mean, struct ema_scatter *scatter)
{
    struct tests of = {.count = count, .test = test, .at = POOL_ARRAY(pool, int, (ptrdiff_t)count *test[0].npoint)};
    int most = 0, hub = 0;
    double squares_hz = 0, squares_damping = 0, squares_shape = 0, nearest = INFINITY;
    long long free_hz = 0, free_damping = 0, free_shape = 0;
    for (int t = 0; t < count; t++)
        most = test[t].nmode > most ? test[t].nmode : most;
    *mean = (struct ema){.tests = count};
    *scatter = (struct ema_scatter){.tests = count, .lacking = count_lacking(count, test)};
    int *partner = POOL_ARRAY(pool, int, (ptrdiff_t)count *most), *way = POOL_ARRAY(pool, int, 6 * (ptrdiff_t)most + 3);
    int *number = POOL_ARRAY(pool, int, count);
    double *work = POOL_ARRAY(pool, double, 2 * (ptrdiff_t)most * most + 5 * (ptrdiff_t)most + 3);
    double *hz = POOL_ARRAY(pool, double, count), *damping = POOL_ARRAY(pool, double, count);
    double *factor = POOL_ARRAY(pool, double, count), *rms_damping = POOL_ARRAY(pool, double, most);
    mean->mode = POOL_ARRAY(pool, struct ema_mode, most);
    mean->point_node = POOL_ARRAY(pool, int, test[0].npoint);
    mean->point_direction = POOL_ARRAY(pool, int, test[0].npoint);
    scatter->std_hz = POOL_ARRAY(pool, double, most);
    scatter->std_damping = POOL_ARRAY(pool, double, most);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    common_points(&of);
    mean->npoint = of.npoint;
    for (int p = 0; p < of.npoint; p++) {
        mean->point_node[p] = test[0].point_node[of.at[(ptrdiff_t)p * count]];
        mean->point_direction[p] = test[0].point_direction[of.at[(ptrdiff_t)p * count]];
    }
    for (int t = 0; t < count; t++) { /* the test that is most like all others, wherever it stands */
        double sum = match(&of, t, partner, work, way);
        hub = sum < nearest ? t : hub;
        nearest = fmin(sum, nearest);
    }
    (void)match(&of, hub, partner, work, way);
    for (int k = 0; k < test[hub].nmode; k++) {
        struct ema_mode *mode = &mean->mode[mean->nmode];
        int in_all = 1;
        for (int t = 0; t < count; t++) {
            number[t] = partner[k + (ptrdiff_t)t * test[hub].nmode];
            in_all &= number[t] >= 0;
        }
        if (!in_all)
            continue;
        *mode = (struct ema_mode){.peak_signal_to_noise = NAN,
                                  .nearest_hz = NAN,
                                  .shape = POOL_ARRAY(pool, double, of.npoint),
                                  .shape_std = POOL_ARRAY(pool, double, of.npoint),
                                  .complex_shape = POOL_ARRAY(pool, double complex, of.npoint)};
        if (pool->out_of_memory)
            return ROTID_ERROR_MEMORY;
        for (int t = 0; t < count; t++) {
            hz[t] = test[t].mode[number[t]].frequency_hz;
            damping[t] = test[t].mode[number[t]].damping;
            mode->quality_flags |= test[t].mode[number[t]].quality_flags;
        }
        double square_hz = spread(count, hz, &mode->frequency_hz), square_damping = spread(count, damping, &mode->damping);
        /* relative to the rms, which two signs do not take to zero */
        double rms = rms_damping[mean->nmode] = sqrt(mode->damping * mode->damping + square_damping / count);
        scatter->std_damping[mean->nmode] = sqrt(square_damping / (count - 1));
        scatter->std_hz[mean->nmode++] = sqrt(square_hz / (count - 1));
        squares_hz += square_hz / (mode->frequency_hz * mode->frequency_hz);
        free_hz += count - 1;
        squares_damping += rms > 0 ? square_damping / (rms * rms) : 0; /* not of a NaN */
        free_damping += rms > 0 ? count - 1 : 0;
        mean_shape(&of, number, mode, factor, &squares_shape, &free_shape);
        mode->mpc = mode_phase_collinearity(of.npoint, mode->complex_shape);
        mode->mpd = mode_phase_deviation(of.npoint, mode->complex_shape);
        mode->modal_mass = mean_mass(&of, number, factor);
    }
    scatter->missing = most - mean->nmode;
    scatter->frequency = sqrt(squares_hz / (double)free_hz);
    scatter->damping = sqrt(squares_damping / (double)free_damping);
    scatter->shape = free_shape ? sqrt(squares_shape / (double)free_shape) : (double)NAN;
    for (int k = 0; k < mean->nmode; k++) {
        struct ema_mode *mode = &mean->mode[k];
        mode->frequency_std = scatter->frequency * mode->frequency_hz / sqrt(count);
        mode->damping_std = scatter->damping * rms_damping[k] / sqrt(count);
        for (int p = 0; p < of.npoint; p++)
            mode->shape_std[p] = isfinite(mode->shape[p]) ? scatter->shape / sqrt(count) : (double)NAN;
    }
    return ROTID_OK;
}
