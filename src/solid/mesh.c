#include "solid/solid.h"

#define AT_LINE  0.011 /* of a slice, from a line: a sensor is taken to be there, as in outline_lines, with some room */
#define UNKNOWNS 9     /* of three nodes that an element has of its own */
#define BAND                                                                                                                     \
    15 /* of five nodes: the band for each element of a slice, whose outer lines have two nodes each, the half-way line one */
#define QUARTER 0.25 /* of its length from the corner: r^(1/2), the strains of a crack */

struct grid {              /* nodes by line 0 ... 2 nslice and place 0 ... 2 nr, even ones at the ends of elements */
    int nr, places, *node; /* nr: elements from the axis to the surface */
    double *r;
};

static int *at(const struct grid *grid, int line, int place)
{
    return &grid->node[(ptrdiff_t)line * grid->places + place];
}

/* line and place of the eight nodes from those of the first */
static const int along[SOLID_NODES] = {0, 0, 2, 2, 0, 1, 2, 1}, outwards[SOLID_NODES] = {0, 2, 2, 0, 1, 2, 1, 0};

/* *widest: the largest number of elements of a slice */
static int count_elements(const struct rotor *rotor, const struct solid_mesh *mesh, const struct grid *grid, int *widest)
{
    int count = 0;
    *widest = 0;
    for (int i = 0; i < mesh->nslice; i++) {
        int before = count;
        for (int j = 0; j < grid->nr; j++)
            count += outline_group(rotor, mesh->segment[i], (grid->r[j] + grid->r[j + 1]) / 2) >= 0;
        *widest = count - before > *widest ? count - before : *widest;
    }
    return count;
}

static int is_corner(const struct rotor *rotor, const struct solid_mesh *mesh, int line, double r)
{
    int left = line > 0 ? mesh->segment[line - 1] : -1, right = line < mesh->nslice ? mesh->segment[line] : -1;
    return left >= 0 && right >= 0 && left != right && outline_corner(rotor, left, r);
}

/* The half-way node between places a and b of which one may be a corner. */
static double half_way(double a, double b, int corner_a, int corner_b)
{
    double share = corner_a == corner_b ? 0.5 : corner_a ? QUARTER : 1 - QUARTER;
    return a + share * (b - a);
}

static void place_nodes(const struct rotor *rotor, const struct solid_rule *rule, const struct grid *grid, int j,
                        const struct solid_element *element, struct solid_mesh *mesh)
{
    double z[2] = {mesh->z[element->slice], mesh->z[element->slice + 1]}, r[2] = {grid->r[j], grid->r[j + 1]};
    int corner[2][2];
    for (int l = 0; l < 2; l++)
        for (int o = 0; o < 2; o++)
            corner[l][o] = !rule->straight && is_corner(rotor, mesh, element->slice + l, r[o]);
    for (int a = 0; a < SOLID_NODES; a++) {
        struct solid_node *node = &mesh->node[element->node[a]];
        int l = along[a], o = outwards[a];
        node->z = l == 1 ? half_way(z[0], z[1], corner[0][o / 2], corner[1][o / 2]) : z[l / 2];
        node->r = o == 1 ? half_way(r[0], r[1], corner[l / 2][0], corner[l / 2][1]) : r[o / 2];
    }
}

static int lay_elements(struct pool *pool, const struct rotor *rotor, const struct grid *grid, struct solid_mesh *mesh,
                        int *failed)
{
    int widest;
    mesh->nelement = count_elements(rotor, mesh, grid, &widest);
    mesh->element = POOL_ARRAY(pool, struct solid_element, mesh->nelement);
    mesh->first = POOL_ARRAY(pool, int, mesh->nslice + 1);
    if (!mesh->element || !mesh->first)
        return ROTID_ERROR_MEMORY;
    struct solid_element *element = mesh->element;
    for (int i = 0; i < mesh->nslice; i++) {
        mesh->first[i] = (int)(element - mesh->element);
        for (int j = 0; j < grid->nr; j++) {
            int s = mesh->segment[i], group = outline_group(rotor, s, (grid->r[j] + grid->r[j + 1]) / 2);
            if (group < 0)
                continue;
            double share = outline_share(rotor, group, (grid->r[j] + grid->r[j + 1]) / 2);
            *element = (struct solid_element){.slice = i, .segment = s, .group = group, .share = share, .sensor = -1};
            *failed = group;
            if (share <= 0)
                return ROTID_ERROR_SECTION;
            for (int a = 0; a < SOLID_NODES; a++) {
                element->node[a] = 2 * j + outwards[a]; /* its place, until nodes have numbers */
                *at(grid, 2 * i + along[a], 2 * j + outwards[a]) = 1;
            }
            element++;
        }
    }
    mesh->first[mesh->nslice] = mesh->nelement;
    return ROTID_OK;
}

