#include "rotor/rotor.h"

static const double gravity = 9.81; /* m/s2: the value the paper's table of the rotor rests on */

int rotor_copy(struct pool *pool, const struct rotor *rotor, struct rotor *copy)
{
    int sling = rotor->sling > 0 ? 2 : 0;
    *copy = *rotor;
    copy->group = POOL_COPY(pool, rotor->group, rotor->ngroup, 0);
    copy->segment = POOL_COPY(pool, rotor->segment, rotor->nsegment, 0);
    copy->ring = POOL_COPY(pool, rotor->ring, rotor->nring, 0);
    copy->tierod = POOL_COPY(pool, rotor->tierod, rotor->ntierod, 0);
    copy->bars = POOL_COPY(pool, rotor->bars, rotor->nbars, 0);
    copy->disk = POOL_COPY(pool, rotor->disk, rotor->ndisk, 0);
    copy->spring = POOL_COPY(pool, rotor->spring, rotor->nspring, sling);
    copy->sensor = POOL_COPY(pool, rotor->sensor, rotor->nsensor, 0);
    copy->effect = POOL_COPY(pool, rotor->effect, rotor->neffect, 0);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    if (sling) {
        copy->spring[copy->nspring++] = (struct spring){.name = "sling", .position = 0};
        copy->spring[copy->nspring++] = (struct spring){.name = "sling end", .position = rotor_length(rotor)};
    }
    return ROTID_OK;
}

void rotor_set_sling(struct rotor *rotor, double mass, double center)
{
    struct spring *spring = rotor->spring + rotor->nspring - 2;
    double weight = mass * gravity, length = rotor_length(rotor);
    spring[0].lateral = weight / rotor->sling;
    spring[1].lateral = weight * center / (length * length + center * rotor->sling);
}

/* ------------------------------------------------------------------------------------------------ shape and values */

/* Members that stand side by side in a struct, without a gap. */
struct span {
    size_t from, end;
};
#define SPAN(S, FIRST, LAST)                                                                                                     \
    {                                                                                                                            \
        offsetof(S, FIRST), offsetof(S, LAST) + sizeof(((S *)0)->LAST)                                                           \
    }
/* Of a material all that no parameter can change, and what one can. */
#define KIND(S)  SPAN(S, material.isotropic, material.stacking)
#define STATE(S) SPAN(S, material.e, material.rho)
#define LIST(M)  offsetof(struct rotor, M), offsetof(struct rotor, n##M), sizeof(struct M)

/* The lists of a rotor; of their structs what a mesh follows from, and what the values of a model are. */
static const struct list {
    size_t list, count, size;
    struct span shape[4], values[2];
} lists[] = {
    {LIST(group),
     {KIND(struct group), SPAN(struct group, holes, holes), SPAN(struct group, hole_diameter, preload),
      SPAN(struct group, layer_of, layer_of)},
     {STATE(struct group)}},
    {LIST(segment), {SPAN(struct segment, group, rectangular), SPAN(struct segment, length, width)}, {{0}}},
    {LIST(ring), {SPAN(struct ring, group, inner)}, {{0}}},
    {LIST(tierod),
     {KIND(struct tierod), SPAN(struct tierod, from, pitch)},
     {STATE(struct tierod), SPAN(struct tierod, tension, tension)}},
    {LIST(bars),
     {KIND(struct bars), STATE(struct bars), SPAN(struct bars, center, elements), SPAN(struct bars, diameter, pitch)},
     {{0}}},
    {LIST(disk),
     {SPAN(struct disk, position, position), SPAN(struct disk, hub_length, hub_outer)},
     {SPAN(struct disk, mass, diametral)}},
    {LIST(spring), {SPAN(struct spring, position, position)}, {SPAN(struct spring, lateral, rotational)}},
    {LIST(sensor), {SPAN(struct sensor, position, position)}, {{0}}},
    {LIST(effect), {SPAN(struct effect, kind, variant)}, {SPAN(struct effect, value, value)}},
};
#define LISTS (sizeof lists / sizeof *lists)

static int count_of(const struct rotor *rotor, const struct list *list)
{
    return *(const int *)((const char *)rotor + list->count);
}

static int same_items(const struct rotor *a, const struct rotor *b, const struct list *list, int nspan, const struct span *span)
{
    const char *one = *(const char *const *)((const char *)a + list->list),
               *other = *(const char *const *)((const char *)b + list->list);
    for (int i = 0; i < count_of(a, list); i++, one += list->size, other += list->size)
        for (int s = 0; s < nspan && span[s].end; s++)
            if (memcmp(one + span[s].from, other + span[s].from, span[s].end - span[s].from) != 0)
                return 0;
    return 1;
}

int rotor_same_shape(const struct rotor *a, const struct rotor *b)
{
    int same = a->sling == b->sling;
    for (size_t i = 0; i < LISTS && same; i++)
        same = count_of(a, &lists[i]) == count_of(b, &lists[i]) && same_items(a, b, &lists[i], 4, lists[i].shape);
    return same;
}

int rotor_same_values(const struct rotor *a, const struct rotor *b)
{
    int same = a->count_all == b->count_all;
    for (size_t i = 0; i < LISTS && same; i++)
        same = same_items(a, b, &lists[i], 2, lists[i].values);
    return same;
}
