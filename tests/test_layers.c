/* Layers of a beam: what parts of a section do together, the shear coefficient of sheets across the axis, derivatives by the
 * parameters and effects of a layer; and how a deck lays them. */
#include "beam/beam.h"
#include "deck/deck.h"
#include "effect_bench.h"
#include "folder.h"
#include "model/model.h"
#include "reading.h"
#include "solid/solid.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------------------------------------ sheets across the axis */

/* 1/k of an annulus of outer radius 1 and inner radius a by finite differences: the flexure function f(r) cos t of a bar with
 * beta = E/G and nu along the axis solves f'' + f'/r - f/r^2 = (beta - 2 nu) r with f' = -nu r^2/2 at both radii, and
 * 1/k = -pi S/(beta I^2) times the integral of f r^2. Ghost points beyond both radii. */
static double inverse_by_differences(double a, double beta, double nu, int n)
{
    static double f[4001], upper[4001];
    double h = (1 - a) / n, pivot = 0, sum = 0;
    for (int i = 0; i <= n; i++) {
        double r = a + h * i, low = 1 / (h * h) - 1 / (2 * h * r), high = 1 / (h * h) + 1 / (2 * h * r);
        double diagonal = -2 / (h * h) - 1 / (r * r), right = (beta - 2 * nu) * r, slope = -nu * r * r / 2;
        if (i == 0) {
            right += low * 2 * h * slope;
            high += low;
            low = 0;
        } else if (i == n) {
            right -= high * 2 * h * slope;
            low += high;
            high = 0;
        }
        pivot = diagonal - (i ? low * upper[i - 1] : 0);
        upper[i] = high / pivot;
        f[i] = (right - (i ? low * f[i - 1] : 0)) / pivot;
    }
    for (int i = n - 1; i >= 0; i--)
        f[i] -= upper[i] * f[i + 1];
    for (int i = 0; i <= n; i++)
        sum += (i == 0 || i == n ? 0.5 : 1) * h * f[i] * (a + h * i) * (a + h * i);
    double area = pi * (1 - a * a), inertia = pi / 4 * (1 - a * a * a * a);
    return -pi * area / (beta * inertia * inertia) * sum;
}

static struct material stack(double e, double g, double nu)
{
    return (struct material){
        .name = "sheets", .e = e, .g = g, .nu = nu, .rho = 7600, .laminated = 1, .sheet_e = 2.1e11, .stacking = 0.97};
}

static double inverse_of(const struct section *section, const struct material *material)
{
    return material->g * section->stiff_area / shear_stiffness_plain(section, material);
}

POOL_TEST(shear_of_a_stack_is_that_of_the_flexure_function)
{
    const double ratio[] = {0.1, 0.45, 0.9}, e[] = {1.2e10, 2.1e11}, g[] = {0.3e10, 0.8e11};
    for (int i = 0; i < 12; i++) {
        struct section section;
        struct material material = stack(e[i / 3 % 2], g[i / 6], 0.29);
        double nu = material.nu * material.e / material.sheet_e; /* along the axis */
        section_round(1, ratio[i % 3], 1, &section);
        double coarse = inverse_by_differences(ratio[i % 3], material.e / material.g, nu, 2000);
        double fine = inverse_by_differences(ratio[i % 3], material.e / material.g, nu, 4000);
        assert_close(inverse_of(&section, &material), fine + (fine - coarse) / 3, 1e-7, 0);
    }
}

POOL_TEST(shear_of_a_stack_has_its_limits)
{
    struct section disc, ring, plate;
    struct material material = stack(1.5e10, 0.7e10, 0.3);
    double x = 0.3 * 0.7e10 / 2.1e11;
    section_round(1, 0, 1, &disc);
    section_round(1, 1 - 1e-7, 1, &ring);
    section_rectangular(2, 1, &plate);
    assert_close(inverse_of(&disc, &material), 7.0 / 6 - x / 3, 1e-14, 0); /* Dharmarajan and McCutchen */
    assert_close(inverse_of(&ring, &material), 2 - x, 1e-12, 0);
    assert_close(inverse_of(&plate, &material), 1.2 - x / 5, 1e-14, 0);
    for (double nu = -0.5; nu < 0.5; nu += 0.1) { /* a stack of the stiffness of its sheets is a piece of steel */
        struct material steel = {.e = 2.1e11, .nu = nu, .isotropic = 1}, same = stack(2.1e11, 2.1e11 / (2 * (1 + nu)), nu);
        section_round(1, 0.6, 1, &ring);
        same.stacking = 1;
        steel.g = material_shear_modulus(&steel);
        assert_close(inverse_of(&ring, &same), inverse_of(&ring, &steel), 1e-14, 0);
        assert_close(inverse_of(&plate, &same), inverse_of(&plate, &steel), 1e-14, 0);
    }
}

/* kGS of layers of these materials, and its derivative by a value of material `which` */
static double layered_shear(int count, const struct section *section, const struct material *material, int which,
                            enum parameter_kind kind, double *derivative)
{
    struct shear_layer layer[5];
    for (int i = 0; i < count; i++)
        layer[i] = (struct shear_layer){.material = shear_material_of(&material[i]), .section = &section[i]};
    double shear = shear_stiffness(count, layer);
    struct shear_material v = shear_material_derivative(&material[which], kind);
    *derivative = shear_material_product(&layer[which].by, &v);
    return shear;
}