static int number_nodes(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, const struct grid *grid,
                        struct solid_mesh *mesh)
{
    int lines = 2 * mesh->nslice + 1;
    mesh->line = POOL_ARRAY(pool, int, lines + 1);
    mesh->surface = POOL_ARRAY(pool, int, lines);
    mesh->surface_z = POOL_ARRAY(pool, double, lines);
    if (!mesh->line || !mesh->surface || !mesh->surface_z)
        return ROTID_ERROR_MEMORY;
    for (int l = 0; l < lines; l++) {
        mesh->line[l] = mesh->nnode;
        for (int p = 0; p < grid->places; p++)
            if (*at(grid, l, p)) {
                mesh->surface[l] = mesh->nnode;
                *at(grid, l, p) = mesh->nnode++;
            }
    }
    mesh->line[lines] = mesh->nnode;
    mesh->node = POOL_ARRAY(pool, struct solid_node, mesh->nnode);
    if (!mesh->node)
        return ROTID_ERROR_MEMORY;
    for (int e = 0; e < mesh->nelement; e++) {
        struct solid_element *element = &mesh->element[e];
        int j = element->node[0] / 2;
        for (int a = 0; a < SOLID_NODES; a++)
            element->node[a] = *at(grid, 2 * element->slice + along[a], element->node[a]);
        place_nodes(rotor, rule, grid, j, element, mesh);
    }
    for (int l = 0; l < lines; l++)
        mesh->surface_z[l] = mesh->node[mesh->surface[l]].z;
    return ROTID_OK;
}

void solid_mesh_member(const struct rotor *rotor, const struct solid_mesh *mesh, int i, int *from, int *to)
{
    const struct bars *bars = i < rotor->ntierod ? NULL : &rotor->bars[i - rotor->ntierod];
    *from = solid_mesh_line(mesh, bars ? bars->center - bars->length / 2 : rotor->tierod[i].from);
    *to = solid_mesh_line(mesh, bars ? bars->center + bars->length / 2 : rotor->tierod[i].to);
}

int solid_mesh_follows(const struct rotor *rotor, int i)
{
    return i < rotor->ntierod && rotor->tierod[i].elements == 1;
}

/* whether v and theta of a member on this line are those of the rotor there */
static int is_tied(const struct rotor *rotor, const struct solid_mesh *mesh, int i, int line, int from, int to)
{
    if (i < rotor->ntierod)
        return line == from || line == to || solid_mesh_follows(rotor, i);
    return line == solid_mesh_line(mesh, rotor->bars[i - rotor->ntierod].center);
}

/* After how many nodes of its line a member's degrees of freedom are numbered. Where a member is tied all nodes of a line meet
 * it; numbered before the nodes right of a tie and behind them left of one, they stay within the band. */
static int nodes_before_member(const struct rotor *rotor, const struct solid_mesh *mesh, int i, int line, int from, int to)
{
    const int *of = mesh->line + 2 * (ptrdiff_t)line;
    int nodes = of[1] - of[0];
    if (i < rotor->ntierod)
        return (int)((double)nodes * (line - from) / (to - from));
    return line < solid_mesh_line(mesh, rotor->bars[i - rotor->ntierod].center) ? nodes : 0;
}

static void number_members(const struct rotor *rotor, struct solid_mesh *mesh, int line, int nodes, int *next)
{
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        int from, to;
        solid_mesh_member(rotor, mesh, i, &from, &to);
        if (line < from || line > to || is_tied(rotor, mesh, i, line, from, to) ||
            nodes_before_member(rotor, mesh, i, line, from, to) != nodes)
            continue;
        *solid_mesh_member_dof(mesh, i, line) = *next;
        *next += 2;
    }
}

