/* A universal file: the struct of its JSON, its modes as tables, and what `rotid uff` shows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"

static const char *text_or_null(const char *text)
{
    return *text ? text : NULL;
}

static struct listed_axis axis(const struct uff_axis *axis)
{
    return (struct listed_axis){axis->specific_type, text_or_null(axis->label), text_or_null(axis->unit)};
}

/* NULL: memory is out; of all below. */
static struct listed_set *sets(struct pool *pool, const struct listing *listing)
{
    struct listed_set *list = POOL_ARRAY(pool, struct listed_set, listing->set_count);
    for (int i = 0; i < listing->set_count && list; ++i) {
        const struct listing_set *set = &listing->set[i];
        list[i] = (struct listed_set){.line = set->set.line,
                                      .set = set->set.number,
                                      .binary = set->set.is_binary,
                                      .name = name_of_set(set->set.number),
                                      .state = set->is_faulty                 ? "malformed"
                                               : set->is_read                 ? "read"
                                               : name_of_set(set->set.number) ? "read_over"
                                                                              : "not_known",
                                      .count = (double)set->size};
    }
    return list;
}

static struct listed_function *functions(struct pool *pool, const struct listing *listing)
{
    struct listed_function *list = POOL_ARRAY(pool, struct listed_function, listing->function_count);
    for (int i = 0; i < listing->function_count && list; ++i) {
        const struct uff_function *f = &listing->function[i].function;
        const struct values *v = &listing->function[i].values;
        int timed = has_time_axis(f);
        char place[2][PLACE_MOST];
        list[i] = (struct listed_function){
            .line = f->line,
            .type = f->type,
            .kind = name_of_function(f->type, 0),
            .response = pool_copy_text(pool, place_text(f->response_node, f->response_direction, place[0])),
            .reference = pool_copy_text(pool, place_text(f->reference_node, f->reference_direction, place[1])),
            .response_node = f->response_node,
            .response_direction = f->response_direction,
            .reference_node = f->reference_node,
            .reference_direction = f->reference_direction,
            .ordinate = f->ordinate,
            .ordinate_name = name_of_ordinate(f->ordinate),
            .binary = f->binary.is_binary,
            .count = (double)f->count,
            .even = f->is_even,
            .start = v->x_first,
            .step = f->is_even ? f->step : NAN,
            .end = v->x_last,
            .time = timed,
            .sampling_rate_hz = timed && f->is_even ? 1 / (f->step * listing->function[i].x_si_factor) : NAN,
            .abscissa = axis(&f->abscissa),
            .numerator = axis(&f->numerator),
            .denominator = axis(&f->denominator),
            .si_factor = listing->function[i].si_factor,
            .abscissa_si_factor = listing->function[i].x_si_factor,
            .min = v->count ? v->min : NAN,
            .max = v->count ? v->max : NAN,
            .rms = v->count ? v->rms : NAN,
            .nfirst = v->count ? 2 : 0,
            .nlast = v->count ? 2 : 0,
            .first = v->first,
            .last = v->last,
            .sum = {v->sum[0], v->sum[1]},
        };
        for (int k = 0; k < LISTED_ID_LINES; ++k)
            list[i].id[k] = text_or_null(f->id[k]);
        if (!list[i].response || !list[i].reference)
            return NULL;
    }
    return list;
}

static struct listed_shape *shapes(struct pool *pool, const struct listing *listing)
{
    struct listed_shape *list = POOL_ARRAY(pool, struct listed_shape, listing->shape_count);
    for (int i = 0; i < listing->shape_count && list; ++i) {
        const struct listing_shape *entry = &listing->shape[i];
        const struct uff_shape *s = &entry->shape;
        int values = s->component_count * s->node_count;
        list[i] = (struct listed_shape){.line = s->line,
                                        .analysis_type = s->analysis_type,
                                        .analysis = name_of_analysis(s->analysis_type),
                                        .mode = s->number,
                                        .frequency_hz = s->frequency_hz,
                                        .damping = s->damping,
                                        .is_complex = s->is_complex,
                                        .components = s->component_count,
                                        .node_count = s->node_count,
                                        .sum = {entry->sum[0], entry->sum[1]},
                                        .rms = entry->rms,
                                        .nnodes = s->node_count,
                                        .nodes = s->node,
                                        .nreal = values,
                                        .real = s->real,
                                        .nimag = s->imag ? values : 0,
                                        .imag = s->imag};
        for (int k = 0; k < LISTED_ID_LINES; ++k)
            list[i].id[k] = text_or_null(s->id[k]);
    }
    return list;
}

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

