/* Cross sections against sums over holes and rods, limits of Cowper's coefficient and inversion. */
#include "beam/beam.h"
#include "rotor/rotor.h"
#include "support.h"

static const double pi = 3.14159265358979323846;
static const int counts[] = {3, 4, 5, 12};

#define COUNTS (sizeof counts / sizeof *counts)

/* In radii, from the integral of r^3 over the ring: the code works with diameters. */
static double ring_area(double ro, double ri)
{
    return pi * (ro - ri) * (ro + ri);
}

static double ring_inertia(double ro, double ri)
{
    return pi / 4 * (ro - ri) * (ro + ri) * (ro * ro + ri * ri);
}

/* N discs of diameter d on the pitch radius e, the first at angle `start` from the neutral axis (parallel-axis theorem) */
static double exact_inertia(int number, double d, double e, double start)
{
    double sum = 0;
    for (int i = 0; i < number; i++) {
        double arm = e * sin(start + 2 * pi * i / number);
        sum += ring_inertia(d / 2, 0) + ring_area(d / 2, 0) * arm * arm;
    }
    return sum;
}

UNIT_TEST(round_section_has_the_moments_of_a_ring)
{
    const double inner[] = {0, 0.02, 0.1, 0.19};
    for (int i = 0; i < 4; i++) {
        struct section s;
        section_round(0.2, inner[i], 0.2, &s);
        assert_close(s.mass_area, ring_area(0.1, inner[i] / 2), 1e-13, 0);
        assert_close(s.mass_inertia, ring_inertia(0.1, inner[i] / 2), 1e-13, 0);
        assert_close(s.stiff_area, s.mass_area, 0, 0);
        assert_close(s.stiff_inertia, s.mass_inertia, 0, 0);
        assert_close(s.ratio, inner[i] / 0.2, 1e-15, 0);
        assert_int_equal(s.rectangular, 0);
    }
}

UNIT_TEST(stiffness_diameter_moves_stiffness_and_leaves_mass)
{
    struct section plain, limited;
    section_round(0.3, 0.05, 0.3, &plain);
    section_round(0.3, 0.05, 0.22, &limited);
    assert_close(limited.mass_area, plain.mass_area, 0, 0);
    assert_close(limited.mass_inertia, plain.mass_inertia, 0, 0);
    assert_close(limited.stiff_area, ring_area(0.11, 0.025), 1e-13, 0);
    assert_close(limited.stiff_inertia, ring_inertia(0.11, 0.025), 1e-13, 0);
    assert_close(limited.ratio, 0.05 / 0.22, 1e-15, 0); /* the shear coefficient belongs to what carries shear */
}

UNIT_TEST(rectangle_bends_in_the_direction_of_its_height)
{
    struct section s;
    section_rectangular(0.03, 0.05, &s);
    double sum = 0; /* strips, midpoint rule: exact to 1/(4 n^2) */
    for (int i = 0; i < 1000; i++) {
        double y = 0.03 * ((i + 0.5) / 1000 - 0.5);
        sum += y * y * 0.05 * 0.03 / 1000;
    }
    assert_close(s.stiff_area, 0.03 * 0.05, 1e-14, 0);
    assert_close(s.stiff_inertia, sum, 2e-6, 0);
    assert_close(s.mass_area, s.stiff_area, 0, 0);
    assert_close(s.mass_inertia, s.stiff_inertia, 0, 0);
    assert_int_equal(s.rectangular, 1);
}

UNIT_TEST(perforation_takes_the_exact_sum_over_holes_at_any_rotation)
{
    const double d = 0.024, e = 0.11, start[] = {0, 0.3, 1.1, 2.7};
    for (size_t n = 0; n < COUNTS; n++)
        for (int a = 0; a < 4; a++) {
            struct section s, whole;
            section_round(0.3, 0.04, 0.28, &whole);
            s = whole;
            assert_status(section_perforate(counts[n], d, e, 0.28, &s), ROTID_OK);
            double inertia = exact_inertia(counts[n], d, e, start[a]), area = counts[n] * ring_area(d / 2, 0);
            assert_close(whole.mass_area - s.mass_area, area, 1e-12, 0);
            assert_close(whole.stiff_area - s.stiff_area, area, 1e-12, 0);
            assert_close(whole.mass_inertia - s.mass_inertia, inertia, 1e-12, 0);
            assert_close(whole.stiff_inertia - s.stiff_inertia, inertia, 1e-12, 0);
            assert_close(s.ratio, whole.ratio, 0, 0);
        }
    /* with two holes the sum depends on the angle: from three on is a condition, not a habit */
    assert_true(exact_inertia(2, d, e, pi / 2) > 10 * exact_inertia(2, d, e, 0));
}

