#include "beam/beam.h"

/* Each element matrix is s P(phi)/(1 + phi)^q with a polynomial P of degree <= 2 in phi and four different kinds of entries:
 *   a = P11, b = P12, c = P13, d = P14, e = P22, f = P24, and the rest by symmetry of the element about its middle. */
struct entries {
    double a, b, c, d, e, f;
};

/* matrix [16] := that of these entries */
static void fill(const struct entries *p, double *matrix)
{
    const double rows[16] = {p->a, p->b, p->c, p->d, p->b, p->e, -p->d, p->f, p->c, -p->d, p->a, -p->b, p->d, p->f, -p->b, p->e};
    memcpy(matrix, rows, sizeof rows);
}

static inline void accumulate(const struct entries *p, double factor, struct entries *sum)
{
    sum->a += factor * p->a;
    sum->b += factor * p->b;
    sum->c += factor * p->c;
    sum->d += factor * p->d;
    sum->e += factor * p->e;
    sum->f += factor * p->f;
}

/* (A.1) times (1 + phi) l^3 / EI, and its derivative with respect to phi */
static void stiffness_entries(double phi, double l, struct entries *p, struct entries *dp)
{
    *p = (struct entries){12, -6 * l, -12, -6 * l, (4 + phi) * l * l, (2 - phi) * l * l};
    *dp = (struct entries){0, 0, 0, 0, l * l, -l * l};
}

/* (A.4) times 60 (1 + phi)^2 l / F. Printed with 36 + 60 phi + 30 phi^2 in the corner, which stores 0.40 of the energy F l
 * theta^2/2 of a rigid rotation at phi = 0; the entries below follow from the integral of v'^2 (docs/errata.md). */
static void geometric_entries(double phi, double l, struct entries *p, struct entries *dp)
{
    double a = 72 + 120 * phi + 60 * phi * phi, da = 120 + 120 * phi;
    double r = (10 * phi + 5 * phi * phi) * l * l, dr = (10 + 10 * phi) * l * l;
    *p = (struct entries){a, -6 * l, -a, -6 * l, 8 * l * l + r, -2 * l * l - r};
    *dp = (struct entries){da, 0, -da, 0, dr, -dr};
}

/* (B.1) times 840 (1 + phi)^2 / (rho S l) */
static void translation_entries(double phi, double l, struct entries *p, struct entries *dp)
{
    double q = phi * phi;
    *p = (struct entries){312 + 588 * phi + 280 * q,    -(44 + 77 * phi + 35 * q) * l,  108 + 252 * phi + 140 * q,
                          (26 + 63 * phi + 35 * q) * l, (8 + 14 * phi + 7 * q) * l * l, -(6 + 14 * phi + 7 * q) * l * l};
    *dp = (struct entries){588 + 560 * phi,     -(77 + 70 * phi) * l,    252 + 280 * phi,
                           (63 + 70 * phi) * l, (14 + 14 * phi) * l * l, -(14 + 14 * phi) * l * l};
}

/* (B.2) times 840 (1 + phi)^2 / (rho I l) */
static void rotation_entries(double phi, double l, struct entries *p, struct entries *dp)
{
    double a = 1008 / (l * l), b = -(84 - 420 * phi) / l;
    *p = (struct entries){a, b, -a, b, 112 + 140 * phi + 280 * phi * phi, -(28 + 140 * phi - 140 * phi * phi)};
    *dp = (struct entries){0, 420 / l, 0, 420 / l, 140 + 560 * phi, -140 + 280 * phi};
}

typedef void entries_of(double phi, double l, struct entries *p, struct entries *dp);

/* adds d[s P/(1 + phi)^q] = (ds P + s dphi (P' - q P/(1 + phi)))/(1 + phi)^q */
static void add_derivative(entries_of *of, double phi, double l, int q, double s, double ds, double dphi, struct entries *sum)
{
    struct entries p, dp;
    of(phi, l, &p, &dp);
    double scale = q == 1 ? 1 / (1 + phi) : 1 / ((1 + phi) * (1 + phi));
    accumulate(&p, (ds - s * dphi * q / (1 + phi)) * scale, sum);
    accumulate(&dp, s * dphi * scale, sum);
}

