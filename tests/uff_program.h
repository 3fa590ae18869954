/* Universal files of a test's own in a folder of its own, and runs of rotid uff there. */
#ifndef ROTID_TESTS_UFF_PROGRAM_H
#define ROTID_TESTS_UFF_PROGRAM_H

#include "uff/uff.h"

#define UFF_OUTPUT_LIMIT 65536
extern char uff_folder[], uff_output[UFF_OUTPUT_LIMIT]; /* output: both streams of the last run */
extern const struct uff_units uff_si;

/* The folder, as setup and teardown of cmocka. */
int make_directory(void **state);
int remove_directory(void **state);

const char *path_of(const char *name);
FILE *create(const char *name);
int is_there(const char *name);
/* Files whose name begins so. */
int count_files(const char *beginning);
/* The bytes of a file, to be freed; NULL where there is none. */
char *read_file(const char *name, size_t *length);

/* Runs `rotid uff` in the folder and returns its exit code; asserts the code and a part of what it says. */
int run(const char *arguments);
void says(const char *arguments, int code, const char *text);

/* A function at a node, complex double where it is a transfer function, real single otherwise. */
struct uff_function function(int type, int node, int count);
/* With values: a decaying wave of its own for each node, times `gain`, limited to `most`. */
void put_function(FILE *stream, const struct uff_function *f, double gain, double most);
/* Nodes 1 to count along z, a quarter of a metre apart. */
void put_nodes(FILE *stream, int count);
/* Three transfer functions with all that belongs to them, and a set that is not known. */
void make_sound(const char *name);

#endif
