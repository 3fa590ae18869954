/* Elements, set 2412, and lines to draw, set 82: lists of node numbers. */
#include <limits.h>
#include <string.h>

#include "uff/uff_fields.h"
#include "uff/uff_reader.h"
#include "uff/uff_record.h"

struct numbers {
    int *item;
    size_t count, capacity;
};

/* `count` node numbers, as many lines as they take; memory grows with what is there, whatever was announced. */
static int append_numbers(struct uff_reader *reader, struct pool *scratch, int count, const char *what, struct numbers *list)
{
    struct uff_lines *lines = &reader->lines;
    int integer[UFF_VALUE_LIMIT], taken = 0;
    for (int done = 0; done < count; done += taken) {
        int status = uff_expect_line(lines, what);
        if (status == ROTID_OK && uff_is_delimiter(lines, lines->strict))
            return uff_fail(lines, 0, "%s: the set ends after %d of %d", what, done, count);
        if (status == ROTID_OK)
            status = uff_parse_integers(lines, count - done, what, integer, &taken);
        for (int i = 0; i < taken && status == ROTID_OK; ++i) {
            int *grown =
                list->count < INT_MAX ? pool_grow(scratch, list->item, list->count, &list->capacity, sizeof *grown) : NULL;
            if (!grown)
                return ROTID_ERROR_MEMORY;
            list->item = grown;
            list->item[list->count++] = integer[i];
        }
        if (status != ROTID_OK)
            return status;
    }
    return ROTID_OK;
}

/* To an array of its length on the pool. */
static int *keep_numbers(struct pool *pool, const struct numbers *list)
{
    int *kept = POOL_ARRAY(pool, int, list->count);
    if (kept && list->count)
        memcpy(kept, list->item, list->count * sizeof *kept);
    return kept;
}

/* One element, of which the first line is at hand. */
static int read_element(struct uff_reader *reader, struct pool *scratch, struct uff_element *element, struct numbers *nodes)
{
    struct uff_lines *lines = &reader->lines;
    *element = (struct uff_element){0};
    int status = uff_take_record(lines, &uff_element_2412, element);
    if (status != ROTID_OK)
        return status;
    if (element->node_count < 0)
        return uff_fail(lines, 51, "%s: %d nodes; expected none or more", uff_element_2412.what, element->node_count);
    if (uff_is_beam(element->descriptor))
        status = uff_read_record(lines, &uff_beam_2412, element);
    if (status == ROTID_OK)
        status = append_numbers(reader, scratch, element->node_count, "nodes of an element", nodes);
    return status;
}

static int read_elements(struct uff_reader *reader, struct pool *scratch, struct pool *pool, int *count, struct uff_element **out)
{
    struct numbers nodes = {0};
    struct uff_element *list = NULL;
    size_t used = 0, capacity = 0;
    for (int is_end = 0;;) {
        int status = uff_next_record(reader, "an element or '-1'", &is_end);
        if (status != ROTID_OK)
            return status;
        if (is_end)
            break;
        struct uff_element *grown = used < INT_MAX ? pool_grow(scratch, list, used, &capacity, sizeof *grown) : NULL;
        if (!grown)
            return ROTID_ERROR_MEMORY;
        list = grown;
        status = read_element(reader, scratch, &list[used++], &nodes);
        if (status != ROTID_OK)
            return status;
    }
    int *node = keep_numbers(pool, &nodes);
    struct uff_element *kept = POOL_ARRAY(pool, struct uff_element, used);
    if (!node || !kept)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < used; ++i) {
        kept[i] = list[i];
        kept[i].node = node;
        node += kept[i].node_count;
    }
    *count = (int)used;
    *out = kept;
    return ROTID_OK;
}

int uff_read_elements(struct uff_reader *reader, struct pool *pool, int *count, struct uff_element **element)
{
    struct pool scratch;
    *count = 0;
    *element = NULL;
    int status = uff_begin(reader, 2412);
    if (status != ROTID_OK)
        return status;
    pool_open(&scratch, reader->allocator);
    status = read_elements(reader, &scratch, pool, count, element);
    pool_close(&scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}

/* Whether the line at hand holds zeros alone. */
static int is_padding(const struct uff_lines *lines)
{
    struct uff_field field[UFF_VALUE_LIMIT];
    int found = uff_split_blanks(lines, field, UFF_VALUE_LIMIT);
    for (int i = 0; i < found; ++i)
        if (field[i].length != 1 || lines->text[field[i].start] != '0')
            return 0;
    return found > 0;
}

/* Test.Lab fills the last line with zeros, and writes another one of them where the nodes fill theirs. */
static int end_trace(struct uff_reader *reader, long long count)
{
    struct uff_lines *lines = &reader->lines;
    int is_end = 0, status;
    do
        status = uff_next_record(reader, "the '-1' that ends the set", &is_end);
    while (status == ROTID_OK && !is_end && is_padding(lines));
    if (status == ROTID_OK && !is_end)
        return uff_fail(lines, 0, "expected the '-1' that ends the set behind %lld nodes", count);
    return status;
}

static int read_trace(struct uff_reader *reader, struct pool *scratch, struct pool *pool, struct uff_trace *trace)
{
    static const char what[] = "a trace line (number, number of nodes, color)";
    const struct uff_column column[] = {{UFF_INTEGER, 0, 10}, {UFF_INTEGER, 10, 10}, {UFF_INTEGER, 20, 10}};
    struct uff_lines *lines = &reader->lines;
    struct numbers nodes = {0};
    struct uff_cell cell[3];
    int status = uff_expect_line(lines, what);
    if (status == ROTID_OK)
        status = uff_cut_record(lines, 3, column, what, cell);
    if (status != ROTID_OK)
        return status;
    if (cell[1].integer < 0)
        return uff_fail(lines, 11, "%s: %lld nodes; expected none or more", what, cell[1].integer);
    trace->number = (int)cell[0].integer;
    trace->color = (int)cell[2].integer;
    status = uff_read_text(lines, "the name of a trace line", trace->name);
    if (status == ROTID_OK)
        status = append_numbers(reader, scratch, (int)cell[1].integer, "nodes of a trace line", &nodes);
    if (status == ROTID_OK)
        status = end_trace(reader, cell[1].integer);
    if (status != ROTID_OK)
        return status;
    trace->node = keep_numbers(pool, &nodes);
    trace->node_count = trace->node ? (int)nodes.count : 0;
    return trace->node ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int uff_read_trace(struct uff_reader *reader, struct pool *pool, struct uff_trace *trace)
{
    struct pool scratch;
    *trace = (struct uff_trace){0};
    int status = uff_begin(reader, 82);
    if (status != ROTID_OK)
        return status;
    pool_open(&scratch, reader->allocator);
    status = read_trace(reader, &scratch, pool, trace);
    pool_close(&scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}
