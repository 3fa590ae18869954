/* An interface that gives way: a rotational spring of this flexibility between two groups. What hangs on which side of it is
 * stated in beam/hinge.h. */
#include "diagnose/causes/causes.h"

/* last segment of the group, or -1 where nothing follows it */
static int segment_before(const struct rotor *rotor, int group)
{
    int last = -1;
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == group)
            last = s;
    return last + 1 < rotor->nsegment ? last : -1;
}

static double diameter_flexibility(const struct rotor *rotor, int s)
{
    double whole = rotor->segment[s].height, bore;
    if (!rotor->segment[s].rectangular)
        rotor_diameters(rotor, s, &whole, &bore);
    return whole / bending_stiffness(rotor, s);
}

/* from nothing to the joint as soft as a shaft ten diameters long, of the softer neighbour */
static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)p;
    int s = segment_before(rotor, effect->target);
    *lower = 0;
    *upper = s < 0 ? 1 : 10 * fmax(diameter_flexibility(rotor, s), diameter_flexibility(rotor, s + 1));
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return segment_before(rotor, target) >= 0;
}

static const struct effect_kind kind = {.id = "joint", .nparameter = 1, .parameter = {{"flexibility", "rad/(N.m)"}}, .joint = 1};

const struct cause_kind cause_joint = {
    .id = "joint",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_INTERFACE,
    .effect = &kind,
    .parameter = {{.typical = 2e-10, .one_sided = 1, PRIOR_DECADES(5)}},
    NO_PLACE,
    .limit_of = "stiffness_local",
    .applies = applies,
    .bounds = bounds,
    .widest = 100,
    .sentence = "an interface between two parts that is flexible in bending",
    .check = "measure both sides of the interface close to it and look for a kink, and repeat after tightening it",
};
