#include "solid/solid.h"

#include <math.h>
#include <string.h>

#include "linalg/linalg.h"
#include "rotor/rotor.h"

static const double place[SHARES] = {-0.77459666924148337704, 0, 0.77459666924148337704};
static const double weight[SHARES] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

static void add_product(double w, const double *x, const double *y, double *sum)
{
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++)
            sum[a + SOLID_NODES * b] += w * x[a] * y[b];
}

static void add_point(const struct solid_mesh *mesh, const struct solid_element *element, int ix, int iy, struct integrals *out)
{
    double n[SOLID_NODES], by_x[SOLID_NODES], by_y[SOLID_NODES], by_r[SOLID_NODES], by_z[SOLID_NODES], r = 0, rx = 0, ry = 0,
                                                                                                       zx = 0, zy = 0;
    double(*sum)[SOLID_NODES * SOLID_NODES] = out->value[iy];
    shape_of_element(place[ix], place[iy], n, by_x, by_y);
    for (int a = 0; a < SOLID_NODES; a++) {
        const struct solid_node *node = &mesh->node[element->node[a]];
        r += n[a] * node->r;
        rx += by_x[a] * node->r;
        ry += by_y[a] * node->r;
        zx += by_x[a] * node->z;
        zy += by_y[a] * node->z;
    }
    double jacobian = rx * zy - ry * zx, w = PI * weight[ix] * weight[iy] * jacobian * r * element->share;
    add_product(w, n, n, sum[BY_MASS]);
    for (int a = 0; a < SOLID_NODES; a++) {
        by_r[a] = (zy * by_x[a] - zx * by_y[a]) / jacobian;
        by_z[a] = (rx * by_y[a] - ry * by_x[a]) / jacobian;
        n[a] /= r;
    }
    add_product(w, by_r, by_r, sum[BY_R_R]);
    add_product(w, n, n, sum[BY_N_N]);
    add_product(w, by_z, by_z, sum[BY_Z_Z]);
    add_product(w, by_r, n, sum[BY_R_N]);
    add_product(w, by_r, by_z, sum[BY_R_Z]);
    add_product(w, n, by_z, sum[BY_N_Z]);
}

/* The mass outside the stiffness diameter moves with the outer edge: half of it each in U, V and W, as of a ring. */
static void add_extra(const struct solid_mesh *mesh, const struct solid_element *element, int iy, double *sum)
{
    double n[SOLID_NODES], by_x[SOLID_NODES], by_y[SOLID_NODES], slope = 0;
    shape_of_element(1, place[iy], n, by_x, by_y);
    for (int a = 0; a < SOLID_NODES; a++)
        slope += by_y[a] * mesh->node[element->node[a]].z;
    add_product(weight[iy] * slope * element->extra / 2, n, n, sum);
}

static void integrals_of(const struct solid_mesh *mesh, const struct solid_element *element, struct integrals *integrals)
{
    memset(integrals, 0, sizeof *integrals);
    for (int iy = 0; iy < SHARES; iy++) {
        for (int ix = 0; ix < SHARES; ix++)
            add_point(mesh, element, ix, iy, integrals);
        if (element->extra > 0)
            add_extra(mesh, element, iy, integrals->value[iy][BY_MASS]);
    }
}

/* Adds to k [24 * 24] the stiffness of one share, constants c, and of an axial stress [Pa], tension positive; both triangles.
 * harmonic: 1, or 0, of which everything is twice as much: int cos^2 t dt is pi or 2 pi. */
static void integrals_add_stiffness(const struct integrals *integrals, int share, int harmonic, const struct elasticity *of,
                                    double stress, double *k)
{
    const double turn = harmonic ? 1 : 2;
    const struct elasticity twice = {turn * of->c11, turn * of->c12, turn * of->c13,
                                     turn * of->c33, turn * of->c44, turn * of->c66},
                            *c = &twice;
    const double(*sum)[SOLID_NODES * SOLID_NODES] = integrals->value[share];
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++) {
            int ab = a + SOLID_NODES * b, ba = b + SOLID_NODES * a;
            double rr = sum[BY_R_R][ab], nn = sum[BY_N_N][ab], zz = sum[BY_Z_Z][ab], rn = sum[BY_R_N][ab], nr = sum[BY_R_N][ba],
                   rz = sum[BY_R_Z][ab], zr = sum[BY_R_Z][ba], nz = sum[BY_N_Z][ab], zn = sum[BY_N_Z][ba];
            double prestress = turn * stress * zz, twist = c->c66 * (nn - rn), back = c->c66 * (nn - nr);
            /* columns of the radial, tangential and axial motion of node b, in the rows of node a */
            double *of_r = k + 3 * (a + (ptrdiff_t)SOLID_DOFS * b), *of_n = of_r + SOLID_DOFS, *of_z = of_n + SOLID_DOFS;
            of_r[0] += c->c11 * (rr + nn) + c->c12 * (rn + nr) + c->c44 * zz + prestress;
            of_z[0] += c->c13 * (rz + nz) + c->c44 * zr;
            of_n[1] += c->c66 * (rr - rn - nr + nn) + c->c44 * zz + prestress;
            of_r[2] += c->c13 * (zr + zn) + c->c44 * rz;
            of_z[2] += c->c33 * zz + c->c44 * rr + prestress;
            if (!harmonic)
                continue;
            of_r[0] += c->c66 * nn;
            of_n[0] += c->c12 * rn + c->c11 * nn + back;
            of_r[1] += c->c12 * nr + c->c11 * nn + twist;
            of_n[1] += c->c11 * nn;
            of_z[1] += c->c13 * nz - c->c44 * zn;
            of_n[2] += c->c13 * zn - c->c44 * nz;
            of_z[2] += c->c44 * nn;
        }
}

