/* Cards of measured data that stand in the deck itself, the references of the heading, and what becomes of frequencies and noise
 * once everything has been read. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck_row.h"
#include "diagnose/causes/causes.h"

/* "paper QUANTITY = value, value, ..." gives a reference; any other line is text. */
static int read_reference(struct deck_reader *reader, const struct data_line *line)
{
    struct job *job = reader->job;
    const char *equals = strchr(line->text, '=');
    if (strncmp(line->text, "paper ", 6) || !equals)
        return 0;
    const char *begin = line->text + 6, *end = equals;
    while (*begin == ' ')
        begin++;
    while (end > begin && end[-1] == ' ')
        end--;
    rotid_reference *reference = &job->reference[job->nreference];
    reference->quantity = pool_format(reader->pool, "%.*s", (int)(end - begin), begin);
    reference->values = POOL_ARRAY(reader->pool, double, line->count);
    reader->out_of_memory |= !reference->quantity || !reference->values;
    if (reader->out_of_memory)
        return 1;
    for (int i = 0; i < line->count; i++) {
        const char *text = i ? line->field[i].text : equals + 1;
        char *rest;
        reference->values[i] = strtod(text, &rest);
        while (*rest == ' ' || (!i && *rest == ','))
            rest = *rest == ',' ? "" : rest + 1;
        if (rest == text || *rest || !isfinite(reference->values[i])) {
            deck_error(reader, line->field[i].place,
                       "the reference has a value that is not a number, expected paper QUANTITY = number, number, ...");
            return 1;
        }
    }
    reference->nvalues = line->count;
    job->nreference++;
    return 1;
}

void deck_heading(struct deck_reader *reader, const struct card *card)
{
    struct job *job = reader->job;
    job->heading = POOL_ARRAY(reader->pool, const char *, card->nline);
    job->reference = POOL_ARRAY(reader->pool, rotid_reference, card->nline);
    reader->out_of_memory |= !job->heading || !job->reference;
    for (int i = 0; i < card->nline && !reader->out_of_memory; i++)
        if (!read_reference(reader, &card->line[i]))
            job->heading[job->nheading++] = card->line[i].text;
}

void deck_sensors(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct rotor *rotor = &reader->job->rotor;
    int count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout);
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct sensor sensor;
        if (deck_count(reader, line, 2, layout) || deck_integer(reader, line, 0, "sensor id", 1, 1000000000, &sensor.id))
            continue;
        if (!deck_has(line, 1)) {
            deck_error(reader, line->end, "a value is missing, expected the position of sensor %d", sensor.id);
            continue;
        }
        if (deck_position(reader, &line->field[1], "position", &sensor.position))
            continue;
        if (rotor->nsensor == DECK_MOST_LINES) {
            deck_error(reader, line->place, "the rotor has more than %d sensors, expected fewer", DECK_MOST_LINES);
            return;
        }
        for (int s = 0; s < rotor->nsensor; s++)
            if (rotor->sensor[s].id == sensor.id)
                deck_error(reader, line->field[0].place, "sensor %d is given twice, expected a new id", sensor.id);
        int at = rotor->nsensor; /* kept by increasing position */
        deck_add_place(reader, SENSOR_PLACES, line->place);
        if (reader->out_of_memory || DECK_ADD(reader, rotor->sensor, rotor->nsensor, &sensor))
            return;
        struct place *place = reader->place[SENSOR_PLACES];
        for (; at > 0 && rotor->sensor[at - 1].position > sensor.position; at--) {
            rotor->sensor[at] = rotor->sensor[at - 1];
            place[at] = place[at - 1];
        }
        rotor->sensor[at] = sensor;
        place[at] = line->place;
    }
}

