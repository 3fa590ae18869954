/* Nodes: set 15 in single precision, one line a node; set 2411 in double precision, two lines a node. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "uff/uff_sets.h"

void uff_clear_labels(struct uff_label_list *labels)
{
    labels->count = 0;
}

int uff_add_label(struct pool *pool, struct uff_label_list *labels, int id)
{
    struct uff_label *grown = pool_grow(pool, labels->item, labels->count, &labels->capacity, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    labels->item = grown;
    labels->item[labels->count] = (struct uff_label){id, (int)labels->count};
    ++labels->count;
    return ROTID_OK;
}

static int compare_labels(const void *first, const void *second)
{
    const struct uff_label *a = first, *b = second;
    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

void uff_sort_labels(struct uff_label_list *labels)
{
    size_t sorted = 1;
    while (sorted < labels->count && labels->item[sorted - 1].id < labels->item[sorted].id)
        ++sorted;
    if (sorted < labels->count) /* most writers sort */
        qsort(labels->item, labels->count, sizeof *labels->item, compare_labels);
}

static int add_node(struct uff_job *job, int line, int id, const double *x)
{
    if (job->node_count >= INT_MAX)
        return uff_fail(&job->lines, 0, "more than %d nodes", INT_MAX);
    struct uff_placed_node *grown = pool_grow(&job->scratch, job->node, job->node_count, &job->node_capacity, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    job->node = grown;
    job->node[job->node_count++] = (struct uff_placed_node){
        .node = {.id = id, .x = {x[0], x[1], x[2]}}, .line = line, .set = job->lines.set, .set_line = job->set_line};
    return ROTID_OK;
}

int uff_read_nodes_15(struct uff_job *job)
{
    const struct uff_form form = {.integers = 4, .integer_width = 10, .reals = 3, .real_width = 13};
    struct uff_lines *lines = &job->lines;
    int warned = 0;
    for (;;) {
        int field[4];
        double x[3];
        int status = uff_expect_line(lines, "a node or '-1'");
        if (status != ROTID_OK)
            return status;
        if (uff_is_delimiter(lines, 0))
            return ROTID_OK;
        status = uff_parse_line(lines, &form, "a node", field, x);
        if (status == ROTID_OK)
            status = add_node(job, lines->line, field[0], x);
        if (status != ROTID_OK)
            return status;
        if (field[1] != 0 && !warned) {
            message_add(lines->messages, SEVERITY_WARNING, lines->path, lines->line, 1,
                        "set 15: node %d is given in coordinate system %d; its coordinates are taken as global and Cartesian",
                        field[0], field[1]);
            warned = 1;
        }
    }
}

int uff_read_nodes_2411(struct uff_job *job)
{
    const struct uff_form label_form = {.integers = 4, .integer_width = 10};
    const struct uff_form place_form = {.reals = 3, .real_width = 25};
    struct uff_lines *lines = &job->lines;
    for (;;) {
        int field[4];
        double x[3];
        int status = uff_expect_line(lines, "a node or '-1'");
        if (status != ROTID_OK)
            return status;
        if (uff_is_delimiter(lines, 0))
            return ROTID_OK;
        int line = lines->line;
        status = uff_parse_line(lines, &label_form, "a node, record 1", field, NULL);
        if (status == ROTID_OK)
            status = uff_expect_line(lines, "coordinates, record 2 of a node");
        if (status == ROTID_OK)
            status = uff_parse_line(lines, &place_form, "coordinates, record 2 of a node", NULL, x);
        if (status == ROTID_OK)
            status = add_node(job, line, field[0], x);
        if (status != ROTID_OK)
            return status;
    }
}

/* Set 15 has six digits: the same node in set 2411 differs in the last of them. */
static int is_same_place(const double *a, const double *b)
{
    for (int i = 0; i < 3; ++i)
        if (fabs(a[i] - b[i]) > 1e-5 * fmax(fabs(a[i]), fabs(b[i])))
            return 0;
    return 1;
}

static int check_repeated(struct uff_job *job, const struct uff_placed_node *first, const struct uff_placed_node *again)
{
    const char *wrong = NULL;
    if (first->set_line == again->set_line)
        wrong = "occurs twice in the set";
    else if (!is_same_place(first->node.x, again->node.x))
        wrong = "was elsewhere in an earlier set";
    if (!wrong)
        return ROTID_OK;
    message_add(job->lines.messages, SEVERITY_ERROR, job->lines.path, again->line, 1, "set %d: node %d %s, line %d", again->set,
                again->node.id, wrong, first->line);
    return ROTID_ERROR_SYNTAX;
}

int uff_join_nodes(struct uff_job *job, struct uff_file *out)
{
    struct uff_label_list *labels = &job->labels;
    uff_clear_labels(labels);
    for (size_t i = 0; i < job->node_count; ++i)
        if (uff_add_label(&job->scratch, labels, job->node[i].node.id) != ROTID_OK)
            return ROTID_ERROR_MEMORY;
    uff_sort_labels(labels);

    char *dropped = POOL_ARRAY(&job->scratch, char, job->node_count);
    if (!dropped)
        return ROTID_ERROR_MEMORY;
    size_t kept = job->node_count;
    for (size_t i = 1; i < labels->count; ++i) {
        if (labels->item[i].id != labels->item[i - 1].id)
            continue;
        int status = check_repeated(job, &job->node[labels->item[i - 1].order], &job->node[labels->item[i].order]);
        if (status != ROTID_OK)
            return status;
        dropped[labels->item[i].order] = 1; /* the first one stays */
        --kept;
    }

    out->node = POOL_ARRAY(job->pool, struct uff_node, kept);
    if (!out->node)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < job->node_count; ++i)
        if (!dropped[i])
            out->node[out->node_count++] = job->node[i].node;
    return ROTID_OK;
}
