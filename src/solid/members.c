#include "beam/beam.h"
#include "linalg/linalg.h"
#include "solid/solid.h"

struct member {
    int number;
    const struct material *material;
    struct section section; /* of all rods together, each about its own axis */
    double pitch;           /* m4: what their area has beside that about the rotor's axis */
    double force;           /* N, of all */
    double young;           /* factor of causes on E */
};

static struct member member_of(const struct solid *solid, int i)
{
    const struct rotor *rotor = &solid->rotor;
    const struct tierod *rod = i < rotor->ntierod ? &rotor->tierod[i] : NULL;
    const struct bars *bars = rod ? NULL : &rotor->bars[i - rotor->ntierod];
    struct member member = {
        .number = rod ? rod->number : bars->number, .material = rod ? &rod->material : &bars->material, .young = 1};
    double area, own;
    section_rods(member.number, rod ? rod->diameter : bars->diameter, rod ? rod->pitch : bars->pitch, &area, &own, &member.pitch);
    member.section = (struct section){.stiff_area = area, .stiff_inertia = own, .mass_area = area, .mass_inertia = own};
    if (rod) {
        struct effect_bundle factor = effects_on_tierod(rotor, i);
        member.young = factor.young;
        member.force = rod->number * rod->tension * factor.tension;
    }
    return member;
}

static struct element element_of(const struct solid *solid, const struct member *member, double length)
{
    const struct material *material = member->material;
    return (struct element){.ei = material->e * member->young * member->section.stiff_inertia,
                            .kgs = shear_stiffness_plain(&member->section, material) * member->young,
                            .rhos = material->rho * member->section.mass_area,
                            .rhoi = material->rho * member->section.mass_inertia,
                            .force = solid->elastic_only ? 0 : member->force,
                            .length = length};
}

/* Derivatives of the five quantities and of E S e^2/2 = stretch * E pitch; 0 where they vanish. */
static int direction_of(const struct solid *solid, const struct member *member, int i, struct parameter parameter,
                        struct element *d, double *stretch)
{
    const struct rotor *rotor = &solid->rotor;
    struct effect_bundle rate = {0, 0, 0};
    struct element now = element_of(solid, member, 1);
    *d = (struct element){0};
    *stretch = 0;
    if (i >= rotor->ntierod)
        return 0;
    if (parameter.kind == PARAMETER_EFFECT) {
        if (!effects_tierod_derivative(rotor, parameter, i, &rate))
            return 0;
        rate.young /= member->young;
        d->force = rotor->tierod[i].number * rotor->tierod[i].tension * rate.tension;
    } else if (parameter.index == i && parameter.kind == PARAMETER_TENSION) {
        d->force = rotor->tierod[i].number * effects_on_tierod(rotor, i).tension;
    } else if (parameter.index == i && parameter.kind == PARAMETER_TIEROD_E) {
        rate.young = 1 / member->material->e;
    } else {
        return 0;
    }
    d->ei = now.ei * rate.young;
    d->kgs = parameter.kind == PARAMETER_TIEROD_E && !member->material->isotropic ? 0 : now.kgs * rate.young;
    *stretch = rate.young;
    return 1;
}

/* The line with which bars move. */
static const struct solid_line *center_of(const struct solid *solid, int bars)
{
    return &solid->line[solid_mesh_line(&solid->mesh, solid->rotor.bars[bars].center)];
}

/* v and theta of a member on a line: its own, or those of the section; room for two terms of its own */
struct end {
    int dof[2];
    double one;
    struct motion motion[2];
};

static void end_of(const struct solid *solid, int i, int line, struct end *end)
{
    int dof = *solid_mesh_member_dof(&solid->mesh, i, line);
    end->dof[0] = dof;
    end->dof[1] = dof + 1;
    end->one = 1;
    for (int c = 0; c < 2; c++)
        end->motion[c] = (struct motion){1, &end->dof[c], &end->one};
    if (dof < 0) {
        end->motion[0] = solid->line[line].v;
        end->motion[1] = solid->line[line].theta;
    }
}

static void add_between(const struct solid *solid, int i, int line, const double *e, const struct target *a)
{
    struct end ends[2];
    end_of(solid, i, line, &ends[0]);
    end_of(solid, i, line + 1, &ends[1]);
    for (int p = 0; p < 4 && a; p++)
        for (int q = 0; q <= p; q++)
            motion_add(a, (p == q ? 1 : 2) * e[p + 4 * q], &ends[p / 2].motion[p % 2], &ends[q / 2].motion[q % 2]);
}

