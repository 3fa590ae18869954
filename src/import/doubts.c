/* Doubtful places of a file. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/listing.h"
#include "import/names.h"

/* A thousand equal sentences help nobody: past this many of a kind they are counted. */
#define DOUBTS_OF_A_KIND 12
#define COHERENCE_MOST   1.000001 /* single precision and six digits go a little beyond 1 */
#define STEP_TOLERANCE   1e-4     /* of the mean step: abscissae have six digits, 64000 lines need five for themselves */

struct search {
    struct pool *pool;
    struct listing *listing;
    int out_of_memory;
};

static void add(struct search *search, const char *kind, int line, const char *format, ...) __attribute__((format(printf, 4, 5)));

static void add(struct search *search, const char *kind, int line, const char *format, ...)
{
    struct listing *listing = search->listing;
    char text[512];
    int same = 0;
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    for (size_t i = 0; i < listing->doubt_count; ++i)
        same += !strcmp(listing->doubt[i].kind, kind);
    if (same > DOUBTS_OF_A_KIND)
        return;
    if (same == DOUBTS_OF_A_KIND)
        (void)snprintf(text, sizeof text, "... and more of that kind");
    struct listing_doubt *grown =
        pool_grow(search->pool, listing->doubt, listing->doubt_count, &listing->doubt_room, sizeof *grown);
    char *copy = pool_copy_text(search->pool, text);
    if (!grown || !copy) {
        search->out_of_memory = 1;
        return;
    }
    listing->doubt = grown;
    grown[listing->doubt_count++] = (struct listing_doubt){kind, copy, line};
}

static void check_sets(struct search *search)
{
    const struct listing *listing = search->listing;
    for (int i = 0; i < listing->set_count; ++i) {
        const struct listing_set *set = &listing->set[i];
        int seen = 0;
        for (int j = 0; j < i && !seen; ++j)
            seen = listing->set[j].set.number == set->set.number;
        if (set->is_faulty)
            add(search, "malformed", set->set.line, "set %d is malformed and was read over", set->set.number);
        else if (!set->is_read && !seen && !name_of_set(set->set.number))
            add(search, "unknown_set", set->set.line, "sets %d are not known here and were read over", set->set.number);
    }
    if (!listing->units && (listing->function_count || listing->node_count))
        add(search, "no_units", 0, "no set 164 tells the units: values are taken as they are, as if in SI");
}

struct place {
    int id, order;
};

static int by_id(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    return p->id != q->id ? (p->id < q->id ? -1 : 1) : (p->order > q->order) - (p->order < q->order);
}

