#include "beam/beam.h"

#define NEAR 0.01 /* of an element: a node this close stands for the position */

struct builder {
    int count;
    double *z;
    int *segment; /* of the element that begins at the node */
};

static void lay_segments(const struct rotor *rotor, struct builder *b)
{
    double z = 0;
    b->count = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *segment = &rotor->segment[s];
        for (int e = 0; e < segment->elements; e++) {
            b->z[b->count] = z + segment->length * e / segment->elements;
            b->segment[b->count++] = s;
        }
        z += segment->length;
    }
    b->z[b->count] = z;
    b->segment[b->count++] = rotor->nsegment - 1;
}

/* index of the last node at or before z */
static int node_before(int count, const double *node, double z)
{
    int low = 0, high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (node[middle] <= z)
            low = middle;
        else
            high = middle;
    }
    return node[high] <= z ? high : low;
}

static void insert(const struct rotor *rotor, struct builder *b, double z)
{
    int i = node_before(b->count, b->z, z);
    const struct segment *segment = &rotor->segment[b->segment[i]];
    double reach = NEAR * segment->length / segment->elements;
    if (i == b->count - 1 || z - b->z[i] <= reach || b->z[i + 1] - z <= reach)
        return;
    size_t behind = (size_t)(b->count - i - 1);
    memmove(b->z + i + 2, b->z + i + 1, behind * sizeof *b->z);
    memmove(b->segment + i + 2, b->segment + i + 1, behind * sizeof *b->segment);
    b->z[i + 1] = z;
    b->segment[i + 1] = b->segment[i];
    b->count++;
}

/* What asks for a node at z. */
struct place {
    double z, from_middle;
    int is_sensor;
};

/* What acts on the rotor before what only looks at it, so that no sensor moves a disk; from the middle outwards, so that a rotor
 * that is turned end to end, or whose cards stand in another order, has the same nodes. */
static int compare_places(const void *left, const void *right)
{
    const struct place *a = left, *b = right;
    int farther = (a->from_middle > b->from_middle) - (a->from_middle < b->from_middle);
    return a->is_sensor != b->is_sensor ? a->is_sensor - b->is_sensor : farther ? farther : (a->z > b->z) - (a->z < b->z);
}

static void add_place(struct place *place, int *count, double z, double middle, int is_sensor)
{
    place[(*count)++] = (struct place){z, fabs(z - middle), is_sensor};
}

static int gather_places(const struct rotor *rotor, double middle, struct place *place)
{
    int count = 0;
    for (int i = 0; i < rotor->nsensor; i++)
        add_place(place, &count, rotor->sensor[i].position, middle, 1);
    for (int i = 0; i < rotor->nspring; i++)
        add_place(place, &count, rotor->spring[i].position, middle, 0);
    for (int i = 0; i < rotor->ndisk; i++) {
        double from, to;
        add_place(place, &count, rotor->disk[i].position, middle, 0);
        if (rotor->disk[i].hub_length > 0) {
            rotor_hub_span(rotor, i, &from, &to);
            add_place(place, &count, from, middle, 0);
            add_place(place, &count, to, middle, 0);
        }
    }
    for (int i = 0; i < rotor->nbars; i++)
        add_place(place, &count, rotor->bars[i].center, middle, 0);
    for (int i = 0; i < rotor->ntierod; i++) {
        add_place(place, &count, rotor->tierod[i].from, middle, 0);
        add_place(place, &count, rotor->tierod[i].to, middle, 0);
    }
    qsort(place, (size_t)count, sizeof *place, compare_places);
    return count;
}

static void refine_axis(const struct builder *b, int refine, struct mesh *mesh)
{
    mesh->nelement = (b->count - 1) * refine;
    mesh->naxis = mesh->nelement + 1;
    for (int e = 0; e < b->count - 1; e++)
        for (int part = 0; part < refine; part++) {
            mesh->z[e * refine + part] = b->z[e] + (b->z[e + 1] - b->z[e]) * part / refine;
            mesh->segment[e * refine + part] = b->segment[e];
        }
    mesh->z[mesh->nelement] = b->z[b->count - 1];
}

int mesh_node_at(const struct mesh *mesh, double z)
{
    int i = node_before(mesh->naxis, mesh->z, z);
    return i + 1 < mesh->naxis && mesh->z[i + 1] - z < z - mesh->z[i] ? i + 1 : i;
}

double mesh_middle(const struct mesh *mesh, int e)
{
    return (mesh->z[e] + mesh->z[e + 1]) / 2;
}