void solid_add_mass(const struct integrals *integrals, int share, double rho, double *m)
{
    const double *sum = integrals->value[share][BY_MASS];
    for (int i = 0; i < SOLID_NODES * SOLID_NODES; i++)
        m[i] += rho * sum[i];
}

/* From and to, along z, of a share of a slice. */
static void integrals_share_span(double left, double right, int share, double *from, double *to)
{
    double before = 0;
    for (int i = 0; i < SHARES && i < share; i++)
        before += weight[i] / 2;
    *from = left + before * (right - left);
    *to = left + (before + weight[share] / 2) * (right - left);
}

static struct effect_span span_of(const struct solid *solid, const struct solid_element *element, int share)
{
    struct effect_span span = {.group = element->group, .segment = element->segment};
    integrals_share_span(solid->mesh.z[element->slice], solid->mesh.z[element->slice + 1], share, &span.from, &span.to);
    return span;
}

static double middle_of(const struct solid *solid, const struct solid_element *element)
{
    return (solid->mesh.z[element->slice] + solid->mesh.z[element->slice + 1]) / 2;
}

/* ---- joints: the slice beside the interface, on the side that is thinner, is the softer along the axis by the flexibility c of
 * a rotational spring, 1/E := 1/E + c I/t,  I of its section, t its length. On the thicker side the parts around it would hold
 * it. */

static double outer_radius(const struct solid_mesh *mesh, int slice)
{
    return mesh->node[mesh->element[solid_mesh_outermost(mesh, slice)].node[1]].r;
}

/* Whether the joint of an effect is in this slice. */
static int joint_in(const struct solid *solid, const struct effect *effect, int slice)
{
    const struct solid_mesh *mesh = &solid->mesh;
    const struct rotor *rotor = &solid->rotor;
    if (!effect->kind->joint)
        return 0;
    for (int left = slice > 0 ? slice - 1 : 0; left <= slice && left + 1 < mesh->nslice; left++)
        if (rotor->segment[mesh->segment[left]].group == effect->target &&
            rotor->segment[mesh->segment[left + 1]].group != effect->target)
            return slice == left + (outer_radius(mesh, left + 1) < outer_radius(mesh, left));
    return 0;
}

/* I/t of a slice */
static double inertia_over_length(const struct solid *solid, int slice)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double inner = mesh->node[mesh->element[mesh->first[slice]].node[0]].r;
    return PI / 4 * (pow(outer_radius(mesh, slice), 4) - pow(inner, 4)) / (mesh->z[slice + 1] - mesh->z[slice]);
}

/* c I/t, or its derivative with respect to a parameter of an effect */
static double joint_compliance(const struct solid *solid, int slice, int effect, int p)
{
    double sum = 0;
    for (int i = 0; i < solid->rotor.neffect; i++) {
        const struct effect *e = &solid->rotor.effect[i];
        if ((effect < 0 || effect == i) && joint_in(solid, e, slice))
            sum += p < 0 ? e->value[0] : 1;
    }
    return sum == 0 ? 0 : sum * inertia_over_length(solid, slice);
}

static struct elasticity_factors factors_of(const struct solid *solid, const struct solid_element *element, int share,
                                            double *rho)
{
    struct effect_field field = {1, 1, 1};
    double axial = 1;
    if (solid->rotor.neffect) {
        struct effect_span span = span_of(solid, element, share);
        field = effects_on_axis(&solid->rotor, &span, 0);
        double e = solid->rotor.group[element->group].material.e * field.e;
        axial = 1 / (1 + e * joint_compliance(solid, element->slice, -1, -1));
    }
    *rho = field.rho;
    return (struct elasticity_factors){field.e, field.g, axial};
}

/* ---- axial stress: the force on a section is shared in proportion to E */

static double stiff_area(const struct solid *solid, int segment, int group)
{
    const struct rotor *rotor = &solid->rotor;
    struct section section;
    double area = 0;
    if (rotor->segment[segment].group == group && !section_of_segment(rotor, segment, &section))
        area = section.stiff_area;
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == segment && rotor->ring[i].group == group && !section_of_ring(rotor, i, &section))
            area += section.stiff_area;
    return area;
}

/* E over the sum of E A, and its derivative with respect to the E that `by` is, of one group or several */
static double share_of_force(const struct solid *solid, const struct solid_element *element, const struct parameter *by,
                             double *derivative)
{
    const struct rotor *rotor = &solid->rotor;
    double sum = 0, of = 0, e = rotor->group[element->group].material.e;
    for (int g = 0; g < rotor->ngroup; g++) {
        double area = stiff_area(solid, element->segment, g);
        sum += rotor->group[g].material.e * area;
        of += by && parameter_is_of_group(by, g) ? area : 0;
    }
    if (derivative)
        *derivative = (parameter_is_of_group(by, element->group) - e * of / sum) / sum;
    return e / sum;
}

static double axial_force(const struct solid *solid, const struct solid_element *element)
{
    return rotor_axial_force(&solid->rotor, solid->rotor.segment[element->segment].group, middle_of(solid, element),
                             solid->mesh.type == MODE_BENDING);
}

static double axial_force_rate(const struct solid *solid, const struct solid_element *element, struct parameter parameter)
{
    return rotor_axial_force_derivative(&solid->rotor, parameter, middle_of(solid, element), solid->mesh.type == MODE_BENDING);
}

