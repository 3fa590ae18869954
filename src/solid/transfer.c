#include "solid/solid.h"

/* The element of `mesh` at a place inside the rotor. */
static const struct solid_element *element_at(const struct solid_mesh *mesh, double z, double r)
{
    int slice = solid_mesh_slice(mesh, z), e = mesh->first[slice];
    while (e < solid_mesh_outermost(mesh, slice) && mesh->node[mesh->element[e].node[1]].r < r)
        e++;
    return &mesh->element[e];
}

/* U, V, W at a place of the element, in the motion `local` of its nodes */
static void motion_at(const struct solid_mesh *mesh, const struct solid_element *element, const double *local, double z, double r,
                      double *motion)
{
    const struct solid_node *low = &mesh->node[element->node[0]], *high = &mesh->node[element->node[2]];
    double n[SOLID_NODES], by_x[SOLID_NODES], by_y[SOLID_NODES];
    shape_of_element(2 * (r - low->r) / (high->r - low->r) - 1, 2 * (z - low->z) / (high->z - low->z) - 1, n, by_x, by_y);
    for (int c = 0; c < 3; c++) {
        motion[c] = 0;
        for (int a = 0; a < SOLID_NODES; a++)
            motion[c] += n[a] * local[3 * a + c];
    }
}

static void transfer_element(const struct solid *from, const double *u, const struct solid_mesh *mesh,
                             const struct solid_element *element, double *v)
{
    const struct solid_node *low = &mesh->node[element->node[0]], *high = &mesh->node[element->node[2]];
    const struct solid_element *around = element_at(&from->mesh, (low->z + high->z) / 2, (low->r + high->r) / 2);
    double local[SOLID_DOFS], motion[3];
    solid_element_motion(from, around, u, local);
    for (int a = 0; a < SOLID_NODES; a++) {
        const struct solid_node *node = &mesh->node[element->node[a]];
        motion_at(&from->mesh, around, local, node->z, node->r, motion);
        for (int c = 0; c < 3; c++)
            if (node->dof[c] >= 0 && !(c == 1 && node->r == 0)) /* V of the axis is that of U */
                v[node->dof[c]] = mesh->type == MODE_TORSION ? motion[c] / node->r : motion[c];
    }
}

void solid_transfer(const struct solid *from, const double *u, const struct solid *to, double *v)
{
    const struct solid_mesh *mesh = &to->mesh;
    double length = mesh->z[mesh->nslice], h = length / 1e4;
    memset(v, 0, (size_t)mesh->ndof * sizeof *v);
    for (int e = 0; e < mesh->nelement; e++)
        transfer_element(from, u, mesh, &mesh->element[e], v);
    for (int e = 0; e < mesh->nelement; e++) {
        const struct solid_element *element = &mesh->element[e];
        int type = mesh->type;
        double *at = &v[mesh->node[element->node[5]].dof[type]];
        if (element->sensor >= 0)
            *at = element->at_sensor[0] * v[mesh->node[element->node[1]].dof[type]] + element->at_sensor[1] * *at +
                  element->at_sensor[2] * v[mesh->node[element->node[2]].dof[type]];
    }
    for (int i = 0; i < to->rotor.ntierod + to->rotor.nbars; i++)
        for (int l = 0; l <= mesh->nslice; l++) {
            int dof = *solid_mesh_member_dof(mesh, i, l);
            if (dof < 0)
                continue;
            v[dof] = members_deflection_at(from, i, u, mesh->z[l]);
            v[dof + 1] =
                (members_deflection_at(from, i, u, mesh->z[l] - h) - members_deflection_at(from, i, u, mesh->z[l] + h)) / (2 * h);
        }
}
