#include "beam/beam.h"
#include "linalg/linalg.h"

void beam_add_between(rotid_matrix *a, int first, int second, const double *e)
{
    const int dof[4] = {2 * first, 2 * first + 1, 2 * second, 2 * second + 1};
    matrix_add_element(a, 4, dof, e);
}

static void add_chain(const struct chain *chain, const double *ek, const double *em, rotid_matrix *k, rotid_matrix *m)
{
    for (int i = 0; i < chain_elements(chain); i++) {
        beam_add_between(k, chain_node(chain, i), chain_node(chain, i + 1), ek);
        beam_add_between(m, chain_node(chain, i), chain_node(chain, i + 1), em);
    }
}

/* axial displacement of the rods is linear between the rotations of the ends */
static void add_stretch(const struct chain *chain, const struct stretch *stretch, rotid_matrix *k, rotid_matrix *m)
{
    int first = 2 * chain->first_end + 1, last = 2 * chain->last_end + 1;
    matrix_add(k, first, first, stretch->stiffness);
    matrix_add(k, last, last, stretch->stiffness);
    matrix_add(k, first, last, -stretch->stiffness);
    matrix_add(m, first, first, stretch->inertia / 3);
    matrix_add(m, last, last, stretch->inertia / 3);
    matrix_add(m, first, last, stretch->inertia / 6);
}

static double tierod_element_length(const struct beam *beam, int i)
{
    const struct chain *chain = &beam->mesh.tierod[i];
    return (beam->mesh.z[chain->last_end] - beam->mesh.z[chain->first_end]) / chain_elements(chain);
}

static void add_axis_element(const struct beam *beam, int e, rotid_matrix *k, rotid_matrix *m)
{
    struct element element;
    double ek[16], em[16];
    axis_quantities(beam, e, &element);
    element_matrices(&element, ek, em);
    if (beam->nhinge && hinge_in(beam, e)) {
        for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);)
            if (lumped.element == e)
                lumped_add(beam, &lumped, &element, ek, em);
        hinge_condense(beam, e, ek, em);
    }
    beam_add_between(k, e, e + 1, ek);
    beam_add_between(m, e, e + 1, em);
}

/* those outside the elements with a hinge */
static void add_lumped(const struct beam *beam, rotid_matrix *k, rotid_matrix *m)
{
    struct element element;
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);) {
        double ek[16] = {0}, em[16] = {0};
        int e = lumped.element;
        if (hinge_in(beam, e))
            continue;
        axis_quantities(beam, e, &element);
        lumped_add(beam, &lumped, &element, ek, em);
        beam_add_between(k, e, e + 1, ek);
        beam_add_between(m, e, e + 1, em);
    }
}

void beam_set(struct beam *beam, const double *x)
{
    parameters_set(&beam->rotor, beam->nparameter, beam->parameter, x);
    factors_refresh(beam);
}

void beam_assemble(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const struct mesh *mesh = &beam->mesh;
    struct element element;
    struct stretch stretch;
    double ek[16], em[16], inertia;
    beam_set(beam, x);
    for (int e = 0; e < mesh->nelement; e++)
        add_axis_element(beam, e, k, m);
    add_lumped(beam, k, m);
    for (int i = 0; i < beam->rotor.ntierod; i++) {
        tierod_quantities(beam, i, tierod_element_length(beam, i), &element, &stretch);
        element_matrices(&element, ek, em);
        add_chain(&mesh->tierod[i], ek, em, k, m);
        add_stretch(&mesh->tierod[i], &stretch, k, m);
    }
    for (int i = 0; i < 2 * beam->rotor.nbars; i++) {
        const struct chain *half = &mesh->bars[i];
        bars_quantities(beam, i / 2, beam->rotor.bars[i / 2].length / 2 / chain_elements(half), &element, &inertia);
        element_matrices(&element, ek, em);
        if (i % 2 == 0) { /* drawn from the centre to the left: the sign of the rotation turns */
            for (int c = 0; c < 4; c++)
                for (int r = 0; r < 4; r++)
                    if ((r + c) % 2) {
                        ek[r + 4 * c] = -ek[r + 4 * c];
                        em[r + 4 * c] = -em[r + 4 * c];
                    }
        }
        add_chain(half, ek, em, k, m);
        matrix_add(m, 2 * half->first_end + 1, 2 * half->first_end + 1, inertia / 2);
    }
    for (int i = 0; i < beam->rotor.ndisk; i++) {
        int v = 2 * mesh->disk_node[i];
        matrix_add(m, v, v, beam->rotor.disk[i].mass);
        matrix_add(m, v + 1, v + 1, effects_on_disk(&beam->rotor, i));
    }
    for (int i = 0; i < beam->rotor.nspring && !beam->elastic_only; i++) {
        int v = 2 * mesh->spring_node[i];
        struct effect_point point;
        if (effects_move_spring(&beam->rotor, i)) /* it is lumped */
            continue;
        effects_on_spring(&beam->rotor, i, &point);
        matrix_add(k, v, v, point.lateral);
        matrix_add(k, v + 1, v + 1, point.rotational);
    }
}