static void widen(struct solid_mesh *mesh, int low, int high)
{
    mesh->kd = high - low > mesh->kd ? high - low : mesh->kd;
}

/* *low and *high: to the first and last degree of freedom of a node, where it has any */
static void reach_node(const struct solid_node *node, int *low, int *high)
{
    for (int c = 0; c < 3; c++)
        if (node->dof[c] >= 0) {
            *low = node->dof[c] < *low ? node->dof[c] : *low;
            *high = node->dof[c] > *high ? node->dof[c] : *high;
        }
}

/* of the nodes of a line */
static void line_dofs(const struct solid_mesh *mesh, int line, int *low, int *high)
{
    const int *of = mesh->line + 2 * (ptrdiff_t)line;
    *low = mesh->ndof;
    *high = 0;
    for (int n = of[0]; n < of[1]; n++)
        reach_node(&mesh->node[n], low, high);
}

static void find_band(const struct rotor *rotor, struct solid_mesh *mesh)
{
    int low, high;
    mesh->kd = 0;
    for (int e = 0; e < mesh->nelement; e++) {
        low = mesh->ndof;
        high = 0;
        for (int a = 0; a < SOLID_NODES; a++)
            reach_node(&mesh->node[mesh->element[e].node[a]], &low, &high);
        widen(mesh, low, high);
    }
    for (int l = 0; l <= mesh->nslice; l++) {
        line_dofs(mesh, l, &low, &high);
        widen(mesh, low, high);
    }
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        int from, to;
        solid_mesh_member(rotor, mesh, i, &from, &to);
        for (int l = from; l < to && !solid_mesh_follows(rotor, i); l++) {
            int left = *solid_mesh_member_dof(mesh, i, l), right = *solid_mesh_member_dof(mesh, i, l + 1);
            if (left < 0)
                line_dofs(mesh, l, &left, &high);
            if (right < 0)
                line_dofs(mesh, l + 1, &low, &right);
            else
                right++;
            widen(mesh, left, right);
        }
    }
}

/* Whether component c of a node is an unknown of its own. */
static int is_unknown(const struct solid_mesh *mesh, const struct solid_node *node, int c)
{
    if (mesh->type == MODE_BENDING)
        return c == 0 || node->r > 0;
    return mesh->type == MODE_TORSION ? c == 1 && node->r > 0 : c == 2 || (c == 0 && node->r > 0);
}

static int number_dofs(struct pool *pool, const struct rotor *rotor, struct solid_mesh *mesh)
{
    int lines = mesh->nslice + 1, members = rotor->ntierod + rotor->nbars, next = 0;
    mesh->member_dof = POOL_ARRAY(pool, int, members *lines);
    if (!mesh->member_dof)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < members * lines; i++)
        mesh->member_dof[i] = -1;
    for (int l = 0; l < 2 * lines - 1; l++) {
        int nodes = mesh->line[l + 1] - mesh->line[l];
        for (int n = 0; n <= nodes; n++) {
            if (l % 2 == 0 && mesh->type == MODE_BENDING)
                number_members(rotor, mesh, l / 2, n, &next);
            if (n == nodes)
                break;
            struct solid_node *node = &mesh->node[mesh->line[l] + n];
            for (int c = 0; c < 3; c++)
                node->dof[c] = is_unknown(mesh, node, c) ? next++ : mesh->type == MODE_BENDING && c == 1 ? node->dof[0] : -1;
        }
    }
    mesh->ndof = next;
    find_band(rotor, mesh);
    return ROTID_OK;
}

int *solid_mesh_member_dof(const struct solid_mesh *mesh, int member, int line)
{
    return &mesh->member_dof[(ptrdiff_t)member * (mesh->nslice + 1) + line];
}

