#include "import/listing.h"

#include <math.h>
#include <string.h>

#define PIECE 4096 /* values at a time */

struct listing_work {
    struct pool *pool;
    struct pool scratch; /* of one set */
    const struct listing_options *options;
    struct uff_reader *reader;
    struct listing *listing;
    double *x, *real, *imag; /* [PIECE] */
};

static int cancelled(const struct listing_work *job)
{
    return job->options->cancelled && job->options->cancelled(job->options->context);
}

static int read_nodes(struct listing_work *job, struct listing_set *set)
{
    struct listing *listing = job->listing;
    struct uff_node *node;
    int count, status = uff_read_nodes(job->reader, &job->scratch, &count, &node);
    if (status)
        return status;
    for (int i = 0; i < count; ++i) {
        struct uff_node *grown =
            pool_grow(job->pool, listing->node, (size_t)listing->node_count, &listing->node_room, sizeof *grown);
        int *line = pool_grow(job->pool, listing->node_line, (size_t)listing->node_count, &listing->line_room, sizeof *line);
        if (!grown || !line)
            return ROTID_ERROR_MEMORY;
        listing->node = grown;
        listing->node_line = line;
        line[listing->node_count] = set->set.line;
        grown[listing->node_count++] = node[i];
    }
    set->size = count;
    return ROTID_OK;
}

