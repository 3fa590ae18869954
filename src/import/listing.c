#include "import/import.h"

#define HASH_START  0xcbf29ce484222325u /* FNV-1a */
#define HASH_FACTOR 0x100000001b3u
/* Near a crest the values of a wave fall off as the square of the distance: three of them are equal only where a step of the
 * converter is larger than the first difference, and the next value is then no farther than five such steps. */
#define CLIPPED_RUN 3
#define CLIPPED_JUMP                                                                                                             \
    0.02 /* of the span: a converter of which at least eight bits are in use has smaller steps than a fifth of that */

void values_open(struct values *values)
{
    *values = (struct values){.hash = HASH_START, .is_constant = 1};
}

static void add_hash(struct values *values, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int b = 0; b < 64; b += 8)
        values->hash = (values->hash ^ ((bits >> b) & 0xff)) * HASH_FACTOR;
}

static void add_square(struct values *values, double size)
{
    if (size == 0)
        return;
    if (size > values->scale) {
        double ratio = values->scale / size;
        values->squares = 1 + values->squares * ratio * ratio;
        values->scale = size;
    } else {
        double ratio = size / values->scale;
        values->squares += ratio * ratio;
    }
}

/* Rows of values at the least (0) and the greatest (1) of all so far. */
static void follow_plateau(struct values *values, int which, double value)
{
    double extreme = which ? values->max : values->min;
    int beyond = !values->count || (which ? value > extreme : value < extreme);
    values->run[which] = beyond ? 1 : value == extreme ? values->run[which] + 1 : 0;
    if (!beyond && values->run[which] <= values->plateau[which])
        return;
    values->plateau[which] = values->run[which];
    if (values->run[which] == 1)
        values->plateau_jump[which] = values->count ? fabs(value - values->before) : 0;
}

static void add_abscissa(struct values *values, double x)
{
    double step = x - values->x_last;
    if (!values->count)
        values->x_first = x;
    if (values->count == 1 || (values->count && step < values->x_least_step))
        values->x_least_step = step;
    if (values->count == 1 || (values->count && step > values->x_most_step))
        values->x_most_step = step;
    values->x_last = x;
}

void values_add(struct values *values, long long count, const double *x, const double *real, const double *imag, int is_complex)
{
    for (long long i = 0; i < count; ++i) {
        double im = is_complex ? imag[i] : 0, size = is_complex ? hypot(real[i], im) : real[i];
        add_abscissa(values, x[i]);
        add_hash(values, real[i]);
        add_hash(values, im);
        add_square(values, fabs(size));
        for (int which = 0; which < 2 && !is_complex; ++which)
            follow_plateau(values, which, size);
        values->min = values->count && values->min < size ? values->min : size;
        values->max = values->count && values->max > size ? values->max : size;
        values->last[0] = real[i];
        values->last[1] = im;
        if (!values->count)
            memcpy(values->first, values->last, sizeof values->first);
        values->is_constant = values->is_constant && real[i] == values->first[0] && im == values->first[1];
        values->sum[0] += real[i];
        values->sum[1] += im;
        values->before = size;
        ++values->count;
    }
}

void values_close(struct values *values)
{
    values->is_constant = values->is_constant && values->count > 1;
    if (values->count)
        values->rms = values->scale * sqrt(values->squares / (double)values->count);
}

int values_are_clipped(const struct values *values)
{
    double span = values->max - values->min;
    const double extreme[] = {values->min, values->max};
    for (int which = 0; which < 2 && span > 0; ++which)
        if (extreme[which] != 0 && /* zeros are a window, or padding */
            values->plateau[which] >= CLIPPED_RUN && values->plateau_jump[which] > CLIPPED_JUMP * span)
            return 1;
    return 0;
}

#define LEVELS_LEAST     6    /* by chance one in half a million sets of six values has the distances of a grid */
#define LEVELS_TOLERANCE 0.02 /* of a step: six digits of a text round 256 of them to 0.0013 */

struct levels { /* met so far, rising; a count above COARSE_LEVELS: too many */
    int count;
    double level[COARSE_LEVELS];
};

static void levels_add(struct levels *l, long long count, const double *sample)
{
    for (long long i = 0; i < count && l->count <= COARSE_LEVELS; ++i) {
        int low = 0, high = l->count;
        while (low < high) {
            int middle = (low + high) / 2;
            if (l->level[middle] < sample[i])
                low = middle + 1;
            else
                high = middle;
        }
        if (low < l->count && l->level[low] == sample[i])
            continue;
        if (l->count++ == COARSE_LEVELS)
            return;
        memmove(l->level + low + 1, l->level + low, (size_t)(l->count - 1 - low) * sizeof *l->level);
        l->level[low] = sample[i];
    }
}

