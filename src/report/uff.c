/* A universal file: the struct of its JSON, its modes as tables, and what `rotid uff` shows. */
#include "report/report.h"

/* 0: memory is out. */
static int add_nodes(struct pool *pool, const struct listing *listing, int all, struct listed_nodes *out)
{
    int n = listing->node_count;
    *out = (struct listed_nodes){.count = n, .min = {NAN, NAN, NAN}, .max = {NAN, NAN, NAN}, .nids = n, .nx = 3};
    int *ids = all ? POOL_ARRAY(pool, int, n) : NULL;
    double *coordinates = all ? POOL_ARRAY(pool, double, 3 * (size_t)n) : NULL;
    out->ids = ids;
    out->x = coordinates;
    if (all && (!ids || !coordinates))
        return 0;
    for (int i = 0; i < n; ++i) {
        const double *x = listing->node[i].x;
        for (int c = 0; c < 3; ++c) {
            out->min[c] = fmin(out->min[c], x[c]); /* fmin and fmax pass over what is not a number */
            out->max[c] = fmax(out->max[c], x[c]);
            if (all)
                coordinates[i + (ptrdiff_t)c * n] = x[c];
        }
        if (all)
            ids[i] = listing->node[i].id;
    }
    return 1;
}

/* What stopped the reader in malformed sets, with its place. */
static int add_errors(struct pool *pool, const struct message_list *messages, struct uff_result *out)
{
    out->errors = POOL_ARRAY(pool, rotid_message, messages->count);
    for (size_t i = 0; i < messages->count && out->errors; ++i)
        if (messages->item[i].severity == SEVERITY_ERROR)
            out->errors[out->nerrors++] = messages->item[i];
    return out->errors != NULL;
}

const struct uff_result *uff_result_of(struct pool *pool, const char *path, const struct listing *listing, int summary_count,
                                       const char *const *summary, int all, const struct message_list *messages)
{
    struct uff_result *out = POOL_NEW(pool, struct uff_result);
    if (!out)
        return NULL;
    *out = (struct uff_result){.file = path, .nsummary = summary_count, .summary = summary, .listing = listing};
    return add_nodes(pool, listing, all, &out->nodes) && add_errors(pool, messages, out) ? out : NULL;
}

/* ---- modes of a universal file as tables */

struct universal {
    int count, nnode, direction, points; /* direction, points: as of the tables */
    const struct uff_shape **mode;
    int *number;           /* [count] */
    double *frequency_std; /* [count] Hz, NaN where it is not known */
    double *value, *std;   /* [nnode * count] a mode after the other; std relative to its largest value */
    struct uff_node *node; /* [nnode] by their ids; coordinates in the unit of the file, NaN where it has none */
};

ORDER_BY(by_id, struct uff_node, it->id, 0)

/* NULL where no mode has it. */
static struct uff_node *node_of(const struct universal *u, int id)
{
    const struct uff_node key = {.id = id};
    return u->nnode ? bsearch(&key, u->node, (size_t)u->nnode, sizeof *u->node, by_id) : NULL;
}

/* Those of all modes, without coordinates where the file has none of them. */
static int take_nodes(struct pool *pool, const struct uff_file *file, struct universal *u)
{
    size_t count = 0;
    for (int k = 0; k < u->count; k++)
        count += (size_t)u->mode[k]->node_count;
    if (!(u->node = POOL_ARRAY(pool, struct uff_node, count)))
        return ROTID_ERROR_MEMORY;
    count = 0;
    for (int k = 0; k < u->count; k++)
        for (int i = 0; i < u->mode[k]->node_count; i++)
            u->node[count++] = (struct uff_node){.id = u->mode[k]->node[i], .x = {NAN, NAN, NAN}};
    if (count)
        qsort(u->node, count, sizeof *u->node, by_id);
    for (size_t i = 0; i < count; i++)
        if (!u->nnode || u->node[i].id != u->node[u->nnode - 1].id)
            u->node[u->nnode++] = u->node[i];
    for (int i = 0; i < file->node_count; i++) {
        struct uff_node *at = node_of(u, file->node[i].id);
        if (at)
            *at = file->node[i];
    }
    return ROTID_OK;
}

