#include "beam/quantities.h"

#include "beam/factors.h"
#include "beam/shear_coefficient.h"
#include "rotor/effects.h"

static double middle_of(const struct mesh *mesh, int e)
{
    return (mesh->z[e] + mesh->z[e + 1]) / 2;
}

/* what material and section give, of length 0 and without force */
static struct element of_material(const struct material *material, const struct section *section)
{
    struct shear_resistance shear;
    shear_resistance(section, material, &shear);
    return (struct element){.ei = material->e * section->stiff_inertia,
                            .kgs = shear.kg * section->stiff_area,
                            .rhos = material->rho * section->mass_area,
                            .rhoi = material->rho * section->mass_inertia};
}

/* with the factors of e, g and rho, where there are any */
static void add_part(struct element part, const struct effect_field *factor, struct element *sum)
{
    sum->ei += factor ? part.ei * factor->e : part.ei;
    sum->kgs += factor ? part.kgs * factor->g : part.kgs;
    sum->rhos += factor ? part.rhos * factor->rho : part.rhos;
    sum->rhoi += factor ? part.rhoi * factor->rho : part.rhoi;
}

void axis_quantities(const struct beam *beam, int e, struct element *element)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    const struct section_part *part;
    struct effect_field *factor;
    int count = factors_parts(beam, e, &part, &factor);
    *element = (struct element){.force = beam->elastic_only ? 0 : rotor_axial_force(rotor, part->group, middle_of(mesh, e)),
                                .length = mesh->z[e + 1] - mesh->z[e]};
    for (int i = 0; i < count; i++)
        add_part(of_material(&rotor->group[part[i].group].material, &part[i].section), factor ? &factor[i] : NULL, element);
}

static int material_direction(const struct material *material, const struct section *section, enum parameter_kind kind,
                              struct element *d)
{
    struct shear_resistance shear;
    shear_resistance(section, material, &shear);
    switch (kind) {
    case PARAMETER_E:
    case PARAMETER_TIEROD_E:
        d->ei = section->stiff_inertia;
        d->kgs = shear.by_e * section->stiff_area;
        return 1;
    case PARAMETER_G:
        d->kgs = shear.by_g * section->stiff_area;
        return 1;
    case PARAMETER_NU:
        d->kgs = shear.by_nu * section->stiff_area;
        return 1;
    case PARAMETER_RHO:
        d->rhos = section->mass_area;
        d->rhoi = section->mass_inertia;
        return 1;
    default:
        return 0;
    }
}

static int effect_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d)
{
    const struct section_part *part;
    struct effect_field *factor;
    int moves = 0;
    for (int i = 0, count = factors_parts(beam, e, &part, &factor); i < count; i++) {
        struct effect_span span = factors_span(beam, e, &part[i]);
        struct effect_field rate = {0, 0, 0};
        struct element now = {0};
        if (!effects_axis_rate(&beam->rotor, parameter, &span, 1, &rate))
            continue;
        add_part(of_material(&beam->rotor.group[part[i].group].material, &part[i].section), factor ? &factor[i] : NULL, &now);
        add_part(now, &rate, d);
        moves = 1;
    }
    d->force = rotor_axial_force_derivative(&beam->rotor, parameter, middle_of(&beam->mesh, e));
    return moves || d->force != 0;
}

int axis_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d)
{
    const struct rotor *rotor = &beam->rotor;
    const struct section_part *part;
    struct effect_field *factor;
    int moves = 0, count = factors_parts(beam, e, &part, &factor);
    *d = (struct element){0};
    if (parameter.kind == PARAMETER_EFFECT)
        return effect_direction(beam, parameter, e, d);
    if (parameter.kind == PARAMETER_TENSION) {
        d->force = rotor_axial_force_derivative(rotor, parameter, middle_of(&beam->mesh, e));
        return d->force != 0;
    }
    for (int i = 0; i < count && parameter.kind <= PARAMETER_RHO; i++) {
        struct element own = {0};
        if (!parameter_is_of_group(&parameter, part[i].group))
            continue;
        moves |= material_direction(&rotor->group[part[i].group].material, &part[i].section, parameter.kind, &own);
        add_part(own, factor ? &factor[i] : NULL, d);
    }
    return moves;
}

