/* What this data set could have shown: for each cause the size that the scan finds nine times in ten, and along the axis where
 * the misfit of the base model lies. */
#include "diagnose/diagnose.h"

#define POWER 1.2816 /* standard normal deviate of 90 % */

void amplitudes_shown(const struct states *states, struct scan *scan)
{
    for (int k = 0; k < scan->ncandidate; k++) {
        const struct scan_candidate *c = &scan->candidate[k];
        const struct rotor *rotor = &states->state[c->home].job.rotor;
        double gain = posterior_gain_shown(scan, k);
        for (int i = c->first; i < c->first + c->count; i++) {
            struct scan_item *item = &scan->item[i];
            item->shown = item->usable ? (sqrt(evidence_drop_for(scan, rotor, i, gain)) + POWER) / item->norm : (double)INFINITY;
        }
    }
}

/* Best and worst over the places, each with the width that shows best. */
static void over_places(const struct scan *scan, const struct scan_candidate *c, rotid_detectable *d)
{
    int place = c->cause->place;
    double smallest = INFINITY, worst = 0;
    for (int i = c->first; i < c->first + c->count;) {
        double here = INFINITY, z = place >= 0 ? scan->item[i].effect.value[place] : NAN;
        int j = i;
        for (; j < c->first + c->count && (j == i || (place >= 0 && scan->item[j].effect.value[place] == z)); j++)
            here = fmin(here, fabs(scan->item[j].shown * scan->item[j].unit));
        i = j;
        if (here < smallest) {
            smallest = here;
            d->z_m = z;
        }
        worst = fmax(worst, here);
    }
    d->smallest = smallest;
    d->worst = place >= 0 ? worst : NAN;
}

int detectable_sizes(struct engine *engine, const struct scan *scan)
{
    rotid_diagnosis *out = &engine->out->result;
    out->detectable = POOL_ARRAY(engine->pool, rotid_detectable, scan->ncandidate);
    if (!out->detectable)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *c = &scan->candidate[i];
        const struct cause_kind *cause = c->cause;
        if (c->suspect || !c->count || c->state >= 0)
            continue;
        rotid_detectable *d = &out->detectable[out->ndetectable++];
        *d = (rotid_detectable){.id = cause->id, .target = c->target, .z_m = NAN, .worst = NAN};
        over_places(scan, c, d);
        if (engine->moving.usable && is_moving_accelerometer(&c->effect)) /* by the frequencies at single sensors */
            d->smallest = fmin(d->smallest, engine->moving.smallest);
        if (!cause->effect->nparameter) { /* there or not: a part of it would show */
            d->parameter = "presence";
            d->unit = "1";
            d->smallest = fabs(d->smallest / scan->item[c->first].unit);
            d->beyond = !(d->smallest <= 1);
            continue;
        }
        double lower, upper, neutral = cause->parameter[cause->size].neutral;
        cause_bounds(cause, &engine->states.state[c->home].job.rotor, &c->effect, cause->size, &lower, &upper);
        d->parameter = cause->effect->parameter[cause->size].name;
        d->unit = cause->effect->parameter[cause->size].unit;
        int side = cause->parameter[cause->size].one_sided;
        double most = side > 0 ? upper - neutral : side < 0 ? neutral - lower : fmax(upper - neutral, neutral - lower);
        d->beyond = !(d->smallest <= most);
        d->worst = d->worst <= most ? d->worst : NAN;
    }
    return ROTID_OK;
}

int localise(struct engine *engine, const struct scan *scan)
{
    rotid_diagnosis *out = &engine->out->result;
    int count = 0;
    for (int i = 0; i < scan->ncandidate; i++)
        if (scan->candidate[i].cause->place >= 0 && !scan->candidate[i].suspect && scan->candidate[i].count > count)
            count = scan->candidate[i].count;
    out->localisation = POOL_ARRAY(engine->pool, rotid_localisation, count);
    if (!out->localisation)
        return ROTID_ERROR_MEMORY;
    double largest = 0;
    for (int i = 0; i < scan->nitem; i++) {
        const struct scan_item *item = &scan->item[i];
        const struct scan_candidate *c = &scan->candidate[item->candidate];
        if (c->cause->place < 0 || c->suspect || c->state >= 0)
            continue;
        double z = item->effect.value[c->cause->place];
        int at = 0;
        while (at < out->nlocalisation && out->localisation[at].z_m != z)
            at++;
        if (at == out->nlocalisation) {
            if (out->nlocalisation == count)
                continue;
            out->localisation[out->nlocalisation++].z_m = z;
        }
        out->localisation[at].indicator = fmax(out->localisation[at].indicator, item->drop);
        largest = fmax(largest, item->drop);
    }
    for (int i = 0; i < out->nlocalisation && largest > 0; i++)
        out->localisation[i].indicator /= largest;
    return ROTID_OK;
}