/* what contraction adds to EI or ES, likewise */
static double contraction_of(enum mode_type type, int count, const struct section *section, const struct material *material,
                             int which, enum parameter_kind kind, double *derivative)
{
    struct shear_layer layer[5];
    for (int i = 0; i < count; i++)
        layer[i] = (struct shear_layer){.material = shear_material_of(&material[i]), .section = &section[i]};
    double sum = contraction_stiffness(type, count, layer);
    struct shear_material v = shear_material_derivative(&material[which], kind);
    *derivative = shear_material_product(&layer[which].contraction, &v);
    return sum;
}

static double bending_of(int count, const struct section *section, const struct material *material, int which,
                         enum parameter_kind kind, double *derivative)
{
    return contraction_of(MODE_BENDING, count, section, material, which, kind, derivative);
}

static double tension_of(int count, const struct section *section, const struct material *material, int which,
                         enum parameter_kind kind, double *derivative)
{
    return contraction_of(MODE_AXIAL, count, section, material, which, kind, derivative);
}

POOL_TEST(derivatives_of_the_shear_of_any_materials_are_right)
{
    const struct material materials[4] = {stack(1.5e10, 6e10, 0.3),
                                          {.e = 2e11, .nu = 0.28, .isotropic = 1},
                                          {.e = 1e11, .g = 3e10, .nu = 0.25},
                                          stack(9e10, 4e10, 0.2)};
    const double diameter[] = {0.2, 0.4, 0.45, 0.7, 0.8};
    struct section section[4];
    for (int i = 0; i < 4; i++)
        section_round(diameter[i + 1], diameter[i], diameter[i + 1], &section[i]);
    assert_status(section_perforate(6, 0.05, 0.28, 0.7, &section[2]), ROTID_OK);
    for (int all = 0; all < 2; all++)
        for (int i = 0; i < 4; i++)
            for (int p = 0; p < 3; p++) {
                struct material m[4];
                int first = all ? 0 : i, count = all ? 4 : 1;
                memcpy(m, materials, sizeof m);
                double *value = p == 0 ? &m[i].e : p == 1 ? &m[i].g : &m[i].nu, was = *value, by, unused, d[2];
                enum parameter_kind kind = p == 0 ? PARAMETER_E : p == 1 ? PARAMETER_G : PARAMETER_NU;
                if (p == 1 && m[i].isotropic)
                    continue;
                static double (*const of[])(int, const struct section *, const struct material *, int, enum parameter_kind,
                                            double *) = {layered_shear, bending_of, tension_of};
                for (int f = 0; f < 3; f++) {
                    double here = of[f](count, section + first, m + first, i - first, kind, &by);
                    for (int k = 0; k < 2; k++) {
                        double step = 1e-3 * (k + 1);
                        *value = was * (1 + step);
                        double up = of[f](count, section + first, m + first, i - first, kind, &unused);
                        *value = was * (1 - step);
                        d[k] = (up - of[f](count, section + first, m + first, i - first, kind, &unused)) / (2 * step * was);
                        *value = was;
                    }
                    assert_close((4 * d[0] - d[1]) / 3, by, 1e-9, 1e-11 * here / was);
                    assert_true(f == 0 || all == 0 || p == 1 || fabs(by) > 1e-4 * here / was);
                }
            }
    double unused; /* what is said of x = nu_sheet G/E_sheet: in one material E along the axis plays no part */
    struct material m = materials[0], stiffer = m;
    stiffer.e *= 1.5;
    assert_close(layered_shear(1, section, &m, 0, PARAMETER_E, &unused),
                 layered_shear(1, section, &stiffer, 0, PARAMETER_E, &unused), 0, 0);
}

/* ------------------------------------------------------------------------------------------------ layers */

/* kGS of two layers from a to b to 1 by linear elements of the axial displacement: another discretisation of the flexure
 * function, with nu_a itself in place of x = nu_a G/E. */
static double by_elements(double a, double b, const double *e, const double *g, const double *nu, int n)
{
    static double diagonal[4002], off[4002], right[4002], weight[4002];
    double j = 0, mean = 0;
    for (int i = 0; i <= n; i++)
        diagonal[i] = off[i] = right[i] = weight[i] = 0;
    for (int i = 0; i < n; i++) {
        int of = 2 * i >= n;
        double from = of ? b + (1 - b) * (2.0 * i / n - 1) : a + (b - a) * 2 * i / n, h = 2 * (of ? 1 - b : b - a) / n;
        for (int q = -1; q <= 1; q += 2) {
            double t = 0.5 + q / sqrt(12), r = from + h * t, shape[2] = {1 - t, t}, slope[2] = {-1 / h, 1 / h};
            j += e[of] * r * r * r * h / 2;
            for (int k = 0; k < 2; k++) {
                weight[i + k] += e[of] * r * r * shape[k] * h / 2;
                right[i + k] += (e[of] * r * r * shape[k] + g[of] * nu[of] * r * r / 2 * (r * slope[k] - shape[k])) * h / 2;
                diagonal[i + k] += g[of] * (slope[k] * slope[k] + shape[k] * shape[k] / (r * r)) * r * h / 2;
            }
            off[i] += g[of] * (slope[0] * slope[1] + shape[0] * shape[1] / (r * r)) * r * h / 2;
        }
    }
    for (int i = 0; i < n; i++) {
        diagonal[i + 1] -= off[i] * off[i] / diagonal[i];
        right[i + 1] -= off[i] / diagonal[i] * right[i];
    }
    for (int i = n; i >= 0; i--) {
        right[i] = (right[i] - (i < n ? off[i] * right[i + 1] : 0)) / diagonal[i];
        mean += weight[i] * right[i];
    }
    return pi * j * j / mean;
}

