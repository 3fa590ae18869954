#include "beam/beam.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

HOST_COMPUTES int equivalent_cylinder(double area, double inertia, char *failure, double *outer, double *inner)
{
    if (!(area > 0 && isfinite(area)))
        return refuse(failure, "area is %g, expected a positive number of m2", area);
    if (!(inertia > 0 && isfinite(inertia)))
        return refuse(failure, "inertia is %g, expected a positive number of m4", inertia);
    if (!outer || !inner)
        return refuse(failure, "%s is NULL, expected room for a diameter", outer ? "inner" : "outer");
    double sum = 8 * inertia / area, difference = 2 * area / pi;
    if (sum < difference * (1 - 1e-14)) /* a solid disc has sum = difference and must not fail on rounding */
        return ROTID_ERROR_SECTION;
    *outer = sqrt(sum + difference);
    *inner = sqrt(fmax(0, sum - difference));
    return ROTID_OK;
}

int rotid_equivalent_cylinder(double area, double inertia, char *failure, double *outer, double *inner)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = equivalent_cylinder(area, inertia, failure, outer, inner);
    return entry_close(&entry, status);
}

int section_equivalent(double area, double inertia, struct section *section)
{
    double outer, inner;
    int status = equivalent_cylinder(area, inertia, NULL, &outer, &inner);
    if (!status)
        *section = (struct section){area, inertia, area, inertia, 0, inner / outer, outer, 2 * inertia, 2 * inertia};
    return status;
}
