/* MEASURED: sensors, modes and shapes from a universal file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "rotid.h"
#include "uff/uff.h"

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

/* What the set is and of which mode. 0; 1 after an error, or where it is none of these. */
static int identify(struct extra *extra, int count, const struct uff_shape *const *chosen)
{
    const char *text = extra->set->id[0];
    int number, matches = 0;
    extra->kind = (int)uff_extra_of(extra->set, &number);
    if (extra->kind == UFF_EXTRAS)
        return 1;
    for (int k = 0; k < count; k++)
        if (chosen[k]->number == number) {
            extra->mode = k;
            matches++;
        }
    if (!number || matches != 1) {
        deck_error(extra->reader, id_line(extra, 0), "'%s' names %s, expected the number of one mode of this file", text,
                   !number   ? "no mode"
                   : matches ? "a number that several modes have"
                             : "a mode that is not there");
        return 1;
    }
    if (extra->seen[extra->kind + UFF_EXTRAS * extra->mode]++) {
        deck_error(extra->reader, id_line(extra, 0), "'%s' is given twice, expected once", text);
        return 1;
    }
    return 0;
}

static int check_form(const struct extra *extra)
{
    const struct uff_shape *set = extra->set;
    if (set->imag) {
        deck_error(extra->reader, id_line(extra, 0), "the values of '%s' are complex, expected real ones", set->id[0]);
        return 1;
    }
    if (extra->component >= set->component_count) {
        deck_error(extra->reader, id_line(extra, 0), "'%s' has %d values a node, expected DIRECTION to be one of them",
                   set->id[0], set->component_count);
        return 1;
    }
    return 0;
}

static void read_frequency(const struct extra *extra)
{
    struct job *job = extra->reader->job;
    const char *text = extra->set->id[1];
    double hz;
    if (uff_extra_frequency_std(extra->set, &hz) || !deck_is_usual(hz)) {
        deck_error(extra->reader, id_line(extra, 1),
                   "the second line of text is '%s', expected FREQUENCY_HZ value DAMPING value, "
                   "two standard deviations",
                   text);
        return;
    }
    if (hz > 0)
        job->measurement.frequency_std[extra->mode] = hz / job->measurement.frequency_hz[extra->mode];
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
    struct job *job = extra->reader->job;
    const struct uff_shape *set = extra->set;
    ptrdiff_t first = (ptrdiff_t)extra->mode * job->rotor.nsensor;
    double *target = extra->kind == UFF_EXTRA_SHAPE_STD ? job->measurement.shape_std
                     : extra->kind == UFF_EXTRA_POINT   ? job->measurement.point_frequency_hz
                                                        : job->measurement.point_frequency_std,
           largest = 0;
    for (int s = 0; s < job->rotor.nsensor; s++)
        if (isfinite(job->measurement.shape[first + s]))
            largest = fmax(largest, fabs(job->measurement.shape[first + s]));
    double offset = extra->kind == UFF_EXTRA_POINT ? read_offset(extra) : 0;
    for (int i = 0; i < set->node_count; i++) {
        int sensor = sensor_find(job, set->node[i]);
        double value = set->real[i * set->component_count + extra->component];
        value += value != 0 ? offset : 0; /* the component of a node that was measured in another direction */
        if (sensor < 0) {
            deck_error(extra->reader, id_line(extra, 0), "'%s' has a value at node %d, expected only nodes that are sensors",
                       set->id[0], set->node[i]);
            continue;
        }
        if (!isfinite(value) || value < 0 || !deck_is_usual(value) ||
            (value > 0 && extra->kind == UFF_EXTRA_POINT && deck_point_is_far(job, extra->mode, value))) {
            deck_error(extra->reader, id_line(extra, 0), "'%s' has %.6g at node %d, expected %s", set->id[0], value, set->node[i],
                       expected[extra->kind]);
            continue;
        }
        if (value > 0)
            target[first + sensor] = extra->kind == UFF_EXTRA_SHAPE_STD ? value / largest : value;
    }
}