POOL_TEST(shear_of_two_layers_is_that_of_the_flexure_function)
{
    const struct material pairs[][2] = {{{.e = 2.1e11, .nu = 0.3, .isotropic = 1}, stack(1.2e10, 0.4e10, 0.29)},
                                        {stack(1e11, 0.5e11, 0.3), {.e = 7e10, .nu = 0.34, .isotropic = 1}},
                                        {{.e = 1e11, .g = 2e10, .nu = 0.25}, {.e = 2e11, .nu = 0.28, .isotropic = 1}}};
    const double bore[] = {0.05, 0.4}, cut[] = {0.45, 0.9};
    for (int i = 0; i < 12; i++) {
        const struct material *m = pairs[i / 4];
        double a = bore[i % 2], b = cut[i / 2 % 2], e[2], g[2], nu[2], unused;
        struct section section[2];
        section_round(2 * b, 2 * a, 2 * b, &section[0]);
        section_round(2, 2 * b, 2, &section[1]);
        for (int k = 0; k < 2; k++) {
            e[k] = m[k].e;
            g[k] = material_shear_modulus(&m[k]);
            nu[k] = m[k].laminated ? m[k].nu * e[k] / m[k].sheet_e : m[k].nu * e[k] / (2 * (1 + m[k].nu) * g[k]);
        }
        double coarse = by_elements(a, b, e, g, nu, 2000), fine = by_elements(a, b, e, g, nu, 4000);
        assert_close(layered_shear(2, section, m, 0, PARAMETER_E, &unused), fine + (fine - coarse) / 3, 1e-7, 0);
    }
}

struct radial_point { /* of linear elements along the radius, n in each layer: one of the two of Gauss in element e */
    struct elasticity c;
    double r, w;              /* radius, and weight times r */
    double share[2], rate[2]; /* of the values at both ends over r, and their derivatives */
};

static struct radial_point radial_point(const double *radius, const struct material *material, int n, int e, int q)
{
    double h = (radius[e / n + 1] - radius[e / n]) / n, t = 0.5 + (q ? 1 : -1) / sqrt(12), r = radius[e / n] + (e % n + t) * h;
    return (struct radial_point){elasticity_of(&material[e / n], &(struct elasticity_factors){1, 1, 1}),
                                 r,
                                 r * h / 2,
                                 {(1 - t) / r, t / r},
                                 {-1 / h, 1 / h}};
}

/* EI of layers by linear elements of the motion in the plane, U cos t and V sin t, for the axial strain r cos t: pi times the
 * energy of the strains U', (U + V)/r, r and V' - (U + V)/r with the constants of the solid. The bore is free. */
static double bending_by_elements(int count, const double *radius, const struct material *material, int n)
{
    static double band[6][12004], right[12004];
    int size = 2 * (count * n + 1);
    double energy = 0;
    memset(band, 0, sizeof band);
    memset(right, 0, sizeof right);
    for (int e = 0; e < count * n; e++) {
        for (int q = 0; q < 2; q++) {
            const struct radial_point p = radial_point(radius, material, n, e, q);
            const struct elasticity c = p.c;
            const double *turn = p.share, *slope = p.rate, r = p.r, w = p.w;
            double strain[4][3]; /* of U and V at both ends: rr, tt, rt */
            for (int i = 0; i < 4; i++) {
                double s = i % 2 ? 0 : slope[i / 2], g = i % 2 ? slope[i / 2] : 0;
                strain[i][0] = s;
                strain[i][1] = turn[i / 2];
                strain[i][2] = g - turn[i / 2];
            }
            energy += w * c.c33 * r * r;
            for (int i = 0; i < 4; i++) {
                right[2 * e + i] -= w * c.c13 * r * (strain[i][0] + strain[i][1]);
                for (int j = 0; j <= i; j++)
                    band[i - j][2 * e + j] += w * (c.c11 * (strain[i][0] * strain[j][0] + strain[i][1] * strain[j][1]) +
                                                   c.c12 * (strain[i][0] * strain[j][1] + strain[i][1] * strain[j][0]) +
                                                   c.c66 * strain[i][2] * strain[j][2]);
            }
        }
    }
    band[0][0] *= 1e12;            /* a translation is left */
    for (int j = 0; j < size; j++) /* L D L' */
        for (int i = 1; i <= 3 && i + j < size; i++) {
            double factor = band[i][j] / band[0][j];
            for (int k = i; k <= 3 && k + j < size; k++)
                band[k - i][j + i] -= factor * band[k][j];
            right[j + i] -= factor * right[j];
        }
    for (int j = 0; j < size; j++)
        energy -= right[j] * right[j] / band[0][j];
    return pi * energy;
}

/* ES likewise, of the motion U for the axial strain 1: 2 pi times the energy of U' and U/r. */
static double tension_by_elements(int count, const double *radius, const struct material *material, int n)
{
    static double diagonal[6002], off[6002], right[6002];
    double energy = 0;
    memset(diagonal, 0, sizeof diagonal);
    memset(off, 0, sizeof off);
    memset(right, 0, sizeof right);
    for (int e = 0; e < count * n; e++) {
        for (int q = 0; q < 2; q++) {
            const struct radial_point p = radial_point(radius, material, n, e, q);
            const struct elasticity c = p.c;
            const double *rr = p.rate, *tt = p.share, w = p.w;
            energy += w * c.c33;
            off[e] += w * (c.c11 * (rr[0] * rr[1] + tt[0] * tt[1]) + c.c12 * (rr[0] * tt[1] + rr[1] * tt[0]));
            for (int i = 0; i < 2; i++) {
                right[e + i] -= w * c.c13 * (rr[i] + tt[i]);
                diagonal[e + i] += w * (c.c11 * (rr[i] * rr[i] + tt[i] * tt[i]) + 2 * c.c12 * rr[i] * tt[i]);
            }
        }
    }
    for (int i = 0; i <= count * n; i++) { /* L D L' */
        energy -= right[i] * right[i] / diagonal[i];
        diagonal[i + 1] -= off[i] * off[i] / diagonal[i];
        right[i + 1] -= off[i] * right[i] / diagonal[i];
    }
    return 2 * pi * energy;
}

