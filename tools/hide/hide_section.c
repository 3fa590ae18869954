/* What the effects make of the section at one place. */
#include <math.h>
#include <string.h>

#include "hide_model.h"

#define MOST_ELEMENTS 200 /* over a wall: kGS within 1e-7 */

static const double pi = 3.14159265358979323846;

struct moments {
    double area, second;
};

static struct moments ring(double outer, double inner)
{
    double o2 = outer * outer, i2 = inner * inner;
    return (struct moments){pi / 4 * (o2 - i2), pi / 64 * (o2 - i2) * (o2 + i2)};
}

static void drill(const struct hide_group *group, struct moments *m)
{
    double d2 = group->hole_diameter * group->hole_diameter, area = group->holes * pi / 4 * d2;
    m->area -= area;
    m->second -= group->holes * pi / 64 * d2 * d2 + 0.5 * area * group->hole_pitch * group->hole_pitch;
}

/* Shear coefficient of an annulus across sheets (Dharmarajan and McCutchen 1973), whose contraction by axial stress is that of a
 * sheet: nu_axial/E = nu/E_sheet. */
static double of_sheets(const struct hide_material *m, double ratio)
{
    double q = ratio * ratio, p = (1 + q) * (1 + q), contraction = m->nu / m->sheet_e * m->g;
    return 6 * p / ((7 - 2 * contraction) * p + (20 - 16 * contraction) * q);
}

/* stiff: diameter that carries stiffness */
static void section_of(const struct hide_group *group, const struct hide_segment *s, double stiff, struct hide_section *section)
{
    const struct hide_material *m = &group->material;
    struct moments heavy, bears;
    double coefficient;
    if (s->rectangular) {
        heavy = bears = (struct moments){s->height * s->width, s->width * pow(s->height, 3) / 12};
        coefficient = 10 * (1 + m->nu) / (12 + 11 * m->nu);
    } else {
        heavy = ring(s->outer, s->inner);
        bears = ring(stiff, s->inner);
        coefficient = m->sheet_e > 0 ? of_sheets(m, s->inner / stiff) : oracle_cowper(m->nu, s->inner / stiff);
        if (group->holes)
            drill(group, &heavy);
        if (group->holes && group->hole_pitch < stiff / 2)
            drill(group, &bears);
    }
    *section = (struct hide_section){m->e * bears.second, coefficient * hide_shear_modulus(m) * bears.area, m->rho * heavy.area,
                                     m->rho * heavy.second};
}

/* The cones that open from the smaller side of every step of the outer diameter. */
static double cone(const struct hide_rotor *rotor, double angle, double z)
{
    double slope = 2 * tan(angle * pi / 180), limit = INFINITY;
    for (int i = 0; i + 1 < rotor->segments; i++) {
        const struct hide_segment *a = &rotor->segment[i], *b = a + 1;
        if (!a->rectangular && !b->rectangular && fabs(a->outer - b->outer) > 1e-9)
            limit = fmin(limit, fmin(a->outer, b->outer) + slope * fabs(z - a->to));
    }
    return limit;
}

static double bump(double z, double center, double width, int box)
{
    double x = (z - center) / width;
    return box ? fabs(x) <= 0.5 : exp(-0.5 * x * x);
}

static double zone(const struct hide_effect *e, double z)
{
    return 1 - hide_get(e, "depth")->number *
                   bump(z, hide_get(e, "z")->number, hide_get(e, "width")->number, hide_get(e, "shape")->index == 1);
}

