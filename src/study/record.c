/* realpath: it is in POSIX 2008, but the headers of glibc want this word for it. NOLINTNEXTLINE(bugprone-reserved-identifier) */
#define _XOPEN_SOURCE 700

#include "study/study.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/base.h"
#include "report/report.h"
#include "result/result.h"

#define SYNC_SECONDS 1.0

/* 0, or the process that holds it; -1 where this file cannot be locked (errno). */
static long lock(int descriptor)
{
    struct flock wanted = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(descriptor, F_SETLK, &wanted) == 0)
        return 0;
    if (errno != EACCES && errno != EAGAIN)
        return -1;
    if (fcntl(descriptor, F_GETLK, &wanted) || wanted.l_type == F_UNLCK || wanted.l_pid < 1)
        return 1;
    return wanted.l_pid;
}

/* The file by that name, open and locked. It may have been replaced between the two. */
static int open_locked(const char *path, struct message_list *messages, int *descriptor)
{
    for (;;) {
        struct stat open_one, named;
        *descriptor = open(path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, 0666);
        if (*descriptor < 0)
            return message_refuse(messages, ROTID_ERROR_IO, path, 1, 1, "cannot be opened: %s", strerror(errno));
        int status = ROTID_OK;
        if (fstat(*descriptor, &open_one) || !S_ISREG(open_one.st_mode))
            status = message_refuse(messages, ROTID_ERROR_ARGUMENT, path, 1, 1,
                                    "this is no file that lines can be added to, expected a regular one");
        long holder = status ? 0 : lock(*descriptor);
        if (holder > 0) {
            status = message_refuse(messages, ROTID_ERROR_ARGUMENT, path, 1, 1,
                                    "is being written by process %ld, expected another file or its end", holder);
        } else if (holder < 0) {
            message_add(messages, SEVERITY_WARNING, path, 1, 1,
                        "cannot be locked here (%s): see to it that no second study writes to it", strerror(errno));
        }
        int same = !status && !stat(path, &named) && named.st_dev == open_one.st_dev && named.st_ino == open_one.st_ino;
        if (!status && same)
            return ROTID_OK;
        (void)close(*descriptor);
        if (status)
            return status;
    }
}

/* The name of a new file, and the header of it, are on the disk before the first run is. */
static void sync_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strdup(path) : NULL;
    if (folder)
        folder[slash == path ? 1 : slash - path] = 0;
    int descriptor = slash && !folder ? -1 : open(folder ? folder : ".", O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0) {
        (void)fsync(descriptor); /* some file systems cannot: then it is there when they think so */
        (void)close(descriptor);
    }
    free(folder);
}

/* Whether all there is of the file is the beginning of its header: it was ended while it was begun. */
static int is_unbegun(int descriptor, off_t size, const char *header)
{
    char *begun = (size_t)size < strlen(header) ? malloc((size_t)size + 1) : NULL;
    int same = begun && pread(descriptor, begun, (size_t)size, 0) == (ssize_t)size && !memcmp(begun, header, (size_t)size);
    free(begun);
    return same;
}

/* Appends count bytes with one write where the system lets them through; the file is as it was where they do not fit. */
static int append(struct study_record *record, const char *bytes, size_t count)
{
    size_t written = 0;
    while (written < count) {
        ssize_t got = write(record->descriptor, bytes + written, count - written);
        if (got > 0)
            written += (size_t)got;
        if (got == 0)
            errno = ENOSPC;
        if (got <= 0 && errno != EINTR) {
            int reason = errno;
            while (ftruncate(record->descriptor, record->length) && errno == EINTR)
                ;
            errno = reason;
            return ROTID_ERROR_IO;
        }
    }
    record->length += (off_t)count;
    record->unsynced = 1;
    return ROTID_OK;
}

static int begin_file(struct study_record *record, const char *header, struct message_list *messages)
{
    if (ftruncate(record->descriptor, 0) || append(record, header, strlen(header)) || fsync(record->descriptor))
        return message_refuse(messages, ROTID_ERROR_IO, record->path, 1, 1, "cannot be written: %s", strerror(errno));
    sync_folder(record->path);
    return ROTID_OK;
}

static int compare(struct pool *pool, struct study_record *record, const struct results *file, struct message_list *messages)
{
    const char *difference;
    int status = header_difference(pool, &file->header, &record->header, record->input != NULL, &difference);
    if (status)
        return status;
    if (difference)
        message_add(messages, SEVERITY_ERROR, record->path, 1, 1,
                    "this file is of another study: %s; expected a new name, or things as they were", difference);
    else if (file->shard != record->shard || file->shards != record->shards)
        message_add(messages, SEVERITY_ERROR, record->path, 1, 1,
                    "this file is of shard %d/%d and not of %d/%d, expected a file for each shard", file->shard, file->shards,
                    record->shard, record->shards);
    else
        return ROTID_OK;
    return ROTID_ERROR_ARGUMENT;
}

