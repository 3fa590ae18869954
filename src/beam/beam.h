/* The built-in model: a rotor, its mesh, and the parameters that may vary. */
#ifndef ROTID_BEAM_BEAM_H
#define ROTID_BEAM_BEAM_H

#include "base/pool.h"
#include "beam/effect.h"
#include "beam/mesh.h"
#include "beam/rotor.h"
#include "beam/section.h"
#include "rotid.h"

enum parameter_kind {
    PARAMETER_E,
    PARAMETER_G,
    PARAMETER_NU,
    PARAMETER_RHO,
    PARAMETER_TIEROD_E,
    PARAMETER_TENSION,
    PARAMETER_SPRING_K,
    PARAMETER_SPRING_K_ROT,
    PARAMETER_DISK_MASS,
    PARAMETER_DISK_INERTIA,
    PARAMETER_EFFECT
};

struct parameter {
    enum parameter_kind kind;
    int index;     /* of the group, tie rod, spring, disk or effect */
    int component; /* of the effect, else 0 */
};

struct hinge { /* of a joint: see beam/hinge.h */
    int effect, element, end;
};

struct beam {
    struct rotor rotor;      /* own copy of everything a parameter can change */
    struct section *section; /* [nsegment] */
    struct section *tube;    /* [ntierod + nbars] equivalent cylinders where the model is TUBE */
    struct mesh mesh;
    struct effect_factors *factor; /* [nelement] products over all effects, of the last beam_assemble; NULL without effects */
    int nhinge;
    struct hinge *hinge; /* [nhinge] */
    int nparameter;
    const struct parameter *parameter; /* [nparameter] */
    int elastic_only;                  /* leaves springs and axial forces out of K: what bends the rotor itself */
};

/* Finds "group.E", "group.G", ".nu", ".rho", "tierod.E", ".tension", "spring.k", ".k_rot", "disk.mass", ".inertia", and the
 * parameters of effects that have a name, "cause.depth". Returns 0 and *parameter, 1 when no object has that name, 2 when the
 * object has no such parameter; *unit is set with 0. */
int parameter_find(const struct rotor *rotor, const char *name, struct parameter *parameter, const char **unit);

/* Its value in the rotor, to read or to set. G of an isotropic material is not stored: give the group a G of its own first. */
double *parameter_value(const struct rotor *rotor, struct parameter parameter);

/* The beam of a rotor, with end springs from the sling added (44). `parameter` [nparameter] is kept. refine >= 1 cuts every
 * element. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group in *failed (groups, then tie rods, then bars). */
int beam_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
               struct beam *beam, int *failed);

/* K and M at the values x of the parameters, which stay in beam->rotor. x may be NULL where nparameter is 0. */
void beam_assemble(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m);

/* dK/dx_p and dM/dx_p at the values of the last beam_assemble. */
void beam_differentiate(const struct beam *beam, int p, rotid_matrix *dk, rotid_matrix *dm);

struct mass_properties {
    double mass, center; /* kg, m from the left end */
    double inertia;      /* kg.m2 about a diameter through the centre */
};

/* Tie rods, bars, disks and the masses of effects included, at the values of the last beam_assemble. */
void beam_mass_properties(const struct beam *beam, struct mass_properties *properties);

/* How many of the lowest modes are rigid-body or suspension modes: at most two, those at zero or with most of their potential
 * energy in springs and axial forces instead of bending. Statuses of eigen_band_solve. */
int beam_count_rigid(struct pool *pool, struct beam *beam, const double *x, int *nrigid);

#endif
