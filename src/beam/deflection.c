#include "beam/beam.h"
#include "linalg/linalg.h"

/* Deflection at s in [0, 1] of the chain. Its elements run to the left where sign is -1: their rotation turns with them. */
static double along_chain(const struct chain *chain, const struct element *element, double sign, const double *u, double s)
{
    struct lumped_shape n;
    int count = chain_elements(chain), e = (int)(s * count);
    e = e < count ? e : count - 1;
    const double *first = u + 2 * (ptrdiff_t)chain_node(chain, e), *second = u + 2 * (ptrdiff_t)chain_node(chain, e + 1);
    lumped_shapes(element, s * count - e, &n, NULL, NULL);
    return n.v[0] * first[0] + n.v[1] * sign * first[1] + n.v[2] * second[0] + n.v[3] * sign * second[1];
}

void tierod_deflection(const struct beam *beam, int tierod, const double *u, int npoint, double *z, double *v)
{
    const struct chain *chain = &beam->mesh.tierod[tierod];
    double from = beam->mesh.z[chain->first_end], to = beam->mesh.z[chain->last_end];
    struct element element;
    struct stretch stretch;
    tierod_quantities(beam, tierod, (to - from) / chain_elements(chain), &element, &stretch);
    for (int i = 0; i < npoint; i++) {
        double s = (double)i / (npoint - 1);
        z[i] = from + (to - from) * s;
        v[i] = along_chain(chain, &element, 1, u, s);
    }
}

void bars_deflection(const struct beam *beam, int bars, const double *u, int npoint, double *z, double *v)
{
    const struct chain *half = &beam->mesh.bars[2 * (ptrdiff_t)bars]; /* left, then right: both from the centre outwards */
    double center = beam->mesh.z[half->first_end], reach = beam->rotor.bars[bars].length / 2, inertia;
    struct element element;
    bars_quantities(beam, bars, reach / chain_elements(half), &element, &inertia);
    for (int i = 0; i < npoint; i++) {
        double s = 2.0 * i / (npoint - 1) - 1;
        z[i] = center + reach * s;
        v[i] = s < 0 ? along_chain(half, &element, -1, u, -s) : along_chain(half + 1, &element, 1, u, s);
    }
}

/* v and theta of a node at xi of an element between two nodes; sign: of along_chain */
static void between(const struct element *element, double sign, const double *first, const double *second, double xi,
                    double *node)
{
    struct lumped_shape n;
    const double end[4] = {first[0], sign * first[1], second[0], sign * second[1]};
    lumped_shapes(element, xi, &n, NULL, NULL);
    node[0] = node[1] = 0;
    for (int i = 0; i < 4; i++) {
        node[0] += n.v[i] * end[i];
        node[1] += sign * n.theta[i] * end[i];
    }
}

static void prolong_chain(const struct chain *chain, const struct element *element, double sign, const double *u,
                          const struct chain *fine, double *fine_u)
{
    int count = chain_elements(chain), parts = chain_elements(fine) / count;
    for (int i = 1; i <= fine->count; i++) {
        int e = i / parts < count ? i / parts : count - 1;
        between(element, sign, u + 2 * (ptrdiff_t)chain_node(chain, e), u + 2 * (ptrdiff_t)chain_node(chain, e + 1),
                (double)(i - e * parts) / parts, fine_u + 2 * (ptrdiff_t)chain_node(fine, i));
    }
}

void beam_prolong(const struct beam *beam, const double *u, const struct mesh *fine, double *fine_u)
{
    const struct mesh *mesh = &beam->mesh;
    int parts = fine->nelement / mesh->nelement;
    struct element element;
    struct stretch stretch;
    double inertia;
    for (int e = 0; e < mesh->nelement; e++) {
        axis_quantities(beam, e, &element);
        for (int i = 0; i <= parts; i++)
            between(&element, 1, u + 2 * (ptrdiff_t)e, u + 2 * (ptrdiff_t)(e + 1), (double)i / parts,
                    fine_u + 2 * ((ptrdiff_t)e * parts + i));
    }
    for (int i = 0; i < beam->rotor.ntierod; i++) {
        const struct chain *chain = &mesh->tierod[i];
        if (!chain_elements(chain))
            continue;
        tierod_quantities(beam, i, (mesh->z[chain->last_end] - mesh->z[chain->first_end]) / chain_elements(chain), &element,
                          &stretch);
        prolong_chain(chain, &element, 1, u, &fine->tierod[i], fine_u);
    }
    for (int i = 0; i < 2 * beam->rotor.nbars; i++) {
        const struct chain *half = &mesh->bars[i];
        if (!chain_elements(half))
            continue;
        bars_quantities(beam, i / 2, beam->rotor.bars[i / 2].length / 2 / chain_elements(half), &element, &inertia);
        prolong_chain(half, &element, i % 2 ? 1 : -1, u, &fine->bars[i], fine_u);
    }
}

/* What turns with a beam: polar inertia. And a stiffness that is spread over a group. Both are mass matrices of other quantities,
 * condensed at hinges like those. */

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
        if (lumped.element == e)
            lumped_add(beam, &lumped, &element, stiffness, mass);
    }
    hinge_condense(beam, e, stiffness, own);
    beam_add_between(a, e, e + 1, own);
}

static void add_chain(const struct chain *chain, struct element element, rotid_matrix *a)
{
    double k[16], m[16];
    element.rhos = 0;
    element.rhoi *= 2;
    element_matrices(&element, k, m);
    for (int i = 0; i < chain_elements(chain); i++)
        beam_add_between(a, chain_node(chain, i), chain_node(chain, i + 1), m);
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
        beam_add_between(a, chain_node(chain, i), chain_node(chain, i + 1), m);
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
        double middle = mesh_middle(&beam->mesh, e);
        if (middle > from && middle < to)
            add_axis(beam, e, stiffness / (to - from), s);
    }
}
