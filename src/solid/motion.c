#include "linalg/linalg.h"
#include "solid/solid.h"

static const double place[3] = {-0.77459666924148337704, 0, 0.77459666924148337704};
static const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

#define COVER 0.1 /* of the largest E of a section */

static int motion_new(struct pool *pool, int most, struct motion *motion)
{
    *motion = (struct motion){0, POOL_ARRAY(pool, int, most), POOL_ARRAY(pool, double, most)};
    return motion->dof && motion->weight ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static void add_term(struct motion *motion, int dof, double w)
{
    if (dof < 0 || w == 0)
        return;
    for (int i = 0; i < motion->count; i++)
        if (motion->dof[i] == dof) {
            motion->weight[i] += w;
            return;
        }
    motion->dof[motion->count] = dof;
    motion->weight[motion->count++] = w;
}

static void divide(struct motion *motion, double by)
{
    for (int i = 0; i < motion->count; i++)
        motion->weight[i] /= by;
}

/* +1, or -1 for V on the axis */
static double sign_of(const struct solid_node *node, int component)
{
    return component == 1 && node->r == 0 ? -1 : 1;
}

/* The shape functions of the edge from node n to n + 2 of a line at x: r, dr/dx and n [3] */
static void edge_at(const struct solid_mesh *mesh, int n, double x, double *r, double *slope, double *shape)
{
    const struct solid_node *node = &mesh->node[n];
    shape[0] = x * (x - 1) / 2;
    shape[1] = 1 - x * x;
    shape[2] = x * (x + 1) / 2;
    *r = shape[0] * node[0].r + shape[1] * node[1].r + shape[2] * node[2].r;
    *slope = (x - 0.5) * node[0].r - 2 * x * node[1].r + (x + 0.5) * node[2].r;
}

/* Whether what is held at a line holds on to the edge from node n to n + 2 of that line, in the section on either side: a cover
 * of a softer material gives way. */
static int carries(const struct rotor *rotor, const struct solid_mesh *mesh, int line, int n)
{
    int any = 0;
    for (int slice = line > 0 ? line - 1 : 0; slice <= line && slice < mesh->nslice; slice++) {
        double own = 0, most = 0;
        for (int i = mesh->first[slice]; i < mesh->first[slice + 1]; i++) {
            const struct solid_element *element = &mesh->element[i];
            double e = rotor->group[element->group].material.e;
            most = fmax(most, e);
            own = element->node[slice < line ? 3 : 0] == n ? fmax(own, e) : own;
        }
        any |= own > 0 && own >= COVER * most;
    }
    return any;
}

/* In torsion V = r_i A_i at node i: the rotation V/r is that of A = 1 where all A_i are 1, though the axis has no unknown. */
int motion_of_section(struct pool *pool, const struct rotor *rotor, const struct solid_mesh *mesh, int line, struct motion *v,
                      struct motion *theta)
{
    const int *nodes = mesh->line + 2 * (ptrdiff_t)line;
    int first = nodes[0], end = nodes[1];
    double area = 0, inertia = 0, r, slope, shape[3];
    int status = motion_new(pool, 2 * (end - first), v);
    if (!status)
        status = motion_new(pool, end - first, theta);
    for (int n = first; n + 2 < end && !status; n += 2)
        for (int g = 0, points = carries(rotor, mesh, line, n) ? 3 : 0; g < points; g++) {
            edge_at(mesh, n, place[g], &r, &slope, shape);
            double w = weight[g] * slope * r;
            area += w;
            inertia += w * r * r;
            for (int i = 0; i < 3; i++) {
                const struct solid_node *node = &mesh->node[n + i];
                if (mesh->type != MODE_BENDING) {
                    add_term(v, node->dof[mesh->type], w * shape[i] * (mesh->type == MODE_TORSION ? r * node->r : 1));
                    continue;
                }
                add_term(v, node->dof[0], w * shape[i] / 2);
                add_term(v, node->dof[1], -sign_of(node, 1) * w * shape[i] / 2);
                add_term(theta, node->dof[2], w * r * shape[i]);
            }
        }
    if (status)
        return status;
    divide(v, mesh->type == MODE_TORSION ? inertia : area);
    divide(theta, inertia);
    return ROTID_OK;
}

/* U of node 5 (V/r, W) of an element whose sensor has taken that degree of freedom: (sensor - n1 U1 - n2 U2)/n5 */
static void add_surface_term(const struct solid_mesh *mesh, const struct solid_element *element, int node, int component,
                             double w, struct motion *motion)
{
    const double *at = element->at_sensor;
    if (component == (int)mesh->type && node == 5 && element->sensor >= 0) {
        add_term(motion, mesh->node[element->node[5]].dof[component], w / at[1]);
        add_term(motion, mesh->node[element->node[1]].dof[component], -w * at[0] / at[1]);
        add_term(motion, mesh->node[element->node[2]].dof[component], -w * at[2] / at[1]);
        return;
    }
    const struct solid_node *own = &mesh->node[element->node[node]];
    add_term(motion, own->dof[component], w);
}

/* Shape functions of an element and dr/dx at y = -1, 0 or 1, of the nodes there alone, or the band would be twice as wide: linear
 * half-way. Returns r. */
static double across_element(const struct solid_mesh *mesh, const struct solid_element *element, double x, int y, double *n,
                             double *slope)
{
    double by_x[SOLID_NODES] = {0}, by_y[SOLID_NODES], r = 0;
    shape_of_element(x, y, n, by_x, by_y);
    for (int i = 0; i < SOLID_NODES && !y; i++) {
        int side = i == 5 ? 1 : i == 7 ? -1 : 0;
        n[i] = side ? (1 + side * x) / 2 : 0;
        by_x[i] = side / 2.0;
    }
    *slope = 0;
    for (int i = 0; i < SOLID_NODES; i++) {
        r += n[i] * mesh->node[element->node[i]].r;
        *slope += by_x[i] * mesh->node[element->node[i]].r;
    }
    return r;
}

int motion_in_slice(struct pool *pool, const struct rotor *rotor, const struct solid_mesh *mesh, int slice, int y,
                    struct motion *v, struct motion *theta)
{
    int first = mesh->first[slice], end = mesh->first[slice + 1], most = SOLID_NODES * (end - first);
    double stiffest = 0, area = 0, inertia = 0;
    int status = motion_new(pool, 2 * most, v);
    if (!status)
        status = motion_new(pool, most, theta);
    for (int e = first; e < end; e++)
        stiffest = fmax(stiffest, rotor->group[mesh->element[e].group].material.e);
    for (int e = first; e < end && !status; e++) {
        const struct solid_element *element = &mesh->element[e];
        int points = rotor->group[element->group].material.e >= COVER * stiffest ? 3 : 0;
        for (int g = 0; g < points; g++) {
            double n[SOLID_NODES], slope, r = across_element(mesh, element, place[g], y, n, &slope), w = weight[g] * slope * r;
            area += w;
            inertia += w * r * r;
            for (int i = 0; i < SOLID_NODES; i++) {
                const struct solid_node *node = &mesh->node[element->node[i]];
                add_surface_term(mesh, element, i, 0, w * n[i] / 2, v);
                add_term(v, node->dof[1], -sign_of(node, 1) * w * n[i] / 2);
                add_term(theta, node->dof[2], w * r * n[i]);
            }
        }
    }
    if (status)
        return status;
    divide(v, area);
    divide(theta, inertia);
    return ROTID_OK;
}

int motion_axial(struct pool *pool, const struct solid_mesh *mesh, int line, double pitch, double reach, struct motion *w)
{
    const int *nodes = mesh->line + 2 * (ptrdiff_t)line;
    int first = nodes[0], end = nodes[1], status = motion_new(pool, end - first, w);
    double inertia = 0;
    int bends = mesh->type == MODE_BENDING;
    for (int n = first; n + 2 < end && !status; n += 2) {
        const double edge[3] = {mesh->node[n].r, mesh->node[n + 1].r, mesh->node[n + 2].r};
        double low = fmax(pitch - reach, edge[0]), high = fmin(pitch + reach, edge[2]), shape[3];
        for (int g = 0; g < 3 && low < high; g++) {
            double r = (low + high) / 2 + (high - low) / 2 * place[g], share = weight[g] * (high - low) * r * (bends ? r : 1);
            shape_of_edge(edge, r, shape, NULL);
            inertia += share * (bends ? r : 1);
            for (int i = 0; i < 3; i++)
                add_term(w, mesh->node[n + i].dof[bends ? 2 : mesh->type],
                         share * shape[i] * (mesh->type == MODE_TORSION ? mesh->node[n + i].r / r : 1));
        }
    }
    for (int i = 0; i < w->count && !status; i++)
        w->weight[i] *= (bends ? pitch : 1) / inertia;
    return status ? status : inertia > 0 ? ROTID_OK : ROTID_ERROR_SECTION;
}

void motion_of_surface(const struct solid_mesh *mesh, double z, int component, int by_place, int *dof, double *w,
                       struct motion *motion)
{
    static const int edge[3] = {1, 5, 2};
    const struct solid_element *element = &mesh->element[solid_mesh_outermost(mesh, solid_mesh_slice(mesh, z))];
    double at[3], n[3], slope[3];
    *motion = (struct motion){0, dof, w};
    for (int i = 0; i < 3; i++)
        at[i] = mesh->node[element->node[edge[i]]].z;
    z = fmin(fmax(z, at[0]), at[2]);
    shape_of_edge(at, z, n, slope);
    for (int i = 0; i < 3; i++)
        add_surface_term(mesh, element, edge[i], component, by_place ? slope[i] : n[i], motion);
}

double motion_value(const struct motion *motion, const double *u)
{
    double sum = 0;
    for (int i = 0; i < motion->count; i++)
        sum += motion->weight[i] * u[motion->dof[i]];
    return sum;
}

/* row [count] := V't */
static void along_basis(const struct target *target, const struct motion *t, double *row)
{
    for (int j = 0; j < target->count; j++)
        row[j] = motion_value(t, target->v + j * target->n);
}

void motion_add(const struct target *target, double value, const struct motion *x, const struct motion *y)
{
    rotid_matrix *a = target->a;
    double of_x[BASIS_MOST], of_y[BASIS_MOST];
    if (target->count) {
        along_basis(target, x, of_x);
        along_basis(target, y, of_y);
        for (int j = 0; j < target->count; j++)
            for (int i = j; i < target->count; i++)
                a->band[i - j + (ptrdiff_t)j * (a->kd + 1)] += value * (of_x[i] * of_y[j] + of_x[j] * of_y[i]) / 2;
        return;
    }
    for (int i = 0; i < x->count; i++)
        for (int j = 0; j < y->count; j++) {
            double w = value * x->weight[i] * y->weight[j];
            matrix_add(a, x->dof[i], y->dof[j], x->dof[i] == y->dof[j] ? w : w / 2);
        }
}
