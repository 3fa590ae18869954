#include "beam/beam.h"

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