UNIT_TEST(holes_outside_the_stiffness_diameter_cost_mass_only)
{
    struct section s, whole;
    section_round(0.3, 0, 0.2, &whole);
    s = whole;
    assert_status(section_perforate(8, 0.02, 0.12, 0.2, &s), ROTID_OK);
    assert_close(s.stiff_area, whole.stiff_area, 0, 0);
    assert_close(s.stiff_inertia, whole.stiff_inertia, 0, 0);
    assert_close(whole.mass_inertia - s.mass_inertia, exact_inertia(8, 0.02, 0.12, 0.2), 1e-12, 0);
}

UNIT_TEST(holes_that_leave_nothing_are_an_error)
{
    struct section s;
    section_round(0.1, 0.08, 0.1, &s);
    assert_status(section_perforate(12, 0.04, 0.045, 0.1, &s), ROTID_ERROR_SECTION);
}

UNIT_TEST(equivalent_cylinder_gives_an_annulus_back)
{
    const double annulus[][2] = {{0.3, 0.2}, {0.3, 0.299}, {3e-3, 1e-3}, {40, 1}};
    for (int i = 0; i < 4; i++) {
        double ro = annulus[i][0] / 2, ri = annulus[i][1] / 2, outer, inner, area = ring_area(ro, ri),
               inertia = ring_inertia(ro, ri);
        struct section s;
        assert_status(rotid_equivalent_cylinder(area, inertia, NULL, &outer, &inner), ROTID_OK);
        assert_close(outer, 2 * ro, 1e-14, 0);
        /* inner^2 is a difference, so its rounding is that of outer^2 */
        assert_close(inner, 2 * ri, 1e-15 + 1e-15 * ro * ro / (ri * ri), 0);
        assert_status(section_equivalent(area, inertia, &s), ROTID_OK);
        assert_close(s.stiff_area, area, 0, 0);
        assert_close(s.stiff_inertia, inertia, 0, 0);
        assert_close(s.mass_area, area, 0, 0);
        assert_close(s.mass_inertia, inertia, 0, 0);
        assert_close(s.ratio, ri / ro, 1e-13, 1e-13);
    }
}

UNIT_TEST(solid_disc_is_the_limit_of_the_equivalent_cylinder)
{
    for (int i = 1; i <= 200; i++) { /* rounding must never make an error of a disc */
        double r = 0.0137 * i, outer, inner;
        assert_status(rotid_equivalent_cylinder(ring_area(r, 0), ring_inertia(r, 0), NULL, &outer, &inner), ROTID_OK);
        assert_close(outer, 2 * r, 1e-14, 0);
        assert_close(inner, 0, 0, 1e-6 * r);
    }
}

UNIT_TEST(section_softer_than_a_disc_of_its_area_is_refused)
{
    double outer, inner, area = ring_area(0.1, 0), inertia = ring_inertia(0.1, 0);
    struct section s;
    assert_status(rotid_equivalent_cylinder(area, inertia * (1 - 1e-9), NULL, &outer, &inner), ROTID_ERROR_SECTION);
    assert_status(rotid_equivalent_cylinder(area, inertia / 2, NULL, &outer, &inner), ROTID_ERROR_SECTION);
    assert_status(section_equivalent(area, inertia / 2, &s), ROTID_ERROR_SECTION);
    const double bad[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        assert_status(rotid_equivalent_cylinder(bad[i], inertia, NULL, &outer, &inner), ROTID_ERROR_ARGUMENT);
        assert_status(rotid_equivalent_cylinder(area, bad[i], NULL, &outer, &inner), ROTID_ERROR_ARGUMENT);
    }
}

