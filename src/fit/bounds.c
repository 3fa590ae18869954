#include "fit/bounds.h"

#include <math.h>

#define SATURATED 1e-6

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

int bounds_pressed(const rotid_parameter *parameter, double x)
{
    double span = parameter->upper - parameter->lower;
    if (x - parameter->lower < SATURATED * span && x - parameter->lower < 0.01 * fabs(parameter->start - parameter->lower))
        return -1;
    return parameter->upper - x < SATURATED * span;
}
