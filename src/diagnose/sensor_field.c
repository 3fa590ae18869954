#include "diagnose/diagnose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linalg/linalg.h"

/* Grid of the roughness: standard deviation of e half-way between two sensors 2 L/(n - 1) apart, from a hundredth of the noise,
 * which is nothing, to a third of the shape, which lets any sensor read anything; factor 3. */
#define ROUGH_FROM 0.01
#define ROUGH_TO   0.3
#define ROUGH_STEP 3.0
static const double mixing[] = {0.005, 0.05};
#define MIXINGS ((int)(sizeof mixing / sizeof *mixing))

/* The shape of the model in mode k at z, cubic between the nodes. */
static double field_model(const struct sensor_field *field, int k, double z)
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

/* field_new but for the parts of the covariance. */
static int field_scale(struct pool *pool, const struct shape_data *data, struct sensor_field *field)
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

/* Prior variance of an error that moves the whole shape like a rigid body: 0.3 of its largest component. */
#define RIGID 0.09

/* int (x - u)+ (y - u)+ du from the origin */
static double twice_integrated(double x, double y)
{
    double a = fmin(x, y), b = fmax(x, y);
    return a * a * (3 * b - a) / 6;
}

double *field_inverse(const struct sensor_field *field, int g, int c)
{
    return field->inverse + ((size_t)c * (size_t)field->ngrid + (size_t)g) * (size_t)field->n * (size_t)field->n;
}

double *field_weight(const struct sensor_field *field, int g, int k)
{
    return field->weight + ((size_t)k * (size_t)field->ngrid + (size_t)g) * (size_t)field->n;
}

/* w = A (m - P) and the evidence, given the log determinant of the covariance */
static void weigh(struct sensor_field *field, int g, int k, double log_determinant)
{
    int n = field->n;
    const double *a = field_inverse(field, g, field->class_of[k]), *m = field->reading + (ptrdiff_t)k * n;
    const double *p = field->model + (ptrdiff_t)k * n;
    const int *present = field->present + (ptrdiff_t)k * n;
    double *w = field_weight(field, g, k), square = 0;
    memset(w, 0, (size_t)n * sizeof *w);
    for (int j = 0; j < n; j++) {
        double r = m[j] - p[j];
        if (present[j] && !field->masked[j])
            for (int i = 0; i < n; i++)
                w[i] += a[i + (ptrdiff_t)j * n] * r;
    }
    for (int i = 0; i < n; i++)
        if (present[i] && !field->masked[i])
            square += w[i] * (m[i] - p[i]);
    field->evidence[g + k * field->ngrid] = -0.5 * (square + log_determinant);
}

static int invert_class(struct sensor_field *field, int g, int c, double *log_determinant)
{
    int n = field->n, count = 0, k = field->leader[c], *row = field->row;
    const int *present = field->present + (ptrdiff_t)k * n;
    const double *v = field->variance + (ptrdiff_t)k * n;
    double *a = field_inverse(field, g, c), *packed = field->packed;
    for (int i = 0; i < n; i++)
        if (present[i])
            row[count++] = i;
    for (int j = 0; j < count; j++)
        for (int i = j; i < count; i++) {
            int s = row[i], t = row[j];
            packed[i + (ptrdiff_t)j * count] = field->part[0][s + t * n] + field->b2[g] * field->part[1][s + t * n] +
                                               field->q[g] * field->part[2][s + t * n] + (i == j ? v[s] : 0);
        }
    if (positive_invert(count, packed, log_determinant))
        return 1;
    memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++)
            a[row[i] + (ptrdiff_t)row[j] * n] = packed[i + (ptrdiff_t)j * count];
    return 0;
}

/* The three parts of the covariance between two places on the axis, apart from their intensities. */
static void parts(const struct sensor_field *field, double z, double other, const double *shape, const double *other_shape,
                  int stride, double part[3])
{
    double x = (z - field->middle) / field->half, y = (other - field->middle) / field->half;
    part[0] = RIGID * (1 + x * y);
    part[1] = 0;
    for (int k = 0; k < field->nmode; k++)
        part[1] += shape[k] * other_shape[k * (ptrdiff_t)stride];
    part[2] = twice_integrated(z - field->origin, other - field->origin);
}

static void fill_covariance(struct sensor_field *field)
{
    int n = field->n;
    double shape[FIELD_MOST_MODES], part[3];
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < field->nmode; k++)
            shape[k] = field->model[j + k * n];
        for (int i = 0; i < n; i++) {
            parts(field, field->data->z[j], field->data->z[i], shape, field->model + i, n, part);
            for (int p = 0; p < 3; p++)
                field->part[p][i + j * n] = part[p];
        }
    }
}

int field_new(struct pool *pool, const struct shape_data *data, struct sensor_field *field)
{
    int status = field_scale(pool, data, field);
    if (!status)
        fill_covariance(field);
    return status;
}

int field_start(struct sensor_field *field, double noise_factor)
{
    double log_determinant, change = noise_factor / field->noise_factor;
    memset(field->masked, 0, (size_t)field->n * sizeof *field->masked);
    for (int i = 0; i < field->n * field->nmode; i++)
        field->variance[i] *= change * change;
    field->noise_factor = noise_factor;
    for (int c = 0; c < field->nclass; c++)
        for (int g = 0; g < field->ngrid; g++) {
            if (invert_class(field, g, c, &log_determinant))
                return 1;
            for (int k = 0; k < field->nmode; k++)
                if (field->class_of[k] == c)
                    weigh(field, g, k, log_determinant);
        }
    return 0;
}

