#include "fit/fit.h"

#define SATURATED 1e-6
#define NOTHING   1e-13 /* of the largest entry of J in y: below, a column is the rounding of the others */

/* The paper scales x by its start before it applies (30); y is the same with and without. The exponential is always of a negative
 * number, so that it underflows to zero, which is the bound, and never overflows. */
double bounds_to_x(const rotid_parameter *parameter, double chi, double y)
{
    double span = parameter->upper - parameter->lower;
    double e = exp(-fabs(chi * y)), part = e / (1 + e);
    return y > 0 ? parameter->lower + span * part : parameter->upper - span * part;
}

double bounds_to_y(const rotid_parameter *parameter, double chi, double x)
{
    return log((parameter->upper - x) / (x - parameter->lower)) / chi;
}

double bounds_slope(const rotid_parameter *parameter, double chi, double y)
{
    double e = exp(-fabs(chi * y)); /* symmetric in y */
    return -(parameter->upper - parameter->lower) * chi * e / ((1 + e) * (1 + e));
}

/* NaN where one is */
static double largest_entry(ptrdiff_t count, const double *a)
{
    double largest = 0;
    for (ptrdiff_t i = 0; i < count && !isnan(largest); i++)
        if (!(fabs(a[i]) <= largest))
            largest = fabs(a[i]);
    return largest;
}

void bounds_jacobian(int m, int n, const rotid_parameter *parameter, double chi, const double *y, const double *dr_dx,
                     double *dr_dy)
{
    for (int p = 0; p < n; p++) {
        double slope = bounds_slope(&parameter[p], chi, y[p]);
        for (int i = 0; i < m; i++)
            dr_dy[i + (ptrdiff_t)p * m] = dr_dx[i + (ptrdiff_t)p * m] * slope;
    }
    double least = NOTHING * largest_entry((ptrdiff_t)m * n, dr_dy);
    for (int p = 0; p < n; p++) {
        double *column = dr_dy + (ptrdiff_t)p * m;
        if (largest_entry(m, column) < least)
            memset(column, 0, (size_t)m * sizeof *column);
    }
}

int bounds_pressed(const rotid_parameter *parameter, double x)
{
    double span = parameter->upper - parameter->lower;
    double above = x - parameter->lower, start = parameter->start - parameter->lower;
    if (above < SATURATED * span && above < fmax(0.01 * fabs(start), SATURATED * fabs(parameter->lower)))
        return -1;
    return parameter->upper - x < SATURATED * span;
}
