#include "beam/beam.h"

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

/* Flexibility of the point at xi between the clamped ends of the element, and its derivative in the direction d with the place
 * moving by dz: of both parts as cantilevers, F = A + B, it is (A^-1 + B^-1)^-1 = A F^-1 B, whose derivative is
 * P' dA P + Q' dB Q with P = F^-1 B and Q = F^-1 A. A part without length has none. */
struct pair { /* [v, theta] symmetric */
    double vv, vt, tt;
};

struct part { /* of the element, from its clamped end to the point; side -1: the end is on the left */
    double length, dlength, side;
};

static struct pair tip(const struct element *e, const struct part *part)
{
    double c = part->length;
    return (struct pair){c * c * c / 3 / e->ei + c / e->kgs, part->side * c * c / 2 / e->ei, c / e->ei};
}

static struct pair tip_rate(const struct element *e, const struct element *d, const struct part *part)
{
    double c = part->length, dc = part->dlength, ei = d->ei / e->ei / e->ei, kgs = d->kgs / e->kgs / e->kgs;
    return (struct pair){(c * c / e->ei + 1 / e->kgs) * dc - c * c * c / 3 * ei - c * kgs,
                         part->side * (c / e->ei * dc - c * c / 2 * ei), dc / e->ei - c * ei};
}

/* x [2 * 2] := F^-1 A */
static void solve(struct pair f, struct pair a, double x[4])
{
    double det = f.vv * f.tt - f.vt * f.vt;
    x[0] = (f.tt * a.vv - f.vt * a.vt) / det;
    x[1] = (f.vv * a.vt - f.vt * a.vv) / det;
    x[2] = (f.tt * a.vt - f.vt * a.tt) / det;
    x[3] = (f.vv * a.tt - f.vt * a.vt) / det;
}

/* X' S X */
static struct pair turned(const double x[4], struct pair s)
{
    return (struct pair){x[0] * (s.vv * x[0] + s.vt * x[1]) + x[1] * (s.vt * x[0] + s.tt * x[1]),
                         x[0] * (s.vv * x[2] + s.vt * x[3]) + x[1] * (s.vt * x[2] + s.tt * x[3]),
                         x[2] * (s.vv * x[2] + s.vt * x[3]) + x[3] * (s.vt * x[2] + s.tt * x[3])};
}

static struct pair flexibility(const struct element *e, const struct element *d, double xi, double dz, struct pair *rate)
{
    const struct part left = {xi * e->length, dz, -1}, right = {(1 - xi) * e->length, -dz, 1};
    struct pair a = tip(e, &left), b = tip(e, &right), f = {a.vv + b.vv, a.vt + b.vt, a.tt + b.tt};
    double p[4], q[4];
    solve(f, b, p);
    solve(f, a, q);
    if (d) {
        struct pair by_a = turned(p, tip_rate(e, d, &left)), by_b = turned(q, tip_rate(e, d, &right));
        *rate = (struct pair){by_a.vv + by_b.vv, by_a.vt + by_b.vt, by_a.tt + by_b.tt};
    }
    return (struct pair){a.vv * p[0] + a.vt * p[1], a.vv * p[2] + a.vt * p[3], a.vt * p[2] + a.tt * p[3]};
}

/* C = S W, W = (I + G S)^-1: the springs S of the point in series with its flexibility G, W [2 * 2] being what of the
 * displacement without them is left. */
static struct pair held(const struct effect_point *s, struct pair g, double w[4])
{
    double lateral = 1 + g.vv * s->lateral, rotational = 1 + g.tt * s->rotational,
           det = lateral * rotational - g.vt * g.vt * s->lateral * s->rotational;
    w[0] = rotational / det;
    w[1] = -g.vt * s->lateral / det;
    w[2] = -g.vt * s->rotational / det;
    w[3] = lateral / det;
    return (struct pair){s->lateral * w[0], s->lateral * w[2], s->rotational * w[3]};
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
    if (beam->elastic_only)
        return;
    if (point->lateral == 0 && point->rotational == 0)
        return;
    double xi = place_in(&beam->mesh, lumped), w[4];
    struct pair c = held(point, flexibility(element, NULL, xi, 0, NULL), w);
    add_product(c.vv, n.v, n.v, k);
    add_product(2 * c.vt, n.v, n.theta, k);
    add_product(c.tt, n.theta, n.theta, k);
}

static int rate_of(const struct beam *beam, struct parameter parameter, const struct lumped *lumped, struct effect_point *d)
{
    const struct rotor *rotor = &beam->rotor;
    if (lumped->effect >= rotor->neffect)
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
    if (!own && d->ei == 0 && d->kgs == 0)
        return 0;
    double dxi = lumped->clamped ? 0 : dpoint.z / element->length;
    lumped_shapes(element, place_in(&beam->mesh, lumped), &n, &by_xi, &by_phi);
    for (int j = 0; j < 4; j++) {
        by_xi.v[j] = by_xi.v[j] * dxi + by_phi.v[j] * dphi;
        by_xi.theta[j] = by_xi.theta[j] * dxi + by_phi.theta[j] * dphi;
    }
    add_product(dpoint.mass, n.v, n.v, dm);
    add_product(2 * point->mass, n.v, by_xi.v, dm);
    if (point->lateral == 0 && point->rotational == 0 && dpoint.lateral == 0 && dpoint.rotational == 0)
        return 1;
    struct pair dg;
    double xi = place_in(&beam->mesh, lumped), w[4];
    struct pair c = held(point, flexibility(element, d, xi, dxi * element->length, &dg), w),
                by_spring = turned(w, (struct pair){dpoint.lateral, 0, dpoint.rotational}),
                by_element = turned((double[]){c.vv, c.vt, c.vt, c.tt}, dg); /* dC = W' dS W - C dG C */
    add_product(by_spring.vv - by_element.vv, n.v, n.v, dk);
    add_product(2 * (by_spring.vt - by_element.vt), n.v, n.theta, dk);
    add_product(by_spring.tt - by_element.tt, n.theta, n.theta, dk);
    add_product(2 * c.vv, n.v, by_xi.v, dk);
    add_product(2 * c.vt, n.v, by_xi.theta, dk);
    add_product(2 * c.vt, n.theta, by_xi.v, dk);
    add_product(2 * c.tt, n.theta, by_xi.theta, dk);
    return 1;
}
