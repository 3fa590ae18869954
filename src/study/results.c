#include "study/study.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "result/result.h"

#define BLOCK     ((size_t)1 << 18)
#define MOST_LINE ((size_t)1 << 26) /* a line is a few thousand bytes; beyond this it is something else */

static int cannot_read(struct results *r)
{
    message_add(r->messages, SEVERITY_ERROR, r->path, r->number + 1, 1, "reading failed: %s", strerror(errno));
    return ROTID_ERROR_IO;
}

static int malformed(struct results *r, int line, const char *what)
{
    message_add(r->messages, SEVERITY_ERROR, r->path, line, 1, "%s", what);
    return ROTID_ERROR_SYNTAX;
}

/* More of the file behind what the buffer holds. ROTID_OK, 1 at the end. */
static int fill(struct results *r)
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
static int take_line(struct results *r, const char **text, size_t *length)
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

int results_open(struct pool *pool, int descriptor, const char *path, struct message_list *messages, struct results *r)
{
    static const char expected[] = "this is no file of results of rotid study, expected one or a new name";
    struct stat information;
    const char *text;
    size_t length;
    *r = (struct results){.descriptor = descriptor, .path = path, .messages = messages};
    pool_open(&r->line, NULL);
    if (fstat(descriptor, &information))
        return cannot_read(r);
    r->size = information.st_size;
    if (!S_ISREG(information.st_mode) || (r->size && pread(descriptor, &(char){0}, 1, 0) != 1))
        return malformed(r, 1, expected);
    int status = take_line(r, &text, &length);
    if (status)
        return status > 0 ? malformed(r, 1, expected) : status;
    cJSON *json = json_text_too_dense(text, length) ? NULL : cJSON_ParseWithLength(text, length);
    status = results_header_read(pool, json, &r->header);
    cJSON_Delete(json);
    if (status)
        return status == ROTID_ERROR_SYNTAX ? malformed(r, 1, expected) : status;
    stamp_study(&r->header, r->study);
    r->there = POOL_ARRAY(pool, char, r->header.runs);
    r->input = POOL_ARRAY(pool, uint64_t, r->header.runs);
    return r->there && r->input ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Nonzero after a message. */
static int refuse_stamp(struct results *r, const struct result_line *line)
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
    enum stamp_fault fault = stamp_check(r->study, line->text, line->length);
    if (fault)
        (void)malformed(r, r->number, texts[fault]);
    return fault != STAMP_GOOD;
}

static int refuse_twice(struct results *r, const struct result_line *line)
{
    uint64_t input = line->said->input ? digest_name(line->said->input) : 0;
    int again = r->there[line->run] && r->input[line->run] != input; /* its deck was mended in between */
    r->input[line->run] = input;
    if (r->there[line->run] > 1 && !again) {
        message_add(r->messages, SEVERITY_ERROR, r->path, r->number, 1,
                    "run %ld stands in a line above already, expected one line of each run that did not fail", line->run);
        return ROTID_ERROR_SYNTAX;
    }
    r->there[line->run] = (char)(line->failed ? 1 : 2);
    return ROTID_OK;
}

const char *results_line_read(struct pool *pool, const char *text, size_t length, struct study_run *run)
{
    struct message_list messages;
    struct reader reader = {.pool = pool, .messages = &messages, .file = "this line is no result"};
    cJSON *json = json_text_too_dense(text, length) ? NULL : cJSON_ParseWithLength(text, length);
    const struct json_place place = {.reader = &reader, .json = json};
    message_open(&messages, pool);
    *run = (struct study_run){.status = -1};
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

int results_next(struct results *r, struct result_line *line)
{
    struct study_run *said;
    pool_close(&r->line);
    pool_open(&r->line, NULL);
    *line = (struct result_line){.offset = r->next};
    int status = take_line(r, &line->text, &line->length);
    if (status)
        return status;
    if (refuse_stamp(r, line))
        return ROTID_ERROR_SYNTAX;
    line->said = said = POOL_NEW(&r->line, struct study_run);
    const char *wrong = said ? results_line_read(&r->line, line->text, line->length, said) : "";
    if (wrong)
        return *wrong ? malformed(r, r->number, wrong) : ROTID_ERROR_MEMORY;
    if (said->run >= r->header.runs || said->run % r->header.shards != r->header.shard - 1)
        return malformed(r, r->number,
                         "this line is of a run that the study, or this shard of it, does not have, expected one of its runs");
    line->run = said->run;
    line->failed = said->status == STUDY_FAILED;
    return refuse_twice(r, line);
}

void results_close(struct results *r)
{
    pool_close(&r->line);
    free(r->buffer);
    r->buffer = NULL;
}

int results_index(struct pool *pool, int descriptor, const char *path, struct message_list *messages, struct header *header,
                  struct result_place **place, size_t *most)
{
    struct results results;
    struct result_line line = {0};
    int status = results_open(pool, descriptor, path, messages, &results);
    *most = 0;
    *header = results.header;
    if (!status && !(*place = POOL_ARRAY(pool, struct result_place, header->runs)))
        status = ROTID_ERROR_MEMORY;
    while (!status && !(status = results_next(&results, &line))) {
        (*place)[line.run] = (struct result_place){descriptor, line.failed, line.offset, line.length};
        *most = line.length > *most ? line.length : *most;
    }
    results_close(&results);
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

int results_write(const char *path, const struct header *header, const struct result_place *place, size_t most)
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
