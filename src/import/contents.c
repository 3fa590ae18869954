#include "import/import.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

#define PIECE 4096

enum { DISPLACEMENT = 8, REACTION_FORCE = 9, VELOCITY = 11, ACCELERATION = 12, EXCITATION_FORCE = 13 };

static int is_one_of(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (same_text(text, *words))
            return 1;
    return 0;
}

int motion_of(const struct uff_axis *axis)
{
    static const char *const accelerations[] = {"g", "gn", "m/s2", "m/s^2", "m/s**2", "mm/s2", "mm/s^2", NULL},
                             *const velocities[] = {"m/s", "mm/s", NULL}, *const displacements[] = {"m", "mm", "um", NULL};
    switch (axis->specific_type) {
    case DISPLACEMENT:
        return FRF_DISPLACEMENT;
    case VELOCITY:
        return FRF_VELOCITY;
    case ACCELERATION:
        return FRF_ACCELERATION;
    case 0:
    case 1:
        return is_one_of(axis->unit, accelerations)   ? FRF_ACCELERATION
               : is_one_of(axis->unit, velocities)    ? FRF_VELOCITY
               : is_one_of(axis->unit, displacements) ? FRF_DISPLACEMENT
                                                      : -1;
    default:
        return -1;
    }
}

int is_force(const struct uff_axis *axis)
{
    static const char *const forces[] = {"N", "kN", "lbf", NULL};
    return axis->specific_type == EXCITATION_FORCE || axis->specific_type == REACTION_FORCE ||
           (axis->specific_type <= 1 && is_one_of(axis->unit, forces));
}

struct placed {
    struct uff_node node;
    int line, order;
};

struct growing {
    struct pool *pool, *scratch;
    const char *path;
    struct message_list *messages;
    struct contents *contents;
    struct placed *node; /* of all sets */
    size_t item_room, node_count, node_room;
};

static int compare_ids(const void *left, const void *right)
{
    const struct placed *a = left, *b = right;
    return a->node.id != b->node.id ? (a->node.id > b->node.id) - (a->node.id < b->node.id)
                                    : (a->order > b->order) - (a->order < b->order);
}

static int add_nodes(struct growing *g, const struct uff_set *set, int count, const struct uff_node *node)
{
    for (int i = 0; i < count; i++) {
        g->node = pool_grow(g->scratch, g->node, g->node_count, &g->node_room, sizeof *g->node);
        if (!g->node)
            return ROTID_ERROR_MEMORY;
        g->node[g->node_count] = (struct placed){node[i], set->line, (int)g->node_count};
        g->node_count++;
    }
    return ROTID_OK;
}

/* Sorted, the first of each id, in metres. */
static int join_nodes(struct growing *g)
{
    struct contents *c = g->contents;
    double metre = c->has_units && c->units.length > 0 ? c->units.length : 1;
    c->node = POOL_ARRAY(g->pool, struct uff_node, g->node_count);
    if (!c->node)
        return ROTID_ERROR_MEMORY;
    if (g->node_count)
        qsort(g->node, g->node_count, sizeof *g->node, compare_ids);
    for (size_t i = 0, first = 0; i < g->node_count; i++) {
        const struct placed *p = &g->node[i];
        if (i && g->node[first].node.id == p->node.id) {
            const double *x = g->node[first].node.x;
            if (x[0] != p->node.x[0] || x[1] != p->node.x[1] || x[2] != p->node.x[2])
                message_add(g->messages, SEVERITY_WARNING, g->path, p->line, 1,
                            "node %d has other coordinates than before, the first ones are used", p->node.id);
            continue;
        }
        first = i;
        c->node[c->node_count] = p->node;
        for (int d = 0; d < 3; d++)
            c->node[c->node_count].x[d] /= metre;
        c->node_count++;
    }
    return ROTID_OK;
}

/* Half a unit of the last digit, relative, of numbers written with so many digits (E11.4 has five, E13.5 six); none where they
 * have more. */
static double rounding_of(long long count, const double *x)
{
    for (int digits = 5; digits <= 6; digits++) {
        int all = 1;
        for (long long i = 0; i < count && all; i++) {
            double unit = x[i] != 0 ? pow(10, floor(log10(fabs(x[i])) + 1e-12) - digits + 1) : 1, number = x[i] / unit;
            all = fabs(number - round(number)) < 1e-6;
        }
        if (all)
            return 5.1 * pow(10, -digits);
    }
    return 1e-12;
}

/* Many writers put down every abscissa although the lines are even, with so few digits that it looks uneven: the straight line
 * through all of them is what was meant, where none is off by more than its own rounding. */
