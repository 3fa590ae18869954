#include "rotor/rotor.h"

#include "rotid.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double disc_area(double d)
{
    return pi * d * d / 4;
}

static double disc_inertia(double d)
{
    return pi * d * d * d * d / 64;
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
        sum += tanh(n * pi * a / (2 * b)) / pow(n, 5);
    return a * b * b * b * (1.0 / 3 - 64 / pow(pi, 5) * b / a * sum);
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