static void add(entries_of *of, double phi, double l, int q, double s, struct entries *sum)
{
    struct entries p, dp;
    of(phi, l, &p, &dp);
    accumulate(&p, q == 1 ? s / (1 + phi) : s / ((1 + phi) * (1 + phi)), sum);
}

static double shear_factor(double ei, double kgs, double l)
{
    return 12 * ei / (kgs * l * l);
}

HOST_COMPUTES void stiffness_matrix(double ei, double kgs, double l, double *stiffness)
{
    struct entries sum = {0};
    add(stiffness_entries, shear_factor(ei, kgs, l), l, 1, ei / (l * l * l), &sum);
    fill(&sum, stiffness);
}

HOST_COMPUTES void geometric_matrix(double force, double phi, double l, double *stiffness)
{
    struct entries sum = {0};
    add(geometric_entries, phi, l, 2, force / (60 * l), &sum);
    fill(&sum, stiffness);
}

HOST_COMPUTES void mass_matrix(double rhos, double rhoi, double phi, double l, double *mass)
{
    struct entries sum = {0};
    add(translation_entries, phi, l, 2, rhos * l / 840, &sum);
    add(rotation_entries, phi, l, 2, rhoi * l / 840, &sum);
    fill(&sum, mass);
}

void rotid_element_stiffness(double ei, double kgs, double l, double *stiffness)
{
    struct host_arithmetic arithmetic;
    host_enter_arithmetic(&arithmetic);
    stiffness_matrix(ei, kgs, l, stiffness);
    host_leave_arithmetic(&arithmetic);
}

void rotid_element_geometric(double force, double phi, double l, double *stiffness)
{
    struct host_arithmetic arithmetic;
    host_enter_arithmetic(&arithmetic);
    geometric_matrix(force, phi, l, stiffness);
    host_leave_arithmetic(&arithmetic);
}

void rotid_element_mass(double rhos, double rhoi, double phi, double l, double *mass)
{
    struct host_arithmetic arithmetic;
    host_enter_arithmetic(&arithmetic);
    mass_matrix(rhos, rhoi, phi, l, mass);
    host_leave_arithmetic(&arithmetic);
}

void element_matrices(const struct element *element, double *k, double *m)
{
    double l = element->length, phi = shear_factor(element->ei, element->kgs, l);
    struct entries sum = {0};
    add(stiffness_entries, phi, l, 1, element->ei / (l * l * l), &sum);
    if (element->force != 0)
        add(geometric_entries, phi, l, 2, element->force / (60 * l), &sum);
    fill(&sum, k);
    mass_matrix(element->rhos, element->rhoi, phi, l, m);
}

void element_derivatives(const struct element *element, const struct element *d, double *dk, double *dm)
{
    double l = element->length, phi = shear_factor(element->ei, element->kgs, l);
    double dphi = phi * (d->ei / element->ei - d->kgs / element->kgs), cube = l * l * l;
    struct entries stiffness = {0}, mass = {0};
    add_derivative(stiffness_entries, phi, l, 1, element->ei / cube, d->ei / cube, dphi, &stiffness);
    if (element->force != 0 || d->force != 0)
        add_derivative(geometric_entries, phi, l, 2, element->force / (60 * l), d->force / (60 * l), dphi, &stiffness);
    add_derivative(translation_entries, phi, l, 2, element->rhos * l / 840, d->rhos * l / 840, dphi, &mass);
    add_derivative(rotation_entries, phi, l, 2, element->rhoi * l / 840, d->rhoi * l / 840, dphi, &mass);
    fill(&stiffness, dk);
    fill(&mass, dm);
}
