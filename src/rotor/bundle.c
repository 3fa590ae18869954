/* Tie rods and bars in torsion and along the axis. */
#include "rotor/rotor.h"

/* From E, the shear modulus, the tension of a rod and its density, which may be derivatives of these. */
static struct bar bundle(const struct tierod *rod, enum mode_type type, int elastic_only, double length, double e, double g,
                         double tension, double rho)
{
    double area, own, pitch, radius = rod->pitch;
    section_rods(rod->number, rod->diameter, radius, &area, &own, &pitch);
    if (type == MODE_AXIAL)
        return (struct bar){e * area, rho * area, length};
    double pulled = elastic_only ? 0 : rod->number * tension * radius * radius;
    return (struct bar){2 * g * own + pulled + 12 * e * own * radius * radius / (length * length),
                        rho * (2 * own + area * radius * radius), length};
}

struct bar bundle_of_tierod(const struct rotor *rotor, enum mode_type type, int elastic_only, int i, double length)
{
    const struct tierod *rod = &rotor->tierod[i];
    const struct effect_bundle f = effects_on_tierod(rotor, i);
    return bundle(rod, type, elastic_only, length, rod->material.e * f.young, material_shear_modulus(&rod->material) * f.young,
                  rod->tension * f.tension, rod->material.rho);
}

struct bar bundle_of_tierod_by(const struct rotor *rotor, enum mode_type type, int elastic_only, int i, double length,
                               struct parameter parameter)
{
    const struct tierod *rod = &rotor->tierod[i];
    struct effect_bundle f = effects_on_tierod(rotor, i), rate = {0, 0, 0};
    double shear = material_shear_modulus(&rod->material);
    if (parameter.kind == PARAMETER_EFFECT) {
        if (!effects_tierod_derivative(rotor, parameter, i, &rate))
            return (struct bar){0, 0, length};
        return bundle(rod, type, elastic_only, length, rod->material.e * rate.young, shear * rate.young,
                      rod->tension * rate.tension, 0);
    }
    if (parameter.kind == PARAMETER_TIEROD_E && parameter.index == i)
        return bundle(rod, type, elastic_only, length, f.young, rod->material.isotropic ? shear / rod->material.e * f.young : 0,
                      0, 0);
    return bundle(rod, type, elastic_only, length, 0, 0,
                  parameter.kind == PARAMETER_TENSION && parameter.index == i ? f.tension : 0, 0);
}

double bundle_of_bars(const struct rotor *rotor, enum mode_type type, int i)
{
    const struct bars *bars = &rotor->bars[i];
    double area, own, pitch;
    section_rods(bars->number, bars->diameter, bars->pitch, &area, &own, &pitch);
    return bars->material.rho * bars->length * (type == MODE_TORSION ? 2 * own + area * bars->pitch * bars->pitch : area);
}
