#include "beam/lumped.h"

#include <math.h>
#include <string.h>

#include "beam/hinge.h"
#include "rotor/effects.h"

/* With theta = gamma - v' and the constant shear angle gamma = -6 EI/kGS c3 of v = c0 + ... + c3 z^3, both shapes are
 * (A + phi B)/(1 + phi). */
static void numerators(double x, double l, double a[8], double b[8])
{
    double bubble = x * (1 - x);
    const double bending[8] = {1 + x * x * (2 * x - 3), -l * x * (1 - x) * (1 - x), x * x * (3 - 2 * x), l * x * x * (1 - x),
                               6 * bubble / l,          1 + x * (3 * x - 4),        -6 * bubble / l,     x * (3 * x - 2)};
    const double shear[8] = {1 - x, -l * bubble / 2, x, l * bubble / 2, 0, 1 - x, 0, x};
    memcpy(a, bending, sizeof bending);
    memcpy(b, shear, sizeof shear);
}

static void numerators_by_xi(double x, double l, double a[8], double b[8])
{
    double slope = 1 - 2 * x;
    const double bending[8] = {6 * x * (x - 1), -l * (1 + x * (3 * x - 4)),
                               6 * x * (1 - x), l * x * (2 - 3 * x),
                               6 * slope / l,   6 * x - 4,
                               -6 * slope / l,  6 * x - 2};
    const double shear[8] = {-1, -l * slope / 2, 1, l * slope / 2, 0, -1, 0, 1};
    memcpy(a, bending, sizeof bending);
    memcpy(b, shear, sizeof shear);
}

static double shear_factor(const struct element *element)
{
    return 12 * element->ei / (element->kgs * element->length * element->length);
}

static void combine(const double *a, const double *b, double phi, struct lumped_shape *n)
{
    for (int i = 0; i < 4; i++) {
        n->v[i] = (a[i] + phi * b[i]) / (1 + phi);
        n->theta[i] = (a[i + 4] + phi * b[i + 4]) / (1 + phi);
    }
}

void lumped_shapes(const struct element *element, double xi, struct lumped_shape *n, struct lumped_shape *by_xi,
                   struct lumped_shape *by_phi)
{
    double phi = shear_factor(element), a[8], b[8];
    numerators(xi, element->length, a, b);
    combine(a, b, phi, n);
    for (int i = 0; i < 4 && by_phi; i++) {
        by_phi->v[i] = (b[i] - n->v[i]) / (1 + phi);
        by_phi->theta[i] = (b[i + 4] - n->theta[i]) / (1 + phi);
    }
    if (by_xi) {
        numerators_by_xi(xi, element->length, a, b);
        combine(a, b, phi, by_xi);
    }
}

/* m += s (x y' + y x')/2 */
static void add_product(double s, const double *x, const double *y, double *m)
{
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            m[i + 4 * j] += s / 2 * (x[i] * y[j] + y[i] * x[j]);
}

/* A node belongs to the element on its right, but for the last one and for one with a hinge there. */
static int element_of(const struct beam *beam, double z)
{
    const struct mesh *mesh = &beam->mesh;
    int node = mesh_node_at(mesh, z), e = z < mesh->z[node] || node == mesh->end_node ? node - 1 : node;
    return e > 0 && z == mesh->z[e] && hinge_at(beam, e, 0) ? e - 1 : e;
}

static int found(const struct beam *beam, struct lumped *lumped)
{
    struct effect_point *point = &lumped->point;
    double end = beam->mesh.z[beam->mesh.end_node];
    lumped->clamped = point->z < 0 || point->z > end;
    point->z = fmin(fmax(point->z, 0), end);
    lumped->element = element_of(beam, point->z);
    return 1;
}

