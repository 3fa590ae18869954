/* Parts of the ROSS script: the rotor as Python data. */
#ifndef ROTID_EXPORT_ROSS_PARTS_H
#define ROTID_EXPORT_ROSS_PARTS_H

#include <stdio.h>

#include "export/ross_model.h"

/* Which classes of its own the script needs. */
struct ross_needs {
    int tierods, rotational_springs, matrices;
};

struct ross_needs ross_needs(const struct ross_model *ross);

/* MATERIAL and SHAFT, TIERODS. ROTID_OK or ROTID_ERROR_MEMORY. */
int ross_put_shaft(struct pool *pool, FILE *stream, const struct ross_model *ross);
/* MATRICES. */
int ross_put_matrices(struct pool *pool, FILE *stream, const struct ross_model *ross);
/* DISKS, SPRINGS. */
int ross_put_attached(struct pool *pool, FILE *stream, const struct ross_model *ross);

/* Names of one kind, each a word and unlike all before. */
struct ross_names {
    struct pool *pool;
    int count;
    size_t capacity;
    const char **item;
};

/* Such a name for `wanted`, NULL or "" taking `otherwise`; NULL without memory. */
const char *ross_name(struct ross_names *names, const char *wanted, const char *otherwise);

#endif
