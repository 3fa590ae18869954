#include "solid/solid.h"

struct constants { /* engineering constants; as a direction: their derivatives */
    double ep, np, ea, na, g;
};

static struct constants constants_of(const struct material *material, const struct elasticity_factors *f)
{
    double axial = f->e * f->axial;
    if (material->laminated)
        return (struct constants){material->stacking * material->sheet_e, material->nu, material->e * axial,
                                  material->nu * material->e * axial / material->sheet_e, material->g * f->g};
    return (struct constants){material->e * f->e, material->nu, material->e * axial, material->nu * f->axial,
                              material_shear_modulus(material) * f->g};
}

/* With a = na^2 ep/ea and D = 1 - np - 2 a:
 *   C11, C12 = ep (1 - a)/((1 + np) D), ep (np + a)/((1 + np) D),  C13 = ep na/D,  C33 = ea (1 - np)/D */
static struct elasticity stiffness(const struct constants *c)
{
    double a = c->na * c->na * c->ep / c->ea, d = 1 - c->np - 2 * a, plane = c->ep / ((1 + c->np) * d);
    return (struct elasticity){.c11 = plane * (1 - a),
                               .c12 = plane * (c->np + a),
                               .c13 = c->ep * c->na / d,
                               .c33 = c->ea * (1 - c->np) / d,
                               .c44 = c->g,
                               .c66 = c->ep / (2 * (1 + c->np))};
}

static struct elasticity derivative(const struct constants *c, const struct constants *v)
{
    double a = c->na * c->na * c->ep / c->ea, d = 1 - c->np - 2 * a, q = 1 + c->np, plane = c->ep / (q * d);
    double da = (2 * c->na * v->na * c->ep + c->na * c->na * v->ep - a * v->ea) / c->ea, dd = -v->np - 2 * da;
    double dplane = v->ep / (q * d) - plane * (v->np / q + dd / d);
    return (struct elasticity){.c11 = dplane * (1 - a) - plane * da,
                               .c12 = dplane * (c->np + a) + plane * (v->np + da),
                               .c13 = (v->ep * c->na + c->ep * v->na - c->ep * c->na * dd / d) / d,
                               .c33 = (v->ea * (1 - c->np) - c->ea * v->np - c->ea * (1 - c->np) * dd / d) / d,
                               .c44 = v->g,
                               .c66 = (v->ep - c->ep * v->np / q) / (2 * q)};
}

struct elasticity elasticity_of(const struct material *material, const struct elasticity_factors *factors)
{
    struct constants c = constants_of(material, factors);
    return stiffness(&c);
}

struct elasticity elasticity_by_material(const struct material *material, const struct elasticity_factors *f,
                                         enum parameter_kind kind)
{
    struct constants c = constants_of(material, f), v = {0, 0, 0, 0, 0};
    if (kind == PARAMETER_E) {
        v.ea = c.ea / material->e;
        if (material->laminated)
            v.na = c.na / material->e;
        else
            v.ep = c.ep / material->e;
        if (material->isotropic)
            v.g = c.g / material->e;
    } else if (kind == PARAMETER_G) {
        v.g = material->isotropic ? 0 : f->g;
    } else if (kind == PARAMETER_NU) {
        v.np = 1;
        v.na = material->laminated ? material->e * f->e * f->axial / material->sheet_e : f->axial;
        if (material->isotropic)
            v.g = -c.g / (1 + material->nu);
    }
    return derivative(&c, &v);
}

struct elasticity elasticity_by_factors(const struct material *material, const struct elasticity_factors *f,
                                        const struct elasticity_factors *d)
{
    struct constants c = constants_of(material, f), v = {0, 0, 0, 0, 0};
    double axial = d->e / f->e + d->axial / f->axial; /* relative */
    v.ea = c.ea * axial;
    v.na = c.na * (material->laminated ? axial : d->axial / f->axial);
    v.ep = material->laminated ? 0 : c.ep * d->e / f->e;
    v.g = c.g * d->g / f->g;
    return derivative(&c, &v);
}
