#include "study/study.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file/file.h"
#include "report/report.h"
#include "result/result.h"

#define MOST_LISTED 20 /* stretches of missing runs that are named */

struct part {
    const char *path;
    int descriptor;
    struct header header;
    struct result_place *place; /* [runs] */
};

struct merger {
    struct pool *pool;
    struct message_list *messages;
    int count;
    struct part *part;
    int *source;   /* [runs] part that a run is taken from, -1: none */
    char *text[2]; /* room for the longest line, twice */
    size_t most;
};

static int open_part(struct merger *m, const char *path, struct part *part)
{
    struct stat about;
    size_t most;
    part->path = path;
    part->descriptor = file_descriptor(path, &about);
    if (part->descriptor < 0) {
        message_add(m->messages, SEVERITY_ERROR, path, 1, 1, "cannot be opened: %s, expected a file of results", strerror(errno));
        return ROTID_ERROR_IO;
    }
    int status = results_index(m->pool, part->descriptor, path, m->messages, &part->header, &part->place, &most);
    m->most = !status && most > m->most ? most : m->most;
    return status;
}

/* Two parts of one study. */
static int compare(struct merger *m, const struct part *first, const struct part *part)
{
    const char *difference;
    int status = header_difference(m->pool, &part->header, &first->header, &difference);
    if (!status && difference) {
        message_add(m->messages, SEVERITY_ERROR, part->path, 1, 1, "this file is not of the same study as %s: %s", first->path,
                    difference);
        status = ROTID_ERROR_ARGUMENT;
    }
    return status;
}

static int fetch(struct merger *m, const struct part *part, long run, char *text)
{
    if (!results_fetch(part->descriptor, part->place[run], text)) {
        text[part->place[run].length] = 0;
        return ROTID_OK;
    }
    message_add(m->messages, SEVERITY_ERROR, part->path, 1, 1, "reading failed: %s", strerror(errno));
    return ROTID_ERROR_IO;
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

/* A run that stands in two parts: which one counts. */
static int settle(struct merger *m, long run, int other)
{
    struct part *first = &m->part[m->source[run]], *second = &m->part[other];
    int status = fetch(m, first, run, m->text[0]);
    if (!status)
        status = fetch(m, second, run, m->text[1]);
    if (status)
        return status;
    size_t length[2] = {timeless(m->text[0]), timeless(m->text[1])};
    if (length[0] == length[1] && !memcmp(m->text[0], m->text[1], length[0]))
        return ROTID_OK;
    int failed[2] = {result_failed(m->text[0]), result_failed(m->text[1])};
    if (failed[0] || failed[1]) {
        m->source[run] = failed[0] ? other : m->source[run];
        return ROTID_OK;
    }
    message_add(m->messages, SEVERITY_ERROR, second->path, 1, 1,
                "run %ld has another result in %s, expected the same: were both computed by one program on machines of one kind?",
                run, first->path);
    return ROTID_ERROR_ARGUMENT;
}

static int choose(struct merger *m)
{
    long runs = m->part[0].header.runs;
    int status = ROTID_OK;
    m->source = POOL_ARRAY(m->pool, int, runs);
    m->text[0] = pool_get(m->pool, m->most + 1, 1);
    m->text[1] = pool_get(m->pool, m->most + 1, 1);
    if (!m->source || !m->text[0] || !m->text[1])
        return ROTID_ERROR_MEMORY;
    for (long run = 0; run < runs; run++) {
        m->source[run] = -1;
        for (int p = 0; p < m->count && !status; p++)
            if (m->part[p].place[run].length && m->source[run] < 0)
                m->source[run] = p;
            else if (m->part[p].place[run].length)
                status = settle(m, run, p);
    }
    return status;
}

/* "3, 7-9", and how many there are. */
static int list_missing(struct merger *m, struct merge *merge)
{
    long runs = m->part[0].header.runs;
    int stretches = 0;
    merge->list = "";
    for (long run = 0; run < runs && merge->list; run++) {
        long last = run;
        if (m->source[run] >= 0)
            continue;
        while (last + 1 < runs && m->source[last + 1] < 0)
            last++;
        merge->missing += last - run + 1;
        if (stretches < MOST_LISTED)
            merge->list = last > run ? pool_format(m->pool, "%s%s%ld-%ld", merge->list, stretches ? ", " : "", run, last)
                                     : pool_format(m->pool, "%s%s%ld", merge->list, stretches ? ", " : "", run);
        else if (stretches == MOST_LISTED)
            merge->list = pool_format(m->pool, "%s, ...", merge->list);
        stretches++;
        run = last;
    }
    return merge->list ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int write_all(struct merger *m, const char *path, struct merge *merge)
{
    struct header header = m->part[0].header;
    struct output output;
    header.shard = header.shards = 1;
    char *first = header_text(&header);
    int status = first ? output_open(&output, path) : ROTID_ERROR_MEMORY;
    if (status) {
        json_free(first);
        return status;
    }
    int failed = fputs(first, output.stream) < 0;
    json_free(first);
    for (long run = 0; run < header.runs && !failed && !status; run++) {
        if (m->source[run] < 0)
            continue;
        status = fetch(m, &m->part[m->source[run]], run, m->text[0]);
        if (status)
            continue;
        merge->failed += result_failed(m->text[0]);
        failed = fputs(m->text[0], output.stream) < 0;
    }
    return output_close(&output, failed && !status ? ROTID_ERROR_IO : status);
}

int merge_results(struct pool *pool, int count, char *const *path, const char *to, struct message_list *messages,
                  struct merge *merge)
{
    struct merger m = {.pool = pool, .messages = messages, .part = POOL_ARRAY(pool, struct part, count)};
    int status = m.part ? ROTID_OK : ROTID_ERROR_MEMORY;
    *merge = (struct merge){0};
    if (!status && access(to, F_OK) == 0) {
        message_add(messages, SEVERITY_ERROR, to, 1, 1, "exists, expected the name of a new file for all parts together");
        return ROTID_ERROR_ARGUMENT;
    }
    for (; m.count < count && !status; m.count++) {
        status = open_part(&m, path[m.count], &m.part[m.count]);
        if (!status)
            status = compare(&m, &m.part[0], &m.part[m.count]);
    }
    if (!status)
        status = choose(&m);
    if (!status)
        status = list_missing(&m, merge);
    if (!status) {
        merge->runs = m.part[0].header.runs;
        status = write_all(&m, to, merge);
        if (status == ROTID_ERROR_IO && !messages->errors)
            message_add(messages, SEVERITY_ERROR, to, 1, 1, "cannot be written: %s", output_error());
    }
    for (int p = 0; p < m.count; p++)
        if (m.part[p].descriptor >= 0)
            (void)close(m.part[p].descriptor);
    return status;
}
