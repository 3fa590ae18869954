#include "solid/solid.h"

#include <stdlib.h>
#include <string.h>

#include "linalg/matrix.h"
#include "solid/attached.h"
#include "solid/field.h"
#include "solid/outline.h"

#define WASHER 2 /* diameters of a rod: what its nut and washer press on */

static int compare_ints(const void *a, const void *b)
{
    int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

/* All sections, since a cause may put a spring anywhere, and the ends of tie rods. */
static int build_lines(struct pool *pool, struct solid *solid, int *failed)
{
    const struct rotor *rotor = &solid->rotor;
    int status = ROTID_OK, from, to;
    for (int l = 0; l <= solid->mesh.nslice && !status; l++)
        status = motion_of_section(pool, &solid->mesh, l, &solid->line[l].v, &solid->line[l].theta);
    for (int i = 0; i < rotor->ntierod && !status; i++) {
        *failed = rotor->ngroup + i;
        solid_mesh_member(rotor, &solid->mesh, i, &from, &to);
        double pitch = rotor->tierod[i].pitch, reach = WASHER / 2 * rotor->tierod[i].diameter;
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
    qsort(solid->far, (size_t)n, sizeof *solid->far, compare_ints);
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

const char *solid_refusal(const struct rotor *rotor, int failed)
{
    int rod = failed - rotor->ngroup, bars = rod - rotor->ntierod;
    if (bars >= rotor->nbars && outline_slenderness(rotor) > SOLID_MOST_SLENDER)
        return "the rotor is more than 1000 times as long as its largest diameter, which a solid loses in rounding, expected a "
               "thicker one, or *FIT, MODEL=BEAM";
    if (bars >= rotor->nbars)
        return "a solid of this rotor has too many unknowns, expected fewer steps of the diameter, or *FIT, MODEL=BEAM";
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

int solid_has_corners(const struct rotor *rotor)
{
    return outline_has_corners(rotor);
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
    if (!status)
        status = solid_mesh_build(pool, &solid->rotor, rule ? rule : &from_rotor, refine, &solid->mesh, failed);
    if (status)
        return status;
    solid->integrals = POOL_ARRAY(pool, struct integrals, solid->mesh.nelement);
    solid->line = POOL_ARRAY(pool, struct solid_line, solid->mesh.nslice + 1);
    solid->stretch = POOL_ARRAY(pool, struct motion, 2 * rotor->ntierod);
    if (!solid->integrals || !solid->line || !solid->stretch)
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

/* On the axis V = -U and W = 0; a sensor stands for U of node 5: U5 = (sensor - n1 U1 - n2 U2)/n5. The rows and columns of the
 * element follow, and those that are no unknowns are left out when it is added. */
static void tie_columns(const struct solid *solid, const struct solid_element *element, double *a, int stride, int step)
{
    for (int n = 0; n < SOLID_NODES; n++) {
        if (solid->mesh.node[element->node[n]].r != 0)
            continue;
        for (int i = 0; i < SOLID_DOFS; i++)
            a[3 * n * stride + i * step] -= a[(3 * n + 1) * stride + i * step];
    }
    if (element->sensor < 0)
        return;
    const double *at = element->at_sensor;
    for (int i = 0; i < SOLID_DOFS; i++) {
        double *middle = &a[15 * stride + i * step];
        *middle /= at[1];
        a[3 * stride + i * step] -= at[0] * *middle;
        a[6 * stride + i * step] -= at[2] * *middle;
    }
}

static void add_element(const struct solid *solid, const struct solid_element *element, double *e, rotid_matrix *a)
{
    int dof[SOLID_DOFS], stride = a->kd + 1;
    tie_columns(solid, element, e, SOLID_DOFS, 1);
    tie_columns(solid, element, e, 1, SOLID_DOFS);
    for (int i = 0; i < SOLID_DOFS; i++) {
        const struct solid_node *node = &solid->mesh.node[element->node[i / 3]];
        dof[i] = node->r == 0 && i % 3 ? -1 : node->dof[i % 3];
    }
    for (int j = 0; j < SOLID_DOFS; j++)
        for (int i = 0; i < SOLID_DOFS && dof[j] >= 0; i++)
            if (dof[i] >= dof[j])
                a->band[(dof[i] - dof[j]) + (ptrdiff_t)dof[j] * stride] += e[i + SOLID_DOFS * j];
}

static void spread_mass(const double *m, double *e)
{
    memset(e, 0, SOLID_DOFS * SOLID_DOFS * sizeof *e);
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++)
            for (int c = 0; c < 3; c++)
                e[3 * a + c + SOLID_DOFS * (3 * b + c)] = m[a + SOLID_NODES * b];
}

/* K and M of an element, or their derivatives; returns whether each is there at all */
static void element_matrices_of(const struct solid *solid, int index, int p, double *k, double *m, int *has_k, int *has_m)
{
    const struct solid_element *element = &solid->mesh.element[index];
    struct share share;
    double mass[SOLID_NODES * SOLID_NODES] = {0};
    memset(k, 0, SOLID_DOFS * SOLID_DOFS * sizeof *k);
    *has_k = *has_m = 0;
    for (int s = 0; s < SHARES; s++) {
        if (p < 0)
            field_of_share(solid, element, s, &share);
        else if (!field_derivative(solid, element, s, solid->parameter[p], &share))
            continue;
        if (share.elasticity.c33 != 0 || share.elasticity.c44 != 0 || share.stress != 0) {
            integrals_add_stiffness(&solid->integrals[index], s, &share.elasticity, share.stress, k);
            *has_k = 1;
        }
        if (share.rho != 0) {
            integrals_add_mass(&solid->integrals[index], s, share.rho, mass);
            *has_m = 1;
        }
    }
    if (*has_m)
        spread_mass(mass, m);
}

static void assemble(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m)
{
    double ek[SOLID_DOFS * SOLID_DOFS], em[SOLID_DOFS * SOLID_DOFS];
    int has_k, has_m;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        const struct solid_element *element = &solid->mesh.element[e];
        element_matrices_of(solid, e, p, ek, em, &has_k, &has_m);
        if (has_k)
            add_element(solid, element, ek, k);
        if (has_m)
            add_element(solid, element, em, m);
    }
    attached_assemble(solid, p, k, m);
}

void solid_assemble(struct solid *solid, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    solid_set(solid, x);
    assemble(solid, -1, k, m);
}

void solid_differentiate(const struct solid *solid, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    assemble(solid, p, dk, dm);
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
            field_of_share(solid, element, s, &share);
            integrals_add_mass(&solid->integrals[e], s, 2 * share.rho, mass);
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
    if (element->sensor >= 0)
        local[15] = (local[15] - element->at_sensor[0] * local[3] - element->at_sensor[2] * local[6]) / element->at_sensor[1];
}

void solid_rigid_motions(const struct solid *solid, double *u)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double *turn = u + mesh->ndof;
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
    int has_k, has_m;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        element_matrices_of(solid, e, -1, ek, em, &has_k, &has_m);
        solid_element_motion(solid, &solid->mesh.element[e], u, local);
        energy[e] = 0;
        for (int j = 0; j < SOLID_DOFS; j++)
            for (int i = 0; i < SOLID_DOFS; i++)
                energy[e] += 0.5 * local[i] * ek[i + SOLID_DOFS * j] * local[j];
    }
}
