/* Cards of measured data that stand in the deck itself, and the references of the heading. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck_row.h"

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
    if (job->heading) {
        deck_error(reader, card->place, "*HEADING is given twice, expected once");
        return;
    }
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
        struct sensor *added = DECK_APPEND(reader, rotor->sensor, rotor->nsensor, reader->sensor_room);
        struct place *place = DECK_APPEND(reader, reader->sensor_place, rotor->nsensor, reader->sensor_place_room);
        if (!added || !place)
            return;
        int at = rotor->nsensor++; /* kept by increasing position */
        for (; at > 0 && rotor->sensor[at - 1].position > sensor.position; at--) {
            rotor->sensor[at] = rotor->sensor[at - 1];
            reader->sensor_place[at] = reader->sensor_place[at - 1];
        }
        rotor->sensor[at] = sensor;
        reader->sensor_place[at] = line->place;
    }
}

void deck_modes(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct job *job = reader->job;
    if (reader->modes_card) {
        deck_error(reader, card->place, "*MODES is given twice, expected once");
        return;
    }
    reader->modes_card = card;
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

static int find_sensor(const struct rotor *rotor, int id)
{
    for (int s = 0; s < rotor->nsensor; s++)
        if (rotor->sensor[s].id == id)
            return s;
    return -1;
}

static void new_shapes(struct deck_reader *reader)
{
    struct job *job = reader->job;
    size_t components = (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
    job->measurement.shape = POOL_ARRAY(reader->pool, double, components);
    job->measurement.shape_std = POOL_ARRAY(reader->pool, double, components);
    if (!job->measurement.shape || !job->measurement.shape_std) {
        job->measurement.shape = NULL;
        reader->out_of_memory = 1;
        return;
    }
    for (size_t i = 0; i < components; i++)
        job->measurement.shape[i] = job->measurement.shape_std[i] = NAN;
}

void deck_shape(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct job *job = reader->job;
    const struct card_option *option = card_option(card, "MODE");
    double number;
    int mode = -1;
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
    int count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout);
    if (!job->measurement.shape)
        new_shapes(reader);
    if (!job->measurement.shape)
        return;
    double *shape = job->measurement.shape + (ptrdiff_t)mode * job->rotor.nsensor,
           *std = job->measurement.shape_std + (ptrdiff_t)mode * job->rotor.nsensor;
    int any = 0;
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        int id, sensor;
        double value, deviation = NAN;
        if (deck_count(reader, line, 3, layout) || deck_integer(reader, line, 0, "sensor id", 1, 1000000000, &id) ||
            deck_number(reader, line, 1, "value", ANY, &value) ||
            (deck_has(line, 2) && deck_number(reader, line, 2, "standard deviation", POSITIVE, &deviation)))
            continue;
        sensor = find_sensor(&job->rotor, id);
        if (sensor < 0) {
            deck_error(reader, line->field[0].place, "sensor %d is not among *SENSORS, expected one that is", id);
            continue;
        }
        if (isfinite(shape[sensor]))
            deck_error(reader, line->field[0].place, "sensor %d is given twice for mode %s, expected once", id, option->value);
        shape[sensor] = value;
        std[sensor] = deviation;
        any |= value != 0;
    }
    if (!any && card->nline)
        deck_error(reader, card->place, "the shape of mode %s is zero everywhere, expected at least one component that is not",
                   option->value);
}

void deck_noise(struct deck_reader *reader, const struct card *card)
{
    if (reader->noise_card)
        deck_error(reader, card->place, "*NOISE is given twice, expected once");
    reader->noise_card = card;
    (void)deck_read_options(reader, card, deck_noise_rows, reader);
    if (!card->noption)
        deck_error(
            reader, card->place,
            "*NOISE has no value, expected FREQUENCY=relative standard deviation, SHAPE=the same of the largest component");
    for (int i = 0; i < card->nline; i++)
        deck_error(reader, card->line[i].place, "*NOISE has no data lines, expected options on the card");
}