void deck_modes(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct job *job = reader->job;
    const struct card_option *type = card_option(card, "TYPE");
    int word = type ? deck_option_word(reader, type, mode_type_words) : MODE_BENDING;
    reader->modes_card = card;
    job->options.type = word > 0 ? (enum mode_type)word : MODE_BENDING;
    int count = deck_lines(reader, card, 1, DECK_MOST_MODES, layout);
    job->measurement.number = POOL_ARRAY(reader->pool, int, card->nline);
    job->measurement.frequency_hz = POOL_ARRAY(reader->pool, double, card->nline);
    job->measurement.damping = POOL_ARRAY(reader->pool, double, card->nline);
    job->measurement.frequency_std = POOL_ARRAY(reader->pool, double, card->nline);
    if (!job->measurement.number || !job->measurement.frequency_hz || !job->measurement.damping ||
        !job->measurement.frequency_std) {
        reader->out_of_memory = 1;
        return;
    }
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        int number = 0;
        double hz = 1, damping = NAN, std = NAN;
        int bad = deck_count(reader, line, 4, layout) || deck_integer(reader, line, 0, "mode", 1, DECK_MOST_MODES, &number);
        bad |= deck_number(reader, line, 1, "frequency [Hz]", POSITIVE, &hz);
        if (deck_has(line, 2))
            bad |= deck_number(reader, line, 2, "damping ratio", NOT_NEGATIVE, &damping);
        if (deck_has(line, 3))
            bad |= deck_number(reader, line, 3, "standard deviation of the frequency [Hz]", POSITIVE, &std);
        if (isfinite(damping) && damping >= 1)
            deck_error(reader, line->field[2].place, "damping ratio is %s, expected a fraction of critical damping below 1",
                       line->field[2].text);
        if (bad)
            continue;
        int k = 0;
        while (k < job->measurement.nmode && number != job->measurement.number[k] &&
               (number > job->measurement.number[k]) == (hz > job->measurement.frequency_hz[k]) &&
               hz != job->measurement.frequency_hz[k])
            k++;
        if (k < job->measurement.nmode && job->measurement.number[k] == number)
            deck_error(reader, line->field[0].place, "mode %d is given twice, expected once", number);
        else if (k < job->measurement.nmode)
            deck_error(reader, line->field[1].place,
                       "mode %d lies at %s Hz and mode %d at %.9g Hz, expected frequencies that rise with the number", number,
                       line->field[1].text, job->measurement.number[k], job->measurement.frequency_hz[k]);
        k = job->measurement.nmode++;
        job->measurement.number[k] = number;
        job->measurement.frequency_hz[k] = hz;
        job->measurement.damping[k] = damping;
        job->measurement.frequency_std[k] = std / hz;
    }
}

/* Values at sensors of one mode, with their deviations, into value and std [nsensor] of it; NaN where nothing was measured. */
struct at_sensors {
    const char *what, *std; /* of a data line, for messages */
    enum range range;
    int mode;
    double *value, *deviation;
};

double *deck_new_values(struct deck_reader *reader, size_t count)
{
    double *value = POOL_ARRAY(reader->pool, double, count);
    reader->out_of_memory |= !value;
    for (size_t i = 0; i < count && value; i++)
        value[i] = NAN;
    return value;
}