/* Shares of the directions in the squares of a mode of several values at a node; zeros of one value. */
static void shares_of(const struct uff_shape *mode, double share[6])
{
    double all = 0;
    memset(share, 0, 6 * sizeof *share);
    if (mode->component_count == 1)
        return;
    for (int i = 0; i < mode->node_count * mode->component_count; i++) {
        double square = mode->real[i] * mode->real[i] + (mode->imag ? mode->imag[i] * mode->imag[i] : 0);
        share[i % mode->component_count] += square;
        all += square;
    }
    for (int c = 0; c < 6 && all > 0; c++)
        share[c] /= all;
}

static int largest_of(const double share[6])
{
    int most = 0;
    for (int c = 1; c < 3; c++)
        most = share[c] > share[most] ? c : most;
    return most;
}

/* The value of a node in which all modes together move most. Modes that move more in another one are warned of. */
static int largest_direction(const struct universal *u, const char *path, struct message_list *messages)
{
    double sum[6] = {0}, share[6];
    for (int k = 0; k < u->count; k++) {
        shares_of(u->mode[k], share);
        for (int c = 0; c < 6; c++)
            sum[c] += share[c];
    }
    int direction = largest_of(sum);
    for (int k = 0; k < u->count; k++) {
        shares_of(u->mode[k], share);
        if (share[largest_of(share)] > share[direction])
            message_add(
                messages, SEVERITY_WARNING, path, 1, 1,
                "mode %d moves most along %c, written is what it moves along %c as the modes together do: expected a file "
                "for each plane",
                u->number[k], "xyz"[largest_of(share)], "xyz"[direction]);
    }
    return direction;
}

static int component_of(const struct universal *u, const struct uff_shape *shape)
{
    return shape->component_count == 1 ? 0 : u->direction < shape->component_count ? u->direction : -1;
}

/* The standard deviations of a mode, relative to its largest value. */
static void take_std(struct universal *u, const struct uff_shape *set, int component, int k)
{
    double hz, largest = largest_magnitude(u->nnode, u->value + (ptrdiff_t)k * u->nnode), *std = u->std + (ptrdiff_t)k * u->nnode;
    if (!uff_extra_frequency_std(set, &hz) && hz > 0)
        u->frequency_std[k] = hz;
    for (int m = 0; m < set->node_count; m++) {
        const struct uff_node *at = node_of(u, set->node[m]);
        double deviation = set->real[m * set->component_count + component];
        double *value = &u->value[(at ? at - u->node : 0) + (ptrdiff_t)k * u->nnode];
        if (at && deviation > 0 && largest > 0)
            std[at - u->node] = deviation / largest;
        else if (at && *value == 0 && uff_extra_is_known(set, m))
            *value = NAN;
    }
}

static void take_extra(struct universal *u, const struct uff_shape *set)
{
    int number, component = component_of(u, set);
    enum uff_extra kind = uff_extra_of(set, &number);
    u->points |= kind == UFF_EXTRA_POINT;
    for (int k = 0; k < u->count && kind == UFF_EXTRA_SHAPE_STD && component >= 0; k++)
        if (u->mode[k]->number == number)
            take_std(u, set, component, k);
}

static int take_shapes(struct pool *pool, struct universal *u, const struct uff_file *file)
{
    size_t count = (size_t)u->count * (size_t)u->nnode;
    u->value = pool_unknown(pool, count);
    u->std = pool_unknown(pool, count);
    if (!u->value || !u->std)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < u->count; k++) {
        double *value = POOL_ARRAY(pool, double, u->mode[k]->node_count);
        int c = component_of(u, u->mode[k]);
        if (!value)
            return ROTID_ERROR_MEMORY;
        if (c >= 0)
            (void)uff_real_shape(u->mode[k], c, value);
        for (int i = 0; i < u->mode[k]->node_count && c >= 0; i++)
            u->value[node_of(u, u->mode[k]->node[i]) - u->node + (ptrdiff_t)k * u->nnode] = value[i];
    }
    for (int i = 0; i < file->extra_count; i++)
        take_extra(u, &file->extra[i]);
    return ROTID_OK;
}

