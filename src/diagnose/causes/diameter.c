/* An outer diameter other than stated: D times a factor s, stiffness and mass together. Of a section D by d
 *
 *   A' / A = (s^2 D^2 - d^2)/(D^2 - d^2),   I' / I = (s^4 D^4 - d^4)/(D^4 - d^4)
 *
 * E by the latter, G and rho by the former: exact in EI and rho A; the shear coefficient and the rotary inertia follow A. */
#include "diagnose/causes/causes.h"

/* (s^n - q)/(1 - q), q = (d/D)^n, or its derivative. */
static double ratio(double s, int n, double q, int p)
{
    double power = n == 2 ? s * s : s * s * s * s;
    return p < 0 ? (power - q) / (1 - q) : n * power / s / (1 - q);
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    const struct segment *segment = &rotor->segment[span->segment];
    double s = effect->value[0], q = segment->inner / segment->outer;
    if (span->group != effect->target)
        return 0;
    double area = ratio(s, 2, q * q, p);
    *out = (struct effect_field){ratio(s, 4, q * q * q * q, p), area, area};
    return 1;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    double thickest = 0; /* bore over diameter */
    (void)p;
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == effect->target && !rotor->segment[s].rectangular)
            thickest = fmax(thickest, rotor->segment[s].inner / rotor->segment[s].outer);
    *lower = fmax((1 + thickest) / 2, 0.8);
    *upper = 1.25;
}

/* A round part of the axis without layers, whose modulus is known: else stiffness and density are what is asked. */
static int applies(const struct rotor *rotor, int target, const int *identified)
{
    int round = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == target) {
            if (rotor->segment[s].rectangular)
                return 0;
            round = 1;
            for (int i = 0; i < rotor->nring; i++)
                if (rotor->ring[i].segment == s)
                    return 0;
        }
    return round && applies_to_known_group(rotor, target, identified);
}

static const struct effect_kind kind = {.id = "diameter", .nparameter = 1, .parameter = {{"factor", "1"}}, .field = field};

const struct cause_kind cause_diameter = {
    .id = "diameter",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 1.01, PRIOR_NORMAL(0.03)}},
    NO_PLACE,
    .applies = applies,
    .bounds = bounds,
    .sentence = "an outer diameter other than stated: stiffness and mass together",
    .check = "measure the diameter of the part, and compare the drawing",
};
