#include "model/model.h"

#define CORNERS 4 /* of an element, whose first nodes they are: inner left, outer left, outer right, inner right */

static const struct solid *solid_of(const struct rotor_model *model)
{
    return model->discrete.as == AS_SOLID ? &model->discrete.solid : NULL;
}

static const struct solid_node *corner(const struct solid *solid, const struct solid_element *element, int c)
{
    return &solid->mesh.node[element->node[c]];
}

static int at_reentrant(const struct solid *solid, const struct solid_element *element)
{
    const struct rotor *rotor = &solid->rotor;
    int s = element->segment, n = solid->mesh.nslice, found = 0;
    for (int c = 0; c < CORNERS; c++) {
        int line = element->slice + (c > 1), left = line > 0 ? solid->mesh.segment[line - 1] : s;
        found |= line < n && solid->mesh.segment[line] != left && outline_corner(rotor, left, corner(solid, element, c)->r);
    }
    return found;
}

rotid_solid_mesh *meridian_size(struct pool *pool, const struct rotor_model *model)
{
    const struct solid *solid = solid_of(model);
    rotid_solid_mesh *size = solid ? POOL_NEW(pool, rotid_solid_mesh) : NULL;
    if (!size)
        return NULL;
    const struct solid_mesh *mesh = &solid->mesh;
    *size = (rotid_solid_mesh){.unknowns = mesh->ndof, .half_band = mesh->kd, .slices = mesh->nslice, .corner_m = NAN};
    for (int e = 0; e < mesh->nelement; e++) {
        const struct solid_element *element = &mesh->element[e];
        const struct solid_node *from = corner(solid, element, 0), *to = corner(solid, element, 2);
        double side = fmax(to->r - from->r, to->z - from->z);
        size->largest_m = fmax(size->largest_m, side);
        if (at_reentrant(solid, element))
            size->corner_m = fmax(size->corner_m, side); /* fmax leaves NaN out */
    }
    return size;
}

void meridian_count(const struct rotor_model *model, int *nodes, int *elements)
{
    const struct solid *solid = solid_of(model);
    if (!solid)
        return;
    *nodes = solid->mesh.nnode;
    *elements = solid->mesh.nelement;
}

/* index [nnode]: of the nodes that are corners, from 0 in their order; the others -1. Their number. */
static int number_corners(const struct solid *solid, int *index)
{
    int count = 0;
    for (int i = 0; i < solid->mesh.nnode; i++)
        index[i] = -1;
    for (int e = 0; e < solid->mesh.nelement; e++)
        for (int c = 0; c < CORNERS; c++)
            index[solid->mesh.element[e].node[c]] = 0;
    for (int i = 0; i < solid->mesh.nnode; i++)
        if (index[i] == 0)
            index[i] = count++;
    return count;
}

rotid_meridian *meridian_mesh(struct pool *pool, const struct rotor_model *model)
{
    const struct solid *solid = solid_of(model);
    int *index = solid ? POOL_ARRAY(pool, int, solid->mesh.nnode) : NULL;
    rotid_meridian *out = index ? POOL_NEW(pool, rotid_meridian) : NULL;
    if (!out)
        return NULL;
    const struct solid_mesh *mesh = &solid->mesh;
    int count = number_corners(solid, index);
    out->nr_m = POOL_LIST(pool, out->r_m, count);
    (void)POOL_LIST(pool, out->z_m, count);
    out->nelements = POOL_LIST(pool, out->elements, mesh->nelement);
    if (!out->r_m || !out->z_m || !out->elements)
        return NULL;
    for (int i = 0; i < mesh->nnode; i++)
        if (index[i] >= 0) {
            out->r_m[index[i]] = mesh->node[i].r;
            out->z_m[index[i]] = mesh->node[i].z;
        }
    for (int e = 0; e < mesh->nelement; e++) {
        out->elements[e].group = mesh->element[e].group;
        for (int c = 0; c < CORNERS; c++)
            out->elements[e].corner[c] = index[mesh->element[e].node[c]];
    }
    return out;
}

/* To the four significant digits that a drawing needs. */
static void shorten(int n, double scale, double *value)
{
    char text[32];
    for (int i = 0; i < n; i++) {
        (void)snprintf(text, sizeof text, "%.3e", scale * value[i]);
        value[i] = strtod(text, NULL);
    }
}

rotid_meridian_mode *meridian_mode(struct pool *pool, const struct rotor_model *model, const double *u)
{
    const struct solid *solid = solid_of(model);
    int *index = solid ? POOL_ARRAY(pool, int, solid->mesh.nnode) : NULL;
    rotid_meridian_mode *out = index ? POOL_NEW(pool, rotid_meridian_mode) : NULL;
    if (!out)
        return NULL;
    int count = number_corners(solid, index);
    double largest = 0, sum = 0;
    out->nu = POOL_LIST(pool, out->u, count);
    out->nw = POOL_LIST(pool, out->w, count);
    out->nenergy = POOL_LIST(pool, out->energy, solid->mesh.nelement);
    if (!out->u || !out->w || !out->energy)
        return NULL;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        double local[SOLID_DOFS], *motion = local;
        solid_element_motion(solid, &solid->mesh.element[e], u, local);
        for (int c = 0; c < CORNERS; c++, motion += 3) {
            int i = index[solid->mesh.element[e].node[c]];
            out->u[i] = motion[0];
            out->w[i] = motion[2];
            largest = fabs(out->u[i]) > fabs(largest) ? out->u[i] : largest;
        }
    }
    solid_strain_energy(solid, u, out->energy);
    for (int e = 0; e < out->nenergy; e++)
        sum += out->energy[e];
    shorten(count, largest != 0 ? 1 / largest : 1, out->u);
    shorten(count, largest != 0 ? 1 / largest : 1, out->w);
    shorten(out->nenergy, sum > 0 ? 1 / sum : 1, out->energy);
    return out;
}
