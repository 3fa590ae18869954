#include "import/convert.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "file/open.h"
#include "uff/uff_read.h"
#include "uff/uff_write.h"

#define PIECE 4096 /* values, bytes at a time */

struct conversion {
    const char *path;
    const struct convert_options *options;
    FILE *out, *source; /* source: the file once more, for what is copied */
    struct message_list *messages;
    struct convert_result *result;
    struct uff_reader *reader;
    struct pool pool, scratch; /* of the reader; of one set */
    double *x, *real, *imag;   /* [PIECE] */
    int format_known;
};

static int cancelled(const struct conversion *job)
{
    return job->options->cancelled && job->options->cancelled(job->options->context);
}

static int is_single(int ordinate)
{
    return ordinate == UFF_REAL_SINGLE || ordinate == UFF_COMPLEX_SINGLE;
}

static int convert_values(struct conversion *job, const struct uff_function *function)
{
    struct uff_function_writer writer;
    int status = uff_write_function(job->out, function, &writer);
    long long got = 1;
    while (!status && got) {
        status = uff_read_values(job->reader, PIECE, job->x, job->real, job->imag, &got);
        if (!status)
            status = uff_write_values(&writer, got, job->x, job->real, job->imag);
        if (!status && cancelled(job))
            status = ROTID_STOP_CANCELLED;
    }
    return status ? status : uff_end_function(&writer);
}

static int convert_function(struct conversion *job, const struct uff_set *set)
{
    struct uff_function function = {0};
    int status = uff_read_function(job->reader, &function);
    if (status)
        return status;
    if (!job->format_known) {
        int format = job->options->format;
        job->result->is_binary = format == CONVERT_OTHER ? !set->is_binary : format == CONVERT_BINARY;
        job->format_known = 1;
    }
    if (!job->result->is_binary && set->is_binary && is_single(function.ordinate))
        function.ordinate = function.ordinate == UFF_REAL_SINGLE ? UFF_REAL_DOUBLE : UFF_COMPLEX_DOUBLE;
    function.binary = (struct uff_binary){.is_binary = job->result->is_binary, .order = 1, .format = 2};
    status = convert_values(job, &function);
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(job->messages, SEVERITY_ERROR, job->path, set->line, 1,
                    "set 58: does not fit the %s format: a value that is not finite or out of range, or a text like '    -1'",
                    job->result->is_binary ? "binary" : "ASCII");
    ++job->result->functions;
    return status;
}

/* Whether the struct of a shape has room for what record 8 says under this analysis; not the time of a transient one, or the
 * eigenvalue of buckling. */
static int holds_all(int analysis_type)
{
    return analysis_type == 0 || analysis_type == 2 || analysis_type == 3 || analysis_type == 5 || analysis_type == 7;
}

/* Reads a set that is no function and writes it to `out`; UFF_END for those that are copied. */
static int carry(struct conversion *job, const struct uff_set *set, FILE *out)
{
    struct uff_reader *reader = job->reader;
    struct pool *pool = &job->scratch;
    int status, count;
    union {
        struct uff_header header;
        struct uff_units units;
        struct uff_trace trace;
        struct uff_shape shape;
        struct uff_analysis analysis;
    } data;
    struct uff_node *node;
    struct uff_element *element;
    memset(&data, 0, sizeof data);
    switch (set->number) {
    case 15:
    case 2411:
        status = uff_read_nodes(reader, pool, &count, &node);
        return status ? status : uff_write_nodes(out, set->number, count, node);
    case 55:
        status = uff_read_shape_set(reader, pool, &data.shape);
        return status ? status : holds_all(data.shape.analysis_type) ? uff_write_shape(out, &data.shape) : UFF_END;
    case 82:
        status = uff_read_trace(reader, pool, &data.trace);
        return status ? status : uff_write_trace(out, &data.trace);
    case 151:
        status = uff_read_header(reader, &data.header);
        return status ? status : uff_write_header(out, &data.header);
    case 164:
        status = uff_read_units(reader, &data.units);
        return status ? status : uff_write_units(out, &data.units);
    case 2412:
        status = uff_read_elements(reader, pool, &count, &element);
        return status ? status : uff_write_elements(out, count, element);
    case 2414:
        status = uff_read_analysis(reader, pool, &data.analysis);
        return status ? status : uff_write_analysis(out, &data.analysis);
    default:
        return UFF_END;
    }
}

