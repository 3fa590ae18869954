#include "export/export.h"

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

/* Fills model->node, nnode and is_solid: where the nodes are. */
static int place_nodes(struct pool *pool, struct export_model *model)
{
    model->is_solid = model->discrete->discrete.as == AS_SOLID;
    return model->is_solid ? solid_nodes(pool, model) : beam_nodes(pool, model);
}

static int condense(struct pool *pool, struct export_model *model)
{
    const rotid_model *beam = &model->discrete->equations;
    struct export_condensed *c = &model->condensed;
    struct reduction reduction;
    c->count = beam->nmaster;
    c->kind = model->job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    if (c->count > EXPORT_MOST_CONDENSE) {
        c->impossible =
            pool_format(pool, "%d %s are too many to condense onto, at most %d are possible", c->count,
                        model->job->rotor.nsensor ? "sensors" : "nodes (the deck has no sensors)", EXPORT_MOST_CONDENSE);
        return c->impossible ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    int status = reduction_new(pool, c->kind, &model->k, c->count, beam->master, &reduction);
    if (!status)
        status = reduction_compute(&reduction, &model->k, &model->m);
    if (status == ROTID_ERROR_SLAVE || status == ROTID_ERROR_MASS) {
        c->impossible = pool_format(pool,
                                    "%d sensor%s too few to condense onto: the rotor can still move freely while %s, expected "
                                    "two or more",
                                    c->count, c->count == 1 ? " is" : "s are", c->count == 1 ? "it rests" : "they rest");
        return c->impossible ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    c->k = reduction.kc;
    c->m = reduction.mc;
    return status;
}

int export_model_open(struct pool *pool, const struct job *job, const struct identification *identified, const char *version,
                      int with_condensed, struct export_model *model)
{
    *model = (struct export_model){.job = job, .version = version, .identified = identified};
    int failed, highest = comparison_highest(job), nparameter = identified ? job->unknowns.nparameter : 0;
    const double *x = identified ? identified->fit->x : NULL;
    model->discrete = POOL_NEW(pool, struct rotor_model);
    if (!model->discrete)
        return ROTID_ERROR_MEMORY;
    struct rotor_model *discrete = model->discrete;
    int status = model_open(pool, job->models, &job->rotor, nparameter, job->unknowns.parameter, 1, discrete, &failed);
    rotid_matrix structure;
    if (!status) {
        discrete_structure(&discrete->discrete, &structure);
        status = matrix_like(pool, &structure, &model->k);
    }
    if (!status)
        status = matrix_like(pool, &structure, &model->m);
    if (!status)
        status = spectrum_compute(pool, job->models, &job->rotor, nparameter, job->unknowns.parameter, x,
                                  job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN,
                                  highest > EXPORT_MODES ? highest : EXPORT_MODES, &model->spectrum);
    if (!status)
        status = place_nodes(pool, model);
    if (status)
        return status;
    discrete_assemble(&discrete->discrete, x, &model->k, &model->m);
    discrete_mass_properties(&discrete->discrete, &model->mass);
    return with_condensed ? condense(pool, model) : ROTID_OK;
}

int export_master_id(const struct export_model *model, int i)
{
    const struct rotor *rotor = &model->job->rotor;
    if (rotor->nsensor)
        return rotor->sensor[i].id;
    return model->is_solid ? model->discrete->discrete.solid.mesh.surface[i] + 1 : model->discrete->master[i] / 2 + 1;
}

/* the first row beyond the last one that can have an entry in the column: in the band, then far ones */
static int row_after(const rotid_matrix *a, int row, int column)
{
    int next = row < column ? column : row + 1, end = column + a->kd;
    if (next <= end && next < a->n)
        return next;
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] >= next && a->far[f] > end)
            return a->far[f];
    return a->n;
}

static double entry(const rotid_matrix *a, int row, int column)
{
    if (row - column <= a->kd)
        return a->band[(row - column) + (ptrdiff_t)column * (a->kd + 1)];
    int i = matrix_far_position(a, row), j = matrix_far_position(a, column);
    return i < 0 || j < 0 ? 0 : a->block[i + (ptrdiff_t)j * a->nfar];
}

int triplet_next(const rotid_matrix *a, struct triplet *t)
{
    while (t->column < a->n) {
        t->row = row_after(a, t->row, t->column);
        if (t->row >= a->n) {
            t->column++;
            t->row = -1;
            continue;
        }
        t->value = entry(a, t->row, t->column);
        if (t->value != 0)
            return 1;
    }
    return 0;
}
