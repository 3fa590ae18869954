#include "diagnose/causes/cause.h"

int cause_of_beam(const struct cause_kind *cause)
{
    return cause->solid || (cause->effect && cause->effect->section);
}

int cause_parameters(const struct effect *effect)
{
    return effect_parameters(effect);
}

const char *cause_target_name(struct pool *pool, const struct rotor *rotor, const struct cause_kind *cause, int target)
{
    if (target < 0)
        return "";
    switch (cause->target) {
    case TARGET_GROUP:
        return rotor->group[target].name;
    case TARGET_INTERFACE:
        return pool_format(pool, "%s|%s", rotor->group[target].name, rotor->group[target + 1].name);
    case TARGET_SPRING:
        return rotor->spring[target].name ? rotor->spring[target].name
                                          : pool_format(pool, "at %.4g m", rotor->spring[target].position);
    case TARGET_DISK:
        return rotor->disk[target].name ? rotor->disk[target].name : pool_format(pool, "at %.4g m", rotor->disk[target].position);
    case TARGET_TIEROD:
        return rotor->tierod[target].name;
    default:
        return "";
    }
}