void solid_field_of_share(const struct solid *solid, const struct solid_element *element, int share, struct share *out)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    double rho;
    struct elasticity_factors factors = factors_of(solid, element, share, &rho);
    *out = (struct share){.elasticity = elasticity_of(material, &factors), .rho = material->rho * rho};
    double force = solid->elastic_only ? 0 : axial_force(solid, element);
    if (force != 0)
        out->stress = force * share_of_force(solid, element, NULL, NULL);
}

/* ---- derivatives */

static void add_elasticity(struct elasticity *sum, const struct elasticity *d)
{
    *sum = (struct elasticity){sum->c11 + d->c11, sum->c12 + d->c12, sum->c13 + d->c13,
                               sum->c33 + d->c33, sum->c44 + d->c44, sum->c66 + d->c66};
}

static int by_material(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                       struct share *rate)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    double rho, force = parameter.kind == PARAMETER_E ? axial_force(solid, element) : 0, derivative;
    if (force != 0) {
        (void)share_of_force(solid, element, &parameter, &derivative);
        rate->stress = force * derivative;
    }
    if (!parameter_is_of_group(&parameter, element->group))
        return rate->stress != 0;
    struct elasticity_factors factors = factors_of(solid, element, share, &rho);
    if (parameter.kind == PARAMETER_RHO) {
        rate->rho = rho;
        return 1;
    }
    rate->elasticity = elasticity_by_material(material, &factors, parameter.kind);
    if (parameter.kind == PARAMETER_E && factors.axial != 1) { /* f = 1/(1 + E c I/t): df/dE = -f (1 - f)/E */
        struct elasticity_factors d = {0, 0, -factors.axial * (1 - factors.axial) / material->e};
        struct elasticity more = elasticity_by_factors(material, &factors, &d);
        add_elasticity(&rate->elasticity, &more);
    }
    return 1;
}

static int by_effect(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    struct effect_span span = span_of(solid, element, share);
    struct effect_field relative = {0, 0, 0};
    double rho, force = axial_force_rate(solid, element, parameter);
    if (force != 0)
        rate->stress = force * share_of_force(solid, element, NULL, NULL);
    int moves = effects_axis_rate(&solid->rotor, parameter, &span, 0, &relative);
    double compliance = joint_compliance(solid, element->slice, parameter.index, parameter.component);
    if (!moves && compliance == 0)
        return rate->stress != 0;
    struct elasticity_factors f = factors_of(solid, element, share, &rho);
    struct elasticity_factors d = {f.e * relative.e, f.g * relative.g,
                                   -f.axial * (1 - f.axial) * relative.e - f.axial * f.axial * material->e * f.e * compliance};
    rate->elasticity = elasticity_by_factors(material, &f, &d);
    rate->rho = material->rho * rho * relative.rho;
    return 1;
}

int solid_field_rate(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate)
{
    *rate = (struct share){0};
    if (parameter.kind == PARAMETER_EFFECT)
        return by_effect(solid, element, share, parameter, rate);
    if (parameter.kind == PARAMETER_TENSION) {
        double force = axial_force_rate(solid, element, parameter);
        rate->stress = force == 0 ? 0 : force * share_of_force(solid, element, NULL, NULL);
        return force != 0;
    }
    return parameter.kind <= PARAMETER_RHO ? by_material(solid, element, share, parameter, rate) : 0;
}

static const struct solid_line *line_at(const struct solid *solid, double z)
{
    return &solid->line[solid_mesh_line(&solid->mesh, z)];
}

/* ---- springs and disks move with the section */

static int disk_of(const struct solid *solid, int i, int p, double *mass, double *inertia)
{
    const struct disk *disk = &solid->rotor.disk[i];
    enum mode_type type = solid->mesh.type;
    *mass = type == MODE_TORSION ? disk->polar : disk->mass;
    *inertia = type == MODE_BENDING ? effects_on_disk(&solid->rotor, i) : 0;
    if (p < 0)
        return 1;
    struct parameter parameter = solid->parameter[p];
    *mass = parameter.kind == PARAMETER_DISK_MASS && parameter.index == i && type != MODE_TORSION;
    *inertia = effects_disk_of(&solid->rotor, parameter) == i && type == MODE_BENDING;
    return *mass + *inertia != 0;
}

static void add_to_section(const struct target *a, const struct solid_line *line, double v, double theta)
{
    if (v != 0)
        motion_add(a, v, &line->v, &line->v);
    if (theta != 0)
        motion_add(a, theta, &line->theta, &line->theta);
}

/* ---- springs to the ground anywhere: shared between the lines on either side by their nearness, each with the motion that its
 * section would have there if it went on rigidly, v - dz theta. At a line nothing but that line is left, and no line is coupled
 * with the next one, which would widen the band. */

/* adds a stiffness on v - dz theta of a line and its derivative by dz, and one on theta */
static void add_carried(const struct solid_line *line, double dz, double lateral, double by_dz, double rotational,
                        const struct target *k)
{
    motion_add(k, lateral, &line->v, &line->v);
    motion_add(k, -2 * lateral * dz - 2 * by_dz, &line->v, &line->theta);
    motion_add(k, lateral * dz * dz + 2 * by_dz * dz + rotational, &line->theta, &line->theta);
}

/* d: NULL, or the rate of the point; then the derivative */
static void add_ground(const struct solid *solid, const struct effect_point *point, const struct effect_point *d,
                       const struct target *k)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double length = mesh->z[mesh->nslice], z = fmin(fmax(point->z, 0), length), moves = d && z == point->z ? d->z : 0;
    int slice = solid_mesh_slice(mesh, z);
    for (int side = 0; side < 2; side++) {
        double slope = (side ? 1 : -1) / (mesh->z[slice + 1] - mesh->z[slice]), dz = z - mesh->z[slice + side],
               share = 1 + slope * dz;
        const struct solid_line *line = &solid->line[slice + side];
        if (d)
            add_carried(line, dz, share * d->lateral + slope * moves * point->lateral, share * moves * point->lateral,
                        share * d->rotational + slope * moves * point->rotational, k);
        else
            add_carried(line, dz, share * point->lateral, 0, share * point->rotational, k);
    }
}