static int settle_abscissa(struct growing *g, struct uff_reader *reader, struct content *item)
{
    struct uff_function *f = &item->function;
    struct pool scratch;
    long long got = 1, done = 0, room = 0;
    double *x = NULL;
    int status = ROTID_OK;
    pool_open(&scratch, g->pool->allocator);
    while (done < f->count && got > 0 && !status) { /* the count is only announced: room comes with the values */
        if (done == room) {
            room = room ? 2 * room : PIECE;
            double *more = POOL_ARRAY(&scratch, double, room);
            if (more && done)
                memcpy(more, x, (size_t)done * sizeof *x);
            x = more;
        }
        status =
            x ? uff_read_values(reader, room - done < f->count - done ? room - done : f->count - done, x + done, NULL, NULL, &got)
              : ROTID_ERROR_MEMORY;
        done += status ? 0 : got;
    }
    if (status || !x) {
        pool_close(&scratch);
        return status;
    }
    double middle = 0.5 * (double)(done - 1), mean = 0, slope = 0, spread = 0;
    for (long long i = 0; i < done; i++)
        mean += x[i] / (double)done;
    for (long long i = 0; i < done; i++) {
        slope += ((double)i - middle) * (x[i] - mean);
        spread += ((double)i - middle) * ((double)i - middle);
    }
    int even = done > 2 && slope > 0;
    slope /= spread;
    double rounding = rounding_of(done, x);
    for (long long i = 0; i < done && even; i++)
        even = fabs(x[i] - mean - ((double)i - middle) * slope) <= rounding * fabs(x[i]) + 1e-6 * slope;
    if (even) {
        f->is_even = 1;
        f->step = slope;
        f->start = mean - middle * slope;
        if (fabs(f->start) < 1e-3 * slope)
            f->start = 0;
    } else {
        item->x = POOL_ARRAY(g->pool, double, done);
        if (item->x && done)
            memcpy(item->x, x, (size_t)done * sizeof *x);
        status = item->x ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    pool_close(&scratch);
    return status;
}

static int read_function(struct growing *g, struct uff_reader *reader, const struct uff_set *set)
{
    struct contents *c = g->contents;
    c->item = pool_grow(g->pool, c->item, (size_t)c->count, &g->item_room, sizeof *c->item);
    if (!c->item)
        return ROTID_ERROR_MEMORY;
    struct content *item = &c->item[c->count];
    *item = (struct content){.set = *set};
    int status = uff_read_function(reader, &item->function);
    if (!status && !item->function.is_even)
        status = settle_abscissa(g, reader, item);
    c->count += !status;
    return status;
}

static int read_set(struct growing *g, struct uff_reader *reader, const struct uff_set *set)
{
    struct contents *c = g->contents;
    struct uff_node *node;
    int count, status;
    switch (set->number) {
    case 15:
    case 781:
    case 2411:
        status = uff_read_nodes(reader, g->scratch, &count, &node);
        return status ? status : add_nodes(g, set, count, node);
    case 164:
        status = uff_read_units(reader, &c->units);
        c->has_units |= !status;
        return status;
    case 58:
        return read_function(g, reader, set);
    default:
        return ROTID_OK;
    }
}

int contents_read(struct pool *pool, struct uff_reader *reader, const char *path, struct message_list *messages,
                  struct contents *contents)
{
    struct pool scratch;
    struct growing g = {.pool = pool, .scratch = &scratch, .path = path, .messages = messages, .contents = contents};
    struct uff_set set;
    int status;
    *contents = (struct contents){0};
    pool_open(&scratch, pool->allocator);
    while (!(status = uff_next(reader, &set)))
        if ((status = read_set(&g, reader, &set)))
            break;
    if (status == UFF_END)
        status = join_nodes(&g);
    pool_close(&scratch);
    return status;
}

int contents_values(struct uff_reader *reader, const struct content *item, long long first, long long count, double factor,
                    double *real, double *imag)
{
    struct uff_function f;
    double skip_real[256], skip_imag[256];
    long long got = 1, done = 0;
    int status = uff_return_to(reader, &item->set);
    if (!status)
        status = uff_read_function(reader, &f);
    for (long long left = first; left > 0 && got > 0 && !status; left -= got)
        status = uff_read_values(reader, left < 256 ? left : 256, NULL, skip_real, skip_imag, &got);
    while (done < count && !status && got > 0) {
        status = uff_read_values(reader, count - done, NULL, real + done, imag ? imag + done : NULL, &got);
        done += got;
    }
    for (long long i = 0; i < done; i++) {
        real[i] *= factor;
        if (imag)
            imag[i] *= factor;
    }
    return status;
}
