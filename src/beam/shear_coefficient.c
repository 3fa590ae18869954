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

struct cowper { /* k = n (1 + nu)/(d0 + d1 nu) */
    double n, d0, d1;
};

static struct cowper annulus(double a)
{
    double p = (1 + a * a) * (1 + a * a), q = a * a;
    return (struct cowper){6 * p, 7 * p + 20 * q, 6 * p + 12 * q};
}

static const struct cowper rectangle = {10, 12, 11};

static double isotropic(struct cowper c, double nu, double *derivative)
{
    return ratio_of_lines(nu, c.n, c.n, c.d0, c.d1, derivative);
}

/* The flexure function of a bar with E along the axis, G and nu between the axis and the plane solves a linear problem whose data
 * are E/G and nu, and 1/k is G/E times an integral of it: 1/k = c0 - c1 x with x = nu G/E, whatever the section. Cowper's k,
 * where x = nu/(2(1 + nu)), gives both: c0 = d0/n, c1 = 2 (d0 - d1)/n. */
static double across_sheets(struct cowper c, double x, double *derivative)
{
    return ratio_of_lines(x, c.n, 0, c.d0, -2 * (c.d0 - c.d1), derivative);
}

static struct cowper of_section(const struct section *section)
{
    return section->rectangular ? rectangle : annulus(section->ratio);
}

double shear_coefficient(const struct section *section, double nu, double *derivative)
{
    return isotropic(of_section(section), nu, derivative);
}

/* Axial stress strains a sheet as it would strain steel: nu of the stack is nu of the sheet times E/E_sheet, so that
 * x = nu_sheet G/E_sheet, whatever E. */
static void of_stack(const struct section *section, const struct material *material, struct shear_resistance *shear)
{
    double dk, x = material->nu * material->g / material->sheet_e, k = across_sheets(of_section(section), x, &dk);
    *shear = (struct shear_resistance){
        .kg = k * material->g, .by_g = k + dk * x, .by_nu = dk * material->g / material->sheet_e * material->g};
}

void shear_resistance(const struct section *section, const struct material *material, struct shear_resistance *shear)
{
    double dk, k, g = material_shear_modulus(material);
    if (material->laminated) {
        of_stack(section, material, shear);
        return;
    }
    k = shear_coefficient(section, material->nu, &dk);
    *shear = (struct shear_resistance){.kg = k * g,
                                       .by_e = material->isotropic ? k * g / material->e : 0,
                                       .by_g = k,
                                       .by_nu = dk * g - (material->isotropic ? k * g / (1 + material->nu) : 0)};
}

HOST_COMPUTES void compute(int rectangular, double nu, double a, double *coefficient)
{
    double unused;
    *coefficient = isotropic(rectangular ? rectangle : annulus(a), nu, &unused);
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