static void add_springs(const struct solid *solid, int p, const struct target *k)
{
    const struct rotor *rotor = &solid->rotor;
    enum mode_type type = solid->mesh.type;
    for (int i = 0; i < rotor->nspring && p < 0 && type != MODE_BENDING; i++)
        add_to_section(k, line_at(solid, rotor->spring[i].position),
                       type == MODE_TORSION ? rotor->spring[i].torsional : rotor->spring[i].axial, 0);
    for (int i = 0; i < rotor->nspring && type == MODE_BENDING; i++) {
        struct effect_point point, d;
        double line = solid->mesh.z[solid_mesh_line(&solid->mesh, rotor->spring[i].position)];
        if (p >= 0 && !effects_spring_derivative(rotor, solid->parameter[p], i, &d))
            continue;
        effects_on_spring(rotor, i, &point);
        point.z += line - rotor->spring[i].position; /* which may be a little beside */
        add_ground(solid, &point, p < 0 ? NULL : &d, k);
    }
}

/* ---- lumped masses sit on the surface as a ring: half of the mass in each of U, V and W, in torsion all of it in V, along the
 * axis in U and W. */

int solid_next_point(const struct solid *solid, int *effect, int *i, struct effect_point *point)
{
    for (; *effect < solid->rotor.neffect; (*effect)++, *i = -1) {
        const struct effect *e = &solid->rotor.effect[*effect];
        if (e->kind->point && e->kind->point(e, &solid->rotor, ++*i, -1, point))
            return 1;
    }
    return 0;
}

/* d = 0: the mass; 1: its derivative by place; for every component of the motion of the surface */
static void add_ring(const struct solid *solid, double z, double mass, double dz, const struct target *m)
{
    const struct solid_mesh *mesh = &solid->mesh;
    int dof[2][SURFACE_MOST + 3];
    double w[2][SURFACE_MOST + 3], radius = mesh->node[mesh->surface[2 * solid_mesh_slice(mesh, z) + 1]].r;
    for (int c = 0; c < 3; c++) {
        struct motion at, slope;
        double half = mesh->type == MODE_BENDING ? mass / 2 : mesh->type == MODE_AXIAL ? mass : mass * radius * radius;
        motion_of_surface(mesh, z, c, 0, dof[0], w[0], &at);
        if (dz == 0) {
            motion_add(m, half, &at, &at);
            continue;
        }
        motion_of_surface(mesh, z, c, 1, dof[1], w[1], &slope);
        motion_add(m, 2 * dz * half, &at, &slope);
    }
}

/* The masses of effects, and their springs to the ground. */
static void add_points(const struct solid *solid, int p, const struct target *k, const struct target *m)
{
    struct effect_point point, d;
    struct parameter parameter = p < 0 ? (struct parameter){.index = 0} : solid->parameter[p];
    double length = solid->mesh.z[solid->mesh.nslice];
    if (p >= 0 && parameter.kind != PARAMETER_EFFECT)
        return;
    for (int effect = 0, i = -1; solid_next_point(solid, &effect, &i, &point);) {
        const struct effect *e = &solid->rotor.effect[effect];
        int rate = p >= 0 && parameter.index == effect && e->kind->point(e, &solid->rotor, i, parameter.component, &d);
        if (p >= 0 && !rate)
            continue;
        if (k && !solid->elastic_only && solid->mesh.type == MODE_BENDING &&
            (point.lateral != 0 || point.rotational != 0 || (rate && (d.lateral != 0 || d.rotational != 0))))
            add_ground(solid, &point, p < 0 ? NULL : &d, k);
        if (m && p < 0)
            add_ring(solid, point.z, point.mass, 0, m);
        if (m && rate && d.mass != 0)
            add_ring(solid, point.z, d.mass, 0, m);
        if (m && rate && d.z != 0 && point.z > 0 && point.z < length)
            add_ring(solid, point.z, point.mass, d.z, m);
    }
}

void solid_add_attached(const struct solid *solid, int p, const struct target *k, const struct target *m)
{
    const struct rotor *rotor = &solid->rotor;
    double a, b;
    if (k && !solid->elastic_only)
        add_springs(solid, p, k);
    for (int i = 0; i < rotor->ndisk && m; i++)
        if (disk_of(solid, i, p, &a, &b))
            add_to_section(m, line_at(solid, rotor->disk[i].position), a, b);
    if (rotor->neffect)
        add_points(solid, p, k, m);
    members_assemble(solid, p, k, m);
}

/* Adds the masses about the left end: zeroth, first and second moments [kg, kg.m, kg.m2]. */
static void attached_moments(const struct solid *solid, double moment[3])
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    struct effect_point point;
    for (int i = 0; i < rotor->ndisk; i++) {
        double z = mesh->z[solid_mesh_line(mesh, rotor->disk[i].position)], mass = rotor->disk[i].mass;
        moment[0] += mass;
        moment[1] += mass * z;
        moment[2] += mass * z * z + effects_on_disk(rotor, i);
    }
    for (int effect = 0, i = -1; solid_next_point(solid, &effect, &i, &point);) {
        double z = fmin(fmax(point.z, 0), mesh->z[mesh->nslice]),
               radius = mesh->node[mesh->surface[2 * solid_mesh_slice(mesh, z) + 1]].r;
        moment[0] += point.mass;
        moment[1] += point.mass * z;
        moment[2] += point.mass * (z * z + radius * radius / 2);
    }
    members_moments(solid, moment);
}

