#ifndef ROTID_SOLID_SOLID_H
#define ROTID_SOLID_SOLID_H

/* Solid: K(x) and M(x) of a rotor as a body of revolution, first circumferential harmonic, with exact dK/dx and dM/dx.
 * In: struct rotor, parameters, values x. Out: solid_assemble (K, M), solid_differentiate (dK, dM), mass, strain energy.
 *
 *   displacement   u_r = U cos t, u_t = V sin t, u_z = W cos t over the meridian (r, z)
 *   mesh           outline.c (outline_lines): lines graded towards re-entrant corners; mesh.c (solid_mesh_build): eight-node
 *                  quadrilaterals, quarter-point nodes at corners; shape.c: shape functions
 *   material       elasticity.c (elasticity_of): transversely isotropic C, of a laminated stack too, and its derivatives
 *   elements       solid.c (integrals_of, once a mesh): K = pi int B'CB r dr dz, M = pi rho int N'N r dr dz as sums;
 *                  field_of_share: C, rho and axial stress of each share of an element, with the factors of the effects
 *   prestress      solid.c: sigma = share of rotor_axial_force over the area; K += pi sigma int (U,z^2 + V,z^2 + W,z^2) r dr dz
 *   attachments    motion.c (motion_of_section): v = int (U - V)/2 r dr/int r dr, theta = int W r^2 dr/int r^3 dr of a section;
 *                  on these solid.c (solid_add_attached) puts springs and disks; point masses are rings of the surface
 *   tie rods, bars members.c (members_assemble): beam elements beside the solid; tension N T of the rods enters their K_G there,
 *                  of one element the axial force;
 *                  stretch by W at the pitch radius (motion_axial)
 *   joints         solid.c (joint_compliance): 1/E + c I/t in the slice beside the interface
 *   basis          basis.c (solid_basis_assemble): V'K V and V'M V of motions u = V q, by classes of equal shares
 *   spin           gyroscopic.c (solid_gyroscopic): P of the first harmonic; solid_spread: a stiffness spread over a group
 *   harmonic 0     the same routines in torsion and along the axis (solid_mesh.type), where a section has one motion, v;
 *                  members.c (assemble_bundles): rods and bars there
 *   transfer       transfer.c (solid_transfer): a motion on another mesh, to begin an eigensolution with
 *
 * Callers: src/model; export reads the mesh. The room must not know modes, data, or the limit of two meshes. */

#include "rotor/rotor.h"

/* ------------------------------------------------------------------------------------------------------------ elasticity */

/* Elastic constants of a body of revolution that is transversely isotropic about its axis z. In the order rr, tt, zz, rz, rt, tz
 *   C = [C11 C12 C13; C12 C11 C13; C13 C13 C33] for the first three, C44 for rz and tz, C66 = (C11 - C12)/2 for rt. */

struct elasticity {
    double c11, c12, c13, c33, c44, c66; /* Pa */
};

/* What is left of the moduli of a material at a place: factors on E and on G, as a cause gives them, and on E of the axial
 * direction alone, as a joint gives it. Neutral: 1 each. */
struct elasticity_factors {
    double e, g, axial;
};

/* The constants of a material. With E_p and nu_p in the plane, E_a and G along the axis, and nu_a the contraction in the plane
 * under axial load:
 *   isotropic            E_p = E_a = E, nu_p = nu_a = nu, G = E/2(1 + nu);
 *   E, G and nu given    the same, with G as given: in the plane nothing better is known;
 *   laminated            E_p = stacking E_sheet, nu_p = nu_sheet, nu_a = nu_sheet E_a/E_sheet: axial stress strains a sheet as
 *                        it would strain solid steel.
 * The factor e acts on E of the first two, and on E_a alone of a laminated material, whose sheets stay what they are; the factor
 * `axial` on E_a alone, with nu_a in proportion. Lekhnitskii, Theory of Elasticity of an Anisotropic Body, 1963, section 4. */
struct elasticity elasticity_of(const struct material *material, const struct elasticity_factors *factors);

/* Its derivative with respect to E, G or nu of the material (kind; zero for others). */
struct elasticity elasticity_by_material(const struct material *material, const struct elasticity_factors *factors,
                                         enum parameter_kind kind);