static void differentiate_axis_element(const struct beam *beam, struct parameter parameter, int e, rotid_matrix *dk,
                                       rotid_matrix *dm)
{
    struct element element, d;
    double k[16], m[16], ek[16] = {0}, em[16] = {0};
    int moves = axis_direction(beam, parameter, e, &d), hinged = beam->nhinge && hinge_in(beam, e);
    if (!moves && !hinged)
        return;
    axis_quantities(beam, e, &element);
    if (moves)
        element_derivatives(&element, &d, ek, em);
    if (hinged) {
        element_matrices(&element, k, m);
        for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);)
            if (lumped.element == e) {
                lumped_add(beam, &lumped, &element, k, m);
                lumped_differentiate(beam, parameter, &lumped, &element, &d, ek, em);
            }
        hinge_differentiate(beam, parameter, e, k, m, ek, em);
    }
    beam_add_between(dk, e, e + 1, ek);
    beam_add_between(dm, e, e + 1, em);
}

static void differentiate_lumped(const struct beam *beam, struct parameter parameter, rotid_matrix *dk, rotid_matrix *dm)
{
    struct element element, d;
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);) {
        double ek[16] = {0}, em[16] = {0};
        int e = lumped.element;
        if (hinge_in(beam, e))
            continue;
        axis_quantities(beam, e, &element);
        axis_direction(beam, parameter, e, &d);
        if (!lumped_differentiate(beam, parameter, &lumped, &element, &d, ek, em))
            continue;
        beam_add_between(dk, e, e + 1, ek);
        beam_add_between(dm, e, e + 1, em);
    }
}

static void differentiate_springs(const struct beam *beam, struct parameter parameter, rotid_matrix *dk)
{
    const struct rotor *rotor = &beam->rotor;
    struct effect_point d;
    for (int i = 0; i < rotor->nspring; i++) {
        int v = 2 * beam->mesh.spring_node[i];
        if (effects_move_spring(rotor, i) || !effects_spring_derivative(rotor, parameter, i, &d))
            continue;
        matrix_add(dk, v, v, d.lateral);
        matrix_add(dk, v + 1, v + 1, d.rotational);
    }
}

/* Of an effect: a lumped mass, say, changes no element but that which carries it. */
static int moves_axis(const struct beam *beam, struct parameter parameter)
{
    if (parameter.kind != PARAMETER_EFFECT || beam->nhinge)
        return 1;
    const struct effect_kind *kind = beam->rotor.effect[parameter.index].kind;
    return kind->field || kind->section || kind->tierod;
}

void beam_differentiate(const struct beam *beam, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    const struct mesh *mesh = &beam->mesh;
    struct parameter parameter = beam->parameter[p];
    struct element element, d;
    struct stretch stretch, dstretch;
    double ek[16], em[16];
    for (int e = 0; e < mesh->nelement && moves_axis(beam, parameter); e++)
        differentiate_axis_element(beam, parameter, e, dk, dm);
    differentiate_lumped(beam, parameter, dk, dm);
    for (int i = 0; i < beam->rotor.ntierod; i++)
        if (tierod_direction(beam, parameter, i, &d, &dstretch)) {
            tierod_quantities(beam, i, tierod_element_length(beam, i), &element, &stretch);
            element_derivatives(&element, &d, ek, em);
            add_chain(&mesh->tierod[i], ek, em, dk, dm);
            add_stretch(&mesh->tierod[i], &dstretch, dk, dm);
        }
    differentiate_springs(beam, parameter, dk);
    int turns = effects_disk_of(&beam->rotor, parameter);
    if (parameter.kind == PARAMETER_DISK_MASS)
        matrix_add(dm, 2 * mesh->disk_node[parameter.index], 2 * mesh->disk_node[parameter.index], 1);
    else if (turns >= 0)
        matrix_add(dm, 2 * mesh->disk_node[turns] + 1, 2 * mesh->disk_node[turns] + 1, 1);
}