#define WASHER 2 /* diameters of a rod: what its nut and washer press on */

/* All sections, since a cause may put a spring anywhere, and the ends of tie rods. */
static int build_lines(struct pool *pool, struct solid *solid, int *failed)
{
    const struct rotor *rotor = &solid->rotor;
    int status = ROTID_OK, from, to;
    for (int l = 0; l <= solid->mesh.nslice && !status; l++)
        status = motion_of_section(pool, rotor, &solid->mesh, l, &solid->line[l].v, &solid->line[l].theta);
    for (int i = 0; i < rotor->ntierod && !status; i++) {
        *failed = rotor->ngroup + i;
        solid_mesh_member(rotor, &solid->mesh, i, &from, &to);
        for (int g = 3 * from; g < 3 * to && !status && solid->mesh.type == MODE_BENDING && solid_mesh_follows(rotor, i); g++)
            if (!solid->inside[g].v.count)
                status =
                    motion_in_slice(pool, rotor, &solid->mesh, g / 3, g % 3 - 1, &solid->inside[g].v, &solid->inside[g].theta);
        if (status)
            return status;
        double pitch = rotor->tierod[i].pitch, reach = WASHER * rotor->tierod[i].diameter / 2;
        struct motion *stretch = &solid->stretch[2 * (ptrdiff_t)i];
        status = motion_axial(pool, &solid->mesh, from, pitch, reach, &stretch[0]);
        if (!status)
            status = motion_axial(pool, &solid->mesh, to, pitch, reach, &stretch[1]);
    }
    return status;
}

static int gather_far(struct pool *pool, struct solid *solid)
{
    int n = 0, most = 0;
    for (int i = 0; i < 2 * solid->rotor.ntierod; i++)
        most += solid->stretch[i].count;
    solid->far = POOL_ARRAY(pool, int, most);
    if (!solid->far)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * solid->rotor.ntierod; i++)
        for (int j = 0; j < solid->stretch[i].count; j++)
            solid->far[n++] = solid->stretch[i].dof[j];
    sort_ints((size_t)n, solid->far);
    for (int i = 0; i < n; i++)
        if (!solid->nfar || solid->far[solid->nfar - 1] != solid->far[i])
            solid->far[solid->nfar++] = solid->far[i];
    return ROTID_OK;
}

/* What has no meaning in a solid. */
static int refuse_tubes(const struct rotor *rotor, int *failed)
{
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        *failed = rotor->ngroup + i;
        if ((i < rotor->ntierod ? rotor->tierod[i].model : rotor->bars[i - rotor->ntierod].model) == BUNDLE_TUBE)
            return ROTID_ERROR_SECTION;
    }
    return ROTID_OK;
}

#define MOST_BULK                                                                                                                \
    1e7 /* C11/C66, of nu 0.49999995: rounding of K leaves 0.01 % of frequencies there, 0.5 % at a hundred times that */

static int keeps_its_volume(const struct group *group)
{
    struct elasticity c = elasticity_of(&group->material, &(struct elasticity_factors){1, 1, 1});
    return !(fabs(c.c11) < MOST_BULK * c.c66);
}

const char *solid_refusal(const struct rotor *rotor, int failed)
{
    int rod = failed - rotor->ngroup, bars = rod - rotor->ntierod;
    if (rod < 0 && keeps_its_volume(&rotor->group[failed]))
        return "the *ELASTIC of this group has a Poisson ratio of 0.5, with which a solid cannot change its volume and has no "
               "finite stiffness, expected nu of at most 0.4999999, or *FIT, MODEL=BEAM";
    if (bars >= rotor->nbars && outline_slenderness(rotor) > SOLID_MOST_SLENDER)
        return "the rotor is more than 1000 times as long as its largest diameter, which a solid loses in rounding, expected a "
               "thicker one, or *FIT, MODEL=BEAM";
    if (bars >= rotor->nbars)
        return "a solid of this rotor has too many unknowns, expected fewer steps of the diameter, sections that are less wide "
               "and "
               "thin, or *FIT, MODEL=BEAM";
    if (bars >= 0 || (rod >= 0 && rotor->tierod[rod].model == BUNDLE_TUBE))
        return "an equivalent tube has no counterpart in a solid, whose sections need not stay plane, expected MODEL=RODS, or "
               "*FIT, "
               "MODEL=BEAM";
    if (rod >= 0)
        return "the rods end where there is no material: their pitch radius is outside the section at one of their ends, "
               "expected "
               "ends inside the shaft";
    for (int s = 0; s < rotor->nsegment; s++) {
        if (rotor->segment[s].group == failed && rotor->segment[s].rectangular)
            return "a solid is a body of revolution, and a *BEAM is not, expected *SHAFT, or *FIT, MODEL=BEAM";
        if (rotor->segment[s].group == failed && s > 0 && !outline_touch(rotor, s))
            return "a section of this group does not touch the one before: its bore is as wide as that one, expected sections "
                   "that "
                   "overlap, or *FIT, MODEL=BEAM";
    }
    return "the holes leave nothing of the annulus that they lie in, expected fewer or smaller ones";
}

double solid_longest_passage(const struct solid *solid)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double longest = 0;
    for (int i = 0; i < mesh->nelement; i++) {
        const struct solid_element *e = &mesh->element[i];
        const struct material *m = &solid->rotor.group[e->group].material;
        double length = mesh->z[e->slice + 1] - mesh->z[e->slice];
        longest = fmax(longest, length * sqrt(m->rho / material_shear_modulus(m)));
    }
    return longest;
}

