/* Element matrices against rigid motions, cantilevers, quadrature of the exact static shapes, and differences. */
#include "beam/beam.h"
#include "support.h"

static const struct element elements[] = {
    {6e6, 3e9, 40, 0.06, 0, 0.0125},      /* a thick rotor: phi = 153.6 */
    {1, 12e6, 3, 1e-4, 2e-3, 1},          /* phi = 1e-6 */
    {2.5, 7.5, 1.7, 0.3, -0.4, 2},        /* phi = 1, compressed */
    {1000, 12, 0.5, 8, 30, 1},            /* phi = 1000 */
    {4.9e3, 2.5e8, 7.85, 4.9e-4, 1e5, 3}, /* a slender steel bar */
};

#define ELEMENTS (sizeof elements / sizeof *elements)

static double shear_factor(const struct element *e)
{
    return 12 * e->ei / (e->kgs * e->length * e->length);
}

static double product(const double *x, const double *a, const double *y)
{
    double sum = 0;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            sum += x[i] * a[i + 4 * j] * y[j];
    return sum;
}

/* Rotations times the length, so that every entry has the same unit and none hides behind the largest. */
static void scale(double l, double *a)
{
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            a[i + 4 * j] /= (i % 2 ? l : 1) * (j % 2 ? l : 1);
}

static double largest(const double *a)
{
    double most = 0;
    for (int i = 0; i < 16; i++)
        most = fmax(most, fabs(a[i]));
    return most;
}

/* v = c0 + c1 z + c2 z^2 + c3 z^3 and theta = gamma - v' with one shear angle gamma: equilibrium EI theta'' = kGS gamma makes
 * gamma = -6 EI c3/kGS. shape[i] [4] are the coefficients c for a unit displacement i, by elimination. */
static void static_shapes(const struct element *e, double shape[4][4])
{
    double l = e->length, s = 6 * e->ei / e->kgs;
    double a[4][8] = {{1, 0, 0, 0, 1, 0, 0, 0},
                      {0, -1, 0, -s, 0, 1, 0, 0},
                      {1, l, l * l, l * l * l, 0, 0, 1, 0},
                      {0, -1, -2 * l, -3 * l * l - s, 0, 0, 0, 1}};
    for (int p = 0; p < 4; p++) {
        int best = p;
        for (int r = p; r < 4; r++)
            if (fabs(a[r][p]) > fabs(a[best][p]))
                best = r;
        for (int c = 0; c < 8; c++) {
            double keep = a[p][c];
            a[p][c] = a[best][c];
            a[best][c] = keep;
        }
        for (int r = 0; r < 4; r++) {
            double factor = r == p ? 0 : a[r][p] / a[p][p];
            for (int c = 0; c < 8; c++)
                a[r][c] -= factor * a[p][c];
        }
    }
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 4; c++)
            shape[i][c] = a[c][4 + i] / a[c][c];
}

/* The energies' second derivatives, integrated with four Gauss points: exact to degree 7, the integrands have degree 6. */
static void integrate(const struct element *e, double *stiffness, double *geometric, double *mass)
{
    const double point[2] = {0.339981043584856264802666, 0.861136311594052575223946};
    const double weight[2] = {0.652145154862546142626936, 0.347854845137453857373064};
    double shape[4][4], l = e->length;
    static_shapes(e, shape);
    memset(stiffness, 0, 16 * sizeof(double));
    memset(geometric, 0, 16 * sizeof(double));
    memset(mass, 0, 16 * sizeof(double));
    for (int g = 0; g < 4; g++) {
        double z = l / 2 * (1 + (g % 2 ? 1 : -1) * point[g / 2]), w = weight[g / 2] * l / 2;
        double v[4], slope[4], theta[4], curvature[4], gamma[4];
        for (int i = 0; i < 4; i++) {
            const double *c = shape[i];
            v[i] = c[0] + z * (c[1] + z * (c[2] + z * c[3]));
            slope[i] = c[1] + z * (2 * c[2] + 3 * z * c[3]);
            gamma[i] = -6 * e->ei / e->kgs * c[3];
            theta[i] = gamma[i] - slope[i];
            curvature[i] = -2 * c[2] - 6 * c[3] * z;
        }
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 4; i++) {
                stiffness[i + 4 * j] += w * (e->ei * curvature[i] * curvature[j] + e->kgs * gamma[i] * gamma[j]);
                geometric[i + 4 * j] += w * e->force * slope[i] * slope[j];
                mass[i + 4 * j] += w * (e->rhos * v[i] * v[j] + e->rhoi * theta[i] * theta[j]);
            }
    }
}

UNIT_TEST(matrices_are_symmetric)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        double k[16], m[16];
        element_matrices(&elements[n], k, m);
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < j; i++) {
                assert_close(k[i + 4 * j], k[j + 4 * i], 0, 0);
                assert_close(m[i + 4 * j], m[j + 4 * i], 0, 0);
            }
    }
}

