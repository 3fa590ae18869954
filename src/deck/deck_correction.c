/* What CAUSE cards of the measurement chain do once everything has been read, and what *IDENTIFY says of them. */
#include <math.h>
#include <string.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"

/* The places of the sensors in the deck, where a correction has changed their order. */
static void follow_sensors(struct deck_reader *reader, const struct job_raw *raw)
{
    struct place *place = POOL_ARRAY(reader->pool, struct place, raw->nsensor);
    if (!place) {
        reader->out_of_memory = 1;
        return;
    }
    for (int s = 0; s < raw->nsensor; s++)
        place[sensor_find(reader->job, raw->sensor[s].id)] = reader->sensor_place[s];
    reader->sensor_place = place;
}

static int knows_any(ptrdiff_t count, const double *std)
{
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(std[i]))
            return 1;
    return 0;
}

void deck_apply_corrections(struct deck_reader *reader)
{
    struct job *job = reader->job;
    if (!job->measurement.ncorrection)
        return;
    if (corrections_keep_raw(reader->pool, job)) {
        reader->out_of_memory = 1;
        return;
    }
    for (int i = 0; i < job->measurement.ncorrection; i++) {
        const struct correction *correction = &job->measurement.correction[i];
        int shape = correction->block && same_text(correction->block, "SHAPE");
        if (correction->block &&
            !(shape ? job->measurement.shape &&
                          knows_any((ptrdiff_t)job->rotor.nsensor * job->measurement.nmode, job->measurement.shape_std)
                    : knows_any(job->measurement.nmode, job->measurement.frequency_std))) {
            deck_error(reader, reader->correction_place[i], "the noise of AT=%s is not stated, expected *NOISE, %s=value",
                       correction->block, correction->block);
            continue;
        }
        int status = correction_apply(reader->pool, job, correction);
        if (status == ROTID_ERROR_MEMORY)
            reader->out_of_memory = 1;
        else if (status && !correction->nsensor)
            deck_error(reader, reader->correction_place[i],
                       "%s puts sensors beyond the rotor, expected a shift and a scale that leave all of them on it",
                       correction->id);
        else if (status)
            deck_error(reader, reader->correction_place[i],
                       "%s leaves sensor %d no place of its own among the others, expected another shift", correction->id,
                       correction->sensor[0]);
        if (status)
            return;
    }
    follow_sensors(reader, job->measurement.raw);
}

int deck_cause_explains(struct deck_reader *reader, const char *parameter, struct place place)
{
    const struct job *job = reader->job;
    const char *dot = strrchr(parameter, '.');
    char *name = dot ? pool_format(reader->pool, "%.*s", (int)(dot - parameter), parameter) : NULL;
    reader->out_of_memory |= dot && !name;
    for (int i = 0; i < job->unknowns.nsuspect && name; i++)
        if (same_text(job->unknowns.suspect[i].effect.name, name)) {
            deck_error(reader, place, "%s is of a suspect, expected a *CAUSE that is part of the model, without SUSPECT",
                       parameter);
            return 1;
        }
    for (int i = 0; i < job->measurement.ncorrection && name; i++)
        if (same_text(job->measurement.correction[i].name, name)) {
            deck_error(reader, place,
                       "%s is of a fault of the measured data, which is stated and not identified, expected a cause in the rotor",
                       parameter);
            return 1;
        }
    for (int c = 0; c < reader->text.ncard && name; c++) {
        const struct card_option *option = card_option(&reader->text.card[c], "NAME");
        if (!strcmp(reader->text.card[c].name, "CAUSE") && option && same_text(option->value, name))
            return 1;
    }
    return 0;
}
