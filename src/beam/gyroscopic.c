/* What turns with a beam: polar inertia. And a stiffness that is spread over a group. Both are mass matrices of other quantities,
 * condensed at hinges like those. */
#include "beam/beam.h"
#include "linalg/linalg.h"

static void add_between(rotid_matrix *a, int first, int second, const double *e)
{
    const int dof[4] = {2 * first, 2 * first + 1, 2 * second, 2 * second + 1};
    matrix_add_element(a, 4, dof, e);
}

/* The inertia of element e without its translation, twice, or as much translation as is given. */
static void add_axis(const struct beam *beam, int e, double per_length, rotid_matrix *a)
{
    struct element element;
    double stiffness[16], own[16], mass[16], k[16];
    axis_quantities(beam, e, &element);
    element_matrices(&element, stiffness, mass);
    struct element other = element;
    other.rhos = per_length;
    other.rhoi = per_length > 0 ? 0 : 2 * element.rhoi;
    element_matrices(&other, k, own);
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);) {
        if (lumped.element != e)
            continue;
        lumped_add(beam, &lumped, &element, stiffness, mass);
        struct lumped turning = lumped;
        turning.point = (struct effect_point){.z = lumped.point.z, .inertia = 2 * lumped.point.inertia};
        if (!(per_length > 0))
            lumped_add(beam, &turning, &element, k, own);
    }
    hinge_condense(beam, e, stiffness, own);
    add_between(a, e, e + 1, own);
}

static void add_chain(const struct chain *chain, struct element element, rotid_matrix *a)
{
    double k[16], m[16];
    element.rhos = 0;
    element.rhoi *= 2;
    element_matrices(&element, k, m);
    for (int i = 0; i < chain_elements(chain); i++)
        add_between(a, chain_node(chain, i), chain_node(chain, i + 1), m);
}

/* As add_chain, of a chain that is drawn to the left: the sign of the rotation turns. */
static void add_left_chain(const struct chain *chain, struct element element, rotid_matrix *a)
{
    double k[16], m[16];
    element.rhos = 0;
    element.rhoi *= 2;
    element_matrices(&element, k, m);
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++)
            if ((r + c) % 2)
                m[r + 4 * c] = -m[r + 4 * c];
    for (int i = 0; i < chain_elements(chain); i++)
        add_between(a, chain_node(chain, i), chain_node(chain, i + 1), m);
}

void beam_gyroscopic(const struct beam *beam, rotid_matrix *p)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    struct element element;
    struct stretch stretch;
    double inertia;
    for (int e = 0; e < mesh->nelement; e++)
        add_axis(beam, e, 0, p);
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct chain *chain = &mesh->tierod[i];
        double length = (mesh->z[chain->last_end] - mesh->z[chain->first_end]) / chain_elements(chain);
        int first = 2 * chain->first_end + 1, last = 2 * chain->last_end + 1;
        tierod_quantities(beam, i, length, &element, &stretch);
        add_chain(chain, element, p);
        matrix_add(p, first, first, 2 * stretch.inertia / 3);
        matrix_add(p, last, last, 2 * stretch.inertia / 3);
        matrix_add(p, first, last, 2 * stretch.inertia / 6);
    }
    for (int i = 0; i < 2 * rotor->nbars; i++) {
        const struct chain *half = &mesh->bars[i];
        bars_quantities(beam, i / 2, rotor->bars[i / 2].length / 2 / chain_elements(half), &element, &inertia);
        if (i % 2)
            add_chain(half, element, p);
        else
            add_left_chain(half, element, p);
        matrix_add(p, 2 * half->first_end + 1, 2 * half->first_end + 1, inertia);
    }
    for (int i = 0; i < rotor->ndisk; i++)
        matrix_add(p, 2 * mesh->disk_node[i] + 1, 2 * mesh->disk_node[i] + 1, rotor->disk[i].polar);
}

void beam_spread(const struct beam *beam, int group, double stiffness, rotid_matrix *s)
{
    double from, to;
    rotor_group_span(&beam->rotor, group, &from, &to);
    for (int e = 0; e < beam->mesh.nelement; e++) {
        double middle = (beam->mesh.z[e] + beam->mesh.z[e + 1]) / 2;
        if (middle > from && middle < to)
            add_axis(beam, e, stiffness / (to - from), s);
    }
}