POOL_TEST(bending_and_tension_of_layers_are_those_of_their_plane_strains)
{
    const struct material material[3] = {
        {.e = 2.1e11, .nu = 0.3, .isotropic = 1}, stack(2e10, 0.5e10, 0.29), {.e = 1.2e11, .g = 3e10, .nu = 0.36}};
    const double radius[] = {0.1, 0.4, 0.7, 0.8};
    for (int count = 2; count <= 3; count++) {
        struct section section[3];
        double sum[2] = {0, 0}, unused;
        for (int i = 0; i < count; i++) {
            section_round(2 * radius[i + 1], 2 * radius[i], 2 * radius[i + 1], &section[i]);
            sum[0] += material[i].e * section[i].stiff_inertia;
            sum[1] += material[i].e * section[i].stiff_area;
        }
        for (int axial = 0; axial < 2; axial++) {
            double (*by)(int, const double *, const struct material *, int) = axial ? tension_by_elements : bending_by_elements;
            double coarse = by(count, radius, material, 1000), fine = by(count, radius, material, 2000);
            double more = contraction_of(axial ? MODE_AXIAL : MODE_BENDING, count, section, material, 0, PARAMETER_E, &unused);
            assert_close(sum[axial] + more, fine + (fine - coarse) / 3, 1e-9, 0);
            assert_true(more > 0.01 * sum[axial]);
        }
    }
}

/* Whatever its moduli: G of 1e-3 of E and a wall of 1e-4 of the diameter too. */
POOL_TEST(a_cut_in_one_material_changes_nothing)
{
    const struct material materials[] = {
        {.e = 2e11, .nu = 0.28, .isotropic = 1}, {.e = 1e11, .g = 1e8, .nu = 0.25}, stack(9e10, 4e10, 0.2)};
    const double diameter[] = {0, 0.1, 0.5, 0.5001, 1};
    for (int i = 0; i < 3; i++)
        for (int from = 0; from < 3; from++) {
            struct section section[4], whole;
            struct material m[4] = {materials[i], materials[i], materials[i], materials[i]};
            double unused;
            for (int k = from; k < 4; k++)
                section_round(diameter[k + 1], diameter[k], diameter[k + 1], &section[k]);
            section_round(1, diameter[from], 1, &whole);
            assert_close(layered_shear(4 - from, section + from, m, 0, PARAMETER_E, &unused),
                         shear_stiffness_plain(&whole, &materials[i]), 1e-11, 0); /* rounding over the wall */
            assert_close(bending_of(4 - from, section + from, m, 0, PARAMETER_E, &unused), 0, 0,
                         1e-20 * materials[i].e * whole.stiff_inertia);
        }
}

/* ------------------------------------------------------------------------------------------------ parts of a section */

static struct group groups[5];
static struct segment segments[3];
static struct ring rings[6];

/* A steel shaft of three groups; layer g lies on the middle one. */
static struct rotor shaft(double outer)
{
    for (int g = 0; g < 3; g++) {
        groups[g] = (struct group){
            .layer_of = -1, .name = "shaft", .material = {.name = "steel", .e = 2e11, .nu = 0.3, .rho = 7800, .isotropic = 1}};
        segments[g] = (struct segment){.group = g, .elements = 8, .length = 0.5, .outer = outer, .stiff_outer = outer};
    }
    return (struct rotor){.ngroup = 3, .group = groups, .nsegment = 3, .segment = segments, .ring = rings};
}

static void add_layer(struct rotor *rotor, const char *name, int segment, double outer, double inner, struct material material)
{
    rotor->group[rotor->ngroup] = (struct group){.layer_of = rotor->segment[segment].group, .name = name, .material = material};
    rotor->ring[rotor->nring++] = (struct ring){rotor->ngroup++, segment, outer, inner};
}

