/* Set 2414, analysis data at nodes or elements. */
#include <limits.h>
#include <string.h>

#include "uff/uff_reader.h"
#include "uff/uff_record.h"

/* What grows, until it is copied to its length. */
struct growing {
    int *item, *offset;
    double *value;
    size_t items, item_room, offset_room, values, value_room;
};

/* The integers or reals of one line, as many of `most` as there are: no record has a fixed number with all writers. */
static int read_few(struct uff_lines *lines, int most, enum uff_kind kind, const char *what, int *integer, double *real)
{
    struct uff_column column[8];
    struct uff_cell cell[8];
    int width = kind == UFF_REAL ? 13 : 10;
    for (int i = 0; i < most; ++i)
        column[i] = (struct uff_column){kind, i * width, width};
    int status = uff_expect_line(lines, what);
    if (status == ROTID_OK)
        status = uff_cut_record(lines, most, column, what, cell);
    for (int i = 0; i < most && status == ROTID_OK; ++i) {
        if (integer)
            integer[i] = (int)cell[i].integer;
        else
            real[i] = cell[i].real;
    }
    return status;
}

/* One integer alone in a line. */
static int read_one(struct uff_lines *lines, const char *what, int *integer)
{
    const struct uff_form form = {.integers = 1, .integer_width = 10};
    int status = uff_expect_line(lines, what);
    return status == ROTID_OK ? uff_parse_line(lines, &form, what, integer, NULL) : status;
}

/* Records 1 to 13. */
static int read_records(struct uff_lines *lines, struct uff_analysis *analysis)
{
    int status = read_one(lines, "record 1 (label)", &analysis->label);
    if (status == ROTID_OK)
        status = uff_read_text(lines, "record 2 (name)", analysis->name);
    if (status == ROTID_OK)
        status = read_one(lines, "record 3 (location)", &analysis->location);
    for (int i = 0; i < UFF_ID_LINES && status == ROTID_OK; ++i)
        status = uff_read_text(lines, "records 4 to 8 (five lines of text)", analysis->id[i]);
    if (status == ROTID_OK)
        status = uff_read_record(lines, &uff_kind_2414, analysis);
    if (status != ROTID_OK)
        return status;
    int type = analysis->data_type;
    if (type != 1 && type != 2 && type != 4 && type != 5 && type != 6)
        return uff_fail(lines, 41, "record 9: data type %d; expected 1, 2, 4, 5 or 6", type);
    if (analysis->value_count < 1)
        return uff_fail(lines, 51, "record 9: %d values; expected at least 1", analysis->value_count);
    status = read_few(lines, 8, UFF_INTEGER, "record 10", analysis->integer, NULL);
    if (status == ROTID_OK)
        status = read_few(lines, 8, UFF_INTEGER, "record 11", analysis->integer + 8, NULL);
    if (status == ROTID_OK)
        status = read_few(lines, 6, UFF_REAL, "record 12", NULL, analysis->real);
    if (status == ROTID_OK)
        status = read_few(lines, 6, UFF_REAL, "record 13", NULL, analysis->real + 6);
    return status;
}

/* `count` numbers, in lines of their own. */
static int append_values(struct uff_lines *lines, struct pool *scratch, long long count, int is_double, struct growing *growing)
{
    static const int width[2][6] = {{13, 13, 13, 13, 13, 13}, {20, 20, 20, 20}};
    double value[UFF_VALUE_LIMIT];
    while (count) {
        int taken = 0, status = uff_expect_line(lines, "values");
        if (status == ROTID_OK && uff_is_delimiter(lines, 1) && lines->strict)
            return uff_fail(lines, 0, "the set ends where %lld more values are due", count);
        if (status == ROTID_OK)
            status = uff_parse_values(lines, is_double ? 4 : 6, width[is_double], count, "values", value, &taken);
        if (status != ROTID_OK)
            return status;
        for (int i = 0; i < taken; ++i) {
            double *grown = growing->values < INT_MAX
                                ? pool_grow(scratch, growing->value, growing->values, &growing->value_room, sizeof *grown)
                                : NULL;
            if (!grown)
                return ROTID_ERROR_MEMORY;
            growing->value = grown;
            growing->value[growing->values++] = value[i];
        }
        count -= taken;
    }
    return ROTID_OK;
}