static int levels_found(const struct levels *l)
{
    const double *level = l->level;
    double step = INFINITY;
    int n = l->count;
    if (n > COARSE_LEVELS)
        return 0;
    for (int i = 1; i < n; ++i)
        step = fmin(step, level[i] - level[i - 1]);
    if (n < LEVELS_LEAST || !((level[n - 1] - level[0]) / step < COARSE_LEVELS - 1.5))
        return 0;
    for (int i = 1; i < n; ++i) {
        double steps = (level[i] - level[i - 1]) / step;
        if (fabs(steps - round(steps)) > LEVELS_TOLERANCE)
            return 0;
    }
    return 1 + (int)lround((level[n - 1] - level[0]) / step);
}

int values_levels(long long count, const double *sample)
{
    struct levels levels = {.count = 0};
    levels_add(&levels, count, sample);
    return levels_found(&levels);
}

int values_are_same(const struct values *a, const struct values *b)
{
    return a->count == b->count && a->hash == b->hash && a->min == b->min && a->max == b->max && a->rms == b->rms;
}

/* ---- doubtful places of a file */

/* A thousand equal sentences help nobody: past this many of a kind they are counted. */
#define FINDINGS_OF_A_KIND 12
#define COHERENCE_MOST     1.000001 /* single precision and six digits go a little beyond 1 */
#define STEP_TOLERANCE     1e-4     /* of the mean step: abscissae have six digits, 64000 lines need five for themselves */

struct search {
    struct pool *pool;
    struct listing *listing;
};

__attribute__((format(printf, 4, 5))) static void add(struct search *search, const char *kind, int line, const char *format, ...)
{
    struct listing *listing = search->listing;
    char text[512];
    int same = 0;
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    for (int i = 0; i < listing->finding_count; ++i)
        same += !strcmp(listing->doubt[i].kind, kind);
    if (same > FINDINGS_OF_A_KIND)
        return;
    if (same == FINDINGS_OF_A_KIND)
        (void)snprintf(text, sizeof text, "... and more of that kind");
    const struct listing_finding doubt = {kind, pool_copy_text(search->pool, text), line};
    if (doubt.text)
        (void)POOL_ADD(search->pool, listing->doubt, listing->finding_count, &doubt);
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
        add(search, "no_units", ROTID_NONE, "no set 164 tells the units: values are taken as they are, as if in SI");
    if (listing->units_line)
        add(search, "unit", listing->units_line, "a set 164 with other factors than one before");
}

ORDER_BY(by_id, struct uff_label, it->id, 0)

static int is_among(int count, const struct uff_label *label, int id)
{
    const struct uff_label key = {.id = id};
    return bsearch(&key, label, (size_t)count, sizeof key, by_id) != NULL;
}

/* Nodes twice with other coordinates; functions at nodes without any. */
static void check_nodes(struct search *search)
{
    const struct listing *listing = search->listing;
    int count = listing->node_count;
    const struct uff_label *label =
        count ? uff_sort_labels(search->pool, count, &listing->node->id, sizeof *listing->node) : NULL;
    if (count && !label)
        return;
    for (int i = 1; i < count; ++i) {
        const struct uff_node *a = &listing->node[label[i - 1].order], *b = &listing->node[label[i].order];
        if (a->id == b->id && (a->x[0] != b->x[0] || a->x[1] != b->x[1] || a->x[2] != b->x[2]))
            add(search, "node_twice", listing->node_line[label[i].order],
                "node %d stands at (%g, %g, %g) and again at (%g, %g, %g)", a->id, a->x[0], a->x[1], a->x[2], b->x[0], b->x[1],
                b->x[2]);
    }
    for (int i = 0; i < listing->set_count; ++i) {
        const struct listing_set *set = &listing->set[i];
        if (set->set.number != 58 || set->item < 0 || !count)
            continue;
        const struct uff_function *f = &listing->function[set->item].function;
        if (f->response_node && !is_among(count, label, f->response_node))
            add(search, "no_coordinates", set->set.line, "function %d: response node %d has no coordinates", set->item + 1,
                f->response_node);
        if (f->reference_node && f->reference_node != f->response_node && !is_among(count, label, f->reference_node))
            add(search, "no_coordinates", set->set.line, "function %d: reference node %d has no coordinates", set->item + 1,
                f->reference_node);
    }
    if (!count && (listing->function_count || listing->shape_count))
        add(search, "no_coordinates", ROTID_NONE, "no set 15 or 2411 tells where the nodes are");
}

