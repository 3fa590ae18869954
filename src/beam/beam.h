#ifndef ROTID_BEAM_BEAM_H
#define ROTID_BEAM_BEAM_H

/* Beam: K(x) and M(x) of a rotor as a chain of Timoshenko elements along its axis, with exact dK/dx and dM/dx.
 * In: struct rotor, parameters, values x. Out: beam_assemble (K, M), beam_differentiate (dK, dM), mass properties, deflections.
 *
 *   set-up         build.c (beam_build): sections, mesh, hinges; mesh.c (mesh_build): nodes at ends, sensors, springs, tie rods
 *   element        element.c (element_matrices): k = K_f + K_G (A.1, A.4), m = M_v + M_theta (B.1, B.2), phi = 12 EI/(kGS l^2);
 *                  v cubic, theta quadratic; element_derivatives: the same along a direction of (EI, kGS, rho S, rho I, F)
 *   quantities     quantities.c (axis_quantities): EI, rho S, rho I as sums over the layers, F = rotor_axial_force;
 *                  axis_direction: their derivatives; build.c: factors of the effects on each element
 *   shear          shear_coefficient.c (shear_stiffness): kGS by Cowper, of layers by Saint-Venant's flexure
 *   tie rods       quantities.c (tierod_quantities): F = N T, the prestress, enters K by K_G of the bundle's own elements, and by
 *                  -N T in the F of the axis (rotor_axial_force, SELF_EQUILIBRATED); stretch E S e^2/(2 L) [1 -1; -1 1] on
 *                  (theta_from, theta_to) for RODS; build.c: the equivalent cylinder (6) for TUBE
 *   joints         hinge.c (hinge_condense): K := K - g g' c/(1 + c k), a rotational spring in series, condensed
 *   masses, springs at any place   lumped.c (lumped_add): carried by the static shapes of the element
 *   spin           deflection.c (beam_gyroscopic): polar inertia P; beam_spread: a stiffness spread over a group
 *   bars           bar.c (bar_open, bar_assemble, bar_differentiate): torsion and axial motion on the same mesh
 *   assembly       assembly.c (beam_assemble, beam_differentiate); deflection.c: deflection between nodes and in members
 *
 * Callers: model/discrete.c; solid/members.c for the elements of rods; export. The room must not know modes, data or causes. */

#include "rotor/rotor.h"

/* ------------------------------------------------------------------------------------------------------------------ mesh */

/* The mesh of a rotor: nodes along the axis, then the inner nodes of rods and bars; degrees of freedom 2 i (v) and 2 i + 1
 * (theta). */

struct chain {               /* a run of elements whose inner nodes are numbered in a row */
    int first_end, last_end; /* nodes it joins; last_end -1: free, its last node is an inner one */
    int inner, count;        /* first inner node, their number */
};

struct mesh {
    int naxis;                    /* nodes on the axis */
    double *z;                    /* [naxis] */
    int nelement;                 /* on the axis: between nodes e and e + 1 */
    int *segment;                 /* [nelement] */
    int nnode;                    /* all of them */
    int ndof, kd;                 /* 2 nnode, 3 */
    int nfar, *far;               /* degrees of freedom where members meet across the band */
    struct chain *tierod;         /* [rotor->ntierod] */
    struct chain *bars;           /* [2 * rotor->nbars]: left and right half */
    int *spring_node, *disk_node; /* [nspring], [ndisk] */
    int *sensor_node;             /* [nsensor], not decreasing */
    int end_node;
};

/* A node at every end of a segment and of a hub, sensor, spring, disk, tie-rod end and bar centre; a node nearer than 1 % of the
 * element there is taken instead of a new one (coordinates of test files carry six digits, and a sliver of an element ruins the
 * conditioning). Nodes of sensors are added last: no sensor moves what acts on the rotor. Then each element is cut into `refine`
 * equal parts. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_build(struct pool *pool, const struct rotor *rotor, int refine, struct mesh *mesh);

/* The node on the axis nearest to z, and the middle of an element of it. */
int mesh_node_at(const struct mesh *mesh, double z);
double mesh_middle(const struct mesh *mesh, int e);

