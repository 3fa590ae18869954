/* Cards of measured data that stand in the deck itself, the references of the heading, and what becomes of frequencies and noise
 * once everything has been read. */
#include "deck/deck_row.h"

/* "paper QUANTITY = value, value, ..." gives a reference; any other line is text. */
static int read_reference(struct deck_reader *reader, const struct data_line *line)
{
    struct job *job = reader->job;
    const char *begin = line->text + strlen("paper"), *equals = strchr(line->field[0].text, '='), *end = strchr(line->text, '=');
    if (strncmp(line->text, "paper ", 6) || !equals)
        return 0;
    begin += strspn(begin, " ");
    while (end > begin && end[-1] == ' ')
        end--;
    rotid_reference *reference = &job->reference[job->nreference];
    reference->quantity = pool_format(reader->pool, "%.*s", (int)(end - begin), begin);
    reference->values = POOL_ARRAY(reader->pool, double, line->count);
    if (reader->pool->out_of_memory)
        return 1;
    for (int i = 0; i < line->count; i++) {
        const char *text = i ? line->field[i].text : equals + 1;
        reference->values[i] = strtod(text, NULL);
        if (!table_is_number(text) || !isfinite(reference->values[i]))
            return deck_error(reader, line->field[i].place,
                              "the reference has a value that is not a number, expected paper QUANTITY = number, number, ...");
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
    for (int i = 0; i < card->nline && !reader->pool->out_of_memory; i++)
        if (!read_reference(reader, &card->line[i]))
            job->heading[job->nheading++] = card->line[i].text;
}

int deck_check_sensor(struct deck_reader *reader, const struct data_line *line, void *item)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct sensor *sensor = item;
    if (rotor->nsensor == DECK_MOST_LINES)
        return deck_error(reader, line->place, "the rotor has more than %d sensors, expected fewer", DECK_MOST_LINES);
    for (int s = 0; s < rotor->nsensor; s++)
        if (rotor->sensor[s].id == sensor->id)
            deck_error(reader, line->field[0].place, "sensor %d is given twice, expected a new id", sensor->id);
    return 0;
}

/* Room for modes without shapes. 0, or 1 where memory is out. */
static int new_modes(struct deck_reader *reader, int count)
{
    struct job_measurement *m = &reader->job->measurement;
    m->number = POOL_ARRAY(reader->pool, int, count);
    m->frequency_hz = POOL_ARRAY(reader->pool, double, count);
    m->damping = pool_unknown(reader->pool, (size_t)count);
    m->frequency_std = pool_unknown(reader->pool, (size_t)count);
    return reader->pool->out_of_memory;
}

void deck_modes(struct deck_reader *reader, const struct card *card)
{
    struct job_measurement *m = &reader->job->measurement;
    const struct card_option *type = card_option(card, "TYPE");
    int word = type ? deck_option_word(reader, type, mode_type_words) : MODE_BENDING;
    reader->modes_card = card;
    reader->job->options.type = word > 0 ? (enum mode_type)word : MODE_BENDING;
    int count = deck_lines(reader, card, 1, DECK_MOST_MODES), failed = new_modes(reader, card->nline);
    for (int i = 0; i < count && !failed; i++) {
        const struct data_line *line = &card->line[i];
        struct mode_line read = {.hz = 1, .damping = NAN, .std = NAN};
        int bad = deck_read_values(reader, line, &read), k = 0;
        if (read.damping >= 1)
            deck_error(reader, line->field[2].place, "damping ratio is %s, expected a fraction of critical damping below 1",
                       line->field[2].text);
        if (bad)
            continue;
        while (k < m->nmode && read.number != m->number[k] && (read.number > m->number[k]) == (read.hz > m->frequency_hz[k]) &&
               read.hz != m->frequency_hz[k])
            k++;
        if (k < m->nmode && m->number[k] == read.number)
            deck_error(reader, line->field[0].place, "mode %d is given twice, expected once", read.number);
        else if (k < m->nmode)
            deck_error(reader, line->field[1].place,
                       "mode %d lies at %s Hz and mode %d at %.9g Hz, expected frequencies that rise with the number",
                       read.number, line->field[1].text, m->number[k], m->frequency_hz[k]);
        for (k = m->nmode++; k > 0 && m->number[k - 1] > read.number; k--) { /* kept by rising number */
            m->number[k] = m->number[k - 1];
            m->frequency_hz[k] = m->frequency_hz[k - 1];
            m->damping[k] = m->damping[k - 1];
            m->frequency_std[k] = m->frequency_std[k - 1];
        }
        m->number[k] = read.number;
        m->frequency_hz[k] = read.hz;
        m->damping[k] = read.damping;
        m->frequency_std[k] = read.std / read.hz;
    }
}

