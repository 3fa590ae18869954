#include "record/record.h"

size_t record_element_size(const struct record_field *field)
{
    return field->kind == FIELD_NUMBER   ? sizeof(double)
           : field->kind == FIELD_TEXT   ? sizeof(const char *)
           : field->kind == FIELD_RECORD ? field->record->size
           : field->kind == FIELD_MAP    ? sizeof(rotid_component)
           : field->kind == FIELD_CHARS  ? field->columns
                                         : sizeof(int);
}

/* The pointer at `place` leads to a copy of its own of what it leads to. Number of the elements there, 0 where there are none. */
static size_t own_list(struct pool *pool, char *place, size_t count, size_t size)
{
    const void *from = *(const void *const *)place;
    void *copy = from ? pool_get(pool, count, size) : NULL;
    if (copy && count)
        memcpy(copy, from, count * size);
    *(void **)place = copy;
    return copy ? count : 0;
}

static size_t length_of(const struct record_field *field, const char *of)
{
    size_t count = field->shape == SHAPE_LIST || field->shape == SHAPE_MATRIX ? (size_t) * (const int *)(of + field->count) : 1;
    int by_columns = field->shape == SHAPE_MATRIX || field->kind == FIELD_MAP;
    return by_columns ? count * (size_t) * (const int *)(of + field->columns) : count;
}

/* Whatever the rows lead to from the struct at `of` becomes its own. */
static void own(struct pool *pool, const struct record *record, char *of)
{
    for (const struct record_field *field = record->field; field->key; field++) {
        char *place = of + field->offset;
        size_t size = field->kind == FIELD_INLINE ? field->record->size : record_element_size(field), count = 1;
        if (field->shape == SHAPE_FIXED || field->kind == FIELD_COUNT)
            continue;
        if (field->shape != SHAPE_ONE || field->kind == FIELD_MAP || field->bits & BEHIND_POINTER) {
            count = own_list(pool, place, length_of(field, of), size);
            place = *(char **)place;
        }
        for (size_t i = 0; i < count; i++, place += size)
            if (field->kind == FIELD_RECORD || field->kind == FIELD_INLINE)
                own(pool, field->record, place);
            else if ((field->kind == FIELD_TEXT || field->kind == FIELD_MAP) &&
                     *(const char *const *)place) /* a component: its name */
                (void)own_list(pool, place, strlen(*(const char *const *)place) + 1, 1);
    }
}

void *record_copy(struct pool *pool, const struct record *record, const void *from)
{
    void *copy = pool_get(pool, 1, record->size);
    if (!copy)
        return NULL;
    memcpy(copy, from, record->size);
    own(pool, record, copy);
    return pool->out_of_memory ? NULL : copy;
}
