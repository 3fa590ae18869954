/* Set 55, data at nodes: five lines of text, 6: what the data are, 7 and 8: integers and reals of the analysis, then for each
 * node its number and its values. */
#include <limits.h>
#include <math.h>

#include "uff/uff_sets.h"

enum { NORMAL_MODE = 2, COMPLEX_FIRST_ORDER = 3, FREQUENCY_RESPONSE = 5, COMPLEX_SECOND_ORDER = 7 }; /* analysis type */
enum { REAL_DATA = 2, COMPLEX_DATA = 5 };                                                            /* data type */

static const double two_pi = 6.283185307179586;

/* Notes that this set is no shape of a vibration; nonzero when it is to be skipped. */
static int note_other_data(struct uff_job *job, int analysis, int characteristic, int quantity)
{
    static const char *const analysis_name[] = {"unknown", "static", "", "", "transient", "", "buckling"};
    int is_mode = analysis == NORMAL_MODE || analysis == COMPLEX_FIRST_ORDER || analysis == COMPLEX_SECOND_ORDER;
    if (!is_mode && analysis != FREQUENCY_RESPONSE) {
        int named = analysis >= 0 && analysis < (int)(sizeof analysis_name / sizeof *analysis_name);
        uff_note_skip(job, "set 55 of analysis type %d (%s)", analysis, named ? analysis_name[analysis] : "not known here");
        return 1;
    }
    if (characteristic < 0 || characteristic > 3) { /* unknown, scalar, 3 or 6 degrees of freedom */
        uff_note_skip(job, "set 55 of data characteristic %d (not a vector)", characteristic);
        return 1;
    }
    if (quantity != 0 && quantity != 8 && quantity != 11 && quantity != 12) {
        uff_note_skip(job, "set 55 of specific data type %d (not displacement, velocity or acceleration)", quantity);
        return 1;
    }
    return 0;
}

/* Record 6. *read is 0 when the set is to be skipped. */
static int read_kind(struct uff_job *job, struct uff_shape *shape, int *read)
{
    static const char what[] = "record 6 (model, analysis, characteristic, quantity, data type, values per node)";
    const struct uff_form form = {.integers = 6, .integer_width = 10};
    struct uff_lines *lines = &job->lines;
    int field[6];
    int status = uff_expect_line(lines, what);
    if (status == ROTID_OK)
        status = uff_parse_line(lines, &form, what, field, NULL);
    if (status != ROTID_OK)
        return status;

    *read = !note_other_data(job, field[1], field[2], field[3]);
    if (!*read)
        return ROTID_OK;
    if (field[4] != REAL_DATA && field[4] != COMPLEX_DATA)
        return uff_fail(lines, 0, "record 6: data type %d; expected 2 (real) or 5 (complex)", field[4]);
    if (field[5] < 1 || field[5] > 6)
        return uff_fail(lines, 0, "record 6: %d values per node; expected 1 to 6", field[5]);
    shape->analysis_type = field[1];
    shape->is_complex = field[4] == COMPLEX_DATA;
    shape->component_count = field[5];
    return ROTID_OK;
}

