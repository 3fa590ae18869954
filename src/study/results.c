/* A file of results: the header, which tells the study; the stamp at the end of each line, which tells a line that was changed or
 * belongs elsewhere; reading line by line; the file as a whole, in order of the runs; the file while it grows. */
/* realpath: it is in POSIX 2008, but the headers of glibc want this word for it. NOLINTNEXTLINE(bugprone-reserved-identifier) */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/study.h"

#define BLOCK     ((size_t)1 << 18)
#define MOST_LINE ((size_t)1 << 26) /* a line is a few thousand bytes; beyond this it is something else */

/* ---- digests */

/* FNV-1a (Fowler, Noll, Vo) */
#define BASIS 0xcbf29ce484222325u
#define PRIME 0x100000001b3u

static void digest_bytes(struct digest *digest, size_t count, const void *bytes)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < count; i++)
        digest->state = (digest->state ^ byte[i]) * PRIME;
}

void digest_open(struct digest *digest)
{
    digest->state = BASIS;
}

void digest_integer(struct digest *digest, long long value)
{
    unsigned char byte[8]; /* by value: the same on every machine */
    for (int i = 0; i < 8; i++)
        byte[i] = (unsigned char)((unsigned long long)value >> (8 * i));
    digest_bytes(digest, sizeof byte, byte);
}

void digest_text(struct digest *digest, const char *text)
{
    digest_integer(digest, text ? (long long)strlen(text) : -1);
    digest_bytes(digest, text ? strlen(text) : 0, text);
}

void digest_letters(const struct digest *digest, char letters[DIGEST_LETTERS + 1])
{
    (void)snprintf(letters, DIGEST_LETTERS + 1, "%016llx", (unsigned long long)digest->state);
}

uint64_t digest_name(const char *name)
{
    struct digest digest;
    digest_open(&digest);
    digest_text(&digest, name);
    return digest.state;
}

/* ---- the header */

struct study_header header_of(struct pool *pool, const struct study *study, const char *version, const char *commit, int shard,
                              int shards)
{
    return (struct study_header){.schema = RESULT_SCHEMA,
                                 .rotid = version,
                                 .commit = commit,
                                 .command = "study",
                                 .plan = study->plan->path,
                                 .studies = plan_commands[study->plan->command],
                                 .digest = {study->plan_digest, study->decks_digest, study->data_digest, study->options_digest},
                                 .seed = (double)study->seed,
                                 .runs = (int)study->runs,
                                 .shard = shards > 1 ? pool_format(pool, "%d/%d", shard, shards) : NULL};
}

/* The shard that the file is of: runs with run % shards == shard - 1; 1 of 1: all. 0 where its text is none. */
static int header_shard(const struct study_header *header, int *shard, int *shards)
{
    int end = 0;
    *shard = *shards = 1;
    return !header->shard || (sscanf(header->shard, "%9d/%9d%n", shard, shards, &end) == 2 && !header->shard[end] &&
                              *shard >= 1 && *shard <= *shards);
}

char *header_text(const struct study_header *header)
{
    struct json_tree tree;
    json_open(&tree);
    record_write(&tree, tree.root, &study_header_record, header);
    return json_close_line(&tree);
}

int results_header_read(struct pool *pool, const cJSON *object, struct study_header *header)
{
    struct message_list unheard; /* the caller says what was expected */
    struct reader reader = {.pool = pool, .messages = &unheard, .file = ""};
    const struct json_place place = {.reader = &reader, .json = object};
    int shard, shards;
    message_open(&unheard, pool);
    *header = (struct study_header){0};
    if (!cJSON_IsObject(object))
        return ROTID_ERROR_SYNTAX;
    record_read(&place, &study_header_record, header);
    if (reader.status)
        return reader.status;
    const char *const needed[] = {header->rotid,        header->studies,     header->digest.plan,
                                  header->digest.decks, header->digest.data, header->digest.options};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (!*needed[i]) /* null */
            return ROTID_ERROR_SYNTAX;
    int good = header->schema == RESULT_SCHEMA && !strcmp(header->command, "study") && header->seed <= 4294967295.0 &&
               header->runs <= STUDY_MOST_RUNS && header_shard(header, &shard, &shards);
    return good ? ROTID_OK : ROTID_ERROR_SYNTAX;
}

