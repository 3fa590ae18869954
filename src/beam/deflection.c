#include "beam/deflection.h"

#include "beam/lumped.h"
#include "beam/quantities.h"

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
