/* The sentences a listing begins with. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "import/listing.h"
#include "import/names.h"

#define RANGES_SHOWN 6

static int ascending(const void *a, const void *b)
{
    int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

/* "1 to 3, 7": numbers in order, neighbours joined; what does not fit as a count. */
static const char *range_text(struct pool *pool, int count, int *number)
{
    const char *text = "";
    int ranges = 0;
    qsort(number, (size_t)count, sizeof *number, ascending);
    for (int i = 0; i < count && text;) {
        int last = i;
        while (last + 1 < count && number[last + 1] - number[last] <= 1)
            ++last;
        if (ranges++ == RANGES_SHOWN)
            return pool_format(pool, "%s, ... up to %d", text, number[count - 1]);
        const char *separator = i ? ", " : "";
        if (number[last] == number[i])
            text = pool_format(pool, "%s%s%d", text, separator, number[i]);
        else
            text = pool_format(pool, "%s%s%d to %d", text, separator, number[i], number[last]);
        i = last + 1;
    }
    return text;
}

static const char *describe_group(struct pool *pool, const struct listing *listing, int group)
{
    const struct listing_function *first = NULL;
    int *response = POOL_ARRAY(pool, int, listing->function_count), count = 0, several = 0, references = 0;
    for (int i = 0; response && i < listing->function_count; ++i) {
        const struct listing_function *f = &listing->function[i];
        if (f->group != group)
            continue;
        first = first ? first : f;
        response[count++] = f->function.response_node;
        references |= f->function.reference_node != first->function.reference_node;
    }
    if (!first) /* memory is out: a group has a function */
        return NULL;
    for (int i = 1; i < count; ++i)
        several |= response[i] != response[0];
    const struct uff_function *f = &first->function;
    const struct values *v = &first->values;
    const char *places = range_text(pool, count, response);
    if (!places)
        return NULL;
    int time = has_time_axis(f);
    const char *unit = time ? "s" : f->abscissa.specific_type == 18 || !f->abscissa.specific_type ? "Hz" : f->abscissa.unit;
    const char *rate =
        time && f->is_even && f->step > 0 ? pool_format(pool, " at %.6g Hz", 1 / (f->step * first->x_si_factor)) : "";
    const char *reference = f->reference_node && !references ? pool_format(pool, ", reference %d", f->reference_node) : "";
    const char *responses = pool_format(pool, ", response%s %s", several ? "s" : "", places);
    if (!rate || !reference || !responses)
        return NULL;
    return pool_format(pool, "%d %s, %lld %s%s%s, %.6g to %.6g %s%s%s", count, name_of_function(f->type, count > 1), f->count,
                       time ? "samples" : "lines", count > 1 ? " each" : "", rate, v->x_first * first->x_si_factor,
                       v->x_last * first->x_si_factor, unit, several || response[0] ? responses : "", reference);
}

static const char *describe_shapes(struct pool *pool, const struct listing *listing)
{
    int complex_count = 0, points = listing->shape[0].shape.node_count, count = 0;
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < listing->shape_count; ++i) {
        const struct uff_shape *shape = &listing->shape[i].shape;
        if (!shape->analysis_type) /* no mode: standard deviations, frequencies of points */
            continue;
        count++;
        complex_count += shape->is_complex;
        least = fmin(least, shape->frequency_hz);
        most = fmax(most, shape->frequency_hz);
    }
    const char *kind = !complex_count ? "real" : complex_count == count ? "complex" : "real and complex";
    const char *rest =
        count < listing->shape_count ? pool_format(pool, ", %d more sets of data at nodes", listing->shape_count - count) : "";
    if (!count)
        return pool_format(pool, "%d sets of data at nodes, none of them a mode", listing->shape_count);
    return rest ? pool_format(pool, "%d shape%s, %s, %.6g to %.6g Hz, %d point%s%s", count, count == 1 ? "" : "s", kind, least,
                              most, points, points == 1 ? "" : "s", rest)
                : NULL;
}

static const char *describe_nodes(struct pool *pool, const struct listing *listing)
{
    double least[3], most[3];
    for (int c = 0; c < 3; ++c) {
        least[c] = most[c] = listing->node[0].x[c];
        for (int i = 1; i < listing->node_count; ++i) {
            least[c] = fmin(least[c], listing->node[i].x[c]);
            most[c] = fmax(most[c], listing->node[i].x[c]);
        }
    }
    double scale = listing->units && listing->units->length > 0 ? 1 / listing->units->length : 1;
    return pool_format(pool, "%d node%s, x %.6g to %.6g, y %.6g to %.6g, z %.6g to %.6g m%s", listing->node_count,
                       listing->node_count == 1 ? "" : "s", scale * least[0], scale * most[0], scale * least[1], scale * most[1],
                       scale * least[2], scale * most[2], listing->units ? "" : ", if the file is in SI");
}

int listing_summarise(struct pool *pool, const struct listing *listing, int *count, const char ***what)
{
    int lines = listing->group_count + 2, n = 0;
    const char **text = POOL_ARRAY(pool, const char *, lines);
    *count = 0;
    *what = text;
    if (!text)
        return ROTID_ERROR_MEMORY;
    for (int g = 0; g < listing->group_count; ++g)
        text[n++] = describe_group(pool, listing, g);
    if (listing->shape_count)
        text[n++] = describe_shapes(pool, listing);
    if (listing->node_count)
        text[n++] = describe_nodes(pool, listing);
    for (int i = 0; i < n; ++i)
        if (!text[i])
            return ROTID_ERROR_MEMORY;
    *count = n;
    return ROTID_OK;
}