/* The rods follow W at both ends, N cos^2 of them N/2, and what lies between them linearly. */
static void add_stretch(const struct solid *solid, int i, double stiffness, double inertia, const struct target *k,
                        const struct target *m)
{
    const struct motion *w = &solid->stretch[2 * (ptrdiff_t)i];
    for (int end = 0; end < 2; end++) {
        if (k && stiffness != 0)
            motion_add(k, stiffness, &w[end], &w[end]);
        if (m && inertia != 0)
            motion_add(m, inertia / 3, &w[end], &w[end]);
    }
    if (k && stiffness != 0)
        motion_add(k, -2 * stiffness, &w[0], &w[1]);
    if (m && inertia != 0)
        motion_add(m, inertia / 3, &w[0], &w[1]);
}

/* rho S and rho I of rods that follow the section, int rho S v^2 dz by Simpson's rule in each slice; their tension is in the
 * axial force of the section (rotor_axial_force), where it balances what they press with */
static void add_following(const struct solid *solid, const struct element *q, int from, int to, const struct target *m)
{
    for (int i = 3 * from; i < 3 * to; i++) {
        const struct solid_line *at = &solid->inside[i];
        double length = (solid->mesh.z[i / 3 + 1] - solid->mesh.z[i / 3]) * (i % 3 == 1 ? 4 : 1) / 6;
        if (m && q->rhos != 0)
            motion_add(m, q->rhos * length, &at->v, &at->v);
        if (m && q->rhoi != 0)
            motion_add(m, q->rhoi * length, &at->theta, &at->theta);
    }
}

/* Elements like `element` between the lines; d: NULL, or the derivative of K alone in this direction. */
static void add_chain(const struct solid *solid, struct element element, int i, const struct element *d, int from, int to,
                      const struct target *k, const struct target *m)
{
    double ek[16], em[16];
    for (int l = from; l < to; l++) {
        element.length = solid->mesh.z[l + 1] - solid->mesh.z[l];
        if (d)
            element_derivatives(&element, d, ek, em);
        else
            element_matrices(&element, ek, em);
        add_between(solid, i, l, ek, k);
        add_between(solid, i, l, em, d ? NULL : m);
    }
}

/* In torsion and along the axis: bars between the sections at their ends, or masses at their centre. */
static void assemble_bundles(const struct solid *solid, int p, const struct target *k, const struct target *m)
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    int from, to;
    for (int i = 0; i < rotor->ntierod; i++) {
        solid_mesh_member(rotor, mesh, i, &from, &to);
        double length = mesh->z[to] - mesh->z[from];
        struct bar bar = p < 0 ? bundle_of_tierod(rotor, mesh->type, solid->elastic_only, i, length)
                               : bundle_of_tierod_by(rotor, mesh->type, solid->elastic_only, i, length, solid->parameter[p]);
        add_stretch(solid, i, bar.stiffness / length, bar.mass * length, k, m);
    }
    for (int i = 0; i < rotor->nbars && m && p < 0; i++) {
        const struct motion *at = &center_of(solid, i)->v;
        motion_add(m, bundle_of_bars(rotor, mesh->type, i), at, at);
    }
}

void members_assemble(const struct solid *solid, int p, const struct target *k, const struct target *m)
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    if (mesh->type != MODE_BENDING) {
        assemble_bundles(solid, p, k, m);
        return;
    }
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        struct member member = member_of(solid, i);
        struct element d;
        double rate = 1;
        int from, to;
        if (p >= 0 && !direction_of(solid, &member, i, solid->parameter[p], &d, &rate))
            continue;
        solid_mesh_member(rotor, mesh, i, &from, &to);
        if (p < 0)
            d = element_of(solid, &member, 1);
        if (solid_mesh_follows(rotor, i))
            add_following(solid, &d, from, to, m);
        else
            add_chain(solid, element_of(solid, &member, 1), i, p < 0 ? NULL : &d, from, to, k, m);
        double area = member.section.stiff_area, length = mesh->z[to] - mesh->z[from];
        if (i < rotor->ntierod)
            add_stretch(solid, i, rate * member.material->e * member.young * area / 2 / length,
                        p < 0 ? member.material->rho * area * length / 2 : 0, k, m);
        else if (p < 0 && m) /* bars follow the rotation of the section at their centre axially */
            motion_add(m, member.material->rho * member.pitch * length, &center_of(solid, i - rotor->ntierod)->theta,
                       &center_of(solid, i - rotor->ntierod)->theta);
    }
}

