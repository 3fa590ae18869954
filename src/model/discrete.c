#include "model/model.h"

#include <float.h>

#include "linalg/linalg.h"

int discretisation_is_solid(enum discretisation as)
{
    return as == AS_SOLID || as == AS_SOLID_TORSION || as == AS_SOLID_AXIAL;
}

static enum mode_type motion_of(enum discretisation as)
{
    return as == AS_BEAM || as == AS_SOLID              ? MODE_BENDING
           : as == AS_TORSION || as == AS_SOLID_TORSION ? MODE_TORSION
                                                        : MODE_AXIAL;
}

int discrete_build(struct pool *pool, enum discretisation as, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, int refine, struct discrete *discrete, int *failed)
{
    const struct solid_rule rule = {.type = motion_of(as)};
    *discrete = (struct discrete){.as = as};
    if (discretisation_is_solid(as))
        return solid_build(pool, rotor, nparameter, parameter, &rule, refine, &discrete->solid, failed);
    int status = beam_build(pool, rotor, nparameter, parameter, refine, &discrete->beam, failed);
    if (as != AS_BEAM && !status)
        status = bar_open(pool, rule.type, &discrete->beam);
    return status;
}

static int is_solid(const struct discrete *discrete)
{
    return discretisation_is_solid(discrete->as);
}

static int is_bar(const struct discrete *discrete)
{
    return discrete->as == AS_TORSION || discrete->as == AS_AXIAL;
}

/* of the motion at a node of the axis of a beam */
static int node_dof(const struct discrete *discrete, int node)
{
    return is_bar(discrete) ? node : 2 * node;
}

const char *discrete_refusal(enum discretisation as, const struct rotor *rotor, int failed)
{
    if (discretisation_is_solid(as))
        return solid_refusal(rotor, failed);
    return failed < rotor->ngroup
               ? "the holes leave nothing of a section of this group, expected fewer or smaller ones"
               : "the rods have no equivalent cylinder (its squared inner diameter would be negative), expected a "
                 "larger pitch radius or MODEL=RODS";
}

int discrete_of_shape(struct pool *pool, const struct discrete *built, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, struct discrete *discrete)
{
    *discrete = (struct discrete){.as = built->as};
    return is_solid(built) ? solid_of_shape(pool, &built->solid, rotor, nparameter, parameter, &discrete->solid)
                           : beam_of_shape(pool, &built->beam, rotor, nparameter, parameter, &discrete->beam);
}

const struct rotor *discrete_rotor(const struct discrete *discrete)
{
    return is_solid(discrete) ? &discrete->solid.rotor : &discrete->beam.rotor;
}

void discrete_structure(const struct discrete *discrete, rotid_matrix *structure)
{
    const struct mesh *beam = &discrete->beam.mesh;
    const struct solid *solid = &discrete->solid;
    *structure = is_solid(discrete)
                     ? (rotid_matrix){.n = solid->mesh.ndof, .kd = solid->mesh.kd, .nfar = solid->nfar, .far = solid->far}
                     : (rotid_matrix){.n = beam->ndof, .kd = beam->kd, .nfar = beam->nfar, .far = beam->far};
}

void discrete_set(struct discrete *discrete, const double *x)
{
    if (is_solid(discrete))
        solid_set(&discrete->solid, x);
    else
        beam_set(&discrete->beam, x);
}

void discrete_assemble(struct discrete *discrete, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    if (is_solid(discrete))
        solid_assemble(&discrete->solid, x, k, m);
    else if (is_bar(discrete))
        bar_assemble(&discrete->beam, x, k, m);
    else
        beam_assemble(&discrete->beam, x, k, m);
}

void discrete_differentiate(const struct discrete *discrete, int p, rotid_matrix *dk, rotid_matrix *dm, int *from, int *end)
{
    *from = 0;
    *end = dk->n;
    if (is_solid(discrete))
        solid_differentiate(&discrete->solid, p, dk, dm, from, end);
    else if (is_bar(discrete))
        bar_differentiate(&discrete->beam, p, dk, dm);
    else
        beam_differentiate(&discrete->beam, p, dk, dm);
}

