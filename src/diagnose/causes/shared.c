#include "diagnose/causes/shared.h"

#include "beam/section.h"

const double gauss_place[GAUSS_POINTS] = {-0.861136311594052575223946, -0.339981043584856264802666, 0.339981043584856264802666,
                                          0.861136311594052575223946};
const double gauss_weight[GAUSS_POINTS] = {0.347854845137453857373064, 0.652145154862546142626936, 0.652145154862546142626936,
                                           0.347854845137453857373064};

double factor_of_compliance(double mean, double dmean, int p)
{
    return p < 0 ? 1 / mean : -dmean / (mean * mean);
}

int scale_stiffness(double factor, int p, struct effect_factors *factors)
{
    *factors = (struct effect_factors){factor, factor, p < 0, p < 0};
    return 1;
}

void bounds_of_factor(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)rotor, (void)effect, (void)p;
    *lower = 0.5;
    *upper = 1.5;
}

int applies_to_known_group(const struct rotor *rotor, int target, const int *identified)
{
    (void)rotor;
    return !identified[target];
}

static double mass_of_rods(const struct material *material, int number, double diameter, double length)
{
    double area, own, pitch;
    section_rods(number, diameter, 0, &area, &own, &pitch);
    return material->rho * area * length;
}

double mass_of_rotor(const struct rotor *rotor)
{
    double sum = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *segment = &rotor->segment[s];
        const struct group *group = &rotor->group[segment->group];
        struct section section;
        if (segment->rectangular)
            section_rectangular(segment->height, segment->width, &section);
        else
            section_round(segment->outer, segment->inner, segment->stiff_outer, &section);
        sum += group->material.rho * section.mass_area * segment->length;
        if (group->holes)
            sum -= mass_of_rods(&group->material, group->holes, group->hole_diameter, segment->length);
    }
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

int scale_along_group(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                      double (*shape)(double xi), struct effect_factors *factors)
{
    double from, to, mean = 0, dmean = 0, half = (span->to - span->from) / 2;
    if (span->group != effect->target)
        return 0;
    rotor_group_span(rotor, span->group, &from, &to);
    for (int g = 0; g < GAUSS_POINTS; g++) {
        double z = span->from + half * (1 + gauss_place[g]), f = shape((2 * z - from - to) / (to - from));
        double factor = 1 + effect->value[0] * f, w = gauss_weight[g] / 2;
        mean += w / factor;
        dmean -= w * f / (factor * factor);
    }
    return scale_stiffness(factor_of_compliance(mean, dmean, p), p, factors);
}
