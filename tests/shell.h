/* Commands of the shell, for tests of what is built around the program and the library. */
#ifndef ROTID_TESTS_SHELL_H
#define ROTID_TESTS_SHELL_H

#include "base/base.h"

/* Runs a command by sh, with both its streams in one. *output (NULL allowed): what it wrote, on the pool. Returns its exit code,
 * 128
 * + the signal that ended it. Variables that a make above this test has set for its children are not passed on. */
int shell_code(struct pool *pool, const char **output, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* The same for what has to succeed: otherwise the test fails with command and output. Returns what it wrote. */
const char *shell(struct pool *pool, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The text of a file, on the pool; the test fails where it cannot be read. */
const char *shell_file(struct pool *pool, const char *path);

#endif
