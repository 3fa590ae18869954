/* Where the characters of a deck come from: a file, or the memory of a host. */
#ifndef ROTID_DECK_DECK_SOURCE_H
#define ROTID_DECK_DECK_SOURCE_H

#include <stdio.h>
#include <sys/stat.h>

#define DECK_SOURCE_END (-1)

/* A deck without a file. */
struct deck_memory {
    const char *name; /* what stands for the file in messages */
    size_t length;
    const char *text;      /* [length] */
    const char *directory; /* of what it names, or NULL: it may name no files */
};

struct deck_source {
    struct stat information; /* of the file; zeros for memory */
    FILE *stream;            /* NULL: memory */
    const char *text;
    size_t left;
};

/* 0, or the error number of the operating system. */
int deck_source_open(struct deck_source *source, const char *path);
void deck_source_open_memory(struct deck_source *source, const struct deck_memory *memory);

/* Bytes that it holds, -1 where nobody knows: a pipe. */
long long deck_source_length(const struct deck_source *source);

/* The next byte, or DECK_SOURCE_END. */
int deck_source_next(struct deck_source *source);

/* 0, or the error number where reading ended before the end. */
int deck_source_close(struct deck_source *source);

#endif