static size_t components(const struct job *job)
{
    return (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
}

/* Room for them in the job, once its sensors and modes are known. 0, or 1 where memory is out. */
static int deck_new_points(struct deck_reader *reader)
{
    struct job_measurement *m = &reader->job->measurement;
    if (m->point_frequency_hz)
        return 0;
    double *hz = pool_unknown(reader->pool, components(reader->job));
    m->point_frequency_std = pool_unknown(reader->pool, components(reader->job));
    reader->mean_kept = POOL_ARRAY(reader->pool, int, m->nmode);
    m->point_frequency_hz = reader->pool->out_of_memory ? NULL : hz;
    return reader->pool->out_of_memory;
}

/* Whether hz cannot be a reading of measured mode `mode`. */
static int deck_point_is_far(const struct job *job, int mode, double hz)
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
    return -deck_error(reader, option->value_place, "mode %s is not among *MODES, expected one that is", option->value);
}

/* Values at sensors of mode `of` with their deviations into value and std [nsensor * nmode], NaN where nothing was measured. How
 * many are not zero. */
static int read_at_sensors(struct deck_reader *reader, const struct card *card, int of, double *value, double *std)
{
    const char *mode = card_option(card, "MODE")->value;
    const struct job *job = reader->job;
    ptrdiff_t first = (ptrdiff_t)of * job->rotor.nsensor;
    int any = 0, points = value == job->measurement.point_frequency_hz;
    for (int i = 0, count = deck_lines(reader, card, 1, DECK_MOST_LINES); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct point_line read = {.std = NAN};
        if (deck_read_values(reader, line, &read))
            continue;
        int sensor = sensor_find(job, read.id);
        if (sensor < 0) {
            deck_error(reader, line->field[0].place, "sensor %d is not among *SENSORS, expected one that is", read.id);
            continue;
        }
        if (isfinite(value[first + sensor]))
            deck_error(reader, line->field[0].place, "sensor %d is given twice for mode %s, expected once", read.id, mode);
        if (points && deck_point_is_far(job, of, read.value))
            deck_error(reader, line->field[1].place,
                       "%s Hz at sensor %d is more than 5 %% from mode %s, expected a frequency near its %.6g Hz",
                       line->field[1].text, read.id, mode, job->measurement.frequency_hz[of]);
        value[first + sensor] = read.value;
        std[first + sensor] = read.std;
        any += read.value != 0;
    }
    return any;
}

void deck_shape(struct deck_reader *reader, const struct card *card)
{
    struct job_measurement *m = &reader->job->measurement;
    int mode = mode_of(reader, card);
    if (mode < 0)
        return;
    if (!m->shape) {
        m->shape_std = pool_unknown(reader->pool, components(reader->job));
        m->shape = m->shape_std ? pool_unknown(reader->pool, components(reader->job)) : NULL;
    }
    if (m->shape && !read_at_sensors(reader, card, mode, m->shape, m->shape_std) && card->nline)
        deck_error(reader, card->place, "the shape of mode %s is zero everywhere, expected at least one component that is not",
                   card_option(card, "MODE")->value);
}