/* Its derivative in the direction d of the factors. */
struct elasticity elasticity_by_factors(const struct material *material, const struct elasticity_factors *factors,
                                        const struct elasticity_factors *d);

/* ------------------------------------------------------------------------------------------------------------------ mesh */

/* The meridian of a rotor as a mesh of eight-node quadrilaterals, and what its nodes do in bending: u_r = U cos t, u_t = V sin t,
 * u_z = W cos t; in torsion u_t = V alone, along the axis u_r = U and u_z = W. Nodes lie on lines of constant z, the ends of a
 * slice, and half-way between; degrees of freedom are numbered line by line, so that the band is as wide as two lines and what
 * lies between them.
 *
 * On the axis V = -U and W = 0 in bending, V = 0 in torsion, U = 0 along it. A re-entrant corner of the outline is a singularity
 * like a crack's, of exponent 0.545: the half-way nodes of the edges that meet there lie at a quarter of their length, by which
 * an element follows a square root. */

enum {
    SOLID_NODES = 8,             /* of an element: four corners from (inner, left) by (outer, left), then the edges between */
    SOLID_DOFS = 3 * SOLID_NODES /* U, V, W of each */
};

/* How fine. What is 0 follows from the rotor. */
struct solid_rule {
    double corner;  /* m: elements at a re-entrant corner */
    double largest; /* m */
    int straight;   /* nonzero: edges at a corner keep their half-way nodes half-way */
    enum mode_type type;
};

struct solid_node {
    double r, z;
    int dof[3]; /* of U, V, W; -1: none. In bending V of the axis has that of U, and the sign is -1; in torsion V is V/r */
};

struct solid_element {
    int node[SOLID_NODES];
    int slice, segment, group; /* group: that of the material */
    double share;              /* of its volume that is not holes */
    double extra;              /* m2: cross section outside the stiffness diameter, which has mass only, on the outer edge */
    int sensor;                /* that U of node 5, half-way along the outer edge, stands for (V/r, W), or -1: sensor_dof */
    double at_sensor[3];       /* share of the nodes 1, 5, 2 in the motion of the sensor */
};

struct solid_mesh {
    enum mode_type type; /* of its degrees of freedom; what is measured is component `type` of U, V, W */
    int nslice;
    double *z;    /* [nslice + 1] lines */
    int *segment; /* [nslice] */
    int *first;   /* [nslice + 1] first element of a slice */
    int nnode;
    struct solid_node *node; /* line by line, from the axis outwards */
    int *line;               /* [2 nslice + 2] first node of each line: 2 i is line i, 2 i + 1 half-way to the next */
    int *surface;            /* [2 nslice + 1] node at the surface of each */
    double *surface_z;       /* [2 nslice + 1] m: what U of that node is the motion of */
    int nelement;
    struct solid_element *element;
    int *sensor_dof; /* [nsensor] the motion of the surface at the sensor is an unknown itself */
    int *member_dof; /* [nmember * (nslice + 1)]: solid_mesh_member_dof */
    int ndof, kd;
};

#define SOLID_MOST_SLENDER                                                                                                       \
    (1000 * (1 + 1e-9))            /* length over largest diameter: rounding of K leaves 1e-4 of the first frequency */
#define SOLID_MOST_UNKNOWNS 200000 /* of the mesh that is not refined */
#define SOLID_MOST_ENTRIES  1e8    /* of its K, unknowns times band: 0.8 GB, 20 s of a disc 2000 times as wide as thick */

/* ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group in *failed where holes leave nothing, a group is
 * rectangular or its first section does not touch the one before; groups, tie rods and bars together where the mesh has too many
 * unknowns or entries or the rotor is too slender. refine >= 1 divides the size of the elements at corners, and by its root the
 * largest; 0: the coarse mesh, with corners six times as large and across the largest twice. */
int solid_mesh_build(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine,
                     struct solid_mesh *mesh, int *failed);

/* Whether member i moves with the section on all of its lines: tie rods of one element, which lie in the holes of what they press
 * together. More elements bend by themselves between their ends. */
int solid_mesh_follows(const struct rotor *rotor, int i);

/* The line nearest to z. */
int solid_mesh_line(const struct solid_mesh *mesh, double z);