int lumped_next(const struct beam *beam, struct lumped *lumped)
{
    const struct rotor *rotor = &beam->rotor;
    for (lumped->i++; lumped->effect < rotor->neffect; lumped->effect++, lumped->i = 0) {
        const struct effect *effect = &rotor->effect[lumped->effect];
        lumped->point = (struct effect_point){.z = 0};
        if (effect->kind->point && effect->kind->point(effect, rotor, lumped->i, -1, &lumped->point))
            return found(beam, lumped);
    }
    while (lumped->spring < rotor->nspring) {
        int i = lumped->spring++;
        if (!effects_move_spring(rotor, i))
            continue;
        effects_on_spring(rotor, i, &lumped->point);
        lumped->point.z += beam->mesh.z[beam->mesh.spring_node[i]] - rotor->spring[i].position; /* which may be a little beside */
        return found(beam, lumped);
    }
    return 0;
}

static int is_spring(const struct beam *beam, const struct lumped *lumped)
{
    return lumped->effect >= beam->rotor.neffect;
}

const char *lumped_name(const struct beam *beam, const struct lumped *lumped)
{
    const struct rotor *rotor = &beam->rotor;
    return is_spring(beam, lumped) ? rotor->spring[lumped->spring - 1].name : rotor->effect[lumped->effect].name;
}

static double place_in(const struct mesh *mesh, const struct lumped *lumped)
{
    int e = lumped->element;
    return (lumped->point.z - mesh->z[e]) / (mesh->z[e + 1] - mesh->z[e]);
}

void lumped_add(const struct beam *beam, const struct lumped *lumped, const struct element *element, double *k, double *m)
{
    const struct effect_point *point = &lumped->point;
    struct lumped_shape n;
    lumped_shapes(element, place_in(&beam->mesh, lumped), &n, NULL, NULL);
    add_product(point->mass, n.v, n.v, m);
    add_product(point->inertia, n.theta, n.theta, m);
    if (beam->elastic_only)
        return;
    add_product(point->lateral, n.v, n.v, k);
    add_product(point->rotational, n.theta, n.theta, k);
}

static int rate_of(const struct beam *beam, struct parameter parameter, const struct lumped *lumped, struct effect_point *d)
{
    const struct rotor *rotor = &beam->rotor;
    if (is_spring(beam, lumped))
        return effects_spring_derivative(rotor, parameter, lumped->spring - 1, d);
    const struct effect *effect = &rotor->effect[lumped->effect];
    return parameter.kind == PARAMETER_EFFECT && parameter.index == lumped->effect &&
           effect->kind->point(effect, rotor, lumped->i, parameter.component, d);
}

int lumped_differentiate(const struct beam *beam, struct parameter parameter, const struct lumped *lumped,
                         const struct element *element, const struct element *d, double *dk, double *dm)
{
    const struct effect_point *point = &lumped->point;
    double dphi = shear_factor(element) * (d->ei / element->ei - d->kgs / element->kgs);
    struct effect_point dpoint = {.z = 0};
    struct lumped_shape n, by_xi, by_phi;
    int own = rate_of(beam, parameter, lumped, &dpoint);
    if (!own && dphi == 0)
        return 0;
    double dxi = lumped->clamped ? 0 : dpoint.z / element->length;
    lumped_shapes(element, place_in(&beam->mesh, lumped), &n, &by_xi, &by_phi);
    for (int j = 0; j < 4; j++) {
        by_xi.v[j] = by_xi.v[j] * dxi + by_phi.v[j] * dphi;
        by_xi.theta[j] = by_xi.theta[j] * dxi + by_phi.theta[j] * dphi;
    }
    add_product(dpoint.mass, n.v, n.v, dm);
    add_product(dpoint.inertia, n.theta, n.theta, dm);
    add_product(2 * point->mass, n.v, by_xi.v, dm);
    add_product(2 * point->inertia, n.theta, by_xi.theta, dm);
    add_product(dpoint.lateral, n.v, n.v, dk);
    add_product(dpoint.rotational, n.theta, n.theta, dk);
    add_product(2 * point->lateral, n.v, by_xi.v, dk);
    add_product(2 * point->rotational, n.theta, by_xi.theta, dk);
    return 1;
}