/* Factors of one effect at z in the group. */
static struct hide_section factors(const struct hide_rotor *rotor, const struct hide_effect *e, int group, double z)
{
    const struct hide_group *g = &rotor->group[group];
    double stiffness = 1, bending = 1, shear = 1, mass = 1, xi = 2 * (z - g->from) / (g->to - g->from) - 1;
    int here = hide_get(e, "group")->index == group;
    if (hide_is(e, "stiffness_gradient") && here)
        stiffness = 1 + hide_get(e, "slope")->number * xi;
    else if (hide_is(e, "stiffness_profile") && here)
        stiffness = 1 + hide_get(e, "profile")->number * (xi * xi - 1.0 / 3);
    else if (hide_is(e, "stiffness_local"))
        stiffness = zone(e, z);
    else if (hide_is(e, "stiffness") && here)
        stiffness = hide_get(e, "factor")->number;
    else if (hide_is(e, "shear_coefficient") && here)
        shear = hide_get(e, "factor")->number;
    else if (hide_is(e, "density") && here)
        mass = hide_get(e, "factor")->number;
    else if (hide_is(e, "bend_only"))
        bending = zone(e, z);
    else if (hide_is(e, "density_zone"))
        mass = 1 + (hide_get(e, "factor")->number - 1) * bump(z, hide_get(e, "z")->number, hide_get(e, "width")->number, 1);
    else if (hide_is(e, "sine") && here)
        stiffness = 1 + hide_get(e, "amplitude")->number * sin(pi * (xi + 1) * hide_get(e, "waves")->number);
    return (struct hide_section){bending * stiffness, shear * stiffness, mass, mass};
}

struct wall { /* of a layered section, between two radii, with the effects on its group and thinned by holes */
    double in, out, e, g, contraction; /* contraction: of the plane by axial strain */
    double stretch, cross,
        free; /* in the plane, sigma = stretch eps + cross eps across; strain without stress by that of the axis */
};

/* A part of the section with the effects on its group: parts turn and deflect alike, so EI and mass are sums. */
static void add_part(const struct hide_physics *physics, int group, const struct hide_segment *s, double stiff, double z,
                     struct hide_section *section, struct wall *wall)
{
    const struct hide_material *m = &physics->rotor->group[group].material;
    struct hide_segment turned = *s;
    struct hide_section part;
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "diameter") && hide_get(&physics->effect[i], "group")->index == group) {
            turned.outer *= hide_get(&physics->effect[i], "factor")->number;
            stiff *= hide_get(&physics->effect[i], "factor")->number;
            s = &turned;
        }
    struct moments whole = ring(stiff, s->inner);
    section_of(&physics->rotor->group[group], s, stiff, &part);
    double g = hide_shear_modulus(m);
    for (int i = 0; i < physics->effects; i++) {
        struct hide_section f = factors(physics->rotor, &physics->effect[i], group, z);
        part.bending *= f.bending;
        part.shear *= f.shear;
        part.mass *= f.mass;
        part.inertia *= f.inertia;
    }
    section->bending += part.bending;
    section->shear += part.shear;
    section->mass += part.mass;
    section->inertia += part.inertia;
    double k = m->sheet_e > 0 ? of_sheets(m, s->inner / stiff) : oracle_cowper(m->nu, s->inner / stiff);
    double axial = m->e, solid = 0; /* E with the effects; what holes leave of the plane */
    for (int i = 0; i < physics->effects; i++)
        axial *= factors(physics->rotor, &physics->effect[i], group, z).bending;
    struct hide_section bare;
    section_of(&physics->rotor->group[group], s, stiff, &bare);
    solid = bare.shear / (k * g * whole.area);
    *wall = (struct wall){s->inner / 2, stiff / 2, part.bending / whole.second, part.shear / (k * whole.area), 0, 0, 0, 0};
    wall->free = m->sheet_e > 0 ? m->nu * axial / m->sheet_e : m->nu;
    double plane = m->sheet_e > 0 ? m->stacking * m->sheet_e : axial, a = 1 / plane - wall->free * wall->free / axial,
           b = -m->nu / plane - wall->free * wall->free / axial;
    wall->stretch = solid * a / (a * a - b * b);
    wall->cross = -solid * b / (a * a - b * b);
    /* x = contraction G/E of the material itself: of what states E, G and nu that of the isotropic material of this nu */
    double x = m->sheet_e > 0 ? m->nu * g / m->sheet_e : m->nu / (2 * (1 + m->nu));
    wall->contraction = wall->g > 0 ? x * wall->e / wall->g : 0;
}

/* kGS of walls that touch, from the axis outwards: the axial displacement of a section in flexure by `each` linear elements a
 * wall, its mean rotation weighted by E. */