/* Elements of a chain, and its i-th node from the end where it begins, 0 <= i <= elements. */
int chain_elements(const struct chain *chain);
int chain_node(const struct chain *chain, int i);

/* ----------------------------------------------------------------------------------------------------- shear coefficient */

/* The shear stiffness kGS of a section in the averages of Cowper (1966): of one material by its coefficient k, of concentric
 * layers by the flexure function over the radius; and what such layers add to EI. */

/* What a material resists shear and contraction with. x = nu_a G/E, nu_a being the contraction of the plane by axial stress:
 * nu/(2 (1 + nu)) of an isotropic material, and of one that states E, G and nu, whose k is that of the isotropic material of this
 * nu; nu G/E_sheet of a stack of sheets, which axial stress strains as it strains a sheet. ep and np: E and nu in the plane; na:
 * nu_a as in src/solid. As a direction: their derivatives. */
struct shear_material {
    double e, g, x;    /* Pa, Pa, - */
    double ep, np, na; /* Pa, -, - */
};
struct shear_material shear_material_of(const struct material *material);
struct shear_material shear_material_derivative(const struct material *material, enum parameter_kind kind);

/* Values or a direction with the factors of causes on E and G. */
void shear_material_scale(const struct material *material, double e, double g, struct shear_material *values);

/* The direction of relative rates of E and G as causes have them. */
struct shear_material shear_material_rate(const struct material *material, double e, double g);

/* The derivative `by` in the direction v. */
double shear_material_product(const struct shear_material *by, const struct shear_material *v);

struct shear_layer {
    struct shear_material material; /* with the factors of causes */
    const struct section *section;
    struct shear_material by;          /* out: derivatives of kGS by the values of the material */
    struct shear_material contraction; /* out: those of contraction_stiffness */
    double pivot, off, w, z;           /* workspace */
};

/* kGS [N] of a section of `count` >= 1 parts that touch, layer [count + 1] from the axis outwards, the last one workspace. One
 * part may have any section, several are round. At fixed x, kGS is of degree 1 in all G together and of degree 0 in all E. */
double shear_stiffness(int count, struct shear_layer *layer);

/* What bonded parts of different contraction add to the sum of their EI [N.m2], MODE_AXIAL: of their ES [N]. 0 of one part, and
 * of parts of one nu_a. */
double contraction_stiffness(enum mode_type type, int count, struct shear_layer *layer);

/* The same of one section of one material, without derivatives. */
double shear_stiffness_plain(const struct section *section, const struct material *material);

/* ------------------------------------------------------------------------------------------------------------------ beam */

/* A rotor as a chain of Timoshenko beam elements: its mesh, and the parameters that may vary. */

struct hinge { /* of a joint: see hinge_place */
    int effect, element, end;
};

struct section_part { /* of a segment: its own section, or a ring of a layer. In bending all of them turn alike, so mass adds, and
                         EI but for contraction_stiffness; kGS: shear_stiffness */
    int group;
    struct section section;
};

struct beam {
    struct rotor rotor; /* own copy of everything a parameter can change */
    int most_parts;     /* of a segment */
    int *first_part;    /* [nsegment + 1] those of segment s are part[first_part[s]] to part[first_part[s + 1] - 1], from the axis
                           outwards */
    struct section_part *part; /* [nsegment + nring] */
    struct section *tube;      /* [ntierod + nbars] equivalent cylinders where the model is TUBE */
    struct mesh mesh;
    struct shear_layer *layer;   /* [most_parts + 1] workspace of the shear stiffness */
    struct effect_field *factor; /* [most_parts * nelement] of the parts of each element, on EI, kGS and mass: products over all
                                    effects, of the last beam_assemble; NULL without effects */
    int nhinge;
    struct hinge *hinge; /* [nhinge] */
    int nparameter;
    const struct parameter *parameter; /* [nparameter] */
    enum mode_type type;               /* of its degrees of freedom */
    int elastic_only;                  /* leaves springs and axial forces out of K: what bends the rotor itself */
};

