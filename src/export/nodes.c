#include "export/nodes.h"

static void place_chain(const struct mesh *mesh, const struct chain *chain, double end, const char *member,
                        struct export_node *node)
{
    double from = mesh->z[chain->first_end];
    for (int i = 1; i <= chain->count; i++)
        node[chain_node(chain, i)] = (struct export_node){from + (end - from) * i / chain_elements(chain), member, 0};
}

int export_nodes(struct pool *pool, struct export_model *model)
{
    const struct beam *beam = &model->discrete->discrete.beam;
    const struct mesh *mesh = &beam->mesh;
    const struct rotor *rotor = &beam->rotor;
    struct export_node *node = POOL_ARRAY(pool, struct export_node, mesh->nnode);
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < mesh->naxis; i++)
        node[i] = (struct export_node){mesh->z[i], "axis", 0};
    for (int s = 0; s < rotor->nsensor; s++)
        node[mesh->sensor_node[s]].sensor = rotor->sensor[s].id;
    for (int t = 0; t < rotor->ntierod; t++)
        place_chain(mesh, &mesh->tierod[t], mesh->z[mesh->tierod[t].last_end], rotor->tierod[t].name, node);
    for (int b = 0; b < 2 * rotor->nbars; b++) {
        const struct chain *half = &mesh->bars[b];
        double reach = rotor->bars[b / 2].length / 2;
        place_chain(mesh, half, mesh->z[half->first_end] + (b % 2 ? reach : -reach), rotor->bars[b / 2].name, node);
    }
    model->node = node;
    return ROTID_OK;
}
