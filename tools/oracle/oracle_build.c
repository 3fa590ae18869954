/* Builders: round sections and the tie members, each one finite element of Timoshenko integrated by Gauss quadrature. */
#include <math.h>
#include <string.h>

#include "oracle.h"

static const double pi = 3.14159265358979323846;

double oracle_cowper(double poisson, double ratio)
{
    double a2 = ratio * ratio, b = (1.0 + a2) * (1.0 + a2);

    return 6.0 * (1.0 + poisson) * b / ((7.0 + 6.0 * poisson) * b + (20.0 + 12.0 * poisson) * a2);
}

int oracle_round_segment(double length, double outer_diameter, double inner_diameter, double young, double shear_modulus,
                         double poisson, double density, double axial, struct oracle_segment *segment)
{
    double outer2 = outer_diameter * outer_diameter, inner2 = inner_diameter * inner_diameter;
    double area = pi / 4.0 * (outer2 - inner2), second_moment = pi / 64.0 * (outer2 * outer2 - inner2 * inner2);

    if (!segment || !(length > 0.0) || !(inner_diameter >= 0.0) || !(outer_diameter > inner_diameter) || !(young > 0.0) ||
        !(shear_modulus > 0.0) || !(density > 0.0))
        return ORACLE_ERROR_ARGUMENT;
    segment->length = length;
    segment->bending = young * second_moment;
    segment->shear = oracle_cowper(poisson, inner_diameter / outer_diameter) * shear_modulus * area;
    segment->mass = density * area;
    segment->inertia = density * second_moment;
    segment->axial = axial;
    return ORACLE_OK;
}

/* Solves the 4 by 4 system a x = b for four right-hand sides by elimination with row pivoting; b becomes x. */
static void solve4(double a[16], double b[16])
{
    for (int k = 0; k < 4; k++) {
        int best = k;
        for (int i = k + 1; i < 4; i++)
            best = fabs(a[4 * i + k]) > fabs(a[4 * best + k]) ? i : best;
        for (int j = 0; j < 4; j++) {
            double keep = a[4 * k + j];
            a[4 * k + j] = a[4 * best + j];
            a[4 * best + j] = keep;
            keep = b[4 * k + j];
            b[4 * k + j] = b[4 * best + j];
            b[4 * best + j] = keep;
        }
        for (int i = 0; i < 4; i++) {
            double factor = i == k ? 0.0 : a[4 * i + k] / a[4 * k + k];
            for (int j = 0; j < 4; j++) {
                a[4 * i + j] -= factor * a[4 * k + j];
                b[4 * i + j] -= factor * b[4 * k + j];
            }
        }
    }
    for (int i = 0; i < 16; i++)
        b[i] /= a[5 * (i / 4)];
}

/* Without load and axial force, Q is constant and M' = Q = kGS (v' + theta), so that theta'' = Q/EI. With v = sum a_k x^k,
 * k = 0..3, the shear angle is constant, v' + theta = Q/kGS, and theta'' = -v''' gives Q = -6 a_3 EI:
 *     theta = -(a_1 + 2 a_2 x + 3 a_3 x^2) - 6 a_3 EI/kGS.
 * The values at both ends determine the a_k. The integrands are polynomials of degree 6 at most; four points of Gauss are exact
 * up to degree 7. Here x is z/L and v is divided by L, which keeps the system for the a_k well scaled. */
int oracle_beam_element(const struct oracle_segment *segment, double stiffness[16], double mass[16])
{
    const double inner = sqrt(3.0 / 7.0 - 2.0 / 7.0 * sqrt(1.2)), outer = sqrt(3.0 / 7.0 + 2.0 / 7.0 * sqrt(1.2));
    const double abscissa[4] = {-outer, -inner, inner, outer};
    const double weight[4] = {0.5 - sqrt(30.0) / 36.0, 0.5 + sqrt(30.0) / 36.0, 0.5 + sqrt(30.0) / 36.0, 0.5 - sqrt(30.0) / 36.0};
    double length, shear_term, shear_energy, ends[16], coefficient[16] = {0};

    if (!segment || !stiffness || !mass || !(segment->length > 0.0) || !(segment->bending > 0.0) || !(segment->shear > 0.0))
        return ORACLE_ERROR_ARGUMENT;
    length = segment->length;
    shear_term = 6.0 * segment->bending / (segment->shear * length * length); /* v' + theta = -shear_term a_3 */
    shear_energy = 6.0 * segment->bending / (length * length) * shear_term;   /* kGS shear_term^2, also for an infinite kGS */
    for (int k = 0; k < 4; k++) { /* columns: a_k; rows: v/L and theta at x = 0 and 1 */
        ends[k] = k == 0 ? 1.0 : 0.0;
        ends[4 + k] = (k == 1 ? -1.0 : 0.0) - (k == 3 ? shear_term : 0.0);
        ends[8 + k] = 1.0;
        ends[12 + k] = -(double)k - (k == 3 ? shear_term : 0.0);
        coefficient[5 * k] = k % 2 == 0 ? 1.0 / length : 1.0; /* a unit deflection is 1/L in these terms */
    }
    solve4(ends, coefficient); /* coefficient[4 k + i] = a_k of the displacement i */
    memset(stiffness, 0, 16 * sizeof(stiffness[0]));
    memset(mass, 0, 16 * sizeof(mass[0]));
    for (int point = 0; point < 4; point++) {
        double x = 0.5 + 0.5 * abscissa[point], w = 0.5 * weight[point] * length;
        double v[4], slope[4], theta[4], curvature[4];
        for (int i = 0; i < 4; i++) {
            const double *a = &coefficient[i];
            v[i] = length * (a[0] + x * (a[4] + x * (a[8] + x * a[12])));
            slope[i] = a[4] + x * (2.0 * a[8] + x * 3.0 * a[12]);
            theta[i] = -slope[i] - shear_term * a[12];
            curvature[i] = -(2.0 * a[8] + 6.0 * x * a[12]) / length;
        }
        for (int i = 0; i < 4; i++) {
            for (int j = 0; j < 4; j++) {
                stiffness[4 * i + j] +=
                    w * (segment->bending * curvature[i] * curvature[j] + segment->axial * slope[i] * slope[j] +
                         shear_energy * coefficient[12 + i] * coefficient[12 + j]);
                mass[4 * i + j] += w * (segment->mass * v[i] * v[j] + segment->inertia * theta[i] * theta[j]);
            }
        }
    }
    return ORACLE_OK;
}

