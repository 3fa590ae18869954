#include "study/study.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ..., "study": "0123456789abcdef", "digest": "0123456789abcdef"}: the digest is of all bytes before its comma but the quote */
#define STUDY  ",\"study\":\""
#define DIGEST "\",\"digest\":\""
#define END    "\"}\n"
#define LENGTH (sizeof STUDY + sizeof DIGEST + sizeof END - 3 + 2 * (size_t)DIGEST_LETTERS)

void stamp_study(const struct header *header, char study[DIGEST_LETTERS + 1])
{
    struct digest digest;
    digest_open(&digest);
    digest_text(&digest, header->version);
    digest_text(&digest, header->commit);
    digest_text(&digest, header->studies);
    digest_text(&digest, header->plan_digest);
    if (header->plan) {
        digest_text(&digest, header->decks_digest);
        digest_text(&digest, header->data_digest);
    }
    digest_text(&digest, header->options_digest);
    digest_integer(&digest, (long long)header->seed);
    digest_integer(&digest, header->runs);
    digest_letters(&digest, study);
}

static void digest_of(size_t length, const char *bytes, char letters[DIGEST_LETTERS + 1])
{
    struct digest digest;
    digest_open(&digest);
    digest_bytes(&digest, length, bytes);
    digest_letters(&digest, letters);
}

char *stamp_line(const char study[DIGEST_LETTERS + 1], const char *line)
{
    size_t body = strlen(line) - strlen("}\n"), length = body + strlen(STUDY) + DIGEST_LETTERS;
    char *stamped = malloc(body + LENGTH + 1), digest[DIGEST_LETTERS + 1];
    if (!stamped)
        return NULL;
    memcpy(stamped, line, body);
    (void)snprintf(stamped + body, LENGTH + 1, STUDY "%s", study);
    digest_of(length, stamped, digest);
    (void)snprintf(stamped + length, LENGTH + 1 + body - length, DIGEST "%s" END, digest);
    return stamped;
}

enum stamp_fault stamp_check(const char study[DIGEST_LETTERS + 1], const char *line, size_t length)
{
    char digest[DIGEST_LETTERS + 1];
    if (length < LENGTH)
        return STAMP_NONE;
    const char *stamp = line + length - LENGTH, *behind = stamp + strlen(STUDY) + DIGEST_LETTERS;
    if (memcmp(stamp, STUDY, strlen(STUDY)) != 0 || memcmp(behind, DIGEST, strlen(DIGEST)) != 0 ||
        memcmp(line + length - strlen(END), END, strlen(END)) != 0)
        return STAMP_NONE;
    digest_of((size_t)(behind - line), line, digest);
    if (memcmp(behind + strlen(DIGEST), digest, DIGEST_LETTERS) != 0)
        return STAMP_CHANGED;
    return memcmp(stamp + strlen(STUDY), study, DIGEST_LETTERS) != 0 ? STAMP_OTHER_STUDY : STAMP_GOOD;
}
