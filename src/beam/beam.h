/* A rotor as a chain of Timoshenko beam elements: its mesh, and the parameters that may vary. */
#ifndef ROTID_BEAM_BEAM_H
#define ROTID_BEAM_BEAM_H

#include "base/pool.h"
#include "beam/mesh.h"
#include "beam/shear_coefficient.h"
#include "rotid.h"
#include "rotor/parameter.h"
#include "rotor/section.h"

struct hinge { /* of a joint: see beam/hinge.h */
    int effect, element, end;
};

struct section_part { /* of a segment: its own section, or a ring of a layer. In bending all of them turn alike, so EI and mass
                         add; kGS: shear_stiffness */
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

/* u [2 ndof]: v = 1, theta = 0, and v = -z, theta = 1. */
void beam_rigid_motions(const struct beam *beam, double *u);

/* Tie rods, bars, disks and the masses of effects included, at the values of the last beam_assemble. */
void beam_mass_properties(const struct beam *beam, struct mass_properties *properties);

#endif