void deck_frequencies(struct deck_reader *reader, const struct card *card)
{
    struct job_measurement *m = &reader->job->measurement;
    const struct card_option *mean = card_option(card, "MEAN");
    int mode = mode_of(reader, card);
    if (mode < 0)
        return;
    reader->frequencies_card = card;
    int take = mean ? deck_option_word(reader, mean, deck_answers) : 1;
    if (deck_new_points(reader))
        return;
    reader->mean_kept[mode] |= !take;
    (void)read_at_sensors(reader, card, mode, m->point_frequency_hz, m->point_frequency_std);
}

/* *WEIGHT or *CENTRE */
void deck_weight(struct deck_reader *reader, const struct card *card)
{
    if (reader->job->options.type != MODE_BENDING) {
        deck_error(reader, card->place,
                   "*%s stands beside modes of torsion or along the axis, expected it where bending was measured", card->name);
        return;
    }
    const struct data_line *line = deck_only_line(reader, card);
    if (line && !deck_read_values(reader, line, &reader->job->measurement.weighed))
        reader->weighed_card = card;
}

void deck_noise(struct deck_reader *reader, const struct card *card)
{
    (void)deck_read_options(reader, card, reader);
    reader->states_floor = card_option(card, "FLOOR_FREQUENCY") || card_option(card, "FLOOR_SHAPE");
    if (!card->noption)
        deck_error(
            reader, card->place,
            "*NOISE has no value, expected FREQUENCY=relative standard deviation, SHAPE=the same of the largest component");
}

/* ------------------------------------------------------------------------------------------------ noise */

/* The mode's frequency and deviation from its readings, where they say one. */
static void average_readings(struct deck_reader *reader, int k)
{
    struct job_measurement *m = &reader->job->measurement;
    int nsensor = reader->job->rotor.nsensor;
    ptrdiff_t first = (ptrdiff_t)k * nsensor;
    double *hz = m->point_frequency_hz + first, *std = m->point_frequency_std + first;
    struct point_mean mean;
    for (int s = 0; s < nsensor && reader->noise_frequency > 0; s++)
        if (!isfinite(std[s]))
            std[s] = reader->noise_frequency * hz[s];
    if (point_mean(reader->pool, nsensor, hz, std, m->shape ? m->shape + first : NULL, &mean))
        return; /* no reading: the mode keeps its frequency */
    for (int s = 0; s < nsensor; s++)
        if (isfinite(hz[s]) && !isfinite(std[s]))
            std[s] = mean.std_of_others;
    if (reader->mean_kept[k])
        return;
    m->frequency_hz[k] = mean.hz;
    if (isfinite(mean.std))
        m->frequency_std[k] = mean.std / mean.hz;
    struct place place = (reader->frequencies_card ? reader->frequencies_card : reader->measured_card)->place;
    if (!mean.regressed)
        deck_note(reader, place,
                  "mode %d has %d frequencies at single sensors, too few to follow the accelerometer along the shape: their mean "
                  "is taken as the frequency with its mass spread over all sensors",
                  m->number[k], mean.readings);
    if (mean.dropped)
        deck_note(reader, place,
                  "mode %d: %d of %d frequencies at single sensors contradict the others and are left out of their mean",
                  m->number[k], mean.dropped, mean.readings);
}

/* The standard deviations of one test are of means over its impacts, less than what the next test would show, and a model judged
 * by them alone is refused for 0.001 %. The next test differs by the scatter of one impact at least, std * sqrt(impacts), and by
 * no less than good tests repeat: 0.02 % of a frequency, 0.2 % of the largest component. */
#define USUAL_FLOOR_FREQUENCY 2e-4
#define USUAL_FLOOR_SHAPE     2e-3

