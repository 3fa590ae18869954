/* A file of results: the header, which tells the study; the stamp at the end of each line, which tells a line that was changed or
 * belongs elsewhere; reading, a line at a time, which keeps where the line of each run stands; writing in order of the runs; the
 * file while it grows, which is the same table of places with a lock. */
/* realpath: it is in POSIX 2008, but the headers of glibc want this word for it. NOLINTNEXTLINE(bugprone-reserved-identifier) */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <sys/stat.h>
#include <unistd.h>

#include "file/file.h"
#include "study/study.h"

#define BLOCK     ((size_t)1 << 18)
#define MOST_LINE ((ssize_t)1 << 26) /* a line is a few thousand bytes; beyond this it is something else */

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
                                 .digest = study->digest,
                                 .seed = (double)study->seed,
                                 .runs = (int)study->runs,
                                 .shard = shards > 1 ? pool_format(pool, "%d/%d", shard, shards) : NULL};
}

int shard_parse(const char *text, int *shard, int *shards)
{
    int end = 0;
    *shard = *shards = 1;
    return !text || (sscanf(text, "%9d/%9d%n", shard, shards, &end) == 2 && !text[end] && *shard >= 1 && *shard <= *shards);
}

char *header_text(const struct study_header *header)
{
    return record_text(&study_header_record, header, 0);
}

const char *header_difference(struct pool *pool, const struct study_header *file, const struct study_header *here,
                              int other_decks)
{
    const char *changed = "";
    const struct {
        const char *file, *here, *what;
    } parts[] = {{file->digest.plan, here->digest.plan, "the plan"},
                 {file->digest.decks, here->digest.decks, "a deck"},
                 {file->digest.data, here->digest.data, "the measured data or a table"},
                 {file->digest.options, here->digest.options, "--set"}};
    int other_options = strcmp(file->digest.options, here->digest.options) != 0; /* they may change the data as well */
    for (int i = 0; i < 4 && changed; i++)
        if (strcmp(parts[i].file, parts[i].here) != 0 && !(other_decks && (i == 1 || i == 2)) && !(other_options && i == 2))
            changed = pool_format(pool, "%s%s%s", changed, *changed ? " and " : "", parts[i].what);
    if (strcmp(file->rotid, here->rotid) != 0 || strcmp(file->commit, here->commit) != 0)
        return pool_format(pool, "it was begun by rotid %s (%s), this is %s (%s)", file->rotid, file->commit, here->rotid,
                           here->commit);
    if (file->seed != here->seed)
        return pool_format(pool, "its seed is %.0f, not %.0f", file->seed, here->seed);
    if (changed && *changed)
        return pool_format(pool, "%s %s changed since it was begun", changed, strstr(changed, " and ") ? "have" : "has");
    if (changed && (file->runs != here->runs || strcmp(file->studies, here->studies) != 0))
        return pool_format(pool, "it has %d runs of %s, not %d of %s", file->runs, file->studies, here->runs, here->studies);
    return changed;
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
    (void)snprintf(study, DIGEST_LETTERS + 1, "%016llx", (unsigned long long)digest.state);
}

/* The stamp [LENGTH + 1] of a line whose values end behind `body` bytes. */
static void make_stamp(const char *study, const char *line, size_t body, char *stamp)
{
    struct digest digest;
    int length = snprintf(stamp, LENGTH + 1, STUDY "%s", study);
    digest_open(&digest);
    digest_bytes(&digest, body, line);
    digest_bytes(&digest, (size_t)length, stamp);
    (void)snprintf(stamp + length, LENGTH + 1 - (size_t)length, DIGEST "%016llx" END, (unsigned long long)digest.state);
}

char *stamp_line(const char study[DIGEST_LETTERS + 1], const char *line)
{
    size_t body = strlen(line) - strlen("}\n");
    char *stamped = malloc(body + LENGTH + 1);
    if (!stamped)
        return NULL;
    memcpy(stamped, line, body);
    make_stamp(study, line, body, stamped + body);
    return stamped;
}

/* What is wrong with the stamp of a line [length] with its line feed, or NULL: it has none, that of the study it names is not the
 * one of its bytes, or that study is another one. */
