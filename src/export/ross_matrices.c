#include <math.h>
#include <string.h>

#include "beam/hinge.h"
#include "export/ross_model.h"

#define AT_NODE 1e-12 /* of the element */

int ross_mass_node(const struct beam *beam, const struct lumped *lumped)
{
    int e = lumped->element;
    double from = beam->mesh.z[e], to = beam->mesh.z[e + 1], near = AT_NODE * (to - from);
    if (hinge_in(beam, e) || lumped->point.lateral != 0 || lumped->point.rotational != 0)
        return -1;
    return lumped->point.z <= from + near ? e : lumped->point.z >= to - near ? e + 1 : -1;
}

/* theta to beta = dv/dz */
static void turn_signs(double *a)
{
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            if ((i + j) % 2)
                a[i + 4 * j] = -a[i + 4 * j];
}

/* The joints and masses of the element by name; NULL without memory. */
static const char *names_of(struct pool *pool, const struct beam *beam, int e)
{
    const char *names = "";
    for (int h = 0; h < beam->nhinge && names; h++)
        if (beam->hinge[h].element == e)
            names = pool_format(pool, "%s%sjoint %s", names, *names ? ", " : "", beam->rotor.effect[beam->hinge[h].effect].name);
    for (struct lumped lumped = {.i = -1}; names && lumped_next(beam, &lumped);)
        if (lumped.element == e && ross_mass_node(beam, &lumped) < 0)
            names = pool_format(pool, "%s%s%s %s", names, *names ? ", " : "",
                                lumped.point.lateral == 0 && lumped.point.rotational == 0 ? "mass" : "spring",
                                lumped_name(beam, &lumped) ? lumped_name(beam, &lumped) : "(without a name)");
    return names;
}

int ross_matrices(struct pool *pool, const struct beam *beam, int e, struct ross_matrices *matrices)
{
    struct element element, massless;
    double k[16];
    *matrices = (struct ross_matrices){.why = names_of(pool, beam, e)};
    if (!matrices->why || !*matrices->why)
        return matrices->why ? 0 : ROTID_ERROR_MEMORY;
    axis_quantities(beam, e, &element);
    element_matrices(&element, matrices->k, matrices->m);
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);)
        if (lumped.element == e && ross_mass_node(beam, &lumped) < 0) {
            lumped_add(beam, &lumped, &element, matrices->k, matrices->m);
            matrices->added += lumped.point.mass;
        }
    massless = element;
    massless.rhos = 0;
    element_matrices(&massless, k, matrices->rotary);
    memcpy(k, matrices->k, sizeof k); /* with the springs in it */
    if (hinge_in(beam, e)) {          /* the second time for the transformation of the rotary part alone */
        hinge_condense(beam, e, matrices->k, matrices->m);
        hinge_condense(beam, e, k, matrices->rotary);
    }
    turn_signs(matrices->k);
    turn_signs(matrices->m);
    turn_signs(matrices->rotary);
    return 1;
}