static double flexure(int walls, const struct wall *wall, int each)
{
    static double diagonal[(1 + HIDE_MOST_RINGS) * MOST_ELEMENTS + 1], off[sizeof diagonal / sizeof *diagonal],
        load[sizeof diagonal / sizeof *diagonal], weight[sizeof diagonal / sizeof *diagonal];
    double bending = 0, rotation = 0;
    int n = walls * each;
    for (int i = 0; i <= n; i++)
        diagonal[i] = off[i] = load[i] = weight[i] = 0;
    for (int i = 0; i < n; i++) {
        const struct wall *w = &wall[i / each];
        double h = (w->out - w->in) / each, from = w->in + h * (i % each);
        for (int side = -1; side <= 1; side += 2) {
            double t = 0.5 + side / sqrt(12), r = from + h * t, n0 = 1 - t, n1 = t, wide = h / 2, axial = w->e * r * r;
            double poisson = w->g * w->contraction * r * r / 2;
            bending += axial * r * wide;
            weight[i] += axial * n0 * wide;
            weight[i + 1] += axial * n1 * wide;
            load[i] += (axial * n0 - poisson * (r / h + n0)) * wide;
            load[i + 1] += (axial * n1 + poisson * (r / h - n1)) * wide;
            diagonal[i] += w->g * (r / (h * h) + n0 * n0 / r) * wide;
            diagonal[i + 1] += w->g * (r / (h * h) + n1 * n1 / r) * wide;
            off[i] += w->g * (n0 * n1 / r - r / (h * h)) * wide;
        }
    }
    for (int i = wall[0].in > 0 ? 0 : 1; i < n; i++) { /* on the axis there is none */
        diagonal[i + 1] -= off[i] * off[i] / diagonal[i];
        load[i + 1] -= off[i] / diagonal[i] * load[i];
    }
    for (int i = n; i >= (wall[0].in > 0 ? 0 : 1); i--) {
        load[i] = (load[i] - (i < n ? off[i] * load[i + 1] : 0)) / diagonal[i];
        rotation += weight[i] * load[i];
    }
    return pi * bending * bending / rotation;
}

/* Of a section with layers, its own part first; the limit of two meshes, whose errors fall as the square. */
static double layered_shear(int walls, struct wall *wall)
{
    for (int i = 1; i < walls; i++)
        for (int j = i; j > 0 && wall[j].in < wall[j - 1].in; j--) {
            struct wall held = wall[j];
            wall[j] = wall[j - 1];
            wall[j - 1] = held;
        }
    double coarse = flexure(walls, wall, MOST_ELEMENTS / 2), fine = flexure(walls, wall, MOST_ELEMENTS);
    return fine + (fine - coarse) / 3;
}

/* Of the length of every hub the middle part `share` is one piece with the shaft, which is that much thicker there. */
static void thicken(const struct hide_rotor *rotor, const struct hide_segment *s, double share, double z,
                    struct hide_section *section)
{
    for (int i = 0; i < rotor->disks; i++) {
        const struct hide_disk *disk = &rotor->disk[i];
        if (s->rectangular || !(disk->hub > s->outer) || fabs(z - disk->z) > share * disk->hub_length / 2)
            continue;
        struct moments own = ring(s->stiff, s->inner), with = ring(disk->hub, s->inner);
        section->bending *= with.second / own.second;
        section->shear *= with.area / own.area;
    }
}

/* Adds w (coefficient' u)^2 to the matrix and load, u the four values of an element from unknown `first` on: the strain is
 * coefficient' u + own, beside which `other` is the second factor of a product (NULL: itself). */
static void add_strain(double matrix[][4], double *load, int first, double weight, const double *one, double own,
                       const double *two, double other)
{
    for (int i = 0; i < 4; i++) {
        load[first + i] -= weight * (one[i] * other + two[i] * own) / 2;
        for (int j = 0; j <= i; j++)
            matrix[first + i][i - j] += weight * (one[i] * two[j] + one[j] * two[i]) / 2;
    }
}

/* What bonded walls of different contraction add to EI: in bending by the curvature 1 the plane would contract by `free` r alone
 * in each wall; twice the least energy of the displacements U cos t and V sin t by `each` linear elements a wall. */
