/* The sets of a universal file. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_SETS_H
#define ROTID_UFF_UFF_SETS_H

#include "uff/uff.h"
#include "uff/uff_lines.h"

/* Node ids with their place, to find those that occur twice. */
struct uff_label {
    int id, order;
};

struct uff_label_list {
    struct uff_label *item;
    size_t count, capacity;
};

struct uff_placed_node {
    struct uff_node node;
    int line, set, set_line; /* where it stands */
};

struct uff_placed_values { /* of one node of a shape */
    int node, line;
    double value[12]; /* as in the file: of a complex number the real and the imaginary part in turn */
};

#define UFF_SKIP_LIMIT 32
struct uff_skip { /* sets of one type that were not read */
    char what[80];
    int line, count; /* line of the first one */
};

/* One reading. */
struct uff_job {
    struct uff_lines lines;
    struct pool *pool;   /* of the caller */
    struct pool scratch; /* ends with the job; what grows grows here and is copied to its length */
    int set_line;        /* of the '-1' that opened the set */
    struct uff_placed_node *node;
    size_t node_count, node_capacity;
    struct uff_shape *shape;
    size_t shape_count, shape_capacity;
    struct uff_placed_values *values; /* of the shape being read */
    size_t values_capacity;
    struct uff_label_list labels;
    struct uff_skip skip[UFF_SKIP_LIMIT];
    int skip_count, skip_others;
};

/* Empties a list, appends to it (ROTID_OK or ROTID_ERROR_MEMORY), sorts it by id and then by order. */
void uff_clear_labels(struct uff_label_list *labels);
int uff_add_label(struct pool *pool, struct uff_label_list *labels, int id);
void uff_sort_labels(struct uff_label_list *labels);

/* Sets 15 and 2411 from behind the set number to the '-1' that closes them. */
int uff_read_nodes_15(struct uff_job *job);
int uff_read_nodes_2411(struct uff_job *job);

/* All nodes read so far to *out, those of several sets joined. The same id twice in a set, or in two sets with different
 * coordinates, is an error. */
int uff_join_nodes(struct uff_job *job, struct uff_file *out);

/* Set 55, also when it is skipped because it is no shape. */
int uff_read_shape(struct uff_job *job);

/* Remembers that a set was not read: the format gives its name, such as "set 151". */
void uff_note_skip(struct uff_job *job, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads over the rest of a set of lines. */
int uff_skip_lines(struct uff_job *job);

#endif