UNIT_TEST(rods_have_the_exact_sum_at_any_rotation)
{
    const double d = 0.032, e = 0.13364;
    for (size_t n = 0; n < COUNTS; n++)
        for (double start = 0; start < 3; start += 0.7) {
            double area, own, pitch;
            section_rods(counts[n], d, e, &area, &own, &pitch);
            assert_close(area, counts[n] * ring_area(d / 2, 0), 1e-14, 0);
            assert_close(own, counts[n] * ring_inertia(d / 2, 0), 1e-14, 0);
            assert_close(own + pitch, exact_inertia(counts[n], d, e, start), 1e-13, 0);
        }
}

/* The disc has the least second moment of all sections of an area: rods that touch but do not overlap always have their annulus.
 */
UNIT_TEST(rods_that_do_not_overlap_always_have_an_equivalent_cylinder)
{
    for (int number = 3; number <= 60; number++) {
        double area, own, pitch, outer, inner, d = 0.02, touching = d / (2 * sin(pi / number));
        section_rods(number, d, touching, &area, &own, &pitch);
        assert_status(rotid_equivalent_cylinder(area, own + pitch, NULL, &outer, &inner), ROTID_OK);
        assert_true(inner > 0);
    }
}

UNIT_TEST(cowper_has_its_limits_of_solid_and_thin_walled_circle)
{
    for (double nu = -0.9; nu <= 0.5; nu += 0.1) {
        double solid = 6 * (1 + nu) / (7 + 6 * nu), thin = 2 * (1 + nu) / (4 + 3 * nu), last = solid;
        assert_close(rotid_shear_coefficient_annulus(nu, 0), solid, 1e-14, 0);
        assert_close(rotid_shear_coefficient_annulus(nu, 1), thin, 1e-14, 0);
        /* deviations from the limits are of second order in a and in 1 - a */
        double near_solid = solid - rotid_shear_coefficient_annulus(nu, 1e-3);
        double near_thin = rotid_shear_coefficient_annulus(nu, 1 - 1e-3) - thin;
        assert_true(near_solid > 0 && near_solid < 3e-5);
        assert_true(near_thin > 0 && near_thin < 3e-5);
        for (double a = 0.05; a < 1.001; a += 0.05) { /* a bore can only take shear stiffness away */
            double k = rotid_shear_coefficient_annulus(nu, a);
            assert_true(k < last);
            last = k;
        }
    }
    assert_close(rotid_shear_coefficient_rectangle(0), 5.0 / 6, 1e-15, 0);
    assert_close(rotid_shear_coefficient_rectangle(0.3), 0.849673202614379, 1e-14, 0); /* 13/15.3 */
}

/* Without lateral contraction Cowper's mean deflection and the shear energy agree: 1/k = A/Q^2 times the integral of tau^2 over
 * the section, here with Saint-Venant's exact shear stresses in a bent round bar. */
UNIT_TEST(cowper_at_nu_zero_is_the_shear_energy_of_a_circle)
{
    const int n = 400;
    double energy = 0; /* radius 1, Q = 1, nu = 0: tau_yz = (3 (1 - y^2) - x^2)/(8 I), tau_xz = -x y/(4 I), I = pi/4 */
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double r = (i + 0.5) / n, angle = 2 * pi * (j + 0.5) / n, x = r * cos(angle), y = r * sin(angle);
            double across = (3 * (1 - y * y) - x * x) / (2 * pi), along = -x * y / pi;
            energy += (across * across + along * along) * r * (1.0 / n) * (2 * pi / n);
        }
    assert_close(1 / (pi * energy), rotid_shear_coefficient_annulus(0, 0), 1e-5, 0);
}

UNIT_TEST(shear_stiffness_chooses_by_shape)
{
    struct section s[3];
    section_round(0.2, 0, 0.2, &s[0]);
    section_round(0.2, 0.13, 0.18, &s[1]);
    section_rectangular(0.1, 0.02, &s[2]);
    for (int i = 0; i < 3; i++)
        for (double nu = -0.5; nu < 0.46; nu += 0.19) {
            struct material material = {.e = 2e11, .nu = nu, .isotropic = 1};
            double k = i == 2 ? rotid_shear_coefficient_rectangle(nu) : rotid_shear_coefficient_annulus(nu, s[i].ratio);
            assert_close(shear_stiffness_plain(&s[i], &material), k * material_shear_modulus(&material) * s[i].stiff_area, 1e-15,
                         0);
        }
}