/* Median of the values that are known, times factor; 0 of none. */
static double known_median(struct deck_reader *reader, ptrdiff_t count, const double *value, double factor)
{
    double *known = POOL_ARRAY(reader->pool, double, count);
    size_t n = 0;
    for (ptrdiff_t i = 0; i < count && known; i++)
        if (isfinite(value[i]))
            known[n++] = factor * value[i];
    return n ? double_of_rank(n, n / 2, known) : 0;
}

static void take_usual_floor(struct deck_reader *reader)
{
    const struct job_measurement *m = &reader->job->measurement;
    ptrdiff_t count = m->shape ? (ptrdiff_t)components(reader->job) : 0;
    if (!reader->measured_card || reader->states_floor ||
        !(deck_knows_any(m->nmode, m->frequency_std) || deck_knows_any(count, m->shape_std)))
        return;
    int tests = reader->impacts < 0; /* their scatter is known: it counts, unless it is less than good tests repeat */
    double root = sqrt(abs(reader->impacts)), hz = known_median(reader, m->nmode, m->frequency_std, root),
           shape = known_median(reader, count, m->shape_std, root);
    reader->floor_frequency = tests && hz > USUAL_FLOOR_FREQUENCY ? 0 : fmax(USUAL_FLOOR_FREQUENCY, hz);
    reader->floor_shape = tests && shape > USUAL_FLOOR_SHAPE ? 0 : fmax(USUAL_FLOOR_SHAPE, shape);
    if (!reader->floor_frequency && !reader->floor_shape)
        return;
    const char *measured = tests ? "it is measured" : "scatter of single impacts";
    deck_note(reader, reader->measured_card->place,
              "the file states the scatter %s; %.2g %% of frequencies (%s) and %.2g %% of shapes (%s) are added for what differs "
              "between tests; *NOISE, FLOOR_FREQUENCY=, FLOOR_SHAPE= state it for yours, 0 for none",
              tests ? pool_format(reader->pool, "between %d tests", -reader->impacts) : "within one test",
              100 * reader->floor_frequency, hz > USUAL_FLOOR_FREQUENCY ? measured : "the least that is taken",
              100 * reader->floor_shape, shape > USUAL_FLOOR_SHAPE ? measured : "the least that is taken");
}

/* Deviations with the floor in quadrature; those that are not known as *NOISE states it, if above 0. */
static void complete(ptrdiff_t count, double *std, double floor, double noise)
{
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(std[i]))
            std[i] = hypot(std[i], floor);
        else if (noise > 0)
            std[i] = noise;
}

void deck_complete_noise(struct deck_reader *reader)
{
    struct job_measurement *m = &reader->job->measurement;
    take_usual_floor(reader);
    m->has_noise_floor = reader->floor_shape > 0;
    m->stated_frequency_noise = fmax(reader->noise_frequency, 0);
    m->stated_shape_noise = fmax(reader->noise_shape, 0);
    for (int k = 0; k < m->nmode && m->point_frequency_hz && !reader->pool->out_of_memory; k++)
        average_readings(reader, k);
    complete(m->nmode, m->frequency_std, reader->floor_frequency, reader->noise_frequency);
    complete(m->shape ? (ptrdiff_t)components(reader->job) : 0, m->shape_std, reader->floor_shape, reader->noise_shape);
}

/* MEASURED: sensors, modes and shapes from a universal file. */

struct extra {
    struct deck_reader *reader;
    const char *path;
    const struct uff_shape *set;
    int kind, mode; /* of the job */
    int component;  /* of a node */
    int *seen;      /* [UFF_EXTRAS * nmode] */
};

static struct place id_line(const struct extra *extra, int i)
{
    return (struct place){extra->path, extra->set->line + 2 + i, 1}; /* behind '-1' and the number of the set */
}