/* A sensor between the lines of its slice takes over U of the node half-way along the outer edge, which no other element has. */
static int place_sensors(struct pool *pool, const struct rotor *rotor, struct solid_mesh *mesh)
{
    mesh->sensor_dof = POOL_ARRAY(pool, int, rotor->nsensor);
    if (!mesh->sensor_dof)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsensor; s++) {
        double z = rotor->sensor[s].position;
        int line = solid_mesh_line(mesh, z), slice = solid_mesh_slice(mesh, z);
        struct solid_element *element = &mesh->element[solid_mesh_outermost(mesh, slice)];
        if (element->sensor >= 0 || fabs(mesh->z[line] - z) <= AT_LINE * (mesh->z[slice + 1] - mesh->z[slice])) {
            mesh->sensor_dof[s] = mesh->node[mesh->surface[2 * (ptrdiff_t)line]].dof[mesh->type];
            continue;
        }
        const double edge[3] = {mesh->node[element->node[1]].z, mesh->node[element->node[5]].z, mesh->node[element->node[2]].z};
        shape_of_edge(edge, z, element->at_sensor, NULL);
        element->sensor = s;
        mesh->sensor_dof[s] = mesh->node[element->node[5]].dof[mesh->type];
        mesh->surface_z[2 * slice + 1] = z;
    }
    return ROTID_OK;
}

/* The lines of the mesh, of which slices, z and segment are set */
static int lay_lines(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine,
                     struct solid_mesh *mesh, struct grid *grid)
{
    int nz, nr, status = outline_lines(pool, rotor, rule, refine, &nr, &grid->r, &nz, &mesh->z, &mesh->segment);
    if (status)
        return status;
    mesh->nslice = nz - 1;
    grid->nr = nr - 1;
    grid->places = 2 * nr - 1;
    return ROTID_OK;
}

/* ROTID_ERROR_SECTION where the mesh that is not refined costs more than SOLID_MOST_UNKNOWNS and SOLID_MOST_ENTRIES */
static int check_size(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule)
{
    struct solid_mesh mesh = {0};
    struct grid grid;
    int widest, status = lay_lines(pool, rotor, rule, 1, &mesh, &grid);
    if (status)
        return status;
    double unknowns = UNKNOWNS * (double)count_elements(rotor, &mesh, &grid, &widest);
    return unknowns > SOLID_MOST_UNKNOWNS || unknowns * BAND * widest > SOLID_MOST_ENTRIES ? ROTID_ERROR_SECTION : ROTID_OK;
}

int solid_mesh_build(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine,
                     struct solid_mesh *mesh, int *failed)
{
    struct grid grid;
    *mesh = (struct solid_mesh){.type = rule->type};
    for (int s = 0; s < rotor->nsegment; s++) {
        *failed = rotor->segment[s].group;
        if (rotor->segment[s].rectangular || (s > 0 && !outline_touch(rotor, s)))
            return ROTID_ERROR_SECTION;
    }
    *failed = rotor->ngroup + rotor->ntierod + rotor->nbars;
    if (outline_slenderness(rotor) > SOLID_MOST_SLENDER)
        return ROTID_ERROR_SECTION;
    int status = refine > 1 ? ROTID_OK : check_size(pool, rotor, rule); /* the coarse mesh is the way to that one */
    if (!status)
        status = lay_lines(pool, rotor, rule, refine, mesh, &grid);
    if (status)
        return status;
    grid.node = POOL_ARRAY(pool, int, (size_t)(2 * mesh->nslice + 1) * (size_t)grid.places);
    status = grid.node ? lay_elements(pool, rotor, &grid, mesh, failed) : ROTID_ERROR_MEMORY;
    if (!status)
        status = number_nodes(pool, rotor, rule, &grid, mesh);
    for (int i = 0; i < mesh->nslice && !status; i++) {
        struct solid_element *outer = &mesh->element[solid_mesh_outermost(mesh, i)];
        const struct segment *segment = &rotor->segment[outer->segment];
        if (segment->stiff_outer < segment->outer && outer->group == segment->group)
            outer->extra = PI / 4 * (segment->outer * segment->outer - segment->stiff_outer * segment->stiff_outer);
    }
    if (!status)
        status = number_dofs(pool, rotor, mesh);
    return status ? status : place_sensors(pool, rotor, mesh);
}

int solid_mesh_line(const struct solid_mesh *mesh, double z)
{
    int i = solid_mesh_slice(mesh, z);
    return mesh->z[i + 1] - z < z - mesh->z[i] ? i + 1 : i;
}

int solid_mesh_slice(const struct solid_mesh *mesh, double z)
{
    int low = 0, high = mesh->nslice;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (mesh->z[middle] <= z)
            low = middle;
        else
            high = middle;
    }
    return low;
}

int solid_mesh_outermost(const struct solid_mesh *mesh, int slice)
{
    return mesh->first[slice + 1] - 1;
}