UNIT_TEST(element_matrices_are_the_sum_of_the_public_ones)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        const struct element *e = &elements[n];
        double k[16], m[16], flexural[16], geometric[16], mass[16], phi = shear_factor(e);
        element_matrices(e, k, m);
        rotid_element_stiffness(e->ei, e->kgs, e->length, flexural);
        rotid_element_geometric(e->force, phi, e->length, geometric);
        rotid_element_mass(e->rhos, e->rhoi, phi, e->length, mass);
        for (int i = 0; i < 16; i++)
            flexural[i] += geometric[i];
        assert_close(relative_difference(16, k, flexural), 0, 0, 1e-15);
        assert_close(relative_difference(16, m, mass), 0, 0, 1e-15);
    }
}

UNIT_TEST(rigid_motion_meets_no_elastic_force)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        double k[16], l = elements[n].length;
        const double rigid[2][4] = {{1, 0, 1, 0}, {0, 1, -l, 1}};
        rotid_element_stiffness(elements[n].ei, elements[n].kgs, l, k);
        scale(l, k);
        for (int r = 0; r < 2; r++)
            for (int i = 0; i < 4; i++) {
                double force = 0;
                for (int j = 0; j < 4; j++)
                    force += k[i + 4 * j] * rigid[r][j] * (j % 2 ? l : 1);
                assert_close(force, 0, 0, 1e-15 * largest(k) * fmax(1, l));
            }
    }
}

UNIT_TEST(rigid_motion_carries_the_whole_mass_and_inertia)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        const struct element *e = &elements[n];
        double k[16], m[16], l = e->length;
        const double translation[4] = {1, 0, 1, 0}, rotation[4] = {l / 2, 1, -l / 2, 1};
        element_matrices(e, k, m);
        assert_close(product(translation, m, translation), e->rhos * l, 1e-12, 0);
        assert_close(product(rotation, m, rotation), e->rhos * l * l * l / 12 + e->rhoi * l, 1e-12, 0);
        assert_close(product(translation, m, rotation), 0, 0, 1e-13 * e->rhos * l * l);
    }
}

UNIT_TEST(rigid_rotation_stores_force_times_length_in_the_geometric_matrix)
{
    const double phi[] = {0, 1e-6, 0.1, 1, 10, 1e3, 1e6}, force = -3.7, l = 0.6;
    for (int n = 0; n < 7; n++) {
        double kg[16];
        const double rotation[4] = {l, 1, 0, 1}, translation[4] = {1, 0, 1, 0};
        rotid_element_geometric(force, phi[n], l, kg);
        assert_close(product(rotation, kg, rotation), force * l, 1e-13, 0);
        assert_close(product(translation, kg, rotation), 0, 0, 1e-13 * fabs(force));
        assert_close(product(translation, kg, translation), 0, 0, 1e-13 * fabs(force) / l);
    }
}

/* Fixed at the left end. Tip load P: v = P (l^3/3EI + l/kGS), theta = -P l^2/2EI; tip moment M: theta = M l/EI, v = -M l^2/2EI.
 */
UNIT_TEST(cantilever_bends_and_shears_as_the_closed_form)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        const struct element *e = &elements[n];
        double k[16], l = e->length;
        rotid_element_stiffness(e->ei, e->kgs, l, k);
        const double load[4] = {0, 0, l * l * l / (3 * e->ei) + l / e->kgs, -l * l / (2 * e->ei)};
        const double moment[4] = {0, 0, -l * l / (2 * e->ei), l / e->ei};
        const double tip_v[4] = {0, 0, 1, 0}, tip_theta[4] = {0, 0, 0, 1}, root_v[4] = {1, 0, 0, 0}, root_theta[4] = {0, 1, 0, 0};
        double tolerance = 1e-14 * (k[10] * load[2] + fabs(k[14] * load[3]));
        assert_close(product(tip_v, k, load), 1, 0, tolerance);
        assert_close(product(tip_theta, k, load), 0, 0, tolerance * l);
        assert_close(product(root_v, k, load), -1, 0, tolerance);
        assert_close(product(root_theta, k, load), l, 0, tolerance * l); /* turning with theta = -dv/dz is clockwise */
        tolerance = 1e-14 * (fabs(k[11] * moment[2]) + k[15] * moment[3]);
        assert_close(product(tip_v, k, moment), 0, 0, tolerance / l);
        assert_close(product(tip_theta, k, moment), 1, 0, tolerance);
        assert_close(product(root_v, k, moment), 0, 0, tolerance / l);
        assert_close(product(root_theta, k, moment), -1, 0, tolerance);
    }
}