static int has_place(const struct place *place, int count, int id)
{
    const struct place *found = NULL;
    int low = 0, high = count;
    while (low < high && !found) {
        int middle = low + (high - low) / 2;
        if (place[middle].id == id)
            found = &place[middle];
        else if (place[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return found != NULL;
}

/* Nodes twice with other coordinates; functions at nodes without any. */
static void check_nodes(struct search *search)
{
    const struct listing *listing = search->listing;
    int count = listing->node_count;
    struct place *place = POOL_ARRAY(search->pool, struct place, count);
    if (!place) {
        search->out_of_memory = 1;
        return;
    }
    for (int i = 0; i < count; ++i)
        place[i] = (struct place){listing->node[i].id, i};
    if (count)
        qsort(place, (size_t)count, sizeof *place, by_id);
    for (int i = 1; i < count; ++i) {
        const struct uff_node *a = &listing->node[place[i - 1].order], *b = &listing->node[place[i].order];
        if (a->id == b->id && (a->x[0] != b->x[0] || a->x[1] != b->x[1] || a->x[2] != b->x[2]))
            add(search, "node_twice", listing->node_line[place[i].order],
                "node %d stands at (%g, %g, %g) and again at (%g, %g, %g)", a->id, a->x[0], a->x[1], a->x[2], b->x[0], b->x[1],
                b->x[2]);
    }
    for (int i = 0; i < listing->set_count; ++i) {
        const struct listing_set *set = &listing->set[i];
        if (set->set.number != 58 || set->item < 0 || !count)
            continue;
        const struct uff_function *f = &listing->function[set->item].function;
        if (f->response_node && !has_place(place, count, f->response_node))
            add(search, "no_coordinates", set->set.line, "function %d: response node %d has no coordinates", set->item + 1,
                f->response_node);
        if (f->reference_node && f->reference_node != f->response_node && !has_place(place, count, f->reference_node))
            add(search, "no_coordinates", set->set.line, "function %d: reference node %d has no coordinates", set->item + 1,
                f->reference_node);
    }
    if (!count && (listing->function_count || listing->shape_count))
        add(search, "no_coordinates", 0, "no set 15 or 2411 tells where the nodes are");
}

/* Functions are named by their number and place. */
static const char *named(int item, const struct uff_function *f, char buffer[96])
{
    char place[PLACE_MOST];
    (void)snprintf(buffer, 96, "function %d (%s at %s)", item + 1, name_of_function(f->type, 0),
                   place_text(f->response_node, f->response_direction, place));
    return buffer;
}

static void check_abscissa(struct search *search, int line, const char *name, const struct listing_function *entry)
{
    const struct values *v = &entry->values;
    double mean = v->count > 1 ? (v->x_last - v->x_first) / (double)(v->count - 1) : 0;
    if (v->count > 1 && !(v->x_least_step > 0))
        add(search, "abscissa_order", line, "%s: the %s does not increase", name,
            has_time_axis(&entry->function) ? "time" : "abscissa");
    else if (!entry->function.is_even && v->count > 2 && v->x_most_step - v->x_least_step > STEP_TOLERANCE * mean)
        add(search, "uneven", line, "%s: uneven abscissa, steps from %g to %g", name, v->x_least_step, v->x_most_step);
}

/* The unit of an axis by its text, and by what counts: set 164 or, where there is none, SI but for an acceleration in g. */
static void check_unit(struct search *search, int line, const char *name, const struct uff_axis *axis)
{
    const struct uff_units *units = search->listing->units;
    struct uff_axis bare = *axis;
    bare.unit[0] = '\0';
    double by_text = unit_text_factor(axis->specific_type, axis->unit), counts = uff_si_factor(units, units ? &bare : axis);
    if (by_text > 0 && fabs(by_text - counts) > 1e-3 * fabs(counts))
        add(search, "unit", line, "%s: unit text '%s', which is %.6g %s, where %s %.6g", name, axis->unit, by_text,
            si_unit(axis->specific_type), units ? "set 164 says" : "no set 164 does and it is taken as", counts);
}

static void check_function(struct search *search, const struct listing_set *set)
{
    const struct listing_function *entry = &search->listing->function[set->item];
    const struct uff_function *f = &entry->function;
    const struct values *v = &entry->values;
    int line = set->set.line;
    char name[96];
    (void)named(set->item, f, name);
    if (v->is_constant)
        add(search, "dead", line, v->max == 0 ? "%s: dead, all values are zero" : "%s: dead, all values are the same", name);
    if (f->type == UFF_TIME && values_are_clipped(v))
        add(search, "clipped", line, "%s: clipped, up to %lld values in a row at %g or %g", name,
            v->plateau[0] > v->plateau[1] ? v->plateau[0] : v->plateau[1], v->min, v->max);
    if (f->type == UFF_COHERENCE && v->max > COHERENCE_MOST)
        add(search, "coherence", line, "%s: the coherence goes up to %g, above 1", name, v->max);
    check_abscissa(search, line, name, entry);
    check_unit(search, line, name, &f->numerator);
    if (f->denominator.specific_type)
        check_unit(search, line, name, &f->denominator);
}

static void check_functions(struct search *search)
{
    const struct listing *listing = search->listing;
    const struct listing_function *f = listing->function;
    for (int i = 0; i < listing->set_count; ++i)
        if (listing->set[i].set.number == 58 && listing->set[i].item >= 0)
            check_function(search, &listing->set[i]);
    for (int i = 0; i < listing->function_count; ++i)
        for (int j = 0; j < i; ++j)
            if (f[i].function.type == f[j].function.type && f[i].values.count > 1 && !f[i].values.is_constant &&
                values_are_same(&f[i].values, &f[j].values)) {
                add(search, "identical", f[i].function.line, "functions %d and %d have the same values, all %lld of them", j + 1,
                    i + 1, f[i].values.count);
                break;
            }
    for (int i = 1; i < listing->function_count; ++i) {
        int j = 0; /* the first one of this type */
        while (f[j].function.type != f[i].function.type)
            ++j;
        if (f[j].function.count != f[i].function.count)
            add(search, "length", f[i].function.line, "functions %d and %d, both %s, have %lld and %lld values", j + 1, i + 1,
                name_of_function(f[i].function.type, 1), f[j].function.count, f[i].function.count);
        else if (f[j].function.is_even && f[i].function.is_even &&
                 (f[j].function.step != f[i].function.step || f[j].function.start != f[i].function.start))
            add(search, "resolution", f[i].function.line, "functions %d and %d, both %s, have steps %g and %g from %g and %g",
                j + 1, i + 1, name_of_function(f[i].function.type, 1), f[j].function.step, f[i].function.step,
                f[j].function.start, f[i].function.start);
    }
}

static void check_shapes(struct search *search)
{
    const struct listing *listing = search->listing;
    for (int i = 0; i < listing->shape_count; ++i) {
        const struct listing_shape *entry = &listing->shape[i];
        if (entry->rms == 0)
            add(search, "dead", entry->shape.line, "shape %d: all values are zero", i + 1);
        if (i && entry->shape.analysis_type == entry[-1].shape.analysis_type &&
            entry->shape.frequency_hz < entry[-1].shape.frequency_hz)
            add(search, "frequency_order", entry->shape.line, "shape %d, %g Hz, follows %g Hz: frequencies do not increase",
                i + 1, entry->shape.frequency_hz, entry[-1].shape.frequency_hz);
        if (entry->shape.node_count != listing->shape[0].shape.node_count)
            add(search, "length", entry->shape.line, "shapes 1 and %d have %d and %d nodes", i + 1,
                listing->shape[0].shape.node_count, entry->shape.node_count);
    }
}

int listing_find_doubts(struct pool *pool, struct listing *listing)
{
    struct search search = {.pool = pool, .listing = listing};
    check_sets(&search);
    check_nodes(&search);
    check_functions(&search);
    check_shapes(&search);
    return search.out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