static const char *stamp_fault(const char *study, const char *line, size_t length)
{
    char stamp[LENGTH + 1], own[DIGEST_LETTERS + 1];
    const char *is = length < LENGTH ? line : line + length - LENGTH;
    if (length < LENGTH || memcmp(is, STUDY, strlen(STUDY)) != 0 ||
        memcmp(is + strlen(STUDY) + DIGEST_LETTERS, DIGEST, strlen(DIGEST)) != 0 ||
        memcmp(line + length - strlen(END), END, strlen(END)) != 0)
        return "this line does not end in its digest, expected a line of rotid study: without this one the run is computed "
               "again; a file of an early version has no digests at all and cannot be checked";
    (void)snprintf(own, sizeof own, "%s", is + strlen(STUDY));
    make_stamp(own, line, length - LENGTH, stamp);
    if (memcmp(is, stamp, LENGTH) != 0)
        return "this line is not as rotid wrote it, its digest differs, expected the line as it was: without it the run is "
               "computed again";
    return strcmp(own, study) != 0 ? "this line is of another study than the first line of the file, expected lines of that one: "
                                     "without it the run is computed again"
                                   : NULL;
}

/* ---- reading */

/* A line as the struct of its record, on the pool. NULL, or the first mistake in it; "" where memory is out. */
static const char *parse(struct pool *pool, const char *text, size_t length, const struct record *record, void *into)
{
    struct message_list messages;
    struct reader reader = {.pool = pool, .messages = &messages, .file = "this line is no result"};
    cJSON *json = NULL;
    int status = json_text_too_dense(text, length) ? ROTID_ERROR_SYNTAX : json_parse(text, length, NULL, &json);
    const struct json_place place = {.reader = &reader, .json = json};
    message_open(&messages, pool);
    if (cJSON_IsObject(json))
        record_read(&place, record, NULL, into);
    else if (status != ROTID_ERROR_MEMORY)
        place_wrong(&place, "it is no JSON, expected an object");
    cJSON_Delete(json);
    return !reader.status && status != ROTID_ERROR_MEMORY ? NULL : messages.count ? messages.item[0].text : "";
}

int results_header_read(struct pool *pool, const char *text, size_t length, struct study_header *header)
{
    int shard, shards;
    *header = (struct study_header){0};
    const char *wrong = parse(pool, text, length, &study_header_record, header);
    if (wrong && !*wrong)
        return ROTID_ERROR_MEMORY;
    return !wrong && header->schema == RESULT_SCHEMA && !strcmp(header->command, "study") && header->seed <= 4294967295.0 &&
                   header->runs <= STUDY_MOST_RUNS && shard_parse(header->shard, &shard, &shards)
               ? ROTID_OK
               : ROTID_ERROR_SYNTAX;
}

const char *results_line_read(struct pool *pool, const char *text, size_t length, struct study_run *run)
{
    *run = (struct study_run){.status = -1};
    const char *wrong = parse(pool, text, length, &study_run_record, run);
    if (!wrong && run->status != STUDY_FAILED && !run->fit)
        return "this line is no result: it has no functional, expected the result of a run that did not fail";
    if (!wrong && run->diagnosis && run->diagnosis->verdict.kind < 0)
        return "this line is no result: it has no verdict, expected that of a diagnosis that came to its end";
    return wrong;
}

/* The file from its beginning, a line in memory at a time. */
struct reading {
    struct results *file; /* file->end: where the next line begins */
    struct message_list *messages;
    char *text; /* [length] of the line read last, with its line feed */
    size_t length, room;
};

static int refuse_line(struct reading *r, const char *wrong)
{
    int line = r->file->lines > 0 ? r->file->lines : 1;
    return *wrong ? message_refuse(r->messages, ROTID_ERROR_SYNTAX, r->file->path, line, 1, "%s", wrong) : ROTID_ERROR_MEMORY;
}

/* The next whole line. ROTID_OK, 1 where there is none any more. */
static int take_line(struct reading *r)
{
    errno = 0;
    ssize_t length = getline(&r->text, &r->room, r->file->stream);
    if (length < 0 && !feof(r->file->stream))
        return errno == ENOMEM ? ROTID_ERROR_MEMORY
                               : message_refuse(r->messages, ROTID_ERROR_IO, r->file->path, r->file->lines + 1, 1,
                                                "reading failed: %s", strerror(errno));
    if (length <= 0 || r->text[length - 1] != '\n')
        return 1;
    r->length = (size_t)length;
    r->file->end += length;
    r->file->lines++;
    return length > MOST_LINE ? refuse_line(r, "the line is too long for a result") : ROTID_OK;
}

