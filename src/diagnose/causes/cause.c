#include "diagnose/causes/causes.h"

int cause_of_beam(const struct cause_kind *cause)
{
    return cause->solid || (cause->effect && cause->effect->section);
}

void cause_range(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                 double *upper)
{
    int stated = cause->lower < cause->upper;
    *lower = stated ? cause->lower : -INFINITY;
    *upper = stated ? cause->upper : INFINITY;
    if (cause->bounds)
        cause->bounds(rotor, effect, p, lower, upper);
}

/* A lower bound above zero is a ratio; a negative one lies where the stiffness would vanish. */
void cause_reach(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                 double *upper)
{
    double neutral = cause->parameter[cause->size].neutral;
    cause_range(cause, rotor, effect, p, lower, upper);
    if (p != cause->size || !(cause->widest > 1))
        return;
    *upper = neutral + cause->widest * (*upper - neutral);
    *lower = *lower > 0 ? *lower / cause->widest : *lower;
}

int cause_has_free_size(const struct cause_kind *cause, const int *fixed)
{
    return cause->effect->nparameter && !fixed[cause->size];
}

void cause_bounds(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, int p, double *lower,
                  double *upper)
{
    cause_reach(cause, rotor, effect, p, lower, upper);
    if (p != cause->size || !(effect->bound[0] < effect->bound[1]))
        return;
    *lower = effect->bound[0];
    *upper = effect->bound[1];
}

const char *cause_target_name(struct pool *pool, const struct rotor *rotor, const struct cause_kind *cause, int target)
{
    if (target < 0)
        return "";
    if (cause->target == TARGET_INTERFACE)
        return pool_format(pool, "%s|%s", rotor->group[target].name, rotor->group[target + 1].name);
    if (cause->target == TARGET_SPRING && !rotor->spring[target].name)
        return pool_format(pool, "spring at %.4g m", rotor->spring[target].position);
    if (cause->target == TARGET_DISK && !rotor->disk[target].name)
        return pool_format(pool, "disk at %.4g m", rotor->disk[target].position);
    return cause->target == TARGET_GROUP    ? rotor->group[target].name
           : cause->target == TARGET_SPRING ? rotor->spring[target].name
           : cause->target == TARGET_DISK   ? rotor->disk[target].name
           : cause->target == TARGET_TIEROD ? rotor->tierod[target].name
                                            : "";
}

const struct effect_parameter_name *correction_parameter(const struct cause_kind *cause, int p)
{
    const struct effect_parameter_name *name = p == 0 ? &cause->value : p < 3 ? &cause->more[p - 1] : NULL;
    return name && name->name ? name : NULL;
}

double *correction_value(struct correction *correction, int p)
{
    return p ? &correction->more[p - 1] : &correction->value;
}
