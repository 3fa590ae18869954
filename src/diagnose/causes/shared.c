#include "diagnose/causes/shared.h"

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