static int add_doubts(struct pool *pool, const struct listing *listing, struct uff_result *out)
{
    out->doubtful = POOL_ARRAY(pool, struct listed_doubt, listing->finding_count);
    for (int i = 0; i < listing->finding_count && out->doubtful; ++i) {
        const struct listing_finding *doubt = &listing->doubt[i];
        out->doubtful[out->ndoubtful++] =
            (struct listed_doubt){doubt->kind, doubt->line > 0 ? doubt->line : ROTID_NONE, doubt->text};
    }
    return out->doubtful != NULL;
}

/* What stopped the reader in malformed sets, with its place. */
static int add_errors(struct pool *pool, const struct message_list *messages, struct uff_result *out)
{
    out->errors = POOL_ARRAY(pool, struct listed_error, messages->count);
    for (size_t i = 0; i < messages->count && out->errors; ++i) {
        const rotid_message *message = &messages->item[i];
        if (message->severity == SEVERITY_ERROR)
            out->errors[out->nerrors++] = (struct listed_error){message->line, message->column, message->text};
    }
    return out->errors != NULL;
}

static struct listed_header *header(struct pool *pool, const struct uff_header *h)
{
    struct listed_header *out = POOL_NEW(pool, struct listed_header);
    if (out)
        *out = (struct listed_header){text_or_null(h->model),   text_or_null(h->description), text_or_null(h->program),
                                      text_or_null(h->created), text_or_null(h->saved),       text_or_null(h->written_by),
                                      text_or_null(h->written)};
    return out;
}

static struct listed_units *units(struct pool *pool, const struct uff_units *u)
{
    struct listed_units *out = POOL_NEW(pool, struct listed_units);
    if (out)
        *out = (struct listed_units){u->code,  name_of_units(u->code), text_or_null(u->description), u->length,
                                     u->force, u->temperature,         u->temperature_offset};
    return out;
}

