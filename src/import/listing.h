/* What a universal file holds, and what in it is doubtful. The values of functions pass by and are not kept. */
#ifndef ROTID_IMPORT_LISTING_H
#define ROTID_IMPORT_LISTING_H

#include "base/message.h"
#include "base/pool.h"
#include "import/values.h"
#include "uff/uff_read.h"

struct listing_function {
    struct uff_function function;
    struct values values;
    double si_factor, x_si_factor; /* a value, an abscissa times this is in SI */
    int group;                     /* of functions that differ in their places alone, from 0 */
};

/* As in the file; node, real, imag only where the values are kept. */
struct listing_shape {
    struct uff_shape shape;
    double sum[2], rms; /* of all components */
};

struct listing_set {
    struct uff_set set;
    int is_read;    /* else it is malformed or was read over */
    int is_faulty;  /* malformed */
    long long size; /* nodes or values that it holds */
    int item;       /* number of the function or the shape, from 0; -1 */
};

/* A doubtful place: what it is, as a word for programs, and a sentence. */
struct listing_doubt {
    const char *kind, *text;
    int line; /* of the set it concerns, 0 for the file */
};

struct listing {
    int set_count, function_count, shape_count, node_count, group_count;
    int faulty_count;
    struct listing_set *set;
    struct listing_function *function;
    struct listing_shape *shape;
    struct uff_node *node;     /* of all sets, in their order */
    int *node_line;            /* line of the set of a node */
    struct uff_header *header; /* NULL where there is none */
    struct uff_units *units;   /* the last one, NULL where there is none */
    size_t doubt_count;
    struct listing_doubt *doubt;
    size_t set_room, function_room, shape_room, node_room, line_room, doubt_room;
};

struct listing_options {
    int keep_shapes;                 /* the values of shapes as well */
    int (*cancelled)(void *context); /* asked now and then, NULL allowed */
    void *context;
};

/* Reads a file through. A malformed set is an error in `messages` and marked, and reading goes on behind it. ROTID_OK;
 * ROTID_STOP_CANCELLED; ROTID_ERROR_SYNTAX where the file is no universal file, _IO, _MEMORY. */
int listing_read(struct pool *pool, const char *path, const struct listing_options *options, struct message_list *messages,
                 struct listing *listing);

/* The doubtful places, of a listing that is complete otherwise. ROTID_OK or ROTID_ERROR_MEMORY. */
int listing_find_doubts(struct pool *pool, struct listing *listing);

/* One sentence for each group of functions, the shapes, the nodes: `what`[*count] of them. ROTID_OK or ROTID_ERROR_MEMORY. */
int listing_summarise(struct pool *pool, const struct listing *listing, int *count, const char ***what);

#endif