/* The beam of a rotor, with end springs from the sling added (44). `parameter` [nparameter] is kept. refine >= 1 cuts every
 * element. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group in *failed (groups, then tie rods, then bars). */
int beam_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
               struct beam *beam, int *failed);

/* The same for a rotor of the same shape (rotor_same_shape) as that of `built`, whose sections, mesh and hinges it shares.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int beam_of_shape(struct pool *pool, const struct beam *built, const struct rotor *rotor, int nparameter,
                  const struct parameter *parameter, struct beam *beam);

/* K and M at the values x of the parameters, which stay in beam->rotor. x may be NULL where nparameter is 0. */
void beam_assemble(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m);

/* Sets the parameters to x, without K and M: for mass and deflections. */
void beam_set(struct beam *beam, const double *x);

/* dK/dx_p and dM/dx_p at the values of the last beam_assemble. */
void beam_differentiate(const struct beam *beam, int p, rotid_matrix *dk, rotid_matrix *dm);

/* Adds the matrix e [4 * 4] of an element between two nodes. */
void beam_add_between(rotid_matrix *a, int first, int second, const double *e);

/* p += P: the polar inertia of what turns, in the place of the rotary inertia of M: twice that of sections, rods and bars, that
 * of disks as stated. With theta = -dv/dz in both planes the gyroscopic terms of a rotor that spins at W from x to y are W P y'
 * on x and -W P x' on y. At the values of the last beam_assemble. */
void beam_gyroscopic(const struct beam *beam, rotid_matrix *p);

/* s += S: a lateral stiffness > 0 to the ground [N/m] evenly over the length of a group, with the shapes of the mass matrix. */
void beam_spread(const struct beam *beam, int group, double stiffness, rotid_matrix *s);

/* u [2 ndof]: v = 1, theta = 0, and v = -z, theta = 1. */
void beam_rigid_motions(const struct beam *beam, double *u);

/* ------------------------------------------------------------------------------------------------------------------- bar */

/* Torsion or axial motion of the rotor: one degree of freedom a node of the axis, two-node bar elements
 *   k = c/l [1 -1; -1 1],  m = j l/6 [2 1; 1 2],
 * of torsion c = sum G J + F sum I_p/sum S and j = sum rho I_p over the layers, axially c = sum E S and j = sum rho S. F is the
 * axial force that turns with the fibres. A bundle of tie rods is one such element between its ends, whose rods follow them:
 *   torsion  c = N G J + N T R^2 + 12 N E I R^2/L^2, j = N rho S (R^2 + d^2/8);  axially c = N E S, j = N rho S.
 * Bars move with their centre. Disks have their polar inertia or their mass, springs their torsional or axial stiffness. Joints,
 * slings and what a cause does to bending alone have no part in either motion. */

/* Makes these the degrees of freedom of a beam that is built. ROTID_OK or ROTID_ERROR_MEMORY. */
int bar_open(struct pool *pool, enum mode_type type, struct beam *beam);

/* As beam_assemble and beam_differentiate. */
void bar_assemble(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m);
void bar_differentiate(const struct beam *beam, int p, rotid_matrix *dk, rotid_matrix *dm);

/* Motion v [npoint] of a member (tie rods, then bars) at even places z [npoint] from its left end to its right one. */
void bar_member_motion(const struct beam *beam, int member, const double *u, int npoint, double *z, double *v);

/* Tie rods, bars, disks and the masses of effects included, at the values of the last beam_assemble. */
void beam_mass_properties(const struct beam *beam, struct mass_properties *properties);

/* The paper's equivalent cylinder of a bundle of rods. Cylinder of the given area and inertia (6). ROTID_OK or
 * ROTID_ERROR_SECTION. */
int section_equivalent(double area, double inertia, struct section *section);

