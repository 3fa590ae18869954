/* A clamp that gives way: a compliance in series with each stiffness of a spring that is stated to hold both deflection and
 * rotation. At most it gives way an eighth as much as the whole rotor does that is held there, by 1/EI in rotation and by
 * (z - clamp)^2/EI in deflection: from twice that on most of the energy of the
 * first mode is in the clamp, which is a hinge then and the mode one of a rigid body. */
#include "diagnose/causes/causes.h"

enum { ROTATIONAL, LATERAL };

static const double most = 0.125;

static void on_spring(const struct effect *effect, int p, struct effect_spring *change)
{
    *change = (struct effect_spring){.factor = p < 0,
                                     .lateral = p < 0 ? effect->value[LATERAL] : p == LATERAL,
                                     .rotational = p < 0 ? effect->value[ROTATIONAL] : p == ROTATIONAL};
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    *lower = 0;
    *upper = most * bending_flexibility(rotor, rotor->spring[effect->target].position, p == LATERAL ? 2 : 0);
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return rotor->spring[target].lateral > 0 && rotor->spring[target].rotational > 0;
}

static const struct effect_kind kind = {
    .id = "clamp", .nparameter = 2, .parameter = {{"rotational", "rad/(N.m)"}, {"lateral", "m/N"}}, .spring = on_spring};

const struct cause_kind cause_clamp = {
    .id = "clamp",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_SPRING,
    .effect = &kind,
    .parameter = {{.typical = 1e-8, .one_sided = 1, PRIOR_DECADES(3)}, {.typical = 1e-10, .one_sided = 1, PRIOR_DECADES(3)}},
    .size = ROTATIONAL,
    NO_PLACE,
    .applies = applies,
    .bounds = bounds,
    .sentence = "a clamp that gives way",
    .check = "measure a point of the clamp itself beside the rotor, and repeat with the bolts tightened",
};
