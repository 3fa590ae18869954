/* Small decks whose data hold an effect that they do not say, made through the first layer itself; and the memory of a host that
 * knows what it has handed out. */
#ifndef ROTID_TESTS_API_BENCH_H
#define ROTID_TESTS_API_BENCH_H

#include "support.h"

/* A shaft of three groups, its core softened towards one end by `gradient` (0: not at all), as modes, shapes and noise of a deck
 * at `path`, which identifies core.E and core.G of a uniform core. seed: of the noise. */
void bench_hidden_deck(const char *path, double gradient, unsigned seed);

/* A deck that must be right. */
rotid_deck *bench_deck(const char *path);

/* Memory that is spoilt when it is given back. One thread at a time. */
struct bench_memory {
    rotid_allocator allocator;
    struct bench_block *newest;
    long in_use, served;
};
void bench_memory_open(struct bench_memory *memory);
/* Whether the address lies in a block that is in use. */
int bench_owns(const struct bench_memory *memory, const void *address);

#endif
