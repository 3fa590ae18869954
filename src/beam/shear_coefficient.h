/* The shear stiffness kGS of a section in the averages of Cowper (1966): of one material by its coefficient k, of concentric
 * layers by the flexure function over the radius. */
#ifndef ROTID_BEAM_SHEAR_COEFFICIENT_H
#define ROTID_BEAM_SHEAR_COEFFICIENT_H

#include "rotor/parameter.h"
#include "rotor/section.h"

/* What a material resists shear with. x = nu_a G/E, nu_a being the contraction of the plane by axial stress: nu/(2 (1 + nu)) of
 * an isotropic material, and of one that states E, G and nu, whose k is that of the isotropic material of this nu; nu G/E_sheet
 * of a stack of sheets, which axial stress strains as it strains a sheet. As a direction: their derivatives. */
struct shear_material {
    double e, g, x; /* Pa, Pa, - */
};
struct shear_material shear_material_of(const struct material *material);
struct shear_material shear_material_derivative(const struct material *material, enum parameter_kind kind);

struct shear_layer {
    struct shear_material material; /* with the factors of causes */
    const struct section *section;
    struct shear_material by; /* out: derivatives of kGS by the values of the material */
    double pivot, off, w, z;  /* workspace */
};

/* kGS [N] of a section of `count` >= 1 parts that touch, layer [count + 1] from the axis outwards, the last one workspace. One
 * part may have any section, several are round. At fixed x, kGS is of degree 1 in all G together and of degree 0 in all E. */
double shear_stiffness(int count, struct shear_layer *layer);

/* The same of one section of one material, without derivatives. */
double shear_stiffness_plain(const struct section *section, const struct material *material);

#endif
