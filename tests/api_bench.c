#include "api_bench.h"

#include <unistd.h>

#define MODES   5
#define SENSORS 11

#define FREQUENCY_NOISE 0.002
#define SHAPE_NOISE     0.015

/* Every group with `finer` times the elements: data are those of a mesh without error. */
static FILE *open_deck(const char *path, int finer)
{
    FILE *stream = fopen(path, "wb");
    if (!stream)
        abort();
    (void)fprintf(stream,
                  "*HEADING\nhidden\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                  "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.4e11, 0.28\n*DENSITY\n7600\n"
                  "*SHAFT, NAME=left, MATERIAL=steel\n0.4, 0.15, 0, %d\n*SHAFT, NAME=core, MATERIAL=sheets\n0.9, 0.3, 0, %d\n"
                  "*SHAFT, NAME=right, MATERIAL=steel\n0.5, 0.17, 0, %d\n*SPRING, NAME=sling\nstart, 9000\n"
                  "*SPRING, NAME=tail\nend, 2000\n*SENSORS\n",
                  6 * finer, 10 * finer, 7 * finer);
    for (int s = 0; s < SENSORS; s++)
        (void)fprintf(stream, "%d, %.17g\n", s + 1, 1.8 * s / (SENSORS - 1));
    return stream;
}

rotid_deck *bench_deck(const char *path)
{
    rotid_deck *deck = NULL;
    int status = rotid_deck_read(path, 0, NULL, NULL, NULL, &deck);
    for (int i = 0; status && deck && i < deck->nmessage; i++)
        print_error("%s:%d:%d: %s\n", path, deck->message[i].line, deck->message[i].column, deck->message[i].text);
    if (status)
        abort();
    return deck;
}

void bench_hidden_deck(const char *path, double gradient, unsigned seed)
{
    struct random_stream stream = {seed};
    rotid_spectrum *s;
    FILE *out = open_deck(path, 4);
    if (gradient != 0)
        (void)fprintf(out, "*CAUSE, NAME=hidden, TYPE=stiffness_gradient, GROUP=core\nslope, %.17g\n", gradient);
    (void)fclose(out);
    rotid_deck *deck = bench_deck(path);
    if (rotid_spectrum_compute(deck, NULL, MODES, NULL, NULL, &s) || s->nmodes != MODES)
        abort();
    rotid_deck_free(deck);
    out = open_deck(path, 1);
    (void)fprintf(out, "*MODES\n");
    for (int k = 0; k < MODES; k++)
        (void)fprintf(out, "%d, %.17g\n", k + 1, s->modes[k].full_hz * (1 + FREQUENCY_NOISE * random_normal(&stream)));
    (void)fprintf(out, "*NOISE, FREQUENCY=%g, SHAPE=%g\n", FREQUENCY_NOISE, SHAPE_NOISE);
    for (int k = 0; k < MODES; k++) {
        (void)fprintf(out, "*SHAPE, MODE=%d\n", k + 1);
        for (int i = 0; i < SENSORS; i++)
            (void)fprintf(out, "%d, %.17g\n", i + 1, s->modes[k].shape[i] + SHAPE_NOISE * random_normal(&stream));
    }
    (void)fprintf(out, "*IDENTIFY\ncore.E, 2e10, 2.2e11, 0.9e11\ncore.G, 1e10, 0.9e11, 0.35e11\n");
    if (fclose(out) != 0)
        abort();
    rotid_spectrum_free(s);
}

struct bench_block { /* keeps what follows it aligned for any type */
    struct bench_block *newer, *older;
    size_t bytes, unused;
};

static void *allocate(void *context, size_t bytes)
{
    struct bench_memory *memory = context;
    struct bench_block *block = malloc(sizeof *block + bytes);
    if (!block)
        return NULL;
    *block = (struct bench_block){.older = memory->newest, .bytes = bytes};
    if (memory->newest)
        memory->newest->newer = block;
    memory->newest = block;
    memory->in_use++;
    memory->served++;
    memset(block + 1, 0xa5, bytes);
    return block + 1;
}

static void release(void *context, void *address)
{
    struct bench_memory *memory = context;
    struct bench_block *block = (struct bench_block *)address - 1;
    if (block->newer)
        block->newer->older = block->older;
    else
        memory->newest = block->older;
    if (block->older)
        block->older->newer = block->newer;
    memset(block + 1, 0x5a, block->bytes);
    memory->in_use--;
    free(block);
}

void bench_memory_open(struct bench_memory *memory)
{
    *memory = (struct bench_memory){.allocator = {allocate, release, memory}};
}

int bench_owns(const struct bench_memory *memory, const void *address)
{
    for (const struct bench_block *block = memory->newest; block; block = block->older) {
        uintptr_t first = (uintptr_t)(block + 1), at = (uintptr_t)address;
        if (at >= first && at < first + block->bytes)
            return 1;
    }
    return 0;
}
