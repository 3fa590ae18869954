#include "rotor/rotor.h"

double rotor_length(const struct rotor *rotor)
{
    double sum = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sum += rotor->segment[s].length;
    return sum;
}

int rotor_segment_at(const struct rotor *rotor, double z)
{
    int s = 0;
    for (double end = rotor->segment[0].length; s + 1 < rotor->nsegment && end < z; end += rotor->segment[s].length)
        s++;
    return s;
}

long rotor_elements(const struct rotor *rotor)
{
    long sum = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sum += rotor->segment[s].elements;
    return sum;
}

int rotor_axis_groups(const struct rotor *rotor)
{
    int count = rotor->ngroup;
    while (count && rotor->group[count - 1].layer_of >= 0)
        count--;
    return count;
}

void rotor_diameters(const struct rotor *rotor, int segment, double *outer, double *inner)
{
    *outer = rotor->segment[segment].outer;
    *inner = rotor->segment[segment].inner;
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == segment) {
            *outer = fmax(*outer, rotor->ring[i].outer);
            *inner = fmin(*inner, rotor->ring[i].inner);
        }
}

/* The diameter that carries stiffness, 0 of a section that is not round. */
static double stiff_diameter(const struct rotor *rotor, int segment)
{
    const struct segment *s = &rotor->segment[segment];
    double outer, inner;
    rotor_diameters(rotor, segment, &outer, &inner);
    return s->stiff_outer > 0 && s->stiff_outer < s->outer ? s->stiff_outer : outer;
}

double rotor_step_error(const struct rotor *rotor, double *z, double *ratio)
{
    static const double step[] = {1, 1.1, 1.3, 1.6, 2}, c[] = {0, 0.05, 0.22, 0.45, 0.6};
    const int last = (int)(sizeof step / sizeof *step) - 1;
    double at = 0, worst = 0, length = rotor_length(rotor);
    for (int s = 1; s < rotor->nsegment; s++) {
        double one = stiff_diameter(rotor, s - 1), other = stiff_diameter(rotor, s);
        at += rotor->segment[s - 1].length;
        if (!(one > 0) || !(other > 0))
            continue;
        double of = fmax(one, other) / fmin(one, other), error = c[last];
        for (int i = last; i > 0 && of < step[i]; i--)
            error = c[i - 1] + (c[i] - c[i - 1]) * (of - step[i - 1]) / (step[i] - step[i - 1]);
        error *= fmax(one, other) / length;
        if (error <= worst)
            continue;
        worst = error;
        *z = at;
        *ratio = of;
    }
    return worst;
}

void rotor_group_span(const struct rotor *rotor, int group, double *from, double *to)
{
    double z = 0;
    int found = 0, host = rotor->group[group].layer_of;
    group = host < 0 ? group : host;
    *from = *to = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        if (rotor->segment[s].group == group && !found++)
            *from = z;
        z += rotor->segment[s].length;
        if (rotor->segment[s].group == group)
            *to = z;
    }
}

void rotor_hub_span(const struct rotor *rotor, int disk, double *from, double *to)
{
    double z = rotor->disk[disk].position, half = rotor->disk[disk].hub_length / 2;
    *from = fmax(z - half, 0);
    *to = fmin(z + half, rotor_length(rotor));
}

double material_shear_modulus(const struct material *material)
{
    return material->isotropic ? material->e / (2 * (1 + material->nu)) : material->g;
}

static double mass_of_rods(const struct material *material, int number, double diameter, double length)
{
    double area, own, pitch;
    section_rods(number, diameter, 0, &area, &own, &pitch);
    return material->rho * area * length;
}

static void add_section(const struct group *group, const struct section *section, double length, double *sum)
{
    *sum += group->material.rho * section->mass_area * length;
    if (group->holes)
        *sum -= mass_of_rods(&group->material, group->holes, group->hole_diameter, length);
}

double rotor_group_mass(const struct rotor *rotor, int group)
{
    double sum = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *segment = &rotor->segment[s];
        struct section section;
        if (segment->group != group)
            continue;
        if (segment->rectangular)
            section_rectangular(segment->height, segment->width, &section);
        else
            section_round(segment->outer, segment->inner, segment->stiff_outer, &section);
        add_section(&rotor->group[segment->group], &section, segment->length, &sum);
    }
    for (int i = 0; i < rotor->nring; i++) {
        const struct ring *ring = &rotor->ring[i];
        struct section section;
        if (ring->group != group)
            continue;
        section_round(ring->outer, ring->inner, ring->outer, &section);
        add_section(&rotor->group[ring->group], &section, rotor->segment[ring->segment].length, &sum);
    }
    return sum;
}

double rotor_mass(const struct rotor *rotor)
{
    double sum = 0;
    for (int g = 0; g < rotor->ngroup; g++)
        sum += rotor_group_mass(rotor, g);
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct tierod *rod = &rotor->tierod[i];
        sum += mass_of_rods(&rod->material, rod->number, rod->diameter, rod->to - rod->from);
    }
    for (int i = 0; i < rotor->nbars; i++)
        sum += mass_of_rods(&rotor->bars[i].material, rotor->bars[i].number, rotor->bars[i].diameter, rotor->bars[i].length);
    for (int i = 0; i < rotor->ndisk; i++)
        sum += rotor->disk[i].mass;
    return sum;
}