/* What the set is and of which mode, in a form that can be read. 0; 1 after an error, or where it is none of these. */
static int identify(struct extra *extra, int count, const struct uff_shape *const *chosen)
{
    const struct uff_shape *set = extra->set;
    int number, matches = 0;
    extra->kind = (int)uff_extra_of(set, &number);
    if (extra->kind == UFF_EXTRAS)
        return 1;
    for (int k = 0; k < count; k++)
        if (chosen[k]->number == number) {
            extra->mode = k;
            matches++;
        }
    if (!number || matches != 1)
        return deck_error(extra->reader, id_line(extra, 0), "'%s' names %s, expected the number of one mode of this file",
                          set->id[0],
                          !number   ? "no mode"
                          : matches ? "a number that several modes have"
                                    : "a mode that is not there");
    if (extra->seen[extra->kind + UFF_EXTRAS * extra->mode]++)
        return deck_error(extra->reader, id_line(extra, 0), "'%s' is given twice, expected once", set->id[0]);
    if (set->imag)
        return deck_error(extra->reader, id_line(extra, 0), "the values of '%s' are complex, expected real ones", set->id[0]);
    if (extra->component >= set->component_count)
        return deck_error(extra->reader, id_line(extra, 0), "'%s' has %d values a node, expected DIRECTION to be one of them",
                          set->id[0], set->component_count);
    return 0;
}

static void read_frequency(const struct extra *extra)
{
    struct deck_reader *reader = extra->reader;
    struct job_measurement *m = &reader->job->measurement;
    double hz;
    if (uff_extra_frequency_std(extra->set, &hz) || !deck_is_usual(hz)) {
        deck_error(reader, id_line(extra, 1),
                   "the second line of text is '%s', expected FREQUENCY_HZ value DAMPING value, two standard deviations",
                   extra->set->id[1]);
        return;
    }
    int tests, count = uff_extra_count(extra->set, &tests);
    if (count && tests)
        reader->impacts = -count;
    else if (count && !(reader->impacts && reader->impacts < count))
        reader->impacts = count;
    if (hz > 0)
        m->frequency_std[extra->mode] = hz / m->frequency_hz[extra->mode];
}

/* Six digits of a frequency are too few, so the values may count from one that stands in the second line of text. */
static double read_offset(const struct extra *extra)
{
    const char *text = extra->set->id[1];
    double hz = 0;
    int length = 0;
    if (strncmp(text, "ABOVE", 5) != 0)
        return 0;
    if (sscanf(text, "ABOVE_HZ %lf%n", &hz, &length) != 1 || text[length] || !(isfinite(hz) && hz >= 0))
        deck_error(extra->reader, id_line(extra, 1), "the second line of text is '%s', expected ABOVE_HZ value", text);
    return hz;
}

static void read_values(const struct extra *extra)
{
    static const char *const expected[UFF_EXTRAS] = {"a standard deviation, zero where it is not known",
                                                     "a frequency within 5 % of that of the mode, zero where it is not known",
                                                     "a standard deviation [Hz], zero where it is not known"};
    const struct job *job = extra->reader->job;
    const struct job_measurement *m = &job->measurement;
    const struct uff_shape *set = extra->set;
    ptrdiff_t first = (ptrdiff_t)extra->mode * job->rotor.nsensor;
    int of_shape = extra->kind == UFF_EXTRA_SHAPE_STD, of_point = extra->kind == UFF_EXTRA_POINT;
    double *target = first + (of_shape   ? m->shape_std
                              : of_point ? m->point_frequency_hz
                                         : m->point_frequency_std),
           *shape = m->shape + first, largest = largest_magnitude(job->rotor.nsensor, shape),
           offset = of_point ? read_offset(extra) : 0;
    for (int i = 0; i < set->node_count; i++) {
        int sensor = sensor_find(job, set->node[i]);
        double value = set->real[i * set->component_count + extra->component];
        value += value != 0 ? offset : 0; /* the component of a node that was measured in another direction */
        if (sensor < 0)
            deck_error(extra->reader, id_line(extra, 0), "'%s' has a value at node %d, expected only nodes that are sensors",
                       set->id[0], set->node[i]);
        else if (!isfinite(value) || value < 0 || !deck_is_usual(value) ||
                 (value > 0 && of_point && deck_point_is_far(job, extra->mode, value)))
            deck_error(extra->reader, id_line(extra, 0), "'%s' has %.6g at node %d, expected %s", set->id[0], value, set->node[i],
                       expected[extra->kind]);
        else if (value > 0)
            target[sensor] = of_shape ? value / largest : value;
        else if (of_shape && uff_extra_is_known(set, i) && shape[sensor] == 0)
            shape[sensor] = NAN;
    }
}

