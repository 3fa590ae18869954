/* The sets of a universal file in turn: between two lines '-1', a line with the number of the set and its records. */
#include "uff/uff.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <string.h>

#include "uff/uff_sets.h"

void uff_note_skip(struct uff_job *job, const char *format, ...)
{
    char what[sizeof job->skip[0].what];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(what, sizeof what, format, values);
    va_end(values);
    for (int i = 0; i < job->skip_count; ++i)
        if (strcmp(job->skip[i].what, what) == 0) {
            job->skip[i].count += job->skip[i].count < INT_MAX;
            return;
        }
    if (job->skip_count == UFF_SKIP_LIMIT) {
        job->skip_others += job->skip_others < INT_MAX;
        return;
    }
    struct uff_skip *skip = &job->skip[job->skip_count++];
    memcpy(skip->what, what, sizeof what);
    skip->line = job->set_line;
    skip->count = 1;
}

static void say_skipped(struct uff_job *job)
{
    struct uff_lines *lines = &job->lines;
    for (int i = 0; i < job->skip_count; ++i) {
        const struct uff_skip *skip = &job->skip[i];
        if (skip->count == 1)
            message_add(lines->messages, SEVERITY_NOTE, lines->path, skip->line, 1, "%s skipped", skip->what);
        else
            message_add(lines->messages, SEVERITY_NOTE, lines->path, skip->line, 1, "%s skipped, %d times from here on",
                        skip->what, skip->count);
    }
    if (job->skip_others)
        message_add(lines->messages, SEVERITY_NOTE, lines->path, 1, 1, "%d sets of further types skipped", job->skip_others);
}

/* Data of unknown sets may be -1 in a line of its own, so the end must look like the beginning did. */
int uff_skip_lines(struct uff_job *job)
{
    for (;;) {
        int status = uff_take_line(&job->lines);
        if (status == UFF_END)
            return uff_fail(&job->lines, 0, "the file ends after this line; expected the '-1' that ends the set");
        if (status != ROTID_OK || uff_is_delimiter(&job->lines, job->lines.strict))
            return status;
    }
}

/* A binary set, 58b: its first line says how many lines and then how many bytes follow. The bytes may hold anything, also what
 * looks like the end. The '-1' follows them at once, with some writers in a new line. */
static int skip_binary(struct uff_job *job)
{
    static const int start[] = {7, 13, 19, 31}, width[] = {6, 6, 12, 12}, field[] = {1, 2, 3, 4};
    struct uff_lines *lines = &job->lines;
    long long value[4];
    if (!uff_find_integers(lines, 4, start, width, field, value) || value[2] < 0 || value[3] < 0)
        return uff_fail(lines, 0, "binary; expected byte order, number format, number of lines and number of bytes");
    long long bytes = value[3];
    for (long long i = 0; i < value[2]; ++i) {
        int status = uff_take_line(lines);
        if (status == UFF_END)
            return uff_fail(lines, 0, "the file ends after this line; expected %lld lines of text in all", value[2]);
        if (status != ROTID_OK)
            return status;
    }
    int status = uff_skip_bytes(lines, bytes);
    do {
        if (status == ROTID_OK)
            status = uff_expect_line(lines, "the '-1' that ends the set");
        if (status != ROTID_OK)
            return status;
    } while (!lines->length);
    if (!uff_is_delimiter(lines, 0))
        return uff_fail(lines, 0, "expected a line '    -1' behind %lld bytes of binary data", bytes);
    return ROTID_OK;
}

/* From the line with the number to the closing '-1'. */
static int read_set(struct uff_job *job)
{
    struct uff_lines *lines = &job->lines;
    int status = uff_expect_line(lines, "the number of a set");
    if (status != ROTID_OK)
        return status;

    size_t i = 0;
    int number = 0;
    while (lines->text[i] == ' ' || lines->text[i] == '\t')
        ++i;
    for (; lines->text[i] >= '0' && lines->text[i] <= '9' && number < 1000000; ++i)
        number = 10 * number + (lines->text[i] - '0');
    int binary = lines->text[i] == 'b' || lines->text[i] == 'B';
    i += (size_t)binary;
    if (!number || (lines->text[i] && lines->text[i] != ' ' && lines->text[i] != '\t')) {
        char excerpt[UFF_EXCERPT];
        return uff_fail(lines, 1, "expected the number of a set behind '    -1', found '%s'",
                        uff_excerpt(lines->text, lines->length, excerpt));
    }

    lines->set = number;
    if (binary) {
        uff_note_skip(job, "set %db", number);
        return skip_binary(job);
    }
    if (number == 15)
        return uff_read_nodes_15(job);
    if (number == 2411 || number == 781)
        return uff_read_nodes_2411(job);
    if (number == 55)
        return uff_read_shape(job);
    uff_note_skip(job, "set %d", number);
    return uff_skip_lines(job);
}

static int read_sets(struct uff_job *job)
{
    struct uff_lines *lines = &job->lines;
    for (int count = 0;;) {
        lines->set = 0;
        int status = uff_take_line(lines);
        if (status == UFF_END && count)
            return ROTID_OK;
        if (status == ROTID_OK && !lines->length) /* blank lines between sets, and at the end */
            continue;
        if (!count && (status == UFF_END || (status == ROTID_OK && !uff_is_delimiter(lines, 0))))
            return uff_fail(lines, 0, "no universal file: expected a line '    -1'");
        if (status != ROTID_OK)
            return status;
        if (!uff_is_delimiter(lines, 0)) {
            char excerpt[UFF_EXCERPT];
            return uff_fail(lines, 1, "expected a line '    -1' that opens a set, found '%s'",
                            uff_excerpt(lines->text, lines->length, excerpt));
        }
        lines->strict = uff_is_delimiter(lines, 1);
        job->set_line = lines->line;
        status = read_set(job);
        if (status != ROTID_OK)
            return status;
        count = 1;
    }
}

static int keep_shapes(struct uff_job *job, struct uff_file *out)
{
    if (job->shape_count > INT_MAX)
        return uff_fail(&job->lines, 0, "more than %d sets 55", INT_MAX);
    out->shape = POOL_ARRAY(job->pool, struct uff_shape, job->shape_count);
    if (!out->shape)
        return ROTID_ERROR_MEMORY;
    if (job->shape_count)
        memcpy(out->shape, job->shape, job->shape_count * sizeof *job->shape);
    out->shape_count = (int)job->shape_count;
    return ROTID_OK;
}

int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out)
{
    struct uff_job job = {.lines = {.path = path, .messages = messages}, .pool = pool};
    *out = (struct uff_file){0};
    pool_open(&job.scratch, pool->allocator);

    int status = ROTID_ERROR_IO;
    errno = 0;
    job.lines.stream = fopen(path, "rb");
    if (job.lines.stream) {
        status = read_sets(&job);
        say_skipped(&job);
        (void)fclose(job.lines.stream); /* nothing was written that could fail to arrive */
        if (status == ROTID_OK)
            status = uff_join_nodes(&job, out);
        if (status == ROTID_OK)
            status = keep_shapes(&job, out);
    } else {
        message_add(messages, SEVERITY_ERROR, path, 1, 1, "cannot be opened: %s", strerror(errno));
    }
    pool_close(&job.scratch);

    if (messages->out_of_memory)
        status = ROTID_ERROR_MEMORY;
    if (status != ROTID_OK)
        *out = (struct uff_file){0};
    return status;
}