static int tie_is_valid(const struct oracle_tie *tie)
{
    return tie && tie->count >= 3 && tie->diameter > 0.0 && tie->pitch_radius > 0.0 && tie->length > 0.0 && tie->young > 0.0 &&
           tie->poisson > -1.0 && tie->poisson <= 0.5 && tie->density > 0.0 && isfinite(tie->tension);
}

/* A rod at the height y_i above the neutral axis is stretched by y_i (theta_b - theta_a) and, its axial displacement being linear
 * in between, moves with the mass matrix rho S L/6 [2 1; 1 2] of a bar on y_i theta. Over three or more evenly spaced rods the
 * sum of y_i^2 is N e^2/2 whatever the orientation. */
int oracle_tie_rods(const struct oracle_tie *tie, double stiffness[16], double mass[16])
{
    static const int rotation[2] = {1, 3};
    struct oracle_segment rods;
    double area, heights, axial_stiffness, axial_mass;
    int status;

    if (!tie_is_valid(tie) || !stiffness || !mass)
        return ORACLE_ERROR_ARGUMENT;
    status = oracle_round_segment(tie->length, tie->diameter, 0.0, tie->young, 0.5 * tie->young / (1.0 + tie->poisson),
                                  tie->poisson, tie->density, tie->tension, &rods);
    if (status)
        return status;
    rods.bending *= tie->count;
    rods.shear *= tie->count;
    rods.mass *= tie->count;
    rods.inertia *= tie->count;
    rods.axial *= tie->count;
    status = oracle_beam_element(&rods, stiffness, mass);
    if (status)
        return status;
    area = pi / 4.0 * tie->diameter * tie->diameter;
    heights = 0.5 * tie->count * tie->pitch_radius * tie->pitch_radius;
    axial_stiffness = tie->young * area / tie->length * heights;
    axial_mass = tie->density * area * tie->length / 6.0 * heights;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            stiffness[4 * rotation[i] + rotation[j]] += i == j ? axial_stiffness : -axial_stiffness;
            mass[4 * rotation[i] + rotation[j]] += i == j ? 2.0 * axial_mass : axial_mass;
        }
    }
    return ORACLE_OK;
}

/* An annulus of area S and second moment I has d_ext^2 - d_int^2 = 4 S/pi and d_ext^2 + d_int^2 = 16 I/S, hence
 * d_ext^2 = 8 I/S + 2 S/pi and d_int^2 = 8 I/S - 2 S/pi. */
int oracle_tie_tube(const struct oracle_tie *tie, double stiffness[16], double mass[16])
{
    struct oracle_segment tube;
    double d2, area, second_moment, outer2, inner2;
    int status;

    if (!tie_is_valid(tie) || !stiffness || !mass)
        return ORACLE_ERROR_ARGUMENT;
    d2 = tie->diameter * tie->diameter;
    area = tie->count * pi / 4.0 * d2;
    second_moment = tie->count * pi / 64.0 * d2 * d2 + 0.5 * area * tie->pitch_radius * tie->pitch_radius;
    outer2 = 8.0 * second_moment / area + 2.0 * area / pi;
    inner2 = 8.0 * second_moment / area - 2.0 * area / pi;
    if (inner2 < 0.0)
        return ORACLE_ERROR_ARGUMENT;
    status = oracle_round_segment(tie->length, sqrt(outer2), sqrt(inner2), tie->young, 0.5 * tie->young / (1.0 + tie->poisson),
                                  tie->poisson, tie->density, tie->count * tie->tension, &tube);
    return status ? status : oracle_beam_element(&tube, stiffness, mass);
}