static void hang(struct solid *solid)
{
    struct mass_properties own;
    if (solid->rotor.sling > 0) {
        solid_mass_properties(solid, &own);
        rotor_set_sling(&solid->rotor, own.mass, own.center);
    }
}

int solid_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter,
                const struct solid_rule *rule, int refine, struct solid *solid, int *failed)
{
    static const struct solid_rule from_rotor = {0};
    *failed = -1;
    *solid = (struct solid){.nparameter = nparameter, .parameter = parameter};
    int status = rotor_copy(pool, rotor, &solid->rotor);
    if (!status)
        status = refuse_tubes(rotor, failed);
    for (int g = 0; g < rotor->ngroup && !status; g++)
        if (keeps_its_volume(&rotor->group[ *failed = g]))
            status = ROTID_ERROR_SECTION;
    if (!status)
        status = solid_mesh_build(pool, &solid->rotor, rule ? rule : &from_rotor, refine, &solid->mesh, failed);
    if (status)
        return status;
    solid->integrals = POOL_ARRAY(pool, struct integrals, solid->mesh.nelement);
    solid->line = POOL_ARRAY(pool, struct solid_line, solid->mesh.nslice + 1);
    solid->inside = POOL_ARRAY(pool, struct solid_line, 3 * (size_t)solid->mesh.nslice);
    solid->stretch = POOL_ARRAY(pool, struct motion, 2 * rotor->ntierod);
    if (!solid->integrals || !solid->line || !solid->inside || !solid->stretch)
        return ROTID_ERROR_MEMORY;
    for (int e = 0; e < solid->mesh.nelement; e++)
        integrals_of(&solid->mesh, &solid->mesh.element[e], &solid->integrals[e]);
    status = build_lines(pool, solid, failed);
    if (!status)
        status = gather_far(pool, solid);
    hang(solid);
    return status;
}

int solid_of_shape(struct pool *pool, const struct solid *built, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, struct solid *solid)
{
    *solid = *built;
    solid->nparameter = nparameter;
    solid->parameter = parameter;
    int status = rotor_copy(pool, rotor, &solid->rotor);
    if (!status)
        hang(solid);
    return status;
}

void solid_set(struct solid *solid, const double *x)
{
    parameters_set(&solid->rotor, solid->nparameter, solid->parameter, x);
}

/* ------------------------------------------------------------------------------------------------ elements */

/* On the axis V = -U and W = 0; in torsion V is r times the unknown; a sensor stands for U of node 5 (or its V/r, its W):
 * U5 = (sensor - n1 U1 - n2 U2)/n5. The rows and columns of the element follow, and those that are no unknowns are left out when
 * it is added. */
static void tie_columns(const struct solid *solid, const struct solid_element *element, double *a, ptrdiff_t stride,
                        ptrdiff_t step)
{
    enum mode_type type = solid->mesh.type;
    for (int n = 0; n < SOLID_NODES; n++) {
        double r = solid->mesh.node[element->node[n]].r, *u = &a[stride * 3 * n], *v = u + stride;
        for (int i = 0; i < SOLID_DOFS && type == MODE_BENDING && r == 0; i++)
            u[i * step] -= v[i * step];
        for (int i = 0; i < SOLID_DOFS && type == MODE_TORSION; i++)
            v[i * step] *= r;
    }
    if (element->sensor < 0)
        return;
    const double *at = element->at_sensor;
    for (int i = 0; i < SOLID_DOFS; i++) {
        double *outer = &a[(int)type * stride + i * step], *middle = outer + 15 * stride;
        *middle /= at[1];
        outer[3 * stride] -= at[0] * *middle;
        outer[6 * stride] -= at[2] * *middle;
    }
}

void solid_tie_element(const struct solid *solid, const struct solid_element *element, double *e, int *dof)
{
    tie_columns(solid, element, e, SOLID_DOFS, 1);
    tie_columns(solid, element, e, 1, SOLID_DOFS);
    for (int i = 0; i < SOLID_DOFS; i++) {
        const struct solid_node *node = &solid->mesh.node[element->node[i / 3]];
        dof[i] = node->r == 0 && i % 3 == 1 ? -1 : node->dof[i % 3];
    }
}

void solid_add_element(const struct solid *solid, const struct solid_element *element, double *e, rotid_matrix *a)
{
    int dof[SOLID_DOFS], stride = a->kd + 1;
    solid_tie_element(solid, element, e, dof);
    for (int j = 0; j < SOLID_DOFS; j++)
        for (int i = 0; i < SOLID_DOFS && dof[j] >= 0; i++)
            if (dof[i] >= dof[j])
                a->band[(dof[i] - dof[j]) + (ptrdiff_t)dof[j] * stride] += e[i + SOLID_DOFS * j];
}

static void spread_mass(const double *m, double *e)
{
    memset(e, 0, sizeof(double[SOLID_DOFS * SOLID_DOFS]));
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++)
            for (int c = 0; c < 3; c++)
                e[3 * a + c + SOLID_DOFS * (3 * b + c)] = m[a + SOLID_NODES * b];
}

void solid_element_matrices(const struct solid *solid, int index, const struct share *field, double *k, double *m, int *has_k,
                            int *has_m)
{
    double mass[SOLID_NODES * SOLID_NODES];
    *has_k = *has_m = 0;
    int harmonic = solid->mesh.type == MODE_BENDING;
    for (int s = 0; s < SHARES; s++) {
        const struct share *share = &field[s];
        const struct elasticity *c = &share->elasticity;
        if (c->c11 != 0 || c->c12 != 0 || c->c13 != 0 || c->c33 != 0 || c->c44 != 0 || c->c66 != 0 || share->stress != 0) {
            if (!*has_k)
                memset(k, 0, sizeof(double[SOLID_DOFS * SOLID_DOFS]));
            integrals_add_stiffness(&solid->integrals[index], s, harmonic, c, share->stress, k);
            *has_k = 1;
        }
        if (share->rho != 0) {
            if (!*has_m)
                memset(mass, 0, sizeof mass);
            solid_add_mass(&solid->integrals[index], s, harmonic ? share->rho : 2 * share->rho, mass);
            *has_m = 1;
        }
    }
    if (*has_m)
        spread_mass(mass, m);
}