void deck_uff_std(struct deck_reader *reader, const char *path, const struct uff_file *file, int count,
                  const struct uff_shape *const *chosen, int component)
{
    struct extra extra = {.reader = reader, .path = path, .seen = POOL_ARRAY(reader->pool, int, UFF_EXTRAS *(size_t)count)};
    for (int i = 0; i < file->extra_count && !reader->pool->out_of_memory; i++) {
        extra.set = &file->extra[i];
        extra.component = extra.set->component_count == 1 ? 0 : component;
        if (identify(&extra, count, chosen))
            continue;
        if (extra.kind != UFF_EXTRA_SHAPE_STD && deck_new_points(reader))
            return;
        if (extra.kind == UFF_EXTRA_SHAPE_STD)
            read_frequency(&extra);
        read_values(&extra);
    }
}

struct import {
    struct deck_reader *reader;
    const struct card *card;
    const char *path;
    struct uff_file file;
    struct measured_nodes at;
};

static struct place in_file(const struct import *import, int line)
{
    return (struct place){import->path, line, 1};
}

ORDER_BY(by_position, struct sensor, it->position, 0)

ORDER_BY(by_id, int, *it, 0)

/* The nodes of all modes by rising id, [*count]; a file of finite elements may have a million. NULL without memory. */
static int *shape_nodes(struct pool *pool, const struct uff_file *file, size_t *count)
{
    *count = 0;
    for (int k = 0; k < file->shape_count; k++)
        *count += uff_is_mode(&file->shape[k]) ? (size_t)file->shape[k].node_count : 0;
    int *id = POOL_ARRAY(pool, int, *count);
    size_t at = 0;
    for (int k = 0; k < file->shape_count && id; k++)
        for (int i = 0; uff_is_mode(&file->shape[k]) && i < file->shape[k].node_count; i++)
            id[at++] = file->shape[k].node[i];
    if (at)
        qsort(id, at, sizeof *id, by_id);
    return id;
}

/* z = origin + scale * coordinate, or origin - scale * coordinate where the test counts from the other end */
static int import_sensors(struct import *import)
{
    struct deck_reader *reader = import->reader;
    struct rotor *rotor = &reader->job->rotor;
    const struct uff_file *file = &import->file;
    if (!file->node_count) {
        if (rotor->nsensor)
            return 0;
        return deck_error(reader, in_file(import, 1),
                          "the file has no nodes (sets 15, 2411), expected them, or a *SENSORS card in the deck");
    }
    if (rotor->nsensor)
        return deck_error(reader, import->card->place,
                          "sensors are given by *SENSORS and by the nodes of %s, expected one of them", import->path);
    rotor->sensor = POOL_ARRAY(reader->pool, struct sensor, file->node_count);
    size_t carried;
    const int *carrying = shape_nodes(reader->pool, file, &carried);
    if (!rotor->sensor || !carrying)
        return 1;
    int outside = 0, first = 0;
    double at = 0;
    for (int i = 0; i < file->node_count; i++) {
        if (!carried || !bsearch(&file->node[i].id, carrying, carried, sizeof *carrying, by_id))
            continue;
        if (rotor->nsensor == DECK_MOST_LINES)
            return deck_error(reader, in_file(import, 1),
                              "the shapes have more than %d nodes, expected those of sensors on a rotor", DECK_MOST_LINES);
        double z = import->at.origin + (import->at.flip ? -1 : 1) * import->at.scale * file->node[i].x[import->at.axis];
        if (!(z >= -1e-5 * reader->length && z <= reader->length * (1 + 1e-5))) {
            if (!outside++) {
                first = i;
                at = z;
            }
            continue;
        }
        z = fmin(fmax(z, 0), reader->length);
        rotor->sensor[rotor->nsensor++] = (struct sensor){file->node[i].id, z};
    }
    if (outside) /* of a wrong unit or axis all of them are */
        deck_error(reader, in_file(import, 1),
                   "node %d lies at %.6g m of the model, outside the rotor%s, expected 0 to %.6g m: check AXIS, ORIGIN, FLIP, "
                   "SCALE and the unit",
                   file->node[first].id, at, outside > 1 ? pool_format(reader->pool, ", and %d more nodes are", outside - 1) : "",
                   reader->length);
    if (rotor->nsensor)
        qsort(rotor->sensor, (size_t)rotor->nsensor, sizeof *rotor->sensor, by_position);
    for (int s = 0; s < rotor->nsensor; s++)
        deck_add_place(reader, SENSOR_PLACES, in_file(import, 1));
    return outside > 0;
}

