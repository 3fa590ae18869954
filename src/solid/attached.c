#include "solid/attached.h"

#include <math.h>

#include "linalg/matrix.h"
#include "rotor/effects.h"
#include "solid/members.h"

static const struct solid_line *line_at(const struct solid *solid, double z)
{
    return &solid->line[solid_mesh_line(&solid->mesh, z)];
}

/* ---- springs and disks move with the section */

static int disk_of(const struct solid *solid, int i, int p, double *mass, double *inertia)
{
    const struct disk *disk = &solid->rotor.disk[i];
    *mass = disk->mass;
    *inertia = disk->diametral;
    if (p < 0)
        return 1;
    struct parameter parameter = solid->parameter[p];
    *mass = parameter.kind == PARAMETER_DISK_MASS;
    *inertia = parameter.kind == PARAMETER_DISK_INERTIA;
    return parameter.index == i && *mass + *inertia != 0;
}

static void add_to_section(rotid_matrix *a, const struct solid_line *line, double v, double theta)
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
                        rotid_matrix *k)
{
    motion_add(k, lateral, &line->v, &line->v);
    motion_add(k, -2 * lateral * dz - 2 * by_dz, &line->v, &line->theta);
    motion_add(k, lateral * dz * dz + 2 * by_dz * dz + rotational, &line->theta, &line->theta);
}

/* d: NULL, or the rate of the point; then the derivative */
static void add_ground(const struct solid *solid, const struct effect_point *point, const struct effect_point *d, rotid_matrix *k)
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

static void add_springs(const struct solid *solid, int p, rotid_matrix *k)
{
    const struct rotor *rotor = &solid->rotor;
    for (int i = 0; i < rotor->nspring; i++) {
        struct effect_point point, d;
        double line = solid->mesh.z[solid_mesh_line(&solid->mesh, rotor->spring[i].position)];
        if (p >= 0 && !effects_spring_derivative(rotor, solid->parameter[p], i, &d))
            continue;
        effects_on_spring(rotor, i, &point);
        point.z += line - rotor->spring[i].position; /* which may be a little beside */
        add_ground(solid, &point, p < 0 ? NULL : &d, k);
    }
}

/* ---- lumped masses sit on the surface as a ring: half of the mass in each of U, V and W. What inertia about a diameter a mass
 * has beyond that of a ring of the surface's radius acts on the slope W/R of the surface. */

int attached_next_point(const struct solid *solid, int *effect, int *i, struct effect_point *point)
{
    for (; *effect < solid->rotor.neffect; (*effect)++, *i = -1) {
        const struct effect *e = &solid->rotor.effect[*effect];
        if (e->kind->point && e->kind->point(e, &solid->rotor, ++*i, -1, point))
            return 1;
    }
    return 0;
}

/* d = 0: the mass; 1: its derivative by place; for every component of the motion of the surface */
static void add_ring(const struct solid *solid, double z, double mass, double inertia, double dz, rotid_matrix *m)
{
    const struct solid_mesh *mesh = &solid->mesh;
    int dof[2][SURFACE_MOST + 3];
    double w[2][SURFACE_MOST + 3], radius = mesh->node[mesh->surface[2 * solid_mesh_slice(mesh, z) + 1]].r;
    for (int c = 0; c < 3; c++) {
        struct motion at, slope;
        double half = mass / 2 + (c == 2 ? inertia / (radius * radius) : 0);
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
static void add_points(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m)
{
    struct effect_point point, d;
    struct parameter parameter = p < 0 ? (struct parameter){.index = 0} : solid->parameter[p];
    double length = solid->mesh.z[solid->mesh.nslice];
    if (p >= 0 && parameter.kind != PARAMETER_EFFECT)
        return;
    for (int effect = 0, i = -1; attached_next_point(solid, &effect, &i, &point);) {
        const struct effect *e = &solid->rotor.effect[effect];
        int rate = p >= 0 && parameter.index == effect && e->kind->point(e, &solid->rotor, i, parameter.component, &d);
        if (p >= 0 && !rate)
            continue;
        if (k && !solid->elastic_only &&
            (point.lateral != 0 || point.rotational != 0 || (rate && (d.lateral != 0 || d.rotational != 0))))
            add_ground(solid, &point, p < 0 ? NULL : &d, k);
        if (m && p < 0)
            add_ring(solid, point.z, point.mass, point.inertia, 0, m);
        if (m && rate && (d.mass != 0 || d.inertia != 0))
            add_ring(solid, point.z, d.mass, d.inertia, 0, m);
        if (m && rate && d.z != 0 && point.z > 0 && point.z < length)
            add_ring(solid, point.z, point.mass, point.inertia, d.z, m);
    }
}

void attached_assemble(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m)
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

void attached_moments(const struct solid *solid, double moment[3])
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    struct effect_point point;
    for (int i = 0; i < rotor->ndisk; i++) {
        double z = mesh->z[solid_mesh_line(mesh, rotor->disk[i].position)], mass = rotor->disk[i].mass;
        moment[0] += mass;
        moment[1] += mass * z;
        moment[2] += mass * z * z + rotor->disk[i].diametral;
    }
    for (int effect = 0, i = -1; attached_next_point(solid, &effect, &i, &point);) {
        double z = fmin(fmax(point.z, 0), mesh->z[mesh->nslice]),
               radius = mesh->node[mesh->surface[2 * solid_mesh_slice(mesh, z) + 1]].r;
        moment[0] += point.mass;
        moment[1] += point.mass * z;
        moment[2] += point.mass * (z * z + radius * radius / 2) + point.inertia;
    }
    members_moments(solid, moment);
}