/* ------------------------------------------------------------------------------------------------------------ deflection */

/* How a beam deflects between its nodes in a motion of these. */

/* Deflection v [npoint] of tie rods or bars at npoint >= 2 even places z [npoint] from the left end of the bundle to its right
 * end, in the motion u [ndof] of all degrees of freedom: between the nodes by the static shapes of the elements, as for a lumped
 * mass. The values of the parameters are those of the last beam_assemble. */
void tierod_deflection(const struct beam *beam, int tierod, const double *u, int npoint, double *z, double *v);
void bars_deflection(const struct beam *beam, int bars, const double *u, int npoint, double *z, double *v);

/* fine_u [ndof of fine]: the motion u [ndof] of the beam, by the same shapes, at the nodes of a mesh whose elements are those of
 * the beam cut into equal parts. */
void beam_prolong(const struct beam *beam, const double *u, const struct mesh *fine, double *fine_u);

/* --------------------------------------------------------------------------------------------------------------- element */

/* The Timoshenko element of the paper's annexes: v cubic, theta quadratic, exact for loads at its nodes.
 * Degrees of freedom (v1, theta1, v2, theta2) with theta = -dv/dz where there is no shear. This is the place that states it. */

/* The five quantities an element depends on, and its length. As a direction of differentiation: their derivatives, length 0. */
struct element {
    double ei;    /* N.m2 */
    double kgs;   /* N, shear coefficient times G times area */
    double rhos;  /* kg/m */
    double rhoi;  /* kg.m */
    double force; /* N, tension positive */
    double length;
};

/* k [16] = K_f + K_G (4), m [16] = M_v + M_theta (5) */
void element_matrices(const struct element *element, double *k, double *m);

/* Derivatives of both in the direction d: the sum over the five quantities of partial derivative times d's component. */
void element_derivatives(const struct element *element, const struct element *d, double *dk, double *dm);

/* --------------------------------------------------------------------------------------------------------------- factors */

/* What the effects of a rotor do to the elements of the axis. */

/* Computes beam->factor anew, where there is one. */
void factors_refresh(struct beam *beam);

/* The parts of the section of element e, how many there are, and the factors of each, NULL without effects. */
int factors_parts(const struct beam *beam, int e, const struct section_part **part, struct effect_field **factor);

/* beam->layer := the parts of element e with their factors; how many. */
int factors_layers(const struct beam *beam, int e);

/* A part of element e as the hooks of effects see it. */
struct effect_span factors_span(const struct beam *beam, int e, const struct section_part *part);

/* ----------------------------------------------------------------------------------------------------------------- hinge */

/* Joints: a massless rotational spring in series with an element, at the end of it that lies at the interface, statically
 * condensed.
 *
 * This comment states which part is attached to which side. The node at the interface, with all parts attached to the node (tie
 * rods, springs, disks, masses at that very place), is on one side of the joint, the element with the hinge on the other. Where a
 * bundle of tie rods begins or ends at the interface, the bundle presses the joint together and holds on to the parts outside:
 * the hinge is in the element between the ends of the bundle. Elsewhere, and between two bundles, the hinge is in the element
 * left of the interface. */

/* Places the hinges of all joints on the mesh. ROTID_OK or ROTID_ERROR_MEMORY. */
int hinge_place(struct pool *pool, struct beam *beam);

/* Whether element e has a hinge. */
int hinge_in(const struct beam *beam, int e);

/* Whether one sits at this end (0 left, 1 right) of element e. */
int hinge_at(const struct beam *beam, int e, int end);

/* Condenses the hinges of element e: K and M [16] of the element, with what is lumped in it, become those between the nodes.
 */
void hinge_condense(const struct beam *beam, int e, double *k, double *m);

/* dK and dM at the same time, k and m being those of the element with what is lumped in it; all four are overwritten. */
void hinge_differentiate(const struct beam *beam, struct parameter parameter, int e, double *k, double *m, double *dk,
                         double *dm);

