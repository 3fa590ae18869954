/* Universal files: nodes (15, 2411) and mode shapes (55) of a modal test. */
#ifndef ROTID_UFF_UFF_H
#define ROTID_UFF_UFF_H

#include "base/message.h"
#include "base/pool.h"

struct uff_node {
    int id;
    double x[3]; /* as written in the file, no units applied */
};

struct uff_shape {       /* one set 55 */
    int line;            /* of the '-1' that opens the set, from 1 */
    int analysis_type;   /* 2 normal mode; 3, 7 complex eigenvalue; 5 frequency response */
    int number;          /* of the mode, or with analysis type 5 of the frequency; from record 7 */
    double frequency_hz; /* 0: a mode that does not oscillate */
    double damping;      /* viscous ratio, of a complex eigenvalue -Re lambda/|lambda|; 0 where the file has none */
    int is_complex;      /* imag given */
    int component_count; /* values per node, 1 to 6 */
    int node_count;      /* the format lets a writer leave out nodes whose values are all zero */
    int *node;           /* [node_count] ids, distinct, in the order of the file */
    double *real;        /* [component_count * node_count], components of a node contiguous */
    double *imag;        /* same, or NULL */
};

struct uff_file {
    int node_count, shape_count;
    struct uff_node *node; /* ids distinct, in the order of the file */
    struct uff_shape *shape;
};

/* Reads a file. Sets 15, 2411, 781 give nodes, sets 55 shapes; all others are skipped, with one note for each type. Everything
 * found lives on the pool. Reading stops at the first malformed set: an error in the message list that names file, line, column,
 * the set, and what was expected. Returns ROTID_OK, ROTID_ERROR_SYNTAX (the list says why), ROTID_ERROR_IO (cannot be read; also
 * in the list) or ROTID_ERROR_MEMORY. *out is empty unless ROTID_OK. A file without a set 55 is ROTID_OK. */
int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out);

#endif
