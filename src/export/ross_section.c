#include <math.h>

#include "beam/factors.h"
#include "export/ross_model.h"
#include "rotor/effects.h"

static const double pi = 3.14159265358979323846;

#define SAME 1e-12 /* relative: what differs by less is equal but for rounding */

static double area_of(const struct ross_section *s)
{
    return pi * (s->outer * s->outer - s->inner * s->inner) / 4;
}

/* S and I of the mass give (outer^2 + inner^2)/16 = I/S. The outer diameter of the section is kept where that leaves an inner
 * one, else the section is solid. */
static void choose_diameters(int rectangular, const struct element *element, struct ross_section *s)
{
    double sum = 16 * element->rhoi / element->rhos, squared = sum - s->outer * s->outer;
    if (!rectangular && fabs(squared - s->inner * s->inner) <= SAME * sum)
        return;
    if (rectangular || squared < 0) {
        s->outer = sqrt(sum);
        s->inner = 0;
    } else {
        s->inner = sqrt(squared);
    }
}

/* E, G and rho that give the quantities of the element with the diameters of s */
static void choose_material(const struct element *element, double nu, struct ross_section *s)
{
    double area = area_of(s), inertia = area * (s->outer * s->outer + s->inner * s->inner) / 16;
    s->nu = nu;
    s->e = element->ei / inertia;
    s->g = element->kgs / (rotid_shear_coefficient_annulus(nu, s->inner / s->outer) * area);
    s->rho = element->rhos / area;
}

static const char *add_reason(struct pool *pool, const char *reasons, const char *reason)
{
    return reasons && reason ? pool_format(pool, "%s%s%s", reasons, *reasons ? ", " : "", reason) : NULL;
}

/* What makes the element other than its card says: NULL without memory, "" for nothing. */
static const char *reasons_of(struct pool *pool, const struct beam *beam, int e)
{
    const struct rotor *rotor = &beam->rotor;
    const struct segment *segment = &rotor->segment[beam->mesh.segment[e]];
    const struct section_part *part;
    struct effect_field *unused;
    int count = factors_parts(beam, e, &part, &unused), holes = 0, sheets = 0;
    const char *reasons = "";
    for (int i = 0; i < count; i++) {
        holes |= rotor->group[part[i].group].holes;
        sheets |= rotor->group[part[i].group].material.laminated;
    }
    if (segment->rectangular)
        reasons = add_reason(pool, reasons, "rectangular, bending in the measured plane only");
    for (int i = 1; i < count; i++)
        reasons = add_reason(pool, reasons, pool_format(pool, "layer %s", rotor->group[part[i].group].name));
    if (sheets)
        reasons = add_reason(pool, reasons, "sheets across the axis");
    if (holes)
        reasons = add_reason(pool, reasons, "perforated");
    if (!segment->rectangular && segment->stiff_outer != segment->outer)
        reasons = add_reason(pool, reasons, "stiffness diameter");
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        int acts = 0;
        for (int j = 0; j < count; j++) {
            const struct effect_span span = factors_span(beam, e, &part[j]);
            struct effect_field f = {1, 1, 1};
            acts |= effect_on_axis(effect, rotor, &span, 1, -1, &f) && (f.e != 1 || f.g != 1 || f.rho != 1);
        }
        if (acts)
            reasons = add_reason(pool, reasons, effect->name);
    }
    return reasons;
}

int ross_axis_section(struct pool *pool, const struct beam *beam, int e, struct ross_section *s)
{
    const struct segment *segment = &beam->rotor.segment[beam->mesh.segment[e]];
    const struct material *material = &beam->rotor.group[segment->group].material;
    const char *reasons = reasons_of(pool, beam, e);
    struct element element;
    if (!reasons)
        return ROTID_ERROR_MEMORY;
    *s = (struct ross_section){segment->outer, segment->inner, material->e, material_shear_modulus(material),
                               material->nu,   material->rho,  NULL};
    if (*reasons) {
        s->equivalent = reasons;
        axis_quantities(beam, e, &element);
        if (!segment->rectangular)
            rotor_diameters(&beam->rotor, beam->mesh.segment[e], &s->outer, &s->inner);
        choose_diameters(segment->rectangular, &element, s);
        choose_material(&element, material->nu, s);
    }
    return ROTID_OK;
}

void ross_tierod_section(const struct beam *beam, int tierod, struct ross_section *s, struct stretch *stretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    double area, own, pitch, young = effects_on_tierod(&beam->rotor, tierod).young, rods = 1;
    struct element unused;
    tierod_quantities(beam, tierod, 1, &unused, stretch);
    section_rods(rod->number, rod->diameter, rod->pitch, &area, &own, &pitch);
    *s = (struct ross_section){.outer = rod->diameter};
    if (stretch->stiffness > 0)
        rods = rod->number; /* one rod with the moduli and the density of all */
    else
        (void)rotid_equivalent_cylinder(area, own + pitch, NULL, &s->outer, &s->inner); /* the beam has it, so it exists */
    s->e = rods * young * rod->material.e;
    s->g = rods * young * material_shear_modulus(&rod->material);
    s->nu = rod->material.nu;
    s->rho = rods * rod->material.rho;
}
