/* A universal file of a test's own: written, opened with the streaming reader, and removed again. */
#ifndef ROTID_TESTS_UFF_FIXTURE_H
#define ROTID_TESTS_UFF_FIXTURE_H

#include "support.h"
#include "uff/uff.h"

#define UFF_EDGE "    -1\n"

struct uff_fixture {
    struct pool pool;
    struct message_list messages;
    struct uff_reader *reader;
    char path[512];
};

/* The path of a new file with these bytes. */
void uff_write_bytes(char path[512], const void *bytes, size_t length);

/* Opens a file of those bytes, or of that text, which is one path less in the folder once it is closed. */
void uff_fixture_bytes(struct uff_fixture *fixture, const void *bytes, size_t length);
void uff_fixture_text(struct uff_fixture *fixture, const char *text);
void uff_fixture_close(struct uff_fixture *fixture);

/* The next set, which must have that number. */
struct uff_set uff_fixture_next(struct uff_fixture *fixture, int number);

/* Asserts the status, and that of an error of syntax the last message is in this line (and column, unless 0) and has this part.
 */
void uff_fixture_refuses(struct uff_fixture *fixture, int status, int line, int column, const char *part);

/* Asserts that there are no messages, or one warning with this part. */
void uff_fixture_is_quiet(const struct uff_fixture *fixture);
void uff_fixture_warns(const struct uff_fixture *fixture, const char *part);

#endif