void deck_uff_std(struct deck_reader *reader, const char *path, const struct uff_file *file, int count,
                  const struct uff_shape *const *chosen, int component)
{
    struct extra extra = {.reader = reader, .path = path, .seen = POOL_ARRAY(reader->pool, int, UFF_EXTRAS *(size_t)count)};
    reader->out_of_memory |= !extra.seen;
    for (int i = 0; i < file->extra_count && !reader->out_of_memory; i++) {
        extra.set = &file->extra[i];
        extra.component = extra.set->component_count == 1 ? 0 : component;
        if (identify(&extra, count, chosen) || check_form(&extra))
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
    int axis, component;
    double origin, scale;
    int flip;
};

static struct place in_file(const struct import *import, int line)
{
    return (struct place){import->path, line, 1};
}

static int read_options(struct import *import)
{
    static const char *const axes[] = {"X", "Y", "Z", NULL};
    struct deck_reader *reader = import->reader;
    const struct card_option *option;
    int bad = 0;
    import->axis = 2;
    if ((option = card_option(import->card, "AXIS")))
        bad |= (import->axis = deck_option_word(reader, option, axes)) < 0;
    if ((option = card_option(import->card, "DIRECTION")))
        bad |= (import->component = deck_option_word(reader, option, axes)) < 0;
    if ((option = card_option(import->card, "FLIP")))
        bad |= (import->flip = deck_option_word(reader, option, deck_answers)) < 0;
    import->scale = 1;
    if ((option = card_option(import->card, "SCALE")))
        bad |= deck_option_number(reader, option, "", POSITIVE, &import->scale);
    import->origin = import->flip > 0 ? reader->length : 0;
    if ((option = card_option(import->card, "ORIGIN")))
        bad |= deck_option_number(reader, option, "m", ANY, &import->origin);
    return bad;
}

static int compare_sensors(const void *left, const void *right)
{
    const struct sensor *a = left, *b = right;
    return (a->position > b->position) - (a->position < b->position);
}

static int compare_ids(const void *left, const void *right)
{
    int a = *(const int *)left, b = *(const int *)right;
    return (a > b) - (a < b);
}

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
        qsort(id, at, sizeof *id, compare_ids);
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
        deck_error(reader, in_file(import, 1),
                   "the file has no nodes (sets 15, 2411), expected them, or a *SENSORS card in the deck");
        return 1;
    }
    if (rotor->nsensor) {
        deck_error(reader, import->card->place, "sensors are given by *SENSORS and by the nodes of %s, expected one of them",
                   import->path);
        return 1;
    }
    rotor->sensor = POOL_ARRAY(reader->pool, struct sensor, file->node_count);
    if (!rotor->sensor) {
        reader->out_of_memory = 1;
        return 1;
    }
    size_t carried;
    const int *carrying = shape_nodes(reader->pool, file, &carried);
    if (!carrying) {
        reader->out_of_memory = 1;
        return 1;
    }
    int outside = 0, first = 0;
    double at = 0;
    for (int i = 0; i < file->node_count; i++) {
        if (!carried || !bsearch(&file->node[i].id, carrying, carried, sizeof *carrying, compare_ids))
            continue;
        if (rotor->nsensor == DECK_MOST_LINES) {
            deck_error(reader, in_file(import, 1), "the shapes have more than %d nodes, expected those of sensors on a rotor",
                       DECK_MOST_LINES);
            return 1;
        }
        double z = import->origin + (import->flip ? -1 : 1) * import->scale * file->node[i].x[import->axis];
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
        qsort(rotor->sensor, (size_t)rotor->nsensor, sizeof *rotor->sensor, compare_sensors);
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
    int component = shape->component_count == 1 ? 0 : import->component;
    if (component >= shape->component_count) {
        deck_error(reader, in_file(import, shape->line), "the shape has %d values a node, expected DIRECTION to be one of them",
                   shape->component_count);
        return 1;
    }
    double *value = POOL_ARRAY(reader->pool, double, shape->node_count);
    if (!value) {
        reader->out_of_memory = 1;
        return 1;
    }
    double largest = 0;
    for (int i = 0; i < shape->node_count; i++) {
        int at = i * shape->component_count + component;
        largest = fmax(largest, hypot(shape->real[at], shape->imag ? shape->imag[at] : 0));
    }
    if (!deck_is_usual(largest) || !deck_is_usual(shape->frequency_hz)) {
        deck_error(reader, in_file(import, shape->line),
                   "the shape has a frequency of %.6g Hz and a largest component of %.6g, expected sizes from %g to %g",
                   shape->frequency_hz, largest, DECK_LEAST, DECK_MOST);
        return 1;
    }
    if (largest == 0) {
        deck_error(reader, in_file(import, shape->line),
                   "the shape at %.6g Hz is zero everywhere in this direction, expected another DIRECTION", shape->frequency_hz);
        return 1;
    }
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
    for (int i = 0; mode && i < UFF_ID_LINES && !option; i++)
        if (!strncmp(mode->id[i], line, sizeof line - 1))
            job->measurement.hammer = (int)strtol(mode->id[i] + sizeof line - 1, NULL, 10);
    if (!option)
        return 0;
    long id = strtol(option->value, &end, 10);
    if (end != option->value && !*end && sensor_find(job, (int)id) >= 0) {
        job->measurement.hammer = (int)id;
        return 0;
    }
    deck_error(import->reader, option->value_place, "HAMMER is %s, expected the id of a sensor of %s", option->value,
               import->path);
    return 1;
}

