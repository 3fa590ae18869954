#include "beam/effects.h"

int effect_parameters(const struct effect *effect)
{
    return effect->kind->count ? effect->kind->count(effect) : effect->kind->nparameter;
}

static struct effect_span span_of(const struct beam *beam, int e)
{
    int segment = beam->mesh.segment[e];
    return (struct effect_span){beam->rotor.segment[segment].group, segment, beam->mesh.z[e], beam->mesh.z[e + 1]};
}

static int on_axis(const struct effect *effect, const struct beam *beam, int e, int p, struct effect_factors *factors)
{
    struct effect_span span = span_of(beam, e);
    return effect->kind->axis(effect, &beam->rotor, &span, p, factors);
}

void effects_refresh(struct beam *beam)
{
    const struct rotor *rotor = &beam->rotor;
    struct effect_factors one;
    if (!beam->factor)
        return;
    for (int e = 0; e < beam->mesh.nelement; e++)
        beam->factor[e] = (struct effect_factors){1, 1, 1, 1};
    for (int i = 0; i < rotor->neffect; i++)
        for (int e = 0; e < beam->mesh.nelement && rotor->effect[i].kind->axis; e++)
            if (on_axis(&rotor->effect[i], beam, e, -1, &one)) {
                struct effect_factors *product = &beam->factor[e];
                *product = (struct effect_factors){product->ei * one.ei, product->kgs * one.kgs, product->rhos * one.rhos,
                                                   product->rhoi * one.rhoi};
            }
}

int effects_open(struct pool *pool, struct beam *beam)
{
    if (!beam->rotor.neffect)
        return ROTID_OK;
    beam->factor = POOL_ARRAY(pool, struct effect_factors, beam->mesh.nelement);
    if (!beam->factor)
        return ROTID_ERROR_MEMORY;
    effects_refresh(beam);
    return ROTID_OK;
}

int effects_axis_rate(const struct beam *beam, struct parameter parameter, int e, struct effect_factors *rate)
{
    const struct effect *effect = &beam->rotor.effect[parameter.index];
    struct effect_factors own = {1, 1, 1, 1};
    if (!effect->kind->axis || !on_axis(effect, beam, e, parameter.component, rate))
        return 0;
    on_axis(effect, beam, e, -1, &own);
    *rate = (struct effect_factors){rate->ei / own.ei, rate->kgs / own.kgs, rate->rhos / own.rhos, rate->rhoi / own.rhoi};
    return 1;
}

static struct effect_bundle on_tierod(const struct rotor *rotor, int tierod, int except)
{
    struct effect_bundle product = {1, 1, 0}, one;
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        if (i != except && effect->kind->tierod && effect->kind->tierod(effect, rotor, tierod, -1, &one))
            product =
                (struct effect_bundle){product.young * one.young, product.tension * one.tension, product.as_rods || one.as_rods};
    }
    return product;
}

struct effect_bundle effects_on_tierod(const struct rotor *rotor, int tierod)
{
    return on_tierod(rotor, tierod, -1);
}

int effects_tierod_derivative(const struct rotor *rotor, struct parameter parameter, int tierod, struct effect_bundle *d)
{
    const struct effect *effect = &rotor->effect[parameter.index];
    if (!effect->kind->tierod || !effect->kind->tierod(effect, rotor, tierod, parameter.component, d))
        return 0;
    struct effect_bundle others = on_tierod(rotor, tierod, parameter.index);
    *d = (struct effect_bundle){d->young * others.young, d->tension * others.tension, 0};
    return 1;
}

static double on_spring(const struct rotor *rotor, int spring, int except)
{
    double product = 1, one;
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        if (i != except && effect->kind->spring && effect->kind->spring(effect, rotor, spring, -1, &one))
            product *= one;
    }
    return product;
}

double effects_on_spring(const struct rotor *rotor, int spring)
{
    return on_spring(rotor, spring, -1);
}

int effects_spring_derivative(const struct rotor *rotor, struct parameter parameter, int spring, double *d)
{
    const struct effect *effect = &rotor->effect[parameter.index];
    if (!effect->kind->spring || !effect->kind->spring(effect, rotor, spring, parameter.component, d))
        return 0;
    *d *= on_spring(rotor, spring, parameter.index);
    return 1;
}