const struct uff_result *uff_result_of(struct pool *pool, const char *path, const struct listing *listing, int summary_count,
                                       const char *const *summary, int all, const struct message_list *messages)
{
    struct uff_result *out = POOL_NEW(pool, struct uff_result);
    if (!out)
        return NULL;
    *out = (struct uff_result){.file = path,
                               .nsummary = summary_count,
                               .summary = summary,
                               .nsets = listing->set_count,
                               .nfunctions = listing->function_count,
                               .nshapes = listing->shape_count,
                               .header = listing->header ? header(pool, listing->header) : NULL,
                               .units = listing->units ? units(pool, listing->units) : NULL,
                               .sets = sets(pool, listing),
                               .functions = functions(pool, listing),
                               .shapes = shapes(pool, listing)};
    int whole =
        (out->header || !listing->header) && (out->units || !listing->units) && out->sets && out->functions && out->shapes;
    whole =
        whole && add_nodes(pool, listing, all, &out->nodes) && add_doubts(pool, listing, out) && add_errors(pool, messages, out);
    return whole ? out : NULL;
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

/* Index among the nodes. */
static int find_node(const struct universal *u, int id)
{
    const struct uff_node key = {.id = id}, *found = bsearch(&key, u->node, (size_t)u->nnode, sizeof *u->node, by_id);
    return (int)(found - u->node);
}

/* Those of all modes, without coordinates where the file has none of them. */
static int take_nodes(struct pool *pool, const struct uff_file *file, struct universal *u)
{
    size_t count = 0;
    struct uff_node *known = POOL_ARRAY(pool, struct uff_node, file->node_count);
    for (int k = 0; k < u->count; k++)
        count += (size_t)u->mode[k]->node_count;
    u->node = POOL_ARRAY(pool, struct uff_node, count);
    if (!known || !u->node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < file->node_count; i++)
        known[i] = file->node[i];
    if (file->node_count)
        qsort(known, (size_t)file->node_count, sizeof *known, by_id);
    count = 0;
    for (int k = 0; k < u->count; k++)
        for (int i = 0; i < u->mode[k]->node_count; i++)
            u->node[count++].id = u->mode[k]->node[i];
    if (count)
        qsort(u->node, count, sizeof *u->node, by_id);
    for (size_t i = 0; i < count; i++)
        if (!u->nnode || u->node[i].id != u->node[u->nnode - 1].id)
            u->node[u->nnode++].id = u->node[i].id;
    for (int n = 0; n < u->nnode; n++) {
        const struct uff_node *at =
            file->node_count ? bsearch(&u->node[n], known, (size_t)file->node_count, sizeof *known, by_id) : NULL;
        for (int a = 0; a < 3; a++)
            u->node[n].x[a] = at ? at->x[a] : NAN;
    }
    return ROTID_OK;
}

/* The value of a node in which all modes together, each to its largest value, move most. */
static int largest_direction(const struct universal *u)
{
    double sum[6] = {0};
    int most = 0;
    for (int k = 0; k < u->count; k++) {
        const struct uff_shape *mode = u->mode[k];
        double of[6] = {0}, all = 0;
        for (int i = 0; i < mode->node_count * mode->component_count; i++) {
            int c = mode->component_count == 1 ? 0 : i % mode->component_count;
            double square = mode->real[i] * mode->real[i] + (mode->imag ? mode->imag[i] * mode->imag[i] : 0);
            of[c] += square;
            all += square;
        }
        for (int c = 0; c < mode->component_count && mode->component_count > 1 && all > 0; c++)
            sum[c] += of[c] / all;
    }
    for (int c = 1; c < 3; c++)
        most = sum[c] > sum[most] ? c : most;
    return most;
}

static int component_of(const struct universal *u, const struct uff_shape *shape)
{
    return shape->component_count == 1 ? 0 : u->direction < shape->component_count ? u->direction : -1;
}

/* The standard deviations of a mode, relative to its largest value. */
static void take_std(struct universal *u, const struct uff_shape *set, int component, int k)
{
    double hz, largest = 0, *std = u->std + (ptrdiff_t)k * u->nnode;
    if (!uff_extra_frequency_std(set, &hz) && hz > 0)
        u->frequency_std[k] = hz;
    for (int n = 0; n < u->nnode; n++)
        largest = fmax(largest, fabs(u->value[n + (ptrdiff_t)k * u->nnode]));
    for (int m = 0; m < set->node_count; m++) {
        const struct uff_node key = {.id = set->node[m]}, *at = bsearch(&key, u->node, (size_t)u->nnode, sizeof key, by_id);
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
    u->value = POOL_ARRAY(pool, double, count);
    u->std = POOL_ARRAY(pool, double, count);
    if (!u->value || !u->std)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        u->value[i] = u->std[i] = NAN;
    for (int k = 0; k < u->count; k++) {
        double *value = POOL_ARRAY(pool, double, u->mode[k]->node_count);
        int c = component_of(u, u->mode[k]);
        if (!value)
            return ROTID_ERROR_MEMORY;
        if (c >= 0)
            (void)uff_real_shape(u->mode[k], c, value);
        for (int i = 0; i < u->mode[k]->node_count && c >= 0; i++)
            u->value[find_node(u, u->mode[k]->node[i]) + (ptrdiff_t)k * u->nnode] = value[i];
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
    u->frequency_std = POOL_ARRAY(pool, double, file.shape_count);
    if (!u->mode || !u->number || !u->frequency_std)
        return ROTID_ERROR_MEMORY;
    u->count = uff_choose_modes(&file, u->mode, &rigid, &conjugates);
    if (!u->count)
        return message_refuse(messages, ROTID_ERROR_SYNTAX, path, 1, 1,
                              "the file has no mode shapes, expected sets 55 of normal or complex modes for --csv");
    uff_mode_numbers(&file, u->count, u->mode, u->number);
    for (int k = 0; k < u->count; k++)
        u->frequency_std[k] = NAN;
    u->direction = largest_direction(u);
    status = take_nodes(pool, &file, u);
    return status ? status : take_shapes(pool, u, &file);
}

static struct table *table_of_modes(struct pool *pool, const struct universal *u)
{
    struct table *table = table_open(pool, "");
    for (int k = 0; k < u->count; k++) {
        table_row(table);
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
        table_row(table);
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
    char response[PLACE_MOST], last[PLACE_MOST], reference[PLACE_MOST];
    (void)place_text(f->function.response_node, f->function.response_direction, response);
    (void)place_text(g->function.response_node, g->function.response_direction, last);
    (void)place_text(f->function.reference_node, f->function.reference_direction, reference);
    return pool_text(pool, "%s%s%s%s%s", response, f == g ? "" : " ... ", f == g ? "" : last,
                     f->function.reference_node ? " / " : "", f->function.reference_node ? reference : "");
}

/* "complex double, m/s/N, times 0.001 in SI" */
static const char *values_of(struct pool *pool, const struct listing_function *f)
{
    const char *above = f->function.numerator.unit, *below = f->function.denominator.unit;
    return pool_text(pool, "%s%s%s%s%s%s%s%s%s", name_of_ordinate(f->function.ordinate),
                     f->function.binary.is_binary ? ", binary" : "", *above || *below ? ", " : "", clean(pool, above),
                     *below ? "/" : "", clean(pool, below), f->si_factor != 1 ? ", times " : "",
                     f->si_factor != 1 ? IN_DIGITS(6, f->si_factor) : "", f->si_factor != 1 ? " in SI" : "");
}

/* What the sets of a row hold that are no functions. */
static const char *contents_of(struct pool *pool, const struct listing *listing, struct row row)
{
    const struct listing_set *set = &listing->set[row.first];
    long long size = 0;
    for (int i = row.first; i <= row.last; ++i)
        size += listing->set[i].size;
    if (set->set.number == 55 && set->item >= 0) {
        const struct uff_shape *first = &listing->shape[set->item].shape;
        const struct uff_shape *last = &listing->shape[listing->set[row.last].item].shape;
        const char *what = pool_text(pool, "%s, %d points, %s, %s", name_of_analysis(first->analysis_type), first->node_count,
                                     first->is_complex ? "complex" : "real", IN_DIGITS(6, first->frequency_hz));
        if (row.first == row.last)
            return pool_text(pool, "%s Hz, damping %s", what, IN_DIGITS(4, first->damping));
        return pool_text(pool, "%s to %s Hz", what, IN_DIGITS(6, last->frequency_hz));
    }
    if (set->set.number == 164 && listing->units)
        return pool_text(pool, "%s %s", name_of_units(listing->units->code), clean(pool, listing->units->description));
    if (set->set.number == 151 && listing->header)
        return clean(pool, listing->header->model);
    if (set->is_read)
        return pool_text(pool, "%lld in all", size);
    return name_of_set(set->set.number) && !set->is_faulty ? "read over" : "";
}

static struct table *table_of_sets(struct pool *pool, const struct listing *listing, int all)
{
    struct table *table = table_open(pool, "");
    int rows = 0, next = 0;
    for (struct row row; next < listing->set_count && (all || rows < ROWS_MOST); ++rows, next = row.last + 1) {
        row = take_row(listing, next, all);
        const struct listing_set *set = &listing->set[row.first];
        const struct listing_function *f = function_of(listing, row.first), *g = function_of(listing, row.last);
        const char *name = f ? name_of_function(f->function.type, row.last > row.first) : name_of_set(set->set.number);
        double min = INFINITY, max = -INFINITY, rms = 0;
        for (int i = row.first; i <= row.last && f; ++i) {
            const struct values *v = &function_of(listing, i)->values;
            min = fmin(min, v->min);
            max = fmax(max, v->max);
            rms = fmax(rms, v->rms);
        }
        table_row(table);
        number_column(table, "line", NULL, SHOW_COUNT, set->set.line);
        text_column(table, "set", SHOW_TEXT, pool_text(pool, "%d%s", set->set.number, set->set.is_binary ? "b" : ""));
        number_column(table, "count", NULL, SHOW_COUNT, row.last - row.first + 1);
        text_column(table, "what", SHOW_TEXT, set->is_faulty ? "MALFORMED" : name ? name : "not known");
        text_column(table, "response / reference", SHOW_TEXT, f ? places_of(pool, f, g) : "");
        number_column(table, "values", NULL, SHOW_COUNT, f ? (double)f->function.count : NAN);
        number_column(table, "from", NULL, SHOW_DIGITS(6), f ? f->values.x_first * f->x_si_factor : NAN);
        number_column(table, "step", NULL, SHOW_DIGITS(6), f && f->function.is_even ? f->function.step * f->x_si_factor : NAN);
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
        if (doubt->line)
            (void)snprintf(head, sizeof head, "  line %d: ", doubt->line);
        wrap_text(out, 4, WIDTH, head, doubt->text);
    }
}
