#include "beam/factors.h"

#include "rotor/effects.h"

struct effect_span factors_span(const struct beam *beam, int e)
{
    int segment = beam->mesh.segment[e];
    return (struct effect_span){beam->rotor.segment[segment].group, segment, beam->mesh.z[e], beam->mesh.z[e + 1]};
}

void factors_refresh(struct beam *beam)
{
    for (int e = 0; e < beam->mesh.nelement && beam->factor; e++) {
        struct effect_span span = factors_span(beam, e);
        beam->factor[e] = effects_on_axis(&beam->rotor, &span, 1);
    }
}

int factors_open(struct pool *pool, struct beam *beam)
{
    beam->factor = NULL;
    if (!beam->rotor.neffect)
        return ROTID_OK;
    beam->factor = POOL_ARRAY(pool, struct effect_field, beam->mesh.nelement);
    if (!beam->factor)
        return ROTID_ERROR_MEMORY;
    factors_refresh(beam);
    return ROTID_OK;
}