int discrete_derivative_products(const struct discrete *discrete, int p, int count, const double *u, double *dk_u, double *dm_u,
                                 int *from, int *end)
{
    return is_solid(discrete) ? solid_derivative_products(&discrete->solid, p, count, u, dk_u, dm_u, from, end) : 1;
}

void discrete_mass_properties(const struct discrete *discrete, struct mass_properties *properties)
{
    if (is_solid(discrete))
        solid_mass_properties(&discrete->solid, properties);
    else
        beam_mass_properties(&discrete->beam, properties);
}

void discrete_gyroscopic(const struct discrete *discrete, rotid_matrix *p)
{
    if (is_solid(discrete))
        solid_gyroscopic(&discrete->solid, p);
    else
        beam_gyroscopic(&discrete->beam, p);
}

void discrete_spread(const struct discrete *discrete, int group, double stiffness, rotid_matrix *s)
{
    if (is_solid(discrete))
        solid_spread(&discrete->solid, group, stiffness, s);
    else
        beam_spread(&discrete->beam, group, stiffness, s);
}

void discrete_spring_motion(const struct discrete *discrete, int i, double *v)
{
    rotid_matrix structure;
    discrete_structure(discrete, &structure);
    memset(v, 0, (size_t)structure.n * sizeof *v);
    if (is_solid(discrete))
        solid_spring_motion(&discrete->solid, i, v);
    else
        v[2 * (ptrdiff_t)discrete->beam.mesh.spring_node[i]] = 1;
}

int discrete_rigid_motions(const struct discrete *discrete, double *u)
{
    if (is_solid(discrete))
        solid_rigid_motions(&discrete->solid, u);
    else if (!is_bar(discrete))
        beam_rigid_motions(&discrete->beam, u);
    for (int i = 0; i < discrete->beam.mesh.ndof && is_bar(discrete); i++)
        u[i] = 1;
    return motion_of(discrete->as) == MODE_BENDING ? 2 : 1;
}

/* shape less the part of it that is a rigid motion: r [count n] are the one or two there are, mr M r, products m11, m12, m22 of
 * them */
static void take_rigid_part(int n, int count, const double *r, const double *mr, const double *shape, double *elastic)
{
    double m[3] = {0, 0, 0}, right[2] = {0, 0};
    for (int i = 0; i < n; i++) {
        m[0] += r[i] * mr[i];
        m[1] += r[i] * mr[n + i];
        m[2] += r[n + i] * mr[n + i];
        right[0] += mr[i] * shape[i];
        right[1] += mr[n + i] * shape[i];
    }
    if (count < 2) /* the second one is zero */
        m[2] = 1;
    double det = m[0] * m[2] - m[1] * m[1];
    double a = (m[2] * right[0] - m[1] * right[1]) / det, b = (m[0] * right[1] - m[1] * right[0]) / det;
    for (int i = 0; i < n; i++)
        elastic[i] = shape[i] - a * r[i] - b * r[n + i];
}

/* What u'K u may lose in the rounding of the entries of K, where u is a rigid motion: their terms cancel */
static double rounding_of(const rotid_matrix *k, const double *u)
{
    double sum = 0;
    for (int i = 0; i < k->n; i++)
        sum += fabs(k->band[(ptrdiff_t)i * (k->kd + 1)]) * u[i] * u[i];
    for (int i = 0; i < k->nfar; i++)
        sum += fabs(k->block[(ptrdiff_t)i * (k->nfar + 1)]) * u[k->far[i]] * u[k->far[i]];
    return DBL_EPSILON * sum;
}

#define ROUNDING   1e-2 /* of the first elastic eigenvalue: half of a per cent of its frequency */
#define NO_SUPPORT 1e-9 /* of the same, in the energy of a rigid motion: 3e-5 of its frequency is at rest */

