#include "deck/deck_uff_std.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck_frequencies.h"
#include "diagnose/causes/sensor.h"
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