static int read_shape(struct listing_work *job, struct listing_set *set)
{
    struct listing *listing = job->listing;
    struct pool *pool = job->options->keep_shapes ? job->pool : &job->scratch;
    struct listing_shape entry = {0};
    struct uff_shape *shape = &entry.shape;
    int status = uff_read_shape_set(job->reader, pool, shape);
    if (status)
        return status;
    double squares = 0;
    size_t count = (size_t)shape->node_count * (size_t)shape->component_count;
    for (size_t i = 0; i < count; ++i) {
        double size = hypot(shape->real[i], shape->imag ? shape->imag[i] : 0);
        entry.sum[0] += shape->real[i];
        entry.sum[1] += shape->imag ? shape->imag[i] : 0;
        squares += size * size;
    }
    entry.rms = count ? sqrt(squares / (double)count) : 0;
    if (!job->options->keep_shapes) {
        shape->node = NULL;
        shape->real = shape->imag = NULL;
    }
    struct listing_shape *grown =
        pool_grow(job->pool, listing->shape, (size_t)listing->shape_count, &listing->shape_room, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    listing->shape = grown;
    set->size = shape->node_count;
    set->item = listing->shape_count;
    grown[listing->shape_count++] = entry;
    return ROTID_OK;
}

static int read_function(struct listing_work *job, struct listing_set *set)
{
    struct listing *listing = job->listing;
    struct listing_function entry = {0};
    struct uff_function *function = &entry.function;
    int status = uff_read_function(job->reader, function);
    int is_complex = function->ordinate == UFF_COMPLEX_SINGLE || function->ordinate == UFF_COMPLEX_DOUBLE;
    long long got = 1;
    values_open(&entry.values);
    while (!status && got) {
        status = uff_read_values(job->reader, PIECE, job->x, job->real, job->imag, &got);
        if (!status)
            values_add(&entry.values, got, job->x, job->real, job->imag, is_complex);
        if (!status && cancelled(job))
            status = ROTID_STOP_CANCELLED;
    }
    if (status)
        return status;
    values_close(&entry.values);
    struct listing_function *grown =
        pool_grow(job->pool, listing->function, (size_t)listing->function_count, &listing->function_room, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    listing->function = grown;
    set->size = function->count;
    set->item = listing->function_count;
    grown[listing->function_count++] = entry;
    return ROTID_OK;
}

static int read_header(struct listing_work *job)
{
    struct uff_header *header = POOL_NEW(job->pool, struct uff_header);
    int status = header ? uff_read_header(job->reader, header) : ROTID_ERROR_MEMORY;
    job->listing->header = status ? job->listing->header : header;
    return status;
}

static int read_units(struct listing_work *job)
{
    struct uff_units *units = POOL_NEW(job->pool, struct uff_units);
    int status = units ? uff_read_units(job->reader, units) : ROTID_ERROR_MEMORY;
    job->listing->units = status ? job->listing->units : units;
    return status;
}

static int read_set(struct listing_work *job, struct listing_set *set)
{
    switch (set->set.number) {
    case 15:
    case 781:
    case 2411:
        return read_nodes(job, set);
    case 55:
        return read_shape(job, set);
    case 58:
        return read_function(job, set);
    case 151:
        return read_header(job);
    case 164:
        return read_units(job);
    default:
        return UFF_END; /* read over */
    }
}

static int read_sets(struct listing_work *job)
{
    struct listing *listing = job->listing;
    for (;;) {
        struct listing_set entry = {.item = -1};
        int status = cancelled(job) ? ROTID_STOP_CANCELLED : uff_next(job->reader, &entry.set);
        if (status == UFF_END)
            return ROTID_OK;
        if (status == ROTID_ERROR_SYNTAX && listing->set_count) { /* between two sets, or at a truncated end */
            ++listing->faulty_count;
            return ROTID_OK;
        }
        if (status)
            return status;
        pool_open(&job->scratch, job->pool->allocator);
        status = read_set(job, &entry);
        pool_close(&job->scratch);
        if (status && status != UFF_END && status != ROTID_ERROR_SYNTAX)
            return status;
        entry.is_read = !status;
        entry.is_faulty = status == ROTID_ERROR_SYNTAX;
        listing->faulty_count += entry.is_faulty;
        struct listing_set *grown =
            pool_grow(job->pool, listing->set, (size_t)listing->set_count, &listing->set_room, sizeof *grown);
        if (!grown)
            return ROTID_ERROR_MEMORY;
        listing->set = grown;
        grown[listing->set_count++] = entry;
    }
}

/* Units may stand behind the functions. */
static void apply_units(struct listing *listing)
{
    for (int i = 0; i < listing->function_count; ++i) {
        struct listing_function *f = &listing->function[i];
        f->si_factor = uff_si_factor(listing->units, &f->function.numerator);
        if (f->function.denominator.specific_type)
            f->si_factor /= uff_si_factor(listing->units, &f->function.denominator);
        f->x_si_factor = uff_si_factor(listing->units, &f->function.abscissa);
    }
}

/* Some writers name the place of a record once more as its reference. */
static int refers_to_itself(const struct uff_function *f)
{
    return f->reference_node == f->response_node && f->reference_direction == f->response_direction;
}

static int same_reference(const struct uff_function *a, const struct uff_function *b)
{
    return a->reference_node == b->reference_node || (refers_to_itself(a) && refers_to_itself(b) && a->type != UFF_TRANSFER);
}

static int same_group(const struct uff_function *a, const struct uff_function *b)
{
    return a->type == b->type && a->ordinate == b->ordinate && a->count == b->count && a->is_even == b->is_even &&
           a->start == b->start && a->step == b->step && same_reference(a, b) && a->binary.is_binary == b->binary.is_binary &&
           a->numerator.specific_type == b->numerator.specific_type;
}

static void find_groups(struct listing *listing)
{
    for (int i = 0; i < listing->function_count; ++i) {
        struct listing_function *f = listing->function;
        int j = i - 1; /* neighbours are alike most of the time */
        while (j >= 0 && !same_group(&f[j].function, &f[i].function))
            --j;
        f[i].group = j >= 0 ? f[j].group : listing->group_count++;
    }
}

int listing_read(struct pool *pool, const char *path, const struct listing_options *options, struct message_list *messages,
                 struct listing *listing)
{
    struct listing_work job = {.pool = pool, .options = options, .listing = listing};
    *listing = (struct listing){0};
    job.x = POOL_ARRAY(pool, double, PIECE);
    job.real = POOL_ARRAY(pool, double, PIECE);
    job.imag = POOL_ARRAY(pool, double, PIECE);
    if (!job.x || !job.real || !job.imag)
        return ROTID_ERROR_MEMORY;
    int status = uff_open(pool, path, messages, &job.reader);
    if (status)
        return status;
    status = read_sets(&job);
    uff_close(job.reader);
    if (status)
        return status;
    apply_units(listing);
    find_groups(listing);
    return listing_find_doubts(pool, listing);
}