UNIT_TEST(matrices_are_the_integrals_of_the_static_shapes)
{
    for (size_t n = 0; n < ELEMENTS; n++) {
        const struct element *e = &elements[n];
        double k[16], kg[16], m[16], k_expected[16], kg_expected[16], m_expected[16];
        rotid_element_stiffness(e->ei, e->kgs, e->length, k);
        rotid_element_geometric(e->force, shear_factor(e), e->length, kg);
        rotid_element_mass(e->rhos, e->rhoi, shear_factor(e), e->length, m);
        integrate(e, k_expected, kg_expected, m_expected);
        double *both[3][2] = {{k, k_expected}, {kg, kg_expected}, {m, m_expected}};
        for (int i = 0; i < 3; i++) {
            scale(e->length, both[i][0]);
            scale(e->length, both[i][1]);
            assert_close(relative_difference(16, both[i][0], both[i][1]), 0, 0, 2e-12);
        }
    }
}

static struct element moved(const struct element *e, const struct element *d, double h)
{
    return (struct element){e->ei + h * d->ei,     e->kgs + h * d->kgs,     e->rhos + h * d->rhos,
                            e->rhoi + h * d->rhoi, e->force + h * d->force, e->length};
}

/* Largest error of element_derivatives against differences of fourth order, and what rounding of the differenced matrices may add
 * to it, both relative to the largest derivative; size is that derivative over the largest entry, to see that there is one. */
static double derivative_error(const struct element *e, const struct element *d, double *rounding, double *size)
{
    const double h = 1e-3, step[4] = {h, -h, 2 * h, -2 * h}, weight[4] = {8, -8, -1, 1};
    double exact[2][16], difference[2][16] = {{0}}, value[2][16], worst = 0;
    element_derivatives(e, d, exact[0], exact[1]);
    for (int s = 0; s < 4; s++) {
        struct element near = moved(e, d, step[s]);
        element_matrices(&near, value[0], value[1]);
        for (int a = 0; a < 2; a++)
            for (int i = 0; i < 16; i++)
                difference[a][i] += weight[s] * value[a][i] / (12 * h);
    }
    *size = *rounding = 0;
    for (int a = 0; a < 2; a++) {
        scale(e->length, exact[a]);
        scale(e->length, difference[a]);
        scale(e->length, value[a]);
        if (largest(exact[a]) == 0 && largest(difference[a]) == 0) /* K does not depend on the mass, nor M on the force */
            continue;
        *size = fmax(*size, largest(exact[a]) / largest(value[a]));
        *rounding = fmax(*rounding, 4e-16 / h * largest(value[a]) / largest(exact[a]));
        worst = fmax(worst, relative_difference(16, difference[a], exact[a]));
    }
    return worst;
}

UNIT_TEST(derivatives_agree_with_differences_in_each_quantity_and_a_mixed_direction)
{
    double worst = 0;
    for (size_t n = 0; n < ELEMENTS; n++) {
        const struct element *e = &elements[n];
        double force = fmax(fabs(e->force), 0.01 * e->kgs);
        const struct element directions[] = {
            {.ei = e->ei},     {.kgs = e->kgs},  {.rhos = e->rhos},
            {.rhoi = e->rhoi}, {.force = force}, {0.3 * e->ei, -0.7 * e->kgs, 1.1 * e->rhos, -0.4 * e->rhoi, 0.6 * force, 0}};
        for (int i = 0; i < 6; i++) {
            double rounding, size, error = derivative_error(e, &directions[i], &rounding, &size);
            assert_true(size > 1e-8);
            assert_close(error, 0, 0, 1e-8 + rounding);
            if (rounding < 1e-9)
                worst = fmax(worst, error);
        }
    }
    print_message("largest relative error of a derivative %.1e\n", worst);
}

/* In phi the geometric part has no other test: with an axial force that carries the whole stiffness it must not hide behind K_f.
 */
UNIT_TEST(geometric_part_is_differentiated_through_the_shear_factor)
{
    const double l = 0.8, ei = 1.3, kgs = 12 * ei / (l * l) / 0.7, force = 1e12, h = 1e-3;
    const struct element e = {ei, kgs, 1, 0.1, force, l}, d = {.kgs = kgs};
    double dk[16], dm[16], kg[16], expected[16] = {0};
    const double step[4] = {h, -h, 2 * h, -2 * h}, weight[4] = {8, -8, -1, 1};
    element_derivatives(&e, &d, dk, dm);
    for (int s = 0; s < 4; s++) {
        rotid_element_geometric(force, 0.7 / (1 + step[s]), l, kg);
        for (int i = 0; i < 16; i++)
            expected[i] += weight[s] * kg[i] / (12 * h);
    }
    scale(l, dk);
    scale(l, expected);
    assert_true(largest(expected) > 1e9);
    assert_close(relative_difference(16, dk, expected), 0, 0, 1e-9);
}
