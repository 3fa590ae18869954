#include "base/base.h"

/* The header keeps the payload behind it aligned for any type. */
union header {
    void *previous;
    max_align_t align;
};

void pool_open(struct pool *pool, const rotid_allocator *allocator)
{
    pool->allocator = allocator;
    pool->last = NULL;
    pool->out_of_memory = 0;
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

struct pool *pool_new(const rotid_allocator *allocator)
{
    struct pool pool;
    pool_open(&pool, allocator);
    struct pool *made = POOL_NEW(&pool, struct pool);
    if (made)
        *made = pool;
    return made;
}

void pool_free(struct pool *pool)
{
    struct pool blocks = {0};
    if (pool)
        blocks = *pool; /* it goes with its own blocks */
    pool_close(&blocks);
}

void pool_absorb(struct pool *pool, struct pool *other)
{
    union header *oldest = other->last;
    pool->out_of_memory |= other->out_of_memory;
    while (oldest && oldest->previous)
        oldest = oldest->previous;
    if (!oldest)
        return;
    oldest->previous = pool->last;
    pool->last = other->last;
    other->last = NULL;
}

static void *take(struct pool *pool, size_t count, size_t size, int zeroed)
{
    int fits = !size || count <= (SIZE_MAX - sizeof(union header)) / size;
    size_t bytes = fits ? sizeof(union header) + count * size : 0;
    /* calloc knows which memory is new, and zero: a large block costs what is used of it */
    union header *block = !fits             ? NULL
                          : pool->allocator ? pool->allocator->allocate(pool->allocator->context, bytes)
                          : zeroed          ? calloc(1, bytes)
                                            : malloc(bytes);
    if (!block) {
        pool->out_of_memory = 1;
        return NULL;
    }
    if (pool->allocator && zeroed)
        memset(block, 0, bytes);
    block->previous = pool->last;
    pool->last = block;
    return block + 1;
}

void *pool_get(struct pool *pool, size_t count, size_t size)
{
    return take(pool, count, size, 1);
}

void *pool_room(struct pool *pool, size_t count, size_t size)
{
    return take(pool, count, size, 0);
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

int pool_add(struct pool *pool, void **list, int *count, size_t size, const void *item)
{
    int full = !*count || (*count >= 8 && !(*count & (*count - 1))); /* there is room for 8, doubled whenever it is full */
    size_t room = (size_t)*count + !full;
    char *grown = pool_grow(pool, *list, (size_t)*count, &room, size);
    if (!grown)
        return 1;
    *list = grown;
    memcpy(grown + (size_t)(*count)++ * size, item, size);
    return 0;
}

void *pool_copy(struct pool *pool, const void *list, size_t count, size_t more, size_t size)
{
    void *copy = count + more < count ? NULL : pool_get(pool, count + more, size);
    if (copy && list && count)
        memcpy(copy, list, count * size);
    return copy;
}

double *pool_unknown(struct pool *pool, size_t count)
{
    double *value = POOL_ARRAY(pool, double, count);
    for (size_t i = 0; i < count && value; i++)
        value[i] = NAN;
    return value;
}

char *pool_copy_text(struct pool *pool, const char *text)
{
    return pool_copy(pool, text, strlen(text) + 1, 0, 1);
}

static char *formatted(struct pool *pool, const char *format, va_list values)
{
    va_list again;
    va_copy(again, values);
    int length = vsnprintf(NULL, 0, format, values);
    char *text = length < 0 ? NULL : pool_get(pool, (size_t)length + 1, 1);
    if (text)
        (void)vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

const char *pool_text_of(struct pool *pool, const char *format, va_list values)
{
    const char *text = formatted(pool, format, values);
    return text ? text : "";
}

const char *pool_text(struct pool *pool, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const char *text = pool_text_of(pool, format, values);
    va_end(values);
    return text;
}

char *pool_format(struct pool *pool, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    char *text = formatted(pool, format, values);
    va_end(values);
    return text;
}
