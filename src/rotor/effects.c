#include "rotor/rotor.h"

int effect_parameters(const struct effect *effect)
{
    return effect->kind->count ? effect->kind->count(effect) : effect->kind->nparameter;
}

/* Factors of one effect along a stretch of the axis, or their derivatives where p >= 0, with the return value of the hooks.
 * sections: nonzero for a beam, whose EI and kGS then follow e and g with the factors of sections among them. */
static int effect_on_axis(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int sections,
                          int p, struct effect_field *factors)
{
    const struct effect_kind *kind = effect->kind;
    struct effect_section section;
    if (kind->field)
        return kind->field(effect, rotor, span, p, factors);
    if (!sections || !kind->section || !kind->section(effect, rotor, span, p, &section))
        return 0;
    *factors = (struct effect_field){section.ei, section.kgs, p < 0};
    return 1;
}

struct effect_field effects_on_axis(const struct rotor *rotor, const struct effect_span *span, int sections)
{
    struct effect_field product = {1, 1, 1}, one;
    for (int i = 0; i < rotor->neffect; i++)
        if (effect_on_axis(&rotor->effect[i], rotor, span, sections, -1, &one))
            product = (struct effect_field){product.e * one.e, product.g * one.g, product.rho * one.rho};
    return product;
}

int effects_axis_rate(const struct rotor *rotor, struct parameter parameter, const struct effect_span *span, int sections,
                      struct effect_field *rate)
{
    const struct effect *effect = &rotor->effect[parameter.index];
    struct effect_field own = {1, 1, 1};
    if (!effect_on_axis(effect, rotor, span, sections, parameter.component, rate))
        return 0;
    effect_on_axis(effect, rotor, span, sections, -1, &own);
    *rate = (struct effect_field){rate->e / own.e, rate->g / own.g, rate->rho / own.rho};
    return 1;
}

static struct effect_bundle on_tierod(const struct rotor *rotor, int tierod, int except)
{
    struct effect_bundle product = {1, 1, 0}, one;
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *effect = &rotor->effect[i];
        if (i == except || !effect->kind->tierod || effect->target != tierod)
            continue;
        effect->kind->tierod(effect, -1, &one);
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
    if (!effect->kind->tierod || effect->target != tierod)
        return 0;
    effect->kind->tierod(effect, parameter.component, d);
    struct effect_bundle others = on_tierod(rotor, tierod, parameter.index);
    *d = (struct effect_bundle){d->young * others.young, d->tension * others.tension, 0};
    return 1;
}

static int is_on_spring(const struct effect *effect, int spring)
{
    return effect->kind->spring && effect->target == spring;
}

static struct effect_spring change_of(const struct rotor *rotor, int spring, int except)
{
    struct effect_spring sum = {.factor = 1}, one;
    for (int i = 0; i < rotor->neffect; i++)
        if (i != except && is_on_spring(&rotor->effect[i], spring)) {
            rotor->effect[i].kind->spring(&rotor->effect[i], -1, &one);
            sum = (struct effect_spring){sum.factor * one.factor, sum.lateral + one.lateral, sum.rotational + one.rotational,
                                         sum.shift + one.shift};
        }
    return sum;
}

static double in_series(double k, double compliance)
{
    return k / (1 + compliance * k);
}

/* d k/(1 + c k) */
static double in_series_rate(double k, double dk, double compliance, double dcompliance)
{
    double one = 1 + compliance * k;
    return (dk - k * k * dcompliance) / (one * one);
}

void effects_on_spring(const struct rotor *rotor, int spring, struct effect_point *point)
{
    const struct spring *own = &rotor->spring[spring];
    struct effect_spring change = change_of(rotor, spring, -1);
    *point = (struct effect_point){.z = own->position + change.shift,
                                   .lateral = in_series(change.factor * own->lateral, change.lateral),
                                   .rotational = in_series(change.factor * own->rotational, change.rotational)};
}

