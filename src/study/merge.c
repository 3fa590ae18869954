#include "study/study.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file/file.h"

#define MOST_LISTED 20 /* stretches of missing runs that are named */

/* A line of a part. */
struct part_line {
    long run;
    int part; /* index of the path */
    struct result_place place;
};

struct merger {
    struct pool *pool;
    struct message_list *messages;
    char *const *path;
    struct study_header header; /* of the first part */
    int nentry;
    size_t most; /* most: bytes of the longest line */
    struct part_line *entry;
    struct result_place *place; /* [runs] of the line that is taken */
};

/* By runs; those that did not fail first, then by parts. */
static int by_run(const void *left, const void *right)
{
    const struct part_line *a = left, *b = right;
    if (a->run != b->run)
        return a->run < b->run ? -1 : 1;
    return a->place.failed != b->place.failed ? a->place.failed - b->place.failed : a->part - b->part;
}

/* The lines of a part, which has to be of the same study as the first one. */
static int add_part(struct merger *m, int part, int *descriptor)
{
    const char *path = m->path[part], *difference = NULL;
    struct stat about;
    struct results file;
    *descriptor = file_descriptor(path, &about);
    if (*descriptor < 0)
        return message_refuse(m->messages, ROTID_ERROR_IO, path, 1, 1, "cannot be opened: %s, expected a file of results",
                              strerror(errno));
    int status = results_read(m->pool, *descriptor, path, m->messages, &file);
    m->header = part ? m->header : file.header;
    if (!status)
        status = header_difference(m->pool, &file.header, &m->header, 0, &difference);
    if (!status && difference)
        status = message_refuse(m->messages, ROTID_ERROR_ARGUMENT, path, 1, 1, "this file is not of the same study as %s: %s",
                                m->path[0], difference);
    for (long run = 0; !status && run < file.header.runs; run++) {
        if (!file.place[run].length)
            continue;
        const struct part_line entry = {run, part, file.place[run]};
        if (POOL_ADD(m->pool, m->entry, m->nentry, &entry))
            return ROTID_ERROR_MEMORY;
    }
    m->most = !status && file.most > m->most ? file.most : m->most;
    return status;
}

/* Length of a line without its time, which stands last. */
static size_t timeless(const char *line)
{
    static const char key[] = ",\"seconds\":";
    const char *at = NULL;
    for (const char *next = strstr(line, key); next; next = strstr(next + 1, key))
        at = next;
    return at ? (size_t)(at - line) : strlen(line);
}

/* Whether two lines of a run that did not fail say the same. */
static int compare(struct merger *m, const struct part_line *one, const struct part_line *other, char *text[2])
{
    const struct part_line *both[2] = {one, other};
    size_t length[2];
    for (int i = 0; i < 2; i++) {
        if (results_fetch(both[i]->place, text[i]))
            return message_refuse(m->messages, ROTID_ERROR_IO, m->path[both[i]->part], 1, 1, "reading failed: %s",
                                  strerror(errno));
        text[i][both[i]->place.length] = 0;
        length[i] = timeless(text[i]);
    }
    if (length[0] == length[1] && !memcmp(text[0], text[1], length[0]))
        return ROTID_OK;
    return message_refuse(
        m->messages, ROTID_ERROR_ARGUMENT, m->path[other->part], 1, 1,
        "run %ld has another result in %s, expected the same: were both computed by one program on machines of one kind?",
        one->run, m->path[one->part]);
}

/* Of the lines of each run the first one; the others that did not fail have to say the same. */
static int choose(struct merger *m, struct merge *merge)
{
    char *text[2] = {pool_get(m->pool, m->most + 1, 1), pool_get(m->pool, m->most + 1, 1)};
    const struct part_line *first = NULL;
    int status = ROTID_OK;
    m->place = POOL_ARRAY(m->pool, struct result_place, m->header.runs);
    if (!text[0] || !text[1] || !m->place)
        return ROTID_ERROR_MEMORY;
    if (m->nentry)
        qsort(m->entry, (size_t)m->nentry, sizeof *m->entry, by_run);
    for (int i = 0; i < m->nentry && !status; i++) {
        const struct part_line *entry = &m->entry[i];
        if (!first || first->run != entry->run) {
            first = entry;
            m->place[entry->run] = entry->place;
            merge->failed += entry->place.failed;
        } else if (!entry->place.failed) {
            status = compare(m, first, entry, text);
        }
    }
    return status;
}

/* "3, 7-9", and how many there are. */
static int list_missing(struct merger *m, struct merge *merge)
{
    int stretches = 0;
    merge->list = "";
    for (long run = 0, last; run < m->header.runs && merge->list; run = last + 1) {
        last = run;
        if (m->place[run].length)
            continue;
        while (last + 1 < m->header.runs && !m->place[last + 1].length)
            last++;
        merge->missing += last - run + 1;
        if (stretches < MOST_LISTED)
            merge->list = last > run ? pool_format(m->pool, "%s%s%ld-%ld", merge->list, stretches ? ", " : "", run, last)
                                     : pool_format(m->pool, "%s%s%ld", merge->list, stretches ? ", " : "", run);
        else if (stretches == MOST_LISTED)
            merge->list = pool_format(m->pool, "%s, ...", merge->list);
        stretches++;
    }
    return merge->list ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int merge_results(struct pool *pool, int count, char *const *path, const char *to, struct message_list *messages,
                  struct merge *merge)
{
    struct merger m = {.pool = pool, .messages = messages, .path = path};
    int *descriptor = POOL_ARRAY(pool, int, count), status = descriptor ? ROTID_OK : ROTID_ERROR_MEMORY, opened = 0;
    *merge = (struct merge){0};
    if (!status && access(to, F_OK) == 0)
        return message_refuse(messages, ROTID_ERROR_ARGUMENT, to, 1, 1,
                              "exists, expected the name of a new file for all parts together");
    for (; opened < count && !status; opened++)
        status = add_part(&m, opened, &descriptor[opened]);
    if (!status)
        status = choose(&m, merge);
    if (!status)
        status = list_missing(&m, merge);
    if (!status) {
        m.header.shard = NULL;
        merge->runs = m.header.runs;
        status = results_write(to, &m.header, m.place, m.most);
        if (status == ROTID_ERROR_IO)
            message_add(messages, SEVERITY_ERROR, to, 1, 1, "cannot be written: %s", output_error());
    }
    for (int p = 0; p < opened; p++)
        if (descriptor[p] >= 0)
            (void)close(descriptor[p]);
    return status;
}
