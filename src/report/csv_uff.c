/* Modes of a universal file as tables. */
#include <math.h>
#include <stdlib.h>

#include "report/report.h"
#include "rotid.h"
#include "uff/uff.h"

static int by_id(const void *left, const void *right)
{
    const struct uff_node *a = left, *b = right;
    return (a->id > b->id) - (a->id < b->id);
}

/* Index among the nodes. */
static int find_node(const struct csv_universal *u, int id)
{
    const struct uff_node key = {.id = id}, *found = bsearch(&key, u->node, (size_t)u->nnode, sizeof *u->node, by_id);
    return (int)(found - u->node);
}

/* Those of all modes, without coordinates where the file has none of them. */
static int take_nodes(struct pool *pool, const struct uff_file *file, struct csv_universal *u)
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
static int largest_direction(const struct csv_universal *u)
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

static int component_of(const struct csv_universal *u, const struct uff_shape *shape)
{
    return shape->component_count == 1 ? 0 : u->direction < shape->component_count ? u->direction : -1;
}

/* The standard deviations of a mode, relative to its largest value. */
static void take_std(struct csv_universal *u, const struct uff_shape *set, int component, int k)
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

static void take_extra(struct csv_universal *u, const struct uff_shape *set)
{
    int number, component = component_of(u, set);
    enum uff_extra kind = uff_extra_of(set, &number);
    u->points |= kind == UFF_EXTRA_POINT;
    for (int k = 0; k < u->count && kind == UFF_EXTRA_SHAPE_STD && component >= 0; k++)
        if (u->mode[k]->number == number)
            take_std(u, set, component, k);
}

static int take_shapes(struct pool *pool, struct csv_universal *u, const struct uff_file *file)
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

int csv_universal_read(struct pool *pool, const char *path, struct message_list *messages, struct csv_universal *u)
{
    struct uff_file file;
    int rigid, conjugates, status = uff_read(pool, path, messages, &file);
    *u = (struct csv_universal){0};
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

static int write_modes(FILE *out, struct pool *pool, const void *from)
{
    const struct csv_universal *u = from;
    struct table *table = table_open(pool, "");
    for (int k = 0; k < u->count; k++) {
        table_row(table);
        number_column(table, "mode", NULL, SHOW_COUNT, u->number[k]);
        number_column(table, "frequency", "Hz", SHOW_FIXED(3), uff_mode_frequency(u->mode[k]));
        number_column(table, "damping", NULL, SHOW_DIGITS(4), u->mode[k]->damping > 0 ? u->mode[k]->damping : (double)NAN);
        number_column(table, "std", "Hz", SHOW_DIGITS(2), u->frequency_std[k]);
    }
    return csv_table(out, table);
}

/* The axis along which the nodes lie, whose coordinates are positions; -1: several, of which all are written; -2: no node has any
 * coordinates. */
static int axis_of(const struct csv_universal *u)
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

static int write_shapes(FILE *out, struct pool *pool, const void *from)
{
    static const char *const axes[] = {"x", "y", "z"};
    const struct csv_universal *u = from;
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
            const char *name = n ? "" : pool_format(pool, "mode %d", u->number[k]);
            number_column(table, name, NULL, SHOW_FIXED(5), u->value[n + (ptrdiff_t)k * u->nnode]);
            if (any_std)
                number_column(table, n || !name ? name : pool_format(pool, "%s std", name), NULL, SHOW_DIGITS(2),
                              u->std[n + (ptrdiff_t)k * u->nnode]);
        }
    }
    return csv_table(out, table);
}

const struct csv_part csv_universal_parts[CSV_MOST_FILES] = {{"modes", write_modes}, {"shapes", write_shapes}};