/* Where member i (tie rods, then bars) begins and ends: lines. */
void solid_mesh_member(const struct rotor *rotor, const struct solid_mesh *mesh, int i, int *from, int *to);

/* The degree of freedom of v of a member on a line, theta following it; -1 where it moves with the rotor or has ended. */
int *solid_mesh_member_dof(const struct solid_mesh *mesh, int member, int line);

/* The slice that holds z, and its outermost element. */
int solid_mesh_slice(const struct solid_mesh *mesh, double z);
int solid_mesh_outermost(const struct solid_mesh *mesh, int slice);

/* ------------------------------------------------------------------------------------------------------------- integrals */

/* What of an element does not depend on its material: integrals over its area, from which K and M of any transversely isotropic
 * material follow as sums. With n = N/r and strains e_rr = U,r; e_tt = (U + V)/r; e_zz = W,z; g_rz = U,z + W,r;
 * g_rt = V,r - (U + V)/r; g_tz = V,z - W/r:
 *   K = pi int B' C B r dr dz,  M = pi rho int N'N r dr dz;
 * in torsion and along the axis twice that of the harmonic 0: e_tt = U/r, g_rt = V,r - V/r, g_tz = V,z. */

#define SHARES 3 /* Gauss points along z: causes act on the share of each with factors of its own */

enum integral { BY_R_R, BY_N_N, BY_Z_Z, BY_R_N, BY_R_Z, BY_N_Z, BY_MASS, INTEGRALS };

/* value[i][a + 8 b]: pi int X_a Y_b r dr dz, X and Y being derivatives with respect to r, N/r, or those with respect to z */
struct integrals {
    double value[SHARES][INTEGRALS][SOLID_NODES * SOLID_NODES];
};

/* ---------------------------------------------------------------------------------------------------------------- motion */

/* A motion of something on the rotor as a sum of degrees of freedom, by which springs, masses and members act inside the band:
 * stiffness s along the motion t'u adds s t t'. */

struct motion {
    int count;
    int *dof;       /* [count] each once */
    double *weight; /* [count] */
};

/* Of the section at a line as a whole: the means over its area, as of a plate that spreads a load and adds no stiffness, without
 * the covers, whose stated E is below a tenth of the stiffest one there,
 *   v = int (U - V)/2 r dr / int r dr,  theta = int W r^2 dr / int r^3 dr;
 * in torsion v = int V r^2 dr / int r^3 dr, along the axis v = int W r dr / int r dr, and no theta.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int motion_of_section(struct pool *pool, const struct rotor *rotor, const struct solid_mesh *mesh, int line, struct motion *v,
                      struct motion *theta);

/* The same in bending at the left end of a slice (y -1), half-way along it (0) or at its right end (1), without covers there. */
int motion_in_slice(struct pool *pool, const struct rotor *rotor, const struct solid_mesh *mesh, int slice, int y,
                    struct motion *v, struct motion *theta);

/* W of a line at a pitch radius as the annulus pitch -+ reach tilts: pitch int W r^2 dr / int r^3 dr, which is theta pitch where
 * the section stays plane; in torsion and along the axis the mean of V/r and W there. A load on a circle would sink in without
 * limit. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION
 * where the section does not reach there. */
int motion_axial(struct pool *pool, const struct solid_mesh *mesh, int line, double pitch, double reach, struct motion *w);

/* U, V or W (component 0, 1, 2) of the surface at z, into room for SURFACE_MOST degrees of freedom; with by_place of its
 * derivative with respect to z. */
#define SURFACE_MOST 3
void motion_of_surface(const struct solid_mesh *mesh, double z, int component, int by_place, int *dof, double *weight,
                       struct motion *motion);

double motion_value(const struct motion *motion, const double *u);

#define BASIS_MOST 160

/* What takes up stiffness and mass: a matrix A of the mesh, or V'A V of the motions u = V q of a basis. */
struct target {
    rotid_matrix *a;
    int count;       /* of the columns of V, up to BASIS_MOST; 0: A itself */
    ptrdiff_t n;     /* of its rows */
    const double *v; /* [n * count] */
};

/* A += value (x y' + y x')/2 */
void motion_add(const struct target *a, double value, const struct motion *x, const struct motion *y);

/* ----------------------------------------------------------------------------------------------------------------- solid */