POOL_TEST(two_layers_by_hand)
{
    struct rotor rotor = shaft(0.1);
    struct beam beam;
    struct element bare, element;
    double from, to, outer, inner;
    groups[1].preload = 5e5;
    add_layer(&rotor, "stack", 1, 0.2, 0.1, stack(1.4e10, 0.7e10, 0.3));
    bench_build(&rotor, 0, NULL, &beam);
    axis_quantities(&beam, 3, &bare);
    axis_quantities(&beam, 12, &element);
    assert_close(bare.ei, 2e11 * pi * 1e-4 / 64, 1e-14, 0);
    /* one surface at 0.05: the contractions 0.3 and 0.02 meet; a = 1/ep - na^2/e, b = np/ep + na^2/e of both parts */
    double a1 = 0.91 / 2e11, b1 = 0.39 / 2e11, a2 = 1 / 0.97 / 2.1e11 - 4e-4 / 1.4e10, b2 = 0.3 / 0.97 / 2.1e11 + 4e-4 / 1.4e10;
    double flexible = 3 * a1 - b1 + ((3 * a2 - b2) * 1 + (a2 + b2) * 16) / 15, load = (0.3 - 0.02) * 0.0025;
    double parts = 2e11 * pi * 1e-4 / 64 + 1.4e10 * pi * (16e-4 - 1e-4) / 64;
    assert_close(element.ei, parts + pi * load * load / flexible, 1e-14, 0);
    /* by hand from l and b of src/beam/shear_coefficient.c, radii 0.05 and 0.1, x = 0.3/2.6 and 0.01: one unknown each surface */
    double e1 = 2e11, g1 = e1 / 2.6, x1 = 0.3 / 2.6, e2 = 1.4e10, g2 = 0.7e10, x2 = 0.01, p = 0.05, q = 0.1;
    double d = q * q - p * p, c = g2 * (q * q + p * p) / d, off = -2 * g2 * p * q / d;
    b1 = e1 * p * p * p / 4 + e2 * p * d / 4;
    b2 = e2 * q * d / 4;
    double l1 = b1 - x2 * e2 * q * q * p / 2, l2 = b2 + x2 * e2 * p * p * q / 2, det = (g1 + c) * c - off * off;
    double mean = b1 * (c * l1 - off * l2) / det + b2 * ((g1 + c) * l2 - off * l1) / det +
                  (1 - 2 * x1) * e1 * e1 * pow(p, 6) / (96 * g1) + (1 - 2 * x2) * e2 * e2 * d * d * d / (96 * g2);
    assert_close(element.kgs, parts * parts / (pi * mean), 1e-13, 0);
    assert_close(element.rhos, 7800 * pi * 0.01 / 4 + 7600 * pi * 0.03 / 4, 1e-14, 0);
    assert_close(element.rhoi, 7800 * pi * 1e-4 / 64 + 7600 * pi * 15e-4 / 64, 1e-14, 0);
    assert_close(element.force, 5e5, 0, 0); /* of the section, not of each part */
    assert_close(rotor_mass(&rotor), 7800 * pi * 0.01 / 4 * 1.5 + 7600 * pi * 0.03 / 4 * 0.5, 1e-14, 0);
    rotor_group_span(&rotor, 3, &from, &to);
    assert_true(from == 0.5 && to == 1);
    rotor_diameters(&rotor, 1, &outer, &inner);
    assert_true(outer == 0.2 && inner == 0 && rotor_axis_groups(&rotor) == 3);
}

/* EI, kGS and mass of a shaft do not know a cut along it, nor whether its own material lies within or outside. */
POOL_TEST(a_shaft_cut_into_core_and_rings_bends_alike)
{
    struct rotor rotor = shaft(0.3);
    struct beam whole, cut;
    struct element a, b;
    struct mass_properties of_whole, of_cut;
    struct material steel = groups[0].material;
    bench_build(&rotor, 0, NULL, &whole);
    segments[1].outer = segments[1].stiff_outer = 0.1;
    add_layer(&rotor, "sleeve", 1, 0.2, 0.1, steel);
    add_layer(&rotor, "ring", 1, 0.3, 0.2, steel);
    bench_build(&rotor, 0, NULL, &cut);
    axis_quantities(&whole, 12, &a);
    axis_quantities(&cut, 12, &b);
    assert_close(b.ei, a.ei, 1e-14, 0);
    assert_close(b.rhos, a.rhos, 1e-14, 0);
    assert_close(b.rhoi, a.rhoi, 1e-14, 0);
    assert_close(b.kgs, a.kgs, 1e-13, 0);
    segments[1] = (struct segment){.group = 1, .elements = 8, .length = 0.5, .outer = 0.3, .inner = 0.2, .stiff_outer = 0.3};
    rings[0] = (struct ring){3, 1, 0.1, 0};
    rings[1] = (struct ring){4, 1, 0.2, 0.1};
    bench_build(&rotor, 0, NULL, &cut);
    axis_quantities(&cut, 12, &b);
    assert_close(b.kgs, a.kgs, 1e-13, 0);
    beam_mass_properties(&whole, &of_whole);
    beam_mass_properties(&cut, &of_cut);
    assert_close(of_cut.mass, of_whole.mass, 1e-14, 0);
    assert_close(of_cut.mass, rotor_mass(&rotor), 1e-14, 0);
    assert_close(of_cut.inertia, of_whole.inertia, 1e-13, 0);
}

POOL_TEST(holes_are_those_of_their_layer)
{
    struct rotor rotor = shaft(0.1);
    struct section section;
    struct beam beam;
    int failed;
    add_layer(&rotor, "stack", 1, 0.3, 0.1, stack(1.4e10, 0.7e10, 0.3));
    groups[3].holes = 8;
    groups[3].hole_diameter = 0.03;
    groups[3].hole_pitch = 0.1;
    assert_status(section_of_ring(&rotor, 0, &section), ROTID_OK);
    assert_close(section.stiff_area, pi * (0.08 - 8 * 9e-4) / 4, 1e-14, 0);
    assert_close(section.stiff_inertia, pi * (81e-4 - 1e-4 - 8 * 81e-8) / 64 - 8 * pi * 9e-4 / 4 * 0.005, 1e-14, 0);
    assert_status(section_of_segment(&rotor, 1, &section), ROTID_OK);
    assert_close(section.mass_area, pi * 0.01 / 4, 1e-14, 0);
    groups[3].holes = 200;
    assert_status(beam_build(&test_pool, &rotor, 0, NULL, 1, &beam, &failed), ROTID_ERROR_SECTION);
    assert_int_equal(failed, 3);
}

