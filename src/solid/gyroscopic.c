/* What turns with a solid of revolution, and a stiffness that is spread over a group. */
#include "linalg/linalg.h"
#include "solid/solid.h"

/* half on (U + V)^2 and on W^2 of the surface, twice: see add_ring of solid.c */
static void add_ring(const struct solid *solid, double z, double mass, const struct target *p)
{
    const struct solid_mesh *mesh = &solid->mesh;
    int dof[3][SURFACE_MOST];
    double weight[3][SURFACE_MOST];
    struct motion at[3];
    for (int c = 0; c < 3; c++)
        motion_of_surface(mesh, z, c, 0, dof[c], weight[c], &at[c]);
    motion_add(p, mass, &at[0], &at[0]);
    motion_add(p, 2 * mass, &at[0], &at[1]);
    motion_add(p, mass, &at[1], &at[1]);
    motion_add(p, mass, &at[2], &at[2]);
}

void solid_gyroscopic(const struct solid *solid, rotid_matrix *p)
{
    const struct rotor *rotor = &solid->rotor;
    const struct solid_mesh *mesh = &solid->mesh;
    const struct target target = {.a = p};
    struct effect_point point;
    for (int i = 0; i < mesh->nelement; i++) {
        double mass[SOLID_NODES * SOLID_NODES] = {0}, e[SOLID_DOFS * SOLID_DOFS] = {0};
        struct share share;
        for (int s = 0; s < SHARES; s++) {
            solid_field_of_share(solid, &mesh->element[i], s, &share);
            solid_add_mass(&solid->integrals[i], s, 2 * share.rho, mass);
        }
        for (int b = 0; b < SOLID_NODES; b++)
            for (int a = 0; a < SOLID_NODES; a++) {
                double *of_r = e + 3 * (a + (ptrdiff_t)SOLID_DOFS * b), *of_n = of_r + SOLID_DOFS, *of_z = of_n + SOLID_DOFS;
                of_r[0] = of_r[1] = of_n[0] = of_n[1] = of_z[2] = mass[a + SOLID_NODES * b];
            }
        solid_add_element(solid, &mesh->element[i], e, p);
    }
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct motion *theta = &solid->line[solid_mesh_line(mesh, rotor->disk[i].position)].theta;
        motion_add(&target, rotor->disk[i].polar, theta, theta);
    }
    for (int effect = 0, i = -1; rotor->neffect && solid_next_point(solid, &effect, &i, &point);)
        if (point.mass != 0)
            add_ring(solid, point.z, point.mass, &target);
    members_gyroscopic(solid, &target);
}

void solid_spread(const struct solid *solid, int group, double stiffness, rotid_matrix *s)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double from, to;
    rotor_group_span(&solid->rotor, group, &from, &to);
    for (int l = 0; l <= mesh->nslice; l++) {
        double left = fmax(l > 0 ? (mesh->z[l - 1] + mesh->z[l]) / 2 : 0, from),
               right = fmin(l < mesh->nslice ? (mesh->z[l] + mesh->z[l + 1]) / 2 : mesh->z[l], to);
        if (right > left)
            motion_add(&(struct target){.a = s}, stiffness * (right - left) / (to - from), &solid->line[l].v, &solid->line[l].v);
    }
}

void solid_spring_motion(const struct solid *solid, int i, double *v)
{
    const struct motion *at = &solid->line[solid_mesh_line(&solid->mesh, solid->rotor.spring[i].position)].v;
    for (int j = 0; j < at->count; j++)
        v[at->dof[j]] += at->weight[j];
}
