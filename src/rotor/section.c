#include "rotor/rotor.h"

static double disc_area(double d)
{
    return PI * d * d / 4;
}

static double disc_inertia(double d)
{
    return PI * d * d * d * d / 64;
}

void section_round(double outer, double inner, double stiff_outer, struct section *section)
{
    *section = (struct section){.stiff_area = disc_area(stiff_outer) - disc_area(inner),
                                .stiff_inertia = disc_inertia(stiff_outer) - disc_inertia(inner),
                                .mass_area = disc_area(outer) - disc_area(inner),
                                .mass_inertia = disc_inertia(outer) - disc_inertia(inner),
                                .ratio = inner / stiff_outer,
                                .stiff_outer = stiff_outer};
    section->torsion = 2 * section->stiff_inertia;
    section->polar = 2 * section->mass_inertia;
}

/* Saint-Venant's a b^3 [1/3 - (64/pi^5) (b/a) sum tanh(n pi a/2b)/n^5 over the odd n], a >= b. Timoshenko and Goodier, Theory of
 * Elasticity, article 109; the term after the fifth is below 1e-6 of the whole. */
static double rectangle_torsion(double height, double width)
{
    double a = fmax(height, width), b = fmin(height, width), sum = 0;
    for (int n = 1; n <= 9; n += 2)
        sum += tanh(n * PI * a / (2 * b)) / pow(n, 5);
    return a * b * b * b * (1.0 / 3 - 64 / pow(PI, 5) * b / a * sum);
}

void section_rectangular(double height, double width, struct section *section)
{
    double area = height * width, inertia = width * height * height * height / 12;
    *section = (struct section){
        area, inertia, area, inertia, 1, 0, 0, rectangle_torsion(height, width), area * (height * height + width * width) / 12};
}

int section_perforate(int number, double d, double e, double stiff_outer, struct section *section)
{
    double area, own, pitch;
    section_rods(number, d, e, &area, &own, &pitch);
    section->mass_area -= area;
    section->mass_inertia -= own + pitch;
    section->polar -= 2 * (own + pitch);
    if (e < stiff_outer / 2) {
        section->stiff_area -= area;
        section->stiff_inertia -= own + pitch;
        section->torsion -= 2 * (own + pitch);
    }
    return section->stiff_area > 0 && section->stiff_inertia > 0 && section->mass_area > 0 && section->mass_inertia > 0
               ? ROTID_OK
               : ROTID_ERROR_SECTION;
}

void section_rods(int number, double d, double e, double *area, double *own, double *pitch)
{
    *area = number * disc_area(d);
    *own = number * disc_inertia(d);
    *pitch = *area * e * e / 2;
}

static int perforate(const struct group *group, double stiff_outer, struct section *section)
{
    return group->holes ? section_perforate(group->holes, group->hole_diameter, group->hole_pitch, stiff_outer, section)
                        : ROTID_OK;
}

int section_of_segment(const struct rotor *rotor, int index, struct section *section)
{
    const struct segment *segment = &rotor->segment[index];
    if (segment->rectangular)
        section_rectangular(segment->height, segment->width, section);
    else
        section_round(segment->outer, segment->inner, segment->stiff_outer, section);
    return perforate(&rotor->group[segment->group], segment->stiff_outer, section);
}

int section_of_ring(const struct rotor *rotor, int index, struct section *section)
{
    const struct ring *ring = &rotor->ring[index];
    section_round(ring->outer, ring->inner, ring->outer, section);
    return perforate(&rotor->group[ring->group], ring->outer, section);
}

/* Tie rods and bars in torsion and along the axis. */

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
