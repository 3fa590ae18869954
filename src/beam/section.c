#include "beam/section.h"

#include <math.h>

#include "base/entry.h"
#include "base/host.h"
#include "rotid.h"

static const double pi = 3.14159265358979323846;

static double disc_area(double d)
{
    return pi * d * d / 4;
}

static double disc_inertia(double d)
{
    return pi * d * d * d * d / 64;
}

void section_round(double outer, double inner, double stiff_outer, struct section *section)
{
    *section = (struct section){.stiff_area = disc_area(stiff_outer) - disc_area(inner),
                                .stiff_inertia = disc_inertia(stiff_outer) - disc_inertia(inner),
                                .mass_area = disc_area(outer) - disc_area(inner),
                                .mass_inertia = disc_inertia(outer) - disc_inertia(inner),
                                .ratio = inner / stiff_outer};
}

void section_rectangular(double height, double width, struct section *section)
{
    double area = height * width, inertia = width * height * height * height / 12;
    *section = (struct section){area, inertia, area, inertia, 1, 0};
}

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
        *section = (struct section){area, inertia, area, inertia, 0, inner / outer};
    return status;
}

int section_perforate(int number, double d, double e, double stiff_outer, struct section *section)
{
    double area, own, pitch;
    section_rods(number, d, e, &area, &own, &pitch);
    section->mass_area -= area;
    section->mass_inertia -= own + pitch;
    if (e < stiff_outer / 2) {
        section->stiff_area -= area;
        section->stiff_inertia -= own + pitch;
    }
    return section->stiff_area > 0 && section->stiff_inertia > 0 && section->mass_area > 0 && section->mass_inertia > 0
               ? ROTID_OK
               : ROTID_ERROR_SECTION;
}

void section_rods(int number, double d, double e, double *area, double *own, double *pitch)
{
    *area = number * disc_area(d);
    *own = number * disc_inertia(d);
    *pitch = *area * e * e / 2;
}

/* N/D and its derivative for N = n0 + n1 nu, D = d0 + d1 nu */
static double ratio_of_lines(double nu, double n0, double n1, double d0, double d1, double *derivative)
{
    double numerator = n0 + n1 * nu, denominator = d0 + d1 * nu;
    *derivative = (n1 * denominator - d1 * numerator) / (denominator * denominator);
    return numerator / denominator;
}

static double annulus(double nu, double a, double *derivative)
{
    double p = (1 + a * a) * (1 + a * a), q = a * a;
    return ratio_of_lines(nu, 6 * p, 6 * p, 7 * p + 20 * q, 6 * p + 12 * q, derivative);
}

static double rectangle(double nu, double *derivative)
{
    return ratio_of_lines(nu, 10, 10, 12, 11, derivative);
}

double section_shear_coefficient(const struct section *section, double nu, double *derivative)
{
    return section->rectangular ? rectangle(nu, derivative) : annulus(nu, section->ratio, derivative);
}

HOST_COMPUTES void shear_coefficient(int rectangular, double nu, double a, double *coefficient)
{
    double unused;
    *coefficient = rectangular ? rectangle(nu, &unused) : annulus(nu, a, &unused);
}

static double masked_shear_coefficient(int rectangular, double nu, double a)
{
    fenv_t floating;
    double coefficient;
    host_enter_floating(&floating);
    shear_coefficient(rectangular, nu, a, &coefficient);
    host_leave_floating(&floating);
    return coefficient;
}

double rotid_shear_coefficient_annulus(double nu, double a)
{
    return masked_shear_coefficient(0, nu, a);
}

double rotid_shear_coefficient_rectangle(double nu)
{
    return masked_shear_coefficient(1, nu, 0);
}
