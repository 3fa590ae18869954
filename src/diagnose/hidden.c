#include "diagnose/hidden.h"

#include <math.h>
#include <string.h>

#include "diagnose/accelerometer.h"
#include "diagnose/detectable.h"
#include "diagnose/scan.h"

#define LISTED 3 /* causes of a parameter */

/* The largest amplitude of an item that stays hidden, with the sign that physics allows; *beyond: the physical bound is less than
 * what would show. */
static double hidden_amplitude(const struct engine *engine, const struct scan_candidate *c, const struct scan_item *item,
                               double threshold, int *beyond)
{
    double shown = amplitude_shown(item, threshold), side = item->side < 0 || (!item->side && -item->lower > item->upper) ? -1 : 1,
           most = side < 0 ? -item->lower : item->upper;
    if (engine->moving.usable && is_moving_accelerometer(&c->effect)) /* by the frequencies at single sensors */
        shown = fmin(shown, engine->moving.smallest / fabs(item->unit));
    *beyond = !(shown <= most);
    if (!c->cause->effect->nparameter) /* there or not: a part of it would show */
        return *beyond ? 1 : 0;
    return side * fmin(shown, most);
}

/* Candidate c moves parameter p most by this item. *row is blank where nothing moves it. */
static void largest_of(const struct engine *engine, const struct scan *scan, const struct scan_candidate *c, int p,
                       double threshold, rotid_hidden *row)
{
    const struct cause_kind *cause = c->cause;
    int nparameter = cause->effect->nparameter;
    *row = (rotid_hidden){.z_m = NAN};
    for (int i = c->first; i < c->first + c->count; i++) {
        const struct scan_item *item = &scan->item[i];
        int beyond;
        if (!item->usable)
            continue;
        double amplitude = hidden_amplitude(engine, c, item, threshold, &beyond),
               shift = amplitude * scan->shift[p + (ptrdiff_t)i * scan->nfree];
        if (!(fabs(shift) > fabs(row->shift)) || !isfinite(shift))
            continue;
        *row = (rotid_hidden){.parameter = engine->states.bounds[p].name,
                              .unit = engine->states.bounds[p].unit,
                              .shift = shift,
                              .id = cause->id,
                              .target = c->target,
                              .component = nparameter ? cause->effect->parameter[cause->size].name : "presence",
                              .size_unit = nparameter ? cause->effect->parameter[cause->size].unit : "1",
                              .size = amplitude * item->unit,
                              .z_m = cause->place >= 0 ? item->effect.value[cause->place] : (double)NAN,
                              .beyond = beyond};
    }
}

int hidden_shifts(struct engine *engine, const struct round_result *last)
{
    const struct scan *scan = &last->scan;
    rotid_diagnosis *out = &engine->out->result;
    out->hidden = POOL_ARRAY(engine->pool, rotid_hidden, LISTED * (size_t)engine->nown);
    if (!out->hidden)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < engine->nown && p < scan->nfree; p++) {
        rotid_hidden most[LISTED];
        int count = 0;
        for (int i = 0; i < scan->ncandidate && !engine->fit->at_bound[p]; i++) {
            const struct scan_candidate *c = &scan->candidate[i];
            rotid_hidden row;
            if (c->suspect || !c->count || c->state >= 0)
                continue;
            largest_of(engine, scan, c, p, last->bootstrap.threshold, &row);
            int at = count;
            while (at > 0 && fabs(row.shift) > fabs(most[at - 1].shift))
                at--;
            if (!row.id || at == LISTED)
                continue;
            count += count < LISTED;
            memmove(&most[at + 1], &most[at], (size_t)(count - 1 - at) * sizeof *most);
            most[at] = row;
        }
        memcpy(out->hidden + out->nhidden, most, (size_t)count * sizeof *most);
        out->nhidden += count;
    }
    return ROTID_OK;
}
