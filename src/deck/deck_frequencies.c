/* FREQUENCIES: what each mode measures with the accelerometer at one sensor after the other; and what becomes of the frequencies
 * and their noise once everything has been read. */
#include <math.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "rotid.h"
#include "run/run.h"

int deck_new_points(struct deck_reader *reader)
{
    struct job *job = reader->job;
    size_t count = (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
    if (job->measurement.point_frequency_hz)
        return 0;
    double *hz = POOL_ARRAY(reader->pool, double, count), *std = POOL_ARRAY(reader->pool, double, count);
    reader->mean_kept = POOL_ARRAY(reader->pool, int, job->measurement.nmode);
    if (!hz || !std || !reader->mean_kept) {
        reader->out_of_memory = 1;
        return 1;
    }
    for (size_t i = 0; i < count; i++)
        hz[i] = std[i] = NAN;
    job->measurement.point_frequency_hz = hz;
    job->measurement.point_frequency_std = std;
    return 0;
}

int deck_point_is_far(const struct job *job, int mode, double hz)
{
    return !(fabs(hz / job->measurement.frequency_hz[mode] - 1) <= POINT_FREQUENCY_RANGE);
}

void deck_frequencies(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct job *job = reader->job;
    const struct card_option *option = card_option(card, "MODE"), *mean = card_option(card, "MEAN");
    double number;
    int mode = -1, take = 1;
    if (!deck_option(reader, card, "MODE", "number of a mode of *MODES") ||
        deck_option_number(reader, option, "", POSITIVE, &number))
        return;
    for (int k = 0; k < job->measurement.nmode; k++)
        if (job->measurement.number[k] == number)
            mode = k;
    if (mode < 0 || !reader->modes_card) {
        deck_error(reader, option->value_place, "mode %s is not among *MODES, expected one that is", option->value);
        return;
    }
    reader->frequencies_card = card;
    int count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout);
    if (mean)
        take = deck_option_word(reader, mean, deck_answers);
    if (deck_new_points(reader))
        return;
    reader->mean_kept[mode] |= !take;
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        int id;
        double hz, std = NAN;
        if (deck_count(reader, line, 3, layout) || deck_integer(reader, line, 0, "sensor id", 1, 1000000000, &id) ||
            deck_number(reader, line, 1, "frequency [Hz]", POSITIVE, &hz) ||
            (deck_has(line, 2) && deck_number(reader, line, 2, "standard deviation [Hz]", POSITIVE, &std)))
            continue;
        int sensor = sensor_find(job, id);
        if (sensor < 0) {
            deck_error(reader, line->field[0].place, "sensor %d is not among *SENSORS, expected one that is", id);
            continue;
        }
        ptrdiff_t at = sensor + (ptrdiff_t)mode * job->rotor.nsensor;
        if (isfinite(job->measurement.point_frequency_hz[at]))
            deck_error(reader, line->field[0].place, "sensor %d is given twice for mode %s, expected once", id, option->value);
        if (deck_point_is_far(job, mode, hz))
            deck_error(reader, line->field[1].place,
                       "%s Hz at sensor %d is more than 5 %% from mode %s, expected a frequency near its %.6g Hz",
                       line->field[1].text, id, option->value, job->measurement.frequency_hz[mode]);
        job->measurement.point_frequency_hz[at] = hz;
        job->measurement.point_frequency_std[at] = std;
    }
}

/* The mode's frequency and deviation from its readings, where they say one. */
static void settle_mode(struct deck_reader *reader, int k)
{
    struct job *job = reader->job;
    int nsensor = job->rotor.nsensor;
    double *hz = job->measurement.point_frequency_hz + (ptrdiff_t)k * nsensor,
           *std = job->measurement.point_frequency_std + (ptrdiff_t)k * nsensor;
    struct point_mean mean;
    for (int s = 0; s < nsensor && reader->noise_frequency > 0; s++)
        if (!isfinite(std[s]))
            std[s] = reader->noise_frequency * hz[s];
    int status = point_mean(reader->pool, nsensor, hz, std,
                            job->measurement.shape ? job->measurement.shape + (ptrdiff_t)k * nsensor : NULL, &mean);
    if (status == ROTID_ERROR_MEMORY)
        reader->out_of_memory = 1;
    if (status)
        return; /* no reading: the mode keeps its frequency */
    for (int s = 0; s < nsensor; s++)
        if (isfinite(hz[s]) && !isfinite(std[s]))
            std[s] = mean.std_of_others;
    if (reader->mean_kept[k])
        return;
    job->measurement.frequency_hz[k] = mean.hz;
    if (isfinite(mean.std))
        job->measurement.frequency_std[k] = mean.std / mean.hz;
    struct place place = (reader->frequencies_card ? reader->frequencies_card : reader->measured_card)->place;
    if (!mean.regressed)
        deck_note(reader, place,
                  "mode %d has %d frequencies at single sensors, too few to follow the accelerometer along the shape: their mean "
                  "is taken as the frequency with its mass spread over all sensors",
                  job->measurement.number[k], mean.readings);
    if (mean.dropped)
        deck_note(reader, place,
                  "mode %d: %d of %d frequencies at single sensors contradict the others and are left out of their mean",
                  job->measurement.number[k], mean.dropped, mean.readings);
}

void deck_settle_noise(struct deck_reader *reader)
{
    struct job *job = reader->job;
    ptrdiff_t components = job->measurement.shape ? (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode : 0;
    job->measurement.has_noise_floor = reader->floor_shape > 0;
    job->measurement.stated_frequency_noise = reader->noise_frequency > 0 ? reader->noise_frequency : 0;
    job->measurement.stated_shape_noise = reader->noise_shape > 0 ? reader->noise_shape : 0;
    for (int k = 0; k < job->measurement.nmode && job->measurement.point_frequency_hz && !reader->out_of_memory; k++)
        settle_mode(reader, k);
    for (int k = 0; k < job->measurement.nmode; k++)
        if (isfinite(job->measurement.frequency_std[k]))
            job->measurement.frequency_std[k] = hypot(job->measurement.frequency_std[k], reader->floor_frequency);
        else if (reader->noise_frequency > 0)
            job->measurement.frequency_std[k] = reader->noise_frequency;
    for (ptrdiff_t i = 0; i < components; i++)
        if (isfinite(job->measurement.shape_std[i]))
            job->measurement.shape_std[i] = hypot(job->measurement.shape_std[i], reader->floor_shape);
        else if (reader->noise_shape > 0)
            job->measurement.shape_std[i] = reader->noise_shape;
}
