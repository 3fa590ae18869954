/* A folder of a test program's own. */
#ifndef ROTID_TESTS_FOLDER_H
#define ROTID_TESTS_FOLDER_H

#include <stddef.h>

extern char folder[];

/* Setup and teardown of a group. What folder_path and folder_write have named is removed; with anything else in it the teardown
 * fails: a file that somebody left behind. */
int folder_make(void **state);
int folder_remove(void **state);

/* folder/name. Sixteen of them are in use at a time. */
const char *folder_path(const char *name);
/* Writes that text into it and returns its path. */
const char *folder_write(const char *name, const char *text);
/* The bytes of a file with a zero behind them, to be freed; NULL where there is none. length may be NULL. */
char *file_bytes(const char *path, size_t *length);

#endif