/* A rotor as a body of revolution: its first circumferential harmonic on the mesh of a meridian, with what is attached to it, and
 * the parameters that may vary. A client of src/rotor beside src/beam. What has no meaning here is refused with
 * ROTID_ERROR_SECTION: see solid_refusal. What a cause does to the sections of a beam (effect_section) does nothing here. */

struct solid_line { /* of the mesh: the motion of the section there */
    struct motion v, theta;
};

struct solid {
    struct rotor rotor; /* own copy of everything a parameter can change */
    struct solid_mesh mesh;
    struct integrals *integrals; /* [nelement] */
    struct solid_line *line;     /* [nslice + 1] */
    struct solid_line *inside;   /* [3 nslice] of the section at the ends of a slice and half-way, where rods follow it */
    struct motion *stretch;      /* [2 ntierod] W at the pitch radius of both ends */
    int nfar, *far;              /* their degrees of freedom, which meet across the band */
    int nparameter;
    const struct parameter *parameter; /* [nparameter] */
    int elastic_only;                  /* leaves springs and axial forces out of K: what bends the rotor itself */
};

/* The solid of a rotor, with end springs from the sling added (44). `parameter` [nparameter] is kept; rule: NULL, what follows
 * from the rotor; refine as for solid_mesh_build. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group, also
 * one that keeps its volume, tie rod or bars in *failed (groups, then tie rods, then bars, then the mesh as a whole). */
int solid_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter,
                const struct solid_rule *rule, int refine, struct solid *solid, int *failed);

/* Why solid_build refused a rotor with ROTID_ERROR_SECTION and this *failed, and what was expected; to follow the place. */
const char *solid_refusal(const struct rotor *rotor, int failed);

/* The longest time [s] in which a shear wave along the axis, of G and the density of its group, passes an element: times a
 * frequency, the share of a wave that the element has to follow. Values of parameters are those of the last assembly. */
double solid_longest_passage(const struct solid *solid);

/* The same for a rotor of the same shape (rotor_same_shape) as that of `built`, whose mesh it shares. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int solid_of_shape(struct pool *pool, const struct solid *built, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, struct solid *solid);

/* K and M at the values x of the parameters, which stay in solid->rotor. x may be NULL where nparameter is 0. */
void solid_assemble(struct solid *solid, const double *x, rotid_matrix *k, rotid_matrix *m);

/* Sets the parameters to x, without K and M. */
void solid_set(struct solid *solid, const double *x);

/* dK/dx_p and dM/dx_p at the values of the last solid_assemble, in rows and columns *from ... *end - 1 alone, but for the block.
 */
void solid_differentiate(const struct solid *solid, int p, rotid_matrix *dk, rotid_matrix *dm, int *from, int *end);

/* dk_u and dm_u [n * count] := dK/dx_p u and dM/dx_p u element by element, in rows *from ... *end - 1 alone. Returns
 * 1 where x_p moves more than elements. */
int solid_derivative_products(const struct solid *solid, int p, int count, const double *u, double *dk_u, double *dm_u, int *from,
                              int *end);

/* Tie rods, bars, disks and the masses of effects included, at the values of the last solid_assemble. */
void solid_mass_properties(const struct solid *solid, struct mass_properties *properties);

/* U, V, W [24] of the nodes of an element in the motion u [ndof]. */
void solid_element_motion(const struct solid *solid, const struct solid_element *element, const double *u, double *local);

/* u [2 ndof]: U = 1, V = -1, W = 0, and U = -z, V = z, W = r; in torsion and along the axis [ndof] V/r or W = 1. */
void solid_rigid_motions(const struct solid *solid, double *u);

/* Strain energy [J] of each element in the motion u [ndof], for the amplitude u: energy [nelement]. */
void solid_strain_energy(const struct solid *solid, const double *u, double *energy);

/* What the values of a rotor and its causes make of the material of an element, share by share. */

struct share { /* one of an element; as a derivative: its rate */
    struct elasticity elasticity;
    double rho, stress; /* kg/m3; Pa, axial, tension positive */
};

/* The values of a share of an element, with the factors of the effects. */
void solid_field_of_share(const struct solid *solid, const struct solid_element *element, int share, struct share *out);

/* Its derivative with respect to a parameter; returns 0 where that is zero. */
int solid_field_rate(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate);