static void add_far_node(struct mesh *mesh, int node)
{
    mesh->far[mesh->nfar++] = 2 * node;
    mesh->far[mesh->nfar++] = 2 * node + 1;
}

/* gives the chain its inner nodes; where a member leaves the band its nodes are far */
static void number_chain(struct mesh *mesh, struct chain *chain, int first_end, int last_end, int elements)
{
    *chain = (struct chain){first_end, last_end, mesh->nnode, last_end < 0 ? elements : elements - 1};
    mesh->nnode += chain->count;
    add_far_node(mesh, first_end);
    if (chain->count)
        add_far_node(mesh, chain->inner);
    if (last_end >= 0) {
        add_far_node(mesh, last_end);
        if (chain->count > 1)
            add_far_node(mesh, chain->inner + chain->count - 1);
    }
}

static void sort_far(struct mesh *mesh)
{
    int unique = 0;
    sort_ints((size_t)mesh->nfar, mesh->far);
    for (int i = 0; i < mesh->nfar; i++)
        if (!unique || mesh->far[unique - 1] != mesh->far[i])
            mesh->far[unique++] = mesh->far[i];
    mesh->nfar = unique;
}

static void place_members(const struct rotor *rotor, int refine, struct mesh *mesh)
{
    mesh->nnode = mesh->naxis;
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct tierod *rod = &rotor->tierod[i];
        number_chain(mesh, &mesh->tierod[i], mesh_node_at(mesh, rod->from), mesh_node_at(mesh, rod->to),
                     rod->elements == 1 ? 1 : rod->elements * refine); /* a single element is the model, not a mesh */
    }
    for (int i = 0; i < rotor->nbars; i++) {
        const struct bars *bars = &rotor->bars[i];
        int center = mesh_node_at(mesh, bars->center), half = bars->elements / 2 * refine;
        number_chain(mesh, &mesh->bars[2 * (ptrdiff_t)i], center, -1, half);
        number_chain(mesh, &mesh->bars[2 * (ptrdiff_t)i + 1], center, -1, half);
    }
    sort_far(mesh);
    for (int i = 0; i < rotor->nspring; i++)
        mesh->spring_node[i] = mesh_node_at(mesh, rotor->spring[i].position);
    for (int i = 0; i < rotor->ndisk; i++)
        mesh->disk_node[i] = mesh_node_at(mesh, rotor->disk[i].position);
    for (int i = 0; i < rotor->nsensor; i++)
        mesh->sensor_node[i] = mesh_node_at(mesh, rotor->sensor[i].position);
    mesh->end_node = mesh->naxis - 1;
    mesh->ndof = 2 * mesh->nnode;
    mesh->kd = 3;
}

int mesh_build(struct pool *pool, const struct rotor *rotor, int refine, struct mesh *mesh)
{
    int base = 1 + (int)rotor_elements(rotor),
        extra = rotor->nsensor + rotor->nspring + 3 * rotor->ndisk + rotor->nbars + 2 * rotor->ntierod;
    int most = (base + extra) * refine + 1, far = 8 * (rotor->ntierod + 2 * rotor->nbars);
    *mesh = (struct mesh){0};
    struct builder b = {0, POOL_ARRAY(pool, double, base + extra), POOL_ARRAY(pool, int, base + extra)};
    struct place *place = POOL_ARRAY(pool, struct place, extra);
    mesh->z = POOL_ARRAY(pool, double, most);
    mesh->segment = POOL_ARRAY(pool, int, most);
    mesh->far = POOL_ARRAY(pool, int, far);
    mesh->tierod = POOL_ARRAY(pool, struct chain, rotor->ntierod);
    mesh->bars = POOL_ARRAY(pool, struct chain, 2 * rotor->nbars);
    mesh->spring_node = POOL_ARRAY(pool, int, rotor->nspring);
    mesh->disk_node = POOL_ARRAY(pool, int, rotor->ndisk);
    mesh->sensor_node = POOL_ARRAY(pool, int, rotor->nsensor);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    lay_segments(rotor, &b);
    for (int i = 0, count = gather_places(rotor, b.z[b.count - 1] / 2, place); i < count; i++)
        insert(rotor, &b, place[i].z);
    refine_axis(&b, refine, mesh);
    place_members(rotor, refine, mesh);
    return ROTID_OK;
}

int chain_elements(const struct chain *chain)
{
    return chain->count + (chain->last_end >= 0);
}

int chain_node(const struct chain *chain, int i)
{
    if (i == 0)
        return chain->first_end;
    return i <= chain->count ? chain->inner + i - 1 : chain->last_end;
}