/* ------------------------------------------------------------------------------------------------ derivatives */

static const char *const names[] = {"core.E",    "core.nu",  "core.rho",  "stack.E",    "stack.G", "stack.nu",
                                    "stack.rho", "sleeve.E", "sleeve.nu", "sleeve.rho", "left.E"};

#define NAMES ((int)(sizeof names / sizeof *names))

static struct group of_bench[5];

/* The paper's rotor of steel with a stack around its core, and a sleeve around that. */
static struct rotor *layered(void)
{
    struct rotor *rotor = bench_rotor(BUNDLE_RODS, 1, 4);
    int core = 0;
    memcpy(of_bench, rotor->group, 3 * sizeof *of_bench);
    rotor->group = of_bench;
    rotor->ring = rings;
    rotor->nring = 0;
    of_bench[1].material = of_bench[0].material;
    of_bench[1].holes = 0;
    while (rotor->segment[core].group != 1)
        core++;
    double outer = rotor->segment[core].outer;
    rotor->segment[core].outer = rotor->segment[core].stiff_outer = 0.5 * outer;
    add_layer(rotor, "stack", core, outer, 0.5 * outer, stack(1.4e10, 5e10, 0.3));
    add_layer(rotor, "sleeve", core, 1.1 * outer, outer, of_bench[0].material);
    of_bench[3].holes = 6;
    of_bench[3].hole_diameter = 0.02;
    of_bench[3].hole_pitch = 0.36 * outer;
    return rotor;
}

static const struct subject {
    const struct cause_kind *cause; /* NULL: none */
    int target;
    double value[EFFECT_MOST_PARAMETERS];
} subjects[] = {
    {NULL, 0, {0}},
    {&cause_stiffness, 3, {0.8}},
    {&cause_density, 4, {1.1}},
    {&cause_stiffness_gradient, 3, {0.3}},
    {&cause_stiffness_profile, 4, {0.4}},
    {&cause_stiffness_local, -1, {0.4, 1.1, 0.08}},
    {&cause_shear_coefficient, 3, {0.9}},
    {&cause_step_stiffness, -1, {33.7}},
    {&cause_joint, 0, {3e-9}},
    {&cause_added_mass, -1, {9, 1.03}},
    {&cause_layer_slip, 3, {0.07}},
    {&cause_layer_slip, 4, {0.011}},
    {&cause_hub_stiffness, -1, {0.6}},
};

/* The mean over an element of 1 - cosh(x/t)/cosh(a/t), by many points; nothing at neutral, all of it lost towards the ends. */
POOL_TEST(a_layer_that_slips_carries_by_shear_lag)
{
    struct rotor *rotor = layered();
    double begin, end;
    rotor_group_span(rotor, 3, &begin, &end);
    const double a = (end - begin) / 2, transfer[] = {0, 1e-4, 0.01, 0.1, a};
    for (size_t k = 0; k < sizeof transfer / sizeof *transfer; k++) {
        struct effect effect = {.kind = cause_layer_slip.effect, .target = 3, .value = {transfer[k]}};
        for (int e = 0; e < 10; e++) {
            struct effect_span span = {3, 0, begin + 0.2 * a * e, begin + 0.2 * a * (e + 1)};
            struct effect_field factors = {1, 1, 1};
            double mean = 0;
            assert_int_equal(effect.kind->field(&effect, rotor, &span, -1, &factors), 1);
            for (int i = 0; i < 20000; i++) {
                double x = fabs(0.2 * a * (e + (i + 0.5) / 20000) - a), t = transfer[k];
                mean += t > 0 ? (1 - exp((x - a) / t) * (1 + exp(-2 * x / t)) / (1 + exp(-2 * a / t))) / 20000 : 1.0 / 20000;
            }
            assert_close(factors.e, mean, 2e-5, 0);
            assert_true(factors.g == factors.e && factors.rho == 1);
        }
    }
    struct effect effect = {.kind = cause_layer_slip.effect, .target = 3};
    struct effect_span other = {1, 0, begin, end};
    struct effect_field factors;
    assert_int_equal(effect.kind->field(&effect, rotor, &other, -1, &factors), 0);
    assert_int_equal(cause_layer_slip.applies(rotor, 3, NULL), 1);
    assert_int_equal(cause_layer_slip.applies(rotor, 1, NULL), 0);
    assert_int_equal(cause_stiffness.applies(rotor, 3, (const int[]){0, 1, 0, 0, 0}), 1);
}

POOL_TEST(derivatives_by_what_is_of_a_layer_agree_with_differences)
{
    for (size_t i = 0; i < 3 * (sizeof subjects / sizeof *subjects); i++) {
        const struct subject *s = &subjects[i / 3];
        const enum mode_type type[3] = {MODE_BENDING, MODE_TORSION, MODE_AXIAL};
        struct rotor *rotor = layered();
        struct parameter parameter[NAMES + EFFECT_MOST_PARAMETERS];
        struct beam beam;
        const char *unit;
        int n = NAMES;
        if (s->cause)
            (void)bench_add(rotor, s->cause->effect, s->target, 0, s->value);
        for (int p = 0; p < NAMES; p++)
            assert_int_equal(parameter_find(rotor, names[p], &parameter[p], &unit), 0);
        for (int p = 0; s->cause && p < effect_parameters(&rotor->effect[0]); p++)
            parameter[n++] = (struct parameter){PARAMETER_EFFECT, 0, p, 0, NULL};
        bench_build(rotor, n, parameter, &beam);
        if (type[i % 3] != MODE_BENDING)
            assert_status(bar_open(&test_pool, type[i % 3], &beam), ROTID_OK);
        for (int p = 0; p < n; p++) {
            double error = bench_derivative_error(&beam, p, p < NAMES ? 1e-3 : 2e-4, 0); /* crosses no end of a cone */
            if (error > 1e-6)
                print_error("%s, parameter %d: relative error of the derivative %.2e\n", s->cause ? s->cause->id : "no cause", p,
                            error);
            assert_true(error <= 1e-6);
        }
    }
}

