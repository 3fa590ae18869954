/* The rotor as ROSS can hold it. A ShaftElement of ROSS is the element of rotid (Genta's with v cubic and the same shear factor),
 * so most rotors go over as they are. What ROSS has no element for is replaced here, in a beam of its own:
 *   inner nodes of tie rods   one element from end to end, exact at rest but for modes of the rods themselves
 *   bars                      a disk at their centre: they move with the node there, without bending
 * The frequencies of that beam are what the script is to give; their distance from those of the deck is the price. */
#ifndef ROTID_EXPORT_ROSS_MODEL_H
#define ROTID_EXPORT_ROSS_MODEL_H

#include "beam/lumped.h"
#include "beam/quantities.h"
#include "export/model.h"

/* A round section and the material that give EI, kGS, rhoS and rhoI of an element by the formulas of ROSS. */
struct ross_section {
    double outer, inner;    /* m */
    double e, g, nu, rho;   /* g with the shear coefficient of the section at nu gives kGS */
    const char *equivalent; /* why diameters or material are not those of the deck, else NULL */
};

/* Bending matrices of an element whose own do not follow from a section: a joint or a mass lies in it. Order and signs of ROSS: x
 * and beta = dx/dz, left then right. */
struct ross_matrices {
    double k[16], m[16];
    double rotary[16]; /* the part of m that stems from the rotation of the sections: twice that is the gyroscopic matrix */
    double added;      /* kg, lumped masses in it */
    const char *why;
};

struct ross_model {
    const struct export_model *model;
    struct rotor_model *discrete;    /* the beam of the script: that of the model where nothing had to be replaced */
    const struct spectrum *spectrum; /* its frequencies */
    double *deck_hz; /* [spectrum->count] of the deck's own model for each of them, NaN without a partner; NULL: the same */
};

/* Lists in `notes` the replaced parts with the error that each replacement causes, and the parts that hold at rest only.
 * Statuses of model_open and spectrum_compute. */
int ross_open(struct pool *pool, const struct export_model *model, struct message_list *notes, struct ross_model *ross);

/* Of an element of the axis. ROTID_OK or ROTID_ERROR_MEMORY. */
int ross_axis_section(struct pool *pool, const struct beam *beam, int e, struct ross_section *section);
/* Of a bundle of tie rods, all rods together, and what its ends feel of their stretching. */
void ross_tierod_section(const struct beam *beam, int tierod, struct ross_section *section, struct stretch *stretch);
/* The node at which a lumped mass sits as if it were a disk, -1 where it is a matter of its element. */
int ross_mass_node(const struct beam *beam, const struct lumped *lumped);
/* 1 where element e has such matrices, else 0; a negative status. */
int ross_matrices(struct pool *pool, const struct beam *beam, int e, struct ross_matrices *matrices);

#endif
