/* Memory of one job: everything a job allocates hangs on its pool and goes with it, so a routine that fails
 * half-way has nothing to undo. Not shared between threads. */
#ifndef ROTID_BASE_POOL_H
#define ROTID_BASE_POOL_H

#include <stddef.h>

#include "rotid.h"

struct pool {
    const rotid_allocator *allocator; /* NULL: malloc and free */
    void *last;                       /* newest block, each linked to the one before */
    int out_of_memory;                /* some room was not to be had: many requests need one check */
};

void pool_open(struct pool *pool, const rotid_allocator *allocator);
void pool_close(struct pool *pool);

/* A pool that is the first of its own blocks, for what outlives the call that makes it; NULL where memory is out. */
struct pool *pool_new(const rotid_allocator *allocator);
/* NULL is allowed. */
void pool_free(struct pool *pool);

/* The pool takes over the blocks of another one, which is empty then; both have the same allocator. */
void pool_absorb(struct pool *pool, struct pool *other);

/* count * size zeroed bytes aligned for any type; NULL when memory is out or the product overflows. Zero bytes give a
 * valid pointer. */
void *pool_get(struct pool *pool, size_t count, size_t size);
/* The same with whatever was there before: workspace, which is written before it is read. */
void *pool_room(struct pool *pool, size_t count, size_t size);

#define POOL_NEW(pool, type)          ((type *)pool_get((pool), 1, sizeof(type)))
#define POOL_ARRAY(pool, type, count) ((type *)pool_get((pool), (size_t)(count), sizeof(type)))
#define POOL_ROOM(pool, type, count)  ((type *)pool_room((pool), (size_t)(count), sizeof(type)))
/* The list gets room for count elements. Its length: 0 where memory is out, so that a loop that fills it is safe. */
#define POOL_LIST(pool, list, count) (((list) = pool_get((pool), (size_t)(count), sizeof *(list))) ? (int)(count) : 0)

/* Room for one more element in a growing array of *capacity elements of which count are used: doubles it (copying) when
 * full. Returns the array, or NULL when memory is out (the old one stays valid). */
void *pool_grow(struct pool *pool, void *array, size_t count, size_t *capacity, size_t size);

char *pool_copy_text(struct pool *pool, const char *text);
char *pool_format(struct pool *pool, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