void solid_fields_of(const struct solid *solid, int index, int p, struct share *field)
{
    const struct solid_element *now = &solid->mesh.element[index], *last = index ? now - 1 : NULL;
    if (last && last->slice == now->slice && last->group == now->group && last->segment == now->segment)
        return;
    for (int s = 0; s < SHARES; s++)
        if (p < 0)
            solid_field_of_share(solid, now, s, &field[s]);
        else
            (void)solid_field_rate(solid, now, s, solid->parameter[p], &field[s]);
}

static void take_in(int dof, int *from, int *end)
{
    *from = dof >= 0 && dof < *from ? dof : *from;
    *end = dof >= *end ? dof + 1 : *end;
}

static void take_in_element(const struct solid *solid, const struct solid_element *element, int *from, int *end)
{
    for (int n = 0; n < SOLID_NODES; n++)
        for (int c = 0; c < 3; c++)
            take_in(solid->mesh.node[element->node[n]].dof[c], from, end);
}

static void take_in_section(const struct solid_line *line, int *from, int *end)
{
    for (int t = 0; t < 2; t++) {
        const struct motion *motion = t ? &line->theta : &line->v;
        for (int j = 0; j < motion->count; j++)
            take_in(motion->dof[j], from, end);
    }
}

/* Rows of what solid_add_attached adds for parameter p: those of the sections and of the surface at the points of an effect, of
 * the section of a disk; all of them where something else is attached that moves with p. */
static void take_in_attached(const struct solid *solid, int p, int *from, int *end)
{
    const struct parameter parameter = solid->parameter[p];
    const struct effect *e = parameter.kind == PARAMETER_EFFECT ? &solid->rotor.effect[parameter.index] : NULL;
    const struct solid_mesh *mesh = &solid->mesh;
    struct effect_point point;
    if (parameter.kind <= PARAMETER_RHO)
        return;
    if (e && e->kind->at_disk)
        take_in_section(line_at(solid, solid->rotor.disk[e->target].position), from, end);
    if (!e || e->kind->spring || e->kind->tierod) {
        *from = 0;
        *end = mesh->ndof;
        return;
    }
    for (int i = 0; e->kind->point && e->kind->point(e, &solid->rotor, i, -1, &point); i++) {
        int slice = solid_mesh_slice(mesh, fmin(fmax(point.z, 0), mesh->z[mesh->nslice]));
        take_in_element(solid, &mesh->element[solid_mesh_outermost(mesh, slice)], from, end);
        for (const struct solid_line *line = &solid->line[slice]; line <= &solid->line[slice + 1]; line++)
            take_in_section(line, from, end);
    }
}

static void assemble(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m, int *from, int *end)
{
    double ek[SOLID_DOFS * SOLID_DOFS], em[SOLID_DOFS * SOLID_DOFS];
    struct share field[SHARES];
    int has_k, has_m;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        const struct solid_element *element = &solid->mesh.element[e];
        solid_fields_of(solid, e, p, field);
        solid_element_matrices(solid, e, field, ek, em, &has_k, &has_m);
        if (has_k)
            solid_add_element(solid, element, ek, k);
        if (has_m)
            solid_add_element(solid, element, em, m);
        if (p >= 0 && (has_k || has_m))
            take_in_element(solid, element, from, end);
    }
    solid_add_attached(solid, p, &(struct target){.a = k}, &(struct target){.a = m});
}

void solid_assemble(struct solid *solid, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    solid_set(solid, x);
    assemble(solid, -1, k, m, NULL, NULL);
}

void solid_differentiate(const struct solid *solid, int p, rotid_matrix *dk, rotid_matrix *dm, int *from, int *end)
{
    *from = solid->mesh.ndof;
    *end = 0;
    take_in_attached(solid, p, from, end);
    assemble(solid, p, dk, dm, from, end);
    *from = *from < *end ? *from : *end;
}

/* y [ndof * count] += E u */
static void add_product_of_element(const struct solid *solid, const struct solid_element *element, double *e, int count,
                                   const double *u, double *y)
{
    int dof[SOLID_DOFS];
    solid_tie_element(solid, element, e, dof);
    for (int c = 0; c < count; c++, u += solid->mesh.ndof, y += solid->mesh.ndof) {
        double sum[SOLID_DOFS] = {0};
        for (int j = 0; j < SOLID_DOFS; j++) {
            const double *column = e + (ptrdiff_t)SOLID_DOFS * j, uj = dof[j] < 0 ? 0 : u[dof[j]];
            for (int i = 0; i < SOLID_DOFS; i++)
                sum[i] += column[i] * uj;
        }
        for (int i = 0; i < SOLID_DOFS; i++)
            if (dof[i] >= 0)
                y[dof[i]] += sum[i];
    }
}

void solid_add_images(const struct solid *solid, int index, const struct share *field, int count, const double *u,
                      struct solid_image image[2])
{
    const struct solid_element *element = &solid->mesh.element[index];
    double e[2][SOLID_DOFS * SOLID_DOFS];
    int has[2];
    solid_element_matrices(solid, index, field, e[0], e[1], &has[0], &has[1]);
    for (int i = 0; i < 2; i++) {
        if (!has[i])
            continue;
        add_product_of_element(solid, element, e[i], count, u, image[i].y);
        take_in_element(solid, element, &image[i].from, &image[i].end);
    }
}