static size_t components(const struct job *job)
{
    return (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
}

int deck_new_points(struct deck_reader *reader)
{
    struct job_measurement *m = &reader->job->measurement;
    if (m->point_frequency_hz)
        return 0;
    double *hz = deck_new_values(reader, components(reader->job));
    m->point_frequency_std = deck_new_values(reader, components(reader->job));
    reader->mean_kept = POOL_ARRAY(reader->pool, int, m->nmode);
    reader->out_of_memory |= !reader->mean_kept;
    m->point_frequency_hz = reader->out_of_memory ? NULL : hz;
    return reader->out_of_memory;
}

int deck_point_is_far(const struct job *job, int mode, double hz)
{
    return !(fabs(hz / job->measurement.frequency_hz[mode] - 1) <= POINT_FREQUENCY_RANGE);
}

/* The mode of a card, -1 after an error. */
static int mode_of(struct deck_reader *reader, const struct card *card)
{
    const struct job_measurement *m = &reader->job->measurement;
    const struct card_option *option = card_option(card, "MODE");
    double number;
    if (!deck_option(reader, card, "MODE", "number of a mode of *MODES") ||
        deck_option_number(reader, option, "", POSITIVE, &number))
        return -1;
    for (int k = 0; k < m->nmode && reader->modes_card; k++)
        if (m->number[k] == number)
            return k;
    deck_error(reader, option->value_place, "mode %s is not among *MODES, expected one that is", option->value);
    return -1;
}

/* How many values are not zero. */
static int read_at_sensors(struct deck_reader *reader, const struct card *card, const struct at_sensors *to)
{
    const char *layout = reader->layout, *mode = card_option(card, "MODE")->value;
    const struct job *job = reader->job;
    ptrdiff_t first = (ptrdiff_t)to->mode * job->rotor.nsensor;
    int any = 0, points = to->value == job->measurement.point_frequency_hz;
    for (int i = 0, count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout); i < count; i++) {
        const struct data_line *line = &card->line[i];
        int id;
        double value, std = NAN;
        if (deck_count(reader, line, 3, layout) || deck_integer(reader, line, 0, "sensor id", 1, 1000000000, &id) ||
            deck_number(reader, line, 1, to->what, to->range, &value) ||
            (deck_has(line, 2) && deck_number(reader, line, 2, to->std, POSITIVE, &std)))
            continue;
        int sensor = sensor_find(job, id);
        if (sensor < 0) {
            deck_error(reader, line->field[0].place, "sensor %d is not among *SENSORS, expected one that is", id);
            continue;
        }
        if (isfinite(to->value[first + sensor]))
            deck_error(reader, line->field[0].place, "sensor %d is given twice for mode %s, expected once", id, mode);
        if (points && deck_point_is_far(job, to->mode, value))
            deck_error(reader, line->field[1].place,
                       "%s Hz at sensor %d is more than 5 %% from mode %s, expected a frequency near its %.6g Hz",
                       line->field[1].text, id, mode, job->measurement.frequency_hz[to->mode]);
        to->value[first + sensor] = value;
        to->deviation[first + sensor] = std;
        any += value != 0;
    }
    return any;
}

void deck_shape(struct deck_reader *reader, const struct card *card)
{
    struct job_measurement *m = &reader->job->measurement;
    struct at_sensors to = {.what = "value", .std = "standard deviation", .range = ANY, .mode = mode_of(reader, card)};
    if (to.mode < 0)
        return;
    if (!m->shape) {
        m->shape_std = deck_new_values(reader, components(reader->job));
        m->shape = m->shape_std ? deck_new_values(reader, components(reader->job)) : NULL;
    }
    to.value = m->shape;
    to.deviation = m->shape_std;
    if (to.value && !read_at_sensors(reader, card, &to) && card->nline)
        deck_error(reader, card->place, "the shape of mode %s is zero everywhere, expected at least one component that is not",
                   card_option(card, "MODE")->value);
}

void deck_frequencies(struct deck_reader *reader, const struct card *card)
{
    struct job_measurement *m = &reader->job->measurement;
    const struct card_option *mean = card_option(card, "MEAN");
    struct at_sensors to = {
        .what = "frequency [Hz]", .std = "standard deviation [Hz]", .range = POSITIVE, .mode = mode_of(reader, card)};
    if (to.mode < 0)
        return;
    reader->frequencies_card = card;
    int take = mean ? deck_option_word(reader, mean, deck_answers) : 1;
    if (deck_new_points(reader))
        return;
    reader->mean_kept[to.mode] |= !take;
    to.value = m->point_frequency_hz;
    to.deviation = m->point_frequency_std;
    (void)read_at_sensors(reader, card, &to);
}

void deck_noise(struct deck_reader *reader, const struct card *card)
{
    (void)deck_read_options(reader, card, deck_noise_rows, reader);
    if (!card->noption)
        deck_error(
            reader, card->place,
            "*NOISE has no value, expected FREQUENCY=relative standard deviation, SHAPE=the same of the largest component");
}

/* ------------------------------------------------------------------------------------------------ noise */

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
