#include "uff/uff.h"

#include <limits.h>
#include <math.h>

/* Set 55, data at nodes: five lines of text, 6: what the data are, 7 and 8: integers and reals of the analysis, then for each
 * node its number and its values. */

enum { NORMAL_MODE = 2, COMPLEX_FIRST_ORDER = 3, FREQUENCY_RESPONSE = 5, COMPLEX_SECOND_ORDER = 7 }; /* analysis type */
enum { REAL_DATA = 2, COMPLEX_DATA = 5 };                                                            /* data type */

static const double two_pi = 6.283185307179586;

struct placed_values { /* of one node */
    int node, line;
    double value[12]; /* as in the file: of a complex number the real and the imaginary part in turn */
};

/* What grows, on a pool of its own, until it is copied to its length. */
struct growing {
    struct pool scratch;
    struct placed_values *values;
    size_t capacity;
    struct uff_label_list labels;
};

static int read_kind(struct uff_lines *lines, struct uff_shape *shape)
{
    int status = ROTID_OK;
    for (int i = 0; i < UFF_ID_LINES && status == ROTID_OK; ++i)
        status = uff_read_text(lines, "five lines of text", shape->id[i]);
    if (status == ROTID_OK)
        status = uff_read_record(lines, &uff_kind_55, shape);
    if (status != ROTID_OK)
        return status;
    shape->is_complex = shape->data_type == COMPLEX_DATA;
    return ROTID_OK;
}

int uff_read_shape_kind(struct uff_reader *reader, struct uff_shape *shape)
{
    *shape = (struct uff_shape){.line = reader->set.line};
    int status = uff_begin(reader, 55);
    return status == ROTID_OK ? uff_end(reader, read_kind(&reader->lines, shape), UFF_AT_DATA) : status;
}

static int is_eigenvalue(const struct uff_shape *shape)
{
    return shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER;
}

/* What record 8 says, as frequency and damping. */
static void take_reals(struct uff_shape *shape, int count, const double *real)
{
    double six[6] = {0};
    for (int i = 0; i < count && i < 6; ++i)
        six[i] = real[i];
    if (is_eigenvalue(shape)) {
        double modulus = hypot(real[0], real[1]);
        int oscillates = real[1] != 0; /* else it is as a rigid-body mode, which has zero here */
        for (int i = 0; i < 2; ++i) {
            shape->eigenvalue[i] = six[i];
            shape->modal_a[i] = six[2 + i];
            shape->modal_b[i] = six[4 + i];
        }
        shape->frequency_hz = oscillates ? modulus / two_pi : 0;
        shape->damping = oscillates ? -real[0] / modulus : 0;
    } else if (shape->analysis_type == NORMAL_MODE) {
        shape->frequency_hz = six[0];
        shape->modal_mass = six[1];
        shape->damping = six[2];
        shape->hysteretic = six[3];
    } else if (shape->analysis_type == FREQUENCY_RESPONSE || shape->analysis_type == 0) {
        shape->frequency_hz = six[0];
    }
}