/* Records 7 and 8: number, frequency and damping. */
static int read_mode(struct uff_job *job, struct uff_shape *shape)
{
    static const int start[] = {0, 10}, width[] = {10, 10}, field[] = {0, 1};
    struct uff_lines *lines = &job->lines;
    int integer[UFF_VALUE_LIMIT + 2];
    double real[UFF_VALUE_LIMIT];
    long long counts[2];
    int is_eigenvalue = shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER;
    int least = is_eigenvalue ? 2 : 1;

    int status = uff_expect_line(lines, "record 7 (numbers of integers and reals, load case, mode number)");
    if (status != ROTID_OK)
        return status;
    if (!uff_find_integers(lines, 2, start, width, field, counts))
        return uff_fail(lines, 1, "record 7: expected the numbers of integers and reals");
    if (counts[0] < 2 || counts[0] > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld integers announced; expected load case and mode number", counts[0]);
    if (counts[1] < least || counts[1] > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld reals announced; expected at least %d", counts[1], least);
    status = uff_read_integers(lines, (int)counts[0] + 2, "record 7", integer);
    if (status != ROTID_OK)
        return status;
    shape->number = integer[3];

    int line = lines->line + 1;
    status = uff_read_reals(lines, (int)counts[1], "record 8", real);
    if (status != ROTID_OK)
        return status;
    shape->frequency_hz = real[0];
    if (is_eigenvalue) {
        double modulus = hypot(real[0], real[1]);
        shape->frequency_hz = modulus / two_pi;
        shape->damping = modulus > 0 ? -real[0] / modulus : 0;
    } else if (shape->analysis_type == NORMAL_MODE && counts[1] >= 3) {
        shape->damping = real[2];
    }
    if (is_eigenvalue && real[1] == 0)
        shape->frequency_hz = shape->damping = 0; /* it does not oscillate: as a rigid-body mode, which has zero here */
    if (shape->frequency_hz >= 0 && isfinite(shape->frequency_hz))
        return ROTID_OK;
    message_add(lines->messages, SEVERITY_ERROR, lines->path, line, 1,
                "set 55: record 8: the frequency is negative or not finite, expected zero or more");
    return ROTID_ERROR_SYNTAX;
}

/* The nodes with their values, to the closing '-1'. */
static int read_values(struct uff_job *job, struct uff_shape *shape)
{
    const struct uff_form form = {.integers = 1, .integer_width = 10};
    struct uff_lines *lines = &job->lines;
    int value_count = shape->component_count * (shape->is_complex ? 2 : 1);
    uff_clear_labels(&job->labels);
    for (size_t count = 0;; ++count) {
        int status = uff_expect_line(lines, "a node number or '-1'");
        if (status != ROTID_OK)
            return status;
        if (uff_is_delimiter(lines, 0))
            return ROTID_OK;
        if (count >= INT_MAX / 6)
            return uff_fail(lines, 0, "more than %d nodes", INT_MAX / 6);
        struct uff_placed_values *grown = pool_grow(&job->scratch, job->values, count, &job->values_capacity, sizeof *grown);
        if (!grown)
            return ROTID_ERROR_MEMORY;
        job->values = grown;
        struct uff_placed_values *values = &job->values[count];
        values->line = lines->line;
        status = uff_parse_line(lines, &form, "a node number", &values->node, NULL);
        /* values are due now, and a line '-1' is one of them */
        if (status == ROTID_OK)
            status = uff_read_reals(lines, value_count, "values of a node", values->value);
        if (status == ROTID_OK)
            status = uff_add_label(&job->scratch, &job->labels, values->node);
        if (status != ROTID_OK)
            return status;
        shape->node_count = (int)count + 1;
    }
}

static int refuse_repeated_nodes(struct uff_job *job)
{
    struct uff_label_list *labels = &job->labels;
    uff_sort_labels(labels);
    for (size_t i = 1; i < labels->count; ++i) {
        if (labels->item[i].id != labels->item[i - 1].id)
            continue;
        const struct uff_placed_values *first = &job->values[labels->item[i - 1].order];
        const struct uff_placed_values *again = &job->values[labels->item[i].order];
        message_add(job->lines.messages, SEVERITY_ERROR, job->lines.path, again->line, 1,
                    "set 55: node %d occurs twice in the set, first in line %d, expected once", again->node, first->line);
        return ROTID_ERROR_SYNTAX;
    }
    return ROTID_OK;
}

static int keep_values(struct uff_job *job, struct uff_shape *shape)
{
    size_t count = (size_t)shape->node_count, components = (size_t)shape->component_count;
    size_t value_count = components * count;
    shape->node = POOL_ARRAY(job->pool, int, count);
    shape->real = POOL_ARRAY(job->pool, double, value_count);
    shape->imag = shape->is_complex ? POOL_ARRAY(job->pool, double, value_count) : NULL;
    if (!shape->node || !shape->real || (shape->is_complex && !shape->imag))
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < count; ++i) {
        const double *value = job->values[i].value;
        shape->node[i] = job->values[i].node;
        for (size_t c = 0; c < components; ++c) {
            shape->real[components * i + c] = shape->is_complex ? value[2 * c] : value[c];
            if (shape->imag)
                shape->imag[components * i + c] = value[2 * c + 1];
        }
    }

    struct uff_shape *grown = pool_grow(&job->scratch, job->shape, job->shape_count, &job->shape_capacity, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    job->shape = grown;
    job->shape[job->shape_count++] = *shape;
    return ROTID_OK;
}

int uff_read_shape(struct uff_job *job)
{
    struct uff_shape shape = {.line = job->set_line};
    int status = ROTID_OK, read = 1;
    for (int i = 0; i < 5 && status == ROTID_OK; ++i)
        status = uff_expect_line(&job->lines, "five lines of text");
    if (status == ROTID_OK)
        status = read_kind(job, &shape, &read);
    if (status == ROTID_OK && !read)
        return uff_skip_lines(job);
    if (status == ROTID_OK)
        status = read_mode(job, &shape);
    if (status == ROTID_OK)
        status = read_values(job, &shape);
    if (status == ROTID_OK)
        status = refuse_repeated_nodes(job);
    if (status != ROTID_OK)
        return status;
    if (!shape.node_count)
        message_add(job->lines.messages, SEVERITY_WARNING, job->lines.path, job->lines.line, 1,
                    "set 55: no nodes, which means that all values are zero");
    return keep_values(job, &shape);
}