/* Functions are named by their number and place. */
static const char *named(int item, const struct uff_function *f, char buffer[96])
{
    char place[PLACE_MOST];
    (void)snprintf(buffer, 96, "function %d (%s at %s)", item + 1, name_of_function(f->type, 0),
                   place_text(f->response_node, f->response_direction, place));
    return buffer;
}

/* Whether the abscissa is time: by its data type or, where that says nothing, by the kind of function. */
static int has_time_axis(const struct uff_function *function)
{
    enum { TIME = 17, FREQUENCY = 18 };
    int type = function->type;
    if (function->abscissa.specific_type == TIME || function->abscissa.specific_type == FREQUENCY)
        return function->abscissa.specific_type == TIME;
    return type == UFF_TIME || type == UFF_AUTO_CORRELATION || type == UFF_CROSS_CORRELATION;
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
    if (entry->levels)
        add(search, "coarse", line, "%s: coarse, %d levels, expected %d or more", name, entry->levels, COARSE_LEVELS);
    if (f->type == UFF_COHERENCE && v->max > COHERENCE_MOST)
        add(search, "coherence", line, "%s: the coherence goes up to %g, above 1", name, v->max);
    check_abscissa(search, line, name, entry);
    check_unit(search, line, name, &f->abscissa);
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

/* The doubtful places, of a listing that is complete otherwise. ROTID_OK or ROTID_ERROR_MEMORY. */
static int listing_find_doubts(struct pool *pool, struct listing *listing)
{
    struct search search = {.pool = pool, .listing = listing};
    check_sets(&search);
    check_nodes(&search);
    check_functions(&search);
    check_shapes(&search);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

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
        int lines = listing->node_count;
        if (POOL_ADD(job->pool, listing->node_line, lines, &set->set.line) ||
            POOL_ADD(job->pool, listing->node, listing->node_count, &node[i]))
            return ROTID_ERROR_MEMORY;
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
    set->size = shape->node_count;
    set->item = listing->shape_count;
    return POOL_ADD(job->pool, listing->shape, listing->shape_count, &entry) ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int read_function(struct listing_work *job, struct listing_set *set)
{
    struct listing *listing = job->listing;
    struct listing_function entry = {0};
    struct uff_function *function = &entry.function;
    struct levels levels = {.count = 0};
    int status = uff_read_function(job->reader, function);
    int is_complex = uff_is_complex(function);
    long long got = 1;
    values_open(&entry.values);
    while (!status && got) {
        status = uff_read_values(job->reader, PIECE, job->x, job->real, job->imag, &got);
        if (!status)
            values_add(&entry.values, got, job->x, job->real, job->imag, is_complex);
        if (!status && function->type == UFF_TIME && !is_complex)
            levels_add(&levels, got, job->real);
        if (!status && cancelled(job))
            status = ROTID_STOP_CANCELLED;
    }
    if (status)
        return status;
    entry.levels = levels_found(&levels);
    values_close(&entry.values);
    set->size = (double)function->count;
    set->item = listing->function_count;
    return POOL_ADD(job->pool, listing->function, listing->function_count, &entry) ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int read_header(struct listing_work *job)
{
    struct uff_header *header = POOL_NEW(job->pool, struct uff_header);
    int status = header ? uff_read_header(job->reader, header) : ROTID_ERROR_MEMORY;
    job->listing->header = status ? job->listing->header : header;
    return status;
}

static int read_units(struct listing_work *job, const struct uff_set *set)
{
    const struct uff_units *before = job->listing->units;
    struct uff_units *units = POOL_NEW(job->pool, struct uff_units);
    int status = units ? uff_read_units(job->reader, units) : ROTID_ERROR_MEMORY;
    if (!status && before && !uff_same_units(before, units))
        job->listing->units_line = set->line;
    job->listing->units = status ? job->listing->units : units;
    return status;
}

static int read_set(struct listing_work *job, struct listing_set *set)
{
    const int number = set->set.number;
    return number == 15 || number == 781 || number == 2411 ? read_nodes(job, set)
           : number == 55                                  ? read_shape(job, set)
           : number == 58                                  ? read_function(job, set)
           : number == 151                                 ? read_header(job)
           : number == 164                                 ? read_units(job, &set->set)
                                                           : UFF_END; /* read over */
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
        if (POOL_ADD(job->pool, listing->set, listing->set_count, &entry))
            return ROTID_ERROR_MEMORY;
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

/* Of an ordinate data type: "real single", ... */
static const char *name_of_ordinate(int ordinate)
{
    return ordinate == UFF_REAL_SINGLE      ? "real single"
           : ordinate == UFF_REAL_DOUBLE    ? "real double"
           : ordinate == UFF_COMPLEX_SINGLE ? "complex single"
           : ordinate == UFF_COMPLEX_DOUBLE ? "complex double"
                                            : "unknown";
}

static int tell(struct pool *pool, struct listing *listing)
{
    char place[PLACE_MOST];
    for (int i = 0; i < listing->set_count; ++i) {
        struct listing_set *set = &listing->set[i];
        set->name = name_of_set(set->set.number);
        set->state = set->is_faulty ? "malformed" : set->is_read ? "read" : set->name ? "read_over" : "not_known";
    }
    for (int i = 0; i < listing->function_count; ++i) {
        struct listing_function *told = &listing->function[i];
        const struct uff_function *f = &told->function;
        struct values *v = &told->values;
        told->kind = name_of_function(f->type, 0);
        told->ordinate = name_of_ordinate(f->ordinate);
        told->response = pool_copy_text(pool, place_text(f->response_node, f->response_direction, place));
        told->reference = pool_copy_text(pool, place_text(f->reference_node, f->reference_direction, place));
        told->is_time = has_time_axis(f);
        told->count = (double)f->count;
        told->step = f->is_even ? f->step : (double)NAN;
        told->rate_hz = told->is_time ? 1 / (told->step * told->x_si_factor) : (double)NAN;
        told->nends = v->count ? 2 : 0;
        told->first = v->first;
        told->last = v->last;
        if (!v->count)
            v->min = v->max = v->rms = NAN;
    }
    for (int i = 0; i < listing->shape_count; ++i) {
        struct listing_shape *told = &listing->shape[i];
        told->analysis = name_of_analysis(told->shape.analysis_type);
        told->nvalues = told->shape.component_count * told->shape.node_count;
    }
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
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
    status = listing_find_doubts(pool, listing);
    return status ? status : tell(pool, listing);
}

/* ---- the sentences a listing begins with */

#define RANGES_SHOWN 6

/* "1 to 3, 7": numbers in order, neighbours joined; what does not fit as a count. */
static const char *range_text(struct pool *pool, int count, int *number)
{
    const char *text = "";
    int ranges = 0;
    sort_ints((size_t)count, number);
    for (int i = 0; i < count;) {
        int last = i;
        while (last + 1 < count && number[last + 1] - number[last] <= 1)
            ++last;
        if (ranges++ == RANGES_SHOWN)
            return pool_text(pool, "%s, ... up to %d", text, number[count - 1]);
        const char *separator = i ? ", " : "";
        text = pool_text(pool, number[last] == number[i] ? "%s%s%d" : "%s%s%d to %d", text, separator, number[i], number[last]);
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
        return "";
    for (int i = 1; i < count; ++i)
        several |= response[i] != response[0];
    const struct uff_function *f = &first->function;
    const struct values *v = &first->values;
    const char *places = range_text(pool, count, response);
    int time = first->is_time;
    const char *unit = time ? "s" : f->abscissa.specific_type == 18 || !f->abscissa.specific_type ? "Hz" : f->abscissa.unit;
    const char *rate = time && f->step > 0 && f->is_even ? pool_text(pool, " at %.6g Hz", first->rate_hz) : "";
    const char *reference = f->reference_node && !references ? pool_text(pool, ", reference %d", f->reference_node) : "";
    const char *responses = pool_text(pool, ", response%s %s", several ? "s" : "", places);
    return pool_text(pool, "%d %s, %lld %s%s%s, %.6g to %.6g %s%s%s", count, name_of_function(f->type, count > 1), f->count,
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
        count < listing->shape_count ? pool_text(pool, ", %d more sets of data at nodes", listing->shape_count - count) : "";
    if (!count)
        return pool_text(pool, "%d sets of data at nodes, none of them a mode", listing->shape_count);
    return pool_text(pool, "%d shape%s, %s, %.6g to %.6g Hz, %d point%s%s", count, count == 1 ? "" : "s", kind, least, most,
                     points, points == 1 ? "" : "s", rest);
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
    return pool_text(pool, "%d node%s, x %.6g to %.6g, y %.6g to %.6g, z %.6g to %.6g m%s", listing->node_count,
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
    *count = n;
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