/* Records 7 and 8: number, frequency and damping. */
static int read_mode(struct uff_lines *lines, struct uff_shape *shape)
{
    static const int start[] = {0, 10}, width[] = {10, 10}, field[] = {0, 1};
    int integer[UFF_VALUE_LIMIT + 2];
    double real[UFF_VALUE_LIMIT];
    long long counts[2];
    int is_mode = is_eigenvalue(shape) || shape->analysis_type == NORMAL_MODE || shape->analysis_type == FREQUENCY_RESPONSE;
    int least_integers = is_mode ? 2 : 1, least_reals = is_eigenvalue(shape) ? 2 : 1;

    int status = uff_expect_line(lines, "record 7 (numbers of integers and reals, load case, mode number)");
    if (status != ROTID_OK)
        return status;
    if (!uff_find_integers(lines, 2, start, width, field, counts))
        return uff_fail(lines, 1, "record 7: expected the numbers of integers and reals");
    if (counts[0] < least_integers || counts[0] > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld integers announced; expected load case and mode number", counts[0]);
    if (counts[1] < least_reals || counts[1] > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld reals announced; expected at least %d", counts[1], least_reals);
    status = uff_read_integers(lines, (int)counts[0] + 2, "record 7", integer);
    if (status != ROTID_OK)
        return status;
    int has_case = counts[0] > 1 || shape->analysis_type != 0; /* of unknown data the one integer is a number */
    shape->load_case = has_case ? integer[2] : 0;
    shape->number = counts[0] > 1 ? integer[3] : has_case ? 0 : integer[2];

    int line = lines->line + 1;
    status = uff_read_reals(lines, (int)counts[1], 6, 13, "record 8", real);
    if (status != ROTID_OK)
        return status;
    take_reals(shape, (int)counts[1], real);
    if (shape->frequency_hz >= 0 && isfinite(shape->frequency_hz))
        return ROTID_OK;
    message_add(lines->messages, SEVERITY_ERROR, lines->path, line, 1,
                "set 55: record 8: the frequency is negative or not finite, expected zero or more");
    return ROTID_ERROR_SYNTAX;
}

/* The nodes with their values, to the closing '-1'. */
static int read_values(struct uff_reader *reader, struct growing *growing, struct uff_shape *shape)
{
    const struct uff_form form = {.integers = 1, .integer_width = 10};
    struct uff_lines *lines = &reader->lines;
    int value_count = shape->component_count * (shape->is_complex ? 2 : 1);
    for (size_t count = 0;; ++count) {
        int is_end, status = uff_next_record(reader, "a node number or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            return status;
        if (count >= INT_MAX / 6)
            return uff_fail(lines, 0, "more than %d nodes", INT_MAX / 6);
        struct placed_values *grown = pool_grow(&growing->scratch, growing->values, count, &growing->capacity, sizeof *grown);
        if (!grown)
            return ROTID_ERROR_MEMORY;
        growing->values = grown;
        struct placed_values *values = &growing->values[count];
        values->line = lines->line;
        status = uff_parse_line(lines, &form, "a node number", &values->node, NULL);
        /* values are due now, and a line '-1' is one of them */
        if (status == ROTID_OK)
            status = uff_read_reals(lines, value_count, 6, 13, "values of a node", values->value);
        if (status == ROTID_OK)
            status = uff_add_label(&growing->scratch, &growing->labels, values->node);
        if (status != ROTID_OK)
            return status;
        shape->node_count = (int)count + 1;
    }
}

static int refuse_repeated_nodes(struct uff_lines *lines, struct growing *growing)
{
    struct uff_label_list *labels = &growing->labels;
    uff_sort_labels(labels);
    for (size_t i = 1; i < labels->count; ++i) {
        if (labels->item[i].id != labels->item[i - 1].id)
            continue;
        const struct placed_values *first = &growing->values[labels->item[i - 1].order];
        const struct placed_values *again = &growing->values[labels->item[i].order];
        message_add(lines->messages, SEVERITY_ERROR, lines->path, again->line, 1,
                    "set 55: node %d occurs twice in the set, first in line %d, expected once", again->node, first->line);
        return ROTID_ERROR_SYNTAX;
    }
    return ROTID_OK;
}

static int keep_values(const struct growing *growing, struct pool *pool, struct uff_shape *shape)
{
    size_t count = (size_t)shape->node_count, components = (size_t)shape->component_count;
    size_t value_count = components * count;
    shape->node = POOL_ARRAY(pool, int, count);
    shape->real = POOL_ARRAY(pool, double, value_count);
    shape->imag = shape->is_complex ? POOL_ARRAY(pool, double, value_count) : NULL;
    if (!shape->node || !shape->real || (shape->is_complex && !shape->imag))
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < count; ++i) {
        const double *value = growing->values[i].value;
        shape->node[i] = growing->values[i].node;
        for (size_t c = 0; c < components; ++c) {
            shape->real[components * i + c] = shape->is_complex ? value[2 * c] : value[c];
            if (shape->imag)
                shape->imag[components * i + c] = value[2 * c + 1];
        }
    }
    return ROTID_OK;
}

int uff_read_shape_rest(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape)
{
    struct uff_lines *lines = &reader->lines;
    int type = shape->data_type, components = shape->component_count;
    if (type != REAL_DATA && type != COMPLEX_DATA)
        return uff_end(reader, uff_fail(lines, 0, "record 6: data type %d; expected 2 (real) or 5 (complex)", type), UFF_BETWEEN);
    if (components < 1 || components > 6)
        return uff_end(reader, uff_fail(lines, 0, "record 6: %d values per node; expected 1 to 6", components), UFF_BETWEEN);

    struct growing growing = {0};
    pool_open(&growing.scratch, reader->allocator);
    int status = read_mode(lines, shape);
    if (status == ROTID_OK)
        status = read_values(reader, &growing, shape);
    if (status == ROTID_OK)
        status = refuse_repeated_nodes(lines, &growing);
    if (status == ROTID_OK && !shape->node_count)
        uff_warn(lines, "no nodes, which means that all values are zero");
    if (status == ROTID_OK)
        status = keep_values(&growing, pool, shape);
    pool_close(&growing.scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}

int uff_read_shape_set(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape)
{
    int status = uff_read_shape_kind(reader, shape);
    return status == ROTID_OK ? uff_read_shape_rest(reader, pool, shape) : status;
}
