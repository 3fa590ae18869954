#include "uff/uff.h"

#include <limits.h>

/* Set 55, data at nodes: five lines of text, 6: what the data are, 7 and 8: integers and reals of the analysis, then for each
 * node its number and its values. */

struct placed_values { /* of one node */
    int node, line;
    double value[12]; /* as in the file: of a complex number the real and the imaginary part in turn */
};

/* What grows, on a pool of its own, until it is copied to its length. */
struct growing {
    struct pool scratch;
    struct placed_values *values; /* [node_count] of the shape */
};

static int read_kind(struct uff_lines *lines, struct uff_shape *shape)
{
    int status = uff_read_id(lines, shape->id);
    if (status == ROTID_OK)
        status = uff_read_record(lines, &uff_kind_55, shape);
    shape->is_complex = shape->data_type == COMPLEX_DATA;
    return status;
}

static int uff_read_shape_kind(struct uff_reader *reader, struct uff_shape *shape)
{
    *shape = (struct uff_shape){.line = reader->set.line};
    int status = uff_begin(reader, 55);
    return status == ROTID_OK ? uff_end(reader, read_kind(&reader->lines, shape), UFF_AT_DATA) : status;
}

int uff_has_eigenvalue(const struct uff_shape *shape)
{
    return shape->analysis_type == COMPLEX_FIRST_ORDER || shape->analysis_type == COMPLEX_SECOND_ORDER;
}

/* What record 8 says, as frequency and damping. */
static void take_reals(struct uff_shape *shape, int count, const double *real)
{
    double six[6] = {0};
    for (int i = 0; i < count && i < 6; ++i)
        six[i] = real[i];
    if (uff_has_eigenvalue(shape)) {
        double modulus = hypot(real[0], real[1]);
        int oscillates = real[1] != 0; /* else it is as a rigid-body mode, which has zero here */
        for (int i = 0; i < 2; ++i) {
            shape->eigenvalue[i] = six[i];
            shape->modal_a[i] = six[2 + i];
            shape->modal_b[i] = six[4 + i];
        }
        shape->frequency_hz = oscillates ? modulus / TWO_PI : 0;
        shape->damping = oscillates ? -real[0] / modulus : 0;
    } else if (shape->analysis_type == NORMAL_MODE) {
        shape->frequency_hz = six[0];
        shape->modal_mass = six[1];
        shape->damping = six[2];
        shape->hysteretic = six[3];
    } else if (shape->analysis_type == FREQUENCY_RESPONSE || shape->analysis_type == UNKNOWN_ANALYSIS) {
        shape->frequency_hz = six[0];
    }
}