static struct section bundle_section(enum bundle_model model, int number, double diameter, double pitch,
                                     const struct section *tube, double *pitch_inertia)
{
    double area, own;
    section_rods(number, diameter, pitch, &area, &own, pitch_inertia);
    if (model == BUNDLE_TUBE)
        return *tube;
    return (struct section){area, own, area, own, 0, 0};
}

static struct element bundle_element(const struct material *material, const struct section *section, double length)
{
    struct element element = of_material(material, section);
    element.length = length;
    return element;
}

static double tierod_length(const struct beam *beam, int tierod)
{
    const struct chain *chain = &beam->mesh.tierod[tierod];
    return beam->mesh.z[chain->last_end] - beam->mesh.z[chain->first_end];
}

/* the model that holds, effects considered, with its section */
static enum bundle_model tierod_section(const struct beam *beam, int tierod, const struct effect_bundle *factor,
                                        struct section *section, double *pitch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    enum bundle_model model = factor->as_rods ? BUNDLE_RODS : rod->model;
    *section = bundle_section(model, rod->number, rod->diameter, rod->pitch, &beam->tube[tierod], pitch);
    return model;
}

void tierod_quantities(const struct beam *beam, int tierod, double length, struct element *element, struct stretch *stretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    struct effect_bundle factor = effects_on_tierod(&beam->rotor, tierod);
    struct section section;
    double pitch, whole = tierod_length(beam, tierod);
    enum bundle_model model = tierod_section(beam, tierod, &factor, &section, &pitch);
    *element = bundle_element(&rod->material, &section, length);
    element->ei *= factor.young;
    element->kgs *= factor.young;
    element->force = beam->elastic_only ? 0 : rod->number * rod->tension * factor.tension;
    *stretch = (struct stretch){0, 0};
    if (model == BUNDLE_RODS)
        *stretch = (struct stretch){rod->material.e * factor.young * pitch / whole, rod->material.rho * pitch * whole};
}

static int tierod_effect_direction(const struct beam *beam, struct parameter parameter, int tierod, struct element *d,
                                   struct stretch *dstretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    struct effect_bundle factor = effects_on_tierod(&beam->rotor, tierod), rate = {0, 0, 0};
    struct section section;
    double pitch;
    if (!effects_tierod_derivative(&beam->rotor, parameter, tierod, &rate))
        return 0;
    enum bundle_model model = tierod_section(beam, tierod, &factor, &section, &pitch);
    struct element base = bundle_element(&rod->material, &section, 1);
    *d = (struct element){
        .ei = base.ei * rate.young, .kgs = base.kgs * rate.young, .force = rod->number * rod->tension * rate.tension};
    if (model == BUNDLE_RODS)
        dstretch->stiffness = rod->material.e * rate.young * pitch / tierod_length(beam, tierod);
    return 1;
}

int tierod_direction(const struct beam *beam, struct parameter parameter, int tierod, struct element *d, struct stretch *dstretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    *d = (struct element){0};
    *dstretch = (struct stretch){0, 0};
    if (parameter.kind == PARAMETER_EFFECT)
        return tierod_effect_direction(beam, parameter, tierod, d, dstretch);
    if (parameter.index != tierod || (parameter.kind != PARAMETER_TENSION && parameter.kind != PARAMETER_TIEROD_E))
        return 0;
    struct effect_bundle factor = effects_on_tierod(&beam->rotor, tierod);
    if (parameter.kind == PARAMETER_TENSION) {
        d->force = rod->number * factor.tension;
        return 1;
    }
    struct section section;
    double pitch;
    if (tierod_section(beam, tierod, &factor, &section, &pitch) == BUNDLE_RODS)
        dstretch->stiffness = factor.young * pitch / tierod_length(beam, tierod);
    material_direction(&rod->material, &section, parameter.kind, d);
    d->ei *= factor.young;
    d->kgs *= factor.young;
    return 1;
}

void bars_quantities(const struct beam *beam, int index, double length, struct element *element, double *inertia)
{
    const struct bars *bars = &beam->rotor.bars[index];
    double pitch;
    struct section section =
        bundle_section(bars->model, bars->number, bars->diameter, bars->pitch, &beam->tube[beam->rotor.ntierod + index], &pitch);
    *element = bundle_element(&bars->material, &section, length);
    *inertia = bars->model == BUNDLE_RODS ? bars->material.rho * pitch * bars->length : 0;
}