/* Modes by rising frequency, without the second of each conjugate pair. */
static int choose_modes(struct import *import, const struct uff_shape **chosen)
{
    int rigid, conjugates, kept = uff_choose_modes(&import->file, chosen, &rigid, &conjugates);
    if (rigid)
        deck_note(import->reader, in_file(import, 1), "%d modes at 0 Hz are left out: they do not bend", rigid);
    if (conjugates)
        deck_note(import->reader, in_file(import, chosen[0]->line),
                  "%d shapes repeat the frequency of another and are left out, as conjugates of it", conjugates);
    return kept;
}

static void place_components(struct import *import, const struct uff_shape *shape, const double *value, double *target)
{
    int missing = 0;
    for (int i = 0; i < shape->node_count; i++) {
        int s = sensor_find(import->reader->job, shape->node[i]);
        if (s >= 0)
            target[s] = value[i];
        missing += s < 0;
    }
    if (missing)
        deck_error(import->reader, in_file(import, shape->line),
                   "%d nodes of this shape have no position, expected all of them among the sensors", missing);
}

static int import_shape(struct import *import, const struct uff_shape *shape, double *target)
{
    struct deck_reader *reader = import->reader;
    int component = shape->component_count == 1 ? 0 : import->at.component;
    if (component >= shape->component_count)
        return deck_error(reader, in_file(import, shape->line),
                          "the shape has %d values a node, expected DIRECTION to be one of them", shape->component_count);
    double *value = POOL_ARRAY(reader->pool, double, shape->node_count);
    if (!value)
        return 1;
    double largest = 0;
    for (int i = 0; i < shape->node_count; i++) {
        int at = i * shape->component_count + component;
        largest = fmax(largest, hypot(shape->real[at], shape->imag ? shape->imag[at] : 0));
    }
    if (!deck_is_usual(largest) || !deck_is_usual(shape->frequency_hz))
        return deck_error(reader, in_file(import, shape->line),
                          "the shape has a frequency of %.6g Hz and a largest component of %.6g, expected sizes from %g to %g",
                          shape->frequency_hz, largest, DECK_LEAST, DECK_MOST);
    if (largest == 0)
        return deck_error(reader, in_file(import, shape->line),
                          "the shape at %.6g Hz is zero everywhere in this direction, expected another DIRECTION",
                          shape->frequency_hz);
    double left = uff_real_shape(shape, component, value);
    if (left > 0.05)
        deck_note(reader, in_file(import, shape->line),
                  "%.0f %% of the motion of the shape at %.6g Hz is out of phase and left out", 100 * left, shape->frequency_hz);
    place_components(import, shape, value, target);
    return 0;
}

