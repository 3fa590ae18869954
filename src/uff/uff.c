/* What a deck wants of a universal file: its nodes and its mode shapes. */
#include "uff/uff.h"

#include <limits.h>
#include <stdarg.h>
#include <string.h>

#include "uff/uff_join.h"

#define SKIP_LIMIT 32
struct skip { /* sets of one type that were not read */
    char what[80];
    int line, count; /* line of the first one */
};

struct shape_list {
    struct uff_shape *item;
    size_t count, capacity;
};

/* One reading. */
struct uff_run {
    struct uff_reader *reader;
    const char *path;
    struct message_list *messages;
    struct pool *pool;   /* of the caller */
    struct pool scratch; /* ends with the job; what grows grows here and is copied to its length */
    struct uff_node_list nodes;
    struct shape_list shapes, extras;
    struct skip skip[SKIP_LIMIT];
    int skip_count, skip_others;
};

/* Remembers that the set at `line` was not read: the format gives its name, such as "set 151". */
static void note_skip(struct uff_run *job, int line, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void note_skip(struct uff_run *job, int line, const char *format, ...)
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
    if (job->skip_count == SKIP_LIMIT) {
        job->skip_others += job->skip_others < INT_MAX;
        return;
    }
    struct skip *skip = &job->skip[job->skip_count++];
    memcpy(skip->what, what, sizeof what);
    skip->line = line;
    skip->count = 1;
}

static void say_skipped(struct uff_run *job)
{
    for (int i = 0; i < job->skip_count; ++i) {
        const struct skip *skip = &job->skip[i];
        if (skip->count == 1)
            message_add(job->messages, SEVERITY_NOTE, job->path, skip->line, 1, "%s skipped", skip->what);
        else
            message_add(job->messages, SEVERITY_NOTE, job->path, skip->line, 1, "%s skipped, %d times from here on", skip->what,
                        skip->count);
    }
    if (job->skip_others)
        message_add(job->messages, SEVERITY_NOTE, job->path, 1, 1, "%d sets of further types skipped", job->skip_others);
}

/* Notes that this set is no shape of a vibration; nonzero when it is to be skipped. */
static int note_other_data(struct uff_run *job, const struct uff_shape *shape)
{
    static const char *const analysis_name[] = {"unknown", "static", "", "", "transient", "", "buckling"};
    int analysis = shape->analysis_type;
    int characteristic = shape->data_characteristic, quantity = shape->specific_type;
    if (analysis != 2 && analysis != 3 && analysis != 5 && analysis != 7) {
        int named = analysis >= 0 && analysis < (int)(sizeof analysis_name / sizeof *analysis_name);
        note_skip(job, shape->line, "set 55 of analysis type %d (%s)", analysis,
                  named ? analysis_name[analysis] : "not known here");
        return 1;
    }
    if (characteristic < 0 || characteristic > 3) { /* unknown, scalar, 3 or 6 degrees of freedom */
        note_skip(job, shape->line, "set 55 of data characteristic %d (not a vector)", characteristic);
        return 1;
    }
    if (quantity != 0 && quantity != 8 && quantity != 11 && quantity != 12) {
        note_skip(job, shape->line, "set 55 of specific data type %d (not displacement, velocity or acceleration)", quantity);
        return 1;
    }
    return 0;
}

static int read_shape(struct uff_run *job)
{
    struct uff_shape shape;
    int status = uff_read_shape_kind(job->reader, &shape);
    if (status != ROTID_OK)
        return status;
    int is_extra = shape.analysis_type == 0 && strncmp(shape.id[0], "ROTID ", 6) == 0;
    if (!is_extra && note_other_data(job, &shape))
        return ROTID_OK; /* uff_next reads over the rest */
    status = uff_read_shape_rest(job->reader, job->pool, &shape);
    if (status != ROTID_OK)
        return status;
    struct shape_list *list = is_extra ? &job->extras : &job->shapes;
    struct uff_shape *grown =
        list->count < INT_MAX ? pool_grow(&job->scratch, list->item, list->count, &list->capacity, sizeof *grown) : NULL;
    if (!grown)
        return ROTID_ERROR_MEMORY;
    list->item = grown;
    list->item[list->count++] = shape;
    return ROTID_OK;
}

static int read_nodes(struct uff_run *job, const struct uff_set *set)
{
    struct uff_node_list *list = &job->nodes;
    size_t before = list->count;
    int status = uff_append_nodes(job->reader, &job->scratch, list);
    for (size_t i = before; i < list->count && set->number == 15; ++i)
        if (list->item[i].node.definition_system != 0) {
            message_add(job->messages, SEVERITY_WARNING, job->path, list->item[i].line, 1,
                        "set 15: node %d is given in coordinate system %d; its coordinates are taken as global and Cartesian",
                        list->item[i].node.id, list->item[i].node.definition_system);
            break;
        }
    return status;
}

static int read_sets(struct uff_run *job)
{
    for (;;) {
        struct uff_set set;
        int status = uff_next(job->reader, &set);
        if (status == UFF_END)
            return ROTID_OK;
        if (status == ROTID_OK && !set.is_binary && (set.number == 15 || set.number == 781 || set.number == 2411))
            status = read_nodes(job, &set);
        else if (status == ROTID_OK && !set.is_binary && set.number == 55)
            status = read_shape(job);
        else if (status == ROTID_OK)
            note_skip(job, set.line, "set %d%s", set.number, set.is_binary ? "b" : "");
        if (status != ROTID_OK)
            return status;
    }
}

static int keep_shapes(struct pool *pool, const struct shape_list *list, int *count, struct uff_shape **out)
{
    *out = POOL_ARRAY(pool, struct uff_shape, list->count);
    if (!*out)
        return ROTID_ERROR_MEMORY;
    if (list->count)
        memcpy(*out, list->item, list->count * sizeof *list->item);
    *count = (int)list->count;
    return ROTID_OK;
}

int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out)
{
    struct uff_run job = {.path = path, .messages = messages, .pool = pool};
    *out = (struct uff_file){0};
    pool_open(&job.scratch, pool->allocator);

    int status = uff_open(&job.scratch, path, messages, &job.reader);
    if (status == ROTID_OK) {
        status = read_sets(&job);
        say_skipped(&job);
        uff_close(job.reader);
    }
    if (status == ROTID_OK)
        status = uff_join_nodes(pool, &job.scratch, path, &job.nodes, messages, out);
    if (status == ROTID_OK)
        status = keep_shapes(pool, &job.shapes, &out->shape_count, &out->shape);
    if (status == ROTID_OK)
        status = keep_shapes(pool, &job.extras, &out->extra_count, &out->extra);
    pool_close(&job.scratch);

    if (messages->out_of_memory)
        status = ROTID_ERROR_MEMORY;
    if (status != ROTID_OK)
        *out = (struct uff_file){0};
    return status;
}
