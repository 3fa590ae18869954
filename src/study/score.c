#include "study/score.h"

#include <math.h>
#include <string.h>

#define PLACE_TOLERANCE 0.03 /* of the length of the rotor */

/* Where a mass is that stays in one place; NaN for other effects, and where an accelerometer moves. */
static double place_of_mass(const struct rotor *rotor, const struct cause_kind *cause, const struct effect *effect)
{
    if (!strcmp(cause->id, "added_mass"))
        return effect->value[cause->place];
    if (!strcmp(cause->id, "accelerometer_mass") && effect->target >= 0 && effect->target < rotor->nsensor)
        return rotor->sensor[effect->target].position;
    return NAN;
}

int score_is_hidden(const struct experiment *e, const struct diagnosis *d, const struct candidate *c)
{
    const struct truth *truth = e->made_by;
    if (!truth->effect || c->state >= 0) /* it acts in all states */
        return 0;
    double mass = place_of_mass(&truth->job.rotor, truth->cause, truth->effect),
           found = place_of_mass(&d->job.rotor, c->cause, &c->effect);
    if (isfinite(mass) || isfinite(found))
        return fabs(mass - found) <= PLACE_TOLERANCE * e->length;
    if (c->cause != truth->cause)
        return 0;
    if (c->cause->target != TARGET_NONE && c->cause->target != TARGET_SENSOR && c->effect.target != truth->effect->target)
        return 0;
    if (c->cause->place < 0)
        return 1;
    double width = c->cause->width >= 0 ? truth->effect->value[c->cause->width] : 0;
    return fabs(c->effect.value[c->cause->place] - truth->effect->value[c->cause->place]) <=
           fmax(width, PLACE_TOLERANCE * e->length);
}

static int has_sensor(const rotid_data_finding *f, int id)
{
    for (int i = 0; i < f->nsensors; i++)
        if (f->sensors[i] == id)
            return 1;
    return 0;
}

static int finding_is_hidden(const struct experiment *e, const rotid_data_finding *f)
{
    const struct truth *truth = e->made_by;
    if (!truth->cause || truth->effect || strcmp(f->id, truth->cause->id) != 0)
        return 0;
    if (truth->fault.block)
        return f->block && !strcmp(f->block, truth->fault.block);
    for (int i = 0; i < truth->fault.nsensor; i++)
        if (!has_sensor(f, truth->fault.sensor[i]) && (i == 0 || !strcmp(truth->cause->id, "sensor_swap")))
            return 0;
    return 1;
}

int score_false_findings(const struct experiment *e, const struct diagnosis *d)
{
    int count = 0;
    for (int i = 0; i < d->result.ndata_findings; i++)
        count += !finding_is_hidden(e, &d->result.data_findings[i]);
    return count;
}

static int is_in_set(const struct experiment *e, const struct diagnosis *d)
{
    for (int i = 0; i < d->nalternative; i++)
        if (score_is_hidden(e, d, &d->alternative[i]))
            return 1;
    return 0;
}

enum score score_make(const struct experiment *e, const struct diagnosis *d)
{
    const struct truth *truth = e->made_by;
    int wrong = 0, faults = score_false_findings(e, d), found = d->result.ndata_findings > faults;
    if (!truth->cause)
        return d->result.verdict.kind == ROTID_ADEQUATE && !d->ncause && !d->result.ndata_findings ? SCORE_QUIET
                                                                                                   : SCORE_FALSE_ALARM;
    for (int i = 0; i < d->ncause; i++)
        wrong |= !score_is_hidden(e, d, &d->cause[i]);
    if (wrong)
        return SCORE_WRONG;
    if (!truth->effect)
        return found                                      ? SCORE_RIGHT
               : faults                                   ? SCORE_WRONG
               : d->result.verdict.kind == ROTID_ADEQUATE ? SCORE_SILENT
                                                          : SCORE_UNEXPLAINED;
    if (d->ncause)
        return SCORE_RIGHT;
    if (d->result.verdict.kind == ROTID_AMBIGUOUS)
        return is_in_set(e, d) ? SCORE_IN_SET : SCORE_OTHER_SET;
    return d->result.verdict.kind == ROTID_ADEQUATE ? SCORE_SILENT : SCORE_UNEXPLAINED;
}