/* The elastic energy of a motion is that of what is left of it without the rigid motions, which are known exactly: those in K
 * lose it in the rounding of its entries, where elements are small beside the rotor. */
static int count_rigid(struct pool *pool, struct discrete *discrete, const double *x, int nmodes, const double *modes,
                       int *nrigid)
{
    rotid_matrix structure, k, elastic_k, m;
    discrete_structure(discrete, &structure);
    int n = structure.n, wanted = n < 4 ? n : 4, all = discrete_rotor(discrete)->count_all;
    int *elastic_only = is_solid(discrete) ? &discrete->solid.elastic_only : &discrete->beam.elastic_only;
    struct eigen_full eigen;
    double lambda[4], *phi = POOL_ARRAY(pool, double, (size_t)wanted *(size_t)n), *work = POOL_ARRAY(pool, double, 6 * (size_t)n);
    int status = phi && work ? matrix_like(pool, &structure, &k) : ROTID_ERROR_MEMORY;
    if (!status)
        status = matrix_like(pool, &structure, &elastic_k);
    if (!status)
        status = matrix_like(pool, &structure, &m);
    if (!status)
        status = eigen_full_new(pool, &k, wanted, &eigen);
    if (status)
        return status;
    if (nmodes >= wanted)
        eigen_full_begin(&eigen, modes);
    discrete_assemble(discrete, x, &k, &m);
    status = eigen_full_solve(&eigen, &k, &m, lambda, phi);
    if (status)
        return status;
    double *rigid = work + n, *mass_rigid = work + 3 * (ptrdiff_t)n, *elastic = work + 5 * (ptrdiff_t)n;
    int free = discrete_rigid_motions(discrete, rigid); /* the mode behind as many is always elastic */
    matrix_multiply(&m, 2, rigid, mass_rigid);
    matrix_zero(&elastic_k);
    matrix_zero(&m);
    *elastic_only = 1;
    discrete_assemble(discrete, x, &elastic_k, &m);
    *elastic_only = 0;
    double rounding = 0;
    for (int j = 0; j < free; j++) { /* a rigid motion bends nothing: what it has is the rounding of K */
        const double *r = rigid + (ptrdiff_t)j * n;
        double bends = matrix_product(&elastic_k, r, r, work);
        rounding = fmax(rounding, fabs(bends) / product_dot(n, r, mass_rigid + (ptrdiff_t)j * n));
    }
    if (rounding > ROUNDING * lambda[2])
        return ROTID_ERROR_STIFFNESS;
    *nrigid = 0;
    for (int j = 0; j < free && j < wanted; j++) {
        take_rigid_part(n, free, rigid, mass_rigid, phi + (ptrdiff_t)j * n, elastic);
        double first = lambda[free < wanted ? free : wanted - 1], energy = matrix_product(&elastic_k, elastic, elastic, work);
        if (energy > fmax(1e-6 * first, rounding) && energy > 0.5 * lambda[j]) {
            if (lambda[j] < 0) /* it bends, and gives way: compression turns a free rotor over */
                return ROTID_ERROR_STIFFNESS;
            break;
        }
        for (int i = 0; i < n && all; i++) /* what is left is the motion on the supports: without any K is the elastic one, but
                                              for axial forces that balance each other within rounding */
            elastic[i] = phi[i + (ptrdiff_t)j * n] - elastic[i];
        if (all && matrix_product(&k, elastic, elastic, work) - matrix_product(&elastic_k, elastic, elastic, work) >
                       fmax(NO_SUPPORT * first, rounding_of(&k, elastic)))
            break;
        (*nrigid)++;
    }
    return ROTID_OK;
}

int discrete_count_rigid(const struct pool *pool, struct discrete *discrete, const double *x, int nmodes, const double *modes,
                         int *nrigid)
{
    struct pool scratch; /* a solution takes ten times what the model does */
    pool_open(&scratch, pool->allocator);
    int status = count_rigid(&scratch, discrete, x, nmodes, modes, nrigid);
    pool_close(&scratch);
    return status;
}