static int read_universal(struct pool *pool, const char *path, struct message_list *messages, struct universal *u)
{
    struct uff_file file;
    int rigid, conjugates, status = uff_read(pool, path, messages, &file);
    *u = (struct universal){0};
    if (status)
        return status;
    u->mode = POOL_ARRAY(pool, const struct uff_shape *, file.shape_count);
    u->number = POOL_ARRAY(pool, int, file.shape_count);
    u->frequency_std = pool_unknown(pool, (size_t)file.shape_count);
    if (!u->mode || !u->number || !u->frequency_std)
        return ROTID_ERROR_MEMORY;
    u->count = uff_choose_modes(&file, u->mode, &rigid, &conjugates);
    if (!u->count)
        return message_refuse(messages, ROTID_ERROR_SYNTAX, path, 1, 1,
                              "the file has no mode shapes, expected sets 55 of normal or complex modes for --csv");
    uff_mode_numbers(&file, u->count, u->mode, u->number);
    u->direction = largest_direction(u, path, messages);
    status = take_nodes(pool, &file, u);
    return status ? status : take_shapes(pool, u, &file);
}

static struct table *table_of_modes(struct pool *pool, const struct universal *u)
{
    struct table *table = table_open(pool, "");
    for (int k = 0; k < u->count; k++) {
        number_column(table, "mode", NULL, SHOW_COUNT, u->number[k]);
        number_column(table, "frequency", "Hz", SHOW_FIXED(3), uff_mode_frequency(u->mode[k]));
        number_column(table, "damping", NULL, SHOW_DIGITS(4), u->mode[k]->damping > 0 ? u->mode[k]->damping : (double)NAN);
        number_column(table, "std", "Hz", SHOW_DIGITS(2), u->frequency_std[k]);
    }
    return table;
}

/* The axis along which the nodes lie, whose coordinates are positions; -1: several, of which all are written; -2: no node has any
 * coordinates. */
static int axis_of(const struct universal *u)
{
    int axis = -1, axes = 0, placed = 0;
    for (int n = 0; n < u->nnode; n++)
        placed |= isfinite(u->node[n].x[0]);
    for (int a = 0; a < 3; a++) {
        int varies = 0;
        for (int n = 1; n < u->nnode; n++)
            varies |= u->node[n].x[a] != u->node[0].x[a];
        axis = varies ? a : axis;
        axes += varies;
    }
    return !placed ? -2 : axes == 1 ? axis : -1;
}

static struct table *table_of_shapes_at_nodes(struct pool *pool, const struct universal *u)
{
    static const char *const axes[] = {"x", "y", "z"};
    int axis = axis_of(u), any_std = 0;
    struct table *table = table_open(pool, "");
    for (ptrdiff_t i = 0; i < (ptrdiff_t)u->nnode * u->count; i++)
        any_std |= isfinite(u->std[i]);
    for (int n = 0; n < u->nnode; n++) {
        number_column(table, "sensor", NULL, SHOW_COUNT, u->node[n].id);
        for (int a = 0; a < 3; a++)
            if (a == axis || axis == -1)
                number_column(table, a == axis ? "position" : axes[a], NULL, SHOW_DIGITS(6), u->node[n].x[a]);
        for (int k = 0; k < u->count; k++) {
            const char *name = n ? "" : pool_text(pool, "mode %d", u->number[k]);
            number_column(table, name, NULL, SHOW_FIXED(5), u->value[n + (ptrdiff_t)k * u->nnode]);
            if (any_std)
                number_column(table, n ? "" : pool_text(pool, "%s std", name), NULL, SHOW_DIGITS(2),
                              u->std[n + (ptrdiff_t)k * u->nnode]);
        }
    }
    return table;
}

