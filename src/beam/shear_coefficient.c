#include "beam/beam.h"

/* The flexure function of a bar with E along the axis, G between the axis and the plane, and the contraction nu_a of the plane
 * solves a linear problem whose data are E/G and nu_a, and 1/k is G/E times an integral of the function: 1/k = c0 - c1 x with
 * x = nu_a G/E, whatever the section. Cowper's k = n (1 + nu)/(d0 + d1 nu), where x = nu/(2 (1 + nu)), gives both constants. */
struct coefficient {
    double c0, c1;
};

static struct coefficient of_cowper(double n, double d0, double d1)
{
    return (struct coefficient){d0 / n, 2 * (d0 - d1) / n};
}

static struct coefficient annulus(double a)
{
    double p = (1 + a * a) * (1 + a * a), q = a * a;
    return of_cowper(6 * p, 7 * p + 20 * q, 6 * p + 12 * q);
}

static struct coefficient rectangle(void)
{
    return of_cowper(10, 12, 11);
}

static double isotropic(double nu)
{
    return nu / (2 * (1 + nu));
}

struct shear_material shear_material_of(const struct material *m)
{
    double g = material_shear_modulus(m);
    if (m->laminated)
        return (struct shear_material){
            m->e, g, m->nu * g / m->sheet_e, m->stacking * m->sheet_e, m->nu, m->nu * m->e / m->sheet_e};
    return (struct shear_material){m->e, g, isotropic(m->nu), m->e, m->nu, m->nu};
}

struct shear_material shear_material_derivative(const struct material *m, enum parameter_kind kind)
{
    double g = material_shear_modulus(m), q = 1 + m->nu;
    switch (kind) {
    case PARAMETER_E:
    case PARAMETER_TIEROD_E:
        return (struct shear_material){
            .e = 1, .g = m->isotropic ? g / m->e : 0, .ep = !m->laminated, .na = m->laminated ? m->nu / m->sheet_e : 0};
    case PARAMETER_G:
        return (struct shear_material){.g = 1, .x = m->laminated ? m->nu / m->sheet_e : 0};
    case PARAMETER_NU:
        return (struct shear_material){.g = m->isotropic ? -g / q : 0,
                                       .x = m->laminated ? g / m->sheet_e : 1 / (2 * q * q),
                                       .np = 1,
                                       .na = m->laminated ? m->e / m->sheet_e : 1};
    default:
        return (struct shear_material){0};
    }
}

void shear_material_scale(const struct material *m, double e, double g, struct shear_material *values)
{
    values->e *= e;
    values->g *= g;
    *(m->laminated ? &values->na : &values->ep) *= e;
}

struct shear_material shear_material_rate(const struct material *m, double e, double g)
{
    struct shear_material rate = shear_material_of(m), values = rate;
    shear_material_scale(m, e, g, &rate);
    return (struct shear_material){
        .e = rate.e, .g = rate.g, .ep = m->laminated ? 0 : values.ep * e, .na = m->laminated ? values.na * e : 0};
}

double shear_material_product(const struct shear_material *by, const struct shear_material *v)
{
    return by->e * v->e + by->g * v->g + by->x * v->x + by->ep * v->ep + by->np * v->np + by->na * v->na;
}

static double of_one(struct shear_layer *layer)
{
    const struct section *section = layer->section;
    struct coefficient c = section->rectangular ? rectangle() : annulus(section->ratio);
    double k = 1 / (c.c0 - c.c1 * layer->material.x), s = section->stiff_area, gs = layer->material.g * s;
    layer->by = (struct shear_material){.g = k * s, .x = c.c1 * k * k * gs};
    return k * gs;
}

/* A part between the radii p < q as the problem below sees it; holes thin E by second moment and G by area. */
struct annulus {
    double p, q, pp, qq, depth; /* depth: q^2 - p^2 */
    double e, g, by_e, by_g;    /* by: for the material's own */
};

static struct annulus annulus_of(const struct shear_layer *layer)
{
    const struct section *section = layer->section;
    double q = section->stiff_outer / 2, p = section->ratio * q, pp = p * p, qq = q * q, depth = qq - pp;
    double by_e = section->stiff_inertia / (PI / 4 * depth * (qq + pp)), by_g = section->stiff_area / (PI * depth);
    return (struct annulus){p, q, pp, qq, depth, layer->material.e * by_e, layer->material.g * by_g, by_e, by_g};
}

/* b of the basis below on the inner (0) and outer (1) surface of a part, and what x adds to l. */
static double load(const struct annulus *a, int side)
{
    return a->e * (side ? a->q : a->p) * a->depth / 4;
}

static double load_by_x(const struct annulus *a, int side)
{
    return a->e / 2 * (side ? a->pp * a->q : -a->qq * a->p);
}