static int import_modes(struct import *import)
{
    struct deck_reader *reader = import->reader;
    struct job *job = reader->job;
    const struct uff_shape **chosen = POOL_ARRAY(reader->pool, const struct uff_shape *, import->file.shape_count);
    int count = chosen ? choose_modes(import, chosen) : 0;
    if (chosen && !count) {
        deck_error(reader, in_file(import, 1), "the file has no mode shapes, expected sets 55 of normal or complex modes");
        return 1;
    }
    size_t components = (size_t)job->rotor.nsensor * (size_t)count;
    job->measurement.number = POOL_ARRAY(reader->pool, int, count);
    job->measurement.frequency_hz = POOL_ARRAY(reader->pool, double, count);
    job->measurement.damping = POOL_ARRAY(reader->pool, double, count);
    job->measurement.frequency_std = POOL_ARRAY(reader->pool, double, count);
    job->measurement.shape = deck_new_values(reader, components);
    job->measurement.shape_std = deck_new_values(reader, components);
    if (!chosen || !job->measurement.number || !job->measurement.frequency_hz || !job->measurement.damping ||
        !job->measurement.frequency_std || !job->measurement.shape || !job->measurement.shape_std) {
        reader->out_of_memory = 1;
        return 1;
    }
    int bad = 0, numbered = uff_modes_are_numbered(count, chosen);
    for (int k = 0; k < count; k++) {
        job->measurement.number[k] = numbered ? chosen[k]->number : k + 1;
        if (job->measurement.number[k] > DECK_MOST_MODES && !bad++)
            deck_error(reader, in_file(import, chosen[k]->line), "the number of a mode is %d, expected 1 to %d",
                       job->measurement.number[k], DECK_MOST_MODES);
        job->measurement.frequency_hz[k] = uff_mode_frequency(chosen[k]);
        job->measurement.damping[k] = chosen[k]->damping > 0 ? chosen[k]->damping : NAN;
        job->measurement.frequency_std[k] = NAN;
        bad |= import_shape(import, chosen[k], job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor);
    }
    job->measurement.nmode = count;
    bad |= import_hammer(import, count ? chosen[0] : NULL);
    if (!bad)
        deck_uff_std(reader, import->path, &import->file, count, chosen, import->component);
    return bad;
}

void deck_measured(struct deck_reader *reader, const struct card *card)
{
    struct import import = {.reader = reader, .card = card};
    reader->measured_card = card;
    if (reader->modes_card) {
        deck_error(reader, card->place, "modes are given by *MODES and by *MEASURED, expected one of them");
        return;
    }
    const char *file = deck_option(reader, card, "FILE", "path of a universal file");
    if (read_options(&import) || !file)
        return;
    import.path = deck_path(reader, card, card_option(card, "FILE"));
    if (!import.path)
        return;
    struct message_list found;
    message_open(&found, reader->pool);
    int status = uff_read(reader->pool, import.path, &found, &import.file);
    if (status == ROTID_ERROR_MEMORY)
        reader->out_of_memory = 1;
    for (size_t i = 0; i < found.count; i++) {
        const rotid_message *m = &found.item[i];
        if (status == ROTID_ERROR_IO && m->severity == SEVERITY_ERROR)
            deck_error(reader, card_option(card, "FILE")->value_place, "%s %s, expected a universal file", import.path, m->text);
        else
            message_add(reader->messages, m->severity, m->file, m->line, m->column, "%s", m->text);
    }
    if (!status && !import_sensors(&import))
        (void)import_modes(&import);
}
