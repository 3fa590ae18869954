#include "diagnose/causes/causes.h"

const double gauss_place[GAUSS_POINTS] = {-0.861136311594052575223946, -0.339981043584856264802666, 0.339981043584856264802666,
                                          0.861136311594052575223946};
const double gauss_weight[GAUSS_POINTS] = {0.347854845137453857373064, 0.652145154862546142626936, 0.652145154862546142626936,
                                           0.347854845137453857373064};

double factor_of_compliance(double mean, double dmean, int p)
{
    return p < 0 ? 1 / mean : -dmean / (mean * mean);
}

int scale_stiffness(double factor, int p, struct effect_field *field)
{
    *field = (struct effect_field){factor, factor, p < 0};
    return 1;
}

double bending_stiffness(const struct rotor *rotor, int s)
{
    const struct segment *segment = &rotor->segment[s];
    double e = rotor->group[segment->group].material.e, h = segment->height;
    if (segment->rectangular)
        return e * segment->width * h * h * h / 12;
    double outer = segment->stiff_outer, inner = segment->inner;
    double sum = e * PI / 64 * (outer * outer * outer * outer - inner * inner * inner * inner);
    for (int i = 0; i < rotor->nring; i++) {
        struct section section;
        if (rotor->ring[i].segment == s && !section_of_ring(rotor, i, &section))
            sum += rotor->group[rotor->ring[i].group].material.e * section.stiff_inertia;
    }
    return sum;
}

double mean_bending_stiffness(const struct rotor *rotor)
{
    double sum = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sum += bending_stiffness(rotor, s) * rotor->segment[s].length;
    return sum / rotor_length(rotor);
}

double bending_flexibility(const struct rotor *rotor, double from, int n)
{
    double sum = 0, z = -from;
    for (int s = 0; s < rotor->nsegment; s++) {
        double end = z + rotor->segment[s].length;
        sum += (pow(end, n + 1) - pow(z, n + 1)) / (n + 1) / bending_stiffness(rotor, s);
        z = end;
    }
    return sum;
}

double heaviest_overlooked(const struct rotor *rotor)
{
    double mass = rotor_mass(rotor);
    return fmax(0.03 * mass, fmin(0.25 * mass, 10));
}

int spring_anywhere(const struct effect *effect, int i, int p, int rotational, struct effect_point *point)
{
    if (i > 0)
        return 0;
    *point = (struct effect_point){.z = p < 0 ? effect->value[1] : p == 1};
    *(rotational ? &point->rotational : &point->lateral) = p < 0 ? effect->value[0] : p == 0;
    return 1;
}

int applies_to_felt_spring(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return rotor->spring[target].lateral > 0 || rotor->spring[target].rotational > 0;
}

int applies_to_known_group(const struct rotor *rotor, int target, const int *identified)
{
    (void)rotor;
    return !identified[target];
}

int scale_along_group(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                      double (*shape)(double xi), struct effect_field *field)
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
    return scale_stiffness(factor_of_compliance(mean, dmean, p), p, field);
}
