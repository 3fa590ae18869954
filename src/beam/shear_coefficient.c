#include "beam/shear_coefficient.h"

#include "base/host.h"
#include "rotid.h"

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

double shear_coefficient(const struct section *section, double nu, double *derivative)
{
    return section->rectangular ? rectangle(nu, derivative) : annulus(nu, section->ratio, derivative);
}

HOST_COMPUTES void compute(int rectangular, double nu, double a, double *coefficient)
{
    double unused;
    *coefficient = rectangular ? rectangle(nu, &unused) : annulus(nu, a, &unused);
}

static double masked_shear_coefficient(int rectangular, double nu, double a)
{
    fenv_t floating;
    double coefficient;
    host_enter_floating(&floating);
    compute(rectangular, nu, a, &coefficient);
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
