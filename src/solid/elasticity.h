/* Elastic constants of a body of revolution that is transversely isotropic about its axis z. In the order rr, tt, zz, rz, rt, tz
 *   C = [C11 C12 C13; C12 C11 C13; C13 C13 C33] for the first three, C44 for rz and tz, C66 = (C11 - C12)/2 for rt. */
#ifndef ROTID_SOLID_ELASTICITY_H
#define ROTID_SOLID_ELASTICITY_H

#include "rotor/effect.h"
#include "rotor/parameter.h"
#include "rotor/rotor.h"

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

#endif
