/* Files that are whole or not there. Used by the writers alone. */
#ifndef HAMMER_FILE_H
#define HAMMER_FILE_H

#include <stdio.h>

#include "hide/hide_text.h"

struct hammer_file {
    const char *path;
    struct hide_text temporary; /* name of the file until it is whole */
    FILE *stream;
};

/* HAMMER_OK or HAMMER_FAILURE with a message; hammer_file_close only after HAMMER_OK. */
int hammer_file_open(const char *path, struct hammer_file *file, const struct hide_message *message);

/* Gives the file its name; with `failed` set, or where that does not work, the file goes away. */
int hammer_file_close(struct hammer_file *file, int failed, const struct hide_message *message);

/* The whole text, whose memory is freed. */
int hammer_file_write(const char *path, struct hide_text *text, const struct hide_message *message);

#endif
