/* The reader of a universal file from inside. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_READER_H
#define ROTID_UFF_UFF_READER_H

#include "uff/uff_lines.h"

enum uff_place {
    UFF_BETWEEN, /* sets */
    UFF_AT_BODY, /* behind the number of a set */
    UFF_AT_DATA, /* behind the records of a function */
    UFF_LOST,    /* after an error of syntax */
    UFF_BROKEN   /* after the file could not be read */
};

/* The values of the function at hand. */
struct uff_values {
    struct uff_function function;
    long long done;
    int per_value; /* numbers: x of an uneven abscissa, real part, imaginary part of complex ones */
    int columns, width[6];
    double pending[UFF_VALUE_LIMIT]; /* numbers of the last line of text that are not handed out yet */
    int pending_at, pending_count;
    int x_size, y_size;  /* bytes of a number */
    long long left_over; /* bytes between the last value and the end of a binary set */
    int is_finished;     /* the closing '-1' has been read */
};

struct uff_reader {
    struct uff_lines lines;
    const rotid_allocator *allocator;
    struct uff_set set;
    struct uff_binary binary;
    enum uff_place place;
    int opened_sets;         /* so far */
    long long warned_before; /* this offset: what was to say about lengths of sets 58b */
    struct uff_values values;
};

/* Every routine that reads a set begins and ends with these: uff_begin is ROTID_ERROR_ARGUMENT unless the set at hand is the
 * `number` and not read yet; uff_end takes the status of the reading, remembers where the reader is, and returns it. */
int uff_begin(struct uff_reader *reader, int number);
int uff_end(struct uff_reader *reader, int status, enum uff_place place);

/* The next line of a set that may end here: *is_end tells. The end of the file is an error. */
int uff_next_record(struct uff_reader *reader, const char *expected, int *is_end);

/* A node and where it stands. */
struct uff_placed_node {
    struct uff_node node;
    int line, set, set_line;
};
struct uff_node_list {
    struct uff_placed_node *item;
    size_t count, capacity;
};

/* Appends the nodes of the set at hand. */
int uff_append_nodes(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list);

/* Set 55 in two parts: to record 6, which describes the data; the rest, or nothing more. */
int uff_read_shape_kind(struct uff_reader *reader, struct uff_shape *shape);
int uff_read_shape_rest(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape);

/* From the end of the records of a 58b: how many bytes its data have. The number in the first line is wrong with some writers,
 * so the '-1' behind the data decides. `function` holds record 7, or has ordinate 0 when that is not known. Sets *bytes, and in
 * *x_size the size of an abscissa of double precision data, which is 4 by the format and 8 with some writers. */
int uff_measure_binary(struct uff_reader *reader, const struct uff_function *function, long long *bytes, int *x_size);

/* Record 7 of sets 58: the description of the values. Returns the cell that is wrong, or -1. */
int uff_cut_data_form(const struct uff_lines *lines, struct uff_cell cell[UFF_CELL_LIMIT], struct uff_function *function);

/* Reads over the rest of the set at hand. */
int uff_skip_set(struct uff_reader *reader);

/* From the last value to behind the closing '-1'; blank lines may stand before it. */
int uff_close_values(struct uff_lines *lines, long long left_over);

/* Ids with their place in a list, to find those that occur twice. */
struct uff_label {
    int id, order;
};
struct uff_label_list {
    struct uff_label *item;
    size_t count, capacity;
};
int uff_add_label(struct pool *pool, struct uff_label_list *labels, int id); /* ROTID_OK or ROTID_ERROR_MEMORY */
void uff_sort_labels(struct uff_label_list *labels);                         /* by id and then by order */

#endif