/* A last line that was cut goes. */
static int cut(struct study_record *record, const struct results *file, struct message_list *messages)
{
    record->length = file->end;
    if (file->size <= file->end)
        return ROTID_OK;
    if (ftruncate(record->descriptor, file->end))
        return message_refuse(messages, ROTID_ERROR_IO, record->path, file->lines + 1, 1, "the cut line cannot be removed: %s",
                              strerror(errno));
    message_add(messages, SEVERITY_NOTE, record->path, file->lines + 1, 1, "a line that was cut has been removed");
    return ROTID_OK;
}

/* Which runs are there. */
static int read_lines(struct pool *pool, struct study_record *record, int retry_failed, struct message_list *messages)
{
    struct results file;
    long changed = 0;
    int status = results_read(pool, record->descriptor, record->path, messages, &file);
    if (!status)
        status = compare(pool, record, &file, messages);
    if (!status)
        status = cut(record, &file, messages);
    record->in_order = file.in_order;
    record->last = file.last;
    for (long run = 0; run < record->header.runs && !status; run++) {
        const struct result_place *at = &file.place[run];
        int other = record->input && at->input && at->input != digest_name(record->input[run]), /* deck of another time */
            again = at->failed && retry_failed;
        changed += other;
        record->state[run] = !at->length || other || again ? RUN_MISSING : at->failed ? RUN_FAILED : RUN_DONE;
        record->done += record->state[run] != RUN_MISSING;
        record->failed += record->state[run] == RUN_FAILED;
    }
    if (changed)
        message_add(messages, SEVERITY_WARNING, record->path, 1, 1,
                    "lines of decks that have changed since: %ld; their runs are computed again", changed);
    return status == ROTID_ERROR_SYNTAX ? ROTID_ERROR_ARGUMENT : status;
}

int record_open(struct pool *pool, const char *path, const struct study_header *header, const char *const *input,
                int retry_failed, struct message_list *messages, struct study_record *record)
{
    struct stat information;
    char *first = header_text(header);
    *record = (struct study_record){
        .descriptor = -1, .header = *header, .input = input, .last = -1, .in_order = 1, .synced = clock_seconds()};
    (void)header_shard(header, &record->shard, &record->shards);
    record->wanted = (header->runs + record->shards - record->shard) / record->shards;
    record->next = record->shard - 1;
    record->state = POOL_ARRAY(pool, char, header->runs);
    stamp_study(header, record->study);
    int status = first && record->state ? open_locked(path, messages, &record->descriptor) : ROTID_ERROR_MEMORY;
    if (status) {
        json_free(first);
        return status;
    }
    record->path = realpath(path, NULL);
    if (!record->path)
        status = ROTID_ERROR_MEMORY;
    else if (fstat(record->descriptor, &information))
        status = message_refuse(messages, ROTID_ERROR_IO, path, 1, 1, "%s", strerror(errno));
    else if (!information.st_size || is_unbegun(record->descriptor, information.st_size, first))
        status = begin_file(record, first, messages);
    else
        status = read_lines(pool, record, retry_failed, messages);
    json_free(first);
    if (status)
        record_close(record);
    return status;
}

long record_take(struct study_record *record)
{
    for (; record->next < record->header.runs; record->next += record->shards)
        if (record->state[record->next] == RUN_MISSING) {
            long run = record->next;
            record->next += record->shards;
            return run;
        }
    return -1;
}

int record_append(struct study_record *record, long run, const char *line, int failed)
{
    char *stamped = stamp_line(record->study, line);
    int status = stamped ? append(record, stamped, strlen(stamped)) : ROTID_ERROR_MEMORY;
    free(stamped);
    if (status)
        return status;
    record->in_order &= run > record->last;
    record->last = run;
    record->state[run] = failed ? RUN_FAILED : RUN_DONE;
    record->done++;
    record->failed += failed;
    return ROTID_OK;
}

int record_sync(struct study_record *record, double now)
{
    if (!record->unsynced || now - record->synced < SYNC_SECONDS)
        return ROTID_OK;
    if (fdatasync(record->descriptor))
        return ROTID_ERROR_IO;
    record->unsynced = 0;
    record->synced = clock_seconds();
    return ROTID_OK;
}

int record_finish(struct pool *pool, struct study_record *record)
{
    if (record->in_order)
        return record_sync(record, INFINITY);
    struct message_list unheard; /* it has been read before */
    struct results file;
    message_open(&unheard, pool);
    int status = results_read(pool, record->descriptor, record->path, &unheard, &file);
    return status ? status : results_write(record->path, &record->header, file.place, file.most);
}

void record_close(struct study_record *record)
{
    if (record->descriptor >= 0)
        (void)close(record->descriptor);
    free(record->path);
    record->descriptor = -1;
    record->path = NULL;
}