/* The first line. ROTID_OK; ROTID_ERROR_SYNTAX where the file is something else. */
static int read_header(struct reading *r, struct pool *pool)
{
    struct results *file = r->file;
    struct stat about = {0};
    int regular = !fstat(fileno(file->stream), &about) && S_ISREG(about.st_mode);
    int first = regular ? getc(file->stream) : EOF; /* what is no JSON may have no line feed for gigabytes */
    file->size = about.st_size;
    int status = first == '{' && ungetc(first, file->stream) == first ? take_line(r) : 1;
    if (!status)
        status = results_header_read(pool, r->text, r->length, &file->header);
    if (status == 1 || status == ROTID_ERROR_SYNTAX)
        return refuse_line(r, "this is no file of results of rotid study, expected one or a new name");
    if (status)
        return status;
    (void)shard_parse(file->header.shard, &file->shard, &file->shards);
    stamp_study(&file->header, file->study);
    file->place = POOL_ARRAY(pool, struct result_place, file->header.runs);
    return file->place ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The line of a run, in place of the one that it had. */
static void put(struct results *file, long run, const struct result_place *at)
{
    file->place[run] = *at;
    file->in_order &= run > file->last;
    file->last = run;
}

/* ROTID_OK with the next line, 1 behind the last whole one, ROTID_ERROR_SYNTAX where a line was changed, is of another study or
 * of a run that stands there already, unless that had failed or its deck was mended in between: which of the two counts, or what
 * the line said, nobody knows here. */
static int read_run(struct reading *r)
{
    struct results *file = r->file;
    struct pool pool;
    struct study_run said;
    char twice[128];
    off_t offset = file->end;
    int status = take_line(r);
    if (status)
        return status;
    pool_open(&pool, NULL);
    const char *wrong = stamp_fault(file->study, r->text, r->length);
    if (!wrong)
        wrong = results_line_read(&pool, r->text, r->length, &said);
    if (!wrong && (said.run >= file->header.runs || said.run % file->shards != file->shard - 1))
        wrong = "this line is of a run that the study, or this shard of it, does not have, expected one of its runs";
    if (!wrong) {
        const struct result_place at = {fileno(file->stream), said.status == STUDY_FAILED, offset, r->length,
                                        said.input ? digest_name(said.input) : 0};
        const struct result_place *before = &file->place[said.run];
        if (!before->length || before->failed || before->input != at.input)
            put(file, said.run, &at);
        else if (snprintf(twice, sizeof twice,
                          "run %d stands in a line above already, expected one line of each run that did not fail", said.run))
            wrong = twice;
    }
    status = wrong ? refuse_line(r, wrong) : ROTID_OK;
    pool_close(&pool);
    return status;
}

/* Reads the file that the stream is of, which stays open also where something is wrong. */
static int read_all(struct pool *pool, struct message_list *messages, struct results *file)
{
    struct reading r = {.file = file, .messages = messages};
    (void)setvbuf(file->stream, NULL, _IOFBF, BLOCK);
    int status = read_header(&r, pool);
    while (!status)
        status = read_run(&r);
    free(r.text);
    return status == 1 ? ROTID_OK : status;
}

int results_open(struct pool *pool, const char *path, struct message_list *messages, struct results *file)
{
    struct stat about;
    int descriptor = file_descriptor(path, &about);
    *file = (struct results){.path = path, .last = -1, .in_order = 1, .stream = descriptor < 0 ? NULL : fdopen(descriptor, "rb")};
    if (!file->stream)
        return message_refuse(messages, ROTID_ERROR_IO, path, 1, 1, "cannot be opened: %s, expected a file of results",
                              strerror(errno));
    int status = read_all(pool, messages, file);
    if (status)
        results_close(file);
    return status;
}

void results_close(struct results *file)
{
    if (file->stream)
        (void)fclose(file->stream);
    file->stream = NULL;
}

char *results_fetch(struct pool *pool, struct result_place place)
{
    char *text = POOL_ROOM(pool, char, place.length + 1);
    size_t have = 0;
    errno = text ? errno : ENOMEM;
    while (text && have < place.length) {
        ssize_t got = pread(place.descriptor, text + have, place.length - have, place.offset + (off_t)have);
        if (got == 0)
            errno = EIO; /* it was longer when it was looked at */
        if (got == 0 || (got < 0 && errno != EINTR))
            return NULL;
        have += got > 0 ? (size_t)got : 0;
    }
    if (text)
        text[place.length] = 0;
    return text;
}

int results_write(const char *path, const struct results *file)
{
    char *first = header_text(&file->header);
    struct output output;
    int status = first ? output_open(&output, path) : ROTID_ERROR_MEMORY;
    if (!status) {
        int failed = fputs(first, output.stream) < 0;
        for (long run = 0; run < file->header.runs && !failed; run++) {
            struct pool pool;
            pool_open(&pool, NULL);
            const char *text = results_fetch(&pool, file->place[run]);
            failed = !text || fputs(text, output.stream) < 0;
            pool_close(&pool);
        }
        status = output_close(&output, failed ? ROTID_ERROR_IO : ROTID_OK);
    }
    free(first);
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

/* The file by that name, open and locked. It may have been replaced between the two. Its lock goes with the first descriptor of
 * it that is closed. */
static int open_locked(const char *path, struct message_list *messages, int *descriptor)
{
    for (;;) {
        struct stat open_one, named;
        *descriptor = open(path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, 0666);
        if (*descriptor < 0)
            return message_refuse(messages, ROTID_ERROR_IO, path, 1, 1, "cannot be opened: %s", strerror(errno));
        int regular = !fstat(*descriptor, &open_one) && S_ISREG(open_one.st_mode);
        long holder = regular ? lock(*descriptor) : 0;
        if (holder < 0)
            message_add(messages, SEVERITY_WARNING, path, 1, 1,
                        "cannot be locked here (%s): see to it that no second study writes to it", strerror(errno));
        if (regular && holder <= 0 && !stat(path, &named) && named.st_dev == open_one.st_dev && named.st_ino == open_one.st_ino)
            return ROTID_OK;
        (void)close(*descriptor);
        if (!regular)
            return message_refuse(messages, ROTID_ERROR_ARGUMENT, path, 1, 1,
                                  "this is no file that lines can be added to, expected a regular one");
        if (holder > 0)
            return message_refuse(messages, ROTID_ERROR_ARGUMENT, path, 1, 1,
                                  "is being written by process %ld, expected another file or its end", holder);
    }
}

/* The name of a new file, and the header of it, are on the disk before the first run is. */
static void sync_folder(const char *path)
{
    char *copy = strdup(path);
    int descriptor = copy ? open(dirname(copy), O_RDONLY | O_CLOEXEC) : -1;
    if (descriptor >= 0) {
        (void)fsync(descriptor); /* some file systems cannot: then it is there when they think so */
        (void)close(descriptor);
    }
    free(copy);
}

/* Whether all there is of the file is the beginning of its header: nothing, or it was ended while it was begun. */
static int is_unbegun(const struct results *file, const char *header)
{
    size_t length = strlen(header);
    char *begun = malloc(length);
    ssize_t got = begun ? pread(fileno(file->stream), begun, length, 0) : -1;
    int same = got >= 0 && (size_t)got < length && !memcmp(begun, header, (size_t)got);
    free(begun);
    return same;
}

/* Appends count bytes with one write where the system lets them through; the file is as it was where they do not fit. */
static int append(struct study_record *record, const char *bytes, size_t count)
{
    int descriptor = fileno(record->file.stream);
    size_t written = 0;
    while (written < count) {
        ssize_t got = write(descriptor, bytes + written, count - written);
        if (got > 0)
            written += (size_t)got;
        if (got == 0)
            errno = ENOSPC;
        if (got <= 0 && errno != EINTR) {
            int reason = errno;
            while (ftruncate(descriptor, record->file.end) && errno == EINTR)
                ;
            errno = reason;
            return ROTID_ERROR_IO;
        }
    }
    record->file.end += (off_t)count;
    return ROTID_OK;
}

static int begin_file(struct study_record *record, const char *header, struct message_list *messages)
{
    int descriptor = fileno(record->file.stream);
    if (ftruncate(descriptor, 0) || append(record, header, strlen(header)) || fsync(descriptor))
        return message_refuse(messages, ROTID_ERROR_IO, record->path, 1, 1, "cannot be written: %s", strerror(errno));
    sync_folder(record->path);
    record->file.end = 0; /* to be read as any other */
    rewind(record->file.stream);
    return ROTID_OK;
}

/* Whether the file is the one of this study and shard. */
static int compare(struct pool *pool, const struct study_record *record, const struct study_header *header,
                   struct message_list *messages)
{
    const struct results *file = &record->file;
    const char *difference = header_difference(pool, &file->header, header, record->deck != NULL);
    int shard, shards;
    (void)shard_parse(header->shard, &shard, &shards);
    if (!difference)
        return ROTID_ERROR_MEMORY;
    if (*difference)
        return message_refuse(messages, ROTID_ERROR_ARGUMENT, file->path, 1, 1,
                              "this file is of another study: %s; expected a new name, or things as they were", difference);
    if (file->shard != shard || file->shards != shards)
        return message_refuse(messages, ROTID_ERROR_ARGUMENT, file->path, 1, 1,
                              "this file is of shard %d/%d and not of %d/%d, expected a file for each shard", file->shard,
                              file->shards, shard, shards);
    return ROTID_OK;
}

/* A last line that was cut goes. */
static int cut(const struct results *file, struct message_list *messages)
{
    if (file->size <= file->end)
        return ROTID_OK;
    if (ftruncate(fileno(file->stream), file->end))
        return message_refuse(messages, ROTID_ERROR_IO, file->path, file->lines + 1, 1, "the cut line cannot be removed: %s",
                              strerror(errno));
    message_add(messages, SEVERITY_NOTE, file->path, file->lines + 1, 1, "a line that was cut has been removed");
    return ROTID_OK;
}

/* Which runs are there; those that are to be computed again have no line. */
static int read_lines(struct pool *pool, struct study_record *record, const struct study_header *header, int retry_failed,
                      struct message_list *messages)
{
    struct results *file = &record->file;
    long changed = 0;
    int status = read_all(pool, messages, file);
    if (!status)
        status = compare(pool, record, header, messages);
    if (!status)
        status = cut(file, messages);
    for (long run = 0; run < header->runs && !status; run++) {
        struct result_place *at = &file->place[run];
        int other = record->deck && at->input && at->input != digest_name(record->deck[run].digest); /* deck of another time */
        changed += other;
        if (other || (at->failed && retry_failed))
            *at = (struct result_place){0};
        record->done += at->length > 0;
        record->failed += at->failed;
    }
    if (changed)
        message_add(messages, SEVERITY_WARNING, file->path, 1, 1,
                    "lines of decks that have changed since: %ld; their runs are computed again", changed);
    return status == ROTID_ERROR_SYNTAX ? ROTID_ERROR_ARGUMENT : status;
}

int record_open(struct pool *pool, const char *path, const struct study_header *header, const struct study_deck *deck,
                int retry_failed, struct message_list *messages, struct study_record *record)
{
    struct results *file = &record->file;
    char *first = header_text(header);
    int descriptor = -1, status = first ? open_locked(path, messages, &descriptor) : ROTID_ERROR_MEMORY;
    *record = (struct study_record){.deck = deck, .synced = clock_seconds(), .file = {.last = -1, .in_order = 1}};
    if (!status && !(file->stream = fdopen(descriptor, "r+b")))
        (void)close(descriptor);
    if (!status && !(file->path = record->path = file->stream ? realpath(path, NULL) : NULL))
        status = ROTID_ERROR_MEMORY;
    if (!status && is_unbegun(file, first))
        status = begin_file(record, first, messages);
    if (!status)
        status = read_lines(pool, record, header, retry_failed, messages);
    free(first);
    if (status) {
        record_close(record);
        return status;
    }
    file->header = *header;
    record->wanted = (header->runs + file->shards - file->shard) / file->shards;
    record->next = file->shard - 1;
    return ROTID_OK;
}

long record_take(struct study_record *record)
{
    const struct results *file = &record->file;
    while (record->next < file->header.runs) {
        long run = record->next;
        record->next += file->shards;
        if (!file->place[run].length)
            return run;
    }
    return -1;
}

int record_append(struct study_record *record, const char *line)
{
    struct results *file = &record->file;
    long run = strtol(line + strlen("{\"run\":"), NULL, 10);
    const struct result_place at = {.descriptor = fileno(file->stream),
                                    .failed = strstr(line, "\"status\":\"failed\",\"error\":") != NULL,
                                    .offset = file->end,
                                    .length = strlen(line) - strlen("}\n") + LENGTH};
    char *stamped = stamp_line(file->study, line);
    int status = stamped ? append(record, stamped, at.length) : ROTID_ERROR_MEMORY;
    free(stamped);
    if (status)
        return status;
    put(file, run, &at);
    record->done++;
    record->failed += at.failed;
    return ROTID_OK;
}

int record_sync(struct study_record *record, double now)
{
    if (now - record->synced < SYNC_SECONDS)
        return ROTID_OK;
    if (fdatasync(fileno(record->file.stream)))
        return ROTID_ERROR_IO;
    record->synced = clock_seconds();
    return ROTID_OK;
}

int record_finish(struct study_record *record)
{
    return record->file.in_order ? record_sync(record, INFINITY) : results_write(record->path, &record->file);
}

void record_close(struct study_record *record)
{
    results_close(&record->file);
    free(record->path);
    record->path = NULL;
}