static double restraint(int walls, const struct wall *wall, int each)
{
    static double matrix[2 * ((1 + HIDE_MOST_RINGS) * MOST_ELEMENTS + 1)][4], load[sizeof matrix / sizeof *matrix];
    double energy = 0;
    int n = walls * each, unknowns = 2 * (n + 1);
    for (int i = 0; i < unknowns; i++)
        load[i] = matrix[i][0] = matrix[i][1] = matrix[i][2] = matrix[i][3] = 0;
    for (int i = 0; i < n; i++) {
        const struct wall *w = &wall[i / each];
        double h = (w->out - w->in) / each, from = w->in + h * (i % each);
        for (int side = -1; side <= 1; side += 2) {
            double t = 0.5 + side / sqrt(12), r = from + h * t, wide = pi * r * h / 2, own = w->free * r;
            const double radial[4] = {-1 / h, 0, 1 / h, 0}, around[4] = {(1 - t) / r, (1 - t) / r, t / r, t / r},
                         shear[4] = {-(1 - t) / r, -1 / h - (1 - t) / r, -t / r, 1 / h - t / r};
            add_strain(matrix, load, 2 * i, w->stretch * wide, radial, own, radial, own);
            add_strain(matrix, load, 2 * i, w->stretch * wide, around, own, around, own);
            add_strain(matrix, load, 2 * i, 2 * w->cross * wide, radial, own, around, own);
            add_strain(matrix, load, 2 * i, (w->stretch - w->cross) / 2 * wide, shear, 0, shear, 0);
            energy += 2 * (w->stretch + w->cross) * own * own * wide;
        }
    }
    matrix[0][0] *= 1e12; /* no translation, and none of the axis */
    matrix[1][0] *= wall[0].in > 0 ? 1 : 1e12;
    for (int i = 0; i < unknowns; i++) /* L D L', band of three beside the diagonal */
        for (int j = i + 1; j < unknowns && j <= i + 3; j++) {
            double ratio = matrix[j][j - i] / matrix[i][0];
            for (int k = j; k < unknowns && k <= i + 3; k++)
                matrix[k][k - j] -= ratio * matrix[k][k - i];
            load[j] -= ratio * load[i];
        }
    for (int i = 0; i < unknowns; i++) /* least energy: less load' K^-1 load */
        energy -= load[i] * load[i] / matrix[i][0];
    return energy;
}

/* A mass spread over a width; its turning is that of its parts moving, as of a sleeve without thickness. */
static double spread(const struct hide_effect *e, double z)
{
    double width = hide_get(e, "width")->number;
    return width > 0 && fabs(z - hide_get(e, "z")->number) <= width / 2 ? hide_get(e, "mass")->number / width : 0;
}

void hide_section_at(const struct hide_physics *physics, int segment, double z, struct hide_section *section)
{
    const struct hide_rotor *rotor = physics->rotor;
    const struct hide_segment *s = &rotor->segment[segment];
    double stiff = s->stiff;
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "step_stiffness"))
            stiff = fmin(stiff, cone(rotor, hide_get(&physics->effect[i], "angle")->number, z));
    /* A cone from a solid end into a wide bore would leave nothing at all; a sleeve of 2 % of the wall keeps it one piece. */
    stiff = fmax(stiff, s->inner + 0.02 * (s->stiff - s->inner));
    *section = (struct hide_section){0, 0, 0, 0};
    struct wall wall[1 + HIDE_MOST_RINGS];
    add_part(physics, s->group, s, stiff, z, section, &wall[0]);
    for (int i = 0; i < s->rings; i++) {
        struct hide_segment ring = {.outer = s->ring[i].outer, .inner = s->ring[i].inner};
        add_part(physics, s->ring[i].group, &ring, ring.outer, z, section, &wall[1 + i]);
    }
    if (s->rings) {
        section->shear = layered_shear(1 + s->rings, wall);
        double coarse = restraint(1 + s->rings, wall, MOST_ELEMENTS / 4), fine = restraint(1 + s->rings, wall, MOST_ELEMENTS / 2);
        section->bending += fine + (fine - coarse) / 3;
    }
    for (int i = 0; i < physics->effects; i++) {
        const struct hide_effect *e = &physics->effect[i];
        if (hide_is(e, "hub_stiffness"))
            thicken(rotor, s, hide_get(e, "share")->number, z, section);
        else if (hide_is(e, "added_mass"))
            section->mass += spread(e, z);
    }
}
