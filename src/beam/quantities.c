#include "beam/beam.h"

/* EI and mass of a part, with the factors of e, g and rho where there are any; kGS is not a sum, nor is all of EI */
static void add_part(const struct material *material, const struct section *section, const struct effect_field *factor,
                     struct element *sum)
{
    sum->ei += material->e * section->stiff_inertia * (factor ? factor->e : 1);
    sum->rhos += material->rho * section->mass_area * (factor ? factor->rho : 1);
    sum->rhoi += material->rho * section->mass_inertia * (factor ? factor->rho : 1);
}

/* kGS of element e, and what contraction adds to EI; the derivatives of both stand in beam->layer then */
static double axis_shear(const struct beam *beam, int e, double *contraction)
{
    int count = factors_layers(beam, e);
    *contraction = contraction_stiffness(MODE_BENDING, count, beam->layer);
    return shear_stiffness(count, beam->layer);
}

void axis_quantities(const struct beam *beam, int e, struct element *element)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    const struct section_part *part;
    struct effect_field *factor;
    int count = factors_parts(beam, e, &part, &factor), group = rotor->segment[mesh->segment[e]].group;
    double contraction, shear = axis_shear(beam, e, &contraction);
    *element = (struct element){.ei = contraction,
                                .kgs = shear,
                                .force = beam->elastic_only ? 0 : rotor_axial_force(rotor, group, mesh_middle(mesh, e), 0),
                                .length = mesh->z[e + 1] - mesh->z[e]};
    for (int i = 0; i < count; i++)
        add_part(&rotor->group[part[i].group].material, &part[i].section, factor ? &factor[i] : NULL, element);
}

/* Adds what the direction v of the values of part i moves in kGS, and in EI beside the sum of the parts. */
static void add_direction(const struct beam *beam, int i, const struct shear_material *v, struct element *d)
{
    d->kgs += shear_material_product(&beam->layer[i].by, v);
    d->ei += shear_material_product(&beam->layer[i].contraction, v);
}

/* of EI and mass alone */
static int material_direction(const struct section *section, enum parameter_kind kind, struct element *d)
{
    *d = (struct element){0};
    if (kind == PARAMETER_E || kind == PARAMETER_TIEROD_E)
        d->ei = section->stiff_inertia;
    if (kind == PARAMETER_RHO)
        *d = (struct element){.rhos = section->mass_area, .rhoi = section->mass_inertia};
    return kind == PARAMETER_E || kind == PARAMETER_TIEROD_E || kind == PARAMETER_G || kind == PARAMETER_NU ||
           kind == PARAMETER_RHO;
}

static int effect_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d)
{
    double contraction;
    const struct section_part *part;
    struct effect_field *factor;
    int moves = 0, count = factors_parts(beam, e, &part, &factor);
    for (int i = 0; i < count; i++) {
        struct effect_span span = factors_span(beam, e, &part[i]);
        struct effect_field rate = {0, 0, 0};
        if (!effects_axis_rate(&beam->rotor, parameter, &span, 1, &rate))
            continue;
        if (!moves)
            (void)axis_shear(beam, e, &contraction);
        if (factor)
            rate = (struct effect_field){rate.e * factor[i].e, rate.g * factor[i].g, rate.rho * factor[i].rho};
        add_part(&beam->rotor.group[part[i].group].material, &part[i].section, &rate, d);
        struct shear_material v = shear_material_rate(&beam->rotor.group[part[i].group].material, rate.e, rate.g);
        add_direction(beam, i, &v, d);
        moves = 1;
    }
    d->force = rotor_axial_force_derivative(&beam->rotor, parameter, mesh_middle(&beam->mesh, e), 0);
    return moves || d->force != 0;
}

int axis_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d)
{
    double contraction;
    const struct rotor *rotor = &beam->rotor;
    const struct section_part *part;
    struct effect_field *factor;
    int moves = 0, count = factors_parts(beam, e, &part, &factor);
    *d = (struct element){0};
    if (parameter.kind == PARAMETER_EFFECT)
        return effect_direction(beam, parameter, e, d);
    if (parameter.kind == PARAMETER_TENSION) {
        d->force = rotor_axial_force_derivative(rotor, parameter, mesh_middle(&beam->mesh, e), 0);
        return d->force != 0;
    }
    for (int i = 0; i < count && parameter.kind <= PARAMETER_RHO; i++) {
        struct element own;
        const struct effect_field f = factor ? factor[i] : (struct effect_field){1, 1, 1};
        if (!parameter_is_of_group(&parameter, part[i].group))
            continue;
        if (!moves)
            (void)axis_shear(beam, e, &contraction);
        moves |= material_direction(&part[i].section, parameter.kind, &own);
        struct shear_material v = shear_material_derivative(&rotor->group[part[i].group].material, parameter.kind);
        shear_material_scale(&rotor->group[part[i].group].material, f.e, f.g, &v);
        d->ei += f.e * own.ei;
        d->rhos += f.rho * own.rhos;
        d->rhoi += f.rho * own.rhoi;
        add_direction(beam, i, &v, d);
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
    return (struct section){.stiff_area = area, .stiff_inertia = own, .mass_area = area, .mass_inertia = own};
}

static struct element bundle_element(const struct material *material, const struct section *section, double length)
{
    struct element element = {.kgs = shear_stiffness_plain(section, material), .length = length};
    add_part(material, section, NULL, &element);
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
    (void)material_direction(&section, parameter.kind, d);
    d->ei *= factor.young;
    if (rod->material.isotropic) /* kGS is proportional to E then */
        d->kgs = shear_stiffness_plain(&section, &rod->material) / rod->material.e * factor.young;
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