int discrete_places(const struct discrete *discrete)
{
    return is_solid(discrete) ? 2 * discrete->solid.mesh.nslice + 1 : discrete->beam.mesh.naxis;
}

const double *discrete_place_z(const struct discrete *discrete)
{
    return is_solid(discrete) ? discrete->solid.mesh.surface_z : discrete->beam.mesh.z;
}

int discrete_place_dof(const struct discrete *discrete, int i)
{
    const struct solid_mesh *mesh = &discrete->solid.mesh;
    return is_solid(discrete) ? mesh->node[mesh->surface[i]].dof[mesh->type] : node_dof(discrete, i);
}

int discrete_sensor_dof(const struct discrete *discrete, int sensor)
{
    return is_solid(discrete) ? discrete->solid.mesh.sensor_dof[sensor]
                              : node_dof(discrete, discrete->beam.mesh.sensor_node[sensor]);
}

double discrete_sensor_z(const struct discrete *discrete, int sensor)
{
    const struct mesh *beam = &discrete->beam.mesh;
    return is_solid(discrete) ? discrete->solid.rotor.sensor[sensor].position : beam->z[beam->sensor_node[sensor]];
}

int discrete_place_joints(struct pool *pool, struct discrete *discrete)
{
    return is_solid(discrete) ? ROTID_OK : hinge_place(pool, &discrete->beam); /* a beam's hinges go with its mesh */
}

int discrete_member_elements(const struct discrete *discrete, int i)
{
    const struct mesh *beam = &discrete->beam.mesh;
    int bars = i - discrete_rotor(discrete)->ntierod, from, to;
    if (is_solid(discrete)) {
        solid_mesh_member(&discrete->solid.rotor, &discrete->solid.mesh, i, &from, &to);
        return to - from;
    }
    return bars < 0 ? chain_elements(&beam->tierod[i]) : 2 * chain_elements(&beam->bars[2 * (ptrdiff_t)bars]);
}

void discrete_member_deflection(const struct discrete *discrete, int i, const double *u, int npoint, double *z, double *v)
{
    int bars = i - discrete->beam.rotor.ntierod;
    if (is_solid(discrete))
        members_deflection(&discrete->solid, i, u, npoint, z, v);
    else if (is_bar(discrete))
        bar_member_motion(&discrete->beam, i, u, npoint, z, v);
    else if (bars < 0)
        tierod_deflection(&discrete->beam, i, u, npoint, z, v);
    else
        bars_deflection(&discrete->beam, bars, u, npoint, z, v);
}

#define OF_CORNER                                                                                                                \
    0.1656 /* 1/(6^1.089 - 1): corners six times as large, of a right angle. Beside refined meshes: 0.08 to 0.28                 \
            */
#define OF_FINER       0.284      /* 1/(4^1.089 - 1) */
#define OF_TWIST       0.1009     /* 1/(6^(4/3) - 1): torsion has the exponent 2/3 at a right angle */
#define OF_FINER_TWIST 0.1871     /* 1/(4^(4/3) - 1) */
#define OF_SMOOTH      (1.0 / 15) /* 1/(2^4 - 1): a frequency by elements of the second order, all twice as large */
#define OF_EDGE        (1.0 / 3)  /* 1/(2^2 - 1): where the zone at an end, r sqrt(G/E) long, is shorter than an element */
#define OF_BORE        6.0        /* times that, at most: beside graded elements (8 bodies, bores of 1 to 20 %) 0.5 to 5.3 */
#define RESOLVED       10.0 /* E/G up to which it is not; beside spectral elements (65 bodies) 0.13 at 20, 0.2 to 0.4 beyond 60 */
#define COMPRESSIBLE                                                                                                             \
    4.0 /* C11/C66 up to which elements follow a change of volume; beside spectral elements (24 bodies) they leave 1.1 to 2.2    \
           times as much at 26 (nu 0.48), 1.9 to 4.5 at 500, 2.5 to 5.8 at 5000 */