/* What a factor on a layer does is what another modulus of that layer does, and to that layer alone. */
POOL_TEST(a_cause_on_a_layer_leaves_the_other_parts_alone)
{
    struct element scaled, stiffer;
    struct beam beam;
    struct rotor *rotor = layered();
    (void)bench_add(rotor, cause_stiffness.effect, 4, 0, (double[]){0.8}); /* the isotropic one: E and G follow each other */
    bench_build(rotor, 0, NULL, &beam);
    int e = 0;
    while (rotor->segment[beam.mesh.segment[e]].group != 1)
        e++;
    axis_quantities(&beam, e, &scaled);
    rotor = layered();
    rotor->group[4].material.e *= 0.8;
    bench_build(rotor, 0, NULL, &beam);
    axis_quantities(&beam, e, &stiffer);
    assert_close(scaled.ei, stiffer.ei, 1e-15, 0);
    assert_close(scaled.kgs, stiffer.kgs, 1e-14, 0);
    assert_close(scaled.rhos, stiffer.rhos, 0, 0);
}

/* A stack that is longer than its shaft is thick: at its ends the cone from the shaft leaves a share of the stack, none of the
 * shaft. */
POOL_TEST(cones_cut_off_the_layer_and_not_what_lies_within)
{
    struct rotor rotor = shaft(0.1);
    struct effect effect = {.kind = cause_step_stiffness.effect, .target = -1, .value = {45}};
    struct effect_span span = {3, 1, 0.5, 0.55};
    struct effect_section factor;
    assert_false(cause_step_stiffness.applies(&rotor, -1, NULL));
    add_layer(&rotor, "stack", 1, 0.3, 0.1, stack(1.4e10, 0.7e10, 0.3));
    assert_true(cause_step_stiffness.applies(&rotor, -1, NULL));
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, -1, &factor), 1);
    assert_true(factor.ei > 0 && factor.ei < 0.1);
    span.from = 0.61; /* the cones have reached 0.32 m */
    span.to = 0.65;
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, -1, &factor), 0);
    span = (struct effect_span){1, 1, 0.5, 0.55};
    assert_int_equal(effect.kind->section(&effect, &rotor, &span, -1, &factor), 0);
}

POOL_TEST(rotors_that_differ_in_a_ring_have_another_shape)
{
    struct rotor rotor = shaft(0.1), copy;
    add_layer(&rotor, "stack", 1, 0.3, 0.1, stack(1.4e10, 0.7e10, 0.3));
    assert_status(rotor_copy(&test_pool, &rotor, &copy), ROTID_OK);
    assert_true(copy.ring != rotor.ring && rotor_same_shape(&rotor, &copy) && rotor_same_values(&rotor, &copy));
    copy.group[3].material.e *= 2;
    assert_true(rotor_same_shape(&rotor, &copy) && !rotor_same_values(&rotor, &copy));
    copy.ring[0].outer = 0.31;
    assert_false(rotor_same_shape(&rotor, &copy));
    copy.ring[0].outer = 0.3;
    copy.group[3].material.sheet_e = 2e11;
    assert_false(rotor_same_shape(&rotor, &copy));
    copy.group[3].material.sheet_e = 2.1e11;
    copy.nring = 0;
    assert_false(rotor_same_shape(&rotor, &copy));
}

/* ------------------------------------------------------------------------------------------------ decks */

#define MATERIALS                                                                                                                \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n"                                                               \
    "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=LAMINATED\n1.4e10, 0.7e10, 2.1e11, 0.29\n*DENSITY\n7600\n"
#define CORE                                                                                                                     \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.1, 0, 4\n"                                                                        \
    "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.2, 0.1, 8\n0.4, 0.24, 0.1, 8\n"

static void read_deck(const char *text, struct job *job)
{
    static struct message_list messages;
    message_open(&messages, &test_pool);
    int status = deck_read(&test_pool, folder_write("deck.inp", text), 0, NULL, &messages, job);
    for (size_t i = 0; i < messages.count; i++) {
        if (strstr(messages.item[i].text, "a solid smears the holes"))
            continue;
        fail_msg("%d:%d: %s", messages.item[i].line, messages.item[i].column, messages.item[i].text);
    }
    assert_status(status, ROTID_OK);
}