/* field [SHARES] of element `index`, or for p >= 0 the rates; left as it is where the element before has the same: elements are
 * gone through in their order. */
void solid_fields_of(const struct solid *solid, int index, int p, struct share *field);

/* K and M [24 * 24] of element `index` from the fields [SHARES] of its shares, or what these change of them; *has_k, *has_m:
 * whether each is there at all, or left as it was. */
void solid_element_matrices(const struct solid *solid, int index, const struct share *field, double *k, double *m, int *has_k,
                            int *has_m);

/* What an assembly makes of motions: y [ndof * count], zero but in rows from ... end - 1; ndof and 0 where there are none. */
struct solid_image {
    double *y;
    int from, end;
};

/* The images of K and M += E u, u [ndof * count], of element `index` with the fields [SHARES] of its shares. */
void solid_add_images(const struct solid *solid, int index, const struct share *field, int count, const double *u,
                      struct solid_image image[2]);

/* e [24 * 24] := the element in unknowns of the mesh, dof [24], -1 where there is none. */
void solid_tie_element(const struct solid *solid, const struct solid_element *element, double *e, int *dof);

/* Adds springs, disks, masses, rods and bars to K and M, or for p >= 0 their derivatives with respect to solid->parameter[p]. */
void solid_add_attached(const struct solid *solid, int p, const struct target *k, const struct target *m);

/* Adds rho times the integrals of mass to m [8 * 8], which stands for each of U, V, W. */
void solid_add_mass(const struct integrals *integrals, int share, double rho, double *m);

/* a += e [24 * 24] of an element, which is overwritten. */
void solid_add_element(const struct solid *solid, const struct solid_element *element, double *e, rotid_matrix *a);

/* The i-th lumped mass or spring of all effects; *effect and *i begin at 0 and -1. Returns 0 when there are no more. */
int solid_next_point(const struct solid *solid, int *effect, int *i, struct effect_point *point);

/* p += P of the first harmonic, P_ij = 2 pi int rho r [(U_i + V_i)(U_j + V_j) + W_i W_j] dr dz, with the polar inertia of what is
 * attached: zero for a translation, 2 rho I for a section that turns. Signs as of beam_gyroscopic. */
void solid_gyroscopic(const struct solid *solid, rotid_matrix *p);

/* s += S: a lateral stiffness > 0 to the ground [N/m] evenly over the length of a group, on the mean motion of its sections. */
void solid_spread(const struct solid *solid, int group, double stiffness, rotid_matrix *s);

/* v [ndof], zeros before: v'u is the deflection of the section on which spring i acts. */
void solid_spring_motion(const struct solid *solid, int i, double *v);

/* ----------------------------------------------------------------------------------------------------------------- basis */

/* Motions u = V q alone: K and M of q, exact for those motions at all values of the parameters. */

#define SOLID_FIELD (sizeof(struct share) / sizeof(double)) /* numbers of a field */

struct solid_class {
    int element, share; /* the first one of it */
    int moves;          /* with a parameter */
    struct share now;   /* its field, or rate, at the last assembly; of one that does not move the field */
    int has_mass, ndirection;
    double direction[SOLID_FIELD][SOLID_FIELD]; /* orthonormal: the field without rho is a sum of the first ndirection */
    double
        *part; /* [8 * count * count] V'M V of rho 1, where has_mass, and V'K V of each direction; 2 of one that does not move */
};

struct solid_basis {
    struct solid *solid;
    int count;       /* up to BASIS_MOST */
    const double *v; /* [ndof * count] V */
    int nclass;
    struct solid_class *class;
    int *class_of;               /* [nelement * SHARES], -1: none */
    struct solid_image image[2]; /* K V and M V of elements, until V' is multiplied to them */
    double *sum;
};

/* At the values of the solid; solid and v are kept. ROTID_OK or ROTID_ERROR_MEMORY. */
int solid_basis_new(struct pool *pool, struct solid *solid, int count, const double *v, struct solid_basis *basis);

/* Adds V'K V and V'M V at x to k and m, full matrices (kd = count - 1), or their derivatives by parameter p. */
void solid_basis_assemble(struct solid_basis *basis, const double *x, rotid_matrix *k, rotid_matrix *m);
void solid_basis_differentiate(struct solid_basis *basis, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm);