int effects_spring_derivative(const struct rotor *rotor, struct parameter parameter, int spring, struct effect_point *d)
{
    const struct spring *own = &rotor->spring[spring];
    struct effect_spring change = change_of(rotor, spring, -1), rate = {.factor = 0};
    double lateral = 0, rotational = 0; /* of what the compliance is in series with */
    if (parameter.kind == PARAMETER_EFFECT) {
        const struct effect *effect = &rotor->effect[parameter.index];
        if (!is_on_spring(effect, spring))
            return 0;
        effect->kind->spring(effect, parameter.component, &rate);
        rate.factor *= change_of(rotor, spring, parameter.index).factor;
        lateral = rate.factor * own->lateral;
        rotational = rate.factor * own->rotational;
    } else if (parameter.index == spring && parameter.kind == PARAMETER_SPRING_K) {
        lateral = change.factor;
    } else if (parameter.index == spring && parameter.kind == PARAMETER_SPRING_K_ROT) {
        rotational = change.factor;
    } else {
        return 0;
    }
    *d = (struct effect_point){
        .z = rate.shift,
        .lateral = in_series_rate(change.factor * own->lateral, lateral, change.lateral, rate.lateral),
        .rotational = in_series_rate(change.factor * own->rotational, rotational, change.rotational, rate.rotational)};
    return 1;
}

int effects_move_spring(const struct rotor *rotor, int spring)
{
    for (int i = 0; i < rotor->neffect; i++)
        if (rotor->effect[i].kind->moves_springs && is_on_spring(&rotor->effect[i], spring))
            return 1;
    return 0;
}

double effects_on_disk(const struct rotor *rotor, int disk)
{
    double sum = rotor->disk[disk].diametral;
    for (int i = 0; i < rotor->neffect; i++)
        sum += rotor->effect[i].kind->at_disk && rotor->effect[i].target == disk ? rotor->effect[i].value[0] : 0;
    return sum;
}

int effects_disk_of(const struct rotor *rotor, struct parameter parameter)
{
    const struct effect *effect = parameter.kind == PARAMETER_EFFECT ? &rotor->effect[parameter.index] : NULL;
    return effect && effect->kind->at_disk ? effect->target : parameter.kind == PARAMETER_DISK_INERTIA ? parameter.index : -1;
}

/* Part of N T on what lies at z: minus what the rods press with, plus that of rods which are on the axis themselves. */
static int share_of_tension(const struct tierod *rod, double z, int followed)
{
    return rod->from < z && z < rod->to ? (followed && rod->elements == 1) - (rod->self_equilibrated != 0) : 0;
}

double rotor_axial_force(const struct rotor *rotor, int group, double z, int followed)
{
    double force = rotor->group[group].preload;
    for (int t = 0; t < rotor->ntierod; t++) {
        const struct tierod *rod = &rotor->tierod[t];
        int share = share_of_tension(rod, z, followed);
        if (share)
            force += share * rod->number * rod->tension * (rotor->neffect ? effects_on_tierod(rotor, t).tension : 1);
    }
    return force;
}

double rotor_axial_force_derivative(const struct rotor *rotor, struct parameter parameter, double z, int followed)
{
    double d = 0;
    if (parameter.kind == PARAMETER_TENSION) {
        const struct tierod *rod = &rotor->tierod[parameter.index];
        return share_of_tension(rod, z, followed) * rod->number *
               (rotor->neffect ? effects_on_tierod(rotor, parameter.index).tension : 1);
    }
    for (int t = 0; t < rotor->ntierod && parameter.kind == PARAMETER_EFFECT; t++) {
        const struct tierod *rod = &rotor->tierod[t];
        struct effect_bundle bundle = {0, 0, 0};
        int share = share_of_tension(rod, z, followed);
        if (share && effects_tierod_derivative(rotor, parameter, t, &bundle))
            d += share * rod->number * rod->tension * bundle.tension;
    }
    return d;
}