/* Materials that differ have a singular edge at the surface: up to OF_SMOOTH E/E, at most this, or OF_CORNER times the fourth
 * root, at most MORE; most often less, so that frequencies stay as they are. */
#define OF_INTERFACE 1.5
#define MORE         2.4

/* How many times OF_SMOOTH a material leaves. */
static double share_of(const struct material *m, int twist)
{
    double stiff = m->laminated ? fmax(m->e, m->stacking * m->sheet_e) : m->e; /* a disc of sheets bends in its plane */
    struct elasticity c = elasticity_of(m, &(struct elasticity_factors){1, 1, 1});
    double shear = stiff / c.c44 / RESOLVED;
    return twist ? shear : fmax(shear, pow(c.c11 / c.c66 / COMPRESSIBLE, 0.25));
}

/* The same of all materials, 1 at least. */
static double largest_share(const struct rotor *rotor, int twist)
{
    double most = 1;
    for (int i = 0; i < rotor->ngroup; i++)
        most = fmax(most, share_of(&rotor->group[i].material, twist));
    return most;
}

/* E of the stiffest over that of the softest material */
static double contrast(const struct rotor *rotor)
{
    double least = rotor->group[0].material.e, most = least;
    for (int i = 1; i < rotor->ngroup; i++) {
        least = fmin(least, rotor->group[i].material.e);
        most = fmax(most, rotor->group[i].material.e);
    }
    return most / least;
}

/* A beam's error falls as the square of the size of its elements, and is left to it. A solid's comes from the re-entrant corners,
 * which no mesh of a reasonable size resolves; where there are none, from the elements. */
struct mesh_limit discrete_mesh_limit(enum discretisation as, const struct rotor *rotor)
{
    if (!discretisation_is_solid(as))
        return (struct mesh_limit){2, -4.0 / 3, 0, 0, 0, 1};
    int twist = as == AS_SOLID_TORSION;
    if (!outline_has_corners(rotor)) {
        double share = fmin(OF_SMOOTH * largest_share(rotor, twist), OF_EDGE);
        double bore = outline_has_small_bore(rotor) ? OF_BORE : 1;
        double most = twist ? share : fmax(bore * share, fmin(OF_SMOOTH * contrast(rotor), OF_INTERFACE));
        return (struct mesh_limit){COARSE_MESH, share, 1, 4, share, most / share};
    }
    double more = twist ? 1 : fmax(largest_share(rotor, twist), as == AS_SOLID ? pow(contrast(rotor), 0.25) : 1);
    double share = twist ? OF_TWIST : OF_CORNER, finer = twist ? OF_FINER_TWIST : OF_FINER;
    return (struct mesh_limit){COARSE_MESH, share, 1, 4, finer, fmin(more, MORE)};
}

double discrete_passage(const struct discrete *discrete)
{
    const struct rotor *rotor = &discrete->solid.rotor;
    double longest = is_solid(discrete) && outline_has_corners(rotor) ? solid_longest_passage(&discrete->solid) : 0;
    return longest * pow(largest_share(rotor, discrete->as == AS_SOLID_TORSION), 0.25);
}

double discrete_members_error(const struct discrete *discrete, const double *u, double lambda)
{
    return is_solid(discrete) ? members_mesh_error(&discrete->solid, u, lambda) : 0;
}

int discrete_transfer(const struct discrete *from, const double *u, const struct discrete *to, double *v)
{
    if (from->as != to->as)
        return 0;
    if (is_solid(from))
        solid_transfer(&from->solid, u, &to->solid, v);
    else if (!is_bar(from) && to->beam.mesh.nelement > from->beam.mesh.nelement)
        beam_prolong(&from->beam, u, &to->beam.mesh, v);
    else
        return 0;
    return 1;
}