int uff_tables_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_tables *tables)
{
    struct universal u;
    int status = read_universal(pool, path, messages, &u);
    if (!status)
        *tables = (struct uff_tables){{table_of_modes(pool, &u), table_of_shapes_at_nodes(pool, &u)}, u.direction, u.points};
    return status;
}

/* ---- the screen */

#define ROWS_MOST 40
#define WIDTH     130

/* Sets from `first` to `last`, alike and one after the other. */
struct row {
    int first, last;
};

static const struct listing_function *function_of(const struct listing *listing, int set)
{
    const struct listing_set *s = &listing->set[set];
    return s->set.number == 58 && s->item >= 0 ? &listing->function[s->item] : NULL;
}

static int alike(const struct listing *listing, int a, int b)
{
    const struct listing_set *s = &listing->set[a], *t = &listing->set[b];
    const struct listing_function *f = function_of(listing, a), *g = function_of(listing, b);
    return s->set.number == t->set.number && s->is_read == t->is_read && s->is_faulty == t->is_faulty && !f == !g &&
           (!f || f->group == g->group);
}

static struct row take_row(const struct listing *listing, int first, int all)
{
    struct row row = {first, first};
    while (!all && row.last + 1 < listing->set_count && alike(listing, first, row.last + 1))
        ++row.last;
    return row;
}

/* A unit in Latin-1, such as m/s with a superscript of two, can still be read. */
static const char *clean(struct pool *pool, const char *text)
{
    char *copy = pool_copy_text(pool, text);
    for (size_t bytes, at = 0; copy && copy[at]; at += bytes) {
        if (!text_utf8(copy + at) && (unsigned char)copy[at] == 0xb2)
            copy[at] = '2';
        bytes = text_utf8(copy + at) ? text_utf8(copy + at) : 1;
    }
    return copy ? copy : "";
}

/* "1:+X ... 19:+X / 1:+X": response and reference. */
static const char *places_of(struct pool *pool, const struct listing_function *f, const struct listing_function *g)
{
    return pool_text(pool, "%s%s%s%s%s", f->response, f == g ? "" : " ... ", f == g ? "" : g->response,
                     f->function.reference_node ? " / " : "", f->function.reference_node ? f->reference : "");
}

/* "complex double, m/s/N, times 0.001 in SI" */
static const char *values_of(struct pool *pool, const struct listing_function *f)
{
    const char *above = f->function.numerator.unit, *below = f->function.denominator.unit;
    return pool_text(pool, "%s%s%s%s%s%s%s%s%s", f->ordinate, f->function.binary.is_binary ? ", binary" : "",
                     *above || *below ? ", " : "", clean(pool, above), *below ? "/" : "", clean(pool, below),
                     f->si_factor != 1 ? ", times " : "", f->si_factor != 1 ? human_trimmed(pool, f->si_factor, 6) : "",
                     f->si_factor != 1 ? " in SI" : "");
}

/* What the sets of a row hold that are no functions. */
static const char *contents_of(struct pool *pool, const struct listing *listing, struct row row)
{
    const struct listing_set *set = &listing->set[row.first];
    double size = 0;
    for (int i = row.first; i <= row.last; ++i)
        size += listing->set[i].size;
    if (set->set.number == 55 && set->item >= 0) {
        const struct uff_shape *first = &listing->shape[set->item].shape;
        const struct uff_shape *last = &listing->shape[listing->set[row.last].item].shape;
        const char *what = pool_text(pool, "%s, %d points, %s, %s", listing->shape[set->item].analysis, first->node_count,
                                     first->is_complex ? "complex" : "real", human_trimmed(pool, first->frequency_hz, 6));
        if (row.first == row.last)
            return pool_text(pool, "%s Hz, damping %s", what, human_trimmed(pool, first->damping, 4));
        return pool_text(pool, "%s to %s Hz", what, human_trimmed(pool, last->frequency_hz, 6));
    }
    if (set->set.number == 164 && listing->units)
        return pool_text(pool, "%s %s", name_of_units(listing->units->code), clean(pool, listing->units->description));
    if (set->set.number == 151 && listing->header)
        return clean(pool, listing->header->model);
    if (set->is_read)
        return pool_text(pool, "%.0f in all", size);
    return set->name && !set->is_faulty ? "read over" : "";
}