static void move_rigidly(const struct mesh *mesh, int node, double z, double *u)
{
    double *shift = u + 2 * (ptrdiff_t)node, *turn = shift + mesh->ndof;
    shift[0] = turn[1] = 1;
    shift[1] = 0;
    turn[0] = -z;
}

static void move_chain(const struct mesh *mesh, const struct chain *chain, double to, double *u)
{
    int n = chain_elements(chain);
    double from = mesh->z[chain->first_end];
    for (int i = 0; i <= n; i++)
        move_rigidly(mesh, chain_node(chain, i), from + (to - from) * i / n, u);
}

void beam_rigid_motions(const struct beam *beam, double *u)
{
    const struct mesh *mesh = &beam->mesh;
    for (int i = 0; i < beam->rotor.ntierod; i++)
        move_chain(mesh, &mesh->tierod[i], mesh->z[mesh->tierod[i].last_end], u);
    for (int i = 0; i < 2 * beam->rotor.nbars; i++) {
        double half = beam->rotor.bars[i / 2].length / 2, center = mesh->z[mesh->bars[i].first_end];
        move_chain(mesh, &mesh->bars[i], i % 2 ? center + half : center - half, u);
    }
    for (int i = 0; i < mesh->naxis; i++)
        move_rigidly(mesh, i, mesh->z[i], u);
}

struct moments { /* of mass about the left end: zeroth, first and second */
    double m0, m1, m2;
};

static void add_point_of_mass(struct moments *sum, double mass, double inertia, double z)
{
    sum->m0 += mass;
    sum->m1 += mass * z;
    sum->m2 += mass * z * z + inertia;
}

static void add_rod_of_mass(struct moments *sum, double rhos, double rhoi, double from, double to)
{
    double l = to - from, middle = (from + to) / 2;
    sum->m0 += rhos * l;
    sum->m1 += rhos * l * middle;
    sum->m2 += rhos * l * (middle * middle + l * l / 12) + rhoi * l;
}

void beam_mass_properties(const struct beam *beam, struct mass_properties *properties)
{
    const struct mesh *mesh = &beam->mesh;
    const struct rotor *rotor = &beam->rotor;
    struct element element;
    struct stretch stretch;
    struct moments sum = {0, 0, 0};
    double inertia;
    for (int e = 0; e < mesh->nelement; e++) {
        axis_quantities(beam, e, &element);
        add_rod_of_mass(&sum, element.rhos, element.rhoi, mesh->z[e], mesh->z[e + 1]);
    }
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct chain *chain = &mesh->tierod[i];
        tierod_quantities(beam, i, 1, &element, &stretch);
        add_rod_of_mass(&sum, element.rhos, element.rhoi, mesh->z[chain->first_end], mesh->z[chain->last_end]);
        sum.m2 += stretch.inertia;
    }
    for (int i = 0; i < rotor->nbars; i++) {
        double center = mesh->z[mesh->bars[2 * (ptrdiff_t)i].first_end], half = rotor->bars[i].length / 2;
        bars_quantities(beam, i, 1, &element, &inertia);
        add_rod_of_mass(&sum, element.rhos, element.rhoi, center - half, center + half);
        sum.m2 += inertia;
    }
    for (int i = 0; i < rotor->ndisk; i++) {
        double z = mesh->z[mesh->disk_node[i]];
        add_point_of_mass(&sum, rotor->disk[i].mass, effects_on_disk(rotor, i), z);
    }
    for (struct lumped lumped = {.i = -1}; lumped_next(beam, &lumped);)
        add_point_of_mass(&sum, lumped.point.mass, 0, lumped.point.z);
    properties->mass = sum.m0;
    properties->center = sum.m1 / sum.m0;
    properties->inertia = sum.m2 - sum.m1 * sum.m1 / sum.m0;
}