void field_mask(struct sensor_field *field, int s)
{
    int n = field->n;
    for (int k = 0; k < field->nmode; k++)
        for (int g = 0; g < field->ngrid; g++) {
            const double *a = field_inverse(field, g, field->class_of[k]) + (ptrdiff_t)s * n;
            double *w = field_weight(field, g, k), part;
            if (a[s] <= 0)
                continue; /* absent from this mode */
            part = w[s] / a[s];
            field->evidence[g + k * field->ngrid] += 0.5 * (w[s] * part - log(a[s]));
            for (int i = 0; i < n; i++)
                w[i] -= a[i] * part;
            w[s] = 0;
        }
    for (int c = 0; c < field->nclass; c++)
        for (int g = 0; g < field->ngrid; g++) {
            double *a = field_inverse(field, g, c), *as = a + (ptrdiff_t)s * n;
            if (as[s] <= 0)
                continue;
            for (int j = 0; j < n; j++) {
                double part = as[j] / as[s];
                if (j != s)
                    for (int i = 0; i < n; i++)
                        a[i + (ptrdiff_t)j * n] -= as[i] * part;
            }
            for (int i = 0; i < n; i++)
                as[i] = a[s + (ptrdiff_t)i * n] = 0;
        }
    field->masked[s] = 1;
}

void field_exchange(struct sensor_field *field, int s, int t)
{
    int n = field->n;
    for (int k = 0; k < field->nmode; k++) {
        double *m = field->reading + (ptrdiff_t)k * n, keep = m[s];
        const double *p = field->model + (ptrdiff_t)k * n;
        for (int g = 0; g < field->ngrid; g++) { /* what is left of the evidence without its square, for weigh */
            const double *w = field_weight(field, g, k);
            double *evidence = field->evidence + g + (ptrdiff_t)k * field->ngrid;
            for (int i = 0; i < n; i++)
                *evidence += 0.5 * w[i] * (m[i] - p[i]);
        }
        m[s] = m[t];
        m[t] = keep;
        for (int g = 0; g < field->ngrid; g++)
            weigh(field, g, k, -2 * field->evidence[g + (ptrdiff_t)k * field->ngrid]);
    }
}

double field_evidence(const struct sensor_field *field)
{
    double total = 0;
    for (int k = 0; k < field->nmode; k++) {
        const double *evidence = field->evidence + (ptrdiff_t)k * field->ngrid;
        double best = evidence[0], sum = 0;
        for (int g = 1; g < field->ngrid; g++)
            best = fmax(best, evidence[g]);
        for (int g = 0; g < field->ngrid; g++)
            sum += exp(evidence[g] - best);
        total += best + log(sum / field->ngrid);
    }
    return total;
}

/* Four sums at a time: one addition need not wait for the one before. */
static double dot(int n, const double *a, const double *b)
{
    double sum[4] = {0};
    int i = 0;
    for (; i + 4 <= n; i += 4)
        for (int j = 0; j < 4; j++)
            sum[j] += a[i + j] * b[i + j];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void field_predict(const struct sensor_field *field, int s, double z, const int *wanted, double *mean, double *variance,
                   double *vector)
{
    int n = field->n, modes = field->nmode;
    double *cov = vector + 3 * (ptrdiff_t)n, own_part[3], part[3], shape[FIELD_MOST_MODES];
    for (int k = 0; k < modes; k++)
        shape[k] = field_model(field, k, z);
    parts(field, z, z, shape, shape, 1, own_part);
    for (int i = 0; i < n; i++) {
        parts(field, z, field->data->z[i], shape, field->model + i, n, part);
        for (int p = 0; p < 3; p++)
            vector[i + p * n] = part[p];
    }
    for (int c = 0; c < field->nclass; c++)
        for (int g = 0; g < field->ngrid; g++) {
            const double *a = field_inverse(field, g, c);
            double square = own_part[0] + field->b2[g] * own_part[1] + field->q[g] * own_part[2];
            int any = 0;
            for (int k = 0; k < modes; k++)
                any |= field->class_of[k] == c && wanted[g + k * field->ngrid];
            if (!any)
                continue;
            for (int i = 0; i < n; i++)
                cov[i] = vector[i] + field->b2[g] * vector[i + n] + field->q[g] * vector[i + 2 * n];
            for (int j = 0; j < n; j++) {
                const double *column = a + (ptrdiff_t)j * n;
                square -= cov[j] * (2 * dot(j, column, cov) + column[j] * cov[j]);
            }
            double with_own = dot(n, cov, a + (ptrdiff_t)s * n);
            double own = a[s + (ptrdiff_t)s * n];
            if (own > 0)
                square += with_own * with_own / own;
            for (int k = 0; k < modes; k++)
                if (field->class_of[k] == c && wanted[g + k * field->ngrid]) {
                    const double *w = field_weight(field, g, k);
                    double e = own > 0 ? -with_own * w[s] / own : 0;
                    for (int i = 0; i < n; i++)
                        e += cov[i] * w[i];
                    mean[g + k * field->ngrid] = shape[k] + e;
                    variance[g + k * field->ngrid] = fmax(square, 0);
                }
        }
}
