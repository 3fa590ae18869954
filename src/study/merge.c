/* Shards, or other parts of one study, into one file: of each run the line of the first part in which it did not fail. */
#include "study/study.h"

#include <errno.h>
#include <unistd.h>

#define MOST_LISTED 20 /* stretches of missing runs that are named */

/* Length of a line without its time, which stands last. */
static size_t timeless(const char *line)
{
    static const char key[] = ",\"seconds\":";
    const char *at = NULL;
    for (const char *next = strstr(line, key); next; next = strstr(next + 1, key))
        at = next;
    return at ? (size_t)(at - line) : strlen(line);
}

/* Whether two lines of a run say the same. ROTID_OK, 1 where they do not, ROTID_ERROR_IO with errno. */
static int compare(struct result_place one, struct result_place other)
{
    struct pool pool;
    pool_open(&pool, NULL);
    const char *a = results_fetch(&pool, one), *b = a ? results_fetch(&pool, other) : NULL;
    int status = b ? timeless(a) != timeless(b) || memcmp(a, b, timeless(a)) != 0 : ROTID_ERROR_IO;
    pool_close(&pool);
    return status;
}

/* Takes the lines of a part into the first one. part: those before it as well. */
static int join(struct pool *pool, struct results *part, int p, struct message_list *messages)
{
    struct results *all = &part[0], *add = &part[p];
    const char *difference = header_difference(pool, &add->header, &all->header, 0);
    int status = difference ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (difference && *difference)
        return message_refuse(messages, ROTID_ERROR_ARGUMENT, add->path, 1, 1, "this file is not of the same study as %s: %s",
                              all->path, difference);
    for (long run = 0; !status && run < all->header.runs; run++) {
        struct result_place *one = &all->place[run], *other = &add->place[run];
        if (!other->length || (one->length && other->failed))
            continue;
        if (one->length && !one->failed)
            status = compare(*one, *other);
        else
            *one = *other;
        int from = 0; /* the part that the line taken is of */
        while (status > 0 && fileno(part[from].stream) != one->descriptor)
            from++;
        if (status == ROTID_ERROR_IO)
            return message_refuse(messages, status, add->path, 1, 1, "reading failed: %s", strerror(errno));
        if (status > 0)
            return message_refuse(messages, ROTID_ERROR_ARGUMENT, add->path, 1, 1,
                                  "run %ld has another result in %s, expected the same: were both computed by one program on "
                                  "machines of one kind?",
                                  run, part[from].path);
    }
    return status;
}

/* "3, 7-9", and how many there are; those that failed. */
static int count(struct pool *pool, const struct results *all, struct merge *merge)
{
    int stretches = 0;
    *merge = (struct merge){.runs = all->header.runs, .list = ""};
    for (long run = 0, last; run < merge->runs && merge->list; run = last + 1) {
        last = run;
        merge->failed += all->place[run].failed;
        if (all->place[run].length)
            continue;
        while (last + 1 < merge->runs && !all->place[last + 1].length)
            last++;
        merge->missing += last - run + 1;
        if (stretches < MOST_LISTED)
            merge->list = last > run ? pool_format(pool, "%s%s%ld-%ld", merge->list, stretches ? ", " : "", run, last)
                                     : pool_format(pool, "%s%s%ld", merge->list, stretches ? ", " : "", run);
        else if (stretches == MOST_LISTED)
            merge->list = pool_format(pool, "%s, ...", merge->list);
        stretches++;
    }
    return merge->list ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int merge_results(struct pool *pool, int nparts, char *const *path, const char *to, struct message_list *messages,
                  struct merge *merge)
{
    struct results *part = POOL_ARRAY(pool, struct results, nparts);
    int status = part ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (!status && access(to, F_OK) == 0)
        return message_refuse(messages, ROTID_ERROR_ARGUMENT, to, 1, 1,
                              "exists, expected the name of a new file for all parts together");
    for (int p = 0; p < nparts && !status; p++) {
        status = results_open(pool, path[p], messages, &part[p]);
        if (!status && p)
            status = join(pool, part, p, messages);
    }
    if (!status)
        status = count(pool, &part[0], merge);
    if (!status) {
        part[0].header.shard = NULL;
        status = results_write(to, &part[0]);
        if (status == ROTID_ERROR_IO)
            message_add(messages, SEVERITY_ERROR, to, 1, 1, "cannot be written: %s", output_error());
    }
    for (int p = 0; part && p < nparts; p++)
        results_close(&part[p]);
    return status;
}