/* The tridiagonal systems in w and z at the surfaces 0 ... count: pivot on the diagonal, -off beside it; 0 where nothing resists
 */
static void solve_surfaces(int count, struct shear_layer *layer)
{
    for (int i = 0; i < count; i++) {
        double ratio = layer[i].pivot > 0 ? layer[i].off / layer[i].pivot : 0;
        layer[i + 1].pivot -= ratio * layer[i].off;
        layer[i + 1].w += ratio * layer[i].w;
        layer[i + 1].z += ratio * layer[i].z;
    }
    for (int i = count; i >= 0; i--) {
        double above_w = i < count ? layer[i].off * layer[i + 1].w : 0, above_z = i < count ? layer[i].off * layer[i + 1].z : 0;
        layer[i].w = layer[i].pivot > 0 ? (layer[i].w + above_w) / layer[i].pivot : 0;
        layer[i].z = layer[i].pivot > 0 ? (layer[i].z + above_z) / layer[i].pivot : 0;
    }
}

/* Axial displacement W(r) cos t of a section whose curvature grows as z. Contraction of each part gives it U = V = -nu_a r^2/2 in
 * its plane, sigma_zz = E r, and axial equilibrium is, for every variation D of W,
 *   int G (W' D' + W D/r^2) r dr = int E (r^2 D + x r^2 (r D' - D)/2) dr =: l(D).
 * W is continuous, and on each part a sum of r, 1/r and r^3. The basis: the two sums of r and 1/r that are 1 at one of its
 * surfaces and 0 at the other, and (r^2 - p^2)(r^2 - q^2)/r, which meets neither of these, so that its share follows part by part
 * and a tridiagonal system in W at the surfaces is left. The mean rotation that bends with the moment EI is weighted by E, int E
 * r^2 W dr =: b(W) over int E r^3 dr =: J, and the shear force is EI, so that kGS = pi J^2/b(W). Derivatives of b(W) follow from
 * the adjoint Z with the load b: dA, db and dl are all that moves. */
static double of_layers(int count, struct shear_layer *layer)
{
    double j = 0, mean = 0;
    for (int i = 0; i <= count; i++)
        layer[i].pivot = layer[i].w = layer[i].z = layer[i].off = 0;
    for (int i = 0; i < count; i++) {
        struct annulus a = annulus_of(&layer[i]);
        double x = layer[i].material.x, stiffness = a.g * (a.qq + a.pp) / a.depth;
        j += a.e * a.depth * (a.qq + a.pp) / 4;
        if (a.g <= 0) /* a cause took all of it */
            continue;
        mean += (1 - 2 * x) * a.e * a.e * a.depth * a.depth * a.depth / (96 * a.g);
        layer[i].off = 2 * a.g * a.p * a.q / a.depth;
        for (int side = 0; side < 2; side++) {
            layer[i + side].pivot += stiffness;
            layer[i + side].w += load(&a, side) + x * load_by_x(&a, side);
            layer[i + side].z += load(&a, side);
        }
    }
    solve_surfaces(count, layer);
    for (int i = 0; i < count; i++) {
        struct annulus a = annulus_of(&layer[i]);
        mean += a.g > 0 ? load(&a, 0) * layer[i].w + load(&a, 1) * layer[i + 1].w : 0;
    }
    double shear = PI * j * j / mean;
    for (int i = 0; i < count; i++) {
        const struct shear_layer *in = &layer[i], *out = &layer[i + 1];
        struct annulus a = annulus_of(in);
        double x = in->material.x, share = a.e * a.e * a.depth * a.depth * a.depth / (96 * a.g);
        layer[i].by = (struct shear_material){0};
        if (a.g <= 0)
            continue;
        double of_x = load_by_x(&a, 0) * in->z + load_by_x(&a, 1) * out->z;
        double of_e = load(&a, 0) * (in->w + in->z) + load(&a, 1) * (out->w + out->z) + x * of_x + 2 * (1 - 2 * x) * share;
        double of_g = (a.qq + a.pp) / a.depth * (in->w * in->z + out->w * out->z) -
                      2 * a.p * a.q / a.depth * (in->w * out->z + out->w * in->z) + (1 - 2 * x) * share / a.g;
        layer[i].by = (struct shear_material){
            .e = a.by_e * shear * (a.depth * (a.qq + a.pp) / (2 * j) - of_e / (a.e * mean)),
            .g = a.by_g * shear * of_g / mean,
            .x = -shear * (of_x - 2 * share) / mean,
        };
    }
    return shear;
}

double shear_stiffness(int count, struct shear_layer *layer)
{
    return count == 1 ? of_one(layer) : of_layers(count, layer);
}

