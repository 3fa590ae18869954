#include "diagnose/sensor_scale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Grid of the roughness: standard deviation of e half-way between two sensors 2 L/(n - 1) apart, from a hundredth of the noise,
 * which is nothing, to a third of the shape, which lets any sensor read anything; factor 3. */
#define ROUGH_FROM 0.01
#define ROUGH_TO   0.3
#define ROUGH_STEP 3.0
static const double mixing[] = {0.005, 0.05};
#define MIXINGS ((int)(sizeof mixing / sizeof *mixing))

double field_model(const struct sensor_field *field, int k, double z)
{
    return shape_data_model(field->data, k, z) * field->scale[k];
}

struct ratio {
    double value, weight;
};

static int by_value(const void *left, const void *right)
{
    double a = ((const struct ratio *)left)->value, b = ((const struct ratio *)right)->value;
    return (a > b) - (a < b);
}

/* The a with the least sum |m - a P|: the median of m/P with weights |P|. */
static double robust_scale(int n, const double *p, const double *m, const int *present, struct ratio *ratio)
{
    int count = 0;
    double total = 0, below = 0;
    for (int i = 0; i < n; i++)
        if (present[i] && p[i] != 0) {
            ratio[count] = (struct ratio){m[i] / p[i], fabs(p[i])};
            total += ratio[count++].weight;
        }
    qsort(ratio, (size_t)count, sizeof *ratio, by_value);
    for (int i = 0; i < count; i++) {
        below += ratio[i].weight;
        if (below >= total / 2)
            return ratio[i].value;
    }
    return 1;
}

/* Scales mode k; a mode that has no data, or none that the model explains, stays out. */
static void scale_mode(struct sensor_field *field, int k, struct ratio *ratio)
{
    const struct shape_data *data = field->data;
    int n = field->n, *present = field->present + (ptrdiff_t)k * n;
    double *p = field->model + (ptrdiff_t)k * n, *m = field->reading + (ptrdiff_t)k * n, *v = field->variance + (ptrdiff_t)k * n;
    double largest = 0;
    field->scale[k] = 1;
    for (int i = 0; i < n; i++) {
        m[i] = data->shape[i + (ptrdiff_t)k * n];
        p[i] = field_model(field, k, data->z[i]);
        present[i] = isfinite(m[i]) && isfinite(p[i]) && isfinite(data->std[i + (ptrdiff_t)k * n]);
    }
    for (int i = 0; i < data->naxis; i++)
        largest = fmax(largest, fabs(data->axis_shape[i + (ptrdiff_t)k * data->naxis]));
    double ratio_to_model = robust_scale(n, p, m, present, ratio);
    field->unit[k] = fabs(ratio_to_model) * largest;
    if (!(field->unit[k] > 0) || !isfinite(field->unit[k])) {
        field->unit[k] = field->scale[k] = 0;
        for (int i = 0; i < n; i++) {
            p[i] = m[i] = present[i] = 0;
            v[i] = 1;
        }
        return;
    }
    field->scale[k] = ratio_to_model / field->unit[k];
    for (int i = 0; i < n; i++) {
        double std = data->std[i + (ptrdiff_t)k * n] / field->unit[k];
        p[i] *= field->scale[k];
        m[i] = present[i] ? m[i] / field->unit[k] : 0;
        v[i] = present[i] ? fmax(std * std, 1e-12) : 1;
    }
}

static double typical_noise(const struct sensor_field *field)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < field->n * field->nmode; i++)
        if (field->present[i]) {
            sum += 0.5 * log(field->variance[i]);
            count++;
        }
    return count ? exp(sum / count) : 1;
}

static void lay_grid(struct sensor_field *field)
{
    double gap = 2 * (field->data->z[field->n - 1] - field->data->z[0]) / (field->n - 1);
    double rough = ROUGH_FROM * typical_noise(field);
    int steps = (int)ceil(log(ROUGH_TO / rough) / log(ROUGH_STEP));
    steps = steps < 1 ? 1 : steps < FIELD_MOST_GRID / MIXINGS ? steps : FIELD_MOST_GRID / MIXINGS - 1;
    double step = pow(fmax(ROUGH_TO / rough, ROUGH_STEP), 1.0 / steps);
    field->ngrid = 0;
    for (int i = 0; i <= steps; i++, rough *= step)
        for (int j = 0; j < MIXINGS; j++) {
            /* between two supports of known slope a twice integrated walk over the gap has the variance q gap^3/192; with the
             * slopes from further sensors four times that */
            field->q[field->ngrid] = 48 * rough * rough / (gap * gap * gap);
            field->b2[field->ngrid++] = mixing[j] * mixing[j];
        }
}

static void find_classes(struct sensor_field *field)
{
    size_t n = (size_t)field->n;
    field->nclass = 0;
    for (int k = 0; k < field->nmode; k++) {
        const int *present = field->present + (size_t)k * n;
        const double *v = field->variance + (size_t)k * n;
        int c = 0;
        for (; c < field->nclass; c++) {
            size_t other = (size_t)field->leader[c] * n;
            if (memcmp(present, field->present + other, n * sizeof *present))
                continue;
            double worst = 0;
            for (size_t i = 0; i < n; i++)
                worst = fmax(worst, fabs(v[i] / field->variance[other + i] - 1));
            if (worst < 1e-9)
                break;
        }
        if (c == field->nclass)
            field->leader[field->nclass++] = k;
        field->class_of[k] = c;
    }
}

int field_scale(struct pool *pool, const struct shape_data *data, struct sensor_field *field)
{
    size_t n = (size_t)data->nsensor, modes = (size_t)data->nmode, all = n * modes;
    *field = (struct sensor_field){.data = data, .n = data->nsensor, .nmode = data->nmode, .noise_factor = 1};
    field->origin = fmin(data->axis_z[0], data->z[0]);
    field->half = (fmax(data->axis_z[data->naxis - 1], data->z[n - 1]) - field->origin) / 2;
    field->middle = field->origin + field->half;
    struct ratio *ratio = POOL_ARRAY(pool, struct ratio, n);
    double *numbers = POOL_ARRAY(pool, double, 3 * all + 2 * modes + 4 * n * n);
    int *integers = POOL_ARRAY(pool, int, all + 2 * n + 2 * modes);
    if (!ratio || !numbers || !integers)
        return ROTID_ERROR_MEMORY;
    field->model = numbers;
    field->reading = numbers + all;
    field->variance = numbers + 2 * all;
    field->unit = numbers + 3 * all;
    field->scale = field->unit + modes;
    field->packed = field->scale + modes;
    for (size_t p = 0; p < 3; p++)
        field->part[p] = field->packed + (p + 1) * n * n;
    field->present = integers;
    field->masked = integers + all;
    field->row = field->masked + n;
    field->class_of = field->row + n;
    field->leader = field->class_of + modes;
    for (int k = 0; k < field->nmode; k++)
        scale_mode(field, k, ratio);
    lay_grid(field);
    find_classes(field);
    size_t grid = (size_t)field->ngrid;
    field->inverse = POOL_ARRAY(pool, double, n *n *grid *(size_t)field->nclass);
    field->weight = POOL_ARRAY(pool, double, all *grid);
    field->evidence = POOL_ARRAY(pool, double, grid *modes);
    return field->inverse && field->weight && field->evidence ? ROTID_OK : ROTID_ERROR_MEMORY;
}
