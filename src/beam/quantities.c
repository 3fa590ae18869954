#include "beam/quantities.h"

void axis_quantities(const struct beam *beam, int e, struct element *element)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    int s = mesh->segment[e];
    const struct section *section = &beam->section[s];
    const struct group *group = &rotor->group[rotor->segment[s].group];
    const struct material *material = &group->material;
    double unused, middle = (mesh->z[e] + mesh->z[e + 1]) / 2;
    *element = (struct element){.ei = material->e * section->stiff_inertia,
                                .kgs = section_shear_coefficient(section, material->nu, &unused) *
                                       material_shear_modulus(material) * section->stiff_area,
                                .rhos = material->rho * section->mass_area,
                                .rhoi = material->rho * section->mass_inertia,
                                .force = beam->elastic_only ? 0 : group->preload,
                                .length = mesh->z[e + 1] - mesh->z[e]};
    for (int t = 0; t < rotor->ntierod && !beam->elastic_only; t++) {
        const struct tierod *rod = &rotor->tierod[t];
        if (rod->self_equilibrated && rod->from < middle && middle < rod->to)
            element->force -= rod->number * rod->tension;
    }
}

static int material_direction(const struct material *material, const struct section *section, enum parameter_kind kind,
                              struct element *d)
{
    double dk, k = section_shear_coefficient(section, material->nu, &dk), g = material_shear_modulus(material);
    switch (kind) {
    case PARAMETER_E:
    case PARAMETER_TIEROD_E:
        d->ei = section->stiff_inertia;
        d->kgs = material->isotropic ? k * g / material->e * section->stiff_area : 0;
        return 1;
    case PARAMETER_G:
        d->kgs = k * section->stiff_area;
        return 1;
    case PARAMETER_NU:
        d->kgs = (dk * g - (material->isotropic ? k * g / (1 + material->nu) : 0)) * section->stiff_area;
        return 1;
    case PARAMETER_RHO:
        d->rhos = section->mass_area;
        d->rhoi = section->mass_inertia;
        return 1;
    default:
        return 0;
    }
}

int axis_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    int s = mesh->segment[e], group = rotor->segment[s].group;
    *d = (struct element){0};
    if (parameter.kind == PARAMETER_TENSION) {
        const struct tierod *rod = &rotor->tierod[parameter.index];
        double middle = (mesh->z[e] + mesh->z[e + 1]) / 2;
        d->force = rod->self_equilibrated && rod->from < middle && middle < rod->to ? -rod->number : 0;
        return d->force != 0;
    }
    if (parameter.kind > PARAMETER_RHO || parameter.index != group)
        return 0;
    return material_direction(&rotor->group[group].material, &beam->section[s], parameter.kind, d);
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
    double unused;
    return (struct element){.ei = material->e * section->stiff_inertia,
                            .kgs = section_shear_coefficient(section, material->nu, &unused) * material_shear_modulus(material) *
                                   section->stiff_area,
                            .rhos = material->rho * section->mass_area,
                            .rhoi = material->rho * section->mass_inertia,
                            .length = length};
}

static double tierod_length(const struct beam *beam, int tierod)
{
    const struct chain *chain = &beam->mesh.tierod[tierod];
    return beam->mesh.z[chain->last_end] - beam->mesh.z[chain->first_end];
}

void tierod_quantities(const struct beam *beam, int tierod, double length, struct element *element, struct stretch *stretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    double pitch, whole = tierod_length(beam, tierod);
    struct section section = bundle_section(rod->model, rod->number, rod->diameter, rod->pitch, &beam->tube[tierod], &pitch);
    *element = bundle_element(&rod->material, &section, length);
    element->force = beam->elastic_only ? 0 : rod->number * rod->tension;
    *stretch = (struct stretch){0, 0};
    if (rod->model == BUNDLE_RODS)
        *stretch = (struct stretch){rod->material.e * pitch / whole, rod->material.rho * pitch * whole};
}

int tierod_direction(const struct beam *beam, struct parameter parameter, int tierod, struct element *d, struct stretch *dstretch)
{
    const struct tierod *rod = &beam->rotor.tierod[tierod];
    *d = (struct element){0};
    *dstretch = (struct stretch){0, 0};
    if (parameter.index != tierod)
        return 0;
    if (parameter.kind == PARAMETER_TENSION) {
        d->force = rod->number;
        return 1;
    }
    if (parameter.kind != PARAMETER_TIEROD_E)
        return 0;
    double pitch;
    struct section section = bundle_section(rod->model, rod->number, rod->diameter, rod->pitch, &beam->tube[tierod], &pitch);
    if (rod->model == BUNDLE_RODS)
        dstretch->stiffness = pitch / tierod_length(beam, tierod);
    return material_direction(&rod->material, &section, parameter.kind, d);
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
