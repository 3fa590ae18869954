#include "diagnose/causes/cause.h"

int cause_parameters(const struct effect *effect)
{
    return effect_parameters(effect);
}