void members_gyroscopic(const struct solid *solid, const struct target *p)
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        struct member member = member_of(solid, i);
        int from, to;
        solid_mesh_member(rotor, mesh, i, &from, &to);
        struct element turning = element_of(solid, &member, 1);
        turning.rhos = turning.force = 0;
        turning.rhoi *= 2;
        if (solid_mesh_follows(rotor, i))
            add_following(solid, &turning, from, to, p);
        else
            add_chain(solid, turning, i, NULL, from, to, NULL, p);
        double length = mesh->z[to] - mesh->z[from];
        if (i < rotor->ntierod) {
            add_stretch(solid, i, 0, member.material->rho * member.section.stiff_area * length, NULL, p);
        } else {
            const struct motion *theta = &center_of(solid, i - rotor->ntierod)->theta;
            motion_add(p, 2 * member.material->rho * member.pitch * length, theta, theta);
        }
    }
}

void members_moments(const struct solid *solid, double moment[3])
{
    const struct rotor *rotor = &solid->rotor;
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        struct member member = member_of(solid, i);
        int from, to;
        solid_mesh_member(rotor, &solid->mesh, i, &from, &to);
        double a = solid->mesh.z[from], b = solid->mesh.z[to], length = b - a,
               mass = member.material->rho * member.section.mass_area * length;
        moment[0] += mass;
        moment[1] += mass * (a + b) / 2;
        moment[2] += mass * ((a + b) * (a + b) / 4 + length * length / 12) +
                     member.material->rho * (member.section.mass_inertia + member.pitch) * length;
    }
}

double members_mesh_error(const struct solid *solid, const double *u, double lambda)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double sum = 0;
    for (int i = 0; i < solid->rotor.ntierod + solid->rotor.nbars && mesh->type == MODE_BENDING; i++) {
        struct member member = member_of(solid, i);
        struct element element = element_of(solid, &member, 1);
        int from, to;
        solid_mesh_member(&solid->rotor, mesh, i, &from, &to);
        for (int l = from; l < to && !solid_mesh_follows(&solid->rotor, i); l++) {
            double ek[16], em[16], q[4], share = 0;
            struct end ends[2];
            element.length = mesh->z[l + 1] - mesh->z[l];
            element_matrices(&element, ek, em);
            for (int p = 0; p < 4; p++) {
                end_of(solid, i, l + p / 2, &ends[p / 2]);
                q[p] = motion_value(&ends[p / 2].motion[p % 2], u);
            }
            for (int p = 0; p < 4; p++)
                for (int r = 0; r < 4; r++)
                    share += q[p] * em[p + 4 * r] * q[r];
            double l2 = element.length * element.length;
            sum += share * lambda * element.rhos * l2 * (l2 / (1440 * element.ei) + 1 / (24 * element.kgs));
        }
    }
    return sum;
}

double members_deflection_at(const struct solid *solid, int i, const double *u, double z)
{
    const struct solid_mesh *mesh = &solid->mesh;
    int from, to, l = solid_mesh_slice(mesh, z);
    solid_mesh_member(&solid->rotor, mesh, i, &from, &to);
    l = l < from ? from : l < to ? l : to - 1;
    struct end a, b;
    end_of(solid, i, l, &a);
    end_of(solid, i, l + 1, &b);
    double h = mesh->z[l + 1] - mesh->z[l], s = (z - mesh->z[l]) / h;
    return (1 + s * s * (2 * s - 3)) * motion_value(&a.motion[0], u) - h * s * (1 - s) * (1 - s) * motion_value(&a.motion[1], u) +
           s * s * (3 - 2 * s) * motion_value(&b.motion[0], u) + h * s * s * (1 - s) * motion_value(&b.motion[1], u);
}

void members_deflection(const struct solid *solid, int i, const double *u, int npoint, double *z, double *v)
{
    const struct solid_mesh *mesh = &solid->mesh;
    int from, to;
    solid_mesh_member(&solid->rotor, mesh, i, &from, &to);
    const struct motion *ends = i < solid->rotor.ntierod ? &solid->stretch[2 * (ptrdiff_t)i] : NULL,
                        *center = ends ? NULL : &center_of(solid, i - solid->rotor.ntierod)->v;
    for (int p = 0; p < npoint; p++) {
        double x = (double)p / (npoint - 1);
        z[p] = mesh->z[from] + (mesh->z[to] - mesh->z[from]) * x;
        if (mesh->type == MODE_BENDING)
            v[p] = members_deflection_at(solid, i, u, z[p]);
        else
            v[p] = ends ? (1 - x) * motion_value(&ends[0], u) + x * motion_value(&ends[1], u) : motion_value(center, u);
    }
}