/* One hinge of flexibility c at `end`, with b the unit vector of its rotation, g = K b and k = b'g: the rotation of the element's
 * end is T u, T = I - b g' c/(1 + c k), and K := T'K T + g g' c/(1 + c k)^2 = K - g g' c/(1 + c k), M := T'M T. dk and dm, both
 * or neither NULL, follow, dc being the derivative of c. */
void hinge_apply(double c, double dc, int end, double *k, double *m, double *dk, double *dm);

/* ---------------------------------------------------------------------------------------------------------------- lumped */

/* Lumped masses and springs to the ground at any place of the axis: those that effects put there, and the springs of the deck
 * that an effect may move. The element around the place carries them with its own static shapes, those that its consistent mass
 * matrix integrates, so that nothing jumps as the place crosses a node; a mass at a node is a disk, and a spring at a node the
 * deck's. Inside an element the jump of the shear force and of the moment is beyond these shapes. A spring therefore acts in
 * series with the flexibility G of its place between the clamped ends of the element, which is what the shapes leave out: exact
 * for a static load, however stiff the spring is. A mass does without: the error is of first order in l, 1e-5 of the frequency
 * for 5 kg on a thin end of the paper's rotor. */

/* v and theta at xi in [0, 1] of the element for unit displacements of its ends. [4] each. */
struct lumped_shape {
    double v[4], theta[4];
};

/* The shapes at xi, and their derivatives with respect to xi and to phi = 12 EI/(kGS l^2); those may be NULL. */
void lumped_shapes(const struct element *element, double xi, struct lumped_shape *n, struct lumped_shape *by_xi,
                   struct lumped_shape *by_phi);

struct lumped { /* one of them; start with i = -1 and the rest 0 */
    int effect, i;
    int spring;  /* behind the effects, which are rotor.neffect then: that of the deck, from 1 */
    int element; /* that carries it: what is at the very node of a hinge is on the node, like a disk */
    int clamped; /* its place lies outside the axis, and the end of the axis is taken instead */
    struct effect_point point;
};

/* The next one; 0 when there are no more. */
int lumped_next(const struct beam *beam, struct lumped *lumped);

/* Adds to k [16] of its element B' (S^-1 + G)^-1 B, B = [v; theta], S = diag(lateral, rotational), unless the beam is to be
 * elastic_only, and to m [16] mass v v'. */
void lumped_add(const struct beam *beam, const struct lumped *lumped, const struct element *element, double *k, double *m);

/* Adds the derivatives to dk and dm, d being the direction of the element's quantities. Returns 0 where it adds nothing. */
int lumped_differentiate(const struct beam *beam, struct parameter parameter, const struct lumped *lumped,
                         const struct element *element, const struct element *d, double *dk, double *dm);

/* ------------------------------------------------------------------------------------------------------------ quantities */

/* From the rotor's materials, sections and forces to the five quantities of an element, and how a parameter moves them. */

/* What couples the two ends of a bundle of rods beside its bending: the stretch of rods at a pitch radius, E (S e^2/2)/L on the
 * relative rotation, and the inertia of rods that move axially in proportion to it. */
struct stretch {
    double stiffness; /* N.m/rad */
    double inertia;   /* kg.m2, all of it: a third at each end, a sixth between */
};

/* Element e of the axis. */
void axis_quantities(const struct beam *beam, int e, struct element *element);
/* Its derivative with respect to a parameter; returns 0 where that is zero. */
int axis_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d);

/* One of the elements of a bundle, its length given; and the stretch over the whole bundle (zero for a tube). */
void tierod_quantities(const struct beam *beam, int tierod, double length, struct element *element, struct stretch *stretch);
int tierod_direction(const struct beam *beam, struct parameter parameter, int tierod, struct element *d,
                     struct stretch *dstretch);
/* Bars are not identified. inertia: of bars that follow the rotation of their centre axially. */
void bars_quantities(const struct beam *beam, int bars, double length, struct element *element, double *inertia);

#endif