/* By way of memory, so that nothing of a set that does not fit reaches the file. *copy: it is to be copied. */
static int convert_other(struct conversion *job, const struct uff_set *set, int *copy)
{
    char *text = NULL;
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);
    if (!memory)
        return ROTID_ERROR_MEMORY;
    pool_open(&job->scratch, NULL);
    int status = carry(job, set, memory);
    pool_close(&job->scratch);
    if (fclose(memory) != 0 && !status)
        status = ROTID_ERROR_MEMORY;
    *copy = status == UFF_END || status == ROTID_ERROR_ARGUMENT;
    if (!status && fwrite(text, 1, length, job->out) != length)
        status = ROTID_ERROR_IO;
    free(text);
    job->result->others += !status;
    return *copy ? ROTID_OK : status;
}

/* Bytes from `first` to `end` of the source, or to its end where that is negative. */
static int copy_bytes(struct conversion *job, long long first, long long end)
{
    char piece[PIECE];
    if (fseeko(job->source, (off_t)first, SEEK_SET) != 0)
        return ROTID_ERROR_IO;
    for (long long at = first; end < 0 || at < end;) {
        size_t wanted = end < 0 || end - at > PIECE ? PIECE : (size_t)(end - at);
        size_t got = fread(piece, 1, wanted, job->source);
        if (!got)
            return end < 0 && !ferror(job->source) ? ROTID_OK : ROTID_ERROR_IO;
        if (fwrite(piece, 1, got, job->out) != got)
            return ROTID_ERROR_IO;
        if (cancelled(job))
            return ROTID_STOP_CANCELLED;
        at += (long long)got;
    }
    return ROTID_OK;
}

static int convert_sets(struct conversion *job)
{
    long long pending = -1; /* where a set begins that is copied as soon as its end is known */
    for (;;) {
        struct uff_set set;
        int copy = 0, status = cancelled(job) ? ROTID_STOP_CANCELLED : uff_next(job->reader, &set);
        if (pending >= 0 && (!status || status == UFF_END)) {
            int copied = copy_bytes(job, pending, status ? -1 : set.offset);
            status = copied ? copied : status;
            pending = -1;
        }
        if (status)
            return status == UFF_END ? ROTID_OK : status;
        status = set.number == 58 ? convert_function(job, &set) : convert_other(job, &set, &copy);
        if (status)
            return status;
        if (copy) {
            pending = set.offset;
            ++job->result->copied;
        }
    }
}

int convert_file(const char *path, const struct convert_options *options, FILE *out, struct message_list *messages,
                 struct convert_result *result)
{
    struct conversion job = {.path = path, .options = options, .out = out, .messages = messages, .result = result};
    *result = (struct convert_result){0};
    pool_open(&job.pool, NULL);
    job.x = POOL_ARRAY(&job.pool, double, PIECE);
    job.real = POOL_ARRAY(&job.pool, double, PIECE);
    job.imag = POOL_ARRAY(&job.pool, double, PIECE);
    int status = job.x && job.real && job.imag ? uff_open(&job.pool, path, messages, &job.reader) : ROTID_ERROR_MEMORY;
    if (!status) {
        struct stat about;
        job.source = file_open(path, 0, &about);
        status = job.source ? convert_sets(&job) : ROTID_ERROR_IO;
        int reason = errno;
        if (job.source)
            (void)fclose(job.source);
        uff_close(job.reader);
        errno = reason;
    }
    pool_close(&job.pool);
    return status;
}