/* Record 14, which is at hand, and the values behind it, which come in `lots` that begin a line each. */
static int read_item(struct uff_lines *lines, struct pool *scratch, const struct uff_analysis *analysis, struct growing *growing)
{
    static const int fields[] = {0, 1, 2, 4, 0, 5};
    const struct uff_form form = {.integers = fields[analysis->location], .integer_width = 10};
    int field[5] = {0}, is_double = analysis->data_type == 4 || analysis->data_type == 6;
    int status = uff_parse_line(lines, &form, "record 14 (label of a node or an element)", field, NULL);
    if (status != ROTID_OK)
        return status;
    long long each = analysis->location == 1 ? analysis->value_count : analysis->location == 2 ? field[1] : field[3];
    long long lots = analysis->location >= 3 && field[1] == 1 ? field[2] : 1;
    if (each < 0 || lots < 0 || (analysis->location >= 3 && field[1] != 1 && field[1] != 2))
        return uff_fail(lines, 0, "record 14: expected expansion code 1 or 2 and numbers of nodes and values");
    each *= analysis->data_type >= 5 ? 2 : 1;

    int *item =
        growing->items < INT_MAX ? pool_grow(scratch, growing->item, growing->items, &growing->item_room, sizeof *item) : NULL;
    int *offset = item ? pool_grow(scratch, growing->offset, growing->items, &growing->offset_room, sizeof *offset) : NULL;
    if (!offset)
        return ROTID_ERROR_MEMORY;
    growing->item = item;
    growing->offset = offset;
    item[growing->items] = field[0];
    offset[growing->items++] = (int)growing->values;
    for (long long i = 0; i < lots && each && status == ROTID_OK; ++i)
        status = append_values(lines, scratch, each, is_double, growing);
    return status;
}

static int keep(struct pool *pool, const struct growing *growing, struct uff_analysis *analysis)
{
    analysis->item = POOL_ARRAY(pool, int, growing->items);
    analysis->item_offset = POOL_ARRAY(pool, int, growing->items + 1);
    analysis->value = POOL_ARRAY(pool, double, growing->values);
    if (!analysis->item || !analysis->item_offset || !analysis->value)
        return ROTID_ERROR_MEMORY;
    if (growing->items) {
        memcpy(analysis->item, growing->item, growing->items * sizeof(int));
        memcpy(analysis->item_offset, growing->offset, growing->items * sizeof(int));
    }
    if (growing->values)
        memcpy(analysis->value, growing->value, growing->values * sizeof(double));
    analysis->item_offset[growing->items] = (int)growing->values;
    analysis->item_count = (int)growing->items;
    return ROTID_OK;
}

static int read_items(struct uff_reader *reader, struct pool *scratch, const struct uff_analysis *analysis,
                      struct growing *growing)
{
    for (int is_end;;) {
        int status = uff_next_record(reader, "a label or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            return status;
        status = read_item(&reader->lines, scratch, analysis, growing);
        if (status != ROTID_OK)
            return status;
    }
}

int uff_read_analysis(struct uff_reader *reader, struct pool *pool, struct uff_analysis *analysis)
{
    struct uff_lines *lines = &reader->lines;
    struct growing growing = {0};
    struct pool scratch;
    *analysis = (struct uff_analysis){.line = reader->set.line};
    int status = uff_begin(reader, 2414);
    if (status != ROTID_OK)
        return status;
    pool_open(&scratch, reader->allocator);
    status = read_records(lines, analysis);
    if (status == ROTID_OK && (analysis->location < 1 || analysis->location == 4 || analysis->location > 5))
        status =
            uff_fail(lines, 0, "record 3: location %d; expected 1 (nodes), 2 (elements), 3 (nodes on elements) or 5 (points)",
                     analysis->location);
    if (status == ROTID_OK)
        status = read_items(reader, &scratch, analysis, &growing);
    if (status == ROTID_OK)
        status = keep(pool, &growing, analysis);
    pool_close(&scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}
