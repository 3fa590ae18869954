#include "base/pool.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The header keeps the payload behind it aligned for any type. */
union header {
    void *previous;
    max_align_t align;
};

void pool_open(struct pool *pool, const rotid_allocator *allocator)
{
    pool->allocator = allocator;
    pool->last = NULL;
}

void pool_close(struct pool *pool)
{
    union header *block = pool->last;
    while (block) {
        union header *previous = block->previous;
        if (pool->allocator)
            pool->allocator->release(pool->allocator->context, block);
        else
            free(block);
        block = previous;
    }
    pool->last = NULL;
}

void pool_absorb(struct pool *pool, struct pool *other)
{
    union header *oldest = other->last;
    while (oldest && oldest->previous)
        oldest = oldest->previous;
    if (!oldest)
        return;
    oldest->previous = pool->last;
    pool->last = other->last;
    other->last = NULL;
}

void *pool_get(struct pool *pool, size_t count, size_t size)
{
    if (size && count > (SIZE_MAX - sizeof(union header)) / size)
        return NULL;
    size_t bytes = sizeof(union header) + count * size;
    /* calloc knows which memory is new, and zero: a large block costs what is used of it */
    union header *block = pool->allocator ? pool->allocator->allocate(pool->allocator->context, bytes) : calloc(1, bytes);
    if (!block)
        return NULL;
    if (pool->allocator)
        memset(block, 0, bytes);
    block->previous = pool->last;
    pool->last = block;
    return block + 1;
}

void *pool_grow(struct pool *pool, void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    size_t wanted = *capacity ? 2 * *capacity : 8;
    void *larger = wanted > *capacity ? pool_get(pool, wanted, size) : NULL;
    if (!larger)
        return NULL;
    if (count)
        memcpy(larger, array, count * size);
    *capacity = wanted;
    return larger;
}

char *pool_copy_text(struct pool *pool, const char *text)
{
    size_t bytes = strlen(text) + 1;
    char *copy = pool_get(pool, bytes, 1);
    return copy ? memcpy(copy, text, bytes) : NULL;
}

char *pool_format(struct pool *pool, const char *format, ...)
{
    va_list first, second;
    va_start(first, format);
    va_copy(second, first);
    int length = vsnprintf(NULL, 0, format, first);
    char *text = length < 0 ? NULL : pool_get(pool, (size_t)length + 1, 1);
    if (text)
        (void)vsnprintf(text, (size_t)length + 1, format, second);
    va_end(second);
    va_end(first);
    return text;
}