/* In bending by the curvature 1 each part alone contracts by U = V = -na r^2/2. Bonded parts press on each other with the
 * stresses sigma_rr = tau_rt = (S/r)(cos t, sin t) at their surfaces: Airy's A r^3 and B/r, sigma_rr = 2 A r - 2 B/r^3 and
 * sigma_tt = 6 A r
 * + 2 B/r^3, since r ln r would carry a force. With the strains e_rr = a sigma_rr - b sigma_tt - na r, a = 1/ep - na^2/e and b =
 * np/ep + na^2/e, U + V at the outer and inner surface of a part is
 *   (S_q (c q^4 + (a + b) p^4) - 4 a p^2 q^2 S_p)/d - na q^2,  (4 a p^2 q^2 S_q - S_p (c p^4 + (a + b) q^4))/d - na p^2,
 * c = 3 a - b, d = q^4 - p^4, the rest being a translation. U + V is continuous, F S = h, and the axial stress na (sigma_rr +
 * sigma_tt) adds the moment pi h'S. Its derivative is pi (2 S'dh - S'dF S).
 *
 * In tension by the strain 1 each part alone contracts by U = -na r, the stresses are sigma_rr = A + B/r^2, sigma_tt = A - B/r^2,
 * S at the surfaces, and U/r there is
 *   (S_q ((a - b) q^2 + (a + b) p^2) - 2 a p^2 S_p)/d - na,  (2 a q^2 S_q - S_p ((a - b) p^2 + (a + b) q^2))/d - na,
 * d = q^2 - p^2. Its continuity times r^2 is F S = h with the same h, and the force added is 2 pi h'S. */
double contraction_stiffness(enum mode_type type, int count, struct shear_layer *layer)
{
    const int axial = type == MODE_AXIAL;
    const double n = axial ? 1 : 3, scale = axial ? 2 * PI : PI;
    double sum = 0;
    layer[0].contraction = (struct shear_material){0};
    if (count == 1) /* of any section */
        return 0;
    for (int i = 0; i <= count; i++)
        layer[i].pivot = layer[i].w = layer[i].z = layer[i].off = 0;
    for (int i = 0; i < count; i++) {
        const struct shear_material *m = &layer[i].material;
        struct annulus t = annulus_of(&layer[i]);
        double a = (1 / m->ep - m->na * m->na / m->e) / t.by_g, b = (m->np / m->ep + m->na * m->na / m->e) / t.by_g;
        double d = axial ? t.depth : t.depth * (t.qq + t.pp), c = n * a - b, mixed = t.pp * t.qq;
        int resists = m->e > 0 && m->ep > 0;
        if (i > 0) {
            layer[i].pivot += resists ? (c * t.pp * t.pp + (a + b) * (axial ? mixed : t.qq * t.qq)) / d : INFINITY;
            layer[i].w -= m->na * t.pp;
        }
        if (i + 1 < count) {
            layer[i + 1].pivot += resists ? (c * t.qq * t.qq + (a + b) * (axial ? mixed : t.pp * t.pp)) / d : INFINITY;
            layer[i + 1].w += m->na * t.qq;
            layer[i].off = i > 0 && resists ? (n + 1) * a * mixed / d : 0;
        }
    }
    solve_surfaces(count, layer);
    for (int i = 0; i < count; i++) {
        const struct shear_material *m = &layer[i].material;
        struct annulus t = annulus_of(&layer[i]);
        double p = layer[i].w, q = layer[i + 1].w, d = axial ? t.depth : t.depth * (t.qq + t.pp), direct = q * t.qq - p * t.pp;
        double p4 = t.pp * t.pp, q4 = t.qq * t.qq, mixed = t.pp * t.qq, of_p = axial ? mixed : q4, of_q = axial ? mixed : p4;
        double by_b = axial ? q * q * t.qq - p * p * t.pp : q * q - p * p;
        double by_a = -(q * q * (n * q4 + of_q) + p * p * (n * p4 + of_p) - 2 * (n + 1) * p * q * mixed) / d;
        layer[i].contraction = (struct shear_material){0};
        if (!(m->e > 0 && m->ep > 0))
            continue;
        sum += m->na * direct;
        layer[i].contraction = (struct shear_material){
            .e = scale * (by_a - by_b) * m->na * m->na / (m->e * m->e * t.by_g),
            .ep = -scale * (by_a + m->np * by_b) / (m->ep * m->ep * t.by_g),
            .np = scale * by_b / (m->ep * t.by_g),
            .na = scale * 2 * (direct - (by_a - by_b) * m->na / (m->e * t.by_g)),
        };
    }
    return scale * sum;
}

double shear_stiffness_plain(const struct section *section, const struct material *material)
{
    struct shear_layer layer = {.material = shear_material_of(material), .section = section};
    return of_one(&layer);
}

HOST_COMPUTES void compute(int rectangular, double nu, double a, double *coefficient)
{
    struct coefficient c = rectangular ? rectangle() : annulus(a);
    *coefficient = 1 / (c.c0 - c.c1 * isotropic(nu));
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
