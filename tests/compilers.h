/* Compilers and folders for tests that build programs of their own. */
#ifndef ROTID_TESTS_COMPILERS_H
#define ROTID_TESTS_COMPILERS_H

#include "base/base.h"

/* The compiler that the environment names in CC, CXX or FC, else cc, c++, gfortran. */
const char *compiler(const char *variable);
/* Is there such a program. */
int has_compiler(struct pool *pool, const char *variable);
/* Skips the test, saying so, where there is none. */
void needs_compiler(struct pool *pool, const char *variable);

/* A new folder, its path on the pool, and its end with all that is in it. */
const char *make_folder(struct pool *pool);
void remove_folder(struct pool *pool, const char *folder);
/* Writes the text into a file of the folder; returns its path, on the pool. */
const char *write_file(struct pool *pool, const char *folder, const char *name, const char *text);

#endif
