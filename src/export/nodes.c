#include "export/nodes.h"

#include <math.h>

static void place_chain(const struct mesh *mesh, const struct chain *chain, double end, const char *member,
                        struct export_node *node)
{
    double from = mesh->z[chain->first_end];
    for (int i = 1; i <= chain->count; i++)
        node[chain_node(chain, i)] =
            (struct export_node){.r = NAN, .z = from + (end - from) * i / chain_elements(chain), .member = member};
}

static int beam_nodes(struct pool *pool, struct export_model *model)
{
    const struct beam *beam = &model->discrete->discrete.beam;
    const struct mesh *mesh = &beam->mesh;
    const struct rotor *rotor = &beam->rotor;
    struct export_node *node = POOL_ARRAY(pool, struct export_node, mesh->nnode);
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < mesh->naxis; i++)
        node[i] = (struct export_node){.r = NAN, .z = mesh->z[i], .member = "axis"};
    for (int s = 0; s < rotor->nsensor; s++)
        node[mesh->sensor_node[s]].sensor = rotor->sensor[s].id;
    for (int t = 0; t < rotor->ntierod; t++)
        place_chain(mesh, &mesh->tierod[t], mesh->z[mesh->tierod[t].last_end], rotor->tierod[t].name, node);
    for (int b = 0; b < 2 * rotor->nbars; b++) {
        const struct chain *half = &mesh->bars[b];
        double reach = rotor->bars[b / 2].length / 2;
        place_chain(mesh, half, mesh->z[half->first_end] + (b % 2 ? reach : -reach), rotor->bars[b / 2].name, node);
    }
    for (int i = 0; i < mesh->nnode; i++) {
        node[i].row[0] = 2 * i + 1;
        node[i].row[1] = 2 * i + 2;
    }
    model->node = node;
    model->nnode = mesh->nnode;
    return ROTID_OK;
}

static int solid_nodes(struct pool *pool, struct export_model *model)
{
    const struct solid_mesh *mesh = &model->discrete->discrete.solid.mesh;
    const struct rotor *rotor = model->discrete->rotor;
    int members = rotor->ntierod + rotor->nbars, count = mesh->nnode;
    for (int i = 0; i < members; i++)
        for (int l = 0; l <= mesh->nslice; l++)
            count += *solid_mesh_member_dof(mesh, i, l) >= 0;
    struct export_node *node = model->node = POOL_ARRAY(pool, struct export_node, count);
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < mesh->nnode; i++) {
        const struct solid_node *from = &mesh->node[i];
        node[i] = (struct export_node){.r = from->r, .z = from->z, .member = "section"};
        for (int c = 0; c < 3; c++)
            node[i].row[c] = from->dof[c] + 1;
        for (int s = 0; s < rotor->nsensor; s++)
            if (mesh->sensor_dof[s] == from->dof[0])
                node[i].sensor = rotor->sensor[s].id;
    }
    model->nnode = mesh->nnode;
    for (int i = 0; i < members; i++)
        for (int l = 0; l <= mesh->nslice; l++) {
            int v = *solid_mesh_member_dof(mesh, i, l);
            const char *name = i < rotor->ntierod ? rotor->tierod[i].name : rotor->bars[i - rotor->ntierod].name;
            if (v >= 0)
                node[model->nnode++] =
                    (struct export_node){.r = NAN, .z = mesh->z[l], .member = name, .row = {v + 1, 0, 0, v + 2}};
        }
    return ROTID_OK;
}

int export_nodes(struct pool *pool, struct export_model *model)
{
    model->is_solid = model->discrete->discrete.as == AS_SOLID;
    return model->is_solid ? solid_nodes(pool, model) : beam_nodes(pool, model);
}
