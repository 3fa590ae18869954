#include "beam/beam.h"

struct effect_span factors_span(const struct beam *beam, int e, const struct section_part *part)
{
    return (struct effect_span){part->group, beam->mesh.segment[e], beam->mesh.z[e], beam->mesh.z[e + 1]};
}

int factors_parts(const struct beam *beam, int e, const struct section_part **part, struct effect_field **factor)
{
    int segment = beam->mesh.segment[e], first = beam->first_part[segment];
    *part = beam->part + first;
    *factor = beam->factor ? beam->factor + (ptrdiff_t)beam->most_parts * e : NULL;
    return beam->first_part[segment + 1] - first;
}

void factors_refresh(struct beam *beam)
{
    for (int e = 0; e < beam->mesh.nelement && beam->factor; e++) {
        const struct section_part *part;
        struct effect_field *factor;
        for (int i = 0, count = factors_parts(beam, e, &part, &factor); i < count; i++) {
            struct effect_span span = factors_span(beam, e, &part[i]);
            factor[i] = effects_on_axis(&beam->rotor, &span, beam->type == MODE_BENDING);
        }
    }
}

int factors_open(struct pool *pool, struct beam *beam)
{
    beam->factor = NULL;
    if (!beam->rotor.neffect)
        return ROTID_OK;
    beam->factor = POOL_ARRAY(pool, struct effect_field, (size_t)beam->most_parts * (size_t)beam->mesh.nelement);
    if (!beam->factor)
        return ROTID_ERROR_MEMORY;
    factors_refresh(beam);
    return ROTID_OK;
}