int header_difference(struct pool *pool, const struct study_header *file, const struct study_header *here, int other_decks,
                      const char **text)
{
    const char *changed = "";
    const struct {
        const char *file, *here, *what;
    } parts[] = {{file->digest.plan, here->digest.plan, "the plan"},
                 {file->digest.decks, here->digest.decks, "a deck"},
                 {file->digest.data, here->digest.data, "the measured data"},
                 {file->digest.options, here->digest.options, "--set"}};
    int other_options = strcmp(file->digest.options, here->digest.options) != 0; /* they may change the data as well */
    *text = NULL;
    for (int i = 0; i < 4 && changed; i++)
        if (strcmp(parts[i].file, parts[i].here) != 0 && !(other_decks && (i == 1 || i == 2)) && !(other_options && i == 2))
            changed = pool_format(pool, "%s%s%s", changed, *changed ? " and " : "", parts[i].what);
    if (!changed)
        return ROTID_ERROR_MEMORY;
    if (strcmp(file->rotid, here->rotid) != 0 || strcmp(file->commit, here->commit) != 0)
        *text = pool_format(pool, "it was begun by rotid %s (%s), this is %s (%s)", file->rotid, file->commit, here->rotid,
                            here->commit);
    else if (file->seed != here->seed)
        *text = pool_format(pool, "its seed is %.0f, not %.0f", file->seed, here->seed);
    else if (*changed)
        *text = pool_format(pool, "%s %s changed since it was begun", changed, strstr(changed, " and ") ? "have" : "has");
    else if (file->runs != here->runs || strcmp(file->studies, here->studies) != 0)
        *text = pool_format(pool, "it has %d runs of %s, not %d of %s", file->runs, file->studies, here->runs, here->studies);
    else
        return ROTID_OK;
    return *text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* ---- stamps */

/* ..., "study": "0123456789abcdef", "digest": "0123456789abcdef"}: the digest is of all bytes before its comma but the quote */
#define STUDY  ",\"study\":\""
#define DIGEST "\",\"digest\":\""
#define END    "\"}\n"
#define LENGTH (sizeof STUDY + sizeof DIGEST + sizeof END - 3 + 2 * (size_t)DIGEST_LETTERS)

void stamp_study(const struct study_header *header, char study[DIGEST_LETTERS + 1])
{
    struct digest digest;
    digest_open(&digest);
    digest_text(&digest, header->rotid);
    digest_text(&digest, header->commit);
    digest_text(&digest, header->studies);
    digest_text(&digest, header->digest.plan);
    if (header->plan) {
        digest_text(&digest, header->digest.decks);
        digest_text(&digest, header->digest.data);
    }
    digest_text(&digest, header->digest.options);
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

enum stamp_fault { STAMP_GOOD, STAMP_NONE, STAMP_CHANGED, STAMP_OTHER_STUDY };

/* line [length] with its line feed */
static enum stamp_fault stamp_check(const char study[DIGEST_LETTERS + 1], const char *line, size_t length)
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

/* ---- reading */

/* The file from its beginning, a line in memory at a time. */
struct reading {
    int descriptor; /* the caller's: where it stands does not matter */
    const char *path;
    struct message_list *messages;
    int number;       /* of the line read last, from 1 */
    off_t next;       /* where the next line begins; at the end: where the last whole one ends */
    struct pool line; /* of the line read last */
    char *buffer;
    size_t capacity, first, count; /* bytes of the buffer not yet given out */
};

static int cannot_read(struct reading *r)
{
    return message_refuse(r->messages, ROTID_ERROR_IO, r->path, r->number + 1, 1, "reading failed: %s", strerror(errno));
}

static int malformed(struct reading *r, int line, const char *what)
{
    return message_refuse(r->messages, ROTID_ERROR_SYNTAX, r->path, line, 1, "%s", what);
}

/* More of the file behind what the buffer holds. ROTID_OK, 1 at the end. */
static int fill(struct reading *r)
{
    if (r->first && r->buffer) {
        memmove(r->buffer, r->buffer + r->first, r->count);
        r->first = 0;
    }
    if (r->count + BLOCK > r->capacity) {
        size_t capacity = 2 * r->capacity + BLOCK;
        char *larger = r->count < MOST_LINE ? realloc(r->buffer, capacity) : NULL;
        if (!larger)
            return r->count < MOST_LINE ? ROTID_ERROR_MEMORY : malformed(r, r->number + 1, "the line is too long for a result");
        r->buffer = larger;
        r->capacity = capacity;
    }
    ssize_t got;
    do
        got = pread(r->descriptor, r->buffer + r->count, BLOCK, r->next + (off_t)r->count);
    while (got < 0 && errno == EINTR);
    if (got < 0)
        return cannot_read(r);
    r->count += (size_t)got;
    return got ? ROTID_OK : 1;
}

/* A whole line, with its line feed. ROTID_OK, 1 where there is none any more. */
static int take_line(struct reading *r, const char **text, size_t *length)
{
    size_t looked = 0;
    for (;;) {
        const char *from = r->buffer ? r->buffer + r->first : NULL,
                   *feed = from ? memchr(from + looked, '\n', r->count - looked) : NULL;
        if (feed) {
            *text = from;
            *length = (size_t)(feed - from) + 1;
            r->first += *length;
            r->count -= *length;
            r->next += (off_t)*length;
            r->number++;
            return ROTID_OK;
        }
        looked = r->count;
        int status = fill(r);
        if (status)
            return status;
    }
}

/* The first line. ROTID_OK; ROTID_ERROR_SYNTAX where the file is something else. */
static int read_header(struct reading *r, struct pool *pool, struct results *results)
{
    static const char expected[] = "this is no file of results of rotid study, expected one or a new name";
    struct stat information;
    const char *text;
    size_t length;
    if (fstat(r->descriptor, &information))
        return cannot_read(r);
    results->size = information.st_size;
    if (!S_ISREG(information.st_mode) || (results->size && pread(r->descriptor, &(char){0}, 1, 0) != 1))
        return malformed(r, 1, expected);
    int status = take_line(r, &text, &length);
    if (status)
        return status > 0 ? malformed(r, 1, expected) : status;
    cJSON *json = NULL;
    status = json_text_too_dense(text, length) ? ROTID_ERROR_SYNTAX : json_parse(text, length, NULL, &json);
    if (!status)
        status = results_header_read(pool, json, &results->header);
    cJSON_Delete(json);
    if (status)
        return status == ROTID_ERROR_SYNTAX ? malformed(r, 1, expected) : status;
    (void)header_shard(&results->header, &results->shard, &results->shards);
    results->place = POOL_ARRAY(pool, struct result_place, results->header.runs);
    return results->place ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Nonzero after a message. */
static int refuse_stamp(struct reading *r, const char *study, const char *text, size_t length)
{
    static const char *const texts[] = {
        [STAMP_NONE] =
            "this line does not end in its digest, expected a line of rotid study: without this one the run is computed "
            "again; a file of an early version has no digests at all and cannot be checked",
        [STAMP_CHANGED] =
            "this line is not as rotid wrote it, its digest differs, expected the line as it was: without it the run "
            "is computed again",
        [STAMP_OTHER_STUDY] =
            "this line is of another study than the first line of the file, expected lines of that one: without "
            "it the run is computed again",
    };
    enum stamp_fault fault = stamp_check(study, text, length);
    if (fault)
        (void)malformed(r, r->number, texts[fault]);
    return fault != STAMP_GOOD;
}

const char *results_line_read(struct pool *pool, const char *text, size_t length, struct study_run *run)
{
    struct message_list messages;
    struct reader reader = {.pool = pool, .messages = &messages, .file = "this line is no result"};
    cJSON *json = NULL;
    int status = json_text_too_dense(text, length) ? ROTID_ERROR_SYNTAX : json_parse(text, length, NULL, &json);
    const struct json_place place = {.reader = &reader, .json = json};
    message_open(&messages, pool);
    *run = (struct study_run){.status = -1};
    if (status == ROTID_ERROR_MEMORY)
        return "";
    if (!cJSON_IsObject(json))
        place_wrong(&place, "it is no JSON, expected an object");
    else
        record_read(&place, &study_run_record, run);
    if (!reader.status && run->status != STUDY_FAILED && !run->fit)
        place_wrong(&place, "it has no functional, expected the result of a run that did not fail");
    if (!reader.status && run->diagnosis && run->diagnosis->verdict.kind < 0)
        place_wrong(&place, "it has no verdict, expected that of a diagnosis that came to its end");
    cJSON_Delete(json);
    return !reader.status ? NULL : messages.count ? messages.item[0].text : "";
}

/* ROTID_OK with the next line, 1 behind the last whole one, ROTID_ERROR_SYNTAX where a line was changed, is of another study or
 * of a run that stands there already, unless that had failed or its deck was mended in between: which of the two counts, or what
 * the line said, nobody knows here. */
static int read_run(struct reading *r, const char *study, struct results *results)
{
    const char *text, *wrong;
    struct study_run said;
    struct result_place at = {.descriptor = r->descriptor, .offset = r->next};
    pool_close(&r->line);
    pool_open(&r->line, NULL);
    int status = take_line(r, &text, &at.length);
    if (status)
        return status;
    if (refuse_stamp(r, study, text, at.length))
        return ROTID_ERROR_SYNTAX;
    if ((wrong = results_line_read(&r->line, text, at.length, &said)))
        return *wrong ? malformed(r, r->number, wrong) : ROTID_ERROR_MEMORY;
    if (said.run >= results->header.runs || said.run % results->shards != results->shard - 1)
        return malformed(r, r->number,
                         "this line is of a run that the study, or this shard of it, does not have, expected one of its runs");
    struct result_place *place = &results->place[said.run];
    at.failed = said.status == STUDY_FAILED;
    at.input = said.input ? digest_name(said.input) : 0;
    if (place->length && !place->failed && place->input == at.input)
        return message_refuse(r->messages, ROTID_ERROR_SYNTAX, r->path, r->number, 1,
                              "run %d stands in a line above already, expected one line of each run that did not fail", said.run);
    *place = at;
    results->most = at.length > results->most ? at.length : results->most;
    results->in_order &= said.run > results->last;
    results->last = said.run;
    return ROTID_OK;
}

int results_read(struct pool *pool, int descriptor, const char *path, struct message_list *messages, struct results *results)
{
    struct reading r = {.descriptor = descriptor, .path = path, .messages = messages};
    char study[DIGEST_LETTERS + 1];
    *results = (struct results){.last = -1, .in_order = 1};
    pool_open(&r.line, NULL);
    int status = read_header(&r, pool, results);
    if (!status)
        stamp_study(&results->header, study);
    while (!status)
        status = read_run(&r, study, results);
    results->end = r.next;
    results->lines = r.number;
    pool_close(&r.line);
    free(r.buffer);
    return status == 1 ? ROTID_OK : status;
}

int result_failed(const char *line)
{
    struct pool pool;
    struct study_run run;
    pool_open(&pool, NULL);
    int failed = !results_line_read(&pool, line, strlen(line), &run) && run.status == STUDY_FAILED;
    pool_close(&pool);
    return failed;
}

int results_fetch(struct result_place place, char *text)
{
    size_t have = 0;
    while (have < place.length) {
        ssize_t got = pread(place.descriptor, text + have, place.length - have, place.offset + (off_t)have);
        if (got == 0)
            errno = EIO; /* it was longer when it was looked at */
        if (got == 0 || (got < 0 && errno != EINTR))
            return ROTID_ERROR_IO;
        have += got > 0 ? (size_t)got : 0;
    }
    return ROTID_OK;
}

int results_write(const char *path, const struct study_header *header, const struct result_place *place, size_t most)
{
    char *first = header_text(header), *text = malloc(most + 1);
    struct output output;
    int status = first && text ? output_open(&output, path) : ROTID_ERROR_MEMORY;
    if (!status) {
        int failed = fputs(first, output.stream) < 0;
        for (long run = 0; run < header->runs && !failed; run++)
            failed = results_fetch(place[run], text) || fwrite(text, 1, place[run].length, output.stream) != place[run].length;
        status = output_close(&output, failed ? ROTID_ERROR_IO : ROTID_OK);
    }
    int reason = errno;
    json_free(first);
    free(text);
    errno = reason;
    return status;
}

/* ---- the file while a study writes it */

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