static struct table *table_of_sets(struct pool *pool, const struct listing *listing, int all)
{
    struct table *table = table_open(pool, "");
    int rows = 0, next = 0;
    for (struct row row; next < listing->set_count && (all || rows < ROWS_MOST); ++rows, next = row.last + 1) {
        row = take_row(listing, next, all);
        const struct listing_set *set = &listing->set[row.first];
        const struct listing_function *f = function_of(listing, row.first), *g = function_of(listing, row.last);
        const char *name = f ? name_of_function(f->function.type, row.last > row.first) : set->name;
        double min = INFINITY, max = -INFINITY, rms = 0;
        for (int i = row.first; i <= row.last && f; ++i) {
            const struct values *v = &function_of(listing, i)->values;
            min = fmin(min, v->min);
            max = fmax(max, v->max);
            rms = fmax(rms, v->rms);
        }
        number_column(table, "line", NULL, SHOW_COUNT, set->set.line);
        text_column(table, "set", SHOW_TEXT, pool_text(pool, "%d%s", set->set.number, set->set.is_binary ? "b" : ""));
        number_column(table, "count", NULL, SHOW_COUNT, row.last - row.first + 1);
        text_column(table, "what", SHOW_TEXT, set->is_faulty ? "MALFORMED" : name ? name : "not known");
        text_column(table, "response / reference", SHOW_TEXT, f ? places_of(pool, f, g) : "");
        number_column(table, "values", NULL, SHOW_COUNT, f ? f->count : NAN);
        number_column(table, "from", NULL, SHOW_DIGITS(6), f ? f->values.x_first * f->x_si_factor : NAN);
        number_column(table, "step", NULL, SHOW_DIGITS(6), f ? f->step * f->x_si_factor : NAN);
        number_column(table, "min", NULL, SHOW_DIGITS(4), f ? min : NAN);
        number_column(table, "max", NULL, SHOW_DIGITS(4), f ? max : NAN);
        number_column(table, "rms", NULL, SHOW_DIGITS(4), f ? rms : NAN);
        text_column(table, "contents", SHOW_TEXT, f ? values_of(pool, f) : contents_of(pool, listing, row));
    }
    if (next < listing->set_count)
        table_note(table, "... and %d more sets; --verbose shows each", listing->set_count - next);
    return table;
}

void screen_uff(const struct screen *to, const char *path, const struct listing *listing, int summary_count,
                const char *const *summary)
{
    FILE *out = to->out;
    (void)fprintf(out, "%s: %d %s\n", path, listing->set_count, human_plural(listing->set_count, "set", "sets"));
    for (int i = 0; i < summary_count; ++i)
        wrap_text(out, 2, WIDTH, "", summary[i]);
    if (listing->units)
        (void)fprintf(out, "units %s: a length in m times %.6g, a force in N times %.6g\n", name_of_units(listing->units->code),
                      listing->units->length, listing->units->force);
    screen_table(to, table_of_sets(to->pool, listing, to->verbose));
    if (listing->function_count)
        screen_say(
            to, "from and step in s or Hz; min and max of the modulus where values are complex; values in the unit of the file");
    if (listing->finding_count)
        (void)fprintf(out, "\ndoubtful places\n");
    for (int i = 0; i < listing->finding_count; ++i) {
        const struct listing_finding *doubt = &listing->doubt[i];
        char head[32] = "  ";
        if (doubt->line != ROTID_NONE)
            (void)snprintf(head, sizeof head, "  line %d: ", doubt->line);
        wrap_text(out, 4, WIDTH, head, doubt->text);
    }
}