/* Places of mesh lines along one coordinate, graded towards some of them. */

struct stop {
    double at;   /* m, where a line has to be */
    double fine; /* m: the size of the elements beside it; 0: not graded towards it */
    double upto; /* m: the largest element between this stop and the next */
};

/* --------------------------------------------------------------------------------------------------------------- members */

/* Tie rods and bars beside a solid: chains of beam elements from line to line of the mesh, which bend by themselves. Tie rods
 * move with the section at both ends and are stretched by W at their pitch radius there; bars move with the section at their
 * centre. Tie rods of one element move with the section everywhere (solid_mesh_follows): their mass acts on the ends and
 * the middle of each slice, and their own bending stiffness, below a thousandth of that of what they press together, is left out.
 */

/* Adds to K and M, or for p >= 0 their derivatives with respect to solid->parameter[p]; the matrices may be NULL. */
void members_assemble(const struct solid *solid, int p, const struct target *k, const struct target *m);

/* Adds to P: twice the inertia of rods and bars about a diameter. */
void members_gyroscopic(const struct solid *solid, const struct target *p);

/* Adds moments of mass about the left end, as attached_moments. */
void members_moments(const struct solid *solid, double moment[3]);

/* How far the elements of members that bend by themselves leave a frequency above its limit, relative to it: the sum of
 * T_e lambda m l^2 (l^2/(1440 EI) + 1/(24 kGS)) over elements of length l and mass m a length, T_e the share of one in u'M u: an
 * element follows a cubic, and the mean of the shear force. */
double members_mesh_error(const struct solid *solid, const double *u, double lambda);

/* Deflection of member i at z, in the motion u: cubic between lines, by v and theta there. */
double members_deflection_at(const struct solid *solid, int i, const double *u, double z);

/* The same, v [npoint], at npoint >= 2 even places z [npoint] from its left end to the right one. */
void members_deflection(const struct solid *solid, int i, const double *u, int npoint, double *z, double *v);

/* --------------------------------------------------------------------------------------------------------------- outline */

/* The outline of a rotor's meridian: which material is where, its re-entrant corners, and the lines that a mesh needs. */

/* Whether segment s > 0 touches the one before: more than a circle. */
int outline_touch(const struct rotor *rotor, int s);

/* The group whose material lies at radius r of segment s, or -1. */
int outline_group(const struct rotor *rotor, int s, double r);

/* Share of the volume of the group's material at radius r that is not holes. */
double outline_share(const struct rotor *rotor, int group, double r);

/* Whether the end z of segment s < nsegment - 1 has a re-entrant corner at radius r. */
int outline_corner(const struct rotor *rotor, int s, double r);

/* Length over the largest diameter. */
double outline_slenderness(const struct rotor *rotor);

/* Whether any end of a segment has one: errors fall slower there than elsewhere. */
int outline_has_corners(const struct rotor *rotor);

/* Whether a section has a bore that is smaller than the largest elements: those beside it are not all halved by a finer mesh. */
int outline_has_small_bore(const struct rotor *rotor);

/* Lines of constant r, x [*nr], and of constant z, z [*nz] with the segment [*nz - 1] of each slice. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int outline_lines(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine, int *nr, double **r,
                  int *nz, double **z, int **segment);

/* ----------------------------------------------------------------------------------------------------------------- shape */

/* Shape functions of the eight-node quadrilateral and of its edges. */

/* n [8] and its derivatives with respect to x, from the inner to the outer edge, and y, from left to right, both in [-1, 1]. */
void shape_of_element(double x, double y, double *n, double *by_x, double *by_y);

/* Share n [3] of the ends and the node between in the motion at a place of an edge, whose nodes are at `edge` [3], in the order
 * first end, node between, second end; by_place [3]: derivatives with respect to the place, or NULL. */
void shape_of_edge(const double *edge, double place, double *n, double *by_place);

/* A motion of a solid on another mesh of the same rotor: where the solution on a finer mesh begins. v [ndof of `to`] := the
 * motion u [ndof of `from`] at the nodes, sensors and members of `to`. Elements are taken to be straight, which those at corners
 * are not: a beginning, no interpolation to the last digit. */
void solid_transfer(const struct solid *from, const double *u, const struct solid *to, double *v);

#endif