/* Records 7 and 8: number, frequency and damping. */
static int read_mode(struct uff_lines *lines, struct uff_shape *shape)
{
    static const struct uff_record counts = {.count = 2,
                                             .member = {{.column = {UFF_LONG, 0, 10}}, {.column = {UFF_LONG, 10, 10}}}};
    int integer[UFF_VALUE_LIMIT + 2];
    double real[UFF_VALUE_LIMIT];
    struct uff_cell cell[UFF_CELL_LIMIT];
    int is_mode = uff_has_eigenvalue(shape) || shape->analysis_type == NORMAL_MODE || shape->analysis_type == FREQUENCY_RESPONSE;
    int least_integers = is_mode ? 2 : 1, least_reals = uff_has_eigenvalue(shape) ? 2 : 1;

    int status = uff_expect_line(lines, "record 7 (numbers of integers and reals, load case, mode number)");
    if (status != ROTID_OK)
        return status;
    if (uff_cut_line(lines, &counts, 0, cell) >= 0)
        return uff_fail(lines, 1, "record 7: expected the numbers of integers and reals");
    long long integers = cell[0].integer, reals = cell[1].integer;
    if (integers < least_integers || integers > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld integers announced; expected load case and mode number", integers);
    if (reals < least_reals || reals > UFF_VALUE_LIMIT)
        return uff_fail(lines, 0, "record 7: %lld reals announced; expected at least %d", reals, least_reals);
    status = uff_read_integers(lines, (int)integers + 2, "record 7", integer);
    if (status != ROTID_OK)
        return status;
    int has_case = integers > 1 || shape->analysis_type != 0; /* of unknown data the one integer is a number */
    shape->load_case = has_case ? integer[2] : 0;
    shape->number = integers > 1 ? integer[3] : has_case ? 0 : integer[2];

    int line = lines->line + 1;
    status = uff_read_reals(lines, (int)reals, 6, 13, "record 8", real);
    if (status != ROTID_OK)
        return status;
    take_reals(shape, (int)reals, real);
    if (shape->frequency_hz >= 0 && isfinite(shape->frequency_hz))
        return ROTID_OK;
    return message_refuse(lines->messages, ROTID_ERROR_SYNTAX, lines->path, line, 1,
                          "set 55: record 8: the frequency is negative or not finite, expected zero or more");
}

/* The nodes with their values, to the closing '-1'. */
static int read_values(struct uff_reader *reader, struct growing *growing, struct uff_shape *shape)
{
    const struct uff_form form = {.integers = 1, .integer_width = 10};
    struct uff_lines *lines = &reader->lines;
    int value_count = shape->component_count * (shape->is_complex ? 2 : 1);
    for (;;) {
        int is_end, status = uff_next_record(reader, "a node number or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            return status;
        if (shape->node_count >= INT_MAX / 6)
            return uff_fail(lines, 0, "more than %d nodes", INT_MAX / 6);
        struct placed_values values = {.line = lines->line};
        status = uff_parse_line(lines, &form, "a node number", &values.node, NULL);
        /* values are due now, and a line '-1' is one of them */
        if (status == ROTID_OK)
            status = uff_read_reals(lines, value_count, 6, 13, "values of a node", values.value);
        if (status != ROTID_OK)
            return status;
        if (POOL_ADD(&growing->scratch, growing->values, shape->node_count, &values))
            return ROTID_ERROR_MEMORY;
    }
}

static int refuse_repeated_nodes(struct uff_lines *lines, struct growing *growing, int count)
{
    const struct uff_label *label = uff_sort_labels(&growing->scratch, count, &growing->values->node, sizeof *growing->values);
    if (!label)
        return ROTID_ERROR_MEMORY;
    for (int i = 1; i < count; ++i) {
        if (label[i].id != label[i - 1].id)
            continue;
        const struct placed_values *first = &growing->values[label[i - 1].order];
        const struct placed_values *again = &growing->values[label[i].order];
        return message_refuse(lines->messages, ROTID_ERROR_SYNTAX, lines->path, again->line, 1,
                              "set 55: node %d occurs twice in the set, first in line %d, expected once", again->node,
                              first->line);
    }
    return ROTID_OK;
}

static int keep_values(const struct growing *growing, struct pool *pool, struct uff_shape *shape)
{
    size_t count = (size_t)shape->node_count, components = (size_t)shape->component_count;
    size_t value_count = components * count;
    shape->node = POOL_ARRAY(pool, int, count);
    shape->real = POOL_ARRAY(pool, double, value_count);
    shape->imag = shape->is_complex ? POOL_ARRAY(pool, double, value_count) : NULL;
    if (!shape->node || !shape->real || (shape->is_complex && !shape->imag))
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < count; ++i) {
        const double *value = growing->values[i].value;
        shape->node[i] = growing->values[i].node;
        for (size_t c = 0; c < components; ++c) {
            shape->real[components * i + c] = shape->is_complex ? value[2 * c] : value[c];
            if (shape->imag)
                shape->imag[components * i + c] = value[2 * c + 1];
        }
    }
    return ROTID_OK;
}

/* Set 55 in two parts: to record 6, which describes the data; the rest, or nothing more. */
static int uff_read_shape_rest(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape)
{
    struct uff_lines *lines = &reader->lines;
    int type = shape->data_type, components = shape->component_count;
    if (type != REAL_DATA && type != COMPLEX_DATA)
        return uff_end(reader, uff_fail(lines, 0, "record 6: data type %d; expected 2 (real) or 5 (complex)", type), UFF_BETWEEN);
    if (components < 1 || components > 6)
        return uff_end(reader, uff_fail(lines, 0, "record 6: %d values per node; expected 1 to 6", components), UFF_BETWEEN);

    struct growing growing = {0};
    pool_open(&growing.scratch, reader->allocator);
    int status = read_mode(lines, shape);
    if (status == ROTID_OK)
        status = read_values(reader, &growing, shape);
    if (status == ROTID_OK && shape->node_count)
        status = refuse_repeated_nodes(lines, &growing, shape->node_count);
    if (status == ROTID_OK && !shape->node_count)
        uff_warn(lines, "no nodes, which means that all values are zero");
    if (status == ROTID_OK)
        status = keep_values(&growing, pool, shape);
    pool_close(&growing.scratch);
    return uff_end(reader, status, UFF_BETWEEN);
}

int uff_read_shape_set(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape)
{
    int status = uff_read_shape_kind(reader, shape);
    return status == ROTID_OK ? uff_read_shape_rest(reader, pool, shape) : status;
}

/* Set 15 has six digits: the same node in set 2411 differs in the last of them. */
static int is_same_place(const double *a, const double *b)
{
    for (int i = 0; i < 3; ++i)
        if (fabs(a[i] - b[i]) > 1e-5 * fmax(fabs(a[i]), fabs(b[i])))
            return 0;
    return 1;
}

static int check_repeated(const char *path, const struct uff_placed_node *first, const struct uff_placed_node *again,
                          struct message_list *messages)
{
    const char *wrong = NULL;
    if (first->set_line == again->set_line)
        wrong = "occurs twice in the set";
    else if (!is_same_place(first->node.x, again->node.x))
        wrong = "was elsewhere in an earlier set";
    if (!wrong)
        return ROTID_OK;
    return message_refuse(messages, ROTID_ERROR_SYNTAX, path, again->line, 1, "set %d: node %d %s, line %d", again->set,
                          again->node.id, wrong, first->line);
}

/* All nodes of the list to *out, those of several sets joined. The same id twice in a set, or in two sets with different
 * coordinates, is an error at its line of `path`. ROTID_OK, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY. */
static int uff_join_nodes(struct pool *pool, struct pool *scratch, const char *path, const struct uff_node_list *list,
                          struct message_list *messages, struct uff_file *out)
{
    const struct uff_label *label = uff_sort_labels(scratch, list->count, &list->item->node.id, sizeof *list->item);
    char *dropped = POOL_ARRAY(scratch, char, list->count);
    if (!label || !dropped)
        return ROTID_ERROR_MEMORY;
    int kept = list->count;
    for (int i = 1; i < list->count; ++i) {
        if (label[i].id != label[i - 1].id)
            continue;
        int status = check_repeated(path, &list->item[label[i - 1].order], &list->item[label[i].order], messages);
        if (status != ROTID_OK)
            return status;
        dropped[label[i].order] = 1; /* the first one stays */
        --kept;
    }

    out->node = POOL_ARRAY(pool, struct uff_node, kept);
    if (!out->node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < list->count; ++i)
        if (!dropped[i])
            out->node[out->node_count++] = list->item[i].node;
    return ROTID_OK;
}

/* ---- the nodes and shapes of a file, for decks */

#define SKIP_LIMIT 32
struct skip { /* sets of one type that were not read */
    char what[80];
    int line, count; /* line of the first one */
};

/* One reading. */
struct uff_run {
    struct uff_reader *reader;
    const char *path;
    struct message_list *messages;
    struct pool *pool;   /* of the caller */
    struct pool scratch; /* ends with the job */
    struct uff_node_list nodes;
    struct uff_file *out;
    struct skip skip[SKIP_LIMIT];
    int skip_count, skip_others;
};

/* Remembers that the set at `line` was not read: the format gives its name, such as "set 151". */
__attribute__((format(printf, 3, 4))) static void note_skip(struct uff_run *job, int line, const char *format, ...)
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
        message_add(job->messages, SEVERITY_NOTE, job->path, skip->line, 1,
                    skip->count == 1 ? "%s skipped" : "%s skipped, %d times from here on", skip->what, skip->count);
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
    if (analysis != NORMAL_MODE && analysis != FREQUENCY_RESPONSE && !uff_has_eigenvalue(shape)) {
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
    struct uff_file *out = job->out;
    int failed = is_extra ? POOL_ADD(job->pool, out->extra, out->extra_count, &shape)
                          : POOL_ADD(job->pool, out->shape, out->shape_count, &shape);
    return failed ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int read_nodes(struct uff_run *job, const struct uff_set *set)
{
    struct uff_node_list *list = &job->nodes;
    int before = list->count, status = uff_append_nodes(job->reader, &job->scratch, list);
    for (int i = before; i < list->count && set->number == 15; ++i)
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

int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out)
{
    struct uff_run job = {.path = path, .messages = messages, .pool = pool, .out = out};
    *out = (struct uff_file){0};
    pool_open(&job.scratch, pool->allocator);

    int status = uff_open(&job.scratch, path, messages, &job.reader);
    if (status == ROTID_OK) {
        status = read_sets(&job);
        say_skipped(&job);
        uff_close(job.reader);
    }
    if (status == ROTID_OK && job.nodes.count)
        status = uff_join_nodes(pool, &job.scratch, path, &job.nodes, messages, out);
    pool_close(&job.scratch);

    if (messages->pool->out_of_memory)
        status = ROTID_ERROR_MEMORY;
    if (status != ROTID_OK)
        *out = (struct uff_file){0};
    return status;
}

int uff_is_mode(const struct uff_shape *shape)
{
    return shape->analysis_type != FREQUENCY_RESPONSE; /* an operating shape */
}

ORDER_BY(by_frequency, struct uff_shape *const, (*it)->frequency_hz, 0)

/* A complex eigenvalue comes with its conjugate; two real modes of one frequency are two modes. */
static int is_conjugate(const struct uff_shape *a, const struct uff_shape *b)
{
    return a->is_complex && b->is_complex && fabs(a->frequency_hz - b->frequency_hz) <= 1e-9 * a->frequency_hz;
}

int uff_choose_modes(const struct uff_file *file, const struct uff_shape **chosen, int *rigid, int *conjugates)
{
    int count = 0, kept = 0;
    *rigid = 0;
    for (int k = 0; k < file->shape_count; k++) {
        if (uff_is_mode(&file->shape[k]) && file->shape[k].frequency_hz > 0)
            chosen[count++] = &file->shape[k];
        else
            *rigid += uff_is_mode(&file->shape[k]);
    }
    if (count)
        qsort(chosen, (size_t)count, sizeof *chosen, by_frequency);
    for (int k = 0; k < count; k++)
        if (!kept || !is_conjugate(chosen[k], chosen[kept - 1]))
            chosen[kept++] = chosen[k];
    *conjugates = count - kept;
    return kept;
}

void uff_mode_numbers(const struct uff_file *file, int count, const struct uff_shape *const *chosen, int *number)
{
    int all = 0, distinct = 0, numbered = 1;
    for (int k = 0; k < count; k++)
        numbered = numbered && chosen[k]->number > (k ? chosen[k - 1]->number : 0);
    for (int k = 0; k < file->shape_count && numbered; k++) /* also of those that are left out */
        if (uff_is_mode(&file->shape[k]) && file->shape[k].number > 0)
            number[all++] = file->shape[k].number;
    sort_ints((size_t)all, number);
    for (int i = 0; i < all; i++)
        if (!distinct || number[i] != number[distinct - 1])
            number[distinct++] = number[i];
    for (int k = 0, below = 0; k < count; k++, below++) { /* what is written lies behind what is read, k <= below */
        while (numbered && number[below] < chosen[k]->number)
            below++;
        number[k] = numbered ? chosen[k]->number - (below - k) : k + 1;
    }
}

double uff_mode_frequency(const struct uff_shape *mode)
{
    double hz;
    for (int i = 0; i < UFF_ID_LINES; i++)
        if (sscanf(mode->id[i], "ROTID FREQUENCY_HZ %lf", &hz) == 1 && fabs(hz - mode->frequency_hz) < 1e-5 * mode->frequency_hz)
            return hz;
    return mode->frequency_hz;
}

double uff_real_shape(const struct uff_shape *mode, int component, double *value)
{
    int n = mode->node_count, step = mode->component_count;
    double xx = 0, yy = 0, xy = 0, left = 0;
    for (int i = 0; i < n; i++) {
        double x = mode->real[i * step + component], y = mode->imag ? mode->imag[i * step + component] : 0;
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    double turn = mode->imag ? -0.5 * atan2(2 * xy, xx - yy) : 0;
    for (int i = 0; i < n; i++) {
        double x = mode->real[i * step + component], y = mode->imag ? mode->imag[i * step + component] : 0;
        value[i] = mode->imag ? x * cos(turn) - y * sin(turn) : x;
        left += mode->imag ? pow(x * sin(turn) + y * cos(turn), 2) : 0;
    }
    return xx + yy > 0 ? left / (xx + yy) : 0;
}

enum uff_extra uff_extra_of(const struct uff_shape *set, int *number)
{
    static const char *const title[UFF_EXTRAS] = {[UFF_EXTRA_SHAPE_STD] = "ROTID STANDARD DEVIATION OF MODE ",
                                                  [UFF_EXTRA_POINT] = "ROTID FREQUENCY AT POINT OF MODE ",
                                                  [UFF_EXTRA_POINT_STD] =
                                                      "ROTID STANDARD DEVIATION OF FREQUENCY AT POINT OF MODE "};
    enum uff_extra kind = 0;
    while (kind < UFF_EXTRAS && strncmp(set->id[0], title[kind], strlen(title[kind])) != 0)
        kind++;
    const char *rest = kind < UFF_EXTRAS ? set->id[0] + strlen(title[kind]) : "";
    char *end;
    long of = strtol(rest, &end, 10); /* the end of the text is one whole number above zero */
    *number = end != rest && !*end && of > 0 && of <= 1000000 ? (int)of : 0;
    return kind;
}

int uff_extra_count(const struct uff_shape *set, int *tests)
{
    int count;
    *tests = sscanf(set->id[2], "TESTS %d", &count) == 1;
    return (*tests || sscanf(set->id[2], "IMPACTS %d", &count) == 1) && count > 0 ? count : 0;
}

int uff_extra_is_known(const struct uff_shape *set, int i)
{
    int known = 0;
    for (int c = 0; c < set->component_count; c++)
        known |= set->real[(ptrdiff_t)i * set->component_count + c] > 0;
    return known;
}

int uff_extra_frequency_std(const struct uff_shape *set, double *hz)
{
    double damping; /* nothing needs its deviation yet, but it has to be one */
    int length = 0;
    return sscanf(set->id[1], "FREQUENCY_HZ %lf DAMPING %lf%n", hz, &damping, &length) != 2 || set->id[1][length] ||
           !(isfinite(*hz) && *hz >= 0 && isfinite(damping) && damping >= 0);
}