POOL_TEST(a_deck_lays_rings_in_order)
{
    struct job job;
    const struct rotor *rotor = &job.rotor;
    /* the layers first, and the cards of the rotor behind them: the order of kinds of cards does not matter */
    read_deck(MATERIALS "*LAYER, NAME=stack, GROUP=core, MATERIAL=sheets\n0.4, 0.2\n0.44, 0.2400000000001\n"
                        "*LAYER, NAME=lining, GROUP=core, MATERIAL=steel\n0.1, 0.08\n"
                        "*LAYER, NAME=sleeve, GROUP=core, MATERIAL=steel\n0.42, 0.4\n0.46, 0.44\n"
                        "*PERFORATION, GROUP=stack\n6, 0.02, 0.16\n"
                        "*CAUSE, NAME=soft, TYPE=stiffness, GROUP=sleeve\nfactor, 0.9\n"
                        "*DISK\nstack.end, 10\n"
                        "*IDENTIFY\nstack.E, 1e9, 1e11, 1.4e10\nstack.nu, 0.1, 0.4, 0.29\n"
                        "*FIT, MODEL=SOLID\n" CORE,
              &job);
    assert_int_equal(rotor->ngroup, 5);
    assert_int_equal(rotor_axis_groups(rotor), 2);
    assert_int_equal(rotor->nring, 6);
    static const struct ring expected[] = {{3, 1, 0.1, 0.08}, {2, 1, 0.4, 0.2},   {4, 1, 0.42, 0.4},
                                           {3, 2, 0.1, 0.08}, {2, 2, 0.44, 0.24}, {4, 2, 0.46, 0.44}};
    for (int i = 0; i < 6; i++) {
        assert_true(rotor->ring[i].group == expected[i].group && rotor->ring[i].segment == expected[i].segment);
        assert_true(rotor->ring[i].outer == expected[i].outer && rotor->ring[i].inner == expected[i].inner);
    }
    const struct group *group = rotor->group;
    assert_true(group[0].layer_of == -1 && group[1].layer_of == -1 && group[2].layer_of == 1 && group[4].layer_of == 1);
    assert_string_equal(group[2].name, "stack");
    assert_true(group[2].holes == 6 && !group[1].holes && group[2].hole_pitch == 0.16);
    const struct material *sheets = &group[2].material;
    assert_true(sheets->laminated && !sheets->isotropic && sheets->e == 1.4e10 && sheets->g == 0.7e10);
    assert_true(sheets->sheet_e == 2.1e11 && sheets->nu == 0.29 && sheets->stacking == 1 && sheets->rho == 7600);
    assert_false(group[4].material.laminated);
    assert_int_equal(rotor->effect[0].target, 4);
    assert_true(job.unknowns.parameter[0].kind == PARAMETER_E && job.unknowns.parameter[0].index == 2);
    assert_close(rotor->disk[0].position, 1.2, 1e-15, 0);
    assert_int_equal(job.options.solid, 1);
    read_deck(MATERIALS CORE "*FIT, MODEL=BEAM\n", &job);
    assert_int_equal(job.options.solid, 0);
}

/* The deck that ships: its stack is a parameter that moves its frequencies. */
POOL_TEST(the_shipped_motor_is_a_model)
{
    struct job job;
    struct message_list messages;
    struct rotor_model model;
    int failed;
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, ROTID_SOURCE_DIR "/input/motor_shaft_stack.inp", 0, NULL, &messages, &job), ROTID_OK);
    assert_int_equal(messages.count, 0);
    assert_int_equal(job.unknowns.nparameter, 2);
    assert_status(model_open(&test_pool, job.models, &job.rotor, 2, job.unknowns.parameter, 1, &model, &failed), ROTID_OK);
    assert_int_equal(model.equations.nrigid, 2);
    struct mass_properties own;
    model_mass_properties(&model, &own);
    assert_close(own.mass, rotor_mass(&job.rotor), 1e-12, 0);
    assert_close(own.mass, 6059.1, 1e-5, 0); /* as its heading says */
}

/* Bars of twenty diameters: one material, soft within hard and hard within soft. What Cowper's average misses is a share of the
 * terms of shear and rotary inertia, which vanish with the wave number: alike in modes 3 to 6, some 2.7 % of one material, less
 * than twice that of two; a wrong kGS of the layers would be a share of another size, or of the first mode too. */
POOL_TEST(two_materials_are_as_near_to_the_solid_of_a_long_bar_as_one)
{
    static const double modulus[3][2] = {{2.1e11, 2.1e11}, {2e10, 2.1e11}, {2.1e11, 2e10}},
                        beta[6] = {4.730040745, 7.853204624, 10.99560784, 14.13716549, 17.27875966, 20.42035225};
    for (int c = 0; c < 3; c++) {
        double hz[2][6], share[6], ei = pi / 64 * (modulus[c][0] * pow(0.06, 4) + modulus[c][1] * (pow(0.1, 4) - pow(0.06, 4))),
                                   mass = 7850 * pi / 4 * 0.01;
        for (int solid = 0; solid < 2; solid++) {
            const char *text =
                pool_format(&test_pool,
                            "*MATERIAL, NAME=a\n*ELASTIC\n%g, 0.3\n*DENSITY\n7850\n*MATERIAL, NAME=b\n*ELASTIC\n%g, "
                            "0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=a\n2, 0.06, 0, 120\n*LAYER, NAME=ring, "
                            "GROUP=core, MATERIAL=b\n0.1, 0.06\n*FIT, MODEL=%s\n",
                            modulus[c][0], modulus[c][1], solid ? "SOLID" : "BEAM");
            read_frequencies(text, ROTID_BENDING, 6, hz[solid]);
        }
        for (int k = 0; k < 6; k++) {
            double slender = beta[k] * beta[k] / (2 * pi * 4) * sqrt(ei / mass);
            share[k] = (hz[1][k] - hz[0][k]) / (slender - hz[1][k]);
            assert_close(hz[1][k], hz[0][k], 0.007, 0);
        }
        for (int k = 2; k < 6; k++)
            assert_true(share[k] > 0 && share[k] < 0.056 && share[k] > share[2] / 2.5);
        if (!c)
            for (int k = 2; k < 6; k++)
                assert_close(share[k], 0.0265, 0.12, 0);
    }
}

TEST_GROUP(folder_make, folder_remove);