/* The sensor beside the hammer: of the card, else of the line that `rotid ema` writes. */
static int import_hammer(struct import *import, const struct uff_shape *mode)
{
    static const char line[] = "ROTID HAMMER AT NODE ";
    struct job *job = import->reader->job;
    const struct card_option *option = card_option(import->card, "HAMMER");
    char *end;
    for (int i = 0; i < UFF_ID_LINES && !option; i++)
        if (!strncmp(mode->id[i], line, sizeof line - 1))
            job->measurement.hammer = (int)strtol(mode->id[i] + sizeof line - 1, NULL, 10);
    if (!option)
        return 0;
    long id = strtol(option->value, &end, 10);
    if (end != option->value && !*end && sensor_find(job, (int)id) >= 0) {
        job->measurement.hammer = (int)id;
        return 0;
    }
    return deck_error(import->reader, option->value_place, "HAMMER is %s, expected the id of a sensor of %s", option->value,
                      import->path);
}

static int import_modes(struct import *import)
{
    struct deck_reader *reader = import->reader;
    struct job_measurement *m = &reader->job->measurement;
    ptrdiff_t nsensor = reader->job->rotor.nsensor;
    const struct uff_shape **chosen = POOL_ARRAY(reader->pool, const struct uff_shape *, import->file.shape_count);
    int count = chosen ? choose_modes(import, chosen) : 0, bad = 0;
    if (chosen && !count)
        return deck_error(reader, in_file(import, 1), "the file has no mode shapes, expected sets 55 of normal or complex modes");
    m->shape = pool_unknown(reader->pool, (size_t)nsensor * (size_t)count);
    m->shape_std = pool_unknown(reader->pool, (size_t)nsensor * (size_t)count);
    if (new_modes(reader, import->file.shape_count)) /* room for the numbers of those that are left out */
        return 1;
    uff_mode_numbers(&import->file, count, chosen, m->number);
    for (int k = 0; k < count; k++) {
        if (m->number[k] > DECK_MOST_MODES && !bad++)
            deck_error(reader, in_file(import, chosen[k]->line), "the number of a mode is %d, expected 1 to %d", m->number[k],
                       DECK_MOST_MODES);
        m->frequency_hz[k] = uff_mode_frequency(chosen[k]);
        if (chosen[k]->damping > 0)
            m->damping[k] = chosen[k]->damping;
        bad |= import_shape(import, chosen[k], m->shape + k * nsensor);
    }
    m->nmode = count;
    bad |= import_hammer(import, chosen[0]);
    if (!bad)
        deck_uff_std(reader, import->path, &import->file, count, chosen, import->at.component);
    return bad;
}

void deck_measured(struct deck_reader *reader, const struct card *card)
{
    struct import import = {.reader = reader, .card = card, .at = {.scale = 1, .origin = NAN}};
    reader->measured_card = card;
    if (reader->modes_card) {
        deck_error(reader, card->place, "modes are given by *MODES and by *MEASURED, expected one of them");
        return;
    }
    const char *file = deck_option(reader, card, "FILE", "path of a universal file");
    if (deck_read_options(reader, card, &import.at) || !file)
        return;
    if (isnan(import.at.origin))
        import.at.origin = import.at.flip ? reader->length : 0;
    import.path = deck_path(reader, card, card_option(card, "FILE"));
    if (!import.path)
        return;
    struct message_list found;
    message_open(&found, reader->pool);
    int status = uff_read(reader->pool, import.path, &found, &import.file);
    reader->pool->out_of_memory |= status == ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < found.count; i++) {
        const rotid_message *m = &found.item[i];
        if (status == ROTID_ERROR_IO && m->severity == SEVERITY_ERROR)
            deck_error(reader, card_option(card, "FILE")->value_place, "%s %s, expected a universal file", import.path, m->text);
        else
            message_at(reader->messages, m->severity, *m, "%s", m->text);
    }
    if (!status && !import_sensors(&import))
        (void)import_modes(&import);
}