int solid_derivative_products(const struct solid *solid, int p, int count, const double *u, double *dk_u, double *dm_u, int *from,
                              int *end)
{
    struct solid_image image[2] = {{dk_u, solid->mesh.ndof, 0}, {dm_u, solid->mesh.ndof, 0}};
    struct share field[SHARES];
    int attached_end = 0;
    *from = solid->mesh.ndof;
    take_in_attached(solid, p, from, &attached_end);
    if (attached_end)
        return 1;
    memset(dk_u, 0, (size_t)count * (size_t)solid->mesh.ndof * sizeof *dk_u);
    memset(dm_u, 0, (size_t)count * (size_t)solid->mesh.ndof * sizeof *dm_u);
    for (int e = 0; e < solid->mesh.nelement; e++) {
        solid_fields_of(solid, e, p, field);
        solid_add_images(solid, e, field, count, u, image);
    }
    *end = image[0].end > image[1].end ? image[0].end : image[1].end;
    *from = image[0].from < image[1].from ? image[0].from : image[1].from;
    *from = *from < *end ? *from : *end;
    return 0;
}

/* ------------------------------------------------------------------------------------------------ mass, motion, energy */

void solid_mass_properties(const struct solid *solid, struct mass_properties *properties)
{
    double moment[3] = {0, 0, 0};
    for (int e = 0; e < solid->mesh.nelement; e++) {
        const struct solid_element *element = &solid->mesh.element[e];
        double mass[SOLID_NODES * SOLID_NODES] = {0};
        struct share share;
        for (int s = 0; s < SHARES; s++) {
            solid_field_of_share(solid, element, s, &share);
            solid_add_mass(&solid->integrals[e], s, 2 * share.rho, mass);
        }
        for (int b = 0; b < SOLID_NODES; b++)
            for (int a = 0; a < SOLID_NODES; a++) {
                const struct solid_node *na = &solid->mesh.node[element->node[a]], *nb = &solid->mesh.node[element->node[b]];
                double w = mass[a + SOLID_NODES * b];
                moment[0] += w;
                moment[1] += w * nb->z;
                moment[2] += w * (na->z * nb->z + na->r * nb->r / 2);
            }
    }
    attached_moments(solid, moment);
    properties->mass = moment[0];
    properties->center = moment[1] / moment[0];
    properties->inertia = moment[2] - moment[1] * moment[1] / moment[0];
}

void solid_element_motion(const struct solid *solid, const struct solid_element *element, const double *u, double *local)
{
    for (int i = 0; i < SOLID_DOFS; i++) {
        const struct solid_node *node = &solid->mesh.node[element->node[i / 3]];
        int dof = node->dof[i % 3];
        local[i] = dof < 0 ? 0 : node->r == 0 && i % 3 == 1 ? -u[dof] : u[dof];
    }
    double *outer = local + solid->mesh.type;
    if (element->sensor >= 0)
        outer[15] = (outer[15] - element->at_sensor[0] * outer[3] - element->at_sensor[2] * outer[6]) / element->at_sensor[1];
    for (int n = 0; n < SOLID_NODES && solid->mesh.type == MODE_TORSION; n++)
        local[3 * n + 1] *= solid->mesh.node[element->node[n]].r;
}

void solid_rigid_motions(const struct solid *solid, double *u)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double *turn = u + mesh->ndof;
    for (int i = 0; i < mesh->nnode && mesh->type != MODE_BENDING; i++)
        if (mesh->node[i].dof[mesh->type] >= 0)
            u[mesh->node[i].dof[mesh->type]] = 1;
    if (mesh->type != MODE_BENDING)
        return;
    for (int i = 0; i < mesh->nnode; i++) {
        const struct solid_node *node = &mesh->node[i];
        for (int c = 2; c >= 0; c--) /* U last: on the axis V has its degree of freedom */
            if (node->dof[c] >= 0) {
                u[node->dof[c]] = c == 0 ? 1 : c == 1 ? -1 : 0;
                turn[node->dof[c]] = c == 0 ? -node->z : c == 1 ? node->z : node->r;
            }
    }
    for (int l = 0; l <= 2 * mesh->nslice; l++) /* a sensor is at a place of its own */
        turn[mesh->node[mesh->surface[l]].dof[0]] = -mesh->surface_z[l];
    for (int i = 0; i < solid->rotor.ntierod + solid->rotor.nbars; i++)
        for (int l = 0; l <= mesh->nslice; l++) {
            int dof = *solid_mesh_member_dof(mesh, i, l);
            if (dof < 0)
                continue;
            u[dof] = turn[dof + 1] = 1;
            u[dof + 1] = 0;
            turn[dof] = -mesh->z[l];
        }
}

void solid_strain_energy(const struct solid *solid, const double *u, double *energy)
{
    double ek[SOLID_DOFS * SOLID_DOFS], em[SOLID_DOFS * SOLID_DOFS], local[SOLID_DOFS];
    struct share field[SHARES];
    int has_k, has_m;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        solid_fields_of(solid, e, -1, field);
        solid_element_matrices(solid, e, field, ek, em, &has_k, &has_m);
        solid_element_motion(solid, &solid->mesh.element[e], u, local);
        energy[e] = 0;
        if (!has_k)
            continue;
        for (int j = 0; j < SOLID_DOFS; j++)
            for (int i = 0; i < SOLID_DOFS; i++)
                energy[e] += 0.5 * local[i] * ek[i + SOLID_DOFS * j] * local[j];
    }
}
